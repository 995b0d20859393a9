//! A file of still postures as a diagnosis has improved it: what was found in place of what it declares, in its order and with its comments.

use toml_edit::{Array, DocumentMut, InlineTable, Item, Table, Value};

use super::{DeclaredValue, PoseOf, PosturesFile, ReadingAxes, ReadingOf, WrenchValues};
use crate::keys::check::plain;
use crate::scenario::effects::as_written;

/// Text of the improved file; `remark` says what was found.
#[must_use]
pub fn improved_postures_text(file: &PosturesFile, found: &WrenchValues, remark: &str) -> String {
    let mut document: DocumentMut = file
        .text
        .parse()
        .expect("the text was read as TOML when the file was loaded");
    let own = &file.values;
    let base = table(&mut document, "base");
    if found.gravity != own.gravity {
        put(base, "gravity_m_per_s2", numbers(found.gravity.to_array()));
    }
    let wrench = table(&mut document, "wrench_sensor");
    if found.axes != own.axes {
        put(wrench, "axes", axes_name(found.axes).into());
    }
    if found.pose != own.pose {
        put(wrench, "pose", pose_name(found.pose).into());
    }
    if found.reads != own.reads {
        put(wrench, "reads", reading_name(found.reads).into());
    }
    if found.rotation != own.rotation {
        put(wrench, "rotation_rad", numbers(found.rotation.to_array()));
    }
    let vectors = [
        ("zero_force_n", "tolerance_n", found.zero_force),
        ("zero_torque_n_m", "tolerance_n_m", found.zero_torque),
        ("tool_centre_m", "tolerance_m", found.tool_centre),
    ];
    for (key, tolerance, value) in vectors {
        if let Some(DeclaredValue { value, low, high }) = value {
            let halves = (0..3).map(|axis| 0.5 * (high[axis] - low[axis]));
            let half = halves.fold(0.0, f64::max);
            put(wrench, key, within(numbers(value), tolerance, half));
        }
    }
    if let Some(DeclaredValue { value, low, high }) = found.tool_mass {
        let half = 0.5 * (high - low);
        let mass = within(number(value), "tolerance_kg", half);
        put(wrench, "tool_mass_kg", mass);
    }
    let mut text = document.to_string();
    if !text.ends_with('\n') {
        text.push('\n');
    }
    text + &format!("\n# Found: {remark}\n")
}

fn axes_name(axes: ReadingAxes) -> &'static str {
    match axes {
        ReadingAxes::Sensor => "sensor",
        ReadingAxes::Base => "base",
    }
}

fn pose_name(pose: PoseOf) -> &'static str {
    match pose {
        PoseOf::SensorInBase => "sensor_in_base",
        PoseOf::BaseInSensor => "base_in_sensor",
    }
}

fn reading_name(reads: ReadingOf) -> &'static str {
    match reads {
        ReadingOf::ToolOnSensor => "tool_on_sensor",
        ReadingOf::SensorOnTool => "sensor_on_tool",
    }
}

fn table<'d>(document: &'d mut DocumentMut, name: &str) -> &'d mut Item {
    document
        .entry(name)
        .or_insert_with(|| Item::Table(Table::new()))
}

/// Puts a value in place of another, whose comment stays.
fn put(table: &mut Item, key: &str, mut new: Value) {
    if let Some(old) = table.get(key).and_then(Item::as_value) {
        *new.decor_mut() = old.decor().clone();
    }
    table[key] = Item::Value(new);
}

fn number(value: f64) -> Value {
    plain(as_written(value))
        .parse()
        .unwrap_or_else(|_| value.into())
}

fn numbers(values: [f64; 3]) -> Value {
    Value::Array(values.map(number).into_iter().collect::<Array>())
}

fn within(value: Value, tolerance: &str, half: f64) -> Value {
    let mut table = InlineTable::new();
    table.insert("value", value);
    // Two digits are as many as an interval deserves.
    let half = format!("{half:.1e}").parse().unwrap_or(half);
    table.insert(tolerance, number(half));
    Value::InlineTable(table)
}

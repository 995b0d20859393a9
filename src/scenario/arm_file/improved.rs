//! An arm file as a diagnosis has improved it: the nominal one with the values found in place of its own, in its order and with its comments, and the physics
//! found below them.

use std::fmt::Write as _;
use std::path::Path;

use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, Value, value};

use super::ArmFile;
use super::laws;
use crate::keys::check::plain;
use crate::recorded_arm::parameters::USUAL_BRISTLE_LENGTH;
use crate::recorded_arm::vocabulary::arm_effect;
use crate::recorded_arm::wrench::{CHANNELS, WrenchSensor};
use crate::recorded_arm::{ArmParameters, Drive};
use crate::scenario::effects::as_written;

/// Text of the improved file; `recordings` are those by which the arm counts its pushes. It may stand anywhere: the path of its URDF is absolute.
#[must_use]
pub fn improved_arm_text(file: &ArmFile, arm: &ArmParameters, recordings: &[String]) -> String {
    let mut document: DocumentMut = file
        .text
        .parse()
        .expect("the text was read as TOML when the arm was loaded");
    let urdf = file.urdf.canonicalize();
    let urdf = urdf.as_deref().unwrap_or(&file.urdf);
    replace(&mut document["arm"]["urdf"], urdf_value(urdf));
    links(&mut document, file, arm);
    drives(&mut document, file, arm);
    load(&mut document, file, arm);
    if let (Some(own), Some(found)) = (&file.nominal.wrench, &arm.wrench) {
        wrench(&mut document["wrench_sensor"], own, found);
    }
    document.remove("effect");
    document.remove("law");
    let mut text = document.to_string();
    if !text.ends_with('\n') {
        text.push('\n');
    }
    for effect in effects(file, arm, recordings) {
        effect.append(&mut text);
    }
    for law in &arm.laws {
        laws::append(&mut text, law, file.names());
    }
    text
}

fn urdf_value(path: &Path) -> Value {
    path.display().to_string().into()
}

/// A number as the file shows it.
fn number(value: f64) -> Value {
    plain(as_written(value))
        .parse()
        .unwrap_or_else(|_| value.into())
}

fn numbers(values: [f64; 3]) -> Value {
    Value::Array(values.map(number).into_iter().collect::<Array>())
}

/// Puts a value in place of another, whose tolerance and comment stay. Ends that no longer hold it go.
fn replace(item: &mut Item, new: Value) {
    let beyond = |table: &InlineTable| {
        let end = |key: &str| table.get(key).and_then(as_number);
        let found = as_number(&new);
        let is_list = found.is_none();
        let outside = |end: Option<f64>, sign: f64| match (end, found) {
            (Some(end), Some(found)) => sign * (found - end) < 0.0,
            _ => false,
        };
        (is_list && table.contains_key("low"))
            || outside(end("low"), 1.0)
            || outside(end("high"), -1.0)
    };
    match item {
        Item::Value(Value::InlineTable(table)) => {
            if beyond(table) {
                table.remove("low");
                table.remove("high");
            }
            table.insert("value", new);
        }
        Item::Value(old) => {
            let decor = old.decor().clone();
            *old = new;
            *old.decor_mut() = decor;
        }
        other => *other = Item::Value(new),
    }
}

fn as_number(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|i| i as f64))
}

/// Links whose mass or centre is another.
fn links(document: &mut DocumentMut, file: &ArmFile, arm: &ArmParameters) {
    for (index, name) in file.links.iter().enumerate() {
        let [own, found] = [&file.nominal, arm].map(|arm| arm.chain.joints[index].body);
        let known = table_of(document, "link", |table| {
            table.get("name").and_then(Item::as_str) == Some(name)
        });
        let [mass, centre] = [
            own.mass != found.mass,
            own.centre_of_mass != found.centre_of_mass,
        ];
        // What the file gives already stays or is replaced; an effect that gave it is no longer there.
        let of_urdf = &file.bodies[index];
        let has = |key: &str| known.is_some_and(|place| has_key(document, "link", place, key));
        let mass = mass || (!has("mass_kg") && found.mass != of_urdf.mass);
        let centre = centre || (!has("centre_m") && found.centre_of_mass != of_urdf.centre_of_mass);
        if !(mass || centre) {
            continue;
        }
        let place = known.unwrap_or_else(|| {
            let mut table = Table::new();
            table.insert("name", value(name.as_str()));
            tables(document, "link").push(table);
            tables(document, "link").len() - 1
        });
        let Some(table) = tables(document, "link").get_mut(place) else {
            continue;
        };
        if mass {
            replace(&mut table["mass_kg"], number(found.mass));
        }
        if centre {
            let centre = numbers(found.centre_of_mass.to_array());
            replace(&mut table["centre_m"], centre);
        }
    }
}

/// The list of tables of a name, made where there is none.
fn tables<'d>(document: &'d mut DocumentMut, name: &str) -> &'d mut ArrayOfTables {
    let item = document
        .entry(name)
        .or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
    if !item.is_array_of_tables() {
        // A list of inline tables.
        let taken = std::mem::take(item);
        *item = match taken.into_array_of_tables() {
            Ok(tables) => Item::ArrayOfTables(tables),
            Err(_) => Item::ArrayOfTables(ArrayOfTables::new()),
        };
    }
    item.as_array_of_tables_mut()
        .expect("it was made one where it was none")
}

fn table_of(
    document: &mut DocumentMut,
    name: &str,
    is_it: impl Fn(&Table) -> bool,
) -> Option<usize> {
    document
        .contains_key(name)
        .then(|| tables(document, name))?;
    tables(document, name).iter().position(is_it)
}

fn has_key(document: &DocumentMut, name: &str, place: usize, key: &str) -> bool {
    let tables = document.get(name).and_then(Item::as_array_of_tables);
    let table = tables.and_then(|tables| tables.get(place));
    table.is_some_and(|table| table.contains_key(key))
}

/// Numbers of drives that have keys.
fn drives(document: &mut DocumentMut, file: &ArmFile, arm: &ArmParameters) {
    for (place, column) in file.numbers.iter().enumerate() {
        let [own, found] = [&file.nominal, arm].map(|arm| &arm.drives[place]);
        let Some(table) = tables(document, "drive").get_mut(column - 1) else {
            continue;
        };
        let mut put = |key: &str, own: f64, found: f64| {
            // A number of an effect, which is then no longer there, may be another than the key's.
            let same = own == found && (table.contains_key(key) || found == 0.0);
            let is_written = table.get(key).and_then(written_number);
            if !same || is_written.is_some_and(|written| written != found) {
                replace(&mut table[key], number(found));
            }
        };
        if found.logs_current {
            let [own, found] = [own, found].map(|drive| 1.0 / drive.inverse_gain);
            put("gain_n_m_per_a", own, found);
        }
        put(
            "motor_inertia_kg_m2",
            own.motor_inertia,
            found.motor_inertia,
        );
        put("coulomb_friction_n_m", own.coulomb, found.coulomb);
        put("viscous_friction_n_m_s_per_rad", own.viscous, found.viscous);
        if found.bristle_length != own.bristle_length
            || found.bristle_length != USUAL_BRISTLE_LENGTH
        {
            replace(
                &mut table["bristle_length_rad"],
                number(found.bristle_length),
            );
        }
    }
}

fn written_number(item: &Item) -> Option<f64> {
    let value = item.as_value()?;
    match value {
        Value::InlineTable(table) => table.get("value").and_then(as_number),
        other => as_number(other),
    }
}

fn load(document: &mut DocumentMut, file: &ArmFile, arm: &ArmParameters) {
    let [own, found] = [file.nominal.load, arm.load];
    if own == found {
        return;
    }
    let table = document.entry("load").or_insert(Item::Table(Table::new()));
    replace(&mut table["mass_kg"], number(found.mass));
    if own.centre() != found.centre() {
        replace(&mut table["centre_m"], numbers(found.centre().to_array()));
    }
}

fn wrench(table: &mut Item, own: &WrenchSensor, found: &WrenchSensor) {
    replace(&mut table["rotation_z_rad"], number(found.rotation));
    for (first, key) in [(0, "zero_force_n"), (3, "zero_torque_n_m")] {
        let zero = |sensor: &WrenchSensor| {
            let zero = &sensor.zero[first..first + 3];
            [zero[0], zero[1], zero[2]]
        };
        if zero(found) != [0.0; 3] || zero(own) != [0.0; 3] {
            replace(&mut table[key], numbers(zero(found)));
        }
    }
    replace(&mut table["tool_mass_kg"], number(found.tool_mass));
    replace(
        &mut table["tool_centre_m"],
        numbers(found.tool_centre.to_array()),
    );
    let inertia = found.tool_inertia_per_mass * found.tool_mass;
    if inertia != glam::DVec3::ZERO {
        replace(
            &mut table["tool_inertia_kg_m2"],
            numbers(inertia.to_array()),
        );
    }
}

/// An effect as it is written.
struct Written {
    name: &'static str,
    places: Vec<(&'static str, String)>,
    numbers: Vec<(&'static str, f64)>,
}

impl Written {
    fn append(&self, text: &mut String) {
        let meaning = arm_effect(self.name).map_or("", |effect| effect.meaning);
        // Writing into a text cannot fail.
        let _ = writeln!(
            text,
            "\n# Found: {meaning}.\n[[effect]]\nname = \"{}\"",
            self.name
        );
        for (key, place) in &self.places {
            let _ = writeln!(text, "{key} = {place}");
        }
        for (key, value) in &self.numbers {
            let _ = writeln!(text, "{key} = {}", plain(as_written(*value)));
        }
    }
}

/// What an arm has beyond the keys of its file.
fn effects(file: &ArmFile, arm: &ArmParameters, recordings: &[String]) -> Vec<Written> {
    let mut found: Vec<Written> = Vec::new();
    for (drive, number) in arm.drives.iter().zip(&file.numbers) {
        of_drive(drive, *number, &mut found);
    }
    let mut add = |name, places: Vec<(&'static str, String)>, numbers| {
        found.push(Written {
            name,
            places,
            numbers,
        });
    };
    if arm.payload.mass != 0.0 {
        let centre = arm.payload.centre();
        let numbers = vec![
            ("mass_kg", arm.payload.mass),
            ("centre_x_m", centre.x),
            ("centre_y_m", centre.y),
            ("centre_z_m", centre.z),
        ];
        add("payload", Vec::new(), numbers);
    }
    if arm.tilt != [0.0; 2] {
        let [roll, pitch] = arm.tilt;
        let numbers = vec![("roll_rad", roll), ("pitch_rad", pitch)];
        add("base_tilt", Vec::new(), numbers);
    }
    for push in &arm.pushes {
        let Some(name) = recordings.get(push.recording) else {
            continue;
        };
        let direction = push.force.normalize_or(-glam::DVec3::Z);
        let numbers = vec![
            ("start_s", push.start),
            ("end_s", push.end),
            ("force_n", push.force.length()),
            ("direction_x", direction.x),
            ("direction_y", direction.y),
            ("direction_z", direction.z),
            ("edge", push.edge),
        ];
        add("outside_push", vec![("recording", quoted(name))], numbers);
    }
    if let Some(wrench) = &arm.wrench {
        for (index, channel) in CHANNELS.into_iter().enumerate() {
            let place = || vec![("channel", quoted(channel))];
            if wrench.gain[index] != 1.0 {
                let numbers = vec![("gain", wrench.gain[index])];
                add("wrench_gain_error", place(), numbers);
            }
            if wrench.drift[index] != 0.0 {
                let numbers = vec![("n_per_s", wrench.drift[index])];
                add("wrench_drift", place(), numbers);
            }
        }
        for crosstalk in wrench.crosstalk.iter().filter(|c| c.share != 0.0) {
            let places = vec![
                ("source", quoted(CHANNELS[crosstalk.source])),
                ("target", quoted(CHANNELS[crosstalk.target])),
            ];
            let numbers = vec![("coefficient", crosstalk.share)];
            add("wrench_crosstalk", places, numbers);
        }
    }
    if arm.delay != 0.0 {
        add("current_late", Vec::new(), vec![("delay_s", arm.delay)]);
    }
    found
}

fn quoted(text: &str) -> String {
    Value::from(text).to_string()
}

/// What a drive has beyond its keys.
fn of_drive(drive: &Drive, number: usize, found: &mut Vec<Written>) {
    let mut add = |name, numbers| {
        found.push(Written {
            name,
            places: vec![("joint", number.to_string())],
            numbers,
        });
    };
    if drive.static_excess != 0.0 {
        let numbers = vec![
            ("coulomb_n_m", drive.coulomb),
            ("viscous_n_m_s_per_rad", drive.viscous),
            ("static_n_m", drive.coulomb + drive.static_excess),
            ("stribeck_velocity_rad_per_s", drive.stribeck_velocity),
        ];
        add("stribeck_joint_friction", numbers);
    }
    if drive.load_friction != 0.0 {
        let numbers = vec![("friction_per_load", drive.load_friction)];
        add("load_dependent_joint_friction", numbers);
    }
    let stiffness = drive.spring_stiffness;
    if stiffness != 0.0 {
        let rest = -drive.offset / stiffness;
        let numbers = vec![("stiffness_n_m_per_rad", stiffness), ("rest_rad", rest)];
        add("dress_pack_spring", numbers);
    } else if drive.offset != 0.0 {
        add("joint_torque_offset", vec![("offset_n_m", drive.offset)]);
    }
    if drive.ripple != [0.0; 2] {
        let [sine, cosine] = drive.ripple;
        let numbers = vec![
            ("amplitude_n_m", sine.hypot(cosine)),
            ("cycles_per_turn", drive.ripple_cycles),
            ("phase_rad", cosine.atan2(sine)),
        ];
        add("gear_ripple", numbers);
    }
    if drive.compliance != 0.0 {
        let numbers = vec![("stiffness_n_m_per_rad", 1.0 / drive.compliance)];
        add("compliant_joint", numbers);
    }
    if drive.encoder_offset != 0.0 {
        let numbers = vec![("offset_rad", drive.encoder_offset)];
        add("joint_encoder_offset", numbers);
    }
    if drive.warm_fraction != 0.0 {
        let numbers = vec![
            ("fraction", drive.warm_fraction),
            ("time_constant_s", drive.warm_time),
        ];
        add("joint_warm_up", numbers);
    }
}

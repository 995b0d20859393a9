//! scenarios/README.md is the reference of all keys, so it is held against what the program does.

use std::collections::BTreeMap;

use toml::{Table, Value};

use super::super::AnyScenario;
use super::super::sections::{bench_sections, model_sections, scenario_sections};
use super::super::suggestion::join;
use super::super::units::Unit;
use super::{MINIMAL, MINIMAL_BENCH, read_any, scenarios};
use crate::plant::{Number, registry};

/// Which of the two formats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Cell,
    Bench,
}

use Format::{Bench, Cell};

/// A line of the README's tables of keys.
struct Row {
    unit: String,
    default: String,
    range: String,
    meaning: String,
}

/// Whether a key of a chapter of the README belongs to a format.
fn belongs(key: &str, chapter: &str, format: Format) -> bool {
    let of_both = ["schema", "kind", "title"].contains(&key) || key.starts_with("device.");
    match chapter {
        "Keys of a cell" => format == Cell || of_both,
        "Keys of a bench" => format == Bench,
        "Keys of the sensing chain" | "Keys of the controller" => true,
        // Neither a cell that runs nor a bench.
        "Keys of a recorded cell" => false,
        other => panic!("{key} stands in the chapter {other:?}"),
    }
}

fn rows(format: Format) -> BTreeMap<String, Row> {
    let text = std::fs::read_to_string(scenarios().join("README.md")).unwrap();
    let mut chapter = "";
    let mut rows = BTreeMap::new();
    for line in text.lines() {
        if let Some(heading) = line.strip_prefix("## ") {
            chapter = heading;
        }
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let quoted = |cell: &&str| Some(cell.strip_prefix('`')?.strip_suffix('`')?.to_owned());
        let Some(key) = cells.get(1).and_then(quoted) else {
            continue;
        };
        assert_eq!(cells.len(), 7, "{line}");
        if !belongs(&key, chapter, format) {
            continue;
        }
        let cell = |index: usize| cells[index].to_owned();
        let (unit, default, range, meaning) = (cell(2), cell(3), cell(4), cell(5));
        let row = Row {
            unit,
            default,
            range,
            meaning,
        };
        assert!(
            rows.insert(key, row).is_none(),
            "a key stands twice: {line}"
        );
    }
    rows
}

/// Keys that a key needs beside it, and the key itself if it is needed there.
fn beside(key: &str) -> String {
    let (table, name) = key.rsplit_once('.').unwrap_or(("", key));
    match (table, name) {
        ("workpiece.burr", "height_mm" | "position_mm" | "width_mm") => {
            "[workpiece.burr]\nkind = 'bump'\nposition_mm = 1\nheight_mm = 1\nwidth_mm = 1".into()
        }
        ("workpiece.burr", "path") => "[workpiece.burr]\nkind = 'table'\npath = 'README.md'".into(),
        ("workpiece.burr", _) => {
            "[workpiece.burr]\nkind = 'random'\nmean_height_mm = 1\ncorrelation_length_mm = 1"
                .into()
        }
        ("arm.limit_overrides", "effort_n_m") => {
            "[[arm.limit_overrides]]\njoint = 'a'\nvelocity_deg_per_s = 90".into()
        }
        ("arm.limit_overrides", _) => "[[arm.limit_overrides]]\njoint = 'a'\neffort_n_m = 9".into(),
        ("arm.link_masses", "link") => "[[arm.link_masses]]\nmass_kg = 2".into(),
        ("arm.link_masses", _) => "[[arm.link_masses]]\nlink = 'a'".into(),
        ("arm.drives", "backlash_deg") => {
            "[[arm.drives]]\njoint = 'a'\nstiffness_n_m_per_rad = 1e6".into()
        }
        ("pass", _) => "[[pass]]\nforce_n = 9\nfeed_mm_per_s = 9".into(),
        ("tool", name) if name.starts_with("cone_") => {
            "[tool]\nshape = 'cone'\nspindle_speed_rpm = 9000\ncone_angle_deg = 60\ncone_length_mm = 200"
                .into()
        }
        ("tool", "wheel_radius_mm") => {
            "[tool]\nshape = 'belt'\nspindle_speed_rpm = 9000\nwheel_radius_mm = 20".into()
        }
        ("tool", _) => "[tool]\nshape = 'ball'\nspindle_speed_rpm = 9000".into(),
        ("process.feed_follows", name) => {
            let other = if name == "power_w" { "power_w" } else { "force_n" };
            format!("[process.feed_follows]\n{other} = 9")
        }
        ("removal", name) => removal(name),
        ("obstacle", _) => "[[obstacle]]\nbox_mm = [1, 1, 1]".into(),
        ("arm.drives", _) => "[[arm.drives]]\njoint = 'a'".into(),
        ("estimator", _) => "[device.override]\ngas_process = 'isothermal'\n[estimator]\n".into(),
        ("hand", _) => "[hand]\npeak_force_n = 1\nfrequency_hz = 1".into(),
        ("command", "force_n") => "[[command]]\nat_s = 0\nforce_n = 1".into(),
        ("command", _) => "[[command]]\nat_s = 0\nset_pressure_bar_gauge = 1".into(),
        ("valve", _) => "[[valve]]\nat_s = 0\nposition = 'extend'".into(),
        ("controller", "kind" | "period_ms") => "[controller]".into(),
        ("controller", name) => {
            let kind = match name {
                "proportional_gain" | "integral_gain_per_s" => "proportional_integral",
                "rate_per_s" => "feedback_linearisation",
                _ => "disturbance_prediction",
            };
            format!("[controller]\nkind = '{kind}'")
        }
        ("sensing.adc", _) => "[sensing.force]\nkind = 'real'".into(),
        ("sensing.filter", name) => {
            let (kind, setting) = match name {
                "time_constant_ms" => ("first_order", "time_constant_ms = 10"),
                "length" => ("median", "length = 3"),
                _ => ("bessel", "cutoff_hz = 10"),
            };
            format!(
                "[sensing]\nsample_rate_hz = 1000\n[sensing.filter]\nkind = '{kind}'\n{setting}"
            )
        }
        (table, name) if table.starts_with("sensing.") && name != "kind" => {
            let white = name.starts_with("standard_deviation");
            let kind = if white { "white" } else { "real" };
            format!("[{table}]\nkind = '{kind}'")
        }
        _ => String::new(),
    }
}

/// A law of removal that has a key.
fn removal(key: &str) -> String {
    let law = match key {
        "threshold_force_n" => {
            "law = 'threshold'\ncoefficient_mm3_per_j = 1\nthreshold_force_n = 1"
        }
        "rate_mm3_per_s"
        | "reference_force_n"
        | "reference_speed_m_per_s"
        | "force_exponent"
        | "speed_exponent"
        | "reference_area_mm2"
        | "area_exponent"
        | "contact_area_mm2" => {
            "law = 'power'\nrate_mm3_per_s = 1\nreference_force_n = 9\nreference_speed_m_per_s = 9\nforce_exponent = 2"
        }
        _ => "law = 'preston'\ncoefficient_mm3_per_j = 1",
    };
    format!("[tool]\nshape = 'ball'\nspindle_speed_rpm = 9000\n[removal]\n{law}")
}

/// The minimal scenario of a format with what a key needs.
fn base(format: Format, key: &str) -> Table {
    const SURFACE: &str =
        "kind = \"surface\"\nposition_mm = 1\npeak_to_peak_mm = 1\nfrequency_hz = 1";
    let minimal = match format {
        Cell => MINIMAL.to_owned(),
        Bench if key.starts_with("load.") && key != "load.kind" => {
            MINIMAL_BENCH.replace("kind = \"free\"", SURFACE)
        }
        Bench if key.starts_with("controller.") => {
            let pressing = MINIMAL_BENCH.replace("kind = \"free\"", SURFACE);
            pressing + "[[command]]\nat_s = 0\nforce_n = 1\n"
        }
        Bench => MINIMAL_BENCH.to_owned(),
    };
    format!("{minimal}{}\n", beside(key)).parse().unwrap()
}

/// The table that holds a key, and its name there.
fn slot<'a>(mut table: &'a mut Table, key: &'a str) -> (&'a mut Table, &'a str) {
    let mut parts: Vec<&str> = key.split('.').collect();
    let name = parts.pop().unwrap();
    for part in parts {
        let value = table.entry(part).or_insert(Value::Table(Table::new()));
        table = match value {
            Value::Array(elements) => elements[0].as_table_mut().unwrap(),
            value => value.as_table_mut().unwrap(),
        };
    }
    (table, name)
}

/// Result of a key with a value: the scenario, or the message.
fn outcome(format: Format, key: &str, value: Option<Value>) -> Result<String, String> {
    let mut table = base(format, key);
    let (holder, name) = slot(&mut table, key);
    match value {
        Some(value) => drop(holder.insert(name.to_owned(), value)),
        None => drop(holder.remove(name)),
    }
    let text = toml::to_string(&table).unwrap();
    match read_any(&text) {
        Ok(mut scenario) => {
            // A value that is given is no default that somebody judged, though it is the same.
            let device = match &mut scenario {
                AnyScenario::Cell(cell) => {
                    cell.judged.clear();
                    &mut cell.device
                }
                AnyScenario::Bench(bench) => &mut bench.device,
            };
            device.judged.clear();
            Ok(format!("{scenario:?}"))
        }
        Err(error) => Err(error.to_string()),
    }
}

#[test]
fn every_key_has_its_row_and_every_row_its_key() {
    for (format, mut sections) in [(Cell, scenario_sections()), (Bench, bench_sections())] {
        // The tables' own names are keys of the tables around them.
        let tables: Vec<&str> = sections.iter().map(|(table, _)| *table).collect();
        sections.retain(|(_, keys)| !keys.is_empty());
        assert_eq!(
            sections.len(),
            tables.len(),
            "a table without keys was not read off its type"
        );
        let mut keys: Vec<String> = sections
            .iter()
            .flat_map(|(table, keys)| keys.iter().map(|key| join(table, key)))
            .filter(|key| !tables.contains(&key.as_str()) && !key.starts_with("expect"))
            .collect();
        keys.sort();
        let documented: Vec<String> = rows(format).into_keys().collect();
        assert_eq!(documented, keys, "{format:?}");
    }
    // A model file has the keys of [device.override].
    let find = |sections: &[(&str, &'static [&'static str])], table: &str| {
        sections.iter().find(|(name, _)| *name == table).unwrap().1
    };
    let of_model = find(&model_sections(), "device");
    assert_eq!(of_model, find(&scenario_sections(), "device.override"));
    assert_eq!(of_model, find(&bench_sections(), "device.override"));
}

#[test]
fn every_unit_is_that_of_the_key() {
    for (key, row) in [Cell, Bench].into_iter().flat_map(rows) {
        let unit = Unit::of_key(&key);
        if unit.is_one() {
            let words = ["number", "whole number", "text", "true or false", "file"];
            let is_word = words.contains(&row.unit.as_str()) || row.unit.starts_with("table");
            assert!(is_word, "{key}: {}", row.unit);
        } else {
            assert_eq!(row.unit.split(',').next().unwrap(), unit.symbol, "{key}");
        }
    }
}

#[test]
fn every_default_is_what_leaving_the_key_out_does() {
    for (format, least_defaults, least_required) in [(Cell, 90, 18), (Bench, 70, 15)] {
        let (mut defaults, mut required) = (0, 0);
        for (key, row) in rows(format) {
            // Without its kind, a bench is no bench.
            if row.default.starts_with("one of") || (key == "kind" && format == Bench) {
                continue;
            }
            let without = outcome(format, &key, None);
            if row.default == "required" {
                let message = without.expect_err(&key);
                assert!(message.contains("is missing"), "{key}: {message}");
                required += 1;
                continue;
            }
            let without = without.unwrap_or_else(|error| panic!("{key}: {error}"));
            if let Ok(mut table) = format!("v = {}", row.default).parse::<Table>() {
                let given = outcome(format, &key, table.remove("v"));
                assert_eq!(given, Ok(without), "{key}");
                defaults += 1;
            } else {
                let worded = row.default == "none"
                    || [
                        "half",
                        "third",
                        "10 bits",
                        "tuned",
                        "the device's",
                        "that of",
                        "sample",
                    ]
                    .iter()
                    .any(|word| row.default.contains(word));
                assert!(worded, "{key}: {}", row.default);
            }
        }
        assert!(
            defaults > least_defaults && required > least_required,
            "{format:?}: {defaults} defaults, {required} required"
        );
    }
}

#[test]
fn every_range_is_kept_and_named_as_in_the_readme() {
    for (format, least) in [(Cell, 95), (Bench, 80)] {
        let rows = rows(format);
        let ranges = rows
            .iter()
            .filter(|(key, row)| range_is_kept(format, key, row))
            .count();
        assert!(ranges > least, "{format:?}: {ranges} ranges");
    }
}

/// Holds the program to the range of a row; false for a row without numbers.
fn range_is_kept(format: Format, key: &str, row: &Row) -> bool {
    let (low, high): (f64, f64) = match (
        row.range.split_once(" to "),
        row.range.strip_prefix("at least "),
    ) {
        (Some((low, high)), _) => (low.parse().unwrap(), high.parse().unwrap()),
        (_, Some(low)) => (low.parse().unwrap(), f64::INFINITY),
        _ => return false,
    };
    let whole = row.unit == "whole number";
    let outcome = |number: f64| {
        let value = if whole {
            Value::Integer(number as i64)
        } else {
            Value::Float(number)
        };
        let zero = Value::Float(0.0);
        let value = if row.unit.contains("list") {
            Value::Array(vec![value, zero.clone(), zero])
        } else {
            value
        };
        outcome(format, key, Some(value))
    };
    let words = format!("expected {}", row.range);
    let refused = |number: f64| outcome(number).is_err_and(|message| message.contains(&words));
    let step = |end: f64| {
        if whole {
            1.0
        } else {
            1e-9 * end.abs().max(1e-3)
        }
    };
    let below = low - step(low);
    assert!(refused(below), "{key} below {low}: {:?}", outcome(below));
    // Another key may object to an end of the range; the range may not.
    assert!(!refused(low) && !refused(high), "{key} at an end");
    if high.is_finite() {
        let above = high + step(high);
        assert!(refused(above), "{key} above {high}: {:?}", outcome(above));
    }
    true
}

/// Keys other than those of the device model file that give a number of the description, with it.
#[rustfmt::skip] // A table: one number a line.
const GIVEN: [(&str, &Number); 15] = [
    ("contact.spindle_frequency_hz", &registry::SPINDLE_FREQUENCY),
    ("contact.stiffness_n_per_m", &registry::CONTACT_STIFFNESS), ("load.stiffness_n_per_m", &registry::CONTACT_STIFFNESS),
    ("contact.damping_n_s_per_m", &registry::CONTACT_DAMPING), ("load.damping_n_s_per_m", &registry::CONTACT_DAMPING),
    ("contact.friction_coefficient", &registry::EDGE_FRICTION), ("contact.runout_frequency_hz", &registry::RUNOUT_FREQUENCY),
    ("arm.servo.lag_bandwidth_hz", &registry::SERVO_BANDWIDTH), ("arm.drives.stiffness_n_m_per_rad", &registry::JOINT_STIFFNESS),
    ("arm.drives.damping_time_ms", &registry::JOINT_DAMPING), ("arm.drives.backlash_deg", &registry::JOINT_PLAY),
    ("arm.drives.friction_n_m", &registry::DRIVE_FRICTION), ("bench.gravity_along_extension_m_per_s2", &registry::GRAVITY),
    ("estimator.moving_mass_kg", &registry::MOVING_MASS), ("estimator.seal_coulomb_force_n", &registry::SEAL_COULOMB),
];

#[test]
fn what_gives_a_number_of_the_description_has_its_range_and_that_of_the_device_its_meaning() {
    let mut of_device = 0;
    for (key, row) in [Cell, Bench].into_iter().flat_map(rows) {
        let device_key = key.strip_prefix("device.override.");
        let of_file = device_key.filter(|key| *key != "gas_process");
        let known = of_file.map(|key| {
            let found = registry::all().find(|number| number.device_key == Some(key));
            found.unwrap_or_else(|| panic!("{key} is not registered"))
        });
        if let Some(number) = known {
            assert_eq!(row.meaning, number.meaning, "{key}");
            of_device += 1;
        }
        let given = GIVEN.iter().find(|(given, _)| *given == key);
        let others = ["contact.runout_um", "arm.drives.joint"];
        let of_plant = key.starts_with("contact.") || key.starts_with("arm.drives.");
        assert!(
            given.is_some() || !of_plant || others.contains(&&*key),
            "{key}"
        );
        let Some(number) = known.or(given.map(|(_, number)| *number)) else {
            continue;
        };
        let range = Unit::of_key(&key).range(number.range);
        let words = match range.end().is_finite() {
            true => format!("{} to {}", range.start(), range.end()),
            false => format!("at least {}", range.start()),
        };
        assert_eq!(row.range, words, "{key}");
    }
    let numbers = registry::all().filter(|number| number.device_key.is_some());
    assert_eq!(of_device, 2 * numbers.count());
}

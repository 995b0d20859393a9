//! The keys as they are declared are held against what the program does, and scenarios/README.md against them.

use std::collections::BTreeMap;

use toml::{Table, Value};

use super::super::AnyScenario;
use super::super::bench_file::BenchFile;
use super::super::file::ScenarioFile;
use super::super::recorded_cell::RecordedCellFile;
use super::{MINIMAL, MINIMAL_BENCH, read_any, scenarios};
use crate::keys::declaration::{Key, tables};
use crate::keys::suggestion::join;
use crate::unit::Unit;

/// Which of the two formats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Cell,
    Bench,
}

use Format::{Bench, Cell};

/// A key in words.
struct Row {
    unit: String,
    default: String,
    range: String,
}

/// The tables of a kind of file, and its word in scenarios/README.md.
type Kind = (&'static str, Vec<(String, Vec<Key>)>);

fn kinds() -> [Kind; 3] {
    [
        ("cell", tables::<ScenarioFile>()),
        ("bench", tables::<BenchFile>()),
        ("recorded_cell", tables::<RecordedCellFile>()),
    ]
}

/// Keys of a format by dotted name, without those that a user names.
fn rows(format: Format) -> BTreeMap<String, Row> {
    let [(_, cell), (_, bench), _] = kinds();
    let tables = match format {
        Cell => cell,
        Bench => bench,
    };
    let rows = tables.iter().flat_map(|(table, keys)| {
        let own = keys.iter().filter(|key| key.row(table).is_some());
        own.map(|key| {
            let [unit, default, range, _] = key.columns();
            let row = Row {
                unit,
                default,
                range,
            };
            (join(table, key.name), row)
        })
    });
    let is_own = |(key, _): &(String, Row)| !key.contains("expect");
    rows.filter(is_own).collect()
}

/// The page with the tables of keys below its marks as the keys are declared, and the tables that it has.
fn page(text: &str) -> (String, Vec<(&str, String)>) {
    const HEAD: &str =
        "| key | unit | default | range | meaning |\n| --- | --- | --- | --- | --- |\n";
    let kinds = kinds();
    let (mut page, mut listed) = (String::new(), Vec::new());
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        page += &format!("{line}\n");
        let mark = line
            .strip_prefix("<!-- keys: ")
            .and_then(|mark| mark.strip_suffix(" -->"));
        let Some((kind, names)) = mark.and_then(|mark| mark.split_once(' ')) else {
            continue;
        };
        while lines.next_if(|line| line.starts_with('|')).is_some() {}
        page += HEAD;
        let (kind, tables) = kinds.iter().find(|(name, _)| *name == kind).unwrap();
        for name in names.split(' ') {
            let name = if name == "top" { "" } else { name };
            let (_, keys) = tables.iter().find(|(table, _)| table == name).unwrap();
            for row in keys.iter().filter_map(|key| key.row(name)) {
                page += &format!("{row}\n");
            }
            listed.push((*kind, name.to_owned()));
        }
    }
    (page, listed)
}

#[test]
fn the_page_tells_the_keys_as_they_are_declared() {
    let path = scenarios().join("README.md");
    let text = std::fs::read_to_string(&path).unwrap();
    let (page, listed) = page(&text);
    if std::env::var_os("IDC_UPDATE_SCHEMAS").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    assert!(
        text == page,
        "scenarios/README.md differs from the keys; IDC_UPDATE_SCHEMAS=1 writes it anew"
    );
    // Those of a cell stand for those of the others that are the same.
    let [(_, cell), ..] = kinds();
    for (kind, tables) in kinds() {
        for (table, keys) in &tables {
            let same = |keys: &[Key]| keys.iter().map(|key| key.row("")).collect::<Vec<_>>();
            let of_cell = cell
                .iter()
                .any(|(own, others)| own == table && same(others) == same(keys));
            let is_listed = |kind| {
                listed
                    .iter()
                    .any(|(own, name)| *own == kind && name == table)
            };
            let is_by_pass = table == "pass.expect.*";
            let is_top = table.is_empty();
            assert!(
                is_listed(kind) || (of_cell && is_listed("cell")) || is_by_pass || is_top,
                "{kind}: {table}"
            );
        }
    }
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
                    cell.assumed.clear();
                    &mut cell.device
                }
                AnyScenario::Bench(bench) => &mut bench.device,
            };
            device.assumed.clear();
            Ok(format!("{scenario:?}"))
        }
        Err(error) => Err(error.to_string()),
    }
}

#[test]
fn every_unit_is_that_of_the_key() {
    for (key, row) in [Cell, Bench].into_iter().flat_map(rows) {
        let unit = Unit::of_key(&key);
        if unit.is_one() {
            let words = [
                "number",
                "whole number",
                "text",
                "true or false",
                "file",
                "list",
            ];
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
                        "in URScript",
                        "by the robot's name",
                        "see docs/",
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

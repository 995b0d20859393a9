//! The JSON Schemas of assets/schemas are those of the program, take every file that the project ships, and do not take what the program refuses.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::common::project;

/// Set, the schemas are written anew.
const UPDATE: &str = "IDC_UPDATE_SCHEMAS";
const KINDS: [&str; 8] = [
    "scenario",
    "rig",
    "arm",
    "postures",
    "import",
    "study",
    "device",
    "removal_table",
];

fn printed(kind: &str) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_idc"))
        .args(["schema", kind])
        .output()
        .unwrap();
    assert!(output.status.success());
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Says of a file's content whether it is one of its kind, and if not, why.
struct Judge {
    schemas: boon::Schemas,
    index: boon::SchemaIndex,
}

impl Judge {
    fn new(kind: &str) -> Self {
        let mut schemas = boon::Schemas::new();
        let mut compiler = boon::Compiler::new();
        compiler.add_resource("idc.json", printed(kind)).unwrap();
        let index = compiler.compile("idc.json", &mut schemas).unwrap();
        Self { schemas, index }
    }

    fn verdict(&self, text: &str) -> Result<(), String> {
        let table: toml::Table = text.parse().unwrap();
        let value = json(&toml::Value::Table(table));
        let verdict = self.schemas.validate(&value, self.index);
        verdict.map_err(|error| error.to_string())
    }
}

/// JSON has no infinity; a large number is as good here.
fn json(value: &toml::Value) -> Value {
    match value {
        toml::Value::Float(number) if number.is_infinite() => 1e300_f64.copysign(*number).into(),
        toml::Value::Array(values) => values.iter().map(json).collect(),
        toml::Value::Table(table) => {
            let pairs = table.iter().map(|(key, value)| (key.clone(), json(value)));
            Value::Object(pairs.collect())
        }
        other => serde_json::to_value(other).unwrap(),
    }
}

fn tomls(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(project(folder)).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let mut paths: Vec<PathBuf> = paths
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    paths.sort();
    paths
}

/// Every file of a kind that the project has.
fn shipped(kind: &str) -> Vec<PathBuf> {
    let one = |path: &str| vec![project(path)];
    match kind {
        "scenario" => [
            tomls("scenarios"),
            one("scenarios/studies/landing.toml"),
            one("scenarios/studies/moved_surface.toml"),
            one("scenarios/studies/wavy_edge.toml"),
            one("tests/lab_cell.toml"),
            one("assets/new/cell.toml"),
        ]
        .concat(),
        "rig" => {
            let cases = std::fs::read_dir(project("assets/proof/cases")).unwrap();
            let cases = cases.map(|case| case.unwrap().path().join("rig.toml"));
            [
                tomls("assets/rigs"),
                one("assets/new/rig.toml"),
                cases.collect(),
            ]
            .concat()
        }
        "arm" => one("tests/recorded_arm.toml"),
        "postures" => one("assets/new/postures.toml"),
        "import" => [
            tomls("assets/import"),
            one("assets/new/import.toml"),
            one("assets/first/map.toml"),
        ]
        .concat(),
        "study" => one("scenarios/studies/device_design.toml"),
        "device" => one("models/device.toml"),
        "removal_table" => one("assets/new/removal_table.toml"),
        other => panic!("{other}"),
    }
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn they_stand_in_the_project_as_they_are_printed() {
    for kind in KINDS {
        let path = project(&format!("assets/schemas/{kind}.json"));
        let text = format!("{:#}\n", printed(kind));
        if std::env::var_os(UPDATE).is_some() {
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, &text).unwrap();
        }
        assert!(
            std::fs::read_to_string(&path).is_ok_and(|kept| kept == text),
            "{} is not what `idc schema {kind}` prints; {UPDATE}=1 writes it anew",
            path.display()
        );
    }
}

#[test]
fn every_file_of_the_project_is_taken() {
    let mut count = 0;
    for kind in KINDS {
        let judge = Judge::new(kind);
        for path in shipped(kind) {
            let verdict = judge.verdict(&read(&path));
            assert_eq!(verdict, Ok(()), "{} as a {kind}", path.display());
            count += 1;
        }
    }
    assert!(count > 45, "{count} files");
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table")]
fn slips_of_the_pen_are_not() {
    for (kind, file, from, to) in [
        (
            "scenario",
            "scenarios/plate_edge.toml",
            "force_n = 150",
            "froce_n = 150",
        ),
        (
            "scenario",
            "scenarios/plate_edge.toml",
            "force_n = 150",
            "force_n = -150",
        ),
        (
            "scenario",
            "scenarios/plate_edge.toml",
            "force_n = 150",
            "force_n = \"150\"",
        ),
        (
            "scenario",
            "scenarios/plate_edge.toml",
            "force_n = 150\n",
            "\n",
        ),
        ("scenario", "scenarios/plate_edge.toml", "\"mm\"", "\"cm\""),
        (
            "scenario",
            "scenarios/plate_edge.toml",
            "force_mean_n",
            "froce_mean_n",
        ),
        (
            "scenario",
            "scenarios/paper_step.toml",
            "[bench]",
            "[bensh]",
        ),
        (
            "scenario",
            "scenarios/hand_push.toml",
            "position_mm =",
            "position =",
        ),
        (
            "scenario",
            "tests/lab_cell.toml",
            "servo_bandwidth_hz =",
            "servo_bandwidth_hz = -1 #",
        ),
        ("rig", "assets/new/rig.toml", "bore_m", "bore_mm"),
        (
            "rig",
            "assets/new/rig.toml",
            "bore_m = 0.0211",
            "bore_m = 21.1",
        ),
        (
            "rig",
            "assets/new/rig.toml",
            "value = 1.0, tolerance",
            "value = 1.0, tolerence",
        ),
        (
            "rig",
            "assets/new/rig.toml",
            "value = 3.17, tolerance = 0.007",
            "value = 3.17, tolerance = 7",
        ),
        (
            "rig",
            "assets/rigs/emps.toml",
            "\"driven_slide\"",
            "\"driven_slid\"",
        ),
        ("import", "assets/new/import.toml", "separator", "seperator"),
        ("import", "assets/new/import.toml", "\"text\"", "\"txt\""),
        (
            "import",
            "assets/new/import.toml",
            "column = \"valve\"",
            "column = 0",
        ),
        (
            "study",
            "scenarios/studies/device_design.toml",
            "minimise_over",
            "minimize_over",
        ),
        (
            "study",
            "scenarios/studies/device_design.toml",
            "front_points = ",
            "front_points = 1 #",
        ),
        (
            "device",
            "models/device.toml",
            "bore_mm = 32",
            "bore_mm = 320",
        ),
        (
            "arm",
            "tests/recorded_arm.toml",
            "gain_n_m_per_a",
            "gain_nm_per_a",
        ),
        (
            "arm",
            "tests/recorded_arm.toml",
            "value = 11.0, tolerance",
            "value = 11.0, tolerence",
        ),
        (
            "arm",
            "tests/recorded_arm.toml",
            "link_mass_tolerance = 0.03",
            "link_mass_tolerance = 3",
        ),
        (
            "postures",
            "assets/new/postures.toml",
            "axes = \"sensor\"",
            "axes = \"tool\"",
        ),
        (
            "postures",
            "assets/new/postures.toml",
            "tool_mass_kg",
            "tool_weight_kg",
        ),
        (
            "removal_table",
            "assets/new/removal_table.toml",
            "fit = ",
            "fits = ",
        ),
        (
            "removal_table",
            "assets/new/removal_table.toml",
            "\"preston\"",
            "\"prestom\"",
        ),
        (
            "removal_table",
            "assets/new/removal_table.toml",
            "unit = \"N\"",
            "unit = \"lbf\"",
        ),
        (
            "removal_table",
            "assets/new/removal_table.toml",
            "force_n\", unit",
            "force_n\", scatter_percent = 3, unit",
        ),
        (
            "removal_table",
            "assets/new/removal_table.toml",
            "kind = \"removal_table\"",
            "kind = \"bench\"",
        ),
        (
            "removal_table",
            "assets/new/removal_table.toml",
            "law = \"preston\"",
            "wear_rate = -1\nlaw = \"preston\"",
        ),
    ] {
        let text = read(&project(file));
        assert!(text.contains(from), "{file} holds no {from:?}");
        let spoiled = text.replacen(from, to, 1);
        assert!(
            Judge::new(kind).verdict(&spoiled).is_err(),
            "{file}: {to:?}"
        );
    }
}

/// A key's meaning, unit, range and default are shown by an editor as the pages tell them.
#[test]
fn keys_are_described() {
    let scenario = printed("scenario");
    let cell = &scenario["else"]["else"]["properties"];
    let force = &cell["process"]["properties"]["force_n"];
    assert_eq!(
        (&force["minimum"], &force["maximum"]),
        (&0.1.into(), &5000.0.into())
    );
    let settle = &cell["process"]["properties"]["settle_time_s"];
    assert_eq!(settle["default"], 1);
    let text = settle["description"].as_str().unwrap();
    assert!(text.contains("[s]") && text.contains("0 to 60"), "{text}");
    let step = &scenario["then"]["properties"]["bench"]["properties"]["duration_s"];
    assert!(step["description"].as_str().unwrap().contains("[s]"));
    let bore = &printed("rig")["properties"]["cylinder"]["properties"]["bore_m"];
    assert_eq!(bore["anyOf"][0]["maximum"], 0.3);
    assert!(
        bore["description"]
            .as_str()
            .unwrap()
            .contains("piston diameter [m]")
    );
    // Every key of every table is described; those of rig files, effects by the dozen, by the one number that they are.
    let mut bare = Vec::new();
    for (name, schema) in [
        ("cell", &scenario["else"]["else"]),
        ("bench", &scenario["then"]),
        ("arm", &printed("arm")),
        ("postures", &printed("postures")),
        ("import", &printed("import")),
        ("study", &printed("study")),
        ("removal_table", &printed("removal_table")),
    ] {
        undescribed(name, schema, &mut bare);
    }
    assert_eq!(bare, Vec::<String>::new());
}

fn undescribed(path: &str, schema: &Value, found: &mut Vec<String>) {
    let Some(properties) = schema["properties"].as_object() else {
        return;
    };
    for (key, property) in properties {
        let path = format!("{path}.{key}");
        if property["description"].as_str().is_none_or(str::is_empty) {
            found.push(path.clone());
        }
        undescribed(&path, property, found);
        undescribed(&path, &property["items"], found);
        undescribed(&path, &property["additionalProperties"], found);
    }
}

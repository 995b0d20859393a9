//! A rig file as the device of a bench.

use std::path::PathBuf;

use super::super::bench::LoadScenario;
use super::super::rig_file::tests::RIG;
use super::super::{BenchScenario, ScenarioError, load, load_bench};
use super::{MINIMAL, MINIMAL_BENCH};
use crate::plant::ContactLaw;

const LOAD_CELL: &str = "kind = \"load_cell\"\nposition_mm = 20\n";

/// A folder with a rig and a scenario that takes it.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new(rig: &str, scenario: &str, from: &str, to: &str) -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        std::fs::write(folder.path("rig.toml"), rig).unwrap();
        let text = scenario.replace("../models/device.toml", "rig.toml");
        assert!(text.contains(from), "{from}");
        std::fs::write(folder.path("bench.toml"), text.replace(from, to)).unwrap();
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }
}

fn read(rig: &str, from: &str, to: &str) -> Result<BenchScenario, ScenarioError> {
    load_bench(&Folder::new(rig, MINIMAL_BENCH, from, to).path("bench.toml"))
}

fn refused(rig: &str, from: &str, to: &str, says: &str) {
    let message = read(rig, from, to).unwrap_err().to_string();
    assert!(message.contains(says), "{message}\nlacks {says:?}");
}

#[test]
fn the_rig_brings_its_device_weight_and_contact() {
    let bench = read(RIG, "kind = \"free\"\n", LOAD_CELL).unwrap();
    assert_eq!(bench.nominal.device.bore, 0.025);
    assert_eq!(bench.nominal.device.regulator.dead_time, 0.0);
    assert_eq!(bench.nominal.gravity_along_extension, -9.81);
    let contact = bench.nominal.contact;
    assert_eq!(
        contact.law,
        ContactLaw::Linear {
            stiffness: 211_000.0
        }
    );
    assert_eq!(contact.damping, 388.0);
    assert_eq!(bench.nominal.sensors, crate::plant::SensorErrors::NONE);
}

#[test]
fn what_the_bench_gives_itself_counts() {
    let given = format!("{LOAD_CELL}stiffness_n_per_m = 3e5\n");
    let bench = read(RIG, "kind = \"free\"\n", &given).unwrap();
    let contact = bench.nominal.contact;
    assert_eq!(contact.law, ContactLaw::Linear { stiffness: 3e5 });
    assert_eq!(contact.damping, 388.0);
    let level = "duration_s = 6\ngravity_along_extension_m_per_s2 = 0";
    let bench = read(RIG, "duration_s = 6", level).unwrap();
    assert_eq!(bench.nominal.gravity_along_extension, 0.0);
}

#[test]
fn effects_come_with_it() {
    let effects = "
[effect.hertzian_contact]
stiffness_n_per_m15 = 2e7
[effect.surface_offset]
offset_m = 0.001
[effect.axial_force_offset]
force_n = -12
[effect.force_sensor_gain_error]
gain = 1.05
";
    let bench = read(&(RIG.to_owned() + effects), "kind = \"free\"\n", LOAD_CELL).unwrap();
    let LoadScenario::Contact { position, .. } = bench.load else {
        panic!("{:?}", bench.load);
    };
    let contact = bench.nominal.contact;
    assert_eq!(contact.law, ContactLaw::Hertz { stiffness: 2e7 });
    assert_eq!((position, contact.surface_offset), (0.02, 0.001));
    assert_eq!(bench.nominal.device.axial_load.force, -12.0);
    assert_eq!(bench.nominal.sensors.force_gain, 1.05);
}

#[test]
fn what_has_no_counterpart_is_refused_by_name() {
    let free = "kind = \"free\"\n";
    refused(
        &(RIG.to_owned() + "\n[effect.channel_time_offset]\noffset_s = -0.01\n"),
        free,
        free,
        "bench.toml:5:1: `device.model` cannot stand here: its channel_time_offset has a negative offset_s",
    );
    refused(
        RIG,
        "[bench]",
        "[device.override]\nbore_mm = 32\n[bench]",
        "bench.toml:7:1: `device.override.bore_mm` cannot stand here: device.model is a rig file",
    );
    refused(
        RIG,
        "[bench]",
        "locked = true\n[bench]",
        "`device.locked` cannot stand here: a bench has no locked device",
    );
    refused(
        &RIG.replace("bore_m = 0.025", "bore_m = 25"),
        free,
        free,
        "rig.toml:6:1: `cylinder.bore_m` is 25 m",
    );
    let cell = Folder::new(RIG, MINIMAL, "schema = 1", "schema = 1");
    let message = load(&cell.path("bench.toml")).unwrap_err().to_string();
    assert!(
        message
            .contains("`device.model` is \"rig.toml\", a rig file, expected a device model file"),
        "{message}"
    );
}

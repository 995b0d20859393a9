//! Files that are right, and what is said of those that are not.

use std::path::{Path, PathBuf};

use glam::DVec3;

use super::*;
use crate::recorded_arm::law::{Factor, JointLaw, Shape, Variable};
use crate::recorded_arm::parameters::set_mass;
use crate::recorded_arm::push::Push;
use crate::recorded_arm::wrench::Crosstalk;
use crate::recorded_arm::{PointMass, Quantity};

/// A rail, a turning joint and an endless one, without limits of drives.
const URDF: &str = r#"<robot name="three">
  <link name="base"/>
  <link name="carriage"><inertial><origin xyz="0 0 0.1"/><mass value="20"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="upper"><inertial><origin xyz="0 0 0.3"/><mass value="8"/><inertia ixx="0.3" iyy="0.3" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="hand"><inertial><origin xyz="0 0 0.05"/><mass value="2"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="flange"/>
  <joint name="rail" type="prismatic"><parent link="base"/><child link="carriage"/><axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="0" velocity="0"/></joint>
  <joint name="shoulder" type="revolute"><parent link="carriage"/><child link="upper"/><origin xyz="0 0 0.4"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="100" velocity="3"/></joint>
  <joint name="wrist" type="continuous"><parent link="upper"/><child link="hand"/><origin xyz="0 0 0.6"/><axis xyz="0 0 1"/></joint>
  <joint name="face" type="fixed"><parent link="hand"/><child link="flange"/><origin xyz="0 0 0.1"/></joint>
</robot>"#;

/// Columns count the shoulder first and the rail last.
const TOML: &str = r#"kind = "recorded_arm"
schema = 1

[arm]
urdf = "three.urdf"
flange = "flange"
gravity_m_per_s2 = [0, 0, -9.81]
link_mass_tolerance = 0.03
link_centre_tolerance_m = 0.005

[[drive]]
joint = "shoulder"
gain_n_m_per_a = { value = 10.0, tolerance = 0.1 }      # as its maker says
motor_inertia_kg_m2 = { value = 1.5, tolerance = 0.3 }
coulomb_friction_n_m = { value = 6.0, tolerance_n_m = 2.0 }
viscous_friction_n_m_s_per_rad = 8.0

[[drive]]
joint = "wrist"
gain_n_m_per_a = 5.0

[[drive]]
joint = "rail"
coulomb_friction_n_m = { value = 30.0, low = 20.0, high = 60.0 }

[load]
mass_kg = { value = 1.0, tolerance_kg = 0.5 }
centre_m = { value = [0.0, 0.1, 0.2], tolerance_m = 0.02 }

[wrench_sensor]
height_m = 0.03
rotation_z_rad = 0.5
zero_force_n = { value = [0.0, 1.0, 0.0], tolerance_n = 0.5 }
tool_mass_kg = { value = 2.0, tolerance = 0.02 }
tool_centre_m = [0.0, 0.0, 0.08]
tool_inertia_kg_m2 = [0.002, 0.003, 0.001]

[sensors]
rate_hz = 100
joint_rad = 1e-6
current_a = [0.03, 0.02, 0.01]
torque_n_m = [0.3, 0.2, 0.1]
wrench_force_n = 0.2
wrench_torque_n_m = 0.01

[recordings]
fit = ["path.csv", "slow_*.csv"]
predict = "other.csv"
"#;

fn folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("three.urdf"), URDF).unwrap();
    let file = folder.path().join("arm.toml");
    (folder, file)
}

fn read(text: &str) -> Result<ArmFile, ScenarioError> {
    let (_folder, file) = folder();
    from_text(&file, text)
}

fn refused(from: &str, to: &str) -> String {
    assert!(TOML.contains(from), "{from}");
    read(&TOML.replace(from, to)).unwrap_err().to_string()
}

#[test]
fn drives_are_those_of_their_joints_whatever_columns_count_first() {
    let arm = read(TOML).unwrap();
    assert_eq!(arm.numbers, [3, 1, 2]);
    assert_eq!(arm.links, ["carriage", "upper", "hand"]);
    let [rail, shoulder, wrist] = &arm.nominal.drives[..] else {
        panic!("{:?}", arm.nominal.drives);
    };
    assert!(!rail.logs_current && rail.coulomb == 30.0);
    assert!(shoulder.logs_current && shoulder.viscous == 8.0);
    assert!((wrist.inverse_gain - 0.2).abs() < 1e-15);
    assert_eq!(arm.noise.drives, [Some(0.1), Some(0.03), Some(0.02)]);
    assert_eq!(arm.nominal.load.centre(), DVec3::new(0.0, 0.1, 0.2));
    assert_eq!(arm.fit.len(), 2);
}

#[test]
fn bounds_are_boxes_about_the_values() {
    let arm = read(TOML).unwrap();
    let bounds = |quantity: Quantity| {
        let own = arm.tolerated.iter().find(|t| t.quantity == quantity);
        own.map(|t| t.bounds)
    };
    let near = |quantity: Quantity, expected: [f64; 2]| {
        let found = bounds(quantity).unwrap_or_else(|| panic!("{quantity:?} is exact"));
        let apart = (0..2).map(|k| (found[k] - expected[k]).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-12, "{quantity:?}: {found:?}");
    };
    near(Quantity::InverseGain(1), [1.0 / 11.0, 1.0 / 9.0]);
    near(Quantity::Coulomb(1), [4.0, 8.0]);
    near(Quantity::Coulomb(0), [20.0, 60.0]);
    near(Quantity::LinkMass(2), [1.94, 2.06]);
    near(Quantity::LinkCentre(1, 2), [0.295, 0.305]);
    near(Quantity::LoadMass, [0.5, 1.5]);
    // Mass times centre is the least and the most of both.
    near(Quantity::LoadMoment(1), [0.5 * 0.08, 1.5 * 0.12]);
    near(Quantity::Zero(1), [0.5, 1.5]);
    near(Quantity::ToolMass, [1.96, 2.04]);
    for exact in [
        Quantity::Viscous(1),
        Quantity::InverseGain(2),
        Quantity::ToolCentre(0),
    ] {
        assert_eq!(bounds(exact), None, "{exact:?}");
    }
}

/// An arm in which every number that an effect may have is another.
fn changed(arm: &ArmFile) -> ArmParameters {
    let mut found = arm.nominal.clone();
    set_mass(&mut found.chain.joints[1].body, 9.25);
    found.chain.joints[2].body.centre_of_mass.x = 0.013;
    for (index, drive) in found.drives.iter_mut().enumerate() {
        let k = index as f64 + 1.0;
        if drive.logs_current {
            drive.inverse_gain = 0.07 * k;
        }
        drive.motor_inertia = 1.1 * k;
        drive.coulomb = 7.0 + k;
        drive.viscous = 0.3 * k;
        drive.bristle_length = 2e-4 * k;
        drive.static_excess = 1.5 * k;
        drive.stribeck_velocity = 0.02 * k;
        drive.warm_fraction = 0.1 * k;
        drive.warm_time = 11.0 * k;
        drive.offset = -3.0 + k;
        drive.ripple = [0.4 * k, -0.9];
        drive.ripple_cycles = 50.0 + k;
        drive.encoder_offset = 0.01 * k;
        drive.compliance = 1e-5 * k;
    }
    found.drives[1].spring_stiffness = 12.0;
    found.drives[2].static_excess = 0.0;
    found.drives[2].stribeck_velocity = 0.05;
    found.drives[2].load_friction = -0.04;
    found.tilt = [0.02, -0.01];
    found.load.mass = 1.25;
    found.load.moment = 1.25 * DVec3::new(0.01, 0.11, 0.19);
    found.payload = PointMass {
        mass: 2.8,
        moment: 2.8 * DVec3::new(0.02, -0.03, 0.2),
    };
    found.delay = 0.012;
    found.pushes.push(Push {
        recording: 1,
        start: 2.0,
        end: 3.5,
        edge: 0.15,
        force: DVec3::new(10.0, -20.0, 5.0),
    });
    found.laws.push(JointLaw {
        joint: 1,
        shape: Shape::Sine,
        variable: Variable::Angle,
        factor: Factor::Friction,
        amplitude: [0.5, -0.25],
        place: 3.0,
        width: 1.0,
    });
    let wrench = found.wrench.as_mut().unwrap();
    wrench.rotation = -1.25;
    wrench.zero = [1.0, 2.0, 3.0, 0.1, 0.2, 0.3];
    wrench.drift[2] = 0.05;
    wrench.gain[4] = 1.1;
    wrench.crosstalk.push(Crosstalk {
        source: 0,
        target: 4,
        share: 0.02,
    });
    wrench.tool_mass = 2.5;
    wrench.tool_centre = DVec3::new(0.01, 0.02, 0.09);
    found
}

fn near(one: &ArmParameters, other: &ArmParameters) {
    // Nine digits are written.
    let numbers = |arm: &ArmParameters| -> Vec<f64> {
        let text = format!("{arm:?}");
        let parts = text.split(|c: char| !(c.is_ascii_digit() || "+-.e".contains(c)));
        parts.filter_map(|part| part.parse().ok()).collect()
    };
    let (one, other) = (numbers(one), numbers(other));
    assert_eq!(one.len(), other.len());
    for (a, b) in one.iter().zip(&other) {
        assert!(
            a == b || (a - b).abs() <= 2e-8 * a.abs().max(b.abs()) + 1e-12,
            "{a} and {b}"
        );
    }
}

#[test]
fn what_was_found_reads_back() {
    let (_folder, file) = folder();
    let arm = from_text(&file, TOML).unwrap();
    let recordings = ["path.csv".to_owned(), "slow_1.csv".to_owned()];
    let found = changed(&arm);
    let text = improved_arm_text(&arm, &found, &recordings);
    assert!(text.contains("# as its maker says"), "{text}");
    let elsewhere = Path::new("improved.toml");
    let read = from_text(elsewhere, &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    near(&read.arm(&recordings), &found);
    // Once more, and back to what the first file said.
    let again = improved_arm_text(&read, &found, &recordings);
    near(
        &from_text(elsewhere, &again).unwrap().arm(&recordings),
        &found,
    );
    let back = improved_arm_text(&read, &arm.nominal, &recordings);
    let back = from_text(elsewhere, &back).unwrap();
    near(&back.arm(&recordings), &arm.nominal);
    // Tolerances stay about the new values, but for ends that no longer hold theirs: the rail's friction.
    assert_eq!(read.tolerated.len() + 1, arm.tolerated.len());
}

#[test]
fn a_push_acts_in_its_recording_alone() {
    let text = format!(
        "{TOML}\n[[effect]]\nname = \"outside_push\"\nrecording = \"slow_2.csv\"\nstart_s = 1\nend_s = 2\nforce_n = 30\n"
    );
    let arm = read(&text).unwrap();
    let names = ["path.csv", "slow_2.csv"].map(str::to_owned);
    assert_eq!(arm.arm(&names).pushes[0].recording, 1);
    assert_eq!(arm.arm(&names[..1]).pushes[0].recording, usize::MAX);
}

#[test]
fn what_cannot_be_is_refused_by_its_key() {
    for (from, to, said) in [
        (
            "joint = \"wrist\"",
            "joint = \"wirst\"",
            "a moving joint of the URDF",
        ),
        ("joint = \"wrist\"", "joint = \"rail\"", "each joint once"),
        (
            "tolerance_n_m = 2.0",
            "tolerance_n = 2.0",
            "`tolerance_n_m`",
        ),
        (
            "low = 20.0, high = 60.0",
            "low = 40.0, high = 60.0",
            "at most the value",
        ),
        (
            "low = 20.0, high = 60.0",
            "low = 20.0, high = 1e300",
            ".high` is 1e300, expected -1000000 to 1100000 N m",
        ),
        (
            "value = 10.0, tolerance = 0.1",
            "value = 10.0, tolerance = 1.5",
            "0 to 1",
        ),
        (
            "value = 10.0, tolerance = 0.1",
            "value = 10.0, tolerence = 0.1",
            "did you mean `tolerance`",
        ),
        (
            "current_a = [0.03, 0.02, 0.01]",
            "current_a = [0.03, 0.02]",
            "3 numbers, one a drive",
        ),
        ("current_a = [0.03, 0.02, 0.01]\n", "", "current_a"),
        (
            "urdf = \"three.urdf\"",
            "urdf = \"four.urdf\"",
            "an existing file",
        ),
        ("flange = \"flange\"", "flange = \"flunge\"", "flunge"),
        ("wrench_force_n = 0.2\n", "", "wrench_force_n"),
        (
            "link_mass_tolerance = 0.03",
            "link_mass_tolerance = 3",
            "0 to 0.95",
        ),
        (
            "[load]",
            "[[link]]\nname = \"elbow\"\n[load]",
            "a link behind a moving joint",
        ),
        (
            "[load]",
            "[[effect]]\nname = \"payloud\"\n[load]",
            "did you mean `payload`",
        ),
        (
            "[load]",
            "[[effect]]\nname = \"joint_torque_offset\"\njoint = 4\noffset_n_m = 1\n[load]",
            "1 to 3",
        ),
        (
            "[load]",
            "[[effect]]\nname = \"joint_torque_offset\"\njoint = 2\n[load]",
            "in N m",
        ),
        (
            "[load]",
            "[[effect]]\nname = \"drive_gain_error\"\njoint = 3\ngain_n_m_per_a = 3\n[load]",
            "no gain_n_m_per_a",
        ),
        (
            "[load]",
            "[[law]]\njoint = 1\nshape = \"hill\"\nover = \"speed\"\nfactors = [1]\n[load]",
            "shape",
        ),
    ] {
        let text = refused(from, to);
        assert!(text.contains(said) && text.contains("arm.toml"), "{text}");
    }
    let second = TOML.find("[[drive]]\njoint = \"rail\"").unwrap();
    let end = TOML.find("[load]").unwrap();
    let without = TOML[..second].to_owned() + &TOML[end..];
    let text = read(&without).unwrap_err().to_string();
    assert!(
        text.contains("rail") && text.contains("[[drive]]"),
        "{text}"
    );
}

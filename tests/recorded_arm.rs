//! A recorded arm is a case: its readings are those of a pendulum on a rail, by formulas of the test's own, and what cannot be a log of it is refused.

use std::fmt::Write as _;

use crate::common::shared;
use crate::program::Bench;

/// A rail along x that carries a turning joint about y, whose link hangs its mass along z.
const URDF: &str = r#"<robot name="crane">
  <link name="base"/>
  <link name="carriage"><inertial><origin xyz="0 0 0"/><mass value="12"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="boom"><inertial><origin xyz="0 0 0.4"/><mass value="5"/><inertia ixx="0.2" iyy="0.2" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="flange"/>
  <joint name="rail" type="prismatic"><parent link="base"/><child link="carriage"/><axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="500" velocity="2"/></joint>
  <joint name="shoulder" type="revolute"><parent link="carriage"/><child link="boom"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="100" velocity="3"/></joint>
  <joint name="face" type="fixed"><parent link="boom"/><child link="flange"/><origin xyz="0 0 0.8"/></joint>
</robot>"#;

const ARM: &str = r#"kind = "recorded_arm"
schema = 1

[arm]
urdf = "crane.urdf"
flange = "flange"
gravity_m_per_s2 = [0, 0, -9.81]

[[drive]]
joint = "shoulder"
gain_n_m_per_a = { value = 8.0, tolerance = 0.1 }
motor_inertia_kg_m2 = { value = 0.7, tolerance = 0.3 }
viscous_friction_n_m_s_per_rad = { value = 3.0, tolerance = 0.3 }

[[drive]]
joint = "rail"
viscous_friction_n_m_s_per_rad = 20.0

[load]
mass_kg = 0.0

[sensors]
rate_hz = 100
joint_rad = 1e-6
current_a = [0.02, 0.02]
torque_n_m = [0.5, 0.5]

[recordings]
fit = ["path_*.csv"]
predict = "other.csv"
"#;

const GRAVITY: f64 = 9.81;

/// Uniform from -1 to 1.
fn noise(state: &mut u64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// A log; `speed` scales its motion's frequencies.
fn log(speed: f64, measured: bool) -> String {
    let mut text = String::from("time_s,joint_1_rad,joint_2_m");
    text += if measured {
        ",joint_1_current_a,joint_2_force_n\n"
    } else {
        "\n"
    };
    let mut state = 7;
    let (m, r, inertia) = (5.0, 0.4, 0.2 + 5.0 * 0.4 * 0.4);
    for i in 0..2000 {
        let t = 0.01 * f64::from(i);
        let (a, b) = (1.3 * speed, 0.9 * speed);
        let q = 0.8 * (a * t).sin();
        let (qd, qdd) = (0.8 * a * (a * t).cos(), -0.8 * a * a * (a * t).sin());
        let x = 0.3 * (b * t).cos();
        let (xd, xdd) = (-0.3 * b * (b * t).sin(), -0.3 * b * b * (b * t).cos());
        let _ = write!(text, "{t:.2},{q:.7},{x:.7}");
        if measured {
            // The mass is at (x + r sin q, r cos q): Lagrange.
            let torque = (inertia + 0.7) * qdd + m * r * q.cos() * xdd - m * GRAVITY * r * q.sin()
                + 3.0 * qd;
            let force = 17.0 * xdd + m * r * (q.cos() * qdd - q.sin() * qd * qd) + 20.0 * xd;
            let current = torque / 8.0 + 0.03 * noise(&mut state);
            let force = force + 0.8 * noise(&mut state);
            let _ = write!(text, ",{current:.5},{force:.4}");
        }
        text.push('\n');
    }
    text
}

fn bench() -> Bench {
    let bench = Bench::new("plate_edge_ideal");
    std::fs::create_dir(bench.path("crane")).unwrap();
    bench.write("crane/crane.urdf", URDF);
    bench.write("crane/arm.toml", ARM);
    bench.write("crane/path_1.csv", log(1.0, true));
    bench.write("crane/path_2.csv", log(1.4, true));
    bench.write("crane/other.csv", log(1.2, false));
    bench
}

#[test]
fn readings_are_those_of_lagrange_whatever_columns_count_first() {
    let bench = bench();
    let arguments = ["predict", "crane/arm.toml", "crane/path_2.csv", "--json"];
    let outcome = bench.idc(&arguments, &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let said: serde_json::Value = serde_json::from_str(&outcome.out).unwrap();
    let rms = said["rms_in_standard_deviations_of_noise"]
        .as_object()
        .unwrap();
    assert_eq!(rms.len(), 2, "{said}");
    for (column, rms) in rms {
        let rms = rms.as_f64().unwrap();
        assert!((0.7..1.2).contains(&rms), "{column}: {rms}");
    }
}

#[test]
fn a_folder_with_an_arm_is_checked_diagnosed_and_predicted() {
    let bench = bench();
    let checked = bench.idc(&["check", "crane"], &[]);
    assert_eq!(checked.code, 0, "{}", checked.err);
    for said in [
        "1 shoulder, 2 rail (prismatic)",
        "path_2.csv",
        "joint_2_force_n",
    ] {
        assert!(checked.out.contains(said), "{}", checked.out);
    }
    let outcome = bench.idc(&["diagnose", "crane", "--out", "found", "--quiet"], &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let prediction = std::fs::read_to_string(bench.path("found/prediction.csv")).unwrap();
    assert!(
        prediction.starts_with("time_s,joint_2_force_n,joint_1_current_a\n"),
        "{prediction:.60}"
    );
    assert_eq!(prediction.lines().count(), 2001);
    // The improved file may stand anywhere and says the same.
    let arguments = [
        "predict",
        "found/improved.toml",
        "crane/other.csv",
        "--out",
        "again.csv",
    ];
    let again = bench.idc(&arguments, &[]);
    assert_eq!(again.code, 0, "{}", again.err);
    let again = std::fs::read_to_string(bench.path("again.csv")).unwrap();
    assert_eq!(again, prediction);
    // A folder of such folders.
    let all = bench.idc(&["diagnose", ".", "--all", "--out", "many"], &[]);
    assert_eq!(all.code, 0, "{}", all.err);
    assert!(all.out.contains("crane"), "{}", all.out);
}

#[test]
fn what_cannot_be_a_log_of_the_arm_is_refused_with_what_to_do() {
    let scaled = |text: &str, column: usize, factor: f64| -> String {
        let line = |(at, line): (usize, &str)| match at {
            0 => line.to_owned(),
            _ => {
                let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
                let value: f64 = fields[column].parse().unwrap();
                fields[column] = format!("{}", value * factor);
                fields.join(",")
            }
        };
        text.lines().enumerate().map(|l| line(l) + "\n").collect()
    };
    let path = log(1.0, true);
    let head =
        |count: usize| -> String { path.lines().take(count).map(|l| format!("{l}\n")).collect() };
    let torques = path.replace("joint_1_current_a", "joint_1_torque_n_m");
    let restarted = head(300) + path.lines().nth(1).unwrap() + "\n";
    let one_way = head(110);
    let third = path.replace("joint_2_m,", "joint_3_m,");
    let named = path.replace("joint_1_rad,", "shoulder_rad,");
    for (content, said) in [
        (
            scaled(&path, 1, 57.3),
            &["degrees", "joint_1_rad", "path_1.csv:"][..],
        ),
        (scaled(&path, 2, 1000.0), &["mm", "joint_2"]),
        (torques, &["joint_1_torque_n_m", "gain_n_m_per_a"]),
        (
            path.replace("joint_2_force_n", "joint_2_current_a"),
            &["has no gain", "joint_2_current_a"],
        ),
        (third, &["joint 3", "joints 1 to 2"]),
        (
            path.replace("joint_2_m,", "joint_2_command_m,"),
            &["joint_2", "positions of all 2 joints"],
        ),
        (head(60), &["59 samples", "at least 100"]),
        (restarted, &["path_1.csv:301", "starts again"]),
        (one_way, &["shorter than a period"]),
    ] {
        let bench = bench();
        std::fs::remove_file(bench.path("crane/path_2.csv")).unwrap();
        bench.write("crane/path_1.csv", &content);
        let outcome = bench.idc(&["diagnose", "crane", "--out", "found"], &[]);
        assert_eq!(outcome.code, 2, "{said:?}: {}", outcome.err);
        for word in said {
            assert!(outcome.err.contains(word), "{word}: {}", outcome.err);
        }
        assert!(!bench.path("found").exists());
    }
    // By the names of the URDF, and torques of both drives in columns of currents.
    let bench = bench();
    bench.write("crane/path_1.csv", named);
    let outcome = bench.idc(&["check", "crane"], &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let both = ARM.replace("joint = \"rail\"", "joint = \"rail\"\ngain_n_m_per_a = 40");
    bench.write("crane/arm.toml", both);
    let currents = scaled(&scaled(&path, 3, 8.0), 4, 1.0);
    let currents = currents.replace("joint_2_force_n", "joint_2_current_a");
    for file in ["crane/path_1.csv", "crane/path_2.csv"] {
        bench.write(file, &currents);
    }
    let outcome = bench.idc(&["diagnose", "crane", "--out", "found"], &[]);
    assert_eq!(outcome.code, 2, "{}", outcome.err);
    assert!(
        outcome.err.contains("looks like a torque"),
        "{}",
        outcome.err
    );
}

#[test]
fn a_new_arm_is_made_of_urdf_and_log_and_says_what_it_does_not_know() {
    let bench = bench();
    let log = log(1.0, true).replace("joint_2_m", "joint_2_rad");
    let arm = log
        .replace("joint_1_", "joint_x_")
        .replace("joint_2_", "joint_1_")
        .replace("joint_x_", "joint_2_");
    bench.write("crane/log.csv", &arm);
    let arguments = [
        "new",
        "arm",
        "crane/new.toml",
        "--urdf",
        "crane/crane.urdf",
        "--log",
        "crane/log.csv",
    ];
    let outcome = bench.idc(&arguments, &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let text = std::fs::read_to_string(bench.path("crane/new.toml")).unwrap();
    assert!(
        text.contains("NOT KNOWN") && text.contains("urdf = \"crane.urdf\""),
        "{text}"
    );
    assert!(
        text.contains("fit = [\"log.csv\"]") && text.contains("rate_hz = 100.0"),
        "{text}"
    );
    let checked = bench.idc(&["check", "crane/new.toml"], &[]);
    assert_eq!(checked.code, 0, "{}", checked.err);
    let without = bench.idc(&["new", "arm", "crane/other.toml"], &[]);
    assert_eq!(without.code, 2);
    assert!(without.err.contains("--urdf"), "{}", without.err);
}

/// The concealed arms of the laboratory and a real robot are read.
#[test]
fn arms_that_were_not_made_here_are_read() {
    let Some(cases) = shared("arm/practice/cases") else {
        return;
    };
    let bench = Bench::new("plate_edge_ideal");
    for case in ["case-01", "case-12", "case-20"] {
        let folder = cases.join(case).display().to_string();
        let outcome = bench.idc(&["check", &folder], &[]);
        assert_eq!(outcome.code, 0, "{case}: {}", outcome.err);
    }
}

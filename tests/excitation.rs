//! The motion that tells an arm's numbers apart: within its limits, the same each time, clear of what stands there, and better than practice.

use glamx::DPose3;
use idc_cell::arm::MAX_JOINTS;
use idc_cell::arm::kinematics::link_poses;
use idc_cell::case::logs_of;
use idc_cell::diagnosis::arm::base_parameters::base_parameters;
use idc_cell::diagnosis::arm::estimate::covariance;
use idc_cell::diagnosis::arm::evidence::Evidence;
use idc_cell::diagnosis::arm::fit::{Columns, Parameter, fit, scales_of};
use idc_cell::diagnosis::arm::hypothesis::nuisances;
use idc_cell::diagnosis::arm::identifiability::randomly_moved;
use idc_cell::diagnosis::arm::input::{ArmInput, ArmRecording};
use idc_cell::excitation::{Clearance, design};
use idc_cell::recorded_arm::motion::{Motion, cut_off_for};
use idc_cell::recorded_arm::simulate::{Channel, RigidCourse, all_bristles, readings};
use idc_cell::recorded_arm::{ArmParameters, Quantity};
use idc_cell::scenario::arm_file::load_arm_file;
use idc_cell::stats::median;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use crate::common::shared;
use crate::program::Bench;

/// Two links that swing in a vertical plane above a floor.
const URDF: &str = r#"<robot name="swing">
  <link name="base"/>
  <link name="upper"><inertial><origin xyz="0 0 0.25"/><mass value="6"/><inertia ixx="0.2" iyy="0.2" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0.25"/><geometry><cylinder radius="0.04" length="0.4"/></geometry></collision></link>
  <link name="lower"><inertial><origin xyz="0 0 0.2"/><mass value="3"/><inertia ixx="0.05" iyy="0.05" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0.2"/><geometry><cylinder radius="0.03" length="0.3"/></geometry></collision></link>
  <link name="flange"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.6"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="150" velocity="2"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="0 0 0.5"/><axis xyz="0 1 0"/><limit lower="-2.5" upper="2.5" effort="60" velocity="3"/></joint>
  <joint name="face" type="fixed"><parent link="lower"/><child link="flange"/><origin xyz="0 0 0.4"/></joint>
</robot>"#;

const ARM: &str = r#"kind = "recorded_arm"
schema = 1

[arm]
urdf = "swing.urdf"
flange = "flange"
link_mass_tolerance = 0.05

[[drive]]
joint = "shoulder"
motor_inertia_kg_m2 = { value = 1.0, tolerance = 0.3 }
coulomb_friction_n_m = { value = 4.0, tolerance = 0.3 }
viscous_friction_n_m_s_per_rad = { value = 6.0, tolerance = 0.3 }

[[drive]]
joint = "elbow"
motor_inertia_kg_m2 = { value = 0.3, tolerance = 0.3 }
coulomb_friction_n_m = { value = 2.0, tolerance = 0.3 }
viscous_friction_n_m_s_per_rad = { value = 3.0, tolerance = 0.3 }

[load]
mass_kg = 0.0

[sensors]
rate_hz = 50
torque_n_m = [0.3, 0.2]

[recordings]
fit = []
"#;

fn bench(arm: &str) -> Bench {
    let bench = Bench::new("plate_edge_ideal");
    bench.write("swing.urdf", URDF);
    bench.write("arm.toml", arm);
    bench
}

/// Rows of a file of numbers below its heading.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let numbers = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
    text.lines().skip(1).map(numbers).collect()
}

#[test]
fn a_designed_path_keeps_its_limits_and_is_the_same_each_time() {
    let bench = bench(ARM);
    let arguments = [
        "check",
        "arm.toml",
        "--design",
        "path.csv",
        "--duration-s",
        "6",
    ];
    let outcome = bench.idc(&arguments, &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    assert!(outcome.out.contains("dry friction"), "{}", outcome.out);
    let text = std::fs::read_to_string(bench.path("path.csv")).unwrap();
    let heading = "time_s,shoulder_rad,elbow_rad,shoulder_rad_per_s,elbow_rad_per_s,shoulder_rad_per_s2,elbow_rad_per_s2";
    assert_eq!(text.lines().next(), Some(heading));
    let path = rows(&text);
    assert_eq!(path.len(), 301);
    let file = load_arm_file(&bench.path("arm.toml")).unwrap();
    let mut farthest = [0.0f64; 2];
    for row in &path {
        for (joint, (limit, speed)) in [(3.0, 2.0), (2.5, 3.0)].into_iter().enumerate() {
            assert!(row[1 + joint].abs() < limit && row[3 + joint].abs() < speed);
            farthest[joint] = farthest[joint].max(row[3 + joint].abs() / speed);
        }
        // The lower link's end stays above the floor.
        let mut poses = [DPose3::IDENTITY; MAX_JOINTS];
        link_poses(
            &file.nominal.chain,
            DPose3::IDENTITY,
            &row[1..3],
            &mut poses[..2],
        );
        let end = poses[1].transform_point(glam::DVec3::Z * 0.35);
        assert!(end.z > 0.005, "{end}");
    }
    assert!(farthest.iter().all(|share| *share > 0.3), "{farthest:?}");
    // At rest at both ends.
    for row in [&path[0], &path[300]] {
        assert!(row[3..].iter().all(|v| v.abs() < 1e-9), "{row:?}");
    }
    let again = bench.idc(&arguments, &[]);
    assert_eq!(again.code, 2, "{}", again.out);
    let arguments = [&arguments[..], &["--force", "--quiet"]].concat();
    assert_eq!(bench.idc(&arguments, &[]).code, 0);
    assert_eq!(
        std::fs::read_to_string(bench.path("path.csv")).unwrap(),
        text
    );
}

#[test]
fn limits_without_room_are_one_message() {
    // A box about the arm, a motor weaker than its friction, and a file that is no arm.
    let boxed = format!(
        "{ARM}\n[[obstacle]]\nname = \"crate\"\nbox_mm = [300, 300, 2000]\nposition_mm = [0, 0, 1000]\n"
    );
    let met = bench(&boxed);
    let arguments = [
        "check",
        "arm.toml",
        "--design",
        "path.csv",
        "--duration-s",
        "6",
    ];
    let outcome = met.idc(&arguments, &[]);
    assert_eq!(outcome.code, 2);
    for said in ["arm.toml", "no path", "crate", "allowed_pairs"] {
        assert!(outcome.err.contains(said), "{}", outcome.err);
    }
    assert!(!met.path("path.csv").exists());
    let weak = bench(ARM);
    weak.write(
        "swing.urdf",
        URDF.replace("effort=\"60\"", "effort=\"1.5\""),
    );
    let outcome = weak.idc(&arguments, &[]);
    assert_eq!(outcome.code, 2);
    assert!(outcome.err.contains("elbow needs"), "{}", outcome.err);
    let other = weak.idc(&["check", "scenario.toml", "--design", "path.csv"], &[]);
    assert_eq!(other.code, 2);
    assert!(other.err.contains("no recorded arm"), "{}", other.err);
}

/// An arm whose numbers lie within their tolerances, but its gains, as declared.
fn truth(input: &ArmInput, random: &mut ChaCha8Rng) -> ArmParameters {
    let mut truth = input.nominal.clone();
    for known in &input.tolerated {
        if !matches!(known.quantity, Quantity::InverseGain(_)) {
            let [low, high] = known.bounds;
            known
                .quantity
                .set(&mut truth, random.random_range(low..=high));
        }
    }
    truth
}

/// A log of it along a motion.
fn logged(
    input: &ArmInput,
    truth: &ArmParameters,
    motion: &Motion,
    noise: f64,
    random: &mut ChaCha8Rng,
) -> ArmInput {
    let mut noisy = |size: f64, value: &f64| {
        let noise: f64 = random.sample(StandardNormal);
        value + size * noise
    };
    let rigid = RigidCourse::of(truth, motion);
    let bristles = all_bristles(truth, motion);
    let mut all = readings(truth, motion, &input.channels, &bristles, &rigid);
    for (values, size) in all.iter_mut().zip(&input.noise) {
        *values = values.iter().map(|value| noisy(*size, value)).collect();
    }
    let positions: Vec<Vec<f64>> = { motion.position.iter() }
        .map(|q| q.iter().map(|value| noisy(noise, value)).collect())
        .collect();
    let cut_off = cut_off_for(&motion.time, &positions);
    ArmInput {
        recordings: vec![ArmRecording {
            name: String::new(),
            motion: Motion::of_positions(0, &motion.time, &positions, cut_off),
            readings: all,
        }],
        ..input.clone()
    }
}

/// Half-widths of a fit to a log, and what it leaves of the worst channel over its noise.
fn fitted(input: &ArmInput, parameters: &[Parameter]) -> (Vec<f64>, f64) {
    let evidence = Evidence::of(input, &[]);
    let scales = vec![1.0; input.channels.len()];
    let start = (&input.nominal, None);
    let found = fit(
        &evidence,
        start,
        parameters,
        &scales,
        &mut Columns::default(),
    );
    let covariance = covariance(&found);
    let left = scales_of(&found.residuals).into_iter().fold(0.0, f64::max);
    let half = (0..parameters.len()).map(|i| covariance[(i, i)].sqrt());
    (half.collect(), left)
}

/// Practice arms as diagnosed: simulated along their own Fourier path and along one that is designed, as long and as often sampled; both fitted alike.
#[test]
#[ignore = "minutes: diagnoses three arms and designs a path for each"]
fn designed_paths_halve_the_half_widths_of_practice_arms() {
    let Some(cases) = shared("arm/practice/cases") else {
        return;
    };
    for name in ["case-01", "case-07", "case-12"] {
        let folder = cases.join(name);
        let bench = Bench::new("plate_edge_ideal");
        let case = folder.display().to_string();
        let diagnosed = bench.idc(&["diagnose", &case, "--out", "found", "--quiet"], &[]);
        assert_eq!(diagnosed.code, 0, "{}", diagnosed.err);
        let file = load_arm_file(&bench.path("found/improved.toml")).unwrap();
        let mut input = logs_of(&folder).unwrap().input;
        input.nominal = file.arm(&[]);
        input.tolerated.clone_from(&file.tolerated);
        input.recordings.truncate(1);
        let practice = input.recordings[0].motion.clone();
        let span = practice.time[practice.len() - 1] - practice.time[0];
        let clearance = Clearance::of(&file).unwrap();
        let start = std::time::Instant::now();
        let found = design(&file, &input, &clearance, span.round()).unwrap();
        let seconds = start.elapsed().as_secs_f64();
        let path = found.path.motion(0, file.rate);

        let mut random = ChaCha8Rng::seed_from_u64(4);
        let truth = truth(&input, &mut random);
        check_limits(&truth, &path);
        let kept = base_parameters(&Evidence::of(&randomly_moved(&input), &[])).kept;
        let free: Vec<Parameter> = { kept.iter() }
            .map(|quantity| Parameter::free(*quantity, [-1e6, 1e6]))
            .collect();
        let mut ratios = Vec::new();
        for parameters in [free, nuisances(&input)] {
            let [before, after] = [&practice, &path].map(|motion| {
                let log = logged(&input, &truth, motion, file.noise.position, &mut random);
                fitted(&log, &parameters)
            });
            assert!(before.1 < 1.3 && after.1 < 1.3, "{} {}", before.1, after.1);
            let each = after.0.iter().zip(&before.0);
            ratios.push(median(each.map(|(after, before)| after / before)).unwrap());
        }
        println!(
            "{name}: half-widths of base parameters {:.3}, within the tolerances {:.3} of practice's (median); {seconds:.0} s",
            ratios[0], ratios[1]
        );
        assert!(ratios[0] <= 0.5, "{name}: {ratios:?}");
    }
}

/// Positions, speeds and torques of the true arm within the URDF's limits.
fn check_limits(truth: &ArmParameters, path: &Motion) {
    let mut arm = truth.clone();
    arm.drives
        .iter_mut()
        .for_each(|drive| drive.inverse_gain = 1.0);
    let channels: Vec<Channel> = (0..arm.joints()).map(Channel::Drive).collect();
    let rigid = RigidCourse::of(&arm, path);
    let torques = readings(&arm, path, &channels, &all_bristles(&arm, path), &rigid);
    for (joint, own) in arm.chain.joints.iter().enumerate() {
        let within = |q: &f64| (own.lower..=own.upper).contains(q);
        assert!(path.position[joint].iter().all(within));
        assert!(path.speed[joint].iter().all(|v| v.abs() <= own.velocity));
        assert!(torques[joint].iter().all(|t| t.abs() <= own.effort));
    }
}

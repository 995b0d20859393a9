//! The four force controllers under seal friction: on the moved surface, at a step of the desired force, and in the cell; docs/CONTROL.md has the tables.

use idc_cell::control::force::limit::{dead_time_error, least_settling_time};
use idc_cell::recording::{Recording, schema};
use idc_cell::rig::Rig;
use idc_cell::scenario::bench::{BenchScenario, CommandScenario, LoadScenario};
use idc_cell::scenario::{ForceLaw, load_bench};
use idc_cell::sensing::SensingParameters;

use crate::common::{project, run, scenario};

/// Names and laws, all tuned to the device.
const LAWS: [(&str, ForceLaw); 4] = [
    ("open loop", ForceLaw::OpenLoop),
    (
        "proportional-integral",
        ForceLaw::ProportionalIntegral {
            proportional_gain: None,
            integral_gain: None,
        },
    ),
    (
        "feedback linearisation",
        ForceLaw::FeedbackLinearisation {
            rate: None,
            integral_gain: None,
        },
    ),
    (
        "disturbance prediction",
        ForceLaw::DisturbancePrediction {
            response_time: None,
            observer_time: None,
            tracking_frequency: None,
            seals: None,
            friction_uncertainty: None,
        },
    ),
];

fn moving_surface() -> BenchScenario {
    load_bench(&project("scenarios/moving_surface.toml")).unwrap()
}

fn record(bench: BenchScenario) -> Recording {
    let rig = Rig::new(bench).unwrap_or_else(|error| panic!("{error}"));
    let (recording, stop) = rig.run(&mut |_, _| ()).unwrap();
    assert!(stop.is_none(), "{stop:?}");
    recording
}

/// Times [s] and force errors [N] from a time on.
fn errors(recording: &Recording, desired: f64, from: f64) -> Vec<(f64, f64)> {
    let force = recording.values(schema::CONTACT_FORCE).unwrap();
    let samples = recording.time().iter().zip(force);
    samples
        .filter(|(time, _)| **time >= from - 1e-9)
        .map(|(time, force)| (*time, force - desired))
        .collect()
}

fn rms(errors: &[(f64, f64)]) -> f64 {
    (errors.iter().map(|(_, e)| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

fn largest(errors: &[(f64, f64)]) -> f64 {
    errors.iter().map(|(_, e)| e.abs()).fold(0.0, f64::max)
}

fn values(errors: &[(f64, f64)]) -> Vec<f64> {
    errors.iter().map(|(_, error)| *error).collect()
}

/// Errors on the surface moved at a frequency [Hz], after its first turn.
fn moved(law: ForceLaw, frequency: f64, sensing: SensingParameters) -> Vec<(f64, f64)> {
    let mut bench = moving_surface();
    let LoadScenario::Contact {
        motion: Some(motion),
        ..
    } = &mut bench.load
    else {
        panic!("the surface does not move")
    };
    motion.frequency = frequency;
    let from = motion.start + 1.0 / frequency;
    bench.duration = motion.start + (2.0 / frequency).max(6.0);
    bench.controller.law = law;
    bench.sensing = sensing;
    errors(&record(bench), 150.0, from)
}

/// Overshoot [1] and time until within 5 % for good [s], if ever, of a step from 100 to 200 N; about what is desired.
fn force_step(law: ForceLaw) -> (f64, Option<f64>) {
    const STEP: f64 = 3.0;
    let mut bench = moving_surface();
    if let LoadScenario::Contact { motion, .. } = &mut bench.load {
        *motion = None;
    }
    bench.duration = 6.0;
    bench.command = CommandScenario::Force(vec![(0.5, 100.0), (STEP, 200.0)]);
    bench.controller.law = law;
    let after = errors(&record(bench), 200.0, STEP);
    let peak = after.iter().map(|(_, e)| *e).fold(f64::MIN, f64::max);
    let outside = after.iter().rposition(|(_, error)| error.abs() > 5.0);
    let settled = after.get(outside.map_or(0, |last| last + 1));
    (peak / 100.0, settled.map(|(time, _)| time - STEP))
}

/// The job of a misplaced part with the seals and sensors of the moved surface: errors while following, overshoot [1] and settling [s] at first touch.
fn misplaced(law: ForceLaw) -> (Vec<(f64, f64)>, f64, Option<f64>) {
    let (mut cell, bench) = (scenario("misplaced_part"), moving_surface());
    cell.device.parameters.seal_friction = bench.device.parameters.seal_friction;
    cell.sensing = bench.sensing;
    cell.sensing.sample_rate = 1e3;
    cell.simulation.step = 0.25e-3;
    cell.controller.law = law;
    let desired = cell.process.force;
    let finished = run(cell);
    let follow = finished.recording.phase("follow").unwrap().clone();
    let mut errors = errors(&finished.recording, desired, follow.start);
    errors.retain(|(time, _)| *time <= follow.end);
    let overshoot = finished.summary.engagement_overshoot_percent.unwrap();
    (errors, overshoot / 100.0, finished.summary.settling_time_s)
}

#[test]
fn what_each_controller_makes_of_a_moved_surface() {
    let noisy = moving_surface().sensing;
    for frequency in [0.1, 0.5] {
        for (kind, sensing) in [("noise", noisy), ("ideal", SensingParameters::ideal())] {
            let bench = moving_surface();
            let open = moved(LAWS[0].1, frequency, sensing);
            let dead_time = bench.device.parameters.regulator.dead_time;
            let bound = dead_time_error(&values(&open), bench.step, dead_time);
            for (name, law) in LAWS {
                let errors = moved(law, frequency, sensing);
                println!("{frequency} {kind} {name}: rms {:.3} max {:.2} bound {bound:.3}", rms(&errors), largest(&errors));
            }
        }
    }
    let regulator = moving_surface().device.parameters.regulator;
    let area = moving_surface().device.parameters.areas().extending;
    println!("least {:.4}", least_settling_time(&regulator, 100.0 / area, 200.0 / area, 0.05));
    for (name, law) in LAWS {
        println!("step {name}: {:?}", force_step(law));
    }
    for (name, law) in LAWS {
        let (errors, overshoot, settling) = misplaced(law);
        println!("cell {name}: rms {:.3} max {:.2} over {overshoot:.3} settle {settling:?}", rms(&errors), largest(&errors));
        let bound = dead_time_error(&values(&errors), 2.5e-4, 0.02);
        println!("   bound {bound:.3}");
    }
}

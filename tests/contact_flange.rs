//! scenarios/acf_plate.toml beside the recordings that it is after, where they are.

use std::path::Path;

use idc_cell::cell::Cell;
use idc_cell::recording::schema;
use idc_cell::scenario::Scenario;

use crate::common::{scenario, shared};

/// Desired force [N], feed [m/s], file of the recording.
const RUNS: [(f64, f64, &str); 3] = [
    (15.0, 0.10, "straight_ACF_F15_v0.10_tramp0.0_fzero0"),
    (35.0, 0.10, "straight_ACF_F35_v0.10_tramp0.0_fzero0"),
    (55.0, 0.25, "straight_ACF_F55_v0.25_tramp0.0_fzero0"),
];

/// Columns of numbers of a file with one line of names.
fn table(path: &Path) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).unwrap();
    let numbers = |line: &str| line.split(',').map(|n| n.parse().unwrap()).collect();
    text.lines().skip(1).map(numbers).collect()
}

fn deviation(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count).sqrt()
}

/// Standard deviation of the recorded force while the arm slides at its feed [N].
fn recorded(folder: &Path, name: &str, feed: f64) -> f64 {
    let speeds = table(&folder.join(format!("{name}_velocity.csv")));
    // It holds for four seconds after the first contact, then slides.
    let mut sliding = speeds
        .iter()
        .filter(|row| row[0] > 3.0 && (row[1].abs() - feed).abs() < 0.15 * feed)
        .map(|row| row[0]);
    let start = sliding.next().unwrap();
    let end = sliding
        .scan(start, |last, time| {
            let goes_on = time - *last < 0.05;
            *last = time;
            goes_on.then_some(time)
        })
        .last()
        .unwrap();
    let forces = table(&folder.join(format!("{name}_force.csv")));
    let settled: Vec<f64> = forces
        .iter()
        .filter(|row| row[0] > start + 0.3 && row[0] < end - 0.1)
        .map(|row| row[1])
        .collect();
    assert!(settled.len() > 1000, "{name}");
    deviation(&settled)
}

/// The same of a simulated cell, without the tenth of its way at either end in which it gains and loses speed.
fn simulated(job: Scenario) -> f64 {
    let run = Cell::new(job).unwrap().run(&mut |_| ()).unwrap();
    let span = run.recording.phase("follow").unwrap();
    let samples = run.recording.samples_in(span);
    let tenth = samples.len() / 10;
    let force = run.recording.values(schema::CONTACT_FORCE).unwrap();
    deviation(&force[samples.start + tenth..samples.end - tenth])
}

#[test]
fn the_force_of_a_sliding_contact_flange_varies_as_it_was_recorded() {
    let job = |force: f64, feed: f64, coulomb: f64| {
        let mut job = scenario("acf_plate");
        job.process.force = force;
        job.process.feed = feed;
        job.process.corner_feed = feed / 2.0;
        let seals = &mut job.device.parameters.seal_friction;
        (seals.coulomb, seals.static_force) = (coulomb, coulomb);
        simulated(job)
    };
    let simulated = RUNS.map(|(force, feed, _)| job(force, feed, 2.4));
    // The seals decide: without them it varies by less than a third of that.
    let without = job(35.0, 0.1, 0.0);
    assert!(without < simulated[1] / 3.0, "{without} {simulated:?}");
    let Some(folder) = shared("recordings/acf_ur10e") else {
        return;
    };
    for ((_, feed, name), simulated) in RUNS.into_iter().zip(simulated) {
        let recorded = recorded(&folder, name, feed);
        println!("{name}: recorded {recorded:.2} N, simulated {simulated:.2} N");
        assert!(
            recorded / 1.5 < simulated && simulated < 1.5 * recorded,
            "{name}: {recorded} {simulated}"
        );
    }
}

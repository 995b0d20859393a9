//! Speed of the coupled cell, cost of each part of its step, and MuJoCo beside it in the same call:
//!
//! ```text
//! cargo bench --bench step
//! cargo bench --bench step -- precision
//! ```
//!
//! The second draws error over cost alone (`precision`).
//!
//! On one core, the same for both. First each part alone (criterion), then interleaved rounds of the whole cell, the whole cell with its parts timed,
//! the whole cell of deburred_edge (seals, air that warms up, a tool that turns, removal), the rigid bodies alone, and MuJoCo on the same arm, load and path; the table at the end holds their medians. The timed parts of a step include the
//! clock's own readings, so they add up to somewhat more than the step itself.

mod job;
mod parts;
mod peer;
mod precision;

use std::error::Error;
use std::process::Command;
use std::time::{Duration, Instant};

use idc_cell::cell::Cell;
use idc_cell::simulation::StepTimes;

use job::{Following, holding_world};
use peer::Peer;

/// Rounds of everything, interleaved, of which the median counts.
const ROUNDS: usize = 9;
/// Steps a round.
const STEPS: usize = 5000;

fn main() -> Result<(), Box<dyn Error>> {
    // `cargo test --benches` only wants to know that the benches run.
    let measuring = std::env::args().any(|argument| argument == "--bench");
    let cell = job::cell("plate_edge_ideal.toml")?;
    let deburring = job::cell("deburred_edge.toml")?;
    println!("{}", pin_to_one_core());
    if std::env::args().any(|argument| argument == "precision") {
        return precision::compare("plate_edge_ideal.toml");
    }
    let mut criterion = parts::criterion();
    parts::all(&mut criterion, &cell);
    criterion.final_summary();
    if measuring {
        compare(&cell, &deburring)?;
        precision::compare("plate_edge_ideal.toml")?;
    }
    Ok(())
}

/// Puts this process and those that it starts on the last core that it may use; says what came of it.
fn pin_to_one_core() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let allowed = status
        .lines()
        .find_map(|line| line.strip_prefix("Cpus_allowed_list:"));
    let last = allowed.and_then(|list| list.trim().rsplit([',', '-']).next());
    let Some(core) = last else {
        return "not pinned to a core: /proc/self/status is not readable".to_owned();
    };
    let pid = std::process::id().to_string();
    let pinned = Command::new("taskset")
        .args(["--cpu-list", "--pid", core, &pid])
        .output();
    match pinned {
        Ok(output) if output.status.success() => format!("pinned to core {core}"),
        _ => "not pinned to a core: taskset failed".to_owned(),
    }
}

/// Seconds a step of each kind, a value a round.
#[derive(Default)]
struct Rounds {
    whole: Vec<f64>,
    deburring: Vec<f64>,
    parts: [Vec<f64>; 5],
    rigid_bodies_alone: Vec<f64>,
    mujoco: Vec<f64>,
}

/// Parts of a timed step, in its order.
const PARTS: [&str; 5] = [
    "reference, set pressure",
    "device, contact",
    "servo, inverse dynamics",
    "rigid bodies, friction (Rapier)",
    "sample",
];

fn compare(cell: &Cell, deburring: &Cell) -> Result<(), Box<dyn Error>> {
    let mut following = Following::new(cell);
    let mut removing = Following::new(deburring);
    let mut world = holding_world(cell, 0.0);
    let mut peer = Peer::start(cell, STEPS);
    let mut rounds = Rounds::default();
    let mut last_round = None;
    for _ in 0..ROUNDS {
        rounds.whole.push(per_step(following.run(STEPS, None)));
        let removed = removing.run(STEPS, None);
        rounds.deburring.push(per_step(removed));
        let mut times = StepTimes::default();
        following.run(STEPS, Some(&mut times));
        let parts = [
            times.reference,
            times.slide,
            times.servo,
            times.rigid_bodies,
            times.sample,
        ];
        for (values, part) in rounds.parts.iter_mut().zip(parts) {
            values.push(per_step(part));
        }
        let clock = Instant::now();
        for _ in 0..STEPS {
            world.step();
        }
        rounds.rigid_bodies_alone.push(per_step(clock.elapsed()));
        if let Ok(peer) = &mut peer {
            let round = peer.round()?;
            rounds.mujoco.push(round.seconds / round.steps as f64);
            last_round = Some(round);
        }
    }
    let slower = ratio(&rounds.deburring, &rounds.whole);
    print_ours(&mut rounds);
    println!(
        "deburred_edge / plate_edge_ideal: {slower:.3} times the time of a step, median of the rounds' ratios"
    );
    let (force, desired) = (world.force(), cell.setup.scenario.process.force);
    println!(
        "the rigid bodies alone press with {force:.4} N of {desired} N, {:.4} mm deep",
        world.penetration() * 1e3
    );
    match &peer {
        Ok(peer) => print_peer(cell, &mut rounds, peer, last_round.as_ref()),
        Err(reason) => println!("\nMuJoCo: not measured; {reason}"),
    }
    Ok(())
}

fn per_step(time: Duration) -> f64 {
    per_step_of(time, STEPS)
}

fn per_step_of(time: Duration, steps: usize) -> f64 {
    time.as_secs_f64() / steps as f64
}

fn print_ours(rounds: &mut Rounds) {
    println!(
        "\nplate_edge_ideal, following, one core; medians of {ROUNDS} interleaved rounds of {STEPS} steps"
    );
    println!(
        "{:<40} {:>10} {:>12} {:>22}",
        "", "us/step", "steps/s", "range of steps/s"
    );
    row("whole coupled cell", &mut rounds.whole);
    for (name, values) in PARTS.iter().zip(&mut rounds.parts) {
        println!("  {name:<38} {:>10.3}", median(values) * 1e6);
    }
    row("whole cell of deburred_edge", &mut rounds.deburring);
    row(
        "rigid bodies alone, arm held",
        &mut rounds.rigid_bodies_alone,
    );
}

fn print_peer(cell: &Cell, rounds: &mut Rounds, peer: &Peer, last: Option<&peer::Round>) {
    let ready = &peer.ready;
    row(
        &format!("MuJoCo {}, same arm, load, path", ready.version),
        &mut rounds.mujoco,
    );
    println!(
        "\nMuJoCo / whole coupled cell: {:.2} times the steps/s",
        median(&mut rounds.whole) / median(&mut rounds.mujoco)
    );
    println!(
        "MuJoCo / rigid bodies alone: {:.2} times the steps/s",
        median(&mut rounds.rigid_bodies_alone) / median(&mut rounds.mujoco)
    );
    let desired = cell.setup.scenario.process.force;
    println!(
        "MuJoCo presses at rest with {:.4} N of {desired} N ({:+.4} %), {:.4} mm deep (F/k {:.4} mm)",
        ready.static_force,
        (ready.static_force / desired - 1.0) * 100.0,
        ready.penetration * 1e3,
        desired / cell.setup.scenario.nominal.contact.stiffness_at(desired) * 1e3,
    );
    if let Some(round) = last {
        println!(
            "and following with {:.3} N, standard deviation {:.4} N",
            round.force_mean, round.force_deviation
        );
    }
}

fn row(name: &str, values: &mut [f64]) {
    let middle = median(values);
    let (fastest, slowest) = (values[0], values[values.len() - 1]);
    println!(
        "{name:<40} {:>10.3} {:>12.0} {:>10.0} ..{:>9.0}",
        middle * 1e6,
        1.0 / middle,
        1.0 / slowest,
        1.0 / fastest
    );
}

/// Median of the quotients, round by round.
fn ratio(of: &[f64], by: &[f64]) -> f64 {
    let mut ratios: Vec<f64> = of.iter().zip(by).map(|(of, by)| of / by).collect();
    median(&mut ratios)
}

/// Median; leaves the values sorted.
fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

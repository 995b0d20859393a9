//! What it costs that nothing meets: runs and checks of cells with their collisions watched and without, in turns in one process:
//!
//! ```text
//! cargo bench --bench collision
//! ```
//!
//! A run without is of the same plan, its watch given no pairs; a check without is of the scenario in which all pairs of bodies may meet.

use std::error::Error;
use std::path::Path;
use std::time::{Duration, Instant};

use idc_cell::cell::Cell;
use idc_cell::run::run_cell;
use idc_cell::scenario::{Scenario, load};

/// Rounds of everything, interleaved, of which the median counts.
const ROUNDS: usize = 15;

fn main() -> Result<(), Box<dyn Error>> {
    // `cargo test --benches` only wants to know that the benches run.
    let measuring = std::env::args().any(|argument| argument == "--bench");
    let rounds = if measuring { ROUNDS } else { 1 };
    for name in ["plate_edge", "bracket_loop"] {
        compare(name, rounds)?;
    }
    Ok(())
}

fn compare(name: &str, rounds: usize) -> Result<(), Box<dyn Error>> {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let watched = load(&project.join(format!("scenarios/{name}.toml")))?;
    let mut free = watched.clone();
    let with = Cell::new(watched.clone())?;
    free.collision.allowed_pairs = with.setup.collision.checked().collect();
    let mut without = Cell::new(watched.clone())?;
    without.setup.collision = Cell::new(free.clone())?.setup.collision;
    let pairs = with.setup.collision.checked().count();
    assert_eq!(without.setup.collision.checked().count(), 0);

    let mut runs: [Vec<f64>; 2] = Default::default();
    let mut checks: [Vec<f64>; 2] = Default::default();
    for _ in 0..rounds {
        for (own, cell) in runs.iter_mut().zip([&without, &with]) {
            own.push(run(cell)?.as_secs_f64());
        }
        for (own, scenario) in checks.iter_mut().zip([&free, &watched]) {
            own.push(check(scenario)?.as_secs_f64());
        }
    }
    let rows = [
        ("run, nothing written", runs.map(median)),
        ("check", checks.map(median)),
    ];
    for (what, [without, with]) in rows {
        println!(
            "{name}, {what}: {with:.4} s with {pairs} pairs of bodies, {without:.4} s without; ratio {:.3}, {:+.4} s; medians of {rounds}",
            with / without,
            with - without
        );
    }
    Ok(())
}

fn run(cell: &Cell) -> Result<Duration, Box<dyn Error>> {
    let clock = Instant::now();
    let finished = run_cell(cell, &mut |_| ())?;
    let taken = clock.elapsed();
    match finished.stop {
        None => Ok(taken),
        Some(stop) => Err(stop.into()),
    }
}

fn check(scenario: &Scenario) -> Result<Duration, Box<dyn Error>> {
    let scenario = scenario.clone();
    let clock = Instant::now();
    drop(Cell::new(scenario)?);
    Ok(clock.elapsed())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

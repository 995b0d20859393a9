//! Which integrator the device gets: error against cost, and scipy's LSODA beside it in the same call:
//!
//! ```text
//! cargo bench --bench solver                      (with --features diffsol for that crate's methods too)
//! ```
//!
//! On one core, the same for both. First one step of the device by itself (criterion); then, against the golden files of scipy's Radau, the device's own
//! integrator, other methods of fixed step, and the adaptive solvers of two crates on the same equations; last the ratio to LSODA.

mod adaptive;
mod case;
mod device;
#[cfg(feature = "diffsol")]
mod diffsol_crate;
mod fixed;
mod legs;
mod model;
mod peer;
mod picture;
mod table;
mod watch;

use std::error::Error;
use std::process::Command;
use std::time::Duration;

use criterion::Criterion;

use case::Case;
use device::{Kind, Moving};

/// Rounds of steps, of which the best counts, as the peer counts its own. Short and many: a round of 2 ms runs within one turn of the scheduler.
const ROUNDS: usize = 300;
/// Steps in each: once through what moves.
const STEPS: u64 = 1500;

fn main() -> Result<(), Box<dyn Error>> {
    // `cargo test --benches` only wants to know that the benches run, and whoever names one wants no other.
    let mut arguments = std::env::args().skip(1);
    let measuring = arguments.all(|argument| argument == "--bench") && std::env::args().len() > 1;
    let step = Case::read("paper_step", "scenarios/paper_step.toml")?;
    println!("{}", pin_to_one_core());
    let mut criterion = Criterion::default()
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_millis(1200))
        .sample_size(20)
        .configure_from_args();
    device::steps(&mut criterion, &step);
    criterion.final_summary();
    if measuring {
        let calls = beside_lsoda(&step);
        let mut cases = vec![step];
        for (name, file) in [
            ("retract", "scenarios/retract.toml"),
            ("impact", "tests/reference/bench/impact.toml"),
        ] {
            cases.push(Case::read(name, file)?);
        }
        cases.push(Case::stiff("scenarios/retract.toml")?);
        let rows = table::print(&cases);
        // Without that crate's methods it would say half of it.
        if cfg!(feature = "diffsol") {
            let path = case::project("docs/pictures/solver_work_precision.svg");
            std::fs::write(&path, picture::svg(&rows, &calls)?)?;
            println!("{}", path.display());
        }
    }
    Ok(())
}

/// Prints the ratio that is asked for; returns the peer's calls, none if it is not there.
fn beside_lsoda(case: &Case) -> Vec<peer::Call> {
    let moving = Moving::of(case);
    let cost = |kind, substeps| {
        let once = |_| moving.run(kind, substeps, STEPS).as_secs_f64() * 1e6 / STEPS as f64;
        (0..ROUNDS).map(once).fold(f64::INFINITY, f64::min)
    };
    let audited = cost(Kind::Carried { audited: true }, 2);
    let plain = cost(Kind::Carried { audited: false }, 2);
    let predicted = cost(Kind::Predicted, 2);
    println!(
        "\none device step of 1 ms, 1 to 2.5 s of paper_step, best of {ROUNDS} rounds (asked: at most 2 us):"
    );
    println!("  with its piston and ledger  {audited:.3} us");
    println!("  with its piston             {plain:.3} us");
    println!("  piston predicted             {predicted:.3} us");
    let calls = peer::run().unwrap_or_else(|reason| {
        println!("LSODA skipped: {reason}");
        Vec::new()
    });
    println!(
        "LSODA of scipy, restarted every ms, and how many times the device's step it takes (asked: 60), with ledger and without:"
    );
    for call in &calls {
        let [relative, absolute] = call.tolerances;
        println!(
            "  {:<16} rtol {relative:.0e}, atol {absolute:.0e} of full scale: {:>7.2} us, error {:.1e}: {:>5.1}, {:>5.1}",
            call.name,
            call.microseconds,
            call.error,
            call.microseconds / audited,
            call.microseconds / plain
        );
    }
    calls
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

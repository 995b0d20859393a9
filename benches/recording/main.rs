//! Cost of a run's recording: a minute of a cell at 1 kHz, by the program as a user runs it, with recording.rrd and without, in turns:
//!
//! ```text
//! cargo bench --bench recording
//! ```
//!
//! Each alone by criterion; then interleaved rounds, whose medians are compared, and what a first write of as many bytes to the disk takes.

use std::error::Error;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use criterion::Criterion;

/// Rounds of both, interleaved, of which the median counts.
const ROUNDS: usize = 25;
/// Feed at which the edge of the plate takes a minute.
const FEED: &str = "feed_mm_per_s = 5.2";

fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let scenario = minute(folder.path())?;
    let run = |recording: bool| -> Result<Duration, Box<dyn Error>> {
        let mut command = Command::new(env!("CARGO_BIN_EXE_idc"));
        command.arg("run").arg(&scenario).arg("--out");
        command
            .arg(folder.path().join("out"))
            .args(["--force", "--quiet"]);
        if !recording {
            command.arg("--no-recording");
        }
        let clock = Instant::now();
        let status = command.status()?;
        if !status.success() {
            return Err(format!("idc run: {status}").into());
        }
        Ok(clock.elapsed())
    };
    run(true)?;
    // `cargo test --benches` only wants to know that the benches run.
    if !std::env::args().any(|argument| argument == "--bench") {
        return Ok(());
    }
    let mut criterion = Criterion::default().sample_size(10).configure_from_args();
    for (name, recording) in [("with", true), ("without", false)] {
        criterion.bench_function(&format!("a minute of a cell, {name} recording.rrd"), |b| {
            b.iter(|| run(recording).expect("it ran before"));
        });
    }
    criterion.final_summary();
    let mut seconds: [Vec<f64>; 2] = Default::default();
    for _ in 0..ROUNDS {
        for (own, recording) in seconds.iter_mut().zip([false, true]) {
            own.push(run(recording)?.as_secs_f64());
        }
    }
    run(true)?;
    let bytes = std::fs::read(folder.path().join("out/recording.rrd"))?;
    let disk = write(&folder.path().join("again"), &bytes)?;
    let [without, with] = seconds.map(median);
    println!(
        "\na minute of a cell: {without:.3} s, with recording.rrd {with:.3} s: {:+.1} %; {:.1} MB, whose mere write takes {:.1} ms",
        100.0 * (with / without - 1.0),
        bytes.len() as f64 / 1e6,
        1e3 * disk.as_secs_f64()
    );
    Ok(())
}

/// A scenario of the project that takes a minute.
fn minute(folder: &Path) -> Result<PathBuf, Box<dyn Error>> {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(project.join("scenarios/plate_edge_ideal.toml"))?;
    let text = text.replace("feed_mm_per_s = 20", FEED);
    let text = text.replace("\"../", &format!("\"{}/", project.display()));
    let file = folder.join("minute.toml");
    std::fs::write(&file, text)?;
    Ok(file)
}

fn write(file: &Path, bytes: &[u8]) -> std::io::Result<Duration> {
    let clock = Instant::now();
    let mut file = std::fs::File::create(file)?;
    file.write_all(bytes)?;
    file.sync_all()?;
    Ok(clock.elapsed())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

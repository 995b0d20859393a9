//! scipy's LSODA beside us: benches/solver/lsoda_peer.py, run once.

use std::path::PathBuf;
use std::process::Command;

use serde_json::Value;

use super::case::{golden_file, project};

/// One way of calling it.
#[derive(Debug)]
pub struct Call {
    /// Its name in scipy.
    pub name: String,
    /// Relative tolerance, and absolute as a share of full scale.
    pub tolerances: [f64; 2],
    /// Microseconds a simulated millisecond.
    pub microseconds: f64,
    /// Largest error of any quantity over its range [1].
    pub error: f64,
}

/// The interpreter with scipy: `IDC_PYTHON`, else the one that .ci/install_references made.
fn interpreter() -> Result<PathBuf, String> {
    let python = std::env::var_os("IDC_PYTHON").map_or_else(
        || project("build/references/venv/bin/python"),
        PathBuf::from,
    );
    if python.exists() {
        return Ok(python);
    }
    Err(format!(
        "{} is not there; .ci/install_references makes it",
        python.display()
    ))
}

/// Runs it on the case that moves; `Err` says why it could not be.
pub fn run() -> Result<Vec<Call>, String> {
    let output = Command::new(interpreter()?)
        .arg(project("benches/solver/lsoda_peer.py"))
        .arg(project("scenarios/paper_step.toml"))
        .arg(project(&golden_file("paper_step")))
        .output()
        .map_err(|error| error.to_string())?;
    let said = String::from_utf8_lossy(&output.stdout);
    if !output.status.success() {
        let error = String::from_utf8_lossy(&output.stderr);
        return Err(error.lines().last().unwrap_or("it failed").to_owned());
    }
    let report: Value = serde_json::from_str(said.trim()).map_err(|error| error.to_string())?;
    let runs = report["runs"].as_array().ok_or("its report has no runs")?;
    let calls: Option<Vec<Call>> = runs.iter().map(call).collect();
    calls.ok_or_else(|| "its runs are not understood".to_owned())
}

fn call(run: &Value) -> Option<Call> {
    let errors = run["max_errors"].as_object()?;
    Some(Call {
        name: run["call"].as_str()?.to_owned(),
        tolerances: [run["rtol"].as_f64()?, run["atol_of_full_scale"].as_f64()?],
        microseconds: run["us_per_ms"].as_f64()?,
        error: errors
            .values()
            .filter_map(Value::as_f64)
            .fold(0.0, f64::max),
    })
}

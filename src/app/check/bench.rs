//! A bench explained.

use super::super::error::AppError;
use super::cell::overrides;
use super::report::{Report, shown};
use crate::metrics;
use crate::rig::Rig;
use crate::run::RunError;
use crate::scenario::BenchScenario;
use crate::scenario::bench::{CommandScenario, LoadScenario};
use crate::shell::word;

/// Bytes of a sample in recording.rrd and samples.parquet together, from runs of the shipped scenarios.
const BYTES: f64 = 320.0;

/// A bench that can be run.
pub(super) fn bench(scenario: BenchScenario, overridden: &[String]) -> Result<Report, AppError> {
    let file = scenario.path.clone();
    metrics::validate(metrics::BENCH_METRICS, &scenario.expect)
        .map_err(RunError::metrics(&file))?;
    let rig = Rig::new(scenario)?;
    let scenario = &rig.scenario;
    let kind = "a bench to simulate: the device without an arm";
    let mut report = Report::new(&file, kind, Some(&scenario.title));
    report.device(&rig.actual.device);
    overrides(&mut report, overridden);
    report.fact("load", load(&scenario.load));
    if let Some(hand) = &scenario.hand {
        let [force, frequency] = [hand.peak_force, hand.frequency].map(shown);
        report.fact(
            "hand",
            format!("pushes with up to {force} N at {frequency} Hz"),
        );
    }
    report.fact("command", command(&scenario.command));
    if scenario.estimator.is_some() {
        report.fact("estimator", "contact force without a load cell");
    }
    // A bench is sampled at its start too.
    let (duration, step) = (scenario.duration, scenario.step);
    report.extent(duration, step, (duration / step - 1e-9).ceil() + 1.0, BYTES);
    report.bounds(&scenario.expect);
    report.next(format!("idc run {}", word(&file)));
    Ok(report)
}

fn load(load: &LoadScenario) -> String {
    match load {
        LoadScenario::Free => "nothing: the tool runs free".to_owned(),
        LoadScenario::Contact {
            position, motion, ..
        } => {
            let place = format!("{} mm along the stroke", shown(position * 1e3));
            match motion {
                None => format!("a load cell {place}"),
                Some(motion) => format!(
                    "a surface {place}, moving by {} mm at {} Hz",
                    shown(motion.peak_to_peak * 1e3),
                    shown(motion.frequency)
                ),
            }
        }
    }
}

fn command(command: &CommandScenario) -> String {
    let (what, unit, size) = match command {
        CommandScenario::SetPressure(_) => ("set pressure", "bar gauge", 1e-5),
        CommandScenario::Force(_) => ("force", "N", 1.0),
    };
    let steps = command.steps().iter();
    let steps: Vec<String> = steps
        .map(|(time, value)| format!("{} at {} s", shown(value * size), shown(*time)))
        .collect();
    if steps.is_empty() {
        return "none".to_owned();
    }
    format!("{what} [{unit}]: {}", steps.join(", "))
}

//! A run of a contact flange as a flange that was fitted to others simulates it.

use std::path::Path;

use super::error::CaseError;
use super::rig::flange_run;
use crate::diagnosis::flange::fit::report::SimulatedRun;
use crate::diagnosis::flange::fit::{predict_flange, settings_of};
use crate::flange::FittedFlange;
use crate::quantity::significant;
use crate::scenario::rig_file::RigFile;

/// A run, predicted.
#[derive(Debug, Clone)]
pub struct FlangePrediction {
    /// Results beside the recorded ones.
    pub run: SimulatedRun,
    /// Times of the simulated log [s].
    pub time: Vec<f64>,
    /// Its force [N].
    pub force: Vec<f64>,
    /// What of the run the fitted ones did not cover, a sentence each.
    pub notes: Vec<String>,
}

/// Predicts a run, whose log gives the arm's motion, the desired force and when the tool touches; none where the simulated force never settles to be measured.
///
/// # Errors
/// A recording that cannot be read, or is none of a contact.
pub fn predict_flange_run(
    rig: &RigFile,
    flange: &FittedFlange,
    path: &Path,
) -> Result<Option<FlangePrediction>, CaseError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new(""));
    let measured = flange_run(rig, folder, &name)?;
    Ok(
        predict_flange(flange, &measured).map(|(run, (first, force))| {
            let (recorded, shown) = &measured;
            FlangePrediction {
                time: recorded.time[first..first + force.len()].to_vec(),
                notes: not_covered(&name, flange, settings_of(recorded, shown)),
                run,
                force,
            }
        }),
    )
}

/// Settings of a run that the fitted ones did not cover.
fn not_covered(name: &str, flange: &FittedFlange, settings: [f64; 3]) -> Vec<String> {
    let covered = &flange.covered;
    let all = [
        ("speed of approach", "m/s", covered.approach),
        ("force before contact", "N", covered.before),
        ("desired force", "N", covered.desired),
    ];
    let beyond = covered.beyond(settings);
    let said = all.into_iter().zip(settings).zip(beyond);
    let said = said.filter(|(_, beyond)| *beyond > 0.0);
    let shown = |value: f64| significant(value, 3);
    said.map(|(((what, unit, [low, high]), value), _)| {
        format!(
            "{name} leaves what the runs fitted to covered, and its intervals are wider: a {what} of {} {unit}, of which {} to {} {unit} were covered",
            shown(value),
            shown(low),
            shown(high)
        )
    })
    .collect()
}

//! A motion that tells an arm's numbers apart: Fourier series of the joints, within limits of position, speed, torque and collision, by which the numbers that are
//! known within bounds come out closest.

mod clearance;
mod error;
mod limits;
mod search;

pub use clearance::Clearance;
pub use error::{ExcitationError, Hindrance};
pub use limits::{
    JointLimits, POSITION_MARGIN, SPEED_SHARE, TORQUE_SHARE, limits_of, torque_shares,
};
pub use search::HIGHEST;

use crate::diagnosis::arm::base_parameters::base_parameters;
use crate::diagnosis::arm::contact::touching;
use crate::diagnosis::arm::estimate::{HALF_WIDTH, inverse_of};
use crate::diagnosis::arm::evidence::Evidence;
use crate::diagnosis::arm::fit::Parameter;
use crate::diagnosis::arm::identifiability::{
    Expected, curvature, expected, moved_along, randomly_moved, roughly_known,
};
use crate::diagnosis::arm::input::ArmInput;
use crate::recorded_arm::fourier_path::FourierPath;
use crate::scenario::arm_file::ArmFile;
use crate::stats::median;
use search::Search;

/// Seed of the search.
const SEED: u64 = 1;

/// A designed path, and what it is expected to show.
#[derive(Debug, Clone)]
pub struct Design {
    /// The path.
    pub path: FourierPath,
    /// Limits that it keeps, margins taken off.
    pub limits: Vec<JointLimits>,
    /// Largest share of each joint's torque limit, margin taken off [1].
    pub torque_shares: Vec<f64>,
    /// What the recordings leave of the tolerances; none without recordings.
    pub before: Option<Vec<Expected>>,
    /// What the path leaves of them.
    pub after: Vec<Expected>,
    /// Half-widths of the base parameters by the path over those by the recordings, their median [1].
    pub median_ratio: Option<f64>,
}

/// Designs a path of a duration [s] for an arm, with recordings or without.
///
/// # Errors
/// The limits leave no room.
pub fn design(
    file: &ArmFile,
    input: &ArmInput,
    clearance: &Clearance,
    duration: f64,
) -> Result<Design, ExcitationError> {
    let limits = limits_of(input);
    let random = randomly_moved(input);
    let kept = base_parameters(&Evidence::of(&random, &[])).kept;
    let parameters: Vec<Parameter> = kept.iter().map(|q| roughly_known(input, *q)).collect();
    let search = Search {
        input,
        limits: &limits,
        parameters: &parameters,
        clearance,
        period: duration,
        seed: SEED,
    };
    let no_room = |hindrance| ExcitationError::NoRoom {
        file: file.path.clone(),
        hindrance,
    };
    let path = search.best().map_err(no_room)?;
    let moved = moved_along(input, &path, file.rate);
    let by_path = Evidence::of(&moved, &[]);
    let touching = touching(input);
    let recorded = (!input.recordings.is_empty()).then(|| Evidence::of(input, &touching));
    let ratio = |recorded: &Evidence| {
        let [before, after] = [recorded, &by_path].map(|by| half_widths(by, &parameters));
        median(
            after
                .iter()
                .zip(&before)
                .map(|(after, before)| after / before),
        )
    };
    Ok(Design {
        torque_shares: torque_shares(&input.nominal, &path, file.rate, &limits),
        before: recorded.as_ref().map(|by| expected(by).0),
        after: expected(&by_path).0,
        median_ratio: recorded.as_ref().and_then(ratio),
        path,
        limits,
    })
}

/// Half-widths of 95 % intervals of numbers that a fit moves.
fn half_widths(evidence: &Evidence, parameters: &[Parameter]) -> Vec<f64> {
    let course = evidence.course(&evidence.input.nominal, None);
    let covariance = inverse_of(&curvature(evidence, &course, parameters));
    let variances = (0..parameters.len()).map(|i| covariance[(i, i)]);
    variances.map(|v| HALF_WIDTH * v.sqrt()).collect()
}

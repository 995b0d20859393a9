//! Everything that is found in a case.

use super::estimate::Estimates;
use crate::diagnosis::difference::extent::{Largest, percentile_90};
use crate::diagnosis::difference::links::LinkResidual;
use crate::diagnosis::difference::localise::{Difference, robust_rms, root_mean_square};
use crate::diagnosis::difference::mismatch::Interval;
use crate::diagnosis::difference::regime::Regime;
use crate::diagnosis::difference::remaining::Remaining;
use crate::diagnosis::effort::EffortReport;
use crate::diagnosis::experiment::coverage::Coverage;
use crate::diagnosis::experiment::next_experiment::Separation;
use crate::diagnosis::fit::free::Free;
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::fit::model_error::ModelError;
use crate::diagnosis::formula::unlisted::Shape;
use crate::diagnosis::recordings::clean::Cleaning;
use crate::diagnosis::recordings::evidence::{Evidence, Prediction};
use crate::diagnosis::search::RoughFit;
use crate::diagnosis::search::detectable::Detectable;
use crate::diagnosis::search::ranking::Ranked;
use crate::diagnosis::search::ruled_out::RuledOut;
use crate::diagnosis::search::tried::Tried;
use crate::diagnosis::settings::Settings;
use crate::plant::{CHANNELS, Channel, PlantParameters};

/// The nominal model, moved within its tolerances as far as recordings that it may not explain allow.
#[derive(Debug)]
pub struct Baseline {
    /// The description.
    pub plant: PlantParameters,
    /// Its prediction.
    pub prediction: Prediction,
    /// Residual of each link of the chain, and the variable that explains it.
    pub links: Vec<(LinkResidual, Vec<Regime>)>,
    /// Where recordings differ from it.
    pub differences: Vec<Difference>,
}

/// Errors of prediction of a channel of a recording that was not fitted to.
#[derive(Debug, Clone, PartialEq)]
pub struct Unseen {
    /// The channel.
    pub channel: Channel,
    /// Of the nominal model as it stands in the rig file.
    pub nominal: ErrorSize,
    /// Of the nominal model, moved within its tolerances.
    pub before: ErrorSize,
    /// Of the best explanation.
    pub after: ErrorSize,
}

/// Size of an error of prediction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorSize {
    /// Root mean square, in the channel's unit.
    pub rms: f64,
    /// Robust root mean square, in standard deviations of the noise [1].
    pub sigmas: f64,
    /// 90th percentile of its size, in standard deviations of the noise [1].
    pub p90: f64,
}

impl ErrorSize {
    /// Of residuals in standard deviations of a noise; none where nothing counts.
    #[must_use]
    pub fn of(residuals: &[f64], noise: f64) -> Option<Self> {
        Some(Self {
            rms: noise * root_mean_square(residuals.iter().copied())?,
            sigmas: robust_rms(residuals)?.1,
            p90: percentile_90(residuals.iter().copied())?,
        })
    }
}

/// The finding.
#[derive(Debug)]
pub struct Diagnosis {
    /// Thresholds that it was made with.
    pub settings: Settings,
    /// The nominal rig.
    pub nominal: PlantParameters,
    /// Its tolerated quantities.
    pub tolerated: Vec<Free>,
    /// The recordings, cleaned.
    pub evidence: Evidence,
    /// Readings set aside in each of them.
    pub cleanings: Vec<Cleaning>,
    /// Effort of the search.
    pub effort: EffortReport,
    /// Notes on the recordings for an engineer, a sentence each.
    pub notes: Vec<String>,
    /// Explanations, best first.
    pub ranked: Vec<Ranked>,
    /// Law that a user tried.
    pub tried: Option<Tried>,
    /// Effects that were looked at.
    pub looked_at: usize,
    /// Explanations that were fitted roughly on the way, the best first.
    pub roughly: Vec<RoughFit>,
    /// What the best leaves beyond noise, by which the evidence was weighed.
    pub model_error: ModelError,
    /// Remainder that no law explains of a part of the device; none where that is noise, or where there is the whole of it.
    pub remaining: Option<Remaining>,
    /// Variants of the best that do worse, of a part of the device.
    pub ruled_out: Vec<RuledOut>,
    /// Smallest effects that the recordings would have shown, where the best has none.
    pub detectable: Vec<Detectable>,
    /// Numbers of the best.
    pub estimates: Estimates,
    /// Half of a 90 % band of each channel's prediction, in standard deviations of noise and numbers together [1].
    pub half_widths: [f64; CHANNELS.len()],
    /// Shape of its model discrepancy, if it has one.
    pub shape: Option<Shape>,
    /// Where its effects act.
    pub mismatch: Vec<Interval>,
    /// Largest departure of the best from the recordings; none where nothing was measured.
    pub largest: Option<Largest>,
    /// Prediction of the nominal model, as it stands in the rig file.
    pub as_nominal: Prediction,
    /// The nominal model, moved within its tolerances.
    pub baseline: Baseline,
    /// Name of the recording to be predicted, and errors of its prediction where it has measured columns.
    pub unseen: Option<(String, Vec<Unseen>)>,
    /// What the recordings have been to of the range within the limits.
    pub coverage: Coverage,
    /// Experiments that would tell the best from the next, best first; none where there is no next.
    pub experiments: Vec<Separation>,
}

impl Diagnosis {
    /// The best explanation.
    pub fn best(&self) -> &Hypothesis {
        &self.ranked[0].hypothesis
    }

    /// Rivals that the recordings do not rule out.
    pub fn rivals(&self) -> impl Iterator<Item = &Ranked> {
        self.ranked[1..]
            .iter()
            .filter(|r| r.odds >= self.settings.least_odds)
    }
}

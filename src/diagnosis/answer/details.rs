//! Content of diagnosis.json beyond what is scored. Sigmas are standard deviations of the sensor's noise.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::account::Account;
use super::estimate::Estimate;
use super::words::display_name;
use crate::diagnosis::data_fault::report::DataFaultReport;
use crate::diagnosis::difference::localise::NOISE_ALONE;
use crate::diagnosis::difference::mismatch::Mismatch;
use crate::diagnosis::effort::EffortReport;
use crate::diagnosis::flange::fit::report::SimulatedFlange;
use crate::quantity::{change, significant};
use crate::recording::provenance::Provenance;

/// Stands for each recording in turn.
pub const IN_TURN: &str = "left out in turn";

/// Version of the details: 2 since names followed the field's terms (`predicted`, `differences`, `autocorrelation_time_s`); 0 in files that are older.
pub const DETAILS_SCHEMA: u32 = 2;

/// All of it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Details {
    /// Version of the details, apart from that of what is scored.
    #[serde(rename = "details_schema")]
    pub schema: u32,
    /// Name of the case.
    pub case: String,
    /// Effort of the search.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub effort: Option<EffortReport>,
    /// The account, as account.txt.
    pub account: Account,
    /// Its provenance.
    pub provenance: Provenance,
    /// Standard deviation of the noise that each channel was given, by column.
    pub noise: Vec<ChannelNoise>,
    /// Departure of each channel of each recording from the models.
    pub misfit: Vec<ChannelMisfit>,
    /// Faults of sensors, logs and clocks, which were taken off before any physics was looked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub data_faults: Vec<DataFaultReport>,
    /// Where recordings differ from the nominal model moved within its tolerances.
    pub differences: Vec<Mismatch>,
    /// Residual of each link of the chain, and the variable that explains it.
    pub links: Vec<LinkReport>,
    /// Largest departure of the best explanation from the recordings, those left out in turn among them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub departure: Option<Departure>,
    /// What became of a law that a user tried.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tried: Option<TriedReport>,
    /// Families of laws that are alike of the effects that were found.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub families: Vec<FamilyReport>,
    /// Share of the mismatch that is explained [1]; none where there is none.
    pub explained_share: Option<f64>,
    /// Remainder that no law explains, where it is more than noise and everything was judged against it.
    pub remaining: Option<RemainingReport>,
    /// Other explanations that were looked at: those fitted in full first, then those that fell behind earlier, the best first.
    pub considered: Vec<Considered>,
    /// Variants of the explanation of a part of the device, the best first.
    pub ruled_out: Vec<RuledOutReport>,
    /// Results of each run of a contact flange.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub runs: Vec<RunReport>,
    /// Prediction of a run of a contact flange that was not looked at.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub predicted: Option<PredictedRun>,
    /// The same as a simulation that was fitted to its runs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flange: Option<SimulatedFlange>,
    /// Smallest effects that the recordings would have shown, where none is named.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub detectable: Vec<DetectableReport>,
    /// Numbers of the rig file within their tolerances.
    pub tolerated: Vec<ToleratedNumber>,
    /// Numbers of a sensor and its tool, declared or not.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub identified: Vec<IdentifiedNumber>,
    /// Errors of prediction on what was not fitted to.
    pub prediction: Vec<PredictionError>,
    /// Where the prediction leaves what the recordings covered.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub unknown_ground: Vec<UnknownGround>,
    /// The next recording to make.
    pub next_experiment: Option<NextExperiment>,
}

/// A departure of the best explanation from a recording.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Departure {
    /// The recording.
    pub recording: String,
    /// Column of the channel.
    pub channel: String,
    /// Whether it was predicted by a fit to the other recordings.
    pub left_out: bool,
    /// 90th percentile of its size, in standard deviations of the sensor's noise and of what the numbers' uncertainty moves it by [1].
    pub p90_sigmas: f64,
    /// Link of the chain that the channel shows: `regulator`, `piston`, `contact` or `sensors`.
    pub link: String,
}

/// Laws that are alike: that one of them is at work may be certain while it is open which.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FamilyReport {
    /// Name.
    pub name: String,
    /// In words, with an article.
    pub words: String,
    /// Probability that one of its laws is at work [1].
    pub probability: f64,
    /// Its laws, the likeliest first.
    pub members: Vec<FamilyMember>,
}

/// A law of a family.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FamilyMember {
    /// Name in the vocabulary.
    pub name: String,
    /// Key of the rig file's number that is off, of `number_off`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub key: Option<String>,
    /// Probability that it is the one [1].
    pub probability: f64,
    /// Its number given that it is the one, of a law that scales what others of its family scale; none of others, and in files that are older.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub number: Option<Estimate>,
}

/// A stretch in which a prediction leaves what the recordings covered that its model was fitted to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UnknownGround {
    /// What leaves it, with its unit; of one over another both.
    pub variable: String,
    /// From [s].
    pub start_s: f64,
    /// Until [s].
    pub end_s: f64,
    /// The value that is farthest off, in the variable's unit.
    pub value: f64,
    /// Least and largest value that the recordings had there.
    pub covered: [f64; 2],
}

impl UnknownGround {
    /// All of a recording in a sentence; none where there is none.
    #[must_use]
    pub fn words(recording: &str, all: &[Self]) -> Option<String> {
        /// Variables named at most.
        const MOST: usize = 3;
        let mut variables: Vec<&Self> = Vec::new();
        for ground in all {
            let beyond = |g: &Self| (g.covered[0] - g.value).max(g.value - g.covered[1]);
            match variables.iter_mut().find(|g| g.variable == ground.variable) {
                Some(known) if beyond(known) < beyond(ground) => *known = ground,
                Some(_) => {}
                None => variables.push(ground),
            }
        }
        let first = all.iter().map(|g| g.start_s).fold(f64::INFINITY, f64::min);
        let last = all
            .iter()
            .map(|g| g.end_s)
            .fold(f64::NEG_INFINITY, f64::max);
        let when = match [first, last].map(|time| format!("{time:.2}")) {
            [first, last] if first == last => format!("at {first} s"),
            [first, last] => format!("in stretches from {first} to {last} s"),
        };
        let said = |g: &&Self| {
            // Over another variable it keeps its own unit.
            let (own, over) = g.variable.split_once("_by_").unwrap_or((&g.variable, ""));
            let (mut name, unit, factor) = display_name(own);
            if !over.is_empty() {
                name += &format!(" over {}", display_name(over).0);
            }
            let shown = |value: f64| significant(factor * value, 3);
            let [low, high] = g.covered.map(shown);
            let value = format!("{} {unit}", shown(g.value));
            format!(
                "{name} comes to {}, of which {low} to {high} were covered",
                value.trim_end()
            )
        };
        let named: Vec<String> = variables.iter().take(MOST).map(said).collect();
        let others = match variables.len().saturating_sub(MOST) {
            0 => String::new(),
            more => format!(", and {more} more"),
        };
        (!all.is_empty()).then(|| {
            format!(
                "{recording} leaves what the recordings fitted to covered, {when}, and the band of its prediction is wider there: {}{others}",
                named.join("; ")
            )
        })
    }
}

/// What became of a law that a user tried.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TriedReport {
    /// Port and expression, in SI.
    pub formula: String,
    /// Its constants as fitted [SI].
    pub parameters: BTreeMap<String, Estimate>,
    /// Effects of the explanation that has it: itself, and what stands beside it.
    pub effects: Vec<String>,
    /// Whether that is the answer.
    pub is_answer: bool,
    /// Its odds against the answer given, as a power of ten [1].
    pub log10_odds: f64,
    /// Share of the mismatch that it explains [1]; none where there is none.
    pub explained_share: Option<f64>,
    /// Its largest departure from the recordings.
    pub departure: Option<Departure>,
}

/// Noise of a channel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ChannelNoise {
    /// Column.
    pub channel: String,
    /// Standard deviation taken, in the column's unit: that of the sensor, or what no law explains where that is more.
    pub standard_deviation: f64,
    /// Values shown by the recordings, in the order of them, in the column's unit.
    pub shown: Vec<Option<f64>>,
}

/// Departure of a channel of a recording from the models.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ChannelMisfit {
    /// File name.
    pub recording: String,
    /// Column.
    pub channel: String,
    /// Samples that count.
    pub samples: usize,
    /// Robust root mean square of the nominal model's error.
    #[serde(rename = "believed_sigmas")]
    pub nominal_sigmas: f64,
    /// Moved within its tolerances.
    pub tolerated_sigmas: f64,
    /// With what was found.
    pub improved_sigmas: f64,
    /// With what was found, fitted to the other recordings.
    pub left_out_sigmas: Option<f64>,
    /// Root mean square of what the nominal model leaves, in the column's unit.
    #[serde(default)]
    #[serde(rename = "believed_rms")]
    pub nominal_rms: f64,
    /// The same, moved within its tolerances.
    #[serde(default)]
    pub tolerated_rms: f64,
    /// The same with what was found.
    #[serde(default)]
    pub improved_rms: f64,
    /// That as a share of the root mean square of the channel itself [1].
    #[serde(default)]
    pub improved_share: f64,
}

/// Residual of a link of the chain, given its own measured input.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LinkReport {
    /// `regulator`, `piston` (chambers and force balance) or `contact` (and load cell).
    pub link: String,
    /// Robust root mean square.
    pub sigmas: f64,
    /// Whether it explains its own recording.
    pub explained: bool,
    /// Variables that say when the mismatch appears.
    pub regimes: Vec<RegimeReport>,
}

/// Remainder that no law explains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RemainingReport {
    /// Column.
    pub channel: String,
    /// Root mean square, in the column's unit.
    pub rms: f64,
    /// Standard deviation of the sensor's noise, in the column's unit.
    pub sensor_noise: f64,
    /// Time for which it is alike [s].
    pub autocorrelation_time_s: f64,
    /// Variables that say when it appears.
    pub regimes: Vec<RegimeReport>,
}

/// An explanation that was looked at, and not given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Considered {
    /// Its effects.
    pub effects: Vec<String>,
    /// Whether it was fitted in full. Otherwise with the piston held to its measured motion, and compared with what the answer's effects came to so.
    pub in_full: bool,
    /// Its odds against the answer given, as a power of ten [1].
    pub log10_odds: f64,
    /// Share of the mismatch that it explains [1]; none where there is none.
    pub explained_share: Option<f64>,
}

/// A variant of an explanation: without one of its effects, or with another law in an effect's place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RuledOutReport {
    /// Its effects.
    pub effects: Vec<String>,
    /// Root mean square of what it leaves, in the unit of the part's channel.
    pub rms: f64,
    /// Its numbers.
    pub parameters: Vec<(String, f64)>,
}

/// An effect at the smallest size that recordings would have shown, with nine chances in ten.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DetectableReport {
    /// Name.
    pub effect: String,
    /// Its numbers.
    pub parameters: Vec<DetectableParameter>,
}

/// A number of an effect at its smallest size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DetectableParameter {
    /// Name with its unit.
    pub name: String,
    /// Value.
    pub value: f64,
    /// Value without the effect; none where there is none, or that is 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub without: Option<f64>,
}

impl DetectableReport {
    /// Its numbers for people: as a change where there is something to change, otherwise as they are.
    #[must_use]
    pub fn words(&self) -> String {
        let words = self.parameters.iter().map(|parameter| {
            let (words, unit, factor) = display_name(&parameter.name);
            match parameter.without {
                Some(without) => {
                    let percent = 100.0 * (parameter.value / without - 1.0);
                    format!("{words} {}", change(percent))
                }
                None => {
                    let value = significant(parameter.value * factor, 2);
                    format!("{words} {value} {unit}").trim_end().to_owned()
                }
            }
        });
        words.collect::<Vec<_>>().join(", ")
    }
}

/// Result of a run of a contact flange.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunReport {
    /// File name.
    pub recording: String,
    /// First contact.
    pub contact_s: f64,
    /// Speed of approach.
    pub approach_m_per_s: f64,
    /// Force desired in contact.
    pub desired_n: f64,
    /// Peak of the impact.
    pub peak_n: f64,
    /// Time from contact until the force has settled.
    pub settling_s: f64,
    /// Frequency of the ringing; none where no line stands out.
    pub ringing_hz: Option<f64>,
    /// Rate at which it dies away.
    pub decay_1_per_s: Option<f64>,
    /// Mean of force less desired force once settled.
    pub steady_error_n: f64,
    /// Standard deviation of the same.
    pub wander_n: f64,
    /// Root mean square of force less desired force while the arm moves in contact.
    pub moving_rms_n: Option<f64>,
    /// Standard deviation of the force in the middle of that time.
    #[serde(default)]
    pub sliding_spread_n: Option<f64>,
    /// Share of that time without contact [1].
    pub contact_lost: f64,
}

/// Prediction of a run of a contact flange.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PredictedRun {
    /// File name.
    pub recording: String,
    /// Its speed of approach.
    pub approach_m_per_s: f64,
    /// Peak predicted.
    pub peak_n: f64,
    /// Peak measured.
    pub peak_measured_n: f64,
    /// Settling predicted.
    pub settling_s: f64,
    /// Settling measured.
    pub settling_measured_s: f64,
}

/// Share of a mismatch that a variable explains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RegimeReport {
    /// The variable.
    pub variable: String,
    /// Share of the variance [1].
    pub share: f64,
}

/// A number of the rig file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ToleratedNumber {
    /// Dotted key.
    pub key: String,
    /// The nominal value.
    #[serde(rename = "believed")]
    pub nominal: f64,
    /// As found.
    pub found: Estimate,
}

/// A number that a diagnosis identifies whatever is declared of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct IdentifiedNumber {
    /// Its name with its unit.
    pub key: String,
    /// As found.
    pub found: Estimate,
}

/// Error of prediction of a channel, before and after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PredictionError {
    /// The recording that was predicted; `left out in turn` for each of those to diagnose from, by a fit to the others.
    pub recording: String,
    /// Column.
    pub channel: String,
    /// Root mean square by the nominal model, in the column's unit.
    #[serde(default)]
    #[serde(rename = "believed")]
    pub nominal: f64,
    /// That by the nominal model moved within its tolerances.
    pub before: f64,
    /// That by the improved one.
    pub after: f64,
    /// Scale of the channel's departures: its sensor's noise, or what no law explains where that is more; none of a drive's torque, of
    /// which nobody knows it.
    #[serde(default)]
    pub noise: Option<f64>,
    /// Robust root mean square of the error before, over the noise.
    #[serde(default)]
    pub before_sigmas: Option<f64>,
    /// The same of the error after.
    #[serde(default)]
    pub after_sigmas: Option<f64>,
}

/// Error that the improved model leaves in a channel of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct RemainingError {
    /// File name.
    pub recording: String,
    /// Whether it was kept from the fit.
    pub kept_back: bool,
    /// Its column.
    pub column: String,
    /// Root mean square, in the column's unit.
    pub rms: f64,
    /// Robust root mean square over the noise [1].
    pub sigmas: f64,
}

impl RemainingError {
    /// Whether it is more than the sensor's noise, which is known no better.
    #[must_use]
    pub fn is_beyond_noise(&self) -> bool {
        self.sigmas > NOISE_ALONE
    }
}

/// Errors that the improved model leaves of channels with a known noise, the largest beside its noise first: in the recordings that were fitted to and in the one
/// that was kept back. What is predicted of recordings left out in turn is not among them: by a fit to fewer recordings, that may be less sure than any.
#[must_use]
pub fn remaining_errors(
    misfit: &[ChannelMisfit],
    prediction: &[PredictionError],
) -> Vec<RemainingError> {
    let fitted = misfit.iter().map(|m| RemainingError {
        recording: m.recording.clone(),
        kept_back: false,
        column: m.channel.clone(),
        rms: m.improved_rms,
        sigmas: m.improved_sigmas,
    });
    let kept = prediction.iter().filter(|e| e.recording != IN_TURN);
    let kept = kept.filter_map(|e| {
        Some(RemainingError {
            recording: e.recording.clone(),
            kept_back: true,
            column: e.channel.clone(),
            rms: e.after,
            sigmas: e.after_sigmas?,
        })
    });
    let mut all: Vec<RemainingError> = fitted.chain(kept).collect();
    all.sort_by(|a, b| b.sigmas.total_cmp(&a.sigmas));
    all
}

/// The next recording to make.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NextExperiment {
    /// Name of the experiment.
    pub name: String,
    /// Instruction.
    pub instruction: String,
    /// The explanation that it tells ...
    pub from: Vec<String>,
    /// ... from the one found.
    pub found: Vec<String>,
    /// Distance between them after a new fit, in sigmas.
    pub sigmas: f64,
    /// Duration [s].
    pub seconds: f64,
    /// The others that were tried: name, sigmas.
    pub others: Vec<(String, f64)>,
}

//! How robust the chosen design is: what varies from part to part, or with the tool's age, is drawn and simulated at it.
//!
//! ```text
//! x_i ~ uniform(min, max), or normal(mean, standard deviation) between min and max
//! share = draws that keep a limit / all draws, with its exact binomial interval at 95 % (Clopper and Pearson)
//! ```
//!
//! The draws are a Latin hypercube: every variable's distribution is covered evenly, and the share scatters no more than that of independent draws does as far as the
//! variables add up (M. Stein, Technometrics 29, 1987). The interval is that of independent draws, so it is rather too wide than too narrow.

mod check;
mod draws;

use crate::stats::{normal_quantile, normal_share_below};
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::keys::error::Location;

pub(super) use check::scattering;
pub(super) use draws::draw;

/// Shares of the draws at which quantiles are reported [1].
const QUANTILES: [f64; 3] = [0.05, 0.5, 0.95];
/// Probability with which an interval misses.
const MISSED: f64 = 0.05;

/// What is drawn, as the study's file says.
#[derive(Debug, Clone, PartialEq)]
pub struct Scattering {
    /// Number of draws.
    pub runs: usize,
    /// Their seed.
    pub seed: u64,
    /// What is drawn.
    pub scatters: Vec<Scatter>,
}

/// A key and how it scatters.
#[derive(Debug, Clone, PartialEq)]
pub struct Scatter {
    /// The key, unit included, as of a variable.
    pub key: String,
    /// Its distribution.
    pub distribution: Distribution,
    /// Whether it is rounded to whole numbers.
    pub whole: bool,
    /// Where it stands in the study file.
    pub location: Location,
}

/// A distribution, in its key's unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// Evenly between two ends.
    Uniform([f64; 2]),
    /// Normally distributed, what lies beyond the bounds left out.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation.
        standard_deviation: f64,
        /// Least and greatest value; none where it has no end.
        #[serde(serialize_with = "finite", deserialize_with = "endless")]
        bounds: [f64; 2],
    },
}

/// Bounds as JSON has them: no end is no number there.
fn finite<S: serde::Serializer>(bounds: &[f64; 2], serializer: S) -> Result<S::Ok, S::Error> {
    bounds
        .map(|bound| bound.is_finite().then_some(bound))
        .serialize(serializer)
}

/// The reverse of [`finite`].
fn endless<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<[f64; 2], D::Error> {
    let [low, high] = <[Option<f64>; 2]>::deserialize(deserializer)?;
    Ok([
        low.unwrap_or(f64::NEG_INFINITY),
        high.unwrap_or(f64::INFINITY),
    ])
}

impl Scatter {
    /// The value below which a share of all lies.
    pub(super) fn at_share(&self, share: f64) -> f64 {
        let value = match self.distribution {
            // Whole numbers have an equal share each.
            Distribution::Uniform([min, max]) if self.whole => {
                return (min + share * (max - min + 1.0)).floor().min(max);
            }
            Distribution::Uniform([min, max]) => min + share * (max - min),
            Distribution::Normal {
                mean,
                standard_deviation,
                bounds,
            } => {
                let ends =
                    bounds.map(|bound| normal_share_below((bound - mean) / standard_deviation));
                let share = ends[0] + share * (ends[1] - ends[0]);
                let value = mean + standard_deviation * normal_quantile(share);
                value.clamp(bounds[0], bounds[1])
            }
        };
        let value = super::variable::rounded(value);
        if self.whole { value.round() } else { value }
    }

    /// Values near both ends of the distribution: what is checked before anything is simulated.
    pub fn ends(&self) -> [f64; 2] {
        [0.001, 0.999].map(|share| self.at_share(share))
    }
}

/// What the draws did.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Robustness {
    /// Number of draws.
    pub runs: usize,
    /// Their seed.
    pub seed: u64,
    /// What was drawn.
    pub variables: Vec<DrawnVariable>,
    /// Draws that could not be simulated, by the reason; they keep no limit.
    pub failed: BTreeMap<String, usize>,
    /// Draws that keep all limits.
    pub all_limits: KeptShare,
    /// Draws that keep each limit.
    pub limits: Vec<LimitShare>,
    /// Quantiles of the objective and of all that is limited, over the draws that could be simulated.
    pub quantiles: Vec<Quantiles>,
    /// Each draw.
    pub draws: Vec<Draw>,
}

/// What was drawn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DrawnVariable {
    /// Its key.
    pub key: String,
    /// Its distribution, in the key's unit.
    pub distribution: Distribution,
}

/// A share of the draws.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct KeptShare {
    /// Draws that count.
    pub kept: usize,
    /// Their share [%].
    pub share_percent: f64,
    /// Its interval at 95 % [%].
    pub interval_percent: [f64; 2],
}

/// Draws that keep a limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LimitShare {
    /// `impact_peak_n at most 400 N`.
    pub limit: String,
    /// Its share.
    #[serde(flatten)]
    pub share: KeptShare,
}

/// How a quantity is distributed over the draws, in its unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Quantiles {
    /// Metric, unit included.
    pub metric: String,
    /// At the chosen design as it is.
    pub chosen: f64,
    /// Below this lie 5 % of the draws.
    pub percent_5: f64,
    /// The median.
    pub percent_50: f64,
    /// Below this lie 95 %.
    pub percent_95: f64,
}

/// A draw.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Draw {
    /// Values that were drawn, in the order of the variables.
    pub values: Vec<f64>,
    /// Objective and limited metrics, in the order of the quantiles; none where it could not be simulated.
    pub metrics: Vec<Option<f64>>,
    /// Whether it keeps all limits.
    pub kept: bool,
}

impl KeptShare {
    /// So many of all.
    pub(super) fn of(kept: usize, all: usize) -> Self {
        let interval = crate::quantity::binomial::interval(kept, all, MISSED);
        Self {
            kept,
            share_percent: 100.0 * kept as f64 / all as f64,
            interval_percent: interval.map(|share| 100.0 * share),
        }
    }
}

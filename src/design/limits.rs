//! Limits that a design must keep, each one-sided.

use super::candidate::Outcome;
use crate::quantity::display_name::{symbol, with_unit};

/// The limited quantity.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LimitQuantity {
    /// Force that the device must be able to give at rest [N].
    Force,
    /// A metric, in the unit of its name, in every scenario that gives it.
    Metric(String),
}

/// Which side is limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// `min`: for the force, it must be able to give so little; for a metric, at least so much.
    Min,
    /// `max`: for the force, it must be able to give so much; for a metric, at most so much.
    Max,
}

/// One side of a quantity in `[limits]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// The limited quantity.
    pub quantity: LimitQuantity,
    /// Which side.
    pub side: Side,
    /// The bound, in the quantity's unit.
    pub bound: f64,
}

impl Limit {
    /// Key in `[limits]`, unit included.
    pub fn key(&self) -> &str {
        match &self.quantity {
            LimitQuantity::Force => "force_n",
            LimitQuantity::Metric(name) => name,
        }
    }

    /// `impact_peak_n at most 400 N`.
    pub fn sentence(&self) -> String {
        let words = match (&self.quantity, self.side) {
            (LimitQuantity::Force, Side::Min) => "down to",
            (LimitQuantity::Force, Side::Max) => "up to",
            (LimitQuantity::Metric(_), Side::Min) => "at least",
            (LimitQuantity::Metric(_), Side::Max) => "at most",
        };
        format!(
            "{} {words} {}",
            self.key(),
            with_unit(self.key(), self.bound)
        )
    }

    /// Value that a design reaches: the worst over the scenarios, in the quantity's unit.
    pub(super) fn value(&self, outcome: &Outcome) -> Option<f64> {
        let values = || {
            let metrics = outcome.scenarios.iter().map(|scenario| &scenario.metrics);
            metrics.filter_map(|metrics| metrics.get(self.key()).copied())
        };
        match (&self.quantity, self.side) {
            (LimitQuantity::Force, Side::Min) => Some(outcome.force_range[0]),
            (LimitQuantity::Force, Side::Max) => Some(outcome.force_range[1]),
            (LimitQuantity::Metric(_), Side::Min) => values().min_by(f64::total_cmp),
            (LimitQuantity::Metric(_), Side::Max) => values().max_by(f64::total_cmp),
        }
    }

    /// By how much a value is outside, in the quantity's unit; negative inside.
    pub(super) fn excess(&self, value: f64) -> f64 {
        match (&self.quantity, self.side) {
            (LimitQuantity::Force, Side::Min) | (LimitQuantity::Metric(_), Side::Max) => {
                value - self.bound
            }
            (LimitQuantity::Force, Side::Max) | (LimitQuantity::Metric(_), Side::Min) => {
                self.bound - value
            }
        }
    }

    /// Scale of the quantity [its unit]: the bound itself, or the unit where that is 0.
    pub(super) fn scale(&self) -> f64 {
        if self.bound == 0.0 {
            1.0
        } else {
            self.bound.abs()
        }
    }

    /// What a tenth is taken of where the limit is loosened [its unit]: the bound, or where that is 0 ten units, of a share that is a hundredth of the whole.
    pub(super) fn slack(&self) -> f64 {
        if self.bound == 0.0 {
            10.0 * self.scale()
        } else {
            self.scale()
        }
    }

    /// The bound loosened by a step [its unit].
    pub(super) fn loosened(&self, step: f64) -> f64 {
        match (&self.quantity, self.side) {
            (LimitQuantity::Force, Side::Min) | (LimitQuantity::Metric(_), Side::Max) => {
                self.bound + step
            }
            (LimitQuantity::Force, Side::Max) | (LimitQuantity::Metric(_), Side::Min) => {
                self.bound - step
            }
        }
    }

    /// Unit as it is printed.
    pub fn unit(&self) -> &'static str {
        symbol(self.key())
    }
}

//! A flange as a diagnosis has fitted it to runs, with all that a prediction of another run takes.

use super::{FlangeModel, Reader, Ripple};

/// Logarithm of a ratio by which runs at one setting differ [1].
const REPEATED: f64 = 0.05;

/// What runs a flange was fitted to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoveredRuns {
    /// Least and largest speed of approach [m/s].
    pub approach: [f64; 2],
    /// Least and largest force before contact [N].
    pub before: [f64; 2],
    /// Least and largest force after it [N].
    pub desired: [f64; 2],
}

impl CoveredRuns {
    /// How far a run's speed of approach [m/s] and its forces before and after contact [N] leave what was covered, each as the logarithm of the ratio to the nearest
    /// end; 0 within.
    #[must_use]
    pub fn beyond(&self, [approach, before, desired]: [f64; 3]) -> [f64; 3] {
        let of = |value: f64, [low, high]: [f64; 2]| match value {
            _ if value < low => (low / value).ln(),
            _ if value > high => (value / high).ln(),
            _ => 0.0,
        };
        let beyond = [
            of(approach, self.approach),
            of(before, self.before),
            of(desired, self.desired),
        ];
        beyond.map(|log| if log > REPEATED { log } else { 0.0 })
    }
}

/// A fitted flange.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedFlange {
    /// Fits that count, the best first.
    pub models: Vec<FlangeModel>,
    /// How the log reads the force.
    pub reader: Reader,
    /// The arm's ripple; none where no run slid.
    pub ripple: Option<Ripple>,
    /// Half of a 90 % interval of the logarithms of peak, ringing, settling and spread, beside what the fits differ by [1].
    pub half_widths: [f64; 4],
    /// What runs it was fitted to.
    pub covered: CoveredRuns,
}

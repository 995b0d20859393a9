//! A flange as a diagnosis has fitted it to runs, with all that a prediction of another run takes.

use super::{FlangeModel, Reader, Ripple};

/// Logarithm of a ratio by which runs at one setting differ [1].
const REPEATED: f64 = 0.05;

/// Speed [m/s] and force [N] below which a setting is as good as none.
const LEAST: [f64; 2] = [1e-3, 1.0];

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
        let of = |value: f64, [low, high]: [f64; 2], least: f64| {
            let [value, low, high] = [value, low, high].map(|setting| setting.max(least).ln());
            (low - value).max(value - high)
        };
        let beyond = [
            of(approach, self.approach, LEAST[0]),
            of(before, self.before, LEAST[1]),
            of(desired, self.desired, LEAST[1]),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_leave_what_was_covered_by_their_ratio_to_it() {
        let covered = CoveredRuns {
            approach: [0.1, 0.2],
            before: [10.0, 50.0],
            desired: [35.0, 50.0],
        };
        assert_eq!(covered.beyond([0.15, 10.0, 51.0]), [0.0; 3]);
        let close = |found: [f64; 3], expected: [f64; 3]| {
            let near = found
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-12);
            assert!(near, "{found:?} {expected:?}");
        };
        let ln = f64::ln;
        close(covered.beyond([0.3, 5.0, 35.0]), [ln(1.5), ln(2.0), 0.0]);
        // A flange that comes with no force at all is as far from 10 N as one with 1 N.
        close(
            covered.beyond([0.05, 0.0, 100.0]),
            [ln(2.0), ln(10.0), ln(2.0)],
        );
    }
}

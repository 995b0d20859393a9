//! When a sample is due.
//!
//! ```text
//! sample k at the step nearest to t = k / f
//! ```
//!
//! The sample's number is counted, not its time added up, so that nothing drifts; half the last step is the tolerance, so that
//! rounding of the time decides nothing.

/// Counter of samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleClock {
    /// Samples per second [Hz]; infinite: at every call.
    rate: f64,
    /// Number of the sample last taken.
    last: Option<u64>,
    /// Time of the last call [s].
    time: f64,
}

/// Share of a sample period by which a tie is decided for the earlier step.
const TIE: f64 = 1e-6;

impl SampleClock {
    /// Of a rate [Hz], above 0; the first call takes a sample.
    pub fn new(rate: f64) -> Self {
        Self {
            rate,
            last: None,
            time: f64::INFINITY,
        }
    }

    /// Whether a sample is due at a time [s]. Times do not go back.
    pub fn is_due(&mut self, time: f64) -> bool {
        let half_step = 0.5 * (time - self.time).max(0.0);
        self.time = time;
        if self.rate == f64::INFINITY {
            return true;
        }
        let number = ((time + half_step) * self.rate + TIE).floor() as u64;
        let due = self.last.is_none_or(|last| number > last);
        if due {
            self.last = Some(number);
        }
        due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps_taken(rate: f64, times: impl Iterator<Item = f64>) -> Vec<usize> {
        let mut clock = SampleClock::new(rate);
        times
            .enumerate()
            .filter_map(|(k, time)| clock.is_due(time).then_some(k))
            .collect()
    }

    #[test]
    fn every_tenth_step_whatever_the_rounding_of_the_time() {
        let expected: Vec<usize> = (0..20_000).step_by(10).collect();
        let multiplied = (0..20_000).map(|k| f64::from(k) * 1e-3);
        assert_eq!(steps_taken(100.0, multiplied), expected);
        let mut sum = 0.0;
        let added = (0..20_000).map(move |_| {
            sum += 1e-3;
            sum - 1e-3
        });
        assert_eq!(steps_taken(100.0, added), expected);
        for error in [-1e-9, 1e-9] {
            let shifted = (0..20_000).map(move |k| (f64::from(k) * 1e-3 + error).max(0.0));
            assert_eq!(steps_taken(100.0, shifted), expected);
        }
    }

    #[test]
    fn every_step_at_the_steps_rate_or_faster() {
        for rate in [1000.0, 5000.0, f64::INFINITY] {
            let times = (0..5000).map(|k| f64::from(k) * 1e-3);
            assert_eq!(steps_taken(rate, times).len(), 5000);
        }
    }

    #[test]
    fn a_rate_that_does_not_fit_takes_the_nearest_step_and_does_not_drift() {
        let taken = steps_taken(300.0, (0..100_000).map(|k| f64::from(k) * 1e-3));
        for (number, step) in taken.iter().enumerate() {
            let instant = number as f64 / 300.0;
            assert!((*step as f64 * 1e-3 - instant).abs() < 0.5e-3 + 1e-8);
        }
        assert_eq!(taken.len(), 30_000);
        // Instants half way between steps: always the earlier.
        let tie = steps_taken(400.0, (0..1000).map(|k| f64::from(k) * 1e-3));
        assert_eq!(tie[..5], [0, 2, 5, 7, 10]);
        assert_eq!(tie.len(), 400);
    }

    #[test]
    fn a_late_start_takes_a_sample_at_once() {
        let taken = steps_taken(100.0, (0..40).map(|k| 5.003 + f64::from(k) * 1e-3));
        assert_eq!(taken, [0, 7, 17, 27, 37]);
    }
}

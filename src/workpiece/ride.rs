//! Lift of a ball that rolls over a burr.
//!
//! The centre of a ball of radius r that touches a profile h from above runs along its envelope
//! (a morphological dilation by the ball): `L(s) = max over |u| <= r of h(s + u) + sqrt(r^2 - u^2) - r`.
//! Grey-scale dilation of surface profiles: ISO 16610-41.

use super::burr::BurrProfile;
use super::error::{WorkpieceError, require};

/// Most entries of a table: a finer step would only cost memory.
const MAXIMUM_ENTRIES: f64 = 5e6;

/// Lift of a ball's centre [m] over path length [m], tabulated, with a smooth (C1) interpolation
/// that neither overshoots nor turns negative.
#[derive(Debug, Clone)]
pub struct RiddenProfile {
    step: f64,
    lifts: Vec<f64>,
    /// Slopes at the table's entries.
    slopes: Vec<f64>,
}

impl BurrProfile {
    /// The lift of a ball of `radius` [m] over a path of `length` [m], tabulated about every `step` [m].
    ///
    /// Between its samples the profile is taken as linear, and the largest lift is sought among
    /// the samples: the error is at most `step^2 / (8 r)` plus what the profile bends in a step.
    ///
    /// # Errors
    /// The radius, the length or the step is out of its range, or the burr is not on the path.
    pub fn ridden_by_ball(
        &self,
        radius: f64,
        length: f64,
        step: f64,
    ) -> Result<RiddenProfile, WorkpieceError> {
        require("ball radius [m]", radius, radius > 0.0, "more than 0")?;
        require("path length [m]", length, length > 0.0, "more than 0")?;
        require(
            "burr step [m]",
            step,
            step > 0.0 && step <= radius && length / step < MAXIMUM_ENTRIES,
            "more than 0, at most the ball radius, and not below a 5000000th of the path",
        )?;
        self.require_cover(length)?;
        let intervals = (length / step).ceil().max(1.0);
        let step = length / intervals;
        let samples = self.samples(radius, intervals as i64, step);
        let highest = samples.iter().map(|sample| sample.1);
        let highest = highest.fold(f64::NEG_INFINITY, f64::max);
        let mut middle = 0;
        let lifts: Vec<f64> = (0..=intervals as i64)
            .map(|entry| {
                let position = entry as f64 * step;
                while samples[middle].0 < position {
                    middle += 1;
                }
                lift_over(samples.split_at(middle), position, radius, highest)
            })
            .collect();
        let slopes = monotone_slopes(&lifts, step);
        Ok(RiddenProfile {
            step,
            lifts,
            slopes,
        })
    }

    /// Positions and heights, increasing, on the table's grid a ball radius beyond both ends, and
    /// at the profile's landmarks.
    fn samples(&self, radius: f64, intervals: i64, step: f64) -> Vec<(f64, f64)> {
        let reach = (radius / step).ceil() as i64;
        let mut positions: Vec<f64> = (-reach..=intervals + reach)
            .map(|entry| entry as f64 * step)
            .chain(self.landmarks())
            .collect();
        positions.sort_by(f64::total_cmp);
        positions
            .into_iter()
            .map(|position| (position, self.height(position)))
            .collect()
    }
}

/// A place along the edge and the height there [m].
type Sample = (f64, f64);

/// Lift of a ball at `position` over samples to its left and right, none of them above `highest`: outwards, until the ball is so far above that none can
/// touch it.
fn lift_over(
    (left, right): (&[Sample], &[Sample]),
    position: f64,
    radius: f64,
    highest: f64,
) -> f64 {
    let mut lift = f64::NEG_INFINITY;
    let mut touch = |&(sample, height): &(f64, f64)| {
        let offset = sample - position;
        if offset.abs() > radius {
            return false;
        }
        // sqrt(r^2 - u^2) - r without its cancellation, so that no burr gives exactly no lift.
        let squared = offset * offset;
        let sag = squared / (radius + (radius * radius - squared).max(0.0).sqrt());
        lift = lift.max(height - sag);
        highest - sag >= lift
    };
    right.iter().all(&mut touch);
    left.iter().rev().all(&mut touch);
    lift
}

/// Slopes that make a cubic Hermite interpolation monotone between entries: the mean of the
/// neighbouring secants, at most three times the smaller, and zero at an extremum (Fritsch and
/// Carlson, SIAM J. Numer. Anal. 17(2), 1980).
fn monotone_slopes(values: &[f64], step: f64) -> Vec<f64> {
    let secants: Vec<f64> = values
        .windows(2)
        .map(|pair| (pair[1] - pair[0]) / step)
        .collect();
    (0..values.len())
        .map(|entry| {
            let left = entry.checked_sub(1).map(|index| secants[index]);
            let right = secants.get(entry).copied();
            match (left, right) {
                (Some(left), Some(right)) if left * right > 0.0 => {
                    let limit = 3.0 * left.abs().min(right.abs());
                    (0.5 * (left + right)).clamp(-limit, limit)
                }
                (Some(only), None) | (None, Some(only)) => only,
                _ => 0.0,
            }
        })
        .collect()
}

impl RiddenProfile {
    /// Length of the path that the table covers [m].
    pub fn length(&self) -> f64 {
        self.step * (self.lifts.len() - 1) as f64
    }

    /// Largest lift in the table [m].
    pub fn largest_lift(&self) -> f64 {
        self.lifts.iter().copied().fold(0.0, f64::max)
    }

    /// Lift of the ball's centre [m] at path length `position` [m]; the end values hold outside.
    pub fn lift(&self, position: f64) -> f64 {
        let (entry, t) = self.locate(position);
        let [low, high] = [self.lifts[entry], self.lifts[entry + 1]];
        let [start, end] = [self.slopes[entry], self.slopes[entry + 1]].map(|m| m * self.step);
        let rest = 1.0 - t;
        // Hermite basis written about the lower value, so that a flat stretch is reproduced exactly.
        low + (high - low) * t * t * (3.0 - 2.0 * t) + start * t * rest * rest - end * t * t * rest
    }

    /// Derivative of [`Self::lift`] with path length [1]; zero outside the table.
    pub fn slope(&self, position: f64) -> f64 {
        if !(0.0..=self.length()).contains(&position) {
            return 0.0;
        }
        let (entry, t) = self.locate(position);
        let secant = (self.lifts[entry + 1] - self.lifts[entry]) / self.step;
        let rest = 1.0 - t;
        6.0 * secant * t * rest
            + self.slopes[entry] * rest * (1.0 - 3.0 * t)
            + self.slopes[entry + 1] * t * (3.0 * t - 2.0)
    }

    /// Interval that holds a position, and the place in it from 0 to 1.
    fn locate(&self, position: f64) -> (usize, f64) {
        let last = self.lifts.len() - 2;
        let place = (position / self.step).clamp(0.0, (last + 1) as f64);
        let entry = (place as usize).min(last);
        (entry, place - entry as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS: f64 = 5e-3;

    #[test]
    fn no_burr_gives_exactly_no_lift() {
        let ridden = BurrProfile::NONE.ridden_by_ball(RADIUS, 0.3, 7e-5).unwrap();
        for sample in 0..1000 {
            let position = f64::from(sample) * 3.1e-4;
            assert_eq!(ridden.lift(position), 0.0);
            assert_eq!(ridden.slope(position), 0.0);
        }
    }

    #[test]
    fn constant_burr_gives_its_height() {
        let burr = BurrProfile::constant(2.5e-4).unwrap();
        let ridden = burr.ridden_by_ball(RADIUS, 0.1, 1e-4).unwrap();
        for position in [-1.0, 0.0, 0.0123, 0.1, 2.0] {
            assert_eq!(ridden.lift(position), 2.5e-4);
            assert_eq!(ridden.slope(position), 0.0);
        }
        assert_eq!(ridden.largest_lift(), 2.5e-4);
    }

    #[test]
    fn spike_gives_the_arc_of_the_ball() {
        let (middle, height) = (0.050_012_3, 4e-4);
        let burr = BurrProfile::bump(middle, height, 1e-6).unwrap();
        let ridden = burr.ridden_by_ball(RADIUS, 0.1, 2e-5).unwrap();
        // The ball meets the spike's tip where sqrt(r^2 - u^2) > r - h.
        let half = (RADIUS.powi(2) - (RADIUS - height).powi(2)).sqrt();
        for sample in -300..=300 {
            let offset = f64::from(sample) * 1e-5;
            let position = middle + offset;
            let arc = height + (RADIUS.powi(2) - offset.powi(2)).sqrt() - RADIUS;
            let expected = arc.max(0.0);
            // Only in the step that holds the kink may the smooth interpolation round it.
            let tolerance = if (offset.abs() - half).abs() < 3e-5 {
                2e-6
            } else {
                1e-8
            };
            assert!(
                (ridden.lift(position) - expected).abs() < tolerance,
                "{offset}"
            );
            if offset.abs() < half - 5e-5 && offset.abs() > 5e-5 {
                let slope = -offset / (RADIUS.powi(2) - offset.powi(2)).sqrt();
                assert!((ridden.slope(position) - slope).abs() < 1e-4, "{offset}");
            }
        }
    }

    #[test]
    fn gentle_burr_is_followed_along_its_parallel_curve() {
        // Where the burr is less curved than the ball, the envelope is the parallel curve:
        // touching at s, the centre is at s - r sin(a), h + r cos(a) - r, with tan(a) = h'.
        let (middle, height, width) = (0.05, 3e-4, 0.03);
        let burr = BurrProfile::bump(middle, height, width).unwrap();
        let ridden = burr.ridden_by_ball(RADIUS, 0.1, 2e-5).unwrap();
        let wave = std::f64::consts::TAU / width;
        for sample in -140..=140 {
            let touch = middle + f64::from(sample) * 1e-4;
            let angle = (-0.5 * height * wave * (wave * (touch - middle)).sin()).atan();
            let centre = touch - RADIUS * angle.sin();
            let lift = burr.height(touch) + RADIUS * angle.cos() - RADIUS;
            assert!((ridden.lift(centre) - lift).abs() < 2e-8, "{touch}");
        }
    }

    #[test]
    fn lift_is_the_largest_over_all_that_lies_under_the_ball() {
        for (seed, mean, deviation) in [(3, 2e-4, 1e-4), (7, 3e-4, 1e-6), (9, 1e-3, 8e-4)] {
            let burr = BurrProfile::seeded_random(seed, mean, deviation, 2e-3).unwrap();
            let ridden = burr.ridden_by_ball(RADIUS, 0.05, 1e-4).unwrap();
            let samples = burr.samples(RADIUS, 500, 1e-4);
            for entry in 0..=500 {
                let position = f64::from(entry) * 1e-4;
                let lifts = samples.iter().filter_map(|(sample, height)| {
                    let squared = (sample - position).powi(2);
                    let rest = RADIUS.powi(2) - squared;
                    (rest >= 0.0).then(|| height - squared / (RADIUS + rest.sqrt()))
                });
                let all = lifts.fold(f64::NEG_INFINITY, f64::max);
                let lift = ridden.lifts[entry as usize];
                assert!((lift - all).abs() < 1e-15, "{position}: {lift}, {all}");
            }
        }
    }

    #[test]
    fn slope_is_the_derivative_of_lift() {
        let burr = BurrProfile::seeded_random(3, 2e-4, 1e-4, 2e-3).unwrap();
        let ridden = burr.ridden_by_ball(RADIUS, 0.05, 1e-4).unwrap();
        let h = 1e-8;
        for sample in 1..500 {
            let position = f64::from(sample) * 9.97e-5;
            let difference = (ridden.lift(position + h) - ridden.lift(position - h)) / (2.0 * h);
            assert!((ridden.slope(position) - difference).abs() < 1e-5);
            assert!(ridden.lift(position) >= burr.height(position) - 1e-6);
        }
    }

    #[test]
    fn impossible_requests_are_refused() {
        for (radius, length, step) in [
            (0.0, 0.1, 1e-4),
            (RADIUS, -0.1, 1e-4),
            (RADIUS, 0.1, 0.0),
            (RADIUS, 0.1, 0.01),
            (RADIUS, 0.1, 1e-9),
            (RADIUS, f64::NAN, 1e-4),
        ] {
            assert!(
                BurrProfile::NONE
                    .ridden_by_ball(radius, length, step)
                    .is_err()
            );
        }
    }
}

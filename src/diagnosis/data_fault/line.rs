//! A straight line through readings, by least squares.

/// A line `value + slope (t - time)` through readings.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    /// Mean time of the readings [s].
    time: f64,
    /// Mean of the readings, in their unit.
    value: f64,
    /// Slope, in their unit a second.
    pub slope: f64,
    /// Root mean square beside the line, in their unit.
    pub rms: f64,
    count: f64,
    /// Sum of the squares of the times less their mean [s2].
    pub spread: f64,
}

impl Line {
    /// Through three readings or more; none where one is not a number.
    pub fn through(points: impl Iterator<Item = (f64, f64)> + Clone) -> Option<Self> {
        let (mut count, mut time, mut value) = (0.0, 0.0, 0.0);
        for (t, v) in points.clone() {
            count += 1.0;
            time += t;
            value += v;
        }
        time /= count;
        value /= count;
        if count < 3.0 || !value.is_finite() {
            return None;
        }
        let (mut spread, mut rise) = (0.0, 0.0);
        for (t, v) in points.clone() {
            spread += (t - time).powi(2);
            rise += (t - time) * (v - value);
        }
        let slope = rise / spread;
        let beside: f64 = points
            .map(|(t, v)| (v - value - slope * (t - time)).powi(2))
            .sum();
        Some(Self {
            time,
            value,
            slope,
            rms: (beside / (count - 2.0)).sqrt(),
            count,
            spread,
        })
    }

    /// Value at a time [s].
    pub fn at(&self, time: f64) -> f64 {
        self.value + self.slope * (time - self.time)
    }

    /// Variance of the value at a time [s] over that of the readings' noise [1].
    pub fn variance_at(&self, time: f64) -> f64 {
        1.0 / self.count + (time - self.time).powi(2) / self.spread
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 0, 1, 2, 3 with 1, 3, 5, 9 the normal equations by hand: slope 13/5, mean 4.5 at 1.5, residuals 0.4, -0.2, -0.8, 0.6.
    #[test]
    fn a_line_is_that_of_the_normal_equations() {
        let points = [(0.0, 1.0), (1.0, 3.0), (2.0, 5.0), (3.0, 9.0)];
        let line = Line::through(points.into_iter()).unwrap();
        assert!((line.slope - 2.6).abs() < 1e-12 && (line.at(1.5) - 4.5).abs() < 1e-12);
        assert!((line.rms - 0.6f64.sqrt()).abs() < 1e-12, "{}", line.rms);
        assert!((line.variance_at(3.0) - (0.25 + 2.25 / 5.0)).abs() < 1e-12);
        assert!(Line::through([(0.0, 1.0), (1.0, f64::NAN), (2.0, 1.0)].into_iter()).is_none());
    }
}

//! Cubics of time, as which loads are given over a step.

/// Coefficients of 1, t, t2, t3.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Cubic(pub [f64; 4]);

impl Cubic {
    /// Over a step of length `h` [s] from values and slopes at its ends.
    pub(super) fn hermite(h: f64, values: [f64; 2], slopes: [f64; 2]) -> Self {
        let rise = (values[1] - values[0]) / h;
        Self([
            values[0],
            slopes[0],
            (3.0 * rise - 2.0 * slopes[0] - slopes[1]) / h,
            (slopes[0] + slopes[1] - 2.0 * rise) / (h * h),
        ])
    }

    /// Value at a time [s].
    pub fn at(&self, time: f64) -> f64 {
        let [a, b, c, d] = self.0;
        a + time * (b + time * (c + time * d))
    }

    /// Its rate at a time [s].
    pub(super) fn rate(&self, time: f64) -> f64 {
        let [_, b, c, d] = self.0;
        b + time * (2.0 * c + 3.0 * time * d)
    }

    /// The same from a time [s] on.
    pub(super) fn from(&self, time: f64) -> Self {
        let [_, _, c, d] = self.0;
        Self([self.at(time), self.rate(time), c + 3.0 * time * d, d])
    }

    /// The most by which it changes within a time [s].
    pub(super) fn reach(&self, time: f64) -> f64 {
        let [_, b, c, d] = self.0.map(f64::abs);
        time * (b + time * (c + time * d))
    }
}

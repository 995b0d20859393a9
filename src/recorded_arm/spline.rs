//! Natural cubic spline through samples at any times.
//!
//! Source: de Boor, A Practical Guide to Splines, 2001, chapter IV.

/// A spline: its knots, values there, and second derivatives there.
pub struct Spline<'a> {
    time: &'a [f64],
    value: &'a [f64],
    second: Vec<f64>,
}

impl<'a> Spline<'a> {
    /// Through values at times that increase.
    #[must_use]
    pub fn through(time: &'a [f64], value: &'a [f64]) -> Self {
        let count = time.len();
        let mut second = vec![0.0; count];
        let mut above = vec![0.0; count];
        for i in 1..count.saturating_sub(1) {
            let (h0, h1) = (time[i] - time[i - 1], time[i + 1] - time[i]);
            let right = 6.0 * ((value[i + 1] - value[i]) / h1 - (value[i] - value[i - 1]) / h0);
            let pivot = 2.0 * (h0 + h1) - h0 * above[i - 1];
            above[i] = h1 / pivot;
            second[i] = (right - h0 * second[i - 1]) / pivot;
        }
        for i in (1..count.saturating_sub(1)).rev() {
            second[i] -= above[i] * second[i + 1];
        }
        Self {
            time,
            value,
            second,
        }
    }

    /// Value at a time; outside the knots that of the nearest end.
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        let last = self.time.len() - 1;
        if last == 0 || time <= self.time[0] {
            return self.value[0];
        }
        if time >= self.time[last] {
            return self.value[last];
        }
        let i = self.time.partition_point(|t| *t <= time) - 1;
        let h = self.time[i + 1] - self.time[i];
        let (a, b) = ((self.time[i + 1] - time) / h, (time - self.time[i]) / h);
        a * self.value[i]
            + b * self.value[i + 1]
            + (a * (a * a - 1.0) * self.second[i] + b * (b * b - 1.0) * self.second[i + 1]) * h * h
                / 6.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_function_is_met_between_uneven_samples() {
        let time: Vec<f64> = (0..200)
            .map(|i| 0.05 * f64::from(i) + 0.01 * f64::from(i % 3))
            .collect();
        let value: Vec<f64> = time.iter().map(|t| t.sin()).collect();
        let spline = Spline::through(&time, &value);
        for i in 20..900 {
            let t = 0.01 * f64::from(i) + 0.003;
            assert!((spline.at(t) - t.sin()).abs() < 1e-6);
        }
    }
}

//! Joint angles over the path as a natural cubic spline, one for all joints.
//!
//! Second derivatives at the knots solve the usual tridiagonal system (Press et al., Numerical Recipes, 3rd ed. 2007, sec. 3.3).

/// A vector-valued cubic spline.
#[derive(Debug, Clone)]
pub struct Spline {
    knots: Vec<f64>,
    values: Vec<Vec<f64>>,
    bends: Vec<Vec<f64>>,
}

impl Spline {
    /// Through `values` at increasing `knots`; at least two.
    pub fn through(knots: Vec<f64>, values: Vec<Vec<f64>>) -> Self {
        let count = knots.len();
        let width = values.first().map_or(0, Vec::len);
        let mut bends = vec![vec![0.0; width]; count];
        // Forward elimination, then back substitution.
        let mut upper = vec![0.0; count];
        for i in 1..count.saturating_sub(1) {
            let (before, after) = (knots[i] - knots[i - 1], knots[i + 1] - knots[i]);
            let share = before / (before + after);
            let pivot = share * upper[i - 1] + 2.0;
            upper[i] = (share - 1.0) / pivot;
            for j in 0..width {
                let slopes = (values[i + 1][j] - values[i][j]) / after
                    - (values[i][j] - values[i - 1][j]) / before;
                bends[i][j] = (6.0 * slopes / (before + after) - share * bends[i - 1][j]) / pivot;
            }
        }
        for i in (1..count.saturating_sub(1)).rev() {
            let (before, after) = bends.split_at_mut(i + 1);
            for (bend, next) in before[i].iter_mut().zip(&after[0]) {
                *bend += upper[i] * next;
            }
        }
        Self {
            knots,
            values,
            bends,
        }
    }

    /// Value, first and second derivative of each component at a place, written to the three slices.
    pub fn at(&self, place: f64, value: &mut [f64], slope: &mut [f64], bend: &mut [f64]) {
        let last = self.knots.len() - 1;
        let upper = self
            .knots
            .partition_point(|&knot| knot <= place)
            .clamp(1, last);
        let lower = upper - 1;
        let h = self.knots[upper] - self.knots[lower];
        let (a, b) = (
            (self.knots[upper] - place) / h,
            (place - self.knots[lower]) / h,
        );
        for j in 0..value.len() {
            let (y0, y1) = (self.values[lower][j], self.values[upper][j]);
            let (m0, m1) = (self.bends[lower][j], self.bends[upper][j]);
            value[j] =
                a * y0 + b * y1 + ((a * a * a - a) * m0 + (b * b * b - b) * m1) * h * h / 6.0;
            slope[j] =
                (y1 - y0) / h + ((3.0 * b * b - 1.0) * m1 - (3.0 * a * a - 1.0) * m0) * h / 6.0;
            bend[j] = a * m0 + b * m1;
        }
    }

    /// Values at the knots.
    pub fn values(&self) -> &[Vec<f64>] {
        &self.values
    }

    /// The knots.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_follows_a_smooth_curve_and_its_derivatives() {
        let knots: Vec<f64> = (0..=200).map(|i| 0.01 * f64::from(i)).collect();
        let values = knots
            .iter()
            .map(|x| vec![x.sin(), (2.0 * x).cos()])
            .collect();
        let spline = Spline::through(knots, values);
        let (mut y, mut d, mut dd) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        for i in 0..100 {
            let x: f64 = 0.5 + 0.01 * f64::from(i) + 0.0037;
            spline.at(x, &mut y, &mut d, &mut dd);
            assert!((y[0] - x.sin()).abs() < 1e-9 && (y[1] - (2.0 * x).cos()).abs() < 1e-8);
            assert!((d[0] - x.cos()).abs() < 1e-6 && (dd[0] + x.sin()).abs() < 1e-4);
        }
    }
}

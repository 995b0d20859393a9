//! Sums over samples of products of columns, as normal equations need them.

use nalgebra::{DMatrix, DVector};

/// Samples that are summed at a time: the parts of all columns stay in a processor's cache.
const CHUNK: usize = 1024;
/// Sums that run side by side.
const LANES: usize = 8;

/// C' W C and C' W r of columns C, residuals r and weights W; samples without weight and entries that are not finite count nothing.
pub(in crate::diagnosis) fn weighted_products(
    columns: &[Vec<f64>],
    residuals: &[f64],
    weights: &[f64],
) -> (DMatrix<f64>, DVector<f64>) {
    let count = columns.len();
    let mut information = DMatrix::zeros(count, count);
    let mut gradient = DVector::zeros(count);
    let counted = weights.iter().enumerate().filter(|(_, w)| **w > 0.0);
    let roots: Vec<(usize, f64)> = counted.map(|(place, w)| (place, w.sqrt())).collect();
    let part = |values: &[f64], chunk: &[(usize, f64)]| -> Vec<f64> {
        let of = |(place, root): &(usize, f64)| match values[*place] {
            value if value.is_finite() => root * value,
            _ => 0.0,
        };
        chunk.iter().map(of).collect()
    };
    for chunk in roots.chunks(CHUNK) {
        let parts: Vec<Vec<f64>> = columns.iter().map(|column| part(column, chunk)).collect();
        let left = part(residuals, chunk);
        for (i, one) in parts.iter().enumerate() {
            for (j, other) in parts[..=i].iter().enumerate() {
                information[(i, j)] += product(one, other);
            }
            gradient[i] += product(one, &left);
        }
    }
    for i in 0..count {
        for j in 0..i {
            information[(j, i)] = information[(i, j)];
        }
    }
    (information, gradient)
}

fn product(one: &[f64], other: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (ones, others) = (one.chunks_exact(LANES), other.chunks_exact(LANES));
    let rest = ones.remainder().iter().zip(others.remainder());
    let rest: f64 = rest.map(|(a, b)| a * b).sum();
    for (a, b) in ones.zip(others) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Held against sums written out, over more samples than one chunk, with samples without weight and values that are none.
    #[test]
    fn they_are_the_sums_written_out() {
        let count = 2 * CHUNK + 13;
        let wave =
            |speed: f64| -> Vec<f64> { (0..count).map(|i| (speed * i as f64).sin()).collect() };
        let (mut columns, mut residuals) = (vec![wave(0.3), wave(1.1), wave(2.7)], wave(0.9));
        let weights: Vec<f64> = (0..count).map(|i| [0.0, 0.5, 2.0][i % 3]).collect();
        // Nothing of these counts: no weight, no value.
        residuals[3] = f64::NAN;
        columns[1][4] = f64::INFINITY;
        let (information, gradient) = weighted_products(&columns, &residuals, &weights);
        columns[1][4] = 0.0;
        residuals[3] = 0.0;
        for i in 0..3 {
            let sum = |other: &[f64]| -> f64 {
                (0..count)
                    .map(|k| weights[k] * columns[i][k] * other[k])
                    .sum()
            };
            for j in 0..3 {
                assert!((information[(i, j)] - sum(&columns[j])).abs() < 1e-9);
            }
            assert!((gradient[i] - sum(&residuals)).abs() < 1e-9);
        }
    }
}

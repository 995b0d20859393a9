//! Least of a quadratic within bounds.
//!
//! ```text
//! min x^T H x/2 - g^T x,    l <= x <= u
//! ```
//!
//! Active set method: a step to the minimum of the free variables, as far as the first bound that it meets; bounds that pull inwards are released. Source:
//! Nocedal and Wright, Numerical Optimization, 2006, sec. 16.5. H is positive definite.

use nalgebra::{DMatrix, DVector};

/// Steps at most, as a multiple of the number of variables.
const MOST: usize = 20;

/// The minimum, from a start within the bounds.
#[must_use]
pub fn least_within(
    hessian: &DMatrix<f64>,
    gradient: &DVector<f64>,
    bounds: &[[f64; 2]],
    start: &[f64],
) -> Vec<f64> {
    let count = start.len();
    let mut x: Vec<f64> = (start.iter().zip(bounds))
        .map(|(x, b)| x.clamp(b[0], b[1]))
        .collect();
    // What lies on a bound and is pulled outwards stays there.
    let pull = |x: &[f64]| gradient - hessian * DVector::from_column_slice(x);
    let downhill = pull(&x);
    let is_free = |i: usize| {
        !(x[i] <= bounds[i][0] && downhill[i] < 0.0 || x[i] >= bounds[i][1] && downhill[i] > 0.0)
    };
    let mut free: Vec<bool> = (0..count).map(is_free).collect();
    for _ in 0..MOST * count.max(1) {
        let downhill = pull(&x);
        let Some(step) = newton_step(hessian, &downhill, &free) else {
            return x;
        };
        let mut share = 1.0;
        let mut met = None;
        for i in 0..count {
            if !free[i] || step[i] == 0.0 {
                continue;
            }
            let room = bounds[i][usize::from(step[i] > 0.0)] - x[i];
            let here = (room / step[i]).max(0.0);
            if here < share {
                (share, met) = (here, Some(i));
            }
        }
        for i in 0..count {
            if free[i] {
                x[i] = (x[i] + share * step[i]).clamp(bounds[i][0], bounds[i][1]);
            }
        }
        if let Some(i) = met {
            free[i] = false;
            x[i] = bounds[i][usize::from(step[i] > 0.0)];
            continue;
        }
        // At the minimum of the free ones: is one held that would rather go inwards?
        let downhill = pull(&x);
        let inwards = |i: &usize| {
            let (at_low, at_high) = (x[*i] <= bounds[*i][0], x[*i] >= bounds[*i][1]);
            let tolerance = 1e-9 * (1.0 + gradient[*i].abs());
            !free[*i]
                && ((at_low && downhill[*i] > tolerance) || (at_high && downhill[*i] < -tolerance))
                && bounds[*i][1] > bounds[*i][0]
        };
        let strongest = (0..count)
            .filter(inwards)
            .max_by(|a, b| downhill[*a].abs().total_cmp(&downhill[*b].abs()));
        match strongest {
            Some(i) => free[i] = true,
            None => return x,
        }
    }
    x
}

/// Step of the free variables to the minimum along them; none where H is not positive definite.
fn newton_step(hessian: &DMatrix<f64>, downhill: &DVector<f64>, free: &[bool]) -> Option<Vec<f64>> {
    let places: Vec<usize> = (0..free.len()).filter(|i| free[*i]).collect();
    let mut step = vec![0.0; free.len()];
    if places.is_empty() {
        return Some(step);
    }
    let small = DMatrix::from_fn(places.len(), places.len(), |i, j| {
        hessian[(places[i], places[j])]
    });
    let right = DVector::from_iterator(places.len(), places.iter().map(|i| downhill[*i]));
    let solved = small.cholesky()?.solve(&right);
    for (place, value) in places.iter().zip(solved.iter()) {
        step[*place] = *value;
    }
    Some(step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};

    /// Against projected gradient descent, which needs no active set.
    #[test]
    fn the_minimum_is_that_of_a_descent_that_is_projected() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        for _ in 0..30 {
            let a = DMatrix::from_fn(9, 6, |_, _| random.random_range(-1.0..1.0));
            let hessian = a.transpose() * &a + DMatrix::identity(6, 6) * 0.05;
            let gradient = DVector::from_fn(6, |_, _| random.random_range(-3.0..3.0));
            let bounds = [[-0.5, 0.7]; 6];
            let found = least_within(&hessian, &gradient, &bounds, &[0.0; 6]);
            let mut x = DVector::zeros(6);
            for _ in 0..20_000 {
                let downhill = &gradient - &hessian * &x;
                x += downhill * 0.02;
                x.apply(|v| *v = v.clamp(-0.5, 0.7));
            }
            for (found, expected) in found.iter().zip(x.iter()) {
                assert!((found - expected).abs() < 1e-6);
            }
        }
    }
}

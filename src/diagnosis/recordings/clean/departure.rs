//! Departure of a reading from its neighbours: from the cubic through the two on either side, at the times of their stamps.
//!
//! ```text
//! e_i = x_i - sum w_j x_j,     z_i = e_i / sqrt(1 + sum w_j^2)
//! ```
//!
//! w Lagrange's weights. White noise of a standard deviation gives z the same one; motion that is smooth over five samples gives none.

/// Steps within which a neighbour must stand.
const REACH: f64 = 4.5;
/// Readings of a stretch.
const STRETCH: usize = 50;
/// Share of stretches that are taken to hold nothing but noise [1].
const QUIET: f64 = 0.2;
/// That quantile of the root mean square of such stretches of white noise, over its standard deviation [1]; from 300 draws of 1000 to 5000 readings.
const QUANTILE: f64 = 0.85;
/// Stretches below which nothing is said.
const LEAST_STRETCHES: usize = 4;

/// Lagrange's weights of nodes, by their indices in `time`, for a time [s].
pub(in crate::diagnosis) fn lagrange(time: &[f64], nodes: &[usize], at: f64) -> Vec<f64> {
    let weight = |node: &usize| {
        let others = nodes.iter().filter(|other| *other != node);
        others
            .map(|other| (at - time[*other]) / (time[*node] - time[*other]))
            .product()
    };
    nodes.iter().map(weight).collect()
}

/// Departure of one reading, as if `left_out` were not there; none without two neighbours on either side.
pub(super) fn departure(
    time: &[f64],
    values: &[f64],
    step: f64,
    index: usize,
    left_out: Option<usize>,
) -> Option<f64> {
    let usable = |other: &usize| {
        let near = (time[*other] - time[index]).abs() < REACH * step;
        near && Some(*other) != left_out && values[*other].is_finite()
    };
    let reach = REACH as usize;
    let before = (index.saturating_sub(reach)..index).rev().filter(usable);
    let after = (index + 1..(index + 1 + reach).min(time.len())).filter(usable);
    let nodes: Vec<usize> = before.take(2).collect();
    let nodes: Vec<usize> = nodes.into_iter().chain(after.take(2)).collect();
    let split = nodes.iter().filter(|node| **node < index).count();
    if !values[index].is_finite() || split != 2 || nodes.len() != 4 {
        return None;
    }
    let weights = lagrange(time, &nodes, time[index]);
    let cubic: f64 = nodes
        .iter()
        .zip(&weights)
        .map(|(n, w)| w * values[*n])
        .sum();
    let scale = (1.0 + weights.iter().map(|w| w * w).sum::<f64>()).sqrt();
    Some((values[index] - cubic) / scale)
}

/// Departures of all readings; NaN where there is none.
pub(in crate::diagnosis) fn departures(time: &[f64], values: &[f64], step: f64) -> Vec<f64> {
    (0..values.len())
        .map(|index| departure(time, values, step, index, None).unwrap_or(f64::NAN))
        .collect()
}

/// Standard deviation of the noise, from the quietest stretches.
pub(super) fn noise_of(departures: &[f64]) -> Option<f64> {
    let given: Vec<f64> = departures
        .iter()
        .copied()
        .filter(|z| z.is_finite())
        .collect();
    let mut spreads: Vec<f64> = given
        .chunks_exact(STRETCH)
        .map(|stretch| (stretch.iter().map(|z| z * z).sum::<f64>() / STRETCH as f64).sqrt())
        .collect();
    if spreads.len() < LEAST_STRETCHES {
        return None;
    }
    let quiet = (QUIET * spreads.len() as f64) as usize;
    let (_, spread, _) = spreads.select_nth_unstable_by(quiet, f64::total_cmp);
    Some(*spread / QUANTILE)
}

//! The offset between two clocks, from two quantities that rise and fall together.
//!
//! ```text
//! r(o) = sum a(t) b(t - o) / sqrt(sum a^2 sum b^2)          means taken out; a and b read off every h; o where |r| is largest
//! ```
//!
//! between two such steps where the parabola through three of them is highest (Knapp and Carter 1976: the correlator; its peak).

use super::log::Series;
use crate::stats::median_step;

/// Correlation below which two quantities say nothing of each other's clock [1].
const LEAST: f64 = 0.5;
/// Share of the shorter series that must overlap.
const OVERLAP: f64 = 0.5;
/// Steps looked at, at most.
const MOST_STEPS: usize = 20_000;

/// Where a clock stands against another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alignment {
    /// To be added to its times [s].
    pub offset: f64,
    /// Correlation there [1]; negative where one falls as the other rises.
    pub correlation: f64,
    /// Distance between two offsets looked at [s].
    pub step: f64,
}

/// Finds the offset of a series' clock within `largest` [s] of nothing.
///
/// # Errors
/// The best correlation, where it is too small to tell.
pub fn align(first: &Series, own: &Series, largest: f64) -> Result<Alignment, f64> {
    let span = |series: &Series| series.time[series.time.len() - 1] - series.time[0];
    let finest = median_step(&first.time).max(median_step(&own.time));
    let step = finest.max((span(first) + 2.0 * largest) / MOST_STEPS as f64);
    let on_grid = |series: &Series| {
        let start = series.time[0];
        let count = (span(series) / step) as usize + 1;
        let time: Vec<f64> = (0..count).map(|i| start + step * i as f64).collect();
        series.read_off(&time)
    };
    let (a, b) = (on_grid(first), on_grid(own));
    let least = (OVERLAP * a.len().min(b.len()) as f64) as usize;
    let lag_of_none = (own.time[0] - first.time[0]) / step;
    let reach = (largest / step).ceil() as i64;
    let middle = lag_of_none.round() as i64;
    // At a lag sample k of b is against sample k + lag of a.
    let all: Vec<(i64, f64)> = (middle - reach..=middle + reach)
        .map(|lag| (lag, correlation(&a, &b, lag, least)))
        .collect();
    let best = (0..all.len()).max_by(|i, j| all[*i].1.abs().total_cmp(&all[*j].1.abs()));
    let Some(best) = best else { return Err(0.0) };
    let (lag, peak) = all[best];
    if peak.abs() < LEAST {
        return Err(peak);
    }
    let beside = |index: Option<usize>| index.and_then(|i| all.get(i)).map(|(_, r)| r.abs());
    let between = match (beside(best.checked_sub(1)), beside(Some(best + 1))) {
        (Some(before), Some(after)) => {
            let bend = before - 2.0 * peak.abs() + after;
            if bend < 0.0 {
                0.5 * (before - after) / bend
            } else {
                0.0
            }
        }
        _ => 0.0,
    };
    Ok(Alignment {
        offset: step * (lag as f64 + between - lag_of_none),
        correlation: peak,
        step,
    })
}

/// Correlation of what overlaps at a lag; none where too little does.
fn correlation(a: &[f64], b: &[f64], lag: i64, least: usize) -> f64 {
    let pairs = || {
        b.iter().enumerate().filter_map(move |(k, b)| {
            let a = usize::try_from(k as i64 + lag)
                .ok()
                .and_then(|i| a.get(i))?;
            (a.is_finite() && b.is_finite()).then_some((*a, *b))
        })
    };
    let (mut count, mut sum_a, mut sum_b) = (0usize, 0.0, 0.0);
    for (a, b) in pairs() {
        count += 1;
        sum_a += a;
        sum_b += b;
    }
    if count < least.max(3) {
        return 0.0;
    }
    let (mean_a, mean_b) = (sum_a / count as f64, sum_b / count as f64);
    let (mut aa, mut bb, mut ab) = (0.0, 0.0, 0.0);
    for (a, b) in pairs() {
        let (a, b) = (a - mean_a, b - mean_b);
        aa += a * a;
        bb += b * b;
        ab += a * b;
    }
    if aa * bb > 0.0 {
        ab / (aa * bb).sqrt()
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(rate: f64, from: f64, to: f64, of: impl Fn(f64) -> f64) -> Series {
        let count = ((to - from) * rate) as usize;
        let time: Vec<f64> = (0..count).map(|i| from + i as f64 / rate).collect();
        let values = time.iter().map(|t| of(*t)).collect();
        Series { time, values }
    }

    /// Bumps that do not repeat.
    fn trajectory(t: f64) -> f64 {
        (-(t - 3.0).powi(2)).exp() + 0.6 * (-4.0 * (t - 5.2).powi(2)).exp()
            - 0.8 * (-2.0 * (t - 8.0).powi(2)).exp()
    }

    #[test]
    fn a_planted_offset_comes_back_to_a_tenth_of_a_sample() {
        let first = series(500.0, 0.0, 10.0, trajectory);
        // Its clock is 1.2345 s behind, and it starts later.
        let own = series(800.0, -0.5, 8.0, |t| -3.0 * trajectory(t + 1.2345) + 7.0);
        let found = align(&first, &own, 4.0).unwrap();
        assert!((found.offset - 1.2345).abs() < 2e-4, "{found:?}");
        assert!(found.correlation < -0.999, "{found:?}");
    }

    #[test]
    fn what_has_nothing_to_do_with_each_other_tells_no_offset() {
        let first = series(100.0, 0.0, 20.0, |t| (3.0 * t).sin());
        let own = series(100.0, 0.0, 20.0, |t| (31.0 * t).sin() * (0.3 * t).cos());
        assert!(align(&first, &own, 2.0).is_err());
    }
}

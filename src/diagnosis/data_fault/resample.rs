//! Readings at other times than those of their stamps.

/// Departure of a reading from the line through its neighbours, in standard deviations of such departures, beyond which nothing is read between samples [1]:
/// an impact is not a line.
use crate::stats::{NORMAL_MAD, median};
const STEEP: f64 = 8.0;

/// The last multiple of a period [s].
pub(super) fn held(time: f64, period: f64) -> f64 {
    // A stamp is rounded: what is all but the next multiple is that.
    (time / period + 1e-6).floor() * period
}

/// Values at times, linear between samples, as the first and last beyond them.
pub(super) fn read_at(time: &[f64], values: &[f64], at: impl Fn(f64) -> f64) -> Vec<f64> {
    let last = time.len() - 1;
    let read = |t: &f64| {
        let u = at(*t).clamp(time[0], time[last]);
        let next = time.partition_point(|other| *other <= u).clamp(1, last);
        let share = (u - time[next - 1]) / (time[next] - time[next - 1]);
        values[next - 1] + share * (values[next] - values[next - 1])
    };
    time.iter().map(read).collect()
}

/// Whether the readings bend so sharply at an index that an impact lies there; of all indices.
fn steep(values: &[f64]) -> Vec<bool> {
    let bend = |i: usize| values[i - 1] - 2.0 * values[i] + values[i + 1];
    let last = values.len() - 1;
    let bends = (1..last).map(|i| bend(i).abs()).filter(|b| b.is_finite());
    let usual = NORMAL_MAD * median(bends).unwrap_or(0.0);
    let is_steep = |i: usize| i > 0 && i < last && bend(i).abs() > STEEP * usual;
    (0..=last).map(is_steep).collect()
}

/// Sets aside what stands beside an impact: it changes within less than a clock is known to.
pub(super) fn set_impacts_aside(values: &mut [f64]) {
    let steep = steep(values);
    for i in (0..values.len()).filter(|i| steep[*i]) {
        let end = (i + 2).min(values.len());
        values[i.saturating_sub(1)..end].fill(f64::NAN);
    }
}

/// Readings at times within the recording; none beside a gap, a lost one or an impact.
pub(super) fn interpolated(time: &[f64], values: &[f64], at: impl Fn(f64) -> f64) -> Vec<f64> {
    let steep = steep(values);
    let last = time.len() - 1;
    let plain = read_at(time, values, &at);
    let inside = |(t, value): (&f64, f64)| {
        let u = at(*t);
        if u < time[0] || u > time[last] {
            return f64::NAN;
        }
        let next = time.partition_point(|other| *other <= u).clamp(1, last);
        let share = (u - time[next - 1]) / (time[next] - time[next - 1]);
        let between = share > 1e-3 && share < 1.0 - 1e-3;
        if between && (steep[next - 1] || steep[next]) {
            return f64::NAN;
        }
        value
    };
    time.iter().zip(plain).map(inside).collect()
}

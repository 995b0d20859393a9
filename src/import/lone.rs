//! Single values far from their neighbours, as loggers write them where they have none: -9999, 65535, 0.
//!
//! ```text
//! d_i = |x_i - median of 11 values about it|          far where d_i > 20 * 1.4826 median of d          and outside what the other values reach
//! ```

use crate::recording::Unit;
use crate::stats::{NORMAL_MAD, median};

/// Values on either side of one that make its neighbourhood.
const BESIDE: usize = 5;
/// Standard deviations from which a value is far.
const FAR: f64 = 20.0;
/// Median absolute deviation of a normal distribution over its standard deviation [1].
/// Part of the others' range by which a single value, and one that comes back often, lies outside of it.
const OUTSIDE: [f64; 2] = [0.5, 2.0];
/// Share of the values that single ones are at most, and those that come back.
const FEW: [f64; 2] = [0.02, 0.5];
/// Numbers that loggers write where they have none.
const MARKS: [f64; 15] = [
    999.0, 999.9, 999.25, 9999.0, 9999.9, 99_999.0, 99_999.9, 999_999.0, 32_767.0, 32_768.0,
    3_276.7, 3_276.8, 65_535.0, 6_553.5, 1e30,
];

/// Values that lie alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lone {
    /// How many.
    pub count: usize,
    /// The first of them, as the log writes it.
    pub first: f64,
}

/// Values, as the log writes them, that lie alone far from all others.
pub(super) fn lone(values: &[f64], unit: Unit) -> Option<Lone> {
    if values.len() < 4 * BESIDE || unit == Unit::One {
        return None;
    }
    let middles: Vec<f64> = (0..values.len()).map(|i| middle(values, i)).collect();
    let away: Vec<f64> = values
        .iter()
        .zip(&middles)
        .map(|(x, m)| (x - m).abs())
        .collect();
    let scale = NORMAL_MAD * median(away.iter().copied()).unwrap_or(0.0);
    let far: Vec<usize> = (0..values.len())
        .filter(|i| away[*i] > FAR * scale && away[*i] > 1e-9 * values[*i].abs())
        .collect();
    let count = values.len() as f64;
    if !far.is_empty() && far.len() as f64 <= (FEW[0] * count).max(3.0) {
        let mut rest = values.to_vec();
        let mut at = 0;
        rest.retain(|_| {
            at += 1;
            far.binary_search(&(at - 1)).is_err()
        });
        let [low, high] = range(&rest);
        let span = high - low;
        let is_mark = |i: &usize| {
            let value = values[*i];
            let outside = (low - value).max(value - high);
            // What strikes an end stop is as short; and what is commanded may be a pulse.
            let may_peak = unit == Unit::MetrePerSecondSquared || scale == 0.0;
            MARKS
                .iter()
                .any(|mark| (value.abs() - mark).abs() < 1e-9 * mark)
                && outside > 0.0
                || (!may_peak && outside > OUTSIDE[0] * span && is_alone(values, &away, *i))
                || (!may_peak
                    && value == 0.0
                    && away[*i] > 0.2 * span
                    && is_alone(values, &away, *i))
        };
        let marks: Vec<usize> = far.into_iter().filter(is_mark).collect();
        if let Some(first) = marks.first() {
            return Some(Lone {
                count: marks.len(),
                first: values[*first],
            });
        }
    }
    again_and_again(values, scale)
}

/// An extreme value that comes back exactly, far outside of all others.
fn again_and_again(values: &[f64], scale: f64) -> Option<Lone> {
    let [low, high] = range(values);
    [low, high].into_iter().find_map(|mark| {
        let rest: Vec<f64> = values
            .iter()
            .copied()
            .filter(|value| *value != mark)
            .collect();
        let count = values.len() - rest.len();
        let [least, most] = range(&rest);
        let outside = (least - mark).max(mark - most);
        let is_mark = scale > 0.0
            && rest.len() > 2
            && count > 1
            && count as f64 <= FEW[1] * values.len() as f64
            && outside > OUTSIDE[1] * (most - least);
        is_mark.then_some(Lone { count, first: mark })
    })
}

/// Whether a value is reached and left at once.
fn is_alone(values: &[f64], away: &[f64], at: usize) -> bool {
    let jumps =
        |other: Option<&f64>| other.is_none_or(|other| (other - values[at]).abs() > 0.8 * away[at]);
    let same = |other: Option<&f64>| other.is_some_and(|other| *other == values[at]);
    let (before, after) = (
        at.checked_sub(1).and_then(|i| values.get(i)),
        values.get(at + 1),
    );
    (jumps(before) || same(before)) && (jumps(after) || same(after))
}

fn range(values: &[f64]) -> [f64; 2] {
    let ends = [f64::INFINITY, f64::NEG_INFINITY];
    values
        .iter()
        .fold(ends, |[low, high], v| [low.min(*v), high.max(*v)])
}

/// The median of the values about one.
fn middle(values: &[f64], at: usize) -> f64 {
    let from = at.saturating_sub(BESIDE);
    let to = (at + BESIDE + 1).min(values.len());
    median(values[from..to].iter().copied()).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Something between -1 and 1 that looks random.
    fn rough(i: usize) -> f64 {
        let t = i as f64;
        (12.9898 * t + 78.233 * (0.37 * t).sin()).sin()
    }

    fn force() -> Vec<f64> {
        (0..600)
            .map(|i| 120.0 / (1.0 + (-0.1 * (i as f64 - 200.0)).exp()) + rough(i))
            .collect()
    }

    #[test]
    fn marks_in_place_of_values_are_found_and_no_course_of_a_device_is() {
        let with = |at: &[usize], mark: f64| {
            let mut values = force();
            for i in at {
                values[*i] = mark;
            }
            lone(&values, Unit::Newton)
        };
        for mark in [-9999.0, 9999.0, 6553.5, -999.25, 1e30, 400.0, 0.0] {
            let found = with(&[400, 401, 550], mark);
            assert_eq!(
                found,
                Some(Lone {
                    count: 3,
                    first: mark
                }),
                "{mark}"
            );
        }
        let unplugged: Vec<usize> = (300..420).collect();
        assert_eq!(with(&unplugged, -9999.0).unwrap().count, 120);
        assert_eq!(lone(&force(), Unit::Newton), None);
        // A command in steps, a pulse of it, a blow of several samples, ringing.
        let steps: Vec<f64> = (0..600).map(|i| f64::from(i / 100)).collect();
        assert_eq!(lone(&steps, Unit::Pascal), None);
        let mut pulse = vec![0.0; 600];
        pulse[300] = 2.0;
        assert_eq!(lone(&pulse, Unit::Pascal), None);
        let blow = |i: usize| 300.0 * (-(i as f64 - 300.0).powi(2) / 18.0).exp();
        let struck: Vec<f64> = force()
            .iter()
            .enumerate()
            .map(|(i, f)| f + blow(i))
            .collect();
        assert_eq!(lone(&struck, Unit::Newton), None);
        let rung: Vec<f64> = (0..600)
            .map(|i| rough(i) * 0.1 + if i % 97 == 0 { 30.0 } else { 0.0 })
            .collect();
        assert_eq!(lone(&rung, Unit::MetrePerSecondSquared), None);
    }
}

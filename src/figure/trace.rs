//! From samples to what a picture can show: axes with round ticks, lines with few points.

use crate::document::Series;

/// A place in the picture, in tenths of a pixel.
pub(super) type Place = (i32, i32);

/// Tenths of a pixel in a pixel.
pub(super) const PX: i32 = 10;

/// The part of an axis that is shown.
#[derive(Debug, Clone)]
pub(super) struct Scale {
    pub low: f64,
    pub high: f64,
    step: f64,
}

impl Scale {
    /// Covers `values`, widened by a share of their span at both ends; up to `most` steps.
    pub fn new(values: impl Iterator<Item = f64>, widened: f64, most: f64) -> Self {
        let finite = values.filter(|value| value.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        // What stands still is not blown up until its rounding errors fill the panel.
        let size = low.abs().max(high.abs());
        let least = if size > 0.0 { 1e-3 * size } else { 1.0 };
        let wider = (0.5 * (least - (high - low))).max(widened * (high - low));
        let (low, high) = (low - wider, high + wider);
        let step = round_step((high - low) / most);
        // A run sampled until 15.999 s ends at 16 s.
        let snap = |edge: f64| {
            let tick = (edge / step).round() * step;
            let near = (edge - tick).abs() < 0.005 * (high - low);
            if near { tick } else { edge }
        };
        Self {
            low: low.min(snap(low)),
            high: high.max(snap(high)),
            step,
        }
    }

    /// Where a value lies: 0 at the low end, 1 at the high end.
    pub fn share(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// Multiples of 1, 2 or 5 times a power of ten with their texts, all of as many decimals.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let first = (self.low / self.step - 1e-6).ceil();
        let count = (self.high / self.step - first + 1e-6).floor() as usize;
        let tick = |index| (first + index as f64) * self.step;
        (0..=count)
            .map(|index| (tick(index), self.text(tick(index))))
            .collect()
    }

    fn text(&self, tick: f64) -> String {
        let power = |value: f64| (value * (1.0 + 1e-9)).log10().floor();
        let size = power(self.low.abs().max(self.high.abs()));
        let step = power(self.step);
        let text = if size < 6.0 && step >= -4.0 {
            format!("{tick:.*}", (-step).max(0.0) as usize)
        } else if tick == 0.0 {
            "0".to_owned()
        } else {
            format!("{tick:.*e}", (size - step).max(0.0) as usize)
        };
        text.replace('-', "\u{2212}")
    }
}

/// Round values of an axis with their texts.
pub fn ticks(ends: [f64; 2]) -> Vec<(f64, String)> {
    Scale::new(ends.into_iter(), 0.0, 10.0).ticks()
}

/// The least of 1, 2, 5 times a power of ten that is not below `least`.
fn round_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.log10().floor());
    let enough = |factor: &f64| factor * power >= least * (1.0 - 1e-9);
    [1.0, 2.0, 5.0].into_iter().find(enough).unwrap_or(10.0) * power
}

/// The lines of a signal over time, with at most two points in each column of pixels: the lowest
/// and the highest, so that no peak is lost.
pub(super) fn over_time(series: &Series, place: impl Fn(f64, f64) -> Place) -> Vec<Vec<Place>> {
    let thinned = |run: Vec<Place>| {
        let columns = run.chunk_by(|a, b| a.0 / PX == b.0 / PX);
        without_level_middles(&columns.flat_map(extremes).collect::<Vec<_>>())
    };
    let wide = |before: Place, after: Place| after.0 - before.0 >= PX;
    runs(series, place, wide).into_iter().map(thinned).collect()
}

/// The lines of a curve, with one of successive points that share a pixel.
pub(super) fn over_quantity(series: &Series, place: impl Fn(f64, f64) -> Place) -> Vec<Vec<Place>> {
    let mut lines = runs(series, place, |_, _| true);
    for line in &mut lines {
        line.dedup_by_key(|&mut (x, y)| (x / PX, y / PX));
    }
    lines
}

/// Runs of samples between gaps that are `wide`, with the corners of steps.
fn runs(
    series: &Series,
    place: impl Fn(f64, f64) -> Place,
    wide: impl Fn(Place, Place) -> bool,
) -> Vec<Vec<Place>> {
    let mut runs: Vec<Vec<Place>> = Vec::new();
    let (mut before, mut gap) = ((0, 0), false);
    for (&horizontal, &value) in series.horizontal.iter().zip(series.values.iter()) {
        let here = place(horizontal, value);
        match runs.last_mut() {
            Some(run) if !(gap && (value.is_nan() || wide(before, here))) => {
                if series.stepwise {
                    run.push((here.0, before.1));
                }
                if !value.is_nan() {
                    run.push(here);
                }
            }
            _ if value.is_nan() => {}
            _ => runs.push(vec![here]),
        }
        gap = value.is_nan();
        if !gap {
            before = here;
        }
    }
    runs
}

/// The lowest and the highest of some places, in the order in which they came.
fn extremes(places: &[Place]) -> Vec<Place> {
    let height = |&index: &usize| places[index].1;
    let low = (0..places.len()).max_by_key(height);
    let high = (0..places.len()).min_by_key(height);
    let mut ends: Vec<usize> = low.into_iter().chain(high).collect();
    ends.sort_unstable();
    ends.dedup();
    ends.into_iter().map(|index| places[index]).collect()
}

/// A level stretch needs its ends only.
fn without_level_middles(places: &[Place]) -> Vec<Place> {
    let level = |index: usize, other: Option<usize>| {
        let other = other.and_then(|other| places.get(other));
        other.is_some_and(|other| other.1 == places[index].1)
    };
    (0..places.len())
        .filter(|&index| !(level(index, index.checked_sub(1)) && level(index, Some(index + 1))))
        .map(|index| places[index])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Role, Stroke};

    #[test]
    fn ticks_are_round_and_lie_inside() {
        for (values, widened, texts) in [
            ([0.0, 15.999], 0.0, "0 2 4 6 8 10 12 14 16"),
            ([0.0, 3.0], 0.06, "0.0 0.5 1.0 1.5 2.0 2.5 3.0"),
            ([-0.021, 0.013], 0.06, "\u{2212}0.02 \u{2212}0.01 0.00 0.01"),
            (
                [320.0, 320.0],
                0.06,
                "319.85 319.90 319.95 320.00 320.05 320.10 320.15",
            ),
            ([0.0, 0.0], 0.06, "\u{2212}0.4 \u{2212}0.2 0.0 0.2 0.4"),
            ([0.0, 3e7], 0.06, "0 5.0e6 1.0e7 1.5e7 2.0e7 2.5e7 3.0e7"),
            (
                [0.0, 2e-6],
                0.06,
                "0 5.0e\u{2212}7 1.0e\u{2212}6 1.5e\u{2212}6 2.0e\u{2212}6",
            ),
        ] {
            let most = if widened == 0.0 { 10.0 } else { 7.0 };
            let scale = Scale::new(values.into_iter(), widened, most);
            let ticks = scale.ticks();
            let found: Vec<&str> = ticks.iter().map(|tick| tick.1.as_str()).collect();
            assert_eq!(found.join(" "), texts);
            for (tick, text) in &ticks {
                assert!((-1e-9..=1.0 + 1e-9).contains(&scale.share(*tick)), "{text}");
            }
        }
    }

    fn place(time: f64, value: f64) -> Place {
        (time.round() as i32, -value.round() as i32)
    }

    fn series(time: &[f64], values: &[f64]) -> Series<'static> {
        Series::new(
            "",
            time.to_vec(),
            values.to_vec(),
            Role::Force,
            Stroke::Plain,
        )
    }

    #[test]
    fn a_column_keeps_its_lowest_and_highest_in_order() {
        let time: Vec<f64> = (0..1000).map(f64::from).collect();
        let values: Vec<f64> = (0..1000).map(|i| f64::from((i * 37) % 101)).collect();
        let lines = over_time(&series(&time, &values), place);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].is_sorted_by_key(|place| place.0));
        for (column, samples) in values.chunks(10).enumerate() {
            let here = lines[0]
                .iter()
                .filter(|place| place.0 / PX == column as i32);
            let heights: Vec<f64> = here.map(|place| f64::from(-place.1)).collect();
            let low = samples.iter().copied().fold(f64::INFINITY, f64::min);
            let high = samples.iter().copied().fold(0.0, f64::max);
            assert!(heights == [low, high] || heights == [high, low]);
        }
    }

    #[test]
    fn a_held_value_turns_square_corners_and_ends_at_a_gap() {
        let time = [0.0, 100.0, 200.0, 300.0, 400.0];
        let held = series(&time, &[1.0, 1.0, 5.0, f64::NAN, 2.0]).stepwise();
        let expected = vec![
            vec![(0, -1), (200, -1), (200, -5), (300, -5)],
            vec![(400, -2)],
        ];
        assert_eq!(over_time(&held, place), expected);
    }
}

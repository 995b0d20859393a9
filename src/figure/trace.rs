//! From samples to what a picture can show: axes with round ticks, lines with few points.

use super::Series;

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
        let text = if size >= 6.0 || step < -4.0 {
            format!("{tick:.*e}", (size - step).max(0.0) as usize)
        } else {
            format!("{tick:.*}", (-step).max(0.0) as usize)
        };
        text.replace('-', "\u{2212}")
    }
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

//! Stroke and accelerometer tell of one motion: the stroke's second derivative against the acceleration, over short stretches.

use super::line::Line;
use super::resample::read_at;
use crate::diagnosis::recordings::input::{DiagnosisInput, NamedRecording};
use crate::plant::Channel;

/// Length of a stretch over which an acceleration is integrated twice [s].
const STRETCH: f64 = 0.1;
/// Readings of it at least.
const LEAST: usize = 16;
/// Root mean square of the motion in a stretch, lines apart, from which it tells [standard deviations of the stroke's noise].
const MOVED: f64 = 12.0;
/// What it may leave, in the same.
const LEFT: f64 = 3.0;
/// Change of the acceleration from sample to sample that is an impact, which its samples do not hold [m/s2].
const IMPACT: f64 = 15.0;
/// Stretches that are needed.
pub(super) const LEAST_STRETCHES: usize = 8;

/// Measured acceleration over the second derivative of the stroke by the stamps [1], and its standard error; none where the recordings do not tell.
pub(super) fn curvature_ratio(case: &DiagnosisInput) -> Option<(f64, f64)> {
    let noise = case.noise[Channel::Stroke as usize];
    let mut ratios: Vec<(f64, f64)> = Vec::new();
    for recording in &case.recordings {
        ratios.extend(curvatures(recording, noise, |t| t));
    }
    pooled(&ratios)
}

/// Ratio of stretches, by their weights.
fn pooled(ratios: &[(f64, f64)]) -> Option<(f64, f64)> {
    if ratios.len() < LEAST_STRETCHES {
        return None;
    }
    let mut sorted = ratios.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half: f64 = sorted.iter().map(|(_, w)| w).sum::<f64>() / 2.0;
    let mut sum = 0.0;
    let median = sorted.iter().find(|(_, w)| {
        sum += w;
        sum >= half
    })?;
    let whole = 2.0 * half;
    let scatter = |(g, w): &(f64, f64)| w * (g - median.0).abs();
    let deviation = 1.2533 * sorted.iter().map(scatter).sum::<f64>() / whole;
    let squares: f64 = sorted.iter().map(|(_, w)| w * w).sum();
    let error = 1.2533 * deviation * squares.sqrt() / whole;
    Some((1.0 / median.0, error / median.0.powi(2)))
}

/// Second derivative of the stroke over acceleration in each stretch that tells, with its weight; the acceleration is read at other stamps.
pub(super) fn curvatures(
    recording: &NamedRecording,
    noise: f64,
    at: impl Fn(f64) -> f64,
) -> Vec<(f64, f64)> {
    let time = &recording.recorded.inputs.time;
    let readings = &recording.recorded.readings;
    let stroke = &readings[Channel::Stroke as usize];
    let acceleration = read_at(time, &readings[Channel::Acceleration as usize], at);
    let step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let width = ((STRETCH / step) as usize).max(LEAST);
    let mut ratios = Vec::new();
    let mut from = 0;
    while from + width <= time.len() {
        let span = from..from + width;
        if let Some(found) = curvature(
            &time[span.clone()],
            &stroke[span.clone()],
            &acceleration[span],
            noise,
        ) {
            ratios.push(found);
        }
        from += width / 2;
    }
    ratios
}

/// Slope of a stroke on its acceleration twice integrated, lines apart, and its weight.
fn curvature(time: &[f64], stroke: &[f64], acceleration: &[f64], noise: f64) -> Option<(f64, f64)> {
    let whole = stroke.iter().filter(|v| v.is_finite()).count();
    let smooth = acceleration
        .windows(2)
        .all(|pair| (pair[1] - pair[0]).abs() < IMPACT);
    if 2 * whole < time.len() || whole < 6 || !smooth {
        return None;
    }
    let mut way = vec![0.0];
    let (mut position, mut speed) = (0.0, 0.0);
    for i in 1..time.len() {
        let h = time[i] - time[i - 1];
        position += h * (speed + h * (2.0 * acceleration[i - 1] + acceleration[i]) / 6.0);
        speed += 0.5 * h * (acceleration[i - 1] + acceleration[i]);
        way.push(position);
    }
    let known: Vec<usize> = (0..time.len()).filter(|i| stroke[*i].is_finite()).collect();
    let of = |values: &[f64]| -> Vec<f64> { known.iter().map(|i| values[*i]).collect() };
    let time = of(time);
    let (way, stroke) = (
        without_line(&time, &of(&way))?,
        without_line(&time, &of(stroke))?,
    );
    let own: f64 = way.iter().map(|w| w * w).sum();
    let both: f64 = way.iter().zip(&stroke).map(|(w, x)| w * x).sum();
    let slope = both / own;
    let count = known.len() as f64;
    let moved = (own / count).sqrt();
    let left = way
        .iter()
        .zip(&stroke)
        .map(|(w, x)| (x - slope * w).powi(2));
    let left = (left.sum::<f64>() / count).sqrt();
    // In another unit the noise is too: what is left is held against the motion as well.
    let size = (stroke.iter().map(|x| x * x).sum::<f64>() / count).sqrt();
    let tells = size > MOVED * noise && left < (LEFT * noise).max(0.02 * size) && moved > 0.0;
    tells.then_some((slope, own * slope * slope))
}

/// Values less the line through them.
fn without_line(time: &[f64], values: &[f64]) -> Option<Vec<f64>> {
    let points = || time.iter().copied().zip(values.iter().copied());
    let line = Line::through(points())?;
    Some(points().map(|(t, v)| v - line.at(t)).collect())
}

//! State in which a recording starts: at rest, or anywhere.
//!
//! A recording that begins in mid-stroke or under pressure does not say what is in the chambers. For a while its piston is held to its measured motion
//! while the outlet, the chambers and the seals come to the state that motion brings them to; nothing is compared with the readings of that time.

use std::sync::Arc;

use super::measured_motion::MeasuredMotion;
use crate::stats::median;

/// Time for which the piston is held [s]: several times as long as a chamber takes to fill.
const HELD: f64 = 0.5;
/// Samples at the beginning that say where a recording starts: one of them may be an outlier.
const FEW: usize = 5;
/// Stroke up to which the piston counts as retracted [m].
const RETRACTED: f64 = 1e-3;
/// Pressure at the regulator's outlet up to which that counts as the atmosphere [Pa gauge].
const ATMOSPHERE: f64 = 1e4;

/// State in which a recording starts.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum InitialState {
    /// At rest on the retracted stop, all at the atmosphere.
    #[default]
    AtRest,
    /// In any state.
    Anywhere(Arc<HeldMotion>),
}

/// A start with the piston held to its measured motion.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldMotion {
    /// The motion while it is held; none where the stroke was not measured.
    pub motion: Option<MeasuredMotion>,
    /// Pressure at the regulator's outlet as it starts [Pa gauge].
    pub outlet: f64,
    /// Samples for which the piston is held.
    pub samples: usize,
}

impl InitialState {
    /// From readings of the regulator's pressure [Pa gauge] and of the stroke [m] at times [s]; NaN where there is none.
    #[must_use]
    pub fn of(time: &[f64], pressure: &[f64], stroke: &[f64]) -> Self {
        let [outlet, retracted] = [pressure, stroke].map(|readings| level(time, readings));
        let at_rest = |level: Option<f64>, limit: f64| level.is_none_or(|level| level <= limit);
        if at_rest(outlet, ATMOSPHERE) && at_rest(retracted, RETRACTED) {
            return Self::AtRest;
        }
        let samples = time.partition_point(|t| *t < time[0] + HELD);
        // A little more than is used: a smoother knows least at its ends.
        let read = time.partition_point(|t| *t < time[0] + 1.5 * HELD);
        let motion = retracted.map(|_| {
            let mut motion = MeasuredMotion::of(&time[..read], &stroke[..read]);
            motion.bridged(&time[..read]);
            motion
        });
        Self::Anywhere(Arc::new(HeldMotion {
            motion,
            outlet: outlet.unwrap_or(0.0).max(0.0),
            samples,
        }))
    }

    /// Samples at the beginning that nothing is compared with.
    #[must_use]
    pub fn samples(&self) -> usize {
        match self {
            Self::AtRest => 0,
            Self::Anywhere(held) => held.samples,
        }
    }

    /// Motion that the piston is held to at a sample.
    pub(super) fn held_at(&self, index: usize) -> Option<&MeasuredMotion> {
        match self {
            Self::Anywhere(held) if index < held.samples => held.motion.as_ref(),
            _ => None,
        }
    }
}

/// Level from which the first readings go on: the line of Theil and Sen through them, carried back to the start. Of what is left beside the line the
/// second lowest is taken: a recording that starts at rest and leaves it on a curve within a few samples has started at rest. None where there are no
/// readings.
fn level(time: &[f64], readings: &[f64]) -> Option<f64> {
    let few: Vec<(f64, f64)> = (time.iter().zip(readings).take(4 * FEW))
        .filter(|(_, reading)| reading.is_finite())
        .take(FEW)
        .map(|(time, reading)| (*time, *reading))
        .collect();
    let pairs = (few.iter().enumerate()).flat_map(|(i, a)| few[..i].iter().map(move |b| (a, b)));
    let slope = median(pairs.map(|(a, b)| (a.1 - b.1) / (a.0 - b.0))).unwrap_or(0.0);
    let mut starts: Vec<f64> = (few.iter())
        .map(|(at, reading)| reading - slope * (at - time[0]))
        .collect();
    starts.sort_by(f64::total_cmp);
    starts.get(1).or(starts.first()).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_recording_is_held_where_it_starts_in_motion_or_under_pressure_and_nowhere_else() {
        let time: Vec<f64> = (0..1000).map(|i| 3.0 + 2e-3 * f64::from(i)).collect();
        let stroke: Vec<f64> = time.iter().map(|t| 0.02 + 0.01 * (t - 3.0)).collect();
        let none = vec![f64::NAN; 1000];
        let low = vec![300.0; 1000];
        let retracted = vec![4e-5; 1000];
        assert_eq!(
            InitialState::of(&time, &low, &retracted),
            InitialState::AtRest
        );
        assert_eq!(InitialState::of(&time, &none, &none), InitialState::AtRest);
        let moving = InitialState::of(&time, &low, &stroke);
        assert_eq!(moving.samples(), 250);
        let motion = moving.held_at(100).unwrap();
        let [at, speed] = [motion.stroke[100], motion.speed[100]];
        assert!(
            (at - 0.022).abs() < 1e-9 && (speed - 0.01).abs() < 1e-6,
            "{at} {speed}"
        );
        assert_eq!(moving.held_at(250), None);
        let InitialState::Anywhere(held) = InitialState::of(&time, &vec![2e5; 1000], &none) else {
            panic!("it starts at 2 bar");
        };
        assert_eq!((held.motion.as_ref(), held.outlet), (None, 2e5));
    }

    /// A regulator that answers at once, recorded at 50 Hz, is far from rest by its second sample.
    #[test]
    fn a_slow_recording_of_a_device_that_leaves_its_rest_starts_at_rest() {
        let time: Vec<f64> = (0..100).map(|i| 2e-2 * f64::from(i)).collect();
        let pressure: Vec<f64> = time
            .iter()
            .map(|t| 2e5 * (1.0 - (-t / 0.1).exp()))
            .collect();
        let stroke: Vec<f64> = time.iter().map(|t| 0.05 * (t - 0.06).max(0.0)).collect();
        assert_eq!(
            InitialState::of(&time, &pressure, &stroke),
            InitialState::AtRest
        );
    }

    #[test]
    fn an_outlier_at_the_start_is_no_start_in_mid_stroke() {
        let time: Vec<f64> = (0..1000).map(|i| 2e-3 * f64::from(i)).collect();
        let mut stroke = vec![0.0; 1000];
        stroke[0] = 0.03;
        let pressure = vec![0.0; 1000];
        assert_eq!(
            InitialState::of(&time, &pressure, &stroke),
            InitialState::AtRest
        );
    }
}

//! A prediction with its 90 % band, and where it leaves known ground.
//!
//! ```text
//! half width = w sqrt(n^2 + sum of d_k^2 + e^2),   d_k half the change of the prediction as the numbers move by one standard deviation to either side along a
//! direction of their covariance, e = prediction less that without what was found, on unknown ground, 0 elsewhere
//! ```
//!
//! n the sensor's noise, w the half width of a 90 % band in standard deviations. Where a run leaves what the recordings covered, nobody has seen that what was
//! found still holds.

use nalgebra::DMatrix;

use super::ground::unknown;
use crate::diagnosis::answer::details::UnknownGround;
use crate::plant::{CHANNELS, PlantInputs, PlantParameters, simulate};
use crate::scenario::rig_file::{Known, RigFile};
use crate::stats::NORMAL_90;

/// Half width of a number's tolerance over the standard deviation of what may lie anywhere in it [1].
const EVEN: f64 = 1.732;
/// Factor by which a band is wider on unknown ground, whatever was found [1].
const UNKNOWN: f64 = 2.0;

/// One value per sample, by channel.
type Readings = [Vec<f64>; CHANNELS.len()];

/// A prediction.
pub struct Predicted {
    /// Readings, in the order of [`CHANNELS`].
    pub readings: Readings,
    /// Lower end of the band.
    pub low: Readings,
    /// Its upper end.
    pub high: Readings,
    /// Whether each sample is on unknown ground.
    pub is_unknown: Vec<bool>,
    /// Where and why.
    pub unknown: Vec<UnknownGround>,
}

/// What is known of a rig that no diagnosis has improved: its tolerances and its sheet.
#[must_use]
pub fn as_the_sheet_says(rig: &RigFile) -> Known {
    let numbers: Vec<_> = (rig.tolerances.iter())
        .map(|t| {
            (
                t.key.to_owned(),
                t.quantity,
                (t.tolerance * t.value).abs() / EVEN,
            )
        })
        .collect();
    Known {
        correlations: vec![0.0; numbers.len() * numbers.len().saturating_sub(1) / 2],
        numbers,
        noise: rig.noise,
        half_widths: [NORMAL_90; CHANNELS.len()],
        ..Known::default()
    }
}

/// The prediction of a rig file of a recording's inputs.
#[must_use]
pub fn predicted_by(rig: &RigFile, inputs: &PlantInputs) -> Predicted {
    let sheet;
    let known = match &rig.known {
        Some(known) => known,
        None => {
            sheet = as_the_sheet_says(rig);
            &sheet
        }
    };
    predicted((&rig.plant, &rig.bare), known, inputs)
}

/// The prediction of a model, with the same without what was found.
#[must_use]
pub fn predicted(
    (plant, bare): (&PlantParameters, &PlantParameters),
    known: &Known,
    inputs: &PlantInputs,
) -> Predicted {
    let readings = simulate(plant, inputs).readings;
    let (is_unknown, unknown) = unknown(&known.covered, plant, inputs);
    let mut variance: Readings =
        std::array::from_fn(|channel| vec![known.noise[channel].powi(2); inputs.time.len()]);
    let mut add =
        |one: &Readings, other: &Readings, factor: f64, counts: &dyn Fn(usize) -> bool| {
            for ((sums, one), other) in variance.iter_mut().zip(one).zip(other) {
                for (i, sum) in sums.iter_mut().enumerate().filter(|(i, _)| counts(*i)) {
                    let change = factor * (one[i] - other[i]);
                    // Where a model is no longer finite, so is the band.
                    *sum += if change.is_nan() {
                        f64::INFINITY
                    } else {
                        change * change
                    };
                }
            }
        };
    for direction in directions(known) {
        let moved = |sign: f64| {
            let mut moved = plant.clone();
            for ((_, quantity, _), by) in known.numbers.iter().zip(&direction) {
                let value = quantity.get(&moved) + sign * by;
                quantity.set(&mut moved, value);
            }
            simulate(&moved, inputs).readings
        };
        let [less, more] = [-1.0, 1.0].map(moved);
        add(&more, &less, 0.5, &|_| true);
    }
    if is_unknown.contains(&true) {
        let without = simulate(bare, inputs).readings;
        add(&readings, &without, 1.0, &|i| is_unknown[i]);
    }
    let end = |sign: f64| -> Readings {
        std::array::from_fn(|channel| {
            let width = |i: usize| {
                let wider = if is_unknown[i] { UNKNOWN } else { 1.0 };
                sign * wider * known.half_widths[channel] * variance[channel][i].sqrt()
            };
            let values = readings[channel].iter().enumerate();
            // A band without an end has none that a file could show.
            let end = |value: f64| if value.is_finite() { value } else { f64::NAN };
            values.map(|(i, value)| end(value + width(i))).collect()
        })
    };
    Predicted {
        low: end(-1.0),
        high: end(1.0),
        readings,
        is_unknown,
        unknown,
    }
}

/// Moves of the numbers by one standard deviation along directions that are independent: the columns of a root of their covariance.
fn directions(known: &Known) -> Vec<Vec<f64>> {
    let count = known.numbers.len();
    let correlation = DMatrix::from_fn(count, count, |i, j| match i.cmp(&j) {
        std::cmp::Ordering::Equal => 1.0,
        std::cmp::Ordering::Greater => known.correlations[i * (i - 1) / 2 + j],
        std::cmp::Ordering::Less => known.correlations[j * (j - 1) / 2 + i],
    });
    let parts = correlation.symmetric_eigen();
    let deviation = |i: usize| known.numbers[i].2;
    (0..count)
        .filter(|k| parts.eigenvalues[*k] > 0.0)
        .map(|k| {
            let root = parts.eigenvalues[k].sqrt();
            (0..count)
                .map(|i| deviation(i) * root * parts.eigenvectors[(i, k)])
                .collect()
        })
        .collect()
}

impl Predicted {
    /// Puts the ends of the band in order, where a sensor reads with the other sign.
    pub(super) fn order(&mut self) {
        for (low, high) in self.low.iter_mut().zip(&mut self.high) {
            for (low, high) in low.iter_mut().zip(high).filter(|(low, high)| low > high) {
                std::mem::swap(low, high);
            }
        }
    }

    /// The columns of its file, by name: those shown of the readings, then their bands, then whether a sample is on known ground.
    #[must_use]
    pub fn columns<'a>(&'a self, shown: &[(&'static str, &'a [f64])]) -> Vec<(String, Vec<f64>)> {
        let mut all: Vec<(String, Vec<f64>)> = (shown.iter())
            .map(|(name, values)| ((*name).to_owned(), values.to_vec()))
            .collect();
        for (place, name) in crate::diagnosis::recordings::recorded::COLUMNS
            .into_iter()
            .enumerate()
        {
            if shown.iter().any(|(own, _)| *own == name) {
                for (end, values) in [("low", &self.low[place]), ("high", &self.high[place])] {
                    all.push((format!("{name}_{end}"), values.clone()));
                }
            }
        }
        let known = self
            .is_unknown
            .iter()
            .map(|unknown| f64::from(u8::from(!unknown)));
        all.push(("known_ground".to_owned(), known.collect()));
        all
    }
}

#[cfg(test)]
mod tests {
    use super::super::ground::tests::{regulator, steps};
    use super::*;
    use std::collections::BTreeMap;

    /// In the steady state the outlet is the gain times the set pressure.
    #[test]
    fn a_band_is_that_of_noise_and_numbers() {
        let predicted = predicted_by(&regulator(), &steps(&[0.0, 2e5]));
        let half = |i: usize| 0.5 * (predicted.high[0][i] - predicted.low[0][i]);
        let expected = NORMAL_90 * 400f64.hypot(2e5 * 0.1 / EVEN);
        assert!(
            (half(199) / expected - 1.0).abs() < 1e-3,
            "{} {expected}",
            half(199)
        );
        assert!(
            (half(0) / (NORMAL_90 * 400.0) - 1.0).abs() < 1e-3,
            "{}",
            half(0)
        );
        assert!(predicted.unknown.is_empty());
    }

    /// Two numbers that move the outlet alike and are known to be opposite leave it alone.
    #[test]
    fn correlations_count() {
        let rig = regulator();
        let gain = rig.tolerances[0].quantity;
        let with = |correlation: f64| Known {
            numbers: vec![("a".to_owned(), gain, 0.05), ("b".to_owned(), gain, 0.05)],
            correlations: vec![correlation],
            ..as_the_sheet_says(&rig)
        };
        let half = |known: &Known| {
            let found = predicted((&rig.plant, &rig.bare), known, &steps(&[2e5, 2e5]));
            0.5 * (found.high[0][199] - found.low[0][199]) / NORMAL_90
        };
        assert!(half(&with(1.0)) > half(&with(0.0)));
        assert!(half(&with(0.0)) > half(&with(-0.99)));
    }

    #[test]
    fn on_unknown_ground_the_model_without_what_was_found_lies_in_the_band() {
        let rig = regulator();
        let mut bare = rig.plant.clone();
        rig.tolerances[0].quantity.set(&mut bare, 0.8);
        let known = Known {
            covered: BTreeMap::from([("outlet_pa".to_owned(), vec![0.0, 1e5])]),
            ..as_the_sheet_says(&rig)
        };
        let found = predicted((&rig.plant, &bare), &known, &steps(&[1e5, 3e5]));
        assert!(!found.is_unknown[90] && found.is_unknown[199]);
        assert!(found.low[0][199] < 0.8 * 3e5, "{}", found.low[0][199]);
        let names: Vec<String> = found
            .columns(&[("regulator_pressure_pa", &found.readings[0])])
            .into_iter()
            .map(|(name, _)| name)
            .collect();
        assert_eq!(
            names,
            [
                "regulator_pressure_pa",
                "regulator_pressure_pa_low",
                "regulator_pressure_pa_high",
                "known_ground"
            ]
        );
    }
}

//! The experiment that best tells two explanations apart.
//!
//! ```text
//! D^2 = min over du of |d - J du|^2 + du' N du = |d|^2 - d' J (J' J + N)^-1 J' d
//! ```
//!
//! d difference of their predictions in standard deviations of the sensors, J derivatives by what the better one leaves free, N what the recordings at hand
//! know of that already. D^2 is by how much the chi-square of the wrong one would stand above that of the right one after a new fit.

use super::{Experiment, experiments};
use crate::diagnosis::fit::Fit;
use crate::diagnosis::recordings::evidence::Evidence;
use crate::plant::{OperatingLimits, PlantInputs, PlantParameters, simulate};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Step of the difference quotients in the fit's coordinate, as in the fit [1].
const STEP: f64 = 0.03;
/// Largest difference of a sample that counts, in standard deviations: impacts met at other times tell too easily [1].
const MOST: f64 = 10.0;

/// Power of an experiment to tell two explanations apart.
#[derive(Debug, Clone)]
pub struct Separation {
    /// The experiment.
    pub experiment: Experiment,
    /// D^2 [1].
    pub square: f64,
    /// Duration [s].
    pub duration: f64,
}

/// The experiments that keep what is stated of the rig's limits with either of the two, best first: by D^2 a second.
#[must_use]
pub fn separations(
    evidence: &Evidence,
    limits: &OperatingLimits,
    [best, rival]: [&Fit; 2],
) -> Vec<Separation> {
    let plant = &best.prediction.plant;
    let all = experiments(evidence, plant, limits);
    let are_stated = *limits != OperatingLimits::default();
    let is_allowed = |own: &Experiment| {
        if !are_stated {
            return true;
        }
        let plants = [plant, &rival.prediction.plant];
        let mut truths = plants
            .map(|plant| simulate(plant, &own.inputs).truth)
            .into_iter();
        truths.all(|truth| limits.allow(&own.inputs, &truth))
    };
    let mut found: Vec<Separation> = all
        .into_par_iter()
        .filter(is_allowed)
        .map(|experiment| {
            let square = square(evidence, best, &rival.prediction.plant, &experiment.inputs);
            let time = &experiment.inputs.time;
            Separation {
                square,
                duration: time[time.len() - 1] - time[0],
                experiment,
            }
        })
        .collect();
    let worth = |s: &Separation| s.square / s.duration;
    found.sort_by(|a, b| worth(b).total_cmp(&worth(a)));
    found
}

fn square(evidence: &Evidence, best: &Fit, rival: &PlantParameters, inputs: &PlantInputs) -> f64 {
    let whitened = |plant: &PlantParameters| -> Vec<f64> {
        let readings = simulate(plant, inputs).readings;
        let channels = readings.iter().zip(evidence.noise);
        channels
            .flat_map(|(values, noise)| values.iter().map(move |value| value / noise))
            .collect()
    };
    let plant = &best.prediction.plant;
    let here = whitened(plant);
    let finite = |value: f64| if value.is_finite() { value } else { 0.0 };
    let difference: Vec<f64> = whitened(rival)
        .iter()
        .zip(&here)
        .map(|(rival, best)| finite(rival - best).clamp(-MOST, MOST))
        .collect();
    let columns: Vec<Vec<f64>> = best
        .free
        .iter()
        .zip(&best.values)
        .map(|(free, value)| {
            let at = free.coordinate.of(*value);
            let ahead = free.coordinate.value(at + STEP);
            let step = if ahead > free.bounds[1] { -STEP } else { STEP };
            let mut moved = plant.clone();
            free.quantity
                .set(&mut moved, free.coordinate.value(at + step));
            let there = whitened(&moved);
            let pairs = there.iter().zip(&here);
            pairs
                .map(|(there, here)| finite((there - here) / step))
                .collect()
        })
        .collect();
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let whole = product(&difference, &difference);
    let count = columns.len();
    let mut normal = DMatrix::from_fn(count, count, |i, j| product(&columns[i], &columns[j]));
    if best.information.nrows() == count {
        normal += &best.information;
    }
    for i in 0..count {
        normal[(i, i)] += 1e-9 * normal[(i, i)] + 1e-9;
    }
    let slope = DVector::from_fn(count, |i, _| product(&columns[i], &difference));
    let explained = normal
        .cholesky()
        .map_or(0.0, |c| slope.dot(&c.solve(&slope)));
    (whole - explained).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::fit::free::{Free, Prior};
    use crate::diagnosis::fit::{Limit, ROUGH, fit};
    use crate::diagnosis::test_evidence::{evidence, plant};
    use crate::effects::Coordinate;
    use crate::plant::registry;

    fn fitted(evidence: &Evidence, plant: &PlantParameters, free: &[Free]) -> Fit {
        fit(evidence, (plant, None), (free, &[]), ROUGH, Limit::of(1))
    }

    fn best_for(rival: &PlantParameters) -> &'static str {
        let evidence = evidence(1);
        let best = fitted(&evidence, &plant(), &[]);
        let rival = fitted(&evidence, rival, &[]);
        separations(&evidence, &OperatingLimits::default(), [&best, &rival])[0]
            .experiment
            .name
    }

    #[test]
    fn each_difference_is_sought_where_it_shows() {
        let mut drifting = plant();
        drifting.sensors.force_drift = 0.2;
        assert_eq!(best_for(&drifting), "dwell");
        let mut late = plant();
        late.device.switching_delay = 0.005;
        assert_eq!(best_for(&late), "valve_reversals");
    }

    #[test]
    fn what_a_free_number_could_do_as_well_tells_nothing() {
        let free = Free {
            quantity: registry::FORCE_GAIN.named("gain"),
            start: 1.0,
            coordinate: Coordinate::Linear(0.01),
            bounds: [0.5, 2.0],
            prior: Prior::Flat,
        };
        let evidence = evidence(1);
        let mut gained = plant();
        gained.sensors.force_gain = 1.01;
        let rival = fitted(&evidence, &gained, &[]);
        let known = fitted(&evidence, &plant(), &[]);
        let mut open = fitted(&evidence, &plant(), &[free]);
        open.information.fill(0.0);
        let most = |best: &Fit| {
            separations(&evidence, &OperatingLimits::default(), [best, &rival])[0].square
        };
        assert!(most(&known) > 1000.0);
        assert!(most(&open) < 1e-3 * most(&known));
    }

    /// What the owner of a rig forbids is not advised, whatever it would tell.
    #[test]
    fn what_a_rig_may_not_do_is_not_asked_of_it() {
        let evidence = evidence(1);
        let best = fitted(&evidence, &plant(), &[]);
        let mut late = plant();
        late.device.switching_delay = 0.005;
        let rival = fitted(&evidence, &late, &[]);
        let names = |limits: &OperatingLimits| -> Vec<&'static str> {
            let found = separations(&evidence, limits, [&best, &rival]);
            found.iter().map(|own| own.experiment.name).collect()
        };
        assert_eq!(names(&OperatingLimits::default()).len(), 7);
        let stays = OperatingLimits {
            solenoid: Some(false),
            duration: Some(10.0),
            ..OperatingLimits::default()
        };
        let left = names(&stays);
        assert_eq!(left.len(), 4, "{left:?}");
        assert!(!left.contains(&"valve_reversals") && !left.contains(&"dwell"));
        let gentle = OperatingLimits {
            force: Some(0.1),
            without_workpiece: Some(false),
            ..OperatingLimits::default()
        };
        assert!(names(&gentle).is_empty());
    }
}

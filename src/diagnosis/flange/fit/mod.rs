//! A contact flange as a simulation: [`crate::flange`] fitted to runs, and other runs predicted with it.
//!
//! Inputs of a run are the arm's speed, the desired force and the force ramp; the contact force is predicted. What of it is met: `residuals`; how: `solve`.
//! Fits that are nearly as good as the best all count, so that what the runs do not tell apart shows as a range of what is predicted.

pub(in crate::diagnosis) mod account;
mod course;
mod prediction;
pub mod report;
mod residuals;
mod scatter;
mod sliding;
mod solve;

use crate::diagnosis::flange::{Run, RunMetrics};
use crate::flange::{CoveredRuns, FittedFlange, FlangeModel, Ripple};
use crate::stats::NORMAL_95;
use prediction::{Logged, predict_run};
use report::{FittedNumber, SimulatedFlange, SimulatedRun};
use residuals::Targets;
use scatter::{scatter, with_interval};
use solve::Solution;

/// Runs that are fitted to at most: the time grows with them.
const MOST: usize = 4;
/// Tolerances of the logarithms of a fitted run's peak, ringing and settling [1].
const ACCEPTED: [f64; 3] = [0.03, 0.02, 0.05];
/// Share of the best's cost by which another may be worse and still counts [1].
const ALIKE: f64 = 0.06;
/// Power of a setting by which a number may be wrong where the setting was not covered [1].
const BEYOND: f64 = 0.5;
/// Half a 95 % interval by the standard deviation [1].
const HALF: f64 = NORMAL_95;

/// A flange fitted to runs.
pub struct FlangeFit {
    /// What it says.
    pub report: SimulatedFlange,
    /// What predicts other runs.
    pub fitted: FittedFlange,
    /// Force that it gives of each run, from a sample on [N]; nothing where a run cannot be simulated.
    pub forces: Vec<Option<ForceFrom>>,
}

/// Fits a flange of a moving mass [kg] to runs and simulates these and others; none where there is no run to fit to.
#[must_use]
pub fn fit_flange(
    fitted: &[(Run, RunMetrics)],
    unseen: &[&(Run, RunMetrics)],
    mass: f64,
) -> Option<FlangeFit> {
    let targets: Vec<Targets> = (fitted.iter().take(MOST))
        .map(|(run, shown)| Targets::of(run, shown))
        .collect();
    let reader = targets.first()?.reader;
    let logged: Vec<Logged<'_>> = (fitted.iter().chain(unseen.iter().copied()))
        .map(|(run, shown)| Logged::new(run, shown, reader))
        .collect();
    let solutions = alike(solve::solutions(&targets, mass), &logged[..targets.len()]);
    let best = solutions.first()?;
    let models: Vec<FlangeModel> = solutions.iter().map(|s| s.model).collect();
    let ripple = sliding::ripple(&best.model, &logged[..targets.len()]);
    let scatter = scatter(best, (&targets, &logged[..targets.len()]), mass, ripple);
    let fitted = FittedFlange {
        models,
        reader,
        ripple,
        half_widths: scatter,
        covered: covered(fitted.iter().take(MOST)),
    };
    let (mut runs, mut forces) = (Vec::new(), Vec::new());
    for (index, run) in logged.iter().enumerate() {
        let (simulated, force) = predicted_by(&fitted, run, index < targets.len()).unzip();
        runs.extend(simulated);
        forces.push(force);
    }
    Some(FlangeFit {
        report: SimulatedFlange {
            numbers: numbers(&solutions, ripple),
            reading_rate_hz: 1.0 / reader.period,
            reading_gain: reader.gain,
            solutions: solutions.len(),
            runs,
        },
        fitted,
        forces,
    })
}

/// Force of a run, from a sample on [N].
type ForceFrom = (usize, Vec<f64>);

/// What a fitted flange gives of a run: its results, and its force; none of a run that cannot be simulated.
#[must_use]
pub fn predict_flange(
    flange: &FittedFlange,
    (run, shown): &(Run, RunMetrics),
) -> Option<(SimulatedRun, ForceFrom)> {
    predicted_by(flange, &Logged::new(run, shown, flange.reader), false)
}

fn predicted_by(
    flange: &FittedFlange,
    run: &Logged<'_>,
    fitted: bool,
) -> Option<(SimulatedRun, ForceFrom)> {
    let made = predict_run(&flange.models, flange.ripple, run)?;
    let beyond = match fitted {
        true => [0.0; 3],
        false => flange.covered.beyond(settings_of(run.run, run.shown)),
    };
    // Of what was not covered a number may go with a power of it that is wrong by a half.
    let half = (flange.half_widths)
        .map(|half| half.hypot(BEYOND * beyond.into_iter().fold(0.0, f64::max)));
    let simulated = SimulatedRun {
        recording: run.run.name.clone(),
        fitted,
        force_before_n: run.course.course.before,
        force_ramp_s: run.course.course.ramp,
        peak_n: with_interval(made.peak, half[0]),
        ringing_hz: made.ringing.map(|ringing| with_interval(ringing, half[1])),
        settling_s: with_interval(made.settling, half[2]),
        sliding_spread_n: made.spread.map(|spread| with_interval(spread, half[3])),
    };
    Some((simulated, (run.first, made.force)))
}

/// Speed of approach [m/s], force that the flange comes with and force after contact [N] of a run.
#[must_use]
pub fn settings_of(run: &Run, shown: &RunMetrics) -> [f64; 3] {
    let before = run.force_ramp.map_or(shown.desired, |ramp| ramp.before);
    [shown.approach, before, shown.desired]
}

/// What some runs cover.
fn covered<'a>(runs: impl Iterator<Item = &'a (Run, RunMetrics)>) -> CoveredRuns {
    let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for (run, shown) in runs {
        for ([low, high], value) in ends.iter_mut().zip(settings_of(run, shown)) {
            *low = low.min(value);
            *high = high.max(value);
        }
    }
    let [approach, before, desired] = ends;
    CoveredRuns {
        approach,
        before,
        desired,
    }
}

/// Those that count as well as the best, by their cost with that of the fitted runs' results.
fn alike(solutions: Vec<Solution>, fitted: &[Logged<'_>]) -> Vec<Solution> {
    let cost = |solution: &Solution| {
        let results = fitted.iter().map(|run| {
            let Some(made) = predict_run(&[solution.model], None, run) else {
                return f64::INFINITY;
            };
            let error =
                |result: &report::SimulatedResult| (result.simulated / result.recorded).ln();
            let ringing = match (run.shown.frequency, &made.ringing) {
                (None, _) => 0.0,
                (_, Some(ringing)) => error(ringing),
                // One that does not ring is as wrong as can be.
                (_, None) => f64::INFINITY,
            };
            let errors = [error(&made.peak), ringing, error(&made.settling)].into_iter();
            let residuals = errors
                .zip(ACCEPTED)
                .map(|(error, accepted)| error / accepted);
            residuals.map(solve::loss).sum()
        });
        solution.cost + results.sum::<f64>()
    };
    let mut ranked: Vec<(f64, Solution)> = (solutions.into_iter())
        .map(|solution| (cost(&solution), solution))
        .collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
    let most = ranked.first().map_or(0.0, |(cost, _)| cost * (1.0 + ALIKE));
    let counts = ranked.into_iter().filter(|(cost, _)| *cost <= most);
    counts.map(|(_, solution)| solution).collect()
}

/// Numbers of the best of some fits.
fn numbers(solutions: &[Solution], ripple: Option<Ripple>) -> Vec<FittedNumber> {
    let all: Vec<_> = solutions.iter().map(|s| s.model.numbers()).collect();
    let fitted = FlangeModel::NAMES.iter().enumerate().map(|(i, name)| {
        let values = all.iter().map(|numbers| numbers[i]);
        let factor = (HALF * solutions[0].deviations[i]).exp();
        let least = values.clone().fold(f64::INFINITY, f64::min);
        let largest = values.fold(0.0, f64::max);
        FittedNumber {
            name: (*name).to_owned(),
            value: all[0][i],
            interval: Some([least / factor, largest * factor]),
        }
    });
    let of_ripple = ripple.into_iter().flat_map(|ripple| {
        [
            ("arm_ripple", ripple.ratio),
            ("arm_ripple_bandwidth_hz", ripple.bandwidth),
        ]
    });
    let met = of_ripple.map(|(name, value)| FittedNumber {
        name: name.to_owned(),
        value,
        interval: None,
    });
    fitted.chain(met).collect()
}

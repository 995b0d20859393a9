//! A run as the simulation logs it, and its results by the same measure as the recorded ones.

use super::course::RunCourse;
use super::report::SimulatedResult;
use crate::diagnosis::flange::{MIDDLE, Run, RunMetrics, deviation};
use crate::flange::{FlangeCourse, FlangeModel, Reader, Ripple, SAMPLED, flange_force};
use crate::stats::{mean, median};

/// Time before contact from which a run is simulated [s].
const LEAD: f64 = 0.3;
/// Time over which a sliding force is averaged [s].
const SLOW: f64 = 0.05;
/// Instants of reading that are looked at, by the period [1]: which of them a run will have nobody knows.
pub(super) const PHASES: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// A run with its inputs.
pub(super) struct Logged<'a> {
    pub run: &'a Run,
    pub shown: &'a RunMetrics,
    pub course: RunCourse,
    reader: Reader,
    /// First of the run's samples that are simulated.
    pub first: usize,
    /// Times that are simulated [s].
    pub time: &'a [f64],
}

impl<'a> Logged<'a> {
    pub fn new(run: &'a Run, shown: &'a RunMetrics, reader: Reader) -> Self {
        let course = RunCourse::of(run, shown, LEAD);
        let first = run.time.partition_point(|t| *t < course.course.start);
        let last = run.time.partition_point(|t| *t <= course.end);
        Self {
            run,
            shown,
            course,
            reader,
            first,
            time: &run.time[first..last],
        }
    }

    /// When the arm slides off and when it stands again, with enough between to tell [s].
    pub fn sliding(&self) -> Option<[f64; 2]> {
        self.shown.spread.and(self.course.slides)
    }

    pub fn recorded_spreads(&self, slides: [f64; 2]) -> [f64; 2] {
        let force = &self.run.force[self.first..self.first + self.time.len()];
        spreads(self.time, force, slides)
    }

    /// The run with another force.
    fn with_force(&self, force: Vec<f64>) -> Run {
        let part = self.first..self.first + force.len();
        Run {
            name: self.run.name.clone(),
            time: self.run.time[part.clone()].to_vec(),
            desired: self.run.desired[part.clone()].to_vec(),
            speed: self.run.speed[part.clone()].to_vec(),
            commanded: self.run.commanded[part].to_vec(),
            force_ramp: self.run.force_ramp,
            force,
        }
    }
}

/// Spread of the force, and of its averages [N], while the arm slides [s].
pub(super) fn spreads(time: &[f64], force: &[f64], slides: [f64; 2]) -> [f64; 2] {
    let end = time[time.len() - 1];
    let [from, to] = MIDDLE.map(|share| slides[0] + share * (slides[1] - slides[0]));
    let at = |t: f64| time.partition_point(|own| *own < t);
    let middle = &force[at(from)..at(to)];
    if middle.len() < 2 {
        return [0.0; 2];
    }
    let period = (end - time[0]) / (time.len() - 1) as f64;
    let width = ((SLOW / period).round() as usize).clamp(1, middle.len());
    let means: Vec<f64> = middle.windows(width).map(mean).collect();
    [deviation(middle), deviation(&means)]
}

/// What the log of a run would have of a course [N], with readings at a phase [s].
pub(super) fn logged(
    model: &FlangeModel,
    course: &FlangeCourse,
    run: &Logged<'_>,
    phase: f64,
) -> Vec<f64> {
    let force = flange_force(model, course, run.course.end + 2.0 * SAMPLED);
    read(&force, course.start, run, phase)
}

fn read(force: &[f64], start: f64, run: &Logged<'_>, phase: f64) -> Vec<f64> {
    let reading = |time: &f64| {
        let place = (run.reader.read_at(*time, phase) - start) / SAMPLED;
        force[(place.max(0.0) as usize).min(force.len() - 1)]
    };
    let readings: Vec<f64> = run.time.iter().map(reading).collect();
    run.reader.logged(&readings)
}

/// Results of a simulated log, and the spread of its force while the arm slides [N].
type LoggedResult = (RunMetrics, Option<f64>);

/// Results of a run by some flanges at all phases; none where one of them never settles to be measured.
pub(super) struct RunPrediction {
    pub peak: SimulatedResult,
    /// None where either does not ring.
    pub ringing: Option<SimulatedResult>,
    pub settling: SimulatedResult,
    pub spread: Option<SimulatedResult>,
    /// Force of the first flange [N].
    pub force: Vec<f64>,
}

pub(super) fn predict_run(
    models: &[FlangeModel],
    ripple: Option<Ripple>,
    run: &Logged<'_>,
) -> Option<RunPrediction> {
    let course = match ripple {
        Some(ripple) => run.course.with_ripple(ripple),
        None => run.course.course.clone(),
    };
    let mut results: Vec<LoggedResult> = Vec::new();
    let mut first = Vec::new();
    for model in models {
        let force = flange_force(model, &course, run.course.end + 2.0 * SAMPLED);
        for phase in PHASES {
            let log = read(&force, course.start, run, phase * run.reader.period);
            if first.is_empty() {
                first.clone_from(&log);
            }
            let spread = (run.sliding()).map(|slides| spreads(run.time, &log, slides)[0]);
            if let Ok(metrics) = run.with_force(log).metrics() {
                results.push((metrics, spread));
            }
        }
    }
    let of_values = |recorded: f64, values: Vec<f64>| {
        Some(SimulatedResult {
            recorded,
            simulated: median(values.iter().copied())?,
            low: values.iter().copied().fold(f64::INFINITY, f64::min),
            high: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        })
    };
    let beside = |recorded: f64, of: &dyn Fn(&LoggedResult) -> f64| {
        of_values(recorded, results.iter().map(of).collect())
    };
    let shown = run.shown;
    let spread = run.sliding().and(ripple).map(|_| {
        let recorded = run.sliding().map(|slides| run.recorded_spreads(slides)[0]);
        beside(recorded.unwrap_or(0.0), &|(_, spread)| {
            spread.unwrap_or(0.0)
        })
    });
    let rings = || results.iter().filter_map(|(m, _)| m.frequency).collect();
    Some(RunPrediction {
        peak: beside(shown.peak, &|(m, _)| m.peak)?,
        ringing: (shown.frequency).and_then(|recorded| of_values(recorded, rings())),
        settling: beside(shown.settling, &|(m, _)| m.settling)?,
        spread: spread.flatten(),
        force: first,
    })
}

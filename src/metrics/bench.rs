//! The numbers of a bench run; docs/METRICS.md has the definitions from here.

use super::catalogue::metrics;
use super::load::air_mass_balance;
use super::statistics::{extent, largest, moments, root_mean_square};
use super::window::Window;
use super::{MetricsError, Timing};
use crate::recording::{Recording, Unit, schema};
use crate::stats::NORMAL_95;

/// Share of a level that counts as steady: its last fifth, one second at most.
const STEADY_SHARE: f64 = 0.2;
const STEADY_LONGEST: f64 = 1.0;
/// Band within which a response counts as settled [1].
const SETTLED: f64 = 0.05;
/// Contact is a force above this [N].
const TOUCH_FORCE: f64 = 1.0;
/// Change of the level that a first-order lag has made after one time constant [1].
const LAG_SHARE: f64 = 0.632;
/// Density of air at reference conditions, ISO 8778 [kg/m3].
const REFERENCE_DENSITY: f64 = 1.185;

/// Limits against which a run is measured.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchLimits {
    /// When each command was given [s], and whether it was a force.
    pub command_times: Vec<f64>,
    /// When the surface began to move, or a hand to push [s].
    pub disturbed_from: Option<f64>,
    /// While the surface moved in its swing [s].
    pub moving: Option<(f64, f64)>,
    /// Ends of the stroke [m].
    pub stroke_limits: (f64, f64),
    /// Atmosphere, absolute [Pa].
    pub atmosphere: f64,
}

metrics! {
    /// One command and what came of it.
    LevelSummary,
    /// Every number of a command, in the order of summary.json.
    LEVEL_METRICS;
    always {
        start_s: f64 = "s", "given at", "since the start", Step [column("at")],
            "When the command was given.";
        set_pressure_bar_gauge: f64 = "bar", "set pressure", "at the end of the level", Step [column("set")],
            "Set pressure at the end of the level.";
        regulator_pressure_bar_gauge: f64 = "bar", "outlet pressure", "steady mean", Step [column("outlet")],
            "Pressure at the regulator's outlet, mean over the steady part.";
        regulator_delay_s: Option<f64> = "s", "regulator's delay", "command to 63 % of its change", Step [column("delay")],
            "Command until the outlet has made 63.2 % of its change.";
        force_mean_n: Option<f64> = "N", "mean", "steady mean", Step [of("force"), column("force")],
            "Mean contact force over the steady part; undefined without contact.";
        force_standard_deviation_n: Option<f64> = "N", "standard deviation", "about the steady mean", Step [of("force")],
            "Its standard deviation there.";
        measured_force_mean_n: Option<f64> = "N", "load cell's reading", "steady mean", Step [column("read")],
            "Mean of the load cell's reading there, as its software gives it.";
        force_settling_time_s: Option<f64> = "s", "settling time", "command to within 5 % of the change", Step [of("force"), column("settled")],
            "Command until the force stays within 5 % of its change about its steady mean; undefined once something else moves.";
        force_overshoot_percent: Option<f64> = "%", "overshoot", "of the change", Step [of("force")],
            "100 * the highest force beyond the steady mean / the change.";
        stroke_mm: Option<f64> = "mm", "stroke", "steady mean", Step [column("stroke")],
            "Mean stroke over the steady part.";
    }
    sometimes {}
    always {}
    also {}
}

metrics! {
    /// The numbers of a bench run. What a run does not determine is `None`.
    BenchSummary,
    /// All of them, in the order of summary.json.
    BENCH_METRICS;
    always {
        desired_force_n: Option<f64> = "N", "desired force", "mean, where forces are commanded", Force [],
            "Mean of the desired force over the same samples as the error; undefined where pressures are commanded.";
        force_mean_n: Option<f64> = "N", "mean", "surface moving; else last level, steady", Force [of("force"), fact(1), rank(1)],
            "Mean of the force.";
        force_rms_error_n: Option<f64> = "N", "RMS error", "about the desired force, else the mean", Force [of("force")],
            "Root of the mean square of the error.";
        force_rms_error_percent: Option<f64> = "%", "RMS error", "of the desired force, else the mean", Force [of("force"), fact(3), rank(3)],
            "100 * `force_rms_error_n` / the desired force, or the mean.";
        force_largest_error_percent: Option<f64> = "%", "largest error", "of the desired force, else the mean", Force [of("force")],
            "100 * largest abs(error) / the desired force, or the mean.";
        coefficient_of_variation_percent: Option<f64> = "%", "coefficient of variation", "standard deviation / mean", Force [fact(2), rank(2)],
            "100 * standard deviation / mean.";
        force_peak_n: Option<f64> = "N", "largest", "of the whole run", Peaks [of("force"), fact(6)],
            "Largest force of the whole run.";
        regulator_delay_s: Option<f64> = "s", "regulator's delay", "first command to 63 % of its change", Step [fact(4), rank(7)],
            "First command until the outlet has made 63.2 % of its change: dead time and time constant.";
        force_settling_time_s: Option<f64> = "s", "settling time", "last step with nothing else moving", Step [of("force"), fact(5), rank(4)],
            "Command until the force stays within 5 % of its change about the steady mean; of the last command that has a response.";
        force_overshoot_percent: Option<f64> = "%", "overshoot", "the same command, of the change", Step [of("force")],
            "100 * the highest force beyond the steady mean after the same command / the change.";
        force_slope_n_per_bar: Option<f64> = "N/bar", "force over pressure", "straight line through the levels", Step [],
            "Slope of the least-squares line of steady force over steady outlet pressure through the levels.";
        force_linearity_percent: Option<f64> = "%", "linearity error", "largest, of the highest level's force", Step [of("force")],
            "100 * largest distance of a level from that line / the highest level's force; needs three levels.";
        first_contact_s: Option<f64> = "s", "first contact", "since the start", Touch [],
            "First sample in contact.";
        impact_peak_n: Option<f64> = "N", "impact peak", "first 50 ms of contact", Touch [rank(5)],
            "Largest force in the first 50 ms of contact.";
        stroke_min_mm: Option<f64> = "mm", "smallest stroke", "since first contact, else the run", Stroke [],
            "Least stroke since first contact, or of the run.";
        stroke_max_mm: Option<f64> = "mm", "largest stroke", "since first contact, else the run", Stroke [],
            "Largest stroke since first contact, or of the run.";
        stroke_margin_mm: Option<f64> = "mm", "stroke margin", "least distance to either end", Stroke [fact(7), rank(6)],
            "Least distance of these two to the ends of the stroke.";
        measured_force_error_percent: Option<f64> = "%", "load cell's error", "mean of reading over truth, less 1", Sensors [],
            "100 * mean of (reading - force) / mean force, in contact.";
        measured_force_noise_n: Option<f64> = "N", "load cell's noise", "reading less truth, about its mean", Sensors [],
            "Standard deviation of (reading - force), in contact; the filter's lag is part of it.";
        estimated_force_rms_error_percent: Option<f64> = "%", "estimator's RMS error", "of the mean force, in contact", Sensors [],
            "100 * root mean square of (estimate - force) / mean force, in contact.";
        estimated_force_coverage_percent: Option<f64> = "%", "estimator's coverage", "truth inside its 95 % band, in contact", Sensors [],
            "Share of samples in contact with abs(estimate - force) at most 1.96 of its recorded deviations, which is the estimator's 95 % band.";
        air_consumed_normal_litres: Option<f64> = "l", "air consumed", "drawn in, at 20 °C and 1 bar", Run [],
            "Air that entered, at 20 degrees C and 1 bar (ISO 8778).";
        air_mass_balance_relative: Option<f64> = "1", "air balance, largest gap", "of the air in the device", Run [],
            "Largest over time of abs((entered - left) - (mass - mass at the start)) / mass, with entered and left both counted from the first sample, and mass the air in both chambers. How far the simulated pneumatics create or lose air; rounding leaves some 1e-13.";
        duration_s: f64 = "s", "simulated time", "the whole run", Run [],
            "Cycle time: simulated time from the first to the last sample, which of a job that is done are those of approach and retract.";
        /// Each command, in order.
        levels: Vec<LevelSummary>;
        /// Duration of the computation; differs from run to run.
        #[serde(skip_serializing_if = "Option::is_none")]
        timing: Option<Timing>;
    }
    sometimes {}
    always {}
    also {
        timing.wall_time_s = "s", "wall time", "of the computation", Run [],
            "Wall-clock time of the computation, as measured by the program.";
        timing.real_time_factor = "1", "real-time factor", "simulated time / wall time", Run [],
            "Simulated time / wall time: 10 means ten times faster than the real cell.";
    }
}

/// Measures a bench run.
///
/// # Errors
/// A channel in another unit than the schema's.
pub fn summarise_bench(
    recording: &Recording,
    limits: &BenchLimits,
) -> Result<BenchSummary, MetricsError> {
    let run = Run::of(recording)?;
    let mut summary = BenchSummary {
        duration_s: Window::run(recording).duration(),
        levels: levels(&run, limits),
        air_mass_balance_relative: air_mass_balance(&Window::run(recording))?,
        air_consumed_normal_litres: run
            .entered
            .and_then(|entered| Some((entered.last()? - entered[0]) / REFERENCE_DENSITY * 1e3)),
        ..BenchSummary::default()
    };
    if let Some(first) = summary.levels.first() {
        summary.regulator_delay_s = first.regulator_delay_s;
    }
    let responded = |level: &&LevelSummary| level.force_settling_time_s.is_some();
    if let Some(last) = summary.levels.iter().rev().find(responded) {
        summary.force_settling_time_s = last.force_settling_time_s;
        summary.force_overshoot_percent = last.force_overshoot_percent;
    }
    summary.force_peak_n = run.force.and_then(extent).map(|(_, most)| most);
    line(&mut summary);
    contact(&mut summary, &run, limits);
    uniformity(&mut summary, &run, limits);
    sensors(&mut summary, &run);
    Ok(summary)
}

/// The channels that are looked at, where they are finite throughout.
struct Run<'a> {
    time: &'a [f64],
    set_pressure: Option<&'a [f64]>,
    regulator: Option<&'a [f64]>,
    force: Option<&'a [f64]>,
    desired: Option<&'a [f64]>,
    measured: Option<&'a [f64]>,
    estimated: Option<&'a [f64]>,
    deviation: Option<&'a [f64]>,
    stroke: Option<&'a [f64]>,
    entered: Option<&'a [f64]>,
}

impl<'a> Run<'a> {
    fn of(recording: &'a Recording) -> Result<Self, MetricsError> {
        let window = Window::run(recording);
        let finite = |quantity, unit| window.finite(quantity, unit);
        Ok(Self {
            time: recording.time(),
            set_pressure: finite(schema::SET_PRESSURE, Unit::Pascal)?,
            regulator: finite(schema::REGULATOR_PRESSURE, Unit::Pascal)?,
            force: finite(schema::CONTACT_FORCE, Unit::Newton)?,
            desired: finite(schema::DESIRED_FORCE, Unit::Newton)?,
            measured: finite(schema::MEASURED_FORCE, Unit::Newton)?,
            estimated: finite(schema::ESTIMATED_FORCE, Unit::Newton)?,
            deviation: finite(schema::ESTIMATED_FORCE_DEVIATION, Unit::Newton)?,
            stroke: finite(schema::STROKE, Unit::Metre)?,
            entered: finite(schema::MASS_ENTERED, Unit::Kilogram)?,
        })
    }

    /// Samples from one time up to another [s].
    fn between(&self, start: f64, end: f64) -> std::ops::Range<usize> {
        let first = self.time.partition_point(|&time| time < start - 1e-9);
        let last = self.time.partition_point(|&time| time <= end + 1e-9);
        first..last.max(first)
    }
}

fn levels(run: &Run<'_>, limits: &BenchLimits) -> Vec<LevelSummary> {
    let Some(&run_end) = run.time.last() else {
        return Vec::new();
    };
    let ends = limits.command_times.iter().skip(1).copied();
    let ends = ends.chain([run_end]);
    limits
        .command_times
        .iter()
        .zip(ends)
        .filter_map(|(&start, end)| level(run, limits, start, end))
        .collect()
}

/// A level ends where the surface begins to move or a hand to push; one commanded after that has no response of its own.
fn level(run: &Run<'_>, limits: &BenchLimits, start: f64, end: f64) -> Option<LevelSummary> {
    let disturbed = limits.disturbed_from.unwrap_or(f64::INFINITY);
    let is_moved = disturbed <= start;
    let end = if is_moved { end } else { end.min(disturbed) };
    let steady_from = end - (STEADY_SHARE * (end - start)).min(STEADY_LONGEST);
    // The sample at `end` already belongs to the next command.
    let samples = run.between(start, end - 1e-6);
    let steady = run.between(steady_from, end - 1e-6);
    let mean = |values: Option<&[f64]>| Some(moments(&values?[steady.clone()])?.mean);
    let gauge = |pressure: f64| (pressure - limits.atmosphere) / 1e5;
    let regulator = mean(run.regulator)?;
    let force = run.force.and_then(|force| moments(&force[steady.clone()]));
    let pressed = force.filter(|force| force.mean > TOUCH_FORCE);
    let response = pressed.filter(|_| !is_moved).and_then(|steady| {
        let force = run.force?;
        Some(response(
            &run.time[samples.clone()],
            &force[samples.clone()],
            steady.mean,
        ))
    });
    Some(LevelSummary {
        start_s: start,
        set_pressure_bar_gauge: gauge(run.set_pressure?[samples.end.checked_sub(1)?]),
        regulator_pressure_bar_gauge: gauge(regulator),
        regulator_delay_s: run.regulator.and_then(|values| {
            let values = &values[samples.clone()];
            let (from, change) = (*values.first()?, regulator - values.first()?);
            let there = values
                .iter()
                .position(|value| (value - from) / change >= LAG_SHARE)?;
            (change.abs() > 1.0).then(|| run.time[samples.start + there] - start)
        }),
        force_mean_n: pressed.map(|force| force.mean),
        force_standard_deviation_n: pressed.map(|force| force.standard_deviation),
        measured_force_mean_n: pressed.and_then(|_| mean(run.measured)),
        force_settling_time_s: response.map(|(settling, _)| settling),
        force_overshoot_percent: response.map(|(_, overshoot)| overshoot),
        stroke_mm: mean(run.stroke).map(|stroke| stroke * 1e3),
    })
}

/// Settling time [s] and overshoot [%] of a force that goes to a steady value.
fn response(time: &[f64], force: &[f64], steady: f64) -> (f64, f64) {
    let change = steady - force[0];
    let band = SETTLED * change.abs();
    let outside = force
        .iter()
        .rposition(|value| (value - steady).abs() > band);
    let settled = outside.map_or(0, |last| (last + 1).min(time.len() - 1));
    let beyond = force
        .iter()
        .map(|value| (value - steady) * change.signum())
        .fold(0.0, f64::max);
    let overshoot = if change == 0.0 {
        0.0
    } else {
        100.0 * beyond / change.abs()
    };
    (time[settled] - time[0], overshoot)
}

/// Least-squares line of force over the regulator's pressure through the levels.
fn line(summary: &mut BenchSummary) {
    let points: Vec<(f64, f64)> = summary
        .levels
        .iter()
        .filter_map(|level| Some((level.regulator_pressure_bar_gauge, level.force_mean_n?)))
        .collect();
    if points.len() < 2 {
        return;
    }
    let count = points.len() as f64;
    let mean_x = points.iter().map(|p| p.0).sum::<f64>() / count;
    let mean_y = points.iter().map(|p| p.1).sum::<f64>() / count;
    let xx: f64 = points.iter().map(|p| (p.0 - mean_x).powi(2)).sum();
    let xy: f64 = points.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y)).sum();
    if xx < 1e-6 {
        return;
    }
    let slope = xy / xx;
    summary.force_slope_n_per_bar = Some(slope);
    if points.len() > 2 {
        let highest = points.iter().map(|p| p.1).fold(0.0, f64::max);
        let off = largest(points.iter().map(|p| p.1 - mean_y - slope * (p.0 - mean_x)));
        summary.force_linearity_percent = off.map(|off| 100.0 * off / highest);
    }
}

fn contact(summary: &mut BenchSummary, run: &Run<'_>, limits: &BenchLimits) {
    const IMPACT: f64 = 0.05;
    let touch = run
        .force
        .and_then(|force| force.iter().position(|&force| force > TOUCH_FORCE));
    if let (Some(touch), Some(force)) = (touch, run.force) {
        let start = run.time[touch];
        summary.first_contact_s = Some(start);
        summary.impact_peak_n = largest(force[run.between(start, start + IMPACT)].iter().copied());
    }
    if let Some((least, greatest)) = run.stroke.and_then(|s| extent(&s[touch.unwrap_or(0)..])) {
        let (lower, upper) = limits.stroke_limits;
        summary.stroke_min_mm = Some(least * 1e3);
        summary.stroke_max_mm = Some(greatest * 1e3);
        summary.stroke_margin_mm = Some((least - lower).min(upper - greatest) * 1e3);
    }
}

/// While the surface moves, else over the steady part of the last level.
fn uniformity(summary: &mut BenchSummary, run: &Run<'_>, limits: &BenchLimits) {
    let Some(force) = run.force else {
        return;
    };
    let last_command = limits.command_times.last().copied();
    let range = match (limits.moving, last_command, run.time.last()) {
        (Some((start, end)), _, _) => run.between(start, end),
        (None, Some(start), Some(&end)) => run.between(
            end - (STEADY_SHARE * (end - start)).min(STEADY_LONGEST),
            end,
        ),
        _ => return,
    };
    let force = &force[range.clone()];
    let Some(spread) = moments(force).filter(|m| m.mean > TOUCH_FORCE) else {
        return;
    };
    let errors: Vec<f64> = match run.desired {
        Some(desired) => force
            .iter()
            .zip(&desired[range.clone()])
            .map(|(force, desired)| force - desired)
            .collect(),
        None => force.iter().map(|force| force - spread.mean).collect(),
    };
    let reference = run
        .desired
        .and_then(|desired| moments(&desired[range]))
        .map_or(spread.mean, |desired| desired.mean);
    summary.desired_force_n = run.desired.map(|_| reference);
    let percent = |value: f64| 100.0 * value / reference;
    summary.force_mean_n = Some(spread.mean);
    summary.coefficient_of_variation_percent =
        Some(100.0 * spread.standard_deviation / spread.mean);
    summary.force_rms_error_n = root_mean_square(&errors);
    summary.force_rms_error_percent = summary.force_rms_error_n.map(percent);
    summary.force_largest_error_percent = largest(errors).map(percent);
}

/// Readings and estimates against the truth, while in contact.
fn sensors(summary: &mut BenchSummary, run: &Run<'_>) {
    let Some(force) = run.force else {
        return;
    };
    let pressed: Vec<usize> = (0..force.len())
        .filter(|&i| force[i] > TOUCH_FORCE)
        .collect();
    let truth: Vec<f64> = pressed.iter().map(|&i| force[i]).collect();
    let Some(mean) = moments(&truth).map(|m| m.mean) else {
        return;
    };
    let errors =
        |values: &[f64]| -> Vec<f64> { pressed.iter().map(|&i| values[i] - force[i]).collect() };
    if let Some(spread) = run.measured.and_then(|measured| moments(&errors(measured))) {
        summary.measured_force_error_percent = Some(100.0 * spread.mean / mean);
        summary.measured_force_noise_n = Some(spread.standard_deviation);
    }
    if let (Some(estimated), Some(deviation)) = (run.estimated, run.deviation) {
        let errors = errors(estimated);
        summary.estimated_force_rms_error_percent =
            root_mean_square(&errors).map(|rms| 100.0 * rms / mean);
        let covered = pressed
            .iter()
            .zip(&errors)
            .filter(|(i, error)| error.abs() <= NORMAL_95 * deviation[**i])
            .count();
        summary.estimated_force_coverage_percent =
            Some(100.0 * covered as f64 / pressed.len() as f64);
    }
}

#[cfg(test)]
mod tests;

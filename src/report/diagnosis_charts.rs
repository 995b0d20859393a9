//! The charts of a diagnosis: recordings beside models, and what links lack.

use crate::diagnosis::answer::Answer;
use crate::diagnosis::answer::words::{
    CHANNEL_UNITS, CHANNEL_WORDS, capital, display_name, of_column, reference_noise,
};
use crate::diagnosis::difference::comparison::{Balance, Compared, ComparedChannel};
use crate::diagnosis::difference::mismatch::Mismatch;
use crate::diagnosis::formula::unlisted::report::{ShapeRow, UnlistedReport};
use crate::document::{Band, Horizontal, Panel, Role, Series, Stroke};
use crate::stats::{NORMAL_95, quantiles};

/// Origin subtracted from the times of a recording [s]: nothing, unless they are those of a clock, which single precision cannot tell apart.
pub(super) fn origin(recording: &Compared) -> f64 {
    const CLOCK: f64 = 100.0;
    let start = recording.time.first().copied().unwrap_or(0.0);
    if start.abs() > CLOCK {
        start.floor()
    } else {
        0.0
    }
}

/// The time axis with its label.
fn time_axis(origin: f64) -> Horizontal {
    match origin {
        0.0 => Horizontal::Time,
        origin => Horizontal::Quantity(format!("time since {origin} s [s]")),
    }
}

/// A channel of a recording: as measured and by the models; and what they leave, with the band of the sensor's noise.
pub(super) fn channel<'a>(
    answer: &Answer,
    recording: &'a Compared,
    channel: &'a ComparedChannel,
) -> [Panel<'a>; 2] {
    let column = &channel.column;
    let (name, unit, factor) = of_column(column);
    let start = origin(recording);
    let from_start = |t: f64| t - start;
    let time: Vec<f64> = recording.time.iter().map(|t| from_start(*t)).collect();
    let scaled = |values: &[f64]| -> Vec<f64> { values.iter().map(|v| v * factor).collect() };
    let series = |values: Vec<f64>, label: &str, role, stroke| {
        Series::new(label, time.clone(), values, role, stroke)
    };
    let own = |m: &&Mismatch| m.recording == recording.name && m.channel == *column;
    let spans = answer.mismatch.iter().filter(own);
    let spans: Vec<[f64; 2]> = spans
        .map(|m| [from_start(m.start_s), from_start(m.end_s)])
        .collect();
    let chart = |title: String, series, bands| Panel {
        title,
        vertical_label: format!("{name} [{unit}]"),
        horizontal: time_axis(start),
        series,
        bands,
        markers: Vec::new(),
        spans: spans.clone(),
        group: recording.name.clone(),
        within: None,
    };
    let words = capital(&name);
    // Of a flange the desired force stands in place of a nominal model.
    let is_flange = !answer.details.runs.is_empty();
    let nominal = if is_flange { "desired" } else { "nominal" };
    let models = [
        (&channel.nominal, nominal, Role::Command, Stroke::Dashed),
        (&channel.improved, "improved", Role::Estimate, Stroke::Plain),
    ];
    let models = models
        .into_iter()
        .filter(|(values, ..)| values.iter().any(|v| v.is_finite()));
    let known = channel.measured.iter().any(|v| v.is_finite());
    let measured = known.then(|| {
        let values = scaled(&channel.measured);
        series(values, "measured", Role::Measured, Stroke::Plain)
    });
    let lines = models.clone();
    let lines =
        lines.map(|(values, label, role, stroke)| series(scaled(values), label, role, stroke));
    let values = chart(
        words.clone(),
        measured.into_iter().chain(lines).collect(),
        Vec::new(),
    );
    let left = models.filter(|_| known).map(|(values, label, role, _)| {
        let pairs = channel.measured.iter().zip(values);
        let left: Vec<f64> = pairs.map(|(m, v)| factor * (m - v)).collect();
        let stroke = match role {
            Role::Command => Stroke::Raw,
            _ => Stroke::Plain,
        };
        series(left, &format!("measured less {label}"), role, stroke)
    });
    let noise = answer.details.noise.iter();
    let noise = noise.filter(|n| n.channel == *column).map(|n| {
        let half = NORMAL_95 * factor * n.standard_deviation;
        Band {
            label: reference_noise(answer.details.remaining.is_some()).to_owned(),
            from: -half,
            to: half,
        }
    });
    let title = format!(
        "{words}: what is left; the band holds 95 % of {}",
        reference_noise(answer.details.remaining.is_some())
    );
    [values, chart(title, left.collect(), noise.collect())]
}

/// A variable for people: words, unit and what a value in SI is multiplied by.
pub fn variable(name: &str) -> (&str, &'static str, f64) {
    match name {
        "time" => ("time", "s", 1.0),
        "stroke_m" => ("stroke", "mm", 1e3),
        "velocity" => ("speed of extension", "mm/s", 1e3),
        "velocity_sign" => ("direction of motion", "1", 1.0),
        "acceleration" => ("acceleration", "m/s2", 1.0),
        "chamber_pressure" => ("pressure in chamber 1", "bar absolute", 1e-5),
        "pressure_difference" => ("pressure difference across the piston", "bar", 1e-5),
        "pressure_rate" => ("rate of pressure in chamber 1", "bar/s", 1e-5),
        "mass_flow" => ("flow of air into chamber 1", "g/s", 1e3),
        "set_pressure" => ("set pressure", "bar", 1e-5),
        "surface_m" => ("place of the surface", "mm", 1e3),
        "contact_force" => ("contact force", "N", 1.0),
        "phase" => ("touching (2) and commanded to extend (1)", "1", 1.0),
        other => (other, "", 1.0),
    }
}

/// Where nearly all values lie, with some room; none where there are none. At an impact a few are ten times as large.
pub fn robust_range(values: &[f64]) -> Option<[f64; 2]> {
    const BEYOND: f64 = 0.01;
    const ROOM: f64 = 0.35;
    let finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    let ends = quantiles(&finite, &[BEYOND, 1.0 - BEYOND])?;
    let (low, high) = (ends[0].min(0.0), ends[1].max(0.0));
    let room = ROOM * (high - low);
    (room > 0.0).then_some([low - room, high + room])
}

/// Residual of a link, in words.
pub fn lacking(balance: &Balance) -> &'static str {
    match balance.link.as_str() {
        "regulator" => "pressure at the regulator's outlet",
        "piston" => "force on the piston",
        "contact" => "contact force",
        _ => CHANNEL_WORDS[balance.channel as usize],
    }
}

/// Residual of a link against the variable that explains it, before and after.
pub(super) fn balance<'a>(balance: &Balance) -> Panel<'a> {
    let (unit, factor) = CHANNEL_UNITS[balance.channel as usize];
    let (words, of, scale) = variable(&balance.variable);
    let lacking = lacking(balance);
    let known = |i: &usize| balance.values[*i].is_finite() && balance.before[*i].is_finite();
    let known: Vec<usize> = (0..balance.values.len()).filter(known).collect();
    let places: Vec<f64> = known.iter().map(|i| balance.values[*i] * scale).collect();
    let cloud = |values: &[f64], label: &str, role| {
        let values: Vec<f64> = known.iter().map(|i| values[*i] * factor).collect();
        Series::new(label, places.clone(), values, role, Stroke::Points)
    };
    Panel {
        title: format!("{}: what it lacks", capital(lacking)),
        vertical_label: format!("lacking [{unit}]"),
        horizontal: Horizontal::Quantity(format!("{words} [{of}]")),
        series: vec![
            cloud(&balance.before, "nominal", Role::Command),
            cloud(&balance.after, "improved", Role::Estimate),
        ],
        within: robust_range(&balance.before).map(|ends| ends.map(|end| factor * end)),
        ..Panel::default()
    }
}

/// A model discrepancy against its variable.
pub(super) fn unlisted<'a>(report: &UnlistedReport) -> Panel<'a> {
    let (_, at_unit, at) = display_name(&format!("x_{}", report.at_unit));
    let (_, unit, of) = display_name(&format!("x_{}", report.value_unit));
    // Where nothing was recorded the interval is wider than all that the term does: not drawn.
    let known = |row: &ShapeRow| row.half_width < report.peak_to_peak;
    let runs = report.shape.chunk_by(|a, b| known(a) == known(b));
    let runs = runs.filter(|run| known(&run[0]));
    let band = |(index, run): (usize, &[ShapeRow])| {
        let edge =
            |row: &ShapeRow, side: f64| (at * row.at, of * (row.value + side * row.half_width));
        let there = run.iter().map(|row| edge(row, -1.0));
        let back = run.iter().rev().map(|row| edge(row, 1.0));
        let (places, values): (Vec<f64>, Vec<f64>) = there.chain(back).unzip();
        let label = if index == 0 { "95 % band" } else { "" };
        Series::new(label, places, values, Role::Band, Stroke::Area)
    };
    let bands = runs.enumerate().map(band);
    let all = report.shape.iter().map(|r| (at * r.at, of * r.value));
    let (along, term): (Vec<f64>, Vec<f64>) = all.unzip();
    let term = Series::new(
        "fitted in the simulator",
        along,
        term,
        Role::Estimate,
        Stroke::Truth,
    );
    let over = match report.period_s {
        Some(_) => "time within the period".to_owned(),
        None => variable(&report.variable).0.replace('_', " "),
    };
    Panel {
        title: format!("The term: {}", report.port.replace('_', " ")),
        vertical_label: format!("{} [{unit}]", report.port.replace('_', " ")),
        horizontal: Horizontal::Quantity(format!("{over} [{at_unit}]")),
        series: bands.chain([term]).collect(),
        ..Panel::default()
    }
}

//! Turns channels into plots: named, coloured series in the units an engineer reads, with their
//! bands and limits.

use super::colours::{
    BLUE, GREEN, GREY, ORANGE, PALE_GREY, PALETTE, PURPLE, SKY_BLUE, VERMILLION, YELLOW,
};
use super::options::FOLLOW_PHASE;
use crate::recording::schema::{self, JointSignal, PlotGroup};
use crate::recording::{Recording, RecordingError, Unit};
use crate::scene::SceneLimits;
use crate::scene::colour::Colour;

/// A line in a plot.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Series {
    /// Its entity, below the plot's, if it is a guide.
    pub(super) name: String,
    /// Its name in the legend, unit included.
    pub(super) label: String,
    pub(super) colour: Colour,
    /// Line width [points].
    pub(super) width: f32,
    /// A guide for the eye: a set value, a band or a limit. Guides have an entity each, the signals of a plot one together, whose times are
    /// stored once.
    pub(super) guide: bool,
    /// Values at the recording's samples, in the plot's unit; of a guide that never changes only those at the two ends.
    pub(super) values: Vec<f64>,
}

/// A plot with its lines.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plot {
    pub(super) group: PlotGroup,
    /// Heading of its panel.
    pub(super) title: &'static str,
    /// Entity of which its series are children.
    pub(super) entity: &'static str,
    pub(super) series: Vec<Series>,
    /// Range of the vertical axis; `None` fits the data.
    pub(super) range: Option<[f64; 2]>,
}

impl Plot {
    /// The lines of signals.
    pub(super) fn signals(&self) -> impl Iterator<Item = &Series> {
        self.series.iter().filter(|series| !series.guide)
    }

    /// The guides for the eye.
    pub(super) fn guides(&self) -> impl Iterator<Item = &Series> {
        self.series.iter().filter(|series| series.guide)
    }
}

/// Style of a group of signals.
struct Style {
    group: PlotGroup,
    title: &'static str,
    entity: &'static str,
    unit: &'static str,
    /// Plot units per SI unit.
    factor: f64,
}

const STYLES: [Style; 6] = [
    style(
        PlotGroup::Force,
        "Contact force [N]",
        "/plots/force",
        "N",
        1.0,
    ),
    style(PlotGroup::Stroke, "Stroke [mm]", "/plots/stroke", "mm", 1e3),
    style(
        PlotGroup::Pressure,
        "Pressure [bar absolute]",
        "/plots/pressure",
        "bar",
        1e-5,
    ),
    style(
        PlotGroup::PathError,
        "Path error [µm]",
        "/plots/path_error",
        "µm",
        1e6,
    ),
    style(
        PlotGroup::JointTorque,
        "Joint torque [%]",
        "/plots/joint_torque",
        "%",
        1e2,
    ),
    style(
        PlotGroup::ForceBalance,
        "Other forces [N]",
        "/plots/other_forces",
        "N",
        1.0,
    ),
];

const fn style(
    group: PlotGroup,
    title: &'static str,
    entity: &'static str,
    unit: &'static str,
    factor: f64,
) -> Style {
    Style {
        group,
        title,
        entity,
        unit,
        factor,
    }
}

/// Offsets of the lines around the desired force, as shares of it.
const FORCE_BANDS: [(f64, &str, &str); 4] = [
    (0.05, "band_plus_5", "±5 % [N]"),
    (-0.05, "band_minus_5", "±5 % [N]"),
    (0.10, "band_plus_10", "±10 % [N]"),
    (-0.10, "band_minus_10", "±10 % [N]"),
];

/// All plots for which the recording has signals.
///
/// # Errors
/// [`RecordingError::Scene`] if a joint with a torque has no torque limit.
pub(super) fn plots(
    recording: &Recording,
    limits: &SceneLimits,
) -> Result<Vec<Plot>, RecordingError> {
    let mut plots = Vec::new();
    for style in &STYLES {
        let series = match style.group {
            PlotGroup::JointTorque => joint_torque_series(recording, limits, style)?,
            _ => group_series(recording, style),
        };
        if series.is_empty() {
            continue;
        }
        let mut plot = Plot {
            group: style.group,
            title: style.title,
            entity: style.entity,
            series,
            range: None,
        };
        add_limits(&mut plot, recording, limits, style);
        plots.push(plot);
    }
    Ok(plots)
}

fn group_series(recording: &Recording, style: &Style) -> Vec<Series> {
    let signals = schema::SIGNALS
        .iter()
        .chain(&schema::BENCH_SIGNALS)
        .filter(|s| s.group == Some(style.group));
    let mut series = Vec::new();
    for (index, signal) in signals.enumerate() {
        let Some(channel) = recording.channel(signal.quantity) else {
            continue;
        };
        // A channel of the same name in another unit is another signal.
        if channel.unit != signal.unit {
            continue;
        }
        let values = channel.values.iter().map(|v| v * style.factor).collect();
        let label = format!("{} [{}]", signal.label, style.unit);
        let colour = signal_colour(signal.quantity, index);
        let look = (label, colour, 1.5);
        series.push(match signal.quantity {
            schema::DESIRED_FORCE => guide(signal.quantity, look, values),
            _ => line(signal.quantity, look, values),
        });
    }
    // What a sensor reads of a signal is drawn first, below the signal itself.
    series.sort_by_key(|series| !series.name.starts_with("measured"));
    series
}

/// The signals that matter most keep a colour of their own; the rest take the palette's.
fn signal_colour(quantity: &str, index: usize) -> Colour {
    match quantity {
        schema::CONTACT_FORCE | schema::STROKE => SKY_BLUE,
        schema::DESIRED_FORCE | schema::SET_PRESSURE => PALE_GREY,
        schema::CHAMBER_1_PRESSURE => ORANGE,
        schema::CHAMBER_2_PRESSURE => GREEN,
        schema::REGULATOR_PRESSURE => PURPLE,
        _ => PALETTE[index % PALETTE.len()],
    }
}

fn joint_torque_series(
    recording: &Recording,
    limits: &SceneLimits,
    style: &Style,
) -> Result<Vec<Series>, RecordingError> {
    let mut series = Vec::new();
    for channel in recording.channels() {
        let Some((joint, JointSignal::Torque)) = schema::parse_joint_quantity(&channel.quantity)
        else {
            continue;
        };
        if channel.unit != Unit::NewtonMetre {
            continue;
        }
        let Some(limit) = limits.joint_torque.get(joint - 1) else {
            let what = format!("number of joint torque limits for `{}`", channel.quantity);
            let expected = format!("at least {joint}");
            return Err(RecordingError::scene(
                what,
                limits.joint_torque.len(),
                expected,
            ));
        };
        let values = channel
            .values
            .iter()
            .map(|v| v / limit * style.factor)
            .collect();
        let label = format!("joint {joint} [{}]", style.unit);
        let colour = PALETTE[(joint - 1) % PALETTE.len()];
        series.push(line(&channel.quantity, (label, colour, 1.5), values));
    }
    Ok(series)
}

fn add_limits(plot: &mut Plot, recording: &Recording, limits: &SceneLimits, style: &Style) {
    match plot.group {
        PlotGroup::Force => add_force_band(plot, recording),
        PlotGroup::Stroke => {
            if let Some([low, high]) = limits.stroke.map(|stop| stop.map(|v| v * style.factor)) {
                let margin = 0.06 * (high - low);
                plot.range = Some([low - margin, high + margin]);
                plot.series.push(limit("retracted", "end stops [mm]", low));
                plot.series.push(limit("extended", "end stops [mm]", high));
            }
        }
        PlotGroup::JointTorque => {
            plot.range = Some([-112.0, 112.0]);
            plot.series.push(limit("limit_plus", "limits [%]", 100.0));
            plot.series.push(limit("limit_minus", "limits [%]", -100.0));
        }
        PlotGroup::Pressure => plot.range = roomy_range(&plot.series),
        PlotGroup::PathError | PlotGroup::ForceBalance => {}
    }
}

/// The range of all values with room above and below, so that a line along an edge can be seen.
fn roomy_range(series: &[Series]) -> Option<[f64; 2]> {
    let values = || {
        series
            .iter()
            .flat_map(|series| series.values.iter().copied())
    };
    let low = values().fold(f64::INFINITY, f64::min);
    let high = values().fold(f64::NEG_INFINITY, f64::max);
    let room = 0.1 * (high - low);
    (room.is_finite() && room > 0.0).then_some([low - room, high + room])
}

/// Lines 5 and 10 % off the desired force, and a range in which they can be read.
fn add_force_band(plot: &mut Plot, recording: &Recording) {
    let Some(desired) = recording.channel(schema::DESIRED_FORCE) else {
        return;
    };
    for (share, name, label) in FORCE_BANDS {
        let values = desired.values.iter().map(|v| v * (1.0 + share)).collect();
        let colour = if share.abs() < 0.07 {
            YELLOW
        } else {
            VERMILLION
        };
        plot.series
            .push(guide(name, (label.to_owned(), colour, 0.8), values));
    }
    let force = recording.channel(schema::CONTACT_FORCE);
    plot.range = match recording.phase(FOLLOW_PHASE) {
        Some(follow) => {
            let span = recording.samples_in(follow);
            range_of_following(
                &desired.values[span.clone()],
                force.map(|f| &f.values[span]),
            )
        }
        None => range_of_all(&desired.values, force.map(|f| &f.values[..])),
    };
}

/// The axis reaches at most so many times the desired force.
const HIGHEST: f64 = 3.0;

/// From the lowest force while following to the highest, with the bands of 10 %; the table tells the peaks of the other phases.
fn range_of_following(desired: &[f64], force: Option<&[f64]>) -> Option<[f64; 2]> {
    let most = desired.iter().copied().fold(0.0, f64::max);
    let bands = desired.iter().flat_map(|d| [0.9 * d, 1.1 * d]);
    let force = force.into_iter().flatten().copied();
    let all = bands.chain(force).filter(|value| value.is_finite());
    let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    let high = high.min(HIGHEST * most);
    let room = 0.1 * (high - low);
    (most > 0.0 && room > 0.0).then_some([low - room, high + room])
}

/// From nothing to the peak, but not so far that the bands cannot be read.
fn range_of_all(desired: &[f64], force: Option<&[f64]>) -> Option<[f64; 2]> {
    let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let most = largest(desired);
    // An impact's peak may be many times the desired force; the table tells its height.
    let top = force.map_or(0.0, largest).clamp(1.2 * most, 2.0 * most);
    (most > 0.0).then_some([-0.05 * most, 1.05 * top])
}

/// A horizontal line over the whole recording.
fn limit(name: &str, label: &str, value: f64) -> Series {
    guide(name, (label.to_owned(), GREY, 0.8), vec![value; 2])
}

/// A series of all samples, with its label, colour and width.
fn line(name: &str, (label, colour, width): (String, Colour, f32), values: Vec<f64>) -> Series {
    Series {
        name: name.to_owned(),
        label,
        colour,
        width,
        guide: false,
        values,
    }
}

/// A guide: all samples, or the two ends if its value never changes.
fn guide(name: &str, look: (String, Colour, f32), mut values: Vec<f64>) -> Series {
    // Constant stretches within a series stay whole: the viewer thins each pixel's samples out to
    // their extremes and would join the wrong one of them to a far next sample.
    if values.len() > 2 && values.iter().all(|value| *value == values[0]) {
        values.truncate(2);
    }
    Series {
        guide: true,
        ..line(name, look, values)
    }
}

/// Colour of a phase's lane: the usual phases have theirs, others take the palette's.
pub(super) fn phase_colour(name: &str, index: usize) -> Colour {
    match name {
        "approach" => BLUE,
        "engage" => ORANGE,
        "follow" => GREEN,
        "retract" => PURPLE,
        _ => PALETTE[index % PALETTE.len()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{PhaseSpan, RecordedChannel};

    fn recording(channels: Vec<RecordedChannel>) -> Recording {
        let time = (0..6_i32).map(f64::from).collect();
        Recording::new(time, channels, vec![]).unwrap()
    }

    fn find<'a>(plot: &'a Plot, name: &str) -> &'a Series {
        plot.series
            .iter()
            .find(|series| series.name == name)
            .unwrap()
    }

    #[test]
    fn a_guide_that_never_changes_keeps_its_ends_only() {
        let look = || (String::new(), GREY, 1.0);
        assert_eq!(guide("x", look(), vec![2.0; 6]).values, [2.0, 2.0]);
        let step = vec![2.0, 2.0, 2.0, 2.0, 2.0, 3.0];
        assert_eq!(guide("x", look(), step.clone()).values, step);
        assert_eq!(line("x", look(), vec![2.0; 6]).values, [2.0; 6]);
    }

    #[test]
    fn force_is_drawn_in_its_band() {
        let plots = plots(
            &recording(vec![
                RecordedChannel::new(schema::CONTACT_FORCE, Unit::Newton, vec![900.0; 6]),
                RecordedChannel::new(schema::DESIRED_FORCE, Unit::Newton, vec![100.0; 6]),
            ]),
            &SceneLimits::default(),
        )
        .unwrap();
        assert_eq!(plots.len(), 1);
        assert_eq!(find(&plots[0], "band_plus_5").values, [105.0, 105.0]);
        assert_eq!(find(&plots[0], "band_minus_10").values, [90.0, 90.0]);
        assert_eq!(find(&plots[0], "contact_force").label, "contact force [N]");
        // The peak of 900 N is cut so that the band stays readable.
        assert_eq!(plots[0].range, Some([-5.0, 210.0]));
    }

    #[test]
    fn the_axis_of_the_force_is_scaled_to_following() {
        let time = (0..6_i32).map(f64::from).collect();
        let follow = PhaseSpan {
            name: FOLLOW_PHASE.into(),
            start: 2.0,
            end: 4.0,
        };
        let force = vec![0.0, 700.0, 101.0, 118.0, 0.0, 0.0];
        let channels = vec![
            RecordedChannel::new(schema::CONTACT_FORCE, Unit::Newton, force),
            RecordedChannel::new(schema::DESIRED_FORCE, Unit::Newton, vec![100.0; 6]),
        ];
        let recording = Recording::new(time, channels, vec![follow]).unwrap();
        let plots = plots(&recording, &SceneLimits::default()).unwrap();
        // 90 to 118 N with a tenth of that on either side: the touch of 700 N is beyond it.
        let [low, high] = plots[0].range.unwrap();
        assert!(
            (low - 87.2).abs() < 1e-9 && (high - 120.8).abs() < 1e-9,
            "{low} {high}"
        );
    }

    #[test]
    fn stroke_is_in_millimetres_between_its_stops() {
        let limits = SceneLimits {
            stroke: Some([0.0, 0.05]),
            joint_torque: vec![],
        };
        let stroke = RecordedChannel::new(schema::STROKE, Unit::Metre, vec![0.025; 6]);
        let plots = plots(&recording(vec![stroke]), &limits).unwrap();
        assert_eq!(find(&plots[0], "stroke").values, [25.0; 6]);
        assert_eq!(find(&plots[0], "extended").values, [50.0, 50.0]);
        assert_eq!(plots[0].range, Some([-3.0, 53.0]));
    }

    #[test]
    fn torque_is_a_share_of_its_limit_and_needs_one() {
        let torque = || RecordedChannel::new("joint_2_torque", Unit::NewtonMetre, vec![-30.0; 6]);
        let mut limits = SceneLimits {
            stroke: None,
            joint_torque: vec![100.0, 120.0],
        };
        let drawn = plots(&recording(vec![torque()]), &limits).unwrap();
        assert_eq!(find(&drawn[0], "joint_2_torque").values, [-25.0; 6]);
        assert_eq!(find(&drawn[0], "limit_minus").values, [-100.0, -100.0]);
        limits.joint_torque.pop();
        let message = plots(&recording(vec![torque()]), &limits)
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("`joint_2_torque` is 1, expected at least 2"),
            "{message}"
        );
    }

    #[test]
    fn pressure_is_in_bar_and_absent_signals_make_no_plot() {
        let pressure =
            RecordedChannel::new(schema::CHAMBER_1_PRESSURE, Unit::Pascal, vec![4.0e5; 6]);
        let plots = plots(&recording(vec![pressure]), &SceneLimits::default()).unwrap();
        assert_eq!(plots.len(), 1);
        assert_eq!(plots[0].series.len(), 1);
        assert!((plots[0].series[0].values[0] - 4.0).abs() < 1e-12);
        assert_eq!(plots[0].range, None);
    }

    #[test]
    fn a_range_leaves_room_and_passes_over_missing_values() {
        let values = vec![f64::NAN, 1.0, 3.0];
        let series = line("x", (String::new(), GREY, 1.0), values);
        let [low, high] = roomy_range(&[series]).unwrap();
        assert!((low - 0.8).abs() < 1e-12 && (high - 3.2).abs() < 1e-12);
    }
}

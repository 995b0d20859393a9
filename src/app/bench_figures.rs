//! figures.svg of a bench run: the source paper's pictures - pressure, force and stroke against time.

use super::estimate_figure;
use crate::document::{Figure, Marker, Panel, Role, Series, Stroke};
use crate::figure::{FigureError, svg};
use crate::physics::valve::ValvePosition;
use crate::recording::{Recording, schema};
use crate::report::{FORCE, Line, PRESSURE, STROKE};
use crate::scenario::BenchScenario;
use crate::scenario::bench::CommandScenario;

/// Draws a run.
///
/// # Errors
/// Something cannot be drawn.
pub(super) fn figures(
    scenario: &BenchScenario,
    recording: &Recording,
) -> Result<String, FigureError> {
    let atmosphere = scenario.nominal.device.gas.atmosphere;
    let last = recording.time().last().copied().unwrap_or(0.0);
    let events = events(scenario, last);
    let bare: Vec<Marker> = events
        .iter()
        .map(|event| Marker {
            label: String::new(),
            at: event.at,
        })
        .collect();
    let panel =
        |title: &str, label: &str, lines: &[Line], convert: &dyn Fn(f64) -> f64, markers| Panel {
            title: title.to_owned(),
            vertical_label: label.to_owned(),
            series: series(scenario, recording, lines, convert),
            markers,
            ..Panel::default()
        };
    let gauge = |pressure: f64| (pressure - atmosphere) / 1e5;
    let mut panels = vec![
        panel(
            "Pressure",
            "pressure [bar gauge]",
            &PRESSURE,
            &gauge,
            events,
        ),
        panel(
            "Contact force",
            "force [N]",
            &FORCE,
            &|force| force,
            bare.clone(),
        ),
        panel(
            "Stroke",
            "stroke [mm]",
            &STROKE,
            &|stroke| stroke * 1e3,
            bare,
        ),
    ];
    panels[1].series.extend(estimate_figure::band(recording));
    if let Some(mut error) = estimate_figure::error_panel(recording) {
        error.markers.clone_from(&panels[1].markers);
        panels.insert(2, error);
    }
    panels.retain(|panel| !panel.series.is_empty());
    svg(&Figure {
        title: scenario.title.clone(),
        panels,
    })
}

fn series<'a>(
    scenario: &BenchScenario,
    recording: &'a Recording,
    lines: &[Line],
    convert: &dyn Fn(f64) -> f64,
) -> Vec<Series<'a>> {
    lines
        .iter()
        .enumerate()
        .filter(|(index, _)| !repeats(recording, lines, *index))
        .filter_map(|(_, &(quantity, label, role, stroke))| {
            let channel = recording.channel(quantity)?;
            let values: Vec<f64> = channel.values.iter().map(|&value| convert(value)).collect();
            let label = match scenario.sensing.force_delay() {
                delay if quantity == schema::MEASURED_FORCE && delay > 0.0 => {
                    format!("{label} (delay {:.0} ms)", delay * 1e3)
                }
                _ => label.to_owned(),
            };
            let line = Series::new(label, recording.time(), values, role, stroke);
            Some(match stroke {
                Stroke::Dashed if quantity != schema::SURFACE_POSITION => line.stepwise(),
                _ => line,
            })
        })
        .collect()
}

/// Whether a line is a reading that is the truth, or a reading before it, sample by sample. An ideal sensor's would only hide the truth.
fn repeats(recording: &Recording, lines: &[Line], index: usize) -> bool {
    let is_reading = |line: &Line| matches!(line.2, Role::Measured | Role::Filtered);
    let Some(own) = recording.channel(lines[index].0) else {
        return false;
    };
    is_reading(&lines[index])
        && lines.iter().enumerate().any(|(other, line)| {
            (other < index || !is_reading(line))
                && other != index
                && recording
                    .channel(line.0)
                    .is_some_and(|channel| channel.values == own.values)
        })
}

/// Commands and switchings up to the last sample's time [s], which a run that was stopped has before its end.
fn events(scenario: &BenchScenario, last: f64) -> Vec<Marker> {
    let commands = scenario.command.steps().iter().map(|&(at, value)| Marker {
        label: match scenario.command {
            // To a millibar, with as few digits as that takes, but one.
            CommandScenario::SetPressure(_) => format!("set {:?} bar", (value / 1e2).round() / 1e3),
            CommandScenario::Force(_) => format!("desired {value:.0} N"),
        },
        at,
    });
    let valve = scenario.valve.iter().map(|&(at, position)| Marker {
        label: match position {
            ValvePosition::Extend => "valve: extend".to_owned(),
            ValvePosition::Retract => "valve: retract".to_owned(),
        },
        at,
    });
    let mut events: Vec<Marker> = commands
        .chain(valve)
        .filter(|event| event.at <= last)
        .collect();
    events.sort_by(|a, b| a.at.total_cmp(&b.at));
    events
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::rig::Rig;
    use crate::scenario::load_bench;
    use crate::sensing::{FilterParameters, SensingParameters};

    #[test]
    fn a_run_that_stopped_early_is_drawn_without_the_commands_that_never_came() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/paper_step.toml");
        let mut scenario = load_bench(&path).unwrap();
        let all = scenario.clone();
        scenario.duration = 0.01;
        let (recording, _) = Rig::new(scenario).unwrap().run(&mut |_| ()).unwrap();
        assert!(!figures(&all, &recording).unwrap().contains("set 1.8 bar"));
    }

    fn drawn(sensing: &SensingParameters) -> String {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/paper_step.toml");
        let mut scenario = load_bench(&path).unwrap();
        scenario.sensing = *sensing;
        scenario.duration = 1.5;
        let (recording, stop) = Rig::new(scenario.clone())
            .unwrap()
            .run(&mut |_| ())
            .unwrap();
        assert_eq!(stop, None);
        figures(&scenario, &recording).unwrap()
    }

    #[test]
    fn readings_are_drawn_where_they_are_not_the_truth() {
        let has = |svg: &str, texts: [&str; 4]| texts.map(|text| svg.contains(text));
        let texts = [", read", "filtered", "(delay ", "set 1.8 bar"];
        let ideal = drawn(&SensingParameters::ideal());
        assert_eq!(has(&ideal, texts), [false, false, false, true]);
        let paper = SensingParameters::paper();
        assert_eq!(has(&drawn(&paper), texts), [true, false, false, true]);
        let treated = SensingParameters {
            force_filter: FilterParameters::FirstOrder {
                time_constant: 0.05,
            },
            ..paper
        };
        assert_eq!(has(&drawn(&treated), texts), [true, true, true, true]);
    }
}

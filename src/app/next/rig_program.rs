//! A rig as a program: it is called as `PROGRAM IN.csv OUT.csv`, carries the inputs out and writes its recording.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use super::super::error::AppError;
use super::error::NextError;
use super::files::InputColumn;
use crate::case::read_rig;
use crate::diagnosis::recordings::recorded::{COLUMNS as MEASURED, hold, recorded_of};
use crate::plant::DeviceParts;
use crate::recording::Recording;
use crate::recording::csv::{CellRecording, read_cell_csv};
use crate::replay::LoadedCell;

/// Between two looks at whether it is done.
const LOOK: Duration = Duration::from_millis(20);
/// By how much its clock may differ: an offset [s], and a share of the time [1].
const CLOCK: [f64; 2] = [0.05, 0.01];
/// Share of the samples that may hold other inputs: those about a change [1].
const STRAY: f64 = 0.02;
/// Letters of its messages that are repeated.
const MOST_SAID: usize = 300;

/// What it did.
pub(super) enum Reply {
    /// A recording stands in the file.
    Recorded,
    /// It refuses these inputs; what it said.
    Refuses(String),
    /// The same inputs are to be tried again.
    Again,
}

/// A rig's program.
pub(super) struct RigProgram {
    pub program: PathBuf,
    pub patience: Duration,
}

impl RigProgram {
    fn name(&self) -> String {
        self.program.display().to_string()
    }

    /// Carries inputs out; `asked` are their columns.
    pub(super) fn call(
        &self,
        (inputs, asked): (&Path, &[InputColumn]),
        recording: &Path,
    ) -> Result<Reply, NextError> {
        let errors = recording.with_extension("stderr.txt");
        let cannot = |cause: std::io::Error| NextError::NoProgram {
            program: self.name(),
            cause: cause.to_string(),
        };
        let to = std::fs::File::create(&errors).map_err(cannot)?;
        let mut child = Command::new(&self.program)
            .args([inputs, recording])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(to)
            .spawn()
            .map_err(cannot)?;
        let start = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().map_err(cannot)? {
                break status;
            }
            if start.elapsed() > self.patience {
                // It may be gone by now.
                let _ = child.kill();
                let _ = child.wait();
                return Err(NextError::TooLong {
                    program: self.name(),
                    seconds: self.patience.as_secs_f64(),
                });
            }
            std::thread::sleep(LOOK);
        };
        self.reply(status, (&errors, asked), recording)
    }

    fn reply(
        &self,
        status: ExitStatus,
        (errors, asked): (&Path, &[InputColumn]),
        recording: &Path,
    ) -> Result<Reply, NextError> {
        let text = crate::file::read(errors).unwrap_or_default();
        let text = String::from_utf8_lossy(&text);
        let line = text.lines().rev().find(|line| !line.trim().is_empty());
        let said = line.map_or_else(String::new, |line| {
            let short: String = line.chars().take(MOST_SAID).collect();
            format!(": {short:?}")
        });
        match status.code() {
            Some(0) if recording.is_file() => Ok(Reply::Recorded),
            Some(0) => Err(NextError::Nothing {
                program: self.name(),
                file: recording.display().to_string(),
                columns: ["time_s"]
                    .into_iter()
                    .chain(asked.iter().map(|own| own.name.as_str()))
                    .chain(MEASURED)
                    .collect::<Vec<_>>()
                    .join(", "),
            }),
            Some(3) => Ok(Reply::Refuses(said)),
            Some(4) => Ok(Reply::Again),
            code => Err(NextError::Failed {
                program: self.name(),
                code: code.map_or_else(|| status.to_string(), |code| code.to_string()),
                said,
            }),
        }
    }

    /// Refuses it after so many experiments.
    pub(super) fn refused(&self, tries: usize, said: String) -> NextError {
        NextError::Refused {
            program: self.name(),
            tries,
            said,
        }
    }
}

/// What a recording says of the inputs that it was made with: its times [s], and the columns in the order of those that were asked for.
pub(super) struct Returned {
    time: Vec<f64>,
    columns: Vec<Vec<f64>>,
}

impl Returned {
    /// Reads the recording of a bench.
    pub(super) fn of_bench(file: &Path) -> Result<Self, AppError> {
        Self::of_recording(file, &read_rig(DeviceParts::Whole, file)?)
    }

    fn of_recording(file: &Path, recording: &Recording) -> Result<Self, AppError> {
        let name = file.display().to_string();
        let inputs = recorded_of(DeviceParts::Whole, &name, recording)?.inputs;
        let valve = super::files::valve(&inputs.extends);
        Ok(Self {
            columns: vec![inputs.set_pressure, valve, inputs.surface],
            time: inputs.time,
        })
    }

    /// Reads the recording of a cell.
    pub(super) fn of_cell(file: &Path, cell: &LoadedCell) -> Result<Self, AppError> {
        let read = read_cell_csv(file, cell.joints.len());
        let CellRecording {
            time,
            path,
            commands,
            mut set_pressure,
            ..
        } = read?;
        hold(&mut set_pressure);
        let columns = [path].into_iter().chain(commands).chain([set_pressure]);
        Ok(Self {
            columns: columns.collect(),
            time,
        })
    }
}

/// Checks that a recording was made with the inputs that were asked for at times [s], as values that are held between samples. Its clock is its own: it may differ by an
/// offset and a rate, which are for the diagnosis to find.
pub(super) fn check_inputs(
    file: &Path,
    found: &Returned,
    (times, asked): (&[f64], &[InputColumn]),
) -> Result<(), NextError> {
    let begin = found.time.first().copied().unwrap_or_default();
    let last = times.len() - 1;
    let index = |time: f64| {
        let after = times.partition_point(|t| *t <= time);
        after.saturating_sub(1).min(last)
    };
    for (column, values) in asked.iter().zip(&found.columns) {
        let asked_values = &column.values;
        let slack = (0.01 * range(asked_values)).max(column.slack);
        let other = |(place, value): &(usize, &f64)| {
            let time = found.time[*place] - begin;
            let reach = CLOCK[0] + CLOCK[1] * time;
            let near = &asked_values[index(time - reach)..=index(time + reach)];
            let fits = |asked: &f64| match (asked.is_finite(), value.is_finite()) {
                (true, true) => (asked - **value).abs() <= slack,
                (asked, found) => asked == found,
            };
            // Between two samples of what was asked for a surface stands in between.
            let [low, high] = near
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| {
                    [l.min(*v), h.max(*v)]
                });
            !(near.iter().any(fits) || (low - slack..=high + slack).contains(*value))
        };
        let strays: Vec<(usize, &f64)> = values.iter().enumerate().filter(other).collect();
        if strays.len() as f64 > STRAY * values.len() as f64 {
            let (place, value) = strays[0];
            let time = found.time[place];
            return Err(NextError::OtherInputs {
                file: file.display().to_string(),
                time,
                column: column.name.clone(),
                found: shown(*value),
                asked: shown(asked_values[index(time - begin)]),
            });
        }
    }
    Ok(())
}

/// Range of values; of those that are all the same, their size.
fn range(values: &[f64]) -> f64 {
    let finite = values.iter().copied().filter(|v| v.is_finite());
    let [low, high] = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| {
        [l.min(v), h.max(v)]
    });
    if high > low { high - low } else { high.abs() }
}

fn shown(value: f64) -> String {
    match value.is_finite() {
        true => format!("{value:.5}"),
        false => "empty".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::{InitialState, PlantInputs};
    use crate::recording::{RecordedChannel, Unit, schema};

    /// Stairs, a reversal and a surface that moves, as they were asked for.
    fn asked() -> PlantInputs {
        let time: Vec<f64> = (0..1000).map(|i| 0.004 * f64::from(i)).collect();
        PlantInputs {
            set_pressure: time
                .iter()
                .map(|t| 1e5 * (1.0 + (2.0 * t).floor() % 3.0))
                .collect(),
            extends: time.iter().map(|t| !(1.5..2.0).contains(t)).collect(),
            surface: time
                .iter()
                .map(|t| 0.02 + 0.005 * (6.0 * t).sin())
                .collect(),
            cell: None,
            motion: None,
            initial: InitialState::AtRest,
            place: 0,
            time,
        }
    }

    /// The same with the clock of the rig: times that go by another rate, from another start, every so many samples; pressures changed.
    fn recorded([rate, start]: [f64; 2], every: usize, factor: f64) -> Recording {
        let inputs = asked();
        let kept = || (0..inputs.time.len()).step_by(every);
        let channel = |quantity: &str, unit, of: &dyn Fn(usize) -> f64| {
            RecordedChannel::new(quantity, unit, kept().map(of).collect())
        };
        let time = kept().map(|i| start + rate * inputs.time[i]).collect();
        let channels = vec![
            channel(schema::SET_PRESSURE_GAUGE, Unit::Pascal, &|i| {
                factor * inputs.set_pressure[i]
            }),
            channel(schema::VALVE_EXTENDS, Unit::One, &|i| {
                f64::from(u8::from(inputs.extends[i]))
            }),
            channel(schema::SURFACE_POSITION, Unit::Metre, &|i| {
                inputs.surface[i]
            }),
            channel(schema::MEASURED_STROKE, Unit::Metre, &|_| 0.01),
        ];
        Recording::new(time, channels, Vec::new()).unwrap()
    }

    fn checked(recording: &Recording) -> Result<(), String> {
        let file = Path::new("out.csv");
        let PlantInputs {
            time,
            set_pressure,
            extends,
            surface,
            ..
        } = asked();
        let column = |name: &str, values, slack| InputColumn {
            name: name.to_owned(),
            values,
            slack,
        };
        let columns = [
            column("set_pressure_pa", set_pressure, 100.0),
            column("solenoid", super::super::files::valve(&extends), 0.01),
            column("surface_m", surface, 2e-4),
        ];
        let returned = Returned::of_recording(file, recording).unwrap();
        let checked = check_inputs(file, &returned, (&time, &columns));
        checked.map_err(|error| error.to_string())
    }

    #[test]
    fn a_rig_has_its_own_clock_and_its_own_rate() {
        for (clock, every) in [
            ([1.0, 0.0], 1),
            ([1.008, 0.0], 1),
            ([0.995, 1_200.0], 1),
            ([1.0, 0.0], 5),
        ] {
            assert_eq!(
                checked(&recorded(clock, every, 1.0)),
                Ok(()),
                "{clock:?} {every}"
            );
        }
    }

    #[test]
    fn other_inputs_than_asked_are_refused_with_the_first_place() {
        let error = checked(&recorded([1.0, 0.0], 1, 1.05)).unwrap_err();
        assert!(
            error.contains("set_pressure_pa") && error.contains("105000"),
            "{error}"
        );
        let error = checked(&recorded([1.2, 0.0], 1, 1.0)).unwrap_err();
        assert!(error.contains("as it was asked for"), "{error}");
    }
}

//! From a recording of a rig to what drove it and what was measured of it.

use crate::diagnosis::flange::Run;
use crate::plant::{
    CHANNELS, Channel, DeviceParts, InitialState, InputError, MeasuredMotion, PlantInputs,
};
use crate::quantity::counted;
use crate::recording::gaps::{Gap, longest_gap, longest_pause};
use crate::recording::{Recording, RecordingError, schema};
use crate::stats::median;
use std::sync::Arc;

/// Quantities of the channels in a recording, in the order of [`CHANNELS`].
pub const QUANTITIES: [&str; CHANNELS.len()] = [
    schema::MEASURED_REGULATOR_PRESSURE_GAUGE,
    schema::MEASURED_STROKE,
    schema::MEASURED_FORCE,
    schema::MEASURED_ACCELERATION,
];
/// Columns of the channels in a file, in the order of [`CHANNELS`].
pub const COLUMNS: [&str; CHANNELS.len()] = [
    "regulator_pressure_pa",
    "stroke_m",
    "force_n",
    "acceleration_m_per_s2",
];

/// Samples below which a recording carries no information on a rig.
pub const LEAST_SAMPLES: usize = 50;
/// Times that a sensor's noise may be smaller or larger than its sheet says; units differ by more.
const UNIT_FACTOR: f64 = 200.0;
/// Samples that a workpiece cannot be gone for: a surface lost for less is filled in.
const SURFACE_GAP: usize = 5;

/// A recording taken apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// Inputs of the rig.
    pub inputs: PlantInputs,
    /// Readings in the order of [`CHANNELS`]; NaN where there is none, all of them for a channel that was not measured.
    pub readings: [Vec<f64>; CHANNELS.len()],
    /// Lost values of the inputs that were filled in.
    pub filled: usize,
}

/// A recording that cannot be diagnosed from.
#[derive(Debug, thiserror::Error)]
pub enum RecordedError {
    /// An input is absent.
    #[error("{file}: {source}")]
    Missing {
        /// File name.
        file: String,
        /// Which.
        source: Box<RecordingError>,
    },
    /// Inputs that do not fit together.
    #[error("{file}: {source}")]
    Inputs {
        /// File name.
        file: String,
        /// The misfit.
        source: InputError,
    },
    /// A time of which nothing was recorded.
    #[error("{file}: nothing is recorded from {:.3} to {:.3} s, and what the device did in those {:.0} s is not known; expected no gap longer than {pause:.1} s: \
        {}",
        gap.from, gap.to, gap.to - gap.from, remedy(gap))]
    Gap {
        /// File name.
        file: String,
        /// The gap.
        gap: Gap,
        /// Longest pause that is none [s].
        pause: f64,
    },
    /// Too short.
    #[error("{file}: {found} samples are too few to tell anything, expected at least {expected}")]
    TooShort {
        /// File name.
        file: String,
        /// Their number.
        found: usize,
        /// Number that there must be.
        expected: usize,
    },
    /// No measured column.
    #[error("{file}: no column was measured, expected at least one of {}", COLUMNS.join(", "))]
    NothingMeasured {
        /// File name.
        file: String,
    },
    /// Noise that is out of all proportion.
    #[error(
        "{file}: the noise of column `{column}` is {found:.3e}, expected about the {expected} of [sensors]; are both in SI? If they are, the sheet's is in doubt: `{column} = {found:.1e}` would do"
    )]
    Noise {
        /// File name.
        file: String,
        /// The column.
        column: &'static str,
        /// Standard deviation in the recording [SI].
        found: f64,
        /// That of the rig file [SI].
        expected: f64,
    },
}

/// What to do about a gap: what stands on either side is a recording, if it is more than a sample.
fn remedy(gap: &Gap) -> String {
    let [before, after] = [gap.before, gap.after].map(|count| counted(count, "sample"));
    match (gap.before, gap.after) {
        (1, _) => format!("leave out the {before} before it"),
        (_, 1) => format!("leave out the {after} after it"),
        _ => format!(
            "put the {before} before it and the {after} after it into a file each (`idc import --split` does so with a log)"
        ),
    }
}

/// Values of a channel that must be there.
fn values_of(file: &str, recording: &Recording, quantity: &str) -> Result<Vec<f64>, RecordedError> {
    let values = recording.values(quantity).map(<[f64]>::to_vec);
    values.map_err(|source| RecordedError::Missing {
        file: file.to_owned(),
        source: Box::new(source),
    })
}

/// Refuses inputs that cannot drive a rig.
///
/// # Errors
/// The first fault of the inputs.
pub fn check(file: &str, inputs: &PlantInputs) -> Result<(), RecordedError> {
    inputs.check().map_err(|source| RecordedError::Inputs {
        file: file.to_owned(),
        source,
    })?;
    check_gaps(file, &inputs.time)
}

/// Refuses a recording with a gap in it: a simulation would go through it, an hour for an hour, and know nothing of what happened there.
fn check_gaps(file: &str, time: &[f64]) -> Result<(), RecordedError> {
    match longest_gap(time) {
        None => Ok(()),
        Some(gap) => Err(RecordedError::Gap {
            file: file.to_owned(),
            gap,
            pause: longest_pause(time),
        }),
    }
}

/// Takes a recording apart. Commands that were lost are held, a surface that is lost for a moment is filled in.
///
/// # Errors
/// An input is absent.
pub fn recorded(file: &str, recording: &Recording) -> Result<Recorded, RecordedError> {
    let values = |quantity: &str| values_of(file, recording, quantity);
    let mut set_pressure = values(schema::SET_PRESSURE_GAUGE)?;
    let mut valve = values(schema::VALVE_EXTENDS)?;
    let mut surface = values(schema::SURFACE_POSITION)?;
    let filled =
        hold(&mut set_pressure) + hold(&mut valve) + bridge(recording.time(), &mut surface);
    let mut inputs = PlantInputs {
        time: recording.time().to_vec(),
        set_pressure,
        extends: valve.iter().map(|position| *position > 0.5).collect(),
        surface,
        cell: None,
        motion: None,
        initial: InitialState::AtRest,
        place: 0,
    };
    check(file, &inputs)?;
    let nothing = || vec![f64::NAN; recording.sample_count()];
    let readings = QUANTITIES.map(|quantity| {
        recording
            .channel(quantity)
            .map_or_else(nothing, |channel| channel.values.clone())
    });
    let [pressure, stroke] =
        [Channel::RegulatorPressure, Channel::Stroke].map(|channel| &readings[channel as usize]);
    inputs.initial = InitialState::of(&inputs.time, pressure, stroke);
    Ok(Recorded {
        inputs,
        readings,
        filled,
    })
}

/// Takes a recording of a rig apart that has so much of the device.
///
/// # Errors
/// An input or a reading of that part is absent.
pub fn recorded_of(
    parts: DeviceParts,
    file: &str,
    recording: &Recording,
) -> Result<Recorded, RecordedError> {
    let Some(output) = parts.output() else {
        return recorded(file, recording);
    };
    let values = |quantity: &str| values_of(file, recording, quantity);
    let time = recording.time().to_vec();
    let count = time.len();
    let mut readings: [Vec<f64>; CHANNELS.len()] = std::array::from_fn(|_| vec![f64::NAN; count]);
    let measured = values(QUANTITIES[output as usize])?;
    let mut set_pressure = match parts {
        DeviceParts::MovedPiston => values(schema::MEASURED_REGULATOR_PRESSURE_GAUGE)?,
        DeviceParts::Regulator => values(schema::SET_PRESSURE_GAUGE)?,
        DeviceParts::ContactFlange => values(schema::DESIRED_FORCE)?,
        DeviceParts::ClosedChamber => vec![first_level(&time, &measured); count],
        DeviceParts::Whole | DeviceParts::DrivenSlide => vec![0.0; count],
    };
    let filled = hold(&mut set_pressure);
    readings[output as usize] = measured;
    let mut inputs = PlantInputs {
        set_pressure,
        extends: vec![true; count],
        surface: vec![f64::NAN; count],
        time,
        cell: None,
        motion: None,
        initial: InitialState::AtRest,
        place: 0,
    };
    check(file, &inputs)?;
    if parts.takes_motion() {
        let stroke = values(schema::MEASURED_STROKE)?;
        let mut motion = MeasuredMotion::of(&inputs.time, &stroke);
        for index in motion.bridged(&inputs.time) {
            readings[output as usize][index] = f64::NAN;
        }
        inputs.motion = Some(Arc::new(motion));
    }
    Ok(Recorded {
        inputs,
        readings,
        filled,
    })
}

/// Takes a run of a contact flange apart: force, desired force and the arm's speed.
///
/// # Errors
/// One of them is absent.
pub fn run_of(file: &str, name: &str, recording: &Recording) -> Result<Run, RecordedError> {
    check_gaps(file, recording.time())?;
    let values = |quantity: &str| {
        let mut values = values_of(file, recording, quantity)?;
        hold(&mut values);
        // What was lost before the first value is as that.
        let first = values.iter().copied().find(|value| value.is_finite());
        for value in values.iter_mut().filter(|value| value.is_nan()) {
            *value = first.unwrap_or(0.0);
        }
        Ok(values)
    };
    let speed = values(schema::TOOL_SPEED)?;
    let commanded = match recording.values(schema::COMMANDED_TOOL_SPEED) {
        Ok(_) => values(schema::COMMANDED_TOOL_SPEED)?,
        Err(_) => speed.clone(),
    };
    Ok(Run {
        name: name.to_owned(),
        force: values(schema::MEASURED_FORCE)?,
        desired: values(schema::DESIRED_FORCE)?,
        speed,
        commanded,
        force_ramp: None,
        time: recording.time().to_vec(),
    })
}

/// The median of the readings in the first second, or of the first few.
fn first_level(time: &[f64], readings: &[f64]) -> f64 {
    const FEW: usize = 5;
    let within = time.partition_point(|t| t - time[0] <= 1.0).max(FEW);
    let first = readings.iter().copied().take(within);
    median(first.filter(|p| p.is_finite())).unwrap_or(0.0)
}

impl Recorded {
    /// Leaves out the readings of channels that the rig file has no sensor of: what they are worth is not known.
    #[must_use]
    pub fn of_sensors(mut self, sensors: [bool; CHANNELS.len()]) -> Self {
        for (readings, is_there) in self.readings.iter_mut().zip(sensors) {
            if !is_there {
                readings.fill(f64::NAN);
            }
        }
        self
    }

    /// Checks that a rig can be diagnosed from it; `noise` is what the recording shows of each channel, `sheet` what the rig file says [SI].
    ///
    /// # Errors
    /// Too short, nothing measured, units that do not fit the rig file.
    pub fn check(
        &self,
        file: &str,
        noise: &[Option<f64>],
        sheet: &[f64; CHANNELS.len()],
    ) -> Result<(), RecordedError> {
        let file = file.to_owned();
        let found = self.inputs.time.len();
        if found < LEAST_SAMPLES {
            return Err(RecordedError::TooShort {
                file,
                found,
                expected: LEAST_SAMPLES,
            });
        }
        if self.readings.iter().flatten().all(|value| value.is_nan()) {
            return Err(RecordedError::NothingMeasured { file });
        }
        for (channel, column) in COLUMNS.into_iter().enumerate() {
            let expected = sheet[channel];
            // A column without any noise stands still, or was made by a computer.
            if let Some(found) = noise[channel].filter(|noise| *noise > 0.0)
                && !(1.0 / UNIT_FACTOR..UNIT_FACTOR).contains(&(found / expected))
            {
                return Err(RecordedError::Noise {
                    file,
                    column,
                    found,
                    expected,
                });
            }
        }
        Ok(())
    }
}

/// Puts the value before it in place of each lost one, and counts them.
pub fn hold(values: &mut [f64]) -> usize {
    let mut filled = 0;
    for index in 1..values.len() {
        if values[index].is_nan() {
            values[index] = values[index - 1];
            filled += 1;
        }
    }
    filled
}

/// Fills short gaps between values with the cubic through the two on either side, and counts the values filled in.
fn bridge(time: &[f64], values: &mut [f64]) -> usize {
    let mut filled = 0;
    let mut from = 0;
    while let Some(start) = (from..values.len()).find(|i| values[*i].is_nan()) {
        let end = (start..values.len()).find(|i| !values[*i].is_nan());
        let end = end.unwrap_or(values.len());
        from = end;
        let nodes: Vec<usize> = [
            start.checked_sub(2),
            start.checked_sub(1),
            Some(end),
            Some(end + 1),
        ]
        .into_iter()
        .flatten()
        .filter(|node| values.get(*node).is_some_and(|value| value.is_finite()))
        .collect();
        let enclosed = start > 0 && end < values.len();
        if !enclosed || end - start >= SURFACE_GAP {
            continue;
        }
        for index in start..end {
            let weights = super::clean::lagrange(time, &nodes, time[index]);
            values[index] = nodes
                .iter()
                .zip(weights)
                .map(|(node, w)| w * values[*node])
                .sum();
            filled += 1;
        }
    }
    filled
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{RecordedChannel, Unit};

    fn recording(count: usize) -> Recording {
        let time: Vec<f64> = (0..count).map(|i| 0.004 * i as f64).collect();
        let surface = time.iter().map(|t| 0.02 + 0.1 * t * t).collect();
        let channels = vec![
            RecordedChannel::new(schema::SET_PRESSURE_GAUGE, Unit::Pascal, vec![2e5; count]),
            RecordedChannel::new(schema::VALVE_EXTENDS, Unit::One, vec![1.0; count]),
            RecordedChannel::new(schema::SURFACE_POSITION, Unit::Metre, surface),
            RecordedChannel::new(schema::MEASURED_FORCE, Unit::Newton, vec![3.0; count]),
        ];
        Recording::new(time, channels, vec![]).unwrap()
    }

    fn with(quantity: &str, change: impl Fn(&mut [f64])) -> Recording {
        let whole = recording(60);
        let mut channels = whole.channels().to_vec();
        let channel = channels
            .iter_mut()
            .find(|c| c.quantity == quantity)
            .unwrap();
        change(&mut channel.values);
        Recording::new(whole.time().to_vec(), channels, vec![]).unwrap()
    }

    #[test]
    fn channels_go_where_they_belong_and_absent_ones_have_no_values() {
        let taken = recorded("ride.csv", &recording(60)).unwrap();
        assert_eq!(taken.filled, 0);
        assert!(taken.inputs.extends.iter().all(|extends| *extends));
        assert_eq!(taken.readings[2], [3.0; 60]);
        for channel in [0, 1, 3] {
            assert!(taken.readings[channel].iter().all(|value| value.is_nan()));
        }
    }

    #[test]
    fn lost_commands_are_held_and_a_short_gap_of_the_surface_is_filled_a_long_one_is_not() {
        let lost = with(schema::SET_PRESSURE_GAUGE, |v| {
            v[10] = f64::NAN;
            v[9] = 1e5;
        });
        let taken = recorded("ride.csv", &lost).unwrap();
        assert_eq!((taken.filled, taken.inputs.set_pressure[10]), (1, 1e5));
        let gone = with(schema::SURFACE_POSITION, |v| v[20..23].fill(f64::NAN));
        let taken = recorded("ride.csv", &gone).unwrap();
        assert_eq!(taken.filled, 3);
        let exact = 0.02 + 0.1 * (0.004f64 * 21.0).powi(2);
        assert!((taken.inputs.surface[21] - exact).abs() < 1e-12);
        let no_part = with(schema::SURFACE_POSITION, |v| v[20..25].fill(f64::NAN));
        let taken = recorded("ride.csv", &no_part).unwrap();
        assert!(taken.filled == 0 && taken.inputs.surface[22].is_nan());
        let at_end = with(schema::SURFACE_POSITION, |v| v[57..].fill(f64::NAN));
        assert_eq!(recorded("ride.csv", &at_end).unwrap().filled, 0);
    }

    #[test]
    fn what_tells_nothing_is_refused() {
        let sheet = [400.0, 2e-5, 0.8, 0.15];
        let none = [None; 4];
        let taken = |recording: &Recording| recorded("ride.csv", recording).unwrap();
        assert!(
            taken(&recording(60))
                .check("ride.csv", &none, &sheet)
                .is_ok()
        );
        let says = |recorded: &Recorded, noise: [Option<f64>; 4]| {
            let refused = recorded.check("ride.csv", &noise, &sheet);
            refused.unwrap_err().to_string()
        };
        assert_eq!(
            says(&taken(&recording(20)), none),
            "ride.csv: 20 samples are too few to tell anything, expected at least 50"
        );
        let in_kilonewton = [None, None, Some(8e-4), None];
        assert!(says(&taken(&recording(60)), in_kilonewton).contains("`force_n` is 8.000e-4"));
        let empty = with(schema::MEASURED_FORCE, |v| v.fill(f64::NAN));
        assert!(says(&taken(&empty), none).contains("no column was measured"));
    }
}

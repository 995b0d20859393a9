//! The samples of a run of a cell as a recording of a cell, as a real one would have made it: what was commanded and what the sensors read, at the
//! instants at which they read it.

use super::csv::CellRecording;
use super::schema::{self, JointSignal, joint_quantity};
use super::{Recording, RecordingError};

/// Share of a sample period by which a tie is decided for the earlier row, as the sensors' clock has it.
const TIE: f64 = 1e-6;

/// Reads a recording from a Parquet table.
///
/// # Errors
/// Those of the file; any file where the library is built without the feature `parquet`.
pub fn read_table(path: &std::path::Path) -> Result<Recording, RecordingError> {
    #[cfg(feature = "parquet")]
    return Ok(super::parquet::read_parquet(path)?.recording);
    #[cfg(not(feature = "parquet"))]
    return Err(RecordingError::WithoutParquet {
        file: path.display().to_string(),
    });
}

/// Takes from the samples of a run what was commanded and read, `rate` times a second [Hz] if that is less often than there are rows. Pressures become
/// those against an atmosphere [Pa].
///
/// # Errors
/// A signal is missing.
pub fn cell_recording(
    samples: &Recording,
    joints: usize,
    rate: f64,
    atmosphere: f64,
) -> Result<CellRecording, RecordingError> {
    let rows = rows(samples.time(), rate);
    let picked = |quantity: &str| -> Result<Vec<f64>, RecordingError> {
        let values = samples.values(quantity)?;
        Ok(rows.iter().map(|row| values[*row]).collect())
    };
    let gauge = |mut values: Vec<f64>| {
        for value in &mut values {
            *value -= atmosphere;
        }
        values
    };
    let joint = |joint: usize, signal| picked(&joint_quantity(joint + 1, signal));
    // A row says what was set in the step that ended with it: the mean of those up to the next row taken is held from a row on.
    let set = samples.values(schema::SET_PRESSURE)?;
    let held = (0..rows.len()).map(|k| {
        let until = rows.get(k + 1).copied().unwrap_or(rows[k]);
        let span = &set[(rows[k] + 1).min(until)..=until];
        span.iter().sum::<f64>() / span.len() as f64
    });
    Ok(CellRecording {
        time: picked_times(samples.time(), &rows),
        path: picked(schema::PATH_LENGTH)?,
        commands: (0..joints)
            .map(|j| joint(j, JointSignal::Reference))
            .collect::<Result<_, _>>()?,
        encoders: (0..joints)
            .map(|j| joint(j, JointSignal::Encoder).map(Some))
            .collect::<Result<_, _>>()?,
        torques: (0..joints)
            .map(|j| joint(j, JointSignal::Torque).map(Some))
            .collect::<Result<_, _>>()?,
        set_pressure: gauge(held.collect()),
        readings: vec![
            (
                schema::MEASURED_REGULATOR_PRESSURE_GAUGE,
                gauge(picked(schema::MEASURED_REGULATOR_PRESSURE)?),
            ),
            (schema::MEASURED_STROKE, picked(schema::MEASURED_STROKE)?),
            (schema::MEASURED_FORCE, picked(schema::MEASURED_FORCE)?),
        ],
        repeated: Vec::new(),
        ignored: Vec::new(),
    })
}

fn picked_times(time: &[f64], rows: &[usize]) -> Vec<f64> {
    rows.iter().map(|row| time[*row]).collect()
}

/// Rows at which sensors that are read f times a second [Hz] were read: the nearest to each k/f.
#[must_use]
pub fn rows(time: &[f64], rate: f64) -> Vec<usize> {
    if rate.is_infinite() {
        return (0..time.len()).collect();
    }
    let mut last = f64::NEG_INFINITY;
    let taken = |row: &usize| {
        let half_step = match row {
            0 => 0.0,
            row => 0.5 * (time[*row] - time[row - 1]),
        };
        let number = ((time[*row] + half_step) * rate + TIE).floor();
        let first = number > last;
        last = last.max(number);
        first
    };
    (0..time.len()).filter(taken).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{RecordedChannel, Unit};

    #[test]
    fn rows_are_those_read_and_what_was_set_after_them_is_held_from_them_on() {
        let time: Vec<f64> = (1..=9).map(|i| f64::from(i) * 1e-3).collect();
        let ramp = |slope: f64| -> Vec<f64> { (1..=9).map(|i| slope * f64::from(i)).collect() };
        let mut channels = vec![
            RecordedChannel::new(schema::PATH_LENGTH, Unit::Metre, ramp(1e-3)),
            RecordedChannel::new(schema::SET_PRESSURE, Unit::Pascal, ramp(1e4)),
            RecordedChannel::new(schema::MEASURED_REGULATOR_PRESSURE, Unit::Pascal, ramp(2e4)),
            RecordedChannel::new(schema::MEASURED_STROKE, Unit::Metre, ramp(0.0)),
            RecordedChannel::new(schema::MEASURED_FORCE, Unit::Newton, ramp(3.0)),
        ];
        for signal in [
            JointSignal::Reference,
            JointSignal::Encoder,
            JointSignal::Torque,
        ] {
            let name = joint_quantity(1, signal);
            channels.push(RecordedChannel::new(name, signal.unit(), ramp(0.1)));
        }
        let samples = Recording::new(time, channels, vec![]).unwrap();
        let taken = cell_recording(&samples, 1, 250.0, 1e4).unwrap();
        assert_eq!(taken.time, [1e-3, 4e-3, 8e-3]);
        assert_eq!(taken.set_pressure, [2e4, 5.5e4, 7e4]);
        assert_eq!(taken.readings[2].1, [3.0, 12.0, 24.0]);
        assert_eq!(taken.readings[0].1[1], 7e4);
        assert!((taken.encoders[0].as_ref().unwrap()[2] - 0.8).abs() < 1e-12);
        let all = cell_recording(&samples, 1, f64::INFINITY, 0.0).unwrap();
        assert_eq!((all.time.len(), all.set_pressure[8]), (9, 9e4));
    }
}

//! The two axes along which a recording can be watched: simulated time and path length.

use ::rerun::log::TimeColumn;

use crate::recording::{Recording, schema};

/// Simulated time.
pub(super) const SIM_TIME: &str = "sim_time";
/// Path length in micrometres; Rerun's timelines are whole numbers.
pub(super) const PATH_LENGTH: &str = "path_length_um";

const MICROMETRES_PER_METRE: f64 = 1e6;

/// Time [s] and, if known, path length [m] of the samples.
pub(super) struct Axes<'a> {
    time: &'a [f64],
    path_length: Option<Vec<f64>>,
}

impl<'a> Axes<'a> {
    /// The axes of a recording's samples.
    pub(super) fn of(recording: &'a Recording) -> Self {
        let path_length = recording.channel(schema::PATH_LENGTH);
        Self {
            time: recording.time(),
            path_length: path_length.map(|channel| hold_last(&channel.values)),
        }
    }

    /// The axes of a scene's frames.
    pub(super) fn of_frames(time: &'a [f64], path_length: &[f64]) -> Self {
        Self {
            time,
            path_length: Some(hold_last(path_length)),
        }
    }

    /// Time columns of the samples of these indices.
    pub(super) fn columns(&self, indices: &[usize]) -> Vec<TimeColumn> {
        let seconds = indices.iter().map(|&i| self.time[i]);
        let mut columns = vec![TimeColumn::new_duration_secs(SIM_TIME, seconds)];
        if let Some(length) = &self.path_length {
            let micrometres = indices
                .iter()
                .map(|&i| (length[i] * MICROMETRES_PER_METRE).round() as i64);
            columns.push(TimeColumn::new_sequence(PATH_LENGTH, micrometres));
        }
        columns
    }

    /// Time columns of all samples.
    pub(super) fn all_columns(&self) -> Vec<TimeColumn> {
        let all: Vec<usize> = (0..self.time.len()).collect();
        self.columns(&all)
    }
}

/// Values with each NaN replaced by the value before it; zero before the first.
fn hold_last(values: &[f64]) -> Vec<f64> {
    let mut last = 0.0;
    let hold = |&value: &f64| {
        if !value.is_nan() {
            last = value;
        }
        last
    };
    values.iter().map(hold).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{Channel, Unit};

    #[test]
    fn time_is_in_nanoseconds_and_path_length_in_micrometres() {
        let length = Channel::new(
            schema::PATH_LENGTH,
            Unit::Metre,
            vec![f64::NAN, 0.0, 0.012_345_6, f64::NAN],
        );
        let time = vec![0.0, 0.001, 0.002, 1.5];
        let recording = Recording::new(time, vec![length], vec![]).unwrap();
        let columns = Axes::of(&recording).all_columns();
        assert_eq!(
            columns[0].times_raw(),
            [0, 1_000_000, 2_000_000, 1_500_000_000]
        );
        assert_eq!(columns[1].times_raw(), [0, 0, 12_346, 12_346]);
    }

    #[test]
    fn without_path_length_there_is_time_alone() {
        let recording = Recording::new(vec![0.0], vec![], vec![]).unwrap();
        assert_eq!(Axes::of(&recording).all_columns().len(), 1);
    }
}

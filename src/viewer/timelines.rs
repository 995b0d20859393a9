//! The two axes along which a recording can be watched: simulated time and path length.

use std::ops::Range;

use ::rerun::log::TimeColumn;

use crate::recording::{Recording, schema};
use crate::scene::Scene;

/// Simulated time.
pub(super) const SIM_TIME: &str = "sim_time";
/// Path length in micrometres; Rerun's timelines are whole numbers.
pub(super) const PATH_LENGTH: &str = "path_length_um";

const MICROMETRES_PER_METRE: f64 = 1e6;

/// Times [ns] and, if known, path lengths [µm] of the samples.
pub(super) struct Axes {
    whole: Vec<TimeColumn>,
}

impl Axes {
    /// The axes of a recording's samples. Where the first have no path length it is `path_before` [m], that of the sample before them.
    pub(super) fn of(recording: &Recording, path_before: f64) -> Self {
        let path_length = recording.channel(schema::PATH_LENGTH);
        Self::new(
            recording.time(),
            path_length.map(|channel| &channel.values[..]),
            path_before,
        )
    }

    /// The axes of a scene's frames, in the same way.
    pub(super) fn of_frames(scene: &Scene, path_before: f64) -> Self {
        let path_length = &scene.frame_path_lengths[..];
        Self::new(&scene.frame_times, Some(path_length), path_before)
    }

    fn new(time: &[f64], path_length: Option<&[f64]>, path_before: f64) -> Self {
        let mut whole = vec![TimeColumn::new_duration_secs(
            SIM_TIME,
            time.iter().copied(),
        )];
        if let Some(length) = path_length {
            let mut last = path_before;
            let micrometres = length.iter().map(|&length| {
                if !length.is_nan() {
                    last = length;
                }
                (last * MICROMETRES_PER_METRE).round() as i64
            });
            whole.push(TimeColumn::new_sequence(PATH_LENGTH, micrometres));
        }
        Self { whole }
    }

    /// Time columns of the samples of these indices.
    pub(super) fn columns(&self, indices: &[usize]) -> Vec<TimeColumn> {
        self.picked(|times| indices.iter().map(|&index| times[index]).collect())
    }

    /// Time columns of the samples in this range.
    pub(super) fn range(&self, range: Range<usize>) -> Vec<TimeColumn> {
        self.picked(|times| times[range.clone()].to_vec())
    }

    fn picked(&self, pick: impl Fn(&[i64]) -> Vec<i64>) -> Vec<TimeColumn> {
        let columns = self.whole.iter();
        let picked = columns.map(|column| {
            let times = pick(column.times_raw());
            TimeColumn::new(None, *column.timeline(), times.into())
        });
        picked.collect()
    }

    /// Time columns of all samples.
    pub(super) fn all_columns(&self) -> Vec<TimeColumn> {
        // The times themselves are shared.
        self.whole.clone()
    }

    /// Time columns of the first and the last sample.
    pub(super) fn ends(&self) -> Vec<TimeColumn> {
        let last = self.whole[0].times_raw().len().saturating_sub(1);
        self.columns(&[0, last])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{RecordedChannel, Unit};

    #[test]
    fn time_is_in_nanoseconds_and_path_length_in_micrometres() {
        let length = RecordedChannel::new(
            schema::PATH_LENGTH,
            Unit::Metre,
            vec![f64::NAN, 0.0, 0.012_345_6, f64::NAN],
        );
        let time = vec![0.0, 0.001, 0.002, 1.5];
        let recording = Recording::new(time, vec![length], vec![]).unwrap();
        let columns = Axes::of(&recording, 0.0).all_columns();
        assert_eq!(
            columns[0].times_raw(),
            [0, 1_000_000, 2_000_000, 1_500_000_000]
        );
        assert_eq!(columns[1].times_raw(), [0, 0, 12_346, 12_346]);
        let later = Axes::of(&recording, 0.5);
        assert_eq!(later.columns(&[0, 3])[1].times_raw(), [500_000, 12_346]);
        assert_eq!(later.ends()[0].times_raw(), [0, 1_500_000_000]);
    }

    #[test]
    fn without_path_length_there_is_time_alone() {
        let recording = Recording::new(vec![0.0], vec![], vec![]).unwrap();
        assert_eq!(Axes::of(&recording, 0.0).all_columns().len(), 1);
    }
}

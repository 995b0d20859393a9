//! Logs put together: one recording at the times of the first log, the others read off between their samples.

use std::path::{Path, PathBuf};

use super::clock::{self, Alignment};
use super::error::ImportError;
use super::log::{Series, read_log};
use super::map::{Clock, ImportMap};
use super::rows::Remark;
use crate::recording::{RecordedChannel, Recording};

/// A recording with the messages on its logs.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// The recording, at the first log's times.
    pub recording: Recording,
    /// Origin of its times, in seconds since 1970; 0 where it is the logs' own start [s].
    pub origin: f64,
    /// The logs, in the map's order.
    pub logs: Vec<LogNote>,
}

/// Notes on a log.
#[derive(Debug, Clone, PartialEq)]
pub struct LogNote {
    /// Its file.
    pub file: PathBuf,
    /// Data left out.
    pub remarks: Vec<Remark>,
    /// Rows of it that were used, and rows that are there.
    pub rows: [usize; 2],
    /// Where its clock was found against the first log's.
    pub alignment: Option<Alignment>,
    /// Quantities that came from it.
    pub quantities: Vec<String>,
    /// Its own series, its clock set right.
    pub series: Vec<Series>,
}

/// Reads the logs of a map, `files` in place of those that it names, and puts them together.
///
/// # Errors
/// Something that a log lacks, a clock that cannot be found, logs that do not overlap in time.
pub fn import(map: &ImportMap, files: &[PathBuf]) -> Result<Imported, ImportError> {
    let mut logs: Vec<LogNote> = Vec::new();
    let mut origin = 0.0;
    let mut given = files.iter();
    for (index, file_map) in map.files.iter().enumerate() {
        let before = logs.last().map(|log| &log.file);
        let file = match before {
            Some(before) if file_map.same_log => Some(before),
            _ => given.next().or(file_map.path.as_ref()),
        };
        let Some(file) = file.cloned() else {
            return Err(ImportError::NoFile {
                map: map.path.clone(),
                number: index + 1,
            });
        };
        let log = read_log(&file, file_map)?;
        if index == 0 {
            origin = log.epoch;
        }
        let mut note = LogNote {
            file,
            remarks: log.remarks,
            rows: log.rows,
            alignment: None,
            quantities: file_map
                .channels
                .iter()
                .map(|c| c.quantity.clone())
                .collect(),
            series: log.series,
        };
        // An unknown clock that counts from a start is no half century off one that counts from 1970, nor the other way round.
        let is_unknown = matches!(file_map.clock, Clock::Unknown { .. });
        if !is_unknown || (origin == 0.0) == (log.epoch == 0.0) {
            note.shift(log.epoch - origin);
        }
        note.set_clock(&file_map.clock, &logs)?;
        logs.push(note);
    }
    let time = logs[0].series[0].time.clone();
    let mut channels = Vec::new();
    for (log, file_map) in logs.iter().zip(&map.files) {
        for (series, channel) in log.series.iter().zip(&file_map.channels) {
            let values = if series.time == time {
                series.values.clone()
            } else {
                check_overlap(&log.file, &series.time, &logs[0].file, &time)?;
                series.read_off(&time)
            };
            channels.push(RecordedChannel::new(
                channel.quantity.clone(),
                channel.unit.si,
                values,
            ));
        }
    }
    for constant in &map.constants {
        let values = vec![constant.value; time.len()];
        channels.push(RecordedChannel::new(
            constant.quantity.clone(),
            constant.unit,
            values,
        ));
    }
    Ok(Imported {
        recording: Recording::new(time, channels, map.phases.clone())?,
        origin,
        logs,
    })
}

impl LogNote {
    /// Moves its times [s].
    fn shift(&mut self, by: f64) {
        let times = self.series.iter_mut().flat_map(|series| &mut series.time);
        times.for_each(|time| *time += by);
    }

    /// Moves its times to the first log's clock.
    fn set_clock(&mut self, clock: &Clock, before: &[Self]) -> Result<(), ImportError> {
        let offset = match clock {
            Clock::Shared { offset } => *offset,
            Clock::Unknown { by, largest } => {
                let first = before[0].series_of(&by[0]);
                let alignment = clock::align(first, self.series_of(&by[1]), *largest);
                let alignment = alignment.map_err(|found| ImportError::Clock {
                    file: self.file.clone(),
                    first: by[0].clone(),
                    own: by[1].clone(),
                    correlation: found,
                })?;
                self.alignment = Some(alignment);
                alignment.offset
            }
        };
        self.shift(offset);
        Ok(())
    }

    fn series_of(&self, quantity: &str) -> &Series {
        let index = self.quantities.iter().position(|own| own == quantity);
        // A map whose clocks are aligned by what is not there was refused.
        &self.series[index.unwrap_or(0)]
    }
}

fn check_overlap(
    file: &Path,
    own: &[f64],
    first_file: &Path,
    first: &[f64],
) -> Result<(), ImportError> {
    let ends = |time: &[f64]| [time[0], time[time.len() - 1]];
    let ([from, to], [first_from, first_to]) = (ends(own), ends(first));
    if from < first_to && first_from < to {
        return Ok(());
    }
    Err(ImportError::Apart {
        file: file.to_owned(),
        own: [from, to],
        first_file: first_file.to_owned(),
        first: [first_from, first_to],
    })
}

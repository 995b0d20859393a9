//! A log as TDMS of LabVIEW: channels in groups, `Group/Channel`. Times stand in a channel, or each channel is a waveform and says its own start and step.
//!
//! ```text
//! t_i = wf_start_time + wf_start_offset + i wf_increment
//! ```

use std::path::Path;

use super::error::ImportError;
use super::map::{ChannelMap, FileMap};
use super::rows::{Remark, Rows, Times, place};
use super::{parquet_log, signature};
use crate::file::Limit;
use crate::recording::table::Cells;

mod bytes;
mod file;
mod scaling;

pub(super) use file::{Channel, Contents, Waveform};

/// Reads the channels that a map names: those with times of their own each by itself.
pub(super) fn read(path: &Path, map: &FileMap) -> Result<Vec<Rows>, ImportError> {
    let contents = contents(path, map.limit)?;
    let mut remarks = Vec::new();
    if let Some(found) = &contents.torn {
        let rest = format!("{} values of its channels can be read", contents.values());
        if !map.accepts_truncated {
            return Err(ImportError::Truncated {
                file: path.to_owned(),
                found: found.clone(),
                rest,
                advice: "`accept_truncated = true` in the map's [[file]] uses them".to_owned(),
            });
        }
        remarks.push(Remark::Truncated(format!("it is cut off: {found}; {rest}")));
    }
    let names: Vec<String> = contents.channels.iter().map(Channel::column).collect();
    let found = map.channels.iter().map(|channel| {
        let index = place(path, &channel.column, Some(&names), names.len())?;
        Ok(&contents.channels[index])
    });
    let channels: Vec<&Channel> = found.collect::<Result<_, ImportError>>()?;
    for (channel, own) in map.channels.iter().zip(&channels) {
        if let Some(found) = &own.problem {
            return Err(ImportError::Kind {
                file: path.to_owned(),
                column: channel.column.clone(),
                found: found.clone(),
                expected: "numbers; the program that recorded it, DIAdem or the Python package `nptdms` exports others as CSV".to_owned(),
            });
        }
    }
    let times = match &map.time {
        None if map.sample_rate.is_none() => {
            return waveforms(path, map, &channels, &remarks);
        }
        None => Times::of_rate(channels.first().map_or(0, |own| own.len())),
        Some(time) => {
            let index = place(path, &time.column, Some(&names), names.len())?;
            let cells = contents.channels[index].cells.clone();
            parquet_log::times(path, time, map.sample_rate.is_some(), cells)?
        }
    };
    let expected = times.len();
    for (channel, own) in map.channels.iter().zip(&channels) {
        if own.len() != expected {
            return Err(ImportError::Length {
                file: path.to_owned(),
                column: channel.column.clone(),
                found: own.len(),
                expected,
            });
        }
    }
    Ok(vec![Rows {
        channels: (0..map.channels.len()).collect(),
        columns: channels.iter().map(|own| own.numbers()).collect(),
        lines: (1..=expected as u64).collect(),
        time: times,
        remarks,
        ..Rows::default()
    }])
}

/// Rows of channels that say their times themselves.
fn waveforms(
    path: &Path,
    map: &FileMap,
    channels: &[&Channel],
    remarks: &[Remark],
) -> Result<Vec<Rows>, ImportError> {
    let known = map.channels.iter().zip(channels).map(|(channel, own)| {
        let waveform = own.waveform.as_ref();
        waveform.ok_or_else(|| no_waveform(path, channel, own))
    });
    let known: Vec<&Waveform> = known.collect::<Result<_, _>>()?;
    let has_start = |waveform: &&Waveform| waveform.start.is_some();
    if let (Some(with), Some(without)) = (
        known.iter().position(has_start),
        known.iter().position(|waveform| !has_start(waveform)),
    ) {
        return Err(ImportError::Kind {
            file: path.to_owned(),
            column: map.channels[without].column.clone(),
            found: "without the property `wf_start_time`".to_owned(),
            expected: format!("one, as {} has it", map.channels[with].column),
        });
    }
    let mut all: Vec<Rows> = Vec::new();
    let mut of_rows: Vec<(&Waveform, usize)> = Vec::new();
    for (index, (own, waveform)) in channels.iter().zip(known).enumerate() {
        let key = (waveform, own.len());
        if let Some(same) = of_rows.iter().position(|other| *other == key) {
            all[same].channels.push(index);
            all[same].columns.push(own.numbers());
            continue;
        }
        of_rows.push(key);
        all.push(Rows {
            channels: vec![index],
            time: waveform.times(own.len()),
            columns: vec![own.numbers()],
            lines: (1..=own.len() as u64).collect(),
            remarks: remarks.to_vec(),
            ..Rows::default()
        });
    }
    Ok(all)
}

fn no_waveform(path: &Path, channel: &ChannelMap, own: &Channel) -> ImportError {
    ImportError::Kind {
        file: path.to_owned(),
        column: channel.column.clone(),
        found: format!("{} values without times", own.len()),
        expected: "its property `wf_increment`, the step of a waveform, or `time` in the map's [[file]]: a channel of the times".to_owned(),
    }
}

/// Reads a file.
///
/// # Errors
/// It cannot be read, or is no TDMS.
pub(super) fn contents(path: &Path, limit: Limit) -> Result<Contents, ImportError> {
    signature::check(path, "tdms", "a TDMS file")?;
    let fail = |cause: String| ImportError::Read {
        file: path.to_owned(),
        cause,
    };
    let bytes =
        crate::file::read_up_to(path, limit.whole()).map_err(|cause| fail(cause.to_string()))?;
    let contents = file::parse(&bytes).map_err(fail)?;
    if contents.channels.is_empty() {
        return Err(fail("it holds no channels".to_owned()));
    }
    Ok(contents)
}

impl Channel {
    /// Its name in a map.
    pub fn column(&self) -> String {
        format!("{}/{}", self.group, self.name)
    }

    /// Its values; stamps in seconds since 1970.
    pub fn numbers(&self) -> Vec<f64> {
        parquet_log::numbers(&self.cells)
    }

    /// Their number.
    pub fn len(&self) -> usize {
        match &self.cells {
            Cells::Numbers(numbers) => numbers.len(),
            Cells::Nanoseconds(stamps) => stamps.len(),
            Cells::Texts(texts) => texts.len(),
        }
    }
}

impl Waveform {
    /// Times of so many samples.
    pub fn times(&self, count: usize) -> Times {
        let since = |index: usize| self.offset + self.increment * index as f64;
        match self.start {
            Some(start) => {
                let at = |index| start + (since(index) * 1e9).round() as i64;
                Times::Nanoseconds((0..count).map(at).collect())
            }
            None => Times::Numbers((0..count).map(since).collect()),
        }
    }
}

impl Contents {
    fn values(&self) -> usize {
        self.channels.iter().map(Channel::len).sum()
    }
}

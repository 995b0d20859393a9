//! The numbers of a log, whatever its form: series against their own times, in SI.

use std::ops::Range;
use std::path::Path;

use super::error::ImportError;
use super::map::{ChannelMap, FileMap, Form};
use super::rows::{Remark, Rows, Times};
use super::stamps::are_whole_seconds;
use super::{bag, mat_log, parquet_log, spreadsheet, tdms_log, text};
use crate::stats::median_step;

/// Times from here on count from 1970, not from a start [s]: over three years.
pub(super) const EPOCH: f64 = 1e8;
const NANOSECONDS: i64 = 1_000_000_000;
/// Steps of a series beyond which nothing is read off between two of its samples.
const GAP: f64 = 3.0;

/// Content of a log for a map's channels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Log {
    /// One for each channel of the map, in its order.
    pub series: Vec<Series>,
    /// Whole seconds taken off its times, since 1970; 0 where they count from a start [s].
    pub epoch: f64,
    /// Data left out, or mended, for people.
    pub remarks: Vec<Remark>,
    /// Rows that were used, and rows that are there.
    pub rows: [usize; 2],
}

/// Values against times.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Times [s], increasing.
    pub time: Vec<f64>,
    /// Values [SI], NaN where the log has none.
    pub values: Vec<f64>,
}

impl Series {
    /// Its values at other times, linear between its samples; NaN before the first, after the last, and in gaps.
    #[must_use]
    pub fn read_off(&self, time: &[f64]) -> Vec<f64> {
        let longest = GAP * median_step(&self.time);
        let value = |t: &f64| {
            let after = self.time.partition_point(|own| own < t);
            let Some(&later) = self.time.get(after) else {
                return f64::NAN;
            };
            if later == *t {
                return self.values[after];
            }
            let Some(before) = after.checked_sub(1) else {
                return f64::NAN;
            };
            let earlier = self.time[before];
            if later - earlier > longest {
                return f64::NAN;
            }
            let share = (t - earlier) / (later - earlier);
            self.values[before] + share * (self.values[after] - self.values[before])
        };
        time.iter().map(value).collect()
    }
}

/// Reads a log as its map says.
///
/// # Errors
/// The file, its row and column that do not fit the map, and what would.
pub fn read_log(path: &Path, map: &FileMap) -> Result<Log, ImportError> {
    let groups = match &map.form {
        Form::Text(form) => vec![text::read(path, form, map)?],
        Form::Parquet => vec![parquet_log::read(path, map)?],
        Form::Mat5 => vec![mat_log::read(path, map)?],
        Form::Bag => bag::read(path, map)?,
        Form::Tdms => tdms_log::read(path, map)?,
        Form::Spreadsheet { sheet, text } => {
            let content =
                spreadsheet::read(path, sheet.as_deref(), text.decimal_mark, map.limit)?.text;
            vec![text::read_content(path, &content, text, map)?]
        }
    };
    let mut log = Log {
        series: vec![Series::default(); map.channels.len()],
        ..Log::default()
    };
    for (index, rows) in groups.into_iter().enumerate() {
        let channels = rows.channels.clone();
        let group = of_rows(path, map, rows)?;
        if index == 0 {
            log.epoch = group.epoch;
        }
        let shift = group.epoch - log.epoch;
        for (channel, mut series) in channels.into_iter().zip(group.series) {
            if shift != 0.0 {
                series.time.iter_mut().for_each(|time| *time += shift);
            }
            log.series[channel] = series;
        }
        log.rows = [log.rows[0] + group.rows[0], log.rows[1] + group.rows[1]];
        for remark in group.remarks {
            if !log.remarks.contains(&remark) {
                log.remarks.push(remark);
            }
        }
    }
    Ok(log)
}

/// Times in seconds, and the whole seconds since 1970 that were taken off them. Among times since 1970 zero is none: NaN.
fn seconds(map: &FileMap, times: Times) -> (Vec<f64>, f64) {
    match times {
        Times::Numbers(numbers) => {
            let unit = map.time.as_ref().and_then(|time| time.unit);
            let to_si = |number: &f64| match (unit, map.sample_rate) {
                (Some(unit), _) => unit.to_si(*number),
                (None, Some(rate)) => number / rate,
                (None, None) => *number,
            };
            let time: Vec<f64> = numbers.iter().map(to_si).collect();
            match time.iter().find(|time| **time != 0.0) {
                // A counter may begin anywhere.
                Some(first) if first.abs() > EPOCH && map.sample_rate.is_none() => {
                    let epoch = first.floor();
                    let since = |t: &f64| if *t == 0.0 { f64::NAN } else { t - epoch };
                    (time.iter().map(since).collect(), epoch)
                }
                _ => (time, 0.0),
            }
        }
        // Taken off before they are numbers: a double has steps of 0.2 us by now.
        Times::Nanoseconds(stamps) => match stamps.iter().find(|stamp| **stamp != 0) {
            Some(first) if *first as f64 > EPOCH * 1e9 => {
                let epoch = first.div_euclid(NANOSECONDS);
                let since = |stamp: &i64| match stamp {
                    0 => f64::NAN,
                    stamp => (stamp - epoch * NANOSECONDS) as f64 / 1e9,
                };
                (stamps.iter().map(since).collect(), epoch as f64)
            }
            _ => {
                let since = |stamp: &i64| *stamp as f64 / 1e9;
                (stamps.iter().map(since).collect(), 0.0)
            }
        },
    }
}

/// Whether times fall and never rise.
fn fall(time: &[f64], rows: &[usize]) -> bool {
    let falls = |pair: &[usize]| time[pair[1]] <= time[pair[0]];
    let [Some(first), Some(last)] = [rows.first(), rows.last()] else {
        return false;
    };
    rows.len() > 2 && time[*last] < time[*first] && rows.windows(2).all(falls)
}

/// Ratio from which a time may have fallen by a thousand, less some steps.
const THOUSANDFOLD: std::ops::RangeInclusive<f64> = 900.0..=1001.0;

/// Whether a clock starts again where a time is behind the one before it, and did not only come late: that goes back by little.
pub(super) fn starts_again([first, before, found]: [f64; 3]) -> bool {
    found - first < 0.5 * (before - first)
}

/// The refusal of a time that goes back behind the one before it; `dropped` are the rows that leave out all from there on, or all before.
fn back(
    path: &Path,
    map: &FileMap,
    line: u64,
    [first, before, found]: [f64; 3],
    dropped: [usize; 2],
) -> ImportError {
    let file = path.to_owned();
    let advice = fallen(found, before);
    if advice.is_empty() && starts_again([first, before, found]) && map.form != Form::Bag {
        return ImportError::Restart {
            file,
            line,
            found,
            before,
            dropped,
        };
    }
    ImportError::Time {
        file,
        line,
        found,
        before,
        advice,
    }
}

/// Pattern of a time that goes back to a thousandth: `1.000` after `999`.
fn fallen(time: f64, before: f64) -> &'static str {
    if THOUSANDFOLD.contains(&(before / time)) {
        "; it fell to a thousandth: is its mark one of thousands (`thousands_mark` in [file.time])?"
    } else {
        ""
    }
}

/// Rows with a stamp, turned round where the newest stands first; says so.
fn in_order(
    time: &[f64],
    rows: Range<usize>,
    lines: &[u64],
    remarks: &mut Vec<Remark>,
) -> Vec<usize> {
    let (mut kept, unstamped): (Vec<usize>, Vec<usize>) =
        rows.partition(|row| !time[*row].is_nan());
    if !unstamped.is_empty() {
        let lines = unstamped.iter().map(|row| lines[*row]).collect();
        remarks.push(Remark::Unstamped(lines));
    }
    if fall(time, &kept) {
        kept.reverse();
        remarks.push(Remark::Reversed);
    }
    kept
}

/// Rows in SI, those left out that the map drops or that say nothing new.
fn of_rows(path: &Path, map: &FileMap, rows: Rows) -> Result<Log, ImportError> {
    let Rows {
        channels,
        time,
        columns,
        lines,
        mut remarks,
        there,
        is_trimmed,
    } = rows;
    let is_whole = matches!(&time, Times::Nanoseconds(stamps) if are_whole_seconds(stamps));
    let (time, epoch) = seconds(map, time);
    let [first, last] = if is_trimmed { [0, 0] } else { map.dropped };
    let count = time.len();
    let kept = first..count.saturating_sub(last);
    if kept.len() < 2 {
        return Err(ImportError::TooShort {
            file: path.to_owned(),
            rows: count,
            dropped: first + last,
        });
    }
    if first + last > 0 {
        remarks.push(Remark::Dropped([first, last]));
    }
    let kept = in_order(&time, kept, &lines, &mut remarks);
    let (mut taken, mut repeated, mut stamped) = (Vec::new(), Vec::new(), Vec::new());
    let same = |a: f64, b: f64| a == b || (a.is_nan() && b.is_nan());
    for row in kept {
        if let Some(&before) = taken.last() {
            if time[row] < time[before] {
                let stamps = [time[taken[0]], time[before], time[row]];
                let dropped = [
                    map.dropped[0] + row - first,
                    map.dropped[1] + count - last - row,
                ];
                return Err(back(path, map, lines[row], stamps, dropped));
            }
            if time[row] == time[before] {
                let repeats = columns.iter().all(|c| same(c[row], c[before]));
                if repeats { &mut repeated } else { &mut stamped }.push(lines[row]);
                continue;
            }
        }
        taken.push(row);
    }
    if taken.len() < 2 {
        return Err(ImportError::Still {
            file: path.to_owned(),
            rows: count - first - last,
        });
    }
    let there = there.unwrap_or(count - first - last);
    check_used(
        path,
        map,
        [taken.len(), there],
        [&repeated, &stamped],
        is_whole,
    )?;
    if !repeated.is_empty() {
        remarks.push(Remark::Repeated(repeated));
    }
    if !stamped.is_empty() {
        remarks.push(Remark::Stamped(stamped));
    }
    let used = taken.len();
    Ok(Log {
        series: series(map, &channels, &columns, &time, &taken),
        epoch,
        remarks,
        rows: [used, there],
    })
}

/// Series in SI of the rows that were taken.
fn series(
    map: &FileMap,
    channels: &[usize],
    columns: &[Vec<f64>],
    time: &[f64],
    taken: &[usize],
) -> Vec<Series> {
    let time: Vec<f64> = taken.iter().map(|row| time[*row]).collect();
    let value = |channel: &ChannelMap, number: f64| {
        let value = if map.missing.has(number) {
            f64::NAN
        } else {
            channel.to_si(number)
        };
        // An overflow is no value.
        if value.is_finite() { value } else { f64::NAN }
    };
    let of = |(channel, numbers): (&usize, &Vec<f64>)| {
        let channel = &map.channels[*channel];
        Series {
            time: time.clone(),
            values: taken
                .iter()
                .map(|row| value(channel, numbers[*row]))
                .collect(),
        }
    };
    channels.iter().zip(columns).map(of).collect()
}

/// Refuses a log of which fewer than nine in ten rows would be used, unless the map accepts that.
fn check_used(
    path: &Path,
    map: &FileMap,
    [used, there]: [usize; 2],
    [repeated, stamped]: [&[u64]; 2],
    is_whole: bool,
) -> Result<(), ImportError> {
    if 10 * used >= 9 * there || map.accepts_unused_rows {
        return Ok(());
    }
    let mut why: Vec<String> = Vec::new();
    if let Some(line) = stamped.first() {
        why.push(format!(
            "{} have the time of the row before them but other values (line {line} is the first)",
            stamped.len()
        ));
    }
    if let Some(line) = repeated.first() {
        why.push(format!(
            "{} repeat the row before them (line {line} is the first)",
            repeated.len()
        ));
    }
    let others = there - used - stamped.len() - repeated.len();
    if others > 0 {
        why.push(format!("{others} are no rows or have no stamp"));
    }
    if !stamped.is_empty() {
        why.push(
            if is_whole {
                "times of whole seconds are too coarse: `sample_rate_hz` in place of `time` in [[file]] spaces rows evenly"
            } else {
                "`sample_rate_hz` in [[file]] spaces rows evenly where times are too coarse"
            }
            .to_owned(),
        );
        why.push(
            "`rows = { column = .., value = .. }` chooses the rows of one variable where each has its own"
                .to_owned(),
        );
    }
    Err(ImportError::Unused {
        file: path.to_owned(),
        used,
        there,
        why: why.join("; "),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_off_between_samples_but_not_across_gaps() {
        let series = Series {
            time: vec![0.0, 1.0, 2.0, 3.0, 10.0, 11.0],
            values: vec![0.0, 10.0, 20.0, 30.0, 0.0, 1.0],
        };
        let read = series.read_off(&[-0.1, 0.0, 0.25, 3.0, 5.0, 10.5, 11.0, 11.1]);
        assert_eq!(read[1..4], [0.0, 2.5, 30.0]);
        assert_eq!(read[5..7], [0.5, 1.0]);
        assert!([0, 4, 7].iter().all(|i| read[*i].is_nan()));
    }
}

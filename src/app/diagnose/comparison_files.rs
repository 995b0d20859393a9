//! comparison.parquet and balance.parquet: what a diagnosis compared, for pages, notebooks and other programs.
//!
//! comparison.parquet has a row per sample of each recording: `recording`, `kept` (`fitted`, or `unseen` where it was kept from the fit), `time_s`, then
//! `measured_`, `believed_`, `tolerated_` (the nominal model moved within its tolerances), `improved_` and `left_out_` (the improved model fitted to the
//! other recordings) of each channel. balance.parquet has a row per sample: `link`, `variable` and `value` (the variable that explains when the link lacks something),
//! `channel` (in whose unit it lacks) and `before` and `after`.

use std::path::Path;

use super::super::error::AppError;
use super::super::files::{BALANCE, COMPARISON};
use crate::diagnosis::difference::comparison::{Balance, Compared, ComparedChannel, Comparison};
use crate::diagnosis::recordings::recorded::COLUMNS;
use crate::plant::{CHANNELS, Channel};
use crate::recording::RecordingError;
use crate::recording::long_column::LongColumn;
use crate::recording::long_table::{read_long, write_long};

const FITTED: &str = "fitted";
const UNSEEN: &str = "unseen";
const MODELS: [&str; 5] = ["measured", "believed", "tolerated", "improved", "left_out"];

/// Writes the recordings beside the models.
pub(super) fn write_recordings(path: &Path, comparison: &Comparison) -> Result<(), RecordingError> {
    write_long(path, &columns_of_recordings(comparison))
}

/// The recordings beside the models as a long table.
pub(super) fn columns_of_recordings(comparison: &Comparison) -> Vec<(String, LongColumn)> {
    let recordings = &comparison.recordings;
    let each = |text: &dyn Fn(&Compared) -> &str| -> LongColumn {
        let rows = recordings
            .iter()
            .flat_map(|r| std::iter::repeat_n(text(r).to_owned(), r.time.len()));
        LongColumn::Names(rows.collect())
    };
    let mut columns = vec![
        ("recording".to_owned(), each(&|r| &r.name)),
        (
            "kept".to_owned(),
            each(&|r| if r.unseen { UNSEEN } else { FITTED }),
        ),
        (
            "time_s".to_owned(),
            LongColumn::Numbers(recordings.iter().flat_map(|r| r.time.clone()).collect()),
        ),
    ];
    let mut names: Vec<&str> = Vec::new();
    for channel in recordings.iter().flat_map(|r| &r.channels) {
        if !names.contains(&channel.column.as_str()) {
            names.push(&channel.column);
        }
    }
    // Those of a device in the order of the format, whatever the first recording lacks.
    names.sort_by_key(|name| COLUMNS.iter().position(|own| own == name));
    for name in names {
        let own = |r: &Compared| r.channels.iter().position(|c| c.column == name);
        for (place, model) in MODELS.into_iter().enumerate() {
            let values = recordings.iter().flat_map(|r| match own(r) {
                Some(index) => of_model(&r.channels[index], place).to_vec(),
                None => vec![f64::NAN; r.time.len()],
            });
            columns.push((
                format!("{model}_{name}"),
                LongColumn::Numbers(values.collect()),
            ));
        }
    }
    columns
}

fn of_model(channel: &ComparedChannel, place: usize) -> &[f64] {
    [
        &channel.measured,
        &channel.nominal,
        &channel.tolerated,
        &channel.improved,
        &channel.left_out,
    ][place]
}

/// Writes the balances.
pub(super) fn write_balances(path: &Path, comparison: &Comparison) -> Result<(), RecordingError> {
    let balances = &comparison.balances;
    let names = |text: &dyn Fn(&Balance) -> &str| {
        let rows = balances
            .iter()
            .flat_map(|b| std::iter::repeat_n(text(b).to_owned(), b.values.len()));
        LongColumn::Names(rows.collect())
    };
    let numbers = |values: &dyn Fn(&Balance) -> &Vec<f64>| {
        LongColumn::Numbers(balances.iter().flat_map(|b| values(b).clone()).collect())
    };
    let columns = [
        ("link", names(&|b| &b.link)),
        ("channel", names(&|b| COLUMNS[b.channel as usize])),
        ("variable", names(&|b| &b.variable)),
        ("value", numbers(&|b| &b.values)),
        ("before", numbers(&|b| &b.before)),
        ("after", numbers(&|b| &b.after)),
    ];
    let columns: Vec<(String, LongColumn)> = columns
        .into_iter()
        .map(|(name, column)| (name.to_owned(), column))
        .collect();
    write_long(path, &columns)
}

/// A table as it was read, its columns by name.
struct Rows<'a> {
    path: &'a Path,
    columns: Vec<(String, LongColumn)>,
}

impl Rows<'_> {
    fn read(path: &Path) -> Result<Rows<'_>, AppError> {
        let columns = read_long(path)?;
        Ok(Rows { path, columns })
    }

    fn find(&self, name: &str) -> Option<&LongColumn> {
        let mut own = self.columns.iter().filter(|(own, _)| own == name);
        own.next().map(|(_, column)| column)
    }

    fn absent(&self, name: &str, of: &str) -> AppError {
        let cause = format!("it has no column `{name}` of {of}");
        RecordingError::read(self.path, cause).into()
    }

    fn names(&self, name: &str) -> Result<&[String], AppError> {
        match self.find(name) {
            Some(LongColumn::Names(names)) => Ok(names),
            _ => Err(self.absent(name, "names")),
        }
    }

    fn numbers(&self, name: &str) -> Result<&[f64], AppError> {
        match self.find(name) {
            Some(LongColumn::Numbers(numbers)) => Ok(numbers),
            _ => Err(self.absent(name, "numbers")),
        }
    }
}

/// Reads what was compared from the folder of a diagnosis.
pub(in super::super) fn read_comparison(folder: &Path) -> Result<Comparison, AppError> {
    Ok(Comparison {
        recordings: recordings(&folder.join(COMPARISON))?,
        balances: balances(&folder.join(BALANCE))?,
    })
}

fn recordings(path: &Path) -> Result<Vec<Compared>, AppError> {
    let rows = Rows::read(path)?;
    let (names, kept) = (rows.names("recording")?, rows.names("kept")?);
    let time = rows.numbers("time_s")?;
    let mut found = Vec::new();
    let mut first = 0;
    let pairs: Vec<(&String, &String)> = names.iter().zip(kept).collect();
    let columns = rows.columns.iter();
    let columns = columns.filter_map(|(name, _)| name.strip_prefix(MODELS[1])?.strip_prefix('_'));
    let columns: Vec<&str> = columns.collect();
    for run in pairs.chunk_by(|a, b| a == b) {
        let span = first..first + run.len();
        first = span.end;
        let mut channels = Vec::new();
        for name in &columns {
            let column = |model: &str| format!("{model}_{name}");
            let read = |place: usize| -> Result<Vec<f64>, AppError> {
                Ok(rows.numbers(&column(MODELS[place]))?[span.clone()].to_vec())
            };
            let (measured, nominal, tolerated) = (read(0)?, read(1)?, read(2)?);
            let (improved, left_out) = (read(3)?, read(4)?);
            if nominal.iter().all(|value| value.is_nan()) {
                continue;
            }
            channels.push(ComparedChannel {
                column: (*name).to_owned(),
                measured,
                nominal,
                tolerated,
                improved,
                left_out,
            });
        }
        found.push(Compared {
            name: run[0].0.clone(),
            unseen: run[0].1 == UNSEEN,
            time: time[span].to_vec(),
            channels,
        });
    }
    Ok(found)
}

fn balances(path: &Path) -> Result<Vec<Balance>, AppError> {
    let rows = Rows::read(path)?;
    let (links, channels) = (rows.names("link")?, rows.names("channel")?);
    let variables = rows.names("variable")?;
    let columns = ["value", "before", "after"].map(|name| rows.numbers(name));
    let [values, before, after] = columns;
    let (values, before, after) = (values?, before?, after?);
    let mut found = Vec::new();
    let mut first = 0;
    for run in links.chunk_by(|a, b| a == b) {
        let span = first..first + run.len();
        first = span.end;
        let place = COLUMNS
            .iter()
            .position(|column| *column == channels[span.start]);
        let channel: Channel = CHANNELS[place.ok_or_else(|| rows.absent("channel", "channels"))?];
        found.push(Balance {
            link: run[0].clone(),
            channel,
            variable: variables[span.start].clone(),
            values: values[span.clone()].to_vec(),
            before: before[span.clone()].to_vec(),
            after: after[span].to_vec(),
        });
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comparison_reads_back() {
        let channel = |channel: Channel, offset: f64| ComparedChannel {
            column: COLUMNS[channel as usize].to_owned(),
            measured: vec![f64::NAN, offset],
            nominal: vec![offset, 1.0],
            tolerated: vec![offset, 0.75],
            improved: vec![0.5, offset],
            left_out: vec![f64::NAN, 0.25],
        };
        let recording = |name: &str, unseen, channels| Compared {
            name: name.to_owned(),
            unseen,
            time: vec![0.0, 0.5],
            channels,
        };
        let comparison = Comparison {
            recordings: vec![
                recording(
                    "a.csv",
                    false,
                    vec![channel(Channel::Stroke, 2.0), channel(Channel::Force, 3.0)],
                ),
                recording("b.csv", true, vec![channel(Channel::Force, 4.0)]),
            ],
            balances: vec![Balance {
                link: "piston".to_owned(),
                channel: Channel::Force,
                variable: "velocity_sign".to_owned(),
                values: vec![-1.0, 1.0],
                before: vec![-5.0, 5.0],
                after: vec![0.1, -0.1],
            }],
        };
        let folder = tempfile::tempdir().unwrap();
        write_recordings(&folder.path().join(COMPARISON), &comparison).unwrap();
        write_balances(&folder.path().join(BALANCE), &comparison).unwrap();
        let read = read_comparison(folder.path()).unwrap();
        // NaN is not itself.
        assert_eq!(format!("{read:?}"), format!("{comparison:?}"));
    }
}

//! fleet.parquet: a row for each number of each recording, in the order of devices and days.

use std::path::Path;

use super::super::error::AppError;
use crate::fleet::{NumberFound, Recording};
use crate::recording::long_column::LongColumn;
use crate::recording::long_table::write_groups;

/// The document.
pub(in super::super) const FLEET: &str = "fleet.json";
/// The table.
pub(super) const TABLE: &str = "fleet.parquet";
const COLUMNS: [(&str, bool); 12] = [
    ("device", true),
    ("recording", true),
    ("day", false),
    ("id", true),
    ("code", false),
    ("reason", true),
    ("verdict", true),
    ("searched", false),
    ("effect", true),
    ("number", true),
    ("value", false),
    ("half_interval", false),
];
/// Recordings of a group of rows.
const GROUP: usize = 1024;

/// Writes the table.
pub(super) fn write_table(recordings: &[Recording], table: &Path) -> Result<(), AppError> {
    let mut groups = recordings.chunks(GROUP);
    write_groups(table, &COLUMNS, || Ok(groups.next().map(group)))
}

fn group(recordings: &[Recording]) -> Vec<LongColumn> {
    let mut columns: Vec<LongColumn> = (COLUMNS.iter())
        .map(|(_, names)| match names {
            true => LongColumn::Names(Vec::new()),
            false => LongColumn::Numbers(Vec::new()),
        })
        .collect();
    for recording in recordings {
        let effects = recording.result.effects.iter();
        let mut rows: Vec<(&str, Option<&NumberFound>)> = effects
            .flat_map(|(effect, numbers)| {
                let bare = numbers.is_empty().then_some((effect.as_str(), None));
                let own = numbers.iter().map(|number| (effect.as_str(), Some(number)));
                bare.into_iter().chain(own)
            })
            .collect();
        // A nominal value with a tolerance is of no effect.
        rows.extend(
            recording
                .result
                .tolerated
                .iter()
                .map(|number| ("", Some(number))),
        );
        if rows.is_empty() {
            rows.push(("", None));
        }
        for (effect, number) in rows {
            row(&mut columns, recording, effect, number);
        }
    }
    columns
}

fn row(
    columns: &mut [LongColumn],
    recording: &Recording,
    effect: &str,
    number: Option<&NumberFound>,
) {
    let result = &recording.result;
    let names = [
        recording.device.as_str(),
        &recording.name,
        &recording.id,
        &result.reason,
        &result.verdict,
        effect,
        number.map_or("", |number| &number.name),
    ];
    let numbers = [
        recording.day,
        f64::from(result.code),
        f64::from(u8::from(result.searched)),
        number.map_or(f64::NAN, |number| number.value),
        number.map_or(f64::NAN, |number| 0.5 * (number.high - number.low)),
    ];
    let (mut names, mut numbers) = (names.into_iter(), numbers.into_iter());
    for column in columns {
        match column {
            LongColumn::Names(all) => all.extend(names.next().map(str::to_owned)),
            LongColumn::Numbers(all) => all.extend(numbers.next()),
        }
    }
}

//! The import map's file, read and checked.

use std::path::Path;

use super::map::{Clock, FileMap, Form, ImportMap, Missing, RowChoice};
use crate::file::Limit;
use crate::keys::check::Section;
use crate::keys::document::{Document, read_text};
use crate::scenario::ScenarioError;

mod channels;
mod keys;
mod texts;
mod times;

use channels::{channel_map, constant};
use keys::{ClockKey, FileKeys, FormKey, MapFile, MarkKey};
use texts::text_form;
use times::time_map;

/// Version of the format.
const SCHEMA: u32 = 1;

/// Reads and checks a map.
///
/// # Errors
/// File, line, column and key of what is wrong, what was found and what was expected.
pub fn load_map(path: &Path) -> Result<ImportMap, ScenarioError> {
    let text = read_text(path)?;
    let document = Document::new(path, &text, SCHEMA)?;
    let keys: MapFile = document.read()?;
    let top = Section::new(&document, "");
    let atmosphere = keys.atmosphere;
    let mut files = Vec::new();
    for (index, file) in keys.file.iter().enumerate() {
        files.push(file_map(&document, index, file, atmosphere)?);
    }
    if files.is_empty() {
        return Err(top.missing("file", "one [[file]] at least"));
    }
    let constants = keys.constant.iter().enumerate();
    let constants = constants
        .map(|(index, keys)| constant(&document, format!("constant[{index}]"), keys, atmosphere))
        .collect::<Result<_, _>>()?;
    let map = ImportMap {
        path: path.to_owned(),
        title: top.text("title", &keys.title)?,
        files,
        constants,
        phases: Vec::new(),
        says_itself: false,
    };
    check_together(&document, &map)?;
    Ok(map)
}

/// JSON Schema of a map, for editors.
#[must_use]
pub fn schema() -> serde_json::Value {
    keys::schema()
}

fn file_map(
    document: &Document<'_>,
    index: usize,
    keys: &FileKeys,
    atmosphere: f64,
) -> Result<FileMap, ScenarioError> {
    let table = format!("file[{index}]");
    let section = Section::new(document, table.clone());
    check_forms(document, &section, keys, &table)?;
    if keys.same_log && (index == 0 || keys.path.is_some()) {
        let reason = match index {
            0 => "the first [[file]] has none before it".to_owned(),
            _ => "the log is that of the [[file]] before it, and has its path".to_owned(),
        };
        return Err(section.misplaced("same_log", reason));
    }
    let sample_rate = keys.sample_rate;
    let time = keys
        .time
        .as_ref()
        .map(|time| time_map(document, &table, keys.form, time, sample_rate))
        .transpose()?;
    let channels = keys.channel.iter().enumerate();
    Ok(FileMap {
        path: keys.path.as_ref().map(|path| document.folder().join(path)),
        same_log: keys.same_log,
        form: form(&section, keys)?,
        dropped: [keys.drop_first_rows, keys.drop_last_rows],
        accepts_truncated: keys.accept_truncated.unwrap_or(false),
        limit: Limit::of(keys.largest_megabytes.map(|megabytes| megabytes as u64)),
        accepts_unused_rows: keys.accept_unused_rows,
        accepts_empty: false,
        missing: missing(&section, keys)?,
        rows: keys.rows.as_ref().map(|rows| RowChoice {
            column: rows.column.0.clone(),
            value: match &rows.value {
                MarkKey::Text(text) => text.trim().to_owned(),
                MarkKey::Whole(number) => number.to_string(),
                MarkKey::Number(number) => number.to_string(),
            },
        }),
        clock: clock(&section, index, keys)?,
        time,
        sample_rate,
        channels: channels
            .map(|(i, channel)| {
                channel_map(
                    document,
                    format!("{table}.channel[{i}]"),
                    channel,
                    atmosphere,
                )
            })
            .collect::<Result<_, _>>()?,
    })
}

/// Refuses keys that a file of this form cannot have, and the lack of those that it must.
fn check_forms(
    document: &Document<'_>,
    section: &Section<'_>,
    keys: &FileKeys,
    table: &str,
) -> Result<(), ScenarioError> {
    let is_bag = matches!(keys.form, FormKey::Bag | FormKey::Mcap);
    let says_times = is_bag || matches!(keys.form, FormKey::Tdms);
    if keys.time.is_none() && keys.sample_rate.is_none() && !says_times {
        return Err(section.missing(
            "time",
            "the column that holds the times, and its unit; or `sample_rate_hz` where no column does",
        ));
    }
    if keys.sample_rate.is_some() && is_bag {
        let reason = "the messages of a bag have times".to_owned();
        return Err(section.misplaced("sample_rate_hz", reason));
    }
    if keys.channel.is_empty() {
        return Err(section.missing("channel", "one [[file.channel]] at least"));
    }
    if keys.accept_truncated.is_some() && matches!(keys.form, FormKey::Parquet) {
        let reason = "a Parquet file that is cut off cannot be read at all".to_owned();
        return Err(section.misplaced("accept_truncated", reason));
    }
    if is_bag {
        return Ok(());
    }
    for (i, channel) in keys.channel.iter().enumerate() {
        let section = Section::new(document, format!("{table}.channel[{i}]"));
        for (key, given) in [("joint", &channel.joint), ("frame", &channel.frame)] {
            if given.is_some() {
                return Err(section.misplaced(key, "only a bag's messages have it".to_owned()));
            }
        }
    }
    Ok(())
}

/// Marks of missing values: texts of a text alone.
fn missing(section: &Section<'_>, keys: &FileKeys) -> Result<Missing, ScenarioError> {
    let mut missing = Missing::default();
    for mark in keys.missing.iter().flatten() {
        match mark {
            MarkKey::Whole(number) => missing.numbers.push(*number as f64),
            MarkKey::Number(number) => missing.numbers.push(*number),
            MarkKey::Text(text) if matches!(keys.form, FormKey::Text | FormKey::Spreadsheet) => {
                missing.texts.push(text.trim().to_lowercase());
            }
            MarkKey::Text(text) => {
                let expected = "numbers; only a text has texts in its columns".to_owned();
                return Err(section.refuse("missing", format!("{text:?}"), expected));
            }
        }
    }
    Ok(missing)
}

fn form(section: &Section<'_>, keys: &FileKeys) -> Result<Form, ScenarioError> {
    if keys.sheet.is_some() && !matches!(keys.form, FormKey::Spreadsheet) {
        return Err(section.misplaced("sheet", "only a spreadsheet has it".to_owned()));
    }
    let of_text = [
        ("encoding", keys.encoding.is_some()),
        ("thousands_mark", keys.thousands_mark.is_some()),
        ("separator", keys.separator.is_some()),
        ("field_widths", keys.field_widths.is_some()),
        ("decimal_mark", keys.decimal_mark.is_some()),
        ("header_lines", keys.header_lines.is_some()),
        ("names_line", keys.names_line.is_some()),
        ("skip_stray_lines", keys.skip_stray_lines.is_some()),
        ("rows", keys.rows.is_some()),
    ];
    let other = match keys.form {
        FormKey::Text => return text_form(section, keys).map(Form::Text),
        FormKey::Parquet => Form::Parquet,
        FormKey::Mat5 => Form::Mat5,
        FormKey::Bag | FormKey::Mcap => Form::Bag,
        FormKey::Tdms => Form::Tdms,
        FormKey::Spreadsheet => return spreadsheet(section, keys),
    };
    match of_text.iter().find(|(_, given)| *given) {
        Some((key, _)) => Err(section.misplaced(key, "only a text has it".to_owned())),
        None => Ok(other),
    }
}

fn spreadsheet(section: &Section<'_>, keys: &FileKeys) -> Result<Form, ScenarioError> {
    let of_files = [
        ("encoding", keys.encoding.is_some()),
        ("separator", keys.separator.is_some()),
        ("field_widths", keys.field_widths.is_some()),
    ];
    if let Some((key, _)) = of_files.iter().find(|(_, given)| *given) {
        return Err(section.misplaced(key, "only a text has it".to_owned()));
    }
    Ok(Form::Spreadsheet {
        sheet: keys.sheet.clone(),
        text: text_form(section, keys)?,
    })
}

fn clock(section: &Section<'_>, index: usize, keys: &FileKeys) -> Result<Clock, ScenarioError> {
    let given = |key: &&str| section.given().any(|given| given == *key);
    match keys.clock {
        ClockKey::Shared => match ["aligned_by", "largest_offset_s"]
            .iter()
            .find(|key| given(key))
        {
            Some(key) => {
                let reason = "the clock is shared; \"unknown\" has it found".to_owned();
                Err(section.misplaced(key, reason))
            }
            None => Ok(Clock::Shared {
                offset: keys.clock_offset,
            }),
        },
        ClockKey::Unknown if index == 0 => {
            let reason = "the first file's clock is the recording's".to_owned();
            Err(section.misplaced("clock", reason))
        }
        ClockKey::Unknown => {
            if given(&"clock_offset_s") {
                let reason = "the clock is unknown; \"shared\" has an offset".to_owned();
                return Err(section.misplaced("clock_offset_s", reason));
            }
            let Some(by) = keys.aligned_by.clone() else {
                let expected =
                    "a quantity of the first file and one of this that rise and fall together";
                return Err(section.missing("aligned_by", expected));
            };
            Ok(Clock::Unknown {
                by,
                largest: keys.largest_offset,
            })
        }
    }
}

/// Every quantity once, and clocks aligned by quantities that are there.
fn check_together(document: &Document<'_>, map: &ImportMap) -> Result<(), ScenarioError> {
    let mut seen: Vec<&str> = Vec::new();
    for (index, constant) in map.constants.iter().enumerate() {
        let in_log = |file: &FileMap| {
            file.channels
                .iter()
                .any(|c| c.quantity == constant.quantity)
        };
        if seen.contains(&constant.quantity.as_str()) || map.files.iter().any(in_log) {
            let section = Section::new(document, format!("constant[{index}]"));
            let expected = "every quantity once".to_owned();
            return Err(section.refuse("quantity", format!("{:?}", constant.quantity), expected));
        }
        seen.push(&constant.quantity);
    }
    for (index, file) in map.files.iter().enumerate() {
        let table = format!("file[{index}]");
        for (i, channel) in file.channels.iter().enumerate() {
            if seen.contains(&channel.quantity.as_str()) {
                let section = Section::new(document, format!("{table}.channel[{i}]"));
                let expected = "every quantity once".to_owned();
                return Err(section.refuse(
                    "quantity",
                    format!("{:?}", channel.quantity),
                    expected,
                ));
            }
            seen.push(&channel.quantity);
        }
        let Clock::Unknown { by, .. } = &file.clock else {
            continue;
        };
        for (k, (owner, name)) in [&map.files[0], file].into_iter().zip(by).enumerate() {
            if !owner.channels.iter().any(|c| c.quantity == *name) {
                let section = Section::new(document, table.clone());
                let names: Vec<&str> = owner.channels.iter().map(|c| c.quantity.as_str()).collect();
                let which = ["the first file", "this file"][k];
                let expected = format!("a quantity of {which}: {}", names.join(", "));
                return Err(section.refuse("aligned_by", format!("{name:?}"), expected));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::units;
    use super::*;
    use crate::keys::declaration::tables;

    const PAGE: &str = include_str!("../../assets/import/README.md");

    #[test]
    fn the_page_of_maps_tells_every_key_as_it_is_declared_and_names_every_unit() {
        const HEAD: &str = "| key | what it says | without it |\n| --- | --- | --- |\n";
        let mut rest = PAGE;
        let mut page = String::new();
        // The page has a table for each of these, in its order.
        let order = [
            "",
            "file",
            "file.time",
            "file.rows",
            "file.channel",
            "constant",
        ];
        let tables = tables::<MapFile>();
        assert_eq!(tables.len(), order.len());
        for name in order {
            let (_, keys) = tables.iter().find(|(table, _)| table == name).unwrap();
            let (before, table) = rest.split_once(HEAD).unwrap();
            let rows: String = keys.iter().map(|key| key.short_row() + "\n").collect();
            page += &format!("{before}{HEAD}{rows}");
            rest = table;
            while rest.starts_with('|') {
                rest = rest.split_once('\n').unwrap().1;
            }
        }
        page += rest;
        if std::env::var_os("IDC_UPDATE_SCHEMAS").is_some() {
            let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/import/README.md");
            std::fs::write(path, &page).unwrap();
        }
        assert!(
            page == PAGE,
            "assets/import/README.md differs from the keys; IDC_UPDATE_SCHEMAS=1 writes it anew"
        );
        for unit in units::UNITS.iter() {
            assert!(PAGE.contains(&format!("`{}`", unit.name)), "{}", unit.name);
        }
    }

    #[test]
    fn the_map_on_the_page_is_one() {
        let start = PAGE.find("    schema = 1").unwrap();
        let end = PAGE.find("    value in SI").unwrap();
        let text: String = PAGE[start..end]
            .lines()
            .map(|line| line.trim_start().to_owned() + "\n")
            .collect();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.toml");
        std::fs::write(&path, text).unwrap();
        let map = load_map(&path).unwrap_or_else(|error| panic!("{error}"));
        let [file] = &map.files[..] else {
            panic!("{map:?}")
        };
        // 50 N/V of 0.15 V less 2.5 N.
        assert!((file.channels[0].to_si(0.15) - 5.0).abs() < 1e-12);
        assert_eq!(file.channels[1].to_si(3.0), 3e5);
    }
}

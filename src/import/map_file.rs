//! The import map's file, read and checked.

use std::path::Path;

use super::encoding;
use super::map::{Clock, FileMap, Form, ImportMap, Separator, TextForm, TimeMap};
use super::stamps::DateOrder;
use super::units;
use crate::recording::Unit;
use crate::scenario::ScenarioError;
use crate::scenario::check::Section;
use crate::scenario::document::{Document, read_text};

mod channels;
mod keys;

use channels::{channel_map, constant, unit};
use keys::{ClockKey, DateOrderKey, FileKeys, FormKey, MapFile, TimeKeys, sections};

/// Version of the format.
const SCHEMA: u32 = 1;
/// Atmosphere where the map says nothing [Pa].
const STANDARD_ATMOSPHERE: f64 = 101_325.0;

/// Reads and checks a map.
///
/// # Errors
/// File, line, column and key of what is wrong, what was found and what was expected.
pub fn load_map(path: &Path) -> Result<ImportMap, ScenarioError> {
    let text = read_text(path)?;
    let document = Document::new(path, &text, SCHEMA)?;
    let keys: MapFile = document.parse(&sections())?;
    let top = Section::new(&document, "");
    let atmosphere = top.number_or(
        "atmosphere_pa",
        keys.atmosphere_pa,
        STANDARD_ATMOSPHERE,
        3e4..=1.2e5,
    )?;
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
    let time = keys
        .time
        .as_ref()
        .map(|time| time_map(document, &table, keys.form, time))
        .transpose()?;
    let says_times = matches!(keys.form, FormKey::Bag | FormKey::Mcap | FormKey::Tdms);
    if time.is_none() && !says_times {
        return Err(section.missing("time", "the column that holds the times, and its unit"));
    }
    if keys.channel.is_empty() {
        return Err(section.missing("channel", "one [[file.channel]] at least"));
    }
    if keys.accept_truncated.is_some() && matches!(keys.form, FormKey::Parquet) {
        let reason = "a Parquet file that is cut off cannot be read at all".to_owned();
        return Err(section.misplaced("accept_truncated", reason));
    }
    if !matches!(keys.form, FormKey::Bag | FormKey::Mcap) {
        for (i, channel) in keys.channel.iter().enumerate() {
            let section = Section::new(document, format!("{table}.channel[{i}]"));
            for (key, given) in [("joint", &channel.joint), ("frame", &channel.frame)] {
                if given.is_some() {
                    return Err(section.misplaced(key, "only a bag's messages have it".to_owned()));
                }
            }
        }
    }
    let channels = keys.channel.iter().enumerate();
    Ok(FileMap {
        path: keys.path.as_ref().map(|path| document.folder().join(path)),
        form: form(&section, keys)?,
        dropped: [
            keys.drop_first_rows.unwrap_or(0),
            keys.drop_last_rows.unwrap_or(0),
        ],
        accepts_truncated: keys.accept_truncated.unwrap_or(false),
        clock: clock(&section, index, keys)?,
        time,
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

fn text_form(section: &Section<'_>, keys: &FileKeys) -> Result<TextForm, ScenarioError> {
    let separator = match (&keys.separator, &keys.field_widths) {
        (Some(_), Some(_)) => {
            let reason = "fields have widths, or something between them".to_owned();
            return Err(section.misplaced("field_widths", reason));
        }
        (None, Some(widths)) if widths.is_empty() || widths.contains(&0) => {
            let expected = "a width of at least 1 for each field".to_owned();
            return Err(section.refuse("field_widths", format!("{widths:?}"), expected));
        }
        (None, Some(widths)) => Separator::Widths(widths.clone()),
        (None, None) if matches!(keys.form, FormKey::Spreadsheet) => Separator::Character(b'\t'),
        (None, None) => Separator::Character(b','),
        (Some(name), None) => match name.as_str() {
            "whitespace" => Separator::Whitespace,
            "tab" => Separator::Character(b'\t'),
            name => {
                let character = single(section, "separator", name, "\"whitespace\" or \"tab\"")?;
                Separator::Character(u8::try_from(character).map_err(|_| {
                    let expected = "a character of ASCII".to_owned();
                    section.refuse("separator", format!("{name:?}"), expected)
                })?)
            }
        },
    };
    let header_lines = keys
        .header_lines
        .unwrap_or(usize::from(keys.names_line.is_some()));
    if let Some(line) = keys.names_line {
        section.count("names_line", line, 1..=header_lines.max(1))?;
    }
    let decimal_mark = match &keys.decimal_mark {
        Some(mark) => single(section, "decimal_mark", mark, "such as \".\" or \",\"")?,
        None => '.',
    };
    if u8::try_from(decimal_mark).is_ok_and(|mark| separator == Separator::Character(mark)) {
        let expected = "another character than between fields".to_owned();
        return Err(section.refuse("decimal_mark", format!("{decimal_mark:?}"), expected));
    }
    let thousands_mark = match &keys.thousands_mark {
        Some(mark) => Some(single(
            section,
            "thousands_mark",
            mark,
            "such as \".\" or \"'\"",
        )?),
        None => None,
    };
    if thousands_mark == Some(decimal_mark) {
        let expected = "another character than `decimal_mark`".to_owned();
        return Err(section.refuse("thousands_mark", format!("{decimal_mark:?}"), expected));
    }
    if let Some(name) = &keys.encoding
        && !encoding::is_known(name)
    {
        let expected =
            "an encoding, such as \"utf-8\", \"windows-1252\", \"utf-16le\" or \"utf-16be\"";
        return Err(section.refuse("encoding", format!("{name:?}"), expected.to_owned()));
    }
    Ok(TextForm {
        encoding: keys.encoding.clone(),
        separator,
        decimal_mark,
        thousands_mark,
        header_lines,
        names_line: keys.names_line,
    })
}

/// A text of one character.
fn single(
    section: &Section<'_>,
    key: &str,
    text: &str,
    besides: &str,
) -> Result<char, ScenarioError> {
    let mut characters = text.chars();
    match (characters.next(), characters.next()) {
        (Some(character), None) => Ok(character),
        _ => Err(section.refuse(
            key,
            format!("{text:?}"),
            format!("one character, {besides}"),
        )),
    }
}

fn clock(section: &Section<'_>, index: usize, keys: &FileKeys) -> Result<Clock, ScenarioError> {
    match keys.clock.unwrap_or(ClockKey::Shared) {
        ClockKey::Shared => {
            for (key, given) in [
                ("aligned_by", keys.aligned_by.is_some()),
                ("largest_offset_s", keys.largest_offset_s.is_some()),
            ] {
                if given {
                    let reason = "the clock is shared; \"unknown\" has it found".to_owned();
                    return Err(section.misplaced(key, reason));
                }
            }
            let offset =
                section.number_or("clock_offset_s", keys.clock_offset_s, 0.0, -1e9..=1e9)?;
            Ok(Clock::Shared { offset })
        }
        ClockKey::Unknown if index == 0 => {
            let reason = "the first file's clock is the recording's".to_owned();
            Err(section.misplaced("clock", reason))
        }
        ClockKey::Unknown => {
            if keys.clock_offset_s.is_some() {
                let reason = "the clock is unknown; \"shared\" has an offset".to_owned();
                return Err(section.misplaced("clock_offset_s", reason));
            }
            let Some(by) = keys.aligned_by.clone() else {
                let expected =
                    "a quantity of the first file and one of this that rise and fall together";
                return Err(section.missing("aligned_by", expected));
            };
            let largest = section.number_or(
                "largest_offset_s",
                keys.largest_offset_s,
                10.0,
                1e-3..=3600.0,
            )?;
            Ok(Clock::Unknown { by, largest })
        }
    }
}

fn time_map(
    document: &Document<'_>,
    table: &str,
    form: FormKey,
    keys: &TimeKeys,
) -> Result<TimeMap, ScenarioError> {
    let section = Section::new(document, format!("{table}.time"));
    if keys.unit.is_none() && matches!(form, FormKey::Mat5) {
        let expected = format!("one of {}", units::of_kind(Unit::Second).join(", "));
        return Err(section.missing("unit", &expected));
    }
    let of_stamps = [
        ("date_column", keys.date_column.is_some()),
        ("date_order", keys.date_order.is_some()),
        ("year", keys.year.is_some()),
    ];
    for (key, given) in [("thousands_mark", keys.thousands_mark.is_some())]
        .into_iter()
        .chain(of_stamps)
    {
        let has_texts = matches!(
            form,
            FormKey::Text | FormKey::Spreadsheet | FormKey::Parquet
        );
        if given && !has_texts {
            return Err(section.misplaced(key, "only a text has it".to_owned()));
        }
    }
    if let Some((key, _)) = of_stamps.into_iter().find(|(_, given)| *given)
        && keys.unit.is_some()
    {
        let reason = "with a `unit` the times are numbers, and no stamps".to_owned();
        return Err(section.misplaced(key, reason));
    }
    if let Some(year) = keys.year {
        section.count("year", year, 1970..=2200)?;
    }
    let mark = |text: &String| single(&section, "thousands_mark", text, "such as \".\" or \"'\"");
    Ok(TimeMap {
        column: keys.column.0.clone(),
        unit: match &keys.unit {
            Some(name) => Some(unit(&section, name, Some(&[Unit::Second]))?),
            None => None,
        },
        thousands_mark: keys.thousands_mark.as_ref().map(mark).transpose()?,
        date_column: keys.date_column.as_ref().map(|column| column.0.clone()),
        date_order: keys.date_order.map(|order| match order {
            DateOrderKey::YearMonthDay => DateOrder::YearMonthDay,
            DateOrderKey::DayMonthYear => DateOrder::DayMonthYear,
            DateOrderKey::MonthDayYear => DateOrder::MonthDayYear,
        }),
        year: keys.year,
    })
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
    use super::*;

    const PAGE: &str = include_str!("../../assets/import/README.md");

    #[test]
    fn the_page_of_maps_names_every_key_and_unit() {
        for (table, keys) in sections() {
            for key in keys {
                assert!(PAGE.contains(&format!("`{key}`")), "{table}: {key}");
            }
        }
        for unit in units::UNITS {
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

//! A log as text: a row a line, fields divided by a character, by white space, or by their widths.

use std::path::Path;

use super::encoding::{DetectedEncoding, decode};
use super::error::ImportError;
use super::map::Separator;
use super::packed::text_bytes;
use crate::file::{Limit, RAISED_BY, megabytes};

mod columns;
mod reading;
mod record;
mod rows;

pub(super) use columns::elements;
pub(super) use record::Record;
pub(super) use rows::{read, read_content};

/// Fields of a row, and bytes of a line, at most.
const MOST_FIELDS: usize = 1 << 16;
const LONGEST: usize = 1_000_000;
/// What a row of few letters takes to be held [byte].
const ROW: u64 = 64;

/// The lines of a text, those before its rows apart.
pub(super) struct Sheet {
    /// Lines before the rows.
    pub header: Vec<String>,
    /// Fields of each row, with its line from 1.
    pub rows: Vec<(u64, Record)>,
    /// Whether the last line ends.
    is_whole: bool,
    /// Fields that the last row holds to their ends.
    last_fields: usize,
}

impl Sheet {
    /// Takes a text apart, or says what the reader cannot.
    pub fn of(
        text: &str,
        header_lines: usize,
        separator: &Separator,
        limit: Limit,
    ) -> Result<Self, String> {
        let (header, body) = split_after(text, header_lines);
        let most = usize::try_from(limit.whole() / ROW).unwrap_or(usize::MAX);
        let rows = records(body, header.len() as u64, separator, most)?;
        let last = rows.last().map_or(0, |(_, row)| row.len());
        Ok(Self {
            // A log that was cut off ends within a field, and what stands of it may be another number.
            last_fields: match separator {
                Separator::Widths(widths) => whole_fields(body, widths),
                _ => last,
            },
            header: header.into_iter().map(str::to_owned).collect(),
            rows,
            is_whole: text.ends_with('\n'),
        })
    }
}

/// A text's content in its encoding, its lines ended alike.
pub(super) fn content(
    path: &Path,
    encoding: Option<&str>,
    limit: Limit,
) -> Result<(String, DetectedEncoding), ImportError> {
    let bytes = text_bytes(path, limit)?;
    let (text, detected) = decode(path, bytes, encoding)?;
    let text = with_like_ends(text);
    let is_long = |line: &str| line.len() > LONGEST;
    if let Some(line) = text.split('\n').position(is_long) {
        return Err(ImportError::Read {
            file: path.to_owned(),
            cause: format!(
                "line {} has more than {}, expected rows of a log",
                line + 1,
                megabytes(LONGEST as u64)
            ),
        });
    }
    Ok((text, detected))
}

/// A text with its lines ended alike. Of a line that ends with two marks, the reader counts the end to the next one.
fn with_like_ends(text: String) -> String {
    if !text.contains('\r') {
        return text;
    }
    let text = text.replace("\r\n", "\n");
    if text.contains('\n') {
        text
    } else {
        text.replace('\r', "\n")
    }
}

/// The fields of one line.
pub(super) fn fields(line: &str, separator: &Separator) -> Vec<String> {
    let records = records(line, 0, separator, usize::MAX).unwrap_or_default();
    let first = records.into_iter().next();
    first.map_or_else(Vec::new, |(_, record)| {
        record.iter().map(str::to_owned).collect()
    })
}

/// Fields that the last line holds to their ends; all of them if it is as long as the first.
fn whole_fields(body: &str, widths: &[usize]) -> usize {
    let mut filled = body.lines().filter(|line| !line.trim().is_empty());
    let first = filled.next().map_or(0, |line| line.chars().count());
    let last = filled
        .next_back()
        .map_or(first, |line| line.chars().count());
    if last >= first {
        return widths.len();
    }
    let mut end = 0;
    let reaches = |width: &&usize| {
        end += **width;
        end <= last
    };
    widths.iter().take_while(reaches).count()
}

/// A text's first lines, and what follows them.
fn split_after(text: &str, count: usize) -> (Vec<&str>, &str) {
    let mut rest = text;
    let mut lines = Vec::new();
    while lines.len() < count && !rest.is_empty() {
        let (line, after) = rest.split_once('\n').unwrap_or((rest, ""));
        lines.push(line);
        rest = after;
    }
    (lines, rest)
}

/// The fields of each line that has any, with its number from 1, that many lines standing before; of `most` such lines at most.
fn records(
    text: &str,
    before: u64,
    separator: &Separator,
    most: usize,
) -> Result<Vec<(u64, Record)>, String> {
    let push = |rows: &mut Vec<_>, line: u64, record: Record| {
        if rows.len() == most {
            return Err(format!("it has more than {most} rows; {RAISED_BY}"));
        }
        rows.push((line, few(line, record)?));
        Ok(())
    };
    let plain = |split: &dyn Fn(&str) -> Record| {
        let lines = (before + 1..).zip(text.lines());
        let filled = lines.filter(|(_, line)| !line.trim().is_empty());
        let mut rows = Vec::new();
        for (line, text) in filled {
            push(&mut rows, line, split(text))?;
        }
        Ok(rows)
    };
    match separator {
        Separator::Character(character) => {
            let mut reader = csv::ReaderBuilder::new()
                .delimiter(*character)
                .has_headers(false)
                .flexible(true)
                .trim(csv::Trim::All)
                .from_reader(text.as_bytes());
            let mut record = csv::StringRecord::new();
            let mut rows = Vec::new();
            while reader.read_record(&mut record).map_err(|e| e.to_string())? {
                let line = before + record.position().map_or(0, csv::Position::line);
                push(&mut rows, line, Record::of(record.iter()))?;
            }
            Ok(rows)
        }
        Separator::Whitespace => plain(&|line| Record::of(line.split_whitespace())),
        Separator::Widths(widths) => plain(&|line| Record::of(cut(line, widths).into_iter())),
    }
}

/// Refuses a row of more fields than any log has.
fn few(line: u64, record: Record) -> Result<Record, String> {
    match record.len() {
        0..=MOST_FIELDS => Ok(record),
        found => Err(format!(
            "line {line} has {found} fields, expected {MOST_FIELDS} at most"
        )),
    }
}

/// The fields of a line, each of a width in characters.
fn cut<'a>(line: &'a str, widths: &[usize]) -> Vec<&'a str> {
    let mut rest = line;
    let field = |width: &usize| {
        let end = rest.char_indices().nth(*width);
        let (field, after) = rest.split_at(end.map_or(rest.len(), |(at, _)| at));
        rest = after;
        field.trim()
    };
    widths.iter().map(field).collect()
}

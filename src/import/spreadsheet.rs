//! A sheet of a spreadsheet (xlsx, xlsb, xls, ods) as the text that it would be exported as: a row a line, tabs between its cells, dates and times as stamps. The rest is the reader of texts.

use std::io::Cursor;
use std::path::Path;

use calamine::{
    Data, DataRef, ExcelDateTime, ExcelDateTimeType, Range, Reader, Sheets,
    open_workbook_auto_from_rs,
};

use super::error::ImportError;
use super::rows::nearest_first;
use super::signature;
use crate::file::{self, Limit, guarded};

mod archive;

/// Bytes of a cell, with its place.
const CELL: u64 = 24;
/// A day, in which serial dates count [us].
const DAY: i64 = 86_400_000_000;

/// A sheet as text.
pub(super) struct SheetText {
    /// Its name.
    pub name: String,
    /// Names of the others that hold anything.
    pub others: Vec<String>,
    /// Its text.
    pub text: String,
}

/// Reads the sheet of a name, without one the only sheet that holds anything; its numbers get the mark that the map says of its texts.
///
/// # Errors
/// No spreadsheet, no such sheet, several to choose from.
pub(super) fn read(
    path: &Path,
    name: Option<&str>,
    decimal_mark: char,
    limit: Limit,
) -> Result<SheetText, ImportError> {
    let mut sheets = open(path, limit)?;
    let names = sheets.sheet_names();
    let chosen = match name {
        Some(name) if names.iter().any(|own| own == name) => name.to_owned(),
        Some(name) => {
            let there = nearest_first(name, &names);
            return Err(fail(
                path,
                format!("it has no sheet `{name}`; there are {there}"),
            ));
        }
        None => only(path, filled(path, &mut sheets, &names, limit)?)?,
    };
    let range = range(path, &mut sheets, &chosen, limit)?;
    Ok(SheetText {
        name: chosen,
        others: Vec::new(),
        text: text(&range, is_1904(&sheets), decimal_mark),
    })
}

/// The only one of the sheets that hold anything.
fn only(path: &Path, mut filled: Vec<(String, usize)>) -> Result<String, ImportError> {
    if filled.len() > 1 {
        let listed: Vec<String> = filled.iter().map(|(name, _)| format!("`{name}`")).collect();
        let cause = format!(
            "its sheets {} all hold something; `sheet` in the map's [[file]] says which is meant",
            listed.join(", ")
        );
        return Err(fail(path, cause));
    }
    match filled.pop() {
        Some((name, _)) => Ok(name),
        None => Err(fail(path, "its sheets are empty".to_owned())),
    }
}

/// The sheet with the most numbers.
///
/// # Errors
/// No spreadsheet, or none of its sheets holds anything.
pub(super) fn likely(path: &Path, limit: Limit) -> Result<SheetText, ImportError> {
    let mut sheets = open(path, limit)?;
    let names = sheets.sheet_names();
    let filled = filled(path, &mut sheets, &names, limit)?;
    // The first of those with as many.
    let best = filled.iter().rev().max_by_key(|(_, numbers)| *numbers);
    let Some((name, _)) = best else {
        return Err(fail(path, "its sheets are empty".to_owned()));
    };
    let others = filled.iter().filter(|(other, _)| other != name);
    let range = range(path, &mut sheets, name, limit)?;
    Ok(SheetText {
        others: others.map(|(other, _)| other.clone()).collect(),
        text: text(&range, is_1904(&sheets), '.'),
        name: name.clone(),
    })
}

type Workbook = Sheets<Cursor<Vec<u8>>>;

fn fail(path: &Path, cause: String) -> ImportError {
    ImportError::Read {
        file: path.to_owned(),
        cause,
    }
}

fn open(path: &Path, limit: Limit) -> Result<Workbook, ImportError> {
    signature::check(path, "spreadsheet", "a spreadsheet")?;
    let bytes = file::read_up_to(path, limit.whole());
    let bytes = bytes.map_err(|cause| fail(path, cause.to_string()))?;
    let most = limit.unpacked(bytes.len() as u64);
    if archive::unpacked_size(&bytes, most) > most || archive::cells_of_ods(&bytes, most) > most {
        return Err(too_much(path, bytes.len() as u64, limit));
    }
    let opened = guarded(|| open_workbook_auto_from_rs(Cursor::new(bytes)));
    opened.ok().and_then(Result::ok).ok_or_else(|| {
        fail(
            path,
            "it is no spreadsheet that can be read (xlsx, xlsb, xls, ods), or has a password; export its sheet as CSV".to_owned(),
        )
    })
}

fn too_much(path: &Path, size: u64, limit: Limit) -> ImportError {
    let refusal = limit.refusal(size, limit.unpacked(size));
    fail(path, format!("{refusal}; or export its sheet as CSV"))
}

/// Sheets that hold anything, with how many numbers.
fn filled(
    path: &Path,
    sheets: &mut Workbook,
    names: &[String],
    limit: Limit,
) -> Result<Vec<(String, usize)>, ImportError> {
    let mut found = Vec::new();
    for name in names {
        let range = range(path, sheets, name, limit)?;
        let is_number = |data: &&Data| {
            matches!(
                data,
                Data::Int(_) | Data::Float(_) | Data::DateTime(_) | Data::DateTimeIso(_)
            )
        };
        let cells = || range.used_cells().map(|(_, _, data)| data);
        if cells().next().is_some() {
            found.push((name.clone(), cells().filter(is_number).count()));
        }
    }
    Ok(found)
}

fn range(
    path: &Path,
    sheets: &mut Workbook,
    name: &str,
    limit: Limit,
) -> Result<Range<Data>, ImportError> {
    let cannot = |cause: String| fail(path, format!("its sheet `{name}` cannot be read: {cause}"));
    check_extent(path, sheets, name, limit)?;
    let range = guarded(|| sheets.worksheet_range(name)).map_err(cannot)?;
    range.map_err(|cause| cannot(cause.to_string()))
}

/// Measures a sheet's cells one by one: those of a table go to the last row and column, and a text may be that of many.
macro_rules! extent {
    ($workbook:expr, $name:expr, $most:expr, $no_sheet:pat) => {{
        let mut extent = Extent::default();
        match $workbook.worksheet_cells_reader($name) {
            // A chart has no cells.
            Err($no_sheet) => Ok(extent),
            Err(cause) => Err(cause.to_string()),
            Ok(mut cells) => loop {
                match cells.next_cell() {
                    Ok(Some(cell)) => extent.take(cell.get_position(), cell.get_value()),
                    Ok(None) => break Ok(extent),
                    Err(cause) => break Err(cause.to_string()),
                }
                if extent.bytes() > $most {
                    break Ok(extent);
                }
            },
        }
    }};
}

/// How far a sheet's cells go, and what their texts come to.
#[derive(Debug, Default)]
struct Extent {
    rows: u64,
    columns: u64,
    texts: u64,
}

impl Extent {
    fn take(&mut self, (row, column): (u32, u32), value: &DataRef<'_>) {
        self.rows = self.rows.max(u64::from(row) + 1);
        self.columns = self.columns.max(u64::from(column) + 1);
        self.texts += match value {
            DataRef::String(text) => text.len() as u64,
            DataRef::SharedString(text) => text.len() as u64,
            _ => 0,
        };
    }

    fn bytes(&self) -> u64 {
        CELL * self.rows * self.columns + self.texts
    }
}

/// Refuses a sheet whose cells stand too far apart to be kept as a table, or hold too much.
fn check_extent(
    path: &Path,
    sheets: &mut Workbook,
    name: &str,
    limit: Limit,
) -> Result<(), ImportError> {
    let most = limit.whole();
    let extent = guarded(|| match sheets {
        Sheets::Xlsx(workbook) => {
            extent!(workbook, name, most, calamine::XlsxError::NotAWorksheet(_))
        }
        Sheets::Xlsb(workbook) => {
            extent!(
                workbook,
                name,
                most,
                calamine::XlsbError::WorksheetNotFound(_)
            )
        }
        // Of xls the rows are few; of ods they were counted.
        _ => Ok(Extent::default()),
    });
    let cannot = |cause: String| fail(path, format!("its sheet `{name}` cannot be read: {cause}"));
    let extent = extent.and_then(|extent| extent).map_err(cannot)?;
    if extent.bytes() <= most {
        return Ok(());
    }
    let (rows, columns) = (extent.rows, extent.columns);
    Err(fail(
        path,
        format!(
            "its sheet `{name}` goes to row {rows} and column {columns} and comes to more than {}, expected a log: delete what stands far off, or export the log as CSV; {}",
            file::megabytes(most),
            file::RAISED_BY
        ),
    ))
}

fn is_1904(sheets: &Workbook) -> bool {
    match sheets {
        Sheets::Xlsx(workbook) => workbook.has_1904_epoch(),
        _ => false,
    }
}

/// A sheet's rows as lines, from its first row on, so that a line is a row; empty ones are empty lines.
fn text(range: &Range<Data>, is_1904: bool, decimal_mark: char) -> String {
    let (first_row, first_column) = range.start().unwrap_or_default();
    let mut text = "\n".repeat(first_row as usize);
    for row in range.rows() {
        let cells: Vec<String> = row
            .iter()
            .map(|data| cell(data, is_1904, decimal_mark))
            .collect();
        if cells.iter().any(|cell| !cell.is_empty()) {
            text += &"\t".repeat(first_column as usize);
            text += &cells.join("\t");
        }
        text.push('\n');
    }
    text
}

/// A cell as a field.
fn cell(data: &Data, is_1904: bool, decimal_mark: char) -> String {
    match data {
        Data::Empty => String::new(),
        Data::Int(number) => number.to_string(),
        Data::Float(number) => number.to_string().replace('.', &decimal_mark.to_string()),
        Data::Bool(true) => "TRUE".to_owned(),
        Data::Bool(false) => "FALSE".to_owned(),
        Data::DateTime(stamp) => serial(*stamp, is_1904),
        Data::DateTimeIso(stamp) => quoted(stamp),
        // `PT1H2M3.5S`, as controllers write it.
        Data::DurationIso(text) => quoted(&match text.strip_prefix("PT") {
            Some(duration) => format!("T#{}", duration.to_lowercase()),
            None => text.clone(),
        }),
        // What cannot be computed is no value.
        Data::Error(_) => String::new(),
        Data::String(text) => quoted(text),
    }
}

/// A text as a field of one line.
fn quoted(text: &str) -> String {
    let text: String = text
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if text.contains('"') {
        return format!("\"{}\"", text.replace('"', "\"\""));
    }
    text
}

/// A serial date, a time of the day or a duration, to the microsecond: more its double does not hold.
fn serial(stamp: ExcelDateTime, is_1904: bool) -> String {
    let days = stamp.as_f64();
    let total = (days * DAY as f64).round() as i64;
    if stamp.is_duration() {
        return format!("T#{}s", total as f64 * 1e-6);
    }
    let time = |total: i64| {
        let second = total / 1_000_000;
        format!(
            "{:02}:{:02}:{:02}.{:06}",
            second / 3600,
            second / 60 % 60,
            second % 60,
            total % 1_000_000
        )
    };
    if (0..DAY).contains(&total) {
        return time(total);
    }
    let day = ExcelDateTime::new(
        total.div_euclid(DAY) as f64,
        ExcelDateTimeType::DateTime,
        is_1904,
    );
    let (year, month, day, ..) = day.to_ymd_hms_milli();
    format!(
        "{year:04}-{month:02}-{day:02} {}",
        time(total.rem_euclid(DAY))
    )
}

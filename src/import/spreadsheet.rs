//! A sheet of a spreadsheet (xlsx, xlsb, xls, ods) as the text that it would be exported as: a row a line, tabs between its cells, dates and times as stamps. The rest is the reader of texts.

use std::io::Cursor;
use std::path::Path;

use calamine::{
    Data, ExcelDateTime, ExcelDateTimeType, Range, Reader, Sheets, open_workbook_auto_from_rs,
};

use super::error::ImportError;
use super::packed::LARGEST_FILE;
use super::rows::nearest_first;
use super::signature;

/// Cells that are read of a sheet, at most.
const MOST_CELLS: usize = 1 << 26;
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
) -> Result<SheetText, ImportError> {
    let mut sheets = open(path)?;
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
        None => only(path, filled(path, &mut sheets, &names)?)?,
    };
    let range = range(path, &mut sheets, &chosen)?;
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
pub(super) fn likely(path: &Path) -> Result<SheetText, ImportError> {
    let mut sheets = open(path)?;
    let names = sheets.sheet_names();
    let filled = filled(path, &mut sheets, &names)?;
    // The first of those with as many.
    let best = filled.iter().rev().max_by_key(|(_, numbers)| *numbers);
    let Some((name, _)) = best else {
        return Err(fail(path, "its sheets are empty".to_owned()));
    };
    let others = filled.iter().filter(|(other, _)| other != name);
    let range = range(path, &mut sheets, name)?;
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

fn open(path: &Path) -> Result<Workbook, ImportError> {
    signature::check(path, "spreadsheet", "a spreadsheet")?;
    let bytes = std::fs::read(path).map_err(|cause| fail(path, cause.to_string()))?;
    if unpacked_size(&bytes) > LARGEST_FILE {
        let cause = format!(
            "it comes to more than {} MB unpacked; export its sheet as CSV",
            LARGEST_FILE >> 20
        );
        return Err(fail(path, cause));
    }
    open_workbook_auto_from_rs(Cursor::new(bytes)).map_err(|_| {
        fail(
            path,
            "it is no spreadsheet that can be read (xlsx, xlsb, xls, ods), or has a password; export its sheet as CSV".to_owned(),
        )
    })
}

/// What the members of a zip archive come to, as its directory says (PKWARE, APPNOTE 4.3.12) [B].
fn unpacked_size(bytes: &[u8]) -> u64 {
    const ENTRY: &[u8] = b"PK\x01\x02";
    const SIZE: std::ops::Range<usize> = 24..28;
    let mut sum = 0;
    let mut rest = bytes;
    while let Some(at) = rest.windows(ENTRY.len()).position(|window| window == ENTRY) {
        rest = &rest[at..];
        if let Some(&[a, b, c, d]) = rest.get(SIZE) {
            sum += u64::from(u32::from_le_bytes([a, b, c, d]));
        }
        rest = &rest[ENTRY.len()..];
    }
    sum
}

/// Sheets that hold anything, with how many numbers.
fn filled(
    path: &Path,
    sheets: &mut Workbook,
    names: &[String],
) -> Result<Vec<(String, usize)>, ImportError> {
    let mut found = Vec::new();
    for name in names {
        let range = range(path, sheets, name)?;
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

fn range(path: &Path, sheets: &mut Workbook, name: &str) -> Result<Range<Data>, ImportError> {
    if let Sheets::Xlsx(workbook) = sheets {
        check_extent(path, workbook, name)?;
    }
    let range = sheets.worksheet_range(name);
    range.map_err(|cause| fail(path, format!("its sheet `{name}` cannot be read: {cause}")))
}

/// Refuses a sheet whose cells stand too far apart to be kept as a table.
fn check_extent(
    path: &Path,
    workbook: &mut calamine::Xlsx<Cursor<Vec<u8>>>,
    name: &str,
) -> Result<(), ImportError> {
    let cannot = |cause: calamine::XlsxError| {
        fail(path, format!("its sheet `{name}` cannot be read: {cause}"))
    };
    let mut cells = match workbook.worksheet_cells_reader(name) {
        // A chart has no cells.
        Err(calamine::XlsxError::NotAWorksheet(_)) => return Ok(()),
        read => read.map_err(cannot)?,
    };
    let (mut rows, mut columns) = (0, 0);
    while let Some(cell) = cells.next_cell().map_err(cannot)? {
        let (row, column) = cell.get_position();
        rows = rows.max(row as usize + 1);
        columns = columns.max(column as usize + 1);
        if rows * columns > MOST_CELLS {
            let cause = format!(
                "its sheet `{name}` goes to row {rows} and column {columns}, more than can be a log; delete what stands far off, or export the log as CSV"
            );
            return Err(fail(path, cause));
        }
    }
    Ok(())
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

//! The marks of a text's numbers: what stands before the decimals, and before every third digit.

use std::path::Path;

use super::seen::Because;
use crate::import::error::ImportError;
use crate::import::map::Column;
use crate::import::numbers::{self, Marks};
use crate::import::text::Sheet;

/// A number that shows a mark: its line, its text.
type Shown<'a> = Option<(u64, &'a str)>;

/// Marks that the numbers of a text show.
struct Found<'a> {
    /// The first number of each column with a decimal point, and with a decimal comma.
    decimals: Vec<[Shown<'a>; 2]>,
    /// A mark of thousands for certain.
    grouped: Option<char>,
    /// A mark of either.
    open: Option<char>,
    /// Whether a column has both numbers with that mark and, of three digits and more, without: 999 before 1.000.
    mixed: bool,
}

impl<'a> Found<'a> {
    fn new(sheet: &'a Sheet, of_numbers: &[bool]) -> Self {
        let mut found = Self {
            decimals: vec![[None; 2]; of_numbers.len()],
            grouped: None,
            open: None,
            mixed: false,
        };
        let mut kinds = vec![[false; 2]; of_numbers.len()];
        for (line, row) in &sheet.rows {
            for (place, field) in row.iter().enumerate().take(of_numbers.len()) {
                if !of_numbers[place] {
                    continue;
                }
                let decimal = match numbers::seen(field) {
                    numbers::Seen::Decimal(mark) => Some(mark),
                    numbers::Seen::Grouped(mark, decimal) => {
                        found.grouped = Some(mark);
                        decimal
                    }
                    numbers::Seen::Open(mark) => {
                        found.open = Some(mark);
                        kinds[place][0] = true;
                        None
                    }
                    numbers::Seen::Plain => {
                        kinds[place][1] = true;
                        None
                    }
                    numbers::Seen::Other => None,
                };
                if let Some(mark) = decimal {
                    let slot = &mut found.decimals[place][usize::from(mark == ',')];
                    *slot = slot.or(Some((*line, field)));
                }
            }
        }
        found.mixed = kinds.contains(&[true; 2]);
        found
    }
}

/// Decimal and thousands marks of all columns of numbers together, how sure they are, and what to ask where they may be either.
///
/// # Errors
/// Decimal marks of both kinds.
pub(super) fn marks(
    path: &Path,
    sheet: &Sheet,
    of_numbers: &[bool],
) -> Result<(Marks, Because, Option<String>), ImportError> {
    let found = Found::new(sheet, of_numbers);
    check_alike(path, sheet, &found.decimals)?;
    let decimals: [Shown<'_>; 2] =
        [0, 1].map(|mark| found.decimals.iter().find_map(|column| column[mark]));
    let known = |mark: char| match mark {
        '.' => decimals[0],
        ',' => decimals[1],
        _ => None,
    };
    let other = |mark: char| if mark == '.' { ',' } else { '.' };
    let only = decimals
        .iter()
        .position(Option::is_some)
        .map(|at| ['.', ','][at]);
    let marks = |decimal: char, thousands: Option<char>| Marks { decimal, thousands };
    let seen = |mark: char| {
        let (line, field) = known(mark).unwrap_or((0, ""));
        Because::certain(format!("`{field}` in line {line}"))
    };
    let mut question = None;
    let (marks, because) = match (only, found.grouped, found.open) {
        (Some(decimal), grouped, _) if grouped.is_some() => {
            (marks(decimal, grouped), seen(decimal))
        }
        (Some(decimal), _, Some(mark)) if mark != decimal => {
            (marks(decimal, Some(mark)), seen(decimal))
        }
        (Some(decimal), ..) => (marks(decimal, None), seen(decimal)),
        (None, Some(mark), _) => (
            marks(
                if ".,".contains(mark) {
                    other(mark)
                } else {
                    '.'
                },
                Some(mark),
            ),
            Because::likely("no number has decimals"),
        ),
        (None, None, Some(mark)) if found.mixed => (
            marks(other(mark), Some(mark)),
            Because::likely(format!(
                "`{mark}` stands before three digits and in large numbers alone"
            )),
        ),
        (None, None, Some(mark)) => {
            let why = format!("every number has `{mark}` before three digits");
            question = Some(format!(
                "{why}: {mark:?} where these are decimals; where it marks thousands {:?}, and `thousands_mark = {:?}`",
                other(mark).to_string(),
                mark.to_string()
            ));
            (marks(mark, None), Because::likely(why))
        }
        (None, None, None) => (marks('.', None), Because::likely("no number has decimals")),
    };
    Ok((marks, because, question))
}

/// Refuses decimal marks of both kinds, in one column or in two.
fn check_alike(path: &Path, sheet: &Sheet, all: &[[Shown<'_>; 2]]) -> Result<(), ImportError> {
    let refuse = |place: usize, line: u64, found: &str, expected: String| ImportError::Number {
        file: path.to_owned(),
        line,
        column: Column::Number(place + 1),
        found: found.to_owned(),
        expected,
    };
    let marks = |decimal| Marks {
        decimal,
        thousands: None,
    };
    for (place, column) in all.iter().enumerate() {
        if let [Some(point), Some(comma)] = column {
            // The mark that comes first counts.
            let (decimal, (line, field)) = if point < comma {
                ('.', *comma)
            } else {
                (',', *point)
            };
            let rows = sheet.rows.iter();
            let fields = rows.filter_map(|(line, row)| Some((*line, row.get(place)?)));
            let expected = numbers::expected(field, line, marks(decimal), fields);
            return Err(refuse(place, line, field, expected));
        }
    }
    let first = |mark: usize| {
        let mut columns = all.iter().enumerate();
        columns.find_map(|(place, column)| Some((place, column[mark]?)))
    };
    match (first(0), first(1)) {
        (Some((point, (_, its))), Some((place, (line, field)))) => {
            let expected = format!(
                "the decimal mark of column {}, `{its}`: `decimal_mark` can name one for the log; write one of the columns with the other's mark",
                point + 1
            );
            Err(refuse(place, line, field, expected))
        }
        _ => Ok(()),
    }
}

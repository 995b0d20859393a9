//! Numbers of a text log: decimal mark, marks before every third digit, words for on and off; and what a column's fields tell of its marks.

use super::words;

/// Words that stand for no value.
const NOTHING: [&str; 22] = [
    "",
    "nan",
    "-nan",
    "+nan",
    "na",
    "n/a",
    "#n/a",
    "#nv",
    "#n/v",
    "null",
    "none",
    "-",
    "--",
    "---",
    "–",
    "—",
    "nan(ind)",
    "-nan(ind)",
    "1.#qnan",
    "-1.#ind",
    "<na>",
    "nat",
];
/// Spaces that stand before every third digit.
const SPACES: [char; 5] = [' ', '\u{a0}', '\u{202f}', '\u{2009}', '\u{2007}'];
/// Minus signs of typesetters, which spreadsheets and browsers copy: U+2212, the dash, the small and the wide sign.
const MINUS: [char; 4] = ['\u{2212}', '\u{2013}', '\u{fe63}', '\u{ff0d}'];

/// Marks in numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Marks {
    /// Before the decimals.
    pub decimal: char,
    /// Before every third digit of whole numbers, if there is one.
    pub thousands: Option<char>,
}

/// Signs in a field of the marks of its column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Seen {
    /// No number.
    Other,
    /// A number without marks.
    Plain,
    /// A mark before decimals.
    Decimal(char),
    /// A mark before every third digit, and one before decimals where there are any.
    Grouped(char, Option<char>),
    /// A mark before three digits, which may be either: `1.000`.
    Open(char),
}

/// Whether a field stands for no value.
pub(super) fn is_nothing(field: &str) -> bool {
    NOTHING.contains(&field.to_ascii_lowercase().as_str())
}

impl Marks {
    /// The number of a field, NaN where it stands for no value.
    pub fn number(self, field: &str) -> Option<f64> {
        if is_nothing(field) {
            return Some(f64::NAN);
        }
        let number = self.parse(field)?;
        Some(number)
    }

    /// As [`Marks::number`], of a column that may be of two states.
    pub fn number_or_word(self, field: &str) -> Option<f64> {
        self.number(field).or_else(|| words::of_word(field))
    }

    fn parse(self, field: &str) -> Option<f64> {
        let field = &*with_plain_minus(field);
        // What Rust reads beside numbers, `inf` and `infinity`, is no reading.
        if !field.contains(|c: char| c.is_ascii_digit()) {
            return None;
        }
        if self.decimal == '.' && self.thousands.is_none() {
            return field.parse().ok();
        }
        let (whole, decimals) = match field.split_once(self.decimal) {
            Some((whole, decimals)) => (whole, Some(decimals)),
            None => (field, None),
        };
        let plain = match self.thousands {
            Some(mark) => ungrouped(whole, mark)?,
            None => whole.to_owned(),
        };
        let text = match decimals {
            Some(decimals) if decimals.contains(['.', ',']) => return None,
            Some(decimals) => format!("{plain}.{decimals}"),
            None if self.decimal != '.' && plain.contains('.') => return None,
            None => plain,
        };
        text.parse().ok()
    }
}

/// A field whose minus signs are those of ASCII.
fn with_plain_minus(field: &str) -> std::borrow::Cow<'_, str> {
    if field.is_ascii() || !field.contains(MINUS) {
        return field.into();
    }
    field.replace(MINUS, "-").into()
}

/// Whether a mark is one of the spaces.
pub(super) fn is_space(mark: char) -> bool {
    SPACES.contains(&mark)
}

/// A whole number without the marks before every third digit; none where they stand elsewhere.
fn ungrouped(whole: &str, mark: char) -> Option<String> {
    let is_mark = |c: char| c == mark || (SPACES.contains(&mark) && SPACES.contains(&c));
    let mut groups = whole.split(is_mark);
    let mut plain = groups.next()?.to_owned();
    let first = plain.trim_start_matches(['+', '-']).len();
    let mut is_grouped = false;
    for group in groups {
        let digits = group.len() == 3 && group.bytes().all(|byte| byte.is_ascii_digit());
        if !digits {
            return None;
        }
        is_grouped = true;
        plain += group;
    }
    (!is_grouped || (1..=3).contains(&first)).then_some(plain)
}

/// Signs of marks in a field.
pub(super) fn seen(field: &str) -> Seen {
    let field = with_plain_minus(field);
    let body = field.trim().trim_start_matches(['+', '-']);
    let (mantissa, exponent) = match body.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, Some(exponent)),
        None => (body, None),
    };
    let is_exponent = |text: &str| {
        let digits = text.trim_start_matches(['+', '-']);
        !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
    };
    if exponent.is_some_and(|text| !is_exponent(text)) {
        return Seen::Other;
    }
    let is_mark = |c: char| ".,'’".contains(c) || SPACES.contains(&c);
    if !mantissa.chars().all(|c| c.is_ascii_digit() || is_mark(c))
        || !mantissa.contains(|c: char| c.is_ascii_digit())
    {
        return Seen::Other;
    }
    let marks: Vec<char> = mantissa.chars().filter(|c| is_mark(*c)).collect();
    let Some((&last, before)) = marks.split_last() else {
        return Seen::Plain;
    };
    let is_decimal = |mark: char| ".,".contains(mark);
    if let Some(&first) = before.first() {
        let all_same = before.iter().all(|mark| *mark == first);
        let decimal = (last != first).then_some(last);
        let whole = match decimal {
            Some(decimal) => mantissa.split(decimal).next().unwrap_or(mantissa),
            None => mantissa,
        };
        let fits = all_same && decimal.is_none_or(is_decimal) && ungrouped(whole, first).is_some();
        return if fits {
            Seen::Grouped(first, decimal)
        } else {
            Seen::Other
        };
    }
    if !is_decimal(last) {
        let fits = ungrouped(mantissa, last).is_some();
        return if fits {
            Seen::Grouped(last, None)
        } else {
            Seen::Other
        };
    }
    let (whole, decimals) = mantissa.split_once(last).unwrap_or((mantissa, ""));
    let may_be_grouped = decimals.len() == 3
        && (1..=3).contains(&whole.len())
        && !whole.starts_with('0')
        && mantissa.len() == body.len();
    if may_be_grouped {
        Seen::Open(last)
    } else {
        Seen::Decimal(last)
    }
}

/// The right form of a field that is no number with these marks, by what the other fields of its column, with their lines, tell.
pub(super) fn expected<'a>(
    field: &str,
    line: u64,
    marks: Marks,
    column: impl Iterator<Item = (u64, &'a str)>,
) -> String {
    let mut decimals: [Option<(u64, &str)>; 2] = [None; 2];
    let mut grouped = None;
    for (own, text) in column {
        let decimal = match seen(text) {
            Seen::Decimal(mark) => Some(mark),
            Seen::Grouped(mark, decimal) => {
                grouped = grouped.or(Some((mark, text, decimal)));
                decimal
            }
            Seen::Open(_) | Seen::Plain | Seen::Other => None,
        };
        if let Some(mark) = decimal {
            let slot = &mut decimals[usize::from(mark == ',')];
            *slot = slot.or(Some((own, text)));
        }
    }
    let other = if marks.decimal == '.' { ',' } else { '.' };
    match (seen(field), decimals, grouped) {
        (Seen::Other, ..) => "a number".to_owned(),
        (_, [Some(point), Some(comma)], _) => {
            let (first, its) = if marks.decimal == ',' { comma } else { point };
            let right = field.replace(other, &marks.decimal.to_string());
            format!(
                "`{}` before the decimals as in `{its}` of line {first}: the column mixes both marks, and `decimal_mark` can name one; \
                 write line {line} as `{right}`, and the others like it, in the log",
                marks.decimal
            )
        }
        (_, _, Some((mark, text, decimal))) if marks.thousands != Some(mark) => {
            let decimal = decimal.filter(|decimal| *decimal != marks.decimal);
            let also =
                decimal.map_or_else(String::new, |d| format!("`decimal_mark = \"{d}\"` and "));
            format!("a number; {also}`thousands_mark = \"{mark}\"` read numbers such as `{text}`")
        }
        (_, [None, Some(_)], _) if marks.decimal == '.' => better(other),
        (_, [Some(_), None], _) if marks.decimal == ',' => better(other),
        (Seen::Open(mark), ..) if mark == other => {
            let whole = field.replace(mark, "");
            let point = field.replace(mark, ".");
            format!(
                "a number, and nothing in the column tells what `{mark}` is: `thousands_mark = \"{mark}\"` makes {whole} of it, `decimal_mark = \"{mark}\"` makes {point}"
            )
        }
        _ => "a number".to_owned(),
    }
}

fn better(mark: char) -> String {
    format!("a number; with `decimal_mark = \"{mark}\"` it would be one")
}

#[cfg(test)]
mod tests;

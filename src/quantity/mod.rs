//! Numbers with their units as people read them: in the terminal, on a page, in the viewer's text; and bounds on a share that was counted.
//!
//! One rule, which docs/METRICS.md states: four significant digits at most, none of them finer than the resolution of the unit, which is below what the
//! sensors of such a cell resolve. What is not zero but finer than that is `<0.001`. Files keep every digit.

pub mod binomial;
pub mod display_name;

/// Significant digits at most; forces near the desired one differ in the fourth.
pub const DIGITS: usize = 4;
/// Orders of magnitude that are written without a power of ten.
const PLAIN: std::ops::Range<i32> = -4..7;
/// Stands for a value that is not known.
pub const UNKNOWN: &str = "–";

/// Decimals at most of a number in each unit; in any other unit the significant digits alone decide.
const DECIMALS: [(&str, usize); 16] = [
    ("N", 3),
    ("N m", 3),
    ("N/bar", 2),
    ("N/mm", 3),
    ("bar", 3),
    ("bar gauge", 3),
    ("bar absolute", 3),
    ("mbar", 1),
    ("mm", 3),
    ("µm", 1),
    ("mm/s", 2),
    ("m/s", 3),
    ("m/s2", 3),
    ("s", 3),
    ("%", 3),
    ("l", 3),
];

/// A number in a unit, without the unit.
#[must_use]
pub fn number(value: f64, unit: &str) -> String {
    let known = DECIMALS.iter().find(|(name, _)| *name == unit);
    match known {
        Some((_, most)) => limited(value, *most),
        None => significant(value, DIGITS),
    }
}

/// A number in a unit, with the unit: `0.312 %`.
#[must_use]
pub fn with_unit(value: f64, unit: &str) -> String {
    match unit {
        "" => number(value, unit),
        _ => format!("{} {unit}", number(value, unit)),
    }
}

/// As [`number`], or a dash.
#[must_use]
pub fn optional(value: Option<f64>, unit: &str) -> String {
    value.map_or_else(|| UNKNOWN.to_owned(), |value| number(value, unit))
}

/// As [`optional`]; a share that falls short of the whole does not read as the whole.
#[must_use]
pub fn metric(value: Option<f64>, unit: &str) -> String {
    match value {
        Some(value) if unit == "%" && (99.995..100.0).contains(&value) => "<100".to_owned(),
        value => optional(value, unit),
    }
}

/// Numbers of a column in one unit, with as many decimals for all as the largest of them has.
#[must_use]
pub fn column(values: &[Option<f64>], unit: &str) -> Vec<String> {
    let known = DECIMALS.iter().find(|(name, _)| *name == unit);
    let sizes = values.iter().flatten().map(|value| value.abs());
    let largest = sizes.filter(|size| size.is_finite()).fold(0.0, f64::max);
    let decimals = decimals(largest, DIGITS).min(known.map_or(DIGITS, |(_, most)| *most));
    let text = |value: &Option<f64>| match value {
        Some(value) => rounded(*value, decimals),
        None => UNKNOWN.to_owned(),
    };
    values.iter().map(text).collect()
}

/// A number rounded to so many significant digits.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    if !PLAIN.contains(&order(value, digits)) {
        return power_of_ten(value);
    }
    let rounded: f64 = format!("{value:.*e}", digits.saturating_sub(1))
        .parse()
        .unwrap_or(value);
    format!("{rounded:.*}", decimals(value, digits))
}

/// A change in percent with its sign; one that would read as none is `<0.1 %`.
#[must_use]
pub fn change(percent: f64) -> String {
    match percent {
        0.0 => "0 %".to_owned(),
        p if p.abs() < 0.05 => "<0.1 %".to_owned(),
        p if p.abs() < 9.95 => format!("{p:+.1} %"),
        p => format!("{p:+.0} %"),
    }
}

/// So many of something, of a word that takes an s: `1 case`, `2 cases`.
#[must_use]
pub fn counted(count: usize, word: &str) -> String {
    match count {
        1 => format!("1 {word}"),
        _ => format!("{count} {word}s"),
    }
}

/// `a`, `a and b`, `a, b and c`.
#[must_use]
pub fn listed(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [only] => only.clone(),
        [all @ .., last] => format!("{} and {last}", all.join(", ")),
    }
}

/// A text that begins with a capital.
#[must_use]
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters
        .next()
        .map(|letter| letter.to_uppercase().collect::<String>());
    first.map_or_else(String::new, |first| first + letters.as_str())
}

/// A share in percent.
#[must_use]
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent >= 99.95 {
        "more than 99.9 %".to_owned()
    } else {
        format!("{percent:.1} %")
    }
}

fn limited(value: f64, most: usize) -> String {
    if value == 0.0 || !value.is_finite() || order(value, DIGITS) >= PLAIN.end {
        return significant(value, DIGITS);
    }
    rounded(value, decimals(value, DIGITS).min(most))
}

/// With so many decimals; what rounds to nothing is said to be less than the last of them.
fn rounded(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return value.to_string();
    }
    let text = format!("{value:.decimals$}");
    let is_nothing = !text.contains(|letter: char| ('1'..='9').contains(&letter));
    match is_nothing {
        true if value == 0.0 => format!("{:.decimals$}", 0.0),
        true if value < 0.0 => format!(">-{}", least(decimals)),
        true => format!("<{}", least(decimals)),
        false => text,
    }
}

/// One in the last of so many decimals.
fn least(decimals: usize) -> String {
    format!("{:.decimals$}", 10f64.powi(-(decimals as i32)))
}

/// Power of ten of the first of so many digits: 9.9996 counts as 10.00.
fn order(value: f64, digits: usize) -> i32 {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    let exponent = text.split_once('e').and_then(|(_, e)| e.parse().ok());
    exponent.unwrap_or_default()
}

fn decimals(value: f64, digits: usize) -> usize {
    match value == 0.0 {
        true => 0,
        false => (digits as i32 - 1 - order(value, digits)).max(0) as usize,
    }
}

/// `3.1·10⁻¹³`.
fn power_of_ten(value: f64) -> String {
    let text = format!("{value:.1e}");
    let (front, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let raised = exponent.chars().map(|letter| match letter {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit.to_digit(10).unwrap_or(0)).unwrap_or('⁰'),
    });
    format!("{front}·10{}", raised.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_not_counted_as_many() {
        let counts = [0, 1, 2].map(|count| counted(count, "case"));
        assert_eq!(counts, ["0 cases", "1 case", "2 cases"]);
    }

    #[test]
    fn the_document_has_the_finest_digit_of_each_unit() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/METRICS.md");
        let document = std::fs::read_to_string(path).unwrap();
        for decimals in 1..=3 {
            let own = DECIMALS.iter().filter(|(_, most)| *most == decimals);
            let units: Vec<&str> = own.map(|(unit, _)| *unit).collect();
            let digit = 10_f64.powi(-(decimals as i32));
            let row = format!("| {} | {digit:.decimals$} |", units.join(", "));
            assert!(document.contains(&row), "docs/METRICS.md lacks {row}");
        }
    }

    #[test]
    fn digits_follow_size_and_unit() {
        for (value, unit, text) in [
            (0.0, "N", "0"),
            (-0.0, "%", "0"),
            (319.62, "N", "319.6"),
            (9.9996, "N", "10.00"),
            (0.9999, "N", "1.000"),
            (-0.012_345_67, "N", "-0.012"),
            (5.2e-4, "N", "0.001"),
            (4.9e-4, "N", "<0.001"),
            (8.2e-8, "N", "<0.001"),
            (-8.2e-8, "%", ">-0.001"),
            (12.34567, "µm", "12.3"),
            (12345.6, "N", "12346"),
            (3.14e-13, "", "3.1·10⁻¹³"),
            (4.0e-4, "", "0.0004000"),
            (4.2e8, "N", "4.2·10⁸"),
            (f64::INFINITY, "N", "inf"),
        ] {
            assert_eq!(number(value, unit), text, "{value} {unit}");
        }
        assert_eq!(optional(None, "N"), "–");
        assert_eq!(with_unit(1.8, "bar"), "1.800 bar");
    }

    #[test]
    fn so_many_digits_are_those_that_are_known() {
        for (value, digits, text) in [
            (13.2143, 3, "13.2"),
            (0.99996, 3, "1.00"),
            (1234.5, 2, "1200"),
            (1.5e-9, 2, "1.5·10⁻⁹"),
        ] {
            assert_eq!(significant(value, digits), text);
        }
    }

    #[test]
    fn a_column_has_the_decimals_of_its_largest() {
        let shown = column(&[Some(320.0), Some(5.125), Some(1e-9), None], "N");
        assert_eq!(shown, ["320.0", "5.1", "<0.1", "–"]);
        assert_eq!(column(&[Some(0.25), Some(0.0)], "N"), ["0.250", "0.000"]);
    }

    #[test]
    fn a_change_never_reads_as_minus_nothing() {
        for (percent, text) in [
            (0.0, "0 %"),
            (-0.01, "<0.1 %"),
            (-3.04, "-3.0 %"),
            (12.3, "+12 %"),
            (149.9, "+150 %"),
        ] {
            assert_eq!(change(percent), text);
        }
    }
}

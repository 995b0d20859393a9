//! Numbers as people write them: no powers of ten where decimals can be read, no zero with a minus, no `1 cases`.

/// Orders of magnitude that are written as decimals.
const DECIMAL: std::ops::Range<i32> = -5..9;

/// A number with so many significant digits.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let digits = digits.max(1);
    // Rounded first, so that 9.9996 counts as 10.00 and not as 10.000.
    let rounded = format!("{value:.*e}", digits - 1);
    let (mantissa, order) = rounded.split_once('e').unwrap_or((&rounded, "0"));
    let order: i32 = order.parse().unwrap_or_default();
    if !DECIMAL.contains(&order) {
        return format!("{mantissa} x 10^{order}");
    }
    let decimals = (digits as i32 - 1 - order).max(0) as usize;
    // What stands before the point is rounded as well.
    let number: f64 = rounded.parse().unwrap_or(value);
    format!("{number:.decimals$}")
}

/// As [`significant`], without zeros at the end of decimals.
#[must_use]
pub fn short(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    match text.split_once(" x ") {
        Some((mantissa, power)) => format!("{} x {power}", trimmed(mantissa)),
        None => trimmed(&text).to_owned(),
    }
}

fn trimmed(text: &str) -> &str {
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => text,
    }
}

/// A number with so many decimals and its sign; what rounds to zero has a plus.
#[must_use]
pub fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{value:+.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| c == '0' || c == '.') => format!("+{digits}"),
        _ => text,
    }
}

/// So many of something: `1 case`, `2 cases`. Only for words that take an s.
#[must_use]
pub fn counted(count: usize, word: &str) -> String {
    match count {
        1 => format!("1 {word}"),
        _ => format!("{count} {word}s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_follow_the_size() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.2994, "1.299"),
            (319.62, "319.6"),
            (9.9996, "10.00"),
            (-0.01234567, "-0.01235"),
            (12345.6, "12350"),
            (4.2e7, "42000000"),
            (8.2e-5, "0.00008200"),
            (3.14e-13, "3.140 x 10^-13"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(significant(value, 4), text);
        }
        assert_eq!(short(40.0, 5), "40");
        assert_eq!(short(2.345_617_89, 5), "2.3456");
        assert_eq!(short(2.5e-7, 5), "2.5 x 10^-7");
        assert_eq!(short(100.0, 2), "100");
    }

    #[test]
    fn a_zero_has_no_minus_and_one_is_one() {
        assert_eq!(signed(-0.04, 1), "+0.0");
        assert_eq!(signed(-0.06, 1), "-0.1");
        assert_eq!(signed(2.0, 0), "+2");
        assert_eq!(
            (counted(1, "case"), counted(0, "case")),
            ("1 case".to_owned(), "0 cases".to_owned())
        );
    }
}

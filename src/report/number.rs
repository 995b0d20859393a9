//! Numbers as people read them.

/// Stands for a value that the run does not determine.
pub(super) const UNDEFINED: &str = "-";

/// A value with about `digits` significant digits; a power of ten where it is far from one.
pub(super) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let digits = digits.max(1);
    // Rounded first, so that 9.9996 counts as 10.00 and not as 10.000.
    let rounded = format!("{value:.*e}", digits - 1);
    let exponent: i32 = rounded
        .split_once('e')
        .and_then(|(_, exponent)| exponent.parse().ok())
        .unwrap_or_default();
    if !(-3..6).contains(&exponent) {
        return format!("{value:.1e}");
    }
    let decimals = digits as i32 - 1 - exponent;
    format!("{value:.*}", decimals.max(0) as usize)
}

/// As [`significant`], or a dash.
pub(super) fn optional(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| UNDEFINED.to_owned(), |value| significant(value, digits))
}

/// A name from a file on one line, without anything that steers a terminal.
pub(super) fn printable(text: &str) -> String {
    text.replace(char::is_control, " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_follow_the_size() {
        for (value, text) in [
            (0.0, "0"),
            (319.62, "319.6"),
            (9.9996, "10.00"),
            (-0.01234567, "-0.01235"),
            (1.0, "1.000"),
            (12345.6, "12346"),
            (3.14e-13, "3.1e-13"),
            (4.2e7, "4.2e7"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(significant(value, 4), text);
        }
        assert_eq!(optional(None, 4), "-");
    }
}

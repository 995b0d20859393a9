//! Numbers as loggers write them.

use super::*;

const COMMA: Marks = Marks {
    decimal: ',',
    thousands: None,
};
const POINT: Marks = Marks {
    decimal: '.',
    thousands: None,
};

#[test]
fn numbers_are_read_with_the_marks_that_are_given_and_with_no_others() {
    let swiss = Marks {
        thousands: Some('\''),
        ..POINT
    };
    let german = Marks {
        thousands: Some('.'),
        ..COMMA
    };
    let french = Marks {
        thousands: Some(' '),
        ..COMMA
    };
    for (marks, text, number) in [
        (POINT, "-1.5e3", Some(-1500.0)),
        (POINT, "1,5", None),
        (COMMA, "-1,5E-3", Some(-1.5e-3)),
        (COMMA, "1.5", None),
        (COMMA, "1.000,5", None),
        (german, "1.000,5", Some(1000.5)),
        (german, "-12.345", Some(-12345.0)),
        (german, "12.5", None),
        (german, "1234,5", Some(1234.5)),
        (swiss, "1'234'567.5", Some(1_234_567.5)),
        (swiss, "1'23.5", None),
        (french, "1\u{202f}234,5", Some(1234.5)),
        (french, "\u{2212}1\u{a0}234,5", Some(-1234.5)),
        (POINT, "\u{2212}0.5", Some(-0.5)),
        (COMMA, "\u{2013}0,5", Some(-0.5)),
        (POINT, "inf", None),
    ] {
        assert_eq!(marks.number(text), number, "{text}");
    }
    assert!(COMMA.number("#NV").unwrap().is_nan());
    assert_eq!(COMMA.number_or_word("WAHR"), Some(1.0));
    assert_eq!(COMMA.number_or_word("1,0"), Some(1.0));
}

#[test]
fn a_field_tells_its_marks_unless_they_may_be_either() {
    for (text, expected) in [
        ("12", Seen::Plain),
        ("1.5", Seen::Decimal('.')),
        ("0,125", Seen::Decimal(',')),
        ("1234.567", Seen::Decimal('.')),
        ("1.000", Seen::Open('.')),
        ("1.000.000", Seen::Grouped('.', None)),
        ("1.000,25", Seen::Grouped('.', Some(','))),
        ("1,000.25", Seen::Grouped(',', Some('.'))),
        ("1'000", Seen::Grouped('\'', None)),
        ("1.5.2024", Seen::Other),
        ("1.000e3", Seen::Decimal('.')),
        ("x", Seen::Other),
        ("\u{2212}1.5", Seen::Decimal('.')),
        ("1 234,5", Seen::Grouped(' ', Some(','))),
        ("1.5E", Seen::Other),
    ] {
        assert_eq!(seen(text), expected, "{text}");
    }
}

#[test]
fn what_to_write_is_decided_by_the_whole_column() {
    let says = |field: &str, marks: Marks, column: &[&str]| {
        let fields = column
            .iter()
            .enumerate()
            .map(|(i, text)| (i as u64 + 2, *text));
        expected(field, 9, marks, fields)
    };
    // A thousand and not one: the point is no decimal mark.
    let wild = says("1.000", COMMA, &["998,5", "999,5", "1.000", "1.000,5"]);
    assert!(
        wild.contains("thousands_mark = \".\"") && !wild.contains("decimal_mark"),
        "{wild}"
    );
    let open = says("1.000", COMMA, &["998", "999", "1.000"]);
    assert!(
        open.contains("makes 1000 of it") && open.contains("makes 1.000"),
        "{open}"
    );
    assert!(says("1,5", POINT, &["1,5", "2,25"]).contains("with `decimal_mark = \",\"`"));
    let mixed = says("2.25", COMMA, &["1,5", "2.25"]);
    assert!(
        mixed.contains("`1,5` of line 2") && mixed.contains("write line 9 as `2,25`"),
        "{mixed}"
    );
    let both = says("1.000,5", POINT, &["1.000,5", "2,25"]);
    assert!(
        both.contains("decimal_mark = \",\"") && both.contains("thousands_mark = \".\""),
        "{both}"
    );
}

//! Stamps as loggers write them.

use super::*;

/// 5 March 2024, 14:02:03.123 in UTC [ns], as `date -u -d '2024-03-05 14:02:03' +%s` says.
const KNOWN: i64 = 1_709_647_323_123_000_000;

fn of(texts: &[&str], order: Option<DateOrder>) -> Result<Vec<i64>, String> {
    let texts: Vec<String> = texts.iter().map(|text| (*text).to_owned()).collect();
    nanoseconds(
        &texts,
        Reading {
            order,
            ..Reading::default()
        },
    )
    .map_err(|unread| format!("{}: {}", unread.index, unread.expected))
}

#[test]
fn one_moment_in_many_forms() {
    for text in [
        "2024-03-05T14:02:03.123Z",
        "2024-03-05 14:02:03.123",
        "2024-03-05T15:02:03,123+01:00",
        "2024-03-05 08:32:03.123 -0530",
        "20240305T140203.123",
        "05.03.2024 14:02:03,123",
        "5.3.2024 14:02:03.123",
        "05.03.24 14:02:03.123000",
        "Di 05.03.2024 14:02:03,123",
        "2024/03/05 14:02:03:123",
        "5 Mar 2024 14:02:03.123",
        "05-Mrz-2024 14:02:03.123",
        "March 5, 2024 2:02:03.123 PM",
    ] {
        assert_eq!(of(&[text], None), Ok(vec![KNOWN]), "{text}");
    }
    let slashed = of(
        &["03/05/2024 2:02:03.123 PM"],
        Some(DateOrder::MonthDayYear),
    );
    assert_eq!(slashed, Ok(vec![KNOWN]));
}

#[test]
fn the_order_of_day_and_month_is_decided_by_all_dates_together() {
    let british = of(&["05/03/2024 14:02:03.123", "13/03/2024 00:00:00"], None);
    assert_eq!(british.unwrap()[0], KNOWN);
    let american = of(&["03/05/2024 14:02:03.123", "03/13/2024 00:00:00"], None);
    assert_eq!(american.unwrap()[0], KNOWN);
    let neither = of(&["03/05/2024 14:02:03"], None).unwrap_err();
    assert!(
        neither.contains("date_order") && neither.contains("day 3 of month 5"),
        "{neither}"
    );
    let both = of(&["13/05/2024 14:02", "05/13/2024 14:02"], None).unwrap_err();
    assert!(
        both.starts_with("1: a date in the order of the others"),
        "{both}"
    );
}

#[test]
fn dates_without_years_are_refused_unless_the_year_is_known() {
    let said = of(&["05.03. 14:02:03"], None).unwrap_err();
    assert!(said.contains("`year = 2024`"), "{said}");
    let stamps = ["05.03. 14:02:03,123".to_owned()];
    let in_2024 = Reading {
        year: Some(2024),
        ..Reading::default()
    };
    assert_eq!(nanoseconds(&stamps, in_2024), Ok(vec![KNOWN]));
    for text in [
        "12.5",
        "-1.5",
        "1,250",
        "x",
        "30.02.2024 25:61:00",
        "05:03:2024:1:2",
    ] {
        assert!(of(&[text], None).is_err(), "{text}");
    }
    assert!(
        of(&["30.02.2024 12:00"], None)
            .unwrap_err()
            .contains("that there is")
    );
}

#[test]
fn times_of_the_day_go_on_at_midnight_and_durations_are_read() {
    let times = of(&["23:59:59.5", "00:00:00.5", "00:00:01"], None).unwrap();
    assert_eq!(
        [times[1] - times[0], times[2] - times[1]],
        [NANOSECONDS, NANOSECONDS / 2]
    );
    let all = of(
        &["T#1h2m3s4ms", "TIME#1.5s", "t#250us", "LTIME#1s_20ns"],
        None,
    )
    .unwrap();
    assert_eq!(
        all,
        [3_723_004_000_000, 1_500_000_000, 250_000, 1_000_000_020]
    );
}

#[test]
fn times_of_two_numbers_are_minutes_and_seconds_where_they_have_decimals_and_asked_for_elsewhere() {
    let times = of(&["59:59.8", "59:59,9", "00:00.0", "00:00.1"], None).unwrap();
    let tenth = NANOSECONDS / 10;
    assert_eq!(times[0], 3_599 * NANOSECONDS + 8 * tenth);
    assert!(
        times.windows(2).all(|pair| pair[1] - pair[0] == tenth),
        "{times:?}"
    );
    let open = ["14:02", "14:03"];
    let said = of(&open, None).unwrap_err();
    assert!(said.contains("`two_numbers = \"mm:ss\"`"), "{said}");
    let texts = open.map(str::to_owned);
    for (numbers, seconds) in [
        (TwoNumbers::MinutesSeconds, 842),
        (TwoNumbers::HoursMinutes, 50_520),
    ] {
        let reading = Reading {
            two_numbers: Some(numbers),
            ..Reading::default()
        };
        assert_eq!(
            nanoseconds(&texts, reading).unwrap()[0],
            seconds * NANOSECONDS
        );
    }
    // No hour has the number 75, and no minute of the day needs to be stated beside others with seconds.
    assert_eq!(
        of(&["75:10", "75:11"], None).unwrap()[0],
        4_510 * NANOSECONDS
    );
    assert_eq!(
        of(&["14:02", "14:02:01"], None).unwrap()[0],
        50_520 * NANOSECONDS
    );
    assert_eq!(
        of(&["2024-03-05 14:02"], None).unwrap()[0],
        KNOWN - 3_123_000_000
    );
}

#[test]
fn durations_and_literals_of_controllers_and_programs() {
    for (text, time) in [
        ("TOD#14:02:03.123", 50_523_123_000_000),
        ("TIME_OF_DAY#00:00:01", NANOSECONDS),
        ("0 days 00:00:01.250000", 1_250_000_000),
        ("1 day, 0:00:01", DAY + NANOSECONDS),
        ("-1 days +23:59:59.5", -NANOSECONDS / 2),
        ("1.02:03:04.5", DAY + 7_384_500_000_000),
        ("PT1M2.5S", 62_500_000_000),
        ("P0DT0H0M1.25S", 1_250_000_000),
        ("DT#2024-03-05-14:02:03.123", KNOWN),
        ("DATE_AND_TIME#2024-03-05-14:02:03.123", KNOWN),
    ] {
        assert_eq!(of(&[text], None), Ok(vec![time]), "{text}");
    }
    for text in ["P", "PT", "1 dayz", "TOD#x", "12.5:3", "-00:01.5"] {
        assert!(of(&[text], None).is_err(), "{text}");
    }
    // The year may stand first or last.
    let said = of(&["24-03-05 14:02:03"], None).unwrap_err();
    assert!(
        said.contains("year-month-day") && said.contains("2005"),
        "{said}"
    );
}

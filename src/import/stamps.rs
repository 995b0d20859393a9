//! Stamps of a text log: dates with times, times of the day, and durations as controllers (IEC 61131-3, `T#1s250ms`) and programs write them.
//!
//! ```text
//! 2024-03-05T14:02:03.123Z   05.03.2024 14:02:03,123   3/5/2024 2:02:03 PM   5 Mar 2024 14:02:03   20240305T140203   14:02:03.123   02:03.1
//! TOD#14:02:03.123   DT#2024-03-05-14:02:03   T#1m2s   0 days 00:00:01.25   1.02:03:04.5   PT1M2.5S
//! ```
//!
//! The order of day and month is determined by all the dates of a log together, by a point between them, or by the map. Stamps without a zone are read as UTC.
//! Of a time of two numbers the last is seconds where it has decimals (as spreadsheets show `mm:ss.0`); of others the map says what they are.

use chrono::NaiveDate;

use super::units;
use crate::recording::Unit;

const NANOSECONDS: i64 = 1_000_000_000;
const DAY: i64 = 86_400 * NANOSECONDS;
const HOUR: i64 = 3600 * NANOSECONDS;
/// Hours from which two numbers are minutes and seconds.
const HOURS: i64 = 24;
/// Days of a month of which none is a month.
const MONTHS: u32 = 12;
/// Years of two digits are of this century.
const CENTURY: i32 = 2000;

/// Beginnings of the months' names, January first: English, German, French, Italian, Spanish.
const NAMES: [&[&str]; 12] = [
    &["jan", "jän", "gen", "ene"],
    &["feb", "fev", "fév"],
    &["mar", "mär", "mrz", "mae"],
    &["apr", "avr", "abr"],
    &["may", "mai", "mag"],
    &["jun", "juin", "giu"],
    &["jul", "juil", "lug"],
    &["aug", "aou", "aoû", "ago"],
    &["sep", "set"],
    &["oct", "okt", "ott"],
    &["nov"],
    &["dec", "dez", "déc", "dic"],
];

/// In which order a date is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DateOrder {
    /// 2024-03-05.
    YearMonthDay,
    /// 05.03.2024.
    DayMonthYear,
    /// 03/05/2024.
    MonthDayYear,
}

/// What a time of two numbers, `14:02`, is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TwoNumbers {
    /// Minutes and seconds.
    MinutesSeconds,
    /// Hours and minutes.
    HoursMinutes,
}

/// What a map says of its stamps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Reading {
    /// The order of day, month and year.
    pub order: Option<DateOrder>,
    /// The year of dates without one.
    pub year: Option<i32>,
    /// What times of two numbers are.
    pub two_numbers: Option<TwoNumbers>,
}

/// Why stamps cannot be read: which of them, and what would be right.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Unread {
    /// Which of the stamps, from 0.
    pub index: usize,
    /// The right form, and what to write.
    pub expected: String,
}

/// A stamp taken apart.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stamp {
    date: Option<Groups>,
    /// Since midnight, in UTC where a zone stands; or a duration [ns].
    time: i64,
    form: TimeForm,
}

/// How a time is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TimeForm {
    /// Hours, minutes and perhaps seconds of a day.
    Day,
    /// Two numbers, the second with decimals: minutes and seconds.
    Minutes,
    /// Two whole numbers, as hours and minutes in `time`.
    Two,
    /// A span of time, which does not go on at midnight.
    Duration,
}

/// The groups of a date, in the order in which they stand.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Groups {
    numbers: [u32; 3],
    /// Number of them: two of a date without a year.
    count: usize,
    /// Which of them a name of a month is.
    named_month: Option<usize>,
    /// Which of them has four digits.
    long: Option<usize>,
    /// Whether there is a point between them.
    pointed: bool,
    /// Whether there is a dash.
    dashed: bool,
}

/// Times of stamps [ns]: since 1970 where they have dates, since midnight or a start where they have none.
///
/// # Errors
/// The first that cannot be read, or whose day and month cannot be distinguished.
pub(super) fn nanoseconds(stamps: &[String], reading: Reading) -> Result<Vec<i64>, Unread> {
    let mut parsed = Vec::with_capacity(stamps.len());
    for (index, text) in stamps.iter().enumerate() {
        parsed.push(parse(text).ok_or_else(|| Unread {
            index,
            expected: unknown(text),
        })?);
    }
    set_two_numbers(&mut parsed, reading.two_numbers)?;
    let order = match reading.order {
        Some(order) => Some(order),
        None => stated_order(&parsed, reading.year)?,
    };
    let mut times: Vec<i64> = Vec::with_capacity(parsed.len());
    let mut passed = 0;
    for (index, stamp) in parsed.iter().enumerate() {
        let Some(groups) = &stamp.date else {
            // A time of the day falls back by a day at midnight, one of minutes by an hour.
            let turn = match stamp.form {
                TimeForm::Day | TimeForm::Two => Some(DAY),
                TimeForm::Minutes => Some(HOUR),
                TimeForm::Duration => None,
            };
            if let (Some(before), Some(turn)) = (times.last(), turn)
                && before - (stamp.time + passed) > turn / 2
            {
                passed += turn;
            }
            times.push(stamp.time + passed);
            continue;
        };
        let date = groups.date(order, reading.year);
        let since =
            date.and_then(|date| date.and_hms_opt(0, 0, 0)?.and_utc().timestamp_nanos_opt());
        let since = since.ok_or_else(|| Unread {
            index,
            expected: "a date that there is".to_owned(),
        })?;
        times.push(since + stamp.time);
    }
    Ok(times)
}

/// Makes minutes and seconds of times of two whole numbers, or hours and minutes, as the map or they themselves say.
fn set_two_numbers(stamps: &mut [Stamp], said: Option<TwoNumbers>) -> Result<(), Unread> {
    let is_two = |stamp: &Stamp| stamp.form == TimeForm::Two && stamp.date.is_none();
    let Some(first) = stamps.iter().position(is_two) else {
        return Ok(());
    };
    let is_minutes = |stamp: &Stamp| {
        stamp.form == TimeForm::Minutes || (is_two(stamp) && stamp.time >= HOURS * HOUR)
    };
    let minutes = stamps.iter().any(is_minutes);
    let day = stamps.iter().any(|stamp| stamp.form == TimeForm::Day);
    match (said, minutes, day) {
        (Some(TwoNumbers::HoursMinutes), ..) | (None, false, true) => {}
        (Some(TwoNumbers::MinutesSeconds), ..) | (None, true, false) => {
            for stamp in stamps.iter_mut().filter(|stamp| is_two(stamp)) {
                stamp.time /= 60;
                stamp.form = TimeForm::Minutes;
            }
        }
        (None, ..) => {
            return Err(Unread {
                index: first,
                expected: "two numbers of which is known what they are: `two_numbers = \"mm:ss\"` in [file.time] reads minutes and seconds, \"hh:mm\" hours and minutes"
                    .to_owned(),
            });
        }
    }
    Ok(())
}

/// Whether this is a stamp, and not a plain number.
pub(super) fn is_stamp(text: &str) -> bool {
    parse(text).is_some()
}

/// Presence of a date, and of a time, in a stamp.
pub(super) fn parts(text: &str) -> Option<[bool; 2]> {
    let stamp = parse(text)?;
    Some([
        stamp.date.is_some(),
        text.contains(':') || stamp.date.is_none() || text.contains('T'),
    ])
}

/// Whether stamps have no more than whole seconds.
pub(super) fn are_whole_seconds(times: &[i64]) -> bool {
    times.iter().all(|time| time % NANOSECONDS == 0)
}

/// The right form of a stamp, and what this looks like.
fn unknown(text: &str) -> String {
    const FORMS: &str = "a stamp such as `2024-03-05T14:02:03.123Z`, `05.03.2024 14:02:03,123`, `14:02:03.123`, `02:03.1`, `T#1s250ms` or `0 days 00:00:01.25`";
    let is_number = text.replace(',', ".").trim().parse::<f64>().is_ok();
    if is_number {
        let units = units::of_kind(Unit::Second).join(", ");
        return format!("{FORMS}; numbers need `unit` in [file.time], one of {units}");
    }
    FORMS.to_owned()
}

/// The order of all dates together; none where there are none.
fn stated_order(stamps: &[Stamp], year: Option<i32>) -> Result<Option<DateOrder>, Unread> {
    let dates = || {
        let all = stamps.iter().enumerate();
        all.filter_map(|(index, stamp)| Some((index, stamp.date?)))
    };
    if year.is_none()
        && let Some((index, _)) = dates().find(|(_, groups)| groups.count == 2)
    {
        let expected = "a date with its year; `year = 2024` in [file.time] adds it".to_owned();
        return Err(Unread { index, expected });
    }
    let Some((first, groups)) = dates().find(|(_, groups)| groups.needs_order()) else {
        return Ok(None);
    };
    if groups.pointed {
        return Ok(Some(DateOrder::DayMonthYear));
    }
    if let Some((index, groups)) = dates().find(|(_, groups)| groups.may_begin_with_year()) {
        let [a, b, c] = groups.numbers;
        let expected = format!(
            "an order of day, month and year, which two digits do not tell: `date_order = \"year-month-day\"` in [file.time] takes it for day {c} of month {b} in {}, \
             \"day-month-year\" for day {a} of month {b} in {}",
            CENTURY + a as i32,
            CENTURY + c as i32
        );
        return Err(Unread { index, expected });
    }
    let above = |place: usize| dates().find(|(_, groups)| groups.numbers[place] > MONTHS);
    match (above(0), above(1)) {
        (Some(_), None) => Ok(Some(DateOrder::DayMonthYear)),
        (None, Some(_)) => Ok(Some(DateOrder::MonthDayYear)),
        (Some((index, _)), Some((other, _))) => Err(Unread {
            index: index.max(other),
            expected: format!(
                "a date in the order of the others: first of them is {}",
                if index < other { "a day" } else { "a month" }
            ),
        }),
        (None, None) => {
            let [a, b, _] = groups.numbers;
            let expected = format!(
                "an order of day and month, which no date of the log tells: none has a number above 12 there; \
                 `date_order = \"day-month-year\"` in [file.time] takes it for day {a} of month {b}, \"month-day-year\" for day {b} of month {a}"
            );
            Err(Unread {
                index: first,
                expected,
            })
        }
    }
}

impl Groups {
    /// Whether only an order can tell which is the day.
    fn needs_order(&self) -> bool {
        self.named_month.is_none() && self.long != Some(0)
    }

    /// Whether a year of two digits may stand first: `24-03-05`.
    fn may_begin_with_year(&self) -> bool {
        self.dashed && self.count == 3 && self.long.is_none() && self.numbers[0] > MONTHS
    }

    fn date(&self, order: Option<DateOrder>, year: Option<i32>) -> Option<NaiveDate> {
        let [a, b, c] = self.numbers;
        let full = |number: u32, long: bool| {
            let number = i32::try_from(number).ok()?;
            Some(if long { number } else { CENTURY + number })
        };
        if self.count == 2 {
            let (month, day) = match (self.named_month, order) {
                (Some(0), _) | (None, Some(DateOrder::MonthDayYear | DateOrder::YearMonthDay)) => {
                    (a, b)
                }
                _ => (b, a),
            };
            return NaiveDate::from_ymd_opt(year?, month, day);
        }
        let by_long = match self.long {
            Some(0) => Some(DateOrder::YearMonthDay),
            _ => None,
        };
        let by_name = match self.named_month {
            Some(0) => Some(DateOrder::MonthDayYear),
            Some(1) if self.long != Some(0) => Some(DateOrder::DayMonthYear),
            _ => None,
        };
        let (year, month, day, place) = match by_name.or(by_long).or(order)? {
            DateOrder::YearMonthDay => (a, b, c, 0),
            DateOrder::DayMonthYear => (c, b, a, 2),
            DateOrder::MonthDayYear => (c, a, b, 2),
        };
        NaiveDate::from_ymd_opt(full(year, self.long == Some(place))?, month, day)
    }
}

fn parse(text: &str) -> Option<Stamp> {
    let text = text.trim();
    let of_span = |time: i64| Stamp {
        date: None,
        time,
        form: TimeForm::Duration,
    };
    if let Some(time) = duration(text).or_else(|| iso_duration(text)) {
        return Some(of_span(time));
    }
    let text = without_type(text);
    if let Some(time) = days_and_time(text) {
        return Some(of_span(time));
    }
    if let Some(stamp) = compact(text) {
        return Some(stamp);
    }
    let Some(colon) = text.find(':') else {
        let date = Some(date(text)?);
        return Some(Stamp {
            date,
            time: 0,
            form: TimeForm::Day,
        });
    };
    let digits = text[..colon].bytes().rev();
    let start = colon - digits.take_while(u8::is_ascii_digit).count();
    let joint = [' ', 'T', 't', ',', ';', '_', '-'];
    let before = text[..start].trim_end_matches(joint);
    let date = match before {
        "" if start > 0 && text.starts_with('-') => return None,
        "" => None,
        before => Some(date(before)?),
    };
    let (time, form) = clock(&text[start..])?;
    if date.is_some() {
        // Beside a date stand hours and minutes.
        let hours_minutes = form != TimeForm::Minutes && time < 25 * HOUR;
        return hours_minutes.then_some(Stamp {
            date,
            time,
            form: TimeForm::Day,
        });
    }
    Some(Stamp { date, time, form })
}

/// A literal of IEC 61131-3 without its type: `TOD#14:02:03`, `DT#2024-03-05-14:02:03`.
fn without_type(text: &str) -> &str {
    const TYPES: [&str; 11] = [
        "tod",
        "ltod",
        "time_of_day",
        "ltime_of_day",
        "dt",
        "ldt",
        "date_and_time",
        "ldate_and_time",
        "dtl",
        "d",
        "date",
    ];
    match text.split_once('#') {
        Some((head, rest)) if TYPES.iter().any(|name| head.eq_ignore_ascii_case(name)) => rest,
        _ => text,
    }
}

/// `0 days 00:00:01.25`, `-1 day, 23:59:59`, `1.02:03:04.5` [ns].
fn days_and_time(text: &str) -> Option<i64> {
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let negative = text.starts_with('-');
    let plain = text.trim_start_matches(['-', '+']);
    let (days, rest) = match plain.split_once(" day") {
        Some((days, rest)) => (days, rest.trim_start_matches(['s', ',', ' ', '+'])),
        None => {
            let (days, rest) = plain.split_once('.')?;
            // `5.14:02:03`, and no `05.03.2024 14:02:03`.
            rest.split_once(':')
                .filter(|(hours, _)| digits(hours) && hours.len() <= 2)?;
            (days, rest)
        }
    };
    if !digits(days) {
        return None;
    }
    let days = days.parse::<i64>().ok()? * DAY;
    let behind = match rest {
        "" => 0,
        rest => match clock(rest)? {
            (time, TimeForm::Day) => time,
            _ => return None,
        },
    };
    // Of a negative number of days the time counts up again, as pandas writes it.
    Some(if negative {
        behind - days
    } else {
        days + behind
    })
}

/// `PT1M2.5S`, `P0DT0H0M1.25S` (ISO 8601) [ns].
fn iso_duration(text: &str) -> Option<i64> {
    let rest = text.strip_prefix('P')?;
    let (days, times) = rest.split_once('T').unwrap_or((rest, ""));
    let mut total = 0.0;
    for (part, units) in [
        (days, &[('D', 86_400e9)][..]),
        (times, &[('H', 3600e9), ('M', 60e9), ('S', 1e9)][..]),
    ] {
        let mut rest = part;
        while !rest.is_empty() {
            let end = rest.find(|c: char| c.is_ascii_alphabetic())?;
            let number: f64 = rest[..end].replace(',', ".").parse().ok()?;
            let letter = rest[end..].chars().next()?;
            let (_, size) = units.iter().find(|(name, _)| *name == letter)?;
            total += number * size;
            rest = &rest[end + 1..];
        }
    }
    (rest.len() > 1).then_some(total.round() as i64)
}

/// `20240305T140203.25`.
fn compact(text: &str) -> Option<Stamp> {
    let (day, rest) = text.split_at_checked(8)?;
    let rest = rest.strip_prefix(['T', 't', '_', '-', ' '])?;
    let (clock_part, fraction) = rest.split_at_checked(6)?;
    let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    if !digits(day) || !digits(clock_part) {
        return None;
    }
    let spread = format!(
        "{}:{}:{}{fraction}",
        &clock_part[..2],
        &clock_part[2..4],
        &clock_part[4..]
    );
    let number = |range: std::ops::Range<usize>| day[range].parse().ok();
    Some(Stamp {
        date: Some(Groups {
            numbers: [number(0..4)?, number(4..6)?, number(6..8)?],
            count: 3,
            named_month: None,
            long: Some(0),
            pointed: false,
            dashed: false,
        }),
        time: clock(&spread)?.0,
        form: TimeForm::Day,
    })
}

fn date(text: &str) -> Option<Groups> {
    let mut groups = Groups {
        numbers: [0; 3],
        count: 0,
        named_month: None,
        long: None,
        pointed: false,
        dashed: text.contains('-'),
    };
    for part in text.split(|c: char| !c.is_alphanumeric()) {
        let number = if part.bytes().all(|byte| byte.is_ascii_digit()) {
            if part.is_empty() {
                continue;
            }
            if part.len() == 4 {
                groups.long = Some(groups.count);
            } else if part.len() > 2 {
                return None;
            }
            part.parse().ok()?
        } else {
            let lower = part.to_lowercase();
            let month = NAMES
                .iter()
                .position(|names| names.iter().any(|name| lower.starts_with(name)));
            match month {
                Some(month) if groups.named_month.is_none() => {
                    groups.named_month = Some(groups.count);
                    month as u32 + 1
                }
                // The day of the week stands first, and says nothing new.
                _ if groups.count == 0 && lower.chars().all(char::is_alphabetic) => continue,
                _ => return None,
            }
        };
        *groups.numbers.get_mut(groups.count)? = number;
        groups.count += 1;
    }
    groups.pointed = text.contains('.') && !text.contains(['/', '-']);
    // A number with a point is no date: `12.5`.
    let is_pair = groups.count == 2
        && (text.ends_with('.') || text.contains(['/', '-']) || groups.named_month.is_some());
    let is_signed = text.starts_with(['-', '+']);
    ((groups.count == 3 || is_pair) && !is_signed).then_some(groups)
}

/// `14:02:03,123 PM +01:00` as nanoseconds since midnight, in UTC where a zone stands; or `02:03.1` as minutes and seconds.
fn clock(text: &str) -> Option<(i64, TimeForm)> {
    let end = text.find(|c: char| !c.is_ascii_digit() && !".:,".contains(c));
    let (numbers, mut rest) = text.split_at(end.unwrap_or(text.len()));
    let numbers = numbers.trim_end_matches(',');
    let two = |part: Option<&str>| {
        part.filter(|p| (1..=2).contains(&p.len()))?
            .parse::<i64>()
            .ok()
    };
    let fraction = |digits: &str| {
        let digits = &digits[..digits.len().min(9)];
        let number: i64 = format!("0{digits}").parse().ok()?;
        Some(number * 10i64.pow(9 - u32::try_from(digits.len()).ok()?))
    };
    if let Some((minutes, decimals)) = minutes_and_seconds(numbers) {
        // Nothing follows but the end.
        let (minutes, seconds) = minutes.split_once(':')?;
        let [minutes, seconds] = [two(Some(minutes))?, two(Some(seconds))?];
        let fits = rest.trim().is_empty() && seconds < 60;
        let whole = (minutes * 60 + seconds) * NANOSECONDS;
        return fits.then_some((whole + fraction(decimals)?, TimeForm::Minutes));
    }
    let mut parts = numbers.split([':', '.', ',']);
    let (mut hours, minutes) = (two(parts.next())?, two(parts.next())?);
    let (seconds, form) = match parts.next() {
        None => (0, TimeForm::Two),
        some => (two(some)?, TimeForm::Day),
    };
    let fraction = match parts.next() {
        None => 0,
        Some(digits) => fraction(digits)?,
    };
    if parts.next().is_some() || minutes > 59 || seconds > 60 {
        return None;
    }
    rest = rest.trim();
    let mut is_half = false;
    for (half, added) in [("am", 0), ("pm", 12), ("a.m.", 0), ("p.m.", 12)] {
        if let Some(head) = rest.get(..half.len())
            && head.eq_ignore_ascii_case(half)
        {
            hours = hours % 12 + added;
            rest = rest[half.len()..].trim();
            is_half = true;
            break;
        }
    }
    let whole = (hours * 60 + minutes) * 60 + seconds;
    let form = if is_half { TimeForm::Day } else { form };
    Some(((whole - zone(rest)?) * NANOSECONDS + fraction, form))
}

/// The two numbers and the decimals of `02:03.1`.
fn minutes_and_seconds(numbers: &str) -> Option<(&str, &str)> {
    let (whole, decimals) = numbers.split_once(['.', ','])?;
    let fits = whole.matches(':').count() == 1
        && !decimals.is_empty()
        && !decimals.contains([':', '.', ',']);
    fits.then_some((whole, decimals))
}

/// Seconds of a zone ahead of UTC.
fn zone(text: &str) -> Option<i64> {
    let digits = match text {
        "" | "Z" | "z" | "UTC" | "GMT" => return Some(0),
        _ => text.strip_prefix("UTC").unwrap_or(text),
    };
    let (sign, digits) = match digits.split_at_checked(1)? {
        ("+", rest) => (1, rest),
        ("-" | "−", rest) => (-1, rest),
        _ => return None,
    };
    let digits = digits.replace(':', "");
    let number: i64 = digits.parse().ok()?;
    match digits.len() {
        1 | 2 => Some(sign * number * 3600),
        4 => Some(sign * (number / 100 * 3600 + number % 100 * 60)),
        _ => None,
    }
}

/// `T#1h2m3s4ms`, `LTIME#12us` [ns].
fn duration(text: &str) -> Option<i64> {
    let (head, mut rest) = text.split_once('#')?;
    let known = ["t", "time", "lt", "ltime"];
    if !known.iter().any(|name| head.eq_ignore_ascii_case(name)) {
        return None;
    }
    let sign = if rest.starts_with('-') { -1.0 } else { 1.0 };
    rest = rest.trim_start_matches('-');
    let mut total = 0.0;
    while !rest.is_empty() {
        let end = rest.find(|c: char| c.is_ascii_alphabetic())?;
        let number: f64 = rest[..end].replace('_', "").parse().ok()?;
        rest = &rest[end..];
        let end = rest
            .find(|c: char| !c.is_ascii_alphabetic())
            .unwrap_or(rest.len());
        let unit = match rest[..end].to_ascii_lowercase().as_str() {
            "d" => 86_400e9,
            "h" => 3600e9,
            "m" => 60e9,
            "s" => 1e9,
            "ms" => 1e6,
            "us" => 1e3,
            "ns" => 1.0,
            _ => return None,
        };
        total += number * unit;
        rest = rest[end..].trim_start_matches('_');
    }
    Some((sign * total).round() as i64)
}

#[cfg(test)]
mod tests;

//! Stamps of a text log: dates with times, times of the day, and durations as controllers write them (IEC 61131-3, `T#1s250ms`).
//!
//! ```text
//! 2024-03-05T14:02:03.123Z   05.03.2024 14:02:03,123   3/5/2024 2:02:03 PM   5 Mar 2024 14:02:03   20240305T140203   14:02:03.123   T#1m2s
//! ```
//!
//! The order of day and month is told by all the dates of a log together, by a point between them, or by the map. Stamps without a zone are read as UTC.

use chrono::NaiveDate;

use super::units;
use crate::recording::Unit;

const NANOSECONDS: i64 = 1_000_000_000;
const DAY: i64 = 86_400 * NANOSECONDS;
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
}

/// Times of stamps [ns]: since 1970 where they have dates, since midnight or a start where they have none.
///
/// # Errors
/// The first that cannot be read, or whose day and month cannot be told apart.
pub(super) fn nanoseconds(
    stamps: &[String],
    order: Option<DateOrder>,
    year: Option<i32>,
) -> Result<Vec<i64>, Unread> {
    let mut parsed = Vec::with_capacity(stamps.len());
    for (index, text) in stamps.iter().enumerate() {
        parsed.push(parse(text).ok_or_else(|| Unread {
            index,
            expected: unknown(text),
        })?);
    }
    let order = match order {
        Some(order) => Some(order),
        None => told_order(&parsed, year)?,
    };
    let mut times: Vec<i64> = Vec::with_capacity(parsed.len());
    let mut days = 0;
    for (index, stamp) in parsed.iter().enumerate() {
        let Some(groups) = &stamp.date else {
            // A time of the day falls back by a day at midnight.
            if let Some(before) = times.last()
                && before - (stamp.time + days * DAY) > DAY / 2
            {
                days += 1;
            }
            times.push(stamp.time + days * DAY);
            continue;
        };
        let date = groups.date(order, year);
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

/// The right form of a stamp, and what this looks like.
fn unknown(text: &str) -> String {
    const FORMS: &str = "a stamp such as `2024-03-05T14:02:03.123Z`, `05.03.2024 14:02:03,123`, `14:02:03.123` or `T#1s250ms`";
    let is_number = text.replace(',', ".").trim().parse::<f64>().is_ok();
    if is_number {
        let units = units::of_kind(Unit::Second).join(", ");
        return format!("{FORMS}; numbers need `unit` in [file.time], one of {units}");
    }
    FORMS.to_owned()
}

/// The order of all dates together; none where there are none.
fn told_order(stamps: &[Stamp], year: Option<i32>) -> Result<Option<DateOrder>, Unread> {
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
    if let Some(time) = duration(text) {
        return Some(Stamp { date: None, time });
    }
    if let Some(stamp) = compact(text) {
        return Some(stamp);
    }
    let Some(colon) = text.find(':') else {
        let date = Some(date(text)?);
        return Some(Stamp { date, time: 0 });
    };
    let digits = text[..colon].bytes().rev();
    let start = colon - digits.take_while(u8::is_ascii_digit).count();
    let joint = [' ', 'T', 't', ',', ';', '_', '-'];
    let before = text[..start].trim_end_matches(joint);
    Some(Stamp {
        date: match before {
            "" => None,
            before => Some(date(before)?),
        },
        time: clock(&text[start..])?,
    })
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
        }),
        time: clock(&spread)?,
    })
}

fn date(text: &str) -> Option<Groups> {
    let mut groups = Groups {
        numbers: [0; 3],
        count: 0,
        named_month: None,
        long: None,
        pointed: false,
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

/// `14:02:03,123 PM +01:00` as nanoseconds since midnight, in UTC where a zone stands.
fn clock(text: &str) -> Option<i64> {
    let end = text.find(|c: char| !c.is_ascii_digit() && !".:,".contains(c));
    let (numbers, mut rest) = text.split_at(end.unwrap_or(text.len()));
    let mut parts = numbers.trim_end_matches(',').split([':', '.', ',']);
    let two = |part: Option<&str>| {
        part.filter(|p| (1..=2).contains(&p.len()))?
            .parse::<i64>()
            .ok()
    };
    let (mut hours, minutes) = (two(parts.next())?, two(parts.next())?);
    let seconds = match parts.next() {
        None => 0,
        some => two(some)?,
    };
    let fraction = match parts.next() {
        None => 0,
        Some(digits) => {
            let digits = &digits[..digits.len().min(9)];
            let number: i64 = format!("0{digits}").parse().ok()?;
            number * 10i64.pow(9 - u32::try_from(digits.len()).ok()?)
        }
    };
    if parts.next().is_some() || hours > 24 || minutes > 59 || seconds > 60 {
        return None;
    }
    rest = rest.trim();
    for (half, added) in [("am", 0), ("pm", 12), ("a.m.", 0), ("p.m.", 12)] {
        if let Some(head) = rest.get(..half.len())
            && head.eq_ignore_ascii_case(half)
        {
            hours = hours % 12 + added;
            rest = rest[half.len()..].trim();
            break;
        }
    }
    let whole = (hours * 60 + minutes) * 60 + seconds;
    Some((whole - zone(rest)?) * NANOSECONDS + fraction)
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

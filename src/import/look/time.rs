//! Which column of a log holds the times, and in what unit.

use super::assign::described;
use super::names::{parts, said, says_time};
use super::seen::{Because, Cells, Looked, SaidRate, SaidUnit, Seen, TimeSeen};
use super::units::shown;
use crate::import::log::starts_again;
use crate::import::map::Column;
use crate::import::stamps::are_whole_seconds;
use crate::import::units::{self, LogUnit};
use crate::recording::Unit;
use crate::stats::median_step;

/// Rates that are usual of an actuator's log, and units in the order in which they are tried [Hz].
const USUAL: std::ops::RangeInclusive<f64> = 20.0..=20e3;
const TRIED: [&str; 4] = ["s", "ms", "us", "ns"];
/// Rates at which numbers of a size may be stamps [Hz].
const POSSIBLE: std::ops::RangeInclusive<f64> = 0.5..=1e6;
/// Share of the times that must differ from one another for them to be those of samples.
const DISTINCT: f64 = 0.9;
/// Share by which a header's rate and that of times in a unit may differ, and the spans of two clocks.
const NEAR: f64 = 0.02;

/// Sizes of numbers that count from a beginning of time, of the years 2000 to 2060, in units that tell it.
#[rustfmt::skip] // A table: a unit a line.
const BY_SIZE: [(&str, [f64; 2]); 10] = [
    ("s", [9.4e8, 2.85e9]), ("ms", [9.4e11, 2.85e12]), ("us", [9.4e14, 2.85e15]), ("ns", [9.4e17, 2.85e18]),
    ("filetime", [1.259e17, 1.449e17]), ("dotnet_ticks", [6.30e17, 6.50e17]),
    ("excel_days", [36_526.0, 58_440.0]), ("excel_microdays", [3.6526e10, 5.844e10]), ("matlab_days", [730_486.0, 752_400.0]), ("labview_s", [3.03e9, 4.93e9]),
];

/// Words that name a counter of samples.
#[rustfmt::skip] // A table: a language a line.
const COUNTERS: [&str; 35] = [
    "sample", "samples", "no", "nr", "num", "number", "index", "idx", "n", "i", "k", "count", "counter", "row", "line", "record", "scan", "point", "id", "cycle", "seq", "sequence",
    "zeile", "lfd", "lfdnr", "nummer", "messpunkt", "punkt", "zaehler", "zyklus",
    "numero", "num\u{e9}ro", "muestra", "echantillon", "campione",
];

/// Statement of the map on the times.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TimeChoice {
    /// Keys and values of its table.
    pub keys: Vec<(&'static str, String)>,
    /// The rate that makes times of rows or of a counter [Hz].
    pub sample_rate: Option<f64>,
    pub because: Because,
    /// The open question.
    pub open: Option<String>,
    /// Whether nothing is to be read before it is answered.
    pub is_blocked: bool,
    /// Places of the columns that it takes.
    pub places: Vec<usize>,
    /// Samples a second that it makes, where that is stated [Hz].
    pub rate: f64,
}

/// A column as the map writes it.
pub(super) fn written(column: &Column) -> String {
    match column {
        Column::Number(number) => number.to_string(),
        Column::Name(name) => toml_text(name),
    }
}

/// A text in the quotes of TOML.
pub(super) fn toml_text(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            '\t' => quoted.push_str("\\t"),
            c if c.is_control() => quoted.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

/// Times of the messages of a bag: a column, and why that.
pub(super) fn of_messages(column: &str, because: &Because) -> TimeChoice {
    TimeChoice {
        keys: vec![("column", format!("{column:?}"))],
        because: because.clone(),
        ..TimeChoice::none()
    }
}

impl TimeChoice {
    /// Nothing chosen.
    fn none() -> Self {
        Self {
            keys: Vec::new(),
            sample_rate: None,
            because: Because::certain(""),
            open: None,
            is_blocked: false,
            places: Vec::new(),
            rate: 0.0,
        }
    }

    /// A question without whose answer nothing is to be read.
    pub fn ask(&mut self, what: String) {
        self.open = Some(what);
        self.is_blocked = true;
    }

    /// A question alone.
    pub fn asked(what: String, places: Vec<usize>) -> Self {
        let mut choice = Self::none();
        choice.places = places;
        choice.ask(what);
        choice
    }
}

/// Chooses the times of a log's columns, of which `logs` are there one behind the other; none where nothing looks like times.
pub(super) fn choose(columns: &[Seen], rates: &[SaidRate], logs: usize) -> Option<TimeChoice> {
    let all = columns.iter().enumerate();
    let worth = all.filter_map(|(place, column)| Some((worth(place, column, logs)?, place)));
    // The first of those that are worth as much.
    let best = worth.max_by_key(|(worth, place)| (*worth, usize::MAX - place));
    let Some((_, place)) = best else {
        let [said, ..] = rates else {
            return None;
        };
        return Some(TimeChoice {
            sample_rate: Some(said.rate),
            because: Because::certain(format!(
                "the header says `{}`, and no column holds times",
                said.words
            )),
            ..TimeChoice::none()
        });
    };
    Some(of_column(columns, place, rates, logs))
}

/// The times of a column, with the rates that the header says.
pub(super) fn of_column(
    columns: &[Seen],
    place: usize,
    rates: &[SaidRate],
    logs: usize,
) -> TimeChoice {
    let column = &columns[place];
    let mut choice = TimeChoice {
        keys: vec![("column", written(&column.column))],
        places: vec![place],
        ..TimeChoice::none()
    };
    // The rate of the columns behind it, or the only one.
    let said = rates
        .iter()
        .rfind(|said| said.place <= place + 1)
        .or(rates.first());
    match &column.cells {
        Cells::Stamps { .. } => of_stamps(columns, place, said, &mut choice),
        _ => of_numbers(columns, place, said, logs, &mut choice),
    }
    choice
}

/// Whether a column looks like times by more than that it stands first.
pub(super) fn is_time(place: usize, column: &Seen, logs: usize) -> bool {
    let said = says_time(&column.name) || in_seconds(column);
    match &column.cells {
        Cells::Stamps { has, .. } => has[1],
        _ => (said || place == 0) && worth(place, column, logs).is_some_and(|worth| worth > 0),
    }
}

fn in_seconds(column: &Seen) -> bool {
    column
        .unit
        .as_ref()
        .is_some_and(|said| said.unit.si == Unit::Second)
}

/// Aptness of a column as times.
fn worth(place: usize, column: &Seen, logs: usize) -> Option<i32> {
    let name = said(&column.name);
    let named = says_time(&column.name);
    let first = i32::from(place == 0);
    match &column.cells {
        Cells::Numbers(values) => {
            let rise = rises(values, logs)?;
            let in_time = in_seconds(column);
            let another = column.unit.is_some() && !in_time;
            let is_other = name.thing.is_some() && !named && !is_counter(column);
            let worth = 3 * i32::from(named) + 2 * i32::from(in_time) + first;
            let may = rise.is_rising(logs) || ((named || in_time) && rise.nearly());
            let penalty = if rise.is_rising(logs) { 0 } else { 3 };
            (may && worth > 0 && !another && !is_other).then_some(worth + 1 - penalty)
        }
        Cells::Stamps {
            has,
            distinct,
            rows,
            ..
        } => {
            let coarse = (*distinct as f64) < DISTINCT * *rows as f64;
            // A date by itself is the day of the times in another column.
            (has[1]).then_some(3 * i32::from(named) + 2 + first - 4 * i32::from(coarse))
        }
        Cells::States(_) | Cells::Other => None,
    }
}

/// How numbers rise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rise {
    /// Rows of the first log.
    count: usize,
    /// How often they fall, in all logs.
    falls: usize,
    /// How often they stay, in the first.
    stays: usize,
    /// Usual step.
    pub step: f64,
    /// First and last number of the first log.
    ends: [f64; 2],
}

impl Rise {
    /// Whether they rise throughout, but for the beginnings of further logs.
    pub fn is_rising(&self, logs: usize) -> bool {
        self.falls < logs && 2 * self.stays < self.count
    }

    /// Whether they rise but for a few falls, or stay often.
    fn nearly(&self) -> bool {
        50 * self.falls <= self.count && self.ends[1] > self.ends[0]
    }
}

/// How numbers rise, of `logs` one behind the other; those that are not there left out.
pub(super) fn rises(values: &[f64], logs: usize) -> Option<Rise> {
    let there: Vec<f64> = values
        .iter()
        .copied()
        .filter(|value| value.is_finite())
        .collect();
    if there.len() < 3 {
        return None;
    }
    // The newest first.
    if logs == 1 && there.windows(2).all(|pair| pair[1] < pair[0]) {
        let turned: Vec<f64> = there.into_iter().rev().collect();
        return rises(&turned, logs);
    }
    let falls = there.windows(2).filter(|pair| pair[1] < pair[0]).count();
    let first = there.windows(2).position(|pair| pair[1] < pair[0]);
    let first = match first {
        Some(at) if falls < logs => &there[..=at],
        _ => &there[..],
    };
    let stays = first.windows(2).filter(|pair| pair[1] == pair[0]).count();
    let mut moving = first.to_vec();
    moving.dedup();
    Some(Rise {
        count: first.len(),
        falls,
        stays,
        step: if moving.len() > 1 {
            median_step(&moving)
        } else {
            0.0
        },
        ends: [first[0], first[first.len() - 1]],
    })
}

/// Whether a column counts samples, by its name.
fn is_counter(column: &Seen) -> bool {
    let name = column.name.trim();
    let words = parts(name);
    name == "#"
        || words
            .first()
            .is_some_and(|word| COUNTERS.contains(&word.as_str()) && words.len() <= 2)
}

fn of_stamps(columns: &[Seen], place: usize, said: Option<&SaidRate>, choice: &mut TimeChoice) {
    let Cells::Stamps {
        has,
        distinct,
        rows,
        because,
        problem,
        times,
    } = &columns[place].cells
    else {
        return;
    };
    choice.because = because.clone();
    choice.open.clone_from(problem);
    let seconds: Vec<f64> = times.iter().map(|time| *time as f64 * 1e-9).collect();
    choice.rate = rises(&seconds, 1).map_or(0.0, |rise| 1.0 / rise.step);
    if (*distinct as f64) < DISTINCT * *rows as f64 {
        coarse(times, said, choice);
        return;
    }
    let is_turned = times.windows(2).all(|pair| pair[1] <= pair[0]);
    if let Some(at) = times.windows(2).position(|pair| pair[1] < pair[0])
        && has[0]
        && !is_turned
    {
        choice.ask(format!(
            "its times go back after the {}. of its rows: two recordings in one log?",
            at + 1
        ));
        return;
    }
    if has[0] {
        return;
    }
    let date = columns.iter().position(|column| {
        matches!(
            &column.cells,
            Cells::Stamps {
                has: [true, false],
                ..
            }
        )
    });
    let Some(date) = date else {
        choice.because.why += ", without a date: they count from midnight, or from a start";
        return;
    };
    let column = &columns[date];
    choice.keys.push(("date_column", written(&column.column)));
    choice.places.push(date);
    if let Cells::Stamps {
        problem, because, ..
    } = &column.cells
    {
        choice.because.why += &format!(", dates apart: {}", because.why);
        choice.open.clone_from(problem);
    }
}

/// Asks for the rate of stamps of which many are the same, with that which they count.
fn coarse(times: &[i64], said: Option<&SaidRate>, choice: &mut TimeChoice) {
    let changes: Vec<usize> = (1..times.len())
        .filter(|i| times[*i] != times[i - 1])
        .collect();
    let counted = match changes[..] {
        [first, .., last] => {
            let span = (times[last] - times[first]) as f64 * 1e-9;
            Some((last - first) as f64 / span).filter(|rate| rate.is_finite() && *rate > 0.0)
        }
        _ => None,
    };
    let what = if are_whole_seconds(times) {
        "its stamps are of whole seconds"
    } else {
        "many of its stamps are the same"
    };
    choice.keys.clear();
    choice.sample_rate = said.map(|said| said.rate).or(counted);
    let rate = match (said, counted) {
        (Some(said), _) => format!("the header says `{}`", said.words),
        (None, Some(counted)) => format!("they count {} rows a second", shown(counted)),
        (None, None) => "at what rate were they sampled?".to_owned(),
    };
    choice.ask(format!(
        "{what}, too coarse for times: {rate}; `sample_rate_hz` in place of `time` spaces rows evenly"
    ));
}

/// A column of numbers taken for times, and what tells their unit.
struct Numbers<'a> {
    column: &'a Seen,
    rise: Rise,
    said: Option<&'a SaidRate>,
    by_size: Option<&'static LogUnit>,
    by_stamps: Option<&'static LogUnit>,
}

fn of_numbers(
    columns: &[Seen],
    place: usize,
    said: Option<&SaidRate>,
    logs: usize,
    choice: &mut TimeChoice,
) {
    let column = &columns[place];
    let Some(mut rise) = rises(column.numbers(), logs) else {
        return;
    };
    let falls = rise.falls;
    let again = falls >= logs && begins_again(column.numbers());
    let starts = if again { logs + falls } else { logs };
    rise = rises(column.numbers(), starts).unwrap_or(rise);
    if !rise.is_rising(starts) {
        let what = if rise.falls > 0 {
            format!(
                "its times go back {} times: two recordings in one log?",
                rise.falls
            )
        } else {
            "most of its times are those of the row before, too coarse for times; `sample_rate_hz` in place of `time` spaces rows evenly".to_owned()
        };
        choice.ask(what);
        return;
    }
    let numbers = Numbers {
        column,
        rise,
        said,
        by_size: by_size(&rise),
        by_stamps: by_stamps(columns, place, &rise),
    };
    if let Some(of_name) = &column.unit {
        numbers.by_name(of_name, choice);
    } else if let Some(unit) = numbers.by_size {
        let why = format!("{} is of the size of such stamps", rise.ends[0]);
        set_unit(choice, unit, &rise, &why);
        choice.because.is_certain = said.is_some_and(|said| numbers.fits(unit, said.rate));
    } else {
        numbers.by_steps(choice);
    }
    if again {
        choice.because.is_certain = false;
        choice.because.why += &format!(
            "; its times go back {falls} times, as a clock that starts again: `idc import --split` writes each recording by itself"
        );
    }
}

/// Whether times go back as those of a clock that starts again, wherever they do.
fn begins_again(values: &[f64]) -> bool {
    let mut first = 0;
    let falls = (1..values.len()).filter(|row| values[*row] < values[row - 1]);
    falls.into_iter().all(|row| {
        let stamps = [values[first], values[row - 1], values[row]];
        first = row;
        starts_again(stamps)
    })
}

impl Numbers<'_> {
    /// Whether the steps in a unit are those of a rate.
    fn fits(&self, unit: &LogUnit, rate: f64) -> bool {
        (1.0 / (unit.factor * self.rise.step) / rate - 1.0).abs() < NEAR
    }

    /// The unit that the name says, unless size or stamps tell another.
    fn by_name(&self, of_name: &SaidUnit, choice: &mut TimeChoice) {
        let unit = of_name.unit;
        // A name such as `Time_ms` may be of days, as the size tells, or other stamps.
        let other = self
            .by_stamps
            .or(self.by_size.filter(|other| other.zero != 0.0))
            .filter(|other| (other.factor / unit.factor - 1.0).abs() > NEAR);
        if let Some(other) = other {
            let as_given = match self.by_stamps {
                Some(_) => "as other stamps of the log tell",
                None => "of the size of such stamps",
            };
            let first = shown(self.rise.ends[0]);
            let why = format!("its name says {}, but {first} is {as_given}", unit.name);
            set_unit(choice, other, &self.rise, &why);
            choice.because.is_certain = false;
            return;
        }
        let sized = self.by_size.filter(|other| other.factor == unit.factor);
        let unit = sized.unwrap_or(unit);
        set_unit(choice, unit, &self.rise, &of_name.because.why);
        choice.because.is_certain = of_name.because.is_certain;
        if let Some(said) = self.said.filter(|said| !self.fits(unit, said.rate)) {
            choice.because.is_certain = false;
            choice.because.why += &format!(", but the header says `{}`", said.words);
        }
    }

    /// The unit that header, stamps or steps tell; or the rate of a counter.
    fn by_steps(&self, choice: &mut TimeChoice) {
        let tried = || TRIED.iter().filter_map(|name| units::named(name));
        let by_header = self
            .said
            .and_then(|said| tried().find(|unit| self.fits(unit, said.rate)));
        let step = self.rise.step;
        let named = says_time(&self.column.name);
        if is_counter(self.column) || (!named && step == 1.0 && by_header.is_none()) {
            self.as_counter(choice);
            return;
        }
        if let Some(unit) = self.by_stamps {
            set_unit(choice, unit, &self.rise, "as other stamps of the log tell");
            return;
        }
        if let (Some(said), Some(unit)) = (self.said, by_header) {
            let why = format!("the header says `{}`", said.words);
            set_unit(choice, unit, &self.rise, &why);
            return;
        }
        let usual: Vec<&LogUnit> = tried()
            .filter(|unit| USUAL.contains(&(1.0 / (unit.factor * step))))
            .collect();
        // A step of one is one of any unit, or of a counter.
        if let ([only], None) = (&usual[..], self.said)
            && step != 1.0
        {
            let why = format!("nothing says it; steps of {}", shown(step));
            set_unit(choice, only, &self.rise, &why);
            choice.because = Because::likely(format!(
                "{why} make {} samples a second of it",
                shown(choice.rate)
            ));
            return;
        }
        let names: Vec<String> = usual
            .iter()
            .map(|unit| format!("{:?}", unit.name))
            .collect();
        let may = match (&names[..], self.said) {
            (_, Some(said)) => format!("fit in no unit what the header says, `{}`", said.words),
            ([], _) => "are usual of no unit".to_owned(),
            _ => format!("may be of {} or count samples", names.join(", ")),
        };
        choice.ask(format!(
            "its unit: steps of {} {may}; add `unit` to it, one of {}",
            shown(step),
            super::units::choices(Unit::Second)
        ));
    }

    /// A counter of samples, with the rate that the header says.
    fn as_counter(&self, choice: &mut TimeChoice) {
        match self.said {
            // Of a counter with other steps it is unknown whether the rate is that of rows or of counts.
            Some(said) if self.rise.step == 1.0 => {
                choice.sample_rate = Some(said.rate);
                choice.rate = said.rate;
                choice.because = Because {
                    is_certain: is_counter(self.column),
                    why: format!("it counts samples, and the header says `{}`", said.words),
                };
            }
            _ => choice.ask(format!(
                "it counts up by {} and may be a counter of samples: `sample_rate_hz` beside it says how many there are a second; or `unit` in it, if it holds times",
                shown(self.rise.step)
            )),
        }
    }
}

/// Puts a unit and why it is that.
fn set_unit(choice: &mut TimeChoice, unit: &LogUnit, rise: &Rise, why: &str) {
    choice.keys.push(("unit", format!("{:?}", unit.name)));
    choice.rate = 1.0 / (unit.factor * rise.step);
    choice.because = Because::certain(format!(
        "{why}, which makes {} samples a second",
        shown(choice.rate)
    ));
}

/// The unit of numbers that count from a beginning of time, by their size and steps.
fn by_size(rise: &Rise) -> Option<&'static LogUnit> {
    let fits = |(name, [low, high]): &(&str, [f64; 2])| {
        let unit = units::named(name)?;
        let within = rise.ends.iter().all(|end| (*low..=*high).contains(end));
        (within && POSSIBLE.contains(&(1.0 / (unit.factor * rise.step)))).then_some(unit)
    };
    BY_SIZE.iter().find_map(fits)
}

/// The unit in which numbers go on as long as the stamps of another column do.
fn by_stamps(columns: &[Seen], place: usize, rise: &Rise) -> Option<&'static LogUnit> {
    let stamps = columns
        .iter()
        .enumerate()
        .find_map(|(other, column)| match &column.cells {
            Cells::Stamps {
                times,
                has: [_, true],
                ..
            } if other != place => Some(times),
            _ => None,
        })?;
    let (first, last) = (stamps.first()?, stamps.last()?);
    let span = (last - first) as f64 * 1e-9;
    let own = rise.ends[1] - rise.ends[0];
    // Stamps may be of whole seconds.
    let near = |unit: &&LogUnit| {
        let sized = unit.zero == 0.0 || by_size(rise).is_some_and(|other| other == *unit);
        sized && (unit.factor * own - span).abs() < 1.0 + NEAR * span && span > 2.0
    };
    let mut fitting = units::UNITS
        .iter()
        .filter(|unit| unit.si == Unit::Second)
        .filter(near);
    let first = fitting.next()?;
    // A unit that tells the beginning of time as well is the better one.
    Some(fitting.find(|unit| unit.zero != 0.0).unwrap_or(first))
}

/// Why no column is taken for times, with what stands in the first ones.
pub(super) fn nothing_found(looked: &Looked) -> String {
    let mut what = "no column rises from row to row or holds stamps".to_owned();
    let others = looked.columns.iter().zip(&looked.samples);
    let others =
        others.filter(|(column, text)| matches!(column.cells, Cells::Other) && !text.is_empty());
    for (column, text) in others.take(2) {
        what += &format!("; {} holds texts such as `{text}`", described(column));
    }
    let named = looked
        .columns
        .iter()
        .find(|column| says_time(&column.name) && !column.numbers().is_empty());
    if let Some(column) = named
        && matches!(looked.time, TimeSeen::Column)
    {
        what += &format!("; {} does not rise throughout", described(column));
    }
    what + "; where rows follow each other at a rate, `sample_rate_hz` takes its place"
}

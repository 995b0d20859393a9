//! The rate that a header says: samples a second, or the time between two of them.

use super::seen::SaidRate;
use crate::import::numbers::{self, Marks, Seen};
use crate::import::units;
use crate::recording::Unit;

/// Words for samples a second.
#[rustfmt::skip] // A table: a language a line.
const RATES: [&str; 18] = [
    "samplerate", "samplingrate", "samplefrequency", "samplingfrequency", "samplingfreq", "scanrate", "acquisitionrate", "samplespersecond", "updaterate", "fs",
    "abtastrate", "abtastfrequenz", "messrate", "samplefrequenz",
    "frequencedechantillonnage", "frecuenciademuestreo", "frequenzadicampionamento", "samplerateinhz",
];
/// Words for the time between two.
#[rustfmt::skip] // A table: a language a line.
const STEPS: [&str; 17] = [
    "sampletime", "samplingtime", "sampleinterval", "samplinginterval", "sampleperiod", "samplingperiod", "deltax", "deltat", "timestep", "dt", "xincrement",
    "abtastzeit", "abtastintervall", "zykluszeit",
    "periodedechantillonnage", "periododemuestreo", "periododicampionamento",
];
/// Rates that a logger may have [Hz].
const POSSIBLE: std::ops::RangeInclusive<f64> = 1e-3..=1e7;

/// What a label is of, with the unit in its brackets.
struct Label {
    is_rate: bool,
    unit: Option<String>,
}

/// Rates that the lines of a header say.
pub(super) fn said(header: &[Vec<String>]) -> Vec<SaidRate> {
    header.iter().flat_map(|line| of_line(line)).collect()
}

/// Rates of a line: a label and its number in one field, or in fields behind each other.
fn of_line(cells: &[String]) -> Vec<SaidRate> {
    let mut found = Vec::new();
    let mut label: Option<(usize, Label)> = None;
    for (place, cell) in cells.iter().enumerate() {
        if let Some((head, rest)) = cell.split_once([':', '=']).or_else(|| before_number(cell))
            && let Some(own) = label_of(head)
            && let Some(rate) = rate(&own, rest, "")
        {
            found.push(said_at(place, rate, cell));
            continue;
        }
        if let Some(own) = label_of(cell.trim_end_matches([':', '='])) {
            label = Some((place, own));
            continue;
        }
        let Some((at, own)) = &label else { continue };
        let next = cells.get(place + 1).map_or("", String::as_str);
        if let Some(rate) = rate(own, cell, next) {
            // The first number stands for the column that the label heads.
            let from = if found.is_empty() || place == at + 1 {
                *at
            } else {
                place
            };
            found.push(said_at(from, rate, &format!("{} {cell}", cells[*at])));
        }
    }
    found
}

fn said_at(place: usize, rate: f64, words: &str) -> SaidRate {
    SaidRate {
        place,
        rate,
        words: words.trim().trim_start_matches('#').trim().to_owned(),
    }
}

/// A text parted before its first number.
fn before_number(cell: &str) -> Option<(&str, &str)> {
    let at = cell.find(|c: char| c.is_ascii_digit())?;
    (at > 0).then(|| cell.split_at(at))
}

/// What a label is of.
fn label_of(text: &str) -> Option<Label> {
    let unit = ['[', '('].into_iter().find_map(|open| {
        let (_, rest) = text.split_once(open)?;
        Some(rest.trim_end_matches([']', ')', ' ', ':', '=']).to_owned())
    });
    let head = text.split(['[', '(']).next().unwrap_or(text);
    let plain: String = head
        .chars()
        .flat_map(char::to_lowercase)
        .filter_map(letter)
        .collect();
    let is = |words: &[&str]| words.contains(&plain.as_str());
    match (is(&RATES), is(&STEPS)) {
        (true, _) => Some(Label {
            is_rate: true,
            unit,
        }),
        (_, true) => Some(Label {
            is_rate: false,
            // LabVIEW's step is in seconds.
            unit: unit.or_else(|| (plain == "deltax").then(|| "s".to_owned())),
        }),
        _ => None,
    }
}

/// A letter without its accent; none of what is no letter.
fn letter(c: char) -> Option<char> {
    match c {
        'é' | 'è' | 'ê' => Some('e'),
        'í' => Some('i'),
        'ó' => Some('o'),
        c => c.is_alphabetic().then_some(c),
    }
}

/// The rate of a number with its unit, which may stand behind it, in the next field or in the label.
fn rate(label: &Label, text: &str, next: &str) -> Option<f64> {
    let text = text.trim();
    let end = text.find(|c: char| !(c.is_ascii_digit() || ".,eE+-".contains(c)));
    let (number, behind) = text.split_at(end.unwrap_or(text.len()));
    let decimal = match numbers::seen(number) {
        Seen::Decimal(mark) => mark,
        // Of `1.000` it is unknown whether it is a thousand.
        Seen::Plain => '.',
        _ => return None,
    };
    let marks = Marks {
        decimal,
        thousands: None,
    };
    let number = marks.number(number).filter(|number| *number > 0.0)?;
    let behind = [behind.trim(), next.trim()]
        .into_iter()
        .find(|text| !text.is_empty());
    let named = |name: &str| rate_unit(name.trim().trim_matches(|c| "[]()".contains(c)));
    let unit = behind
        .and_then(named)
        .or_else(|| label.unit.as_deref().and_then(named));
    let rate = match (unit, label.is_rate) {
        (Some(RateUnit::Hertz(factor)), true) => factor * number,
        (Some(RateUnit::Seconds(factor)), false) => 1.0 / (factor * number),
        (None, true) if behind.is_none_or(|text| numbers::seen(text) != Seen::Other) => number,
        _ => return None,
    };
    POSSIBLE.contains(&rate).then_some(rate)
}

enum RateUnit {
    Hertz(f64),
    Seconds(f64),
}

fn rate_unit(name: &str) -> Option<RateUnit> {
    match name.to_lowercase().as_str() {
        "hz" | "s/s" | "sa/s" | "1/s" | "samples/s" | "sps" => Some(RateUnit::Hertz(1.0)),
        "khz" | "ks/s" | "ksa/s" => Some(RateUnit::Hertz(1e3)),
        "mhz" => Some(RateUnit::Hertz(1e6)),
        _ => {
            let unit =
                units::named(name).filter(|unit| unit.si == Unit::Second && unit.zero == 0.0)?;
            Some(RateUnit::Seconds(unit.factor))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_say_rates_in_many_ways() {
        for (line, rates) in [
            ("Sample rate;250;Hz", vec![(0, 250.0)]),
            ("Sample rate: 1 kHz", vec![(0, 1e3)]),
            ("# fs = 500", vec![(0, 500.0)]),
            ("Abtastrate [Hz];2400", vec![(0, 2400.0)]),
            ("Abtastzeit;0,5;ms", vec![(0, 2e3)]),
            ("Sampling interval (us) 100", vec![(0, 1e4)]),
            ("Fréquence d'échantillonnage : 100 Hz", vec![(0, 100.0)]),
            (
                "SampleTime[ms];0,2;SampleTime[ms];5",
                vec![(0, 5e3), (2, 200.0)],
            ),
            ("Delta_X;0,004;0,004", vec![(0, 250.0), (2, 250.0)]),
            // No unit, or that of something else.
            ("Abtastzeit;5", vec![]),
            ("Baud rate;115200", vec![]),
            ("Sample rate;fast", vec![]),
            ("Sample rate;1.000;Hz", vec![]),
            ("Sample rate;3 ms", vec![]),
        ] {
            let cells: Vec<String> = line.split(';').map(str::to_owned).collect();
            let found: Vec<(usize, f64)> = said(&[cells])
                .iter()
                .map(|said| (said.place, (said.rate * 1e6).round() / 1e6))
                .collect();
            assert_eq!(found, rates, "{line}");
        }
    }
}

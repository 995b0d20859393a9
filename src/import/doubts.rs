//! Signs that make a channel's unit or reading doubtful: what is seen, and what it looks like. Reported to the user, who decides; nothing is changed.
//!
//! Each rule says why. None refuses: a strange recording may be right.

use super::log::Series;
use super::lone::lone;
use super::map::{ChannelMap, Column, FileMap, Pressure};
use super::units::{self, LogUnit, UNITS};
use crate::recording::thousandfold::thousandfold;
use crate::recording::{Recording, Unit};
use crate::stats::median_step;
use nalgebra::{DMatrix, DVector};

/// Atmosphere, and what it is at most away from that at sea level and on hills [Pa].
const ATMOSPHERE: f64 = 101_325.0;
const WEATHER: f64 = 5e3;
/// Pressure above its least that a recording must reach for that least to be called a rest [Pa].
const EXCURSION: f64 = 5e4;
/// Share of samples that make a rest.
const REST: f64 = 0.02;
/// Ends of the ranges of converters and amplifiers [V].
const RAILS: [f64; 5] = [2.5, 3.3, 4.096, 5.0, 10.0];
/// Ranges whose halves, quarters and so on are converters' steps [V]; 4.096 V has steps of whole millivolts, as any rounding has.
const RANGES: [f64; 2] = [10.0, 3.3];
/// Largest distance of a number from one of those, relatively.
const CLOSE: f64 = 1e-3;
/// Bits of a converter, fewest and most.
const BITS: std::ops::RangeInclusive<i32> = 8..=24;
/// Analogue outputs end here, with some over-range [V].
const OUTPUT: f64 = 10.5;
/// Share of a channel's variance that motion must explain for it to be a controller's output.
const EXPLAINED: f64 = 0.99;
/// A sample a second or fewer, for longer than this, is rare [Hz, s].
const SLOW: [f64; 2] = [1.0, 3600.0];
/// Samples a second that no logger of an actuator takes [Hz].
const FAST: f64 = 1e6;
/// Words that end names without being meant as units.
const NO_UNITS: [&str; 9] = [
    "in", "min", "A", "meter", "metre", "day", "second", "volt", "amp",
];

/// Doubts about a channel by itself: `values` that are there, the range of them, the step of its converter, and where it is cut off [SI].
#[must_use]
pub fn of_channel(
    channel: &ChannelMap,
    values: &[f64],
    range: [f64; 2],
    quantum: Option<f64>,
    cut_off_at: &[f64],
) -> Vec<String> {
    let mut doubts = Vec::new();
    doubts.extend(by_name(channel));
    doubts.extend(by_size(channel.unit, range));
    if channel.is_plain() && !matches!(channel.unit.si, Unit::Volt | Unit::One | Unit::Second) {
        doubts.extend(by_rail(channel.unit, cut_off_at));
        doubts.extend(by_step(channel.unit, quantum));
        doubts.extend(by_counts(channel.unit, range, values));
    }
    doubts.extend(by_rest(channel, range, values));
    doubts.extend(by_neighbours(channel, values));
    if let Some(fallen) = thousandfold(values) {
        doubts.push(format!(
            "falls to a thousandth from one sample to the next {} times and never goes beyond: looks like a thousands mark read as a decimal mark; `thousands_mark` in [[file]] names it",
            fallen.count
        ));
    }
    doubts
}

/// Single values far from all others, as marks of missing ones are.
fn by_neighbours(channel: &ChannelMap, values: &[f64]) -> Option<String> {
    let written: Vec<f64> = values.iter().map(|value| channel.written(*value)).collect();
    let found = lone(&written, channel.unit.si)?;
    // The rounding of the way there and back.
    let first = format!("{}", (found.first * 1e9).round() / 1e9);
    let first = if found.first.abs() < 1e6 {
        first
    } else {
        format!("{:e}", found.first)
    };
    Some(format!(
        "{} of {} values lie far from their neighbours and from all others, the first as {first} in the log: \
         if they stand for no value, `missing = [{first}]` in [[file]] says so",
        found.count,
        values.len()
    ))
}

/// Largest value that is usual in a recording of an actuator, least and most [SI].
fn usual(unit: Unit) -> Option<[f64; 2]> {
    match unit {
        Unit::Pascal => Some([2e3, 5e6]),
        Unit::Metre => Some([1e-5, 5.0]),
        Unit::MetrePerSecond => Some([1e-5, 20.0]),
        Unit::MetrePerSecondSquared => Some([1e-2, 2e4]),
        Unit::Newton => Some([5e-2, 1e5]),
        Unit::Kelvin => Some([230.0, 450.0]),
        Unit::Radian => Some([1e-6, 100.0]),
        _ => None,
    }
}

/// Values that nobody has, which in another unit of the kind would be usual.
fn by_size(unit: &LogUnit, range: [f64; 2]) -> Option<String> {
    let [least, most] = usual(unit.si)?;
    let peak = range[0].abs().max(range[1].abs());
    if peak == 0.0 || !peak.is_finite() || (least..=most).contains(&peak) {
        return None;
    }
    let written = peak / unit.factor - unit.zero;
    let fits = |other: &&LogUnit| {
        other.si == unit.si && (least..=most).contains(&other.to_si(written).abs())
    };
    let others: Vec<&str> = UNITS.iter().filter(fits).map(|other| other.name).collect();
    let what = if peak > most { "much" } else { "little" };
    let otherwise = if others.is_empty() {
        "in no known unit would it be usual: is it another quantity, or has it a gain?".to_owned()
    } else {
        format!("in {} it would be usual", others.join(", "))
    };
    Some(format!(
        "reaches {peak:.3e} {} at most, {what} for such a quantity; {otherwise}",
        unit.si.symbol()
    ))
}

/// A column whose name ends in another unit than the map's, without a gain between them.
fn by_name(channel: &ChannelMap) -> Option<String> {
    let Column::Name(name) = &channel.column else {
        return None;
    };
    // `position[1]` is an element, and no unit.
    let named = unit_of_name(name).filter(|unit| unit.si != Unit::One)?;
    let same = named.si == channel.unit.si
        && (named.factor / channel.unit.factor - 1.0).abs() < 1e-9
        && named.zero == channel.unit.zero;
    if same || !channel.is_plain() {
        return None;
    }
    let how = if named.si == channel.unit.si {
        format!("is `unit = \"{}\"` meant?", named.name)
    } else {
        format!(
            "`gain` makes {} of {}, and none is given",
            channel.unit.name, named.name
        )
    };
    Some(format!(
        "its column's name `{name}` says {}, the map {}: {how}",
        named.name, channel.unit.name
    ))
}

/// The unit that a column's name ends with: in brackets, or behind an underscore where it cannot be a word or an index.
pub(super) fn unit_of_name(name: &str) -> Option<&'static LogUnit> {
    let name = name.trim();
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((_, inside)) = name.strip_suffix(close).and_then(|n| n.rsplit_once(open)) {
            return units::named(inside);
        }
    }
    let words: Vec<&str> = name.split(['_', ' ']).filter(|w| *w != "per").collect();
    let after_first = words.len().saturating_sub(1);
    for count in (2..=after_first.min(3)).rev() {
        let last = &words[words.len() - count..];
        let compound = units::named(&last.join("/")).or_else(|| units::named(&last.join(" ")));
        if compound.is_some() {
            return compound;
        }
    }
    let last = words.last().filter(|_| after_first > 0)?;
    // `p_s` is a supply pressure and `F_m` a measured force as often as not.
    let plain = last.len() == 1 && last.chars().all(|c| !c.is_ascii_uppercase());
    if plain || NO_UNITS.contains(last) {
        return None;
    }
    units::named(last)
}

fn is_close(number: f64, to: f64) -> bool {
    (number / to - 1.0).abs() < CLOSE
}

/// Values that stay at the end of a converter's range.
fn by_rail(unit: &LogUnit, cut_off_at: &[f64]) -> Option<String> {
    let written = cut_off_at.iter().map(|value| value / unit.factor);
    let rail = written
        .into_iter()
        .find(|number| RAILS.iter().any(|rail| is_close(number.abs(), *rail)))?;
    Some(format!(
        "stays at {rail:.3}, where a converter or an amplifier of volts ends: looks like a sensor or a controller's output in volts, taken for {}; \
         `gain` and `offset` make {} of volts",
        unit.name, unit.name
    ))
}

/// Steps that are those of a converter of volts.
fn by_step(unit: &LogUnit, quantum: Option<f64>) -> Option<String> {
    let written = quantum? / unit.factor;
    let (range, bits) = RANGES.iter().find_map(|range| {
        let bits = (range / written).log2().round();
        let fits = BITS.contains(&(bits as i32)) && is_close(written, range / bits.exp2());
        fits.then_some((range, bits))
    })?;
    Some(format!(
        "moves in steps of {written:.5e}, which is {range} V over 2^{bits}: looks like a converter's volts, taken for {}; `gain` and `offset` make {} of them",
        unit.name, unit.name
    ))
}

/// Whole numbers that end where a converter's counts do.
fn by_counts(unit: &LogUnit, range: [f64; 2], values: &[f64]) -> Option<String> {
    let written = |value: f64| value / unit.factor - unit.zero;
    let whole = |number: f64| (number - number.round()).abs() < 1e-6 * number.abs().max(1.0);
    let top = written(range[1]);
    let full = BITS
        .flat_map(|bits| [(2.0f64).powi(bits) - 1.0, (2.0f64).powi(bits - 1) - 1.0])
        .find(|full| (top - full).abs() < 1e-3)?;
    values.iter().all(|value| whole(written(*value))).then(|| {
        format!(
            "is made of whole numbers up to {full}, where a converter ends: looks like its counts, taken for {}; `gain` and `offset` make {} of them",
            unit.name, unit.name
        )
    })
}

/// A pressure at rest where the other kind of pressure rests.
fn by_rest(channel: &ChannelMap, range: [f64; 2], values: &[f64]) -> Option<String> {
    let kind = channel.pressure?;
    // As the log has it, above the atmosphere or absolute.
    let [low, high] = range.map(|value| value - channel.above);
    let near = |level: f64| {
        let rests = |value: &&f64| (**value - channel.above - level).abs() < WEATHER;
        let count = values.iter().filter(rests).count();
        count as f64 > REST * values.len() as f64
    };
    let bar = low / 1e5;
    match kind {
        Pressure::Gauge if low < -1.05 * ATMOSPHERE => Some(format!(
            "falls to {bar:.2} bar above the atmosphere, below no pressure at all"
        )),
        Pressure::Gauge
            if (low - ATMOSPHERE).abs() < WEATHER && high - low > EXCURSION && near(ATMOSPHERE) =>
        {
            Some(format!(
                "rests at {bar:.3} bar and never falls below it: looks absolute, where the map says gauge"
            ))
        }
        Pressure::Absolute if low < -WEATHER => Some(format!(
            "falls to {bar:.2} bar, and no absolute pressure is negative: looks gauge, where the map says absolute"
        )),
        Pressure::Absolute if low.abs() < WEATHER && high - low > EXCURSION && near(0.0) => Some(
            format!("rests at {bar:.3} bar, a vacuum: looks gauge, where the map says absolute"),
        ),
        _ => None,
    }
}

/// A time in another unit: samples too slow for too long, or too fast.
#[must_use]
pub fn of_time(file: &FileMap, series: &Series) -> Option<String> {
    let unit = file.time.as_ref()?.unit?;
    let step = median_step(&series.time);
    let span = series.time[series.time.len() - 1] - series.time[0];
    let (is_slow, is_fast) = (1.0 / step <= SLOW[0] && span > SLOW[1], 1.0 / step > FAST);
    if !is_slow && !is_fast {
        return None;
    }
    let other = |name: &str| {
        let factor = units::named(name)?.factor / unit.factor;
        let rate = 1.0 / (step * factor);
        let fits = rate > SLOW[0] && rate <= FAST / 10.0;
        fits.then(|| {
            format!(
                "in {name} it would be one every {:.4} s over {:.1} s",
                step * factor,
                span * factor
            )
        })
    };
    let otherwise = if is_slow {
        ["ms", "us", "ns"].iter().find_map(|name| other(name))
    } else {
        ["us", "ms", "s"].iter().find_map(|name| other(name))
    };
    Some(format!(
        "has a sample every {step:.3e} s over {span:.1} s by the map's `unit = \"{}\"`{}",
        unit.name,
        otherwise.map_or_else(String::new, |text| format!("; {text}"))
    ))
}

/// A force that is within volts, and that motion explains as a controller's law does.
///
/// ```text
/// force = a (x - y) + b dy/dt + c
/// ```
#[must_use]
pub fn of_command(recording: &Recording, channel: &ChannelMap) -> Option<String> {
    if !channel.is_plain() || !matches!(channel.unit.si, Unit::Newton | Unit::NewtonMetre) {
        return None;
    }
    let force = recording.channel(&channel.quantity)?;
    let written = force.values.iter().map(|value| value / channel.unit.factor);
    let peak = written.fold(0.0, |most: f64, number| most.max(number.abs()));
    if peak > OUTPUT {
        return None;
    }
    let places: Vec<_> = recording
        .channels()
        .iter()
        .filter(|c| matches!(c.unit, Unit::Metre | Unit::Radian))
        .collect();
    for x in &places {
        for y in places
            .iter()
            .filter(|y| y.quantity != x.quantity && y.unit == x.unit)
        {
            let share = explained(recording.time(), &force.values, &x.values, &y.values);
            if let Some(share) = share.filter(|share| *share > EXPLAINED) {
                return Some(format!(
                    "is to {:.2} % a sum of `{}` less `{}` and of the speed of `{}`, and never beyond {peak:.1}: looks like a controller's output in volts, \
                     taken for {}; `gain` makes {} of volts",
                    100.0 * share,
                    x.quantity,
                    y.quantity,
                    y.quantity,
                    channel.unit.name,
                    channel.unit.name
                ));
            }
        }
    }
    None
}

/// Share of a force's variance that x - y, dy/dt and a constant explain.
fn explained(time: &[f64], force: &[f64], x: &[f64], y: &[f64]) -> Option<f64> {
    let speed = |i: usize| (y[i] - y[i - 1]) / (time[i] - time[i - 1]);
    let rows: Vec<[f64; 4]> = (1..time.len())
        .map(|i| [force[i], x[i] - y[i], speed(i), 1.0])
        .filter(|row| row.iter().all(|v| v.is_finite()))
        .collect();
    if rows.len() < 100 {
        return None;
    }
    let right = DVector::from_iterator(rows.len(), rows.iter().map(|row| row[0]));
    let mut left = DMatrix::from_fn(rows.len(), 3, |i, j| rows[i][j + 1]);
    let mut normal = DMatrix::zeros(3, 3);
    for j in 0..3 {
        let size = left.column(j).norm();
        if size == 0.0 {
            return None;
        }
        left.column_mut(j).scale_mut(1.0 / size);
    }
    left.tr_mul_to(&left, &mut normal);
    let weights = normal.cholesky()?.solve(&left.tr_mul(&right));
    let rest = (&right - &left * weights).norm_squared();
    let mean = right.mean();
    let all: f64 = right.iter().map(|v| (v - mean).powi(2)).sum();
    (all > 0.0).then(|| 1.0 - rest / all)
}

#[cfg(test)]
mod tests {
    use super::super::findings;
    use super::*;
    use crate::recording::RecordedChannel;

    fn doubts(channel: &ChannelMap, written: impl Fn(f64) -> f64) -> String {
        let time: Vec<f64> = (0..4000).map(|i| f64::from(i) * 0.01).collect();
        let values = time.iter().map(|t| channel.to_si(written(*t))).collect();
        findings::finding(&Series { time, values }, channel)
            .doubts
            .join("\n")
    }

    /// Something between -1 and 1 that looks random.
    fn rough(t: f64) -> f64 {
        (1e5 * t + 3e4 * t * t).sin()
    }

    #[test]
    fn a_size_that_nobody_has_names_the_units_in_which_it_would_be_usual() {
        let cases: [(&str, &str, f64, &str); 4] = [
            ("pressure_gauge", "Pa", 4.0, "bar"),
            ("pressure_gauge", "bar", 2e5, "Pa"),
            ("stroke", "m", 140.0, "mm"),
            ("temperature", "K", 21.0, "degC"),
        ];
        for (quantity, unit, size, other) in cases {
            let said = doubts(&ChannelMap::unconverted(quantity, unit), |t| {
                size * (1.0 + 0.1 * t.sin())
            });
            assert!(
                said.contains("usual") && said.contains(other),
                "{quantity}: {said}"
            );
        }
        let said = doubts(&ChannelMap::unconverted("stroke", "mm"), |t| 40.0 * t.sin());
        assert_eq!(said, "");
    }

    #[test]
    fn a_columns_name_that_says_another_unit_counts_as_much_as_the_map() {
        let named = |column: &str, unit: &str| {
            let mut channel = ChannelMap::unconverted("force", unit);
            channel.column = Column::Name(column.to_owned());
            channel
        };
        for (column, unit, says) in [
            ("vir_V", "N", "`gain` makes N of V"),
            ("stroke [mm]", "m", "unit = \"mm\""),
            ("v_tcp_m_s", "mm/s", "unit = \"m/s\""),
            ("F (kN)", "N", "unit = \"kN\""),
        ] {
            let said = by_name(&named(column, unit)).unwrap_or_default();
            assert!(said.contains(says), "{column}: {said}");
        }
        for (column, unit) in [
            ("F_N", "N"),
            ("F_m", "N"),
            ("p_in", "bar"),
            ("p_s", "bar"),
            ("v_tcp_m_s", "m/s"),
            ("contact_force_n", "N"),
            ("/joint_states.effort[1]", "N"),
            ("data(:,1)", "N"),
            ("V", "N"),
        ] {
            assert_eq!(by_name(&named(column, unit)), None, "{column}");
        }
        let mut geared = named("vir_V", "N");
        geared.gain = 35.0;
        assert_eq!(by_name(&geared), None);
    }

    #[test]
    fn what_ends_at_ten_or_moves_in_a_converters_steps_is_taken_for_volts() {
        let force = ChannelMap::unconverted("force", "N");
        let said = doubts(&force, |t| {
            (14.0 * t.sin() + 0.1 * rough(t)).clamp(-10.0, 10.0)
        });
        assert!(
            said.contains("stays at") && said.contains("10.000"),
            "{said}"
        );
        let said = doubts(&force, |t| 20.0 / 4096.0 * (900.0 * t.sin()).round());
        assert!(said.contains("10 V over 2^11"), "{said}");
        let said = doubts(&force, |t| {
            (2047.5 + 3000.0 * t.sin()).round().clamp(0.0, 4095.0)
        });
        assert!(said.contains("counts"), "{said}");
        let mut scaled = force.clone();
        scaled.gain = 50.0;
        let said = doubts(&scaled, |t| {
            (14.0 * t.sin() + 0.1 * rough(t)).clamp(-10.0, 10.0)
        });
        assert_eq!(said, "");
        let said = doubts(&force, |t| 0.01 * (900.0 * t.sin()).round());
        assert_eq!(said, "");
    }

    #[test]
    fn gauge_and_absolute_are_distinguished_by_where_they_rest() {
        let stroke = |t: f64| 3.0 * (t - 20.0).clamp(0.0, 1.0);
        let mut channel = ChannelMap::unconverted("pressure_gauge", "bar");
        let said = doubts(&channel, |t| 1.013 + stroke(t) + 0.001 * rough(t));
        assert!(said.contains("looks absolute"), "{said}");
        assert_eq!(doubts(&channel, |t| stroke(t) + 0.001 * rough(t)), "");
        // A regulator that holds one bar is at rest there too, but goes nowhere else.
        assert_eq!(doubts(&channel, |t| 1.0 + 0.01 * rough(t)), "");
        channel.pressure = Some(Pressure::Absolute);
        channel.above = -ATMOSPHERE;
        let said = doubts(&channel, |t| stroke(t) + 0.001 * rough(t));
        assert!(said.contains("looks gauge"), "{said}");
        assert_eq!(
            doubts(&channel, |t| 1.013 + stroke(t) + 0.001 * rough(t)),
            ""
        );
    }

    #[test]
    fn a_controllers_output_is_known_by_its_law() {
        let time: Vec<f64> = (0..4000).map(|i| f64::from(i) * 1e-3).collect();
        let y: Vec<f64> = time.iter().map(|t| 0.1 * (3.0 * t).sin()).collect();
        let x: Vec<f64> = time
            .iter()
            .zip(&y)
            .map(|(t, y)| y + 1e-4 * (17.0 * t).sin())
            .collect();
        let law = |i: usize| match i {
            0 => 0.0,
            i => 2e4 * (x[i] - y[i]) - 5.0 * (y[i] - y[i - 1]) / 1e-3,
        };
        let measured = |i: usize| 3.0 * (y[i] * 40.0).signum() + 2.0 * rough(time[i]);
        let recording = |force: &dyn Fn(usize) -> f64| {
            let force = (0..time.len()).map(force).collect();
            let channels = vec![
                RecordedChannel::new("force", Unit::Newton, force),
                RecordedChannel::new("x", Unit::Metre, x.clone()),
                RecordedChannel::new("y", Unit::Metre, y.clone()),
            ];
            Recording::new(time.clone(), channels, Vec::new()).unwrap()
        };
        let said = of_command(&recording(&law), &ChannelMap::unconverted("force", "N")).unwrap();
        assert!(said.contains("controller's output"), "{said}");
        assert_eq!(
            of_command(
                &recording(&measured),
                &ChannelMap::unconverted("force", "N")
            ),
            None
        );
        let mut scaled = ChannelMap::unconverted("force", "N");
        scaled.gain = 35.0;
        assert_eq!(of_command(&recording(&law), &scaled), None);
    }
}

//! A law on one line, as a person tries one: `port: expression; constant = low..high unit; constant = value unit`.

use std::ops::Range;

use thiserror::Error;

use super::own::is_name;
use crate::plant::{
    Constant, Expression, ExpressionError, LawText, MOST_CONSTANTS, Port, SYMBOLS, Unit, kept_name,
};

/// Name of such a law among effects.
pub const TRIED: &str = "tried";
/// Between the ends of a range.
const TO: &str = "..";
/// Ratio of the ends of a range of one sign from which its middle is taken in proportion [1].
const WIDE: f64 = 10.0;

/// A line that is no law.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LineError {
    /// Nothing before the expression.
    #[error(
        "there is no port, expected \"PORT: EXPRESSION; CONSTANT = LOW..HIGH\" with a port of {}",
        ports()
    )]
    NoPort,
    /// A port that there is not.
    #[error("the port is {found:?}, expected one of {}", ports())]
    Port {
        /// What stands there.
        found: String,
    },
    /// An expression that is none.
    #[error("at `{part}`, character {location} of the expression: {reason}")]
    Expression {
        /// The part.
        part: String,
        /// Its first character, from 1.
        location: usize,
        /// In words.
        reason: String,
    },
    /// A constant that is none.
    #[error("{found:?} is no constant, expected {expected}")]
    Constant {
        /// What stands there.
        found: String,
        /// What should.
        expected: String,
    },
    /// A constant that the expression does not have.
    #[error("the expression has no `{name}`, expected only constants that it uses")]
    Unused {
        /// Its name.
        name: String,
    },
    /// Nothing to be fitted.
    #[error("no constant has a range, expected at least one to be found, as in \"c = 100..1000\"")]
    NothingFree,
    /// More constants than a law has.
    #[error("it has {count} constants, expected {MOST_CONSTANTS} at most")]
    TooMany {
        /// How many.
        count: usize,
    },
}

fn ports() -> String {
    Port::ALL.map(Port::name).join(", ")
}

/// Reads a law: numbers in SI, a unit behind them if one likes.
///
/// # Errors
/// What is wrong, with its place in the expression.
pub fn law_of_line(line: &str) -> Result<LawText, LineError> {
    let (name, rest) = line.split_once(':').ok_or(LineError::NoPort)?;
    let name = name.trim();
    let mut ports = Port::ALL.into_iter();
    let port = ports
        .find(|port| port.name() == name)
        .ok_or_else(|| LineError::Port {
            found: name.to_owned(),
        })?;
    let mut parts = rest.split(';').map(str::trim);
    let text = parts.next().unwrap_or_default();
    let mut constants: Vec<Constant> = Vec::new();
    for part in parts.filter(|part| !part.is_empty()) {
        let constant = constant(part)?;
        if constants.iter().any(|known| known.name == constant.name) {
            return Err(LineError::Constant {
                found: part.to_owned(),
                expected: "each constant once".to_owned(),
            });
        }
        constants.push(constant);
    }
    if constants.len() > MOST_CONSTANTS {
        let count = constants.len();
        return Err(LineError::TooMany { count });
    }
    // Free ones first.
    constants.sort_by_key(|constant| constant.range.is_none());
    let names: Vec<&str> = (SYMBOLS.iter().map(|symbol| symbol.name))
        .chain(constants.iter().map(|constant| constant.name))
        .collect();
    let at = |error: ExpressionError| in_expression(text, &error.span, error.reason);
    let law = LawText {
        name: TRIED,
        port,
        expression: Expression::read(text, &names).map_err(at)?,
        constants,
    };
    for (location, constant) in law.constants.iter().enumerate() {
        if !law.is_bristle_stiffness(constant) && !law.expression.uses(SYMBOLS.len() + location) {
            let name = constant.name.to_owned();
            return Err(LineError::Unused { name });
        }
    }
    if law
        .constants
        .iter()
        .all(|constant| constant.range.is_none())
    {
        return Err(LineError::NothingFree);
    }
    law.check_units().map_err(at)?;
    Ok(law)
}

/// A fault at a part of an expression.
fn in_expression(text: &str, span: &Range<usize>, reason: String) -> LineError {
    let part = text.get(span.clone()).unwrap_or_default();
    LineError::Expression {
        part: if part.is_empty() { "its end" } else { part }.to_owned(),
        location: text.get(..span.start).unwrap_or(text).chars().count() + 1,
        reason,
    }
}

/// A constant: a value or a range, and its unit.
fn constant(part: &str) -> Result<Constant, LineError> {
    let refuse = |expected: &str| LineError::Constant {
        found: part.to_owned(),
        expected: expected.to_owned(),
    };
    let form = "NAME = VALUE or NAME = LOW..HIGH, with a unit of SI behind it if one likes";
    let (name, value) = part.split_once('=').ok_or_else(|| refuse(form))?;
    let (name, value) = (name.trim(), value.trim());
    if !is_name(name) {
        return Err(refuse("a name of letters, digits and _"));
    }
    if let Some(symbol) = SYMBOLS.iter().find(|symbol| symbol.name == name) {
        let meaning = symbol.meaning;
        return Err(refuse(&format!(
            "another name: `{name}` is {meaning} in an expression"
        )));
    }
    let numeric = |c: char| c.is_ascii_digit() || "+-.eE".contains(c);
    let end = value.find(|c| !numeric(c)).unwrap_or(value.len());
    let (numbers, unit) = value.split_at(end);
    if numbers.is_empty() {
        return Err(refuse(form));
    }
    let unit = Some(unit.trim()).filter(|unit| !unit.is_empty());
    if let Some(unit) = unit
        && Unit::read(unit).is_err()
    {
        return Err(refuse("a unit of SI without prefixes, as in \"N s/m\""));
    }
    let number = |text: &str| -> Result<f64, LineError> {
        let number: Option<f64> = text.trim().parse().ok();
        number
            .filter(|number| number.is_finite())
            .ok_or_else(|| refuse(form))
    };
    let (value, range) = match numbers.split_once(TO) {
        None => (number(numbers)?, None),
        Some((low, high)) => {
            let range @ [low, high] = [number(low)?, number(high)?];
            if low >= high {
                return Err(refuse("the least value first, then a larger one"));
            }
            (middle(range), Some(range))
        }
    };
    Ok(Constant {
        name: kept_name(name),
        value,
        unit: unit.map(kept_name),
        range,
    })
}

fn middle([low, high]: [f64; 2]) -> f64 {
    if low > 0.0 && high > WIDE * low {
        (low * high).sqrt()
    } else {
        0.5 * (low + high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::Moment;

    #[test]
    fn a_line_is_a_law_with_the_constants_to_be_found_first() {
        let law = law_of_line(
            " piston_force : -c * max(v, 0) + k * x; k = -30 N/m; c = 100..1000 N s/m ",
        )
        .unwrap();
        assert_eq!(law.port, Port::PistonForce);
        let [c, k] = &law.constants[..] else {
            panic!("{:?}", law.constants)
        };
        assert_eq!(
            (c.name, c.range, c.unit),
            ("c", Some([100.0, 1000.0]), Some("N s/m"))
        );
        assert!((c.value - 550.0).abs() < 1e-9);
        assert_eq!((k.name, k.value, k.range), ("k", -30.0, None));
        let moment = Moment {
            speed: 0.2,
            stroke: 0.01,
            ..Moment::default()
        };
        assert!((law.value(&moment, &[200.0]) - (-40.0 - 0.3)).abs() < 1e-12);
    }

    #[test]
    fn a_range_of_decades_starts_in_the_middle_of_them() {
        let law = law_of_line("first_chamber_leak: a; a = 1e-8..1e-4").unwrap();
        assert!((law.constants[0].value / 1e-6 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_no_law_is_reported_with_its_location() {
        for (line, said) in [
            ("-c * v; c = 1..2", "there is no port"),
            (
                "piston: -c * v; c = 1..2",
                "the port is \"piston\", expected one of piston_force, friction",
            ),
            (
                "piston_force: -c * y; c = 1..2",
                "at `y`, character 6 of the expression: there is no `y` here",
            ),
            (
                "piston_force: -c * v +; c = 1..2",
                "at `its end`, character 9",
            ),
            (
                "piston_force: -c * v; c = 1..2 N/m",
                "it is in N/s, expected N",
            ),
            (
                "piston_force: -c * v; c = 1..2 N/mm",
                "a unit of SI without prefixes",
            ),
            ("piston_force: -c * v; c = 2..1", "the least value first"),
            ("piston_force: -c * v; c = many", "expected NAME = VALUE"),
            (
                "piston_force: -c * v; v = 1..2",
                "`v` is speed of extension",
            ),
            (
                "piston_force: -c * v; c = 1..2; c = 3",
                "each constant once",
            ),
            ("piston_force: -c * v; c = 1..2; d = 3", "no `d`"),
            ("piston_force: -c * v; c = 2", "no constant has a range"),
        ] {
            let message = law_of_line(line).unwrap_err().to_string();
            assert!(message.contains(said), "{line}: {message}");
        }
    }
}

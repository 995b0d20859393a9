//! `[latent]` of an improved rig file: a term that no known effect explains, as `crate::plant::Latent` has it.
//!
//! ```text
//! port = "piston_force"            where it enters
//! variable = "stroke_m"            on what it depends
//! directed = false                 whether it turns with the motion
//! from_m = 0.021                   first and last of evenly spaced knots, in the variable's unit, and the value at each in the port's unit;
//! to_m = 0.034                     linear between them, constant beyond
//! value_n = [0.1, -3.2, ...]
//!
//! frequency_hz = 6.4               or, over time, sine and cosine of this frequency and of its multiples
//! sine_pa = [4100.0, 120.0]
//! cosine_pa = [-800.0, 95.0]
//! ```

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::super::effects::as_written;
use super::entry::Entry;
use crate::keys::check::{Section, plain};
use crate::keys::document::Document;
use crate::keys::error::ScenarioError;
use crate::keys::suggestion::{join, nearest};
use crate::plant::{Basis, Latent, MOST_COEFFICIENTS, Port, Variable};

/// Name of the table.
pub(super) const TABLE: &str = "latent";
/// Beyond any rig, in the SI unit of whatever it is [SI].
const FAR: f64 = 1e9;
/// Frequencies of a periodic term [Hz].
const FREQUENCIES: [f64; 2] = [1e-3, 1e4];

type Table = BTreeMap<String, Entry>;

/// The term of a file.
pub(super) fn latent(
    document: &Document<'_>,
    table: Option<&Table>,
) -> Result<Option<Latent>, ScenarioError> {
    let Some(table) = table else { return Ok(None) };
    let reader = Reader {
        section: Section::new(document, TABLE),
        document,
        table,
    };
    reader.read().map(Some)
}

/// Keys of a term.
struct Keys {
    from: String,
    to: String,
    value: String,
    sine: String,
    cosine: String,
}

const FREQUENCY: &str = "frequency_hz";

fn keys(port: Port, variable: Variable) -> Keys {
    let [of_port, of_variable] = [port.suffix(), variable.suffix()];
    Keys {
        from: format!("from_{of_variable}"),
        to: format!("to_{of_variable}"),
        value: format!("value_{of_port}"),
        sine: format!("sine_{of_port}"),
        cosine: format!("cosine_{of_port}"),
    }
}

struct Reader<'a> {
    section: Section<'a>,
    document: &'a Document<'a>,
    table: &'a Table,
}

impl Reader<'_> {
    fn read(&self) -> Result<Latent, ScenarioError> {
        let ports = Port::ALL.map(|port| (port.name(), port));
        let port = self.choice("port", &ports)?;
        let variables = Variable::ALL.map(|variable| (variable.name(), variable));
        let variable = self.choice("variable", &variables)?;
        let directed = match self.entry("directed", "true or false")? {
            Entry::Flag(flag) => *flag,
            other => return Err(self.refuse("directed", other, "true or false".to_owned())),
        };
        let names = keys(port, variable);
        let waves = self.table.contains_key(FREQUENCY);
        if waves && variable != Variable::Time {
            let reason =
                "a periodic term is one over time, and variable is not \"time\"".to_owned();
            return Err(self.section.misplaced(FREQUENCY, reason));
        }
        let basis_keys: &[&str] = if waves {
            &[FREQUENCY, &names.sine, &names.cosine]
        } else {
            &[&names.from, &names.to, &names.value]
        };
        self.refuse_unknown(basis_keys)?;
        let (basis, coefficients) = if waves {
            self.waves(&names)?
        } else {
            self.hats(&names)?
        };
        Ok(Latent {
            port,
            variable,
            directed,
            basis,
            coefficients,
        })
    }

    fn hats(&self, names: &Keys) -> Result<(Basis, Vec<f64>), ScenarioError> {
        let from = self.number(&names.from, [-FAR, FAR])?;
        let to = self.number(&names.to, [-FAR, FAR])?;
        if to <= from {
            let expected = format!("more than {}, {}", names.from, plain(from));
            return Err(self.section.refuse(&names.to, plain(to), expected));
        }
        let values = self.list(&names.value, 2, MOST_COEFFICIENTS)?;
        Ok((Basis::Hats { ends: [from, to] }, values))
    }

    fn waves(&self, names: &Keys) -> Result<(Basis, Vec<f64>), ScenarioError> {
        let frequency = self.number(FREQUENCY, FREQUENCIES)?;
        let sines = self.list(&names.sine, 1, MOST_COEFFICIENTS / 2)?;
        let cosines = self.list(&names.cosine, sines.len(), sines.len())?;
        let pairs = sines.into_iter().zip(cosines);
        let coefficients = pairs.flat_map(|(sine, cosine)| [sine, cosine]).collect();
        Ok((Basis::Waves { frequency }, coefficients))
    }

    fn refuse_unknown(&self, basis: &[&str]) -> Result<(), ScenarioError> {
        let mut known = vec!["port", "variable", "directed"];
        known.extend(basis);
        match self.table.keys().find(|key| !known.contains(&key.as_str())) {
            None => Ok(()),
            Some(key) => {
                let dotted = join(TABLE, key);
                Err(ScenarioError::UnknownKey {
                    location: self.document.key_location(&dotted),
                    key: dotted,
                    advice: nearest(key, &known),
                })
            }
        }
    }

    fn entry(&self, key: &str, expected: &str) -> Result<&Entry, ScenarioError> {
        let entry = self.table.get(key);
        entry.ok_or_else(|| self.section.missing(key, expected))
    }

    fn refuse(&self, key: &str, found: &Entry, expected: String) -> ScenarioError {
        self.section.refuse(key, found.to_string(), expected)
    }

    fn choice<T: Copy>(&self, key: &str, choices: &[(&str, T)]) -> Result<T, ScenarioError> {
        let names: Vec<String> = choices
            .iter()
            .map(|(name, _)| format!("{name:?}"))
            .collect();
        let expected = format!("one of {}", names.join(", "));
        let entry = self.entry(key, &expected)?;
        let chosen = choices
            .iter()
            .find(|(name, _)| matches!(entry, Entry::Text(text) if text == name));
        match chosen {
            Some((_, choice)) => Ok(*choice),
            None => Err(self.refuse(key, entry, expected)),
        }
    }

    fn number(&self, key: &str, [low, high]: [f64; 2]) -> Result<f64, ScenarioError> {
        let expected = format!("a number from {} to {}", plain(low), plain(high));
        match self.entry(key, &expected)? {
            Entry::Number(number) if (low..=high).contains(number) => Ok(*number),
            other => Err(self.refuse(key, other, expected)),
        }
    }

    fn list(&self, key: &str, least: usize, most: usize) -> Result<Vec<f64>, ScenarioError> {
        let expected = if least == most {
            format!("a list of {least}")
        } else {
            format!("a list of {least} to {most} numbers")
        };
        let entry = self.entry(key, &expected)?;
        let Entry::List(list) = entry else {
            return Err(self.refuse(key, entry, expected));
        };
        if !(least..=most).contains(&list.len()) {
            let found = format!("a list of {}", list.len());
            return Err(self.section.refuse(key, found, expected));
        }
        match list
            .iter()
            .position(|value| value.is_nan() || value.abs() > FAR)
        {
            None => Ok(list.clone()),
            Some(index) => {
                let key = format!("{key}[{index}]");
                let expected = format!("a number from {} to {}", plain(-FAR), plain(FAR));
                Err(self.section.refuse(&key, plain(list[index]), expected))
            }
        }
    }
}

/// The term as a table of a file.
pub(super) fn text(latent: &Latent) -> String {
    let names = keys(latent.port, latent.variable);
    let shown = |value: f64| plain(as_written(value));
    let mut text = format!(
        "\n# Found: physics that no known effect explains, as a term over {}.\n[{TABLE}]\nport = {:?}\nvariable = {:?}\ndirected = {}\n",
        latent.variable.name(),
        latent.port.name(),
        latent.variable.name(),
        latent.directed,
    );
    let list = |values: &mut dyn Iterator<Item = &f64>| {
        let values: Vec<String> = values.map(|value| float(&shown(*value))).collect();
        format!("[{}]", values.join(", "))
    };
    let c = &latent.coefficients;
    // Writing into a text cannot fail.
    let _ = match latent.basis {
        // Its law stands among the effects.
        Basis::Formula(_) => return String::new(),
        Basis::Hats { ends } => write!(
            text,
            "{} = {}\n{} = {}\n{} = {}\n",
            names.from,
            shown(ends[0]),
            names.to,
            shown(ends[1]),
            names.value,
            list(&mut c.iter()),
        ),
        Basis::Waves { frequency } => write!(
            text,
            "{FREQUENCY} = {}\n{} = {}\n{} = {}\n",
            shown(frequency),
            names.sine,
            list(&mut c.iter().step_by(2)),
            names.cosine,
            list(&mut c.iter().skip(1).step_by(2)),
        ),
    };
    text
}

/// A number that TOML reads as one with a fraction, so that a list holds numbers of one kind.
pub(super) fn float(text: &str) -> String {
    if text.contains(['.', 'e', 'E']) {
        text.to_owned()
    } else {
        format!("{text}.0")
    }
}

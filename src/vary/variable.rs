//! What is varied: a key and its values, as they are typed.

use std::collections::BTreeSet;

use crate::scenario::listed;

/// Values of one variable at most where each is named or counted.
const MOST: usize = 1_000_000;

/// A key with the values that it may have.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Dotted key of the scenario.
    pub key: String,
    /// Its values.
    pub values: Values,
}

/// Values of a key.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Those named, as they are typed.
    Listed(Vec<String>),
    /// So many from the first to the last, evenly.
    Even {
        /// First and last.
        ends: [f64; 2],
        /// Their number.
        count: usize,
    },
    /// Whole numbers from the first to the last, each of them; of a key that is no count, any number between ([`Variable::of_key`]).
    Whole([i64; 2]),
    /// Any number between two; for samples alone.
    Between([f64; 2]),
}

/// A sweep that cannot be.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum VaryError {
    /// A setting that is none.
    #[error("{text}: {reason}")]
    Setting {
        /// As typed.
        text: String,
        /// The fault, and what was expected.
        reason: String,
    },
    /// A key that is given twice.
    #[error("{key} is given twice, expected all its values in one --set")]
    Twice {
        /// The key.
        key: String,
    },
    /// A range that a grid cannot take.
    #[error(
        "{key} is any number between two, and a grid needs to know how many: expected {key}=a..b:COUNT, or --sample random:N or latin:N"
    )]
    Uncounted {
        /// The key.
        key: String,
    },
    /// Too many runs, or none.
    #[error("they ask for {count} runs, expected 1 to {most}")]
    Count {
        /// Their number.
        count: String,
        /// The most.
        most: usize,
    },
    /// A sampling that there is not.
    #[error("`{text}` is no sampling; expected grid, random:N or latin:N with a number of runs")]
    NoSampling {
        /// As typed.
        text: String,
    },
    /// A table of points that is none.
    #[error("{file}: {reason}")]
    Table {
        /// The file.
        file: String,
        /// The fault, and what was expected.
        reason: String,
    },
}

impl Variable {
    /// As it is typed: `KEY=v,v,..`, `KEY=a..b:COUNT`, `KEY=1..200` or `KEY=1.5..2.5`.
    ///
    /// # Errors
    /// It is none of these, or an empty range.
    pub fn parse(text: &str) -> Result<Self, VaryError> {
        let refuse = |reason: &str| VaryError::Setting {
            text: text.to_owned(),
            reason: reason.to_owned(),
        };
        let expected = "expected KEY=VALUES with a key of the scenario by its dotted path and VALUES as 30,60 or 1e5..3e5:5 or 1..200";
        let (key, values) = text.split_once('=').ok_or_else(|| refuse(expected))?;
        let (key, values) = (key.trim(), values.trim());
        if key.is_empty() || values.is_empty() {
            return Err(refuse(expected));
        }
        let values = match range(values) {
            Some(range) => range.map_err(|reason| refuse(&reason))?,
            None => Values::Listed(named(values).map_err(|reason| refuse(&reason))?),
        };
        Ok(Self {
            key: key.to_owned(),
            values,
        })
    }

    /// With the values that its key can have: between whole ends a count has whole numbers, any other key any number.
    #[must_use]
    pub fn of_key(self, is_count: impl FnOnce(&str, i64) -> bool) -> Self {
        match self.values {
            Values::Whole(ends) if !is_count(&self.key, ends[0]) => Self {
                values: Values::Between(ends.map(|end| end as f64)),
                ..self
            },
            _ => self,
        }
    }

    /// Which values it has, in words.
    #[must_use]
    pub fn words(&self) -> &'static str {
        match self.values {
            Values::Listed(_) => "each as named",
            Values::Even { .. } => "evenly spaced",
            Values::Whole(_) => "whole numbers",
            Values::Between(_) => "any number between",
        }
    }

    /// Number of its values; none where they are not counted.
    #[must_use]
    pub fn count(&self) -> Option<usize> {
        match &self.values {
            Values::Listed(values) => Some(values.len()),
            Values::Even { count, .. } => Some(*count),
            Values::Whole([first, last]) => {
                usize::try_from(last.abs_diff(*first)).ok()?.checked_add(1)
            }
            Values::Between(_) => None,
        }
    }

    /// The value of a place among those counted.
    #[must_use]
    pub fn at(&self, place: usize) -> String {
        match &self.values {
            Values::Listed(values) => values[place].clone(),
            Values::Whole([first, _]) => (first + place as i64).to_string(),
            Values::Even { count: 1, ends } | Values::Between(ends) => number(ends[0]),
            Values::Even { ends, count } => {
                let share = place as f64 / (count - 1) as f64;
                // Both ends to the last digit.
                let value = ends[0] * (1.0 - share) + ends[1] * share;
                number(tidy(value, ends[1] - ends[0]))
            }
        }
    }

    /// The value at a share from 0 to below 1 of what it may have.
    #[must_use]
    pub fn at_share(&self, share: f64) -> String {
        match (&self.values, self.count()) {
            (_, Some(count)) => self.at(((share * count as f64) as usize).min(count - 1)),
            (Values::Between([low, high]), _) => number(low + share * (high - low)),
            (_, None) => String::new(),
        }
    }

    /// Values that lie at the ends, or all that are named: what is checked before anything is run.
    #[must_use]
    pub fn to_check(&self) -> Vec<String> {
        match &self.values {
            Values::Listed(values) => values.clone(),
            Values::Even { ends, .. } | Values::Between(ends) => ends.map(number).to_vec(),
            Values::Whole(ends) => ends.map(|end| end.to_string()).to_vec(),
        }
    }
}

/// Digits of a step's sum that are rounding alone, as in 0.30000000000000004, are taken away.
fn tidy(value: f64, span: f64) -> f64 {
    let least = span.abs() * 1e-12;
    if least == 0.0 {
        return value;
    }
    let decimals = (-least.log10().ceil()).clamp(0.0, 17.0) as usize;
    format!("{value:.decimals$}").parse().unwrap_or(value)
}

fn number(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e15 {
        format!("{value:.0}")
    } else {
        format!("{value}")
    }
}

/// A range, if the text has two numbers with dots between.
fn range(text: &str) -> Option<Result<Values, String>> {
    let (ends, count) = match text.split_once(':') {
        Some((ends, count)) => (ends, Some(count)),
        None => (text, None),
    };
    let (first, last) = ends.split_once("..")?;
    let read = |text: &str| text.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    let ends = [read(first)?, read(last)?];
    let whole = |text: &str| text.trim().parse::<i64>().ok();
    let empty = || {
        Err(format!(
            "the range is empty, as {} is not below {}",
            first.trim(),
            last.trim()
        ))
    };
    Some(
        match (
            count.map(|count| (count, count.trim().parse())),
            whole(first).zip(whole(last)),
        ) {
            (Some((_, Ok(count @ 2..=MOST))), _) if ends[0] != ends[1] => {
                Ok(Values::Even { ends, count })
            }
            (Some((_, Ok(_))), _) if ends[0] == ends[1] => empty(),
            (Some((count, _)), _) => Err(format!(
                "`{count}` is no number of values, expected 2 to {MOST}"
            )),
            (None, Some((first, last))) if first < last => Ok(Values::Whole([first, last])),
            (None, None) if ends[0] < ends[1] => Ok(Values::Between(ends)),
            (None, _) => empty(),
        },
    )
}

/// Values that are named, each once.
fn named(text: &str) -> Result<Vec<String>, String> {
    let values = listed(text);
    if values.iter().any(String::is_empty) {
        return Err("a value between commas is empty".to_owned());
    }
    let mut seen = BTreeSet::new();
    match values.iter().find(|value| !seen.insert(*value)) {
        Some(twice) => Err(format!("{twice} is in it twice, expected each value once")),
        None => Ok(values),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Vec<String> {
        let variable = Variable::parse(text).unwrap();
        (0..variable.count().unwrap())
            .map(|at| variable.at(at))
            .collect()
    }

    #[test]
    fn values_are_what_is_typed() {
        assert_eq!(all("a.b=30,60"), ["30", "60"]);
        assert_eq!(
            all("a=1e5..3e5:5"),
            ["100000", "150000", "200000", "250000", "300000"]
        );
        assert_eq!(all("a=0..1:11")[3], "0.3");
        assert_eq!(all("a=3..1:3"), ["3", "2", "1"]);
        assert_eq!(all("a=1e-9..3e-9:3")[1], "0.000000002");
        assert_eq!(all("a=-1..2"), ["-1", "0", "1", "2"]);
        assert_eq!(
            all("device.model=../a.toml,b.toml"),
            ["../a.toml", "b.toml"]
        );
        let real = Variable::parse("a=-1..1").unwrap().of_key(|_, _| false);
        assert_eq!(real.values, Values::Between([-1.0, 1.0]));
        let between = Variable::parse("a=1.5..2.5").unwrap();
        assert_eq!(
            (between.count(), between.at_share(0.25)),
            (None, "1.75".to_owned())
        );
        let whole = Variable::parse("a=1..4").unwrap();
        assert_eq!(
            [0.0, 0.49, 0.999].map(|share| whole.at_share(share)),
            ["1", "2", "4"]
        );
    }

    #[test]
    fn what_is_no_variable_is_refused_with_what_was_expected() {
        for (text, expected) in [
            ("force_n", "expected KEY=VALUES"),
            ("=30", "expected KEY=VALUES"),
            ("a=", "expected KEY=VALUES"),
            ("a=1,,2", "between commas is empty"),
            ("a=1,1", "1 is in it twice"),
            ("a=5..1", "the range is empty, as 5 is not below 1"),
            ("a=2.5..2.5", "the range is empty"),
            ("a=2..2:4", "the range is empty"),
            ("a=1..2:0", "`0` is no number of values"),
            ("a=1..2:x", "`x` is no number of values"),
        ] {
            let refused = Variable::parse(text).unwrap_err().to_string();
            assert!(refused.contains(expected), "{text}: {refused}");
        }
    }
}

//! What an answer states of an effect: where it is, and its numbers, in the order of the vocabulary.

use std::fmt;
use std::ops::{Deref, DerefMut};

use serde::de::{Deserializer, MapAccess, Visitor};
use serde::ser::{SerializeMap, Serializer};
use serde::{Deserialize, Serialize};

use super::estimate::Estimate;

/// What says where an effect is; a part of its name, without an interval.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Place {
    /// A joint, by its number from 1.
    Count(usize),
    /// A link, a recording or a channel, by its name.
    Name(String),
}

impl From<usize> for Place {
    fn from(number: usize) -> Self {
        Self::Count(number)
    }
}

impl From<&str> for Place {
    fn from(name: &str) -> Self {
        Self::Name(name.to_owned())
    }
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count(number) => write!(formatter, "{number}"),
            Self::Name(name) => formatter.write_str(name),
        }
    }
}

/// Place and numbers; the numbers where it is read as a list.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Parameters {
    /// Where it is, by key.
    pub place: Vec<(String, Place)>,
    numbers: Vec<(String, Estimate)>,
}

impl Parameters {
    /// Of an effect that has a place.
    #[must_use]
    pub fn placed(place: Vec<(String, Place)>, numbers: Vec<(String, Estimate)>) -> Self {
        Self { place, numbers }
    }

    /// The place in words, as in ` (joint 2)`, to stand behind a name; empty where there is none.
    #[must_use]
    pub fn place_words(&self) -> String {
        let words = self.place.iter().map(|(key, place)| match place {
            Place::Count(number) => format!("{key} {number}"),
            Place::Name(name) => name.clone(),
        });
        match words.collect::<Vec<_>>().join(" to ") {
            none if none.is_empty() => none,
            words => format!(" ({words})"),
        }
    }
}

impl From<Vec<(String, Estimate)>> for Parameters {
    fn from(numbers: Vec<(String, Estimate)>) -> Self {
        Self::placed(Vec::new(), numbers)
    }
}

impl FromIterator<(String, Estimate)> for Parameters {
    fn from_iter<I: IntoIterator<Item = (String, Estimate)>>(numbers: I) -> Self {
        numbers.into_iter().collect::<Vec<_>>().into()
    }
}

impl Deref for Parameters {
    type Target = Vec<(String, Estimate)>;

    fn deref(&self) -> &Self::Target {
        &self.numbers
    }
}

impl DerefMut for Parameters {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.numbers
    }
}

impl<'a> IntoIterator for &'a Parameters {
    type Item = &'a (String, Estimate);
    type IntoIter = std::slice::Iter<'a, (String, Estimate)>;

    fn into_iter(self) -> Self::IntoIter {
        self.numbers.iter()
    }
}

impl Serialize for Parameters {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let count = self.place.len() + self.numbers.len();
        let mut map = serializer.serialize_map(Some(count))?;
        for (key, place) in &self.place {
            map.serialize_entry(key, place)?;
        }
        for (key, estimate) in &self.numbers {
            map.serialize_entry(key, estimate)?;
        }
        map.end()
    }
}

/// An entry of the table.
#[derive(Deserialize)]
#[serde(untagged)]
enum Entry {
    Number(Estimate),
    Place(Place),
}

impl<'de> Deserialize<'de> for Parameters {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct InOrder;
        impl<'de> Visitor<'de> for InOrder {
            type Value = Parameters;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a table of numbers with their intervals")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Parameters, A::Error> {
                let mut found = Parameters::default();
                while let Some((key, entry)) = map.next_entry()? {
                    match entry {
                        Entry::Number(estimate) => found.numbers.push((key, estimate)),
                        Entry::Place(place) => found.place.push((key, place)),
                    }
                }
                Ok(found)
            }
        }
        deserializer.deserialize_map(InOrder)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_among_the_numbers_as_it_is() {
        let place = vec![("joint".to_owned(), Place::from(2))];
        let numbers = vec![("offset_n_m".to_owned(), Estimate::new(4.0, 3.5, 4.5))];
        let written = Parameters::placed(place, numbers);
        let text = serde_json::to_string(&written).unwrap();
        assert!(
            text.starts_with(r#"{"joint":2,"offset_n_m":{"value":4.0"#),
            "{text}"
        );
        assert_eq!(serde_json::from_str::<Parameters>(&text).unwrap(), written);
        assert_eq!(written.place_words(), " (joint 2)");
    }
}

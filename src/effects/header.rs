//! The header comment of an effect's file, read for people: the one place where its physics is described.
//!
//! ```text
//! first paragraph    what it is in a sentence, then where it comes from
//! fenced lines       equation
//! next paragraph     legend, and on a line of its own `Source:`
//! `Signature:`       what it looks like in the signals
//! `Confused with:`   a line `- NAME: how the two are distinguished.` each
//! ```

use std::collections::BTreeMap;
use std::sync::LazyLock;

use super::{
    CATALOGUE, CELL_EFFECTS, JOINT_EFFECTS, JOINT_FRICTION, LINK_EFFECTS, NUMBERS_OFF, SERVO_LAG,
};
use super::{Effect, vocabulary};

/// The parts of a header; a part that is missing is empty.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Header {
    /// Meaning of the effect, to be put into a sentence.
    pub meaning: String,
    /// Where it comes from; may be empty.
    pub cause: String,
    /// Equation, line by line.
    pub equation: Vec<&'static str>,
    /// Symbols of the equation with their units.
    pub legend: String,
    /// Where the equation comes from.
    pub source: String,
    /// Its look in the signals.
    pub signature: String,
    /// Effects with which it is confused, and how they are distinguished.
    pub rivals: Vec<(String, String)>,
}

/// Every effect once, those of joints of the first joint, in the order of the catalogue; those of a part of a device last.
pub fn kinds() -> impl Iterator<Item = &'static Effect> {
    CATALOGUE
        .iter()
        .chain(&CELL_EFFECTS)
        .chain(JOINT_EFFECTS.iter().take(1).flatten())
        .chain(JOINT_FRICTION.iter().take(1))
        .chain([&SERVO_LAG])
        .chain(LINK_EFFECTS)
}

/// Headers by the effects' names in the vocabulary.
static HEADERS: LazyLock<BTreeMap<&'static str, Header>> = LazyLock::new(|| {
    kinds()
        .chain(NUMBERS_OFF.iter().take(1))
        .map(|effect| (effect.vocabulary().0, Header::of(effect.text)))
        .collect()
});

/// An effect in a few words.
#[must_use]
pub fn meaning(effect: &str) -> &'static str {
    let number = NUMBERS_OFF.iter().find(|number| number.name == effect);
    let name = number.map_or_else(|| vocabulary(effect).0, |number| number.vocabulary().0);
    let header = HEADERS.get(name);
    header.map_or("physics beyond the nominal model", |header| &header.meaning)
}

impl Effect {
    /// The header of its file.
    pub fn header(&self) -> &'static Header {
        static NONE: LazyLock<Header> = LazyLock::new(Header::default);
        HEADERS.get(self.vocabulary().0).unwrap_or(&NONE)
    }
}

impl Header {
    fn of(file: &'static str) -> Self {
        let mut header = Self::default();
        let mut first = String::new();
        let mut part = Part::First;
        let lines = file.lines().map_while(|line| line.strip_prefix("//!"));
        for line in lines {
            let mut words = line.trim();
            if let Some(fence) = words.strip_prefix("```") {
                part = if fence.is_empty() {
                    Part::Legend
                } else {
                    Part::Equation
                };
                continue;
            }
            for (label, labelled) in [
                ("Source:", Part::Source),
                ("Signature:", Part::Signature),
                ("Confused with:", Part::Rivals),
            ] {
                if let Some(rest) = words.strip_prefix(label) {
                    (part, words) = (labelled, rest.trim());
                }
            }
            let text = match part {
                Part::First => &mut first,
                Part::Equation => {
                    (header.equation).push(line.strip_prefix(' ').unwrap_or(line).trim_end());
                    continue;
                }
                Part::Legend => &mut header.legend,
                Part::Source => &mut header.source,
                Part::Signature => &mut header.signature,
                Part::Rivals => {
                    match words.strip_prefix("- ").map(|rival| rival.split_once(": ")) {
                        Some(rival) => {
                            let (name, apart) = rival.unwrap_or_default();
                            header.rivals.push((name.to_owned(), apart.to_owned()));
                            continue;
                        }
                        None => match header.rivals.last_mut() {
                            Some((_, apart)) => apart,
                            None => continue,
                        },
                    }
                }
            };
            if !text.is_empty() && !words.is_empty() {
                text.push(' ');
            }
            text.push_str(words);
        }
        let (meaning, cause) = first.split_once(". ").unwrap_or((&first, ""));
        let mut letters = meaning.trim_end_matches('.').chars();
        let small = letters.next().into_iter().flat_map(char::to_lowercase);
        header.meaning = small.chain(letters).collect();
        cause.clone_into(&mut header.cause);
        header
    }
}

#[derive(Clone, Copy)]
enum Part {
    First,
    Equation,
    Legend,
    Source,
    Signature,
    Rivals,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_has_words_of_its_own() {
        let mut seen = std::collections::BTreeSet::new();
        for effect in kinds() {
            let words = meaning(effect.name);
            assert_ne!(words, meaning(""), "{effect:?}");
            assert!(seen.insert(words), "{effect:?}");
        }
    }

    #[test]
    fn every_effect_s_file_has_all_parts_and_is_its_own() {
        let names: Vec<&str> = kinds().map(|effect| effect.vocabulary().0).collect();
        for effect in kinds() {
            let name = effect.vocabulary().0;
            assert!(
                effect.text.contains(&format!("effect(\"{name}\", ")),
                "the text of {name} is another effect's"
            );
            let header = effect.header();
            assert!(!header.equation.is_empty(), "{name} has no equation");
            for (part, text) in [
                ("legend", &header.legend),
                ("source", &header.source),
                ("signature", &header.signature),
            ] {
                assert!(text.ends_with('.'), "{name}: {part} is {text:?}");
            }
            assert!(header.legend.contains('['), "{name}: no unit in its legend");
            assert!(!header.rivals.is_empty(), "{name} is confused with nothing");
            for (rival, apart) in &header.rivals {
                assert!(apart.ends_with('.'), "{name}: {rival}: {apart:?}");
                let one = rival.split(' ').next().unwrap_or_default();
                assert!(
                    !one.contains('_') || (names.contains(&one) && *rival != name),
                    "{name}: there is no {rival} to confuse it with"
                );
            }
        }
    }

    #[test]
    fn every_symbol_of_an_equation_is_in_its_legend() {
        let is_part = |c: char| c.is_alphanumeric() || c == '_';
        for effect in kinds() {
            let header = effect.header();
            let words: Vec<&str> = header.legend.split(|c| !is_part(c)).collect();
            for symbol in (header.equation.iter()).flat_map(|line| line.split(|c| !is_part(c))) {
                // Longer ones without an index are functions, or prose about the equation; what flows in or out is one symbol.
                let is_letter = symbol.len() == 1 && symbol.starts_with(char::is_alphabetic);
                if !(is_letter || symbol.contains('_')) || ["e", "i"].contains(&symbol) {
                    continue;
                }
                let stem = symbol.trim_end_matches("_in").trim_end_matches("_out");
                let differential = symbol.strip_prefix('d').unwrap_or(symbol);
                let known = |words: &&str| {
                    [symbol, stem, differential].contains(words)
                        || (symbol.ends_with('_') && words.starts_with(symbol))
                };
                assert!(
                    words.iter().any(known),
                    "{effect:?}: {symbol} is not in its legend"
                );
            }
        }
    }
}

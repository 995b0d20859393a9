//! The missing physics, its share of the mismatch, and the rest.

use super::super::details::{DetectableReport, IN_TURN, PredictionError, RemainingError};
use super::super::estimate::Limit;
use super::super::finding::Diagnosis;
use super::super::words::{
    CHANNEL_UNITS, CHANNEL_WORDS, capital, display_name, listed, of_column, percent,
    reference_noise, with_interval,
};
use super::MOST_OTHERS;
use super::link::EXPLAINING;
use crate::diagnosis::answer::{Extent, FoundLaw};
use crate::diagnosis::difference::links::Link;
use crate::diagnosis::fit::hypothesis::effect_display_name;
use crate::diagnosis::recordings::recorded::COLUMNS;
use crate::diagnosis::search::ruled_out::RuledOut;
use crate::effects::meaning;
use crate::quantity::{change, significant};

impl Diagnosis {
    pub(super) fn what_is_missing(&self) -> Vec<String> {
        let mut paragraphs = Vec::new();
        for (effect, numbers) in &self.estimates.effects {
            let law = self.law_of(effect);
            let numbers: Vec<String> = numbers
                .iter()
                .filter(|n| n.reported || self.is_of_link())
                .map(|n| {
                    let constant =
                        law.and_then(|law| law.constants.iter().find(|c| c.name == n.name));
                    let (words, unit, factor) = match constant {
                        Some(constant) => (
                            format!("{} =", n.name),
                            constant.unit.unwrap_or_default(),
                            1.0,
                        ),
                        None => display_name(n.name),
                    };
                    let interval = n.interval.map(|end| end * factor);
                    let value = with_interval(n.value * factor, interval, unit);
                    match n.at_limit {
                        Some(limit) => format!(
                            "{words} {value}, at the {} end of the range that is searched",
                            end(limit)
                        ),
                        None => format!("{words} {value}"),
                    }
                })
                .collect();
            let subsystem = effect.subsystem.name().replace('_', " ");
            let confidence = self.confidence(effect.name);
            let doubt = self.doubt_words(effect.name);
            paragraphs.push(format!(
                "{} ({subsystem}): {}. {}. Probability {}; the intervals are those of 95 %.{doubt}",
                effect_display_name(effect.name),
                law.map_or_else(
                    || meaning(effect.name).to_owned(),
                    |law| FoundLaw::of(law).words()
                ),
                match law {
                    None => capital(&listed(&numbers)),
                    Some(_) => format!("With {}", listed(&numbers)),
                },
                probability(confidence)
            ));
        }
        paragraphs.extend(self.family_words());
        paragraphs.extend(self.unlisted_words());
        paragraphs.extend(self.left_words());
        paragraphs.extend(self.smallest_that_show());
        let displaced = self.displaced();
        if !displaced.is_empty() {
            paragraphs.push(format!(
                "It stands in place of {} in the rig file.",
                listed(&displaced)
            ));
        }
        if let Some(share) = self.explained_share() {
            let several = self.best().effects.len() + usize::from(self.shape.is_some()) > 1;
            paragraphs.push(format!(
                "{} {} of the mismatch, and {} {}{}.",
                if several {
                    "Together they explain"
                } else {
                    "It explains"
                },
                percent(share),
                if several { "leave" } else { "leaves" },
                self.most_left(),
                self.prediction_words()
            ));
        }
        paragraphs
    }

    /// What known effects leave far above the noise.
    fn left_words(&self) -> Option<String> {
        self.leaves_model_discrepancy().then(|| {
            "Beside it, or in its place, there is physics that no known effect explains: a channel is left far above its noise.".to_owned()
        })
    }

    fn smallest_that_show(&self) -> Option<String> {
        (!self.detectable.is_empty()).then(|| {
            "No effect that is named. The smallest that these recordings would have shown, each alone and nine times in ten, if not always by its name:".to_owned()
        })
    }

    /// The smallest effects that the recordings would have shown, a line each; none where one was found.
    pub(super) fn smallest_table(&self) -> Option<String> {
        let all = self.smallest_reported();
        let wide = all.iter().map(|smallest| smallest.effect.len()).max()?;
        let line = |smallest: &DetectableReport| {
            format!("  {:<wide$}   {}\n", smallest.effect, smallest.words())
        };
        Some(all.iter().map(line).collect())
    }

    /// The largest remaining error beside its noise: a share of what is explained says nothing of the size of the rest.
    fn most_left(&self) -> String {
        let errors = self.remaining_errors();
        match errors.first() {
            Some(error) if error.is_beyond_noise() => error.words(self.reference_noise()),
            _ => format!("no more than {}", self.reference_noise()),
        }
    }

    /// Tolerated numbers of the rig file that an effect has taken the place of.
    fn displaced(&self) -> Vec<String> {
        let kept = |name: &str| self.estimates.tolerated.iter().any(|n| n.name == name);
        let tolerated = self.tolerated.iter();
        tolerated
            .filter(|free| !kept(free.quantity.name))
            .map(|free| {
                let (_, unit, factor) = display_name(free.quantity.name);
                let value = significant(free.start * factor, 4);
                format!("{} = {value} {unit}", free.quantity.name)
                    .trim_end()
                    .to_owned()
            })
            .collect()
    }

    fn prediction_words(&self) -> String {
        let mut errors = self.prediction_errors();
        let sigmas = |error: &PredictionError| error.before_sigmas.unwrap_or_default();
        errors.sort_by(|a, b| sigmas(b).total_cmp(&sigmas(a)));
        let Some(worst) = errors.first() else {
            return String::new();
        };
        let index = COLUMNS.iter().position(|c| *c == worst.channel);
        let (unit, factor) = CHANNEL_UNITS[index.unwrap_or(0)];
        let said = |value: f64| format!("{} {unit}", significant(value * factor, 2));
        let what = if worst.recording == IN_TURN {
            "the prediction error on each recording by a fit to the others".to_owned()
        } else {
            format!(
                "the prediction error on {}, which it never saw,",
                worst.recording
            )
        };
        format!(
            "; {what} {} from {} to {} RMS in the {}, where {} is {}",
            if worst.after < worst.before {
                "falls"
            } else {
                "goes"
            },
            said(worst.before),
            said(worst.after),
            CHANNEL_WORDS[index.unwrap_or(0)],
            self.reference_noise(),
            said(worst.noise.unwrap_or_default())
        )
    }

    /// Scale of departures.
    pub(super) fn reference_noise(&self) -> &'static str {
        reference_noise(self.remaining.is_some())
    }

    /// Remainder that no law explains of a part of the device.
    fn unexplained(&self) -> Option<String> {
        let remaining = self.remaining.as_ref()?;
        let (unit, factor) = CHANNEL_UNITS[remaining.channel as usize];
        let said = |value: f64| format!("{} {unit}", significant(value * factor, 2));
        let explaining: Vec<String> = (self.regimes_of_what_is_left().iter())
            .filter(|regime| regime.correlation_ratio >= EXPLAINING)
            .take(MOST_OTHERS)
            .map(|regime| {
                let name = regime.variable.trim_end_matches("_m").replace('_', " ");
                format!("{name} ({})", percent(regime.correlation_ratio))
            })
            .collect();
        let when = if explaining.is_empty() {
            "no single variable explains it".to_owned()
        } else {
            format!("explained variance by variable: {}", listed(&explaining))
        };
        Some(format!(
            "The best laws leave {} RMS in the {}, where the sensor's noise is {}, correlated over {} s; {when}. Every effect was compared with that in place of the noise.",
            said(remaining.size),
            CHANNEL_WORDS[remaining.channel as usize],
            said(remaining.noise),
            significant(remaining.time, 2),
        ))
    }

    pub(super) fn what_is_left(&self) -> Vec<String> {
        let errors = self.remaining_errors();
        let Some(largest) = errors.first() else {
            return self.unexplained().into_iter().collect();
        };
        let reference_noise = self.reference_noise();
        let beyond: Vec<String> = (errors.iter())
            .filter(|error| error.is_beyond_noise())
            .take(MOST_OTHERS)
            .map(|error| error.words(reference_noise))
            .collect();
        let kept = errors.iter().any(|error| error.kept_back);
        let besides = if kept {
            " and kept back from the fit"
        } else {
            ""
        };
        let rest = if beyond.is_empty() {
            format!(
                "No more than {reference_noise} in the recordings fitted to{besides}: the largest error beside it is {}.",
                largest.words(reference_noise)
            )
        } else {
            let count = errors.iter().filter(|e| e.is_beyond_noise()).count();
            let others = match count - beyond.len() {
                0 => String::new(),
                others => format!(", and in {others} more"),
            };
            format!(
                "More than {reference_noise} in {count} of {} channels of the recordings fitted to{besides}: {}{others}.",
                errors.len(),
                listed(&beyond)
            )
        };
        let extent = self.extent_in_words();
        (self.unexplained().into_iter().chain([rest]).chain(extent)).collect()
    }

    /// Whether the recordings are explained fully or in part, by the channel that differs most.
    fn extent_in_words(&self) -> Option<String> {
        let largest = self.largest?;
        let name = &self.evidence.recordings[largest.recording].name;
        let channel = CHANNEL_WORDS[largest.channel as usize];
        let p90 = significant(largest.p90, 2);
        let predicted = match largest.left_out {
            true => ", predicted by a fit to the others",
            false => "",
        };
        let extent = match self.extent()? {
            Extent::Fully => "fully",
            Extent::Partly => "in part",
        };
        let link = match largest.is_near_noise() {
            true => String::new(),
            false => format!("; that is in the link {}", Link::of(largest.channel).name()),
        };
        Some(format!(
            "The recordings are explained {extent}: at worst, in the {channel} of {name}{predicted}, 90 % of the samples lie within {p90} standard deviations of the prediction, where noise alone gives 1.6{link}."
        ))
    }

    /// Variants of the explanation of a part of the device, with what they leave.
    pub(super) fn what_was_ruled_out(&self) -> String {
        let Some(channel) = self.nominal.parts.output() else {
            return String::new();
        };
        let (unit, factor) = CHANNEL_UNITS[channel as usize];
        let said = |rms: f64| format!("{} {unit}", significant(rms * factor, 3));
        if self.ruled_out.is_empty() {
            return String::new();
        }
        let words = |variants: &[&RuledOut]| -> String {
            let one = |variant: &&RuledOut| {
                let names: Vec<String> = variant
                    .effects
                    .iter()
                    .map(|n| effect_display_name(n))
                    .collect();
                let names = match names.is_empty() {
                    true => "nothing".to_owned(),
                    false => listed(&names),
                };
                format!("{names}: {}", said(variant.rms))
            };
            let all: Vec<String> = variants.iter().map(one).collect();
            all.join("; with ")
        };
        let (as_well, worse): (Vec<&RuledOut>, Vec<&RuledOut>) =
            (self.ruled_out.iter()).partition(|v| self.does_as_well(v, channel));
        let mut text = format!(
            "The explanation leaves {} RMS.",
            said(self.left_of(channel))
        );
        if !as_well.is_empty() {
            let as_well = words(&as_well);
            text += &format!(" As little is left, and so not ruled out, with {as_well}.");
        }
        if !worse.is_empty() {
            let worse = words(&worse);
            text += &format!(
                " Without one of its effects, or with another law in its place, there would be left, with {worse}."
            );
        }
        text
    }

    pub(super) fn own_numbers(&self) -> String {
        let numbers: Vec<String> = self
            .estimates
            .tolerated
            .iter()
            .filter_map(|n| {
                let nominal = self.tolerated.iter().find(|f| f.quantity.name == n.name)?;
                let (words, unit, factor) = display_name(n.name);
                let table = n.name.split_once('.').map_or("", |(table, _)| table);
                let moved = if nominal.start == 0.0 {
                    String::new()
                } else {
                    format!(" ({})", change(100.0 * (n.value / nominal.start - 1.0)))
                };
                let value = significant(n.value * factor, 4);
                let limit = n.at_limit.map_or_else(String::new, |limit| {
                    format!(" at the {} end of its tolerance", end(limit))
                });
                Some(format!("{table} {words} {value} {unit}").trim().to_owned() + &moved + &limit)
            })
            .collect();
        if numbers.is_empty() {
            return String::new();
        }
        let limits = self.estimates.tolerated.iter();
        let limits = limits.filter(|n| n.at_limit.is_some()).count();
        let doubt = match limits {
            0 => "",
            1 => {
                " One stands at the end of its tolerance: either that is too narrow, or the number stands in for something that the model lacks."
            }
            _ => {
                " Some stand at the ends of their tolerances: either those are too narrow, or the numbers stand in for something that the model lacks."
            }
        };
        format!("Within their tolerances: {}.{doubt}", numbers.join("; "))
    }
}

impl RemainingError {
    /// The error in words: `0.51 N RMS in the force of ride.csv (robust, 3.4 times the sensor's noise)`.
    fn words(&self, reference_noise: &str) -> String {
        let (words, unit, factor) = of_column(&self.column);
        let kept = match self.kept_back {
            true => ", which was kept back",
            false => "",
        };
        format!(
            "{} {unit} RMS in the {words} of {}{kept} (robust, {} times {reference_noise})",
            significant(factor * self.rms, 2),
            self.recording,
            significant(self.sigmas, 2)
        )
    }
}

/// An end of a range in words.
fn end(limit: Limit) -> &'static str {
    match limit {
        Limit::Lower => "lower",
        Limit::Upper => "upper",
    }
}

pub(super) fn probability(value: f64) -> String {
    if value > 0.999 {
        "above 99.9 %".to_owned()
    } else {
        format!("{:.1} %", 100.0 * value)
    }
}

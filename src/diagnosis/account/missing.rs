//! What is missing, how much of the mismatch it explains, and what is left.

use super::super::conclude::IN_TURN;
use super::super::details::PredictionError;
use super::super::diagnose::{Diagnosis, spoken_name};
use super::super::localise::NOISE_ALONE;
use super::super::recorded::COLUMNS;
use super::super::words::{
    CHANNEL_UNITS, CHANNEL_WORDS, capital, figures, listed, percent, spoken, with_interval,
    yardstick,
};
use super::MOST_OTHERS;
use super::link::TELLING;
use crate::effects::meaning;

impl Diagnosis {
    pub(super) fn what_is_missing(&self) -> Vec<String> {
        let mut paragraphs = Vec::new();
        for (effect, numbers) in &self.estimates.effects {
            let numbers: Vec<String> = numbers
                .iter()
                .filter(|n| n.reported || self.is_of_link())
                .map(|n| {
                    let (words, unit, factor) = spoken(n.name);
                    let interval = n.interval.map(|end| end * factor);
                    format!(
                        "{words} {}",
                        with_interval(n.value * factor, interval, unit)
                    )
                })
                .collect();
            let subsystem = effect.subsystem.name().replace('_', " ");
            paragraphs.push(format!(
                "{} ({subsystem}): {}. {}. Probability {}; the intervals are those of 95 %.",
                spoken_name(effect.name),
                meaning(effect.name),
                capital(&listed(&numbers)),
                probability(self.confidence(effect.name))
            ));
        }
        paragraphs.extend(self.unlisted_words());
        let displaced = self.displaced();
        if !displaced.is_empty() {
            paragraphs.push(format!(
                "It stands in place of {} in the rig file.",
                listed(&displaced)
            ));
        }
        if let Some(share) = self.explained_share() {
            paragraphs.push(format!(
                "{} {} of the mismatch{}.",
                if self.best().effects.len() + usize::from(self.shape.is_some()) > 1 {
                    "Together they explain"
                } else {
                    "It explains"
                },
                percent(share),
                self.prediction_words()
            ));
        }
        paragraphs
    }

    /// Tolerated numbers of the rig file that an effect has taken the place of.
    fn displaced(&self) -> Vec<String> {
        let kept = |name: &str| self.estimates.tolerated.iter().any(|n| n.name == name);
        let tolerated = self.tolerated.iter();
        tolerated
            .filter(|free| !kept(free.quantity.name))
            .map(|free| {
                let (_, unit, factor) = spoken(free.quantity.name);
                let value = figures(free.start * factor, 4);
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
        let said = |value: f64| format!("{} {unit}", figures(value * factor, 2));
        let what = if worst.recording == IN_TURN {
            "the prediction error on each recording by a fit to the others".to_owned()
        } else {
            format!(
                "the prediction error on {}, which it never saw,",
                worst.recording
            )
        };
        format!(
            "; {what} {} from {} to {} in the {}, where {} is {}",
            if worst.after < worst.before {
                "falls"
            } else {
                "goes"
            },
            said(worst.before),
            said(worst.after),
            CHANNEL_WORDS[index.unwrap_or(0)],
            self.yardstick(),
            said(worst.noise.unwrap_or_default())
        )
    }

    /// What departures are compared with.
    pub(super) fn yardstick(&self) -> &'static str {
        yardstick(self.remaining.is_some())
    }

    /// What no law explains of a part of the device.
    fn unexplained(&self) -> Option<String> {
        let remaining = self.remaining.as_ref()?;
        let (unit, factor) = CHANNEL_UNITS[remaining.channel as usize];
        let said = |value: f64| format!("{} {unit}", figures(value * factor, 2));
        let telling: Vec<String> = (self.regimes_of_what_is_left().iter())
            .filter(|regime| regime.share >= TELLING)
            .take(MOST_OTHERS)
            .map(|regime| {
                let name = regime.variable.trim_end_matches("_m").replace('_', " ");
                format!("{name} ({})", percent(regime.share))
            })
            .collect();
        let when = if telling.is_empty() {
            "no single variable says when".to_owned()
        } else {
            format!(
                "what says when, by its share of the variance: {}",
                listed(&telling)
            )
        };
        Some(format!(
            "The best laws leave {} RMS in the {}, where the sensor's noise is {}, alike for {} s; {when}. No known effect explains that, and every effect was judged against it.",
            said(remaining.size),
            CHANNEL_WORDS[remaining.channel as usize],
            said(remaining.noise),
            figures(remaining.time, 2),
        ))
    }

    pub(super) fn what_is_left(&self) -> Vec<String> {
        if let Some(unexplained) = self.unexplained() {
            return vec![unexplained];
        }
        let left: Vec<String> = self
            .by_misfit(&self.best().fit.prediction.residuals)
            .iter()
            .filter(|m| m.sigmas > NOISE_ALONE)
            .take(MOST_OTHERS)
            .map(|m| {
                format!(
                    "the {} of {} departs by {} times its noise",
                    CHANNEL_WORDS[m.channel as usize],
                    self.name(m.recording),
                    figures(m.sigmas, 3)
                )
            })
            .collect();
        if left.is_empty() {
            return if self.best().finds_nothing() {
                Vec::new()
            } else {
                vec!["Noise.".to_owned()]
            };
        }
        vec![format!(
            "More than noise: {}. No known effect explains that.",
            listed(&left)
        )]
    }

    /// Variants of the explanation of a part of the device, with what they leave.
    pub(super) fn what_was_ruled_out(&self) -> String {
        let Some(channel) = self.believed.chain.output() else {
            return String::new();
        };
        let (unit, factor) = CHANNEL_UNITS[channel as usize];
        let said = |rms: f64| format!("{} {unit}", figures(rms * factor, 3));
        let variants: Vec<String> = (self.ruled_out.iter())
            .map(|variant| {
                let names: Vec<String> = variant.effects.iter().map(|n| spoken_name(n)).collect();
                let names = if names.is_empty() {
                    "nothing".to_owned()
                } else {
                    listed(&names)
                };
                format!("{names}: {}", said(variant.rms))
            })
            .collect();
        if variants.is_empty() {
            return String::new();
        }
        format!(
            "The explanation leaves {} RMS. Without one of its effects, or with another law in its place, there would be left, with {}.",
            said(self.left_of(channel)),
            variants.join("; with ")
        )
    }

    pub(super) fn own_numbers(&self) -> String {
        let numbers: Vec<String> = self
            .estimates
            .tolerated
            .iter()
            .filter_map(|n| {
                let believed = self.tolerated.iter().find(|f| f.quantity.name == n.name)?;
                let (words, unit, factor) = spoken(n.name);
                let table = n.name.split_once('.').map_or("", |(table, _)| table);
                let change = if believed.start == 0.0 {
                    String::new()
                } else {
                    format!(" ({:+.1} %)", 100.0 * (n.value / believed.start - 1.0))
                };
                let value = figures(n.value * factor, 4);
                Some(format!("{table} {words} {value} {unit}").trim().to_owned() + &change)
            })
            .collect();
        if numbers.is_empty() {
            return String::new();
        }
        format!("Within their tolerances: {}.", numbers.join("; "))
    }
}

pub(super) fn probability(value: f64) -> String {
    if value > 0.999 {
        "above 99.9 %".to_owned()
    } else {
        format!("{:.1} %", 100.0 * value)
    }
}

//! The account: what an engineer can act on.

use super::conclude::IN_TURN;
use super::diagnose::{Diagnosis, Ranked, names_of, spoken_name};
use super::links::{Link, LinkResidual};
use super::localise::{Misfit, NOISE_ALONE, misfits};
use super::regime::Regime;
use super::words::{
    CHANNEL_UNITS, CHANNEL_WORDS, figures, listed, percent, spoken, with_interval, wrapped,
};
use crate::effects::meaning;
use crate::plant::Channel;

/// Other channels that part from the model, named at most.
const MOST_OTHERS: usize = 3;
/// Share of a mismatch's variance from which a variable is worth a word [1].
const TELLING: f64 = 0.1;
/// Chi-square by which an experiment must tell two explanations apart to be named: a chance of one in a million [1].
const TELLS: f64 = 28.0;

impl Diagnosis {
    /// The account of a case by its name.
    #[must_use]
    pub fn account(&self, case: &str) -> String {
        let mut text = format!("{case}: {}\n", self.headline());
        let mut part = |title: &str, paragraphs: Vec<String>| {
            let paragraphs: Vec<String> =
                paragraphs.into_iter().filter(|p| !p.is_empty()).collect();
            if paragraphs.is_empty() {
                return;
            }
            text.push_str(&format!("\n{title}\n"));
            for paragraph in paragraphs {
                text.push_str(&wrapped("  ", &paragraph));
            }
        };
        part("Where it parts", self.where_it_parts());
        part("Which link", self.which_link());
        part("What is missing", self.what_is_missing());
        part("What is left", self.what_is_left());
        part(
            "What the recordings do not tell apart",
            self.not_told_apart(),
        );
        part("What to record next", vec![self.what_next()]);
        part("The rig file's own numbers", vec![self.own_numbers()]);
        part(
            "The recordings",
            self.notes.iter().map(|n| format!("{n}.")).collect(),
        );
        text
    }

    fn headline(&self) -> String {
        let names = names_of(self.best());
        if names.is_empty() {
            "nothing is missing".to_owned()
        } else {
            format!("missing: {}", listed(&names))
        }
    }

    fn name(&self, recording: usize) -> &str {
        &self.evidence.recordings[recording].name
    }

    /// Channels in the order of their misfit, the largest first.
    fn by_misfit(&self, residuals: &[f64]) -> Vec<Misfit> {
        let mut all = misfits(&self.evidence, residuals);
        all.sort_by(|a, b| b.sigmas.total_cmp(&a.sigmas));
        all
    }

    /// A size in standard deviations of a channel, in its unit.
    fn in_unit(&self, channel: Channel, sigmas: f64) -> String {
        let (unit, factor) = CHANNEL_UNITS[channel as usize];
        let size = sigmas * self.evidence.noise[channel as usize] * factor;
        format!("{} {unit}", figures(size, 2))
    }

    fn where_it_parts(&self) -> Vec<String> {
        if self.best().effects.is_empty() {
            let count = self.evidence.recordings.len();
            let recordings = if count == 1 {
                "the recording".to_owned()
            } else {
                format!("all {count} recordings")
            };
            let worst = self.by_misfit(&self.best().fit.prediction.residuals);
            let to = worst.first().map_or_else(String::new, |worst| {
                format!(
                    ": the worst channel, the {} of {}, departs by {} times its noise",
                    CHANNEL_WORDS[worst.channel as usize],
                    self.name(worst.recording),
                    figures(worst.sigmas, 3)
                )
            });
            return vec![format!(
                "Nowhere. The believed model, moved within its tolerances, explains {recordings}{to}."
            )];
        }
        let all = self.by_misfit(&self.baseline.prediction.residuals);
        let parting: Vec<&Misfit> = all.iter().filter(|m| self.span(m).is_some()).collect();
        let Some((worst, others)) = parting.split_first() else {
            return vec![
                "No short time stands out: the mismatch is spread over the recordings.".to_owned(),
            ];
        };
        let mut paragraphs = vec![self.worst_parting(worst)];
        let others: Vec<String> = others
            .iter()
            .filter(|m| m.sigmas > NOISE_ALONE)
            .take(MOST_OTHERS)
            .filter_map(|m| {
                let [from, to] = self.span(m)?;
                Some(format!(
                    "the {} of {} from {from:.2} to {to:.2} s ({} RMS)",
                    CHANNEL_WORDS[m.channel as usize],
                    self.name(m.recording),
                    self.in_unit(m.channel, m.sigmas)
                ))
            })
            .collect();
        if !others.is_empty() {
            paragraphs.push(format!("So do {}.", listed(&others)));
        }
        paragraphs
    }

    /// From the first to the last time in which a channel parts from the baseline [s].
    fn span(&self, misfit: &Misfit) -> Option<[f64; 2]> {
        let spans = self.spans(misfit);
        Some([spans.first()?[0], spans.last()?[1]])
    }

    fn spans(&self, misfit: &Misfit) -> Vec<[f64; 2]> {
        let partings = self.baseline.partings.iter();
        let own =
            partings.filter(|p| p.recording == misfit.recording && p.channel == misfit.channel);
        own.map(|p| p.span).collect()
    }

    fn worst_parting(&self, worst: &Misfit) -> String {
        let spans = self.spans(worst);
        let [from, to] = self.span(worst).unwrap_or_default();
        let long: f64 = spans.iter().map(|span| span[1] - span[0]).sum();
        let times = match spans.len() {
            1 => String::new(),
            count => format!(", in {count} stretches that make {long:.1} s"),
        };
        format!(
            "Between {from:.2} and {to:.2} s of {} the {} parts from the believed model, whatever its tolerances allow{times}: by {} RMS, where the sensor's noise is {}.",
            self.name(worst.recording),
            CHANNEL_WORDS[worst.channel as usize],
            self.in_unit(worst.channel, worst.sigmas),
            self.in_unit(worst.channel, 1.0),
        )
    }

    fn which_link(&self) -> Vec<String> {
        if self.best().effects.is_empty() {
            return Vec::new();
        }
        let links = self.baseline.links.iter();
        links
            .map(|(link, regimes)| link_words(link, regimes))
            .collect()
    }

    fn what_is_missing(&self) -> Vec<String> {
        let mut paragraphs = Vec::new();
        for (effect, numbers) in &self.estimates.effects {
            let numbers: Vec<String> = numbers
                .iter()
                .filter(|n| n.reported)
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
                if self.best().effects.len() > 1 {
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
        errors.sort_by(|a, b| b.before_sigmas.total_cmp(&a.before_sigmas));
        let Some(worst) = errors.first() else {
            return String::new();
        };
        let index = super::recorded::COLUMNS
            .iter()
            .position(|c| *c == worst.channel);
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
            "; {what} falls from {} to {} in the {}, where the sensor's noise is {}",
            said(worst.before),
            said(worst.after),
            CHANNEL_WORDS[index.unwrap_or(0)],
            said(worst.noise)
        )
    }

    fn what_is_left(&self) -> Vec<String> {
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
            return if self.best().effects.is_empty() {
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

    fn not_told_apart(&self) -> Vec<String> {
        self.rivals()
            .map(|rival| {
                format!(
                    "{}, at odds of 1 to {}.",
                    self.instead(rival),
                    figures(1.0 / rival.odds, 2)
                )
            })
            .collect()
    }

    /// An explanation beside the best one.
    fn instead(&self, rival: &Ranked) -> String {
        let name = |e: &&'static crate::effects::Effect| e.name.to_owned();
        let names: Vec<String> = rival.hypothesis.effects.iter().map(name).collect();
        let best: Vec<String> = self.best().effects.iter().map(name).collect();
        if names.is_empty() {
            return "Nothing at all may be missing".to_owned();
        }
        let more: Vec<String> = names
            .iter()
            .filter(|n| !best.contains(n))
            .cloned()
            .collect();
        if best.iter().all(|n| names.contains(n)) {
            format!("Beside what was found, {} may be at work", listed(&more))
        } else {
            format!("It may be {} instead", listed(&names))
        }
    }

    fn what_next(&self) -> String {
        let Some(best) = self.experiments.first() else {
            return String::new();
        };
        let Some(rival) = self.ranked.get(1) else {
            return String::new();
        };
        let near = self.rivals().next().is_some();
        if best.square < TELLS {
            return if near {
                format!(
                    "None of the {} experiments tried would tell these apart.",
                    self.experiments.len()
                )
            } else {
                String::new()
            };
        }
        let from = self.instead(rival);
        let opening = if near {
            "To settle it".to_owned()
        } else {
            format!(
                "The nearest rival ({}) is ruled out. To be surer still",
                lower(&from)
            )
        };
        let sigmas = best.square.sqrt();
        format!(
            "{opening}: {}. After a new fit the two would stand {} standard deviations apart.",
            best.experiment.instruction,
            figures(sigmas, 2)
        )
    }

    fn own_numbers(&self) -> String {
        let numbers: Vec<String> = self
            .estimates
            .tolerated
            .iter()
            .filter_map(|n| {
                let believed = self.tolerated.iter().find(|f| f.quantity.name == n.name)?;
                let (words, unit, factor) = spoken(n.name);
                let table = n.name.split('.').next().unwrap_or_default();
                let change = 100.0 * (n.value / believed.start - 1.0);
                let value = figures(n.value * factor, 4);
                Some(
                    format!("{table} {words} {value} {unit}")
                        .trim_end()
                        .to_owned()
                        + &format!(" ({change:+.1} %)"),
                )
            })
            .collect();
        if numbers.is_empty() {
            return String::new();
        }
        format!("Within their tolerances: {}.", numbers.join("; "))
    }
}

fn link_words(link: &LinkResidual, regimes: &[Regime]) -> String {
    let size = figures(link.size, 3);
    let explained = link.size <= NOISE_ALONE;
    if explained {
        return match link.link {
            Link::Regulator => format!(
                "The regulator explains its own recording: {size} times its sensor's noise."
            ),
            Link::Piston => format!(
                "Chambers and piston explain the measured motion: no force is lacking beyond {size} times the noise."
            ),
            Link::Contact => format!(
                "The contact explains the force at the measured stroke: {size} times the noise."
            ),
        };
    }
    let telling: Vec<String> = regimes
        .iter()
        .filter(|r| r.share >= TELLING)
        .take(3)
        .map(|r| {
            format!(
                "{} ({:.0} %)",
                r.variable.trim_end_matches("_m").replace('_', " "),
                100.0 * r.share
            )
        })
        .collect();
    let when = if telling.is_empty() {
        "; no single variable says when".to_owned()
    } else {
        format!(
            "; what says when, by its share of the variance: {}",
            listed(&telling)
        )
    };
    let (unit, factor) = match link.link {
        Link::Regulator => ("mbar", 1e-2),
        Link::Piston | Link::Contact => ("N", 1.0),
    };
    let amount = format!("{} {unit}", figures(link.size * link.unit * factor, 2));
    match link.link {
        Link::Regulator => format!(
            "The regulator does not explain its own recording: {amount} RMS, {size} times its sensor's noise{when}."
        ),
        Link::Piston => format!(
            "Along its measured motion the piston lacks a force of {amount} RMS, {size} times the noise{when}."
        ),
        Link::Contact => format!(
            "The contact does not explain the force at the measured stroke: {size} times the noise{when}."
        ),
    }
}

fn probability(value: f64) -> String {
    if value > 0.999 {
        "above 99.9 %".to_owned()
    } else {
        format!("{:.1} %", 100.0 * value)
    }
}

fn capital(text: &str) -> String {
    changed(text, |c| c.to_uppercase().collect())
}

fn lower(text: &str) -> String {
    changed(text, |c| c.to_lowercase().collect())
}

fn changed(text: &str, change: fn(char) -> String) -> String {
    let mut letters = text.chars();
    letters
        .next()
        .map_or_else(String::new, |first| change(first) + letters.as_str())
}

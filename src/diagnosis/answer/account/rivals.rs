//! Explanations that the recordings do not tell apart, and the next recording to make.

use super::super::details::Considered;
use super::super::finding::Diagnosis;
use super::super::words::{listed, odds};
use crate::diagnosis::formula::unlisted::words::{port, variable};
use crate::diagnosis::search::ranking::Ranked;
use crate::diagnosis::settings::Settings;
use crate::quantity::significant;

/// Chi-square by which an experiment must tell two explanations apart to be named: a chance of one in a million [1].
const TELLS: f64 = 28.0;

impl Considered {
    /// Whether it is ruled out: fitted in full, and at odds below 1 to 100.
    #[must_use]
    pub fn is_ruled_out(&self) -> bool {
        self.in_full && self.log10_odds < Settings::DEFAULT.least_odds.log10()
    }

    /// Whether it may be as good as the explanation given, by what was fitted.
    #[must_use]
    pub fn is_close(&self) -> bool {
        self.log10_odds >= Settings::DEFAULT.least_odds.log10()
    }
}

impl Diagnosis {
    pub(super) fn not_distinguished(&self) -> Vec<String> {
        let fitted = self.rivals().map(|rival| {
            format!(
                "{}, at odds of {}.",
                self.instead(rival),
                odds(rival.odds.log10())
            )
        });
        let considered = self.considered();
        let roughly: Vec<String> = (considered.iter())
            .filter(|c| c.is_close() && !c.in_full)
            .map(|c| format!("{} ({})", names(&c.effects), odds(c.log10_odds)))
            .collect();
        let roughly = (!roughly.is_empty()).then(|| {
            format!(
                "Fitted roughly alone, and not ruled out by that: {}.",
                listed(&roughly)
            )
        });
        fitted.chain(roughly).collect()
    }

    /// An explanation beside the best one.
    fn instead(&self, rival: &Ranked) -> String {
        let names = rival.hypothesis.effect_display_names();
        let best = self.best().effect_display_names();
        let beyond = |all: &[String], known: &[String]| -> Vec<String> {
            all.iter().filter(|n| !known.contains(n)).cloned().collect()
        };
        let (more, fewer) = (beyond(&names, &best), beyond(&best, &names));
        match (more.is_empty(), fewer.is_empty()) {
            _ if names.is_empty() => "Nothing at all may be missing".to_owned(),
            (false, true) => format!("Beside what was found, {} may be at work", listed(&more)),
            (true, false) => format!("{} may do without {}", listed(&names), listed(&fewer)),
            (false, false) => format!("It may be {} instead", listed(&names)),
            // The same effects: what differs is where the model discrepancy enters.
            (true, true) => rival.hypothesis.unlisted().map_or_else(
                || format!("{} may have other numbers", listed(&names)),
                |latent| {
                    format!(
                        "The model discrepancy may be in the {}, depending on the {}, instead",
                        port(latent.port).words,
                        variable(latent.variable).words
                    )
                },
            ),
        }
    }

    pub(super) fn what_next(&self) -> String {
        let considered = self.considered();
        let near = self.rivals().next().is_some() || considered.iter().any(Considered::is_close);
        if !near && self.shape.is_some() {
            return self.what_to_check();
        }
        let separating = (self.experiments.first()).filter(|best| best.square >= TELLS);
        let settles = separating.map(|best| {
            format!(
                "{}. After a new fit the two would stand {} standard deviations apart.",
                best.experiment.instruction,
                significant(best.square.sqrt(), 2)
            )
        });
        match (near, settles) {
            (true, Some(settles)) => format!("To settle it: {settles}"),
            (true, None) if self.experiments.is_empty() => String::new(),
            (true, None) => format!(
                "None of the {} experiments tried would distinguish these.",
                self.experiments.len()
            ),
            (false, settles) => {
                let surer = settles.map_or(String::new(), |s| format!(" To be surer still: {s}"));
                format!(
                    "No further recording is needed to distinguish the explanations: {}{surer}",
                    nearest(&considered, self.looked_at)
                )
            }
        }
    }
}

/// Distance of the nearest of the other explanations.
fn nearest(considered: &[Considered], looked_at: usize) -> String {
    let by_odds = |a: &&Considered, b: &&Considered| a.log10_odds.total_cmp(&b.log10_odds);
    let Some(nearest) = considered.iter().max_by(by_odds) else {
        return format!(
            "none of the {looked_at} effects that were looked at gains what its numbers cost."
        );
    };
    let how = match nearest.in_full {
        true => "fitted in full",
        false => "fitted roughly",
    };
    let of = match considered.len() {
        1 => "the one other explanation that was tried".to_owned(),
        count => format!("the nearest of {count} other explanations that were tried"),
    };
    format!(
        "{of}, {}, stands at odds of {} ({how}).",
        names(&nearest.effects),
        odds(nearest.log10_odds)
    )
}

/// Names of an explanation's effects.
fn names(effects: &[String]) -> String {
    match effects.is_empty() {
        true => "nothing missing".to_owned(),
        false => listed(effects),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn considered(name: &str, in_full: bool, log10_odds: f64) -> Considered {
        Considered {
            effects: vec![name.to_owned()],
            in_full,
            log10_odds,
            explained_share: None,
        }
    }

    #[test]
    fn the_nearest_rival_is_named_with_its_odds() {
        // "No other explanation that was tried comes near" was once said above one at odds of 1 to 6.9.
        let tried = [
            considered("hose_volume", true, -4.0),
            considered("runout", false, -2.5),
        ];
        assert_eq!(
            nearest(&tried, 34),
            "the nearest of 2 other explanations that were tried, runout, stands at odds of 1 to 320 (fitted roughly)."
        );
        assert_eq!(
            nearest(&[], 34),
            "none of the 34 effects that were looked at gains what its numbers cost."
        );
    }

    #[test]
    fn ruled_out_is_what_was_fitted_in_full_and_is_far() {
        let verdict = |in_full, odds: f64| {
            let rival = considered("runout", in_full, odds.log10());
            (rival.is_close(), rival.is_ruled_out())
        };
        assert_eq!(verdict(true, 1.0 / 6.9), (true, false));
        assert_eq!(verdict(false, 1.0 / 6.9), (true, false));
        assert_eq!(verdict(true, 1e-3), (false, true));
        assert_eq!(verdict(false, 1e-3), (false, false));
    }
}

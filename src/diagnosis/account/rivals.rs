//! What the recordings do not tell apart, and what to record next.

use super::super::diagnose::{Diagnosis, Ranked, names_of};
use super::super::words::{figures, listed, lower};

/// Chi-square by which an experiment must tell two explanations apart to be named: a chance of one in a million [1].
const TELLS: f64 = 28.0;

impl Diagnosis {
    pub(super) fn not_told_apart(&self) -> Vec<String> {
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
        let names = names_of(&rival.hypothesis);
        let best = names_of(self.best());
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

    pub(super) fn what_next(&self) -> String {
        let near = self.rivals().next().is_some();
        if !near && self.shape.is_some() {
            return self.what_to_check();
        }
        let (Some(best), Some(rival)) = (self.experiments.first(), self.ranked.get(1)) else {
            return if near {
                String::new()
            } else {
                "Nothing need be: no other explanation that was tried comes near.".to_owned()
            };
        };
        if best.square < TELLS {
            return if near {
                format!(
                    "None of the {} experiments tried would tell these apart.",
                    self.experiments.len()
                )
            } else {
                "Nothing need be: the nearest rival is ruled out.".to_owned()
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
}

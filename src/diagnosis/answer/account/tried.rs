//! Words on a law that a user tried: how it fares beside the answer.

use std::collections::BTreeMap;

use super::super::details::{Departure, TriedReport};
use super::super::estimate::{Estimate, Number};
use super::super::finding::Diagnosis;
use super::super::words::{listed, odds, percent, with_interval_in_si};
use crate::diagnosis::difference::extent::Largest;
use crate::plant::LawText;
use crate::quantity::significant;

impl Diagnosis {
    /// The law that was tried, as it was written.
    fn tried_law(&self) -> Option<&LawText> {
        let tried = self.tried.as_ref()?;
        let plant = &self.ranked[tried.place].hypothesis.fit.prediction.plant;
        plant.own.last().map(|own| &*own.text)
    }

    /// What became of a law that was tried, for a program.
    pub(in crate::diagnosis) fn tried_report(&self) -> Option<TriedReport> {
        let (tried, law) = (self.tried.as_ref()?, self.tried_law()?);
        let ranked = &self.ranked[tried.place];
        let number = |n: &Number| (n.name.to_owned(), Estimate::from(n));
        Some(TriedReport {
            formula: format!("{} = {}", law.port.name(), law.expression.text()),
            parameters: tried.numbers.iter().map(number).collect::<BTreeMap<_, _>>(),
            effects: ranked.hypothesis.effect_display_names(),
            is_answer: tried.place == 0,
            log10_odds: -0.5 * (ranked.score - self.ranked[0].score) / std::f64::consts::LN_10,
            explained_share: self.share_explained_by(&ranked.hypothesis),
            departure: tried.largest.map(|largest| self.departure(largest)),
        })
    }

    /// The same in words.
    pub(in crate::diagnosis) fn how_the_law_fares(&self) -> Vec<String> {
        let (Some(tried), Some(law), Some(report)) =
            (&self.tried, self.tried_law(), self.tried_report())
        else {
            return Vec::new();
        };
        let number = |n: &Number| {
            let unit = law.constants.iter().find(|c| c.name == n.name);
            let unit = unit.and_then(|c| c.unit).unwrap_or_default();
            let value = with_interval_in_si(n.value, n.interval, unit);
            let at_limit = if n.at_limit.is_some() {
                ", at the end of its range"
            } else {
                ""
            };
            format!("{} = {value}{at_limit}", n.name)
        };
        let numbers: Vec<String> = tried.numbers.iter().map(number).collect();
        let others: Vec<String> = (self.ranked[tried.place].hypothesis.effects.iter())
            .filter(|effect| effect.name != law.name)
            .map(|effect| effect.name.to_owned())
            .collect();
        let beside = match (tried.place, others.is_empty()) {
            (0, true) => "is the answer".to_owned(),
            (0, false) => format!("is a part of the answer, beside {}", listed(&others)),
            (_, true) => "was fitted alone".to_owned(),
            (_, false) => format!("was fitted beside {}", listed(&others)),
        };
        let against = match tried.place {
            0 => String::new(),
            _ => format!(
                " Odds against the answer given: {}.",
                odds(report.log10_odds)
            ),
        };
        let share = report
            .explained_share
            .map(|share| format!("It explains {} of the mismatch.", percent(share)));
        let departure = report.departure.map(|d| {
            let predicted = if d.left_out {
                ", predicted by a fit to the others"
            } else {
                ""
            };
            format!(
                "What it leaves is largest in {} of {}{predicted}: 90th percentile {} standard deviations, where noise alone has 1.6.",
                d.channel,
                d.recording,
                significant(d.p90_sigmas, 2)
            )
        });
        let first = format!(
            "{} {beside}: {}; the intervals are those of 95 %.{against}",
            report.formula,
            listed(&numbers)
        );
        let rest: Vec<String> = share.into_iter().chain(departure).collect();
        [first, rest.join(" ")]
            .into_iter()
            .filter(|text| !text.is_empty())
            .collect()
    }

    /// A departure as it is reported.
    pub(in crate::diagnosis) fn departure(&self, largest: Largest) -> Departure {
        Departure {
            recording: self.evidence.recordings[largest.recording].name.clone(),
            channel: crate::diagnosis::recordings::recorded::COLUMNS[largest.channel as usize]
                .to_owned(),
            left_out: largest.left_out,
            p90_sigmas: largest.p90,
            link: crate::diagnosis::difference::links::Link::of(largest.channel)
                .name()
                .to_owned(),
        }
    }
}

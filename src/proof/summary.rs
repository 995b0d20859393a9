//! Results of all cases of a proof, and the claims about them.

use serde::Serialize;

use super::reliability::Reliability;
use super::score::CaseScore;
use crate::document::{Block, Cell, Column, Document, Section, Table};
use crate::stats::{median, quantile};

/// Claims that a proof must reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Claims {
    /// Share of listed effects, or pairs of them, that are named exactly.
    pub named: f64,
    /// Share of predictions within `prediction_within`.
    pub predicted: f64,
    /// Percentile of a prediction's error [standard deviations].
    pub prediction_within: f64,
    /// Median of the parameters' errors.
    pub error_median: f64,
    /// Their 90th percentile.
    pub error_most: f64,
    /// Share of intervals that hold the truth.
    pub coverage: f64,
    /// Median overlap of claimed and true intervals.
    pub overlap: f64,
}

impl Claims {
    /// Those of the project's page. Nothing found where nothing is missing, and unlisted effects found and placed, is claimed of all cases.
    pub const PAGE: Self = Self {
        named: 38.0 / 41.0,
        predicted: 42.0 / 46.0,
        prediction_within: 2.0,
        error_median: 0.02,
        error_most: 0.10,
        coverage: 0.90,
        overlap: 0.85,
    };
}

/// A proof's score.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProofSummary {
    /// Case by case.
    pub cases: Vec<CaseScore>,
    /// Listed effects named exactly, of how many.
    pub named: [usize; 2],
    /// Cases with nothing concealed that were answered so, of how many.
    pub clean: [usize; 2],
    /// Unlisted effects answered so, placed, of how many.
    pub unlisted: [usize; 2],
    /// Verdicts that are right, of how many.
    pub verdicts: [usize; 2],
    /// Median and 90th percentile of the parameters' errors where the effects were named exactly.
    pub errors: Option<[f64; 2]>,
    /// Intervals that hold the truth, of how many, there.
    pub covered: [usize; 2],
    /// Median half-width of the intervals, relative to the truth.
    pub half_width: Option<f64>,
    /// Median overlap where something is at work.
    pub overlap: Option<f64>,
    /// Predictions within the bound, of how many.
    pub predicted: [usize; 2],
    /// Reliability of the stated probabilities; none where nothing was named.
    pub reliability: Option<Reliability>,
    /// Median time of a diagnosis [s].
    pub seconds: Option<f64>,
}

impl ProofSummary {
    /// Of all cases.
    pub fn new(cases: Vec<CaseScore>) -> Self {
        let count = |of: &dyn Fn(&&CaseScore) -> bool, hit: &dyn Fn(&&CaseScore) -> bool| {
            let among = cases.iter().filter(of);
            [among.clone().filter(hit).count(), among.count()]
        };
        let listed = |c: &&CaseScore| !c.truth.is_empty() && !c.unlisted;
        let empty = |c: &&CaseScore| c.truth.is_empty();
        let any = |_: &&CaseScore| true;
        let exact: Vec<&CaseScore> = cases
            .iter()
            .filter(listed)
            .filter(|c| c.named_exactly)
            .collect();
        let errors: Vec<f64> = exact.iter().flat_map(|c| c.errors.clone()).collect();
        let widths: Vec<f64> = exact.iter().flat_map(|c| c.half_widths.clone()).collect();
        let within = |c: &&CaseScore| {
            c.prediction
                .is_some_and(|p| p <= Claims::PAGE.prediction_within)
        };
        let at_work = cases.iter().filter(|c| !c.truth.is_empty());
        Self {
            named: count(&listed, &|c| c.named_exactly),
            clean: count(&empty, &|c| c.named_exactly),
            unlisted: count(&|c| c.unlisted, &|c| c.named_exactly && c.placed),
            verdicts: count(&any, &|c| c.verdict_right),
            errors: quantile(errors.iter().copied(), 0.5)
                .zip(quantile(errors.iter().copied(), 0.9))
                .map(|(a, b)| [a, b]),
            covered: [exact.iter().map(|c| c.covered).sum(), errors.len()],
            half_width: quantile(widths.iter().copied(), 0.5),
            overlap: median(at_work.map(|c| c.overlap)),
            predicted: count(&any, &within),
            reliability: Reliability::of(cases.iter().flat_map(|case| &case.stated)),
            seconds: median(cases.iter().filter_map(|c| c.seconds)),
            cases,
        }
    }

    /// Results that fall short of the claims, a sentence each.
    pub fn shortfalls(&self, claims: &Claims) -> Vec<String> {
        let mut short = Vec::new();
        let mut share = |what: &str, [hits, of]: [usize; 2], least: f64| {
            if (hits as f64) < least * of as f64 - 1e-9 {
                let least = 100.0 * least;
                short.push(format!(
                    "{what}: {hits} of {of}, claimed at least {least:.0} %"
                ));
            }
        };
        share("listed effects named exactly", self.named, claims.named);
        share("nothing found where nothing is missing", self.clean, 1.0);
        share("unlisted effects found and placed", self.unlisted, 1.0);
        share(
            "intervals that hold the truth",
            self.covered,
            claims.coverage,
        );
        share(
            "unseen recordings predicted",
            self.predicted,
            claims.predicted,
        );
        let mut number =
            |what: &str, value: Option<f64>, bound: f64, wrong: fn(&f64, &f64) -> bool| {
                if let Some(value) = value.filter(|value| wrong(value, &bound)) {
                    short.push(format!("{what}: {value:.3}, claimed {bound}"));
                }
            };
        number(
            "median parameter error",
            self.errors.map(|e| e[0]),
            claims.error_median,
            f64::gt,
        );
        number(
            "90th percentile of parameter errors",
            self.errors.map(|e| e[1]),
            claims.error_most,
            f64::gt,
        );
        number(
            "median overlap of the intervals",
            self.overlap,
            claims.overlap,
            f64::lt,
        );
        short
    }

    /// For people.
    pub fn document(&self) -> Document<'static> {
        let of = |[hits, of]: [usize; 2]| format!("{hits} of {of}");
        let number = |value: Option<f64>, digits: usize| {
            value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
        };
        let percent = |value: Option<f64>| number(value.map(|v| 100.0 * v), 2);
        let [median, most] = [0, 1].map(|i| self.errors.map(|errors| errors[i]));
        let rows = [
            ("listed effects named exactly", of(self.named)),
            ("nothing found where nothing is missing", of(self.clean)),
            ("unlisted effects found and placed", of(self.unlisted)),
            ("verdicts right", of(self.verdicts)),
            (
                "parameter error, median / 90th percentile",
                format!("{} % / {} %", percent(median), percent(most)),
            ),
            ("95 % intervals that hold the truth", of(self.covered)),
            (
                "their median half-width",
                format!("{} %", percent(self.half_width)),
            ),
            (
                "median overlap of claimed and true intervals",
                number(self.overlap, 2),
            ),
            (
                "predictions within 2.0 standard deviations",
                of(self.predicted),
            ),
            (
                "right of the names stated above 0.9",
                of(self.reliability.as_ref().map_or([0, 0], |r| r.sure)),
            ),
            (
                "Brier score of the stated probabilities",
                number(self.reliability.as_ref().map(|r| r.brier), 3),
            ),
            ("median time [s]", number(self.seconds, 1)),
        ];
        let rows = rows.map(|(what, value)| vec![Cell::from(what), Cell::from(value)]);
        let columns = Column::list("of all cases | #");
        let all = Table::new("", columns, rows.to_vec());
        let columns = Column::list("case | | at work | answered | #overlap | #prediction");
        let cases = Table::new("", columns, self.cases.iter().map(row).collect());
        Document {
            sections: [cases, all]
                .map(|table| Section::new("", vec![Block::Table(table)]))
                .into(),
            ..Document::default()
        }
    }
}

fn row(case: &CaseScore) -> Vec<Cell> {
    let list = |names: &[String]| match names.is_empty() {
        true => "nothing".to_owned(),
        false => names.join(" + "),
    };
    let mark = if case.named_exactly { "named" } else { "MISS" };
    let answered = match (&case.answered, &case.failure) {
        (Some(names), _) => list(names),
        (None, failure) => format!("no answer ({})", failure.clone().unwrap_or_default()),
    };
    let prediction = case
        .prediction
        .map_or("-".to_owned(), |p| format!("{p:.2}"));
    vec![
        case.case.as_str().into(),
        Cell::Verdict(mark.to_owned(), case.named_exactly),
        list(&case.truth).into(),
        answered.into(),
        format!("{:.2}", case.overlap).into(),
        prediction.into(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laboratory::SealedCase;

    fn case(truth: &[&str], exact: bool, errors: &[f64]) -> CaseScore {
        let sealed = SealedCase {
            case: "case".to_owned(),
            effects: Vec::new(),
            noise: std::collections::BTreeMap::default(),
            also_there: Vec::new(),
            mismatch: Vec::new(),
            true_parameters: std::collections::BTreeMap::default(),
            shows: 0.0,
            seed: 0,
        };
        CaseScore {
            truth: truth.iter().map(|s| (*s).to_owned()).collect(),
            named_exactly: exact,
            verdict_right: exact,
            placed: true,
            errors: errors.to_vec(),
            covered: errors.len(),
            overlap: 0.9,
            prediction: Some(1.7),
            ..CaseScore::failed(&sealed, String::new())
        }
    }

    #[test]
    fn what_is_claimed_is_asked_for() {
        let good = vec![case(&[], true, &[]), case(&["a"], true, &[0.01, 0.02])];
        let summary = ProofSummary::new(good.clone());
        assert_eq!(
            (summary.named, summary.clean, summary.unlisted),
            ([1, 1], [1, 1], [0, 0])
        );
        assert!(
            summary.shortfalls(&Claims::PAGE).is_empty(),
            "{:?}",
            summary.shortfalls(&Claims::PAGE)
        );

        let mut bad = good;
        bad[0].named_exactly = false;
        bad[1].errors = vec![0.2, 0.3];
        bad[1].covered = 0;
        bad[1].overlap = 0.1;
        bad[1].prediction = None;
        let short = ProofSummary::new(bad).shortfalls(&Claims::PAGE);
        assert_eq!(short.len(), 6, "{short:?}");
    }
}

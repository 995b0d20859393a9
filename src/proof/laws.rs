//! Laws that no list holds, drawn at random by the laboratory, each concealed in a device of its own: what a diagnosis makes of them.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::devices::{DrawPlan, write_recipes};
use super::error::ProofError;
use super::outcome::Made;
use super::prove::{Diagnose, score};
use super::score::CaseScore;
use super::sweep::{Course, carry_out};
use crate::diagnosis::answer::Answer;
use crate::effects::UNLISTED;
use crate::laboratory::{Known, Recipe, SealedEffect, law_case, write_case};
use crate::recording::atomic::UnfinishedFolder;
use crate::stats::quantile;

/// Seed of the first device.
const FIRST_SEED: u64 = 2_000_000;
/// Error of a prediction that is within the claim [standard deviations].
const WITHIN: f64 = 2.0;
/// Variables that an answer may name.
const MOST_VARIABLES: usize = 3;

/// A case and what was made of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LawOutcome {
    /// Its making: what must agree to go on.
    pub made: Made,
    /// The law in a line.
    pub law: String,
    /// Subsystem in which it acts.
    pub subsystem: String,
    /// Variables that it depends on.
    pub depends_on: Vec<String>,
    /// The listed effect beside it.
    pub beside: Option<String>,
    /// Visibility of all that is concealed, in standard deviations [1].
    pub shows: f64,
    /// The model discrepancy that was answered: subsystem, variables, formula.
    pub answers: Vec<LawAnswer>,
    /// The score.
    pub score: CaseScore,
}

/// An answer with a model discrepancy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LawAnswer {
    /// Subsystem.
    pub subsystem: String,
    /// Variables.
    pub depends_on: Vec<String>,
    /// Port and formula, or the form of its curve.
    pub says: String,
}

impl LawOutcome {
    /// Whether its subsystem was given.
    pub fn link(&self) -> bool {
        self.answers.iter().any(|a| a.subsystem == self.subsystem)
    }

    /// Whether all that it depends on is among no more than three variables given.
    pub fn variables(&self) -> bool {
        let all = |a: &LawAnswer| {
            self.depends_on
                .iter()
                .all(|name| a.depends_on.contains(name))
        };
        let mut few = self
            .answers
            .iter()
            .filter(|a| a.depends_on.len() <= MOST_VARIABLES);
        few.any(all)
    }

    /// Whether the unseen recording was predicted.
    pub fn predicted(&self) -> bool {
        self.score.prediction.is_some_and(|error| error <= WITHIN)
    }
}

impl DrawPlan {
    /// Name and seed of each case.
    fn cases(&self) -> Vec<(String, u64)> {
        let seeds = self.seeds(FIRST_SEED);
        seeds.map(|seed| (format!("law-{seed}"), seed)).collect()
    }

    /// Draws a case.
    ///
    /// # Errors
    /// No law will do.
    fn recipe(&self, name: &str, seed: u64) -> Result<Recipe, ProofError> {
        let recipe = law_case(name, seed, self.duration)?;
        let conditions = self.conditions.of(seed, self.duration);
        Ok(Recipe {
            conditions,
            ..recipe
        })
    }

    /// A device with a law by the name of its case; none that the plan does not have.
    ///
    /// # Errors
    /// No law will do.
    pub fn law_named(&self, name: &str) -> Result<Option<Recipe>, ProofError> {
        let mut cases = self.cases().into_iter();
        let found = cases.find(|(own, _)| own == name);
        found
            .map(|(name, seed)| self.recipe(&name, seed))
            .transpose()
    }

    fn made(&self, seed: u64) -> Made {
        Made {
            effect: Some("law".to_owned()),
            size: 0,
            sizes: 1,
            seed,
            duration_s: self.duration,
            conditions: self.conditions,
        }
    }

    /// Writes the cases of the laws into `cases` and their truth into `sealed`; `say` gets how many are written, of how many. Returns their names.
    ///
    /// # Errors
    /// No law will do for a device, a file that cannot be written.
    pub fn write_laws(
        &self,
        cases: &Path,
        sealed: &Path,
        say: &dyn Fn(usize, usize),
    ) -> Result<Vec<String>, ProofError> {
        let recipes = self.cases().into_iter();
        let recipes = recipes.map(|(name, seed)| self.recipe(&name, seed));
        write_recipes(recipes, (cases, sealed), say)
    }
}

/// Diagnoses the cases of a plan that are not done yet; as `sweep`.
///
/// # Errors
/// Outcomes of another plan, no law that will do for a device, a file that cannot be written.
pub fn laws(
    plan: &DrawPlan,
    course: &Course<'_>,
    diagnose: &Diagnose<'_>,
    say: &(dyn Fn(usize, usize, &str) + Sync),
) -> Result<Vec<LawOutcome>, ProofError> {
    let cases = plan.cases();
    let names: Vec<String> = cases.iter().map(|(name, _)| name.clone()).collect();
    let made: Vec<Made> = cases.iter().map(|(_, seed)| plan.made(*seed)).collect();
    carry_out(
        course,
        &names,
        (&|outcome: &LawOutcome| outcome.made.clone(), &made),
        &|index| attempt(plan, &names[index], cases[index].1, course.out, diagnose),
        &|outcome| {
            let mark = |is_right: bool| if is_right { "right" } else { "wrong" };
            let [link, variables] = [outcome.link(), outcome.variables()].map(mark);
            let names = answered(outcome);
            format!("answered {names}, link {link}, variables {variables}")
        },
        say,
    )
}

fn attempt(
    plan: &DrawPlan,
    name: &str,
    seed: u64,
    out: &Path,
    diagnose: &Diagnose<'_>,
) -> Result<LawOutcome, ProofError> {
    let case = plan.recipe(name, seed)?.make()?;
    let room = UnfinishedFolder::within(out)?;
    let place = |part: &str| -> PathBuf { room.path().join(part) };
    write_case(&case, &place("case"), None)?;
    let answer = diagnose(&place("case"), &place("answer"));
    let answers = answer.as_ref().map_or_else(|_| Vec::new(), unlisted);
    // Only now is there a sealed file at all.
    write_case(&case, &place("again"), Some(&place("sealed")))?;
    let score = score(name, answer, &place("answer"), &place("sealed"))?;
    let is_law = |effect: &&SealedEffect| effect.name == UNLISTED;
    let law = case.sealed.effects.iter().find(is_law);
    let beside = case.sealed.effects.iter().find(|effect| !is_law(effect));
    let depends_on = match law.and_then(|law| law.parameters.get("depends_on")) {
        Some(Known::Names(names)) => names.clone(),
        _ => Vec::new(),
    };
    Ok(LawOutcome {
        made: plan.made(seed),
        law: law.and_then(|law| law.formula.clone()).unwrap_or_default(),
        subsystem: law.map_or_else(String::new, |law| law.subsystem.clone()),
        depends_on,
        beside: beside.map(|effect| effect.name.clone()),
        shows: case.sealed.shows,
        answers,
        score,
    })
}

/// What an answer says of a model discrepancy.
fn unlisted(answer: &Answer) -> Vec<LawAnswer> {
    let found = answer
        .effects
        .iter()
        .filter(|effect| effect.name == UNLISTED);
    found
        .map(|effect| LawAnswer {
            subsystem: effect.subsystem.clone(),
            depends_on: effect.depends_on.clone(),
            says: effect.unlisted.as_ref().map_or_else(String::new, |report| {
                let form = || format!("{} curve over {}", report.form, report.variable);
                let formula = report.formula.clone().unwrap_or_else(form);
                format!("{}: {formula}", report.port)
            }),
        })
        .collect()
}

/// Names answered, or why there are none.
fn answered(outcome: &LawOutcome) -> String {
    match (&outcome.score.answered, &outcome.score.failure) {
        (Some(names), _) if names.is_empty() => "nothing".to_owned(),
        (Some(names), _) => names.join(" + "),
        (None, failure) => failure.clone().unwrap_or_default(),
    }
}

/// A case in a row of the table.
fn row(outcome: &LawOutcome) -> String {
    let score = &outcome.score;
    let mark = |is_right: bool| if is_right { "yes" } else { "no" };
    let says = outcome.answers.iter().map(|a| {
        let variables = a.depends_on.join(", ");
        format!("{} ({}; {variables})", a.says, a.subsystem)
    });
    let answer = [answered(outcome)]
        .into_iter()
        .chain(says)
        .collect::<Vec<String>>()
        .join(": ");
    let beside = outcome
        .beside
        .as_deref()
        .map_or(String::new(), |name| format!(", beside {name}"));
    let number = |value: Option<f64>, digits: usize| {
        value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
    };
    // A bar would end the cell.
    let cell = |text: String| text.replace('|', "\\|");
    format!(
        "| {} | {} | {} ({}) | {:.0} | {} | {} | {} | {} | {} | {} |",
        outcome.made.seed,
        cell(outcome.law.clone() + &beside),
        outcome.depends_on.join(", "),
        outcome.subsystem,
        outcome.shows,
        cell(answer),
        mark(outcome.link()),
        mark(outcome.variables()),
        mark(score.named_exactly),
        number(score.prediction, 2),
        number(score.seconds, 0),
    )
}

/// The counts, then a row a case, in Markdown.
pub fn laws_page(outcomes: &[LawOutcome]) -> String {
    let all = outcomes.len();
    let mut text = String::from("# Laws that no list holds\n\n");
    let mut count = |what: &str, hit: &dyn Fn(&LawOutcome) -> bool| {
        let hits = outcomes.iter().filter(|o| hit(o)).count();
        let _ = writeln!(text, "- {what}: {hits} of {all}");
    };
    count("right link", &LawOutcome::link);
    count(
        "right variables, among at most three",
        &LawOutcome::variables,
    );
    count("right link and variables", &|o| o.link() && o.variables());
    count("right set of names", &|o| o.score.named_exactly);
    count("unseen recording within 2 sigma", &LawOutcome::predicted);
    count("answered", &|o| o.score.answered.is_some());
    let seconds: Vec<f64> = outcomes.iter().filter_map(|o| o.score.seconds).collect();
    let [median, most] =
        [0.5, 1.0].map(|share| quantile(seconds.iter().copied(), share).unwrap_or(f64::NAN));
    let _ = writeln!(text, "- seconds: median {median:.0}, worst {most:.0}\n");
    text += "Unseen: 90th percentile of the prediction's error in the worst channel, in standard deviations of its noise; 1.64 is perfect. Shows: all that is\n\
concealed, in standard deviations beside all that is tolerated.\n\n\
| seed | law | depends on (link) | shows | answer | link | variables | names | unseen | s |\n\
| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for outcome in outcomes {
        let _ = writeln!(text, "{}", row(outcome));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laboratory::SealedCase;
    use crate::proof::CaseConditions;

    #[test]
    fn the_page_counts_links_variables_names_and_predictions() {
        let sealed = SealedCase {
            case: "law-1".to_owned(),
            effects: Vec::new(),
            also_there: Vec::new(),
            noise: std::collections::BTreeMap::default(),
            mismatch: Vec::new(),
            true_parameters: std::collections::BTreeMap::default(),
            shows: 80.0,
            seed: 1,
        };
        let names = |list: &[&str]| {
            list.iter()
                .map(|s| (*s).to_owned())
                .collect::<Vec<String>>()
        };
        let plan = DrawPlan {
            count: 2,
            draw: 0,
            duration: 4.0,
            conditions: CaseConditions::Laboratory,
            shares: [super::super::LEAST_SHARE, 1.0],
        };
        let outcome = |subsystem: &str, variables: &[&str], error: f64| LawOutcome {
            made: plan.made(7),
            law: "force on the piston = 1 N |u|".to_owned(),
            subsystem: "force_balance".to_owned(),
            depends_on: names(&["stroke_m", "velocity_sign"]),
            beside: Some("tool_runout".to_owned()),
            shows: 80.0,
            answers: vec![LawAnswer {
                subsystem: subsystem.to_owned(),
                depends_on: names(variables),
                says: "friction: 2 N".to_owned(),
            }],
            score: CaseScore {
                prediction: Some(error),
                seconds: Some(10.0 * error),
                answered: Some(names(&["unlisted"])),
                ..CaseScore::failed(&sealed, String::new())
            },
        };
        let all = [
            outcome("force_balance", &["velocity_sign", "time", "stroke_m"], 1.7),
            outcome("sensors", &["stroke_m"], 2.1),
            outcome(
                "force_balance",
                &["stroke_m", "velocity_sign", "time", "velocity"],
                3.0,
            ),
        ];
        let page = laws_page(&all);
        for line in [
            "right link: 2 of 3",
            "right variables, among at most three: 1 of 3",
            "right set of names: 0 of 3",
            "unseen recording within 2 sigma: 1 of 3",
            "seconds: median 21, worst 30",
            "1 N \\|u\\|, beside tool_runout",
        ] {
            assert!(page.contains(line), "{line}: {page}");
        }
    }
}

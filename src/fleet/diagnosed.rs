//! What a recording of a fleet came to: first by what explained the last one, and by nothing; where neither leaves noise alone, by a search.

use serde::{Deserialize, Serialize};

use crate::case::{Case, CaseError, diagnose};
use crate::diagnosis::answer::Verdict;
use crate::diagnosis::answer::estimate::Number;
use crate::diagnosis::search::known::{KnownEffects, KnownFit};
use crate::diagnosis::settings::Settings;
use crate::effects::Effect;

/// An effect with the values that a fit starts from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Started {
    /// Its name.
    pub name: String,
    /// Values of its numbers.
    pub values: Vec<f64>,
}

/// A number with its interval at 95 %.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NumberFound {
    /// Its name, with its unit.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Ends of the interval.
    pub low: f64,
    /// See `low`.
    pub high: f64,
}

/// What a recording came to.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Diagnosed {
    /// 0, or 2 where it could not be read.
    pub code: u8,
    /// Why it could not be read; empty where it could.
    pub reason: String,
    /// `nothing_missing`, `explained` or `unlisted`.
    pub verdict: String,
    /// Whether it took a search.
    pub searched: bool,
    /// What is at work, and its reported numbers.
    pub effects: Vec<(String, Vec<NumberFound>)>,
    /// Nominal values with a tolerance, as the recording has it.
    pub tolerated: Vec<NumberFound>,
    /// What the next recording begins with.
    pub state: Vec<Started>,
}

impl Diagnosed {
    /// A recording with effects that are fitted, whatever else there is.
    ///
    /// # Errors
    /// Those of the case.
    pub fn of_effects(case: &Case, effects: &[Started]) -> Result<Self, CaseError> {
        let fitted = case.known_fit(&[known(case, effects)])?;
        Ok(fitted.map(|fit| of_fit(case, &fit)).unwrap_or_default())
    }

    /// A recording after one that came to this state; with the improved model, where it took a search.
    ///
    /// # Errors
    /// Those of the case and of its diagnosis.
    pub fn after(case: &Case, state: &[Started]) -> Result<(Self, Option<String>), CaseError> {
        let mut sets = vec![Vec::new()];
        if !state.is_empty() {
            sets.push(known(case, state));
        }
        if let Some(fit) = case.known_fit(&sets)?
            && fit.leaves_noise
        {
            return Ok((of_fit(case, &fit), None));
        }
        let searched = diagnose(case, &Settings::default(), &mut |_| ())?;
        let mut result = Self {
            verdict: word(searched.answer.verdict).to_owned(),
            searched: true,
            ..Self::default()
        };
        if let Some(diagnosis) = &searched.diagnosis {
            let numbers = &diagnosis.estimates;
            fill(&mut result, case, &numbers.effects, &numbers.tolerated);
            if searched.answer.verdict == Verdict::Unlisted {
                result.effects.push(("unlisted".to_owned(), Vec::new()));
            }
        }
        Ok((result, Some(searched.improved)))
    }
}

fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Explained => "explained",
        Verdict::NothingMissing => "nothing_missing",
        Verdict::Unlisted => "unlisted",
    }
}

/// Effects by their names, of those that the case may have.
fn known(case: &Case, started: &[Started]) -> KnownEffects {
    let candidates = case.input().map(|input| &input.candidates);
    let find = |name: &str| {
        candidates?
            .iter()
            .find(|effect| effect.name == name)
            .copied()
    };
    let of = |one: &Started| Some((find(&one.name)?, one.values.clone()));
    started.iter().filter_map(of).collect()
}

fn of_fit(case: &Case, fit: &KnownFit) -> Diagnosed {
    let verdict = match fit.effects.is_empty() {
        true => "nothing_missing",
        false => "explained",
    };
    let mut result = Diagnosed {
        verdict: verdict.to_owned(),
        ..Diagnosed::default()
    };
    fill(&mut result, case, &fit.effects, &fit.tolerated);
    result
}

fn fill(
    result: &mut Diagnosed,
    case: &Case,
    effects: &[(&'static Effect, Vec<Number>)],
    tolerated: &[Number],
) {
    let found = |number: &Number| NumberFound {
        name: number.name.to_owned(),
        value: number.value,
        low: number.interval[0],
        high: number.interval[1],
    };
    for (effect, numbers) in effects {
        let reported = numbers.iter().filter(|number| number.reported).map(found);
        result
            .effects
            .push((effect.name.to_owned(), reported.collect()));
        let Some(input) = case.input() else { continue };
        let parameters = effect.parameters(&input.nominal);
        let value = |name: &str| numbers.iter().find(|n| n.name == name).map(|n| n.value);
        let values: Option<Vec<f64>> = parameters.iter().map(|p| value(p.quantity.name)).collect();
        if let (Some(values), None) = (values, effect.phase) {
            let name = effect.name.to_owned();
            result.state.push(Started { name, values });
        }
    }
    result.tolerated = tolerated.iter().map(found).collect();
}

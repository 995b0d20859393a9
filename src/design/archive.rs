//! Every design that was evaluated, each once.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::candidate::{Evaluate, EvaluateError, Outcome};
use super::limits::Limit;
use super::study::{Study, TradeOff};

/// An evaluated design.
#[derive(Debug, Clone)]
pub(super) struct EvaluatedDesign {
    /// Its values, one a variable.
    pub values: Vec<f64>,
    /// Its result, or the reason why there is none.
    pub result: Result<Scored, EvaluateError>,
}

/// Value of a design that could be simulated.
#[derive(Debug, Clone)]
pub(super) struct Scored {
    pub outcome: Outcome,
    /// The objective, in its unit.
    pub objective: f64,
    /// The second objective, in its unit; 0 if there is none.
    pub trade_off: f64,
    /// Per limit, how far it is outside, as a share of the bound; negative inside.
    pub excess: Vec<f64>,
}

impl Scored {
    /// Whether all limits are kept.
    pub fn feasible(&self) -> bool {
        self.excess.iter().all(|excess| *excess <= 0.0)
    }
}

/// A design that could be simulated.
pub(super) type Good = (Arc<EvaluatedDesign>, Scored);

/// The design, if it could be simulated.
pub(super) fn good(evaluated: &Arc<EvaluatedDesign>) -> Option<Good> {
    let scored = evaluated.result.as_ref().ok()?;
    Some((evaluated.clone(), scored.clone()))
}

/// A part of the search: its stretch of the budget, and the designs that were known when it began.
#[derive(Debug, Clone, Copy, Default)]
struct Stage {
    from: usize,
    to: usize,
    before: usize,
}

impl Stage {
    /// Where in the budget the search is with so many designs known.
    fn position(self, known: usize) -> usize {
        (self.from + known.saturating_sub(self.before)).min(self.to)
    }
}

/// Evaluates and remembers. Shared between threads: which of them comes first changes nothing, for the same design gives the same outcome and the
/// designs are kept in the order of their values.
pub(super) struct Archive<'a> {
    study: &'a Study,
    evaluator: &'a dyn Evaluate,
    progress: &'a (dyn Fn(usize, usize) + Sync),
    /// State of the progress.
    stage: Mutex<Stage>,
    known: Mutex<BTreeMap<Vec<u64>, Arc<EvaluatedDesign>>>,
}

impl<'a> Archive<'a> {
    pub fn new(
        study: &'a Study,
        evaluator: &'a dyn Evaluate,
        progress: &'a (dyn Fn(usize, usize) + Sync),
    ) -> Self {
        Self {
            study,
            evaluator,
            progress,
            stage: Mutex::default(),
            known: Mutex::default(),
        }
    }

    /// An empty one for designs that are not to be chosen.
    pub fn aside(&self) -> Self {
        Self::new(self.study, self.evaluator, self.progress)
    }

    /// A part of the search begins, for which this stretch of the budget is meant. A part that needs less ends early: the time left is then less than was
    /// shown, and never more.
    pub fn begin(&self, from: usize, to: usize) {
        let before = self.known().len();
        *self.stage() = Stage { from, to, before };
        (self.progress)(from, self.study.evaluations);
    }

    fn stage(&self) -> std::sync::MutexGuard<'_, Stage> {
        self.stage.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn study(&self) -> &'a Study {
        self.study
    }

    /// The design at these places from 0 to 1.
    pub fn at(&self, coordinates: &[f64]) -> Arc<EvaluatedDesign> {
        let values = self.study.values(coordinates);
        let key: Vec<u64> = values.iter().map(|value| sortable(*value)).collect();
        if let Some(evaluated) = self.known().get(&key) {
            return evaluated.clone();
        }
        // Not under the lock: this takes long. Two threads may do the same work, with the same outcome.
        let evaluated = Arc::new(self.evaluate(values));
        let count = {
            let mut known = self.known();
            known.entry(key).or_insert_with(|| evaluated.clone());
            known.len()
        };
        let position = self.stage().position(count);
        (self.progress)(position, self.study.evaluations);
        evaluated
    }

    /// A design of any values, which is not remembered.
    pub fn evaluate(&self, values: Vec<f64>) -> EvaluatedDesign {
        let result = self
            .evaluator
            .evaluate(&self.study.design(&values))
            .and_then(|outcome| score(self.study, &values, outcome));
        EvaluatedDesign { values, result }
    }

    /// The bare outcome of a design, of which metrics may be missing.
    pub fn outcome(&self, values: &[f64]) -> Result<Outcome, EvaluateError> {
        self.evaluator.evaluate(&self.study.design(values))
    }

    /// All designs so far, by their values.
    pub fn all(&self) -> Vec<Arc<EvaluatedDesign>> {
        self.known().values().cloned().collect()
    }

    /// Those that keep all limits.
    pub fn feasible(&self) -> Vec<Good> {
        let all = self.all();
        let good = all.iter().filter_map(good);
        good.filter(|(_, scored)| scored.feasible()).collect()
    }

    fn known(&self) -> std::sync::MutexGuard<'_, BTreeMap<Vec<u64>, Arc<EvaluatedDesign>>> {
        // Only whole entries are ever inserted, so a panic elsewhere leaves the map sound.
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Bits in the order of the numbers.
fn sortable(value: f64) -> u64 {
    let bits = value.to_bits();
    if bits >> 63 == 0 {
        bits | 1 << 63
    } else {
        !bits
    }
}

fn score(study: &Study, values: &[f64], outcome: Outcome) -> Result<Scored, EvaluateError> {
    let given = |value: Option<f64>, metric: &str| match value {
        Some(value) if value.is_finite() => Ok(value),
        Some(value) => Err(EvaluateError {
            reason: format!("{metric} not finite"),
            detail: format!("{metric} is {value}, expected a finite number"),
        }),
        None => Err(EvaluateError {
            reason: format!("{metric} not determined"),
            detail: format!("no scenario determines {metric}"),
        }),
    };
    let objective = given(study.objective.value(&outcome), &study.objective.metric)?;
    let trade_off = match &study.trade_off {
        Some(TradeOff::Metric(metric)) => given(metric.value(&outcome), &metric.metric)?,
        Some(TradeOff::Variable(index)) => values[*index],
        None => 0.0,
    };
    let excess = |limit: &Limit| {
        let value = given(limit.value(&outcome), limit.key())?;
        Ok(limit.excess(value) / limit.scale())
    };
    let excess = study.limits.iter().map(excess).collect::<Result<_, _>>()?;
    Ok(Scored {
        outcome,
        objective,
        trade_off,
        excess,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_sort_as_the_numbers_do() {
        let numbers = [-2.5, -1.0, -1e-9, 0.0, 1e-9, 0.5, 3.0, 1e12];
        assert!(numbers.map(sortable).is_sorted_by(|a, b| a < b));
    }
}

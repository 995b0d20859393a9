//! Effort of a search, and a limit of it.
//!
//! Effort is counted in model evaluations: simulations of all recordings that are looked at by one description. Whether a limit is reached is asked at
//! checkpoints of the search alone, which one thread passes in the same order in every run, and only where something was evaluated since the last one. So a
//! search that a limit of time has stopped stands at an effort that stops it again at the same checkpoint.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

/// Limit of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum EffortLimit {
    /// It ends by itself.
    #[default]
    None,
    /// So many model evaluations.
    Evaluations(u64),
    /// So long, by the clock.
    Time(Duration),
}

/// Effort that a search came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct EffortReport {
    /// Model evaluations, until its limit stopped it or until it came to its own end.
    pub model_evaluations: u64,
    /// Whether a limit stopped it.
    pub stopped: bool,
}

impl EffortReport {
    /// In a sentence for people, of one that was stopped.
    #[must_use]
    pub fn note(&self) -> Option<String> {
        let count = self.model_evaluations;
        self.stopped.then(|| {
            format!(
                "the search was stopped by its limit after {count} model evaluations and the answer is the best so far: what it did not come to is not ruled out; `--effort {count}` comes to the same answer"
            )
        })
    }
}

/// Effort of a search so far; copies count together.
#[derive(Debug, Clone, Default)]
pub struct Effort(Arc<Count>);

#[derive(Debug, Default)]
struct Count {
    limit: EffortLimit,
    begun: Option<Instant>,
    evaluations: AtomicU64,
    /// Evaluations at the checkpoint passed last.
    passed: AtomicU64,
    /// Evaluations at the checkpoint that stopped the search; 0 where none did.
    stopped: AtomicU64,
    /// Evaluations spent on formulas.
    on_formulas: AtomicU64,
    /// Evaluations from which no formula was asked for any more; 0 where all were.
    without_formulas: AtomicU64,
}

impl Effort {
    /// None so far, within a limit that counts from now on.
    #[must_use]
    pub fn within(limit: EffortLimit) -> Self {
        Self(Arc::new(Count {
            limit,
            begun: Some(Instant::now()),
            ..Count::default()
        }))
    }

    /// One more evaluation.
    pub(super) fn count(&self) {
        self.0.evaluations.fetch_add(1, Ordering::Relaxed);
    }

    /// Model evaluations so far.
    fn evaluations(&self) -> u64 {
        self.0.evaluations.load(Ordering::Relaxed)
    }

    /// What the search has come to.
    pub(super) fn report(&self) -> EffortReport {
        let stopped = self.stopped_at();
        EffortReport {
            model_evaluations: stopped.unwrap_or_else(|| self.evaluations()),
            stopped: stopped.is_some(),
        }
    }

    /// What is found in a search for formulas; nothing where so many evaluations were spent on such before, or at a limit. A checkpoint.
    pub(super) fn on_formulas<T>(&self, most: u64, search: impl FnOnce() -> Vec<T>) -> Vec<T> {
        let begun = self.evaluations();
        if self.0.on_formulas.load(Ordering::Relaxed) >= most {
            let first = &self.0.without_formulas;
            let _ = first.compare_exchange(0, begun, Ordering::Relaxed, Ordering::Relaxed);
            return Vec::new();
        }
        if self.is_spent() {
            return Vec::new();
        }
        let found = search();
        let spent = self.evaluations() - begun;
        self.0.on_formulas.fetch_add(spent, Ordering::Relaxed);
        found
    }

    /// In a sentence for people that no formula was asked for any more, where that is so.
    pub(super) fn note_of_formulas(&self) -> Option<String> {
        let count = self.0.without_formulas.load(Ordering::Relaxed);
        (count > 0).then(|| {
            format!(
                "no further law that the list does not hold was looked for after {count} model evaluations: none is ruled out by that"
            )
        })
    }

    /// Evaluations at which a limit stopped the search; none where it came to its own end.
    fn stopped_at(&self) -> Option<u64> {
        Some(self.0.stopped.load(Ordering::Relaxed)).filter(|stopped| *stopped > 0)
    }

    /// A checkpoint: whether the search is to end with the best that it has. Called from the thread that searches, while no other evaluates.
    pub(super) fn is_spent(&self) -> bool {
        if self.stopped_at().is_some() {
            return true;
        }
        let evaluations = self.evaluations();
        if self.0.passed.swap(evaluations, Ordering::Relaxed) == evaluations {
            return false;
        }
        let spent = match self.0.limit {
            EffortLimit::None => false,
            EffortLimit::Evaluations(most) => evaluations >= most,
            EffortLimit::Time(most) => self.0.begun.is_some_and(|begun| begun.elapsed() >= most),
        };
        if spent {
            self.0.stopped.store(evaluations, Ordering::Relaxed);
        }
        spent
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_limit_of_time_comes_to_stops_at_the_same_checkpoint() {
        // Evaluations between checkpoints; at some of them nothing was evaluated.
        let between = [3, 0, 4, 0, 0, 5];
        let walk = |effort: &Effort| {
            between.iter().position(|count| {
                (0..*count).for_each(|_| effort.count());
                effort.is_spent()
            })
        };
        let timed = Effort::within(EffortLimit::Time(Duration::ZERO));
        // Stopped at the first.
        assert_eq!((walk(&timed), timed.stopped_at()), (Some(0), Some(3)));
        for most in [3, 4, 7, 8, 12] {
            let counted = Effort::within(EffortLimit::Evaluations(most));
            let place = walk(&counted).unwrap();
            let again = Effort::within(EffortLimit::Evaluations(counted.stopped_at().unwrap()));
            assert_eq!(walk(&again), Some(place), "{most}");
        }
        assert_eq!(walk(&Effort::within(EffortLimit::Evaluations(13))), None);
        assert_eq!(walk(&Effort::default()), None);
        // Once stopped, it stays so.
        assert!(timed.is_spent());
    }

    /// A planted law was not looked for, as the known effects had taken so many evaluations before: what is spent on formulas counts alone.
    #[test]
    fn past_its_evaluations_no_formula_is_asked_for_and_that_is_said_with_where_it_began() {
        let effort = Effort::default();
        let search = || {
            effort.on_formulas(10, || {
                (0..6).for_each(|_| effort.count());
                vec![()]
            })
        };
        (0..20).for_each(|_| effort.count());
        assert_eq!([search().len(), search().len()], [1, 1]);
        assert_eq!(effort.note_of_formulas(), None);
        assert_eq!([search().len(), search().len()], [0, 0]);
        let note = effort.note_of_formulas().unwrap();
        assert!(note.contains("after 32 model evaluations"), "{note}");
        // The search itself goes on.
        assert!(!effort.report().stopped);
    }
}

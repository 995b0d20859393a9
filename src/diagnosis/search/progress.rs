//! Progress of a diagnosis, for whoever waits for it.

use std::fmt;

use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::effects::Effect;

/// Steps of a diagnosis, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Step {
    /// The nominal model is fitted within its tolerances.
    Baseline,
    /// Explanations are fitted roughly.
    RoughFit,
    /// The leading ones are fitted in full.
    FullFit,
    /// The best ones are varied: fewer effects, plainer laws, close rivals, model discrepancies.
    Variation,
    /// The mismatch is located.
    Localisation,
    /// Experiments are compared.
    Experiments,
}

/// A message on the way.
#[derive(Debug, Clone)]
pub struct Progress<'a> {
    /// Step that it is of.
    pub step: Step,
    /// Effects of the explanation that was fitted; none where it is about no single one.
    pub effects: &'a [&'static Effect],
    /// Numbers, for developers.
    pub detail: String,
}

/// Observer of a diagnosis: called on the thread that diagnoses.
pub type Observer<'a> = dyn FnMut(&Progress<'_>) + 'a;

impl Step {
    /// Message that the step begins.
    pub(in crate::diagnosis) fn begins(self) -> Progress<'static> {
        Progress {
            step: self,
            effects: &[],
            detail: String::new(),
        }
    }

    /// Message on an explanation.
    pub(in crate::diagnosis) fn of(self, hypothesis: &Hypothesis, detail: String) -> Progress<'_> {
        Progress {
            step: self,
            effects: &hypothesis.effects,
            detail,
        }
    }

    /// Message on none in particular.
    pub(in crate::diagnosis) fn with(self, detail: String) -> Progress<'static> {
        Progress {
            detail,
            ..self.begins()
        }
    }
}

impl fmt::Display for Progress<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            step,
            effects,
            detail,
        } = self;
        write!(formatter, "{step:?} {effects:?} {detail}")
    }
}

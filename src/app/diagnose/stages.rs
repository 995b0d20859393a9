//! Stages of a diagnosis as people see them. The time that a search takes depends on what it finds: the share of the work behind each step is a guess.

use crate::diagnosis::search::progress::{Progress, Step};

/// Stages in their order.
const STAGES: [&str; 5] = [
    "reading the recordings",
    "fitting the nominal model",
    "weighing explanations",
    "locating the mismatch",
    "comparing experiments",
];

/// Stage that a step belongs to, and share of the whole that lies behind where it begins [1]: medians of six cases, in which what was left was within a factor
/// of 2.2 of what this gives.
fn place(step: Step) -> (usize, Option<f64>) {
    match step {
        Step::Baseline => (1, None),
        Step::RoughFit => (2, Some(0.32)),
        Step::FullFit => (2, Some(0.55)),
        Step::Variation => (2, None),
        Step::Localisation => (3, Some(0.95)),
        Step::Experiments => (4, Some(0.98)),
    }
}

/// Words before the recordings are read.
pub(in super::super) fn first() -> String {
    words(0)
}

fn words(stage: usize) -> String {
    format!("{} of {}: {}", stage + 1, STAGES.len(), STAGES[stage])
}

/// Furthest step of a diagnosis so far.
#[derive(Debug, Default)]
pub(in super::super) struct Stages {
    furthest: Option<Step>,
}

impl Stages {
    /// Words once the recordings are read.
    pub(super) fn begun() -> String {
        words(1)
    }

    /// Words for a message, and the share of the whole that lies behind [1] if it is the first of a further step.
    pub(in super::super) fn shown(&mut self, progress: &Progress<'_>) -> (String, Option<f64>) {
        let step = self.furthest.max(Some(progress.step));
        let further = step > self.furthest;
        self.furthest = step;
        let (stage, behind) = place(step.unwrap_or(progress.step));
        let names: Vec<String> = (progress.effects.iter())
            .map(|effect| effect.name.replace('_', " "))
            .collect();
        let text = match names.as_slice() {
            [] => words(stage),
            names => format!("{}, {}", words(stage), names.join(", ")),
        };
        (text, behind.filter(|_| further))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::CATALOGUE;

    #[test]
    fn stages_go_on_and_never_back_and_a_mark_is_passed_once() {
        let mut stages = Stages::default();
        let mut shown = |step: Step, effects: usize| {
            let effects: Vec<_> = CATALOGUE.iter().take(effects).collect();
            stages.shown(&Progress {
                step,
                effects: &effects,
                detail: "score 12.3".to_owned(),
            })
        };
        let name = CATALOGUE[0].name.replace('_', " ");
        assert_eq!(first(), "1 of 5: reading the recordings");
        assert_eq!(Stages::begun(), "2 of 5: fitting the nominal model");
        assert_eq!(shown(Step::Baseline, 0), (Stages::begun(), None));
        let searching = "3 of 5: weighing explanations".to_owned();
        let with_name = format!("{searching}, {name}");
        assert_eq!(shown(Step::RoughFit, 1), (with_name.clone(), Some(0.32)));
        assert_eq!(shown(Step::RoughFit, 1), (with_name.clone(), None));
        assert_eq!(shown(Step::FullFit, 1), (with_name.clone(), Some(0.55)));
        assert_eq!(shown(Step::RoughFit, 1), (with_name, None));
        assert_eq!(shown(Step::Variation, 0), (searching, None));
        let located = "4 of 5: locating the mismatch".to_owned();
        assert_eq!(shown(Step::Localisation, 0), (located.clone(), Some(0.95)));
        assert_eq!(shown(Step::Baseline, 0), (located, None));
        let last = "5 of 5: comparing experiments".to_owned();
        assert_eq!(shown(Step::Experiments, 0), (last, Some(0.98)));
    }
}

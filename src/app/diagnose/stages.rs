//! How far a diagnosis is, by its stages. How long a search takes depends on what it finds: what lies behind at each mark is a guess.

/// Stages in their order.
const STAGES: [&str; 5] = [
    "reading the recordings",
    "fitting the believed model",
    "weighing explanations",
    "locating the mismatch",
    "comparing experiments",
];
/// The one of them that has many steps.
const SEARCH: usize = 2;
/// What the diagnosis says when it passes a mark for the first time, and the share of the whole that lies behind then [1]: medians of six cases, in which
/// what was left was within a factor of 2.2 of what this says.
const MARKS: [(&str, f64); 4] = [
    ("] rough gain ", 0.32),
    ("] full ", 0.55),
    ("locating the mismatch", 0.95),
    ("comparing experiments", 0.98),
];

/// The stage that a diagnosis is in.
#[derive(Debug, Default)]
pub(super) struct Stages {
    index: usize,
    /// Marks that were passed.
    passed: usize,
}

impl Stages {
    /// What is shown at the start.
    pub(super) fn first() -> String {
        Self::default().shown("")
    }

    /// What is shown once the recordings are read.
    pub(super) fn begun(&mut self) -> String {
        self.index = 1;
        self.shown("")
    }

    /// What is shown when the diagnosis says this.
    pub(super) fn told(&mut self, said: &str) -> String {
        let said = said.trim();
        let named = STAGES.iter().position(|stage| *stage == said);
        self.index = named.unwrap_or(SEARCH).max(self.index);
        // Of a step, what it is about alone; how well it does is for --verbose.
        let step = match said.split_once(']') {
            Some((names, _)) if named.is_none() => names.trim_start_matches('[').replace('_', " "),
            _ => String::new(),
        };
        self.shown(&step)
    }

    /// The share of the whole that lies behind when the diagnosis says this, if that is a mark.
    pub(super) fn behind(&mut self, said: &str) -> Option<f64> {
        let mark = MARKS.iter().rposition(|(words, _)| said.contains(words))?;
        (mark >= self.passed).then(|| {
            self.passed = mark + 1;
            MARKS[mark].1
        })
    }

    fn shown(&self, step: &str) -> String {
        let stage = format!(
            "{} of {}: {}",
            self.index + 1,
            STAGES.len(),
            STAGES[self.index]
        );
        match step {
            "" => stage,
            step => format!("{stage}, {step}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mark_is_passed_once() {
        let mut stages = Stages::default();
        assert_eq!(stages.behind("baseline 7, noise 3"), None);
        assert_eq!(stages.behind("  [a] rough gain 7.9"), Some(0.32));
        assert_eq!(stages.behind("  [b] rough gain 7.8"), None);
        assert_eq!(stages.behind("  [a] rough 7660.4"), None);
        assert_eq!(stages.behind("  [a] full 13903.1 left 1868"), Some(0.55));
        assert_eq!(stages.behind("  [b] rough gain 7.8"), None);
        assert_eq!(stages.behind("locating the mismatch"), Some(0.95));
    }

    #[test]
    fn stages_go_on_and_never_back() {
        let mut stages = Stages::default();
        assert_eq!(Stages::first(), "1 of 5: reading the recordings");
        assert_eq!(stages.begun(), "2 of 5: fitting the believed model");
        assert_eq!(
            stages.told("baseline 7, noise 3"),
            "3 of 5: weighing explanations"
        );
        assert_eq!(
            stages.told("  [hose_volume] rough gain 787985.1"),
            "3 of 5: weighing explanations, hose volume"
        );
        assert_eq!(
            stages.told("locating the mismatch"),
            "4 of 5: locating the mismatch"
        );
        assert_eq!(stages.told("[x] full"), "4 of 5: locating the mismatch, x");
        assert_eq!(
            stages.told("comparing experiments"),
            "5 of 5: comparing experiments"
        );
    }
}

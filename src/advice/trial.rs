//! A change tried: the scenario with it is checked as a whole, then run to its end.

use std::mem::{Discriminant, discriminant};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::cell::{Cell, CellError};
use crate::path::{Obstacle, PlanError};
use crate::scenario::{AnyScenario, KeyValue, Scenario, ScenarioTemplate};

/// Share of the desired force by which the mean of a run may miss it [1].
const FORCE_KEPT: f64 = 0.1;
/// Share of the edge on which the tool may lose contact [1].
const CONTACT_LOST: f64 = 0.01;
/// Share of a drive's largest torque from which it counts as saturated [1].
const SATURATED: f64 = 0.999;

/// What kind of refusal it is: of a plan, at what kind of obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct RefusalKind {
    refusal: Discriminant<CellError>,
    obstacle: Option<Discriminant<Obstacle>>,
}

impl RefusalKind {
    fn of(error: &CellError) -> Self {
        let obstacle = match error {
            CellError::Plan { source, .. } => match &**source {
                PlanError::Waypoint { obstacle, .. } => Some(discriminant(obstacle)),
                _ => None,
            },
            _ => None,
        };
        Self {
            refusal: discriminant(error),
            obstacle,
        }
    }
}

/// What a run came to.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RunOutcome {
    /// Whether it was stopped before its end.
    pub stopped: bool,
    /// Mean contact force along the edge [N].
    pub force: Option<f64>,
    /// Share of the edge on which the tool did not touch [1].
    pub lost: Option<f64>,
    /// Largest torque of a drive, of its limit [1].
    pub torque: Option<f64>,
}

/// Extent of a search: what is counted is the same on every machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// Places and postures that are tried.
    pub outlines: usize,
    /// Whole checks.
    pub checks: usize,
    /// Steps that are simulated, of all runs together.
    pub steps: usize,
}

impl Effort {
    /// The usual extent times a factor [1]: below 20 s for it at factor 1 on a computer of 2020.
    #[must_use]
    pub fn times(factor: f64) -> Self {
        let times = |usual: f64| (usual * factor).round() as usize;
        Self {
            outlines: times(300.0),
            checks: times(100.0),
            steps: times(400_000.0),
        }
    }
}

/// Tries changes of a scenario.
pub struct Trial<'a> {
    template: &'a ScenarioTemplate,
    /// Changes that are there already.
    given: Vec<KeyValue>,
    runs: &'a (dyn Fn(&Cell) -> Option<RunOutcome> + Sync),
    tell: &'a (dyn Fn(&'static str) + Sync),
    keep_on: &'a (dyn Fn() -> bool + Sync),
    outlines: AtomicUsize,
    checks: AtomicUsize,
    steps: AtomicUsize,
    over: AtomicBool,
    /// The refusal that is looked into, and the first change that ended it but met another.
    refusal: Option<RefusalKind>,
    other: Mutex<Option<(Vec<KeyValue>, CellError)>>,
    /// Notes of the scenario without a change; none where it cannot be loaded.
    notes: Mutex<Option<Vec<String>>>,
}

/// How changes are tried.
pub struct RunOptions<'a> {
    /// Runs a cell; none where nothing could be measured.
    pub runs: &'a (dyn Fn(&Cell) -> Option<RunOutcome> + Sync),
    /// Is given what is looked for.
    pub tell: &'a (dyn Fn(&'static str) + Sync),
    /// Whether to go on: the user's patience.
    pub keep_on: &'a (dyn Fn() -> bool + Sync),
}

impl<'a> Trial<'a> {
    /// Of a scenario with changes that are there already.
    #[must_use]
    pub fn new(
        template: &'a ScenarioTemplate,
        given: &'a [KeyValue],
        effort: Effort,
        options: &RunOptions<'a>,
    ) -> Self {
        Self {
            template,
            given: given.to_vec(),
            runs: options.runs,
            tell: options.tell,
            keep_on: options.keep_on,
            outlines: AtomicUsize::new(effort.outlines),
            checks: AtomicUsize::new(effort.checks),
            steps: AtomicUsize::new(effort.steps),
            over: AtomicBool::new(false),
            refusal: None,
            other: Mutex::new(None),
            notes: Mutex::new(None),
        }
    }

    /// The same with what is left of its extent, looking into a refusal of the scenario with further changes.
    pub(super) fn of(&self, further: &[KeyValue], refusal: &CellError) -> Self {
        let left = |from: &AtomicUsize| AtomicUsize::new(from.load(Ordering::Relaxed));
        Self {
            given: self.given.iter().chain(further).cloned().collect(),
            outlines: left(&self.outlines),
            checks: left(&self.checks),
            steps: left(&self.steps),
            over: AtomicBool::new(self.is_over()),
            refusal: Some(RefusalKind::of(refusal)),
            other: Mutex::new(None),
            notes: Mutex::new(None),
            ..*self
        }
    }

    /// The first change that ended the refusal but met another.
    pub(super) fn other_refusal(&self) -> Option<(Vec<KeyValue>, CellError)> {
        let mut other = self.other.lock().unwrap_or_else(PoisonError::into_inner);
        other.take()
    }

    pub(super) fn know(&self, notes: Option<Vec<String>>) {
        *self.notes.lock().unwrap_or_else(PoisonError::into_inner) = notes;
    }

    pub(super) fn begin(&self, what: &'static str) {
        (self.tell)(what);
    }

    /// Whether the search's extent is used up.
    #[must_use]
    pub fn is_over(&self) -> bool {
        if !(self.keep_on)() {
            self.over.store(true, Ordering::Relaxed);
        }
        self.over.load(Ordering::Relaxed)
    }

    /// Takes an amount of what may be tried; whether there was as much.
    fn take(&self, from: &AtomicUsize, amount: usize) -> bool {
        let taken = from.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| {
            left.checked_sub(amount)
        });
        if taken.is_err() {
            self.over.store(true, Ordering::Relaxed);
        }
        taken.is_ok() && !self.is_over()
    }

    /// Whether so many places may still be tried.
    #[must_use]
    pub fn may_outline(&self, count: usize) -> bool {
        self.take(&self.outlines, count)
    }

    /// The scenario with changes.
    #[must_use]
    pub fn scenario(&self, edits: &[KeyValue]) -> Option<Scenario> {
        let all: Vec<KeyValue> = self.given.iter().chain(edits).cloned().collect();
        match self.template.with(&all) {
            Ok(AnyScenario::Cell(scenario)) => Some(*scenario),
            _ => None,
        }
    }

    /// The cell with changes, checked as a whole; none where it cannot be read, or no more may be tried.
    #[must_use]
    pub fn checked(&self, edits: &[KeyValue]) -> Option<Result<Cell, CellError>> {
        if !self.take(&self.checks, 1) {
            return None;
        }
        Some(Cell::new(self.scenario(edits)?))
    }

    /// Whether a cell adds no note, runs to its end, within its drives, and keeps its force; `friction` [N] may be held back by its seals.
    #[must_use]
    pub fn runs_well(&self, cell: &Cell, friction: f64) -> bool {
        let notes = self.notes.lock().unwrap_or_else(PoisonError::into_inner);
        let known = notes.clone();
        drop(notes);
        // Those of its plan are another matter, of what its masses leave open, and of the step.
        let step = cell
            .resolution
            .note(&cell.setup.scenario)
            .into_iter()
            .count();
        let planned = cell.plan.notes.len() + usize::from(cell.estimated.is_some()) + step;
        let own = cell.setup.notes.len().saturating_sub(planned);
        let is_new = |note: &String| known.as_ref().is_some_and(|known| !known.contains(note));
        if cell.setup.notes[..own].iter().any(is_new) {
            return false;
        }
        let steps = (cell.plan.duration() / cell.setup.scenario.simulation.step).ceil();
        if !self.take(&self.steps, steps as usize) {
            return false;
        }
        let Some(outcome) = (self.runs)(cell) else {
            return false;
        };
        let desired = cell.setup.passes[0].force;
        let allowed = FORCE_KEPT * desired + friction;
        let kept =
            |force: f64| cell.setup.scenario.device.locked || (force - desired).abs() <= allowed;
        !outcome.stopped
            && outcome.torque.is_none_or(|share| share < SATURATED)
            && outcome.lost.is_none_or(|share| share <= CONTACT_LOST)
            && outcome.force.is_some_and(kept)
    }

    /// Whether a change passes the whole check and a run.
    #[must_use]
    pub fn passes(&self, edits: &[KeyValue], friction: f64) -> bool {
        match self.checked(edits) {
            Some(Ok(cell)) => self.runs_well(&cell, friction),
            Some(Err(error)) => {
                let kind = RefusalKind::of(&error);
                if self.refusal.is_some_and(|own| own != kind) {
                    let mut other = self.other.lock().unwrap_or_else(PoisonError::into_inner);
                    other.get_or_insert((edits.to_vec(), error));
                }
                false
            }
            None => false,
        }
    }
}

//! Local search: COBYLA (M. J. D. Powell, A direct search optimization method that models the objective and constraint functions by linear
//! interpolation, 1994) on the continuous variables, catalogue choices held. It sees objective and limits apart, so it runs along an active limit
//! where a method that only compares gets stuck.

use std::convert::Infallible;
use std::sync::{Mutex, PoisonError};

use basin::{
    Cobyla, ConstraintDescription, ConstraintSet, ConstraintSolveError, Constraints, CostFunction,
    Executor, NoBounds, NoLinearConstraints, NoNonlinearBlock, NonlinearBlock, NonlinearBlocks,
    NonlinearInequalityValues, SelectedState,
};

use super::archive::{Archive, EvaluatedDesign};
use super::error::DesignError;
use super::goal::Goal;

/// It aims so far inside the limits, as a share of each bound, for its linear models end beside them.
const INSIDE: f64 = 2e-5;
/// Shares of a variable's range at which it stops: about the digits that a variable has.
const FINAL_RADIUS: f64 = 2e-5;
/// Costs and excesses where nothing could be simulated.
const FAILED: f64 = 10.0;

/// A place and its rank.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ranked {
    pub coordinates: Vec<f64>,
    pub rank: f64,
}

impl Ranked {
    pub fn of(archive: &Archive<'_>, goal: &Goal, coordinates: &[f64]) -> Self {
        Self {
            rank: goal.rank(&archive.at(coordinates)),
            coordinates: coordinates.to_vec(),
        }
    }
}

struct Local<'a> {
    archive: &'a Archive<'a>,
    goal: &'a Goal,
    /// Places of all variables; those of the free ones are replaced.
    fixed: Vec<f64>,
    /// Variables that are moved.
    free: Vec<usize>,
    best: &'a Mutex<Ranked>,
}

impl Local<'_> {
    /// Evaluates within the bounds, whatever the method asks for.
    fn judge(&self, point: &[f64]) -> std::sync::Arc<EvaluatedDesign> {
        let mut coordinates = self.fixed.clone();
        for (index, coordinate) in self.free.iter().zip(point) {
            coordinates[*index] = coordinate.clamp(0.0, 1.0);
        }
        let evaluated = self.archive.at(&coordinates);
        let rank = self.goal.rank(&evaluated);
        let mut best = self.best.lock().unwrap_or_else(PoisonError::into_inner);
        if rank < best.rank {
            *best = Ranked { coordinates, rank };
        }
        evaluated
    }

    fn constraint_count(&self) -> usize {
        2 * self.free.len() + self.goal.excess_count()
    }
}

impl CostFunction for Local<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Infallible;

    fn cost(&self, point: &Vec<f64>) -> Result<f64, Infallible> {
        let evaluated = self.judge(point);
        Ok(evaluated
            .result
            .as_ref()
            .map_or(FAILED, |scored| self.goal.cost(scored)))
    }
}

impl Constraints for Local<'_> {
    type Set = ConstraintSet<
        NoBounds,
        NoLinearConstraints,
        NonlinearBlocks<NoNonlinearBlock, NonlinearBlock>,
    >;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new().with_nonlinear_inequalities(self.constraint_count())
    }
}

impl NonlinearInequalityValues for Local<'_> {
    type Param = Vec<f64>;
    type Values = Vec<f64>;
    type Error = Infallible;

    fn nonlinear_inequalities(
        &self,
        point: &Vec<f64>,
    ) -> Result<Vec<f64>, ConstraintSolveError<Infallible>> {
        let evaluated = self.judge(point);
        let bounds = point
            .iter()
            .flat_map(|coordinate| [-coordinate, coordinate - 1.0]);
        let mut values: Vec<f64> = bounds.collect();
        match &evaluated.result {
            Ok(scored) => values.extend(self.goal.excesses(scored).iter().map(|e| e + INSIDE)),
            Err(_) => values.resize(self.constraint_count(), FAILED),
        }
        Ok(values)
    }
}

/// Searches about a place with at most `budget` designs; returns the best that it met, the place itself included, and how many it asked for.
pub(super) fn polish(
    archive: &Archive<'_>,
    goal: &Goal,
    start: &[f64],
    radius: f64,
    budget: usize,
) -> Result<(Ranked, usize), DesignError> {
    let variables = &archive.study().variables;
    let free: Vec<usize> = (0..variables.len())
        .filter(|index| variables[*index].domain.count().is_none())
        .collect();
    let first = Ranked::of(archive, goal, start);
    // A simplex and a step.
    if free.is_empty() || budget < free.len() + 3 {
        return Ok((first, 1));
    }
    let point: Vec<f64> = free.iter().map(|index| start[*index]).collect();
    let best = Mutex::new(first);
    let problem = Local {
        archive,
        goal,
        fixed: start.to_vec(),
        free,
        best: &best,
    };
    let solver = Cobyla::new()
        .with_initial_radius(radius)
        .with_final_radius(FINAL_RADIUS);
    let result = Executor::new(problem, solver, SelectedState::new(point))
        .max_cost_evals(budget as u64)
        .run()
        .map_err(|error| DesignError::Optimiser(format!("COBYLA: {error}")))?;
    let used = usize::try_from(result.cost_evals())
        .unwrap_or(budget)
        .min(budget);
    Ok((
        best.into_inner().unwrap_or_else(PoisonError::into_inner),
        used,
    ))
}

//! Solvers of the crate `diffsol` on the model.

use std::cell::Cell;

use diffsol::{
    NalgebraContext, NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder, OdeEquationsImplicit,
    OdeSolverMethod, OdeSolverProblem,
};

use super::case::Case;
use super::legs::Stepper;
use super::model::{Leg, Model, State};
use super::table::Table;

type Vector = NalgebraVec<f64>;
type Matrix = NalgebraMat<f64>;
type Linear = NalgebraLU<f64>;

/// Share of the absolute in the relative tolerance: the scaled states are about 1.
const ABSOLUTE_SHARE: f64 = 1e-2;

/// As many failures as a run may have.
const MANY: usize = 1_000_000;
const STARTS: &str = "starts anywhere";

/// Less than this is not worth a step [s].
const ROUNDING: f64 = 1e-12;

/// The model as a problem of the crate; the leg is looked up at each call.
fn problem<'a>(
    case: &'a Case,
    leg: &'a Cell<Leg>,
    tolerance: f64,
) -> OdeSolverProblem<
    impl OdeEquationsImplicit<T = f64, V = Vector, M = Matrix, C = NalgebraContext> + 'a,
> {
    let (model, start) = (&case.model, case.start);
    let mut problem = OdeBuilder::<Matrix>::new()
        .rtol(tolerance)
        .atol([ABSOLUTE_SHARE * tolerance; 4])
        .rhs_implicit(
            move |y: &[f64], _: &[f64], time, rates: &mut [f64]| {
                rates.copy_from_slice(&model.rates(&leg.get(), time, &array(y)));
            },
            move |y: &[f64], _: &[f64], time, v: &[f64], product: &mut [f64]| {
                let rows = model.slopes(&leg.get(), time, &array(y)).matrix();
                for (entry, row) in product.iter_mut().zip(rows) {
                    *entry = row.iter().zip(v).map(|(a, b)| a * b).sum();
                }
            },
        )
        .init(
            move |_: &[f64], _, y: &mut [f64]| y.copy_from_slice(&start),
            4,
        )
        .build()
        .expect("the problem is complete");
    // Counted over the whole run, and the flow's kinks cost one here and there.
    problem.ode_options.max_nonlinear_solver_failures = MANY;
    problem.ode_options.max_error_test_failures = MANY;
    problem
}

fn array(y: &[f64]) -> State {
    [y[0], y[1], y[2], y[3]]
}

/// A running solver of the crate.
struct Diffsol<'a, Eqn: OdeEquationsImplicit, S> {
    model: &'a Model,
    leg: &'a Cell<Leg>,
    problem: &'a OdeSolverProblem<Eqn>,
    order: usize,
    solver: S,
}

impl<'a, Eqn, S> Diffsol<'a, Eqn, S>
where
    Eqn: OdeEquationsImplicit<T = f64, V = Vector>,
    S: OdeSolverMethod<'a, Eqn>,
{
    /// `order` is that of its first step.
    fn new(
        case: &'a Case,
        leg: &'a Cell<Leg>,
        problem: &'a OdeSolverProblem<Eqn>,
        order: usize,
        solver: S,
    ) -> Self {
        Self {
            model: &case.model,
            leg,
            problem,
            order,
            solver,
        }
    }
}

impl<'a, Eqn, S> Stepper for Diffsol<'a, Eqn, S>
where
    Eqn: OdeEquationsImplicit<T = f64, V = Vector, C = NalgebraContext>,
    S: OdeSolverMethod<'a, Eqn>,
{
    fn start(&mut self, leg: &Leg, time: f64, state: &State, end: f64, step: Option<f64>) {
        self.leg.set(*leg);
        let rates = self.model.rates(leg, time, state);
        let problem = self.problem;
        let mut own = self.solver.state_mut();
        for i in 0..4 {
            own.y[i] = state[i];
            own.dy[i] = rates[i];
        }
        *own.t = time;
        match step {
            Some(step) => *own.h = step.min(end - time),
            None => own.set_step_size(1.0, &problem.atol, problem.rtol, &problem.eqn, self.order),
        }
    }

    fn step(&mut self, stop: f64) {
        let left = stop - self.solver.state().t;
        if left <= ROUNDING {
            return;
        }
        // What it left before its last stop it takes for the length of its next step.
        if self.solver.state().h < ROUNDING {
            *self.solver.state_mut().h = 0.1 * left;
        }
        self.solver.set_stop_time(stop).expect("it is ahead");
        self.solver.step().expect("the model is tame");
    }

    fn now(&self) -> (f64, State) {
        let state = self.solver.state();
        (state.t, [0, 1, 2, 3].map(|i| state.y[i]))
    }

    fn next_step(&self) -> f64 {
        self.solver.state().h
    }

    fn at(&mut self, time: f64) -> State {
        let time = time.min(self.solver.state().t);
        let y = self.solver.interpolate(time).expect("within the last step");
        [0, 1, 2, 3].map(|i| y[i])
    }
}

/// All of its methods on every case.
pub fn add_to(table: &mut Table<'_>) {
    table.solver("BDF (diffsol)", |case, tolerance, go| {
        let leg = first_leg(case);
        let problem = problem(case, &leg, tolerance);
        let method = problem.bdf::<Linear>().expect(STARTS);
        go(&mut Diffsol::new(case, &leg, &problem, 1, method));
    });
    table.solver("TR-BDF2 (diffsol)", |case, tolerance, go| {
        let leg = first_leg(case);
        let problem = problem(case, &leg, tolerance);
        let method = problem.tr_bdf2::<Linear>().expect(STARTS);
        go(&mut Diffsol::new(case, &leg, &problem, 2, method));
    });
    table.solver("ESDIRK34 (diffsol)", |case, tolerance, go| {
        let leg = first_leg(case);
        let problem = problem(case, &leg, tolerance);
        let method = problem.esdirk34::<Linear>().expect(STARTS);
        go(&mut Diffsol::new(case, &leg, &problem, 4, method));
    });
    table.solver("Tsit45 (diffsol)", |case, tolerance, go| {
        let leg = first_leg(case);
        let problem = problem(case, &leg, tolerance);
        let method = problem.tsit45().expect(STARTS);
        go(&mut Diffsol::new(case, &leg, &problem, 5, method));
    });
}

fn first_leg(case: &Case) -> Cell<Leg> {
    Cell::new(case.timetable.leg(&case.model, None, 0.0, &case.start))
}

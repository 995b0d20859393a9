//! Solvers of the crate `differential-equations` 0.7.0 on the model, with what they need to run at all.
//!
//! Its BDF is left out: it interpolates with differences of another step, and is wrong by 1e-3 and more at any tolerance.

use differential_equations::interpolate::Interpolation;
use differential_equations::linalg::Matrix;
use differential_equations::methods::{
    DiagonallyImplicitRungeKutta, ExplicitRungeKutta, ImplicitRungeKutta,
};
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use differential_equations::status::Status;

use super::legs::Stepper;
use super::model::{Leg, Model, State};

/// The model on a leg.
struct Equations<'a> {
    model: &'a Model,
    leg: Leg,
}

impl ODE<f64, State> for Equations<'_> {
    fn diff(&self, time: f64, state: &State, rates: &mut State) {
        *rates = self.model.rates(&self.leg, time, state);
    }

    fn jacobian(&self, time: f64, state: &State, matrix: &mut Matrix<f64>) {
        let rows = self.model.slopes(&self.leg, time, state).matrix();
        for (i, row) in rows.iter().enumerate() {
            for (j, slope) in row.iter().enumerate() {
                matrix[(i, j)] = *slope;
            }
        }
    }
}

/// Rejections in a row after which a method is made anew: Radau5 of 0.7.0 can be stuck with a factorisation for another step.
const MOST_REJECTIONS: usize = 4;

fn begin<S: OrdinaryNumericalMethod<f64, State>>(
    method: &mut S,
    equations: &Equations<'_>,
    time: f64,
    end: f64,
    state: &State,
) {
    method
        .init(equations, time, end, state)
        .expect("starts anywhere");
    method.set_status(Status::Solving);
}

/// Absolute tolerance over the relative one: the scaled states are about 1.
const ABSOLUTE_SHARE: f64 = 1e-2;

/// Explicit, order 8, at a relative tolerance.
pub fn dop853(model: &Model, tolerance: f64) -> Box<dyn Stepper + '_> {
    Adaptive::boxed(model, move |first_step| {
        ExplicitRungeKutta::dop853()
            .rtol(tolerance)
            .atol(ABSOLUTE_SHARE * tolerance)
            .h0(first_step)
            .max_steps(usize::MAX)
    })
}

/// Explicit, order 5.
pub fn dopri5(model: &Model, tolerance: f64) -> Box<dyn Stepper + '_> {
    Adaptive::boxed(model, move |first_step| {
        ExplicitRungeKutta::dopri5()
            .rtol(tolerance)
            .atol(ABSOLUTE_SHARE * tolerance)
            .h0(first_step)
            .max_steps(usize::MAX)
    })
}

/// Fully implicit, order 5. It turns its tolerances into others, one scalar as often as there are states: so it gets one for each.
pub fn radau5(model: &Model, tolerance: f64) -> Box<dyn Stepper + '_> {
    Adaptive::boxed(model, move |first_step| {
        ImplicitRungeKutta::radau5()
            .rtol([tolerance; 4])
            .atol([ABSOLUTE_SHARE * tolerance; 4])
            .h0(first_step)
            .max_steps(usize::MAX)
    })
}

/// Diagonally implicit, order 5 (Kvaerno). It never forgets a rejection, so it may have any number of them.
pub fn kvaerno5(model: &Model, tolerance: f64) -> Box<dyn Stepper + '_> {
    Adaptive::boxed(model, move |first_step| {
        DiagonallyImplicitRungeKutta::kvaerno745()
            .rtol(tolerance)
            .atol(ABSOLUTE_SHARE * tolerance)
            .h0(first_step)
            .max_steps(usize::MAX)
            .max_rejects(usize::MAX)
    })
}

/// A method of the crate, made anew at each start: some of them change their own tolerances when they start.
struct Adaptive<'a, S, F> {
    model: &'a Model,
    make: F,
    running: Option<(Equations<'a>, S)>,
}

impl<'a, S, F> Adaptive<'a, S, F>
where
    S: OrdinaryNumericalMethod<f64, State> + Interpolation<f64, State>,
    F: Fn(f64) -> S,
{
    /// `make` is given the first step [s], or 0 for one of the method's own choice.
    fn boxed(model: &'a Model, make: F) -> Box<dyn Stepper + 'a>
    where
        S: 'a,
        F: 'a,
    {
        Box::new(Self {
            model,
            make,
            running: None,
        })
    }

    fn running(&self) -> &S {
        &self.running.as_ref().expect("started").1
    }
}

impl<S, F> Stepper for Adaptive<'_, S, F>
where
    S: OrdinaryNumericalMethod<f64, State> + Interpolation<f64, State>,
    F: Fn(f64) -> S,
{
    fn start(&mut self, leg: &Leg, time: f64, state: &State, end: f64, step: Option<f64>) {
        let mut method = (self.make)(step.map_or(0.0, |step| step.min(end - time)));
        let equations = Equations {
            model: self.model,
            leg: *leg,
        };
        begin(&mut method, &equations, time, end, state);
        self.running = Some((equations, method));
    }

    fn step(&mut self, stop: f64) {
        let (equations, method) = self.running.as_mut().expect("started");
        let mut rejections = 0;
        loop {
            let left = stop - method.t();
            // A step that would leave a hair's breadth takes it along.
            if method.h() >= left * (1.0 - 1e-9) {
                method.set_h(left);
            }
            if rejections > MOST_REJECTIONS {
                let (time, state, step) = (method.t(), *method.y(), method.h());
                *method = (self.make)(step);
                begin(method, equations, time, stop, &state);
                rejections = 0;
            }
            method.step(equations).expect("the model is tame");
            if !matches!(method.status(), Status::RejectedStep) {
                return;
            }
            rejections += 1;
        }
    }

    fn now(&self) -> (f64, State) {
        let method = self.running();
        (method.t(), *method.y())
    }

    fn next_step(&self) -> f64 {
        self.running().h()
    }

    fn at(&mut self, time: f64) -> State {
        let (_, method) = self.running.as_mut().expect("started");
        let within = time.clamp(method.t_prev(), method.t());
        method.interpolate(within).expect("within the last step")
    }
}

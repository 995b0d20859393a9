//! One step of the device, as the loops take it.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion};
use idc_cell::device::{DeviceState, PistonMotion};

use super::case::{Case, STEP};
use super::table::WINDOW;

/// A step of 1 ms: with the piston, with and without its ledger, and with a piston that a rigid-body engine moves, as in the cell.
pub fn steps(criterion: &mut Criterion, case: &Case) {
    let moving = Moving::of(case);
    let mut group = criterion.benchmark_group("device step of 1 ms");
    for (name, kind) in [
        ("with its piston, ledger", Kind::Carried { audited: true }),
        ("with its piston", Kind::Carried { audited: false }),
        ("piston predicted", Kind::Predicted),
    ] {
        for substeps in [1, 2, 4] {
            group.bench_function(BenchmarkId::new(name, substeps), |bencher| {
                bencher.iter_custom(|steps| moving.run(kind, substeps, steps));
            });
        }
    }
    group.finish();
}

/// Ways of taking a step.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    /// The device moves its piston.
    Carried {
        /// Whether the energy ledger is kept.
        audited: bool,
    },
    /// Somebody else does.
    Predicted,
}

/// The part of a case in which something happens.
pub struct Moving<'a> {
    case: &'a Case,
    start: (DeviceState, PistonMotion),
    /// Motion at the start of each step.
    motion: Vec<PistonMotion>,
    first_step: usize,
}

impl<'a> Moving<'a> {
    /// That of a case.
    pub fn of(case: &'a Case) -> Self {
        let mut motion = case.model.motion(&case.start);
        let mut state = case.device.at_rest(motion.stroke, 0.0);
        let (first_step, last_step) = ((WINDOW.0 / STEP) as usize, (WINDOW.1 / STEP) as usize);
        let step = |step: usize, state: &mut DeviceState, motion: &mut PistonMotion| {
            case.step_device(state, motion, step as f64 * STEP, 2, true);
        };
        for i in 0..first_step {
            step(i, &mut state, &mut motion);
        }
        let start = (state.clone(), motion);
        let mut motions = Vec::new();
        for i in first_step..last_step {
            motions.push(motion);
            step(i, &mut state, &mut motion);
        }
        Self {
            case,
            start,
            motion: motions,
            first_step,
        }
    }

    /// Time that some steps take, the part over and over again.
    pub fn run(&self, kind: Kind, substeps: usize, steps: u64) -> Duration {
        let clock = Instant::now();
        let (mut state, mut motion) = self.start.clone();
        for step in 0..steps as usize {
            let step = step % self.motion.len();
            if step == 0 {
                (state, motion) = self.start.clone();
            }
            let time = (self.first_step + step) as f64 * STEP;
            match kind {
                Kind::Carried { audited } => {
                    self.case
                        .step_device(&mut state, &mut motion, time, substeps, audited);
                }
                Kind::Predicted => {
                    let set_pressure = self.case.set_pressure(time);
                    let predicted = self.motion[step];
                    let device = &self.case.device;
                    black_box(device.advance(&mut state, set_pressure, predicted, STEP, substeps));
                }
            }
        }
        black_box((&state, &motion));
        clock.elapsed()
    }
}

//! A cell or a bench step by step, under set pressures that Python gives.

use std::sync::{Mutex, PoisonError};

use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use self_cell::self_cell;

use super::call::detached;
use super::error::{plain, raised};
use super::run::Run;
use super::scenario::{Scenario, SetKey, edited};
use crate::app::{EditedScenario, FinishedRun};
use crate::cell::Cell;
use crate::control::observed::{OBSERVED, Observed};
use crate::device::DeviceParameters;
use crate::rig::{Rig, RigError, RigSimulation};
use crate::run::{Finished, Job, finish_bench, finish_cell};
use crate::simulation::{CellRun, Simulation, SimulationError};
use crate::unit::{SiUnit, column_name};

type RunningRig<'a> = Option<(RigSimulation<'a>, Option<RigError>)>;
type RunningArm<'a> = Option<(Simulation<'a>, Option<SimulationError>)>;

self_cell!(
    /// A bench and its simulation, none once it was taken.
    struct BenchSteps {
        owner: Box<Rig>,
        #[not_covariant]
        dependent: RunningRig,
    }
);

self_cell!(
    /// A cell and its simulation, none once it was taken.
    struct CellSteps {
        owner: Box<Cell>,
        #[not_covariant]
        dependent: RunningArm,
    }
);

enum Running {
    Bench(BenchSteps),
    Cell(CellSteps),
}

impl Running {
    fn bench(rig: Box<Rig>) -> Self {
        Self::Bench(BenchSteps::new(rig, |rig| {
            Some((RigSimulation::new(rig), None))
        }))
    }

    fn cell(cell: Box<Cell>) -> Self {
        Self::Cell(CellSteps::new(cell, |cell| {
            Some((Simulation::new(cell), None))
        }))
    }

    /// From the start again, the noise of its sensors by another seed.
    fn begun_again(self, seed: Option<u64>) -> Self {
        match self {
            Self::Bench(steps) => {
                let mut rig = steps.into_owner();
                if let Some(seed) = seed {
                    rig.scenario.seed = seed;
                }
                Self::bench(rig)
            }
            Self::Cell(steps) => {
                let mut cell = steps.into_owner();
                if let Some(seed) = seed {
                    cell.setup.scenario.simulation.seed = seed;
                }
                Self::cell(cell)
            }
        }
    }

    fn step(&mut self, set_pressure: f64) {
        match self {
            Self::Bench(steps) => steps.with_dependent_mut(|_, running| {
                if let Some((simulation, stop)) = running {
                    *stop = simulation.step_at(set_pressure).err();
                }
            }),
            Self::Cell(steps) => steps.with_dependent_mut(|_, running| {
                if let Some((simulation, stop)) = running {
                    *stop = simulation.step_at(set_pressure).err();
                }
            }),
        }
    }

    fn observed(&self) -> Option<Observed> {
        match self {
            Self::Bench(steps) => {
                steps.with_dependent(|_, running| Some(running.as_ref()?.0.observed()))
            }
            Self::Cell(steps) => {
                steps.with_dependent(|_, running| Some(running.as_ref()?.0.observed()))
            }
        }
    }

    /// Whether the job is done, or was stopped.
    fn done(&self) -> bool {
        match self {
            Self::Bench(steps) => steps.with_dependent(|_, running| {
                let running = running.as_ref();
                running.is_none_or(|(simulation, stop)| stop.is_some() || simulation.done())
            }),
            Self::Cell(steps) => steps.with_dependent(|_, running| {
                let running = running.as_ref();
                running.is_none_or(|(simulation, stop)| stop.is_some() || simulation.done())
            }),
        }
    }

    fn stop(&self) -> Option<String> {
        match self {
            Self::Bench(steps) => {
                steps.with_dependent(|_, running| Some(running.as_ref()?.1.as_ref()?.to_string()))
            }
            Self::Cell(steps) => {
                steps.with_dependent(|_, running| Some(running.as_ref()?.1.as_ref()?.to_string()))
            }
        }
    }

    /// Steps done and in all.
    fn steps(&self) -> (usize, usize) {
        match self {
            Self::Bench(steps) => steps.with_dependent(|_, running| match running {
                Some((simulation, _)) => (simulation.steps(), simulation.total_steps()),
                None => (0, 0),
            }),
            Self::Cell(steps) => steps.with_dependent(|_, running| match running {
                Some((simulation, _)) => (simulation.steps(), simulation.total_steps()),
                None => (0, 0),
            }),
        }
    }

    /// Length of a step [s].
    fn step_length(&self) -> f64 {
        match self {
            Self::Bench(steps) => steps.borrow_owner().scenario.step,
            Self::Cell(steps) => steps.borrow_owner().setup.scenario.simulation.step,
        }
    }

    fn device(&self) -> &DeviceParameters {
        match self {
            Self::Bench(steps) => &steps.borrow_owner().scenario.nominal.device,
            Self::Cell(steps) => &steps.borrow_owner().setup.scenario.nominal.device,
        }
    }
}

/// What numbers of an observation are written where, and how.
struct Watched {
    buffer: PyBuffer<f32>,
    /// Of each: its place among all, its factor, and the least and the greatest that is written.
    numbers: Vec<(usize, f64, [f64; 2])>,
}

impl Watched {
    fn write(&self, py: Python<'_>, seen: &Observed) {
        let Some(slots) = self.buffer.as_mut_slice(py) else {
            return;
        };
        for (slot, (place, factor, [least, most])) in slots.iter().zip(&self.numbers) {
            // What there is not is written as the least.
            slot.set((factor * seen[*place]).max(*least).min(*most) as f32);
        }
    }
}

/// A cell or a bench that is stepped.
#[pyclass(module = "idc._idc", frozen)]
pub(super) struct Steps {
    scenario: EditedScenario,
    is_bench: bool,
    step_length: f64,
    full_stroke: f64,
    supply: f64,
    inner: Mutex<Inner>,
}

struct Inner {
    running: Option<Running>,
    watched: Option<Watched>,
}

impl Steps {
    fn inner(&self) -> std::sync::MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Inner {
    fn running(&mut self) -> PyResult<&mut Running> {
        let taken = || plain("its run was taken by finish(): reset() begins it anew");
        self.running.as_mut().ok_or_else(taken)
    }

    fn advance(&mut self, set_pressure: f64, count: usize) -> PyResult<Observed> {
        if !set_pressure.is_finite() {
            let message =
                format!("the set pressure is {set_pressure} Pa, expected a finite number, gauge");
            return Err(plain(message));
        }
        let running = self.running()?;
        if running.done() {
            return Err(plain("the job is done: reset() begins it anew"));
        }
        for _ in 0..count {
            running.step(set_pressure);
            if running.done() {
                break;
            }
        }
        let seen = running.observed();
        seen.ok_or_else(|| plain("its run was taken by finish(): reset() begins it anew"))
    }
}

#[pymethods]
impl Steps {
    /// Checks and plans it.
    #[new]
    fn new(
        py: Python<'_>,
        scenario: &Scenario,
        set: Vec<SetKey>,
        effects: Vec<String>,
    ) -> PyResult<Self> {
        let made = detached(py, None, |_| {
            let scenario = edited(scenario, set, &effects)?;
            let running = match scenario.job()? {
                Job::Bench(rig) => Running::bench(rig),
                Job::Cell(cell) => Running::cell(cell),
            };
            Ok((scenario, running))
        });
        let (scenario, running) = made?;
        let device = running.device();
        Ok(Self {
            scenario,
            is_bench: matches!(running, Running::Bench(_)),
            step_length: running.step_length(),
            full_stroke: device.full_stroke,
            supply: device.regulator.supply,
            inner: Mutex::new(Inner {
                running: Some(running),
                watched: None,
            }),
        })
    }

    /// Whether it is a bench.
    #[getter]
    fn is_bench(&self) -> bool {
        self.is_bench
    }

    /// Length of a step [s].
    #[getter]
    fn step_s(&self) -> f64 {
        self.step_length
    }

    /// Stroke of the device [m].
    #[getter]
    fn full_stroke_m(&self) -> f64 {
        self.full_stroke
    }

    /// Supply pressure [Pa gauge].
    #[getter]
    fn supply_pa_gauge(&self) -> f64 {
        self.supply
    }

    /// Steps done and in all.
    #[getter]
    fn steps(&self) -> (usize, usize) {
        self.inner().running.as_ref().map_or((0, 0), Running::steps)
    }

    /// Whether the job is done, or was stopped.
    #[getter]
    fn done(&self) -> bool {
        self.inner().running.as_ref().is_none_or(Running::done)
    }

    /// Reason for an early stop.
    #[getter]
    fn stopped(&self) -> Option<String> {
        self.inner().running.as_ref().and_then(Running::stop)
    }

    /// From the start again.
    #[pyo3(signature = (seed=None))]
    fn reset(&self, py: Python<'_>, seed: Option<u64>) -> PyResult<Observation> {
        let mut inner = self.inner();
        let running = match inner.running.take() {
            Some(running) => running.begun_again(seed),
            None => {
                let job = self.scenario.job().map_err(|error| raised(&error))?;
                let fresh = match job {
                    Job::Bench(rig) => Running::bench(rig),
                    Job::Cell(cell) => Running::cell(cell),
                };
                match seed {
                    Some(_) => fresh.begun_again(seed),
                    None => fresh,
                }
            }
        };
        let seen = running.observed().unwrap_or([f64::NAN; OBSERVED.len()]);
        inner.running = Some(running);
        if let Some(watched) = &inner.watched {
            watched.write(py, &seen);
        }
        Ok(Observation(seen))
    }

    /// So many steps under a set pressure [Pa gauge].
    fn step(&self, set_pressure: f64, count: usize) -> PyResult<Observation> {
        self.inner().advance(set_pressure, count).map(Observation)
    }

    /// What is seen now.
    fn observe(&self) -> PyResult<Observation> {
        let mut inner = self.inner();
        let seen = inner.running()?.observed();
        Ok(Observation(seen.unwrap_or([f64::NAN; OBSERVED.len()])))
    }

    /// Has numbers of each further observation written to an array of 32-bit numbers: of each its place, factor, least and greatest.
    fn watch(&self, buffer: PyBuffer<f32>, numbers: Vec<(usize, f64, f64, f64)>) -> PyResult<()> {
        if buffer.item_count() != numbers.len() || buffer.readonly() || !buffer.is_c_contiguous() {
            return Err(plain("expected a writable array of as many 32-bit numbers"));
        }
        if numbers.iter().any(|number| number.0 >= OBSERVED.len()) {
            return Err(plain("there is no such number in an observation"));
        }
        self.inner().watched = Some(Watched {
            buffer,
            numbers: (numbers.into_iter())
                .map(|(place, factor, least, most)| (place, factor, [least, most]))
                .collect(),
        });
        Ok(())
    }

    /// As `step`, the observation written to the array of `watch`: contact force and desired force [N], phase, whether the job is done.
    fn step_watched(
        &self,
        py: Python<'_>,
        set_pressure: f64,
        count: usize,
    ) -> PyResult<(f64, f64, f64, bool)> {
        let mut inner = self.inner();
        let seen = inner.advance(set_pressure, count)?;
        if let Some(watched) = &inner.watched {
            watched.write(py, &seen);
        }
        let [_, desired, _, contact, .., phase] = seen;
        let done = inner.running()?.done();
        Ok((contact, desired, phase, done))
    }

    /// What was done so far as a run, with its numbers; it is begun anew by `reset`.
    fn finish(&self, py: Python<'_>) -> PyResult<Run> {
        let mut inner = self.inner();
        inner.running()?;
        let Some(running) = inner.running.take() else {
            return Err(plain(
                "its run was taken by finish(): reset() begins it anew",
            ));
        };
        let scenario = self.scenario.clone();
        detached(py, None, move |_| {
            let (job, finished) = match running {
                Running::Bench(mut steps) => {
                    let made = steps.with_dependent_mut(|rig, running| {
                        running.take().map(|(simulation, stop)| {
                            finish_bench(rig, simulation.into_recording()?, stop)
                        })
                    });
                    let finished = made.transpose()?.map(|run| Finished::Bench(Box::new(run)));
                    (Job::Bench(steps.into_owner()), finished)
                }
                Running::Cell(mut steps) => {
                    let made = steps.with_dependent_mut(|cell, running| {
                        running.take().map(|(simulation, stop)| {
                            finish_cell(cell, CellRun::of(simulation, stop)?)
                        })
                    });
                    let finished = made.transpose()?.map(|run| Finished::Cell(Box::new(run)));
                    (Job::Cell(steps.into_owner()), finished)
                }
            };
            Ok(finished.map(|finished| FinishedRun::of_steps(scenario, job, finished)))
        })?
        .map(Run)
        .ok_or_else(|| plain("nothing was stepped"))
    }
}

/// What is seen after a step.
#[pyclass(module = "idc._idc", frozen)]
pub(super) struct Observation(Observed);

/// Names of its numbers, units included.
fn names() -> impl Iterator<Item = String> {
    OBSERVED.iter().map(|sight| match sight.unit {
        SiUnit::One => sight.quantity.to_owned(),
        unit => column_name(sight.quantity, unit),
    })
}

/// A getter for each number, in the order of `OBSERVED`.
macro_rules! getters {
    ($($place:literal $name:ident;)*) => {
        #[pymethods]
        impl Observation {
            $(#[getter]
            fn $name(&self) -> f64 {
                self.0[$place]
            })*

            /// Names of all, units included.
            #[classattr]
            fn names() -> Vec<String> {
                names().collect()
            }

            /// Meaning of each.
            #[classattr]
            fn meanings() -> Vec<&'static str> {
                OBSERVED.iter().map(|sight| sight.meaning).collect()
            }

            /// All of them.
            fn values(&self) -> Vec<f64> {
                self.0.to_vec()
            }
        }
    };
}

getters! {
    0 time_s;
    1 desired_force_n;
    2 desired_axial_force_n;
    3 contact_force_n;
    4 measured_force_n;
    5 stroke_m;
    6 stroke_velocity_m_per_s;
    7 measured_stroke_m;
    8 set_pressure_gauge_pa;
    9 regulator_pressure_gauge_pa;
    10 measured_regulator_pressure_gauge_pa;
    11 chamber_1_pressure_pa;
    12 chamber_2_pressure_pa;
    13 gravity_along_extension_m_per_s2;
    14 phase;
}

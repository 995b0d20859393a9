//! A bench scenario with its golden file, as device, as plain equations, and as a measure of error.

use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

use idc_cell::device::{Device, DeviceState, PistonMotion};
use idc_cell::physics::push_only::PushOnly;
use idc_cell::physics::valve::ValvePosition;
use idc_cell::plant::{Actual, ContactLaw, PlantParameters};
use idc_cell::rig::load_at;
use idc_cell::scenario::bench::{BenchScenario, CommandScenario, LoadScenario};
use idc_cell::scenario::load_bench;

use super::adaptive;
use super::legs::{Run, Stops, Timetable};
use super::model::{Model, State};

/// Step of the loop [s].
pub const STEP: f64 = 1e-3;
/// Full scale of pressure [Pa], stroke [m] and force [N].
const FULL_SCALE: [f64; 3] = [6e5, 0.05, 490.332_5];

/// Quantities compared: both chamber pressures [Pa], stroke [m], contact force and the gas's force [N].
type Signals = [f64; 5];

/// A case.
pub struct Case {
    /// Its name.
    pub name: &'static str,
    /// The scenario.
    pub scenario: BenchScenario,
    /// The same physics, as it is.
    actual: Box<Actual<PlantParameters>>,
    /// Its device.
    pub device: Device,
    /// The same as plain equations.
    pub model: Model,
    /// Commands.
    pub timetable: Timetable,
    /// Where it starts.
    pub start: State,
    /// Times of the golden file [s].
    pub times: Vec<f64>,
    golden: Vec<Signals>,
}

/// A path within the project.
pub fn project(path: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

impl Case {
    /// Reads scenario and golden file.
    pub fn read(name: &'static str, scenario: &str) -> Result<Self, Box<dyn Error>> {
        let scenario = load_bench(&project(scenario))?;
        let (times, golden) = golden(&project(&golden_file(name)))?;
        let mut case = Self::of(name, scenario)?;
        (case.times, case.golden) = (times, golden);
        Ok(case)
    }

    /// A scenario with dead volumes of 0.3 cm3 and orifices of 5 mm2, whose air settles within microseconds; no golden file, so the crate's
    /// DOP853 stands for one.
    pub fn stiff(scenario: &str) -> Result<Self, Box<dyn Error>> {
        let mut scenario = load_bench(&project(scenario))?;
        let parameters = &mut scenario.nominal.device;
        parameters.dead_volume = 3e-7;
        parameters.supply_orifice = 5e-6;
        parameters.exhaust_orifice = 5e-6;
        let mut case = Self::of("small chambers", scenario)?;
        let samples = case.milliseconds();
        let run = Run {
            model: &case.model,
            timetable: &case.timetable,
            start: case.start,
            stops: Stops::Free,
            samples: &samples,
        };
        let (mut times, mut golden) = (Vec::new(), Vec::new());
        run.go(
            &mut *adaptive::dop853(&case.model, 1e-11),
            &mut |time, state| {
                times.push(time);
                golden.push(case.signals(state));
            },
        );
        (case.times, case.golden) = (times, golden);
        Ok(case)
    }

    fn of(name: &'static str, scenario: BenchScenario) -> Result<Self, Box<dyn Error>> {
        let parameters = &scenario.nominal.device;
        let load = match scenario.load {
            LoadScenario::Free => None,
            LoadScenario::Contact { position, .. } => {
                let ContactLaw::Linear { stiffness } = scenario.nominal.contact.law else {
                    return Err(format!("{name} must press on a spring").into());
                };
                let damping = scenario.nominal.contact.damping;
                Some((position, PushOnly { stiffness, damping }))
            }
        };
        let device = Device::new(parameters.clone());
        let model = Model::new(parameters, scenario.nominal.gravity_along_extension, load);
        let regulator = &parameters.regulator;
        let CommandScenario::SetPressure(commands) = &scenario.command else {
            return Err(format!("{name} must command pressures").into());
        };
        let outlet = |set: f64| (regulator.gain * set).clamp(0.0, regulator.supply);
        let arrivals = commands
            .iter()
            .map(|(at, set)| (at + regulator.dead_time, outlet(*set)))
            .collect();
        let timetable = Timetable {
            arrivals,
            valve: scenario.valve.clone(),
            end: scenario.duration,
        };
        let weight = parameters.moving_mass * scenario.nominal.gravity_along_extension;
        let motion = PistonMotion {
            stroke: weight.min(0.0) / parameters.end_stop.stiffness,
            speed: 0.0,
        };
        let masses = device.at_rest(motion.stroke, 0.0).air.masses;
        Ok(Self {
            name,
            start: model.state(&device, masses, motion),
            device,
            model,
            timetable,
            actual: Box::new(scenario.nominal.with(|_| ())),
            scenario,
            times: Vec::new(),
            golden: Vec::new(),
        })
    }

    /// The ends of all steps of the loop [s].
    pub fn milliseconds(&self) -> Vec<f64> {
        (0..=self.steps()).map(|i| i as f64 * STEP).collect()
    }

    /// Steps of the loop in the whole run.
    pub fn steps(&self) -> usize {
        (self.scenario.duration / STEP).round() as usize
    }

    /// The loop's own integrator, as the bench rig drives it; `audited` keeps the energy ledger.
    pub fn run_device(&self, substeps: usize, audited: bool, seen: &mut dyn FnMut(f64, &State)) {
        let motion = self.model.motion(&self.start);
        let mut device = self.device.at_rest(motion.stroke, 0.0);
        let mut motion = motion;
        seen(0.0, &self.start);
        for step in 0..self.steps() {
            let time = step as f64 * STEP;
            self.step_device(&mut device, &mut motion, time, substeps, audited);
            let state = self.model.state(&self.device, device.air.masses, motion);
            seen(time + STEP, &state);
        }
    }

    /// One step of it.
    pub fn step_device(
        &self,
        state: &mut DeviceState,
        motion: &mut PistonMotion,
        time: f64,
        substeps: usize,
        audited: bool,
    ) {
        let set_pressure = self.set_pressure(time);
        let valve = self
            .scenario
            .valve
            .iter()
            .rev()
            .find(|v| v.0 <= time + 1e-9);
        state.valve = valve.map_or(ValvePosition::Extend, |v| v.1);
        let load = load_at(&self.scenario, &self.actual, time);
        let device = &self.device;
        if audited {
            device.advance_loaded::<_, true>(state, motion, set_pressure, &load, STEP, substeps);
        } else {
            device.advance_loaded::<_, false>(state, motion, set_pressure, &load, STEP, substeps);
        }
    }

    /// Set pressure at a time [s], gauge [Pa].
    pub fn set_pressure(&self, time: f64) -> f64 {
        let steps = self.scenario.command.steps();
        steps
            .iter()
            .rev()
            .find(|command| command.0 <= time + 1e-9)
            .map_or(0.0, |command| command.1)
    }

    fn signals(&self, state: &State) -> Signals {
        let [first, second] = self.model.pressures(state);
        let parameters = self.device.parameters();
        let atmosphere = parameters.gas.atmosphere;
        [
            first,
            second,
            self.model.motion(state).stroke,
            self.model.load_force(state),
            parameters.areas().gas_force(first, second, atmosphere),
        ]
    }

    /// Largest error of any signal over its full scale [1], over all samples that the golden file also has; infinite if there are none.
    pub fn error(&self, samples: &[(f64, State)]) -> f64 {
        let mut largest = 0.0f64;
        let mut rows = self.times.iter().zip(&self.golden).peekable();
        let mut compared = 0;
        for (time, state) in samples {
            while rows.next_if(|row| *row.0 < time - 1e-9).is_some() {}
            let Some((_, golden)) = rows.next_if(|row| (row.0 - time).abs() <= 1e-9) else {
                continue;
            };
            compared += 1;
            let signals = self.signals(state);
            for (i, full_scale) in [0, 0, 1, 2, 2].into_iter().enumerate() {
                let error = (signals[i] - golden[i]).abs() / FULL_SCALE[full_scale];
                // A solver that has lost its way must not look right.
                largest = if error.is_nan() {
                    f64::INFINITY
                } else {
                    largest.max(error)
                };
            }
        }
        if compared > 100 {
            largest
        } else {
            f64::INFINITY
        }
    }
}

/// Golden file of a case, within the project.
pub fn golden_file(name: &str) -> String {
    format!("tests/reference/bench/{name}.csv")
}

fn golden(path: &Path) -> Result<(Vec<f64>, Vec<Signals>), Box<dyn Error>> {
    let text =
        std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut rows = text.lines().filter(|line| !line.starts_with('#'));
    let names = rows.next().ok_or("no header")?.split(',');
    let columns: BTreeMap<&str, usize> = names.enumerate().map(|(i, name)| (name, i)).collect();
    let column = |name: &str| {
        columns
            .get(name)
            .copied()
            .ok_or(format!("no column {name}"))
    };
    let time = column("time_s")?;
    let signals = [
        column("chamber_1_pressure_pa")?,
        column("chamber_2_pressure_pa")?,
        column("stroke_m")?,
        column("contact_force_n")?,
        column("gas_force_n")?,
    ];
    let (mut times, mut values) = (Vec::new(), Vec::new());
    for row in rows {
        let numbers = row
            .split(',')
            .map(str::parse)
            .collect::<Result<Vec<f64>, _>>()?;
        times.push(numbers[time]);
        values.push(signals.map(|i| numbers[i]));
    }
    Ok((times, values))
}

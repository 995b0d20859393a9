//! An instance of a unit: what the importer has said, and the rig as it has come.
//!
//! A communication step is cut into steps of the bench: as many whole ones as it is long where it is a multiple of them, else into equal parts that are
//! shorter. Set pressure and valve are held over it; the surface goes on as its position, speed and acceleration at the step's start say, the outside force as its
//! value and rate do.

use std::sync::Arc;

use super::error::FmuError;
use super::model::Model;
use super::variables::{Causality, Input, Kind, Output, Role, Variable};
use crate::effects::actual;
use crate::physics::valve::ValvePosition;
use crate::plant::{Actual, Cubic, Nominal, PistonLoad, PlantParameters, Quantity, registry};
use crate::rig::{PausedRig, RunningRig, load_under};

/// Longest communication step [s].
const LONGEST: f64 = 3600.0;
/// Share of a bench's step by which a communication step may be off a multiple of it [1].
const HAIR: f64 = 1e-9;

/// What an importer has said last.
#[derive(Debug, Clone, Copy)]
struct Inputs {
    set_pressure: f64,
    extends: bool,
    /// Position, speed, acceleration of the surface; [m], [m/s], [m/s2].
    surface: Option<[f64; 3]>,
    /// Outside force and its rate; [N], [N/s].
    outside: [f64; 2],
}

/// A rig that has started.
#[derive(Debug, Clone)]
struct Running {
    rig: PausedRig,
    /// Time from which steps of one length are counted [s].
    epoch: f64,
    /// Their number since then.
    steps: u64,
    /// Their length [s].
    length: f64,
    /// Time since the inputs were true [s].
    elapsed: f64,
}

impl Running {
    fn time(&self) -> f64 {
        self.epoch + self.steps as f64 * self.length
    }
}

/// All of an instance that changes: its state as an importer saves and restores it.
#[derive(Debug, Clone)]
pub struct Snapshot {
    plant: Nominal<PlantParameters>,
    actual: Actual<PlantParameters>,
    start_stroke: f64,
    start_time: f64,
    inputs: Inputs,
    running: Option<Running>,
    /// Outputs as they are, if they have been asked for.
    outputs: Option<[f64; Output::COUNT]>,
}

/// An instance.
#[derive(Debug, Clone)]
pub struct Instance {
    model: Arc<Model>,
    now: Snapshot,
}

impl Inputs {
    /// Load on the piston from a time on [s], which is `elapsed` [s] after the inputs were true.
    fn load<'a>(
        &self,
        actual: &'a Actual<PlantParameters>,
        time: f64,
        elapsed: f64,
    ) -> PistonLoad<'a> {
        let surface = self.surface.map(|[position, speed, acceleration]| {
            let bend = 0.5 * acceleration;
            Cubic([
                position + elapsed * (speed + elapsed * bend),
                speed + elapsed * acceleration,
                bend,
                0.0,
            ])
        });
        let [force, rate] = self.outside;
        let outside = Cubic([force + elapsed * rate, rate, 0.0, 0.0]);
        load_under(actual, time, surface, outside)
    }

    fn valve(&self) -> ValvePosition {
        match self.extends {
            true => ValvePosition::Extend,
            false => ValvePosition::Retract,
        }
    }

    /// The value of one; a Boolean's is 0 or 1.
    fn of(&self, input: Input) -> f64 {
        let surface = self.surface.unwrap_or_default();
        match input {
            Input::SetPressure => self.set_pressure,
            Input::Valve => f64::from(u8::from(self.extends)),
            Input::SurfacePosition => surface[0],
            Input::SurfaceSpeed => surface[1],
            Input::SurfaceAcceleration => surface[2],
            Input::OutsideForce => self.outside[0],
            Input::OutsideForceRate => self.outside[1],
        }
    }

    fn set(&mut self, input: Input, value: f64) {
        let mut surface = |place: usize| {
            if let Some(surface) = &mut self.surface {
                surface[place] = value;
            }
        };
        match input {
            Input::SetPressure => self.set_pressure = value,
            Input::Valve => self.extends = value != 0.0,
            Input::SurfacePosition => surface(0),
            Input::SurfaceSpeed => surface(1),
            Input::SurfaceAcceleration => surface(2),
            Input::OutsideForce => self.outside[0] = value,
            Input::OutsideForceRate => self.outside[1] = value,
        }
    }
}

impl Instance {
    /// Before its initialization.
    #[must_use]
    pub fn new(model: Arc<Model>) -> Self {
        let plant = model.plant.clone();
        let now = Snapshot {
            actual: actual(&plant, &[]),
            plant,
            start_stroke: model.starts.stroke,
            start_time: 0.0,
            inputs: Inputs {
                set_pressure: 0.0,
                extends: model.starts.extends,
                surface: model.starts.surface.map(|position| [position, 0.0, 0.0]),
                outside: [0.0; 2],
            },
            running: None,
            outputs: None,
        };
        Self { model, now }
    }

    /// Its model.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// As it was before its initialization, with the numbers of its files.
    pub fn reset(&mut self) {
        *self = Self::new(Arc::clone(&self.model));
    }

    /// Time [s].
    #[must_use]
    pub fn time(&self) -> f64 {
        let running = self.now.running.as_ref();
        running.map_or(self.now.start_time, Running::time)
    }

    /// Its state, to be restored.
    #[must_use]
    pub fn save(&self) -> Snapshot {
        self.now.clone()
    }

    /// Goes back to a state.
    pub fn restore(&mut self, state: &Snapshot) {
        self.now.clone_from(state);
    }

    /// Says at which time it is to start [s].
    ///
    /// # Errors
    /// A time that is not finite, or a unit that runs already.
    pub fn start_at(&mut self, time: f64) -> Result<(), FmuError> {
        if self.now.running.is_some() || !time.is_finite() {
            let what = format!(
                "the start time is {time} s, expected a finite one, once before the first step"
            );
            return Err(FmuError::Argument { what });
        }
        self.now.start_time = time;
        Ok(())
    }

    /// Ends the initialization: the rig at rest, and its sensors read for the first time.
    pub fn initialize(&mut self) {
        self.now.running = Some(self.begun());
        self.now.outputs = None;
    }

    /// The rig at rest.
    fn begun(&self) -> Running {
        let Snapshot {
            actual,
            inputs,
            start_stroke,
            start_time,
            ..
        } = &self.now;
        let scenario = &self.model.scenario;
        let mut rig = RunningRig::new(actual, *start_stroke, (&scenario.sensing, scenario.seed));
        rig.switch(inputs.valve());
        rig.read(*start_time, inputs.load(actual, *start_time, 0.0));
        Running {
            rig: rig.pause(),
            epoch: *start_time,
            steps: 0,
            length: scenario.step,
            elapsed: 0.0,
        }
    }

    fn variable(&self, reference: u32, kind: &'static str) -> Result<&Variable, FmuError> {
        let own = |variable: &&Variable| {
            let boolean = variable.kind == Kind::Boolean;
            boolean == (kind == BOOLEAN)
        };
        let found = self.model.variable(reference).filter(own);
        found.ok_or(FmuError::NoVariable { reference, kind })
    }

    /// Value of a variable; a Boolean's is 0 or 1.
    fn value(&mut self, reference: u32, kind: &'static str) -> Result<f64, FmuError> {
        let role = self.variable(reference, kind)?.role;
        Ok(match role {
            Role::Time => self.time(),
            Role::Input(input) => self.now.inputs.of(input),
            Role::Output(output) => self.outputs()[output as usize],
            Role::Number(quantity) => quantity.get(&self.now.plant),
            Role::StartStroke => self.now.start_stroke,
        })
    }

    /// Value of a number.
    ///
    /// # Errors
    /// There is none at the value reference.
    pub fn real(&mut self, reference: u32) -> Result<f64, FmuError> {
        self.value(reference, REAL)
    }

    /// Value of what is true or false.
    ///
    /// # Errors
    /// There is none at the value reference.
    pub fn boolean(&mut self, reference: u32) -> Result<bool, FmuError> {
        Ok(self.value(reference, BOOLEAN)? != 0.0)
    }

    /// Sets a number.
    ///
    /// # Errors
    /// There is none that can be set now, or it cannot be this; nothing has changed then.
    pub fn set_real(&mut self, reference: u32, value: f64) -> Result<(), FmuError> {
        let variable = self.variable(reference, REAL)?;
        let (role, causality) = (variable.role, variable.causality);
        match causality {
            Causality::Independent | Causality::Output => return Err(not_set(variable, "at all")),
            Causality::Fixed if self.now.running.is_some() => {
                return Err(not_set(variable, "after the initialization"));
            }
            _ => check_range(variable, value)?,
        }
        match role {
            Role::Input(input) => {
                self.now.inputs.set(input, value);
                let held = matches!(input, Input::SetPressure | Input::Valve);
                // What is said of surface and force is true from here on.
                if let Some(running) = self.now.running.as_mut().filter(|_| !held) {
                    running.elapsed = 0.0;
                }
            }
            Role::Number(quantity) => self.set_number(reference, quantity, value)?,
            Role::StartStroke => self.now.start_stroke = value,
            Role::Time | Role::Output(_) => (),
        }
        self.now.outputs = None;
        Ok(())
    }

    /// Sets what is true or false.
    ///
    /// # Errors
    /// There is none at the value reference.
    pub fn set_boolean(&mut self, reference: u32, value: bool) -> Result<(), FmuError> {
        if let Role::Input(input) = self.variable(reference, BOOLEAN)?.role {
            self.now.inputs.set(input, f64::from(u8::from(value)));
            self.now.outputs = None;
        }
        Ok(())
    }

    /// Changes a number of the description.
    fn set_number(
        &mut self,
        reference: u32,
        quantity: Quantity,
        value: f64,
    ) -> Result<(), FmuError> {
        if quantity.get(&self.now.plant) == value {
            return Ok(());
        }
        let mut plant = self.now.plant.clone();
        quantity.set(&mut plant, value);
        let refuse = |expected: String| FmuError::Value {
            name: self.model.variables[reference as usize].name.clone(),
            value,
            expected,
        };
        let count = quantity.is(&registry::CYLINDER_COUNT.quantity());
        if count && value.fract() != 0.0 {
            return Err(refuse("a whole number".to_owned()));
        }
        if plant.device.rod >= plant.device.bore {
            let expected = format!("the rod less than the bore, {} m", plant.device.bore);
            return Err(refuse(expected));
        }
        self.now.actual = actual(&plant, &[]);
        self.now.plant = plant;
        Ok(())
    }

    /// Outputs as they are now: of the inputs as they were set, or as they have gone on since.
    fn outputs(&mut self) -> &[f64; Output::COUNT] {
        if self.now.outputs.is_none() {
            self.now.outputs = Some(self.computed());
        }
        self.now.outputs.get_or_insert([f64::NAN; Output::COUNT])
    }

    fn computed(&self) -> [f64; Output::COUNT] {
        let Snapshot { actual, inputs, .. } = &self.now;
        let running = self.now.running.clone();
        let running = running.unwrap_or_else(|| self.begun());
        let (time, elapsed) = (running.time(), running.elapsed);
        let rig = RunningRig::resumed(actual, running.rig);
        let truth = rig.truth(time, inputs.load(actual, time, elapsed));
        let (readings, pressures, forces) = (rig.readings(), rig.pressures(), rig.device_forces());
        let atmosphere = actual.device.gas.atmosphere;
        let mut values = [f64::NAN; Output::COUNT];
        let mut put = |output: Output, value: f64| values[output as usize] = value;
        put(Output::ContactForce, truth.contact_force);
        put(Output::DeviceForce, forces[0]);
        put(Output::SealForce, forces[1]);
        put(Output::Stroke, truth.motion.stroke);
        put(Output::Speed, truth.motion.speed);
        put(Output::Acceleration, truth.acceleration);
        put(
            Output::RegulatorPressure,
            atmosphere + truth.regulator_pressure,
        );
        put(Output::FirstPressure, pressures[0]);
        put(Output::SecondPressure, pressures[1]);
        put(Output::MeasuredForce, readings.force);
        put(Output::MeasuredForceUnfiltered, readings.force_unfiltered);
        put(Output::MeasuredStroke, readings.stroke);
        put(Output::MeasuredAcceleration, readings.acceleration);
        put(
            Output::MeasuredRegulatorPressure,
            atmosphere + readings.regulator_pressure,
        );
        values
    }

    /// Goes on from a communication point [s] over a communication step [s].
    ///
    /// # Errors
    /// It is not initialized, is at another time, cannot go so far at once, or its numbers are no more those of a device: its state is then the one before.
    pub fn step(&mut self, point: f64, length: f64) -> Result<(), FmuError> {
        let running = self.now.running.as_ref().ok_or(FmuError::NotInitialized)?;
        let whole = self.model.scenario.step;
        let time = running.time();
        // An importer adds its steps up.
        let rounding = 1e3 * f64::EPSILON * time.abs();
        if (point - time).abs() > (1e-3 * whole).max(rounding) || !point.is_finite() {
            return Err(FmuError::Point { point, time });
        }
        if length.is_nan() || length <= 0.0 || length > LONGEST {
            let most = LONGEST;
            return Err(FmuError::Length { length, most });
        }
        let (part, count) = parts(length, whole, rounding);
        let next = self.advanced(running.clone(), part, count)?;
        self.now.running = Some(next);
        self.now.outputs = None;
        Ok(())
    }

    /// The rig after a number of steps of a length [s].
    fn advanced(&self, mut running: Running, part: f64, count: u64) -> Result<Running, FmuError> {
        let Snapshot { actual, inputs, .. } = &self.now;
        let substeps = self.model.scenario.substeps;
        if part != running.length {
            running.epoch = running.time();
            (running.steps, running.length) = (0, part);
        }
        let mut rig = RunningRig::resumed(actual, running.rig);
        rig.switch(inputs.valve());
        for index in 0..count {
            let at = |done: u64| {
                let time = running.epoch + (running.steps + done) as f64 * part;
                (time, inputs.load(actual, time, done as f64 * part))
            };
            rig.step(inputs.set_pressure, at(index).1, (part, substeps));
            let (time, load) = at(index + 1);
            rig.read(time, load);
            rig.check(time)?;
        }
        Ok(Running {
            rig: rig.pause(),
            epoch: running.epoch,
            steps: running.steps + count,
            length: part,
            elapsed: count as f64 * part,
        })
    }
}

const REAL: &str = "Float64 (Real)";
const BOOLEAN: &str = "Boolean";

/// Length [s] and number of the steps that a communication step [s] is cut into, where a bench's own is `whole` [s]; times are as exact as `rounding` [s].
fn parts(length: f64, whole: f64, rounding: f64) -> (f64, u64) {
    let number = length / whole;
    let nearest = number.round();
    if nearest >= 1.0 && (number - nearest).abs() <= HAIR * nearest + rounding / whole {
        return (whole, nearest as u64);
    }
    let count = number.ceil().max(1.0);
    (length / count, count as u64)
}

fn not_set(variable: &Variable, when: &'static str) -> FmuError {
    FmuError::NotSet {
        name: variable.name.clone(),
        when,
    }
}

/// Refuses what is out of a variable's range; the value that it starts with may be.
fn check_range(variable: &Variable, value: f64) -> Result<(), FmuError> {
    let [low, high] = variable.range;
    let limitless = value.is_infinite() && high == f64::INFINITY && low > 0.0;
    if variable.start == Some(value)
        || limitless
        || (value.is_finite() && low <= value && value <= high)
    {
        return Ok(());
    }
    let unit = variable.unit.unwrap_or_default();
    let expected = match (low.is_finite(), high.is_finite()) {
        (true, true) => format!("{low} to {high} {unit}"),
        (true, false) => format!("at least {low} {unit}"),
        (false, _) => "a finite number".to_owned(),
    };
    Err(FmuError::Value {
        name: variable.name.clone(),
        value,
        expected: expected.trim_end().to_owned(),
    })
}

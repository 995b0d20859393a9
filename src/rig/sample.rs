//! Record of a bench rig at each step.

use crate::device::{Device, DeviceParameters, DeviceState, PistonMotion};
use crate::estimation::EstimatorOutput;
use crate::physics::valve::ValvePosition;
use crate::recording::schema;
use crate::recording::{RecordedChannel, Recording, RecordingError};
use crate::sensing::Readings;

/// Channels of a bench recording, in the order of `RigLog::push`.
const CHANNELS: [&str; 25] = [
    schema::SET_PRESSURE,
    schema::REGULATOR_PRESSURE,
    schema::CHAMBER_1_PRESSURE,
    schema::CHAMBER_2_PRESSURE,
    schema::CONTACT_FORCE,
    schema::DESIRED_FORCE,
    schema::DEVICE_FORCE,
    schema::SEAL_FORCE,
    schema::STROKE,
    schema::STROKE_VELOCITY,
    schema::ACCELERATION,
    schema::SURFACE_POSITION,
    schema::VALVE_EXTENDS,
    schema::CHAMBER_1_MASS,
    schema::CHAMBER_2_MASS,
    schema::HOSE_MASS,
    schema::MASS_ENTERED,
    schema::MASS_LEFT,
    schema::MEASURED_FORCE,
    schema::MEASURED_FORCE_UNFILTERED,
    schema::MEASURED_STROKE,
    schema::MEASURED_ACCELERATION,
    schema::MEASURED_REGULATOR_PRESSURE,
    schema::ESTIMATED_FORCE,
    schema::ESTIMATED_FORCE_DEVIATION,
];

/// True state of the rig at a moment, as no sensor shows it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RigTruth {
    /// Time [s].
    pub time: f64,
    /// Stroke and speed.
    pub motion: PistonMotion,
    /// Acceleration along extension [m/s2].
    pub acceleration: f64,
    /// Force of the tool on the load [N].
    pub contact_force: f64,
    /// Regulator's outlet, gauge [Pa].
    pub regulator_pressure: f64,
}

/// Recorded quantities at a moment.
pub(super) struct RigSample<'a> {
    pub device: &'a Device<&'a DeviceParameters>,
    pub state: &'a DeviceState,
    pub truth: &'a RigTruth,
    pub readings: &'a Readings,
    /// Where the load's surface stands [m]; infinite without one.
    pub surface: f64,
    /// Set pressure that the regulator acts on [Pa gauge].
    pub set_pressure: f64,
    /// Contact force asked for [N]; NaN where pressures are.
    pub desired_force: f64,
    /// Contact force as the estimator has it, if there is one.
    pub estimate: Option<EstimatorOutput>,
}

/// Samples by rows, until the run has ended.
pub(super) struct RigLog {
    time: Vec<f64>,
    rows: Vec<[f64; CHANNELS.len()]>,
}

impl RigLog {
    pub(super) fn new(capacity: usize) -> Self {
        Self {
            time: Vec::with_capacity(capacity),
            rows: Vec::with_capacity(capacity),
        }
    }

    pub(super) fn push(&mut self, sample: &RigSample<'_>) {
        let RigSample {
            device,
            state,
            truth,
            readings,
            ..
        } = *sample;
        let atmosphere = device.parameters().gas.atmosphere;
        let pressures = device.pressures(state, truth.motion.stroke);
        let seal = device.seal_force(state, truth.motion.speed);
        self.time.push(truth.time);
        self.rows.push([
            atmosphere + sample.set_pressure,
            atmosphere + truth.regulator_pressure,
            pressures[0],
            pressures[1],
            truth.contact_force,
            sample.desired_force,
            device.gas_force(state, truth.motion.stroke) + seal,
            seal,
            truth.motion.stroke,
            truth.motion.speed,
            truth.acceleration,
            match sample.surface.is_finite() {
                true => sample.surface,
                false => f64::NAN,
            },
            f64::from(u8::from(state.valve == ValvePosition::Extend)),
            state.air.masses[0],
            state.air.masses[1],
            state.air.line_mass(),
            state.air.entered,
            state.air.left,
            readings.force,
            readings.force_unfiltered,
            readings.stroke,
            readings.acceleration,
            atmosphere + readings.regulator_pressure,
            sample.estimate.map_or(f64::NAN, |e| e.force),
            sample.estimate.map_or(f64::NAN, |e| e.normal_deviation()),
        ]);
    }

    /// Number of samples.
    pub(super) fn count(&self) -> usize {
        self.time.len()
    }

    /// The recording, without the channels that never had a value.
    pub(super) fn into_recording(self) -> Result<Recording, RecordingError> {
        let channels = self
            .channels(0)
            .filter(|channel| !channel.values.iter().all(|value| value.is_nan()));
        let channels = channels.collect();
        Recording::new(self.time, channels, Vec::new())
    }

    /// The recording from a sample on, with all channels.
    pub(super) fn since(&self, first: usize) -> Result<Recording, RecordingError> {
        let first = first.min(self.count());
        let time = self.time[first..].to_vec();
        Recording::new(time, self.channels(first).collect(), Vec::new())
    }

    fn channels(&self, first: usize) -> impl Iterator<Item = RecordedChannel> {
        CHANNELS.iter().enumerate().map(move |(index, quantity)| {
            let values: Vec<f64> = self.rows[first..].iter().map(|row| row[index]).collect();
            let unit = schema::definition(quantity)
                .expect("every channel is in the schema")
                .unit;
            RecordedChannel::new(*quantity, unit, values)
        })
    }
}

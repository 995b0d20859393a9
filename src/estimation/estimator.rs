//! The estimator: predicts over a period, takes the samples in, gives the force.

use super::EstimationError;
use super::belief::{
    ACCELERATION, ACCELERATION_BIAS, Belief, DEAD_VOLUME, MASSES, OUTLET, PRESLIDING,
    PRESSURE_BIAS, PRESSURE_SCALE, SPEED, STROKE, TURNING_DEFLECTION, TURNING_STROKE, Term,
};
use super::chambers::Chambers;
use super::models::Models;
use super::output::{EstimatorOutput, ForceOutput, coverage_factor};
use super::parameters::EstimatorParameters;
use super::process::{ProcessNoise, first_belief, predict};
use super::seals::{Seals, Way};
use crate::device::DeviceParameters;
use crate::physics::axial_load::AxialLoad;
use crate::physics::gas_process::GasProcess;
use crate::physics::valve::ValvePosition;

/// Longest sampling period [s].
const LONGEST_PERIOD: f64 = 0.02;
/// Standard deviations of the stroke by which a step back must exceed a turning point to count.
const TURN: f64 = 4.0;
/// Standard deviations of the displacement by which a halted motion must exceed its turning point to have gone on.
const RESUME: f64 = 1.0;
/// Standard deviation of a chamber's pressure about its source before the first sample [Pa].
const START_PRESSURE: f64 = 2e3;

/// Least pressure of a chamber, in atmospheres [1].
const LEAST_PRESSURE: f64 = 0.01;

/// Acceleration that no accelerometer of such a device shows [m/s2].
const LARGEST_ACCELERATION: f64 = 1e4;

const STROKE_TERMS: [Term; 1] = [(STROKE, 1.0)];
const ACCELERATION_TERMS: [Term; 2] = [(ACCELERATION, 1.0), (ACCELERATION_BIAS, 1.0)];

/// One set of samples. What is not finite, or no sensor of the device could mean, counts as missing: a stroke off by more than the full stroke, an
/// acceleration beyond 1e4 m/s2, a pressure below vacuum or beyond twice the supply.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// Stroke [m].
    pub stroke: f64,
    /// Acceleration of extension, relative to the flange [m/s2].
    pub acceleration: f64,
    /// Regulator's outlet, gauge [Pa].
    pub regulator_pressure: f64,
    /// Position of the valve over the period that ends with these samples.
    pub valve: ValvePosition,
}

/// Estimates the contact force, sample by sample.
#[derive(Debug, Clone)]
pub struct ContactForceEstimator {
    /// Variances of the noise on stroke, acceleration and pressure.
    noise: [f64; 3],
    /// Plausible range of each.
    plausible: [std::ops::RangeInclusive<f64>; 3],
    process: Vec<ProcessNoise>,
    chambers: Chambers,
    seals: Seals,
    output: ForceOutput,
    atmosphere: f64,
    supply: f64,
    models: Models,
    started: bool,
}

/// A part of a device that the estimator has no equation for; what the regulator does is measured.
fn not_modelled(device: &DeviceParameters) -> Option<&'static str> {
    let isothermal = device.gas_process == GasProcess::Isothermal;
    let pressed = device.seal_friction.pressure_coefficient != 0.0;
    [
        (
            !isothermal,
            "chambers whose gas warms up (gas_process; \"isothermal\" has none)",
        ),
        (device.hose.is_some(), "a line between regulator and valve"),
        (!device.leakage.is_none(), "leaks"),
        (device.axial_load != AxialLoad::NONE, "an axial load"),
        (!device.end_cushioning.is_none(), "cushions at its ends"),
        (pressed, "seals that the pressure across them presses"),
        (device.switching_delay > 0.0, "a valve that switches late"),
    ]
    .into_iter()
    .find_map(|(has, part)| has.then_some(part))
}

impl ContactForceEstimator {
    /// For a device as its data say, about at a stroke [m], sampled every `period` [s].
    ///
    /// It starts with chambers in equilibrium with what they hang on, and with seals whose deflection is anywhere.
    ///
    /// # Errors
    /// A parameter, the stroke or the period is out of its range.
    pub fn new(
        device: &DeviceParameters,
        parameters: &EstimatorParameters,
        initial_stroke: f64,
        period: f64,
    ) -> Result<Self, EstimationError> {
        parameters.check()?;
        if let Some(part) = not_modelled(device) {
            return Err(EstimationError::NotModelled { part });
        }
        if !(period > 0.0 && period <= LONGEST_PERIOD) {
            return Err(EstimationError::Period {
                period,
                longest: LONGEST_PERIOD,
            });
        }
        if !initial_stroke.is_finite() {
            return Err(EstimationError::NotFinite {
                name: "initial stroke",
                value: initial_stroke,
            });
        }
        let lag = device.regulator.time_constant;
        let noise = &parameters.noise;
        let (stroke, supply) = (device.full_stroke, device.regulator.supply);
        let belief = first_belief(device, parameters, initial_stroke);
        Ok(Self {
            noise: [noise.stroke, noise.acceleration, noise.regulator_pressure].map(|s| s * s),
            plausible: [
                -stroke..=2.0 * stroke,
                -LARGEST_ACCELERATION..=LARGEST_ACCELERATION,
                -device.gas.atmosphere..=2.0 * supply,
            ],
            process: parameters
                .models
                .iter()
                .map(|model| ProcessNoise::new(model, period, lag))
                .collect(),
            chambers: Chambers::new(device, period),
            seals: Seals::new(device.seal_friction),
            output: ForceOutput::new(device, parameters.tolerances, parameters.gravity_along_axis),
            atmosphere: device.gas.atmosphere,
            supply,
            models: Models::new(&parameters.models, &belief, period),
            started: false,
        })
    }

    /// Time between two sets of samples [s].
    pub fn period(&self) -> f64 {
        self.chambers.period()
    }

    /// Tells the component of gravity along extension, less the flange's own acceleration there [m/s2], as it is from now on.
    pub fn set_gravity_along_axis(&mut self, gravity: f64) {
        self.output.gravity_along_axis = gravity;
    }

    /// Probability of each process model, in the order given [1].
    pub fn model_probabilities(&self) -> &[f64] {
        &self.models.probabilities
    }

    /// Takes one set of samples in, a period after the one before.
    pub fn update(&mut self, measurement: &Measurement) -> EstimatorOutput {
        if self.started {
            self.models.mix();
            for (belief, noise) in self.models.beliefs.iter_mut().zip(&self.process) {
                predict(belief, &self.chambers, noise, measurement.valve);
            }
        } else {
            self.fill_chambers(measurement);
            self.started = true;
        }
        let normalized_innovations = self.observe(measurement);
        self.follow_seals();
        self.estimate(normalized_innovations)
    }

    /// Chambers as they are after a long rest: each at the pressure of what it hangs on.
    fn fill_chambers(&mut self, measurement: &Measurement) {
        for belief in &mut self.models.beliefs {
            let stroke = belief.mean[STROKE];
            let outlet = belief.mean[OUTLET];
            for (i, element) in MASSES.into_iter().enumerate() {
                let supplied = Chambers::is_supplied(i, measurement.valve);
                let gauge = if supplied { outlet } else { 0.0 };
                let mass = self.chambers.mass(i, self.atmosphere + gauge, stroke);
                let [by_mass, by_stroke, by_dead_volume] =
                    self.chambers.pressure_slopes(i, mass, stroke);
                belief.mean[element] = mass;
                let follows = if supplied { 1.0 / by_mass } else { 0.0 };
                belief.combine(
                    element,
                    &[
                        (OUTLET, follows),
                        (STROKE, -by_stroke / by_mass),
                        (DEAD_VOLUME, -by_dead_volume / by_mass),
                    ],
                );
                belief.add_noise(element, element, (START_PRESSURE / by_mass).powi(2));
            }
        }
    }

    /// Takes the samples in under every model and weighs the models.
    fn observe(&mut self, measurement: &Measurement) -> [f64; 3] {
        let samples = [
            measurement.stroke,
            measurement.acceleration,
            measurement.regulator_pressure,
        ];
        let mut normalized = [f64::NAN; 3];
        let likeliest = self.models.likeliest();
        let mut likelihoods = vec![0.0; self.models.beliefs.len()];
        for (i, sample) in samples.into_iter().enumerate() {
            // Not a number is in no range either.
            if !self.plausible[i].contains(&sample) {
                continue;
            }
            let noise = self.noise[i];
            let beliefs = self.models.beliefs.iter_mut().zip(&mut likelihoods);
            for (model, (belief, log)) in beliefs.enumerate() {
                let pressure_terms = [
                    (OUTLET, 1.0),
                    (PRESSURE_BIAS, 1.0),
                    (PRESSURE_SCALE, belief.mean[OUTLET]),
                ];
                let terms: [&[Term]; 3] = [&STROKE_TERMS, &ACCELERATION_TERMS, &pressure_terms];
                let innovation = belief.observe(terms[i], sample, noise);
                *log += innovation.log_likelihood();
                if model == likeliest {
                    normalized[i] = innovation.residual / innovation.variance.sqrt();
                }
            }
        }
        self.models.weigh(&likelihoods);
        for belief in &mut self.models.beliefs {
            let mean = &mut belief.mean;
            mean[OUTLET] = mean[OUTLET].clamp(-self.atmosphere, self.supply + self.atmosphere);
            // A sample far off must not leave a chamber without air.
            for (i, element) in MASSES.into_iter().enumerate() {
                let vacuum = LEAST_PRESSURE * self.atmosphere;
                mean[element] = mean[element].max(self.chambers.mass(i, vacuum, mean[STROKE]));
            }
            mean[TURNING_DEFLECTION] = self.seals.limited(mean[TURNING_DEFLECTION]);
        }
        normalized
    }

    /// Carries the seals' turning point along where the stroke has gone on or turned.
    fn follow_seals(&mut self) {
        let displacement = |belief: &Belief| belief.mean[STROKE] - belief.mean[TURNING_STROKE];
        let stroke_variance = |belief: &Belief| belief.covariance[STROKE][STROKE];
        let (moved, turned) = self
            .models
            .overall(|belief| (displacement(belief), stroke_variance(belief)));
        let (_, resumed) = self.models.overall(|belief| {
            let variance = belief.variance(&[(STROKE, 1.0), (TURNING_STROKE, -1.0)]);
            (displacement(belief), variance)
        });
        let way = self
            .seals
            .way(moved, TURN * turned.sqrt(), RESUME * resumed.sqrt());
        match way {
            Way::On => self.carry_turning_point(),
            Way::Undecided => {}
            // When it turned is not known, so where is known no better than the stroke was.
            Way::Halted => {
                for belief in &mut self.models.beliefs {
                    let variance = stroke_variance(belief);
                    belief.add_noise(TURNING_STROKE, TURNING_STROKE, variance);
                }
            }
        }
    }

    /// The turning point becomes where the piston is.
    fn carry_turning_point(&mut self) {
        for belief in &mut self.models.beliefs {
            let mean = &mut belief.mean;
            let displacement = mean[STROKE] - mean[TURNING_STROKE];
            let after = self
                .seals
                .after(mean[TURNING_DEFLECTION], displacement, mean[SPEED]);
            mean[TURNING_DEFLECTION] = after.value;
            mean[TURNING_STROKE] = mean[STROKE];
            belief.combine(
                TURNING_DEFLECTION,
                &[
                    (TURNING_DEFLECTION, after.by_deflection),
                    (STROKE, after.by_displacement),
                    (TURNING_STROKE, -after.by_displacement),
                    (PRESLIDING, after.by_presliding),
                ],
            );
            belief.combine(TURNING_STROKE, &[(STROKE, 1.0)]);
        }
    }

    fn estimate(&self, normalized_innovations: [f64; 3]) -> EstimatorOutput {
        let parts: Vec<_> = self
            .models
            .beliefs
            .iter()
            .map(|belief| self.output.of(belief, &self.chambers, &self.seals))
            .collect();
        let weighted = |of: &dyn Fn(usize) -> f64| -> f64 {
            let weights = self.models.probabilities.iter().enumerate();
            weights.map(|(i, weight)| weight * of(i)).sum()
        };
        let force = weighted(&|i| parts[i].force);
        let variance =
            weighted(&|i| parts[i].variance + (parts[i].force - force) * (parts[i].force - force));
        let element = |index: usize| weighted(&|i| self.models.beliefs[i].mean[index]);
        EstimatorOutput {
            force,
            standard_deviation: variance.sqrt(),
            coverage_factor: coverage_factor(
                weighted(&|i| parts[i].fourth_powers) / (variance * variance),
            ),
            chamber_pressures: [0, 1].map(|c| weighted(&|i| parts[i].pressures[c])),
            gas_force: weighted(&|i| parts[i].gas),
            friction: weighted(&|i| parts[i].friction),
            stroke: element(STROKE),
            speed: element(SPEED),
            acceleration: element(ACCELERATION),
            normalized_innovations,
        }
    }
}

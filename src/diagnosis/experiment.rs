//! Experiments that a bench can do, within what its recordings show that it does.

pub mod choice;
pub mod coverage;
pub mod information;
pub mod inseparable;
pub mod limits;
pub mod next_experiment;
mod open;
pub mod programme;
pub mod ride;

use super::recordings::evidence::Evidence;
use crate::plant::{InitialState, OperatingLimits, PlantInputs, PlantParameters};
use std::f64::consts::TAU;

/// An experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// Its name.
    pub name: &'static str,
    /// Instruction.
    pub instruction: String,
    /// The same for the simulator.
    pub inputs: PlantInputs,
}

/// Travel of a surface that is worth a motion [m].
const LEAST_TRAVEL: f64 = 5e-4;

/// Behaviour of the device in its recordings.
struct Reach {
    /// Step of the samples [s].
    step: f64,
    /// Highest set pressure [Pa gauge].
    pressure: f64,
    /// Where the workpiece stands [m].
    surface: f64,
    /// Reach of its motion to either side [m].
    travel: f64,
}

impl Reach {
    fn new(evidence: &Evidence, plant: &PlantParameters, limits: &OperatingLimits) -> Self {
        let inputs = || evidence.recordings.iter().map(|m| &m.inputs);
        let stroke = plant.device.full_stroke;
        let surfaces: Vec<f64> = inputs()
            .flat_map(|i| i.surface.iter().copied())
            .filter(|x| x.is_finite() && *x > 0.1 * stroke && *x < 0.9 * stroke)
            .collect();
        let middle = if surfaces.is_empty() {
            0.5 * stroke
        } else {
            surfaces.iter().sum::<f64>() / surfaces.len() as f64
        };
        // As far as the owner lets it.
        let [least, most] = limits.surface;
        let [least, most] = [least.unwrap_or(0.0), most.unwrap_or(stroke)];
        let middle = middle.min(most).max(least);
        let pressures = inputs().flat_map(|i| i.set_pressure.iter().copied());
        let steps = inputs().map(|i| crate::stats::median_step(&i.time));
        Self {
            step: steps.fold(f64::INFINITY, f64::min),
            pressure: pressures
                .fold(0.0, f64::max)
                .min(limits.set_pressure.unwrap_or(f64::INFINITY)),
            surface: middle,
            travel: (0.2 * stroke)
                .min(0.8 * middle)
                .min(0.8 * (stroke - middle))
                .min(most - middle)
                .min(middle - least),
        }
    }

    fn inputs(&self, duration: f64, at: impl Fn(f64) -> (f64, bool, f64)) -> PlantInputs {
        let count = (duration / self.step).round() as usize + 1;
        let time: Vec<f64> = (0..count).map(|i| i as f64 * self.step).collect();
        let values: Vec<(f64, bool, f64)> = time.iter().map(|t| at(*t)).collect();
        PlantInputs {
            set_pressure: values.iter().map(|v| v.0).collect(),
            extends: values.iter().map(|v| v.1).collect(),
            surface: values.iter().map(|v| v.2).collect(),
            cell: None,
            motion: None,
            initial: InitialState::AtRest,
            place: 0,
            time,
        }
    }
}

/// Triangle wave between 0 and 1 that starts at 0.
fn triangle(phase: f64) -> f64 {
    let phase = phase.rem_euclid(1.0);
    if phase < 0.5 {
        2.0 * phase
    } else {
        2.0 - 2.0 * phase
    }
}

/// Square wave that changes after each such time [s].
fn first_half(time: f64, each: f64) -> bool {
    ((time / each) as usize).is_multiple_of(2)
}

/// The experiments for a bench.
#[must_use]
pub fn experiments(
    evidence: &Evidence,
    plant: &PlantParameters,
    limits: &OperatingLimits,
) -> Vec<Experiment> {
    let reach = Reach::new(evidence, plant, limits);
    let [ramp, steps, dwell] = reach.at_a_fixed_surface();
    let [strokes, reversals] = reach.without_a_workpiece();
    let mut all = vec![ramp, steps, strokes, reversals];
    if reach.travel > LEAST_TRAVEL {
        all.extend(reach.on_a_moved_surface());
    }
    all.push(dwell);
    all
}

impl Reach {
    fn at_a_fixed_surface(&self) -> [Experiment; 3] {
        let (top, surface) = (self.pressure, self.surface);
        let high = bar(top);
        let fixed = format!("the surface fixed at {:.0} mm", mm(surface));
        // The tool is set down on the surface before anything is asked of it.
        let settled = |t: f64, then: f64| if t < 1.0 { 0.5 * top } else { then };
        [
            Experiment {
                name: "pressure_ramp",
                instruction: format!(
                    "with {fixed}, raise the set pressure slowly from 0 to {high:.1} bar and back, twice in 10 s"
                ),
                inputs: self.inputs(10.0, |t| (top * triangle(t / 5.0), true, surface)),
            },
            Experiment {
                name: "pressure_steps",
                instruction: format!(
                    "with {fixed}, step the set pressure between {:.1} and {:.1} bar every 0.5 s, for 8 s",
                    0.3 * high,
                    0.8 * high
                ),
                inputs: self.inputs(8.0, |t| {
                    let then = if first_half(t, 0.5) { 0.8 } else { 0.3 } * top;
                    (settled(t, then), true, surface)
                }),
            },
            Experiment {
                name: "dwell",
                instruction: format!("with {fixed}, hold {:.1} bar for 15 s", 0.5 * high),
                inputs: self.inputs(15.0, |_| (0.5 * top, true, surface)),
            },
        ]
    }

    fn without_a_workpiece(&self) -> [Experiment; 2] {
        let top = self.pressure;
        let (high, none) = (bar(top), f64::NAN);
        [
            Experiment {
                name: "free_strokes",
                instruction: format!(
                    "without a workpiece, full strokes out and in at {:.1}, {:.1} and {high:.1} bar, 1.5 s each way",
                    0.33 * high,
                    0.67 * high
                ),
                inputs: self.inputs(9.0, |t| {
                    let pressure = top * ((t / 3.0).floor() + 1.0).min(3.0) / 3.0;
                    (pressure, t % 3.0 < 1.5, none)
                }),
            },
            Experiment {
                name: "valve_reversals",
                instruction: format!(
                    "without a workpiece, reverse the valve in mid-stroke, every 0.15 s, at {:.1} bar, for 6 s",
                    0.6 * high
                ),
                inputs: self.inputs(6.0, |t| (0.6 * top, first_half(t, 0.15), none)),
            },
        ]
    }

    fn on_a_moved_surface(&self) -> [Experiment; 2] {
        let (half, surface, travel) = (0.5 * self.pressure, self.surface, self.travel);
        let ride = |t: f64, frequency: f64| {
            let on = 1.0 - (-t / 0.5).exp();
            surface + travel * on * (TAU * frequency * t).sin()
        };
        [
            Experiment {
                name: "slow_ride",
                instruction: format!(
                    "at a constant {:.1} bar, move the surface {:.0} mm to either side of {:.0} mm at 0.3 Hz, for 10 s",
                    bar(half),
                    mm(travel),
                    mm(surface)
                ),
                inputs: self.inputs(10.0, |t| (half, true, ride(t, 0.3))),
            },
            Experiment {
                name: "fast_ride",
                instruction: format!(
                    "at a constant {:.1} bar, move the surface {:.1} mm to either side of {:.0} mm at 3 Hz, for 6 s",
                    bar(half),
                    mm(0.2 * travel),
                    mm(surface)
                ),
                inputs: self.inputs(6.0, |t| {
                    (half, true, surface + 0.2 * (ride(t, 3.0) - surface))
                }),
            },
        ]
    }
}

fn bar(pressure: f64) -> f64 {
    pressure * 1e-5
}

fn mm(length: f64) -> f64 {
    length * 1e3
}

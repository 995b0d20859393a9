//! How far the owner of a rig lets it be moved.

use super::{PlantInputs, Trajectory};

/// Time over which a rate of the set pressure is taken [s]: a regulator is given a value and holds it.
const HELD: f64 = 0.05;
/// Rounding [1].
const ROUNDING: f64 = 1.0 + 1e-6;

/// Limits as a file states them; none where it states nothing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OperatingLimits {
    /// Largest set pressure [Pa gauge].
    pub set_pressure: Option<f64>,
    /// Largest rate of the set pressure [Pa/s].
    pub set_pressure_rate: Option<f64>,
    /// Where the surface may stand along the stroke, at least and at most [m].
    pub surface: [Option<f64>; 2],
    /// Largest speed of the surface [m/s].
    pub surface_speed: Option<f64>,
    /// Largest acceleration of the surface [m/s2].
    pub surface_acceleration: Option<f64>,
    /// Whether the 5/2 valve may retract.
    pub solenoid: Option<bool>,
    /// Whether the tool may run without a workpiece.
    pub without_workpiece: Option<bool>,
    /// Largest stroke [m].
    pub stroke: Option<f64>,
    /// Largest force on the part [N].
    pub force: Option<f64>,
    /// Longest recording [s].
    pub duration: Option<f64>,
    /// Largest speed [rad/s] and acceleration [rad/s2] of the joints of a cell's arm.
    pub joint_motion: [Option<f64>; 2],
    /// Largest torque of each drive of that arm, base first [N m].
    pub joint_torque: Option<Vec<f64>>,
}

impl OperatingLimits {
    /// Whether inputs of a bench keep them, with what a device does under these. What is not stated is not looked at.
    #[must_use]
    pub fn allow(&self, inputs: &PlantInputs, truth: &Trajectory) -> bool {
        let within =
            |most: Option<f64>, found: f64| most.is_none_or(|most| found <= ROUNDING * most);
        let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        let time = &inputs.time;
        let [least, most] = self.surface;
        let mut places = inputs.surface.iter().filter(|x| x.is_finite());
        let is_within =
            places.all(|x| least.is_none_or(|least| least <= ROUNDING * x) && within(most, *x));
        let is_free = inputs.surface.iter().any(|x| !x.is_finite());
        let retracts = inputs.extends.iter().any(|extends| !extends);
        let [speed, acceleration] = surface_motion(inputs);
        is_within
            && within(self.set_pressure, largest(&inputs.set_pressure))
            && within(self.set_pressure_rate, set_pressure_rate(inputs))
            && within(self.surface_speed, speed)
            && within(self.surface_acceleration, acceleration)
            && (self.solenoid != Some(false) || !retracts)
            && (self.without_workpiece != Some(false) || !is_free)
            && within(self.stroke, largest(&truth.stroke))
            && within(self.force, largest(&truth.contact_force))
            && within(self.duration, time[time.len() - 1] - time[0])
    }
}

/// Largest rate of the set pressure over [`HELD`] [Pa/s].
fn set_pressure_rate(inputs: &PlantInputs) -> f64 {
    let (time, pressure) = (&inputs.time, &inputs.set_pressure);
    let mut largest: f64 = 0.0;
    let mut ahead = 0;
    for (at, start) in time.iter().enumerate() {
        while ahead + 1 < time.len() && time[ahead + 1] <= start + HELD {
            ahead += 1;
        }
        for later in at..=ahead {
            largest = largest.max((pressure[later] - pressure[at]).abs());
        }
    }
    largest / HELD
}

/// Largest speed [m/s] and acceleration [m/s2] of the surface, by its samples.
fn surface_motion(inputs: &PlantInputs) -> [f64; 2] {
    let (time, surface) = (&inputs.time, &inputs.surface);
    let speed = |at: usize| (surface[at + 1] - surface[at]) / (time[at + 1] - time[at]);
    let mut largest = [0.0f64; 2];
    for at in 0..time.len().saturating_sub(1) {
        largest[0] = largest[0].max(speed(at).abs());
        if at > 0 {
            let change = (speed(at) - speed(at - 1)).abs();
            largest[1] = largest[1].max(2.0 * change / (time[at + 1] - time[at - 1]));
        }
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::InitialState;

    /// Two seconds: set pressure stepped to 2 bar, the surface moved 5 mm to either side of 20 mm at 1 Hz, 120 N at most and a stroke of 25 mm.
    fn done() -> (PlantInputs, Trajectory) {
        let time: Vec<f64> = (0..=1000).map(|i| 0.002 * f64::from(i)).collect();
        let surface = |t: &f64| 0.02 + 0.005 * (std::f64::consts::TAU * t).sin();
        let surface: Vec<f64> = time.iter().map(surface).collect();
        let truth = Trajectory {
            contact_force: time.iter().map(|t| 60.0 * t).collect(),
            stroke: surface.clone(),
            ..Trajectory::default()
        };
        let inputs = PlantInputs {
            set_pressure: time
                .iter()
                .map(|t| if *t < 1.0 { 0.0 } else { 2e5 })
                .collect(),
            extends: vec![true; time.len()],
            surface,
            cell: None,
            motion: None,
            initial: InitialState::AtRest,
            place: 0,
            time,
        };
        (inputs, truth)
    }

    type Set = fn(&mut OperatingLimits, f64);

    /// Each limit a little above what was done, then a little below it; the surface's speed and acceleration by those of its sine.
    #[test]
    fn each_limit_is_kept_or_not() {
        let (inputs, truth) = done();
        let turns = std::f64::consts::TAU;
        assert!(OperatingLimits::default().allow(&inputs, &truth));
        let limits: [(f64, Set); 9] = [
            (2e5, |l, v| l.set_pressure = Some(v)),
            (2e5 / HELD, |l, v| l.set_pressure_rate = Some(v)),
            (0.025, |l, v| l.surface[1] = Some(v)),
            (0.005 * turns, |l, v| l.surface_speed = Some(v)),
            (0.005 * turns * turns, |l, v| {
                l.surface_acceleration = Some(v);
            }),
            (0.025, |l, v| l.stroke = Some(v)),
            (120.0, |l, v| l.force = Some(v)),
            (2.0, |l, v| l.duration = Some(v)),
            // By how far it is from the largest.
            (0.01, |l, v| l.surface[0] = Some(0.025 - v)),
        ];
        for (place, (value, set)) in limits.iter().enumerate() {
            for (share, allowed) in [(1.01, true), (0.99, false)] {
                let mut own = OperatingLimits::default();
                set(&mut own, value * share);
                assert_eq!(own.allow(&inputs, &truth), allowed, "{place} {share}");
            }
        }
    }

    #[test]
    fn a_valve_and_a_part_that_are_to_stay_stay() {
        let (mut inputs, truth) = done();
        let stays = OperatingLimits {
            solenoid: Some(false),
            without_workpiece: Some(false),
            ..OperatingLimits::default()
        };
        assert!(stays.allow(&inputs, &truth));
        inputs.extends[500] = false;
        assert!(!stays.allow(&inputs, &truth));
        inputs.extends[500] = true;
        inputs.surface.fill(f64::NAN);
        assert!(!stays.allow(&inputs, &truth));
        assert!(OperatingLimits::default().allow(&inputs, &truth));
    }
}

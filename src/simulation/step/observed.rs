//! What a controller outside of the program sees of a cell.

use super::Simulation;
use crate::control::observed::Observed;
use crate::path::Phase;

impl Simulation<'_> {
    /// What there is to see of it after the last step; before the first as it rests.
    pub fn observed(&self) -> Observed {
        let (reference, readings, device) = (&self.reference, &self.readings, &self.device);
        let motion = device.motion;
        let [extending, retracting] = device.device.pressures(&device.state, motion.stroke);
        let desired = self.desired(reference);
        [
            self.steps as f64 * self.cell.setup.scenario.simulation.step,
            desired,
            desired * reference.share,
            self.log.last_contact_force(),
            readings.force,
            motion.stroke,
            motion.speed,
            readings.stroke,
            self.answer,
            device.state.regulator.outlet,
            readings.regulator_pressure,
            extending,
            retracting,
            self.cell.gravity_along(reference.axis),
            match reference.phase {
                Phase::Approach => 0.0,
                Phase::Engage => 1.0,
                Phase::Follow => 2.0,
                Phase::Retract => 3.0,
            },
        ]
    }
}

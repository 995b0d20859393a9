//! Forces on the piston besides that of the gas: cushions, axial load, seals under pressure; and all of it together.

use std::borrow::Borrow;

use super::DeviceParameters;
use super::load::PistonMotion;
use super::pneumatics::Device;
use super::state::{AirState, DeviceState};
use crate::physics::seal_friction::SealFriction;

impl<P: Borrow<DeviceParameters>> Device<P> {
    /// Force of the whole device on the piston along extension [N]: gas, seals, end stops, cushions and axial load.
    pub fn piston_force(&self, state: &DeviceState, motion: PistonMotion) -> f64 {
        self.gas_force(state, motion.stroke)
            + self.seal_force(state, motion.speed)
            + self.stop_force(motion)
            + self.cushion_force(motion)
            + self.axial_force(motion.stroke)
    }

    /// Force of the end cushions along extension [N].
    pub fn cushion_force(&self, motion: PistonMotion) -> f64 {
        self.cushion_force_of(self.cushion_at(motion), motion)
    }

    /// Force of the axial load along extension [N] at a stroke [m].
    pub fn axial_force(&self, stroke: f64) -> f64 {
        self.parameters().axial_load.force_at(stroke)
    }

    /// Which end cushion is being pressed: -1 the retracted one, 1 the extended one, 0 none.
    pub(super) fn cushion_at(&self, motion: PistonMotion) -> i8 {
        let parameters = self.parameters();
        parameters
            .end_cushioning
            .pressed(parameters.full_stroke, motion.stroke, motion.speed)
    }

    /// Damping of an end's cushion [N s/m], as it holds while it is pressed.
    pub(super) fn cushion_damping(&self, end: i8, stroke: f64) -> f64 {
        let parameters = self.parameters();
        parameters
            .end_cushioning
            .damping_of(end, parameters.full_stroke, stroke)
    }

    /// Force of an end's cushion along extension [N], as it holds while it is pressed.
    pub(super) fn cushion_force_of(&self, end: i8, motion: PistonMotion) -> f64 {
        -self.cushion_damping(end, motion.stroke) * motion.speed
    }

    /// The seals as the chamber pressures press them: a mean over states of the air with their strokes [m]; with a further dry friction [N].
    pub(super) fn seals_over<const N: usize>(
        &self,
        states: [(&AirState, f64); N],
        further: f64,
    ) -> SealFriction {
        let seals = &self.parameters().seal_friction;
        if seals.pressure_coefficient == 0.0 {
            return seals.with(further);
        }
        let difference = states.map(|(air, stroke)| {
            let volumes = [0, 1].map(|i| self.chambers[i].volume(stroke));
            let pressures = self.pressures_of(air, volumes);
            (pressures[0] - pressures[1]) / N as f64
        });
        seals.under(difference.iter().sum()).with(further)
    }
}

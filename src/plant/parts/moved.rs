//! A piston or slide whose motion is recorded: the force that it takes.
//!
//! ```text
//! moved:   F = p A_1 + F_0 - k x + m g - F_f - m a                      what the piston pushes with
//! driven:  F = m a + F_f - F_0 + k x - m g                               what the drive pushes with
//! ```
//!
//! p gauge pressure in chamber 1 [Pa], A_1 its piston area [m2], F_0 - k x axial load [N], g component of gravity along extension [m/s2], m moving mass
//! [kg], a acceleration along extension [m/s2], F_f friction against the motion [N], x stroke [m]. Chamber 2 is open.

use super::super::inputs::PlantInputs;
use super::super::parameters::PlantParameters;
use super::super::trajectory::Trajectory;
use super::DeviceParts;

pub(super) fn true_trajectory(plant: &PlantParameters, inputs: &PlantInputs) -> Trajectory {
    let device = &plant.device;
    let atmosphere = device.gas.atmosphere;
    let count = inputs.time.len();
    let mut truth = Trajectory::still(count, atmosphere);
    let Some(motion) = &inputs.motion else {
        return truth;
    };
    let area = device.areas().extending;
    let drives = plant.parts == DeviceParts::DrivenSlide;
    let mut deflection = 0.0;
    for i in 0..count {
        let pressure = inputs.set_pressure[i];
        let (stroke, speed) = (motion.stroke[i], motion.speed[i]);
        let seals = device.seal_friction.under(pressure);
        let travel = if i > 0 {
            stroke - motion.stroke[i - 1]
        } else {
            0.0
        };
        if travel.is_finite() {
            deflection = seals.deflection_after(deflection, travel, speed);
        }
        let friction = seals.force(deflection, speed) + plant.links.viscous_asymmetry * speed.abs();
        let inertia = device.moving_mass * (motion.acceleration[i] - plant.gravity_along_extension);
        let push = pressure * area + device.axial_load.force_at(stroke) - friction - inertia;
        truth.contact_force[i] = if drives { -push } else { push };
        truth.outlet[i] = pressure;
        truth.pressures[0][i] = atmosphere + pressure;
        truth.stroke[i] = stroke;
        truth.speed[i] = speed;
        truth.acceleration[i] = motion.acceleration[i];
    }
    truth
}

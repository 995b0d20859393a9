//! A contact flange by its nominal values: the contact force follows the desired one, first order.
//!
//! ```text
//! tau dF/dt = F_d - F
//! ```
//!
//! F contact force [N], F_d desired force [N], tau time constant [s]. The desired force stands where that of the other rigs is a set pressure.

use super::super::inputs::PlantInputs;
use super::super::parameters::PlantParameters;
use super::super::trajectory::Trajectory;

pub(super) fn true_trajectory(plant: &PlantParameters, inputs: &PlantInputs) -> Trajectory {
    let time = &inputs.time;
    let mut truth = Trajectory::still(time.len(), plant.device.gas.atmosphere);
    let mut force = inputs.set_pressure[0];
    for i in 0..time.len() {
        truth.contact_force[i] = force;
        let Some(next) = time.get(i + 1) else { break };
        let decay = (-(next - time[i]) / plant.device.regulator.time_constant).exp();
        force = inputs.set_pressure[i] + (force - inputs.set_pressure[i]) * decay;
    }
    truth
}

//! A regulator alone, and what hangs on it.
//!
//!     y = p - w (p - q),   dq/dt = (p - q)/T
//!
//! p what the regulator's law gives ([`crate::physics::regulator`]) with a time constant of its own while it falls, if there is one [Pa], y outlet [Pa],
//! q pressure of a load behind a line, from which air flows as long as it stands otherwise [Pa], w share [1], T its time [s]: the two modes of two volumes
//! with a laminar line between them, the near one seen (Anderson 1967, chapter 4).

use super::super::inputs::PlantInputs;
use super::super::parameters::PlantParameters;
use super::super::simulate::Trajectory;
use crate::physics::regulator::RegulatorState;

pub(super) fn trajectory(plant: &PlantParameters, inputs: &PlantInputs) -> Trajectory {
    let filling = plant.device.regulator;
    let venting = crate::physics::regulator::RegulatorParameters {
        time_constant: plant
            .links
            .venting_time_constant
            .unwrap_or(filling.time_constant),
        ..filling
    };
    let atmosphere = plant.device.gas.atmosphere;
    let (time, set) = (&inputs.time, &inputs.set_pressure);
    let mut truth = Trajectory::still(time.len(), atmosphere);
    let mut state = RegulatorState::at_rest(&filling, set[0]);
    let mut behind = state.outlet;
    let (share, settling) = (plant.links.load_share, plant.links.load_time);
    for i in 0..time.len() {
        let outlet = state.outlet - share * (state.outlet - behind);
        truth.outlet[i] = outlet;
        truth.pressures[0][i] = atmosphere + outlet;
        let Some(next) = time.get(i + 1) else { break };
        let h = next - time[i];
        state.command(&filling, set[i]);
        let before = state.outlet;
        let falls = filling.gain * state.acted_on() < state.outlet;
        let law = if falls { &venting } else { &filling };
        state.advance(law, h);
        // The load follows the mean of the step.
        let mean = 0.5 * (before + state.outlet);
        behind = mean + (behind - mean) * (-h / settling).exp();
    }
    truth
}

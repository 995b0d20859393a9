//! A regulator alone, and what hangs on it.
//!
//! ```text
//! y = p - w (p - q),   dq/dt = (p - q)/T
//! ```
//!
//! p what the regulator's law gives ([`crate::physics::regulator`]) with time constants of its own while it falls, and while nothing is set, if there are
//! such [Pa], y outlet [Pa],
//! q pressure of a load behind a line, from which air flows as long as it stands otherwise [Pa], w share [1], T its time [s]: the two modes of two volumes
//! with a laminar line between them, the near one seen (Anderson 1967, chapter 4).

use super::super::inputs::PlantInputs;
use super::super::parameters::PlantParameters;
use super::super::trajectory::Trajectory;
use crate::physics::regulator::{RateLimit, RegulatorParameters, RegulatorState};

/// Set pressure below which nothing is set [Pa gauge].
const NOTHING_SET: f64 = 100.0;

pub(super) fn true_trajectory(plant: &PlantParameters, inputs: &PlantInputs) -> Trajectory {
    let filling = plant.device.regulator;
    let links = plant.links;
    let with = |time_constant: f64| RegulatorParameters {
        time_constant,
        ..filling
    };
    let venting = with(links.venting_time_constant.unwrap_or(filling.time_constant));
    let shut = match links.shut_time_constant {
        None => venting,
        // An exhaust that stands open is not limited by the valve that meters it.
        Some(time_constant) => RegulatorParameters {
            rate_limit: RateLimit::NONE,
            ..with(time_constant)
        },
    };
    let atmosphere = plant.device.gas.atmosphere;
    let (time, set) = (&inputs.time, &inputs.set_pressure);
    let mut truth = Trajectory::still(time.len(), atmosphere);
    let mut state = RegulatorState::at_rest(&filling, set[0]);
    let mut behind = state.outlet;
    let (share, settling) = (links.load_share, links.load_time);
    for i in 0..time.len() {
        let outlet = state.outlet - share * (state.outlet - behind);
        truth.outlet[i] = outlet;
        truth.pressures[0][i] = atmosphere + outlet;
        let Some(next) = time.get(i + 1) else { break };
        let h = next - time[i];
        state.command(&filling, set[i]);
        let before = state.outlet;
        let falls = filling.gain * state.acted_on() < state.outlet;
        let law = match (falls, state.acted_on() <= NOTHING_SET) {
            (false, _) => &filling,
            (true, false) => &venting,
            (true, true) => &shut,
        };
        state.advance(law, h);
        // The load follows the mean of the step.
        let mean = 0.5 * (before + state.outlet);
        behind = mean + (behind - mean) * (-h / settling).exp();
    }
    truth
}

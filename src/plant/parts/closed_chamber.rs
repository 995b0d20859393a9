//! A chamber that was filled and shut off.
//!
//! ```text
//! dp/dt = - (A C/V) sqrt(R T) p f(p_a/p)  -  k (p^2 - p_a^2)  -  r (1 + o g) g  -  (D/T_c) e^(-t/T_c)
//!         orifice                            narrow gap          opening leak      air that cools after filling
//! ```
//!
//! p pressure and p_a that of the atmosphere [Pa absolute], g = p - p_a [Pa], A C/V equivalent area by volume [1/m], f flow function (the source paper's
//! eqs. 9 to 11), k conductance of laminar compressible flow by volume [1/(Pa s)] (Poiseuille; Egli 1937 for gaps), r rate at small pressure [1/s], o its
//! growth [1/Pa], D what cooling takes [Pa], T_c its time [s], t since the chamber was shut; until then it is fed. With k alone dp/dt = -(2 p_a k g + k g^2). Runge and Kutta's fourth order, a step a sample.

use super::super::inputs::PlantInputs;
use super::super::parameters::PlantParameters;
use super::super::trajectory::Trajectory;
use crate::physics::orifice::FlowFunction;

pub(super) fn true_trajectory(plant: &PlantParameters, inputs: &PlantInputs) -> Trajectory {
    let gas = &plant.device.gas;
    let atmosphere = gas.atmosphere;
    let flow = FlowFunction::new(gas);
    let (leak, links) = (plant.links.leak, plant.links);
    let energy = gas.specific_gas_constant * gas.temperature;
    let rate = |time: f64, gauge: f64| {
        let pressure = atmosphere + gauge;
        let through = if leak.orifice > 0.0 && gauge > 0.0 {
            leak.orifice * energy * flow.mass_flow(1.0, pressure, atmosphere)
        } else {
            0.0
        };
        let squares = pressure * pressure - atmosphere * atmosphere;
        let opening = leak.proportional * (1.0 + leak.opening * gauge) * gauge;
        let cooling = links.cooling / links.cooling_time * (-time / links.cooling_time).exp();
        -(through + leak.laminar * squares + opening + cooling)
    };
    let time = &inputs.time;
    let mut truth = Trajectory::still(time.len(), atmosphere);
    let mut gauge = inputs.set_pressure[0] + links.start_error;
    for i in 0..time.len() {
        truth.outlet[i] = gauge;
        truth.pressures[0][i] = atmosphere + gauge;
        let Some(next) = time.get(i + 1) else { break };
        let start = (time[i] - time[0] - links.shut_time).max(0.0);
        let h = (next - time[0] - links.shut_time).max(0.0) - start;
        let a = rate(start, gauge);
        let b = rate(start + 0.5 * h, gauge + 0.5 * h * a);
        let c = rate(start + 0.5 * h, gauge + 0.5 * h * b);
        let d = rate(start + h, gauge + h * c);
        gauge += h / 6.0 * (a + 2.0 * (b + c) + d);
    }
    truth
}

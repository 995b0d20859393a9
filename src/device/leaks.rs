//! Leaks between the chambers and to the atmosphere, with the enthalpy that it carries.

use super::DeviceParameters;
use crate::physics::orifice::FlowFunction;

/// Flows of the leaks.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LeakFlows {
    /// Into each chamber [kg/s].
    pub masses: [f64; 2],
    /// Enthalpy into each chamber [W].
    pub enthalpies: [f64; 2],
    /// From the atmosphere into each chamber [kg/s].
    pub external: [f64; 2],
}

impl LeakFlows {
    /// Flows of a leaking device between chambers of absolute pressure [Pa] and temperature [K], with further areas of leaks from each chamber to the
    /// atmosphere [m2].
    pub(super) fn new(
        parameters: &DeviceParameters,
        flow_function: &FlowFunction,
        chambers: [(f64, f64); 2],
        further: [f64; 2],
    ) -> Self {
        let leakage = &parameters.leakage;
        let gas = &parameters.gas;
        let discharge = parameters.discharge_coefficient;
        let flow = |area: f64, from: (f64, f64), to: (f64, f64)| {
            let mass = flow_function.mass_flow(area * discharge, from.0, to.0);
            let upstream = if mass > 0.0 { from.1 } else { to.1 };
            // The flow function is that of the surroundings' temperature.
            let mass = mass * (gas.temperature / upstream).sqrt();
            (mass, gas.specific_heat_pressure() * upstream * mass)
        };
        let cross = flow(leakage.cross_piston, chambers[0], chambers[1]);
        let surroundings = (gas.atmosphere, gas.temperature);
        let areas = [leakage.external + further[0], further[1]];
        let [first, second] = [0, 1].map(|i| flow(areas[i], surroundings, chambers[i]));
        Self {
            masses: [first.0 - cross.0, second.0 + cross.0],
            enthalpies: [first.1 - cross.1, second.1 + cross.1],
            external: [first.0, second.0],
        }
    }
}

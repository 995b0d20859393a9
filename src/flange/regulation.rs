//! The air's force, disturbed by the stroke and regulated back.
//!
//! ```text
//! dP/dt = k_g s' - q,    dq/dt = ((P - P_set)/t_1 - q)/t_2
//! ```
//!
//! P force of the air [N], s' rate at which the slide is pushed in [m/s], k_g stiffness of the shut-in air [N/m], q what the regulator vents [N/s],
//! t_1 time in which it would [s], t_2 time in which its valve follows [s]. Leaves out: choked flow, so that large errors vent as quickly as small ones.

/// Regulator with the air behind it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Regulation {
    pub gas_stiffness: f64,
    pub time: f64,
    pub valve_time: f64,
}

/// Its state.
#[derive(Debug, Clone, Copy)]
pub(super) struct Air {
    /// Force [N].
    pub force: f64,
    /// What is vented [N/s].
    pub vented: f64,
}

impl Regulation {
    /// State after a step [s] with the slide pushed in at a rate [m/s] and a set force [N].
    pub(super) fn advanced(self, air: Air, rate: f64, set: f64, step: f64) -> Air {
        let wanted = (air.force - set) / self.time;
        let vented = air.vented + step * (wanted - air.vented) / self.valve_time;
        Air {
            force: air.force + step * (self.gas_stiffness * rate - vented),
            vented,
        }
    }
}

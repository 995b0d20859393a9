//! Process of the gas in a chamber under compression: stays at its temperature, or heats up and exchanges heat with the wall.
//!
//! ```text
//! isothermal:  p V = m R T_0                                                               (source paper, eq. 4)
//! wall heat:   dE/dt = sum(m_dot_in c_p T_in) - sum(m_dot_out c_p T) - p dV/dt + G (T_w - T),   p V = (k - 1) E,   T = E / (m c_v)
//! ```
//!
//! E internal energy [J], T temperature [K], G conductance from gas to wall [W/K], T_w wall temperature [K], k ratio of specific heats [1],
//! c_p and c_v specific heats [J/(kg K)]. G = 0 is adiabatic; a large G comes back to isothermal.
//! First law for an open volume; Carneiro and Gomes de Almeida 2006 for the order of magnitude of G in small cylinders.

/// The process in each chamber.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GasProcess {
    /// Constant temperature, as in the source paper.
    Isothermal,
    /// The gas has its own temperature; the wall is at the surroundings'.
    WallHeat {
        /// Conductance between the gas of a chamber and its wall [W/K].
        conductance: f64,
    },
}

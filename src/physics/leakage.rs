//! Air that passes where it should not: the piston seal, and the fittings of chamber 1.
//!
//! ```text
//! m_dot = A C p_u / sqrt(R T) f(p_d / p_u)                (equivalent orifices in the source paper's eqs. 9 to 11, `orifice`)
//! ```
//!
//! A equivalent area [m2], C discharge coefficient of the device's orifices [1]. The higher pressure is upstream, and near equal pressures the
//! flow is as linear in their difference as through any orifice here.
//! Leaves out: that a gap of some micrometres is laminar throughout; an equivalent orifice states the flow at working pressures.

/// Equivalent orifices, all cylinders together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leakage {
    /// Past the piston seal, between the chambers [m2].
    pub cross_piston: f64,
    /// From chamber 1 to the atmosphere [m2].
    pub external: f64,
}

impl Leakage {
    /// Tight.
    pub const NONE: Self = Self {
        cross_piston: 0.0,
        external: 0.0,
    };

    /// Whether anything leaks.
    pub fn is_none(&self) -> bool {
        *self == Self::NONE
    }
}

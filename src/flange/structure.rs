//! The structure that carries the head of a tool: a spring whose damping grows with its speed.
//!
//! ```text
//! F = k x + (2 z sqrt(k m) + q |x'|) x',    m = m_h m_s/(m_h + m_s)                (French 1971, chapter 3; the quadratic term: fluids and gaps squeezed)
//! ```
//!
//! F force [N], x deflection [m], k stiffness [N/m], z damping ratio [1], q quadratic damping [N s2/m2], m_h and m_s masses at its ends [kg].

/// A spring with its damping.
#[derive(Debug, Clone, Copy)]
pub(super) struct Structure {
    /// Stiffness [N/m].
    stiffness: f64,
    /// Viscous coefficient [N s/m].
    viscous: f64,
    /// Quadratic coefficient [N s2/m2].
    quadratic: f64,
}

impl Structure {
    /// Of a stiffness [N/m] with a damping ratio [1] for the mass [kg] that swings on it, and a quadratic coefficient [N s2/m2].
    pub(super) fn new(stiffness: f64, ratio: f64, mass: f64, quadratic: f64) -> Self {
        Self {
            stiffness,
            viscous: 2.0 * ratio * (stiffness * mass).sqrt(),
            quadratic,
        }
    }

    /// Force [N] at a deflection [m] and its rate [m/s].
    pub(super) fn force(self, deflection: f64, rate: f64) -> f64 {
        self.stiffness * deflection + (self.viscous + self.quadratic * rate.abs()) * rate
    }
}

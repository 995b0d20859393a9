//! Friction of piston seals and guides: bristles that bend before they slide.
//!
//! ```text
//! F = s z + b v,   dz/dx = 1 - sign(v) s z / g(v),   s = F_c / z_p              (Dahl 1968; Canudas de Wit et al. 1995, without micro-damping)
//! g(v) = F_c + (F_s - F_c) exp(-(v / v_s)^2)                                    (Stribeck)
//! ```
//!
//! F resisting force [N], z bristle deflection [m], s its stiffness [N/m], b viscous coefficient [N s/m], v speed of extension [m/s],
//! F_c Coulomb and F_s static friction [N], v_s Stribeck velocity [m/s], z_p presliding displacement [m]: Coulomb friction over initial stiffness.
//!
//! The deflection depends on the path alone, not on time. While the direction and g hold, it follows in closed form over a displacement d,
//!
//! ```text
//! z(d) = z_inf + (z_0 - z_inf) exp(-s |d| / g),   z_inf = sign(d) g / s
//! ```
//!
//! so sliding, however fast, is never stiff.
//!
//! A seal is pressed against its bore by the pressure across it: F_c and F_s then grow by c |p_1 - p_2|, while the bristles keep their stiffness, which
//! is that of z_p at 1 bar across them (Raparelli, Manuello Bertetto and Mazza 1997).
//!
//! c pressure coefficient [N/Pa], p_1 and p_2 chamber pressures [Pa].

/// Friction of all cylinders together, at the piston.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SealFriction {
    /// Coulomb friction [N]; 0 for no dry friction.
    pub coulomb: f64,
    /// Static friction [N], at least the Coulomb friction.
    pub static_force: f64,
    /// Stribeck velocity [m/s].
    pub stribeck_velocity: f64,
    /// Viscous coefficient [N s/m].
    pub viscous: f64,
    /// Presliding displacement [m].
    pub presliding_displacement: f64,
    /// Growth of Coulomb and static friction with the pressure difference across the piston [N/Pa].
    pub pressure_coefficient: f64,
}

/// Pressure difference at which the presliding displacement holds, if friction depends on it [Pa].
const REFERENCE_DIFFERENCE: f64 = 1e5;

/// Dry friction that nobody would notice [N].
const LEAST: f64 = 1e-6;
/// Stiffness of bristles where none is known: of 10 N over the presliding displacement of [`SealFriction::NONE`] [N/m].
pub const USUAL_STIFFNESS: f64 = 2e5;

impl SealFriction {
    /// No friction.
    pub const NONE: Self = Self {
        coulomb: 0.0,
        static_force: 0.0,
        stribeck_velocity: 0.01,
        viscous: 0.0,
        presliding_displacement: 5e-5,
        pressure_coefficient: 0.0,
    };

    /// Whether there is dry friction.
    pub fn is_dry(&self) -> bool {
        self.coulomb > 0.0 || self.pressure_coefficient > 0.0
    }

    /// The same seals with a pressure difference across them [Pa], as they are while it lasts.
    #[must_use]
    pub fn under(&self, pressure_difference: f64) -> Self {
        if self.pressure_coefficient == 0.0 {
            return *self;
        }
        let growth = self.pressure_coefficient * pressure_difference.abs();
        let coulomb = self.coulomb + growth;
        Self {
            coulomb,
            static_force: self.static_force + growth,
            presliding_displacement: coulomb / self.stiffness(),
            pressure_coefficient: 0.0,
            ..*self
        }
    }

    /// The same seals with a further dry friction [N], as they are while it lasts; friction is never less than nothing.
    #[must_use]
    pub fn with(&self, further: f64) -> Self {
        if further == 0.0 {
            return *self;
        }
        let coulomb = (self.coulomb + further).max(LEAST);
        Self {
            coulomb,
            static_force: (self.static_force + further).max(coulomb),
            presliding_displacement: coulomb / self.stiffness(),
            pressure_coefficient: 0.0,
            ..*self
        }
    }

    /// Seals that a further friction may press: dry, with bristles of a stiffness [N/m], or as usual, where they have none.
    #[must_use]
    pub fn pressed(&self, stiffness: Option<f64>) -> Self {
        if self.is_dry() {
            return *self;
        }
        Self {
            coulomb: LEAST,
            static_force: LEAST,
            presliding_displacement: LEAST / stiffness.unwrap_or(USUAL_STIFFNESS),
            ..*self
        }
    }

    /// Stiffness of the bristles before they slide [N/m].
    pub fn stiffness(&self) -> f64 {
        let coulomb = self.coulomb + self.pressure_coefficient * REFERENCE_DIFFERENCE;
        coulomb / self.presliding_displacement
    }

    /// g: dry friction at a steady speed [N].
    pub fn steady(&self, speed: f64) -> f64 {
        if self.static_force == self.coulomb {
            return self.coulomb;
        }
        let ratio = speed / self.stribeck_velocity;
        self.coulomb + (self.static_force - self.coulomb) * (-ratio * ratio).exp()
    }

    /// Deflection [m] after a displacement [m] in one direction, from a deflection [m], at a speed [m/s].
    pub fn deflection_after(&self, deflection: f64, displacement: f64, speed: f64) -> f64 {
        if !self.is_dry() || displacement == 0.0 {
            return deflection;
        }
        let end = (self.steady(speed) / self.stiffness()).copysign(displacement);
        end + (deflection - end) * (-displacement.abs() / end.abs()).exp()
    }

    /// Force that resists extension [N] at a deflection [m] and speed [m/s].
    pub fn force(&self, deflection: f64, speed: f64) -> f64 {
        if self.is_dry() {
            self.stiffness() * deflection + self.viscous * speed
        } else {
            self.viscous * speed
        }
    }

    /// dF/dx [N/m] at a deflection [m] while moving in the direction of `speed` [m/s]: none once sliding.
    pub fn tangent_stiffness(&self, deflection: f64, speed: f64) -> f64 {
        if !self.is_dry() {
            return 0.0;
        }
        let stiffness = self.stiffness();
        let share = stiffness * deflection / self.steady(speed);
        stiffness * (1.0 - share.copysign(deflection * speed)).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEALS: SealFriction = SealFriction {
        coulomb: 10.0,
        static_force: 14.0,
        stribeck_velocity: 0.01,
        viscous: 50.0,
        presliding_displacement: 2e-5,
        pressure_coefficient: 0.0,
    };

    #[test]
    fn steady_sliding_gives_coulomb_and_viscous_friction() {
        let z = SEALS.deflection_after(0.0, 0.01, 0.2);
        assert!((SEALS.force(z, 0.2) - (10.0 + 50.0 * 0.2)).abs() < 1e-9);
        let back = SEALS.deflection_after(z, -0.01, -0.2);
        assert!((SEALS.force(back, -0.2) + 20.0).abs() < 1e-9);
        assert!(SEALS.tangent_stiffness(z, 0.2) < 1e-6 * SEALS.stiffness());
    }

    #[test]
    fn it_breaks_away_at_static_friction_and_starts_like_a_spring() {
        let z = SEALS.deflection_after(0.0, 0.001, 1e-5);
        assert!((SEALS.force(z, 0.0) - 14.0).abs() < 1e-3);
        let small = SEALS.deflection_after(0.0, 1e-9, 1e-6);
        assert!((SEALS.force(small, 0.0) / (SEALS.stiffness() * 1e-9) - 1.0).abs() < 1e-4);
        assert!((SEALS.tangent_stiffness(0.0, 1.0) / SEALS.stiffness() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_closed_form_equals_its_differential_equation() {
        let (mut z, n) = (-8e-6, 200_000);
        let (displacement, speed) = (6e-5, 0.004);
        let dx = displacement / f64::from(n);
        for _ in 0..n {
            let rate = |z: f64| 1.0 - SEALS.stiffness() * z / SEALS.steady(speed);
            let middle = z + 0.5 * dx * rate(z);
            z += dx * rate(middle);
        }
        let closed = SEALS.deflection_after(-8e-6, displacement, speed);
        assert!((closed / z - 1.0).abs() < 1e-8, "{closed} {z}");
    }

    #[test]
    fn a_closed_loop_of_motion_only_ever_takes_work() {
        let (mut z, mut x, mut work) = (0.0, 0.0f64, 0.0);
        for i in 0..20_000 {
            let next = 3e-5 * (f64::from(i) * 0.01).sin();
            let (before, d) = (SEALS.force(z, 0.0), next - x);
            z = SEALS.deflection_after(z, d, d * 100.0);
            work += 0.5 * (before + SEALS.force(z, 0.0)) * d;
            x = next;
        }
        assert!(work > 1e-3, "{work}");
    }

    #[test]
    fn pressure_raises_the_level_and_not_the_stiffness() {
        let seals = SealFriction {
            pressure_coefficient: 3e-5,
            ..SEALS
        };
        let pressed = seals.under(-2e5);
        assert!((pressed.stiffness() / seals.stiffness() - 1.0).abs() < 1e-14);
        let z = pressed.deflection_after(0.0, 0.01, 0.2);
        assert!((seals.force(z, 0.2) - (10.0 + 3e-5 * 2e5 + 50.0 * 0.2)).abs() < 1e-9);
        let breakaway = pressed.deflection_after(0.0, 0.001, 1e-5);
        assert!((seals.force(breakaway, 0.0) - (14.0 + 6.0)).abs() < 1e-3);
        // The whole of it may come from the pressure; without any it is gone.
        let bare = SealFriction {
            pressure_coefficient: 3e-5,
            ..SealFriction::NONE
        };
        assert!(bare.is_dry() && !bare.under(0.0).is_dry());
        assert!((bare.stiffness() - 3.0 / 5e-5).abs() < 1e-9);
    }

    #[test]
    fn seals_without_dry_friction_have_bristles_that_stay_as_they_are() {
        let viscous = SealFriction {
            coulomb: 0.0,
            static_force: 0.0,
            ..SEALS
        };
        assert_eq!(viscous.deflection_after(1e-6, 0.01, 0.2), 1e-6);
        assert_eq!(SEALS.deflection_after(1e-6, 0.0, 0.2), 1e-6);
    }
}

//! Friction of the slide's seals, which creep.
//!
//! ```text
//! F = F_c z + b v,    dz/dt = (v - |v| z)/z_p - z/T                (Dahl 1968; the last term: rubber relaxes, Ferry 1980, chapter 1)
//! ```
//!
//! F friction on the slide along the speed v of the arm against it [N], F_c Coulomb force [N], z share of it that is built up [1], z_p presliding [m],
//! b viscous coefficient [N s/m], T relaxation time [s]. Leaves out: that friction grows with pressure, and Stribeck's dip.

/// Seals of the slide.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seal {
    pub coulomb: f64,
    pub presliding: f64,
    pub viscous: f64,
    pub relaxation: f64,
}

impl Seal {
    /// Share built up after a step [s] at a speed [m/s].
    pub(super) fn advanced(self, share: f64, speed: f64, step: f64) -> f64 {
        share + step * ((speed - speed.abs() * share) / self.presliding - share / self.relaxation)
    }

    /// Friction [N].
    pub(super) fn force(self, share: f64, speed: f64) -> f64 {
        self.coulomb * share + self.viscous * speed
    }
}

#[cfg(test)]
mod tests {
    use super::Seal;

    #[test]
    fn it_builds_up_to_coulomb_s_force_and_relaxes_at_rest() {
        let seal = Seal {
            coulomb: 5.0,
            presliding: 5e-5,
            viscous: 0.0,
            relaxation: 0.5,
        };
        let mut share = 0.0;
        for _ in 0..100_000 {
            share = seal.advanced(share, 0.1, 1e-5);
        }
        assert!((seal.force(share, 0.1) / 5.0 - 1.0).abs() < 2e-3);
        for _ in 0..50_000 {
            share = seal.advanced(share, 0.0, 1e-5);
        }
        assert!((seal.force(share, 0.0) - 5.0 * (-1f64).exp()).abs() < 0.02);
    }
}

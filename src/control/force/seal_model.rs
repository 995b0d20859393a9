//! The seals' nominal friction as a controller has it, now and after a motion that is predicted.
//!
//! The bristles' deflection depends on the path alone (`physics::seal_friction`), so a predicted path gives the coming friction, a reversal included:
//! x(t + h) - x(t) = v h + a h^2 / 2, in two legs if v + a h changes its sign on the way.

use crate::physics::seal_friction::SealFriction;

/// The model with its state.
#[derive(Debug, Clone)]
pub(super) struct SealModel {
    seals: SealFriction,
    deflection: f64,
}

impl SealModel {
    /// Nominal seals, relaxed.
    pub(super) fn new(seals: SealFriction) -> Self {
        Self {
            seals,
            deflection: 0.0,
        }
    }

    /// Takes a motion that was made [m] at a speed [m/s].
    pub(super) fn moved(&mut self, displacement: f64, speed: f64) {
        self.deflection = self
            .seals
            .deflection_after(self.deflection, displacement, speed);
    }

    /// Dry friction that resists extension [N].
    pub(super) fn dry(&self) -> f64 {
        self.dry_at(self.deflection)
    }

    /// Viscous friction that resists extension [N] at a speed [m/s].
    pub(super) fn viscous(&self, speed: f64) -> f64 {
        self.seals.viscous * speed
    }

    fn dry_at(&self, deflection: f64) -> f64 {
        self.seals.force(deflection, 0.0)
    }

    /// Dry friction [N] after a time [s] at a speed [m/s] and acceleration [m/s2].
    pub(super) fn dry_ahead(&self, speed: f64, acceleration: f64, time: f64) -> f64 {
        let path = |t: f64| t * (speed + 0.5 * acceleration * t);
        let reversal = -speed / acceleration;
        let mut deflection = self.deflection;
        let mut from = 0.0;
        if reversal > 0.0 && reversal < time {
            deflection = self
                .seals
                .deflection_after(deflection, path(reversal), 0.5 * speed);
            from = reversal;
        }
        let rest = path(time) - path(from);
        deflection = self
            .seals
            .deflection_after(deflection, rest, rest / (time - from));
        self.dry_at(deflection)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEALS: SealFriction = SealFriction {
        coulomb: 10.0,
        static_force: 10.0,
        ..SealFriction::NONE
    };

    #[test]
    fn a_reversal_within_the_time_is_foreseen() {
        let mut model = SealModel::new(SEALS);
        model.moved(0.01, 0.01);
        assert!((model.dry() - 10.0).abs() < 1e-9);
        // 10 mm/s, back at the same place after 20 ms, a millimetre beyond after 40 ms.
        let (speed, acceleration) = (0.01, -1.0);
        let mut truth = model.clone();
        for i in 0..40_000 {
            let t = f64::from(i) * 1e-6;
            let moved = 1e-6 * (speed + acceleration * (t + 5e-7));
            truth.moved(moved, moved * 1e6);
        }
        let ahead = model.dry_ahead(speed, acceleration, 0.04);
        assert!(
            (ahead - truth.dry()).abs() < 1e-3,
            "{ahead} {}",
            truth.dry()
        );
        assert!(ahead < -9.0);
        assert!(model.dry_ahead(speed, 0.0, 0.04) > 9.99);
    }
}

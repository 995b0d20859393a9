//! Deflection of the seals' bristles, from a stroke that is only known within its noise.
//!
//! The deflection depends on the path, and a noisy stroke has a long path even at rest. So the path is counted from turning points only: while
//! the motion goes on in its direction the turning point is carried along; a step back is laid from it by the closed form of `seal_friction`,
//! without being counted; once it is larger than noise can be, it is the new direction and its start the turning point.
//!
//! Deflections are over the presliding displacement: -1..=1 without Stribeck's effect.

use crate::physics::seal_friction::SealFriction;

/// Deflection at a displacement from a turning point, and its derivatives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Deflection {
    /// Over the presliding displacement [1].
    pub(super) value: f64,
    /// By the deflection at the turning point [1].
    pub(super) by_deflection: f64,
    /// By the displacement [1/m].
    pub(super) by_displacement: f64,
    /// By the relative error of the presliding displacement [1].
    pub(super) by_presliding: f64,
}

/// Trajectory of the motion, determined from the nominal stroke.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// On in the same direction, or turned: carry the turning point along.
    On,
    /// Back for the first time since it went on.
    Halted,
    /// Still back by less than can be distinguished from noise.
    Undecided,
}

/// The seals and the direction in which they were last seen to move.
#[derive(Debug, Clone)]
pub(super) struct Seals {
    friction: SealFriction,
    /// 1 extending, -1 retracting.
    direction: f64,
    /// Whether it has stepped back since it went on.
    halted: bool,
}

impl Seals {
    pub(super) fn new(friction: SealFriction) -> Self {
        Self {
            friction,
            direction: 1.0,
            halted: false,
        }
    }

    /// Largest deflection there can be [1].
    fn largest(&self) -> f64 {
        self.friction.steady(0.0) / self.friction.coulomb
    }

    /// Limits a deflection to what there can be.
    pub(super) fn limited(&self, deflection: f64) -> f64 {
        if self.friction.is_dry() {
            deflection.clamp(-self.largest(), self.largest())
        } else {
            0.0
        }
    }

    /// Meaning of a displacement from the turning point [m] when noise can make up to `noise` [m] of a step back, and a motion that has halted
    /// is taken to go on from `resume` [m] on.
    pub(super) fn way(&mut self, displacement: f64, noise: f64, resume: f64) -> Way {
        let onward = self.direction * displacement;
        if onward < -noise {
            self.direction = -self.direction;
        } else if onward < 0.0 || (self.halted && onward < resume) {
            let first = !self.halted;
            self.halted = true;
            return if first { Way::Halted } else { Way::Undecided };
        }
        self.halted = false;
        Way::On
    }

    /// Deflection after a displacement [m] at a speed [m/s].
    pub(super) fn after(&self, deflection: f64, displacement: f64, speed: f64) -> Deflection {
        let still = Deflection {
            value: deflection,
            by_deflection: 1.0,
            by_displacement: 0.0,
            by_presliding: 0.0,
        };
        if !self.friction.is_dry() {
            return Deflection {
                value: 0.0,
                by_deflection: 0.0,
                ..still
            };
        }
        let presliding = self.friction.presliding_displacement;
        let level = self.friction.steady(speed) / self.friction.coulomb;
        let direction = if displacement == 0.0 {
            self.direction
        } else {
            displacement.signum()
        };
        let end = direction * level;
        let path = displacement.abs() / (presliding * level);
        let left = (-path).exp();
        let rest = (deflection - end) * left;
        Deflection {
            value: end + rest,
            by_deflection: left,
            by_displacement: -rest * direction / (presliding * level),
            by_presliding: rest * path,
        }
    }

    /// Dry friction at a deflection of 1, resisting extension [N].
    pub(super) fn dry(&self) -> f64 {
        self.friction.coulomb
    }

    /// Viscous coefficient [N s/m].
    pub(super) fn viscous(&self) -> f64 {
        self.friction.viscous
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRICTION: SealFriction = SealFriction {
        coulomb: 10.0,
        static_force: 13.0,
        stribeck_velocity: 0.01,
        viscous: 0.0,
        presliding_displacement: 5e-5,
        pressure_coefficient: 0.0,
    };

    #[test]
    fn it_is_the_closed_form_of_the_device_and_its_derivatives() {
        let seals = Seals::new(FRICTION);
        for (start, displacement, speed) in [(0.7, -3e-5, -0.005), (-0.2, 8e-5, 0.02)] {
            let after = seals.after(start, displacement, speed);
            let z = FRICTION.deflection_after(start * 5e-5, displacement, speed) / 5e-5;
            assert!((after.value - z).abs() < 1e-12);
            let by = |d: f64, x: f64| seals.after(start + d, displacement + x, speed).value;
            assert!(((by(1e-6, 0.0) - by(-1e-6, 0.0)) / 2e-6 - after.by_deflection).abs() < 1e-6);
            let slope = (by(0.0, 1e-10) - by(0.0, -1e-10)) / 2e-10;
            assert!((slope / after.by_displacement - 1.0).abs() < 1e-5);
            let longer = |relative: f64| {
                let presliding_displacement = 5e-5 * (1.0 + relative);
                let seals = Seals::new(SealFriction {
                    presliding_displacement,
                    ..FRICTION
                });
                seals.after(start, displacement, speed).value
            };
            let slope = (longer(1e-5) - longer(-1e-5)) / 2e-5;
            assert!((slope - after.by_presliding).abs() < 1e-6);
        }
    }

    #[test]
    fn noise_at_rest_does_not_wear_the_deflection_down() {
        let mut seals = Seals::new(FRICTION);
        let (mut turning, mut deflection) = (0.0, -0.6);
        let (mut path, mut last) = (0.0, 0.0f64);
        for i in 0..10_000 {
            let stroke = 2e-6 * (f64::from(i) * 0.7).sin();
            path += (stroke - last).abs();
            last = stroke;
            if seals.way(stroke - turning, 1e-5, 0.0) == Way::On {
                deflection = seals.after(deflection, stroke - turning, 0.0).value;
                turning = stroke;
            }
        }
        assert!(path > 100.0 * FRICTION.presliding_displacement);
        assert!((deflection + 0.6).abs() < 0.1, "{deflection}");
    }
}

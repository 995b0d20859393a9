//! A mass that slides along the flange's z: what it does to the flange beyond what it does at stroke zero.
//!
//! ```text
//! f = -m (A(s) + 2 w x s' + s'' - A(0)),    n = -m (c + s) x (A(s) + 2 w x s' + s'') + m c x A(0),    A(s) = A + w' x (c + s) + w x (w x (c + s))
//! ```
//!
//! f, n force and moment on the flange about its origin, m the mass, c its centre at stroke zero, s stroke, all along the flange's z; A acceleration of the flange
//! less gravity, w its angular velocity. Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, sec. 5.3, a prismatic joint in the recursion.

use super::outside::OutsideWrench;
use crate::arm::dynamics::LinkMotion;
use glam::DVec3;

/// A compact mass on a slide along the flange's z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlidingMass {
    /// Mass [kg].
    pub mass: f64,
    /// Distance of its centre from the flange's origin at stroke zero [m].
    pub centre: f64,
}

impl SlidingMass {
    /// What it does at a stroke [m], its rate [m/s] and acceleration [m/s2], beyond what it does at rest at stroke zero.
    #[must_use]
    pub fn beyond_retracted(
        &self,
        flange: &LinkMotion,
        [stroke, rate, acceleration]: [f64; 3],
    ) -> OutsideWrench {
        let (spin, spin_rate) = (flange.spin, flange.spin_rate);
        let of = |centre: DVec3| {
            flange.acceleration + spin_rate.cross(centre) + spin.cross(spin.cross(centre))
        };
        let retracted = DVec3::Z * self.centre;
        let out = DVec3::Z * (self.centre + stroke);
        let slides = 2.0 * spin.cross(DVec3::Z * rate) + DVec3::Z * acceleration;
        let (with, without) = (-self.mass * (of(out) + slides), -self.mass * of(retracted));
        OutsideWrench {
            force: with - without,
            moment: out.cross(with) - retracted.cross(without),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flange that turns about its x at a constant rate under gravity, a mass that slides out at a constant rate: its motion in the world twice differenced.
    #[test]
    fn force_is_that_of_the_motion_in_the_world() {
        let (rate, gravity) = (0.7, DVec3::new(0.0, 0.0, -9.81));
        let slide = SlidingMass {
            mass: 3.0,
            centre: 0.1,
        };
        let stroke = |t: f64| 0.02 + 0.3 * t + 0.5 * t * t;
        let turned = |t: f64| glam::DQuat::from_rotation_x(rate * t);
        let centre = |t: f64, stroke: f64| turned(t) * (DVec3::Z * (slide.centre + stroke));
        let acting = |stroke: &dyn Fn(f64) -> f64, t: f64| {
            let step = 1e-4;
            let at = |t: f64| centre(t, stroke(t));
            let second = (at(t + step) - 2.0 * at(t) + at(t - step)) / (step * step);
            let force = -slide.mass * (second - gravity);
            (at(t), force)
        };
        let t = 0.4;
        let flange = LinkMotion {
            acceleration: turned(t).inverse() * -gravity,
            spin: DVec3::X * rate,
            spin_rate: DVec3::ZERO,
        };
        let found = slide.beyond_retracted(&flange, [stroke(t), 0.3 + t, 1.0]);
        let (out, with) = acting(&stroke, t);
        let (retracted, without) = acting(&|_| 0.0, t);
        let force = turned(t).inverse() * (with - without);
        let moment = turned(t).inverse() * (out.cross(with) - retracted.cross(without));
        assert!((found.force - force).length() < 1e-5, "{found:?} {force}");
        assert!((found.moment - moment).length() < 1e-5);
    }
}

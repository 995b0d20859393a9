//! Friction of the ball on the part: it sticks elastically until it slides.
//!
//! ```text
//! F = -k z,   z' = v_t,   |k z| <= mu N
//! ```
//!
//! z tangential deflection [m], v_t speed of the ball along the part's surface [m/s], N contact force [N], k tangential stiffness [N/m]. The deflection beyond
//! what friction holds is slip (return mapping of elastic-plastic friction: Simo, Hughes, Computational Inelasticity, 1998, sec. 1.2).

use glam::DVec3;

/// Tangential stiffness over the normal one [1]. Of the bare contact it is 0.8 (Mindlin, J. Appl. Mech. 16, 1949); the normal one holds the compliance of
/// tool and part besides, which gives mostly that way. Between 0.8 and 6 the running cell is met within 0.06 of the force's noise.
const TANGENTIAL_SHARE: f64 = 2.0;

/// State of deflection.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ContactFriction {
    deflection: DVec3,
    centre: Option<DVec3>,
}

/// Friction along the slide over one step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct AxialFriction {
    /// Force on the ball at the start [N].
    pub force: DVec3,
    /// Its share against extension [N].
    pub start: f64,
    /// Stroke then [m].
    pub stroke: f64,
    /// Its growth with the stroke while the ball sticks [N/m].
    pub stiffness: f64,
    /// Its largest value [N].
    pub most: f64,
}

/// How the ball touches the part.
pub(super) struct BallTouch {
    /// Centre of the ball [m].
    pub centre: DVec3,
    /// Outward normal of the part there.
    pub normal: DVec3,
    /// Force along it [N].
    pub force: f64,
    /// Stiffness of the contact [N/m].
    pub stiffness: f64,
}

impl ContactFriction {
    /// Takes the ball to where its centre is now [m], pressed with a force [N] along a normal with a coefficient of friction against a contact of a
    /// stiffness [N/m]; gives the friction on a slide at a stroke [m]. What carries the ball gives by so much in a step [m/N]: the stiffness is less by
    /// that, or what is known a step late would shake it.
    pub fn advance(
        &mut self,
        touch: &BallTouch,
        coefficient: f64,
        give: f64,
        (slide, stroke): (DVec3, f64),
    ) -> AxialFriction {
        let BallTouch {
            centre,
            normal,
            force,
            stiffness,
        } = *touch;
        let before = self.centre.replace(centre).unwrap_or(centre);
        let most = coefficient * force;
        if most <= 0.0 {
            self.deflection = DVec3::ZERO;
            return AxialFriction::default();
        }
        let stiffness = TANGENTIAL_SHARE * stiffness / (1.0 + TANGENTIAL_SHARE * stiffness * give);
        let moved = self.deflection + centre - before;
        let tangential = moved - normal * moved.dot(normal);
        self.deflection = tangential.clamp_length_max(most / stiffness);
        let along = slide - normal * slide.dot(normal);
        AxialFriction {
            force: -stiffness * self.deflection,
            start: stiffness * self.deflection.dot(slide),
            stroke,
            stiffness: stiffness * along.length_squared(),
            most: most * along.length(),
        }
    }
}

impl AxialFriction {
    /// Force against extension at a stroke [N].
    pub fn at(&self, stroke: f64) -> f64 {
        (self.start + self.stiffness * (stroke - self.stroke)).clamp(-self.most, self.most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NORMAL: DVec3 = DVec3::Z;
    const STIFFNESS: f64 = 2e5;

    fn after(friction: &mut ContactFriction, x: f64, force: f64, slide: DVec3) -> f64 {
        let centre = DVec3::new(x, 0.0, 0.3);
        let touch = BallTouch {
            centre,
            normal: NORMAL,
            force,
            stiffness: STIFFNESS,
        };
        let axial = friction.advance(&touch, 0.15, 0.0, (slide, 0.04));
        axial.at(0.04)
    }

    #[test]
    fn it_sticks_slides_and_turns_round() {
        let lean: f64 = 0.2;
        let slide = DVec3::new(lean.sin(), 0.0, -lean.cos());
        let mut friction = ContactFriction::default();
        assert_eq!(after(&mut friction, 0.0, 100.0, slide), 0.0);
        // A deflection of 10 um, then far beyond 15 N, then back by 20 um.
        let elastic = TANGENTIAL_SHARE * STIFFNESS * 1e-5;
        let stuck = after(&mut friction, 1e-5, 100.0, slide);
        assert!((stuck - elastic * lean.sin()).abs() < 1e-9);
        let slid = after(&mut friction, 1e-3, 100.0, slide);
        assert!((slid - 15.0 * lean.sin()).abs() < 1e-9);
        let back = after(&mut friction, 1e-3 - 2e-5, 100.0, slide);
        assert!((back - (15.0 - 2.0 * elastic) * lean.sin()).abs() < 1e-9);
        // Off the part there is none, and what was deflected is forgotten.
        assert_eq!(after(&mut friction, 0.0, 0.0, slide), 0.0);
        assert_eq!(after(&mut friction, 0.0, 100.0, slide), 0.0);
    }

    #[test]
    fn a_slide_along_the_normal_feels_none() {
        let mut friction = ContactFriction::default();
        after(&mut friction, 0.0, 100.0, -NORMAL);
        assert_eq!(after(&mut friction, 1e-3, 100.0, -NORMAL), 0.0);
    }
}

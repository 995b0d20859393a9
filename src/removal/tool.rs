//! Motion of a turning tool's surface where it touches.
//!
//! ```text
//! v = omega r w x n / |w x n|,   r = R |w x n|                      of a ball, which does not cut at its pole
//! r = r_tip + l sin(alpha),      n . w = -sin(alpha)                of a cone that lies with its flank on the edge
//! ```
//!
//! v velocity of the tool's surface against its mount [m/s], omega angular velocity about w [rad/s], w axis of the spindle from it to the tool's tip, n normal out of the
//! part, R radius of the ball, r_tip that of the cone's tip, l distance of the contact from the tip along the flank [m], alpha half the cone's angle [rad].
//! A belt runs at the speed of its wheel's rim.

use glam::DVec3;

/// Shape of the part of a tool that touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ToolShape {
    /// A ball; its radius [m].
    Ball {
        /// Radius [m].
        radius: f64,
    },
    /// A cone.
    Cone {
        /// Half its angle [rad].
        half_angle: f64,
        /// Length of its flank from the tip [m].
        flank: f64,
        /// Distance of the contact from the tip along the flank [m].
        contact: f64,
        /// Radius of its tip [m].
        tip_radius: f64,
    },
    /// A belt over a wheel; its radius [m].
    Belt {
        /// Radius of the wheel with the belt [m].
        wheel_radius: f64,
    },
}

/// A tool on its spindle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurningTool {
    /// Shape where it touches.
    pub shape: ToolShape,
    /// Sense about the axis from the spindle to the tip: 1 for the right-handed one, which is clockwise as seen along it, -1 for the other.
    pub sense: f64,
    /// Angle of the spindle's axis from that of the slide, towards the direction of travel [rad].
    pub lead: f64,
    /// The same towards the face on the left of the direction of travel [rad].
    pub lean: f64,
}

impl TurningTool {
    /// Axis of the spindle towards the tip, the slide's axis towards the part being `axis`, the normal `normal` and the direction of travel `tangent`.
    pub fn spindle_axis(&self, axis: DVec3, normal: DVec3, tangent: DVec3) -> DVec3 {
        let angle = self.lead.hypot(self.lean);
        if angle == 0.0 {
            return axis;
        }
        let left = normal.cross(tangent);
        let towards = (tangent * self.lead + left * self.lean) / angle;
        let across = (towards - axis * towards.dot(axis)).normalize_or(tangent);
        axis * angle.cos() + across * angle.sin()
    }

    /// Radius about the spindle's axis at which a tool touches a surface of a normal [m].
    pub fn contact_radius(&self, spindle: DVec3, normal: DVec3) -> f64 {
        match self.shape {
            ToolShape::Ball { radius } => radius * spindle.cross(normal).length(),
            ToolShape::Cone {
                half_angle,
                contact,
                tip_radius,
                ..
            } => tip_radius + contact * half_angle.sin(),
            ToolShape::Belt { wheel_radius } => wheel_radius,
        }
    }

    /// Direction in which the tool's surface moves where it touches; none along the axis.
    pub fn surface_direction(&self, spindle: DVec3, normal: DVec3) -> DVec3 {
        // omega w x (-r n)
        -self.sense * spindle.cross(normal).normalize_or_zero()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_4;

    fn tool(shape: ToolShape) -> TurningTool {
        TurningTool {
            shape,
            sense: 1.0,
            lead: 0.0,
            lean: 0.0,
        }
    }

    #[test]
    fn a_ball_does_not_cut_at_its_pole_and_at_full_radius_at_its_equator() {
        let ball = tool(ToolShape::Ball { radius: 5e-3 });
        let (normal, travel) = (DVec3::Z, DVec3::X);
        let upright = ball.spindle_axis(-normal, normal, travel);
        assert!(ball.contact_radius(upright, normal) < 1e-12);
        assert_eq!(ball.surface_direction(upright, normal), DVec3::ZERO);
        let leaning = TurningTool {
            lead: FRAC_PI_4,
            ..ball
        };
        let axis = leaning.spindle_axis(-normal, normal, travel);
        assert!((leaning.contact_radius(axis, normal) - 5e-3 * FRAC_PI_4.sin()).abs() < 1e-12);
    }

    #[test]
    fn the_surface_moves_as_a_point_of_a_turning_body_does() {
        let ball = TurningTool {
            lead: 0.3,
            lean: -0.5,
            ..tool(ToolShape::Ball { radius: 5e-3 })
        };
        let (normal, travel) = (DVec3::Z, DVec3::X);
        let spindle = ball.spindle_axis(-normal, normal, travel);
        let turned = glam::DQuat::from_axis_angle(spindle, 1e-6) * (normal * -5e-3);
        let velocity = (turned - normal * -5e-3) / 1e-6;
        let found = ball.surface_direction(spindle, normal) * ball.contact_radius(spindle, normal);
        assert!((velocity - found).length() < 1e-8, "{velocity} {found}");
        assert!(
            spindle.dot(travel) > 0.0,
            "leads in the direction of travel"
        );
        // Left of travel along x, the normal up, is y.
        assert!(spindle.y < 0.0);
    }

    #[test]
    fn a_cone_cuts_at_the_radius_of_its_flank_and_a_belt_at_that_of_its_wheel() {
        let cone = tool(ToolShape::Cone {
            half_angle: FRAC_PI_4,
            flank: 10e-3,
            contact: 4e-3,
            tip_radius: 0.5e-3,
        });
        let radius = cone.contact_radius(DVec3::X, DVec3::Z);
        assert!((radius - (0.5e-3 + 4e-3 * FRAC_PI_4.sin())).abs() < 1e-15);
        let belt = tool(ToolShape::Belt {
            wheel_radius: 0.015,
        });
        assert_eq!(belt.contact_radius(DVec3::X, DVec3::Z), 0.015);
    }

    #[test]
    fn a_spindle_leads_and_leans_by_its_angles() {
        let (normal, travel) = (DVec3::Z, DVec3::X);
        let left = normal.cross(travel);
        let leaning = TurningTool {
            lead: 0.03,
            lean: -0.04,
            ..tool(ToolShape::Ball { radius: 5e-3 })
        };
        let axis = leaning.spindle_axis(-normal, normal, travel);
        assert!((axis.length() - 1.0).abs() < 1e-12);
        assert!((axis.angle_between(-normal) - 0.05).abs() < 1e-9);
        let ratio = axis.dot(left) / axis.dot(travel);
        assert!(
            (ratio + 4.0 / 3.0).abs() < 1e-9 && axis.dot(travel) > 0.0,
            "{axis}"
        );
    }
}

//! Shape of a chamfered edge and of the burr on it, by their sections.
//!
//! ```text
//! A = d^2 tan(phi/2),   c = d / cos(phi/2)             a flat across the bisector; of a right angle A = d^2, c = d sqrt(2)
//! A_b = b h / 2,        h_r = h sqrt(1 - q / A_b)       what is left of a burr of which a section q was taken, its shape kept
//! ```
//!
//! A section of the chamfer [m2], d its depth along the bisector [m], c its leg [m], phi angle of the part between its faces [rad], h height of the burr [m],
//! b thickness of its root [m]. Leaves out: a chamfer that is not square to the bisector.

/// Depth along the bisector [m] of a chamfer of a section [m2] on an edge of an angle [rad].
pub fn depth(section: f64, angle: f64) -> f64 {
    (section / (0.5 * angle).tan()).sqrt()
}

/// Leg [m] of a chamfer of a section [m2] on an edge of an angle [rad].
pub fn leg(section: f64, angle: f64) -> f64 {
    depth(section, angle) / (0.5 * angle).cos()
}

/// Section [m2] of a chamfer of a leg [m] on an edge of an angle [rad].
pub fn section_of_leg(leg: f64, angle: f64) -> f64 {
    let depth = leg * (0.5 * angle).cos();
    depth * depth * (0.5 * angle).tan()
}

/// Section of a burr of a height and a root thickness [m2].
pub fn burr_section(height: f64, root: f64) -> f64 {
    0.5 * height * root
}

/// Height [m] of the part of a burr that is left, of its height and section before [m, m2] and the section taken [m2].
pub fn residual_height(height: f64, section: f64, taken: f64) -> f64 {
    if taken >= section {
        return 0.0;
    }
    height * (1.0 - taken / section).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, SQRT_2};

    #[test]
    fn a_right_angle_gives_the_square_of_the_depth_and_its_diagonal() {
        let section = 0.09e-6;
        assert!((depth(section, FRAC_PI_2) - 0.3e-3).abs() < 1e-15);
        assert!((leg(section, FRAC_PI_2) - SQRT_2 * 0.3e-3).abs() < 1e-15);
        assert!((section_of_leg(leg(section, 1.2), 1.2) - section).abs() < 1e-20);
    }

    #[test]
    fn a_quarter_left_of_a_burr_s_section_is_half_its_height() {
        let section = burr_section(0.4e-3, 0.1e-3);
        let left = residual_height(0.4e-3, section, 0.75 * section);
        assert!((left - 0.2e-3).abs() < 1e-15, "{left}");
        assert_eq!(residual_height(0.4e-3, section, section), 0.0);
        assert_eq!(residual_height(0.0, 0.0, 0.0), 0.0);
    }
}

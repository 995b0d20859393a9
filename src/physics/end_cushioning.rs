//! Damping at either end of the stroke that the piston meets as it comes near, and not as it leaves.
//!
//! ```text
//! F = -c (1 - d / l) v     for d < l and towards the end,     0 otherwise
//! ```
//!
//! F along extension [N], c damping at the very end [N s/m], l length [m], d distance from the end, 0 beyond it [m], v speed of extension [m/s].
//!
//! A pneumatic cushion traps air that leaves through a needle valve; a check valve lets it in again at once (ISO 15552 cylinders).
//! Leaves out: the spring of the trapped air.

/// A cushion at each end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndCushioning {
    /// Damping at the very end of the stroke [N s/m]; 0 for no cushions.
    pub damping: f64,
    /// Distance from the end at which it begins [m].
    pub length: f64,
}

impl EndCushioning {
    /// No cushions.
    pub const NONE: Self = Self {
        damping: 0.0,
        length: 5e-3,
    };

    /// Whether there is none.
    pub fn is_none(&self) -> bool {
        self.damping == 0.0
    }

    /// Which cushion is being pressed at a stroke [m] and speed [m/s]: -1 the retracted end's, 1 the extended one's, 0 none.
    pub fn pressed(&self, full_stroke: f64, stroke: f64, speed: f64) -> i8 {
        if self.is_none() {
            0
        } else if speed < 0.0 && stroke < self.length {
            -1
        } else {
            i8::from(speed > 0.0 && full_stroke - stroke < self.length)
        }
    }

    /// Damping of the cushion of an end [N s/m] at a stroke [m], as it holds while it is pressed.
    pub fn damping_of(&self, end: i8, full_stroke: f64, stroke: f64) -> f64 {
        let distance = match end {
            -1 => stroke,
            1 => full_stroke - stroke,
            _ => return 0.0,
        };
        self.damping * (1.0 - distance.max(0.0) / self.length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUSHION: EndCushioning = EndCushioning {
        damping: 800.0,
        length: 8e-3,
    };

    fn damping(stroke: f64, speed: f64) -> f64 {
        CUSHION.damping_of(CUSHION.pressed(0.05, stroke, speed), 0.05, stroke)
    }

    #[test]
    fn it_falls_linearly_to_nothing_at_its_length_and_lets_the_piston_leave() {
        for (distance, expected) in [(0.0, 800.0), (2e-3, 600.0), (8e-3, 0.0), (0.02, 0.0)] {
            assert!((damping(distance, -0.1) - expected).abs() < 1e-9);
            assert!((damping(0.05 - distance, 0.1) - expected).abs() < 1e-9);
            assert_eq!(damping(distance, 0.1) + damping(0.05 - distance, -0.1), 0.0);
        }
        // Pressed into the stop it stays what it is at the end.
        assert_eq!(damping(-1e-4, -0.1), 800.0);
    }

    #[test]
    fn a_piston_that_coasts_in_stops_where_the_closed_form_says() {
        // M dv/dx = -c (1 - d/l): v falls by c l / (2 M) over the whole length.
        let (mass, mut stroke, mut speed, dt) = (4.0, 0.042, 1.0, 1e-6);
        while stroke < 0.05 {
            let rate = |stroke, speed| -damping(stroke, speed) * speed / mass;
            let middle = speed + 0.5 * dt * rate(stroke, speed);
            let between = stroke + 0.5 * dt * speed;
            stroke += dt * middle;
            speed += dt * rate(between, middle);
        }
        assert!((speed - (1.0 - 800.0 * 8e-3 / 8.0)).abs() < 1e-4, "{speed}");
    }
}

//! Stroke, speed and acceleration from a coarse stroke and a biased accelerometer.
//!
//! ```text
//! x' = v,  v' = a + b,  b' = 0      corrected by the stroke's error e:  x += (1 - z^3) e,  v += 1.5 (1 - z)^2 (1 + z) e / T,  b += (1 - z)^3 e / T^2
//! ```
//!
//! z = exp(-w T), so that all three poles lie at w [rad/s] (critically damped g-h-k filter, Brookner 1998, with the measured acceleration as input).
//! b takes up the accelerometer's bias, and all of the acceleration if there is no accelerometer.

/// The tracker with its state.
#[derive(Debug, Clone)]
pub(super) struct MotionTracker {
    period: f64,
    gains: [f64; 3],
    bias: f64,
    /// Stroke [m].
    pub stroke: f64,
    /// Speed of extension [m/s].
    pub speed: f64,
    /// Acceleration of extension [m/s2].
    pub acceleration: f64,
    started: bool,
}

impl MotionTracker {
    /// With its poles at `frequency` [rad/s].
    pub(super) fn new(frequency: f64, period: f64) -> Self {
        let z = (-frequency * period).exp();
        Self {
            period,
            gains: [
                1.0 - z * z * z,
                1.5 * (1.0 - z).powi(2) * (1.0 + z) / period,
                (1.0 - z).powi(3) / (period * period),
            ],
            bias: 0.0,
            stroke: 0.0,
            speed: 0.0,
            acceleration: 0.0,
            started: false,
        }
    }

    /// Begins anew at the next stroke.
    pub(super) fn restart(&mut self) {
        self.started = false;
    }

    /// Takes a measured stroke [m] and acceleration [m/s2], and returns how far the piston has moved since the last [m].
    pub(super) fn update(&mut self, stroke: f64, acceleration: f64) -> f64 {
        if !self.started {
            self.started = true;
            self.stroke = stroke;
            (self.speed, self.bias) = (0.0, -acceleration);
            return 0.0;
        }
        let (before, dt) = (self.stroke, self.period);
        let held = acceleration + self.bias;
        self.stroke += dt * (self.speed + 0.5 * dt * held);
        self.speed += dt * held;
        let error = stroke - self.stroke;
        self.stroke += self.gains[0] * error;
        self.speed += self.gains[1] * error;
        self.bias += self.gains[2] * error;
        self.acceleration = acceleration + self.bias;
        self.stroke - before
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_biased_accelerometer_and_a_coarse_stroke_give_the_speed() {
        let mut tracker = MotionTracker::new(40.0, 1e-3);
        let (w, a) = (3.0, 0.01);
        let mut worst = 0.0f64;
        for i in 0..6000 {
            let t = f64::from(i) * 1e-3;
            let stroke = 0.02 + a * (w * t).sin();
            tracker.update(
                (stroke / 2e-5).round() * 2e-5,
                0.3 - a * w * w * (w * t).sin(),
            );
            if t > 1.0 {
                worst = worst.max((tracker.speed - a * w * (w * t).cos()).abs());
            }
        }
        // 30 mm/s, from steps of 20 um.
        assert!(worst < 5e-4, "{worst}");
    }

    #[test]
    fn without_an_accelerometer_the_bias_is_the_acceleration() {
        let mut tracker = MotionTracker::new(40.0, 1e-3);
        for i in 0..2000 {
            let t = f64::from(i) * 1e-3;
            tracker.update(0.5 * 0.2 * t * t, 0.0);
        }
        assert!((tracker.acceleration - 0.2).abs() < 1e-6);
        assert!((tracker.speed - 0.2 * 1.999).abs() < 1e-6);
    }
}

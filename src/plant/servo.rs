//! A joint's servo as its owner describes it: the motor follows its command as a critically damped second-order lag.
//!
//!     q'' = w^2 (u - q) - 2 w q',   w = 2 pi f
//!
//! Exact for commands that are linear between samples (Franklin, Powell, Workman, Digital Control, 1998, sec. 4.3: first-order hold).

use std::f64::consts::TAU;

/// Angles of one motor.
#[derive(Debug, Clone, PartialEq)]
pub struct Followed {
    /// Angle [rad].
    pub angle: Vec<f64>,
    /// Its acceleration [rad/s2].
    pub acceleration: Vec<f64>,
}

/// What a servo of a bandwidth [Hz] makes of commands [rad] at times [s], from rest on the first one.
pub fn follow(time: &[f64], command: &[f64], bandwidth: f64) -> Followed {
    let w = TAU * bandwidth;
    let mut angle = Vec::with_capacity(command.len());
    let mut acceleration = Vec::with_capacity(command.len());
    let (mut q, mut v) = (command.first().copied().unwrap_or(0.0), 0.0);
    for i in 0..command.len() {
        if i > 0 {
            let h = time[i] - time[i - 1];
            let slope = (command[i] - command[i - 1]) / h;
            // Against the steady answer to a ramp, u - 2 slope/w, the error decays as (a + b t) exp(-w t).
            let behind = command[i - 1] - 2.0 * slope / w;
            let a = q - behind;
            let b = v - slope + w * a;
            let decay = (-w * h).exp();
            q = behind + slope * h + (a + b * h) * decay;
            v = slope + (b - w * (a + b * h)) * decay;
        }
        angle.push(q);
        acceleration.push(w * w * (command[i] - q) - 2.0 * w * v);
    }
    Followed {
        angle,
        acceleration,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_answered_by_the_closed_form() {
        // The step is a ramp over the first sample, so short that it is one.
        let mut time = vec![0.0, 1e-9];
        time.extend((1..500).map(|i| f64::from(i) * 2e-3));
        let command: Vec<f64> = (0..time.len())
            .map(|i| f64::from(u8::from(i > 0)))
            .collect();
        let w = TAU * 25.0;
        for (t, q) in time.iter().zip(follow(&time, &command, 25.0).angle) {
            let exact = 1.0 - (1.0 + w * t) * (-w * t).exp();
            assert!((q - exact).abs() < 1e-6, "{t}: {q} against {exact}");
        }
    }

    #[test]
    fn a_ramp_is_followed_two_over_w_behind() {
        let time: Vec<f64> = (0..500).map(|i| f64::from(i) * 2e-3).collect();
        let followed = follow(&time, &time, 10.0);
        let lag = time[499] - followed.angle[499];
        assert!((lag - 2.0 / (TAU * 10.0)).abs() < 1e-9);
        assert!(followed.acceleration[499].abs() < 1e-9);
    }
}

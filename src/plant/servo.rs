//! The motion of a joint's motor in a recording: it follows its command as a critically damped lag (`physics::command_lag`), and as its encoder shows.

use crate::physics::command_lag::CommandLag;
use nalgebra::{Matrix3, Vector3};

/// Angles of one motor.
#[derive(Debug, Clone, PartialEq)]
pub struct Followed {
    /// Angle [rad].
    pub angle: Vec<f64>,
    /// Its acceleration [rad/s2].
    pub acceleration: Vec<f64>,
}

/// Response of a servo of a bandwidth [Hz] to commands [rad] at times [s], from rest on the first one; one of no lag obeys.
pub fn follow(time: &[f64], command: &[f64], bandwidth: f64) -> Followed {
    if bandwidth.is_infinite() {
        return Followed {
            angle: command.to_vec(),
            acceleration: (0..command.len())
                .map(|i| curvature(time, command, i))
                .collect(),
        };
    }
    let mut lag = CommandLag::at_rest(bandwidth, command.first().copied().unwrap_or(0.0));
    let mut angle = vec![lag.position; command.len()];
    let mut acceleration = vec![0.0; command.len()];
    for i in 1..command.len() {
        acceleration[i] = lag.advance(command[i], time[i] - time[i - 1]);
        angle[i] = lag.position;
    }
    Followed {
        angle,
        acceleration,
    }
}

/// Second derivative at a sample; none at the ends, where everything rests.
pub(super) fn curvature(time: &[f64], values: &[f64], i: usize) -> f64 {
    if i == 0 || i + 1 >= values.len() {
        return 0.0;
    }
    let [before, after] = [time[i] - time[i - 1], time[i + 1] - time[i]];
    let rise = (values[i + 1] - values[i]) / after - (values[i] - values[i - 1]) / before;
    rise * 2.0 / (before + after)
}

/// Half the span over which what an encoder shows beside its command is smoothed [s]: servos hardly swing faster.
const SMOOTHED: f64 = 0.009;
/// Standard deviations of an encoder's noise by which what it shows must move before its motor is taken to have moved. To shake a motor by its encoder's
/// noise would loosen every seal that sticks behind it.
const UNMOVED: f64 = 2.0;

/// Time over which the motor is taken to where its encoder has it on average while it does not leave that noise [s].
const SETTLED: f64 = 0.06;

/// Motion of a motor shown by an encoder [rad] with noise of a standard deviation [rad], which a servo without loads would have moved as `led`: its
/// departure from that fitted by a parabola about each sample (Savitzky, Golay, Anal. Chem. 36, 1964), and followed with as much play as noise makes, forward
/// and backward in time, so that what follows is not late on the mean. Values that are absent count for nothing.
pub fn shown(time: &[f64], led: &Followed, encoder: &[f64], noise: f64) -> Followed {
    let pairs = encoder.iter().zip(&led.angle);
    let away: Vec<f64> = pairs.map(|(encoder, led)| encoder - led).collect();
    let fitted: Vec<[f64; 2]> = (0..time.len()).map(|i| parabola(time, &away, i)).collect();
    let forward = with_play(time, &fitted, noise, 0..time.len());
    let backward = with_play(time, &fitted, noise, (0..time.len()).rev());
    let both = forward.iter().zip(&backward).zip(&led.angle);
    let bends = fitted.iter().zip(&led.acceleration);
    Followed {
        angle: both.map(|((a, b), led)| led + 0.5 * (a + b)).collect(),
        acceleration: bends.map(|([_, bend], led)| led + bend).collect(),
    }
}

/// Departures [rad] followed with the play of a noise [rad], in an order of the samples.
fn with_play(
    time: &[f64],
    fitted: &[[f64; 2]],
    noise: f64,
    order: impl Iterator<Item = usize>,
) -> Vec<f64> {
    let mut followed = vec![0.0; time.len()];
    let mut before: Option<(f64, f64)> = None;
    for i in order {
        let [value, _] = fitted[i];
        let held = before.map_or(value, |(at, held)| {
            let mean = held + (value - held) * ((time[i] - at).abs() / SETTLED).min(1.0);
            mean.clamp(value - UNMOVED * noise, value + UNMOVED * noise)
        });
        followed[i] = held;
        before = Some((time[i], held));
    }
    followed
}

/// Value and second derivative at a sample of the parabola through those about it.
fn parabola(time: &[f64], values: &[f64], i: usize) -> [f64; 2] {
    let from = time.partition_point(|t| *t < time[i] - SMOOTHED);
    let to = time.partition_point(|t| *t <= time[i] + SMOOTHED);
    let mut normal = Matrix3::zeros();
    let mut right = Vector3::zeros();
    for j in from..to {
        if values[j].is_finite() {
            let u = (time[j] - time[i]) / SMOOTHED;
            let row = Vector3::new(1.0, u, u * u);
            normal += row * row.transpose();
            right += row * values[j];
        }
    }
    // Too few for a parabola: as it was read, or as it was led.
    let Some(fit) = normal.cholesky().map(|c| c.solve(&right)) else {
        return [
            if values[i].is_finite() {
                values[i]
            } else {
                0.0
            },
            0.0,
        ];
    };
    [fit[0], 2.0 * fit[2] / (SMOOTHED * SMOOTHED)]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

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
    fn an_encoder_shows_what_pushed_its_motor_aside_and_its_noise_moves_nothing() {
        let time: Vec<f64> = (0..500).map(|i| f64::from(i) * 4e-3).collect();
        let led = follow(&time, &time, f64::INFINITY);
        let pushed = |t: f64| 1e-4 * (-(((t - 1.0) / 0.03).powi(2))).exp();
        // Noise of two values in turn, and one reading that is lost.
        let noise = |i: usize| if i.is_multiple_of(3) { 2e-6 } else { -1e-6 };
        let mut encoder: Vec<f64> = (0..500)
            .map(|i| time[i] + pushed(time[i]) + noise(i))
            .collect();
        encoder[100] = f64::NAN;
        let shown = shown(&time, &led, &encoder, 2e-6);
        for (i, t) in time.iter().enumerate() {
            let error = shown.angle[i] - t - pushed(*t);
            assert!(error.abs() < 1e-5, "{i}: {error}");
        }
        // Nothing is still but for a tenth of the noise, and what creeps is followed without a lag.
        let still: Vec<f64> = (20..90).map(|i| shown.angle[i] - time[i]).collect();
        assert!(
            still
                .windows(2)
                .all(|pair| (pair[0] - pair[1]).abs() < 2e-7)
        );
    }

    #[test]
    fn what_comes_back_slowly_is_followed_without_a_lag() {
        let time: Vec<f64> = (0..500).map(|i| f64::from(i) * 4e-3).collect();
        let led = follow(&time, &time, f64::INFINITY);
        let back = |t: f64| 1e-4 * (-t / 0.4).exp();
        let noise = |i: usize| if i.is_multiple_of(3) { 2e-6 } else { -1e-6 };
        let encoder: Vec<f64> = (0..500)
            .map(|i| time[i] + back(time[i]) + noise(i))
            .collect();
        let shown = shown(&time, &led, &encoder, 2e-6);
        let errors = (50..450).map(|i| shown.angle[i] - time[i] - back(time[i]));
        let mean = errors.sum::<f64>() / 400.0;
        assert!(mean.abs() < 3e-7, "{mean}");
    }
}

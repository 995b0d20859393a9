//! A measured motion that a simulated piston is held to.
//!
//! ```text
//! F_g = M (w^2 (x_m - x) + 2 w (v_m - v)),   w = 2 pi 10 Hz
//! ```
//!
//! x_m and v_m measured motion. A model that lacks something soon meets impacts at other times than the device did, and from then on every
//! difference is one of timing. Held to the measured motion it stays beside it, and F_g is the force that it lacks. (Nudging, or synchronisation:
//! Abarbanel et al., SIAM J. Appl. Dyn. Syst. 8, 2009.)
//!
//! x_m and v_m come from a smoother (Rauch, Tung, Striebel, AIAA J. 3, 1965) that joins stroke and acceleration: state x, v; the acceleration
//! measured is the input, its noise the process noise.

/// Rate of the hold [rad/s].
const RATE: f64 = 62.8;

/// Speed below which a piston counts as resting [m/s].
const SLOW: f64 = 0.01;
/// Acceleration by which a speed may change where none was measured [m/s2].
const UNKNOWN: f64 = 20.0;
/// Samples on either side in which a jump of the acceleration is felt.
const NEAR: usize = 3;

/// A motion, one value per sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Nudging {
    /// Stroke as measured, sensor gain included [m].
    pub stroke: Vec<f64>,
    /// Its rate [m/s].
    pub speed: Vec<f64>,
    /// Gain with which the piston is held, 0 to 1: hardly where the acceleration jumps, because how an impact ends decides how the seals are left.
    pub gain: Vec<f64>,
}

impl Nudging {
    /// Stiffness [N/m] and damping [N s/m] of the hold for a mass [kg].
    pub fn gains(mass: f64) -> (f64, f64) {
        (mass * RATE * RATE, 2.0 * mass * RATE)
    }

    /// From times [s], stroke [m] and acceleration [m/s2], NaN where there is no value, and their noise.
    pub fn new(
        time: &[f64],
        stroke: &[f64],
        acceleration: &[f64],
        stroke_noise: f64,
        acceleration_noise: f64,
        touching: impl Fn(usize) -> bool,
    ) -> Self {
        let smooth = smoothed(
            time,
            stroke,
            acceleration,
            [stroke_noise, acceleration_noise],
        );
        let gain = |i: usize| {
            let near = &acceleration[i.saturating_sub(NEAR)..(i + NEAR + 1).min(time.len())];
            // Seven samples of noise range over 2.7 standard deviations.
            let jump = (range(near) / (6.0 * acceleration_noise)).max(0.0);
            1.0 / (1.0 + jump.powi(4))
        };
        // At rest and in contact there is no timing to lose, and to shake a resting piston would undo its seals' friction.
        let moving = |i: usize| {
            let speed = smooth[i][1] / SLOW;
            let square = speed * speed;
            square / (1.0 + square)
        };
        let held = |i: usize| match touching(i) {
            true => 0.0,
            false => moving(i) * gain(i),
        };
        Self {
            gain: (0..time.len()).map(held).collect(),
            stroke: smooth.iter().map(|s| s[0]).collect(),
            speed: smooth.iter().map(|s| s[1]).collect(),
        }
    }
}

/// Largest less smallest of the values that there are; negative infinite where there are none.
fn range(values: &[f64]) -> f64 {
    let known = values.iter().filter(|value| value.is_finite());
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    let (low, high) = known.fold(ends, |(low, high), value| {
        (low.min(*value), high.max(*value))
    });
    high - low
}

/// Stroke [m] and speed [m/s] as estimated, and their covariance: of stroke, of both, of speed.
#[derive(Clone, Copy)]
struct Estimate {
    state: [f64; 2],
    covariance: [f64; 3],
}

impl Estimate {
    /// A time `h` [s] later, under an acceleration [m/s2] that is off by so much squared.
    fn later(self, h: f64, a: f64, q: f64) -> Self {
        let ([x, v], [xx, xv, vv]) = (self.state, self.covariance);
        Self {
            state: [x + h * v + 0.5 * h * h * a, v + h * a],
            covariance: [
                xx + 2.0 * h * xv + h * h * vv + 0.25 * h.powi(4) * q,
                xv + h * vv + 0.5 * h.powi(3) * q,
                vv + h * h * q,
            ],
        }
    }

    /// With a stroke that was measured [m] with a variance.
    fn with(self, stroke: f64, variance: f64) -> Self {
        let ([x, v], [xx, xv, vv]) = (self.state, self.covariance);
        let total = xx + variance;
        let gain = [xx / total, xv / total];
        let innovation = stroke - x;
        Self {
            state: [x + gain[0] * innovation, v + gain[1] * innovation],
            covariance: [
                (1.0 - gain[0]) * xx,
                (1.0 - gain[0]) * xv,
                vv - gain[1] * xv,
            ],
        }
    }

    /// State as the smoothed one a time `h` [s] later has it, which was predicted from here: x + C (s - x_p), C = P F' P_p^-1, F = [[1, h], [0, 1]].
    fn smoothed(self, h: f64, predicted: &Self, later: [f64; 2]) -> [f64; 2] {
        let ([x, v], [xx, xv, vv]) = (self.state, self.covariance);
        let [pxx, pxv, pvv] = predicted.covariance;
        let determinant = pxx * pvv - pxv * pxv;
        if determinant <= 0.0 || determinant.is_nan() {
            return self.state;
        }
        let pf = [xx + h * xv, xv, xv + h * vv, vv];
        let inverse = [pvv / determinant, -pxv / determinant, pxx / determinant];
        let c = [
            pf[0] * inverse[0] + pf[1] * inverse[1],
            pf[0] * inverse[1] + pf[1] * inverse[2],
            pf[2] * inverse[0] + pf[3] * inverse[1],
            pf[2] * inverse[1] + pf[3] * inverse[2],
        ];
        let d = [0, 1].map(|k| later[k] - predicted.state[k]);
        [x + c[0] * d[0] + c[1] * d[1], v + c[2] * d[0] + c[3] * d[1]]
    }
}

/// Stroke [m] and speed [m/s] at each sample from noisy readings, forward by a filter and backward by its smoother.
fn smoothed(
    time: &[f64],
    stroke: &[f64],
    acceleration: &[f64],
    [stroke_noise, acceleration_noise]: [f64; 2],
) -> Vec<[f64; 2]> {
    let count = time.len();
    // An impact between two samples moves the speed by more than the accelerometer's noise tells.
    let surprise = |i: usize| match range(&acceleration[i - 1..(i + 2).min(count)]) {
        f64::NEG_INFINITY => UNKNOWN,
        range => acceleration_noise + 0.5 * range,
    };
    let first = stroke.iter().copied().find(|x| x.is_finite());
    let variance = stroke_noise * stroke_noise;
    let mut estimate = Estimate {
        state: [first.unwrap_or(0.0), 0.0],
        covariance: [variance, 0.0, 1e-6],
    };
    let (mut filtered, mut predicted) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for i in 0..count {
        if i > 0 {
            let pair = acceleration[i - 1..=i].iter().copied();
            let known: Vec<f64> = pair.filter(|a| a.is_finite()).collect();
            let a = known.iter().sum::<f64>() / known.len().max(1) as f64;
            estimate = estimate.later(time[i] - time[i - 1], a, surprise(i).powi(2));
        }
        predicted.push(estimate);
        if stroke[i].is_finite() {
            estimate = estimate.with(stroke[i], variance);
        }
        filtered.push(estimate);
    }
    let mut smooth = vec![estimate.state; count];
    for i in (0..count - 1).rev() {
        let h = time[i + 1] - time[i];
        smooth[i] = filtered[i].smoothed(h, &predicted[i + 1], smooth[i + 1]);
    }
    smooth
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    #[test]
    fn a_smooth_motion_comes_back_from_noisy_readings() {
        // From rest, as recordings begin.
        let time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 4e-3).collect();
        let w = 6.0f64;
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let noise: Vec<f64> = (0..1003)
            .map(|_| random.random_range(-1.732..1.732))
            .collect();
        let stroke: Vec<f64> = time
            .iter()
            .enumerate()
            .map(|(i, t)| 0.02 * (1.0 - (w * t).cos()) + 2e-5 * noise[i])
            .collect();
        let acceleration: Vec<f64> = time
            .iter()
            .enumerate()
            .map(|(i, t)| 0.02 * w * w * (w * t).cos() + 0.15 * noise[i + 3])
            .collect();
        let nudging = Nudging::new(&time, &stroke, &acceleration, 2e-5, 0.15, |_| false);
        let worst = (5..995)
            .map(|i| (nudging.speed[i] - 0.02 * w * (w * time[i]).sin()).abs())
            .fold(0.0, f64::max);
        assert!(worst < 4e-3, "{worst}");
    }
}

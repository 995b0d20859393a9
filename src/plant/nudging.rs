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
    #[expect(
        clippy::too_many_lines,
        reason = "a filter and its smoother, which share all matrices"
    )]
    pub fn new(
        time: &[f64],
        stroke: &[f64],
        acceleration: &[f64],
        stroke_noise: f64,
        acceleration_noise: f64,
        touching: impl Fn(usize) -> bool,
    ) -> Self {
        let count = time.len();
        // An impact between two samples moves the speed by more than the accelerometer's noise tells.
        let surprise = |i: usize| {
            let jump = [i.wrapping_sub(1), i, i + 1].map(|j| {
                acceleration
                    .get(j)
                    .copied()
                    .filter(|a| a.is_finite())
                    .unwrap_or(f64::NAN)
            });
            let finite: Vec<f64> = jump.into_iter().filter(|a| a.is_finite()).collect();
            if finite.is_empty() {
                return 20.0;
            }
            let high = finite.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let low = finite.iter().copied().fold(f64::INFINITY, f64::min);
            acceleration_noise + 0.5 * (high - low)
        };
        let first = stroke
            .iter()
            .copied()
            .find(|x| x.is_finite())
            .unwrap_or(0.0);
        let r = stroke_noise * stroke_noise;
        let mut state = [first, 0.0];
        let mut cov = [r, 0.0, 1e-6];
        let mut filtered = Vec::with_capacity(count);
        let mut predicted = Vec::with_capacity(count);
        for i in 0..count {
            if i > 0 {
                let h = time[i] - time[i - 1];
                let pair = [acceleration[i - 1], acceleration[i]];
                let known: Vec<f64> = pair.into_iter().filter(|a| a.is_finite()).collect();
                let a = if known.is_empty() {
                    0.0
                } else {
                    known.iter().sum::<f64>() / known.len() as f64
                };
                let q = surprise(i).powi(2);
                state = [state[0] + h * state[1] + 0.5 * h * h * a, state[1] + h * a];
                let [pxx, pxv, pvv] = cov;
                cov = [
                    pxx + 2.0 * h * pxv + h * h * pvv + 0.25 * h.powi(4) * q,
                    pxv + h * pvv + 0.5 * h.powi(3) * q,
                    pvv + h * h * q,
                ];
            }
            predicted.push((state, cov));
            if stroke[i].is_finite() {
                let s = cov[0] + r;
                let gain = [cov[0] / s, cov[1] / s];
                let innovation = stroke[i] - state[0];
                state = [
                    state[0] + gain[0] * innovation,
                    state[1] + gain[1] * innovation,
                ];
                let [pxx, pxv, pvv] = cov;
                cov = [
                    (1.0 - gain[0]) * pxx,
                    (1.0 - gain[0]) * pxv,
                    pvv - gain[1] * pxv,
                ];
            }
            filtered.push((state, cov));
        }
        let mut smooth = vec![filtered[count - 1].0; count];
        for i in (0..count - 1).rev() {
            let h = time[i + 1] - time[i];
            let (x, p) = filtered[i];
            let (xp, pp) = predicted[i + 1];
            let determinant = pp[0] * pp[2] - pp[1] * pp[1];
            if determinant <= 0.0 || determinant.is_nan() {
                smooth[i] = x;
                continue;
            }
            // C = P F' P_p^-1, F = [[1, h], [0, 1]]
            let pf = [p[0] + h * p[1], p[1], p[1] + h * p[2], p[2]];
            let inverse = [
                pp[2] / determinant,
                -pp[1] / determinant,
                pp[0] / determinant,
            ];
            let c = [
                pf[0] * inverse[0] + pf[1] * inverse[1],
                pf[0] * inverse[1] + pf[1] * inverse[2],
                pf[2] * inverse[0] + pf[3] * inverse[1],
                pf[2] * inverse[1] + pf[3] * inverse[2],
            ];
            let d = [smooth[i + 1][0] - xp[0], smooth[i + 1][1] - xp[1]];
            smooth[i] = [
                x[0] + c[0] * d[0] + c[1] * d[1],
                x[1] + c[2] * d[0] + c[3] * d[1],
            ];
        }
        let gain = |i: usize| {
            let near = &acceleration[i.saturating_sub(NEAR)..(i + NEAR + 1).min(count)];
            let known = near.iter().filter(|a| a.is_finite());
            let (low, high) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), a| {
                (l.min(*a), h.max(*a))
            });
            // Seven samples of noise range over 2.7 standard deviations.
            let jump = ((high - low) / (6.0 * acceleration_noise)).max(0.0);
            1.0 / (1.0 + jump.powi(4))
        };
        // At rest and in contact there is no timing to lose, and to shake a resting piston would undo its seals' friction.
        let moving = |i: usize| {
            let speed = smooth[i][1] / SLOW;
            let square = speed * speed;
            square / (1.0 + square)
        };
        Self {
            gain: (0..count)
                .map(|i| {
                    if touching(i) {
                        0.0
                    } else {
                        moving(i) * gain(i)
                    }
                })
                .collect(),
            stroke: smooth.iter().map(|s| s[0]).collect(),
            speed: smooth.iter().map(|s| s[1]).collect(),
        }
    }
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

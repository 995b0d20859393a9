//! The link from the commands to the encoders of an arm: its joints' servos, by themselves.
//!
//! ```text
//! minimise   sum over joints and samples ((q_measured - q(u, f))/sigma)^2     over the bandwidth f
//! ```

use crate::diagnosis::fit::free::{Prior, free_of};
use crate::diagnosis::search::EstablishedEffect;
use crate::diagnosis::settings::Settings;
use crate::effects::SERVO_LAG;
use crate::plant::{PlantParameters, follow};

/// Commands and encoders of one recording; an encoder that was not recorded is absent.
#[derive(Debug, Clone)]
pub struct Axes {
    /// Sample times [s].
    pub time: Vec<f64>,
    /// Commands of each joint [rad].
    pub commands: Vec<Vec<f64>>,
    /// Reading of each joint's encoder [rad]; NaN where there is no value.
    pub encoders: Vec<Option<Vec<f64>>>,
}

/// Lag found of the servos.
#[derive(Debug, Clone, PartialEq)]
pub struct ServoLink {
    /// Bandwidth that fits best [Hz].
    pub bandwidth: f64,
    /// Its standard deviation [Hz].
    pub deviation: f64,
    /// Its gain over the nominal one, as a sum of squares [1].
    pub gain: f64,
    /// Readings.
    pub count: usize,
    /// Weight of a sum of squares: less than one where encoders differ from any such lag by more than their noise, and not at random [1].
    pub weight: f64,
    /// Root mean square of what it leaves of each joint, in standard deviations of the noise [1].
    pub left: Vec<f64>,
}

/// Bounds of the search [Hz].
const BOUNDS: [f64; 2] = [0.3, 300.0];
/// Bandwidths tried at first, evenly by their logarithm.
const TRIED: usize = 40;
/// Halvings of the interval about the best: to a part in 1e8.
const NARROWED: usize = 40;

fn residuals(
    axes: &[Axes],
    joint: usize,
    noise: f64,
    bandwidth: f64,
) -> impl Iterator<Item = f64> + '_ {
    axes.iter().flat_map(move |axes| {
        let encoder = axes.encoders[joint].as_deref().unwrap_or_default();
        let angle = follow(&axes.time, &axes.commands[joint], bandwidth).angle;
        let pairs = encoder.iter().zip(angle);
        let left: Vec<f64> = pairs
            .map(|(measured, angle)| (measured - angle) / noise)
            .filter(|r| r.is_finite())
            .collect();
        left
    })
}

/// Fits the bandwidth of all servos alike; none where no encoder was recorded. `noise` is the encoders' [rad].
#[must_use]
pub fn servo_link(axes: &[Axes], noise: f64, nominal: f64) -> Option<ServoLink> {
    let joints = axes.first()?.commands.len();
    let cost = |bandwidth: f64| -> f64 {
        (0..joints)
            .flat_map(|joint| residuals(axes, joint, noise, bandwidth))
            .map(|r| r * r)
            .sum()
    };
    let count = (0..joints)
        .flat_map(|joint| residuals(axes, joint, noise, nominal))
        .count();
    if count == 0 {
        return None;
    }
    let [low, high] = BOUNDS.map(f64::ln);
    let spacing = (high - low) / TRIED as f64;
    let tried = (0..=TRIED).map(|i| low + spacing * i as f64);
    let mut costs: Vec<(f64, f64)> = tried.map(|u| (cost(u.exp()), u)).collect();
    if nominal.is_finite() {
        costs.push((cost(nominal), nominal.ln()));
    }
    costs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut from, mut to) = (costs[0].1 - spacing, costs[0].1 + spacing);
    // Golden sections: the cost has one valley there.
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    for _ in 0..NARROWED {
        let [left, right] = [to - golden * (to - from), from + golden * (to - from)];
        if cost(left.exp()) < cost(right.exp()) {
            to = right;
        } else {
            from = left;
        }
    }
    let bandwidth = (0.5 * (from + to)).exp();
    let best = cost(bandwidth);
    // Curvature of the cost, by which it rises by one within a standard deviation.
    let step = 1e-3 * bandwidth;
    let curvature = (cost(bandwidth + step) - 2.0 * best + cost(bandwidth - step)) / (step * step);
    let left = (0..joints)
        .map(|joint| {
            let (sum, count) = residuals(axes, joint, noise, bandwidth)
                .fold((0.0, 0.0), |(s, n), r| (s + r * r, n + 1.0));
            (sum / f64::max(count, 1.0)).sqrt()
        })
        .collect();
    Some(ServoLink {
        bandwidth,
        deviation: (2.0 / curvature.max(1e-12)).sqrt(),
        gain: cost(nominal) - best,
        count,
        weight: 1.0,
        left,
    })
}

/// The same of motors that a servo of its own moves, which loads and friction push aside: what is left is not noise, and counts for as many samples as are
/// independent (first-order autocorrelation, Bartlett, J. R. Stat. Soc. 8, 1946). A lag faster than the servo [Hz] is the servo's own.
#[must_use]
pub fn pushed_servo_link(axes: &[Axes], noise: f64, nominal: f64, servo: f64) -> Option<ServoLink> {
    let mut link = servo_link(axes, noise, nominal)?;
    let (mut square, mut next, mut count) = (0.0, 0.0, 0.0);
    for recording in axes {
        for joint in 0..recording.commands.len() {
            let one = std::slice::from_ref(recording);
            let left: Vec<f64> = residuals(one, joint, noise, link.bandwidth).collect();
            square += left.iter().map(|l| l * l).sum::<f64>();
            next += left.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>();
            count += left.len() as f64;
        }
    }
    let likeness = (next / square.max(f64::MIN_POSITIVE)).clamp(0.0, 0.999);
    let independent = (1.0 - likeness) / (1.0 + likeness);
    link.weight = (independent * count / square.max(f64::MIN_POSITIVE)).min(1.0);
    link.deviation /= link.weight.sqrt();
    if link.bandwidth > servo {
        link.gain = 0.0;
    }
    Some(link)
}

impl ServoLink {
    /// Whether the encoders show another bandwidth than the nominal one, by Schwarz's criterion, as for any effect.
    #[must_use]
    pub fn differs(&self) -> bool {
        self.weight * self.gain > (self.count as f64).ln() + Settings::DEFAULT.look_elsewhere
    }

    /// The effect, if they do.
    #[must_use]
    pub fn shown(&self, plant: &PlantParameters) -> Option<EstablishedEffect> {
        let mut numbers = free_of(&SERVO_LAG, plant, &[self.bandwidth]);
        for number in &mut numbers {
            number.prior = Prior::Normal {
                mean: self.bandwidth,
                deviation: self.deviation,
            };
        }
        self.differs().then_some(EstablishedEffect {
            effect: &SERVO_LAG,
            numbers,
        })
    }
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};
    use rand_distr::StandardNormal;

    use super::*;

    const NOISE: f64 = 2e-6;

    fn axes(bandwidth: f64) -> Vec<Axes> {
        let time: Vec<f64> = (0..1500).map(|i| f64::from(i) * 2e-3).collect();
        let swing = |size: f64| -> Vec<f64> {
            let angle = |t: &f64| size * (1.0 - (3.0 * t).cos());
            time.iter().map(angle).collect()
        };
        let commands = vec![swing(0.1), swing(-0.03)];
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(4);
        let mut read = |command: &Vec<f64>| {
            let angle = follow(&time, command, bandwidth).angle;
            let noisy = |q: f64| q + NOISE * random.sample::<f64, _>(StandardNormal);
            Some(angle.into_iter().map(noisy).collect())
        };
        let encoders = commands.iter().map(&mut read).collect();
        vec![Axes {
            time: time.clone(),
            commands,
            encoders,
        }]
    }

    #[test]
    fn a_slow_servo_is_found_and_sized_and_a_nominal_one_is_left_alone() {
        let slow = servo_link(&axes(14.0), NOISE, 25.0).unwrap();
        assert!(slow.differs());
        assert!(
            (slow.bandwidth - 14.0).abs() < 4.0 * slow.deviation,
            "{slow:?}"
        );
        assert!(slow.deviation < 0.01);
        assert!(slow.left.iter().all(|left| (left - 1.0).abs() < 0.1));
        let nominal = servo_link(&axes(25.0), NOISE, 25.0).unwrap();
        assert!(!nominal.differs(), "{nominal:?}");
    }

    #[test]
    fn without_encoders_nothing_is_said() {
        let mut blind = axes(25.0);
        blind[0].encoders = vec![None, None];
        assert_eq!(servo_link(&blind, NOISE, 25.0), None);
    }
}

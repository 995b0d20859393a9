//! The search for a path: many random ones, then changes of the best, each kept where it is better.
//!
//! ```text
//! max ln det(Y^T Y + T^-1)
//! ```
//!
//! Y change of all readings, over their noise, by one unit of each base parameter; T squares of their tolerances. Source: Chaloner and Verdinelli, Statistical
//! Science 10 (1995), 273 (Bayesian D-optimality).

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rayon::prelude::*;

use super::clearance::Clearance;
use super::error::Hindrance;
use super::limits::{JointLimits, bring_within, torque_shares};
use crate::diagnosis::arm::evidence::Evidence;
use crate::diagnosis::arm::fit::Parameter;
use crate::diagnosis::arm::identifiability::{curvature, moved_along};
use crate::diagnosis::arm::input::ArmInput;
use crate::recorded_arm::fourier_path::{FourierPath, Harmonic, JointPath};

/// Highest frequency [Hz]: below where gears and links of arms swing.
pub const HIGHEST: f64 = 1.0;
/// Harmonics of a joint.
const HARMONICS: usize = 5;
/// Samples by which a path is evaluated [Hz].
const RATE: f64 = 4.0;
/// Samples at which its torques are looked at [Hz].
const TORQUES: f64 = 25.0;
/// Random paths to begin with.
const RANDOM: usize = 150;
/// Rounds of changes.
const ROUNDS: usize = 150;
/// Changes of a round, tried side by side.
const CHILDREN: usize = 6;
/// Times that a path is scaled down for torque or clearance.
const SHRINKS: usize = 12;
/// Factor of that [1].
const SHRINK: f64 = 0.85;

/// A path with its worth.
struct Found {
    path: FourierPath,
    worth: f64,
}

/// One that is within the limits, or what it runs into.
type Evaluated = Result<Found, Hindrance>;

/// What a search works with.
pub(super) struct Search<'a> {
    pub input: &'a ArmInput,
    pub limits: &'a [JointLimits],
    /// Base parameters with what is known of them.
    pub parameters: &'a [Parameter],
    pub clearance: &'a Clearance,
    pub period: f64,
    pub seed: u64,
}

impl Search<'_> {
    /// The best path that was found; what the last one ran into where every one does.
    pub fn best(&self) -> Result<FourierPath, Hindrance> {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let first = self.evaluated(&self.random(&mut random));
        let others: Vec<FourierPath> = (1..RANDOM).map(|_| self.random(&mut random)).collect();
        let mut best = self.best_of(first, &others)?;
        let mut size = 0.5;
        for _ in 0..ROUNDS {
            let changed: Vec<FourierPath> = (0..CHILDREN)
                .map(|_| self.changed(&best.path, size, &mut random))
                .collect();
            let before = best.worth;
            best = self.best_of(Ok(best), &changed)?;
            // One success in five rounds or so keeps the size (Rechenberg).
            size = match best.worth > before {
                true => f64::min(1.3 * size, 1.0),
                false => f64::max(0.93 * size, 0.03),
            };
        }
        Ok(best.path)
    }

    /// The best of a path and others, which are looked at side by side; the first of equals.
    fn best_of(&self, first: Evaluated, others: &[FourierPath]) -> Evaluated {
        let evaluated: Vec<Evaluated> =
            others.par_iter().map(|path| self.evaluated(path)).collect();
        evaluated
            .into_iter()
            .fold(first, |best, next| match (best, next) {
                (Ok(best), Ok(next)) if next.worth > best.worth => Ok(next),
                (Ok(best), _) => Ok(best),
                (Err(_), next) => next,
            })
    }

    /// A path as far as torque and clearance let it go, with its worth.
    fn evaluated(&self, path: &FourierPath) -> Evaluated {
        let mut path = path.clone();
        let mut left = SHRINKS;
        loop {
            let shares = torque_shares(&self.input.nominal, &path, TORQUES, self.limits);
            let Some(hindrance) = self.hindrance(&path, &shares) else {
                let worth = self.worth(&path);
                return Ok(Found { path, worth });
            };
            left -= 1;
            if left == 0 {
                return Err(hindrance);
            }
            // A joint that needs too much, and all where something is met.
            let meets = matches!(hindrance, Hindrance::Met { .. });
            for (joint, share) in path.joints.iter_mut().zip(&shares) {
                if *share > 1.0 || meets {
                    joint.scale(SHRINK);
                }
            }
        }
    }

    fn hindrance(&self, path: &FourierPath, shares: &[f64]) -> Option<Hindrance> {
        let chain = &self.input.nominal.chain;
        let over = (0..shares.len()).find(|joint| shares[*joint] > 1.0);
        if let Some(joint) = over {
            return Some(Hindrance::Torque {
                joint: chain.joints[joint].name.clone(),
                share: shares[joint],
            });
        }
        let [first, second] = self.clearance.met(path)?;
        Some(Hindrance::Met {
            first,
            second,
            margin: self.clearance.margin,
        })
    }

    fn worth(&self, path: &FourierPath) -> f64 {
        let moved = moved_along(self.input, path, RATE);
        let evidence = Evidence::of(&moved, &[]);
        let course = evidence.course(&moved.nominal, None);
        let hessian = curvature(&evidence, &course, self.parameters);
        match hessian.cholesky() {
            Some(root) => root.l().diagonal().iter().map(|d| d.ln()).sum::<f64>(),
            None => f64::NEG_INFINITY,
        }
    }

    fn random(&self, random: &mut ChaCha8Rng) -> FourierPath {
        let joints = self.limits.iter();
        FourierPath {
            period: self.period,
            joints: joints
                .map(|limits| self.random_joint(limits, random))
                .collect(),
        }
    }

    fn highest(&self) -> usize {
        ((HIGHEST * self.period) as usize).max(3)
    }

    fn random_joint(&self, limits: &JointLimits, random: &mut ChaCha8Rng) -> JointPath {
        let highest = self.highest();
        let mut numbers: Vec<usize> = (1..=highest).collect();
        while numbers.len() > HARMONICS {
            numbers.remove(random.random_range(0..numbers.len()));
        }
        let harmonics = numbers.into_iter().map(|number| Harmonic {
            number,
            cosine: random.sample(StandardNormal),
            sine: random.sample(StandardNormal),
        });
        let mut path = JointPath {
            centre: 0.0,
            harmonics: harmonics.collect(),
        };
        path.centre = random.random_range(limits.position[0]..=limits.position[1]);
        // As fast as it may; what is too far or too fast is scaled down.
        path.scale(10.0 * limits.speed);
        path.rest_at_ends();
        bring_within(&mut path, self.period, limits);
        path
    }

    /// One or two joints of a path changed.
    fn changed(&self, path: &FourierPath, size: f64, random: &mut ChaCha8Rng) -> FourierPath {
        let mut path = path.clone();
        let count = path.joints.len();
        for _ in 0..random.random_range(1..=3) {
            let place = random.random_range(0..count);
            let limits = &self.limits[place];
            let joint = &mut path.joints[place];
            let speed = joint
                .harmonics
                .iter()
                .map(|h| h.sine.abs().max(h.cosine.abs()));
            let speed = speed.fold(1e-3 * limits.speed, f64::max);
            for harmonic in &mut joint.harmonics {
                let step: [f64; 2] = [random.sample(StandardNormal), random.sample(StandardNormal)];
                harmonic.cosine += 0.5 * size * speed * step[0];
                harmonic.sine += 0.5 * size * speed * step[1];
            }
            if random.random_bool(0.3) {
                let own = random.random_range(0..joint.harmonics.len());
                let number = random.random_range(1..=self.highest());
                if joint.harmonics.iter().all(|h| h.number != number) {
                    joint.harmonics[own].number = number;
                }
            }
            let step: f64 = random.sample(StandardNormal);
            joint.centre += 0.3 * size * step * (limits.position[1] - limits.position[0]);
            joint.scale(random.random_range(0.9..1.3));
            joint.rest_at_ends();
            bring_within(joint, self.period, limits);
        }
        path
    }
}

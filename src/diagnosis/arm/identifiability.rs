//! How well a motion shows the numbers of an arm that are known within bounds.
//!
//! ```text
//! C = (Y^T Y + T^-1)^-1
//! ```
//!
//! Y change of all readings, over their noise, by one unit of each number; T squares of the tolerances' standard deviations.

use nalgebra::DMatrix;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

use super::estimate::{HALF_WIDTH, inverse_of};
use super::evidence::{Column, Course, Evidence};
use super::fit::{Parameter, products};
use super::hypothesis::nuisances;
use super::input::{ArmInput, ArmRecording};
use crate::arm::{Joint, JointKind};
use crate::recorded_arm::fourier_path::{FourierPath, Harmonic, JointPath};
use crate::recorded_arm::{ArmParameters, Quantity, Tolerated};

/// Duration [s], rate [Hz] and harmonics of the random motion.
const RANDOM: (f64, f64, usize) = (40.0, 10.0, 12);
/// Seed of it.
const SEED: u64 = 6;

/// What a motion would leave of a tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expected {
    /// The number.
    pub quantity: Quantity,
    /// Half the width of its tolerance [its unit].
    pub tolerance: f64,
    /// Half the width of the 95 % interval that a fit would state, no more than the tolerance [its unit].
    pub half_width: f64,
}

impl Expected {
    /// Tolerance and half-width in the unit that people read: a gain's, not its inverse's.
    #[must_use]
    pub fn shown(&self, arm: &ArmParameters) -> [f64; 2] {
        let factor = match self.quantity {
            Quantity::InverseGain(_) => self.quantity.value(arm).powi(-2),
            _ => 1.0,
        };
        [self.tolerance, self.half_width].map(|half| half * factor)
    }
}

/// The input with one recording in place of its own: a random motion within the joints' limits, by which whatever can show does.
#[must_use]
pub fn randomly_moved(input: &ArmInput) -> ArmInput {
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    let (period, rate, count) = RANDOM;
    let joints = input.nominal.chain.joints.iter();
    let path = FourierPath {
        period,
        joints: joints
            .map(|joint| {
                let [low, high] = travel(joint);
                let harmonics = (1..=count).map(|number| Harmonic {
                    number,
                    cosine: random.random_range(-1.0..1.0),
                    sine: random.random_range(-1.0..1.0),
                });
                let mut path = JointPath {
                    centre: 0.5 * (low + high),
                    harmonics: harmonics.collect(),
                };
                let times = (0..400).map(|i| f64::from(i) * period / 400.0);
                let peak = times
                    .map(|t| path.at(period, t))
                    .fold([1e-9_f64; 2], |peak, [q, v, _]| {
                        [peak[0].max((q - path.centre).abs()), peak[1].max(v.abs())]
                    });
                path.scale((0.5 * (high - low) / peak[0]).min(joint.velocity / peak[1]));
                path
            })
            .collect(),
    };
    moved_along(input, &path, rate)
}

/// Limits of a joint within which it is moved [rad or m]; of an endless one a turn.
#[must_use]
pub fn travel(joint: &Joint) -> [f64; 2] {
    let most = match joint.kind {
        JointKind::Revolute => PI,
        JointKind::Prismatic => 1.0,
    };
    match [joint.lower, joint.upper] {
        [low, high] if low.is_finite() && high.is_finite() => [low, high],
        [low, _] if low.is_finite() => [low, low + 2.0 * most],
        [_, high] if high.is_finite() => [high - 2.0 * most, high],
        _ => [-most, most],
    }
}

/// The input with one recording in place of its own: the motion along a path at a rate [Hz].
#[must_use]
pub fn moved_along(input: &ArmInput, path: &FourierPath, rate: f64) -> ArmInput {
    let motion = path.motion(0, rate);
    let readings = vec![vec![0.0; motion.len()]; input.channels.len()];
    ArmInput {
        recordings: vec![ArmRecording {
            name: String::new(),
            motion,
            readings,
        }],
        ..input.clone()
    }
}

/// A number with what is known of it, by its file or usually.
#[must_use]
pub fn roughly_known(input: &ArmInput, quantity: Quantity) -> Parameter {
    let value = quantity.value(&input.nominal);
    let half = tolerance(input, quantity);
    Parameter::tolerated(&Tolerated {
        quantity,
        bounds: [value - half, value + half],
    })
}

/// What counts as known of an arm's numbers: what its file says, or usual shares where it says nothing.
#[must_use]
pub fn known_of(input: &ArmInput) -> Vec<Tolerated> {
    if !input.tolerated.is_empty() {
        return input.tolerated.clone();
    }
    let drives = (0..input.nominal.joints()).flat_map(|joint| {
        let gain = input.nominal.drives[joint].logs_current;
        let all = [
            Quantity::MotorInertia(joint),
            Quantity::Coulomb(joint),
            Quantity::Viscous(joint),
        ];
        all.into_iter()
            .chain(gain.then_some(Quantity::InverseGain(joint)))
    });
    let links = (0..input.nominal.joints()).flat_map(|link| {
        let centre = (0..3).map(move |axis| Quantity::LinkCentre(link, axis));
        std::iter::once(Quantity::LinkMass(link)).chain(centre)
    });
    drives
        .chain(links)
        .map(|quantity| {
            let value = quantity.value(&input.nominal);
            let half = usual_tolerance(quantity, value);
            Tolerated {
                quantity,
                bounds: [value - half, value + half],
            }
        })
        .collect()
}

/// How far a number is usually off [its unit].
fn usual_tolerance(quantity: Quantity, value: f64) -> f64 {
    let (share, least) = match quantity {
        Quantity::LinkMass(_) => (0.1, 0.1),
        Quantity::LinkCentre(..) => (0.0, 0.01),
        Quantity::LinkInertia(..) => (0.1, 0.01),
        Quantity::InverseGain(_) => (0.1, 1e-6),
        Quantity::MotorInertia(_) => (0.3, 0.05),
        Quantity::Coulomb(_) | Quantity::Viscous(_) => (0.3, 0.5),
        _ => (0.1, 10.0 * quantity.step(value)),
    };
    f64::max(share * value.abs(), least)
}

/// Half the width of what is known of a number, by its file or usually [its unit].
#[must_use]
pub fn tolerance(input: &ArmInput, quantity: Quantity) -> f64 {
    let stated = input.tolerated.iter().find(|t| t.quantity == quantity);
    match stated {
        Some(stated) => 0.5 * (stated.bounds[1] - stated.bounds[0]),
        None => usual_tolerance(quantity, quantity.value(&input.nominal)),
    }
}

/// What the recordings of the evidence would leave of the tolerances, if nothing but noise were left; with the covariance of the same numbers.
#[must_use]
pub fn expected(evidence: &Evidence) -> (Vec<Expected>, DMatrix<f64>) {
    let input = evidence.input;
    let course = evidence.course(&input.nominal, None);
    let with_tolerances = ArmInput {
        tolerated: known_of(input),
        ..input.clone()
    };
    let parameters = nuisances(&with_tolerances);
    let covariance = inverse_of(&curvature(evidence, &course, &parameters));
    let count = with_tolerances.tolerated.len();
    let own = parameters.iter().take(count);
    let expected = own
        .enumerate()
        .map(|(i, parameter)| {
            let tolerance = 0.5 * (parameter.bounds[1] - parameter.bounds[0]);
            Expected {
                quantity: parameter.quantity,
                tolerance,
                half_width: (HALF_WIDTH * covariance[(i, i)].sqrt()).min(tolerance),
            }
        })
        .collect();
    (
        expected,
        covariance.view((0, 0), (count, count)).into_owned(),
    )
}

/// Curvature of half the cost of a fit that moves numbers, at a course.
#[must_use]
pub fn curvature(evidence: &Evidence, course: &Course, parameters: &[Parameter]) -> DMatrix<f64> {
    let columns: Vec<Column> = parameters
        .iter()
        .map(|p| evidence.derivative(course, p.quantity))
        .collect();
    let mut hessian = DMatrix::zeros(parameters.len(), parameters.len());
    for (i, column) in columns.iter().enumerate() {
        for (j, other) in columns.iter().enumerate().take(i + 1) {
            let value = products(column, other).iter().sum::<f64>();
            hessian[(i, j)] = value;
            hessian[(j, i)] = value;
        }
        if let Some([_, deviation]) = parameters[i].prior {
            hessian[(i, i)] += 1.0 / (deviation * deviation);
        }
        hessian[(i, i)] += 1e-12;
    }
    hessian
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::arm::test_chains::planar_two_link;
    use crate::recorded_arm::outside::OutsideError;
    use crate::recorded_arm::simulate::Channel;
    use crate::recorded_arm::{Drive, PointMass};
    use glam::DVec3;

    /// Two links in a plane, whose drives log currents.
    pub fn input(gravity: DVec3) -> ArmInput {
        let mut chain = planar_two_link().0;
        chain
            .joints
            .iter_mut()
            .for_each(|joint| joint.velocity = 2.0);
        let drive = Drive {
            inverse_gain: 0.1,
            logs_current: true,
            motor_inertia: 0.5,
            coulomb: 1.0,
            viscous: 2.0,
            ..Drive::default()
        };
        let known = |quantity, value: f64, share: f64| Tolerated {
            quantity,
            bounds: [value * (1.0 - share), value * (1.0 + share)],
        };
        ArmInput {
            nominal: ArmParameters {
                chain,
                gravity,
                tilt: [0.0; 2],
                drives: vec![drive; 2],
                load: PointMass::default(),
                payload: PointMass::default(),
                wrench: None,
                delay: 0.0,
                pushes: Vec::new(),
                laws: Vec::new(),
                outside_error: OutsideError::default(),
            },
            links: vec!["upper".to_owned(), "lower".to_owned()],
            numbers: vec![1, 2],
            tolerated: vec![
                known(Quantity::InverseGain(0), 0.1, 0.1),
                known(Quantity::Coulomb(0), 1.0, 0.3),
            ],
            channels: vec![Channel::Drive(0), Channel::Drive(1)],
            columns: vec![String::new(); 2],
            noise: vec![0.01; 2],
            recordings: Vec::new(),
        }
    }

    #[test]
    fn a_motion_that_one_joint_sits_out_leaves_its_tolerances() {
        let input = input(9.81 * DVec3::NEG_Y);
        let mut still = randomly_moved(&input);
        let motion = &mut still.recordings[0].motion;
        for values in [&mut motion.speed[0], &mut motion.acceleration[0]] {
            values.fill(0.0);
        }
        motion.position[0].fill(0.3);
        let left = |input: &ArmInput| -> Vec<f64> {
            let (all, _) = expected(&Evidence::of(input, &[]));
            all.iter()
                .map(|one| one.half_width / one.tolerance)
                .collect()
        };
        let [moved, still] = [left(&randomly_moved(&input)), left(&still)];
        assert!(moved.iter().all(|share| *share < 0.1), "{moved:?}");
        assert_eq!(still[1], 1.0);
    }
}

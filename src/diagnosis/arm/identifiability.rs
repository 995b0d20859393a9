//! What a log of an arm can tell apart: base parameters of its dynamics, and how well a motion shows the numbers that are known within bounds.
//!
//! ```text
//! Y = Q R,      d = Y_b R_b^-1 r       of a column d that depends on those before it
//! C = (Y^T Y + T^-1)^-1
//! ```
//!
//! Y change of all readings, over their noise, by one unit of each number; b the columns kept, from the base on (as many as there are base parameters); T squares
//! of the tolerances' standard deviations. Source: Gautier, Journal of Robotic Systems 8 (1991), 485 (base parameters by the QR decomposition of the
//! regressor).

use nalgebra::{DMatrix, DVector};
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

/// Share of a column that those before it leave, below which it depends on them [1].
const DEPENDS: f64 = 1e-7;
/// Share of a dependent column that a partner makes up, below which it is rounding [1].
const TAKES_PART: f64 = 1e-6;
/// Duration [s], rate [Hz] and harmonics of the random motion.
const RANDOM: (f64, f64, usize) = (40.0, 10.0, 12);
/// Seed of it.
const SEED: u64 = 6;

/// Base parameters of an arm along a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct BaseParameters {
    /// Numbers that were looked at.
    pub numbers: usize,
    /// Combinations of them that show.
    pub rank: usize,
    /// Largest over least singular value of the columns kept, over the noise and scaled by the tolerances [1].
    pub condition: f64,
    /// The numbers for which they stand: each with what depends on it.
    pub kept: Vec<Quantity>,
    /// Combinations that noise leaves better known than their tolerances.
    pub beyond_noise: usize,
    /// Numbers that do not show at all.
    pub silent: Vec<Quantity>,
    /// Numbers that show only together with others.
    pub together: Vec<Together>,
}

/// A number that shows only together with others.
#[derive(Debug, Clone, PartialEq)]
pub struct Together {
    /// The number.
    pub quantity: Quantity,
    /// The others.
    pub with: Vec<Quantity>,
}

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

/// Numbers of an arm on which joint torques and a wrench sensor's readings depend linearly: those of links, friction and motors, sensor zeros and tool.
#[must_use]
pub fn linear_numbers(arm: &ArmParameters) -> Vec<Quantity> {
    use Quantity as Q;
    let mut all = Vec::new();
    for link in 0..arm.joints() {
        // Inertia first: a motor's is then said to be inseparable from its link's, not from a mass.
        all.extend((0..6).map(|element| Q::LinkInertia(link, element)));
        all.extend((0..3).map(|axis| Q::LinkCentre(link, axis)));
        all.push(Q::LinkMass(link));
    }
    for joint in 0..arm.joints() {
        all.extend([Q::MotorInertia(joint), Q::Coulomb(joint), Q::Viscous(joint)]);
    }
    if arm.wrench.is_some() {
        all.extend((0..6).map(Q::Zero));
        all.push(Q::ToolMass);
        all.extend((0..3).map(Q::ToolCentre));
    }
    all
}

/// Sets of numbers that may be off beside those, each looked at alone.
#[must_use]
pub fn further_numbers(arm: &ArmParameters) -> Vec<Vec<Quantity>> {
    use Quantity as Q;
    let mut all = vec![
        vec![
            Q::PayloadMass,
            Q::PayloadMoment(0),
            Q::PayloadMoment(1),
            Q::PayloadMoment(2),
        ],
        vec![Q::Tilt(0), Q::Tilt(1)],
    ];
    let gains = (0..arm.joints()).filter(|joint| arm.drives[*joint].logs_current);
    all.push(gains.map(Q::InverseGain).collect());
    for joint in 0..arm.joints() {
        all.push(vec![Q::Offset(joint)]);
        all.push(vec![Q::EncoderOffset(joint)]);
    }
    if arm.wrench.is_some() {
        all.push(vec![Q::SensorRotation]);
        all.extend((0..6).map(|channel| vec![Q::WrenchGain(channel)]));
    }
    all
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

/// Half the width of what is known of a number [its unit].
fn tolerance(input: &ArmInput, quantity: Quantity) -> f64 {
    let stated = input.tolerated.iter().find(|t| t.quantity == quantity);
    match stated {
        Some(stated) => 0.5 * (stated.bounds[1] - stated.bounds[0]),
        None => usual_tolerance(quantity, quantity.value(&input.nominal)),
    }
}

/// Columns that were kept, orthogonal, with what they were made of.
struct Kept {
    quantities: Vec<Quantity>,
    basis: Vec<DVector<f64>>,
    /// Upper triangle: each kept column in the basis.
    upper: Vec<Vec<f64>>,
}

impl Kept {
    /// What a column is in the basis, and what is left of it.
    fn projected(&self, column: &DVector<f64>) -> (Vec<f64>, DVector<f64>) {
        let mut left = column.clone();
        let mut along = vec![0.0; self.basis.len()];
        // Twice is enough (Kahan and Parlett).
        for _ in 0..2 {
            for (own, basis) in along.iter_mut().zip(&self.basis) {
                let share = basis.dot(&left);
                left.axpy(-share, basis, 1.0);
                *own += share;
            }
        }
        (along, left)
    }

    /// Numbers on whose columns one that has these shares of the basis depends, `size` its own.
    fn partners(&self, along: &[f64], size: f64) -> Vec<Quantity> {
        let count = self.basis.len();
        let mut shares = along.to_vec();
        for i in (0..count).rev() {
            shares[i] /= self.upper[i][i];
            for k in 0..i {
                shares[k] -= self.upper[i][k] * shares[i];
            }
        }
        let own = |i: usize| self.upper[i].iter().map(|v| v * v).sum::<f64>().sqrt();
        let takes_part = |i: &usize| (shares[*i] * own(*i)).abs() > TAKES_PART * size;
        let places = (0..count).filter(takes_part);
        places.map(|i| self.quantities[i]).collect()
    }

    fn keep(&mut self, quantity: Quantity, mut along: Vec<f64>, left: &DVector<f64>) {
        let size = left.norm();
        along.push(size);
        self.upper.push(along);
        self.basis.push(left / size);
        self.quantities.push(quantity);
    }
}

/// Values by row of a column by channel.
fn flat(evidence: &Evidence, column: &Column) -> DVector<f64> {
    let mut all = Vec::with_capacity(evidence.count());
    for (values, rows) in column.iter().zip(&evidence.rows) {
        match values.is_empty() {
            true => all.extend(std::iter::repeat_n(0.0, rows.len())),
            false => all.extend_from_slice(values),
        }
    }
    DVector::from_vec(all)
}

/// Base parameters along the recordings of the evidence, then what the further numbers of the arm depend on.
#[must_use]
pub fn base_parameters(evidence: &Evidence) -> BaseParameters {
    let input = evidence.input;
    let mut arm = input.nominal.clone();
    if arm.payload.mass == 0.0 {
        // A load without mass has no centre that could show.
        arm.payload.mass = 0.1;
    }
    let course = evidence.course(&arm, None);
    let numbers = linear_numbers(&arm);
    let mut kept = Kept {
        quantities: Vec::new(),
        basis: Vec::new(),
        upper: Vec::new(),
    };
    let mut found = BaseParameters {
        numbers: numbers.len(),
        rank: 0,
        kept: Vec::new(),
        condition: 1.0,
        beyond_noise: 0,
        silent: Vec::new(),
        together: Vec::new(),
    };
    for quantity in numbers {
        found.sort_in(evidence, &course, quantity, &mut kept);
    }
    found.rank = kept.basis.len();
    found.kept.clone_from(&kept.quantities);
    let scaled = DMatrix::from_fn(found.rank, found.rank, |i, j| match i <= j {
        true => kept.upper[j][i] * tolerance(input, kept.quantities[j]),
        false => 0.0,
    });
    let singular = scaled.singular_values();
    let (most, least) = (singular.max(), singular.min());
    found.condition = if least > 0.0 {
        most / least
    } else {
        f64::INFINITY
    };
    found.beyond_noise = singular.iter().filter(|s| **s > HALF_WIDTH).count();
    for set in further_numbers(&arm) {
        let alone = kept.basis.len();
        for quantity in set {
            found.sort_in(evidence, &course, quantity, &mut kept);
        }
        kept.quantities.truncate(alone);
        kept.basis.truncate(alone);
        kept.upper.truncate(alone);
    }
    found
}

impl BaseParameters {
    /// Keeps a number's column, or notes that it does not show or only together with others.
    fn sort_in(
        &mut self,
        evidence: &Evidence,
        course: &Course,
        quantity: Quantity,
        kept: &mut Kept,
    ) {
        let column = flat(evidence, &evidence.derivative(course, quantity));
        let size = column.norm();
        // Less than noise by far, for a change as large as what is known.
        if size * tolerance(evidence.input, quantity) < DEPENDS {
            self.silent.push(quantity);
            return;
        }
        let (along, left) = kept.projected(&column);
        if left.norm() > DEPENDS * size {
            kept.keep(quantity, along, &left);
            return;
        }
        let with = kept.partners(&along, size);
        self.together.push(Together { quantity, with });
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
mod tests {
    use super::*;
    use crate::arm::test_chains::planar_two_link;
    use crate::recorded_arm::simulate::Channel;
    use crate::recorded_arm::{Drive, PointMass};
    use glam::DVec3;

    fn input(gravity: DVec3) -> ArmInput {
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
    fn a_planar_arm_has_the_base_parameters_of_the_textbook() {
        // Two links in a vertical plane: zz, mx and my of each, the second motor's inertia, and two frictions a joint (Khalil and Dombre 2002, sec. 9.4).
        for (gravity, expected) in [(DVec3::NEG_Y, 11), (DVec3::NEG_Z, 9)] {
            let moved = randomly_moved(&input(9.81 * gravity));
            let found = base_parameters(&Evidence::of(&moved, &[]));
            assert_eq!(found.rank, expected);
            // The first motor turns with the first link.
            let motor = { found.together.iter() }.find(|t| t.quantity == Quantity::MotorInertia(0));
            assert_eq!(motor.unwrap().with, [Quantity::LinkInertia(0, 2)]);
            let gains = found.together.iter().map(|t| t.quantity);
            let gains = gains.filter(|q| matches!(q, Quantity::InverseGain(_)));
            assert_eq!(gains.collect::<Vec<_>>(), [Quantity::InverseGain(1)]);
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

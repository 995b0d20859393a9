//! Base parameters: as many combinations of an arm's numbers as its readings tell apart.
//!
//! ```text
//! Y = Q R,      d = Y_b R_b^-1 r       of a column d that depends on those before it
//! ```
//!
//! Y change of all readings, over their noise, by one unit of each number; b the columns kept, from the base on (as many as there are base parameters). Source:
//! Gautier, Journal of Robotic Systems 8 (1991), 485 (base parameters by the QR decomposition of the regressor).

use nalgebra::{DMatrix, DVector};

use super::estimate::HALF_WIDTH;
use super::evidence::{Column, Course, Evidence};
use super::identifiability::tolerance;
use crate::recorded_arm::{ArmParameters, Quantity};

/// Share of a column that those before it leave, below which it depends on them [1].
const DEPENDS: f64 = 1e-7;
/// Share of a dependent column that a partner makes up, below which it is rounding [1].
const TAKES_PART: f64 = 1e-6;
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

#[cfg(test)]
mod tests {
    use super::super::identifiability::{randomly_moved, tests::input};
    use super::*;
    use glam::DVec3;

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
}

//! What a wrench sensor reads by a description.

use nalgebra::{Matrix3, Vector3};

use super::Posture;
use super::fit::Fit;
use super::frame::{Axes, Frame};
use super::nominal::{Bounded, Nominal};

/// Channels of a wrench, as their columns are called.
pub const WRENCH_COLUMNS: [&str; 6] = [
    "force_x_n",
    "force_y_n",
    "force_z_n",
    "torque_x_n_m",
    "torque_y_n_m",
    "torque_z_n_m",
];
/// A description by which a sensor's readings are predicted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Model {
    /// What the readings are.
    pub frame: Frame,
    /// Readings are these times what they are in axes that are not turned.
    pub turn: Matrix3<f64>,
    /// Force that is read without a load, in the sensor's axes [N].
    pub zero: Vector3<f64>,
    /// Torque that is [N m].
    pub torque_zero: Vector3<f64>,
    /// Weight in the base's axes [N].
    pub weight: Vector3<f64>,
    /// Its centre from the sensor's origin, in the axes of its link [m].
    pub centre: Vector3<f64>,
}

impl Model {
    /// As it was fitted.
    #[must_use]
    pub fn of(fit: &Fit) -> Self {
        let [zero, torque_zero] = fit.zeros();
        Self {
            frame: fit.frame,
            turn: fit.turn,
            zero,
            torque_zero,
            weight: fit.weight(),
            centre: fit.numbers[3],
        }
    }

    /// A fit in the declared axes with its declared numbers as they are, or moved within their boxes.
    #[must_use]
    pub fn declared(fit: &Fit, nominal: &Nominal, moved: bool) -> Self {
        let mut model = Self::of(fit);
        let within = |bounded: Bounded, found: f64| match moved {
            true => found.clamp(bounded.low, bounded.high),
            false => bounded.value,
        };
        let put = |bounds: Option<[Bounded; 3]>, numbers: &mut Vector3<f64>| {
            for (number, bounded) in numbers.iter_mut().zip(bounds.into_iter().flatten()) {
                *number = within(bounded, *number);
            }
        };
        let declared = &nominal.declared;
        put(declared.zero, &mut model.zero);
        put(declared.torque_zero, &mut model.torque_zero);
        put(declared.centre, &mut model.centre);
        if let Some(mass) = declared.mass {
            let gravity = nominal.gravity.norm();
            let mass = within(mass, model.weight.norm() / gravity);
            model.weight = nominal.gravity * mass;
        }
        model
    }

    /// Force [N] and torque [N m] that are read in a pose as it is logged.
    #[must_use]
    pub fn reads(&self, pose: &Matrix3<f64>) -> [Vector3<f64>; 2] {
        let pose = match self.frame.inverse {
            false => *pose,
            true => pose.transpose(),
        };
        let sign = if self.frame.opposite { -1.0 } else { 1.0 };
        let load = pose.transpose() * self.weight * sign;
        let own = [load, self.centre.cross(&load)];
        let zeros = [self.zero, self.torque_zero];
        match self.frame.axes {
            Axes::Sensor => std::array::from_fn(|i| self.turn * own[i] + zeros[i]),
            Axes::Base => std::array::from_fn(|i| self.turn * pose * (own[i] + zeros[i])),
        }
    }
}

/// Readings less what a description says of them, by channel.
#[must_use]
pub fn residuals(postures: &[Posture], model: &Model) -> [Vec<f64>; 6] {
    let left: Vec<[f64; 6]> = postures
        .iter()
        .map(|posture| {
            let [force, torque] = model.reads(&posture.base_from_sensor);
            let force = posture.force - force;
            let torque = posture.torque.map(|read| read - torque);
            std::array::from_fn(|i| match i {
                0..3 => force[i],
                _ => torque.map_or(f64::NAN, |torque| torque[i - 3]),
            })
        })
        .collect();
    std::array::from_fn(|i| left.iter().map(|left| left[i]).collect())
}

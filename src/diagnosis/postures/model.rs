//! A wrench sensor with what hangs on it: as it is declared, and what it reads by a description.

use nalgebra::{Matrix3, Vector3};

use super::fit::Fit;
use super::frame::{Axes, Frame};

/// A declared number and the box in which the truth lies [SI].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounded {
    /// The number.
    pub value: f64,
    /// Least value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
}

impl Bounded {
    /// Half the width of the box.
    #[must_use]
    pub fn half_width(&self) -> f64 {
        0.5 * (self.high - self.low)
    }

    /// Distance of a value from the box.
    #[must_use]
    pub fn beyond(&self, value: f64) -> f64 {
        (value - self.high).max(self.low - value).max(0.0)
    }
}

/// Declared numbers, those that are.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Declared {
    /// Mass of all beyond the sensor [kg].
    pub mass: Option<Bounded>,
    /// Its centre from the sensor's origin, in the axes of its link [m].
    pub centre: Option<[Bounded; 3]>,
    /// Forces that are read without a load, in the sensor's axes [N].
    pub zero: Option<[Bounded; 3]>,
    /// Torques that are [N m].
    pub torque_zero: Option<[Bounded; 3]>,
}

impl Declared {
    /// Whether nothing is declared.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Gravity and sensor by their nominal values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nominal {
    /// What the readings are; their turn is `axes_turn`.
    pub frame: Frame,
    /// Readings in the declared axes are these times what they are in those of link or base.
    pub axes_turn: Matrix3<f64>,
    /// How far the axes may be turned against that [rad].
    pub turn: f64,
    /// Gravity in the base's axes [m/s2].
    pub gravity: Vector3<f64>,
    /// How far the weight may lie from it [rad].
    pub tilt: f64,
    /// Noise of a force [N] and of a torque [N m]; 0: not known.
    pub noise: [f64; 2],
    /// Declared numbers.
    pub declared: Declared,
}

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

//! A wrench sensor with what hangs on it, as it is declared.

use nalgebra::{Matrix3, Vector3};

use super::frame::Frame;

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

//! What sets the regulator's pressure.
//!
//! `ForceController` is the seam: a controller sees what a real one could see and answers with a set pressure.

use crate::device::{DeviceParameters, PressureMap};

/// What a force controller may look at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceObservation {
    /// Time [s].
    pub time: f64,
    /// Desired force along the device's axis [N].
    pub desired_axial_force: f64,
    /// Component of gravity along extension, from the wrist's angle [m/s2].
    pub gravity_along_axis: f64,
    /// Measured contact force along the device's axis [N].
    pub measured_axial_force: f64,
    /// Stroke [m].
    pub stroke: f64,
    /// Regulator's outlet pressure, gauge [Pa].
    pub regulator_pressure: f64,
}

/// The controllers there are.
#[derive(Debug, Clone)]
pub enum ForceController {
    /// Open loop: the pressure that gives the force at rest, gravity compensated as the wrist turns.
    PressureMap(PressureMap),
}

impl ForceController {
    /// The open-loop controller of a device.
    pub fn pressure_map(parameters: &DeviceParameters) -> Self {
        Self::PressureMap(PressureMap::new(parameters))
    }

    /// Set pressure for the coming step [Pa gauge].
    pub fn set_pressure(&mut self, observation: &ForceObservation) -> f64 {
        match self {
            Self::PressureMap(map) => map.set_pressure(
                observation.desired_axial_force,
                observation.gravity_along_axis,
            ),
        }
    }
}

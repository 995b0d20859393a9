//! What a force controller sees.

/// Measurements open to a force controller.
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
    /// Acceleration of the tool along extension as the accelerometer gives it, gravity taken out [m/s2].
    pub acceleration: f64,
    /// Regulator's outlet pressure, gauge [Pa].
    pub regulator_pressure: f64,
}

impl ForceObservation {
    pub(super) fn is_finite(&self) -> bool {
        [
            self.time,
            self.desired_axial_force,
            self.gravity_along_axis,
            self.measured_axial_force,
            self.stroke,
            self.acceleration,
            self.regulator_pressure,
        ]
        .iter()
        .all(|value| value.is_finite())
    }
}

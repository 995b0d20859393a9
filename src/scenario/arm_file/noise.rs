//! Noise of a recorded arm's sensors.

/// Standard deviations of the sensors' noise [SI]; none where there is no such sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmNoise {
    /// Of the joints' angles.
    pub position: f64,
    /// Of current or torque of each drive, base first.
    pub drives: Vec<Option<f64>>,
    /// Of angles on the links' side.
    pub link: Option<f64>,
    /// Of the wrench sensor's forces.
    pub force: Option<f64>,
    /// Of its torques.
    pub moment: Option<f64>,
}

//! How far the owner of a rig lets it be moved.

/// Limits as a file states them; none where it states nothing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OperatingLimits {
    /// Largest set pressure [Pa gauge].
    pub set_pressure: Option<f64>,
    /// Largest rate of the set pressure [Pa/s].
    pub set_pressure_rate: Option<f64>,
    /// Where the surface may stand along the stroke, at least and at most [m].
    pub surface: [Option<f64>; 2],
    /// Largest speed of the surface [m/s].
    pub surface_speed: Option<f64>,
    /// Largest acceleration of the surface [m/s2].
    pub surface_acceleration: Option<f64>,
    /// Whether the 5/2 valve may retract.
    pub solenoid: Option<bool>,
    /// Whether the tool may run without a workpiece.
    pub without_workpiece: Option<bool>,
    /// Largest stroke [m].
    pub stroke: Option<f64>,
    /// Largest force on the part [N].
    pub force: Option<f64>,
    /// Longest recording [s].
    pub duration: Option<f64>,
    /// Largest speed [rad/s] and acceleration [rad/s2] of the joints of a cell's arm.
    pub joint_motion: [Option<f64>; 2],
    /// Largest torque of each drive of that arm, base first [N m].
    pub joint_torque: Option<Vec<f64>>,
}

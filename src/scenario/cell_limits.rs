//! `[limits]` of a cell's file.

use crate::keys::declaration::keys;
use crate::plant::OperatingLimits;

keys! {
    /// `[limits]`: how far an experiment of `idc next` may move the cell; what is not stated, no farther than the recordings did. A run does not look at it.
    pub(super) struct CellLimitsKeys: Default {
        /// largest set pressure, gauge
        set_pressure: Option<f64> = "set_pressure_pa" in 0.0..=1.6e6;
        /// largest rate of the set pressure
        set_pressure_rate: Option<f64> = "set_pressure_rate_pa_per_s" in 1.0..=1e12;
        /// largest stroke of the tool
        stroke: Option<f64> = "stroke_m" in 0.0..=2.0;
        /// largest speed of a joint
        joint_speed: Option<f64> = "joint_speed_rad_per_s" in 1e-4..=20.0;
        /// largest acceleration of a joint
        joint_acceleration: Option<f64> = "joint_acceleration_rad_per_s2" in 1e-4..=1000.0;
        /// largest torque of each drive, base first, friction of the drives themselves counted
        joint_torque: Option<Vec<f64>> = "joint_torque_n_m" in 0.0..=1e6;
        /// largest force on the part
        force: Option<f64> = "force_n" in 0.0..=1e5;
        /// longest recording
        duration: Option<f64> = "duration_s" in 0.5..=3600.0;
    }
}

impl CellLimitsKeys {
    /// As experiments take them.
    pub fn limits(self) -> OperatingLimits {
        OperatingLimits {
            set_pressure: self.set_pressure,
            set_pressure_rate: self.set_pressure_rate,
            stroke: self.stroke,
            force: self.force,
            duration: self.duration,
            joint_motion: [self.joint_speed, self.joint_acceleration],
            joint_torque: self.joint_torque,
            ..OperatingLimits::default()
        }
    }
}

//! Effects of the sensors: the rig is nominal, its readings are not.

pub mod channel_time_offset;
pub mod force_sensor_bias_drift;
pub mod force_sensor_gain_error;
pub mod force_sensor_lag;
pub mod force_sensor_saturation;
pub mod inertial_crosstalk;
pub mod stroke_sensor_gain_error;

use super::parts::*;

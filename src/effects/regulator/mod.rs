//! Effects from the set pressure to the outlet, and of the valve.

pub mod regulator_gain_error;
pub mod regulator_hysteresis;
pub mod regulator_rate_limit;
pub mod regulator_second_order;
pub mod solenoid_switching_delay;
pub mod transport_delay;

use super::parts::*;

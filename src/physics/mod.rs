//! Pure equations of the pneumatic device, its tool and its arm's drives: no engine, no files, no clock. One effect a file.
//!
//! Pressures are absolute [Pa], mass flows positive into the chamber, forces positive in extension.

pub mod axial_load;
pub mod chamber;
pub mod chamfer;
pub mod command_lag;
pub mod cutting_force;
pub mod end_cushioning;
pub mod flow_slope;
pub mod gas;
pub mod gas_process;
pub mod hose;
pub mod iso_6358;
pub mod joint_spring;
pub mod leakage;
pub mod line_chain;
pub mod orifice;
pub mod piston;
pub mod push_only;
pub mod regulator;
pub mod removal_law;
pub mod seal_friction;
pub mod spindle;
mod subsonic;
pub mod supply_reservoir;
pub mod switching_delay;
pub mod valve;

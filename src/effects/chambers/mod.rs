//! Effects on the air: its ways and what it does in the chambers.

pub mod cross_piston_leakage;
pub mod exhaust_restriction;
pub mod external_leakage;
pub mod extra_dead_volume;
pub mod heat_transfer;
pub mod hose_volume;
pub mod supply_droop;
pub mod supply_restriction;

use super::parts::*;

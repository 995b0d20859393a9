//! What was recorded: read, cleaned, and as a fit sees it.

pub mod clean;
pub mod device;
pub mod evidence;
pub mod input;
pub mod predictability;
pub mod recorded;
pub mod subject;

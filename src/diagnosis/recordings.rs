//! What was recorded: read, cleaned, and as a fit sees it.

pub mod clean;
pub mod device;
pub mod evidence;
pub mod input;
pub mod recorded;
pub mod steadiness;
pub mod subject;

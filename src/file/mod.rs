//! Files as they are opened for reading: regular ones alone, read up to a limit; and readers of other crates, whose panics become refusals.

mod foreign;
mod limit;
mod open;

pub use foreign::guarded;
pub use limit::{Limit, RAISED_BY, megabytes, raise};
pub use open::{check, open, read, read_settings, read_text, read_up_to};

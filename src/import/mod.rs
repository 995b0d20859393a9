//! Logs of real devices, as their makers wrote them, made into recordings: a map says which column is what.

pub mod assemble;
mod bag;
pub mod clock;
pub mod doubts;
pub mod encoding;
pub mod error;
pub mod findings;
pub mod kinds;
pub mod log;
mod lone;
pub mod look;
pub mod map;
pub mod map_file;
mod mat_log;
mod numbers;
mod packed;
mod parquet_log;
pub mod rows;
mod signature;
mod spreadsheet;
pub mod stamps;
mod tdms_log;
mod text;
pub mod units;
pub mod words;

pub use assemble::{Imported, LogNote, import};
pub use bag::own::map_of_bag;
pub use error::ImportError;
pub use log::{Log, Series, read_log};
pub use look::{Draft, draft};
pub use map::ImportMap;
pub use map_file::load_map;
pub use rows::Remark;

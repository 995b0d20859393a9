//! Finds what physics recordings contain that the nominal model leaves out.

pub mod answer;
pub mod arm;
pub mod data_fault;
pub mod diagnose;
pub mod difference;
pub mod effort;
pub mod experiment;
pub mod fit;
pub mod flange;
pub mod formula;
pub mod joints;
pub mod postures;
pub mod recordings;
pub mod removal;
pub mod search;
pub mod settings;
#[cfg(test)]
mod test_evidence;

//! Finds what physics recordings contain that the believed model leaves out.

pub mod account;
pub mod answer;
pub mod case;
pub mod clean;
pub mod conclude;
mod covariance;
pub mod details;
pub mod diagnose;
pub mod estimate;
pub mod evidence;
pub mod experiment;
pub mod fit;
pub mod free;
pub mod latent;
pub mod left_out;
pub mod links;
pub mod localise;
pub mod mismatch;
pub mod next_experiment;
pub mod recorded;
pub mod regime;
mod scale;
pub mod search;
pub mod spectrum;
pub mod unlisted;
pub mod words;

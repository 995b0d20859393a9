//! The shared library of co-simulation units: the interface in C of `idc_cell::fmu`. Of what else is in the crate it holds nothing.
//!
//! ```sh
//! cargo build --release --example co_simulation_unit
//! ```
//!
//! makes `target/release/examples/libco_simulation_unit.so`, where `idc export fmu` looks for it (docs/FMU.md).

pub use idc_cell::fmu;

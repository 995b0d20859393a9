//! The extension module of the Python package as tests take it: src/python over the library that the program is linked from. Users have that of `pip install .`,
//! for which the library is compiled once more, with the feature `python`.
//!
//! ```sh
//! cargo build --release --example python_module
//! ```

// The errors of the library carry their facts, and are seldom.
#![allow(clippy::result_large_err)]

use idc_cell::{app, cell, control, device, recording, rig, run, scenario, simulation, unit, vary};

#[path = "../src/python/mod.rs"]
mod python;

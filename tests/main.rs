//! Tests of the whole: one binary, because each links the engine and the recorder.

mod air;
mod bad_input;
mod balance;
mod bench_reference;
mod command_line;
mod common;
mod contact;
mod convergence;
mod determinism;
mod equations;
mod layers;
mod predict;
mod program;
mod real_robots;
mod rig_file;
mod stops;
mod uniformity;

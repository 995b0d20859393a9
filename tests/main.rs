//! Tests of the whole: one binary, because each links the engine and the recorder.

mod air;
mod bad_input;
mod balance;
mod bench_reference;
mod command_line;
mod common;
mod contact;
mod convergence;
mod design;
mod determinism;
mod equations;
mod layers;
mod program;
mod real_robots;
mod stops;
mod uniformity;

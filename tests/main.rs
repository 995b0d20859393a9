//! Tests of the whole: one binary, because each links the engine and the recorder.

mod air;
mod bad_input;
mod balance;
mod bench_reference;
mod command_line;
mod common;
mod contact;
mod controllers;
mod convergence;
mod design;
mod determinism;
mod diagnose;
mod equations;
mod estimator;
mod laboratory;
mod layers;
mod paper_deviation;
mod paper_page;
mod predict;
mod program;
mod real_robots;
mod rig_file;
mod stiff_reference;
mod stops;
mod uniformity;

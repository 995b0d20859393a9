//! The source paper's equations, closed forms and conserved quantities: what docs/EQUATIONS.md says of each, row by row.
//!
//! `cargo test --release --test cell equations -- --nocapture` prints the figures that the page states.

mod conserved;
mod devices;
mod equation_7;
mod equilibrium;
mod extremes;
mod gas_springs;
mod lines;
mod orifices;
mod piston;
mod regulator_and_line;
mod seals_and_contact;
mod vessels;

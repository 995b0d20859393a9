//! Air that filling has warmed cools after the chamber is shut.
//!
//! ```text
//! dp/dt = -(D/T_c) e^(-t/T_c)
//! ```
//!
//! p pressure [Pa], D pressure that cooling takes [Pa], T_c its time [s], t since the chamber was shut [s].
//! Source: The last of the heat of a filling, to the walls at a constant coefficient (Carneiro and Gomes de Almeida 2006).
//!
//! Signature: A fall at the start that ends by itself.
//!
//! Confused with:
//! - leak_in_proportion: goes on until the chamber is empty.
//! - a sensor that warms up: shows at no pressure too.

use super::*;

/// A chamber of a litre exchanges its heat in some seconds: slower than this is another thing [s].
const LONGEST_COOLING: [f64; 2] = [0.1, 20.0];

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("chamber_cooling.rs"),
    parameters: |_, _| vec![
        reported(COOLING.named("pressure_lost_pa"), Linear(500.0), [-1e5, 1e5]),
        reported(COOLING_TIME.named("cooling_time_constant_s"), Logarithmic, LONGEST_COOLING),
    ],
    usual: |_, _| vec![2e3, 5.0],
    starts: |_, _| vec![vec![300.0, 2.0], vec![300.0, 10.0]],
    ..effect("chamber_cooling", Subsystem::Chambers)
};

//! Air that filling has warmed cools after the chamber is shut.
//!
//!     dp/dt = -(D/T_c) e^(-t/T_c)
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
pub const EFFECT: Effect = Effect {
    name: "chamber_cooling",
    text: include_str!("chamber_cooling.rs"),
    which: Which::Only,
    subsystem: Subsystem::Chambers,
    group: None,
    parameters: |_, _| {
        vec![
            reported(
                quantity!("pressure_lost_pa", p => p.links.cooling),
                Linear(500.0),
                [-1e5, 1e5],
            ),
            reported(
                quantity!("cooling_time_constant_s", p => p.links.cooling_time),
                Logarithmic,
                LONGEST_COOLING,
            ),
        ]
    },
    usual: |_, _| vec![2e3, 5.0],
    starts: |_, _| vec![vec![300.0, 2.0], vec![300.0, 10.0]],
};

//! A burr stands on the edge. A smooth bump.
//!
//!     l(s) = h exp(-((s - p)/w)^2 / 2)
//!
//! l how far the part stands out along the bisector of its edge [m], s place along the edge and p that of the burr [m], h height and w standard width of the
//! burr [m].
//! Source: The bump is a normal curve, the simplest smooth one of a place, a height and a width: a choice of this project.
//!
//! Signature: The stroke gives way at one place of the path, in every recording at the same, and the force kicks as it climbs and leaves.
//!
//! Confused with:
//! - surface_waviness: goes on all along the path.
//! - a disturbance at one time: is at another place of the path in another recording.

use super::*;
use Coordinate::{Linear, Logarithmic};

pub(super) const EFFECT: Effect = Effect {
    name: "burr",
    text: include_str!("burr.rs"),
    which: Which::Only,
    subsystem: super::super::Subsystem::Workpiece,
    group: None,
    parameters: |_, _| {
        vec![
            reported(
                Quantity {
                    name: "position_m",
                    index: 0,
                    get: |p, _| p.cell.burr.position,
                    set: |p, _, v| p.cell.burr.position = v,
                },
                Linear(1e-3),
                [0.0, 100.0],
            ),
            reported(
                Quantity {
                    name: "height_m",
                    index: 0,
                    get: |p, _| p.cell.burr.height,
                    set: |p, _, v| p.cell.burr.height = v,
                },
                Linear(1e-4),
                [0.0, 0.02],
            ),
            Parameter {
                quantity: Quantity {
                    name: "width_m",
                    index: 0,
                    get: |p, _| p.cell.burr.width,
                    set: |p, _, v| p.cell.burr.width = v,
                },
                coordinate: Logarithmic,
                bounds: [2e-4, 0.02],
                reported: false,
                choices: &[],
            },
        ]
    },
    usual: |_, _| vec![0.1, 3e-4, 2e-3],
    starts: |clues: &Clues<'_>, _| {
        let places = clues.bumps.iter();
        places.map(|place| vec![*place, 1e-4, 2e-3]).collect()
    },
};

//! Where to put the part: over a grid of positions, with the flange turned about the tool's axis in steps, whether the whole job can be done.

mod footprint;
mod picture;

use crate::listed::listed;
use glam::DVec3;
use glamx::DPose3;
use rayon::prelude::*;

pub use footprint::{Footprint, FootprintKind, footprints};
pub use picture::svg;

use crate::cell::{Setup, Stance};
use crate::path::{Obstacle, Outline, Plan, PlanError};

/// Rolls that are planned in full, the most comfortable first, before a position is given up.
const PLANNED: usize = 3;

/// Positions of the part that are tried.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceGrid {
    /// Along the world's x [m].
    pub x: Vec<f64>,
    /// Along its y [m].
    pub y: Vec<f64>,
    /// Height of the part's origin [m].
    pub z: f64,
    /// Steps of a turn in which the flange is turned about the tool's axis.
    pub rolls: usize,
}

listed! {
    /// Why a job cannot be done.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Hindrance: 6,
    /// Its name.
    name: &'static str {
        /// Some of it is out of reach, or beyond an axis's range.
        Reach = "reach",
        /// The arm is all but singular, or would have to change its posture.
        Singularity = "singularity",
        /// Bodies come too near to each other.
        Collision = "collision",
        /// An axis is too weak.
        Torque = "torque",
        /// An axis is too slow for the feed.
        Speed = "speed",
        /// The tool cannot stand so to the edge.
        Edge = "edge",
    }
}

impl From<&PlanError> for Hindrance {
    fn from(error: &PlanError) -> Self {
        match error {
            PlanError::Waypoint { obstacle, .. } => match obstacle {
                Obstacle::OutOfReach { .. } | Obstacle::Position { .. } => Self::Reach,
                Obstacle::PostureChange { .. } | Obstacle::Singular { .. } => Self::Singularity,
                Obstacle::Collision(_) => Self::Collision,
                Obstacle::Effort { .. } => Self::Torque,
                Obstacle::Velocity { .. } => Self::Speed,
            },
            PlanError::Penetration(_) => Self::Collision,
            PlanError::Lean { .. } | PlanError::InwardCorner { .. } => Self::Edge,
        }
    }
}

/// The job at a position, done as comfortably as it can be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Possible {
    /// Angle of the flange about the tool's axis [rad].
    pub roll: f64,
    /// How far the whole job keeps from singularity, limits of position and torque [1]: `Outline::comfort`.
    pub comfort: f64,
    /// Time that the job takes [s].
    pub cycle_time: f64,
}

/// A position that was tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TriedPlace {
    /// The part's origin in the world [m].
    pub position: DVec3,
    /// Rolls at which reach, postures and clearances allow the job.
    pub rolls: usize,
    /// The best of them, or what is in the way of the roll that comes nearest.
    pub outcome: Result<Possible, Hindrance>,
}

/// Tries all positions of a grid, row by row of y; `done` gets each as it is finished.
pub fn tried_places(setup: &Setup, grid: &PlaceGrid, done: &(dyn Fn() + Sync)) -> Vec<TriedPlace> {
    let positions: Vec<DVec3> = (grid.y.iter())
        .flat_map(|&y| grid.x.iter().map(move |&x| DVec3::new(x, y, grid.z)))
        .collect();
    positions
        .into_par_iter()
        .map(|position| {
            let tried = tried_place(setup, position, grid.rolls);
            done();
            tried
        })
        .collect()
}

fn tried_place(setup: &Setup, position: DVec3, rolls: usize) -> TriedPlace {
    let own = setup.stance();
    let rotation = own.world_from_part.rotation;
    let stance = Stance {
        world_from_part: DPose3::from_parts(position, rotation),
        ..own
    };
    let mut ways: Vec<Outline> = Vec::new();
    let mut hindrance = Hindrance::Reach;
    for roll in rolls_of(setup, rolls) {
        let rolled = Stance {
            roll: Some(roll),
            ..stance
        };
        match setup.outline(&rolled) {
            Ok(outline) => ways.push(outline),
            Err(error) => hindrance = hindrance.max(Hindrance::from(&error)),
        }
    }
    ways.sort_by(|a, b| b.comfort.total_cmp(&a.comfort));
    let count = ways.len();
    for outline in ways.into_iter().take(PLANNED) {
        let (roll, comfort) = (outline.roll, outline.comfort);
        let planned = setup.tried(&stance, |request| {
            Plan::from_outline(request, outline.clone())
        });
        match planned {
            Ok(plan) => {
                return TriedPlace {
                    position,
                    rolls: count,
                    outcome: Ok(Possible {
                        roll,
                        comfort,
                        cycle_time: plan.duration(),
                    }),
                };
            }
            Err(error) => hindrance = hindrance.max(Hindrance::from(&error)),
        }
    }
    TriedPlace {
        position,
        rolls: count,
        outcome: Err(hindrance),
    }
}

/// Rolls that are tried: the one that the scenario gives, one of an arm that cannot choose, or evenly spaced ones.
fn rolls_of(setup: &Setup, count: usize) -> Vec<f64> {
    if let Some(roll) = setup.scenario.process.roll {
        return vec![roll];
    }
    if setup.arm.chain.len() < 6 {
        return vec![0.0];
    }
    let turn = std::f64::consts::TAU / count as f64;
    (0..count).map(|step| turn * step as f64).collect()
}

/// The places at which the job can be done, the most comfortable first; of places as comfortable the one with the shorter cycle.
#[must_use]
pub fn best_places(tried: &[TriedPlace]) -> Vec<(DVec3, Possible)> {
    let possible = tried.iter().filter_map(|place| {
        let outcome = place.outcome.ok()?;
        Some((place.position, outcome))
    });
    let mut possible: Vec<_> = possible.collect();
    possible.sort_by(|(_, a), (_, b)| {
        let comfort = b.comfort.total_cmp(&a.comfort);
        comfort.then(a.cycle_time.total_cmp(&b.cycle_time))
    });
    possible
}

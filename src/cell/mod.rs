//! The cell, assembled from a scenario and checked: everything that does not change during a run.

mod ball;
mod collision;
mod cutting;
mod device_shape;
mod error;
mod estimated;
mod part;
mod payload;
mod plant;
mod recorded_arm;
mod resolution;
mod setup;
mod stroke;
mod supply;

use std::path::Path;

use glam::DVec3;
use glamx::DPose3;

pub use ball::largest_balls;
pub use collision::obstacle_body;
pub use device_shape::DeviceShape;
pub use error::CellError;
pub use estimated::{EstimatedArm, EstimatedLink, EstimatedTorque};
pub use part::{Part, choose_edge, station};
pub use payload::{FlangeLoad, with_housing};
pub use plant::complete;
pub use recorded_arm::check as check_recorded_arm;
pub use resolution::Resolution;
pub use setup::{Setup, Stance, arm_options};

use crate::arm::chain::MAX_JOINTS;
use crate::arm::kinematics::{jacobian_at, link_poses};
use crate::collision::Meeting;
use crate::control::force::{ForceController, Pressing};
use crate::path::Plan;
use crate::plant::{EdgeStation, Relief};
use crate::scenario::{Scenario, load};

/// A cell, ready to run.
pub struct Cell {
    /// What of it does not depend on where the part lies.
    pub setup: Setup,
    /// How finely a step of the simulation is cut.
    pub resolution: Resolution,
    /// The middle of the followed edge, with the part at its nominal pose.
    pub middle: EdgeStation,
    /// Controller of the regulator's pressure, as it is at the start.
    pub controller: ForceController,
    /// The job.
    pub plan: Plan,
    /// Cosine between the tool's axis and the contact normal in the middle of the edge: the share of the contact force that the device sees there [1].
    pub axial_share: f64,
    /// Least and greatest component of gravity along the tool's axis on the edge [m/s2].
    pub gravity_on_edge: [f64; 2],
    /// Masses of the arm that are estimated, and what that leaves open.
    pub estimated: Option<EstimatedArm>,
}

impl Cell {
    /// Reads a scenario file and makes the cell that it describes.
    ///
    /// # Errors
    /// Those of the file, and of [`Cell::new`].
    pub fn load(path: &Path) -> Result<Self, CellError> {
        Self::new(load(path)?)
    }

    /// Loads what the scenario names, plans the job and checks that it can be done.
    ///
    /// # Errors
    /// Something is missing, refused or out of reach; the error names file, key or waypoint.
    pub fn new(scenario: Scenario) -> Result<Self, CellError> {
        let mut setup = Setup::load(scenario)?;
        let resolution = Resolution::of(&setup.scenario, &setup.actual)?;
        if let Some(Meeting { names, depth, .. }) =
            setup.collision.static_penetrations().into_iter().next()
        {
            return Err(CellError::Penetration {
                file: setup.scenario.path.clone(),
                names,
                depth,
            });
        }
        let stance = setup.stance();
        let refused = |error| CellError::plan(&setup.scenario, error);
        let tool_path = setup.tool_path(&stance).map_err(refused)?;
        ball::check(&setup.scenario, &setup.part)?;
        stroke::check(&setup.scenario, &setup.part, &tool_path)?;
        let gravity_on_edge = supply::check(&setup.scenario, &setup.passes, &tool_path)?;
        cutting::check(&setup.scenario, &tool_path)?;
        let axial_share = tool_path.share(&tool_path.at(0.5 * tool_path.length()));
        let scenario = &setup.scenario;
        let controller = ForceController::of_scenario(
            &scenario.controller,
            &scenario.nominal,
            &scenario.sensing,
            Some(Pressing {
                force: scenario.process.force,
                share: axial_share,
            }),
            scenario.simulation.step,
        )?;
        let request = setup.request(&stance, &setup.collision, tool_path);
        let plan = Plan::new(&request).map_err(refused)?;
        let spread = setup.scenario.arm.mass_spread;
        let estimated = EstimatedArm::of(&setup.arm.estimated, spread, &request, &plan);
        let notes = &mut setup.notes;
        notes.extend(estimated.as_ref().map(EstimatedArm::note));
        notes.extend(plan.notes.iter().cloned());
        notes.extend(resolution.note(&setup.scenario));
        let edge = &setup.part.edge;
        let middle = station(
            edge,
            setup.scenario.workpiece.world_from_part,
            0.5 * edge.length,
        );
        Ok(Self {
            setup,
            resolution,
            middle,
            controller,
            plan,
            axial_share,
            gravity_on_edge,
            estimated,
        })
    }

    /// Component of gravity along the tool's axis [m/s2].
    pub fn gravity_along(&self, axis: DVec3) -> f64 {
        self.setup.scenario.simulation.gravity.dot(axis)
    }

    /// Offset of the part's surface from its mesh where the ball is, at a place along the edge [m].
    pub fn relief(&self, place: f64) -> Relief {
        let place = place.clamp(0.0, self.setup.part.edge.length);
        let ride = self.setup.part.ride.as_ref();
        self.relief_ridden(
            place,
            ride.map(|ride| (ride.lift(place), ride.slope(place), 0.0)),
        )
    }

    /// The same of an edge on which the ball rides with a lift [m], its slope [1] and its rate where it is [m/s].
    pub fn relief_ridden(&self, place: f64, ridden: Option<(f64, f64, f64)>) -> Relief {
        let world_from_part = self.setup.scenario.workpiece.world_from_part;
        let here = station(&self.setup.part.edge, world_from_part, place);
        let mut relief = self.setup.actual.cell.relief(&self.middle, &here);
        if let Some((lift, slope, rate)) = ridden {
            relief.rate += rate;
            relief.height += lift;
            relief.gradient += here.tangent * slope;
        }
        relief
    }

    /// The joint, from 1, whose turning moves the tool most along the contact normal in the middle of the job: what is wrong with it shows most.
    pub fn most_observable_joint(&self) -> usize {
        let reference = self.plan.reference(0.5 * self.plan.duration());
        let count = self.setup.arm.chain.len();
        let mut links = [DPose3::IDENTITY; MAX_JOINTS];
        let base = self.setup.scenario.arm.world_from_base;
        let position = &reference.position[..count];
        link_poses(&self.setup.arm.chain, base, position, &mut links[..count]);
        let jacobian = jacobian_at(&self.setup.arm.chain, &links[..count], reference.centre);
        let normal = reference.normal.to_array();
        let along = |joint: usize| -> f64 {
            let rows = normal.iter().enumerate();
            rows.map(|(row, n)| n * jacobian[(row, joint)]).sum()
        };
        let most = (0..count).max_by(|&a, &b| along(a).abs().total_cmp(&along(b).abs()));
        most.unwrap_or_default() + 1
    }
}

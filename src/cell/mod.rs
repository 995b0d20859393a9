//! The cell, assembled from a scenario and checked: everything that does not change during a run.

mod error;
mod part;
mod plant;

use std::path::Path;

use glam::{DMat3, DVec3};
use glamx::DPose3;

pub use error::CellError;
pub use part::{Part, choose_edge, station};

use crate::arm::chain::{BodyInertia, Joint, JointKind, KinematicChain, MAX_JOINTS};
use crate::arm::kinematics::{jacobian_at, link_poses};
use crate::arm::urdf::{Arm, ArmOptions, LimitOverride, load_arm};
use crate::control::force::ForceController;
use crate::control::transmission::TransmissionParameters;
use crate::device::{Device, PressureMap};
use crate::path::PlanRequest;
use crate::path::profile::MotionLimits;
use crate::path::{Plan, ToolPath};
use crate::physics::push_only::PushOnly;
use crate::plant::{EdgeStation, PlantParameters, Relief};
use crate::scenario::{ArmScenario, Scenario, ScenarioError, attainable_set_pressure, load};

/// A cell, ready to run.
pub struct Cell {
    /// Scenario from which it was made.
    pub scenario: Scenario,
    /// The arm.
    pub arm: Arm,
    /// The arm with the device's slide as its last joint, as its controller believes it to be.
    pub arm_with_slide: KinematicChain,
    /// The same as it is.
    pub bodies: KinematicChain,
    /// Transmission between motor and link of each of its joints, base first; none where they are one.
    pub transmissions: Vec<Option<TransmissionParameters>>,
    /// Its physics.
    pub plant: PlantParameters,
    /// The middle of the followed edge, where the part is believed.
    pub middle: EdgeStation,
    /// The device.
    pub device: Device,
    /// Controller of the regulator's pressure, as it is at the start.
    pub controller: ForceController,
    /// Part, edge and burr.
    pub part: Part,
    /// The job.
    pub plan: Plan,
    /// Least and greatest component of gravity along the tool's axis on the edge [m/s2].
    pub gravity_on_edge: [f64; 2],
    /// Notes on what a user may not expect, one sentence each.
    pub notes: Vec<String>,
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
        let mut arm = load_arm(&scenario.arm.urdf, &arm_options(&scenario.arm))?;
        check_drives(&scenario, &arm.chain)?;
        let plant = plant::of(&scenario, &arm.chain)?;
        for (joint, friction) in arm.chain.joints.iter_mut().zip(plant.cell.joint_friction) {
            joint.friction = friction;
        }
        let transmissions = plant::transmissions(&scenario, &arm.chain, &plant.cell);
        check_seed_posture(&scenario, &arm.chain)?;
        let believed_mass = scenario.device.parameters.moving_mass;
        let arm_with_slide = with_slide(&arm.chain, &scenario, believed_mass);
        let bodies = with_slide(&arm.chain, &scenario, plant.device.moving_mass);
        let part = Part::load(&scenario)?;
        let middle = station(
            &part.edge,
            scenario.workpiece.world_from_part,
            0.5 * part.edge.length,
        );
        let device = Device::new(plant.with_friction_of_terms(plant.device.clone()));
        let tool_path = ToolPath::along(
            part.edge.clone(),
            scenario.workpiece.world_from_part,
            scenario.process.lean,
        )
        .map_err(|error| CellError::plan(&scenario, error))?;
        let gravity_on_edge = check_supply(&scenario, &tool_path)?;
        let controller = controller(&scenario)?;
        let plan = Plan::new(&plan_request(
            &scenario,
            &arm.chain,
            &arm_with_slide,
            tool_path,
        ))
        .map_err(|error| CellError::plan(&scenario, error))?;
        let notes = arm.notes.iter().chain(&plan.notes).cloned().collect();
        Ok(Self {
            scenario,
            arm,
            arm_with_slide,
            bodies,
            transmissions,
            plant,
            middle,
            device,
            controller,
            part,
            plan,
            gravity_on_edge,
            notes,
        })
    }

    /// Component of gravity along the tool's axis [m/s2].
    pub fn gravity_along(&self, axis: DVec3) -> f64 {
        self.scenario.simulation.gravity.dot(axis)
    }

    /// Offset of the part's surface from its mesh where the ball is, at a place along the edge [m].
    pub fn relief(&self, place: f64) -> Relief {
        let world_from_part = self.scenario.workpiece.world_from_part;
        let here = station(&self.part.edge, world_from_part, place);
        let mut relief = self.plant.cell.relief(&self.middle, &here);
        if let Some(ride) = &self.part.ride {
            relief.height += ride.lift(here.station);
            relief.gradient += here.tangent * ride.slope(here.station);
        }
        relief
    }

    /// The joint, from 1, whose turning moves the tool most along the contact normal in the middle of the job: what is wrong with it shows most.
    pub fn telling_joint(&self) -> usize {
        let reference = self.plan.reference(0.5 * self.plan.duration());
        let count = self.arm.chain.len();
        let mut links = [DPose3::IDENTITY; MAX_JOINTS];
        let base = self.scenario.arm.world_from_base;
        let position = &reference.position[..count];
        link_poses(&self.arm.chain, base, position, &mut links[..count]);
        let jacobian = jacobian_at(&self.arm.chain, &links[..count], reference.centre);
        let normal = reference.normal.to_array();
        let along = |joint: usize| -> f64 {
            let rows = normal.iter().enumerate();
            rows.map(|(row, n)| n * jacobian[(row, joint)]).sum()
        };
        let most = (0..count).max_by(|&a, &b| along(a).abs().total_cmp(&along(b).abs()));
        most.unwrap_or_default() + 1
    }

    /// Cosine between the tool's axis and the contact normal: the share of the contact force that the device sees.
    pub fn axial_share(&self) -> f64 {
        self.scenario.process.lean.cos()
    }
}

/// The parts of its file that a scenario's arm takes.
pub fn arm_options(arm: &ArmScenario) -> ArmOptions {
    ArmOptions {
        base_link: arm.base_link.clone(),
        tip_link: arm.flange_link.clone(),
        package_directories: arm.package_directories.clone(),
        limit_overrides: arm
            .limit_overrides
            .iter()
            .map(|o| {
                (
                    o.joint.clone(),
                    LimitOverride {
                        effort: o.effort,
                        velocity: o.velocity,
                    },
                )
            })
            .collect(),
        skip_visuals: false,
    }
}

fn check_drives(scenario: &Scenario, chain: &KinematicChain) -> Result<(), CellError> {
    let known = |name: &str| chain.joints.iter().any(|joint| joint.name == name);
    match scenario.arm.drives.iter().find(|d| !known(&d.joint)) {
        None => Ok(()),
        Some(drive) => Err(CellError::DriveUnknown {
            file: scenario.path.clone(),
            joint: drive.joint.clone(),
            joints: chain.joints.iter().map(|j| j.name.clone()).collect(),
        }),
    }
}

fn check_seed_posture(scenario: &Scenario, arm: &KinematicChain) -> Result<(), CellError> {
    match &scenario.arm.seed_posture {
        Some(posture) if posture.len() != arm.len() => Err(CellError::SeedPosture {
            file: scenario.path.clone(),
            found: posture.len(),
            axes: arm.len(),
        }),
        _ => Ok(()),
    }
}

/// The arm's chain with the device's moving part, of a mass [kg], on a prismatic joint along the flange's z.
fn with_slide(arm: &KinematicChain, scenario: &Scenario, mass: f64) -> KinematicChain {
    let device = &scenario.device;
    let gyration = device.moving_radius_of_gyration;
    let mut chain = arm.clone();
    chain.joints.push(Joint {
        name: "device_slide".into(),
        kind: JointKind::Prismatic,
        parent_from_joint: arm.tip_from_last,
        axis: DVec3::Z,
        lower: 0.0,
        upper: device.parameters.full_stroke,
        effort: f64::INFINITY,
        velocity: f64::INFINITY,
        damping: 0.0,
        friction: 0.0,
        body: BodyInertia {
            mass,
            centre_of_mass: DVec3::new(0.0, 0.0, device.moving_centre_of_mass),
            inertia: DMat3::from_diagonal(DVec3::splat(mass * gyration * gyration)),
        },
    });
    chain.tip_from_last = DPose3::from_translation(DVec3::new(0.0, 0.0, device.tool_centre));
    chain
}

fn plan_request<'a>(
    scenario: &'a Scenario,
    arm: &'a KinematicChain,
    arm_with_slide: &'a KinematicChain,
    tool_path: ToolPath,
) -> PlanRequest<'a> {
    let (process, device) = (&scenario.process, &scenario.device);
    // A free slide stands at its outer end until the tool touches; a locked one does not move.
    let push_back = if device.locked {
        0.0
    } else {
        device.parameters.full_stroke - process.working_stroke
    };
    PlanRequest {
        arm,
        arm_with_slide,
        world_from_base: scenario.arm.world_from_base,
        gravity: scenario.simulation.gravity,
        tool_path,
        tool_distance: device.tool_centre + process.working_stroke,
        tool_radius: device.tool_radius,
        penetration: process.force / scenario.contact.stiffness,
        working_stroke: process.working_stroke,
        push_back,
        force: process.force,
        friction: scenario.contact.friction,
        feed: process.feed,
        corner_feed: process.corner_feed,
        limits: MotionLimits {
            acceleration: process.acceleration,
            jerk: process.jerk,
        },
        approach_distance: process.approach_distance,
        approach_speed: process.approach_speed,
        engage_speed: process.engage_speed,
        settle_time: process.settle_time,
        seed_posture: scenario.arm.seed_posture.as_deref(),
        seed: scenario.simulation.seed,
    }
}

/// The controller against the contact as the slide feels it: of the normal's stiffness the share along the axis, twice.
fn controller(scenario: &Scenario) -> Result<ForceController, ScenarioError> {
    let share = scenario.process.lean.cos().powi(2);
    ForceController::of_scenario(
        &scenario.controller,
        &scenario.device.parameters,
        &scenario.sensing,
        Some(PushOnly {
            stiffness: share * scenario.contact.stiffness,
            damping: share * scenario.contact.damping,
        }),
        scenario.simulation.step,
    )
}

/// The supply must give the force wherever the wrist turns, and gravity alone must not press harder than asked for. Returns the least and greatest
/// component of gravity along the tool's axis [m/s2].
fn check_supply(scenario: &Scenario, tool_path: &ToolPath) -> Result<[f64; 2], CellError> {
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    let map = PressureMap::new(&scenario.device.parameters);
    let axial = scenario.process.force * scenario.process.lean.cos();
    let device = &scenario.device.parameters;
    let (supply, giver) = attainable_set_pressure(device, &scenario.sensing.command);
    let length = tool_path.length();
    let count = (length / 5e-3).ceil().max(1.0) as usize;
    for i in 0..=count {
        let station = tool_path.at(length * i as f64 / count as f64);
        let gravity = scenario.simulation.gravity.dot(station.axis);
        range = [range[0].min(gravity), range[1].max(gravity)];
        let needed = map.unlimited(axial, gravity);
        if needed > supply || needed < 0.0 {
            return Err(CellError::Supply {
                file: scenario.path.clone(),
                force: scenario.process.force,
                edge_length: station.edge_length,
                needed,
                supply,
                giver,
                attainable: [map.force(0.0, gravity), map.force(supply, gravity)]
                    .map(|force| force / scenario.process.lean.cos()),
            });
        }
    }
    Ok(range)
}

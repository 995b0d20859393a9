//! What of a cell does not depend on where the part lies: loaded and checked once, planned as often as it takes.

use glam::{DMat3, DVec3};
use glamx::DPose3;

use super::collision;
use super::error::CellError;
use super::part::Part;
use super::payload::{FlangeLoad, with_housing};
use super::plant;
use super::recorded_arm;
use super::supply;
use crate::arm::chain::{BodyInertia, Joint, JointKind, KinematicChain};
use crate::arm::urdf::{Arm, ArmOptions, LimitOverride, load_arm};
use crate::collision::CollisionModel;
use crate::effects::actual;
use crate::path::profile::MotionLimits;
use crate::path::{Outline, Pass, Plan, PlanError, PlanRequest, ToolAxis, ToolPath};
use crate::plant::{Actual, PlantParameters};
use crate::scenario::{ArmScenario, PassScenario, Scenario};

/// Arm, device and part of a scenario.
pub struct Setup {
    /// Scenario from which it was made.
    pub scenario: Scenario,
    /// The arm.
    pub arm: Arm,
    /// The nominal arm with the device's slide as its last joint.
    pub arm_with_slide: KinematicChain,
    /// Its physics as it is.
    pub actual: Actual<PlantParameters>,
    /// Part, edge and burr.
    pub part: Part,
    /// What must not meet, the part at its nominal pose.
    pub collision: CollisionModel,
    /// Passes along the edge.
    pub passes: Vec<Pass>,
    /// Notes on what a user may not expect, one sentence each.
    pub notes: Vec<String>,
}

/// Where the part lies and how the tool stands to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stance {
    /// The part's pose.
    pub world_from_part: DPose3,
    /// The tool's axis.
    pub tool_axis: ToolAxis,
    /// Angle of the flange about it [rad]; chosen when absent.
    pub roll: Option<f64>,
}

impl Setup {
    /// Loads what the scenario names.
    ///
    /// # Errors
    /// Something is missing or refused; the error names file and key.
    pub fn load(mut scenario: Scenario) -> Result<Self, CellError> {
        let mut arm = load_arm(&scenario.arm.urdf, &arm_options(&scenario.arm))?;
        check_drives(&scenario, &arm.chain)?;
        recorded_arm::check(&scenario.arm, &arm.chain)?;
        plant::complete(&mut scenario.nominal, &scenario.arm, &arm.chain);
        let actual = actual(&scenario.nominal, &scenario.effects);
        plant::check(&scenario, &arm.chain, &actual)?;
        let frictions = scenario.nominal.cell.joint_friction;
        for (joint, friction) in arm.chain.joints.iter_mut().zip(frictions) {
            joint.friction = friction;
        }
        check_seed_posture(&scenario, &arm.chain)?;
        let flange = FlangeLoad::of(&scenario, &arm);
        flange.check(&scenario)?;
        let arm_with_slide = with_slide(&arm.chain, &scenario.nominal);
        let part = Part::load(&scenario)?;
        let mut notes = std::mem::take(&mut arm.notes);
        let mesh = scenario.workpiece.mesh.display();
        notes.extend(
            part.mesh
                .notes()
                .iter()
                .map(|note| format!("{mesh}: {note}")),
        );
        notes.extend(flange.notes());
        notes.extend(recorded_arm::note(&scenario.arm));
        let collision = collision::model(&scenario, &arm, &arm_with_slide, &part, &mut notes)?;
        Ok(Self {
            passes: passes(&scenario),
            scenario,
            arm,
            arm_with_slide,
            actual,
            part,
            collision,
            notes,
        })
    }

    /// The arm with the device's slide as it is.
    #[must_use]
    pub fn bodies(&self) -> KinematicChain {
        with_slide(&self.arm.chain, &self.actual)
    }

    /// How part and tool stand by the scenario.
    #[must_use]
    pub fn stance(&self) -> Stance {
        let process = &self.scenario.process;
        let lean = ToolAxis::Lean(process.lean);
        Stance {
            world_from_part: self.scenario.workpiece.world_from_part,
            tool_axis: process
                .tool_axis
                .map_or(lean, |axis| ToolAxis::Direction(axis.0)),
            roll: process.roll,
        }
    }

    /// The tool's path with part and tool standing otherwise.
    ///
    /// # Errors
    /// An inward corner, or a direction of the tool too far from the edge's bisector.
    pub fn tool_path(&self, stance: &Stance) -> Result<ToolPath, PlanError> {
        ToolPath::along(
            self.part.edge.clone(),
            stance.world_from_part,
            stance.tool_axis,
        )
    }

    /// The outline of the job with part and tool standing otherwise.
    ///
    /// # Errors
    /// What is in its way.
    pub fn outline(&self, stance: &Stance) -> Result<Outline, PlanError> {
        self.tried(stance, Plan::outline)
    }

    /// Whether the whole job can be done with part and tool standing otherwise.
    #[must_use]
    pub fn is_possible(&self, stance: &Stance) -> bool {
        let supplied = |path: &ToolPath| supply::check(&self.scenario, &self.passes, path).is_ok();
        self.tool_path(stance).as_ref().is_ok_and(supplied) && self.tried(stance, Plan::new).is_ok()
    }

    /// The plan of the job with part and tool standing otherwise, or its outline.
    ///
    /// # Errors
    /// What is in its way.
    pub fn tried<T>(
        &self,
        stance: &Stance,
        plan: impl Fn(&PlanRequest) -> Result<T, PlanError>,
    ) -> Result<T, PlanError> {
        let tool_path = self.tool_path(stance)?;
        let collision = self.collision.with_part_at(stance.world_from_part);
        if let Some(meeting) = collision.static_penetrations().into_iter().next() {
            return Err(PlanError::Penetration(Box::new(meeting)));
        }
        let request = PlanRequest {
            briefly: true,
            ..self.request(stance, &collision, tool_path)
        };
        plan(&request)
    }

    /// The job with part and tool standing otherwise, on a path and among bodies that do so too.
    #[must_use]
    pub fn request<'a>(
        &'a self,
        stance: &Stance,
        collision: &'a CollisionModel,
        tool_path: ToolPath,
    ) -> PlanRequest<'a> {
        let scenario = &self.scenario;
        let (process, nominal) = (&scenario.process, &scenario.nominal);
        // A free slide stands at its outer end until the tool touches; a locked one does not move.
        let push_back = if scenario.device.locked {
            0.0
        } else {
            nominal.device.full_stroke - process.working_stroke
        };
        PlanRequest {
            arm: &self.arm.chain,
            arm_with_slide: &self.arm_with_slide,
            world_from_base: scenario.arm.world_from_base,
            gravity: scenario.simulation.gravity,
            tool_path,
            tool_distance: nominal.mounting.tool_centre + process.working_stroke,
            tool_radius: nominal.mounting.tool_radius,
            penetration: process.force / nominal.contact.stiffness_at(process.force),
            working_stroke: process.working_stroke,
            push_back,
            force: self
                .passes
                .iter()
                .map(|pass| pass.force)
                .fold(0.0, f64::max),
            friction: nominal.cell.friction,
            passes: &self.passes,
            corner_feed: process.corner_feed,
            lateral_acceleration: process.lateral_acceleration,
            limits: MotionLimits {
                acceleration: process.acceleration,
                jerk: process.jerk,
            },
            approach_distance: process.approach_distance,
            approach_speed: process.approach_speed,
            engage_speed: process.engage_speed,
            settle_time: process.settle_time,
            collision: Some(collision),
            roll: stance.roll,
            seed_posture: scenario.arm.seed_posture.as_deref(),
            briefly: false,
            seed: scenario.simulation.seed,
        }
    }
}

/// The passes of a scenario, at least one.
pub(super) fn passes(scenario: &Scenario) -> Vec<Pass> {
    let process = &scenario.process;
    let pass = |pass: &PassScenario| Pass {
        force: pass.force.unwrap_or(process.force),
        feed: pass.feed.unwrap_or(process.feed),
    };
    match scenario.passes.as_slice() {
        [] => vec![pass(&PassScenario::default())],
        listed => listed.iter().map(pass).collect(),
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

/// The arm's chain with the device's housing on its flange and its moving part on a prismatic joint along the flange's z.
fn with_slide(arm: &KinematicChain, plant: &PlantParameters) -> KinematicChain {
    let (mounting, mass) = (&plant.mounting, plant.device.moving_mass);
    let gyration = mounting.moving_radius_of_gyration;
    let mut chain = with_housing(arm, mounting);
    chain.joints.push(Joint {
        name: "device_slide".into(),
        kind: JointKind::Prismatic,
        parent_from_joint: arm.tip_from_last,
        axis: DVec3::Z,
        lower: 0.0,
        upper: plant.device.full_stroke,
        effort: f64::INFINITY,
        velocity: f64::INFINITY,
        damping: 0.0,
        friction: 0.0,
        body: BodyInertia {
            mass,
            centre_of_mass: DVec3::new(0.0, 0.0, mounting.moving_centre_of_mass),
            inertia: DMat3::from_diagonal(DVec3::splat(mass * gyration * gyration)),
        },
    });
    chain.tip_from_last = DPose3::from_translation(DVec3::new(0.0, 0.0, mounting.tool_centre));
    chain
}

/// The parts of its file that a scenario's arm takes.
pub fn arm_options(arm: &ArmScenario) -> ArmOptions {
    ArmOptions {
        base_link: arm.base_link.clone(),
        tip_link: arm.flange_link.clone(),
        package_directories: arm.package_directories.clone(),
        link_masses: arm.link_masses.clone(),
        whole_mass: arm.whole_mass,
        tip_from_mount: arm.flange_from_mount,
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
        is_recorded: false,
    }
}

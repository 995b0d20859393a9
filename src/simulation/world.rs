//! Rapier behind one door: the arm and its slide as a reduced-coordinate multibody, the tool's ball on the part's mesh.
//!
//! Units SI, `f64` build of Rapier. Each degree of freedom is driven by a `JointLaw`, an affine force law that Rapier integrates implicitly through its
//! per-joint spring and damper; nothing else acts on a joint, so the torque that was really applied is known after the step.

use glam::DVec3;
use glamx::DPose3;
use rapier3d::prelude::*;

use super::contact::{ContactReading, PartContact, PartContactParameters};
use crate::arm::chain::{Chain, JointKind};
use crate::cell::Cell;
use crate::control::law::JointLaw;
use crate::workpiece::TriangleMesh;

/// Stiffness of the spring that carries a constant force [N/m or N m/rad]: too soft to act as a spring.
const CARRIER_STIFFNESS: f64 = 1e-3;

/// The ball nose of the tool on the last link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolBall {
    /// Radius [m].
    pub radius: f64,
    /// Centre in the last link's frame [m].
    pub centre_in_link: DVec3,
}

/// What the world is built from.
pub struct WorldDescription<'a> {
    /// Arm with the slide as its last joint.
    pub chain: &'a Chain,
    /// Pose of the arm's base.
    pub world_from_base: DPose3,
    /// Gravity [m/s2].
    pub gravity: DVec3,
    /// Step [s].
    pub step: f64,
    /// The tool.
    pub tool: ToolBall,
    /// The part, in the world frame, with its contact law.
    pub part: &'a TriangleMesh,
    /// Contact law.
    pub contact: PartContactParameters,
}

impl<'a> WorldDescription<'a> {
    /// The world of a cell.
    pub fn of(cell: &'a Cell) -> Self {
        let scenario = &cell.scenario;
        Self {
            chain: &cell.arm_with_slide,
            world_from_base: scenario.arm.world_from_base,
            gravity: scenario.simulation.gravity,
            step: scenario.simulation.step,
            tool: ToolBall {
                radius: scenario.device.tool_radius,
                centre_in_link: DVec3::new(0.0, 0.0, scenario.device.tool_centre),
            },
            part: &cell.part.mesh_in_world,
            contact: PartContactParameters {
                stiffness: scenario.contact.stiffness,
                damping: scenario.contact.damping,
                friction: scenario.contact.friction,
            },
        }
    }
}

/// The rigid-body world.
pub struct World {
    physics: PhysicsWorld,
    part_contact: PartContact,
    /// Handle of each joint, base first.
    joints: Vec<MultibodyJointHandle>,
    /// Rapier's axis index of each joint's only degree of freedom.
    axes: Vec<usize>,
    /// Link index of each joint in the multibody.
    links: Vec<usize>,
    tool_body: RigidBodyHandle,
    tool: ToolBall,
    laws: Vec<JointLaw>,
    positions: Vec<f64>,
    velocities: Vec<f64>,
    reading: ContactReading,
}

impl World {
    /// Builds the world with all joints at zero.
    pub fn new(description: &WorldDescription) -> Self {
        let mut physics = PhysicsWorld::new();
        physics.gravity = description.gravity;
        physics.integration_parameters = integration_parameters(description.step);
        physics.physics_pipeline.counters.disable();
        let base = physics.insert_body(RigidBodyBuilder::fixed().pose(description.world_from_base));
        let part = physics.insert_body(RigidBodyBuilder::fixed());

        let (mut joints, mut axes, mut parent) = (Vec::new(), Vec::new(), base);
        for joint in &description.chain.joints {
            let body = &joint.body;
            let properties =
                MassProperties::with_inertia_matrix(body.centre_of_mass, body.mass, body.inertia);
            let link = physics.insert_body(
                RigidBodyBuilder::dynamic()
                    .additional_mass_properties(properties)
                    .can_sleep(false),
            );
            // Or the engine would not know the mass before its first step.
            let colliders = &physics.colliders;
            physics.bodies[link].recompute_mass_properties_from_colliders(colliders);
            // Rapier's one free axis is x (linear or angular); a basis turns it onto the joint's axis.
            let basis = DPose3::from_rotation(GenericJoint::complete_ang_frame(joint.axis));
            let (locked, axis) = match joint.kind {
                JointKind::Revolute => (JointAxesMask::LOCKED_REVOLUTE_AXES, 3),
                JointKind::Prismatic => (JointAxesMask::LOCKED_PRISMATIC_AXES, 0),
            };
            let data = GenericJointBuilder::new(locked)
                .local_frame1(joint.parent_from_joint * basis)
                .local_frame2(basis)
                .build();
            let handle = physics
                .multibody_joints
                .insert(parent, link, data, true)
                .expect("a chain never closes a loop");
            joints.push(handle);
            axes.push(axis);
            parent = link;
        }
        let tool_body = parent;
        let part_contact = PartContact::insert(
            &mut physics,
            part,
            tool_body,
            description.part,
            description.tool,
            description.contact,
            description.step,
        );
        let count = joints.len();
        let links = joints
            .iter()
            .map(|&handle| {
                let (_, link) = physics.multibody_joints.get(handle).expect("just inserted");
                link
            })
            .collect();
        let mut world = Self {
            physics,
            part_contact,
            joints,
            axes,
            links,
            tool_body,
            tool: description.tool,
            laws: vec![JointLaw::default(); count],
            positions: vec![0.0; count],
            velocities: vec![0.0; count],
            reading: ContactReading::default(),
        };
        world.clear_joint_defaults();
        world
    }

    /// Rapier damps every angular degree of freedom by default; here only what the model says may act.
    fn clear_joint_defaults(&mut self) {
        let multibody = self.multibody_mut();
        multibody.damping_mut().fill(0.0);
        multibody.armature_mut().fill(0.0);
        multibody.frictions_mut().fill(0.0);
    }

    fn multibody(&self) -> &Multibody {
        self.physics
            .multibody_joints
            .get(self.joints[0])
            .expect("the multibody lives as long as the world")
            .0
    }

    fn multibody_mut(&mut self) -> &mut Multibody {
        self.physics
            .multibody_joints
            .get_mut_internal(self.joints[0])
            .expect("the multibody lives as long as the world")
            .0
    }

    /// Puts the joints at positions [rad or m] and at rest.
    pub fn set_positions(&mut self, positions: &[f64]) {
        let displacement: Vec<f64> = positions
            .iter()
            .zip(&self.positions)
            .map(|(target, now)| target - now)
            .collect();
        let physics = &mut self.physics;
        let (multibody, _) = physics
            .multibody_joints
            .get_mut(self.joints[0])
            .expect("the multibody lives as long as the world");
        multibody.forward_kinematics(&physics.bodies, true);
        multibody.apply_displacements(&displacement);
        multibody.generalized_velocity_mut().fill(0.0);
        multibody.forward_kinematics(&physics.bodies, false);
        multibody.update_rigid_bodies(&mut physics.bodies, true);
        self.read_joints();
    }

    /// Sets the law of each degree of freedom for the next steps.
    pub fn set_laws(&mut self, laws: &[JointLaw]) {
        self.laws.copy_from_slice(laws);
        let multibody = self
            .physics
            .multibody_joints
            .get_mut_internal(self.joints[0])
            .expect("the multibody lives as long as the world")
            .0;
        for (i, law) in laws.iter().enumerate() {
            let (stiffness, rest) = if law.stiffness > 0.0 {
                (law.stiffness, law.rest + law.force / law.stiffness)
            } else {
                (
                    CARRIER_STIFFNESS,
                    self.positions[i] + law.force / CARRIER_STIFFNESS,
                )
            };
            multibody.damping_mut()[i] = law.damping;
            if let Some(link) = multibody.link_mut(self.links[i]) {
                link.joint.set_spring(self.axes[i], stiffness, rest);
            }
        }
    }

    /// Advances by one step.
    pub fn step(&mut self) {
        let centre = self.tool_centre();
        self.part_contact
            .prepare(&mut self.physics, self.joints[0], self.tool_body, centre);
        self.physics.step_with_events(&(), &());
        self.read_joints();
        self.reading = self.part_contact.read(&self.physics);
    }

    fn read_joints(&mut self) {
        let (multibody, _) = self
            .physics
            .multibody_joints
            .get(self.joints[0])
            .expect("the multibody lives as long as the world");
        for i in 0..self.joints.len() {
            let link = multibody
                .link(self.links[i])
                .expect("each joint has its link");
            self.positions[i] = link.joint().coords()[self.axes[i]];
            self.velocities[i] = multibody.generalized_velocity()[i];
        }
    }

    /// Joint positions [rad or m].
    pub fn positions(&self) -> &[f64] {
        &self.positions
    }

    /// Joint velocities [rad/s or m/s].
    pub fn velocities(&self) -> &[f64] {
        &self.velocities
    }

    /// Force that a degree of freedom's law applied over the last step [N or N m].
    pub fn applied_force(&self, joint: usize) -> f64 {
        self.laws[joint].at(self.positions[joint], self.velocities[joint])
    }

    /// Contact over the last step.
    pub fn contact(&self) -> &ContactReading {
        &self.reading
    }

    /// Centre of the tool's ball in the world [m].
    pub fn tool_centre(&self) -> DVec3 {
        self.physics.bodies[self.tool_body]
            .position()
            .transform_point(self.tool.centre_in_link)
    }

    /// Poses of the links behind the joints in the world, base first; writes as many as `out` holds.
    pub fn link_poses(&self, out: &mut [DPose3]) {
        let multibody = self.multibody();
        for (pose, &link) in out.iter_mut().zip(&self.links) {
            let link = multibody.link(link).expect("each joint has its link");
            *pose = *link.local_to_world();
        }
    }

    /// The contact, to shift it while the run goes on (burr under the ball).
    pub fn part_contact_mut(&mut self) -> &mut PartContact {
        &mut self.part_contact
    }

    /// Torques that hold Rapier's bodies still against gravity at the current positions [N m or N]: minus the sum of J^T m g.
    pub fn gravity_torques(&self) -> nalgebra::DVector<f64> {
        let multibody = self.multibody();
        let mut torques = nalgebra::DVector::zeros(self.joints.len());
        for link in multibody.links() {
            let body = &self.physics.bodies[link.rigid_body_handle()];
            if !body.is_dynamic() {
                continue;
            }
            let weight = (self.physics.gravity * body.mass()).to_array();
            let jacobian = multibody.body_jacobian(link.link_id());
            torques -= jacobian
                .fixed_rows::<3>(0)
                .tr_mul(&nalgebra::Vector3::from(weight));
        }
        torques
    }

    /// Joint-space mass matrix of Rapier's bodies, row-major, at the current positions: sum of J^T diag(m, I) J.
    pub fn mass_matrix(&self) -> nalgebra::DMatrix<f64> {
        let multibody = self.multibody();
        let count = self.joints.len();
        let mut matrix = nalgebra::DMatrix::zeros(count, count);
        for link in multibody.links() {
            let body = &self.physics.bodies[link.rigid_body_handle()];
            if !body.is_dynamic() {
                continue;
            }
            let jacobian = multibody.body_jacobian(link.link_id());
            let inertia = body.mass_properties().effective_angular_inertia();
            let mass = body.mass();
            let mut weighted = jacobian.clone_owned();
            for column in 0..count {
                let linear = jacobian.fixed_view::<3, 1>(0, column) * mass;
                let angular = DVec3::new(
                    jacobian[(3, column)],
                    jacobian[(4, column)],
                    jacobian[(5, column)],
                );
                let angular = inertia * angular;
                weighted
                    .fixed_view_mut::<3, 1>(0, column)
                    .copy_from(&linear);
                for (row, value) in angular.to_array().into_iter().enumerate() {
                    weighted[(3 + row, column)] = value;
                }
            }
            matrix += jacobian.transpose() * weighted;
        }
        matrix
    }
}

/// Parameters under which Rapier's soft contact is the spring and damper that `PartContact` asks for: one backward-Euler solve a step, no second
/// pass that would undo the spring's velocity, no cap on its recovery.
fn integration_parameters(step: f64) -> IntegrationParameters {
    IntegrationParameters {
        dt: step,
        num_solver_iterations: 1,
        num_internal_pgs_iterations: 1,
        num_internal_stabilization_iterations: 0,
        normalized_allowed_linear_error: 0.0,
        normalized_max_corrective_velocity: f64::MAX,
        normalized_prediction_distance: 2e-3,
        max_ccd_substeps: 0,
        contact_clustering: false,
        contact_recycling: false,
        friction_model: FrictionModel::Coulomb,
        ..IntegrationParameters::default()
    }
}

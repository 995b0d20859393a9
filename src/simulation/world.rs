//! Rapier behind one door: the arm and its slide as a reduced-coordinate multibody, the tool's ball on the part's mesh.
//!
//! Units SI, `f64` build of Rapier. Each degree of freedom is driven by a `JointLaw`, an affine force law; nothing else acts on a joint, so the torque that was
//! really applied is known after the step. The law acts at one moment of the step,
//!
//! ```text
//! v_m = (1 - theta) v + theta v',   q_m = q + theta h v_m,   q' = q + h v_m
//! ```
//!
//! v, v' speeds at its start and end. theta = 1/(1 - exp(-z)) - 1/z, z = h times the law's own rate, is exact for a decay at that rate: 1/2, the implicit
//! midpoint rule of second order, where the step resolves the law, 1 where it does not (exponential fitting: Liniger, Willoughby, SIAM J. Numer. Anal. 7,
//! 1970). Rapier's per-joint spring and damper take the part in v' implicitly, and q' is put right after its step, which takes theta as 1.
//!
//! Where it may, Rapier is asked in one of several steps alone: in between, the arm moves by what Rapier had last (`held_arm`), with the same laws. It is asked in each
//! step while the tool may stick to the part, where a drive is at its limit, and for as long as what was lacking at its last step says so.

mod hold;

use glam::DVec3;
use glamx::DPose3;
use rapier3d::prelude::*;

use super::contact::{ContactReading, PartContact, ToolBall};
use super::held_arm::{HeldArm, Joints};
use super::lever::Lever;
use super::rates::Rates;
use crate::arm::chain::{JointKind, KinematicChain, MAX_JOINTS};
use crate::arm::kinematics::link_poses;
use crate::cell::Cell;
use crate::control::law::{DriveLimit, JointLaw};
use crate::device::PistonMotion;
use crate::plant::{Relief, Touch};
use crate::workpiece::TriangleMesh;

/// Stiffness of the spring that carries a constant force [N/m or N m/rad]: too soft to act as a spring.
const CONSTANT_LOAD_STIFFNESS: f64 = 1e-3;

/// Description from which the world is built.
pub struct WorldDescription<'a> {
    /// Arm with the slide as its last joint.
    pub chain: KinematicChain,
    /// Pose of the arm's base.
    pub world_from_base: DPose3,
    /// Gravity [m/s2].
    pub gravity: DVec3,
    /// Step [s].
    pub step: f64,
    /// The tool.
    pub tool: ToolBall,
    /// The part, in the world frame.
    pub part: &'a TriangleMesh,
    /// Coulomb friction coefficient of the tool on it [1].
    pub friction: f64,
    /// Most steps for one of Rapier's.
    pub most_held: usize,
}

impl<'a> WorldDescription<'a> {
    /// The world of a cell.
    pub fn of(cell: &'a Cell) -> Self {
        let (scenario, actual) = (&cell.setup.scenario, &cell.setup.actual);
        Self {
            chain: cell.setup.bodies(),
            world_from_base: scenario.arm.world_from_base,
            gravity: scenario.simulation.gravity,
            step: scenario.simulation.step,
            tool: ToolBall {
                radius: actual.mounting.tool_radius,
                centre_in_link: DVec3::new(0.0, 0.0, actual.mounting.tool_centre),
            },
            part: &cell.setup.part.mesh_in_world,
            // A tool that turns rubs against its own surface's motion (`cutting`), not against its travel.
            friction: match scenario.tool {
                Some(_) => 0.0,
                None => actual.cell.friction,
            },
            most_held: scenario.simulation.arm_steps,
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
    /// Axis of the last joint, the slide's, in its link's frame.
    slide_axis: DVec3,
    step: f64,
    /// Each joint's own inertia where it was put last [kg m2 or kg].
    inertias: Vec<f64>,
    laws: Vec<JointLaw>,
    /// Drive of each joint.
    drives: Vec<Drive>,
    /// The theta of each law.
    moments: Vec<f64>,
    /// Force [N or N m] and speed of each joint at the moment of the last step in which its law acts.
    applied: Vec<(f64, f64)>,
    /// Positions at the start of the step [rad or m].
    starts: Vec<f64>,
    positions: Vec<f64>,
    velocities: Vec<f64>,
    /// What the last step added to them [rad/s or m/s].
    gained: Joints,
    /// Positions at which Rapier's bodies stand [rad or m], and the ball there.
    seen: Vec<f64>,
    seen_lever: Lever,
    /// The ball where the joints are.
    lever: Lever,
    reading: ContactReading,
    /// Force on the tool [N] over the coming step that acts so far off the ball's centre [m].
    pushed: (DVec3, DVec3),
    friction: f64,
    chain: KinematicChain,
    world_from_base: DPose3,
    /// The arm as Rapier had it last.
    held: HeldArm,
    rates: Rates,
}

/// The drive in a joint's law.
#[derive(Debug, Clone, Copy, Default)]
struct Drive {
    /// Its limit; none where nothing limits it.
    limit: Option<DriveLimit>,
    /// Its torque over the last step [N m], where it has a limit.
    torque: f64,
    /// Whether the limit cut it.
    cut: bool,
}

/// Where in a step a law acts that decays by `z` in it.
fn moment(z: f64) -> f64 {
    if z < 1e-3 {
        0.5 + z / 12.0
    } else {
        -1.0 / (-z).exp_m1() - 1.0 / z
    }
}

/// Puts an arm's links on a base; gives the handle of each joint, Rapier's axis index of its only degree of freedom, and the last link.
fn insert_arm(
    physics: &mut PhysicsWorld,
    base: RigidBodyHandle,
    chain: &KinematicChain,
) -> (Vec<MultibodyJointHandle>, Vec<usize>, RigidBodyHandle) {
    let (mut joints, mut axes, mut parent) = (Vec::new(), Vec::new(), base);
    for joint in &chain.joints {
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
    (joints, axes, parent)
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

        let (joints, axes, tool_body) = insert_arm(&mut physics, base, &description.chain);
        let part_contact = PartContact::insert(
            &mut physics,
            part,
            tool_body,
            description.part,
            description.tool,
            description.friction,
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
            slide_axis: description.chain.joints[count - 1].axis,
            step: description.step,
            inertias: vec![f64::INFINITY; count],
            laws: vec![JointLaw::default(); count],
            drives: vec![Drive::default(); count],
            moments: vec![0.5; count],
            applied: vec![(0.0, 0.0); count],
            starts: vec![0.0; count],
            positions: vec![0.0; count],
            velocities: vec![0.0; count],
            gained: [0.0; MAX_JOINTS],
            seen: vec![0.0; count],
            seen_lever: Lever::new(DVec3::ZERO, DVec3::Z, []),
            lever: Lever::new(DVec3::ZERO, DVec3::Z, []),
            reading: ContactReading::default(),
            pushed: (DVec3::ZERO, DVec3::ZERO),
            friction: description.friction,
            chain: description.chain.clone(),
            world_from_base: description.world_from_base,
            held: HeldArm::default(),
            rates: Rates::new(description.most_held),
        };
        world.clear_joint_defaults();
        world
    }

    /// Rapier damps every angular degree of freedom by default; here only what the model says may act.
    fn clear_joint_defaults(&mut self) {
        let physics = &mut self.physics;
        let multibodies = &mut physics.multibody_joints;
        let (multibody, _) = multibodies
            .get_mut_internal(self.joints[0])
            .expect("the multibody lives as long as the world");
        // It learns only now that its root is fixed, and which degrees of freedom it has.
        multibody.forward_kinematics(&physics.bodies, true);
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
        self.positions.copy_from_slice(positions);
        self.velocities.fill(0.0);
        self.gained = [0.0; MAX_JOINTS];
        self.tell_bodies();
        let physics = &mut self.physics;
        let (multibody, _) = physics
            .multibody_joints
            .get_mut(self.joints[0])
            .expect("the multibody lives as long as the world");
        multibody.forward_kinematics(&physics.bodies, false);
        multibody.update_rigid_bodies(&mut physics.bodies, true);
        self.read_joints();
        self.positions.copy_from_slice(&self.seen);
        self.lever = self.seen_lever;
        self.held.forget();
        let masses = self.mass_matrix();
        self.inertias = (0..self.joints.len()).map(|i| masses[(i, i)]).collect();
    }

    /// Takes Rapier's joints to where and as fast as the joints are; its bodies follow at the start of its next step.
    fn tell_bodies(&mut self) {
        let mut motions = [0.0; MAX_JOINTS];
        for (motion, (to, from)) in motions
            .iter_mut()
            .zip(self.positions.iter().zip(&self.seen))
        {
            *motion = to - from;
        }
        let multibody = self
            .physics
            .multibody_joints
            .get_mut_internal(self.joints[0])
            .expect("the multibody lives as long as the world")
            .0;
        multibody.apply_displacements(&motions[..self.positions.len()]);
        multibody
            .generalized_velocity_mut()
            .copy_from_slice(&self.velocities);
    }

    /// The ball where Rapier's bodies stand.
    fn seen_ball(&self) -> Lever {
        let body = &self.physics.bodies[self.tool_body];
        let centre = body.position().transform_point(self.tool.centre_in_link);
        let arm = centre - body.mass_properties().world_com;
        let link = self.links[self.joints.len() - 1];
        let columns = self.multibody().body_jacobian(link).column_iter();
        let columns = columns.map(|column| {
            let linear = DVec3::new(column[0], column[1], column[2]);
            let angular = DVec3::new(column[3], column[4], column[5]);
            (linear + angular.cross(arm), angular)
        });
        Lever::new(centre, body.rotation() * self.slide_axis, columns)
    }

    /// Sets the length of the steps to come [s].
    pub fn set_step(&mut self, step: f64) {
        self.step = step;
        self.physics.integration_parameters.dt = step;
        self.part_contact.set_step(step);
    }

    /// Sets the limit of the drive in each degree of freedom's law from now on; none where nothing limits it.
    pub fn set_limits(&mut self, limits: &[Option<DriveLimit>]) {
        for (drive, limit) in self.drives.iter_mut().zip(limits) {
            drive.limit = *limit;
        }
    }

    /// Sets the law of each degree of freedom for the next step.
    pub fn set_laws(&mut self, laws: &[JointLaw]) {
        self.laws.copy_from_slice(laws);
        for (i, law) in laws.iter().enumerate() {
            let inertia = self.inertias[i];
            let rate = (law.damping / inertia).max((law.stiffness / inertia).sqrt());
            self.moments[i] = moment(self.step * rate);
        }
    }

    /// Force of a joint's law as far as the step's end has no part in it [N m or N].
    fn early(&self, i: usize) -> f64 {
        let (theta, h) = (self.moments[i], self.step);
        let early = (1.0 - theta) * self.velocities[i];
        self.laws[i].at(self.positions[i] + theta * h * early, early)
    }

    /// Has Rapier's joints act by their laws, and by further forces [N m or N].
    fn tell_laws(&mut self, further: &Joints) {
        for (i, further) in further.iter().enumerate().take(self.joints.len()) {
            let (law, theta, q) = (self.laws[i], self.moments[i], self.positions[i]);
            let force = self.early(i) + further;
            let stiffness = match law.stiffness > 0.0 {
                true => theta * theta * law.stiffness,
                false => CONSTANT_LOAD_STIFFNESS,
            };
            let (axis, link) = (self.axes[i], self.links[i]);
            let multibody = self.multibody_mut();
            multibody.damping_mut()[i] = theta * law.damping;
            if let Some(link) = multibody.link_mut(link) {
                link.joint
                    .set_spring(axis, stiffness, q + force / stiffness);
            }
        }
    }

    /// Where the tool touches the part, or is about to, whose surface is off its mesh by `relief`.
    pub fn touches(&mut self, relief: &Relief, touches: &mut Vec<Touch>) {
        // The bodies' own velocities are those of the step before.
        let arm = &self.velocities[..self.joints.len() - 1];
        let velocity = self.lever.velocity(arm, DVec3::ZERO);
        let (centre, axis) = (self.lever.centre, self.lever.axis);
        self.part_contact
            .find(relief, centre, velocity, axis, touches);
    }

    /// Has a force [N] act on the tool over the coming step, where it touches along a normal.
    pub fn push_tool(&mut self, force: DVec3, normal: DVec3) {
        self.pushed = (force, -normal * self.tool.radius);
    }

    /// Adds to forces of the joints [N m or N] what a force on the ball [N] does.
    pub fn add_force(&self, force: DVec3, out: &mut [f64]) {
        self.lever.add_force(force, DVec3::ZERO, out);
    }

    /// Advances by one step, the tool pressed on the part with forces [N] along normals. The slide ends where its own law took it, `slide`, moved on by what
    /// the arm did meanwhile that this law did not know; as the law set for it says where there is none.
    pub fn step(&mut self, pressed: &[(DVec3, f64)], slide: Option<PistonMotion>) {
        self.starts.copy_from_slice(&self.positions);
        for (applied, speed) in self.applied.iter_mut().zip(&self.velocities) {
            applied.1 = *speed;
        }
        self.take(pressed);
        self.pushed = (DVec3::ZERO, DVec3::ZERO);
        for (i, gained) in self.gained.iter_mut().enumerate().take(self.joints.len()) {
            *gained = self.velocities[i] - self.applied[i].1;
        }
        self.end(slide);
    }

    /// Asks Rapier for the step, and for the friction of a tool that may stick.
    fn ask(&mut self, pressed: &[(DVec3, f64)]) {
        self.part_contact.press(
            &self.physics,
            self.joints[0],
            self.tool_body,
            self.lever.centre,
            pressed,
        );
        self.push(&[self.pushed]);
        self.advance(&[0.0; MAX_JOINTS]);
        self.reading = self.part_contact.read(&self.physics);
        self.rates.unsteady();
        if !self.rates.every_step() {
            self.learn_anew(pressed);
        }
    }

    /// Forces [N] on the tool over Rapier's next step, so far off the ball's centre [m].
    fn push(&mut self, forces: &[(DVec3, DVec3)]) {
        let motions = self.off_seen();
        let body = &mut self.physics.bodies[self.tool_body];
        let back = self.seen_lever.centre - body.mass_properties().world_com;
        // Where the body will be by then.
        let back = self.seen_lever.turned(back, &motions);
        body.reset_forces(true);
        body.reset_torques(true);
        for (force, arm) in forces {
            body.add_force(*force, true);
            body.add_torque((back + *arm).cross(*force), true);
        }
    }

    /// Has Rapier advance by the step, further forces [N m or N] on its joints.
    fn advance(&mut self, further: &Joints) {
        self.tell_bodies();
        self.tell_laws(further);
        self.physics.step_with_events(&(), &());
        self.read_joints();
    }

    /// Ends a step whose speeds are known.
    fn end(&mut self, slide: Option<PistonMotion>) {
        let h = self.step;
        let last = self.joints.len() - 1;
        for i in 0..=last {
            let (force, speed) = self.at_moment(i);
            self.applied[i] = match self.drives[i] {
                Drive {
                    limit: Some(limit),
                    torque,
                    cut: true,
                } => (torque + limit.losses.at(0.0, speed), speed),
                _ => (force, speed),
            };
            self.positions[i] = match slide {
                Some(slide) if i == last => {
                    slide.stroke + 0.5 * h * (self.velocities[i] - slide.speed)
                }
                _ => self.starts[i] + h * speed,
            };
        }
        self.lever = self.seen_lever.after(&self.off_seen()[..=last]);
    }

    /// How far the joints are from where Rapier's bodies stand [rad or m].
    fn off_seen(&self) -> Joints {
        let mut off = [0.0; MAX_JOINTS];
        let pairs = self.positions.iter().zip(&self.seen);
        for (off, (to, from)) in off.iter_mut().zip(pairs) {
            *off = to - from;
        }
        off
    }

    /// Force of a joint's law [N or N m] and its speed at the moment of the step in which it acts, as the step has left it.
    fn at_moment(&self, i: usize) -> (f64, f64) {
        let (q, v, theta) = (self.starts[i], self.applied[i].1, self.moments[i]);
        let speed = (1.0 - theta) * v + theta * self.velocities[i];
        (self.laws[i].at(q + theta * self.step * speed, speed), speed)
    }

    /// Holds every drive within its limit. Laws act implicitly, so that what a drive gives is known after the step alone; where it is beyond the limit the
    /// step is what it would have been with the limit in place of the law: with E its joint, A the step's mass matrix with all laws,
    ///
    /// ```text
    /// dv = A^-1 E p,   p/h - theta (k_d + theta h k_p) dv = tau_limit - tau
    /// ```
    fn limit_drives(&mut self) {
        let mut cut: Vec<(usize, f64)> = Vec::new();
        let mut velocities = Vec::new();
        loop {
            let before = cut.len();
            for i in 0..self.joints.len() {
                let Some(limit) = self.drives[i].limit else {
                    continue;
                };
                if cut.iter().any(|(joint, _)| *joint == i) {
                    continue;
                }
                let (force, speed) = self.at_moment(i);
                let torque = force - limit.losses.at(0.0, speed);
                (self.drives[i].torque, self.drives[i].cut) = (torque, false);
                if torque.abs() > limit.effort {
                    cut.push((i, limit.effort.copysign(torque)));
                }
            }
            if cut.len() == before {
                return;
            }
            match before {
                0 => velocities.clone_from(&self.velocities),
                _ => self.velocities.copy_from_slice(&velocities),
            }
            self.cut_drives(&cut);
        }
    }

    /// Makes the speeds of a step those that it has with drives of some joints at a torque [N m].
    fn cut_drives(&mut self, cut: &[(usize, f64)]) {
        let (h, count) = (self.step, self.joints.len());
        let responses: Vec<nalgebra::DVector<f64>> = cut
            .iter()
            .map(|&(joint, _)| {
                let mut response = nalgebra::DVector::zeros(count);
                response[joint] = 1.0;
                self.multibody()
                    .inv_augmented_mass()
                    .solve_mut(&mut response);
                response
            })
            .collect();
        let size = cut.len();
        let mut equations = nalgebra::DMatrix::zeros(size, size);
        let mut wanted = nalgebra::DVector::zeros(size);
        for (row, &(joint, torque)) in cut.iter().enumerate() {
            let (law, theta) = (self.laws[joint], self.moments[joint]);
            let (force, speed) = self.at_moment(joint);
            let drive = &mut self.drives[joint];
            (drive.torque, drive.cut) = (torque, true);
            let losses = drive
                .limit
                .map_or(JointLaw::default(), |limit| limit.losses);
            let yielding = theta * (law.damping - losses.damping + theta * h * law.stiffness);
            wanted[row] = torque - (force - losses.at(0.0, speed));
            for (column, response) in responses.iter().enumerate() {
                equations[(row, column)] = -yielding * response[joint];
            }
            equations[(row, row)] += 1.0 / h;
        }
        if let Some(impulses) = equations.lu().solve(&wanted) {
            for (response, impulse) in responses.iter().zip(impulses.iter()) {
                for (speed, gained) in self.velocities.iter_mut().zip(response.iter()) {
                    *speed += impulse * gained;
                }
            }
        }
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
            self.seen[i] = link.joint().coords()[self.axes[i]];
            self.velocities[i] = multibody.generalized_velocity()[i];
        }
        self.seen_lever = self.seen_ball();
    }

    /// Joint positions [rad or m].
    pub fn positions(&self) -> &[f64] {
        &self.positions
    }

    /// Joint velocities [rad/s or m/s].
    pub fn velocities(&self) -> &[f64] {
        &self.velocities
    }

    /// Force that a degree of freedom's law applied over the last step [N or N m], and its speed then [rad/s or m/s].
    pub fn applied(&self, joint: usize) -> (f64, f64) {
        self.applied[joint]
    }

    /// Torque of a limited drive over the last step [N m], and whether its limit cut it.
    pub fn drive(&self, joint: usize) -> (f64, bool) {
        (self.drives[joint].torque, self.drives[joint].cut)
    }

    /// Contact over the last step.
    pub fn contact(&self) -> &ContactReading {
        &self.reading
    }

    /// Centre of the tool's ball in the world [m].
    pub fn tool_centre(&self) -> DVec3 {
        self.lever.centre
    }

    /// Poses of the links behind the joints in the world, base first.
    pub fn link_poses(&self, out: &mut [DPose3]) {
        link_poses(&self.chain, self.world_from_base, &self.positions, out);
    }

    /// Steps so far, and Rapier's among them.
    pub fn asked(&self) -> (usize, usize) {
        self.rates.counts()
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

/// Parameters under which Rapier's soft contact carries the force that `PartContact` asks for: one solve a step, no second pass that would undo its
/// velocity, no cap on its recovery.
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

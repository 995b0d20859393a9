//! Tool on part: where the ball touches, and Rapier's contact made to carry the force that the contact law has there.
//!
//! ```text
//! p = r + l - d,   p' = l' - n.u - (n.a) x'                    penetration of the ball along a contact's normal n and its rate
//! ```
//!
//! r radius [m], d distance of the ball's centre from the part [m], l how far the part stands out (burr) [m], u velocity of the ball with the slide held
//! [m/s], a slide's axis, x' its speed [m/s]. The law itself is the plant's (`plant::ContactParameters`), integrated with the slide (`slide`).
//!
//! Rapier's contact is soft in terms of a natural frequency w and the constraint's own effective mass m: impulse = -h m w^2 (s + h v), s separation, v its rate
//! (Catto's soft step, undamped). With w so small that the rate does not count, a separation of -F/(m w^2) is a force F, and Rapier adds the friction that
//! goes with it.
//!
//! The mesh's triangles meet the ball several times at one place: at an internal edge from the side (ghosts) and at a sharp edge from both faces (twice
//! the stiffness). Only true contacts, local minima of the distance to the part, count: `ContactSurface` finds them, `dispatch` hands them over.

use glam::DVec3;
use nalgebra::DVector;
use rapier3d::prelude::*;

use super::dispatch::{TrueContact, TrueContacts};
use crate::plant::{Relief, Touch};
use crate::workpiece::{ContactSurface, SurfaceContact, TriangleMesh};

/// Distance ahead of touching at which a contact is offered to the slide [m].
const REACH: f64 = 1e-3;
/// Natural frequency of a contact that carries a given force [rad/s].
const CONSTANT_LOAD_RATE: f64 = 0.1;

/// The ball nose of the tool on the last link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolBall {
    /// Radius [m].
    pub radius: f64,
    /// Centre in the last link's frame [m].
    pub centre_in_link: DVec3,
}

/// Contact force over a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ContactReading {
    /// Sum of the normal force magnitudes [N].
    pub normal_force: f64,
    /// Friction on the tool in the world [N].
    pub friction: DVec3,
}

/// The contact pair of tool and part.
pub struct PartContact {
    part_collider: ColliderHandle,
    contacts: TrueContacts,
    surface: ContactSurface,
    tool: ToolBall,
    tool_collider: ColliderHandle,
    step: f64,
    found: Vec<SurfaceContact>,
    /// Whether a step has been made: before it the engine has no factorised mass matrix.
    stepped: bool,
    jacobian: DVector<f64>,
    response: DVector<f64>,
}

impl PartContact {
    /// Puts the part and the tool's ball into the world, with a Coulomb friction coefficient [1].
    pub(super) fn insert(
        physics: &mut PhysicsWorld,
        part_body: RigidBodyHandle,
        tool_body: RigidBodyHandle,
        part: &TriangleMesh,
        tool: ToolBall,
        friction: f64,
        step: f64,
    ) -> Self {
        let contacts = TrueContacts::default();
        physics.narrow_phase = NarrowPhase::with_query_dispatcher(contacts.clone());
        physics.integration_parameters.static_contact_softness =
            SpringCoefficients::new(CONSTANT_LOAD_RATE / std::f64::consts::TAU, 0.0);
        // Rapier takes no more from it than its box, to know when the pair is near; `surface` knows the mesh.
        let mesh = ColliderBuilder::trimesh(part.vertices().to_vec(), part.triangles().to_vec())
            .expect("a part's mesh holds at least one triangle")
            .density(0.0)
            .friction(friction)
            .friction_combine_rule(CoefficientCombineRule::Average);
        let part_collider = physics.insert_collider(mesh, Some(part_body));
        let ball = ColliderBuilder::ball(tool.radius)
            .translation(tool.centre_in_link)
            .density(0.0)
            .friction(friction)
            .friction_combine_rule(CoefficientCombineRule::Average);
        let tool_collider = physics.insert_collider(ball, Some(tool_body));
        Self {
            part_collider,
            contacts,
            surface: ContactSurface::new(part),
            tool,
            tool_collider,
            step,
            found: Vec::new(),
            stepped: false,
            jacobian: DVector::zeros(0),
            response: DVector::zeros(0),
        }
    }

    /// Puts into `touches` where a ball at `centre` touches, `velocity` [m/s] being its velocity with the slide held and `axis` the slide's.
    pub(super) fn find(
        &mut self,
        relief: &Relief,
        centre: DVec3,
        velocity: DVec3,
        axis: DVec3,
        touches: &mut Vec<Touch>,
    ) {
        let radius = self.tool.radius;
        let reach = radius + REACH + relief.height.max(0.0);
        let seen = centre - relief.aside;
        self.surface.genuine_contacts(seen, reach, &mut self.found);
        touches.clear();
        touches.extend(self.found.iter().map(|contact| {
            // A rising burr leans the normal back against the motion.
            let normal = (contact.normal - relief.gradient).normalize();
            let above = contact.distance - radius - relief.height;
            Touch {
                normal,
                penetration: -above * normal.dot(contact.normal),
                rate: -normal.dot(velocity) + relief.rate * normal.dot(contact.normal),
                share: -normal.dot(axis),
                damped: true,
            }
        }));
    }

    /// Sets the length of the steps to come [s].
    pub(super) fn set_step(&mut self, step: f64) {
        self.step = step;
    }

    /// Has the tool pressed with given forces [N] along normals over the coming step.
    pub(super) fn press(
        &mut self,
        physics: &PhysicsWorld,
        joint: MultibodyJointHandle,
        tool_body: RigidBodyHandle,
        centre: DVec3,
        forces: &[(DVec3, f64)],
    ) {
        let separation = |&(normal, force): &(DVec3, f64)| {
            let point = centre - normal * self.tool.radius;
            let mass = self.effective_mass(physics, joint, tool_body, normal, point);
            let stiffness = mass.unwrap_or(1.0) * CONSTANT_LOAD_RATE * CONSTANT_LOAD_RATE;
            TrueContact {
                normal,
                separation: -force / stiffness,
            }
        };
        let pressing = forces.iter().filter(|(_, force)| *force > 0.0);
        let pressing: Vec<TrueContact> = pressing.map(separation).collect();
        self.contacts.with(|contacts| *contacts = pressing);
    }

    /// Has nothing pressed over the engine's coming step.
    pub(super) fn lift(&mut self) {
        self.contacts.with(Vec::clear);
        self.stepped = true;
    }

    /// Mass that a push along `direction` at `point` feels, as Rapier's solver will see it [kg]; unknown before the first step.
    fn effective_mass(
        &mut self,
        physics: &PhysicsWorld,
        joint: MultibodyJointHandle,
        tool_body: RigidBodyHandle,
        direction: DVec3,
        point: DVec3,
    ) -> Option<f64> {
        let (multibody, _) = physics.multibody_joints.get(joint)?;
        let link = physics.multibody_joints.rigid_body_link(tool_body)?;
        let count = multibody.ndofs();
        if !self.stepped {
            return None;
        }
        if self.jacobian.len() != count {
            self.jacobian = DVector::zeros(count);
            self.response = DVector::zeros(count);
        }
        let arm = point - physics.bodies[tool_body].mass_properties().world_com;
        let torque = arm.cross(direction);
        let wrench = nalgebra::Vector6::new(
            direction.x,
            direction.y,
            direction.z,
            torque.x,
            torque.y,
            torque.z,
        );
        self.jacobian
            .gemv_tr(1.0, multibody.body_jacobian(link.id), &wrench, 0.0);
        self.response.copy_from(&self.jacobian);
        multibody.inv_augmented_mass().solve_mut(&mut self.response);
        Some(1.0 / self.jacobian.dot(&self.response))
    }

    /// Reads the forces of the last step.
    pub(super) fn read(&mut self, physics: &PhysicsWorld) -> ContactReading {
        self.stepped = true;
        let mut reading = ContactReading::default();
        let part = self.part_collider;
        for pair in physics.narrow_phase.contact_pairs_with(self.tool_collider) {
            let part_first = pair.collider1 == part;
            for manifold in pair.manifolds() {
                if manifold.data.solver_contacts.is_empty() {
                    continue;
                }
                for point in &manifold.points {
                    let tangent = point.data.warmstart_tangent_world / self.step;
                    reading.normal_force += point.data.impulse / self.step;
                    reading.friction += if part_first { -tangent } else { tangent };
                }
            }
        }
        reading
    }
}

//! Tool on part: Rapier's contact made to obey a stiffness and damping in N/m and N s/m, once per true contact.
//!
//!     F = k d + c d_dot, never pulling                                       d penetration of the ball [m]
//!
//! Rapier's contact is soft in terms of a natural frequency and a damping ratio of the constraint's own effective mass m, and takes one backward-Euler
//! step of it (Catto's soft step): impulse = -h (k' (s + h v) + c' v), s separation at the start, v its rate at the end of the step, k' = m w^2, c' = 2 z m w.
//! With m known, w and z follow from what k' and c' should be. k' = k: the static penetration is F/k. The position term is taken h v ahead, which damps a
//! ringing contact by k h too much; so c' = c_h - (1 - theta) k h, where c_h = m (e^(h c / m) - 1) / h makes one step shrink the motion just as the
//! continuous damper does, and theta in 0..1 gives back the implicit term when w h is too large for an explicit spring.
//!
//! The mesh's triangles meet the ball several times at one place: at an internal edge from the side (ghosts) and at a sharp edge from both faces (twice
//! the stiffness). Only true contacts, local minima of the distance to the part, reach the solver: `ContactSurface` finds them, `dispatch` hands them over.

use glam::DVec3;
use nalgebra::DVector;
use rapier3d::prelude::*;

use super::dispatch::{TrueContact, TrueContacts};
use super::world::ToolBall;
use crate::workpiece::{ContactSurface, SurfaceContact, TriangleMesh};

/// How far ahead of touching a contact is offered to the solver [m].
const REACH: f64 = 1e-3;
/// Steps for which an effective mass is kept while the contact lasts: the arm turns by 1e-3 rad at most meanwhile.
const MASS_STEPS: u32 = 8;
/// w h up to which an explicit spring is accurate.
const EXPLICIT_LIMIT: f64 = 0.5;

/// Contact law between tool and part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartContactParameters {
    /// Stiffness [N/m].
    pub stiffness: f64,
    /// Damping [N s/m].
    pub damping: f64,
    /// Coulomb friction coefficient [1].
    pub friction: f64,
}

/// Contact force over a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ContactReading {
    /// Sum of the normal force magnitudes [N].
    pub normal_force: f64,
    /// Force on the tool in the world, friction included [N].
    pub force_on_tool: DVec3,
    /// Magnitude of the friction force [N].
    pub friction_force: f64,
    /// Deepest penetration at the start of the step [m]; negative when apart.
    pub penetration: f64,
    /// Outward normal of the deepest contact, zero where there is none [1].
    pub normal: DVec3,
}

/// The contact pair of tool and part.
pub struct PartContact {
    part_collider: ColliderHandle,
    contacts: TrueContacts,
    surface: ContactSurface,
    parameters: PartContactParameters,
    tool: ToolBall,
    tool_collider: ColliderHandle,
    step: f64,
    /// Height and slope of the burr under the ball.
    lift: f64,
    lift_gradient: DVec3,
    found: Vec<SurfaceContact>,
    /// Steps until the effective mass is computed anew.
    mass_steps_left: u32,
    jacobian: DVector<f64>,
    response: DVector<f64>,
}

impl PartContact {
    /// Puts the part and the tool's ball into the world.
    pub(super) fn insert(
        physics: &mut PhysicsWorld,
        part_body: RigidBodyHandle,
        tool_body: RigidBodyHandle,
        part: &TriangleMesh,
        tool: ToolBall,
        parameters: PartContactParameters,
        step: f64,
    ) -> Self {
        let contacts = TrueContacts::default();
        physics.narrow_phase = NarrowPhase::with_query_dispatcher(contacts.clone());
        // Rapier takes no more from it than its box, to know when the pair is near; `surface` knows the mesh.
        let mesh = ColliderBuilder::trimesh(part.vertices().to_vec(), part.triangles().to_vec())
            .expect("a part's mesh holds at least one triangle")
            .density(0.0)
            .friction(parameters.friction)
            .friction_combine_rule(CoefficientCombineRule::Average);
        let part_collider = physics.insert_collider(mesh, Some(part_body));
        let ball = ColliderBuilder::ball(tool.radius)
            .translation(tool.centre_in_link)
            .density(0.0)
            .friction(parameters.friction)
            .friction_combine_rule(CoefficientCombineRule::Average);
        let tool_collider = physics.insert_collider(ball, Some(tool_body));
        Self {
            part_collider,
            contacts,
            surface: ContactSurface::new(part),
            parameters,
            tool,
            tool_collider,
            step,
            lift: 0.0,
            lift_gradient: DVec3::ZERO,
            found: Vec::new(),
            mass_steps_left: 0,
            jacobian: DVector::zeros(0),
            response: DVector::zeros(0),
        }
    }

    /// Raises the part's surface under the ball along its normal, for the next steps: height [m] and its gradient along the part [m/m].
    pub fn set_lift(&mut self, lift: f64, gradient: DVec3) {
        self.lift = lift;
        self.lift_gradient = gradient;
    }

    /// Finds the true contacts of the coming step and sets the solver's softness for them.
    pub(super) fn prepare(
        &mut self,
        physics: &mut PhysicsWorld,
        joint: MultibodyJointHandle,
        tool_body: RigidBodyHandle,
        centre: DVec3,
    ) {
        let reach = self.tool.radius + REACH + self.lift.max(0.0);
        self.surface
            .genuine_contacts(centre, reach, &mut self.found);
        let (radius, lift, gradient) = (self.tool.radius, self.lift, self.lift_gradient);
        let deepest = self.contacts.with(|contacts| {
            contacts.clear();
            contacts.extend(self.found.iter().map(|contact| {
                // A rising burr leans the normal back against the motion.
                let normal = (contact.normal - gradient).normalize();
                let separation = (contact.distance - radius - lift) * normal.dot(contact.normal);
                TrueContact { normal, separation }
            }));
            contacts
                .iter()
                .copied()
                .min_by(|a, b| a.separation.total_cmp(&b.separation))
        });
        let Some(deepest) = deepest else {
            self.mass_steps_left = 0;
            return;
        };
        if self.mass_steps_left > 0 {
            self.mass_steps_left -= 1;
        } else {
            let point = centre - deepest.normal * self.tool.radius;
            let mass = self.effective_mass(physics, joint, tool_body, deepest.normal, point);
            self.mass_steps_left = if mass.is_some() { MASS_STEPS - 1 } else { 0 };
            let mass = mass.unwrap_or(1.0);
            physics.integration_parameters.static_contact_softness =
                softness(&self.parameters, mass, self.step);
        }
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
        if self.jacobian.len() != count {
            // There is no factorised mass matrix before the first step.
            self.jacobian = DVector::zeros(count);
            self.response = DVector::zeros(count);
            return None;
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
        let mut reading = ContactReading::default();
        let step = self.step;
        let part = self.part_collider;
        self.contacts.with(|contacts| {
            if contacts.is_empty() {
                return;
            }
            reading.penetration = -f64::MAX;
            for pair in physics.narrow_phase.contact_pairs_with(self.tool_collider) {
                let part_first = pair.collider1 == part;
                for (manifold, contact) in pair.manifolds().iter().zip(contacts.iter()) {
                    if manifold.data.solver_contacts.is_empty() {
                        continue;
                    }
                    for point in &manifold.points {
                        let normal_force = point.data.impulse / step;
                        let tangent = point.data.warmstart_tangent_world / step;
                        let friction = if part_first { -tangent } else { tangent };
                        reading.normal_force += normal_force;
                        reading.friction_force += friction.length();
                        reading.force_on_tool += contact.normal * normal_force + friction;
                    }
                    if -contact.separation > reading.penetration {
                        reading.penetration = -contact.separation;
                        reading.normal = contact.normal;
                    }
                }
            }
        });
        reading
    }
}

/// Rapier's softness that obeys the law for an effective mass [kg] and a step [s].
fn softness(parameters: &PartContactParameters, mass: f64, step: f64) -> SpringCoefficients<f64> {
    let frequency = (parameters.stiffness / mass).sqrt();
    let phase = frequency * step;
    let theta = if phase <= EXPLICIT_LIMIT {
        0.0
    } else {
        1.0 - (EXPLICIT_LIMIT / phase).powi(2)
    };
    let discrete_damping = mass * ((step * parameters.damping / mass).exp_m1()) / step;
    let damping = discrete_damping - (1.0 - theta) * parameters.stiffness * step;
    SpringCoefficients::new(
        frequency / std::f64::consts::TAU,
        damping / (2.0 * mass * frequency),
    )
}

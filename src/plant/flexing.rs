//! Links that swing on the springs of their joints, slowly enough for the samples to show it.
//!
//!     M d'' + D d' + K d = J_n F + J_t T - J_a (M_t x'' ...) - tau       link against motor, each joint by itself
//!     T = -mu F sat(v / v_s),   v = v_motors + sum J_t d'
//!
//! d deflection [rad], M inertia about the joint [kg m2], D = 2 zeta sqrt(K M), J_n, J_t, J_a levers of the ball along bisector, edge and slide [m], F contact
//! force, T friction along the edge (regularised: no friction at rest), tau what the motors' acceleration takes. The slide lets the moving mass go its own way
//! along its axis: there the links feel what the device pushes with. (Spong, J. Dyn. Syst. Meas. Control 109, 1987.) The rule of the implicit midpoint,
//! friction in closed form; the forces from the steps before.

use super::cell_course::{CellCourse, Felt, SLIDING};
use super::cell_parameters::CellParameters;

/// Swing per sample beyond which the samples do not resolve it, and the deflection follows the forces at once [rad].
pub(super) const RESOLVED: f64 = 1.0;

/// One joint that swings.
#[derive(Debug, Clone, Copy)]
struct Swing {
    joint: usize,
    deflection: f64,
    speed: f64,
    /// Torque at the step before [N m].
    before: Option<f64>,
}

/// Joints that swing.
#[derive(Debug, Clone)]
pub(super) struct Flexing<'a> {
    course: &'a CellCourse,
    cell: &'a CellParameters,
    swings: Vec<Swing>,
}

/// Forces that bend the arm.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bending {
    /// Contact force [N].
    pub contact: f64,
    /// What the device pushes the moving mass with, its weight included [N].
    pub push: f64,
    /// Stroke [m].
    pub stroke: f64,
}

/// What swinging does to the standoff over a step, along the bisector: coefficients of 1, t, t2 [m].
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Swung {
    /// Lift of the ball.
    pub lift: [f64; 3],
    /// Acceleration of the slide along its axis [m/s2].
    pub acceleration: f64,
}

impl<'a> Flexing<'a> {
    /// Joints that swing slowly enough; none where all are stiff.
    pub fn new(course: &'a CellCourse, cell: &'a CellParameters) -> Self {
        let swings = cell.swinging(course).into_iter();
        Self {
            course,
            cell,
            swings: swings
                .map(|joint| Swing {
                    joint,
                    deflection: 0.0,
                    speed: 0.0,
                    before: None,
                })
                .collect(),
        }
    }

    /// Is every joint stiff?
    pub fn is_stiff(&self) -> bool {
        self.swings.is_empty()
    }

    /// Where the ball is lifted to now, seen along the slide: coefficients of 1, t, t2 over what comes next.
    pub fn now(&self, i: usize, stroke: f64, share: f64) -> [f64; 3] {
        let ball = self.course.ball[i] + self.course.slide[i] * stroke;
        let mut lift = [0.0; 3];
        for swing in &self.swings {
            let joint = &self.course.joints[swing.joint];
            let lever = joint.axis[i].cross(ball - joint.origin[i]);
            let lever = lever.dot(self.course.edge[i].bisector) / share;
            lift[0] += lever * swing.deflection;
            lift[1] += lever * swing.speed;
        }
        lift
    }

    /// Advances over `h` [s] from sample `i` under forces as they are now.
    pub fn advance(&mut self, felt: &Felt, i: usize, h: f64, forces: Bending) -> Swung {
        let course = self.course;
        let edge = &course.edge[i];
        let slide = course.slide[i];
        let ball = course.ball[i] + slide * forces.stroke;
        let mut along = felt.speed[i];
        for swing in &self.swings {
            let joint = &course.joints[swing.joint];
            let lever = joint.axis[i].cross(ball - joint.origin[i]);
            along += lever.dot(edge.tangent) * swing.speed;
        }
        let mut swung = Swung::default();
        for swing in &mut self.swings {
            let joint = &course.joints[swing.joint];
            let lever = joint.axis[i].cross(ball - joint.origin[i]);
            let (lift, slip) = (lever.dot(edge.bisector), lever.dot(edge.tangent));
            let (axial, share) = (lever.dot(slide), felt.share[i]);
            let stiffness = self.cell.joint_stiffness[swing.joint];
            let inertia = joint.inertia[i];
            let damping = 2.0 * self.cell.joint_damping_ratio * (stiffness * inertia).sqrt();
            let motors = joint.torque[i] - axial * felt.carried[i];
            // n F less its part along the slide, and in its stead what the device pushes with.
            let torque = (lift + share * axial) * forces.contact - axial * forces.push - motors;
            let ahead = swing.before.map_or(torque, |before| 1.5 * torque - 0.5 * before);
            swing.before = Some(torque);
            // (2 M/h + D + K h/2) v + K d - 2 M/h v0 = torque + slip T(others + slip v)
            let bent = 2.0 * inertia / h + damping + 0.5 * stiffness * h;
            let right = ahead + 2.0 * inertia / h * swing.speed - stiffness * swing.deflection;
            let others = along - slip * swing.speed;
            let most = self.cell.friction * forces.contact;
            let grip = most / SLIDING;
            let mut middle = (right - slip * grip * others) / (bent + slip * slip * grip);
            let slides = others + slip * middle;
            if slides.abs() > SLIDING {
                middle = (right - slip * most * slides.signum()) / bent;
            }
            let end = 2.0 * middle - swing.speed;
            let rate = (end - swing.speed) / h;
            let path = [swing.deflection, swing.speed, 0.5 * rate];
            for (total, part) in swung.lift.iter_mut().zip(path) {
                *total += lift * part;
            }
            swung.acceleration += axial * rate;
            along += slip * (end - swing.speed);
            swing.deflection += h * middle;
            swing.speed = end;
        }
        swung
    }
}

impl CellParameters {
    /// Joints whose links swing slowly enough for the samples to show it.
    pub(super) fn swinging(&self, course: &CellCourse) -> Vec<usize> {
        let count = course.len();
        if count < 2 {
            return Vec::new();
        }
        let step = (course.time[count - 1] - course.time[0]) / (count - 1) as f64;
        let swings = |joint: usize| {
            let inertia = course.joints[joint].inertia[count / 2];
            (self.joint_stiffness[joint] / inertia).sqrt() * step < RESOLVED
        };
        (0..course.joints.len()).filter(|joint| swings(*joint)).collect()
    }
}

//! The tool's ball about a pose of the arm at which its Jacobian is known.
//!
//! ```text
//! p(d) = p + sum_i c_i d_i + sum_i (z_i d_i / 2 + sum_{k<i} z_k d_k) x c_i d_i        to the second order in the joints' motions d
//! c_i(d) = c_i + (sum_{k<=i} z_k d_k) x c_i + z_i x sum_{k>i} c_k d_k                 to the first, as z_i(d)
//! ```
//!
//! p centre of the ball [m], c_i its motion with joint i [m/rad or 1], z_i turn of the tool with it [1]; the derivative of c_j along an earlier joint i, and of c_i along
//! a later joint j, is z_i x c_j.

use glam::DVec3;

use crate::arm::chain::MAX_JOINTS;

/// The ball at a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lever {
    count: usize,
    /// Its centre in the world [m].
    pub centre: DVec3,
    /// The slide's axis in the world.
    pub axis: DVec3,
    moves: [DVec3; MAX_JOINTS],
    turns: [DVec3; MAX_JOINTS],
}

impl Lever {
    /// A ball at a centre [m] on a slide of an axis, moved and turned by joints, base first.
    pub fn new(
        centre: DVec3,
        axis: DVec3,
        columns: impl IntoIterator<Item = (DVec3, DVec3)>,
    ) -> Self {
        let mut lever = Self {
            count: 0,
            centre,
            axis,
            moves: [DVec3::ZERO; MAX_JOINTS],
            turns: [DVec3::ZERO; MAX_JOINTS],
        };
        for (moves, turns) in columns.into_iter().take(MAX_JOINTS) {
            lever.moves[lever.count] = moves;
            lever.turns[lever.count] = turns;
            lever.count += 1;
        }
        lever
    }

    /// The same after motions of the joints [rad or m].
    #[must_use]
    pub fn after(&self, motions: &[f64]) -> Self {
        let mut after = *self;
        let (mut turned, mut moved, mut bend) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        for (i, &motion) in motions.iter().enumerate().take(self.count) {
            let (turn, step) = (self.turns[i] * motion, self.moves[i] * motion);
            after.turns[i] += turned.cross(self.turns[i]);
            bend += (turned + 0.5 * turn).cross(step);
            turned += turn;
            after.moves[i] += turned.cross(self.moves[i]);
            moved += step;
        }
        let mut beyond = DVec3::ZERO;
        for i in (0..self.count).rev() {
            after.moves[i] += self.turns[i].cross(beyond);
            beyond += self.moves[i] * motions[i];
        }
        after.centre += moved + bend;
        after.axis = self.turned(self.axis, motions);
        after
    }

    /// A vector of the tool after motions of the joints [rad or m].
    #[must_use]
    pub fn turned(&self, vector: DVec3, motions: &[f64]) -> DVec3 {
        let (mut turned, mut after) = (DVec3::ZERO, vector);
        for (turns, motion) in self.turns[..self.count].iter().zip(motions) {
            let turn = *turns * *motion;
            let swung = turn.cross(vector);
            after += swung + (turned + 0.5 * turn).cross(swung);
            turned += turn;
        }
        after
    }

    /// Velocity [m/s] of a point of the tool, `arm` [m] off the ball's centre, with speeds of the joints; of as many joints as there are speeds.
    pub fn velocity(&self, speeds: &[f64], arm: DVec3) -> DVec3 {
        let joints = speeds.iter().zip(&self.moves).zip(&self.turns);
        joints.fold(DVec3::ZERO, |sum, ((speed, moves), turns)| {
            sum + (*moves + turns.cross(arm)) * *speed
        })
    }

    /// Adds to forces of the joints [N m or N] what a force [N] does that acts on the tool `arm` [m] off the ball's centre.
    pub fn add_force(&self, force: DVec3, arm: DVec3, out: &mut [f64]) {
        let moment = arm.cross(force);
        for (out, (moves, turns)) in out.iter_mut().zip(self.moves.iter().zip(&self.turns)) {
            *out += moves.dot(force) + turns.dot(moment);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    /// Three joints and a slide behind them: origins, axes, and where the ball is.
    fn pose(q: [f64; 4]) -> (DVec3, DVec3, Vec<(DVec3, DVec3)>) {
        let axes = [DVec3::Z, DVec3::Y, DVec3::X];
        let offsets = [
            DVec3::new(0.1, 0.0, 0.4),
            DVec3::new(0.2, 0.1, 0.5),
            DVec3::new(0.3, 0.0, -0.1),
        ];
        let slide = DVec3::new(0.0, 0.6, 0.8);
        let (mut turn, mut origin) = (DQuat::IDENTITY, DVec3::ZERO);
        let mut frames = Vec::new();
        for i in 0..3 {
            let axis = turn * axes[i];
            frames.push((origin, axis));
            turn = DQuat::from_axis_angle(axis, q[i]) * turn;
            origin += turn * offsets[i];
        }
        let axis = turn * slide;
        let centre = origin + axis * (0.15 + q[3]);
        let mut columns: Vec<_> = frames
            .into_iter()
            .map(|(origin, axis)| (axis.cross(centre - origin), axis))
            .collect();
        columns.push((axis, DVec3::ZERO));
        (centre, axis, columns)
    }

    /// Errors of centre, axis and Jacobian after motions of a size, against the pose there.
    fn errors(size: f64) -> [f64; 3] {
        let start = [0.3, -0.7, 1.1, 0.02];
        let motions = [0.9, -0.6, 0.8, 0.5].map(|share| share * size);
        let mut end = start;
        for (end, motion) in end.iter_mut().zip(motions) {
            *end += motion;
        }
        let (centre, axis, columns) = pose(start);
        let after = Lever::new(centre, axis, columns).after(&motions);
        let (centre, axis, columns) = pose(end);
        let jacobian = columns.iter().enumerate().map(|(i, (moves, turns))| {
            (after.moves[i] - *moves).length() + (after.turns[i] - *turns).length()
        });
        [
            (after.centre - centre).length(),
            (after.axis - axis).length(),
            jacobian.fold(0.0, f64::max),
        ]
    }

    #[test]
    fn the_ball_is_where_the_joints_take_it_to_the_third_order_and_its_jacobian_to_the_second() {
        let (coarse, fine) = (errors(1e-2), errors(5e-3));
        for (which, order) in [3.0, 3.0, 2.0].into_iter().enumerate() {
            let found = (coarse[which] / fine[which]).log2();
            assert!((found - order).abs() < 0.1, "{which}: order {found}");
        }
    }

    #[test]
    fn a_force_does_the_work_that_it_does_at_its_point() {
        let (centre, axis, columns) = pose([0.3, -0.7, 1.1, 0.02]);
        let lever = Lever::new(centre, axis, columns);
        let (force, arm) = (DVec3::new(3.0, -2.0, 5.0), DVec3::new(0.01, 0.02, -0.03));
        let speeds = [0.2, 0.1, -0.4, 0.3];
        let mut torques = [0.0; 4];
        lever.add_force(force, arm, &mut torques);
        let power: f64 = torques.iter().zip(speeds).map(|(t, v)| t * v).sum();
        assert!((power - force.dot(lever.velocity(&speeds, arm))).abs() < 1e-12);
    }
}

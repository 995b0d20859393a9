//! The arm between two steps of the rigid-body engine: its equation of motion with the mass matrix and the bias that the engine had last.
//!
//! ```text
//! M a = l + J^T f + b + (t + h/2) s
//! b = M a - l - J^T f - (h/2) s                 at the engine's last step, t since it began
//! s = (M a' - l' - J^T f' - b) / (T + h/2)      what M and b lack at the engine's next step, T after the last
//! ```
//!
//! a accelerations over a step of h [s], l the joints' laws, J^T f what acts on the tool, b gravity and what comes of speeds (Coriolis). The laws act within the step as
//! `world` has them; only what hangs on the pose is held, and carried on at the rate s at which it changed last. So nothing that swings is stepped over: of the second
//! order in the time between two steps of the engine.

use nalgebra::DMatrix;

use crate::arm::chain::MAX_JOINTS;

/// A value a joint.
pub type Joints = [f64; MAX_JOINTS];

/// What acts on the arm over a step.
#[derive(Debug, Clone, Copy, Default)]
pub struct Acting {
    /// Step [s].
    pub step: f64,
    /// Forces of the laws at the speeds of the step's start, and of what acts on the tool [N m or N].
    pub force: Joints,
    /// What the laws add to the mass matrix [kg m2 or kg].
    pub added: Joints,
}

/// What a step of the engine tells.
#[derive(Debug, Clone, Copy)]
pub struct Engine<'a> {
    /// Mass matrix.
    pub mass: &'a DMatrix<f64>,
    /// Accelerations [rad/s2 or m/s2].
    pub accelerations: &'a Joints,
    /// Forces of the laws as they acted, and of what acted on the tool [N m or N].
    pub force: &'a Joints,
    /// What was added to them of `HeldArm::ahead` [N m or N].
    pub ahead: &'a Joints,
    /// Step [s].
    pub step: f64,
}

/// The arm as the engine had it last.
#[derive(Debug, Clone, Default)]
pub struct HeldArm {
    count: usize,
    mass: [Joints; MAX_JOINTS],
    bias: Joints,
    rate: Joints,
    /// Since the engine's last step began [s].
    since: f64,
    /// Lower triangle of the mass matrix with what the laws add, its diagonal inverted, and what that was.
    factor: [Joints; MAX_JOINTS],
    factored: Option<Joints>,
}

impl HeldArm {
    /// Whether the engine was asked yet.
    pub fn known(&self) -> bool {
        self.count > 0
    }

    /// Forgets what it knows.
    pub fn forget(&mut self) {
        self.count = 0;
        self.rate = [0.0; MAX_JOINTS];
    }

    /// Change of the joints' speeds over a step; none where the mass matrix is none.
    pub fn forecast(&mut self, acting: &Acting) -> Option<Joints> {
        if !self.known() || !self.factorise(&acting.added) {
            return None;
        }
        let (h, n) = (acting.step, self.count);
        let carried = self.since + 0.5 * h;
        let mut speeds = [0.0; MAX_JOINTS];
        for i in 0..n {
            let force = acting.force[i] + self.bias[i] + carried * self.rate[i];
            let done: f64 = (0..i).map(|k| self.factor[i][k] * speeds[k]).sum();
            speeds[i] = (h * force - done) * self.factor[i][i];
        }
        for i in (0..n).rev() {
            let done: f64 = (i + 1..n).map(|k| self.factor[k][i] * speeds[k]).sum();
            speeds[i] = (speeds[i] - done) * self.factor[i][i];
        }
        Some(speeds)
    }

    /// Cholesky's factor of the mass matrix with what laws add, unless it is at hand.
    fn factorise(&mut self, added: &Joints) -> bool {
        if self.factored.as_ref() == Some(added) {
            return true;
        }
        self.factored = None;
        for (i, &added) in added.iter().enumerate().take(self.count) {
            for j in 0..=i {
                let known: f64 = (0..j).map(|k| self.factor[i][k] * self.factor[j][k]).sum();
                let rest = self.mass[i][j] - known;
                if i > j {
                    self.factor[i][j] = rest * self.factor[j][j];
                    continue;
                }
                let rest = rest + added;
                if rest.is_nan() || rest <= 0.0 {
                    return false;
                }
                self.factor[i][i] = 1.0 / rest.sqrt();
            }
        }
        self.factored = Some(*added);
        true
    }

    /// A step [s] has passed without the engine.
    pub fn pass(&mut self, step: f64) {
        self.since += step;
    }

    /// What the engine's next step of a length [s] does not know: it takes the pose at its start [N m or N].
    pub fn ahead(&self, step: f64) -> Joints {
        self.rate.map(|rate| 0.5 * step * rate)
    }

    /// Takes what the engine's step tells; gives what was lacking in it, in forces of the joints [N m or N].
    pub fn learn(&mut self, engine: &Engine<'_>) -> Joints {
        let n = engine.mass.nrows();
        let reach = self.since + 0.5 * engine.step;
        let mut lacking = [0.0; MAX_JOINTS];
        let mut rate = [0.0; MAX_JOINTS];
        if self.known() {
            for i in 0..n {
                let inert: f64 = (0..n)
                    .map(|k| self.mass[i][k] * engine.accelerations[k])
                    .sum();
                let lack = inert - engine.force[i] - self.bias[i];
                rate[i] = lack / reach;
                lacking[i] = lack - reach * self.rate[i];
            }
        }
        for i in 0..n {
            let mut inert = 0.0;
            for k in 0..n {
                self.mass[i][k] = engine.mass[(i, k)];
                inert += self.mass[i][k] * engine.accelerations[k];
            }
            self.bias[i] = inert - engine.force[i] - engine.ahead[i];
        }
        (self.count, self.since, self.rate, self.factored) = (n, engine.step, rate, None);
        lacking
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 1e-3;
    /// Steps for one of the engine's.
    const HELD: usize = 8;

    fn joints(values: [f64; 2]) -> Joints {
        let mut joints = [0.0; MAX_JOINTS];
        joints[..2].copy_from_slice(&values);
        joints
    }

    fn mass() -> DMatrix<f64> {
        DMatrix::from_row_slice(2, 2, &[2.0, 0.5, 0.5, 1.0])
    }

    /// Accelerations under forces.
    fn accelerations(force: [f64; 2]) -> Joints {
        let solved = mass().lu().solve(&nalgebra::Vector2::from(force)).unwrap();
        joints([solved[0], solved[1]])
    }

    /// A bias that changes evenly [N m].
    fn bias(time: f64) -> [f64; 2] {
        [3.0 - 20.0 * time, 1.0 + 7.0 * time]
    }

    const FORCE: [f64; 2] = [0.4, -0.3];

    /// An arm that has learnt such a bias from an engine several times, as the pose was at the start of its steps; what was lacking at the last.
    fn taught() -> (HeldArm, Joints, f64) {
        let (mut arm, mut time) = (HeldArm::default(), 0.0);
        let mut lacking = [0.0; MAX_JOINTS];
        for _ in 0..20 {
            let (ahead, now) = (arm.ahead(STEP), bias(time));
            let force = [0, 1].map(|i| FORCE[i] + now[i] + ahead[i]);
            lacking = arm.learn(&Engine {
                mass: &mass(),
                accelerations: &accelerations(force),
                force: &joints(FORCE),
                ahead: &ahead,
                step: STEP,
            });
            for _ in 1..HELD {
                arm.pass(STEP);
            }
            time += HELD as f64 * STEP;
        }
        (arm, lacking, time)
    }

    // Catches: a bias that stays as it was; the start of a step for its middle.
    #[test]
    fn a_bias_that_changes_evenly_is_followed_to_the_middle_of_each_step() {
        let (mut arm, lacking, time) = taught();
        assert!(lacking[0].abs() < 1e-12, "{lacking:?}");
        let acting = Acting {
            step: STEP,
            force: joints(FORCE),
            added: [0.0; MAX_JOINTS],
        };
        let gained = arm.forecast(&acting).unwrap();
        let middle = bias(time + 0.5 * STEP);
        let expected = accelerations([FORCE[0] + middle[0], FORCE[1] + middle[1]]);
        for (gained, expected) in gained.iter().zip(expected) {
            assert!((gained - STEP * expected).abs() < 1e-12);
        }
    }

    #[test]
    fn what_laws_add_to_the_mass_matrix_is_added() {
        let (mut arm, ..) = taught();
        let acting = |added| Acting {
            step: STEP,
            force: joints([2.0, -1.0]),
            added: joints(added),
        };
        let free = arm.forecast(&acting([0.0, 0.0])).unwrap();
        let held = arm.forecast(&acting([1e12, 0.0])).unwrap();
        assert!(held[0].abs() < 1e-11 * free[0].abs() && held[1].abs() > 0.0);
        assert_eq!(arm.forecast(&acting([0.0, 0.0])).unwrap(), free);
        assert!(arm.forecast(&acting([-1e3, 0.0])).is_none());
    }

    #[test]
    fn nothing_is_said_before_the_engine_has() {
        let mut arm = HeldArm::default();
        assert!(arm.forecast(&Acting::default()).is_none());
        let (mut arm, ..) = taught();
        arm.forget();
        assert!(arm.forecast(&Acting::default()).is_none());
    }
}

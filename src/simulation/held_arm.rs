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
    /// Whether the engine has told anything yet.
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
        for i in 0..self.count {
            for j in 0..=i {
                let known: f64 = (0..j).map(|k| self.factor[i][k] * self.factor[j][k]).sum();
                let rest = self.mass[i][j] - known;
                if i > j {
                    self.factor[i][j] = rest * self.factor[j][j];
                    continue;
                }
                let rest = rest + added[i];
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

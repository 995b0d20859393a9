//! In how many steps of the cell the rigid-body engine is asked once.
//!
//! As many as a scenario allows, fewer where more was lacking at the engine's last step than is accepted: what is lacking grows with the square of the time.

use super::held_arm::Joints;

/// Error of a joint that is accepted of what is lacking at the engine's step [rad].
const ACCEPTED: f64 = 1e-8;
/// Share of that below which the engine is asked half as often [1].
const EASY: f64 = 0.125;
/// Motion of a joint from where the engine's bodies stand up to which the ball's place is known without them [rad or m].
const NEAR: f64 = 5e-3;

/// Rates of cell and engine.
#[derive(Debug, Clone, Copy)]
pub struct Rates {
    most: usize,
    now: usize,
    /// Steps since the engine's last, that included.
    passed: usize,
    /// Steps of both so far.
    steps: usize,
    asked: usize,
}

impl Rates {
    /// At most so many steps for one of the engine's.
    pub fn new(most: usize) -> Self {
        Self {
            most,
            now: 1,
            passed: 0,
            steps: 0,
            asked: 0,
        }
    }

    /// Whether the engine is asked for each step, whatever it says.
    pub fn every_step(&self) -> bool {
        self.most <= 1
    }

    /// Whether a step may do without the engine, the joints so far from where its bodies stand.
    pub fn may_hold(&self, off: &Joints) -> bool {
        self.passed < self.now && off.iter().all(|off| off.abs() < NEAR)
    }

    /// A step was done without it.
    pub fn held(&mut self) {
        self.passed += 1;
        self.steps += 1;
    }

    /// The engine was asked, and the error of what was lacking is this [rad].
    pub fn learnt(&mut self, error: f64) {
        self.asked();
        if error > ACCEPTED {
            self.now = (self.now / 2).max(1);
        } else if error < EASY * ACCEPTED {
            self.now = (2 * self.now).min(self.most);
        }
    }

    /// The engine was asked, and says nothing of the step to come.
    pub fn unsteady(&mut self) {
        self.asked();
        self.now = 1;
    }

    fn asked(&mut self) {
        self.passed = 1;
        self.steps += 1;
        self.asked += 1;
    }

    /// Steps so far, and the engine's among them.
    pub fn counts(&self) -> (usize, usize) {
        (self.steps, self.asked)
    }
}

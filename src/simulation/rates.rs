//! In how many steps of the cell the rigid-body engine is asked once.
//!
//! As many as a scenario allows, fewer where more was lacking at the engine's last step than is accepted: what is lacking grows with the square of the time.

use super::held_arm::Joints;

/// Error of a joint that is accepted of what is lacking at the engine's step [rad].
const ACCEPTED: f64 = 2e-8;
/// Share of that below which the engine is asked half as often [1].
const EASY: f64 = 0.125;
/// Motion of a joint from where the engine's bodies stand up to which the ball's place is known without them [rad or m].
const NEAR: f64 = 5e-3;

/// Rates of cell and engine.
#[derive(Debug, Clone, Copy)]
pub struct Rates {
    most: usize,
    now: usize,
    /// Steps since the engine's last, that included; of an engine that was not asked yet as many as may be.
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
            passed: 1,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::chain::MAX_JOINTS;

    const THERE: Joints = [0.0; MAX_JOINTS];

    /// Steps that may do without the engine before it is asked again.
    fn held(rates: &mut Rates) -> usize {
        let mut count = 0;
        while rates.may_hold(&THERE) {
            rates.held();
            count += 1;
        }
        count
    }

    #[test]
    fn the_engine_is_asked_seldom_where_little_is_lacking_and_often_where_much_is() {
        let mut rates = Rates::new(8);
        assert_eq!(held(&mut rates), 0);
        for expected in [1, 3, 7, 7] {
            rates.learnt(0.0);
            assert_eq!(held(&mut rates), expected);
        }
        rates.learnt(2.0 * ACCEPTED);
        assert_eq!(held(&mut rates), 3);
        rates.learnt(0.5 * ACCEPTED);
        assert_eq!(held(&mut rates), 3);
        rates.unsteady();
        assert_eq!(held(&mut rates), 0);
        assert_eq!(rates.counts(), (31, 7));
    }

    #[test]
    fn the_engine_is_asked_before_the_arm_is_far_from_where_its_bodies_stand() {
        let mut rates = Rates::new(8);
        rates.learnt(0.0);
        let mut far = THERE;
        far[2] = -1.1 * NEAR;
        assert!(rates.may_hold(&THERE) && !rates.may_hold(&far));
        assert!(Rates::new(1).every_step());
    }
}

//! Joint positions over a motion as a row of cubics, so that between any two moments of it the way of each joint is bounded.

use super::Positions;
use crate::arm::chain::MAX_JOINTS;

/// A cubic of all joints by its Bezier points; the way of a joint along it is at most that along the points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cubic {
    points: [Positions; 4],
}

impl Cubic {
    /// Way of each joint along it, no less.
    pub fn ways(&self) -> Positions {
        let mut ways = [0.0; MAX_JOINTS];
        for two in self.points.windows(2) {
            for (way, (from, to)) in ways.iter_mut().zip(two[0].iter().zip(&two[1])) {
                *way += (to - from).abs();
            }
        }
        ways
    }

    /// Farthest that each joint gets from the straight line between its ends, no less.
    pub fn bends(&self) -> Positions {
        let [start, second, third, end] = &self.points;
        let mut bends = [0.0; MAX_JOINTS];
        for (joint, bend) in bends.iter_mut().enumerate() {
            let (from, to) = (start[joint], end[joint]);
            let off = |value: f64, share: f64| (value - from - share * (to - from)).abs();
            *bend = off(second[joint], 1.0 / 3.0).max(off(third[joint], 2.0 / 3.0));
        }
        bends
    }

    /// Both its halves (de Casteljau).
    pub fn halves(&self) -> [Self; 2] {
        let middle = |a: &Positions, b: &Positions| {
            let mut between = [0.0; MAX_JOINTS];
            for (joint, value) in between.iter_mut().enumerate() {
                *value = 0.5 * (a[joint] + b[joint]);
            }
            between
        };
        let [a, b, c, d] = &self.points;
        let (ab, bc, cd) = (middle(a, b), middle(b, c), middle(c, d));
        let (abc, bcd) = (middle(&ab, &bc), middle(&bc, &cd));
        let half = middle(&abc, &bcd);
        [
            Self {
                points: [*a, ab, abc, half],
            },
            Self {
                points: [half, bcd, cd, *d],
            },
        ]
    }

    pub fn end(&self) -> &Positions {
        &self.points[3]
    }
}

/// Joint positions over a motion.
#[derive(Debug, Clone, Default)]
pub struct JointMotion {
    pub(super) knots: Vec<Positions>,
    /// Between each two knots.
    pub(super) cubics: Vec<Cubic>,
}

impl JointMotion {
    /// Goes on to joint positions in a straight line of joint space; the first of all are where it starts.
    pub fn line_to(&mut self, end: Positions) {
        let start = self.knots.last().copied().unwrap_or(end);
        let mut change = [0.0; MAX_JOINTS];
        for (joint, change) in change.iter_mut().enumerate() {
            *change = end[joint] - start[joint];
        }
        self.cubic_to(end, [change; 2]);
    }

    /// Goes on to joint positions by the cubic with changes at its start and end, each over the whole of it if it went on so.
    pub fn cubic_to(&mut self, end: Positions, [leaving, arriving]: [Positions; 2]) {
        let Some(&start) = self.knots.last() else {
            self.knots.push(end);
            return;
        };
        let (mut second, mut third) = (start, end);
        for joint in 0..MAX_JOINTS {
            second[joint] += leaving[joint] / 3.0;
            third[joint] -= arriving[joint] / 3.0;
        }
        self.cubics.push(Cubic {
            points: [start, second, third, end],
        });
        self.knots.push(end);
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.knots.is_empty()
    }

    /// Joint positions at the knots.
    #[must_use]
    pub fn knots(&self) -> &[Positions] {
        &self.knots
    }
}

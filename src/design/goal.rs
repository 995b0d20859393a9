//! Aim of one part of the search, and the order of two designs by it.
//!
//! Feasibility first (K. Deb, An efficient constraint handling method for genetic algorithms, Comput. Methods Appl. Mech. Engrg. 186, 2000): of two
//! feasible designs the one of lower cost, of a feasible and an infeasible one the feasible one, of two infeasible ones the one with the smaller
//! sum of excesses, before all that cannot be simulated. The rule as one number, [`Goal::rank`], is what a method that only compares is given.

use super::archive::{EvaluatedDesign, Scored};

/// Which of both objectives is minimised.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Aim {
    /// The objective.
    Objective,
    /// The second one.
    TradeOff,
}

/// A goal. Costs are shares of what the starting design has.
#[derive(Debug, Clone)]
pub(super) struct Goal {
    pub aim: Aim,
    /// Greatest value of the second objective, in its unit.
    pub ceiling: Option<f64>,
    /// Per limit, excess that is let pass, as a share of its bound.
    pub slack: Vec<f64>,
    /// Scale of each objective.
    pub scales: [f64; 2],
}

impl Goal {
    /// Cost of a design.
    pub fn cost(&self, scored: &Scored) -> f64 {
        match self.aim {
            Aim::Objective => scored.objective / self.scales[0],
            Aim::TradeOff => scored.trade_off / self.scales[1],
        }
    }

    /// Excess of each limit, and of the ceiling if there is one; at most 0 where it is kept.
    pub fn excesses(&self, scored: &Scored) -> Vec<f64> {
        let pairs = scored.excess.iter().zip(&self.slack);
        let mut excesses: Vec<f64> = pairs.map(|(excess, slack)| excess - slack).collect();
        let ceiling = self
            .ceiling
            .map(|ceiling| (scored.trade_off - ceiling) / self.scales[1]);
        excesses.extend(ceiling);
        excesses
    }

    /// Number of them.
    pub fn excess_count(&self) -> usize {
        self.slack.len() + usize::from(self.ceiling.is_some())
    }

    /// The feasibility rule as one number, less being better: below 1 feasible, from 2 to 3 infeasible, 4 not simulated.
    pub fn rank(&self, evaluated: &EvaluatedDesign) -> f64 {
        let Ok(scored) = &evaluated.result else {
            return 4.0;
        };
        let outside: f64 = self
            .excesses(scored)
            .iter()
            .map(|excess| excess.max(0.0))
            .sum();
        if outside > 0.0 {
            2.0 + outside / (1.0 + outside)
        } else {
            let cost = self.cost(scored);
            cost / (1.0 + cost.abs())
        }
    }

    /// Whether this is the rank of a design that keeps everything.
    pub fn keeps(rank: f64) -> bool {
        rank < 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{EvaluateError, Outcome};

    fn evaluated(objective: f64, excess: [f64; 2]) -> EvaluatedDesign {
        EvaluatedDesign {
            values: vec![],
            result: Ok(Scored {
                outcome: Outcome {
                    force_range: [0.0, 1.0],
                    scenarios: vec![],
                },
                objective,
                trade_off: 0.0,
                excess: excess.to_vec(),
            }),
        }
    }

    #[test]
    fn feasibility_comes_first_then_cost_or_excess() {
        let goal = Goal {
            aim: Aim::Objective,
            ceiling: None,
            slack: vec![0.0; 2],
            scales: [1.0; 2],
        };
        let failed = EvaluatedDesign {
            values: vec![],
            result: Err(EvaluateError {
                reason: "stopped".into(),
                detail: "stopped".into(),
            }),
        };
        let ordered = [
            evaluated(-1e3, [0.0, -1.0]),
            evaluated(0.5, [-1.0, -1.0]),
            evaluated(1e6, [0.0, 0.0]),
            evaluated(-1e9, [1e-9, -5.0]),
            evaluated(0.0, [0.2, 0.2]),
            evaluated(0.0, [0.5, -9.0]),
            failed,
        ];
        let ranks = ordered.map(|evaluated| goal.rank(&evaluated));
        assert!(ranks.is_sorted_by(|a, b| a < b), "{ranks:?}");
        assert_eq!(
            ranks.map(Goal::keeps).iter().filter(|kept| **kept).count(),
            3
        );
    }
}

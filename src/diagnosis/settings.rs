//! Thresholds of a diagnosis, each with its reason (docs/DIAGNOSIS.md).

use super::effort::EffortLimit;

/// Thresholds of the search and of what its answer names.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Effects at most of a whole device, whose recordings hardly tell more apart.
    pub most_effects: usize,
    /// Effects at most of a part of one, which is seen with all its details.
    pub most_effects_of_part: usize,
    /// Explanations that are carried on from each number of effects: of two effects the stronger alone is not always the best alone.
    pub carried_on: usize,
    /// Candidates of each number of effects that are fitted in full: a rough fit puts the right one among the first.
    pub fitted_in_full: usize,
    /// Rough cost over the leading one beyond which an explanation is not built upon [1].
    pub far_behind: f64,
    /// Rough cost behind the best at which an explanation is given up [1]: a full fit has never gained as much on another.
    pub given_up: f64,
    /// Share of what an explanation leaves that one more effect must explain, or the search stagnates [1].
    pub stagnation: f64,
    /// Penalty of each effect for having looked at so many: twice the logarithm of their number [1].
    pub look_elsewhere: f64,
    /// Odds against the best below which an explanation is no alternative [1].
    pub least_odds: f64,
    /// Times that what no law explains of a part is looked at anew: the first look takes few samples.
    pub rounds: usize,
    /// Model evaluations spent on formulas past which none is asked for, but for the last resort beside nothing [1]: of 12 laboratory laws one took 7877 in all, a device with rough edges that no law explains 31 000.
    pub formulas_within: u64,
    /// Whether every explanation that could stand in the place of the best is fitted in full, for an experiment to tell them apart.
    pub rivals: bool,
    /// Limit of its effort.
    pub limit: EffortLimit,
}

impl Settings {
    /// Those that the figures of docs/CONFUSION.md were made with.
    pub const DEFAULT: Self = Self {
        most_effects: 3,
        most_effects_of_part: 6,
        carried_on: 2,
        fitted_in_full: 4,
        far_behind: 2.0,
        given_up: 300.0,
        stagnation: 0.5,
        look_elsewhere: 7.0,
        least_odds: 0.01,
        rounds: 3,
        formulas_within: 12_000,
        rivals: false,
        limit: EffortLimit::None,
    };
}

impl Default for Settings {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Residual beyond which a sample counts in proportion only, in standard deviations [1] (Huber, Ann. Math. Stat. 35, 1964): hardly a sample of normal noise.
pub(super) const HUBER: f64 = 4.0;

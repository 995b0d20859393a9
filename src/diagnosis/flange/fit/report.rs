//! What diagnosis.json has of a flange that was simulated.

use serde::{Deserialize, Serialize};

/// A flange as a simulation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SimulatedFlange {
    /// Fitted numbers, by their names with units.
    pub numbers: Vec<FittedNumber>,
    /// Rate of the readings behind the log.
    pub reading_rate_hz: f64,
    /// Gain of each of the two lags that they went through, over a sample [1]; 1 without.
    pub reading_gain: f64,
    /// Fits from other starts that count as well as the best [-].
    pub solutions: usize,
    /// What it gives of each run, that it was fitted to or that it never saw.
    pub runs: Vec<SimulatedRun>,
}

/// A fitted number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FittedNumber {
    /// Name with its unit.
    pub name: String,
    /// Value.
    pub value: f64,
    /// Lower and upper end of its interval, 95 % of what the curvature of the cost leaves, over all fits that count; none where it was met, not fitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval: Option<[f64; 2]>,
}

/// A run, recorded and simulated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SimulatedRun {
    /// File name.
    pub recording: String,
    /// Whether it was fitted to.
    pub fitted: bool,
    /// Force set before contact.
    pub force_before_n: f64,
    /// Time in which the desired force is reached.
    pub force_ramp_s: f64,
    /// Peak of the impact.
    pub peak_n: SimulatedResult,
    /// Frequency of the ringing; none where either does not ring.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ringing_hz: Option<SimulatedResult>,
    /// Time from contact until the force has settled.
    pub settling_s: SimulatedResult,
    /// Standard deviation of the force while the arm slides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sliding_spread_n: Option<SimulatedResult>,
}

/// A result beside what was simulated.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SimulatedResult {
    /// As recorded.
    pub recorded: f64,
    /// As simulated; the median over instants of reading and solutions.
    pub simulated: f64,
    /// Lower end of its 90 % interval: what the fits leave open, and how far each fitted run is from what the others say of it.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl SimulatedResult {
    /// Error of the simulation [1].
    #[must_use]
    pub fn error(&self) -> f64 {
        self.simulated / self.recorded - 1.0
    }
}

//! Thresholds of noise, of adequacy and of a mention, on the scale of what there is to explain.
//!
//! A law of the catalogue is an idealisation: what it leaves of a large mismatch is large beside the noise and says nothing of other physics. So an
//! effect beside another must gain a share of what that one gained, not only more than noise could.

use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::fit::robust_sum;
use crate::diagnosis::recordings::evidence::Evidence;

/// Standard deviations of the sum of squares that noise alone may come to [1].
const SPREAD: f64 = 6.0;
/// Share of the mismatch that the idealisation of a law may leave [1].
const IDEALISATION_LEFT: f64 = 0.002;
/// Share of what is explained already below which one more effect is not distinguished from the idealisation of the others [1].
pub(in crate::diagnosis) const IMMATERIAL: f64 = 1e-3;

/// Share of the mismatch beyond which what is left is physics of its own [1].
const UNEXPLAINED: f64 = 0.05;

/// Share of a mismatch that one effect must explain to count as its cause [1].
const HALF: f64 = 0.5;

/// The scale of a search.
#[derive(Debug, Clone, Copy)]
pub(in crate::diagnosis) struct Scale {
    /// Samples.
    count: f64,
    /// Sum of squares that noise alone has, roughly [1].
    noise: f64,
    /// Cost of the nominal model within its tolerances, roughly and in full [1].
    rough: f64,
    full: f64,
}

impl Scale {
    pub fn of(evidence: &Evidence, baseline: &Hypothesis, noise: f64) -> Self {
        let fit = &baseline.fit;
        let free = evidence.predict(&fit.prediction.plant, false, None);
        Self {
            count: evidence.count() as f64,
            noise,
            rough: fit.rough,
            full: robust_sum(&free.residuals) + fit.prior,
        }
    }

    /// Addition of chance to the rough cost of noise [1].
    pub fn rough_spread(&self) -> f64 {
        SPREAD * (2.0 * self.noise).sqrt()
    }

    /// Cost that a hypothesis which was fitted in full leaves beyond the noise's [1].
    pub fn left(&self, hypothesis: &Hypothesis) -> f64 {
        hypothesis.fit.cost() - self.count
    }

    /// Whether a hypothesis that was fitted in full leaves noise, or no more than the idealisation of its laws.
    pub fn is_adequate(&self, hypothesis: &Hypothesis) -> bool {
        let left = self.left(hypothesis);
        let chance = SPREAD * (2.0 * self.count).sqrt();
        let idealised = match hypothesis.effects.len() {
            0 => 0.0,
            _ => IDEALISATION_LEFT * (self.full - self.count),
        };
        left < chance.max(idealised)
    }

    /// Whether a hypothesis explains the mismatch but for a small share, whatever that is. Where the piston is held counts too: impacts that are met at
    /// slightly other times make a good explanation look bad.
    pub fn is_explained(&self, hypothesis: &Hypothesis) -> bool {
        let full = self.left(hypothesis) / (self.full - self.count);
        let rough = self.left_roughly(hypothesis);
        self.is_adequate(hypothesis) || full.min(rough) < UNEXPLAINED
    }

    /// Share of the mismatch that a rough fit leaves [1].
    pub fn left_roughly(&self, hypothesis: &Hypothesis) -> f64 {
        (hypothesis.fit.rough - self.noise) / (self.rough - self.noise)
    }

    /// Whether a rough fit leaves no more than the idealisation of its laws may, fitted in full or not.
    pub fn is_idealised(&self, hypothesis: &Hypothesis) -> bool {
        self.left_roughly(hypothesis) < 2.0 * IDEALISATION_LEFT
    }

    /// Whether a lighter hypothesis leaves more than noise, and the richer one explains at least half of that.
    pub fn is_needed(&self, richer: &Hypothesis, lighter: &Hypothesis) -> bool {
        !self.is_adequate(lighter) && self.left(richer) < HALF * self.left(lighter)
    }

    /// Whether it explains at least half.
    pub fn is_half_explained(&self, hypothesis: &Hypothesis) -> bool {
        self.left_roughly(hypothesis) < HALF
    }

    /// Whether one more effect, or a richer law, could gain nothing that would be worth a mention.
    pub fn leaves_nothing_material(&self, hypothesis: &Hypothesis) -> bool {
        self.left(hypothesis) < self.material_in_full(hypothesis.fit.cost())
    }

    /// Least gain of one more effect beside a hypothesis of a cost [1].
    pub fn material_in_full(&self, cost: f64) -> f64 {
        IMMATERIAL * (self.full - cost).max(0.0)
    }
}

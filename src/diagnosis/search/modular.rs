//! Numbers of the regulator from its own channel, where what is behind it is not explained to the noise.
//!
//! The outlet pressure follows from the set pressure alone. A joint fit of a model that lacks something behind the outlet bends the regulator's numbers for
//! the sake of channels that it cannot explain anyway. So the feedback from there is cut: the tolerated numbers that the outlet depends on are fitted to its
//! channel alone and held, the others then to all (modularisation: Liu, Bayarri and Berger, Bayesian Analysis 4, 2009; cutting feedback: Plummer,
//! Statistics and Computing 25, 2015).

use super::super::fit::{FINEST, Fit, Limit, Refit, Start, fit};
use super::progress::{Observer, Step};
use super::{Search, same};
use crate::diagnosis::difference::localise::{NOISE_ALONE, robust_rms};
use crate::diagnosis::fit::covariance::covariance;
use crate::diagnosis::fit::free::{Free, Prior};
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::recordings::device::Device;
use crate::diagnosis::recordings::evidence::by_channel;
use crate::diagnosis::recordings::subject::Subject;
use crate::effects::Subsystem;

/// Residual by the step of a coordinate below which a channel does not depend on it, in standard deviations of its noise [1].
const NOTHING: f64 = 1e-6;
/// Explanations that are fitted again with the regulator's numbers held; those behind them are given up, and those that leave far more.
const MOST: usize = 6;

impl Search<'_> {
    /// Takes the regulator's numbers from its own channel for all that is fitted from here on, and fits the first explanations again; best first as before.
    pub(super) fn settle_regulator(
        &mut self,
        full: &mut Vec<Hypothesis>,
        observer: &mut Observer<'_>,
    ) {
        let settled = full.first().and_then(|best| self.regulator_alone(best));
        let Some(settled) = settled else { return };
        for free in &mut self.tolerated {
            let own = settled.iter().find(|own| same(own, free, &self.nominal));
            *free = *own.unwrap_or(free);
        }
        let hopeless = self.settings.far_behind * self.score(&full[0]);
        full.retain(|h| self.score(h) <= hopeless);
        full.truncate(MOST);
        for hypothesis in full {
            *hypothesis = self.refit(hypothesis, Refit::FINEST.from(Start::Here));
            let detail = format!("regulator settled {:.1}", self.score(hypothesis));
            observer(&Step::Variation.of(hypothesis, detail));
        }
    }

    /// Free quantities with those held that are settled.
    pub(super) fn settled(&self, mut free: Vec<Free>) -> Vec<Free> {
        let is_settled = |f: &&Free| matches!(f.prior, Prior::Settled { .. });
        for settled in self.tolerated.iter().filter(is_settled) {
            for own in free.iter_mut().filter(|f| f.quantity.is(&settled.quantity)) {
                *own = *settled;
            }
        }
        free
    }

    /// Tolerated numbers that the outlet depends on, from its channel alone; none where that depends on more than the regulator and its sensor, or
    /// is not explained so.
    fn regulator_alone(&self, hypothesis: &Hypothesis) -> Option<Vec<Free>> {
        let fitted = &hypothesis.fit;
        let upstream = self.upstream(hypothesis)?;
        let own = self.evidence.of_channel(Device::UPSTREAM?);
        let free: Vec<Free> = (upstream.iter())
            .map(|i| fitted.free[*i].from(fitted.values[*i]))
            .collect();
        let plant = &fitted.prediction.plant;
        let (stages, limit) = (FINEST, Limit::of(20));
        let alone = fit(&own, (plant, None), (&free, &[]), stages, limit);
        // What is missing at the outlet itself, its numbers would hide.
        let (_, left) = robust_rms(&alone.prediction.residuals)?;
        if left > NOISE_ALONE {
            return None;
        }
        let variances = covariance(&own, &alone).diagonal();
        let tolerated = hypothesis.tolerated(&self.nominal);
        let of = |(place, free): (usize, &Free)| {
            let value = alone.values[place];
            let deviation = variances[place].max(0.0).sqrt() * free.coordinate.slope(value);
            Free {
                prior: Prior::Settled { deviation },
                ..free.from(value)
            }
        };
        let places = alone.free.iter().enumerate();
        Some(
            (places.filter(|(place, _)| upstream[*place] < tolerated))
                .map(of)
                .collect(),
        )
    }

    /// Which numbers of an explanation its outlet pressure depends on; none where it depends on more than the regulator and its sensor.
    fn upstream(&self, hypothesis: &Hypothesis) -> Option<Vec<usize>> {
        let fitted = &hypothesis.fit;
        let moves = |index: &usize| self.moves_outlet(fitted, *index);
        let found: Vec<usize> = (0..fitted.free.len()).filter(moves).collect();
        for (index, effect) in hypothesis.effects.iter().enumerate() {
            let numbers = hypothesis.numbers_of(&self.nominal, index);
            let is_own = matches!(effect.subsystem, Subsystem::Regulator | Subsystem::Sensors);
            if !is_own && found.iter().any(|index| numbers.contains(index)) {
                return None;
            }
        }
        (!found.is_empty()).then_some(found)
    }

    fn moves_outlet(&self, fitted: &Fit, index: usize) -> bool {
        let Some(column) = fitted.columns.get(index) else {
            return false;
        };
        by_channel(self.evidence, column)
            .filter(|(_, channel, _)| Some(*channel) == Device::UPSTREAM)
            .any(|(_, _, slopes)| slopes.iter().any(|slope| slope.abs() > NOTHING))
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::test_evidence::{evidence_of, plant, search};
    use super::*;
    use crate::diagnosis::recordings::input::tolerated;
    use crate::plant::registry;

    /// A spring that nobody modelled bends a joint fit of the regulator; its own channel tells the truth.
    #[test]
    fn what_is_missing_behind_the_outlet_does_not_bend_the_regulator() {
        let gain = registry::REGULATOR_GAIN.quantity();
        let mut truth = plant();
        gain.set(&mut truth, 1.01);
        registry::RETURN_STIFFNESS
            .quantity()
            .set(&mut truth, 2000.0);
        let stairs = |first: f64| (0..500).map(|i| first + 4e4 * f64::from(i / 100)).collect();
        let evidence = evidence_of(&truth, vec![stairs(1.6e5), stairs(2.2e5)]);
        let mut search = Search {
            tolerated: vec![tolerated(gain, 1.0, 0.1)],
            look: 1,
            ..search(&evidence)
        };
        let joint = search.refit(&search.baseline(), Refit::FULL);
        let mut full = vec![joint.clone()];
        search.settle_regulator(&mut full, &mut |_| {});
        let error = |hypothesis: &Hypothesis| (hypothesis.fit.values[0] - 1.01).abs();
        assert!(error(&joint) > 0.01, "{:?}", joint.fit.values);
        assert!(error(&full[0]) < 1e-3, "{:?}", full[0].fit.values);
        let prior = search.tolerated[0].prior;
        assert!(
            matches!(prior, Prior::Settled { deviation } if deviation < 1e-3),
            "{prior:?}"
        );
    }
}

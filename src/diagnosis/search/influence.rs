//! What an effect moves: what moves no channel by a share of its noise is taken out, and what explains by no more than leading a fit to the tolerated numbers is missing
//! nothing.

use super::super::fit::{Limit, robust_sum};
use super::Search;
use super::finish::{LAST, LIGHTER};
use super::progress::{Observer, Step};
use super::scale::Scale;
use crate::diagnosis::fit::free::Free;
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::recordings::evidence::rms_by_channel;
use crate::plant::{DeviceParts, PlantParameters};

/// Influence of an effect on the channel that it moves most below which it is not named, in standard deviations of that channel's noise [1].
pub(in crate::diagnosis) const BELOW_NOISE: f64 = 0.5;
/// Error in time that is forgiven where that is judged [s].
const FORGIVEN: f64 = 1e-3;

impl Search<'_> {
    /// Takes out of the best hypothesis of a whole device what moves no channel by a share of its noise: recordings long enough show what nobody would miss. What
    /// is needed to come near noise stays: impacts at slightly other times are forgiven only where nothing larger is left.
    pub(super) fn drop_below_noise(
        &self,
        full: &mut Vec<Hypothesis>,
        scale: &Scale,
        observer: &mut Observer<'_>,
    ) {
        while let Some(best) = full.first()
            && best.unlisted().is_none()
            && self.nominal.parts == DeviceParts::Whole
            && !self.is_spent()
        {
            let own = self.shown.len()..best.effects.len();
            let sizes = own.map(|index| (index, self.influence(best, index)));
            let Some((index, size)) = sizes.min_by(|a, b| a.1.total_cmp(&b.1)) else {
                break;
            };
            if size >= BELOW_NOISE {
                break;
            }
            let name = best.effects[index].name;
            observer(&Step::Variation.of(best, format!("{name} moves {size:.2} sigmas at most")));
            let Some(lighter) = self.without(best, index) else {
                break;
            };
            if scale.is_needed(best, &lighter) {
                break;
            }
            full.retain(|h| !h.effects.iter().any(|effect| effect.name == name));
            full.retain(|h| h.names() != lighter.names());
            full.insert(0, lighter);
        }
    }

    /// Fits the nominal model from where the best hypothesis has its tolerated numbers, where that is not hopeless and was not done: what explains by no more than
    /// leading a fit to them is missing nothing.
    pub(super) fn add_nominal(&self, full: &mut Vec<Hypothesis>, observer: &mut Observer<'_>) {
        let is_nominal = |h: &Hypothesis| self.found(h) == 0 && h.unlisted().is_none();
        if full.iter().any(is_nominal) || self.is_spent() {
            return;
        }
        let Some(best) = full.first() else { return };
        let plant = &best.fit.prediction.plant;
        let shown = self.shown.iter().flat_map(|shown| &shown.numbers);
        let free = self.tolerated.iter().chain(shown);
        let free: Vec<Free> = free.map(|f| f.from_where(plant)).collect();
        let nominal = self.with_numbers_of(plant, &free);
        let there = self.evidence.predict(&nominal, false, None);
        if robust_sum(&there.residuals) - best.fit.misfit > self.settings.given_up {
            return;
        }
        let effects = self.shown.iter().map(|shown| shown.effect).collect();
        let from = (&self.nominal, None);
        let nominal = self.fitted(effects, from, &free, LAST, Limit::of(LIGHTER));
        observer(&Step::Variation.of(&nominal, format!("score {:.1}", self.score(&nominal))));
        full.push(nominal);
        full.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
    }

    /// The nominal model with some numbers of another: what else the other has, such as air that warms up in place of air at one temperature, is not in it.
    fn with_numbers_of(&self, plant: &PlantParameters, numbers: &[Free]) -> PlantParameters {
        let mut nominal = self.nominal.clone();
        for f in numbers {
            f.quantity.set(&mut nominal, f.quantity.get(plant));
        }
        nominal
    }

    /// What an effect of a hypothesis does to the channel that it moves most ([`Self::moved_by`]).
    fn influence(&self, hypothesis: &Hypothesis, index: usize) -> f64 {
        let plant = &hypothesis.fit.prediction.plant;
        let own = hypothesis.effects[index].parameters(&self.nominal);
        let is_own = |f: &&Free| own.iter().any(|p| p.quantity.is(&f.quantity));
        let others = hypothesis.fit.free.iter().filter(|f| !is_own(f));
        let others: Vec<Free> = others.copied().collect();
        let mut bare = self.with_numbers_of(plant, &others);
        bare.latent.clone_from(&plant.latent);
        self.moved_by(plant, &bare)
    }

    /// Whether a term moves a channel by a share of its noise that somebody would miss.
    pub(in crate::diagnosis) fn term_shows(&self, hypothesis: &Hypothesis) -> bool {
        let plant = &hypothesis.fit.prediction.plant;
        let mut bare = plant.clone();
        bare.latent = None;
        self.moved_by(plant, &bare) >= BELOW_NOISE
    }

    /// What tells a description from a bare one in the channel that it moves most, root mean square, in standard deviations of its noise, with an error in time
    /// of 1 ms forgiven: an impact that is met a little earlier is a spike, and no matter [1].
    fn moved_by(&self, plant: &PlantParameters, bare: &PlantParameters) -> f64 {
        let with = self.evidence.predict(plant, false, None);
        let without = self.evidence.predict(bare, false, None);
        let shares = self.evidence.shares(FORGIVEN, false);
        let moved: Vec<f64> = (with.residuals.iter().zip(&without.residuals))
            .zip(shares.iter())
            .map(|((with, without), share)| (with - without) * share)
            .collect();
        let sizes = rms_by_channel(self.evidence, &moved);
        sizes.into_iter().fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::fit::rough_noise;
    use super::super::super::test_evidence::{evidence_of, plant, search};
    use super::*;
    use crate::diagnosis::fit::free::free_of;
    use crate::effects::{Effect, every};

    /// Steps of the set pressure, which warm the air up.
    fn steps() -> Vec<Vec<f64>> {
        vec![[1.5e5, 3e5, 2e5, 3.5e5].map(|level| [level; 125]).concat()]
    }

    /// A hypothesis of an effect with numbers that are not fitted.
    fn with(search: &Search<'_>, name: &str, numbers: &[f64]) -> Hypothesis {
        let effect: &'static Effect = every().find(|e| e.name == name).unwrap();
        let free = free_of(effect, &search.nominal, numbers);
        let from = (&search.nominal, None);
        search.fitted(vec![effect], from, &free, LAST, Limit::of(0))
    }

    /// Air at one temperature is no conductance that a number could be put back to: an endless one made the simulation no number, for minutes, and the effect was
    /// said to move nothing.
    #[test]
    fn what_heat_transfer_moves_is_asked_against_air_at_one_temperature() {
        let evidence = evidence_of(&plant(), steps());
        let search = search(&evidence);
        let hypothesis = with(&search, "heat_transfer", &[0.05]);
        let moved = search.influence(&hypothesis, 0);
        let plain = search.evidence.predict(&plant(), false, None);
        let warm = &hypothesis.fit.prediction.residuals;
        let largest = (warm.iter().zip(&plain.residuals))
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(moved > BELOW_NOISE && moved < largest, "{moved} {largest}");
    }

    /// The fit of an endlessly stiff joint stood for nothing missing.
    #[test]
    fn the_nominal_model_is_kept_beside_what_hardly_moves_anything() {
        let nominal_of = |truth: &PlantParameters, stiffness: f64| {
            let evidence = evidence_of(truth, steps());
            let search = search(&evidence);
            let spring = with(&search, "return_spring_load", &[stiffness]);
            let mut full = vec![spring];
            search.add_nominal(&mut full, &mut |_| ());
            full.iter().position(Hypothesis::finds_nothing)
        };
        // Of as little cost, and without the spring's number: the first.
        assert_eq!(nominal_of(&plant(), 1e-6), Some(0));
        // Where there is a spring the nominal model is hopeless, and not fitted.
        let mut sprung = plant();
        let spring = crate::plant::registry::RETURN_STIFFNESS.quantity();
        spring.set(&mut sprung, 2000.0);
        assert_eq!(nominal_of(&sprung, 2000.0), None);
    }

    /// A force of 0.2 N was fitted to noise and then taken out, as it moved 0.2 sigmas with 1 ms forgiven; without it 11 sigmas were left where the piston
    /// lands.
    #[test]
    fn what_is_needed_to_come_near_noise_is_not_taken_out() {
        let landing = vec![[0.0, 3e5, 0.0, 3e5].map(|level| [level; 125]).concat()];
        let kept = |size: f64| {
            let mut truth = plant();
            let load = crate::plant::registry::AXIAL_LOAD.quantity();
            load.set(&mut truth, size);
            let evidence = evidence_of(&truth, landing.clone());
            let search = search(&evidence);
            let scale = Scale::of(&evidence, &search.baseline(), rough_noise(&evidence));
            let found = with(&search, "axial_force_offset", &[size]);
            let moved = search.influence(&found, 0);
            assert!(moved < BELOW_NOISE, "{moved}");
            let mut full = vec![found];
            search.drop_below_noise(&mut full, &scale, &mut |_| ());
            !full[0].finds_nothing()
        };
        // Without it 1600 beyond noise are left of 2000 readings, or nothing.
        assert_eq!([kept(0.3), kept(0.1)], [true, false]);
    }
}

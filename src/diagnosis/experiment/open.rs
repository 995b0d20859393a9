//! The explanations of a diagnosis that are open, with their odds, and beside them that it is none of these.

use super::information::{Open, Sensors};
use crate::diagnosis::answer::finding::Diagnosis;
use crate::diagnosis::difference::localise::robust_rms;
use crate::diagnosis::formula::unlisted::report::formula_text;
use crate::diagnosis::recordings::evidence::by_channel;
use crate::diagnosis::search::ranking::Ranked;
use crate::effects::UNLISTED;
use crate::plant::CHANNELS;

/// Odds against the best below which an explanation is settled not to be the one [1]: as improbable as that none of them is.
const LEAST: f64 = NONE_OF_THESE;
/// Explanations at most: others behind them are less likely than all of these.
const MOST: usize = 6;
/// Standard deviations of its sum of squares that noise alone may leave [1].
const CHANCE: f64 = 3.0;
/// Least probability that none of the explanations holds [1]: no list holds all laws.
const NONE_OF_THESE: f64 = 0.005;

impl Diagnosis {
    /// Explanations that are open, the likeliest first; their probabilities and that of none of these come to one.
    #[must_use]
    pub fn open(&self) -> Vec<Open> {
        let odds = |r: &Ranked| r.odds.max(self.odds_by_what_is_left(&r.hypothesis));
        let mut open: Vec<(f64, &Ranked)> = (self.ranked.iter().map(|r| (odds(r), r)))
            .filter(|(odds, _)| *odds >= LEAST)
            .collect();
        open[1..].sort_by(|a, b| b.0.total_cmp(&a.0));
        open.truncate(MOST);
        let sum: f64 = open.iter().map(|(odds, _)| odds).sum();
        let any = 1.0 - self.none_of_these();
        let sensors = self.sensors();
        let own = open.into_iter();
        own.map(|(odds, ranked)| self.open_of(ranked, any * odds / sum))
            .map(|own| own.informed_by(&self.evidence, &sensors))
            .collect()
    }

    /// Probability that none of the explanations holds [1]: what the best leaves beyond noise over that and what it gains over the nominal model, and no less than
    /// what is stated against the least certain of its effects, were there no other explanation beside it, or that of a law that acts beyond what the recordings have been to.
    #[must_use]
    pub fn none_of_these(&self) -> f64 {
        let best = &self.best().fit;
        let chance = CHANCE * (2.0 * self.evidence.count() as f64).sqrt();
        let left = (self.model_error.left(&self.evidence, best) - chance).max(0.0);
        let gained = (self.baseline.prediction.residuals.iter())
            .filter(|r| r.is_finite())
            .map(|r| r * r)
            .sum::<f64>()
            - best.misfit;
        let left = left / (left + gained.max(0.0) + 1.0);
        let unlisted = self.best().unlisted().map(|_| UNLISTED);
        let names = self.best().effects.iter().map(|effect| effect.name);
        let certain = names.chain(unlisted).map(|name| self.certain_alone(name));
        let doubted = 1.0 - certain.fold(1.0, f64::min);
        left.max(doubted)
            .clamp(self.least_none_of_these(), 1.0 - NONE_OF_THESE)
    }

    /// What it is at least: a law that no list holds may be anywhere, and where no recording was.
    fn least_none_of_these(&self) -> f64 {
        NONE_OF_THESE + self.coverage.probability_beyond()
    }

    /// Whether that none of these holds is as improbable as recordings of where these were can make it.
    #[must_use]
    pub fn is_doubted_for_its_range(&self) -> bool {
        self.none_of_these() <= self.least_none_of_these()
    }

    fn open_of(&self, ranked: &Ranked, probability: f64) -> Open {
        let hypothesis = &ranked.hypothesis;
        let fit = &hypothesis.fit;
        let mut names = hypothesis.effect_display_names();
        // Formulas are explanations of their own.
        if let (Some(last), Some(formula)) = (
            names.last_mut(),
            hypothesis.unlisted().and_then(formula_text),
        ) {
            *last += &format!(" ({formula})");
        }
        let first = hypothesis.tolerated(&self.nominal);
        Open {
            name: match names.is_empty() {
                true => "nothing is missing".to_owned(),
                false => names.join(" + "),
            },
            probability,
            plant: fit.prediction.plant.clone(),
            free: fit.free.clone(),
            values: fit.values.clone(),
            information: fit.information.clone(),
            of_effects: (first..fit.free.len()).collect(),
        }
    }

    /// The rig's sensors, and what the best explanation leaves beside their noise.
    #[must_use]
    pub fn sensors(&self) -> Sensors {
        let residuals = &self.best().fit.prediction.residuals;
        let mut variance = [1.0f64; CHANNELS.len()];
        for (_, channel, own) in by_channel(&self.evidence, residuals) {
            if let Some((_, sigmas)) = robust_rms(own) {
                let place = channel as usize;
                variance[place] = variance[place].max(sigmas * sigmas);
            }
        }
        // A channel that no recording has is not there, whatever its noise would be.
        let mut noise = self.evidence.noise;
        for channel in CHANNELS {
            let mut readings = self
                .evidence
                .recordings
                .iter()
                .flat_map(|own| &own.readings[channel as usize]);
            if !readings.any(|value| value.is_finite()) {
                noise[channel as usize] = f64::INFINITY;
            }
        }
        Sensors {
            without: self.baseline.plant.clone(),
            noise,
            variance,
            probe: None,
        }
    }
}

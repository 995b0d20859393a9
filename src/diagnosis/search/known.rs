//! Effects that are known to be at work, fitted to recordings without a search: of recordings in a row what explained the last one mostly explains the next.

use super::ranking::Ranked;
use super::scale::Scale;
use crate::diagnosis::answer::estimate::{Number, estimates};
use crate::diagnosis::diagnose::search_of;
use crate::diagnosis::fit::free::{Free, free_of};
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::fit::{FULL, Limit, Stage, rough_noise};
use crate::diagnosis::recordings::evidence::Evidence;
use crate::diagnosis::recordings::input::DiagnosisInput;
use crate::diagnosis::settings::Settings;
use crate::effects::Effect;

/// Iterations of a fit.
const MOST: usize = 25;
/// Stages: it starts near.
const STAGES: &[Stage] = FULL.split_at(FULL.len() - 2).1;

/// Effects with numbers to start from, in the order of their parameters; an effect whose values are not known starts at its usual size.
pub type KnownEffects = Vec<(&'static Effect, Vec<f64>)>;

/// What a fit of known effects came to.
#[derive(Debug, Clone)]
pub struct KnownFit {
    /// The effects that were fitted, with their numbers.
    pub effects: Vec<(&'static Effect, Vec<Number>)>,
    /// Tolerated quantities.
    pub tolerated: Vec<Number>,
    /// Whether what is left is noise, by the measure of a search.
    pub leaves_noise: bool,
}

/// Fits sets of effects and takes the one for which the evidence speaks; none where a set has an effect with a phase in each recording, which only a search
/// finds, or where nothing is to be fitted.
#[must_use]
pub fn known_fit(
    case: &DiagnosisInput,
    evidence: &Evidence,
    sets: &[KnownEffects],
    settings: &Settings,
) -> Option<KnownFit> {
    let periodic = |set: &KnownEffects| set.iter().any(|(effect, _)| effect.phase.is_some());
    if sets.iter().any(periodic) {
        return None;
    }
    let search = search_of(case, evidence, settings);
    let baseline = search.baseline();
    let scale = Scale::of(evidence, &baseline, rough_noise(evidence));
    let fitted = sets.iter().map(|set| {
        let shown = search.shown.iter();
        let mut effects: Vec<&'static Effect> = shown.clone().map(|shown| shown.effect).collect();
        let mut free: Vec<Free> = search.tolerated.clone();
        free.extend(shown.flat_map(|shown| shown.numbers.iter().copied()));
        for (effect, values) in set {
            if effects.iter().any(|other| other.excludes(effect)) {
                continue;
            }
            let usual = effect.usual(&search.nominal);
            let start = if values.len() == usual.len() {
                values
            } else {
                &usual
            };
            effects.push(effect);
            free.extend(free_of(effect, &search.nominal, start));
        }
        search.fitted(
            effects,
            (&search.nominal, None),
            &free,
            STAGES,
            Limit::of(MOST),
        )
    });
    let mut fitted: Vec<Hypothesis> = fitted.collect();
    // One that leaves more than noise is no answer, whatever the others are.
    let rank = |h: &Hypothesis| (!scale.is_adequate(h), search.score(h));
    fitted.sort_by(|a, b| {
        rank(a)
            .partial_cmp(&rank(b))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    let hypothesis = fitted.into_iter().next()?;
    let leaves_noise = scale.is_adequate(&hypothesis);
    let ranked = [Ranked {
        score: search.score(&hypothesis),
        odds: 1.0,
        probability: 1.0,
        left_out: None,
        hypothesis,
    }];
    let numbers = estimates(&search.nominal, &ranked, evidence);
    Some(KnownFit {
        effects: numbers.effects,
        tolerated: numbers.tolerated,
        leaves_noise,
    })
}

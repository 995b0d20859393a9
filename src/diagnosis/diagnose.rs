//! From a case to everything that is found in it.

use super::answer::UNLISTED;
use super::clean::{Cleaning, clean};
use super::cross_validation::{Depth, LeftOut, left_out};
use super::estimate::{Estimates, estimates};
use super::evidence::{Evidence, Prediction};
use super::extent::{Largest, percentile_90};
use super::fit::{Limit, Refit, Start};
use super::free::Free;
use super::hypothesis::{Hypothesis, stands_for};
use super::input::{DiagnosisInput, NamedRecording, Prepared};
use super::links::{LinkResidual, links};
use super::localise::{Difference, differences, robust_rms, root_mean_square};
use super::mismatch::{Interval, intervals};
use super::model_error::ModelError;
use super::next_experiment::{Separation, separations};
use super::progress::{Observer, Step};
use super::regime::{Regime, regimes};
use super::remaining::Remaining;
use super::ruled_out::{RuledOut, ruled_out};
use super::search::{RoughFit, Search};
use super::settings::Settings;
use super::unlisted::Shape;
use crate::effects::vocabulary;
use crate::plant::{CHANNELS, Chain, Channel, PlantParameters, simulate};

/// The fit of the answer to all recordings but one, from where that to all is.
const LEFT_OUT: Refit<'static> = Refit::FINEST.from(Start::Here).until(Limit::of(8));

/// An explanation among others.
#[derive(Debug, Clone)]
pub struct Ranked {
    /// The explanation.
    pub hypothesis: Hypothesis,
    /// Its cost, penalty included [1].
    pub score: f64,
    /// Its odds against the best one [1].
    pub odds: f64,
    /// Its probability among those looked at in full [1].
    pub probability: f64,
    /// Each recording as predicted by a fit to the others; none where there are no others.
    pub left_out: Option<LeftOut>,
}

impl Ranked {
    /// Robust sum of squares of what was left out in turn.
    fn left_out_sum(&self, model_error: &ModelError) -> Option<f64> {
        Some(self.left_out.as_ref()?.sum(model_error))
    }
}

/// The believed model, moved within its tolerances as far as recordings that it may not explain allow.
#[derive(Debug)]
pub struct Baseline {
    /// The description.
    pub plant: PlantParameters,
    /// Its prediction.
    pub prediction: Prediction,
    /// Residual of each link of the chain, and the variable that explains it.
    pub links: Vec<(LinkResidual, Vec<Regime>)>,
    /// Where recordings differ from it.
    pub differences: Vec<Difference>,
}

/// Errors of prediction of a channel of a recording that was not fitted to.
#[derive(Debug, Clone, PartialEq)]
pub struct Unseen {
    /// The channel.
    pub channel: Channel,
    /// Of the believed model as it stands in the rig file.
    pub believed: ErrorSize,
    /// Of the believed model, moved within its tolerances.
    pub before: ErrorSize,
    /// Of the best explanation.
    pub after: ErrorSize,
}

/// Size of an error of prediction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorSize {
    /// Root mean square, in the channel's unit.
    pub rms: f64,
    /// Robust root mean square, in standard deviations of the noise [1].
    pub sigmas: f64,
    /// 90th percentile of its size, in standard deviations of the noise [1].
    pub p90: f64,
}

impl ErrorSize {
    /// Of residuals in standard deviations of a noise; none where nothing counts.
    #[must_use]
    pub fn of(residuals: &[f64], noise: f64) -> Option<Self> {
        Some(Self {
            rms: noise * root_mean_square(residuals.iter().copied())?,
            sigmas: robust_rms(residuals)?.1,
            p90: percentile_90(residuals.iter().copied())?,
        })
    }
}

/// The finding.
#[derive(Debug)]
pub struct Diagnosis {
    /// Thresholds that it was made with.
    pub settings: Settings,
    /// The rig as believed.
    pub believed: PlantParameters,
    /// Its tolerated quantities.
    pub tolerated: Vec<Free>,
    /// The recordings, cleaned.
    pub evidence: Evidence,
    /// Readings set aside in each of them.
    pub cleanings: Vec<Cleaning>,
    /// Notes on the recordings for an engineer, a sentence each.
    pub notes: Vec<String>,
    /// Explanations, best first.
    pub ranked: Vec<Ranked>,
    /// Effects that were looked at.
    pub looked_at: usize,
    /// Explanations that were fitted roughly on the way, the best first.
    pub roughly: Vec<RoughFit>,
    /// What the best leaves beyond noise, by which the evidence was weighed.
    pub model_error: ModelError,
    /// Remainder that no law explains of a part of the device; none where that is noise, or where there is the whole of it.
    pub remaining: Option<Remaining>,
    /// Variants of the best that do worse, of a part of the device.
    pub ruled_out: Vec<RuledOut>,
    /// Numbers of the best.
    pub estimates: Estimates,
    /// Shape of its term without a name, if it has one.
    pub shape: Option<Shape>,
    /// Where its effects act.
    pub mismatch: Vec<Interval>,
    /// Largest departure of the best from the recordings; none where nothing was measured.
    pub largest: Option<Largest>,
    /// Prediction of the believed model, as it stands in the rig file.
    pub as_believed: Prediction,
    /// The believed model, moved within its tolerances.
    pub baseline: Baseline,
    /// Name of the recording to be predicted, and errors of its prediction where it has measured columns.
    pub unseen: Option<(String, Vec<Unseen>)>,
    /// Experiments that would tell the best from the next, best first; none where there is no next.
    pub experiments: Vec<Separation>,
}

/// Diagnoses a case from its recordings as prepared; `observer` is told of its progress.
#[must_use]
pub fn diagnose(
    case: &DiagnosisInput,
    prepared: Prepared,
    settings: &Settings,
    observer: &mut Observer<'_>,
) -> Diagnosis {
    let Prepared {
        evidence,
        cleanings,
        notes,
    } = prepared;
    let remaining = (case.believed.chain.output())
        .map(|channel| Remaining::of(&search_of(case, &evidence, settings), channel, observer))
        .filter(|(remaining, _)| !remaining.is_noise());
    let mut roughly = Vec::new();
    let mut weight = ModelError::NONE;
    let (mut ranked, evidence, remaining) = match remaining {
        None => {
            let search = search_of(case, &evidence, settings);
            let (found, rough, model_error) = search.run_with_rough(observer);
            roughly = rough;
            let weighed = Search {
                model_error,
                ..search.clone()
            };
            weight = model_error;
            (rank(&weighed, found), evidence, None)
        }
        Some((mut remaining, mut seed)) => {
            let mut rounds = 0;
            loop {
                let (mut ranked, whole) =
                    against((case, settings), &remaining, &seed, &evidence, observer);
                let best = &ranked[0].hypothesis.fit.prediction;
                let left = Remaining::left_by(best, &evidence, remaining.channel);
                rounds += 1;
                if rounds == settings.rounds || !remaining.is_more_than(&left) {
                    break (ranked, whole, Some(left));
                }
                // The first look was too rough: what it left would hide what is still to be found.
                remaining = left;
                seed = ranked.swap_remove(0).hypothesis;
            }
        }
    };
    let whole = &ranked[0].hypothesis.fit;
    ranked[0].left_out = left_out(&evidence, whole, Depth::Refit(LEFT_OUT));
    let search = search_of(case, &evidence, settings);
    let best = &ranked[0].hypothesis;
    observer(&Step::Localisation.begins());
    let baseline = baseline(&search, best);
    let unseen = case.unseen.as_ref().and_then(|unseen| {
        let errors = unseen_errors(case, &evidence, unseen, &baseline.plant, best)?;
        Some((unseen.name.clone(), errors))
    });
    observer(&Step::Experiments.begins());
    // The experiments known are those of a bench: what an arm can do is in its programs.
    let of_bench = case.believed.chain == Chain::Whole
        && evidence.recordings.iter().all(|m| m.inputs.cell.is_none());
    let rival = ranked.get(1).filter(|_| of_bench);
    let experiments = rival.map_or_else(Vec::new, |rival| {
        separations(&evidence, &best.fit, &rival.hypothesis.fit)
    });
    Diagnosis {
        settings: *settings,
        believed: case.believed.clone(),
        tolerated: case.tolerated.clone(),
        looked_at: case.candidates.len(),
        ruled_out: match case.believed.chain.output() {
            Some(channel) => ruled_out(&search, best, channel),
            None => Vec::new(),
        },
        roughly,
        model_error: weight,
        remaining,
        estimates: estimates(&case.believed, &ranked, &evidence),
        shape: Shape::of(&evidence, best),
        mismatch: intervals(&evidence, &case.believed, best),
        largest: Largest::of(&evidence, &ranked[0], remaining.as_ref()),
        as_believed: evidence.predict(&case.believed, false, None),
        baseline,
        unseen,
        experiments,
        ranked,
        cleanings,
        notes,
        evidence,
    }
}

/// Explanations found against what no law explains, with samples that are all but independent; then fitted to all samples.
fn against(
    (case, settings): (&DiagnosisInput, &Settings),
    remaining: &Remaining,
    seed: &Hypothesis,
    evidence: &Evidence,
    observer: &mut Observer<'_>,
) -> (Vec<Ranked>, Evidence) {
    let independent = remaining.independent(evidence);
    let search = search_of(case, &independent, settings);
    let mut found = search.run(observer);
    // What the first look came to may be out of the search's sight: laws that do nothing but together.
    let seeded = search.refit(seed, Refit::FULL);
    if !found.iter().any(|h| h.names() == seeded.names()) {
        let mut seeded = vec![seeded];
        search.eliminate(&mut seeded, observer);
        found.append(&mut seeded);
        found.sort_by(|a, b| search.score(a).total_cmp(&search.score(b)));
    }
    let mut ranked = rank(&search, found);
    let whole = remaining.whole(evidence);
    let search = search_of(case, &whole, settings);
    for (place, ranked) in ranked.iter_mut().enumerate() {
        if place == 0 || ranked.odds >= search.settings.least_odds {
            ranked.hypothesis = search.refit(&ranked.hypothesis, Refit::FINEST);
            ranked.left_out = left_out(&whole, &ranked.hypothesis.fit, Depth::OneStep);
        }
    }
    (ranked, whole)
}

/// The search in some evidence of a case.
fn search_of<'a>(case: &DiagnosisInput, evidence: &'a Evidence, settings: &Settings) -> Search<'a> {
    // A single link is simulated in no time.
    let (look, most_effects) = match case.believed.chain {
        Chain::Whole => (3, settings.most_effects),
        _ => (12, settings.most_effects_of_part),
    };
    Search {
        evidence,
        believed: case.believed.clone(),
        tolerated: case.tolerated.clone(),
        candidates: case.candidates.clone(),
        shown: case.shown.clone(),
        look,
        most_effects,
        model_error: ModelError::NONE,
        settings: *settings,
    }
}

/// Explanations by evidence, unless what was left out in turn speaks as clearly for another as evidence would have to.
fn rank(search: &Search<'_>, found: Vec<Hypothesis>) -> Vec<Ranked> {
    let mut ranked: Vec<Ranked> = found
        .into_iter()
        .map(|hypothesis| Ranked {
            score: search.score(&hypothesis),
            odds: 1.0,
            probability: 1.0,
            left_out: None,
            hypothesis,
        })
        .collect();
    let limit = -2.0 * search.settings.least_odds.ln();
    let close = ranked[0].score + limit;
    let near = ranked.iter().take_while(|r| r.score <= close).count();
    for leading in &mut ranked[..near] {
        let fit = &leading.hypothesis.fit;
        leading.left_out = left_out(search.evidence, fit, Depth::OneStep);
    }
    let sums: Vec<Option<f64>> = (ranked[..near].iter())
        .map(|r| r.left_out_sum(&search.model_error))
        .collect();
    if let Some(first) = sums[0] {
        let others = sums.iter().enumerate().skip(1);
        // A richer law in place of a plain one predicts a little better whether or not it is at work: the search has weighed them.
        let others =
            others.filter(|(i, _)| !stands_for(&ranked[*i].hypothesis, &ranked[0].hypothesis));
        let predicts = others.filter_map(|(i, sum)| Some((i, (*sum)?)));
        let better = predicts.min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((index, sum)) = better
            && first - sum > limit
        {
            let chosen = ranked.remove(index);
            ranked.insert(0, chosen);
        }
    }
    let best = ranked[0].score;
    // One that was put first for what it predicts is not held to be less likely than those behind it.
    let odds = |score: f64| (-0.5 * (score - best)).exp().min(1.0);
    let sum: f64 = ranked.iter().map(|r| odds(r.score)).sum();
    for r in &mut ranked {
        r.odds = odds(r.score);
        r.probability = r.odds / sum;
    }
    ranked
}

/// The baseline with what it leaves; of a rig that misses nothing, the best explanation is it.
fn baseline(search: &Search<'_>, best: &Hypothesis) -> Baseline {
    let evidence = search.evidence;
    let (plant, held) = if best.finds_nothing() {
        let plant = best.fit.prediction.plant.clone();
        let held = evidence.predict(&plant, true, None);
        (plant, held)
    } else {
        let prediction = search.baseline().fit.prediction;
        let plant = prediction.plant.clone();
        let held = if prediction.guided {
            prediction
        } else {
            evidence.predict(&plant, true, None)
        };
        (plant, held)
    };
    let prediction = evidence.predict(&plant, false, None);
    // A single link has nothing to be cut from.
    let links = match plant.chain {
        Chain::Whole => links(evidence, &held, &search.tolerated),
        _ => Vec::new(),
    };
    let links = links.into_iter().map(|link| {
        let regimes = regimes(evidence, &plant, &held.trajectories, &link.sigmas);
        (link, regimes)
    });
    Baseline {
        links: links.collect(),
        differences: differences(evidence, &prediction.residuals),
        plant,
        prediction,
    }
}

/// Errors of prediction of a recording that was not looked at; none where it holds no measured column.
fn unseen_errors(
    case: &DiagnosisInput,
    evidence: &Evidence,
    unseen: &NamedRecording,
    baseline: &PlantParameters,
    best: &Hypothesis,
) -> Option<Vec<Unseen>> {
    let inputs = &unseen.recorded.inputs;
    let mut measured = unseen.recorded.readings.clone();
    if measured.iter().flatten().all(|value| value.is_nan()) {
        return None;
    }
    clean(
        &inputs.time,
        &mut measured,
        &case.noise,
        case.believed.device.moving_mass,
    );
    let models = [&case.believed, baseline, &best.fit.prediction.plant];
    let predictions = models.map(|plant| simulate(plant, inputs).readings);
    let error = |channel: Channel, predicted: &[Vec<f64>; CHANNELS.len()]| {
        let index = channel as usize;
        let pairs = measured[index].iter().zip(&predicted[index]);
        let noise = evidence.noise[index];
        let residuals: Vec<f64> = pairs.map(|(m, p)| (m - p) / noise).collect();
        ErrorSize::of(&residuals, noise)
    };
    let channels = CHANNELS.into_iter().filter_map(|channel| {
        let [believed, before, after] = predictions.each_ref().map(|p| error(channel, p));
        Some(Unseen {
            channel,
            believed: believed?,
            before: before?,
            after: after?,
        })
    });
    Some(channels.collect())
}

impl Diagnosis {
    /// The best explanation.
    pub fn best(&self) -> &Hypothesis {
        &self.ranked[0].hypothesis
    }

    /// Rivals that the recordings do not rule out.
    pub fn rivals(&self) -> impl Iterator<Item = &Ranked> {
        self.ranked[1..]
            .iter()
            .filter(|r| r.odds >= self.settings.least_odds)
    }
}

/// Names of an explanation's effects.
pub fn names_of(hypothesis: &Hypothesis) -> Vec<String> {
    let effects = hypothesis.effects.iter();
    let unnamed = hypothesis.unlisted().map(|_| UNLISTED.to_owned());
    effects
        .map(|effect| spoken_name(effect.name))
        .chain(unnamed)
        .collect()
}

/// Name of an effect, with the joint that it is about.
pub fn spoken_name(effect: &str) -> String {
    match vocabulary(effect) {
        (name, Some(joint)) => format!("{name} (joint {joint})"),
        (name, None) => name.to_owned(),
    }
}

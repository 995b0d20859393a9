//! From a case to everything that is found in it.

use super::answer::band::half_widths;
use super::answer::estimate::estimates;
use super::answer::finding::{Baseline, Diagnosis, ErrorSize, Unseen};
use super::answer::words::listed;
use super::difference::extent::Largest;
use super::difference::links::links;
use super::difference::localise::differences;
use super::difference::mismatch::intervals;
use super::difference::regime::regimes;
use super::difference::remaining::Remaining;
use super::effort::Effort;
use super::experiment::coverage::Coverage;
use super::experiment::next_experiment::{Separation, separations};
use super::fit::cross_validation::{Depth, left_out};
use super::fit::free::Free;
use super::fit::hypothesis::Hypothesis;
use super::fit::model_error::ModelError;
use super::fit::{Limit, Refit, Start};
use super::formula::unlisted::Shape;
use super::recordings::clean::clean;
use super::recordings::evidence::Evidence;
use super::recordings::input::{DiagnosisInput, NamedRecording, Prepared};
use super::search::detectable::detectable;
use super::search::progress::{Observer, Step};
use super::search::ranking::{Ranked, rank};
use super::search::ruled_out::{add_exchanged, ruled_out};
use super::search::tried::Tried;
use super::search::{RoughFit, Search};
use super::settings::Settings;
use crate::diagnosis::recordings::device::Device;
use crate::plant::{CHANNELS, Channel, DeviceParts, PlantParameters, simulate};

/// The fit of the answer to all recordings but one, from where that to all is.
const LEFT_OUT: Refit<'static> = Refit::FINEST.from(Start::Here).until(Limit::of(8));

/// Diagnoses a case from its recordings as prepared; `observer` gets its progress.
#[must_use]
pub fn diagnose(
    case: &DiagnosisInput,
    prepared: Prepared,
    settings: &Settings,
    observer: &mut Observer<'_>,
) -> Diagnosis {
    let Prepared {
        mut evidence,
        cleanings,
        mut notes,
    } = prepared;
    evidence.effort = Effort::within(settings.limit);
    let Found {
        mut ranked,
        roughly,
        model_error,
        evidence,
        remaining,
    } = found(case, evidence, settings, observer);
    let search = search_of(case, &evidence, settings);
    notes.extend(finite_first(&search, &mut ranked));
    let is_spent = search.is_spent();
    let effort = evidence.effort.report();
    notes.extend(effort.note());
    notes.extend(evidence.effort.note_of_formulas());
    let depth = match is_spent {
        true => Depth::OneStep,
        false => Depth::Refit(LEFT_OUT),
    };
    let whole = &ranked[0].hypothesis.fit;
    ranked[0].left_out = left_out(&evidence, whole, depth);
    let best = &ranked[0].hypothesis;
    observer(&Step::Localisation.begins());
    let baseline = baseline(&search, best);
    let unseen = case.unseen.as_ref().and_then(|unseen| {
        let errors = unseen_errors(case, &evidence, unseen, &baseline.plant, best)?;
        Some((unseen.name.clone(), errors))
    });
    observer(&Step::Experiments.begins());
    let experiments = experiments(case, &evidence, &ranked);
    let estimates = estimates(&case.nominal, &ranked, &evidence);
    Diagnosis {
        settings: *settings,
        nominal: case.nominal.clone(),
        tolerated: case.tolerated.clone(),
        looked_at: case.candidates.len(),
        ruled_out: match case.nominal.parts.output() {
            Some(channel) if !is_spent => ruled_out(&search, best, channel),
            _ => Vec::new(),
        },
        detectable: match case.nominal.parts == DeviceParts::Whole
            && best.finds_nothing()
            && !is_spent
        {
            true => detectable(&search, best),
            false => Vec::new(),
        },
        tried: (case.tried)
            .and_then(|effect| Tried::of(effect, &case.nominal, (&ranked, &evidence))),
        roughly,
        model_error,
        remaining,
        half_widths: half_widths(&evidence, &ranked[0], &estimates.covariance),
        estimates,
        shape: Shape::of(&evidence, best),
        mismatch: intervals(&evidence, &case.nominal, best),
        largest: Largest::of(&evidence, &ranked[0], remaining.as_ref()),
        as_nominal: evidence.predict(&case.nominal, false, None),
        baseline,
        unseen,
        coverage: Coverage::of(&case.limits, &evidence, &best.fit.prediction),
        experiments,
        ranked,
        cleanings,
        effort,
        notes,
        evidence,
    }
}

/// Puts the first explanation that stays finite over what the recording to be predicted reaches before those that do not, and takes these out: the nominal
/// model within its tolerances where all fail. Returns what was taken out, a sentence each.
fn finite_first(search: &Search<'_>, ranked: &mut Vec<Ranked>) -> Vec<String> {
    let mut notes = Vec::new();
    while !search.is_finite(&ranked[0].hypothesis) {
        let names = ranked[0].hypothesis.effect_display_names();
        if names.is_empty() {
            notes.push("no model stays finite over the recording that is to be predicted, the nominal one neither".to_owned());
            break;
        }
        let names = listed(&names);
        notes.push(format!(
            "{names} fits the recordings best, and is not finite over what the recording to be predicted reaches: the next best explanation is given in its place"
        ));
        let failed = ranked.remove(0);
        if ranked.is_empty() {
            let plain = search.refit(&search.baseline(), Refit::FULL);
            ranked.push(Ranked {
                score: search.score(&plain),
                hypothesis: plain,
                ..failed
            });
        }
        let sum: f64 = ranked.iter().map(|r| r.probability).sum();
        let first = ranked[0].odds;
        for one in ranked.iter_mut() {
            one.odds = (one.odds / first).min(1.0);
            one.probability = if sum > 0.0 {
                one.probability / sum
            } else {
                1.0
            };
        }
    }
    notes
}

/// What a search came to.
struct Found {
    ranked: Vec<Ranked>,
    roughly: Vec<RoughFit>,
    model_error: ModelError,
    /// With the noise that explanations were held against.
    evidence: Evidence,
    remaining: Option<Remaining>,
}

/// Searches a whole device against its sensors' noise, a part of one against what no law explains.
fn found(
    case: &DiagnosisInput,
    evidence: Evidence,
    settings: &Settings,
    observer: &mut Observer<'_>,
) -> Found {
    let remaining = (case.nominal.parts.output())
        .map(|channel| Remaining::of(&search_of(case, &evidence, settings), channel, observer))
        .filter(|(remaining, _)| !remaining.is_noise());
    let Some((mut remaining, mut seed)) = remaining else {
        let search = search_of(case, &evidence, settings);
        let resumed = match case.kept.is_empty() {
            true => None,
            false => search.resumed(&case.kept, observer),
        };
        let (mut found, roughly, model_error) =
            resumed.unwrap_or_else(|| search.run_with_rough(observer));
        let weighed = Search {
            model_error: model_error.clone(),
            ..search.clone()
        };
        if settings.rivals {
            weighed.add_rivals(&mut found, observer);
        }
        if let Some(effect) = case.tried {
            weighed.add_tried(&mut found, effect, observer);
        }
        return Found {
            ranked: rank(&weighed, found),
            roughly,
            model_error,
            remaining: None,
            evidence,
        };
    };
    let mut round = 0;
    loop {
        round += 1;
        let (mut ranked, whole) = against((case, settings), &remaining, &seed, &evidence, observer);
        let best = &ranked[0].hypothesis.fit.prediction;
        let left = Remaining::left_by(best, &evidence, remaining.channel);
        let is_last = round == settings.rounds || whole.effort.is_spent();
        if is_last || !remaining.is_more_than(&left) {
            return Found {
                ranked,
                roughly: Vec::new(),
                model_error: ModelError::NONE,
                evidence: whole,
                remaining: Some(left),
            };
        }
        // The first look was too rough: what it left would hide what is still to be found.
        remaining = left;
        seed = ranked.swap_remove(0).hypothesis;
    }
}

/// Experiments that would tell the best explanation from the next: those known are of a bench, what an arm can do is in its programs.
fn experiments(case: &DiagnosisInput, evidence: &Evidence, ranked: &[Ranked]) -> Vec<Separation> {
    let of_bench = case.nominal.parts == DeviceParts::Whole
        && evidence.recordings.iter().all(|m| m.inputs.cell.is_none());
    match ranked {
        [best, rival, ..] if of_bench => separations(
            evidence,
            &case.limits,
            [&best.hypothesis.fit, &rival.hypothesis.fit],
        ),
        _ => Vec::new(),
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
    add_exchanged(&search, &mut found, observer);
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
pub(super) fn search_of<'a>(
    case: &'a DiagnosisInput,
    evidence: &'a Evidence,
    settings: &Settings,
) -> Search<'a> {
    // A single link is simulated in no time.
    let (look, most_effects) = match case.nominal.parts {
        DeviceParts::Whole => (3, settings.most_effects),
        _ => (12, settings.most_effects_of_part),
    };
    Search {
        evidence,
        nominal: case.nominal.clone(),
        tolerated: case.tolerated.iter().map(Free::within_sheet).collect(),
        candidates: case.candidates.clone(),
        shown: case.shown.clone(),
        look,
        most_effects,
        model_error: ModelError::NONE,
        unseen: (case.unseen.as_ref()).map(|unseen| &unseen.recorded.inputs),
        settings: *settings,
    }
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
    let links = match plant.parts {
        DeviceParts::Whole => links(evidence, &held, &search.tolerated),
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
    clean::<Device>(&inputs.time, &mut measured, &case.noise, &case.nominal);
    for readings in &mut measured {
        readings[..inputs.initial.samples()].fill(f64::NAN);
    }
    let models = [&case.nominal, baseline, &best.fit.prediction.plant];
    let predictions = models.map(|plant| simulate(plant, inputs).readings);
    let error = |channel: Channel, predicted: &[Vec<f64>; CHANNELS.len()]| {
        let index = channel as usize;
        let pairs = measured[index].iter().zip(&predicted[index]);
        let noise = evidence.noise[index];
        let residuals: Vec<f64> = pairs.map(|(m, p)| (m - p) / noise).collect();
        ErrorSize::of(&residuals, noise)
    };
    let channels = CHANNELS.into_iter().filter_map(|channel| {
        let [nominal, before, after] = predictions.each_ref().map(|p| error(channel, p));
        Some(Unseen {
            channel,
            nominal: nominal?,
            before: before?,
            after: after?,
        })
    });
    Some(channels.collect())
}

//! improved.toml: the nominal model's file with what was found, in the vocabulary of effects.

use crate::diagnosis::answer::estimate::Number;
use crate::diagnosis::answer::finding::Diagnosis;
use crate::effects::{PresentEffect, own_effect};
use crate::plant::{Latent, Quantity};
use crate::scenario::effects::WrittenEffect;
use crate::scenario::rig_file::{
    FREQUENCY_NAME, Improved, Known, RigFile, coefficient_name, improved_text,
};

use super::ground::covered;

/// The effects of an improved file: what the nominal one names already stays, unless what was found stands in its place.
pub(super) fn written<'a>(
    present: &'a [PresentEffect],
    diagnosis: &'a Diagnosis,
) -> Vec<WrittenEffect<'a>> {
    let found = &diagnosis.estimates.effects;
    let kept = present.iter().filter_map(|present| {
        let effect = present.effect;
        if found.iter().any(|(new, _)| new.excludes(effect)) || is_sought(present) {
            return None;
        }
        let parameters = effect.parameters(&diagnosis.nominal);
        let pairs = parameters.iter().zip(&present.values);
        Some(WrittenEffect {
            effect,
            law: present.law.as_deref(),
            parameters: pairs
                .map(|(p, value)| (p.quantity.name, *value, None))
                .collect(),
        })
    });
    // A number that is off stands at its own key.
    let laws = found
        .iter()
        .filter(|(effect, _)| effect.number_key().is_none());
    let new = laws.map(|(effect, numbers)| {
        let parameters = effect.parameters(&diagnosis.nominal);
        let own = |n: &&Number| parameters.iter().any(|p| p.quantity.name == n.name);
        let numbers = numbers.iter().filter(own);
        WrittenEffect {
            effect,
            law: diagnosis.law_of(effect),
            parameters: numbers
                .map(|n| (n.name, n.value, Some(n.interval)))
                .collect(),
        }
    });
    kept.chain(new).chain(formula(diagnosis)).collect()
}

/// The formula of a model discrepancy, if it is one.
fn formula(diagnosis: &Diagnosis) -> Option<WrittenEffect<'_>> {
    let law = &diagnosis.best().formula()?.law;
    let numbers = diagnosis.estimates.formula.iter();
    Some(WrittenEffect {
        effect: own_effect(law, 0),
        law: Some(law),
        parameters: numbers
            .map(|n| (n.name, n.value, Some(n.interval)))
            .collect(),
    })
}

/// Whether it is a law whose numbers were sought. Then it stands in the file only where they were found.
fn is_sought(present: &PresentEffect) -> bool {
    let law = present.law.as_ref();
    law.is_some_and(|law| law.constants.iter().any(|c| c.range.is_some()))
}

/// improved.toml: the rig file with what was found.
pub(super) fn improved_rig(rig: &RigFile, diagnosis: &Diagnosis) -> String {
    let estimates = &diagnosis.estimates;
    let off = estimates.effects.iter();
    let off = off.filter(|(effect, _)| effect.number_key().is_some());
    let off = off.flat_map(|(_, numbers)| numbers);
    let tolerated: Vec<(&str, f64, f64, f64)> = estimates
        .tolerated
        .iter()
        .chain(off)
        .map(|n| (n.name, n.value, n.interval[0], n.interval[1]))
        .collect();
    let effects = written(&rig.effects, diagnosis);
    let known = known(diagnosis);
    improved_text(
        rig,
        &Improved {
            tolerated: &tolerated,
            effects: &effects,
            unnamed: diagnosis.best().unlisted(),
            known: Some(&known),
            flange: None,
        },
    )
}

/// How sure a diagnosis is of its best explanation, and what its recordings covered.
pub(super) fn known(diagnosis: &Diagnosis) -> Known {
    let best = diagnosis.best();
    let fit = &best.fit;
    let covariance = &diagnosis.estimates.covariance;
    let places: Vec<(usize, String, Quantity)> = named(diagnosis);
    let deviation = |index: usize| covariance[(index, index)].max(0.0).sqrt();
    let numbers = places.iter().map(|(index, name, quantity)| {
        let slope = fit.free[*index].coordinate.slope(fit.values[*index]);
        (name.clone(), *quantity, deviation(*index) * slope.abs())
    });
    let correlation = |i: usize, j: usize| {
        let both = deviation(i) * deviation(j);
        match both > 0.0 {
            true => (covariance[(i, j)] / both).clamp(-1.0, 1.0),
            false => 0.0,
        }
    };
    let correlations = (1..places.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    let trajectories = &fit.prediction.trajectories;
    let runs = diagnosis.evidence.recordings.iter().zip(trajectories);
    Known {
        numbers: numbers.collect(),
        correlations: (correlations.map(|(i, j)| correlation(places[i].0, places[j].0))).collect(),
        noise: diagnosis.evidence.noise,
        half_widths: diagnosis.half_widths,
        covered: covered(runs.map(|(measured, run)| (&measured.inputs, &run.truth))),
    }
}

/// Free numbers that an improved file holds, by their names there: phases of what is periodic and the start of a chamber are those of their recordings.
fn named(diagnosis: &Diagnosis) -> Vec<(usize, String, Quantity)> {
    let best = diagnosis.best();
    let free = &best.fit.free;
    let tolerated = best.tolerated(&diagnosis.nominal);
    let mut found: Vec<(usize, String, Quantity)> = (0..tolerated)
        .filter(|index| free[*index].quantity.name.contains('.'))
        .map(|index| {
            (
                index,
                free[index].quantity.name.to_owned(),
                free[index].quantity,
            )
        })
        .collect();
    for (place, effect) in best.effects.iter().enumerate() {
        let own = best.numbers_of(&diagnosis.nominal, place);
        let parameters = effect.parameters(&diagnosis.nominal);
        for (index, parameter) in own.zip(parameters) {
            let name = match effect.number_key() {
                Some(key) => key.to_owned(),
                None => format!("{}.{}", effect.name, parameter.quantity.name),
            };
            found.push((index, name, free[index].quantity));
        }
    }
    if let Some(term) = best.unlisted() {
        let first = free.len() - term.numbers();
        found.extend((first..free.len()).map(|index| {
            let quantity = free[index].quantity;
            (
                index,
                name_in_term(term, index - first, &quantity),
                quantity,
            )
        }));
    }
    found
}

fn name_in_term(term: &Latent, index: usize, quantity: &Quantity) -> String {
    match term.formula() {
        Some(formula) => format!("{}.{}", own_effect(&formula.law, 0).name, quantity.name),
        None if index < term.coefficients.len() => coefficient_name(index),
        None => FREQUENCY_NAME.to_owned(),
    }
}

//! improved.toml: the believed model's file with what was found, in the vocabulary of effects.

use crate::diagnosis::estimate::Number;
use crate::diagnosis::finding::Diagnosis;
use crate::effects::{PresentEffect, own_effect};
use crate::scenario::effects::WrittenEffect;
use crate::scenario::rig_file::{RigFile, improved_text};

/// The effects of an improved file: what the believed one names already stays, unless what was found stands in its place.
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
        let parameters = effect.parameters(&diagnosis.believed);
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
        let parameters = effect.parameters(&diagnosis.believed);
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

/// The formula of a term without a name, if it is one.
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
    improved_text(rig, &tolerated, &effects, diagnosis.best().unlisted())
}

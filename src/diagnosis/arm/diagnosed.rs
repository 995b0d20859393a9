//! A diagnosis of a recorded arm.

use super::account::account;
use super::answer::{alternatives, effects};
use super::contact::touching;
use super::drives::{DriveNumbers, drives};
use super::effect::ArmEffect;
use super::evidence::Evidence;
use super::extent::{changes, stretches};
use super::held::held_pushes;
use super::input::ArmInput;
use super::pushed::candidate;
use super::search::search;
use crate::diagnosis::answer::details::{DETAILS_SCHEMA, Details};
use crate::diagnosis::answer::{Answer, Extent, SCHEMA, Verdict};
use crate::diagnosis::difference::mismatch::Mismatch;
use crate::diagnosis::search::progress::{Observer, Step};
use crate::effects::UNLISTED;
use crate::recorded_arm::ArmParameters;

/// What a channel leaves, over its noise, up to which it is explained [1].
const EXPLAINED: f64 = 1.3;

/// What was found.
#[derive(Debug, Clone)]
pub struct ArmDiagnosis {
    /// The answer.
    pub answer: Answer,
    /// The description as declared, moved within its tolerances to the recordings.
    pub tolerated: ArmParameters,
    /// The whole improved description.
    pub fitted: ArmParameters,
    /// Numbers of its drives.
    pub drives: Vec<DriveNumbers>,
}

/// Diagnoses a recorded arm; `observer` gets its progress.
#[must_use]
pub fn diagnose(input: &ArmInput, observer: &mut Observer<'_>) -> ArmDiagnosis {
    observer(&Step::Baseline.begins());
    let touching = touching(input);
    let evidence = Evidence::of(input, &touching);
    let mut found = search(&evidence, observer);
    observer(&Step::Localisation.begins());
    for push in held_pushes(input, &found.best.fit.arm) {
        let placed = candidate(push).applied(&mut found.best.fit.arm);
        if let Some(added) = found.best.fit.arm.pushes.last_mut() {
            *added = push;
        }
        found.best.effects.push(placed);
    }
    let effects = effects(input, &found);
    let alternatives = alternatives(input, &found);
    let verdict = if effects.is_empty() {
        Verdict::NothingMissing
    } else if effects.iter().any(|effect| effect.name == UNLISTED) {
        Verdict::Unlisted
    } else {
        Verdict::Explained
    };
    let drives = drives(input, &found.best.fit);
    let account = account(input, &found, &effects, &alternatives, (&touching, &drives));
    let fully = found.scales.iter().all(|scale| *scale <= EXPLAINED);
    let answer = Answer {
        schema: SCHEMA,
        verdict,
        explained: Some(if fully { Extent::Fully } else { Extent::Partly }),
        mismatch: mismatch(input, &found.best.fit.arm, &found.best.effects),
        effects,
        seconds: 0.0,
        alternatives,
        notes: Vec::new(),
        details: Details {
            schema: DETAILS_SCHEMA,
            account,
            ..Details::default()
        },
    };
    let mut fitted = found.best.fit.arm;
    // Less than a stamp's last digit is no delay.
    if !found
        .best
        .effects
        .iter()
        .any(|e| e.effect == ArmEffect::CurrentLate)
    {
        fitted.delay = input.nominal.delay;
    }
    ArmDiagnosis {
        answer,
        tolerated: found.nominal.fit.arm,
        fitted,
        drives,
    }
}

/// Where the effects act; nowhere without any.
fn mismatch(
    input: &ArmInput,
    arm: &ArmParameters,
    effects: &[super::effect::Candidate],
) -> Vec<Mismatch> {
    if effects.is_empty() {
        return Vec::new();
    }
    stretches(input, &changes(input, arm, effects))
        .iter()
        .map(|stretch| Mismatch {
            recording: input.recordings[stretch.recording].name.clone(),
            channel: input.columns[stretch.channel].clone(),
            start_s: stretch.start,
            end_s: stretch.end,
        })
        .collect()
}

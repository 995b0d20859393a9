//! A diagnosis of still postures.

use super::account::account;
use super::answer::{alternatives, effects, identified};
use super::estimate::{Numbers, numbers};
use super::fit::fit;
use super::found::{Found, PosturesInput};
use super::frame::{Frame, Turn};
use super::model::{Model, WRENCH_COLUMNS, residuals};
use super::select::candidates;
use super::{Posture, StillRecording};
use crate::diagnosis::answer::details::{ChannelMisfit, ChannelNoise, DETAILS_SCHEMA, Details};
use crate::diagnosis::answer::{Answer, Extent, SCHEMA, Verdict};
use crate::diagnosis::difference::localise::{robust_rms, root_mean_square};
use crate::effects::UNLISTED;

/// What is left of forces or torques, over their noise, up to which they are explained [1].
const EXPLAINED: f64 = 1.3;

/// What was found.
pub struct PosturesDiagnosis {
    /// The answer.
    pub answer: Answer,
    /// As declared, what is not declared fitted so.
    pub nominal: Model,
    /// The improved description.
    pub found: Model,
    /// The numbers of it.
    pub numbers: Numbers,
}

/// Diagnoses; none where the postures do not determine the numbers.
#[must_use]
pub fn diagnose(input: &PosturesInput) -> Option<PosturesDiagnosis> {
    let nominal = &input.nominal;
    let all = input.recordings.iter().flat_map(|r| &r.postures);
    let postures: Vec<Posture> = all.copied().collect();
    let candidates = candidates(&postures, nominal);
    let declared = Frame {
        turn: Turn::None,
        ..nominal.frame
    };
    let mut as_declared = fit(&postures, declared, nominal)?;
    as_declared.frame = declared;
    let numbers = numbers(&postures, &candidates.first()?.fit, nominal);
    let found = Found {
        input,
        postures,
        candidates,
        numbers,
        as_declared,
    };
    let effects = effects(&found);
    let alternatives = alternatives(&found);
    let models = [
        Model::declared(&found.as_declared, nominal, false),
        Model::declared(&found.as_declared, nominal, true),
        Model::of(&found.best().fit),
    ];
    let answer = Answer {
        schema: SCHEMA,
        verdict: match effects.is_empty() {
            true => Verdict::NothingMissing,
            false if effects.iter().any(|effect| effect.name == UNLISTED) => Verdict::Unlisted,
            false => Verdict::Explained,
        },
        explained: extent(&found),
        mismatch: Vec::new(),
        seconds: 0.0,
        details: Details {
            schema: DETAILS_SCHEMA,
            account: account(&found, &effects, &models),
            noise: noise(&found),
            misfit: misfits(&found, &models),
            identified: identified(&found),
            ..Details::default()
        },
        effects,
        alternatives,
        notes: Vec::new(),
    };
    let [nominal, _, improved] = models;
    Some(PosturesDiagnosis {
        answer,
        nominal,
        found: improved,
        numbers: found.numbers,
    })
}

/// Whether noise alone is left; none where the noise of the sensor is not known.
fn extent(found: &Found<'_>) -> Option<Extent> {
    let fit = &found.best().fit;
    let noise = found.input.nominal.noise;
    let kinds = if fit.has_torques { 2 } else { 1 };
    let known = noise[..kinds].iter().all(|noise| *noise > 0.0);
    let mut left = fit.rms.iter().zip(noise).take(kinds);
    known.then(
        || match left.all(|(rms, noise)| *rms <= EXPLAINED * noise) {
            true => Extent::Fully,
            false => Extent::Partly,
        },
    )
}

/// The sensor's noise by channel, as far as it is known.
fn noise(found: &Found<'_>) -> Vec<ChannelNoise> {
    let known = WRENCH_COLUMNS.iter().enumerate();
    let known = known.map(|(place, column)| (column, found.input.nominal.noise[place / 3]));
    known
        .filter(|(_, noise)| *noise > 0.0)
        .map(|(column, noise)| ChannelNoise {
            channel: (*column).to_owned(),
            standard_deviation: noise,
            shown: Vec::new(),
        })
        .collect()
}

/// What descriptions leave of each channel; over what is left of its kind where the noise is not known.
fn misfits(found: &Found<'_>, models: &[Model; 3]) -> Vec<ChannelMisfit> {
    let fit = &found.best().fit;
    let scatter = [0, 1].map(|kind| match found.input.nominal.noise[kind] {
        0.0 => fit.scatter[kind],
        known => known,
    });
    let of_recording = |recording: &StillRecording| {
        let left = models.each_ref().map(|m| residuals(&recording.postures, m));
        let one = |place: usize| {
            let own = left.each_ref().map(|left| left[place].as_slice());
            let sigmas = |values: &[f64]| {
                let over: Vec<f64> = values.iter().map(|v| v / scatter[place / 3]).collect();
                robust_rms(&over)
            };
            let rms = own.map(|left| root_mean_square(left.iter().copied()).unwrap_or(0.0));
            let (samples, nominal_sigmas) = sigmas(own[0])?;
            let read = recording.postures.iter().map(|posture| match place {
                0..3 => posture.force[place],
                _ => posture.torque.map_or(f64::NAN, |t| t[place - 3]),
            });
            let size = root_mean_square(read).unwrap_or(0.0);
            Some(ChannelMisfit {
                recording: recording.name.clone(),
                channel: WRENCH_COLUMNS[place].to_owned(),
                samples,
                nominal_sigmas,
                tolerated_sigmas: sigmas(own[1])?.1,
                improved_sigmas: sigmas(own[2])?.1,
                left_out_sigmas: None,
                nominal_rms: rms[0],
                tolerated_rms: rms[1],
                improved_rms: rms[2],
                improved_share: if size > 0.0 { rms[2] / size } else { 0.0 },
            })
        };
        (0..WRENCH_COLUMNS.len())
            .filter_map(one)
            .collect::<Vec<_>>()
    };
    found
        .input
        .recordings
        .iter()
        .flat_map(of_recording)
        .collect()
}

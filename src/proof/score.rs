//! One answer against the sealed truth of its case.
//!
//! - named exactly: the effects answered are those at work, no more and no fewer, and the verdict goes with them;
//! - parameter error: |value - truth| over |truth|; an interval covers where low <= truth <= high;
//! - overlap: time of claimed and true intervals in common over the time of either, over all recordings and channels;
//! - prediction: 90th percentile of |predicted - measured| over the sensor's noise, of the channel where it is largest; 1.64 is perfect.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use crate::diagnosis::answer::{Answer, Extent, Verdict};
use crate::effects::UNLISTED;
use crate::laboratory::{CHANNELS, Known, SealedCase, SealedEffect};

/// A name of an answer with its stated probability.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StatedName {
    /// The name.
    pub name: String,
    /// Its stated probability [1].
    pub probability: f64,
    /// Whether such an effect is there.
    pub right: bool,
}

/// Score of a case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseScore {
    /// Name of the case.
    pub case: String,
    /// Effects at work, each by its meaning.
    pub truth: Vec<String>,
    /// Effects answered; none where there was no answer.
    pub answered: Option<Vec<String>>,
    /// The names answered, with their stated probabilities.
    #[serde(default)]
    pub stated: Vec<StatedName>,
    /// Whether the answer says that it explains the recordings fully; none where it does not say.
    #[serde(default)]
    pub explained_fully: Option<bool>,
    /// Whether an unlisted effect is at work.
    pub unlisted: bool,
    /// Whether the effects at work are named, and nothing else.
    pub named_exactly: bool,
    /// Whether the verdict goes with the effects at work.
    pub verdict_right: bool,
    /// Of an unlisted effect: whether its subsystem and all that it depends on were given.
    pub placed: bool,
    /// Relative errors of the parameters of what was named.
    pub errors: Vec<f64>,
    /// Half-widths of their intervals, relative to the truth.
    pub half_widths: Vec<f64>,
    /// Number of intervals that hold the truth.
    pub covered: usize,
    /// Overlap of claimed and true intervals [1].
    pub overlap: f64,
    /// 90th percentile of the prediction's error in the worst channel, in standard deviations [1].
    pub prediction: Option<f64>,
    /// Wall time of the diagnosis [s].
    pub seconds: Option<f64>,
    /// Why there is no answer.
    pub failure: Option<String>,
}

impl CaseScore {
    /// Of a case that was not answered.
    pub fn failed(truth: &SealedCase, failure: String) -> Self {
        Self {
            case: truth.case.clone(),
            truth: truth.effects.iter().map(|e| e.truth.clone()).collect(),
            answered: None,
            stated: Vec::new(),
            explained_fully: None,
            unlisted: is_unlisted(truth),
            named_exactly: false,
            verdict_right: false,
            placed: false,
            errors: Vec::new(),
            half_widths: Vec::new(),
            covered: 0,
            overlap: 0.0,
            prediction: None,
            seconds: None,
            failure: Some(failure),
        }
    }
}

fn is_unlisted(truth: &SealedCase) -> bool {
    truth.effects.iter().any(|effect| effect.name == UNLISTED)
}

/// Scores an answer; `prediction` is the worst channel's percentile, where there is a prediction.
pub fn judge(answer: &Answer, truth: &SealedCase, prediction: Option<f64>) -> CaseScore {
    let sorted = |mut names: Vec<String>| {
        names.sort();
        names
    };
    let answered = sorted(answer.effects.iter().map(|e| e.name.clone()).collect());
    let wanted = sorted(truth.effects.iter().map(|e| e.name.clone()).collect());
    let unlisted = is_unlisted(truth);
    let verdict = match (wanted.is_empty(), unlisted) {
        (true, _) => Verdict::NothingMissing,
        (false, true) => Verdict::Unlisted,
        (false, false) => Verdict::Explained,
    };
    // What is there beside may be named or not, and no list holds all of it.
    let beside = !truth.also_there.is_empty();
    let there = |name: &String| truth.also_there.contains(name) || (beside && name == UNLISTED);
    let all_named = wanted.iter().all(|name| answered.contains(name));
    let others: Vec<&String> = answered.iter().filter(|n| !wanted.contains(n)).collect();
    let verdict_right = answer.verdict == verdict || (beside && all_named);
    let stated = answer.effects.iter().map(|effect| StatedName {
        name: effect.name.clone(),
        probability: effect.confidence,
        right: wanted.contains(&effect.name) || there(&effect.name),
    });
    let mut score = CaseScore {
        named_exactly: all_named && others.into_iter().all(there) && verdict_right,
        stated: stated.collect(),
        explained_fully: answer.explained.map(|extent| extent == Extent::Fully),
        placed: !unlisted || truth.effects.iter().all(|effect| places(answer, effect)),
        verdict_right,
        answered: Some(answered),
        overlap: overlap(answer, truth),
        prediction,
        seconds: Some(answer.seconds),
        failure: None,
        ..CaseScore::failed(truth, String::new())
    };
    for effect in &truth.effects {
        let Some(found) = answer
            .effects
            .iter()
            .find(|found| found.name == effect.name)
        else {
            continue;
        };
        for (name, known) in &effect.parameters {
            let Known::Number(known) = known else {
                continue;
            };
            let estimate = found.parameters.iter().find(|(own, _)| own == name);
            let Some((_, estimate)) = estimate else {
                score.errors.push(f64::MAX);
                score.half_widths.push(f64::MAX);
                continue;
            };
            let relative = |difference: f64| (difference / known).abs();
            score.errors.push(relative(estimate.value - known));
            score
                .half_widths
                .push(relative(0.5 * (estimate.high - estimate.low)));
            if (estimate.low..=estimate.high).contains(known) {
                score.covered += 1;
            }
        }
    }
    score
}

/// Whether an answer gives the subsystem of an unlisted effect, and at most three variables with all that it depends on.
fn places(answer: &Answer, effect: &SealedEffect) -> bool {
    let Some(Known::Names(wanted)) = effect.parameters.get("depends_on") else {
        return true;
    };
    answer.effects.iter().any(|found| {
        found.name == UNLISTED
            && found.subsystem == effect.subsystem
            && found.depends_on.len() <= 3
            && wanted.iter().all(|name| found.depends_on.contains(name))
    })
}

/// Intersection over union of the times of claimed and true intervals; 1 where both are empty.
pub fn overlap(answer: &Answer, truth: &SealedCase) -> f64 {
    type Rows<'a> = BTreeMap<(&'a str, &'a str), Vec<[f64; 2]>>;
    let mut claimed = Rows::new();
    for row in &answer.mismatch {
        let recording = row.recording.trim_end_matches(".csv");
        let key = (recording, row.channel.as_str());
        claimed
            .entry(key)
            .or_default()
            .push([row.start_s, row.end_s]);
    }
    let mut real = Rows::new();
    for row in &truth.mismatch {
        // What is to be predicted is not diagnosed from.
        if row.recording != "predict" {
            let key = (row.recording.as_str(), row.channel.as_str());
            real.entry(key).or_default().push([row.start_s, row.end_s]);
        }
    }
    let keys: BTreeSet<_> = claimed.keys().chain(real.keys()).copied().collect();
    let (mut common, mut either) = (0.0, 0.0);
    for key in keys {
        let rows = |from: &Rows<'_>| from.get(&key).map_or_else(Vec::new, |rows| merged(rows));
        let (a, b) = (rows(&claimed), rows(&real));
        let both: f64 = a
            .iter()
            .flat_map(|x| b.iter().map(|y| (x[1].min(y[1]) - x[0].max(y[0])).max(0.0)))
            .sum();
        common += both;
        either += length(&a) + length(&b) - both;
    }
    if either > 0.0 { common / either } else { 1.0 }
}

fn merged(rows: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut rows = rows.to_vec();
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut apart: Vec<[f64; 2]> = Vec::new();
    for row in rows {
        match apart.last_mut() {
            Some(last) if row[0] <= last[1] => last[1] = last[1].max(row[1]),
            _ => apart.push(row),
        }
    }
    apart
}

fn length(rows: &[[f64; 2]]) -> f64 {
    rows.iter().map(|row| row[1] - row[0]).sum()
}

/// 90th percentile of |predicted - measured| over the noise in the channel where it is largest; readings that were lost are left out.
pub fn worst_channel(
    predicted: &[Vec<f64>; 4],
    measured: &[Vec<f64>; 4],
    noise: &BTreeMap<String, f64>,
) -> f64 {
    let mut worst = 0.0f64;
    for (channel, name) in CHANNELS.iter().enumerate() {
        let Some(noise) = noise.get(*name) else {
            continue;
        };
        let pairs = predicted[channel].iter().zip(&measured[channel]);
        let mut errors: Vec<f64> = pairs
            .filter(|(_, measured)| !measured.is_nan())
            .map(|(predicted, measured)| ((predicted - measured) / noise).abs())
            .map(|error| if error.is_finite() { error } else { f64::MAX })
            .collect();
        errors.sort_by(f64::total_cmp);
        let last = errors.len().saturating_sub(1);
        worst = worst.max(errors.get(last * 9 / 10).copied().unwrap_or(0.0));
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::answer::details::Details;
    use crate::diagnosis::answer::estimate::Estimate;
    use crate::diagnosis::answer::{FoundEffect, SCHEMA};
    use crate::diagnosis::difference::mismatch::Mismatch;
    use crate::laboratory::SealedInterval;

    fn truth() -> SealedCase {
        SealedCase {
            case: "case".to_owned(),
            effects: vec![SealedEffect {
                name: "force_sensor_gain_error".to_owned(),
                truth: "force_sensor_gain_error".to_owned(),
                subsystem: "sensors".to_owned(),
                parameters: [("gain".to_owned(), Known::Number(0.9))].into(),
                formula: None,
            }],
            noise: CHANNELS
                .iter()
                .map(|name| ((*name).to_owned(), 2.0))
                .collect(),
            also_there: Vec::new(),
            mismatch: vec![SealedInterval {
                recording: "ride".to_owned(),
                channel: "force_n".to_owned(),
                start_s: 1.0,
                end_s: 3.0,
            }],
            true_parameters: BTreeMap::new(),
            shows: 0.0,
            seed: 0,
        }
    }

    fn answer(value: f64, low: f64, high: f64) -> Answer {
        Answer {
            schema: SCHEMA,
            verdict: Verdict::Explained,
            explained: None,
            effects: vec![FoundEffect {
                name: "force_sensor_gain_error".to_owned(),
                key: None,
                subsystem: "sensors".to_owned(),
                confidence: 1.0,
                doubts: Vec::new(),
                parameters: vec![("gain".to_owned(), Estimate::new(value, low, high))].into(),
                depends_on: Vec::new(),
                law: None,
                unlisted: None,
            }],
            mismatch: vec![Mismatch {
                recording: "ride.csv".to_owned(),
                channel: "force_n".to_owned(),
                start_s: 2.0,
                end_s: 5.0,
            }],
            seconds: 1.0,
            alternatives: Vec::new(),
            notes: Vec::new(),
            details: Details::default(),
        }
    }

    #[test]
    fn a_right_answer_is_named_and_its_numbers_are_measured() {
        let score = judge(&answer(0.909, 0.89, 0.93), &truth(), Some(1.7));
        assert!(score.named_exactly && score.verdict_right && score.placed);
        assert!((score.errors[0] - 0.01).abs() < 1e-12);
        assert!((score.half_widths[0] - 0.02 / 0.9).abs() < 1e-12);
        assert_eq!((score.covered, score.prediction), (1, Some(1.7)));
        // 2 to 3 in common of 1 to 5.
        assert!((score.overlap - 0.25).abs() < 1e-12);
        assert_eq!(judge(&answer(0.95, 0.94, 0.96), &truth(), None).covered, 0);
    }

    #[test]
    fn what_is_there_beside_may_be_named_and_what_is_not_may_not() {
        let mut truth = truth();
        truth.also_there = vec!["tool_runout".to_owned()];
        let named = |others: &[&str]| {
            let mut answer = answer(0.9, 0.8, 1.0);
            for name in others {
                let mut more = answer.effects[0].clone();
                (*name).clone_into(&mut more.name);
                more.confidence = 0.6;
                answer.effects.push(more);
            }
            judge(&answer, &truth, None)
        };
        assert!(named(&[]).named_exactly && named(&["tool_runout"]).named_exactly);
        let wrong = named(&["tool_runout", "force_sensor_lag"]);
        assert!(!wrong.named_exactly);
        let stated: Vec<(f64, bool)> = wrong
            .stated
            .iter()
            .map(|name| (name.probability, name.right))
            .collect();
        assert_eq!(stated, [(1.0, true), (0.6, true), (0.6, false)]);
    }

    #[test]
    fn what_is_too_much_too_little_or_another_is_not_named_exactly() {
        let mut nothing = answer(0.9, 0.8, 1.0);
        nothing.effects.clear();
        nothing.verdict = Verdict::NothingMissing;
        let score = judge(&nothing, &truth(), None);
        assert!(!score.named_exactly && !score.verdict_right && score.errors.is_empty());

        let mut more = answer(0.9, 0.8, 1.0);
        let mut second = more.effects[0].clone();
        second.name = "force_sensor_lag".to_owned();
        more.effects.push(second);
        let score = judge(&more, &truth(), None);
        assert!(!score.named_exactly && score.verdict_right && score.covered == 1);

        let mut empty = truth();
        empty.effects.clear();
        assert!(judge(&nothing, &empty, None).named_exactly);
        assert!(!judge(&answer(0.9, 0.8, 1.0), &empty, None).named_exactly);
    }

    #[test]
    fn an_unlisted_effect_must_be_placed() {
        let mut sealed = truth();
        let names = |list: &[&str]| list.iter().map(|s| (*s).to_owned()).collect::<Vec<_>>();
        sealed.effects[0].name = UNLISTED.to_owned();
        sealed.effects[0].parameters =
            [("depends_on".to_owned(), Known::Names(names(&["stroke_m"])))].into();
        let mut found = answer(0.0, 0.0, 0.0);
        found.verdict = Verdict::Unlisted;
        found.effects[0].name = UNLISTED.to_owned();
        found.effects[0].depends_on = names(&["velocity", "stroke_m"]);
        let score = judge(&found, &sealed, None);
        assert!(score.named_exactly && score.placed && score.unlisted);
        found.effects[0].depends_on = names(&["velocity"]);
        assert!(!judge(&found, &sealed, None).placed);
        found.effects[0].depends_on = names(&["velocity", "stroke_m", "time", "surface_m"]);
        assert!(!judge(&found, &sealed, None).placed);
    }

    #[test]
    fn the_worst_channel_counts_and_lost_readings_do_not() {
        let noise = truth().noise;
        let measured = [0, 1, 2, 3].map(|c| {
            let reading = |i: i32| if i == 99 { f64::NAN } else { f64::from(i * c) };
            (0..100).map(reading).collect::<Vec<f64>>()
        });
        let predicted = [0, 1, 2, 3].map(|_| vec![0.0; 100]);
        // Channel 3: errors 0, 1.5 ... 147 of 99 readings; index 88 of them.
        assert_eq!(worst_channel(&predicted, &measured, &noise), 88.0 * 1.5);
    }
}

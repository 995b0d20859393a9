//! Rules that hold the statements of an answer to each other, in one place: a diagnosis is stated through them, and [`contradictions`] checks any answer.

use super::details::{ChannelMisfit, IN_TURN, PredictionError, remaining_errors};
use super::doubt::Doubt;
use super::estimate::Estimate;
use super::{Answer, Extent, FoundEffect, Verdict};
use crate::diagnosis::difference::localise::NOISE_ALONE;
use crate::diagnosis::recordings::recorded::COLUMNS;
use crate::effects::UNLISTED;

/// Probability from which an effect is stated as found [1].
pub const TRUSTED: f64 = 0.5;
/// Probability below which an effect is not in the headline [1].
pub const IN_HEADLINE: f64 = 0.1;
/// Most that is stated of a law while a tolerated number stands at its end and was not tried beyond it [1].
const UNTRIED: f64 = 0.9;
/// Ratio of the ends of an interval that says no more than an order of magnitude [1].
const DECADE: f64 = 10.0;
/// Robust root mean square of a channel far above its noise, over the noise [1].
pub const FAR: f64 = 3.0;
/// Growth of an error from the nominal model that is more than chance [1].
const WORSE: f64 = 1.05;

/// Probability that is stated of an effect for which the evidence gives one.
#[must_use]
pub fn stated(probability: f64, doubts: &[Doubt]) -> f64 {
    let of = |most: f64, doubt: &Doubt| match doubt {
        Doubt::NotTriedBeyond | Doubt::LeavesMuch => most.min(UNTRIED),
        Doubt::AnotherDoesAsWell => most.min(TRUSTED),
        // As likely as not at best.
        _ => most.min(TRUSTED * probability),
    };
    doubts.iter().fold(probability, of)
}

/// Doubts that the numbers of an effect cast on it.
#[must_use]
pub fn doubts_of(numbers: &[Estimate]) -> Vec<Doubt> {
    let spans = |e: &Estimate| {
        let [a, b] = [e.low.abs(), e.high.abs()];
        e.low * e.high > 0.0 && a.max(b) >= DECADE * a.min(b)
    };
    let neutral = |e: &Estimate| {
        e.without
            .map(|without| e.low < e.high && (e.low..=e.high).contains(&without))
    };
    let known: Vec<bool> = numbers.iter().filter_map(neutral).collect();
    let all = [
        (
            numbers.iter().any(|e| e.at_limit.is_some()),
            Doubt::AtEndOfRange,
        ),
        (numbers.iter().any(spans), Doubt::SpansDecade),
        (
            !known.is_empty() && known.iter().all(|holds| *holds),
            Doubt::HoldsNeutral,
        ),
    ];
    let holding = all.into_iter().filter(|(is, _)| *is);
    holding.map(|(_, doubt)| doubt).collect()
}

/// Whether an effect is named in the headline.
#[must_use]
pub fn in_headline(confidence: f64, doubts: &[Doubt]) -> bool {
    confidence >= IN_HEADLINE && !doubts.iter().any(|d| d.forbids())
}

/// Index of the channel that is left furthest above its noise, of those far above it where it was fitted to. What is left in a recording that was left out or kept
/// back says as much of the fit, and of ground that it does not know, as of the explanation.
#[must_use]
pub fn far_above(misfit: &[ChannelMisfit]) -> Option<usize> {
    let errors = remaining_errors(misfit, &[]);
    let far = errors.first().filter(|e| e.sigmas > FAR)?;
    COLUMNS.iter().position(|column| *column == far.column)
}

/// Whether a channel of a recording is predicted worse than by the nominal model.
#[must_use]
pub fn is_worse(nominal: f64, improved: f64, sigmas: f64) -> bool {
    sigmas > NOISE_ALONE && improved > WORSE * nominal
}

/// Whether a channel is predicted worse than by the nominal model, or the recording that was kept back not to its noise.
#[must_use]
pub fn forbids_fully(misfit: &[ChannelMisfit], prediction: &[PredictionError]) -> bool {
    let worse = |m: &ChannelMisfit| is_worse(m.nominal_rms, m.improved_rms, m.improved_sigmas);
    let mut kept = prediction.iter().filter(|e| e.recording != IN_TURN);
    misfit.iter().any(worse)
        || kept.any(|e| e.after_sigmas.is_some_and(|sigmas| sigmas > NOISE_ALONE))
}

/// Statements of an answer that contradict one another, a sentence each; none of an answer that holds together.
#[must_use]
pub fn contradictions(answer: &Answer) -> Vec<String> {
    let mut found = Vec::new();
    let details = &answer.details;
    for effect in &answer.effects {
        found.extend(of_effect(effect, &details.account.headline));
    }
    let unlisted = answer.effects.iter().any(|e| e.name == UNLISTED);
    let far = far_above(&details.misfit).is_some();
    let mut claim = |is: bool, what: &str| {
        if is {
            found.push(what.to_owned());
        }
    };
    claim(
        answer.verdict == Verdict::Explained && far,
        "it is explained, and a channel is left far above its noise",
    );
    claim(
        (answer.verdict == Verdict::NothingMissing) != answer.effects.is_empty(),
        "the verdict does not go with the effects",
    );
    claim(
        (answer.verdict == Verdict::Unlisted) != unlisted,
        "the verdict does not go with what is unlisted",
    );
    claim(
        answer.explained == Some(Extent::Fully)
            && forbids_fully(&details.misfit, &details.prediction),
        "it is explained fully, and a channel is worse than nominal or above its noise where it was not fitted to",
    );
    for family in &details.families {
        let most = family
            .members
            .iter()
            .map(|m| m.probability)
            .fold(0.0, f64::max);
        claim(
            family.probability < most - 1e-9,
            &format!(
                "the family {} is less likely than one of its laws",
                family.name
            ),
        );
        for member in &family.members {
            let stated = (answer.effects.iter())
                .find(|e| e.name == member.name && e.key == member.key)
                .map(|e| e.confidence);
            claim(
                stated.is_some_and(|stated| (stated - member.probability).abs() > 1e-9),
                &format!("{} has two probabilities", member.name),
            );
        }
    }
    found
}

/// Contradictions in what is stated of an effect.
fn of_effect(effect: &FoundEffect, headline: &str) -> Vec<String> {
    let name = &effect.name;
    let mut found = Vec::new();
    let probability = effect.confidence;
    if !(0.0..=1.0).contains(&probability) {
        found.push(format!("{name} has a probability of {probability}"));
    }
    let numbers: Vec<Estimate> = effect.parameters.iter().map(|(_, e)| *e).collect();
    let shown = doubts_of(&numbers);
    let forbidden = shown.iter().chain(&effect.doubts).find(|d| d.forbids());
    if let Some(doubt) = forbidden.filter(|_| probability > TRUSTED) {
        found.push(format!(
            "{name} is stated above 50 %, and {}",
            doubt.words()
        ));
    }
    if effect.doubts.contains(&Doubt::NotTriedBeyond) && probability > UNTRIED {
        let what = Doubt::NotTriedBeyond.words();
        found.push(format!("{name} is stated above 90 %, and {what}"));
    }
    // Of one kind of several joints each is named with its joint.
    let joint = effect.parameters.iter().find(|(key, _)| key == "joint");
    let named = match joint {
        Some((_, joint)) => headline.contains(&format!("{name} (joint {})", joint.value)),
        None if !effect.parameters.place.is_empty() => {
            headline.contains(&format!("{name}{}", effect.parameters.place_words()))
        }
        None => headline
            .split(|c: char| !(c.is_alphanumeric() || c == '_'))
            .any(|word| word == name),
    };
    if named && (forbidden.is_some() || probability < IN_HEADLINE) {
        found.push(format!(
            "{name} is in the headline, and is not to be stated"
        ));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::details::{FamilyMember, FamilyReport};
    use super::super::estimate::Limit;
    use super::super::tests::answer;
    use super::*;

    fn number(value: f64, low: f64, high: f64, without: Option<f64>) -> Estimate {
        Estimate {
            without,
            ..Estimate::new(value, low, high)
        }
    }

    #[test]
    fn numbers_cast_the_doubts_that_they_should() {
        let of = doubts_of;
        assert_eq!(of(&[number(12.0, 11.0, 13.0, Some(0.0))]), []);
        assert_eq!(
            of(&[number(0.1, -0.1, 0.3, Some(0.0))]),
            [Doubt::HoldsNeutral]
        );
        assert_eq!(
            of(&[number(1.0, 0.3, 3.1, Some(0.0))]),
            [Doubt::SpansDecade]
        );
        // Of two numbers one that is clearly there is enough.
        let drift = [
            number(0.1, -0.1, 0.3, Some(0.0)),
            number(2.0, 1.9, 2.1, Some(0.0)),
        ];
        assert_eq!(of(&drift), []);
        let end = Estimate {
            at_limit: Some(Limit::Upper),
            ..number(1000.0, 900.0, 1000.0, None)
        };
        assert_eq!(of(&[end]), [Doubt::AtEndOfRange]);
        // Which joint is known or not.
        assert_eq!(
            of(&[number(2.0, 2.0, 2.0, Some(2.0))]),
            [Doubt::HoldsNeutral; 0]
        );
    }

    /// Each statement that must not stand, made in an answer that holds together.
    #[test]
    fn what_contradicts_is_seen() {
        let sound = answer();
        assert_eq!(contradictions(&sound), [""; 0]);
        let seen = |change: &dyn Fn(&mut Answer), words: &str| {
            let mut answer = sound.clone();
            change(&mut answer);
            let found = contradictions(&answer);
            assert!(
                found.iter().any(|s| s.contains(words)),
                "{words}: {found:?}"
            );
        };
        let misfit = |improved: f64, nominal: f64| ChannelMisfit {
            recording: "ride.csv".to_owned(),
            channel: "force_n".to_owned(),
            samples: 100,
            nominal_sigmas: nominal,
            tolerated_sigmas: nominal,
            improved_sigmas: improved,
            left_out_sigmas: None,
            nominal_rms: nominal,
            tolerated_rms: nominal,
            improved_rms: improved,
            improved_share: 0.1,
        };
        seen(
            &|a| a.effects[0].parameters[0].1.at_limit = Some(Limit::Upper),
            "end of the range",
        );
        seen(
            &|a| a.effects[0].parameters[0].1.high = 1000.0,
            "spans a decade",
        );
        seen(
            &|a| a.effects[0].doubts = vec![Doubt::CostsNothing],
            "as well without it",
        );
        seen(
            &|a| a.effects[0].doubts = vec![Doubt::NotTriedBeyond],
            "above 90 %",
        );
        seen(
            &|a| {
                a.effects[0].confidence = 0.05;
                a.details.account.headline = "missing: coulomb_viscous_friction".to_owned();
            },
            "in the headline",
        );
        seen(
            &|a| a.details.misfit = vec![misfit(5.0, 9.0)],
            "far above its noise",
        );
        seen(
            &|a| {
                a.explained = Some(Extent::Fully);
                a.details.misfit = vec![misfit(1.3, 1.2)];
            },
            "explained fully",
        );
        seen(&|a| a.verdict = Verdict::NothingMissing, "does not go with");
        seen(
            &|a| {
                let member = FamilyMember {
                    name: "coulomb_viscous_friction".to_owned(),
                    key: None,
                    probability: 0.5,
                    number: None,
                };
                a.details.families = vec![FamilyReport {
                    name: "dry_friction".to_owned(),
                    words: String::new(),
                    probability: 0.4,
                    members: vec![member],
                }];
            },
            "two probabilities",
        );
    }

    #[test]
    fn what_is_doubted_is_stated_by_no_more_than_the_rules_allow() {
        assert_eq!(stated(0.999, &[]), 0.999);
        assert!(stated(1.0, &[Doubt::AtEndOfRange]) <= 0.5);
        assert!(stated(0.6, &[Doubt::SpansDecade, Doubt::NotTriedBeyond]) <= 0.3);
        assert_eq!(stated(1.0, &[Doubt::NotTriedBeyond]), 0.9);
        assert!(!in_headline(0.3, &[Doubt::CostsNothing]));
        assert!(!in_headline(0.09, &[]) && in_headline(0.3, &[]));
    }
}

//! From what was found to diagnosis.json.

use super::details::{
    ChannelMisfit, ChannelNoise, Considered, DETAILS_SCHEMA, Details, DetectableParameter,
    DetectableReport, IN_TURN, LinkReport, NextExperiment, PredictionError, RegimeReport,
    RemainingError, RemainingReport, RuledOutReport, ToleratedNumber, remaining_errors,
};
use super::estimate::{Estimate, Number};
use super::finding::{Diagnosis, ErrorSize, Unseen};
use super::parameters::Parameters;
use super::statements::{TRUSTED, far_above, forbids_fully};
use super::{Alternative, Answer, Extent, FoundEffect, FoundLaw, SCHEMA, Verdict};
use crate::diagnosis::difference::extent::NEAR_NOISE;
use crate::diagnosis::difference::links::Link;
use crate::diagnosis::difference::localise::{
    Misfit, NOISE_ALONE, misfits, robust_rms, root_mean_square,
};
use crate::diagnosis::difference::mismatch::Mismatch;
use crate::diagnosis::difference::regime::{Regime, regimes};
use crate::diagnosis::fit::hypothesis::{Hypothesis, effect_display_name};
use crate::diagnosis::fit::robust_sum;
use crate::diagnosis::formula::unlisted::report::formula_text;
use crate::diagnosis::recordings::evidence::Prediction;
use crate::diagnosis::recordings::recorded::COLUMNS;
use crate::diagnosis::search::detectable::DetectableNumber;
use crate::effects::UNLISTED;
use crate::effects::{Effect, Subsystem, Which};
use crate::plant::{CHANNELS, Channel, DeviceParts, LawText};

/// Variables named at most for a link.
const MOST_REGIMES: usize = 5;
/// Explanations that were not given, named at most.
const MOST_CONSIDERED: usize = 8;

impl Link {
    /// The link that a channel shows.
    pub(in crate::diagnosis) fn of(channel: Channel) -> Self {
        match channel {
            Channel::RegulatorPressure => Self::Regulator,
            Channel::Stroke | Channel::Acceleration => Self::Piston,
            Channel::Force => Self::Contact,
        }
    }

    /// Where a model discrepancy would enter that this link alone shows.
    fn subsystem(self) -> Subsystem {
        match self {
            Self::Regulator => Subsystem::Regulator,
            Self::Piston => Subsystem::ForceBalance,
            Self::Contact => Subsystem::Contact,
        }
    }

    /// Name in an answer.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Regulator => "regulator",
            Self::Piston => "piston",
            Self::Contact => "contact",
        }
    }
}

impl Diagnosis {
    /// diagnosis.json; `seconds` is how long it took.
    #[must_use]
    pub fn answer(&self, seconds: f64) -> Answer {
        let effects = self.found();
        let name = |recording: usize| self.evidence.recordings[recording].name.clone();
        Answer {
            schema: SCHEMA,
            verdict: if effects.is_empty() {
                Verdict::NothingMissing
            } else if effects.iter().any(|effect| effect.name == UNLISTED) {
                Verdict::Unlisted
            } else {
                Verdict::Explained
            },
            explained: self.extent(),
            effects,
            mismatch: self
                .mismatch
                .iter()
                .map(|interval| Mismatch {
                    recording: name(interval.recording),
                    channel: COLUMNS[interval.channel as usize].to_owned(),
                    start_s: interval.start,
                    end_s: interval.end,
                })
                .collect(),
            seconds,
            alternatives: self
                .rivals()
                .map(|ranked| Alternative {
                    effects: ranked.hypothesis.effect_display_names(),
                    formula: ranked.hypothesis.unlisted().and_then(formula_text),
                    odds: ranked.odds,
                })
                .collect(),
            notes: self.notes.clone(),
            details: self.details(),
        }
    }

    /// Whether all recordings are predicted to near the noise: those fitted to, each by the others, and the one to be predicted where it was measured.
    #[must_use]
    pub fn extent(&self) -> Option<Extent> {
        let unseen = self.unseen.iter().flat_map(|(_, errors)| errors);
        let near = |error: &Unseen| error.after.p90 <= NEAR_NOISE;
        let near = self.largest?.is_near_noise() && unseen.into_iter().all(near);
        let fully = near && !forbids_fully(&self.misfits(), &self.prediction_errors());
        Some(if fully { Extent::Fully } else { Extent::Partly })
    }

    /// The smallest effects that the recordings would have shown, where none is named.
    pub(in crate::diagnosis) fn smallest_reported(&self) -> Vec<DetectableReport> {
        let number = |number: &DetectableNumber| DetectableParameter {
            name: number.name.to_owned(),
            value: number.value,
            without: number.without,
        };
        (self.detectable.iter())
            .map(|smallest| DetectableReport {
                effect: effect_display_name(smallest.effect.name),
                parameters: smallest.numbers.iter().map(number).collect(),
            })
            .collect()
    }

    /// The law that an effect is which a user wrote.
    pub fn law_of(&self, effect: &Effect) -> Option<&LawText> {
        match effect.which {
            Which::Own { place } => self.nominal.own.get(place).map(|law| &*law.text),
            Which::Only | Which::Joint { .. } | Which::Number { .. } => None,
        }
    }

    /// The missing effects, with their numbers: the one place where a diagnosis gets its effects from.
    fn found(&self) -> Vec<FoundEffect> {
        let effects = self.estimates.effects.iter();
        let unlisted = self.best().unlisted().map(|latent| FoundEffect {
            name: UNLISTED.to_owned(),
            subsystem: latent.port.subsystem().to_owned(),
            confidence: self.confidence(UNLISTED),
            doubts: self.doubts(UNLISTED),
            parameters: (self.estimates.formula.iter())
                .map(|number| (number.name.to_owned(), Estimate::from(number)))
                .collect(),
            depends_on: (self.best().depends_on.iter())
                .map(|name| (*name).to_owned())
                .collect(),
            key: None,
            law: latent.formula().map(|formula| FoundLaw::of(&formula.law)),
            unlisted: self.unlisted_report().map(Box::new),
        });
        let rest = self.discrepancy_far_above_noise();
        effects
            .map(|(effect, numbers)| FoundEffect {
                name: effect.vocabulary().0.to_owned(),
                subsystem: effect.subsystem.name().to_owned(),
                confidence: self.confidence(effect.name),
                doubts: self.doubts(effect.name),
                parameters: joint_of(effect)
                    .into_iter()
                    .chain(
                        numbers
                            .iter()
                            .filter(|number| number.reported || self.is_of_link())
                            .map(|number| (name_of(effect, number), Estimate::from(number))),
                    )
                    .collect(),
                depends_on: Vec::new(),
                key: effect.number_key().map(str::to_owned),
                law: self.law_of(effect).map(FoundLaw::of),
                unlisted: None,
            })
            .chain(unlisted)
            .chain(rest)
            .collect()
    }

    /// The channel that known effects leave furthest above its noise, of those far above it.
    fn far_above_with_names(&self) -> Option<usize> {
        let named = !self.best().effects.is_empty() && self.best().unlisted().is_none();
        self.far_above().filter(|_| named)
    }

    /// The channel that the best explanation leaves furthest above its noise, of those far above it.
    pub(in crate::diagnosis) fn far_above(&self) -> Option<usize> {
        far_above(&self.misfits())
    }

    /// Whether known effects leave a channel far above its noise: then they do not explain the recordings.
    pub(in crate::diagnosis) fn leaves_model_discrepancy(&self) -> bool {
        self.far_above_with_names().is_some()
    }

    /// What known effects leave far above the noise, as a model discrepancy: of them alone nothing is explained.
    fn discrepancy_far_above_noise(&self) -> Option<FoundEffect> {
        let channel = self.far_above_with_names()?;
        Some(FoundEffect {
            name: UNLISTED.to_owned(),
            subsystem: Link::of(CHANNELS[channel]).subsystem().name().to_owned(),
            confidence: TRUSTED,
            doubts: Vec::new(),
            parameters: Parameters::default(),
            depends_on: Vec::new(),
            key: None,
            law: None,
            unlisted: None,
        })
    }

    /// Share of the mismatch of the baseline that is explained [1]; none where there is no mismatch beyond noise.
    #[must_use]
    pub fn explained_share(&self) -> Option<f64> {
        if self.best().finds_nothing() {
            return None;
        }
        self.share_explained_by(self.best())
    }

    /// That of an explanation.
    #[must_use]
    pub fn share_explained_by(&self, hypothesis: &Hypothesis) -> Option<f64> {
        let noise = self.evidence.count() as f64;
        let before = robust_sum(&self.baseline.prediction.residuals);
        let after = hypothesis.fit.misfit;
        (before > noise).then(|| ((before - after) / (before - noise)).clamp(0.0, 1.0))
    }

    /// Errors of prediction: of the recording to be predicted where it was measured, otherwise of each left out in turn.
    #[must_use]
    pub fn prediction_errors(&self) -> Vec<PredictionError> {
        let error = |recording: &str, unseen: &Unseen| PredictionError {
            recording: recording.to_owned(),
            channel: COLUMNS[unseen.channel as usize].to_owned(),
            nominal: unseen.nominal.rms,
            before: unseen.before.rms,
            after: unseen.after.rms,
            noise: Some(self.evidence.noise[unseen.channel as usize]),
            before_sigmas: Some(unseen.before.sigmas),
            after_sigmas: Some(unseen.after.sigmas),
        };
        if let Some((name, errors)) = &self.unseen {
            return errors.iter().map(|e| error(name, e)).collect();
        }
        let Some(left) = &self.ranked[0].left_out else {
            return Vec::new();
        };
        let of_channel = |channel: Channel| {
            let noise = self.evidence.noise[channel as usize];
            let size = |prediction: &Prediction| {
                let own = self.by_channel(&prediction.residuals);
                let own = own.filter(|(_, of, _)| *of == channel);
                let all: Vec<f64> = own.flat_map(|(.., r)| r.iter().copied()).collect();
                ErrorSize::of(&all, noise)
            };
            let after = (left.residuals.iter()).flat_map(|r| r[channel as usize].iter());
            let after: Vec<f64> = after.copied().collect();
            let in_turn = Unseen {
                channel,
                nominal: size(&self.as_nominal)?,
                before: size(&self.baseline.prediction)?,
                after: ErrorSize::of(&after, noise)?,
            };
            Some(error(IN_TURN, &in_turn))
        };
        CHANNELS.into_iter().filter_map(of_channel).collect()
    }

    /// Errors that the best explanation leaves, the largest beside its noise first.
    #[must_use]
    pub fn remaining_errors(&self) -> Vec<RemainingError> {
        remaining_errors(&self.misfits(), &self.prediction_errors())
    }

    pub(in crate::diagnosis) fn by_channel<'a>(
        &'a self,
        residuals: &'a [f64],
    ) -> impl Iterator<Item = (usize, crate::plant::Channel, &'a [f64])> {
        crate::diagnosis::recordings::evidence::by_channel(&self.evidence, residuals)
    }

    /// Whether there is a part of the device alone.
    #[must_use]
    pub fn is_of_link(&self) -> bool {
        self.nominal.parts != DeviceParts::Whole
    }

    /// Details that are not scored.
    #[must_use]
    pub fn details(&self) -> Details {
        Details {
            schema: DETAILS_SCHEMA,
            effort: Some(self.effort),
            account: self.account(),
            noise: self.noises(),
            misfit: self.misfits(),
            differences: self
                .baseline
                .differences
                .iter()
                .map(|difference| Mismatch {
                    recording: self.evidence.recordings[difference.recording].name.clone(),
                    channel: COLUMNS[difference.channel as usize].to_owned(),
                    start_s: difference.span[0],
                    end_s: difference.span[1],
                })
                .collect(),
            links: self.link_reports(),
            departure: self.largest.map(|largest| self.departure(largest)),
            tried: self.tried_report(),
            families: self.families(),
            explained_share: self.explained_share(),
            remaining: self.remaining_report(),
            considered: (self.considered().into_iter())
                .take(MOST_CONSIDERED)
                .collect(),
            ruled_out: (self.ruled_out.iter())
                .map(|variant| RuledOutReport {
                    effects: variant
                        .effects
                        .iter()
                        .map(|name| (*name).to_owned())
                        .collect(),
                    rms: variant.rms,
                    parameters: (variant.numbers.iter())
                        .map(|(name, value)| ((*name).to_owned(), *value))
                        .collect(),
                })
                .collect(),
            detectable: self.smallest_reported(),
            tolerated: self.tolerated(),
            prediction: self.prediction_errors(),
            next_experiment: self.next_experiment(),
            ..Details::default()
        }
    }

    /// Explanations that were tried beside the best one: those fitted in full first, each the best first.
    pub(in crate::diagnosis) fn considered(&self) -> Vec<Considered> {
        let power = |score: f64, best: f64| -0.5 * (score - best) / std::f64::consts::LN_10;
        let best = self.ranked[0].score;
        let others = self.ranked[1..].iter().map(|ranked| Considered {
            effects: ranked.hypothesis.effect_display_names(),
            in_full: true,
            log10_odds: power(ranked.score, best),
            explained_share: self.share_explained_by(&ranked.hypothesis),
        });
        let mut found: Vec<Considered> = others.collect();
        let own = self.best().effect_display_names();
        for rough in &self.roughly {
            let effects: Vec<String> = rough
                .effects
                .iter()
                .map(|e| effect_display_name(e))
                .collect();
            let same = |known: &[String]| {
                known.len() == effects.len() && known.iter().all(|name| effects.contains(name))
            };
            if !same(&own) && !found.iter().any(|other| same(&other.effects)) {
                found.push(Considered {
                    effects,
                    in_full: false,
                    log10_odds: power(rough.behind, 0.0),
                    explained_share: rough.explained_share,
                });
            }
        }
        // Those that were fitted in full come first; of each kind the nearest.
        found.sort_by(|a, b| {
            let nearest = b.log10_odds.total_cmp(&a.log10_odds);
            b.in_full.cmp(&a.in_full).then(nearest)
        });
        found
    }

    fn noises(&self) -> Vec<ChannelNoise> {
        let of = |(channel, column): (usize, &str)| ChannelNoise {
            channel: column.to_owned(),
            standard_deviation: self.evidence.noise[channel],
            shown: self.cleanings.iter().map(|c| c.noise[channel]).collect(),
        };
        // A rig without a sensor has no noise of it.
        let there = |(channel, _): &(usize, &str)| self.evidence.noise[*channel].is_finite();
        let all = COLUMNS.into_iter().enumerate();
        all.filter(there).map(of).collect()
    }

    pub(in crate::diagnosis) fn misfits(&self) -> Vec<ChannelMisfit> {
        let evidence = &self.evidence;
        let nominal = misfits(evidence, &self.as_nominal.residuals);
        let baseline = misfits(evidence, &self.baseline.prediction.residuals);
        let improved = misfits(evidence, &self.best().fit.prediction.residuals);
        let left = |recording: usize, channel: usize| {
            let left = self.ranked[0].left_out.as_ref()?;
            robust_rms(&left.residuals[recording][channel]).map(|(_, rms)| rms)
        };
        let together = nominal.iter().zip(&baseline).zip(&improved);
        together
            .map(|((nominal, baseline), improved)| ChannelMisfit {
                recording: evidence.recordings[nominal.recording].name.clone(),
                channel: COLUMNS[nominal.channel as usize].to_owned(),
                samples: nominal.samples,
                nominal_sigmas: nominal.sigmas,
                tolerated_sigmas: baseline.sigmas,
                improved_sigmas: improved.sigmas,
                left_out_sigmas: left(nominal.recording, nominal.channel as usize),
                nominal_rms: nominal.rms,
                tolerated_rms: baseline.rms,
                improved_rms: improved.rms,
                improved_share: self.share_of_channel(improved),
            })
            .collect()
    }

    /// Remainder of a channel as a share of the root mean square of the channel itself [1]; of one that reads nought throughout, nothing is a share.
    fn share_of_channel(&self, left: &Misfit) -> f64 {
        let measured = &self.evidence.recordings[left.recording].readings[left.channel as usize];
        let own = root_mean_square(measured.iter().copied()).unwrap_or_default();
        if own > 0.0 { left.rms / own } else { 0.0 }
    }

    /// Root mean square of what the best explanation leaves of a channel, in its unit.
    pub(in crate::diagnosis) fn left_of(&self, channel: Channel) -> f64 {
        let best = &self.best().fit.prediction;
        let own = self.by_channel(&best.residuals);
        let own = own.filter(|(_, of, _)| *of == channel);
        let sigmas = root_mean_square(own.flat_map(|(.., residuals)| residuals.iter().copied()));
        sigmas.unwrap_or_default() * self.evidence.noise[channel as usize]
    }

    fn link_reports(&self) -> Vec<LinkReport> {
        let links = self.baseline.links.iter();
        links
            .map(|(link, regimes)| {
                let explained = link.size <= NOISE_ALONE;
                let named = if explained { 0 } else { MOST_REGIMES };
                LinkReport {
                    link: link.link.name().to_owned(),
                    sigmas: link.size,
                    explained,
                    regimes: regimes
                        .iter()
                        .take(named)
                        .map(|regime| RegimeReport {
                            variable: regime.variable.to_owned(),
                            share: regime.correlation_ratio,
                        })
                        .collect(),
                }
            })
            .collect()
    }

    fn remaining_report(&self) -> Option<RemainingReport> {
        let remaining = self.remaining.as_ref()?;
        let regimes = self.regimes_of_what_is_left().into_iter();
        Some(RemainingReport {
            channel: COLUMNS[remaining.channel as usize].to_owned(),
            rms: remaining.size,
            sensor_noise: remaining.noise,
            autocorrelation_time_s: remaining.time,
            regimes: regimes
                .take(MOST_REGIMES)
                .map(|regime| RegimeReport {
                    variable: regime.variable.to_owned(),
                    share: regime.correlation_ratio,
                })
                .collect(),
        })
    }

    /// Variables that explain the remainder of a part of the device under the best explanation.
    pub(in crate::diagnosis) fn regimes_of_what_is_left(&self) -> Vec<Regime> {
        let Some(remaining) = &self.remaining else {
            return Vec::new();
        };
        let best = &self.best().fit.prediction;
        let own = self.by_channel(&best.residuals);
        let own = own.filter(|(_, channel, _)| *channel == remaining.channel);
        let left: Vec<f64> = own
            .flat_map(|(_, _, residuals)| residuals.to_vec())
            .collect();
        regimes(&self.evidence, &best.plant, &best.trajectories, &left)
    }

    fn tolerated(&self) -> Vec<ToleratedNumber> {
        let nominal = |number: &Number| {
            let free = self.best().fit.free.iter();
            let mut own = free.filter(|f| f.quantity.name == number.name);
            own.next().map(|f| f.quantity.get(&self.nominal))
        };
        let numbers = self.estimates.tolerated.iter();
        numbers
            .filter_map(|number| {
                Some(ToleratedNumber {
                    key: number.name.to_owned(),
                    nominal: nominal(number)?,
                    found: Estimate::from(number),
                })
            })
            .collect()
    }

    /// The experiment that tells the best explanation from the next.
    #[must_use]
    pub fn next_experiment(&self) -> Option<NextExperiment> {
        let (best, others) = self.experiments.split_first()?;
        Some(NextExperiment {
            name: best.experiment.name.to_owned(),
            instruction: best.experiment.instruction.clone(),
            from: self.ranked.get(1)?.hypothesis.effect_display_names(),
            found: self.best().effect_display_names(),
            sigmas: best.square.sqrt(),
            seconds: best.duration,
            others: others
                .iter()
                .map(|other| (other.experiment.name.to_owned(), other.square.sqrt()))
                .collect(),
        })
    }
}

/// The joint that an effect is about, as one of its numbers.
fn joint_of(effect: &Effect) -> Option<(String, Estimate)> {
    let joint = effect.vocabulary().1? as f64;
    Some(("joint".to_owned(), Estimate::new(joint, joint, joint)))
}

/// Name of an effect's number in an answer: of a number of the rig file that is off, whose key stands beside it, its value.
fn name_of(effect: &Effect, number: &Number) -> String {
    let name = effect.number_key().map_or(number.name, |_| "value");
    name.to_owned()
}

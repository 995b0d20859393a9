//! From a search to an answer: effects by their names, places and numbers, and how sure each is.

use super::effect::{ArmEffect, Candidate};
use super::estimate::{Number, covariance, declared, numbers, turned};
use super::fit::Parameter;
use super::input::ArmInput;
use super::search::{Found, Stage};
use crate::diagnosis::answer::doubt::Doubt;
use crate::diagnosis::answer::estimate::{Estimate, Limit};
use crate::diagnosis::answer::parameters::{Parameters, Place};
use crate::diagnosis::answer::statements::{doubts_of, stated};
use crate::diagnosis::answer::{Alternative, FoundEffect, FoundLaw};
use crate::effects::UNLISTED;
use crate::recorded_arm::Quantity;
use crate::recorded_arm::law::{Factor, JointLaw, Shape, Variable};
use crate::recorded_arm::vocabulary::arm_effect;
use crate::recorded_arm::wrench::CHANNELS;

/// Worth over which the evidence for an effect grows by a factor of e [1].
const GROWS: f64 = 25.0;
/// Most that is stated: a law that nobody thought of may do as well [1].
const MOST: f64 = 0.97;
/// Odds below which a rival is not mentioned [1].
const LEAST_ODDS: f64 = 1e-4;
/// Variables of a law at most.
const VARIABLES: usize = 3;

/// Name of an effect in the vocabulary.
#[must_use]
pub fn name_of(effect: ArmEffect) -> &'static str {
    match effect {
        ArmEffect::JointFriction(_) => "joint_friction",
        ArmEffect::Stribeck(_) => "stribeck_joint_friction",
        ArmEffect::LoadFriction(_) => "load_dependent_joint_friction",
        ArmEffect::MotorInertia(_) => "motor_inertia_error",
        ArmEffect::DriveGain(_) => "drive_gain_error",
        ArmEffect::TorqueOffset(_) => "joint_torque_offset",
        ArmEffect::GearRipple(_) => "gear_ripple",
        ArmEffect::CompliantJoint(_) => "compliant_joint",
        ArmEffect::EncoderOffset(_) => "joint_encoder_offset",
        ArmEffect::WarmUp(_) => "joint_warm_up",
        ArmEffect::Payload => "payload",
        ArmEffect::LinkMass(_) => "link_mass_error",
        ArmEffect::BaseTilt => "base_tilt",
        ArmEffect::DressPack(_) => "dress_pack_spring",
        ArmEffect::Push(_) => "outside_push",
        ArmEffect::WrenchZero => "wrench_zero",
        ArmEffect::ToolWeight => "tool_weight_error",
        ArmEffect::FrameTurned => "wrench_frame_turned",
        ArmEffect::WrenchGain(_) => "wrench_gain_error",
        ArmEffect::Crosstalk(..) => "wrench_crosstalk",
        ArmEffect::WrenchDrift(_) => "wrench_drift",
        ArmEffect::CurrentLate => "current_late",
        ArmEffect::Unlisted(_) => UNLISTED,
    }
}

/// Where an effect is.
fn place_of(input: &ArmInput, effect: ArmEffect) -> Vec<(String, Place)> {
    if let Some(joint) = effect.joint() {
        return vec![("joint".to_owned(), Place::from(input.numbers[joint]))];
    }
    let named = |key: &str, name: &str| (key.to_owned(), Place::from(name));
    match effect {
        ArmEffect::LinkMass(link) => vec![named("link", &input.links[link])],
        ArmEffect::Push(recording) => {
            vec![named("recording", &input.recordings[recording].name)]
        }
        ArmEffect::WrenchGain(k) | ArmEffect::WrenchDrift(k) => {
            vec![named("channel", CHANNELS[k])]
        }
        ArmEffect::Crosstalk(source, target) => vec![
            named("source", CHANNELS[source]),
            named("target", CHANNELS[target]),
        ],
        _ => Vec::new(),
    }
}

/// Share of the links' tolerated numbers at their bounds from which the links are not as described [1].
const EXHAUSTED: f64 = 0.2;

/// Effects of a search as they are reported: what acts at one joint without a name is one.
#[must_use]
pub fn effects(input: &ArmInput, found: &Found) -> Vec<FoundEffect> {
    let spread = covariance(&found.best.fit);
    let laws = laws_at(&found.best.effects);
    let mut all = Vec::new();
    for (joint, own) in &laws {
        all.push(unlisted(input, found, *joint, own));
    }
    for effect in &found.best.effects {
        if is_part_of_law(effect, &laws) {
            continue;
        }
        let reported = match effect.effect {
            ArmEffect::FrameTurned => {
                let declared = input.nominal.wrench.as_ref().map_or(0.0, |w| w.rotation);
                vec![turned(&found.best.fit, &spread, declared)]
            }
            _ => numbers(&found.best.fit, &spread, effect),
        };
        // What the description states is the number without the effect: an interval that holds it casts doubt.
        let declared = declared(&input.nominal, effect).into_iter().map(Some);
        let declared = declared.chain(std::iter::repeat(None));
        let mut numbers: Vec<(String, Estimate)> = reported.iter().map(estimate).collect();
        for ((_, number), without) in numbers.iter_mut().zip(declared) {
            number.without = without.filter(|without| without.is_finite());
        }
        all.push(listed(input, found, effect.effect, numbers));
    }
    all
}

/// Laws and ripples without a name, joint by joint: two ripples of one gear are no gear ripple of one frequency.
fn laws_at(effects: &[Candidate]) -> Vec<(usize, Vec<&Candidate>)> {
    let mut joints: Vec<usize> = (effects.iter())
        .filter_map(|e| e.law.map(|law| law.joint))
        .collect();
    joints.sort_unstable();
    joints.dedup();
    let of = |joint: usize| {
        let laws = effects
            .iter()
            .filter(move |e| e.law.is_some_and(|l| l.joint == joint));
        let periodic = effects.iter().any(|e| {
            e.law
                .is_some_and(|l| l.joint == joint && l.shape == Shape::Sine)
        });
        let ripple =
            (effects.iter()).filter(move |e| periodic && e.effect == ArmEffect::GearRipple(joint));
        (joint, laws.chain(ripple).collect())
    };
    joints.into_iter().map(of).collect()
}

fn is_part_of_law(effect: &Candidate, laws: &[(usize, Vec<&Candidate>)]) -> bool {
    let own = laws.iter().flat_map(|(_, own)| own);
    { own }.any(|other| std::ptr::eq(*other, effect))
}

fn estimate(number: &Number) -> (String, Estimate) {
    let (value, half) = (number.value, number.half);
    let estimate = Estimate::new(value, value - half, value + half);
    (number.key.to_owned(), estimate)
}

fn listed(
    input: &ArmInput,
    found: &Found,
    effect: ArmEffect,
    mut numbers: Vec<(String, Estimate)>,
) -> FoundEffect {
    let name = name_of(effect);
    for (_, number) in &mut numbers {
        number.at_limit = limit_of(found, effect, number);
    }
    let plain: Vec<Estimate> = numbers.iter().map(|(_, number)| *number).collect();
    let mut doubts = doubts_of(&plain);
    if acts_as_links_do(effect)
        && are_links_exhausted(found)
        && !doubts.contains(&Doubt::AtEndOfRange)
    {
        doubts.push(Doubt::AtEndOfRange);
    }
    FoundEffect {
        name: name.to_owned(),
        key: None,
        subsystem: arm_effect(name)
            .map_or("", |known| known.subsystem)
            .to_owned(),
        confidence: stated(probability(found, effect), &doubts),
        doubts,
        parameters: Parameters::placed(place_of(input, effect), numbers),
        depends_on: Vec::new(),
        law: None,
        unlisted: None,
    }
}

/// Whether an effect acts as masses and centres of the links do.
fn acts_as_links_do(effect: ArmEffect) -> bool {
    use ArmEffect as E;
    matches!(
        effect,
        E::Payload | E::LinkMass(_) | E::BaseTilt | E::DressPack(_)
    )
}

/// Whether much of what is tolerated of the links ends at its bounds even so: then the links are not as described, and what acts as they do stands for that.
fn are_links_exhausted(found: &Found) -> bool {
    let fit = &found.best.fit;
    let of_links = |p: &&Parameter| {
        p.prior.is_some() && matches!(p.quantity, Quantity::LinkMass(_) | Quantity::LinkCentre(..))
    };
    let all = fit.parameters.iter().filter(of_links);
    let is_at_bound = |p: &&Parameter| {
        let value = p.quantity.value(&fit.arm);
        let near = 1e-3 * (p.bounds[1] - p.bounds[0]);
        p.bounds.iter().any(|bound| (value - bound).abs() < near)
    };
    let (count, at_bounds) = (all.clone().count(), all.filter(is_at_bound).count());
    at_bounds as f64 > EXHAUSTED * count as f64
}

/// The end of what a link's mass may be, where its interval reaches that: then it may stand for something else.
fn limit_of(found: &Found, effect: ArmEffect, number: &Estimate) -> Option<Limit> {
    let ArmEffect::LinkMass(_) = effect else {
        return None;
    };
    let own = found.best.effects.iter().find(|own| own.effect == effect)?;
    let [least, most] = own.free.first()?.bounds;
    match (number.low <= least, number.high >= most) {
        (_, true) => Some(Limit::Upper),
        (true, false) => Some(Limit::Lower),
        (false, false) => None,
    }
}

fn unlisted(input: &ArmInput, found: &Found, joint: usize, own: &[&Candidate]) -> FoundEffect {
    let arm = &found.best.fit.arm;
    let laws: Vec<JointLaw> = own.iter().filter_map(|c| fitted_law(found, c)).collect();
    let ripple = arm.drives[joint].ripple;
    let mut terms: Vec<String> = laws.iter().map(formula).collect();
    if own
        .iter()
        .any(|c| matches!(c.effect, ArmEffect::GearRipple(_)))
    {
        let cycles = arm.drives[joint].ripple_cycles;
        terms.push(sine(ripple, cycles));
    }
    let mut depends_on: Vec<String> = Vec::new();
    let variables = laws.iter().flat_map(JointLaw::depends_on);
    for variable in variables.map(str::to_owned) {
        if !depends_on.contains(&variable) && depends_on.len() < VARIABLES {
            depends_on.push(variable);
        }
    }
    let outside = laws.iter().all(|law| {
        law.variable == Variable::Angle && law.factor == Factor::One && law.shape != Shape::Sine
    });
    FoundEffect {
        name: UNLISTED.to_owned(),
        key: None,
        subsystem: if outside { "surroundings" } else { "joints" }.to_owned(),
        confidence: probability(found, ArmEffect::Unlisted(joint)),
        doubts: Vec::new(),
        parameters: Parameters::placed(place_of(input, ArmEffect::Unlisted(joint)), Vec::new()),
        depends_on,
        law: Some(FoundLaw {
            acts_on: format!("torque_of_joint_{}", input.numbers[joint]),
            is: terms.join(" + "),
            units: std::collections::BTreeMap::default(),
        }),
        unlisted: None,
    }
}

/// A law as it was fitted.
fn fitted_law(found: &Found, candidate: &Candidate) -> Option<JointLaw> {
    let place = candidate.free.iter().find_map(|p| match p.quantity {
        Quantity::LawAmplitude(law, _) => Some(law),
        _ => None,
    })?;
    found.best.fit.arm.laws.get(place).copied()
}

fn sine([sine, cosine]: [f64; 2], cycles: f64) -> String {
    let amplitude = sine.hypot(cosine);
    let phase = cosine.atan2(sine);
    format!("{amplitude:.3} sin({cycles:.2} q {phase:+.2})")
}

/// A law as an expression over q, v, a, t_g and t [SI], z the share of the sliding friction.
fn formula(law: &JointLaw) -> String {
    let x = match law.variable {
        Variable::Angle => "q",
        Variable::Speed => "v",
        Variable::Acceleration => "a",
        Variable::Load => "t_g",
        Variable::Time => "t",
    };
    let (a, p, w) = (law.amplitude[0], law.place, law.width);
    let shape = match law.shape {
        Shape::SlopeAbove => format!("{a:.4} max(0, {x} - ({p:.4}))"),
        Shape::SlopeBelow => format!("{a:.4} max(0, {p:.4} - {x})"),
        Shape::Bump => format!("{a:.4} exp(-(({x} - ({p:.4}))/{w:.4})^2/2)"),
        Shape::Sine => sine(law.amplitude, p),
        Shape::Linear => format!("{a:.4} {x}"),
        Shape::Square => format!("{a:.4} {x} |{x}|"),
        Shape::Cube => format!("{a:.4} {x}^3"),
        Shape::Saturation => format!("{a:.4} tanh({x}/{w:.4})"),
        Shape::Approach => format!("{a:.4} (1 - exp(-{x}/{w:.4}))"),
        Shape::Step => format!("{a:.4} ({x} >= {p:.4})"),
        Shape::Constant => format!("{a:.4}"),
    };
    let factor = match law.factor {
        Factor::One => "",
        Factor::Friction => " z",
        Factor::Speed => " v",
        Factor::Load => " t_g",
    };
    shape + factor
}

/// The stage at which an effect was taken in.
fn stage_of(found: &Found, effect: ArmEffect) -> Option<&Stage> {
    (found.stages.iter()).find(|s| s.accepted().is_some_and(|t| t.effect == effect))
}

/// Probability that an effect is at work: by how much it is worth, and how near another came at its stage that was not needed beside it.
fn probability(found: &Found, effect: ArmEffect) -> f64 {
    let Some((stage, own)) =
        stage_of(found, effect).and_then(|stage| stage.accepted().map(|own| (stage, own)))
    else {
        // A push while the arm holds still is not searched for by a fit.
        return match effect {
            ArmEffect::Push(_) => MOST,
            _ => MOST * 0.5,
        };
    };
    let others: f64 = rivals(found, stage).iter().map(|(_, odds)| odds).sum();
    MOST * (1.0 - (-own.worth / GROWS).exp()).max(0.0) / (1.0 + others)
}

/// Other effects of a stage, with their odds against the one that was taken in.
fn rivals(found: &Found, stage: &Stage) -> Vec<(ArmEffect, f64)> {
    let Some(own) = stage.accepted() else {
        return Vec::new();
    };
    let taken = found.best.names();
    let others = stage.tried.iter().filter(|t| !taken.contains(&t.effect));
    others
        .filter(|t| {
            own.effect.simpler() != Some(t.effect) && t.effect.simpler() != Some(own.effect)
        })
        .map(|t| (t.effect, (0.5 * (t.worth - own.worth)).min(0.0).exp()))
        .collect()
}

/// Explanations that come near.
#[must_use]
pub fn alternatives(input: &ArmInput, found: &Found) -> Vec<Alternative> {
    let mut all = Vec::new();
    for stage in &found.stages {
        for (effect, odds) in rivals(found, stage) {
            if odds > LEAST_ODDS {
                let place = Parameters::placed(place_of(input, effect), Vec::new());
                all.push(Alternative {
                    effects: vec![format!("{}{}", name_of(effect), place.place_words())],
                    formula: None,
                    odds,
                });
            }
        }
    }
    all.sort_by(|a, b| b.odds.total_cmp(&a.odds));
    all
}

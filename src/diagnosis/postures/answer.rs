//! Effects of a diagnosis of still postures, by their names and numbers, and how sure each is.

use super::estimate::{Interval, numbers};
use super::fit::fit;
use super::found::Found;
use super::frame::{Frame, Turn};
use super::nominal::Bounded;
use super::select::SUREST;
use crate::diagnosis::answer::details::IdentifiedNumber;
use crate::diagnosis::answer::estimate::Estimate;
use crate::diagnosis::answer::statements::{doubts_of, stated};
use crate::diagnosis::answer::{Alternative, FoundEffect, FoundLaw};
use crate::effects::UNLISTED;
use crate::recorded_arm::vocabulary::arm_effect;
use crate::stats::{NORMAL_95, normal_share_below};

/// Standard errors by which a number lies beyond its tolerance where it is off [1].
const OFF: f64 = 3.0;
/// Odds below which another is not mentioned [1].
const LEAST_ODDS: f64 = 1e-4;
/// Most of them.
const MOST: usize = 6;

/// Effects, what the readings are first.
pub(super) fn effects(found: &Found<'_>) -> Vec<FoundEffect> {
    let declared = &found.input.nominal.declared;
    let own = &found.numbers;
    let three = |bounds: Option<[Bounded; 3]>, intervals: [Interval; 3]| {
        let pairs = bounds.into_iter().flatten().zip(intervals);
        pairs
            .map(|(bounds, interval)| (Some(bounds), interval))
            .collect::<Vec<_>>()
    };
    let vector = |bounds: Option<[Bounded; 3]>, intervals: [Interval; 3]| match bounds {
        Some(_) => three(bounds, intervals),
        None => intervals.map(|interval| (None, interval)).to_vec(),
    };
    let mut zero = vector(declared.zero, own.zero);
    let mut tool = vec![(declared.mass, own.mass)];
    if found.best().fit.has_torques {
        zero.extend(vector(declared.torque_zero, own.torque_zero));
        tool.extend(vector(declared.centre, own.centre));
    }
    let tilt = Bounded {
        value: 0.0,
        low: 0.0,
        high: found.input.nominal.tilt,
    };
    let lean = own.lean.map(|interval| (None, interval));
    let all = [
        frame(found),
        off(found, "wrench_zero", &zero, &zero),
        off(found, "tool_weight_error", &tool, &tool),
        off(found, "base_tilt", &[(Some(tilt), own.tilt)], &lean),
    ];
    all.into_iter().flatten().collect()
}

/// The axes, where they are not the declared ones.
fn frame(found: &Found<'_>) -> Option<FoundEffect> {
    let declared = &found.input.nominal.frame;
    let best = found.best();
    let frame = best.fit.frame;
    if found.is_as_declared(&frame) {
        return None;
    }
    if !frame.is_turned_about_z(declared) {
        return Some(FoundEffect {
            law: Some(FoundLaw {
                acts_on: "wrench_sensor_reading".to_owned(),
                is: frame.formula(),
                units: std::collections::BTreeMap::default(),
            }),
            depends_on: vec!["pose".to_owned()],
            ..effect(UNLISTED, best.probability, Vec::new())
        });
    }
    // Which quarter turn it is does not tell how near.
    let free = Frame {
        turn: Turn::AboutZ,
        ..frame
    };
    let free = fit(&found.postures, free, &found.input.nominal)?;
    let [angle, low, high] = numbers(&found.postures, &free, &found.input.nominal).turn;
    let nominal = found.input.nominal.axes_turn;
    let estimate = Estimate {
        without: Some(-nominal[(1, 0)].atan2(nominal[(0, 0)])),
        ..Estimate::new(angle, low, high)
    };
    let about_z = found.candidates.iter();
    let about_z = about_z.filter(|c| c.fit.frame.is_turned_about_z(declared));
    let probability: f64 = about_z.map(|c| c.probability).sum();
    let numbers = vec![("angle_rad".to_owned(), estimate)];
    Some(effect("wrench_frame_turned", probability, numbers))
}

type Held = (Option<Bounded>, Interval);

/// An effect whose numbers are `reported`, where one that is looked at lies beyond its tolerance.
fn off(
    found: &Found<'_>,
    name: &str,
    looked_at: &[Held],
    reported: &[Held],
) -> Option<FoundEffect> {
    let errors = looked_at.iter().filter_map(|(bounds, [value, _, high])| {
        let error = (high - value) / NORMAL_95;
        Some(bounds.as_ref()?.beyond(*value) / error.max(1e-12))
    });
    let furthest = errors.fold(0.0, f64::max);
    if furthest < OFF {
        return None;
    }
    let chance = 2.0 * looked_at.len() as f64 * normal_share_below(-furthest);
    let keys = arm_effect(name).map_or(&[][..], |known| known.numbers);
    let numbers = keys.iter().zip(reported);
    let numbers = numbers.map(|(key, (bounds, [value, low, high]))| {
        let estimate = Estimate {
            without: bounds.map(|bounds| bounds.value),
            ..Estimate::new(*value, *low, *high)
        };
        ((*key).to_owned(), estimate)
    });
    let probability = found.best().probability * (1.0 - chance);
    Some(effect(name, probability, numbers.collect()))
}

fn effect(name: &str, probability: f64, numbers: Vec<(String, Estimate)>) -> FoundEffect {
    let estimates: Vec<Estimate> = numbers.iter().map(|(_, estimate)| *estimate).collect();
    // An interval of a component that spans a decade around 0 is no doubt of a vector that is off.
    let doubts = match estimates.len() {
        1 => doubts_of(&estimates),
        _ => Vec::new(),
    };
    FoundEffect {
        name: name.to_owned(),
        key: None,
        subsystem: arm_effect(name)
            .map_or("wrench_sensor", |known| known.subsystem)
            .to_owned(),
        confidence: stated(probability.clamp(0.0, SUREST), &doubts),
        doubts,
        parameters: numbers.into(),
        depends_on: Vec::new(),
        law: None,
        unlisted: None,
    }
}

/// Other axes that come near, the nearest first.
pub(super) fn alternatives(found: &Found<'_>) -> Vec<Alternative> {
    let own = found.best().probability;
    let declared = &found.input.nominal.frame;
    let others = found.candidates.iter().skip(1).map(|candidate| {
        let frame = &candidate.fit.frame;
        let effects = match (
            found.is_as_declared(frame),
            frame.is_turned_about_z(declared),
        ) {
            (true, _) => Vec::new(),
            (_, true) => vec!["wrench_frame_turned".to_owned()],
            _ => vec![UNLISTED.to_owned()],
        };
        Alternative {
            formula: Some(format!("readings {}", frame.words())),
            effects,
            odds: candidate.probability / own,
        }
    });
    others.filter(|a| a.odds > LEAST_ODDS).take(MOST).collect()
}

/// Every number of sensor and tool, declared or not.
pub(super) fn identified(found: &Found<'_>) -> Vec<IdentifiedNumber> {
    let own = &found.numbers;
    let mut all = vec![
        ("tool_weight_n".to_owned(), own.weight),
        ("tool_mass_kg".to_owned(), own.mass),
        ("weight_tilt_rad".to_owned(), own.tilt),
    ];
    let three = |stem: &str, unit: &str, intervals: [Interval; 3]| {
        let named = ["x", "y", "z"].into_iter().zip(intervals);
        named
            .map(|(axis, interval)| (format!("{stem}_{axis}_{unit}"), interval))
            .collect::<Vec<_>>()
    };
    all.extend(three("zero_force", "n", own.zero));
    if found.best().fit.has_torques {
        all.extend(three("zero_torque", "n_m", own.torque_zero));
        all.extend(three("tool_centre", "m", own.centre));
    }
    if found.best().fit.frame.turn != Turn::None {
        all.push(("axes_turn_rad".to_owned(), own.turn));
    }
    let number = |(key, [value, low, high]): (String, Interval)| IdentifiedNumber {
        key,
        found: Estimate::new(value, low, high),
    };
    all.into_iter().map(number).collect()
}

//! What is said of still postures: what the readings are, what to write into the controller, what is left.

use super::found::Found;
use super::frame::{Axes, axes_angles};
use super::model::{Model, residuals};
use crate::diagnosis::answer::FoundEffect;
use crate::diagnosis::answer::account::{Account, SectionKind};
use crate::diagnosis::answer::statements::TRUSTED;
use crate::diagnosis::answer::words::{display_name, with_interval};
use crate::diagnosis::difference::localise::root_mean_square;
use crate::effects::UNLISTED;
use crate::quantity::{capital, counted, listed, percent, significant};

/// Explanations beside the one given that are mentioned.
const RIVALS: usize = 3;
/// Probability below which another is not worth a sentence [1].
const LEAST: f64 = 1e-3;

/// The account; `models`: as declared, that within its tolerances, as found.
pub(super) fn account(found: &Found<'_>, effects: &[FoundEffect], models: &[Model; 3]) -> Account {
    let frame = found.best().fit.frame;
    let named = |effect: &FoundEffect| match effect.name.as_str() {
        UNLISTED => format!("the readings are {}", frame.words()),
        name => name.replace('_', " "),
    };
    let names: Vec<String> = effects.iter().map(named).collect();
    let mut account = Account {
        headline: match names.is_empty() {
            true => "nothing is missing: the sensor and its tool are as declared".to_owned(),
            false => format!("not as declared: {}", listed(&names)),
        },
        sections: Vec::new(),
    };
    let sentences = effects
        .iter()
        .map(|effect| of_effect(effect, &named(effect)));
    let mut missing: Vec<String> = sentences.collect();
    missing.push(identified(found));
    account.add(SectionKind::Missing, missing);
    account.add(SectionKind::Controller, controller(found, effects));
    account.add(SectionKind::Remaining, left(found, models));
    account.add(SectionKind::Ambiguous, ambiguous(found));
    let recordings = found.input.recordings.iter();
    let recordings =
        recordings.map(|r| format!("{}: {}.", r.name, counted(r.postures.len(), "posture")));
    let mut recordings: Vec<String> = recordings.collect();
    if !found.best().fit.has_torques {
        recordings.push("No torques were read, as a table has no columns of them (torque_x_n_m to torque_z_n_m; [columns] names others).".to_owned());
    }
    account.add(SectionKind::Recordings, recordings);
    account
}

fn of_effect(effect: &FoundEffect, name: &str) -> String {
    let numbers = effect.parameters.iter().map(|(key, e)| {
        let (words, unit, factor) = display_name(key);
        let [value, low, high] = [e.value, e.low, e.high].map(|v| v * factor);
        let declared = e.without.map_or(String::new(), |without| {
            format!(", declared {}", significant(without * factor, 3))
        });
        format!(
            "{words} {}{declared}",
            with_interval(value, [low, high], unit)
        )
    });
    let numbers: Vec<String> = numbers.collect();
    let numbers = match (effect.name.as_str(), numbers.is_empty()) {
        (UNLISTED, _) => format!(
            ": {} (P the pose as logged, P' its inverse{})",
            effect.meaning(),
            match effect
                .law
                .as_ref()
                .is_some_and(|law| law.is.starts_with('C'))
            {
                true => ", C the turn of the axes",
                false => "",
            }
        ),
        (_, true) => String::new(),
        (_, false) => format!(": {}", numbers.join("; ")),
    };
    let sure = match effect.confidence >= TRUSTED {
        true => "",
        false => ", as likely as not at best",
    };
    let confidence = percent(effect.confidence);
    format!(
        "{}{numbers}. Probability {confidence}{sure}.",
        capital(name)
    )
}

/// Weight and tilt, whatever is declared.
fn identified(found: &Found<'_>) -> String {
    let own = &found.numbers;
    let shown = |[value, low, high]: [f64; 3], unit: &str| with_interval(value, [low, high], unit);
    format!(
        "The tool beyond the sensor weighs {}, and its weight lies {} from gravity as the file has it; 95 % intervals.",
        shown(own.weight, "N"),
        shown(own.tilt.map(f64::to_degrees), "degrees")
    )
}

/// What to write into the controller.
fn controller(found: &Found<'_>, effects: &[FoundEffect]) -> Vec<String> {
    let own = &found.numbers;
    let fit = &found.best().fit;
    let row = |values: [[f64; 3]; 3], digits: usize| {
        let values = values.map(|[value, ..]| format!("{value:.digits$}"));
        format!("[{}]", values.join(", "))
    };
    let mass = own.mass[0];
    let mut all = vec![match fit.has_torques {
        true => format!(
            "The tool beyond the sensor: set_payload({mass:.3}, {}), in kg and in m from the sensor's origin along the axes of its link; add where that origin lies from the flange, and what hangs before the sensor.",
            row(own.centre, 4)
        ),
        false => format!(
            "The mass of the tool beyond the sensor: {mass:.3} kg. Without torques its centre, which set_payload asks for, is not known."
        ),
    }];
    let torques = match fit.has_torques {
        true => format!(" and {} N m", row(own.torque_zero, 4)),
        false => String::new(),
    };
    all.push(format!(
        "The sensor's zero, to be taken off its readings in its own axes: {} N{torques}.",
        row(own.zero, 3)
    ));
    let angles = axes_angles(fit.turn);
    if angles.iter().any(|angle| angle.abs() > 1e-6) {
        let [roll, pitch, yaw] = angles.map(f64::to_degrees);
        let of = match fit.frame.axes {
            Axes::Sensor => "sensor's link",
            Axes::Base => "base",
        };
        all.push(format!(
            "The axes of the readings against the {of}'s: roll {roll:.2}, pitch {pitch:.2}, yaw {yaw:.2} degrees."
        ));
    }
    if fit.frame.axes == Axes::Base {
        all.push("The readings are turned by the pose already, zero and all: a controller takes them as a wrench in the base's axes, and the zero is taken off after they have been turned back.".to_owned());
    }
    if fit.frame.inverse {
        all.push(
            "The pose in the log turns the base's axes into the sensor's: invert it.".to_owned(),
        );
    }
    if fit.frame.opposite {
        all.push(
            "The readings are what the sensor does to the tool: change their sign.".to_owned(),
        );
    }
    if effects.iter().any(|effect| effect.name == "base_tilt") {
        let down = fit.weight().normalize() * found.input.nominal.gravity.norm();
        all.push(format!(
            "Gravity in the base's axes: [{:.3}, {:.3}, {:.3}] m/s2 (set_gravity takes its opposite).",
            down.x, down.y, down.z
        ));
    }
    all
}

/// What is left, as declared and as found.
fn left(found: &Found<'_>, models: &[Model; 3]) -> Vec<String> {
    let of = |model: &Model, kind: usize| {
        let left = residuals(&found.postures, model);
        let of_kind = left[3 * kind..3 * kind + 3].iter().flatten().copied();
        significant(root_mean_square(of_kind).unwrap_or(0.0), 3)
    };
    let kinds = [("forces", "N"), ("torques", "N m")];
    let count = if found.best().fit.has_torques { 2 } else { 1 };
    let mut all: Vec<String> = (kinds.into_iter().enumerate().take(count))
        .map(|(kind, (words, unit))| {
            format!(
                "Of the {words} {} {unit} RMS a component are left; as declared it is {} {unit}.",
                of(&models[2], kind),
                of(&models[0], kind)
            )
        })
        .collect();
    if found.input.nominal.noise[0] == 0.0 {
        all.push("The sensor's noise is not declared (`wrench_force_n` in [sensors]): what is left of forces or torques stands for it in multiples of it, and whether that is more than noise is not known.".to_owned());
    }
    all
}

/// Other axes that come near, and what tells them apart.
fn ambiguous(found: &Found<'_>) -> Vec<String> {
    let others = found.candidates.iter().skip(1).take(RIVALS);
    let others = others.filter(|other| other.probability > LEAST);
    let mut all: Vec<String> = others
        .map(|other| {
            format!(
                "Readings {} would do as well or nearly, with a probability of {}.",
                other.fit.frame.words(),
                percent(other.probability)
            )
        })
        .collect();
    if all.is_empty()
        && let Some(next) = found.candidates.get(1)
    {
        all.push(format!(
            "Next best are readings {}, with a probability below {} and {} N RMS left of the forces.",
            next.fit.frame.words(),
            percent(LEAST),
            significant(next.fit.rms[0], 3)
        ));
    }
    let fit = &found.best().fit;
    if !fit.has_torques && (fit.frame.axes == Axes::Base) != fit.frame.inverse {
        let swapped = fit.numbers[0].angle(&found.input.nominal.gravity);
        all.push(format!(
            "Forces alone do not tell readings in the base's axes from a pose that is the inverse of what it says: zero and weight change places. Torques would; without them it rests on the weight, which lies {} degrees from gravity here and would lie {} degrees from it otherwise.",
            significant(found.numbers.tilt[0].to_degrees(), 2),
            significant(opposite_or(swapped).to_degrees(), 2)
        ));
    }
    all
}

/// Angle to the nearer of a direction and its opposite.
fn opposite_or(angle: f64) -> f64 {
    angle.min(std::f64::consts::PI - angle)
}

//! What is said of a recorded arm: what is missing, what to write into its controller, what is left.

use super::drives::{DriveNumbers, sentences};
use super::effect::ArmEffect;
use super::input::ArmInput;
use super::search::Found;
use crate::diagnosis::answer::account::{Account, SectionKind};
use crate::diagnosis::answer::statements::TRUSTED;
use crate::diagnosis::answer::words::{display_name, with_interval_in_si};
use crate::diagnosis::answer::{Alternative, FoundEffect};
use crate::quantity::{capital, listed, percent, significant};

/// What a channel leaves, over its noise, from which more than noise is left [1].
const LEFT: f64 = 1.3;

/// The account.
#[must_use]
pub fn account(
    input: &ArmInput,
    found: &Found,
    effects: &[FoundEffect],
    alternatives: &[Alternative],
    (touching, drives): (&[bool], &[DriveNumbers]),
) -> Account {
    let named: Vec<String> = effects
        .iter()
        .map(|e| format!("{}{}", e.name.replace('_', " "), e.parameters.place_words()))
        .collect();
    let left = left(input, found);
    let headline = match (named.is_empty(), left.is_empty()) {
        (false, _) => format!("missing: {}", listed(&named)),
        (true, true) => "nothing is missing".to_owned(),
        (true, false) => "no effect is found missing, and more than noise is left".to_owned(),
    };
    let mut account = Account {
        headline,
        sections: Vec::new(),
    };
    account.add(
        SectionKind::Missing,
        effects.iter().map(of_effect).collect(),
    );
    account.add(SectionKind::Controller, controller(found, effects));
    account.add(SectionKind::Arm, sentences(drives));
    account.add(SectionKind::Remaining, left);
    let rivals = alternatives.iter().take(4).map(|rival| {
        format!(
            "{} would explain the recordings at odds of {} against the one given.",
            capital(&listed(&rival.effects).replace('_', " ")),
            significant(rival.odds, 2)
        )
    });
    account.add(SectionKind::Ambiguous, rivals.collect());
    let contact = (input.recordings.iter().zip(touching))
        .filter(|(_, touching)| **touching)
        .map(|(recording, _)| {
            format!(
                "{}: the tool touches something there; it was not fitted to.",
                recording.name
            )
        });
    account.add(SectionKind::Recordings, contact.collect());
    account
}

/// An effect with its numbers.
fn of_effect(effect: &FoundEffect) -> String {
    let numbers: Vec<String> = effect
        .parameters
        .iter()
        .map(|(key, e)| {
            let (words, unit, factor) = display_name(key);
            let of = |v: f64| v * factor;
            format!(
                "{words} {}",
                with_interval_in_si(of(e.value), [of(e.low), of(e.high)], unit)
            )
        })
        .collect();
    let law = match &effect.law {
        Some(_) => {
            " (SI; q angle, v speed, a acceleration, t_g torque carried, t time, z share of the friction reached)"
        }
        None => "",
    };
    let numbers = match numbers.is_empty() {
        true => String::new(),
        false => format!(": {}", numbers.join(", ")),
    };
    let sure = match effect.confidence >= TRUSTED {
        true => "",
        false => ", as likely as not at best",
    };
    format!(
        "{}{numbers}{law}. Probability {}{sure}.",
        capital(&effect.meaning()),
        percent(effect.confidence)
    )
}

/// What to write into the controller.
fn controller(found: &Found, effects: &[FoundEffect]) -> Vec<String> {
    let has = |name: &str| effects.iter().any(|effect| effect.name == name);
    let arm = &found.best.fit.arm;
    let mut all = Vec::new();
    let carries = [has("payload"), has("tool_weight_error")];
    if carries.contains(&true) {
        let mut mass = arm.load.mass + arm.payload.mass;
        let mut moment = arm.load.moment + arm.payload.moment;
        if let Some(wrench) = &arm.wrench {
            mass += wrench.tool_mass;
            let centre = wrench.tool_centre + glam::DVec3::Z * wrench.height;
            moment += wrench.tool_mass * centre;
        }
        let centre = moment / mass;
        all.push(format!(
            "All that the flange carries, as a controller takes it: set_payload({mass:.3}, [{:.4}, {:.4}, {:.4}]) in kg and m from the flange.",
            centre.x, centre.y, centre.z
        ));
    }
    if let Some(wrench) = &arm.wrench {
        if has("tool_weight_error") {
            let c = wrench.tool_centre;
            all.push(format!(
                "The tool beyond the wrench sensor: {:.3} kg, centre [{:.4}, {:.4}, {:.4}] m from its origin in the flange's axes.",
                wrench.tool_mass, c.x, c.y, c.z
            ));
        }
        if has("wrench_zero") {
            let zero: Vec<String> = wrench.zero.iter().map(|z| format!("{z:.3}")).collect();
            all.push(format!(
                "The sensor's zero: [{}] N and N m.",
                zero.join(", ")
            ));
        }
        if has("wrench_frame_turned") {
            all.push(format!(
                "The sensor's axes stand at {:.2} degrees about the flange's z.",
                wrench.rotation.to_degrees()
            ));
        }
    }
    if has("base_tilt") {
        let [roll, pitch] = arm.tilt.map(f64::to_degrees);
        all.push(format!(
            "The base stands at a roll of {roll:.2} and a pitch of {pitch:.2} degrees."
        ));
    }
    let encoders = found
        .best
        .names()
        .into_iter()
        .filter_map(|effect| match effect {
            ArmEffect::EncoderOffset(joint) => Some(joint),
            _ => None,
        });
    for joint in encoders {
        all.push(format!(
            "{} reads {:.4} degrees too much.",
            arm.chain.joints[joint].name,
            arm.drives[joint].encoder_offset.to_degrees()
        ));
    }
    all
}

/// Channels of which more than noise is left.
fn left(input: &ArmInput, found: &Found) -> Vec<String> {
    let channels = input.columns.iter().zip(&found.scales);
    let more = channels.filter(|(_, scale)| **scale > LEFT);
    more.map(|(column, scale)| {
        format!(
            "{column} is left at {} times its noise (RMS over what was fitted).",
            significant(*scale, 2)
        )
    })
    .collect()
}

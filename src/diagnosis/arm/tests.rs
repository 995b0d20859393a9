//! Arms whose friction is another law than the model's: what is planted in them is found, and in one without a fault nothing.

use super::answer::effects;
use super::contact::touching;
use super::diagnosed::diagnose;
use super::drives::{DriveNumber, drives_text};
use super::effect::{ArmEffect, candidates};
use super::evidence::Evidence;
use super::fit::Columns;
use super::held::held_pushes;
use super::input::{ArmInput, ArmRecording};
use super::search::search;
use crate::arm::test_chains::random_chain;
use crate::diagnosis::answer::doubt::Doubt;
use crate::diagnosis::answer::{Answer, Verdict};
use crate::recorded_arm::motion::Motion;
use crate::recorded_arm::outside::OutsideError;
use crate::recorded_arm::simulate::{Channel, RigidCourse, all_bristles, readings};
use crate::recorded_arm::{ArmParameters, Drive, PointMass, Quantity, Tolerated};
use glam::DVec3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

const JOINTS: usize = 3;
const COULOMB: f64 = 3.0;
const VISCOUS: f64 = 5.0;
const NOISE: f64 = 0.03;

fn nominal() -> ArmParameters {
    let mut chain = random_chain(4, JOINTS);
    for joint in &mut chain.joints {
        joint.velocity = 2.0;
    }
    let drive = Drive {
        inverse_gain: 0.1,
        logs_current: true,
        motor_inertia: 1.0,
        coulomb: COULOMB,
        viscous: VISCOUS,
        ..Drive::default()
    };
    ArmParameters {
        chain,
        gravity: DVec3::new(0.0, 0.0, -9.81),
        tilt: [0.0; 2],
        drives: vec![drive; JOINTS],
        load: PointMass::default(),
        payload: PointMass::default(),
        wrench: None,
        delay: 0.0,
        pushes: Vec::new(),
        laws: Vec::new(),
        outside_error: OutsideError::default(),
    }
}

fn motion(recording: usize, held: bool) -> Motion {
    let time: Vec<f64> = (0..2000).map(|i| 0.01 * f64::from(i)).collect();
    let course = |joint: usize, t: f64| {
        if held {
            return 0.3 * joint as f64 - 0.2;
        }
        let rate = 0.7 + 0.23 * joint as f64 + 0.31 * recording as f64;
        0.8 * (rate * t).sin() + 0.3 * (2.3 * rate * t + joint as f64).cos()
    };
    let positions: Vec<Vec<f64>> = (0..JOINTS)
        .map(|joint| time.iter().map(|t| course(joint, *t)).collect())
        .collect();
    Motion::of_positions(recording, &time, &positions, 25.0)
}

/// Currents of an arm whose dry friction is a hyperbolic tangent of the speed.
fn recorded(truth: &ArmParameters, motion: Motion, random: &mut ChaCha8Rng) -> ArmRecording {
    let mut smooth = truth.clone();
    smooth
        .drives
        .iter_mut()
        .for_each(|drive| drive.coulomb = 0.0);
    let channels: Vec<Channel> = (0..JOINTS).map(Channel::Drive).collect();
    let rigid = RigidCourse::of(&smooth, &motion);
    let mut currents = readings(
        &smooth,
        &motion,
        &channels,
        &all_bristles(&smooth, &motion),
        &rigid,
    );
    for (joint, own) in currents.iter_mut().enumerate() {
        let drive = &truth.drives[joint];
        for (current, speed) in own.iter_mut().zip(&motion.speed[joint]) {
            let noise: f64 = random.sample(StandardNormal);
            let friction = drive.coulomb * (speed / 2e-3).tanh();
            *current += drive.inverse_gain * friction + NOISE * noise;
        }
    }
    ArmRecording {
        name: format!("recording_{}", motion.recording),
        motion,
        readings: currents,
    }
}

fn input(truth: &ArmParameters, held: bool) -> ArmInput {
    let nominal = nominal();
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let within = |quantity: Quantity, share: f64| {
        let value = quantity.value(&nominal);
        Tolerated {
            quantity,
            bounds: [value * (1.0 - share), value * (1.0 + share)],
        }
    };
    let tolerated = (0..JOINTS).flat_map(|joint| {
        [
            within(Quantity::InverseGain(joint), 0.1),
            within(Quantity::MotorInertia(joint), 0.3),
            within(Quantity::Coulomb(joint), 0.3),
            within(Quantity::Viscous(joint), 0.3),
        ]
    });
    let held = held.then_some(2);
    let recordings = (0..2).chain(held);
    ArmInput {
        links: (1..=JOINTS).map(|i| format!("link_{i}")).collect(),
        numbers: (1..=JOINTS).collect(),
        tolerated: tolerated.collect(),
        channels: (0..JOINTS).map(Channel::Drive).collect(),
        columns: (1..=JOINTS)
            .map(|i| format!("joint_{i}_current_a"))
            .collect(),
        noise: vec![NOISE; JOINTS],
        recordings: recordings
            .map(|r| recorded(truth, motion(r, r == 2), &mut random))
            .collect(),
        nominal,
    }
}

fn answer(plant: impl Fn(&mut ArmParameters)) -> Answer {
    let mut truth = nominal();
    // Within their tolerances.
    truth.drives[0].inverse_gain *= 1.06;
    truth.drives[1].coulomb *= 0.8;
    truth.drives[2].motor_inertia *= 1.2;
    plant(&mut truth);
    diagnose(&input(&truth, false), &mut |_| {}).answer
}

#[test]
fn an_arm_within_its_tolerances_lacks_nothing() {
    let answer = answer(|_| {});
    assert_eq!(
        answer.verdict,
        Verdict::NothingMissing,
        "{:?}",
        answer.effects
    );
    assert!(answer.mismatch.is_empty());
}

#[test]
fn the_table_of_drives_holds_the_truth_and_knows_friction_better_in_amperes() {
    let mut truth = nominal();
    truth.drives[0].inverse_gain *= 1.06;
    truth.drives[1].coulomb *= 0.8;
    let drives = diagnose(&input(&truth, false), &mut |_| {}).drives;
    for (found, own) in drives.iter().zip(&truth.drives) {
        let gain = 1.0 / own.inverse_gain;
        let [dry, viscous, inertia] = found.mechanical;
        let [amperes, _, per_ampere] = found.electrical.unwrap();
        let pairs = [
            (dry, own.coulomb),
            (viscous, own.viscous),
            (inertia, own.motor_inertia),
            (amperes, own.coulomb / gain),
            (per_ampere, gain),
        ];
        for (number, truth) in pairs {
            let [low, high] = number.interval.unwrap();
            assert!(low <= truth && truth <= high, "{number:?} {truth}");
        }
        let share = |number: DriveNumber| {
            let [low, high] = number.interval.unwrap();
            (high - low) / number.value
        };
        assert!(share(amperes) <= share(dry));
        // What rubs is a straight line here, so that its dry part is the friction's own.
        let line = found.dry_of_line.unwrap();
        assert!((line - own.coulomb).abs() < 0.05 * own.coulomb, "{line}");
        assert_eq!(found.effort, 100.0);
    }
    let text = drives_text(&drives);
    let counts = text.lines().map(|line| line.split(',').count());
    assert!(counts.clone().all(|count| count == 26), "{text}");
    assert_eq!(counts.count(), 1 + JOINTS);
}

#[test]
fn a_payload_is_named_with_its_mass_and_centre() {
    let planted = PointMass {
        mass: 2.0,
        moment: 2.0 * DVec3::new(0.05, -0.03, 0.08),
    };
    let answer = answer(|arm| arm.payload = planted);
    let names: Vec<&str> = answer.effects.iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, ["payload"]);
    let mass = answer.effects[0].parameters[0].1;
    assert!(mass.low <= 2.0 && 2.0 <= mass.high, "{mass:?}");
    assert!((mass.value - 2.0).abs() < 0.3, "{mass:?}");
    assert!(!answer.mismatch.is_empty());
}

#[test]
fn a_gear_s_ripple_is_named_with_its_cycles() {
    let answer = answer(|arm| {
        arm.drives[1].ripple = [1.5, 1.0];
        arm.drives[1].ripple_cycles = 21.0;
    });
    let names: Vec<&str> = answer.effects.iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, ["gear_ripple"]);
    let number = |i: usize| answer.effects[0].parameters[i].1.value;
    assert!((number(0) / 1.5f64.hypot(1.0) - 1.0).abs() < 0.05);
    assert!((number(1) - 21.0).abs() < 0.1);
    assert_eq!(answer.effects[0].parameters.place_words(), " (joint 2)");
}

#[test]
fn a_push_on_an_arm_that_holds_still_is_found_when_it_was() {
    let mut truth = nominal();
    let mut input = input(&truth, true);
    assert!(touching(&input).iter().all(|touches| !touches));
    assert_eq!(held_pushes(&input, &truth), []);
    // A force of 60 N for two seconds, by the levers of the flange.
    let own = &mut input.recordings[2];
    let lever = super::pushed::levers(&truth, &own.motion, 0);
    for (joint, currents) in own.readings.iter_mut().enumerate() {
        for (current, time) in currents.iter_mut().zip(&own.motion.time) {
            if (6.0..8.0).contains(time) {
                *current -= 0.1 * lever[joint].dot(DVec3::new(0.0, 60.0, 0.0));
            }
        }
    }
    truth.drives[0].offset = 0.0;
    let found = held_pushes(&input, &truth);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!((found[0].start - 6.0).abs() < 0.15 && (found[0].end - 8.0).abs() < 0.15);
    assert_eq!(found[0].recording, 2);
}

/// Bodies that are exchanged along known links carry what the whole recursion gives, link by link and with another load.
#[test]
fn exchanged_bodies_are_carried_as_a_whole_recursion_says() {
    let (arm, motion) = (nominal(), motion(0, false));
    let known = RigidCourse::of(&arm, &motion);
    let mut other = arm.clone();
    Quantity::LinkMass(0).set(&mut other, 7.0);
    Quantity::LinkCentre(1, 2).set(&mut other, 0.13);
    Quantity::PayloadMass.set(&mut other, 2.5);
    Quantity::PayloadMoment(0).set(&mut other, 0.4);
    assert!(arm.moves_as(&other) && !arm.is_rigidly_as(&other));
    let (found, expected) = (
        known.with_bodies_of(&other),
        RigidCourse::of(&other, &motion),
    );
    for (joint, (found, expected)) in found.carried.iter().zip(&expected.carried).enumerate() {
        for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
            assert!(
                (found - expected).abs() < 1e-9,
                "joint {joint}, sample {i}: {found}, {expected}"
            );
        }
    }
    Quantity::EncoderOffset(1).set(&mut other, 0.01);
    assert!(!arm.moves_as(&other));
}

/// A spring where nothing pulls has an interval that holds no stiffness at all: it is doubted, and not stated as likely.
#[test]
fn an_effect_whose_interval_holds_what_is_declared_is_doubted() {
    let input = input(&nominal(), false);
    let evidence = Evidence::of(&input, &[]);
    let mut found = search(&evidence, &mut |_| {});
    assert!(found.best.effects.is_empty());
    let all = candidates(&input);
    let spring = all.iter().find(|c| c.effect == ArmEffect::DressPack(1));
    let spring = spring.expect("among the candidates");
    let columns = &mut Columns::default();
    found.best = found.best.with(&evidence, spring, &found.scales, columns);
    let reported = effects(&input, &found);
    assert_eq!(reported.len(), 1);
    assert!(
        reported[0].doubts.contains(&Doubt::HoldsNeutral),
        "{:?}",
        reported[0]
    );
    assert!(reported[0].confidence < 0.5);
}

/// Links that are nowhere near what the description tolerates are no payload, no leaning base and no hose: a real arm's free path was given a load of 0.9 kg.
#[test]
fn links_beyond_their_tolerances_are_not_stated_as_a_load() {
    let mut truth = nominal();
    for link in 0..JOINTS {
        for axis in 0..3 {
            let quantity = Quantity::LinkCentre(link, axis);
            let sign = if (link + axis) % 2 == 0 { 1.0 } else { -1.0 };
            quantity.set(&mut truth, quantity.value(&nominal()) + 0.02 * sign);
        }
    }
    let mut input = input(&truth, false);
    let centres = (0..JOINTS).flat_map(|link| (0..3).map(move |axis| (link, axis)));
    input.tolerated.extend(centres.map(|(link, axis)| {
        let quantity = Quantity::LinkCentre(link, axis);
        let value = quantity.value(&input.nominal);
        Tolerated {
            quantity,
            bounds: [value - 0.002, value + 0.002],
        }
    }));
    let answer = diagnose(&input, &mut |_| {}).answer;
    let as_links = [
        "payload",
        "link_mass_error",
        "base_tilt",
        "dress_pack_spring",
    ];
    let effects = answer.effects.iter();
    let all: Vec<_> = effects
        .filter(|effect| as_links.contains(&effect.name.as_str()))
        .collect();
    assert!(!all.is_empty(), "nothing stands for the links: {answer:?}");
    for effect in all {
        assert!(effect.confidence < 0.5, "{effect:?}");
    }
}

/// A joint that goes to and fro at one speed turns within a sample, which a low-pass of its positions smears: spikes of inertia were called laws without a name,
/// at 0.97 in seven of eighty arms with a rail or a gantry.
#[test]
fn jumps_of_a_speed_are_not_called_physics() {
    const SPEED: f64 = 0.4;
    const TURN: f64 = 1.6;
    let mut truth = nominal();
    truth.drives[0].motor_inertia = 30.0;
    let mut input = input(&truth, false);
    input.nominal.drives[0].motor_inertia = 30.0;
    for tolerated in &mut input.tolerated {
        if tolerated.quantity == Quantity::MotorInertia(0) {
            tolerated.bounds = [21.0, 39.0];
        }
    }
    let mut random = ChaCha8Rng::seed_from_u64(12);
    for (recording, own) in input.recordings.iter_mut().enumerate() {
        let mut exact = motion(recording, false);
        let phase = |t: f64| (t / TURN + 0.13 + 0.2 * recording as f64) % 1.0;
        let course = |t: f64| SPEED * TURN * ((phase(t) - 0.5).abs() - 0.25);
        exact.position[0] = exact.time.iter().map(|t| course(*t)).collect();
        let speed = |t: &f64| if phase(*t) < 0.5 { -SPEED } else { SPEED };
        exact.speed[0] = exact.time.iter().map(speed).collect();
        exact.acceleration[0].fill(0.0);
        let measured = Motion::of_positions(recording, &exact.time, &exact.position, 25.0);
        *own = recorded(&truth, exact, &mut random);
        own.motion = measured;
    }
    let answer = diagnose(&input, &mut |_| {}).answer;
    assert!(answer.effects.is_empty(), "{:?}", answer.effects);
}

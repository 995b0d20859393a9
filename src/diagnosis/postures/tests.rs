use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use super::diagnosed::diagnose;
use super::estimate::numbers;
use super::found::PosturesInput;
use super::frame::{Axes, Frame, Turn};
use super::nominal::{Bounded, Declared, Nominal};
use super::select::candidates;
use super::{Posture, StillRecording, least_turn};
use crate::diagnosis::answer::statements::contradictions;
use crate::diagnosis::answer::{Answer, Verdict};

/// Of a base that stands and a sensor whose readings are in its own axes.
fn nominal() -> Nominal {
    Nominal {
        frame: Frame::PLAIN,
        axes_turn: Matrix3::identity(),
        gravity: Vector3::new(0.0, 0.0, -9.81),
        tilt: 0.035,
        turn: 0.035,
        noise: [0.0; 2],
        declared: Declared::default(),
    }
}
const ZERO: Vector3<f64> = Vector3::new(-3.0, 5.0, -14.0);
const TORQUE_ZERO: Vector3<f64> = Vector3::new(0.02, -0.06, 0.01);
const CENTRE: Vector3<f64> = Vector3::new(0.004, -0.002, 0.05);
const WEIGHT: f64 = 12.0;

/// Numbers between 0 and 1 by a shift register.
fn uniform(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Still postures whose readings are given in axes turned by an angle about z, or in the base's, by a pose that may be the inverse, with either sign. Written
/// in components of the world, not as the fit has it.
fn planted(seed: u64, axes: Axes, turn: f64, inverse: bool, sign: f64) -> Vec<Posture> {
    let mut uniform = uniform(seed);
    (0..20)
        .map(|_| {
            let mut normal = || (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
            let q = Quaternion::new(normal(), normal(), normal(), normal());
            let pose = UnitQuaternion::from_quaternion(q);
            let down = pose.inverse_transform_vector(&Vector3::new(0.0, 0.0, -WEIGHT));
            let mounted = Rotation3::from_euler_angles(0.0, 0.0, turn);
            let felt = |own: Vector3<f64>, zero: Vector3<f64>| {
                let read = mounted.inverse() * own * sign + zero;
                if axes == Axes::Base {
                    pose * read
                } else {
                    read
                }
            };
            let mut noise = |size: f64| Vector3::new(normal(), normal(), normal()) * size;
            let logged = if inverse { pose.inverse() } else { pose };
            Posture {
                base_from_sensor: logged.to_rotation_matrix().into_inner(),
                force: felt(down, ZERO) + noise(0.2),
                torque: Some(felt(CENTRE.cross(&down), TORQUE_ZERO) + noise(0.002)),
            }
        })
        .collect()
}

#[test]
fn each_frame_is_distinguished_from_all_others() {
    let of = |axes, inverse, opposite| Frame {
        axes,
        inverse,
        opposite,
        turn: Turn::None,
    };
    for axes in [Axes::Sensor, Axes::Base] {
        for inverse in [false, true] {
            for opposite in [false, true] {
                let sign = if opposite { -1.0 } else { 1.0 };
                for seed in 1..4 {
                    let postures = planted(seed, axes, 0.0, inverse, sign);
                    let best = &candidates(&postures, &nominal())[0];
                    assert_eq!(best.fit.frame, of(axes, inverse, opposite), "seed {seed}");
                    assert!(best.probability > 0.9, "{}", best.probability);
                }
            }
        }
    }
}

#[test]
fn turned_axes_are_found_with_their_angle() {
    for angle in [-0.5, 0.2, 1.0, std::f64::consts::FRAC_PI_2] {
        let postures = planted(5, Axes::Sensor, angle, false, 1.0);
        let best = &candidates(&postures, &nominal())[0];
        assert!(
            best.fit.frame.is_turned_about_z(&Frame::PLAIN),
            "{angle}: {:?}",
            best.fit.frame
        );
        if best.fit.frame.turn == Turn::AboutZ {
            let [turn, low, high] = numbers(&postures, &best.fit, &nominal()).turn;
            assert!(
                low < angle && angle < high && high - low < 0.1,
                "{angle}: {turn}"
            );
        }
    }
}

#[test]
fn intervals_hold_what_was_planted() {
    let (mut held, mut all) = (0, 0_u32);
    for seed in 1..=40 {
        let postures = planted(seed, Axes::Base, 0.0, false, 1.0);
        let best = &candidates(&postures[..10], &nominal())[0];
        let found = numbers(&postures[..10], &best.fit, &nominal());
        let mut check = |[_, low, high]: [f64; 3], truth: f64| {
            all += 1;
            held += u32::from(low <= truth && truth <= high);
        };
        check(found.weight, WEIGHT);
        for i in 0..3 {
            check(found.zero[i], ZERO[i]);
            check(found.torque_zero[i], TORQUE_ZERO[i]);
            check(found.centre[i], CENTRE[i]);
        }
    }
    let share = f64::from(held) / f64::from(all);
    assert!((0.92..=0.995).contains(&share), "{share}");
}

#[test]
fn postures_about_one_axis_do_not_turn_the_sensor_enough() {
    let about_z = |i: usize| {
        let mut posture = planted(1, Axes::Sensor, 0.0, false, 1.0)[0];
        posture.base_from_sensor = Rotation3::from_euler_angles(0.0, 0.0, i as f64).into_inner();
        posture
    };
    let postures: Vec<Posture> = (0..8).map(about_z).collect();
    assert!(least_turn(&postures) < 1e-6);
    assert!(least_turn(&planted(1, Axes::Sensor, 0.0, false, 1.0)) > 0.5);
}

fn answer(postures: Vec<Posture>, nominal: &Nominal) -> Answer {
    let name = "stills.csv".to_owned();
    let recordings = vec![StillRecording { name, postures }];
    let found = diagnose(&PosturesInput {
        nominal: *nominal,
        recordings,
    });
    let answer = found.unwrap().answer;
    assert_eq!(contradictions(&answer), [""; 0]);
    answer.text().unwrap();
    answer
}

fn names(answer: &Answer) -> Vec<&str> {
    answer.effects.iter().map(|e| e.name.as_str()).collect()
}

fn bounded(value: f64, half: f64) -> Bounded {
    Bounded {
        value,
        low: value - half,
        high: value + half,
    }
}

/// All declared, each number within half its tolerance.
fn declared() -> Nominal {
    let three = |of: Vector3<f64>, half: f64| {
        let off = |axis: usize| bounded(of[axis] + 0.5 * half, half);
        Some(std::array::from_fn(off))
    };
    Nominal {
        noise: [0.2, 0.002],
        declared: Declared {
            mass: Some(bounded(1.01 * WEIGHT / 9.81, 0.02)),
            centre: three(CENTRE, 0.004),
            zero: three(ZERO, 0.5),
            torque_zero: three(TORQUE_ZERO, 0.02),
        },
        ..nominal()
    }
}

#[test]
fn where_nothing_is_wrong_nothing_is_missing() {
    for seed in 1..=40 {
        for nominal in [&nominal(), &declared()] {
            let answer = answer(planted(seed, Axes::Sensor, 0.0, false, 1.0), nominal);
            assert_eq!(names(&answer), [""; 0], "seed {seed}");
            assert_eq!(answer.verdict, Verdict::NothingMissing);
        }
    }
}

#[test]
fn what_is_not_as_declared_is_named_with_its_numbers() {
    let mut off = declared();
    off.declared.mass = Some(bounded(1.0, 0.05));
    off.declared.zero = Some([bounded(0.0, 0.5); 3]);
    let found = answer(planted(3, Axes::Sensor, 0.3, false, 1.0), &off);
    let expected = ["wrench_frame_turned", "wrench_zero", "tool_weight_error"];
    assert_eq!(names(&found), expected);
    let effects = found.effects.iter();
    let numbers = effects.flat_map(|effect| effect.parameters.iter());
    let number = |key: &str| numbers.clone().find(|(own, _)| own == key).unwrap().1;
    for (key, truth) in [
        ("angle_rad", 0.3),
        ("force_x_n", ZERO.x),
        ("torque_y_n_m", TORQUE_ZERO.y),
        ("mass_kg", WEIGHT / 9.81),
        ("centre_z_m", CENTRE.z),
    ] {
        let found = number(key);
        assert!(
            found.low <= truth && truth <= found.high,
            "{key}: {found:?}"
        );
    }
    // Nothing is stated above 98 %.
    assert!(found.effects.iter().all(|effect| effect.confidence <= 0.98));
}

#[test]
fn a_declared_frame_is_no_finding_and_another_is() {
    let in_base = Nominal {
        frame: Frame {
            axes: Axes::Base,
            ..Frame::PLAIN
        },
        ..nominal()
    };
    let turned = Nominal {
        axes_turn: Rotation3::from_euler_angles(0.0, 0.0, -0.8).into_inner(),
        ..nominal()
    };
    let of = |axes, turn, nominal: &Nominal| answer(planted(2, axes, turn, false, 1.0), nominal);
    assert_eq!(names(&of(Axes::Base, 0.0, &in_base)), [""; 0]);
    assert_eq!(names(&of(Axes::Sensor, 0.8, &turned)), [""; 0]);
    assert_eq!(names(&of(Axes::Sensor, 0.0, &in_base)), ["unlisted"]);
    assert_eq!(names(&of(Axes::Base, 0.0, &nominal())), ["unlisted"]);
    assert_eq!(
        names(&of(Axes::Sensor, 0.0, &turned)),
        ["wrench_frame_turned"]
    );
}

#[test]
fn without_torques_what_rests_on_the_tilt_alone_is_said() {
    let forces = |axes| {
        let mut postures = planted(4, axes, 0.0, false, 1.0);
        for posture in &mut postures {
            posture.torque = None;
        }
        answer(postures, &nominal())
    };
    let found = forces(Axes::Base);
    assert_eq!(names(&found), ["unlisted"]);
    let words = serde_json::to_string(&found.details.account).unwrap();
    assert!(words.contains("zero and weight change places"), "{words}");
    let keys: Vec<&str> = (found.details.identified.iter())
        .map(|n| n.key.as_str())
        .collect();
    assert!(keys.contains(&"tool_mass_kg") && !keys.contains(&"tool_centre_x_m"));
    assert_eq!(names(&forces(Axes::Sensor)), [""; 0]);
}

#[test]
fn a_base_that_leans_is_named_with_roll_and_pitch() {
    // A base that rolls and pitches has gravity turned the other way.
    let leaning = Rotation3::from_euler_angles(0.2, -0.1, 0.0).inverse();
    let mut postures = planted(6, Axes::Sensor, 0.0, false, 1.0);
    for posture in &mut postures {
        posture.base_from_sensor = leaning * posture.base_from_sensor;
    }
    let found = answer(postures, &nominal());
    assert_eq!(names(&found), ["base_tilt"]);
    let numbers = &found.effects[0].parameters;
    for ((_, number), truth) in numbers.iter().zip([0.2, -0.1]) {
        assert!(number.low <= truth && truth <= number.high, "{number:?}");
        assert!(number.high - number.low < 0.05, "{number:?}");
    }
}

use nalgebra::{Quaternion, Rotation3, UnitQuaternion, Vector3};

use super::estimate::numbers;
use super::frame::{Axes, Frame, Turn};
use super::select::{Belief, candidates};
use super::{Posture, least_turn};

const BELIEF: Belief = Belief {
    gravity: Vector3::new(0.0, 0.0, -9.81),
    tilt: 0.035,
    turn: 0.035,
    noise: [0.0; 2],
};
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
                torque: felt(CENTRE.cross(&down), TORQUE_ZERO) + noise(0.002),
            }
        })
        .collect()
}

#[test]
fn each_frame_is_told_from_all_others() {
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
                    let best = &candidates(&postures, &BELIEF)[0];
                    assert_eq!(best.fit.frame, of(axes, inverse, opposite), "seed {seed}");
                    assert!(best.probability > 0.9, "{}", best.probability);
                }
            }
        }
    }
}

#[test]
fn turned_axes_are_told_with_their_angle() {
    for angle in [-0.5, 0.2, 1.0, std::f64::consts::FRAC_PI_2] {
        let postures = planted(5, Axes::Sensor, angle, false, 1.0);
        let best = &candidates(&postures, &BELIEF)[0];
        assert!(
            best.fit.frame.is_turned_about_z(),
            "{angle}: {:?}",
            best.fit.frame
        );
        if best.fit.frame.turn == Turn::AboutZ {
            let [turn, low, high] = numbers(&postures, &best.fit, BELIEF.gravity, [0.0; 2]).turn;
            assert!(
                low < angle && angle < high && high - low < 0.1,
                "{angle}: {turn}"
            );
        }
    }
}

#[test]
fn intervals_hold_what_was_planted() {
    let (mut held, mut all) = (0, 0);
    for seed in 1..=40 {
        let postures = planted(seed, Axes::Base, 0.0, false, 1.0);
        let best = &candidates(&postures[..10], &BELIEF)[0];
        let found = numbers(&postures[..10], &best.fit, BELIEF.gravity, [0.0; 2]);
        let mut check = |[_, low, high]: [f64; 3], truth: f64| {
            all += 1;
            held += usize::from(low <= truth && truth <= high);
        };
        check(found.weight, WEIGHT);
        for i in 0..3 {
            check(found.zero[i], ZERO[i]);
            check(found.torque_zero[i], TORQUE_ZERO[i]);
            check(found.centre[i], CENTRE[i]);
        }
    }
    let share = held as f64 / all as f64;
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

//! Closed forms of the mechanics alone: a device without air, its seals, and a tap on a load.

use idc_cell::device::{Device, DeviceParameters, DeviceState, PistonMotion};
use idc_cell::physics::gas_process::GasProcess;
use idc_cell::physics::push_only::PushOnly;
use idc_cell::physics::seal_friction::SealFriction;

use super::devices::{Outside, closed, reached, still};

const SEALS: SealFriction = SealFriction {
    coulomb: 10.0,
    static_force: 14.0,
    stribeck_velocity: 0.01,
    viscous: 50.0,
    presliding_displacement: 5e-5,
    pressure_coefficient: 0.0,
};

/// Nothing in the chambers and no way in; with it, the force along extension that balances the atmosphere on the rods [N].
fn empty(seal_friction: SealFriction) -> (Device, DeviceState, f64) {
    let device = Device::new(DeviceParameters {
        seal_friction,
        full_stroke: 10.0,
        ..closed(GasProcess::Isothermal)
    });
    let mut state = device.at_rest(0.02, 0.0);
    state.air.masses = [0.0; 2];
    let rod = device.parameters().gas.atmosphere * device.parameters().areas().rod();
    (device, state, rod)
}

// Catches: the viscous part left out, Stribeck's curve that does not end at Coulomb's friction, friction that drives.
#[test]
fn seals_slide_steadily_at_coulomb_plus_viscous_friction() {
    let (device, mut state, rod) = empty(SEALS);
    let pull = 40.0;
    let outside = Outside::force(pull + rod);
    let mut motion = still(0.02);
    // Time constant M/b = 80 ms.
    for _ in 0..3000 {
        device.advance_loaded::<_, true>(&mut state, &mut motion, 0.0, &outside, 1e-3, 1);
    }
    reached(
        "sliding speed (F - F_c) / b",
        (motion.speed / ((pull - 10.0) / 50.0) - 1.0).abs(),
        1e-4,
    );
    reached(
        "friction while sliding",
        (-device.seal_force(&state, motion.speed) / pull - 1.0).abs(),
        1e-4,
    );
    // Let go of: v = (v_0 + F_c/b) exp(-b t/M) - F_c/b, then it sticks.
    let (start, coast) = (motion.speed, Outside::force(rod));
    let stops_after = 4.0 / 50.0 * (start * 50.0 / 10.0 + 1.0f64).ln();
    let mut largest = 0.0f64;
    for ms in 1..=(0.9 * stops_after * 1e3) as usize {
        device.advance_loaded::<_, true>(&mut state, &mut motion, 0.0, &coast, 1e-3, 1);
        let expected = (start + 0.2) * (-50.0 / 4.0 * ms as f64 * 1e-3).exp() - 0.2;
        largest = largest.max((motion.speed - expected).abs() / start);
    }
    reached("coasting against seals, of the first speed", largest, 1e-4);
}

/// Pulled by a force that grows slowly to a level [N], then held for a second; and where it was at the end of the growth [m].
fn pulled(seals: SealFriction, level: f64, growth: f64) -> (f64, PistonMotion) {
    let (device, mut state, rod) = empty(seals);
    let mut motion = still(0.02);
    let steps = (level / growth * 1e3) as usize;
    let mut bent = 0.0;
    for step in 0..steps + 1000 {
        let share = ((step as f64 + 0.5) / steps as f64).min(1.0);
        let outside = Outside::force(level * share + rod);
        device.advance_loaded::<_, true>(&mut state, &mut motion, 0.0, &outside, 1e-3, 1);
        if step + 1 == steps {
            bent = motion.stroke - 0.02;
        }
    }
    (bent, motion)
}

// Catches: breakaway at Coulomb's friction, a bristle stiffness other than F_c/z_p, creep under a force below breakaway.
#[test]
fn seals_hold_to_static_friction_and_bend_before_it_in_closed_form() {
    // Damped and without Stribeck's fall the pull is quasi-static: F = F_c (1 - exp(-x/z_p)).
    let plain = SealFriction {
        static_force: 10.0,
        viscous: 2e3,
        ..SEALS
    };
    let mut largest = 0.0f64;
    for share in [0.3, 0.6, 0.9f64] {
        let (bent, end) = pulled(plain, 10.0 * share, 0.1);
        let expected = -5e-5 * (1.0 - share).ln();
        // The growth leaves the viscous part b x', which the hold takes away.
        assert!((bent / expected - 1.0).abs() < 0.01);
        largest = largest.max(((end.stroke - 0.02) / expected - 1.0).abs());
    }
    reached("presliding displacement -z_p ln(1 - F/F_c)", largest, 1e-4);
    for (share, slides) in [(0.95, false), (1.01, true)] {
        let (_, end) = pulled(SEALS, 14.0 * share, 2.0);
        let moved = end.stroke - 0.02;
        println!(
            "pulled with {share} of static friction: {:.3} mm, {:.2e} m/s",
            moved * 1e3,
            end.speed
        );
        assert_eq!(moved > 1e-3, slides, "{share}: {moved}");
    }
}

/// Where a mass of 4 kg is [m] that meets a load at 0.021 m with a speed [m/s], `time` [s] later.
///
/// In contact d = v/w_d exp(-a t) sin(w_d t), a = c/2M, w_d^2 = k/M - a^2, until k d + c d' = 0 at w_d t = pi - 2 asin(a/w); then free flight.
fn tapped(law: PushOnly, speed: f64, time: f64) -> f64 {
    let (natural, decay) = ((law.stiffness / 4.0).sqrt(), law.damping / 8.0);
    let damped = (natural * natural - decay * decay).sqrt();
    let leaves = (std::f64::consts::PI - 2.0 * (decay / natural).asin()) / damped;
    let at = time.min(leaves);
    let (sine, cosine) = (damped * at).sin_cos();
    let shrunk = speed * (-decay * at).exp();
    let left = shrunk * (cosine - decay / damped * sine);
    0.021 + shrunk / damped * sine + left * (time - at)
}

// Catches: a contact that pulls, is left or met a sub-step late, or whose damping or mass is wrong.
#[test]
fn a_tap_lasts_half_a_period_and_bounces_in_closed_form() {
    for damping in [0.0, 400.0] {
        let law = PushOnly {
            stiffness: 1.5e5,
            damping,
        };
        let (device, mut state, rod) = empty(SealFriction::NONE);
        let outside = Outside {
            force: rod,
            load: Some((0.021, law)),
            rate: (1.5e5f64 / 4.0).sqrt(),
        };
        // Meets the load within a step, at 4.16 ms.
        let speed = 0.24;
        let mut motion = PistonMotion {
            stroke: 0.02,
            speed,
        };
        let deepest = tapped(law, speed, 8.1e-3) - 0.021;
        let mut largest = 0.0f64;
        for ms in 1..=60 {
            device.advance_loaded::<_, true>(&mut state, &mut motion, 0.0, &outside, 1e-3, 1);
            let since = f64::from(ms) * 1e-3 - 0.001 / speed;
            let expected = match since > 0.0 {
                true => tapped(law, speed, since),
                false => 0.021 + speed * since,
            };
            largest = largest.max((motion.stroke - expected).abs() / deepest);
        }
        println!(
            "tap at {speed} m/s, damping {damping}: leaves at {:.5} of its speed",
            -motion.speed / speed
        );
        reached("path of a tap, of its depth", largest, 1e-4);
        if damping == 0.0 {
            // Extrapolated back along the free flight: when it left, after half a period.
            let left_at = 0.06 - (0.021 - motion.stroke) / -motion.speed;
            let half_period = std::f64::consts::PI * (4.0f64 / 1.5e5).sqrt();
            reached(
                "half-period of a tap",
                ((left_at - 0.001 / speed) / half_period - 1.0).abs(),
                1e-4,
            );
        }
    }
}

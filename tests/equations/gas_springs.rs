//! Closed forms of closed chambers whose piston moves: springs of air.

use idc_cell::device::{Device, PistonMotion};
use idc_cell::physics::gas_process::GasProcess;

use super::devices::{ADIABATIC, Outside, closed, filled, reached, still, volumes};

const K: f64 = 1.4;
const ATMOSPHERE: f64 = 101_325.0;

/// Pressure in chamber 2 [Pa absolute] that holds the piston against one in chamber 1.
fn balancing(device: &Device, first: f64) -> f64 {
    let areas = device.parameters().areas();
    (first * areas.extending - ATMOSPHERE * areas.rod()) / areas.retracting
}

/// Largest errors of p V^n, of T V^(n-1) and of the work of the air while a piston thrown at 1.5 m/s swings on closed chambers.
fn errors_of_a_swing(process: GasProcess, exponent: f64) -> [f64; 3] {
    let device = Device::new(closed(process));
    let start = [3e5, balancing(&device, 3e5)];
    let mut state = filled(&device, 0.025, start, 0.0);
    let mut motion = PistonMotion {
        stroke: 0.025,
        speed: 1.5,
    };
    let first = volumes(device.parameters(), 0.025);
    let mut errors = [0.0f64; 3];
    let (mut lowest, mut turned) = (0.025f64, 0.0f64);
    for _ in 0..1000 {
        device.advance_loaded::<_, true>(&mut state, &mut motion, 0.0, &Outside::NOTHING, 1e-3, 1);
        lowest = lowest.min(motion.stroke);
        let now = volumes(device.parameters(), motion.stroke);
        let (pressures, temperatures) = (
            device.pressures(&state, motion.stroke),
            device.temperatures(&state),
        );
        let mut work = 0.0;
        for i in 0..2 {
            let ratio = now[i] / first[i];
            errors[0] = errors[0].max((pressures[i] / start[i] * ratio.powf(exponent) - 1.0).abs());
            errors[1] =
                errors[1].max((temperatures[i] / 293.15 * ratio.powf(exponent - 1.0) - 1.0).abs());
            work += if exponent == 1.0 {
                start[i] * first[i] * ratio.ln()
            } else {
                start[i] * first[i] / (exponent - 1.0) * (1.0 - ratio.powf(1.0 - exponent))
            };
        }
        turned = turned.max(work.abs());
        errors[2] = errors[2].max((state.ledger.chamber_work - work).abs());
    }
    assert!(lowest < 0.012, "it deflected: {lowest}");
    errors[2] /= turned;
    errors
}

// Catches: k of one for an air that heats, work with the wrong sign in the energy, a ledger that misses a chamber.
#[test]
fn closed_chambers_follow_p_v_and_p_v_to_the_k_and_do_the_work_of_the_closed_form() {
    for (name, process, exponent) in [
        ("isothermal", GasProcess::Isothermal, 1.0),
        ("adiabatic", ADIABATIC, K),
    ] {
        let [pressure, temperature, work] = errors_of_a_swing(process, exponent);
        reached(
            &format!("{name} compression, p V^{exponent}"),
            pressure,
            1e-4,
        );
        reached(
            &format!("{name} compression, temperature"),
            temperature,
            1e-4,
        );
        reached(&format!("{name} compression, work"), work, 1e-4);
    }
}

// Catches: a "conductance" that is not one: without the right 1/G the constant drifts.
#[test]
fn much_wall_heat_comes_back_to_isothermal_as_one_over_g() {
    // A chamber pressed steadily: p/p_isothermal - 1 = T/T_w - 1 = -p V' / (G T_w) to first order.
    let departure = |conductance: f64| {
        let device = Device::new(closed(GasProcess::WallHeat { conductance }));
        let mut state = filled(&device, 0.045, [2e5, 2e5], 0.0);
        let air = state.air.masses[0] * super::devices::rt();
        let speed = -0.1;
        let mut stroke = 0.045;
        for _ in 0..2500 {
            device.advance(&mut state, 0.0, PistonMotion { stroke, speed }, 1e-4, 1);
            stroke += speed * 1e-4;
        }
        let isothermal = air / volumes(device.parameters(), stroke)[0];
        let first_order = isothermal * 1.6085e-3 * 0.1 / (conductance * 293.15);
        let found = device.pressures(&state, stroke)[0] / isothermal - 1.0;
        (found, found / first_order - 1.0)
    };
    let mut before = f64::NAN;
    for conductance in [6.25, 12.5, 25.0, 50.0, 100.0] {
        let (found, error) = departure(conductance);
        println!(
            "G = {conductance} W/K: {found:.2e} above isothermal, first order off by {error:.1e}"
        );
        assert!(found > 0.0);
        if before.is_finite() {
            assert!(
                (before / found - 2.0).abs() < 0.1,
                "halved by twice the conductance"
            );
        }
        before = found;
    }
    let (_, error) = departure(100.0);
    // Twice over, the second order out: what is left of the first-order law.
    let extrapolated = 2.0 * error - departure(50.0).1;
    reached(
        "-p V' / (G T), extrapolated to large G",
        extrapolated.abs(),
        1e-4,
    );
}

/// Natural frequency of a small free swing [rad/s] from its zero crossings over many periods.
fn natural_frequency(process: GasProcess, first: f64) -> f64 {
    let device = Device::new(closed(process));
    let start = [first, balancing(&device, first)];
    let mut state = filled(&device, 0.02, start, 0.0);
    let mut motion = still(0.02);
    motion.speed = 1e-3;
    let (mut crossings, mut before) = (Vec::new(), motion);
    for ms in 1..=4000 {
        device.advance_loaded::<_, true>(&mut state, &mut motion, 0.0, &Outside::NOTHING, 1e-3, 1);
        let (a, b) = (before.stroke - 0.02, motion.stroke - 0.02);
        if a < 0.0 && b >= 0.0 {
            // Cubic through both ends and their speeds, by Newton's method.
            let (va, vb) = (before.speed * 1e-3, motion.speed * 1e-3);
            let mut s = a / (a - b);
            for _ in 0..20 {
                let (s2, s3) = (s * s, s * s * s);
                let value = a * (2.0 * s3 - 3.0 * s2 + 1.0)
                    + va * (s3 - 2.0 * s2 + s)
                    + b * (3.0 * s2 - 2.0 * s3)
                    + vb * (s3 - s2);
                let slope = (6.0 * s2 - 6.0 * s) * (a - b)
                    + va * (3.0 * s2 - 4.0 * s + 1.0)
                    + vb * (3.0 * s2 - 2.0 * s);
                s -= value / slope;
            }
            crossings.push((f64::from(ms - 1) + s) * 1e-3);
        }
        before = motion;
    }
    let periods = (crossings.len() - 1) as f64;
    std::f64::consts::TAU * periods / (crossings.last().unwrap() - crossings[0])
}

// Catches: a stiffness of one chamber only, k left out or applied to an isothermal chamber, the mass counted twice.
#[test]
fn the_piston_swings_on_two_air_springs_at_its_natural_frequency() {
    for (name, process, exponent) in [
        ("isothermal", GasProcess::Isothermal, 1.0),
        ("adiabatic", ADIABATIC, K),
    ] {
        for first in [1.5e5, 4e5] {
            let device = Device::new(closed(process));
            let areas = device.parameters().areas();
            let [v1, v2] = volumes(device.parameters(), 0.02);
            let stiffness = first * areas.extending.powi(2) / v1
                + balancing(&device, first) * areas.retracting.powi(2) / v2;
            let expected = (exponent * stiffness / 4.0).sqrt();
            let found = natural_frequency(process, first);
            println!(
                "{name}, {first} Pa: {:.4} Hz",
                found / std::f64::consts::TAU
            );
            reached(
                "natural frequency on two air springs",
                (found / expected - 1.0).abs(),
                1e-4,
            );
        }
    }
}

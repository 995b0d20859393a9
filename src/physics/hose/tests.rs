//! The line against closed forms of both regimes and against another program's Colebrook.

use super::*;

fn rt() -> f64 {
    287.05 * 293.15
}

fn near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found / expected - 1.0).abs() < tolerance,
        "{found:e} against {expected:e}"
    );
}

#[test]
fn a_metre_of_4_mm_tube_is_12_6_cm3_and_slow_air_flows_by_poiseuille() {
    let tube = Hose::tube(1.0, 0.004, &Gas::default());
    near(tube.volume, 12.566e-6, 1e-4);
    // A litre a minute at the atmosphere: 8 mu l Q / (pi r^4) = 48 Pa at the mean density.
    let rate = 1e-3 / 60.0;
    let drop = 8.0 * 1.82e-5 * rate / (std::f64::consts::PI * 0.002f64.powi(4));
    let within = 101_325.0 - drop;
    let density = 0.5 * (101_325.0 + within) / rt();
    near(tube.mass_flow(101_325.0, within), rate * density, 1e-12);
    near(
        tube.resistance_at_rest(101_325.0),
        drop / rate / (101_325.0 / rt()),
        1e-12,
    );
    assert_eq!(tube.mass_flow(3e5, 3e5), 0.0);
}

#[test]
fn fast_air_flows_as_another_program_finds_it_by_colebrook() {
    // Mass flow [kg/s] where f l/d G^2/2 = (p_1^2 - p_2^2)/(2 R T), f from `fluids` 1.3.1 (friction_factor, smooth, method Colebrook), by brentq.
    for (length, diameter, before, within, expected) in [
        (1.0, 0.004, 701_325.0, 601_325.0, 0.007_590_870_221_861_055),
        (2.0, 0.004, 401_325.0, 301_325.0, 0.003_649_878_840_845_563),
        (
            1.0,
            0.006,
            301_325.0,
            291_325.0,
            0.003_988_773_267_883_995_5,
        ),
        (10.0, 0.006, 701_325.0, 101_325.0, 0.012_878_016_290_612_563),
        (0.5, 0.008, 501_325.0, 500_325.0, 0.004_693_824_114_343_035),
        (1.0, 0.004, 301_000.0, 300_000.0, 0.000_358_704_359_238_844),
        (1.0, 0.004, 200_100.0, 200_000.0, 8.207_286_354_895_635e-5),
    ] {
        let tube = Hose::tube(length, diameter, &Gas::default());
        near(tube.mass_flow(before, within), expected, 1e-9);
        near(tube.mass_flow(within, before), -expected, 1e-9);
        near(tube.pressure_before(expected, within), before, 1e-9);
        near(tube.pressure_before(-expected, before), within, 1e-9);
    }
}

#[test]
fn laminar_alone_would_let_35_times_as_much_through_while_a_hose_fills() {
    // Seven bar absolute before a metre of 4 mm, six behind it.
    let tube = Hose::tube(1.0, 0.004, &Gas::default());
    let laminar = Hose::lumped(tube.volume, tube.resistance_at_rest(6.5e5));
    let ratio = laminar.mass_flow(7e5, 6e5) / tube.mass_flow(7e5, 6e5);
    assert!((ratio - 35.0).abs() < 1.0, "{ratio}");
    assert_eq!(
        laminar.pressure_before(laminar.mass_flow(7e5, 6e5), 6e5),
        7e5
    );
}

#[test]
fn the_regimes_join_without_a_jump_a_kink_or_a_fall() {
    let slope_by_difference = |k: f64| {
        let step = 1e-6 * k;
        (reynolds(k + step).0 - reynolds(k - step).0) / (2.0 * step)
    };
    for k in [64.0 * LAMINAR_TO, TURBULENT_FROM * TURBULENT_FROM] {
        let (below, above) = (reynolds(k * (1.0 - 1e-9)), reynolds(k * (1.0 + 1e-9)));
        near(above.0, below.0, 1e-8);
        near(above.1, below.1, 1e-6);
    }
    near(reynolds(640_000.0).0, 4005.5, 1e-4);
    let mut before = reynolds(1e4).0;
    for i in 1..4000 {
        let k = 1e4 * 1.003f64.powi(i);
        let (found, slope) = reynolds(k);
        assert!(found > before && slope > 0.0, "K = {k}");
        assert!(
            (slope / slope_by_difference(k) - 1.0).abs() < 1e-3,
            "K = {k}"
        );
        near(drive_of(found), k, 1e-10);
        before = found;
    }
}

#[test]
fn the_slope_over_the_pressure_in_the_line_is_its_difference_quotient() {
    let tube = Hose::tube(1.0, 0.004, &Gas::default());
    for (before, within) in [(3e5, 2.9999e5), (3e5, 2.994e5), (5e5, 3e5), (3e5, 5e5)] {
        let quotient =
            (tube.mass_flow(before, within + 0.1) - tube.mass_flow(before, within - 0.1)) / 0.2;
        near(tube.flow_slope(before, within).slope, quotient, 1e-5);
    }
}

#[test]
fn the_balance_holds_from_standstill_to_a_base_far_off() {
    for tube in [
        Hose::tube(1.0, 0.004, &Gas::default()),
        Hose::tube(0.01, 0.025, &Gas::default()),
        Hose::lumped(1e-5, 1e5),
    ] {
        let on = |p: f64| FlowSlope {
            flow: 2e-8 * (p - 2e5),
            slope: 2e-8,
        };
        for (before, storage, base) in [
            (6e5, 0.0, 0.0),
            (2e5, 0.0, 9e5),
            (1e5, 1e-7, 5e5),
            (6e5, 1e-6, 4e6),
            (6e5, 1e-9, 1e5),
        ] {
            let p = tube.balance(before, 2e5, (storage, base), on);
            let off = storage * (p - base) - tube.mass_flow(before, p) + on(p).flow;
            // As far as rounding of p by a part in 1e15 takes it.
            let slope = storage + 2e-8 - tube.flow_slope(before, p).slope;
            assert!(
                off.abs() < 1e-14 * slope * p,
                "{before} {storage} {base}: {off:e}"
            );
        }
        // A base that no air can have stays a pressure.
        assert!(tube.balance(3e5, 2e5, (1e-6, -4e6), on) > 0.0);
    }
}

#[test]
fn the_slope_of_what_is_drawn_is_that_of_a_balance_that_follows() {
    let rigid = Hose {
        law: LineLaw::Constant {
            resistance: 3e7,
            segments: 1,
            last: 1.0,
        },
        ..Hose::tube(1.0, 0.004, &Gas::default())
    };
    for line in [Hose::tube(1.0, 0.004, &Gas::default()), rigid] {
        for (before, within) in [(5e5, 4.6e5), (4.6e5, 5e5), (3e5, 2.99e5)] {
            let onward = 2e-8;
            // What goes on and is stored, through the flow at these pressures.
            let rest = line.mass_flow(before, within) - onward * within;
            let balanced = |before: f64| {
                let (mut low, mut high) = (1e5, 9e5);
                for _ in 0..200 {
                    let p = 0.5 * (low + high);
                    match line.mass_flow(before, p) > rest + onward * p {
                        true => low = p,
                        false => high = p,
                    }
                }
                line.mass_flow(before, 0.5 * (low + high))
            };
            let drawn = line.drawn(before, within, onward);
            assert_eq!(drawn.flow, line.mass_flow(before, within));
            let slope = (balanced(before + 10.0) - balanced(before - 10.0)) / 20.0;
            near(drawn.slope, slope, 1e-4);
        }
    }
}

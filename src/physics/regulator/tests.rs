//! The regulator and what a real one has besides, against closed forms and against fine integration.

use super::*;

fn step_response(dt: f64, until: f64) -> f64 {
    let parameters = RegulatorParameters {
        gain: 0.98,
        dead_time: 0.0205,
        ..RegulatorParameters::default()
    };
    let mut state = RegulatorState::at_rest(&parameters, 0.0);
    state.command(&parameters, 2e5);
    for _ in 0..(until / dt).round() as usize {
        state.advance(&parameters, dt);
    }
    state.outlet
}

#[test]
fn a_step_follows_the_closed_form_whatever_the_step() {
    for dt in [1e-3, 2.5e-4, 1e-2] {
        let exact = 0.98 * 2e5 * (1.0 - (-(0.4 - 0.0205f64) / 0.15).exp());
        assert!((step_response(dt, 0.4) / exact - 1.0).abs() < 1e-12);
        assert_eq!(step_response(dt, 0.02), 0.0);
    }
}

#[test]
fn the_outlet_never_exceeds_the_supply() {
    let parameters = RegulatorParameters {
        time_constant: 0.1,
        dead_time: 0.0,
        supply: 3e5,
        ..RegulatorParameters::default()
    };
    let mut state = RegulatorState::at_rest(&parameters, 0.0);
    state.command(&parameters, 5e5);
    for _ in 0..5000 {
        state.advance(&parameters, 1e-3);
    }
    assert!((state.outlet - 3e5).abs() < 1e-6);
}

/// Outlet [Pa gauge] after every step of `dt` [s], the set pressures given at their steps.
fn outlets(
    parameters: &RegulatorParameters,
    commands: &[(usize, f64)],
    dt: f64,
    steps: usize,
) -> Vec<f64> {
    let mut state = RegulatorState::at_rest(parameters, 0.0);
    let mut set = 0.0;
    (0..steps)
        .map(|step| {
            if let Some((_, value)) = commands.iter().find(|(at, _)| *at == step) {
                set = *value;
            }
            state.command(parameters, set);
            state.advance(parameters, dt)
        })
        .collect()
}

#[test]
fn a_limited_lag_ramps_until_its_own_rate_is_the_limit_and_then_closes_in() {
    let parameters = RegulatorParameters {
        dead_time: 0.0,
        rate_limit: RateLimit {
            rise: 4e5,
            fall: 2.5e5,
        },
        ..RegulatorParameters::default()
    };
    // Up to 3 bar: a ramp to 3e5 - 4e5 * 0.15; down to 0: a ramp to 2.5e5 * 0.15.
    let way = |time: f64, from: f64, to: f64, limit: f64| {
        let turn = to - limit * 0.15;
        let until = (turn - from) / limit;
        if time < until {
            from + limit * time
        } else {
            to + (turn - to) * (-(time - until) / 0.15).exp()
        }
    };
    for (dt, steps) in [(1e-3, 4000), (7e-3, 572)] {
        let down = steps / 2;
        let outlets = outlets(&parameters, &[(0, 3e5), (down, 0.0)], dt, steps);
        let top = outlets[down - 1];
        for (step, outlet) in outlets.iter().enumerate() {
            let time = (step + 1) as f64 * dt;
            let expected = if step < down {
                way(time, 0.0, 3e5, 4e5)
            } else {
                way(time - down as f64 * dt, top, 0.0, -2.5e5)
            };
            assert!(
                (outlet - expected).abs() < 2e-3,
                "{dt} {step}: {outlet} {expected}"
            );
        }
    }
}

#[test]
fn play_keeps_the_outlet_back_by_half_its_width_either_way() {
    let parameters = RegulatorParameters {
        gain: 0.98,
        time_constant: 0.01,
        hysteresis: 6e3,
        ..RegulatorParameters::default()
    };
    let commands = [(0, 2e5), (300, 1.95e5), (600, 1.5e5), (900, 1.55e5)];
    let outlets = outlets(&parameters, &commands, 1e-3, 1200);
    for (step, acted_on) in [(299, 1.94e5), (599, 1.94e5), (899, 1.56e5), (1199, 1.56e5)] {
        assert!((outlets[step] - 0.98 * acted_on).abs() < 1e-3, "{step}");
    }
}

#[test]
fn an_oscillator_rings_by_its_closed_form_whatever_the_step() {
    let oscillator = SecondOrder {
        natural_frequency: 25.0,
        damping_ratio: 0.35,
    };
    let parameters = RegulatorParameters {
        dead_time: 0.012,
        second_order: Some(oscillator),
        ..RegulatorParameters::default()
    };
    for (dt, steps) in [(1e-3, 500), (5e-3, 100)] {
        let outlets = outlets(&parameters, &[(0, 2e5)], dt, steps);
        for (step, outlet) in outlets.iter().enumerate() {
            let time = ((step + 1) as f64 * dt - 0.012).max(0.0);
            let expected = 2e5 + oscillator.after(-2e5, 0.0, time).0;
            assert!(
                (outlet - expected).abs() < 1e-6,
                "{step}: {outlet} {expected}"
            );
        }
        let top = outlets.iter().copied().fold(0.0, f64::max);
        assert!(top > 2.5e5, "it overshoots: {top}");
    }
}

#[test]
fn an_oscillator_stays_between_atmosphere_and_supply() {
    let parameters = RegulatorParameters {
        supply: 2.2e5,
        second_order: Some(SecondOrder {
            natural_frequency: 25.0,
            damping_ratio: 0.1,
        }),
        ..RegulatorParameters::default()
    };
    let outlets = outlets(&parameters, &[(0, 2e5), (1000, 0.0)], 1e-3, 2000);
    let extreme = |pick: fn(f64, f64) -> f64| outlets.iter().copied().reduce(pick);
    assert_eq!(
        (extreme(f64::min), extreme(f64::max)),
        (Some(0.0), Some(2.2e5))
    );
}

#[test]
fn an_oscillator_with_limited_rates_equals_its_fine_integration() {
    for (ratio, rise, fall) in [
        (0.3, 1.5e6, 8e5),
        (0.8, 6e5, f64::INFINITY),
        (2.0, 3e5, 4e5),
    ] {
        let oscillator = SecondOrder {
            natural_frequency: 30.0,
            damping_ratio: ratio,
        };
        let parameters = RegulatorParameters {
            dead_time: 0.0,
            rate_limit: RateLimit { rise, fall },
            second_order: Some(oscillator),
            ..RegulatorParameters::default()
        };
        let commands = [(0, 3e5), (120, 1.5e5), (300, 2.5e5), (420, 1e5)];
        let exact = outlets(&parameters, &commands, 1e-3, 700);
        let (mut p, mut v, mut set, mut saturated) = (0.0f64, 0.0f64, 0.0, 0);
        let fine = 2000;
        let h = 1e-3 / f64::from(fine);
        for (step, exact) in exact.iter().enumerate() {
            if let Some((_, value)) = commands.iter().find(|(at, _)| *at == step) {
                set = *value;
            }
            for _ in 0..fine {
                // Leapfrog, its error of second order; the rate is held at its limits.
                let half = p + 0.5 * h * v;
                let acceleration = oscillator.acceleration(half - set, v);
                let middle = v + 0.5 * h * acceleration;
                let next = (v + h * oscillator.acceleration(half - set, middle)).clamp(-fall, rise);
                saturated += usize::from(next == rise || next == -fall);
                p = half + 0.5 * h * next;
                v = next;
            }
            assert!((exact - p).abs() < 2.0, "{ratio} at {step}: {exact} {p}");
        }
        assert!(saturated > 10 * fine as usize, "the limits were met");
    }
}

//! Closed forms of a chamber whose piston stands still: filled, emptied, cooled by its wall.

use idc_cell::device::{Device, DeviceParameters, DeviceState};
use idc_cell::physics::gas_process::GasProcess;

use super::devices::{ADIABATIC, closed, filled, printed_flow, reached, rt, still, usual, volumes};

const STROKE: f64 = 0.04;
const T_0: f64 = 293.15;
const K: f64 = 1.4;

fn device(gas_process: GasProcess) -> Device {
    Device::new(DeviceParameters {
        gas_process,
        ..usual()
    })
}

/// Largest error of a chamber's pressure and temperature against closed forms of time, over a time [s].
fn error(
    device: &Device,
    state: &mut DeviceState,
    chamber: usize,
    set: f64,
    duration: f64,
    exact: impl Fn(f64) -> (f64, f64),
) -> f64 {
    let mut largest = 0.0f64;
    for ms in 1..=(duration * 1e3) as usize {
        device.advance(state, set, still(STROKE), 1e-3, 1);
        let (pressure, temperature) = exact(ms as f64 * 1e-3);
        let found = device.pressures(state, STROKE)[chamber] / pressure - 1.0;
        let warmth = device.temperatures(state)[chamber] / temperature - 1.0;
        largest = largest.max(found.abs()).max(warmth.abs());
    }
    largest
}

// Catches: charging by R T for k R T or the other way, the supply's enthalpy c_v T for c_p T, a wrong discharge coefficient.
#[test]
fn choked_filling_is_linear_in_time_and_hotter_by_up_to_k_without_heat_exchange() {
    // From 0.1 bar, choked up to 0.528 of 7 bar.
    let (start, supply) = (1e4, 6e5 + 101_325.0);
    let volume = volumes(&usual(), STROKE)[0];
    let choked = printed_flow(2.5e-6 * 0.95, supply, 0.0);
    let (mut hottest, mut limit) = (0.0f64, 0.0);
    for (name, process, rule) in [
        ("isothermal", GasProcess::Isothermal, 1.0),
        ("adiabatic", ADIABATIC, K),
    ] {
        let device = device(process);
        let mut state = filled(&device, STROKE, [start, 101_325.0], 6e5);
        let rise = rt() * choked / volume;
        let duration = (0.5 * supply - start) / (rule * rise);
        let largest = error(&device, &mut state, 0, 6e5, duration, |t| {
            let pressure = start + rule * rise * t;
            (pressure, T_0 * pressure / (start + rise * t))
        });
        hottest = hottest.max(device.temperatures(&state)[0] / T_0);
        limit = rule;
        reached(
            &format!("choked filling, {name}, {:.0} ms", 1e3 * duration),
            largest,
            1e-4,
        );
    }
    println!("adiabatic filling heats to {hottest:.3} T_0, between 1 and k = {limit}");
    assert!(hottest > 1.3 && hottest < limit);
}

// Catches: sqrt(T) of the upstream temperature left out of eq. (9), outflow at the wall's temperature, eq. (6) with the wrong volume.
#[test]
fn choked_venting_is_an_exponential_or_a_power_of_time() {
    let (start, end) = (7e5, 2e5);
    let volume = volumes(&usual(), STROKE)[1];
    // tau = V / (A C f sqrt(R T_0))
    let tau = start * volume / (rt() * printed_flow(2e-6 * 0.95, start, 1e5));
    let isothermal = device(GasProcess::Isothermal);
    let mut state = filled(&isothermal, STROKE, [101_325.0, start], 0.0);
    let duration = tau * (start / end).ln();
    let largest = error(&isothermal, &mut state, 1, 0.0, duration, |t| {
        (start * (-t / tau).exp(), T_0)
    });
    reached(
        &format!("choked venting, isothermal, {:.0} ms", 1e3 * duration),
        largest,
        1e-4,
    );

    let adiabatic = device(ADIABATIC);
    let mut state = filled(&adiabatic, STROKE, [101_325.0, start], 0.0);
    let root = |t: f64| 1.0 + 0.5 * (K - 1.0) * t / tau;
    let duration = ((start / end).powf(0.5 * (K - 1.0) / K) - 1.0) * tau / (0.5 * (K - 1.0));
    let largest = error(&adiabatic, &mut state, 1, 0.0, duration, |t| {
        (
            start * root(t).powf(-2.0 * K / (K - 1.0)),
            T_0 * root(t).powi(-2),
        )
    });
    reached(
        &format!("choked venting, adiabatic, {:.0} ms", 1e3 * duration),
        largest,
        1e-4,
    );
    assert!(adiabatic.temperatures(&state)[1] < 0.75 * T_0);
}

// Catches: heat exchange by c_p, shared between the chambers, or of the wrong sign.
#[test]
fn a_closed_chamber_comes_to_its_wall_with_m_c_v_over_g() {
    let mut largest = 0.0f64;
    for conductance in [0.05, 0.5, 5.0] {
        let device = Device::new(closed(GasProcess::WallHeat { conductance }));
        let mut state = filled(&device, STROKE, [3e5, 2e5], 0.0);
        let heats = state.air.masses.map(|mass| mass * 287.05 / (K - 1.0));
        let above = [60.0, -40.0];
        for i in 0..2 {
            state.air.energies[i] += heats[i] * above[i];
        }
        for ms in 1..=200 {
            device.advance(&mut state, 0.0, still(STROKE), 1e-3, 1);
            for i in 0..2 {
                let expected =
                    T_0 + above[i] * (-conductance * f64::from(ms) * 1e-3 / heats[i]).exp();
                let found = device.temperatures(&state)[i];
                largest = largest.max((found - expected).abs() / above[i].abs());
            }
        }
    }
    reached(
        "temperature of a closed chamber against exp(-G t / (m c_v))",
        largest,
        1e-4,
    );
}

//! The laboratory against the simulator that a diagnosis fits: with nothing concealed they are the same device in two hands.

use idc_cell::device::DeviceParameters;
use idc_cell::laboratory::{
    Concealed, Conditions, EFFECTS, LaboratoryRig, NominalRig, Programme, Recipe, run,
};
use idc_cell::physics::end_cushioning::EndCushioning;
use idc_cell::physics::gas::Gas;
use idc_cell::physics::gas_process::GasProcess;
use idc_cell::physics::hose::Hose;
use idc_cell::physics::push_only::PushOnly;
use idc_cell::physics::regulator::{RateLimit, RegulatorParameters, SecondOrder};
use idc_cell::physics::seal_friction::SealFriction;
use idc_cell::physics::supply_reservoir::SupplyReservoir;
use idc_cell::plant::{
    ContactLaw, ContactParameters, InitialState, Periodic, PlantInputs, PlantParameters, simulate,
};
use rand::{Rng, SeedableRng};
use rand_distr::StandardNormal;

/// The same device in the simulator's own description.
pub fn plant_of(rig: &LaboratoryRig) -> PlantParameters {
    PlantParameters {
        device: DeviceParameters {
            cylinder_count: rig.count,
            bore: rig.bore,
            rod: rig.rod,
            full_stroke: rig.stroke,
            dead_volume: rig.dead_volume,
            moving_mass: rig.mass,
            supply_orifice: rig.supply_orifice,
            exhaust_orifice: rig.exhaust_orifice,
            discharge_coefficient: rig.discharge,
            regulator: RegulatorParameters {
                gain: rig.gain,
                time_constant: rig.time_constant,
                dead_time: 0.0,
                supply: 16e5,
                ..RegulatorParameters::default()
            },
            end_stop: PushOnly {
                stiffness: rig.stop[0],
                damping: rig.stop[1],
            },
            gas: Gas {
                specific_gas_constant: rig.gas.constant,
                heat_capacity_ratio: rig.gas.ratio,
                temperature: rig.gas.temperature,
                atmosphere: rig.gas.atmosphere,
            },
            ..DeviceParameters::default()
        },
        gravity_along_extension: rig.gravity,
        contact: ContactParameters::linear(rig.contact_stiffness, rig.contact_damping),
        ..PlantParameters::default()
    }
}

/// A programme as the simulator takes it.
pub fn inputs_of(programme: &Programme) -> PlantInputs {
    let time = programme.times.clone();
    PlantInputs {
        cell: None,
        motion: None,
        initial: InitialState::AtRest,
        place: 0,
        set_pressure: time.iter().map(|t| programme.set_pressure(*t)).collect(),
        extends: time.iter().map(|t| programme.extends(*t)).collect(),
        surface: time
            .iter()
            .map(|t| programme.surface.as_ref().map_or(f64::NAN, |s| s.at(*t)[0]))
            .collect(),
        time,
    }
}

/// Noise of usual sensors, in the order of the channels.
const NOISE: [f64; 4] = [400.0, 2e-5, 0.8, 0.15];

#[test]
fn with_nothing_concealed_it_agrees_with_the_simulator() {
    for seed in 0..8 {
        let nominal = NominalRig::draw(seed);
        let rig = nominal.real(seed);
        for programme in &nominal.programmes(seed, 5.0) {
            let ours = run(&rig, &Concealed::default(), programme).unwrap();
            let theirs = simulate(&plant_of(&rig), &inputs_of(programme)).readings;
            for channel in 0..4 {
                let mut off: Vec<f64> = ours.readings[channel]
                    .iter()
                    .zip(&theirs[channel])
                    .map(|(a, b)| (a - b).abs() / NOISE[channel])
                    .collect();
                off.sort_by(f64::total_cmp);
                // Impacts fall between samples, where a microsecond of timing is many standard deviations.
                let most = off[off.len() * 98 / 100];
                assert!(most < 0.6, "{seed} {} {channel}: {most}", programme.name);
                assert!(off[off.len() / 2] < 0.05);
            }
        }
    }
}

/// A recording that begins in mid-motion is followed from the end of the time in which its piston is held.
#[test]
fn a_recording_that_begins_in_mid_motion_is_followed_after_half_a_second() {
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(5);
    for seed in 0..8 {
        let nominal = NominalRig::draw(seed);
        let rig = nominal.real(seed);
        for mut programme in nominal.programmes(seed, 5.0) {
            let begins = 0.9 + 0.13 * seed as f64;
            programme.times.retain(|time| *time >= begins);
            let ours = run(&rig, &Concealed::default(), &programme)
                .unwrap()
                .readings;
            let mut noisy = |channel: usize| -> Vec<f64> {
                let noise = |value: &f64| {
                    let drawn: f64 = random.sample(StandardNormal);
                    value + NOISE[channel] * drawn
                };
                ours[channel].iter().map(noise).collect()
            };
            let mut inputs = inputs_of(&programme);
            let (pressure, stroke) = (noisy(0), noisy(1));
            inputs.initial = InitialState::of(&inputs.time, &pressure, &stroke);
            let held = inputs.initial.samples();
            assert!(held.abs_diff(125) < 2, "{held} {seed} {}", programme.name);
            let theirs = simulate(&plant_of(&rig), &inputs).readings;
            for channel in 0..4 {
                let most = bulk(&ours[channel][held..], &theirs[channel][held..], channel);
                println!("{seed} {} {channel} {most:.2}", programme.name);
                assert!(most < 1.0, "{seed} {} {channel}: {most}", programme.name);
            }
        }
    }
}

/// The same effect in the simulator, all its numbers as they are in the laboratory.
fn with_effect(rig: &LaboratoryRig, concealed: &Concealed, name: &str) -> PlantParameters {
    let mut plant = plant_of(rig);
    let device = &mut plant.device;
    if let Some(seals) = &concealed.seals {
        device.seal_friction = SealFriction {
            coulomb: seals.coulomb,
            static_force: seals.breakaway,
            stribeck_velocity: seals.stribeck_velocity,
            viscous: seals.viscous,
            presliding_displacement: seals.presliding,
            pressure_coefficient: seals.per_pressure,
        };
    }
    let swing = |plant: &mut PlantParameters| {
        let swing = &concealed.swings[0];
        let (sine, cosine) = swing.phase.sin_cos();
        let periodic = Periodic {
            sine: swing.amplitude * cosine,
            cosine: swing.amplitude * sine,
            frequency: swing.frequency,
            ..Periodic::NONE
        };
        if name == "tool_runout" {
            plant.contact.runout = periodic;
        } else {
            plant.contact.waviness = periodic;
        }
    };
    let sensors = &mut plant.sensors;
    match name {
        "return_spring_load" => device.axial_load.return_stiffness = concealed.spring,
        "axial_force_offset" => device.axial_load.force = concealed.axial_force,
        "end_cushioning" => {
            let [damping, length] = concealed.cushion.unwrap();
            device.end_cushioning = EndCushioning { damping, length };
        }
        "cross_piston_leakage" => device.leakage.cross_piston = concealed.cross_leak,
        "external_leakage" => device.leakage.external = concealed.external_leak,
        "heat_transfer" => {
            let conductance = concealed.wall_conductance.unwrap();
            device.gas_process = GasProcess::WallHeat { conductance };
        }
        "hose_volume" => {
            let [volume, resistance] = concealed.hose.unwrap();
            device.hose = Some(Hose::evenly_spread(volume, resistance));
        }
        "supply_droop" => {
            let [volume, flow] = concealed.reservoir.unwrap();
            device.supply_reservoir = Some(SupplyReservoir::new(volume, flow));
        }
        "transport_delay" => device.regulator.dead_time = concealed.dead_time,
        "regulator_hysteresis" => device.regulator.hysteresis = concealed.play,
        "regulator_rate_limit" => {
            let [rise, fall] = concealed.rate_limit.unwrap();
            device.regulator.rate_limit = RateLimit { rise, fall };
        }
        "regulator_second_order" => {
            let [natural_frequency, damping_ratio] = concealed.second_order.unwrap();
            device.regulator.second_order = Some(SecondOrder {
                natural_frequency,
                damping_ratio,
            });
        }
        "solenoid_switching_delay" => device.switching_delay = concealed.switching_delay,
        "hertzian_contact" => {
            let stiffness = concealed.hertz.unwrap();
            plant.contact.law = ContactLaw::Hertz { stiffness };
        }
        "tool_runout" | "surface_waviness" => swing(&mut plant),
        "surface_offset" => plant.contact.surface_offset = concealed.surface_offset,
        "force_sensor_bias_drift" => {
            [sensors.force_bias, sensors.force_drift] = concealed.force_bias;
        }
        "force_sensor_gain_error" => sensors.force_gain = concealed.force_gain,
        "force_sensor_lag" => sensors.force_lag = concealed.force_lag,
        "force_sensor_saturation" => sensors.force_limit = concealed.force_limit,
        "inertial_crosstalk" => sensors.crosstalk_mass = concealed.crosstalk,
        "stroke_sensor_gain_error" => sensors.stroke_gain = concealed.stroke_gain,
        "channel_time_offset" => sensors.force_delay = concealed.force_late,
        // Numbers of the rig itself, and friction.
        _ => (),
    }
    plant
}

/// Each effect means the same in both hands. What parts them is what the laboratory does richer: seals, and lines in more segments.
#[test]
fn effects_mean_the_same_in_the_laboratory_and_in_the_simulator() {
    for effect in &EFFECTS {
        let mut most = [0.0f64; 4];
        for seed in 0..3 {
            let recipe = Recipe {
                name: String::new(),
                seed,
                effects: vec![(effect.name, 0.5)],
                law: None,
                duration: 4.0,
                conditions: Conditions::default(),
            };
            let (rig, concealed, programmes) = recipe.reality().unwrap();
            let plant = with_effect(&rig, &concealed, effect.name);
            for programme in &programmes[..3] {
                let ours = run(&rig, &concealed, programme).unwrap().readings;
                let theirs = simulate(&plant, &inputs_of(programme)).readings;
                for channel in 0..4 {
                    most[channel] =
                        most[channel].max(bulk(&ours[channel], &theirs[channel], channel));
                }
            }
        }
        let allowed = match effect.name {
            // Sixteen segments here, eight there.
            "hose_volume" => 1.5,
            "presliding_hysteresis" => 1.5,
            // Seals that are elastic at first, and damped while they bend.
            name if name.contains("friction") => 20.0,
            _ => 0.5,
        };
        println!("{} {most:.2?}", effect.name);
        assert!(
            most.iter().all(|m| *m < allowed),
            "{} {most:.2?}",
            effect.name
        );
    }
}

/// The difference that 95 % of the samples stay below, in standard deviations of a usual sensor.
fn bulk(ours: &[f64], theirs: &[f64], channel: usize) -> f64 {
    let pairs = ours.iter().zip(theirs);
    let mut off: Vec<f64> = pairs.map(|(a, b)| (a - b).abs() / NOISE[channel]).collect();
    off.sort_by(f64::total_cmp);
    off[off.len() * 95 / 100]
}

//! The laboratory against the simulator that a diagnosis fits: with nothing concealed they are the same device in two hands.

use idc_cell::device::DeviceParameters;
use idc_cell::laboratory::{Believed, Concealed, Programme, Rig, run};
use idc_cell::physics::gas::Gas;
use idc_cell::physics::push_only::PushOnly;
use idc_cell::physics::regulator::RegulatorParameters;
use idc_cell::plant::{
    ContactLaw, ContactParameters, Periodic, PlantInputs, PlantParameters, SensorErrors, simulate,
};

/// The same device in the simulator's own description.
pub fn plant_of(rig: &Rig) -> PlantParameters {
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
        contact: ContactParameters {
            law: ContactLaw::Linear {
                stiffness: rig.contact_stiffness,
            },
            damping: rig.contact_damping,
            surface_offset: 0.0,
            runout: Periodic::NONE,
            waviness: Periodic::NONE,
        },
        sensors: SensorErrors::NONE,
    }
}

pub fn inputs_of(programme: &Programme) -> PlantInputs {
    let time = programme.times.clone();
    PlantInputs {
        set_pressure: time.iter().map(|t| programme.set_pressure(*t)).collect(),
        extends: time.iter().map(|t| programme.extends(*t)).collect(),
        surface: time
            .iter()
            .map(|t| programme.surface.as_ref().map_or(f64::NAN, |s| s.at(*t)[0]))
            .collect(),
        time,
    }
}

#[test]
fn with_nothing_concealed_it_agrees_with_the_simulator() {
    const NOISE: [f64; 4] = [400.0, 2e-5, 0.8, 0.15];
    for seed in 0..8 {
        let believed = Believed::draw(seed);
        let rig = believed.real(seed);
        for programme in &believed.programmes(seed, 5.0) {
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

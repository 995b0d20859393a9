//! Optional parts of a device, by their keys: each reaches its field in SI, and what cannot be is refused.

use super::{MINIMAL_BENCH, message, read_bench};
use crate::device::DeviceParameters;
use crate::physics::axial_load::AxialLoad;
use crate::physics::end_cushioning::EndCushioning;
use crate::physics::hose::Hose;
use crate::physics::leakage::Leakage;
use crate::physics::regulator::{RateLimit, RegulatorParameters, SecondOrder};
use crate::physics::seal_friction::SealFriction;
use crate::physics::supply_reservoir::SupplyReservoir;

fn with(keys: &str) -> String {
    format!("{MINIMAL_BENCH}[device.override]\n{keys}\n")
}

#[test]
fn every_key_of_what_is_off_by_default_reaches_its_field() {
    let keys = "valve_switching_delay_ms = 15\ncross_piston_leak_mm2 = 0.05\nexternal_leak_mm2 = 0.2\nregulator_hysteresis_pa = 6000\n\
        regulator_rise_limit_pa_per_s = 4e5\nregulator_fall_limit_pa_per_s = 3e5\nregulator_natural_frequency_rad_per_s = 30\n\
        regulator_damping_ratio = 0.4\nsupply_reservoir_volume_cm3 = 800\nsupply_reservoir_pressure_pa_absolute = 6.5e5\n\
        compressor_flow_kg_per_s = 3e-4\nend_cushioning_damping_n_s_per_m = 700\nend_cushioning_length_mm = 8\naxial_load_n = -12\n\
        return_stiffness_n_per_m = 300\nseal_pressure_coefficient_n_per_pa = 2e-5\nhose_volume_cm3 = 40\nhose_resistance_pa_s_per_kg = 2e7";
    let expected = DeviceParameters {
        switching_delay: 0.015,
        leakage: Leakage {
            cross_piston: 0.05 / 1e6,
            external: 0.2 / 1e6,
        },
        regulator: RegulatorParameters {
            hysteresis: 6e3,
            rate_limit: RateLimit {
                rise: 4e5,
                fall: 3e5,
            },
            second_order: Some(SecondOrder {
                natural_frequency: 30.0,
                damping_ratio: 0.4,
            }),
            ..RegulatorParameters::default()
        },
        supply_reservoir: Some(SupplyReservoir {
            volume: 8e-4,
            full_pressure: 6.5e5,
            compressor_flow: 3e-4,
        }),
        end_cushioning: EndCushioning {
            damping: 700.0,
            length: 8e-3,
        },
        axial_load: AxialLoad {
            force: -12.0,
            return_stiffness: 300.0,
        },
        seal_friction: SealFriction {
            pressure_coefficient: 2e-5,
            ..SealFriction::NONE
        },
        hose: Some(Hose::lumped(4e-5, 2e7)),
        ..DeviceParameters::default()
    };
    let text = with(keys).replace("[device]\n", "[device]\nideal = true\n");
    let read = read_bench(&text).unwrap();
    assert_eq!(read.nominal.device, expected);
}

#[test]
fn what_contradicts_itself_is_refused_by_name() {
    for (keys, words) in [
        (
            "hose_volume_cm3 = 40\nhose_resistance_pa_s_per_kg = 2e7\nhose_length_m = 1",
            "`device.override.hose_volume_cm3` is 40 cm3, expected 0 beside a hose_length_m, which says the volume",
        ),
        (
            "hose_volume_cm3 = 40",
            "`device.hose_resistance_pa_s_per_kg` is 0 Pa s/kg, expected more than 0 with a hose_volume_cm3, and 0 without one",
        ),
        (
            "hose_resistance_pa_s_per_kg = 2e7",
            "`device.override.hose_resistance_pa_s_per_kg` is 20000000 Pa s/kg, expected more than 0 with a hose_volume_cm3, and 0 without one",
        ),
        (
            "supply_reservoir_volume_cm3 = 1",
            "`device.override.supply_reservoir_volume_cm3` is 1 cm3, expected 0 for none, or 10 to 1000000 cm3",
        ),
        (
            "regulator_natural_frequency_rad_per_s = 0.01",
            "`device.override.regulator_natural_frequency_rad_per_s` is 0.01 rad/s, expected 0 for none, or 0.1 to 1000 rad/s",
        ),
    ] {
        let message = message(&with(keys));
        assert!(message.ends_with(words), "{message}");
    }
}

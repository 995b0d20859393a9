//! The effects that are known.
#![allow(clippy::too_many_lines)]
use super::effect::*;
use super::quantity::{Coordinate, Coordinate::*, Quantity};
use crate::physics::gas_process::GasProcess;
use crate::physics::hose::Hose;
use crate::physics::regulator::SecondOrder;
use crate::physics::supply_reservoir::SupplyReservoir;
use crate::plant::*;

macro_rules! quantity {
    ($name:literal, $p:ident => $($place:tt)+) => { Quantity { name: $name, get: |$p| $($place)+, set: |$p, value| $($place)+ = value } };
}
fn reported(quantity: Quantity, coordinate: Coordinate, bounds: [f64; 2]) -> Parameter {
    Parameter {
        quantity,
        coordinate,
        bounds,
        reported: true,
        choices: &[],
    }
}
fn hidden(quantity: Quantity, coordinate: Coordinate, bounds: [f64; 2]) -> Parameter {
    Parameter {
        quantity,
        coordinate,
        bounds,
        reported: false,
        choices: &[],
    }
}

const COULOMB: Quantity = Quantity {
    name: "coulomb_force_n",
    get: |p| p.device.seal_friction.coulomb,
    set: |p, v| {
        let s = &mut p.device.seal_friction;
        let extra = s.static_force - s.coulomb;
        s.coulomb = v;
        s.static_force = v + extra;
    },
};
const STATIC: Quantity = Quantity {
    name: "static_force_n",
    get: |p| p.device.seal_friction.static_force,
    set: |p, v| {
        let s = &mut p.device.seal_friction;
        s.static_force = v.max(s.coulomb);
    },
};
const STRIBECK: Quantity =
    quantity!("stribeck_velocity_m_per_s", p => p.device.seal_friction.stribeck_velocity);
const VISCOUS: Quantity =
    quantity!("viscous_coefficient_n_s_per_m", p => p.device.seal_friction.viscous);
const PRESLIDING: Quantity =
    quantity!("presliding_displacement_m", p => p.device.seal_friction.presliding_displacement);
pub const STIFFNESS: Quantity = Quantity {
    name: "stiffness_n_per_m",
    get: |p| match p.contact.law {
        ContactLaw::Linear { stiffness } | ContactLaw::Hertz { stiffness } => stiffness,
    },
    set: |p, v| {
        p.contact.law = match p.contact.law {
            ContactLaw::Linear { .. } => ContactLaw::Linear { stiffness: v },
            ContactLaw::Hertz { .. } => ContactLaw::Hertz { stiffness: v },
        }
    },
};
const HERTZ: Quantity = Quantity {
    name: "stiffness_n_per_m15",
    get: |p| match p.contact.law {
        ContactLaw::Hertz { stiffness } => stiffness,
        ContactLaw::Linear { .. } => 0.0,
    },
    set: |p, v| p.contact.law = ContactLaw::Hertz { stiffness: v },
};
fn wall(p: &PlantParameters) -> f64 {
    match p.device.gas_process {
        GasProcess::WallHeat { conductance } => conductance,
        GasProcess::Isothermal => f64::INFINITY,
    }
}

const RISE: Quantity = quantity!("rise_pa_per_s", p => p.device.regulator.rate_limit.rise);
const FALL: Quantity = quantity!("fall_pa_per_s", p => p.device.regulator.rate_limit.fall);
fn oscillator(p: &PlantParameters) -> SecondOrder {
    p.device.regulator.second_order.unwrap_or(SecondOrder {
        natural_frequency: 1.0 / p.device.regulator.time_constant,
        damping_ratio: 1.0,
    })
}
/// Volume [m3], resistance [Pa s/kg] at its smallest flows, and segments of the line; where there is none, of one to begin with.
fn line(p: &PlantParameters) -> (f64, f64, usize) {
    p.device.hose.map_or((1e-5, 1e8, 2), |h| {
        let resistance = h.resistance_at_rest(p.device.gas.atmosphere);
        (h.volume, resistance, h.segments())
    })
}
fn set_line(p: &mut PlantParameters, (volume, resistance, segments): (f64, f64, usize)) {
    p.device.hose = Some(Hose::in_segments(volume, resistance, segments));
}
fn reservoir(p: &PlantParameters) -> SupplyReservoir {
    p.device
        .supply_reservoir
        .unwrap_or_else(|| SupplyReservoir::new(1e-3, 1e-3))
}
const FREQUENCY: Quantity = Quantity {
    name: "natural_frequency_rad_per_s",
    get: |p| oscillator(p).natural_frequency,
    set: |p, v| {
        p.device.regulator.second_order = Some(SecondOrder {
            natural_frequency: v,
            ..oscillator(p)
        })
    },
};
const DAMPING_RATIO: Quantity = Quantity {
    name: "damping_ratio",
    get: |p| oscillator(p).damping_ratio,
    set: |p, v| {
        p.device.regulator.second_order = Some(SecondOrder {
            damping_ratio: v,
            ..oscillator(p)
        })
    },
};
const RESERVOIR: Quantity = Quantity {
    name: "reservoir_volume_m3",
    get: |p| reservoir(p).volume,
    set: |p, v| {
        p.device.supply_reservoir = Some(SupplyReservoir {
            volume: v,
            ..reservoir(p)
        })
    },
};
const COMPRESSOR: Quantity = Quantity {
    name: "compressor_flow_kg_per_s",
    get: |p| reservoir(p).compressor_flow,
    set: |p, v| {
        p.device.supply_reservoir = Some(SupplyReservoir {
            compressor_flow: v,
            ..reservoir(p)
        })
    },
};

const FAR: f64 = 1e3;

fn friction_parameters(first: &[Parameter], rest: &[Parameter]) -> Vec<Parameter> {
    first.iter().chain(rest).copied().collect()
}

/// All effects.
pub static CATALOGUE: &[Effect] = &[
    Effect {
        name: "coulomb_viscous_friction",
        subsystem: Subsystem::ForceBalance,
        group: Some("friction"),
        parameters: |_| {
            friction_parameters(
                &[
                    reported(COULOMB, Logarithmic, [0.05, 500.0]),
                    reported(VISCOUS, Linear(20.0), [0.0, 5000.0]),
                ],
                &[hidden(PRESLIDING, Logarithmic, [2e-6, 3e-4])],
            )
        },
        starts: |_| {
            vec![
                vec![3.0, 20.0, 5e-5],
                vec![10.0, 60.0, 5e-5],
                vec![30.0, 100.0, 5e-5],
            ]
        },
    },
    Effect {
        name: "stribeck_friction",
        subsystem: Subsystem::ForceBalance,
        group: Some("friction"),
        parameters: |_| {
            vec![
                reported(COULOMB, Logarithmic, [0.05, 500.0]),
                reported(
                    Quantity {
                        name: "static_force_n",
                        ..STATIC
                    },
                    Linear(5.0),
                    [0.05, 1000.0],
                ),
                reported(STRIBECK, Logarithmic, [5e-4, 0.2]),
                hidden(VISCOUS, Linear(20.0), [0.0, 5000.0]),
                hidden(PRESLIDING, Logarithmic, [2e-6, 3e-4]),
            ]
        },
        starts: |_| {
            vec![
                vec![4.0, 8.0, 0.008, 30.0, 5e-5],
                vec![8.0, 16.0, 0.008, 40.0, 5e-5],
                vec![8.0, 16.0, 0.03, 40.0, 5e-5],
            ]
        },
    },
    Effect {
        name: "presliding_hysteresis",
        subsystem: Subsystem::ForceBalance,
        group: Some("friction"),
        parameters: |_| {
            vec![
                reported(COULOMB, Logarithmic, [0.05, 500.0]),
                reported(PRESLIDING, Logarithmic, [1e-4, 1e-2]),
                hidden(VISCOUS, Linear(20.0), [0.0, 5000.0]),
            ]
        },
        starts: |_| {
            vec![
                vec![8.0, 5e-4, 30.0],
                vec![20.0, 5e-4, 40.0],
                vec![8.0, 2e-3, 30.0],
                vec![20.0, 2e-3, 40.0],
            ]
        },
    },
    Effect {
        name: "pressure_dependent_friction",
        subsystem: Subsystem::ForceBalance,
        group: Some("friction"),
        parameters: |_| {
            vec![
                reported(
                    quantity!("friction_per_pressure_n_per_pa", p => p.device.seal_friction.pressure_coefficient),
                    Logarithmic,
                    [1e-7, 1e-2],
                ),
                hidden(COULOMB, Linear(3.0), [0.0, 500.0]),
                hidden(VISCOUS, Linear(20.0), [0.0, 5000.0]),
                hidden(PRESLIDING, Logarithmic, [2e-6, 3e-4]),
            ]
        },
        starts: |_| vec![vec![3e-5, 2.0, 30.0, 5e-5], vec![1e-4, 3.0, 40.0, 5e-5]],
    },
    Effect {
        name: "return_spring_load",
        subsystem: Subsystem::ForceBalance,
        group: None,
        parameters: |_| {
            vec![reported(
                quantity!("stiffness_n_per_m", p => p.device.axial_load.return_stiffness),
                Linear(100.0),
                [-5e4, 5e4],
            )]
        },
        starts: |_| vec![vec![0.0]],
    },
    Effect {
        name: "axial_force_offset",
        subsystem: Subsystem::ForceBalance,
        group: None,
        parameters: |_| {
            vec![reported(
                quantity!("force_n", p => p.device.axial_load.force),
                Linear(2.0),
                [-500.0, 500.0],
            )]
        },
        starts: |_| vec![vec![0.0]],
    },
    Effect {
        name: "end_cushioning",
        subsystem: Subsystem::ForceBalance,
        group: None,
        parameters: |_| {
            vec![
                reported(
                    quantity!("damping_n_s_per_m", p => p.device.end_cushioning.damping),
                    Logarithmic,
                    [5.0, 1e5],
                ),
                reported(
                    quantity!("length_m", p => p.device.end_cushioning.length),
                    Logarithmic,
                    [2e-4, 0.025],
                ),
            ]
        },
        starts: |_| {
            vec![
                vec![300.0, 0.004],
                vec![300.0, 0.01],
                vec![1500.0, 0.004],
                vec![1500.0, 0.01],
            ]
        },
    },
    Effect {
        name: "cross_piston_leakage",
        subsystem: Subsystem::Chambers,
        group: None,
        parameters: |_| {
            vec![reported(
                quantity!("orifice_area_m2", p => p.device.leakage.cross_piston),
                Logarithmic,
                [1e-10, 1e-4],
            )]
        },
        starts: |c| {
            let a = c.plant.device.supply_orifice;
            [0.01, 0.05, 0.2].iter().map(|f| vec![f * a]).collect()
        },
    },
    Effect {
        name: "external_leakage",
        subsystem: Subsystem::Chambers,
        group: None,
        parameters: |_| {
            vec![reported(
                quantity!("orifice_area_m2", p => p.device.leakage.external),
                Logarithmic,
                [1e-10, 1e-4],
            )]
        },
        starts: |c| {
            let a = c.plant.device.supply_orifice;
            [0.01, 0.05, 0.2].iter().map(|f| vec![f * a]).collect()
        },
    },
    Effect {
        name: "supply_droop",
        subsystem: Subsystem::Chambers,
        group: None,
        parameters: |_| {
            vec![
                reported(RESERVOIR, Logarithmic, [1e-5, 0.1]),
                reported(COMPRESSOR, Logarithmic, [1e-6, 0.1]),
            ]
        },
        starts: |_| {
            vec![
                vec![1e-4, 5e-5],
                vec![1e-4, 2e-4],
                vec![4e-4, 5e-5],
                vec![4e-4, 2e-4],
                vec![1.5e-3, 1e-4],
            ]
        },
    },
    Effect {
        name: "regulator_hysteresis",
        subsystem: Subsystem::Regulator,
        group: None,
        parameters: |_| {
            vec![reported(
                quantity!("half_width_pa", p => p.device.regulator.hysteresis),
                Logarithmic,
                [10.0, 2e5],
            )]
        },
        starts: |_| [2e3, 6e3, 15e3].iter().map(|v| vec![*v]).collect(),
    },
    Effect {
        name: "regulator_rate_limit",
        subsystem: Subsystem::Regulator,
        group: None,
        parameters: |_| {
            vec![
                reported(RISE, Logarithmic, [1e3, 1e8]),
                reported(FALL, Logarithmic, [1e3, 1e8]),
            ]
        },
        starts: |_| vec![vec![4e5, 4e5], vec![1.2e6, 4e5], vec![4e5, 1.2e6]],
    },
    Effect {
        name: "regulator_second_order",
        subsystem: Subsystem::Regulator,
        group: None,
        parameters: |_| {
            vec![
                reported(FREQUENCY, Logarithmic, [0.5, 500.0]),
                reported(DAMPING_RATIO, Logarithmic, [0.02, 5.0]),
            ]
        },
        starts: |c| {
            let w = 1.0 / c.plant.device.regulator.time_constant;
            vec![vec![1.5 * w, 0.6], vec![1.5 * w, 0.3], vec![4.0 * w, 0.4]]
        },
    },
    Effect {
        name: "solenoid_switching_delay",
        subsystem: Subsystem::Regulator,
        group: None,
        parameters: |_| {
            vec![reported(
                quantity!("delay_s", p => p.device.switching_delay),
                Logarithmic,
                [1e-3, 1.0],
            )]
        },
        starts: |_| [0.01, 0.03, 0.08].iter().map(|v| vec![*v]).collect(),
    },
    Effect {
        name: "moving_mass_error",
        subsystem: Subsystem::ForceBalance,
        group: None,
        parameters: |p| {
            let m = p.device.moving_mass;
            vec![reported(
                quantity!("mass_kg", p => p.device.moving_mass),
                Logarithmic,
                [0.2 * m, 5.0 * m],
            )]
        },
        starts: |c| {
            let a = c.plant.device.moving_mass;
            [0.6, 0.8, 0.92, 1.08, 1.25, 1.7]
                .iter()
                .map(|f| vec![f * a])
                .collect()
        },
    },
    Effect {
        name: "heat_transfer",
        subsystem: Subsystem::Chambers,
        group: None,
        parameters: |_| {
            vec![reported(
                Quantity {
                    name: "wall_conductance_w_per_k",
                    get: wall,
                    set: |p, v| p.device.gas_process = GasProcess::WallHeat { conductance: v },
                },
                Logarithmic,
                [1e-3, 10.0],
            )]
        },
        starts: |_| [0.01, 0.05, 0.2, 0.8].iter().map(|v| vec![*v]).collect(),
    },
    Effect {
        name: "exhaust_restriction",
        subsystem: Subsystem::Chambers,
        group: None,
        parameters: |p| {
            let a = p.device.exhaust_orifice;
            vec![reported(
                quantity!("orifice_area_m2", p => p.device.exhaust_orifice),
                Logarithmic,
                [0.05 * a, 20.0 * a],
            )]
        },
        starts: |c| {
            let a = c.plant.device.exhaust_orifice;
            [0.35, 0.55, 0.8, 1.25, 1.8, 3.0]
                .iter()
                .map(|f| vec![f * a])
                .collect()
        },
    },
    Effect {
        name: "supply_restriction",
        subsystem: Subsystem::Chambers,
        group: None,
        parameters: |p| {
            let a = p.device.supply_orifice;
            vec![reported(
                quantity!("orifice_area_m2", p => p.device.supply_orifice),
                Logarithmic,
                [0.05 * a, 20.0 * a],
            )]
        },
        starts: |c| {
            let a = c.plant.device.supply_orifice;
            [0.35, 0.55, 0.8, 1.25, 1.8, 3.0]
                .iter()
                .map(|f| vec![f * a])
                .collect()
        },
    },
    Effect {
        name: "extra_dead_volume",
        subsystem: Subsystem::Chambers,
        group: None,
        parameters: |p| {
            let a = p.device.dead_volume;
            vec![reported(
                quantity!("dead_volume_m3", p => p.device.dead_volume),
                Logarithmic,
                [0.1 * a, 20.0 * a],
            )]
        },
        starts: |c| {
            let a = c.plant.device.dead_volume;
            [0.35, 0.55, 0.8, 1.25, 1.8, 3.0]
                .iter()
                .map(|f| vec![f * a])
                .collect()
        },
    },
    Effect {
        name: "hose_volume",
        subsystem: Subsystem::Chambers,
        group: None,
        parameters: |_| {
            vec![
                reported(
                    Quantity {
                        name: "volume_m3",
                        get: |p| p.device.hose.map_or(0.0, |h| h.volume),
                        set: |p, v| set_line(p, (v, line(p).1, line(p).2)),
                    },
                    Logarithmic,
                    [1e-6, 2e-3],
                ),
                reported(
                    Quantity {
                        name: "resistance_pa_s_per_kg",
                        get: |p| p.device.hose.map_or(0.0, |_| line(p).1),
                        set: |p, v| set_line(p, (line(p).0, v, line(p).2)),
                    },
                    Logarithmic,
                    [1e6, 5e9],
                ),
                Parameter {
                    choices: &[1.0, 2.0, 3.0, 4.0, 8.0],
                    ..hidden(
                        Quantity {
                            name: "segments",
                            get: |p| p.device.hose.map_or(0.0, |h| h.segments() as f64),
                            set: |p, v| set_line(p, (line(p).0, line(p).1, v.round() as usize)),
                        },
                        Linear(1.0),
                        [1.0, 8.0],
                    )
                },
            ]
        },
        starts: |_| {
            vec![
                vec![2e-5, 3e7, 2.0],
                vec![5e-5, 5e7, 2.0],
                vec![5e-5, 3e8, 2.0],
                vec![1.5e-4, 5e7, 2.0],
                vec![1.5e-4, 3e8, 2.0],
                vec![4e-4, 1e8, 2.0],
            ]
        },
    },
    Effect {
        name: "transport_delay",
        subsystem: Subsystem::Regulator,
        group: None,
        parameters: |_| {
            vec![reported(
                quantity!("delay_s", p => p.device.regulator.dead_time),
                Logarithmic,
                [5e-4, 2.0],
            )]
        },
        starts: |_| [0.01, 0.03, 0.1, 0.25].iter().map(|v| vec![*v]).collect(),
    },
    Effect {
        name: "regulator_gain_error",
        subsystem: Subsystem::Regulator,
        group: None,
        parameters: |p| {
            let g = p.device.regulator.gain;
            vec![reported(
                quantity!("gain", p => p.device.regulator.gain),
                Logarithmic,
                [0.3 * g, 3.0 * g],
            )]
        },
        starts: |c| {
            let g = c.plant.device.regulator.gain;
            vec![vec![0.97 * g], vec![1.03 * g]]
        },
    },
    Effect {
        name: "contact_stiffness_error",
        subsystem: Subsystem::Contact,
        group: Some("contact_law"),
        parameters: |p| {
            let k = (STIFFNESS.get)(p);
            vec![reported(STIFFNESS, Logarithmic, [0.01 * k, 50.0 * k])]
        },
        starts: |c| {
            let a = (STIFFNESS.get)(c.plant);
            [0.1, 0.25, 0.5, 0.8, 1.25, 2.5]
                .iter()
                .map(|f| vec![f * a])
                .collect()
        },
    },
    Effect {
        name: "hertzian_contact",
        subsystem: Subsystem::Contact,
        group: Some("contact_law"),
        parameters: |_| vec![reported(HERTZ, Logarithmic, [1e5, 1e10])],
        starts: |c| {
            let k = (STIFFNESS.get)(c.plant);
            let d = 120.0 / k;
            let a = 120.0 / d.powf(1.5);
            [0.2, 0.5, 1.0, 2.5].iter().map(|f| vec![f * a]).collect()
        },
    },
    Effect {
        name: "tool_runout",
        subsystem: Subsystem::Contact,
        group: None,
        parameters: |_| {
            vec![
                reported(
                    quantity!("frequency_hz", p => p.contact.runout.frequency),
                    Linear(0.02),
                    [11.0, 200.0],
                ),
                hidden(
                    quantity!("sine_m", p => p.contact.runout.sine),
                    Linear(2e-5),
                    [-0.01, 0.01],
                ),
                hidden(
                    quantity!("cosine_m", p => p.contact.runout.cosine),
                    Linear(2e-5),
                    [-0.01, 0.01],
                ),
            ]
        },
        starts: |c| {
            c.periodic
                .iter()
                .filter(|f| **f >= 11.0)
                .take(2)
                .flat_map(|f| [vec![*f, 1e-5, 0.0], vec![*f, 0.0, 1e-5]])
                .collect()
        },
    },
    Effect {
        name: "surface_waviness",
        subsystem: Subsystem::Contact,
        group: None,
        parameters: |_| {
            vec![
                reported(
                    quantity!("frequency_hz", p => p.contact.waviness.frequency),
                    Linear(0.02),
                    [0.3, 11.0],
                ),
                hidden(
                    quantity!("sine_m", p => p.contact.waviness.sine),
                    Linear(2e-5),
                    [-0.02, 0.02],
                ),
                hidden(
                    quantity!("cosine_m", p => p.contact.waviness.cosine),
                    Linear(2e-5),
                    [-0.02, 0.02],
                ),
            ]
        },
        starts: |c| {
            c.periodic
                .iter()
                .filter(|f| **f < 11.0)
                .take(2)
                .flat_map(|f| [vec![*f, 1e-5, 0.0], vec![*f, 0.0, 1e-5]])
                .collect()
        },
    },
    Effect {
        name: "surface_offset",
        subsystem: Subsystem::Contact,
        group: None,
        parameters: |_| {
            vec![reported(
                quantity!("offset_m", p => p.contact.surface_offset),
                Linear(5e-4),
                [-0.02, 0.02],
            )]
        },
        starts: |_| {
            [-2e-3, -6e-4, 6e-4, 2e-3]
                .iter()
                .map(|v| vec![*v])
                .collect()
        },
    },
    Effect {
        name: "force_sensor_bias_drift",
        subsystem: Subsystem::Sensors,
        group: None,
        parameters: |_| {
            vec![
                reported(
                    quantity!("bias_n", p => p.sensors.force_bias),
                    Linear(1.0),
                    [-FAR, FAR],
                ),
                reported(
                    quantity!("drift_n_per_s", p => p.sensors.force_drift),
                    Linear(0.1),
                    [-FAR, FAR],
                ),
            ]
        },
        starts: |_| vec![vec![0.0, 0.0]],
    },
    Effect {
        name: "force_sensor_gain_error",
        subsystem: Subsystem::Sensors,
        group: None,
        parameters: |_| {
            vec![reported(
                quantity!("gain", p => p.sensors.force_gain),
                Linear(0.02),
                [0.2, 5.0],
            )]
        },
        starts: |_| vec![vec![1.0]],
    },
    Effect {
        name: "force_sensor_lag",
        subsystem: Subsystem::Sensors,
        group: None,
        parameters: |_| {
            vec![reported(
                quantity!("time_constant_s", p => p.sensors.force_lag),
                Logarithmic,
                [1e-4, 2.0],
            )]
        },
        starts: |_| [3e-3, 0.01, 0.03, 0.1].iter().map(|v| vec![*v]).collect(),
    },
    Effect {
        name: "force_sensor_saturation",
        subsystem: Subsystem::Sensors,
        group: None,
        parameters: |c| {
            let _ = c;
            vec![reported(
                quantity!("limit_n", p => p.sensors.force_limit),
                Linear(2.0),
                [5.0, 5000.0],
            )]
        },
        starts: |c| vec![vec![c.largest_force]],
    },
    Effect {
        name: "inertial_crosstalk",
        subsystem: Subsystem::Sensors,
        group: None,
        parameters: |_| {
            vec![reported(
                quantity!("mass_kg", p => p.sensors.crosstalk_mass),
                Linear(0.1),
                [-20.0, 20.0],
            )]
        },
        starts: |_| vec![vec![0.0]],
    },
    Effect {
        name: "stroke_sensor_gain_error",
        subsystem: Subsystem::Sensors,
        group: None,
        parameters: |_| {
            vec![reported(
                quantity!("gain", p => p.sensors.stroke_gain),
                Linear(0.01),
                [0.2, 5.0],
            )]
        },
        starts: |_| vec![vec![1.0]],
    },
    Effect {
        name: "channel_time_offset",
        subsystem: Subsystem::Sensors,
        group: None,
        parameters: |_| {
            vec![reported(
                quantity!("offset_s", p => p.sensors.force_delay),
                Linear(0.005),
                [-0.5, 0.5],
            )]
        },
        starts: |_| {
            [4e-3, 0.015, 0.04, -0.01]
                .iter()
                .map(|v| vec![*v])
                .collect()
        },
    },
];

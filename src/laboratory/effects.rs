//! The effects that the laboratory can conceal, each at a share of the largest that is plausible.
//!
//! The share is that of the departure from the nominal model: of a gain or an orifice its departure from the nominal one. Where a large number means
//! little of an effect (a wall that conducts well, a large reservoir), it is the largest effect's number over the share. The least share of a sweep
//! is that at which all that an effect moves is lost in the noise (`sizes`).

use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::concealed::{Concealed, Seals, Swing};
use super::rig::LaboratoryRig;

/// An effect.
#[derive(Debug, Clone, Copy)]
pub struct LabEffect {
    /// Its name; of a listed one, the vocabulary's.
    pub name: &'static str,
    /// Where it enters.
    pub subsystem: &'static str,
    /// Of an unlisted one: what it depends on.
    pub depends_on: &'static [&'static str],
    /// Conceals it and says its numbers.
    pub(super) conceal: fn(&mut Scene<'_>) -> Vec<(&'static str, f64)>,
}

/// Context from which an effect is drawn.
pub(super) struct Scene<'a> {
    /// Random numbers.
    pub rng: &'a mut ChaCha8Rng,
    /// The nominal device.
    pub nominal: &'a LaboratoryRig,
    /// Largest force without the effect [N].
    pub peak_force: f64,
    /// Share of the largest plausible effect [1].
    pub share: f64,
    /// Where it is put.
    pub concealed: &'a mut Concealed,
}

impl Scene<'_> {
    /// The largest plausible departure brought to size, up to a fifth up or down.
    fn sized(&mut self, largest: f64) -> f64 {
        self.by_power(largest, 1.0)
    }

    /// As `sized`, by another power of the share: a negative one where a large number means little.
    fn by_power(&mut self, largest: f64, power: f64) -> f64 {
        largest * self.share.powf(power) * self.about(1.0)
    }

    /// A number up to a fifth up or down.
    fn about(&mut self, value: f64) -> f64 {
        value * self.rng.random_range(0.8..1.2)
    }

    fn sign(&mut self) -> f64 {
        if self.rng.random_bool(0.5) { 1.0 } else { -1.0 }
    }

    fn phase(&mut self) -> f64 {
        self.rng.random_range(0.0..std::f64::consts::TAU)
    }

    /// Seals of a Coulomb [N] and a viscous friction [N s/m].
    fn seals(&mut self, coulomb: f64, viscous: f64) -> Seals {
        Seals {
            coulomb,
            breakaway: coulomb,
            stribeck_velocity: 0.01,
            viscous,
            presliding: self.about(2e-5),
            per_pressure: 0.0,
            elastic_share: 0.4,
        }
    }

    /// A number of the rig, off by a factor of this logarithm at its largest.
    fn off(&mut self, nominal: f64, largest: f64) -> f64 {
        let sign = self.sign();
        nominal * (sign * self.sized(largest)).exp()
    }
}

const fn listed(
    name: &'static str,
    subsystem: &'static str,
    conceal: fn(&mut Scene<'_>) -> Vec<(&'static str, f64)>,
) -> LabEffect {
    LabEffect {
        name,
        subsystem,
        depends_on: &[],
        conceal,
    }
}

/// The effects of the vocabulary.
pub static EFFECTS: [LabEffect; 34] = [
    listed("coulomb_viscous_friction", "force_balance", |s| {
        let (coulomb, viscous) = (s.sized(24.0), s.sized(90.0));
        s.concealed.seals = Some(s.seals(coulomb, viscous));
        vec![
            ("coulomb_force_n", coulomb),
            ("viscous_coefficient_n_s_per_m", viscous),
        ]
    }),
    listed("stribeck_friction", "force_balance", |s| {
        let (coulomb, viscous) = (s.sized(10.0), s.sized(40.0));
        let breakaway = coulomb * s.about(2.0);
        let stribeck_velocity = s.about(0.012);
        let seals = s.seals(coulomb, viscous);
        s.concealed.seals = Some(Seals {
            breakaway,
            stribeck_velocity,
            ..seals
        });
        vec![
            ("coulomb_force_n", coulomb),
            ("static_force_n", breakaway),
            ("stribeck_velocity_m_per_s", stribeck_velocity),
        ]
    }),
    listed("presliding_hysteresis", "force_balance", |s| {
        let (coulomb, viscous) = (s.sized(24.0), s.sized(40.0));
        let presliding = s.about(8e-4);
        let seals = s.seals(coulomb, viscous);
        s.concealed.seals = Some(Seals {
            presliding,
            elastic_share: 0.0,
            ..seals
        });
        vec![
            ("coulomb_force_n", coulomb),
            ("presliding_displacement_m", presliding),
        ]
    }),
    listed("pressure_dependent_friction", "force_balance", |s| {
        let (coulomb, viscous) = (s.sized(2.5), s.sized(40.0));
        let per_pressure = s.sized(1.2e-4);
        let seals = s.seals(coulomb, viscous);
        s.concealed.seals = Some(Seals {
            per_pressure,
            ..seals
        });
        vec![("friction_per_pressure_n_per_pa", per_pressure)]
    }),
    listed("return_spring_load", "force_balance", |s| {
        s.concealed.spring = s.sized(900.0);
        vec![("stiffness_n_per_m", s.concealed.spring)]
    }),
    listed("axial_force_offset", "force_balance", |s| {
        let (force, sign) = (s.sized(15.0), s.sign());
        // A device that is pulled off its stop does not start at rest.
        let rests = s.nominal.weight() + force < -1.0;
        s.concealed.axial_force = if rests { sign * force } else { -force };
        vec![("force_n", s.concealed.axial_force)]
    }),
    listed("moving_mass_error", "force_balance", |s| {
        let mass = s.off(s.nominal.mass, 0.35);
        s.concealed.mass = Some(mass);
        vec![("mass_kg", mass)]
    }),
    listed("end_cushioning", "force_balance", |s| {
        let (damping, length) = (s.sized(700.0), s.about(6e-3));
        s.concealed.cushion = Some([damping, length]);
        vec![("damping_n_s_per_m", damping), ("length_m", length)]
    }),
    listed("cross_piston_leakage", "chambers", |s| {
        s.concealed.cross_leak = s.sized(0.25 * s.nominal.supply_orifice);
        vec![("orifice_area_m2", s.concealed.cross_leak)]
    }),
    listed("external_leakage", "chambers", |s| {
        s.concealed.external_leak = s.sized(0.3 * s.nominal.supply_orifice);
        vec![("orifice_area_m2", s.concealed.external_leak)]
    }),
    // From nearly adiabatic towards isothermal.
    listed("heat_transfer", "chambers", |s| {
        let conductance = s.by_power(0.03, -1.0);
        s.concealed.wall_conductance = Some(conductance);
        vec![("wall_conductance_w_per_k", conductance)]
    }),
    listed("exhaust_restriction", "chambers", |s| {
        let area = s.off(s.nominal.exhaust_orifice, 0.6);
        s.concealed.exhaust_orifice = Some(area);
        vec![("orifice_area_m2", area)]
    }),
    listed("supply_restriction", "chambers", |s| {
        let area = s.off(s.nominal.supply_orifice, 0.6);
        s.concealed.supply_orifice = Some(area);
        vec![("orifice_area_m2", area)]
    }),
    listed("extra_dead_volume", "chambers", |s| {
        let volume = s.nominal.dead_volume * s.sized(0.8).exp();
        s.concealed.dead_volume = Some(volume);
        vec![("dead_volume_m3", volume)]
    }),
    // Volume and resistance by the root of the share: their product, its time constant, by the share.
    listed("hose_volume", "chambers", |s| {
        let (volume, resistance) = (s.by_power(1.2e-4, 0.5), s.by_power(1.5e8, 0.5));
        s.concealed.hose = Some([volume, resistance]);
        vec![
            ("volume_m3", volume),
            ("resistance_pa_s_per_kg", resistance),
        ]
    }),
    listed("supply_droop", "chambers", |s| {
        let (volume, flow) = (s.by_power(1.2e-4, -1.0), s.by_power(6e-5, -1.0));
        s.concealed.reservoir = Some([volume, flow]);
        vec![
            ("reservoir_volume_m3", volume),
            ("compressor_flow_kg_per_s", flow),
        ]
    }),
    listed("transport_delay", "regulator", |s| {
        s.concealed.dead_time = s.sized(0.12);
        vec![("delay_s", s.concealed.dead_time)]
    }),
    listed("regulator_gain_error", "regulator", |s| {
        let gain = s.off(s.nominal.gain, 0.08);
        s.concealed.gain = Some(gain);
        vec![("gain", gain)]
    }),
    listed("regulator_hysteresis", "regulator", |s| {
        s.concealed.play = s.sized(15e3);
        vec![("half_width_pa", s.concealed.play)]
    }),
    listed("regulator_rate_limit", "regulator", |s| {
        let limit = [s.by_power(3e5, -1.0), s.by_power(2e5, -1.0)];
        s.concealed.rate_limit = Some(limit);
        vec![("rise_pa_per_s", limit[0]), ("fall_pa_per_s", limit[1])]
    }),
    // Less and less of an overshoot, until it is the first-order lag with another one far faster: 2 zeta / w comes to the time constant.
    listed("regulator_second_order", "regulator", |s| {
        let damping = s.by_power(0.3, -0.5);
        let frequency = (2.0 * damping).max(1.6) / s.nominal.time_constant;
        s.concealed.second_order = Some([frequency, damping]);
        vec![
            ("natural_frequency_rad_per_s", frequency),
            ("damping_ratio", damping),
        ]
    }),
    listed("solenoid_switching_delay", "regulator", |s| {
        s.concealed.switching_delay = s.sized(0.08);
        vec![("delay_s", s.concealed.switching_delay)]
    }),
    listed("contact_stiffness_error", "contact", |s| {
        let stiffness = s.off(s.nominal.contact_stiffness, 1.5);
        s.concealed.contact_stiffness = Some(stiffness);
        vec![("stiffness_n_per_m", stiffness)]
    }),
    // From one that at 100 N is as soft as a fifth of the nominal stiffness; none is lost, for it takes the place of another law.
    listed("hertzian_contact", "contact", |s| {
        const AT: f64 = 100.0;
        let share = s.by_power(0.2, -0.3);
        let depth = AT / (share * s.nominal.contact_stiffness);
        let stiffness = AT / depth.powf(1.5);
        s.concealed.hertz = Some(stiffness);
        vec![("stiffness_n_per_m15", stiffness)]
    }),
    listed("tool_runout", "contact", |s| swing(s, 8e-5, [15.0, 60.0])),
    listed("surface_offset", "contact", |s| {
        s.concealed.surface_offset = s.sign() * s.sized(2e-3);
        vec![("offset_m", s.concealed.surface_offset)]
    }),
    listed("surface_waviness", "contact", |s| {
        swing(s, 4e-4, [1.5, 6.0])
    }),
    listed("force_sensor_bias_drift", "sensors", |s| {
        s.concealed.force_bias = [s.sign() * s.sized(8.0), s.sign() * s.sized(0.8)];
        let [bias, drift] = s.concealed.force_bias;
        vec![("bias_n", bias), ("drift_n_per_s", drift)]
    }),
    listed("force_sensor_gain_error", "sensors", |s| {
        s.concealed.force_gain = s.off(1.0, 0.12);
        vec![("gain", s.concealed.force_gain)]
    }),
    listed("force_sensor_lag", "sensors", |s| {
        s.concealed.force_lag = s.sized(0.05);
        vec![("time_constant_s", s.concealed.force_lag)]
    }),
    listed("force_sensor_saturation", "sensors", |s| {
        s.concealed.force_limit = s.peak_force * (1.0 - s.sized(0.4));
        vec![("limit_n", s.concealed.force_limit)]
    }),
    listed("inertial_crosstalk", "sensors", |s| {
        s.concealed.crosstalk = s.sized(2.0);
        vec![("mass_kg", s.concealed.crosstalk)]
    }),
    listed("stroke_sensor_gain_error", "sensors", |s| {
        s.concealed.stroke_gain = s.off(1.0, 0.04);
        vec![("gain", s.concealed.stroke_gain)]
    }),
    listed("channel_time_offset", "sensors", |s| {
        s.concealed.force_late = s.sized(0.03);
        vec![("offset_s", s.concealed.force_late)]
    }),
];

/// Effects that the vocabulary does not have.
pub static UNLISTED_EFFECTS: [LabEffect; 5] = [
    LabEffect {
        depends_on: &["time"],
        ..listed("regulator_ripple", "regulator", |s| {
            s.concealed.ripple = Some([s.sized(4e3), s.rng.random_range(3.0..9.0)]);
            Vec::new()
        })
    },
    LabEffect {
        depends_on: &["stroke_m"],
        ..listed("sticky_spot", "force_balance", |s| {
            let place = s.nominal.stroke * s.rng.random_range(0.2..0.4);
            s.concealed.sticky_spot = Some([s.sized(30.0), place, s.about(2e-3)]);
            Vec::new()
        })
    },
    LabEffect {
        depends_on: &["velocity"],
        ..listed("one_way_damping", "force_balance", |s| {
            s.concealed.one_way_damping = s.sized(250.0);
            Vec::new()
        })
    },
    LabEffect {
        depends_on: &["stroke_m"],
        ..listed("magnetic_detent", "force_balance", |s| {
            s.concealed.detent = Some([s.sized(14.0), s.about(9e-3)]);
            Vec::new()
        })
    },
    LabEffect {
        depends_on: &["mass_flow"],
        ..listed("outlet_droop", "regulator", |s| {
            s.concealed.outlet_droop = s.sized(8e7);
            Vec::new()
        })
    },
];

fn swing(s: &mut Scene<'_>, largest: f64, [low, high]: [f64; 2]) -> Vec<(&'static str, f64)> {
    let swing = Swing {
        amplitude: s.sized(largest),
        frequency: s.rng.random_range(low..high),
        phase: s.phase(),
    };
    s.concealed.swings.push(swing);
    vec![
        ("amplitude_m", swing.amplitude),
        ("frequency_hz", swing.frequency),
    ]
}

/// An effect by its name.
pub(super) fn effect(name: &str) -> Option<&'static LabEffect> {
    EFFECTS
        .iter()
        .chain(&UNLISTED_EFFECTS)
        .find(|effect| effect.name == name)
}

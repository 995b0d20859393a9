//! The terms that could each be the paper's deviation alone.

use super::bench::{Edit, Level, Shown};
use Edit::{Commands, Count, Key, Text};

/// Quantity in which the deviation is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seen {
    /// The outlet's pressure as read.
    Pressure,
    /// The force as read.
    Force,
    /// The force that eq. (1) as printed makes of true pressures.
    PrintedForce,
}

/// One term, of any size.
pub struct Term {
    /// Its name.
    pub name: &'static str,
    /// The keys that give it its size.
    pub key: &'static str,
    /// Quantity in which the deviation is seen.
    pub seen: Seen,
    /// Whether the actual value is the higher or the lower one.
    pub sign: f64,
    /// Edits for a size.
    pub edits: fn(f64) -> Vec<Edit>,
    /// Size for a set pressure [bar gauge] and a deviation [1], in closed form.
    pub closed: fn(f64, f64) -> f64,
    /// Size without error.
    pub nominal: f64,
    /// Size as text.
    pub text: fn(f64) -> String,
    /// Knowledge of such parts.
    pub plausible: &'static str,
}

/// Contact force at 1 bar [N]: two bores of 32 mm.
pub const NEWTON_PER_BAR: f64 = 1e5 * 2.0 * std::f64::consts::FRAC_PI_4 * 0.032 * 0.032;
const ATMOSPHERE: f64 = 101_325.0;
/// Offset of the outlet's voltage, 1.25 V of 5 V span on 6 bar [bar].
const ZERO: f64 = 1.5;

impl Term {
    /// Deviation between two runs [1], edited over nominal.
    pub fn deviation(&self, edited: &Shown, nominal: &Shown) -> f64 {
        match self.seen {
            Seen::Pressure => edited.outlet_read / nominal.outlet_read - 1.0,
            Seen::Force => edited.force_read / nominal.force_read - 1.0,
            Seen::PrintedForce => edited.force_as_printed / edited.force - 1.0,
        }
    }

    /// Size by the closed form for a level and its printed deviation plus some points [%].
    pub fn size(&self, level: &Level, points: f64) -> f64 {
        let deviation = self.sign * 1e-2 * (level.printed + points);
        (self.closed)(level.pressure, deviation)
    }
}

fn percent(size: f64) -> String {
    format!("{:+.2} %", 100.0 * size)
}

fn real_pressure(mut edits: Vec<Edit>) -> Vec<Edit> {
    edits.extend([
        Text("sensing.regulator_pressure.kind", "real"),
        // So fine that its rounding is no second term.
        Count("sensing.adc.bits", 24),
    ]);
    edits
}

fn load_cell(resistor: f64) -> Vec<Edit> {
    vec![
        Text("sensing.force.kind", "real"),
        Key("sensing.force.standard_deviation_n", 0.0),
        Key("sensing.force.gain_resistor_ohm", resistor),
        Count("sensing.adc.bits", 24),
    ]
}

fn gain_resistor(_: f64, deviation: f64) -> f64 {
    60e3 / ((4.0 + 60e3 / 121.0) * (1.0 + deviation) - 4.0)
}

/// All of them.
#[rustfmt::skip] // A table.
pub const TERMS: &[Term] = &[
    Term {
        name: "regulator's gain",
        key: "`regulator_gain`",
        seen: Seen::Pressure, sign: 1.0, nominal: 1.0,
        edits: |size| vec![Key("device.override.regulator_gain", size)],
        closed: |_, deviation| 1.0 + deviation,
        text: |size| format!("{size:.4}"),
        plausible: "possible: a regulator out of adjustment. A sound one: about 1 % of full scale, 3 % at 1.8 of 6 bar (judged; no data sheet of this one found)",
    },
    Term {
        name: "offset of regulator, its input or its sensor",
        key: "`set_pressure_bar_gauge` + size",
        seen: Seen::Pressure, sign: 1.0, nominal: 0.0,
        edits: |size| vec![Commands(1.0, size)],
        closed: |pressure, deviation| pressure * deviation,
        text: |size| format!("{:.0} mbar", 1e3 * size),
        plausible: "each size is 1 to 3 % of full scale, possible; but another size at each level",
    },
    Term {
        name: "set value's amplifier: resistors off against each other",
        key: "`feedback_resistor_error` = size, `ground_resistor_error` = -size",
        seen: Seen::Pressure, sign: 1.0, nominal: 0.0,
        edits: |size| vec![
            Text("sensing.command.kind", "real"), Count("sensing.command.pwm_bits", 16),
            Key("sensing.command.feedback_resistor_error", size), Key("sensing.command.ground_resistor_error", -size),
        ],
        closed: |_, deviation| deviation / (0.75 + deviation),
        text: percent,
        plausible: "only with resistors of 10 % (E12), both near their limits; not of 5 or 1 %, see below",
    },
    Term {
        name: "set value's amplifier: one resistor off",
        key: "`feedback_resistor_error`",
        seen: Seen::Pressure, sign: 1.0, nominal: 0.0,
        edits: |size| vec![
            Text("sensing.command.kind", "real"), Count("sensing.command.pwm_bits", 16),
            Key("sensing.command.feedback_resistor_error", size),
        ],
        closed: |_, deviation| deviation / 0.375,
        text: percent,
        plausible: "more than E12's 10 %; a wrong value from the series could",
    },
    Term {
        name: "PWM's high level, ADC with its own reference",
        key: "`set_pressure_bar_gauge` x size / 5 V",
        seen: Seen::Pressure, sign: -1.0, nominal: 5.0,
        edits: |size| vec![Commands(size / 5.0, 0.0)],
        closed: |_, deviation| 5.0 * (1.0 + deviation),
        text: |size| format!("{size:.3} V"),
        plausible: "a board fed by USB: 4.75 to 5.25 V at a high-power port, from 4.40 V at a low-power one (USB 2.0, 7.2.2), so lower is possible; +6 % is not. The ADC's default reference is the same supply: next row",
    },
    Term {
        name: "Arduino's supply, PWM and ADC alike",
        key: "`set_pressure_bar_gauge` x size / 5 V, `converter_gain` = 0.8 x 5 V / size",
        seen: Seen::Pressure, sign: 1.0, nominal: 5.0,
        edits: |size| real_pressure(vec![Commands(size / 5.0, 0.0), Key("sensing.regulator_pressure.converter_gain", 4.0 / size)]),
        closed: |pressure, deviation| 5.0 / (1.0 + deviation * pressure / ZERO),
        text: |size| format!("{size:.3} V"),
        plausible: "possible down to 4.75 V; the slope cancels and an offset is left, another size at each level",
    },
    Term {
        name: "sensor's scale, 1.25 to 6.25 V",
        key: "`scale_error`",
        seen: Seen::Pressure, sign: 1.0, nominal: 0.0,
        edits: |size| real_pressure(vec![Key("sensing.regulator_pressure.scale_error", size)]),
        closed: |_, deviation| deviation,
        text: percent,
        plausible: "as the regulator's gain; then the outlet was right and only its reading wrong",
    },
    Term {
        name: "converter to 1 to 5 V, or the ADC's reference",
        key: "`converter_gain` = 0.8 (1 + size)",
        seen: Seen::Pressure, sign: 1.0, nominal: 0.0,
        edits: |size| real_pressure(vec![Key("sensing.regulator_pressure.converter_gain", 0.8 * (1.0 + size))]),
        closed: |pressure, deviation| deviation * pressure / (pressure + ZERO),
        text: percent,
        plausible: "possible with resistors of 5 %; but the error carries the 1.25 V along, so another size at each level",
    },
    Term {
        name: "supply too weak",
        key: "`supply_pressure_bar_gauge`",
        seen: Seen::Pressure, sign: -1.0, nominal: 0.0,
        edits: |size| vec![Key("device.override.supply_pressure_bar_gauge", size)],
        closed: |pressure, deviation| pressure * (1.0 + deviation),
        text: |size| format!("{size:.3} bar"),
        plausible: "no: what limits 1.2 bar could not give 2.1",
    },
    Term {
        name: "load cell: gain resistor fitted, 121 ohm assumed; reads more",
        key: "`gain_resistor_ohm`",
        seen: Seen::Force, sign: 1.0, nominal: 121.0,
        edits: load_cell, closed: gain_resistor,
        text: |size| format!("{size:.1} ohm"),
        plausible: "no: the paper's own 100 ohm read 20.8 % more, and above 490 N the ADC is full, +1.6 % at 3.0 bar",
    },
    Term {
        name: "the same; reads less",
        key: "`gain_resistor_ohm`",
        seen: Seen::Force, sign: -1.0, nominal: 121.0,
        edits: load_cell, closed: gain_resistor,
        text: |size| format!("{size:.1} ohm"),
        plausible: "a resistor of 10 % in place of 121 ohm, which is a value of the 1 % series: hardly",
    },
    Term {
        name: "bore",
        key: "`bore_mm`",
        seen: Seen::Force, sign: 1.0, nominal: 32.0,
        edits: |size| vec![Key("device.override.bore_mm", size)],
        closed: |_, deviation| 32.0 * (1.0 + deviation).sqrt(),
        text: |size| format!("{size:.2} mm"),
        plausible: "no: 1 mm; a tube of H11 has 0.16 mm, 1 % of the area (ISO 286)",
    },
    Term {
        name: "seal friction, tool moving outwards",
        key: "`seal_coulomb_force_n`, `seal_static_force_n`",
        seen: Seen::Force, sign: -1.0, nominal: 0.0,
        edits: |size| vec![Key("device.override.seal_coulomb_force_n", size), Key("device.override.seal_static_force_n", size)],
        closed: |pressure, deviation| -deviation * pressure * NEWTON_PER_BAR,
        text: |size| format!("{size:.1} N"),
        plausible: "5 to 20 N are usual (judged), so the two lower levels; another size at each level",
    },
    Term {
        name: "weight of a device that stands up",
        key: "`gravity_along_extension_m_per_s2` = -9.81, `moving_mass_kg`",
        seen: Seen::Force, sign: -1.0, nominal: 0.0,
        edits: |size| vec![Key("bench.gravity_along_extension_m_per_s2", -9.81), Key("device.override.moving_mass_kg", size)],
        closed: |pressure, deviation| -deviation * pressure * NEWTON_PER_BAR / 9.81,
        text: |size| format!("{size:.2} kg"),
        plausible: "a mass of that size is usual; another size at each level",
    },
    Term {
        name: "atmosphere on the rods left out, eq. (1) as printed",
        key: "`rod_mm`",
        seen: Seen::PrintedForce, sign: 1.0, nominal: 0.0,
        edits: |size| vec![Key("device.override.rod_mm", size)],
        closed: |pressure, deviation| {
            let surplus = deviation * pressure * NEWTON_PER_BAR;
            1e3 * (surplus / (ATMOSPHERE * 2.0 * std::f64::consts::FRAC_PI_4)).sqrt()
        },
        text: |size| format!("{size:.2} mm"),
        plausible: "rods of that size are usual (ours: 12 mm, 22.9 N); another size at each level",
    },
];

/// Parameters that change no steady value, at any size: each is changed at will here.
#[rustfmt::skip] // A table.
pub const NEVER: &[(&str, &[Edit])] = &[
    ("supply orifice halved", &[Key("device.override.supply_orifice_mm2", 1.25)]),
    ("exhaust orifice halved", &[Key("device.override.exhaust_orifice_mm2", 1.0)]),
    ("C_s 0.95 to 0.6", &[Key("device.override.discharge_coefficient", 0.6)]),
    ("dead volume tripled", &[Key("device.override.dead_volume_cm3", 60.0)]),
    ("stroke 50 to 60 mm", &[Key("device.override.stroke_mm", 60.0)]),
    ("level device's mass halved", &[Key("device.override.moving_mass_kg", 2.0)]),
    ("temperature +20 K", &[Key("device.override.gas_temperature_k", 313.15)]),
    ("another gas constant", &[Key("device.override.gas_constant_j_per_kg_k", 280.0)]),
    ("wall heat in place of isothermal", &[Text("device.override.gas_process", "wall_heat")]),
    ("2 m of hose", &[Key("device.override.hose_length_m", 2.0)]),
    ("viscous seals", &[Key("device.override.seal_viscous_coefficient_n_s_per_m", 100.0)]),
    ("atmosphere -5 %", &[Key("device.override.atmosphere_pa_absolute", 96_000.0)]),
    ("another time constant", &[Key("device.override.regulator_time_constant_s", 0.25)]),
    ("no dead time", &[Key("device.override.regulator_dead_time_ms", 0.0)]),
    ("load cell half as stiff", &[Key("load.stiffness_n_per_m", 7.5e4)]),
    ("RC four times as slow", &[
        Text("sensing.command.kind", "real"), Count("sensing.command.pwm_bits", 16), Key("sensing.command.capacitance_uf", 40.0),
    ]),
];

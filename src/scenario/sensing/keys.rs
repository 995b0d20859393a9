//! The TOML of `[sensing]`, key by key, the same in a scenario of either kind.

use serde::Deserialize;

/// `[sensing]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::scenario) struct SensingKeys {
    #[serde(default)]
    pub preset: Preset,
    pub sample_rate_hz: Option<f64>,
    #[serde(default)]
    pub command: CommandChainKeys,
    #[serde(default)]
    pub regulator_pressure: RegulatorPressureKeys,
    #[serde(default)]
    pub force: ForceKeys,
    #[serde(default)]
    pub stroke: StrokeKeys,
    #[serde(default)]
    pub acceleration: AccelerationKeys,
    #[serde(default)]
    pub adc: AdcKeys,
    pub filter: Option<FilterKeys>,
}

/// Kind of the stages that do not say it themselves.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(in crate::scenario) enum Preset {
    /// The truth everywhere.
    #[default]
    Ideal,
    /// The source paper's chain.
    Paper,
    /// White noise on every sensor, the command ideal.
    White,
}

/// Kind of the command's way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(in crate::scenario) enum CommandChainKind {
    /// As it is wanted.
    Ideal,
    /// PWM, RC and amplifier.
    Real,
}

/// Kind of a sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(in crate::scenario) enum SensorKind {
    /// The truth.
    Ideal,
    /// The truth and white noise.
    White,
    /// The sensor with all that follows it.
    Real,
}

/// `[sensing.command]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::scenario) struct CommandChainKeys {
    pub kind: Option<CommandChainKind>,
    pub full_scale_bar_gauge: Option<f64>,
    pub full_input_v: Option<f64>,
    pub pwm_high_v: Option<f64>,
    pub pwm_bits: Option<u32>,
    pub pwm_frequency_hz: Option<f64>,
    pub resistance_ohm: Option<f64>,
    pub capacitance_uf: Option<f64>,
    pub amplifier_gain: Option<f64>,
    pub feedback_resistor_error: Option<f64>,
    pub ground_resistor_error: Option<f64>,
}

/// `[sensing.regulator_pressure]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::scenario) struct RegulatorPressureKeys {
    pub kind: Option<SensorKind>,
    pub standard_deviation_pa: Option<f64>,
    pub full_scale_bar_gauge: Option<f64>,
    pub zero_v: Option<f64>,
    pub full_v: Option<f64>,
    pub scale_error: Option<f64>,
    pub converter_gain: Option<f64>,
    pub assumed_converter_gain: Option<f64>,
}

/// `[sensing.force]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::scenario) struct ForceKeys {
    pub kind: Option<SensorKind>,
    pub standard_deviation_n: Option<f64>,
    pub capacity_kg: Option<f64>,
    pub rated_output_mv_per_v: Option<f64>,
    pub excitation_v: Option<f64>,
    pub zero_offset_n: Option<f64>,
    pub gain_resistor_ohm: Option<f64>,
    pub assumed_gain_resistor_ohm: Option<f64>,
    pub reference_v: Option<f64>,
    pub lowest_output_v: Option<f64>,
    pub highest_output_v: Option<f64>,
}

/// `[sensing.stroke]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::scenario) struct StrokeKeys {
    pub kind: Option<SensorKind>,
    pub standard_deviation_mm: Option<f64>,
    pub gain: Option<f64>,
    pub offset_mm: Option<f64>,
    pub resolution_mm: Option<f64>,
}

/// `[sensing.acceleration]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::scenario) struct AccelerationKeys {
    pub kind: Option<SensorKind>,
    pub standard_deviation_m_per_s2: Option<f64>,
    pub bias_m_per_s2: Option<f64>,
    pub range_m_per_s2: Option<f64>,
    pub resolution_m_per_s2: Option<f64>,
}

/// `[sensing.adc]`, which reads regulator pressure and force.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::scenario) struct AdcKeys {
    pub bits: Option<u32>,
    pub reference_v: Option<f64>,
    pub noise_steps: Option<f64>,
}

/// Treatment of the force's noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(in crate::scenario) enum FilterKind {
    /// None.
    None,
    /// First-order lag.
    FirstOrder,
    /// Second-order Bessel filter.
    Bessel,
    /// Median of the last samples.
    Median,
}

/// `[sensing.filter]`: `kind` says which of the other keys there is.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::scenario) struct FilterKeys {
    pub kind: FilterKind,
    pub time_constant_ms: Option<f64>,
    pub cutoff_hz: Option<f64>,
    pub length: Option<usize>,
}

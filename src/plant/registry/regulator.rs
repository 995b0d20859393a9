//! The pressure regulator.

use super::{Number, numbers};

#[rustfmt::skip] // A table: one number a line.
numbers! { REGULATOR:
    /// steady outlet pressure over set pressure
    REGULATOR_GAIN = "regulator.gain" as "regulator_gain", [0.2, 5.0], (p => p.device.regulator.gain);
    /// first-order lag of the regulator
    REGULATOR_TIME_CONSTANT = "regulator.time_constant_s" as "regulator_time_constant_s", [5e-4, 10.0], (p => p.device.regulator.time_constant);
    /// time before the lag sees a change
    REGULATOR_DEAD_TIME = "regulator.dead_time_s" as "regulator_dead_time_ms", [0.0, 5.0], (p => p.device.regulator.dead_time);
    /// half the width of the play between the set pressure and the pressure acted on
    REGULATOR_HYSTERESIS = "regulator.hysteresis_pa" as "regulator_hysteresis_pa", [0.0, 2e5], (p => p.device.regulator.hysteresis);
    /// largest rate at which the outlet rises
    RISE_LIMIT = "regulator.rise_limit_pa_per_s" as "regulator_rise_limit_pa_per_s", [1000.0, f64::INFINITY], (p => p.device.regulator.rate_limit.rise);
    /// largest rate at which it falls
    FALL_LIMIT = "regulator.fall_limit_pa_per_s" as "regulator_fall_limit_pa_per_s", [1000.0, f64::INFINITY], (p => p.device.regulator.rate_limit.fall);
    /// supply
    SUPPLY_PRESSURE = "regulator.supply_pressure_pa" as "supply_pressure_bar_gauge", [1e4, 1.6e6], (p => p.device.regulator.supply);
}

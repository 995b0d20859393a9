//! Errors of sensors.

use super::{ANY, Number, numbers};

#[rustfmt::skip] // A table: one number a line.
numbers! { SENSORS:
    /// gain of the load cell and its amplifier
    FORCE_GAIN = "sensors.force_gain", ANY, (p => p.sensors.force_gain);
    /// reading of the load cell at no force at the start of a recording
    FORCE_BIAS = "sensors.force_bias_n", ANY, (p => p.sensors.force_bias);
    /// drift of that
    FORCE_DRIFT = "sensors.force_drift_n_per_s", ANY, (p => p.sensors.force_drift);
    /// time constant of the load cell's low-pass filter
    FORCE_LAG = "sensors.force_lag_s", ANY, (p => p.sensors.force_lag);
    /// reading at which the load cell clips
    FORCE_LIMIT = "sensors.force_limit_n", ANY, (p => p.sensors.force_limit);
    /// how late the load cell is stamped
    FORCE_DELAY = "sensors.force_delay_s", ANY, (p => p.sensors.force_delay);
    /// mass beyond the load cell
    CROSSTALK_MASS = "sensors.crosstalk_mass_kg", ANY, (p => p.sensors.crosstalk_mass);
    /// gain of the position sensor
    STROKE_GAIN = "sensors.stroke_gain", ANY, (p => p.sensors.stroke_gain);
    /// reading of the pressure sensor at the atmosphere at the start of a recording
    PRESSURE_OFFSET = "sensors.pressure_offset_pa", ANY, (p => p.sensors.pressure_offset);
    /// drift of that
    PRESSURE_DRIFT = "sensors.pressure_drift_pa_per_s", ANY, (p => p.sensors.pressure_drift);
}

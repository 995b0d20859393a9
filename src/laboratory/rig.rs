//! A device of the laboratory: its numbers as they really are.

use std::f64::consts::PI;

/// The air and its surroundings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gas {
    /// Specific gas constant [J/(kg K)].
    pub constant: f64,
    /// Ratio of specific heats [1].
    pub ratio: f64,
    /// Temperature of the surroundings [K].
    pub temperature: f64,
    /// Pressure of the surroundings [Pa].
    pub atmosphere: f64,
}

/// Dry air on a usual day.
pub const AIR: Gas = Gas {
    constant: 287.05,
    ratio: 1.4,
    temperature: 293.15,
    atmosphere: 101_325.0,
};

/// A device, its contact and its sensors.
#[derive(Debug, Clone, PartialEq)]
pub struct LaboratoryRig {
    /// Cylinders in parallel.
    pub count: u32,
    /// Bore [m].
    pub bore: f64,
    /// Rod [m].
    pub rod: f64,
    /// Stroke [m].
    pub stroke: f64,
    /// Dead volume of each chamber, all cylinders together [m3].
    pub dead_volume: f64,
    /// Moving mass [kg].
    pub mass: f64,
    /// Component of gravity along extension [m/s2].
    pub gravity: f64,
    /// Stiffness [N/m] and damping [N s/m] of the end stops.
    pub stop: [f64; 2],
    /// Regulator: steady outlet over set pressure [1].
    pub gain: f64,
    /// Regulator: time constant [s].
    pub time_constant: f64,
    /// Orifice from outlet to chamber [m2].
    pub supply_orifice: f64,
    /// Orifice from chamber to atmosphere [m2].
    pub exhaust_orifice: f64,
    /// Discharge coefficient [1].
    pub discharge: f64,
    /// Air.
    pub gas: Gas,
    /// Stiffness [N/m] of tool on workpiece.
    pub contact_stiffness: f64,
    /// Damping [N s/m] of tool on workpiece.
    pub contact_damping: f64,
    /// Samples per second [Hz].
    pub rate: f64,
    /// Standard deviation of each sensor's noise.
    pub noise: [f64; 4],
}

impl LaboratoryRig {
    /// Areas on which chambers 1 and 2 press [m2].
    pub fn areas(&self) -> [f64; 2] {
        let circle = |d: f64| 0.25 * PI * d * d;
        let count = f64::from(self.count);
        [
            count * circle(self.bore),
            count * (circle(self.bore) - circle(self.rod)),
        ]
    }

    /// Weight along extension [N].
    pub fn weight(&self) -> f64 {
        self.mass * self.gravity
    }
}

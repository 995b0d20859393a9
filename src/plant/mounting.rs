//! A device as it is mounted: its masses and its tool along its axis, from the flange.

/// Masses and tool of a device on a flange.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mounting {
    /// Centre of the moving mass from the flange at zero stroke [m].
    pub moving_centre_of_mass: f64,
    /// Radius of gyration of the moving mass about its centre [m].
    pub moving_radius_of_gyration: f64,
    /// Mass of the housing, which does not move with the slide [kg]; 0 where it is not known.
    pub housing_mass: f64,
    /// Its centre from the flange [m].
    pub housing_centre_of_mass: f64,
    /// Centre of the tool's ball nose from the flange at zero stroke [m].
    pub tool_centre: f64,
    /// Radius of the ball nose [m].
    pub tool_radius: f64,
}

impl Default for Mounting {
    /// That of models/device.toml, its housing apart.
    fn default() -> Self {
        Self {
            moving_centre_of_mass: 0.1,
            moving_radius_of_gyration: 0.05,
            housing_mass: 0.0,
            housing_centre_of_mass: 0.0,
            tool_centre: 0.15,
            tool_radius: 0.005,
        }
    }
}

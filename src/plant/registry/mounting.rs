//! A device as it is mounted: masses and tool along its axis.

use super::{Number, numbers};

#[rustfmt::skip] // A table: one number a line.
numbers! { MOUNTING:
    /// ball nose
    TOOL_RADIUS = "tool.ball_radius_m" as "tool_ball_radius_mm", [5e-4, 0.1], (p => p.mounting.tool_radius);
    /// centre of the ball from the flange at zero stroke, at least the ball's radius
    TOOL_CENTRE = "tool.centre_m" as "tool_centre_mm", [0.001, 1.0], (p => p.mounting.tool_centre);
    /// centre of the moving mass from the flange at zero stroke
    MOVING_CENTRE = "tool.moving_centre_of_mass_m" as "moving_centre_of_mass_mm", [0.0, 1.0], (p => p.mounting.moving_centre_of_mass);
    /// of the moving mass about its centre, the same about every axis
    MOVING_GYRATION = "tool.moving_radius_of_gyration_m" as "moving_radius_of_gyration_mm", [0.001, 0.5], (p => p.mounting.moving_radius_of_gyration);
    /// of the housing, which stands still on the flange: cylinders, guides, valve; 0 where it is not known
    HOUSING_MASS = "tool.housing_mass_kg" as "housing_mass_kg", [0.0, 200.0], (p => p.mounting.housing_mass);
    /// centre of the housing's mass from the flange
    HOUSING_CENTRE = "tool.housing_centre_of_mass_m" as "housing_centre_of_mass_mm", [0.0, 1.0], (p => p.mounting.housing_centre_of_mass);
}

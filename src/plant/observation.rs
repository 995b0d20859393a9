//! Observation of a cell: what the columns of its recordings are of, and how a recording begins.

/// Differences between cells of which there are recordings, beside their numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Observation {
    /// Whether the load cell measures along the slide, not along the bisector of the edge.
    pub force_along_slide: bool,
    /// Whether a recording starts with the slide out on its stop, at the pressure set, not retracted without pressure.
    pub starts_pressing: bool,
    /// Whether the joints' springs carry gravity, not only what accelerates.
    pub gravity_on_joints: bool,
    /// Whether the encoders say where the motors went, not the commands and the servos' bandwidth.
    pub motors_by_encoders: bool,
    /// Whether the ball meets the edge as the mesh has it, not along its bisector.
    pub sharp_edge: bool,
}

impl Observation {
    /// A cell as `idc run` records it.
    pub const RUN: Self = Self {
        force_along_slide: true,
        starts_pressing: true,
        gravity_on_joints: true,
        motors_by_encoders: true,
        sharp_edge: true,
    };

    /// A cell whose controller compensates for gravity in force and joints, recorded from its retracted stop on.
    pub const COMPENSATED: Self = Self {
        force_along_slide: false,
        starts_pressing: false,
        gravity_on_joints: false,
        motors_by_encoders: false,
        sharp_edge: false,
    };
}

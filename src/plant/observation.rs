//! How a cell was observed: what the columns of its recordings are of, and how a recording begins.

/// What differs between cells of which there are recordings, beside their numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Observation {
    /// Does the load cell measure along the slide, not along the bisector of the edge?
    pub force_along_slide: bool,
    /// Does a recording start with the slide out on its stop, at the pressure set, not retracted without pressure?
    pub starts_pressing: bool,
    /// Do the joints' springs carry gravity, not only what accelerates?
    pub gravity_on_joints: bool,
    /// Do the encoders say where the motors went, not the commands and the servos' bandwidth?
    pub motors_by_encoders: bool,
    /// Does the ball meet the edge as the mesh has it, not along its bisector?
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

//! Why a run was stopped by its physics.

/// What stopped a run; the recording up to there is kept.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// The slide ran into an end of its stroke.
    #[error("the stroke ran out at {time:.3} s in phase {phase}, {:.1} mm along the edge: the slide is at {:.2} mm of 0 to {:.1} mm; the part lies farther off than the stroke allows",
        1e3 * edge_length, 1e3 * stroke, 1e3 * full_stroke)]
    StrokeRanOut {
        /// When [s].
        time: f64,
        /// Phase of the job.
        phase: &'static str,
        /// Where [m].
        edge_length: f64,
        /// Stroke [m].
        stroke: f64,
        /// Full stroke [m].
        full_stroke: f64,
    },
    /// A state is not a number any more.
    #[error("{quantity} became {value} at {time:.3} s in phase {phase}; the step of {:.3} ms is too long for this cell, or a parameter is far out of range", 1e3 * step)]
    NotFinite {
        /// What.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// When [s].
        time: f64,
        /// Phase of the job.
        phase: &'static str,
        /// Rigid-body step [s].
        step: f64,
    },
    /// An axis could not hold its reference.
    #[error("axis {axis} fell {:.2} deg behind its reference at {time:.3} s in phase {phase}: its effort limit of {effort:.1} N m is not enough", error.to_degrees())]
    AxisLost {
        /// Axis.
        axis: String,
        /// Distance from the reference [rad].
        error: f64,
        /// Its limit [N m].
        effort: f64,
        /// When [s].
        time: f64,
        /// Phase of the job.
        phase: &'static str,
    },
}

//! Why a run was stopped by its physics.

/// Reason why a run stopped; the recording up to there is kept.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// The slide ran into an end of its stroke.
    #[error("the stroke ran out at {time:.3} s in phase {phase}, {:.1} mm along the edge: the slide is at {:.2} mm of 0 to {:.1} mm; {}",
        1e3 * edge_length, 1e3 * stroke, 1e3 * full_stroke, why_the_stroke_ran_out(*stroke <= 0.0, *arm, *tip, *touched))]
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
        /// How far the arm stands nearer to the part than planned [m].
        arm: f64,
        /// How far the tool stands beyond its planned place, along its axis [m].
        tip: f64,
        /// Whether the tool has touched the part before.
        touched: bool,
    },
    /// The tool left the edge sideways.
    #[error("the tool slipped off the edge at {time:.3} s, {:.1} mm along the edge: it stands {:.1} mm beside its path, its ball's radius is {:.1} mm, the contact force was {force:.0} N",
        1e3 * edge_length, 1e3 * off, 1e3 * radius)]
    SlippedOff {
        /// When [s].
        time: f64,
        /// Where [m].
        edge_length: f64,
        /// Distance from the path across the tool's axis [m].
        off: f64,
        /// Radius of the ball [m].
        radius: f64,
        /// Contact force [N].
        force: f64,
    },
    /// The spindle could not turn the tool.
    #[error("the spindle stalled at {time:.3} s, {:.1} mm along the edge: cutting takes {:.1} N mm, it gives at most {:.1} N mm; less force_n, a contact nearer to the spindle's axis or a stronger spindle would turn", 1e3 * edge_length, 1e3 * torque, 1e3 * stall_torque)]
    Stalled {
        /// When [s].
        time: f64,
        /// Where [m].
        edge_length: f64,
        /// Torque [N m].
        torque: f64,
        /// That at which it stalls [N m].
        stall_torque: f64,
    },
    /// Two bodies met.
    #[error("collision: {} met {} at {time:.3} s in phase {phase}, {:.1} mm along the edge, {:.2} mm deep", names[0], names[1], 1e3 * edge_length, 1e3 * depth)]
    Collision {
        /// The two bodies.
        names: [String; 2],
        /// Depth [m].
        depth: f64,
        /// When [s].
        time: f64,
        /// Phase of the job.
        phase: &'static str,
        /// Where [m].
        edge_length: f64,
    },
    /// A state is not a number any more, or an amount of air is negative.
    #[error("{quantity} became {value:.3e} at {time:.3} s in phase {phase}; step_ms = {} is too long for this cell, or device_substeps are too few, or a parameter is far out of range", 1e3 * step)]
    NotFinite {
        /// The quantity.
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
    #[error("axis {axis} lost its path at {time:.3} s in phase {phase}: it is {:.2} deg from its reference, at most {:.2} deg are accepted; its drive gives {torque:.1} of at most {effort:.1} N m",
        error.to_degrees(), accepted.to_degrees())]
    AxisLost {
        /// Axis.
        axis: String,
        /// Distance from the reference [rad].
        error: f64,
        /// Largest distance that is accepted [rad].
        accepted: f64,
        /// Torque of its drive [N m].
        torque: f64,
        /// Its limit [N m].
        effort: f64,
        /// When [s].
        time: f64,
        /// Phase of the job.
        phase: &'static str,
    },
    /// A drive came to its limit, the arm did not find its path again, and that stopped the run.
    #[error(
        "the drive of joint {axis} came to its limit of {effort} N m at {time:.3} s in phase {phase} and lost its path; after that {stop}"
    )]
    Saturated {
        /// The joint.
        axis: String,
        /// Limit of its drive [N m].
        effort: f64,
        /// When it came to it [s].
        time: f64,
        /// Phase of the job then.
        phase: &'static str,
        /// What stopped the run.
        stop: Box<SimulationError>,
    },
}

/// Why a slide stands at an end of its stroke, the inner one or the outer: where it stands is the sum of what arm and tool are off.
fn why_the_stroke_ran_out(inner: bool, arm: f64, tip: f64, touched: bool) -> String {
    let (arm, tip) = (1e3 * arm, 1e3 * tip);
    let part = if inner { -tip } else { tip };
    let drawn = if inner { arm } else { -arm };
    if !inner && !touched {
        return "the tool has not touched the part, which lies farther from the arm than the stroke allows, or beside its path".to_owned();
    }
    if drawn > part {
        let side = if inner {
            "nearer to the part"
        } else {
            "farther from the part"
        };
        return format!("the arm stands {drawn:.2} mm {side} than planned");
    }
    let side = if inner {
        "nearer to the arm"
    } else {
        "farther from the arm"
    };
    format!("the tool finds the part {part:.2} mm {side} than planned")
}

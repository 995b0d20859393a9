//! Kinds of change that may make a job possible.

/// A kind of change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Angle of the flange about the tool's axis.
    Roll,
    /// Lean of the tool.
    Lean,
    /// Direction of the tool.
    ToolAxis,
    /// Direction of travel.
    Reversed,
    /// Place of the part.
    PartMoved,
    /// Place and rotation of the part.
    PartTurned,
    /// Place of the robot's base.
    BaseMoved,
    /// Feed, or the speed of the phase that is too fast.
    Feed,
    /// Acceleration along the path.
    Acceleration,
    /// Less force.
    LessForce,
    /// More force.
    MoreForce,
    /// Moving mass.
    Mass,
    /// Pressure behind the second chamber.
    OpposingPressure,
    /// Supply pressure.
    SupplyPressure,
    /// Piston diameter.
    Bore,
    /// Stroke at which the device works.
    WorkingStroke,
    /// The nominal pose moved to the actual one.
    Located,
    /// Radius of the tool's ball.
    Ball,
    /// Clearance that is asked for.
    Margin,
    /// Distance from the edge at which the motion starts.
    Approach,
    /// Edge that is followed.
    Edge,
    /// Stretch of the edge.
    Stretch,
    /// How the spindle stands.
    Spindle,
    /// Torque at which the spindle stalls.
    SpindleTorque,
}

impl Kind {
    /// Its name for programs and people.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Roll => "roll",
            Self::Lean => "lean",
            Self::ToolAxis => "tool axis",
            Self::Reversed => "other direction of travel",
            Self::PartMoved => "part moved",
            Self::PartTurned => "part turned",
            Self::BaseMoved => "base moved",
            Self::Feed => "feed",
            Self::Acceleration => "acceleration",
            Self::LessForce | Self::MoreForce => "force",
            Self::Mass => "moving mass",
            Self::OpposingPressure => "opposing pressure",
            Self::SupplyPressure => "supply pressure",
            Self::Bore => "bore",
            Self::WorkingStroke => "working stroke",
            Self::Located => "part located",
            Self::Ball => "smaller ball",
            Self::Margin => "clearance",
            Self::Approach => "approach",
            Self::Edge => "another edge",
            Self::Stretch => "another stretch of the edge",
            Self::Spindle => "spindle's axis",
            Self::SpindleTorque => "stall torque",
        }
    }

    /// Whether it is looked for only where nothing else was found.
    pub(super) fn is_last_resort(self) -> bool {
        matches!(self, Self::PartTurned | Self::BaseMoved | Self::Bore)
    }
}

//! A robot's program as moves: what all dialects can say, in SI.

use glamx::DPose3;

/// A program.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Program {
    /// Its name in the controller.
    pub name: String,
    /// What it does, in order.
    pub steps: Vec<Step>,
}

/// A step of a program.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// A comment.
    Note(String),
    /// What is carried, for the controller's model of its load.
    Load {
        /// Mass [kg].
        mass: f64,
        /// Centre of mass in the flange's frame [m].
        centre: [f64; 3],
    },
    /// The tool of the moves that follow, in the flange's frame.
    Tool(Frame),
    /// The frame of the poses that follow, in the controller's base.
    Frame(Frame),
    /// An analog output.
    Output {
        /// Its number or name.
        output: String,
        /// As the controller takes it.
        value: f64,
    },
    /// A rest [s].
    Wait(f64),
    /// A move.
    Move(Move),
}

/// A frame that the program names or gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Its name or number in the program.
    pub name: String,
    /// Its pose; none where the controller alone knows it.
    pub pose: Option<DPose3>,
}

/// A move.
#[derive(Debug, Clone, PartialEq)]
pub struct Move {
    /// How it gets there.
    pub way: Way,
    /// Where it ends.
    pub target: Target,
    /// How fast; none where the program leaves it to the controller.
    pub timing: Option<Timing>,
    /// How near it comes.
    pub zone: Zone,
}

/// How a move gets to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// The axes in step, the tool on some curve.
    Joint,
    /// The tool on a straight line.
    Line,
}

/// Where a move ends.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// Joint angles as the controller counts them [rad].
    Joints([f64; 6]),
    /// The tool's pose in the frame.
    Pose {
        /// The pose.
        pose: DPose3,
        /// How the arm stands there, as the dialect says it.
        configuration: Option<Configuration>,
    },
}

/// How an arm stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Configuration {
    /// RAPID: quarter turns of axes 1, 4 and 6, and the posture by its number.
    Quarters {
        /// Of axes 1, 4 and 6.
        turns: [i32; 3],
        /// 0 to 7.
        posture: i32,
    },
    /// KRL: bits of posture and of the signs of the axes.
    StatusTurn {
        /// S.
        status: u32,
        /// T.
        turn: u32,
    },
    /// FANUC: wrist, elbow, shoulder, and turns of axes 1, 4 and 6.
    Flags {
        /// F in place of N.
        flip: bool,
        /// U in place of D.
        up: bool,
        /// T in place of B.
        top: bool,
        /// Of axes 1, 4 and 6.
        turns: [i32; 3],
    },
}

/// How fast a move is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Timing {
    /// Of the tool [m/s].
    Speed(f64),
    /// Of the leading axis [rad/s].
    Turning(f64),
    /// Time that the move takes [s].
    Duration(f64),
    /// Share of the greatest speeds of the axes [1].
    Share(f64),
}

/// How near a move comes to its end before the next one starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Zone {
    /// It stops there.
    Stop,
    /// Within a distance [m].
    Within(f64),
    /// The greater this share, the wider the corner [1].
    Share(f64),
    /// Through it, without a stop.
    Through,
}

impl Program {
    /// Its moves, in order.
    pub fn moves(&self) -> impl Iterator<Item = &Move> {
        self.steps.iter().filter_map(|step| match step {
            Step::Move(one) => Some(one),
            _ => None,
        })
    }
}

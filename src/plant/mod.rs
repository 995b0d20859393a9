//! A bench rig as one description, driven by the inputs of a recording: what would have been measured if the description were true.
//!
//! ```text
//! set pressure -> regulator -> line and valve -> chambers -> piston <- contact <- surface
//!                     |                                        |         |
//!                     +-------------- sensors -----------------+---------+
//! ```
//!
//! The device is that of every other simulation ([`crate::device`]); contact and sensors have their own errors here, because a recording shows them
//! only through each other.

mod arm_trajectory;
mod cell_parameters;
mod contact;
mod contact_friction;
mod cubic;
mod hold;
mod initial_state;
mod inputs;
mod joint_deflections;
mod latent;
mod load;
mod measured_motion;
mod moment;
mod mounting;
mod nominal;
mod nudging;
mod observation;
mod operating_limits;
mod own_law;
mod parameters;
mod parts;
mod port;
pub mod registry;
mod riding;
mod running_device;
mod running_sensors;
mod sensors;
mod servo;
mod sharp_edge;
mod simulate;
mod terms;
mod trajectory;

pub use arm_trajectory::{
    ArmTrajectory, ContactJacobian, ContactKinematics, INERTIA_EVERY, JointTrajectory,
};
pub use cell_parameters::{Burr, CellParameters, MOST_JOINTS, Relief};
pub use contact::{ContactLaw, ContactParameters, PHASES, Periodic};
pub use cubic::Cubic;
pub use initial_state::{HeldMotion, InitialState};
pub use inputs::{InputError, PlantInputs};
pub use latent::{Basis, Formula, Latent, MOST_COEFFICIENTS};
pub use load::{PistonLoad, Touch};
pub use measured_motion::MeasuredMotion;
pub use moment::{Moment, Variable};
pub use mounting::Mounting;
pub use nominal::{Actual, Nominal};
pub use nudging::Nudging;
pub use observation::Observation;
pub use operating_limits::OperatingLimits;
pub use own_law::{
    BRISTLE_STIFFNESS, Constant, Expression, ExpressionError, LawText, MOST_CONSTANTS, OwnLaw,
    SYMBOLS, Symbol, USUAL_BRISTLE_STIFFNESS, Unit, kept_name,
};
pub use parameters::PlantParameters;
pub use parts::{DeviceParts, LinkParameters};
pub use port::Port;
pub use registry::{Number, Quantity};
pub use running_device::{PausedDevice, RunningDevice};
pub use running_sensors::{RunningSensors, SensorReadings};
pub use sensors::SensorErrors;
pub use servo::{Followed, follow, shown};
pub use sharp_edge::{EdgeStation, EdgeTouch, SharpEdge};
pub use simulate::{PlantTrajectory, readings, simulate, true_trajectory};
pub use trajectory::{CHANNELS, Channel, Trajectory};

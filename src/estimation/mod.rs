//! Contact force without a load cell and without sensors in the chambers, from the regulator's outlet, stroke and acceleration, with its uncertainty.
//!
//! ```text
//! F = (p1 A1 - p2 A2 - p_atm (A1 - A2)) - F_f - b v + M (g - a)                     (source paper, eq. 1, solved for the load)
//! ```
//!
//! F contact force, positive when the tool presses [N]; p1, p2 absolute chamber pressures [Pa]; F_f dry friction of the seals [N], b v viscous [N];
//! M moving mass [kg]; g gravity along extension [m/s2]; a acceleration, v speed of extension.
//!
//! Everything on the right is estimated, and the force follows; the motion is imposed by a stiff surface, so the motion is what a smooth model may
//! be laid down for, not the force. One extended Kalman filter holds it together:
//!
//! | what | model between samples | file |
//! | --- | --- | --- |
//! | stroke, speed, acceleration | random walk of the acceleration | `process` |
//! | regulator outlet | lag behind a set value that walks | `process` |
//! | air in each chamber | eqs. (9) to (11) and the estimated motion | `chambers` |
//! | bristles of the seals | closed form over the path since the last turning point | `seals` |
//!
//! **What is only known within tolerances** (orifices, dead volume, presliding displacement, the pressure sensor's bias) is carried as *considered*
//! parameters (Schmidt 1966; Jazwinski 1970, section 8.4): they are never corrected, for the measurements cannot tell them from the force, but
//! their covariance with the state is kept, so the band covers them. Mass, friction level, areas and gravity act on the force alone and add there.
//!
//! **How fast things may change** is not known either: quiet pressing and impact differ by a thousand. Several filters with different process
//! noise run side by side and mix by their likelihood (interacting multiple models: Blom and Bar-Shalom 1988), file `models`.
//!
//! Leaves out: gas that warms up and the line before the valve (both refused), end stops (resting on one, its push is part of the estimate).

mod belief;
mod chambers;
mod error;
mod estimator;
mod models;
mod output;
mod parameters;
mod process;
mod seals;

pub use error::EstimationError;
pub use estimator::{ContactForceEstimator, Measurement};
pub use output::EstimatorOutput;
pub use parameters::{EstimatorParameters, ProcessModel, SensorNoise, Tolerances};

#[cfg(test)]
mod tests;

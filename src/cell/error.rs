//! Why a cell cannot be assembled or cannot do its job.

use std::path::PathBuf;

use glam::DVec3;

use crate::arm::urdf::ArmError;
use crate::collision::ModelError;
use crate::path::PlanError;
use crate::scenario::{Scenario, ScenarioError};
use crate::shell::word;
use crate::workpiece::WorkpieceError;

/// A cell that is refused before anything moves.
#[derive(Debug, thiserror::Error)]
pub enum CellError {
    /// A value of the scenario that only the cell as a whole can judge.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The arm's file.
    #[error(transparent)]
    Arm(#[from] ArmError),
    /// The part, its edge or its burr.
    #[error(transparent)]
    Workpiece(#[from] WorkpieceError),
    /// Another number of springs than of joints.
    #[error("{}: `joints.stiffness_n_m_per_rad` has {found} values, expected {axes}, one for each of the arm's joints", file.display())]
    JointStiffness {
        /// Scenario file.
        file: PathBuf,
        /// Number that it gives.
        found: usize,
        /// Number of joints of the arm.
        axes: usize,
    },
    /// Another number of largest torques than of joints.
    #[error("{}: `limits.joint_torque_n_m` has {found} values, expected {axes}, one for each of the arm's joints", file.display())]
    JointTorque {
        /// Scenario file.
        file: PathBuf,
        /// Number that it gives.
        found: usize,
        /// Number of joints of the arm.
        axes: usize,
    },
    /// A joint that slides in an arm that is to be replayed.
    #[error("{}: joint `{joint}` slides, expected joints that turn: recordings of a cell are replayed for such arms alone", file.display())]
    SlidingJoint {
        /// URDF file.
        file: PathBuf,
        /// The joint.
        joint: String,
    },
    /// An arm file of another arm than the cell's, or with its drives in another order.
    #[error(
        "{}: its drives are of the joints {found}, expected {expected}, those of the cell's arm, base first: name the arm file of this arm in `arm.recorded_arm`, with its [[drive]] in this order", file.display()
    )]
    OtherDrives {
        /// The arm file.
        file: PathBuf,
        /// Its joints, in the order of its drives.
        found: String,
        /// Those of the cell.
        expected: String,
    },
    /// The chosen edge is not there.
    #[error("{}: `workpiece.edge` is {chosen}, which does not exist; the part has edges 0 to {} and loops 0 to {} (list them with `idc edges {}`)",
        file.display(), *edges as isize - 1, *loops as isize - 1, word(mesh))]
    EdgeUnknown {
        /// Scenario file.
        file: PathBuf,
        /// The mesh.
        mesh: PathBuf,
        /// The choice.
        chosen: String,
        /// Number of edges.
        edges: usize,
        /// Number of loops.
        loops: usize,
    },
    /// The chosen edge is not one that a tool can ride.
    #[error("{}: `workpiece.edge` is {chosen}, {convexity}; expected one that sticks out everywhere, as a tool can ride it from outside (side convex in `idc edges {}`)",
        file.display(), word(mesh))]
    EdgeNotConvex {
        /// Scenario file.
        file: PathBuf,
        /// The mesh.
        mesh: PathBuf,
        /// The choice.
        chosen: String,
        /// Its convexity.
        convexity: &'static str,
    },
    /// Start or end of the chosen stretch does not lie on the edge.
    #[error("{}: `workpiece.edge.{key}` is {} mm, expected {expected}", file.display(), millimetres(*value))]
    EdgeStretch {
        /// Scenario file.
        file: PathBuf,
        /// Which of the two.
        key: &'static str,
        /// Its value [m].
        value: f64,
        /// Expected value or form.
        expected: String,
    },
    /// The burr.
    #[error("{}: `workpiece.burr`: {source}", file.display())]
    Burr {
        /// Scenario file.
        file: PathBuf,
        /// Its fault.
        source: WorkpieceError,
    },
    /// An effect that a running cell cannot have.
    #[error("{}: `{key}` cannot stand here: {reason}", file.display())]
    Effect {
        /// Scenario file.
        file: PathBuf,
        /// Its table in the file.
        key: String,
        /// Why not.
        reason: String,
    },
    /// A drive of a joint that the arm does not have.
    #[error("{}: `arm.drives` names joint `{joint}`, expected one of {}", file.display(), joints.join(", "))]
    DriveUnknown {
        /// Scenario file.
        file: PathBuf,
        /// The name.
        joint: String,
        /// Names of the arm's joints, base first.
        joints: Vec<String>,
    },
    /// A posture for another number of axes.
    #[error("{}: `arm.seed_posture_deg` is a list of {found}, expected a list of {axes}, one angle an axis", file.display())]
    SeedPosture {
        /// Scenario file.
        file: PathBuf,
        /// Angles given.
        found: usize,
        /// Axes of the arm.
        axes: usize,
    },
    /// The path.
    #[error("{}: {source}", file.display())]
    Plan {
        /// Scenario file.
        file: PathBuf,
        /// The obstacle.
        source: Box<PlanError>,
    },
    /// Bodies that cannot be checked for collisions.
    #[error("{}: {source}", file.display())]
    CollisionModel {
        /// Scenario file.
        file: PathBuf,
        /// Why not.
        source: ModelError,
    },
    /// What stands still stands in each other.
    #[error("{}: {} stands {:.1} mm deep in {}", file.display(), names[0], 1e3 * depth, names[1])]
    Penetration {
        /// Scenario file.
        file: PathBuf,
        /// The two bodies.
        names: [String; 2],
        /// Depth [m].
        depth: f64,
    },
    /// A ball that reaches into the part where it should ride on the edge.
    #[error("{}: `device.override.tool_ball_radius_mm` is {}: the ball cannot follow the edge at {:.1} mm, point ({:.1}, {:.1}, {:.1}) mm, where it reaches into the part beside it; expected {}",
        file.display(), millimetres(*radius), 1e3 * edge_length, 1e3 * point.x, 1e3 * point.y, 1e3 * point.z, ball_that_can(*largest))]
    BallTooLarge {
        /// Scenario file.
        file: PathBuf,
        /// Radius of the ball [m].
        radius: f64,
        /// That of the largest ball that can follow the whole edge [m].
        largest: f64,
        /// Where it is tightest [m].
        edge_length: f64,
        /// That point in the world [m].
        point: DVec3,
    },
    /// A part that lies farther from its nominal pose than the slide can follow.
    #[error("{}: `workpiece.misplacement` moves the part by {} mm and {} deg: with a working stroke of {} mm the slide would go from {:.1} to {:.1} mm of 0 to {} mm along the edge; expected a part that lies within the stroke",
        file.display(), millimetres(*shift), shown_degrees(*tilt), millimetres(*working_stroke), 1e3 * from, 1e3 * to, millimetres(*full_stroke))]
    ShiftBeyondStroke {
        /// Scenario file.
        file: PathBuf,
        /// Its shift [m].
        shift: f64,
        /// Its tilt [rad].
        tilt: f64,
        /// Least stroke along the edge [m].
        from: f64,
        /// Largest stroke [m].
        to: f64,
        /// Full stroke [m].
        full_stroke: f64,
        /// Working stroke [m].
        working_stroke: f64,
    },
    /// A tool on its pole.
    #[error("{}: [tool]: the spindle's axis stands {:.1} deg from the contact normal, where the tool's surface hardly moves: it does not cut; spindle_lead_deg or spindle_lean_deg = 45, say, or another process.lean_deg, takes the contact off the pole", file.display(), angle.to_degrees())]
    ToolDoesNotCut {
        /// Scenario file.
        file: PathBuf,
        /// Angle of the spindle's axis from the contact normal [rad].
        angle: f64,
    },
    /// A cone that lies with its tip or rim on the edge.
    #[error("{}: [tool]: the spindle's axis stands {:.0} deg from the contact normal, but a cone of this angle lies with its flank on the edge at {:.0} deg: else its tip or its rim cuts; set spindle_lead_deg or spindle_lean_deg for that", file.display(), angle.to_degrees(), needed.to_degrees())]
    ConeOffEdge {
        /// Scenario file.
        file: PathBuf,
        /// Angle of the spindle's axis from the contact normal [rad].
        angle: f64,
        /// That at which the flank lies on the edge [rad].
        needed: f64,
    },
    /// A spindle that does not get its tool round.
    #[error("{}: [tool]: pass {pass} at {force} N takes {:.2} mm3/s and {:.1} N mm at the spindle, which stalls at {:.1} N mm: expected less force_n, a contact nearer to the spindle's axis, or stall_torque_n_mm of a stronger spindle", file.display(), 1e9 * rate, 1e3 * torque, 1e3 * stall_torque)]
    SpindleStalls {
        /// Scenario file.
        file: PathBuf,
        /// Pass, from 1.
        pass: usize,
        /// Its force [N].
        force: f64,
        /// Torque that it takes [N m].
        torque: f64,
        /// That at which the spindle stalls [N m].
        stall_torque: f64,
        /// Removal rate [m3/s].
        rate: f64,
    },
    /// The tool's weight alone presses harder than is asked for.
    #[error("{}: `process.force_n` is {force} N, but at {:.1} mm along the edge the weight of tool and slide alone presses with {:.1} N: device.override.moving_mass_kg at most {} (now {mass}), or force_n at least {:.1}, or the tool's axis at least {:.0} deg from the vertical (now {:.0}), by another lean or the part turned, or device.override.opposing_pressure_bar_gauge at least {:.2} of a second regulator",
        file.display(), 1e3 * edge_length, pressing, (most_mass * 100.0).floor() / 100.0, (pressing * 10.0).ceil() / 10.0, least_tilt.to_degrees().ceil(), tilt.to_degrees(), (least_opposing * 1e-3).ceil() / 100.0)]
    Weight {
        /// Scenario file.
        file: PathBuf,
        /// Desired force [N].
        force: f64,
        /// Where [m].
        edge_length: f64,
        /// Contact force by the weight alone [N].
        pressing: f64,
        /// Moving mass [kg].
        mass: f64,
        /// Largest moving mass at which the force can be had there [kg].
        most_mass: f64,
        /// Angle of the tool's axis to gravity there [rad], and the least at which the force can be had.
        tilt: f64,
        /// The least at which the force can be had [rad].
        least_tilt: f64,
        /// Least opposing pressure at which it can be had [Pa gauge].
        least_opposing: f64,
    },
    /// A contact too fast for any step.
    #[error("{}: [contact]: {stiffness} N/m and {damping} N s/m against a moving mass of {mass} kg change faster than the shortest part of a step, 1 us, can follow: expected stiffness_n_per_m at most {:.1e} and damping_n_s_per_m at most {:.1e} (device.override.end_stop_* likewise), or a larger moving_mass_kg",
        file.display(), most_stiffness, most_damping)]
    Unresolved {
        /// Scenario file.
        file: PathBuf,
        /// Contact stiffness [N/m].
        stiffness: f64,
        /// Contact damping [N s/m].
        damping: f64,
        /// Moving mass [kg].
        mass: f64,
        /// The largest stiffness that can be followed [N/m].
        most_stiffness: f64,
        /// The largest damping [N s/m].
        most_damping: f64,
    },
    /// More on the flange than the arm may carry.
    #[error("{}: the flange carries {carried} kg, {housing} kg of housing and {moving} kg of slide and tool, but the arm at most {payload} kg ({origin}): expected a lighter device (moving_mass_kg, housing_mass_kg in [device.override]), an arm for more, or arm.payload_kg if it may carry more",
        file.display())]
    Payload {
        /// Scenario file.
        file: PathBuf,
        /// Mass on the flange [kg].
        carried: f64,
        /// Mass of the device's housing [kg].
        housing: f64,
        /// Mass of its slide and tool [kg].
        moving: f64,
        /// What the arm may carry [kg].
        payload: f64,
        /// Who says so.
        origin: String,
    },
    /// The supply cannot give the force, or the command's way not the set pressure.
    #[error("{}: `process.force_n` is {force} N, which needs {:.2} bar gauge at the regulator at {:.1} mm along the edge; {giver} 0 to {:.2} bar, expected {:.1} to {:.1} N there",
        file.display(), needed / 1e5, 1e3 * edge_length, supply / 1e5, attainable[0].max(0.0), attainable[1])]
    Supply {
        /// Scenario file.
        file: PathBuf,
        /// Desired force [N].
        force: f64,
        /// Where [m].
        edge_length: f64,
        /// Pressure needed, gauge [Pa].
        needed: f64,
        /// Largest set pressure, gauge [Pa].
        supply: f64,
        /// Origin of the limit.
        giver: &'static str,
        /// Contact forces at no and at full pressure [N].
        attainable: [f64; 2],
    },
}

/// A length in millimetres without the last digits, which a conversion may have spoilt.
pub(super) fn millimetres(metres: f64) -> f64 {
    (metres * 1e9).round() / 1e6
}

/// An angle in degrees without the last digits.
fn shown_degrees(angle: f64) -> f64 {
    (angle.to_degrees() * 1e6).round() / 1e6
}

/// Smallest ball of a device [m].
const SMALLEST_BALL: f64 = 5e-4;

/// What ball would do.
fn ball_that_can(largest: f64) -> String {
    if largest < SMALLEST_BALL {
        return "another stretch of the edge: no ball can follow it there".to_owned();
    }
    // Rounded down, so that what is said can.
    let radius = (1e5 * largest).floor() / 100.0;
    format!("at most {radius}, or a stretch of the edge without that place")
}

impl CellError {
    pub(super) fn plan(scenario: &Scenario, source: PlanError) -> Self {
        Self::Plan {
            file: scenario.path.clone(),
            source: Box::new(source),
        }
    }
}

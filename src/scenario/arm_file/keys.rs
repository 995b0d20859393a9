//! The TOML of an arm file, table by table. Effects are `effects`' business.

use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

use super::super::file::{CollisionKeys, ObstacleKeys};
use super::super::rig_file::RecordingsKeys;
use super::super::toleranced::Toleranced;
use super::effects::EffectTables;
use crate::keys::declaration::{Plain, keys};

impl Plain for FileKind {}

/// The one kind of such a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum FileKind {
    /// A recorded arm.
    RecordedArm,
}

type Number = Toleranced<f64>;
type Vector = Toleranced<[f64; 3]>;

keys! {
    /// A recorded arm: its links, drives, load and sensors by their nominal values, and the recordings that it is diagnosed from.
    pub(super) struct ArmFileKeys {
        /// version of the format
        schema: u32 = "schema" in 1..=1;
        /// what the file is
        kind: FileKind = "kind";
        /// links and joints
        arm: ArmKeys = "arm";
        /// links by other numbers than the URDF's
        links: Vec<LinkKeys> = "link";
        /// drives, in the order in which columns count their joints
        drives: Vec<DriveKeys> = "drive";
        /// declared load at the flange
        load: LoadKeys = "load";
        /// sensor between flange and tool
        wrench: Option<WrenchKeys> = "wrench_sensor";
        /// noise and rate of the sensors
        sensors: SensorsKeys = "sensors";
        /// recordings
        recordings: RecordingsKeys = "recordings";
        /// what a designed path keeps clear of; the world is the base link's frame
        collision: CollisionKeys = "collision";
        /// what stands beside the arm
        obstacles: Vec<ObstacleKeys> = "obstacle";
        /// physics beyond the nominal model
        effects: EffectTables = "effect";
        /// laws at joints that have no name
        laws: Vec<LawKeys> = "law";
    }

    /// `[arm]`.
    pub(super) struct ArmKeys {
        /// URDF file of the arm, from this file's folder
        urdf: PathBuf = "urdf";
        /// link that carries load and wrench sensor
        flange: String = "flange";
        /// link that stands still
        base: Option<String> = "base", shown "the URDF's root";
        /// gravity in the axes of the base link, as it stands nominally
        gravity: glam::DVec3 = "gravity_m_per_s2", or vec![0.0, 0.0, -9.81];
        /// how far each link's mass may be off, a share of it; its inertia tensor scales with its mass
        mass_tolerance: f64 = "link_mass_tolerance" in 0.0..=0.95, or 0.0;
        /// how far each coordinate of each link's centre of mass may be off
        centre_tolerance: f64 = "link_centre_tolerance_m" in 0.0..=1.0, or 0.0;
    }

    /// `[[link]]`: a link by other numbers than the URDF's, with all that is fixed to it.
    pub(super) struct LinkKeys {
        /// name of the link behind a moving joint
        name: String = "name";
        /// mass; its inertia tensor scales with it
        mass: Option<Number> = "mass_kg";
        /// centre of mass in the link's frame
        centre: Option<Vector> = "centre_m";
    }

    /// `[[drive]]`: one for each moving joint. Of a prismatic joint read N for N m and m for rad.
    pub(super) struct DriveKeys {
        /// name of the joint in the URDF
        joint: String = "joint";
        /// torque per current; left out where torques are logged
        gain: Option<Number> = "gain_n_m_per_a", shown "torques are logged";
        /// inertia of motor and gear at the joint's side
        motor_inertia: Option<Number> = "motor_inertia_kg_m2", shown "0";
        /// dry friction
        coulomb: Option<Number> = "coulomb_friction_n_m", shown "0";
        /// viscous friction
        viscous: Option<Number> = "viscous_friction_n_m_s_per_rad", shown "0";
        /// angle over which dry friction builds up after a reversal
        bristle_length: Option<f64> = "bristle_length_rad" in 1e-9..=1.0, shown "1e-4";
    }

    /// `[load]`: declared load, fixed to the flange; the joints carry it, a wrench sensor does not feel it.
    pub(super) struct LoadKeys: Default {
        /// mass
        mass: Option<Number> = "mass_kg", shown "0";
        /// its centre in the flange's axes
        centre: Option<Vector> = "centre_m", shown "[0, 0, 0]";
    }

    /// `[wrench_sensor]`: a sensor between flange and tool. It reads what the tool does to it, about its own origin, in its own axes.
    pub(super) struct WrenchKeys {
        /// its origin along the flange's z
        height: f64 = "height_m" in -10.0..=10.0, or 0.0;
        /// its axes against the flange's, about z
        rotation: Number = "rotation_z_rad";
        /// forces that it reads without a tool
        zero_force: Option<Vector> = "zero_force_n", shown "[0, 0, 0]";
        /// torques that it reads without a tool
        zero_torque: Option<Vector> = "zero_torque_n_m", shown "[0, 0, 0]";
        /// mass of all that is beyond it
        tool_mass: Number = "tool_mass_kg";
        /// centre of that from the sensor's origin, in the flange's axes
        tool_centre: Vector = "tool_centre_m";
        /// its inertia about its centre, in the flange's axes; scales with its mass
        tool_inertia: Option<glam::DVec3> = "tool_inertia_kg_m2", shown "[0, 0, 0]";
        /// where the tool touches, along the flange's z from the sensor's origin
        tip: Option<f64> = "tip_m" in -10.0..=10.0;
    }

    /// `[sensors]`: rate, and one standard deviation of each sensor's white noise.
    pub(super) struct SensorsKeys {
        /// samples per second
        rate: f64 = "rate_hz" in 1e-3..=1e6;
        /// angles of joints
        position: Option<f64> = "joint_rad" in 0.0..=1.0;
        /// speeds of joints; they are made of the angles
        speed: Option<f64> = "joint_rad_per_s" in 0.0..=10.0;
        /// currents, one a drive
        current: Option<Vec<f64>> = "current_a";
        /// torques, one a drive
        torque: Option<Vec<f64>> = "torque_n_m";
        /// angles on the links' side of the gears
        link: Option<f64> = "link_rad" in 1e-12..=1.0;
        /// forces of the wrench sensor
        force: Option<f64> = "wrench_force_n" in 1e-9..=1e6;
        /// torques of the wrench sensor
        moment: Option<f64> = "wrench_torque_n_m" in 1e-9..=1e6;
    }

    /// `[[law]]`: torque at a joint by a shape over one variable, as a diagnosis writes what no name covers.
    pub(super) struct LawKeys {
        /// number of the joint in columns
        joint: u32 = "joint";
        /// its form over the variable x, with place p and width w
        shape: String = "shape";
        /// the variable
        over: String = "over";
        /// what the form is multiplied with
        times: String = "times", or "one";
        /// factors of the form; the second is that of a sine's cosine [N m per unit of form and factor]
        factors: Vec<f64> = "factors", being "one or two";
        /// place p, or cycles a turn of a sine [unit of the variable]
        at: f64 = "place", or 0.0;
        /// width w [unit of the variable]
        width: f64 = "width", or 1.0;
    }
}

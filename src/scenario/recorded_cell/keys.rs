//! Keys of a recorded cell, as `file` has those of a cell.

use glam::DVec3;

use super::super::cell::ContactKeys;
use super::super::cell_limits::CellLimitsKeys;
use super::super::effects::EffectKeys;
use super::super::file::{ArmKeys, DeviceKeys, Kind, WorkpieceKeys};
use crate::keys::declaration::keys;
use crate::plant::registry;

keys! {
    /// The file.
    pub(in super::super) struct RecordedCellFile {
        /// version of this format
        schema: u32 = "schema" in 1..=2;
        /// what the file describes
        kind: Kind = "kind", being "`\"recorded_cell\"`";
        /// name for people
        title: String = "title", being "not empty";
        arm: ArmKeys = "arm";
        joints: JointsKeys = "joints";
        device: DeviceKeys = "device";
        workpiece: WorkpieceKeys = "workpiece";
        contact: ContactKeys = "contact";
        sensors: SensorsKeys = "sensors";
        belief: BeliefKeys = "belief";
        limits: CellLimitsKeys = "limits";
        /// physics beyond the nominal model: [`[[effect]]`](#effect)
        effect: EffectKeys = "effect", shown "none";
    }

    /// `[joints]`.
    pub(in super::super) struct JointsKeys {
        /// each encoder follows its command as a critically damped second-order lag
        servo_bandwidth: f64 = "servo_bandwidth_hz" in 0.1..=f64::INFINITY;
        /// springs between motors and links, base first
        stiffness: Vec<f64> = "stiffness_n_m_per_rad", of registry::JOINT_STIFFNESS;
        /// damping of those springs over their stiffness
        damping_time: f64 = "damping_time_ms", of registry::JOINT_DAMPING;
        /// assumed standard deviation of it
        damping_time_tolerance: f64 = "damping_time_tolerance_ms" in 0..=50, or 1.0;
    }

    /// `[sensors]`: standard deviations of their noise.
    pub(in super::super) struct SensorsKeys {
        /// standard deviation of the encoders' noise
        joints: f64 = "joints_rad" in 1e-9..=0.01;
        /// of the outlet's
        regulator_pressure: f64 = "regulator_pressure_pa" in 1.0..=1e5;
        /// of the stroke's
        stroke: f64 = "stroke_um" in 0.01..=5e3;
        /// of the force's
        force: f64 = "force_n" in 1e-4..=1e3;
    }

    /// `[belief]`: what is assumed.
    pub(in super::super) struct BeliefKeys {
        /// relative tolerance of moving mass, dead volume, orifices, regulator and contact
        tolerance: f64 = "tolerance" in 0.0..=0.5, or 0.005;
        /// how far off its stop the retracted slide may start
        start_stroke_tolerance: f64 = "start_stroke_tolerance_mm" in 0..=10, or 0.2;
        /// in the world
        gravity: DVec3 = "gravity_m_per_s2" in -30..=30, or vec![0.0, 0.0, -9.81];
    }
}

//! The numbers of a run as they stand in summary.json.
//!
//! Field names are file keys, so each ends in its unit; docs/METRICS.md defines every one.

use std::time::Instant;

use serde::{Deserialize, Serialize};

/// The numbers of a run; keys are written in the order of the fields.
///
/// All but `timing` follow from the recording alone, bit for bit.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Summary {
    /// Desired contact force [N].
    pub desired_force_n: f64,
    /// Mean contact force while following [N].
    pub force_mean_n: Option<f64>,
    /// Population standard deviation of the contact force while following [N].
    pub force_standard_deviation_n: Option<f64>,
    /// Standard deviation over mean [%].
    pub coefficient_of_variation_percent: Option<f64>,
    /// Root mean square of contact force less desired force while following [N].
    pub force_rms_error_n: Option<f64>,
    /// That, of the desired force [%].
    pub force_rms_error_percent: Option<f64>,
    /// Largest distance of the contact force from the desired force while following [N].
    pub largest_deviation_n: Option<f64>,
    /// Share of the followed length on which the force is within 5 % of the desired one [%].
    pub within_5_percent_share_percent: Option<f64>,
    /// Share of the followed length on which the force is within 10 % of the desired one [%].
    pub within_10_percent_share_percent: Option<f64>,
    /// Share of the followed length on which the tool does not touch [%].
    pub loss_of_contact_share_percent: Option<f64>,
    /// Mean friction force while following [N].
    pub friction_force_mean_n: Option<f64>,
    /// Largest contact force in the phase `approach` [N].
    pub force_peak_approach_n: Option<f64>,
    /// Largest contact force in the phase `engage` [N].
    pub force_peak_engage_n: Option<f64>,
    /// Largest contact force in the phase `follow` [N].
    pub force_peak_follow_n: Option<f64>,
    /// Largest contact force in the phase `retract`, where the tool lifts off [N].
    pub force_peak_retract_n: Option<f64>,
    /// Largest contact force from first touch to the start of following [N].
    pub engagement_peak_n: Option<f64>,
    /// Excess of that peak over the desired force [%].
    pub engagement_overshoot_percent: Option<f64>,
    /// From first touch until the force stays within 5 % of the desired one [s].
    pub settling_time_s: Option<f64>,
    /// Range of the stroke while following [mm].
    pub stroke_used_mm: Option<f64>,
    /// Smallest stroke while following [mm].
    pub stroke_min_mm: Option<f64>,
    /// Largest stroke while following [mm].
    pub stroke_max_mm: Option<f64>,
    /// Least distance from either end of the stroke while following [mm].
    pub stroke_margin_mm: Option<f64>,
    /// Root mean square of the lateral path error while following [µm].
    pub path_error_rms_um: Option<f64>,
    /// Largest lateral path error while following [µm].
    pub path_error_max_um: Option<f64>,
    /// Root mean square of the lag along the path while following [µm].
    pub path_lag_rms_um: Option<f64>,
    /// Largest lag along the path while following [µm].
    pub path_lag_max_um: Option<f64>,
    /// Length followed [mm].
    pub path_length_mm: Option<f64>,
    /// Length followed over the time it took [mm/s].
    pub feed_mean_mm_per_s: Option<f64>,
    /// Time of following [s].
    pub follow_duration_s: Option<f64>,
    /// Largest torque of the most loaded joint, of its effort limit, over the run [%].
    pub joint_torque_share_percent: Option<f64>,
    /// Name of that joint.
    pub most_loaded_joint: Option<String>,
    /// Time for which a drive was at its limit, over the run [s].
    pub drives_saturated_s: Option<f64>,
    /// Largest gap in the balance of the air in the chambers, of their mass, over the run [1].
    pub air_mass_balance_relative: Option<f64>,
    /// Height of the highest burr before the first pass [mm]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub burr_before_max_mm: Option<f64>,
    /// Mean leg of the chamfer along the edge [mm]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chamfer_leg_mean_mm: Option<f64>,
    /// Population standard deviation of the leg [mm]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chamfer_leg_standard_deviation_mm: Option<f64>,
    /// Least leg [mm]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chamfer_leg_min_mm: Option<f64>,
    /// Largest leg [mm]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chamfer_leg_max_mm: Option<f64>,
    /// Height of the highest burr that is left [mm]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual_burr_max_mm: Option<f64>,
    /// Share of the edge on which more burr is left than may be [%]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual_burr_share_percent: Option<f64>,
    /// Share of the edge out of tolerance, by leg or burr [%]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub out_of_tolerance_share_percent: Option<f64>,
    /// Least leg at the ends of the edge [mm]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ends_chamfer_leg_min_mm: Option<f64>,
    /// Largest leg at the ends [mm]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ends_chamfer_leg_max_mm: Option<f64>,
    /// Height of the highest burr that is left at the ends [mm]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ends_residual_burr_max_mm: Option<f64>,
    /// Share of the ends out of tolerance, by leg or burr [%]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ends_out_of_tolerance_share_percent: Option<f64>,
    /// Share of the whole edge out of tolerance, its ends included [%]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub whole_edge_out_of_tolerance_share_percent: Option<f64>,
    /// Length of each end [mm]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ends_length_mm: Option<f64>,
    /// Mean section that was taken, of burr and edge [mm2]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub section_removed_mean_mm2: Option<f64>,
    /// Standard deviation of that section over its mean [%]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub section_variation_percent: Option<f64>,
    /// Volume that was taken [mm3]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub removed_volume_mm3: Option<f64>,
    /// Mean removal rate while something comes off [mm3/s]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub removal_rate_mean_mm3_per_s: Option<f64>,
    /// Largest power at the tool [W]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spindle_power_max_w: Option<f64>,
    /// Energy that the spindle gave at the tool [kJ]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spindle_energy_kj: Option<f64>,
    /// Work of force and cutting speed that the tool has done [kJ]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tool_wear_kj: Option<f64>,
    /// Air that has entered the device [g]; of a turning tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub air_used_g: Option<f64>,
    /// Simulated time of the whole run [s].
    pub duration_s: f64,
    /// Each joint's largest torque, base first.
    pub joints: Vec<JointTorqueShare>,
    /// Each pass along the edge, in order.
    #[serde(default)]
    pub passes: Vec<PassSummary>,
    /// The force in each tenth of the followed length; empty if nothing was followed.
    pub force_by_tenth: Vec<ForceTenth>,
    /// Duration of the computation; differs from run to run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub timing: Option<Timing>,
}

/// Share of a joint's effort limit that a run took.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JointTorqueShare {
    /// The joint's name.
    pub joint: String,
    /// Its largest torque, of its effort limit [%]; undefined without limit or channel.
    pub torque_share_percent: Option<f64>,
    /// Time for which its drive was at its limit [s].
    #[serde(default)]
    pub saturated_s: f64,
    /// When it first was [s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub saturated_from_s: Option<f64>,
}

/// The contact force in one tenth of the followed length.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ForceTenth {
    /// Where it begins, from the start of following [mm].
    pub from_mm: f64,
    /// Where it ends [mm].
    pub to_mm: f64,
    /// Mean contact force [N]; undefined if no sample fell here.
    pub force_mean_n: Option<f64>,
    /// Population standard deviation of the contact force [N].
    pub force_standard_deviation_n: Option<f64>,
}

impl ForceTenth {
    /// One of its ends with the decimals that tell tenths apart, however short the edge [mm].
    #[must_use]
    pub fn end_text(&self, end_mm: f64) -> String {
        let decimals = match (self.to_mm - self.from_mm).abs() {
            length if length >= 10.0 => 0,
            length if length >= 1.0 => 1,
            length if length >= 0.1 => 2,
            _ => 3,
        };
        format!("{end_mm:.decimals$}")
    }
}

/// Duration of a run's computation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// Wall-clock time of the computation [s].
    pub wall_time_s: f64,
    /// Simulated time over wall-clock time [1].
    pub real_time_factor: f64,
}

impl Timing {
    /// The timing of `simulated` [s] computed in `wall` [s].
    #[must_use]
    pub fn new(simulated: f64, wall: f64) -> Self {
        Self {
            wall_time_s: wall,
            real_time_factor: simulated / wall,
        }
    }

    /// The timing of `simulated` [s] computed from `start` until now.
    #[must_use]
    pub fn since(start: Instant, simulated: f64) -> Self {
        Self::new(simulated, start.elapsed().as_secs_f64())
    }
}

/// The numbers of one pass; each is defined as that of its name in [`Summary`], over this pass alone.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PassSummary {
    /// Number of the pass, from 1.
    pub pass: usize,
    /// Desired contact force [N].
    pub desired_force_n: f64,
    /// Mean contact force [N].
    pub force_mean_n: Option<f64>,
    /// Population standard deviation of it [N].
    pub force_standard_deviation_n: Option<f64>,
    /// Standard deviation over mean [%].
    pub coefficient_of_variation_percent: Option<f64>,
    /// Root mean square of contact force less desired force [N].
    pub force_rms_error_n: Option<f64>,
    /// That, of the desired force [%].
    pub force_rms_error_percent: Option<f64>,
    /// Largest distance of the contact force from the desired one [N].
    pub largest_deviation_n: Option<f64>,
    /// Share of the length on which the force is within 5 % of the desired one [%].
    pub within_5_percent_share_percent: Option<f64>,
    /// Share of the length on which it is within 10 % [%].
    pub within_10_percent_share_percent: Option<f64>,
    /// Share of the length on which the tool does not touch [%].
    pub loss_of_contact_share_percent: Option<f64>,
    /// Largest contact force [N].
    pub force_peak_follow_n: Option<f64>,
    /// Root mean square of the lateral path error [µm].
    pub path_error_rms_um: Option<f64>,
    /// Largest lateral path error [µm].
    pub path_error_max_um: Option<f64>,
    /// Root mean square of the lag along the path [µm].
    pub path_lag_rms_um: Option<f64>,
    /// Largest lag along the path [µm].
    pub path_lag_max_um: Option<f64>,
    /// Length followed [mm].
    pub path_length_mm: Option<f64>,
    /// Length followed over the time it took [mm/s].
    pub feed_mean_mm_per_s: Option<f64>,
    /// Time of following [s].
    pub follow_duration_s: Option<f64>,
}

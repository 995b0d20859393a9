//! The numbers of a run as they stand in summary.json.
//!
//! Field names are file keys, so each ends in its unit; docs/METRICS.md defines every one.

use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::catalogue::{Metric, entry, metrics};

metrics! {
    /// The numbers of a run; keys are written in the order of the fields.
    ///
    /// All but `timing` follow from the recording alone, bit for bit.
    Summary,
    /// Every metric, in the order of summary.json.
    METRICS;
    always {
        /// Desired contact force [N].
        desired_force_n: f64 = "N", "desired force", "what the scenario asks for";
        /// Mean contact force while following [N].
        force_mean_n: Option<f64> = "N", "mean", "over the following phase";
        /// Population standard deviation of the contact force while following [N].
        force_standard_deviation_n: Option<f64> = "N", "standard deviation", "about the mean";
        /// Standard deviation over mean [%].
        coefficient_of_variation_percent: Option<f64> = "%", "coefficient of variation", "standard deviation / mean";
        /// Root mean square of contact force less desired force while following [N].
        force_rms_error_n: Option<f64> = "N", "RMS error", "of force - desired, following";
        /// That, of the desired force [%].
        force_rms_error_percent: Option<f64> = "%", "RMS error", "of the desired force";
        /// Largest distance of the contact force from the desired force while following [N].
        largest_deviation_n: Option<f64> = "N", "largest deviation", "largest |force - desired|";
        /// Share of the followed length on which the force is within 5 % of the desired one [%].
        within_5_percent_share_percent: Option<f64> = "%", "within 5 % of desired", "share of the length followed";
        /// Share of the followed length on which the force is within 10 % of the desired one [%].
        within_10_percent_share_percent: Option<f64> = "%", "within 10 % of desired", "share of the length followed";
        /// Share of the followed length on which the tool does not touch [%].
        loss_of_contact_share_percent: Option<f64> = "%", "contact lost", "share of the length followed";
        /// Mean friction force while following [N].
        friction_force_mean_n: Option<f64> = "N", "friction, mean", "across the contact normal";
        /// Largest contact force in the phase `approach` [N].
        force_peak_approach_n: Option<f64> = "N", "largest, approach", "of the whole phase";
        /// Largest contact force in the phase `engage` [N].
        force_peak_engage_n: Option<f64> = "N", "largest, engage", "of the whole phase";
        /// Largest contact force in the phase `follow` [N].
        force_peak_follow_n: Option<f64> = "N", "largest, follow", "of the whole phase";
        /// Largest contact force in the phase `retract`, where the tool lifts off [N].
        force_peak_retract_n: Option<f64> = "N", "largest, retract", "of the whole phase";
        /// Largest contact force from first touch to the start of following [N].
        engagement_peak_n: Option<f64> = "N", "peak", "first touch to start of follow";
        /// Excess of that peak over the desired force [%].
        engagement_overshoot_percent: Option<f64> = "%", "overshoot", "peak above desired force";
        /// From first touch until the force stays within 5 % of the desired one [s].
        settling_time_s: Option<f64> = "s", "settling time", "touch until it stays in ±5 %";
        /// Range of the stroke while following [mm].
        stroke_used_mm: Option<f64> = "mm", "stroke used", "largest less smallest stroke";
        /// Smallest stroke while following [mm].
        stroke_min_mm: Option<f64> = "mm", "smallest stroke", "over the following phase";
        /// Largest stroke while following [mm].
        stroke_max_mm: Option<f64> = "mm", "largest stroke", "over the following phase";
        /// Least distance from either end of the stroke while following [mm].
        stroke_margin_mm: Option<f64> = "mm", "stroke margin", "least distance to either end";
        /// Root mean square of the lateral path error while following [µm].
        path_error_rms_um: Option<f64> = "µm", "lateral error, RMS", "tool tip beside planned path";
        /// Largest lateral path error while following [µm].
        path_error_max_um: Option<f64> = "µm", "lateral error, largest", "tool tip beside planned path";
        /// Root mean square of the lag along the path while following [µm].
        path_lag_rms_um: Option<f64> = "µm", "lag, RMS", "tool tip behind its plan";
        /// Largest lag along the path while following [µm].
        path_lag_max_um: Option<f64> = "µm", "lag, largest", "tool tip behind its plan";
        /// Length followed [mm].
        path_length_mm: Option<f64> = "mm", "length followed", "along the planned path";
        /// Length followed over the time it took [mm/s].
        feed_mean_mm_per_s: Option<f64> = "mm/s", "feed, mean", "length followed / its time";
        /// Time of following [s].
        follow_duration_s: Option<f64> = "s", "time of following", "first to last sample of it";
        /// Largest torque of the most loaded joint, of its effort limit, over the run [%].
        joint_torque_share_percent: Option<f64> = "%", "joint torque / limit", "largest of all joints";
        /// Name of that joint.
        most_loaded_joint: Option<String>;
        /// Time for which a drive was at its limit, over the run [s].
        drives_saturated_s: Option<f64> = "s", "drives at their limit", "time of the run";
        /// Largest gap in the balance of the air in the chambers, of their mass, over the run [1].
        air_mass_balance_relative: Option<f64> = "1", "air balance, largest gap", "of the air in the chambers";
    }
    sometimes {
        /// Height of the highest burr before the first pass [mm]; of a turning tool.
        burr_before_max_mm: Option<f64> = "mm", "burr before, highest", "along the edge";
        /// Mean leg of the chamfer along the edge [mm]; of a turning tool.
        chamfer_leg_mean_mm: Option<f64> = "mm", "chamfer leg, mean", "along the edge";
        /// Population standard deviation of the leg [mm]; of a turning tool.
        chamfer_leg_standard_deviation_mm: Option<f64> = "mm", "chamfer leg, spread", "standard deviation of it";
        /// Least leg [mm]; of a turning tool.
        chamfer_leg_min_mm: Option<f64> = "mm", "chamfer leg, least", "along the edge";
        /// Largest leg [mm]; of a turning tool.
        chamfer_leg_max_mm: Option<f64> = "mm", "chamfer leg, largest", "along the edge";
        /// Height of the highest burr that is left [mm]; of a turning tool.
        residual_burr_max_mm: Option<f64> = "mm", "burr left, highest", "along the edge";
        /// Share of the edge on which more burr is left than may be [%]; of a turning tool.
        residual_burr_share_percent: Option<f64> = "%", "burr left", "share of the edge";
        /// Share of the edge out of tolerance, by leg or burr [%]; of a turning tool.
        out_of_tolerance_share_percent: Option<f64> = "%", "out of tolerance", "share of the edge";
        /// Least leg at the ends of the edge [mm]; of a turning tool.
        ends_chamfer_leg_min_mm: Option<f64> = "mm", "ends, leg, least", "at the ends of the edge";
        /// Largest leg at the ends [mm]; of a turning tool.
        ends_chamfer_leg_max_mm: Option<f64> = "mm", "ends, leg, largest", "at the ends of the edge";
        /// Height of the highest burr that is left at the ends [mm]; of a turning tool.
        ends_residual_burr_max_mm: Option<f64> = "mm", "ends, highest burr", "at the ends of the edge";
        /// Share of the ends out of tolerance, by leg or burr [%]; of a turning tool.
        ends_out_of_tolerance_share_percent: Option<f64> = "%", "ends, out of tolerance", "share of the ends";
        /// Share of the whole edge out of tolerance, its ends included [%]; of a turning tool.
        whole_edge_out_of_tolerance_share_percent: Option<f64> = "%", "out of tolerance, whole", "share of the whole edge";
        /// Length of each end [mm]; of a turning tool.
        ends_length_mm: Option<f64> = "mm", "ends, length of each", "a contact length";
        /// Mean section that was taken, of burr and edge [mm2]; of a turning tool.
        section_removed_mean_mm2: Option<f64> = "mm2", "section removed, mean", "of burr and edge";
        /// Standard deviation of that section over its mean [%]; of a turning tool.
        section_variation_percent: Option<f64> = "%", "section, variation", "standard deviation / mean";
        /// Volume that was taken [mm3]; of a turning tool.
        removed_volume_mm3: Option<f64> = "mm3", "volume removed", "of burr and edge";
        /// Mean removal rate while something comes off [mm3/s]; of a turning tool.
        removal_rate_mean_mm3_per_s: Option<f64> = "mm3/s", "removal rate, mean", "while cutting";
        /// Largest power at the tool [W]; of a turning tool.
        spindle_power_max_w: Option<f64> = "W", "spindle power, largest", "at the tool";
        /// Energy that the spindle gave at the tool [kJ]; of a turning tool.
        spindle_energy_kj: Option<f64> = "kJ", "spindle energy", "at the tool";
        /// Work of force and cutting speed that the tool has done [kJ]; of a turning tool.
        tool_wear_kj: Option<f64> = "kJ", "tool wear", "work of force and speed";
        /// Air that has entered the device [g]; of a turning tool.
        air_used_g: Option<f64> = "g", "air used", "entered the device";
    }
    always {
        /// Simulated time of the whole run [s].
        duration_s: f64 = "s", "cycle time", "approach to retract";
        /// Each joint's largest torque, base first.
        joints: Vec<JointTorqueShare>;
        /// Each pass along the edge, in order.
        #[serde(default)]
        passes: Vec<PassSummary>;
        /// The force in each tenth of the followed length; empty if nothing was followed.
        force_by_tenth: Vec<ForceTenth>;
        /// Duration of the computation; differs from run to run.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        timing: Option<Timing>;
    }
    also [
        entry("wall_time_s", "s", "wall time", "of the computation", |s| {
            s.timing.map(|timing| timing.wall_time_s)
        }),
        entry("real_time_factor", "1", "real-time factor", "simulated time / wall time", |s| {
            s.timing.map(|timing| timing.real_time_factor)
        })
    ]
}

/// The metric of a name.
#[must_use]
pub fn metric(name: &str) -> Option<&'static Metric<Summary>> {
    METRICS.iter().find(|metric| metric.name == name)
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

metrics! {
    /// The numbers of one pass; each is defined as that of its name in [`Summary`], over this pass alone.
    PassSummary,
    /// Every number of a pass, in the order of summary.json.
    PASS_METRICS;
    always {
        /// Number of the pass, from 1.
        pass: usize;
        /// Desired contact force [N].
        desired_force_n: f64 = "N", "desired force", "what the pass asks for";
        /// Mean contact force [N].
        force_mean_n: Option<f64> = "N", "mean", "over the pass";
        /// Population standard deviation of it [N].
        force_standard_deviation_n: Option<f64> = "N", "standard deviation", "about the mean";
        /// Standard deviation over mean [%].
        coefficient_of_variation_percent: Option<f64> = "%", "coefficient of variation", "standard deviation / mean";
        /// Root mean square of contact force less desired force [N].
        force_rms_error_n: Option<f64> = "N", "RMS error", "of force - desired";
        /// That, of the desired force [%].
        force_rms_error_percent: Option<f64> = "%", "RMS error", "of the desired force";
        /// Largest distance of the contact force from the desired one [N].
        largest_deviation_n: Option<f64> = "N", "largest deviation", "largest |force - desired|";
        /// Share of the length on which the force is within 5 % of the desired one [%].
        within_5_percent_share_percent: Option<f64> = "%", "within 5 % of desired", "share of the length followed";
        /// Share of the length on which it is within 10 % [%].
        within_10_percent_share_percent: Option<f64> = "%", "within 10 % of desired", "share of the length followed";
        /// Share of the length on which the tool does not touch [%].
        loss_of_contact_share_percent: Option<f64> = "%", "contact lost", "share of the length followed";
        /// Largest contact force [N].
        force_peak_follow_n: Option<f64> = "N", "largest", "of the pass";
        /// Root mean square of the lateral path error [µm].
        path_error_rms_um: Option<f64> = "µm", "lateral error, RMS", "tool tip beside planned path";
        /// Largest lateral path error [µm].
        path_error_max_um: Option<f64> = "µm", "lateral error, largest", "tool tip beside planned path";
        /// Root mean square of the lag along the path [µm].
        path_lag_rms_um: Option<f64> = "µm", "lag, RMS", "tool tip behind its plan";
        /// Largest lag along the path [µm].
        path_lag_max_um: Option<f64> = "µm", "lag, largest", "tool tip behind its plan";
        /// Length followed [mm].
        path_length_mm: Option<f64> = "mm", "length followed", "along the planned path";
        /// Length followed over the time it took [mm/s].
        feed_mean_mm_per_s: Option<f64> = "mm/s", "feed, mean", "length followed / its time";
        /// Time of following [s].
        follow_duration_s: Option<f64> = "s", "time of following", "first to last sample of it";
    }
    sometimes {}
    always {}
    also []
}

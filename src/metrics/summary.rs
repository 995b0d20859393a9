//! The numbers of a run as they stand in summary.json.
//!
//! Field names are file keys, so each ends in its unit; docs/METRICS.md has the definitions from here.

use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::catalogue::{Metric, metrics};
use super::note;

metrics! {
    /// The numbers of a run; keys are written in the order of the fields.
    ///
    /// All but `timing` follow from the recording alone, bit for bit.
    Summary,
    /// Every metric, in the order of summary.json.
    METRICS;
    always {
        desired_force_n: f64 = "N", "desired force", "what the scenario asks for", Force [beside],
            "F_d, which the scenario asks for.";
        force_mean_n: Option<f64> = "N", "mean", "over the following phase", Force [of("force"), fact(4), rank(5), note(note::from_desired)],
            "m = (1/n) * sum of F_i.";
        force_standard_deviation_n: Option<f64> = "N", "standard deviation", "about the mean", Force [of("force")],
            "d = sqrt((1/n) * sum of (F_i - m)^2). Of the population (divided by n): the samples are all of the run, not a draw from more.";
        coefficient_of_variation_percent: Option<f64> = "%", "coefficient of variation", "standard deviation / mean", Force [fact(5), rank(6)],
            "100 d / m; undefined unless m > 0. How uniform the force is, whether or not it is the right one.";
        force_rms_error_n: Option<f64> = "N", "RMS error", "of force - desired, following", Force [of("force"), note(note::of_desired)],
            "sqrt((1/n) * sum of (F_i - F_d)^2). Offset and spread together: its square is (m - F_d)^2 + d^2.";
        force_rms_error_percent: Option<f64> = "%", "RMS error", "of the desired force", Force [of("force"), beside, fact(7)],
            "100 * `force_rms_error_n` / F_d.";
        largest_deviation_n: Option<f64> = "N", "largest deviation", "largest |force - desired|", Force [rank(7)],
            "Largest abs(F_i - F_d). From the desired force, so that an offset counts.";
        within_5_percent_share_percent: Option<f64> = "%", "within 5 % of desired", "share of the length followed", Force [fact(6)],
            "Share of the length with abs(F - F_d) <= 0.05 F_d.";
        within_10_percent_share_percent: Option<f64> = "%", "within 10 % of desired", "share of the length followed", Force [],
            "Share of the length with abs(F - F_d) <= 0.10 F_d.";
        loss_of_contact_share_percent: Option<f64> = "%", "contact lost", "share of the length followed", Force [],
            "Share of the length on which the tool does not touch.";
        friction_force_mean_n: Option<f64> = "N", "friction, mean", "across the contact normal", Force [],
            "Mean of `friction_force`, the size of the contact force's part across the normal.";
        force_peak_approach_n: Option<f64> = "N", "largest, approach", "of the whole phase", Peaks [of("force"), column("approach")],
            "Largest `contact_force_peak` over all samples of the phase `approach`.";
        force_peak_engage_n: Option<f64> = "N", "largest, engage", "of the whole phase", Peaks [of("force"), column("engage")],
            "Largest `contact_force_peak` over all samples of the phase `engage`.";
        force_peak_follow_n: Option<f64> = "N", "largest, follow", "of the whole phase", Peaks [of("force"), column("follow"), note(note::of_first_pass)],
            "Largest `contact_force_peak` over all samples of the phase `follow`.";
        force_peak_retract_n: Option<f64> = "N", "largest, retract", "of the whole phase", Peaks [of("force"), column("retract")],
            "Largest `contact_force_peak` over all samples of the phase `retract`. A tool that chatters against its end stop while it lifts off shows here.";
        engagement_peak_n: Option<f64> = "N", "peak", "first touch to start of follow", Touch [of("engagement"), rank(8), note(note::above_desired)],
            "Largest `contact_force_peak` in the window (F where that is not recorded); if the run stopped before following, up to its end. This is what can gouge the part.";
        engagement_overshoot_percent: Option<f64> = "%", "overshoot", "peak above desired force", Touch [of("engagement"), beside],
            "100 * max(0, peak - F_d) / F_d.";
        settling_time_s: Option<f64> = "s", "settling time", "touch until it stays in ±5 %", Touch [rank(10)],
            "Time from first touch to the first sample from which on abs(F - F_d) <= 0.05 F_d holds to the end of the window. Undefined if the force is outside at the end of the window, or if following never starts. If it is undefined, lengthen `settle_time`.";
        stroke_used_mm: Option<f64> = "mm", "stroke used", "largest less smallest stroke", Stroke [note(note::strokes)],
            "Largest less smallest `stroke`.";
        stroke_min_mm: Option<f64> = "mm", "smallest stroke", "over the following phase", Stroke [beside],
            "Smallest `stroke`; zero is retracted.";
        stroke_max_mm: Option<f64> = "mm", "largest stroke", "over the following phase", Stroke [beside],
            "Largest `stroke`.";
        stroke_margin_mm: Option<f64> = "mm", "stroke margin", "least distance to either end", Stroke [fact(9), rank(9)],
            "min(smallest stroke - lower end, upper end - largest stroke). How much more misplacement the device could take; negative inside an end stop.";
        path_error_rms_um: Option<f64> = "µm", "lateral error, RMS", "tool tip beside planned path", Path [rank(11)],
            "sqrt((1/n) * sum of e_i^2) with e = `path_error`, the lateral error: the distance of the tool tip beside the planned path, across path and contact normal, positive to the left of travel. The tip is where joints and slide have taken the ball's centre, its planned place that of the plan at the same time; a leaned slide that gives way moves it aside as well. Along the normal the device gives way by design; that is the stroke, not an error.";
        path_error_max_um: Option<f64> = "µm", "lateral error, largest", "tool tip beside planned path", Path [],
            "Largest abs(e_i).";
        path_lag_rms_um: Option<f64> = "µm", "lag, RMS", "tool tip behind its plan", Path [],
            "sqrt((1/n) * sum of l_i^2) with l = `path_lag`, the distance by which the tip lags behind its planned place along the path, negative ahead of it. Drives that lag behind their commands by a second-order response of bandwidth f (`arm.servo.lag_bandwidth_hz`), critically damped, lag by 2 feed / (2 pi f) at a steady feed.";
        path_lag_max_um: Option<f64> = "µm", "lag, largest", "tool tip behind its plan", Path [],
            "Largest abs(l_i).";
        path_length_mm: Option<f64> = "mm", "length followed", "along the planned path", Path [note(note::feed)],
            "sum of abs(s_i - s_(i-1)): the length followed.";
        feed_mean_mm_per_s: Option<f64> = "mm/s", "feed, mean", "length followed / its time", Path [beside],
            "Length followed / `follow_duration_s`; below the set feed by starts, ends and corners.";
        follow_duration_s: Option<f64> = "s", "time of following", "first to last sample of it", Time [beside],
            "From the first to the last sample of following; one sample interval less than the phase.";
        joint_torque_share_percent: Option<f64> = "%", "joint torque / limit", "largest of all joints", Run [note(note::most_loaded)],
            "The largest of the joints' shares, 100 * max over time of abs(torque) / effort limit, over all phases: an arm that saturates while approaching is too weak as well.";
        /// Name of that joint.
        most_loaded_joint: Option<String>;
        drives_saturated_s: Option<f64> = "s", "drives at their limit", "time of the run", Run [note(note::first_saturated)],
            "Time for which any drive is at its limit: sum of the steps that end in a sample with abs(torque) at least (1 - 1e-9) times an effort limit. No drive gives more than its limit; what the servo asks for beyond it is lost. Unless `[expect]` sets a bound on it, `max = 0` stands: a run in which a drive is at its limit ends with exit code 1.";
        air_mass_balance_relative: Option<f64> = "1", "air balance, largest gap", "of the air in the chambers", Run [],
            "Largest over time of abs((entered - left) - (mass - mass at the start)) / mass, with entered and left both counted from the first sample, and mass the air in both chambers. How far the simulated pneumatics create or lose air; rounding leaves some 1e-13.";
    }
    sometimes {
        burr_before_max_mm: Option<f64> = "mm", "burr before, highest", "along the edge", Edge [],
            "Height of the highest burr before the first pass.";
        chamfer_leg_mean_mm: Option<f64> = "mm", "chamfer leg, mean", "along the edge", Edge [fact(1), rank(1), note(note::legs)],
            "Mean of the chamfer's leg over the stations.";
        chamfer_leg_standard_deviation_mm: Option<f64> = "mm", "chamfer leg, spread", "standard deviation of it", Edge [],
            "Population standard deviation of the leg over the stations.";
        chamfer_leg_min_mm: Option<f64> = "mm", "chamfer leg, least", "along the edge", Edge [beside],
            "Least leg over the stations.";
        chamfer_leg_max_mm: Option<f64> = "mm", "chamfer leg, largest", "along the edge", Edge [beside],
            "Largest leg over the stations.";
        residual_burr_max_mm: Option<f64> = "mm", "burr left, highest", "along the edge", Edge [fact(3), rank(2), note(note::too_much_burr)],
            "Height of the highest burr that is left.";
        residual_burr_share_percent: Option<f64> = "%", "burr left", "share of the edge", Edge [beside],
            "Share of the stations on which more than `residual_burr_max_mm` of the scenario is left.";
        out_of_tolerance_share_percent: Option<f64> = "%", "out of tolerance", "share of the edge", Edge [fact(2), rank(3), note(note::with_its_ends)],
            "Share of the stations on which more than `residual_burr_max_mm` of the scenario is left, or the leg lies outside `leg_min_mm` to `leg_max_mm`.";
        ends_chamfer_leg_min_mm: Option<f64> = "mm", "ends, leg, least", "at the ends of the edge", Edge [beside],
            "Least leg over the stations of both ends, which the numbers above leave out.";
        ends_chamfer_leg_max_mm: Option<f64> = "mm", "ends, leg, largest", "at the ends of the edge", Edge [note(note::legs_of_ends)],
            "Largest leg over the stations of both ends.";
        ends_residual_burr_max_mm: Option<f64> = "mm", "ends, highest burr", "at the ends of the edge", Edge [],
            "Height of the highest burr that is left on the stations of both ends.";
        ends_out_of_tolerance_share_percent: Option<f64> = "%", "ends, out of tolerance", "share of the ends", Edge [note(note::length_of_ends)],
            "Share of the stations of both ends out of tolerance.";
        whole_edge_out_of_tolerance_share_percent: Option<f64> = "%", "out of tolerance, whole", "share of the whole edge", Edge [beside],
            "Share of all stations out of tolerance.";
        ends_length_mm: Option<f64> = "mm", "ends, length of each", "a contact length", Edge [beside],
            "Length of each end: `removal.contact_length_mm`.";
        section_removed_mean_mm2: Option<f64> = "mm2", "section removed, mean", "of burr and edge", Edge [beside],
            "Mean of the section that was taken, of burr and edge.";
        section_variation_percent: Option<f64> = "%", "section, variation", "standard deviation / mean", Edge [],
            "100 * population standard deviation of the removed section / its mean.";
        removed_volume_mm3: Option<f64> = "mm3", "volume removed", "of burr and edge", Edge [note(note::rate)],
            "Sum of the removed section times the stations' distance, over the whole edge.";
        removal_rate_mean_mm3_per_s: Option<f64> = "mm3/s", "removal rate, mean", "while cutting", Edge [beside],
            "Time integral of `removal_rate` / time in which it is above 0; each sample stands for the step before it.";
        spindle_power_max_w: Option<f64> = "W", "spindle power, largest", "at the tool", Edge [],
            "Largest `spindle_power`.";
        spindle_energy_kj: Option<f64> = "kJ", "spindle energy", "at the tool", Edge [beside],
            "Time integral of `spindle_power`.";
        tool_wear_kj: Option<f64> = "kJ", "tool wear", "work of force and speed", Edge [],
            "`tool_wear` at the end of the run: the work of normal force and cutting speed.";
        air_used_g: Option<f64> = "g", "air used", "entered the device", Edge [beside],
            "`mass_entered` at the end of the run.";
    }
    always {
        duration_s: f64 = "s", "cycle time", "approach to retract", Time [fact(8), rank(4), note(note::following)],
            "Cycle time: simulated time from the first to the last sample, which of a job that is done are those of approach and retract.";
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
    also {
        timing.wall_time_s = "s", "wall time", "of the computation", Run [beside],
            "Wall-clock time of the computation, as measured by the program.";
        timing.real_time_factor = "1", "real-time factor", "simulated time / wall time", Run [note(note::wall_time)],
            "Simulated time / wall time: 10 means ten times faster than the real cell.";
    }
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
        desired_force_n: f64 = "N", "desired force", "what the pass asks for", Force [column("desired")],
            "Desired contact force.";
        force_mean_n: Option<f64> = "N", "mean", "over the pass", Force [column("mean")],
            "Mean contact force.";
        force_standard_deviation_n: Option<f64> = "N", "standard deviation", "about the mean", Force [column("SD")],
            "Population standard deviation of it.";
        coefficient_of_variation_percent: Option<f64> = "%", "coefficient of variation", "standard deviation / mean", Force [],
            "Standard deviation over mean.";
        force_rms_error_n: Option<f64> = "N", "RMS error", "of force - desired", Force [],
            "Root mean square of contact force less desired force.";
        force_rms_error_percent: Option<f64> = "%", "RMS error", "of the desired force", Force [column("RMS error")],
            "That, of the desired force.";
        largest_deviation_n: Option<f64> = "N", "largest deviation", "largest |force - desired|", Force [],
            "Largest distance of the contact force from the desired one.";
        within_5_percent_share_percent: Option<f64> = "%", "within 5 % of desired", "share of the length followed", Force [column("in 5 %")],
            "Share of the length on which the force is within 5 % of the desired one.";
        within_10_percent_share_percent: Option<f64> = "%", "within 10 % of desired", "share of the length followed", Force [],
            "Share of the length on which it is within 10 %.";
        loss_of_contact_share_percent: Option<f64> = "%", "contact lost", "share of the length followed", Force [],
            "Share of the length on which the tool does not touch.";
        force_peak_follow_n: Option<f64> = "N", "largest", "of the pass", Peaks [column("largest")],
            "Largest contact force.";
        path_error_rms_um: Option<f64> = "µm", "lateral error, RMS", "tool tip beside planned path", Path [],
            "Root mean square of the lateral path error.";
        path_error_max_um: Option<f64> = "µm", "lateral error, largest", "tool tip beside planned path", Path [],
            "Largest lateral path error.";
        path_lag_rms_um: Option<f64> = "µm", "lag, RMS", "tool tip behind its plan", Path [],
            "Root mean square of the lag along the path.";
        path_lag_max_um: Option<f64> = "µm", "lag, largest", "tool tip behind its plan", Path [],
            "Largest lag along the path.";
        path_length_mm: Option<f64> = "mm", "length followed", "along the planned path", Path [],
            "Length followed.";
        feed_mean_mm_per_s: Option<f64> = "mm/s", "feed, mean", "length followed / its time", Path [column("feed")],
            "Length followed over the time it took.";
        follow_duration_s: Option<f64> = "s", "time of following", "first to last sample of it", Time [],
            "Time of following.";
    }
    sometimes {}
    always {}
    also {}
}

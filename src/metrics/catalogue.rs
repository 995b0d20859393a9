//! The list of metrics: name, unit, meaning in short and where the value stands.
//!
//! Bounds are looked up here and reports are made from it; docs/METRICS.md has the full definitions.

use super::Summary;

/// One number of a run.
#[derive(Debug, Clone, Copy)]
pub struct Metric<S = Summary> {
    /// Key in summary.json, unit included.
    pub name: &'static str,
    /// Unit as it is printed.
    pub unit: &'static str,
    /// Name for people, within its part of the report.
    pub label: &'static str,
    /// Its meaning, in a few words.
    pub meaning: &'static str,
    /// Its value, if the run determines it.
    pub value: fn(&S) -> Option<f64>,
}

impl<S> Metric<S> {
    /// Its unit; empty for a pure number.
    #[must_use]
    pub fn shown_unit(&self) -> &'static str {
        match self.unit {
            "1" => "",
            unit => unit,
        }
    }

    /// Name for people where it stands alone, as in `force, mean`.
    #[must_use]
    pub fn full_label(&self) -> String {
        let subjects = ["force", "engagement"];
        let subject = subjects
            .into_iter()
            .find(|subject| self.name.starts_with(subject) && !self.label.contains(subject));
        subject.map_or_else(
            || self.label.to_owned(),
            |subject| format!("{subject}, {}", self.label),
        )
    }
}

pub(super) const fn entry<S>(
    name: &'static str,
    unit: &'static str,
    label: &'static str,
    meaning: &'static str,
    value: fn(&S) -> Option<f64>,
) -> Metric<S> {
    Metric {
        name,
        unit,
        label,
        meaning,
        value,
    }
}

/// Every metric, in the order of summary.json.
#[rustfmt::skip]
pub const METRICS: &[Metric] = &[
    entry("desired_force_n", "N", "desired force",
        "what the scenario asks for", |s| Some(s.desired_force_n)),
    entry("force_mean_n", "N", "mean",
        "over the following phase", |s| s.force_mean_n),
    entry("force_standard_deviation_n", "N", "standard deviation",
        "about the mean", |s| s.force_standard_deviation_n),
    entry("coefficient_of_variation_percent", "%", "coefficient of variation",
        "standard deviation / mean", |s| s.coefficient_of_variation_percent),
    entry("force_rms_error_n", "N", "RMS error",
        "of force - desired, following", |s| s.force_rms_error_n),
    entry("force_rms_error_percent", "%", "RMS error",
        "of the desired force", |s| s.force_rms_error_percent),
    entry("largest_deviation_n", "N", "largest deviation",
        "largest |force - desired|", |s| s.largest_deviation_n),
    entry("within_5_percent_share_percent", "%", "within 5 % of desired",
        "share of the length followed", |s| s.within_5_percent_share_percent),
    entry("within_10_percent_share_percent", "%", "within 10 % of desired",
        "share of the length followed", |s| s.within_10_percent_share_percent),
    entry("loss_of_contact_share_percent", "%", "contact lost",
        "share of the length followed", |s| s.loss_of_contact_share_percent),
    entry("friction_force_mean_n", "N", "friction, mean",
        "across the contact normal", |s| s.friction_force_mean_n),
    entry("force_peak_approach_n", "N", "largest, approach",
        "of the whole phase", |s| s.force_peak_approach_n),
    entry("force_peak_engage_n", "N", "largest, engage",
        "of the whole phase", |s| s.force_peak_engage_n),
    entry("force_peak_follow_n", "N", "largest, follow",
        "of the whole phase", |s| s.force_peak_follow_n),
    entry("force_peak_retract_n", "N", "largest, retract",
        "of the whole phase", |s| s.force_peak_retract_n),
    entry("engagement_peak_n", "N", "peak",
        "first touch to start of follow", |s| s.engagement_peak_n),
    entry("engagement_overshoot_percent", "%", "overshoot",
        "peak above desired force", |s| s.engagement_overshoot_percent),
    entry("settling_time_s", "s", "settling time",
        "touch until it stays in ±5 %", |s| s.settling_time_s),
    entry("stroke_used_mm", "mm", "stroke used",
        "largest less smallest stroke", |s| s.stroke_used_mm),
    entry("stroke_min_mm", "mm", "smallest stroke",
        "over the following phase", |s| s.stroke_min_mm),
    entry("stroke_max_mm", "mm", "largest stroke",
        "over the following phase", |s| s.stroke_max_mm),
    entry("stroke_margin_mm", "mm", "stroke margin",
        "least distance to either end", |s| s.stroke_margin_mm),
    entry("path_error_rms_um", "µm", "lateral error, RMS",
        "tool tip beside planned path", |s| s.path_error_rms_um),
    entry("path_error_max_um", "µm", "lateral error, largest",
        "tool tip beside planned path", |s| s.path_error_max_um),
    entry("path_lag_rms_um", "µm", "lag, RMS",
        "tool tip behind its plan", |s| s.path_lag_rms_um),
    entry("path_lag_max_um", "µm", "lag, largest",
        "tool tip behind its plan", |s| s.path_lag_max_um),
    entry("path_length_mm", "mm", "length followed",
        "along the planned path", |s| s.path_length_mm),
    entry("feed_mean_mm_per_s", "mm/s", "feed, mean",
        "length followed / its time", |s| s.feed_mean_mm_per_s),
    entry("follow_duration_s", "s", "time of following",
        "first to last sample of it", |s| s.follow_duration_s),
    entry("joint_torque_share_percent", "%", "joint torque / limit",
        "largest of all joints", |s| s.joint_torque_share_percent),
    entry("drives_saturated_s", "s", "drives at their limit",
        "time of the run", |s| s.drives_saturated_s),
    entry("air_mass_balance_relative", "1", "air balance, largest gap",
        "of the air in the chambers", |s| s.air_mass_balance_relative),
    entry("burr_before_max_mm", "mm", "burr before, highest",
        "along the edge", |s| s.burr_before_max_mm),
    entry("chamfer_leg_mean_mm", "mm", "chamfer leg, mean",
        "along the edge", |s| s.chamfer_leg_mean_mm),
    entry("chamfer_leg_standard_deviation_mm", "mm", "chamfer leg, spread",
        "standard deviation of it", |s| s.chamfer_leg_standard_deviation_mm),
    entry("chamfer_leg_min_mm", "mm", "chamfer leg, least",
        "along the edge", |s| s.chamfer_leg_min_mm),
    entry("chamfer_leg_max_mm", "mm", "chamfer leg, largest",
        "along the edge", |s| s.chamfer_leg_max_mm),
    entry("residual_burr_max_mm", "mm", "burr left, highest",
        "along the edge", |s| s.residual_burr_max_mm),
    entry("residual_burr_share_percent", "%", "burr left",
        "share of the edge", |s| s.residual_burr_share_percent),
    entry("out_of_tolerance_share_percent", "%", "out of tolerance",
        "share of the edge", |s| s.out_of_tolerance_share_percent),
    entry("ends_chamfer_leg_min_mm", "mm", "ends, leg, least",
        "at the ends of the edge", |s| s.ends_chamfer_leg_min_mm),
    entry("ends_chamfer_leg_max_mm", "mm", "ends, leg, largest",
        "at the ends of the edge", |s| s.ends_chamfer_leg_max_mm),
    entry("ends_residual_burr_max_mm", "mm", "ends, highest burr",
        "at the ends of the edge", |s| s.ends_residual_burr_max_mm),
    entry("ends_out_of_tolerance_share_percent", "%", "ends, out of tolerance",
        "share of the ends", |s| s.ends_out_of_tolerance_share_percent),
    entry("whole_edge_out_of_tolerance_share_percent", "%", "out of tolerance, whole",
        "share of the whole edge", |s| s.whole_edge_out_of_tolerance_share_percent),
    entry("ends_length_mm", "mm", "ends, length of each",
        "a contact length", |s| s.ends_length_mm),
    entry("section_removed_mean_mm2", "mm2", "section removed, mean",
        "of burr and edge", |s| s.section_removed_mean_mm2),
    entry("section_variation_percent", "%", "section, variation",
        "standard deviation / mean", |s| s.section_variation_percent),
    entry("removed_volume_mm3", "mm3", "volume removed",
        "of burr and edge", |s| s.removed_volume_mm3),
    entry("removal_rate_mean_mm3_per_s", "mm3/s", "removal rate, mean",
        "while cutting", |s| s.removal_rate_mean_mm3_per_s),
    entry("spindle_power_max_w", "W", "spindle power, largest",
        "at the tool", |s| s.spindle_power_max_w),
    entry("spindle_energy_kj", "kJ", "spindle energy",
        "at the tool", |s| s.spindle_energy_kj),
    entry("tool_wear_kj", "kJ", "tool wear",
        "work of force and speed", |s| s.tool_wear_kj),
    entry("air_used_g", "g", "air used",
        "entered the device", |s| s.air_used_g),
    entry("duration_s", "s", "cycle time",
        "approach to retract", |s| Some(s.duration_s)),
    entry("wall_time_s", "s", "wall time",
        "of the computation", |s| s.timing.map(|timing| timing.wall_time_s)),
    entry("real_time_factor", "1", "real-time factor",
        "simulated time / wall time", |s| s.timing.map(|timing| timing.real_time_factor)),
];

/// The metric of a name.
#[must_use]
pub fn metric(name: &str) -> Option<&'static Metric> {
    METRICS.iter().find(|metric| metric.name == name)
}

#[cfg(test)]
mod tests {
    use super::super::Timing;
    use super::super::summarise;
    use super::super::test_recordings::{Builder, limits};
    use super::*;

    /// Keys of summary.json that are no numbers to set bounds on.
    const OTHER_KEYS: [&str; 5] = [
        "most_loaded_joint",
        "joints",
        "passes",
        "force_by_tenth",
        "timing",
    ];

    #[test]
    fn the_list_is_the_file_key_by_key() {
        let mut summary = summarise(&Builder::nominal().build(), &limits()).unwrap();
        summary.timing = Some(Timing::new(8.0, 2.0));
        assert_eq!(
            metric("real_time_factor").and_then(|m| (m.value)(&summary)),
            Some(4.0)
        );
        let file = serde_json::to_value(&summary).unwrap();
        let timing = &file["timing"];
        for metric in METRICS {
            let found = file.get(metric.name).or_else(|| timing.get(metric.name));
            let found = found.and_then(serde_json::Value::as_f64);
            assert_eq!(found, (metric.value)(&summary), "{}", metric.name);
        }
        for key in file.as_object().unwrap().keys() {
            let known = metric(key).is_some() || OTHER_KEYS.contains(&key.as_str());
            assert!(known, "{key} is not listed");
        }
    }

    #[test]
    fn names_stand_in_the_order_of_the_file() {
        let summary = summarise(&Builder::nominal().build(), &limits()).unwrap();
        let text = serde_json::to_string(&summary).unwrap();
        let places = METRICS
            .iter()
            .filter_map(|m| text.find(&format!("\"{}\":", m.name)));
        let places: Vec<usize> = places.collect();
        // Timing, and what only a turning tool has.
        assert_eq!(places.len(), METRICS.len() - 24);
        assert!(places.is_sorted());
    }

    #[test]
    fn every_metric_is_defined_in_the_document() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/METRICS.md");
        let document = std::fs::read_to_string(path).unwrap();
        for metric in METRICS {
            assert!(
                document.contains(&format!("`{}`", metric.name)),
                "{}",
                metric.name
            );
        }
        for key in OTHER_KEYS {
            assert!(document.contains(&format!("`{key}`")), "{key}");
        }
    }
}

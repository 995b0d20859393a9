//! The finished edge: chamfer and burr along it, what was taken, and what the spindle gave for it.

use super::statistics::{extent, largest};
use super::window::Window;
use super::{MetricsError, Summary};
use crate::recording::csv::EdgeProfile;
use crate::recording::{Unit, schema};

/// What an edge is measured against.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeLimits {
    /// Least and largest leg of a good chamfer [m].
    pub leg: [f64; 2],
    /// Largest burr that may be left [m].
    pub residual_burr: f64,
    /// Length at both ends of the edge that is left out of account [m]: where the tool is set on and lifted off.
    pub ends: f64,
}

/// Fills in the numbers of an edge that a turning tool has worked.
pub(super) fn measure(summary: &mut Summary, profile: &EdgeProfile, limits: &EdgeLimits) {
    let (Some(first), Some(last)) = (profile.place.first(), profile.place.last()) else {
        return;
    };
    ends(summary, profile, limits);
    let (from, to) = (first + limits.ends, last - limits.ends);
    let between_ends: Vec<usize> = (0..profile.place.len())
        .filter(|&i| (from..=to).contains(&profile.place[i]))
        .collect();
    let of = |values: &[f64]| -> Vec<f64> { between_ends.iter().map(|&i| values[i]).collect() };
    let legs = of(&profile.chamfer_leg);
    let burrs = of(&profile.burr_after);
    let sections = of(&profile.section_removed);
    if legs.is_empty() {
        return;
    }
    let (mean, deviation) = moments(&legs);
    summary.chamfer_leg_mean_mm = Some(1e3 * mean);
    summary.chamfer_leg_standard_deviation_mm = Some(1e3 * deviation);
    if let Some((least, most)) = extent(&legs) {
        summary.chamfer_leg_min_mm = Some(1e3 * least);
        summary.chamfer_leg_max_mm = Some(1e3 * most);
    }
    let before = of(&profile.burr_before);
    summary.burr_before_max_mm = largest(before).map(|burr| 1e3 * burr);
    summary.residual_burr_max_mm = largest(burrs.iter().copied()).map(|burr| 1e3 * burr);
    let count = legs.len() as f64;
    let left = burrs.iter().filter(|burr| **burr > limits.residual_burr);
    summary.residual_burr_share_percent = Some(100.0 * left.count() as f64 / count);
    summary.out_of_tolerance_share_percent = out_of_tolerance(profile, limits, &between_ends);
    let (mean, deviation) = moments(&sections);
    summary.section_removed_mean_mm2 = Some(1e6 * mean);
    summary.section_variation_percent = (mean > 0.0).then(|| 100.0 * deviation / mean);
    // Stations are evenly spaced.
    let spacing = (last - first) / (profile.place.len() - 1).max(1) as f64;
    let volume = profile.section_removed.iter().sum::<f64>() * spacing;
    summary.removed_volume_mm3 = Some(1e9 * volume);
}

/// Share of stations out of tolerance, by leg or burr [%]; `None` of no station.
fn out_of_tolerance(profile: &EdgeProfile, limits: &EdgeLimits, of: &[usize]) -> Option<f64> {
    let is_out = |&&i: &&usize| {
        let is_good = (limits.leg[0]..=limits.leg[1]).contains(&profile.chamfer_leg[i]);
        !is_good || profile.burr_after[i] > limits.residual_burr
    };
    (!of.is_empty()).then(|| 100.0 * of.iter().filter(is_out).count() as f64 / of.len() as f64)
}

/// Fills in the numbers of both ends, which the others leave out, and of the edge as a whole.
fn ends(summary: &mut Summary, profile: &EdgeProfile, limits: &EdgeLimits) {
    let all: Vec<usize> = (0..profile.place.len()).collect();
    summary.whole_edge_out_of_tolerance_share_percent = out_of_tolerance(profile, limits, &all);
    let (first, last) = (profile.place[0], profile.place[all.len() - 1]);
    let between = first + limits.ends..=last - limits.ends;
    let is_end = |i: &usize| !between.contains(&profile.place[*i]);
    let ends: Vec<usize> = all.into_iter().filter(is_end).collect();
    summary.ends_out_of_tolerance_share_percent = out_of_tolerance(profile, limits, &ends);
    let of = |values: &[f64]| -> Vec<f64> { ends.iter().map(|&i| 1e3 * values[i]).collect() };
    if let Some((least, most)) = extent(&of(&profile.chamfer_leg)) {
        summary.ends_chamfer_leg_min_mm = Some(least);
        summary.ends_chamfer_leg_max_mm = Some(most);
    }
    summary.ends_residual_burr_max_mm = largest(of(&profile.burr_after));
    summary.ends_length_mm = Some(1e3 * limits.ends);
}

/// Fills in what the tool and its spindle did over the whole run.
pub(super) fn of_tool(summary: &mut Summary, run: &Window) -> Result<(), MetricsError> {
    let time = run.time();
    let integral = |values: &[f64]| -> f64 {
        // A sample holds what the step before it did.
        let steps = time.windows(2).zip(&values[1..]);
        steps.map(|(pair, value)| (pair[1] - pair[0]) * value).sum()
    };
    if let Some(power) = run.finite(schema::SPINDLE_POWER, Unit::Watt)? {
        summary.spindle_power_max_w = largest(power.iter().copied());
        summary.spindle_energy_kj = Some(1e-3 * integral(power));
    }
    if let Some(rate) = run.finite(schema::REMOVAL_RATE, Unit::CubicMetrePerSecond)? {
        let cutting: f64 = time
            .windows(2)
            .zip(&rate[1..])
            .filter(|(_, rate)| **rate > 0.0)
            .map(|(pair, _)| pair[1] - pair[0])
            .sum();
        summary.removal_rate_mean_mm3_per_s =
            (cutting > 0.0).then(|| 1e9 * integral(rate) / cutting);
    }
    if let Some(wear) = run.finite(schema::TOOL_WEAR, Unit::Joule)? {
        summary.tool_wear_kj = wear.last().map(|wear| 1e-3 * wear);
    }
    if summary.tool_wear_kj.is_some()
        && let Some(entered) = run.finite(schema::MASS_ENTERED, Unit::Kilogram)?
    {
        summary.air_used_g = entered.last().map(|mass| 1e3 * mass);
    }
    Ok(())
}

/// Mean and population standard deviation.
fn moments(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square = values
        .iter()
        .map(|value| (value - mean).powi(2))
        .sum::<f64>()
        / count;
    (mean, square.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_is_checked_between_its_ends_by_leg_and_burr() {
        let count = 100;
        let mut profile = EdgeProfile {
            place: (0..count).map(|i| 1e-3 * f64::from(i)).collect(),
            burr_before: vec![0.3e-3; 100],
            burr_after: vec![0.0; 100],
            chamfer_leg: vec![0.3e-3; 100],
            section_removed: vec![0.07e-6; 100],
        };
        profile.chamfer_leg[0] = 2e-3;
        for i in 50..60 {
            profile.chamfer_leg[i] = 0.6e-3;
        }
        profile.burr_after[70] = 0.1e-3;
        profile.burr_after[71] = 0.01e-3;
        let limits = EdgeLimits {
            leg: [0.2e-3, 0.5e-3],
            residual_burr: 0.02e-3,
            ends: 5e-3,
        };
        let mut summary = Summary::default();
        measure(&mut summary, &profile, &limits);
        let near = |found: Option<f64>, expected: f64| {
            assert!(
                (found.unwrap() - expected).abs() < 1e-9,
                "{found:?} {expected}"
            );
        };
        // 90 stations are judged, 11 of which are bad.
        near(summary.out_of_tolerance_share_percent, 100.0 * 11.0 / 90.0);
        near(summary.residual_burr_share_percent, 100.0 / 90.0);
        near(summary.chamfer_leg_max_mm, 0.6);
        near(
            summary.chamfer_leg_mean_mm,
            (80.0 * 0.3 + 10.0 * 0.6) / 90.0,
        );
        near(summary.burr_before_max_mm, 0.3);
        near(summary.residual_burr_max_mm, 0.1);
        near(summary.removed_volume_mm3, 100.0 * 0.07);
        near(summary.section_variation_percent, 0.0);
        near(summary.section_removed_mean_mm2, 0.07);
        // Ten stations are ends, one of them bad; twelve of all.
        near(summary.ends_out_of_tolerance_share_percent, 10.0);
        near(summary.whole_edge_out_of_tolerance_share_percent, 12.0);
        near(summary.ends_chamfer_leg_max_mm, 2.0);
        near(summary.ends_chamfer_leg_min_mm, 0.3);
        near(summary.ends_residual_burr_max_mm, 0.0);
        near(summary.ends_length_mm, 5.0);
    }

    #[test]
    fn an_edge_that_is_all_ends_is_checked_by_them() {
        let profile = EdgeProfile {
            place: vec![0.0, 1e-3, 2e-3, 3e-3],
            burr_before: vec![0.0; 4],
            burr_after: vec![0.0, 0.0, 0.0, 0.1e-3],
            chamfer_leg: vec![0.3e-3, 0.3e-3, 0.3e-3, 0.3e-3],
            section_removed: vec![0.0; 4],
        };
        let limits = EdgeLimits {
            leg: [0.2e-3, 0.5e-3],
            residual_burr: 0.02e-3,
            ends: 5e-3,
        };
        let mut summary = Summary::default();
        measure(&mut summary, &profile, &limits);
        assert_eq!(summary.out_of_tolerance_share_percent, None);
        assert_eq!(summary.ends_out_of_tolerance_share_percent, Some(25.0));
        assert_eq!(
            summary.whole_edge_out_of_tolerance_share_percent,
            Some(25.0)
        );
    }
}

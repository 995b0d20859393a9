//! What is said beside a number that says more than its meaning.

use super::Summary;
use crate::quantity::{change, number, with_unit};

/// Two ends, as in `from 0.412 to 0.480 mm`.
fn from_to(least: f64, most: f64, unit: &str) -> String {
    format!("from {} to {}", number(least, unit), with_unit(most, unit))
}

pub(super) fn from_desired(summary: &Summary) -> Option<String> {
    let desired = summary.desired_force_n;
    let off = 100.0 * (summary.force_mean_n? - desired) / desired;
    Some(format!(
        "desired {} ({})",
        with_unit(desired, "N"),
        change(off)
    ))
}

pub(super) fn of_desired(summary: &Summary) -> Option<String> {
    let share = with_unit(summary.force_rms_error_percent?, "%");
    Some(format!("{share} of the desired force"))
}

pub(super) fn above_desired(summary: &Summary) -> Option<String> {
    Some(match summary.engagement_overshoot_percent? {
        0.0 => "not above the desired force".to_owned(),
        over => format!("{} above desired", with_unit(over, "%")),
    })
}

pub(super) fn of_first_pass(summary: &Summary) -> Option<String> {
    (summary.passes.len() > 1).then(|| "of the first pass".to_owned())
}

pub(super) fn legs(summary: &Summary) -> Option<String> {
    let (least, most) = (summary.chamfer_leg_min_mm?, summary.chamfer_leg_max_mm?);
    Some(from_to(least, most, "mm"))
}

pub(super) fn too_much_burr(summary: &Summary) -> Option<String> {
    let share = with_unit(summary.residual_burr_share_percent?, "%");
    Some(format!("too much of it on {share}"))
}

pub(super) fn with_its_ends(summary: &Summary) -> Option<String> {
    let whole = summary.whole_edge_out_of_tolerance_share_percent?;
    Some(format!("with its ends {}", with_unit(whole, "%")))
}

pub(super) fn length_of_ends(summary: &Summary) -> Option<String> {
    let length = with_unit(summary.ends_length_mm?, "mm");
    Some(format!("{length} at either end"))
}

pub(super) fn legs_of_ends(summary: &Summary) -> Option<String> {
    let least = summary.ends_chamfer_leg_min_mm?;
    Some(from_to(least, summary.ends_chamfer_leg_max_mm?, "mm"))
}

pub(super) fn rate(summary: &Summary) -> Option<String> {
    let rate = with_unit(summary.removal_rate_mean_mm3_per_s?, "mm3/s");
    Some(format!("at {rate} while cutting"))
}

pub(super) fn strokes(summary: &Summary) -> Option<String> {
    Some(from_to(
        summary.stroke_min_mm?,
        summary.stroke_max_mm?,
        "mm",
    ))
}

pub(super) fn feed(summary: &Summary) -> Option<String> {
    let feed = with_unit(summary.feed_mean_mm_per_s?, "mm/s");
    Some(format!("at {feed} on average"))
}

pub(super) fn most_loaded(summary: &Summary) -> Option<String> {
    let joint = summary.most_loaded_joint.as_ref()?;
    Some(format!("largest, at {joint}"))
}

pub(super) fn first_saturated(summary: &Summary) -> Option<String> {
    let joints = summary.joints.iter();
    let saturated = joints.filter_map(|joint| Some((joint, joint.saturated_from_s?)));
    let (joint, from) = saturated.min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(format!("{}, {}", joint.joint, with_unit(from, "s")))
}

pub(super) fn following(summary: &Summary) -> Option<String> {
    let time = with_unit(summary.follow_duration_s?, "s");
    Some(format!("following {time} of it"))
}

pub(super) fn wall_time(summary: &Summary) -> Option<String> {
    let wall = with_unit(summary.timing?.wall_time_s, "s");
    Some(format!("computed in {wall}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    type Note = fn(&Summary) -> Option<String>;

    #[test]
    fn each_note_says_the_number_that_it_is_about() {
        let summary = Summary {
            desired_force_n: 100.0,
            force_mean_n: Some(103.0),
            force_rms_error_percent: Some(3.25),
            engagement_overshoot_percent: Some(7.5),
            chamfer_leg_min_mm: Some(0.25),
            chamfer_leg_max_mm: Some(0.5),
            residual_burr_share_percent: Some(12.5),
            whole_edge_out_of_tolerance_share_percent: Some(6.25),
            ends_length_mm: Some(4.5),
            ends_chamfer_leg_min_mm: Some(0.125),
            ends_chamfer_leg_max_mm: Some(0.75),
            removal_rate_mean_mm3_per_s: Some(2.5),
            stroke_min_mm: Some(20.5),
            stroke_max_mm: Some(31.5),
            feed_mean_mm_per_s: Some(19.5),
            most_loaded_joint: Some("elbow".to_owned()),
            follow_duration_s: Some(14.5),
            ..Summary::default()
        };
        let notes: [(Note, &[&str]); 12] = [
            (from_desired, &["desired 100", "3"]),
            (of_desired, &["3.250 % of the desired force"]),
            (above_desired, &["7.5", "% above desired"]),
            (legs, &["from 0.25", "to 0.5"]),
            (too_much_burr, &["too much of it on 12.5"]),
            (with_its_ends, &["with its ends 6.25"]),
            (length_of_ends, &["4.5", "mm at either end"]),
            (legs_of_ends, &["from 0.125", "to 0.75"]),
            (rate, &["at 2.5", "while cutting"]),
            (strokes, &["from 20.5", "to 31.5"]),
            (feed, &["at 19.5", "on average"]),
            (most_loaded, &["largest, at elbow"]),
        ];
        for (note, parts) in notes {
            let text = note(&summary).unwrap();
            assert!(parts.iter().all(|part| text.contains(part)), "{text}");
            assert_eq!(note(&Summary::default()), None);
        }
        let text = following(&summary).unwrap();
        assert!(text.starts_with("following 14.5") && text.ends_with("of it"));
        assert_eq!(of_first_pass(&summary), None);
    }
}

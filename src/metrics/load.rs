//! Use of the joints' limits, and whether the run's air adds up; over the whole run.

use super::statistics::largest;
use super::window::Window;
use super::{JointTorqueShare, MetricsError, Summary, SummaryLimits};
use crate::recording::Unit;
use crate::recording::schema::{self, JointSignal};

/// Fills in joint torques and the balance of air.
pub(super) fn measure(
    summary: &mut Summary,
    run: &Window,
    limits: &SummaryLimits,
) -> Result<(), MetricsError> {
    summary.joints = joints(run, limits)?;
    let mut worst: Option<(&str, f64)> = None;
    for joint in &summary.joints {
        if let Some(share) = joint.torque_share_percent
            && worst.is_none_or(|(_, worst)| share > worst)
        {
            worst = Some((&joint.joint, share));
        }
    }
    summary.joint_torque_share_percent = worst.map(|(_, share)| share);
    summary.most_loaded_joint = worst.map(|(joint, _)| joint.to_owned());
    summary.drives_saturated_s = saturated(run, limits)?;
    summary.air_mass_balance_relative = air_mass_balance(run)?;
    Ok(())
}

fn joints(run: &Window, limits: &SummaryLimits) -> Result<Vec<JointTorqueShare>, MetricsError> {
    let joints = limits.joint_names.iter().zip(&limits.joint_efforts);
    joints
        .enumerate()
        .map(|(index, (name, &effort))| {
            let quantity = schema::joint_quantity(index + 1, JointSignal::Torque);
            let torque = run.finite(&quantity, JointSignal::Torque.unit())?;
            let largest = torque.and_then(|torque| largest(torque.iter().copied()));
            let (time, at) = (run.time(), |torque: &f64| is_at_limit(*torque, effort));
            let first = torque.and_then(|torque| torque.iter().position(at));
            Ok(JointTorqueShare {
                saturated_s: duration(time, |index| {
                    torque.is_some_and(|torque| at(&torque[index]))
                }),
                saturated_from_s: first.map(|first| time[first]),
                joint: name.clone(),
                torque_share_percent: largest
                    .filter(|_| effort.is_finite())
                    .map(|torque| 100.0 * torque / effort),
            })
        })
        .collect()
}

/// Share of a drive's limit from which it counts as being there [1]: less than one by what rounding takes.
const AT_LIMIT: f64 = 1.0 - 1e-9;

fn is_at_limit(torque: f64, effort: f64) -> bool {
    torque.abs() >= AT_LIMIT * effort
}

/// Time of the samples of which something holds [s], each standing for the step before it.
fn duration(time: &[f64], holds: impl Fn(usize) -> bool) -> f64 {
    let steps = (1..time.len()).filter(|index| holds(*index));
    steps.fold(0.0, |sum, index| sum + (time[index] - time[index - 1]))
}

/// Time for which any drive was at its limit [s].
fn saturated(run: &Window, limits: &SummaryLimits) -> Result<Option<f64>, MetricsError> {
    let mut torques = Vec::with_capacity(limits.joint_efforts.len());
    for (index, &effort) in limits.joint_efforts.iter().enumerate() {
        let quantity = schema::joint_quantity(index + 1, JointSignal::Torque);
        let Some(torque) = run.finite(&quantity, JointSignal::Torque.unit())? else {
            return Ok(None);
        };
        torques.push((torque, effort));
    }
    let any = |index: usize| {
        let mut drives = torques.iter();
        drives.any(|(torque, effort)| is_at_limit(torque[index], *effort))
    };
    Ok(Some(duration(run.time(), any)))
}

/// Largest |(entered - left) - (mass - mass at the start)| over the mass in the chambers; all
/// counted from the first sample, at which some air may already have moved.
pub(super) fn air_mass_balance(run: &Window) -> Result<Option<f64>, MetricsError> {
    let channel = |quantity| run.finite(quantity, Unit::Kilogram);
    let (Some(first), Some(second), Some(entered), Some(left)) = (
        channel(schema::CHAMBER_1_MASS)?,
        channel(schema::CHAMBER_2_MASS)?,
        channel(schema::MASS_ENTERED)?,
        channel(schema::MASS_LEFT)?,
    ) else {
        return Ok(None);
    };
    let line = channel(schema::HOSE_MASS)?;
    let held = |index: usize| first[index] + second[index] + line.map_or(0.0, |line| line[index]);
    let gap = |index: usize| {
        let moved = (entered[index] - entered[0]) - (left[index] - left[0]);
        (moved - (held(index) - held(0))) / held(index)
    };
    let largest = largest((0..first.len()).map(gap));
    Ok(largest.filter(|gap| gap.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::super::summarise;
    use super::super::test_recordings::{Builder, assert_near, limits};

    #[test]
    fn the_joint_nearest_to_its_limit_is_named() {
        // Efforts are 200 and 20 N m: the small torque is the greater share. Signs do not matter,
        // and the whole run counts: the peak lies before following starts.
        let mut builder = Builder::nominal();
        builder.torques = [
            vec![50.0; builder.force.len()],
            vec![-3.0; builder.force.len()],
        ];
        builder.torques[1][3] = -15.0;
        let summary = summarise(&builder.build(), &limits()).unwrap();
        assert_eq!(summary.joints[0].joint, "base");
        assert_near(summary.joints[0].torque_share_percent, 25.0, 1e-12);
        assert_near(summary.joints[1].torque_share_percent, 75.0, 1e-12);
        assert_near(summary.joint_torque_share_percent, 75.0, 1e-12);
        assert_eq!(summary.most_loaded_joint.as_deref(), Some("wrist"));

        let mut unlimited = limits();
        unlimited.joint_efforts[1] = f64::INFINITY;
        let summary = summarise(&builder.build(), &unlimited).unwrap();
        assert_eq!(summary.joints[1].torque_share_percent, None);
        assert_eq!(summary.most_loaded_joint.as_deref(), Some("base"));
    }

    #[test]
    fn a_drive_at_its_limit_is_reported_with_its_time() {
        let mut builder = Builder::nominal();
        let summary = summarise(&builder.build(), &limits()).unwrap();
        assert_eq!(summary.drives_saturated_s, Some(0.0));
        assert_eq!(summary.joints[1].saturated_from_s, None);
        // The wrist's 20 N m for three samples, the base's 200 N m for one of them.
        builder.torques[1][100..103].fill(-20.0);
        builder.torques[0][102] = 200.0;
        let summary = summarise(&builder.build(), &limits()).unwrap();
        assert_near(summary.drives_saturated_s, 3.0 * Builder::STEP, 1e-9);
        let [base, wrist] = [&summary.joints[0], &summary.joints[1]];
        assert_near(Some(base.saturated_s), Builder::STEP, 1e-9);
        assert_near(Some(wrist.saturated_s), 3.0 * Builder::STEP, 1e-9);
        assert_near(base.saturated_from_s, 102.0 * Builder::STEP, 1e-12);
        assert_near(wrist.saturated_from_s, 100.0 * Builder::STEP, 1e-12);
    }

    #[test]
    fn air_that_adds_up_balances_and_a_leak_is_seen() {
        let mut builder = Builder::nominal();
        let summary = summarise(&builder.build(), &limits()).unwrap();
        let sound = summary.air_mass_balance_relative.unwrap();
        assert!(sound < 1e-14, "{sound}");

        // One part in a million of the air in chamber 1 vanishes at some sample and stays away.
        let from = builder.force.len() / 2;
        let held = builder.air[0][from] + builder.air[1][from];
        let lost = 1e-6 * builder.air[0][from];
        for mass in &mut builder.air[0][from..] {
            *mass -= lost;
        }
        let summary = summarise(&builder.build(), &limits()).unwrap();
        assert_near(summary.air_mass_balance_relative, lost / held, 1e-3);
    }
}

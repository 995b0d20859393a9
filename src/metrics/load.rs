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
            Ok(JointTorqueShare {
                joint: name.clone(),
                torque_share_percent: largest
                    .filter(|_| effort.is_finite())
                    .map(|torque| 100.0 * torque / effort),
            })
        })
        .collect()
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

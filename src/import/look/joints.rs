//! Joints of an arm in a bag: what their encoders read, their speeds and their drives' torques, under the names that recordings of cells have; by the joints' own
//! names where nothing tells their order and the log is of an arm alone, so that its URDF can.

use std::collections::BTreeSet;

use super::assign::Pick;
use super::names::{self, Thing};
use super::seen::{Because, Seen};
use crate::import::map::Column;
use crate::recording::Unit;
use crate::recording::schema::{self, JointSignal};

/// Joints of the arms of Universal Robots, base first; their messages have them in another order.
const NAMED: [&str; 6] = [
    "shoulder_pan",
    "shoulder_lift",
    "elbow",
    "wrist_1",
    "wrist_2",
    "wrist_3",
];

/// Words of what is no joint of the arm itself.
pub(super) const JOINTLESS: [&str; 3] = ["finger", "gripper", "knuckle"];

/// Joints of the first topic that names any, base first; what stands at the places taken is left out. `of_cell` counts them in any case.
pub(super) fn joints(columns: &[Seen], taken: &[usize], of_cell: bool) -> Vec<Pick> {
    let free = |place: &usize| !taken.contains(place);
    let of_arm: Vec<usize> = (0..columns.len())
        .filter(free)
        .filter(|place| signal(&columns[*place]).is_some() && is_of_arm(&columns[*place]))
        .collect();
    let Some(topic) = of_arm.first().and_then(|place| topic(&columns[*place])) else {
        return Vec::new();
    };
    let own = of_arm
        .into_iter()
        .filter(|place| self::topic(&columns[*place]) == Some(topic));
    let own: Vec<usize> = own.collect();
    let mut joints: Vec<&str> = Vec::new();
    for joint in own
        .iter()
        .filter_map(|place| columns[*place].joint.as_deref())
    {
        if !joints.contains(&joint) {
            joints.push(joint);
        }
    }
    let (numbers, why) = numbered(&joints);
    let mut picks: Vec<(usize, Pick)> = Vec::new();
    for place in own {
        let column = &columns[place];
        let index = joints
            .iter()
            .position(|joint| column.joint.as_deref() == Some(joint));
        let (Some(index), Some(signal)) = (index, signal(column)) else {
            continue;
        };
        let number = (of_cell || why.is_certain).then(|| numbers[index]);
        let (quantity, because) = quantity_of_joint(number, joints[index], signal.name(), &why);
        if picks.iter().all(|(_, pick)| pick.quantity != quantity) {
            let pick = Pick::new(quantity, place, because, signal.unit());
            picks.push((numbers[index], pick));
        }
    }
    picks.sort_by_key(|(number, pick)| (*number, pick.place));
    picks.into_iter().map(|(_, pick)| pick).collect()
}

/// Quantity of a joint, by its number or by its own name, and how sure that is.
pub(super) fn quantity_of_joint(
    number: Option<usize>,
    joint: &str,
    signal: &str,
    why: &Because,
) -> (String, Because) {
    match number {
        Some(number) => (format!("joint_{number}_{signal}"), why.clone()),
        None => {
            let why = "by the joint's own name, which the arm's URDF must have";
            let joint = schema::plain_joint(joint);
            (format!("{joint}_{signal}"), Because::likely(why))
        }
    }
}

/// Signal of a joint that a column may be, by its unit.
fn signal(column: &Seen) -> Option<JointSignal> {
    column.joint.as_ref()?;
    let unit = column.unit.as_ref()?.unit.si;
    match unit {
        Unit::Radian => Some(JointSignal::Encoder),
        Unit::RadianPerSecond => Some(JointSignal::Velocity),
        Unit::NewtonMetre => Some(JointSignal::Torque),
        _ => None,
    }
}

/// Whether its joint turns and is no gripper's.
fn is_of_arm(column: &Seen) -> bool {
    let joint = column.joint.as_deref().unwrap_or_default();
    let lower = joint.to_lowercase();
    let slides = names::said(joint)
        .thing
        .is_some_and(|(thing, _)| thing == Thing::Stroke);
    !slides && !JOINTLESS.iter().any(|word| lower.contains(word))
}

/// Topic of a column: what stands before its field.
fn topic(column: &Seen) -> Option<&str> {
    match &column.column {
        Column::Name(name) => name.split_once('.').map(|(topic, _)| topic),
        Column::Number(_) => None,
    }
}

/// Numbers of joints from the base, from 1, and how sure that is.
pub(super) fn numbered(joints: &[&str]) -> (Vec<usize>, Because) {
    let digits = |joint: &&str| {
        let end = joint.trim_end_matches(|c: char| !c.is_ascii_digit());
        let start = end.trim_end_matches(|c: char| c.is_ascii_digit()).len();
        end[start..].parse::<usize>().ok()
    };
    let known = |joint: &&str| {
        let place = NAMED.iter().position(|name| joint.contains(name));
        place.map(|place| place + 1)
    };
    let all: Option<Vec<usize>> = joints.iter().map(known).collect();
    if let Some(numbers) = all.filter(|numbers| are_distinct(numbers)) {
        let why = "joints are counted from the base, and the names are those of Universal Robots";
        return (numbers, Because::certain(why));
    }
    let all: Option<Vec<usize>> = joints.iter().map(digits).collect();
    if let Some(numbers) = all.filter(|numbers| are_distinct(numbers)) {
        // Some count from 0.
        let least = numbers.iter().min().copied().unwrap_or(1);
        let shifted = numbers
            .iter()
            .map(|n| n + usize::from(least == 0))
            .collect();
        let why = "joints are counted from the base, and the name has the number";
        return (shifted, Because::certain(why));
    }
    let why = "in the order of the messages; joints are counted from the base, from 1";
    ((1..=joints.len()).collect(), Because::likely(why))
}

fn are_distinct(numbers: &[usize]) -> bool {
    numbers.iter().collect::<BTreeSet<_>>().len() == numbers.len()
}

#[cfg(test)]
mod tests {
    use super::numbered;

    #[test]
    fn joints_are_counted_from_the_base() {
        for (names, numbers, is_certain) in [
            (vec!["joint_2", "joint_1", "joint_3"], vec![2, 1, 3], true),
            (vec!["arm_joint_0", "arm_joint_1"], vec![1, 2], true),
            (vec!["panda_joint1", "panda_joint2"], vec![1, 2], true),
            (
                vec![
                    "elbow_joint",
                    "shoulder_lift_joint",
                    "shoulder_pan_joint",
                    "wrist_1_joint",
                ],
                vec![3, 2, 1, 4],
                true,
            ),
            (vec!["hip", "knee"], vec![1, 2], false),
            (vec!["left_1", "right_1"], vec![1, 2], false),
        ] {
            let (found, why) = numbered(&names);
            assert_eq!((found, why.is_certain), (numbers, is_certain), "{names:?}");
        }
    }
}

//! Joints of an arm in columns that call them by name, as a URDF does: `shoulder_pan.pos`, `hip current [mA]`, `/joint_states/elbow/effort`.

use std::collections::BTreeMap;

use super::assign::Pick;
use super::joints::{JOINTLESS, numbered, quantity_of_joint};
use super::numbered::{NAMES, SIGNALS, Signal, quantity, si, unit};
use super::seen::Seen;
use crate::recording::Unit;

/// Joints from which columns are those of an arm.
const LEAST: usize = 3;
/// What makers put before the names of joints.
const BEFORE: [&str; 6] = [
    "observation_state",
    "observation_velocity",
    "observation_effort",
    "observation_current",
    "action",
    "joint_states",
];

/// A column of a joint.
struct Named {
    place: usize,
    joint: String,
    name: usize,
}

/// Joints in columns that have their names; none where there are less than three, or nothing says that they are joints.
pub(super) fn named_joints(columns: &[Seen], taken: &[usize]) -> Vec<Pick> {
    let all: Vec<Named> = (0..columns.len())
        .filter(|place| !taken.contains(place))
        .filter(|place| columns[*place].joint.is_none() && !columns[*place].numbers().is_empty())
        .filter_map(|place| {
            let (joint, name) = parts(&columns[place])?;
            let other = columns[place].unit.as_ref().map(|said| said.unit.si);
            // A position in mm is no angle.
            let fits = other.is_none_or(|unit| unit == si(NAMES[name].1));
            fits.then_some(Named { place, joint, name })
        })
        .collect();
    // Of a signal the name that most joints have; of equals the first.
    let of_signal = |signal: Signal| -> Vec<&Named> {
        let mut by_name: BTreeMap<usize, Vec<&Named>> = BTreeMap::new();
        for column in all.iter().filter(|c| NAMES[c.name].1 == signal) {
            by_name.entry(column.name).or_default().push(column);
        }
        let most = by_name
            .into_values()
            .max_by_key(|own| (own.len(), usize::MAX - own[0].name));
        most.unwrap_or_default()
    };
    let positions = of_signal(Signal::Position);
    let joints: Vec<&str> = positions.iter().map(|c| c.joint.as_str()).collect();
    if joints.len() < LEAST || has_twice(&joints) || !are_joints(columns, &positions, &all) {
        return Vec::new();
    }
    let places = |own: &[&Named]| own.iter().map(|c| c.place).collect::<Vec<_>>();
    let angle = unit(columns, positions[0].name, &places(&positions), None);
    let Some(angle) = angle.filter(|angle| angle.unit.si == Unit::Radian) else {
        return Vec::new();
    };
    let (numbers, why) = numbered(&joints);
    let mut picks: Vec<(usize, usize, Pick)> = Vec::new();
    for (order, signal) in SIGNALS.into_iter().enumerate() {
        let own: Vec<&Named> = (of_signal(signal).into_iter())
            .filter(|column| joints.contains(&column.joint.as_str()))
            .collect();
        let Some(first) = own.first() else { continue };
        let Some(unit) = unit(columns, first.name, &places(&own), Some(&angle)) else {
            continue;
        };
        for column in own {
            let place = joints.iter().position(|joint| *joint == column.joint);
            let place = place.unwrap_or_default();
            let number = why.is_certain.then(|| numbers[place]);
            let (quantity, because) =
                quantity_of_joint(number, &column.joint, quantity(signal), &why);
            if picks.iter().all(|(.., pick)| pick.quantity != quantity) {
                let mut pick = Pick::new(quantity, column.place, because, si(signal));
                pick.unit = Some(unit.clone());
                picks.push((order, number.unwrap_or(place), pick));
            }
        }
    }
    picks.sort_by_key(|(order, number, _)| (*order, *number));
    picks.into_iter().map(|(.., pick)| pick).collect()
}

fn has_twice(joints: &[&str]) -> bool {
    let place = |joint: &str| joints.iter().position(|own| *own == joint);
    (0..joints.len()).any(|index| place(joints[index]) != Some(index))
}

/// Whether positions are angles of joints: in a unit of angles, by what their maker puts before, or as the same names have speeds, currents or torques.
fn are_joints(columns: &[Seen], positions: &[&Named], all: &[Named]) -> bool {
    let in_angles = |column: &&Named| {
        let unit = columns[column.place].unit.as_ref();
        unit.is_some_and(|said| said.unit.si == Unit::Radian)
    };
    let of_maker = |column: &&Named| {
        let name = words(&columns[column.place].name).join("_");
        BEFORE.iter().any(|before| name.starts_with(before))
    };
    let has_more = |column: &&Named| {
        let is_drives = |signal| matches!(signal, Signal::Speed | Signal::Current | Signal::Torque);
        let mut others = all.iter().filter(|other| other.joint == column.joint);
        others.any(|other| is_drives(NAMES[other.name].1))
    };
    positions.iter().all(in_angles)
        || positions.iter().all(of_maker)
        || positions.iter().all(has_more)
}

/// Words of a name in small letters, without what stands in brackets.
fn words(name: &str) -> Vec<String> {
    let mut depth = 0;
    let plain = name.chars().map(|c| {
        depth += i32::from("[(".contains(c)) - i32::from("])".contains(c));
        if depth > 0 || !c.is_alphanumeric() {
            ' '
        } else {
            c
        }
    });
    let plain: String = plain.collect();
    let words = plain.split_whitespace().map(str::to_lowercase);
    words.collect()
}

/// The joint that a column is of, and the row of its signal; none of what is no joint that turns.
fn parts(column: &Seen) -> Option<(String, usize)> {
    let words = words(&column.name);
    let before = BEFORE.iter().find_map(|before| {
        let count = before.split('_').count();
        let fits = words.len() > count && words[..count].join("_") == *before;
        fits.then_some((*before, count))
    });
    let (maker, rest) = match before {
        Some((before, count)) => (Some(before), &words[count..]),
        None => (None, &words[..]),
    };
    let row = |name: &str| NAMES.iter().position(|(own, ..)| *own == name);
    // The longest signal at the end of the name, else that of the maker before it.
    let at_end = (1..rest.len()).find_map(|start| Some((start, row(&rest[start..].join("_"))?)));
    let at_start = || {
        let ends = (1..rest.len()).rev();
        let mut found = ends.filter_map(|end| Some((end, row(&rest[..end].join("_"))?)));
        found.next()
    };
    let of_maker = maker.and_then(row);
    let (joint, name) = match (at_end, of_maker) {
        // `action.elbow.pos` is a command.
        (Some((start, _)), Some(name)) => (&rest[..start], name),
        (None, Some(name)) => (rest, name),
        (Some((start, name)), None) => (&rest[..start], name),
        (None, None) => at_start().map(|(end, name)| (&rest[end..], name))?,
    };
    let joint = joint.join("_");
    // A number alone is another's business.
    let is_name = joint.chars().any(char::is_alphabetic)
        && !JOINTLESS.iter().any(|word| joint.contains(word));
    is_name.then_some((joint, name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::look::seen::Cells;
    use crate::import::map::Column;

    fn found(names: &[&str], values: &[f64]) -> Vec<String> {
        let seen = |name: &&str| Seen {
            column: Column::Name((*name).to_owned()),
            name: (*name).to_owned(),
            joint: None,
            frames: Vec::new(),
            unit: super::super::units::of_name(name),
            cells: Cells::Numbers(values.to_vec()),
        };
        let columns: Vec<Seen> = names.iter().map(seen).collect();
        let shown = |pick: &Pick| {
            let unit = pick.unit.as_ref().unwrap().unit.name;
            format!("{} {} {unit}", columns[pick.place].name, pick.quantity)
        };
        named_joints(&columns, &[]).iter().map(shown).collect()
    }

    #[test]
    fn joints_by_name_are_found_with_their_signals() {
        let robot = found(
            &[
                "observation.state.shoulder_pan.pos",
                "observation.state.elbow_flex.pos",
                "observation.state.wrist_flex.pos",
                "observation.state.gripper.pos",
                "action.shoulder_pan.pos",
                "action.elbow_flex.pos",
                "action.wrist_flex.pos",
            ],
            &[-20.0, 80.0],
        );
        assert_eq!(robot.len(), 6, "{robot:?}");
        assert_eq!(
            robot[1],
            "observation.state.elbow_flex.pos elbow_flex_encoder deg"
        );
        assert_eq!(
            robot[3],
            "action.shoulder_pan.pos shoulder_pan_reference deg"
        );
        let plain = found(
            &[
                "bend position [deg]",
                "hip position [deg]",
                "roll position [deg]",
                "hip current [mA]",
                "roll current [mA]",
                "bend current [mA]",
            ],
            &[1.0, 2.0],
        );
        assert_eq!(plain[0], "bend position [deg] bend_encoder deg");
        assert_eq!(plain[4], "hip current [mA] hip_current mA");
        // Names that say the place from the base.
        let numbered = found(
            &[
                "/joint_states/arm_joint_2/position",
                "/joint_states/arm_joint_1/position",
                "/joint_states/arm_joint_3/position",
            ],
            &[1.0, 2.0],
        );
        assert_eq!(
            numbered[0],
            "/joint_states/arm_joint_1/position joint_1_encoder rad"
        );
    }

    #[test]
    fn positions_of_a_device_are_no_joints() {
        for names in [
            &["piston position", "table position", "probe position"][..],
            &["left pos [mm]", "right pos [mm]", "mid pos [mm]"],
            &["inlet pressure", "outlet pressure", "tank pressure"],
        ] {
            assert!(found(names, &[0.1, 1.0]).is_empty(), "{names:?}");
        }
    }
}

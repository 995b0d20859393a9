//! Joints of an arm in the logs of its controller: a column for each joint and signal, by what the makers' exports call them.
//!
//! Sources: Universal Robots, "Real-Time Data Exchange (RTDE) Guide", fields `actual_q`, `actual_qd`, `actual_current`, `target_q`; KUKA.RobotSensorInterface
//! 4.1, `AIPos`, `ASPos`, `MACur`, and the variables `$AXIS_ACT`, `$TORQUE_AXIS_ACT`; Franka Control Interface, `RobotState` (`q`, `dq`, `tau_J`, `q_d`); LeRobot
//! dataset format 2 and 3, `observation.state`, `action`.

use std::collections::BTreeSet;

use super::assign::Pick;
use super::seen::{Because, SaidUnit, Seen};
use crate::import::units;
use crate::recording::Unit;

/// Joints from which columns are those of an arm.
const LEAST: usize = 3;
/// Largest angle that is taken for radians: a turn and a little.
const RADIANS: f64 = 6.6;
/// Largest current that is taken for amperes.
const AMPERES: f64 = 200.0;

/// What such columns hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Signal {
    Position,
    Command,
    Speed,
    Current,
    Torque,
}

use Signal::{Command, Current, Position, Speed, Torque};

/// Signals in the order of a map.
pub(super) const SIGNALS: [Signal; 5] = [Position, Command, Speed, Current, Torque];

/// Names without the joint, their words in small letters, those of makers before those of everybody; the unit where the maker says it.
#[rustfmt::skip] // A table: a name a line.
pub(super) const NAMES: [(&str, Signal, Option<&str>); 59] = [
    ("actual_q", Position, Some("rad")), ("actual_qd", Speed, Some("rad/s")), ("actual_current", Current, Some("A")), ("target_q", Command, Some("rad")),
    ("q_actual", Position, Some("rad")), ("qd_actual", Speed, Some("rad/s")), ("i_actual", Current, Some("A")), ("q_target", Command, Some("rad")),
    ("aipos", Position, Some("deg")), ("aspos", Command, Some("deg")), ("macur", Current, None), ("axis_act", Position, Some("deg")),
    ("torque_axis_act", Torque, Some("Nm")),
    ("q", Position, None), ("dq", Speed, None), ("tau", Torque, Some("Nm")), ("q_d", Command, None), ("qd", Speed, None),
    ("observation_state", Position, None), ("action", Command, None), ("observation_velocity", Speed, None), ("observation_effort", Torque, None),
    ("observation_torque", Torque, None), ("observation_current", Current, None),
    ("position", Position, None), ("positions", Position, None), ("pos", Position, None), ("angle", Position, None), ("actual_position", Position, None),
    ("position_actual", Position, None), ("winkel", Position, None), ("measured_position", Position, None), ("encoder", Position, None),
    ("velocity", Speed, None), ("velocities", Speed, None), ("vel", Speed, None), ("speed", Speed, None), ("actual_velocity", Speed, None),
    ("measured_velocity", Speed, None),
    ("current", Current, None), ("currents", Current, None), ("motor_current", Current, None), ("strom", Current, None),
    ("motorstrom", Current, None),
    ("torque", Torque, None), ("torques", Torque, None), ("motor_torque", Torque, None), ("actual_torque", Torque, None), ("measured_torque", Torque, None),
    ("effort", Torque, None), ("drehmoment", Torque, None),
    ("command", Command, None), ("commanded_position", Command, None), ("position_command", Command, None), ("target_position", Command, None),
    ("desired_position", Command, None), ("reference", Command, None), ("reference_position", Command, None), ("cmd", Command, None),
];
/// Words that stand beside a joint's number and say no more.
const JOINT: [&str; 6] = ["joint", "axis", "achse", "j", "a", "jt"];
/// Words before a name that say where its program keeps it.
const OWNERS: [&str; 4] = ["state", "robot_state", "joint_states", "joint_state"];

/// A column of a joint.
struct Numbered {
    place: usize,
    number: usize,
    name: usize,
}

/// Joints in columns of their own, base first; none where there are less than three.
pub(super) fn numbered_joints(columns: &[Seen], taken: &[usize]) -> Vec<Pick> {
    let free = (0..columns.len()).filter(|place| !taken.contains(place));
    let of_joints: Vec<Numbered> = free
        .filter(|place| columns[*place].joint.is_none() && !columns[*place].numbers().is_empty())
        .filter_map(|place| {
            let (words, number) = parts(&columns[place].name)?;
            let name = words.iter().find_map(|words| named(words))?;
            Some(Numbered {
                place,
                number,
                name,
            })
        })
        .collect();
    let of = |name: usize| of_joints.iter().filter(move |column| column.name == name);
    let numbers = |name: usize| of(name).map(|c| c.number).collect::<BTreeSet<usize>>();
    // Of a signal the first name that is there of as many joints as the positions.
    let first = |signal: Signal, asked: Option<&BTreeSet<usize>>| {
        let names = (0..NAMES.len()).filter(|name| NAMES[*name].1 == signal);
        let mut fitting = names.filter(|name| {
            let own = numbers(*name);
            own.len() == of(*name).count() && asked.map_or(is_arm(&own), |asked| *asked == own)
        });
        fitting.next()
    };
    let Some(position) = first(Position, None) else {
        return Vec::new();
    };
    let joints = numbers(position);
    let from = usize::from(joints.first() == Some(&0));
    let places = |name: usize| of(name).map(|c| c.place).collect::<Vec<usize>>();
    let angle = unit(columns, position, &places(position), None);
    let Some(angle) = angle.filter(|angle| angle.unit.si == Unit::Radian) else {
        return Vec::new();
    };
    let mut picks: Vec<(usize, usize, Pick)> = Vec::new();
    for (order, signal) in SIGNALS.into_iter().enumerate() {
        let Some(name) = first(signal, Some(&joints)) else {
            continue;
        };
        let Some(unit) = unit(columns, name, &places(name), Some(&angle)) else {
            continue;
        };
        for column in of(name) {
            let number = column.number + from;
            let why = format!("`{}` with the number of a joint", NAMES[name].0);
            let quantity = format!("joint_{number}_{}", quantity(signal));
            let mut pick = Pick::new(quantity, column.place, Because::certain(why), si(signal));
            pick.unit = Some(unit.clone());
            picks.push((number, order, pick));
        }
    }
    picks.sort_by_key(|(number, order, _)| (*order, *number));
    picks.into_iter().map(|(.., pick)| pick).collect()
}

/// Whether numbers are those of an arm's joints, from 0 or 1.
fn is_arm(numbers: &BTreeSet<usize>) -> bool {
    let (Some(first), Some(last)) = (numbers.first(), numbers.last()) else {
        return false;
    };
    numbers.len() >= LEAST && *first <= 1 && last - first + 1 == numbers.len()
}

/// Row of a name; of one that stands behind where its program keeps it, too.
fn named(words: &str) -> Option<usize> {
    let of = |words: &str| NAMES.iter().position(|(name, ..)| *name == words);
    let owned = || {
        let mut owners = OWNERS.iter();
        owners.find_map(|owner| of(words.strip_prefix(owner)?.strip_prefix('_')?))
    };
    of(words).or_else(owned)
}

/// Word of a signal in the quantity of a map.
pub(super) fn quantity(signal: Signal) -> &'static str {
    match signal {
        Position => "encoder",
        Command => "reference",
        Speed => "velocity",
        Current => "current",
        Torque => "torque",
    }
}

/// Unit of a signal.
pub(super) fn si(signal: Signal) -> Unit {
    match signal {
        Position | Command => Unit::Radian,
        Speed => Unit::RadianPerSecond,
        Current => Unit::Ampere,
        Torque => Unit::NewtonMetre,
    }
}

/// Words of a name without units and the joint's number, all of them and without those that stand beside a joint's number; and the number.
fn parts(name: &str) -> Option<([String; 2], usize)> {
    // A unit in brackets is not the name; a number in brackets is the joint's.
    let mut plain = String::new();
    let mut rest = name;
    while let Some(open) = rest.find(['[', '(']) {
        let close = rest[open..].find([']', ')']).map(|end| open + end);
        let Some(close) = close else { break };
        plain.push_str(&rest[..open]);
        let inside = &rest[open + 1..close];
        if inside.chars().all(|c| c.is_ascii_digit()) {
            plain.push('_');
            plain.push_str(inside);
        }
        rest = &rest[close + 1..];
    }
    plain.push_str(rest);
    let mut words: Vec<String> = Vec::new();
    let mut number = None;
    let mut before = ' ';
    for c in plain.chars() {
        let joins = c.is_alphabetic() && before.is_alphabetic()
            || c.is_ascii_digit() && before.is_ascii_digit();
        match words.last_mut() {
            Some(last) if joins => last.extend(c.to_lowercase()),
            _ if c.is_alphanumeric() => words.push(c.to_lowercase().collect()),
            _ => {}
        }
        before = c;
    }
    words.retain(|word| match word.parse::<usize>() {
        Ok(found) => {
            number = Some(found);
            false
        }
        Err(_) => true,
    });
    let unit = words
        .last()
        .is_some_and(|word| ["rad", "deg", "nm", "ma"].contains(&word.as_str()));
    if unit && words.len() > 1 {
        words.pop();
    }
    let without: Vec<&str> = words
        .iter()
        .map(String::as_str)
        .filter(|w| !JOINT.contains(w))
        .collect();
    // `J1 [deg]` is a joint's angle; `A1` may be an input of a data logger.
    let is_joint = words.iter().any(|word| word != "a");
    let joined = if without.is_empty() && is_joint {
        "position".to_owned()
    } else {
        without.join("_")
    };
    // `AXIS_ACT.A1`: the letter is the number's.
    if words.len() > 1 && words.last().is_some_and(|word| word == "a") {
        words.pop();
    }
    Some(([words.join("_"), joined], number?))
}

/// Unit of the columns of one name: as the log says it, as the maker does, or by the size of all of them together.
pub(super) fn unit(
    columns: &[Seen],
    name: usize,
    own: &[usize],
    angle: Option<&SaidUnit>,
) -> Option<SaidUnit> {
    let (_, signal, of_maker) = NAMES[name];
    let said = own.iter().find_map(|place| columns[*place].unit.clone());
    if let Some(said) = said.filter(|said| said.unit.si == si(signal)) {
        return Some(said);
    }
    let unit = |name: &str, because: Because| {
        Some(SaidUnit {
            unit: units::named(name)?,
            pressure: None,
            because,
        })
    };
    if let Some(name) = of_maker {
        return unit(
            name,
            Because::certain("that is what the robot's maker writes"),
        );
    }
    let ranges = own.iter().filter_map(|place| columns[*place].range());
    let peak = ranges
        .flatten()
        .fold(0.0, |peak: f64, value| peak.max(value.abs()));
    let by_size = |what: &str| {
        Because::likely(format!(
            "nothing says it; the largest of all joints is {peak:.3}, {what}"
        ))
    };
    let is_degrees = angle.is_some_and(|angle| angle.unit.name == "deg");
    match signal {
        Position | Command if peak > RADIANS => unit("deg", by_size("more than a turn in rad")),
        Position | Command => unit("rad", by_size("usual in rad")),
        Speed if is_degrees => unit("deg/s", Because::likely("angles are in degrees")),
        Speed => unit("rad/s", Because::likely("angles are in rad")),
        Current if peak > AMPERES => unit("mA", by_size("usual in mA")),
        Current => unit("A", by_size("usual in A")),
        Torque => unit(
            "Nm",
            Because::likely("nothing says it; torques are usual in it"),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::look::seen::Cells;
    use crate::import::map::Column;

    fn columns(names: &[&str], values: &[f64]) -> Vec<Seen> {
        let seen = |name: &&str| Seen {
            column: Column::Name((*name).to_owned()),
            name: (*name).to_owned(),
            joint: None,
            frames: Vec::new(),
            unit: super::super::units::of_name(name),
            cells: Cells::Numbers(values.to_vec()),
        };
        names.iter().map(seen).collect()
    }

    fn found(names: &[&str], values: &[f64]) -> Vec<String> {
        let columns = columns(names, values);
        let picks = numbered_joints(&columns, &[]);
        let shown = |pick: &Pick| {
            let unit = pick.unit.as_ref().unwrap();
            format!(
                "{} {} {}",
                columns[pick.place].name, pick.quantity, unit.unit.name
            )
        };
        picks.iter().map(shown).collect()
    }

    #[test]
    fn every_makers_joints_are_found_by_number_with_their_units() {
        let rtde = found(
            &[
                "timestamp",
                "actual_q_0",
                "actual_q_1",
                "actual_q_2",
                "actual_current_0",
                "actual_current_1",
                "actual_current_2",
                "target_moment_0",
            ],
            &[0.1, 1.0],
        );
        assert_eq!(rtde.len(), 6);
        assert_eq!(rtde[1], "actual_q_1 joint_2_encoder rad");
        assert_eq!(rtde[5], "actual_current_2 joint_3_current A");
        let kuka = found(
            &[
                "AIPos.A1", "AIPos.A2", "AIPos.A3", "MACur.A1", "MACur.A2", "MACur.A3",
            ],
            &[0.5, 2.0],
        );
        assert_eq!(kuka[0], "AIPos.A1 joint_1_encoder deg");
        assert_eq!(kuka[3], "MACur.A1 joint_1_current A");
        let franka = found(
            &[
                "q[0]", "q[1]", "q[2]", "dq[0]", "dq[1]", "dq[2]", "tau_J[0]", "tau_J[1]",
                "tau_J[2]", "q_d[0]", "q_d[1]", "q_d[2]",
            ],
            &[0.5, 2.0],
        );
        assert_eq!(franka.len(), 12);
        assert_eq!(franka[3], "q_d[0] joint_1_reference rad");
        assert_eq!(franka[9], "tau_J[0] joint_1_torque N m");
        let any = found(
            &[
                "J1 [deg]",
                "J2 [deg]",
                "J3 [deg]",
                "joint 1 current (mA)",
                "joint 2 current (mA)",
                "joint 3 current (mA)",
            ],
            &[0.5, 2.0],
        );
        assert_eq!(any[0], "J1 [deg] joint_1_encoder deg");
        assert_eq!(any[3], "joint 1 current (mA) joint_1_current mA");
    }

    #[test]
    fn a_joint_that_hardly_moves_has_the_unit_of_the_others() {
        let mut columns = columns(
            &[
                "observation.state[0]",
                "observation.state[1]",
                "observation.state[2]",
            ],
            &[1.0, 2.0],
        );
        columns[2].cells = Cells::Numbers(vec![-90.0, 45.0]);
        let picks = numbered_joints(&columns, &[]);
        assert!(
            picks
                .iter()
                .all(|pick| pick.unit.as_ref().unwrap().unit.name == "deg")
        );
    }

    #[test]
    fn columns_of_a_device_are_no_joints() {
        for names in [
            &["pressure_1", "pressure_2", "pressure_3"][..],
            &["position_1", "position_2"],
            &["p1", "p2", "p3", "force"],
            &["AI0", "AI1", "AI2"],
        ] {
            assert!(found(names, &[0.1, 1.0]).is_empty(), "{names:?}");
        }
    }
}

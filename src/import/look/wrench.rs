//! The six readings of a force-torque sensor at an arm's wrist, by what the makers' exports call them.
//!
//! Sources: Universal Robots, "Real-Time Data Exchange (RTDE) Guide", `ft_raw_wrench`, `actual_TCP_force`; Franka Control Interface, `RobotState`, `K_F_ext_hat_K`,
//! `O_F_ext_hat_K`; ROS, geometry_msgs/WrenchStamped.

use std::collections::BTreeMap;

use super::assign::Pick;
use super::seen::{Because, SaidUnit, Seen};
use crate::import::units;
use crate::recording::Unit;

/// Names with the number of the axis behind, forces before torques, the better ones first; in words what else than a sensor's reading they hold.
#[rustfmt::skip] // A table: a name a line.
const NAMES: [(&str, Option<&str>); 9] = [
    ("ft_raw_wrench", None),
    ("wrench", None), ("ft_sensor", None), ("force_torque", None), ("observation_wrench", None),
    ("k_f_ext_hat_k", Some("estimated from joint torques, without the declared load")),
    ("actual_tcp_force", Some("in the base's axes, and without the declared payload's weight")),
    ("tcp_force", Some("in the base's axes, and without the declared payload's weight")),
    ("o_f_ext_hat_k", Some("in the base's axes, estimated from joint torques")),
];
/// Words of forces and torques behind which an axis stands.
const FORCES: [&str; 2] = ["force", "f"];
const MOMENTS: [&str; 4] = ["torque", "moment", "t", "m"];
const AXES: [&str; 3] = ["x", "y", "z"];
/// Words of what is commanded.
const SET: [&str; 6] = [
    "target",
    "command",
    "commanded",
    "cmd",
    "desired",
    "setpoint",
];
/// The readings in a map, forces first.
const QUANTITIES: [&str; 6] = [
    "wrench_force_x",
    "wrench_force_y",
    "wrench_force_z",
    "wrench_torque_x",
    "wrench_torque_y",
    "wrench_torque_z",
];

/// The six readings of the first sensor of which all are there.
pub(super) fn wrench(columns: &[Seen], taken: &[usize]) -> Vec<Pick> {
    let mut sensors: BTreeMap<(usize, String), [Option<usize>; 6]> = BTreeMap::new();
    for (place, column) in columns.iter().enumerate() {
        let is_free = !taken.contains(&place) && column.joint.is_none();
        if !is_free || !column.numbers().iter().any(|value| value.is_finite()) {
            continue;
        }
        if let Some((sensor, axis)) = axis(&column.name) {
            let is = |name: &str| name == sensor || name.strip_suffix("_force") == Some(&sensor);
            let row = NAMES.iter().position(|(name, _)| is(name));
            let readings = sensors.entry((row.unwrap_or(0), sensor)).or_default();
            readings[axis].get_or_insert(place);
        }
    }
    let whole = |(key, readings): (&(usize, String), &[Option<usize>; 6])| {
        let places: Vec<usize> = readings.iter().flatten().copied().collect();
        (places.len() == readings.len()).then_some((key.0, places))
    };
    let Some((row, places)) = sensors.iter().find_map(whole) else {
        return Vec::new();
    };
    picks(columns, &places, NAMES[row].1)
}

/// Six columns as the readings of a sensor.
pub(super) fn picks(columns: &[Seen], places: &[usize], other: Option<&str>) -> Vec<Pick> {
    let because = match other {
        Some(other) => Because::likely(format!(
            "{other}: leave it out where it is not what the wrist's sensor reads"
        )),
        None => Because::certain("the six readings of a force-torque sensor"),
    };
    let pairs = places.iter().zip(QUANTITIES).enumerate();
    let picks = pairs.filter_map(|(axis, (place, quantity))| {
        let (si, name) = match axis {
            0..3 => (Unit::Newton, "N"),
            _ => (Unit::NewtonMetre, "Nm"),
        };
        let mut pick = Pick::new(quantity.to_owned(), *place, because.clone(), si);
        let said = columns[*place].unit.as_ref();
        if said.is_none_or(|said| said.unit.si != si) {
            pick.unit = Some(SaidUnit {
                unit: units::named(name)?,
                pressure: None,
                because: Because::likely(format!("nothing says it; {name} is usual")),
            });
        }
        Some(pick)
    });
    picks.collect()
}

/// The sensor that a name is of, and which of its six readings.
fn axis(name: &str) -> Option<(String, usize)> {
    // A number in brackets is the axis's; a unit is not the name.
    let digits = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
    let plain = match name.split_once(['[', '(']) {
        Some((head, rest)) => match rest.split_once([']', ')']) {
            Some((inside, after)) if digits(inside) => format!("{head}_{inside}{after}"),
            _ => head.to_owned(),
        },
        None => name.to_owned(),
    };
    let mut words: Vec<String> = plain
        .split(|c: char| !c.is_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(str::to_lowercase)
        .collect();
    while is_unit(&words) {
        words.pop();
    }
    let last = words.pop()?;
    if let Ok(number) = last.parse::<usize>() {
        let sensor = words.join("_");
        let is_known = NAMES.iter().any(|(name, _)| *name == sensor);
        return (is_known && number < QUANTITIES.len()).then_some((sensor, number));
    }
    // `force.x`, `Fx`, `forceX`.
    let (what, letter) = match AXES.contains(&last.as_str()) {
        true => (words.pop()?, last),
        false => {
            let at = last.char_indices().next_back()?.0;
            (last[..at].to_owned(), last[at..].to_owned())
        }
    };
    let axis = AXES.iter().position(|axis| *axis == letter)?;
    let of = match what.as_str() {
        word if FORCES.contains(&word) => 0,
        word if MOMENTS.contains(&word) => 3,
        _ => return None,
    };
    // Messages of a set point are no readings.
    let is_set = words.iter().any(|word| SET.contains(&word.as_str()));
    (!is_set).then(|| (words.join("_"), of + axis))
}

/// Whether the last word is a unit behind an axis: `force_x_n`, `torque_x_n_m`.
fn is_unit(words: &[String]) -> bool {
    let [.., before, last] = words else {
        return false;
    };
    ["n", "nm", "m"].contains(&last.as_str())
        && (before == "n" || AXES.iter().any(|axis| before.ends_with(axis)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::look::seen::Cells;
    use crate::import::map::Column;

    #[test]
    fn six_readings_are_found_however_they_are_called() {
        let columns = |names: &[String]| -> Vec<Seen> {
            let seen = |name: &String| Seen {
                column: Column::Name(name.clone()),
                name: name.clone(),
                joint: None,
                frames: Vec::new(),
                unit: super::super::units::of_name(name),
                cells: Cells::Numbers(vec![1.0, 2.0]),
            };
            names.iter().map(seen).collect()
        };
        let numbered = |name: &str| -> Vec<String> {
            (0..6).map(|i| name.replace('#', &i.to_string())).collect()
        };
        let listed = |names: [&str; 6]| names.map(str::to_owned).to_vec();
        for names in [
            numbered("ft_raw_wrench_#"),
            numbered("K_F_ext_hat_K[#]"),
            listed([
                "Fx [N]", "Fy [N]", "Fz [N]", "Tx [Nm]", "Ty [Nm]", "Tz [Nm]",
            ]),
            listed(["Fx", "Fy", "Fz", "Mx", "My", "Mz"]),
            listed([
                "/w.wrench.force.x",
                "/w.wrench.force.y",
                "/w.wrench.force.z",
                "/w.wrench.torque.x",
                "/w.wrench.torque.y",
                "/w.wrench.torque.z",
            ]),
            listed([
                "wrench_force_x_n",
                "wrench_force_y_n",
                "wrench_force_z_n",
                "wrench_torque_x_n_m",
                "wrench_torque_y_n_m",
                "wrench_torque_z_n_m",
            ]),
        ] {
            let columns = columns(&names);
            let found = wrench(&columns, &[]);
            assert_eq!(found.len(), 6, "{names:?}");
            for (place, pick) in found.iter().enumerate() {
                assert_eq!((pick.place, &*pick.quantity), (place, QUANTITIES[place]));
            }
        }
        let few = listed(["Fx", "Fy", "Fz", "x", "y", "z"]);
        assert!(wrench(&columns(&few), &[]).is_empty());
        // The sensor's own reading before what a controller made of it.
        let both = [numbered("actual_TCP_force_#"), numbered("ft_raw_wrench_#")].concat();
        assert_eq!(wrench(&columns(&both), &[])[0].place, 6);
    }
}

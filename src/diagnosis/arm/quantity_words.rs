//! Numbers of a recorded arm in words: what each is of, what it is, its unit.

use super::input::ArmInput;
use crate::arm::JointKind;
use crate::quantity::listed;
use crate::recorded_arm::Quantity;
use crate::recorded_arm::quantity::INERTIA_ELEMENTS;
use crate::recorded_arm::wrench::CHANNELS;

/// A number in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Named {
    /// What it is of: a link, a joint, a sensor.
    pub owner: String,
    /// What of that.
    pub part: String,
    /// Its unit.
    pub unit: &'static str,
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// A number in words.
#[must_use]
pub fn named(input: &ArmInput, quantity: Quantity) -> Named {
    use Quantity as Q;
    let of = |owner: &str, part: String, unit| Named {
        owner: owner.to_owned(),
        part,
        unit,
    };
    let along = |what: &str, axis: usize| format!("{what} along {}", AXES[axis]);
    match quantity {
        Q::LinkMass(link) => of(&input.links[link], "mass".to_owned(), "kg"),
        Q::LinkCentre(link, axis) => of(&input.links[link], along("centre", axis), "m"),
        Q::LinkInertia(link, element) => {
            of(&input.links[link], inertia(input, link, element), "kg m2")
        }
        Q::LoadMass => of("load", "mass".to_owned(), "kg"),
        Q::LoadMoment(axis) => of("load", along("moment", axis), "kg m"),
        Q::PayloadMass => of("a payload", "mass".to_owned(), "kg"),
        Q::PayloadMoment(axis) => of("a payload", along("moment", axis), "kg m"),
        Q::Tilt(0) => of("base", "roll".to_owned(), "rad"),
        Q::Tilt(_) => of("base", "pitch".to_owned(), "rad"),
        Q::ToolMass => of("tool", "mass".to_owned(), "kg"),
        Q::ToolCentre(axis) => of("tool", along("centre", axis), "m"),
        Q::OutsidePoint(axis) => of("contact", along("point", axis), "m"),
        Q::OutsideDrag => of("contact", "friction, as a share".to_owned(), ""),
        Q::SensorRotation => of("wrench sensor", "angle about z".to_owned(), "rad"),
        Q::WrenchGain(k) => of("wrench sensor", format!("gain of {}", words(k)), ""),
        Q::Zero(k) => of(
            "wrench sensor",
            format!("zero of {}", words(k)),
            zero_unit(k),
        ),
        other => of_drive(input, other),
    }
}

fn words(channel: usize) -> String {
    CHANNELS[channel].replace('_', " ")
}

const fn zero_unit(channel: usize) -> &'static str {
    if channel < 3 { "N" } else { "N m" }
}

/// An element of a link's inertia; that about the axis of the joint is called so.
fn inertia(input: &ArmInput, link: usize, element: usize) -> String {
    let (name, row, column) = INERTIA_ELEMENTS[element];
    let joint = &input.nominal.chain.joints[link];
    if row == column && joint.kind == JointKind::Revolute && joint.axis[row].abs() > 0.999 {
        return format!("inertia about the axis of {}", joint.name);
    }
    format!("inertia {name}")
}

/// A number of a joint's drive.
fn of_drive(input: &ArmInput, quantity: Quantity) -> Named {
    use Quantity as Q;
    let (joint, part, units) = match quantity {
        Q::InverseGain(j) => (j, "drive gain", ["N m/A", "N/A"]),
        Q::MotorInertia(j) => (j, "motor inertia", ["kg m2", "kg"]),
        Q::Coulomb(j) => (j, "dry friction", ["N m", "N"]),
        Q::Viscous(j) => (j, "viscous friction", ["N m s/rad", "N s/m"]),
        Q::Offset(j) => (j, "torque offset", ["N m", "N"]),
        Q::EncoderOffset(j) => (j, "encoder offset", ["rad", "m"]),
        Q::BristleLength(j) => (j, "bristle length", ["rad", "m"]),
        other => {
            return Named {
                owner: "arm".to_owned(),
                part: format!("{other:?}"),
                unit: "",
            };
        }
    };
    let own = &input.nominal.chain.joints[joint];
    Named {
        owner: own.name.clone(),
        part: part.to_owned(),
        unit: units[usize::from(own.kind == JointKind::Prismatic)],
    }
}

/// Numbers by what they are of, in their order: `link_2: mass and centre along z`.
#[must_use]
pub fn by_owner(input: &ArmInput, quantities: &[Quantity]) -> Vec<(String, Vec<String>)> {
    let mut all: Vec<(String, Vec<String>)> = Vec::new();
    for quantity in quantities {
        let Named { owner, part, .. } = named(input, *quantity);
        match all.iter_mut().find(|(own, _)| *own == owner) {
            Some((_, parts)) => parts.push(part),
            None => all.push((owner, vec![part])),
        }
    }
    all
}

/// The same in one phrase.
#[must_use]
pub fn phrase(input: &ArmInput, quantities: &[Quantity]) -> String {
    let owners = by_owner(input, quantities).into_iter();
    let each = owners.map(|(owner, parts)| format!("{owner}: {}", listed(&parts)));
    each.collect::<Vec<_>>().join("; ")
}

//! From the keys of an arm file to its arm, and to what of it is known within bounds.

use glam::DVec3;

use super::super::toleranced::{Content, Toleranced};
use super::keys::{ArmFileKeys, ArmKeys, DriveKeys, LinkKeys, LoadKeys, SensorsKeys, WrenchKeys};
use super::names::Names;
use super::noise::ArmNoise;
use super::order::column_order;

use crate::arm::{ArmOptions, load_arm};
use crate::keys::check::{Section, plain};
use crate::keys::document::Document;
use crate::keys::error::ScenarioError;
use crate::recorded_arm::outside::OutsideError;
use crate::recorded_arm::parameters::{USUAL_BRISTLE_LENGTH, set_mass};
use crate::recorded_arm::wrench::WrenchSensor;
use crate::recorded_arm::{ArmParameters, Drive, PointMass, Quantity, Tolerated};

/// Ranges of numbers [SI].
const MASS: [f64; 2] = [0.0, 1e5];
const LENGTH: [f64; 2] = [-1e3, 1e3];
const FRICTION: [f64; 2] = [0.0, 1e5];
const GAIN: [f64; 2] = [1e-6, 1e6];
const FORCE: [f64; 2] = [-1e5, 1e5];
const ANGLE: [f64; 2] = [-100.0, 100.0];

/// What is known within bounds so far.
pub(super) struct Known(pub Vec<Tolerated>);

impl Known {
    /// Notes a number whose bounds differ.
    fn add(&mut self, quantity: Quantity, bounds: [f64; 2]) {
        if bounds[0] < bounds[1] {
            self.0.push(Tolerated { quantity, bounds });
        }
    }

    /// Bounds of each component of a value that is given, noted; the value.
    fn taken<T: Content>(
        &mut self,
        (section, key): (&Section<'_>, &str),
        value: &Toleranced<T>,
        range: [f64; 2],
        quantity: impl Fn(usize) -> Quantity,
    ) -> Result<T, ScenarioError> {
        let bounds = value.bounds(section, key, range)?;
        for (index, bounds) in bounds.into_iter().enumerate() {
            self.add(quantity(index), bounds);
        }
        Ok(value.value)
    }

    fn optional(
        &mut self,
        place: (&Section<'_>, &str),
        value: Option<&Toleranced<f64>>,
        range: [f64; 2],
        quantity: Quantity,
    ) -> Result<f64, ScenarioError> {
        match value {
            Some(value) => self.taken(place, value, range, |_| quantity),
            None => Ok(0.0),
        }
    }
}

/// What of the URDF is the arm.
pub(super) fn options(keys: &ArmKeys) -> ArmOptions {
    ArmOptions {
        base_link: keys.base.clone(),
        tip_link: keys.flange.clone(),
        skip_visuals: true,
        is_recorded: true,
        ..ArmOptions::default()
    }
}

/// The URDF's arm, its drives still without numbers, with the names of its links and the number of each joint in columns.
pub(super) fn chain(
    document: &Document<'_>,
    keys: &ArmFileKeys,
) -> Result<(ArmParameters, Vec<String>, Vec<usize>), ScenarioError> {
    let section = Section::new(document, "arm");
    let path = section.file("urdf", &keys.arm.urdf)?;
    let arm = load_arm(&path, &options(&keys.arm)).map_err(|error| {
        let found = format!("\"{}\"", keys.arm.urdf.display());
        section.refuse("urdf", found, format!("an arm that can be read: {error}"))
    })?;
    let given: Vec<&str> = keys.drives.iter().map(|d| d.joint.as_str()).collect();
    let numbers = column_order(document, &arm.chain, &given)?;
    let drives = vec![Drive::default(); arm.chain.len()];
    let nominal = ArmParameters {
        chain: arm.chain,
        gravity: keys.arm.gravity,
        tilt: [0.0; 2],
        drives,
        load: PointMass::default(),
        payload: PointMass::default(),
        wrench: None,
        delay: 0.0,
        pushes: Vec::new(),
        laws: Vec::new(),
        outside_error: OutsideError::default(),
    };
    Ok((nominal, arm.link_names[1..].to_vec(), numbers))
}

/// Links by other numbers than the URDF's, and the tolerances of all.
pub(super) fn links(
    document: &Document<'_>,
    keys: &ArmFileKeys,
    names: Names<'_>,
    arm: &mut ArmParameters,
    known: &mut Known,
) -> Result<(), ScenarioError> {
    let mut given: Vec<Option<(usize, &LinkKeys)>> = vec![None; names.links.len()];
    for (index, link) in keys.links.iter().enumerate() {
        let section = Section::new(document, format!("link[{index}]"));
        let Some(place) = names.links.iter().position(|name| *name == link.name) else {
            let expected = format!(
                "a link behind a moving joint: one of {}",
                names.links.join(", ")
            );
            return Err(section.refuse("name", format!("{:?}", link.name), expected));
        };
        if given[place].replace((index, link)).is_some() {
            let expected = "each link once".to_owned();
            return Err(section.refuse("name", format!("{:?} again", link.name), expected));
        }
    }
    for (place, given) in given.into_iter().enumerate() {
        let section = Section::new(
            document,
            format!("link[{}]", given.map_or(0, |(index, _)| index)),
        );
        let body = &mut arm.chain.joints[place].body;
        let relative = keys.arm.mass_tolerance;
        match given.and_then(|(_, link)| link.mass.as_ref()) {
            Some(mass) => {
                let of = |_| Quantity::LinkMass(place);
                let from = known.0.len();
                set_mass(body, known.taken((&section, "mass_kg"), mass, MASS, of)?);
                if from == known.0.len() {
                    known.add(of(0), [-relative, relative].map(|t| body.mass * (1.0 + t)));
                }
            }
            None => {
                let bounds = [-relative, relative].map(|t| body.mass * (1.0 + t));
                known.add(Quantity::LinkMass(place), bounds);
            }
        }
        let of = |axis| Quantity::LinkCentre(place, axis);
        let from = known.0.len();
        if let Some(centre) = given.and_then(|(_, link)| link.centre.as_ref()) {
            let centre = known.taken((&section, "centre_m"), centre, LENGTH, of)?;
            body.centre_of_mass = centre.into();
        }
        if from == known.0.len() && body.mass > 0.0 {
            let half = keys.arm.centre_tolerance;
            for axis in 0..3 {
                let value = body.centre_of_mass[axis];
                known.add(of(axis), [value - half, value + half]);
            }
        }
    }
    Ok(())
}

/// A drive; `place` is its joint's in the chain, `index` its own in the file.
pub(super) fn drive(
    document: &Document<'_>,
    (index, keys): (usize, &DriveKeys),
    place: usize,
    known: &mut Known,
) -> Result<Drive, ScenarioError> {
    let section = Section::new(document, format!("drive[{index}]"));
    let mut drive = Drive::default();
    if let Some(gain) = &keys.gain {
        let bounds = gain.bounds(&section, "gain_n_m_per_a", GAIN)?[0];
        if bounds[0] <= 0.0 {
            let expected = "a tolerance less than the gain".to_owned();
            return Err(section.refuse_number("gain_n_m_per_a", gain.value, expected));
        }
        drive.logs_current = true;
        drive.inverse_gain = 1.0 / gain.value;
        known.add(
            Quantity::InverseGain(place),
            [1.0 / bounds[1], 1.0 / bounds[0]],
        );
    }
    let mut number = |key: &str, value: &Option<Toleranced<f64>>, range, quantity| {
        known.optional((&section, key), value.as_ref(), range, quantity)
    };
    let inertia = Quantity::MotorInertia(place);
    drive.motor_inertia = number("motor_inertia_kg_m2", &keys.motor_inertia, MASS, inertia)?;
    let coulomb = Quantity::Coulomb(place);
    drive.coulomb = number("coulomb_friction_n_m", &keys.coulomb, FRICTION, coulomb)?;
    let viscous = Quantity::Viscous(place);
    let key = "viscous_friction_n_m_s_per_rad";
    drive.viscous = number(key, &keys.viscous, FRICTION, viscous)?;
    drive.bristle_length = keys.bristle_length.unwrap_or(USUAL_BRISTLE_LENGTH);
    Ok(drive)
}

/// The declared load.
pub(super) fn load(
    document: &Document<'_>,
    keys: &LoadKeys,
    known: &mut Known,
) -> Result<PointMass, ScenarioError> {
    let section = Section::new(document, "load");
    let mut own = Known(Vec::new());
    let place = (&section, "mass_kg");
    let mass = own.optional(place, keys.mass.as_ref(), MASS, Quantity::LoadMass)?;
    let masses = own.0.first().map_or([mass; 2], |t| t.bounds);
    known.add(Quantity::LoadMass, masses);
    let Some(centre) = &keys.centre else {
        return Ok(PointMass {
            mass,
            moment: DVec3::ZERO,
        });
    };
    let bounds = centre.bounds(&section, "centre_m", LENGTH)?;
    for (axis, [low, high]) in bounds.into_iter().enumerate() {
        // Mass times centre is what torques depend on: its bounds are those of all that both may be.
        let ends = [low, high].map(|c| masses.map(|m| m * c)).concat();
        let least = ends.iter().copied().fold(f64::INFINITY, f64::min);
        let most = ends.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        known.add(Quantity::LoadMoment(axis), [least, most]);
    }
    Ok(PointMass {
        mass,
        moment: mass * DVec3::from(centre.value),
    })
}

/// The wrench sensor with its tool.
pub(super) fn wrench(
    document: &Document<'_>,
    keys: &WrenchKeys,
    known: &mut Known,
) -> Result<WrenchSensor, ScenarioError> {
    let section = Section::new(document, "wrench_sensor");
    let rotation = known.taken((&section, "rotation_z_rad"), &keys.rotation, ANGLE, |_| {
        Quantity::SensorRotation
    })?;
    let mut zero = [0.0; 6];
    for (first, key, value) in [
        (0, "zero_force_n", &keys.zero_force),
        (3, "zero_torque_n_m", &keys.zero_torque),
    ] {
        let Some(value) = value else { continue };
        let of = |axis| Quantity::Zero(first + axis);
        let taken = known.taken((&section, key), value, FORCE, of)?;
        zero[first..first + 3].copy_from_slice(&taken);
    }
    let tool_mass = known.taken((&section, "tool_mass_kg"), &keys.tool_mass, MASS, |_| {
        Quantity::ToolMass
    })?;
    let centre = known.taken(
        (&section, "tool_centre_m"),
        &keys.tool_centre,
        LENGTH,
        Quantity::ToolCentre,
    )?;
    let inertia = keys.tool_inertia.unwrap_or_default();
    if let Some(moment) = inertia.to_array().into_iter().find(|i| *i < 0.0) {
        let expected = "0 or more".to_owned();
        return Err(section.refuse_number("tool_inertia_kg_m2", moment, expected));
    }
    Ok(WrenchSensor {
        height: keys.height,
        rotation,
        zero,
        drift: [0.0; 6],
        gain: [1.0; 6],
        crosstalk: Vec::new(),
        tool_mass,
        tool_centre: centre.into(),
        tool_inertia_per_mass: match tool_mass > 0.0 {
            true => inertia / tool_mass,
            false => DVec3::ZERO,
        },
    })
}

/// Noise of the sensors, of drives base first.
pub(super) fn noise(
    document: &Document<'_>,
    keys: &SensorsKeys,
    arm: &ArmParameters,
    numbers: &[usize],
) -> Result<ArmNoise, ScenarioError> {
    let section = Section::new(document, "sensors");
    let count = arm.joints();
    for (key, list) in [("current_a", &keys.current), ("torque_n_m", &keys.torque)] {
        let Some(list) = list else { continue };
        if list.len() != count {
            let found = format!("a list of {}", list.len());
            let expected = format!("{count} numbers, one a drive");
            return Err(section.refuse(key, found, expected));
        }
        if let Some(wrong) = list.iter().find(|one| !(one.is_finite() && **one > 0.0)) {
            let expected = "the standard deviation of its noise, more than 0, as every sensor has";
            return Err(section.refuse(key, plain(*wrong), expected.to_owned()));
        }
    }
    let lacks = |logs_current: bool| arm.drives.iter().any(|d| d.logs_current == logs_current);
    let [of_current, of_torque] =
        [(true, &keys.current), (false, &keys.torque)].map(|(is, list)| {
            let other = if is { &keys.torque } else { &keys.current };
            lacks(is) && list.is_none() && other.is_some()
        });
    if of_current {
        let expected = "the noise of each drive's current: the drives have `gain_n_m_per_a`, so their currents are logged";
        return Err(section.missing("current_a", expected));
    }
    if of_torque {
        let expected =
            "the noise of each drive's torque: drives without `gain_n_m_per_a` log torques";
        return Err(section.missing("torque_n_m", expected));
    }
    let drives = arm.drives.iter().zip(numbers).map(|(drive, number)| {
        let list = if drive.logs_current {
            &keys.current
        } else {
            &keys.torque
        };
        list.as_ref().map(|list| list[number - 1])
    });
    let noise = ArmNoise {
        position: keys.position.unwrap_or(0.0),
        drives: drives.collect(),
        link: keys.link,
        force: keys.force,
        moment: keys.moment,
    };
    let is_any = noise.drives.iter().any(Option::is_some) || noise.link.is_some();
    if !is_any && noise.force.is_none() && noise.moment.is_none() {
        let expected = "the noise of one sensor at least: current_a or torque_n_m, link_rad, wrench_force_n and wrench_torque_n_m";
        return Err(section.missing("current_a", expected));
    }
    if arm.wrench.is_some() && (noise.force.is_none() || noise.moment.is_none()) {
        let key = match noise.force {
            None => "wrench_force_n",
            Some(_) => "wrench_torque_n_m",
        };
        return Err(section.missing(key, "the noise of the wrench sensor that the file has"));
    }
    Ok(noise)
}

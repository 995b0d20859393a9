//! Friction, inertia and gain of each drive as a fit leaves them, with 95 % intervals, beside the maker's limits.
//!
//! ```text
//! F [A] = F [N m]/g
//! ```
//!
//! g torque per ampere. Beside the numbers of the friction's own form stands the dry part of the straight line through all that rubs at the joint where it moves,
//!
//! ```text
//! F_all = F_line sign(q') + F_v q' + c
//! ```
//!
//! by least squares, as a controller's friction compensation takes it. Where friction alone loads a joint it is known better in amperes than in newton metres, whose interval has the gain's share in it.

use std::fmt::Write as _;

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::estimate::{FORM, HALF_WIDTH, covariance};
use super::evidence::slides;
use super::fit::Fit;
use super::input::ArmInput;
use crate::arm::JointKind;
use crate::diagnosis::answer::words::with_interval_in_si;
use crate::quantity::significant;
use crate::recorded_arm::simulate::{Channel, moments};
use crate::recorded_arm::{ArmParameters, Drive, Quantity};

/// A number with its interval; none where it is exact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveNumber {
    /// Its value [SI].
    pub value: f64,
    /// Ends of its interval [SI].
    pub interval: Option<[f64; 2]>,
}

/// A drive.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveNumbers {
    /// Its joint.
    pub joint: String,
    /// Kind of it.
    pub kind: JointKind,
    /// Dry friction [N m or N], viscous friction [N m s/rad or N s/m], inertia of motor and gear [kg m2 or kg].
    pub mechanical: [DriveNumber; 3],
    /// Dry friction [A], viscous friction [A s/rad or A s/m] and gain [N m/A or N/A], where currents are logged.
    pub electrical: Option<[DriveNumber; 3]>,
    /// Dry friction of the straight line through all that rubs [N m or N]; none of a joint that does not move both ways.
    pub dry_of_line: Option<f64>,
    /// Torque per ampere [N m/A or N/A]; 1 where torques are logged.
    pub gain: f64,
    /// Largest torque or force in the recordings [N m or N].
    pub largest_torque: f64,
    /// What the maker allows [N m or N]; infinite where the URDF does not say.
    pub effort: f64,
    /// Largest speed in the recordings [rad/s or m/s].
    pub largest_speed: f64,
    /// What the maker allows [rad/s or m/s].
    pub velocity: f64,
}

/// A number as it is made of a drive, what it depends on, and whether its size rests on the form of a law.
type Made = (fn(&Drive) -> f64, [Option<Quantity>; 2], bool);

/// Numbers of all drives, base first.
#[must_use]
pub fn drives(input: &ArmInput, fit: &Fit) -> Vec<DriveNumbers> {
    let covariance = covariance(fit);
    let number = |joint: usize, made: Made| number(fit, &covariance, joint, made);
    (0..input.nominal.joints())
        .map(|joint| {
            use Quantity as Q;
            let own = &input.nominal.chain.joints[joint];
            let drive = &fit.arm.drives[joint];
            let (coulomb, viscous) = (Some(Q::Coulomb(joint)), Some(Q::Viscous(joint)));
            let gain = Some(Q::InverseGain(joint));
            let mechanical: [Made; 3] = [
                (|d| d.coulomb, [coulomb, None], true),
                (|d| d.viscous, [viscous, None], true),
                (
                    |d| d.motor_inertia,
                    [Some(Q::MotorInertia(joint)), None],
                    false,
                ),
            ];
            let electrical: [Made; 3] = [
                (|d| d.coulomb * d.inverse_gain, [coulomb, gain], true),
                (|d| d.viscous * d.inverse_gain, [viscous, gain], true),
                (|d| 1.0 / d.inverse_gain, [gain, None], false),
            ];
            let [largest_torque, largest_speed] = largest(input, &fit.arm, joint);
            DriveNumbers {
                joint: own.name.clone(),
                kind: own.kind,
                mechanical: mechanical.map(|made| number(joint, made)),
                electrical: drive
                    .logs_current
                    .then(|| electrical.map(|made| number(joint, made))),
                dry_of_line: dry_of_line(input, fit, joint),
                gain: 1.0 / drive.inverse_gain,
                largest_torque,
                effort: own.effort,
                largest_speed,
                velocity: own.velocity,
            }
        })
        .collect()
}

fn number(
    fit: &Fit,
    covariance: &DMatrix<f64>,
    joint: usize,
    (of, depends, is_law): Made,
) -> DriveNumber {
    let value = of(&fit.arm.drives[joint]);
    let mut gradient = DVector::zeros(fit.parameters.len());
    let mut moves = false;
    for quantity in depends.into_iter().flatten() {
        let Some(place) = fit.parameters.iter().position(|p| p.quantity == quantity) else {
            continue;
        };
        moves = true;
        let at = quantity.value(&fit.arm);
        let step = 1e-4 * at.abs().max(1e-6);
        let moved = |by: f64| {
            let mut arm = fit.arm.clone();
            quantity.set(&mut arm, at + by);
            of(&arm.drives[joint])
        };
        gradient[place] = (moved(step) - moved(-step)) / (2.0 * step);
    }
    let variance = gradient.dot(&(covariance * &gradient)).max(0.0);
    let form = if is_law { FORM * value.abs() } else { 0.0 };
    let half = (HALF_WIDTH * variance.sqrt()).hypot(form);
    DriveNumber {
        value,
        interval: moves.then(|| [(value - half).max(0.0), value + half]),
    }
}

/// Dry friction of the straight line through all that rubs at a joint.
fn dry_of_line(input: &ArmInput, fit: &Fit, joint: usize) -> Option<f64> {
    let drive = &fit.arm.drives[joint];
    let laws = || fit.arm.laws.iter().filter(|law| law.joint == joint);
    let (mut a, mut b) = (Matrix3::zeros(), Vector3::zeros());
    for (r, recording) in input.recordings.iter().enumerate() {
        let (bristles, rigid) = fit.course.parts(r);
        let all = moments(drive, &recording.motion, bristles, &rigid.carried, joint);
        for (moment, slides) in all.zip(slides(input, r, joint)) {
            if slides {
                let own = moment.dry + drive.viscous * moment.speed;
                let rubs = own + laws().map(|law| law.torque(&moment)).sum::<f64>();
                let row = Vector3::new(moment.speed.signum(), moment.speed, 1.0);
                a += row * row.transpose();
                b += row * rubs;
            }
        }
    }
    a.cholesky()
        .map(|a| a.solve(&b)[0])
        .filter(|dry| dry.is_finite())
}

/// Largest torque and speed of a joint in the recordings.
fn largest(input: &ArmInput, arm: &ArmParameters, joint: usize) -> [f64; 2] {
    let most = |values: &[f64]| {
        let known = values.iter().filter(|v| v.is_finite());
        known.fold(0.0, |most: f64, v| most.max(v.abs()))
    };
    let channel = { input.channels.iter() }.position(|c| *c == Channel::Drive(joint));
    let mut all = [0.0; 2];
    for recording in &input.recordings {
        let torque = channel.map_or(0.0, |c| most(&recording.readings[c]));
        all[0] = f64::max(all[0], torque / arm.drives[joint].inverse_gain);
        all[1] = f64::max(all[1], most(&recording.motion.speed[joint]));
    }
    all
}

const COLUMNS: [&str; 6] = [
    "dry_friction_n_m",
    "viscous_friction_n_m_s_per_rad",
    "motor_inertia_kg_m2",
    "dry_friction_a",
    "viscous_friction_a_s_per_rad",
    "gain_n_m_per_a",
];

/// The drives as comma-separated values; of a prismatic joint read N for N m and m for rad.
#[must_use]
pub fn drives_text(drives: &[DriveNumbers]) -> String {
    let mut text = String::from("joint,kind");
    // Writing into a text cannot fail.
    for column in COLUMNS {
        let _ = write!(text, ",{column},{column}_low,{column}_high");
    }
    text += ",dry_friction_line_n_m,dry_friction_line_a,largest_torque_n_m,effort_limit_n_m,largest_speed_rad_per_s,speed_limit_rad_per_s\n";
    let shown = |value: f64| match value.is_finite() {
        true => significant(value, 5),
        false => String::new(),
    };
    for drive in drives {
        let kind = match drive.kind {
            JointKind::Revolute => "revolute",
            JointKind::Prismatic => "prismatic",
        };
        let _ = write!(text, "{},{kind}", drive.joint.replace([',', '"'], " "));
        let electrical = drive.electrical.map_or([None; 3], |all| all.map(Some));
        for number in drive.mechanical.map(Some).into_iter().chain(electrical) {
            let _ = match number {
                None => write!(text, ",,,"),
                Some(number) => {
                    let ends = number.interval.map(|ends| ends.map(shown));
                    let [low, high] = ends.unwrap_or_default();
                    write!(text, ",{},{low},{high}", shown(number.value))
                }
            };
        }
        let line = drive.dry_of_line.unwrap_or(f64::NAN);
        let amperes = drive.electrical.map_or(f64::NAN, |_| line / drive.gain);
        let limits = [
            line,
            amperes,
            drive.largest_torque,
            drive.effort,
            drive.largest_speed,
            drive.velocity,
        ];
        let _ = writeln!(text, ",{}", limits.map(shown).join(","));
    }
    text
}

/// A sentence for each drive.
#[must_use]
pub fn sentences(drives: &[DriveNumbers]) -> Vec<String> {
    drives.iter().map(sentence).collect()
}

fn sentence(drive: &DriveNumbers) -> String {
    let is_prismatic = drive.kind == JointKind::Prismatic;
    let units = match is_prismatic {
        false => ["N m", "N m s/rad", "kg m2", "A", "N m/A", "rad/s"],
        true => ["N", "N s/m", "kg", "A", "N/A", "m/s"],
    };
    let shown = |number: &DriveNumber, unit: &str| match number.interval {
        Some(ends) => with_interval_in_si(number.value, ends, unit),
        None => format!("{} {unit}", significant(number.value, 3)),
    };
    let [dry, viscous, inertia] = &drive.mechanical;
    let mut words = vec![format!("dry friction {}", shown(dry, units[0]))];
    if let Some([amperes, _, _]) = &drive.electrical {
        words.push(format!("which is {}", shown(amperes, units[3])));
    }
    words.push(format!("viscous friction {}", shown(viscous, units[1])));
    words.push(format!("motor inertia {}", shown(inertia, units[2])));
    if let Some([_, _, gain]) = &drive.electrical {
        words.push(format!("gain {}", shown(gain, units[4])));
    }
    let what = if is_prismatic { "force" } else { "torque" };
    let held = [
        (what, drive.largest_torque, drive.effort, units[0]),
        ("speed", drive.largest_speed, drive.velocity, units[5]),
    ];
    let held: Vec<String> = { held.into_iter() }
        .filter(|(_, found, limit, _)| *found > 0.0 && limit.is_finite())
        .map(|(what, found, limit, unit)| {
            let beyond = if found > limit { ", beyond it" } else { "" };
            let [found, limit] = [found, limit].map(|value| significant(value, 3));
            format!("{what} {found} of {limit} {unit}{beyond}")
        })
        .collect();
    let text = format!("{}: {}.", drive.joint, words.join(", "));
    match held.is_empty() {
        true => text,
        false => format!(
            "{text} At most, of what its maker allows: {}.",
            held.join(", ")
        ),
    }
}

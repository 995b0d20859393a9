//! Numbers of an effect as they are reported, with 95 % intervals from the curvature of the fit.
//!
//! ```text
//! var f = grad f^T H^-1 grad f s^2
//! ```
//!
//! H curvature of half the cost, with what is known of the tolerated numbers; s an eighth more than the noise alone. What a law of a textbook leaves of a real
//! joint, gear or hose is added: its size is right to three hundredths (Armstrong-Helouvry et al., Automatica 30 (1994), 1083: friction differs that much from one
//! law to another on the same data).

use nalgebra::{DMatrix, DVector};

use super::effect::{ArmEffect, Candidate};
use super::fit::Fit;
use crate::recorded_arm::{ArmParameters, Quantity};

/// Half-width of an interval over the standard deviation of noise alone [1]: 1.96, and an eighth for the model.
pub const HALF_WIDTH: f64 = 2.2;

/// Half-width of what the form of a law leaves open, as a share of its size [1].
pub const FORM: f64 = 0.03;
/// The same of the beginning and end of a push, whose course is not known [s].
const COURSE: f64 = 0.04;

/// A number with its interval.
#[derive(Debug, Clone, PartialEq)]
pub struct Number {
    /// Key in the vocabulary.
    pub key: &'static str,
    /// Value, and half of the interval [SI].
    pub value: f64,
    /// Half-width [SI].
    pub half: f64,
}

/// A number as it is made of a description.
type Reported = (&'static str, Box<dyn Fn(&ArmParameters) -> f64>);

/// Numbers of an effect.
#[must_use]
pub fn numbers(fit: &Fit, covariance: &DMatrix<f64>, effect: &Candidate) -> Vec<Number> {
    let own = reported(effect);
    own.into_iter()
        .map(|(key, value)| {
            let gradient: Vec<f64> = (fit.parameters.iter())
                .map(|parameter| {
                    let quantity = parameter.quantity;
                    let at = quantity.value(&fit.arm);
                    let step = 0.1 * quantity.step(at);
                    let of = |x: f64| {
                        let mut arm = fit.arm.clone();
                        quantity.set(&mut arm, x);
                        value(&arm)
                    };
                    (of(at + step) - of(at - step)) / (2.0 * step)
                })
                .collect();
            let gradient = DVector::from_vec(gradient);
            let variance = gradient.dot(&(covariance * &gradient));
            let found = value(&fit.arm);
            let form = match (is_law_of_textbook(effect.effect), key) {
                (_, "start_s" | "end_s") => COURSE,
                (true, "cycles_per_turn" | "rest_rad") | (false, _) => 0.0,
                (true, _) => FORM * found.abs(),
            };
            Number {
                key,
                value: found,
                half: (HALF_WIDTH * variance.max(0.0).sqrt()).hypot(form),
            }
        })
        .collect()
}

/// Numbers of an effect as a description has them, in the same order; NaN where it has none.
#[must_use]
pub fn declared(arm: &ArmParameters, effect: &Candidate) -> Vec<f64> {
    match effect.effect {
        // A description states no push.
        ArmEffect::Push(_) => Vec::new(),
        _ => reported(effect)
            .iter()
            .map(|(_, value)| value(arm))
            .collect(),
    }
}

/// Whether an effect is a law of a textbook: not a mass, a gain or a number of a sensor.
fn is_law_of_textbook(effect: ArmEffect) -> bool {
    matches!(
        effect,
        ArmEffect::JointFriction(_)
            | ArmEffect::Stribeck(_)
            | ArmEffect::LoadFriction(_)
            | ArmEffect::GearRipple(_)
            | ArmEffect::CompliantJoint(_)
            | ArmEffect::WarmUp(_)
            | ArmEffect::DressPack(_)
            | ArmEffect::Push(_)
            | ArmEffect::Crosstalk(..)
            | ArmEffect::WrenchDrift(_)
    )
}

/// Covariance of a fit's numbers.
#[must_use]
pub fn covariance(fit: &Fit) -> DMatrix<f64> {
    inverse_of(&fit.hessian)
}

/// Inverse of the curvature of half a cost; zeros where it is not positive definite.
#[must_use]
pub fn inverse_of(hessian: &DMatrix<f64>) -> DMatrix<f64> {
    let count = hessian.nrows();
    // Scaled to ones on its diagonal: units differ by many orders.
    let scale: Vec<f64> = (0..count)
        .map(|i| hessian[(i, i)].max(1e-300).sqrt())
        .collect();
    let scaled = DMatrix::from_fn(count, count, |i, j| hessian[(i, j)] / (scale[i] * scale[j]));
    let inverse = scaled
        .cholesky()
        .map_or_else(|| DMatrix::zeros(count, count), |c| c.inverse());
    DMatrix::from_fn(count, count, |i, j| inverse[(i, j)] / (scale[i] * scale[j]))
}

fn reported(candidate: &Candidate) -> Vec<Reported> {
    use Quantity as Q;
    let plain = |key: &'static str, quantity: Q| -> Reported {
        (
            key,
            Box::new(move |arm: &ArmParameters| quantity.value(arm)),
        )
    };
    match candidate.effect {
        ArmEffect::JointFriction(j) => vec![
            plain("coulomb_n_m", Q::Coulomb(j)),
            plain("viscous_n_m_s_per_rad", Q::Viscous(j)),
        ],
        ArmEffect::Stribeck(j) => of_stribeck(j),
        ArmEffect::LoadFriction(j) => vec![plain("friction_per_load", Q::LoadFriction(j))],
        ArmEffect::MotorInertia(j) => vec![plain("inertia_kg_m2", Q::MotorInertia(j))],
        ArmEffect::DriveGain(j) => vec![(
            "gain_n_m_per_a",
            Box::new(move |arm| 1.0 / arm.drives[j].inverse_gain),
        )],
        ArmEffect::TorqueOffset(j) => vec![plain("offset_n_m", Q::Offset(j))],
        ArmEffect::GearRipple(j) => vec![
            (
                "amplitude_n_m",
                Box::new(move |arm| arm.drives[j].ripple[0].hypot(arm.drives[j].ripple[1])),
            ),
            plain("cycles_per_turn", Q::RippleCycles(j)),
        ],
        ArmEffect::CompliantJoint(j) => vec![(
            "stiffness_n_m_per_rad",
            Box::new(move |arm| 1.0 / arm.drives[j].compliance),
        )],
        ArmEffect::EncoderOffset(j) => vec![plain("offset_rad", Q::EncoderOffset(j))],
        ArmEffect::WarmUp(j) => vec![
            plain("fraction", Q::WarmFraction(j)),
            plain("time_constant_s", Q::WarmTime(j)),
        ],
        ArmEffect::Payload => of_payload(),
        ArmEffect::LinkMass(link) => vec![plain("mass_kg", Q::LinkMass(link))],
        ArmEffect::BaseTilt => vec![
            plain("roll_rad", Q::Tilt(0)),
            plain("pitch_rad", Q::Tilt(1)),
        ],
        ArmEffect::DressPack(j) => vec![
            plain("stiffness_n_m_per_rad", Q::SpringStiffness(j)),
            (
                "rest_rad",
                Box::new(move |arm| -arm.drives[j].offset / arm.drives[j].spring_stiffness),
            ),
        ],
        ArmEffect::Push(_) => of_push(candidate),
        ArmEffect::WrenchZero => ZEROS
            .iter()
            .enumerate()
            .map(|(k, key)| plain(key, Q::Zero(k)))
            .collect(),
        ArmEffect::ToolWeight => vec![
            plain("mass_kg", Q::ToolMass),
            plain("centre_x_m", Q::ToolCentre(0)),
            plain("centre_y_m", Q::ToolCentre(1)),
            plain("centre_z_m", Q::ToolCentre(2)),
        ],
        ArmEffect::FrameTurned | ArmEffect::Unlisted(_) => Vec::new(),
        ArmEffect::WrenchGain(k) => vec![plain("gain", Q::WrenchGain(k))],
        ArmEffect::Crosstalk(source, target) => {
            vec![plain("coefficient", Q::Crosstalk(source, target))]
        }
        ArmEffect::WrenchDrift(k) => vec![plain("n_per_s", Q::Drift(k))],
        ArmEffect::CurrentLate => vec![plain("delay_s", Q::Delay)],
    }
}

fn of_stribeck(j: usize) -> Vec<Reported> {
    use Quantity as Q;
    vec![
        ("coulomb_n_m", Box::new(move |arm| Q::Coulomb(j).value(arm))),
        (
            "viscous_n_m_s_per_rad",
            Box::new(move |arm| Q::Viscous(j).value(arm)),
        ),
        (
            "static_n_m",
            Box::new(move |arm| arm.drives[j].coulomb + arm.drives[j].static_excess),
        ),
        (
            "stribeck_velocity_rad_per_s",
            Box::new(move |arm| Q::StribeckVelocity(j).value(arm)),
        ),
    ]
}

fn of_payload() -> Vec<Reported> {
    let centre = |axis: usize| -> Box<dyn Fn(&ArmParameters) -> f64> {
        Box::new(move |arm| arm.payload.centre()[axis])
    };
    vec![
        (
            "mass_kg",
            Box::new(|arm: &ArmParameters| Quantity::PayloadMass.value(arm)),
        ),
        ("centre_x_m", centre(0)),
        ("centre_y_m", centre(1)),
        ("centre_z_m", centre(2)),
    ]
}

const ZEROS: [&str; 6] = [
    "force_x_n",
    "force_y_n",
    "force_z_n",
    "torque_x_n_m",
    "torque_y_n_m",
    "torque_z_n_m",
];

fn of_push(candidate: &Candidate) -> Vec<Reported> {
    let index = candidate.free.iter().find_map(|p| match p.quantity {
        Quantity::PushStart(index) => Some(index),
        _ => None,
    });
    let Some(index) = index else {
        return Vec::new();
    };
    vec![
        ("start_s", Box::new(move |arm| arm.pushes[index].start)),
        ("end_s", Box::new(move |arm| arm.pushes[index].end)),
        (
            "force_n",
            Box::new(move |arm| arm.pushes[index].force.length()),
        ),
    ]
}

/// The angle by which a sensor is turned beyond what is declared [rad], with half of its interval.
#[must_use]
pub fn turned(fit: &Fit, covariance: &DMatrix<f64>, declared: f64) -> Number {
    let place = (fit.parameters.iter()).position(|p| p.quantity == Quantity::SensorRotation);
    let variance = place.map_or(0.0, |i| covariance[(i, i)]);
    let found = fit.arm.wrench.as_ref().map_or(0.0, |w| w.rotation) - declared;
    let turn = std::f64::consts::TAU;
    Number {
        key: "angle_rad",
        value: found - turn * (found / turn).round(),
        half: HALF_WIDTH * variance.max(0.0).sqrt(),
    }
}

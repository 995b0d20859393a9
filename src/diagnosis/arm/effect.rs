//! What may be missing in a recorded arm's description: which numbers each effect frees, and where a search begins.

use super::fit::Parameter;
use super::input::ArmInput;
use crate::arm::JointKind;
use crate::recorded_arm::law::{Factor, JointLaw, Shape, Variable};
use crate::recorded_arm::push::Push;
use crate::recorded_arm::simulate::Channel;
use crate::recorded_arm::{ArmParameters, Quantity};
use std::f64::consts::TAU;

/// An effect with where it is; joints, links, channels and recordings from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ArmEffect {
    /// Dry and viscous friction outside their tolerances.
    JointFriction(usize),
    /// Friction that falls as a joint starts to turn.
    Stribeck(usize),
    /// Friction that grows with the torque carried.
    LoadFriction(usize),
    /// Inertia of motor and gear outside its tolerance.
    MotorInertia(usize),
    /// Torque per ampere outside its tolerance.
    DriveGain(usize),
    /// A constant torque.
    TorqueOffset(usize),
    /// A torque periodic in the joint's angle.
    GearRipple(usize),
    /// A soft gear.
    CompliantJoint(usize),
    /// An encoder's zero.
    EncoderOffset(usize),
    /// Friction that falls as the joint warms.
    WarmUp(usize),
    /// A load that is not declared.
    Payload,
    /// A link's mass outside its tolerance.
    LinkMass(usize),
    /// The base does not stand as declared.
    BaseTilt,
    /// Hoses that pull a joint to a rest angle.
    DressPack(usize),
    /// A push from outside, in a recording.
    Push(usize),
    /// The wrench sensor's zero outside its tolerance.
    WrenchZero,
    /// The tool's mass and centre outside their tolerances.
    ToolWeight,
    /// The sensor is turned about its z.
    FrameTurned,
    /// A channel's gain.
    WrenchGain(usize),
    /// A share of a source (first) in a target (second).
    Crosstalk(usize, usize),
    /// A channel's zero that drifts.
    WrenchDrift(usize),
    /// Currents are stamped late.
    CurrentLate,
    /// A law at a joint that has no name.
    Unlisted(usize),
}

/// A way in which an effect may act: where its numbers begin, which of them a fit moves.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The effect.
    pub effect: ArmEffect,
    /// Numbers as they begin.
    pub presets: Vec<(Quantity, f64)>,
    /// Numbers that are free.
    pub free: Vec<Parameter>,
    /// Those of the free ones that a screening moves: readings depend on them nearly linearly.
    pub screened: Vec<Quantity>,
    /// A push that is added.
    pub push: Option<Push>,
    /// A law that is added.
    pub law: Option<JointLaw>,
}

/// Stribeck velocities that gears have [rad/s].
const STRIBECK: [f64; 2] = [2e-3, 0.4];
const ANY: [f64; 2] = [-1e6, 1e6];
const POSITIVE: [f64; 2] = [0.0, 1e6];

impl ArmEffect {
    /// The joint at which it acts, if it is one joint's.
    #[must_use]
    pub fn joint(self) -> Option<usize> {
        match self {
            Self::JointFriction(joint)
            | Self::Stribeck(joint)
            | Self::LoadFriction(joint)
            | Self::MotorInertia(joint)
            | Self::DriveGain(joint)
            | Self::TorqueOffset(joint)
            | Self::GearRipple(joint)
            | Self::CompliantJoint(joint)
            | Self::EncoderOffset(joint)
            | Self::WarmUp(joint)
            | Self::DressPack(joint)
            | Self::Unlisted(joint) => Some(joint),
            _ => None,
        }
    }

    /// What a simpler effect would be of which this one is more than.
    #[must_use]
    pub fn simpler(self) -> Option<Self> {
        match self {
            Self::Stribeck(joint) => Some(Self::JointFriction(joint)),
            Self::DressPack(joint) => Some(Self::TorqueOffset(joint)),
            _ => None,
        }
    }
}

impl Candidate {
    fn linear(effect: ArmEffect, free: &[(Quantity, [f64; 2])]) -> Self {
        let parameters = free.iter().map(|(q, bounds)| Parameter::free(*q, *bounds));
        Self {
            effect,
            presets: Vec::new(),
            free: parameters.collect(),
            screened: free.iter().map(|(q, _)| *q).collect(),
            push: None,
            law: None,
        }
    }

    fn from(mut self, presets: &[(Quantity, f64)]) -> Self {
        self.presets = presets.to_vec();
        self
    }

    /// With numbers that only a whole fit moves.
    fn refined(mut self, free: &[(Quantity, [f64; 2])]) -> Self {
        let parameters = free.iter().map(|(q, bounds)| Parameter::free(*q, *bounds));
        self.free.extend(parameters);
        self
    }

    /// Puts it into a description; numbers of pushes and laws take the place that they get.
    #[must_use]
    pub fn applied(&self, arm: &mut ArmParameters) -> Self {
        let (pushes, laws) = (arm.pushes.len(), arm.laws.len());
        let placed = |quantity: Quantity| match quantity {
            Quantity::PushForce(_, axis) => Quantity::PushForce(pushes, axis),
            Quantity::PushStart(_) => Quantity::PushStart(pushes),
            Quantity::PushEnd(_) => Quantity::PushEnd(pushes),
            Quantity::PushEdge(_) => Quantity::PushEdge(pushes),
            Quantity::LawAmplitude(_, which) => Quantity::LawAmplitude(laws, which),
            Quantity::LawPlace(_) => Quantity::LawPlace(laws),
            Quantity::LawWidth(_) => Quantity::LawWidth(laws),
            other => other,
        };
        arm.pushes.extend(self.push);
        arm.laws.extend(self.law);
        for (quantity, value) in &self.presets {
            quantity.set(arm, *value);
        }
        let mut own = self.clone();
        for parameter in &mut own.free {
            parameter.quantity = placed(parameter.quantity);
        }
        for quantity in &mut own.screened {
            *quantity = placed(*quantity);
        }
        own
    }
}

/// All ways in which something listed may be missing.
#[must_use]
pub fn candidates(input: &ArmInput) -> Vec<Candidate> {
    let mut all = Vec::new();
    for joint in 0..input.nominal.joints() {
        of_joint(input, joint, &mut all);
    }
    of_load_and_mount(input, &mut all);
    if input.nominal.wrench.is_some() {
        of_wrench(&mut all);
    }
    all
}

fn of_joint(input: &ArmInput, joint: usize, all: &mut Vec<Candidate>) {
    use Quantity as Q;
    let friction = [(Q::Coulomb(joint), POSITIVE), (Q::Viscous(joint), POSITIVE)];
    all.push(Candidate::linear(
        ArmEffect::JointFriction(joint),
        &friction,
    ));
    for velocity in [0.015, 0.03, 0.06, 0.12, 0.25] {
        let stribeck = [friction[0], friction[1], (Q::StaticExcess(joint), POSITIVE)];
        all.push(
            Candidate::linear(ArmEffect::Stribeck(joint), &stribeck)
                .from(&[
                    (Q::StribeckVelocity(joint), velocity),
                    (Q::StaticExcess(joint), 1e-3),
                ])
                .refined(&[(Q::StribeckVelocity(joint), STRIBECK)]),
        );
    }
    of_drive(input, joint, all);
    of_gear(input, joint, all);
}

/// Effects of a joint's drive beside its friction.
fn of_drive(input: &ArmInput, joint: usize, all: &mut Vec<Candidate>) {
    use Quantity as Q;
    let drive = &input.nominal.drives[joint];
    let one = |effect, quantity, bounds| Candidate::linear(effect, &[(quantity, bounds)]);
    all.push(one(
        ArmEffect::LoadFriction(joint),
        Q::LoadFriction(joint),
        [-1.0, 1.0],
    ));
    all.push(one(
        ArmEffect::MotorInertia(joint),
        Q::MotorInertia(joint),
        POSITIVE,
    ));
    if drive.logs_current {
        let bounds = [0.2, 5.0].map(|factor| factor * drive.inverse_gain);
        all.push(one(
            ArmEffect::DriveGain(joint),
            Q::InverseGain(joint),
            bounds,
        ));
    }
    all.push(one(ArmEffect::TorqueOffset(joint), Q::Offset(joint), ANY));
    for time in [1.5, 3.0, 6.0, 12.0, 25.0, 60.0] {
        all.push(
            one(
                ArmEffect::WarmUp(joint),
                Q::WarmFraction(joint),
                [-2.0, 1.0],
            )
            .from(&[(Q::WarmTime(joint), time), (Q::WarmFraction(joint), 1e-4)])
            .refined(&[(Q::WarmTime(joint), [0.3, 600.0])]),
        );
    }
}

/// Effects of a joint's gear, encoder and hoses.
fn of_gear(input: &ArmInput, joint: usize, all: &mut Vec<Candidate>) {
    use Quantity as Q;
    let one = |effect, quantity, bounds| Candidate::linear(effect, &[(quantity, bounds)]);
    let by_contact = input.shows_joints_by_contact();
    if input.channels.contains(&Channel::Link(joint)) && !by_contact {
        all.push(one(
            ArmEffect::CompliantJoint(joint),
            Q::Compliance(joint),
            [0.0, 0.1],
        ));
    }
    if !by_contact {
        all.push(one(
            ArmEffect::EncoderOffset(joint),
            Q::EncoderOffset(joint),
            [-0.5, 0.5],
        ));
    }
    let spring = [
        (Q::SpringStiffness(joint), POSITIVE),
        (Q::Offset(joint), ANY),
    ];
    all.push(Candidate::linear(ArmEffect::DressPack(joint), &spring));
    for cycles in ripple_cycles(input, joint) {
        let ripple = [(Q::Ripple(joint, 0), ANY), (Q::Ripple(joint, 1), ANY)];
        all.push(
            Candidate::linear(ArmEffect::GearRipple(joint), &ripple)
                .from(&[
                    (Q::RippleCycles(joint), cycles),
                    (Q::Ripple(joint, 0), 1e-6),
                ])
                .refined(&[(
                    Q::RippleCycles(joint),
                    [0.9 * cycles - 2.0, 1.1 * cycles + 2.0],
                )]),
        );
    }
}

/// Cycles a turn that the travel of a joint tells apart.
#[must_use]
pub fn ripple_cycles(input: &ArmInput, joint: usize) -> Vec<f64> {
    if input.nominal.chain.joints[joint].kind == JointKind::Prismatic {
        return Vec::new();
    }
    let (mut low, mut high) = (f64::MAX, f64::MIN);
    for recording in &input.recordings {
        for q in &recording.motion.position[joint] {
            (low, high) = (low.min(*q), high.max(*q));
        }
    }
    let travel = (high - low).max(0.05);
    // From two cycles over the travel on: less is a slope.
    let (from, step) = (TAU / travel * 1.5, 0.4 * TAU / travel);
    let count = ((200.0 - from) / step).max(0.0) as usize;
    (0..count.min(700))
        .map(|i| from + step * i as f64)
        .collect()
}

fn of_load_and_mount(input: &ArmInput, all: &mut Vec<Candidate>) {
    use Quantity as Q;
    let payload = [
        (Q::PayloadMass, POSITIVE),
        (Q::PayloadMoment(0), ANY),
        (Q::PayloadMoment(1), ANY),
        (Q::PayloadMoment(2), ANY),
    ];
    // From a mass on that has a centre.
    let begun = [(Q::PayloadMass, 0.1)];
    all.push(Candidate::linear(ArmEffect::Payload, &payload).from(&begun));
    for link in 0..input.nominal.joints() {
        let mass = input.nominal.chain.joints[link].body.mass;
        if mass > 0.0 {
            let bounds = [0.5 * mass, 2.0 * mass];
            all.push(Candidate::linear(
                ArmEffect::LinkMass(link),
                &[(Q::LinkMass(link), bounds)],
            ));
        }
    }
    let tilt = [(Q::Tilt(0), [-0.5, 0.5]), (Q::Tilt(1), [-0.5, 0.5])];
    all.push(Candidate::linear(ArmEffect::BaseTilt, &tilt));
    for delay in [0.0, 0.02, -0.02, 0.05] {
        all.push(
            Candidate::linear(ArmEffect::CurrentLate, &[(Q::Delay, [-0.2, 0.2])])
                .from(&[(Q::Delay, delay)]),
        );
    }
}

fn of_wrench(all: &mut Vec<Candidate>) {
    use Quantity as Q;
    let zeros: Vec<_> = (0..6).map(|k| (Q::Zero(k), ANY)).collect();
    all.push(Candidate::linear(ArmEffect::WrenchZero, &zeros));
    let tool = [
        (Q::ToolMass, POSITIVE),
        (Q::ToolCentre(0), [-2.0, 2.0]),
        (Q::ToolCentre(1), [-2.0, 2.0]),
        (Q::ToolCentre(2), [-2.0, 2.0]),
    ];
    all.push(Candidate::linear(ArmEffect::ToolWeight, &tool));
    for turn in [0.0, 0.5, -0.5, 1.57, -1.57, 3.1] {
        let mut candidate = Candidate::linear(
            ArmEffect::FrameTurned,
            &[(Q::SensorRotation, [-10.0, 10.0])],
        );
        candidate.presets = vec![(Q::SensorRotation, turn)];
        all.push(candidate);
    }
    for k in 0..6 {
        all.push(Candidate::linear(
            ArmEffect::WrenchGain(k),
            &[(Q::WrenchGain(k), [-3.0, 3.0])],
        ));
        all.push(Candidate::linear(
            ArmEffect::WrenchDrift(k),
            &[(Q::Drift(k), ANY)],
        ));
        for source in (0..6).filter(|source| *source != k) {
            let share = [(Q::Crosstalk(source, k), ANY)];
            all.push(Candidate::linear(ArmEffect::Crosstalk(source, k), &share));
        }
    }
}

/// A law at a joint from a place and a width on.
#[must_use]
pub fn law(
    joint: usize,
    (shape, variable, factor): (Shape, Variable, Factor),
    (place, width): (f64, f64),
    refined: &[(Quantity, [f64; 2])],
) -> Candidate {
    let amplitudes: &[(Quantity, [f64; 2])] = if shape == Shape::Sine {
        &[
            (Quantity::LawAmplitude(0, 0), ANY),
            (Quantity::LawAmplitude(0, 1), ANY),
        ]
    } else {
        &[(Quantity::LawAmplitude(0, 0), ANY)]
    };
    let mut candidate = Candidate::linear(ArmEffect::Unlisted(joint), amplitudes).refined(refined);
    candidate.law = Some(JointLaw {
        joint,
        shape,
        variable,
        factor,
        amplitude: [0.0; 2],
        place,
        width,
    });
    candidate
}

//! Numbers of a recorded arm that a fit may move.

use super::parameters::{ArmParameters, Drive, set_mass};
use super::wrench::{Crosstalk, WrenchSensor};

/// A number of the description; joints, links and axes from 0. Gains are moved by their inverse and centres by mass times centre where that makes readings
/// depend on them linearly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quantity {
    /// Mass of a link [kg].
    LinkMass(usize),
    /// A coordinate of a link's centre of mass [m].
    LinkCentre(usize, usize),
    /// An element of a link's inertia tensor about its centre of mass, in the order of [`INERTIA_ELEMENTS`] [kg m2].
    LinkInertia(usize, usize),
    /// Amperes per newton metre [A/(N m)].
    InverseGain(usize),
    /// Inertia of motor and gear [kg m2].
    MotorInertia(usize),
    /// Dry friction [N m].
    Coulomb(usize),
    /// Viscous friction [N m s/rad].
    Viscous(usize),
    /// Length over which friction builds up, its logarithm [rad].
    BristleLength(usize),
    /// Static less dry friction [N m].
    StaticExcess(usize),
    /// Stribeck velocity [rad/s].
    StribeckVelocity(usize),
    /// Dry friction per torque carried [1].
    LoadFriction(usize),
    /// Share by which friction falls [1].
    WarmFraction(usize),
    /// Time constant of that [s].
    WarmTime(usize),
    /// Constant torque [N m].
    Offset(usize),
    /// Ripple: factor of the sine (0) or the cosine (1) [N m].
    Ripple(usize, usize),
    /// Cycles of the ripple a turn [1].
    RippleCycles(usize),
    /// Stiffness of a dress pack [N m/rad].
    SpringStiffness(usize),
    /// Encoder offset [rad].
    EncoderOffset(usize),
    /// Compliance of the gear [rad/(N m)].
    Compliance(usize),
    /// Mass of the declared load [kg].
    LoadMass,
    /// A coordinate of its mass times centre [kg m].
    LoadMoment(usize),
    /// Mass of a load that is not declared [kg].
    PayloadMass,
    /// A coordinate of its mass times centre [kg m].
    PayloadMoment(usize),
    /// How the base stands turned, about x (0) or y (1) [rad].
    Tilt(usize),
    /// Zero of a channel of the wrench sensor [N or N m].
    Zero(usize),
    /// Rate of a channel's zero [N/s or N m/s].
    Drift(usize),
    /// Gain of a channel [1].
    WrenchGain(usize),
    /// Share of a source (first) that a target (second) reads [1].
    Crosstalk(usize, usize),
    /// Axes of the sensor against the flange's [rad].
    SensorRotation,
    /// Mass of the tool beyond the sensor [kg].
    ToolMass,
    /// A coordinate of the tool's centre [m].
    ToolCentre(usize),
    /// A coordinate of how far what acts from outside acts beside where it is stated to [m].
    OutsidePoint(usize),
    /// How far friction of the tool is off what is stated, as a share of it [1].
    OutsideDrag,
    /// How late currents are stamped [s].
    Delay,
    /// Component of the largest force of a push [N].
    PushForce(usize, usize),
    /// Start of a push [s].
    PushStart(usize),
    /// End of a push [s].
    PushEnd(usize),
    /// Share of a push's duration over which it grows [1].
    PushEdge(usize),
    /// Factor of a law, first or second.
    LawAmplitude(usize, usize),
    /// Place of a law.
    LawPlace(usize),
    /// Width of a law.
    LawWidth(usize),
}

/// Elements of an inertia tensor: name, row and column.
pub const INERTIA_ELEMENTS: [(&str, usize, usize); 6] = [
    ("xx", 0, 0),
    ("yy", 1, 1),
    ("zz", 2, 2),
    ("xy", 0, 1),
    ("xz", 0, 2),
    ("yz", 1, 2),
];

fn crosstalk(wrench: &mut WrenchSensor, source: usize, target: usize) -> &mut f64 {
    let known = (wrench.crosstalk.iter()).position(|c| c.source == source && c.target == target);
    let index = known.unwrap_or_else(|| {
        wrench.crosstalk.push(Crosstalk {
            source,
            target,
            share: 0.0,
        });
        wrench.crosstalk.len() - 1
    });
    &mut wrench.crosstalk[index].share
}

/// Where a number of a drive stands.
type DriveField = fn(&mut Drive) -> &mut f64;

impl Quantity {
    /// The number itself, where it is one that stands in the description as it is.
    fn slot(self, arm: &mut ArmParameters) -> Option<&mut f64> {
        if let Some((joint, field)) = self.of_drive() {
            return arm.drives.get_mut(joint).map(field);
        }
        match self {
            Self::PushForce(index, axis) => {
                return arm.pushes.get_mut(index).map(|p| &mut p.force[axis]);
            }
            Self::PushStart(index) => return arm.pushes.get_mut(index).map(|p| &mut p.start),
            Self::PushEnd(index) => return arm.pushes.get_mut(index).map(|p| &mut p.end),
            Self::PushEdge(index) => return arm.pushes.get_mut(index).map(|p| &mut p.edge),
            _ => {}
        }
        let wrench = arm.wrench.as_mut();
        match self {
            Self::LinkCentre(link, axis) => {
                let body = &mut arm.chain.joints.get_mut(link)?.body;
                Some(&mut body.centre_of_mass[axis])
            }
            Self::LoadMass => Some(&mut arm.load.mass),
            Self::LoadMoment(axis) => Some(&mut arm.load.moment[axis]),
            Self::PayloadMass => Some(&mut arm.payload.mass),
            Self::PayloadMoment(axis) => Some(&mut arm.payload.moment[axis]),
            Self::Tilt(axis) => Some(&mut arm.tilt[axis]),
            Self::Zero(k) => wrench.map(|w| &mut w.zero[k]),
            Self::Drift(k) => wrench.map(|w| &mut w.drift[k]),
            Self::WrenchGain(k) => wrench.map(|w| &mut w.gain[k]),
            Self::Crosstalk(source, target) => wrench.map(|w| crosstalk(w, source, target)),
            Self::SensorRotation => wrench.map(|w| &mut w.rotation),
            Self::ToolMass => wrench.map(|w| &mut w.tool_mass),
            Self::ToolCentre(axis) => wrench.map(|w| &mut w.tool_centre[axis]),
            Self::OutsidePoint(axis) => Some(&mut arm.outside_error.point[axis]),
            Self::OutsideDrag => Some(&mut arm.outside_error.drag),
            Self::Delay => Some(&mut arm.delay),
            Self::LawAmplitude(law, which) => {
                arm.laws.get_mut(law).map(|l| &mut l.amplitude[which])
            }
            Self::LawPlace(law) => arm.laws.get_mut(law).map(|l| &mut l.place),
            Self::LawWidth(law) => arm.laws.get_mut(law).map(|l| &mut l.width),
            _ => None,
        }
    }

    /// The joint and the field of its drive, of what stands there.
    fn of_drive(self) -> Option<(usize, DriveField)> {
        Some(match self {
            Self::InverseGain(j) => (j, |d| &mut d.inverse_gain),
            Self::MotorInertia(j) => (j, |d| &mut d.motor_inertia),
            Self::Coulomb(j) => (j, |d| &mut d.coulomb),
            Self::Viscous(j) => (j, |d| &mut d.viscous),
            Self::BristleLength(j) => (j, |d| &mut d.bristle_length),
            Self::StaticExcess(j) => (j, |d| &mut d.static_excess),
            Self::StribeckVelocity(j) => (j, |d| &mut d.stribeck_velocity),
            Self::LoadFriction(j) => (j, |d| &mut d.load_friction),
            Self::WarmFraction(j) => (j, |d| &mut d.warm_fraction),
            Self::WarmTime(j) => (j, |d| &mut d.warm_time),
            Self::Offset(j) => (j, |d| &mut d.offset),
            Self::Ripple(j, 0) => (j, |d| &mut d.ripple[0]),
            Self::Ripple(j, _) => (j, |d| &mut d.ripple[1]),
            Self::RippleCycles(j) => (j, |d| &mut d.ripple_cycles),
            Self::SpringStiffness(j) => (j, |d| &mut d.spring_stiffness),
            Self::EncoderOffset(j) => (j, |d| &mut d.encoder_offset),
            Self::Compliance(j) => (j, |d| &mut d.compliance),
            _ => return None,
        })
    }

    /// Its value.
    #[must_use]
    pub fn value(self, arm: &ArmParameters) -> f64 {
        if let Self::LinkMass(link) = self {
            return arm.chain.joints.get(link).map_or(0.0, |j| j.body.mass);
        }
        // Most are of a drive, which is copied sooner than the whole arm.
        if let Some((joint, field)) = self.of_drive() {
            let drive = arm.drives.get(joint).copied();
            return drive.map_or(0.0, |mut drive| *field(&mut drive));
        }
        if let Self::LinkInertia(link, element) = self {
            let (_, row, column) = INERTIA_ELEMENTS[element];
            let joint = arm.chain.joints.get(link);
            return joint.map_or(0.0, |j| j.body.inertia.col(column)[row]);
        }
        let mut copy = arm.clone();
        self.slot(&mut copy).map_or(0.0, |slot| *slot)
    }

    /// Changes it.
    pub fn set(self, arm: &mut ArmParameters, value: f64) {
        if let Self::LinkMass(link) = self {
            if let Some(joint) = arm.chain.joints.get_mut(link) {
                set_mass(&mut joint.body, value);
            }
            return;
        }
        if let Self::LinkInertia(link, element) = self {
            let (_, row, column) = INERTIA_ELEMENTS[element];
            if let Some(joint) = arm.chain.joints.get_mut(link) {
                joint.body.inertia.col_mut(column)[row] = value;
                joint.body.inertia.col_mut(row)[column] = value;
            }
            return;
        }
        if let Some(slot) = self.slot(arm) {
            *slot = value;
        }
    }

    /// A change that is small beside what it usually is.
    #[must_use]
    pub fn step(self, value: f64) -> f64 {
        // What something is divided by keeps clear of nothing.
        let divisor = match self {
            Self::BristleLength(_) => Some(1e-6),
            Self::StribeckVelocity(_) | Self::LawWidth(_) => Some(1e-3),
            Self::WarmTime(_) => Some(1e-2),
            _ => None,
        };
        if let Some(usual) = divisor {
            return f64::min(usual, 0.25 * value.abs()).max(f64::MIN_POSITIVE);
        }
        let usual = match self {
            Self::LinkMass(_) | Self::PayloadMass | Self::LoadMass | Self::ToolMass => 1e-2,
            Self::LinkCentre(..)
            | Self::ToolCentre(_)
            | Self::PayloadMoment(_)
            | Self::LoadMoment(_)
            | Self::OutsidePoint(_)
            | Self::LinkInertia(..) => 1e-3,
            Self::InverseGain(_)
            | Self::WrenchGain(_)
            | Self::Crosstalk(..)
            | Self::LoadFriction(_)
            | Self::WarmFraction(_) => 1e-3,
            Self::Tilt(_) | Self::SensorRotation | Self::EncoderOffset(_) => 1e-4,
            Self::Compliance(_) => 1e-7,
            Self::Delay => 1e-3,
            Self::RippleCycles(_) | Self::LawPlace(_) => 1e-3,
            Self::PushStart(_) | Self::PushEnd(_) => 1e-2,
            _ => 1e-2,
        };
        f64::max(usual, 1e-4 * value.abs())
    }

    /// Whether readings do not depend linearly on it.
    #[must_use]
    pub fn is_curved(self) -> bool {
        matches!(
            self,
            Self::BristleLength(_)
                | Self::StaticExcess(_)
                | Self::StribeckVelocity(_)
                | Self::WarmFraction(_)
                | Self::WarmTime(_)
                | Self::Ripple(..)
                | Self::RippleCycles(_)
                | Self::Compliance(_)
                | Self::EncoderOffset(_)
                | Self::PayloadMass
                | Self::PayloadMoment(_)
                | Self::Tilt(_)
                | Self::SensorRotation
                | Self::ToolMass
                | Self::ToolCentre(_)
                | Self::Delay
                | Self::PushForce(..)
                | Self::PushStart(_)
                | Self::PushEnd(_)
                | Self::PushEdge(_)
                | Self::LawAmplitude(..)
                | Self::LawPlace(_)
                | Self::LawWidth(_)
        )
    }
}

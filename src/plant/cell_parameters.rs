//! Properties of a cell's arm and part: springs in the joints, encoders that are off, a servo that lags, a part off its nominal pose.

use super::sharp_edge::EdgeStation;
use crate::physics::joint_spring::JointSpring;
use glam::DVec3;

/// Most joints that an arm may have.
pub const MOST_JOINTS: usize = 8;

/// Damping over stiffness of a joint's spring of which nothing else is said [s].
pub(super) const DAMPING_TIME: f64 = 2.5e-3;

/// Arm and part of a cell, beside its device; [`CellParameters::RIGID`] where there is none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellParameters {
    /// Bandwidth of the joints' servos, critically damped [Hz].
    pub servo_bandwidth: f64,
    /// Stiffness of the spring between the motor and the link of each joint [N m/rad].
    pub joint_stiffness: [f64; MOST_JOINTS],
    /// Play between the motor and the link of each joint, from flank to flank [rad].
    pub joint_play: [f64; MOST_JOINTS],
    /// Dry friction of each joint, which its drive overcomes: seen in its torque, not in what the device feels [N m].
    pub joint_friction: [f64; MOST_JOINTS],
    /// Damping over stiffness of each joint, a time [s].
    pub joint_damping: [f64; MOST_JOINTS],
    /// Offset of each joint's encoder from the truth [rad].
    pub encoder_offset: [f64; MOST_JOINTS],
    /// Friction of the tool along the edge [1].
    pub friction: f64,
    /// Stroke at which a recording starts [m].
    pub start_stroke: f64,
    /// Distance by which the part stands out along the bisector at the middle of its edge [m].
    pub part_shift: f64,
    /// Slope of that along the edge [m/m].
    pub part_tilt: f64,
    /// A burr on the edge.
    pub burr: Burr,
}

/// Offset of a part's surface under the ball from its mesh.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Relief {
    /// Displacement of the part from where it should be [m].
    pub aside: DVec3,
    /// Distance by which the surface stands out along its normal [m].
    pub height: f64,
    /// Gradient of that along the part [m/m].
    pub gradient: DVec3,
    /// Rate at which it grows where it is, as a tool that cuts lowers it [m/s].
    pub rate: f64,
}

/// A smooth bump on an edge: h exp(-((s - p)/w)^2 / 2).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Burr {
    /// Its height along the bisector [m].
    pub height: f64,
    /// Its middle, from the start of the edge [m].
    pub position: f64,
    /// Its standard width [m].
    pub width: f64,
}

impl Burr {
    /// No burr.
    pub const NONE: Self = Self {
        height: 0.0,
        position: 0.0,
        width: 2e-3,
    };

    /// Height [m] at a distance from the start of the edge [m].
    pub fn at(&self, station: f64) -> f64 {
        if self.height == 0.0 {
            return 0.0;
        }
        let away = (station - self.position) / self.width;
        self.height * (-0.5 * away * away).exp()
    }

    /// Derivative of that [m/m].
    pub fn slope(&self, station: f64) -> f64 {
        -(station - self.position) / (self.width * self.width) * self.at(station)
    }
}

impl CellParameters {
    /// The spring between the motor and the link of a joint; none where they are one.
    pub fn transmission(&self, joint: usize) -> Option<JointSpring> {
        let stiffness = self.joint_stiffness[joint];
        stiffness.is_finite().then(|| JointSpring {
            stiffness,
            damping_time: self.joint_damping[joint],
            play: self.joint_play[joint],
        })
    }

    /// Displacement of the part from where it should be at one of its points [m], `middle` being the middle of its edge.
    pub fn aside(&self, middle: &EdgeStation, point: DVec3) -> DVec3 {
        let turn = middle.tangent.cross(middle.bisector) * self.part_tilt;
        middle.bisector * self.part_shift + turn.cross(point - middle.point)
    }

    /// Displacement of the part at a station of its edge.
    pub fn relief(&self, middle: &EdgeStation, station: &EdgeStation) -> Relief {
        Relief {
            aside: self.aside(middle, station.point),
            height: self.burr.at(station.station),
            gradient: station.tangent * self.burr.slope(station.station),
            rate: 0.0,
        }
    }

    /// Nothing gives, nothing is off.
    pub const RIGID: Self = Self {
        servo_bandwidth: f64::INFINITY,
        joint_stiffness: [f64::INFINITY; MOST_JOINTS],
        joint_play: [0.0; MOST_JOINTS],
        joint_friction: [0.0; MOST_JOINTS],
        joint_damping: [DAMPING_TIME; MOST_JOINTS],
        encoder_offset: [0.0; MOST_JOINTS],
        friction: 0.0,
        start_stroke: 0.0,
        part_shift: 0.0,
        part_tilt: 0.0,
        burr: Burr::NONE,
    };
}

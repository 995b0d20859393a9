//! A law at a joint that has no name: torque by a shape over what moves it.
//!
//! ```text
//! t = sum of a_k s_k(x)           in addition at the joint, times bristles z where it is friction
//! ```

use super::moment::JointMoment;

/// What a law depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variable {
    /// Joint angle [rad].
    Angle,
    /// Speed [rad/s].
    Speed,
    /// Acceleration [rad/s2].
    Acceleration,
    /// Torque that the gear carries [N m].
    Load,
    /// Time in the recording [s].
    Time,
}

impl Variable {
    /// Name in the vocabulary.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Angle => "joint_angle",
            Self::Speed => "speed",
            Self::Acceleration => "acceleration",
            Self::Load => "load_torque",
            Self::Time => "time",
        }
    }

    /// All.
    pub const ALL: [Self; 5] = [
        Self::Angle,
        Self::Speed,
        Self::Acceleration,
        Self::Load,
        Self::Time,
    ];

    /// Its value.
    #[must_use]
    pub fn of(self, moment: &JointMoment) -> f64 {
        match self {
            Self::Angle => moment.position,
            Self::Speed => moment.speed,
            Self::Acceleration => moment.acceleration,
            Self::Load => moment.carried,
            Self::Time => moment.time,
        }
    }
}

/// Form over the variable x, with its place p and width w.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// max(0, (x - p)): nothing up to a place, then a slope.
    SlopeAbove,
    /// max(0, (p - x)).
    SlopeBelow,
    /// exp(-((x - p)/w)^2/2).
    Bump,
    /// sin(x p) and cos(x p) with a factor each.
    Sine,
    /// x.
    Linear,
    /// x |x|.
    Square,
    /// x^3.
    Cube,
    /// tanh(x/w).
    Saturation,
    /// 1 - exp(-x/w), of a time.
    Approach,
    /// 1 from a place on.
    Step,
    /// 1.
    Constant,
}

/// What the form is multiplied with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Factor {
    /// Nothing: a torque.
    One,
    /// Bristles: friction.
    Friction,
    /// Speed: a damper.
    Speed,
    /// The torque that the gear carries: a share of it.
    Load,
}

/// A law at a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointLaw {
    /// The joint.
    pub joint: usize,
    /// Its form.
    pub shape: Shape,
    /// What it is over.
    pub variable: Variable,
    /// What it is multiplied with.
    pub factor: Factor,
    /// Factors of the form [N m per unit of form and factor]; the second of a sine's cosine.
    pub amplitude: [f64; 2],
    /// Place, or cycles a turn of a sine [unit of the variable].
    pub place: f64,
    /// Width [unit of the variable].
    pub width: f64,
}

impl JointLaw {
    /// Its torque at a moment [N m].
    #[must_use]
    pub fn torque(&self, moment: &JointMoment) -> f64 {
        let x = self.variable.of(moment);
        let (p, w) = (self.place, self.width);
        let [a, b] = self.amplitude;
        let shape = match self.shape {
            Shape::SlopeAbove => a * (x - p).max(0.0),
            Shape::SlopeBelow => a * (p - x).max(0.0),
            Shape::Bump => a * (-0.5 * ((x - p) / w).powi(2)).exp(),
            Shape::Sine => {
                let (sine, cosine) = (p * x).sin_cos();
                a * sine + b * cosine
            }
            Shape::Linear => a * x,
            Shape::Square => a * x * x.abs(),
            Shape::Cube => a * x.powi(3),
            Shape::Saturation => a * (x / w).tanh(),
            Shape::Approach => a * (1.0 - (-x / w).exp()),
            Shape::Step => {
                if x >= p {
                    a
                } else {
                    0.0
                }
            }
            Shape::Constant => a,
        };
        shape
            * match self.factor {
                Factor::One => 1.0,
                Factor::Friction => moment.bristles,
                Factor::Speed => moment.speed,
                Factor::Load => moment.carried,
            }
    }

    /// Variables on which it depends, by their names.
    #[must_use]
    pub fn depends_on(&self) -> Vec<&'static str> {
        let own = (self.shape != Shape::Constant).then(|| self.variable.name());
        let by = match self.factor {
            Factor::One => None,
            Factor::Friction => Some("speed_sign"),
            Factor::Speed => Some("speed"),
            Factor::Load => Some("load_torque"),
        };
        let mut all: Vec<&'static str> = own.into_iter().chain(by).collect();
        all.dedup();
        all
    }
}

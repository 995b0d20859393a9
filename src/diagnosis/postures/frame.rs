//! Axes in which a wrench sensor's readings may be given, against those that are declared.

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};

/// Axes that readings are given in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axes {
    /// The sensor's own.
    Sensor,
    /// The base's: something has turned them by the pose already.
    Base,
}

/// Turn of those axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Turn {
    /// None.
    None,
    /// By quarter turns, 1 to 3, about x, y or z (0, 1, 2).
    Quarters(usize, u8),
    /// By any angle about z.
    AboutZ,
    /// Any.
    Free,
}

/// What readings are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame {
    /// Their axes.
    pub axes: Axes,
    /// How these are turned against what is declared.
    pub turn: Turn,
    /// Whether the pose is the inverse of what it says: the base in the sensor's axes.
    pub inverse: bool,
    /// Whether they are what the sensor does to the tool.
    pub opposite: bool,
}

/// Probability before any reading that readings are in the base's axes where the sensor's are declared, or the other way round [1].
const OTHER_AXES: f64 = 0.1;
/// That the pose is the inverse of the declared one.
const INVERSE: f64 = 0.05;
/// That readings have the opposite of the declared sign.
const OPPOSITE: f64 = 0.1;
/// That axes are turned by quarters about z, about x or y, by any angle about z, anyhow.
const TURNED: [f64; 4] = [0.06, 0.03, 0.06, 0.02];

impl Frame {
    /// The sensor's own axes, by the pose as it is logged.
    pub const PLAIN: Self = Self {
        axes: Axes::Sensor,
        turn: Turn::None,
        inverse: false,
        opposite: false,
    };

    /// All that are tried; the sign comes out of the fit.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let mut turns = vec![Turn::None, Turn::AboutZ, Turn::Free];
        turns.extend((0..3).flat_map(|axis| (1..4).map(move |count| Turn::Quarters(axis, count))));
        let mut frames = Vec::new();
        for axes in [Axes::Sensor, Axes::Base] {
            for inverse in [false, true] {
                frames.extend(turns.iter().map(|turn| Self {
                    axes,
                    turn: *turn,
                    inverse,
                    opposite: false,
                }));
            }
        }
        frames
    }

    /// Natural logarithm of its probability before any reading, where another is declared [1].
    #[must_use]
    pub fn prior(&self, declared: &Self) -> f64 {
        let odds = |is: bool, share: f64| if is { share } else { 1.0 - share };
        let turn = match self.turn {
            Turn::None => 1.0 - TURNED.iter().sum::<f64>(),
            Turn::Quarters(2, _) => TURNED[0] / 3.0,
            Turn::Quarters(..) => TURNED[1] / 6.0,
            Turn::AboutZ => TURNED[2],
            Turn::Free => TURNED[3],
        };
        let axes = odds(self.axes != declared.axes, OTHER_AXES);
        let inverse = odds(self.inverse != declared.inverse, INVERSE);
        (axes * inverse * odds(self.opposite != declared.opposite, OPPOSITE) * turn).ln()
    }

    /// Whether the sensor's axes are turned about z, and nothing else is other than declared.
    #[must_use]
    pub fn is_turned_about_z(&self, declared: &Self) -> bool {
        matches!(self.turn, Turn::AboutZ | Turn::Quarters(2, _))
            && self.axes == Axes::Sensor
            && *self
                == Self {
                    turn: self.turn,
                    ..*declared
                }
    }

    /// In words, behind "the readings are".
    #[must_use]
    pub fn words(&self) -> String {
        let mut text = match self.axes {
            Axes::Sensor => "in the sensor's axes",
            Axes::Base => "in the base's axes (something has turned them by the pose already)",
        }
        .to_owned();
        match self.turn {
            Turn::None => {}
            Turn::Quarters(axis, count) => {
                let axis = ["x", "y", "z"][axis];
                text += &format!(", turned by {} degrees about {axis}", 90 * u32::from(count));
            }
            Turn::AboutZ => text += ", turned about z",
            Turn::Free => text += ", turned",
        }
        if self.inverse {
            text += ", the pose being that of the base in the sensor's axes";
        }
        if self.opposite {
            text += ", with the sign of what the sensor does to the tool";
        }
        text
    }

    /// The reading of a force by zero, weight and pose, in symbols.
    #[must_use]
    pub fn formula(&self) -> String {
        let (own, other) = match self.inverse {
            false => ("P", "P'"),
            true => ("P'", "P"),
        };
        let sign = if self.opposite { "-" } else { "+" };
        let turn = match self.turn {
            Turn::None => "",
            _ => "C ",
        };
        match self.axes {
            Axes::Sensor => format!("{turn}(zero {sign} {other} weight)"),
            Axes::Base => format!("{turn}{own} (zero {sign} {other} weight)"),
        }
    }
}

impl Turn {
    /// Numbers that it has.
    #[must_use]
    pub fn count(self) -> usize {
        match self {
            Self::None | Self::Quarters(..) => 0,
            Self::AboutZ => 1,
            Self::Free => 3,
        }
    }

    /// Turns to begin a fit with: readings in turned axes are these times what they are in those that are not.
    #[must_use]
    pub fn starts(self) -> Vec<Matrix3<f64>> {
        let about = |axis: usize, count: u8| {
            let axis = Unit::new_unchecked(Vector3::ith(axis, 1.0));
            let angle = -std::f64::consts::FRAC_PI_2 * f64::from(count);
            Rotation3::from_axis_angle(&axis, angle).into_inner()
        };
        match self {
            Self::None => vec![Matrix3::identity()],
            Self::Quarters(axis, count) => vec![about(axis, count)],
            Self::AboutZ => (0..4).map(|count| about(2, count)).collect(),
            // The 24 turns of a cube: each of six axes to where z was, then about it.
            Self::Free => {
                let tops = [(0, 0), (0, 1), (0, 2), (0, 3), (1, 1), (1, 3)];
                let of_top =
                    |(axis, count)| (0..4).map(move |turn| about(2, turn) * about(axis, count));
                tops.into_iter().flat_map(of_top).collect()
            }
        }
    }
}

/// Roll, pitch and yaw of axes in which readings are these times what they were.
#[must_use]
pub fn axes_angles(turn: Matrix3<f64>) -> [f64; 3] {
    let axes = Rotation3::from_matrix_unchecked(turn.transpose());
    let (roll, pitch, yaw) = axes.euler_angles();
    [roll, pitch, yaw]
}

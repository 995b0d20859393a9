//! A term that a rig's model lacks and that has no name: a force, a pressure, a flow, a displacement or an error of a reading, as a function of one
//! variable.
//!
//! ```text
//! y = s(v) sum c_k phi_k(x),   phi_k hats between evenly spaced knots, or sines and cosines of a frequency and its double
//! s(v) = 1, or tanh(v/v_0), v_0 = 2 mm/s, for what acts against the motion
//! ```
//!
//! x variable, v speed of extension [m/s], c coefficients in the port's unit.

use std::f64::consts::TAU;

/// Coefficients at most.
pub const MOST_COEFFICIENTS: usize = 24;
/// Speed at which what acts against the motion is fully there [m/s].
const SOFT: f64 = 2e-3;

/// Where a latent term enters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Port {
    /// A force on the piston along extension [N].
    PistonForce,
    /// A pressure added to the regulator's outlet [Pa].
    OutletPressure,
    /// Air into chamber 1 [kg/s].
    FirstChamberFlow,
    /// Air into chamber 2 [kg/s].
    SecondChamberFlow,
    /// A displacement of the surface along extension [m].
    Surface,
    /// Added to the load cell's reading [N].
    ForceReading,
    /// Added to the position sensor's reading [m].
    StrokeReading,
    /// Added to the pressure sensor's reading [Pa].
    PressureReading,
}

impl Port {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::PistonForce,
        Self::OutletPressure,
        Self::FirstChamberFlow,
        Self::SecondChamberFlow,
        Self::Surface,
        Self::ForceReading,
        Self::StrokeReading,
        Self::PressureReading,
    ];

    /// Whether it changes what a sensor says, and nothing else.
    pub fn is_reading(self) -> bool {
        matches!(
            self,
            Self::ForceReading | Self::StrokeReading | Self::PressureReading
        )
    }

    /// Name in files and answers.
    pub fn name(self) -> &'static str {
        match self {
            Self::PistonForce => "piston_force",
            Self::OutletPressure => "outlet_pressure",
            Self::FirstChamberFlow => "first_chamber_flow",
            Self::SecondChamberFlow => "second_chamber_flow",
            Self::Surface => "surface",
            Self::ForceReading => "force_reading",
            Self::StrokeReading => "stroke_reading",
            Self::PressureReading => "pressure_reading",
        }
    }

    /// Its unit as a key ends with it.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::PistonForce | Self::ForceReading => "n",
            Self::OutletPressure | Self::PressureReading => "pa",
            Self::FirstChamberFlow | Self::SecondChamberFlow => "kg_per_s",
            Self::Surface | Self::StrokeReading => "m",
        }
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::PistonForce | Self::ForceReading => "N",
            Self::OutletPressure | Self::PressureReading => "Pa",
            Self::FirstChamberFlow | Self::SecondChamberFlow => "kg/s",
            Self::Surface | Self::StrokeReading => "m",
        }
    }

    /// Part of the chain that it belongs to, as in an answer.
    pub fn subsystem(self) -> &'static str {
        match self {
            Self::PistonForce => "force_balance",
            Self::OutletPressure => "regulator",
            Self::FirstChamberFlow | Self::SecondChamberFlow => "chambers",
            Self::Surface => "contact",
            Self::ForceReading | Self::StrokeReading | Self::PressureReading => "sensors",
        }
    }
}

/// On what a latent term depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Variable {
    /// Time since the start of the recording [s].
    Time,
    /// Stroke [m].
    Stroke,
    /// Speed of extension [m/s].
    Velocity,
    /// Pressure in chamber 1 [Pa absolute].
    ChamberPressure,
    /// Pressure in chamber 1 less that in chamber 2 [Pa].
    PressureDifference,
    /// Air that comes in [kg/s].
    MassFlow,
    /// Set pressure [Pa gauge].
    SetPressure,
    /// Where the surface stands [m].
    Surface,
    /// Contact force [N].
    ContactForce,
}

impl Variable {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Time,
        Self::Stroke,
        Self::Velocity,
        Self::ChamberPressure,
        Self::PressureDifference,
        Self::MassFlow,
        Self::SetPressure,
        Self::Surface,
        Self::ContactForce,
    ];

    /// Its unit as a key ends with it.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::Stroke | Self::Surface => "m",
            Self::Velocity => "m_per_s",
            Self::ChamberPressure | Self::PressureDifference | Self::SetPressure => "pa",
            Self::MassFlow => "kg_per_s",
            Self::ContactForce => "n",
        }
    }

    /// Name in an answer.
    pub fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Stroke => "stroke_m",
            Self::Velocity => "velocity",
            Self::ChamberPressure => "chamber_pressure",
            Self::PressureDifference => "pressure_difference",
            Self::MassFlow => "mass_flow",
            Self::SetPressure => "set_pressure",
            Self::Surface => "surface_m",
            Self::ContactForce => "contact_force",
        }
    }
}

/// Functions whose sum a latent term is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Basis {
    /// Hats between evenly spaced knots from one value to another; constant beyond.
    Hats {
        /// First and last knot.
        ends: [f64; 2],
    },
    /// Sine and cosine of a frequency and of its double.
    Waves {
        /// Cycles over one unit of the variable.
        frequency: f64,
    },
}

/// A latent term.
#[derive(Debug, Clone, PartialEq)]
pub struct Latent {
    /// Where it enters.
    pub port: Port,
    /// On what it depends.
    pub variable: Variable,
    /// Whether it acts with the direction of motion.
    pub directed: bool,
    /// Functions.
    pub basis: Basis,
    /// Their coefficients in the port's unit.
    pub coefficients: Vec<f64>,
}

/// The variables of one moment.
#[derive(Debug, Clone, Copy, Default)]
pub struct Moment {
    /// Time since the start of the recording [s].
    pub time: f64,
    /// Stroke [m].
    pub stroke: f64,
    /// Speed of extension [m/s].
    pub speed: f64,
    /// Pressures in the chambers [Pa absolute].
    pub pressures: [f64; 2],
    /// Air that comes in [kg/s].
    pub mass_flow: f64,
    /// Set pressure [Pa gauge].
    pub set_pressure: f64,
    /// Where the surface stands [m]; NaN where there is none.
    pub surface: f64,
    /// Contact force [N].
    pub contact_force: f64,
}

impl Moment {
    /// The same a time [s] later, as far as its motion tells.
    #[must_use]
    pub fn ahead(&self, time: f64) -> Self {
        Self {
            time: self.time + time,
            stroke: self.stroke + time * self.speed,
            ..*self
        }
    }

    /// One of them.
    pub fn of(&self, variable: Variable) -> f64 {
        match variable {
            Variable::Time => self.time,
            Variable::Stroke => self.stroke,
            Variable::Velocity => self.speed,
            Variable::ChamberPressure => self.pressures[0],
            Variable::PressureDifference => self.pressures[0] - self.pressures[1],
            Variable::MassFlow => self.mass_flow,
            Variable::SetPressure => self.set_pressure,
            Variable::Surface => self.surface,
            Variable::ContactForce => self.contact_force,
        }
    }
}

impl Latent {
    /// Count of the numbers that it has: its coefficients and, of waves, their frequency.
    pub fn numbers(&self) -> usize {
        self.coefficients.len() + usize::from(matches!(self.basis, Basis::Waves { .. }))
    }

    /// Its value at a value of its variable and a speed of extension [m/s].
    pub fn value(&self, at: f64, speed: f64) -> f64 {
        if !at.is_finite() {
            return 0.0;
        }
        let shape = self.shape(at);
        if self.directed {
            shape * (speed / SOFT).tanh()
        } else {
            shape
        }
    }

    /// Its value at a moment.
    pub fn at(&self, moment: &Moment) -> f64 {
        self.value(moment.of(self.variable), moment.speed)
    }

    /// Its value without the direction of motion.
    pub fn shape(&self, at: f64) -> f64 {
        let c = &self.coefficients;
        match self.basis {
            Basis::Hats { ends } => {
                let last = c.len() - 1;
                let place = (at - ends[0]) / (ends[1] - ends[0]) * last as f64;
                let place = place.clamp(0.0, last as f64);
                let left = (place as usize).min(last.saturating_sub(1));
                let share = place - left as f64;
                let right = c.get(left + 1).copied().unwrap_or(0.0);
                c[left] * (1.0 - share) + right * share
            }
            Basis::Waves { frequency } => {
                let terms = c.chunks_exact(2).enumerate();
                terms
                    .map(|(k, pair)| {
                        let (sine, cosine) = (TAU * frequency * (k + 1) as f64 * at).sin_cos();
                        pair[0] * sine + pair[1] * cosine
                    })
                    .sum()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(basis: Basis, coefficients: &[f64]) -> Latent {
        Latent {
            port: Port::PistonForce,
            variable: Variable::Stroke,
            directed: false,
            basis,
            coefficients: coefficients.to_vec(),
        }
    }

    #[test]
    fn hats_are_linear_between_knots_and_constant_beyond() {
        let latent = with(Basis::Hats { ends: [1.0, 3.0] }, &[2.0, 4.0, -2.0]);
        for (at, expected) in [(0.0, 2.0), (1.5, 3.0), (2.0, 4.0), (2.5, 1.0), (9.0, -2.0)] {
            assert!((latent.shape(at) - expected).abs() < 1e-12);
        }
        assert_eq!(latent.value(f64::NAN, 1.0), 0.0);
    }

    #[test]
    fn what_is_directed_turns_with_the_motion() {
        let mut latent = with(Basis::Waves { frequency: 2.0 }, &[1.0, 0.0, 0.0, 0.5]);
        let plain = (TAU * 2.0 * 0.1).sin() + 0.5 * (TAU * 4.0 * 0.1).cos();
        assert!((latent.value(0.1, -1.0) - plain).abs() < 1e-12);
        latent.directed = true;
        assert!((latent.value(0.1, -1.0) + plain).abs() < 1e-12);
        assert_eq!(latent.value(0.1, 0.0), 0.0);
    }
}

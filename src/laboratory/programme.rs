//! Programme of a recording: set pressures, valve and surface over time.

use std::f64::consts::TAU;

/// One sine of a surface's motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    /// Zero to peak [m].
    pub amplitude: f64,
    /// Frequency [Hz].
    pub frequency: f64,
    /// Phase at t = 0 [rad].
    pub phase: f64,
}

/// Where the surface stands along the stroke.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Its middle [m].
    pub middle: f64,
    /// Its motion about it.
    pub waves: Vec<Wave>,
}

impl Surface {
    /// Position [m] and speed [m/s] at a time [s].
    pub fn at(&self, time: f64) -> [f64; 2] {
        self.waves.iter().fold([self.middle, 0.0], |sum, wave| {
            let rate = TAU * wave.frequency;
            let (sine, cosine) = (rate * time + wave.phase).sin_cos();
            [
                sum[0] + wave.amplitude * sine,
                sum[1] + wave.amplitude * rate * cosine,
            ]
        })
    }
}

/// A recording's programme. Commands hold from their time on; before the first one the set pressure is 0 and the valve extends.
#[derive(Debug, Clone, PartialEq)]
pub struct Programme {
    /// Name of the recording, without `.csv`.
    pub name: String,
    /// Set pressures: time [s], pressure [Pa gauge].
    pub set_pressures: Vec<(f64, f64)>,
    /// Valve: time [s], extends.
    pub valve: Vec<(f64, bool)>,
    /// The surface, where there is a workpiece.
    pub surface: Option<Surface>,
    /// Sample times [s].
    pub times: Vec<f64>,
}

impl Programme {
    /// Set pressure commanded at a time [Pa gauge].
    pub fn set_pressure(&self, time: f64) -> f64 {
        held(&self.set_pressures, time).unwrap_or(0.0)
    }

    /// Whether the valve is commanded to extend at a time.
    pub fn extends(&self, time: f64) -> bool {
        held(&self.valve, time).unwrap_or(true)
    }
}

fn held<T: Copy>(commands: &[(f64, T)], time: f64) -> Option<T> {
    let due = commands.iter().rev().find(|(at, _)| *at <= time + 1e-9);
    due.map(|(_, value)| *value)
}

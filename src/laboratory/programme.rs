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
pub enum Surface {
    /// A middle [m], and a motion about it.
    Waves(f64, Vec<Wave>),
    /// As it was asked for, sample by sample.
    Sampled(Sampled),
}

/// A motion by its samples: cubics between them, with the slopes of the parabolas through three (Catmull and Rom).
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    /// Times [s], increasing; two at least.
    pub times: Vec<f64>,
    /// Places [m].
    pub places: Vec<f64>,
}

impl Sampled {
    /// Slope at a sample [m/s].
    fn slope(&self, index: usize) -> f64 {
        let last = self.times.len() - 1;
        let (before, after) = (index.saturating_sub(1), (index + 1).min(last));
        (self.places[after] - self.places[before]) / (self.times[after] - self.times[before])
    }

    fn at(&self, time: f64) -> [f64; 2] {
        let last = self.times.len() - 1;
        if time <= self.times[0] || time >= self.times[last] {
            let end = if time <= self.times[0] { 0 } else { last };
            return [self.places[end], 0.0];
        }
        let after = self.times.partition_point(|t| *t <= time).min(last);
        let (from, to) = (after - 1, after);
        let step = self.times[to] - self.times[from];
        let x = (time - self.times[from]) / step;
        let [a, b] = [self.places[from], self.places[to]];
        let [p, q] = [step * self.slope(from), step * self.slope(to)];
        let (second, third) = (3.0 * (b - a) - 2.0 * p - q, 2.0 * (a - b) + p + q);
        [
            a + x * (p + x * (second + x * third)),
            (p + x * (2.0 * second + 3.0 * x * third)) / step,
        ]
    }
}

impl Surface {
    /// Position [m] and speed [m/s] at a time [s].
    pub fn at(&self, time: f64) -> [f64; 2] {
        let (middle, waves) = match self {
            Self::Sampled(sampled) => return sampled.at(time),
            Self::Waves(middle, waves) => (*middle, waves),
        };
        waves.iter().fold([middle, 0.0], |sum, wave| {
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

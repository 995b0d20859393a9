//! Paths of joints as finite Fourier series, by which an arm is moved to tell its numbers apart.
//!
//! ```text
//! q'(t) = sum of a_k cos(2 pi n_k t/T) + b_k sin(2 pi n_k t/T)        of each joint
//! ```
//!
//! T period [s], n_k harmonics, a_k, b_k speeds [rad/s]. Where sum a_k = 0 and sum n_k b_k = 0 a path is at rest at both ends, without acceleration. Source:
//! Swevers et al., IEEE Transactions on Robotics and Automation 13 (1997), 730.

use std::f64::consts::TAU;

use super::motion::Motion;

/// One harmonic of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harmonic {
    /// Periods over the path [1].
    pub number: usize,
    /// Speed along the cosine [rad/s or m/s].
    pub cosine: f64,
    /// Speed along the sine [rad/s or m/s].
    pub sine: f64,
}

/// Path of one joint.
#[derive(Debug, Clone, PartialEq)]
pub struct JointPath {
    /// Mean position [rad or m].
    pub centre: f64,
    /// Harmonics.
    pub harmonics: Vec<Harmonic>,
}

/// A path of all joints.
#[derive(Debug, Clone, PartialEq)]
pub struct FourierPath {
    /// Duration [s].
    pub period: f64,
    /// Joints, base first.
    pub joints: Vec<JointPath>,
}

impl JointPath {
    /// Position, speed and acceleration at a time.
    #[must_use]
    pub fn at(&self, period: f64, time: f64) -> [f64; 3] {
        let mut out = [self.centre, 0.0, 0.0];
        for harmonic in &self.harmonics {
            let rate = TAU * harmonic.number as f64 / period;
            let (sine, cosine) = (rate * time).sin_cos();
            out[0] += (harmonic.cosine * sine - harmonic.sine * cosine) / rate;
            out[1] += harmonic.cosine * cosine + harmonic.sine * sine;
            out[2] += (harmonic.sine * cosine - harmonic.cosine * sine) * rate;
        }
        out
    }

    /// The nearest of its kind that is at rest at both ends.
    pub fn rest_at_ends(&mut self) {
        let count = self.harmonics.len().max(1) as f64;
        let mean = self.harmonics.iter().map(|h| h.cosine).sum::<f64>() / count;
        let number = |h: &Harmonic| h.number as f64;
        let along = self
            .harmonics
            .iter()
            .map(|h| number(h) * h.sine)
            .sum::<f64>();
        let own = self
            .harmonics
            .iter()
            .map(|h| number(h).powi(2))
            .sum::<f64>();
        for harmonic in &mut self.harmonics {
            harmonic.cosine -= mean;
            harmonic.sine -= number(harmonic) * along / own;
        }
    }

    /// Moves as far and as fast as a factor says, about the same centre.
    pub fn scale(&mut self, factor: f64) {
        for harmonic in &mut self.harmonics {
            harmonic.cosine *= factor;
            harmonic.sine *= factor;
        }
    }
}

impl FourierPath {
    /// As a motion at a rate [Hz], which counts as a recording.
    #[must_use]
    pub fn motion(&self, recording: usize, rate: f64) -> Motion {
        let count = (self.period * rate).round() as usize + 1;
        let time: Vec<f64> = (0..count).map(|i| i as f64 / rate).collect();
        let of = |which: usize| -> Vec<Vec<f64>> {
            let joints = self.joints.iter();
            joints
                .map(|joint| {
                    time.iter()
                        .map(|t| joint.at(self.period, *t)[which])
                        .collect()
                })
                .collect()
        };
        Motion {
            recording,
            cut_off: f64::INFINITY,
            position: of(0),
            speed: of(1),
            acceleration: of(2),
            time,
            outside: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path() -> FourierPath {
        let harmonics = [(1, 0.4, -0.3), (4, -0.9, 0.8), (7, 0.3, 0.2)];
        let harmonics = harmonics.map(|(number, cosine, sine)| Harmonic {
            number,
            cosine,
            sine,
        });
        let mut joint = JointPath {
            centre: 0.5,
            harmonics: harmonics.to_vec(),
        };
        joint.rest_at_ends();
        FourierPath {
            period: 10.0,
            joints: vec![joint],
        }
    }

    #[test]
    fn a_path_rests_at_both_ends_where_it_began() {
        let joint = &path().joints[0];
        let [start, end] = [0.0, 10.0].map(|t| joint.at(10.0, t));
        for k in 0..3 {
            assert!((start[k] - end[k]).abs() < 1e-12);
        }
        assert!(start[1].abs() < 1e-12 && start[2].abs() < 1e-12);
    }

    #[test]
    fn speed_and_acceleration_are_what_a_log_of_the_positions_gives() {
        let exact = path().motion(0, 100.0);
        let logged = Motion::of_positions(0, &exact.time, &exact.position, 25.0);
        for i in 50..950 {
            assert!((logged.speed[0][i] - exact.speed[0][i]).abs() < 1e-4);
            assert!((logged.acceleration[0][i] - exact.acceleration[0][i]).abs() < 2e-2);
        }
    }
}

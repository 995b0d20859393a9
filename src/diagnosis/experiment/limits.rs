//! How far an experiment may move a rig, and by what.

use super::ride::ArmReach;
use crate::diagnosis::recordings::evidence::Evidence;
use crate::diagnosis::recordings::recorded::LEAST_SAMPLES;
use crate::plant::{Channel, OperatingLimits};
use crate::stats::median_step;

/// What may be moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Movable {
    /// The set pressure.
    pub set_pressure: bool,
    /// The 5/2 valve.
    pub solenoid: bool,
    /// The surface, or whether there is one at all.
    pub surface: bool,
    /// The arm, along the path of its recordings.
    pub path: bool,
}

impl Movable {
    /// All of it.
    pub const ALL: Self = Self {
        set_pressure: true,
        solenoid: true,
        surface: true,
        path: true,
    };
}

/// Limits of an experiment.
#[derive(Debug, Clone)]
pub struct Limits {
    /// What may be moved.
    pub movable: Movable,
    /// Time between two samples [s].
    pub step: f64,
    /// Least and largest set pressure [Pa gauge].
    pub set_pressure: [f64; 2],
    /// Largest rate of the set pressure [Pa/s].
    pub set_pressure_rate: f64,
    /// Whether the valve may retract.
    pub retracts: bool,
    /// Where a surface may stand [m]; none where there was never one.
    pub surface: Option<[f64; 2]>,
    /// Largest speed [m/s] and acceleration [m/s2] of the surface.
    pub surface_motion: [f64; 2],
    /// Whether the tool may run without a workpiece.
    pub without_workpiece: bool,
    /// Largest stroke [m]; without end where a file states none, for what moves the tool has limits of its own.
    pub stroke: f64,
    /// Largest force on the part [N].
    pub force: f64,
    /// Longest recording [s].
    pub duration: f64,
    /// How far the arm may be moved; none on a bench.
    pub arm: Option<ArmReach>,
}

/// Limits that leave nothing to be done.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LimitError {
    /// Nothing may be moved.
    #[error(
        "nothing may be moved: {what}; expected a set pressure, a valve or a surface that may take another value"
    )]
    NothingMoves {
        /// Why.
        what: String,
    },
    /// Recordings that would be too short to tell anything.
    #[error(
        "recordings of at most {most} s are allowed, expected {least} s at least: a longer `limits.duration_s` or --time"
    )]
    TooShort {
        /// The limit [s].
        most: f64,
        /// What is needed [s].
        least: f64,
    },
    /// Two that exclude each other.
    #[error("`{lower}` is {least} and `{upper}` {most}, expected the first below the second")]
    Contradiction {
        /// Key of the lower one.
        lower: &'static str,
        /// Its value.
        least: f64,
        /// Key of the upper one.
        upper: &'static str,
        /// Its value.
        most: f64,
    },
    /// The force that the device rests with is more than the part may bear.
    #[error(
        "every programme that was tried presses the part with more than `force_n` = {most:.3} N, at least {least:.3} N; expected a larger force or a smaller set pressure in [limits]"
    )]
    Force {
        /// The limit [N].
        most: f64,
        /// The least of the largest forces [N].
        least: f64,
    },
    /// The tool runs out farther than it may.
    #[error(
        "every programme that was tried extends the tool by more than `stroke_m` = {most:.4} m, at least by {least:.4} m; expected a larger stroke, or a surface that stops the tool before it, in [limits]"
    )]
    Stroke {
        /// The limit [m].
        most: f64,
        /// The least of the largest strokes [m].
        least: f64,
    },
    /// Whatever is done, the tool bounces.
    #[error(
        "under every programme that was tried the tool bounces so that nothing can be predicted; expected a slower surface, or a larger set pressure, in [limits]"
    )]
    Unpredictable,
    /// A drive would have to give more than it may.
    #[error(
        "every programme that was tried asks a drive of the arm for more than `joint_torque_n_m`, at least for {percent:.0} % of it; expected larger torques, or a smaller force, joint speed or acceleration, in [limits]"
    )]
    Torque {
        /// The least of the largest shares [%].
        percent: f64,
    },
}

/// Shortest recording [s]: less is nothing that a person would set a rig up for.
const SHORTEST: f64 = 1.0;

impl Limits {
    /// Length that a recording has at least [s].
    #[must_use]
    pub fn shortest(&self) -> f64 {
        SHORTEST.max(2.0 * LEAST_SAMPLES as f64 * self.step)
    }

    /// What a file states, and for the rest what the recordings did.
    ///
    /// # Errors
    /// Limits that contradict one another, or leave nothing to be moved.
    pub fn new(
        evidence: &Evidence,
        stated: &OperatingLimits,
        movable: Movable,
        (duration, arm): (f64, Option<ArmReach>),
    ) -> Result<Self, LimitError> {
        let seen = Seen::of(evidence, arm.is_some());
        let least = stated.surface[0].or(seen.surface.map(|s| s[0]));
        let most = stated.surface[1].or(seen.surface.map(|s| s[1]));
        let surface = least.zip(most).map(|(least, most)| [least, most]);
        if let Some([least, most]) = surface
            && least > most
        {
            return Err(LimitError::Contradiction {
                lower: "limits.surface_least_m",
                least,
                upper: "limits.surface_most_m",
                most,
            });
        }
        if let (Some(least), Some(most)) = (least, stated.stroke)
            && least > most
        {
            return Err(LimitError::Contradiction {
                lower: "limits.surface_least_m",
                least,
                upper: "limits.stroke_m",
                most,
            });
        }
        let limits = Self {
            movable,
            step: seen.step,
            set_pressure: match movable.set_pressure {
                true => [0.0, stated.set_pressure.unwrap_or(seen.set_pressure)],
                false => [seen.usual_pressure; 2],
            },
            set_pressure_rate: stated.set_pressure_rate.unwrap_or(seen.set_pressure_rate),
            retracts: movable.solenoid && stated.solenoid.unwrap_or(seen.retracts),
            surface,
            surface_motion: match movable.surface {
                true => [
                    stated.surface_speed.unwrap_or(seen.surface_motion[0]),
                    (stated.surface_acceleration).unwrap_or(seen.surface_motion[1]),
                ],
                false => [0.0; 2],
            },
            without_workpiece: match surface {
                Some(_) => {
                    movable.surface && stated.without_workpiece.unwrap_or(seen.without_workpiece)
                }
                None => true,
            },
            stroke: stated.stroke.unwrap_or(f64::INFINITY),
            force: stated.force.unwrap_or(seen.force),
            duration: stated.duration.map_or(duration, |most| duration.min(most)),
            arm,
        };
        limits.check()?;
        Ok(limits)
    }

    fn check(&self) -> Result<(), LimitError> {
        let shortest = self.shortest();
        if self.duration < shortest {
            return Err(LimitError::TooShort {
                most: self.duration,
                least: shortest,
            });
        }
        let [least, most] = self.set_pressure;
        let pressure_moves = self.movable.set_pressure && most > least;
        let surface_moves = self.movable.surface && self.surface.is_some_and(|[a, b]| b > a);
        let arm_moves = self.movable.path && self.arm.is_some();
        if pressure_moves || self.retracts || surface_moves || arm_moves {
            return Ok(());
        }
        let mut why = Vec::new();
        if !pressure_moves {
            why.push(match self.movable.set_pressure {
                true => "the set pressure is zero in every recording".to_owned(),
                false => "the set pressure is to be left alone".to_owned(),
            });
        }
        if self.arm.is_some() {
            why.push("the arm is to be left alone".to_owned());
        } else {
            why.push("the valve never retracts, or is to be left alone".to_owned());
            why.push("the surface stands still, or is to be left alone".to_owned());
        }
        Err(LimitError::NothingMoves {
            what: why.join(", "),
        })
    }
}

/// What the recordings did.
struct Seen {
    step: f64,
    set_pressure: f64,
    usual_pressure: f64,
    set_pressure_rate: f64,
    retracts: bool,
    surface: Option<[f64; 2]>,
    surface_motion: [f64; 2],
    without_workpiece: bool,
    force: f64,
}

impl Seen {
    fn of(evidence: &Evidence, is_cell: bool) -> Self {
        let inputs = || evidence.recordings.iter().map(|own| &own.inputs);
        let pressures: Vec<f64> = inputs()
            .flat_map(|i| i.set_pressure.iter().copied())
            .collect();
        let surfaces = inputs().flat_map(|i| i.surface.iter().copied());
        // Of a cell it is where the edge is along the stroke, which nobody sets.
        let surfaces: Vec<f64> = surfaces.filter(|x| x.is_finite() && !is_cell).collect();
        let most = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let rates = |pick: fn(&crate::plant::PlantInputs) -> &Vec<f64>| {
            most(&mut inputs().flat_map(move |i| {
                let pairs = pick(i).windows(2).zip(i.time.windows(2));
                pairs.map(|(v, t)| (v[1] - v[0]).abs() / (t[1] - t[0]))
            }))
        };
        let accelerations = most(&mut inputs().flat_map(|i| {
            let triples = i.surface.windows(3).zip(i.time.windows(3));
            triples.filter_map(|(x, t)| {
                let [before, after] = [1, 2].map(|k: usize| (x[k] - x[k - 1]) / (t[k] - t[k - 1]));
                let found = (after - before).abs() / (0.5 * (t[2] - t[0]));
                found.is_finite().then_some(found)
            })
        }));
        let force = Channel::Force as usize;
        let forces = evidence.recordings.iter().flat_map(|m| &m.readings[force]);
        let steps = inputs().map(|i| median_step(&i.time));
        let range = surfaces
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
                [low.min(*x), high.max(*x)]
            });
        Self {
            step: steps.fold(f64::INFINITY, f64::min),
            set_pressure: most(&mut pressures.iter().copied()),
            usual_pressure: crate::stats::median(pressures.iter().copied()).unwrap_or(0.0),
            set_pressure_rate: rates(|i| &i.set_pressure),
            retracts: inputs().any(|i| i.extends.iter().any(|extends| !extends)),
            surface: (!surfaces.is_empty()).then_some(range),
            surface_motion: [rates(|i| &i.surface), accelerations],
            without_workpiece: evidence.recordings.iter().any(|m| m.free),
            force: most(&mut forces.copied().filter(|f| f.is_finite())),
        }
    }
}

#[cfg(test)]
impl Limits {
    /// Those of a bench on which everything may be moved, for tests.
    pub(super) fn of_tests() -> Self {
        Self {
            movable: Movable::ALL,
            step: 0.004,
            set_pressure: [0.0, 3e5],
            set_pressure_rate: 2e6,
            retracts: true,
            surface: Some([0.012, 0.031]),
            surface_motion: [0.2, 3.0],
            without_workpiece: true,
            stroke: f64::INFINITY,
            force: 1e3,
            duration: 9.0,
            arm: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::test_evidence::evidence;

    /// Two recordings on a surface at 20 mm, the second with pressures of its own, a reversal and a surface that moves.
    fn recorded() -> Evidence {
        let mut evidence = evidence(2);
        let inputs = &mut evidence.recordings[1].inputs;
        let count = inputs.time.len();
        for index in 0..count {
            let phase = 0.1 * index as f64;
            inputs.set_pressure[index] = 1e5 + 400.0 * index as f64;
            inputs.surface[index] = 0.02 + 0.004 * phase.sin();
        }
        inputs.extends[count - 3] = false;
        evidence
    }

    #[test]
    fn what_is_not_stated_is_as_far_as_the_recordings_went() {
        let limits = Limits::new(
            &recorded(),
            &OperatingLimits::default(),
            Movable::ALL,
            (8.0, None),
        );
        let limits = limits.unwrap();
        assert_eq!(limits.set_pressure, [0.0, 2e5]);
        // 400 Pa every 4 ms; 4 mm at 0.1 rad every 4 ms.
        assert!((limits.set_pressure_rate / 1e5 - 1.0).abs() < 1e-6);
        let rate: f64 = 0.1 / 0.004;
        assert!((limits.surface_motion[0] / (0.004 * rate) - 1.0).abs() < 0.01);
        assert!((limits.surface_motion[1] / (0.004 * rate * rate) - 1.0).abs() < 0.01);
        let [least, most] = limits.surface.unwrap();
        assert!((least - 0.016).abs() < 2e-5 && (most - 0.024).abs() < 2e-5);
        assert!(limits.retracts && !limits.without_workpiece);
        assert_eq!(limits.duration, 8.0);
        assert!((limits.step - 0.004).abs() < 1e-12);
        let force = Channel::Force as usize;
        let forces = recorded()
            .recordings
            .into_iter()
            .flat_map(|m| m.readings[force].clone());
        assert_eq!(limits.force, forces.fold(0.0, f64::max));
    }

    #[test]
    fn what_is_stated_holds_and_what_is_to_be_left_alone_is() {
        let stated = OperatingLimits {
            set_pressure: Some(5e4),
            set_pressure_rate: Some(1e4),
            surface: [Some(0.018), None],
            surface_speed: Some(0.01),
            surface_acceleration: Some(0.5),
            solenoid: Some(false),
            without_workpiece: Some(true),
            stroke: Some(0.04),
            force: Some(12.0),
            duration: Some(3.0),
            joint_motion: [None; 2],
            joint_torque: None,
        };
        let limits = Limits::new(&recorded(), &stated, Movable::ALL, (8.0, None)).unwrap();
        assert_eq!(limits.set_pressure, [0.0, 5e4]);
        assert_eq!(limits.set_pressure_rate, 1e4);
        assert_eq!(limits.surface.unwrap()[0], 0.018);
        assert_eq!(limits.surface_motion, [0.01, 0.5]);
        assert!(!limits.retracts && limits.without_workpiece);
        assert_eq!(
            (limits.stroke, limits.force, limits.duration),
            (0.04, 12.0, 3.0)
        );
        let only = |set_pressure, solenoid, surface| Movable {
            set_pressure,
            solenoid,
            surface,
            path: false,
        };
        let valve = Limits::new(
            &recorded(),
            &OperatingLimits::default(),
            only(false, true, false),
            (8.0, None),
        );
        let valve = valve.unwrap();
        assert_eq!(valve.set_pressure[0], valve.set_pressure[1]);
        assert_eq!(valve.surface_motion, [0.0; 2]);
        assert!(!valve.without_workpiece);
        let nothing = Limits::new(&recorded(), &stated, only(false, true, false), (8.0, None));
        let error = nothing.unwrap_err().to_string();
        assert!(error.contains("nothing may be moved"), "{error}");
    }

    #[test]
    fn limits_that_contradict_one_another_are_refused() {
        let stated = OperatingLimits {
            surface: [Some(0.03), None],
            ..OperatingLimits::default()
        };
        let error = Limits::new(&recorded(), &stated, Movable::ALL, (8.0, None)).unwrap_err();
        let error = error.to_string();
        assert!(
            error.contains("surface_least_m") && error.contains("0.03"),
            "{error}"
        );
        let stated = OperatingLimits {
            surface: [Some(0.02), Some(0.03)],
            stroke: Some(0.01),
            ..OperatingLimits::default()
        };
        let error = Limits::new(&recorded(), &stated, Movable::ALL, (8.0, None)).unwrap_err();
        let error = error.to_string();
        assert!(
            error.contains("surface_least_m") && error.contains("stroke_m"),
            "{error}"
        );
    }
}

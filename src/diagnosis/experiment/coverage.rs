//! What of the range within the limits the recordings have been to: a law that acts beyond that alone is in none of them.
//!
//! ```text
//! u = mean over x of the parts of 0..x_max that no recording was in      x: pressure of the extending chamber, stroke, contact force
//! P(a law beyond) = P_0 u
//! I = h(P_0 (u - u'))                                                    information of an experiment that leaves u' [nat], h binary entropy
//! ```
//!
//! Each range is cut into ten equal parts. x_max is what `[limits]` states, less what draws of the numbers keep free below it, and a variable of which nothing is stated is not
//! counted: what has no limit is moved no farther than the recordings moved it.

use super::information::entropy;
use crate::diagnosis::recordings::evidence::{Evidence, Prediction};
use crate::plant::{OperatingLimits, PlantParameters, Trajectory};
use crate::quantity::{listed, percent};

/// P_0, probability that a law acts in a part of the range alone that no recording was in, were that all of it [1]: a judgement.
const BEYOND: f64 = 0.1;
/// Parts of a range.
const PARTS: usize = 10;
/// Samples from which a recording was in a part.
const SAMPLES: usize = 3;
/// Share of a limit that an experiment reaches [1]: a regulator's end is slow, and the force keeps its limit in every draw.
const PRESSURE_REACHED: f64 = 0.9;
const STROKE_REACHED: f64 = 0.95;
const FORCE_REACHED: f64 = 0.8;

/// A variable that laws depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Variable {
    /// Pressure of the extending chamber, gauge.
    Pressure,
    Stroke,
    Force,
}

impl Variable {
    /// A value [SI] with its name, as people read it.
    fn up_to(self, value: f64) -> String {
        match self {
            Self::Pressure => format!("chamber pressure up to {:.1} bar", value * 1e-5),
            Self::Stroke => format!("stroke up to {:.0} mm", value * 1e3),
            Self::Force => format!("contact force up to {value:.0} N"),
        }
    }
}

/// A variable's range, and which of its parts recordings were in.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Range {
    of: Variable,
    most: f64,
    visited: [bool; PARTS],
}

/// Ranges within the limits, with what recordings were in.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Coverage {
    ranges: Vec<Range>,
    atmosphere: f64,
}

impl Coverage {
    /// Of recordings, by what an explanation gives of them.
    #[must_use]
    pub fn of(limits: &OperatingLimits, evidence: &Evidence, found: &Prediction) -> Self {
        let mut coverage = Self {
            ranges: ranges(limits, evidence, &found.plant),
            atmosphere: found.plant.device.gas.atmosphere,
        };
        for trajectory in &found.trajectories {
            let parts = coverage.parts(&trajectory.truth);
            for (range, parts) in coverage.ranges.iter_mut().zip(parts) {
                for (visited, samples) in range.visited.iter_mut().zip(parts) {
                    *visited |= samples >= SAMPLES;
                }
            }
        }
        coverage
    }

    /// u [1]; 0 where no limit is stated.
    #[must_use]
    pub fn unvisited(&self) -> f64 {
        let free = |range: &Range| range.visited.iter().filter(|visited| !**visited).count();
        self.share(self.ranges.iter().map(free).sum())
    }

    /// Probability of a law beyond what the recordings have been to [1].
    #[must_use]
    pub fn probability_beyond(&self) -> f64 {
        BEYOND * self.unvisited()
    }

    /// I, of an experiment by what an explanation gives of it [nat].
    #[must_use]
    pub fn information(&self, truth: &Trajectory) -> f64 {
        let parts = self.parts(truth);
        let new = self.ranges.iter().zip(parts).map(|(range, parts)| {
            let pairs = range.visited.iter().zip(parts);
            pairs
                .filter(|(visited, samples)| !**visited && *samples >= SAMPLES)
                .count()
        });
        let found = BEYOND * self.share(new.sum());
        entropy(&[found, 1.0 - found]).max(0.0)
    }

    /// A sentence on it; none where no limit is stated.
    #[must_use]
    pub fn words(&self) -> Option<String> {
        let own: Vec<String> = (self.ranges.iter())
            .map(|range| {
                let visited = range.visited.iter().filter(|visited| **visited).count();
                let percent = 100 * visited / PARTS;
                format!("{percent} % of the {}", range.of.up_to(range.most))
            })
            .collect();
        (!own.is_empty()).then(|| {
            format!(
                "Within the limits the recordings have been to {}. A law that acts only outside that shows in none of them: its probability, {}, is counted with none of these.",
                listed(&own),
                percent(self.probability_beyond())
            )
        })
    }

    fn share(&self, parts: usize) -> f64 {
        match self.ranges.len() {
            0 => 0.0,
            count => parts as f64 / (count * PARTS) as f64,
        }
    }

    /// Samples in each part of each range.
    fn parts(&self, truth: &Trajectory) -> Vec<[usize; PARTS]> {
        let of = |range: &Range| {
            let (values, zero) = match range.of {
                Variable::Pressure => (&truth.pressures[0], self.atmosphere),
                Variable::Stroke => (&truth.stroke, 0.0),
                Variable::Force => (&truth.contact_force, 0.0),
            };
            let mut parts = [0; PARTS];
            for value in values {
                let at = (value - zero) / range.most * PARTS as f64;
                if at.is_finite() {
                    parts[(at.max(0.0) as usize).min(PARTS - 1)] += 1;
                }
            }
            parts
        };
        self.ranges.iter().map(of).collect()
    }
}

/// Ranges of what limits are stated of.
fn ranges(limits: &OperatingLimits, evidence: &Evidence, plant: &PlantParameters) -> Vec<Range> {
    let device = &plant.device;
    let area = device.areas().extending;
    let inputs = evidence.recordings.iter().map(|own| &own.inputs);
    let set = inputs.flat_map(|own| own.set_pressure.iter().copied());
    let largest = limits.set_pressure.unwrap_or(set.fold(0.0, f64::max));
    // With a workpiece the force bounds the pressure.
    let is_pressed = limits.without_workpiece != Some(true);
    let bearable = match limits.force.filter(|_| is_pressed) {
        Some(force) => FORCE_REACHED * force / area,
        None => f64::INFINITY,
    };
    let pressure = limits.set_pressure.map(|most| PRESSURE_REACHED * most);
    let stroke = match limits.without_workpiece {
        Some(true) => Some(limits.stroke.unwrap_or(device.full_stroke)),
        _ => limits.surface[1].or(limits.stroke),
    };
    let force = limits.force.map(|most| most.min(largest * area));
    let stated = [
        (Variable::Pressure, pressure.map(|most| most.min(bearable))),
        (Variable::Stroke, stroke.map(|most| STROKE_REACHED * most)),
        (Variable::Force, force.map(|most| FORCE_REACHED * most)),
    ];
    let own = stated.into_iter().filter_map(|(of, most)| {
        let most = most.filter(|most| *most > 0.0)?;
        Some(Range {
            of,
            most,
            visited: [false; PARTS],
        })
    });
    own.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::test_evidence::{evidence_of, plant};
    use crate::plant::simulate;

    fn limits() -> OperatingLimits {
        OperatingLimits {
            set_pressure: Some(3e5),
            without_workpiece: Some(true),
            force: Some(1e3),
            ..OperatingLimits::default()
        }
    }

    fn coverage(limits: &OperatingLimits, pressures: &[f64]) -> Coverage {
        let recordings = pressures.iter().map(|p| vec![*p; 126]).collect();
        let evidence = evidence_of(&plant(), recordings);
        Coverage::of(limits, &evidence, &evidence.predict(&plant(), false, None))
    }

    /// Counted part by part, by its bounds in place of its number.
    #[test]
    fn what_was_visited_is_what_samples_lie_in() {
        let found = coverage(&limits(), &[1e5]);
        let evidence = evidence_of(&plant(), vec![vec![1e5; 126]]);
        let truth = simulate(&plant(), &evidence.recordings[0].inputs).truth;
        let area = plant().device.areas().extending;
        let most = [
            0.9 * 3e5,
            0.95 * plant().device.full_stroke,
            0.8 * (3e5 * area).min(1e3),
        ];
        let atmosphere = plant().device.gas.atmosphere;
        let gauge: Vec<f64> = truth.pressures[0].iter().map(|p| p - atmosphere).collect();
        let values = [&gauge, &truth.stroke, &truth.contact_force];
        let mut empty = 0;
        for (most, values) in most.iter().zip(values) {
            for part in 0..10 {
                let [low, high] = [part, part + 1].map(|end| 0.1 * f64::from(end) * most);
                let within = |x: &&f64| (**x >= low || part == 0) && (**x < high || part == 9);
                empty += usize::from(values.iter().filter(within).count() < 3);
            }
        }
        assert!(
            (found.unvisited() - empty as f64 / 30.0).abs() < 1e-12,
            "{found:?}, {empty}"
        );
        assert!(empty > 10 && empty < 29, "{empty}");
    }

    /// A device was stated to have nothing but a wrong gain after experiments that never pressed on the part, nor went beyond a third of the pressure that was
    /// allowed: the law beside it acts above that.
    #[test]
    fn where_no_recording_was_a_law_may_act_and_a_recording_there_tells() {
        let few = coverage(&limits(), &[0.4e5]);
        let more = coverage(&limits(), &[0.4e5, 2.9e5]);
        assert!(few.unvisited() > more.unvisited() + 0.3, "{few:?} {more:?}");
        assert!(few.probability_beyond() > 0.05);
        let truth = |pressure: f64| {
            let evidence = evidence_of(&plant(), vec![vec![pressure; 126]]);
            simulate(&plant(), &evidence.recordings[0].inputs).truth
        };
        assert_eq!(few.information(&truth(0.4e5)), 0.0);
        assert!(few.information(&truth(2.9e5)) > 0.1);
        assert_eq!(more.information(&truth(2.9e5)), 0.0);
        assert!(
            few.words()
                .is_some_and(|words| words.contains("chamber pressure"))
        );
    }

    /// What has no limit is moved no farther than the recordings moved it.
    #[test]
    fn without_limits_nothing_is_left_unvisited() {
        let found = coverage(&OperatingLimits::default(), &[0.4e5]);
        assert_eq!((found.unvisited(), found.words()), (0.0, None));
    }
}

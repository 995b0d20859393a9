//! A programme of a bench: set pressure, valve and surface over time, within limits by the way it is made.
//!
//! ```text
//! p(t): each segment goes in a straight line from one pressure to another, held for 50 ms at a time, no faster than the limit
//! s(t) = s0 - a (1 - cos(2 pi f (t - t0))) / 2     for t > t0
//! ```
//!
//! p set pressure, s position of the surface along the stroke, s0 where it stands, a peak to peak, f frequency, t0 start of its motion. A staircase, a ramp,
//! a dwell, reversals of the valve and a ride are each one of these. A bench's scenario holds the same, number for number. In a cell the arm rides instead ([`Ride`]).

use std::f64::consts::{PI, TAU};

use rand::Rng;

use super::limits::Limits;
use super::ride::{ArmCommands, ArmReach, Ride};
use crate::plant::{InitialState, PlantInputs};

/// Time for which a set pressure is held [s].
pub const HOLD: f64 = 0.05;
/// Segments at most.
const MOST_SEGMENTS: usize = 14;
/// Shortest segment [s].
const SHORTEST: f64 = 0.1;
/// Lowest and highest frequency of a surface [Hz].
const FREQUENCIES: [f64; 2] = [0.1, 12.0];

/// A part of a programme.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// Its length [s].
    pub duration: f64,
    /// Set pressure at its start and at its end [Pa gauge].
    pub set_pressure: [f64; 2],
    /// Whether the valve extends.
    pub extends: bool,
}

/// A surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Where it stands [m].
    pub position: f64,
    /// Its motion towards the device, peak to peak [m].
    pub peak_to_peak: f64,
    /// Frequency of that [Hz].
    pub frequency: f64,
    /// Start of it [s].
    pub start: f64,
}

/// What the tool is pressed against.
#[derive(Debug, Clone, PartialEq)]
pub enum Part {
    /// Nothing: there is no workpiece.
    None,
    /// The surface of a bench.
    Surface(Surface),
    /// The edge of a cell's part, along which the arm rides.
    Edge(Ride),
}

/// A programme.
#[derive(Debug, Clone, PartialEq)]
pub struct Programme {
    /// Set pressure and valve.
    pub segments: Vec<Segment>,
    /// What the tool is pressed against.
    pub part: Part,
}

impl Surface {
    /// Where it stands at a time [m].
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        let phase = TAU * self.frequency * (time - self.start).max(0.0);
        self.position - 0.5 * self.peak_to_peak * (1.0 - phase.cos())
    }

    /// Largest speed [m/s] and acceleration [m/s2].
    #[must_use]
    pub fn motion(&self) -> [f64; 2] {
        let rate = TAU * self.frequency;
        [1, 2].map(|order| 0.5 * self.peak_to_peak * rate.powi(order))
    }

    fn drawn(limits: &Limits, [least, most]: [f64; 2], random: &mut impl Rng) -> Self {
        let position = between([least, most], random);
        let frequency = (between(FREQUENCIES.map(f64::ln), random)).exp();
        let moves = limits.movable.surface && random.random_bool(0.7);
        let mut drawn = Self {
            position,
            peak_to_peak: if moves { position - least } else { 0.0 },
            frequency,
            start: between([0.0, 1.0], random),
        };
        drawn.peak_to_peak *= random.random_range(0.1..1.0);
        drawn.within(limits, [least, most]);
        drawn
    }

    /// Brings it within its limits.
    fn within(&mut self, limits: &Limits, [least, most]: [f64; 2]) {
        self.position = self.position.clamp(least, most);
        self.frequency = self.frequency.clamp(FREQUENCIES[0], FREQUENCIES[1]);
        self.peak_to_peak = self.peak_to_peak.clamp(0.0, self.position - least);
        for (found, limit) in self.motion().into_iter().zip(limits.surface_motion) {
            if found > limit {
                self.peak_to_peak *= limit / found;
            }
        }
    }
}

impl Part {
    fn drawn(limits: &Limits, random: &mut impl Rng) -> Self {
        if let Some(reach) = &limits.arm {
            return Self::Edge(Ride::drawn(reach, limits.movable.path, random));
        }
        (limits.surface)
            .filter(|_| !limits.without_workpiece || random.random_bool(0.75))
            .map_or(Self::None, |range| {
                Self::Surface(Surface::drawn(limits, range, random))
            })
    }
}

impl Segment {
    fn drawn(limits: &Limits, random: &mut impl Rng) -> Self {
        let pressure = |random: &mut _| between(limits.set_pressure, random);
        let from = pressure(random);
        let holds = random.random_bool(0.6);
        Self {
            duration: between([SHORTEST.ln(), (0.5 * limits.duration).ln()], random).exp(),
            set_pressure: [from, if holds { from } else { pressure(random) }],
            extends: !limits.retracts || random.random_bool(0.65),
        }
    }
}

fn between([least, most]: [f64; 2], random: &mut impl Rng) -> f64 {
    least + (most - least) * random.random::<f64>()
}

impl Programme {
    /// One drawn at random within the limits, of a length up to theirs.
    pub fn drawn(limits: &Limits, random: &mut impl Rng) -> Self {
        let count = random.random_range(1..=MOST_SEGMENTS);
        let mut drawn = Self {
            segments: (0..count).map(|_| Segment::drawn(limits, random)).collect(),
            part: Part::drawn(limits, random),
        };
        drawn.within(limits);
        drawn
    }

    /// The same with something changed.
    #[must_use]
    pub fn changed(&self, limits: &Limits, random: &mut impl Rng) -> Self {
        let mut other = self.clone();
        for _ in 0..random.random_range(1..=3) {
            other.change(limits, random);
        }
        other.within(limits);
        other
    }

    fn change(&mut self, limits: &Limits, random: &mut impl Rng) {
        let at = random.random_range(0..self.segments.len());
        match random.random_range(0..8) {
            0 if self.segments.len() < MOST_SEGMENTS => {
                self.segments.insert(at, Segment::drawn(limits, random));
            }
            1 if self.segments.len() > 1 => drop(self.segments.remove(at)),
            2 => self.segments[at].duration *= between([-0.7, 0.7], random).exp(),
            3 => {
                let holds = self.segments[at].set_pressure[0] == self.segments[at].set_pressure[1];
                let pressure = between(limits.set_pressure, random);
                let end = random.random_range(0..2);
                self.segments[at].set_pressure[end] = pressure;
                if holds && random.random_bool(0.7) {
                    self.segments[at].set_pressure = [pressure; 2];
                }
            }
            4 if limits.retracts => self.segments[at].extends = !self.segments[at].extends,
            5 => self.segments = [self.segments.clone(), self.segments.clone()].concat(),
            _ => match (&mut self.part, limits.surface, &limits.arm) {
                (Part::Surface(surface), Some(range), _) => {
                    let drawn = Surface::drawn(limits, range, random);
                    match random.random_range(0..4) {
                        0 => *surface = drawn,
                        1 => surface.frequency = drawn.frequency,
                        2 => surface.position = drawn.position,
                        _ => surface.peak_to_peak = drawn.peak_to_peak,
                    }
                }
                (Part::Edge(ride), _, Some(reach)) => ride.change(reach, random),
                _ => self.segments[at] = Segment::drawn(limits, random),
            },
        }
    }

    /// Brings it within the limits: no longer, and each segment on the grid of held pressures.
    fn within(&mut self, limits: &Limits) {
        self.segments.truncate(MOST_SEGMENTS);
        let [low, high] = limits.set_pressure;
        for segment in &mut self.segments {
            segment.set_pressure = segment.set_pressure.map(|p| p.clamp(low, high));
            let holds = (segment.duration.max(SHORTEST) / HOLD).round().max(1.0);
            segment.duration = holds * HOLD;
        }
        let mut left = (limits.duration / HOLD).floor() * HOLD;
        self.segments.retain_mut(|segment| {
            segment.duration = segment.duration.min(left);
            left -= segment.duration;
            segment.duration >= 0.5 * HOLD
        });
        let missing = limits.shortest() - self.duration();
        if let Some(last) = self.segments.last_mut()
            && missing > 0.5 * HOLD
        {
            last.duration += (missing / HOLD).round() * HOLD;
        }
        let duration = self.duration();
        match (&mut self.part, limits.surface, &limits.arm) {
            (Part::Surface(surface), Some(range), _) => surface.within(limits, range),
            (Part::Edge(ride), _, Some(reach)) => ride.within(reach, duration),
            _ => (),
        }
    }

    /// The surface of a bench; none of a cell, or without a workpiece.
    #[must_use]
    pub fn surface(&self) -> Option<&Surface> {
        match &self.part {
            Part::Surface(surface) => Some(surface),
            Part::None | Part::Edge(_) => None,
        }
    }

    /// The arm's ride, with what it may do; none on a bench.
    #[must_use]
    pub fn ride<'a>(&'a self, limits: &'a Limits) -> Option<(&'a Ride, &'a ArmReach)> {
        match (&self.part, &limits.arm) {
            (Part::Edge(ride), Some(reach)) => Some((ride, reach)),
            _ => None,
        }
    }

    /// The same with so much of its set pressures [1].
    #[must_use]
    pub fn gentler(&self, share: f64) -> Self {
        let mut other = self.clone();
        for segment in &mut other.segments {
            segment.set_pressure = segment.set_pressure.map(|p| p * share);
        }
        other
    }

    /// Its length [s].
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.segments.iter().map(|own| own.duration).sum()
    }

    /// Set pressures [Pa gauge] and whether the valve extends, each held for [`HOLD`].
    #[must_use]
    pub fn commands(&self, limits: &Limits) -> Vec<(f64, bool)> {
        let most = limits.set_pressure_rate * HOLD;
        let mut last = 0.0;
        let mut found = Vec::new();
        for segment in &self.segments {
            let count = (segment.duration / HOLD).round().max(1.0);
            let [from, to] = segment.set_pressure;
            for index in 0..count as usize {
                let share = match count {
                    1.0 => 0.0,
                    _ => index as f64 / (count - 1.0),
                };
                let asked = from + share * (to - from);
                last += (asked - last).clamp(-most, most);
                // As a file has it.
                last = last.round();
                found.push((last, segment.extends));
            }
        }
        found
    }

    /// Times of its samples [s], with set pressure [Pa gauge] and whether the valve extends.
    fn sampled(&self, limits: &Limits) -> (Vec<f64>, Vec<f64>, Vec<bool>) {
        let commands = self.commands(limits);
        let duration = commands.len() as f64 * HOLD;
        let count = (duration / limits.step + 1e-9).floor() as usize + 1;
        let time: Vec<f64> = (0..count).map(|i| i as f64 * limits.step).collect();
        let at = |t: &f64| commands[((t / HOLD + 1e-9) as usize).min(commands.len() - 1)];
        let held: Vec<(f64, bool)> = time.iter().map(at).collect();
        let (set_pressure, extends) = held.into_iter().unzip();
        (time, set_pressure, extends)
    }

    /// What the arm of a cell is commanded; none on a bench.
    #[must_use]
    pub fn arm_commands(&self, limits: &Limits) -> Option<ArmCommands> {
        let (ride, reach) = self.ride(limits)?;
        let (time, set_pressure, _) = self.sampled(limits);
        Some(ride.commands(reach, time, set_pressure))
    }

    /// As the simulator takes it.
    #[must_use]
    pub fn inputs(&self, limits: &Limits) -> PlantInputs {
        if let (Some(commands), Some(reach)) = (self.arm_commands(limits), &limits.arm) {
            return reach.inputs(commands);
        }
        let (time, set_pressure, extends) = self.sampled(limits);
        let surface = self.surface();
        PlantInputs {
            set_pressure,
            extends,
            surface: time
                .iter()
                .map(|t| surface.map_or(f64::NAN, |own| own.at(*t)))
                .collect(),
            cell: None,
            motion: None,
            initial: InitialState::AtRest,
            place: 0,
            time,
        }
    }

    /// What is to be done, a sentence each.
    #[must_use]
    pub fn instructions(&self, limits: &Limits) -> Vec<String> {
        let bar = |pressure: f64| format!("{:.2}", pressure * 1e-5);
        let begin = "Begin with the slide retracted, at rest, and no set pressure.".to_owned();
        let of_part = match (&self.part, &limits.arm) {
            (Part::Edge(ride), Some(reach)) => ride.instructions(reach),
            (Part::Surface(own), _) if own.peak_to_peak < 1e-6 => {
                vec![format!(
                    "Fix the surface at {:.1} mm of the stroke.",
                    own.position * 1e3
                )]
            }
            (Part::Surface(own), _) => vec![format!(
                "Put the surface at {:.1} mm of the stroke and from {:.2} s on move it towards the device and back, {:.2} mm peak to peak at {:.2} Hz ({:.0} mm/s at most).",
                own.position * 1e3,
                own.start,
                own.peak_to_peak * 1e3,
                own.frequency,
                own.peak_to_peak * PI * own.frequency * 1e3
            )],
            (Part::None | Part::Edge(_), _) => vec!["Take the workpiece away.".to_owned()],
        };
        let mut lines: Vec<String> = [begin].into_iter().chain(of_part).collect();
        let has_valve = limits.arm.is_none();
        let mut from = 0.0;
        for own in self.merged() {
            let [start, end] = own.set_pressure;
            let pressure = match (start - end).abs() < 1.0 {
                true => format!("{} bar", bar(start)),
                false => format!("from {} to {} bar", bar(start), bar(end)),
            };
            let valve = match (has_valve, own.extends) {
                (false, _) => "",
                (true, true) => ", valve extended",
                (true, false) => ", valve retracted",
            };
            lines.push(format!(
                "{from:.2} s to {:.2} s: set pressure {pressure}{valve}.",
                from + own.duration
            ));
            from += own.duration;
        }
        lines
    }

    /// Its segments, those in one that hold the same.
    fn merged(&self) -> Vec<Segment> {
        let mut merged: Vec<Segment> = Vec::new();
        for own in &self.segments {
            let holds = own.set_pressure[0] == own.set_pressure[1];
            match merged.last_mut() {
                Some(last)
                    if holds
                        && last.set_pressure == own.set_pressure
                        && last.extends == own.extends =>
                {
                    last.duration += own.duration;
                }
                _ => merged.push(own.clone()),
            }
        }
        merged
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    /// Every programme that is drawn or changed, however often, keeps the limits; by the samples of its inputs, not by its own numbers.
    #[test]
    fn a_thousand_programmes_keep_their_limits() {
        let limits = Limits::of_tests();
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut programme = Programme::drawn(&limits, &mut random);
        let (mut retracts, mut moves, mut free) = (0, 0, 0);
        for index in 0..1000 {
            programme = match index % 3 {
                0 => Programme::drawn(&limits, &mut random),
                _ => programme.changed(&limits, &mut random),
            };
            let inputs = programme.inputs(&limits);
            let duration = inputs.time[inputs.time.len() - 1];
            assert!(duration <= limits.duration + 1e-9, "{duration}");
            let mut last = 0.0;
            for pressure in &inputs.set_pressure {
                assert!((0.0..=3e5).contains(pressure), "{pressure}");
                let most = limits.set_pressure_rate * HOLD + 1.0;
                assert!((pressure - last).abs() <= most, "{last} to {pressure}");
                last = *pressure;
            }
            retracts += usize::from(inputs.extends.contains(&false));
            if inputs.surface[0].is_nan() {
                free += 1;
                continue;
            }
            let step = limits.step;
            for three in inputs.surface.windows(3) {
                assert!((0.012 - 1e-9..=0.031 + 1e-9).contains(&three[1]));
                let speed = (three[2] - three[0]) / (2.0 * step);
                assert!(speed.abs() <= 0.2 * (1.0 + 1e-6), "{speed}");
                let acceleration = (three[2] - 2.0 * three[1] + three[0]) / (step * step);
                assert!(acceleration.abs() <= 3.0 * (1.0 + 1e-6), "{acceleration}");
            }
            moves += usize::from(inputs.surface.windows(2).any(|two| two[0] != two[1]));
        }
        assert!(
            retracts > 300 && moves > 200 && free > 100,
            "{retracts} {moves} {free}"
        );
    }

    /// What is asked of a person is what the inputs do.
    #[test]
    fn instructions_cover_the_whole_of_it() {
        let limits = Limits::of_tests();
        let programme = Programme::drawn(&limits, &mut ChaCha8Rng::seed_from_u64(2));
        let lines = programme.instructions(&limits);
        assert_eq!(lines.len(), 2 + programme.segments.len());
        let end = format!("{:.2} s:", programme.duration());
        assert!(lines[lines.len() - 1].contains(&end), "{lines:?}");
        let hold = Segment {
            duration: 0.5,
            set_pressure: [1e5; 2],
            extends: true,
        };
        let still = Programme {
            segments: vec![hold.clone(), hold],
            part: Part::None,
        };
        let lines = still.instructions(&limits);
        assert!(lines[2].contains("0.00 s to 1.00 s"), "{lines:?}");
        assert_eq!(lines.len(), 3);
    }
}

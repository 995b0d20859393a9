//! A ride of an arm: along the course on which its recordings pressed, at other speeds, back and forth, with rests.
//!
//! ```text
//! u(t) = u_a + (u_b - u_a) (1 - cos(pi t / D)) / 2                               a leg from u_a to u_b
//! D = k max over u, joints of  pi |q'| sqrt(w) / V,  pi sqrt(|q'' w + q' (m - u)| / A)
//! w = (u - u_a) (u_b - u),   m = (u_a + u_b) / 2
//! ```
//!
//! u time at which the recording was there, its rests left out; q(u) the joints then, D time that the leg takes, k >= 1 its slowness, V and A largest speed and
//! acceleration of a joint. With u'^2 = (pi / D)^2 w and u'' = (pi / D)^2 (m - u) no joint moves faster, or speeds up more, than it may.

use std::f64::consts::PI;
use std::sync::Arc;

use rand::Rng;

use crate::plant::{PlantInputs, PlantParameters};

/// Share of the largest speed below which an arm rests [1].
const RESTS: f64 = 1e-3;
/// Time over which speeds are taken [s].
const WINDOW: f64 = 0.02;
/// Places of a course at which a leg's speeds are looked at.
const PLACES: usize = 400;
/// A leg that could be done in less goes nowhere [s].
const STILL: f64 = 0.02;
/// Legs at most.
const MOST_LEGS: usize = 8;
/// Largest slowness of a leg [1].
const SLOWEST: f64 = 20.0;
/// Longest rest after a leg [s].
const LONGEST_REST: f64 = 2.0;

/// What an arm is commanded at samples.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmCommands {
    /// Times [s].
    pub time: Vec<f64>,
    /// Place along the edge [m].
    pub path: Vec<f64>,
    /// Joints, base first [rad].
    pub joints: Vec<Vec<f64>>,
    /// Set pressure [Pa gauge].
    pub set_pressure: Vec<f64>,
}

/// Where an arm went in a recording while its device was set to press.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// Name of the recording.
    pub recording: String,
    /// Time in it at which the course starts [s].
    pub start: f64,
    /// Time since, without rests [s].
    moving: Vec<f64>,
    path: Vec<f64>,
    joints: Vec<Vec<f64>>,
    /// Rate [rad/s] and second derivative [rad/s2] of each joint at some places: (place, of joints).
    motion: Vec<(f64, Vec<[f64; 2]>)>,
}

impl Course {
    /// Of a recording's commands; none where the device never pressed.
    #[must_use]
    pub fn of(recording: &str, commands: &ArmCommands) -> Option<Self> {
        let presses = |pressure: &f64| *pressure > 0.0;
        let first = commands.set_pressure.iter().position(presses)?;
        let last = commands.set_pressure.iter().rposition(presses)?;
        let rate = |at: usize| {
            let step = commands.time[at + 1] - commands.time[at];
            let own = commands.joints.iter();
            own.map(|q| ((q[at + 1] - q[at]) / step).abs())
                .fold(0.0, f64::max)
        };
        let most = (first..last).map(rate).fold(0.0, f64::max);
        let (mut kept, mut moving) = (vec![first], vec![0.0]);
        for at in first..last {
            if rate(at) > RESTS * most {
                let step = commands.time[at + 1] - commands.time[at];
                moving.push(moving[moving.len() - 1] + step);
                kept.push(at + 1);
            }
        }
        let of = |values: &Vec<f64>| kept.iter().map(|at| values[*at]).collect();
        let mut course = Self {
            recording: recording.to_owned(),
            start: commands.time[first],
            path: of(&commands.path),
            joints: commands.joints.iter().map(of).collect(),
            moving,
            motion: Vec::new(),
        };
        course.motion = (0..=PLACES)
            .map(|index| course.length() * index as f64 / PLACES as f64)
            .map(|u| (u, course.motion_at(u)))
            .collect();
        Some(course)
    }

    /// Its length [s].
    #[must_use]
    pub fn length(&self) -> f64 {
        self.moving[self.moving.len() - 1]
    }

    fn interpolated(&self, values: &[f64], u: f64) -> f64 {
        let last = self.moving.len() - 1;
        if last == 0 {
            return values[0];
        }
        let at = self.moving.partition_point(|own| *own <= u).clamp(1, last);
        let [from, to] = [self.moving[at - 1], self.moving[at]];
        let share = ((u - from) / (to - from)).clamp(0.0, 1.0);
        values[at - 1] + share * (values[at] - values[at - 1])
    }

    fn motion_at(&self, u: f64) -> Vec<[f64; 2]> {
        let window = WINDOW.min(0.25 * self.length());
        if window <= 0.0 {
            return vec![[0.0; 2]; self.joints.len()];
        }
        let u = u.clamp(window, self.length() - window);
        let of = |joint: &Vec<f64>| {
            let [before, here, after] =
                [u - window, u, u + window].map(|at| self.interpolated(joint, at));
            [
                0.5 * (after - before) / window,
                (after - 2.0 * here + before) / (window * window),
            ]
        };
        self.joints.iter().map(of).collect()
    }

    /// Largest speed and acceleration of each joint.
    fn largest(&self) -> Vec<[f64; 2]> {
        let mut largest = vec![[0.0f64; 2]; self.joints.len()];
        for (_, motion) in &self.motion {
            for (most, own) in largest.iter_mut().zip(motion) {
                *most = [most[0].max(own[0].abs()), most[1].max(own[1].abs())];
            }
        }
        largest
    }

    /// Time that a leg takes at least [s].
    fn shortest(&self, [from, to]: [f64; 2], limits: &[[f64; 2]]) -> f64 {
        let middle = 0.5 * (from + to);
        let mut least: f64 = 0.0;
        for (u, motion) in &self.motion {
            let within = (u - from) * (to - u);
            if within < 0.0 {
                continue;
            }
            for ([rate, second], [speed, acceleration]) in motion.iter().zip(limits) {
                let by_speed = rate.abs() * within.sqrt() / speed;
                let own = second * within + rate * (middle - u);
                let by_acceleration = (own.abs() / acceleration).sqrt();
                least = least.max(PI * by_speed.max(by_acceleration));
            }
        }
        least
    }
}

/// Recordings' commands made into inputs of the plant.
type Replay = dyn Fn(ArmCommands) -> PlantInputs + Send + Sync;

/// Largest share of the torque that a drive may give, by a device, its inputs, and its strokes [m] and contact forces [N].
type TorqueShare = dyn Fn(&PlantParameters, &PlantInputs, (&[f64], &[f64])) -> f64 + Send + Sync;

/// How far an arm may be moved: along the courses of its recordings.
#[derive(Clone)]
pub struct ArmReach {
    /// The courses.
    pub courses: Vec<Course>,
    /// Largest speed [rad/s] and acceleration [rad/s2] of each joint.
    limits: Vec<[f64; 2]>,
    replay: Arc<Replay>,
    /// None where no torque is limited.
    torque_share: Option<Arc<TorqueShare>>,
}

impl std::fmt::Debug for ArmReach {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        to.debug_struct("ArmReach")
            .field("courses", &self.courses.len())
            .field("limits", &self.limits)
            .finish_non_exhaustive()
    }
}

impl ArmReach {
    /// Of courses, and of what makes commands into inputs. What is not stated of joints' largest speed [rad/s] and acceleration [rad/s2] is as large as it was;
    /// none where there is no course.
    #[must_use]
    pub fn new(
        courses: Vec<Course>,
        stated: [Option<f64>; 2],
        replay: Arc<Replay>,
    ) -> Option<Self> {
        let joints = courses.first()?.joints.len();
        let mut limits = vec![[1e-6f64; 2]; joints];
        for course in &courses {
            for (most, own) in limits.iter_mut().zip(course.largest()) {
                *most = [most[0].max(own[0]), most[1].max(own[1])];
            }
        }
        for own in &mut limits {
            *own = [0, 1].map(|order| stated[order].unwrap_or(own[order]));
        }
        Some(Self {
            courses,
            limits,
            replay,
            torque_share: None,
        })
    }

    /// The same with drives whose torque is limited.
    #[must_use]
    pub fn with_torques(mut self, share: Arc<TorqueShare>) -> Self {
        self.torque_share = Some(share);
        self
    }

    /// Largest share of the torque that a drive may give, by a device, its inputs, and its strokes [m] and contact forces [N]; 0 where none is limited [1].
    #[must_use]
    pub fn torque_share(
        &self,
        plant: &PlantParameters,
        inputs: &PlantInputs,
        touched: (&[f64], &[f64]),
    ) -> f64 {
        let share = self.torque_share.as_ref();
        share.map_or(0.0, |share| share(plant, inputs, touched))
    }

    /// Inputs of the plant by what the arm is commanded.
    #[must_use]
    pub fn inputs(&self, commands: ArmCommands) -> PlantInputs {
        (self.replay)(commands)
    }
}

/// A part of a ride: to another place, and a rest there.
#[derive(Debug, Clone, PartialEq)]
pub struct Leg {
    /// Where it goes, as a share of the course [1].
    pub to: f64,
    /// By how much it is slower than it may be [1].
    slowness: f64,
    /// Time that it takes [s].
    pub duration: f64,
    /// Rest after it [s].
    pub rest: f64,
}

/// A ride.
#[derive(Debug, Clone, PartialEq)]
pub struct Ride {
    /// Place of its course.
    pub course: usize,
    /// Where it starts, as a share of the course [1].
    pub start: f64,
    /// Its legs.
    pub legs: Vec<Leg>,
}

impl Leg {
    fn drawn(random: &mut impl Rng) -> Self {
        let to = match random.random_range(0..3) {
            0 => 1.0,
            1 => 0.0,
            _ => random.random(),
        };
        Self {
            to,
            slowness: (random.random::<f64>() * SLOWEST.ln()).exp(),
            duration: 0.0,
            rest: match random.random_bool(0.5) {
                true => 0.0,
                false => LONGEST_REST * random.random::<f64>(),
            },
        }
    }
}

impl Ride {
    /// One drawn at random.
    pub fn drawn(reach: &ArmReach, moves: bool, random: &mut impl Rng) -> Self {
        let legs = if moves { random.random_range(1..=4) } else { 0 };
        Self {
            course: random.random_range(0..reach.courses.len()),
            start: match moves && random.random_bool(0.5) {
                true => random.random(),
                false => 0.0,
            },
            legs: (0..legs).map(|_| Leg::drawn(random)).collect(),
        }
    }

    /// Changes something of it.
    pub fn change(&mut self, reach: &ArmReach, random: &mut impl Rng) {
        let Some(last) = self.legs.len().checked_sub(1) else {
            return;
        };
        let at = random.random_range(0..=last);
        let drawn = Leg::drawn(random);
        match random.random_range(0..6) {
            0 if last + 1 < MOST_LEGS => self.legs.insert(at, drawn),
            1 if last > 0 => drop(self.legs.remove(at)),
            2 => self.legs[at].slowness = drawn.slowness,
            3 => self.legs[at].rest = drawn.rest,
            4 => self.course = random.random_range(0..reach.courses.len()),
            _ => self.legs[at].to = drawn.to,
        }
    }

    /// Gives each leg the time that it takes, or what is left; those that cannot be done by the end are left out.
    pub fn within(&mut self, reach: &ArmReach, duration: f64) {
        let course = &reach.courses[self.course];
        let (mut from, mut left) = (self.start, duration);
        let mut kept = Vec::new();
        for mut leg in self.legs.drain(..).take(MOST_LEGS) {
            let ends = [from, leg.to].map(|share| share * course.length());
            let shortest = course.shortest(ends, &reach.limits);
            if shortest < STILL {
                continue;
            }
            let wanted = leg.slowness.max(1.0) * shortest;
            // Times as a file has them, and no faster for it.
            leg.duration = (1e3 * wanted.min(left.max(shortest))).ceil() / 1e3;
            if leg.duration > left + 1e-3 {
                break;
            }
            left -= leg.duration + leg.rest;
            from = leg.to;
            kept.push(leg);
        }
        self.legs = kept;
    }

    /// Where it is at a time, as a share of the course [1].
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        let (mut from, mut start) = (self.start, 0.0);
        for leg in &self.legs {
            let own = time - start;
            if own < leg.duration {
                let share = 0.5 * (1.0 - (PI * own / leg.duration).cos());
                return from + share * (leg.to - from);
            }
            from = leg.to;
            start += leg.duration + leg.rest;
            if time < start {
                break;
            }
        }
        from
    }

    /// What the arm is commanded at times [s].
    #[must_use]
    pub fn commands(
        &self,
        reach: &ArmReach,
        time: Vec<f64>,
        set_pressure: Vec<f64>,
    ) -> ArmCommands {
        let course = &reach.courses[self.course];
        let places: Vec<f64> = time.iter().map(|t| self.at(*t) * course.length()).collect();
        let of = |values: &Vec<f64>| {
            let own = places.iter().map(|u| course.interpolated(values, *u));
            own.collect::<Vec<f64>>()
        };
        ArmCommands {
            path: of(&course.path),
            joints: course.joints.iter().map(of).collect(),
            time,
            set_pressure,
        }
    }

    /// What is to be done, a sentence each.
    #[must_use]
    pub fn instructions(&self, reach: &ArmReach) -> Vec<String> {
        let course = &reach.courses[self.course];
        let place = |share: f64| {
            let path = course.interpolated(&course.path, share * course.length());
            format!("{:.1} mm along the edge", path * 1e3)
        };
        let mut lines = vec![format!(
            "Put the arm where {} has it at {}, the slide retracted.",
            course.recording,
            place(self.start)
        )];
        if self.legs.is_empty() {
            lines.push("The arm rests there.".to_owned());
        }
        let mut from = 0.0;
        for leg in &self.legs {
            let to = from + leg.duration;
            lines.push(format!(
                "{from:.2} s to {to:.2} s: along the path of {} to {}.",
                course.recording,
                place(leg.to)
            ));
            from = to + leg.rest;
        }
        lines
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    /// Two joints that rest, swing to and fro at up to 0.5 and 0.2 rad/s, and rest again; pressed from 0.5 s on.
    fn recorded() -> ArmCommands {
        let time: Vec<f64> = (0..2000).map(|i| 0.002 * f64::from(i)).collect();
        let phase = |t: &f64| (t - 1.0).clamp(0.0, 2.0);
        let swing = |most: f64| {
            let own = time.iter().map(phase);
            own.map(|u| most / PI * (1.0 - (PI * u).cos()))
                .collect::<Vec<f64>>()
        };
        ArmCommands {
            path: time.iter().map(|t| 0.1 * phase(t)).collect(),
            joints: vec![swing(0.5), swing(0.2)],
            set_pressure: time
                .iter()
                .map(|t| if *t < 0.5 { 0.0 } else { 1e5 })
                .collect(),
            time,
        }
    }

    fn reach(stated: [Option<f64>; 2]) -> ArmReach {
        let course = Course::of("a.csv", &recorded()).unwrap();
        let replay = |_: ArmCommands| -> PlantInputs { panic!("no inputs are asked for") };
        ArmReach::new(vec![course], stated, Arc::new(replay)).unwrap()
    }

    #[test]
    fn a_course_has_no_rests_and_starts_where_the_device_presses() {
        let reach = reach([None; 2]);
        let course = &reach.courses[0];
        assert!((course.start - 0.5).abs() < 1e-9);
        assert!((course.length() - 2.0).abs() < 0.02, "{}", course.length());
        let [speed, acceleration] = reach.limits[0];
        assert!((speed / 0.5 - 1.0).abs() < 0.01, "{speed}");
        assert!(
            (acceleration / (0.5 * PI) - 1.0).abs() < 0.02,
            "{acceleration}"
        );
        let mut still = recorded();
        still.joints.iter_mut().for_each(|q| q.fill(0.3));
        let still = Course::of("still.csv", &still).unwrap();
        assert_eq!(still.length(), 0.0);
        let mut retracted = recorded();
        retracted.set_pressure.fill(0.0);
        assert_eq!(Course::of("retracted.csv", &retracted), None);
    }

    /// By the samples of what is commanded, not by the ride's own numbers.
    #[test]
    fn no_joint_is_faster_than_it_may_be() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        for stated in [[None; 2], [Some(0.1), Some(5.0)], [Some(3.0), Some(0.4)]] {
            let reach = reach(stated);
            let mut moved = 0;
            for _ in 0..200 {
                let mut ride = Ride::drawn(&reach, true, &mut random);
                ride.change(&reach, &mut random);
                ride.within(&reach, 12.0);
                let step = 0.01;
                let time: Vec<f64> = (0..=1200).map(|i| f64::from(i) * step).collect();
                let nothing = vec![0.0; time.len()];
                let commands = ride.commands(&reach, time, nothing);
                for (joint, [speed, acceleration]) in commands.joints.iter().zip(&reach.limits) {
                    for three in joint.windows(3) {
                        let found = (three[2] - three[0]).abs() / (2.0 * step);
                        assert!(found <= 1.01 * speed, "{found} {speed}");
                        let found = (three[2] - 2.0 * three[1] + three[0]).abs() / (step * step);
                        assert!(found <= 1.1 * acceleration, "{found} {acceleration}");
                    }
                }
                moved += usize::from(!ride.legs.is_empty());
            }
            assert!(moved > 100, "{moved}");
        }
    }
}

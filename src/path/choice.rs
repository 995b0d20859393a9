//! The choice of roll and posture: of all ways through widely spaced poses of the job the most comfortable, found without going all of them to their end.
//!
//! A way is no more comfortable than its least comfortable pose so far. The one that is still most comfortable is gone on with, a pose at a time; the first
//! that comes to its end that way is the most comfortable of all, and the others have been left where they fell behind it.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;
use glamx::DPose3;

use super::collisions;
use super::error::{Obstacle, PlanError};
use super::poses::Coarse;
use super::posture::{MountedArm, Stop};
use super::request::PlanRequest;

/// Roll and posture of a job.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// Angle of the flange's x axis about the tool's axis from the direction of travel, at the start of the edge [rad].
    pub roll: f64,
    /// Joint angles at the start of the edge [rad].
    pub start: Vec<f64>,
    /// How far the whole way keeps from singularity (least singular value over 0.15), limits of position (distance over 0.5 rad) and of torque (spare share over
    /// 0.3), the least of these [1]; 0 at a limit, from 1 on comfortable.
    pub comfort: f64,
}

/// Widely spaced poses of the whole job for a spin of the flange about the tool's axis.
struct Spin {
    /// The spin [rad].
    angle: f64,
    /// Poses of the flange.
    poses: Vec<DPose3>,
    /// Force on the tool at each [N].
    forces: Vec<DVec3>,
}

/// A way through the poses of a spin, as far as it was gone.
struct Way {
    /// Number of the spin.
    spin: usize,
    /// Joint angles from which it starts [rad].
    start: Vec<f64>,
    /// Farthest that an axis is there from the posture that is asked for [rad].
    away: f64,
    /// Joint angles at the poses [rad].
    angles: Vec<Vec<f64>>,
    /// The least of their comforts [1].
    comfort: f64,
}

impl Way {
    /// By which ways are ordered: ways as good as each other to rounding have one rank, and beyond comfortable all are as good as each other.
    fn rank(&self) -> i64 {
        let worth = self.comfort.min(1.0) - 10.0 * self.away;
        (worth / 1e-9).round() as i64
    }
}

/// Rolls and postures of a job that let all widely spaced poses pass, the most comfortable first; of those as comfortable the first found.
pub(super) struct Choice<'a> {
    request: &'a PlanRequest<'a>,
    mounted: MountedArm<'a>,
    coarse: Coarse,
    spins: Vec<Spin>,
    ways: Vec<Way>,
    /// Ways that may be the next, by their ranks, then by the order in which they were found.
    open: BinaryHeap<(i64, Reverse<usize>)>,
    /// The most comfortable way on which bodies meet.
    blocked: Option<usize>,
    /// Where the way stopped that came farthest of those that came to no end: its number, the pose's, and why.
    farthest: Option<(usize, usize, Stop)>,
}

impl<'a> Choice<'a> {
    /// Of a job.
    pub(super) fn new(request: &'a PlanRequest<'a>) -> Self {
        let mounted = MountedArm::of(request);
        let mut choice = Self {
            request,
            mounted,
            coarse: Coarse::new(request),
            spins: Vec::new(),
            ways: Vec::new(),
            open: BinaryHeap::new(),
            blocked: None,
            farthest: None,
        };
        for angle in mounted.spins(request.roll) {
            choice.add(angle);
        }
        choice
    }

    /// Adds the ways of a spin [rad].
    fn add(&mut self, angle: f64) {
        let request = self.request;
        let (poses, forces) = self.coarse.poses(request, angle);
        let starts = (self.mounted).starts(&poses[0], request.seed_posture, request.seed);
        if starts.is_empty() {
            let joints = self.mounted.chain.joints.iter();
            let from = joints.map(|joint| joint.middle().unwrap_or(0.0)).collect();
            let pose = poses[0];
            self.end(self.ways.len(), 0, Stop::NotReached { pose, from });
        }
        for start in starts {
            let pairs = request.seed_posture.unwrap_or_default().iter().zip(&start);
            let away = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let way = Way {
                spin: self.spins.len(),
                start,
                away,
                angles: Vec::with_capacity(poses.len()),
                comfort: f64::INFINITY,
            };
            self.open.push((way.rank(), Reverse(self.ways.len())));
            self.ways.push(way);
        }
        self.spins.push(Spin {
            angle,
            poses,
            forces,
        });
    }

    /// Keeps where a way stopped, if it came farther than all others, or as far and was found before them.
    fn end(&mut self, number: usize, pose: usize, stop: Stop) {
        let farther = |(other, reached, _): &(usize, usize, Stop)| {
            pose > *reached || (pose == *reached && number < *other)
        };
        if self.farthest.as_ref().is_none_or(farther) {
            self.farthest = Some((number, pose, stop));
        }
    }

    /// The most comfortable way to the end of its poses of those that are left.
    fn next_way(&mut self) -> Option<usize> {
        while let Some((_, Reverse(number))) = self.open.pop() {
            let way = &mut self.ways[number];
            let spin = &self.spins[way.spin];
            let reached = way.angles.len();
            let Some(pose) = spin.poses.get(reached) else {
                return Some(number);
            };
            let from = way.angles.last().unwrap_or(&way.start);
            match self.mounted.next(pose, from) {
                Ok(q) => {
                    way.comfort = (self.mounted).comfort(&q, spin.forces[reached], way.comfort);
                    way.angles.push(q);
                    self.open.push((way.rank(), Reverse(number)));
                }
                Err(stop) => self.end(number, reached, stop),
            }
        }
        None
    }

    /// What is in the way, where there is no roll and posture: on the most comfortable way what meets, else where the one stopped that came farthest.
    pub(super) fn failure(&self) -> PlanError {
        let blockade = self.blocked.and_then(|number| {
            collisions::blockade(self.request, &self.coarse, &self.ways[number].angles)
        });
        let farthest = || {
            let (_, pose, stop) = self.farthest.clone()?;
            Some((pose, self.mounted.why(stop)))
        };
        let unreachable = Obstacle::OutOfReach {
            distance: f64::NAN,
            axis: None,
        };
        let (index, obstacle) = blockade.or_else(farthest).unwrap_or((0, unreachable));
        self.coarse.failure(self.request, index, obstacle)
    }
}

impl Iterator for Choice<'_> {
    type Item = Outline;

    fn next(&mut self) -> Option<Outline> {
        loop {
            let number = self.next_way()?;
            let way = &self.ways[number];
            if collisions::passable(self.request, &self.coarse, &way.angles) {
                return Some(Outline {
                    roll: self.spins[way.spin].angle,
                    start: way.start.clone(),
                    comfort: way.comfort,
                });
            }
            self.blocked.get_or_insert(number);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use glam::DVec3;

    use super::*;
    use crate::cell::{Setup, Stance};
    use crate::scenario::load;

    /// A way and its joint angles at the poses [rad].
    type Gone = (Outline, Vec<Vec<f64>>);

    /// Ways to their end, the most comfortable first, of those as comfortable the first found; and where the one stopped that came farthest.
    fn all_ways(request: &PlanRequest) -> (Vec<Gone>, Option<(usize, Stop)>) {
        let mounted = MountedArm::of(request);
        let (mut ways, mut farthest) = (Vec::new(), None::<(usize, Stop)>);
        for roll in mounted.spins(request.roll) {
            let (poses, forces) = Coarse::new(request).poses(request, roll);
            for start in mounted.starts(&poses[0], request.seed_posture, request.seed) {
                match mounted.track(&poses, &start) {
                    Ok(angles) => {
                        let forces = angles.iter().zip(&forces);
                        let comfort = forces
                            .map(|(q, force)| mounted.comfort(q, *force, f64::INFINITY))
                            .fold(f64::INFINITY, f64::min);
                        let outline = Outline {
                            roll,
                            start,
                            comfort,
                        };
                        ways.push((outline, angles));
                    }
                    Err(stop) if farthest.as_ref().is_none_or(|other| stop.0 > other.0) => {
                        farthest = Some(stop);
                    }
                    Err(_) => (),
                }
            }
        }
        let rank = |way: &Outline| {
            let away = request.seed_posture.map_or(0.0, |posture| {
                let pairs = posture.iter().zip(&way.start);
                pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            });
            ((way.comfort.min(1.0) - 10.0 * away) / 1e-9).round()
        };
        ways.sort_by(|(a, _), (b, _)| rank(b).total_cmp(&rank(a)));
        (ways, farthest)
    }

    /// How many ways of a job with its part somewhere else are chosen from; they are the same as those that all are gone to their end for.
    fn compared(setup: &Setup, shift: DVec3, roll: Option<f64>) -> usize {
        let own = setup.stance();
        let mut stance = Stance { roll, ..own };
        stance.world_from_part.translation += shift;
        let collision = setup.collision.with_part_at(stance.world_from_part);
        let request = PlanRequest {
            briefly: true,
            ..setup.request(&stance, &collision, setup.tool_path(&stance).unwrap())
        };
        let (ways, farthest) = all_ways(&request);
        let coarse = Coarse::new(&request);
        let passable = |(_, angles): &&(Outline, Vec<Vec<f64>>)| {
            collisions::passable(&request, &coarse, angles)
        };
        let expected: Vec<&Outline> = ways.iter().filter(passable).map(|way| &way.0).collect();
        let mut choice = Choice::new(&request);
        for outline in &expected {
            let found = choice.next().unwrap();
            assert_eq!((found.roll, &found.start), (outline.roll, &outline.start));
            assert!((found.comfort - outline.comfort).abs() < 1e-12);
        }
        assert_eq!(choice.next(), None);
        let blocked =
            (ways.first()).and_then(|(_, angles)| collisions::blockade(&request, &coarse, angles));
        let farthest = farthest.map(|(pose, stop)| (pose, MountedArm::of(&request).why(stop)));
        if expected.is_empty()
            && let Some((pose, obstacle)) = blocked.or(farthest)
        {
            let failure = coarse.failure(&request, pose, obstacle);
            assert_eq!(choice.failure().to_string(), failure.to_string());
        }
        expected.len()
    }

    fn setup(scenario: &str) -> Setup {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios");
        Setup::load(load(&file.join(scenario)).unwrap()).unwrap()
    }

    #[test]
    fn ways_come_in_the_order_of_their_comfort_though_few_are_gone_to_their_end() {
        let plate = setup("plate_edge_ideal.toml");
        let mut counts = Vec::new();
        for (x, y) in [(0.0, 0.0), (0.2, 0.1), (-0.2, -0.4), (0.4, 0.3), (0.9, 0.0)] {
            counts.push(compared(&plate, DVec3::new(x, y, 0.0), None));
        }
        assert!(counts[0] > 8 && counts.contains(&0), "{counts:?}");
        // Of one roll; some of its ways end before their last pose.
        assert!(compared(&plate, DVec3::ZERO, Some(0.5)) < counts[0]);
        let seeded = setup("tilted_wrist.toml");
        compared(&seeded, DVec3::ZERO, None);
    }

    #[test]
    fn the_first_way_costs_a_part_of_all() {
        let plate = setup("plate_edge_ideal.toml");
        let stance = plate.stance();
        let path = plate.tool_path(&stance).unwrap();
        let request = plate.request(&stance, &plate.collision, path);
        let gone =
            |choice: &Choice| -> usize { choice.ways.iter().map(|way| way.angles.len()).sum() };
        let mut choice = Choice::new(&request);
        choice.next().unwrap();
        let first = gone(&choice);
        while choice.next().is_some() {}
        assert!(3 * first < gone(&choice), "{first} of {}", gone(&choice));
    }
}

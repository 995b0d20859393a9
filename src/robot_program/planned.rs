//! A cell's plan as moves.

use glam::DVec3;
use glamx::DPose3;

use super::dialect::Dialect;
use super::error::ProgramError;
use super::moves::{Configuration, Frame, Move, Program, Step, Target, Timing, Way, Zone};
use super::orientation::of_yaw_pitch_roll;
use super::output::Output;
use super::posture::{Posture, axes, configuration};
use crate::arm::chain::{JointKind, MAX_JOINTS};
use crate::arm::kinematics::{link_poses, tip_pose};
use crate::arm::urdf::{ArmError, fixed_frame};
use crate::cell::{Cell, CellError};
use crate::listed::listed;
use crate::path::{Phase, Stretch};
use crate::scenario::RobotMaker;

/// Interval at which the plan is looked at [s].
const INTERVAL: f64 = 4e-3;
/// Greatest distance of the plan from a line between two moves [m], angle [rad], and the same of joint angles [rad].
const OFF: [f64; 3] = [1e-5, 3e-4, 2e-5];
/// Greatest distance along it, of joint angles in step [rad].
const LATE: f64 = 1e-3;
/// Share by which the speed may change within a line on the edge [1], from a length of it on [m].
const EVEN: (f64, f64) = (0.01, 2e-3);
/// Widest corner on the edge, and off it [m]; never more than a share of the shorter line beside it [1].
const CORNER: [f64; 2] = [1e-3, 5e-3];
const CORNER_SHARE: f64 = 0.4;
/// Length below which a last piece is no move of its own [m].
const SHORTEST: f64 = 2e-5;
/// Speed of the first move, from wherever the arm stands: share of the axes' greatest speed [1], of the leading axis [rad/s].
const FIRST: (f64, f64) = (0.1, 0.2);

listed! {
    /// How moves are given.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Moves: 2,
    /// Its name on the command line.
    name: &'static str {
        /// As poses of the tool in the part's frame, on lines.
        Cartesian = "cartesian",
        /// As joint angles, each move with its time.
        Joint = "joint",
    }
}

/// The plan at a time.
struct Sample {
    time: f64,
    joints: [f64; 6],
    /// The tool in the part's frame.
    pose: DPose3,
}

/// What moves are made of.
struct Planner<'a> {
    cell: &'a Cell,
    dialect: Dialect,
    moves: Moves,
    /// Joint 3 as the controller counts it has so much of joint 2.
    coupling: f64,
    base_from_world: DPose3,
    part_from_world: DPose3,
    tip_from_tool: DPose3,
}

/// The program of a cell in a dialect.
///
/// # Errors
/// What the dialect cannot say, and the way out.
pub fn planned(
    cell: &Cell,
    name: &str,
    dialect: Dialect,
    moves: Moves,
) -> Result<Program, ProgramError> {
    check(cell, dialect)?;
    let scenario = &cell.setup.scenario;
    let coupling = scenario.program.joint_3_by_2;
    if coupling.is_none() && dialect == Dialect::FanucLs && moves == Moves::Joint {
        return Err(ProgramError::Coupling {
            file: scenario.path.clone(),
        });
    }
    let output = Output::of(cell, dialect)?;
    let world_from_base = scenario.arm.world_from_base * base(cell)?;
    let world_from_part = scenario.workpiece.world_from_part;
    let mounting = &scenario.nominal.mounting;
    let distance = mounting.tool_centre + scenario.process.working_stroke;
    let planner = Planner {
        cell,
        dialect,
        moves,
        coupling: coupling.unwrap_or(0.0),
        base_from_world: world_from_base.inverse(),
        part_from_world: world_from_part.inverse(),
        tip_from_tool: DPose3::from_translation(DVec3::Z * distance),
    };
    let frame = |pose: DPose3| Frame {
        name: String::new(),
        pose: Some(pose),
    };
    let flange_from_tip = flange(cell)?;
    let (housing, moving) = (mounting.housing_mass, scenario.nominal.device.moving_mass);
    let mass = housing + moving;
    let along = (housing * mounting.housing_centre_of_mass
        + moving * (scenario.process.working_stroke + mounting.moving_centre_of_mass))
        / mass.max(1e-9);
    let centre = flange_from_tip.transform_point(DVec3::Z * along).to_array();
    let mut steps = vec![
        Step::Note(format!(
            "idc {}: {}",
            env!("CARGO_PKG_VERSION"),
            one_line(&scenario.title)
        )),
        Step::Load { mass, centre },
        Step::Tool(frame(flange_from_tip * planner.tip_from_tool)),
        Step::Frame(frame(planner.base_from_world * world_from_part)),
    ];
    planner.steps(&output, &mut steps)?;
    Ok(Program {
        name: short(name, dialect),
        steps,
    })
}

/// A title without what would end a comment.
fn one_line(text: &str) -> String {
    let plain = |c: char| {
        if c.is_ascii_alphanumeric() || " .,-+()".contains(c) {
            c
        } else {
            ' '
        }
    };
    text.chars()
        .map(plain)
        .collect::<String>()
        .trim()
        .to_owned()
}

/// A name that all controllers take: letters, digits and underscores, at most 24.
fn short(name: &str, dialect: Dialect) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let name: String = name.chars().map(plain).collect();
    let name = match name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        true => name,
        false => format!("p{name}"),
    };
    let name: String = name.chars().take(24).collect();
    match dialect {
        Dialect::FanucLs | Dialect::Krl => name.to_ascii_uppercase(),
        Dialect::Urscript | Dialect::Rapid => name,
    }
}

/// Whether the dialect is for such an arm.
fn check(cell: &Cell, dialect: Dialect) -> Result<(), ProgramError> {
    let (scenario, chain) = (&cell.setup.scenario, &cell.setup.arm.chain);
    let file = || scenario.path.clone();
    if let Some(slide) = chain
        .joints
        .iter()
        .find(|joint| joint.kind == JointKind::Prismatic)
    {
        return Err(ProgramError::Slides {
            file: file(),
            dialect: dialect.name(),
            axis: slide.name.clone(),
        });
    }
    if chain.len() != 6 {
        return Err(ProgramError::Axes {
            file: file(),
            dialect: dialect.name(),
            axes: chain.len(),
        });
    }
    let robot = &cell.setup.arm.name;
    let maker = match scenario.program.maker {
        Some(RobotMaker::UniversalRobots) => Some("Universal Robots"),
        Some(RobotMaker::Kuka) => Some("KUKA"),
        Some(RobotMaker::Abb) => Some("ABB"),
        Some(RobotMaker::Fanuc) => Some("FANUC"),
        None => maker_of(robot),
    };
    match maker {
        Some(maker) if maker != dialect.maker() => {
            let own = Dialect::ALL.into_iter().find(|own| own.maker() == maker);
            Err(ProgramError::Maker {
                file: file(),
                robot: robot.clone(),
                maker,
                dialect: dialect.name(),
                of: dialect.maker(),
                way_out: match own {
                    Some(own) => format!("--dialect {}", own.name()),
                    None => {
                        "no --dialect: trajectory.csv and trajectory.mcap are written for every arm"
                            .to_owned()
                    }
                },
            })
        }
        _ => Ok(()),
    }
}

/// The maker of a robot by the words of its name.
fn maker_of(name: &str) -> Option<&'static str> {
    /// Beginnings of words, and whether a digit has to follow.
    const KNOWN: [(&str, bool, &str); 22] = [
        ("ur", true, "Universal Robots"),
        ("universal", false, "Universal Robots"),
        ("kuka", false, "KUKA"),
        ("kr", true, "KUKA"),
        ("lbr", false, "KUKA"),
        ("iiwa", false, "KUKA"),
        ("abb", false, "ABB"),
        ("irb", true, "ABB"),
        ("crb", true, "ABB"),
        ("fanuc", false, "FANUC"),
        ("lrmate", false, "FANUC"),
        ("crx", true, "FANUC"),
        ("panda", false, "Franka"),
        ("franka", false, "Franka"),
        ("fr3", false, "Franka"),
        ("motoman", false, "Yaskawa"),
        ("yaskawa", false, "Yaskawa"),
        ("staubli", false, "Staubli"),
        ("kawasaki", false, "Kawasaki"),
        ("doosan", false, "Doosan"),
        ("xarm", false, "UFACTORY"),
        ("kinova", false, "Kinova"),
    ];
    let name = name.to_ascii_lowercase();
    let words = name.split(|c: char| !c.is_ascii_alphanumeric());
    words.into_iter().find_map(|word| {
        let is = |&&(begins, digit, _): &&(&str, bool, &str)| {
            let rest = word.strip_prefix(begins);
            rest.is_some_and(|rest| !digit || rest.starts_with(|c: char| c.is_ascii_digit()))
        };
        KNOWN.iter().find(is).map(|&(_, _, maker)| maker)
    })
}

/// The controller's base in the arm's: as the scenario gives it, else the URDF's link `base`, as ROS-Industrial has it.
fn base(cell: &Cell) -> Result<DPose3, ProgramError> {
    let scenario = &cell.setup.scenario;
    let (arm, table) = (&scenario.arm, &scenario.program);
    if table.base_position.is_some() || table.base_rotation.is_some() {
        let turn = table.base_rotation.unwrap_or_default();
        return Ok(DPose3::from_parts(
            table.base_position.unwrap_or_default(),
            of_yaw_pitch_roll([turn.z, turn.y, turn.x]),
        ));
    }
    let found = fixed_frame(&arm.urdf, arm.base_link.as_deref(), "base").map_err(of_arm)?;
    Ok(found.unwrap_or(DPose3::IDENTITY))
}

/// The device's mount in the controller's flange: the URDF's link `tool0`, as ROS-Industrial has it, else the scenario's flange link.
fn flange(cell: &Cell) -> Result<DPose3, ProgramError> {
    let arm = &cell.setup.scenario.arm;
    let mounted = DPose3::from_rotation(arm.flange_from_mount);
    let found = fixed_frame(&arm.urdf, Some(&arm.flange_link), "tool0").map_err(of_arm)?;
    Ok(found.map_or(mounted, |link_from_flange| {
        link_from_flange.inverse() * mounted
    }))
}

fn of_arm(error: ArmError) -> ProgramError {
    ProgramError::Cell(Box::new(CellError::from(error)))
}

impl Planner<'_> {
    fn steps(&self, output: &Output, steps: &mut Vec<Step>) -> Result<(), ProgramError> {
        let mut pass = None;
        let set = |value: f64| Step::Output {
            output: output.name.clone(),
            value,
        };
        for stretch in self.cell.plan.stretches() {
            let samples = self.samples(stretch);
            if pass != Some(stretch.pass) {
                steps.push(set(output.passes[stretch.pass]));
                if pass.is_none() {
                    steps.push(Step::Move(self.first(&samples[0])?));
                }
                pass = Some(stretch.pass);
            }
            let name = stretch.phase.name();
            steps.push(Step::Note(format!("pass {}: {name}", stretch.pass + 1)));
            self.stretch(stretch.phase, &samples, steps)?;
            let rest = stretch.end - stretch.at_rest;
            if rest > 1e-9 {
                steps.push(Step::Wait(rest));
            }
        }
        steps.push(set(output.idle));
        Ok(())
    }

    /// The plan over a stretch, first and last time included.
    fn samples(&self, stretch: Stretch) -> Vec<Sample> {
        let span = stretch.at_rest - stretch.start;
        let count = (span / INTERVAL).ceil().max(1.0) as usize;
        // The end belongs to the stretch that ends there.
        let last = 1e-9 * span;
        let arm = &self.cell.setup.arm.chain;
        let world_from_base = self.cell.setup.scenario.arm.world_from_base;
        let sample = |index: usize| {
            let time =
                (stretch.start + span * index as f64 / count as f64).min(stretch.at_rest - last);
            let mut joints = [0.0; 6];
            joints.copy_from_slice(&self.cell.plan.reference(time).position[..6]);
            let tip = tip_pose(arm, world_from_base, &joints);
            Sample {
                time,
                joints,
                pose: self.part_from_world * tip * self.tip_from_tool,
            }
        };
        (0..=count).map(sample).collect()
    }

    /// The move to where the job starts, from wherever the arm stands.
    fn first(&self, sample: &Sample) -> Result<Move, ProgramError> {
        let by_joints = self.moves == Moves::Joint || self.dialect == Dialect::Urscript;
        Ok(Move {
            way: Way::Joint,
            target: match by_joints {
                true => Target::Joints(self.counted(&sample.joints)),
                false => self.pose(sample)?,
            },
            timing: Some(match self.dialect {
                Dialect::Urscript => Timing::Turning(FIRST.1),
                Dialect::Krl | Dialect::FanucLs => Timing::Share(FIRST.0),
                Dialect::Rapid => Timing::Speed(FIRST.0),
            }),
            zone: Zone::Stop,
        })
    }

    fn stretch(
        &self,
        phase: Phase,
        samples: &[Sample],
        steps: &mut Vec<Step>,
    ) -> Result<(), ProgramError> {
        // FANUC's moves of axes have times in thousandths alone: its joint angles are gone to on lines.
        let timed = self.moves == Moves::Joint && self.dialect != Dialect::FanucLs;
        let mut ends = ends(samples, |from, to| match self.moves {
            Moves::Cartesian => is_line(&samples[from..=to], phase == Phase::Follow),
            Moves::Joint => is_in_step(&samples[from..=to], timed),
        });
        let widest = CORNER[usize::from(phase != Phase::Follow)];
        let length = |from: usize, to: usize| {
            (samples[to].pose.translation - samples[from].pose.translation).length()
        };
        // A last piece of next to nothing belongs to the one before it.
        if let [.., before, last] = ends[..]
            && length(before, last) < SHORTEST
        {
            ends.remove(ends.len() - 2);
        }
        let mut from = 0;
        for (index, &to) in ends.iter().enumerate() {
            let zone = match ends.get(index + 1) {
                None => Zone::Stop,
                Some(&next) => {
                    let shorter = length(from, to).min(length(to, next));
                    // In whole micrometres, as all dialects have them.
                    self.zone(
                        (1e6 * widest.min(CORNER_SHARE * shorter)).floor() / 1e6,
                        timed,
                    )
                }
            };
            let timing = match timed {
                true => Timing::Duration(samples[to].time - samples[from].time),
                false => Timing::Speed(peak(&samples[from..=to])),
            };
            steps.push(Step::Move(Move {
                way: if timed { Way::Joint } else { Way::Line },
                target: match self.moves {
                    Moves::Joint => Target::Joints(self.counted(&samples[to].joints)),
                    Moves::Cartesian => self.pose(&samples[to])?,
                },
                timing: Some(timing),
                zone,
            }));
            from = to;
        }
        Ok(())
    }

    /// A corner, as the dialect says it.
    fn zone(&self, radius: f64, timed: bool) -> Zone {
        match self.dialect {
            Dialect::FanucLs => Zone::Share(1.0),
            Dialect::Krl if timed => Zone::Through,
            _ if radius > 0.0 => Zone::Within(radius),
            _ => Zone::Stop,
        }
    }

    /// Joint angles as the controller counts them.
    fn counted(&self, joints: &[f64; 6]) -> [f64; 6] {
        let mut counted = *joints;
        counted[2] += self.coupling * joints[1];
        counted
    }

    fn pose(&self, sample: &Sample) -> Result<Target, ProgramError> {
        let configuration = match self.dialect {
            Dialect::Urscript => None,
            _ => self.configuration(&sample.joints)?,
        };
        Ok(Target::Pose {
            pose: sample.pose,
            configuration,
        })
    }

    fn configuration(&self, joints: &[f64; 6]) -> Result<Option<Configuration>, ProgramError> {
        let setup = &self.cell.setup;
        let chain = &setup.arm.chain;
        let mut links = [DPose3::IDENTITY; MAX_JOINTS];
        let base_from_arm = self.base_from_world * setup.scenario.arm.world_from_base;
        link_poses(chain, base_from_arm, joints, &mut links[..6]);
        let placed: Vec<(DPose3, DVec3)> = (links.iter().zip(&chain.joints))
            .map(|(link, joint)| (*link, joint.axis))
            .collect();
        let found = axes(&placed).ok_or("it has not six axes");
        let posture = found.and_then(|axes| Posture::of(&axes, joints[0]));
        let found = posture.and_then(|posture| configuration(self.dialect, posture, joints));
        found.map_err(|reason| ProgramError::Configuration {
            file: setup.scenario.path.clone(),
            dialect: self.dialect.name(),
            reason,
        })
    }
}

/// Greatest speed of the tool [m/s].
fn peak(samples: &[Sample]) -> f64 {
    let speed = |two: &[Sample]| {
        (two[1].pose.translation - two[0].pose.translation).length() / (two[1].time - two[0].time)
    };
    // Where the tool turns on the spot, it is still moved on.
    samples.windows(2).map(speed).fold(1e-4, f64::max)
}

/// Ends of the longest pieces that fit, one after the other.
fn ends(samples: &[Sample], fits: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let last = samples.len() - 1;
    let (mut found, mut from) = (Vec::new(), 0);
    while from < last {
        let (mut to, mut step) = (from + 1, 1);
        // Ever longer strides as long as they fit, then ever shorter ones.
        while to + step <= last && fits(from, to + step) {
            to += step;
            step *= 2;
        }
        while step > 0 {
            if to + step <= last && fits(from, to + step) {
                to += step;
            }
            step /= 2;
        }
        found.push(to);
        from = to;
    }
    found
}

/// Whether the tool goes on a line from the first to the last pose, on the edge at an even speed.
fn is_line(samples: &[Sample], on_edge: bool) -> bool {
    let (first, last) = (&samples[0].pose, &samples[samples.len() - 1].pose);
    let way = last.translation - first.translation;
    let length = way.length();
    let turned = first.rotation.angle_between(last.rotation);
    let near = samples.iter().all(|sample| {
        let from = sample.pose.translation - first.translation;
        let share = match length > 1e-6 {
            true => from.dot(way) / (length * length),
            false => sample.pose.rotation.angle_between(first.rotation) / turned.max(1e-9),
        };
        let point = first.translation + way * share.clamp(0.0, 1.0);
        let turn = first.rotation.slerp(last.rotation, share.clamp(0.0, 1.0));
        (sample.pose.translation - point).length() < OFF[0]
            && sample.pose.rotation.angle_between(turn) < OFF[1]
    });
    let is_even = || {
        let speed = |two: &[Sample]| {
            (two[1].pose.translation - two[0].pose.translation).length()
                / (two[1].time - two[0].time)
        };
        let speeds = || samples.windows(2).map(speed);
        let (low, high) = (
            speeds().fold(f64::INFINITY, f64::min),
            speeds().fold(0.0, f64::max),
        );
        length < EVEN.1 || high - low < EVEN.0 * high
    };
    near && (!on_edge || is_even())
}

/// Whether the joints go in step from the first to the last angles, and where times count, evenly.
fn is_in_step(samples: &[Sample], timed: bool) -> bool {
    let (first, last) = (&samples[0], &samples[samples.len() - 1]);
    let way: [f64; 6] = std::array::from_fn(|joint| last.joints[joint] - first.joints[joint]);
    let square: f64 = way.iter().map(|angle| angle * angle).sum();
    let span = last.time - first.time;
    samples.iter().all(|sample| {
        let from: [f64; 6] =
            std::array::from_fn(|joint| sample.joints[joint] - first.joints[joint]);
        let along: f64 = from.iter().zip(&way).map(|(one, other)| one * other).sum();
        let share = along / square.max(1e-18);
        let off = (0..6).map(|joint| (from[joint] - share * way[joint]).abs());
        let late = (share - (sample.time - first.time) / span).abs() * square.sqrt();
        off.fold(0.0, f64::max) < OFF[2] && (!timed || late < LATE)
    })
}

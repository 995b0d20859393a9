//! How far a program that was read back is from what was to be written.

use super::moves::{Frame, Move, Program, Step, Target, Timing, Zone};

/// Greatest differences between two programs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deviation {
    /// Of positions, tools and frames [m].
    pub position: f64,
    /// Of orientations [rad].
    pub angle: f64,
    /// Of joint angles [rad].
    pub joint: f64,
    /// Of speeds and times, as a share [1].
    pub timing: f64,
}

/// A step with the tool and the frame that it is done with.
type Held<'a> = (&'a Step, [Option<&'a Frame>; 2]);

/// Steps that do something.
fn done(program: &Program) -> Vec<Held<'_>> {
    let mut held = [None; 2];
    let mut found = Vec::new();
    for step in &program.steps {
        match step {
            Step::Tool(frame) => held[0] = Some(frame),
            Step::Frame(frame) => held[1] = Some(frame),
            // The dialects say of a load what they can.
            Step::Note(_) | Step::Load { .. } => {}
            Step::Move(_) | Step::Output { .. } | Step::Wait(_) => found.push((step, held)),
        }
    }
    found
}

/// The greatest differences of moves, with their tools and frames, outputs and waits, or the first of them that one of the two has not.
///
/// # Errors
/// What is not the same, in words.
pub fn deviation(written: &Program, read: &Program) -> Result<Deviation, String> {
    let mut found = Deviation::default();
    let (ours, theirs) = (done(written), done(read));
    if ours.len() != theirs.len() {
        return Err(format!("{} steps, not {}", theirs.len(), ours.len()));
    }
    for (index, (one, other)) in ours.into_iter().zip(theirs).enumerate() {
        found
            .steps(one, other)
            .map_err(|what| format!("step {}: {what}", index + 1))?;
    }
    Ok(found)
}

/// Greatest difference of an output's values [1], of those that count in ones, and of waits [s].
const VALUE: [f64; 2] = [1e-5, 0.51];
const WAIT: f64 = 0.006;

impl Deviation {
    fn steps(
        &mut self,
        (one, with): Held<'_>,
        (other, read): Held<'_>,
    ) -> Result<(), &'static str> {
        match (one, other) {
            (Step::Move(one), Step::Move(other)) => {
                // Joint angles need no frame.
                let counts = usize::from(matches!(one.target, Target::Pose { .. })) + 1;
                for (with, read) in with.iter().zip(&read).take(counts) {
                    match (with, read) {
                        (Some(with), Some(read)) => self.frames(with, read)?,
                        (None, None) => {}
                        _ => return Err("another tool or frame"),
                    }
                }
                self.moves(one, other)
            }
            (
                Step::Output { output, value },
                Step::Output {
                    output: name,
                    value: back,
                },
            ) => {
                let most = VALUE[usize::from(value.abs() > 10.0)];
                match output == name && (value - back).abs() <= most {
                    true => Ok(()),
                    false => Err("another output"),
                }
            }
            (Step::Wait(time), Step::Wait(back)) if (time - back).abs() <= WAIT => Ok(()),
            (Step::Wait(_), Step::Wait(_)) => Err("another wait"),
            _ => Err("another kind of step"),
        }
    }

    fn frames(&mut self, one: &Frame, other: &Frame) -> Result<(), &'static str> {
        let (Some(one), Some(other)) = (one.pose, other.pose) else {
            return Err("a frame without a pose");
        };
        let distance = (one.translation - other.translation).length();
        self.position = self.position.max(distance);
        // The angle by its sine, exact where it is small.
        let turned = one.rotation.inverse() * other.rotation;
        let angle = 2.0 * turned.xyz().length().min(1.0).asin();
        self.angle = self.angle.max(angle);
        Ok(())
    }

    fn moves(&mut self, one: &Move, other: &Move) -> Result<(), &'static str> {
        if one.way != other.way {
            return Err("another way");
        }
        match (&one.target, &other.target) {
            (Target::Joints(one), Target::Joints(other)) => {
                for (one, other) in one.iter().zip(other) {
                    self.joint = self.joint.max((one - other).abs());
                }
            }
            (
                Target::Pose {
                    pose,
                    configuration,
                },
                Target::Pose {
                    pose: read,
                    configuration: other,
                },
            ) => {
                let frame = |pose| Frame {
                    name: String::new(),
                    pose: Some(pose),
                };
                self.frames(&frame(*pose), &frame(*read))?;
                if configuration != other {
                    return Err("another configuration");
                }
            }
            _ => return Err("joints in place of a pose, or the other way round"),
        }
        if one.zone != other.zone {
            let near = match (one.zone, other.zone) {
                (Zone::Within(one), Zone::Within(other)) => (one - other).abs() < 1e-6,
                _ => false,
            };
            if !near {
                return Err("another zone");
            }
        }
        let ((Some(Timing::Speed(one)), Some(Timing::Speed(other)))
        | (Some(Timing::Turning(one)), Some(Timing::Turning(other)))
        | (Some(Timing::Duration(one)), Some(Timing::Duration(other)))
        | (Some(Timing::Share(one)), Some(Timing::Share(other)))) = (one.timing, other.timing)
        else {
            return Err("another kind of speed");
        };
        self.timing = self.timing.max((one - other).abs() / one);
        Ok(())
    }
}

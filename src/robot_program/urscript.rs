//! URScript, the language of Universal Robots.
//!
//! After "The URScript Programming Language", Universal Robots, for e-Series, software 5.11
//! (<https://www.universal-robots.com/download/manuals-e-seriesur-series/script/script-manual-e-series-sw-511/>):
//! section "Module motion" (`movej`, `movel`, `movep`: q, a, v, t, r; `set_tcp`), "Module internals" (`set_target_payload`, `sleep`), "Module urmath" (`pose_trans`),
//! "Module interfaces" (`set_standard_analog_out`: 0 to 1; `set_analog_outputdomain`: 1 is volts). A pose is p[x, y, z, rx, ry, rz] in metres and the rotation vector in
//! radians. A pose says nothing of a posture: the first move goes to joint angles, and lines keep it.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glam::{DQuat, DVec3};
use glamx::DPose3;

use super::error::ProgramError;
use super::moves::{Frame, Move, Program, Step, Target, Timing, Way, Zone};
use super::orientation::{fixed, list};
use super::words::{Line, Token};
use crate::path::rotation_vector;

/// Digits behind the point of metres and radians.
const DIGITS: usize = 8;
/// Acceleration of moves of the axes [rad/s2], and of lines [m/s2]: those that the manual has where none is given.
const ACCELERATION: [&str; 2] = ["1.4", "1.2"];
/// Calls that move nothing.
const STILL: [&str; 13] = [
    "textmsg",
    "popup",
    "sync",
    "set_analog_outputdomain",
    "set_standard_digital_out",
    "set_configurable_digital_out",
    "set_tool_digital_out",
    "set_digital_out",
    "set_tool_voltage",
    "set_gravity",
    "stopj",
    "stopl",
    "halt",
];

/// The text of a program.
pub(super) fn write(program: &Program) -> String {
    let mut text = format!("def {}():\n", program.name);
    let mut framed = false;
    for step in &program.steps {
        let line = match step {
            Step::Note(note) => format!("# {note}"),
            Step::Load { mass, centre } => format!(
                "set_target_payload({}, [{}])",
                fixed(*mass, 4),
                list(centre, 5)
            ),
            Step::Tool(frame) => format!("set_tcp({})", pose_text(frame)),
            Step::Frame(frame) => {
                framed = true;
                format!("part = {}", pose_text(frame))
            }
            Step::Output { output, value } => format!(
                "set_analog_outputdomain({output}, 1)\n  set_standard_analog_out({output}, {})",
                fixed(*value, 5)
            ),
            Step::Wait(time) => format!("sleep({})", fixed(*time, 4)),
            Step::Move(one) => move_text(one, framed),
        };
        // Writing into a text cannot fail.
        let _ = writeln!(text, "  {line}");
    }
    let _ = writeln!(text, "end\n{}()", program.name);
    text
}

fn pose_text(frame: &Frame) -> String {
    let pose = frame.pose.unwrap_or(DPose3::IDENTITY);
    let turn = rotation_vector(pose.rotation);
    let values = [pose.translation.to_array(), turn.to_array()].concat();
    format!("p[{}]", list(&values, DIGITS))
}

fn move_text(one: &Move, framed: bool) -> String {
    let (name, acceleration) = match one.way {
        Way::Joint => ("movej", ACCELERATION[0]),
        Way::Line => ("movel", ACCELERATION[1]),
    };
    let target = match &one.target {
        Target::Joints(joints) => format!("[{}]", list(joints, DIGITS)),
        Target::Pose { pose, .. } => {
            let pose = pose_text(&Frame {
                name: String::new(),
                pose: Some(*pose),
            });
            match framed {
                true => format!("pose_trans(part, {pose})"),
                false => pose,
            }
        }
    };
    let timing = match one.timing {
        Some(Timing::Speed(speed) | Timing::Turning(speed)) => format!(", v={}", fixed(speed, 6)),
        Some(Timing::Duration(time)) => format!(", t={}", fixed(time, 6)),
        Some(Timing::Share(_)) | None => String::new(),
    };
    let zone = match one.zone {
        Zone::Within(radius) => format!(", r={}", fixed(radius, 6)),
        Zone::Stop | Zone::Share(_) | Zone::Through => String::new(),
    };
    format!("{name}({target}, a={acceleration}{timing}{zone})")
}

/// A value of the language, as far as moves have them.
#[derive(Debug, Clone, PartialEq)]
enum Value {
    Number(f64),
    Joints([f64; 6]),
    /// A pose, and the name of the frame that it is in.
    Pose(DPose3, Option<(String, DPose3)>),
}

/// What has been read so far.
#[derive(Default)]
struct Reader {
    program: Program,
    known: BTreeMap<String, Value>,
    frame: Option<String>,
    defined: Vec<String>,
    open: bool,
}

/// The program of a text.
///
/// # Errors
/// The line that is not understood.
pub(super) fn read(text: &str) -> Result<Program, ProgramError> {
    let mut reader = Reader::default();
    let mut last = 0;
    for (index, line) in text.lines().enumerate() {
        last = index + 1;
        if let Some((_, note)) = line.split_once('#') {
            let note = note.trim();
            if !note.is_empty() {
                reader.program.steps.push(Step::Note(note.to_owned()));
            }
        }
        let mut words = Line::new(last, line, Some('#'))?;
        if !words.is_done() {
            reader.line(&mut words)?;
        }
    }
    match reader.open {
        true => Err(Line::new(last + 1, "", None)?.refuse("`end`")),
        false => Ok(reader.program),
    }
}

impl Reader {
    fn line(&mut self, line: &mut Line) -> Result<(), ProgramError> {
        if line.takes_word("def") {
            let name = line.word("the program's name")?;
            for mark in ['(', ')', ':'] {
                line.mark(mark)?;
            }
            self.defined.push(name.clone());
            self.open = true;
            self.program.name = name;
            return line.end();
        }
        if self.open && line.takes_word("end") {
            self.open = false;
            return line.end();
        }
        line.takes_word("global");
        let before = line.clone();
        let name = line.word("a call or a value")?;
        if line.takes('=') {
            let value = self.value(line)?;
            self.known.insert(name, value);
            return line.end();
        }
        line.mark('(')?;
        match name.as_str() {
            "movej" | "movel" | "movep" => self.motion(line, &name)?,
            "set_tcp" => {
                let pose = self.pose(line)?;
                self.program.steps.push(Step::Tool(Frame {
                    name: String::new(),
                    pose: Some(pose),
                }));
            }
            "sleep" => {
                let time = line.positive(true)?;
                self.program.steps.push(Step::Wait(time));
            }
            "set_target_payload" | "set_payload" => self.load(line)?,
            "set_standard_analog_out" | "set_analog_out" => {
                let output = line.whole()?.to_string();
                line.mark(',')?;
                let value = line.number()?;
                self.program.steps.push(Step::Output { output, value });
            }
            still if STILL.contains(&still) || self.defined.contains(&name) => {
                return skip(line);
            }
            _ => return Err(before.refuse("a call that is known")),
        }
        line.mark(')')?;
        line.end()
    }

    fn load(&mut self, line: &mut Line) -> Result<(), ProgramError> {
        let mass = line.positive(true)?;
        let mut centre = [0.0; 3];
        if line.takes(',') {
            centre = line.numbers()?;
        }
        self.program.steps.push(Step::Load { mass, centre });
        Ok(())
    }

    fn pose(&self, line: &mut Line) -> Result<DPose3, ProgramError> {
        let before = line.clone();
        match self.value(line)? {
            Value::Pose(pose, None) => Ok(pose),
            _ => Err(before.refuse("a pose, p[...]")),
        }
    }

    fn value(&self, line: &mut Line) -> Result<Value, ProgramError> {
        if line.peek() == Some(&Token::Mark('[')) {
            return Ok(Value::Joints(line.numbers()?));
        }
        let before = line.clone();
        let Some(Token::Word(name)) = line.peek().cloned() else {
            return Ok(Value::Number(line.number()?));
        };
        line.take();
        match name.as_str() {
            "p" => {
                let [x, y, z, rx, ry, rz] = line.numbers()?;
                let turn = DQuat::from_scaled_axis(DVec3::new(rx, ry, rz));
                let pose = DPose3::from_parts(DVec3::new(x, y, z), turn);
                Ok(Value::Pose(pose, None))
            }
            "pose_trans" => {
                line.mark('(')?;
                let frame = match line.peek() {
                    Some(Token::Word(name)) if name != "p" => name.clone(),
                    _ => return Err(line.refuse("the name of a frame")),
                };
                let base_from_frame = self.pose(line)?;
                line.mark(',')?;
                let pose = self.pose(line)?;
                line.mark(')')?;
                Ok(Value::Pose(pose, Some((frame, base_from_frame))))
            }
            _ => match self.known.get(&name) {
                Some(value) => Ok(value.clone()),
                None => Err(before.refuse("a value that is known")),
            },
        }
    }

    fn motion(&mut self, line: &mut Line, name: &str) -> Result<(), ProgramError> {
        let target = match self.value(line)? {
            Value::Joints(joints) => Target::Joints(joints),
            Value::Pose(pose, frame) => {
                self.enter(frame);
                Target::Pose {
                    pose,
                    configuration: None,
                }
            }
            Value::Number(_) => return Err(line.refuse("joint angles or a pose before it")),
        };
        let is_joint = name == "movej";
        // movep has no time: its fourth number is the radius.
        let order: &[&str] = if name == "movep" {
            &["a", "v", "r"]
        } else {
            &["a", "v", "t", "r"]
        };
        let mut given = BTreeMap::new();
        let mut named = false;
        while line.takes(',') {
            let before = line.clone();
            let key = match line.peek() {
                Some(Token::Word(word))
                    if order.contains(&word.as_str()) && !self.known.contains_key(word) =>
                {
                    named = true;
                    let word = line.word("a name")?;
                    line.mark('=')?;
                    word
                }
                _ if named => return Err(line.refuse("a name, as v=")),
                _ => order
                    .get(given.len())
                    .map_or_else(|| Err(line.refuse("`)`")), |name| Ok((*name).to_owned()))?,
            };
            let Value::Number(value) = self.value(line)? else {
                return Err(before.refuse("a number"));
            };
            if value < 0.0 || given.insert(key, value).is_some() {
                return Err(before.refuse("each argument once, none below 0"));
            }
        }
        let positive = |key: &str| given.get(key).copied().filter(|value| *value > 0.0);
        let speed = positive("v").map(if is_joint {
            Timing::Turning
        } else {
            Timing::Speed
        });
        self.program.steps.push(Step::Move(Move {
            way: if is_joint { Way::Joint } else { Way::Line },
            target,
            timing: positive("t").map(Timing::Duration).or(speed),
            zone: positive("r").map_or(Zone::Stop, Zone::Within),
        }));
        Ok(())
    }

    /// The frame of the next pose; the base where none is named.
    fn enter(&mut self, frame: Option<(String, DPose3)>) {
        let name = frame.as_ref().map(|(name, _)| name.clone());
        if name != self.frame {
            let (name, pose) = frame.unwrap_or(("base".to_owned(), DPose3::IDENTITY));
            self.program.steps.push(Step::Frame(Frame {
                name,
                pose: Some(pose),
            }));
        }
        self.frame = name;
    }
}

/// The rest of a call that moves nothing, whose brackets must close.
fn skip(line: &mut Line) -> Result<(), ProgramError> {
    let mut depth = 1;
    while depth > 0 {
        match line.take() {
            Some(Token::Mark('(')) => depth += 1,
            Some(Token::Mark(')')) => depth -= 1,
            Some(_) => {}
            None => return Err(line.refuse("`)`")),
        }
    }
    line.end()
}

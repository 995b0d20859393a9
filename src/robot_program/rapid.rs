//! RAPID, the language of ABB.
//!
//! After "Technical reference manual, RAPID Instructions, Functions and Data types", ABB 3HAC050917 (<https://library.abb.com>): instructions MoveAbsJ, MoveJ, MoveL, SetAO, WaitTime;
//! data types confdata, jointtarget, loaddata, orient (q1 to q4, the scalar first), pose, robtarget, speeddata [mm/s, degrees/s], tooldata, wobjdata, zonedata [mm, degrees].
//! Positions are in millimetres, angles in degrees. `\T` gives a move its time [s].

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glam::{DQuat, DVec3};
use glamx::DPose3;

use super::error::ProgramError;
use super::moves::{Configuration, Frame, Move, Program, Step, Target, Timing, Way, Zone};
use super::orientation::{fixed, list};
use super::words::{Line, Token};

/// Digits of millimetres, of degrees and speeds, of quaternions.
const DIGITS: [usize; 3] = [4, 6, 9];
/// External axes that there are not.
const NO_AXES: &str = "[9E9,9E9,9E9,9E9,9E9,9E9]";
/// Greatest deviation of a quaternion's length from 1 [1].
const UNIT: f64 = 1e-3;
/// Words that begin what moves nothing.
const STILL: [&str; 30] = [
    "MODULE",
    "ENDMODULE",
    "ENDPROC",
    "ConfL",
    "ConfJ",
    "SingArea",
    "SetDO",
    "Set",
    "Reset",
    "WaitDI",
    "TPWrite",
    "TPErase",
    "AccSet",
    "VelSet",
    "IF",
    "ENDIF",
    "ELSE",
    "WHILE",
    "ENDWHILE",
    "ActUnit",
    "WaitWObj",
    "DropWObj",
    "StopMove",
    "ClearPath",
    "StartMove",
    "RETURN",
    "WaitUntil",
    "PulseDO",
    "FOR",
    "ENDFOR",
];

/// The text of a program.
pub(super) fn write(program: &Program) -> String {
    let mut load = (0.001, [0.0, 0.0, 0.001]);
    let (mut tool, mut frame) = (DPose3::IDENTITY, DPose3::IDENTITY);
    let mut body = String::new();
    for step in &program.steps {
        let line = match step {
            Step::Note(note) => format!("! {note}"),
            Step::Load { mass, centre } => {
                load = (*mass, *centre);
                continue;
            }
            Step::Tool(given) => {
                tool = given.pose.unwrap_or(tool);
                continue;
            }
            Step::Frame(given) => {
                frame = given.pose.unwrap_or(frame);
                continue;
            }
            Step::Output { output, value } => format!("SetAO {output}, {};", fixed(*value, 5)),
            Step::Wait(time) => format!("WaitTime {};", fixed(*time, 4)),
            Step::Move(one) => move_text(one),
        };
        // Writing into a text cannot fail.
        let _ = writeln!(body, "    {line}");
    }
    let (mass, centre) = load;
    let name = &program.name;
    format!(
        "MODULE {name}_module\n  PERS tooldata {TOOL} := [TRUE,{},[{},[{}],[1,0,0,0],0,0,0]];\n  PERS wobjdata {FRAME} := [FALSE,TRUE,\"\",{},[[0,0,0],[1,0,0,0]]];\n\n  PROC {name}()\n    ConfJ \\On;\n    ConfL \\Off;\n{body}  ENDPROC\nENDMODULE\n",
        pose_text(&tool),
        fixed(mass, 4),
        list(&centre.map(|value| 1e3 * value), 2),
        pose_text(&frame)
    )
}

/// Names of tool and frame that are written.
const TOOL: &str = "tIdc";
const FRAME: &str = "wPart";

fn pose_text(pose: &DPose3) -> String {
    let rotation = match pose.rotation.w < 0.0 {
        true => -pose.rotation,
        false => pose.rotation,
    };
    let [x, y, z, w] = rotation.normalize().to_array();
    let position = (pose.translation * 1e3).to_array();
    format!(
        "[{}],[{}]",
        list(&position, DIGITS[0]),
        list(&[w, x, y, z], DIGITS[2])
    )
    .replacen('[', "[[", 1)
        + "]"
}

fn move_text(one: &Move) -> String {
    let (name, target) = match &one.target {
        Target::Joints(joints) => {
            let angles = joints.map(f64::to_degrees);
            (
                "MoveAbsJ",
                format!("[[{}],{NO_AXES}]", list(&angles, DIGITS[1])),
            )
        }
        Target::Pose {
            pose,
            configuration,
        } => {
            let name = match one.way {
                Way::Joint => "MoveJ",
                Way::Line => "MoveL",
            };
            let [one, four, six, posture] = match configuration {
                Some(Configuration::Quarters {
                    turns: [one, four, six],
                    posture,
                }) => [*one, *four, *six, *posture],
                _ => [0; 4],
            };
            let pose = pose_text(pose);
            let inner = &pose[1..pose.len() - 1];
            (
                name,
                format!("[{inner},[{one},{four},{six},{posture}],{NO_AXES}]"),
            )
        }
    };
    let speed = |speed: f64| format!("[{},500,5000,1000]", fixed(1e3 * speed, 4));
    let timing = match one.timing {
        Some(Timing::Speed(value)) => speed(value),
        Some(Timing::Duration(time)) => format!("v100\\T:={}", fixed(time, 6)),
        Some(Timing::Turning(_) | Timing::Share(_)) | None => "v100".to_owned(),
    };
    let zone = match one.zone {
        Zone::Within(radius) => {
            let radius = fixed(1e3 * radius, 4);
            format!("[FALSE,{radius},{radius},{radius},1,{radius},1]")
        }
        Zone::Through => "z0".to_owned(),
        Zone::Stop | Zone::Share(_) => "fine".to_owned(),
    };
    format!("{name} {target}, {timing}, {zone}, {TOOL}\\WObj:={FRAME};")
}

/// Data of a module by name.
#[derive(Debug, Clone)]
enum Data {
    Target(Target),
    Tool(DPose3, f64, [f64; 3]),
    Frame(DPose3),
    Speed(f64),
    Zone(Zone),
    /// What moves nothing, or is known in the controller alone.
    Other,
}

/// What has been read so far.
#[derive(Default)]
struct Reader {
    program: Program,
    known: BTreeMap<String, Data>,
    tool: Option<String>,
    frame: Option<String>,
    depth: i32,
}

/// The program of a text. A statement may go over lines.
///
/// # Errors
/// The line that is not understood.
pub(super) fn read(text: &str) -> Result<Program, ProgramError> {
    let mut reader = Reader::default();
    let (mut pending, mut first) = (String::new(), 0);
    let mut last = 0;
    for (index, line) in text.lines().enumerate() {
        last = index + 1;
        let (code, note) = line
            .split_once('!')
            .map_or((line, ""), |(code, note)| (code, note.trim()));
        if !note.is_empty() {
            reader.program.steps.push(Step::Note(note.to_owned()));
        }
        if pending.is_empty() {
            first = last;
        }
        pending.push_str(code);
        pending.push(' ');
        while let Some((statement, rest)) = pending.split_once(';') {
            reader.statement(&mut Line::new(first, statement, None)?)?;
            pending = rest.to_owned();
            first = last;
        }
        if is_whole(&pending) {
            reader.statement(&mut Line::new(first, &pending, None)?)?;
            pending.clear();
        }
    }
    if !pending.trim().is_empty() {
        return Err(Line::new(last, "", None)?.refuse("`;`"));
    }
    match reader.depth {
        0 => Ok(reader.program),
        _ => {
            Err(Line::new(last + 1, "", None)?
                .refuse("ENDPROC and ENDMODULE for each PROC and MODULE"))
        }
    }
}

/// Whether a statement needs no semicolon.
fn is_whole(text: &str) -> bool {
    let mut words = text.split_whitespace();
    let first = words.next().unwrap_or_default();
    let last = text.split_whitespace().next_back().unwrap_or_default();
    match first {
        "MODULE" | "ENDMODULE" | "ENDPROC" | "ENDIF" | "ELSE" | "ENDWHILE" | "ENDFOR" | "" => true,
        "PROC" => last.ends_with(')'),
        "IF" => last == "THEN",
        "WHILE" | "FOR" => last == "DO",
        _ => false,
    }
}

impl Reader {
    fn statement(&mut self, line: &mut Line) -> Result<(), ProgramError> {
        if line.is_done() {
            return Ok(());
        }
        let before = line.clone();
        let word = line.word("an instruction or data")?;
        match word.as_str() {
            "MODULE" | "PROC" => {
                self.depth += 1;
                let name = line.word("a name")?;
                if word == "PROC" && self.program.name.is_empty() {
                    self.program.name = name;
                }
                return Ok(());
            }
            "ENDMODULE" | "ENDPROC" => {
                self.depth -= 1;
                return line.end();
            }
            "CONST" | "PERS" | "VAR" | "TASK" | "LOCAL" => return self.declaration(line),
            "MoveAbsJ" | "MoveJ" | "MoveL" => self.motion(line, &word)?,
            "WaitTime" => {
                let time = line.positive(true)?;
                self.program.steps.push(Step::Wait(time));
            }
            "SetAO" => {
                let output = line.word("the name of a signal")?;
                line.mark(',')?;
                let value = line.number()?;
                self.program.steps.push(Step::Output { output, value });
            }
            still if STILL.contains(&still) => return Ok(()),
            // A call of a procedure.
            _ if line.is_done() && !word.starts_with("Move") => return Ok(()),
            _ => return Err(before.refuse("an instruction that is known")),
        }
        line.end()
    }

    fn declaration(&mut self, line: &mut Line) -> Result<(), ProgramError> {
        line.takes_word("PERS");
        line.takes_word("VAR");
        let kind = line.word("a data type")?;
        let name = line.word("a name")?;
        if line.is_done() {
            self.known.insert(name, Data::Other);
            return Ok(());
        }
        let given = line.takes(':') && line.takes('=');
        let data = match kind.as_str() {
            _ if !given => return Err(line.refuse("`:=`")),
            "robtarget" => Data::Target(robtarget(line)?),
            "jointtarget" => Data::Target(jointtarget(line)?),
            "tooldata" => tooldata(line)?,
            "wobjdata" => wobjdata(line)?,
            "speeddata" => Data::Speed(speeddata(line)?),
            "zonedata" => Data::Zone(zonedata(line)?),
            _ => {
                while line.take().is_some() {}
                Data::Other
            }
        };
        self.known.insert(name, data);
        line.end()
    }

    fn motion(&mut self, line: &mut Line, word: &str) -> Result<(), ProgramError> {
        let is_list = line.peek() == Some(&Token::Mark('['));
        let before = line.clone();
        let target = match (word, is_list) {
            ("MoveAbsJ", true) => jointtarget(line)?,
            (_, true) => robtarget(line)?,
            _ => match self.known.get(&line.word("a target")?) {
                Some(Data::Target(target)) => target.clone(),
                _ => return Err(before.refuse("a target that is known")),
            },
        };
        if (word == "MoveAbsJ") != matches!(target, Target::Joints(_)) {
            return Err(before.refuse("a jointtarget with MoveAbsJ, a robtarget else"));
        }
        if line.takes('\\') {
            line.word("NoEOffs")?;
        }
        line.mark(',')?;
        let mut timing = Timing::Speed(self.speed(line)?);
        if line.takes('\\') {
            let before = line.clone();
            let kind = line.word("T or V")?;
            line.mark(':')?;
            line.mark('=')?;
            let value = line.positive(false)?;
            timing = match kind.as_str() {
                "T" => Timing::Duration(value),
                "V" => Timing::Speed(1e-3 * value),
                _ => return Err(before.refuse("T or V")),
            };
        }
        line.mark(',')?;
        let zone = self.zone(line)?;
        line.mark(',')?;
        let tool = line.word("a tool")?;
        let frame = match line.takes('\\') {
            true => {
                if !line.takes_word("WObj") {
                    return Err(line.refuse("WObj"));
                }
                line.mark(':')?;
                line.mark('=')?;
                line.word("a work object")?
            }
            false => "wobj0".to_owned(),
        };
        self.enter(tool, frame);
        self.program.steps.push(Step::Move(Move {
            way: if word == "MoveL" {
                Way::Line
            } else {
                Way::Joint
            },
            target,
            timing: Some(timing),
            zone,
        }));
        Ok(())
    }

    /// Tool and frame of the next move.
    fn enter(&mut self, tool: String, frame: String) {
        if self.tool.as_ref() != Some(&tool) {
            let pose = match self.known.get(&tool) {
                Some(&Data::Tool(pose, mass, centre)) => {
                    self.program.steps.push(Step::Load { mass, centre });
                    Some(pose)
                }
                _ => (tool == "tool0").then_some(DPose3::IDENTITY),
            };
            self.program.steps.push(Step::Tool(Frame {
                name: tool.clone(),
                pose,
            }));
        }
        if self.frame.as_ref() != Some(&frame) {
            let pose = match self.known.get(&frame) {
                Some(&Data::Frame(pose)) => Some(pose),
                _ => frame
                    .eq_ignore_ascii_case("wobj0")
                    .then_some(DPose3::IDENTITY),
            };
            self.program.steps.push(Step::Frame(Frame {
                name: frame.clone(),
                pose,
            }));
        }
        (self.tool, self.frame) = (Some(tool), Some(frame));
    }

    fn speed(&self, line: &mut Line) -> Result<f64, ProgramError> {
        if line.peek() == Some(&Token::Mark('[')) {
            return speeddata(line);
        }
        let before = line.clone();
        let name = line.word("a speed")?;
        let usual = || {
            name.strip_prefix('v')
                .and_then(|digits| digits.parse::<u32>().ok())
        };
        match self.known.get(&name) {
            Some(Data::Speed(speed)) => Ok(*speed),
            None => match usual() {
                Some(speed) if (5..=7000).contains(&speed) => Ok(1e-3 * f64::from(speed)),
                _ => Err(before.refuse("a speed that is known")),
            },
            Some(_) => Err(before.refuse("a speed that is known")),
        }
    }

    fn zone(&self, line: &mut Line) -> Result<Zone, ProgramError> {
        if line.peek() == Some(&Token::Mark('[')) {
            return zonedata(line);
        }
        let before = line.clone();
        let name = line.word("a zone")?;
        let usual = || {
            name.strip_prefix('z')
                .and_then(|digits| digits.parse::<u32>().ok())
        };
        match (self.known.get(&name), name.as_str()) {
            (Some(Data::Zone(zone)), _) => Ok(*zone),
            (None, "fine") => Ok(Zone::Stop),
            // The manual's z0 is 0.3 mm wide.
            (None, "z0") => Ok(Zone::Within(0.3e-3)),
            (None, _) => match usual() {
                Some(radius)
                    if matches!(
                        radius,
                        1 | 5 | 10 | 15 | 20 | 30 | 40 | 50 | 60 | 80 | 100 | 150 | 200
                    ) =>
                {
                    Ok(Zone::Within(1e-3 * f64::from(radius)))
                }
                _ => Err(before.refuse("a zone that is known")),
            },
            (Some(_), _) => Err(before.refuse("a zone that is known")),
        }
    }
}

/// `[position, orientation]` without its outer brackets.
fn pose(line: &mut Line) -> Result<DPose3, ProgramError> {
    let [x, y, z] = line.numbers()?;
    line.mark(',')?;
    let before = line.clone();
    let [w, i, j, k] = line.numbers()?;
    let rotation = DQuat::from_xyzw(i, j, k, w);
    if (rotation.length() - 1.0).abs() > UNIT {
        return Err(before.refuse("a quaternion of length 1"));
    }
    Ok(DPose3::from_parts(
        DVec3::new(x, y, z) * 1e-3,
        rotation.normalize(),
    ))
}

fn robtarget(line: &mut Line) -> Result<Target, ProgramError> {
    line.mark('[')?;
    let pose = pose(line)?;
    line.mark(',')?;
    line.mark('[')?;
    let mut values = [0; 4];
    for (index, value) in values.iter_mut().enumerate() {
        if index > 0 {
            line.mark(',')?;
        }
        *value = line.whole()?;
    }
    let [one, four, six, posture] = values;
    if !(0..=7).contains(&posture) {
        return Err(line.refuse("a posture, cfx, of 0 to 7 before it"));
    }
    line.mark(']')?;
    line.mark(',')?;
    line.numbers::<6>()?;
    line.mark(']')?;
    let turns = [one, four, six];
    Ok(Target::Pose {
        pose,
        configuration: Some(Configuration::Quarters { turns, posture }),
    })
}

fn jointtarget(line: &mut Line) -> Result<Target, ProgramError> {
    line.mark('[')?;
    let joints: [f64; 6] = line.numbers()?;
    line.mark(',')?;
    line.numbers::<6>()?;
    line.mark(']')?;
    Ok(Target::Joints(joints.map(f64::to_radians)))
}

fn truth(line: &mut Line) -> Result<bool, ProgramError> {
    match (line.takes_word("TRUE"), line.takes_word("FALSE")) {
        (true, _) => Ok(true),
        (_, true) => Ok(false),
        _ => Err(line.refuse("TRUE or FALSE")),
    }
}

fn tooldata(line: &mut Line) -> Result<Data, ProgramError> {
    line.mark('[')?;
    truth(line)?;
    line.mark(',')?;
    line.mark('[')?;
    let pose = pose(line)?;
    line.mark(']')?;
    line.mark(',')?;
    line.mark('[')?;
    let mass = line.positive(true)?;
    line.mark(',')?;
    let centre: [f64; 3] = line.numbers()?;
    line.mark(',')?;
    line.numbers::<4>()?;
    for _ in 0..3 {
        line.mark(',')?;
        line.positive(true)?;
    }
    line.mark(']')?;
    line.mark(']')?;
    Ok(Data::Tool(pose, mass, centre.map(|value| 1e-3 * value)))
}

fn wobjdata(line: &mut Line) -> Result<Data, ProgramError> {
    line.mark('[')?;
    truth(line)?;
    line.mark(',')?;
    truth(line)?;
    line.mark(',')?;
    line.text("the name of a unit, or \"\"")?;
    let mut whole = DPose3::IDENTITY;
    // The user's frame, then the object's in it.
    for _ in 0..2 {
        line.mark(',')?;
        line.mark('[')?;
        whole *= pose(line)?;
        line.mark(']')?;
    }
    line.mark(']')?;
    Ok(Data::Frame(whole))
}

fn speeddata(line: &mut Line) -> Result<f64, ProgramError> {
    let before = line.clone();
    let [speed, turning, ..]: [f64; 4] = line.numbers()?;
    match speed > 0.0 && turning > 0.0 {
        true => Ok(1e-3 * speed),
        false => Err(before.refuse("speeds greater than 0")),
    }
}

fn zonedata(line: &mut Line) -> Result<Zone, ProgramError> {
    line.mark('[')?;
    let stops = truth(line)?;
    let mut radius = 0.0;
    for index in 0..6 {
        line.mark(',')?;
        let value = line.positive(true)?;
        if index == 0 {
            radius = value;
        }
    }
    line.mark(']')?;
    Ok(if stops {
        Zone::Stop
    } else {
        Zone::Within(1e-3 * radius)
    })
}

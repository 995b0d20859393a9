//! KRL, the language of KUKA.
//!
//! After "KUKA System Software 8.3, Operating and Programming Instructions for System Integrators" (KSS 8.3 END V1), chapters "Motion programming" (status and
//! turn, "Singularities") and "Programming for user group Expert (KRL syntax)": `PTP`, `LIN`, `C_DIS`, `SPTP` in a `PTP_SPLINE` with `TIME_BLOCK`, `WAIT SEC`, `$ANOUT[n]`
//! (-1 to 1 for -10 to 10 V), and from "KRL Reference Guide, Release 4.1" (<http://robot.zaab.org/wp-content/uploads/2014/04/KRL-Reference-Guide-v4_1.pdf>): data types AXIS, FRAME, POS, variables `$TOOL`, `$BASE`, `$VEL.CP` [m/s], `$APO.CDIS`
//! [mm]. X, Y, Z are in millimetres; A, B, C in degrees turn about z, the new y, the new x. Lines keep the posture of their start, S and T count for `PTP` alone.

use std::fmt::Write as _;

use glamx::DPose3;

use super::error::ProgramError;
use super::moves::{Configuration, Frame, Move, Program, Step, Target, Timing, Way, Zone};
use super::orientation::{fixed, millimetres_and_degrees, of_millimetres_and_degrees};
use super::words::{Line, Token};

/// Digits of millimetres, of degrees.
const DIGITS: [usize; 2] = [4, 6];
/// Names of the fields of a frame.
const FRAME: [&str; 6] = ["X", "Y", "Z", "A", "B", "C"];
/// Names of the fields of joint angles.
const AXES: [&str; 6] = ["A1", "A2", "A3", "A4", "A5", "A6"];
/// Words that begin what moves nothing.
const STILL: [&str; 12] = [
    "EXT",
    "DECL",
    "INTERRUPT",
    "GLOBAL",
    "$OUT",
    "$BWDSTART",
    "PDAT_ACT",
    "FDAT_ACT",
    "$ADVANCE",
    "$ACC",
    "$ORI_TYPE",
    "$VEL_AXIS",
];

/// The text of a program.
pub(super) fn write(program: &Program) -> String {
    let mut text = format!(
        "&ACCESS RVP\n&REL 1\nDEF {} ( )\n  BAS (#INITMOV,0)\n",
        program.name
    );
    let mut state = Written::default();
    let mut steps = program.steps.as_slice();
    while let Some(step) = steps.first() {
        let in_spline = timed(steps);
        if in_spline > 0 {
            spline(&mut text, &steps[..in_spline]);
            steps = &steps[in_spline..];
            continue;
        }
        for line in state.lines(step) {
            // Writing into a text cannot fail.
            let _ = writeln!(text, "  {line}");
        }
        steps = &steps[1..];
    }
    text + "END\n"
}

/// Steps from here on that are moves with a time, up to one that stops.
fn timed(steps: &[Step]) -> usize {
    let mut count = 0;
    for step in steps {
        match step {
            Step::Move(Move {
                timing: Some(Timing::Duration(_)),
                zone,
                ..
            }) => {
                count += 1;
                if *zone == Zone::Stop {
                    break;
                }
            }
            _ => break,
        }
    }
    count
}

/// Moves of the axes, each with its time, in one spline.
fn spline(text: &mut String, steps: &[Step]) {
    let mut total = 0.0;
    let mut inside = String::new();
    for step in steps {
        if let Step::Move(Move {
            target,
            timing: Some(Timing::Duration(time)),
            ..
        }) = step
        {
            total += time;
            // Writing into a text cannot fail.
            let _ = writeln!(inside, "    SPTP {}", target_text(target));
            let _ = writeln!(inside, "    TIME_BLOCK PART = {}", fixed(*time, 6));
        }
    }
    let _ = writeln!(
        text,
        "  PTP_SPLINE\n    TIME_BLOCK START\n{inside}    TIME_BLOCK END = {}\n  ENDSPLINE",
        fixed(total, 6)
    );
}

/// What the controller has been given.
#[derive(Default)]
struct Written {
    speed: String,
    share: String,
    distance: String,
}

impl Written {
    fn lines(&mut self, step: &Step) -> Vec<String> {
        match step {
            Step::Note(note) => vec![format!("; {note}")],
            Step::Load {
                mass,
                centre: [x, y, z],
            } => {
                let centre = [x, y, z].map(|value| fixed(value * 1e3, 2));
                let [x, y, z] = centre;
                vec![format!(
                    "$LOAD = {{M {},CM {{X {x},Y {y},Z {z},A 0,B 0,C 0}},J {{X 0,Y 0,Z 0}}}}",
                    fixed(*mass, 4)
                )]
            }
            Step::Tool(frame) => vec![format!("$TOOL = {}", frame_text(frame))],
            Step::Frame(frame) => vec![format!("$BASE = {}", frame_text(frame))],
            Step::Output { output, value } => {
                vec![format!("$ANOUT[{output}] = {}", fixed(*value, 5))]
            }
            Step::Wait(time) => vec![format!("WAIT SEC {}", fixed(*time, 4))],
            Step::Move(one) => self.motion(one),
        }
    }

    fn motion(&mut self, one: &Move) -> Vec<String> {
        let mut lines = Vec::new();
        let mut set = |kept: &mut String, line: String| {
            if *kept != line {
                lines.push(line.clone());
                *kept = line;
            }
        };
        match one.timing {
            Some(Timing::Speed(speed)) => {
                set(&mut self.speed, format!("$VEL.CP = {}", fixed(speed, 6)));
            }
            Some(Timing::Share(share)) => set(
                &mut self.share,
                format!("BAS (#VEL_PTP,{})", fixed(100.0 * share, 2)),
            ),
            Some(Timing::Turning(_) | Timing::Duration(_)) | None => {}
        }
        let blend = match one.zone {
            Zone::Within(radius) => {
                set(
                    &mut self.distance,
                    format!("$APO.CDIS = {}", fixed(1e3 * radius, 4)),
                );
                " C_DIS"
            }
            Zone::Stop | Zone::Share(_) | Zone::Through => "",
        };
        let word = match one.way {
            Way::Joint => "PTP",
            Way::Line => "LIN",
        };
        lines.push(format!("{word} {}{blend}", target_text(&one.target)));
        lines
    }
}

fn frame_text(frame: &Frame) -> String {
    format!("{{{}}}", fields(&frame.pose.unwrap_or(DPose3::IDENTITY)))
}

fn fields(pose: &DPose3) -> String {
    let values = millimetres_and_degrees(pose);
    let texts: Vec<String> = (FRAME.iter().zip(values).enumerate())
        .map(|(index, (name, value))| format!("{name} {}", fixed(value, DIGITS[index / 3])))
        .collect();
    texts.join(",")
}

fn target_text(target: &Target) -> String {
    match target {
        Target::Joints(joints) => {
            let texts: Vec<String> = (AXES.iter().zip(joints))
                .map(|(name, angle)| format!("{name} {}", fixed(angle.to_degrees(), DIGITS[1])))
                .collect();
            format!("{{{}}}", texts.join(","))
        }
        Target::Pose {
            pose,
            configuration,
        } => {
            let bits = match configuration {
                Some(Configuration::StatusTurn { status, turn }) => {
                    format!(",S 'B{status:03b}',T 'B{turn:06b}'")
                }
                _ => String::new(),
            };
            format!("{{{}{bits}}}", fields(pose))
        }
    }
}

/// What has been read so far.
#[derive(Default)]
struct Reader {
    program: Program,
    speed: Option<f64>,
    share: Option<f64>,
    distance: f64,
    /// Shares of the spline's time so far, and where its moves begin.
    spline: Option<(Vec<f64>, usize)>,
    total: Option<f64>,
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
        let trimmed = line.trim();
        if trimmed.starts_with('&') {
            continue;
        }
        if let Some(note) = trimmed.strip_prefix(';') {
            let note = note.trim_start_matches(';').trim();
            if !note.is_empty() {
                reader.program.steps.push(Step::Note(note.to_owned()));
            }
            continue;
        }
        let mut words = Line::new(last, line, Some(';'))?;
        if !words.is_done() {
            reader.line(&mut words)?;
        }
    }
    match reader.open {
        true => Err(Line::new(last + 1, "", None)?.refuse("`END`")),
        false => Ok(reader.program),
    }
}

impl Reader {
    fn line(&mut self, line: &mut Line) -> Result<(), ProgramError> {
        let before = line.clone();
        let word = line.word("a statement")?.to_ascii_uppercase();
        match word.as_str() {
            "DEF" => {
                self.program.name = line.word("the program's name")?;
                self.open = true;
                line.mark('(')?;
                line.mark(')')?;
            }
            "END" if self.open && self.spline.is_none() => self.open = false,
            "BAS" => self.basic(line)?,
            "PTP" | "SPTP" | "LIN" | "SLIN" => self.motion(line, &word)?,
            "PTP_SPLINE" if self.spline.is_none() => {
                self.spline = Some((Vec::new(), self.program.steps.len()));
            }
            "TIME_BLOCK" if self.spline.is_some() => self.time_block(line)?,
            "ENDSPLINE" => self.end_of_spline(&before)?,
            "WAIT" => {
                if !line.takes_word("SEC") {
                    return Err(line.refuse("`SEC`"));
                }
                let time = line.positive(true)?;
                self.program.steps.push(Step::Wait(time));
            }
            "$TOOL" | "$BASE" => self.frame(line, &word)?,
            "$LOAD" => self.load(line)?,
            "$VEL" | "$APO" => self.set(line, &word)?,
            "$ANOUT" => {
                line.mark('[')?;
                let output = line.whole()?.to_string();
                line.mark(']')?;
                line.mark('=')?;
                let value = line.number()?;
                self.program.steps.push(Step::Output { output, value });
            }
            still if STILL.contains(&still) => return Ok(()),
            _ => return Err(before.refuse("a statement that is known")),
        }
        line.end()
    }

    /// `BAS (#VEL_PTP,10)` and its like.
    fn basic(&mut self, line: &mut Line) -> Result<(), ProgramError> {
        line.mark('(')?;
        let command = line.word("a command, as #VEL_PTP")?.to_ascii_uppercase();
        let mut value = None;
        if line.takes(',') {
            value = Some(line.positive(true)?);
        }
        match (command.as_str(), value) {
            ("#VEL_PTP", Some(percent)) if percent <= 100.0 => self.share = Some(1e-2 * percent),
            ("#VEL_CP", Some(speed)) => self.speed = Some(speed),
            ("#VEL_PTP" | "#VEL_CP", _) => {
                return Err(line.refuse("a speed; of PTP 0 to 100 %, before it"));
            }
            ("#TOOL" | "#BASE", Some(number)) => {
                let frame = Frame {
                    name: number.to_string(),
                    pose: None,
                };
                self.program.steps.push(match command.as_str() {
                    "#TOOL" => Step::Tool(frame),
                    _ => Step::Frame(frame),
                });
            }
            _ => {}
        }
        line.mark(')')
    }

    /// `$VEL.CP = 0.02` and its like.
    fn set(&mut self, line: &mut Line, word: &str) -> Result<(), ProgramError> {
        line.mark('.')?;
        let field = line.word("a field")?.to_ascii_uppercase();
        line.mark('=')?;
        match (word, field.as_str()) {
            ("$VEL", "CP") => self.speed = Some(line.positive(false)?),
            ("$APO", "CDIS") => self.distance = 1e-3 * line.positive(true)?,
            ("$VEL", "ORI1" | "ORI2") | ("$APO", "CPTP" | "CORI" | "CVEL") => {
                line.positive(true)?;
            }
            _ => return Err(line.refuse("a field that is known before it")),
        }
        Ok(())
    }

    fn frame(&mut self, line: &mut Line, word: &str) -> Result<(), ProgramError> {
        line.mark('=')?;
        let frame = match line.peek() {
            Some(Token::Mark('{')) => {
                let before = line.clone();
                match aggregate(line)? {
                    Target::Pose {
                        pose,
                        configuration: None,
                    } => Frame {
                        name: String::new(),
                        pose: Some(pose),
                    },
                    _ => return Err(before.refuse("a frame, {X ..,Y ..,Z ..,A ..,B ..,C ..}")),
                }
            }
            _ => {
                let of = line
                    .word("a frame, or TOOL_DATA[n], BASE_DATA[n]")?
                    .to_ascii_uppercase();
                if !matches!(
                    (word, of.as_str()),
                    ("$TOOL", "TOOL_DATA") | ("$BASE", "BASE_DATA")
                ) {
                    return Err(line.refuse("TOOL_DATA or BASE_DATA before it"));
                }
                line.mark('[')?;
                let name = line.whole()?.to_string();
                line.mark(']')?;
                Frame { name, pose: None }
            }
        };
        self.program.steps.push(match word {
            "$TOOL" => Step::Tool(frame),
            _ => Step::Frame(frame),
        });
        Ok(())
    }

    fn load(&mut self, line: &mut Line) -> Result<(), ProgramError> {
        line.mark('=')?;
        line.mark('{')?;
        line.word("M")?;
        let mass = line.positive(true)?;
        line.mark(',')?;
        line.word("CM")?;
        let before = line.clone();
        let Target::Pose { pose, .. } = aggregate(line)? else {
            return Err(before.refuse("the frame of the centre of mass"));
        };
        let centre = pose.translation.to_array();
        while line.take().is_some() {}
        self.program.steps.push(Step::Load { mass, centre });
        Ok(())
    }

    fn motion(&mut self, line: &mut Line, word: &str) -> Result<(), ProgramError> {
        let target = aggregate(line)?;
        let mut zone = Zone::Stop;
        if line.takes_word("C_DIS") {
            zone = Zone::Within(self.distance);
        } else if line.takes_word("C_PTP")
            || line.takes_word("C_VEL")
            || line.takes_word("C_ORI")
            || line.takes_word("C_SPL")
        {
            zone = Zone::Through;
        }
        let is_joint = word.ends_with("PTP");
        if !is_joint && matches!(target, Target::Joints(_)) {
            return Err(line.refuse("a pose before it: lines go to no joint angles"));
        }
        let timing = match is_joint {
            true => self.share.map(Timing::Share),
            false => self.speed.map(Timing::Speed),
        };
        if self.spline.is_some() && word == "SPTP" {
            zone = Zone::Through;
        }
        self.program.steps.push(Step::Move(Move {
            way: if is_joint { Way::Joint } else { Way::Line },
            target,
            timing,
            zone,
        }));
        Ok(())
    }

    fn time_block(&mut self, line: &mut Line) -> Result<(), ProgramError> {
        let Some((parts, first)) = &mut self.spline else {
            return Ok(());
        };
        let kind = line.word("START, PART or END")?.to_ascii_uppercase();
        match kind.as_str() {
            "START" if parts.is_empty() => return Ok(()),
            "PART" if self.program.steps.len() == *first + parts.len() + 1 => {
                line.mark('=')?;
                parts.push(line.positive(false)?);
            }
            "END" if self.program.steps.len() == *first + parts.len() => {
                line.mark('=')?;
                self.total = Some(line.positive(false)?);
            }
            _ => {
                return Err(line
                    .refuse("TIME_BLOCK START, then PART behind each move, then END, before it"));
            }
        }
        Ok(())
    }

    /// Gives each move of a spline its time.
    fn end_of_spline(&mut self, line: &Line) -> Result<(), ProgramError> {
        let Some((parts, first)) = self.spline.take() else {
            return Err(line.refuse("PTP_SPLINE before it"));
        };
        let steps = &mut self.program.steps[first..];
        if steps.is_empty()
            || !parts.is_empty() && (self.total.is_none() || parts.len() != steps.len())
        {
            return Err(line
                .refuse("moves before it, with TIME_BLOCK END where there is a TIME_BLOCK PART"));
        }
        let scale = self.total.take().unwrap_or_default() / parts.iter().sum::<f64>();
        for (step, part) in steps.iter_mut().zip(&parts) {
            if let Step::Move(one) = step {
                one.timing = Some(Timing::Duration(part * scale));
            }
        }
        if let Some(Step::Move(last)) = steps.last_mut() {
            last.zone = Zone::Stop;
        }
        Ok(())
    }
}

/// Joint angles or a pose in braces.
fn aggregate(line: &mut Line) -> Result<Target, ProgramError> {
    line.mark('{')?;
    // The type may stand before the values: {FRAME: X 1, ...}.
    let before = line.clone();
    if line.word("X or A1").is_ok() && !line.takes(':') {
        *line = before;
    }
    let is_joints =
        matches!(line.peek(), Some(Token::Word(word)) if word.eq_ignore_ascii_case("A1"));
    let names = if is_joints { AXES } else { FRAME };
    let mut values = [0.0; 6];
    for (index, name) in names.iter().enumerate() {
        if index > 0 {
            line.mark(',')?;
        }
        if !line.takes_word(name) {
            return Err(line.refuse(format!("`{name}`")));
        }
        values[index] = line.number()?;
    }
    let mut bits = [None; 2];
    while line.takes(',') {
        let before = line.clone();
        let name = line.word("S, T or an external axis")?.to_ascii_uppercase();
        match name.as_str() {
            "S" if !is_joints && bits[0].is_none() => bits[0] = Some(binary(line, 0b1_1111)?),
            "T" if !is_joints && bits[1].is_none() => bits[1] = Some(binary(line, 0b11_1111)?),
            // External axes that stand still.
            "E1" | "E2" | "E3" | "E4" | "E5" | "E6" => {
                let before = line.clone();
                if line.number()? != 0.0 {
                    return Err(before.refuse("0: external axes are not read"));
                }
            }
            _ => return Err(before.refuse("S, T or an external axis, once")),
        }
    }
    line.mark('}')?;
    if is_joints {
        return Ok(Target::Joints(values.map(f64::to_radians)));
    }
    let configuration = match bits {
        [Some(status), Some(turn)] => Some(Configuration::StatusTurn { status, turn }),
        [None, None] => None,
        _ => return Err(line.refuse("S and T, or neither, before it")),
    };
    let pose = of_millimetres_and_degrees(values);
    Ok(Target::Pose {
        pose,
        configuration,
    })
}

/// Bits, as a number or as 'B 010'.
fn binary(line: &mut Line, most: u32) -> Result<u32, ProgramError> {
    let before = line.clone();
    let value = match line.peek() {
        Some(Token::Text(text)) => {
            let digits = text.trim().strip_prefix(['B', 'b']).map(str::trim);
            digits.and_then(|digits| u32::from_str_radix(digits, 2).ok())
        }
        _ => u32::try_from(before.clone().whole()?).ok(),
    };
    if matches!(line.peek(), Some(Token::Text(_))) {
        line.take();
    } else {
        line.whole()?;
    }
    match value {
        Some(value) if value <= most => Ok(value),
        _ => Err(before.refuse(format!("bits, 0 to {most}"))),
    }
}

//! TP programs of FANUC as text (.ls).
//!
//! After "FANUC Robot series R-30iB/R-30iB Mate controller, Operator's Manual (Basic Operation)", B-83284EN: motion instructions (position data, configuration, feed rate, positioning path),
//! register, frame, wait and analog instructions. X, Y, Z are in millimetres; W, P, R in degrees turn about the fixed x, y, z. F or N says on which side joint 5 is,
//! U or D the elbow, T or B the shoulder; the turns of joints 1, 4, 6 are 0 from -179 to 179 degrees. Which side of joint 5 is N depends on the model's sense of counting: here N is below 0.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glamx::DPose3;

use super::error::ProgramError;
use super::moves::{Configuration, Frame, Move, Program, Step, Target, Timing, Way, Zone};
use super::orientation::{fixed, millimetres_and_degrees, of_millimetres_and_degrees};
use super::words::{Line, Token};

/// Number of the tool's and the part's frame that are written: the last of a controller.
const NUMBER: usize = 9;
/// Number of the position register that is used for them.
const REGISTER: usize = 99;
/// Digits of millimetres and degrees.
const DIGITS: usize = 3;
/// Largest rounding of a speed [1].
const ROUNDING: f64 = 1e-3;
/// Names of the fields of a position; W, P and R turn about x, y and z.
const POSE: [&str; 6] = ["X", "Y", "Z", "W", "P", "R"];
const JOINTS: [&str; 6] = ["J1", "J2", "J3", "J4", "J5", "J6"];
/// Words that begin what moves nothing.
const STILL: [&str; 24] = [
    "CALL", "IF", "JMP", "LBL", "R", "DO", "DI", "RO", "F", "GO", "OVERRIDE", "PAYLOAD", "TIMER",
    "FOR", "ENDFOR", "ELSE", "ENDIF", "END", "SELECT", "ABORT", "PAUSE", "RUN", "MESSAGE", "UALM",
];

/// The text of a program.
pub(super) fn write(program: &Program) -> String {
    let mut lines: Vec<String> = Vec::new();
    let mut positions = String::new();
    let mut count = 0;
    for step in &program.steps {
        match step {
            Step::Note(note) => lines.push(format!("  !{note}")),
            Step::Load { mass, .. } => lines.push(format!(
                "  !load {} kg: PAYLOAD by the user",
                fixed(*mass, 2)
            )),
            Step::Tool(frame) => lines.extend(frame_lines("UTOOL", frame)),
            Step::Frame(frame) => lines.extend(frame_lines("UFRAME", frame)),
            Step::Output { output, value } => lines.push(format!("  AO[{output}]={value:.0}")),
            Step::Wait(time) => lines.push(format!("  WAIT {}(sec)", fixed(*time, 2))),
            Step::Move(one) => {
                count += 1;
                lines.push(move_text(one, count));
                // Writing into a text cannot fail.
                let _ = write!(
                    positions,
                    "P[{count}]{{\n   GP1:\n\tUF : {NUMBER}, UT : {NUMBER},{}\n}};\n",
                    target_text(&one.target)
                );
            }
        }
    }
    let mut text = format!(
        "/PROG  {}\n/ATTR\nOWNER\t\t= MNEDITOR;\nCOMMENT\t\t= \"idc\";\nPROTECT\t\t= READ_WRITE;\nDEFAULT_GROUP\t= 1,*,*,*,*;\nCONTROL_CODE\t= 00000000 00000000;\n/MN\n",
        program.name
    );
    for (index, line) in lines.iter().enumerate() {
        let _ = writeln!(text, "{:4}:{line}    ;", index + 1);
    }
    text + "/POS\n" + &positions + "/END\n"
}

/// A frame by way of a position register.
fn frame_lines(word: &str, frame: &Frame) -> Vec<String> {
    let [x, y, z, yaw, pitch, roll] =
        millimetres_and_degrees(&frame.pose.unwrap_or(DPose3::IDENTITY));
    let values = [x, y, z, roll, pitch, yaw];
    let mut lines: Vec<String> = (values.iter().enumerate())
        .map(|(index, value)| format!("  PR[{REGISTER},{}]=({})", index + 1, fixed(*value, DIGITS)))
        .collect();
    lines.push(format!("  {word}[{NUMBER}]=PR[{REGISTER}]"));
    lines.push(format!("  {word}_NUM={NUMBER}"));
    lines
}

fn move_text(one: &Move, number: usize) -> String {
    let word = match one.way {
        Way::Joint => "J",
        Way::Line => "L",
    };
    let timing = match one.timing {
        Some(Timing::Speed(speed)) => speed_text(1e3 * speed),
        Some(Timing::Duration(time)) => format!("{:.0}msec", 1e3 * time),
        Some(Timing::Share(share)) => format!("{:.0}%", 100.0 * share),
        Some(Timing::Turning(_)) | None => "10%".to_owned(),
    };
    let zone = match one.zone {
        Zone::Stop => "FINE".to_owned(),
        Zone::Share(share) => format!("CNT{:.0}", 100.0 * share),
        Zone::Within(_) | Zone::Through => "CNT100".to_owned(),
    };
    format!("{word} P[{number}] {timing} {zone}")
}

/// A speed with one digit behind the point [mm/s]; where that rounds too much, in the finer centimetres a minute.
fn speed_text(speed: f64) -> String {
    let rounded = (10.0 * speed).round() / 10.0;
    match (rounded - speed).abs() <= ROUNDING * speed {
        true => format!("{}mm/sec", fixed(speed, 1)),
        false => format!("{}cm/min", fixed(6.0 * speed, 1)),
    }
}

fn target_text(target: &Target) -> String {
    let row = |names: &[&str], values: &[f64], unit: &str| {
        let fields: Vec<String> = (names.iter().zip(values))
            .map(|(name, value)| format!("{name} = {:>9} {unit}", fixed(*value, DIGITS)))
            .collect();
        fields.join(",\t")
    };
    match target {
        Target::Joints(joints) => {
            let angles = joints.map(f64::to_degrees);
            format!(
                "\n\t{},\n\t{}",
                row(&JOINTS[..3], &angles[..3], "deg"),
                row(&JOINTS[3..], &angles[3..], "deg")
            )
        }
        Target::Pose {
            pose,
            configuration,
        } => {
            let [x, y, z, yaw, pitch, roll] = millimetres_and_degrees(pose);
            format!(
                "\t\tCONFIG : '{}',\n\t{},\n\t{}",
                configuration_text(*configuration),
                row(&POSE[..3], &[x, y, z], "mm"),
                row(&POSE[3..], &[roll, pitch, yaw], "deg")
            )
        }
    }
}

fn configuration_text(configuration: Option<Configuration>) -> String {
    let Some(Configuration::Flags {
        flip,
        up,
        top,
        turns: [one, four, six],
    }) = configuration
    else {
        return "N U T, 0, 0, 0".to_owned();
    };
    let letter = |is: bool, letters: [char; 2]| letters[usize::from(!is)];
    format!(
        "{} {} {}, {one}, {four}, {six}",
        letter(flip, ['F', 'N']),
        letter(up, ['U', 'D']),
        letter(top, ['T', 'B'])
    )
}

/// A position, with the numbers of its frame and tool.
type Position = (Target, [i32; 2]);

/// What has been read so far.
#[derive(Default)]
struct Reader {
    program: Program,
    /// Moves by the place of their step, and the number of their position.
    used: Vec<(usize, i32, Line)>,
    register: BTreeMap<i32, [f64; 6]>,
    frames: BTreeMap<(String, i32), DPose3>,
    positions: BTreeMap<i32, Position>,
}

/// The program of a text.
///
/// # Errors
/// The line that is not understood.
pub(super) fn read(text: &str) -> Result<Program, ProgramError> {
    let mut reader = Reader::default();
    let mut part = String::new();
    let (mut pending, mut first, mut last) = (String::new(), 0, 0);
    for (index, line) in text.lines().enumerate() {
        last = index + 1;
        let trimmed = line.trim();
        if let Some(rest) = trimmed
            .strip_prefix('/')
            .filter(|rest| !rest.starts_with('/'))
        {
            let mut words = rest.split_whitespace();
            words.next().unwrap_or_default().clone_into(&mut part);
            if part == "PROG" {
                let name = words.next().unwrap_or_default();
                name.clone_into(&mut reader.program.name);
            }
            continue;
        }
        match part.as_str() {
            "MN" => reader.instruction(last, trimmed)?,
            "POS" => {
                if pending.is_empty() {
                    first = last;
                }
                pending.push_str(trimmed);
                pending.push(' ');
                if trimmed.ends_with("};") {
                    reader.position(&mut Line::new(
                        first,
                        pending.trim_end().trim_end_matches(';'),
                        None,
                    )?)?;
                    pending.clear();
                }
            }
            _ => {}
        }
    }
    if part != "END" || !pending.trim().is_empty() {
        return Err(Line::new(last + 1, "", None)?.refuse("`/END`"));
    }
    reader.finish()
}

impl Reader {
    fn instruction(&mut self, number: usize, text: &str) -> Result<(), ProgramError> {
        if text.is_empty() {
            return Ok(());
        }
        let whole = Line::new(number, "", None)?;
        let Some((label, code)) = text.split_once(':') else {
            return Err(whole.refuse("the number of the line and `:`"));
        };
        let Some(code) = code.trim_end().strip_suffix(';') else {
            return Err(whole.refuse("`;`"));
        };
        if label.trim().parse::<u32>().is_err() {
            return Err(Line::new(number, label, None)?.refuse("the number of the line"));
        }
        let code = code.trim();
        if let Some(note) = code.strip_prefix('!').or_else(|| code.strip_prefix("//")) {
            self.program.steps.push(Step::Note(note.trim().to_owned()));
            return Ok(());
        }
        let mut line = Line::new(number, code, None)?;
        match line.is_done() {
            true => Ok(()),
            false => self.statement(&mut line),
        }
    }

    fn statement(&mut self, line: &mut Line) -> Result<(), ProgramError> {
        let before = line.clone();
        let word = line.word("an instruction")?;
        match word.as_str() {
            "J" | "L" => self.motion(line, &word)?,
            "UFRAME_NUM" | "UTOOL_NUM" => {
                line.mark('=')?;
                let number = line.whole()?;
                let of = word.trim_end_matches("_NUM").to_owned();
                let frame = Frame {
                    name: number.to_string(),
                    pose: self.frames.get(&(of.clone(), number)).copied(),
                };
                self.program.steps.push(match of.as_str() {
                    "UTOOL" => Step::Tool(frame),
                    _ => Step::Frame(frame),
                });
            }
            "UFRAME" | "UTOOL" => self.frame(line, word)?,
            "PR" => self.register(line)?,
            "AO" => {
                let output = index(line)?.to_string();
                line.mark('=')?;
                let value = bracketed(line)?;
                self.program.steps.push(Step::Output { output, value });
            }
            "WAIT" => match line.peek() {
                Some(Token::Number(_)) => {
                    let time = line.positive(true)?;
                    line.mark('(')?;
                    line.word("sec")?;
                    line.mark(')')?;
                    self.program.steps.push(Step::Wait(time));
                }
                _ => return Ok(()),
            },
            still if STILL.contains(&still) => return Ok(()),
            _ => return Err(before.refuse("an instruction that is known")),
        }
        line.end()
    }

    /// `PR[99,1]=(12.5)`.
    fn register(&mut self, line: &mut Line) -> Result<(), ProgramError> {
        line.mark('[')?;
        let number = line.whole()?;
        line.mark(',')?;
        let before = line.clone();
        let field = line.whole()?;
        line.mark(']')?;
        line.mark('=')?;
        let value = bracketed(line)?;
        let values = self.register.entry(number).or_insert([0.0; 6]);
        let field = usize::try_from(field - 1).unwrap_or(usize::MAX);
        match values.get_mut(field) {
            Some(place) => *place = value,
            None => return Err(before.refuse("a field, 1 to 6")),
        }
        Ok(())
    }

    /// `UFRAME[9]=PR[99]`.
    fn frame(&mut self, line: &mut Line, word: String) -> Result<(), ProgramError> {
        let number = index(line)?;
        line.mark('=')?;
        let before = line.clone();
        line.word("PR")?;
        let register = index(line)?;
        let Some(&[x, y, z, roll, pitch, yaw]) = self.register.get(&register) else {
            return Err(before.refuse("a position register that has been set"));
        };
        let pose = of_millimetres_and_degrees([x, y, z, yaw, pitch, roll]);
        self.frames.insert((word, number), pose);
        Ok(())
    }

    fn motion(&mut self, line: &mut Line, word: &str) -> Result<(), ProgramError> {
        let whole = line.clone();
        if !line.takes_word("P") {
            return Err(line.refuse("P[n]: moves to registers are not read"));
        }
        let number = index(line)?;
        let before = line.clone();
        let value = line.positive(false)?;
        let unit = match line.takes('%') {
            true => "%".to_owned(),
            false => line.word("a unit")?,
        };
        let per = match line.takes('/') {
            true => line.word("a unit of time")?,
            false => String::new(),
        };
        let is_joint = word == "J";
        let timing = match (unit.as_str(), per.as_str()) {
            ("%", "") if is_joint && value <= 100.0 => Timing::Share(1e-2 * value),
            ("mm", "sec") if !is_joint => Timing::Speed(1e-3 * value),
            ("cm", "min") if !is_joint => Timing::Speed(1e-2 / 60.0 * value),
            ("sec", "") => Timing::Duration(value),
            ("msec", "") => Timing::Duration(1e-3 * value),
            _ => return Err(before.refuse("a speed: % for J, mm/sec or cm/min for L, sec or msec")),
        };
        let before = line.clone();
        let zone = line.word("FINE or CNT")?;
        let zone = match (
            zone.as_str(),
            zone.strip_prefix("CNT").map(str::parse::<u32>),
        ) {
            ("FINE", _) => Zone::Stop,
            (_, Some(Ok(share))) if share <= 100 => Zone::Share(1e-2 * f64::from(share)),
            _ => return Err(before.refuse("FINE, or CNT0 to CNT100")),
        };
        if let Some(Token::Word(option)) = line.peek()
            && option
                .strip_prefix("ACC")
                .is_some_and(|digits| digits.parse::<u32>().is_ok())
        {
            line.take();
        }
        self.used.push((self.program.steps.len(), number, whole));
        self.program.steps.push(Step::Move(Move {
            way: if is_joint { Way::Joint } else { Way::Line },
            // Put in once the positions have been read.
            target: Target::Joints([0.0; 6]),
            timing: Some(timing),
            zone,
        }));
        Ok(())
    }

    /// `P[1]{ GP1: UF : 0, UT : 1, ... }`.
    fn position(&mut self, line: &mut Line) -> Result<(), ProgramError> {
        line.word("P")?;
        let before = line.clone();
        let number = index(line)?;
        line.mark('{')?;
        if !line.takes_word("GP1") {
            return Err(line.refuse("GP1: other groups are external axes"));
        }
        line.mark(':')?;
        let mut frames = [0; 2];
        for (name, value) in ["UF", "UT"].iter().zip(&mut frames) {
            if !line.takes_word(name) {
                return Err(line.refuse(format!("`{name}`")));
            }
            line.mark(':')?;
            *value = line.whole()?;
            line.mark(',')?;
        }
        let target = match line.takes_word("CONFIG") {
            true => {
                line.mark(':')?;
                let before = line.clone();
                let configuration = configuration(&line.text("a configuration")?);
                let configuration = configuration
                    .ok_or_else(|| before.refuse("a configuration, as 'N U T, 0, 0, 0'"))?;
                line.mark(',')?;
                let [x, y, z, roll, pitch, yaw] = fields(line, &POSE)?;
                Target::Pose {
                    pose: of_millimetres_and_degrees([x, y, z, yaw, pitch, roll]),
                    configuration: Some(configuration),
                }
            }
            false => Target::Joints(fields(line, &JOINTS)?.map(f64::to_radians)),
        };
        line.mark('}')?;
        line.end()?;
        match self.positions.insert(number, (target, frames)) {
            None => Ok(()),
            Some(_) => Err(before.refuse("each position once")),
        }
    }

    /// Puts the positions into the moves; a position has its frame and tool.
    fn finish(mut self) -> Result<Program, ProgramError> {
        for (step, number, line) in &self.used {
            let Some((target, _)) = self.positions.get(number) else {
                return Err(line.refuse("a position that stands in /POS"));
            };
            if let Step::Move(one) = &mut self.program.steps[*step] {
                one.target = target.clone();
            }
        }
        Ok(self.program)
    }
}

/// `[9]`, or `[9:name]`.
fn index(line: &mut Line) -> Result<i32, ProgramError> {
    line.mark('[')?;
    let number = line.whole()?;
    if line.takes(':') {
        while !matches!(line.peek(), Some(Token::Mark(']')) | None) {
            line.take();
        }
    }
    line.mark(']')?;
    Ok(number)
}

/// A number, in brackets where it is negative.
fn bracketed(line: &mut Line) -> Result<f64, ProgramError> {
    let is_in = line.takes('(');
    let value = line.number()?;
    if is_in {
        line.mark(')')?;
    }
    Ok(value)
}

/// `X = 1.000 mm, Y = ...`.
fn fields(line: &mut Line, names: &[&str; 6]) -> Result<[f64; 6], ProgramError> {
    let mut values = [0.0; 6];
    for (index, (name, value)) in names.iter().zip(&mut values).enumerate() {
        if index > 0 {
            line.mark(',')?;
        }
        if !line.takes_word(name) {
            return Err(line.refuse(format!("`{name}`")));
        }
        line.mark('=')?;
        *value = line.number()?;
        let unit = if matches!(*name, "X" | "Y" | "Z") {
            "mm"
        } else {
            "deg"
        };
        if !line.takes_word(unit) {
            return Err(line.refuse(format!("`{unit}`")));
        }
    }
    Ok(values)
}

fn configuration(text: &str) -> Option<Configuration> {
    let mut parts = text.split(',').map(str::trim);
    let letters: Vec<&str> = parts.next()?.split_whitespace().collect();
    let one_of = |letter: &str, [yes, no]: [&str; 2]| match letter {
        given if given == yes => Some(true),
        given if given == no => Some(false),
        _ => None,
    };
    let [wrist, elbow, shoulder] = letters.as_slice() else {
        return None;
    };
    let turns: Vec<i32> = parts.map(|turn| turn.parse().ok()).collect::<Option<_>>()?;
    Some(Configuration::Flags {
        flip: one_of(wrist, ["F", "N"])?,
        up: one_of(elbow, ["U", "D"])?,
        top: one_of(shoulder, ["T", "B"])?,
        turns: turns.try_into().ok()?,
    })
}

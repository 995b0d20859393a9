//! `idc investigate`: a diagnosis that asks a rig its own questions, until it is sure or no allowed experiment would make it so.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;
use serde_json::{Value, json};

use super::super::error::{AppError, ExitCode};
use super::super::files::{OutputFolder, OverwritePolicy, REPORT, is_same, output_folder};
use super::super::interrupt::Interruptible;
use super::super::output::say;
use super::super::progress;
use super::error::NextError;
use super::files;
use super::outputs::write;
use super::page::ROLES;
use super::proposal::{Allowed, Proposal, case_in, diagnosed, stated_limits};
use super::rig_program::{Reply, Returned, RigProgram, check_inputs};
use crate::case::{Case, Diagnosed, Explanations, IMPROVED, RIG, rig_of, to_fit};
use crate::diagnosis::answer::Answer;
use crate::diagnosis::experiment::information::Open;
use crate::diagnosis::experiment::limits::LimitError;
use crate::document::{
    Block, Cell, Column, Document, Horizontal, Panel, Role, Section, Series, Stroke, Style, Table,
    Tone, html, text,
};
use crate::quantity::percent;
use crate::recording::RecordingError;
use crate::recording::atomic::{make_folder, write_all, write_text};
use crate::replay::LoadedCell;
use crate::report;
use crate::scenario::rig_file::{RigFile, text_with_recordings};

/// For the help.
pub(in super::super) const EXAMPLES: &str = "\
The recordings of a rig are diagnosed, the experiment is chosen that is expected
to tell most of what they leave open, and the rig's program is called with its
inputs: PROGRAM IN.csv OUT.csv. Its recording joins the others, and so on until
one explanation is as probable as --until asks, or nothing that is allowed would
settle it. IN.csv has columns time_s, set_pressure_pa, solenoid, surface_m, of a
cell time_s, path_m, joint_N_command_rad, set_pressure_pa; OUT.csv those and
what was measured. Exit codes of the program: 0 recorded, 3 these inputs are
refused, 4 try again. Exit codes here: 0 settled, or nothing is missing; 1 it
stays open; 2 bad input.

The folder case/ of the results holds all recordings with their rig.toml: `idc
diagnose` of it comes to the same from the beginning.

Examples:
  # A rig that a script drives. (takes minutes)
  idc investigate assets/proof/cases/case-03 --rig ./my_rig --out runs/asked";

const RECORD: &str = "investigation.json";
const CASE: &str = "case";
const NAMES: [&str; 3] = [IMPROVED, REPORT, RECORD];
/// Experiments that a rig may refuse, and repetitions that it may ask for, in a row.
const TRIES: usize = 4;
/// By how much the largest force is lowered where a rig refuses [1].
const GENTLER: f64 = 0.7;
/// Information from which an experiment is worth its while [nat].
const WORTH: f64 = 0.02;

#[derive(Debug, Args)]
pub(in super::super) struct InvestigateArguments {
    /// Folder with rig.toml and the recordings that it names, or with the recordings of a cell (--scenario).
    case: PathBuf,
    /// Scenario file of a cell that the recordings are of.
    #[arg(long)]
    scenario: Option<PathBuf>,
    /// Program of the rig, called as PROGRAM IN.csv OUT.csv.
    #[arg(long, value_name = "PROGRAM")]
    rig: PathBuf,
    #[command(flatten)]
    allowed: Allowed,
    /// Probability at which the best explanation counts as settled.
    #[arg(long, default_value_t = 0.95, value_parser = probability)]
    until: f64,
    /// Recordings at most.
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=1000))]
    runs: u32,
    /// Time that the rig's program may take for a recording.
    #[arg(long, value_name = "TIME", default_value = "5min", value_parser = super::super::diagnose::duration)]
    patience: Duration,
    /// Folder for case, run-1 and so on, improved.toml, report.html and investigation.json [default: runs/<name of the case's folder>].
    #[arg(long, help_heading = "Output")]
    out: Option<PathBuf>,
    /// Put new results in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print what investigation.json holds instead of the text.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

fn probability(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|p| (0.5..1.0).contains(p));
    value.ok_or_else(|| "expected a probability from 0.5 to below 1".to_owned())
}

/// Odds at a time of the investigation.
struct Odds {
    open: Vec<(String, f64)>,
    none_of_these: f64,
}

/// A recording that was asked for.
struct Asked {
    name: String,
    duration: f64,
    expected: Option<f64>,
    instructions: Vec<String>,
}

/// What is to be done next.
enum Next {
    /// A recording that was made.
    Recorded(Asked),
    /// Nothing that is allowed would tell enough; what stays open, a sentence each.
    Nothing(Vec<String>),
}

/// Why it stops.
enum Stop {
    Settled,
    NothingMissing,
    NoExperiment(Vec<String>),
    Runs,
}

impl Stop {
    fn words(&self) -> &'static str {
        match self {
            Self::Settled => "settled",
            Self::NothingMissing => "nothing is missing",
            Self::NoExperiment(_) => "no allowed experiment would tell more",
            Self::Runs => "as many recordings as --runs allows",
        }
    }
}

impl Odds {
    fn of(open: &[Open], none_of_these: f64) -> Self {
        // Curves without a formula have one name.
        let mut named: Vec<(String, f64)> = Vec::new();
        for own in open {
            match named.iter_mut().find(|(name, _)| *name == own.name) {
                Some((_, sum)) => *sum += own.probability,
                None => named.push((own.name.clone(), own.probability)),
            }
        }
        Self {
            open: named,
            none_of_these,
        }
    }

    fn json(&self) -> Value {
        let round = |p: f64| (p * 1e4).round() / 1e4;
        let own = self
            .open
            .iter()
            .map(|(name, p)| json!({ "effects": name, "probability": round(*p) }));
        json!({ "explanations": own.collect::<Vec<_>>(), "none_of_these": round(self.none_of_these) })
    }

    fn probability(&self, name: &str) -> Option<f64> {
        self.open
            .iter()
            .find(|(own, _)| own == name)
            .map(|(_, p)| *p)
    }
}

/// The case that grows: recordings in a folder of their own, of a bench with their rig file.
struct Growth {
    folder: PathBuf,
    /// The rig file of a bench.
    rig: Option<RigFile>,
    /// The cell.
    cell: Option<LoadedCell>,
    names: Vec<String>,
}

impl Growth {
    fn of(
        folder: &Path,
        (case, cell): (&Case, Option<LoadedCell>),
        to: PathBuf,
    ) -> Result<Self, AppError> {
        if is_same(folder, &to) {
            return Err(AppError::AmongInputs {
                folder: to.display().to_string(),
            });
        }
        let mut growth = Self {
            folder: to,
            rig: None,
            names: Vec::new(),
            cell,
        };
        if growth.cell.is_none() {
            let rig = rig_of(folder)?;
            for name in to_fit(&rig, folder)? {
                growth.take(name.clone(), &folder.join(name))?;
            }
            growth.rig = Some(rig);
        } else {
            growth.forget_earlier_runs();
            let recordings = case.input().map(|input| &input.recordings);
            for own in recordings.into_iter().flatten() {
                let file = Path::new(&own.file);
                // A run of this program is a folder of the name that it is called by.
                let within = file.file_name().filter(|name| **name != *own.name);
                let name = within.map_or(PathBuf::from(&own.name), |name| {
                    Path::new(&own.name).join(name)
                });
                growth.take(name.display().to_string(), file)?;
            }
        }
        growth.write()?;
        Ok(growth)
    }

    /// A cell's recordings are all that stand in its folder: those of an earlier investigation are none of them.
    fn forget_earlier_runs(&self) {
        let entries = std::fs::read_dir(&self.folder).into_iter().flatten();
        for entry in entries.flatten() {
            let name = entry.file_name().display().to_string();
            if number_of(&name).is_some() {
                let _ = std::fs::remove_file(entry.path());
            }
        }
    }

    /// Number of its next recording: after those that an earlier investigation left among them.
    fn next_number(&self) -> usize {
        let numbers = self.names.iter().filter_map(|name| number_of(name));
        numbers.max().map_or(1, |last| last + 1)
    }

    /// The case with all recordings.
    fn case(&self) -> Result<Case, AppError> {
        case_in(&self.folder, self.cell.as_ref())
    }

    /// The rig file of a bench, with all recordings.
    fn write(&self) -> Result<(), AppError> {
        let Some(rig) = &self.rig else {
            return Ok(());
        };
        let text = text_with_recordings(rig, &self.names);
        Ok(write_text(&self.folder.join(RIG), &text)?)
    }

    fn take(&mut self, name: String, recording: &Path) -> Result<(), AppError> {
        let to = self.folder.join(&name);
        let folder = to.parent().unwrap_or(&self.folder);
        make_folder(folder).map_err(|error| RecordingError::write(folder, error))?;
        copy(recording, &to)?;
        self.names.push(name);
        Ok(())
    }

    fn add(&mut self, name: String, recording: &Path) -> Result<(), AppError> {
        self.take(name, recording)?;
        self.write()
    }
}

/// Number of a recording that was asked for, by its file's name; none of another.
fn number_of(name: &str) -> Option<usize> {
    name.strip_prefix("run-")?
        .strip_suffix(".csv")?
        .parse()
        .ok()
}

/// A recording in another folder.
fn copy(from: &Path, to: &Path) -> Result<(), AppError> {
    let bytes = crate::file::read(from).map_err(|error| RecordingError::read(from, error))?;
    Ok(write_all(&[(to, bytes)])?)
}

/// Asks until it is settled.
pub(in super::super) fn investigate(
    arguments: &InvestigateArguments,
) -> Result<ExitCode, AppError> {
    let silent = arguments.quiet || arguments.json;
    let cell = arguments.scenario.as_deref().map(LoadedCell::load);
    let cell = cell.transpose()?;
    let case = case_in(&arguments.case, cell.as_ref())?;
    stated_limits(&case)?;
    let out = output_folder(arguments.out.as_ref(), &arguments.case);
    let folder = OutputFolder::prepare(&out, &NAMES, OverwritePolicy::of(arguments.force))?;
    let _interruptible = Interruptible::of_one("investigation", &out);
    let program = RigProgram {
        program: arguments.rig.clone(),
        patience: arguments.patience,
    };
    let start = Instant::now();
    let mut growth = Growth::of(&arguments.case, (&case, cell), out.join(CASE))?;
    let case_name = case.name;
    let mut odds: Vec<Odds> = Vec::new();
    let mut asked: Vec<Asked> = Vec::new();
    let mut known: Option<Explanations> = None;
    let (stop, found) = loop {
        let mut case = growth.case()?;
        case.name.clone_from(&case_name);
        if let Some(known) = &known
            && known.outdated(&case.provenance()?).is_none()
        {
            case.go_on_from(known);
        }
        let found = diagnosed(&case, (silent, arguments.allowed.verbose))?;
        let Some(diagnosis) = &found.diagnosis else {
            return Err(NextError::NoBench { case: case.name }.into());
        };
        let open = diagnosis.open();
        odds.push(Odds::of(&open, diagnosis.none_of_these()));
        let is_sure = open[0].probability >= arguments.until;
        let is_nothing = diagnosis.best().finds_nothing();
        match (is_sure, is_nothing, asked.len() == arguments.runs as usize) {
            (true, true, _) => break (Stop::NothingMissing, found),
            (true, false, _) => break (Stop::Settled, found),
            (false, _, true) => break (Stop::Runs, found),
            (false, _, false) => (),
        }
        let number = growth.next_number();
        let next = ask(arguments, (&case, &found), (&program, &out, number), silent);
        let next = match next.or_else(|error| none_allowed(error, asked.len()))? {
            Next::Recorded(next) => next,
            Next::Nothing(left_open) => break (Stop::NoExperiment(left_open), found),
        };
        growth.add(
            next.name.clone(),
            &out.join(format!("run-{number}")).join(RECORDING),
        )?;
        asked.push(next);
        known = found.explanations;
    };
    let record = record(&stop, &odds, &asked, start.elapsed().as_secs_f64(), &found);
    let name = &case_name;
    let visited = found
        .diagnosis
        .as_ref()
        .and_then(|own| own.coverage.words());
    let page = page(&stop, (&odds, &asked), (&found.answer, name), visited);
    let document = format!("{record:#}\n");
    let texts = [
        (IMPROVED, found.improved.as_str()),
        (REPORT, &html(&page)),
        (RECORD, &document),
    ];
    folder.write_texts(&NAMES, &texts)?;
    if arguments.json {
        say(&document)?;
    } else if !arguments.quiet {
        say(&text(&page, Style::Plain))?;
    }
    Ok(match stop {
        Stop::Settled | Stop::NothingMissing => ExitCode::Done,
        Stop::NoExperiment(_) | Stop::Runs => ExitCode::OutsideBounds,
    })
}

/// The recording of a run in its folder.
const RECORDING: &str = "recording.csv";

/// Chooses an experiment and has it carried out; none where nothing that is allowed would tell enough.
fn ask(
    arguments: &InvestigateArguments,
    (case, found): (&Case, &Diagnosed),
    (program, out, number): (&RigProgram, &Path, usize),
    silent: bool,
) -> Result<Next, AppError> {
    let allowed = &arguments.allowed;
    let Some(diagnosis) = &found.diagnosis else {
        return Ok(Next::Nothing(Vec::new()));
    };
    let name = format!("run-{number}");
    let run = out.join(&name);
    let (mut force, mut said, mut again) = (None, String::new(), 0);
    let mut refusals = 0;
    while refusals < TRIES {
        let bar = progress::bar("choosing", silent);
        let seed = allowed.seed + 1000 * number as u64 + refusals as u64;
        let proposal = Proposal::of(case, diagnosis, (allowed, seed, force), &mut |done, all| {
            progress::tell(&bar, done, all);
        });
        bar.finish_and_clear();
        let proposal = match proposal {
            // Nothing is gentler than what it has refused.
            Err(AppError::Next(NextError::Limits(LimitError::Force { .. }))) if refusals > 0 => {
                break;
            }
            proposal => proposal?,
        };
        let expected = &proposal.chosen.expected;
        // Of one explanation that is not certain the recording that tells most of its numbers says most as well of whether it holds.
        let gained = match proposal.open.len() {
            // Where but the range is in doubt, its numbers say nothing of that.
            1 if diagnosis.is_doubted_for_its_range() => 0.0,
            1 => expected.how_much,
            _ => expected.which,
        } + proposal.chosen.beyond;
        if gained < WORTH {
            return Ok(Next::Nothing(proposal.left_open()));
        }
        let policy = OverwritePolicy::of(arguments.force || refusals > 0);
        let folder = OutputFolder::prepare_within(&run, &files::NAMES, policy)?;
        write(&folder, &proposal, &found.improved, &case.name)?;
        let recording = run.join(RECORDING);
        // What an earlier investigation left there is no answer.
        let _ = std::fs::remove_file(&recording);
        let columns = files::columns(&proposal);
        loop {
            match program.call((&run.join(files::INPUTS), &columns), &recording)? {
                Reply::Recorded => {
                    let returned = match case.cell() {
                        Some(cell) => Returned::of_cell(&recording, cell)?,
                        None => Returned::of_bench(&recording)?,
                    };
                    check_inputs(&recording, &returned, (&proposal.inputs.time, &columns))?;
                    return Ok(Next::Recorded(Asked {
                        name: format!("{name}.csv"),
                        duration: proposal.chosen.programme.duration(),
                        expected: proposal.expected_probability(),
                        instructions: proposal.chosen.programme.instructions(&proposal.limits),
                    }));
                }
                Reply::Again if again + 1 < TRIES => again += 1,
                Reply::Again => {
                    refusals += 1;
                    again = 0;
                    break;
                }
                Reply::Refuses(why) => {
                    said = why;
                    refusals += 1;
                    force = Some(GENTLER * force.unwrap_or(proposal.limits.force));
                    break;
                }
            }
        }
    }
    Err(program.refused(refusals, said).into())
}

/// Nothing that is allowed, where limits that allowed a recording before allow none under what is open since; otherwise the error.
fn none_allowed(error: AppError, recorded: usize) -> Result<Next, AppError> {
    match error {
        AppError::Next(NextError::Limits(limit)) if recorded > 0 => {
            Ok(Next::Nothing(vec![format!(
                "By what is open now, {limit}."
            )]))
        }
        error => Err(error),
    }
}

fn record(stop: &Stop, odds: &[Odds], asked: &[Asked], seconds: f64, found: &Diagnosed) -> Value {
    let runs = asked.iter().map(|own| {
        json!({
            "recording": own.name,
            "duration_s": own.duration,
            "expected_probability_if_one_of_these": own.expected.map(|p| (p * 1e4).round() / 1e4),
            "instructions": own.instructions,
        })
    });
    json!({
        "stop": stop.words(),
        "left_open": match stop {
            Stop::NoExperiment(left_open) => left_open.as_slice(),
            _ => &[],
        },
        "odds": odds.iter().map(Odds::json).collect::<Vec<_>>(),
        "asked": runs.collect::<Vec<_>>(),
        "answer": found.answer,
        "seconds": seconds,
    })
}

/// Probability of each explanation after each recording.
fn page(
    stop: &Stop,
    (odds, asked): (&[Odds], &[Asked]),
    (answer, case): (&Answer, &str),
    visited: Option<String>,
) -> Document<'static> {
    let last = odds.last();
    let best = last.and_then(|odds| odds.open.first());
    let (name, probability) = best.cloned().unwrap_or_default();
    let verdict = format!(
        "After {} of its own choice: {name}, at {}; {}.",
        crate::quantity::counted(asked.len(), "recording"),
        percent(probability),
        stop.words()
    );
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in odds.iter().rev().flat_map(|odds| &odds.open) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let table = table(odds, asked, &names);
    let drawn = (!asked.is_empty()).then(|| Block::Panel(tree(odds, asked, &names)));
    let mut blocks: Vec<Block<'_>> = drawn.into_iter().chain([Block::Table(table)]).collect();
    blocks.extend(visited.map(Block::Paragraph));
    if let Stop::NoExperiment(left_open) = stop {
        blocks.extend(left_open.iter().cloned().map(Block::Paragraph));
    }
    let mut sections = vec![Section::new(
        "Probability of each explanation after each recording",
        blocks,
    )];
    if let (Stop::NothingMissing, Some(smallest)) = (stop, report::detectable(answer)) {
        sections.push(smallest);
    }
    for own in asked {
        let expected = own.expected.map_or_else(
            || "chosen to hold the one that was open to its numbers".to_owned(),
            |p| {
                format!(
                    "expected to bring the right one, if it is one of these, to {}",
                    percent(p)
                )
            },
        );
        let expected = format!("{:.1} s; {expected}.", own.duration);
        let steps = own.instructions.iter().cloned();
        let blocks = [expected].into_iter().chain(steps).map(Block::Paragraph);
        sections.push(Section::new(
            &format!("Asked for {}", own.name),
            blocks.collect(),
        ));
    }
    Document {
        title: format!("Investigation of {case}"),
        verdict,
        tone: match stop {
            Stop::Settled | Stop::NothingMissing => Tone::Found,
            Stop::NoExperiment(_) | Stop::Runs => Tone::Open,
        },
        sections,
        footer: "Made by idc investigate. The folder case beside this page holds all recordings with their rig file.".to_owned(),
        ..Document::default()
    }
}

/// Probability of each explanation at first and after each recording.
fn table(odds: &[Odds], asked: &[Asked], names: &[&str]) -> Table {
    let mut heads = "explanation | #at first".to_owned();
    for own in asked {
        heads += &format!(" | #after {}", own.name);
    }
    let row = |name: &str| {
        let own = odds.iter().map(|odds| {
            let shown = odds
                .probability(name)
                .map_or_else(|| "below 0.1 %".to_owned(), percent);
            Cell::from(shown)
        });
        [Cell::from(name.to_owned())]
            .into_iter()
            .chain(own)
            .collect::<Vec<_>>()
    };
    let none = [Cell::from("none of these")].into_iter().chain(
        odds.iter()
            .map(|odds| Cell::from(percent(odds.none_of_these))),
    );
    let rows = names.iter().map(|name| row(name)).chain([none.collect()]);
    Table::new("", Column::list(&heads), rows.collect())
}

/// Explanations over the time that was recorded of the program's own choice: each goes on until a recording cuts it.
fn tree(odds: &[Odds], asked: &[Asked], names: &[&str]) -> Panel<'static> {
    let mut ends: Vec<f64> = asked.iter().map(|own| own.duration).collect();
    for place in 1..ends.len() {
        ends[place] += ends[place - 1];
    }
    // What it came to goes on a little, that it is seen.
    let last = ends.last().map_or(1.0, |end| 1.08 * end);
    // Each goes on as it was until the end of a recording.
    let starts = [0.0].into_iter().chain(ends.iter().copied());
    let spans = starts.zip(ends.iter().copied().chain([last]));
    let times: Vec<f64> = spans.flat_map(|(start, end)| [start, end]).collect();
    let series = |label: &str, values: Vec<f64>, (role, stroke)| {
        let values: Vec<f64> = values.into_iter().flat_map(|value| [value; 2]).collect();
        Series::new(label, times.clone(), values, role, stroke)
    };
    let drawn = names.iter().zip(ROLES).map(|(name, role)| {
        let own = odds
            .iter()
            .map(|odds| odds.probability(name).unwrap_or(0.0));
        series(name, own.collect(), (role, Stroke::Plain))
    });
    let none = odds.iter().map(|odds| odds.none_of_these).collect();
    let none = series("none of these", none, (Role::Command, Stroke::Dashed));
    Panel {
        title: String::new(),
        vertical_label: "probability [1]".to_owned(),
        horizontal: Horizontal::Quantity("recorded time [s]".to_owned()),
        series: drawn.chain([none]).collect(),
        within: Some([0.0, 1.0]),
        ..Panel::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After two recordings an explanation was open by which every programme pressed too hard: that ended an investigation with an error, its recordings without a record.
    #[test]
    fn limits_that_allow_nothing_more_end_what_has_begun() {
        let limit = || LimitError::Force {
            most: 3.6,
            least: 65.0,
        };
        let error = |limit| AppError::Next(NextError::Limits(limit));
        assert!(none_allowed(error(limit()), 0).is_err());
        let Ok(Next::Nothing(reasons)) = none_allowed(error(limit()), 2) else {
            panic!("it is an error");
        };
        assert!(reasons[0].contains("`force_n` = 3.600 N"), "{reasons:?}");
        let other = NextError::NoBench {
            case: String::new(),
        };
        assert!(none_allowed(other.into(), 2).is_err());
    }

    /// The folder of an investigation is a case: one that is gone on from wrote its first recording over that of the other.
    #[test]
    fn recordings_of_an_earlier_investigation_keep_their_names() {
        let growth = |names: &[&str]| Growth {
            folder: PathBuf::new(),
            rig: None,
            cell: None,
            names: names.iter().map(|name| (*name).to_owned()).collect(),
        };
        assert_eq!(growth(&["stairs.csv", "run-up.csv"]).next_number(), 1);
        assert_eq!(
            growth(&["run-10.csv", "stairs.csv", "run-2.csv"]).next_number(),
            11
        );
    }
}

//! `idc next`: the experiment that is expected to tell most of what a diagnosis leaves open, as something that runs.

mod error;
mod files;
mod investigate;
mod page;
mod rig_program;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

pub use error::NextError;
pub(super) use investigate::{EXAMPLES as INVESTIGATE_EXAMPLES, InvestigateArguments, investigate};

use super::error::{AppError, ExitCode};
use super::files::{OutputFolder, OverwritePolicy, output_folder};
use super::interrupt::Interruptible;
use super::output::say;
use super::progress::{self, StagedLine};
use crate::case::{Case, Diagnosed, diagnose};
use crate::diagnosis::answer::finding::Diagnosis;
use crate::diagnosis::experiment::choice::{ChoiceSettings, Chosen, choose};
use crate::diagnosis::experiment::information::{Open, Sensors};
use crate::diagnosis::experiment::limits::{Limits, Movable};
use crate::diagnosis::search::progress::Progress;
use crate::diagnosis::settings::Settings;
use crate::document::{Style, text};
use files::NAMES;

/// For the help.
pub(super) const EXAMPLES: &str = "\
The recordings of a rig are diagnosed; then set pressure, valve and surface are
sought that are expected to tell most, per second, of which explanation is right
and, once that is settled, of how large its numbers are. Nothing is moved farther
than [limits] of rig.toml allows and, where it states nothing, than the
recordings moved it; the force on the part is kept by 20 draws of the numbers of
every open explanation. Exit codes: 0 written, 2 bad input.

Examples:
  # Inputs, a bench's scenario, instructions and a picture. (takes minutes)
  idc next assets/proof/cases/case-03 --out runs/next
  # Ten seconds at most, the valve left alone. (takes minutes)
  idc next assets/proof/cases/case-03 --time 10s --may set-pressure,surface";

/// What may be moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum May {
    /// The set pressure.
    SetPressure,
    /// The 5/2 valve.
    Solenoid,
    /// The surface, and whether there is one.
    Surface,
}

/// What an experiment may be.
#[derive(Debug, Args)]
pub(super) struct Allowed {
    /// Longest recording.
    #[arg(long, value_name = "TIME", default_value = "15s", value_parser = super::diagnose::duration)]
    time: std::time::Duration,
    /// What may be moved [default: all].
    #[arg(long, value_delimiter = ',', value_name = "INPUTS")]
    may: Vec<May>,
    /// Cost of preparing a recording, as seconds of recording.
    #[arg(long, value_name = "SECONDS", default_value_t = 5.0, value_parser = seconds)]
    cost: f64,
    /// Programmes that are looked at.
    #[arg(long, value_name = "COUNT", default_value_t = 240, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    programmes: u32,
    /// Seed of what is drawn.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

fn seconds(text: &str) -> Result<f64, String> {
    let value = text
        .parse()
        .ok()
        .filter(|value| (0.0..=1e5).contains(value));
    value.ok_or_else(|| "expected 0 to 100000 seconds".to_owned())
}

impl Allowed {
    fn movable(&self) -> Movable {
        let may = |input: May| self.may.is_empty() || self.may.contains(&input);
        Movable {
            set_pressure: may(May::SetPressure),
            solenoid: may(May::Solenoid),
            surface: may(May::Surface),
        }
    }

    fn settings(&self, seed: u64) -> ChoiceSettings {
        ChoiceSettings {
            programmes: self.programmes as usize,
            seed,
            preparation: self.cost,
        }
    }
}

#[derive(Debug, Args)]
pub(super) struct NextArguments {
    /// Folder with rig.toml and the recordings that it names.
    case: PathBuf,
    #[command(flatten)]
    allowed: Allowed,
    /// Folder for inputs.csv, bench.toml, instructions.txt, expected.svg, report.html and next.json [default: runs/<name of the case's folder>].
    #[arg(long, help_heading = "Output")]
    out: Option<PathBuf>,
    /// Put new results in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print what next.json holds instead of the text.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

/// An experiment for what a diagnosis leaves open.
struct Proposal {
    open: Vec<Open>,
    none_of_these: f64,
    sensors: Sensors,
    limits: Limits,
    chosen: Chosen,
}

impl Proposal {
    /// Of a diagnosis.
    fn of(
        case: &Case,
        diagnosis: &Diagnosis,
        (allowed, seed, force): (&Allowed, u64, Option<f64>),
        observer: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, AppError> {
        let rig = bench_rig(case)?;
        let mut stated = rig.limits;
        stated.force = force.or(stated.force);
        let open = diagnosis.open();
        let sensors = diagnosis.sensors();
        let limits = Limits::new(
            &diagnosis.evidence,
            &stated,
            allowed.movable(),
            allowed.time.as_secs_f64(),
        )
        .map_err(NextError::Limits)?;
        let settings = allowed.settings(seed);
        let chosen =
            choose(&open, &sensors, &limits, &settings, observer).map_err(NextError::Limits)?;
        Ok(Self {
            none_of_these: diagnosis.none_of_these(),
            open,
            sensors,
            limits,
            chosen,
        })
    }

    /// Probability that is expected of the true explanation afterwards [1].
    fn expected_probability(&self) -> f64 {
        let own = self.open.iter().zip(&self.chosen.expected.odds).enumerate();
        let sum: f64 = self.open.iter().map(|own| own.probability).sum();
        own.map(|(place, (open, odds))| open.probability * odds[place])
            .sum::<f64>()
            / sum
    }
}

fn bench_rig(case: &Case) -> Result<&crate::scenario::rig_file::RigFile, NextError> {
    case.bench_rig().ok_or_else(|| NextError::NoBench {
        case: case.name.clone(),
    })
}

/// Diagnoses a case of a rig, with its progress.
fn diagnosed(case: &Case, silent: bool) -> Result<Diagnosed, AppError> {
    let line = StagedLine::new(&super::diagnose::stages::first(), silent);
    let mut stages = super::diagnose::stages::Stages::default();
    let found = diagnose(case, &Settings::default(), &mut |now: &Progress<'_>| {
        let (words, share) = stages.shown(now);
        line.tell(words, share);
    });
    line.end();
    Ok(found?)
}

/// Chooses an experiment and writes it.
pub(super) fn run(arguments: &NextArguments) -> Result<ExitCode, AppError> {
    let silent = arguments.quiet || arguments.json;
    let case = Case::from_folder(&arguments.case)?;
    bench_rig(&case)?;
    let out = output_folder(arguments.out.as_ref(), &arguments.case);
    let folder = OutputFolder::prepare(&out, &NAMES, OverwritePolicy::of(arguments.force))?;
    let _interruptible = Interruptible::of_one("choice", &out);
    let found = diagnosed(&case, silent)?;
    let Some(diagnosis) = &found.diagnosis else {
        return Err(NextError::NoBench { case: case.name }.into());
    };
    let bar = progress::bar("choosing", silent);
    let allowed = &arguments.allowed;
    let proposal = Proposal::of(
        &case,
        diagnosis,
        (allowed, allowed.seed, None),
        &mut |done, all| progress::tell(&bar, done, all),
    );
    bar.finish_and_clear();
    let proposal = proposal?;
    let document = write(&folder, &proposal, &found.improved, &case.name)?;
    if arguments.json {
        say(&document)?;
    } else if !arguments.quiet {
        say(&text(
            &page::of_proposal(&proposal, &case.name),
            Style::Plain,
        ))?;
    }
    Ok(ExitCode::Done)
}

/// Writes all files of an experiment; gives next.json.
fn write(
    folder: &OutputFolder,
    proposal: &Proposal,
    improved: &str,
    case: &str,
) -> Result<String, AppError> {
    let document = format!("{:#}\n", files::json(proposal));
    let bench = files::bench(proposal, case);
    let picture = page::picture(proposal)?;
    let page = crate::document::html(&page::of_proposal(proposal, case));
    let inputs = files::inputs(proposal)?;
    let instructions = proposal.chosen.programme.instructions().join("\n") + "\n";
    let texts = [
        (files::INPUTS, inputs.as_str()),
        (files::BENCH, &bench),
        (files::DEVICE, improved),
        (files::INSTRUCTIONS, &instructions),
        (files::EXPECTED, &picture),
        (super::files::REPORT, &page),
        (files::NEXT, &document),
    ];
    folder.write_texts(&NAMES, &texts)?;
    Ok(document)
}

/// A file in a folder, for messages.
fn within(folder: &Path, name: &str) -> PathBuf {
    folder.join(name)
}

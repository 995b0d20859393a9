//! Arguments of `idc run`, and one run.

use std::path::PathBuf;

use clap::Args;

use super::super::advice::AdviceArguments;
use super::super::error::{AppError, ExitCode};
use super::super::files::{OutputFolder, OverwritePolicy, RUN_NAMES, output_folder};
use super::super::interrupt::Interruptible;
use super::super::output::show;
use super::super::progress;
use super::super::terminal::say_aside;
use super::super::viewer::{Viewing, Watch};
use super::job::RunOptions;
use super::settings::{Setting, Variant, with_flags};
use super::source::Source;
use crate::document::Style;
use crate::run::{Job, RunError};
use crate::scenario::{AnyScenario, EffectRequest, ScenarioTemplate};
use crate::viewer::Opening;

#[derive(Debug, Args)]
pub(in super::super) struct RunArguments {
    /// Scenario file.
    pub(super) scenario: PathBuf,
    /// Another value for a key of the scenario by its dotted path, as in process.force_n=150; of several values, divided by commas, each is run, and of several --set each combination.
    #[arg(long = "set", value_name = "KEY=VALUE[,VALUE..]", value_parser = Setting::parse)]
    pub(super) settings: Vec<Setting>,
    /// An effect of the catalogue to put in: its name, and those of its numbers that are not to have their usual size, in any unit of theirs, as in tool_runout:amplitude_mm=0.1,frequency_hz=120 or joint_friction:joint=3, of an arm file as in wrench_drift:channel=force_x; may be given several times.
    #[arg(long = "with", value_name = "EFFECT[:KEY=VALUE,..]", value_parser = EffectRequest::parse)]
    pub(super) effects: Vec<EffectRequest>,
    /// With --set, leave runs as they are that stand complete, as of one that was interrupted.
    #[arg(long, requires = "settings", conflicts_with = "force")]
    pub(super) resume: bool,
    #[command(flatten)]
    advice: AdviceArguments,
    /// Folder for recording.rrd, samples.parquet and summary.json; of several runs, for a folder each and compare.html [default: runs/<scenario name>].
    #[arg(long, help_heading = "Output")]
    pub(super) out: Option<PathBuf>,
    /// Watch the run while it goes on: `native` or `web` viewer, `web:PORT`, or the address at which one listens [default: native where it is installed, otherwise web].
    #[arg(long, value_name = "WHERE", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    pub(super) view: Option<String>,
    /// Put new results in place of old ones.
    #[arg(long, help_heading = "Output")]
    pub(super) force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    pub(super) quiet: bool,
    /// Print what summary.json holds instead of the table; of several runs a list of it.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    pub(super) json: bool,
    /// Leave out recording.rrd, as for many runs of which only the numbers are wanted.
    #[arg(long, help_heading = "Output")]
    pub(super) no_recording: bool,
    /// Write recording.mcap as well: all signals as messages of ROS 2, for Foxglove and `ros2 bag`; `idc import` reads it back without a map.
    #[arg(long, help_heading = "Output")]
    pub(super) mcap: bool,
    /// Let the recording open at a moment of simulated time [s] and stay there, for pictures.
    #[arg(long, hide = true)]
    hold_at_s: Option<f64>,
}

impl RunArguments {
    /// Where results go.
    pub(super) fn folder(&self) -> PathBuf {
        output_folder(self.out.as_ref(), &self.scenario)
    }

    pub(super) fn run_options(&self) -> RunOptions {
        RunOptions {
            recorded: !self.no_recording,
            with_bag: self.mcap,
            opening: self.hold_at_s.map_or(Opening::Following, Opening::At),
            style: match anstream::AutoStream::choice(&std::io::stdout()) {
                anstream::ColorChoice::Never => Style::Plain,
                _ => Style::Coloured,
            },
        }
    }

    pub(super) fn policy(&self) -> OverwritePolicy {
        match self.resume {
            true => OverwritePolicy::Keep,
            false => OverwritePolicy::of(self.force),
        }
    }
}

/// Runs one scenario; where it is varied, of that template.
pub(super) fn one(
    arguments: &RunArguments,
    scenario: AnyScenario,
    varied: Option<(&ScenarioTemplate, &Variant)>,
) -> Result<ExitCode, AppError> {
    if matches!(scenario, AnyScenario::Bench(_)) && arguments.hold_at_s.is_some() {
        return Err(AppError::NoBench {
            option: "hold-at-s",
        });
    }
    let viewing = arguments.view.as_deref().map(Viewing::parse).transpose()?;
    let quiet = arguments.quiet || arguments.json;
    let job = Job::new(scenario)
        .map_err(AppError::from)
        .map_err(|error| {
            let read = || ScenarioTemplate::read(&arguments.scenario);
            let error = match varied {
                Some((template, variant)) => {
                    (arguments.advice).with_advice(error, template, &variant.edits, quiet)
                }
                None => match (&error, read()) {
                    (AppError::Run(run), Ok(template)) if matches!(**run, RunError::Cell(_)) => {
                        (arguments.advice).with_advice(error, &template, &[], quiet)
                    }
                    _ => error,
                },
            };
            match varied {
                Some((_, variant)) => with_flags(error, &variant.edits),
                None => error,
            }
        })?;
    let path = arguments.folder();
    let folder = OutputFolder::prepare(&path, &RUN_NAMES, OverwritePolicy::of(arguments.force))?;
    let source = match varied {
        Some((template, variant)) => Source::varied(template, &variant.edits, None, folder.path())?,
        None => Source::file(&arguments.scenario),
    };
    if !quiet {
        for note in job.notes() {
            say_aside(&format!("note: {note}"));
        }
    }
    let watch = viewing.map(Watch::begin).transpose()?;
    let address = watch.as_ref().and_then(Watch::address);
    if let (Some(address), false) = (address, arguments.quiet) {
        say_aside(&format!("watch the run at {address}"));
    }
    let interruptible = Interruptible::of_one("run", &path);
    let bar = progress::bar("simulating", quiet);
    let progress = &mut |done, total| progress::tell(&bar, done, total);
    let outcome = job.perform(
        &source,
        &folder,
        arguments.run_options(),
        watch.as_ref(),
        progress,
    );
    bar.finish_and_clear();
    let outcome = outcome?;
    // From here on all is in its place.
    drop(interruptible);
    show(
        [arguments.quiet, arguments.json],
        &outcome.document,
        &outcome.table,
        &folder,
        &outcome.names,
    )?;
    for line in &outcome.messages {
        say_aside(line);
    }
    if let Some(watch) = watch {
        let (scene, summary) = outcome.shown;
        watch.close(scene, summary, quiet);
    }
    Ok(outcome.code)
}

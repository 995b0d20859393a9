//! `idc prove`, with --sweep too, and `idc laboratory`: the diagnosis on cases of which the truth is known, but not to it.

use std::path::{Path, PathBuf};

use super::diagnose::answer_case;
use clap::Args;
use clap::builder::PossibleValue;

use super::error::{AppError, ExitCode};
use super::files::{OutputFolder, OverwritePolicy, claim_folder, prepare_file};
use super::interrupt::Interruptible;
use super::output::say;
use super::progress;
use super::terminal::{say_aside, shown_path};
use crate::document::{Style, text};
use crate::laboratory::{Recipe, shipped};
use crate::proof::{
    CaseConditions, Claims, Course, Diagnose, DrawPlan, LEAST_SHARE, ProofError, SweepPlan,
    folders, laws, laws_page, page, prove, sweep, write_recipes,
};
use crate::quantity::counted;
use crate::recording::RecordingError;
use crate::recording::atomic::{UnfinishedFolder, make_folder, write_text};
use crate::recording::claim::{clear_beside, clear_unfinished};
use crate::recording::provenance::SourceFile;

/// The cases that come with the project, from its folder.
const CASES: &str = "assets/proof/cases";

#[derive(Debug, Args)]
pub(super) struct ProveArguments {
    /// Folder of cases, each a folder with rig.toml and recordings [default: assets/proof/cases where that is, as in the project's folder; elsewhere the laboratory makes the same cases, into `laboratory` in the folder for the answers].
    #[arg(long)]
    cases: Option<PathBuf>,
    /// Folder of what is sealed, opened only once all is diagnosed [default: the folder `sealed` beside that of the cases].
    #[arg(long)]
    sealed: Option<PathBuf>,
    /// Names of the cases to take [default: all].
    #[arg(long, num_args = 1.., value_name = "NAME")]
    only: Vec<String>,
    /// Instead, try the diagnosis on every effect, from its largest size down to where it is lost, and on devices with nothing missing; outcomes, one file for each, and tables.
    #[arg(long, conflicts_with_all = ["cases", "sealed", "only"])]
    sweep: bool,
    #[command(flatten)]
    plan: SweepArguments,
    /// Folder for the answers, or outcomes [default: runs/proof, with --sweep runs/proof-sweep].
    #[arg(long, help_heading = "Output")]
    out: Option<PathBuf>,
    /// Cases at a time [default: as many as there are processors].
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Print the score, or the outcomes, as JSON.
    #[arg(long, help_heading = "Output")]
    json: bool,
    /// Put new results in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
}

/// What --sweep takes.
#[derive(Debug, Args)]
#[command(next_help_heading = "With --sweep")]
struct SweepArguments {
    /// Effects by name, divided by commas [default: all of the vocabulary].
    #[arg(long, requires = "sweep", value_delimiter = ',')]
    effects: Vec<String>,
    /// Instead of effects, this many devices with a law each that no list holds, drawn at random; a table in laws.md.
    #[arg(long, requires = "sweep", conflicts_with_all = ["effects", "seeds", "sizes", "empty"], value_parser = clap::value_parser!(u64).range(1..=1000))]
    laws: Option<u64>,
    /// Devices for each size of each effect.
    #[arg(long, requires = "sweep", default_value_t = 5, value_parser = clap::value_parser!(u64).range(0..=1000))]
    seeds: u64,
    /// Sizes of each effect.
    #[arg(long, requires = "sweep", default_value_t = 4, value_parser = clap::value_parser!(u16).range(1..=16))]
    sizes: u16,
    /// Devices with nothing missing.
    #[arg(long, requires = "sweep", default_value_t = 150)]
    empty: u64,
    /// Which devices are drawn: another number, others.
    #[arg(long, requires = "sweep", default_value_t = 0, value_parser = clap::value_parser!(u64).range(0..1_000_000))]
    draw: u64,
    /// Length of each recording [s].
    #[arg(long, requires = "sweep", default_value_t = 4.0, value_parser = duration)]
    duration_s: f64,
    /// Conditions under which the devices are recorded.
    #[arg(long, requires = "sweep", value_enum, default_value_t)]
    conditions: CaseConditions,
    /// Go on where it was stopped.
    #[arg(long, requires = "sweep", conflicts_with = "force")]
    resume: bool,
    /// File for the tables [default: CONFUSION.md in the output folder, laws.md with --laws].
    #[arg(long, requires = "sweep")]
    page: Option<PathBuf>,
    /// Print nothing but errors.
    #[arg(long, requires = "sweep", conflicts_with = "json")]
    quiet: bool,
}

impl ProveArguments {
    /// Where its results go.
    fn folder(&self) -> PathBuf {
        let usual = match self.sweep {
            true => "runs/proof-sweep",
            false => "runs/proof",
        };
        self.out.clone().unwrap_or_else(|| usual.into())
    }
}

/// Length of a recording [s].
fn duration(text: &str) -> Result<f64, String> {
    let expected = || format!("`{text}` is no length of a recording, expected 2 to 60 s");
    let value: f64 = text.parse().map_err(|_| expected())?;
    if (2.0..=60.0).contains(&value) {
        Ok(value)
    } else {
        Err(expected())
    }
}

#[derive(Debug, Args)]
pub(super) struct LaboratoryArguments {
    /// Folder for `cases` and `sealed`.
    #[arg(long, help_heading = "Output", required_unless_present = "rig")]
    out: Option<PathBuf>,
    /// Instead, be the rig of a case: carry out these inputs on its device and write the recording, as `idc investigate --rig` asks a program to.
    #[arg(long, num_args = 3, value_names = ["CASE", "IN.csv", "OUT.csv"], conflicts_with = "out")]
    rig: Option<Vec<PathBuf>>,
    /// Instead, the cases of `idc prove --sweep --laws` of this many: devices with a law each that no list holds.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=1000))]
    laws: Option<u64>,
    /// Instead, this many devices: nothing missing in one, an effect of the vocabulary in the next.
    #[arg(long, conflicts_with = "laws", value_parser = clap::value_parser!(u64).range(1..=1000))]
    devices: Option<u64>,
    /// With --laws or --devices, which are drawn: another number, others.
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u64).range(0..1_000_000))]
    draw: u64,
    /// With --laws or --devices, length of each recording [s].
    #[arg(long, default_value_t = 4.0, value_parser = duration)]
    duration_s: f64,
    /// With --devices, the smallest effect, as a share of the largest that is plausible.
    #[arg(long, default_value_t = LEAST_SHARE, value_parser = share)]
    smallest: f64,
    /// The largest.
    #[arg(long, default_value_t = 1.0, value_parser = share)]
    largest: f64,
    /// With --devices, conditions under which they are recorded.
    #[arg(long, value_enum, default_value_t)]
    conditions: CaseConditions,
    /// Put new results in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print as JSON which cases were written.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

/// A share of an effect.
fn share(text: &str) -> Result<f64, String> {
    let value = text
        .parse()
        .ok()
        .filter(|share| (1e-3..=1.0).contains(share));
    value.ok_or_else(|| "expected a share from 0.001 to 1".to_owned())
}

impl LaboratoryArguments {
    fn plan(&self, count: u64, conditions: CaseConditions) -> DrawPlan {
        DrawPlan {
            count,
            draw: self.draw,
            duration: self.duration_s,
            conditions,
            shares: [self.smallest.min(self.largest), self.largest],
        }
    }
}

/// The program's own diagnosis of a case.
fn diagnose() -> Box<Diagnose<'static>> {
    Box::new(|case: &Path, out: &Path| answer_case(case, out).map_err(|error| error.to_string()))
}

fn jobs(asked: Option<u16>) -> usize {
    let processors = || std::thread::available_parallelism().map_or(1, usize::from);
    asked.map_or_else(processors, usize::from)
}

/// Proves and prints the score, or sweeps.
pub(super) fn run(arguments: &ProveArguments) -> Result<ExitCode, AppError> {
    match arguments.sweep {
        true => run_sweep(arguments),
        false => run_prove(arguments),
    }
}

fn run_prove(arguments: &ProveArguments) -> Result<ExitCode, AppError> {
    let jobs = jobs(arguments.jobs);
    let out = &arguments.folder();
    let (cases, _folder) = prepare_proof(arguments)?;
    let beside = || cases.parent().unwrap_or(Path::new("")).join("sealed");
    let sealed = arguments.sealed.clone().unwrap_or_else(beside);
    let bar = progress::bar("proving", arguments.json);
    let interruptible = Interruptible::new({
        let out = out.display().to_string();
        move |done| {
            format!(
                "{} kept in {out}, without a score; the same command with --force begins anew, --only NAME.. does some of the cases",
                counted(done, "answer")
            )
        }
    });
    let summary = prove(
        &cases,
        &sealed,
        &arguments.only,
        out,
        jobs,
        &*diagnose(),
        &|done, total| {
            interruptible.at(done);
            progress::tell(&bar, done, total);
        },
    );
    bar.finish_and_clear();
    let summary = summary?;
    let short = summary.shortfalls(&Claims::PAGE);
    if arguments.json {
        say(&(serde_json::to_string_pretty(&summary)? + "\n"))?;
    } else {
        say(&text(&summary.document(), Style::Plain))?;
        for sentence in &short {
            say(&format!("falls short: {sentence}\n"))?;
        }
    }
    Ok(if short.is_empty() {
        ExitCode::Done
    } else {
        ExitCode::OutsideBounds
    })
}

/// Sweeps and writes the tables.
fn run_sweep(arguments: &ProveArguments) -> Result<ExitCode, AppError> {
    let (asked, out) = (&arguments.plan, arguments.folder());
    let plan = SweepPlan {
        effects: asked.effects.clone(),
        seeds: asked.seeds,
        draw: asked.draw,
        sizes: usize::from(asked.sizes),
        empty: asked.empty,
        duration: asked.duration_s,
        conditions: asked.conditions,
        jobs: jobs(arguments.jobs),
        resume: asked.resume,
        replace: arguments.force,
    };
    let table = if asked.laws.is_some() {
        "laws.md"
    } else {
        "CONFUSION.md"
    };
    let usual = || out.join(table);
    let file = asked.page.clone().unwrap_or_else(usual);
    // The tables of a sweep that goes on take the place of its own earlier ones.
    let option = if asked.page.is_some() {
        "--page"
    } else {
        "--out"
    };
    plan.check()?;
    let policy = OverwritePolicy::of(arguments.force || asked.resume);
    let _claims = (prepare_file(&file, option, policy)?, claim_folder(&out)?);
    let silent = asked.quiet || arguments.json;
    let bar = progress::bar("sweeping", silent);
    let interruptible = Interruptible::new({
        let out = out.display().to_string();
        move |done| {
            format!(
                "{} kept in {out}; the same command with --resume goes on",
                counted(done, "outcome")
            )
        }
    });
    let tell = |done: usize, total: usize, line: &str| {
        interruptible.at(done);
        progress::tell(&bar, done, total);
        if silent {
        } else if bar.is_hidden() {
            say_aside(&format!("{done} of {total}: {line}"));
        } else {
            progress::above(&bar, &format!("{done} of {total}: {line}"));
        }
    };
    let found = swept(asked, &plan, &out, &tell);
    bar.finish_and_clear();
    let (count, text, json) = found?;
    write_text(&file, &text)?;
    if arguments.json {
        say(&(json + "\n"))?;
    } else if !asked.quiet {
        if asked.laws.is_some() {
            say(&text)?;
        }
        say(&format!(
            "{}, tables in {}\n",
            counted(count, "outcome"),
            shown_path(&file)
        ))?;
    }
    Ok(ExitCode::Done)
}

/// Outcomes of a sweep over effects or laws: how many there are, their tables, and as JSON.
fn swept(
    asked: &SweepArguments,
    plan: &SweepPlan,
    out: &Path,
    tell: &(dyn Fn(usize, usize, &str) + Sync),
) -> Result<(usize, String, String), AppError> {
    let Some(count) = asked.laws else {
        let outcomes = sweep(plan, out, &*diagnose(), tell)?;
        let json = serde_json::to_string_pretty(&outcomes)?;
        return Ok((outcomes.len(), page(&outcomes), json));
    };
    let course = Course {
        out,
        jobs: plan.jobs,
        resume: plan.resume,
        replace: plan.replace,
    };
    let outcomes = laws(&law_plan(count, asked), &course, &*diagnose(), tell)?;
    let json = serde_json::to_string_pretty(&outcomes)?;
    Ok((outcomes.len(), laws_page(&outcomes), json))
}

fn law_plan(count: u64, arguments: &SweepArguments) -> DrawPlan {
    DrawPlan {
        count,
        draw: arguments.draw,
        duration: arguments.duration_s,
        conditions: arguments.conditions,
        shares: [LEAST_SHARE, 1.0],
    }
}

/// Writes the project's own cases.
pub(super) fn run_laboratory(arguments: &LaboratoryArguments) -> Result<ExitCode, AppError> {
    if let Some([name, inputs, recording]) = arguments.rig.as_deref() {
        return carry_out(arguments, &name.display().to_string(), [inputs, recording]);
    }
    let out = &arguments.out.clone().unwrap_or_default();
    let [cases, sealed] = ["cases", "sealed"].map(|name| out.join(name));
    if let Some(found) = [&cases, &sealed].into_iter().find(|path| path.exists())
        && !arguments.force
    {
        return Err(AppError::ResultsExist {
            folder: out.display().to_string(),
            name: found.file_name().unwrap_or_default().display().to_string(),
        });
    }
    let _claim = claim_folder(out)?;
    clear_unfinished(out);
    clear_beside(out, &[]);
    let quiet = arguments.quiet || arguments.json;
    let plan = |count: u64, conditions: CaseConditions| arguments.plan(count, conditions);
    let what = match (arguments.laws, arguments.devices) {
        (Some(count), _) => Which::Laws(plan(count, CaseConditions::Laboratory)),
        (None, Some(count)) => Which::Devices(plan(count, arguments.conditions)),
        (None, None) => Which::Shipped(&[]),
    };
    let names = make_cases(out, &what, quiet)?;
    if arguments.json {
        let document = serde_json::json!({ "cases": names, "folder": cases.display().to_string(), "sealed": sealed.display().to_string() });
        say(&format!("{document:#}\n"))?;
    } else if !arguments.quiet {
        say(&format!(
            "{} written to {}, their truth to {}\n",
            counted(names.len(), "case"),
            shown_path(&cases),
            shown_path(&sealed)
        ))?;
    }
    Ok(ExitCode::Done)
}

/// Carries inputs out on the device of a case.
fn carry_out(
    arguments: &LaboratoryArguments,
    name: &str,
    [inputs, recording]: [&Path; 2],
) -> Result<ExitCode, AppError> {
    let recipe = match (arguments.laws, arguments.devices) {
        (Some(count), _) => arguments
            .plan(count, CaseConditions::Laboratory)
            .law_named(name)?,
        (None, Some(count)) => arguments
            .plan(count, arguments.conditions)
            .device_named(name),
        (None, None) => shipped().into_iter().find(|recipe| recipe.name == name),
    };
    let recipe = recipe.ok_or_else(|| ProofError::NoCase {
        name: name.to_owned(),
    })?;
    // Noise of its own for each list of inputs, the same for the same.
    let bytes = crate::file::read(inputs).map_err(|error| RecordingError::read(inputs, error))?;
    let turn = SourceFile::holding("", &bytes)
        .sha256
        .bytes()
        .fold(0u64, |sum, byte| {
            sum.wrapping_mul(31).wrapping_add(u64::from(byte)) % 1_000_003
        });
    recipe
        .carry_out(inputs, recording, 1 + turn)
        .map_err(ProofError::from)?;
    Ok(ExitCode::Done)
}

/// Cases that are made.
enum Which<'a> {
    /// The project's own, all or those named.
    Shipped(&'a [String]),
    /// Devices with a law each.
    Laws(DrawPlan),
    /// Devices with nothing missing and with an effect of the vocabulary in turn.
    Devices(DrawPlan),
}

/// Makes cases into `cases` and `sealed` of a folder: all of them appear, or none. Returns their names.
fn make_cases(out: &Path, which: &Which<'_>, quiet: bool) -> Result<Vec<String>, AppError> {
    let _interruptible = Interruptible::of_one("laboratory", out);
    let cannot = |error: std::io::Error| AppError::OutputFolder {
        folder: out.display().to_string(),
        reason: error.to_string(),
    };
    make_folder(out).map_err(cannot)?;
    let unfinished = UnfinishedFolder::within(out)?;
    let [cases, sealed] = ["cases", "sealed"].map(|name| unfinished.path().join(name));
    let bar = progress::bar("making", quiet);
    let tell = |done: usize, total: usize| progress::tell(&bar, done, total);
    let made = match which {
        Which::Shipped(only) => make_shipped(&cases, &sealed, only, &tell),
        Which::Laws(plan) => plan.write_laws(&cases, &sealed, &tell),
        Which::Devices(plan) => plan.write_devices(&cases, &sealed, &tell),
    };
    bar.finish_and_clear();
    let made = made?;
    let mut files = Vec::new();
    note_files(unfinished.path(), Path::new(""), &mut files).map_err(cannot)?;
    let names: Vec<&str> = files.iter().map(String::as_str).collect();
    unfinished.finish(&names, &[], &[])?;
    Ok(made)
}

/// Makes the project's own cases, all or those named.
fn make_shipped(
    cases: &Path,
    sealed: &Path,
    only: &[String],
    tell: &dyn Fn(usize, usize),
) -> Result<Vec<String>, ProofError> {
    let wanted = |recipe: &Recipe| only.is_empty() || only.contains(&recipe.name);
    let recipes = shipped().into_iter().filter(wanted).map(Ok);
    write_recipes(recipes, (cases, sealed), tell)
}

/// Files below a folder, by their paths from it.
fn note_files(folder: &Path, from: &Path, found: &mut Vec<String>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder.join(from))? {
        let path = from.join(entry?.file_name());
        if folder.join(&path).is_dir() {
            note_files(folder, &path, found)?;
        } else {
            found.push(path.display().to_string());
        }
    }
    found.sort();
    Ok(())
}

/// The cases to prove with. Refuses to prove into a folder that holds an answer to one of them, or cannot be written.
fn prepare_proof(arguments: &ProveArguments) -> Result<(PathBuf, OutputFolder), AppError> {
    let usual = || PathBuf::from(CASES);
    let there = arguments
        .cases
        .clone()
        .or_else(|| usual().is_dir().then(usual));
    let names: Vec<String> = match &there {
        Some(cases) => {
            let found = folders(cases, &arguments.only)?;
            found.into_iter().map(|(name, _)| name).collect()
        }
        None => shipped_names(&arguments.only)?,
    };
    for name in names.iter().filter(|_| !arguments.force) {
        let answer = Path::new(name).join("diagnosis.json");
        if arguments.folder().join(&answer).exists() {
            return Err(AppError::ResultsExist {
                folder: arguments.folder().display().to_string(),
                name: answer.display().to_string(),
            });
        }
    }
    let folder = OutputFolder::prepare(&arguments.folder(), &[], OverwritePolicy::Replace)?;
    if let Some(cases) = there {
        return Ok((cases, folder));
    }
    let made = arguments.folder().join("laboratory");
    if !arguments.json {
        say_aside(&format!(
            "note: there is no {CASES} here, so the laboratory makes the same cases, into {}",
            shown_path(&made)
        ));
    }
    make_cases(&made, &Which::Shipped(&arguments.only), arguments.json)?;
    Ok((made.join("cases"), folder))
}

/// Names of the project's cases, all or those that are asked for.
fn shipped_names(only: &[String]) -> Result<Vec<String>, AppError> {
    let names: Vec<String> = shipped().into_iter().map(|recipe| recipe.name).collect();
    match only.iter().find(|name| !names.contains(name)) {
        Some(name) => Err(AppError::NoShippedCase {
            name: name.clone(),
            known: names.join(", "),
        }),
        None if only.is_empty() => Ok(names),
        None => Ok(only.to_vec()),
    }
}

impl clap::ValueEnum for CaseConditions {
    fn value_variants<'a>() -> &'a [Self] {
        &[
            Self::Laboratory,
            Self::Shop,
            Self::Imperfect,
            Self::MidMotion,
            Self::MissingChannel,
            Self::FreePhases,
            Self::WrongNoise,
        ]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let (name, help) = match self {
            Self::Laboratory => ("laboratory", "An ideal laboratory"),
            Self::Shop => (
                "shop",
                "A real device's imperfections, 50 to 1000 Hz, sheet noise off by up to two, coarse converters, dirt",
            ),
            Self::Imperfect => ("imperfect", "Imperfections below the noise"),
            Self::MidMotion => ("mid-motion", "Recordings that begin in mid-motion"),
            Self::MissingChannel => ("missing-channel", "One channel missing"),
            Self::FreePhases => (
                "free-phases",
                "Periodic phases drawn anew in each recording",
            ),
            Self::WrongNoise => ("wrong-noise", "Sheet noise off by two"),
        };
        Some(PossibleValue::new(name).help(help))
    }
}

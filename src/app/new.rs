//! `idc new`: a commented file to start from, which can be used as it stands. What a cell needs beside it (arm, device, part) comes with the program.

mod arm;
mod part;
mod recorded_arm;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::error::{AppError, ExitCode};
use super::files::{OverwritePolicy, prepare_files};
use super::output::say;
use crate::case::{POSTURES, RIG};
use crate::import::{Draft, draft};
use crate::recording::atomic::write_all;
use crate::scenario::removal_table::REMOVAL_TABLE;
use crate::shell::word;
use part::Files;

/// For the help.
pub(super) const EXAMPLES: &str = "\
Exit codes: 0 done, 2 bad input, or a file that stands already (--force).

Examples:
  # A robot cell; arm, device and part go beside it.
  idc new cell runs/mine/cell.toml
  idc run runs/mine/cell.toml --out runs/mine/first
  # The same with a part of one's own; --urdf takes an arm.
  idc new cell runs/mine/own.toml --part assets/bracket.stl
  # A rig file and an import map, for logs of a device on a bench.
  idc new rig runs/mine/rig.toml
  idc new import runs/mine/map.toml
  # Runs of a tool and what it took off, with a table beside it.
  idc new removal_table runs/mine/belt/rig.toml
  idc diagnose runs/mine/belt --out runs/mine/belt_found
  # Still postures of a wrench sensor, with a table beside it.
  idc new postures runs/mine/wrist/postures.toml
  # An import map by looking at logs: what it tells of them and how sure it is
  # stands in its comments, and what it asks for.
  idc new import runs/mine/looked.toml --from assets/first/stairs.csv
  # A recorded arm, from its URDF; with --log what a log of it shows, too.
  idc new arm runs/mine/arm/arm.toml --urdf models/arm/arm10.urdf
  # Each can be checked.
  idc check runs/mine/rig.toml";

/// Where a template names the folder of models.
const MODELS: &str = "MODELS";
/// Where a template names a table.
const TABLE: &str = "TABLE";
/// Rows of a table of runs, and of one of postures.
const RUNS: &[u8] = include_bytes!("../../assets/new/removal_runs.csv");
const STILLS: &[u8] = include_bytes!("../../assets/new/stills.csv");
/// Files that a cell needs.
const BESIDE: [(&str, &[u8]); 3] = [
    ("arm10.urdf", include_bytes!("../../models/arm/arm10.urdf")),
    ("device.toml", include_bytes!("../../models/device.toml")),
    ("plate.stl", include_bytes!("../../assets/plate.stl")),
];

#[derive(Debug, Args)]
pub(super) struct NewArguments {
    /// Kind of file to begin with.
    #[arg(value_enum)]
    kind: Kind,
    /// File to write [default: new_KIND.toml].
    file: Option<PathBuf>,
    /// Logs for the map to be drafted by looking at them: text, .parquet, .mat, .mcap, .db3 or a bag's folder. A last one that ends in .toml is FILE.
    #[arg(long, value_name = "LOG", num_args = 1.., help_heading = "Input")]
    from: Vec<PathBuf>,
    /// URDF or xacro file of a recorded arm; or of the arm of a cell, in place of the one that comes with the program. Masses and limits that it lacks are estimated, marked so in the file; a device that it can carry is chosen, and the part put where it reaches.
    #[arg(long, value_name = "FILE", help_heading = "Input")]
    urdf: Option<PathBuf>,
    /// Log of a recorded arm: its rate, its noise, and whether it holds currents or torques.
    #[arg(long, value_name = "CSV", requires = "urdf", help_heading = "Input")]
    log: Option<PathBuf>,
    /// Mesh of the part of a cell, in place of the plate: its longest edge that the tool can ride is chosen, and the part put where the robot reaches it.
    #[arg(long, value_name = "FILE", help_heading = "Input")]
    part: Option<PathBuf>,
    /// The same as FILE.
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with = "file",
        help_heading = "Output"
    )]
    out: Option<PathBuf>,
    /// Put new files in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print as JSON what was written.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Kind {
    /// A scenario: arm, device and part.
    Cell,
    /// A rig file: a device by its nominal values.
    Rig,
    /// A recorded arm: links by its URDF, drives, load and sensors.
    Arm,
    /// Still postures of a wrench sensor.
    Postures,
    /// An import map: what the columns of a log are.
    Import,
    /// A table of runs: what a tool took off at which settings.
    #[value(name = "removal_table")]
    RemovalTable,
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Cell => "cell",
            Self::Rig => "rig",
            Self::Arm => "arm",
            Self::Postures => "postures",
            Self::Import => "import",
            Self::RemovalTable => REMOVAL_TABLE,
        }
    }

    fn template(self) -> &'static str {
        match self {
            Self::Cell => include_str!("../../assets/new/cell.toml"),
            Self::Rig => include_str!("../../assets/new/rig.toml"),
            // Made of its URDF.
            Self::Arm => "",
            Self::Postures => include_str!("../../assets/new/postures.toml"),
            Self::Import => include_str!("../../assets/new/import.toml"),
            Self::RemovalTable => include_str!("../../assets/new/removal_table.toml"),
        }
    }

    /// Next step with the file.
    fn next(self, file: &Path) -> String {
        let folder = file
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty());
        let folder = word(folder.unwrap_or(Path::new(".")));
        let is_case = file.ends_with(match self {
            Self::Postures => POSTURES,
            _ => RIG,
        });
        let file = word(file);
        match self {
            Self::Cell => format!("idc run {file}"),
            Self::Rig | Self::Arm => format!("idc check {file}"),
            Self::Import => format!("idc import {file} LOG.csv"),
            Self::RemovalTable | Self::Postures if is_case => format!("idc diagnose {folder}"),
            Self::RemovalTable | Self::Postures => format!("idc check {file}"),
        }
    }
}

/// Writes a file to start from.
pub(super) fn run(arguments: &NewArguments) -> Result<ExitCode, AppError> {
    let kind = arguments.kind;
    let usual = || PathBuf::from(format!("new_{}.toml", kind.name()));
    let mut logs = arguments.from.clone();
    if !logs.is_empty() && !matches!(kind, Kind::Import) {
        return Err(AppError::NotDrafted { kind: kind.name() });
    }
    let mut given = arguments.file.clone().or_else(|| arguments.out.clone());
    let is_map = |path: &&PathBuf| path.extension().is_some_and(|ending| ending == "toml");
    if given.is_none() && logs.len() > 1 && logs.last().as_ref().is_some_and(is_map) {
        given = logs.pop();
    }
    let file = given.unwrap_or_else(usual);
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    if let Some(letter) = stem.chars().find(|c| "\"\\".contains(*c) || c.is_control()) {
        return Err(AppError::Unwritable {
            file: file.display().to_string(),
            letter,
        });
    }
    let drafted = match &logs[..] {
        [] => None,
        logs => Some(draft(&stem.replace('_', " "), logs)?),
    };
    check_options(arguments)?;
    let (files, of_arm) = match &drafted {
        None => match (kind, &arguments.urdf) {
            (Kind::Arm, Some(urdf)) => {
                let (text, said) = recorded_arm::text(urdf, arguments.log.as_deref(), &file)?;
                (vec![(file.clone(), text.into_bytes())], said)
            }
            _ => with_own(files(kind, &file), &file, arguments)?,
        },
        Some(draft) => {
            let text = draft.text.clone().into_bytes();
            (vec![(file.clone(), text)], String::new())
        }
    };
    let quiet = arguments.quiet || arguments.json;
    let (files, chosen) = match arguments.part {
        Some(_) => part::with_an_edge(files, &file, quiet)?,
        None => (files, String::new()),
    };
    // All are looked at before the first is written. What stands there as it would be written can stay.
    let stays =
        |path: &Path, content: &[u8]| crate::file::read(path).is_ok_and(|old| old == content);
    let written = files.iter();
    let written = written.filter(|(path, content)| !stays(path, content) || *path == file);
    let written: Vec<(&PathBuf, &Vec<u8>)> = written.map(|(path, own)| (path, own)).collect();
    let paths: Vec<&PathBuf> = written.iter().map(|(path, _)| *path).collect();
    let _claims = prepare_files(&paths, "--out", OverwritePolicy::of(arguments.force))?;
    write_all(&written)?;
    let paths = written.iter().map(|(path, _)| path.display().to_string());
    let paths: Vec<String> = paths.collect();
    let next = match (&drafted, logs.first()) {
        (Some(_), Some(log)) => format!("idc import {} {}", word(&file), word(log)),
        _ => kind.next(&file),
    };
    report_written(
        arguments,
        (drafted.as_ref(), &of_arm, &chosen),
        &paths,
        &next,
    )?;
    Ok(ExitCode::Done)
}

/// Refuses options of another kind of file, and an arm without its URDF.
fn check_options(arguments: &NewArguments) -> Result<(), AppError> {
    let kind = arguments.kind;
    let refuse = |option| {
        Err(AppError::OfACell {
            option,
            kind: kind.name(),
        })
    };
    match kind {
        Kind::Cell | Kind::Arm => {}
        _ if arguments.urdf.is_some() => return refuse("--urdf"),
        _ if arguments.part.is_some() => return refuse("--part"),
        _ => {}
    }
    match kind {
        Kind::Arm if arguments.part.is_some() => refuse("--part"),
        Kind::Arm if arguments.urdf.is_none() => Err(AppError::NoUrdf),
        Kind::Arm => Ok(()),
        _ if arguments.log.is_some() => Err(AppError::OfAnArm { kind: kind.name() }),
        _ => Ok(()),
    }
}

/// Prints what was written, and what was found of logs or of an arm.
fn report_written(
    arguments: &NewArguments,
    (drafted, of_arm, chosen): (Option<&Draft>, &str, &str),
    paths: &[String],
    next: &str,
) -> Result<(), AppError> {
    let kind = arguments.kind;
    if arguments.json {
        let mut document =
            serde_json::json!({ "kind": kind.name(), "written": paths, "next": next });
        if let Some(draft) = drafted {
            document["found"] = serde_json::json!(draft.found);
            document["asked"] = serde_json::json!(draft.open);
        }
        if !of_arm.is_empty() {
            document["arm"] = serde_json::json!(of_arm);
        }
        if !chosen.is_empty() {
            document["chosen"] = serde_json::json!(chosen);
        }
        say(&format!("{document:#}\n"))?;
    } else if !arguments.quiet {
        let looked = drafted.map_or(String::new(), summary);
        let looked = match of_arm {
            "" => looked,
            summary => format!("{looked}arm: {summary}\n"),
        };
        let chosen = match chosen {
            "" => String::new(),
            chosen => format!("chosen: {chosen}\n"),
        };
        say(&format!(
            "{looked}{chosen}written: {}\nnext: {next}\n",
            paths.join(", ")
        ))?;
    }
    Ok(())
}

/// Quantities found in logs, and those asked for, for people.
fn summary(draft: &Draft) -> String {
    let wide = draft.found.iter().map(|(quantity, _)| quantity.len());
    let wide = wide.max().unwrap_or(0);
    let found = draft.found.iter();
    let mut lines: Vec<String> = found
        .map(|(quantity, column)| format!("{quantity:<wide$}  {column}"))
        .collect();
    lines.extend(draft.open.iter().map(|what| format!("asked: {what}")));
    lines.iter().map(|line| format!("{line}\n")).collect()
}

/// The cell's file with arm and part of the user's own, and in words what was chosen for the arm.
fn with_own(
    mut files: Files,
    file: &Path,
    arguments: &NewArguments,
) -> Result<(Files, String), AppError> {
    let whole = |path: &Path| {
        std::fs::canonicalize(path).map_err(|error| AppError::OutputFile {
            file: path.display().to_string(),
            option: "--urdf and --part",
            reason: error.to_string(),
        })
    };
    let mut text = String::from_utf8_lossy(&files[0].1).into_owned();
    let mut draft = None;
    if let Some(urdf) = &arguments.urdf {
        let (own, found) = arm::with_arm(&text, &whole(urdf)?)?;
        text = own;
        draft = Some(found);
        files.retain(|(path, _)| !path.ends_with(BESIDE[0].0));
    }
    let mut put = |line: &str, value: &str| {
        let lines = text.lines().map(|old| match old.split_once(" = ") {
            Some((key, _)) if key == line => format!("{key} = {value}"),
            _ => old.to_owned(),
        });
        text = lines.map(|line| line + "\n").collect();
    };
    if let Some(part) = &arguments.part {
        let part = whole(part)?;
        let unit = part::likely_unit(&part)?;
        put("mesh", &format!("{:?}", part.display().to_string()));
        put("mesh_unit", &format!("\"{unit}\""));
        put(
            "edge",
            "0                                # by its number in `idc edges`, which with --out draws them",
        );
        // Of a part of one's own the whole edge.
        let stretch = |line: &&str| !line.starts_with("start_mm") && !line.starts_with("end_mm");
        text = text
            .lines()
            .filter(stretch)
            .map(|line| format!("{line}\n"))
            .collect();
        files.retain(|(path, _)| !path.ends_with(BESIDE[2].0));
    }
    files[0].1 = text.into_bytes();
    match (draft, &arguments.part) {
        (Some(arm), None) => {
            let quiet = arguments.quiet || arguments.json;
            arm::placed(files, file, &arm, quiet)
        }
        _ => Ok((files, String::new())),
    }
}

/// The file and what it needs beside it, with their contents.
fn files(kind: Kind, file: &Path) -> Files {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let models = format!("{stem}_models");
    let runs = match kind {
        Kind::Postures => format!("{stem}_stills.csv"),
        _ => format!("{stem}_runs.csv"),
    };
    let text = kind.template().replace(MODELS, &models);
    let text = text.replace(TABLE, &runs);
    let mut files = vec![(file.to_owned(), text.into_bytes())];
    if matches!(kind, Kind::Cell) {
        let beside = BESIDE.iter();
        files
            .extend(beside.map(|(name, content)| {
                (file.with_file_name(&models).join(name), content.to_vec())
            }));
    }
    if matches!(kind, Kind::RemovalTable) {
        files.push((file.with_file_name(&runs), RUNS.to_vec()));
    }
    if matches!(kind, Kind::Postures) {
        files.push((file.with_file_name(&runs), STILLS.to_vec()));
    }
    files
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{PosturesCase, RemovalCase};
    use crate::cell::Cell;
    use crate::import::load_map;
    use crate::scenario::load;
    use crate::scenario::rig_file::load_rig;

    fn written(kind: Kind) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("deep/my.file.toml");
        for (path, content) in files(kind, &file) {
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, content).unwrap();
        }
        (folder, file)
    }

    #[test]
    fn each_is_what_our_own_readers_take() {
        let (_folder, file) = written(Kind::Cell);
        let cell = Cell::new(load(&file).unwrap()).unwrap();
        assert_eq!(cell.setup.scenario.process.force, 150.0);
        let (_folder, file) = written(Kind::Rig);
        let rig = load_rig(&file).unwrap();
        assert_eq!((rig.fit.len(), rig.tolerances.len()), (1, 8));
        let (_folder, file) = written(Kind::Import);
        assert_eq!(load_map(&file).unwrap().files[0].channels.len(), 7);
        let (_folder, file) = written(Kind::RemovalTable);
        let case = RemovalCase::from_file(&file, String::new()).unwrap();
        assert_eq!((case.rows.len(), case.unseen.len()), (24, 0));
        let (_folder, file) = written(Kind::Postures);
        let case = PosturesCase::from_file(&file).unwrap();
        assert_eq!(case.input.recordings[0].postures.len(), 12);
    }
}

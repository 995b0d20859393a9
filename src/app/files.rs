//! The files of a run: recording.rrd, recording.mcap where it is asked for, samples.parquet, summary.json, report.html, cell.svg, edge.svg, lean.svg, drawing.json, figures.svg of a bench, varied.toml of
//! `--set`; those of a study: design.json, override.toml, front.svg, robustness.svg, report.html. All appear, or none.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::error::AppError;
use super::space;
use crate::drawing;
use crate::metrics::FOLLOW_PHASE;
use crate::recording::atomic::{UnfinishedFolder, make_folder, write_text};
use crate::recording::bag::write_bag;
use crate::recording::claim::{Claim, clear_beside, clear_unfinished};
use crate::recording::parquet::write_parquet;
use crate::recording::provenance::Provenance;
use crate::recording::{Recording, RecordingError};
use crate::report::{SUMMARY, Sketches};
use crate::scene::Scene;
use crate::tasks::TASKS;

pub(super) const RECORDING: &str = "recording.rrd";
/// The signals as messages of ROS 2.
pub(super) const BAG: &str = "recording.mcap";
pub(super) const SAMPLES: &str = "samples.parquet";
pub(super) const FIGURES: &str = "figures.svg";
pub(super) const CELL: &str = "cell.svg";
pub(super) const EDGE: &str = "edge.svg";
/// The edge as a turning tool left it, station by station.
pub(super) const EDGE_PROFILE: &str = "edge_profile.csv";
/// How the tool stands across the edge.
pub(super) const LEAN: &str = "lean.svg";
/// What the page draws in space.
pub(super) const DRAWING: &str = "drawing.json";
/// The scenario as `--set` made it.
pub(super) const VARIED: &str = "varied.toml";
/// What the seal of summary.json says that it is of.
pub(super) const RUN: &str = "run";
/// All that a run may write.
pub(super) const RUN_NAMES: [&str; 12] = [
    RECORDING,
    BAG,
    SAMPLES,
    SUMMARY,
    FIGURES,
    CELL,
    EDGE,
    EDGE_PROFILE,
    LEAN,
    DRAWING,
    REPORT,
    VARIED,
];
pub(super) const DESIGN: &str = "design.json";
pub(super) const OVERRIDE: &str = "override.toml";
pub(super) const FRONT: &str = "front.svg";
pub(super) const ROBUSTNESS: &str = "robustness.svg";
pub(super) const DIAGNOSIS: &str = "diagnosis.json";
/// Recordings of a diagnosis beside its models, and their balances.
pub(super) const COMPARISON: &str = "comparison.parquet";
pub(super) const BALANCE: &str = "balance.parquet";
/// A diagnosis on a screen, for Rerun's viewer.
pub(super) const BOARD: &str = "diagnosis.rrd";
/// The page of any of them.
pub(super) const REPORT: &str = "report.html";

/// Treatment of results that stand where new ones are to go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum OverwritePolicy {
    /// New ones are refused.
    Refuse,
    /// They are kept.
    Keep,
    /// New ones take their place.
    Replace,
}

impl OverwritePolicy {
    /// As `--force` says.
    pub(super) fn of(force: bool) -> Self {
        if force { Self::Replace } else { Self::Refuse }
    }
}

/// Whether two paths lead to one file, or folder, that is there.
pub(super) fn is_same(one: &Path, other: &Path) -> bool {
    match (one.canonicalize(), other.canonicalize()) {
        (Ok(one), Ok(other)) => one == other,
        _ => false,
    }
}

/// Refuses a file that stands, or cannot stand, where one is to be written, makes its folder and claims the file for this process.
pub(super) fn prepare_file(
    path: &Path,
    option: &'static str,
    policy: OverwritePolicy,
) -> Result<Option<Claim>, AppError> {
    let refuse = |reason: &dyn std::fmt::Display| AppError::OutputFile {
        file: path.display().to_string(),
        option,
        reason: reason.to_string(),
    };
    let exists = || match policy == OverwritePolicy::Refuse && path.exists() {
        true => Err(AppError::FileExists {
            file: path.display().to_string(),
            option,
        }),
        false => Ok(()),
    };
    if path.is_dir() {
        return Err(refuse(&"there is a folder of that name"));
    }
    exists()?;
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    make_folder(folder).map_err(|error| refuse(&error))?;
    let claim = match path.metadata() {
        // A device or a pipe is nobody's.
        Ok(found) if !found.is_file() => return Ok(None),
        _ => Claim::of_file(path).map_err(|error| refuse(&error))?,
    };
    let claim = claim.ok_or_else(|| AppError::FileClaimed {
        file: path.display().to_string(),
        option,
    })?;
    // Another process may have written it, and ended, in between.
    exists()?;
    clear_unfinished(folder);
    Ok(Some(claim))
}

/// The same of several files that one command writes. Of very many the first are claimed: a process holds no more files open.
pub(super) fn prepare_files<P: AsRef<Path>>(
    paths: &[P],
    option: &'static str,
    policy: OverwritePolicy,
) -> Result<Vec<Claim>, AppError> {
    const MOST: usize = 200;
    let mut claims = Vec::new();
    for path in paths {
        let claim = prepare_file(path.as_ref(), option, policy)?;
        claims.extend(claim.filter(|_| claims.len() < MOST));
    }
    Ok(claims)
}

/// Makes a folder and claims it for this process.
pub(super) fn claim_folder(path: &Path) -> Result<Claim, AppError> {
    let refuse = |error: std::io::Error| AppError::OutputFolder {
        folder: path.display().to_string(),
        reason: error.to_string(),
    };
    make_folder(path).map_err(refuse)?;
    let claim = Claim::of_folder(path).map_err(refuse)?;
    claim.ok_or_else(|| AppError::FolderClaimed {
        folder: path.display().to_string(),
    })
}

/// A folder that was found to be writable before the run.
pub(super) struct OutputFolder {
    path: PathBuf,
    /// None where a folder above it is claimed.
    _claim: Option<Claim>,
}

impl OutputFolder {
    /// Makes and claims the folder and tries it for files of these names, so that a long run does not end with nothing.
    pub(super) fn prepare(
        path: &Path,
        names: &[&str],
        policy: OverwritePolicy,
    ) -> Result<Self, AppError> {
        Self::check(path, names, policy)?;
        let claim = claim_folder(path)?;
        Self::within_claim(path, names, policy, Some(claim))
    }

    /// The same of a folder within one that this process has claimed.
    pub(super) fn prepare_within(
        path: &Path,
        names: &[&str],
        policy: OverwritePolicy,
    ) -> Result<Self, AppError> {
        Self::check(path, names, policy)?;
        make_folder(path).map_err(|error| AppError::OutputFolder {
            folder: path.display().to_string(),
            reason: error.to_string(),
        })?;
        Self::within_claim(path, names, policy, None)
    }

    fn within_claim(
        path: &Path,
        names: &[&str],
        policy: OverwritePolicy,
        claim: Option<Claim>,
    ) -> Result<Self, AppError> {
        // Another process may have written there, and ended, in between.
        Self::check(path, names, policy)?;
        clear_beside(path, &[TASKS]);
        clear_unfinished(path);
        drop(UnfinishedFolder::within(path)?);
        Ok(Self {
            path: path.to_owned(),
            _claim: claim,
        })
    }

    /// Refuses a folder that files of these names cannot go to, without making it.
    pub(super) fn check(
        path: &Path,
        names: &[&str],
        policy: OverwritePolicy,
    ) -> Result<(), AppError> {
        let refuse = |reason: String| AppError::OutputFolder {
            folder: path.display().to_string(),
            reason,
        };
        if path.exists() && !path.is_dir() {
            return Err(refuse("there is a file of that name".to_owned()));
        }
        let exists = |name: &&&str| path.join(name).is_file();
        if policy == OverwritePolicy::Refuse
            && let Some(name) = names.iter().find(exists)
        {
            return Err(AppError::ResultsExist {
                folder: path.display().to_string(),
                name: (*name).to_owned(),
            });
        }
        match names.iter().find(|name| path.join(name).is_dir()) {
            Some(name) => Err(refuse(format!("{name} in it is a folder"))),
            None => Ok(()),
        }
    }

    /// Its path.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the files of a run and returns their names.
    pub(super) fn write(&self, output: RunOutput<'_>) -> Result<Vec<&'static str>, AppError> {
        let unfinished = UnfinishedFolder::within(&self.path)?;
        let metadata = BTreeMap::from([
            ("title".to_owned(), output.title.to_owned()),
            (
                "program".to_owned(),
                format!("idc {}", env!("CARGO_PKG_VERSION")),
            ),
        ]);
        let [table, picture, bag] =
            [SAMPLES, RECORDING, BAG].map(|name| unfinished.path().join(name));
        let joints = output.joints.as_deref();
        // The large files, side by side.
        let (tables, written) = rayon::join(
            || {
                write_parquet(&table, output.recording, &metadata)?;
                let write = |joints| write_bag(&bag, output.recording, joints, &metadata);
                joints.map_or(Ok(()), write)
            },
            || output.picture.map(|write| write(&picture)),
        );
        tables?;
        let recorded = written.transpose()?.is_some();
        write_text(&unfinished.path().join(SUMMARY), output.summary)?;
        write_text(&unfinished.path().join(REPORT), output.report)?;
        let mut names = vec![SAMPLES, SUMMARY, REPORT];
        let Sketches {
            cell, edge, lean, ..
        } = output.sketches;
        for (name, svg) in [(CELL, cell), (EDGE, edge), (LEAN, lean)] {
            if let Some(svg) = svg {
                write_text(&unfinished.path().join(name), svg)?;
                names.push(name);
            }
        }
        if let Some(space) = &output.sketches.space {
            let text = serde_json::to_value(space)?.to_string();
            write_text(&unfinished.path().join(DRAWING), &text)?;
            names.push(DRAWING);
        }
        if recorded {
            names.insert(0, RECORDING);
        }
        if joints.is_some() {
            names.push(BAG);
        }
        let texts = [
            (EDGE_PROFILE, output.edge_profile),
            (FIGURES, output.figures),
            (VARIED, output.varied),
        ];
        for (name, text) in texts {
            if let Some(text) = text {
                write_text(&unfinished.path().join(name), text)?;
                names.push(name);
            }
        }
        finish(unfinished, &RUN_NAMES, &names)?;
        Ok(names)
    }

    /// Writes texts by name and returns their names.
    pub(super) fn write_texts(
        &self,
        all: &[&str],
        files: &[(&'static str, &str)],
    ) -> Result<Vec<&'static str>, AppError> {
        self.write_with(all, |folder| {
            for (name, text) in files {
                write_text(&folder.join(name), text)?;
            }
            Ok(files.iter().map(|(name, _)| *name).collect())
        })
    }

    /// Lets files be written into a folder of their own, and moves those that are named here, the last one last; returns their names. Others of `all` names go.
    pub(super) fn write_with(
        &self,
        all: &[&str],
        write: impl FnOnce(&Path) -> Result<Vec<&'static str>, AppError>,
    ) -> Result<Vec<&'static str>, AppError> {
        let unfinished = UnfinishedFolder::within(&self.path)?;
        let names = write(unfinished.path())?;
        finish(unfinished, all, &names)?;
        Ok(names)
    }
}

/// Puts files in their places. Others that a result of the kind can have would pass for some of this one, and go.
fn finish(unfinished: UnfinishedFolder, all: &[&str], names: &[&str]) -> Result<(), AppError> {
    let gone = all.iter().filter(|name| !names.contains(name));
    let gone: Vec<&str> = gone.copied().collect();
    // The numbers last: where they stand, the rest does.
    let mut names = names.to_vec();
    let is_json = |name: &str| Path::new(name).extension().is_some_and(|end| end == "json");
    names.sort_by_key(|name| is_json(name) && *name != DRAWING);
    Ok(unfinished.finish(&names, &gone, &[TASKS])?)
}

/// Where the results of a run come from: files by their paths as the scenario has them.
pub(super) fn provenance(files: &[&PathBuf], seed: u64) -> Result<Provenance, AppError> {
    let names: Vec<String> = files.iter().map(|f| f.display().to_string()).collect();
    let files = names
        .iter()
        .zip(files)
        .map(|(name, path)| (name.as_str(), path.as_path()));
    Ok(Provenance::of(files, Some(seed))?)
}

/// Writes recording.rrd.
pub(super) type Picture<'a> = Box<dyn FnOnce(&Path) -> Result<(), RecordingError> + Send + 'a>;

/// Files of a run.
pub(super) struct RunOutput<'a> {
    /// Name for people.
    pub title: &'a str,
    /// The signals.
    pub recording: &'a Recording,
    /// Writer of recording.rrd; none where it is not wanted.
    pub picture: Option<Picture<'a>>,
    /// Names of the arm's joints, base first, where recording.mcap is wanted.
    pub joints: Option<Vec<String>>,
    /// summary.json.
    pub summary: &'a str,
    /// edge_profile.csv.
    pub edge_profile: Option<&'a str>,
    /// figures.svg.
    pub figures: Option<&'a str>,
    /// varied.toml.
    pub varied: Option<&'a str>,
    /// cell.svg, edge.svg, lean.svg and drawing.json.
    pub sketches: &'a Sketches,
    /// report.html.
    pub report: &'a str,
}

/// The scene in the middle of following, or at the end of a run that does not follow an edge.
pub(super) fn sketches(scene: &Scene, recording: &Recording) -> Sketches {
    let follow = recording.phase(FOLLOW_PHASE);
    let end = recording.time().last().copied().unwrap_or_default();
    let moment = follow.map_or(end, |follow| 0.5 * (follow.start + follow.end.min(end)));
    Sketches {
        cell: Some(drawing::cell(scene, moment)),
        edge: drawing::edge(scene),
        lean: None,
        space: space::of_run(scene, moment),
    }
}

/// Where results go: as asked, or to a folder in `runs` that is called as the input, a file without its extension.
pub(super) fn output_folder(out: Option<&PathBuf>, input: &Path) -> PathBuf {
    let default = || {
        let folder = input.canonicalize().ok().filter(|path| path.is_dir());
        let name = match &folder {
            Some(folder) => folder.file_name(),
            None => input.file_stem(),
        };
        Path::new("runs").join(name.unwrap_or_default())
    };
    out.cloned().unwrap_or_else(default)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_go_to_a_folder_that_is_called_as_the_input() {
        let folder = tempfile::tempdir().unwrap();
        let case = folder.path().join("rig.v2");
        std::fs::create_dir(&case).unwrap();
        let of = |input: &Path| output_folder(None, input);
        assert_eq!(of(&case), Path::new("runs/rig.v2"));
        // As `idc diagnose .` has it.
        assert_eq!(of(&case.join(".")), Path::new("runs/rig.v2"));
        assert_eq!(of(Path::new("scenarios/a.b.toml")), Path::new("runs/a.b"));
        let asked = PathBuf::from("elsewhere");
        assert_eq!(output_folder(Some(&asked), &case), asked);
    }
}

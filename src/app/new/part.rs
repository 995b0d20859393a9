//! The edge of a part of one's own that can be ridden, and where the part lies for it: found by planning, and run once, so that the file runs as it is written.

use std::path::{Path, PathBuf};

use super::super::error::AppError;
use super::super::progress;
use crate::advice::{Effort, RunOptions, RunOutcome, Trial, anywhere, pose_edits};
use crate::cell::{Cell, Setup, largest_balls};
use crate::metrics;
use crate::run::run_cell;
use crate::scenario::{KeyValue, ScenarioTemplate};
use crate::workpiece::{
    Convexity, EdgeList, EdgeSearch, PartFile, WorkpieceError, list_edges, load_mesh,
};

/// Sizes of usual parts [m].
const USUAL: [f64; 2] = [8e-3, 1.5];
/// Units of mesh files, the most frequent first, and their length [m].
const UNITS: [(&str, f64); 3] = [("mm", 1e-3), ("m", 1.0), ("inch", 0.0254)];
/// Angles between faces from which an edge counts as sharp that are tried [deg]; the first is the usual one.
const SHARP: [f64; 2] = [30.0, 18.0];
/// Edges that are looked at, the longest first.
const EDGES: usize = 16;
/// Shares of an edge that are tried, about its middle [1].
const SHARES: [f64; 3] = [1.0, 0.5, 0.25];
/// Shortest stretch that is a job, of the ball's radius [1] and [m].
const SHORTEST: (f64, f64) = (1.0, 3e-3);
/// Longest stretch that is tried, of the arm's reach [1].
const LONGEST: f64 = 0.8;
/// Stretches, and places of each, that are tried.
const STRETCHES: usize = 20;
const PLACES: usize = 24;
/// Places that are run for each stretch.
const RUNS: usize = 2;
/// Feeds that are tried in place of the usual one [mm/s]: round a tight bend the wrist must turn quickly.
const SLOWER: [f64; 2] = [8.0, 4.0];
/// Smallest ball that is tried [m].
const SMALLEST_BALL: f64 = 5e-4;
/// Extent of the search, of that for advice [1].
const EXTENT: f64 = 3.0;
/// Forces that are tried [N]: that of the file, then less, for arms that cannot give it.
const FORCES: [Option<f64>; 3] = [None, Some(60.0), Some(25.0)];
/// Bounds of the file that is written: the mean force to either side [1].
const FORCE_KEPT: f64 = 0.03;

/// The unit with which a mesh is a part of a usual size, or else can be read at all: the one that its file states, else millimetres first.
pub(super) fn likely_unit(part: &Path) -> Result<&'static str, AppError> {
    let file = PartFile::read(part)?;
    let units = UNITS
        .iter()
        .filter(|(unit, _)| !file.states_unit || *unit == "m");
    let (mut readable, mut refused) = (None, None);
    for &(unit, scale) in units {
        match file.mesh(scale) {
            Ok(mesh) => {
                let (low, high) = mesh.bounds();
                if (USUAL[0]..=USUAL[1]).contains(&(high - low).length()) {
                    return Ok(unit);
                }
                readable.get_or_insert(unit);
            }
            Err(fault) => {
                refused.get_or_insert(WorkpieceError::Mesh {
                    file: part.to_owned(),
                    fault,
                });
            }
        }
    }
    match (readable, refused) {
        (Some(unit), _) => Ok(unit),
        (None, Some(error)) => Err(error.into()),
        (None, None) => Ok(UNITS[0].0),
    }
}

/// A file, with what it needs beside it.
pub(super) type Files = Vec<(PathBuf, Vec<u8>)>;

/// A stretch of an edge.
#[derive(Debug, Clone)]
struct Ridden {
    number: usize,
    sharp_angle: f64,
    /// Start and end [m]; none of a whole edge.
    stretch: Option<[f64; 2]>,
    length: f64,
    /// Ball that can follow it, where the usual one cannot [m].
    ball: Option<f64>,
}

impl Ridden {
    fn edits(&self) -> Vec<KeyValue> {
        let key = |name: &str| format!("workpiece.edge.{name}");
        let mut edits = vec![KeyValue::number(key("edge"), self.number as f64)];
        if (self.sharp_angle - SHARP[0]).abs() > 0.0 {
            edits.push(KeyValue::number(key("sharp_angle_deg"), self.sharp_angle));
        }
        if let Some([start, end]) = self.stretch {
            let tenth = |length: f64| (1e4 * length).round() / 10.0;
            edits.push(KeyValue::number(key("start_mm"), tenth(start)));
            edits.push(KeyValue::number(key("end_mm"), tenth(end)));
        }
        if let Some(ball) = self.ball {
            let radius = (1e4 * ball).round() / 10.0;
            edits.push(KeyValue::number(
                "device.override.tool_ball_radius_mm",
                radius,
            ));
        }
        edits
    }
}

/// The file with the longest edge of the part that can be ridden, and the part where the robot reaches it; and in words what was chosen.
pub(super) fn with_an_edge(
    mut files: Files,
    file: &Path,
    quiet: bool,
) -> Result<(Files, String), AppError> {
    let trouble = |reason: String| AppError::OutputFile {
        file: file.display().to_string(),
        option: "--out",
        reason,
    };
    // The search reads what is not written yet.
    let folder = tempfile::tempdir().map_err(|error| trouble(error.to_string()))?;
    let text = String::from_utf8_lossy(&files[0].1).into_owned();
    let text = with_own_bounds(&text);
    let own = file.parent().unwrap_or(Path::new(""));
    for (path, content) in &files[1..] {
        let there = folder.path().join(path.strip_prefix(own).unwrap_or(path));
        let written = std::fs::create_dir_all(there.parent().unwrap_or(folder.path()))
            .and_then(|()| std::fs::write(&there, content));
        written.map_err(|error| trouble(error.to_string()))?;
    }
    let draft = folder.path().join("cell.toml");
    std::fs::write(&draft, &text).map_err(|error| trouble(error.to_string()))?;
    let template = ScenarioTemplate::read(&draft)?;
    let line = progress::spinner("looking for an edge that can be ridden", quiet);
    let runs = |cell: &Cell| outcome(cell);
    let options = RunOptions {
        runs: &runs,
        tell: &|_| (),
        keep_on: &|| true,
    };
    let mut refused = None;
    let mut found = None;
    for force in FORCES {
        let given = force.map_or_else(Vec::new, with_force);
        let trial = Trial::new(&template, &given, Effort::times(EXTENT), &options);
        match search(&trial) {
            Ok((ridden, edits)) => {
                found = Some((ridden, [given, edits].concat()));
                break;
            }
            Err(error) => {
                refused.get_or_insert(error);
            }
        }
    }
    line.finish_and_clear();
    let (ridden, edits) = match (found, refused) {
        (Some(found), _) => found,
        (None, Some(error)) => return Err(error),
        (None, None) => return Ok((files, String::new())),
    };
    files[0].1 = template.text(&edits)?.into_bytes();
    let length = (1e4 * ridden.length).round() / 10.0;
    Ok((files, format!("edge {}, {length} mm of it", ridden.number)))
}

/// The template's text with bounds that hold for any edge, in place of those of the plate's.
fn with_own_bounds(text: &str) -> String {
    let Some((before, _)) = text.split_once("\n[expect]\n") else {
        return text.to_owned();
    };
    let force = text.lines().find_map(|line| {
        let value = line.strip_prefix("force_n = ")?;
        value.split_whitespace().next()?.parse::<f64>().ok()
    });
    let mut text = format!("{before}\n[expect]\nloss_of_contact_share_percent = {{ max = 0 }}\n");
    if let Some(force) = force {
        let [low, high] = [-FORCE_KEPT, FORCE_KEPT].map(|share| (1.0 + share) * force);
        text += &format!("force_mean_n = {{ min = {low}, max = {high} }}\n");
    }
    text
}

/// Another force [N], with the bounds that go with it.
fn with_force(force: f64) -> Vec<KeyValue> {
    let [low, high] = [-FORCE_KEPT, FORCE_KEPT].map(|share| (1.0 + share) * force);
    let bounds = format!("{{ min = {low}, max = {high} }}");
    vec![
        KeyValue::number("process.force_n", force),
        KeyValue::typed("expect.force_mean_n", &bounds),
    ]
}

/// A run whose bounds are not all kept counts as one that stopped.
fn outcome(cell: &Cell) -> Option<RunOutcome> {
    let finished = run_cell(cell, &mut |_| ()).ok()?;
    let summary = &finished.summary;
    let verdicts = metrics::check(metrics::METRICS, summary, &cell.setup.scenario.expect).ok()?;
    Some(RunOutcome {
        stopped: finished.stop.is_some() || verdicts.iter().any(|verdict| !verdict.kept),
        force: summary.force_mean_n,
        lost: summary
            .loss_of_contact_share_percent
            .map(|lost| 1e-2 * lost),
        torque: summary.joint_torque_share_percent.map(|share| 1e-2 * share),
    })
}

/// The longest stretch that can be ridden, with its place.
fn search(trial: &Trial<'_>) -> Result<(Ridden, Vec<KeyValue>), AppError> {
    let mut convex = 0;
    let mut nearest = None;
    let mut part = String::new();
    for sharp_angle in SHARP {
        let angle = KeyValue::number("workpiece.edge.sharp_angle_deg", sharp_angle);
        let Some(scenario) = trial.scenario(&[angle]) else {
            continue;
        };
        let workpiece = &scenario.workpiece;
        part = workpiece.mesh.display().to_string();
        let mesh = load_mesh(&workpiece.mesh, workpiece.mesh_scale)?;
        let search = EdgeSearch {
            sharp_angle: sharp_angle.to_radians(),
            ..EdgeSearch::default()
        };
        let list = list_edges(&mesh, &search);
        convex = list
            .edges
            .iter()
            .filter(|edge| edge.convexity == Convexity::Convex)
            .count();
        for ridden in stretches(trial, &list, sharp_angle) {
            match placed(trial, &ridden)? {
                Ok(edits) => return Ok((ridden, edits)),
                Err(reason) => {
                    nearest.get_or_insert(reason);
                }
            }
            if trial.is_over() {
                break;
            }
        }
    }
    let reason = match nearest {
        Some(reason) if trial.is_over() => {
            format!(
                "the longest: {reason}; the search was ended there, after as much as it may try"
            )
        }
        Some(reason) => format!("the longest: {reason}"),
        None => {
            "none is long enough for the tool's ball, or none can be followed by any".to_owned()
        }
    };
    Err(AppError::NothingRidden {
        part,
        convex,
        reason,
    })
}

/// Stretches that a ball can follow, the longest first; those of the usual ball before those of smaller ones.
fn stretches(trial: &Trial<'_>, list: &EdgeList, sharp_angle: f64) -> Vec<Ridden> {
    let mut numbers: Vec<usize> = (0..list.edges.len())
        .filter(|&number| list.edges[number].convexity == Convexity::Convex)
        .collect();
    numbers.sort_by(|&a, &b| list.edges[b].length.total_cmp(&list.edges[a].length));
    let mut found = Vec::new();
    let mut smaller = Vec::new();
    for number in numbers.into_iter().take(EDGES) {
        let edge = Ridden {
            number,
            sharp_angle,
            stretch: None,
            length: list.edges[number].length,
            ball: None,
        };
        let Some(setup) = trial
            .scenario(&edge.edits())
            .and_then(|own| Setup::load(own).ok())
        else {
            continue;
        };
        let radius = setup.scenario.nominal.mounting.tool_radius;
        let balls = largest_balls(&setup.part, radius);
        let longest = LONGEST * setup.arm.chain.reach();
        let tightest = balls.iter().map(|ball| ball.1).fold(radius, f64::min);
        for [from, to] in free(&balls, radius) {
            for share in SHARES {
                found.extend(about_middle(&edge, [from, to], share, (radius, longest)));
            }
        }
        let ball = (0.95e4 * tightest).floor() / 1e4;
        if tightest < radius && ball >= SMALLEST_BALL {
            let edge = Ridden {
                ball: Some(ball),
                ..edge
            };
            let whole = [0.0, edge.length];
            smaller.extend(about_middle(&edge, whole, 1.0, (ball, longest)));
        }
    }
    let by_length = |a: &Ridden, b: &Ridden| b.length.total_cmp(&a.length);
    found.sort_by(by_length);
    smaller.sort_by(by_length);
    found.truncate(STRETCHES);
    found.extend(smaller);
    found.truncate(STRETCHES);
    found
}

/// The share of a stretch about its middle, if it is long enough.
fn about_middle(
    edge: &Ridden,
    [from, to]: [f64; 2],
    share: f64,
    (radius, longest): (f64, f64),
) -> Option<Ridden> {
    let length = (share * (to - from)).min(longest);
    let middle = 0.5 * (from + to);
    let ends = [middle - 0.5 * length, middle + 0.5 * length];
    let whole = ends[0] < 1e-9 && ends[1] > edge.length - 1e-9;
    let enough = length >= (SHORTEST.0 * radius).max(SHORTEST.1);
    enough.then(|| Ridden {
        stretch: (!whole).then_some(ends.map(|end| (1e4 * end).floor() / 1e4)),
        length,
        ..edge.clone()
    })
}

/// Stretches on which all largest balls are at least of a radius [m], a ball's radius away from what is too tight.
fn free(balls: &[(f64, f64)], radius: f64) -> Vec<[f64; 2]> {
    let mut found: Vec<[f64; 2]> = Vec::new();
    let mut from: Option<f64> = None;
    let last = balls.len() - 1;
    for (index, &(place, largest)) in balls.iter().enumerate() {
        if largest >= radius {
            from.get_or_insert(if index == 0 { place } else { place + radius });
        }
        if let Some(start) = from
            && (largest < radius || index == last)
        {
            let end = if largest < radius {
                place - radius
            } else {
                place
            };
            if end > start {
                found.push([start, end]);
            }
            from = None;
        }
    }
    found
}

/// Keys of a stretch and a place of the part at which it can be ridden and runs within its bounds; or why there is none.
fn placed(trial: &Trial<'_>, ridden: &Ridden) -> Result<Result<Vec<KeyValue>, String>, AppError> {
    let edits = ridden.edits();
    let Some(scenario) = trial.scenario(&edits) else {
        return Ok(Err("its stretch cannot be read".to_owned()));
    };
    let setup = Setup::load(scenario)?;
    let mut reason = None;
    let mut runs = 0;
    for there in anywhere(&setup, &setup.stance(), true)
        .into_iter()
        .take(PLACES)
    {
        if !trial.may_outline(1) {
            break;
        }
        if let Err(error) = setup.outline(&there) {
            reason.get_or_insert_with(|| error.to_string());
            continue;
        }
        let mut all = edits.clone();
        all.extend(pose_edits(there.world_from_part, true));
        match trial.checked(&all) {
            Some(Ok(cell)) if trial.runs_well(&cell, 0.0) => return Ok(Ok(all)),
            Some(Ok(_)) => {
                let mut slower = SLOWER.into_iter().map(|feed| with_feed(&all, feed));
                if let Some(edits) = slower.find(|edits| trial.passes(edits, 0.0)) {
                    return Ok(Ok(edits));
                }
                reason = Some("its run does not keep the bounds".to_owned());
                runs += 1;
                if runs == RUNS {
                    break;
                }
            }
            Some(Err(error)) => reason = Some(error.to_string()),
            None => break,
        }
    }
    Ok(Err(
        reason.unwrap_or_else(|| "out of reach everywhere".to_owned())
    ))
}

/// The same with another feed [mm/s].
fn with_feed(edits: &[KeyValue], feed: f64) -> Vec<KeyValue> {
    let mut all = edits.to_vec();
    all.push(KeyValue::number("process.feed_mm_per_s", feed));
    all
}

//! `idc place`: where the part of a cell can lie.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use glam::DVec3;

use super::error::{AppError, ExitCode};
use super::files::{OverwritePolicy, prepare_file};
use super::output::say;
use super::progress;
use crate::cell::Setup;
use crate::document::{Block, Cell, Column, Document, Number, Section, Style, Table, Tone, text};
use crate::place::{PlaceGrid, Possible, TriedPlace, best_places, footprints, svg, tried_places};
use crate::recording::atomic::write_all;
use crate::scenario::load;
use crate::shell::word;

/// For the help.
pub(super) const EXAMPLES: &str = "\
The part is moved over a grid of positions, its rotation as the scenario has
it; at each the flange is turned about the tool's axis in steps. Reach, limits
of the axes, singularities, torque, speed and collisions are checked along the
whole job. Comfort is the least over the job of: singular value / 0.15, distance
from an axis's limit / 0.5 rad, spare torque / 30 %; 0 at a limit, from 1 on
comfortable. Exit codes: 0 there is a place, 1 there is none, 2 bad input.

Examples:
  # a map; without ranges of 20 x 20 positions, 600 mm to either side
  idc place scenarios/plate_edge.toml --x-mm 400..1100:8 --y-mm=-300..300:7 \\
      --out runs/place.svg
  # a row of places in front of the robot, all of them as a table
  idc place scenarios/plate_edge.toml --x-mm 500..1000:6 --y-mm 0..0:1 \\
      --csv runs/place.csv
  # for a program
  idc place scenarios/plate_edge.toml --x-mm 650..850:3 --y-mm=-50..50:3 --json";

/// Positions to either side of the scenario's [m].
const BESIDE: f64 = 0.6;
/// Positions along an axis.
const COUNT: usize = 20;
/// Places that are printed.
const PRINTED: usize = 5;

/// Evenly spaced values, `from..to:count`.
#[derive(Debug, Clone, PartialEq)]
struct Range {
    from: f64,
    to: f64,
    count: usize,
}

impl FromStr for Range {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let parts = text.split_once("..").and_then(|(from, rest)| {
            let (to, count) = rest.split_once(':')?;
            Some((from.parse().ok()?, to.parse().ok()?, count.parse().ok()?))
        });
        let fits = |(from, to, count): &(f64, f64, usize)| {
            from.is_finite() && to.is_finite() && from <= to && (1..=1000).contains(count)
        };
        match parts.filter(fits) {
            Some((from, to, count)) => Ok(Self { from, to, count }),
            None => Err(
                "expected FROM..TO:COUNT with FROM at most TO and 1 to 1000 values, as 500..900:20"
                    .to_owned(),
            ),
        }
    }
}

impl Range {
    /// About a value.
    fn about(middle: f64) -> Self {
        Self {
            from: 1e3 * (middle - BESIDE),
            to: 1e3 * (middle + BESIDE),
            count: COUNT,
        }
    }

    /// Its values, of millimetres in metres; rounded to a tenth of a millimetre, so that what is printed is what was tried.
    fn values(&self) -> Vec<f64> {
        let step = (self.to - self.from) / (self.count - 1).max(1) as f64;
        let value = |index: usize| (10.0 * (self.from + step * index as f64)).round() / 1e4;
        (0..self.count).map(value).collect()
    }
}

#[derive(Debug, Args)]
pub(super) struct PlaceArguments {
    /// Scenario of a cell.
    scenario: PathBuf,
    /// Positions of the part along the world's x [mm], as 500..900:20 [default: 20 from 600 mm below to 600 mm above the scenario's].
    #[arg(long, value_name = "FROM..TO:COUNT", allow_hyphen_values = true)]
    x_mm: Option<Range>,
    /// The same along y.
    #[arg(long, value_name = "FROM..TO:COUNT", allow_hyphen_values = true)]
    y_mm: Option<Range>,
    /// Height of the part's origin [mm] [default: the scenario's].
    #[arg(long, allow_negative_numbers = true)]
    z_mm: Option<f64>,
    /// Steps of a turn in which the flange is turned about the tool's axis.
    #[arg(long, default_value_t = 12, value_parser = clap::value_parser!(u16).range(1..=360))]
    rolls: u16,
    /// Picture of the result, an SVG file.
    #[arg(long, help_heading = "Output")]
    out: Option<PathBuf>,
    /// All places as a table, a CSV file.
    #[arg(long, help_heading = "Output")]
    csv: Option<PathBuf>,
    /// Put new files in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print the best places as JSON.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

/// Tries all places.
pub(super) fn run(arguments: &PlaceArguments) -> Result<ExitCode, AppError> {
    let policy = OverwritePolicy::of(arguments.force);
    let mut claims = Vec::new();
    for (file, option) in [(&arguments.out, "--out"), (&arguments.csv, "--csv")] {
        if let Some(file) = file {
            claims.extend(prepare_file(file, option, policy)?);
        }
    }
    let setup = Setup::load(load(&arguments.scenario)?)?;
    let part = setup.stance().world_from_part.translation;
    let range = |given: &Option<Range>, middle: f64| {
        let about = || Range::about(middle);
        given.clone().unwrap_or_else(about).values()
    };
    let grid = PlaceGrid {
        x: range(&arguments.x_mm, part.x),
        y: range(&arguments.y_mm, part.y),
        z: arguments.z_mm.map_or(part.z, |z| 1e-3 * z),
        rolls: usize::from(arguments.rolls),
    };
    let count = grid.x.len() * grid.y.len();
    let bar = progress::places(count, arguments.quiet || arguments.json);
    let tried = tried_places(&setup, &grid, &|| bar.inc(1));
    bar.finish_and_clear();
    let mut files = Vec::new();
    if let Some(out) = &arguments.out {
        let robot = setup.scenario.arm.world_from_base.translation;
        let bodies = footprints(&setup, best_places(&tried).into_iter().next());
        let picture = svg(&setup.scenario.title, &grid, &tried, (robot, part), &bodies);
        files.push((out, picture));
    }
    if let Some(csv) = &arguments.csv {
        files.push((csv, table(&tried)));
    }
    write_all(&files)?;
    if arguments.json {
        say(&json(arguments, &tried))?;
    } else if !arguments.quiet {
        say(&text(&document(arguments, &tried), Style::Plain))?;
    }
    Ok(if tried.iter().any(|place| place.outcome.is_ok()) {
        ExitCode::Done
    } else {
        ExitCode::OutsideBounds
    })
}

/// Every place, one a line.
fn table(tried: &[TriedPlace]) -> String {
    let mut text =
        "x_mm,y_mm,z_mm,rolls_possible,hindrance,roll_deg,comfort,cycle_time_s\n".to_owned();
    for place in tried {
        let [x, y, z] = millimetres(place);
        let rest = match place.outcome {
            Err(hindrance) => format!("{},,,", hindrance.name()),
            Ok(best) => format!(
                ",{},{:.3},{:.2}",
                degrees(best.roll),
                best.comfort,
                best.cycle_time
            ),
        };
        // Writing into a text cannot fail.
        let _ = writeln!(text, "{x},{y},{z},{},{rest}", place.rolls);
    }
    text
}

fn millimetres(place: &TriedPlace) -> [f64; 3] {
    place.position.to_array().map(shown)
}

/// A length in millimetres, to a tenth.
fn shown(metres: f64) -> f64 {
    (metres * 1e4).round() / 10.0 + 0.0
}

fn degrees(angle: f64) -> f64 {
    (angle.to_degrees() * 100.0).round() / 100.0 + 0.0
}

fn json(arguments: &PlaceArguments, tried: &[TriedPlace]) -> String {
    let best = best_places(tried).into_iter().take(PRINTED);
    let best: Vec<_> = best
        .map(|(position, possible)| {
            serde_json::json!({
                "position_mm": position.to_array().map(shown),
                "roll_deg": degrees(possible.roll),
                "comfort": (1e3 * possible.comfort).round() / 1e3,
                "cycle_time_s": (100.0 * possible.cycle_time).round() / 100.0,
            })
        })
        .collect();
    let document = serde_json::json!({
        "scenario": arguments.scenario.display().to_string(),
        "tried": tried.len(),
        "possible": tried.iter().filter(|place| place.outcome.is_ok()).count(),
        "best": best,
    });
    format!("{document:#}\n")
}

/// Where the job can be done, what hinders it elsewhere, and the lines of the best position.
fn document(arguments: &PlaceArguments, tried: &[TriedPlace]) -> Document<'static> {
    let best = best_places(tried);
    let mut hindered: Vec<(usize, &str)> = crate::place::Hindrance::ALL
        .into_iter()
        .map(|hindrance| {
            let is = |place: &&TriedPlace| place.outcome == Err(hindrance);
            (tried.iter().filter(is).count(), hindrance.name())
        })
        .filter(|(count, _)| *count > 0)
        .collect();
    hindered.sort_unstable_by_key(|(count, _)| std::cmp::Reverse(*count));
    let reasons: Vec<String> = hindered
        .iter()
        .map(|(count, name)| format!("{name} {count}"))
        .collect();
    let lead = (!reasons.is_empty()).then(|| format!("Not possible for: {}.", reasons.join(", ")));
    let row = |(position, possible): &(DVec3, Possible)| {
        let [x, y, z] = position.to_array().map(shown);
        vec![
            Cell::from(format!("[{x}, {y}, {z}]")),
            Cell::from(degrees(possible.roll).to_string()),
            Cell::from(format!("{:.2}", possible.comfort)),
            Number::new("", Some(possible.cycle_time), "s").into(),
        ]
    };
    let mut sections = Vec::new();
    if let Some((position, possible)) = best.first() {
        let columns = Column::list("position_mm | #roll_deg | #comfort | #cycle time");
        let rows = best.iter().take(PRINTED).map(row).collect();
        let table = Block::Table(Table::new("", columns, rows));
        sections.push(Section::new("Best positions", vec![table]));
        let [x, y, z] = position.to_array().map(shown);
        let roll = degrees(possible.roll);
        let lines = format!(
            "[workpiece]\nposition_mm = [{x}, {y}, {z}]\n\n[process]\nroll_deg = {roll}\n\n\
             idc run {} --set 'workpiece.position_mm=[{x}, {y}, {z}]' --set process.roll_deg={roll}",
            word(&arguments.scenario)
        );
        let title = "The best one for the scenario, and as a run";
        sections.push(Section::new(title, vec![Block::Lines(lines)]));
    }
    if let Some(out) = &arguments.out {
        let file = Block::File(out.display().to_string(), "the map of positions".to_owned());
        sections.push(Section::new("Picture", vec![file]));
    }
    Document {
        title: "Positions of the part".to_owned(),
        verdict: format!(
            "The whole job can be done at {} of {} positions.",
            best.len(),
            tried.len()
        ),
        tone: if best.is_empty() {
            Tone::Bad
        } else {
            Tone::Good
        },
        lead: lead.into_iter().collect(),
        sections,
        ..Document::default()
    }
}

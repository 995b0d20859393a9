//! Another edge, another stretch of it, another direction along it.

use glam::DVec3;

use super::amounts::{first, held_back};
use super::kind::Kind;
use super::remedy::Remedy;
use super::trial::Trial;
use crate::cell::{CellError, Setup, choose_edge, largest_balls};
use crate::scenario::{EdgeChoice, EdgeSelection, KeyValue, Scenario, WorkpieceScenario};
use crate::workpiece::{Convexity, EdgeCurve, EdgeSearch, list_edges, load_mesh};

/// Edges that are tried in place of one that cannot be ridden.
const EDGES: usize = 6;
/// Shortest stretch that is worth a job, of the ball's radius [1].
const SHORTEST: f64 = 2.0;

/// The direction of the tool that is nearest to all bisectors.
pub(super) fn tool_axis(trial: &Trial<'_>, setup: &Setup) -> Option<Remedy> {
    const LOOKS: usize = 200;
    let (edge, pose) = (&setup.part.edge, setup.scenario.workpiece.world_from_part);
    let looks = (0..=LOOKS).map(|look| edge.length * look as f64 / LOOKS as f64);
    let sum: DVec3 = looks.map(|place| edge.at(place).bisector).sum();
    let axis = -(pose.rotation * sum).try_normalize()?;
    let [x, y, z] = axis.to_array().map(|v| (1e3 * v).round() / 1e3 + 0.0);
    let edits = vec![KeyValue::typed(
        "process.tool_axis",
        &format!("[{x}, {y}, {z}]"),
    )];
    let words = "the tool along the edge's bisector";
    let friction = held_back(&setup.scenario);
    first(trial, Kind::ToolAxis, words, vec![edits], friction)
}

/// The whole edge that a scenario chooses a stretch of.
fn whole(scenario: &Scenario) -> Option<EdgeCurve> {
    let workpiece = WorkpieceScenario {
        edge: EdgeChoice {
            start: 0.0,
            end: None,
            ..scenario.workpiece.edge.clone()
        },
        ..scenario.workpiece.clone()
    };
    let mesh = load_mesh(&workpiece.mesh, workpiece.mesh_scale).ok()?;
    choose_edge(&scenario.path, &workpiece, &mesh).ok()
}

/// A length in millimetres to a thousandth, no longer than it is.
fn floored(length: f64) -> f64 {
    (1e6 * length + 1e-6).floor() / 1e3
}

/// The same stretch the other way round.
pub(super) fn reversed(trial: &Trial<'_>, scenario: &Scenario) -> Option<Remedy> {
    let choice = &scenario.workpiece.edge;
    let key = |name: &str| format!("workpiece.edge.{name}");
    let value = if choice.reversed { "false" } else { "true" };
    let mut edits = vec![KeyValue::typed(key("reversed"), value)];
    if choice.start > 0.0 || choice.end.is_some() {
        let whole = whole(scenario)?;
        if whole.closed {
            return None;
        }
        let end = choice.end.unwrap_or(whole.length);
        let from = (1e6 * (whole.length - end)).ceil().max(0.0) / 1e3;
        edits.push(KeyValue::number(key("start_mm"), from));
        let to = floored(whole.length - choice.start);
        edits.push(KeyValue::number(key("end_mm"), to));
    }
    let words = "the edge followed the other way round";
    let friction = held_back(scenario);
    first(trial, Kind::Reversed, words, vec![edits], friction)
}

/// The longest edge that can be ridden.
pub(super) fn another(trial: &Trial<'_>, scenario: &Scenario) -> Option<Remedy> {
    let workpiece = &scenario.workpiece;
    let choice = &workpiece.edge;
    let mesh = load_mesh(&workpiece.mesh, workpiece.mesh_scale).ok()?;
    let search = EdgeSearch {
        sharp_angle: choice.sharp_angle,
        ..EdgeSearch::default()
    };
    let list = list_edges(&mesh, &search);
    let (name, curves) = match choice.selection {
        EdgeSelection::Edge(_) => ("edge", &list.edges),
        EdgeSelection::Loop(_) => ("loop", &list.loops),
    };
    let of = |curve: &EdgeCurve, number: usize, name: &str| {
        let end = choice.end.unwrap_or(choice.start);
        // A stretch that does not lie on it is left out.
        if end <= curve.length && choice.start < curve.length {
            vec![KeyValue::number(
                format!("workpiece.edge.{name}"),
                number as f64,
            )]
        } else {
            let table = format!("{{ {name} = {number} }}");
            vec![KeyValue::typed("workpiece.edge", &table)]
        }
    };
    let mut convex: Vec<(f64, Vec<KeyValue>)> = curves
        .iter()
        .enumerate()
        .filter(|(_, curve)| curve.convexity == Convexity::Convex)
        .map(|(number, curve)| (curve.length, of(curve, number, name)))
        .collect();
    convex.sort_by(|a, b| b.0.total_cmp(&a.0));
    let tried = convex.into_iter().take(EDGES).map(|(_, edits)| edits);
    let friction = held_back(scenario);
    first(trial, Kind::Edge, "another edge", tried.collect(), friction)
}

/// A stretch that lies on the edge, or the longest one along which the ball can go.
pub(super) fn stretch(
    trial: &Trial<'_>,
    scenario: &Scenario,
    setup: Option<&Setup>,
    refusal: &CellError,
) -> Option<Remedy> {
    let friction = held_back(scenario);
    let edits = |from: f64, to: f64| {
        let number = |name: &str, value: f64| {
            let key = format!("workpiece.edge.{name}");
            KeyValue::number(key, value)
        };
        vec![number("start_mm", from), number("end_mm", to)]
    };
    let words = "another stretch of the edge";
    let choice = &scenario.workpiece.edge;
    if let CellError::EdgeStretch { .. } = refusal {
        let whole = whole(scenario)?;
        let start = if choice.start < whole.length {
            choice.start
        } else {
            0.0
        };
        let last = if whole.closed {
            start + whole.length
        } else {
            whole.length
        };
        let end = choice.end.unwrap_or(last).min(last);
        let start = if start < end { start } else { 0.0 };
        // The whole of it, or what of it about its middle the robot reaches.
        let middle = 0.5 * (start + end);
        let tried = [1.0, 0.6, 0.3].map(|share| {
            let half = 0.5 * share * (end - start);
            edits(floored(middle - half), floored(middle + half))
        });
        return first(trial, Kind::Stretch, words, tried.to_vec(), friction);
    }
    let setup = setup?;
    let radius = scenario.nominal.mounting.tool_radius;
    let (from, to) = longest(&largest_balls(&setup.part, radius), radius)?;
    let tried = [0.0, 0.5, 1.0, 2.0].into_iter().filter_map(|share| {
        // The ends of what is followed anyway stay where they are.
        let keep = |end: f64, sign: f64, own: f64| {
            if (end - own).abs() < 1e-9 {
                end
            } else {
                end + sign * share * radius
            }
        };
        let (from, to) = (keep(from, 1.0, 0.0), keep(to, -1.0, setup.part.edge.length));
        let long = to - from > SHORTEST * radius;
        let from = (1e3 * from).ceil() + floored(choice.start);
        let to = (1e3 * to).floor() + floored(choice.start);
        long.then(|| edits(from, to))
    });
    first(trial, Kind::Stretch, words, tried.collect(), friction)
}

/// The longest stretch on which all largest balls are at least of a radius [m].
fn longest(balls: &[(f64, f64)], radius: f64) -> Option<(f64, f64)> {
    let mut best: Option<(f64, f64)> = None;
    let mut from: Option<f64> = None;
    for (index, &(place, largest)) in balls.iter().enumerate() {
        let fits = largest >= radius;
        if fits {
            from.get_or_insert(place);
        }
        let ends = !fits || index + 1 == balls.len();
        if let (Some(start), true) = (from, ends) {
            let end = if fits { place } else { balls[index - 1].0 };
            if best.is_none_or(|(low, high)| end - start > high - low) {
                best = Some((start, end));
            }
            from = None;
        }
    }
    best.filter(|(low, high)| high > low)
}

#[cfg(test)]
mod tests {
    use super::longest;

    #[test]
    fn the_longest_stretch_is_that_between_what_is_too_tight() {
        let balls = [3.0, 5.0, 5.0, 1.0, 5.0, 5.0, 5.0, 2.0].map(|radius| 1e-3 * radius);
        let balls: Vec<(f64, f64)> = (0..8).map(|i| f64::from(i) * 0.1).zip(balls).collect();
        let (from, to) = longest(&balls, 4e-3).unwrap();
        assert!((from - 0.4).abs() < 1e-12 && (to - 0.6).abs() < 1e-12);
        assert_eq!(longest(&balls, 6e-3), None);
        let (from, to) = longest(&balls, 1e-3).unwrap();
        assert!((from, to) == (0.0, balls[7].0));
    }
}

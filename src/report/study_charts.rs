//! Charts of a design study: its trade-off front, and how the draws at the chosen design lie about its limits.

use crate::design::robustness::Robustness;
use crate::design::{Candidate, LimitState, ObjectiveNames, Side, StudyResult};
use crate::document::{Band, Figure, Horizontal, Marker, Panel, Role, Series, Stroke};
use crate::quantity::display_name::{axis, raised, with_unit};

/// Room left around what must be seen, as a share of its extent.
const MARGIN: f64 = 0.12;
/// The start is drawn on the edge if it lies further from the front than this many times the front's extent.
const FAR: f64 = 3.0;

/// The trade-off front: every design that keeps the limits, the front, the starting and the chosen design, the limits; none without a second objective.
#[must_use]
pub fn front(result: &StudyResult) -> Option<Figure<'static>> {
    let trade_off = result.objectives.trade_off.as_deref()?;
    let names = &result.objectives;
    let label = |key: &str, over: Option<&str>| match over {
        Some(over) if names.scenarios > 1 => {
            format!("{}, {over} of {} scenarios", axis(key), names.scenarios)
        }
        _ => axis(key),
    };
    let [across, up] = ranges(result, trade_off);
    let inside = |point: &&[f64; 2]| {
        (across[0]..=across[1]).contains(&point[0]) && (up[0]..=up[1]).contains(&point[1])
    };
    let others: Vec<[f64; 2]> = result.others.iter().filter(inside).copied().collect();
    let points = result.front.iter();
    let points: Vec<[f64; 2]> = points.map(|p| [p.trade_off, p.objective]).collect();
    let words = "front: none is better in both";
    let series = [
        series("keeps the limits", &others, Role::Measured, Stroke::Points),
        series(
            words,
            &stairs(&points, [across, up]),
            Role::Regulator,
            Stroke::Plain,
        ),
        series("", &points, Role::Regulator, Stroke::Points),
        design(&result.start, "start", names, [across, up]),
        design(&result.chosen, "chosen", names, [across, up]),
    ];
    let (spans, markers) = beyond(limits_of(result, trade_off), across);
    let bands = limits_of(result, &names.minimised).filter_map(|limit| {
        let [from, to] = forbidden(limit, up)?;
        let label = limit_words(limit);
        Some(Band { label, from, to })
    });
    let panel = Panel {
        title: "Trade-off front".to_owned(),
        vertical_label: label(&names.minimised, Some(&names.minimised_over)),
        horizontal: Horizontal::Quantity(label(trade_off, names.trade_off_over.as_deref())),
        series: series.into_iter().flatten().collect(),
        bands: bands.collect(),
        markers,
        spans,
        within: Some(up),
        ..Panel::default()
    };
    let (title, panels) = (result.title.clone(), vec![panel]);
    Some(Figure { title, panels })
}

/// How the objective and each limited quantity are distributed over the draws; none if nothing was drawn.
#[must_use]
pub fn robustness(result: &StudyResult) -> Option<Figure<'static>> {
    let found = result.robustness.as_ref()?;
    let (kept, runs) = (found.all_limits.kept, found.runs);
    let panels = (0..found.quantiles.len()).map(|place| distribution(result, found, place));
    Some(Figure {
        title: format!("{}: {kept} of {runs} draws keep all limits", result.title),
        panels: panels.collect(),
    })
}

/// One quantity: the share of the draws that lies at or below each value.
fn distribution(result: &StudyResult, found: &Robustness, place: usize) -> Panel<'static> {
    let own = &found.quantiles[place];
    let draws = found.draws.iter();
    let mut values: Vec<(f64, bool)> = draws
        .filter_map(|draw| Some((draw.metrics[place]?, draw.kept)))
        .collect();
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [low, high] = extent(values.iter().map(|v| v.0).chain([own.chosen]));
    // A bound that is far off would press all draws into one line.
    let near = |bound: &f64| (bound - low).abs().min((bound - high).abs()) <= 2.0 * (high - low);
    let bounds = limits_of(result, &own.metric).map(|limit| limit.bound);
    let across = with_margin(extent([low, high].into_iter().chain(bounds.filter(near))));
    let (spans, markers) = beyond(limits_of(result, &own.metric), across);
    let of = |is_kept: bool| -> Vec<[f64; 2]> {
        let share = |rank: usize| 100.0 * (rank + 1) as f64 / found.runs as f64;
        let ranked = values.iter().enumerate();
        let own = ranked.filter(|(_, (_, kept))| *kept == is_kept);
        own.map(|(rank, (value, _))| [*value, share(rank)])
            .collect()
    };
    let [least, most] = across.map(|end| [end, f64::NAN]);
    let chosen = [least, [own.chosen, 0.0], [own.chosen, 100.0], most];
    let words = ["draw that keeps all limits", "draw that breaks one"];
    let series = [
        series(
            "chosen design as it is",
            &chosen,
            Role::Command,
            Stroke::Plain,
        ),
        series(words[0], &of(true), Role::Regulator, Stroke::Points),
        series(words[1], &of(false), Role::Force, Stroke::Points),
    ];
    Panel {
        title: axis(&own.metric),
        vertical_label: "draws at or below [%]".to_owned(),
        horizontal: Horizontal::Quantity(axis(&own.metric)),
        series: series.into_iter().flatten().collect(),
        markers,
        spans,
        within: Some([0.0, 100.0]),
        ..Panel::default()
    }
}

/// A series; none without points.
fn series(label: &str, points: &[[f64; 2]], role: Role, stroke: Stroke) -> Option<Series<'static>> {
    let of = |which: usize| points.iter().map(|point| point[which]).collect::<Vec<_>>();
    (!points.is_empty()).then(|| Series::new(label, of(0), of(1), role, stroke))
}

/// A design with its values; one beyond the picture stands on its edge and says so.
fn design(
    candidate: &Candidate,
    word: &str,
    names: &ObjectiveNames,
    ranges: [[f64; 2]; 2],
) -> Option<Series<'static>> {
    let own = [candidate.trade_off?, candidate.objective];
    let shown = [0, 1].map(|axis| own[axis].clamp(ranges[axis][0], ranges[axis][1]));
    let second = names.trade_off.as_deref().unwrap_or_default();
    let [x, y] =
        [(second, own[0]), (&names.minimised, own[1])].map(|(key, value)| short(key, value));
    let breaks = if candidate.feasible {
        ""
    } else {
        ", breaks a limit"
    };
    let beyond = if shown == own {
        ""
    } else {
        ", beyond this picture"
    };
    let role = if word == "chosen" {
        Role::Force
    } else {
        Role::Command
    };
    let label = format!("{word}: {x}, {y}{breaks}{beyond}");
    series(&label, &[shown], role, Stroke::Mark)
}

/// Between two designs nothing was computed: the staircase is what is known to be reachable, from end to end of the picture.
fn stairs(points: &[[f64; 2]], [across, up]: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
    let mut height = up[1];
    let mut stairs = vec![[across[0], f64::NAN]];
    for point in points {
        stairs.extend([[point[0], height], *point]);
        height = point[1];
    }
    stairs.push([across[1], height]);
    stairs
}

/// Range that must be seen: the front and the chosen design, the start unless it is far, and what limits both axes if that is near.
fn ranges(result: &StudyResult, trade_off: &str) -> [[f64; 2]; 2] {
    let keys = [trade_off, result.objectives.minimised.as_str()];
    [0, 1].map(|axis| {
        let of = |candidate: &Candidate| [candidate.trade_off, Some(candidate.objective)][axis];
        let points = result.front.iter();
        let points = points.map(|point| [point.trade_off, point.objective][axis]);
        let [low, high] = extent(points.chain(of(&result.chosen)));
        let near = |value: f64, times: f64| {
            let room = times * (high - low);
            high <= low || (low - room..=high + room).contains(&value)
        };
        let start = of(&result.start).filter(|value| near(*value, FAR));
        let bounds = limits_of(result, keys[axis]).map(|limit| limit.bound);
        let bounds = bounds.filter(|bound| near(*bound, 0.5));
        with_margin(extent([low, high].into_iter().chain(start).chain(bounds)))
    })
}

fn extent(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    })
}

/// What is one point still needs an axis.
fn with_margin([low, high]: [f64; 2]) -> [f64; 2] {
    let least = 0.02 * low.abs().max(high.abs()).max(1e-9);
    let margin = MARGIN * (high - low).max(least);
    [low - margin, high + margin]
}

/// Limits on a metric.
fn limits_of<'a>(result: &'a StudyResult, key: &'a str) -> impl Iterator<Item = &'a LimitState> {
    let limits = result.chosen.limits.iter();
    limits.filter(move |limit| limit.key == key)
}

/// What a limit forbids of a range; none where that is out of sight.
fn forbidden(limit: &LimitState, [low, high]: [f64; 2]) -> Option<[f64; 2]> {
    let is_seen = low < limit.bound && limit.bound < high;
    is_seen.then_some(match limit.side {
        Side::Max => [limit.bound, high],
        Side::Min => [low, limit.bound],
    })
}

/// What limits forbid of the horizontal axis, and where they stand.
fn beyond<'a>(
    limits: impl Iterator<Item = &'a LimitState>,
    across: [f64; 2],
) -> (Vec<[f64; 2]>, Vec<Marker>) {
    let marked = |limit: &LimitState| Marker {
        label: limit_words(limit),
        at: limit.bound,
    };
    let seen = limits.filter_map(|limit| Some((forbidden(limit, across)?, marked(limit))));
    seen.unzip()
}

fn limit_words(limit: &LimitState) -> String {
    let side = match limit.side {
        Side::Max => "at most",
        Side::Min => "at least",
    };
    format!("limit: {side} {}", short(&limit.key, limit.bound))
}

/// As [`with_unit`], to four significant digits.
fn short(key: &str, value: f64) -> String {
    let shown = format!("{value:.3e}").parse().unwrap_or(value);
    raised(&with_unit(key, shown))
}

//! The tried positions seen from above: how comfortable the job is where it can be done, and what is in its way where it cannot; over them the robot, the
//! obstacles and the part.

use glam::{DVec2, DVec3};
use maud::{Markup, html};

use super::{Footprint, FootprintKind, Hindrance, PlaceGrid, TriedPlace, best_places};
use crate::figure::ticks;

/// Edges of the map, and size of the picture [px].
const LEFT: f64 = 84.0;
const RIGHT: f64 = 690.0;
const TOP: f64 = 52.0;
const BOTTOM: f64 = 692.0;
const SIZE: [f64; 2] = [900.0, 760.0];
/// A row of the legend, and its scale of colours [px].
const ROW: f64 = 26.0;
const RAMP: f64 = 200.0;
const DARK: &str = "#222";
const GREY: &str = "#666";
/// Comfort from 0 to 1: from yellow over green to deep blue (viridis, reversed), which the colour-blind tell apart and a printer too.
const COMFORT: [[u8; 3]; 5] = [
    [0xFD, 0xE7, 0x25],
    [0x5E, 0xC9, 0x62],
    [0x21, 0x91, 0x8C],
    [0x3B, 0x52, 0x8B],
    [0x44, 0x01, 0x54],
];
/// Bodies from below to above: colour and opacity of the inside, colour and width of the outline.
const BODIES: [(FootprintKind, &str, f64, &str, u32); 6] = [
    (FootprintKind::Reach, "none", 1.0, DARK, 2),
    (FootprintKind::Obstacle, "#C8BEAA", 0.9, DARK, 2),
    (FootprintKind::Base, "#E69F00", 0.75, DARK, 2),
    (FootprintKind::Link, "#E69F00", 0.3, GREY, 1),
    (FootprintKind::PartNow, "#FFF", 0.25, GREY, 2),
    (FootprintKind::PartBest, "#FFF", 0.45, DARK, 3),
];
/// Dashes of how far the tool reaches [px].
const DASHES: &str = "6 4";

/// Of the map's axes, from and to [mm].
type Ranges = [[f64; 2]; 2];

/// The picture as SVG; `robot` and `part` are where the arm's base and the part of the scenario stand [m], `bodies` what stands there.
#[must_use]
pub fn svg(
    title: &str,
    grid: &PlaceGrid,
    tried: &[TriedPlace],
    (robot, part): (DVec3, DVec3),
    bodies: &[Footprint],
) -> String {
    let half = DVec2::new(half_step(&grid.x), half_step(&grid.y));
    let span = |values: &[f64], half: f64| {
        let ends = [values.first(), values.last()].map(|end| end.map_or(0.0, |v| 1e3 * v));
        [ends[0] - half, ends[1] + half]
    };
    let tiles = [span(&grid.x, half.x), span(&grid.y, half.y)];
    let ranges = of_one_scale(with_room(tiles, robot, bodies));
    let best = best_places(tried).first().map(|(position, _)| *position);
    let marks = [
        (Some(robot), "robot"),
        (Some(part), "part now"),
        (best, "part, best"),
    ];
    let drawn = html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", SIZE[0], SIZE[1])) width=(SIZE[0]) height=(SIZE[1])
            role="img" aria-label="where the part can lie, from above" font-family="Arial, Liberation Sans, Helvetica, sans-serif" font-size="14" fill=(DARK) {
            rect width=(SIZE[0]) height=(SIZE[1]) fill="#FFF" {}
            clipPath id="map" { rect x=(LEFT) y=(TOP) width=(RIGHT - LEFT) height=(BOTTOM - TOP) {} }
            text x=(LEFT) y="34" font-size="18" { (title.replace(char::is_control, " ")) ": where the part can lie" }
            g clip-path="url(#map)" {
                @for place in tried { (tile(place, half, ranges, most_comfort(tried))) }
                @for kind in &BODIES { (outlines(kind, ranges, bodies)) }
                @for body in of_kind(bodies, FootprintKind::Obstacle) {
                    @let middle = middle(&body.outline, ranges);
                    text x=(px(middle.x)) y=(px(middle.y + 5.0)) text-anchor="middle" { (body.name.replace(char::is_control, " ")) }
                }
                @for (at, word) in marks.iter().filter_map(|(at, word)| Some(((*at)?, word))) {
                    @let at = on_map(1e3 * at.truncate(), ranges);
                    circle cx=(px(at.x)) cy=(px(at.y)) r="7" fill="#FFF" stroke=(DARK) stroke-width="2" {}
                    text x=(px(at.x + 14.0)) y=(px(at.y + 5.0)) stroke="#FFF" stroke-width="4" stroke-opacity="0.85" paint-order="stroke" { (word) }
                }
            }
            (axes(ranges))
            (legend(tried, bodies))
        }
    };
    drawn.into_string()
}

/// To a tenth of a pixel.
fn px(value: f64) -> String {
    format!("{value:.1}")
}

/// Where a place [mm] lies in the picture [px].
fn on_map(at: DVec2, [across, up]: Ranges) -> DVec2 {
    let share = |value: f64, [low, high]: [f64; 2]| (value - low) / (high - low);
    DVec2::new(
        LEFT + share(at.x, across) * (RIGHT - LEFT),
        BOTTOM - share(at.y, up) * (BOTTOM - TOP),
    )
}

/// Half of a grid's step [mm].
fn half_step(values: &[f64]) -> f64 {
    match values {
        [first, .., last] => 500.0 * (last - first) / (values.len() - 1) as f64,
        _ => 25.0,
    }
}

fn of_kind(bodies: &[Footprint], kind: FootprintKind) -> impl Iterator<Item = &Footprint> + Clone {
    bodies.iter().filter(move |body| body.kind == kind)
}

/// A tried position, a little over its neighbours, or seams would show.
fn tile(place: &TriedPlace, half: DVec2, ranges: Ranges, most: f64) -> Markup {
    let middle = 1e3 * place.position.truncate();
    let [from, to] = [-1.02, 1.02].map(|side| on_map(middle + side * half, ranges));
    let fill = match place.outcome {
        Ok(possible) => shade(possible.comfort / most),
        Err(hindrance) => tint(hindrance).to_owned(),
    };
    html! { rect x=(px(from.x)) y=(px(to.y)) width=(px(to.x - from.x)) height=(px(from.y - to.y)) fill=(fill) {} }
}

/// The bodies of a kind: obstacles and the part filled, the arm shaded over the map.
fn outlines(
    (kind, fill, opacity, line, width): &(FootprintKind, &str, f64, &str, u32),
    ranges: Ranges,
    bodies: &[Footprint],
) -> Markup {
    let corners = |body: &Footprint| {
        let corners = body.outline.iter().map(|at| on_map(1e3 * *at, ranges));
        let corners: Vec<String> = corners
            .map(|at| format!("{:.1},{:.1}", at.x, at.y))
            .collect();
        corners.join(" ")
    };
    let dashes = (*kind == FootprintKind::Reach).then_some(DASHES);
    html! {
        @for body in of_kind(bodies, *kind) {
            polygon points=(corners(body)) fill=(fill) fill-opacity=(opacity) stroke=(line) stroke-width=(width) stroke-dasharray=[dashes] {}
        }
    }
}

/// The middle of what is seen of an outline [m], in the picture [px].
fn middle(outline: &[DVec2], ranges: Ranges) -> DVec2 {
    let [low, high] = [DVec2::new(LEFT, TOP), DVec2::new(RIGHT, BOTTOM)];
    let seen = outline
        .iter()
        .map(|at| on_map(1e3 * *at, ranges).clamp(low, high));
    seen.sum::<DVec2>() / outline.len() as f64
}

/// Ranges widened so that the robot is seen, and of the obstacles those that stand about it and the tried positions.
fn with_room(tiles: Ranges, robot: DVec3, bodies: &[Footprint]) -> Ranges {
    let arm = [FootprintKind::Base, FootprintKind::Link].map(|kind| of_kind(bodies, kind));
    let arm = arm.into_iter().flatten().flat_map(|body| &body.outline);
    let arm = arm.map(|at| 1e3 * *at).chain([1e3 * robot.truncate()]);
    let mut seen = tiles;
    widen(&mut seen, arm);
    // Beyond as much again only their near part is seen.
    let near = seen.map(|[low, high]| [1.5 * low - 0.5 * high, 1.5 * high - 0.5 * low]);
    let [low, high] = [0, 1].map(|end| DVec2::new(near[0][end], near[1][end]));
    for body in of_kind(bodies, FootprintKind::Obstacle) {
        let corners = body.outline.iter().map(|at| (1e3 * *at).clamp(low, high));
        // One that lies beyond as a whole is not looked for.
        let is_near = |at: &DVec2| at.cmpgt(low).all() && at.cmplt(high).all();
        if corners.clone().any(|at| is_near(&at)) {
            widen(&mut seen, corners);
        }
    }
    seen
}

/// Widens ranges [mm] to points, with some room about these.
fn widen(ranges: &mut Ranges, points: impl Iterator<Item = DVec2>) {
    const ROOM: f64 = 30.0;
    for at in points {
        for (range, value) in ranges.iter_mut().zip([at.x, at.y]) {
            *range = [range[0].min(value - ROOM), range[1].max(value + ROOM)];
        }
    }
}

/// Ranges widened so that a millimetre is as long across as it is up.
fn of_one_scale(ranges: Ranges) -> Ranges {
    let room = [RIGHT - LEFT, BOTTOM - TOP];
    let scale = [0, 1].map(|axis| (ranges[axis][1] - ranges[axis][0]) / room[axis]);
    let scale = scale[0].max(scale[1]);
    [0, 1].map(|axis| {
        let middle = f64::midpoint(ranges[axis][0], ranges[axis][1]);
        [-0.5, 0.5].map(|share| middle + share * scale * room[axis])
    })
}

fn axes(ranges: Ranges) -> Markup {
    let at = |x: f64, y: f64| on_map(DVec2::new(x, y), ranges);
    let (x, y) = (f64::midpoint(LEFT, RIGHT), f64::midpoint(TOP, BOTTOM));
    html! {
        path fill="none" stroke=(GREY) d=(format!("M{LEFT} {TOP}V{BOTTOM}H{RIGHT}")) {}
        @for (tick, words) in ticks(ranges[0]) {
            @let x = px(at(tick, 0.0).x);
            path stroke=(GREY) d=(format!("M{x} {BOTTOM}v5")) {}
            text x=(x) y=(BOTTOM + 21.0) text-anchor="middle" { (words) }
        }
        @for (tick, words) in ticks(ranges[1]) {
            @let y = at(0.0, tick).y;
            path stroke=(GREY) d=(format!("M{LEFT} {y:.1}h-5")) {}
            text x=(LEFT - 9.0) y=(px(y + 5.0)) text-anchor="end" { (words) }
        }
        text x=(x) y=(BOTTOM + 48.0) text-anchor="middle" { "part position x [mm]" }
        text transform=(format!("translate(22 {y}) rotate(-90)")) text-anchor="middle" { "part position y [mm]" }
    }
}

/// The end of the colours: the largest comfort, at least 1.
fn most_comfort(tried: &[TriedPlace]) -> f64 {
    let comforts = tried.iter().filter_map(|place| place.outcome.ok());
    comforts
        .map(|possible| possible.comfort)
        .fold(1.0, f64::max)
}

/// Colour of a share of the largest comfort.
fn shade(comfort: f64) -> String {
    let steps = COMFORT.len() - 1;
    let along = comfort.clamp(0.0, 1.0) * steps as f64;
    let index = (along as usize).min(steps - 1);
    let share = along - index as f64;
    let [from, to] = [COMFORT[index], COMFORT[index + 1]].map(|of| of.map(f64::from));
    let [red, green, blue] = [0, 1, 2].map(|which| from[which] + share * (to[which] - from[which]));
    format!("rgb({red:.0},{green:.0},{blue:.0})")
}

/// Tint of what is in the way: pale, so that it is not taken for a comfort.
fn tint(hindrance: Hindrance) -> &'static str {
    match hindrance {
        Hindrance::Reach => "#EEE",
        Hindrance::Singularity => "#D2D2D2",
        Hindrance::Collision => "#F4B8A8",
        Hindrance::Torque => "#E3C0E0",
        Hindrance::Speed => "#F3D9B1",
        Hindrance::Edge => "#B0B0B0",
    }
}

/// What the colours say, beside the map; of hindrances those that there are.
fn legend(tried: &[TriedPlace], bodies: &[Footprint]) -> Markup {
    let left = RIGHT + 24.0;
    let beside = left + 32.0;
    let top = TOP + 28.0;
    let present = |hindrance: &Hindrance| tried.iter().any(|p| p.outcome == Err(*hindrance));
    let present: Vec<_> = Hindrance::ALL.into_iter().filter(present).collect();
    let below = top + RAMP + 1.5 * ROW;
    let row = |index: usize| below + ROW * index as f64;
    let stops = COMFORT.len() - 1;
    html! {
        linearGradient id="comfort" x1="0" x2="0" y1="1" y2="0" {
            @for index in 0..=stops {
                @let share = index as f64 / stops as f64;
                stop offset=(share) stop-color=(shade(share)) {}
            }
        }
        text x=(left) y=(top - 10.0) { "comfort" }
        rect x=(left) y=(top) width="24" height=(RAMP) fill="url(#comfort)" {}
        text x=(beside) y=(top + 12.0) { (format!("{:.1}", most_comfort(tried))) }
        text x=(beside) y=(top + RAMP) { "0: at a limit" }
        @if !present.is_empty() { text x=(left) y=(row(0)) { "not possible for" } }
        @for (index, hindrance) in present.iter().enumerate() {
            rect x=(left) y=(row(index + 1) - 13.0) width="24" height="16" fill=(tint(*hindrance)) stroke=(GREY) {}
            text x=(beside) y=(row(index + 1)) { (hindrance.name()) }
        }
        @for body in of_kind(bodies, FootprintKind::Reach) {
            @let y = row(present.len() + 2);
            path stroke=(DARK) stroke-width="2" stroke-dasharray=(DASHES) d=(format!("M{left} {}h24", y - 5.0)) {}
            text x=(beside) y=(y) { (body.name) }
            text x=(left) y=(y + 24.0) { "with the tool, stretched" }
        }
    }
}

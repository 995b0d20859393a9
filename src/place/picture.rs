//! The tried positions seen from above: how comfortable the job is where it can be done, and what is in its way where it cannot; over them the robot, the
//! obstacles and the part.
//!
//! The drawing library counts in whole units; a unit is a tenth of a pixel here.

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use glam::{DVec2, DVec3};

use super::{Footprint, FootprintKind, Hindrance, PlaceGrid, TriedPlace, best_places};

const PX: i32 = 10;
const WIDTH: i32 = 900 * PX;
const HEIGHT: i32 = 760 * PX;
const RIGHT: i32 = 210 * PX;
const FONT: &str = "Arial, Liberation Sans, Helvetica, sans-serif";
const TEXT: i32 = 17 * PX;
const LARGE: i32 = 22 * PX;
const DARK: RGBColor = RGBColor(0x22, 0x22, 0x22);
const GREY: RGBColor = RGBColor(0x66, 0x66, 0x66);
const ROBOT: RGBColor = RGBColor(0xE6, 0x9F, 0x00);
const OBSTACLE: RGBColor = RGBColor(0xC8, 0xBE, 0xAA);
/// Comfort from 0 to 1: from yellow over green to deep blue (viridis, reversed), which the colour-blind tell apart and a printer too.
const COMFORT: [RGBColor; 5] = [
    RGBColor(0xFD, 0xE7, 0x25),
    RGBColor(0x5E, 0xC9, 0x62),
    RGBColor(0x21, 0x91, 0x8C),
    RGBColor(0x3B, 0x52, 0x8B),
    RGBColor(0x44, 0x01, 0x54),
];

type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The picture as SVG; `robot` and `part` are where the arm's base and the part of the scenario stand [m], `bodies` what stands there.
///
/// # Errors
/// The drawing library refuses; in its words.
pub fn svg(
    title: &str,
    grid: &PlaceGrid,
    tried: &[TriedPlace],
    (robot, part): (DVec3, DVec3),
    bodies: &[Footprint],
) -> Result<String, String> {
    let mut text = String::new();
    let surroundings = Surroundings {
        robot,
        part,
        bodies,
    };
    draw(&mut text, title, grid, tried, &surroundings).map_err(|error| error.to_string())?;
    let size = format!("width=\"{WIDTH}\" height=\"{HEIGHT}\"");
    let shown = format!(
        "width=\"{}\" height=\"{}\" role=\"img\" aria-label=\"where the part can lie, from above\"",
        WIDTH / PX,
        HEIGHT / PX
    );
    Ok(text.replacen(&size, &shown, 1))
}

/// What stands in the cell.
struct Surroundings<'a> {
    robot: DVec3,
    part: DVec3,
    bodies: &'a [Footprint],
}

/// Half of a grid's step [mm].
fn half_step(values: &[f64]) -> f64 {
    match values {
        [first, .., last] => 500.0 * (last - first) / (values.len() - 1) as f64,
        _ => 25.0,
    }
}

fn draw(
    text: &mut String,
    title: &str,
    grid: &PlaceGrid,
    tried: &[TriedPlace],
    surroundings: &Surroundings<'_>,
) -> Drawn {
    let root = SVGBackend::with_string(text, (WIDTH as u32, HEIGHT as u32)).into_drawing_area();
    root.fill(&WHITE)?;
    let left = Pos::new(HPos::Left, VPos::Center);
    let style = |size: i32| (FONT, size).into_font().color(&DARK).pos(left);
    let title = title.replace(char::is_control, " ");
    root.draw(&Text::new(
        format!("{title}: where the part can lie"),
        (84 * PX, 28 * PX),
        style(LARGE),
    ))?;
    let half = [half_step(&grid.x), half_step(&grid.y)];
    let span = |values: &[f64], half: f64| {
        let ends = [values.first(), values.last()].map(|end| end.map_or(0.0, |end| 1e3 * end));
        (ends[0] - half, ends[1] + half)
    };
    let (across, up) = (span(&grid.x, half[0]), span(&grid.y, half[1]));
    let (across, up) = with_room(across, up, surroundings);
    let (across, up) = of_equal_scale(across, up);
    let mut chart = ChartBuilder::on(&root)
        .margin_top(52 * PX)
        .margin_right(RIGHT)
        .margin_bottom(8 * PX)
        .margin_left(6 * PX)
        .x_label_area_size(60 * PX)
        .y_label_area_size(76 * PX)
        .build_cartesian_2d(across.0..across.1, up.0..up.1)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .axis_style(GREY.stroke_width(PX as u32))
        .set_all_tick_mark_size(5 * PX)
        .label_style((FONT, TEXT).into_font().color(&DARK))
        .axis_desc_style((FONT, TEXT).into_font().color(&DARK))
        .x_desc("part position x [mm]")
        .y_desc("part position y [mm]")
        .x_label_formatter(&|value| format!("{value:.0}"))
        .y_label_formatter(&|value| format!("{value:.0}"))
        .draw()?;
    let most = most_comfort(tried);
    for place in tried {
        let [x, y] = [1e3 * place.position.x, 1e3 * place.position.y];
        // A little over its neighbours, or seams would show.
        let half = half.map(|half| 1.02 * half);
        let corners = [(x - half[0], y - half[1]), (x + half[0], y + half[1])];
        let colour = match place.outcome {
            Ok(possible) => shade(possible.comfort / most),
            Err(hindrance) => tint(hindrance),
        };
        chart.draw_series([Rectangle::new(corners, colour.filled())])?;
    }
    reach(&mut chart, [across, up], surroundings.bodies)?;
    outlines(&mut chart, [across, up], surroundings.bodies)?;
    marks(&mut chart, tried, [across, up], surroundings)?;
    legend(&root, tried, surroundings.bodies)?;
    root.present()
}

/// Robot, the part as the scenario has it, and the best place.
fn marks(
    chart: &mut Chart<'_, '_>,
    tried: &[TriedPlace],
    [across, up]: [(f64, f64); 2],
    surroundings: &Surroundings<'_>,
) -> Drawn {
    let left = Pos::new(HPos::Left, VPos::Center);
    let style = |size: i32| (FONT, size).into_font().color(&DARK).pos(left);
    let mark = |at: DVec3, word: &'static str| {
        let size = 7 * PX;
        EmptyElement::at((1e3 * at.x, 1e3 * at.y))
            + Circle::new((0, 0), size, WHITE.filled())
            + Circle::new((0, 0), size, DARK.stroke_width(2 * PX as u32))
            + Rectangle::new(
                [
                    (11 * PX, -11 * PX),
                    ((17 + 8 * word.len() as i32) * PX, 11 * PX),
                ],
                WHITE.mix(0.85).filled(),
            )
            + Text::new(word, (14 * PX, 0), style(TEXT))
    };
    let inside = |at: &DVec3| {
        (across.0..across.1).contains(&(1e3 * at.x)) && (up.0..up.1).contains(&(1e3 * at.y))
    };
    let best = best_places(tried).first().map(|(position, _)| *position);
    let (robot, part) = (surroundings.robot, surroundings.part);
    let marks = [
        (Some(robot), "robot"),
        (Some(part), "part now"),
        (best, "part, best"),
    ];
    for (at, word) in marks {
        if let Some(at) = at.filter(inside) {
            chart.draw_series([mark(at, word)])?;
        }
    }
    for body in surroundings.bodies {
        if body.kind == FootprintKind::Obstacle {
            let seen = clipped(&body.outline, [across, up]);
            if !seen.is_empty() {
                let middle = seen.iter().sum::<DVec2>() / seen.len() as f64;
                let name = body.name.replace(char::is_control, " ");
                let style = style(TEXT).pos(Pos::new(HPos::Center, VPos::Center));
                chart.draw_series([Text::new(name, (middle.x, middle.y), style)])?;
            }
        }
    }
    Ok(())
}

/// The bodies' outlines: obstacles and the part filled, the arm shaded over the map.
fn outlines(chart: &mut Chart<'_, '_>, within: [(f64, f64); 2], bodies: &[Footprint]) -> Drawn {
    let order = [
        FootprintKind::Obstacle,
        FootprintKind::Base,
        FootprintKind::Link,
        FootprintKind::PartNow,
        FootprintKind::PartBest,
    ];
    for kind in order {
        for body in bodies.iter().filter(|body| body.kind == kind) {
            let seen = clipped(&body.outline, within);
            if seen.len() < 3 {
                continue;
            }
            let corners: Vec<(f64, f64)> = seen.iter().map(|at| (at.x, at.y)).collect();
            let (filled, line, width) = match kind {
                FootprintKind::Obstacle => (OBSTACLE.mix(0.9), DARK.mix(0.8), 2),
                FootprintKind::Base => (ROBOT.mix(0.75), DARK.mix(0.9), 2),
                FootprintKind::Link => (ROBOT.mix(0.3), DARK.mix(0.5), 1),
                FootprintKind::PartNow => (WHITE.mix(0.25), GREY.mix(1.0), 2),
                FootprintKind::PartBest => (WHITE.mix(0.45), DARK.mix(1.0), 3),
                FootprintKind::Reach => continue,
            };
            let closed = corners.iter().chain(corners.first()).copied();
            let closed: Vec<(f64, f64)> = closed.collect();
            chart.draw_series([Polygon::new(corners, filled.filled())])?;
            let style = line.stroke_width(width * PX as u32);
            chart.draw_series([PathElement::new(closed, style)])?;
        }
    }
    Ok(())
}

/// How far the tool reaches: every other piece of a circle, as far as it is within the frame.
fn reach(chart: &mut Chart<'_, '_>, [across, up]: [(f64, f64); 2], bodies: &[Footprint]) -> Drawn {
    let inside =
        |at: &(f64, f64)| (across.0..=across.1).contains(&at.0) && (up.0..=up.1).contains(&at.1);
    for body in bodies.iter().filter(|b| b.kind == FootprintKind::Reach) {
        for ends in body.outline.chunks_exact(2) {
            let ends = [ends[0], ends[1]].map(|at| (1e3 * at.x, 1e3 * at.y));
            if ends.iter().all(inside) {
                let style = DARK.stroke_width(2 * PX as u32);
                chart.draw_series([PathElement::new(ends, style)])?;
            }
        }
    }
    Ok(())
}

/// What of an outline [m] is seen within a frame, both in millimetres then (I. E. Sutherland and G. W. Hodgman, Communications of the ACM 17, 1974).
fn clipped(outline: &[DVec2], [across, up]: [(f64, f64); 2]) -> Vec<DVec2> {
    let sides = [
        (DVec2::X, across.0),
        (-DVec2::X, -across.1),
        (DVec2::Y, up.0),
        (-DVec2::Y, -up.1),
    ];
    let mut seen: Vec<DVec2> = outline.iter().map(|corner| 1e3 * *corner).collect();
    for (inward, from) in sides {
        let beyond = |at: DVec2| inward.dot(at) - from;
        let mut kept = Vec::new();
        for (index, &corner) in seen.iter().enumerate() {
            let before = seen[(index + seen.len() - 1) % seen.len()];
            let (last, own) = (beyond(before), beyond(corner));
            if (last < 0.0) != (own < 0.0) {
                kept.push(before.lerp(corner, last / (last - own)));
            }
            if own >= 0.0 {
                kept.push(corner);
            }
        }
        seen = kept;
    }
    seen
}

/// Ranges widened so that the robot is seen, and of the obstacles those that stand about it and the tried positions.
fn with_room(
    across: (f64, f64),
    up: (f64, f64),
    surroundings: &Surroundings<'_>,
) -> ((f64, f64), (f64, f64)) {
    let own = |kinds: &[FootprintKind]| -> Vec<DVec2> {
        let bodies = surroundings
            .bodies
            .iter()
            .filter(|body| kinds.contains(&body.kind));
        bodies
            .flat_map(|body| &body.outline)
            .map(|at| 1e3 * *at)
            .collect()
    };
    let mut seen = [across, up];
    widen(&mut seen, &[1e3 * surroundings.robot.truncate()]);
    widen(&mut seen, &own(&[FootprintKind::Base, FootprintKind::Link]));
    let about = seen;
    // Beyond as much again only their near part is seen.
    let near = about.map(|(low, high)| (low - 0.5 * (high - low), high + 0.5 * (high - low)));
    for body in surroundings
        .bodies
        .iter()
        .filter(|b| b.kind == FootprintKind::Obstacle)
    {
        widen(&mut seen, &clipped(&body.outline, near));
    }
    (seen[0], seen[1])
}

/// Widens ranges [mm] to points, with some room about these.
fn widen(ranges: &mut [(f64, f64); 2], points: &[DVec2]) {
    const ROOM: f64 = 30.0;
    for at in points {
        for (range, value) in ranges.iter_mut().zip([at.x, at.y]) {
            *range = (range.0.min(value - ROOM), range.1.max(value + ROOM));
        }
    }
}

/// The end of the colours: the largest comfort, at least 1.
fn most_comfort(tried: &[TriedPlace]) -> f64 {
    let comforts = tried.iter().filter_map(|place| place.outcome.ok());
    comforts
        .map(|possible| possible.comfort)
        .fold(1.0, f64::max)
}

/// Ranges widened so that a millimetre is as long across as it is up.
fn of_equal_scale(across: (f64, f64), up: (f64, f64)) -> ((f64, f64), (f64, f64)) {
    let room = [
        f64::from(WIDTH - RIGHT - 82 * PX),
        f64::from(HEIGHT - 120 * PX),
    ];
    let scale = ((across.1 - across.0) / room[0]).max((up.1 - up.0) / room[1]);
    let widened = |(low, high): (f64, f64), room: f64| {
        let middle = 0.5 * (low + high);
        (middle - 0.5 * scale * room, middle + 0.5 * scale * room)
    };
    (widened(across, room[0]), widened(up, room[1]))
}

/// Colour of a share of the largest comfort.
fn shade(comfort: f64) -> RGBColor {
    let steps = COMFORT.len() - 1;
    let along = comfort.clamp(0.0, 1.0) * steps as f64;
    let index = (along as usize).min(steps - 1);
    let share = along - index as f64;
    let [from, to] = [COMFORT[index], COMFORT[index + 1]];
    let mixed = |a: u8, b: u8| (f64::from(a) + share * (f64::from(b) - f64::from(a))).round() as u8;
    RGBColor(
        mixed(from.0, to.0),
        mixed(from.1, to.1),
        mixed(from.2, to.2),
    )
}

/// Tint of what is in the way: pale, so that it is not taken for a comfort.
fn tint(hindrance: Hindrance) -> RGBColor {
    match hindrance {
        Hindrance::Reach => RGBColor(0xEE, 0xEE, 0xEE),
        Hindrance::Singularity => RGBColor(0xD2, 0xD2, 0xD2),
        Hindrance::Collision => RGBColor(0xF4, 0xB8, 0xA8),
        Hindrance::Torque => RGBColor(0xE3, 0xC0, 0xE0),
        Hindrance::Speed => RGBColor(0xF3, 0xD9, 0xB1),
        Hindrance::Edge => RGBColor(0xB0, 0xB0, 0xB0),
    }
}

/// What the colours say, beside the map; of hindrances those that there are.
fn legend(root: &Area<'_>, tried: &[TriedPlace], bodies: &[Footprint]) -> Drawn {
    const STEPS: i32 = 50;
    let left = WIDTH - RIGHT + 24 * PX;
    let anchor = Pos::new(HPos::Left, VPos::Center);
    let style = (FONT, TEXT).into_font().color(&DARK).pos(anchor);
    let words = |text: String, x: i32, y: i32| root.draw(&Text::new(text, (x, y), style.clone()));
    let mut y = 70 * PX;
    words("comfort".to_owned(), left, y)?;
    y += 18 * PX;
    let height = 4 * PX;
    for step in 0..STEPS {
        let comfort = 1.0 - f64::from(step) / f64::from(STEPS - 1);
        let top = y + step * height;
        let corners = [(left, top), (left + 24 * PX, top + height)];
        root.draw(&Rectangle::new(corners, shade(comfort).filled()))?;
    }
    let bottom = y + STEPS * height;
    let most = most_comfort(tried);
    words(format!("{most:.1}"), left + 32 * PX, y + 6 * PX)?;
    words("0: at a limit".to_owned(), left + 32 * PX, bottom - 6 * PX)?;
    y = bottom + 36 * PX;
    let present =
        |hindrance: &Hindrance| tried.iter().any(|place| place.outcome == Err(*hindrance));
    let present: Vec<_> = Hindrance::ALL.into_iter().filter(present).collect();
    if !present.is_empty() {
        words("not possible for".to_owned(), left, y)?;
    }
    for hindrance in present {
        y += 26 * PX;
        let corners = [(left, y - 8 * PX), (left + 24 * PX, y + 8 * PX)];
        root.draw(&Rectangle::new(corners, tint(hindrance).filled()))?;
        root.draw(&Rectangle::new(corners, GREY.stroke_width(PX as u32)))?;
        words(hindrance.name().to_owned(), left + 32 * PX, y)?;
    }
    for body in bodies.iter().filter(|b| b.kind == FootprintKind::Reach) {
        y += 36 * PX;
        for dash in [0, 9, 18] {
            let ends = [(left + dash * PX, y), (left + (dash + 6) * PX, y)];
            root.draw(&PathElement::new(ends, DARK.stroke_width(2 * PX as u32)))?;
        }
        words(body.name.clone(), left + 32 * PX, y)?;
        words("with the tool, stretched".to_owned(), left, y + 24 * PX)?;
    }
    Ok(())
}

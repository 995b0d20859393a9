//! The screen on which findings open: left the words and below them space and quantities against one another, right the signals.

use ::rerun::AsComponents;
use ::rerun::components::Range1D;
use ::rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, PlotLegend, ScalarAxis, TimeAxis, TimePanelBlueprint, VisualBounds2D,
};
use ::rerun::external::re_sdk_types::blueprint::components::{
    BackgroundKind, Corner2D, LinkAxis, PanelState, PlayState, TimeRange, TimelineName,
};
use ::rerun::external::re_sdk_types::datatypes::{Range2D, TimeRange as Range, TimeRangeBoundary};

use super::cloud::{self, FIELD, ROOM};
use super::sheet::{self, TIME};
use crate::scene::board::{Board, Cloud, Sheet, SheetPlot};
use crate::scene::error_scale::ErrorScale;
use crate::viewer::RerunOptions;
use crate::viewer::blueprint::{Panel, View, ViewKind};
use crate::viewer::cell::CELL;
use crate::viewer::colours::rerun_colour;
use crate::viewer::layout::{cell_view, edge_heading, plain_view};
use crate::viewer::options::SUMMARY;
use crate::viewer::view_box::cell_box;

/// Share of the longest recording that each must last for all to have one time axis.
const ALIKE: f64 = 0.8;
/// Shares of a plot's width and height that its legend takes.
const LEGEND: [f64; 2] = [0.35, 0.45];

/// The panels of the screen.
pub(super) fn screen(board: &Board, options: &RerunOptions) -> Panel {
    let verdict = plain_view(ViewKind::TextDocument, "Verdict", SUMMARY);
    let clouds = board.clouds.iter().enumerate();
    let mut clouds: Vec<Panel> = clouds
        .map(|(index, cloud)| cloud_view(index, cloud))
        .collect();
    let mut left = vec![(1.0, verdict)];
    // What says most stays in front, with a cell below it.
    match clouds.len() {
        0 => {}
        1 => left.push((1.0, clouds.remove(0))),
        _ => left.push((1.0, Panel::tabs(clouds))),
    }
    if let Some(scene) = &board.scene {
        let known = scene.edge_path.relative_force_error.iter();
        let scale = known.clone().any(|e| e.is_finite());
        let scale = scale.then(|| ErrorScale::of(&scene.edge_path));
        let name = match scale {
            Some(_) => format!("{}. {}", scene.title, edge_heading(scale)),
            None => format!("Cell: {}", scene.title),
        };
        left.push((1.0, cell_view(&name, CELL, cell_box(scene), options)));
    }
    let left = Panel::column(left);
    let linked = are_alike(&board.sheets);
    let sheets = board.sheets.iter().enumerate();
    let mut sheets: Vec<Panel> = sheets
        .map(|(index, sheet)| sheet_panel(index, sheet, linked))
        .collect();
    match sheets.len() {
        0 => left,
        1 => Panel::row(vec![(1.0, left), (1.7, sheets.remove(0))]),
        _ => Panel::row(vec![(1.0, left), (1.7, Panel::tabs(sheets))]),
    }
}

/// The time panel: collapsed, on the recordings' time, at rest.
pub(super) fn time_panel() -> TimePanelBlueprint {
    TimePanelBlueprint::new()
        .with_state(PanelState::Collapsed)
        .with_timeline(TimelineName(TIME.into()))
        .with_play_state(PlayState::Paused)
}

/// Whether all recordings last about as long.
fn are_alike(sheets: &[Sheet]) -> bool {
    let lengths = || {
        let ends = |sheet: &Sheet| Some(sheet.time.last()? - sheet.time.first()?);
        sheets.iter().filter_map(ends)
    };
    let longest = lengths().fold(0.0, f64::max);
    lengths().all(|length| length >= ALIKE * longest)
}

fn cloud_view(index: usize, cloud: &Cloud) -> Panel {
    let [left, right, top, bottom] = ROOM;
    let bounds = Range2D {
        x_range: [-left, FIELD[0] + right].into(),
        y_range: [-top, FIELD[1] + bottom].into(),
    };
    let background =
        Background::new(BackgroundKind::SolidColor).with_color(rerun_colour([20, 23, 28, 255]));
    Panel::View(View {
        kind: ViewKind::Spatial2D,
        name: format!("{}: {}", cloud.title, cloud.vertical),
        origin: cloud::entity(index),
        contents: vec!["$origin/**".to_owned()],
        properties: vec![
            ("VisualBounds2D", Box::new(VisualBounds2D::new(bounds))),
            ("Background", Box::new(background)),
        ],
        hidden: vec![],
    })
}

fn sheet_panel(index: usize, sheet: &Sheet, linked: bool) -> Panel {
    let entity = sheet::entity(index);
    let mut rows = Vec::new();
    if !sheet.lanes.is_empty() {
        let lanes = sheet::lanes_entity(&entity);
        let name = "Where the recording differs from the nominal model";
        // Of the height of all plots, whatever their number.
        let share = (0.08 + 0.055 * sheet.lanes.len() as f32) * sheet.rows.len() as f32;
        rows.push((share, plain_view(ViewKind::StateTimeline, name, &lanes)));
    }
    for row in &sheet.rows {
        let plots = row
            .iter()
            .map(|plot| (1.0, plot_view(&entity, sheet, plot, linked)));
        rows.push((1.0, Panel::row(plots.collect())));
    }
    Panel::named(&sheet.title, Panel::column(rows))
}

/// The corner in which fewest samples lie.
fn empty_corner(plot: &SheetPlot) -> Corner2D {
    let values = || plot.lines.iter().flat_map(|line| &line.values);
    let [low, high] = plot.range.unwrap_or_else(|| {
        let fold = |start: f64, of: fn(f64, f64) -> f64| values().copied().fold(start, of);
        [
            fold(f64::INFINITY, f64::min),
            fold(f64::NEG_INFINITY, f64::max),
        ]
    });
    let within = |right: bool, top: bool| {
        let lines = plot.lines.iter().map(|line| {
            let count = line.values.len();
            let part = (LEGEND[0] * count as f64) as usize;
            let side = if right {
                &line.values[count - part..]
            } else {
                &line.values[..part]
            };
            let height = |value: &f64| (value - low) / (high - low);
            let inside = |value: &&f64| match top {
                true => height(value) > 1.0 - LEGEND[1],
                false => height(value) < LEGEND[1],
            };
            side.iter().filter(inside).count()
        });
        lines.sum::<usize>()
    };
    let corners = [
        (Corner2D::RightTop, within(true, true)),
        (Corner2D::RightBottom, within(true, false)),
        (Corner2D::LeftTop, within(false, true)),
        (Corner2D::LeftBottom, within(false, false)),
    ];
    let best = corners.into_iter().min_by_key(|(_, count)| *count);
    best.map_or(Corner2D::RightTop, |(corner, _)| corner)
}

fn plot_view(entity: &str, sheet: &Sheet, plot: &SheetPlot, linked: bool) -> Panel {
    let axis = if linked {
        TimeAxis::new().with_link(LinkAxis::LinkToGlobal)
    } else {
        let nanoseconds = |time: Option<&f64>| {
            let time = time.copied().unwrap_or_default() * 1e9;
            TimeRangeBoundary::Absolute((time.round() as i64).into())
        };
        let start = nanoseconds(sheet.time.first());
        let end = nanoseconds(sheet.time.last());
        TimeAxis::new().with_view_range(TimeRange(Range { start, end }))
    };
    let legend = PlotLegend::new().with_corner(empty_corner(plot));
    let mut properties: Vec<(&'static str, Box<dyn AsComponents>)> = vec![
        ("TimeAxis", Box::new(axis)),
        ("PlotLegend", Box::new(legend)),
    ];
    if let Some(range) = plot.range {
        let range = ScalarAxis::new().with_range(Range1D::from(range));
        properties.push(("ScalarAxis", Box::new(range)));
    }
    Panel::View(View {
        kind: ViewKind::TimeSeries,
        name: plot.title.clone(),
        origin: sheet::plot_entity(entity, plot),
        contents: vec!["$origin/**".to_owned()],
        properties,
        hidden: vec![],
    })
}

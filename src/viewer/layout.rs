//! The screen on which a recording opens.
//!
//! Left the cell, below it a close look at the edge and the table of results; right the phases and
//! the plots, one above the other on one time axis.

use ::rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, EyeControls3D, LineGrid3D, PlotLegend, ScalarAxis, TimeAxis, TimePanelBlueprint,
};
use ::rerun::external::re_sdk_types::blueprint::components::{
    BackgroundKind, Corner2D, LinkAxis, LoopMode, PanelState, PlayState, TimelineName,
};
use ::rerun::{AsComponents, components::Range1D, datatypes};
use glam::DVec3;

use super::blueprint::{Panel, View, ViewKind, write_blueprint};
use super::cell::{CELL, COLLISION};
use super::colours::rerun_colour;
use super::options::{PHASES, RerunOptions, SUMMARY};
use super::plots::Plot;
use super::rrd::{RrdError, RrdWriter};
use super::timelines::SIM_TIME;
use super::view_box::{ViewBox, cell_box};
use crate::recording::Recording;
use crate::recording::schema::PlotGroup;
use crate::scene::Scene;
use crate::scene::error_scale::ErrorScale;

/// Before any recording begins [s].
const BEFORE: f64 = -1.0;
/// Distance of the eye from the cell, in radii of the cell.
const CELL_EYE_RADII: f64 = 1.8;
/// Distance of the eye from the edge: with room for the tool above it.
const EDGE_EYE_RADII: f64 = 3.2;
/// The same of an edge whose burr and chamfer are to be seen.
const WORKED_EYE_RADII: f64 = 2.2;

pub(super) fn write_layout(
    rrd: &mut RrdWriter,
    scene: &Scene,
    plots: &[Plot],
    recording: &Recording,
    options: &RerunOptions,
) -> Result<(), RrdError> {
    let errors = &scene.edge_path.relative_force_error;
    let known = errors.iter().any(|error| error.is_finite());
    let screen = screen(&LayoutInput {
        plots,
        scale: known.then(|| ErrorScale::of(&scene.edge_path)),
        cell: cell_box(scene),
        edge: ViewBox::around(scene.edge_path.points_in_world.iter().copied()),
        is_worked: scene.finished_edge.is_some(),
        eye_direction: options.eye_direction,
        has_phases: !recording.phases().is_empty(),
        has_summary: !options.summary_markdown.is_empty() || scene.finished_edge.is_some(),
    });
    write_blueprint(rrd, &screen, &time_panel(options.opening.moment(recording)))
}

/// Quantities that the layout depends on.
pub(super) struct LayoutInput<'a> {
    pub(super) plots: &'a [Plot],
    /// Box of the cell's bodies.
    pub(super) cell: Option<ViewBox>,
    /// Whether a burr and a chamfer are drawn on it.
    pub(super) is_worked: bool,
    /// Box of the edge path.
    pub(super) edge: Option<ViewBox>,
    /// Colours of the edge path; none while its force errors are not known.
    pub(super) scale: Option<ErrorScale>,
    /// From the middle of what is shown towards the eye.
    pub(super) eye_direction: DVec3,
    pub(super) has_phases: bool,
    pub(super) has_summary: bool,
}

/// The panels of the screen.
pub(super) fn screen(input: &LayoutInput) -> Panel {
    let mut signals = Vec::new();
    if input.has_phases {
        signals.push((0.55, plain_view(ViewKind::StateTimeline, "Phases", PHASES)));
    }
    let shares = [
        (PlotGroup::Force, 1.7),
        (PlotGroup::Stroke, 1.0),
        (PlotGroup::Pressure, 1.1),
        (PlotGroup::PathError, 1.0),
    ];
    for (group, share) in shares {
        let plot = input.plots.iter().find(|plot| plot.group == group);
        signals.extend(plot.map(|plot| (share, plot_view(plot))));
    }
    let (cell, edge) = spatial_views(input);
    let mut space = vec![(1.6, cell)];
    let mut details = Vec::new();
    details.extend(edge.map(|edge| (1.0, edge)));
    let mut tabs = Vec::new();
    if input.has_summary {
        tabs.push(plain_view(ViewKind::TextDocument, "Summary", SUMMARY));
    }
    for group in [PlotGroup::JointTorque, PlotGroup::ForceBalance] {
        let plot = input.plots.iter().find(|plot| plot.group == group);
        tabs.extend(plot.map(plot_view));
    }
    if !tabs.is_empty() {
        details.push((1.0, Panel::tabs(tabs)));
    }
    if !details.is_empty() {
        space.push((1.0, Panel::row(details)));
    }
    let space = Panel::column(space);
    if signals.is_empty() {
        space
    } else {
        Panel::row(vec![(1.15, space), (1.0, Panel::column(signals))])
    }
}

/// The time panel: collapsed, on simulated time, at a moment [s] or at the start.
///
/// A blueprint of Rerun 0.36 has no place for the time cursor. But a viewer that plays a loop goes to its start as soon as it is past its end, and this
/// loop ends before the recording begins: it stands at the moment from its first picture on, until it is paused, moved, or set not to loop.
pub(super) fn time_panel(moment: Option<f64>) -> TimePanelBlueprint {
    let panel = TimePanelBlueprint::new()
        .with_state(PanelState::Collapsed)
        .with_timeline(TimelineName(SIM_TIME.into()));
    let time = |seconds: f64| datatypes::TimeInt((seconds * 1e9).round() as i64);
    match moment {
        None => panel.with_play_state(PlayState::Paused),
        Some(moment) => panel
            .with_play_state(PlayState::Playing)
            .with_loop_mode(LoopMode::Selection)
            .with_time_selection(datatypes::AbsoluteTimeRange {
                min: time(moment),
                max: time(BEFORE),
            }),
    }
}

/// A view of all below an entity, as the viewer shows it of itself.
pub(super) fn plain_view(kind: ViewKind, name: &str, origin: &str) -> Panel {
    Panel::View(View {
        kind,
        name: name.to_owned(),
        origin: origin.to_owned(),
        contents: vec!["$origin/**".to_owned()],
        properties: vec![],
        hidden: vec![],
    })
}

fn plot_view(plot: &Plot) -> Panel {
    let link = TimeAxis::new().with_link(LinkAxis::LinkToGlobal);
    // The force ends at zero and the others' lines seldom run along the top.
    let corner = match plot.group {
        PlotGroup::Force => Corner2D::RightBottom,
        _ => Corner2D::RightTop,
    };
    let legend = PlotLegend::new().with_corner(corner);
    let mut properties: Vec<(&'static str, Box<dyn AsComponents>)> = vec![
        ("TimeAxis", Box::new(link)),
        ("PlotLegend", Box::new(legend)),
    ];
    if let Some(range) = plot.range {
        let axis = ScalarAxis::new().with_range(Range1D::from(range));
        properties.push(("ScalarAxis", Box::new(axis)));
    }
    Panel::View(View {
        kind: ViewKind::TimeSeries,
        name: plot.title.to_owned(),
        origin: plot.entity.to_owned(),
        contents: vec!["$origin/**".to_owned()],
        properties,
        hidden: vec![],
    })
}

/// Heading of the view of an edge that is worked.
const WORKED_HEADING: &str = "Burr bronze; chamfer green, blue −, orange +";

/// Heading of the edge's view: how to read the colours of the path.
pub(super) fn edge_heading(scale: Option<ErrorScale>) -> String {
    match scale.map(ErrorScale::percent) {
        Some(end) => format!("Force error: blue −{end} %, white 0, orange +{end} %"),
        None => "Edge".to_owned(),
    }
}

/// The whole cell and, if there is one, the edge from nearby.
fn spatial_views(input: &LayoutInput) -> (Panel, Option<Panel>) {
    let eye_on = |framed: &ViewBox, radii| {
        let eye = framed.eye(input.eye_direction, radii);
        (eye, framed.centre())
    };
    let eye_on_cell = input.cell.map(|cell| eye_on(&cell, CELL_EYE_RADII));
    let edge = input.edge.map(|edge| {
        let (radii, heading) = match input.is_worked {
            true => (WORKED_EYE_RADII, WORKED_HEADING.to_owned()),
            false => (EDGE_EYE_RADII, edge_heading(input.scale)),
        };
        spatial_view(&heading, Some(eye_on(&edge, radii)), 0.05)
    });
    (spatial_view("Cell", eye_on_cell, 0.25), edge)
}

/// A view of what fills a box, below an entity.
pub(super) fn cell_view(
    name: &str,
    origin: &str,
    framed: Option<ViewBox>,
    options: &RerunOptions,
) -> Panel {
    let eye = framed.map(|framed| {
        let eye = framed.eye(options.eye_direction, CELL_EYE_RADII);
        (eye, framed.centre())
    });
    let mut panel = spatial_view(name, eye, 0.25);
    if let Panel::View(view) = &mut panel {
        origin.clone_into(&mut view.origin);
    }
    panel
}

/// A view of the cell, seen from a place towards a target [m].
fn spatial_view(name: &str, eye_and_target: Option<(DVec3, DVec3)>, grid_spacing: f32) -> Panel {
    let background =
        Background::new(BackgroundKind::SolidColor).with_color(rerun_colour([28, 32, 38, 255]));
    let grid = LineGrid3D::new()
        .with_spacing(grid_spacing)
        .with_color(rerun_colour([120, 130, 140, 40]));
    let mut properties: Vec<(&'static str, Box<dyn AsComponents>)> = vec![
        ("Background", Box::new(background)),
        ("LineGrid3D", Box::new(grid)),
    ];
    if let Some((eye, target)) = eye_and_target {
        let eye = EyeControls3D::new()
            .with_position(eye.as_vec3().to_array())
            .with_look_target(target.as_vec3().to_array())
            .with_eye_up([0.0, 0.0, 1.0]);
        properties.push(("EyeControls3D", Box::new(eye)));
    }
    Panel::View(View {
        kind: ViewKind::Spatial3D,
        name: name.to_owned(),
        origin: CELL.to_owned(),
        contents: vec!["$origin/**".to_owned()],
        properties,
        hidden: vec![COLLISION],
    })
}

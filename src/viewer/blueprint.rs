//! Blueprints (the viewer's screen layouts) as a tree of panels.
//!
//! Rerun's Rust blueprint API can neither place the eye of a 3D view nor set the axes of a plot,
//! and gives every panel a random id. This writes the same archetypes by hand, with ids counted
//! from one.

use ::rerun::external::re_sdk_types::blueprint::archetypes::{
    ContainerBlueprint, EntityBehavior, PanelBlueprint, TimeAxis, TimePanelBlueprint,
    ViewBlueprint, ViewContents, ViewportBlueprint,
};
use ::rerun::external::re_sdk_types::blueprint::components::{
    ColumnShare, ContainerKind, IncludedContent, PanelState, QueryExpression, RootContainer,
    RowShare, TimeRange, ViewClass,
};
use ::rerun::log::TimeColumn;
use ::rerun::{AsComponents, components::Name, datatypes};

use super::rrd::{RrdError, RrdWriter};

/// The viewer's id for settings that views share.
const GLOBAL_VIEW: u128 = 0x5c0d_ca6a_e63f_9cf7_f657_2602_5904_74cc;

/// A view's class, as the viewer calls it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ViewKind {
    Spatial2D,
    Spatial3D,
    TimeSeries,
    StateTimeline,
    TextDocument,
}

impl ViewKind {
    const fn class(self) -> &'static str {
        match self {
            Self::Spatial2D => "2D",
            Self::Spatial3D => "3D",
            Self::TimeSeries => "TimeSeries",
            Self::StateTimeline => "StateTimeline",
            Self::TextDocument => "TextDocument",
        }
    }
}

/// A panel that shows entities.
pub(super) struct View {
    pub(super) kind: ViewKind,
    /// Heading.
    pub(super) name: String,
    /// Entity at whose place the view looks.
    pub(super) origin: String,
    /// Queries for the entities shown, such as `$origin/**`.
    pub(super) contents: Vec<String>,
    /// Settings of the view, each under its archetype's short name.
    pub(super) properties: Vec<(&'static str, Box<dyn AsComponents>)>,
    /// Entities that are not seen, nor what is below them, until they are asked for in the panel of the blueprint.
    pub(super) hidden: Vec<&'static str>,
}

/// A view, or panels that share a part of the screen.
pub(super) enum Panel {
    View(View),
    /// Panels side by side, on top of one another or behind tabs, with their shares of the space.
    Split(ContainerKind, Vec<(f32, Panel)>),
    /// Panels under a name of their own, as a tab shows it.
    Named(String, Box<Panel>),
}

impl Panel {
    /// Panels from left to right.
    pub(super) fn row(parts: Vec<(f32, Self)>) -> Self {
        Self::Split(ContainerKind::Horizontal, parts)
    }

    /// Panels from top to bottom.
    pub(super) fn column(parts: Vec<(f32, Self)>) -> Self {
        Self::Split(ContainerKind::Vertical, parts)
    }

    /// Panels under a name.
    pub(super) fn named(name: &str, panel: Self) -> Self {
        Self::Named(name.to_owned(), Box::new(panel))
    }

    /// Panels behind tabs, the first in front.
    pub(super) fn tabs(panels: Vec<Self>) -> Self {
        let parts = panels.into_iter().map(|panel| (1.0, panel)).collect();
        Self::Split(ContainerKind::Tabs, parts)
    }
}

/// Writes a layout: the panels, the side panels closed, the time panel as given.
pub(super) fn write_blueprint(
    rrd: &mut RrdWriter,
    root: &Panel,
    time_panel: &TimePanelBlueprint,
) -> Result<(), RrdError> {
    let mut writer = BlueprintWriter { rrd, ids: 0 };
    let (root, _) = writer.panel(root)?;
    let viewport = ViewportBlueprint::new()
        .with_root_container(RootContainer(datatypes::Uuid {
            bytes: root.to_be_bytes(),
        }))
        .with_auto_layout(false)
        .with_auto_views(false);
    writer.add("viewport", &viewport)?;
    let closed = PanelBlueprint::new().with_state(PanelState::Collapsed);
    writer.add("blueprint_panel", &closed)?;
    writer.add("selection_panel", &closed)?;
    writer.add("time_panel", time_panel)?;
    // Plots whose axes are linked share this one. Left to itself the viewer shows no more than a
    // minute or 2000 steps of it.
    let whole_run = TimeAxis::new().with_view_range(TimeRange(datatypes::TimeRange::EVERYTHING));
    writer.add(&format!("view/{}/TimeAxis", uuid(GLOBAL_VIEW)), &whole_run)?;
    rrd.activate()
}

struct BlueprintWriter<'a> {
    rrd: &'a mut RrdWriter,
    ids: u128,
}

impl BlueprintWriter<'_> {
    fn add(&mut self, entity: &str, components: &dyn AsComponents) -> Result<(), RrdError> {
        // The viewer looks for blueprints on a timeline of this name.
        let time = TimeColumn::new_sequence("blueprint", [0]);
        self.rrd.add_row(entity, vec![time], components)
    }

    /// Writes a panel with what is in it; gives its id and entity.
    fn panel(&mut self, panel: &Panel) -> Result<(u128, String), RrdError> {
        if let Panel::Named(name, panel) = panel {
            let (id, entity) = self.panel(panel)?;
            let name = Name(name.clone().into());
            let named = match panel.as_ref() {
                Panel::View(_) => None,
                _ => Some(ContainerBlueprint::update_fields().with_display_name(name)),
            };
            if let Some(named) = named {
                self.add(&entity, &named)?;
            }
            return Ok((id, entity));
        }
        self.ids += 1;
        let id = self.ids;
        let entity = match panel {
            Panel::Named(..) => unreachable!("named panels are written above"),
            Panel::View(view) => {
                let entity = format!("view/{}", uuid(id));
                self.view(&entity, view)?;
                entity
            }
            Panel::Split(kind, parts) => {
                let entity = format!("container/{}", uuid(id));
                self.split(&entity, *kind, parts)?;
                entity
            }
        };
        Ok((id, entity))
    }

    fn split(
        &mut self,
        entity: &str,
        kind: ContainerKind,
        parts: &[(f32, Panel)],
    ) -> Result<(), RrdError> {
        let mut contents = Vec::new();
        for (_, panel) in parts {
            let (_, child) = self.panel(panel)?;
            contents.push(IncludedContent(child.into()));
        }
        let shares = parts.iter().map(|(share, _)| *share);
        let container = ContainerBlueprint::new(kind).with_contents(contents);
        let container = match kind {
            ContainerKind::Horizontal => {
                container.with_col_shares(shares.map(|share| ColumnShare(share.into())))
            }
            ContainerKind::Vertical => {
                container.with_row_shares(shares.map(|share| RowShare(share.into())))
            }
            ContainerKind::Tabs | ContainerKind::Grid => container,
        };
        self.add(entity, &container)
    }

    fn view(&mut self, entity: &str, view: &View) -> Result<(), RrdError> {
        let queries = view.contents.iter();
        let queries = queries.map(|query| QueryExpression(query.clone().into()));
        self.add(
            &format!("{entity}/ViewContents"),
            &ViewContents::new(queries),
        )?;
        let head = ViewBlueprint::new(ViewClass(view.kind.class().into()))
            .with_display_name(Name(view.name.clone().into()))
            .with_space_origin(view.origin.clone());
        self.add(entity, &head)?;
        for (property, settings) in &view.properties {
            self.add(&format!("{entity}/{property}"), settings.as_ref())?;
        }
        for hidden in &view.hidden {
            let place = format!("{entity}/ViewContents/overrides{hidden}/visualizers");
            self.add(&place, &EntityBehavior::new().with_visible(false))?;
        }
        Ok(())
    }
}

/// An id in the form in which the viewer expects it.
fn uuid(id: u128) -> String {
    let hex = format!("{id:032x}");
    let (a, b, c, d, e) = (
        &hex[..8],
        &hex[8..12],
        &hex[12..16],
        &hex[16..20],
        &hex[20..],
    );
    format!("{a}-{b}-{c}-{d}-{e}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_have_the_form_of_a_uuid() {
        assert_eq!(uuid(1), "00000000-0000-0000-0000-000000000001");
        assert_eq!(
            uuid(0x0123_4567_89ab_cdef_0123_4567_89ab_cdef),
            "01234567-89ab-cdef-0123-456789abcdef"
        );
    }
}

//! A figure as plain data.

use std::borrow::Cow;

/// A picture of one or more panels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Figure<'a> {
    /// Stands above everything; may be empty.
    pub title: String,
    /// From top to bottom.
    pub panels: Vec<Panel<'a>>,
}

/// One pair of axes with what is drawn in it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel<'a> {
    /// Short name, left of the legend; may be empty.
    pub title: String,
    /// Name and unit of the vertical axis: `force [N]`.
    pub vertical_label: String,
    /// The horizontal axis.
    pub horizontal: Horizontal,
    /// The signals; later ones lie on top.
    pub series: Vec<Series<'a>>,
    /// Horizontal bands behind the signals.
    pub bands: Vec<Band>,
    /// Vertical event lines.
    pub markers: Vec<Marker>,
    /// Parts of the horizontal axis that are shaded; they may reach beyond it.
    pub spans: Vec<[f64; 2]>,
    /// Panels of one name are zoomed together; may be empty.
    pub group: String,
    /// Ends of the vertical axis, where what lies beyond would press the rest flat.
    pub within: Option<[f64; 2]>,
}

/// The horizontal axis of a panel.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Horizontal {
    /// Time [s], shared by all such panels of a figure and labelled below the last in a row.
    #[default]
    Time,
    /// Another quantity, with its name and unit: `set pressure [bar]`.
    Quantity(String),
}

/// One signal, or one cloud of points.
#[derive(Debug, Clone, PartialEq)]
pub struct Series<'a> {
    /// Text in the legend; without it the series is not in the legend.
    pub label: String,
    /// Time [s], increasing; in a panel over another quantity that quantity, in any order.
    pub horizontal: Cow<'a, [f64]>,
    /// One value each; NaN splits the line wherever the gap is a pixel wide or more.
    pub values: Cow<'a, [f64]>,
    /// Decides the colour.
    pub role: Role,
    /// Its stroke.
    pub stroke: Stroke,
    /// Whether each value holds until the next one, instead of a straight line between them.
    pub stepwise: bool,
}

/// Role of a signal; each role has its colour in every figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Commanded or desired value: black.
    Command,
    /// Regulator outlet: blue.
    Regulator,
    /// Chamber 1, which extends the slide: vermilion.
    Chamber1,
    /// Chamber 2, which retracts it: green.
    Chamber2,
    /// Sensor as read: sky blue.
    Measured,
    /// Sensor after its filter: blue.
    Filtered,
    /// True force: vermilion.
    Force,
    /// Stroke: green.
    Stroke,
    /// Estimated or fitted value: purple.
    Estimate,
    /// Limits and tolerance: orange.
    Band,
}

/// Stroke of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// A line.
    Plain,
    /// A dashed line, for commands.
    Dashed,
    /// A thin translucent line, for noisy signals.
    Raw,
    /// A thick line, for the truth.
    Truth,
    /// Dots without a line.
    Points,
    /// Large dots, for the few that others are compared with.
    Mark,
    /// The area that the line encloses, filled: of a band whose edges are curves, one edge there and the other back.
    Area,
}

/// A horizontal band, such as a tolerance.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Text in the legend; may be empty.
    pub label: String,
    /// Lower edge.
    pub from: f64,
    /// Upper edge.
    pub to: f64,
}

/// A vertical line at an event.
#[derive(Debug, Clone, PartialEq)]
pub struct Marker {
    /// Text above the panel: `valve: retract`; may be empty where the panel above has it.
    pub label: String,
    /// Where, on the horizontal axis.
    pub at: f64,
}

impl<'a> Series<'a> {
    /// Straight from sample to sample.
    pub fn new(
        label: impl Into<String>,
        horizontal: impl Into<Cow<'a, [f64]>>,
        values: impl Into<Cow<'a, [f64]>>,
        role: Role,
        stroke: Stroke,
    ) -> Self {
        Self {
            label: label.into(),
            horizontal: horizontal.into(),
            values: values.into(),
            role,
            stroke,
            stepwise: false,
        }
    }

    /// The same, each value held until the next.
    #[must_use]
    pub fn stepwise(mut self) -> Self {
        self.stepwise = true;
        self
    }
}

//! A screen of findings: recordings beside models, what is left of them, where it is left, against what, and the words that go with it.
//!
//! Plain data in the units in which it is read; whoever diagnoses fills it in, and [`crate::viewer`] draws it.

use super::Scene;

/// A screen.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Board {
    /// Its name.
    pub title: String,
    /// Its conclusion, in Markdown.
    pub text: String,
    /// Quantities against one another.
    pub clouds: Vec<Cloud>,
    /// Signals against time, a sheet for each recording.
    pub sheets: Vec<Sheet>,
    /// Its look in space.
    pub scene: Option<Scene>,
}

/// Role of a line or a cloud; each has its colour in every picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoardRole {
    /// As a sensor read it.
    Measured,
    /// By the nominal model.
    Nominal,
    /// By the improved model.
    Improved,
    /// A band, or a limit.
    Guide,
}

/// Signals of one recording.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sheet {
    /// Its name.
    pub title: String,
    /// Times [s].
    pub time: Vec<f64>,
    /// States over time.
    pub lanes: Vec<Lane>,
    /// Plots, those of a row side by side.
    pub rows: Vec<Vec<SheetPlot>>,
}

/// Lines over one another.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SheetPlot {
    /// Heading, unit included.
    pub title: String,
    /// Lines, at the sheet's times.
    pub lines: Vec<BoardLine>,
    /// Horizontal lines, with a label.
    pub guides: Vec<(String, f64)>,
    /// Range of the vertical axis; `None` fits the data.
    pub range: Option<[f64; 2]>,
}

/// A line.
#[derive(Debug, Clone, PartialEq)]
pub struct BoardLine {
    /// Its name in the legend, unit included.
    pub label: String,
    /// Its role.
    pub role: BoardRole,
    /// Its values; NaN where there is none.
    pub values: Vec<f64>,
}

/// States of one thing over time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Lane {
    /// Its subject.
    pub name: String,
    /// Start, end [s] and state, in order and without overlap.
    pub spans: Vec<(f64, f64, String)>,
}

/// Quantities against a variable.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cloud {
    /// Heading.
    pub title: String,
    /// The variable, unit included.
    pub horizontal: String,
    /// The quantity, unit included.
    pub vertical: String,
    /// The drawn groups, the last on top.
    pub groups: Vec<CloudGroup>,
}

/// Points, or a line through them.
#[derive(Debug, Clone, PartialEq)]
pub struct CloudGroup {
    /// Its name.
    pub label: String,
    /// Its role.
    pub role: BoardRole,
    /// Variable and quantity.
    pub points: Vec<[f64; 2]>,
    /// Whether they are joined by a line.
    pub joined: bool,
}

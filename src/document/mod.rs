//! Pages for a browser: one HTML file with everything in it, for people who have nothing else installed.
//!
//! A [`Document`] is plain data. Its charts are drawn in the browser by uPlot (`assets/page/uplot/`) and what is seen in space by three.js
//! (`assets/page/three/`), which stand in the file; the page may ask for nothing over a network, and says so to the browser (Content-Security-Policy).
//! The same page gives the same bytes.

mod drawing;
mod html;
mod packed;
mod panel;
mod thin;

pub use drawing::{Drawing, DrawnArrow, DrawnBody, DrawnLegend, DrawnLine, DrawnView, Shade};
pub use html::html;
pub use panel::{Band, Figure, Horizontal, Marker, Panel, Role, Series, Stroke};
pub use thin::kept;

/// A page.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Document<'a> {
    /// Its subject: `Diagnosis of case-14`.
    pub title: String,
    /// Its conclusion, in a sentence.
    pub verdict: String,
    /// Tone of that.
    pub tone: Tone,
    /// Below the verdict, a paragraph each.
    pub lead: Vec<String>,
    /// Key numbers.
    pub facts: Vec<Fact>,
    /// Its parts.
    pub sections: Vec<Section<'a>>,
    /// Last line.
    pub footer: String,
}

/// Tone of a verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Tone {
    /// Said, not judged.
    #[default]
    Plain,
    /// All is as it should be.
    Good,
    /// Something was found.
    Found,
    /// A question is left.
    Open,
    /// Something is not as it should be.
    Bad,
}

/// A key number.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fact {
    /// Its name.
    pub name: String,
    /// Value and unit.
    pub value: String,
    /// Its remark; may be empty.
    pub remark: String,
}

/// A part of a page.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section<'a> {
    /// Heading, and name in the list of contents.
    pub title: String,
    /// Its blocks.
    pub blocks: Vec<Block<'a>>,
}

/// Something in a section.
#[derive(Debug, Clone, PartialEq)]
pub enum Block<'a> {
    /// A heading within the section.
    Heading(String),
    /// A paragraph.
    Paragraph(String),
    /// A paragraph that helps to read what follows.
    Hint(String),
    /// Rows and columns.
    Table(Table),
    /// A chart.
    Panel(Panel<'a>),
    /// Times in which something is so, over a span that all rows share.
    Strip(Strip),
    /// Lines as they are.
    Lines(String),
    /// A picture, an SVG document of our own.
    Picture(String),
    /// Pictures of our own side by side as far as there is room: what each shows, and an SVG document in the page's colours.
    Sketches(Vec<(String, String)>),
    /// Bodies and lines in space, which a reader can turn; on paper, and where a browser does not draw in space, pictures as above.
    InSpace(&'a Drawing, Vec<(String, String)>),
    /// A file beside the page: its name, and what it holds.
    File(String, String),
    /// A part that is folded away until it is asked for: a summary and blocks.
    Folded(String, Vec<Block<'a>>),
}

/// Rows and columns.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// Its caption; may be empty.
    pub caption: String,
    /// Names of the columns, and whether they hold numbers.
    pub columns: Vec<(String, bool)>,
    /// As many cells a row as there are columns.
    pub rows: Vec<Vec<Cell>>,
}

/// A cell of a table.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Words or a number.
    Text(String),
    /// Words that are good news, or bad news.
    Judged(String, bool),
    /// Hexadecimal digits.
    Hash(String),
    /// An interval with the value in it, drawn between what all of them span: `[least, low, value, high, most]`.
    Interval([f64; 5]),
}

/// Times in which something is so.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Strip {
    /// First and last time [s].
    pub span: [f64; 2],
    /// A name each, and its times [s].
    pub rows: Vec<(String, Vec<[f64; 2]>)>,
}

impl<'a> Section<'a> {
    /// A section with blocks.
    pub fn new(title: &str, blocks: Vec<Block<'a>>) -> Self {
        Self {
            title: title.to_owned(),
            blocks,
        }
    }
}

impl Table {
    /// A table; columns that begin with `#` hold numbers.
    #[must_use]
    pub fn new(caption: &str, columns: &[&str], rows: Vec<Vec<Cell>>) -> Self {
        let column = |name: &&str| match name.strip_prefix('#') {
            Some(name) => (name.to_owned(), true),
            None => ((*name).to_owned(), false),
        };
        Self {
            caption: caption.to_owned(),
            columns: columns.iter().map(column).collect(),
            rows,
        }
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

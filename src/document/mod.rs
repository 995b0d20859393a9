//! Results for people: one typed document, made once from a result, and its renderers, which know nothing of the subject.
//!
//! A [`Document`] is plain data: a verdict, key numbers, sections of [`Block`]s. [`text`] writes it for a terminal or a file, [`markdown`] for the viewer and
//! for repositories, [`html`] as one file for a browser, in which uPlot (`assets/page/uplot/`) draws the panels and three.js (`assets/page/three/`) what is seen
//! in space; the page may ask for nothing over a network and run no script but these, and says so to the browser (Content-Security-Policy). A renderer that cannot draw a block names the
//! file that shows it. The same document gives the same bytes.

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};

mod drawing;
mod html;
mod markdown;
mod number;
mod packed;
mod panel;
mod printable;
mod text;
mod thin;

pub use drawing::{Drawing, DrawnArrow, DrawnBody, DrawnLegend, DrawnLine, DrawnView, Shade};
pub use html::html;
pub use markdown::{markdown, markdown_below};
pub use number::Number;
pub use panel::{Band, Figure, Horizontal, Marker, Panel, Role, Series, Stroke};
pub use printable::{printable, printable_lines, printable_styled};
pub use text::{Style, WIDTH, text, wrapped};
pub use thin::kept;

/// Letters that are encoded in an address: all but those that mean nothing there.
const LEFT_OUT: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'_')
    .remove(b'.')
    .remove(b'~')
    .remove(b'/');

/// A result for people.
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
    /// Last line of a page.
    pub footer: String,
    /// Name of the file that has it as a page; empty for `report.html`.
    pub file: String,
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
    /// Its value.
    pub value: Cell,
    /// Its remark; may be empty.
    pub remark: String,
}

/// A part of a document.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section<'a> {
    /// Heading, and name in the list of contents.
    pub title: String,
    /// Its blocks.
    pub blocks: Vec<Block<'a>>,
    /// Whether only a page shows it; elsewhere it is named.
    pub is_appendix: bool,
}

/// Something in a section.
#[derive(Debug, Clone, PartialEq)]
pub enum Block<'a> {
    /// A heading within the section.
    Heading(String),
    /// A paragraph.
    Paragraph(String),
    /// A paragraph that helps to read what a page shows.
    Hint(String),
    /// Rows and columns.
    Table(Table),
    /// A chart.
    Panel(Panel<'a>),
    /// Times in which something is so, over a span that all rows share.
    Strip(Strip),
    /// Lines as they are.
    Lines(String),
    /// Pictures side by side as far as there is room: what each shows, and an SVG document, which may be another's: a page shows it as an image, in which
    /// nothing runs.
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
    /// Its columns.
    pub columns: Vec<Column>,
    /// As many cells a row as there are columns.
    pub rows: Vec<Vec<Cell>>,
    /// Whether a reader may sort its rows by a column.
    pub is_sortable: bool,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Column {
    /// Its heading.
    pub name: String,
    /// Whether it holds numbers.
    pub is_numeric: bool,
}

/// A cell of a table.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number.
    Number(Number),
    /// Words that are good news, or bad news.
    Verdict(String, bool),
    /// Hexadecimal digits.
    Hash(String),
    /// Words, and where they lead.
    Link(String, String),
    /// An interval with the value in it, drawn between what all of them span: `[least, low, value, high, most]`.
    Interval([f64; 5]),
}

/// Times in which something is so.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Strip {
    /// What it is of.
    pub title: String,
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
            is_appendix: false,
        }
    }

    /// The same for a page alone.
    #[must_use]
    pub fn appendix(mut self) -> Self {
        self.is_appendix = true;
        self
    }
}

impl Table {
    /// A table.
    #[must_use]
    pub fn new(caption: &str, columns: Vec<Column>, rows: Vec<Vec<Cell>>) -> Self {
        Self {
            caption: caption.to_owned(),
            columns,
            rows,
            is_sortable: false,
        }
    }

    /// The same with rows that a reader may sort.
    #[must_use]
    pub fn sortable(mut self) -> Self {
        self.is_sortable = true;
        self
    }
}

impl Column {
    /// Several by their names: `case | #seconds | effects`, those of numbers with a `#`.
    #[must_use]
    pub fn list(names: &str) -> Vec<Self> {
        let column = |name: &str| match name.trim().strip_prefix('#') {
            Some(name) => Self::of_numbers(name),
            None => Self::of_words(name.trim()),
        };
        names.split('|').map(column).collect()
    }

    /// One of words.
    pub fn of_words(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            is_numeric: false,
        }
    }

    /// One of numbers.
    pub fn of_numbers(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            is_numeric: true,
        }
    }
}

impl Fact {
    /// A key number.
    pub fn new(name: impl Into<String>, value: impl Into<Cell>, remark: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            value: value.into(),
            remark: remark.into(),
        }
    }
}

impl Cell {
    /// What it says, without marks; an interval says nothing.
    #[must_use]
    pub fn words(&self) -> String {
        match self {
            Self::Text(words)
            | Self::Verdict(words, _)
            | Self::Hash(words)
            | Self::Link(words, _) => words.clone(),
            Self::Number(number) => number.with_unit(),
            Self::Interval(_) => String::new(),
        }
    }
}

impl Default for Cell {
    fn default() -> Self {
        Self::Text(String::new())
    }
}

impl From<&str> for Cell {
    fn from(words: &str) -> Self {
        Self::Text(words.to_owned())
    }
}

impl From<String> for Cell {
    fn from(words: String) -> Self {
        Self::Text(words)
    }
}

impl From<Number> for Cell {
    fn from(number: Number) -> Self {
        Self::Number(number)
    }
}

/// A target as an address: of a place on the page after `#`, otherwise of a file. Neither a scheme (`javascript:`) nor a host can be in it.
fn address(target: &str) -> String {
    let (mark, rest) = match target.strip_prefix('#') {
        Some(place) => ("#", place),
        // Two of them would begin a host.
        None if target.starts_with('/') => ("/", target.trim_start_matches('/')),
        None => ("", target),
    };
    format!("{mark}{}", utf8_percent_encode(rest, LEFT_OUT))
}

/// Names of what a block shows and neither text nor Markdown can: charts, drawings, pictures.
fn drawn(block: &Block<'_>) -> Vec<String> {
    let named = |all: &[(String, String)]| -> Vec<String> {
        all.iter().map(|(words, _)| first_sentence(words)).collect()
    };
    match block {
        Block::Panel(panel) => vec![panel.title.clone()],
        Block::Strip(strip) => vec![format!("times in {}", strip.title)],
        Block::Sketches(all) => named(all),
        Block::InSpace(drawing, _) => vec![first_sentence(&drawing.name)],
        Block::Folded(summary, _) => vec![summary.clone()],
        _ => Vec::new(),
    }
}

fn first_sentence(words: &str) -> String {
    let end = words.find(['.', ',', ';', ':']).unwrap_or(words.len());
    words[..end].to_owned()
}

/// A line on what stands on the page alone: sections, and what of others is drawn; none where that is nothing.
fn on_the_page(document: &Document<'_>) -> Option<String> {
    let mut names: Vec<String> = Vec::new();
    for section in &document.sections {
        match section.is_appendix {
            true => names.push(section.title.clone()),
            false => names.extend(section.blocks.iter().flat_map(drawn)),
        }
    }
    names.retain(|name| !name.is_empty());
    names.dedup();
    let file = match document.file.is_empty() {
        true => "report.html",
        false => &document.file,
    };
    (!names.is_empty()).then(|| format!("In {file}: {}.", names.join(", ")))
}

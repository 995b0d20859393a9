//! A document for a terminal, or a file of plain text: no line longer than [`WIDTH`].

use comfy_table::{
    Attribute, Cell as TextCell, CellAlignment, Color, ContentArrangement, Table as TextTable,
    presets::NOTHING,
};

use super::{Block, Cell, Column, Document, Section, Strip, Table, Tone, on_the_page, printable};

/// Columns of a terminal.
pub const WIDTH: usize = 80;
/// Before the blocks of a section.
const INDENT: &str = "  ";

/// Style of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Style {
    /// Without colours, for files and pipes.
    #[default]
    Plain,
    /// With ANSI colours, for a terminal.
    Coloured,
}

impl Style {
    fn paint(self, code: &str, text: &str) -> String {
        match self {
            Self::Plain => text.to_owned(),
            Self::Coloured => {
                let painted = text
                    .lines()
                    .map(|line| format!("\x1b[{code}m{line}\x1b[0m\n"));
                painted.collect()
            }
        }
    }
}

/// The document as text.
#[must_use]
pub fn text(document: &Document<'_>, style: Style) -> String {
    let mut out = style.paint("1", &wrapped("", &printable(&document.title)));
    let verdict = wrapped("", &printable(&document.verdict));
    out += &match document.tone {
        Tone::Plain | Tone::Found => verdict,
        Tone::Good => style.paint("32", &verdict),
        Tone::Open => style.paint("33", &verdict),
        Tone::Bad => style.paint("1;31", &verdict),
    };
    for lead in &document.lead {
        out += &wrapped("", &printable(lead));
    }
    if !document.facts.is_empty() {
        let rows = document.facts.iter().map(|fact| {
            let remark = Cell::from(printable(&fact.remark));
            vec![Cell::from(fact.name.as_str()), fact.value.clone(), remark]
        });
        let columns = vec![
            Column::of_words(""),
            Column::of_numbers(""),
            Column::of_words(""),
        ];
        out.push('\n');
        out += &table(&Table::new("", columns, rows.collect()), style);
    }
    for part in document.sections.iter().filter(|part| !part.is_appendix) {
        out += &section(part, style);
    }
    if let Some(line) = on_the_page(document) {
        out.push('\n');
        out += &style.paint("2", &wrapped("", &line));
    }
    out
}

/// A paragraph in lines of at most [`WIDTH`] columns, the first with something before it and the others indented as far.
#[must_use]
pub fn wrapped(before: &str, paragraph: &str) -> String {
    let indent = " ".repeat(textwrap::core::display_width(before));
    let options = textwrap::Options::new(WIDTH)
        .initial_indent(before)
        .subsequent_indent(&indent)
        .break_words(false)
        .word_splitter(textwrap::WordSplitter::NoHyphenation);
    // A number stays with its percent sign.
    let paragraph = paragraph.replace(" %", "\u{a0}%");
    let lines = textwrap::wrap(&paragraph, options);
    let lines = lines.iter().map(|line| format!("{}\n", line.trim_end()));
    lines.collect::<String>().replace('\u{a0}', " ")
}

fn section(section: &Section<'_>, style: Style) -> String {
    let blocks: String = section.blocks.iter().map(|one| block(one, style)).collect();
    match blocks.is_empty() {
        true => String::new(),
        false => format!(
            "\n{}{blocks}",
            style.paint("1", &wrapped("", &section.title))
        ),
    }
}

/// A block; nothing of what is drawn, which the last line names.
fn block(block: &Block<'_>, style: Style) -> String {
    match block {
        Block::Heading(text) => style.paint("1", &wrapped(INDENT, &printable(text))),
        Block::Paragraph(text) => wrapped(INDENT, &printable(text)),
        Block::Statement(text, rests_on) => {
            wrapped(INDENT, &printable(text))
                + &style.paint("2", &wrapped("    ", &printable(rests_on)))
        }
        Block::Table(of) => table(of, style),
        Block::Strip(of) => strip(of),
        Block::Lines(lines) => lines
            .lines()
            .map(|line| format!("{INDENT}{line}\n"))
            .collect(),
        Block::File(name, words) => wrapped(INDENT, &format!("{name}: {words}")),
        Block::Hint(_)
        | Block::Panel(_)
        | Block::Picture(..)
        | Block::Sketches(_)
        | Block::InSpace(..)
        | Block::Folded(..) => String::new(),
    }
}

/// Columns without borders; what is too long for its column goes on below.
fn table(table: &Table, style: Style) -> String {
    let shown = |index: usize| {
        let mut cells = table.rows.iter().map(|row| &row[index]);
        !cells.all(|cell| matches!(cell, Cell::Interval(_)) || cell.words().is_empty())
    };
    let shown: Vec<usize> = (0..table.columns.len())
        .filter(|index| shown(*index))
        .collect();
    let mut of = TextTable::new();
    of.load_style(NOTHING)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_width((WIDTH - INDENT.len()) as u16);
    of.force_no_tty();
    if style == Style::Coloured {
        of.enforce_styling();
    }
    if shown
        .iter()
        .any(|index| !table.columns[*index].name.is_empty())
    {
        let heads = shown.iter().map(|index| {
            let head = TextCell::new(&table.columns[*index].name).add_attribute(Attribute::Dim);
            aligned(head, table.columns[*index].is_numeric)
        });
        of.set_header(heads.collect::<Vec<_>>());
    }
    for row in &table.rows {
        let cells = shown.iter().map(|index| {
            let own = TextCell::new(printable(&row[*index].words()));
            let own = match &row[*index] {
                Cell::Verdict(_, true) => own.fg(Color::Green),
                Cell::Verdict(_, false) => own.fg(Color::Red).add_attribute(Attribute::Bold),
                _ => own,
            };
            aligned(own, table.columns[*index].is_numeric)
        });
        of.add_row(cells.collect::<Vec<_>>());
    }
    let lines = of
        .lines()
        .map(|line| format!("{INDENT}{}", line.trim_end()).trim_end().to_owned() + "\n");
    let caption = match table.caption.is_empty() {
        true => String::new(),
        false => style.paint("2", &wrapped(INDENT, &table.caption)),
    };
    caption + &lines.collect::<String>()
}

fn aligned(cell: TextCell, is_numeric: bool) -> TextCell {
    match is_numeric {
        true => cell.set_alignment(CellAlignment::Right),
        false => cell,
    }
}

fn strip(strip: &Strip) -> String {
    let line = |(name, spans): &(String, Vec<[f64; 2]>)| {
        let spans: Vec<String> = spans
            .iter()
            .map(|[from, to]| format!("{from:.2} to {to:.2} s"))
            .collect();
        wrapped(INDENT, &format!("{name}: {}", spans.join(", ")))
    };
    strip.rows.iter().map(line).collect()
}

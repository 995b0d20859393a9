//! A document for a terminal, or a file of plain text: no line longer than [`WIDTH`].

use std::borrow::Cow;

use comfy_table::{
    Attribute, Cell as TextCell, CellAlignment, Color, ColumnConstraint, ContentArrangement,
    Table as TextTable, presets::NOTHING,
};

use textwrap::core::display_width;

use super::{Block, Cell, Column, Document, Section, Table, Tone, on_the_page};
use super::{printable, printable_lines};

/// Columns of a terminal.
pub const WIDTH: usize = 80;
/// Beside the text of a cell.
const GAP: usize = 2;
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
    let mut out = style.paint("1", &wrapped("", &document.title));
    let verdict = wrapped("", &document.verdict);
    out += &match document.tone {
        Tone::Plain | Tone::Found => verdict,
        Tone::Good => style.paint("32", &verdict),
        Tone::Open => style.paint("33", &verdict),
        Tone::Bad => style.paint("1;31", &verdict),
    };
    for lead in &document.lead {
        out += &wrapped("", lead);
    }
    if !document.facts.is_empty() {
        let rows = document.facts.iter().map(|fact| {
            let remark = Cell::from(fact.remark.as_str());
            vec![Cell::from(fact.name.as_str()), fact.value.clone(), remark]
        });
        let columns = Column::list(" | # | ");
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
    out.trim_start_matches('\n').to_owned()
}

/// A paragraph in lines of at most [`WIDTH`] columns, the first with something before it and the others indented as far.
#[must_use]
pub fn wrapped(before: &str, paragraph: &str) -> String {
    hanging([before, &" ".repeat(display_width(before))], paragraph)
}

/// A paragraph with something before its first line and before the others.
fn hanging([first, others]: [&str; 2], paragraph: &str) -> String {
    if paragraph.is_empty() {
        return String::new();
    }
    let paragraph = printable(paragraph);
    let options = textwrap::Options::new(WIDTH)
        .initial_indent(first)
        .subsequent_indent(others)
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
        Block::Heading(text) => style.paint("1", &wrapped(INDENT, text)),
        Block::Paragraph(text) => wrapped(INDENT, text),
        Block::Table(of) => table(of, style),
        Block::Lines(lines) => printable_lines(lines)
            .lines()
            .map(|line| format!("{INDENT}{line}").trim_end().to_owned() + "\n")
            .collect(),
        Block::File(name, words) => wrapped(INDENT, &format!("{name}: {words}")),
        Block::Hint(_)
        | Block::Strip(_)
        | Block::Panel(_)
        | Block::Sketches(_)
        | Block::InSpace(..)
        | Block::Folded(..) => String::new(),
    }
}

/// Columns without borders; what is too long for its column goes on below. Where not even the words fit beside one another, a paragraph for each row.
fn table(table: &Table, style: Style) -> String {
    let heads = table.columns.iter().map(|column| printable(&column.name));
    let heads: Vec<String> = heads.map(Cow::into_owned).collect();
    let words = |cell: &Cell| printable(&cell.words()).into_owned();
    let rows = table.rows.iter().map(|row| row.iter().map(words));
    let rows: Vec<Vec<String>> = rows.map(Iterator::collect).collect();
    let shown = |index: usize| rows.iter().any(|row| !row[index].is_empty());
    let shown: Vec<usize> = (0..table.columns.len())
        .filter(|index| shown(*index))
        .collect();
    let caption = match table.caption.is_empty() {
        true => String::new(),
        false => style.paint("2", &wrapped(INDENT, &table.caption)),
    };
    let widest = |index: &usize, of: fn(&str) -> usize| {
        let cells = rows.iter().map(|row| &row[*index]);
        let texts = cells.chain([&heads[*index]]);
        texts.map(|text| of(text)).max().unwrap_or(0)
    };
    let longest_word = |text: &str| text.split(' ').map(display_width).max().unwrap_or(0);
    let least: Vec<usize> = shown.iter().map(|i| widest(i, longest_word)).collect();
    let room = WIDTH - INDENT.len();
    if least.iter().map(|width| width + GAP).sum::<usize>() > room {
        let rows = rows.iter().map(|row| record(table, &shown, row));
        return caption + &rows.collect::<String>();
    }
    let mut of = TextTable::new();
    of.load_style(NOTHING)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_width(room as u16);
    of.force_no_tty();
    if style == Style::Coloured {
        of.enforce_styling();
    }
    if shown.iter().any(|index| !heads[*index].is_empty()) {
        let heads = shown.iter().map(|index| {
            let head = TextCell::new(&heads[*index]).add_attribute(Attribute::Dim);
            aligned(head, table.columns[*index].is_numeric)
        });
        of.set_header(heads.collect::<Vec<_>>());
    }
    for (row, words) in table.rows.iter().zip(&rows) {
        let cells = shown.iter().map(|index| {
            let own = TextCell::new(&words[*index]);
            let own = match &row[*index] {
                Cell::Verdict(_, true) => own.fg(Color::Green),
                Cell::Verdict(_, false) => own.fg(Color::Red).add_attribute(Attribute::Bold),
                _ => own,
            };
            aligned(own, table.columns[*index].is_numeric)
        });
        of.add_row(cells.collect::<Vec<_>>());
    }
    let most: Vec<usize> = shown.iter().map(|i| widest(i, display_width)).collect();
    let constraints = widths(&least, &most, room).into_iter().map(|width| {
        let width = u16::try_from(width + GAP).unwrap_or(u16::MAX);
        ColumnConstraint::Absolute(comfy_table::Width::Fixed(width))
    });
    of.set_constraints(constraints);
    let lines = of
        .lines()
        .map(|line| format!("{INDENT}{}", line.trim_end()).trim_end().to_owned() + "\n");
    caption + &lines.collect::<String>()
}

/// Widths of columns between their longest words and their longest texts: what is left of the room goes to those first that need the least of it.
fn widths(least: &[usize], most: &[usize], room: usize) -> Vec<usize> {
    let mut left = room.saturating_sub(least.iter().map(|width| width + GAP).sum());
    let mut widths = least.to_vec();
    let mut order: Vec<usize> = (0..least.len()).collect();
    order.sort_by_key(|index| most[*index] - least[*index]);
    for (place, &index) in order.iter().enumerate() {
        let more = (most[index] - least[index]).min(left / (order.len() - place));
        widths[index] += more;
        left -= more;
    }
    widths
}

/// A row as a paragraph: its words, then its numbers by the names of their columns.
fn record(table: &Table, shown: &[usize], row: &[String]) -> String {
    let filled = shown.iter().filter(|index| !row[**index].is_empty());
    let parts = filled.map(|index| match table.columns[*index].is_numeric {
        true => format!("{} {}", table.columns[*index].name, row[*index]),
        false => row[*index].clone(),
    });
    let parts: Vec<String> = parts.collect();
    hanging([INDENT, "    "], &parts.join("; "))
}

fn aligned(cell: TextCell, is_numeric: bool) -> TextCell {
    match is_numeric {
        true => cell.set_alignment(CellAlignment::Right),
        false => cell,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Number;

    fn shown(columns: &[&str], row: &[&str]) -> String {
        let columns = columns.iter().copied().map(Column::of_numbers).collect();
        let row = row.iter().copied().map(Cell::from).collect();
        let table = Table::new("", columns, vec![row]);
        text(
            &Document {
                title: "all".to_owned(),
                sections: vec![Section::new("Numbers", vec![Block::Table(table)])],
                ..Document::default()
            },
            Style::Plain,
        )
    }

    #[test]
    fn no_word_of_a_table_is_cut_and_no_line_is_too_long() {
        let name = "displacement";
        let few = shown(&[name; 5], &["stairs.csv"; 5]);
        assert_eq!(few.matches(name).count(), 5, "{few}");
        // More than fit beside one another: a paragraph, each number by its name.
        let many = shown(&[name; 9], &["stairs.csv"; 9]);
        assert_eq!(many.matches("displacement stairs.csv").count(), 9, "{many}");
        for text in [few, many] {
            assert!(
                text.lines().all(|line| display_width(line) <= WIDTH),
                "{text}"
            );
        }
    }

    #[test]
    fn colours_change_nothing_but_the_colours() {
        let verdict = Cell::Verdict("OUTSIDE".to_owned(), false);
        let number = Cell::from(Number::new("x", Some(12.5), "N"));
        let columns = Column::list("verdict | #value");
        let table = Table::new("All.", columns, vec![vec![verdict, number]]);
        let document = Document {
            title: "all".to_owned(),
            verdict: "Bad.".to_owned(),
            tone: Tone::Bad,
            sections: vec![Section::new("Numbers", vec![Block::Table(table)])],
            ..Document::default()
        };
        let mut coloured = text(&document, Style::Coloured);
        while let Some(at) = coloured.find('\u{1b}') {
            let end = at + coloured[at..].find('m').unwrap();
            coloured.replace_range(at..=end, "");
        }
        // Spaces before the end of a colour stay where they are.
        let lines = coloured
            .lines()
            .map(|line| format!("{}\n", line.trim_end()));
        assert_eq!(lines.collect::<String>(), text(&document, Style::Plain));
    }
}

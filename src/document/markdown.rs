//! A document as Markdown, for the text panel of a recording and for repositories.

use super::{Block, Cell, Document, Table, Tone, address, on_the_page};
use super::{printable, printable_lines};

/// The document as Markdown.
#[must_use]
pub fn markdown(document: &Document<'_>) -> String {
    markdown_below(document, 1)
}

/// The same as a part of a page, its title a heading of a level; without a title none.
#[must_use]
pub fn markdown_below(document: &Document<'_>, level: usize) -> String {
    let mut out = match document.title.as_str() {
        "" => String::new(),
        title => heading(title, level),
    };
    if !document.verdict.is_empty() {
        let mark = if document.tone == Tone::Bad { "**" } else { "" };
        let marks = "#".repeat(level + 1);
        out += &format!("\n{marks} {mark}{}{mark}\n", escape(&document.verdict));
    }
    for lead in &document.lead {
        out += &format!("\n{}\n", escape(lead));
    }
    if !document.facts.is_empty() {
        out += "\n| | | |\n| --- | ---: | --- |\n";
        for fact in &document.facts {
            out += &row(&[
                escape(&fact.name),
                escape(&fact.value.words()),
                escape(&fact.remark),
            ]);
        }
    }
    for section in document
        .sections
        .iter()
        .filter(|section| !section.is_appendix)
    {
        let blocks: String = (section.blocks.iter())
            .map(|one| block(one, level + 2))
            .collect();
        if !blocks.is_empty() {
            out += &format!("\n{}{blocks}", heading(&section.title, level + 1));
        }
    }
    if let Some(line) = on_the_page(document) {
        out += &format!("\n{}\n", escape(&line));
    }
    out
}

/// A block; nothing of what is drawn, which the last line names.
fn block(block: &Block<'_>, level: usize) -> String {
    match block {
        Block::Heading(text) => format!("\n{}", heading(text, level)),
        Block::Paragraph(text) => format!("\n{}\n", escape(text)),
        Block::Table(of) => table(of),
        Block::Lines(lines) => fenced(lines.trim_end()),
        Block::File(name, words) => {
            let (target, shown) = (address(name), escape(words));
            match is_picture(name) {
                true => format!("\n![{shown}]({target})\n"),
                false => format!("\n[{}]({target}): {shown}\n", escape(name)),
            }
        }
        Block::Hint(_)
        | Block::Strip(_)
        | Block::Panel(_)
        | Block::Sketches(_)
        | Block::InSpace(..)
        | Block::Folded(..) => String::new(),
    }
}

/// A heading; one that would be too deep for a list of contents is bold.
fn heading(text: &str, level: usize) -> String {
    match level {
        1..=3 => format!("{} {}\n", "#".repeat(level), escape(text)),
        _ => format!("**{}**\n", escape(text)),
    }
}

fn table(table: &Table) -> String {
    let mut out = String::from("\n");
    if !table.caption.is_empty() {
        out += &format!("{}\n\n", escape(&table.caption));
    }
    let heads: Vec<String> = table
        .columns
        .iter()
        .map(|column| escape(&column.name))
        .collect();
    out += &row(&heads);
    let rules = table.columns.iter().map(|column| match column.is_numeric {
        true => "---:".to_owned(),
        false => "---".to_owned(),
    });
    out += &row(&rules.collect::<Vec<_>>());
    for cells in &table.rows {
        let cell = |cell: &Cell| match cell {
            Cell::Verdict(words, false) => format!("**{}**", escape(words)),
            Cell::Link(words, target) => format!("[{}]({})", escape(words), address(target)),
            other => escape(&other.words()),
        };
        out += &row(&cells.iter().map(cell).collect::<Vec<_>>());
    }
    out
}

fn row(cells: &[String]) -> String {
    format!("| {} |\n", cells.join(" | "))
}

/// Lines as they are, in a fence that none of them ends.
fn fenced(lines: &str) -> String {
    let runs = lines.split(|letter| letter != '`').map(str::len);
    let fence = "`".repeat(runs.max().unwrap_or(0).max(2) + 1);
    format!("\n{fence}\n{}\n{fence}\n", printable_lines(lines))
}

/// Text in which nothing is taken for Markdown or for the end of a cell.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in printable(text).chars() {
        if "\\`*_[]<>|#~$&!".contains(letter) {
            out.push('\\');
        }
        out.push(letter);
    }
    out
}
/// Whether a file is a picture that a reader of Markdown shows.
fn is_picture(name: &str) -> bool {
    let extension = std::path::Path::new(name).extension();
    extension.is_some_and(|extension| extension.eq_ignore_ascii_case("svg"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Column, Section};

    #[test]
    fn nothing_of_a_name_leads_elsewhere_or_ends_its_place() {
        let name = "javascript:alert(1)";
        let cell = Cell::Link("x](http://a)\u{1b}".to_owned(), name.to_owned());
        let table = Table::new("", Column::list("name"), vec![vec![cell]]);
        let blocks = vec![
            Block::Table(table),
            Block::File("a b)(c.svg".to_owned(), "picture".to_owned()),
            Block::Lines("```\n[out](http://a)".to_owned()),
        ];
        let text = markdown(&Document {
            sections: vec![Section::new("All", blocks)],
            ..Document::default()
        });
        for expected in [
            "[x\\](http://a)\\\\u001b](javascript%3Aalert%281%29)",
            "![picture](a%20b%29%28c.svg)",
            "\n````\n```\n[out](http://a)\n````\n",
        ] {
            assert!(text.contains(expected), "{expected} in {text}");
        }
    }
}

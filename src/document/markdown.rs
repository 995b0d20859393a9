//! A document as Markdown, for the text panel of a recording and for repositories.

use super::{Block, Cell, Document, Table, Tone, on_the_page};

/// The document as Markdown.
#[must_use]
pub fn markdown(document: &Document<'_>) -> String {
    let mut out = format!("# {}\n", escape(&document.title));
    if !document.verdict.is_empty() {
        let mark = if document.tone == Tone::Bad { "**" } else { "" };
        out += &format!("\n## {mark}{}{mark}\n", escape(&document.verdict));
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
        let blocks: String = section.blocks.iter().map(block).collect();
        if !blocks.is_empty() {
            out += &format!("\n## {}\n{blocks}", escape(&section.title));
        }
    }
    if let Some(line) = on_the_page(document) {
        out += &format!("\n{}\n", escape(&line));
    }
    out
}

/// A block; nothing of what is drawn, which the last line names.
fn block(block: &Block<'_>) -> String {
    match block {
        Block::Heading(text) => format!("\n### {}\n", escape(text)),
        Block::Paragraph(text) => format!("\n{}\n", escape(text)),
        Block::Table(of) => table(of),
        Block::Lines(lines) => format!("\n```\n{}\n```\n", lines.trim_end()),
        Block::File(name, words) => format!("\n[{}]({name}): {}\n", escape(name), escape(words)),
        Block::Hint(_)
        | Block::Strip(_)
        | Block::Panel(_)
        | Block::Picture(..)
        | Block::Sketches(_)
        | Block::InSpace(..)
        | Block::Folded(..) => String::new(),
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
            other => escape(&other.words()),
        };
        out += &row(&cells.iter().map(cell).collect::<Vec<_>>());
    }
    out
}

fn row(cells: &[String]) -> String {
    format!("| {} |\n", cells.join(" | "))
}

/// Text in which nothing is taken for Markdown or for the end of a cell.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        if letter.is_control() {
            out.push(' ');
            continue;
        }
        if "\\`*_[]<>|#~$&!".contains(letter) {
            out.push('\\');
        }
        out.push(letter);
    }
    out
}

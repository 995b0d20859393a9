//! The part of a page that says where all comes from.

use crate::document::{Block, Cell, Column, Number, Section, Table};
use crate::recording::provenance::{Provenance, SourceFile};

/// The same of a program, libraries included, and files.
pub fn sources(program: &str, files: &[SourceFile]) -> Section<'static> {
    provenance(&Provenance {
        program: program.to_owned(),
        files: files.to_vec(),
        ..Provenance::default()
    })
}

/// The part of a page that says where all comes from.
pub fn provenance(from: &Provenance) -> Section<'static> {
    let mut made = format!("Made by {}", from.program);
    if !from.libraries.is_empty() {
        made += &format!(" with {}", from.libraries.join(", "));
    }
    made += &match from.seed {
        Some(seed) => format!("; seed {seed}."),
        None => "; nothing is drawn at random.".to_owned(),
    };
    let rows = from.files.iter().map(|file| {
        vec![
            Cell::from(file.file.clone()),
            Cell::from(Number::bare("", None, "").written(file.bytes.to_string())),
            Cell::Hash(file.sha256.clone()),
        ]
    });
    Section::new(
        "Provenance",
        vec![
            Block::Paragraph(made),
            Block::Table(Table::new(
                "Files that were read",
                Column::list("file | #bytes | SHA-256"),
                rows.collect(),
            )),
        ],
    )
    .appendix()
}

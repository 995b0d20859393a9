//! The part of a page that says where all comes from.

use crate::document::{Block, Cell, Section, Table};
use crate::recording::provenance::{Provenance, SourceFile};

/// Where a document says that it comes from.
pub(super) fn provenance_of(document: &serde_json::Value) -> Section<'static> {
    let known = serde_json::from_value(document["provenance"].clone());
    provenance(&known.unwrap_or_default())
}

/// The same of a program, libraries included, and files.
pub(in super::super) fn sources(program: &str, files: &[SourceFile]) -> Section<'static> {
    provenance(&Provenance {
        program: program.to_owned(),
        files: files.to_vec(),
        ..Provenance::default()
    })
}

/// The part of a page that says where all comes from.
pub(super) fn provenance(from: &Provenance) -> Section<'static> {
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
            Cell::from(file.bytes.to_string()),
            Cell::Hash(file.sha256.clone()),
        ]
    });
    Section::new(
        "Provenance",
        vec![
            Block::Paragraph(made),
            Block::Table(Table::new(
                "Files that were read",
                &["file", "#bytes", "SHA-256"],
                rows.collect(),
            )),
        ],
    )
}

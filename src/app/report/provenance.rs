//! The part of a page that says where all comes from.

use crate::page::{Block, PageSection, PageTable, TableCell};
use crate::recording::provenance::{Provenance, SourceFile};

/// Where a document says that it comes from.
pub(super) fn provenance_of(document: &serde_json::Value) -> PageSection<'static> {
    let known = serde_json::from_value(document["provenance"].clone());
    provenance(&known.unwrap_or_default())
}

/// The same of a program, libraries included, and files.
pub(in super::super) fn sources(program: &str, files: &[SourceFile]) -> PageSection<'static> {
    provenance(&Provenance {
        program: program.to_owned(),
        files: files.to_vec(),
        ..Provenance::default()
    })
}

/// The part of a page that says where all comes from.
pub(super) fn provenance(from: &Provenance) -> PageSection<'static> {
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
            TableCell::from(file.file.clone()),
            TableCell::from(file.bytes.to_string()),
            TableCell::Hash(file.sha256.clone()),
        ]
    });
    PageSection::new(
        "Provenance",
        vec![
            Block::Paragraph(made),
            Block::PageTable(PageTable::new(
                "Files that were read",
                &["file", "#bytes", "SHA-256"],
                rows.collect(),
            )),
        ],
    )
}

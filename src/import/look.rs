//! A map drafted by looking at logs: how they are written, what their columns are and in what units, each with how sure it is and why. What cannot be determined
//! is asked for in a comment.
//!
//! ```text
//! logs -> layout (`table`) and columns (`text`, `forms`) -> clocks and times (`clocks`, `time`), quantities (`names`, `assign`) and units (`units`) -> map (`sections`, `write`)
//! ```

use std::path::{Path, PathBuf};

use super::error::ImportError;
use super::{bag, signature};

mod assign;
mod clocks;
mod forms;
mod joints;
mod lerobot;
mod long;
mod marks;
mod named;
mod names;
mod numbered;
mod rate;
mod sections;
mod seen;
mod table;
mod text;
mod time;
mod units;
mod unnamed;
mod wrench;
mod write;

pub use seen::Draft;
use seen::{Cells, Looked};

/// Columns of a log that are looked at, at most.
const MOST_COLUMNS: usize = 4096;

/// Drafts a map for logs. Those that are alike make a recording each; those that are not are taken to be parts of one.
///
/// # Errors
/// A log that cannot be read, whose encoding cannot be determined, or whose numbers mix decimal marks.
pub fn draft(title: &str, paths: &[PathBuf]) -> Result<Draft, ImportError> {
    let mut kinds: Vec<(Looked, Vec<PathBuf>)> = Vec::new();
    for path in paths {
        let mut looked = look(path)?;
        let count = looked.columns.len();
        if count > MOST_COLUMNS {
            looked.columns.truncate(MOST_COLUMNS);
            looked.notes.push(format!(
                "Of its {count} columns the first {MOST_COLUMNS} were looked at."
            ));
        }
        match kinds.iter_mut().find(|(kind, _)| kind.is_like(&looked)) {
            Some((kind, alike)) => {
                alike.push(path.clone());
                let lacks = |line: &&seen::Line| kind.head.iter().all(|own| own.key != line.key);
                let more: Vec<seen::Line> = looked.head.iter().filter(lacks).cloned().collect();
                kind.head.extend(more);
                kind.notes.extend(looked.notes.iter().cloned());
                for (own, more) in kind.columns.iter_mut().zip(&looked.columns) {
                    // Ranges are those of all; the first log's rows stand first. A column may be empty in one of them.
                    match &mut own.cells {
                        Cells::Numbers(numbers) | Cells::States(numbers) => {
                            numbers.extend_from_slice(more.numbers());
                        }
                        Cells::Other => own.cells = more.cells.clone(),
                        Cells::Stamps { .. } => {}
                    }
                }
            }
            None => kinds.push((looked, vec![path.clone()])),
        }
    }
    Ok(write::draft(title, &kinds))
}

/// Looks at a log, by what it begins with; by its name where that says nothing.
fn look(path: &Path) -> Result<Looked, ImportError> {
    if path.is_dir() {
        return forms::bag(path);
    }
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let by_name = match ending.to_lowercase().as_str() {
        "parquet" => "parquet",
        "mat" => "mat5",
        "mcap" | "db3" => "bag",
        _ => "text",
    };
    let form = match signature::of_file(path)? {
        Some(found) => found
            .form
            .ok_or_else(|| found.refusal(path, signature::READ))?,
        None => by_name,
    };
    match form {
        "parquet" => forms::parquet(path),
        "mat5" => forms::mat(path),
        "tdms" => forms::tdms(path),
        "spreadsheet" => forms::spreadsheet(path),
        "bag" => forms::bag(path),
        _ if bag::is_packed(path) => forms::bag(path),
        _ => text::look(path),
    }
}

//! Text for a person after a run: a table for the terminal, and the same as Markdown.

mod bench;
mod markdown;
mod rows;
#[cfg(test)]
mod test_summaries;
mod text;

pub use bench::{bench_markdown, bench_text};
pub use markdown::markdown;
pub use rows::{drives, far_from_desired, shown};
pub use text::{Style, text};

//! What a person reads after a run: a table for the terminal, and the same as Markdown.

mod bench;
mod markdown;
mod number;
mod rows;
#[cfg(test)]
mod test_summaries;
mod text;

pub use bench::{bench_markdown, bench_text};
pub use markdown::markdown;
pub use text::{Style, text};

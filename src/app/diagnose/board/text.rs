//! The words on the screen of a diagnosis, in Markdown.

use std::fmt::Write as _;

use crate::diagnosis::answer::Answer;
use crate::diagnosis::answer::words::{capital, of_column, percent, reference_noise};
use crate::quantity::significant;

/// Verdict, numbers, prediction, and the account.
pub(super) fn markdown(answer: &Answer, left_out: usize, thinned: bool) -> String {
    let account = &answer.details.account;
    let headline = account.headline.replace('_', " ");
    let mut text = format!("# {}\n", capital(&headline));
    text += &effects(answer);
    text += &predictions(answer);
    for section in &account.sections {
        text += &format!("\n## {}\n", section.title);
        for paragraph in &section.paragraphs {
            text += &format!("\n{}\n", paragraph.replace('_', "\\_"));
        }
        if let Some(table) = &section.table {
            text += &format!("\n```\n{}\n```\n", table.trim_end());
        }
    }
    let mut notes = Vec::new();
    if left_out > 0 {
        notes.push(format!("{left_out} more recordings are not drawn"));
    }
    if thinned {
        notes.push(
            "of long recordings the least and the largest value of each stretch are drawn"
                .to_owned(),
        );
    }
    if !notes.is_empty() {
        let notes = capital(&notes.join("; "));
        text += &format!("\n*{notes}: comparison.parquet holds every sample.*\n");
    }
    text
}

/// The numbers of what was found, each effect above its own.
fn effects(answer: &Answer) -> String {
    let mut rows = String::new();
    for effect in &answer.effects {
        let name = effect.name.replace('_', " ");
        let probability = percent(effect.confidence);
        // A string takes whatever is written to it.
        let _ = writeln!(rows, "| **{name}** | probability | {probability} |");
        for (name, estimate) in &effect.parameters {
            let (words, unit, factor) = effect.display_name(name);
            let number = |value: f64| significant(factor * value, 4);
            let [low, value, high] = [estimate.low, estimate.value, estimate.high];
            // Which of several it is, such as a joint, has no interval.
            let (value, interval) = if low == high {
                (format!("{}", factor * value), String::new())
            } else {
                let interval = format!("{} to {}", number(low), number(high));
                (number(value), interval)
            };
            let _ = writeln!(rows, "| {words} | {value} {unit} | {interval} |");
        }
    }
    if rows.is_empty() {
        return rows;
    }
    format!("\n| what is missing | value | 95 % interval |\n|---|---|---|\n{rows}")
}

/// Errors of prediction on what was not fitted to.
fn predictions(answer: &Answer) -> String {
    let mut rows = String::new();
    for error in &answer.details.prediction {
        let (words, unit, factor) = of_column(&error.channel);
        let number = |value: f64| significant(factor * value, 2);
        let _ = writeln!(
            rows,
            "| {} | {words} [{unit}] | {} | {} | {} |",
            error.recording.replace('_', "\\_"),
            number(error.before),
            number(error.after),
            error.noise.map_or("–".to_owned(), number)
        );
    }
    if rows.is_empty() {
        return rows;
    }
    format!(
        "\n| prediction error (RMS) | of | before | after | {} |\n|---|---|---|---|---|\n{rows}",
        reference_noise(answer.details.remaining.is_some())
    )
}

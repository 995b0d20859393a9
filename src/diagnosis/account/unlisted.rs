//! What is said of physics without a name: where it enters, on what it depends, its shape, and what known physics is near.

use std::fmt::Write as _;

use super::super::diagnose::Diagnosis;
use super::super::unlisted::known::known;
use super::super::unlisted::report::NearEffects;
use super::super::unlisted::words::{Shown, port, variable};
use super::super::unlisted::{Form, Row, Shape};
use super::super::words::{figures, listed, percent};
use super::missing::probability;
use crate::plant::Basis;

/// Rows of the table.
const ROWS: usize = 12;
/// Letters of a bar from one side to the other.
const BAR: usize = 32;

impl Diagnosis {
    /// Paragraphs on a term without a name; none where there is none.
    pub(super) fn unlisted_words(&self) -> Vec<String> {
        let Some(shape) = &self.shape else {
            return Vec::new();
        };
        let latent = &shape.latent;
        let known = known(latent, shape.form);
        let confidence = probability(self.confidence(super::super::answer::UNLISTED));
        vec![
            format!("{}. Probability {confidence}.", self.where_and_what(shape)),
            format!(
                "{} Known physics of that kind: {}. To find it: {}.",
                near(&self.nearest_known()),
                known.resembles,
                known.check
            ),
        ]
    }

    /// Where a term enters, on what it depends, and how large it is.
    fn where_and_what(&self, shape: &Shape) -> String {
        let latent = &shape.latent;
        let (at, over) = (port(latent.port), variable(latent.variable));
        let subsystem = latent.port.subsystem().replace('_', " ");
        let turns = if latent.directed {
            ", and turns with the direction of motion"
        } else {
            ""
        };
        let size = figures(shape.peak_to_peak * at.factor, 3);
        let mut text = format!(
            "Physics that no known effect explains ({subsystem}): {} {} that depends on the {}{turns}, {size} {} from its least to its largest value",
            article(at.words),
            at.words,
            over.words,
            at.unit
        );
        text += &match (shape.form, shape.period) {
            (_, Some([period, half])) => format!(
                ", with a period of {} s ({} Hz) to {} ms",
                figures(period, 5),
                figures(1.0 / period, 4),
                figures(1e3 * half, 2)
            ),
            (Form::Localised, None) => acting(shape, over),
            (Form::Odd, None) => ", opposite in sign for opposite signs of it".to_owned(),
            (Form::Even, None) => ", the same for either sign of it".to_owned(),
            _ => String::new(),
        };
        let others: Vec<String> = (self.best().depends_on.iter())
            .filter(|name| **name != latent.variable.name() && **name != "velocity_sign")
            .map(|name| name.trim_end_matches("_m").replace('_', " "))
            .collect();
        if !others.is_empty() {
            text += &format!(
                "; the recordings would as well have it depend on {}",
                listed(&others)
            );
        }
        text
    }

    /// The shape as a table with bars, and where its picture stands; none where there is no such term.
    pub(super) fn shape_table(&self) -> Option<String> {
        let shape = self.shape.as_ref()?;
        let latent = &shape.latent;
        let (of, over) = (port(latent.port), variable(latent.variable));
        let place = match latent.basis {
            Basis::Hats { .. } => format!("{} [{}]", over.words, over.unit),
            Basis::Waves { .. } => "time within a period [s]".to_owned(),
        };
        let last = shape.curve.len() - 1;
        let rows: Vec<&Row> = (0..=ROWS).map(|k| &shape.curve[k * last / ROWS]).collect();
        let largest = rows.iter().fold(0.0f64, |most, r| most.max(r.value.abs()));
        let wide = place.chars().count();
        let head = format!("{} [{}]", of.words, of.unit);
        let mut text =
            format!("\n  {place}   {head}, with its 95 % interval (picture: unlisted.svg)\n");
        for row in rows {
            let scale = |value: f64| value * of.factor;
            let digits = decimals(scale(largest));
            // Writing into a text cannot fail.
            let _ = writeln!(
                text,
                "  {:>wide$}   {:>9} +- {:<9} {}",
                figures(row.at * over.factor, 4),
                format!("{:.digits$}", scale(row.value)),
                half_width(scale(row.half_width), scale(largest), digits),
                bar(row.value / largest)
            );
        }
        Some(text)
    }
}

/// Between which values of its variable a localised term acts.
fn acting(shape: &Shape, over: Shown) -> String {
    let c = &shape.knots;
    let largest = c.iter().fold(0.0f64, |most, row| most.max(row.value.abs()));
    let mut acts = c.iter().filter(|row| row.value.abs() > 0.1 * largest);
    let Some(first) = acts.next() else {
        return String::new();
    };
    let last = acts.next_back().unwrap_or(first);
    format!(
        ", between {} and {} {} alone",
        figures(first.at * over.factor, 3),
        figures(last.at * over.factor, 3),
        over.unit
    )
}

/// What the known effects come to.
fn near(effects: &[NearEffects]) -> String {
    let Some(best) = effects.first() else {
        return "No known effect explains a part of it.".to_owned();
    };
    let share = best.share_explained.map_or_else(String::new, |share| {
        format!(", which explains {} of the mismatch", percent(share))
    });
    format!(
        "The nearest known explanation is {}{share}.",
        listed(&best.effects)
    )
}

/// A half width, or that nothing is known.
fn half_width(value: f64, largest: f64, digits: usize) -> String {
    if value < 3.0 * largest {
        format!("{value:.digits$}")
    } else {
        "unknown".to_owned()
    }
}

/// Decimals that show a hundredth of a value.
fn decimals(largest: f64) -> usize {
    let order = largest.log10().floor();
    if order.is_finite() {
        (2.0 - order).clamp(0.0, 6.0) as usize
    } else {
        2
    }
}

/// A share of the largest value, -1 to 1, as a bar to the left or the right of a middle.
fn bar(share: f64) -> String {
    let half = BAR / 2;
    let length = (share.abs().min(1.0) * half as f64).round() as usize;
    if !share.is_finite() || length == 0 {
        return format!("{}|", " ".repeat(half));
    }
    if share < 0.0 {
        format!("{}{}|", " ".repeat(half - length), "#".repeat(length))
    } else {
        format!("{}|{}", " ".repeat(half), "#".repeat(length))
    }
}

fn article(words: &str) -> &'static str {
    if words.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_grow_from_the_middle() {
        assert_eq!(bar(0.0), format!("{}|", " ".repeat(16)));
        assert_eq!(bar(1.0), format!("{}|{}", " ".repeat(16), "#".repeat(16)));
        assert_eq!(bar(-0.25), format!("{}####|", " ".repeat(12)));
        assert_eq!(bar(f64::NAN).trim(), "|");
    }

    #[test]
    fn numbers_show_a_hundredth_of_the_largest() {
        assert_eq!((decimals(42.0), decimals(0.31), decimals(812.0)), (1, 3, 0));
        assert_eq!(half_width(500.0, 10.0, 1), "unknown");
    }
}

//! Words on a model discrepancy: where it enters, on what it depends, its shape, and what known physics is near.

use std::fmt::Write as _;

use super::super::estimate::Number;
use super::super::finding::Diagnosis;
use super::super::words::{listed, percent, with_interval, with_interval_in_si};
use super::missing::probability;
use crate::diagnosis::formula::unlisted::known::known;
use crate::diagnosis::formula::unlisted::report::NearEffects;
use crate::diagnosis::formula::unlisted::words::{port, variable};
use crate::diagnosis::formula::unlisted::{Form, Shape};
use crate::plant::Variable;
use crate::quantity::significant;

/// Letters of a bar from one side to the other.
const BAR: usize = 32;

impl Diagnosis {
    /// Paragraphs on a model discrepancy; none where there is none.
    pub(super) fn unlisted_words(&self) -> Vec<String> {
        let Some(shape) = &self.shape else {
            return Vec::new();
        };
        let latent = &shape.latent;
        let known = known(latent, shape.form);
        let confidence = probability(self.confidence(crate::effects::UNLISTED));
        let doubt = self.doubt_words(crate::effects::UNLISTED);
        let first = format!(
            "{}. Probability {confidence}.{doubt}",
            self.where_and_what(shape)
        );
        let mut paragraphs = vec![first];
        paragraphs.extend(self.as_formula());
        paragraphs.push(
            format!(
                "{} Known physics of that kind: {}. The shape stands below with its 95 % interval, and drawn in unlisted.svg.",
                near(&self.nearest_known(), self.explained_share()),
                known.resembles,
            ),
        );
        paragraphs
    }

    /// The formula of a term with its numbers and the expressions that do nearly as well; none where it is a curve.
    fn as_formula(&self) -> Option<String> {
        let law = &self.best().formula()?.law;
        let number = |number: &Number| {
            let constant = law.constants.iter().find(|c| c.name == number.name);
            let unit = constant.and_then(|c| c.unit).filter(|unit| *unit != "1");
            let unit = unit.unwrap_or_default();
            let value = with_interval_in_si(number.value, number.interval, unit);
            format!("{} = {value}", number.name)
        };
        let numbers: Vec<String> = self.estimates.formula.iter().map(number).collect();
        let others = self.rivals().filter_map(|rival| {
            let other = &rival.hypothesis.formula()?.law;
            let (port, is) = (other.port.name(), other.expression.text());
            Some(format!(
                "{port} = {is} (odds {})",
                significant(rival.odds, 2)
            ))
        });
        let others: Vec<String> = others.collect();
        let rest = match others.is_empty() {
            true => String::new(),
            false => format!(" Not distinguished from it: {}.", listed(&others)),
        };
        Some(format!(
            "As a formula, in SI: {} = {}, with {}; the intervals are those of 95 %.{rest}",
            law.port.name(),
            law.expression.text(),
            listed(&numbers)
        ))
    }

    /// Where a term enters, on what it depends, and how large it is.
    fn where_and_what(&self, shape: &Shape) -> String {
        let latent = &shape.latent;
        let (at, over) = (port(latent.port), variable(latent.variable));
        let subsystem = latent.port.subsystem().replace('_', " ");
        let depends = match latent.variable {
            Variable::Time => "varies with time".to_owned(),
            _ => format!("depends on the {}", over.words),
        };
        let turns = if latent.directed {
            " and turns with the direction of motion"
        } else {
            ""
        };
        let size = significant(shape.peak_to_peak * at.factor, 3);
        let mut text = format!(
            "Physics that no known effect explains ({subsystem}): {} {} that {depends}{turns}, {size} {} from peak to peak",
            article(at.words),
            at.words,
            at.unit
        );
        text += &match (shape.form, shape.period) {
            (_, Some([period, half])) => format!(
                ", with a period of {} ({} Hz)",
                with_interval(
                    1e3 * period,
                    [period - half, period + half].map(|t| 1e3 * t),
                    "ms"
                ),
                significant(1.0 / period, 4),
            ),
            (Form::Localised, None) => {
                let [from, to] = shape.acts.map(|end| significant(end * over.factor, 3));
                format!(", between {from} and {to} {} alone", over.unit)
            }
            (Form::Odd, None) => ", opposite in sign for opposite signs of it".to_owned(),
            (Form::Even, None) => ", the same for either sign of it".to_owned(),
            _ => String::new(),
        };
        let names = self.best().depends_on.iter();
        let others = Variable::ALL.into_iter().filter(|other| {
            *other != latent.variable && names.clone().any(|name| *name == other.name())
        });
        let others: Vec<String> = others
            .map(|v| format!("the {}", variable(v).words))
            .collect();
        if !others.is_empty() {
            text += &format!(
                "; {} would do nearly as well for a variable",
                listed(&others)
            );
        }
        text
    }

    /// Hints to what a term is; nothing where there are none.
    pub(super) fn what_to_check(&self) -> String {
        self.shape.as_ref().map_or_else(String::new, |shape| {
            let check = known(&shape.latent, shape.form).check;
            format!("To find what it is: {check}.")
        })
    }

    /// The shape as a table with bars; none where there is no such term.
    pub(super) fn shape_table(&self) -> Option<String> {
        let shape = self.shape.as_ref()?;
        let latent = &shape.latent;
        let (of, over) = (port(latent.port), variable(latent.variable));
        let (place, place_factor) = match shape.period {
            None => (format!("{} [{}]", over.words, over.unit), over.factor),
            Some(_) => ("within the period [ms]".to_owned(), 1e3),
        };
        let rows = &shape.table;
        let largest = rows.iter().fold(0.0f64, |most, r| most.max(r.value.abs()));
        let wide = place.chars().count();
        let digits = decimals(largest * of.factor);
        let span = rows[rows.len() - 1].at - rows[0].at;
        let place_digits = decimals(span * place_factor);
        let mut text = format!("\n  {place}   {} [{}]\n", of.words, of.unit);
        for row in rows {
            // Writing into a text cannot fail.
            let _ = writeln!(
                text,
                "  {:>wide$}   {:>9} +- {:<9} {}",
                fixed(row.at * place_factor, place_digits),
                fixed(row.value * of.factor, digits),
                half_width(row.half_width * of.factor, largest * of.factor, digits),
                bar(row.value / largest)
            );
        }
        Some(text)
    }
}

/// A number with so many decimals; zero has no sign.
fn fixed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|letter| matches!(letter, '0' | '.')) => rest.to_owned(),
        _ => text,
    }
}

/// Result of the known effects, beside the term's share.
fn near(effects: &[NearEffects], term: Option<f64>) -> String {
    let Some(best) = effects.first() else {
        return "No known effect was found to explain a part of it.".to_owned();
    };
    let shares = best.share_explained.zip(term);
    let said = shares.map_or_else(String::new, |(share, term)| {
        let (share, term) = (percent(share), percent(term));
        format!(
            ", {}, explains {share} of the mismatch, the term {term}",
            listed(&best.effects)
        )
    });
    if said.is_empty() {
        format!(
            "The nearest known explanation is {}.",
            listed(&best.effects)
        )
    } else {
        format!("The nearest known explanation{said}.")
    }
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
        assert_eq!(fixed(-0.04, 1), "0.0");
        assert_eq!(fixed(-0.06, 1), "-0.1");
    }
}

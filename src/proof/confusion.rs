//! The page of a sweep: what was answered for what, the size at which each effect is first seen, false alarms.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::outcome::Outcome;
use super::reliability::Reliability;
use crate::laboratory::LOST;
use crate::quantity::binomial::upper_bound;
use crate::quantity::significant;
use crate::stats::{median, quantile};

/// 90th percentile of a prediction's error from which an explanation is not a full one [standard deviations].
const FAR: f64 = 4.0;

/// A page in Markdown; outcomes in any order.
pub fn page(outcomes: &[Outcome]) -> String {
    let mut text = String::from("# What is taken for what\n\n");
    let _ = writeln!(
        text,
        "Written by `idc prove --sweep` from {} outcomes. Each case is a device drawn at random by the laboratory (`src/laboratory/`: equations of its own, another\n\
integrator), recorded in three programmes and diagnosed from them; a fourth is predicted.\n\n\
An effect comes in sizes. Size 0 is the largest that is plausible; the last one is that at which, in these recordings, it shows with {LOST} standard\n\
deviations beside all that the rig file tolerates: it is meant to be lost. Those between are in equal ratios. *Shows* is that measure: its square is what\n\
the effect could add to twice the log-likelihood (`src/laboratory/visibility.rs`).\n",
        outcomes.len()
    );
    false_alarms(&mut text, outcomes);
    sizes(&mut text, outcomes);
    matrix(&mut text, outcomes);
    reliability(&mut text, outcomes);
    numbers(&mut text, outcomes);
    text
}

/// Conditions, and for each the share of right names among those stated with about a probability.
fn reliability(text: &mut String, outcomes: &[Outcome]) {
    let stated = outcomes.iter().flat_map(|outcome| &outcome.score.stated);
    let Some(found) = Reliability::of(stated) else {
        return;
    };
    let [right, sure] = found.sure;
    let [_, all] = found.sure_of_right;
    let _ = writeln!(
        text,
        "## What a stated probability is worth\n\nOf the names stated with a probability above 0.9, {right} of {sure} are right; they are {right} of the {all} right names. The Brier score is {:.3}.\n\n| stated | names | mean stated | right |\n| --- | --- | --- | --- |",
        found.brier
    );
    for bin in &found.bins {
        let _ = writeln!(
            text,
            "| {} to {} | {} | {:.3} | {:.3} |",
            bin.stated[0],
            bin.stated[1],
            bin.count,
            bin.mean,
            bin.right as f64 / bin.count as f64
        );
    }
    let fully = |outcome: &&Outcome| outcome.score.explained_fully == Some(true);
    let missed = |outcome: &&Outcome| outcome.score.prediction.is_none_or(|p| p > FAR);
    let all = outcomes.iter().filter(fully);
    let _ = writeln!(
        text,
        "\nOf {} answers that say to explain the recordings fully, {} miss the unseen recording by more than {FAR} standard deviations (90th percentile, worst channel).\n",
        all.clone().count(),
        all.filter(missed).count()
    );
}

fn effects(outcomes: &[Outcome]) -> BTreeMap<&str, Vec<&Outcome>> {
    let mut by_effect: BTreeMap<&str, Vec<&Outcome>> = BTreeMap::new();
    for outcome in outcomes {
        if let Some(effect) = &outcome.made.effect {
            by_effect.entry(effect).or_default().push(outcome);
        }
    }
    by_effect
}

fn false_alarms(text: &mut String, outcomes: &[Outcome]) {
    let empty: Vec<&Outcome> = outcomes
        .iter()
        .filter(|o| o.made.effect.is_none())
        .collect();
    if empty.is_empty() {
        return;
    }
    let wrong: Vec<&&Outcome> = empty.iter().filter(|o| !o.score.named_exactly).collect();
    let bound = 100.0 * upper_bound(wrong.len(), empty.len(), 0.05);
    let _ = writeln!(
        text,
        "## Nothing missing\n\n{} false alarms in {} devices with nothing missing; with 95 % confidence there are no more than {bound:.1} % (exact binomial bound).\n",
        wrong.len(),
        empty.len()
    );
    for outcome in wrong {
        let _ = writeln!(text, "- seed {}: {}", outcome.made.seed, outcome.answered());
    }
    text.push('\n');
}

/// Count of hits, and of all.
fn tally(outcomes: &[&Outcome], hit: impl Fn(&Outcome) -> bool) -> String {
    let hits = outcomes.iter().filter(|o| hit(o)).count();
    format!("{hits}/{}", outcomes.len())
}

fn of_size<'a>(outcomes: &[&'a Outcome], size: usize) -> Vec<&'a Outcome> {
    outcomes
        .iter()
        .filter(|o| o.made.size == size)
        .copied()
        .collect()
}

/// The last size, from the largest down, at which an effect is seen in most devices.
fn first_seen(outcomes: &[&Outcome], count: usize) -> Option<usize> {
    let most = |size: &usize| {
        let these = of_size(outcomes, *size);
        2 * these.iter().filter(|o| o.seen()).count() > these.len()
    };
    (0..count).take_while(most).last()
}

fn count_of_sizes(outcomes: &[Outcome]) -> usize {
    outcomes.iter().map(|o| o.made.sizes).max().unwrap_or(0)
}

fn sizes(text: &mut String, outcomes: &[Outcome]) {
    let by_effect = effects(outcomes);
    let count = count_of_sizes(outcomes);
    if by_effect.is_empty() {
        return;
    }
    text.push_str("## From which size on\n\nNamed exactly, that is alone, at each size; then the smallest size at which it is seen, alone or with others, in most devices, and what it comes to there\n(medians).\n\n| effect |");
    for size in 0..count {
        let _ = write!(text, " {size} |");
    }
    text.push_str(" seen down to | share of the largest | shows | its numbers |\n| --- |");
    text.push_str(&" --- |".repeat(count + 4));
    text.push('\n');
    for (effect, all) in &by_effect {
        let _ = write!(text, "| {effect} |");
        for size in 0..count {
            let _ = write!(
                text,
                " {} |",
                tally(&of_size(all, size), |o| o.score.named_exactly)
            );
        }
        let Some(size) = first_seen(all, count) else {
            text.push_str(" - | - | - | - |\n");
            continue;
        };
        let these = of_size(all, size);
        let of_these =
            |of: &dyn Fn(&Outcome) -> f64| median(these.iter().map(|o| of(o))).unwrap_or(f64::NAN);
        let names: Vec<&String> = these.iter().flat_map(|o| o.parameters.keys()).collect();
        let mut numbers: Vec<String> = names
            .iter()
            .map(|name| {
                let value =
                    of_these(&|o| o.parameters.get(*name).copied().unwrap_or(f64::NAN).abs());
                format!("{name} {}", short(value))
            })
            .collect();
        numbers.sort();
        numbers.dedup();
        let _ = writeln!(
            text,
            " {size} | {} | {} | {} |",
            short(of_these(&|o| o.share)),
            short(of_these(&|o| o.shows)),
            numbers.join(", ")
        );
    }
    text.push('\n');
}

/// A number in three digits.
fn short(value: f64) -> String {
    if value == 0.0 || (1e-3..1e4).contains(&value.abs()) {
        let digits = (2.0 - value.abs().max(1e-3).log10().floor()).clamp(0.0, 6.0) as usize;
        format!("{value:.digits$}")
    } else {
        significant(value, 3)
    }
}

fn matrix(text: &mut String, outcomes: &[Outcome]) {
    let by_effect = effects(outcomes);
    for size in 0..count_of_sizes(outcomes) {
        let _ = writeln!(
            text,
            "## Taken for what, at size {size}\n\n| at work | answered, with how often |\n| --- | --- |"
        );
        for (effect, all) in &by_effect {
            let mut answers: BTreeMap<String, usize> = BTreeMap::new();
            for outcome in of_size(all, size) {
                *answers.entry(outcome.answered()).or_default() += 1;
            }
            let mut answers: Vec<(String, usize)> = answers.into_iter().collect();
            answers.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
            let list: Vec<String> = answers
                .iter()
                .map(|(answer, times)| {
                    let name = if answer == effect { "itself" } else { answer };
                    format!("{name} {times}")
                })
                .collect();
            let _ = writeln!(text, "| {effect} | {} |", list.join(", "));
        }
        text.push('\n');
    }
}

fn numbers(text: &mut String, outcomes: &[Outcome]) {
    let count = count_of_sizes(outcomes);
    text.push_str("## How well, where named exactly\n\n| size | cases | parameter error, median | 90th percentile | intervals that hold the truth | overlap of the intervals, median | prediction, median |\n| --- | --- | --- | --- | --- | --- | --- |\n");
    for size in 0..count {
        let all: Vec<&Outcome> = outcomes
            .iter()
            .filter(|o| o.made.effect.is_some())
            .collect();
        let named: Vec<&Outcome> = of_size(&all, size)
            .into_iter()
            .filter(|o| o.score.named_exactly)
            .collect();
        let errors: Vec<f64> = named.iter().flat_map(|o| o.score.errors.clone()).collect();
        let covered: usize = named.iter().map(|o| o.score.covered).sum();
        let percent = |share| {
            quantile(errors.iter().copied(), share)
                .map_or_else(|| "-".to_owned(), |e| format!("{:.2} %", 100.0 * e))
        };
        let middle = |values: Vec<f64>| median(values).map_or_else(|| "-".to_owned(), short);
        let _ = writeln!(
            text,
            "| {size} | {} | {} | {} | {covered}/{} | {} | {} |",
            named.len(),
            percent(0.5),
            percent(0.9),
            errors.len(),
            middle(named.iter().map(|o| o.score.overlap).collect()),
            middle(named.iter().filter_map(|o| o.score.prediction).collect()),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::super::case_conditions::CaseConditions;
    use super::super::outcome::Made;
    use super::super::score::CaseScore;
    use super::*;

    fn outcome(effect: Option<&str>, size: usize, answered: &[&str]) -> Outcome {
        let answered: Vec<String> = answered.iter().map(|s| (*s).to_owned()).collect();
        let truth: Vec<String> = effect.into_iter().map(str::to_owned).collect();
        Outcome {
            made: Made {
                effect: effect.map(str::to_owned),
                size,
                sizes: 2,
                seed: 7,
                duration_s: 5.0,
                conditions: CaseConditions::Laboratory,
            },
            share: 0.1f64.powi(size as i32),
            shows: 30.0,
            parameters: [("gain".to_owned(), 1.05)].into(),
            score: CaseScore {
                case: String::new(),
                named_exactly: answered == truth,
                truth,
                answered: Some(answered),
                stated: Vec::new(),
                explained_fully: None,
                unlisted: false,
                verdict_right: true,
                placed: true,
                errors: vec![0.01],
                half_widths: vec![0.02],
                covered: 1,
                overlap: 0.9,
                prediction: Some(1.7),
                seconds: None,
                failure: None,
            },
        }
    }

    #[test]
    fn the_page_counts_what_was_answered() {
        let mut all = vec![
            outcome(Some("a"), 0, &["a"]),
            outcome(Some("a"), 0, &["a", "b"]),
            outcome(Some("a"), 1, &["a"]),
            outcome(Some("a"), 1, &[]),
            outcome(None, 0, &["c"]),
        ];
        all.extend((0..9).map(|_| outcome(None, 0, &[])));
        let page = page(&all);
        assert!(page.contains("1 false alarms in 10 devices"), "{page}");
        assert!(page.contains("- seed 7: c"));
        // Size 1 is seen in half of the devices, which is not most.
        assert!(
            page.contains("| a | 1/2 | 1/2 | 0 | 1.00 | 30.0 | gain 1.05 |"),
            "{page}"
        );
        assert!(page.contains("| a | itself 1, a + b 1 |"));
        assert!(page.contains("| a | itself 1, nothing 1 |"));
        assert!(
            page.contains("| 0 | 1 | 1.00 % | 1.00 % | 1/1 | 0.900 | 1.70 |"),
            "{page}"
        );
    }
}

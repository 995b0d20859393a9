//! A diagnosis of a removal table as diagnosis.json has it, and in sentences.

use super::law::{Deviation, TableRow};
use super::select::{EffectValue as Value, Left, RemovalDiagnosis, Rival};
use crate::diagnosis::answer::account::SectionKind;
use crate::diagnosis::answer::details::{
    DETAILS_SCHEMA, Details, FamilyMember, FamilyReport, NextExperiment, PredictionError,
};
use crate::diagnosis::answer::estimate::Estimate;
use crate::diagnosis::answer::family::family;
use crate::diagnosis::answer::statements::{TRUSTED, doubts_of, in_headline, stated};
use crate::diagnosis::answer::{Alternative, Answer, FoundEffect, SCHEMA, Verdict};
use crate::quantity::{counted, significant};

/// Half width of an exponent's interval beyond which the table does not tell it.
const VAGUE: f64 = 0.3;

/// What the account is of.
pub struct AnswerContext<'a> {
    /// Name of the case.
    pub case: &'a str,
    /// Whether the tool moves with a feed.
    pub is_feed: bool,
    /// Rows of less weight.
    pub rows_of_model: usize,
    /// Rows kept back.
    pub unseen: &'a [TableRow],
}

/// The answer.
#[must_use]
pub fn answer(diagnosis: &RemovalDiagnosis, context: &AnswerContext<'_>, seconds: f64) -> Answer {
    let mut details = Details {
        schema: DETAILS_SCHEMA,
        case: context.case.to_owned(),
        ..Details::default()
    };
    details.account.headline = headline(diagnosis);
    let effects = diagnosis.effects.iter();
    let found: Vec<String> = effects
        .map(|value| sentence(diagnosis, value, context.is_feed))
        .collect();
    let parts = [
        (SectionKind::Missing, found),
        (SectionKind::Remaining, left(diagnosis)),
        (SectionKind::Ambiguous, ambiguous(diagnosis)),
        (
            SectionKind::RuledOut,
            not_needed(diagnosis, context.is_feed),
        ),
        (SectionKind::UnseenRun, unseen(diagnosis, context.unseen)),
        (
            SectionKind::NextExperiment,
            next(diagnosis, context.is_feed),
        ),
        (SectionKind::Recordings, rows(diagnosis, context)),
    ];
    for (kind, paragraphs) in parts {
        details.account.add(kind, paragraphs);
    }
    details.families = families(diagnosis);
    details.prediction = predictions(diagnosis, context.unseen);
    details.next_experiment = experiment(diagnosis);
    let [before, after] = [diagnosis.before.log, diagnosis.after.log].map(|rms| rms * rms);
    details.explained_share = (before > 0.0).then(|| (1.0 - after / before).max(0.0));
    Answer {
        schema: SCHEMA,
        verdict: if diagnosis.effects.is_empty() {
            Verdict::NothingMissing
        } else {
            Verdict::Explained
        },
        explained: None,
        effects: diagnosis
            .effects
            .iter()
            .map(|value| effect(diagnosis, value))
            .collect(),
        mismatch: Vec::new(),
        seconds,
        alternatives: diagnosis.rivals.iter().map(alternative).collect(),
        notes: Vec::new(),
        details,
    }
}

fn names(deviations: &[Deviation]) -> Vec<String> {
    deviations.iter().map(|of| of.name().to_owned()).collect()
}

/// The law of the force, whatever its form, where one is named.
fn families(diagnosis: &RemovalDiagnosis) -> Vec<FamilyReport> {
    let own = |of: Deviation| diagnosis.effects.iter().find(|v| v.deviation == of);
    let (any, forms) = &diagnosis.by_force;
    let Some(family) = (forms.iter())
        .find(|(of, _)| own(*of).is_some())
        .and_then(|(of, _)| family(of.name(), None))
    else {
        return Vec::new();
    };
    let mut members: Vec<FamilyMember> = (forms.iter())
        .map(|(of, probability)| FamilyMember {
            name: of.name().to_owned(),
            key: None,
            probability: own(*of).map_or(*probability, |v| effect(diagnosis, v).confidence),
            number: None,
        })
        .collect();
    members.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    let likeliest = members.first().map_or(0.0, |m| m.probability);
    vec![FamilyReport {
        name: family.name.to_owned(),
        words: family.words.to_owned(),
        probability: any.max(likeliest),
        members,
    }]
}

fn alternative(rival: &Rival) -> Alternative {
    Alternative {
        effects: names(&rival.deviations),
        formula: None,
        odds: rival.odds,
    }
}

fn effect(diagnosis: &RemovalDiagnosis, value: &Value) -> FoundEffect {
    let scale = if value.deviation == Deviation::Coefficient {
        1e9
    } else {
        1.0
    };
    let [middle, low, high] = value.value.map(|v| v * scale);
    let nominal = diagnosis.nominal.number(value.deviation) * scale;
    let own = Estimate {
        without: Some(nominal).filter(|v| v.is_finite()),
        ..Estimate::new(middle, low, high)
    };
    let mut parameters = vec![(value.deviation.key().to_owned(), own)];
    if value.deviation == Deviation::Wear {
        let [middle, low, high] = losses(diagnosis, value);
        let loss = Estimate {
            without: Some(0.0),
            ..Estimate::new(middle, low, high)
        };
        parameters.push(("loss_over_table_percent".to_owned(), loss));
    }
    let depends = match value.deviation {
        Deviation::Coefficient => vec![],
        Deviation::Force | Deviation::Threshold | Deviation::Sag => vec!["force"],
        Deviation::Wear => vec!["wear"],
        Deviation::Speed => vec!["speed"],
        Deviation::Time => vec!["time"],
        Deviation::Area => vec!["area"],
    };
    let numbers: Vec<Estimate> = parameters.iter().map(|(_, e)| *e).collect();
    let doubts = doubts_of(&numbers);
    FoundEffect {
        name: value.deviation.name().to_owned(),
        key: None,
        subsystem: "process".to_owned(),
        confidence: stated(value.confidence, &doubts),
        doubts,
        parameters: parameters.into(),
        depends_on: depends.into_iter().map(str::to_owned).collect(),
        law: None,
        unlisted: None,
    }
}

/// Share lost from the least worn row to the most [%].
fn losses(diagnosis: &RemovalDiagnosis, value: &Value) -> [f64; 3] {
    let [least, most] = span(&diagnosis.rows, |row| row.wear);
    value
        .value
        .map(|rate| -100.0 * (-rate * (most - least)).exp_m1())
}

fn span(rows: &[TableRow], of: impl Fn(&TableRow) -> f64) -> [f64; 2] {
    let least = rows.iter().map(&of).fold(f64::INFINITY, f64::min);
    [
        least,
        rows.iter().map(&of).fold(f64::NEG_INFINITY, f64::max),
    ]
}

fn headline(diagnosis: &RemovalDiagnosis) -> String {
    let words = |of: Deviation| match of {
        Deviation::Coefficient => "another amount",
        Deviation::Force => "another exponent of the force",
        Deviation::Threshold => "a threshold force",
        Deviation::Sag => "a speed that sags under load",
        Deviation::Wear => "wear",
        Deviation::Speed => "another exponent of the speed",
        Deviation::Time => "another exponent of the time",
        Deviation::Area => "another exponent of the area",
    };
    let said = |value: &Value| {
        let effect = effect(diagnosis, value);
        let force = family(value.deviation.name(), None).is_some();
        match in_headline(effect.confidence, &effect.doubts) {
            _ if effect.confidence >= TRUSTED => Some(words(value.deviation)),
            _ if force && diagnosis.by_force.0 >= TRUSTED => {
                Some("another law of the force (a power or a threshold is open)")
            }
            true => Some(words(value.deviation)),
            false => None,
        }
    };
    let found: Vec<&str> = diagnosis.effects.iter().filter_map(said).collect();
    match found.split_last() {
        None if !diagnosis.effects.is_empty() => {
            "what the law of removal lacks is not settled: nothing is sure".to_owned()
        }
        None => "nothing is missing from the nominal law of removal".to_owned(),
        Some((last, [])) => format!("the law of removal lacks {last}"),
        Some((last, others)) => {
            format!("the law of removal lacks {} and {last}", others.join(", "))
        }
    }
}

/// A number with its interval: `2.05 (1.90 to 2.20)`.
fn number([value, low, high]: [f64; 3]) -> String {
    let half = 0.5 * (high - low);
    // As many decimals as the interval's half width deserves with two digits.
    let decimals = if half > 0.0 {
        (1.0 - half.log10().floor()).clamp(0.0, 12.0) as usize
    } else {
        3
    };
    format!("{value:.decimals$} (95 % of {low:.decimals$} to {high:.decimals$})")
}

fn sentence(diagnosis: &RemovalDiagnosis, value: &Value, is_feed: bool) -> String {
    let nominal = diagnosis.nominal.number(value.deviation);
    let exponent = |what: &str| {
        format!(
            "The removed volume grows as {what} to the power {}, nominal {}.",
            number(value.value),
            significant(nominal, 3)
        )
    };
    match value.deviation {
        Deviation::Coefficient => format!(
            "At the reference settings a new tool takes off {} mm3, nominal {}.",
            number(value.value.map(|v| v * 1e9)),
            significant(nominal * 1e9, 3)
        ),
        Deviation::Force => exponent(if diagnosis.found.threshold > 0.0 {
            "the force above the threshold"
        } else {
            "the force"
        }),
        Deviation::Speed => exponent("the cutting speed"),
        Deviation::Time if is_feed => {
            let [value, low, high] = value.value;
            format!(
                "The removed volume goes as the feed to the power {}, nominal {}.",
                number([-value, -high, -low]),
                significant(-nominal, 3)
            )
        }
        Deviation::Time => exponent("the grinding time"),
        Deviation::Area => exponent("the contact area"),
        Deviation::Threshold => format!(
            "Below a force of {} N nothing comes off, nominal {}.",
            number(value.value),
            significant(nominal, 3)
        ),
        Deviation::Sag => format!(
            "The cutting speed falls by {} % per newton of force, nominal {}.",
            number(value.value.map(|v| 100.0 * v)),
            significant(100.0 * nominal, 3)
        ),
        Deviation::Wear => format!(
            "The tool wears: from the freshest row to the most worn it loses {} % of what it takes off.",
            number(losses(diagnosis, value))
        ),
    }
}

/// Errors in words.
fn errors(left: &Left) -> String {
    format!(
        "{} RMS of the natural logarithm of the volume ({} % RMS of the predicted volume)",
        significant(left.log, 2),
        significant(100.0 * left.share, 2)
    )
}

fn left(diagnosis: &RemovalDiagnosis) -> Vec<String> {
    let mut text = format!("The nominal law leaves {}", errors(&diagnosis.before));
    text += &if diagnosis.effects.is_empty() {
        ".".to_owned()
    } else {
        format!(", what was found {}.", errors(&diagnosis.after))
    };
    vec![
        text,
        format!(
            "With each row predicted by a fit to the others it is {} RMS of the logarithm.",
            significant(diagnosis.left_out, 2)
        ),
    ]
}

fn ambiguous(diagnosis: &RemovalDiagnosis) -> Vec<String> {
    let rivals = diagnosis.rivals.iter().filter(|rival| rival.odds > 0.01).map(|rival| {
        let names = names(&rival.deviations).join(" + ").replace('_', " ");
        let odds = if rival.odds < 1.0 {
            format!("1 to {}", significant(1.0 / rival.odds, 2))
        } else {
            format!("{} to 1", significant(rival.odds, 2))
        };
        let rms = significant(rival.rms, 2);
        format!("In place of it {names} would do: odds {odds}, it leaves {rms} RMS of the logarithm.")
    });
    rivals.collect()
}

fn not_needed(diagnosis: &RemovalDiagnosis, is_feed: bool) -> Vec<String> {
    let describe = |value: &Value| {
        let [_, low, high] = value.value;
        let vague = 0.5 * (high - low) > VAGUE;
        let quantity = quantity(value.deviation, is_feed);
        match value.deviation {
            Deviation::Force | Deviation::Speed | Deviation::Time | Deviation::Area => {
                let sign = if value.deviation == Deviation::Time && is_feed {
                    -1.0
                } else {
                    1.0
                };
                let mut ends = value.value.map(|v| sign * v);
                if sign < 0.0 {
                    ends.swap(1, 2);
                }
                let finding = if vague {
                    "cannot be determined well"
                } else {
                    "need not differ from its nominal value"
                };
                format!(
                    "The exponent of the {quantity} {finding}: left free it is {}.",
                    number(ends)
                )
            }
            Deviation::Threshold => {
                format!(
                    "A threshold force is not needed; it is below {} N if there is one.",
                    significant(high, 2)
                )
            }
            Deviation::Sag => {
                format!(
                    "A speed that sags is not needed; it is less than {} % per newton if it does.",
                    significant(100.0 * high, 2)
                )
            }
            Deviation::Wear => {
                let [_, _, high] = losses(diagnosis, value);
                format!(
                    "Wear is not needed; over the table the tool loses less than {} % if it wears.",
                    significant(high.max(0.0), 2)
                )
            }
            Deviation::Coefficient => format!(
                "The amount at the reference settings is nominal: left free it is {} mm3.",
                number(value.value.map(|v| v * 1e9))
            ),
        }
    };
    let mut sentences: Vec<String> = diagnosis.not_needed.iter().map(describe).collect();
    let undetermined: Vec<&str> = diagnosis
        .unreported
        .iter()
        .map(|of| quantity(*of, is_feed))
        .collect();
    if !undetermined.is_empty() {
        sentences.push(format!(
            "The table cannot tell how the volume depends on {}: not stated, the same in all rows, or bound to what was found.",
            undetermined.join(", ")
        ));
    }
    sentences
}

fn quantity(of: Deviation, is_feed: bool) -> &'static str {
    match of {
        Deviation::Coefficient => "amount",
        Deviation::Force => "force",
        Deviation::Threshold => "threshold force",
        Deviation::Sag => "sag of the speed",
        Deviation::Wear => "wear",
        Deviation::Speed => "cutting speed",
        Deviation::Time if is_feed => "feed",
        Deviation::Time => "grinding time",
        Deviation::Area => "contact area",
    }
}

fn unseen(diagnosis: &RemovalDiagnosis, rows: &[TableRow]) -> Vec<String> {
    if rows.is_empty() {
        return Vec::new();
    }
    let [before, after] = [&diagnosis.nominal, &diagnosis.found].map(|law| Left::of(law, rows));
    let nothing = match after.nothing {
        0 => String::new(),
        some => format!(
            " Of {} it predicts nothing, or a setting is not known.",
            counted(some, "row")
        ),
    };
    vec![format!(
        "Of {} that were kept back it is {} off, the nominal law {}.{nothing}",
        counted(after.rows, "row"),
        errors(&after),
        errors(&before)
    )]
}

/// A row of the settings at which a rival says something else, and the ratio of what the two predict there.
fn distinguishable(diagnosis: &RemovalDiagnosis, rival: &Rival) -> Option<(TableRow, f64)> {
    let at = &diagnosis.found.reference;
    let [least, most] = span(&diagnosis.rows, |row| row.force);
    let row = |force: f64| TableRow {
        table: String::new(),
        line: 0,
        force,
        time: at.time,
        speed: at.speed,
        area: at.area,
        wear: span(&diagnosis.rows, |row| row.wear)[0],
        volume: f64::NAN,
        weight: 1.0,
        scatter: 0.0,
    };
    [0.6 * least, 1.5 * most]
        .into_iter()
        .map(|force| {
            let row = row(force);
            let apart =
                diagnosis.found.volume_of(&row).max(1e-15) / rival.law.volume_of(&row).max(1e-15);
            (row, apart)
        })
        .filter(|(_, apart)| apart.is_finite())
        .max_by(|(_, a), (_, b)| a.ln().abs().total_cmp(&b.ln().abs()))
}

fn next(diagnosis: &RemovalDiagnosis, is_feed: bool) -> Vec<String> {
    let mut proposals = Vec::new();
    let rival = diagnosis.rivals.first().filter(|rival| rival.odds > 0.01);
    if let Some(rival) = rival
        && let Some((row, apart)) = distinguishable(diagnosis, rival)
    {
        let names = names(&rival.deviations).join(" + ").replace('_', " ");
        let [found, other] = [&diagnosis.found, &rival.law].map(|law| law.volume_of(&row) * 1e9);
        let (many, beyond) = (
            if apart > 1.0 { apart } else { 1.0 / apart },
            diagnosis.after.log,
        );
        let runs = ((3.0 * beyond / many.ln()).powi(2).ceil()).clamp(1.0, 99.0);
        proposals.push(format!(
            "Runs at {} N tell what was found from {names}: {} against {} mm3 there, at the reference settings otherwise; {} would do.",
            significant(row.force, 2),
            significant(found, 2),
            significant(other, 2),
            counted(runs as usize, "run"),
        ));
    }
    for of in &diagnosis.unreported {
        if matches!(
            of,
            Deviation::Speed | Deviation::Time | Deviation::Area | Deviation::Force
        ) {
            proposals.push(format!(
                "Runs at twice and at half the {}, all else as it was, would tell its exponent.",
                quantity(*of, is_feed)
            ));
        }
    }
    for value in &diagnosis.not_needed {
        let [_, low, high] = value.value;
        let exponent = matches!(
            value.deviation,
            Deviation::Speed | Deviation::Time | Deviation::Area
        );
        if exponent && 0.5 * (high - low) > VAGUE {
            proposals.push(format!(
                "A wider range of the {} would tell its exponent.",
                quantity(value.deviation, is_feed)
            ));
        }
    }
    proposals
}

fn experiment(diagnosis: &RemovalDiagnosis) -> Option<NextExperiment> {
    let rival = diagnosis.rivals.first().filter(|rival| rival.odds > 0.01)?;
    let (row, apart) = distinguishable(diagnosis, rival)?;
    let found: Vec<Deviation> = diagnosis.effects.iter().map(|v| v.deviation).collect();
    Some(NextExperiment {
        name: "force_beyond_the_table".to_owned(),
        instruction: format!("runs at {} N", significant(row.force, 2)),
        from: names(&rival.deviations),
        found: names(&found),
        sigmas: apart.ln().abs() / diagnosis.after.log.max(1e-6),
        seconds: 0.0,
        others: Vec::new(),
    })
}

fn rows(diagnosis: &RemovalDiagnosis, context: &AnswerContext<'_>) -> Vec<String> {
    let mut notes = vec![format!(
        "{} were fitted.",
        counted(diagnosis.rows.len(), "row")
    )];
    if context.rows_of_model > 0 {
        notes.push(format!(
            "{} of the table are marked as no measurements of their own and count less; they scatter less than measurements may, so that what is left is a lower bound.",
            counted(context.rows_of_model, "row")
        ));
    }
    let lines = |rows: &[TableRow]| {
        let lines: Vec<String> = rows
            .iter()
            .map(|row| format!("{} line {}", row.table, row.line))
            .collect();
        lines.join(", ")
    };
    if !diagnosis.incomplete.is_empty() {
        notes.push(format!(
            "{} could not be used, as a setting is not known or nothing came off: {}.",
            counted(diagnosis.incomplete.len(), "row"),
            lines(&diagnosis.incomplete)
        ));
    }
    if !diagnosis.aside.is_empty() {
        notes.push(format!(
            "{} lie further off than scatter puts one in a hundred tables, and were not fitted to (the errors above count them): {}.",
            counted(diagnosis.aside.len(), "row"),
            lines(&diagnosis.aside)
        ));
    }
    notes
}

fn predictions(diagnosis: &RemovalDiagnosis, unseen: &[TableRow]) -> Vec<PredictionError> {
    let error = |recording: &str, before: f64, after: f64| PredictionError {
        recording: recording.to_owned(),
        channel: "log_removed_volume".to_owned(),
        nominal: before,
        before,
        after,
        noise: None,
        before_sigmas: None,
        after_sigmas: None,
    };
    let mut errors = vec![error(
        "left out in turn",
        diagnosis.before.log,
        diagnosis.left_out,
    )];
    let [before, after] = [&diagnosis.nominal, &diagnosis.found].map(|law| Left::of(law, unseen));
    if after.rows > 0 && before.rows > 0 {
        errors.push(error("rows kept back", before.log, after.log));
    }
    errors
}

//! diagnosis.rrd: what a diagnosis found, as a screen for Rerun's viewer.

use crate::diagnosis::answer::Answer;
use crate::diagnosis::answer::words::{
    CHANNEL_UNITS, capital, display_name, of_column, reference_noise,
};
use crate::diagnosis::difference::comparison::{Balance, Compared, ComparedChannel, Comparison};
use crate::diagnosis::difference::mismatch::Mismatch;
use crate::diagnosis::formula::unlisted::report::{ShapeRow, UnlistedReport};
use crate::diagnosis::recordings::recorded::COLUMNS;
use crate::document::{Document, kept, markdown};
use crate::plant::CHANNELS;
use crate::report::{lacking as lacking_of, robust_range, variable};
use crate::scene::Scene;
use crate::scene::board::{Board, BoardLine, BoardRole, Cloud, CloudGroup, Lane, Sheet, SheetPlot};
use crate::stats::{NORMAL_95, quantile};

/// Recordings that are drawn at most; tabs beyond would not fit the screen.
const MOST_SHEETS: usize = 10;
/// Samples of a recording that are drawn at most.
const MOST_SAMPLES: usize = 60_000;
/// Start of a recording from which its heading tells it [s].
const LATE: f64 = 0.05;
/// Points of a cloud at most, evenly over the samples: more are a blot.
const MOST_POINTS: usize = 4000;
/// Noise bands that a plot of what is left shows at least [1].
const BANDS_SHOWN: f64 = 2.5;
/// Share of the samples that such a plot holds at least, and the room beyond them [1].
const USUAL: f64 = 0.96;
const ROOM: f64 = 1.5;
/// Share of a cloud's points to either side that its axes need not reach [1].
const OUTERMOST: f64 = 0.005;
/// Values that a variable has at most for its points to be spread; how far from each, to what side, and in what order.
const FEW: usize = 5;
const SPREAD: f64 = 0.2;
const SIDE: f64 = 0.13;
const GOLDEN: f64 = 0.618_034;
/// The part of the device that each of its channels tells of.
const SUBSYSTEMS: [&str; CHANNELS.len()] = ["regulator", "piston", "contact", "piston"];

/// The part that a column tells of; a column that is not of a device is of an arm.
fn subsystem(column: &str) -> &'static str {
    let place = COLUMNS.iter().position(|own| *own == column);
    match place {
        Some(place) => SUBSYSTEMS[place],
        None if column.starts_with("wrench_") => "wrench sensor",
        None => "joints",
    }
}

/// The screen of a diagnosis; `scene` is what a cell looks like.
pub(super) fn board(
    answer: &Answer,
    comparison: &Comparison,
    scene: Option<Scene>,
    report: &Document<'_>,
) -> Board {
    let of_flange = !answer.details.runs.is_empty();
    let shown = shown(&comparison.recordings);
    let sheets: Vec<Sheet> = shown
        .iter()
        .map(|recording| sheet(answer, recording, of_flange))
        .collect();
    let thinned = shown.iter().any(|r| r.time.len() > MOST_SAMPLES);
    let left_out = comparison.recordings.len() - shown.len();
    let effects = answer.effects.iter();
    let unlisted = effects.filter_map(|effect| effect.unlisted.as_deref());
    let clouds = unlisted.map(of_unlisted);
    // The link that lacks most in front.
    let lacking = |balance: &&Balance| {
        let mut links = answer.details.links.iter();
        let own = links.find(|link| link.link == balance.link);
        own.map_or(0.0, |link| link.sigmas)
    };
    let mut balances: Vec<&Balance> = comparison.balances.iter().collect();
    balances.sort_by(|a, b| lacking(b).total_cmp(&lacking(a)));
    let clouds = clouds.chain(balances.into_iter().map(of_balance));
    Board {
        title: format!("Diagnosis of {}", answer.details.case),
        text: markdown(report) + &not_drawn(left_out, thinned),
        clouds: clouds.collect(),
        sheets,
        scene,
    }
}

/// A note on what of the recordings is not drawn; nothing where all is.
fn not_drawn(left_out: usize, thinned: bool) -> String {
    let mut notes = Vec::new();
    if left_out > 0 {
        notes.push(format!("{left_out} more recordings are not drawn"));
    }
    if thinned {
        let thinned =
            "of long recordings the least and the largest value of each stretch are drawn";
        notes.push(thinned.to_owned());
    }
    match notes.is_empty() {
        true => String::new(),
        false => {
            let notes = capital(&notes.join("; "));
            format!("\n*{notes}: comparison.parquet holds every sample.*\n")
        }
    }
}

/// The recordings that are drawn: the first, and what was kept from the fit.
fn shown(recordings: &[Compared]) -> Vec<&Compared> {
    let unseen = recordings.iter().filter(|r| r.unseen).count();
    let fitted = recordings.iter().filter(|r| !r.unseen);
    let room = MOST_SHEETS.saturating_sub(unseen);
    let unseen = recordings.iter().filter(|r| r.unseen);
    fitted.take(room).chain(unseen).collect()
}

fn sheet(answer: &Answer, recording: &Compared, of_flange: bool) -> Sheet {
    let start = recording.time.first().copied().unwrap_or_default();
    let all = recording.channels.iter();
    let all: Vec<&[f64]> = all
        .flat_map(|c| [&c.measured[..], &c.nominal, &c.improved])
        .collect();
    let kept = kept(recording.time.len(), &all, &[], MOST_SAMPLES);
    let mut rows: Vec<&ComparedChannel> = recording.channels.iter().collect();
    rows.sort_by(|a, b| lacking(answer, recording, b).total_cmp(&lacking(answer, recording, a)));
    let title = match (recording.unseen, of_flange) {
        (true, false) => format!("{} (not fitted to)", recording.name),
        (true, true) => format!("{} (predicted)", recording.name),
        _ => recording.name.clone(),
    };
    // Sheets share a timeline, so that each begins at nought; the words of the account are in the recording's own time.
    let title = match start.abs() > LATE {
        true => format!("{title}, from {start:.1} s on"),
        false => title,
    };
    Sheet {
        title,
        time: kept.iter().map(|i| recording.time[*i] - start).collect(),
        lanes: lanes(answer, recording, start),
        rows: rows
            .into_iter()
            .map(|channel| row(answer, channel, &kept, of_flange))
            .collect(),
    }
}

/// Robust error of the nominal model in a channel of a recording, over its noise [1]: what differs most is drawn first.
fn lacking(answer: &Answer, recording: &Compared, channel: &ComparedChannel) -> f64 {
    let column = &channel.column;
    let fitted = answer.details.misfit.iter();
    let fitted = fitted.filter(|m| m.recording == recording.name && m.channel == *column);
    let kept = answer.details.prediction.iter();
    let kept = kept.filter(|e| e.recording == recording.name && e.channel == *column);
    let sizes = fitted.map(|m| m.tolerated_sigmas);
    let sizes = sizes.chain(kept.filter_map(|e| e.before_sigmas));
    sizes.fold(0.0, f64::max)
}

/// A channel beside the models, and what they leave of it with the band of its noise.
fn row(
    answer: &Answer,
    channel: &ComparedChannel,
    kept: &[usize],
    of_flange: bool,
) -> Vec<SheetPlot> {
    let (name, unit, factor) = of_column(&channel.column);
    let words = capital(&name);
    let is_known = |values: &[f64]| values.iter().any(|value| value.is_finite());
    let line = |label: &str, role, value: &dyn Fn(usize) -> f64| BoardLine {
        label: format!("{label} [{unit}]"),
        role,
        values: kept.iter().map(|i| factor * value(*i)).collect(),
    };
    let before = if of_flange { "desired" } else { "nominal" };
    let models = [
        (&channel.nominal, before, BoardRole::Nominal),
        (&channel.improved, "improved", BoardRole::Improved),
    ];
    let models = models.into_iter().filter(|(values, ..)| is_known(values));
    let measured = is_known(&channel.measured);
    let own = measured.then(|| line("measured", BoardRole::Measured, &|i| channel.measured[i]));
    let lines = models
        .clone()
        .map(|(values, label, role)| line(label, role, &|i| values[i]));
    let mut plots = vec![SheetPlot {
        title: format!("{words} [{unit}]"),
        lines: own.into_iter().chain(lines).collect(),
        ..SheetPlot::default()
    }];
    if measured {
        let left = models.map(|(values, label, role)| {
            let left = |i: usize| channel.measured[i] - values[i];
            line(&format!("measured less {label}"), role, &left)
        });
        let left: Vec<BoardLine> = left.collect();
        let noise = answer.details.noise.iter();
        let noise = noise.filter(|noise| noise.channel == channel.column);
        let guides = noise.flat_map(|noise| {
            let half = NORMAL_95 * factor * noise.standard_deviation;
            let reference_noise = reference_noise(answer.details.remaining.is_some());
            [half, -half].map(|end| (format!("95 % of {reference_noise} [{unit}]"), end))
        });
        let guides: Vec<(String, f64)> = guides.collect();
        plots.push(SheetPlot {
            title: format!("{words}: what is left [{unit}]"),
            range: usual_range(&left, &guides),
            lines: left,
            guides,
        });
    }
    plots
}

/// A range in which what is left can be read beside its noise: an impact may be a hundred times as high.
fn usual_range(lines: &[BoardLine], guides: &[(String, f64)]) -> Option<[f64; 2]> {
    let band = guides.iter().map(|(_, value)| value.abs());
    let mut most = BANDS_SHOWN * band.fold(0.0, f64::max);
    for line in lines {
        let sizes = line.values.iter().map(|value| value.abs());
        let usual = quantile(sizes.filter(|size| size.is_finite()), USUAL);
        most = most.max(ROOM * usual.unwrap_or_default());
    }
    (most > 0.0).then_some([-most, most])
}

/// When the channels differ from the nominal model, a lane for each.
fn lanes(answer: &Answer, recording: &Compared, start: f64) -> Vec<Lane> {
    let state = match &answer.effects[..] {
        [only] => only.name.replace('_', " "),
        _ => "differs from the model".to_owned(),
    };
    let lane = |channel: &ComparedChannel| {
        let column = &channel.column;
        let own = |m: &&Mismatch| m.recording == recording.name && m.channel == *column;
        let flagged = answer.mismatch.iter().filter(own);
        let mut spans: Vec<(f64, f64, String)> = flagged
            .map(|m| (m.start_s - start, m.end_s - start, state.clone()))
            .collect();
        spans.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut apart: Vec<(f64, f64, String)> = Vec::new();
        for span in spans {
            match apart.last_mut() {
                Some(last) if span.0 <= last.1 => last.1 = last.1.max(span.1),
                _ => apart.push(span),
            }
        }
        Lane {
            name: format!("{}: {}", subsystem(column), of_column(column).0),
            spans: apart,
        }
    };
    let lanes = recording.channels.iter().map(lane);
    lanes.filter(|lane| !lane.spans.is_empty()).collect()
}

/// Residual of a link against the variable that explains it, before and after.
fn of_balance(balance: &Balance) -> Cloud {
    let (unit, factor) = CHANNEL_UNITS[balance.channel as usize];
    let (words, of, scale) = variable(&balance.variable);
    let known = |i: &usize| balance.values[*i].is_finite() && balance.before[*i].is_finite();
    let known: Vec<usize> = (0..balance.values.len()).filter(known).collect();
    let stride = known.len().div_ceil(MOST_POINTS).max(1);
    let kept: Vec<usize> = known.into_iter().step_by(stride).collect();
    let mut sorted: Vec<f64> = kept.iter().map(|i| balance.values[*i]).collect();
    sorted.sort_by(f64::total_cmp);
    // The few points of an impact would press all others flat.
    let drawn = robust_range(&balance.before).unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let is_drawn = |lacking: f64| (drawn[0]..=drawn[1]).contains(&lacking);
    let outermost = (OUTERMOST * sorted.len() as f64) as usize;
    let low = sorted.get(outermost).copied().unwrap_or_default();
    let high = sorted.iter().rev().nth(outermost).copied();
    let high = high.unwrap_or_default();
    // Of a variable with few values, points would lie on one another: they are spread, those of the models side by side.
    let mut apart = sorted;
    apart.dedup();
    let is_discrete = apart.len() <= FEW;
    let group = |label: &str, role, lacking: &[f64], side: f64| {
        let pairs = kept.iter().map(|i| (balance.values[*i], lacking[*i]));
        let within = pairs
            .enumerate()
            .filter(|(_, (value, lacking))| (low..=high).contains(value) && is_drawn(*lacking));
        let spread = |index: usize| match is_discrete {
            true => side + SPREAD * ((GOLDEN * index as f64).fract() - 0.5),
            false => 0.0,
        };
        let points: Vec<[f64; 2]> = within
            .map(|(i, (value, lacking))| [scale * value + spread(i), factor * lacking])
            .collect();
        let known = kept.iter().filter(|i| lacking[**i].is_finite());
        let label = match known.count() - points.len() {
            0 => label.to_owned(),
            beyond => format!("{label} ({beyond} points beyond)"),
        };
        CloudGroup {
            label,
            role,
            points,
            joined: false,
        }
    };
    Cloud {
        title: capital(lacking_of(balance)),
        horizontal: format!("{words} [{of}]"),
        vertical: format!("what it lacks [{unit}]"),
        groups: vec![
            group("nominal", BoardRole::Nominal, &balance.before, -SIDE),
            group("improved", BoardRole::Improved, &balance.after, SIDE),
        ],
    }
}

/// A model discrepancy against its variable, with its 95 % band where it is known better than by its own size.
fn of_unlisted(report: &UnlistedReport) -> Cloud {
    let (_, at_unit, at) = display_name(&format!("x_{}", report.at_unit));
    let (_, unit, of) = display_name(&format!("x_{}", report.value_unit));
    let known = |row: &&ShapeRow| row.half_width < report.peak_to_peak;
    let line = |label: &str, role, side: f64| CloudGroup {
        label: label.to_owned(),
        role,
        points: report
            .shape
            .iter()
            .filter(known)
            .map(|row| [at * row.at, of * (row.value + side * row.half_width)])
            .collect(),
        joined: true,
    };
    let over = match report.period_s {
        Some(_) => "time within the period",
        None => variable(&report.variable).0,
    };
    let port = report.port.replace('_', " ");
    Cloud {
        title: "The model discrepancy".to_owned(),
        horizontal: format!("{} [{at_unit}]", over.replace('_', " ")),
        vertical: format!("{port} [{unit}]"),
        groups: vec![
            line("95 % from", BoardRole::Guide, -1.0),
            line("to", BoardRole::Guide, 1.0),
            line("the term", BoardRole::Improved, 0.0),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(spans: &[(f64, f64)]) -> Answer {
        let mut answer: Answer = serde_json::from_str(
            r#"{"schema":1,"verdict":"nothing_missing","effects":[],"mismatch":[],"seconds":0.0,"alternatives":[]}"#,
        )
        .unwrap();
        answer.mismatch = spans
            .iter()
            .map(|(start_s, end_s)| Mismatch {
                recording: "a.csv".to_owned(),
                channel: "force_n".to_owned(),
                start_s: *start_s,
                end_s: *end_s,
            })
            .collect();
        answer
    }

    fn compared(name: &str, unseen: bool, count: usize) -> Compared {
        let values = |offset: f64| (0..count).map(|i| i as f64 + offset).collect();
        Compared {
            name: name.to_owned(),
            unseen,
            time: (0..count).map(|i| 5.0 + 1e-3 * i as f64).collect(),
            channels: vec![ComparedChannel {
                column: "force_n".to_owned(),
                measured: values(0.0),
                nominal: values(2.0),
                tolerated: values(1.0),
                improved: values(-1.0),
                left_out: values(-2.0),
            }],
        }
    }

    #[test]
    fn a_sheet_starts_at_nought_and_shows_what_is_left() {
        let recording = compared("a.csv", false, 100);
        let sheet = sheet(&answer(&[(5.02, 5.03), (5.0, 5.025)]), &recording, false);
        assert_eq!(sheet.time[0], 0.0);
        assert_eq!(sheet.lanes[0].name, "contact: force");
        assert_eq!(sheet.lanes[0].spans.len(), 1);
        assert!((sheet.lanes[0].spans[0].1 - 0.03).abs() < 1e-12);
        let left = &sheet.rows[0][1];
        assert_eq!(left.lines[0].values[7], -2.0);
        assert_eq!(left.lines[1].values[7], 1.0);
        assert_eq!(left.lines[1].label, "measured less improved [N]");
    }

    #[test]
    fn long_recordings_are_thinned_and_many_are_left_out_but_the_unseen_stays() {
        let mut recordings: Vec<Compared> = (0..20)
            .map(|i| compared(&format!("{i}.csv"), false, 10))
            .collect();
        recordings.push(compared("last.csv", true, 300_000));
        let comparison = Comparison {
            recordings,
            balances: Vec::new(),
        };
        let board = board(&answer(&[]), &comparison, None, &Document::default());
        assert_eq!(board.sheets.len(), MOST_SHEETS);
        let last = board.sheets.last().unwrap();
        assert_eq!(last.title, "last.csv (not fitted to), from 5.0 s on");
        assert!(last.time.len() < 2 * MOST_SAMPLES, "{}", last.time.len());
        assert!(board.text.contains("11 more recordings"), "{}", board.text);
        assert!(board.text.contains("comparison.parquet"));
    }
}

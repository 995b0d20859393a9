//! fit.svg of a contact flange: of each run the recorded and the simulated force, as it lands and as it comes to rest.

use super::super::error::AppError;
use crate::diagnosis::answer::Answer;
use crate::diagnosis::difference::comparison::{Compared, Comparison};
use crate::document::{Figure, Horizontal, Panel, Role, Series, Stroke};
use crate::figure::svg;

/// Runs drawn at most: the one that it never saw first.
const MOST: usize = 4;
/// Times shown of each run, from contact on [s].
const SHOWN: [(&str, [f64; 2]); 2] = [("impact", [-0.01, 0.12]), ("to rest", [0.1, 1.0])];

/// The picture, if a flange was simulated.
pub(super) fn picture(
    answer: &Answer,
    comparison: &Comparison,
) -> Result<Option<String>, AppError> {
    let Some(flange) = &answer.details.flange else {
        return Ok(None);
    };
    let mut recordings: Vec<&Compared> = comparison.recordings.iter().collect();
    recordings.sort_by_key(|run| !run.unseen);
    let mut panels = Vec::new();
    for run in recordings.into_iter().take(MOST) {
        let Some(simulated) = flange.runs.iter().find(|r| r.recording == run.name) else {
            continue;
        };
        let known = match simulated.fitted {
            true => "fitted",
            false => "predicted",
        };
        let contact = touches(run);
        for (what, [from, to]) in SHOWN {
            panels.push(panel(run, (known, what), contact, [from, to]));
        }
    }
    Ok(Some(svg(&Figure {
        title: "Contact force, recorded and simulated".to_owned(),
        panels,
    })?))
}

/// First time at which the recorded force is a tenth of its largest [s].
fn touches(run: &Compared) -> f64 {
    let force = &run.channels[0].measured;
    let largest = force.iter().copied().fold(0.0, f64::max);
    let first = force.iter().position(|f| *f > 0.1 * largest);
    run.time[first.unwrap_or(0)]
}

fn panel<'a>(
    run: &Compared,
    (known, what): (&str, &str),
    contact: f64,
    [from, to]: [f64; 2],
) -> Panel<'a> {
    let at = |after: f64| run.time.partition_point(|t| *t < contact + after);
    let part = at(from)..at(to);
    let channel = &run.channels[0];
    let series = |label: &str, values: &[f64], role, stroke| {
        let time: Vec<f64> = run.time[part.clone()].iter().map(|t| t - contact).collect();
        Series::new(label, time, values[part.clone()].to_vec(), role, stroke)
    };
    Panel {
        title: format!("{what}, {known}"),
        vertical_label: "force [N]".to_owned(),
        // Each panel has its own stretch of time.
        horizontal: Horizontal::Quantity(format!("time after contact [s], {}", run.name)),
        series: vec![
            series("recorded", &channel.measured, Role::Measured, Stroke::Plain),
            series("desired", &channel.nominal, Role::Command, Stroke::Dashed),
            series(
                "simulated",
                &channel.improved,
                Role::Estimate,
                Stroke::Plain,
            ),
        ],
        ..Panel::default()
    }
}

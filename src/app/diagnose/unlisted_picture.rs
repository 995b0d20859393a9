//! unlisted.svg: a model discrepancy against its variable, with its 95 % band, what the recordings say is needed there, and the form that comes next.

use super::super::error::AppError;
use crate::diagnosis::answer::finding::Diagnosis;
use crate::diagnosis::answer::words::odds;
use crate::diagnosis::formula::unlisted::words::{self, DisplayQuantity};
use crate::diagnosis::formula::unlisted::{Shape, ShapePoint};
use crate::document::{Figure, Horizontal, Panel, Role, Series, Stroke};
use crate::figure::svg;
use crate::plant::Latent;

/// Half widths beyond so many times what the term moves through are not drawn: nothing was recorded there [1].
const UNKNOWN: f64 = 1.0;

/// The picture, if there is such a term.
pub(super) fn picture(diagnosis: &Diagnosis) -> Result<Option<String>, AppError> {
    let Some(shape) = &diagnosis.shape else {
        return Ok(None);
    };
    let mut figure = figure(shape);
    figure.panels[0].series.extend(next_form(diagnosis, shape));
    Ok(Some(svg(&figure)?))
}

/// The form that comes next, where it is a formula at the same port over the same variable.
fn next_form(diagnosis: &Diagnosis, shape: &Shape) -> Option<Series<'static>> {
    let rival = diagnosis.ranked[1..].iter().find(|ranked| {
        let same = |latent: &Latent| {
            (latent.port, latent.variable) == (shape.latent.port, shape.latent.variable)
        };
        ranked.hypothesis.formula().is_some() && ranked.hypothesis.unlisted().is_some_and(same)
    })?;
    if shape.period.is_some() {
        return None;
    }
    let latent = rival.hypothesis.unlisted()?;
    let text = rival.hypothesis.formula()?.law.expression.text();
    let (port, variable) = (words::port(latent.port), words::variable(latent.variable));
    let places = || shape.curve.iter().map(|row| row.at);
    Some(Series::new(
        format!("next form, odds {}: {text}", odds(rival.odds.log10())),
        places()
            .map(|at| at * variable.factor)
            .collect::<Vec<f64>>(),
        places()
            .map(|at| latent.shape(at) * port.factor)
            .collect::<Vec<f64>>(),
        Role::Command,
        Stroke::Dashed,
    ))
}

fn figure(shape: &Shape) -> Figure<'static> {
    let latent = &shape.latent;
    let port = words::port(latent.port);
    let variable = words::variable(latent.variable);
    let turns = if latent.directed {
        ", turning with the motion"
    } else {
        ""
    };
    let over = match shape.period {
        Some([period, _]) => format!("time within the period of {:.4} ms [ms]", 1e3 * period),
        None => format!("{} [{}]", variable.words, variable.unit),
    };
    Figure {
        title: format!("Explained by no known effect: {}{turns}", port.words),
        panels: vec![Panel {
            vertical_label: format!("{} [{}]", port.words, port.unit),
            horizontal: Horizontal::Quantity(over),
            series: series(shape, port, variable),
            ..Panel::default()
        }],
    }
}

fn series(shape: &Shape, port: DisplayQuantity, variable: DisplayQuantity) -> Vec<Series<'static>> {
    let at = |value: f64| match shape.period {
        None => value * variable.factor,
        Some(_) => 1e3 * value,
    };
    let places: Vec<f64> = shape.curve.iter().map(|row| at(row.at)).collect();
    let most = UNKNOWN * shape.peak_to_peak;
    let known = |row: &ShapePoint| row.half_width < most;
    let runs = shape.curve.chunk_by(|a, b| known(a) == known(b));
    let runs = runs.filter(|run| run.len() > 1 && known(&run[0]));
    let band = |(index, run): (usize, &[ShapePoint])| {
        let edge = |row: &ShapePoint, side: f64| (row.value + side * row.half_width) * port.factor;
        let there = run.iter().map(|row| (at(row.at), edge(row, -1.0)));
        let back = run.iter().rev().map(|row| (at(row.at), edge(row, 1.0)));
        let (places, values): (Vec<f64>, Vec<f64>) = there.chain(back).unzip();
        let label = if index == 0 { "95 % band" } else { "" };
        Series::new(label, places, values, Role::Band, Stroke::Area)
    };
    let mut series: Vec<Series<'static>> = runs.enumerate().map(band).collect();
    if !shape.needed.is_empty() {
        let needed = shape.needed.iter();
        series.push(Series::new(
            "needed by the recordings, medians",
            needed.clone().map(|n| at(n.at)).collect::<Vec<f64>>(),
            needed.map(|n| n.value * port.factor).collect::<Vec<f64>>(),
            Role::Measured,
            Stroke::Points,
        ));
    }
    let values: Vec<f64> = shape.curve.iter().map(|r| r.value * port.factor).collect();
    let found = Series::new(
        "fitted in the simulator",
        places,
        values,
        Role::Estimate,
        Stroke::Truth,
    );
    series.push(found);
    series
}

//! Something cannot be drawn.

use thiserror::Error;

use crate::document::{Figure, Horizontal, Panel, Series};

/// Why a figure cannot be drawn.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum FigureError {
    /// Nothing to draw.
    #[error("figure `{figure}` has no panels")]
    NoPanels {
        /// Its title.
        figure: String,
    },
    /// A panel without series.
    #[error("panel `{panel}` has no series")]
    NoSeries {
        /// Its vertical label.
        panel: String,
    },
    /// A series, band or marker that does not fit.
    #[error("{what} `{label}` of panel `{panel}` {reason}")]
    Misfit {
        /// Series, band or marker.
        what: &'static str,
        /// Its label.
        label: String,
        /// Vertical label of its panel.
        panel: String,
        /// Its fault, with the values.
        reason: String,
    },
    /// The drawing library refused.
    #[error("figure `{figure}` cannot be drawn: {reason}")]
    Drawing {
        /// Its title.
        figure: String,
        /// Message of the library.
        reason: String,
    },
}

/// Refuses what cannot be drawn.
pub(super) fn check(figure: &Figure) -> Result<(), FigureError> {
    if figure.panels.is_empty() {
        let figure = figure.title.clone();
        return Err(FigureError::NoPanels { figure });
    }
    figure.panels.iter().try_for_each(check_panel)
}

fn check_panel(panel: &Panel) -> Result<(), FigureError> {
    if panel.series.is_empty() {
        let panel = panel.vertical_label.clone();
        return Err(FigureError::NoSeries { panel });
    }
    for series in &panel.series {
        if let Some(reason) = fault(series, panel.horizontal == Horizontal::Time) {
            return Err(panel.misfit("series", &series.label, reason));
        }
    }
    for band in &panel.bands {
        let (from, to) = (band.from, band.to);
        if !(from.is_finite() && to.is_finite() && from < to) {
            let reason = format!("reaches from {from} to {to}; expected it to go up");
            return Err(panel.misfit("band", &band.label, reason));
        }
    }
    Ok(())
}

impl Panel<'_> {
    pub(super) fn misfit(&self, what: &'static str, label: &str, reason: String) -> FigureError {
        FigureError::Misfit {
            what,
            label: label.to_owned(),
            panel: self.vertical_label.clone(),
            reason,
        }
    }
}

fn fault(series: &Series, over_time: bool) -> Option<String> {
    let (places, values) = (&series.horizontal, &series.values);
    if places.len() != values.len() {
        let (places, values) = (places.len(), values.len());
        return Some(format!("has {values} values at {places} places"));
    }
    if values.iter().all(|value| value.is_nan()) {
        return Some("has no values".to_owned());
    }
    if let Some(index) = values.iter().position(|value| value.is_infinite()) {
        return Some(format!("has an infinite value, sample {index}"));
    }
    if let Some(index) = places.iter().position(|place| !place.is_finite()) {
        return Some(format!("has sample {index} at {}", places[index]));
    }
    let mut steps = places.windows(2);
    let index = steps.position(|pair| over_time && pair[0] >= pair[1])?;
    let (before, after) = (places[index], places[index + 1]);
    Some(format!(
        "has time {after} s after {before} s, sample {}; expected increasing times",
        index + 1
    ))
}

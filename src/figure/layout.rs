//! Where everything in a figure has its place.

use super::FigureError;
use super::canvas::text_width;
use super::trace::{PX, Scale};
use crate::document::{Figure, Horizontal, Panel, Series};

/// Width of the figure.
pub(super) const WIDTH: i32 = 960 * PX;
/// Left end of the plots.
pub(super) const LEFT: i32 = 80 * PX;
/// Right end of the plots.
pub(super) const RIGHT: i32 = 940 * PX;
/// Height of the figure's title.
pub(super) const TITLE_HEIGHT: i32 = 40 * PX;
/// Height of a row of the legend or of marker labels.
pub(super) const ROW: i32 = 21 * PX;
/// Length of a line in the legend.
pub(super) const KEY: i32 = 26 * PX;
/// Between two entries of the legend.
const KEY_GAP: i32 = 24 * PX;
/// Between a text and what it belongs to.
pub(super) const SPACE: i32 = 6 * PX;
/// Length of a tick.
pub(super) const TICK: i32 = 4 * PX;
/// Size of the texts.
pub(super) const NORMAL: i32 = 14 * PX;
/// Size of marker labels.
pub(super) const SMALL: i32 = 13 * PX;

/// The place of a text: its left end, and its row.
#[derive(Clone, Copy)]
pub(super) struct Spot {
    pub left: i32,
    pub row: i32,
}

/// A panel with everything in its place.
pub(super) struct Layout<'a> {
    pub panel: &'a Panel<'a>,
    pub horizontal: Scale,
    pub vertical: Scale,
    /// Whether the horizontal axis has its labels here.
    pub labelled: bool,
    /// Of the legend entries, rows counted from above.
    pub keys: Vec<Spot>,
    /// Of the markers that have labels, rows counted from the plot upwards.
    pub labels: Vec<Option<Spot>>,
    /// Upper edge of the panel.
    pub above: i32,
    /// Edges of its plot.
    pub top: i32,
    pub bottom: i32,
}

/// The panels of a figure, one below the other.
pub(super) fn layouts<'a>(figure: &'a Figure) -> Result<Vec<Layout<'a>>, FigureError> {
    let over_time = |panel: &&Panel| panel.horizontal == Horizontal::Time;
    let time = figure.panels.iter().filter(over_time);
    let time = Scale::new(time.flat_map(Panel::places), 0.0, 10.0);
    let mut above = if figure.title.is_empty() {
        SPACE
    } else {
        TITLE_HEIGHT
    };
    let mut layouts = Vec::new();
    for (index, panel) in figure.panels.iter().enumerate() {
        let (horizontal, height) = match panel.horizontal {
            Horizontal::Time => (time.clone(), 180 * PX),
            Horizontal::Quantity(_) => (Scale::new(panel.places(), 0.04, 10.0), 330 * PX),
        };
        let keys = key_spots(panel);
        let labels = label_spots(panel, &horizontal)?;
        let last_key = keys.last().map_or(0, |spot| spot.row + 1);
        let last_label = labels.iter().flatten().map(|spot| spot.row + 1).max();
        let headings = last_key.max(i32::from(!panel.title.is_empty()));
        let top = above + ROW * (headings + last_label.unwrap_or(0)) + TICK;
        let next = figure.panels.get(index + 1);
        layouts.push(Layout {
            vertical: match panel.within {
                Some(ends) => Scale::new(ends.into_iter(), 0.0, 7.0),
                None => Scale::new(panel.heights(), 0.06, 7.0),
            },
            labelled: !(over_time(&panel) && next.is_some_and(|next| over_time(&next))),
            bottom: top + height,
            panel,
            horizontal,
            keys,
            labels,
            above,
            top,
        });
        above = layouts.last().map_or(0, Layout::below);
    }
    Ok(layouts)
}

/// Legend entries one after the other behind the panel's title, in as many rows as they take.
fn key_spots(panel: &Panel) -> Vec<Spot> {
    let title = match text_width(&panel.title, NORMAL) {
        0 => 0,
        // Bold is wider.
        width => width * 11 / 10 + KEY_GAP,
    };
    let (mut left, mut row) = (LEFT + title, 0);
    let mut spots = Vec::new();
    for (label, _) in panel.keys() {
        let width = KEY + SPACE + text_width(label, NORMAL);
        if left + width > RIGHT && left > LEFT {
            (left, row) = (LEFT, row + 1);
        }
        spots.push(Spot { left, row });
        left += width + KEY_GAP;
    }
    spots
}

/// Marker labels right of their lines, or left where the picture ends. From the last to the first
/// each goes into the lowest row in which it and its line meet no later label.
fn label_spots(panel: &Panel, horizontal: &Scale) -> Result<Vec<Option<Spot>>, FigureError> {
    let mut order: Vec<usize> = (0..panel.markers.len()).collect();
    order.sort_by(|&a, &b| panel.markers[b].at.total_cmp(&panel.markers[a].at));
    let mut spots = vec![None; order.len()];
    let mut taken: Vec<i32> = Vec::new();
    for index in order {
        let marker = &panel.markers[index];
        let (low, high) = (horizontal.low, horizontal.high);
        if !(low <= marker.at && marker.at <= high) {
            let reason = format!(
                "stands at {}, the axis goes from {low} to {high}",
                marker.at
            );
            return Err(panel.misfit("marker", &marker.label, reason));
        }
        if marker.label.is_empty() {
            continue;
        }
        let line = across(horizontal, marker.at);
        let width = text_width(&marker.label, SMALL) + 2 * SPACE;
        let left = if line + width <= WIDTH {
            line
        } else {
            line - width
        };
        let row = taken.iter().position(|&from| left + width <= from);
        let row = row.unwrap_or(taken.len());
        taken.resize(taken.len().max(row + 1), left);
        taken[..=row].fill(left);
        let row = row as i32;
        spots[index] = Some(Spot { left, row });
    }
    Ok(spots)
}

/// Where a value lies from left to right.
pub(super) fn across(horizontal: &Scale, value: f64) -> i32 {
    LEFT + (horizontal.share(value) * f64::from(RIGHT - LEFT)).round() as i32
}

impl<'a> Panel<'a> {
    fn places(&self) -> impl Iterator<Item = f64> {
        let series = self.series.iter();
        series.flat_map(|series| series.horizontal.iter().copied())
    }

    fn heights(&self) -> impl Iterator<Item = f64> {
        let values = self
            .series
            .iter()
            .flat_map(|series| series.values.iter().copied());
        values.chain(self.bands.iter().flat_map(|band| [band.from, band.to]))
    }

    /// Texts of the legend, with their series or, for bands, none.
    pub(super) fn keys(&self) -> impl Iterator<Item = (&str, Option<&Series<'a>>)> {
        let series = self
            .series
            .iter()
            .map(|series| (series.label.as_str(), Some(series)));
        let bands = self.bands.iter().map(|band| (band.label.as_str(), None));
        series.chain(bands).filter(|(label, _)| !label.is_empty())
    }
}

impl Layout<'_> {
    /// Lower edge of the panel.
    pub fn below(&self) -> i32 {
        self.bottom + if self.labelled { 56 * PX } else { 16 * PX }
    }

    /// Where a value lies from top to bottom; on the edge if it lies beyond.
    pub fn up(&self, value: f64) -> i32 {
        let height = f64::from(self.bottom - self.top);
        self.bottom - (self.vertical.share(value).clamp(0.0, 1.0) * height).round() as i32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Marker, Role, Stroke};

    fn panel(labels: &[&str]) -> Panel<'static> {
        let series = labels.iter().map(|label| {
            let (time, values) = (vec![0.0, 16.0], vec![0.0, 1.0]);
            Series::new(*label, time, values, Role::Force, Stroke::Plain)
        });
        Panel {
            title: "Force".into(),
            series: series.collect(),
            ..Panel::default()
        }
    }

    #[test]
    fn legends_wrap_and_stay_above_the_plot() {
        let figure = Figure {
            title: String::new(),
            panels: vec![
                panel(&["load cell, filtered (delay 50 ms)"; 7]),
                panel(&[""]),
            ],
        };
        let layouts = layouts(&figure).unwrap();
        let [first, second] = &layouts[..] else {
            panic!("two panels")
        };
        assert_eq!(first.keys.last().unwrap().row, 2);
        for spot in &first.keys {
            let width = KEY + SPACE + text_width("load cell, filtered (delay 50 ms)", NORMAL);
            assert!(LEFT <= spot.left && spot.left + width <= RIGHT);
            assert!(first.above + ROW * (spot.row + 1) <= first.top);
        }
        assert!(second.keys.is_empty());
        assert!(first.below() <= second.above && second.above + ROW <= second.top);
        assert_eq!((first.labelled, second.labelled), (false, true));
    }

    #[test]
    fn marker_labels_meet_neither_each_other_nor_the_lines() {
        let mut panel = panel(&["force"]);
        panel.markers = (0..14)
            .map(|index| Marker {
                label: format!("command {index}"),
                at: f64::from((index * 5) % 14),
            })
            .collect();
        let scale = Scale::new([0.0, 16.0].into_iter(), 0.0, 10.0);
        let spots = label_spots(&panel, &scale).unwrap();
        let width = text_width("command 0", SMALL) + SPACE;
        let spots: Vec<Spot> = spots.into_iter().flatten().collect();
        assert_eq!(spots.len(), 14);
        assert!(spots.iter().any(|spot| spot.row > 0));
        for (a, &one) in spots.iter().enumerate() {
            for (b, &other) in spots.iter().enumerate() {
                let beside = one.left + width <= other.left || other.left + width <= one.left;
                assert!(a == b || one.row != other.row || beside);
                let crosses = one.left < other.left && other.left < one.left + width;
                assert!(!(crosses && one.row <= other.row));
            }
        }
        panel.markers = vec![Marker {
            label: "valve: retract".into(),
            at: 16.0,
        }];
        let spot = label_spots(&panel, &scale).unwrap()[0].unwrap();
        assert!(spot.left < RIGHT - width);
    }
}

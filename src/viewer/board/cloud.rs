//! Quantities against a variable. The viewer's plots know time alone, so these stand in a view of the plane, with axes of their own.

use ::rerun::{LineStrips2D, Points2D, Radius};

use super::super::colours::role_colour;
use crate::scene::board::Cloud;
use crate::scene::colour::Colour;
use crate::viewer::colours::{GREY, PALE_GREY, rerun_colour};
use crate::viewer::rrd::{RrdError, RrdWriter};

/// Width and height of the field in which points lie, in units of the view.
pub(super) const FIELD: [f64; 2] = [1600.0, 900.0];
/// Room around it for numbers and words: left, right, top, bottom.
pub(super) const ROOM: [f64; 4] = [210.0, 60.0, 130.0, 190.0];
/// Share of the range that stays free at either end.
const MARGIN: f64 = 0.06;
/// Numbers on an axis, about.
const TICKS: f64 = 6.0;
/// Distance at which the viewer writes below a point what belongs to it.
const BELOW: f32 = 28.0;
const GRID: Colour = [150, 150, 150, 70];

/// Entity of a cloud.
pub(super) fn entity(cloud: usize) -> String {
    format!("/balance_{}", cloud + 1)
}

/// One axis: the range that it shows.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Axis {
    low: f64,
    high: f64,
}

impl Axis {
    fn around(values: impl Iterator<Item = f64>) -> Self {
        let finite = values.filter(|value| value.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        if low > high {
            return Self {
                low: 0.0,
                high: 1.0,
            };
        }
        let span = high - low;
        let room = if span > 0.0 {
            MARGIN * span
        } else {
            0.5 * low.abs().max(1.0)
        };
        Self {
            low: low - room,
            high: high + room,
        }
    }

    /// Place within the range [1].
    fn place(self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// Round numbers within the range, with as many decimals as they need.
    fn ticks(self) -> Vec<(f64, String)> {
        let raw = (self.high - self.low) / TICKS;
        let power = 10f64.powf(raw.log10().floor());
        let factor = [1.0, 2.0, 5.0, 10.0];
        let factor = factor.into_iter().find(|f| f * power >= raw);
        let step = factor.unwrap_or(10.0) * power;
        let decimals = (-step.log10().floor()).max(0.0) as usize;
        let (first, last) = ((self.low / step).ceil(), (self.high / step).floor());
        let count = (last - first) as usize + 1;
        let tick = |index: usize| {
            let value = (first + index as f64) * step;
            // No minus before a nought.
            (value, format!("{:.decimals$}", value + 0.0))
        };
        (0..count).map(tick).collect()
    }
}

/// Where points of the axes lie in the view, whose y points down.
struct Field {
    horizontal: Axis,
    vertical: Axis,
}

impl Field {
    fn at(&self, [x, y]: [f64; 2]) -> [f32; 2] {
        let x = FIELD[0] * self.horizontal.place(x);
        let y = FIELD[1] * (1.0 - self.vertical.place(y));
        [x as f32, y as f32]
    }
}

/// Writes a cloud with its axes.
pub(super) fn write(rrd: &mut RrdWriter, entity: &str, cloud: &Cloud) -> Result<(), RrdError> {
    let points = || cloud.groups.iter().flat_map(|group| &group.points);
    let field = Field {
        horizontal: Axis::around(points().map(|point| point[0])),
        // What is lacking is seen against nought.
        vertical: Axis::around(points().map(|point| point[1]).chain([0.0])),
    };
    write_axes(rrd, entity, cloud, &field)?;
    let width = FIELD[0] / cloud.groups.len().max(1) as f64;
    for (index, group) in cloud.groups.iter().enumerate() {
        let colour = rerun_colour(role_colour(group.role));
        let own = format!("{entity}/{}", crate::viewer::options::slug(&group.label));
        let places: Vec<[f32; 2]> = group.points.iter().map(|p| field.at(*p)).collect();
        if group.joined {
            let line = LineStrips2D::new([places])
                .with_colors([colour])
                .with_radii([Radius::new_ui_points(1.2)])
                .with_draw_order(20.0 + index as f32);
            rrd.add_static(&own, &line)?;
        } else {
            let dots = Points2D::new(places)
                .with_colors([colour])
                .with_radii([Radius::new_ui_points(1.6)])
                .with_draw_order(20.0 + index as f32);
            rrd.add_static(&own, &dots)?;
        }
        // The legend: names above the field, each in its colour.
        let middle = [(width * (index as f64 + 0.5)) as f32, -45.0];
        let name = label([middle], [group.label.clone()], role_colour(group.role));
        rrd.add_static(&format!("{own}/name"), &name)?;
    }
    Ok(())
}

fn write_axes(
    rrd: &mut RrdWriter,
    entity: &str,
    cloud: &Cloud,
    field: &Field,
) -> Result<(), RrdError> {
    let (x, y) = (field.horizontal, field.vertical);
    let mut lines = vec![
        [[x.low, y.low], [x.low, y.high]],
        [[x.low, y.low], [x.high, y.low]],
    ];
    let frame = lines.len();
    let mut numbers: Vec<([f32; 2], String)> = Vec::new();
    for (value, text) in x.ticks() {
        lines.push([[value, y.low], [value, y.high]]);
        let [across, down] = field.at([value, y.low]);
        numbers.push(([across, down + 45.0 - BELOW], text));
    }
    for (value, text) in y.ticks() {
        lines.push([[x.low, value], [x.high, value]]);
        let [across, down] = field.at([x.low, value]);
        numbers.push(([across - 85.0, down - BELOW], text));
    }
    let colours = (0..lines.len()).map(|i| rerun_colour(if i < frame { GREY } else { GRID }));
    let strips = lines.iter().map(|line| line.map(|end| field.at(end)));
    let axes = LineStrips2D::new(strips)
        .with_colors(colours)
        .with_radii([Radius::new_ui_points(0.6)])
        .with_draw_order(10.0);
    rrd.add_static(&format!("{entity}/axes"), &axes)?;
    let (places, texts): (Vec<_>, Vec<_>) = numbers.into_iter().unzip();
    let numbers = label(places, texts, PALE_GREY);
    rrd.add_static(&format!("{entity}/axes/numbers"), &numbers)?;
    let below = [(0.5 * FIELD[0]) as f32, (FIELD[1] + 125.0) as f32 - BELOW];
    let words = label([below], [cloud.horizontal.clone()], PALE_GREY);
    rrd.add_static(&format!("{entity}/axes/variable"), &words)
}

/// Words at places, without a dot.
fn label(
    places: impl IntoIterator<Item = [f32; 2]>,
    texts: impl IntoIterator<Item = String>,
    colour: Colour,
) -> Points2D {
    Points2D::new(places)
        .with_labels(texts)
        .with_show_labels(true)
        .with_colors([rerun_colour(colour)])
        .with_radii([Radius::new_ui_points(0.01)])
        .with_draw_order(30.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within() {
        let axis = Axis {
            low: -0.31,
            high: 0.52,
        };
        let ticks: Vec<String> = axis.ticks().into_iter().map(|(_, text)| text).collect();
        assert_eq!(ticks, ["-0.2", "0.0", "0.2", "0.4"]);
        let large = Axis {
            low: 95.0,
            high: 1320.0,
        };
        let ticks: Vec<f64> = large.ticks().into_iter().map(|(value, _)| value).collect();
        assert_eq!(ticks, [500.0, 1000.0]);
    }

    #[test]
    fn an_axis_holds_its_values_and_exists_without_any() {
        let axis = Axis::around([2.0, f64::NAN, -2.0].into_iter());
        assert!(axis.low < -2.0 && axis.high > 2.0);
        let empty = Axis::around(std::iter::empty());
        assert_eq!((empty.low, empty.high), (0.0, 1.0));
        let one = Axis::around([3.0].into_iter());
        assert!(one.low < 3.0 && one.high > 3.0 && one.ticks().len() < 20);
        let field = Field {
            horizontal: axis,
            vertical: axis,
        };
        assert_eq!(field.at([0.0, 0.0]), [800.0, 450.0]);
        assert!(field.at([0.0, 1.0])[1] < 450.0, "y points up");
    }
}

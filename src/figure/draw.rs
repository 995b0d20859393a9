//! The painting of a figure whose parts have their places.

use std::collections::BTreeSet;

use plotters::style::{Color, RGBColor, ShapeStyle, WHITE};

use super::FigureError;
use super::canvas::{self, Anchor, Canvas, Drawn, fitting};
use super::layout::{
    KEY, LEFT, Layout, NORMAL, RIGHT, ROW, SMALL, SPACE, Spot, TICK, TITLE_HEIGHT, WIDTH, across,
    layouts,
};
use super::trace::{PX, Place, over_quantity, over_time};
use crate::document::{Figure, Horizontal, Role, Series, Stroke};

/// Size of the figure's title.
const LARGE: i32 = 18 * PX;
const FRAME: RGBColor = RGBColor(0x55, 0x55, 0x55);
const EVENT: RGBColor = RGBColor(0x99, 0x99, 0x99);
const GRID: RGBColor = RGBColor(0xE4, 0xE4, 0xE4);
const SHADE: RGBColor = RGBColor(0xCC, 0x79, 0xA7);

/// The figure as an SVG document.
pub(super) fn document(figure: &Figure) -> Result<String, FigureError> {
    let layouts = layouts(figure)?;
    let height = layouts.last().map_or(TITLE_HEIGHT, Layout::below);
    let paint = |canvas: &Canvas| {
        let size = fitting(&figure.title, LARGE, WIDTH - 8 * SPACE);
        let middle = (WIDTH / 2, TITLE_HEIGHT / 2);
        canvas.text(&figure.title, middle, size, Anchor::Centre)?;
        layouts.iter().try_for_each(|layout| layout.paint(canvas))
    };
    canvas::document(&figure.title, (WIDTH, height), paint).map_err(|reason| FigureError::Drawing {
        figure: figure.title.clone(),
        reason,
    })
}

impl Layout<'_> {
    fn paint(&self, canvas: &Canvas) -> Drawn {
        for span in &self.panel.spans {
            let [from, to] = span.map(|end| across(&self.horizontal, end).clamp(LEFT, RIGHT));
            canvas.area([(from, self.top), (to, self.bottom)], SHADE.mix(0.15))?;
        }
        for band in &self.panel.bands {
            let corners = [(LEFT, self.up(band.to)), (RIGHT, self.up(band.from))];
            canvas.area(corners, Role::Band.colour().mix(0.25))?;
        }
        self.paint_axes(canvas)?;
        self.paint_markers(canvas)?;
        let place = |horizontal, value| (across(&self.horizontal, horizontal), self.up(value));
        for series in &self.panel.series {
            let lines = match self.panel.horizontal {
                Horizontal::Time => over_time(series, place),
                Horizontal::Quantity(_) => over_quantity(series, place),
            };
            series.paint(canvas, &lines, series.style())?;
        }
        self.paint_legend(canvas)
    }

    fn paint_axes(&self, canvas: &Canvas) -> Drawn {
        let (top, bottom) = (self.top, self.bottom);
        let [grid, frame] = [GRID, FRAME].map(|colour| colour.stroke_width(PX as u32));
        let label = match &self.panel.horizontal {
            Horizontal::Time => "time [s]",
            Horizontal::Quantity(label) => label,
        };
        for (tick, text) in self.horizontal.ticks() {
            let x = across(&self.horizontal, tick);
            canvas.line(&[(x, top), (x, bottom)], grid)?;
            canvas.line(&[(x, bottom), (x, bottom + TICK)], frame)?;
            if self.labelled {
                canvas.text(&text, (x, bottom + 14 * PX), NORMAL, Anchor::Centre)?;
            }
        }
        for (tick, text) in self.vertical.ticks() {
            let y = self.up(tick);
            canvas.line(&[(LEFT, y), (RIGHT, y)], grid)?;
            canvas.line(&[(LEFT - TICK, y), (LEFT, y)], frame)?;
            canvas.text(&text, (LEFT - 2 * TICK, y), NORMAL, Anchor::Right)?;
        }
        let corners = [
            (LEFT, top),
            (RIGHT, top),
            (RIGHT, bottom),
            (LEFT, bottom),
            (LEFT, top),
        ];
        canvas.line(&corners, frame)?;
        if self.labelled {
            let middle = (i32::midpoint(LEFT, RIGHT), bottom + 34 * PX);
            canvas.text(label, middle, NORMAL, Anchor::Centre)?;
        }
        let label = &self.panel.vertical_label;
        let size = fitting(label, NORMAL, bottom - self.above);
        canvas.text(
            label,
            (2 * SPACE, i32::midpoint(top, bottom)),
            size,
            Anchor::Upwards,
        )
    }

    fn paint_markers(&self, canvas: &Canvas) -> Drawn {
        let placed = self.panel.markers.iter().zip(&self.labels);
        let middle = |spot: Spot| self.top - ROW * spot.row - ROW / 2;
        for (marker, spot) in placed.clone() {
            let x = across(&self.horizontal, marker.at);
            let end = spot.map_or(self.top, |spot| middle(spot) - 8 * PX);
            canvas.line(&[(x, end), (x, self.bottom)], EVENT.stroke_width(10))?;
        }
        for (marker, spot) in placed {
            let Some(spot) = *spot else { continue };
            let x = across(&self.horizontal, marker.at);
            let (y, left) = (middle(spot), spot.left + SPACE);
            if spot.left == x {
                canvas.text(&marker.label, (left, y), SMALL, Anchor::Left)?;
            } else {
                // Lines of earlier markers may pass here.
                canvas.area(
                    [(left, y - ROW / 2), (x - SPACE, y + ROW / 3)],
                    WHITE.mix(1.0),
                )?;
                canvas.text(&marker.label, (x - SPACE, y), SMALL, Anchor::Right)?;
            }
        }
        Ok(())
    }

    fn paint_legend(&self, canvas: &Canvas) -> Drawn {
        canvas.bold_text(&self.panel.title, (LEFT, self.above + ROW / 2), NORMAL)?;
        for ((label, series), spot) in self.panel.keys().zip(&self.keys) {
            let y = self.above + ROW * spot.row + ROW / 2;
            let (left, right) = (spot.left, spot.left + KEY);
            if let Some(series) = series {
                let line = match series.stroke {
                    Stroke::Points | Stroke::Mark => vec![(i32::midpoint(left, right), y)],
                    Stroke::Area => vec![
                        (left, y - SPACE),
                        (right, y - SPACE),
                        (right, y + SPACE),
                        (left, y + SPACE),
                    ],
                    _ => vec![(left, y), (right, y)],
                };
                // Thin lines are hard to tell apart alone.
                let style = series.style();
                let thick = style.stroke_width(style.stroke_width.max(18));
                series.paint(canvas, &[line], thick)?;
            } else {
                let corners = [(left, y - SPACE), (right, y + SPACE)];
                canvas.area(corners, Role::Band.colour().mix(0.25))?;
            }
            canvas.text(label, (right + SPACE, y), NORMAL, Anchor::Left)?;
        }
        Ok(())
    }
}

impl Series<'_> {
    fn style(&self) -> ShapeStyle {
        let (width, opacity) = match self.stroke {
            Stroke::Plain | Stroke::Dashed => (18, 1.0),
            Stroke::Raw => (10, 0.65),
            Stroke::Truth => (32, 1.0),
            Stroke::Points => (0, 0.8),
            Stroke::Mark => (0, 1.0),
            Stroke::Area => (0, 0.25),
        };
        self.role.colour().mix(opacity).stroke_width(width)
    }

    fn paint(&self, canvas: &Canvas, lines: &[Vec<Place>], style: ShapeStyle) -> Drawn {
        if let Stroke::Points | Stroke::Mark = self.stroke {
            let radius = if self.stroke == Stroke::Mark { 65 } else { 35 };
            // Of points that hide one another one is enough.
            let mut seen = BTreeSet::new();
            let mut visible = |&&(x, y): &&Place| seen.insert((x / (2 * PX), y / (2 * PX)));
            let mut points = lines.iter().flatten().filter(&mut visible);
            return points.try_for_each(|&point| canvas.dot(point, radius, style));
        }
        lines.iter().try_for_each(|line| match line[..] {
            // As a line it would be invisible.
            [alone] => canvas.dot(alone, style.stroke_width.max(15), style),
            _ if self.stroke == Stroke::Area => canvas.polygon(line, style),
            _ if self.stroke == Stroke::Dashed => canvas.dashed(line, style),
            _ => canvas.line(line, style),
        })
    }
}

impl Role {
    fn colour(self) -> RGBColor {
        match self {
            Self::Command => RGBColor(0x00, 0x00, 0x00),
            Self::Regulator | Self::Filtered => RGBColor(0x00, 0x72, 0xB2),
            Self::Chamber1 | Self::Force => RGBColor(0xD5, 0x5E, 0x00),
            Self::Chamber2 | Self::Stroke => RGBColor(0x00, 0x9E, 0x73),
            Self::Measured => RGBColor(0x56, 0xB4, 0xE9),
            Self::Estimate => RGBColor(0xCC, 0x79, 0xA7),
            Self::Band => RGBColor(0xE6, 0x9F, 0x00),
        }
    }
}

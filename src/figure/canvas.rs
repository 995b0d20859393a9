//! Canvas of a figure: lines, dots, areas and texts in an SVG document.
//!
//! The drawing library counts in whole units. A unit is a tenth of a pixel here: lines are smooth
//! and coordinates short.

use std::io;

use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::trace::{PX, Place};

pub(super) type Drawn = Result<(), DrawingAreaErrorKind<io::Error>>;

const FONT: &str = "Arial, Liberation Sans, Helvetica, sans-serif";
const DARK: RGBColor = RGBColor(0x22, 0x22, 0x22);
/// A dashed line has at most so many dashes, however ragged it is.
const MOST_DASHES: f64 = 300.0;

/// Where a text has its place.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Left,
    Centre,
    Right,
    /// In its middle, turned to run upwards.
    Upwards,
}

pub(super) struct Canvas<'a>(DrawingArea<SVGBackend<'a>, Shift>);

/// An SVG document of a name with what `paint` paints on it; the size is in pixels outside, in tenths inside.
pub(super) fn document(
    name: &str,
    (width, height): Place,
    paint: impl FnOnce(&Canvas) -> Drawn,
) -> Result<String, String> {
    let mut svg = String::new();
    let backend = SVGBackend::with_string(&mut svg, (width as u32, height as u32));
    let canvas = Canvas(backend.into_drawing_area());
    let painted = canvas.0.fill(&WHITE).and_then(|()| paint(&canvas));
    let painted = painted.and_then(|()| canvas.0.present());
    drop(canvas);
    painted.map_err(|error| error.to_string())?;
    let size = |unit: i32| format!("width=\"{}\" height=\"{}\"", width / unit, height / unit);
    let name = maud::html! { (name) }.into_string();
    let shown = format!(
        "{} stroke-linejoin=\"round\" role=\"img\" aria-label=\"{name}\"",
        size(PX)
    );
    Ok(svg.replacen(&size(1), &shown, 1))
}

impl Canvas<'_> {
    pub fn line(&self, places: &[Place], style: ShapeStyle) -> Drawn {
        self.0.draw(&PathElement::new(places, style))
    }

    pub fn dashed(&self, places: &[Place], style: ShapeStyle) -> Drawn {
        let side = |pair: &[Place]| {
            f64::from(pair[1].0 - pair[0].0).hypot(f64::from(pair[1].1 - pair[0].1))
        };
        let length: f64 = places.windows(2).map(side).sum();
        let dash = (length / MOST_DASHES).max(f64::from(7 * PX)) as i32;
        let places = places.iter().copied();
        self.0
            .draw(&DashedPathElement::new(places, dash, dash * 4 / 7, style))
    }

    pub fn dot(&self, place: Place, radius: u32, style: ShapeStyle) -> Drawn {
        self.0.draw(&Circle::new(place, radius, style.filled()))
    }

    pub fn polygon(&self, corners: &[Place], style: ShapeStyle) -> Drawn {
        self.0.draw(&Polygon::new(corners, style.filled()))
    }

    pub fn area(&self, corners: [Place; 2], colour: RGBAColor) -> Drawn {
        self.0.draw(&Rectangle::new(corners, colour.filled()))
    }

    /// A text around the height of its place, without what XML cannot hold; the library escapes
    /// the rest.
    pub fn text(&self, text: &str, place: Place, size: i32, anchor: Anchor) -> Drawn {
        self.write(text, place, size, anchor, FontStyle::Normal)
    }

    /// The same in bold, to the right of its place.
    pub fn bold_text(&self, text: &str, place: Place, size: i32) -> Drawn {
        self.write(text, place, size, Anchor::Left, FontStyle::Bold)
    }

    fn write(
        &self,
        text: &str,
        (x, y): Place,
        size: i32,
        anchor: Anchor,
        font: FontStyle,
    ) -> Drawn {
        if text.is_empty() {
            return Ok(());
        }
        let foreign =
            |letter: char| letter.is_control() || matches!(letter, '\u{FFFE}' | '\u{FFFF}');
        // The library divides sizes by 1.24, and half a capital is higher than its half an x.
        let font = FontDesc::new(FontFamily::Name(FONT), 1.24 * f64::from(size), font);
        let lower = size / 10;
        let (font, place, across) = match anchor {
            Anchor::Left => (font, (x, y + lower), HPos::Left),
            Anchor::Centre => (font, (x, y + lower), HPos::Center),
            Anchor::Right => (font, (x, y + lower), HPos::Right),
            Anchor::Upwards => (
                font.transform(FontTransform::Rotate270),
                (x + lower, y),
                HPos::Center,
            ),
        };
        let style = TextStyle::from(font)
            .color(&DARK)
            .pos(Pos::new(across, VPos::Center));
        self.0.draw_text(&text.replace(foreign, " "), &style, place)
    }
}

/// The greatest size up to `size` at which a text is not wider than `width`.
pub(super) fn fitting(text: &str, size: i32, width: i32) -> i32 {
    size.min(size * width / text_width(text, size).max(1))
}

/// DejaVu Sans, shown where neither Arial nor its like is installed, by the width of Arial.
const WIDEST: f64 = 1.15;

/// Width of a text in the widest of the fonts, rounded up.
pub(super) fn text_width(text: &str, size: i32) -> i32 {
    let width = |letter| match letter {
        'i' | 'j' | 'l' | '\'' => 0.23,
        'f' | 't' | 'I' | ' ' | '.' | ',' | ':' | ';' | '|' | '!' | '[' | ']' | '/' => 0.28,
        'r' | '(' | ')' | '-' => 0.34,
        'm' | 'w' | 'M' | 'W' | '%' | '@' => 0.9,
        'A'..='Z' => 0.72,
        _ => 0.57,
    };
    (text.chars().map(width).sum::<f64>() * WIDEST * f64::from(size)).ceil() as i32
}

//! What the pictures of a study share: sizes, colours, ranges and ticks of axes, limits.

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::design::error::DesignError;
use crate::design::result::{LimitState, StudyResult};

pub(super) const PX: i32 = 10;
pub(super) const WIDTH: i32 = 960 * PX;
pub(super) const FONT: &str = "Arial, Liberation Sans, Helvetica, sans-serif";
// The library writes four fifths of these.
pub(super) const TEXT: i32 = 17 * PX;
pub(super) const LARGE: i32 = 22 * PX;
// Colours that the colour-blind tell apart (M. Okabe and K. Ito, "Color Universal Design", 2008).
pub(super) const FRONT: RGBColor = RGBColor(0x00, 0x72, 0xB2);
pub(super) const CHOSEN: RGBColor = RGBColor(0xD5, 0x5E, 0x00);
pub(super) const LIMIT: RGBColor = RGBColor(0xCC, 0x79, 0xA7);
pub(super) const DARK: RGBColor = RGBColor(0x22, 0x22, 0x22);
pub(super) const GREY: RGBColor = RGBColor(0x66, 0x66, 0x66);
/// Of words beside what has these colours, dark enough to be read on white: 4.5 to 1 and more.
pub(super) const CHOSEN_WORDS: RGBColor = RGBColor(0xB3, 0x47, 0x00);
pub(super) const LIMIT_WORDS: RGBColor = RGBColor(0x9C, 0x3D, 0x75);
pub(super) const GRID: RGBColor = RGBColor(0xE4, 0xE4, 0xE4);
/// Room left around what must be seen, as a share of its extent: for the labels above the start and below the chosen design.
pub(super) const MARGIN: f64 = 0.12;

pub(super) type Chart<'a, 'b> =
    ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(super) type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// A picture of a name (words of this program) and a height as SVG.
///
/// # Errors
/// The drawing library refuses.
pub(super) fn svg(
    (name, height): (&str, i32),
    draw: impl FnOnce(&Area<'_>) -> Drawn,
) -> Result<String, DesignError> {
    let mut svg = String::new();
    let root = SVGBackend::with_string(&mut svg, (WIDTH as u32, height as u32)).into_drawing_area();
    let drawn = root.fill(&WHITE).and_then(|()| draw(&root));
    let drawn = drawn.and_then(|()| root.present());
    drop(root);
    drawn.map_err(|error| DesignError::Picture(error.to_string()))?;
    let size = format!("width=\"{WIDTH}\" height=\"{height}\"");
    let shown = format!(
        "width=\"{}\" height=\"{}\" role=\"img\" aria-label=\"{name}\"",
        WIDTH / PX,
        height / PX
    );
    Ok(svg.replacen(&size, &shown, 1))
}

/// A text of a size, with its place at its left in the middle.
pub(super) fn written(size: i32) -> TextStyle<'static> {
    let anchor = Pos::new(HPos::Left, VPos::Center);
    (FONT, size).into_font().color(&DARK).pos(anchor)
}

pub(super) fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}

/// Limits on a metric.
pub(super) fn limits_of<'a>(
    result: &'a StudyResult,
    key: &'a str,
) -> impl Iterator<Item = &'a LimitState> {
    let limits = result.chosen.limits.iter();
    limits.filter(move |limit| limit.key == key)
}

pub(super) fn inside([x, y]: [f64; 2], [across, up]: [(f64, f64); 2]) -> bool {
    (across.0..=across.1).contains(&x) && (up.0..=up.1).contains(&y)
}

/// A tick with as many decimals as its axis needs.
pub(super) fn tick(value: f64, (low, high): (f64, f64)) -> String {
    let step = (high - low) / 8.0;
    let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    let text = format!("{value:.decimals$}");
    let text = if text
        .trim_start_matches('-')
        .chars()
        .all(|c| c == '0' || c == '.')
    {
        text.trim_start_matches('-').to_owned()
    } else {
        text
    };
    text.replace('-', "\u{2212}")
}

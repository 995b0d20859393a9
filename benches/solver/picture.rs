//! Error against cost as a picture: the case that moves, and the small chambers.
//!
//! The drawing library counts in whole units; a unit is a tenth of a pixel here, so that the curves are smooth.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::peer::Call;
use super::table::{OWN, RENEWED, Row, STIFF};

const PX: i32 = 10;
const WIDTH: i32 = 1120 * PX;
const HEIGHT: i32 = 640 * PX;
/// Room for title and legend.
const HEADING: i32 = 130 * PX;
const FONT: &str = "Arial, Liberation Sans, Helvetica, sans-serif";
// The library writes four fifths of these.
const TEXT: i32 = 17 * PX;
const LARGE: i32 = 22 * PX;
const DARK: RGBColor = RGBColor(0x22, 0x22, 0x22);
const GREY: RGBColor = RGBColor(0x77, 0x77, 0x77);
const GRID: RGBColor = RGBColor(0xE4, 0xE4, 0xE4);
const ERRORS: Range<f64> = 1e-8..1.0;
const COSTS: Range<f64> = 0.1..600.0;
/// Demand on one step: error over full scale [1] and time [us].
const ASKED: (f64, f64) = (1e-4, 2.0);

type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Methods that are drawn: name in the table, ending of their settings, colour. Colours that the colour-blind tell apart (M. Okabe and K. Ito 2008).
const METHODS: [(&str, &str, RGBColor); 6] = [
    (OWN, "ledger", RGBColor(0xD5, 0x5E, 0x00)),
    ("ROS3", "sub-steps", RGBColor(0x77, 0x77, 0x77)),
    (
        "DOPRI5 (diff.-equations)",
        RENEWED,
        RGBColor(0x56, 0xB4, 0xE9),
    ),
    (
        "Radau5 (diff.-equations)",
        RENEWED,
        RGBColor(0x00, 0x72, 0xB2),
    ),
    ("TR-BDF2 (diffsol)", RENEWED, RGBColor(0x00, 0x9E, 0x73)),
    ("BDF (diffsol)", RENEWED, RGBColor(0xCC, 0x79, 0xA7)),
];
const PEER: &str = "LSODA (scipy: solve_ivp, odeint, ode)";

/// Errors and costs of a method on a case.
fn points(rows: &[Row], case: usize, name: &str, setting: &str) -> Vec<(f64, f64)> {
    let of_it = rows
        .iter()
        .filter(|row| row.name == name && row.setting.ends_with(setting));
    let measured = of_it.filter_map(|row| row.measured[case]);
    // The peer's window where there is a peer, else the whole run.
    let cost = |m: &super::watch::Measured| if case == STIFF { m.whole } else { m.inside };
    measured
        .filter(|m| m.error < ERRORS.end)
        .map(|m| (m.error.max(ERRORS.start), cost(&m)))
        .collect()
}

/// The picture as SVG.
pub fn svg(rows: &[Row], calls: &[Call]) -> Result<String, String> {
    let mut svg = String::new();
    draw(&mut svg, rows, calls).map_err(|error| error.to_string())?;
    let size = |unit: i32| format!("width=\"{}\" height=\"{}\"", WIDTH / unit, HEIGHT / unit);
    Ok(svg.replacen(&size(1), &size(PX), 1))
}

fn draw(svg: &mut String, rows: &[Row], calls: &[Call]) -> Drawn {
    let root = SVGBackend::with_string(svg, (WIDTH as u32, HEIGHT as u32)).into_drawing_area();
    root.fill(&WHITE)?;
    let (heading, panels) = root.split_vertically(HEADING);
    legend(&heading)?;
    let (left, right) = panels.split_horizontally(WIDTH / 2);
    let peer: Vec<_> = calls.iter().map(|c| (c.error, c.microseconds)).collect();
    panel(
        &left,
        "paper_step, 1 to 2.5 s: runs out, meets the load cell, presses",
        rows,
        0,
        &peer,
    )?;
    panel(
        &right,
        "small chambers: 0.3 cm\u{b3} behind 5 mm\u{b2}, retract",
        rows,
        STIFF,
        &[],
    )?;
    root.present()
}

fn style(size: i32) -> TextStyle<'static> {
    let anchor = Pos::new(HPos::Left, VPos::Center);
    (FONT, size).into_font().color(&DARK).pos(anchor)
}

fn legend(area: &Area<'_>) -> Drawn {
    let title = "Cost of one simulated millisecond against error, every solver restarted each millisecond as in a control loop";
    area.draw(&Text::new(title, (40 * PX, 26 * PX), style(LARGE)))?;
    let names = METHODS.map(|(name, _, colour)| (name, colour));
    for (index, (name, colour)) in names.into_iter().chain([(PEER, DARK)]).enumerate() {
        let (column, line) = (index as i32 % 4, index as i32 / 4);
        let (x, y) = (40 * PX + column * 250 * PX, (62 + 30 * line) * PX);
        area.draw(&Circle::new((x + 8 * PX, y), 5 * PX, colour.filled()))?;
        area.draw(&Text::new(name, (x + 22 * PX, y), style(TEXT)))?;
    }
    Ok(())
}

fn panel(area: &Area<'_>, title: &str, rows: &[Row], case: usize, peer: &[(f64, f64)]) -> Drawn {
    area.draw(&Text::new(
        title.to_owned(),
        (84 * PX, 12 * PX),
        style(TEXT),
    ))?;
    let mut chart = ChartBuilder::on(area)
        .margin_top(30 * PX)
        .margin_right(24 * PX)
        .margin_bottom(8 * PX)
        .x_label_area_size(56 * PX)
        .y_label_area_size(84 * PX)
        .build_cartesian_2d(ERRORS.log_scale(), COSTS.log_scale())?;
    chart
        .configure_mesh()
        .bold_line_style(GRID.stroke_width(PX as u32))
        .light_line_style(TRANSPARENT)
        .axis_style(GREY.stroke_width(PX as u32))
        .set_all_tick_mark_size(5 * PX)
        .label_style((FONT, TEXT).into_font().color(&DARK))
        .axis_desc_style((FONT, TEXT).into_font().color(&DARK))
        .x_desc("largest error over full scale")
        .y_desc("time [us]")
        .x_label_formatter(&|value| format!("{value:.0e}"))
        .y_label_formatter(&|value| format!("{value}"))
        .draw()?;
    let wanted = [(ERRORS.start, ASKED.1), ASKED, (ASKED.0, COSTS.start)];
    chart.draw_series([PathElement::new(wanted, DARK.stroke_width(PX as u32))])?;
    let words = (ERRORS.start * 1.5, COSTS.start * 1.25);
    chart.draw_series([Text::new("asked: in here", words, style(TEXT))])?;
    for (name, setting, colour) in METHODS {
        let points = points(rows, case, name, setting);
        let width = if name == OWN { 4 } else { 2 };
        let line = PathElement::new(points.clone(), colour.stroke_width((width * PX) as u32));
        chart.draw_series([line])?;
        chart.draw_series(
            points
                .iter()
                .map(|p| Circle::new(*p, 5 * PX, colour.filled())),
        )?;
    }
    chart.draw_series(peer.iter().map(|p| Circle::new(*p, 5 * PX, DARK.filled())))?;
    Ok(())
}

//! Figures: signals against time, or one quantity against another, as one SVG file.
//!
//! A [`Figure`] is plain data; the caller converts to the units that people read (bar, mm, N) and
//! writes them into the labels. [`svg`] draws panels one above the other, legends and event labels
//! above the data and never on it, in colours that the colour-blind tell apart (M. Okabe and K. Ito,
//! Color Universal Design, 2008), with as many points as the picture can show.

mod canvas;
mod draw;
mod error;
mod layout;
mod trace;

use crate::document::Figure;
pub use error::FigureError;
pub use trace::ticks;

/// Draws a figure as an SVG document, 960 px wide; the same figure gives the same bytes.
///
/// # Errors
/// Names the panel and the series, band or marker that cannot be drawn.
pub fn svg(figure: &Figure) -> Result<String, FigureError> {
    error::check(figure)?;
    draw::document(figure)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Band, Horizontal, Marker, Panel, Role, Series, Stroke};

    /// 16 s at 1 kHz of something between -1 and 1 that never stands still.
    fn ragged() -> (Vec<f64>, Vec<f64>) {
        let time = (0..16_000).map(|index| f64::from(index) * 1e-3);
        let values = (0..16_000).map(|index| f64::from((index * 7919) % 2001) * 1e-3 - 1.0);
        (time.collect(), values.collect())
    }

    fn one(series: Series) -> Figure {
        let panel = Panel {
            vertical_label: "force [N]".into(),
            series: vec![series],
            ..Panel::default()
        };
        Figure {
            title: "run".into(),
            panels: vec![panel],
        }
    }

    fn line<'a>(time: &'a [f64], values: &'a [f64]) -> Series<'a> {
        Series::new("truth", time, values, Role::Force, Stroke::Plain)
    }

    fn force_lines(svg: &str) -> Vec<&str> {
        let lines = svg.lines().filter(|line| line.starts_with("<polyline"));
        let force = lines.filter(|line| line.contains("\"#D55E00\""));
        force.collect()
    }

    #[test]
    fn a_figure_is_960_wide_and_always_the_same() {
        let (time, values) = ragged();
        let figure = one(line(&time, &values));
        let first = svg(&figure).unwrap();
        assert!(first.starts_with("<svg width=\"960\" height=\"301\" "));
        assert!(first.contains("viewBox=\"0 0 9600 3010\""));
        assert_eq!(first, svg(&figure).unwrap());
    }

    #[test]
    fn a_spike_of_one_sample_stays_in_its_pixel() {
        let (time, mut values) = ragged();
        values[9001] = 9.0;
        let svg = svg(&one(line(&time, &values))).unwrap();
        // The plot reaches from 80 to 940 px for 0 to 16 s and from 245 up to 65 px for -1 to 9,
        // widened by 6 % of that at both ends.
        let x = 800 + (8600.0 * 9.001 / 16.0_f64).round() as i32;
        let y = 2450 - (1800.0 * (9.0 + 1.6) / 11.2_f64).round() as i32;
        assert!(svg.contains(&format!(" {x},{y} ")));
    }

    #[test]
    fn the_largest_figure_in_use_stays_small() {
        let (time, values) = ragged();
        let signal = |stroke| Series::new("signal", &time, &values, Role::Force, stroke);
        let panel = || Panel {
            series: vec![
                signal(Stroke::Plain),
                signal(Stroke::Raw),
                signal(Stroke::Truth).stepwise(),
                signal(Stroke::Dashed).stepwise(),
            ],
            ..Panel::default()
        };
        let figure = Figure {
            title: String::new(),
            panels: vec![panel(), panel(), panel()],
        };
        let size = svg(&figure).unwrap().len();
        assert!(size < 300_000, "{size} bytes");
    }

    #[test]
    fn a_gap_splits_the_line_if_it_can_be_seen() {
        let time: Vec<f64> = (0..8).map(f64::from).collect();
        let values = [1.0, 2.0, f64::NAN, 3.0, 4.0, f64::NAN, 5.0, 6.0];
        let figure = one(line(&time, &values));
        // One of them is the legend's.
        assert_eq!(force_lines(&svg(&figure).unwrap()).len(), 4);
        let (time, mut values) = ragged();
        values[9001] = f64::NAN;
        let drawn = svg(&one(line(&time, &values))).unwrap();
        assert_eq!(force_lines(&drawn).len(), 2);
        values[9001..9050].fill(f64::NAN);
        let drawn = svg(&one(line(&time, &values))).unwrap();
        assert_eq!(force_lines(&drawn).len(), 3);
        assert!(!drawn.contains("NaN"));
    }

    #[test]
    fn texts_cannot_break_the_document() {
        let series = Series {
            label: "<a & \"b\">\u{1}\n".into(),
            ..line(&[0.0, 1.0], &[0.0, 1.0])
        };
        let svg = svg(&one(series)).unwrap();
        assert!(svg.contains("\n&lt;a &amp; &quot;b&quot;&gt;  \n</text>"));
        assert_eq!(svg.matches('<').count(), svg.matches('>').count());
    }

    #[test]
    fn points_over_a_quantity_may_come_in_any_order() {
        let series = Series::new(
            "levels",
            vec![3.0, 1.0, 2.0, 2.0],
            vec![300.0, 100.0, 200.0, 200.0],
            Role::Measured,
            Stroke::Points,
        );
        let mut figure = one(series);
        let error = svg(&figure).unwrap_err().to_string();
        assert!(error.contains("time 1 s after 3 s, sample 1"), "{error}");
        figure.panels[0].horizontal = Horizontal::Quantity("set pressure [bar]".into());
        let svg = svg(&figure).unwrap();
        assert!(svg.contains("set pressure [bar]"));
        // Three places, and the legend.
        assert_eq!(svg.matches("<circle").count(), 4);
    }

    #[test]
    fn what_cannot_be_drawn_is_refused_by_name() {
        let refuse = |figure: &Figure| svg(figure).unwrap_err().to_string();
        assert_eq!(refuse(&Figure::default()), "figure `` has no panels");
        let nan = [f64::NAN; 2];
        for (time, values, reason) in [
            (&[][..], &[][..], "has no values"),
            (&[0.0, 1.0], &nan, "has no values"),
            (&[0.0, 1.0], &[1.0], "has 1 values at 2 places"),
            (
                &[0.0, 1.0],
                &[1.0, f64::INFINITY],
                "has an infinite value, sample 1",
            ),
            (&[0.0, f64::NAN], &[1.0, 1.0], "has sample 1 at NaN"),
            (
                &[0.5, 0.5],
                &[1.0, 1.0],
                "has time 0.5 s after 0.5 s, sample 1; expected increasing times",
            ),
        ] {
            let expected = format!("series `truth` of panel `force [N]` {reason}");
            assert_eq!(refuse(&one(line(time, values))), expected);
        }
        let mut figure = one(line(&[0.0, 1.0], &[0.0, 1.0]));
        figure.panels[0].markers = vec![Marker {
            label: "late".into(),
            at: 1.5,
        }];
        assert!(refuse(&figure).contains("marker `late` of panel `force [N]` stands at 1.5"));
        figure.panels[0].bands = vec![Band {
            label: "6 %".into(),
            from: 2.0,
            to: 1.0,
        }];
        assert!(refuse(&figure).contains("band `6 %` of panel `force [N]` reaches from 2 to 1"));
        figure.panels[0].series.clear();
        assert_eq!(refuse(&figure), "panel `force [N]` has no series");
    }
}

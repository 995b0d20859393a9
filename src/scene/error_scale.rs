//! Colours of the force error along an edge, scaled to what is there: the same on a page and in the viewer.

use super::EdgePath;
use super::colour::{Colour, of_error};

const NO_CONTACT: Colour = [110, 110, 110, 255];

/// Share of the segments whose errors lie within the scale; what lies beyond has its last colour.
const WITHIN: f64 = 0.95;
/// Smallest scale, so that rounding errors are not painted as errors of the force [1].
const LEAST: f64 = 0.001;
/// Steps of a decade at which a scale ends.
const STEPS: [f64; 3] = [1.0, 2.0, 5.0];

/// From too little force over the right one to too much.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorScale {
    /// Relative force error at either end [1].
    pub end: f64,
}

impl ErrorScale {
    /// The scale on which the errors of an edge can be distinguished: the next of 0.1, 0.2, 0.5, 1, 2, 5 .. % within which 95 % of the segments lie.
    #[must_use]
    pub fn of(edge: &EdgePath) -> Self {
        let errors = edge.relative_force_error.iter();
        let mut sizes: Vec<f64> = errors.map(|e| e.abs()).filter(|e| e.is_finite()).collect();
        sizes.sort_by(f64::total_cmp);
        let place = (WITHIN * sizes.len() as f64).ceil() as usize;
        let size = sizes.get(place.saturating_sub(1)).copied().unwrap_or(0.0);
        let decades = (-3..2).map(|power| 10f64.powi(power));
        let mut ends = decades.flat_map(|decade| STEPS.map(|step| step * decade));
        let fits = |end: &f64| *end >= LEAST - 1e-12 && size <= *end * (1.0 + 1e-9);
        Self {
            end: ends.find(fits).unwrap_or(10.0),
        }
    }

    /// Blue too little, white right, vermilion too much, dark grey no contact (NaN).
    #[must_use]
    pub fn colour(self, relative_error: f64) -> Colour {
        if relative_error.is_nan() {
            return NO_CONTACT;
        }
        of_error((relative_error / self.end).clamp(-1.0, 1.0))
    }

    /// Its end in percent: `0.5`.
    #[must_use]
    pub fn percent(self) -> String {
        // One digit: a product may end in 0.30000000000000004.
        format!("{:.1e}", 100.0 * self.end)
            .parse::<f64>()
            .map_or_else(|_| String::new(), |percent| percent.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::super::colour::{PALE, TOO_LITTLE, TOO_MUCH};
    use super::*;

    fn scale(errors: &[f64]) -> ErrorScale {
        ErrorScale::of(&EdgePath {
            relative_force_error: errors.to_vec(),
            ..EdgePath::default()
        })
    }

    #[test]
    fn force_error_runs_from_blue_through_white_to_vermilion() {
        let scale = ErrorScale { end: 0.10 };
        assert_eq!(scale.colour(-0.10), TOO_LITTLE);
        assert_eq!(scale.colour(-3.0), TOO_LITTLE);
        assert_eq!(scale.colour(0.0), PALE);
        assert_eq!(scale.colour(f64::INFINITY), TOO_MUCH);
        assert_eq!(scale.colour(f64::NAN), NO_CONTACT);
        // Half-way between white and blue.
        assert_eq!(scale.colour(-0.05), [123, 180, 212, 255]);
    }

    #[test]
    fn the_scale_holds_nearly_all_and_not_much_more() {
        for (errors, percent) in [
            (vec![], "0.1"),
            (vec![1e-9; 50], "0.1"),
            (vec![0.004; 50], "0.5"),
            (vec![-0.02; 50], "2"),
            (vec![0.031, f64::NAN], "5"),
            (vec![1.5; 50], "200"),
        ] {
            assert_eq!(scale(&errors).percent(), percent, "{errors:?}");
        }
        // One segment in a hundred at the start does not press the rest flat.
        let mut errors = vec![0.004; 99];
        errors.push(0.7);
        assert_eq!(scale(&errors).percent(), "0.5");
    }
}

//! Colours that people with any colour vision can tell apart, the same for a signal in every run.

use crate::recording::scene::Colour;

/// The palette of Okabe and Ito (2008), without its black.
pub(super) const ORANGE: Colour = [230, 159, 0, 255];
pub(super) const SKY_BLUE: Colour = [86, 180, 233, 255];
pub(super) const GREEN: Colour = [0, 158, 115, 255];
pub(super) const YELLOW: Colour = [240, 228, 66, 255];
pub(super) const BLUE: Colour = [0, 114, 178, 255];
pub(super) const VERMILLION: Colour = [213, 94, 0, 255];
pub(super) const PURPLE: Colour = [204, 121, 167, 255];
pub(super) const GREY: Colour = [150, 150, 150, 255];
pub(super) const PALE_GREY: Colour = [215, 215, 215, 255];

/// Palette in the order in which series take their colours.
pub(super) const PALETTE: [Colour; 7] = [SKY_BLUE, ORANGE, GREEN, YELLOW, VERMILLION, PURPLE, BLUE];

/// Relative force error at which the colour of the edge path saturates.
pub(super) const FORCE_ERROR_AT_FULL_COLOUR: f64 = 0.10;

const NO_CONTACT: Colour = [110, 110, 110, 255];
const ON_TARGET: Colour = [245, 245, 245, 255];

/// Colour of a relative force error: blue too little, white right, vermillion too much, dark grey
/// no contact (NaN).
pub(super) fn force_error_colour(relative_error: f64) -> Colour {
    if relative_error.is_nan() {
        return NO_CONTACT;
    }
    let share = (relative_error / FORCE_ERROR_AT_FULL_COLOUR).clamp(-1.0, 1.0);
    let end = if share < 0.0 { BLUE } else { VERMILLION };
    let mut colour = ON_TARGET;
    for (value, end) in colour.iter_mut().zip(end) {
        let start = f64::from(*value);
        // Within 0 to 255 as a blend of two such values.
        *value = (start + share.abs() * (f64::from(end) - start)).round() as u8;
    }
    colour
}

/// As the viewer wants it.
pub(super) fn rerun_colour(colour: Colour) -> ::rerun::Color {
    let [red, green, blue, opacity] = colour;
    ::rerun::Color::from_unmultiplied_rgba(red, green, blue, opacity)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn force_error_runs_from_blue_through_white_to_vermillion() {
        assert_eq!(force_error_colour(-0.10), BLUE);
        assert_eq!(force_error_colour(-3.0), BLUE);
        assert_eq!(force_error_colour(0.0), ON_TARGET);
        assert_eq!(force_error_colour(0.10), VERMILLION);
        assert_eq!(force_error_colour(f64::INFINITY), VERMILLION);
        assert_eq!(force_error_colour(f64::NAN), NO_CONTACT);
        // Half-way between white and blue.
        assert_eq!(force_error_colour(-0.05), [123, 180, 212, 255]);
    }
}

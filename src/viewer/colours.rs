//! Colours that people with any colour vision can tell apart, the same for a signal in every run.

use crate::scene::board::BoardRole;
use crate::scene::colour::Colour;

/// The palette of Okabe and Ito (2008), without its black; its light colours darker, so that all are seen on the viewer's dark and on its light ground.
pub(super) const ORANGE: Colour = [200, 132, 0, 255];
pub(super) const SKY_BLUE: Colour = [50, 150, 215, 255];
pub(super) const GREEN: Colour = [0, 158, 115, 255];
pub(super) const YELLOW: Colour = [150, 140, 20, 255];
pub(super) const BLUE: Colour = [0, 114, 178, 255];
pub(super) const VERMILLION: Colour = [213, 94, 0, 255];
pub(super) const PURPLE: Colour = [204, 121, 167, 255];
pub(super) const GREY: Colour = [150, 150, 150, 255];
pub(super) const PALE_GREY: Colour = [140, 140, 140, 255];

/// Palette in the order in which series take their colours.
pub(super) const PALETTE: [Colour; 7] = [SKY_BLUE, ORANGE, GREEN, YELLOW, VERMILLION, PURPLE, BLUE];

/// As the viewer wants it.
pub(super) fn rerun_colour(colour: Colour) -> ::rerun::Color {
    let [red, green, blue, opacity] = colour;
    ::rerun::Color::from_unmultiplied_rgba(red, green, blue, opacity)
}

/// The colour of what is shown, the same in every picture.
pub(super) fn role_colour(role: BoardRole) -> Colour {
    match role {
        // Seen on the viewer's dark and on its light ground.
        BoardRole::Measured => GREY,
        BoardRole::Nominal => ORANGE,
        BoardRole::Improved => SKY_BLUE,
        BoardRole::Guide => YELLOW,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance of WCAG 2.
    fn luminance(colour: Colour) -> f64 {
        let linear = |value: u8| {
            let share = f64::from(value) / 255.0;
            match share <= 0.04045 {
                true => share / 12.92,
                false => ((share + 0.055) / 1.055).powf(2.4),
            }
        };
        0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2])
    }

    #[test]
    fn every_line_is_seen_in_the_light_theme_and_in_the_dark() {
        // WCAG asks 3 of what is drawn; the viewer's grounds are white and nearly black.
        for colour in PALETTE.into_iter().chain([GREY, PALE_GREY]) {
            let own = luminance(colour) + 0.05;
            let [light, dark] = [1.05 / own, own / (luminance([14, 17, 20, 255]) + 0.05)];
            assert!(
                light > 2.9 && dark > 2.9,
                "{colour:?}: {light:.2}, {dark:.2}"
            );
        }
    }
}

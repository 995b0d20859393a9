//! Colours of what is drawn of a recording; those of errors are distinct to people with any colour vision.

/// Red, green, blue and opacity, 0 to 255.
pub type Colour = [u8; 4];

pub(super) const TOO_LITTLE: Colour = [0, 114, 178, 255];
pub(super) const TOO_MUCH: Colour = [213, 94, 0, 255];
/// The colour of no error.
pub(super) const PALE: Colour = [245, 245, 245, 255];

/// From full blue of -1, too little, through pale to full vermilion of 1, too much.
pub(super) fn of_error(share: f64) -> Colour {
    let end = if share < 0.0 { TOO_LITTLE } else { TOO_MUCH };
    let mut colour = PALE;
    for (value, end) in colour.iter_mut().zip(end) {
        let start = f64::from(*value);
        // Within 0 to 255 as a blend of two such values.
        *value = (start + share.abs() * (f64::from(end) - start)).round() as u8;
    }
    colour
}

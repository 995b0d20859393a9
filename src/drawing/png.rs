//! An image as text, by the `png` crate.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

/// Red, green, blue and opacity, row by row, as a PNG in base64.
pub(super) fn base64_png(pixels: &[u8], [width, height]: [usize; 2]) -> String {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let written = encoder.write_header().and_then(|mut writer| {
        writer.write_image_data(pixels)?;
        writer.finish()
    });
    // Writing into memory fails only where the count of pixels is wrong: no picture rather than none of the results.
    match written {
        Ok(()) => STANDARD.encode(&bytes),
        Err(_) => String::new(),
    }
}

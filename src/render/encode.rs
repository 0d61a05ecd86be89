//! Pictures as files.

use std::io::{self, Write};

use super::stage::Image;

/// Writes a picture as PNG.
///
/// # Errors
/// What `out` answers.
pub fn write_png(image: &Image, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let mut encoder = png::Encoder::new(out, image.width(), image.height());
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(image.as_raw())?;
    Ok(writer.finish()?)
}

/// A moving picture that is being written.
pub struct Animation;

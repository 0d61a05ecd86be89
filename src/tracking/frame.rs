//! Pictures of a clip.

/// A picture: rows from the top, three bytes a pixel, sRGB.
#[derive(Debug, Clone, Copy)]
pub struct Frame<'a> {
    /// Width and height in pixels.
    pub size: [u32; 2],
    pixels: &'a [u8],
}

impl<'a> Frame<'a> {
    /// A picture of this width and height; `None` if it has no pixels, or not three bytes for each.
    pub fn new(size: [u32; 2], pixels: &'a [u8]) -> Option<Self> {
        let [width, height] = size.map(|side| side as usize);
        let bytes = width.checked_mul(height)?.checked_mul(3)?;
        (bytes > 0 && bytes == pixels.len()).then_some(Self { size, pixels })
    }

    /// The bytes of a row.
    pub(super) fn row(&self, y: usize) -> &'a [u8] {
        let bytes = self.size[0] as usize * 3;
        &self.pixels[y * bytes..(y + 1) * bytes]
    }

    /// Every `step`th pixel of every `step`th row, from the first one.
    pub(super) fn rows(
        &self,
        step: usize,
    ) -> impl Iterator<Item = impl Iterator<Item = [u8; 3]> + 'a> {
        let frame = *self;
        (0..self.size[1] as usize).step_by(step).map(move |y| {
            let pixels = frame.row(y).chunks_exact(3).step_by(step);
            pixels.map(|pixel| [pixel[0], pixel[1], pixel[2]])
        })
    }
}

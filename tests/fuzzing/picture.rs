//! Every file in place of a picture is read or refused: as an image, as the texture of a part, and as the map of a landscape.

use std::io::Cursor;

use image::{DynamicImage, ImageFormat, Rgb, RgbImage, Rgba, RgbaImage};
use okoshi::resolver::MemoryResolver;

use super::{drawing, files};

/// The longest picture that the search begins with, in bytes.
const LONGEST: usize = 16 << 10;

const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="100">
<image x="5" y="5" width="40" height="40" href="a.png"/>
<rect x="50" y="5" width="30" height="40"/><text x="55" y="20">B$Texture a.png</text>
<g><image x="100" y="5" width="80" height="60" href="a.png"/><text x="100" y="90">Land$Tiles 10</text></g></svg>"##;

pub(super) fn check(bytes: &[u8]) -> bool {
    drawing::check_compiled(DRAWING, &MemoryResolver::default().with("a.png", bytes));
    image::load_from_memory(bytes).is_ok()
}

/// Small pictures in every format that is read, with and without transparency, and those of the cases.
pub(super) fn seeds() -> Vec<Vec<u8>> {
    let opaque = RgbImage::from_fn(9, 7, |x, y| Rgb([30 * x as u8, 30 * y as u8, 99]));
    let holes = RgbaImage::from_fn(8, 8, |x, y| {
        Rgba([200, 9, 9, 255 * ((x / 3 + y) % 2) as u8])
    });
    let glass = RgbaImage::from_fn(5, 6, |x, y| Rgba([9, 200, 9, (40 * x + 9 * y) as u8]));
    let gray = DynamicImage::from(opaque.clone()).into_luma16();
    let pictures: [DynamicImage; 4] = [opaque.into(), holes.into(), glass.into(), gray.into()];
    let formats = [
        ImageFormat::Png,
        ImageFormat::Jpeg,
        ImageFormat::Gif,
        ImageFormat::WebP,
    ];
    let mut seeds = Vec::new();
    for (picture, format) in pictures.iter().flat_map(|one| formats.map(|of| (one, of))) {
        let mut file = Cursor::new(Vec::new());
        // Not every format holds every kind of pixel.
        if picture.write_to(&mut file, format).is_ok() {
            seeds.push(file.into_inner());
        }
    }
    let folders = files::case_folders().into_iter();
    let files = folders.flat_map(|folder| files::ending(&folder.to_string_lossy(), ".png"));
    seeds.extend(files.map(files::read).filter(|file| file.len() <= LONGEST));
    seeds
}

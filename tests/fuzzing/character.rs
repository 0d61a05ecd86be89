//! Every pair of pictures becomes a character, or is refused: pictures whose regions touch all borders, with noise and as JPEG files, too.

use std::io::Cursor;

use fastrand::Rng;
use image::{ImageFormat, Rgba, RgbaImage};
use okoshi::resolver::MemoryResolver;

use super::drawing;

/// Bytes before the pixels: width, height, palette, noise, kinds of the files, strings.
const HEAD: usize = 6;
/// The largest side of a picture, pixels.
const LARGEST: u8 = 96;
/// What the strings of the views may say.
const WORDS: [&str; 6] = [
    "",
    " Backing",
    " Mirror",
    " Mirror off",
    " Backing Mirror",
    " Match thesis",
];
const ANGLES: [&str; 4] = ["45 0", "90 0", "0 40", "-30 10"];

pub(super) fn check(bytes: &[u8]) -> bool {
    let Some((&[width, height, palette, noise, kinds, strings], pixels)) =
        bytes.split_first_chunk::<HEAD>()
    else {
        return false;
    };
    let [width, height] = [width, height].map(|side| u32::from(side % LARGEST) + 1);
    let (front, side) = pixels.split_at(pixels.len() / 2);
    let files = [(front, kinds & 1), (side, kinds & 2)].map(|(pixels, as_jpeg)| {
        let picture = picture(pixels, [width, height], palette, noise);
        encoded(&picture, as_jpeg != 0)
    });
    let [front, side] = files;
    let resolver = MemoryResolver::default()
        .with("front.png", front)
        .with("side.png", side);
    let words = WORDS[usize::from(strings) % WORDS.len()];
    let angles = ANGLES[usize::from(strings >> 4) % ANGLES.len()];
    let [x, y] = [width, height].map(|side| f64::from(side) / 2.0);
    let text = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="300" height="100">
<g><image width="{width}" height="{height}" href="front.png"/><text x="{x}" y="{y}" font-size="5">Eye</text>
<text x="1" y="99">C$View 0 0{words}</text></g>
<g><image x="150" width="{width}" height="{height}" href="side.png"/><text x="{}" y="{y}" font-size="5">Eye$Hidden</text>
<text x="151" y="99">C$View {angles}</text></g></svg>"#,
        150.0 + x
    );
    !drawing::check_compiled(&text, &resolver)
        .scene
        .nodes
        .is_empty()
}

/// A picture of a few colours: two bytes are a run, its colour and its length; what they leave over is of the last run's colour. Color 0
/// is transparent.
fn picture(runs: &[u8], [width, height]: [u32; 2], palette: u8, noise: u8) -> RgbaImage {
    let mut random = Rng::with_seed(u64::from(palette));
    let colors: [[u8; 3]; 8] = [(); 8].map(|()| [(); 3].map(|()| random.u8(..)));
    let mut picture = RgbaImage::new(width, height);
    let mut place = 0..width * height;
    for run in runs.chunks_exact(2) {
        let color = usize::from(run[0]) % (colors.len() + 1);
        // The last run goes on to the end.
        for index in place.by_ref().take(usize::from(run[1]) + 1) {
            let pixel = match color {
                0 => Rgba([0; 4]),
                color => {
                    let spread = i16::from(noise % 32);
                    let [r, g, b] = colors[color - 1].map(|channel| {
                        let off = random.i16(-spread..=spread);
                        (i16::from(channel) + off).clamp(0, 255) as u8
                    });
                    Rgba([r, g, b, 255])
                }
            };
            picture.put_pixel(index % width, index / width, pixel);
        }
    }
    picture
}

fn encoded(picture: &RgbaImage, as_jpeg: bool) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let written = if as_jpeg {
        let opaque = image::DynamicImage::from(picture.clone()).into_rgb8();
        opaque.write_to(&mut file, ImageFormat::Jpeg)
    } else {
        picture.write_to(&mut file, ImageFormat::Png)
    };
    written.expect("room in memory");
    file.into_inner()
}

/// Stripes, checks and rings that touch all borders, and a figure with a head, plain and with noise.
pub(super) fn seeds() -> Vec<Vec<u8>> {
    const SIDE: u8 = 48;
    let patterns: [fn(i32, i32) -> u8; 6] = [
        |x, _| 1 + (x / 6 % 5) as u8,
        |_, y| 1 + (y / 7 % 3) as u8,
        |x, y| 1 + ((x / 8 + y / 8) % 4) as u8,
        |x, y| 1 + (((x - 24).pow(2) + (y - 24).pow(2)) / 150 % 6) as u8,
        |x, y| match (x, y) {
            _ if (x - 24).pow(2) + (y - 14).pow(2) < 9 => 4,
            _ if (x - 24).pow(2) + (y - 14).pow(2) < 100 => 2,
            (16..32, 24..44) => 3,
            (8..16, 26..38) | (32..40, 26..38) => 5,
            _ => 0,
        },
        |x, y| ((x * 31 + y * 17) % 9) as u8,
    ];
    let mut seeds = Vec::new();
    for (index, pattern) in patterns.iter().enumerate() {
        let side = i32::from(SIDE);
        let colors = (0..side * side).map(|place| pattern(place % side, place / side));
        let mut runs: Vec<[u8; 2]> = Vec::new();
        for color in colors {
            match runs.last_mut() {
                Some([last, length]) if *last == color && *length < u8::MAX => *length += 1,
                _ => runs.push([color, 0]),
            }
        }
        // The second view is the first again.
        let runs = runs.concat().repeat(2);
        for (noise, kinds) in [(0, 0), (4, 0), (8, 3)] {
            let strings = (index + usize::from(noise)) as u8;
            let head = [SIDE - 1, SIDE - 1, 7, noise, kinds, strings << 4 | strings];
            seeds.push([&head[..], &runs].concat());
        }
    }
    seeds
}

//! Photographs that are made here, of drawings on paper.

use std::io::Cursor;

use fastrand::Rng;
use glam::{DMat3, DVec2, DVec3};
use image::codecs::jpeg::JpegEncoder;
use image::{DynamicImage, ImageEncoder as _, ImageFormat, Rgb, RgbImage};

use super::{TraceError, Traced, trace};
use crate::compile::{Options, compile};
use crate::geometry::{area, bounds};
use crate::resolver::MemoryResolver;

/// The sheet of paper, in millimetres.
const SHEET: DVec2 = DVec2::new(210.0, 297.0);
const PAPER: [f64; 3] = [247.0, 242.0, 227.0];
const SKIN: [f64; 3] = [240.0, 190.0, 150.0];
const SHIRT: [f64; 3] = [200.0, 60.0, 50.0];
const TROUSERS: [f64; 3] = [140.0, 140.0, 140.0];
const SHOES: [f64; 3] = [40.0, 40.0, 60.0];

/// What is drawn at a place of the sheet: a face with two eyes, a shirt, trousers with two legs, and shoes.
fn drawn(place: DVec2) -> Option<[f64; 3]> {
    let within = |from: [f64; 2], to: [f64; 2]| {
        place.cmpge(from.into()).all() && place.cmplt(to.into()).all()
    };
    let around = |middle: [f64; 2], radius: f64| place.distance(middle.into()) < radius;
    if around([97.0, 80.0], 3.5) || around([113.0, 80.0], 3.5) {
        Some(SHOES)
    } else if around([105.0, 85.0], 30.0) {
        Some(SKIN)
    } else if within([75.0, 113.0], [135.0, 180.0]) {
        Some(SHIRT)
    } else if within([80.0, 180.0], [102.0, 250.0]) || within([108.0, 180.0], [130.0, 250.0]) {
        Some(TROUSERS)
    } else if within([72.0, 250.0], [102.0, 262.0]) || within([108.0, 250.0], [138.0, 262.0]) {
        Some(SHOES)
    } else {
        None
    }
}

/// How a photograph is taken.
struct Shot {
    /// From pixels to millimetres on the sheet, projective.
    place: DMat3,
    table: [f64; 3],
    /// How much darker the shadow is.
    shadow: f64,
    /// The share of what is drawn that shows the paper, as with a crayon.
    gaps: f64,
}

impl Shot {
    /// A sheet that lies aslant on a dark table, with the shadow of a hand.
    fn aslant() -> Self {
        let seen = DMat3::from_cols_array_2d(&[
            [2.9, -0.3, 2e-4],
            [0.35, 2.75, 3e-4],
            [110.0, 110.0, 1.0],
        ]);
        Self {
            place: seen.inverse(),
            table: [95.0, 70.0, 50.0],
            shadow: 0.3,
            gaps: 0.0,
        }
    }

    fn taken(&self) -> RgbImage {
        let mut random = Rng::with_seed(7);
        let gap = |cell: DVec2| {
            let cell = cell.as_ivec2();
            let seed = (cell.x as u32).wrapping_mul(7919) ^ (cell.y as u32).wrapping_mul(104_729);
            Rng::with_seed(seed.into()).f64() < self.gaps
        };
        RgbImage::from_fn(900, 1000, |x, y| {
            let pixel = DVec2::new(x.into(), y.into());
            let place = self.place * DVec3::new(pixel.x, pixel.y, 1.0);
            let place = place.truncate() / place.z;
            let is_on_sheet = place.cmpge(DVec2::ZERO).all() && place.cmplt(SHEET).all();
            let color = if !is_on_sheet {
                self.table
            } else if gap((place / 0.7).floor()) {
                PAPER
            } else {
                drawn(place).unwrap_or(PAPER)
            };
            let aside = pixel.dot(DVec2::new(0.8, 0.6)) - 900.0;
            let light = 1.0 - 0.25 * pixel.x / 900.0 - self.shadow / (1.0 + (-aside / 30.0).exp());
            let texture = 1.0 + 0.02 * (random.f64() - 0.5);
            let noise = [(); 3].map(|()| 8.0 * (random.f64() - 0.5));
            let seen = [0, 1, 2].map(|at| color[at] * light * texture + noise[at]);
            Rgb(seen.map(|channel| channel.clamp(0.0, 255.0) as u8))
        })
    }
}

fn file(picture: &RgbImage, format: ImageFormat) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    picture.write_to(&mut file, format).expect("room in memory");
    file.into_inner()
}

struct Shape {
    /// sRGB, 0 to 255.
    color: DVec3,
    /// Square pixels.
    area: f64,
    /// The sides of its box, pixels.
    extent: DVec2,
}

/// The shapes of the drawing that was made from a file, which okoshi reads without an error.
fn shapes(traced: &Traced) -> Vec<Shape> {
    let compiled = compile(&traced.svg, &Options::default(), &MemoryResolver::default());
    assert!(!compiled.has_errors(), "{:?}", compiled.diagnostics);
    let shape = |shape: &crate::svg::Shape| {
        let (low, high) = bounds(&shape.outline).expect("a shape with an outline");
        Shape {
            color: DVec3::from(shape.paint.color.map(f64::from)),
            area: area(&shape.outline),
            extent: high - low,
        }
    };
    let shapes: Vec<Shape> = compiled.drawing.shapes.iter().map(shape).collect();
    assert_eq!(shapes.len(), traced.shapes);
    shapes
}

/// The largest shape of about this colour, in relation to that of the paper.
fn of_color(shapes: &[Shape], color: [f64; 3]) -> &Shape {
    let wanted = DVec3::from(color) / DVec3::from(PAPER) * 255.0;
    let like = shapes
        .iter()
        .filter(|shape| shape.color.distance(wanted) < 30.0);
    let found = like.max_by(|a, b| a.area.total_cmp(&b.area));
    found.unwrap_or_else(|| {
        let colors: Vec<DVec3> = shapes.iter().map(|shape| shape.color).collect();
        panic!("no {color:?} among {colors:?}")
    })
}

/// Fails unless the shapes are those of the sheet, at one scale.
fn assert_drawn(traced: &Traced) {
    let shapes = shapes(traced);
    // Head, eyes, shirt, trousers, and two shoes.
    assert_eq!(shapes.len(), 8);
    let [head, shirt, trousers] = [SKIN, SHIRT, TROUSERS].map(|color| of_color(&shapes, color));
    // The scale, from the shirt.
    let scale = shirt.extent / DVec2::new(60.0, 67.0);
    assert!((scale.x / scale.y - 1.0).abs() < 0.1, "{scale}");
    // Of the head, the shirt covers a little.
    for (shape, millimetres) in [(head, 2810.0), (trousers, 22.0 * 70.0)] {
        let drawn = shape.area / scale.element_product() / millimetres;
        assert!((drawn - 1.0).abs() < 0.06, "{drawn} of {millimetres}");
    }
}

#[test]
fn a_photograph_of_a_drawing_is_straightened_and_its_shapes_have_their_colors() {
    let traced = trace(&file(&Shot::aslant().taken(), ImageFormat::Jpeg)).expect("a drawing");
    assert!(traced.is_straightened && !traced.is_shaded);
    assert_drawn(&traced);
}

#[test]
fn gaps_between_the_strokes_of_a_crayon_are_closed() {
    let shot = Shot {
        gaps: 0.12,
        ..Shot::aslant()
    };
    let traced = trace(&file(&shot.taken(), ImageFormat::Jpeg)).expect("a drawing");
    let shapes = shapes(&traced);
    assert!(shapes.len() <= 10, "{}", shapes.len());
    of_color(&shapes, SHIRT);
}

#[test]
fn a_table_that_is_nearly_as_light_as_the_paper_is_none() {
    let shot = Shot {
        table: [215.0, 205.0, 190.0],
        ..Shot::aslant()
    };
    let traced = trace(&file(&shot.taken(), ImageFormat::Jpeg)).expect("a drawing");
    assert!(traced.is_straightened);
    assert_drawn(&traced);
}

#[test]
fn without_a_table_in_it_the_whole_photograph_is_paper() {
    let shot = Shot {
        place: DMat3::from_cols_array_2d(&[[0.21, 0.0, 0.0], [0.0, 0.27, 0.0], [8.0, 10.0, 1.0]]),
        ..Shot::aslant()
    };
    let traced = trace(&file(&shot.taken(), ImageFormat::Jpeg)).expect("a drawing");
    assert!(!traced.is_straightened);
    let shapes = shapes(&traced);
    assert_eq!(shapes.len(), 8);
    for color in [SKIN, SHIRT, TROUSERS, SHOES] {
        of_color(&shapes, color);
    }
}

#[test]
fn what_a_program_painted_keeps_its_colors_and_its_place() {
    let painted = RgbImage::from_fn(400, 300, |x, y| {
        let is_inside = (100..300).contains(&x) && (50..250).contains(&y);
        Rgb(if is_inside {
            [250, 220, 40]
        } else {
            [60, 90, 160]
        })
    });
    let traced = trace(&file(&painted, ImageFormat::Png)).expect("a drawing");
    let shapes = shapes(&traced);
    assert_eq!(shapes.len(), 1);
    assert_eq!(shapes[0].color, DVec3::new(250.0, 220.0, 40.0));
    assert!((shapes[0].area - 200.0 * 200.0).abs() < 100.0);
}

#[test]
fn a_camera_says_which_side_is_up() {
    let upright = Shot::aslant().taken();
    let lying = DynamicImage::from(upright).rotate270().into_rgb8();
    // One entry, the orientation: the first row of pixels is the right side of what is seen.
    let exif = [&b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0"[..]];
    let mut file = Cursor::new(Vec::new());
    let mut encoder = JpegEncoder::new_with_quality(&mut file, 90);
    encoder
        .set_exif_metadata(exif.concat())
        .expect("room for it");
    encoder.encode_image(&lying).expect("room in memory");
    assert_drawn(&trace(&file.into_inner()).expect("a drawing"));
}

#[test]
fn a_blank_sheet_and_what_is_no_picture_are_refused() {
    let blank = RgbImage::from_pixel(200, 200, Rgb([255; 3]));
    let refusal = trace(&file(&blank, ImageFormat::Png)).expect_err("nothing is drawn");
    assert!(matches!(refusal, TraceError::Empty), "{refusal}");
    let refusal = trace(b"<svg/>").expect_err("no picture");
    assert!(matches!(refusal, TraceError::Picture(_)), "{refusal}");
}

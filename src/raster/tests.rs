//! Drawings whose regions are known, made here, and what repainting the regions found gives.

mod drawing;

use image::{Rgba, RgbaImage};

use super::{RasterView, Shades, regions};
use crate::geometry::{area, bounds};
use drawing::{Drawing, blob, disc, line, polygon, rectangle};

const SKIN: [u8; 4] = [240, 190, 150, 255];
const RED: [u8; 4] = [200, 40, 50, 255];
const GREEN: [u8; 4] = [60, 160, 90, 255];
const BLUE: [u8; 4] = [70, 110, 220, 255];
const BROWN: [u8; 4] = [120, 70, 60, 255];
const BLACK: [u8; 4] = [5, 5, 10, 255];
const WHITE: [u8; 4] = [255; 4];
const NOTHING: [u8; 4] = [0; 4];
const BACKGROUNDS: [[u8; 4]; 3] = [NOTHING, WHITE, [200, 230, 255, 255]];

/// A face with eyes, a nose and hair on a body: 6 regions.
fn figure(background: [u8; 4], line: Option<f32>) -> Drawing {
    let mut drawing = Drawing::new(220, 260, background);
    drawing.line = line.map(|width| (width, BLACK));
    drawing.fill(
        polygon(&[(70.3, 150.2), (150.6, 150.2), (181.4, 251.7), (40.8, 251.7)]),
        RED,
    );
    drawing.fill(disc(110.0, 100.0, 72.4), SKIN);
    drawing.fill(
        polygon(&[(60.2, 71.5), (110.0, 12.3), (165.8, 74.1), (110.0, 52.0)]),
        BROWN,
    );
    drawing.fill(disc(86.3, 98.7, 11.2), BLUE);
    drawing.fill(disc(134.2, 98.7, 11.2), BLUE);
    drawing.fill(
        polygon(&[(110.0, 108.0), (121.0, 131.25), (100.2, 131.25)]),
        GREEN,
    );
    drawing
}

#[test]
fn shapes_without_outlines_are_found_on_any_background() {
    for background in BACKGROUNDS {
        let drawing = figure(background, None);
        let view = regions(&drawing.picture());
        assert_eq!(view.regions.len(), 6);
        assert!(view.regions.iter().all(|region| region.line.is_none()));
        assert!(view.lines.is_empty());
        drawing.assert_repainted(&view, 0.98);
    }
}

#[test]
fn shapes_with_outlines_are_found_and_keep_their_lines() {
    for background in BACKGROUNDS {
        for width in [2.0, 3.0, 4.5, 6.0] {
            let drawing = figure(background, Some(width));
            let view = regions(&drawing.picture());
            assert_eq!(view.regions.len(), 6, "width {width} on {background:?}");
            for region in &view.regions {
                let line = region.line.unwrap();
                assert!(
                    (line.width - f64::from(width)).abs() < 0.35,
                    "{line:?} for {width}"
                );
                assert!((line.color[2] - 10.0 / 255.0).abs() < 0.02);
            }
            // Where two lines meet at a sharp angle, some ink belongs to neither.
            let rest: f64 = view.lines.iter().map(|line| area(&line.outline)).sum();
            assert!(rest < 150.0, "{rest} for {width} on {background:?}");
            drawing.assert_repainted(&view, 0.96);
        }
    }
}

/// A picture with normally distributed noise of this standard deviation, in steps of 1/255.
fn noisy(picture: &RgbaImage, deviation: f64) -> RgbaImage {
    let mut random = fastrand::Rng::with_seed(1);
    let mut picture = picture.clone();
    for channel in picture.pixels_mut().flat_map(|pixel| &mut pixel.0[..3]) {
        // Of twelve uniform numbers the sum has a variance of 1.
        let normal: f64 = (0..12).map(|_| random.f64() - 0.5).sum();
        *channel = (f64::from(*channel) + deviation * normal)
            .round()
            .clamp(0.0, 255.0) as u8;
    }
    picture
}

/// A picture as a JPEG file of this quality has it.
fn as_jpeg(picture: &RgbaImage, quality: u8) -> RgbaImage {
    let picture = image::DynamicImage::from(picture.clone()).into_rgb8();
    let mut file = Vec::new();
    image::codecs::jpeg::JpegEncoder::new_with_quality(&mut file, quality)
        .encode_image(&picture)
        .unwrap();
    image::load_from_memory(&file).unwrap().into_rgba8()
}

#[test]
fn noise_and_what_jpeg_files_add_are_no_regions() {
    for background in [WHITE, BACKGROUNDS[2]] {
        for line in [None, Some(4.5)] {
            let drawing = figure(background, line);
            let picture = drawing.picture();
            let mut dirty: Vec<(String, RgbaImage)> = Vec::new();
            for deviation in [1.0, 2.0, 4.0, 8.0] {
                dirty.push((format!("noise of {deviation}"), noisy(&picture, deviation)));
            }
            for quality in [30, 75, 95] {
                dirty.push((format!("quality {quality}"), as_jpeg(&picture, quality)));
            }
            for (what, picture) in dirty {
                let view = regions(&picture);
                let what = format!("{what}, line {line:?} on {background:?}");
                let count = view.regions.len();
                assert!((6..=9).contains(&count), "{what}: {count} regions");
                assert_eq!(view.shades, Shades::None, "{what}");
                let whole: f64 = view
                    .regions
                    .iter()
                    .map(|region| area(&region.outline))
                    .sum();
                let clean: f64 = regions(&drawing.picture())
                    .regions
                    .iter()
                    .map(|region| area(&region.outline))
                    .sum();
                assert!(
                    (whole / clean - 1.0).abs() < 0.02,
                    "{what}: {whole} for {clean}"
                );
            }
        }
    }
}

#[test]
fn eyes_are_found_in_noise_and_in_jpeg_files() {
    let face = |radius: f32| {
        let mut drawing = Drawing::new(400, 400, WHITE);
        drawing.fill(disc(200.0, 200.0, 150.0), SKIN);
        for x in [150.0, 250.0] {
            drawing.fill(disc(x, 180.0, radius), BLUE);
        }
        drawing.picture()
    };
    // Of 24 and of 64 pixels; an eye of 80 would be a two-thousandth of the picture.
    let (small, larger) = (face(2.75), face(4.5));
    let dirty = [
        ("noise of 3", noisy(&small, 3.0)),
        ("noise of 8", noisy(&small, 8.0)),
        ("quality 75", as_jpeg(&larger, 75)),
        ("quality 50", as_jpeg(&larger, 50)),
    ];
    for (what, picture) in dirty {
        let view = regions(&picture);
        let eyes = view.regions.iter().filter(|r| r.container == Some(0));
        assert_eq!((view.regions.len(), eyes.count()), (3, 2), "{what}");
    }
}

#[test]
fn soft_shades_are_flattened() {
    let picture = figure(WHITE, None).picture();
    let mut shaded = picture.clone();
    for (x, y, pixel) in shaded.enumerate_pixels_mut() {
        let light = 1.0 - 0.5 * f64::from(x * x + y * y) / f64::from(220 * 220 + 260 * 260);
        for channel in &mut pixel.0[..3] {
            *channel = (f64::from(*channel) * light).round() as u8;
        }
    }
    let flattened = regions(&shaded);
    assert_eq!(flattened.shades, Shades::Flattened);
    // Some steps that are far apart in colour remain.
    let count = flattened.regions.len();
    assert!((6..=12).contains(&count), "{count}");
    assert_eq!(regions(&picture).shades, Shades::None);
    // So many shades are no drawing.
    let tiles = RgbaImage::from_fn(420, 420, |x, y| {
        let light = if (x / 35 + y / 35) % 2 == 0 { 40 } else { 140 };
        let shade = (light + 2 * (x % 35)) as u8;
        Rgba([shade, 200 - shade / 2, shade / 2 + 60, 255])
    });
    assert_eq!(regions(&tiles).shades, Shades::Steps);
}

#[test]
fn large_pictures_are_looked_at_in_squares() {
    let mut drawing = Drawing::new(4100, 300, WHITE);
    drawing.fill(rectangle(100.0, 50.0, 3000.0, 250.0), RED);
    drawing.fill(disc(3600.0, 150.0, 90.0), BLUE);
    let view = regions(&drawing.picture());
    assert_eq!(view.regions.len(), 2);
    for (region, drawn) in view
        .regions
        .iter()
        .zip([[100.0, 50.0, 3000.0, 250.0], [3510.0, 60.0, 3690.0, 240.0]])
    {
        let (low, high) = bounds(&region.outline).unwrap();
        for (found, drawn) in [low.x, low.y, high.x, high.y].into_iter().zip(drawn) {
            assert!((found - drawn).abs() < 1.5, "{found} for {drawn}");
        }
    }
}

#[test]
fn what_lies_inside_has_a_container_and_comes_later() {
    let mut drawing = Drawing::new(200, 200, NOTHING);
    drawing.fill(disc(100.0, 100.0, 90.0), SKIN);
    drawing.fill(disc(80.0, 90.0, 40.0), GREEN);
    drawing.fill(disc(75.0, 85.0, 15.0), BLUE);
    drawing.fill(disc(150.0, 110.0, 20.0), RED);
    let view = regions(&drawing.picture());
    let containers: Vec<_> = view.regions.iter().map(|region| region.container).collect();
    assert_eq!(containers, [None, Some(0), Some(0), Some(1)]);
    // Holes that other regions make are filled.
    for (region, radius) in view.regions.iter().zip([90.0_f64, 40.0, 20.0, 15.0]) {
        assert_eq!(region.outline.polygons.len(), 1);
        assert_eq!(region.outline.polygons[0].rings.len(), 1);
        let exact = std::f64::consts::PI * radius * radius;
        assert!((area(&region.outline) / exact - 1.0).abs() < 0.01);
    }
}

#[test]
fn borders_lie_where_the_soft_pixels_say() {
    let mut drawing = Drawing::new(80, 60, WHITE);
    drawing.fill(rectangle(10.25, 12.75, 60.25, 47.75), RED);
    let view = regions(&drawing.picture());
    let (low, high) = bounds(&view.regions[0].outline).unwrap();
    for (found, drawn) in [
        (low.x, 10.25),
        (low.y, 12.75),
        (high.x, 60.25),
        (high.y, 47.75),
    ] {
        assert!((found - drawn).abs() < 0.05, "{found} for {drawn}");
    }
}

#[test]
fn regions_reach_the_edge_of_the_picture() {
    let mut drawing = Drawing::new(50, 40, NOTHING);
    drawing.fill(rectangle(20.0, 0.0, 50.0, 40.0), RED);
    let view = regions(&drawing.picture());
    let (low, high) = bounds(&view.regions[0].outline).unwrap();
    assert!((low.x - 20.0).abs() < 0.05 && low.y.abs() < 0.05);
    assert!((high.x - 50.0).abs() < 0.05 && (high.y - 40.0).abs() < 0.05);
}

#[test]
fn neighbors_share_their_border() {
    let mut drawing = Drawing::new(160, 160, NOTHING);
    drawing.fill(disc(80.0, 80.0, 70.0), GREEN);
    let whole = area(&regions(&drawing.picture()).regions[0].outline);
    drawing.fill(
        polygon(&[
            (0.0, 0.0),
            (90.0, 0.0),
            (60.0, 80.0),
            (100.0, 160.0),
            (0.0, 160.0),
        ]),
        BLUE,
    );
    drawing.clip(disc(80.0, 80.0, 70.0));
    let view = regions(&drawing.picture());
    assert_eq!(view.regions.len(), 2);
    let parts: f64 = view
        .regions
        .iter()
        .map(|region| area(&region.outline))
        .sum();
    assert!((parts - whole).abs() < 60.0, "{parts} of {whole}");
    let [first, second] = [0, 1].map(|i| &view.regions[i].outline.polygons[0].rings[0]);
    let shared = first.iter().filter(|point| second.contains(point)).count();
    assert!(shared >= 3, "{shared} points");
    // Where one ring leaves the other's points it does not come back: the shared points are a run.
    let is_shared: Vec<bool> = first.iter().map(|point| second.contains(point)).collect();
    let changes = (0..first.len()).filter(|i| is_shared[*i] != is_shared[(i + 1) % first.len()]);
    assert_eq!(changes.count(), 2);
}

#[test]
fn transparent_holes_and_those_under_translucent_regions_stay() {
    let mut drawing = Drawing::new(200, 120, NOTHING);
    drawing.fill(rectangle(10.0, 10.0, 190.0, 110.0), RED);
    drawing.clear(disc(50.0, 60.0, 25.0));
    drawing.fill(disc(100.0, 60.0, 20.0), GREEN);
    drawing.clear(disc(150.0, 60.0, 25.0));
    drawing.fill(disc(150.0, 60.0, 25.0), [255, 255, 255, 80]);
    let view = regions(&drawing.picture());
    assert_eq!(view.regions.len(), 3);
    let outer = &view.regions[0];
    assert_eq!(outer.outline.polygons[0].rings.len(), 3);
    let translucent = view
        .regions
        .iter()
        .find(|region| region.color[3] < 0.9)
        .unwrap();
    assert!((translucent.color[3] - 80.0 / 255.0).abs() < 0.01);
    assert!((translucent.color[0] - 1.0).abs() < 0.02);
}

#[test]
fn thin_mouths_are_regions() {
    for width in [1.2, 2.0, 3.0] {
        let mut drawing = Drawing::new(120, 120, NOTHING);
        drawing.fill(disc(60.0, 60.0, 50.0), SKIN);
        drawing.stroke(
            line(&[(40.0, 75.0), (50.0, 84.0), (70.0, 84.0), (80.0, 75.0)]),
            width,
            RED,
        );
        let view = regions(&drawing.picture());
        assert_eq!(view.regions.len(), 2, "width {width}");
        let mouth = &view.regions[1];
        assert_eq!(mouth.container, Some(0));
        let (low, high) = bounds(&mouth.outline).unwrap();
        assert!((low.x - 40.0).abs() < 2.0 && (high.x - 80.0).abs() < 2.0);
        assert!((mouth.color[0] - 200.0 / 255.0).abs() < 0.1);
        let exact = f64::from(width) * 47.0;
        let found = area(&mouth.outline);
        assert!((found / exact - 1.0).abs() < 0.5, "{found} for {exact}");
    }
}

#[test]
fn soft_edges_make_no_regions() {
    // Edges in the middle of pixels give long strips of one mixed colour.
    let mut drawing = Drawing::new(200, 200, WHITE);
    drawing.fill(rectangle(20.5, 20.5, 180.5, 180.5), RED);
    drawing.fill(rectangle(60.5, 60.3, 140.7, 140.5), BLUE);
    assert_eq!(regions(&drawing.picture()).regions.len(), 2);
    let blurred = image::imageops::blur(&drawing.picture(), 1.0);
    assert_eq!(regions(&blurred).regions.len(), 2);
}

#[test]
fn dark_dots_and_dark_figures_are_regions() {
    let mut drawing = Drawing::new(200, 200, WHITE);
    drawing.line = Some((4.0, BLACK));
    drawing.fill(disc(100.0, 100.0, 80.0), SKIN);
    drawing.line = None;
    drawing.fill(disc(75.0, 90.0, 7.0), BLACK);
    drawing.fill(disc(125.0, 90.0, 7.0), BLACK);
    let view = regions(&drawing.picture());
    assert_eq!(view.regions.len(), 3);
    assert!(view.lines.is_empty());
    // A cat with a thin tail has no outline.
    let mut cat = Drawing::new(300, 200, WHITE);
    cat.fill(disc(120.0, 120.0, 60.0), BLACK);
    cat.stroke(
        line(&[(170.0, 120.0), (230.0, 60.0), (240.0, 20.0)]),
        4.0,
        BLACK,
    );
    let view = regions(&cat.picture());
    assert_eq!(view.regions.len(), 1);
    assert!(view.lines.is_empty());
    cat.assert_repainted(&view, 0.98);
}

#[test]
fn lines_that_are_no_border_are_inner_lines() {
    let mut drawing = Drawing::new(240, 200, NOTHING);
    drawing.line = Some((4.0, BLACK));
    drawing.fill(disc(100.0, 100.0, 80.0), SKIN);
    // A mouth, a wrinkle that starts at the border, and a whisker outside.
    drawing.stroke(
        line(&[(70.0, 130.0), (100.0, 140.0), (130.0, 130.0)]),
        4.0,
        BLACK,
    );
    drawing.stroke(line(&[(100.0, 20.0), (100.0, 60.0)]), 4.0, BLACK);
    drawing.stroke(line(&[(180.0, 100.0), (230.0, 80.0)]), 4.0, BLACK);
    let view = regions(&drawing.picture());
    assert_eq!(view.regions.len(), 1);
    assert_eq!(view.lines.len(), 3);
    assert!(view.regions[0].line.is_some());
    let inside = view.lines.iter().filter(|line| line.region == Some(0));
    assert_eq!(inside.count(), 2);
    drawing.assert_repainted(&view, 0.94);
}

#[test]
fn a_border_with_a_gap_in_its_line_is_not_drawn_closed() {
    let mut drawing = Drawing::new(200, 200, WHITE);
    drawing.fill(rectangle(40.25, 40.25, 160.25, 160.25), GREEN);
    drawing.stroke(
        line(&[
            (40.25, 60.0),
            (40.25, 40.25),
            (160.25, 40.25),
            (160.25, 160.25),
            (40.25, 160.25),
            (40.25, 80.0),
        ]),
        5.0,
        BLACK,
    );
    let view = regions(&drawing.picture());
    assert_eq!(view.regions.len(), 1);
    assert!(view.regions[0].line.is_none());
    assert_eq!(view.lines.len(), 1);
    drawing.assert_repainted(&view, 0.96);
}

#[test]
fn random_drawings_are_repainted() {
    let mut random = fastrand::Rng::with_seed(7);
    let colors = [SKIN, RED, GREEN, BLUE, BROWN, [250, 220, 60, 255]];
    let mut compared = 0;
    for case in 0..40 {
        let background = BACKGROUNDS[case % 3];
        let mut drawing = Drawing::new(180, 180, background);
        drawing.line = (case % 2 == 1).then(|| (random.f32() * 3.0 + 2.5, BLACK));
        for index in 0..random.usize(2..7) {
            let at = (random.f32() * 140.0 + 20.0, random.f32() * 140.0 + 20.0);
            let radius = random.f32() * 40.0 + 12.0;
            drawing.fill(blob(&mut random, at, radius), colors[index % colors.len()]);
        }
        let view = regions(&drawing.picture());
        compared += drawing.assert_inside_repainted(&view, case);
    }
    assert!(compared > 40 * 180 * 180 / 2, "{compared} pixels");
}

#[test]
fn pictures_that_are_no_drawings_give_few_regions() {
    let mut random = fastrand::Rng::with_seed(3);
    let size = 160;
    let noise = RgbaImage::from_fn(size, size, |_, _| {
        Rgba([random.u8(..), random.u8(..), random.u8(..), 255])
    });
    let two = RgbaImage::from_fn(size, size, |_, _| {
        Rgba([0, 0, 0, if random.bool() { 255 } else { 0 }])
    });
    let veil = RgbaImage::from_fn(size, size, |_, _| Rgba([255, 0, 0, random.u8(..)]));
    let gradient = RgbaImage::from_fn(size, size, |x, y| {
        Rgba([x as u8, y as u8, (x + y) as u8 / 2, 255])
    });
    let checks = RgbaImage::from_fn(size, size, |x, y| match (x / 3 + y / 3) % 2 {
        0 => Rgba(WHITE),
        _ => Rgba(RED),
    });
    for picture in [noise, two, veil, gradient, checks] {
        let view = regions(&picture);
        assert!(view.regions.len() <= 400);
        assert_finite(&view);
    }
}

#[test]
fn pixels_that_only_dark_regions_surround_belong_to_one() {
    let mut random = fastrand::Rng::with_seed(0);
    // Dark camera noise: a normal distribution, clipped.
    let picture = RgbaImage::from_fn(160, 160, |_, _| {
        let radius = (-2.0 * (1.0 - random.f32()).ln()).sqrt();
        let value = radius * (std::f32::consts::TAU * random.f32()).cos();
        let gray = (20.0 + 50.0 * value).clamp(0.0, 255.0) as u8;
        Rgba([gray, gray, gray, 255])
    });
    let view = regions(&picture);
    assert!(view.regions.len() <= 400);
    assert_finite(&view);
}

#[test]
fn empty_and_tiny_pictures_give_no_or_one_region() {
    for (width, height) in [(0, 0), (0, 5), (1, 1), (2, 2), (3, 1), (7, 7)] {
        for color in [NOTHING, WHITE, BLACK, [9, 9, 9, 9]] {
            let view = regions(&RgbaImage::from_pixel(width, height, Rgba(color)));
            assert!(view.regions.len() <= 1);
            assert_finite(&view);
        }
    }
}

fn assert_finite(view: &RasterView) {
    for region in &view.regions {
        assert!(area(&region.outline).is_finite());
        assert!(region.color.iter().all(|c| (0.0..=1.0).contains(c)));
        assert!(
            region
                .container
                .is_none_or(|container| container < view.regions.len())
        );
    }
    for (index, region) in view.regions.iter().enumerate() {
        assert!(region.container.is_none_or(|container| container < index));
    }
}

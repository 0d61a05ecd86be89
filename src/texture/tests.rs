use image::{Rgba, RgbaImage};

use super::*;

fn stop(offset: f64, red: f64, alpha: f64) -> Stop {
    Stop {
        offset,
        color: [red, 0.0, 255.0 - red, alpha],
    }
}

fn linear(spread: Spread) -> PaintServer {
    PaintServer {
        source: Source::Linear(Gradient {
            stops: vec![stop(0.0, 0.0, 255.0), stop(1.0, 255.0, 255.0)],
            spread,
        }),
        place: DAffine2::from_scale(DVec2::new(50.0, 50.0)),
    }
}

const BOX: [DVec2; 2] = [DVec2::ZERO, DVec2::splat(100.0)];

#[test]
fn a_linear_gradient_has_its_end_colors_at_its_ends() {
    let server = linear(Spread::Pad);
    let plan = server.plan(BOX, 1.0).unwrap();
    let baked = plan.bake().unwrap();
    let pixels = image::load_from_memory(&baked.picture.bytes)
        .unwrap()
        .to_rgba8();
    let (width, height) = pixels.dimensions();
    assert_eq!(pixels.get_pixel(0, 0), &Rgba([0, 0, 255, 255]));
    assert_eq!(
        pixels.get_pixel(width - 1, height - 1),
        &Rgba([255, 0, 0, 255])
    );
    // The ends lie at the centres of the outermost pixels, where no neighbour contributes.
    let map = plan.map(&server);
    let ends = [0.0, 50.0].map(|x| map.transform_point2(DVec2::new(x, 7.0)).x);
    let middle = 0.5 / f64::from(width);
    assert!((ends[0] - middle).abs() < 1e-12 && (ends[1] - (1.0 - middle)).abs() < 1e-12);
}

#[test]
fn gradients_are_extended_by_the_sampler() {
    for (spread, wrap) in [
        (Spread::Pad, Wrap::ClampToEdge),
        (Spread::Reflect, Wrap::MirroredRepeat),
        (Spread::Repeat, Wrap::Repeat),
    ] {
        let plan = linear(spread).plan(BOX, 1.0).unwrap();
        assert_eq!(plan.bake().unwrap().wrap, [wrap, Wrap::ClampToEdge]);
    }
}

#[test]
fn a_degenerate_paint_is_refused() {
    let mut server = linear(Spread::Pad);
    server.place = DAffine2::from_scale(DVec2::new(50.0, 0.0));
    assert!(server.plan(BOX, 1.0).is_err());
    server.place = DAffine2::from_scale(DVec2::splat(f64::NAN));
    assert!(server.plan(BOX, 1.0).is_err());
}

#[test]
fn many_textures_are_made_smaller() {
    let radial = |red: f64| {
        let gradient = Gradient {
            stops: vec![stop(0.0, red, 255.0), stop(1.0, 255.0, 255.0)],
            spread: Spread::Pad,
        };
        let focus = Focus {
            x: 0.0,
            y: 0.0,
            radius: 0.0,
        };
        PaintServer {
            source: Source::Radial(gradient, focus),
            place: DAffine2::IDENTITY,
        }
    };
    let plans = |count: usize| {
        let servers = (0..count).map(|i| radial(i as f64 / 100.0));
        let mut plans: Vec<Plan> = servers.map(|s| s.plan(BOX, 1.0).unwrap()).collect();
        fit(&mut plans);
        plans
    };
    let pixels = |plans: &[Plan]| -> u32 { plans.iter().map(|p| p.size[0] * p.size[1]).sum() };
    assert_eq!(pixels(&plans(10)), 10 * 128 * 128);
    assert!(f64::from(pixels(&plans(20_000))) <= MAX_PIXELS);
    assert_eq!(plans(300_000)[7].size, [MIN_SIDE; 2]);
}

fn disc(soft: f64) -> RgbaImage {
    RgbaImage::from_fn(64, 64, |x, y| {
        let far = (f64::from(x) - 31.5).hypot(f64::from(y) - 31.5);
        let alpha = ((20.0 - far) / soft + 0.5).clamp(0.0, 1.0) * 255.0;
        Rgba([if alpha > 0.0 { 200 } else { 0 }, 10, 20, alpha as u8])
    })
}

fn read(pixels: &RgbaImage, holes: Holes) -> Picture {
    let mut bytes = std::io::Cursor::new(Vec::new());
    pixels
        .write_to(&mut bytes, image::ImageFormat::Png)
        .unwrap();
    let bytes: Arc<[u8]> = bytes.into_inner().into();
    picture(decode(&bytes).unwrap(), &bytes, holes).unwrap()
}

#[test]
fn antialiased_borders_are_holes_and_half_tones_are_not() {
    assert_eq!(read(&disc(1.0), Holes::Alpha).alpha, Alpha::Holes);
    assert_eq!(read(&disc(2.0), Holes::Alpha).alpha, Alpha::Holes);
    assert_eq!(read(&disc(20.0), Holes::Alpha).alpha, Alpha::Blended);
    // The outline replaces sharp borders; a glow is kept.
    assert_eq!(read(&disc(1.0), Holes::Outline).alpha, Alpha::Opaque);
    assert_eq!(read(&disc(20.0), Holes::Outline).alpha, Alpha::Blended);
}

#[test]
fn colors_bleed_into_transparent_pixels() {
    let pixels = image::load_from_memory(&read(&disc(1.0), Holes::Alpha).bytes)
        .unwrap()
        .to_rgba8();
    // Black transparent pixels would darken the border when filtered.
    assert!(pixels.pixels().all(|pixel| pixel.0[0] == 200));
    assert_eq!(pixels.get_pixel(0, 0).0[3], 0);
    let cut = image::load_from_memory(&read(&disc(1.0), Holes::Outline).bytes)
        .unwrap()
        .to_rgba8();
    assert!(cut.pixels().all(|pixel| pixel.0 == [200, 10, 20, 255]));
}

#[test]
fn opaque_files_are_kept_unchanged() {
    let pixels = RgbaImage::from_pixel(7, 3, Rgba([1, 2, 3, 255]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    pixels
        .write_to(&mut bytes, image::ImageFormat::Png)
        .unwrap();
    let bytes: Arc<[u8]> = bytes.into_inner().into();
    let kept = picture(decode(&bytes).unwrap(), &bytes, Holes::Outline).unwrap();
    assert!(Arc::ptr_eq(&kept.bytes, &bytes));
    let mut webp = std::io::Cursor::new(Vec::new());
    image::DynamicImage::ImageRgba8(pixels)
        .to_rgb8()
        .write_to(&mut webp, image::ImageFormat::WebP)
        .unwrap();
    let bytes: Arc<[u8]> = webp.into_inner().into();
    let converted = picture(decode(&bytes).unwrap(), &bytes, Holes::Outline).unwrap();
    assert_eq!(converted.media_type, MediaType::Png);
    assert!(converted.bytes.starts_with(b"\x89PNG"));
}

/// A PNG of one opaque pixel with the settings that `set` makes.
fn pixel(set: impl FnOnce(&mut png::Encoder<'_, &mut Vec<u8>>)) -> Arc<[u8]> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
    encoder.set_color(png::ColorType::Rgb);
    set(&mut encoder);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[1, 2, 3]).unwrap();
    writer.finish().unwrap();
    bytes.into()
}

#[test]
fn files_that_gltf_does_not_allow_are_encoded_again() {
    let is_kept = |bytes: &Arc<[u8]>| {
        let made = picture(decode(bytes).unwrap(), bytes, Holes::Outline).unwrap();
        assert_eq!(
            decode(&made.bytes).unwrap().pixels.get_pixel(0, 0).0,
            [1, 2, 3, 255]
        );
        Arc::ptr_eq(&made.bytes, bytes)
    };
    let gamma = |scaled| pixel(|png| png.set_source_gamma(png::ScaledFloat::from_scaled(scaled)));
    let dots = |xppu, yppu| {
        let unit = png::Unit::Meter;
        pixel(|png| png.set_pixel_dims(Some(png::PixelDimensions { xppu, yppu, unit })))
    };
    assert!(is_kept(&gamma(45_455)));
    assert!(!is_kept(&gamma(55_000)));
    assert!(is_kept(&dots(2835, 2835)));
    assert!(!is_kept(&dots(2835, 1417)));
    assert!(!is_kept(&pixel(|png| png.set_animated(1, 0).unwrap())));
}

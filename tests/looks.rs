//! From the front, parts look like the drawing: textures are sampled on their surfaces and compared
//! with a picture of the drawing.

mod common;

use std::io::Cursor;
use std::sync::Arc;

use base64::Engine as _;
use glam::{DAffine3, DVec2, DVec3};
use okoshi::compile::Compiled;
use okoshi::diagnostic::Code;
use okoshi::resolver::MemoryResolver;
use okoshi::scene::{AlphaMode, MediaType, NodeId, Scene, Surface, TextureId, TiVec, Wrap};
use resvg::tiny_skia::{Pixmap, Transform};

/// Pixels a drawing unit in the picture of the drawing.
const ZOOM: f32 = 8.0;
/// Metres a drawing unit.
const UNIT: f64 = 0.01;

fn drawing(defs: &str, body: &str) -> String {
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 120 100">
  <defs>{defs}</defs>{body}<text x="0" y="99">%Ground page</text>
</svg>"##
    )
}

fn compiled(text: &str, files: &MemoryResolver) -> Compiled {
    let compiled = common::compiled(text, files);
    assert!(!compiled.has_errors(), "{:?}", compiled.diagnostics);
    compiled
}

/// A 20 × 10 picture with a colour in each corner, and optionally a hole in the middle.
fn png(hole: bool) -> Vec<u8> {
    let picture = image::RgbaImage::from_fn(40, 20, |x, y| {
        let clear = hole && (14..26).contains(&x) && (6..14).contains(&y);
        image::Rgba([
            (x * 6) as u8,
            (y * 12) as u8,
            90,
            if clear { 0 } else { 255 },
        ])
    });
    let mut out = Cursor::new(Vec::new());
    picture
        .write_to(&mut out, image::ImageFormat::Png)
        .expect("a PNG");
    out.into_inner()
}

fn data_uri(bytes: &[u8]) -> String {
    let text = base64::engine::general_purpose::STANDARD.encode(bytes);
    format!("data:image/png;base64,{text}")
}

/// The drawing as rendered by resvg.
fn picture(text: &str) -> Pixmap {
    let tree = usvg::Tree::from_str(text, &usvg::Options::default()).expect("a drawing");
    let mut pixmap = Pixmap::new(120 * ZOOM as u32, 100 * ZOOM as u32).expect("a pixmap");
    resvg::render(
        &tree,
        Transform::from_scale(ZOOM, ZOOM),
        &mut pixmap.as_mut(),
    );
    pixmap
}

/// An image's pixels, and its wrap modes.
struct Sampler {
    pixels: image::RgbaImage,
    wrap: [Wrap; 2],
}

impl Sampler {
    fn of(scene: &Scene, texture: TextureId) -> Self {
        let texture = scene.textures[texture];
        let pixels = image::load_from_memory(&scene.images[texture.image].bytes);
        Self {
            pixels: pixels.expect("an image").to_rgba8(),
            wrap: texture.wrap,
        }
    }

    /// Bilinear sampling.
    fn at(&self, uv: [f64; 2]) -> [f64; 4] {
        let size = [self.pixels.width(), self.pixels.height()];
        let pixel = |i: usize, at: i64| {
            let count = i64::from(size[i]);
            (match self.wrap[i] {
                Wrap::Repeat => at.rem_euclid(count),
                Wrap::ClampToEdge => at.clamp(0, count - 1),
                Wrap::MirroredRepeat => {
                    let at = at.rem_euclid(2 * count);
                    at.min(2 * count - 1 - at)
                }
            }) as u32
        };
        let [x, y] = [0, 1].map(|i| uv[i] * f64::from(size[i]) - 0.5);
        let mut sum = [0.0; 4];
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let [u, v] = [(x, dx), (y, dy)].map(|(at, d)| {
                let share = at - at.floor();
                (
                    at.floor() as i64 + d,
                    if d == 1 { share } else { 1.0 - share },
                )
            });
            let color = self.pixels.get_pixel(pixel(0, u.0), pixel(1, v.0)).0;
            (0..4).for_each(|i| sum[i] += f64::from(color[i]) * u.1 * v.1);
        }
        sum
    }
}

/// Points of all faces towards the viewer: their position in the drawing, and their colour.
fn seen(scene: &Scene) -> Vec<(DVec2, [f64; 4])> {
    let mut places: TiVec<NodeId, _> = vec![DAffine3::IDENTITY; scene.nodes.len()].into();
    let mut out = Vec::new();
    // Away from the edges, where the picture of the drawing is antialiased.
    let parts = 24;
    let inside: Vec<[f64; 3]> = (1..parts)
        .flat_map(|i| (1..parts - i).map(move |j| [i, j, parts - i - j]))
        .map(|parted| parted.map(|part| f64::from(part) / f64::from(parts)))
        .collect();
    for (id, node) in scene.nodes.iter_enumerated() {
        let own = DAffine3::from_rotation_translation(node.rotation, node.translation);
        places[id] *= own;
        node.children
            .iter()
            .for_each(|child| places[*child] = places[id]);
        let primitives = node
            .mesh
            .iter()
            .flat_map(|mesh| &scene.meshes[*mesh].primitives);
        for primitive in primitives {
            let material = &scene.materials[primitive.material];
            let texture = material.base_color_texture.expect("a textured part");
            let sampler = Sampler::of(scene, texture.texture);
            let surface: &Surface = &primitive.surface();
            assert_eq!(surface.uvs.len(), surface.positions.len());
            let facing = |t: &&[u32; 3]| t.iter().all(|i| surface.normals[*i as usize][2] > 0.5);
            for triangle in surface.triangles.iter().filter(facing) {
                for weights in &inside {
                    let (mut point, mut uv) = (DVec3::ZERO, [0.0; 2]);
                    for (corner, weight) in triangle.iter().zip(weights) {
                        let at = surface.positions[*corner as usize];
                        point += glam::Vec3::from(at).as_dvec3() * *weight;
                        let corner = surface.uvs[*corner as usize];
                        (0..2).for_each(|i| uv[i] += f64::from(corner[i]) * *weight);
                    }
                    let world = places[id].transform_point3(point) / UNIT;
                    let mut color = sampler.at(uv);
                    color[3] *= f64::from(material.base_color[3]);
                    out.push((DVec2::new(world.x, -world.y), color));
                }
            }
        }
    }
    out
}

/// Compares the model with the drawing: the greatest difference of a channel that all but `odd` of a hundred
/// points keep to.
fn difference(text: &str, files: &MemoryResolver, shown: &str, odd: usize) -> f64 {
    let compiled = compiled(text, files);
    let picture = picture(shown);
    let mut differences = Vec::new();
    for (at, color) in seen(&compiled.scene) {
        let at = at * f64::from(ZOOM);
        let (x, y) = (at.x as u32, at.y as u32);
        let beside = [(0, 0), (2, 0), (0, 2), (2, 2)];
        let beside = beside.map(|(dx, dy)| picture.pixel((x + dx).max(1) - 1, (y + dy).max(1) - 1));
        let (Some(pixel), [Some(a), Some(b), Some(c), Some(d)]) = (picture.pixel(x, y), beside)
        else {
            continue;
        };
        // The picture is antialiased along the border of shapes, where thin triangles have all their points.
        let alphas = [a, b, c, d].map(|pixel| pixel.alpha());
        let [least, most] =
            [alphas.iter().min(), alphas.iter().max()].map(|alpha| i32::from(*alpha.unwrap_or(&0)));
        if most - least > 20 {
            continue;
        }
        let pixel = pixel.demultiply();
        let drawn = [pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()].map(f64::from);
        // The colour of a nearly transparent pixel says little.
        let weight = |i: usize| {
            if i == 3 {
                1.0
            } else {
                drawn[3].min(color[3]) / 255.0
            }
        };
        let channels = (0..4).map(|i| (drawn[i] - color[i]).abs() * weight(i));
        let most = channels.fold(0.0, f64::max);
        differences.push(most);
    }
    assert!(
        differences.len() > 200,
        "only {} points are seen",
        differences.len()
    );
    differences.sort_by(f64::total_cmp);
    differences[differences.len() * (100 - odd) / 100 - 1]
}

const SHAPES: &str = r##"
  <path d="M 10 40 L 50 8 L 58 18 Q 40 40 18 50 Z" fill="url(#paint)"/>
  <g transform="translate(84 30) rotate(25) scale(1.5 1)"><circle r="14" fill="url(#paint)"/></g>
  <path d="M 20 60 h 60 v 30 h -60 z M 40 70 v 10 h 20 v -10 z" fill="url(#paint)" opacity="0.75"/>"##;

const STOPS: &str = r##"<stop offset="0.1" stop-color="#ff2010"/><stop offset="0.5" stop-color="#20c040"/><stop offset="0.9" stop-color="#1020e0"/>"##;

/// Paints, how far colours may be off, and how many of a hundred points may be further off: those on sharp edges.
#[test]
fn paints_match_the_drawing() {
    let cases: &[(&str, String, f64, usize)] = &[
        ("a linear gradient over boxes", format!(r##"<linearGradient id="paint">{STOPS}</linearGradient>"##), 3.0, 1),
        (
            "a link to stops, a turned gradient of the page, repeated",
            format!(r##"<linearGradient id="stops">{STOPS}</linearGradient><linearGradient id="between" xlink:href="#stops" spreadMethod="repeat"/><linearGradient id="paint" xlink:href="#between" gradientUnits="userSpaceOnUse" x1="0" y1="0" x2="30" y2="10" gradientTransform="rotate(20) skewX(15)"/>"##),
            6.0,
            5,
        ),
        (
            "a reflected gradient",
            format!(r##"<linearGradient id="paint" x1="0.3" x2="0.5" y2="0.2" spreadMethod="reflect">{STOPS}</linearGradient>"##),
            6.0,
            1,
        ),
        (
            "stops that can be seen through",
            r##"<linearGradient id="paint" y2="1"><stop offset="0" stop-color="#ff8000" stop-opacity="0.9"/><stop offset="1" stop-color="#0080ff" stop-opacity="0.2"/></linearGradient>"##.to_owned(),
            6.0,
            1,
        ),
        ("a radial gradient", format!(r##"<radialGradient id="paint">{STOPS}</radialGradient>"##), 5.0, 1),
        (
            "a radial gradient with a focus",
            format!(r##"<radialGradient id="paint" cx="0.4" cy="0.45" r="0.5" fx="0.2" fy="0.3" gradientTransform="rotate(10)">{STOPS}</radialGradient>"##),
            8.0,
            3,
        ),
        (
            "a reflected radial gradient of the page",
            format!(r##"<radialGradient id="paint" gradientUnits="userSpaceOnUse" cx="60" cy="50" r="20" fx="55" spreadMethod="reflect">{STOPS}</radialGradient>"##),
            8.0,
            2,
        ),
        (
            "a pattern of the page",
            r##"<pattern id="paint" patternUnits="userSpaceOnUse" x="3" y="1" width="12" height="8" patternTransform="rotate(30) scale(1.2 1)"><rect width="12" height="8" fill="#204080"/><rect x="6" width="6" height="4" fill="#f0d020"/></pattern>"##.to_owned(),
            6.0,
            16,
        ),
        (
            "a pattern over boxes, with a view box and a link",
            r##"<pattern id="tile" viewBox="0 0 10 10" width="0.5" height="0.5"><rect width="10" height="10" fill="#208040"/><circle cx="5" cy="5" r="3" fill="#f02040"/></pattern><pattern id="paint" xlink:href="#tile" x="0.1"/>"##.to_owned(),
            6.0,
            16,
        ),
        (
            "a pattern with holes",
            r##"<pattern id="paint" patternUnits="userSpaceOnUse" width="10" height="10"><rect width="6" height="10" fill="#a02080"/></pattern>"##.to_owned(),
            6.0,
            16,
        ),
    ];
    let mut off = Vec::new();
    for (what, defs, most, odd) in cases {
        let text = drawing(defs, SHAPES);
        let found = difference(&text, &MemoryResolver::default(), &text, *odd);
        if found > *most {
            off.push(format!("{what}: off by {found}"));
        }
    }
    assert!(off.is_empty(), "{off:#?}");
}

#[test]
fn pictures_match_the_drawing() {
    for hole in [false, true] {
        let uri = data_uri(&png(hole));
        let image = format!(
            r##"<g transform="rotate(-12 50 50)"><image x="20" y="20" width="80" height="40" xlink:href="{uri}"/></g>"##
        );
        let text = drawing("", &image);
        let found = difference(&text, &MemoryResolver::default(), &text, 5);
        assert!(found <= 4.5, "hole {hole}: off by {found}");
    }
}

#[test]
fn a_texture_file_covers_the_bounding_box_of_its_part() {
    let bytes: Arc<[u8]> = png(false).into();
    let files = MemoryResolver::default().with("cloth.png", Arc::clone(&bytes));
    let outline = r##"M 20 20 L 90 30 L 60 80 Z"##;
    let body = format!(
        r##"<path d="{outline}" fill="red"/><text x="50" y="40">Sail$Texture "cloth.png" Axis 30</text>"##
    );
    let text = drawing("", &body);
    let uri = data_uri(&bytes);
    let clipped = format!(
        r##"<clipPath id="clip"><path d="{outline}"/></clipPath><image clip-path="url(#clip)" x="20" y="20" width="70" height="60" preserveAspectRatio="none" xlink:href="{uri}"/>"##
    );
    let found = difference(&text, &files, &drawing("", &clipped), 0);
    assert!(found <= 10.0, "off by {found}");
    // The file itself is in the model, and is a dependency.
    let compiled = compiled(&text, &files);
    assert_eq!(compiled.scene.images.raw[0].bytes, bytes);
    assert_eq!(compiled.scene.images.raw[0].name, "cloth.png");
    assert_eq!(compiled.dependencies, ["cloth.png"]);
}

/// The materials of a drawing of one rectangle.
fn material(paint: &str, defs: &str, string: &str) -> okoshi::scene::Material {
    let files = MemoryResolver::default()
        .with("whole.png", png(false))
        .with("hole.png", png(true));
    let body = format!(
        r##"<rect x="10" y="10" width="50" height="30" {paint}/><text x="35" y="25">Part${string}</text>"##
    );
    let compiled = compiled(&drawing(defs, &body), &files);
    assert_eq!(compiled.scene.materials.len(), 1);
    compiled.scene.materials.raw[0].clone()
}

#[test]
fn alpha_is_blended_only_if_something_is_transparent() {
    let red = r##"fill="red""##;
    let gradient = r##"fill="url(#g)""##;
    let whole = r##"<linearGradient id="g"><stop stop-color="red"/><stop offset="1" stop-color="blue"/></linearGradient>"##;
    let faded = r##"<linearGradient id="g"><stop stop-color="red"/><stop offset="1" stop-opacity="0"/></linearGradient>"##;
    let holes = r##"<pattern id="g" patternUnits="userSpaceOnUse" width="9" height="9"><circle cx="4" cy="4" r="3" fill="blue"/></pattern>"##;
    let mask = AlphaMode::Mask { cutoff: 0.5 };
    for (paint, defs, string, mode, alpha) in [
        (red, "", "Shape flat", AlphaMode::Opaque, 1.0),
        (red, "", "Alpha 0.25", AlphaMode::Blend, 0.25),
        (
            r##"fill="red" fill-opacity="0.5" opacity="0.5""##,
            "",
            "Shape flat",
            AlphaMode::Blend,
            0.25,
        ),
        (
            r##"fill="red" opacity="0.5""##,
            "",
            "Alpha 1",
            AlphaMode::Opaque,
            1.0,
        ),
        (gradient, whole, "Shape flat", AlphaMode::Opaque, 1.0),
        (gradient, whole, "Alpha 0.5", AlphaMode::Blend, 0.5),
        (gradient, faded, "Shape flat", AlphaMode::Blend, 1.0),
        (gradient, holes, "Shape flat", mask, 1.0),
        (gradient, holes, "Alpha 0.5", AlphaMode::Blend, 0.5),
        (red, "", r##"Texture "whole.png""##, AlphaMode::Opaque, 1.0),
        (red, "", r##"Texture "hole.png""##, mask, 1.0),
        (
            red,
            "",
            r##"Texture "hole.png" Alpha 0.5"##,
            AlphaMode::Blend,
            0.5,
        ),
    ] {
        let material = material(paint, defs, string);
        assert_eq!(material.alpha_mode, mode, "{paint} {defs} {string}");
        assert_eq!(material.base_color[3], alpha, "{paint} {string}");
    }
}

#[test]
fn color_replaces_a_gradient_and_tints_a_file() {
    let gradient = r##"<linearGradient id="g"><stop stop-color="red"/><stop offset="1" stop-color="blue"/></linearGradient>"##;
    let plain = material(r##"fill="url(#g)""##, gradient, "Color 0 1 0");
    assert_eq!(
        (plain.base_color, plain.base_color_texture),
        ([0.0, 1.0, 0.0, 1.0], None)
    );
    let baked = material(r##"fill="url(#g)""##, gradient, "Shape flat");
    assert_eq!(baked.base_color, [1.0; 4]);
    let file = material(r##"fill="red""##, "", r##"Texture "whole.png""##);
    assert_eq!(file.base_color, [1.0; 4]);
    let tinted = material(
        r##"fill="red""##,
        "",
        r##"Texture "whole.png" Color 0 1 0"##,
    );
    assert_eq!(tinted.base_color, [0.0, 1.0, 0.0, 1.0]);
    assert!(tinted.base_color_texture.is_some());
    let factors = material(
        r##"fill="red""##,
        "",
        "Metallic 1 Roughness 0.25 Emissive 1 0 0.5",
    );
    assert_eq!((factors.metallic, factors.roughness), (1.0, 0.25));
    // sRGB becomes linear light.
    assert!(
        (factors.emissive[2] - 0.214).abs() < 1e-3,
        "{:?}",
        factors.emissive
    );
}

#[test]
fn equal_paints_share_a_texture_and_a_material() {
    let stops = r##"<stop stop-color="red"/><stop offset="1" stop-color="blue"/>"##;
    let defs = format!(
        r##"<linearGradient id="s">{stops}</linearGradient><linearGradient id="a" xlink:href="#s" gradientUnits="userSpaceOnUse" x2="40"/><linearGradient id="b" xlink:href="#s" y2="3"/>"##
    );
    let rect = |i: usize| {
        let server = ["a", "b", "s"][i % 3];
        format!(
            r##"<rect x="{}" y="{}" width="{}" height="7" fill="url(#{server})"/>"##,
            i % 10 * 11,
            i / 10 * 9,
            5 + i % 4
        )
    };
    let body: String = (0..60).map(rect).collect();
    let compiled = compiled(&drawing(&defs, &body), &MemoryResolver::default());
    let scene = &compiled.scene;
    assert_eq!(
        (
            scene.textures.len(),
            scene.images.len(),
            scene.materials.len()
        ),
        (1, 1, 1)
    );
    assert_eq!(scene.images.raw[0].media_type, MediaType::Png);
    assert_eq!(scene.meshes.len(), 60);
}

#[test]
fn patterns_beyond_the_limits_are_reported() {
    let row =
        |inner: &str| format!(r##"<rect width="9" height="9" fill="url(#{inner})"/>"##).repeat(12);
    let nest = |id: &str, inner: &str| {
        format!(
            r##"<pattern id="{id}" patternUnits="userSpaceOnUse" width="9" height="9">{}</pattern>"##,
            row(inner)
        )
    };
    let leaf = r##"<pattern id="a" patternUnits="userSpaceOnUse" width="9" height="9"><rect width="4" height="4" fill="red"/></pattern>"##;
    for (defs, why) in [
        (format!("{leaf}{}{}{}{}", nest("b", "a"), nest("c", "b"), nest("d", "c"), nest("paint", "d")), "too complex"),
        (
            r##"<pattern id="a" patternUnits="userSpaceOnUse" width="1000000" height="1000000"><rect width="4" height="4" fill="red"/></pattern><pattern id="paint" patternUnits="userSpaceOnUse" width="9" height="9"><rect width="9" height="9" fill="url(#a)"/></pattern>"##.to_owned(),
            "too large",
        ),
        (
            r##"<filter id="f"><feTurbulence numOctaves="1000000000"/></filter><pattern id="paint" patternUnits="userSpaceOnUse" width="9" height="9"><rect width="9" height="9" fill="red" filter="url(#f)"/></pattern>"##.to_owned(),
            "filter",
        ),
    ] {
        let compiled = compiled(&drawing(&defs, SHAPES), &MemoryResolver::default());
        let told: Vec<_> = compiled.diagnostics.iter().filter(|d| d.code == Code::PlainPaint).collect();
        // Once per paint, not per part.
        assert_eq!(told.len(), 1, "{:?}", compiled.diagnostics);
        assert!(told[0].message.contains(why), "{}", told[0].message);
        assert!(compiled.scene.textures.is_empty());
        assert_eq!(compiled.scene.meshes.len(), 3);
    }
}

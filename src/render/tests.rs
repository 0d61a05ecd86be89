//! Pictures of models made by hand.

use std::io::Cursor;

use base64::Engine as _;
use glam::{Vec2, Vec3};
use image::{ImageFormat, RgbaImage};
use serde_json::{Value, json};

use super::*;
use crate::resolver::MemoryResolver;

mod bend;
mod cameras;
mod files;
mod film;

/// A mesh on a node of its own.
#[derive(Clone)]
struct Shape {
    positions: Vec<Vec3>,
    uvs: Vec<Vec2>,
    triangles: Vec<[u32; 3]>,
    material: Value,
    /// Merged into the node.
    node: Value,
    /// Added to the attributes, each with its accessor's type and component type.
    more: Vec<(&'static str, &'static str, u32, Vec<u8>)>,
}

fn shape(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>, material: Value) -> Shape {
    Shape {
        positions,
        uvs: vec![],
        triangles,
        material,
        node: json!({}),
        more: vec![],
    }
}

/// A square that faces +Z, `2 * half` wide.
fn square(middle: Vec3, half: f32, material: Value) -> Shape {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let positions = corners
        .map(|(x, y)| middle + Vec3::new(x, y, 0.0) * half)
        .to_vec();
    let uvs = corners
        .map(|(x, y): (f32, f32)| Vec2::new(x + 1.0, 1.0 - y) / 2.0)
        .to_vec();
    Shape {
        uvs,
        ..shape(positions, vec![[0, 1, 2], [0, 2, 3]], material)
    }
}

fn sphere(material: Value) -> Shape {
    const RINGS: u32 = 32;
    const SECTORS: u32 = 64;
    let mut positions = vec![];
    for ring in 0..=RINGS {
        for sector in 0..SECTORS {
            let (lat, lon) = (ring as f32 / RINGS as f32, sector as f32 / SECTORS as f32);
            let (down, round) = (lat * std::f32::consts::PI, lon * std::f32::consts::TAU);
            positions.push(Vec3::new(
                down.sin() * round.sin(),
                down.cos(),
                down.sin() * round.cos(),
            ));
        }
    }
    let mut triangles = vec![];
    for ring in 0..RINGS {
        for sector in 0..SECTORS {
            let next = (sector + 1) % SECTORS;
            let at = |ring: u32, sector: u32| ring * SECTORS + sector;
            let (a, b, c, d) = (
                at(ring, sector),
                at(ring + 1, sector),
                at(ring + 1, next),
                at(ring, next),
            );
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    shape(positions, triangles, material)
}

fn plain(r: f32, g: f32, b: f32, alpha: f32) -> Value {
    let mode = if alpha < 1.0 { "BLEND" } else { "OPAQUE" };
    json!({
        "pbrMetallicRoughness": { "baseColorFactor": [r, g, b, alpha], "metallicFactor": 0 },
        "alphaMode": mode,
    })
}

/// An unlit material.
fn unlit(r: f32, g: f32, b: f32, alpha: f32) -> Value {
    let mut material = plain(r, g, b, alpha);
    material["extensions"] = json!({ "KHR_materials_unlit": {} });
    material
}

fn bytes(floats: impl IntoIterator<Item = f32>) -> Vec<u8> {
    floats.into_iter().flat_map(f32::to_le_bytes).collect()
}

/// A `.gltf` with the shapes; `extra` is merged into its top level.
fn file(shapes: &[Shape], extra: &Value) -> Vec<u8> {
    let (mut data, mut views, mut accessors) = (vec![], vec![], vec![]);
    let mut list = |kind: &str, component: u32, count: usize, list: &[u8]| {
        views.push(json!({ "buffer": 0, "byteOffset": data.len(), "byteLength": list.len() }));
        data.extend_from_slice(list);
        data.resize(data.len().next_multiple_of(4), 0);
        let view = views.len() - 1;
        accessors.push(json!({
            "bufferView": view, "componentType": component, "count": count, "type": kind,
            "min": [-9, -9, -9], "max": [9, 9, 9],
        }));
        if kind != "VEC3" {
            let last = accessors.len() - 1;
            let fields = accessors[last].as_object_mut().unwrap();
            fields.remove("min");
            fields.remove("max");
        }
        accessors.len() - 1
    };
    let (mut meshes, mut nodes, mut materials) = (vec![], vec![], vec![]);
    for (index, shape) in shapes.iter().enumerate() {
        let count = shape.positions.len();
        let positions = bytes(shape.positions.iter().flat_map(|p| p.to_array()));
        let mut attributes = json!({ "POSITION": list("VEC3", 5126, count, &positions) });
        if !shape.uvs.is_empty() {
            let uvs = bytes(shape.uvs.iter().flat_map(|p| p.to_array()));
            attributes["TEXCOORD_0"] = list("VEC2", 5126, count, &uvs).into();
        }
        for (name, kind, component, values) in &shape.more {
            attributes[*name] = list(kind, *component, count, values).into();
        }
        let corners: Vec<u8> = shape
            .triangles
            .iter()
            .flatten()
            .flat_map(|c| c.to_le_bytes())
            .collect();
        let indices = list("SCALAR", 5125, shape.triangles.len() * 3, &corners);
        meshes.push(json!({ "primitives": [{ "attributes": attributes, "indices": indices, "material": index }] }));
        let mut node = shape.node.clone();
        node["mesh"] = index.into();
        nodes.push(node);
        materials.push(shape.material.clone());
    }
    let roots: Vec<usize> = (0..nodes.len()).collect();
    let data = base64::engine::general_purpose::STANDARD.encode(&data);
    let length = base64::engine::general_purpose::STANDARD
        .decode(&data)
        .unwrap()
        .len();
    let mut root = json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": roots }], "nodes": nodes, "meshes": meshes,
        "materials": materials, "accessors": accessors, "bufferViews": views, "extensionsUsed": ["KHR_materials_unlit"],
        "buffers": [{ "byteLength": length, "uri": format!("data:application/octet-stream;base64,{data}") }],
    });
    for (key, value) in extra.as_object().unwrap() {
        match root.get_mut(key).and_then(Value::as_array_mut) {
            Some(list) => list.extend(value.as_array().unwrap().iter().cloned()),
            None => root[key] = value.clone(),
        }
    }
    serde_json::to_vec(&root).unwrap()
}

const FRONT: View = View {
    yaw: 0.0,
    pitch: 0.0,
};

fn front(side: u32) -> Options {
    let projection = Projection::Orthographic;
    Options {
        size: [side, side],
        view: FRONT,
        projection,
        ..Options::default()
    }
}

#[track_caller]
fn picture(file: &[u8], options: &Options) -> Image {
    let model = read(file, &MemoryResolver::default()).unwrap();
    let posed = PosedModel::new(&model, &model.rest()).unwrap();
    posed.picture(options).unwrap()
}

#[track_caller]
fn of(shapes: &[Shape], options: &Options) -> Image {
    picture(&file(shapes, &json!({})), options)
}

/// The bounding box of all mostly opaque pixels: left, top, right, bottom, the latter two exclusive.
fn extent(image: &Image) -> [u32; 4] {
    let there = image
        .enumerate_pixels()
        .filter(|(_, _, pixel)| pixel.0[3] > 200);
    there.fold([u32::MAX, u32::MAX, 0, 0], |[l, t, r, b], (x, y, _)| {
        [l.min(x), t.min(y), r.max(x + 1), b.max(y + 1)]
    })
}

#[track_caller]
fn near(pixel: &image::Rgba<u8>, wanted: [u8; 4]) {
    let far = pixel.0.iter().zip(wanted).any(|(a, b)| a.abs_diff(b) > 2);
    assert!(!far, "{:?} is not {wanted:?}", pixel.0);
}

#[test]
fn a_sphere_is_round_and_lit_from_the_upper_left() {
    let image = of(&[sphere(plain(0.5, 0.5, 0.5, 1.0))], &front(200));
    let [l, t, r, b] = extent(&image);
    for (low, high) in [(l, r), (t, b)] {
        assert!(
            (10..=14).contains(&low) && (186..=190).contains(&high),
            "{low} to {high}"
        );
    }
    let there = image.pixels().filter(|pixel| pixel.0[3] > 200).count() as f32;
    let disk = std::f32::consts::PI * 88.0 * 88.0;
    assert!(
        (there / disk - 1.0).abs() < 0.02,
        "{there} pixels of {disk}"
    );
    let at = |x: u32, y: u32| image.get_pixel(x, y).0[0];
    assert!(
        at(70, 60) > at(100, 130) + 10,
        "{} over {}",
        at(70, 60),
        at(100, 130)
    );
    assert!(at(100, 130) > at(130, 170) + 10);
    let flat = of(
        &[sphere(plain(0.5, 0.5, 0.5, 1.0))],
        &Options {
            shading: Shading::Flat,
            ..front(200)
        },
    );
    assert_eq!(extent(&flat), extent(&image));
}

#[test]
fn what_is_in_front_hides_what_is_behind() {
    let far = square(Vec3::ZERO, 1.0, unlit(1.0, 0.0, 0.0, 1.0));
    let close = square(Vec3::Z, 0.5, unlit(0.0, 1.0, 0.0, 1.0));
    let forth = of(&[far, close], &front(100));
    let far = square(Vec3::ZERO, 1.0, unlit(1.0, 0.0, 0.0, 1.0));
    let close = square(Vec3::Z, 0.5, unlit(0.0, 1.0, 0.0, 1.0));
    let back = of(&[close, far], &front(100));
    for image in [forth, back] {
        near(image.get_pixel(50, 50), [0, 255, 0, 255]);
        near(image.get_pixel(15, 50), [255, 0, 0, 255]);
        near(image.get_pixel(1, 50), [0; 4]);
    }
}

#[test]
fn transparent_surfaces_are_blended_in_order() {
    // Whatever their order in the file.
    let shapes = [
        square(Vec3::Z, 1.0, unlit(0.0, 0.0, 1.0, 0.5)),
        square(Vec3::ZERO, 1.0, unlit(1.0, 0.0, 0.0, 1.0)),
        square(Vec3::Z * 0.5, 1.0, unlit(0.0, 1.0, 0.0, 0.5)),
    ];
    let image = of(&shapes, &front(60));
    let [half, quarter] = [0.5, 0.25].map(texture::linear_to_srgb);
    near(image.get_pixel(30, 30), [quarter, quarter, half, 255]);
    let glass = of(
        &[square(Vec3::ZERO, 1.0, unlit(0.0, 0.0, 1.0, 0.25))],
        &front(60),
    );
    near(glass.get_pixel(30, 30), [0, 0, 255, 64]);
    let white = Options {
        background: Some([255; 3]),
        ..front(60)
    };
    let glass = of(
        &[square(Vec3::ZERO, 1.0, unlit(0.0, 0.0, 1.0, 0.25))],
        &white,
    );
    let rest = texture::linear_to_srgb(0.75);
    near(glass.get_pixel(30, 30), [rest, rest, 255, 255]);
}

#[test]
fn orthographic_projection_keeps_the_scale() {
    let pair = || {
        [
            square(Vec3::new(-2.0, 0.0, 0.0), 1.0, unlit(1.0, 0.0, 0.0, 1.0)),
            square(Vec3::new(2.0, 0.0, -6.0), 1.0, unlit(0.0, 0.0, 1.0, 1.0)),
        ]
    };
    let wide = |image: &Image, channel: usize| {
        let y = image.height() / 2;
        (0..image.width())
            .filter(|x| {
                image.get_pixel(*x, y).0[channel] > 128 && image.get_pixel(*x, y).0[3] > 128
            })
            .count()
    };
    let image = of(&pair(), &front(300));
    assert!(
        wide(&image, 0).abs_diff(wide(&image, 2)) <= 1,
        "{} and {}",
        wide(&image, 0),
        wide(&image, 2)
    );
    // Six units wide, in the 300 pixels without the margin.
    assert!(wide(&image, 0).abs_diff(88) <= 1, "{}", wide(&image, 0));
    let lens = Options {
        projection: Projection::Perspective,
        ..front(300)
    };
    let image = of(&pair(), &lens);
    assert!(
        wide(&image, 0) > wide(&image, 2) + 8,
        "{} and {}",
        wide(&image, 0),
        wide(&image, 2)
    );
}

#[test]
fn the_framing_is_tight_and_cuts_nothing_off() {
    let long = || {
        let mut ball = sphere(unlit(1.0, 1.0, 1.0, 1.0));
        ball.node = json!({ "scale": [1, 3, 0.5], "translation": [500, 20, -3], "rotation": [0, 0, 0.3826834, 0.9238795] });
        [ball]
    };
    for projection in [Projection::Perspective, Projection::Orthographic] {
        for (yaw, pitch) in [(0.0, 0.0), (30.0, 15.0), (200.0, -40.0), (75.0, 90.0)] {
            for size in [[160, 160], [240, 90], [70, 200]] {
                let view = View { yaw, pitch };
                let image = of(
                    &long(),
                    &Options {
                        size,
                        view,
                        projection,
                        ..Options::default()
                    },
                );
                let [l, t, r, b] = extent(&image);
                let [w, h] = size;
                assert!(
                    l > 0 && t > 0 && r < w && b < h,
                    "{view:?} {size:?} {l} {t} {r} {b}"
                );
                let filled = ((r - l) as f32 / w as f32).max((b - t) as f32 / h as f32);
                assert!(filled > 0.7, "{view:?} {size:?} {filled}");
                // Centred in the other direction too.
                assert!(
                    (l + r).abs_diff(w) <= 4 && (t + b).abs_diff(h) <= 4,
                    "{view:?} {size:?} {l} {t} {r} {b}"
                );
            }
        }
    }
}

#[test]
fn a_turntable_goes_once_round() {
    let shapes = [
        square(Vec3::Z, 1.0, unlit(1.0, 0.0, 0.0, 1.0)),
        sphere(plain(0.2, 0.5, 0.8, 1.0)),
    ];
    let model = read(&file(&shapes, &json!({})), &MemoryResolver::default()).unwrap();
    let posed = PosedModel::new(&model, &model.rest()).unwrap();
    let turn = |frames: u32, view: View| {
        let mut images: Vec<Image> = vec![];
        let options = Options {
            view,
            size: [64, 64],
            ..Options::default()
        };
        let done = posed.turntable(&options, frames, |image| -> Result<(), RenderError> {
            images.push(image);
            Ok(())
        });
        done.unwrap();
        images
    };
    let images = turn(5, View::default());
    assert_eq!(images.len(), 5);
    for (index, image) in images.iter().enumerate() {
        assert!(
            images[..index].iter().all(|other| other != image),
            "frame {index} came before"
        );
    }
    // The frame after the last is the first: a turn that starts one frame later ends with it.
    let later = turn(
        5,
        View {
            yaw: 30.0 + 72.0,
            pitch: 15.0,
        },
    );
    let far = later[4]
        .as_raw()
        .iter()
        .zip(images[0].as_raw())
        .filter(|(a, b)| a.abs_diff(**b) > 2)
        .count();
    assert!(far < 20, "{far} bytes differ");
}

#[test]
fn pictures_do_not_depend_on_the_number_of_threads() {
    let file = file(
        &[
            sphere(plain(0.5, 0.6, 0.7, 1.0)),
            square(Vec3::Z, 0.7, plain(1.0, 0.2, 0.1, 0.5)),
        ],
        &json!({}),
    );
    let model = read(&file, &MemoryResolver::default()).unwrap();
    let posed = PosedModel::new(&model, &model.rest()).unwrap();
    let options = Options {
        size: [150, 150],
        ..Options::default()
    };
    let image = posed.picture(&options).unwrap();
    let alone = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    assert!(alone.install(|| posed.drawn_here(&options).unwrap()) == image);
}

#[test]
fn shadows_lie_on_the_ground_and_end_before_the_border() {
    let image = of(
        &[sphere(plain(0.8, 0.8, 0.8, 1.0))],
        &Options {
            size: [200, 200],
            ..Options::default()
        },
    );
    let shadow = |pixel: &image::Rgba<u8>| pixel.0[3] > 20 && pixel.0[..3] == [0; 3];
    assert!(image.pixels().filter(|pixel| shadow(pixel)).count() > 200);
    for (x, y, pixel) in image.enumerate_pixels() {
        let border = x == 0 || y == 0 || x == 199 || y == 199;
        assert!(!border || pixel.0[3] < 4, "{x} {y} {pixel:?}");
    }
    // There is no ground from below.
    let below = Options {
        view: View {
            yaw: 0.0,
            pitch: -30.0,
        },
        size: [100, 100],
        ..Options::default()
    };
    assert!(
        !of(&[sphere(plain(0.8, 0.8, 0.8, 1.0))], &below)
            .pixels()
            .any(shadow)
    );
}

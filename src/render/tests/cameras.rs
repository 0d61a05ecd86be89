use super::film::{moving, red};
use std::sync::Arc;

use glam::DQuat;

use super::*;
use crate::export::{GLB, to_memory};
use crate::scene::{
    self, Animation, Interpolation, Material, Mesh, NewNode, Node, Primitive, Scene, Surface,
    Timing, Track, Values,
};

/// A `.gltf` with the shapes and, at the next node, a camera.
fn with_camera(shapes: &[Shape], node: Value, projection: Value) -> Vec<u8> {
    with_node(&file(shapes, &json!({})), node, projection)
}

/// The file with a node more, which has a camera.
fn with_node(file: &[u8], mut node: Value, projection: Value) -> Vec<u8> {
    let mut root: Value = serde_json::from_slice(file).unwrap();
    node["camera"] = 0.into();
    root["cameras"] = json!([projection]);
    let nodes = root["nodes"].as_array_mut().unwrap();
    nodes.push(node);
    let last = nodes.len() - 1;
    let shown = root["scenes"][0]["nodes"].as_array_mut().unwrap();
    shown.push(last.into());
    serde_json::to_vec(&root).unwrap()
}

fn perspective(yfov: f64) -> Value {
    json!({ "type": "perspective", "perspective": { "yfov": yfov, "znear": 0.01 } })
}

fn orthographic(half_height: f64) -> Value {
    let lens = json!({ "xmag": half_height, "ymag": half_height, "znear": 0, "zfar": 100 });
    json!({ "type": "orthographic", "orthographic": lens })
}

fn model(bytes: &[u8]) -> Model {
    read(bytes, &MemoryResolver::default()).unwrap()
}

/// The mean and the largest difference of two pictures' bytes.
fn differences(one: &Image, other: &Image) -> (f64, u8) {
    assert_eq!(one.dimensions(), other.dimensions());
    let bytes = one.as_raw().iter().zip(other.as_raw());
    let apart: Vec<u8> = bytes.map(|(a, b)| a.abs_diff(*b)).collect();
    let sum: u64 = apart.iter().map(|byte| u64::from(*byte)).sum();
    let most = apart.iter().copied().max().unwrap_or(0);
    (sum as f64 / apart.len() as f64, most)
}

/// A camera where the one of a view is, for a sphere, whose picture has its middle in the middle.
#[test]
fn a_camera_of_the_file_gives_the_picture_of_the_same_view() {
    let ball = || [sphere(plain(0.8, 0.5, 0.3, 1.0))];
    let lens = 18.0 / 85.0;
    for size in [[70_u32, 70], [90, 60], [60, 90]] {
        let sides = size.map(f64::from);
        let [longer, shorter] = [sides[0].max(sides[1]), sides[0].min(sides[1])];
        let inner = sides.map(|side| (side - 0.12 * shorter) / longer);
        for (projection, yaw, pitch) in [
            (Projection::Perspective, 0.0, 0.0),
            (Projection::Perspective, 90.0, 0.0),
            (Projection::Perspective, -90.0, 90.0),
            (Projection::Orthographic, 180.0, 0.0),
            (Projection::Orthographic, 90.0, -90.0),
        ] {
            let view = View { yaw, pitch };
            let turn = glam::DQuat::from_rotation_y(f64::to_radians(yaw))
                * glam::DQuat::from_rotation_x(-f64::to_radians(pitch));
            let seen = ball()[0].positions.clone();
            let seen: Vec<DVec3> = seen.iter().map(|p| turn.inverse() * p.as_dvec3()).collect();
            let reach = |axis: usize, slope: f64| {
                let far = seen.iter().map(|p| p[axis] + slope * p.z);
                far.fold(0.0, f64::max)
            };
            let (distance, json) = match projection {
                Projection::Perspective => {
                    let away = |axis: usize| reach(axis, inner[axis] * lens) / (inner[axis] * lens);
                    let angle = 2.0 * (lens * sides[1] / longer).atan();
                    (away(0).max(away(1)), perspective(angle))
                }
                Projection::Orthographic => {
                    let half = (reach(0, 0.0) / inner[0]).max(reach(1, 0.0) / inner[1]);
                    (5.0, orthographic(half * sides[1] / longer))
                }
            };
            let node = json!({
                "translation": (turn * DVec3::Z * distance).to_array(),
                "rotation": turn.to_array(),
            });
            let model = model(&with_camera(&ball(), node, json));
            let posed = PosedModel::new(&model, &model.rest()).unwrap();
            let options = Options {
                size,
                view,
                projection,
                background: Some([255; 3]),
                ..Options::default()
            };
            let own = posed.picture(&options).unwrap();
            let other = Options {
                view: View::default(),
                projection: Projection::default(),
                ..options
            };
            let by_camera = posed.picture_by(&other, &model.cameras()[0]).unwrap();
            let (mean, most) = differences(&own, &by_camera);
            assert!(mean < 0.05 && most < 40, "{size:?} {view:?} {mean} {most}");
        }
    }
}

/// A red square before a camera that moves to its right for two seconds and rests for another.
fn tracking_shot(interpolation: &str) -> Model {
    let shape = square(Vec3::ZERO, 0.25, unlit(1.0, 0.0, 0.0, 1.0));
    let places = [0.0, 0.5, 1.0].map(|x| Vec3::new(x, 0.0, 4.0));
    let file = moving(shape, "translation", places, interpolation);
    let mut root: Value = serde_json::from_slice(&file).unwrap();
    root["animations"][0]["channels"][0]["target"]["node"] = 1.into();
    let lens = perspective(2.0 * f64::atan(0.5));
    model(&with_node(
        &serde_json::to_vec(&root).unwrap(),
        json!({ "name": "Dolly" }),
        lens,
    ))
}

fn frames(film: &Film<'_>, times: &[f64]) -> Vec<Image> {
    let options = Options {
        size: [200, 100],
        ..Options::default()
    };
    let mut images = vec![];
    let shooting = film.shooting(&options).unwrap();
    let drawn = shooting.draw(times.iter().copied(), |image| {
        images.push(image);
        Ok::<(), RenderError>(())
    });
    drawn.unwrap();
    images
}

#[test]
fn a_moving_camera_moves_the_picture() {
    let model = tracking_shot("LINEAR");
    let clip = &model.clips()[0];
    let camera = model.camera_of(clip).unwrap();
    assert_eq!(camera.name, "Dolly");
    let film = Film::new(&model, clip, [0.0, 3.0]).unwrap();
    let film = film.filmed_by(camera).unwrap();
    let images = frames(&film, &[0.0, 1.0, 2.0]);
    // The picture is 4 m high at the square, so 25 pixels are a metre.
    let columns: Vec<(u32, u32)> = images.iter().map(red).collect();
    for ((low, high), middle) in columns.iter().zip([100.0, 87.5, 75.0]) {
        let own = f64::from(low + high + 1) / 2.0;
        assert!((own - middle).abs() < 1.1, "{columns:?}");
        assert!((10..=13).contains(&(high - low)), "{columns:?}");
    }
    // A strip shows the same.
    let options = Options {
        size: [200, 100],
        ..Options::default()
    };
    let strip = film.film_strip(&options, 4, |_| ()).unwrap();
    let second = image::imageops::crop_imm(&strip, 200, 0, 200, 100).to_image();
    assert_eq!(red(&second), columns[1]);
}

#[test]
fn pictures_are_equal_if_the_camera_is_too() {
    let count = |model: &Model, is_filmed: bool| {
        let film = Film::new(model, &model.clips()[0], [0.0, 3.0]).unwrap();
        let film = if is_filmed {
            film.filmed_by(&model.cameras()[0]).unwrap()
        } else {
            film
        };
        film.held_frames(24).unwrap().len()
    };
    let smooth = tracking_shot("LINEAR");
    assert_eq!([true, false].map(|filmed| count(&smooth, filmed)), [49, 1]);
    let held = tracking_shot("STEP");
    assert_eq!([true, false].map(|filmed| count(&held, filmed)), [3, 1]);
}

/// A ball, and a camera that steps from its front to its back after two seconds.
fn orbiting() -> Model {
    let Shape {
        positions,
        triangles,
        ..
    } = sphere(plain(1.0, 1.0, 1.0, 1.0));
    let corners: Vec<[f32; 3]> = positions.iter().map(|p| p.to_array()).collect();
    let ball = Surface {
        normals: corners.clone(),
        positions: corners,
        triangles,
        ..Surface::default()
    };
    let mut scene = Scene::default();
    let material = scene.materials.push_and_get_key(Material::default());
    scene.add(NewNode {
        mesh: Some(Mesh {
            primitives: vec![Primitive {
                patches: vec![ball.into()],
                material,
            }],
        }),
        ..NewNode::default()
    });
    let camera = scene.cameras.push_and_get_key(scene::Camera {
        name: String::new(),
        projection: scene::CameraProjection::Perspective {
            vertical_field_of_view: 0.6,
            near: 0.01,
            far: None,
        },
    });
    let node = scene.add(NewNode {
        node: Node {
            camera: Some(camera),
            ..Node::default()
        },
        ..NewNode::default()
    });
    let timing = Arc::new(Timing {
        times: vec![0.0, 2.0, 3.0],
        interpolation: Interpolation::Step,
    });
    let back = DQuat::from_rotation_y(std::f64::consts::PI);
    let track = |values| Track {
        node,
        timing: timing.clone(),
        values,
    };
    scene.animations.push(Animation {
        name: "orbit".to_owned(),
        tracks: vec![
            track(Values::Translations(
                [5.0, -5.0, -5.0].map(|z| DVec3::Z * z).to_vec(),
            )),
            track(Values::Rotations(vec![DQuat::IDENTITY, back, back].into())),
        ],
    });
    model(&to_memory(&GLB, &scene, None).unwrap().bytes)
}

#[test]
fn lights_do_not_turn_with_the_camera() {
    let model = orbiting();
    let at = |span: [f64; 2], time: f64| {
        let film = Film::new(&model, &model.clips()[0], span).unwrap();
        let film = film.filmed_by(&model.cameras()[0]).unwrap();
        frames(&film, &[time]).remove(0)
    };
    let front = at([0.0, 3.0], 0.0);
    let back = at([0.0, 3.0], 2.0);
    assert!(
        differences(&front, &back).0 > 3.0,
        "another side of the light"
    );
    // A film that begins there has its light there.
    let (mean, most) = differences(&front, &at([2.0, 3.0], 2.0));
    assert!(mean < 0.3 && most < 60, "{mean} {most}");
}

#[test]
fn lines_show_how_far_a_moving_camera_goes() {
    // The square goes to the right; a camera goes along, or stays.
    let shape = square(Vec3::ZERO, 0.25, unlit(1.0, 0.0, 0.0, 1.0));
    let places = [0.0, 0.5, 1.0].map(|x| Vec3::new(x, 0.0, 0.0));
    let lines = |is_moving: bool| {
        let walker = moving(shape.clone(), "translation", places, "LINEAR");
        let mut root: Value = serde_json::from_slice(&walker).unwrap();
        if is_moving {
            let mut channel = root["animations"][0]["channels"][0].clone();
            channel["target"]["node"] = 1.into();
            let channels = root["animations"][0]["channels"].as_array_mut().unwrap();
            channels.push(channel);
        }
        let walker = serde_json::to_vec(&root).unwrap();
        let node = json!({ "children": [2] });
        let mut root: Value =
            serde_json::from_slice(&with_node(&walker, node, perspective(0.6))).unwrap();
        // The camera hangs on the node that moves.
        root["nodes"][1].as_object_mut().unwrap().remove("camera");
        let above = json!({ "camera": 0, "translation": [0, 0, 4] });
        root["nodes"].as_array_mut().unwrap().push(above);
        let model = model(&serde_json::to_vec(&root).unwrap());
        let film = Film::new(&model, &model.clips()[0], [0.0, 3.0]).unwrap();
        let film = film.filmed_by(&model.cameras()[0]).unwrap();
        let image = frames(&film, &[1.0]).remove(0);
        let gray = image.pixels().filter(|pixel| {
            let [r, g, b, alpha] = pixel.0;
            r == g && g == b && (90..=150).contains(&r) && alpha > 5
        });
        gray.count()
    };
    assert!(lines(true) > 20, "{}", lines(true));
    assert_eq!(lines(false), 0);
}

#[test]
fn only_what_is_between_the_planes_is_shown() {
    let shapes = [
        square(Vec3::Z * 3.0, 0.5, unlit(0.0, 0.0, 1.0, 1.0)),
        square(Vec3::ZERO, 0.5, unlit(1.0, 0.0, 0.0, 1.0)),
        square(Vec3::Z * -3.0, 2.0, unlit(0.0, 1.0, 0.0, 1.0)),
    ];
    let colors = |lens: Value| {
        let node = json!({ "translation": [0, 0, 4] });
        let model = model(&with_camera(&shapes, node, lens));
        let posed = PosedModel::new(&model, &model.rest()).unwrap();
        let options = Options {
            size: [80, 80],
            background: Some([0; 3]),
            ..Options::default()
        };
        let image = posed.picture_by(&options, &model.cameras()[0]).unwrap();
        [[40, 40], [20, 40]].map(|[x, y]| {
            let [r, g, b, _] = image.get_pixel(x, y).0;
            [r, g, b]
        })
    };
    let (red, green, blue) = ([255, 0, 0], [0, 255, 0], [0, 0, 255]);
    let angle = 2.0 * f64::atan(0.5);
    let lens = |near: f64, far: Option<f64>| {
        let mut lens = perspective(angle);
        lens["perspective"]["znear"] = near.into();
        far.inspect(|far| lens["perspective"]["zfar"] = (*far).into());
        lens
    };
    assert_eq!(colors(lens(0.1, None)), [blue, blue]);
    assert_eq!(colors(lens(2.0, None)), [red, green]);
    assert_eq!(colors(lens(2.0, Some(5.0))), [red, [0; 3]]);
    assert_eq!(colors(orthographic(1.2)), [blue, green]);
}

#[test]
fn a_camera_without_a_direction_is_an_error() {
    let shape = square(Vec3::ZERO, 0.5, unlit(1.0, 0.0, 0.0, 1.0));
    let node = json!({ "name": "Flat", "scale": [1, 1, 0] });
    let model = model(&with_camera(&[shape], node, perspective(1.0)));
    let posed = PosedModel::new(&model, &model.rest()).unwrap();
    let error = posed.picture_by(&Options::default(), &model.cameras()[0]);
    let error = error.unwrap_err().to_string();
    assert!(error.contains("camera `Flat` without a place"), "{error}");
}

use base64::Engine as _;
use serde_json::{Value, json};

use super::*;
use crate::import::ParsedFile;
use crate::resolver::MemoryResolver;

/// An accessor: component type, element type, and its bytes.
type List = (u32, &'static str, Vec<u8>);

fn floats(element: &'static str, numbers: &[f32]) -> List {
    let bytes = numbers.iter().flat_map(|number| number.to_le_bytes());
    (5126, element, bytes.collect())
}

/// A file of two nodes, the second with a matrix: scaled by two, rotated by 90° about x, moved by one to the right.
fn gltf(lists: &[List], animations: &Value) -> Value {
    let (mut data, mut views, mut accessors) = (vec![], vec![], vec![]);
    for (component, element, bytes) in lists {
        let width = match component {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            _ => 4,
        };
        let parts = match *element {
            "SCALAR" => 1,
            "VEC3" => 3,
            _ => 4,
        };
        accessors.push(json!({
            "bufferView": views.len(), "componentType": component, "type": element,
            "count": bytes.len() / width / parts, "normalized": *component < 5126,
        }));
        views.push(json!({ "buffer": 0, "byteOffset": data.len(), "byteLength": bytes.len() }));
        data.extend_from_slice(bytes);
        data.resize(data.len().next_multiple_of(4), 0);
    }
    let uri = base64::engine::general_purpose::STANDARD.encode(&data);
    json!({
        "asset": { "version": "2.0" },
        "nodes": [
            { "translation": [1, 2, 3], "scale": [1, 1, 2] },
            { "matrix": [2, 0, 0, 0, 0, 0, 2, 0, 0, -2, 0, 0, 1, 0, 0, 1] },
        ],
        "buffers": [{
            "byteLength": data.len(), "uri": format!("data:application/octet-stream;base64,{uri}"),
        }],
        "bufferViews": views,
        "accessors": accessors,
        "animations": animations,
    })
}

/// One channel of accessors 0 and 1.
fn moving(node: usize, path: &str, interpolation: &str) -> Value {
    json!({
        "name": "move",
        "channels": [{ "sampler": 0, "target": { "node": node, "path": path } }],
        "samplers": [{ "input": 0, "output": 1, "interpolation": interpolation }],
    })
}

fn opened(file: &Value) -> Result<(ParsedFile, Vec<Clip>), ImportError> {
    let bytes = serde_json::to_vec(file).unwrap();
    let file = crate::import::read(&bytes, &MemoryResolver::default())?;
    let clips = read(&file.document, &file.buffers)?;
    Ok((file, clips))
}

fn error_of(file: &Value) -> String {
    match opened(file) {
        Ok(_) => panic!("it is read"),
        Err(error) => error.to_string(),
    }
}

/// Scale, rotation and translation of a node at a time of the first clip.
#[track_caller]
fn at(file: &Value, node: usize, time: f64) -> (DVec3, DQuat, DVec3) {
    let (file, clips) = opened(file).unwrap();
    let pose = clips[0].pose_at(&file.geometry.rest(), time);
    pose.locals[NodeId::from(node)].to_scale_rotation_translation()
}

#[track_caller]
fn stands(file: &Value, time: f64, place: [f64; 3]) {
    let (_, _, found) = at(file, 0, time);
    assert!(found.abs_diff_eq(place.into(), 1e-6), "{time}: {found}");
}

#[track_caller]
fn turned(file: &Value, node: usize, time: f64, degrees: f64) {
    let (_, turn, _) = at(file, node, time);
    let wanted = DQuat::from_rotation_y(degrees.to_radians());
    let apart = turn.angle_between(wanted).to_degrees();
    assert!(apart < 1e-3, "{time}: {turn}, {apart} degrees off");
}

#[test]
fn values_between_keys_are_interpolated() {
    let times = floats("SCALAR", &[1.0, 2.0, 4.0]);
    let places = floats("VEC3", &[0.0, 0.0, 0.0, 8.0, 0.0, 0.0, 8.0, 6.0, 0.0]);
    let lists = [times.clone(), places];
    let linear = gltf(&lists, &json!([moving(0, "translation", "LINEAR")]));
    stands(&linear, 0.0, [0.0; 3]);
    stands(&linear, 1.25, [2.0, 0.0, 0.0]);
    stands(&linear, 3.0, [8.0, 3.0, 0.0]);
    stands(&linear, 9.0, [8.0, 6.0, 0.0]);
    // What the clip does not move keeps its rest pose.
    let (scale, turn, _) = at(&linear, 0, 1.5);
    assert!(scale.abs_diff_eq(DVec3::new(1.0, 1.0, 2.0), 1e-9));
    assert!(turn.abs_diff_eq(DQuat::IDENTITY, 1e-9));
    let step = gltf(&lists, &json!([moving(0, "translation", "STEP")]));
    stands(&step, 0.0, [0.0; 3]);
    stands(&step, 1.99, [0.0; 3]);
    stands(&step, 2.0 - 1e-7, [8.0, 0.0, 0.0]);
    stands(&step, 3.99, [8.0, 0.0, 0.0]);
    stands(&step, 4.0, [8.0, 6.0, 0.0]);
    // In-tangent, value, out-tangent for each key: out of the first at 4 per second, into the second at 0.
    let mut spline = vec![0.0; 27];
    (spline[6], spline[12]) = (4.0, 8.0);
    spline[21] = 8.0;
    let spline = [times, floats("VEC3", &spline)];
    let spline = gltf(&spline, &json!([moving(0, "translation", "CUBICSPLINE")]));
    stands(&spline, 0.5, [0.0; 3]);
    // Half way: half of the end, and an eighth of the tangent.
    stands(&spline, 1.5, [4.5, 0.0, 0.0]);
    stands(&spline, 2.0, [8.0, 0.0, 0.0]);
    stands(&spline, 3.0, [8.0, 0.0, 0.0]);
    stands(&spline, 5.0, [8.0, 0.0, 0.0]);
}

#[test]
fn rotations_take_the_shorter_arc_in_every_component_type() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let times = floats("SCALAR", &[0.0, 1.0]);
    let as_floats = floats("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, -half, 0.0, -half]);
    let shorts = |numbers: [f32; 8], most: f32| -> Vec<u8> {
        let short = |number: f32| ((number * most).round() as i32 as u16).to_le_bytes();
        numbers.into_iter().flat_map(short).collect()
    };
    let quarter = [0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half];
    for (list, precision) in [
        (as_floats, 1e-3),
        ((5122, "VEC4", shorts(quarter, 32767.0)), 1e-2),
        ((5123, "VEC4", shorts(quarter, 65535.0)), 1e-2),
        ((5120, "VEC4", vec![0, 0, 0, 127, 0, 90, 0, 90]), 1e-3),
        ((5121, "VEC4", vec![0, 0, 0, 255, 0, 180, 0, 180]), 1e-3),
    ] {
        let clips = json!([moving(0, "rotation", "LINEAR")]);
        let file = gltf(&[times.clone(), list], &clips);
        for (time, degrees) in [(0.0, 0.0_f64), (0.5, 45.0), (1.0, 90.0)] {
            let (_, turn, _) = at(&file, 0, time);
            let wanted = DQuat::from_rotation_y(degrees.to_radians());
            assert!(turn.angle_between(wanted).to_degrees() < precision);
        }
    }
}

#[test]
fn a_matrix_is_decomposed_only_for_animated_nodes() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let lists = [
        floats("SCALAR", &[0.0]),
        floats("VEC4", &[0.0, half, 0.0, half]),
    ];
    let file = gltf(&lists, &json!([moving(1, "rotation", "LINEAR")]));
    turned(&file, 1, 0.0, 90.0);
    let (scale, _, place) = at(&file, 1, 0.0);
    assert!(scale.abs_diff_eq(DVec3::splat(2.0), 1e-6) && place.abs_diff_eq(DVec3::X, 1e-6));
    // Larger than at rest, with its rotation kept.
    let lists = [floats("SCALAR", &[0.0]), floats("VEC3", &[3.0; 3])];
    let file = gltf(&lists, &json!([moving(1, "scale", "STEP")]));
    let (scale, turn, _) = at(&file, 1, 0.0);
    assert!(scale.abs_diff_eq(DVec3::splat(3.0), 1e-6));
    let quarter = DQuat::from_rotation_x(90_f64.to_radians());
    assert!(turn.angle_between(quarter) < 1e-6);
    let (opened, clips) = opened(&file).unwrap();
    let rest = opened.geometry.rest();
    assert_eq!(
        clips[0].pose_at(&rest, 0.0).locals.first(),
        rest.locals.first()
    );
}

#[test]
fn a_clip_lasts_until_its_last_key() {
    let lists = [floats("SCALAR", &[0.0, 2.0]), floats("VEC3", &[0.0; 6])];
    let clip = json!([moving(0, "translation", "STEP")]);
    let (_, clips) = opened(&gltf(&lists, &clip)).unwrap();
    assert_eq!((clips[0].name.as_str(), clips[0].seconds), ("move", 2.0));
    // Weights are numbers; those of a mesh without morph targets do nothing.
    let weights = json!([moving(0, "weights", "LINEAR")]);
    let error = error_of(&gltf(&lists, &weights));
    assert!(error.contains("a type that is not allowed"), "{error}");
    let lists = [floats("SCALAR", &[0.0, 2.0]), floats("SCALAR", &[0.0; 2])];
    let (_, clips) = opened(&gltf(&lists, &weights)).unwrap();
    assert_eq!((clips.len(), clips[0].seconds), (1, 2.0));
}

#[test]
fn broken_animations_are_refused() {
    let times = || floats("SCALAR", &[0.0, 1.0]);
    let places = || floats("VEC3", &[0.0; 6]);
    let refused = |lists: &[List], clip: Value, message: &str| {
        let error = error_of(&gltf(lists, &json!([clip])));
        assert!(error.contains("is not a readable glTF file"), "{error}");
        assert!(error.contains(message), "{error}");
    };
    let good = || moving(0, "translation", "LINEAR");
    refused(
        &[times(), places()],
        moving(2, "scale", "STEP"),
        "moves node 2, which is not there",
    );
    refused(
        &[times(), places()],
        moving(0, "colour", "STEP"),
        "that nodes do not have",
    );
    refused(
        &[times(), places()],
        moving(0, "rotation", "STEP"),
        "accessor 1 has a type",
    );
    refused(&[places(), places()], good(), "accessor 0 has a type");
    for wrong in [&[1.0, 0.0][..], &[0.0, f32::NAN], &[f32::INFINITY]] {
        refused(
            &[floats("SCALAR", wrong), places()],
            good(),
            "not in ascending order",
        );
    }
    let spline = moving(0, "translation", "CUBICSPLINE");
    refused(
        &[times(), places()],
        spline,
        "needs 6 keys, but accessor 1 has 2",
    );
    refused(
        &[floats("SCALAR", &[0.0]), places()],
        good(),
        "needs 1 keys",
    );
    let nowhere = floats("VEC3", &[0.0, 0.0, 0.0, 0.0, f32::NAN, 0.0]);
    refused(&[times(), nowhere], good(), "a key that is not a number");
    let mut twice = good();
    let first = twice["channels"][0].clone();
    twice["channels"].as_array_mut().unwrap().push(first);
    refused(
        &[times(), places()],
        twice,
        "two channels for the same property of node 0",
    );
    let mut beyond = gltf(&[times(), places()], &json!([good()]));
    beyond["accessors"][1]["count"] = json!(1000);
    let error = error_of(&beyond);
    assert!(error.contains("longer than its buffer view"), "{error}");
    beyond["accessors"][1]["count"] = json!(MAX_KEYS + 1);
    let error = error_of(&beyond);
    assert!(
        error.contains("has clips with 33554433 keys, more than the limit"),
        "{error}"
    );
}

#[test]
fn channels_share_key_times() {
    let lists = [floats("SCALAR", &[0.0, 2.0]), floats("VEC3", &[0.0; 6])];
    let mut clip = moving(0, "translation", "LINEAR");
    let second = json!({ "sampler": 0, "target": { "node": 1, "path": "scale" } });
    clip["channels"].as_array_mut().unwrap().push(second);
    let (_, clips) = opened(&gltf(&lists, &json!([clip]))).unwrap();
    let [first, second] = &clips[0].animated[..] else {
        panic!("two nodes move")
    };
    let (a, b) = (first.translation.as_ref(), second.scale.as_ref());
    assert!(Arc::ptr_eq(&a.unwrap().times, &b.unwrap().times));
}

use std::collections::BTreeMap;

use proptest::prelude::*;
use serde_json::Value;

use super::delta;
use crate::compile::{Options, compile};
use crate::export::{self, GLB};
use crate::resolver::MemoryResolver;

/// What a node looks like: its fields, with what they refer to in place of numbers.
type Node = BTreeMap<String, Value>;

fn glb(text: &str) -> Vec<u8> {
    let compiled = compile(text, &Options::default(), &MemoryResolver::default());
    assert!(!compiled.has_errors(), "{:?}", compiled.diagnostics);
    let model = export::to_memory(&GLB, &compiled.scene, None);
    model.expect("a model").bytes
}

fn json(glb: &[u8]) -> (Value, Vec<u8>) {
    let glb = gltf::binary::Glb::from_slice(glb).expect("a binary glTF");
    let json = serde_json::from_slice(&glb.json).expect("JSON");
    (json, glb.bin.unwrap_or_default().into_owned())
}

fn index(value: &Value) -> usize {
    value.as_u64().expect("a number") as usize
}

/// An accessor by what it holds.
fn numbers(file: &(Value, Vec<u8>), accessor: &Value) -> Value {
    let (json, data) = file;
    let accessor = &json["accessors"][index(accessor)];
    let view = &json["bufferViews"][index(&accessor["bufferView"])];
    let offset = |value: &Value| value["byteOffset"].as_u64().unwrap_or(0) as usize;
    let components = match accessor["type"].as_str().expect("a type") {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        _ => 4,
    };
    let size = match index(&accessor["componentType"]) {
        5120 | 5121 => 1,
        5122 | 5123 => 2,
        _ => 4,
    } * components;
    let stride = view["byteStride"]
        .as_u64()
        .map_or(size, |stride| stride as usize);
    let start = offset(view) + offset(accessor);
    let rows = (0..index(&accessor["count"])).map(|row| &data[start + row * stride..][..size]);
    let rows: Vec<Value> = rows.map(|row| row.into()).collect();
    let mut described = accessor.clone();
    for place in ["bufferView", "byteOffset"] {
        described.as_object_mut().expect("an object").remove(place);
    }
    Value::Array(vec![described, rows.into()])
}

/// A mesh by what it looks like.
fn mesh(file: &(Value, Vec<u8>), number: &Value) -> Value {
    let mut mesh = file.0["meshes"][index(number)].clone();
    for primitive in mesh["primitives"].as_array_mut().expect("primitives") {
        for (_, accessor) in primitive["attributes"].as_object_mut().expect("attributes") {
            *accessor = numbers(file, accessor);
        }
        primitive["indices"] = numbers(file, &primitive["indices"]);
        primitive["material"] = file.0["materials"][index(&primitive["material"])].clone();
    }
    mesh
}

fn nodes(glb: &[u8]) -> Vec<Node> {
    let file = json(glb);
    let nodes = file.0["nodes"].as_array().expect("nodes").iter();
    let node = |node: &Value| {
        let mut node: Node = serde_json::from_value(node.clone()).expect("an object");
        if let Some(number) = node.get_mut("mesh") {
            *number = mesh(&file, number);
        }
        node
    };
    nodes.map(node).collect()
}

/// What a page does with a delta.
fn applied(before: &[u8], delta: &[u8]) -> Vec<Node> {
    let mut model = nodes(before);
    let file = json(delta);
    let own = &file.0["extras"]["okoshi"];
    assert_eq!(own["since"], 7);
    for moved in own["nodes"].as_array().expect("a list") {
        let node = &mut model[index(&moved["node"])];
        for name in super::OWN {
            match moved.get(name) {
                Some(value) => node.insert(name.to_owned(), value.clone()),
                None => node.remove(name),
            };
        }
    }
    for changed in file.0["nodes"].as_array().into_iter().flatten() {
        let node = &mut model[index(&changed["extras"]["node"])];
        node.insert("mesh".to_owned(), mesh(&file, &changed["mesh"]));
    }
    model
}

/// A figure whose parts hang on the first one.
fn drawing(parts: &[(u32, u32, usize, usize)]) -> String {
    const KINDS: [&str; 4] = ["default -9 9", "roundv", "flat", "conev -8 8 0.5"];
    const COLORS: [&str; 3] = ["#c83737", "#2a7fff", "#37c871"];
    let shapes = parts.iter().enumerate().map(|(at, (x, width, kind, color))| {
        let y = 40 * at;
        let (x, width) = (x + 10, width + 10);
        let parent = if at > 0 { "@P0" } else { "" };
        format!(
            r#"<rect id="p{at}" x="{x}" y="{y}" width="{width}" height="20" fill="{}"/><text x="{}" y="{}" font-size="3">P{at}{parent}$Shape {}</text>"#,
            COLORS[color % 3], x + 2, y + 10, KINDS[kind % 4],
        )
    });
    let shapes: String = shapes.collect();
    format!(r#"<svg xmlns="http://www.w3.org/2000/svg" width="400" height="400">{shapes}</svg>"#)
}

#[test]
fn a_changed_color_is_one_mesh() {
    let before = glb(&drawing(&[(0, 30, 0, 0), (9, 20, 1, 1), (3, 20, 0, 0)]));
    let after = glb(&drawing(&[(0, 30, 0, 0), (9, 20, 1, 2), (3, 20, 0, 0)]));
    let delta = delta(&before, &after, 7).expect("a delta");
    let (json, _) = json(&delta);
    assert_eq!(json["nodes"].as_array().map(Vec::len), Some(1));
    assert_eq!(json["nodes"][0]["extras"]["node"], 1);
    assert_eq!(json["materials"].as_array().map(Vec::len), Some(1));
    assert_eq!(
        json["extras"]["okoshi"]["nodes"].as_array().map(Vec::len),
        Some(0)
    );
    assert!(delta.len() < after.len());
}

#[test]
fn another_hierarchy_has_no_delta() {
    let three = glb(&drawing(&[(0, 30, 0, 0), (9, 20, 1, 1), (3, 20, 0, 0)]));
    let two = glb(&drawing(&[(0, 30, 0, 0), (9, 20, 1, 1)]));
    assert!(delta(&three, &two, 7).is_none());
    let renamed = drawing(&[(0, 30, 0, 0), (9, 20, 1, 1)]).replace("P1", "Q1");
    assert!(delta(&two, &glb(&renamed), 7).is_none());
    assert!(delta(&two, b"no model", 7).is_none());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn a_delta_applied_is_the_new_model(
        before in prop::collection::vec((0..60_u32, 0..60_u32, 0..4_usize, 0..3_usize), 5),
        edits in prop::collection::vec((0..5_usize, 0..60_u32, 0..60_u32, 0..4_usize, 0..3_usize), 0..4),
    ) {
        let mut after = before.clone();
        for (at, x, width, kind, color) in edits {
            after[at] = (x, width, kind, color);
        }
        let [before, after] = [glb(&drawing(&before)), glb(&drawing(&after))];
        let delta = delta(&before, &after, 7).expect("a delta");
        prop_assert_eq!(applied(&before, &delta), nodes(&after));
    }
}

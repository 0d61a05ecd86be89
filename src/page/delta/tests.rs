use std::collections::BTreeMap;

use proptest::prelude::*;
use serde_json::{Value, json};

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

fn read(glb: &[u8]) -> (Value, Vec<u8>) {
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
    let file = read(glb);
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

/// The text and the numbers of a delta.
fn parts_of(delta: &[u8]) -> (Value, &[u8]) {
    let [magic, length] = [&delta[..4], &delta[4..8]];
    assert_eq!(magic, super::MAGIC);
    let length = u32::from_le_bytes(length.try_into().expect("four bytes")) as usize;
    let text = serde_json::from_slice(&delta[8..][..length]).expect("JSON");
    (text, &delta[8 + length..])
}

/// The next array of a delta, as `numbers` has one of a model.
fn next_array(data: &mut &[u8], kind: &Value, components: usize, count: usize) -> Value {
    let size = match index(kind) {
        5120 | 5121 => 1,
        5122 | 5123 => 2,
        _ => 4,
    } * components;
    let rows = data[..size * count].chunks(size);
    let rows: Vec<Value> = rows.map(|row| row.into()).collect();
    *data = &data[(size * count).next_multiple_of(4)..];
    let shape = ["SCALAR", "VEC2", "VEC3", "VEC4"][components - 1];
    let described = json!({"componentType": kind, "count": count, "type": shape});
    Value::Array(vec![described, rows.into()])
}

/// The primitives of a delta, as `mesh` has those of a model.
fn primitives(text: &Value, mut data: &[u8]) -> Vec<Value> {
    let primitives = text["primitives"].as_array().expect("a list").iter();
    let primitives = primitives.map(|primitive| {
        let [material, layout, vertices, corners] = [0, 1, 2, 3].map(|at| index(&primitive[at]));
        let layout = &text["layouts"][layout];
        let mut attributes = serde_json::Map::new();
        for attribute in layout["attributes"].as_array().expect("a list") {
            let name = attribute[0].as_str().expect("a name");
            let components = index(&attribute[2]);
            let mut array = next_array(&mut data, &attribute[1], components, vertices);
            if name == "POSITION" {
                array[0]["min"] = primitive[4].clone();
                array[0]["max"] = primitive[5].clone();
            }
            if attribute[3] == true {
                array[0]["normalized"] = true.into();
            }
            attributes.insert(name.to_owned(), array);
        }
        let indices = next_array(&mut data, &layout["indices"], 1, corners);
        let material = &text["materials"]["materials"][material];
        json!({"attributes": attributes, "indices": indices, "material": material})
    });
    let primitives = primitives.collect();
    assert!(data.is_empty());
    primitives
}

/// What a page does with a delta.
fn applied(before: &[u8], delta: &[u8]) -> Vec<Node> {
    let mut model = nodes(before);
    let (text, data) = parts_of(delta);
    assert_eq!(text["since"], 7);
    for moved in text["nodes"].as_array().expect("a list") {
        let node = &mut model[index(&moved["node"])];
        for name in super::OWN {
            match moved.get(name) {
                Some(value) => node.insert(name.to_owned(), value.clone()),
                None => node.remove(name),
            };
        }
    }
    let primitives = primitives(&text, data);
    for changed in text["meshes"].as_array().expect("a list") {
        let mesh = model[index(&changed[0])].get_mut("mesh").expect("a mesh");
        let old = mesh["primitives"].as_array_mut().expect("primitives");
        let new = changed[1].as_array().expect("a list");
        assert_eq!(old.len(), new.len());
        for (old, new) in old.iter_mut().zip(new) {
            for name in ["attributes", "indices", "material"] {
                old[name] = primitives[index(new)][name].clone();
            }
        }
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
    let (text, _) = parts_of(&delta);
    assert_eq!(text["meshes"], json!([[1, [0]]]));
    let materials = &text["materials"]["materials"];
    assert_eq!(materials.as_array().map(Vec::len), Some(1));
    assert_eq!(text["nodes"], json!([]));
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

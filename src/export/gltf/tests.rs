use std::sync::Arc;

use glam::{DQuat, DVec3};
use proptest::prelude::*;
use serde_json::json;
use typed_index_collections::ti_vec;

use super::*;
use crate::export::{self, SeekableOutput};
use crate::scene::{
    AlphaMode, Filter, Image, Material, MediaType, Mesh, Node, NodeId, Primitive, Provenance,
    Surface, SurfacePatch, Texture, TextureUse, ViewDependent, Wrap,
};

mod animated;

mod cameras;

mod textured;

mod skinned;

mod view_dependent;

const BOTH: [&dyn Exporter; 2] = [&GLB, &GLTF];

fn bytes(scene: &Scene, exporter: &dyn Exporter) -> Vec<u8> {
    export::to_memory(exporter, scene, None).unwrap().bytes
}

fn primitive(surface: Surface, material: usize) -> Primitive {
    Primitive {
        patches: vec![surface.into()],
        material: material.into(),
    }
}

/// The surface of a primitive, to be made invalid.
fn first_surface(scene: &mut Scene) -> &mut Surface {
    match &mut scene.meshes.raw[0].primitives[0].patches[0] {
        SurfacePatch::Surface(surface) => surface,
        _ => panic!("these scenes have surfaces only"),
    }
}

/// The file as a strict reader sees it.
fn read(bytes: &[u8]) -> (gltf::Document, Vec<Vec<u8>>) {
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(bytes).unwrap();
    let buffers = document
        .buffers()
        .map(|buffer| match buffer.source() {
            gltf::buffer::Source::Bin => blob.clone().unwrap(),
            gltf::buffer::Source::Uri(uri) => {
                use base64::Engine as _;
                let data = uri.split_once(";base64,").unwrap().1;
                base64::engine::general_purpose::STANDARD
                    .decode(data)
                    .unwrap()
            }
        })
        .collect::<Vec<_>>();
    for (buffer, data) in document.buffers().zip(&buffers) {
        assert!(buffer.length() <= data.len() && data.len() < buffer.length() + 4);
    }
    (document, buffers)
}

fn json(bytes: &[u8]) -> serde_json::Value {
    if bytes.starts_with(b"glTF") {
        let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
        serde_json::from_slice(&bytes[20..20 + length]).unwrap()
    } else {
        serde_json::from_slice(bytes).unwrap()
    }
}

fn material(alpha: f32) -> Material {
    Material {
        name: "paint \"1\"\\\n".to_owned(),
        base_color: [0.1, 0.5, 1.0, alpha],
        metallic: 0.0,
        roughness: 0.9,
        emissive: [0.0, 0.25, 0.0],
        alpha_mode: if alpha < 1.0 {
            AlphaMode::Blend
        } else {
            AlphaMode::Opaque
        },
        double_sided: alpha < 1.0,
        ..Material::default()
    }
}

/// A strip of triangles over `corners` corners.
fn strip(corners: u32) -> Surface {
    Surface {
        positions: (0..corners)
            .map(|i| [i as f32 * 0.1, (i % 2) as f32, -0.3])
            .collect(),
        normals: vec![[0.0, 0.0, 1.0]; corners as usize],
        uvs: vec![],
        influences: vec![],
        targets: Vec::new(),
        triangles: (2..corners).map(|i| [i - 2, i - 1, i]).collect(),
    }
}

fn single(surface: Surface) -> Scene {
    Scene {
        nodes: ti_vec![Node {
            name: "Part".to_owned(),
            mesh: Some(0.into()),
            ..Node::default()
        }],
        roots: vec![0.into()],
        meshes: ti_vec![Mesh {
            primitives: vec![primitive(surface, 0)],
        }],
        materials: ti_vec![material(1.0)],
        ..Scene::default()
    }
}

/// Reads everything back and compares it with the scene.
fn assert_round_trip(scene: &Scene, exporter: &dyn Exporter) {
    let file = bytes(scene, exporter);
    let (document, buffers) = read(&file);
    let nodes = document.nodes().collect::<Vec<_>>();
    assert_eq!(nodes.len(), scene.nodes.len() + 1);
    let root = document.default_scene().unwrap().nodes().next().unwrap();
    assert_eq!((root.name(), root.index()), (Some(ROOT), scene.nodes.len()));
    let children = |node: &gltf::Node| -> Vec<NodeId> {
        node.children().map(|child| child.index().into()).collect()
    };
    let roots = children(&root);
    assert_eq!(roots, scene.roots);

    for (node, read) in scene.nodes.iter().zip(&nodes) {
        assert_eq!(read.name(), (!node.name.is_empty()).then_some(&*node.name));
        assert_eq!(children(read), node.children);
        let (translation, rotation, scale) = read.transform().decomposed();
        assert_eq!(translation, node.translation.as_vec3().to_array());
        assert_eq!(rotation, node.rotation.as_quat().to_array());
        assert_eq!(scale, [1.0; 3]);
        let solid = node.mesh.map(|mesh| &scene.meshes[mesh].primitives);
        let solid = solid.into_iter().flatten().collect::<Vec<_>>();
        let solid = solid
            .into_iter()
            .filter(|part| !part.surface().triangles.is_empty());
        let read_solid = read
            .mesh()
            .into_iter()
            .flat_map(|mesh| mesh.primitives().collect::<Vec<_>>());
        let read_solid = read_solid.collect::<Vec<_>>();
        assert_eq!(solid.clone().count(), read_solid.len());
        for (part, read) in solid.zip(read_solid) {
            assert_primitive(part, &read, &buffers);
        }
    }
}

fn assert_primitive(part: &Primitive, read: &gltf::Primitive, buffers: &[Vec<u8>]) {
    let surface = part.surface();
    let reader = read.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
    let positions = reader.read_positions().unwrap().collect::<Vec<_>>();
    assert_eq!(positions, surface.positions);
    let normals = reader.read_normals().unwrap().collect::<Vec<_>>();
    assert_eq!(normals, surface.normals);
    let uvs = reader
        .read_tex_coords(0)
        .map(|uvs| uvs.into_f32().collect::<Vec<_>>());
    assert_eq!(uvs.unwrap_or_default(), surface.uvs);
    let indices = reader
        .read_indices()
        .unwrap()
        .into_u32()
        .collect::<Vec<_>>();
    assert_eq!(indices, surface.triangles.as_flattened());
    assert_eq!(read.material().index(), Some(part.material.into()));

    // What was written as decimals is exactly the least and the greatest `f32`.
    let mut min = [f32::INFINITY; 3];
    let mut max = [f32::NEG_INFINITY; 3];
    for position in &positions {
        for axis in 0..3 {
            min[axis] = min[axis].min(position[axis]);
            max[axis] = max[axis].max(position[axis]);
        }
    }
    let bounds = read.bounding_box();
    assert_eq!((bounds.min, bounds.max), (min, max));
}

#[test]
fn an_empty_scene_has_a_root_and_no_empty_arrays() {
    for exporter in BOTH {
        let file = bytes(&Scene::default(), exporter);
        read(&file);
        let json = json(&file);
        let keys = json.as_object().unwrap().keys().collect::<Vec<_>>();
        assert_eq!(keys, ["asset", "nodes", "scene", "scenes"]);
        assert_eq!(json["nodes"], json!([{ "name": "Root" }]));
    }
}

#[test]
fn a_part_is_written_as_documented() {
    let mut scene = single(strip(3));
    scene.nodes.raw[0].translation = DVec3::new(0.1, -2.0, 0.0);
    scene.nodes.raw[0].provenance = Some(Provenance {
        element: Some("path12".to_owned()),
        string: Some("腕@体$\n\"x\"".to_owned()),
    });
    let json = json(&bytes(&scene, &GLB));
    assert_eq!(json["asset"]["version"], "2.0");
    assert_eq!(json["scenes"], json!([{ "nodes": [1] }]));
    assert_eq!(
        json["nodes"],
        json!([
            {
                "name": "Part",
                "mesh": 0,
                "translation": [0.1, -2, 0],
                "extras": { "okoshi": { "element": "path12", "string": "腕@体$\n\"x\"" } },
            },
            { "name": "Root", "children": [0] },
        ])
    );
    assert_eq!(
        json["materials"],
        json!([{
            "name": "paint \"1\"\\\n",
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.1, 0.5, 1, 1],
                "metallicFactor": 0,
                "roughnessFactor": 0.9,
            },
            "emissiveFactor": [0, 0.25, 0],
        }])
    );
    assert_eq!(json["meshes"][0]["name"], "Part");
    assert_round_trip(&scene, &GLB);
    assert_round_trip(&scene, &GLTF);
}

#[test]
fn see_through_paint_is_blended() {
    let mut scene = single(strip(3));
    scene.materials.raw[0] = material(0.5);
    let json = json(&bytes(&scene, &GLB));
    assert_eq!(json["materials"][0]["alphaMode"], "BLEND");
    assert_eq!(json["materials"][0]["doubleSided"], true);
}

#[test]
fn the_glb_is_framed_by_the_book() {
    let file = bytes(&single(strip(5)), &GLB);
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!(word(8), file.len());
    let json = word(12);
    assert_eq!((json % 4, word(20 + json) % 4), (0, 0));
    assert_eq!(20 + json + 8 + word(20 + json), file.len());
}

#[test]
fn indices_take_the_smallest_type_that_holds_them() {
    use gltf::accessor::DataType;
    for (corners, expected) in [
        (3, DataType::U8),
        (255, DataType::U8),
        (256, DataType::U16),
        (65_535, DataType::U16),
        (65_536, DataType::U32),
    ] {
        let scene = single(strip(corners));
        let (document, _) = read(&bytes(&scene, &GLB));
        let mesh = document.meshes().next().unwrap();
        let indices = mesh.primitives().next().unwrap().indices().unwrap();
        assert_eq!(indices.data_type(), expected, "{corners} corners");
        assert_round_trip(&scene, &GLB);
    }
}

#[test]
fn kinds_of_data_share_a_view_each() {
    let mut scene = single(strip(7));
    for corners in [300, 4, 70_000, 9] {
        let mut surface = strip(corners);
        surface.uvs = vec![[0.25, 1.0]; corners as usize];
        let material = scene.materials.push_and_get_key(self::material(0.5));
        scene.meshes.raw[0]
            .primitives
            .push(primitive(surface, material.into()));
    }
    let (document, _) = read(&bytes(&scene, &GLB));
    assert_eq!(document.views().count(), 6);
    for accessor in document.accessors() {
        let view = accessor.view().unwrap();
        assert_eq!(
            (view.offset() + accessor.offset()) % accessor.data_type().size(),
            0
        );
    }
    assert_round_trip(&scene, &GLB);
    assert_round_trip(&scene, &GLTF);
}

#[test]
fn parts_without_triangles_have_no_mesh() {
    let mut scene = single(strip(2));
    scene.nodes.push(Node {
        name: "Other".to_owned(),
        mesh: Some(1.into()),
        ..Node::default()
    });
    scene.roots.push(1.into());
    scene.meshes.push(Mesh {
        primitives: vec![primitive(strip(4), 0)],
    });
    let (document, _) = read(&bytes(&scene, &GLB));
    assert_eq!(document.meshes().count(), 1);
    assert_round_trip(&scene, &GLB);
}

#[test]
fn a_broken_scene_is_refused_before_a_byte_is_written() {
    let break_it: [fn(&mut Scene); 12] = [
        |scene| first_surface(scene).positions[1][2] = f32::NAN,
        |scene| first_surface(scene).triangles[0][1] = 3,
        |scene| scene.meshes.raw[0].primitives[0].material = 1.into(),
        |scene| scene.nodes.raw[0].translation.x = f64::INFINITY,
        |scene| scene.nodes.raw[0].children.push(0.into()),
        |scene| scene.nodes.raw[0].mesh = Some(1.into()),
        |scene| scene.materials.raw[0].roughness = f32::NAN,
        |scene| scene.textures.raw[1].image = 4.into(),
        |scene| scene.materials.raw[0].normal_texture = Some(TextureUse::new(5.into())),
        |scene| scene.materials.raw[0].base_color_texture = Some(TextureUse::new(0.into())),
        |scene| scene.materials.raw[0].alpha_mode = AlphaMode::Mask { cutoff: f32::NAN },
        |scene| scene.images.raw[0].media_type = MediaType::Jpeg,
    ];
    for break_it in break_it {
        let mut scene = single(strip(3));
        let Scene {
            textures, images, ..
        } = textured::scene(strip(3), 16);
        (scene.textures, scene.images) = (textures, images);
        break_it(&mut scene);
        let mut out = SeekableOutput::new(io::Cursor::new(Vec::new()));
        let error = export::write(&GLB, &scene, &mut out, None).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::InvalidInput);
        assert!(out.finish().unwrap().get_ref().is_empty(), "{error}");
    }
}

#[test]
fn a_large_model_is_written_in_windows() {
    let count = 40_000;
    let mut scene = single(strip(120));
    let node = scene.nodes.raw[0].clone();
    let mesh = scene.meshes.raw[0].clone();
    for index in 1..count {
        scene.nodes.push(Node {
            name: format!("Part{index}"),
            mesh: Some(index.into()),
            ..node.clone()
        });
        scene.roots.push(index.into());
        scene.meshes.push(mesh.clone());
    }
    let bytes = bytes(&scene, &GLB);
    assert!(bytes.len() > 100 << 20);
    let (blanks, length) = json_padding(&bytes);
    assert!((4..length / 2).contains(&blanks), "{blanks} of {length}");
    let (document, buffers) = read(&bytes);
    assert_eq!(document.meshes().count(), count);
    for mesh in document.meshes().step_by(997) {
        let primitive = mesh.primitives().next().unwrap();
        let reader = primitive.reader(|_| Some(&buffers[0]));
        let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
        assert_eq!(indices, strip(120).triangles.as_flattened());
        assert!(reader.read_positions().unwrap().eq(strip(120).positions));
    }
}

#[test]
fn long_numbers_and_names_are_written_without_gaps() {
    const PARTS: usize = 3000;
    const CORNERS: u32 = 12;
    let longest = -1.234_567_8e-5_f32;
    assert_eq!(serde_json::to_string(&longest).unwrap().len(), 15);
    let mut surface = strip(CORNERS);
    surface.positions.iter_mut().for_each(|p| *p = [longest; 3]);
    surface.uvs = vec![[0.5; 2]; CORNERS as usize];
    let node = |part: usize| Node {
        name: "\u{1}\"\\".repeat(60),
        children: if part + 1 < PARTS {
            vec![(part + 1).into()]
        } else {
            vec![]
        },
        translation: DVec3::splat(f64::from(longest)),
        rotation: DQuat::from_xyzw(
            longest.into(),
            longest.into(),
            longest.into(),
            longest.into(),
        ),
        mesh: Some(part.into()),
        bones: vec![],
        shares: 0,
        camera: None,
        view_dependent: Some(ViewDependent::Bend),
        provenance: Some(Provenance {
            element: Some("\n".repeat(9)),
            string: Some("\"".repeat(9)),
        }),
    };
    let scene = Scene {
        nodes: (0..PARTS).map(node).collect(),
        roots: vec![0.into()],
        meshes: (0..PARTS)
            .map(|_| Mesh {
                primitives: vec![primitive(surface.clone(), 0); 2],
            })
            .collect(),
        materials: ti_vec![material(1.0)],
        ..Scene::default()
    };
    let bytes = bytes(&scene, &GLB);
    assert!(bytes.len() > 4 << 20);
    assert_eq!(json(&bytes)["nodes"].as_array().unwrap().len(), PARTS + 1);
    // The estimate does not count the escaped characters, so the data had to be moved.
    let (blanks, length) = json_padding(&bytes);
    assert!(blanks < 4, "{blanks} of {length} bytes are blank");
    let (document, buffers) = read(&bytes);
    assert!(buffers[0].len() > 1 << 20);
    for mesh in document.meshes().step_by(97) {
        let primitive = mesh.primitives().next().unwrap();
        let reader = primitive.reader(|_| Some(&buffers[0]));
        let positions = reader.read_positions().unwrap();
        assert!(positions.eq([[longest; 3]; CORNERS as usize]));
    }
}

#[test]
fn text_with_more_data_than_stays_in_memory_has_blanks_before_it() {
    let scene = single(strip(60_000));
    let text = String::from_utf8(bytes(&scene, &GLTF)).unwrap();
    let (before, after) = text.split_once("  ").unwrap();
    assert!(before.ends_with(']') && after.trim_start().starts_with(r#","buffers":[{"#));
    let (_, buffers) = read(text.as_bytes());
    assert!(buffers[0].len() > 1 << 20);
    assert_eq!(buffers, read(&bytes(&scene, &GLB)).1);
}

/// How many blanks are at the end of a GLB's JSON, and how long it is with them.
fn json_padding(bytes: &[u8]) -> (usize, usize) {
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let json = &bytes[20..20 + length];
    (length - json.trim_ascii_end().len(), length)
}

fn any_surface() -> impl Strategy<Value = Surface> {
    (
        3..300_u32,
        any::<bool>(),
        prop::collection::vec(-1e6_f32..1e6, 3..40),
    )
        .prop_map(|(corners, textured, numbers)| {
            let mut surface = strip(corners);
            for (value, number) in surface.positions.as_flattened_mut().iter_mut().zip(numbers) {
                *value = number;
            }
            if textured {
                surface.uvs = surface.positions.iter().map(|p| [p[0], p[1]]).collect();
            }
            surface
        })
}

fn any_scene() -> impl Strategy<Value = Scene> {
    let node = (
        any::<String>(),
        any::<u16>(),
        [-9.0..9.0, -9.0..9.0, -4.0..4.0],
    );
    let surfaces = prop::collection::vec(prop::collection::vec(any_surface(), 0..3), 1..6);
    (prop::collection::vec(node, 1..6), surfaces).prop_map(|(nodes, meshes)| {
        let mut scene = Scene {
            materials: ti_vec![material(1.0), material(0.5), material(0.0)],
            ..Scene::default()
        };
        for (index, (name, parent, [x, y, angle])) in nodes.into_iter().enumerate() {
            match (parent as usize % (index + 1)).checked_sub(1) {
                Some(parent) => scene.nodes.raw[parent].children.push(index.into()),
                None => scene.roots.push(index.into()),
            }
            scene.nodes.push(Node {
                name,
                translation: DVec3::new(x, y, 0.0),
                rotation: DQuat::from_rotation_z(angle),
                mesh: (index < meshes.len()).then(|| index.into()),
                ..Node::default()
            });
        }
        for surfaces in meshes {
            let primitives = surfaces.into_iter().enumerate();
            let primitives = primitives
                .map(|(material, surface)| primitive(surface, material))
                .collect();
            scene.meshes.push(Mesh { primitives });
        }
        scene
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn what_is_written_reads_back(scene in any_scene()) {
        for exporter in BOTH {
            assert_round_trip(&scene, exporter);
            prop_assert_eq!(bytes(&scene, exporter), bytes(&scene, exporter));
        }
    }
}

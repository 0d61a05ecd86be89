//! `Shape model`: imported models in place of solids.

use std::io::Cursor;
use std::sync::Arc;

use okoshi::compile::{Compiled, Options, compile};
use okoshi::export::{GLB, to_memory};
use okoshi::resolver::MemoryResolver;
use okoshi::scene::{
    Filter, Image, Material, MediaType, Mesh, Node, Primitive, Scene, Surface, Texture, TextureUse,
    Wrap,
};
use typed_index_collections::ti_vec;

/// A box of 2 × 4 × 1 about (10, 0, 0): a textured front, and a plain body.
fn pillar() -> Vec<u8> {
    let mut png = Cursor::new(Vec::new());
    let pixels = image::RgbaImage::from_pixel(2, 2, image::Rgba([200, 30, 30, 255]));
    pixels
        .write_to(&mut png, image::ImageFormat::Png)
        .expect("sound");
    let quad = |z: f32, uvs: bool| Surface {
        positions: vec![
            [9.0, -2.0, z],
            [11.0, -2.0, z],
            [11.0, 2.0, z],
            [9.0, 2.0, z],
        ],
        normals: vec![[0.0, 0.0, z.signum()]; 4],
        uvs: if uvs {
            vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]
        } else {
            vec![]
        },
        influences: vec![],
        targets: vec![],
        triangles: if z > 0.0 {
            vec![[0, 1, 2], [0, 2, 3]]
        } else {
            vec![[0, 2, 1], [0, 3, 2]]
        },
    };
    let primitive = |surface: Surface, material: usize| Primitive {
        patches: vec![surface.into()],
        material: material.into(),
    };
    let scene = Scene {
        nodes: ti_vec![Node {
            name: "Pillar".to_owned(),
            mesh: Some(0.into()),
            ..Node::default()
        }],
        roots: vec![0.into()],
        meshes: ti_vec![Mesh {
            primitives: vec![
                primitive(quad(0.5, true), 0),
                primitive(quad(-0.5, false), 1),
            ],
        }],
        materials: ti_vec![
            Material {
                name: "front".to_owned(),
                base_color_texture: Some(TextureUse::new(0.into())),
                metallic: 0.25,
                ..Material::default()
            },
            Material {
                name: "back".to_owned(),
                double_sided: true,
                ..Material::default()
            },
        ],
        textures: ti_vec![Texture {
            image: 0.into(),
            wrap: [Wrap::ClampToEdge, Wrap::MirroredRepeat],
            filter: Filter::Nearest,
        }],
        images: ti_vec![Image {
            name: "red".to_owned(),
            media_type: MediaType::Png,
            bytes: Arc::from(png.into_inner()),
        }],
        ..Scene::default()
    };
    to_memory(&GLB, &scene, None).expect("sound").bytes
}

/// A drawing of a rectangle of 40 × 100 about (50, 80), and a body beside it.
fn drawing(shape: &str) -> String {
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="300" height="200">
  <rect x="30" y="30" width="40" height="100" fill="#00ff00" id="post"/>
  <rect x="200" y="60" width="60" height="60" fill="#0000ff" id="body"/>
  <text x="50" y="80" font-size="5">Post$Shape {shape}</text>
  <text x="230" y="90" font-size="5">Body$Shape default -5 5</text>
</svg>"##
    )
}

fn compiled(shape: &str, files: &[(&str, &[u8])]) -> Compiled {
    let mut resolver = MemoryResolver::default();
    for (name, bytes) in files {
        resolver = resolver.with(name, *bytes);
    }
    compile(&drawing(shape), &Options::default(), &resolver)
}

fn codes(compiled: &Compiled) -> Vec<&str> {
    compiled
        .diagnostics
        .iter()
        .map(|found| found.code.id())
        .collect()
}

/// The box of a node's mesh, in its frame.
fn bounds(scene: &Scene, name: &str) -> [[f32; 3]; 2] {
    let node = scene
        .nodes
        .iter()
        .find(|node| node.name == name)
        .expect("sound");
    let mesh = &scene.meshes[node.mesh.expect("sound")];
    let none = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    mesh.primitives.iter().fold(none, |all, primitive| {
        primitive
            .surface()
            .positions
            .iter()
            .fold(all, |[low, high], p| {
                [0, 1].map(|side| {
                    [0, 1, 2].map(|axis| match side {
                        0 => low[axis].min(p[axis]),
                        _ => high[axis].max(p[axis]),
                    })
                })
            })
    })
}

fn assert_near(found: [[f32; 3]; 2], expected: [[f32; 3]; 2]) {
    let far = found.as_flattened().iter().zip(expected.as_flattened());
    let far = far.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(far < 1e-5, "{found:?} is not {expected:?}");
}

/// The part's box is 0.4 × 1 m, the model's 2 × 4: it becomes a fifth as large in width, and its depth too.
#[test]
fn a_model_is_fitted_to_its_part() {
    let compiled = compiled("model \"pillar.glb\"", &[("pillar.glb", &pillar())]);
    assert!(codes(&compiled).is_empty(), "{:?}", compiled.diagnostics);
    assert_near(
        bounds(&compiled.scene, "Post"),
        [[-0.2, -0.4, -0.1], [0.2, 0.4, 0.1]],
    );
    assert_eq!(compiled.dependencies, ["pillar.glb"]);
}

#[test]
fn sides_and_offsets_apply_to_models() {
    let files: &[(&str, &[u8])] = &[("pillar.glb", &pillar())];
    let both = compiled("-s model \"pillar.glb\" Offset 50", files);
    assert_near(
        bounds(&both.scene, "Post"),
        [[-0.2, -0.4, -0.6], [0.2, 0.4, 0.6]],
    );
    let twice = compiled("-d model \"pillar.glb\" Offset 50", files);
    assert_near(
        bounds(&twice.scene, "Post"),
        [[-0.2, -0.4, -0.1], [0.2, 0.4, 0.1]],
    );
    assert_near(
        bounds(&twice.scene, "Post.back"),
        [[-0.2, -0.4, -0.1], [0.2, 0.4, 0.1]],
    );
}

#[test]
fn a_models_materials_are_kept() {
    let compiled = compiled("model \"pillar.glb\"", &[("pillar.glb", &pillar())]);
    let model = to_memory(&GLB, &compiled.scene, None).expect("sound");
    let document = gltf::Gltf::from_slice(&model.bytes)
        .expect("sound")
        .document;
    let materials: Vec<_> = document
        .materials()
        .filter_map(|m| m.name().map(str::to_owned))
        .collect();
    assert_eq!(materials, ["#0000ff", "front", "back"]);
    let front = document.materials().nth(1).expect("sound");
    assert_eq!(front.pbr_metallic_roughness().metallic_factor(), 0.25);
    let texture = front
        .pbr_metallic_roughness()
        .base_color_texture()
        .expect("sound")
        .texture();
    assert_eq!(
        texture.sampler().wrap_s(),
        gltf::texture::WrappingMode::ClampToEdge
    );
    assert_eq!(
        texture.sampler().wrap_t(),
        gltf::texture::WrappingMode::MirroredRepeat
    );
    assert_eq!(texture.source().name(), Some("red"));
    assert!(document.materials().nth(2).expect("sound").double_sided());
    let post = document
        .meshes()
        .find(|mesh| mesh.name() == Some("Post"))
        .expect("sound");
    assert_eq!(post.primitives().count(), 2);
}

#[test]
fn a_gltf_links_from_its_own_folder() {
    let glb = pillar();
    let length = u32::from_le_bytes(glb[12..16].try_into().expect("sound")) as usize;
    let mut json: serde_json::Value = serde_json::from_slice(&glb[20..20 + length]).expect("sound");
    json["buffers"][0]["uri"] = "pillar.bin".into();
    let (json, data) = (json.to_string(), &glb[28 + length..]);
    let compiled = compiled(
        "model \"things/pillar.gltf\"",
        &[
            ("things/pillar.gltf", json.as_bytes()),
            ("things/pillar.bin", data),
        ],
    );
    assert!(codes(&compiled).is_empty(), "{:?}", compiled.diagnostics);
    assert_eq!(
        compiled.dependencies,
        ["things/pillar.bin", "things/pillar.gltf"]
    );
}

/// A broken file is reported, and the part becomes a plate.
#[test]
fn files_that_are_no_models_are_reported() {
    let whole = pillar();
    let empty = br#"{"asset":{"version":"2.0"}}"#;
    let cut = &whole[..whole.len() / 2];
    for (bytes, says) in [
        (&b"no model"[..], "is not a readable glTF file"),
        (cut, "is not a readable glTF file"),
        (empty, "has no triangles"),
        (&[], "is not a readable glTF file"),
    ] {
        let compiled = compiled("model \"a.glb\"", &[("a.glb", bytes)]);
        assert_eq!(codes(&compiled).len(), 1, "{:?}", compiled.diagnostics);
        let found = &compiled.diagnostics[0];
        assert!(found.message.contains(says), "{}", found.message);
        let [low, high] = bounds(&compiled.scene, "Post");
        assert!(high[1] - low[1] > 0.99, "the plate");
    }
    for link in ["../a.glb", "/a.glb", "http://example.org/a.glb"] {
        let compiled = compiled(&format!("model \"{link}\""), &[]);
        assert_eq!(codes(&compiled).len(), 1, "{:?}", compiled.diagnostics);
    }
}

/// No damaged byte causes more than a diagnostic.
#[test]
fn broken_models_are_survived() {
    let whole = pillar();
    for at in (0..whole.len()).step_by(7) {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x55;
        let compiled = compiled("model \"a.glb\"", &[("a.glb", &bytes)]);
        to_memory(&GLB, &compiled.scene, None).expect("sound");
    }
}

//! How much JSON a scene takes at most, which must be known before its solids are made.

use std::io;

use super::document::{
    Accessor, Attributes, Bounds, BufferView, Extensions, Extras, Node, Number, Primitive,
    Provenance,
};
use super::packing::{KINDS, RUNS, WINDOW};
use super::{animations, looks};
use crate::scene::{self, Scene};

/// How many bytes a text takes, escaped.
pub(super) fn text(text: &str) -> usize {
    text.bytes()
        .map(|byte| {
            if byte < 0x20 {
                6
            } else if matches!(byte, b'"' | b'\\') {
                2
            } else {
                1
            }
        })
        .sum()
}

/// More bytes than the JSON of a scene takes, reckoned before its solids are made: texts are counted, and numbers
/// taken at their longest.
pub(super) fn room(scene: &Scene) -> io::Result<u64> {
    /// What is there once.
    const HEAD: usize = 4096;
    /// No `f32` that is written takes more characters.
    const LONGEST: Number = Number(-1.234_567_8e-5);

    let length = |element: serde_json::Result<Vec<u8>>| Ok::<_, io::Error>(element?.len() + 1);
    let primitives: usize = scene.meshes.iter().map(|mesh| mesh.primitives.len()).sum();
    let views = KINDS * (primitives / WINDOW + 1) + scene.images.len() + 1 + animations::VIEWS;
    let children = digits(scene.nodes.len()) + 1;

    let node = length(serde_json::to_vec(&Node {
        name: "",
        children: &[],
        mesh: Some(scene.meshes.len()),
        skin: None,
        translation: Some([LONGEST; 3]),
        rotation: Some([LONGEST; 4]),
        extensions: Some(Extensions::new(scene::ViewDependent::Bend)),
        extras: Some(Extras {
            okoshi: Provenance {
                element: Some(""),
                string: Some(""),
            },
        }),
    }))? + r#""name":"","children":[],"#.len();
    let nodes: usize = scene
        .nodes
        .iter()
        .map(|scene_node| {
            let words = scene_node
                .provenance
                .iter()
                .flat_map(|provenance| [&provenance.element, &provenance.string]);
            let words: usize = words.flatten().map(|word| text(word)).sum();
            // The name may stand a second time, as its mesh's.
            node + 2 * text(&scene_node.name) + words + scene_node.children.len() * children
        })
        .sum();

    let mesh = r#"{"name":"","primitives":[]},"#.len();
    let primitive = length(serde_json::to_vec(&Primitive {
        attributes: Attributes {
            position: RUNS * primitives,
            normal: Some(RUNS * primitives),
            uv: None,
            joints: None,
            weights: None,
        },
        indices: RUNS * primitives,
        material: scene.materials.len(),
    }))?;
    let accessor = |element, bounds: Option<Bounds>| {
        length(serde_json::to_vec(&Accessor {
            buffer_view: views,
            byte_offset: u64::from(u32::MAX),
            component_type: u16::MAX,
            normalized: false,
            count: u32::MAX as usize,
            element,
            min: bounds,
            max: bounds,
        }))
    };
    let accessors = accessor("VEC3", Some(Bounds::Corner([LONGEST; 3])))?
        + accessor("VEC3", None)?
        + accessor("SCALAR", None)?;
    let mut pieces = scene
        .meshes
        .iter()
        .flat_map(|mesh| &mesh.primitives)
        .flat_map(|p| &p.pieces);
    let mapped = |piece: &scene::Piece| matches!(piece, scene::Piece::Surface(surface) if !surface.uvs.is_empty());
    let uvs = match !scene.textures.is_empty() || pieces.any(mapped) {
        true => accessor("VEC2", None)? + r#","TEXCOORD_0":"#.len() + digits(RUNS * primitives),
        false => 0,
    };
    let joints = match scene.skin {
        Some(_) => {
            2 * (accessor("VEC4", None)? + r#","WEIGHTS_0":"#.len() + digits(RUNS * primitives))
                + r#""normalized":true,"#.len()
        }
        None => 0,
    };
    let skin = if scene.skin.is_some() {
        HEAD + scene.nodes.len() * children
    } else {
        0
    };
    // Moments and what is there then.
    let moving = accessor("SCALAR", Some(Bounds::Moment([LONGEST])))? + accessor("VEC4", None)?;
    let tracks: usize = scene.animations.iter().map(|a| a.tracks.len()).sum();
    let view = length(serde_json::to_vec(&BufferView {
        buffer: 0,
        byte_offset: u64::from(u32::MAX),
        byte_length: u64::from(u32::MAX),
        byte_stride: Some(u8::MAX),
        target: Some(u16::MAX),
    }))?;

    let total = HEAD
        + nodes
        + scene.roots.len() * children
        + scene.meshes.len() * mesh
        + primitives * (primitive + accessors + uvs + joints)
        + views * view
        + skin
        + tracks * moving
        + animations::room(scene)?
        + looks::room(scene);
    Ok(total as u64)
}

/// How many digits the numbers up to `greatest` have.
fn digits(greatest: usize) -> usize {
    greatest.max(1).ilog10() as usize + 1
}

//! Checks a scene before the first byte is written.

use std::collections::BTreeSet;
use std::io;

use typed_index_collections::TiSlice;

use super::invalid;
use crate::scene::{
    AlphaMode, Animation, MAX_JOINTS, MediaType, Node, NodeId, Scene, Surface, Track, Values,
};

/// Refuses nodes, materials and animations that would make an invalid file.
pub(super) fn check(scene: &Scene) -> io::Result<()> {
    check_nodes(scene)?;
    check_cameras(scene)?;
    check_skin(scene)?;
    check_images(scene)?;
    check_materials(scene)?;
    scene
        .animations
        .iter()
        .try_for_each(|animation| check_animation(animation, &scene.nodes))
}

/// An error whose message is `what`, if there is a fault.
fn refuse<T: Into<String>>(fault: bool, what: impl FnOnce() -> T) -> io::Result<()> {
    if fault { Err(invalid(what())) } else { Ok(()) }
}

fn check_nodes(scene: &Scene) -> io::Result<()> {
    for (id, node) in scene.nodes.iter_enumerated() {
        let wrong = |what: &str| format!("node `{}` has {what}", node.name);
        let is_finite = node.translation.is_finite() && node.rotation.is_finite();
        refuse(!is_finite, || wrong("a position that is not a number"))?;
        // A child comes after its parent, so there can be no cycle.
        let in_order = |child: &NodeId| *child > id && *child < scene.nodes.next_key();
        refuse(!node.children.iter().all(in_order), || {
            wrong("a child out of order")
        })?;
        let is_beyond = node
            .mesh
            .is_some_and(|mesh| mesh >= scene.meshes.next_key());
        refuse(is_beyond, || wrong("a mesh out of range"))?;
        let mut bones = node.bones.iter();
        refuse(bones.any(|bone| *bone >= scene.nodes.next_key()), || {
            wrong("a bone out of range")
        })?;
    }
    let mut roots = scene.roots.iter();
    refuse(
        roots.any(|root| *root >= scene.nodes.next_key()),
        || "a root out of range",
    )
}

fn check_cameras(scene: &Scene) -> io::Result<()> {
    for camera in &scene.cameras {
        let wrong = || format!("camera `{}` has a number out of range", camera.name);
        refuse(!camera.projection.is_valid(), wrong)?;
    }
    for (id, node) in scene.nodes.iter_enumerated() {
        let Some(camera) = node.camera else { continue };
        let wrong = |what: &str| format!("node `{}` has a camera{what}", node.name);
        refuse(camera >= scene.cameras.next_key(), || {
            wrong(" out of range")
        })?;
        let is_apart = node.mesh.is_none() && node.children.is_empty();
        let is_part = !is_apart || !scene.roots.contains(&id);
        refuse(is_part, || wrong(", but is a part of the model"))?;
    }
    Ok(())
}

fn check_skin(scene: &Scene) -> io::Result<()> {
    let Some(skin) = &scene.skin else {
        return Ok(());
    };
    let own = scene.nodes.iter().any(|node| node.mesh == Some(skin.mesh));
    let is_joint = |joint: &NodeId| *joint < scene.nodes.next_key();
    let joints_fit = skin.rest.len() == skin.joints.len() && skin.joints.iter().all(is_joint);
    let is_beyond = own || skin.mesh >= scene.meshes.next_key() || !joints_fit;
    refuse(is_beyond, || "a skin that does not fit the nodes")?;
    refuse(
        skin.joints.len() > MAX_JOINTS,
        || "a skin with too many joints",
    )
}

fn check_images(scene: &Scene) -> io::Result<()> {
    for image in &scene.images {
        let (name, media_type) = (&image.name, image.media_type);
        let is_other = MediaType::of(&image.bytes) != Some(media_type);
        refuse(is_other, || {
            format!("image `{name}` is not a {media_type:?}")
        })?;
    }
    let mut textures = scene.textures.iter();
    let is_beyond = textures.any(|texture| texture.image >= scene.images.next_key());
    refuse(is_beyond, || "a texture with an image out of range")
}

fn check_materials(scene: &Scene) -> io::Result<()> {
    for material in &scene.materials {
        let wrong = |what: &str| format!("material `{}` has a {what}", material.name);
        let mut textures = material.textures();
        let is_beyond = textures.any(|used| used.texture >= scene.textures.next_key());
        refuse(is_beyond, || wrong("texture out of range"))?;
        let cutoff = match material.alpha_mode {
            AlphaMode::Mask { cutoff } => cutoff,
            AlphaMode::Opaque | AlphaMode::Blend => 0.0,
        };
        let factors = [material.metallic, material.roughness, cutoff];
        let amounts = material.textures().map(|used| &used.amount);
        let colors = material.base_color.iter().chain(&material.emissive);
        let mut numbers = colors.chain(&factors).chain(amounts);
        let is_finite = numbers.all(|number| number.is_finite());
        refuse(!is_finite, || wrong("factor that is not a number"))?;
    }
    Ok(())
}

fn check_animation(animation: &Animation, nodes: &TiSlice<NodeId, Node>) -> io::Result<()> {
    let name = &animation.name;
    let refuse =
        |fault: bool, what: &str| refuse(fault, || format!("animation `{name}` has {what}"));
    let mut animated = BTreeSet::new();
    for Track {
        node,
        timing,
        values,
    } in &animation.tracks
    {
        let is_valid = match values {
            // Writing would normalise any other quaternion to an arbitrary rotation.
            Values::Rotations(rotations) => {
                let unit = |rotation: &glam::DQuat| (rotation.length_squared() - 1.0).abs() < 1e-3;
                rotations.iter().all(unit)
            }
            Values::Translations(translations) => {
                translations.iter().all(|t| t.as_vec3().is_finite())
            }
            Values::Weights(weights) => {
                let count = weights.first().map_or(0, Vec::len);
                let all = weights.iter();
                let mut all = all.map(|w| w.len() == count && w.iter().all(|w| w.is_finite()));
                all.all(|is_valid| is_valid)
            }
        };
        refuse(*node >= nodes.next_key(), "a track of a node out of range")?;
        let kind = match values {
            Values::Rotations(_) => 0,
            Values::Translations(_) => 1,
            Values::Weights(_) => 2,
        };
        refuse(
            !animated.insert((*node, kind)),
            "two tracks of one kind for one node",
        )?;
        let times = &timing.times;
        let ascending = times.windows(2).all(|pair| pair[0] < pair[1]);
        let within = times.first().is_some_and(|first| *first >= 0.0)
            && times.last().is_some_and(|last| last.is_finite());
        refuse(!ascending || !within, "keys out of order in time, or none")?;
        refuse(
            values.len() != times.len(),
            "a different number of keys and times",
        )?;
        refuse(!is_valid, "a key that is not a number, or not a rotation")?;
    }
    Ok(())
}

/// Refuses an invalid surface with triangles, and returns the bounding box of a valid one. `joints` is the number of joints.
pub(super) fn surface(surface: &Surface, joints: usize) -> io::Result<[[f32; 3]; 2]> {
    let vertices = surface.positions.len();
    let (normals, uvs, influences) = (&surface.normals, &surface.uvs, &surface.influences);
    let lengths = [normals.len(), uvs.len(), influences.len()];
    let mut targets = surface.targets.iter();
    let is_whole = targets.all(|target| target.len() == vertices)
        && lengths.iter().all(|length| [0, vertices].contains(length));
    refuse(
        !is_whole,
        || "a surface whose lists of vertices differ in length",
    )?;
    let greatest = surface.triangles.as_flattened().iter().copied().max();
    let is_beyond =
        greatest.is_none_or(|at| at as usize >= vertices) || vertices > u32::MAX as usize;
    refuse(is_beyond, || "a surface with a vertex out of range")?;
    let beyond = |joint: &u16| usize::from(*joint) >= joints;
    let is_beyond = influences.iter().any(|own| own.joints.iter().any(beyond));
    refuse(is_beyond, || "a surface with a joint out of range")?;
    // Without an early end, so that many numbers are tested at once.
    let is_finite = |rows: &[f32]| rows.iter().fold(true, |all, row| all & row.is_finite());
    let mut targets = surface.targets.iter();
    let is_finite = is_finite(surface.positions.as_flattened())
        && is_finite(normals.as_flattened())
        && is_finite(uvs.as_flattened())
        && targets.all(|target| is_finite(target.as_flattened()));
    refuse(
        !is_finite,
        || "a surface with a vertex that is not a number",
    )?;
    bounds(&surface.positions).ok_or_else(|| invalid("a surface without vertices"))
}

/// The least and the greatest value of each coordinate; `None` without points.
pub(super) fn bounds(points: &[[f32; 3]]) -> Option<[[f32; 3]; 2]> {
    // Four points at once: their coordinates fill whole vectors.
    let (fours, rest) = points.as_chunks::<4>();
    let first = [*points.first()?; 4];
    let (mut least, mut greatest) = (first, first);
    for four in fours {
        grow(least.as_flattened_mut(), four.as_flattened(), |a, b| a < b);
        grow(greatest.as_flattened_mut(), four.as_flattened(), |a, b| {
            a > b
        });
    }
    let ends = |all: &[[f32; 3]; 4], is_better: fn(f32, f32) -> bool| {
        let mut end = all[0];
        all.iter()
            .chain(rest)
            .for_each(|point| grow(&mut end, point, is_better));
        end
    };
    Some([ends(&least, |a, b| a < b), ends(&greatest, |a, b| a > b)])
}

/// Replaces each number by the new one in its place if that is better.
fn grow(numbers: &mut [f32], new: &[f32], is_better: impl Fn(f32, f32) -> bool) {
    for (number, new) in numbers.iter_mut().zip(new) {
        let better = is_better(*new, *number);
        *number = if better { *new } else { *number };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_those_of_all_points() {
        let mut random = fastrand::Rng::with_seed(1);
        for count in 0..20 {
            let points: Vec<[f32; 3]> = (0..count)
                .map(|_| [(); 3].map(|()| random.f32() - 0.5))
                .collect();
            let expected = points.iter().fold(None, |bounds, point| {
                let [low, high] = bounds.unwrap_or([*point; 2]);
                let of = |i: usize| [low[i].min(point[i]), high[i].max(point[i])];
                let [x, y, z] = [of(0), of(1), of(2)];
                Some([[x[0], y[0], z[0]], [x[1], y[1], z[1]]])
            });
            assert_eq!(bounds(&points), expected, "{count}");
        }
    }

    #[test]
    fn numbers_that_are_not_finite_are_refused() {
        for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut valid = Surface {
                positions: vec![[0.0; 3]; 7],
                normals: vec![[0.0, 0.0, 1.0]; 7],
                triangles: vec![[0, 1, 6]],
                ..Surface::default()
            };
            assert!(surface(&valid, 0).is_ok());
            valid.normals[6][1] = wrong;
            assert!(surface(&valid, 0).is_err(), "{wrong}");
        }
    }
}

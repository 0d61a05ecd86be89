//! Checks a scene before the first byte is written.

use std::collections::BTreeSet;
use std::io;

use super::invalid;
use crate::scene::{AlphaMode, Animation, MAX_JOINTS, MediaType, Scene, Surface, Track, Values};

/// Refuses nodes, materials and animations that would make an invalid file.
pub(super) fn check(scene: &Scene) -> io::Result<()> {
    check_nodes(scene)?;
    check_skin(scene)?;
    check_images(scene)?;
    check_materials(scene)?;
    scene
        .animations
        .iter()
        .try_for_each(|animation| check_animation(animation, scene.nodes.len()))
}

fn check_nodes(scene: &Scene) -> io::Result<()> {
    for (index, node) in scene.nodes.iter().enumerate() {
        let name = &node.name;
        if !node.translation.is_finite() || !node.rotation.is_finite() {
            return Err(invalid(format!(
                "node `{name}` has a position that is not a number"
            )));
        }
        // A child comes after its parent, so there can be no cycle.
        let in_order = |child: &usize| (index + 1..scene.nodes.len()).contains(child);
        if !node.children.iter().all(in_order) {
            return Err(invalid(format!("node `{name}` has a child out of order")));
        }
        if node.mesh.is_some_and(|mesh| mesh >= scene.meshes.len()) {
            return Err(invalid(format!("node `{name}` has a mesh out of range")));
        }
    }
    if scene.roots.iter().any(|root| *root >= scene.nodes.len()) {
        return Err(invalid("a root out of range"));
    }
    Ok(())
}

fn check_skin(scene: &Scene) -> io::Result<()> {
    let Some(skin) = &scene.skin else {
        return Ok(());
    };
    let own = scene.nodes.iter().any(|node| node.mesh == Some(skin.mesh));
    if own || skin.mesh >= scene.meshes.len() || skin.rest.len() != scene.nodes.len() {
        return Err(invalid("a skin that does not fit the nodes"));
    }
    match scene.nodes.len() > MAX_JOINTS {
        true => Err(invalid("a skin with too many joints")),
        false => Ok(()),
    }
}

fn check_images(scene: &Scene) -> io::Result<()> {
    for image in &scene.images {
        if MediaType::of(&image.bytes) != Some(image.media_type) {
            let (name, media_type) = (&image.name, image.media_type);
            return Err(invalid(format!("image `{name}` is not a {media_type:?}")));
        }
    }
    match scene.textures.iter().any(|t| t.image >= scene.images.len()) {
        true => Err(invalid("a texture with an image out of range")),
        false => Ok(()),
    }
}

fn check_materials(scene: &Scene) -> io::Result<()> {
    for material in &scene.materials {
        let mut textures = material.textures();
        if textures.any(|used| used.texture >= scene.textures.len()) {
            let name = &material.name;
            return Err(invalid(format!(
                "material `{name}` has a texture out of range"
            )));
        }
        let cutoff = match material.alpha_mode {
            AlphaMode::Mask { cutoff } => cutoff,
            AlphaMode::Opaque | AlphaMode::Blend => 0.0,
        };
        let factors = [material.metallic, material.roughness, cutoff];
        let amounts = material.textures().map(|used| &used.amount);
        let numbers = material
            .base_color
            .iter()
            .chain(&material.emissive)
            .chain(&factors)
            .chain(amounts);
        if !numbers.into_iter().all(|number| number.is_finite()) {
            return Err(invalid(format!(
                "material `{}` has a factor that is not a number",
                material.name
            )));
        }
    }
    Ok(())
}

fn check_animation(animation: &Animation, nodes: usize) -> io::Result<()> {
    let name = &animation.name;
    let wrong = |what: &str| Err(invalid(format!("animation `{name}` has {what}")));
    if !(0.0..f64::INFINITY).contains(&animation.seconds) {
        return wrong("a length that is not a duration");
    }
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
        if *node >= nodes {
            return wrong("a track of a node out of range");
        }
        let kind = match values {
            Values::Rotations(_) => 0,
            Values::Translations(_) => 1,
            Values::Weights(_) => 2,
        };
        if !animated.insert((*node, kind)) {
            return wrong("two tracks of one kind for one node");
        }
        let times = &timing.times;
        let ascending = times.windows(2).all(|pair| pair[0] < pair[1]);
        let within = times.first().is_some_and(|first| *first >= 0.0)
            && times.last().is_some_and(|last| last.is_finite());
        if !ascending || !within {
            return wrong("keys out of order in time, or none");
        }
        if values.len() != times.len() {
            return wrong("a different number of keys and times");
        }
        if !is_valid {
            return wrong("a key that is not a number, or not a rotation");
        }
    }
    Ok(())
}

/// Refuses an invalid surface with triangles, and returns the bounding box of a valid one. `joints` is the number of joints.
pub(super) fn surface(surface: &Surface, joints: usize) -> io::Result<[[f32; 3]; 2]> {
    let vertices = surface.positions.len();
    let lengths = [
        surface.normals.len(),
        surface.uvs.len(),
        surface.joints.len(),
    ];
    let is_whole = surface
        .targets
        .iter()
        .all(|target| target.len() == vertices);
    if !is_whole || !lengths.iter().all(|length| [0, vertices].contains(length)) {
        return Err(invalid(
            "a surface whose lists of vertices differ in length",
        ));
    }
    let greatest = surface.triangles.as_flattened().iter().max();
    if greatest.is_none_or(|vertex| *vertex as usize >= vertices) || vertices > u32::MAX as usize {
        return Err(invalid("a surface with a vertex out of range"));
    }
    if surface
        .joints
        .iter()
        .any(|joint| usize::from(*joint) >= joints)
    {
        return Err(invalid("a surface with a joint out of range"));
    }
    // A sum is finite only if all its terms are, and adds up without branches.
    let sum = |rows: &[f32]| rows.iter().map(|number| number * 0.0).sum::<f32>();
    let sums = sum(surface.positions.as_flattened())
        + sum(surface.normals.as_flattened())
        + sum(surface.uvs.as_flattened())
        + surface
            .targets
            .iter()
            .map(|target| sum(target.as_flattened()))
            .sum::<f32>();
    if !sums.is_finite() {
        return Err(invalid("a surface with a vertex that is not a number"));
    }
    bounds(&surface.positions).ok_or_else(|| invalid("a surface without vertices"))
}

/// The least and the greatest value of each coordinate; `None` without points.
pub(super) fn bounds(points: &[[f32; 3]]) -> Option<[[f32; 3]; 2]> {
    let first = [*points.first()?; 2];
    Some(points.iter().fold(first, |[min, max], p| {
        [
            [0, 1, 2].map(|i| min[i].min(p[i])),
            [0, 1, 2].map(|i| max[i].max(p[i])),
        ]
    }))
}

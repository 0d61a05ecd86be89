//! What a scene must keep to, seen before the first byte is written.

use std::io;

use super::invalid;
use crate::scene::{AlphaMode, MOST_JOINTS, MediaType, Scene};

/// Refuses nodes and materials that would make a file that no reader takes.
pub(super) fn check(scene: &Scene) -> io::Result<()> {
    check_nodes(scene)?;
    check_skin(scene)?;
    check_images(scene)?;
    check_materials(scene)
}

fn check_nodes(scene: &Scene) -> io::Result<()> {
    for (index, node) in scene.nodes.iter().enumerate() {
        let name = &node.name;
        if !node.translation.is_finite() || !node.rotation.is_finite() {
            return Err(invalid(format!(
                "node `{name}` stands nowhere: not a number"
            )));
        }
        // A child stands behind its parent, so no cycle gets past this.
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
    match scene.nodes.len() > MOST_JOINTS {
        true => Err(invalid("a skin with too many joints")),
        false => Ok(()),
    }
}

fn check_images(scene: &Scene) -> io::Result<()> {
    for image in &scene.images {
        if MediaType::of(&image.bytes) != Some(image.media_type) {
            let (name, media_type) = (&image.name, image.media_type);
            return Err(invalid(format!("image `{name}` is no {media_type:?}")));
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

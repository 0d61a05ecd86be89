//! Where a model lies on the page of its drawing.

use crate::math;
use glam::{DVec2, DVec3};

use super::{LookError, characters};
use crate::assemble::world_transform;
use crate::compile::Compiled;
use crate::render::{MAX_SIDE, RenderError, Sheet};
use crate::scene::{NodeId, Scene, WorldTransform};
use crate::terrain::Layer;

/// The elevation from which a landscape looks as drawn, in degrees.
const ELEVATION: f64 = 45.0;
/// A page reaches into the next pixel only by more than this, in pixels.
const ROUNDING: f64 = 1e-6;

/// A model as it is drawn: what shows it, and what of the world that is.
///
/// Figures are seen from the front. Landscapes are tilted by 45° towards the viewer, each at its place on the page, behind the
/// figures unless they are drawn after all of them: with their bend, they look as drawn. Characters that turn are shown in each of
/// their views, where that is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnView {
    /// The model. Its landscapes are roots.
    pub scene: Scene,
    /// The page, in the plane of the drawing.
    pub sheet: Sheet,
    /// Its width and height, pixels.
    pub size: [u32; 2],
}

impl DrawnView {
    /// How `scene`, the model of a compiled drawing, is drawn, at `scale` pixels a drawing unit.
    ///
    /// # Errors
    /// A page without a size, or with too many pixels.
    pub fn new(compiled: &Compiled, scene: Scene, scale: f64) -> Result<Self, LookError> {
        let (corner, size) = compiled.drawing.page;
        let [width, height] = (size * scale).to_array().map(|side| side - ROUNDING);
        if !(width > 0.0 && height > 0.0) {
            return Err(LookError::NoPage);
        }
        let size = [width, height].map(|side| side.ceil() as u32);
        if size.iter().any(|side| *side > MAX_SIDE) {
            return Err(RenderError::Size(size[0], size[1]).into());
        }
        let world = world_transform(&compiled.bindings, &compiled.layers);
        let mut scene = scene;
        tilt_landscapes(compiled, &world, &mut scene);
        characters::show_views(compiled, &world, &mut scene);
        Ok(Self {
            scene,
            sheet: Sheet {
                corner: world.point(DVec3::new(corner.x, -corner.y, 0.0)),
                right: world.rotation * DVec3::X,
                up: world.rotation * DVec3::Y,
                pixel: world.scale / scale,
            },
            size,
        })
    }
}

/// Moves and turns the landscapes to where they look as drawn from the front.
fn tilt_landscapes(compiled: &Compiled, world: &WorldTransform, scene: &mut Scene) {
    let layers = &compiled.layers;
    // No part and no other tile layer has the name of a tile layer.
    let node_of = |layer: &Layer| scene.nodes.position(|node| node.name == layer.name);
    let found: Option<Vec<NodeId>> = layers.iter().map(node_of).collect();
    let Some(found) = found.filter(|found| !found.is_empty()) else {
        return;
    };
    for node in &mut scene.nodes {
        node.children.retain(|child| !found.contains(child));
    }
    let extents = layers.iter().map(extent);
    // So far apart that none reaches into another, or into a figure.
    let apart = 2.0 * (compiled.drawing.page.1.length() + extents.fold(0.0, f64::max));
    let last_part = compiled.bindings.parts.iter().rfind(|part| {
        use crate::bind::PartKind;
        matches!(part.kind, PartKind::Main | PartKind::Sub)
    });
    let last_shape = last_part.map(|part| part.shape);
    for (index, (node, layer)) in found.into_iter().zip(layers).enumerate() {
        let first = layer.sources.first().map(|source| source.shape);
        let steps = if first > last_shape {
            index as f64 + 1.0
        } else {
            index as f64 - layers.len() as f64
        };
        let [low, high] = layer.bounds();
        let DVec2 { x, y } = low.midpoint(high);
        let moved = &mut scene.nodes[node];
        moved.translation = world.point(DVec3::new(x, -y, steps * apart));
        // Plain maps are drawn from straight above.
        let elevation = if layer.map.is_plain() {
            90.0
        } else {
            ELEVATION
        };
        moved.rotation = world.rotation * math::rotation_x(elevation.to_radians());
        if !scene.roots.contains(&node) {
            scene.roots.push(node);
        }
    }
}

/// The diagonal of a tile layer's grid, drawing units.
fn extent(layer: &Layer) -> f64 {
    let [low, high] = layer.bounds();
    low.distance(high)
}

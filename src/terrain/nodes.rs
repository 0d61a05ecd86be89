//! The nodes of landscapes: one for each tile layer.

use crate::math;

use super::reading::Layer;
use crate::bind::Bindings;
use crate::geometry::{Frame, y_up};
use crate::scene::{
    MaterialId, Mesh, NewNode, Node, NodeId, Primitive, Provenance, SurfacePatch, ViewDependent,
    WorldTransform,
};
use crate::svg::Drawing;

/// The node of a landscape. `parent` is the node of the part that the layer hangs on, with the part's frame; `material_of` gives
/// the scene's material for a material of the layer, if that is drawn.
pub(crate) fn node(
    layer: &Layer,
    drawing: &Drawing,
    bindings: &Bindings,
    world: &WorldTransform,
    parent: Option<(NodeId, &Frame)>,
    material_of: impl Fn(u8) -> Option<MaterialId>,
) -> NewNode {
    let [low, high] = layer.bounds();
    let middle = (low + high) / 2.0;
    let (translation, rotation) = match parent {
        // A landscape stays level, however the part that it hangs on is turned.
        Some((_, frame)) => (
            frame.to_local(y_up(middle)).extend(0.0) * world.scale,
            math::rotation_z(-frame.angle),
        ),
        None => (world.point_on_ground(middle), world.rotation),
    };
    let string = bindings.strings[layer.string].text.as_str();
    NewNode {
        node: Node {
            name: layer.name.clone(),
            translation,
            rotation,
            provenance: Some(Provenance {
                element: drawing.groups[layer.group].element.id.clone(),
                string: Some(string.to_owned()),
            }),
            // A plain map is no picture of its tops and fronts, so there is no drawn look.
            view_dependent: (!layer.map.is_plain()).then_some(ViewDependent::Bend),
            ..Node::default()
        },
        mesh: mesh(layer, layer.size * world.scale, material_of),
        parent: parent.map(|(node, _)| node),
    }
}

/// The mesh of a landscape; `tile` is the side of a tile in metres.
fn mesh(layer: &Layer, tile: f64, material_of: impl Fn(u8) -> Option<MaterialId>) -> Option<Mesh> {
    let mut primitives: Vec<Primitive> = Vec::new();
    for (index, mut surfaces) in layer.landscape.surface(layer.roof, layer.bevel) {
        let Some(material) = material_of(index) else {
            continue;
        };
        for position in surfaces
            .iter_mut()
            .flat_map(|surface| &mut surface.positions)
        {
            *position = position.map(|at| (f64::from(at) * tile) as f32);
        }
        let patches = surfaces.into_iter().map(SurfacePatch::from);
        let mut same = primitives.iter_mut();
        match same.find(|primitive| primitive.material == material) {
            Some(primitive) => primitive.patches.extend(patches),
            None => primitives.push(Primitive {
                patches: patches.collect(),
                material,
            }),
        }
    }
    (!primitives.is_empty()).then_some(Mesh { primitives })
}

//! The objects of maps of Tiled: pictures that stand on the ground.

use std::sync::Arc;

use glam::{DAffine2, DQuat, DVec2};
use rustc_hash::{FxHashMap, FxHashSet};
use typed_index_collections::TiSlice;

use super::materials::LookMaterials;
use crate::bind::{Bindings, Numbers};
use crate::diagnostic::{Code, Diagnostic};
use crate::scene::{
    MaterialId, Mesh, MeshId, NewNode, Node, NodeId, Primitive, Scene, SurfacePatch,
};
use crate::solid::{self, Placement, Profile, Sides, Solid};
use crate::terrain::{Footing, LandscapeId, Layer, LayerObject};

/// How thick an object is, as a share of its width.
const THICKNESS: f64 = 0.1;
/// The name of objects without one.
const NAMELESS: &str = "Object";

/// Gives objects without a name one, and a number to all whose name is taken: nodes are told apart by their names.
pub(super) fn name(bindings: &Bindings, layers: &mut TiSlice<LandscapeId, Layer>) {
    if layers.iter().all(|layer| layer.objects.is_empty()) {
        return;
    }
    let parts = bindings.parts.iter().map(|part| part.name.clone());
    let names = bindings.layers.iter().map(|layer| layer.name.clone());
    let mut taken: FxHashSet<String> = parts.chain(names).collect();
    let mut numbers = Numbers::default();
    for object in layers.iter_mut().flat_map(|layer| &mut layer.objects) {
        if object.name.is_empty() {
            NAMELESS.clone_into(&mut object.name);
        }
        if taken.contains(&object.name) {
            object.name = numbers.free(&object.name, 2, |name| !taken.contains(name));
        }
        taken.insert(object.name.clone());
    }
}

/// Adds the nodes of objects below those of their landscapes. Objects with one picture and one size share a mesh. `scale` are metres in
/// a drawing unit.
pub(super) fn add(
    layers: &TiSlice<LandscapeId, Layer>,
    landscapes: &TiSlice<LandscapeId, NodeId>,
    materials: &LookMaterials,
    scale: f64,
    scene: &mut Scene,
) {
    let mut meshes: FxHashMap<(MaterialId, [u64; 2]), MeshId> = FxHashMap::default();
    for (index, layer) in layers.iter_enumerated() {
        for object in &layer.objects {
            let Some(material) = materials.of(index, object.material) else {
                continue;
            };
            let (_, size) = object.look();
            let mesh = meshes.entry((material, size));
            let mesh = *mesh.or_insert_with(|| {
                scene
                    .meshes
                    .push_and_get_key(mesh_of(object, material, scale))
            });
            let mut point = layer.place(object.foot).point * layer.size;
            // Its face is where it is drawn.
            point.z -= THICKNESS / 2.0 * object.size.x;
            let id = scene.add(NewNode {
                node: Node {
                    name: object.name.clone(),
                    translation: point * scale,
                    rotation: DQuat::IDENTITY,
                    ..Node::default()
                },
                mesh: None,
                parent: Some(landscapes[index]),
            });
            scene.nodes[id].mesh = Some(mesh);
        }
    }
}

/// A slab with the object's picture on both faces, on its foot.
fn mesh_of(object: &LayerObject, material: MaterialId, scale: f64) -> Mesh {
    let DVec2 {
        x: width,
        y: height,
    } = object.size;
    let stand = DAffine2::from_scale(DVec2::new(width, -height))
        * DAffine2::from_translation(DVec2::new(-0.5, -1.0));
    let solid = Solid {
        outline: Arc::clone(&object.outline),
        to_frame: stand,
        profile: Profile::plate(THICKNESS / 2.0 * width),
        options: solid::Options {
            segments: solid::LEAST_SEGMENTS,
            crease: 30.0,
            placement: Placement {
                scale,
                ..Placement::default()
            },
        },
        sides: Sides::Front,
        // The outline is in the unit square of the picture.
        texture: Some(DAffine2::IDENTITY),
    };
    Mesh {
        primitives: vec![Primitive {
            patches: vec![SurfacePatch::Deferred(Arc::new(solid))],
            material,
        }],
    }
}

/// Reports objects beside their map, and such as float.
pub(super) fn report(
    bindings: &Bindings,
    layers: &TiSlice<LandscapeId, Layer>,
    diagnostics: &mut Vec<Diagnostic>,
) {
    for layer in layers {
        let count = |footing: Footing| {
            let objects = layer.objects.iter();
            let places = objects.filter(|object| layer.place(object.foot).footing == footing);
            places.count()
        };
        let span = bindings.strings[layer.string].text.whole();
        let name = &layer.name;
        let objects = |count: usize, singular: &str, plural: &str| match count {
            1 => format!("1 object of `{name}` {singular}"),
            count => format!("{count} objects of `{name}` {plural}"),
        };
        let outside = count(Footing::Outside);
        if outside > 0 {
            let message = objects(
                outside,
                "is beside its tiles, and stands at height 0",
                "are beside its tiles, and stand at height 0",
            );
            let help =
                "move them onto tiles in Tiled: they stand on the middle of their lower edge";
            diagnostics.push(Diagnostic::new(Code::NoFooting, span, message).help(help));
        }
        let floating = count(Footing::Water);
        if floating > 0 {
            let message = objects(floating, "floats", "float");
            let help = "nothing needs to be done if these are boats; else move their lower edges onto ground in Tiled";
            diagnostics.push(Diagnostic::new(Code::Floats, span, message).help(help));
        }
    }
}

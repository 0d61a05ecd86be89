//! The JSON of a scene.

use std::io;
use std::ops::Range;

use ::gltf::json::accessor::Accessor as JsonAccessor;
use ::gltf::json::buffer::View as JsonView;
use ::gltf::json::extensions::scene as node_extensions;
use ::gltf::json::mesh::{
    Mesh as JsonMesh, Mode, MorphTarget, Primitive as JsonPrimitive, Semantic,
};
use ::gltf::json::scene::UnitQuaternion;
use ::gltf::json::validation::Checked::Valid;
use ::gltf::json::{Asset, Index, Node as JsonNode, Root, Scene as JsonScene, Skin as JsonSkin};
use rustc_hash::FxHashMap;
use serde::Serialize;
use serde_json::json;
use serde_json::value::to_raw_value;
use typed_index_collections::{TiVec, ti_vec};

use super::buffer::Kind;
use super::json::Json;
use super::primitives::{Packed, PackedSkin};
use super::{ROOT, SKINNED, VIEW_DEPENDENT, animations, cameras, materials};
use crate::scene::{self, CameraId, MaterialId, MeshId, NodeId, Scene, Turn, ViewDependent};

/// The JSON up to the buffers, without the closing brace.
pub(super) fn describe(scene: &Scene, packed: &Packed) -> io::Result<Json> {
    let root_node = scene.nodes.len();
    let skins = &packed.skins;
    let mut root = Root {
        asset: Asset {
            generator: Some(concat!("okoshi ", env!("CARGO_PKG_VERSION")).to_owned()),
            ..Asset::default()
        },
        extensions_used: extensions(scene),
        scene: Some(Index::new(0)),
        // A skinned mesh follows its joints alone, so it has no parent.
        scenes: vec![JsonScene {
            nodes: (root_node..=root_node + skins.len()).map(index).collect(),
            extensions: None,
            extras: None,
            name: None,
        }],
        ..Root::default()
    };
    materials::add_textures(scene, packed, &mut root);
    root.skins.extend(skins.iter().map(|skin| JsonSkin {
        inverse_bind_matrices: Some(index(skin.bind_matrices)),
        joints: skin.joints.iter().copied().map(index).collect(),
        // All skins have the same, so that programs with one skeleton for a figure make one.
        skeleton: Some(index(root_node)),
        extensions: None,
        extras: None,
        name: None,
    }));
    let mut json = Json::new(&root)?;

    let first_primitives: TiVec<MeshId, usize> =
        starts(scene.meshes.iter().map(|mesh| mesh.primitives.len()));
    let primitives = |mesh: MeshId| {
        let first = first_primitives[mesh];
        &packed.primitives[first..first + scene.meshes[mesh].primitives.len()]
    };
    let written = |mesh: MeshId| !primitives(mesh).iter().all(Range::is_empty);
    let meshes: TiVec<MeshId, usize> =
        starts(scene.meshes.keys().map(|mesh| usize::from(written(mesh))));
    let mesh_index = |mesh: MeshId| written(mesh).then(|| index(meshes[mesh]));
    let mut owners: TiVec<NodeId, Option<NodeId>> = ti_vec![None; scene.nodes.len()];
    for skin in skins {
        for bone in skin.joints.iter().filter(|_| skin.node.is_some()) {
            // Garments follow the bones of what wears them, which comes first.
            owners[*bone] = owners[*bone].or(skin.node.filter(|node| node != bone));
        }
    }
    json.list("nodes", root_node + 1 + skins.len(), |id: NodeId| {
        Some(match scene.nodes.get(id) {
            Some(node) => JsonNode {
                mesh: node
                    .mesh
                    .filter(|_| node.bones.is_empty())
                    .and_then(mesh_index),
                extras: match owners[id] {
                    Some(owner) => bone_extras(node, &scene.nodes[owner]),
                    None => part_extras(node),
                },
                ..json_node(node)
            },
            None => match usize::from(id).checked_sub(root_node + 1) {
                Some(number) => JsonNode {
                    mesh: mesh_index(skins[number].mesh),
                    skin: Some(index(number)),
                    ..skinned_node(scene, &skins[number])
                },
                None => JsonNode {
                    name: name(ROOT),
                    children: children(&scene.roots),
                    ..JsonNode::default()
                },
            },
        })
    })?;

    // A mesh is named after the first node that shows it.
    let mut names: TiVec<MeshId, &str> = ti_vec![""; scene.meshes.len()];
    for node in scene.nodes.iter().rev() {
        if let Some(mesh) = node.mesh {
            names[mesh] = &node.name;
        }
    }
    let targets = target_names(scene);
    json.list("meshes", scene.meshes.len(), |mesh: MeshId| {
        let primitives = scene.meshes[mesh].primitives.iter().zip(primitives(mesh));
        let primitives = primitives.filter(|(_, accessors)| !accessors.is_empty());
        let primitives: Vec<_> = primitives
            .map(|(primitive, accessors)| json_primitive(primitive, accessors.clone(), packed))
            .collect();
        (!primitives.is_empty()).then(|| JsonMesh {
            name: name(names[mesh]),
            primitives,
            weights: None,
            extensions: None,
            extras: targets
                .get(&mesh)
                .and_then(|target_names| to_raw_value(&TargetNames { target_names }).ok()),
        })
    })?;
    json.list("cameras", scene.cameras.len(), |id: CameraId| {
        Some(cameras::camera(&scene.cameras[id]))
    })?;
    json.list("materials", scene.materials.len(), |id: MaterialId| {
        Some(materials::material(&scene.materials[id]))
    })?;
    let first_tracks: Vec<usize> = starts(scene.animations.iter().map(|a| a.tracks.len()));
    json.list("animations", scene.animations.len(), |number: usize| {
        let animation = &scene.animations[number];
        let accessors = &packed.tracks[first_tracks[number]..];
        (!animation.tracks.is_empty()).then(|| animations::animation(animation, accessors))
    })?;
    let layout = &packed.layout;
    json.list("accessors", layout.accessors.len(), |number: usize| {
        Some(JsonAccessor::from(&layout.accessors[number]))
    })?;
    json.list("bufferViews", layout.views.len(), |number: usize| {
        Some(JsonView::from(&layout.views[number]))
    })?;
    Ok(json)
}

/// About how many bytes the JSON takes, more often too many than too few.
pub(super) fn estimate_length(scene: &Scene) -> u64 {
    let node = |node: &scene::Node| {
        let texts = node.provenance.iter().flat_map(|p| [&p.element, &p.string]);
        let texts = texts.flatten().map(|text| 30 + text.len());
        160 + 2 * node.name.len() + texts.sum::<usize>() // The name is the mesh's too.
    };
    let nodes: usize = scene.nodes.iter().map(node).sum();
    let primitives = scene.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let tracks = scene.animations.iter().flat_map(|a| &a.tracks);
    let cameras = scene.cameras.iter().map(|camera| 160 + camera.name.len());
    (4096 + nodes + 520 * primitives.count() + 400 * tracks.count() + cameras.sum::<usize>()) as u64
}

/// The extensions that the scene uses.
fn extensions(scene: &Scene) -> Vec<String> {
    let mut nodes = scene.nodes.iter();
    let view_dependent = nodes.any(|node| node.view_dependent.is_some());
    let unlit = scene.materials.iter().any(|material| material.unlit);
    let used = [(unlit, materials::UNLIT), (view_dependent, VIEW_DEPENDENT)].into_iter();
    let used = used.filter(|(is_used, _)| *is_used);
    used.map(|(_, name)| name.to_owned()).collect()
}

/// The index of the first element of each group, for groups that follow one another.
fn starts<List: FromIterator<usize>>(counts: impl Iterator<Item = usize>) -> List {
    let start = |next: &mut usize, count| {
        *next += count;
        Some(*next - count)
    };
    counts.scan(0, start).collect()
}

/// A node without its mesh and extras.
fn json_node(node: &scene::Node) -> JsonNode {
    let translation = node.translation.as_vec3().to_array();
    let rotation = node.rotation.as_quat().to_array();
    // A quaternion and its negative are the same rotation.
    let rotated = rotation.map(f32::abs) != [0.0, 0.0, 0.0, 1.0];
    JsonNode {
        name: name(&node.name),
        children: children(&node.children),
        camera: node.camera.map(index),
        translation: (translation != [0.0; 3]).then_some(translation),
        rotation: rotated.then_some(UnitQuaternion(rotation)),
        extensions: node.view_dependent.as_ref().map(|view_dependent| {
            // One object for each way of following the viewer, so that later ones have keys of their own.
            let extension = match view_dependent {
                scene::ViewDependent::Bend => json!({ "bend": {} }),
                scene::ViewDependent::Turn(Turn { views, between }) => {
                    let sets = between.iter();
                    let between: Vec<Vec<usize>> = sets
                        .map(|set| set.iter().copied().map(usize::from).collect())
                        .collect();
                    json!({ "turn": { "views": views.raw, "between": between } })
                }
                scene::ViewDependent::Region(places) => {
                    let places: Vec<[f32; 3]> =
                        places.iter().map(|p| p.as_vec3().to_array()).collect();
                    json!({ "region": { "places": places } })
                }
            };
            node_extensions::Node {
                others: [(VIEW_DEPENDENT.to_owned(), extension)]
                    .into_iter()
                    .collect(),
            }
        }),
        ..JsonNode::default()
    }
}

/// What a part's node says about the drawing.
fn part_extras(node: &scene::Node) -> ::gltf::json::Extras {
    let provenance = node.provenance.as_ref()?;
    let okoshi = Provenance {
        element: provenance.element.as_deref(),
        string: provenance.string.as_deref(),
    };
    let known = okoshi.element.is_some() || okoshi.string.is_some();
    known.then(|| to_raw_value(&Extras { okoshi }).ok())?
}

/// What a bone says about the part inside which it is.
fn bone_extras(bone: &scene::Node, part: &scene::Node) -> ::gltf::json::Extras {
    let okoshi = OfBone {
        bone_of: &part.name,
        shares: Some(bone.shares).filter(|shares| *shares > 0),
    };
    to_raw_value(&Extras { okoshi }).ok()
}

/// The node that shows the mesh of a skin, without mesh and skin.
fn skinned_node(scene: &Scene, skin: &PackedSkin) -> JsonNode {
    let Some(part) = skin.node.map(|node| &scene.nodes[node]) else {
        return JsonNode {
            name: name(SKINNED),
            ..JsonNode::default()
        };
    };
    let okoshi = OfNode {
        mesh_of: &part.name,
    };
    JsonNode {
        name: name(&format!("{}.mesh", part.name)),
        extras: to_raw_value(&Extras { okoshi }).ok(),
        ..JsonNode::default()
    }
}

#[derive(Serialize)]
struct Extras<T> {
    okoshi: T,
}

/// The part that a bone is inside of, and how many nodes make the turn of its joint together: it and those above it.
#[derive(Serialize)]
struct OfBone<'a> {
    bone_of: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    shares: Option<usize>,
}

/// The part whose mesh a node shows, because a mesh with bones follows them alone.
#[derive(Serialize)]
struct OfNode<'a> {
    mesh_of: &'a str,
}

/// The names of a mesh's morph targets, where many programs look for them.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct TargetNames<'a> {
    target_names: &'a [String],
}

/// The names of the morph targets of the regions of characters, by mesh: the views that they belong to.
fn target_names(scene: &Scene) -> FxHashMap<MeshId, Vec<String>> {
    let mut names = FxHashMap::default();
    for node in &scene.nodes {
        let Some(ViewDependent::Turn(turn)) = &node.view_dependent else {
            continue;
        };
        let name = |[theta, phi]: &[f64; 2]| format!("View {theta} {phi}");
        let views: Vec<String> = turn.views.iter().skip(1).map(name).collect();
        let meshes = node
            .children
            .iter()
            .filter_map(|child| scene.nodes[*child].mesh);
        names.extend(meshes.map(|mesh| (mesh, views.clone())));
    }
    names
}

#[derive(Serialize)]
struct Provenance<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    element: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    string: Option<&'a str>,
}

fn json_primitive(
    primitive: &scene::Primitive,
    accessors: Range<usize>,
    packed: &Packed,
) -> JsonPrimitive {
    let mut json = JsonPrimitive {
        attributes: Default::default(),
        indices: None,
        material: Some(index(primitive.material)),
        mode: Valid(Mode::Triangles),
        targets: None,
        extensions: None,
        extras: None,
    };
    for accessor in accessors {
        let semantic = match packed.layout.accessors[accessor].kind {
            Kind::Positions => Semantic::Positions,
            Kind::Normals => Semantic::Normals,
            Kind::Displacements => {
                json.targets.get_or_insert_default().push(MorphTarget {
                    positions: Some(index(accessor)),
                    normals: None,
                    tangents: None,
                });
                continue;
            }
            Kind::TexCoords => Semantic::TexCoords(0),
            Kind::JointsU16 | Kind::JointsU8 => Semantic::Joints(0),
            Kind::Weights => Semantic::Weights(0),
            _ => {
                json.indices = Some(index(accessor));
                continue;
            }
        };
        json.attributes.insert(Valid(semantic), index(accessor));
    }
    json
}

/// The index of an item. A file that fits its format has fewer than 2³² items of each kind.
pub(super) fn index<T>(number: impl Into<usize>) -> Index<T> {
    Index::new(number.into() as u32)
}

/// A name, unless it is empty.
pub(super) fn name(name: &str) -> Option<String> {
    (!name.is_empty()).then(|| name.to_owned())
}

fn children<T>(nodes: &[NodeId]) -> Option<Vec<Index<T>>> {
    (!nodes.is_empty()).then(|| nodes.iter().copied().map(index).collect())
}

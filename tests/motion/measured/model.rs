//! A model as other programs get it: the vertices of a GLB, moved by the nodes and the skins of its clips.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3, Mat4, Quat, Vec3};
use gltf::animation::util::ReadOutputs;
use okoshi::internals::mocap::Transform;

/// A node with its mesh, or with the mesh of the skin whose first joint it is.
pub(super) struct Node {
    pub(super) parent: Option<usize>,
    local: Transform,
    pub(super) corners: Vec<Corner>,
    triangles: Vec<[u32; 3]>,
}

/// A corner of a mesh: the nodes that move it, each with its weight and with the corner's place in its frame.
pub(super) struct Corner(Vec<(usize, f64, DVec3)>);

impl Corner {
    /// Where it is in the world.
    pub(super) fn place(&self, world: &[Transform]) -> DVec3 {
        let places = self.0.iter().map(|(node, weight, local)| {
            let placed = world[*node];
            (placed.position + placed.rotation * *local) * *weight
        });
        places.sum()
    }
}

/// The direction of rays: no edge of a drawn figure is parallel to it.
const RAY: DVec3 = DVec3::new(0.351, 0.217, 0.911);

/// A surface in the world.
pub(super) struct Surface<'a> {
    corners: Vec<DVec3>,
    /// The lowest and the highest corner of its bounding box.
    bounds: [DVec3; 2],
    triangles: &'a [[u32; 3]],
}

impl Surface<'_> {
    /// Whether a point is inside: a ray from it leaves the surface more often than it enters it.
    pub(super) fn contains(&self, point: DVec3) -> bool {
        let [low, high] = self.bounds;
        if point.clamp(low, high) != point {
            return false;
        }
        let mut leaves = 0;
        for triangle in self.triangles {
            let [a, b, c] = triangle.map(|corner| self.corners[corner as usize] - point);
            let normals = [a.cross(b), b.cross(c), c.cross(a)];
            let sides = normals.map(|normal| normal.dot(RAY) > 0.0);
            // On the same side of all edges, the ray meets the triangle, ahead of the point or behind it.
            if sides[0] == sides[1] && sides[1] == sides[2] {
                let is_ahead = (a.dot(normals[1]) > 0.0) == sides[0];
                leaves += i32::from(is_ahead) * if sides[0] { 1 } else { -1 };
            }
        }
        leaves > 0
    }
}

/// The keys of a node in a clip, one per frame.
#[derive(Default)]
struct Keys {
    places: Vec<DVec3>,
    turns: Vec<DQuat>,
}

/// A model.
pub(super) struct Model {
    pub(super) nodes: Vec<Node>,
    names: BTreeMap<String, usize>,
    /// Per clip its name, and the keys of nodes.
    clips: BTreeMap<String, BTreeMap<usize, Keys>>,
    /// The nodes, parents before children.
    order: Vec<usize>,
}

impl Model {
    pub(super) fn read(glb: &[u8]) -> Self {
        let file = gltf::Gltf::from_slice(glb).expect("a GLB");
        let blob = file.blob.as_deref().expect("its data");
        let mut model = Self {
            nodes: Vec::new(),
            names: BTreeMap::new(),
            clips: BTreeMap::new(),
            order: Vec::new(),
        };
        for node in file.nodes() {
            let name = node.name().unwrap_or_default().to_owned();
            model.names.entry(name).or_insert(node.index());
            model.nodes.push(read_node(&node));
        }
        for node in file.nodes() {
            let joints = joints(&node, blob);
            let owner = &mut model.nodes[joints[0].0];
            for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
                owner.add(&primitive, &joints, blob);
            }
            for child in node.children() {
                model.nodes[child.index()].parent = Some(node.index());
            }
        }
        let scene = file.default_scene().expect("a scene");
        let mut stack: Vec<gltf::Node<'_>> = scene.nodes().collect();
        while let Some(node) = stack.pop() {
            model.order.push(node.index());
            stack.extend(node.children());
        }
        for clip in file.animations() {
            let name = clip.name().unwrap_or_default().to_owned();
            let nodes = model.clips.entry(name).or_default();
            for channel in clip.channels() {
                let reader = channel.reader(|_| Some(blob));
                let keys = nodes.entry(channel.target().node().index()).or_default();
                match reader.read_outputs().expect("values") {
                    ReadOutputs::Translations(places) => {
                        keys.places = places.map(|at| Vec3::from(at).as_dvec3()).collect();
                    }
                    ReadOutputs::Rotations(turns) => {
                        let turns = turns.into_f32();
                        keys.turns = turns
                            .map(|turn| Quat::from_array(turn).as_dquat())
                            .collect();
                    }
                    _ => panic!("a figure is moved and turned"),
                }
            }
        }
        model
    }

    /// The node of a name.
    pub(super) fn named(&self, name: &str) -> Option<usize> {
        self.names.get(name).copied()
    }

    /// A node and what hangs on it.
    pub(super) fn with_children(&self, node: usize) -> Vec<usize> {
        let above = |node: &usize| self.nodes[*node].parent;
        let is_below =
            |other: &usize| std::iter::successors(Some(*other), above).any(|other| other == node);
        (0..self.nodes.len()).filter(is_below).collect()
    }

    /// The transforms of the nodes at rest.
    pub(super) fn at_rest(&self) -> Vec<Transform> {
        self.placed(|node| self.nodes[node].local)
    }

    /// The transforms of the nodes in a frame of a clip.
    pub(super) fn at(&self, clip: &str, frame: usize) -> Vec<Transform> {
        let keys = &self.clips[clip];
        self.placed(|node| {
            let mut local = self.nodes[node].local;
            if let Some(keys) = keys.get(&node) {
                local.position = keys.places.get(frame).copied().unwrap_or(local.position);
                local.rotation = keys.turns.get(frame).copied().unwrap_or(local.rotation);
            }
            local
        })
    }

    fn placed(&self, local: impl Fn(usize) -> Transform) -> Vec<Transform> {
        let mut world: Vec<Transform> = (0..self.nodes.len()).map(&local).collect();
        for node in &self.order {
            if let Some(parent) = self.nodes[*node].parent {
                let (above, own) = (world[parent], world[*node]);
                world[*node] = Transform {
                    rotation: above.rotation * own.rotation,
                    position: above.position + above.rotation * own.position,
                };
            }
        }
        world
    }

    /// The corners of some nodes' meshes in the world.
    pub(super) fn corners<'a>(
        &'a self,
        nodes: &'a [usize],
        world: &'a [Transform],
    ) -> impl Iterator<Item = DVec3> + 'a {
        let corners = nodes.iter().flat_map(|node| &self.nodes[*node].corners);
        corners.map(|corner| corner.place(world))
    }

    /// A node's mesh in the world.
    pub(super) fn surface(&self, node: usize, world: &[Transform]) -> Surface<'_> {
        let node = &self.nodes[node];
        let corners = node.corners.iter().map(|corner| corner.place(world));
        let corners: Vec<DVec3> = corners.collect();
        let [low, high] = [DVec3::min, DVec3::max].map(|extreme| {
            let extremes = corners.iter().copied();
            extremes.reduce(extreme).unwrap_or_default()
        });
        Surface {
            corners,
            bounds: [low, high],
            triangles: &node.triangles,
        }
    }
}

fn read_node(node: &gltf::Node<'_>) -> Node {
    let (place, turn, _) = node.transform().decomposed();
    Node {
        parent: None,
        local: Transform {
            rotation: Quat::from_array(turn).as_dquat(),
            position: Vec3::from(place).as_dvec3(),
        },
        corners: Vec::new(),
        triangles: Vec::new(),
    }
}

/// The nodes that move the mesh of a node, each with the matrix that leads from the mesh to its frame.
fn joints(node: &gltf::Node<'_>, blob: &[u8]) -> Vec<(usize, Mat4)> {
    let Some(skin) = node.skin() else {
        return vec![(node.index(), Mat4::IDENTITY)];
    };
    let reader = skin.reader(|_| Some(blob));
    let matrices = reader.read_inverse_bind_matrices().expect("bind matrices");
    let joints = skin.joints().map(|joint| joint.index());
    let matrices = matrices.map(|columns| Mat4::from_cols_array_2d(&columns));
    joints.zip(matrices).collect()
}

impl Node {
    /// Adds a primitive of a mesh that these nodes move.
    fn add(&mut self, primitive: &gltf::Primitive<'_>, joints: &[(usize, Mat4)], blob: &[u8]) {
        let reader = primitive.reader(|_| Some(blob));
        let first = self.corners.len() as u32;
        let places = reader.read_positions().expect("positions");
        let places: Vec<Vec3> = places.map(Vec3::from).collect();
        let bound = reader.read_joints(0).map(|joints| joints.into_u16());
        let weights = reader.read_weights(0).map(|weights| weights.into_f32());
        match bound.zip(weights) {
            Some((bound, weights)) => {
                let corners = places.iter().zip(bound.zip(weights));
                self.corners
                    .extend(corners.map(|(place, (bound, weights))| {
                        let own = bound.into_iter().zip(weights);
                        let own = own.filter(|(_, weight)| *weight > 0.0);
                        let own = own.map(|(joint, weight)| {
                            let (node, matrix) = &joints[usize::from(joint)];
                            let local = matrix.transform_point3(*place);
                            (*node, f64::from(weight), local.as_dvec3())
                        });
                        Corner(own.collect())
                    }));
            }
            None => {
                let corners = places
                    .iter()
                    .map(|place| (joints[0].0, 1.0, place.as_dvec3()));
                self.corners.extend(corners.map(|own| Corner(vec![own])));
            }
        }
        let indices: Vec<u32> = reader.read_indices().expect("indices").into_u32().collect();
        let triangles = indices.chunks_exact(3);
        self.triangles
            .extend(triangles.map(|t| [t[0] + first, t[1] + first, t[2] + first]));
    }
}

//! Where everything lies in the one buffer.

use std::io;

use rayon::prelude::*;

use super::invalid;
use crate::scene::{Primitive, Scene, Surface};

/// A kind of data. Each has one buffer view; the order, widest components first, keeps every
/// accessor aligned without padding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Positions,
    Normals,
    Uvs,
    Indices(IndexType),
}

impl Kind {
    pub(super) const ALL: [Self; 6] = [
        Self::Positions,
        Self::Normals,
        Self::Uvs,
        Self::Indices(IndexType::U32),
        Self::Indices(IndexType::U16),
        Self::Indices(IndexType::U8),
    ];

    fn slot(self) -> usize {
        match self {
            Self::Positions => 0,
            Self::Normals => 1,
            Self::Uvs => 2,
            Self::Indices(IndexType::U32) => 3,
            Self::Indices(IndexType::U16) => 4,
            Self::Indices(IndexType::U8) => 5,
        }
    }

    /// How many accessor elements of this kind a surface has, and how many bytes they take.
    fn measure(self, surface: &Surface) -> (usize, u64) {
        let (count, size) = match self {
            Self::Positions => (surface.positions.len(), 12),
            Self::Normals => (surface.normals.len(), 12),
            Self::Uvs => (surface.uvs.len(), 8),
            Self::Indices(index) if index == IndexType::of(surface) => {
                (surface.triangles.len() * 3, index.size())
            }
            Self::Indices(_) => (0, 0),
        };
        (count, count as u64 * size)
    }
}

/// The component type of an index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum IndexType {
    U8,
    U16,
    U32,
}

impl IndexType {
    /// The smallest type for the surface's corners. A type's greatest value is not an index: it
    /// restarts primitives.
    pub(super) fn of(surface: &Surface) -> Self {
        match surface.positions.len() {
            0..=0xFF => Self::U8,
            0x100..=0xFFFF => Self::U16,
            _ => Self::U32,
        }
    }

    fn size(self) -> u64 {
        match self {
            Self::U8 => 1,
            Self::U16 => 2,
            Self::U32 => 4,
        }
    }
}

/// A stretch of the buffer that holds all data of a kind.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    pub(super) kind: Kind,
    pub(super) offset: u64,
    pub(super) length: u64,
}

/// Elements of one kind that belong to one primitive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    pub(super) kind: Kind,
    /// Number of the view.
    pub(super) view: usize,
    /// Where the run begins in its view.
    pub(super) offset: u64,
    pub(super) count: usize,
}

/// The corners of a primitive's box.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    pub(super) min: [f32; 3],
    pub(super) max: [f32; 3],
}

/// The plan of a file, known before the first byte is written.
#[derive(Debug)]
pub(super) struct Layout {
    /// The views that are not empty, in the order of the buffer.
    pub(super) views: Vec<View>,
    /// One box for each primitive that is written.
    pub(super) bounds: Vec<Bounds>,
    /// The number in the file of each mesh of the scene; none for one without triangles.
    pub(super) mesh_numbers: Vec<Option<usize>>,
    /// The view of each kind.
    view_numbers: [usize; 6],
}

impl Layout {
    pub(super) fn new(scene: &Scene) -> io::Result<Self> {
        check_nodes(scene)?;
        check_materials(scene)?;
        let bounds = written(scene)
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(|primitive| bounds(primitive, scene.materials.len()))
            .collect::<io::Result<_>>()?;

        let mut lengths = [0; 6];
        for primitive in written(scene) {
            for kind in Kind::ALL {
                lengths[kind.slot()] += kind.measure(&primitive.surface).1;
            }
        }
        let mut views = vec![];
        let mut view_numbers = [0; 6];
        let mut offset = 0;
        for kind in Kind::ALL {
            let length = lengths[kind.slot()];
            if length > 0 {
                view_numbers[kind.slot()] = views.len();
                views.push(View {
                    kind,
                    offset,
                    length,
                });
                offset += length;
            }
        }

        let mut number = 0;
        let mesh_numbers = scene
            .meshes
            .iter()
            .map(|mesh| {
                mesh.primitives.iter().any(is_written).then(|| {
                    number += 1;
                    number - 1
                })
            })
            .collect();
        Ok(Self {
            views,
            bounds,
            mesh_numbers,
            view_numbers,
        })
    }

    /// The length of the buffer.
    pub(super) fn byte_length(&self) -> u64 {
        self.views
            .last()
            .map_or(0, |view| view.offset + view.length)
    }

    /// All accessors of the file, in their order, each with the number of its primitive.
    pub(super) fn runs<'a>(&'a self, scene: &'a Scene) -> impl Iterator<Item = (usize, Run)> + 'a {
        let mut offsets = [0; 6];
        written(scene)
            .enumerate()
            .flat_map(move |(primitive, part)| {
                kinds(&part.surface).map(|kind| {
                    let kind = kind?;
                    let (count, length) = kind.measure(&part.surface);
                    let offset = offsets[kind.slot()];
                    offsets[kind.slot()] += length;
                    let view = self.view_numbers[kind.slot()];
                    Some((
                        primitive,
                        Run {
                            kind,
                            view,
                            offset,
                            count,
                        },
                    ))
                })
            })
            .flatten()
    }
}

/// The kinds of data that a surface has, in the order of its accessors.
pub(super) fn kinds(surface: &Surface) -> [Option<Kind>; 4] {
    [
        Some(Kind::Positions),
        (!surface.normals.is_empty()).then_some(Kind::Normals),
        (!surface.uvs.is_empty()).then_some(Kind::Uvs),
        Some(Kind::Indices(IndexType::of(surface))),
    ]
}

/// Whether a primitive is written at all: glTF has no empty accessors.
pub(super) fn is_written(primitive: &Primitive) -> bool {
    !primitive.surface.triangles.is_empty()
}

/// The primitives that are written, in the order of their accessors and of their data.
pub(super) fn written(scene: &Scene) -> impl Iterator<Item = &Primitive> {
    scene
        .meshes
        .iter()
        .flat_map(|mesh| &mesh.primitives)
        .filter(|primitive| is_written(primitive))
}

/// Refuses nodes and materials that would make a file that no reader takes.
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

fn check_materials(scene: &Scene) -> io::Result<()> {
    for material in &scene.materials {
        let factors = [material.metallic, material.roughness];
        let numbers = material
            .base_color
            .iter()
            .chain(&material.emissive)
            .chain(&factors);
        if !numbers.into_iter().all(|number| number.is_finite()) {
            return Err(invalid(format!(
                "material `{}` has a factor that is not a number",
                material.name
            )));
        }
    }
    Ok(())
}

/// The box of a primitive, which must be sound.
fn bounds(primitive: &Primitive, materials: usize) -> io::Result<Bounds> {
    let surface = &primitive.surface;
    let corners = surface.positions.len();
    let lengths = [surface.normals.len(), surface.uvs.len()];
    if !lengths.iter().all(|length| [0, corners].contains(length)) {
        return Err(invalid("a surface whose lists of corners differ in length"));
    }
    let greatest = surface.triangles.as_flattened().iter().max();
    if greatest.is_none_or(|corner| *corner as usize >= corners) || corners > u32::MAX as usize {
        return Err(invalid("a surface with a corner out of range"));
    }
    if primitive.material >= materials {
        return Err(invalid("a primitive with a material out of range"));
    }
    let floats = surface.positions.as_flattened().iter();
    let floats = floats.chain(surface.normals.as_flattened());
    if !floats
        .chain(surface.uvs.as_flattened())
        .all(|f| f.is_finite())
    {
        return Err(invalid("a surface with a corner that is not a number"));
    }
    let mut min = [f32::INFINITY; 3];
    let mut max = [f32::NEG_INFINITY; 3];
    for position in &surface.positions {
        for axis in 0..3 {
            min[axis] = min[axis].min(position[axis]);
            max[axis] = max[axis].max(position[axis]);
        }
    }
    Ok(Bounds { min, max })
}

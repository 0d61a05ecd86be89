//! The binary data of the primitives: surfaces are made, packed little-endian and written, a window of primitives at a time.
//!
//! A model of a hundred thousand parts is never in memory as a whole: while one window is written, the next one is made,
//! on all cores. A window's data lies together, with a buffer view for each kind in it; the size of windows is fixed, so
//! that the bytes do not depend on the machine.

use std::io;
use std::ops::Range;

use glam::DMat4;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec};

use super::animations;
use super::buffer::{Accessor, BufferWriter, Kind, Layout, Sink, floats};
use super::{Written, invalid};
use crate::export::check;
use crate::export::size::{Extent, Placed};
use crate::export::surfaces::with_surface;
use crate::memo::Memo;
use crate::scene::{
    Image, ImageId, Influence, MediaType, MeshId, NodeId, Primitive, RigidTransform, Scene, Skin,
    Surface,
};

/// Primitives in a window.
const WINDOW: usize = 512;
/// Primitives that are packed by one thread at a time.
const BATCH: usize = 32;

/// An image that was packed.
#[derive(Debug, Clone, Copy)]
pub(super) struct StoredImage {
    /// The image of the scene: the first of those that are equal.
    pub(super) image: ImageId,
    /// Index of the view that holds its bytes.
    pub(super) view: usize,
}

/// The layout of the buffer, and what is where in it.
#[derive(Debug, Default)]
pub(super) struct Packed {
    pub(super) layout: Layout,
    /// The accessors of each primitive of all meshes in order; none of one without triangles, which glTF cannot hold.
    pub(super) primitives: Vec<Range<usize>>,
    /// The box that holds all of them in the rest pose.
    extent: Extent,
    /// The skins with their accessors of inverse bind matrices: those of nodes with bones, and that of the whole model.
    pub(super) skins: Vec<PackedSkin>,
    /// Per track, in the order of the animations, the accessors of its times and of its values.
    pub(super) tracks: Vec<[usize; 2]>,
    /// The images, equal ones once.
    pub(super) images: Vec<StoredImage>,
    /// Per image of the scene its index in `images`.
    pub(super) image_numbers: TiVec<ImageId, usize>,
}

/// Data of a batch of primitives, a buffer for each of [`Kind::OF_PRIMITIVES`].
#[derive(Default)]
struct Batch {
    data: [Vec<u8>; Kind::OF_PRIMITIVES.len()],
    /// With offsets in `data` and without views, until the batch is written.
    accessors: Vec<Accessor>,
    /// The accessors of each primitive.
    primitives: Vec<Range<usize>>,
    extent: Extent,
}

impl Packed {
    /// Packs all that goes into the buffer.
    ///
    /// # Errors
    /// Those of `out`; [`io::ErrorKind::InvalidInput`] for a surface that breaks its own rules.
    pub(super) fn new<'a>(scene: &Scene, memo: &Memo, out: &'a mut Sink<'a>) -> io::Result<Self> {
        let mut out = BufferWriter::new(out);
        let (primitives, extent) = write_primitives(scene, memo, &mut out)?;
        let skins = write_skins(scene, &primitives, &mut out)?;
        let tracks = animations::write_keys(scene, &mut out)?;
        let mut packed = Self {
            primitives,
            extent,
            skins,
            tracks,
            ..Self::default()
        };
        packed.write_images(&scene.images, &mut out)?;
        packed.layout = out.layout;
        Ok(packed)
    }

    /// How much was written.
    pub(super) fn written(&self) -> Written {
        let mut written = Written {
            bytes: self.layout.length,
            size: self.extent.size(),
            ..Written::default()
        };
        let accessors = self.primitives.iter().cloned();
        for accessor in accessors.flat_map(|range| &self.layout.accessors[range]) {
            match accessor.kind {
                Kind::Positions => written.vertices += accessor.count,
                Kind::IndicesU8 | Kind::IndicesU16 | Kind::IndicesU32 => {
                    written.triangles += accessor.count / 3;
                }
                _ => {}
            }
        }
        written
    }

    /// Writes the images behind the surfaces, equal ones once.
    fn write_images(
        &mut self,
        images: &TiSlice<ImageId, Image>,
        out: &mut BufferWriter<'_>,
    ) -> io::Result<()> {
        let mut known: FxHashMap<(MediaType, &[u8]), usize> = FxHashMap::default();
        for (id, image) in images.iter_enumerated() {
            let next = self.images.len();
            let number = *known
                .entry((image.media_type, &image.bytes))
                .or_insert(next);
            self.image_numbers.push(number);
            if number < next {
                continue;
            }
            let view = out.view(None);
            self.images.push(StoredImage { image: id, view });
            out.write(&image.bytes)?;
            out.pad()?;
        }
        Ok(())
    }
}

/// Writes every primitive, and returns the accessors of each, and the box that holds all.
fn write_primitives(
    scene: &Scene,
    memo: &Memo,
    out: &mut BufferWriter<'_>,
) -> io::Result<(Vec<Range<usize>>, Extent)> {
    let placed = Placed::of(scene);
    let mut ranges = Vec::with_capacity(placed.primitives.len());
    let mut extent = Extent::default();
    let make = |window: &[(&Primitive, MeshId)], batches: &mut Vec<Batch>| -> io::Result<()> {
        batches.resize_with(window.len().div_ceil(BATCH), Batch::default);
        let batches = batches.par_iter_mut().zip(window.par_chunks(BATCH));
        batches.try_for_each(|(batch, window)| batch.fill(window, &placed, scene, memo))
    };
    let mut windows = placed.primitives.chunks(WINDOW);
    // Two sets of buffers take turns, so that no memory is allocated after the second window.
    let (mut full, mut next) = (Vec::new(), Vec::new());
    make(windows.next().unwrap_or(&[]), &mut full)?;
    while !full.is_empty() {
        let extents = full.iter().map(|batch| batch.extent);
        extent = extents.fold(extent, Extent::join);
        let window = windows.next().unwrap_or(&[]);
        let (written, made) = rayon::join(
            || write_window(&mut full, &mut ranges, out),
            || make(window, &mut next),
        );
        written?;
        made?;
        std::mem::swap(&mut full, &mut next);
    }
    Ok((ranges, extent))
}

/// Writes a window kind by kind, and adds the accessors of its primitives.
fn write_window(
    window: &mut [Batch],
    ranges: &mut Vec<Range<usize>>,
    out: &mut BufferWriter<'_>,
) -> io::Result<()> {
    let mut views = [0; Kind::OF_PRIMITIVES.len()];
    for kind in Kind::OF_PRIMITIVES {
        let slot = kind as usize;
        if window.iter().all(|batch| batch.data[slot].is_empty()) {
            continue;
        }
        views[slot] = out.view(Some(kind));
        for batch in window.iter() {
            out.write(&batch.data[slot])?;
        }
    }
    out.pad()?;

    let mut before = [0_u64; Kind::OF_PRIMITIVES.len()];
    for batch in window.iter_mut() {
        let accessors = &mut out.layout.accessors;
        let first = accessors.len();
        accessors.extend(batch.accessors.iter().map(|accessor| Accessor {
            view: views[accessor.kind as usize],
            offset: before[accessor.kind as usize] + accessor.offset,
            ..*accessor
        }));
        let shifted = |range: &Range<usize>| first + range.start..first + range.end;
        ranges.extend(batch.primitives.iter().map(shifted));
        for (before, data) in before.iter_mut().zip(&batch.data) {
            *before += data.len() as u64;
        }
    }
    Ok(())
}

/// A skin, and the mesh that it moves.
#[derive(Debug)]
pub(super) struct PackedSkin {
    pub(super) joints: Vec<NodeId>,
    pub(super) mesh: MeshId,
    /// The node whose mesh it is; `None` for that of the whole model.
    pub(super) node: Option<NodeId>,
    /// The accessor of the inverse bind matrices.
    pub(super) bind_matrices: usize,
}

/// Writes the inverse bind matrices of all skins whose meshes have triangles, one a joint, column by column. The corners of a mesh are
/// in the frame of the node that has it.
fn write_skins(
    scene: &Scene,
    primitives: &[Range<usize>],
    out: &mut BufferWriter<'_>,
) -> io::Result<Vec<PackedSkin>> {
    let mut starts: TiVec<MeshId, usize> = TiVec::with_capacity(scene.meshes.len());
    let mut next = 0;
    for mesh in &scene.meshes {
        starts.push(next);
        next += mesh.primitives.len();
    }
    let is_empty = |mesh: MeshId| {
        let of_mesh = &primitives[starts[mesh]..][..scene.meshes[mesh].primitives.len()];
        of_mesh.iter().all(Range::is_empty)
    };
    let bent = scene.nodes.iter_enumerated().filter_map(|(id, node)| {
        let mesh = node.mesh.filter(|_| !node.bones.is_empty())?;
        Some((id, mesh, &node.bones))
    });
    let bent: Vec<_> = bent.filter(|(_, mesh, _)| !is_empty(*mesh)).collect();
    let to_world = if bent.is_empty() {
        TiVec::new()
    } else {
        scene.rest()
    };
    let mut skins = Vec::new();
    for (id, mesh, bones) in bent {
        let joints: Vec<NodeId> = std::iter::once(id).chain(bones.iter().copied()).collect();
        let own = to_world[id];
        let matrices: Vec<[f32; 16]> = joints
            .iter()
            .map(|joint| matrix(&to_world[*joint].inverse().after(&own)))
            .collect();
        skins.push(PackedSkin {
            joints,
            mesh,
            node: Some(id),
            bind_matrices: write_matrices(&matrices, out)?,
        });
    }
    if let Some(Skin { mesh, joints, rest }) =
        scene.skin.as_ref().filter(|skin| !is_empty(skin.mesh))
    {
        let matrices: Vec<[f32; 16]> = rest.iter().map(|pose| matrix(&pose.inverse())).collect();
        skins.push(PackedSkin {
            joints: joints.clone(),
            mesh: *mesh,
            node: None,
            bind_matrices: write_matrices(&matrices, out)?,
        });
    }
    Ok(skins)
}

fn matrix(transform: &RigidTransform) -> [f32; 16] {
    let matrix = DMat4::from_rotation_translation(transform.rotation, transform.translation);
    matrix.as_mat4().to_cols_array()
}

/// Writes matrices, and returns their accessor.
fn write_matrices(matrices: &[[f32; 16]], out: &mut BufferWriter<'_>) -> io::Result<usize> {
    let accessor = out.accessor(Kind::InverseBindMatrices, matrices.len(), None);
    out.write_floats(matrices)?;
    Ok(accessor)
}

impl Batch {
    fn fill(
        &mut self,
        primitives: &[(&Primitive, MeshId)],
        placed: &Placed<'_>,
        scene: &Scene,
        memo: &Memo,
    ) -> io::Result<()> {
        self.data.iter_mut().for_each(Vec::clear);
        self.accessors.clear();
        self.primitives.clear();
        self.extent = Extent::default();
        for (primitive, mesh) in primitives {
            let Some(material) = scene.materials.get(primitive.material) else {
                return Err(invalid("a primitive with a material out of range"));
            };
            let first = self.accessors.len();
            with_surface(primitive, memo, |surface| {
                let unmapped = surface.uvs.is_empty() && !surface.positions.is_empty();
                if unmapped && material.textures().next().is_some() {
                    return Err(invalid("a textured surface without texture coordinates"));
                }
                if surface.triangles.is_empty() {
                    Ok(())
                } else {
                    self.push(surface, placed.poses(*mesh), placed.joints(*mesh))
                }
            })?;
            self.primitives.push(first..self.accessors.len());
        }
        Ok(())
    }

    /// Packs a surface with triangles, which is at `poses`; `joints` is the number of joints that can move it.
    fn push(
        &mut self,
        surface: &Surface,
        poses: &[RigidTransform],
        joints: usize,
    ) -> io::Result<()> {
        let bounds = check::surface(surface, joints)?;
        for pose in poses {
            self.extent.add(&surface.positions, bounds, pose);
        }
        let vertices = surface.positions.len();
        let positions = self.accessor(Kind::Positions, vertices, Some(bounds));
        floats(positions, &surface.positions);
        if !surface.normals.is_empty() {
            let normals = self.accessor(Kind::Normals, vertices, None);
            floats(normals, &surface.normals);
        }
        for target in &surface.targets {
            let bounds = check::bounds(target);
            let displacements = self.accessor(Kind::Displacements, vertices, bounds);
            floats(displacements, target);
        }
        if !surface.uvs.is_empty() {
            let tex_coords = self.accessor(Kind::TexCoords, vertices, None);
            floats(tex_coords, &surface.uvs);
        }
        // The smallest type for so many vertices. A type's greatest value is not an index: it restarts primitives.
        let indices = surface.triangles.as_flattened();
        match vertices {
            0..=0xFF => {
                let out = self.accessor(Kind::IndicesU8, indices.len(), None);
                out.extend(indices.iter().map(|index| *index as u8));
            }
            0x100..=0xFFFF => {
                let out = self.accessor(Kind::IndicesU16, indices.len(), None);
                append(out, indices, |index| (index as u16).to_le_bytes());
            }
            _ => {
                let out = self.accessor(Kind::IndicesU32, indices.len(), None);
                append(out, indices, u32::to_le_bytes);
            }
        }
        if !surface.influences.is_empty() {
            let influences = surface.influences.iter().map(Influence::quantized);
            if joints <= 0x100 {
                let out = self.accessor(Kind::JointsU8, vertices, None);
                let numbers = influences.clone();
                out.extend(numbers.flat_map(|own| own.map(|(joint, _)| joint as u8)));
            } else {
                let out = self.accessor(Kind::JointsU16, vertices, None);
                let numbers = influences.clone();
                out.extend(numbers.flat_map(|own| {
                    let [[a, b], [c, d], [e, f], [g, h]] =
                        own.map(|(joint, _)| joint.to_le_bytes());
                    [a, b, c, d, e, f, g, h]
                }));
            }
            let weights = self.accessor(Kind::Weights, vertices, None);
            weights.extend(influences.flat_map(|own| own.map(|(_, weight)| weight)));
        }
        Ok(())
    }

    /// Adds an accessor, and returns the buffer for its elements.
    fn accessor(
        &mut self,
        kind: Kind,
        count: usize,
        bounds: Option<[[f32; 3]; 2]>,
    ) -> &mut Vec<u8> {
        let data = &mut self.data[kind as usize];
        self.accessors.push(Accessor {
            kind,
            view: 0,
            offset: data.len() as u64,
            count,
            bounds,
        });
        data
    }
}

/// Appends the bytes of each index.
fn append<const N: usize>(out: &mut Vec<u8>, indices: &[u32], bytes: impl Fn(u32) -> [u8; N]) {
    let start = out.len();
    out.resize(start + N * indices.len(), 0);
    let (places, _) = out[start..].as_chunks_mut::<N>();
    for (place, index) in places.iter_mut().zip(indices) {
        *place = bytes(*index);
    }
}

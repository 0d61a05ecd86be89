//! The binary data: surfaces made, packed little-endian and handed on, a window of primitives at a time.
//!
//! A model of a hundred thousand parts is never in memory as a whole: while one window is written, the next
//! one is made, on all cores. A window's data lies together, a buffer view for each kind in it; the size of
//! windows is fixed, so that the bytes do not depend on the machine.

use std::io;

use glam::DMat4;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::animations::{self, Keys};
use super::memory::{Memory, Used};
use super::{Again, invalid};
use crate::scene::{Image, MediaType, Mesh, Pose, Primitive, Scene, Surface};

/// Primitives in a window.
pub(super) const WINDOW: usize = 512;
/// Primitives that are packed by one thread at a time.
const BATCH: usize = 32;
/// Kinds of data.
pub(super) const KINDS: usize = 9;

/// A kind of data. The order, widest components first, keeps every accessor aligned without padding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Positions,
    Normals,
    Uvs,
    Joints(JointType),
    Weights,
    Indices(IndexType),
}

impl Kind {
    const ALL: [Self; KINDS] = [
        Self::Positions,
        Self::Normals,
        Self::Uvs,
        Self::Joints(JointType::U16),
        Self::Joints(JointType::U8),
        Self::Weights,
        Self::Indices(IndexType::U32),
        Self::Indices(IndexType::U16),
        Self::Indices(IndexType::U8),
    ];

    fn slot(self) -> usize {
        match self {
            Self::Positions => 0,
            Self::Normals => 1,
            Self::Uvs => 2,
            Self::Joints(JointType::U16) => 3,
            Self::Joints(JointType::U8) => 4,
            Self::Weights => 5,
            Self::Indices(IndexType::U32) => 6,
            Self::Indices(IndexType::U16) => 7,
            Self::Indices(IndexType::U8) => 8,
        }
    }
}

/// The component type of a joint's number; four of them go to a corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum JointType {
    U8,
    U16,
}

impl JointType {
    /// The smaller type that holds the numbers of so many joints.
    fn of(joints: usize) -> Self {
        match joints {
            0..=0x100 => Self::U8,
            _ => Self::U16,
        }
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
    /// The smallest type for so many corners. A type's greatest value is not an index: it restarts primitives.
    fn of(corners: usize) -> Self {
        match corners {
            0..=0xFF => Self::U8,
            0x100..=0xFFFF => Self::U16,
            _ => Self::U32,
        }
    }
}

/// A stretch of the buffer that holds data of one kind.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    /// None for what is no part of a primitive.
    pub(super) kind: Option<Kind>,
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

/// Accessors of a primitive.
pub(super) const RUNS: usize = 6;

/// A primitive that was packed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    /// Its accessors, in the order of the file.
    pub(super) runs: [Option<Run>; RUNS],
    /// Its box: least and greatest corner.
    pub(super) bounds: [[f32; 3]; 2],
}

/// An image that was packed.
#[derive(Debug, Clone, Copy)]
pub(super) struct StoredImage {
    /// Its number in the scene: the first of those that are equal.
    pub(super) image: usize,
    /// Number of the view that holds its bytes.
    pub(super) view: usize,
}

impl Entry {
    /// Its accessors, each with the entry itself.
    pub(super) fn with_runs(&self) -> impl Iterator<Item = (&Self, &Run)> {
        self.runs.iter().flatten().map(move |run| (self, run))
    }
}

/// What was packed, and where it lies.
#[derive(Debug, Default)]
pub(super) struct Packed {
    /// The views, in the order of the buffer.
    pub(super) views: Vec<View>,
    /// The primitives of all meshes in order; none for one without triangles, which glTF cannot hold.
    pub(super) entries: Vec<Option<Entry>>,
    /// Number of the view of the skin's inverse bind matrices.
    pub(super) bind_matrices: Option<usize>,
    /// The keys of the animations.
    pub(super) keys: Keys,
    /// The images, equal ones once.
    pub(super) images: Vec<StoredImage>,
    /// Per image of the scene its number in `images`.
    pub(super) image_numbers: Vec<usize>,
    /// The length of the buffer, a multiple of four.
    pub(super) length: u64,
}

impl Packed {
    /// How much was packed.
    pub(super) fn total(&self) -> super::Written {
        let count = |slot: usize| -> usize {
            let runs = self
                .entries
                .iter()
                .flatten()
                .filter_map(|entry| entry.runs[slot]);
            runs.map(|run| run.count).sum()
        };
        super::Written {
            corners: count(0),
            triangles: count(3) / 3,
            bytes: self.length,
        }
    }
}

/// Data of a batch of primitives, a buffer a kind.
#[derive(Default)]
struct Batch {
    data: [Vec<u8>; KINDS],
    entries: Vec<Option<Entry>>,
    used: Used,
}

/// Packs every primitive and hands the bytes to `write` in order.
///
/// # Errors
/// What `write` answers; [`io::ErrorKind::InvalidInput`] for a surface that breaks its own rules.
pub(super) fn pack(
    scene: &Scene,
    again: Again<'_>,
    mut write: impl FnMut(&[u8]) -> io::Result<()> + Send,
) -> io::Result<Packed> {
    let (memory, mut used) = match again {
        Some((memory, used)) => (Some(memory), Some(used)),
        None => (None, None),
    };
    let primitives: Vec<&Primitive> = scene
        .meshes
        .iter()
        .flat_map(|mesh| &mesh.primitives)
        .collect();
    let mut packed = Packed {
        entries: Vec::with_capacity(primitives.len()),
        ..Packed::default()
    };
    let make = |window: &[&Primitive], batches: &mut Vec<Batch>| -> io::Result<()> {
        batches.resize_with(window.len().div_ceil(BATCH), Batch::default);
        let batches = batches.par_iter_mut().zip(window.par_chunks(BATCH));
        batches.try_for_each(|(batch, window)| batch.fill(window, scene, memory))
    };
    let mut windows = primitives.chunks(WINDOW);
    // Two sets of buffers take turns, so that no memory is asked for after the second window.
    let (mut ready, mut next) = (Vec::new(), Vec::new());
    make(windows.next().unwrap_or(&[]), &mut ready)?;
    while !ready.is_empty() {
        if let Some(used) = &mut used {
            ready
                .iter_mut()
                .for_each(|batch| used.append(&mut batch.used));
        }
        let window = windows.next().unwrap_or(&[]);
        let (written, made) = rayon::join(
            || packed.take(&mut ready, &mut write),
            || make(window, &mut next),
        );
        written?;
        made?;
        std::mem::swap(&mut ready, &mut next);
    }
    packed.store_skin(scene, &mut write)?;
    animations::store(scene, &mut packed, &mut write)?;
    packed.store_images(&scene.images, &mut write)?;
    Ok(packed)
}

impl Packed {
    /// Writes a window and notes where its data lies.
    fn take(
        &mut self,
        window: &mut [Batch],
        write: &mut impl FnMut(&[u8]) -> io::Result<()>,
    ) -> io::Result<()> {
        let mut numbers = [0; KINDS];
        for kind in Kind::ALL {
            let slot = kind.slot();
            let length: usize = window.iter().map(|batch| batch.data[slot].len()).sum();
            if length == 0 {
                continue;
            }
            numbers[slot] = self.views.len();
            self.views.push(View {
                kind: Some(kind),
                offset: self.length,
                length: length as u64,
            });
            self.length += length as u64;
            for batch in window.iter() {
                write(&batch.data[slot])?;
            }
        }
        self.pad(write)?;

        let mut before = [0_u64; KINDS];
        for batch in window.iter_mut() {
            for entry in &mut batch.entries {
                for run in entry
                    .iter_mut()
                    .flat_map(|entry| entry.runs.iter_mut().flatten())
                {
                    run.view = numbers[run.kind.slot()];
                    run.offset += before[run.kind.slot()];
                }
            }
            for (before, data) in before.iter_mut().zip(&batch.data) {
                *before += data.len() as u64;
            }
            self.entries.append(&mut batch.entries);
        }
        Ok(())
    }

    /// Goes on to the next multiple of four.
    fn pad(&mut self, write: &mut impl FnMut(&[u8]) -> io::Result<()>) -> io::Result<()> {
        let padding = self.length.next_multiple_of(4) - self.length;
        self.length += padding;
        write(&[0; 3][..padding as usize])
    }

    /// Writes the skin's inverse bind matrices, one a joint, column by column.
    fn store_skin(
        &mut self,
        scene: &Scene,
        write: &mut impl FnMut(&[u8]) -> io::Result<()>,
    ) -> io::Result<()> {
        let Some(skin) = &scene.skin else {
            return Ok(());
        };
        let primitives = |mesh: &Mesh| mesh.primitives.len();
        let first: usize = scene.meshes[..skin.mesh].iter().map(primitives).sum();
        let of_skin = &self.entries[first..][..primitives(&scene.meshes[skin.mesh])];
        if of_skin.iter().all(Option::is_none) {
            return Ok(());
        }
        let matrix = |pose: &Pose| {
            let back = pose.inverse();
            let matrix = DMat4::from_rotation_translation(back.rotation, back.translation);
            matrix.as_mat4().to_cols_array()
        };
        let matrices: Vec<[f32; 16]> = skin.rest.iter().map(matrix).collect();
        let mut bytes = Vec::new();
        floats(&mut bytes, &matrices);
        self.bind_matrices = Some(self.views.len());
        self.views.push(View {
            kind: None,
            offset: self.length,
            length: bytes.len() as u64,
        });
        self.length += bytes.len() as u64;
        write(&bytes)
    }

    /// Writes the images behind the surfaces, equal ones once.
    fn store_images(
        &mut self,
        images: &[Image],
        write: &mut impl FnMut(&[u8]) -> io::Result<()>,
    ) -> io::Result<()> {
        let mut known: FxHashMap<(MediaType, &[u8]), usize> = FxHashMap::default();
        for (index, image) in images.iter().enumerate() {
            let next = self.images.len();
            let number = *known
                .entry((image.media_type, &image.bytes))
                .or_insert(next);
            self.image_numbers.push(number);
            if number < next {
                continue;
            }
            self.images.push(StoredImage {
                image: index,
                view: self.views.len(),
            });
            let length = image.bytes.len() as u64;
            self.views.push(View {
                kind: None,
                offset: self.length,
                length,
            });
            write(&image.bytes)?;
            self.length += length;
            self.pad(write)?;
        }
        Ok(())
    }
}

impl Batch {
    fn fill(
        &mut self,
        primitives: &[&Primitive],
        scene: &Scene,
        memory: Option<&Memory>,
    ) -> io::Result<()> {
        self.data.iter_mut().for_each(Vec::clear);
        self.entries.clear();
        for primitive in primitives {
            let surface = match memory {
                Some(memory) => {
                    primitive.surface_by(&mut |source| self.used.surface(source, memory))
                }
                None => primitive.surface(),
            };
            let Some(material) = scene.materials.get(primitive.material) else {
                return Err(invalid("a primitive with a material out of range"));
            };
            let bare = surface.uvs.is_empty() && !surface.positions.is_empty();
            if bare && material.textures().next().is_some() {
                return Err(invalid("a textured surface without texture coordinates"));
            }
            let entry = match surface.triangles.is_empty() {
                true => None,
                false => Some(self.put(&surface, scene.nodes.len())?),
            };
            self.entries.push(entry);
        }
        Ok(())
    }

    fn put(&mut self, surface: &Surface, joints: usize) -> io::Result<Entry> {
        let bounds = checked_bounds(surface, joints)?;
        let corners = surface.positions.len();
        let index = IndexType::of(corners);
        let run = |batch: &Self, kind: Kind, count: usize| {
            Some(Run {
                kind,
                view: 0,
                offset: batch.data[kind.slot()].len() as u64,
                count,
            })
        };
        let mut runs = [None; RUNS];
        runs[0] = run(self, Kind::Positions, corners);
        floats(&mut self.data[Kind::Positions.slot()], &surface.positions);
        if !surface.normals.is_empty() {
            runs[1] = run(self, Kind::Normals, corners);
            floats(&mut self.data[Kind::Normals.slot()], &surface.normals);
        }
        if !surface.uvs.is_empty() {
            runs[2] = run(self, Kind::Uvs, corners);
            floats(&mut self.data[Kind::Uvs.slot()], &surface.uvs);
        }
        let indices = surface.triangles.as_flattened();
        runs[3] = run(self, Kind::Indices(index), indices.len());
        let out = &mut self.data[Kind::Indices(index).slot()];
        // The type was chosen so that every corner fits.
        match index {
            IndexType::U8 => out.extend(indices.iter().map(|corner| *corner as u8)),
            IndexType::U16 => out.extend(
                indices
                    .iter()
                    .flat_map(|corner| (*corner as u16).to_le_bytes()),
            ),
            IndexType::U32 => out.extend(indices.iter().flat_map(|corner| corner.to_le_bytes())),
        }
        if !surface.joints.is_empty() {
            self.put_joints(surface, joints, &mut runs);
        }
        Ok(Entry { runs, bounds })
    }

    /// Every corner follows one joint with all its weight.
    fn put_joints(&mut self, surface: &Surface, joints: usize, runs: &mut [Option<Run>; RUNS]) {
        let kind = JointType::of(joints);
        let count = surface.joints.len();
        for (slot, kind) in [(4, Kind::Joints(kind)), (5, Kind::Weights)] {
            runs[slot] = Some(Run {
                kind,
                view: 0,
                offset: self.data[kind.slot()].len() as u64,
                count,
            });
        }
        let out = &mut self.data[Kind::Joints(kind).slot()];
        let numbers = surface.joints.iter();
        match kind {
            JointType::U8 => out.extend(numbers.flat_map(|joint| [*joint as u8, 0, 0, 0])),
            JointType::U16 => out.extend(numbers.flat_map(|joint| {
                let [low, high] = joint.to_le_bytes();
                [low, high, 0, 0, 0, 0, 0, 0]
            })),
        }
        let weights = &mut self.data[Kind::Weights.slot()];
        weights.extend(std::iter::repeat_n([u8::MAX, 0, 0, 0], count).flatten());
    }
}

/// Appends numbers as little-endian bytes.
pub(super) fn floats<const N: usize>(out: &mut Vec<u8>, rows: &[[f32; N]]) {
    if cfg!(target_endian = "little") {
        out.extend_from_slice(bytemuck::cast_slice(rows.as_flattened()));
    } else {
        out.extend(
            rows.as_flattened()
                .iter()
                .flat_map(|number| number.to_le_bytes()),
        );
    }
}

/// The box of a surface, which must be sound.
fn checked_bounds(surface: &Surface, joints: usize) -> io::Result<[[f32; 3]; 2]> {
    let corners = surface.positions.len();
    let lengths = [
        surface.normals.len(),
        surface.uvs.len(),
        surface.joints.len(),
    ];
    if !lengths.iter().all(|length| [0, corners].contains(length)) {
        return Err(invalid("a surface whose lists of corners differ in length"));
    }
    let greatest = surface.triangles.as_flattened().iter().max();
    if greatest.is_none_or(|corner| *corner as usize >= corners) || corners > u32::MAX as usize {
        return Err(invalid("a surface with a corner out of range"));
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
        + sum(surface.uvs.as_flattened());
    if !sums.is_finite() {
        return Err(invalid("a surface with a corner that is not a number"));
    }
    let first = [surface.positions[0]; 2];
    Ok(surface.positions.iter().fold(first, |[min, max], p| {
        [
            [0, 1, 2].map(|i| min[i].min(p[i])),
            [0, 1, 2].map(|i| max[i].max(p[i])),
        ]
    }))
}

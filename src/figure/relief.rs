//! Relief (figure.md): where two parts overlap and their front or back faces would lie in one plane, the part that is drawn
//! later stands out by a small step. So the drawing order stays visible.

use std::sync::Arc;

use rayon::prelude::*;

use super::{FigureContext, overlap};
use crate::bind::{Part, PartKind, plate_depth};
use crate::geometry::{BoxTree, Outline, area_around, indexed_box};
use crate::memo::{Bits, Long, Memo, Same};
use crate::solid::Profile;
use crate::threads::GRAIN;

/// The step, as a share of the part's thickness.
const STEP: f64 = 0.01;
/// Limit of the steps by which a face stands out.
const MAX_STEPS: f64 = 20.0;
/// Limit of the overlapping parts below a part: in a higher pile the steps have reached their limit anyway.
const MAX_NEIGHBOURS: usize = 64;
/// Limit of the bounding boxes that are checked to find them.
const MAX_BOXES: usize = 4096;

/// How far the faces of each part stand out, drawing units.
pub(super) struct Relief {
    steps: Arc<[[f64; 2]]>,
}

/// What the steps are computed from: per part its plane faces, and its outline.
#[derive(PartialEq, Eq, Hash)]
struct ReliefKey {
    faces: Long<Option<Faces>>,
    outlines: Long<Same<Outline>>,
}

/// The faces of a part: back and front, where it has them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Faces {
    planes: [Option<Plane>; 2],
    thickness: Bits<f64>,
}

/// Where a face lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Plane {
    /// At a depth, drawing units.
    Depth(Bits<f64>),
    /// On the rounded surface of a part: only other ink is there.
    Ink(usize),
}

impl Relief {
    pub(super) fn measure(context: &FigureContext<'_>, memo: &Memo) -> Self {
        let bindings = context.bindings;
        let depths = node_depths(context);
        let faces: Vec<_> = (0..bindings.parts.len())
            .into_par_iter()
            .with_min_len(GRAIN)
            .map(|part| faces(context, part, &depths))
            .collect();
        let outline = |part: &Part| Same(Arc::clone(&part.outline));
        let key = ReliefKey {
            faces: Long(faces),
            outlines: bindings.parts.iter().map(outline).collect(),
        };
        let steps = memo.get(key, |key| steps(&bindings.parts, &key.faces.0).into());
        Self { steps }
    }

    /// How far ink on a rounded part stands out because of the ink below it, drawing units.
    pub(super) fn step(&self, part: usize) -> f64 {
        self.steps[part][1]
    }

    /// A part's profile with its faces standing out.
    pub(super) fn raised(&self, part: usize, mut profile: Profile) -> Profile {
        profile.raise(self.steps[part]);
        profile
    }
}

/// How far the faces of each part stand out.
fn steps(parts: &[Part], faces: &[Option<Faces>]) -> Vec<[f64; 2]> {
    let boxes = faces.par_iter().enumerate().with_min_len(GRAIN);
    let boxes = boxes.filter_map(|(index, faces)| {
        faces.as_ref()?;
        Some(indexed_box(parts[index].measure.bounds, index))
    });
    let tree = BoxTree::bulk_load(boxes.collect());
    let below: Vec<Vec<usize>> = (0..parts.len())
        .into_par_iter()
        .map(|part| below(parts, part, faces, &tree))
        .collect();
    let mut steps = vec![[0.0_f64; 2]; parts.len()];
    for (part, below) in below.iter().enumerate() {
        let Some(own) = faces[part] else { continue };
        let raised = [0, 1].map(|side| {
            let same =
                |other: &&usize| faces[**other].is_some_and(|other| same_plane(own, other, side));
            let highest = below
                .iter()
                .filter(same)
                .map(|other| steps[*other][side])
                .reduce(f64::max);
            highest.map_or(0.0, |highest| highest + STEP * own.thickness.0)
        });
        let most = MAX_STEPS * STEP * own.thickness.0;
        steps[part] = raised.map(|step| step.min(most));
    }
    steps
}

fn same_plane(a: Faces, b: Faces, side: usize) -> bool {
    match (a.planes[side], b.planes[side]) {
        (Some(Plane::Depth(Bits(one))), Some(Plane::Depth(Bits(other)))) => {
            (one - other).abs() <= 1e-3 * STEP * a.thickness.0.max(b.thickness.0)
        }
        (Some(Plane::Ink(one)), Some(Plane::Ink(other))) => one == other,
        _ => false,
    }
}

/// Per part the depth of the node it belongs to, drawing units.
fn node_depths(context: &FigureContext<'_>) -> Vec<f64> {
    let parts = &context.bindings.parts;
    let mut depths: Vec<Option<f64>> = vec![None; parts.len()];
    for start in 0..parts.len() {
        let mut chain = Vec::new();
        let mut next = Some(parts[start].main);
        while let Some(part) = next.filter(|part| depths[*part].is_none()) {
            chain.push(part);
            next = parts[part].parent;
        }
        let mut depth = next.and_then(|part| depths[part]).unwrap_or(0.0);
        for part in chain.into_iter().rev() {
            depth += context.node_offset(part);
            depths[part] = Some(depth);
        }
    }
    parts
        .iter()
        .map(|part| depths[part.main].unwrap_or(0.0))
        .collect()
}

fn faces(context: &FigureContext<'_>, part: usize, depths: &[f64]) -> Option<Faces> {
    if !matches!(
        context.bindings.parts[part].kind,
        PartKind::Main | PartKind::Sub
    ) {
        return None;
    }
    if context.is_draped(part) {
        // As for plates, the steps are shares of a thickness: here of one that makes each step half of the first one.
        let thickness = 0.5 * context.ink_step(part) / STEP;
        return Some(Faces {
            planes: [None, Some(Plane::Ink(context.bindings.parts[part].host?))],
            thickness: Bits(thickness),
        });
    }
    let (stand, _) = context.stand(context.bindings.parts[part].main, part);
    let depth = depths[part] + stand;
    let faces = context.profile(part)?.faces()?;
    let thickness = faces.thickness;
    Some(Faces {
        planes: faces
            .depths
            .map(|z| z.map(|z| Plane::Depth(Bits(depth + z)))),
        thickness: Bits(thickness.unwrap_or_else(|| 2.0 * plate_depth(context.drawing))),
    })
}

/// The earlier parts that a part overlaps and shares a plane with.
fn below(parts: &[Part], part: usize, faces: &[Option<Faces>], tree: &BoxTree) -> Vec<usize> {
    let Some(own) = faces[part] else {
        return vec![];
    };
    let area = area_around(parts[part].measure.bounds, 0.0);
    let mut found: Vec<usize> = tree
        .locate_in_envelope_intersecting(area)
        .take(MAX_BOXES)
        .map(|other| other.data)
        .filter(|other| *other < part)
        .filter(|other| {
            faces[*other].is_some_and(|other| (0..2).any(|side| same_plane(own, other, side)))
        })
        .collect();
    found.sort_unstable_by_key(|other| std::cmp::Reverse(*other));
    found.truncate(MAX_NEIGHBOURS);
    found.retain(|other| overlap(&parts[part], &parts[*other]));
    found
}

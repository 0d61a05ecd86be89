//! Two height fields over one mesh of an outline, the front and the back of a solid that is lifted.
//!
//! The mesh has the points that the solid by itself would have, the corners of the surfaces below where those lift it, points
//! wherever its border crosses an edge of one, and more where it would still deviate. What deviates even so is made up for by
//! lifting the front.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use rustc_hash::FxHashSet;

use super::LayForm;
use super::ground::{Level, Place, Target};
use crate::geometry::Outline;
use crate::scene::Surface;
use crate::solid::crease::Crease;
use crate::solid::heights::{BothHeights, Heights};
use crate::solid::inflate::{Mesh, Points, mesh, points};
use crate::solid::layers::steps_per_half_turn;
use crate::solid::shade::shade;
use crate::solid::stack::PlacementTransform;
use crate::solid::{Options, Placement};

/// How far the mesh may deviate from the surfaces below it before it is refined, as a share of the step.
const TOLERANCE: f64 = 0.5;
/// The cosine of the steepest slope at which deviations are measured at a right angle.
const STEEP: f64 = 0.4;
/// Triangles whose sides are all shorter than this, in tolerances, are not refined.
const SMALL: f64 = 1.0;
/// Points of the border are no closer than this, in tolerances.
const NEAR: f64 = 0.2;
/// The front is lifted where the surface below would come closer to it than the rest of this share of the step.
const LIFTED: f64 = 0.8;
/// The number of rounds of refinement.
const MAX_ROUNDS: usize = 3;
/// Limit of the growth of a mesh by refinement. It is reached only over surfaces with steps, which no mesh can follow.
const MAX_GROWTH: usize = 3;
/// Limit of the points of a mesh that is refined.
const MAX_POINTS: usize = 1 << 14;
/// The least thickness, relative to depths, that `f32` can distinguish from none.
const MIN_THICKNESS: f64 = 1e-6;
/// Edges of rounded solids that are sharper than this are seen as edges, degrees: it is between the steps of a rounding and
/// the right angle at which walls stand.
const ROUND_CREASE: f64 = 75.0;

/// The front and the back of a solid over one mesh.
pub(super) struct Field {
    mesh: Mesh,
    /// Per point.
    front: Vec<f64>,
    back: Vec<f64>,
    is_open: bool,
    is_round: bool,
    /// Steps of a rounding per half turn.
    steps: u32,
}

impl Field {
    /// The height fields over an outline, in the frame of its node; `None` if nothing lifts the solid.
    pub(super) fn new(outline: &Outline, options: &Options, target: &Target<'_>) -> Option<Self> {
        let steps = steps_per_half_turn(options);
        let tolerance = TOLERANCE * target.lay.step;
        // Skins of plates and lines have no heights of their own.
        let is_round = target.own.is_some() && target.lay.bulge > 0.0;
        let mut all = match is_round {
            true => points(outline, steps),
            false => Points {
                points: Vec::new(),
                edges: Vec::new(),
            },
        };
        if !target.is_lifting(&all.points) {
            return None;
        }
        let rings = match is_round {
            true => rings(&all),
            false => {
                let polygons = outline.polygons.iter();
                polygons.flat_map(|polygon| polygon.rings.clone()).collect()
            }
        };
        let inner = all.points.split_off(all.edges.len());
        let mut all = border(&rings, target, tolerance);
        all.points.extend(inner);
        corners(&rings, target, &mut all.points);
        let in_place = PlacementTransform::new(&Options {
            placement: Placement::default(),
            ..*options
        });
        let mut cover = Cover::new(mesh(&all, &in_place), target);
        let most = MAX_POINTS.min(MAX_GROWTH * all.points.len());
        for _ in 0..MAX_ROUNDS {
            let wanted = cover.deviations(tolerance, most.saturating_sub(all.points.len()));
            if wanted.is_empty() {
                break;
            }
            all.points.extend(wanted);
            cover = Cover::new(mesh(&all, &in_place), target);
        }
        let [front, back] = cover.fields();
        Some(Self {
            mesh: cover.mesh,
            front,
            back,
            is_open: target.lay.form == LayForm::Sheet,
            is_round,
            steps,
        })
    }

    fn place(&self, i: u32, depth: f64) -> DVec3 {
        flat(&self.mesh.points[i as usize]).extend(depth)
    }

    /// The heights of both sides, depths in the drawing.
    pub(super) fn heights(&self) -> BothHeights {
        let over = |depth: &dyn Fn(usize) -> f64| {
            let triangles = self.mesh.triangles.iter();
            let corners =
                triangles.map(|triangle| triangle.map(|i| self.place(i, depth(i as usize))));
            Arc::new(Heights::over(corners))
        };
        BothHeights {
            front: over(&|i| self.front[i]),
            back: over(&|i| -self.back[i]),
        }
    }

    /// The surface in the frame of a node at this depth, with its back and its walls.
    pub(super) fn surface(&self, node_depth: f64, crease: f64) -> Surface {
        let Mesh {
            points, triangles, ..
        } = &self.mesh;
        let count = points.len();
        let edges: FxHashSet<[u32; 2]> = triangles.iter().flat_map(sides).collect();
        let border = triangles.iter().flat_map(sides);
        let border: Vec<[u32; 2]> = border.filter(|[a, b]| !edges.contains(&[*b, *a])).collect();
        // Where several parts of the border meet in a point, front and back meet too, or four walls would share an edge.
        let mut walls_from = vec![0_u32; count];
        for [from, _] in &border {
            walls_from[*from as usize] += 1;
        }
        let deepest = self.front.iter().chain(&self.back);
        let deepest = deepest.fold(0.0_f64, |most, z| most.max((z - node_depth).abs()));
        let least = (MIN_THICKNESS * deepest).max(f64::from(f32::MIN_POSITIVE));
        let mut positions = Vec::with_capacity(2 * count);
        let write = |i: usize, depth: f64| {
            let [x, y] = points[i];
            [x, y, (depth - node_depth) as f32]
        };
        positions.extend((0..count).map(|i| write(i, self.front[i])));
        let mut written = triangles.clone();
        if !self.is_open {
            let mut back: Vec<u32> = (0..count as u32).collect();
            for i in 0..count {
                let thickness = self.front[i] - self.back[i];
                let meets = walls_from[i] > 1 || (walls_from[i] == 1 && thickness <= least);
                if !meets {
                    back[i] = positions.len() as u32;
                    positions.push(write(i, self.front[i] - thickness.max(least)));
                }
            }
            let behind = triangles.iter().map(|triangle| {
                let [a, b, c] = triangle.map(|i| back[i as usize]);
                [a, c, b]
            });
            written.extend(behind);
            for [a, b] in border {
                let (behind_a, behind_b) = (back[a as usize], back[b as usize]);
                if behind_a != a {
                    written.push([b, a, behind_a]);
                }
                if behind_b != b {
                    written.push([b, behind_a, behind_b]);
                }
            }
        }
        let is_smooth = self.is_round && crease > 180.0 / f64::from(self.steps);
        let crease = if is_smooth {
            crease.max(ROUND_CREASE)
        } else {
            crease
        };
        shade(&positions, &written, Crease::new(crease), |_| false)
    }
}

/// The border of sampled points, ring by ring.
fn rings(points: &Points) -> Vec<Vec<DVec2>> {
    let mut rings = Vec::new();
    let mut ring = Vec::new();
    for [from, to] in &points.edges {
        ring.push(points.points[*from]);
        // The last edge of a ring leads back to its first point.
        if to <= from {
            rings.push(std::mem::take(&mut ring));
        }
    }
    rings
}

/// The border with points where it crosses the edges of triangles below and the front bends there by more than the tolerance.
fn border(rings: &[Vec<DVec2>], target: &Target<'_>, tolerance: f64) -> Points {
    // Closer points would bend the border only where it is too steep to be seen.
    let apart = NEAR * tolerance;
    let mut points = Points {
        points: Vec::new(),
        edges: Vec::new(),
    };
    let mut crossings = Vec::new();
    for ring in rings {
        let start = points.points.len();
        for (index, from) in ring.iter().enumerate() {
            points.points.push(*from);
            let to = ring[(index + 1) % ring.len()];
            crossings.clear();
            if points.points.len() < MAX_POINTS {
                for place in &target.ground.below {
                    place.crossings(*from, to, &mut crossings);
                }
            }
            if crossings.is_empty() {
                continue;
            }
            crossings.sort_unstable_by(f64::total_cmp);
            let length = from.distance(to);
            let profile = std::iter::once(0.0)
                .chain(crossings.iter().copied())
                .chain([1.0]);
            let at = |share: f64| (share, target.at(from.lerp(to, share)).front);
            let mut profile: Vec<(f64, f64)> = profile.map(at).collect();
            profile.dedup_by(|next, last| (next.0 - last.0) * length < apart && next.0 < 1.0);
            keep_bends(&profile, tolerance, &mut |share| {
                points.points.push(from.lerp(to, share));
            });
        }
        let end = points.points.len();
        let next = |i: usize| if i + 1 == end { start } else { i + 1 };
        points.edges.extend((start..end).map(|i| [i, next(i)]));
    }
    points
}

/// Calls `keep` with the places between the first and the last at which a profile of heights bends by more than the tolerance
/// (Douglas & Peucker 1973), in their order.
fn keep_bends(profile: &[(f64, f64)], tolerance: f64, keep: &mut impl FnMut(f64)) {
    let (Some(&(from, low)), Some(&(to, high))) = (profile.first(), profile.last()) else {
        return;
    };
    let deviation = |(share, height): &(f64, f64)| {
        let straight = low + (high - low) * (share - from) / (to - from);
        (height - straight).abs()
    };
    let places = 1..profile.len().saturating_sub(1);
    let worst = places.max_by(|a, b| deviation(&profile[*a]).total_cmp(&deviation(&profile[*b])));
    if let Some(worst) = worst.filter(|worst| deviation(&profile[*worst]) > tolerance) {
        keep_bends(&profile[..=worst], tolerance, keep);
        keep(profile[worst].0);
        keep_bends(&profile[worst..], tolerance, keep);
    }
}

/// Adds the corners of the triangles below an outline that lift it, or behind which it is. Those that are not in the outline have
/// no triangles in its mesh.
fn corners(rings: &[Vec<DVec2>], target: &Target<'_>, points: &mut Vec<DVec2>) {
    let all = || rings.iter().flatten().copied();
    let (Some(low), Some(high)) = (all().reduce(DVec2::min), all().reduce(DVec2::max)) else {
        return;
    };
    let mut known: FxHashSet<[u64; 2]> = FxHashSet::default();
    let ground = target.ground;
    let is_volume = target.lay.form == LayForm::Volume;
    let mut add = |corner: DVec2, is_wanted: &dyn Fn(DVec2) -> bool| {
        if points.len() < MAX_POINTS
            && known.insert(corner.to_array().map(f64::to_bits))
            && is_wanted(corner)
        {
            points.push(corner);
        }
    };
    for place in &ground.below {
        let lifts = |corner: DVec2| !is_volume || target.lifts(corner);
        place.corners([low, high], Place::front_heights, |corner| {
            add(corner, &lifts)
        });
    }
    for place in ground.wraps.iter().chain(&ground.behind) {
        place.corners([low, high], Place::back_heights, |corner| {
            add(corner, &|_| true)
        });
    }
}

/// A mesh with the levels of the target.
struct Cover {
    mesh: Mesh,
    /// Per point.
    levels: Vec<Level>,
    /// In the order of the triangles, the middle of each first.
    samples: Vec<Sample>,
    step: f64,
    is_volume: bool,
}

/// A point of a triangle, and how far the target deviates there.
struct Sample {
    triangle: usize,
    at: DVec2,
    /// How far the surface below is above the triangle's front.
    below: f64,
    /// The cosine of the triangle's slope, but at least [`STEEP`].
    slope: f64,
    /// How far the triangle is from where it should be, at a right angle; in very steep places more than that, or a border that
    /// is lifted by it would be ragged as seen from the side.
    apart: f64,
}

/// The points of a triangle at which it is compared with the target: its middle, those of its sides, and points near its
/// corners, as shares of the corners.
const PLACES: [[f64; 3]; 7] = [
    [1.0 / 3.0; 3],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.5],
    [0.5, 0.0, 0.5],
    [0.7, 0.15, 0.15],
    [0.15, 0.7, 0.15],
    [0.15, 0.15, 0.7],
];

impl Cover {
    fn new(mesh: Mesh, target: &Target<'_>) -> Self {
        let levels: Vec<Level> = mesh
            .points
            .iter()
            .map(|point| target.at(flat(point)))
            .collect();
        let is_volume = target.lay.form == LayForm::Volume;
        let mut samples = Vec::new();
        for (triangle, corners) in mesh.triangles.iter().enumerate() {
            // Where nothing below lifts it the solid by itself is fine enough.
            let own = corners.map(|i| levels[i as usize]);
            if own.iter().all(|level| level.below.is_none()) && is_volume {
                continue;
            }
            let corners =
                corners.map(|i| flat(&mesh.points[i as usize]).extend(levels[i as usize].front));
            let [a, b, c] = corners;
            let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
            let slope = normal.z.max(STEEP);
            for [share_a, share_b, share_c] in PLACES {
                let own = a * share_a + b * share_b + c * share_c;
                let point = own.truncate();
                let (below, apart) = if is_volume {
                    let below = target.below(point);
                    let below = below.map_or(f64::NEG_INFINITY, |below| below - own.z);
                    // A volume may stand out more than it has to.
                    (below, (below + target.lay.step).max(0.0))
                } else {
                    match target.lifted(point, || target.front_reach(point)) {
                        Some([below, lifted]) => (below - own.z, (lifted - own.z).abs()),
                        None => (f64::NEG_INFINITY, (target.at(point).front - own.z).abs()),
                    }
                };
                samples.push(Sample {
                    triangle,
                    at: own.truncate(),
                    below,
                    slope,
                    apart: apart * slope,
                });
            }
        }
        Self {
            mesh,
            levels,
            samples,
            step: target.lay.step,
            is_volume,
        }
    }

    /// Where triangles are farther from the target than the tolerance: of each the worst place, moved inward from its sides; of
    /// too many the worst.
    fn deviations(&self, tolerance: f64, most: usize) -> Vec<DVec2> {
        let of_triangles = self.samples.chunk_by(|a, b| a.triangle == b.triangle);
        let worst = of_triangles.filter_map(|samples| {
            let worst = samples.iter().max_by(|a, b| a.apart.total_cmp(&b.apart))?;
            let at =
                self.mesh.triangles[worst.triangle].map(|i| flat(&self.mesh.points[i as usize]));
            let is_large = (0..3).any(|i| at[i].distance(at[(i + 1) % 3]) > SMALL * tolerance);
            let place = worst.at.lerp(samples[0].at, 0.2);
            (is_large && worst.apart > tolerance).then_some((worst.apart, place))
        });
        let mut worst: Vec<(f64, DVec2)> = worst.collect();
        worst.sort_by(|a, b| b.0.total_cmp(&a.0));
        worst.truncate(most);
        worst.into_iter().map(|(_, place)| place).collect()
    }

    /// The depths of the front and of the back at each point.
    fn fields(&self) -> [Vec<f64>; 2] {
        let mut more = vec![0.0_f64; self.levels.len()];
        for sample in &self.samples {
            // On slopes the front is as far from the surface below as elsewhere.
            let step = self.step / sample.slope;
            let missing = sample.below + (1.0 - LIFTED) * step;
            let least = if self.is_volume {
                0.0
            } else {
                step - self.step
            };
            for i in self.mesh.triangles[sample.triangle] {
                let most = &mut more[i as usize];
                *most = most.max(missing).max(least);
            }
        }
        let front = self.levels.iter().zip(&more);
        let front = front.map(|(level, more)| level.front + more);
        [
            front.collect(),
            self.levels.iter().map(|level| level.back).collect(),
        ]
    }
}

fn flat(place: &[f32; 2]) -> DVec2 {
    let [x, y] = place.map(f64::from);
    DVec2::new(x, y)
}

fn sides([a, b, c]: &[u32; 3]) -> [[u32; 2]; 3] {
    [[*a, *b], [*b, *c], [*c, *a]]
}

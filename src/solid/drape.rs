//! A skin on the surfaces of other solids: ink on rounded parts (layers.md, Ink).
//!
//! The skin covers its outline exactly as seen from the front. Its front is a little above the surfaces below it, its back a
//! little under them, so that it is closed and nothing of it is swallowed. Its mesh has the corners of the triangles below it,
//! points wherever its border crosses an edge of one, and more where it would still deviate; what deviates even so is made up
//! for by lifting the front.

use std::any::Any;
use std::hash::Hasher;
use std::sync::Arc;

use glam::{DAffine2, DVec2, DVec3};
use rustc_hash::{FxHashSet, FxHasher};

use super::crease::Crease;
use super::heights::{Heights, RecentHeights};
use super::inflate::{Mesh, Points, mesh};
use super::shade::shade;
use super::source::on_sides;
use super::stack::PlacementTransform;
use super::{Options, Placement, Sides, Solid};
use crate::geometry::Outline;
use crate::scene::{Surface, SurfaceSource};

/// How far the mesh may deviate from the surfaces below it before it is refined, as a share of the height of the front.
const TOLERANCE: f64 = 0.5;
/// The cosine of the steepest slope at which deviations are measured at a right angle.
const STEEP: f64 = 0.4;
/// Triangles whose sides are all shorter than this, in tolerances, are not refined.
const SMALL: f64 = 1.0;
/// Points of the border are no closer than this, in tolerances.
const NEAR: f64 = 0.2;
/// The front is lifted where the surface below would come closer to it than the rest of this share of its height.
const LIFTED: f64 = 0.8;
/// The number of rounds of refinement.
const MAX_ROUNDS: usize = 3;
/// Limit of the growth of a mesh by refinement. It is reached only over surfaces with steps, which no mesh can follow.
const MAX_GROWTH: usize = 3;
/// Limit of the points of a mesh that is refined.
const MAX_POINTS: usize = 1 << 14;
/// The least thickness, relative to depths, that `f32` can distinguish from none.
const MIN_THICKNESS: f64 = 1e-6;

/// Everything that the surface of a skin depends on. Lengths are in model units.
#[derive(Debug, Clone)]
pub struct Drape {
    /// Its outline as drawn, y down.
    pub outline: Arc<Outline>,
    /// From there to the final positions as seen from the front, y up.
    pub to_model: DAffine2,
    /// The solids that it lies on, in their final positions. Beside all of them it is as far in front as the nearest border of
    /// the first.
    pub below: Vec<Arc<Solid>>,
    /// How far its back is under their surfaces, and how far its front is above.
    pub reach: [f64; 2],
    /// Edges with a smaller angle between their faces are smooth, degrees.
    pub crease: f64,
    /// The sides of the drawing plane that it is on.
    pub sides: Sides,
    /// From the drawing to texture coordinates, if it is textured.
    pub texture: Option<DAffine2>,
    /// The heights that the skins of a scene share.
    pub recent: Arc<RecentHeights>,
}

impl SurfaceSource for Drape {
    fn surface(&self) -> Surface {
        let place = |point: &DVec2| self.to_model.transform_point2(*point);
        let outline = self
            .outline
            .map_rings(|ring| ring.iter().map(place).collect());
        let below = |heights: &[&Heights]| skin(&outline, heights, self.reach, self.crease);
        let mut surface = self.recent.with(&self.below, below);
        if let Some(texture) = self.texture {
            let map = texture * self.to_model.inverse();
            let uv = |[x, y, _]: &[f32; 3]| {
                let point = map.transform_point2(DVec2::new(f64::from(*x), f64::from(*y)));
                point.as_vec2().to_array()
            };
            surface.uvs = surface.positions.iter().map(uv).collect();
        }
        on_sides(surface, self.sides)
    }

    fn mirrored(&self) -> Arc<dyn SurfaceSource> {
        Arc::new(Self {
            sides: self.sides.mirrored(),
            ..self.clone()
        })
    }

    fn key(&self) -> u64 {
        let mut hasher = FxHasher::default();
        for solid in &self.below {
            hasher.write_u64(solid.key());
        }
        let mut number = |number: f64| hasher.write_u64(number.to_bits());
        let polygons = self.outline.polygons.iter();
        for ring in polygons.flat_map(|polygon| &polygon.rings) {
            number(ring.len() as f64);
            ring.iter().flat_map(DVec2::to_array).for_each(&mut number);
        }
        let transforms = [self.to_model].into_iter().chain(self.texture);
        let numbers = transforms.flat_map(|transform| transform.to_cols_array());
        numbers.for_each(&mut number);
        self.reach.into_iter().for_each(&mut number);
        number(self.crease);
        hasher.finish()
    }

    fn is_equal(&self, other: &dyn SurfaceSource) -> bool {
        let Some(other) = (other as &dyn Any).downcast_ref::<Self>() else {
            return false;
        };
        self.outline == other.outline
            && self.to_model == other.to_model
            && self.below == other.below
            && self.reach == other.reach
            && self.crease == other.crease
            && self.sides == other.sides
            && self.texture == other.texture
    }
}

/// The skin over an outline in its final place.
fn skin(outline: &Outline, below: &[&Heights], reach: [f64; 2], crease: f64) -> Surface {
    let ground = Ground(below);
    let tolerance = TOLERANCE * reach[1];
    let mut points = border(outline, &ground, tolerance);
    corners(outline, &ground, &mut points.points);
    let in_place = PlacementTransform::new(&Options {
        segments: 1,
        crease,
        placement: Placement::default(),
    });
    let mut cover = Cover::new(mesh(&points, &in_place), &ground);
    let most = MAX_POINTS.min(MAX_GROWTH * points.points.len());
    for _ in 0..MAX_ROUNDS {
        let wanted = cover.deviations(tolerance, most.saturating_sub(points.points.len()));
        if wanted.is_empty() {
            break;
        }
        points.points.extend(wanted);
        cover = Cover::new(mesh(&points, &in_place), &ground);
    }
    cover.closed(reach, crease)
}

/// The surfaces below a skin.
struct Ground<'a>(&'a [&'a Heights]);

impl Ground<'_> {
    fn height(&self, point: DVec2) -> f64 {
        let highest = self.0.iter().filter_map(|heights| heights.at(point));
        let highest = highest.reduce(f64::max);
        let beside = || self.0.first().and_then(|heights| heights.nearest(point));
        highest.or_else(beside).unwrap_or(0.0)
    }
}

/// The border with points where it crosses the edges of triangles below and the surface bends there by more than the tolerance.
fn border(outline: &Outline, ground: &Ground<'_>, tolerance: f64) -> Points {
    // Closer points would bend the border only where it is too steep to be seen.
    let apart = NEAR * tolerance;
    let mut points = Points {
        points: Vec::new(),
        edges: Vec::new(),
    };
    let mut crossings = Vec::new();
    for ring in outline.polygons.iter().flat_map(|polygon| &polygon.rings) {
        let start = points.points.len();
        for (index, from) in ring.iter().enumerate() {
            points.points.push(*from);
            let to = ring[(index + 1) % ring.len()];
            crossings.clear();
            if points.points.len() < MAX_POINTS {
                for heights in ground.0 {
                    heights.crossings(*from, to, &mut crossings);
                }
            }
            crossings.sort_unstable_by(f64::total_cmp);
            let length = from.distance(to);
            let profile = std::iter::once(0.0)
                .chain(crossings.iter().copied())
                .chain([1.0]);
            let at = |share: f64| (share, ground.height(from.lerp(to, share)));
            let mut profile: Vec<(f64, f64)> = profile.map(at).collect();
            profile.dedup_by(|next, last| (next.0 - last.0) * length < apart && next.0 < 1.0);
            keep_bends(&profile, tolerance, &mut |share| {
                points.points.push(from.lerp(to, share))
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

/// Adds the corners of the triangles below the bounding boxes of an outline's polygons. Those that are not in the outline have no
/// triangles in its mesh.
fn corners(outline: &Outline, ground: &Ground<'_>, points: &mut Vec<DVec2>) {
    let mut known: FxHashSet<[u64; 2]> = FxHashSet::default();
    for border in outline
        .polygons
        .iter()
        .filter_map(|polygon| polygon.rings.first())
    {
        let low = border.iter().copied().reduce(DVec2::min);
        let high = border.iter().copied().reduce(DVec2::max);
        let (Some(low), Some(high)) = (low, high) else {
            continue;
        };
        for heights in ground.0 {
            for corner in heights.corners(low, high) {
                if points.len() < MAX_POINTS && known.insert(corner.to_array().map(f64::to_bits)) {
                    points.push(corner);
                }
            }
        }
    }
}

/// A mesh with the heights of what is below it.
struct Cover {
    mesh: Mesh,
    /// Per point.
    heights: Vec<f64>,
    /// In the order of the triangles, the middle of each first.
    samples: Vec<Sample>,
}

/// A point of a triangle, and how far the surface below deviates there.
struct Sample {
    triangle: usize,
    at: DVec2,
    /// How far the surface is above the triangle.
    above: f64,
    /// The cosine of the triangle's slope, but at least [`STEEP`].
    slope: f64,
    /// How far it is from the triangle, at a right angle; in very steep places more than that, or a border that is lifted by it
    /// would be ragged as seen from the side.
    apart: f64,
}

/// The points of a triangle at which it is compared with the surface below: its middle, those of its sides, and points near its
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
    fn new(mesh: Mesh, ground: &Ground<'_>) -> Self {
        let heights = mesh.points.iter().map(|point| ground.height(flat(point)));
        let heights: Vec<f64> = heights.collect();
        let triangles = mesh.triangles.iter().enumerate();
        let samples = triangles.flat_map(|(triangle, corners)| {
            let corners =
                corners.map(|i| flat(&mesh.points[i as usize]).extend(heights[i as usize]));
            let [a, b, c] = corners;
            let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
            let slope = normal.z.max(STEEP);
            PLACES.map(|[share_a, share_b, share_c]| {
                let own = a * share_a + b * share_b + c * share_c;
                let above = ground.height(own.truncate()) - own.z;
                Sample {
                    triangle,
                    at: own.truncate(),
                    above,
                    slope,
                    apart: above.abs() * slope,
                }
            })
        });
        Self {
            samples: samples.collect(),
            heights,
            mesh,
        }
    }

    /// Where triangles are farther from the surface below than the tolerance: of each the worst place, moved inward from its sides;
    /// of too many the worst.
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

    /// The surface with its back and its walls.
    fn closed(&self, [down, up]: [f64; 2], crease: f64) -> Surface {
        let count = self.mesh.points.len();
        let heights = self.heights.iter();
        let least = MIN_THICKNESS * heights.fold(0.0_f64, |most, z| most.max(z.abs()));
        let (down, up) = (down.max(least), up.max(least));
        let mut fronts = vec![up; count];
        for sample in &self.samples {
            // On slopes the front is as far from the surface as elsewhere.
            let front = up / sample.slope;
            let lifted = sample.above + (1.0 - LIFTED) * front;
            for i in self.mesh.triangles[sample.triangle] {
                let most = &mut fronts[i as usize];
                *most = most.max(front).max(lifted);
            }
        }

        let edges: FxHashSet<[u32; 2]> = self.mesh.triangles.iter().flat_map(sides).collect();
        let border = self.mesh.triangles.iter().flat_map(sides);
        let border: Vec<[u32; 2]> = border.filter(|[a, b]| !edges.contains(&[*b, *a])).collect();
        // Where several parts of the border meet in a point, front and back meet too, or four walls would share an edge.
        let mut walls_from = vec![0_u32; count];
        for [from, _] in &border {
            walls_from[*from as usize] += 1;
        }
        let mut positions = Vec::with_capacity(2 * count);
        for (i, [x, y]) in self.mesh.points.iter().enumerate() {
            let front = self.heights[i] + fronts[i];
            positions.push([*x, *y, front as f32]);
        }
        let mut back: Vec<u32> = (0..count as u32).collect();
        for (i, [x, y]) in self.mesh.points.iter().enumerate() {
            if walls_from[i] < 2 {
                back[i] = positions.len() as u32;
                positions.push([*x, *y, (self.heights[i] - down) as f32]);
            }
        }
        let mut triangles = self.mesh.triangles.clone();
        let behind = self.mesh.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|i| back[i as usize]);
            [a, c, b]
        });
        triangles.extend(behind);
        for [a, b] in border {
            let (behind_a, behind_b) = (back[a as usize], back[b as usize]);
            if behind_a != a {
                triangles.push([b, a, behind_a]);
            }
            if behind_b != b {
                triangles.push([b, behind_a, behind_b]);
            }
        }
        shade(&positions, &triangles, Crease::new(crease), |_| false)
    }
}

fn flat(place: &[f32; 2]) -> DVec2 {
    let [x, y] = place.map(f64::from);
    DVec2::new(x, y)
}

fn sides([a, b, c]: &[u32; 3]) -> [[u32; 2]; 3] {
    [[*a, *b], [*b, *c], [*c, *a]]
}

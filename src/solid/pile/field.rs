//! Two height fields over one mesh of an outline, the front and the back of a solid that is lifted.
//!
//! The mesh has the points that the solid by itself would have, points where its border crosses an edge of a surface below and
//! bends there, corners of those surfaces that it would miss, and more where it would still deviate. What deviates even so is made
//! up for by lifting the front.

use std::sync::Arc;

use glam::DVec2;

use super::LayForm;
use super::cover::Cover;
use super::ground::Target;
use crate::geometry::{Outline, edges_of, simplify};
use crate::scene::Surface;
use crate::solid::crease::Crease;
use crate::solid::heights::{BothHeights, Heights};
use crate::solid::inflate::{Mesh, Points, mesh as mesh_of, points};
use crate::solid::layers::steps_per_half_turn;
use crate::solid::shade::shade;
use crate::solid::stack::PlacementTransform;
use crate::solid::{Options, Placement, Solid};

/// Points of the border are no closer than this, in tolerances.
const NEAR: f64 = 0.2;
/// Crossings of a border with edges below that are looked at, about.
const MAX_CROSSINGS: usize = 1 << 16;
/// The least thickness, relative to depths, that `f32` can distinguish from none.
const MIN_THICKNESS: f64 = 1e-6;
/// Edges of rounded solids that are sharper than this are seen as edges, degrees: it is between the steps of a rounding and
/// the right angle at which walls stand.
const ROUND_CREASE: f64 = 75.0;

/// The front and the back of a solid over one mesh.
#[derive(Debug)]
pub(super) struct Field {
    mesh: Mesh,
    /// Per point.
    front: Vec<f64>,
    back: Vec<f64>,
    is_open: bool,
    is_round: bool,
    /// Steps of a rounding per half turn, of the solid by itself.
    steps: u32,
}

impl Field {
    /// The height fields over an outline, in the frame of its node; `None` if nothing lifts the solid.
    pub(super) fn new(outline: &Outline, solid: &Solid, target: &Target<'_>) -> Option<Self> {
        let options = &solid.options;
        let steps = steps_per_half_turn(options);
        let tolerance = target.lay.tolerance();
        // Skins of plates and lines have no heights of their own.
        let is_round = match target.lay.form {
            LayForm::Ink => false,
            LayForm::BackSkin => solid.profile.is_soft(),
            _ => target.lay.bulge > 0.0,
        };
        let mut all = if is_round {
            let segments = target.lay.segments.unwrap_or(steps);
            match solid.profile.height_field() {
                Some(kind) => kind.points(outline, segments, options.placement.scale),
                None => points(outline, segments),
            }
        } else {
            Points {
                points: Vec::new(),
                edges: Vec::new(),
            }
        };
        if !target.is_lifting(&all.points) {
            return None;
        }
        let rings = if is_round {
            rings(&all)
        } else {
            let polygons = outline.polygons.iter();
            polygons.flat_map(|polygon| polygon.rings.clone()).collect()
        };
        let inner = all.points.split_off(all.edges.len());
        let mut all = border(&rings, target, tolerance);
        all.points.extend(inner);
        let in_place = PlacementTransform::new(&Options {
            placement: Placement::default(),
            ..*options
        });
        let mut cover = Cover::new(mesh_of(&all, &in_place), target, tolerance);
        let most = all.points.len() + target.growth.most(all.points.len());
        let mut refine =
            |cover: &mut Cover<'_>, wanted: &dyn Fn(&Cover<'_>, usize) -> Vec<DVec2>| {
                let wanted = wanted(cover, most.saturating_sub(all.points.len()));
                if !wanted.is_empty() {
                    all.points.extend(wanted);
                    cover.refine(mesh_of(&all, &in_place));
                }
            };
        // Half of the points are left for what the corners do not tell.
        refine(&mut cover, &|cover, room| cover.corners(room / 2));
        refine(&mut cover, &|cover, room| cover.deviations(room));
        let [front, back] = cover.fields();
        Some(Self {
            mesh: cover.into_mesh(),
            front,
            back,
            is_open: target.lay.form == LayForm::Sheet,
            is_round,
            steps,
        })
    }

    /// The heights of both sides, depths in the drawing.
    pub(super) fn heights(self: &Arc<Self>) -> BothHeights {
        let field = Arc::clone(self);
        let back = move || Heights::over_mesh(&field.mesh, |i| -field.back[i]);
        BothHeights::new(Heights::over_mesh(&self.mesh, |i| self.front[i]), back)
    }

    /// The number of triangles of its front.
    pub(super) fn facet_count(&self) -> usize {
        self.mesh.triangles.len()
    }

    /// The surface in the frame of a node at this depth, with its back and its walls.
    pub(super) fn surface(&self, node_depth: f64, crease: f64) -> Surface {
        let Mesh {
            points, triangles, ..
        } = &self.mesh;
        let count = points.len();
        let border = self.mesh.border();
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

/// The border with points where it crosses the edges of triangles below and the front bends there by more than the tolerance. Of too many
/// only those where it bends more are kept.
fn border(rings: &[Vec<DVec2>], target: &Target<'_>, tolerance: f64) -> Points {
    // Closer points would bend the border only where it is too steep to be seen.
    let apart = NEAR * tolerance;
    let own: usize = rings.iter().map(Vec::len).sum();
    let mut profiles: Vec<Vec<(f64, f64)>> = Vec::with_capacity(own);
    let mut looked_at = 0;
    let mut crossings = Vec::new();
    for [from, to] in edges_of(rings) {
        crossings.clear();
        if looked_at < MAX_CROSSINGS {
            for body in target.ground.visible() {
                body.crossings(from, to, &mut crossings);
            }
            looked_at += crossings.len();
        }
        if crossings.is_empty() {
            profiles.push(Vec::new());
            continue;
        }
        crossings.sort_unstable_by(f64::total_cmp);
        let length = from.distance(to);
        let profile = std::iter::once(0.0)
            .chain(crossings.iter().copied())
            .chain([1.0]);
        let at = |share: f64| {
            let point = from.lerp(to, share);
            // Height fields are 0 along the border.
            let reach = target.reach(point).unwrap_or_default();
            (share, target.at(point, reach).front)
        };
        let mut profile: Vec<(f64, f64)> = profile.map(at).collect();
        profile.dedup_by(|next, last| (next.0 - last.0) * length < apart && next.0 < 1.0);
        profiles.push(profile);
    }
    // Borders that lie on one another would have ever more points.
    let most = target.growth.most(own);
    let mut tolerance = tolerance;
    let shares = loop {
        let inner = profiles
            .iter()
            .map(|profile| inner_bends(profile, tolerance));
        let inner: Vec<Vec<f64>> = inner.collect();
        if inner.iter().map(Vec::len).sum::<usize>() <= most {
            break inner;
        }
        tolerance *= 2.0;
    };
    let mut points = Points {
        points: Vec::new(),
        edges: Vec::new(),
    };
    let mut shares = shares.iter();
    for ring in rings {
        let start = points.points.len();
        for ([from, to], shares) in edges_of([ring]).zip(&mut shares) {
            points.points.push(from);
            let places = shares.iter().map(|share| from.lerp(to, *share));
            points.points.extend(places);
        }
        let end = points.points.len();
        let next = |i: usize| if i + 1 == end { start } else { i + 1 };
        points.edges.extend((start..end).map(|i| [i, next(i)]));
    }
    points
}

/// The shares at which a profile of heights bends by more than the tolerance between its ends.
fn inner_bends(profile: &[(f64, f64)], tolerance: f64) -> Vec<f64> {
    match &bends(profile, tolerance)[..] {
        [_, inner @ .., _] => inner.iter().map(|index| profile[*index].0).collect(),
        _ => Vec::new(),
    }
}

/// The indices of the points at which a profile of heights bends by more than the tolerance, with its ends.
fn bends(profile: &[(f64, f64)], tolerance: f64) -> Vec<usize> {
    simplify(profile.len(), |from, to| {
        let [(start, low), (end, high)] = [profile[from], profile[to]];
        let deviation = |(share, height): (f64, f64)| {
            let straight = low + (high - low) * (share - start) / (end - start);
            (height - straight).abs()
        };
        let farthest =
            (from + 1..to).max_by(|a, b| deviation(profile[*a]).total_cmp(&deviation(profile[*b])));
        farthest.filter(|index| deviation(profile[*index]) > tolerance)
    })
}

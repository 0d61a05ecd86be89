//! How a mesh follows what it is laid on, and where it does not.

use std::cell::OnceCell;

use glam::{DVec2, DVec3};
use rustc_hash::{FxHashMap, FxHashSet};

use super::LayForm;
use super::ground::{BodyInFrame, Level, Target};
use crate::solid::heights::Heights;
use crate::solid::inflate::Mesh;

/// The cosine of the steepest slope at which deviations are measured at a right angle.
const STEEP: f64 = 0.4;
/// Triangles whose sides are all shorter than this, in tolerances, are not refined.
const SMALL: f64 = 1.0;
/// The front is lifted where the surface below would come closer to it than the rest of this share of the step.
const LIFTED: f64 = 0.8;
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

/// A place of the plane, told apart exactly.
type Key = [u32; 2];

/// What is known of a mesh that is laid on others.
pub(super) struct Cover<'a> {
    target: &'a Target<'a>,
    tolerance: f64,
    is_volume: bool,
    mesh: Mesh,
    /// The mesh in the plane, in which the triangles at places are found.
    plane: OnceCell<Heights>,
    /// Per point of the mesh.
    levels: Vec<Level>,
    /// Per triangle of the mesh, if what lies below matters there.
    samples: Vec<Option<Samples>>,
}

/// A triangle compared with the target.
#[derive(Debug, Clone, Copy)]
struct Samples {
    /// How far each corner has to be lifted so that the surface below does not cut through the triangle.
    lifts: [f64; 3],
    /// How far the triangle is from where it should be, at a right angle; in very steep places more than that, or a border that
    /// is lifted by it would be ragged as seen from the side.
    apart: f64,
    /// Where it is that far from there.
    at: DVec2,
}

impl Samples {
    /// The samples of the same triangle, listed from its corner `first` on.
    fn turned(mut self, first: usize) -> Self {
        self.lifts.rotate_left(first % 3);
        self
    }
}

impl<'a> Cover<'a> {
    /// Compares a mesh with the target.
    pub(super) fn new(mesh: Mesh, target: &'a Target<'a>, tolerance: f64) -> Self {
        let points = mesh.points.iter().zip(target.reaches(&mesh));
        let levels = points.map(|(point, reach)| target.at(flat(point), reach));
        let mut cover = Self {
            target,
            tolerance,
            is_volume: target.lay.form == LayForm::Volume,
            levels: levels.collect(),
            samples: Vec::new(),
            plane: OnceCell::new(),
            mesh,
        };
        let triangles = cover.mesh.triangles.iter();
        let samples = triangles.map(|triangle| cover.samples_of(*triangle));
        cover.samples = samples.collect();
        cover
    }

    /// Compares a mesh with the target that was refined from the one before: most of its triangles are known.
    pub(super) fn refine(&mut self, mesh: Mesh) {
        let key = |mesh: &Mesh, i: u32| mesh.points[i as usize].map(f32::to_bits);
        // Triangles begin with the least corner.
        let turned = |mesh: &Mesh, triangle: &[u32; 3]| {
            let first = (0..3).min_by_key(|i| key(mesh, triangle[*i])).unwrap_or(0);
            (first, [0, 1, 2].map(|i| triangle[(first + i) % 3]))
        };
        let levels = (0..).zip(&self.levels);
        let known_levels: FxHashMap<Key, Level> = levels
            .map(|(i, level)| (key(&self.mesh, i), *level))
            .collect();
        let mut known_samples: FxHashMap<[Key; 3], Option<Samples>> = FxHashMap::default();
        for (triangle, samples) in self.mesh.triangles.iter().zip(&self.samples) {
            let (first, triangle) = turned(&self.mesh, triangle);
            let samples = samples.map(|samples| samples.turned(first));
            known_samples.insert(triangle.map(|i| key(&self.mesh, i)), samples);
        }
        let level = |i: u32| {
            let known = known_levels.get(&key(&mesh, i)).copied();
            known.unwrap_or_else(|| self.at(flat(&mesh.points[i as usize])))
        };
        self.levels = (0..mesh.points.len() as u32).map(level).collect();
        self.mesh = mesh;
        self.plane = OnceCell::new();
        let samples = self.mesh.triangles.iter().map(|triangle| {
            let (first, turned) = turned(&self.mesh, triangle);
            let known = known_samples.get(&turned.map(|i| key(&self.mesh, i)));
            match known {
                Some(samples) => samples.map(|samples| samples.turned(3 - first)),
                None => self.samples_of(*triangle),
            }
        });
        self.samples = samples.collect();
    }

    /// The target over a point of the mesh.
    fn at(&self, point: DVec2) -> Level {
        let reach = self.target.reach(point);
        let over_mesh = || self.interpolated(point, |level| level.reach).unwrap_or(0.0);
        self.target
            .at(point, reach.unwrap_or_else(|| [over_mesh(); 2]))
    }

    /// What the mesh has over a place, if it is there, by what it has at its points.
    fn interpolated(&self, place: DVec2, of_level: impl Fn(&Level) -> f64) -> Option<f64> {
        // In the plane none of the triangles is a wall, so their numbers are those of the mesh.
        let plane = self
            .plane
            .get_or_init(|| Heights::over_mesh(&self.mesh, |_| 0.0));
        let (_, triangle) = plane.find(place)?;
        let triangle = self.mesh.triangles.get(triangle as usize)?;
        let [a, b, c] = triangle.map(|i| flat(&self.mesh.points[i as usize]));
        let [own_a, own_b, own_c] = triangle.map(|i| of_level(&self.levels[i as usize]));
        let (ab, ac, to) = (b - a, c - a, place - a);
        let twice = ab.perp_dot(ac);
        let (share_b, share_c) = (to.perp_dot(ac) / twice, ab.perp_dot(to) / twice);
        Some(own_a + (own_b - own_a) * share_b + (own_c - own_a) * share_c)
    }

    /// Compares a triangle with the target; `None` where nothing below matters.
    fn samples_of(&self, triangle: [u32; 3]) -> Option<Samples> {
        let mesh = &self.mesh;
        let target = self.target;
        let levels = triangle.map(|i| self.levels[i as usize]);
        // Where nothing below lifts it the solid by itself is fine enough.
        if self.is_volume && levels.iter().all(|level| level.below.is_none()) {
            return None;
        }
        let flats = triangle.map(|i| flat(&mesh.points[i as usize]));
        let reach = levels.map(|level| level.reach);
        let [a, b, c] = [0, 1, 2].map(|i| flats[i].extend(levels[i].front));
        let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
        let slope = normal.z.max(STEEP);
        // On slopes the front is as far from the surface below as elsewhere.
        let step = target.lay.step / slope;
        let least = if self.is_volume {
            0.0
        } else {
            step - target.lay.step
        };
        let mut samples = Samples {
            lifts: [least; 3],
            apart: 0.0,
            at: flats[0],
        };
        if target.is_plane(&levels) {
            return Some(samples);
        }
        let mut missing = [f64::NEG_INFINITY; PLACES.len()];
        let fronts = levels.map(|level| level.front);
        let mut top = fronts.into_iter().fold(f64::NEG_INFINITY, f64::max);
        for (shares, missing) in PLACES.iter().zip(&mut missing) {
            let [share_a, share_b, share_c] = *shares;
            let own = a * share_a + b * share_b + c * share_c;
            let point = own.truncate();
            let (below, apart) = if self.is_volume {
                let below = target.below(point);
                let below = below.map_or(f64::NEG_INFINITY, |below| below - own.z);
                // A volume may stand out more than it has to.
                (below, (below + target.lay.step).max(0.0))
            } else {
                let reach = reach[0] * share_a + reach[1] * share_b + reach[2] * share_c;
                match target.lifted(point, target.rim(point), reach) {
                    Some((below, lifted)) => (below.front - own.z, (lifted - own.z).abs()),
                    None => (
                        f64::NEG_INFINITY,
                        (target.at(point, [reach; 2]).front - own.z).abs(),
                    ),
                }
            };
            *missing = below + (1.0 - LIFTED) * step;
            top = top.max(own.z + *missing);
            if apart * slope > samples.apart {
                samples.apart = apart * slope;
                samples.at = point;
            }
        }
        let room = fronts.map(|front| top - front);
        let lifts = PLACES.iter().zip(missing);
        let lifts = lifts.map(|(shares, missing)| lift(*shares, room, missing));
        let lift = lifts.fold(0.0, f64::max);
        samples.lifts = room.map(|room| lift.min(room).max(least));
        Some(samples)
    }

    /// The corners of the triangles below, and of those that it is wrapped around or behind, which the mesh misses by more than
    /// the tolerance; of too many those that it misses most.
    pub(super) fn corners(&self, most: usize) -> Vec<DVec2> {
        let target = self.target;
        let points = || self.mesh.points.iter().map(flat);
        let (Some(low), Some(high)) = (points().reduce(DVec2::min), points().reduce(DVec2::max))
        else {
            return Vec::new();
        };
        let mut known: FxHashSet<[i64; 2]> = FxHashSet::default();
        let mut missed: Vec<(f64, DVec2)> = Vec::new();
        let mut add = |corner: DVec2, apart: &dyn Fn(DVec2) -> Option<f64>| {
            // Of corners that are closer than this one is enough.
            let cell = (corner / self.tolerance).round();
            if known.insert(cell.to_array().map(|x| x as i64))
                && let Some(apart) = apart(corner).filter(|apart| *apart > self.tolerance)
            {
                missed.push((apart, corner));
            }
        };
        let apart = |corner: DVec2| {
            let own = self.interpolated(corner, |level| level.front)?;
            Some(if self.is_volume {
                target.below(corner)? + target.lay.step - own
            } else {
                (self.at(corner).front - own).abs()
            })
        };
        for body in target.ground.visible() {
            let corners = body.corners([low, high], BodyInFrame::front_heights);
            corners.for_each(|corner| add(corner, &apart));
        }
        let around = || target.ground.wraps.iter().chain(&target.ground.behind);
        if around().next().is_some() {
            let apart = |corner: DVec2| {
                let own = self.interpolated(corner, |level| level.back)?;
                Some((self.at(corner).back - own).abs())
            };
            for body in around() {
                let corners = body.corners([low, high], BodyInFrame::back_heights);
                corners.for_each(|corner| add(corner, &apart));
            }
        }
        worst(missed, most)
    }

    /// Where triangles are farther from the target than the tolerance: of each the worst place, moved inward from its sides; of
    /// too many the worst.
    pub(super) fn deviations(&self, most: usize) -> Vec<DVec2> {
        let mesh = &self.mesh;
        let of_triangles = mesh.triangles.iter().zip(&self.samples);
        let deviations = of_triangles.filter_map(|(triangle, samples)| {
            let samples = samples.as_ref()?;
            let at = triangle.map(|i| flat(&mesh.points[i as usize]));
            let longest = (0..3)
                .map(|i| at[i].distance(at[(i + 1) % 3]))
                .fold(0.0, f64::max);
            let middle = (at[0] + at[1] + at[2]) / 3.0;
            (longest > SMALL * self.tolerance && samples.apart > self.tolerance)
                .then(|| (samples.apart, samples.at.lerp(middle, 0.2)))
        });
        worst(deviations.collect(), most)
    }

    /// The depths of the front and of the back at each point, the front lifted where the surface below would cut through it.
    pub(super) fn fields(&self) -> [Vec<f64>; 2] {
        let mut more = vec![0.0_f64; self.levels.len()];
        for (triangle, samples) in self.mesh.triangles.iter().zip(&self.samples) {
            let Some(samples) = samples else { continue };
            for (i, lift) in triangle.iter().zip(samples.lifts) {
                let most = &mut more[*i as usize];
                *most = most.max(lift);
            }
        }
        let front = self.levels.iter().zip(&more);
        let front: Vec<f64> = front.map(|(level, more)| level.front + more).collect();
        let back = self.levels.iter().zip(&front);
        let back = back.map(|(level, front)| {
            let mirrored = self.target.mirrored(*front);
            mirrored.map_or(level.back, |mirrored| level.back.min(mirrored))
        });
        let back = back.collect();
        [front, back]
    }

    /// The mesh.
    pub(super) fn into_mesh(self) -> Mesh {
        self.mesh
    }
}

/// How far the corners of a triangle have to be lifted, each by no more than its room, to lift a place in it, where the corners have
/// these shares, by `missing`. A corner without room is as high as the highest place that is to be cleared, so lifting it more
/// would only make a spike.
fn lift(shares: [f64; 3], room: [f64; 3], missing: f64) -> f64 {
    if missing <= 0.0 {
        return 0.0;
    }
    let mut lift = missing;
    // Each round but the last finds another corner without room.
    for _ in 0..shares.len() {
        let corners = || shares.into_iter().zip(room);
        let lifted: f64 = corners().map(|(share, room)| share * lift.min(room)).sum();
        let free = corners().filter(|(_, room)| *room > lift);
        let free: f64 = free.map(|(share, _)| share).sum();
        if lifted >= missing || free <= 0.0 {
            break;
        }
        lift += (missing - lifted) / free;
    }
    lift
}

/// The places with the greatest deviations, at most this many, the greatest first.
fn worst(mut places: Vec<(f64, DVec2)>, most: usize) -> Vec<DVec2> {
    places.sort_by(|a, b| b.0.total_cmp(&a.0));
    places.truncate(most);
    places.into_iter().map(|(_, place)| place).collect()
}

pub(super) fn flat(place: &[f32; 2]) -> DVec2 {
    let [x, y] = place.map(f64::from);
    DVec2::new(x, y)
}

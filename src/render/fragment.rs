//! Fragments: the pieces of surface that a pixel shows, each with its coverage, as in an A-buffer (Carpenter 1984).

use glam::{Vec2, Vec3};

use super::Shading;
use super::camera::{Camera, on_level};
use super::coverage::Coverage;
use super::ground::{Floor, shadow_fade};
use super::lanes::Hit;
use super::light::{IncidentLight, even};
use super::raster::Raster;
use super::sampling::Sampling;
use super::surface::Alpha;
use super::trace::Tracer;

/// The rays that decide whether a pixel contains an edge.
pub(super) const MIN_RAYS: usize = 4;
/// The largest number of surfaces that a ray passes through.
const MAX_LAYERS: usize = 64;
/// Below this transmittance nothing more is visible.
const OPAQUE: f32 = 0.004;
/// Surfaces in a pixel whose normals have at least this cosine are shaded as one.
const ALIKE: f32 = 0.94;
/// Neighbours whose normals have at least this cosine share their light.
const NEIGHBORS_ALIKE: f32 = 0.88;
/// The largest number of fragments of a pixel.
const MAX_FRAGMENTS: usize = 12;
/// The distance from a surface at which secondary rays start, so that they do not hit it.
const LIFT: f32 = 3e-5;

/// What a fragment belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FragmentKind {
    /// The model, with the index of a material.
    Model(usize),
    /// The invisible ground, which shows shadows only.
    Ground,
}

/// A piece of surface that a pixel shows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fragment {
    pub(super) kind: FragmentKind,
    /// Share of the pixel; those of a pixel add up to at most 1.
    pub(super) weight: f32,
    /// Base colour, linear; multiplied by `weight` while rays are accumulated.
    pub(super) color: Vec3,
    /// The shading normal, towards the camera.
    pub(super) normal: Vec3,
    /// A point on the surface where secondary rays may start.
    pub(super) place: Vec3,
    /// Towards the camera.
    pub(super) towards: Vec3,
    /// The width of the pixel there.
    pub(super) width: f32,
    pub(super) incident: IncidentLight,
}

/// Finds the fragments of pixels.
pub(super) struct PixelSampler<'a> {
    pub(super) tracer: &'a Tracer<'a>,
    pub(super) camera: &'a Camera,
    pub(super) coverage: &'a Coverage,
    /// What rays meet, if it was found without tracing them.
    pub(super) raster: Option<Raster<'a>>,
    pub(super) sampling: &'a Sampling,
    pub(super) shading: Shading,
    /// The lines on the ground.
    pub(super) floor: Option<Floor>,
}

impl PixelSampler<'_> {
    /// Appends the fragments of a pixel to `out`. `met` gives the triangles that its rays meet, if these are known.
    pub(super) fn sample(
        &self,
        x: u32,
        y: u32,
        met: Option<impl Fn(usize) -> Option<usize>>,
        out: &mut Vec<Fragment>,
    ) {
        let first = out.len();
        let corner = Vec2::new(x as f32, y as f32);
        let covered = self.coverage.contains(x, y);
        let few = if covered {
            MIN_RAYS
        } else {
            self.sampling.empty
        };
        let mut rays = 0;
        for index in 0..self.sampling.edge {
            let uniform = index == few && self.are_uniform(&out[first..], few as f32 - 0.5);
            if uniform {
                break;
            }
            let place = corner + even(index);
            match (covered, &met) {
                (false, _) => self.trace_ground(place, first, out),
                (true, None) => self.trace(place, first, out),
                (true, Some(met)) => self.show(met(index), place, first, out),
            }
            rays += 1;
        }
        average(&mut out[first..], rays);
    }

    /// As [`sample`](Self::sample), by the first few rays. `met` gives the triangles that they meet.
    pub(super) fn sample_few(
        &self,
        x: u32,
        y: u32,
        met: impl Fn(usize) -> Option<usize>,
        out: &mut Vec<Fragment>,
    ) {
        let first = out.len();
        let corner = Vec2::new(x as f32, y as f32);
        for index in 0..MIN_RAYS {
            self.show(met(index), corner + even(index), first, out);
        }
        average(&mut out[first..], MIN_RAYS);
    }

    /// As [`sample`](Self::sample), by the ray through the middle. `met` is the triangle that it meets, if this is known.
    pub(super) fn sample_once(
        &self,
        x: u32,
        y: u32,
        met: Option<Option<usize>>,
        out: &mut Vec<Fragment>,
    ) {
        let first = out.len();
        let place = Vec2::new(x as f32, y as f32) + even(0);
        match met {
            None => self.trace(place, first, out),
            Some(met) => self.show(met, place, first, out),
        }
        average(&mut out[first..], 1);
    }

    /// Whether one ray is enough for a pixel, judging by what it shows and what its neighbours show.
    pub(super) fn is_enough<'f>(
        &self,
        seen: &[Fragment],
        mut neighbors: impl Iterator<Item = &'f [Fragment]>,
    ) -> bool {
        let is_bare = |fragments: &[Fragment]| {
            let mut kinds = fragments.iter().map(|fragment| fragment.kind);
            kinds.all(|kind| kind == FragmentKind::Ground)
        };
        self.is_uniform(seen, 1)
            && neighbors.all(|other| match (seen, other) {
                // The ground has no edges.
                _ if is_bare(seen) => is_bare(other),
                ([one], [other]) => one.kind == other.kind && same_surface(one, other),
                _ => false,
            })
    }

    /// Whether a pixel that was sampled by so many rays needs no more.
    #[inline]
    pub(super) fn is_uniform(&self, seen: &[Fragment], rays: usize) -> bool {
        self.are_uniform(seen, 1.0 - 0.5 / rays as f32)
    }

    /// Whether there is one plain surface, with more than this weight, or nothing.
    #[inline]
    fn are_uniform(&self, seen: &[Fragment], least: f32) -> bool {
        match seen {
            [] => true,
            [one] => {
                let flat = match one.kind {
                    FragmentKind::Ground => true,
                    FragmentKind::Model(material) => {
                        let material = &self.tracer.materials[material];
                        material.sampler.is_none() && material.alpha == Alpha::Opaque
                    }
                };
                flat && one.weight > least
            }
            _ => false,
        }
    }

    /// Follows the ray through a point of the picture.
    fn trace(&self, place: Vec2, first: usize, out: &mut Vec<Fragment>) {
        let (origin, direction) = self.camera.ray(place);
        let [mut nearest, farthest] = self.camera.limits(direction);
        let mut clear = 1.0;
        for _ in 0..MAX_LAYERS {
            let hit = self.tracer.closest(origin, direction, nearest);
            let Some(hit) = hit.filter(|hit| hit.distance <= farthest) else {
                break;
            };
            nearest = hit.distance + 1e-6;
            let width = self.camera.pixel(hit.distance);
            let base = self
                .tracer
                .base(&hit, width / (self.sampling.edge as f32).sqrt());
            let cover = self.tracer.cover(&hit, base.w);
            if cover > 0.0 {
                let fragment = self.fragment(&hit, origin, direction, width, base.truncate());
                merge(fragment, clear * cover, first, out);
                clear *= 1.0 - cover;
            }
            if clear < OPAQUE {
                return;
            }
        }
        if let Some(ground) = self.ground(origin, direction) {
            merge(ground, clear, first, out);
        }
    }

    /// As [`trace`](Self::trace), if the first triangle is known that the ray meets.
    fn show(&self, met: Option<usize>, place: Vec2, first: usize, out: &mut Vec<Fragment>) {
        let Some(triangle) = met else {
            self.trace_ground(place, first, out);
            return;
        };
        let tracer = self.tracer;
        let material = &tracer.materials[tracer.material(triangle)];
        let (origin, direction) = self.camera.ray(place);
        match Hit::of_plane(&tracer.surface, triangle, origin, direction) {
            Some(hit) if material.alpha == Alpha::Opaque => {
                let width = self.camera.pixel(hit.distance);
                let base = tracer.base(&hit, width / (self.sampling.edge as f32).sqrt());
                let fragment = self.fragment(&hit, origin, direction, width, base.truncate());
                merge(fragment, 1.0, first, out);
            }
            // What is behind it may be seen too.
            _ => self.trace(place, first, out),
        }
    }

    /// Follows the ray through a point of the picture where the model is not.
    fn trace_ground(&self, place: Vec2, first: usize, out: &mut Vec<Fragment>) {
        let (origin, direction) = self.camera.ray(place);
        if let Some(ground) = self.ground(origin, direction) {
            merge(ground, 1.0, first, out);
        }
    }

    fn fragment(
        &self,
        hit: &Hit,
        origin: Vec3,
        direction: Vec3,
        width: f32,
        color: Vec3,
    ) -> Fragment {
        let tracer = self.tracer;
        let facet = tracer.facet(hit.triangle);
        // Two-sided surfaces may be seen from behind.
        let side = if facet.dot(direction) > 0.0 {
            -1.0
        } else {
            1.0
        };
        let place = origin + direction * hit.distance;
        let smooth = match self.shading {
            Shading::Smooth => tracer.normal(hit),
            Shading::Flat | Shading::Unlit => None,
        };
        let place = match smooth {
            Some(_) => tracer.lifted(hit, place, side),
            None => place,
        };
        Fragment {
            kind: FragmentKind::Model(tracer.material(hit.triangle)),
            weight: 0.0,
            color,
            normal: smooth.unwrap_or(facet) * side,
            place: place + facet * side * LIFT,
            towards: -direction,
            width,
            incident: IncidentLight::default(),
        }
    }

    /// The ground where a ray hits it, if seen from above and where it shows anything.
    fn ground(&self, origin: Vec3, direction: Vec3) -> Option<Fragment> {
        let surface = &self.tracer.surface;
        let lit = self.shading != Shading::Unlit;
        if !lit && self.floor.is_none() {
            return None;
        }
        let distance = on_level(origin, direction, surface.low.y)?;
        let place = origin + direction * distance;
        let shadow = lit && shadow_fade(place, surface) > 0.0;
        let lines = || self.floor.is_some_and(|floor| floor.fade(place) > 0.0);
        (shadow || lines()).then(|| Fragment {
            kind: FragmentKind::Ground,
            weight: 0.0,
            color: Vec3::ZERO,
            normal: Vec3::Y,
            place,
            towards: -direction,
            width: self.camera.pixel(distance),
            incident: IncidentLight::default(),
        })
    }
}

/// Turns the sums of so many rays into means.
fn average(fragments: &mut [Fragment], rays: usize) {
    for fragment in fragments {
        fragment.color /= fragment.weight;
        fragment.weight /= rays as f32;
        fragment.normal = fragment.normal.normalize_or(fragment.towards);
    }
}

/// Whether two fragments of neighbouring pixels are on one surface, without an edge between them.
#[inline]
pub(super) fn same_surface(one: &Fragment, other: &Fragment) -> bool {
    let apart = other.place - one.place;
    (one.kind == FragmentKind::Ground) == (other.kind == FragmentKind::Ground)
        && one.normal.dot(other.normal) > NEIGHBORS_ALIKE
        && apart.dot(one.normal).abs() < one.width * 2.5
        && apart.length_squared() < (one.width * 12.0).powi(2)
}

/// Adds a fragment to a similar one of its pixel, or to the list.
#[inline]
fn merge(piece: Fragment, weight: f32, first: usize, out: &mut Vec<Fragment>) {
    let full = out.len() - first >= MAX_FRAGMENTS;
    let alike = |other: &&mut Fragment| {
        let cosine = other.normal.normalize_or_zero().dot(piece.normal);
        let near = (other.place - piece.place).dot(piece.normal).abs() < piece.width * 2.0;
        other.kind == piece.kind && (full || cosine > ALIKE && near)
    };
    match out[first..].iter_mut().find(alike) {
        Some(other) => {
            other.weight += weight;
            other.color += piece.color * weight;
            other.normal += piece.normal * weight;
        }
        None => out.push(Fragment {
            weight,
            color: piece.color * weight,
            normal: piece.normal * weight,
            ..piece
        }),
    }
}

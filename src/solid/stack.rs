//! Decides how a stack of layers is built: which copies of the outline it has, whether they are points, lines or
//! rings, and how all triangles stay non-degenerate in `f32`.

use glam::{DMat2, DVec2, DVec3};

use super::crease::Crease;
use super::layers::{Layer, MIN_SCALE};
use super::prism::prism;
use super::ridge::{Collapse, Matched, matched};
use super::rings::Rings;
use super::shell::shell;
use super::{Options, cap};
use crate::geometry::Outline;
use crate::scene::Surface;

/// Minimum scales of copies, tried in turn until all points are distinct in `f32`.
const MIN_SCALES: [f64; 4] = [0.01, 0.05, 0.25, 1.0];
/// Degenerate triangles in copies of a smaller scale are attributed to the scale.
const NARROW: f64 = 0.05;
/// The number of attempts at a surface.
const ATTEMPTS: usize = 12;
/// The first distance by which a point is moved off an edge that it touches in `f32`, relative to the
/// largest coordinate; it is doubled at each attempt.
const FIRST_NUDGE: f64 = 1e-6;
/// The largest such distance, relative to the extent.
const MAX_NUDGE: f64 = 1e-4;
/// Gaps in a copy wider than this, relative to its largest coordinate, survive in `f32`.
const GAP: f64 = 1e-6;
/// Copies further away than this, relative to their extent, are checked even if not scaled.
const FAR: f64 = 1.0;
/// Layers closer than this, relative to the whole depth, are one.
const NEAR: f64 = 1e-6;

/// The surface over layers by rising depth: closed over two or more, the flat outline for one, nothing for none.
pub(super) fn surface(outline: &Outline, layers: &[Layer], options: &Options) -> Surface {
    match layers {
        [] => Surface::default(),
        [layer] => flat(outline, layer.z, options),
        _ => stack(outline, layers, options),
    }
}

/// The outline alone, seen from the front.
fn flat(outline: &Outline, z: f64, options: &Options) -> Surface {
    let rings = Rings::of(outline);
    let transform = PlacementTransform::new(options);
    let transform = |p: &DVec2| transform.position(p.extend(z));
    Surface {
        positions: rings.points.iter().map(transform).collect(),
        normals: vec![[0.0, 0.0, 1.0]; rings.len()],
        triangles: cap::triangles(&rings),
        ..Surface::default()
    }
}

/// The base of a stack: the outline and how its copies collapse.
pub(super) enum Base {
    /// Scaled evenly; copies of scale 0 are points.
    Even(Rings),
    /// Scaled one way, towards a line on which both sides of the outline match.
    Ridge(Matched),
    /// Scaled one way, towards a line that some cuts meet several times; a narrow copy replaces
    /// copies of scale 0.
    Narrow(Rings),
}

impl Base {
    fn new(outline: &Outline, layers: &[Layer]) -> Base {
        let collapse = if layers.iter().any(|l| l.across != l.along && l.along == 1.0) {
            Collapse::Across
        } else if layers.iter().any(|l| l.across != l.along) {
            Collapse::Along
        } else {
            return Base::Even(Rings::of(outline));
        };
        match matched(outline, collapse) {
            Some(matched) => Base::Ridge(matched),
            None => Base::Narrow(Rings::of(outline)),
        }
    }

    pub(super) fn rings(&self) -> &Rings {
        match self {
            Base::Even(rings) | Base::Narrow(rings) => rings,
            Base::Ridge(matched) => &matched.rings,
        }
    }

    pub(super) fn stations(&self) -> Option<&[u32]> {
        match self {
            Base::Ridge(matched) => Some(&matched.stations),
            Base::Even(_) | Base::Narrow(_) => None,
        }
    }

    fn caps(&self) -> Vec<[u32; 3]> {
        match self {
            Base::Even(rings) | Base::Narrow(rings) => cap::triangles(rings),
            Base::Ridge(matched) => matched.triangles(),
        }
    }
}

impl Base {
    /// Whether walls are too warped for two triangles each: in a thin outline the volumes that these would add or lose are
    /// close to the whole volume.
    pub(super) fn is_warped(&self) -> bool {
        let Base::Narrow(rings) = self else {
            return false;
        };
        let (mut warp, mut area) = (0.0, 0.0);
        for (p, next) in rings.points.iter().zip(&rings.next) {
            let q = rings.points[*next as usize];
            warp += (q.x - p.x) * (q.y - p.y).abs();
            area += p.perp_dot(q) / 2.0;
        }
        warp.abs() > area / 2.0
    }
}

/// Whether an edge leads up.
pub(super) fn rises(from: DVec2, to: DVec2) -> bool {
    (from.y, from.x) <= (to.y, to.x)
}

/// The closed surface over two or more layers.
fn stack(outline: &Outline, layers: &[Layer], options: &Options) -> Surface {
    let transform = PlacementTransform::new(options);
    let crease = Crease::new(options.crease);
    let mut base = Base::new(outline, layers);
    if base.rings().len() < 3 {
        return Surface::default();
    }
    let extent = base.rings().extent();
    let largest = layers
        .iter()
        .map(|l| l.across.min(l.along))
        .fold(0.0, f64::max);
    let mut floors = MIN_SCALES.iter().map(|floor| floor.min(largest));
    let mut floor = MIN_SCALE.min(largest);
    let mut nudge = FIRST_NUDGE * (extent + transform.translation.truncate().abs().max_element());
    for _ in 0..ATTEMPTS {
        let levels = levels(layers, &base, floor, &transform);
        let ends = [levels[0].form, levels[levels.len() - 1].form];
        let mut caps = [Vec::new(), Vec::new()];
        if ends.contains(&Form::Rings) {
            // Each end may need different edges flipped.
            let cap = base.caps();
            caps = [cap.clone(), cap];
        }
        match fault(base.rings(), &levels, &mut caps, &transform) {
            None => {
                let prism = prism(base.rings(), &levels, &caps, crease, &transform);
                return prism.unwrap_or_else(|| shell(&base, &levels, &caps, crease, &transform));
            }
            Some(Fault::Small) => floor = floors.next().unwrap_or(floor),
            Some(Fault::Degenerate(empty)) => {
                if let Base::Even(rings) | Base::Narrow(rings) = &mut base {
                    rings.widen(&empty, nudge);
                    nudge = (2.0 * nudge).min(MAX_NUDGE * extent);
                } else {
                    base = Base::Narrow(Rings::of(outline));
                }
            }
        }
    }
    // Some points coincide in `f32`, which is the only fault left.
    let levels = levels(layers, &base, floor, &transform);
    let caps = base.caps();
    shell(&base, &levels, &[caps.clone(), caps], crease, &transform)
}

/// The form of a copy.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Rings,
    Ridge,
    Tip,
}

#[derive(Clone, Copy)]
pub(super) struct Level {
    pub(super) scale: DVec2,
    pub(super) z: f64,
    pub(super) form: Form,
}

/// The levels of a stack: its layers without those that are too small or too close to another.
fn levels(layers: &[Layer], base: &Base, floor: f64, transform: &PlacementTransform) -> Vec<Level> {
    let end = layers.len() - 1;
    let depth = layers[end].z - layers[0].z;
    let mut levels: Vec<Level> = Vec::with_capacity(layers.len());
    for (i, layer) in layers.iter().enumerate() {
        let mut scale = DVec2::new(layer.across, layer.along);
        let mut form = Form::Rings;
        if let Base::Narrow(_) = base {
            scale = scale.max(DVec2::splat(floor));
        } else if scale.min_element() < floor {
            if i != 0 && i != end {
                continue;
            }
            let tip = scale.x < floor && scale.y < floor;
            form = if tip { Form::Tip } else { Form::Ridge };
            // The copy is narrow, but the base does not collapse to a ridge.
            if form == Form::Ridge && !matches!(base, Base::Ridge(_)) {
                form = Form::Rings;
                scale = scale.max(DVec2::splat(floor));
            } else {
                scale = DVec2::select(scale.cmplt(DVec2::splat(floor)), DVec2::ZERO, scale);
            }
        }
        if let Some(before) = levels.last()
            && (layer.z - before.z <= NEAR * depth
                || transform.depth(layer.z) == transform.depth(before.z))
        {
            if i != end {
                continue;
            }
            if levels.len() > 1 {
                levels.pop();
            }
        }
        levels.push(Level {
            scale,
            z: layer.z,
            form,
        });
    }
    levels
}

/// A fault of a stack in `f32`.
enum Fault {
    /// A copy is so small that points coincide.
    Small,
    /// Triangles of a cap are degenerate.
    Degenerate(Vec<[u32; 3]>),
}

/// The first fault of a stack, after edges within the caps were flipped to avoid degenerate triangles.
fn fault(
    rings: &Rings,
    levels: &[Level],
    caps: &mut [Vec<[u32; 3]>; 2],
    transform: &PlacementTransform,
) -> Option<Fault> {
    let extent = rings.extent();
    let away = transform.translation.truncate().abs().max_element();
    let gap = cap::least_gap(rings);
    let ends = [0, levels.len() - 1];
    for (k, level) in levels
        .iter()
        .enumerate()
        .filter(|(_, l)| l.form == Form::Rings)
    {
        if k > 0
            && levels.len() == 2
            && level.scale == levels[0].scale
            && levels[0].form == Form::Rings
        {
            // Both ends of a prism are equal.
            let [first, last] = caps;
            last.clone_from(first);
            continue;
        }
        let scale = level.scale.min_element();
        let small = (scale < 1.0 || away > FAR * extent) && scale * gap < GAP * (extent + away);
        let capped = ends.contains(&k);
        if !(small || capped) {
            continue;
        }
        let place = |p: &DVec2| {
            let [x, y, _] = transform.position((*p * level.scale).extend(level.z));
            DVec2::new(x.into(), y.into())
        };
        let points: Vec<DVec2> = rings.points.iter().map(place).collect();
        if small {
            let bits = |p: &DVec2| {
                let [x, y] = [p.x, p.y].map(|x| u64::from((x as f32 + 0.0).to_bits()));
                x << 32 | y
            };
            let mut places: Vec<u64> = points.iter().map(bits).collect();
            places.sort_unstable();
            if places.windows(2).any(|w| w[0] == w[1]) {
                return Some(Fault::Small);
            }
        }
        if capped {
            let empty = cap::flip_degenerate(&points, &mut caps[usize::from(k > 0)], 0.0);
            if !empty.is_empty() {
                return Some(if scale < NARROW {
                    Fault::Small
                } else {
                    Fault::Degenerate(empty)
                });
            }
        }
    }
    None
}

/// Maps points to their final positions: a [`Placement`](super::Placement) with its rotation matrix.
pub(super) struct PlacementTransform {
    turn: DMat2,
    translation: DVec3,
    scale: f64,
}

impl PlacementTransform {
    pub(super) fn new(options: &Options) -> PlacementTransform {
        PlacementTransform {
            turn: options.placement.turn(),
            translation: options.placement.translation,
            scale: options.placement.scale,
        }
    }

    pub(super) fn position(&self, p: DVec3) -> [f32; 3] {
        let turned = (self.turn * p.truncate()).extend(p.z);
        (self.scale * (turned + self.translation))
            .as_vec3()
            .to_array()
    }

    /// The x and y of a point's final position.
    pub(super) fn in_plane(&self, p: DVec2) -> [f32; 2] {
        (self.scale * (self.turn * p + self.translation.truncate()))
            .as_vec2()
            .to_array()
    }

    pub(super) fn depth(&self, z: f64) -> f32 {
        (self.scale * (z + self.translation.z)) as f32
    }

    pub(super) fn normal(&self, n: DVec3) -> [f32; 3] {
        (self.turn * n.truncate()).extend(n.z).as_vec3().to_array()
    }
}

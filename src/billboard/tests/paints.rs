//! The law of paints: at every drawn view, each region has the colour there that the drawing gives it, whatever the other views show.
//!
//! Generated characters are recoloured from view to view with colours, gradients and alpha. What their models show is found from
//! positions, morph targets and materials alone, as any program shows them.

use std::fmt::Write as _;

use glam::{DVec2, DVec3, Vec3Swizzles as _};
use typed_index_collections::TiVec;

use super::generated::random::Random;
use super::generated::{Drawn, character, directions};
use crate::compile::{Compiled, Options, compile};
use crate::geometry::{Outline, bounds};
use crate::resolver::MemoryResolver;
use crate::scene::{Material, NodeId, Primitive, Scene, Surface, ViewDependent, ViewId, Wrap};

/// How far from the drawn colour a channel may be, 0 to 1.
const TOLERANCE: f64 = 0.02;
/// Places closer to a border are not compared, heights.
const MARGIN: f64 = 0.004;
/// Places that are tried in each region.
const PLACES: usize = 12;

/// sRGB with straight alpha, each 0 to 1.
type Color = [f64; 4];

/// What a region is painted with.
#[derive(Debug, Clone, Copy)]
pub(super) enum Paint {
    Plain(Color),
    /// From the left to the right of the box around the region, without alpha.
    Gradient([Color; 2]),
}

impl Paint {
    /// As if lit by another light.
    fn recolored(self, random: &mut Random) -> Self {
        let mut near = |color: Color| {
            let mut near = color;
            for channel in &mut near[..3] {
                *channel = (*channel + random.between(-0.15, 0.15)).clamp(0.0, 1.0);
            }
            near
        };
        match self {
            Self::Plain(color) => Self::Plain(near(color)),
            Self::Gradient(ends) => Self::Gradient(ends.map(near)),
        }
    }

    fn at(self, place: DVec2, (low, high): (DVec2, DVec2)) -> Color {
        match self {
            Self::Plain(color) => color,
            Self::Gradient([from, to]) => {
                let share = (place.x - low.x) / (high.x - low.x);
                [0, 1, 2, 3].map(|i| from[i] + (to[i] - from[i]) * share)
            }
        }
    }

    fn hex(color: Color) -> String {
        let [r, g, b] = [0, 1, 2].map(|i| (color[i] * 255.0).round() as u8);
        format!("#{r:02x}{g:02x}{b:02x}")
    }
}

/// A region of a drawing: its outline, and its paint.
pub(super) type Region = (Outline, Paint);

/// The drawing of a character from two sides, and the regions of both views, back-most first.
pub(super) fn drawing(seed: u64) -> (String, [Vec<Region>; 2]) {
    let shown = character(seed);
    let mut random = Random::new(seed ^ 0x5EED);
    let views = directions(seed).map(|direction| shown.true_view(direction));
    let base = shown.items.iter().map(|item| {
        let paint = Paint::Plain(item.color);
        match random.below(6) {
            0 => Paint::Gradient([item.color, random.color(0.2, 0.8)]),
            1 => Paint::Plain([item.color[0], item.color[1], item.color[2], 0.6]),
            _ => paint,
        }
    });
    let base: Vec<Paint> = base.collect();
    let second = base.iter().map(|paint| match random.below(4) {
        0 => *paint,
        1 => Paint::Gradient([random.color(0.1, 0.9), random.color(0.1, 0.9)]),
        _ => paint.recolored(&mut random),
    });
    let paints = [base.clone(), second.collect()];
    let mut text =
        String::from("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"3000\" height=\"900\">");
    let mut regions = [Vec::new(), Vec::new()];
    for (number, view) in views.iter().enumerate() {
        let Drawn { view, items, .. } = view;
        let center = DVec2::new(700.0 + 1500.0 * number as f64, 450.0);
        let _ = write!(text, "<g id=\"view-{number}\">");
        for (region, item) in view.regions.iter().zip(items) {
            let outline = region
                .outline
                .map_rings(|ring| ring.iter().map(|p| *p + center).collect());
            let paint = paints[number][*item];
            let id = format!("r{number}-{item}");
            let fill = match paint {
                Paint::Plain(color) => format!(
                    "fill=\"{}\" fill-opacity=\"{}\"",
                    Paint::hex(color),
                    color[3]
                ),
                Paint::Gradient([from, to]) => {
                    let stops = [(0, from), (1, to)].map(|(offset, color)| {
                        format!(
                            "<stop offset=\"{offset}\" stop-color=\"{}\"/>",
                            Paint::hex(color)
                        )
                    });
                    let _ = write!(
                        text,
                        "<linearGradient id=\"g{id}\">{}</linearGradient>",
                        stops.concat()
                    );
                    format!("fill=\"url(#g{id})\"")
                }
            };
            let mut path = String::new();
            for ring in outline.polygons.iter().flat_map(|polygon| &polygon.rings) {
                for (at, point) in ring.iter().enumerate() {
                    let command = if at == 0 { 'M' } else { 'L' };
                    let _ = write!(path, "{command}{} {}", point.x, point.y);
                }
                path.push('Z');
            }
            let _ = write!(
                text,
                "<path id=\"{id}\" fill-rule=\"evenodd\" d=\"{path}\" {fill}><desc>thing{item}</desc></path>"
            );
            regions[number].push((outline, paint));
        }
        let [theta, phi] = [view.direction.theta, view.direction.phi];
        let _ = write!(
            text,
            "<text x=\"{}\" y=\"890\" font-size=\"9\">Toy$View {theta} {phi} Mirror off</text></g>",
            center.x
        );
    }
    text.push_str("</svg>");
    (text, regions)
}

fn is_inside(outline: &Outline, place: DVec2) -> bool {
    let rings = outline.polygons.iter().flat_map(|polygon| &polygon.rings);
    let edges = rings.flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
    let crossed = edges.filter(|(a, b)| {
        (a.y > place.y) != (b.y > place.y)
            && place.x < a.x + (place.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossed.count() % 2 == 1
}

fn distance(outline: &Outline, place: DVec2) -> f64 {
    let rings = outline.polygons.iter().flat_map(|polygon| &polygon.rings);
    let edges = rings.flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
    let to_edge = edges.map(|(a, b)| {
        let along = *b - *a;
        let share = (place - *a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
        place.distance(*a + along * share.clamp(0.0, 1.0))
    });
    to_edge.fold(f64::INFINITY, f64::min)
}

/// Layers over each other, front-most first, multiplied by alpha.
fn composed(layers: impl Iterator<Item = Color>) -> Color {
    let mut sum = [0.0; 4];
    for [r, g, b, alpha] in layers {
        let rest = (1.0 - sum[3]) * alpha;
        for (sum, channel) in sum.iter_mut().zip([r, g, b, 1.0]) {
            *sum += rest * channel;
        }
    }
    sum
}

/// A model as it is seen from one of its views: triangles with the depths and looks of their corners.
struct Seen<'a> {
    scene: &'a Scene,
    surfaces: Vec<(TiVec<usize, DVec3>, Surface, &'a Material)>,
}

impl<'a> Seen<'a> {
    fn new(scene: &'a Scene, view: ViewId) -> Self {
        let mut surfaces = Vec::new();
        for node in scene.nodes.iter() {
            let Some(ViewDependent::Turn(turn)) = &node.view_dependent else {
                continue;
            };
            let weights = turn.weights(turn.views[view]);
            let region = |child: &NodeId| {
                let child = &scene.nodes[*child];
                let Some(ViewDependent::Region(places)) = &child.view_dependent else {
                    return Vec::new();
                };
                let place = turn.position(&weights, places);
                let mesh = child.mesh.map(|mesh| &scene.meshes[mesh]);
                let primitives = mesh.into_iter().flat_map(|mesh| &mesh.primitives);
                let surface = |primitive: &'a Primitive| {
                    let surface = primitive.surface().into_owned();
                    let corners = (0..surface.positions.len()).map(|corner| {
                        let base = DVec3::from(surface.positions[corner].map(f64::from));
                        let moved = weights.iter().skip(1).zip(&surface.targets);
                        let moved = moved.map(|(weight, target)| {
                            DVec3::from(target[corner].map(f64::from)) * *weight
                        });
                        place + base + moved.sum::<DVec3>()
                    });
                    (
                        corners.collect(),
                        surface,
                        &scene.materials[primitive.material],
                    )
                };
                primitives.map(surface).collect()
            };
            surfaces.extend(node.children.iter().flat_map(region));
        }
        Self { scene, surfaces }
    }

    /// The colour at a place of the screen, metres.
    fn at(&self, place: DVec2) -> Color {
        let mut hits: Vec<(f64, Color)> = Vec::new();
        for (corners, surface, material) in &self.surfaces {
            for triangle in &surface.triangles {
                let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
                let area = (b - a).xy().perp_dot((c - a).xy());
                if area.abs() < 1e-12 {
                    continue;
                }
                let share = |p: DVec3, q: DVec3| (p.xy() - place).perp_dot(q.xy() - place) / area;
                let shares = [share(b, c), share(c, a), share(a, b)];
                if shares.iter().any(|share| *share < 0.0) {
                    continue;
                }
                let depth = shares[0] * a.z + shares[1] * b.z + shares[2] * c.z;
                let uv = triangle.iter().zip(shares).map(|(corner, share)| {
                    let uv = surface
                        .uvs
                        .get(*corner as usize)
                        .copied()
                        .unwrap_or_default();
                    DVec2::from(uv.map(f64::from)) * share
                });
                hits.push((depth, self.color(material, uv.sum())));
            }
        }
        hits.sort_by(|a, b| b.0.total_cmp(&a.0));
        composed(hits.into_iter().map(|(_, color)| color))
    }

    fn color(&self, material: &Material, uv: DVec2) -> Color {
        let [r, g, b, alpha] = material.base_color.map(f64::from);
        let srgb = |linear: f64| {
            if linear <= 0.003_130_8 {
                12.92 * linear
            } else {
                1.055 * linear.powf(1.0 / 2.4) - 0.055
            }
        };
        let factor = [srgb(r), srgb(g), srgb(b), alpha];
        let Some(texture) = &material.base_color_texture else {
            return factor;
        };
        let texture = &self.scene.textures[texture.texture];
        let image =
            image::load_from_memory(&self.scene.images[texture.image].bytes).expect("an image");
        let image = image.into_rgba8();
        assert_eq!(texture.wrap[0], Wrap::ClampToEdge);
        let size = DVec2::new(image.width().into(), image.height().into());
        let pixel = (uv * size).clamp(DVec2::ZERO, size - 1.0);
        let pixel = image.get_pixel(pixel.x as u32, pixel.y as u32).0;
        [0, 1, 2, 3].map(|i| factor[i] * f64::from(pixel[i]) / 255.0)
    }
}

/// Compares both views with the drawing; returns how many regions, and how many that have several paints.
fn check(seed: u64) -> [usize; 2] {
    let (text, regions) = drawing(seed);
    let compiled: Compiled = compile(&text, &Options::default(), &MemoryResolver::default());
    let [character] = &compiled.characters[..] else {
        panic!("seed {seed}: {:?}", compiled.diagnostics);
    };
    let world = crate::assemble::world_transform(&compiled.bindings, &compiled.layers);
    let scale = character.frames[ViewId::FIRST].height * world.scale;
    let mut random = Random::new(seed);
    let mut compared = 0;
    for (view, regions) in regions.iter().enumerate() {
        let view = ViewId::from(view);
        let seen = Seen::new(&compiled.scene, view);
        let frame = &character.frames[view];
        for (number, (outline, _)) in regions.iter().enumerate() {
            let Some((low, high)) = bounds(outline) else {
                continue;
            };
            let mut is_compared = false;
            for _ in 0..PLACES {
                let place = low + (high - low) * DVec2::new(random.next(), random.next());
                let is_clear = regions
                    .iter()
                    .all(|(other, _)| distance(other, place) > MARGIN * frame.height);
                if !is_clear || !is_inside(outline, place) {
                    continue;
                }
                let drawn = regions
                    .iter()
                    .rev()
                    .filter(|(outline, _)| is_inside(outline, place));
                let drawn =
                    composed(drawn.map(|(outline, paint)| {
                        paint.at(place, bounds(outline).expect("an outline"))
                    }));
                let shown = seen.at(frame.on_screen(place) * scale);
                for (drawn, shown) in drawn.iter().zip(shown) {
                    assert!(
                        (drawn - shown).abs() <= TOLERANCE,
                        "seed {seed}, view {view:?}, region {number}: {shown:?} instead of {drawn:?} at {place}\n{text}"
                    );
                }
                is_compared = true;
            }
            compared += usize::from(is_compared);
        }
    }
    let several = character.regions.iter();
    let several = several.filter(|region| region.paints_in_views().is_some());
    [compared, several.count()]
}

#[test]
fn every_view_has_the_colours_of_its_drawing() {
    let (mut compared, mut several) = (0, 0);
    for seed in 0..100 {
        let found = check(seed);
        compared += found[0];
        several += found[1];
    }
    assert!(compared > 3000 && several > 800, "{compared} {several}");
}

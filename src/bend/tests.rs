//! Laws of parts that bend: at rest they are as drawn, and bent they keep their width and volume.
#![allow(clippy::print_stdout, reason = "what was measured is told")]

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine2, DQuat, DVec2, DVec3, Vec3};

use super::{Bend, BentSurface, Bones, Centerline};
use crate::compile::compile;
use crate::geometry::{Outline, Polygon, y_up};
use crate::resolver::MemoryResolver;
use crate::scene::{Influence, Surface, SurfaceSource};
use crate::solid::{Options, Placement, Profile, Sides, Solid};

/// A limb as a person would draw it, hanging from the origin: its length, and its width along it.
fn limb(length: f64, width: impl Fn(f64) -> f64, bow: f64) -> Outline {
    const STEPS: usize = 40;
    let middle = |share: f64| DVec2::new(bow * length * (PI * share).sin(), share * length);
    let side = |sign: f64| {
        (0..=STEPS).map(move |step| {
            let share = step as f64 / STEPS as f64;
            (share, sign)
        })
    };
    let point = |(share, sign): (f64, f64)| {
        let way = middle(share + 1e-4) - middle(share - 1e-4);
        middle(share) + sign * width(share) / 2.0 * way.perp().normalize()
    };
    let ring: Vec<DVec2> = side(-1.0).chain(side(1.0).rev()).map(point).collect();
    Outline {
        polygons: vec![Polygon { rings: vec![ring] }],
    }
}

fn solid(outline: &Outline, kind: &str) -> Solid {
    Solid {
        outline: Arc::new(outline.clone()),
        to_frame: DAffine2::from_scale(DVec2::new(1.0, -1.0)),
        profile: Profile::new(kind, &[], 10.0).unwrap(),
        options: Options {
            segments: 12,
            crease: 30.0,
            placement: Placement::default(),
        },
        sides: Sides::Front,
        texture: None,
    }
}

/// A part that bends, in drawing units.
struct Bent {
    bend: Bend,
    surface: Surface,
    rigid: Surface,
}

fn bent(outline: &Outline, kind: &str, bend: impl Fn(Centerline) -> Bend) -> Bent {
    bent_at(outline, DVec2::ZERO, kind, bend)
}

/// A part whose joint is at a place of the drawing.
fn bent_at(outline: &Outline, joint: DVec2, kind: &str, bend: impl Fn(Centerline) -> Bend) -> Bent {
    let bend = bend(Centerline::new(outline, y_up(joint)).unwrap());
    let solid = solid(outline, kind);
    let source = BentSurface {
        solid: Arc::new(solid.clone()),
        bones: Arc::new(Bones::new(&bend, DAffine2::IDENTITY)),
        rigid: None,
    };
    Bent {
        surface: source.surface(),
        rigid: solid.surface(),
        bend,
    }
}

impl Bent {
    /// The corners where each joint is turned by an angle about an axis.
    fn posed(&self, axis: DVec3, angle: f64) -> Vec<DVec3> {
        let mut transforms = vec![(DQuat::IDENTITY, DVec3::ZERO)];
        let shares = self
            .bend
            .nodes
            .iter()
            .filter(|node| node.joint == 0)
            .count();
        for node in &self.bend.nodes {
            let (turn, shift) = *transforms.last().unwrap();
            let own = DQuat::from_axis_angle(axis, angle / shares as f64);
            let at = node.position.extend(0.0);
            // About the node, then as the one before.
            transforms.push((turn * own, turn * (at - own * at) + shift));
        }
        let corners = self.surface.positions.iter().zip(&self.surface.influences);
        let corners = corners.map(|(position, Influence { joints, first })| {
            let own = Vec3::from(*position).as_dvec3();
            let [one, other] = joints.map(|joint| {
                let (turn, shift) = transforms[usize::from(joint)];
                turn * own + shift
            });
            other.lerp(one, f64::from(*first))
        });
        corners.collect()
    }
}

impl Bent {
    /// How many triangles face another way than their corners' bones turn them.
    fn folded(&self, moved: &[DVec3], axis: DVec3, angle: f64) -> usize {
        let count = self.bend.nodes.len() as f64;
        let rest = at_rest(&self.surface);
        let normal = |points: &[DVec3], triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|corner| points[corner as usize]);
            (b - a).cross(c - a)
        };
        let turned = |triangle: &&[u32; 3]| {
            let turns = triangle.map(|corner| {
                let Influence { joints, first } = self.surface.influences[corner as usize];
                let [a, b] = joints.map(f64::from);
                b + (a - b) * f64::from(first)
            });
            let turn = turns.iter().sum::<f64>() / 3.0 / count * angle;
            let before = DQuat::from_axis_angle(axis, turn) * normal(&rest, triangle);
            let after = normal(moved, triangle);
            // A sliver has no side.
            let [a, b, c] = triangle.map(|corner| rest[corner as usize]);
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            before.length() / longest > 0.02 * self.bend.width() && before.dot(after) < 0.0
        };
        self.surface.triangles.iter().filter(turned).count()
    }
}

fn volume(points: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let corner = |corner: u32| points[corner as usize];
    let tetrahedra = triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(corner);
        a.cross(b).dot(c) / 6.0
    });
    tetrahedra.sum()
}

fn at_rest(surface: &Surface) -> Vec<DVec3> {
    let positions = surface.positions.iter();
    positions.map(|at| Vec3::from(*at).as_dvec3()).collect()
}

/// The least width of a limb across its first joint, where its corners are moved so.
fn width_at_joint(bent: &Bent, corners: &[DVec3]) -> f64 {
    let joint = bent
        .bend
        .nodes
        .iter()
        .find(|node| node.share > 0.5)
        .unwrap();
    // Of the corners near the joint along the limb those of either side.
    let near = |corner: &DVec3| {
        let along = bent.bend.line.along(corner.truncate());
        (along - joint.at).abs() < 0.25 * bent.bend.width()
    };
    let rest = at_rest(&bent.surface);
    let axis = DVec2::from_angle(joint.angle);
    let mut widest = [f64::INFINITY; 2];
    let mut sides: [Option<DVec3>; 2] = [None; 2];
    for (rest, moved) in rest.iter().zip(corners).filter(|(rest, _)| near(rest)) {
        let across = (rest.truncate() - joint.position).dot(axis);
        for (side, sign) in [-1.0, 1.0].into_iter().enumerate() {
            let off = (sign * across - bent.bend.width() / 2.0).abs() + rest.z.abs();
            if off < widest[side] {
                widest[side] = off;
                sides[side] = Some(*moved);
            }
        }
    }
    sides[0].unwrap().distance(sides[1].unwrap())
}

/// By how much joints are turned, degrees; the least width as a share of that at rest; the largest share of triangles that are turned
/// over.
const LIMITS: [(f64, f64, f64); 4] = [
    (30.0, 0.90, 0.0),
    (60.0, 0.90, 0.002),
    (90.0, 0.85, 0.02),
    (120.0, 0.70, 0.05),
];

/// Limbs of all kinds: straight and bowed, tapered and even.
fn limbs() -> Vec<Outline> {
    let mut random = fastrand::Rng::with_seed(5);
    let mut limbs = Vec::new();
    for _ in 0..60 {
        let length = 80.0 + 120.0 * random.f64();
        let wide = length / (2.6 + 5.0 * random.f64());
        let taper = 0.4 * random.f64();
        let bow = 0.3 * (random.f64() - 0.5);
        limbs.push(limb(length, |share| wide * (1.0 - taper * share), bow));
    }
    limbs
}

#[test]
fn at_rest_a_part_is_as_drawn() {
    for outline in limbs() {
        for kind in ["inflate", "default"] {
            let bent = bent(&outline, kind, Bend::limb);
            let [rest, drawn] = [&bent.surface, &bent.rigid].map(at_rest);
            let [rest_volume, drawn_volume] = [
                volume(&rest, &bent.surface.triangles),
                volume(&drawn, &bent.rigid.triangles),
            ];
            assert!((rest_volume / drawn_volume - 1.0).abs() < 1e-5);
            // No corner is lost, and none moves.
            assert_eq!(rest[..drawn.len()], drawn);
            let moved = bent.posed(DVec3::Z, 0.0);
            let farthest = moved.iter().zip(&rest).map(|(a, b)| a.distance(*b));
            assert!(farthest.fold(0.0, f64::max) < 1e-4);
        }
    }
}

#[test]
fn every_edge_has_two_triangles_after_cutting() {
    use rustc_hash::FxHashMap;
    for outline in limbs().iter().take(20) {
        for kind in ["inflate", "default"] {
            let bent = bent(outline, kind, Bend::limb);
            let place = |corner: u32| bent.surface.positions[corner as usize].map(f32::to_bits);
            let mut edges: FxHashMap<_, i32> = FxHashMap::default();
            for triangle in &bent.surface.triangles {
                for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                    let [a, b] = [triangle[a], triangle[b]].map(place);
                    *edges
                        .entry(if a < b { (a, b) } else { (b, a) })
                        .or_default() += if a < b { 1 } else { -1 };
                }
            }
            assert!(edges.values().all(|sum| *sum == 0));
        }
    }
}

#[test]
fn a_bent_limb_keeps_its_width_and_volume() {
    let limbs: Vec<[Bent; 2]> = limbs()
        .iter()
        .map(|outline| ["inflate", "default"].map(|kind| bent(outline, kind, Bend::limb)))
        .collect();
    let mut volume = 0.0_f64;
    for (degrees, least, most) in LIMITS {
        let measured = measure(limbs.iter().flatten(), degrees);
        volume = volume.max(measured.volume);
        assert!(measured.narrowest >= least && measured.folded <= most);
    }
    assert!(volume < 0.11, "{volume}");
}

/// What becomes of limbs where their joints are turned by an angle to both sides and about the viewer axis and an axis of the drawing.
struct Measured {
    /// The least width at a joint, as a share of that at rest.
    narrowest: f64,
    /// The share of triangles that are turned over.
    folded: f64,
    /// By how much a volume changes at most.
    volume: f64,
}

fn measure<'a>(limbs: impl Iterator<Item = &'a Bent>, degrees: f64) -> Measured {
    let (mut narrowest, mut volumes, mut folded, mut all) = (1.0_f64, 0.0_f64, 0, 0);
    for bent in limbs {
        let rest = at_rest(&bent.surface);
        let triangles = &bent.surface.triangles;
        for (sign, axis) in [(1.0, DVec3::Z), (-1.0, DVec3::Z), (1.0, DVec3::X)] {
            let turn = sign * degrees.to_radians();
            let moved = bent.posed(axis, turn);
            let width = width_at_joint(bent, &moved) / width_at_joint(bent, &rest);
            narrowest = narrowest.min(width);
            let change = volume(&moved, triangles) / volume(&rest, triangles) - 1.0;
            volumes = volumes.max(change.abs());
            folded += bent.folded(&moved, axis, turn);
            all += triangles.len();
        }
    }
    let measured = Measured {
        narrowest,
        folded: folded as f64 / all as f64,
        volume: volumes,
    };
    println!(
        "{degrees}°: {:.3} of the width, {:.4} turned over, {:.3} of the volume",
        measured.narrowest, measured.folded, measured.volume
    );
    measured
}

/// Measures 40 slender shapes of the drawings in the folder that LOOK_DIR names, as if they were limbs that hang on the middle of their
/// drawing. Every second one is reported for itself: what was chosen by looking at the others is judged by these.
#[test]
#[ignore = "needs drawings in LOOK_DIR"]
fn limbs_of_clip_art() {
    const COUNT: usize = 40;
    let folder = std::env::var_os("LOOK_DIR").expect("LOOK_DIR is a folder of drawings");
    let files = std::fs::read_dir(folder).unwrap();
    let mut files: Vec<_> = files.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let mut found = Vec::new();
    for file in files {
        let Ok(text) = std::fs::read_to_string(&file) else {
            continue;
        };
        let compiled = compile(&text, &Default::default(), &MemoryResolver::default());
        let parts = &compiled.bindings.parts;
        let middle =
            parts.iter().map(|part| part.measure.center).sum::<DVec2>() / parts.len().max(1) as f64;
        for part in parts {
            let is_plain = matches!(&part.outline.polygons[..], [one] if one.rings.len() == 1);
            let ends = part.measure.ends;
            let joint = if ends[0].distance(middle) < ends[1].distance(middle) {
                ends[0]
            } else {
                ends[1]
            };
            let line = Centerline::new(&part.outline, y_up(joint));
            let is_limb = |line: &Centerline| (2.2..9.0).contains(&(line.length() / line.width()));
            if is_plain && line.as_ref().is_some_and(is_limb) {
                found.push((Arc::clone(&part.outline), joint));
            }
        }
    }
    println!("{} slender shapes", found.len());
    assert!(found.len() >= COUNT, "too few: {}", found.len());
    let limbs: Vec<[Bent; 2]> = (0..COUNT)
        .map(|number| {
            let (outline, joint) = &found[number * found.len() / COUNT];
            ["inflate", "default"].map(|kind| bent_at(outline, *joint, kind, Bend::limb))
        })
        .collect();
    for (name, first) in [("seen", 0), ("held back", 1)] {
        println!("{name}:");
        for (degrees, least, most) in LIMITS {
            let half = limbs.iter().skip(first).step_by(2).flatten();
            let measured = measure(half, degrees);
            // Not all of them are limbs: some are wider at one end than they are long.
            assert!(measured.narrowest >= least && measured.folded <= most.max(0.03));
        }
    }
}

#[test]
fn an_elbow_is_where_the_drawing_bends() {
    let straight = limb(100.0, |_| 20.0, 0.0);
    let bend = Bend::limb(Centerline::new(&straight, DVec2::ZERO).unwrap());
    let middle = bend.nodes[1].position;
    assert!(middle.distance(DVec2::new(0.0, -50.0)) < 3.0, "{middle}");
    let points = [
        (0., 0.),
        (20., 0.),
        (20., 55.),
        (80., 55.),
        (80., 75.),
        (0., 75.),
    ];
    let ring = points.map(|(x, y)| DVec2::new(x, y)).to_vec();
    let bent = Outline {
        polygons: vec![Polygon { rings: vec![ring] }],
    };
    let bend = Bend::limb(Centerline::new(&bent, y_up(DVec2::new(10.0, 5.0))).unwrap());
    let elbow = bend.nodes[1].position;
    assert!(elbow.distance(DVec2::new(14.0, -61.0)) < 8.0, "{elbow}");
}

#[test]
fn a_chain_has_bones_of_one_length() {
    let outline = limb(200.0, |_| 16.0, 0.25);
    let bend = Bend::chain(Centerline::new(&outline, DVec2::ZERO).unwrap(), 4);
    assert_eq!(bend.nodes.len(), 4);
    let names: Vec<String> = bend.names("Tail").collect();
    assert_eq!(names, ["Tail.2", "Tail.3", "Tail.4", "Tail.5"]);
    let places: Vec<f64> = bend.nodes.iter().map(|node| node.at).collect();
    for pair in places.windows(2) {
        assert!((pair[1] - pair[0] - places[0]).abs() < 1e-9);
    }
    // As many as there is room for.
    let short = limb(60.0, |_| 20.0, 0.0);
    let bend = Bend::chain(Centerline::new(&short, DVec2::ZERO).unwrap(), 4);
    assert_eq!(bend.nodes.len(), 2);
}

#[test]
fn round_shapes_have_no_middle_line() {
    let ball: Vec<DVec2> = (0..40)
        .map(|step| 20.0 * DVec2::from_angle(PI * f64::from(step) / 20.0))
        .collect();
    let ball = Outline {
        polygons: vec![Polygon { rings: vec![ball] }],
    };
    let line = Centerline::new(&ball, DVec2::new(0.0, 20.0));
    assert!(line.is_none_or(|line| line.length() < 2.0 * line.width()));
    assert!(Centerline::new(&Outline::default(), DVec2::ZERO).is_none());
    // A frame so thin that of its grid a single cell is left.
    let thin = |inset: f64| {
        [(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)].map(|(x, y): (f64, f64)| {
            DVec2::new(x.clamp(inset, 100.0 - inset), y.clamp(inset, 100.0 - inset))
        })
    };
    let frame = Outline {
        polygons: vec![Polygon {
            rings: vec![thin(0.0).to_vec(), thin(0.05).into_iter().rev().collect()],
        }],
    };
    assert!(Centerline::new(&frame, DVec2::ZERO).is_none());
}

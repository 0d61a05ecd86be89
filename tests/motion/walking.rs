//! Figures with legs walk, run, trot and sneak without coming apart, and go where they look.
//!
//! What is measured are the models: by how much the gap between the meshes of a part and of what it hangs on grows, compared with the
//! model at rest, at 24 times of each clip.

use std::path::{Path, PathBuf};

use glam::DVec3;
use okoshi::FolderResolver;
use okoshi::compile::{Compiled, Options, compile};
use okoshi::diagnostic::Code;
use okoshi::internals::mocap::Transform;
use okoshi::internals::rig::FigureClip;
use okoshi::scene::{Animation, NodeId, Scene, TiVec, Values};

use crate::model::world;

/// The gaits.
const GAITS: [&str; 4] = ["walk", "run", "trot", "sneak"];
/// By how much a gap may grow, as a share of the figure's height.
const MAX_GROWTH: f64 = 0.03;
/// The times at which a clip is looked at.
const TIMES: usize = 24;
/// How many points of a part are compared with what it hangs on.
const POINTS: usize = 960;
/// The drawings of `tests/motion/figures` and of the examples in which a figure walks to a side: −1 to the drawing's left.
const PROFILES: [(&str, f64); 14] = [
    ("examples/clockwork-dragon.svg", 1.0),
    ("examples/dog.svg", 1.0),
    ("examples/motion/beetle.svg", 1.0),
    ("examples/motion/bird.svg", -1.0),
    ("examples/motion/dog.svg", 1.0),
    ("examples/motion/horse.svg", 1.0),
    ("examples/motion/spider.svg", -1.0),
    ("tests/motion/figures/bird.svg", 1.0),
    ("tests/motion/figures/cat.svg", 1.0),
    ("tests/motion/figures/dancer.svg", 1.0),
    ("tests/motion/figures/dog.svg", -1.0),
    ("tests/motion/figures/horse.svg", -1.0),
    ("tests/cases/facing-found/drawing.svg", -1.0),
    ("tests/cases/facing-said/drawing.svg", 1.0),
];
/// What stands on the ground without being alive: the wheels of a car.
const THINGS: [&str; 1] = ["examples/car.svg"];
/// A spider that is drawn from above without names, whose abdomen is taken for its head.
const HEAD_DOWN: [&str; 1] = ["tests/motion/figures/spider.svg"];
/// The least number of figures with legs.
const FEWEST: usize = 25;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The drawings whose figures walk.
fn drawings() -> Vec<PathBuf> {
    let folders = ["examples", "examples/motion", "tests/motion/figures"];
    let files = folders.iter().flat_map(|folder| {
        let entries = std::fs::read_dir(root().join(folder)).expect("a folder");
        entries.map(|entry| entry.expect("an entry").path())
    });
    let is_drawing = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "svg");
    let mut drawings: Vec<PathBuf> = files.filter(is_drawing).collect();
    let cases = [
        "tests/cases/facing-found/drawing.svg",
        "tests/cases/facing-said/drawing.svg",
    ];
    drawings.extend(cases.map(|case| root().join(case)));
    drawings.sort();
    drawings
}

/// A drawing whose figures all play the gaits.
fn walking(path: &Path) -> Compiled {
    let text = std::fs::read_to_string(path).expect("a drawing");
    let end = text.rfind("</svg>").expect("the end of the drawing");
    let gaits = GAITS.map(|gait| format!(" Motion {gait}")).concat();
    let string = format!("<text x='0' y='0' font-size='1'>%{gaits}</text>");
    let text = format!("{}{string}{}", &text[..end], &text[end..]);
    let folder = path.parent().expect("a folder");
    compile(&text, &Options::default(), &FolderResolver::new(folder))
}

/// The triangles of a node's mesh, in its frame.
fn triangles(scene: &Scene, node: NodeId) -> Vec<[DVec3; 3]> {
    let mesh = scene.nodes[node].mesh;
    let primitives = mesh
        .into_iter()
        .flat_map(|mesh| &scene.meshes[mesh].primitives);
    let triangles = primitives.flat_map(|primitive| {
        let surface = primitive.surface();
        let corner = |at: u32| DVec3::from(surface.positions[at as usize].map(f64::from));
        let triangles = surface.triangles.iter();
        triangles
            .map(|triangle| triangle.map(corner))
            .collect::<Vec<_>>()
    });
    triangles.collect()
}

/// The square of the distance from a point to a triangle (Ericson, *Real-Time Collision Detection*, 5.1.5).
fn distance_squared(point: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    let nearest = if d1 <= 0.0 && d2 <= 0.0 {
        a
    } else {
        let bp = point - b;
        let (d3, d4) = (ab.dot(bp), ac.dot(bp));
        let cp = point - c;
        let (d5, d6) = (ab.dot(cp), ac.dot(cp));
        let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
        if d3 >= 0.0 && d4 <= d3 {
            b
        } else if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            a + ab * (d1 / (d1 - d3))
        } else if d6 >= 0.0 && d5 <= d6 {
            c
        } else if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            a + ac * (d2 / (d2 - d6))
        } else if va <= 0.0 && d4 >= d3 && d5 >= d6 {
            b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))
        } else {
            let whole = va + vb + vc;
            a + ab * (vb / whole) + ac * (vc / whole)
        }
    };
    point.distance_squared(nearest)
}

/// A part that turns, and what it hangs on.
struct Pair {
    nodes: [NodeId; 2],
    /// Points of the part's mesh, those first that are nearest to what it hangs on.
    points: Vec<DVec3>,
    below: Vec<[DVec3; 3]>,
    at_rest: f64,
}

impl Pair {
    fn of(scene: &Scene, rest: &TiVec<NodeId, Transform>, nodes: [NodeId; 2]) -> Option<Self> {
        let [own, below] = nodes.map(|node| triangles(scene, node));
        let middles = own.iter().map(|[a, b, c]| (*a + *b + *c) / 3.0);
        let sides = own
            .iter()
            .flat_map(|[a, b, c]| [(*a + *b) / 2.0, (*b + *c) / 2.0]);
        let all: Vec<DVec3> = own
            .iter()
            .flatten()
            .copied()
            .chain(middles)
            .chain(sides)
            .collect();
        let step = all.len().div_ceil(POINTS).max(1);
        let mut pair = Self {
            nodes,
            points: all.into_iter().step_by(step).collect(),
            below,
            at_rest: 0.0,
        };
        let gap = |pair: &Self, point: DVec3| pair.gap_of(point, rest, 0.0);
        let mut gaps: Vec<(f64, DVec3)> = pair
            .points
            .iter()
            .map(|point| (gap(&pair, *point), *point))
            .collect();
        gaps.sort_by(|a, b| a.0.total_cmp(&b.0));
        pair.at_rest = gaps.first()?.0;
        pair.points = gaps.into_iter().map(|(_, point)| point).collect();
        pair.at_rest.is_finite().then_some(pair)
    }

    /// The distance of a point of the part from what it hangs on, or any that is at most `enough`.
    fn gap_of(&self, point: DVec3, world: &TiVec<NodeId, Transform>, enough: f64) -> f64 {
        let [own, below] = self.nodes.map(|node| world[node]);
        let point = own.rotation * point + own.position;
        let point = below.rotation.inverse() * (point - below.position);
        let mut least = f64::INFINITY;
        for triangle in &self.below {
            least = least.min(distance_squared(point, *triangle).sqrt());
            if least <= enough {
                break;
            }
        }
        least
    }

    /// The gap between both, or any that is at most `enough`.
    fn gap(&self, world: &TiVec<NodeId, Transform>, enough: f64) -> f64 {
        let mut least = f64::INFINITY;
        for point in &self.points {
            least = least.min(self.gap_of(*point, world, enough));
            if least <= enough {
                break;
            }
        }
        least
    }
}

/// The greatest extent upwards of some nodes' meshes.
fn height(scene: &Scene, rest: &TiVec<NodeId, Transform>) -> f64 {
    let heights = scene.nodes.keys().flat_map(|node| {
        let placed = rest[node];
        let corners = triangles(scene, node).into_iter().flatten();
        let heights = corners.map(|corner| (placed.rotation * corner + placed.position).y);
        heights.collect::<Vec<_>>()
    });
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| {
        (low.min(y), high.max(y))
    });
    high - low
}

/// The parts that a clip takes off what they hang on: what they are called, and by how much, as shares of the height.
fn loose(scene: &Scene, clip: &Animation) -> Vec<(String, f64)> {
    let rest = world(scene, &Animation::default(), 0);
    let allowed = MAX_GROWTH * height(scene, &rest);
    let keys = clip
        .tracks
        .iter()
        .map(|track| track.timing.times.len())
        .min()
        .unwrap_or(0);
    let poses = (0..TIMES).map(|time| world(scene, clip, time * (keys - 1) / (TIMES - 1)));
    let poses: Vec<_> = poses.collect();
    let turns = |node: NodeId| clip.tracks.iter().any(|track| track.node == node);
    let mut found = Vec::new();
    for (parent, node) in scene.nodes.iter_enumerated() {
        for child in node.children.iter().copied().filter(|child| turns(*child)) {
            let Some(pair) = Pair::of(scene, &rest, [child, parent]) else {
                continue;
            };
            let enough = pair.at_rest + allowed;
            let gaps = poses.iter().map(|world| pair.gap(world, enough));
            let most = gaps.fold(0.0, f64::max);
            if most > enough {
                let growth = (most - pair.at_rest) / allowed * MAX_GROWTH;
                found.push((scene.nodes[child].name.clone(), growth));
            }
        }
    }
    found
}

/// How far a node travels in a clip.
fn travel(scene: &Scene, clip: &Animation, node: &str) -> DVec3 {
    let mut ways = clip.tracks.iter().filter_map(|track| match &track.values {
        Values::Translations(places) if scene.nodes[track.node].name == node => {
            Some(*places.last()? - *places.first()?)
        }
        _ => None,
    });
    ways.next().unwrap_or_default()
}

#[test]
fn figures_with_legs_hold_together_and_go_where_they_look() {
    let mut figures = 0;
    let mut profiles = 0;
    for path in drawings() {
        let name = path.strip_prefix(root()).expect("a path of the project");
        let name = name.to_string_lossy().replace('\\', "/");
        if THINGS.contains(&&*name) {
            continue;
        }
        let compiled = walking(&path);
        let has_legs = |clip: &&FigureClip| {
            let mut parts = clip.parts.iter();
            clip.file == "walk" && parts.any(|drive| drive.why.contains("UpLeg"))
        };
        let Some(walk) = compiled.clips.iter().find(has_legs) else {
            continue;
        };
        let root = &compiled.bindings.parts[walk.root].name;
        figures += 1;
        let said = compiled
            .diagnostics
            .iter()
            .filter(|found| found.code == Code::ComesOff);
        let said: Vec<&str> = said.map(|found| found.message.as_str()).collect();
        assert_eq!(said, [""; 0], "{name}");
        let scene = &compiled.scene;
        for gait in GAITS {
            let clip = scene
                .animations
                .iter()
                .find(|clip| clip.name.starts_with(gait));
            let clip = clip.expect("the gait");
            assert_eq!(loose(scene, clip), [], "{name}: {gait}");
            let way = travel(scene, clip, root).normalize_or_zero();
            let profile = PROFILES.iter().find(|(drawing, _)| *drawing == name);
            let toward = match profile {
                Some((_, side)) => DVec3::X * *side,
                None if HEAD_DOWN.contains(&&*name) => DVec3::NEG_Z,
                None => DVec3::Z,
            };
            assert!(way.dot(toward) > 0.9, "{name}: {gait} goes along {way}");
        }
        profiles += usize::from(PROFILES.iter().any(|(drawing, _)| *drawing == name));
    }
    eprintln!("{figures} figures with legs, {profiles} of them in profile");
    assert!(figures >= FEWEST, "only {figures} figures");
    assert_eq!(profiles, PROFILES.len());
}

/// The measure finds what comes off: an arm that turns about a point beside the body.
#[test]
fn a_part_that_comes_off_is_found() {
    let case = root().join("tests/cases/motion-comes-off/drawing.svg");
    let compiled = walking(&case);
    let scene = &compiled.scene;
    let clip = scene.animations.iter().find(|clip| clip.name == "walk");
    let found = loose(scene, clip.expect("a walk"));
    let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["Larm"]);
    assert!(found[0].1 > 0.08, "{found:?}");
}

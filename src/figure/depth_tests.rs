//! Where parts of figures are in depth by what they are: arms over a trunk, hats, skirts, the necks of animals.

use glam::{DAffine3, DQuat, DVec2, DVec3};
use rustc_hash::FxHashMap;

use crate::compile::{Options, compile};
use crate::resolver::MemoryResolver;
use crate::scene::{NodeId, Scene};

/// Cells a centimetre.
const FINE: f64 = 1.0;

/// The highest depths over the cells of a grid, centimetres.
type DepthMap = FxHashMap<[i32; 2], f64>;

fn figure(shapes: &[String]) -> Scene {
    let source = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="240" height="240">{}</svg>"#,
        shapes.concat()
    );
    compile(&source, &Options::default(), &MemoryResolver::default()).scene
}

fn shape(name: &str, path: &str) -> String {
    format!(r#"<path id="{name}" d="{path}"/>"#)
}

/// Calls `each` for the triangles of all nodes, one of which is turned by these degrees; centimetres.
fn triangles(
    scene: &Scene,
    (turned, degrees): (&str, f64),
    mut each: impl FnMut(&str, [DVec3; 3]),
) {
    let mut open: Vec<(NodeId, DAffine3)> = Vec::new();
    let is_child = |id: NodeId| scene.nodes.iter().any(|node| node.children.contains(&id));
    open.extend(
        scene
            .nodes
            .keys()
            .filter(|id| !is_child(*id))
            .map(|id| (id, DAffine3::IDENTITY)),
    );
    while let Some((id, above)) = open.pop() {
        let node = &scene.nodes[id];
        let mut own = above * DAffine3::from_rotation_translation(node.rotation, node.translation);
        if node.name == turned {
            own *= DAffine3::from_quat(DQuat::from_rotation_z(degrees.to_radians()));
        }
        open.extend(node.children.iter().map(|child| (*child, own)));
        let Some(mesh) = node.mesh else { continue };
        for primitive in &scene.meshes[mesh].primitives {
            let surface = primitive.surface();
            let at = |i: u32| {
                let place = surface.positions[i as usize].map(f64::from);
                own.transform_point3(DVec3::from(place)) * 100.0
            };
            for triangle in &surface.triangles {
                each(&node.name, triangle.map(at));
            }
        }
    }
}

fn cover(map: &mut DepthMap, [a, b, c]: [DVec3; 3]) {
    let normal = (b - a).cross(c - a);
    if normal.z.abs() < 1e-9 {
        return;
    }
    let [low, high] = [a.min(b).min(c), a.max(b).max(c)].map(|at| at.truncate() * FINE);
    for x in low.x.ceil() as i32..=high.x.floor() as i32 {
        for y in low.y.ceil() as i32..=high.y.floor() as i32 {
            let point = DVec2::new(x.into(), y.into()) / FINE;
            let side = |from: DVec3, to: DVec3| {
                (to - from).truncate().perp_dot(point - from.truncate()) * normal.z.signum()
            };
            if side(a, b) < 0.0 || side(b, c) < 0.0 || side(c, a) < 0.0 {
                continue;
            }
            let off = point - a.truncate();
            let depth = a.z - (normal.x * off.x + normal.y * off.y) / normal.z;
            let highest = map.entry([x, y]).or_insert(f64::NEG_INFINITY);
            *highest = highest.max(depth);
        }
    }
}

/// The share of an arm that is inside the trunk, seen from the front.
fn swallowed(scene: &Scene, arm: &str, degrees: f64) -> f64 {
    let mut maps: FxHashMap<String, DepthMap> = FxHashMap::default();
    triangles(scene, (arm, degrees), |name, triangle| {
        cover(maps.entry(name.to_owned()).or_default(), triangle);
    });
    let (arm, trunk) = (&maps[arm], &maps["Body"]);
    let is_inside =
        |(cell, depth): &(&[i32; 2], &f64)| trunk.get(*cell).is_some_and(|trunk| trunk > *depth);
    arm.iter().filter(is_inside).count() as f64 / arm.len() as f64
}

/// How deep and how wide a model is.
fn depth_and_width(scene: &Scene) -> [f64; 2] {
    let mut ends = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    triangles(scene, ("", 0.0), |_, corners| {
        for at in corners {
            ends = [ends[0].min(at), ends[1].max(at)];
        }
    });
    let size = ends[1] - ends[0];
    [size.z, size.x]
}

const HEAD: &str = "M100 48 a20 20 0 1 1 .1 0z";

#[test]
fn arms_over_a_trunk_have_room_to_turn() {
    let trunks = [
        "M60 120 a40 60 0 1 1 80 0 a40 60 0 1 1 -80 0z",
        "M52 130 a48 48 0 1 1 96 0 a48 48 0 1 1 -96 0z",
        "M80 60 q20 -10 40 0 l24 120 q-44 10 -88 0z",
    ];
    let arms = [
        // Folded before the belly, before the chest, hanging.
        "M66 84 q8 -8 12 2 l26 44 q2 12 -10 8 z",
        "M72 80 q8 -8 14 2 l34 14 q4 14 -10 10z",
        "M72 76 q12 -4 14 8 l0 60 q-8 10 -16 0z",
    ];
    // The other arm, so that the figure is as wide as people are who stretch one out.
    let other = || shape("Right_arm", "M112 84 q12 -4 14 8 l106 20 q-4 10 -12 4z");
    let mut shares = [Vec::new(), Vec::new()];
    for trunk in trunks {
        for arm in arms {
            for order in 0..3 {
                for (without, shares) in shares.iter_mut().enumerate() {
                    if without == 1 && order > 0 {
                        continue;
                    }
                    let [body, head, arm] = [("Body", trunk), ("Head", HEAD), ("Left_arm", arm)]
                        .map(|(name, path)| shape(name, path));
                    let in_order = match order {
                        0 => [body, head, arm, other()],
                        1 => [head, body, other(), arm],
                        _ => [other(), body, arm, head],
                    };
                    let text = match without {
                        0 => String::new(),
                        _ => r#"<text x="10" y="230">%Stack 0</text>"#.to_owned(),
                    };
                    let scene = figure(&[in_order.concat(), text]);
                    let [depth, width] = depth_and_width(&scene);
                    assert!(depth <= 0.61 * width, "{trunk} {depth} {width}");
                    assert!(swallowed(&scene, "Left_arm", 0.0) < 0.01, "{trunk}");
                    let turns = [-60.0, 60.0];
                    shares.extend(turns.map(|degrees| swallowed(&scene, "Left_arm", degrees)));
                }
            }
        }
    }
    let [mean, flat] = [0, 1].map(|i| shares[i].iter().sum::<f64>() / shares[i].len() as f64);
    let worst = shares[0].iter().copied().fold(0.0, f64::max);
    assert!(
        mean < 0.08 && worst < 0.45 && flat > 0.2,
        "{mean} {worst} {flat}"
    );
}

/// The least and the greatest depth of a node between two shares of its height, and how wide it is there.
fn girth(scene: &Scene, name: &str, [from, to]: [f64; 2]) -> [f64; 3] {
    let mut corners = Vec::new();
    triangles(scene, ("", 0.0), |node, triangle| {
        if node == name {
            corners.extend(triangle);
        }
    });
    let heights = || corners.iter().map(|at| at.y);
    let (low, high) = (
        heights().fold(f64::INFINITY, f64::min),
        heights().fold(f64::NEG_INFINITY, f64::max),
    );
    let band = [from, to].map(|share| low + share * (high - low));
    let near = corners
        .iter()
        .filter(|at| (band[0]..=band[1]).contains(&at.y));
    let mut ends = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    for at in near {
        ends = [ends[0].min(*at), ends[1].max(*at)];
    }
    [ends[0].z, ends[1].z, ends[1].x - ends[0].x]
}

fn with_text(shapes: &[String], text: &str) -> Scene {
    let text = format!(r#"<text x="10" y="230">{text}</text>"#);
    figure(&[shapes.concat(), text])
}

fn person(more: &[String]) -> Vec<String> {
    let mut shapes = vec![
        shape("Left_leg", "M84 150 h12 v60 q-6 4 -12 0z"),
        shape("Right_leg", "M104 150 h12 v60 q-6 4 -12 0z"),
        shape("Left_arm", "M78 96 q-8 -8 -40 20 q-4 8 6 8z"),
        shape("Right_arm", "M122 96 q8 -8 40 20 q4 8 -6 8z"),
        shape("Body", "M78 96 q22 -10 44 0 q4 30 0 60 h-44 q-4 -30 0 -60z"),
        shape("Head", "M72 64 a28 28 0 1 1 56 0 a28 28 0 1 1 -56 0z"),
    ];
    shapes.extend(more.iter().cloned());
    shapes
}

#[test]
fn hats_are_around_heads() {
    for (name, path) in [
        (
            "Hat",
            "M68 52 q0 -40 32 -40 q32 0 32 40 q16 2 16 8 h-96 q0 -6 16 -8z",
        ),
        (
            "Witch_hat",
            "M100 2 q-8 20 -30 46 q-28 4 -30 12 q60 10 120 0 q-2 -8 -30 -12 q-22 -26 -30 -46z",
        ),
        (
            "Crown",
            "M70 56 l-4 -36 l18 16 l16 -24 l16 24 l18 -16 l-4 36 q-30 -8 -60 0z",
        ),
    ] {
        let shapes = person(&[shape(name, path)]);
        let scene = figure(&shapes);
        // From the hat's lower border on, about .6 of the head's height.
        let [head_back, head_front, _] = girth(&scene, "Head", [0.65, 1.0]);
        let [back, front, wide] = girth(&scene, name, [0.0, 0.3]);
        assert!(
            front >= head_front - 0.5 && back <= head_back + 0.5,
            "{name}: {back} {front} {head_back} {head_front}"
        );
        assert!(front - back <= 1.05 * wide, "{name}");
        let [depth, width] = depth_and_width(&scene);
        assert!(depth <= 0.62 * width, "{name}: {depth} {width}");
        let [back, _, _] = girth(&with_text(&shapes, "%Shape inflate"), name, [0.0, 0.3]);
        assert!(back > head_back + 4.0, "{name}: {back}");
    }
}

#[test]
fn skirts_and_trousers_are_round_about_the_hips() {
    let skirt = person(&[shape("Skirt", "M78 140 h44 l22 44 q-44 8 -88 0z")]);
    let thickness = |scene: &Scene, name: &str, band: [f64; 2]| {
        let [back, front, wide] = girth(scene, name, band);
        [front - back, wide]
    };
    let [hem, hem_width] = thickness(&figure(&skirt), "Skirt", [0.0, 0.2]);
    assert!(hem > 0.6 * hem_width, "{hem} {hem_width}");
    let [depth, width] = depth_and_width(&figure(&skirt));
    assert!(depth <= 0.62 * width, "{depth} {width}");
    let [closed, _] = thickness(&with_text(&skirt, "%Shape inflate"), "Skirt", [0.0, 0.02]);
    let [hem, _] = thickness(&figure(&skirt), "Skirt", [0.0, 0.02]);
    assert!(closed < 0.7 * hem, "{closed} {hem}");
    let trousers = person(&[shape(
        "Trousers",
        "M76 148 h48 l2 68 h-22 l-4 -40 l-4 40 h-22z",
    )]);
    let scene = figure(&trousers);
    let [hips, wide] = thickness(&scene, "Trousers", [0.8, 0.95]);
    assert!((0.5..1.1).contains(&(hips / wide)), "{hips} {wide}");
    let [legs, wide] = thickness(&scene, "Trousers", [0.1, 0.3]);
    assert!((0.3..0.6).contains(&(legs / wide)), "{legs} {wide}");
}

#[test]
fn neck_and_head_of_an_animal_in_profile_stay_in_its_plane() {
    let horse = |of_neck: &str| {
        [
            shape("Tail", "M186 92 q30 6 22 60 q-12 4 -10 -10 q0 -30 -16 -36z"),
            shape("Far_front_leg", "M92 130 h16 v76 h-16z"),
            shape("Far_hind_leg", "M156 130 h16 v76 h-16z"),
            shape("Body", "M72 116 a62 34 0 1 1 124 0 a62 34 0 1 1 -124 0z"),
            shape("Near_front_leg", "M82 124 q10 -6 18 0 v90 h-16z"),
            shape("Near_hind_leg", "M166 120 q12 -6 22 2 l-2 92 h-16z"),
            shape("Neck", "M84 124 q-26 -40 -22 -74 q16 -10 28 0 q4 30 34 44z")
                .replace("/>", &format!(">{of_neck}</path>")),
            shape(
                "Head",
                "M88 44 q-10 -16 -28 -4 q-30 20 -40 42 q4 14 20 8 q20 -8 38 -14 q16 -12 10 -32z",
            ),
            r#"<circle cx="62" cy="56" r="4"/>"#.to_owned(),
        ]
    };
    let depth = |scene: &Scene, name: &str| {
        let mut nodes = scene.nodes.iter();
        nodes.find(|node| node.name == name).unwrap().translation.z * 100.0
    };
    let scene = figure(&horse(""));
    for name in ["Tail", "Neck", "Head"] {
        assert!(
            depth(&scene, name).abs() < 1e-9,
            "{name}: {}",
            depth(&scene, name)
        );
    }
    let legs = [
        "Near_front_leg",
        "Near_hind_leg",
        "Far_front_leg",
        "Far_hind_leg",
    ];
    let [near_front, near_hind, far_front, far_hind] = legs.map(|leg| depth(&scene, leg));
    assert!(
        near_front > 5.0 && near_hind > 5.0,
        "{near_front} {near_hind}"
    );
    assert!(
        far_front < -5.0 && far_hind < -5.0,
        "{far_front} {far_hind}"
    );
    let moved = depth(&figure(&horse("<desc>Neck@Body$Stack 1</desc>")), "Neck");
    assert!(moved > 5.0, "{moved}");
}

//! Drawings that play motions, through the whole compiler: the model's nodes point where bones do.

use std::collections::BTreeMap;
use std::path::Path;

use glam::{DQuat, DVec2, DVec3};
use okoshi::FolderResolver;
use okoshi::compile::{Compiled, Options, compile};
use okoshi::internals::bind::PartId;
use okoshi::internals::labels::Facing;
use okoshi::internals::mocap::{Clip, JointId, Pose, Transform};
use okoshi::internals::retarget::Landmarks;
use okoshi::internals::rig::FigureClip;
use okoshi::scene::{Animation, Interpolation, NodeId, Scene, TiVec, Values};

use crate::retarget::clips::clip;
use crate::retarget::splayed::{SplayedLeg, Steps};
use crate::retarget::{Body, angle};

/// The drawings of the examples, and the direction that each faces.
const DRAWINGS: [(&str, Facing); 7] = [
    ("ant", Facing::Viewer),
    ("beetle", Facing::Right),
    ("boxer", Facing::Viewer),
    ("dog", Facing::Right),
    ("kick", Facing::Viewer),
    ("robot-ja", Facing::Viewer),
    ("stick", Facing::Viewer),
];

/// Tolerance of directions, degrees; keys are rounded when they are written.
const OFF: f64 = 0.05;

fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("examples/motion/{name}.svg"));
    std::fs::read_to_string(path).expect("the example")
}

fn compiled(text: &str) -> Compiled {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/motion");
    compile(text, &Options::default(), &FolderResolver::new(&folder))
}

/// The world transforms of the nodes at a key of a clip.
pub(crate) fn world(scene: &Scene, clip: &Animation, key: usize) -> TiVec<NodeId, Transform> {
    let mut local: TiVec<NodeId, Transform> = scene
        .nodes
        .iter()
        .map(|node| Transform {
            rotation: node.rotation,
            position: node.translation,
        })
        .collect();
    for track in &clip.tracks {
        match &track.values {
            Values::Rotations(turns) => local[track.node].rotation = turns[key],
            Values::Translations(places) => local[track.node].position = places[key],
            other => panic!("{other:?} of a figure"),
        }
    }
    let mut world = local.clone();
    let mut stack = scene.roots.clone();
    while let Some(node) = stack.pop() {
        for &child in &scene.nodes[node].children {
            let above = world[node];
            world[child] = Transform {
                rotation: above.rotation * local[child].rotation,
                position: above.position + above.rotation * local[child].position,
            };
            stack.push(child);
        }
    }
    world
}

/// The joint of a name.
fn joint(clip: &Clip, name: &str) -> JointId {
    let joints = &clip.skeleton.joints;
    joints
        .position(|joint| joint.name == name)
        .unwrap_or_else(|| panic!("no joint `{name}`"))
}

/// The direction of the chain that a part follows, parsed from the reported reason.
fn chain(clip: &Clip, pose: &Pose, why: &str) -> Option<DVec3> {
    let ways = ["it points from `", "it turns like the line from `"];
    let (_, way) = ways.iter().find_map(|way| why.split_once(way))?;
    let (from, to) = way.split_once("` to ")?;
    let to = to.split_once(';').map_or(to, |(to, _)| to);
    let from = pose[joint(clip, from)].position;
    let to = match to.strip_prefix("the end of `") {
        Some(of) => {
            let of = joint(clip, of.trim_end_matches('`'));
            pose[of].position + pose[of].rotation * clip.skeleton.joints[of].ends[0]
        }
        None => pose[joint(clip, to.trim_matches('`'))].position,
    };
    Some(to - from)
}

/// The axis of a part in the drawing's axes: from its joint to its far end.
fn axis(compiled: &Compiled, part: PartId) -> DVec3 {
    let part = &compiled.bindings.parts[part];
    let flip = |point: DVec2| DVec2::new(point.x, -point.y);
    let origin = flip(part.origin);
    let [a, b] = part.measure.ends.map(flip);
    let far = if a.distance(origin) > b.distance(origin) {
        a
    } else {
        b
    };
    (far - origin).extend(0.0)
}

/// The leg that a part is if it keeps its drawn pose.
fn splayed_leg(compiled: &Compiled, clip: &Clip, part: PartId, why: &str) -> Option<SplayedLeg> {
    if !why.contains("keeps its drawn pose") {
        return None;
    }
    let (_, ends) = why.split_once("it turns like the line from `")?;
    let (hip, ankle) = ends.split_once("` to `")?;
    let ankle = ankle.split_once('`').map_or(ankle, |(ankle, _)| ankle);
    Some(SplayedLeg {
        hip: joint(clip, hip),
        ankle: joint(clip, ankle),
        points: axis(compiled, part),
    })
}

/// The largest angle between the parts of a drawing and their bones; `turn` rotates the drawing's axes to the world's.
fn worst(compiled: &Compiled, figure_clip: &FigureClip, facing: Facing, turn: DQuat) -> f64 {
    let prepared = clip(&format!("examples/motion/{}", figure_clip.file));
    let clip = &prepared.clip;
    let body = Body::of(clip, &Landmarks::of(&prepared.anatomy), facing);
    let first = clip.pose(0);
    let full = &figure_clip.full_animation();
    let nodes = compiled.scene.nodes.iter_enumerated();
    let names: BTreeMap<&str, NodeId> = nodes.map(|(id, node)| (&*node.name, id)).collect();
    let nodes = compiled.scene.nodes.iter_enumerated();
    let parents: BTreeMap<NodeId, NodeId> = nodes
        .flat_map(|(id, node)| node.children.iter().map(move |child| (*child, id)))
        .collect();
    let rest = {
        let still = Animation::default();
        world(&compiled.scene, &still, 0)
    };
    let legs = figure_clip.parts.iter();
    let legs: Vec<SplayedLeg> = legs
        .filter_map(|drive| splayed_leg(compiled, clip, drive.part, &drive.why))
        .collect();
    let steps = Steps::of(clip, &body, &legs);
    let mut worst = 0.0_f64;
    let (mut looked_at, mut splayed, mut moved) = (0, 0, 0);
    for frame in 0..clip.frames {
        let pose = clip.pose(frame);
        let now = world(&compiled.scene, full, frame);
        for drive in &figure_clip.parts {
            let name = &*compiled.bindings.parts[drive.part].name;
            let Some(way) = chain(clip, &pose, &drive.why) else {
                continue;
            };
            let node = names[name];
            let off = figure_clip.turned(drive.part, frame);
            // The part's axis points like the chain, or its far end moves as the chain's if it keeps its drawn pose.
            let points = axis(compiled, drive.part);
            let leg = splayed_leg(compiled, clip, drive.part, &drive.why);
            splayed += usize::from(leg.is_some());
            let way = leg.map_or(way, |leg| steps.due(&leg, &pose));
            let own = rest[node].rotation.inverse() * (turn * points);
            let away = angle(now[node].rotation * own, turn * body.drawn(&first, way));
            worst = worst.max((away - off).max(0.0));
            moved += usize::from(off > 1.0);
            looked_at += 1;
            if let Some(copy) = names.get(&*format!("{name}.back")) {
                // A copy is the mirror image of the original, in the plane of what both are attached to.
                let mut above = parents[copy];
                while compiled.scene.nodes[above].name.ends_with(".back") {
                    above = parents[&above];
                }
                let frame = now[above].rotation;
                let mirrored =
                    frame.inverse() * (now[node].rotation * own) * DVec3::new(1.0, 1.0, -1.0);
                let own = rest[*copy].rotation.inverse() * (turn * points);
                worst = worst.max(angle(now[*copy].rotation * own, frame * mirrored));
            }
        }
    }
    assert!(looked_at >= 4 * clip.frames, "only {looked_at} directions");
    // Most parts point where the motion says; the others have made room. A dog's hind and fore legs reach down differently far, so that
    // those of one pair bend wherever both stand.
    assert!(
        5 * moved <= 3 * looked_at,
        "{moved} of {looked_at} have made room"
    );
    let is_beetle = compiled
        .bindings
        .parts
        .iter()
        .filter(|part| part.name.contains("eg"))
        .count()
        >= 6;
    assert_eq!(
        splayed > 0,
        is_beetle,
        "{splayed} directions of splayed limbs"
    );
    worst
}

#[test]
fn nodes_point_where_bones_do() {
    for (name, facing) in DRAWINGS {
        let compiled = compiled(&text(name));
        assert!(
            !compiled.clips.is_empty(),
            "{name}: {:?}",
            compiled.diagnostics
        );
        for figure_clip in &compiled.clips {
            let off = worst(&compiled, figure_clip, facing, DQuat::IDENTITY);
            eprintln!("{name}, {}: {off:.2e}°", figure_clip.name);
            assert!(off < OFF, "{name}, {}: {off}°", figure_clip.name);
        }
    }
}

/// A drawing with other axes, in another unit.
#[test]
fn axes_and_scale_of_the_drawing_do_not_matter() {
    // Right, up and front of the drawing, as the model's world has them.
    let turn = |right, up, front| DQuat::from_mat3(&glam::DMat3::from_cols(right, up, front));
    let turns = [
        ("+x +z -y", turn(DVec3::X, DVec3::Z, DVec3::NEG_Y)),
        ("-z +y +x", turn(DVec3::NEG_Z, DVec3::Y, DVec3::X)),
    ];
    for (name, facing) in DRAWINGS {
        for (axes, turn) in &turns {
            let text = text(name);
            let changed = text.replacen("Scale 0.", &format!("Axes {axes} Scale 7."), 1);
            assert!(changed != text, "{name} has no scale");
            let compiled = compiled(&changed);
            assert!(!compiled.has_errors(), "{name}: {:?}", compiled.diagnostics);
            for figure_clip in &compiled.clips {
                let off = worst(&compiled, figure_clip, facing, *turn);
                eprintln!("{name}, {}, {axes}: {off:.2e}°", figure_clip.name);
                assert!(off < OFF, "{name}, {}, {axes}: {off}°", figure_clip.name);
            }
        }
    }
}

#[test]
fn doubled_limbs_are_mirrored() {
    let text = text("kick").replace("Lleg@Hips", "Lleg@Hips$Shape -d default 5 9");
    let text = text.replace("Larm@Body", "Larm@Body$Shape -d roundv Offset 12");
    let compiled = compiled(&text);
    let copies = compiled
        .scene
        .nodes
        .iter()
        .filter(|node| node.name.ends_with(".back"));
    // With their children: shin and foot, forearm.
    assert_eq!(copies.count(), 5, "{:?}", compiled.diagnostics);
    for figure_clip in &compiled.clips {
        let off = worst(&compiled, figure_clip, Facing::Viewer, DQuat::IDENTITY);
        assert!(off < OFF, "{}: {off}°", figure_clip.name);
    }
}

/// Limited clips have a key for each drawing, and each key shows a frame of the full clip.
#[test]
fn a_key_for_each_drawing() {
    let mut limited = 0;
    for (name, _) in DRAWINGS {
        let compiled = compiled(&text(name));
        for figure_clip in &compiled.clips {
            let shown = compiled
                .scene
                .animations
                .iter()
                .find(|one| one.name == figure_clip.name)
                .expect("the clip");
            let Some(cut) = figure_clip.cut.as_ref() else {
                let is_linear = |track: &okoshi::scene::Track| {
                    track.timing.interpolation == Interpolation::Linear
                };
                assert!(shown.tracks.iter().all(is_linear), "{name}");
                continue;
            };
            limited += 1;
            let full = figure_clip.full_animation();
            assert_eq!(shown.tracks.len(), full.tracks.len());
            for (track, whole) in shown.tracks.iter().zip(&full.tracks) {
                assert_eq!(
                    (track.node, track.timing.interpolation),
                    (whole.node, Interpolation::Step)
                );
                let drawings: Vec<_> = cut.exposure.drawings().collect();
                // The closing key repeats the last drawing.
                assert_eq!(track.timing.times.len(), drawings.len() + 1, "{name}");
                match &track.values {
                    Values::Rotations(a) => assert!(a[drawings.len()] == a[drawings.len() - 1]),
                    Values::Translations(a) => assert!(a[drawings.len()] == a[drawings.len() - 1]),
                    other => panic!("{other:?} of a figure"),
                }
                for (key, drawing) in drawings.iter().enumerate() {
                    let time = (drawing.start as f64 * figure_clip.frame_time()) as f32;
                    assert_eq!(track.timing.times[key], time);
                    let source = drawing.source as usize;
                    match (&track.values, &whole.values) {
                        (Values::Rotations(a), Values::Rotations(b)) => {
                            assert!(a[key].dot(b[source]).abs() > 1.0 - 1e-12, "{name} {key}");
                        }
                        (Values::Translations(a), Values::Translations(b)) => {
                            assert_eq!(a[key], b[source])
                        }
                        _ => panic!("tracks of two kinds"),
                    }
                }
            }
            let seconds = cut.exposure.len() as f64 * figure_clip.frame_time();
            assert!((shown.seconds() - seconds).abs() < 1e-6, "{name}");
        }
    }
    assert!(limited >= 2, "only {limited} limited clips");
}

/// A corner of a mesh in the frames of the nodes that move it, each with its weight.
type Corner = Vec<(NodeId, DVec3, f64)>;

/// The corners of all nodes' meshes.
fn corners(scene: &Scene) -> Vec<Corner> {
    let rest = world(scene, &Animation::default(), 0);
    let mut corners = Vec::new();
    for (id, node) in scene.nodes.iter_enumerated() {
        let Some(mesh) = node.mesh else { continue };
        let patches = scene.meshes[mesh].primitives.iter();
        for patch in patches.flat_map(|primitive| &primitive.patches) {
            let surface = patch.surface();
            for (number, corner) in surface.positions.iter().enumerate() {
                let own = DVec3::from(corner.map(f64::from));
                let Some(influence) = surface.influences.get(number) else {
                    corners.push(vec![(id, own, 1.0)]);
                    continue;
                };
                let placed = rest[id].rotation * own + rest[id].position;
                let weights = influence.weights.map(f64::from);
                let weights = influence.joints.into_iter().zip(weights);
                let moved = weights.filter(|(_, weight)| *weight > 0.0);
                let moved = moved.map(|(joint, weight)| {
                    let bone = usize::from(joint).checked_sub(1);
                    let bone = bone.map_or(id, |bone| node.bones[bone]);
                    let local = rest[bone].rotation.inverse() * (placed - rest[bone].position);
                    (bone, local, weight)
                });
                corners.push(moved.collect());
            }
        }
    }
    corners
}

/// Soles stand on the ground, and nothing else is below it.
#[test]
fn nothing_sinks_into_the_ground() {
    let mut grounded = 0;
    for (name, _) in DRAWINGS {
        let compiled = compiled(&text(name));
        let corners = corners(&compiled.scene);
        let extent = |nodes: &TiVec<NodeId, Transform>| {
            let heights = corners.iter().map(|corner| {
                let moved = corner.iter().map(|(node, local, weight)| {
                    let placed = nodes[*node];
                    weight * (placed.rotation * *local + placed.position).y
                });
                moved.sum::<f64>()
            });
            heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| {
                (low.min(y), high.max(y))
            })
        };
        let (ground, top) = extent(&world(&compiled.scene, &Animation::default(), 0));
        let height = top - ground;
        for clip in &compiled.clips {
            let full = clip.full_animation();
            let mut worst = [0.0_f64; 2];
            for frame in 0..clip.source_frames() {
                let (low, _) = extent(&world(&compiled.scene, &full, frame));
                worst[0] = worst[0].max((ground - low) / height);
                if clip.grounded()[frame] {
                    grounded += 1;
                    worst[1] = worst[1].max((low - ground).abs() / height);
                }
            }
            eprintln!(
                "{name}, {}: {:.2} % below the ground, {:.2} % off it",
                clip.name,
                worst[0] * 100.0,
                worst[1] * 100.0
            );
            assert!(
                worst[0] < 0.01 && worst[1] < 0.01,
                "{name}, {}: {worst:?}",
                clip.name
            );
        }
    }
    assert!(grounded > 200, "only {grounded} frames on the ground");
}

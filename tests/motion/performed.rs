//! Performances of drawn figures, in the scene that a drawing becomes: timing, emphasis and camerawork.

use std::fmt::Write as _;

use fastrand::Rng;
use glam::{DQuat, DVec3};
use okoshi::compile::{Compiled, Options, compile};
use okoshi::internals::performance::Filming;
use okoshi::resolver::MemoryResolver;
use okoshi::scene::{CameraProjection, Interpolation, NodeId, Scene, Track, Values};

const DRAWING: &str = include_str!("../cases/perform-plays/drawing.svg");
const BOXING: &[u8] = include_bytes!("../../examples/motion/boxing.bvh");
/// Seconds from frame to frame.
const STEP: f64 = 1.0 / 24.0;

/// The figure of the drawing with this string for all parts, and marks on its arms that move like this: per frame of 24 a second.
fn perform(string: &str, red: &[[f64; 2]], green: &[[f64; 2]]) -> Compiled {
    let at = DRAWING.find(">%Perform").expect("a string for all parts");
    let end = at + DRAWING[at + 1..].find('<').expect("its end") + 1;
    let drawing = format!("{}>{string}{}", &DRAWING[..at], &DRAWING[end..]);
    let mut track = String::from("# 320x240\nframe,time,red_x,red_y,green_x,green_y\n");
    for (frame, (red, green)) in red.iter().zip(green).enumerate() {
        let time = frame as f64 * STEP;
        let [[a, b], [c, d]] = [red, green];
        let _ = writeln!(track, "{frame},{time:.6},{a:.3},{b:.3},{c:.3},{d:.3}");
    }
    let files = MemoryResolver::default()
        .with("hands.csv", track.into_bytes())
        .with("boxing.bvh", BOXING.to_vec());
    let compiled = compile(&drawing, &Options::default(), &files);
    assert!(!compiled.has_errors(), "{:?}", compiled.diagnostics);
    compiled
}

/// A mark that rests, moves within a few frames around `at`, and rests.
fn strike(random: &mut Rng, frames: usize, at: usize, width: f64) -> Vec<[f64; 2]> {
    let steepness = 0.8 + random.f64();
    let direction = random.f64() * std::f64::consts::TAU;
    let place = |frame: usize| {
        let gone = 1.0 / (1.0 + (-(frame as f64 - at as f64) * steepness).exp());
        [
            160.0 + width * gone * direction.cos(),
            120.0 + width * gone * direction.sin(),
        ]
    };
    (0..frames).map(place).collect()
}

fn track<'a>(scene: &'a Scene, clip: &str, node: &str, is_rotation: bool) -> Option<&'a Track> {
    let animation = scene
        .animations
        .iter()
        .find(|animation| animation.name == clip)?;
    animation.tracks.iter().find(|track| {
        let fits = matches!(track.values, Values::Rotations(_)) == is_rotation;
        fits && scene.nodes[track.node].name == node
    })
}

fn rotations<'a>(scene: &'a Scene, clip: &str, node: &str) -> &'a [DQuat] {
    let track = track(scene, clip, node, true).unwrap_or_else(|| panic!("{node} turns in {clip}"));
    match &track.values {
        Values::Rotations(rotations) => rotations,
        _ => unreachable!("rotations were looked for"),
    }
}

/// The keys around a time, and how far it is on the way.
fn between(track: &Track, time: f64) -> (usize, usize, f64) {
    let times = &track.timing.times;
    let next = times.partition_point(|key| f64::from(*key) <= time + 1e-5);
    let from = next.saturating_sub(1);
    let to = next.min(times.len() - 1);
    let [start, end] = [from, to].map(|key| f64::from(times[key]));
    match track.timing.interpolation {
        Interpolation::Linear if end > start => {
            (from, to, ((time - start) / (end - start)).max(0.0))
        }
        _ => (from, from, 0.0),
    }
}

/// A node's transform in the world at a time of a clip.
fn placed(scene: &Scene, clip: &str, node: NodeId, time: f64) -> (DQuat, DVec3) {
    let own = &scene.nodes[node];
    let mut local = (own.rotation, own.translation);
    if let Some(track) = track(scene, clip, &own.name, true)
        && let Values::Rotations(values) = &track.values
    {
        let (from, to, t) = between(track, time);
        local.0 = values[from].slerp(values[to], t);
    }
    if let Some(track) = track(scene, clip, &own.name, false)
        && let Values::Translations(values) = &track.values
    {
        let (from, to, t) = between(track, time);
        local.1 = values[from].lerp(values[to], t);
    }
    match scene.nodes.position(|other| other.children.contains(&node)) {
        Some(parent) => {
            let (turn, place) = placed(scene, clip, parent, time);
            (turn * local.0, place + turn * local.1)
        }
        None => local,
    }
}

/// The far end of a part in its node: the middle of its farthest points along +Y.
fn far_end(scene: &Scene, node: NodeId) -> DVec3 {
    let mesh = &scene.meshes[scene.nodes[node].mesh.expect("a solid")];
    let points = mesh
        .primitives
        .iter()
        .flat_map(|primitive| primitive.surface().positions.clone());
    let highest = points.map(|point| f64::from(point[1])).fold(0.0, f64::max);
    DVec3::Y * highest
}

/// Where each of the limbs is, of which some are performed.
const LIMBS: [&str; 4] = ["Rarm", "Larm", "Rleg", "Lleg"];

#[test]
fn the_key_pose_stands_in_the_key_frame_of_the_scene() {
    let mut random = Rng::with_seed(3);
    let mut checked = 0;
    for round in 0..12 {
        let frames = 30 + random.usize(..60);
        let at = 5 + random.usize(..frames - 10);
        let (red, green) = (
            strike(&mut random, frames, at, 90.0),
            strike(&mut random, frames, at / 2, 30.0),
        );
        let motion = ["punch", "\"boxing.bvh\"", "wave"][round % 3];
        let name = ["punch", "boxing", "wave"][round % 3];
        let string = format!("%Motion {motion} Perform -ec \"hands.csv\" Motion {motion}");
        let compiled = perform(&string, &red, &green);
        let plan = &compiled.clips[0]
            .performed
            .as_ref()
            .expect("a performance")
            .plan;
        let [input, source] = plan.keys.expect("keys");
        assert!(
            input.abs_diff(at) <= 1,
            "{input} is where the mark moves most: {at}"
        );
        let whole = format!("{name}-2");
        for limb in LIMBS {
            let [performed, whole] =
                [name, whole.as_str()].map(|clip| rotations(&compiled.scene, clip, limb));
            assert_eq!(performed.len(), frames, "its length is the performance's");
            let same = [whole[source], -whole[source]].contains(&performed[input]);
            assert!(same, "{limb}: {} {}", performed[input], whole[source]);
            checked += 1;
        }
    }
    assert_eq!(checked, 48);
}

#[test]
fn the_key_pose_stays_in_its_frame_when_the_clip_is_limited() {
    let mut random = Rng::with_seed(4);
    let motions = ["punch", "\"boxing.bvh\" boxing", "wave", "dance", "jump"];
    let mut omitted = [0, 0];
    for round in 0..20 {
        let frames = 40 + random.usize(..60);
        let at = 6 + random.usize(..frames - 12);
        let (red, green) = (
            strike(&mut random, frames, at, 90.0),
            strike(&mut random, frames, frames / 2, 30.0),
        );
        let motion = motions[round % motions.len()];
        let name = motion.rsplit(' ').next().expect("a word");
        let performed = perform(
            &format!("%Motion {motion} Perform \"hands.csv\""),
            &red,
            &green,
        );
        for limits in ["Limited 4 20", "Limited 10 30"] {
            let string = format!("%Motion {motion} Perform \"hands.csv\" {limits}");
            let limited = perform(&string, &red, &green);
            let clip = &limited.clips[0];
            let plan = &clip.performed.as_ref().expect("a performance").plan;
            let [input, _] = plan.keys.expect("keys");
            let cut = clip.cut.as_ref().expect("it is limited");
            assert_eq!(
                cut.exposure.len(),
                frames,
                "its length is the performance's"
            );
            for frame in &cut.omitted {
                omitted[usize::from(*frame as usize > input)] += 1;
            }
            for limb in LIMBS {
                let [shown, due] = [&limited, &performed].map(|of| {
                    let node = of.scene.nodes.position(|node| node.name == limb);
                    placed(&of.scene, name, node.expect("a limb"), input as f64 * STEP)
                });
                let off = shown.0.angle_between(due.0);
                assert!(
                    off < 1e-6,
                    "{motion} {limits}, frame {input}: {limb} is {off} off"
                );
            }
        }
    }
    assert!(omitted.iter().all(|side| *side > 40), "{omitted:?}");
}

#[test]
fn a_limited_loop_is_as_long_as_the_loop() {
    let still = [[0.0, 0.0]; 2];
    for motion in ["walk", "run", "-l \"boxing.bvh\" boxing", "-i walk"] {
        let compiled = perform(
            &format!("%Motion {motion} Motion {motion} Limited 3 8"),
            &still,
            &still,
        );
        let ends = compiled.scene.animations.iter().map(|animation| {
            let ends = animation
                .tracks
                .iter()
                .filter_map(|track| track.timing.times.last());
            ends.copied().fold(0.0, f32::max)
        });
        let ends: Vec<f32> = ends.collect();
        assert_eq!(ends.len(), 2, "{motion}");
        assert_eq!(ends[0], ends[1], "{motion}");
        let [full, limited] = [0, 1].map(|clip| compiled.clips[clip].seconds());
        assert!(
            (full - limited).abs() < 1e-9,
            "{motion}: {full} s, {limited} s"
        );
    }
}

#[test]
fn equation_1_holds_in_the_scene() {
    let mut random = Rng::with_seed(5);
    let angle = |turns: &[DQuat], frame: usize| {
        let way = turns[0].inverse() * turns[frame];
        2.0 * way.xyz().length().atan2(way.w.abs())
    };
    let mut compared = 0;
    for share in [0.0, 0.2, 0.5, 1.0] {
        let red = strike(&mut random, 50, 30, 100.0);
        // The same way, smaller.
        let green: Vec<[f64; 2]> = red
            .iter()
            .map(|[x, y]| [160.0 + (x - 160.0) * share, 120.0 + (y - 120.0) * share])
            .collect();
        let damped = perform("%Motion punch Perform -c \"hands.csv\"", &red, &green);
        let whole = perform("%Motion punch Perform -ec \"hands.csv\"", &red, &green);
        let plan = &damped.clips[0]
            .performed
            .as_ref()
            .expect("a performance")
            .plan;
        assert_eq!(plan.emphasized, Some(0));
        let ratio = plan.input.largest_of(1);
        assert!((ratio - share).abs() < 0.02, "{ratio} {share}");
        for limb in LIMBS {
            let [now, before] = [&damped, &whole].map(|of| rotations(&of.scene, "punch", limb));
            if limb != "Larm" || share == 1.0 {
                assert_eq!(now, before, "{limb} stays bit for bit");
                continue;
            }
            for frame in 0..now.len() {
                let [left, full] = [now, before].map(|turns| angle(turns, frame));
                assert!(
                    (left - full * ratio).abs() < 1e-6,
                    "frame {frame}: {left} of {full}"
                );
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 150);
}

#[test]
fn the_camera_keeps_the_joint_in_the_middle() {
    let mut random = Rng::with_seed(8);
    let mut held = 0;
    for round in 0..8 {
        let frames = 36 + random.usize(..40);
        let at = 8 + random.usize(..frames - 16);
        let (red, green) = (
            strike(&mut random, frames, at, 90.0),
            strike(&mut random, frames, 9, 20.0),
        );
        let motion = ["punch", "\"boxing.bvh\" boxing", "wave", "dance"][round % 4];
        let name = ["punch", "boxing", "wave", "dance"][round % 4];
        let limited = if round < 4 { "" } else { " Limited 3 18" };
        let compiled = perform(
            &format!("%Bend 0 Axes +z +y -x Motion {motion} Perform \"hands.csv\"{limited}"),
            &red,
            &green,
        );
        let scene = &compiled.scene;
        let camera = scene
            .nodes
            .position(|node| node.camera.is_some())
            .expect("a camera");
        assert_eq!(scene.nodes[camera].name, format!("{name} camera"));
        let CameraProjection::Perspective {
            vertical_field_of_view,
            near,
            ..
        } = scene.cameras.raw[0].projection
        else {
            panic!("a perspective camera");
        };
        let half = (vertical_field_of_view / 2.0).tan();
        let arm = scene
            .nodes
            .position(|node| node.name == "Rarm")
            .expect("an arm");
        let tip = far_end(scene, arm);
        let shown = compiled.clips[0].frames();
        let seen = |time: f64| {
            let (turn, place) = placed(scene, name, arm, time);
            let (view, eye) = placed(scene, name, camera, time);
            view.inverse() * (place + turn * tip - eye)
        };
        // Between the frames of a full clip, too.
        let moments: Vec<f64> = (0..2 * shown - 1)
            .map(|half| half as f64 * STEP / 2.0)
            .collect();
        for (index, time) in moments.iter().enumerate() {
            let at = seen(*time);
            // Between two frames the camera goes straight, and the joint may go round.
            let most = if index % 2 == 0 { 0.02 } else { 0.06 };
            let off = at.truncate() / (-at.z * 2.0 * half);
            assert!(off.abs().max_element() < most, "{motion} at {time}: {off}");
            assert!(-at.z > near);
        }
        // Where the joint is nearest to the viewer, so is the camera.
        let viewer =
            DQuat::from_mat3(&glam::DMat3::from_cols(DVec3::Z, DVec3::Y, DVec3::NEG_X)) * DVec3::Z;
        let depths: Vec<f64> = (0..shown)
            .map(|frame| {
                let (turn, place) = placed(scene, name, arm, frame as f64 * STEP);
                (place + turn * tip).dot(viewer)
            })
            .collect();
        let distances: Vec<f64> = (0..shown)
            .map(|frame| -seen(frame as f64 * STEP).z)
            .collect();
        let nearest = (0..shown)
            .min_by(|a, b| distances[*a].total_cmp(&distances[*b]))
            .expect("frames");
        let highest = depths.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        assert!(
            highest - depths[nearest] < 1e-6,
            "{motion}: {nearest} in {depths:?}"
        );
        let [first, last] = [distances[0], distances[shown - 1]];
        let half_way = distances[nearest] * 2.0 / first.max(last);
        assert!(
            (half_way - 1.0).abs() < 1e-6,
            "half the distance: {half_way}"
        );
        held += compiled.clips[0]
            .cut
            .as_ref()
            .map_or(0, |cut| cut.held.len());
    }
    assert!(held > 40, "{held} drawings are held");
}

#[test]
fn the_character_moves_in_place_of_the_camera() {
    let mut random = Rng::with_seed(2);
    let (red, green) = (
        strike(&mut random, 48, 30, 90.0),
        strike(&mut random, 48, 9, 20.0),
    );
    for limited in ["", " Limited 2 14"] {
        let filmed = perform(
            &format!("%Motion dance Perform \"hands.csv\"{limited}"),
            &red,
            &green,
        );
        let moved = perform(
            &format!("%Motion dance Perform -r \"hands.csv\"{limited}"),
            &red,
            &green,
        );
        assert!(moved.scene.cameras.is_empty());
        let plan = &moved.clips[0]
            .performed
            .as_ref()
            .expect("a performance")
            .plan;
        assert_eq!(plan.filming, Filming::Character);
        let arm = moved
            .scene
            .nodes
            .position(|node| node.name == "Rarm")
            .expect("an arm");
        let tip = far_end(&moved.scene, arm);
        let camera = filmed
            .scene
            .nodes
            .position(|node| node.camera.is_some())
            .expect("a camera");
        // The way from the camera to the joint changes as it does for a camera that moves.
        let mut eye = None;
        for frame in 0..moved.clips[0].frames() {
            let time = frame as f64 * STEP;
            let (turn, place) = placed(&moved.scene, "dance", arm, time);
            let (own_turn, own) = placed(&filmed.scene, "dance", arm, time);
            let (_, at) = placed(&filmed.scene, "dance", camera, time);
            let still = place + turn * tip - (own + own_turn * tip - at);
            let eye = *eye.get_or_insert(still);
            assert!(still.distance(eye) < 1e-6, "frame {frame}: {still} {eye}");
        }
    }
}

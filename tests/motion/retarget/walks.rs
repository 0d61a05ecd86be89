//! Walking legs: the direction that they face, and feet that do not slide.

use glam::{DVec3, dvec3};
use okoshi::internals::labels::{Facing, FigurePartId};
use okoshi::internals::mocap::{Clip, JointId, Pose};
use okoshi::internals::retarget::{Landmarks, RetargetedClip, Rig, retarget};

use super::clips::{FILES, clip};
use super::rigs::{Limbs, biped, dog};
use super::{Body, Placed, angle, direction, end, moved_point, placed};

/// The figure's leg is about this long, drawing units.
const LEG: f64 = 97.0;

#[test]
fn thighs_face_forward_in_walks() {
    for file in [
        "examples/motion/walk.bvh",
        "examples/motion/zombie-walk.bvh",
        "tests/motion/data/mocapbank.bvh",
    ] {
        let prepared = clip(file);
        let landmarks = Landmarks::of(&prepared.anatomy);
        let body = Body::of(&prepared.clip, &landmarks, Facing::Viewer);
        let first = prepared.clip.pose(0);
        for pieces in 1..=3 {
            let rig = biped(&prepared.anatomy, Limbs::Bound, pieces);
            let retargeted = retarget(&prepared.clip, &rig, &landmarks);
            // In space, and seen from above: a swinging leg tips its front up or down.
            let mut worst = [0.0_f64; 2];
            let mut checked = 0;
            for frame in 0..prepared.clip.frames {
                let pose = prepared.clip.pose(frame);
                let [_, front] = body.left_and_front(&pose);
                let front = body.drawn(&first, front);
                let placed = placed(&rig, &retargeted, frame);
                for (index, part) in rig.parts.iter_enumerated() {
                    let drive = part.drive.filter(|_| part.is_leg);
                    let thighs = landmarks.thighs.expect("legs");
                    let Some(drive) = drive.filter(|drive| thighs.contains(&drive.joint)) else {
                        continue;
                    };
                    // Walking never lifts a thigh so high: the clip contains other actions as well.
                    let way = direction(&prepared.clip, &pose, &drive).expect("a bone");
                    if angle(way, -body.up) < 60.0 {
                        checked += 1;
                        let own =
                            placed[index].rotation * (part.node.rotation.inverse() * DVec3::Z);
                        let above = angle(own * dvec3(1.0, 0.0, 1.0), front);
                        worst = [worst[0].max(angle(own, front)), worst[1].max(above)];
                    }
                }
            }
            assert!(
                checked >= prepared.clip.frames,
                "{file}: of two thighs only {checked} in all frames"
            );
            eprintln!("{file} {pieces}: thighs {worst:.1?}° from the front");
            assert!(worst[1] < 45.0, "{file}, {pieces} pieces: {worst:?}°");
            if file.starts_with("examples") {
                assert!(worst[0] < 45.0, "{file}, {pieces} pieces: {worst:?}°");
            }
        }
    }
}

/// The feet of a rig: per foot of the clip the parts that stand on it.
fn feet(rig: &Rig) -> Vec<Vec<FigurePartId>> {
    let mut feet: Vec<(JointId, Vec<FigurePartId>)> = Vec::new();
    for (index, part) in rig.parts.iter_enumerated() {
        let Some(drive) = part.drive.filter(|_| part.stands) else {
            continue;
        };
        match feet.iter_mut().find(|(joint, _)| *joint == drive.joint) {
            Some((_, parts)) => parts.push(index),
            None => feet.push((drive.joint, vec![index])),
        }
    }
    feet.into_iter().map(|(_, parts)| parts).collect()
}

/// Where the points of a foot are.
fn soles(rig: &Rig, placed: &Placed, foot: &[FigurePartId]) -> Vec<DVec3> {
    let points = foot.iter().flat_map(|part| {
        let surface = rig.parts[*part].surface.iter();
        surface.map(move |point| moved_point(rig, placed, *part, *point))
    });
    points.collect()
}

/// How long a leg of the clip is, foot not counted.
fn leg(clip: &Clip, landmarks: &Landmarks) -> f64 {
    let [thighs, knees, feet] =
        [landmarks.thighs, landmarks.knees, landmarks.feet].map(|pair| pair.expect("legs"));
    let pose = clip.pose(0);
    let length = |a: JointId, b: JointId| pose[a].position.distance(pose[b].position);
    let legs =
        [0, 1].map(|side| length(thighs[side], knees[side]) + length(knees[side], feet[side]));
    (legs[0] + legs[1]) / 2.0
}

/// The worst of all grounded frames: how much faster the locked foot slides where it touches the ground than the foot of the actor, in
/// leg lengths a second; how far the lowest point is off the ground, drawing units; and the number of steps that were checked.
fn standing(
    clip: &Clip,
    rig: &Rig,
    landmarks: &Landmarks,
    retargeted: &RetargetedClip,
) -> ([f64; 2], usize) {
    let leg = leg(clip, landmarks);
    let feet = feet(rig);
    let standing = rig.parts.iter().filter(|part| part.stands);
    let ground = standing.flat_map(|part| &part.surface).map(|point| point.y);
    let ground = ground.fold(f64::INFINITY, f64::min);
    let mut worst = [0.0_f64; 2];
    let mut checked = 0;
    for frame in 0..clip.frames {
        let now = placed(rig, retargeted, frame);
        if !retargeted.grounded[frame] {
            continue;
        }
        let all = feet
            .iter()
            .flat_map(|foot| soles(rig, &now, foot))
            .map(|point| point.y);
        worst[1] = worst[1].max((all.fold(f64::INFINITY, f64::min) - ground).abs());
        if frame == 0 {
            continue;
        }
        checked += 1;
        let before = placed(rig, retargeted, frame - 1);
        let level = |way: DVec3| (way * dvec3(1.0, 0.0, 1.0)).length();
        // A foot rolls: the point counts that is lowest in both poses.
        let slides = feet.iter().map(|foot| {
            let [from, to] = [&before, &now].map(|placed| soles(rig, placed, foot));
            let points = from.into_iter().zip(to);
            let (from, to) = points
                .min_by(|a, b| (a.0.y + a.1.y).total_cmp(&(b.0.y + b.1.y)))
                .expect("a sole");
            level(to - from) / LEG / clip.frame_time
        });
        let actor = (0..2).map(|side| {
            let ends = |pose: &Pose| {
                let ankle = pose[landmarks.feet.expect("feet")[side]].position;
                [
                    Some(ankle),
                    landmarks.foot_tips.map(|tips| end(clip, pose, tips[side])),
                ]
            };
            let [from, to] = [frame - 1, frame].map(|frame| ends(&clip.pose(frame)));
            let steps = from
                .into_iter()
                .zip(to)
                .filter_map(|(from, to)| Some(from?.distance(to?)));
            steps.fold(f64::INFINITY, f64::min) / leg / clip.frame_time
        });
        let slowest = actor.fold(f64::INFINITY, f64::min);
        // Contacts are slower than 0.6 on a smooth path; single steps may be a little faster.
        assert!(
            slowest < 0.7,
            "frame {frame}: the actor's feet move at {slowest} legs a second"
        );
        let slide = slides.fold(f64::INFINITY, f64::min);
        worst[0] = worst[0].max(slide - slowest);
    }
    (worst, checked)
}

#[test]
fn locked_feet_do_not_slide() {
    for file in FILES {
        let prepared = clip(file);
        let landmarks = Landmarks::of(&prepared.anatomy);
        let mut rigs: Vec<Rig> = Vec::new();
        for limbs in Limbs::ALL {
            rigs.extend((1..=3).map(|pieces| biped(&prepared.anatomy, limbs, pieces)));
        }
        rigs.push(dog(&prepared.anatomy, Facing::Right));
        for (number, rig) in rigs.iter().enumerate() {
            let retargeted = retarget(&prepared.clip, rig, &landmarks);
            let grounded = retargeted
                .grounded
                .iter()
                .filter(|grounded| **grounded)
                .count();
            let ([slide, height], checked) = standing(&prepared.clip, rig, &landmarks, &retargeted);
            eprintln!(
                "{file} {number}: {grounded} of {} grounded, slides {slide:.3} leg lengths a second, {:.2} % of the leg off the ground",
                prepared.clip.frames,
                height / LEG * 100.0
            );
            assert!(slide < 0.1, "{file}, figure {number}: slides {slide}");
            assert!(height < 1e-9 * LEG, "{file}, figure {number}: {height}");
            // The zombie stumbles; everyone else has a foot on the ground most of the time.
            let quarters = if file.contains("zombie") { 1 } else { 3 };
            assert!(
                4 * checked >= quarters * prepared.clip.frames,
                "{file}, figure {number}: only {checked} steps of {grounded} grounded frames"
            );
        }
    }
}

/// A walker moves ahead as far as in the clip, scaled by the length of the legs.
#[test]
fn walks_travel() {
    let prepared = clip("examples/motion/walk.bvh");
    let landmarks = Landmarks::of(&prepared.anatomy);
    let rig = biped(&prepared.anatomy, Limbs::Bound, 2);
    let retargeted = retarget(&prepared.clip, &rig, &landmarks);
    let places = retargeted.translations.raw[0].as_ref().expect("it goes");
    let way = places[places.len() - 1] - places[0];
    let pose = |frame: usize| prepared.clip.pose(frame)[landmarks.hips].position;
    let body = Body::of(&prepared.clip, &landmarks, Facing::Viewer);
    let clip_way = body.drawn(
        &prepared.clip.pose(0),
        pose(prepared.clip.frames - 1) - pose(0),
    );
    let due = clip_way * LEG / leg(&prepared.clip, &landmarks);
    eprintln!("walked {way}, the clip {due}");
    assert!(
        angle(way * dvec3(1.0, 0.0, 1.0), due * dvec3(1.0, 0.0, 1.0)) < 15.0,
        "{way} {due}"
    );
    assert!(
        (way.length() / due.length() - 1.0).abs() < 0.25,
        "{way} {due}"
    );
}

//! Legs that walk: which way they face, and feet that stand.

use glam::{DVec3, dvec3};
use okoshi::motion::carry::{Carried, Landmarks, Puppet, carry};
use okoshi::motion::labels::Facing;
use okoshi::motion::skeleton::{Clip, Placed};

use super::clips::{FILES, clip};
use super::puppets::{Limbs, biped, dog};
use super::{Body, angle, carried_to, direction, end, placed};

/// The figure's leg is about this long, drawing units.
const LEG: f64 = 97.0;

#[test]
fn thighs_face_forward_in_walks() {
    for file in [
        "examples/motion/walk.bvh",
        "examples/motion/zombie-walk.bvh",
        "tests/motion/data/mocapbank.bvh",
    ] {
        let ready = clip(file);
        let landmarks = Landmarks::of(&ready.anatomy);
        let body = Body::of(&ready.clip, &landmarks, Facing::Viewer);
        let first = ready.clip.pose(0);
        for pieces in 1..=3 {
            let puppet = biped(&ready.anatomy, Limbs::Bound, pieces);
            let carried = carry(&ready.clip, &puppet, &landmarks);
            // As they are, and seen from above: a leg that swings tips its front up or down.
            let mut worst = [0.0_f64; 2];
            for frame in 0..ready.clip.frames() {
                let pose = ready.clip.pose(frame);
                let [_, front] = body.left_and_front(&pose);
                let front = body.drawn(&first, front);
                let placed = placed(&puppet, &carried, frame);
                for (index, part) in puppet.parts.iter().enumerate() {
                    let drive = part.drive.filter(|drive| drive.is_leg);
                    let thighs = landmarks.thighs.expect("legs");
                    let Some(drive) = drive.filter(|drive| thighs.contains(&drive.joint)) else {
                        continue;
                    };
                    // Nobody who walks lifts a thigh so high: that clip holds other actions, too.
                    let way = direction(&ready.clip, &pose, &drive).expect("a bone");
                    if angle(way, -body.up) < 60.0 {
                        let own =
                            placed[index].rotation * (part.node.rotation.inverse() * DVec3::Z);
                        let above = angle(own * dvec3(1.0, 0.0, 1.0), front);
                        worst = [worst[0].max(angle(own, front)), worst[1].max(above)];
                    }
                }
            }
            eprintln!("{file} {pieces}: thighs {worst:.1?}° from the front");
            assert!(worst[1] < 45.0, "{file}, {pieces} pieces: {worst:?}°");
            if file.starts_with("examples") {
                assert!(worst[0] < 45.0, "{file}, {pieces} pieces: {worst:?}°");
            }
        }
    }
}

/// The feet of a puppet: the parts that stand on the joint of one foot.
fn feet(puppet: &Puppet) -> Vec<Vec<usize>> {
    let mut feet: Vec<(usize, Vec<usize>)> = Vec::new();
    for (index, part) in puppet.parts.iter().enumerate() {
        let Some(drive) = part.drive.filter(|_| !part.sole.is_empty()) else {
            continue;
        };
        match feet.iter_mut().find(|(joint, _)| *joint == drive.joint) {
            Some((_, parts)) => parts.push(index),
            None => feet.push((drive.joint, vec![index])),
        }
    }
    feet.into_iter().map(|(_, parts)| parts).collect()
}

/// Where the points of a foot's soles are.
fn soles(puppet: &Puppet, placed: &[Placed], foot: &[usize]) -> Vec<DVec3> {
    let points = foot.iter().flat_map(|part| {
        let soles = puppet.parts[*part].sole.iter();
        soles.map(move |point| carried_to(puppet, placed, *part, *point))
    });
    points.collect()
}

/// How long a leg of the clip is, foot not counted.
fn leg(clip: &Clip, landmarks: &Landmarks) -> f64 {
    let [thighs, knees, feet] =
        [landmarks.thighs, landmarks.knees, landmarks.feet].map(|pair| pair.expect("legs"));
    let pose = clip.pose(0);
    let length = |a: usize, b: usize| pose[a].position.distance(pose[b].position);
    let legs =
        [0, 1].map(|side| length(thighs[side], knees[side]) + length(knees[side], feet[side]));
    (legs[0] + legs[1]) / 2.0
}

/// Per frame the worst: how far the standing foot slid, and how far the lowest is off the ground; drawing units.
fn standing(clip: &Clip, puppet: &Puppet, landmarks: &Landmarks, carried: &Carried) -> [f64; 2] {
    let leg = leg(clip, landmarks);
    let feet = feet(puppet);
    let mean = |points: Vec<DVec3>| points.iter().sum::<DVec3>() / points.len() as f64;
    let ground = puppet
        .parts
        .iter()
        .flat_map(|part| &part.sole)
        .map(|point| point.y);
    let ground = ground.fold(f64::INFINITY, f64::min);
    let mut worst = [0.0_f64; 2];
    for frame in 0..clip.frames() {
        let now = placed(puppet, carried, frame);
        if !carried.grounded[frame] {
            continue;
        }
        let all = feet
            .iter()
            .flat_map(|foot| soles(puppet, &now, foot))
            .map(|point| point.y);
        worst[1] = worst[1].max((all.fold(f64::INFINITY, f64::min) - ground).abs());
        if frame == 0 {
            continue;
        }
        let before = placed(puppet, carried, frame - 1);
        let slides = feet.iter().map(|foot| {
            let [from, to] = [&before, &now].map(|placed| mean(soles(puppet, placed, foot)));
            ((to - from) * dvec3(1.0, 0.0, 1.0)).length()
        });
        let slides: Vec<f64> = slides.collect();
        let (still, slide) =
            slides
                .iter()
                .copied()
                .enumerate()
                .fold((0, f64::INFINITY), |best, next| {
                    if next.1 < best.1 { next } else { best }
                });
        worst[0] = worst[0].max(slide);
        // The one that stands is low and slow in the clip, too.
        let drive = puppet.parts[feet[still][0]]
            .drive
            .expect("a foot is driven");
        let point = |frame: usize| {
            let pose = clip.pose(frame);
            let far = end(clip, &pose, drive.tip.expect("it points"));
            match landmarks.feet.expect("feet").contains(&drive.joint) {
                true => (far + pose[drive.joint].position) / 2.0,
                false => far,
            }
        };
        let speed = point(frame).distance(point(frame - 1)) / clip.frame_time / leg;
        assert!(
            speed < 0.6,
            "frame {frame}: the standing foot moves at {speed} legs a second"
        );
    }
    worst
}

#[test]
fn standing_feet_stay() {
    for file in FILES {
        let ready = clip(file);
        let landmarks = Landmarks::of(&ready.anatomy);
        let mut puppets: Vec<Puppet> = Vec::new();
        for limbs in Limbs::ALL {
            puppets.extend((1..=3).map(|pieces| biped(&ready.anatomy, limbs, pieces)));
        }
        puppets.push(dog(&ready.anatomy, Facing::Right));
        for (number, puppet) in puppets.iter().enumerate() {
            let carried = carry(&ready.clip, puppet, &landmarks);
            let grounded = carried
                .grounded
                .iter()
                .filter(|grounded| **grounded)
                .count();
            let [slide, height] = standing(&ready.clip, puppet, &landmarks, &carried);
            eprintln!(
                "{file} {number}: {grounded} of {} grounded, slides {slide:.1e}, {:.2} % of the leg off the ground",
                ready.clip.frames(),
                height / LEG * 100.0
            );
            assert!(
                slide < 1e-9 * LEG,
                "{file}, figure {number}: slides {slide}"
            );
            assert!(height < 1e-9 * LEG, "{file}, figure {number}: {height}");
        }
    }
}

/// Someone who walks or kicks gets ahead, and lifts the feet.
#[test]
fn walks_get_ahead() {
    let ready = clip("examples/motion/walk.bvh");
    let landmarks = Landmarks::of(&ready.anatomy);
    let puppet = biped(&ready.anatomy, Limbs::Bound, 2);
    let carried = carry(&ready.clip, &puppet, &landmarks);
    let places = carried.moves[0].as_ref().expect("it goes");
    let way = places[places.len() - 1] - places[0];
    let pose = |frame: usize| ready.clip.pose(frame)[landmarks.hips].position;
    let body = Body::of(&ready.clip, &landmarks, Facing::Viewer);
    let clip_way = body.drawn(&ready.clip.pose(0), pose(ready.clip.frames() - 1) - pose(0));
    let due = clip_way * LEG / leg(&ready.clip, &landmarks);
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

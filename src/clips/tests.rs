//! Laws of all clips.

use glam::{DQuat, DVec3};

use super::body::{Body, Leg};
use super::*;
use crate::mocap::{self, JointId};

/// Every clip of a body, with its poses.
fn all() -> impl Iterator<Item = (String, BuiltIn, Body, Vec<mocap::Pose>)> {
    let pairs = Legs::ALL
        .into_iter()
        .flat_map(|legs| BuiltIn::ALL.map(|which| (legs, which)))
        .filter(|(_, which)| !which.moves_parts());
    pairs.map(|(legs, which)| {
        let (clip, _) = clip(which, legs);
        let poses = (0..clip.frames).map(|frame| clip.pose(frame)).collect();
        let name = format!("{} on {}", which.name(), legs.count());
        (name, which, Body::on(legs), poses)
    })
}

/// The joints from the place on the ground below the hips.
fn about_hips(pose: &mocap::Pose) -> Vec<DVec3> {
    let hips = pose[JointId::default()].position;
    let below = DVec3::new(hips.x, 0.0, hips.z);
    pose.iter().map(|joint| joint.position - below).collect()
}

fn apart(a: &[DVec3], b: &[DVec3]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| a.distance_squared(*b));
    squares.sum::<f64>().sqrt()
}

/// The points of a sole in the world.
fn sole(leg: &Leg, pose: &mocap::Pose) -> [DVec3; 2] {
    let foot = pose[leg.joints[2]];
    leg.sole.map(|point| foot.position + foot.rotation * point)
}

#[test]
fn names_are_unique_words() {
    for which in BuiltIn::ALL {
        assert_eq!(BuiltIn::from_name(which.name()), Some(which));
    }
    assert_eq!(BuiltIn::from_name("Walk"), None);
}

#[test]
fn every_clip_can_be_repeated() {
    for (name, _, _, poses) in all() {
        let places: Vec<Vec<DVec3>> = poses.iter().map(about_hips).collect();
        let steps: Vec<f64> = places
            .windows(2)
            .map(|pair| apart(&pair[0], &pair[1]))
            .collect();
        let mut sorted = steps.clone();
        sorted.sort_by(f64::total_cmp);
        let seam = apart(&places[0], &places[places.len() - 1]);
        assert!(seam <= sorted[sorted.len() / 2], "{name}: a seam of {seam}");
        // The step over the seam is not out of line either.
        let change = |a: usize, b: usize| {
            let pairs = places[a].iter().zip(&places[a + 1]);
            let others = places[b].iter().zip(&places[b + 1]);
            let changes = pairs
                .zip(others)
                .map(|((a, b), (c, d))| (*b - *a).distance_squared(*d - *c));
            changes.sum::<f64>().sqrt()
        };
        let inner = (1..steps.len())
            .map(|at| change(at - 1, at))
            .fold(0.0, f64::max);
        let seam = change(steps.len() - 1, 0);
        assert!(
            seam <= inner * 1.05 + 1e-6,
            "{name}: a jerk of {seam}, elsewhere {inner}"
        );
    }
}

#[test]
fn feet_on_the_ground_stay_where_they_are() {
    for (name, which, body, poses) in all() {
        for leg in &body.legs {
            let contact = Gait::of(which, legs_of(&body)).map(|gait| gait.contact(leg));
            let frames = poses.len() - 1;
            for (frame, pair) in poses.windows(2).enumerate() {
                let [before, after] = [&pair[0], &pair[1]].map(|pose| sole(leg, pose));
                let stands = match contact {
                    Some((touches, duty)) => {
                        let since = |frame: usize| {
                            (gaits::START + frame as f64 / frames as f64 - touches).rem_euclid(1.0)
                        };
                        since(frame) < since(frame + 1) && since(frame + 1) <= duty
                    }
                    None => [before, after].iter().flatten().all(|point| point.y < 0.3),
                };
                let slides = [0, 1].map(|point| before[point].distance(after[point]));
                let slide = slides[0].min(slides[1]) * FPS / leg.length();
                assert!(
                    !stands || slide < 0.1,
                    "{name}, frame {frame}: {slide} leg lengths a second"
                );
            }
        }
    }
}

#[test]
fn no_foot_is_in_the_ground_and_none_floats() {
    for (name, which, body, poses) in all() {
        for leg in &body.legs {
            let lowest = poses
                .iter()
                .flat_map(|pose| sole(leg, pose))
                .map(|point| point.y);
            let lowest = lowest.fold(f64::INFINITY, f64::min);
            assert!(lowest.abs() < 0.02 * leg.length(), "{name}: {lowest}");
        }
        let lowest = |pose: &mocap::Pose| {
            let points = body.legs.iter().flat_map(|leg| sole(leg, pose));
            points.map(|point| point.y).fold(f64::INFINITY, f64::min)
        };
        let in_air = poses.iter().filter(|pose| lowest(pose) > 1.0).count();
        let flies = matches!(which, BuiltIn::Jump | BuiltIn::Run | BuiltIn::Trot);
        assert!(flies || in_air == 0, "{name}: {in_air} frames in the air");
    }
}

#[test]
fn the_head_is_steady_while_the_body_walks() {
    for (name, which, body, poses) in all() {
        let Some(head) = body
            .anatomy
            .head
            .filter(|_| Gait::of(which, legs_of(&body)).is_some())
        else {
            continue;
        };
        let mean = poses[0][head].rotation;
        let most = poses
            .iter()
            .map(|pose| pose[head].rotation.angle_between(mean));
        let most = most.fold(0.0, f64::max).to_degrees();
        assert!(most < 12.0, "{name}: the head turns by {most} degrees");
    }
}

#[test]
fn gaits_travel_by_their_stride_and_actions_do_not() {
    for (name, which, body, poses) in all() {
        let hips = JointId::default();
        let way = poses[poses.len() - 1][hips].position - poses[0][hips].position;
        let stride = Gait::of(which, legs_of(&body)).map_or(0.0, |gait| gait.steps.stride);
        assert!(way.distance(DVec3::Z * stride) < 1e-6, "{name}: {way}");
    }
}

#[test]
fn knees_and_elbows_bend_to_their_own_side() {
    for (name, _, body, poses) in all() {
        for pose in &poses {
            for leg in &body.legs {
                let [hip, knee, ankle] = leg.joints.map(|joint| pose[joint].position);
                let way = ankle - hip;
                let off = (knee - hip).reject_from(way);
                assert!(off.dot(leg.knee.reject_from(way)) >= -1e-6, "{name}");
            }
            for arm in &body.arms {
                let [_, upper, lower, _] = arm.joints;
                let bend = pose[upper].rotation.inverse() * pose[lower].rotation;
                let hand = bend * DVec3::NEG_Y;
                // Forward, or outward and up, but not back.
                assert!(hand.z > -0.35, "{name}: {hand}");
            }
        }
    }
}

#[test]
fn the_biped_is_labeled_as_it_is_by_its_names() {
    let (clip, anatomy) = clip(BuiltIn::Idle, Legs::Two);
    let by_names = crate::labels::label_clip(&clip);
    assert_eq!(by_names.limbs, anatomy.limbs);
    assert_eq!((by_names.hips, by_names.head), (anatomy.hips, anatomy.head));
    assert_eq!(
        (by_names.spine, by_names.neck),
        (anatomy.spine, anatomy.neck)
    );
}

#[test]
fn rotations_are_of_unit_length() {
    for (name, _, _, poses) in all() {
        let sound = |rotation: DQuat| (rotation.length() - 1.0).abs() < 1e-6;
        assert!(
            poses.iter().flatten().all(|joint| sound(joint.rotation)),
            "{name}"
        );
    }
}

fn legs_of(body: &Body) -> Legs {
    let mut all = Legs::ALL.into_iter();
    all.find(|legs| legs.count() == body.legs.len()).unwrap()
}

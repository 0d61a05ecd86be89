//! Parts that hang lag behind and overshoot, and are at rest where nothing moves.

use std::sync::Arc;

use glam::{DVec3, dvec3};
use okoshi::internals::labels::{Anatomy, FigurePartId};
use okoshi::internals::mocap::{Axis, Channel, Clip, Joint, Skeleton};
use okoshi::internals::retarget::{Drive, Follow};
use okoshi::internals::retarget::{Landmarks, Rig, RigPart, retarget};
use typed_index_collections::ti_vec;

use super::clips::{FILES, clip};
use super::rigs::{Limbs, biped, part};
use super::{Placed, angle, apart, placed};

/// A part from a joint to a tip that hangs on another and swings.
fn hanging(parent: FigurePartId, joint: DVec3, tip: DVec3, swing: Option<f64>) -> RigPart {
    RigPart {
        swing,
        ..part(Some(parent), false, [joint, tip])
    }
}

/// A figure with a pony tail of two strands, a tail and a cape; and the indices of these.
pub(super) fn hairy(anatomy: &Anatomy, stiffness: Option<f64>) -> (Rig, Vec<FigurePartId>) {
    let mut rig = biped(anatomy, Limbs::Bound, 2);
    let [hips, chest, head] = [0, 2, 3].map(FigurePartId::from);
    let first = rig.parts.next_key();
    let at = |x: f64, y: f64| dvec3(x, y, 0.0);
    rig.parts
        .push(hanging(head, at(-4.0, 188.0), at(-14.0, 170.0), stiffness));
    rig.parts.push(hanging(
        first,
        at(-14.0, 170.0),
        at(-18.0, 150.0),
        stiffness,
    ));
    rig.parts
        .push(hanging(hips, at(-4.0, 102.0), at(-34.0, 92.0), stiffness));
    rig.parts
        .push(hanging(chest, at(0.0, 155.0), at(0.0, 90.0), stiffness));
    // The head and the trunk are in the way of hair and cape.
    let ball = |center: DVec3, size: DVec3| {
        let ways = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
        ways.map(move |way| center + way * size).collect()
    };
    rig.parts[head].surface = ball(at(0.0, 178.0), dvec3(12.0, 14.0, 12.0));
    rig.parts[chest].surface = ball(at(0.0, 145.0), dvec3(16.0, 18.0, 9.0));
    let hanging = rig.parts.keys().skip(first.into()).collect();
    (rig, hanging)
}

/// The largest angle between a part and where it would be without swinging, in a frame.
fn deviation(rig: &Rig, still: &Placed, now: &Placed, part: FigurePartId) -> f64 {
    let parent = rig.parts[part].parent.expect("it hangs");
    // What it hangs on may swing itself.
    let carried = now[parent].rotation * still[parent].rotation.inverse() * still[part].rotation;
    apart(carried, now[part].rotation)
}

#[test]
fn nothing_swings_farther_than_sixty_degrees() {
    let mut most = 0.0_f64;
    for file in FILES {
        let prepared = clip(file);
        let landmarks = Landmarks::of(&prepared.anatomy);
        for stiffness in [0.05, 1.0, 20.0, 1e9] {
            let (rig, hanging) = hairy(&prepared.anatomy, Some(stiffness));
            let (stiff, _) = hairy(&prepared.anatomy, None);
            let swung = retarget(&prepared.clip, &rig, &landmarks);
            let again = retarget(&prepared.clip, &rig, &landmarks);
            assert_eq!(swung, again, "{file}: the same motion gives the same");
            let still = retarget(&prepared.clip, &stiff, &landmarks);
            let mut own = 0.0_f64;
            for frame in 0..prepared.clip.frames {
                let [still, now] =
                    [(&stiff, &still), (&rig, &swung)].map(|(rig, clip)| placed(rig, clip, frame));
                for part in &hanging {
                    own = own.max(deviation(&rig, &still, &now, *part));
                }
                for part in rig.parts.keys().take(hanging[0].into()) {
                    assert!(apart(still[part].rotation, now[part].rotation) < 1e-9);
                    assert!(still[part].position.distance(now[part].position) < 1e-9);
                }
            }
            eprintln!("{file}, stiffness {stiffness}: {own:.1}°");
            assert!(own < 60.0 + 1e-6, "{file}, {stiffness}: {own}°");
            assert!(
                own > 1.0 || stiffness > 10.0,
                "{file}, {stiffness}: only {own}°"
            );
            most = most.max(own);
        }
    }
    assert!(most > 30.0, "at most {most}°");
}

/// A body that turns about z by these degrees, and a part that hangs down from it.
fn turning(degrees: &[f64]) -> (Clip, Rig) {
    let joints = ti_vec![Joint {
        name: "Hips".to_owned(),
        parent: None,
        offset: DVec3::ZERO,
        channels: vec![Channel::Rotation(Axis::Z)],
        ends: vec![DVec3::Y],
    }];
    let clip = Clip::new(Arc::new(Skeleton { joints }), 1.0 / 24.0, degrees.to_vec());
    let body = RigPart {
        parent: None,
        is_rooted: true,
        tip: dvec3(0.0, 100.0, 0.0),
        drive: Some(Drive {
            joint: 0.into(),
            tip: None,
            follow: Follow::Change,
        }),
        ..hanging(0.into(), DVec3::ZERO, DVec3::Y, None)
    };
    let tail = hanging(0.into(), DVec3::ZERO, dvec3(0.0, -30.0, 0.0), Some(1.0));
    let rig = Rig {
        parts: ti_vec![body, tail],
        ..Rig::default()
    };
    (clip, rig)
}

/// The angle of the tail about z, frame by frame.
fn tail_angles(degrees: &[f64]) -> Vec<f64> {
    let (clip, rig) = turning(degrees);
    let played = retarget(&clip, &rig, &Landmarks::default());
    let down = |frame: usize| placed(&rig, &played, frame).raw[1].rotation * DVec3::Y;
    (0..clip.frames)
        .map(|frame| angle(DVec3::NEG_Y, down(frame)).copysign(down(frame).x))
        .collect()
}

#[test]
fn a_resting_figure_does_not_drift() {
    let angles = tail_angles(&[0.0; 240]);
    assert!(angles.iter().all(|angle| angle.abs() < 1e-9), "{angles:?}");
    // A body that leans for good: the tail comes to rest between where it is drawn and straight down.
    let leaning: Vec<f64> = (0..480)
        .map(|frame| f64::from(frame.min(48)) * 0.5)
        .collect();
    let angles = tail_angles(&leaning);
    let last = &angles[400..];
    let spread = last.iter().copied().fold(f64::MIN, f64::max)
        - last.iter().copied().fold(f64::MAX, f64::min);
    assert!(spread < 0.01, "{spread}");
    assert!((1.0..23.0).contains(&last[0]), "{}", last[0]);
}

#[test]
fn a_part_that_swings_lags_and_overshoots() {
    let turn: Vec<f64> = (0..72)
        .map(|frame: i32| f64::from((frame - 10).clamp(0, 4)) * 10.0)
        .collect();
    let angles = tail_angles(&turn);
    let rest = angles[71];
    assert!(angles[..4].iter().all(|angle| angle.abs() < 1e-6));
    let lag = turn[12] - angles[12];
    assert!(lag > 5.0, "it lags by {lag}°");
    let over = angles.iter().copied().fold(f64::MIN, f64::max) - rest;
    assert!(over > 3.0, "it overshoots by {over}°");
    assert!((angles[60] - rest).abs() < 1.0, "it comes to rest");
}

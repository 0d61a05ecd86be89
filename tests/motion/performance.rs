//! Laws of performances: what timing and emphasis do to the motion of a figure.

use std::collections::BTreeSet;

use glam::DQuat;
use okoshi::internals::labels::{Facing, FigurePartId};
use okoshi::internals::mocap::resample::TimeMap;
use okoshi::internals::retarget::{Landmarks, RetargetedClip, Rig, Turns, retarget};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use crate::retarget::clips::{FILES, clip};
use crate::retarget::rigs::{Limbs, biped, dog, part};
use crate::retarget::{apart, placed};

/// Every figure with every clip.
fn all(mut check: impl FnMut(&str, &Rig, &okoshi::internals::mocap::Clip, &Landmarks)) -> usize {
    let mut checked = 0;
    for file in FILES {
        let prepared = clip(file);
        let landmarks = Landmarks::of(&prepared.anatomy);
        for limbs in Limbs::ALL {
            for rig in [
                biped(&prepared.anatomy, limbs, 2),
                dog(&prepared.anatomy, Facing::Right),
            ] {
                check(file, &rig, &prepared.clip, &landmarks);
                checked += 1;
            }
        }
    }
    checked
}

#[test]
fn a_map_that_changes_nothing_changes_nothing() {
    let checked = all(|file, rig, clip, landmarks| {
        let last = clip.frames - 1;
        let same = TimeMap::through(&[[0, 0], [last / 3, last / 3], [last, last]]);
        let timed = Turns::new(clip, rig, landmarks).timed(&same).travel();
        assert_eq!(timed, retarget(clip, rig, landmarks), "{file}");
    });
    assert_eq!(checked, 24);
}

#[test]
fn the_key_pose_stands_in_the_key_frame() {
    let checked = all(|file, rig, clip, landmarks| {
        let (last, whole) = (clip.frames - 1, retarget(clip, rig, landmarks));
        for (input, motion, end) in [
            (last / 4, last / 2, last),
            (last * 2, last / 3, last * 3),
            (7, last, 30),
            (31, last / 2, 31),
        ] {
            let points = if input == end {
                vec![[0, 0], [input, motion]]
            } else {
                vec![[0, 0], [input, motion], [end, last]]
            };
            let map = TimeMap::through(&points);
            let timed = Turns::new(clip, rig, landmarks).timed(&map).travel();
            assert_eq!(timed.grounded.len(), end + 1);
            for (timed, whole) in timed.rotations.iter().zip(&whole.rotations) {
                let (Some(timed), Some(whole)) = (timed, whole) else {
                    assert_eq!(timed.is_some(), whole.is_some());
                    continue;
                };
                assert_eq!(timed[0], whole[0], "{file}");
                let same = timed[input] == whole[motion] || timed[input] == -whole[motion];
                assert!(same, "{file}: {} {}", timed[input], whole[motion]);
            }
        }
    });
    assert_eq!(checked, 24);
}

/// Feet that were on the ground are there for the same share of the time, and stay where they are, however slow the motion becomes.
#[test]
fn contacts_go_through_the_map() {
    let mut contacts = 0;
    let checked = all(|file, rig, clip, landmarks| {
        let last = clip.frames - 1;
        let whole = retarget(clip, rig, landmarks);
        let share = |clip: &RetargetedClip| {
            let on_ground = clip.grounded.iter().filter(|grounded| **grounded);
            on_ground.count() as f64 / clip.grounded.len() as f64
        };
        for factor in [2, 3] {
            let map = TimeMap::through(&[[0, 0], [last * factor, last]]);
            let slow = Turns::new(clip, rig, landmarks).timed(&map).travel();
            let [before, now] = [&whole, &slow].map(share);
            // Frames in which one foot takes over from another do not count, and are shorter in slow motion.
            let gained = now - before;
            assert!((-0.02..0.08).contains(&gained), "{file}: {before} {now}");
            for frame in 0..=last {
                let heights = [(&whole, frame), (&slow, frame * factor)].map(|(clip, frame)| {
                    let nodes = placed(rig, clip, frame);
                    nodes.raw[0].position.y
                });
                let size = rig.parts.iter().map(|part| part.tip.y).fold(0.0, f64::max);
                assert!(
                    (heights[0] - heights[1]).abs() < 1e-9 * size,
                    "{file}: {frame}"
                );
            }
            contacts += slow.grounded.iter().filter(|grounded| **grounded).count();
        }
    });
    assert_eq!(checked, 24);
    assert!(contacts > 1000, "{contacts} frames in contact");
}

/// The rotation of a part relative to its parent, frame by frame.
fn locals(rig: &Rig, clip: &RetargetedClip, part: FigurePartId) -> Vec<DQuat> {
    let frames = 0..clip.grounded.len();
    let local = |frame| {
        let nodes = placed(rig, clip, frame);
        let above = rig.parts[part]
            .parent
            .map_or(DQuat::IDENTITY, |parent| nodes[parent].rotation);
        above.inverse() * nodes[part].rotation
    };
    frames.map(local).collect()
}

#[test]
fn ratios_follow_equation_1() {
    let (mut damped, mut compared, mut skipped) = (0, 0, 0);
    let checked = all(|file, rig, clip, landmarks| {
        let count = rig.parts.len();
        let whole = retarget(clip, rig, landmarks);
        let of = |ratios: &TiSlice<FigurePartId, Option<f64>>| {
            Turns::new(clip, rig, landmarks).damped(ratios).travel()
        };
        assert_eq!(of(&ti_vec![Some(1.0); count]), whole, "{file}");
        assert_eq!(of(&ti_vec![None; count]), whole, "{file}");
        // The last limb and its parent, and every other part.
        let last = FigurePartId::from(count - 1);
        let chain = [Some(last), rig.parts[last].parent];
        let every_other = (0..count).map(|part| (part > 0 && part % 2 == 0).then_some(0.3));
        let chain = (rig.parts.keys()).map(|part| chain.contains(&Some(part)).then_some(0.0));
        for ratios in [chain.collect::<TiVec<_, _>>(), every_other.collect()] {
            let edited = of(&ratios);
            for (part, ratio) in ratios.iter_enumerated().skip(1) {
                let [before, now] = [&whole, &edited].map(|clip| locals(rig, clip, part));
                let ratio = ratio.unwrap_or(1.0);
                damped += usize::from(ratio < 1.0 && whole.rotations[part].is_some());
                for frame in 0..before.len() {
                    let [full, left] = [&before, &now].map(|turns| apart(turns[frame], turns[0]));
                    // Limbs that turn by more than half a turn are followed, and their angle is not what `apart` measures.
                    let is_far = full > 150.0;
                    skipped += usize::from(is_far);
                    compared += 1;
                    let fits = is_far || (left - full * ratio).abs() < 1e-4;
                    assert!(fits, "{file}: {part:?} in frame {frame}: {full} {left}");
                }
            }
        }
    });
    assert_eq!(checked, 24);
    assert!(damped > 100, "{damped} parts were damped");
    assert!(
        compared > 50_000 && skipped * 50 < compared,
        "{skipped} of {compared} skipped"
    );
}

/// What hangs on a damped part goes along with it.
#[test]
fn parts_without_a_drive_go_along() {
    let prepared = clip(FILES[0]);
    let landmarks = Landmarks::of(&prepared.anatomy);
    let mut rig = biped(&prepared.anatomy, Limbs::Bound, 2);
    let hand = rig.parts.last_key().expect("a hand");
    let ends = [rig.parts[hand].tip, rig.parts[hand].tip * 1.1];
    let glove = rig.parts.push_and_get_key(part(Some(hand), false, ends));
    let mut ratios = ti_vec![None; rig.parts.len()];
    ratios[hand] = Some(0.5);
    let edited = Turns::new(&prepared.clip, &rig, &landmarks)
        .damped(&ratios)
        .travel();
    let turns: BTreeSet<String> = locals(&rig, &edited, glove)
        .iter()
        .map(|turn| format!("{:.6}", apart(*turn, DQuat::IDENTITY)))
        .collect();
    assert_eq!(turns.len(), 1, "{turns:?}");
}

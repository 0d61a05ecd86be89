//! Limited animation: the fast code against the plain algorithm, and the promises of the thesis.

#[path = "../common/plain_limited.rs"]
mod plain_limited;

use std::fs::File;
use std::path::Path;
use std::sync::Arc;

use crate::retarget::clips::clip;
use fastrand::Rng;
use glam::{DVec3, dvec3};
use okoshi::internals::labels::label_clip;
use okoshi::internals::limited::Measured;
use okoshi::internals::limited::{
    Camera, Cut, Drawing, Exposure, Length, MAX_OMITTED_RUN, Method, Options, Poses, compare,
    error, every, limit, ssd,
};
use okoshi::internals::mocap::bvh;
use okoshi::internals::mocap::{Axis, Channel, Clip, Joint, Skeleton};
use okoshi::internals::motion::PointChoice;
use okoshi::internals::motion::edit::{self, ExposureMethod, edit};
use okoshi::internals::prepare;
use plain_limited::{Plain, plain, repeats};
use typed_index_collections::ti_vec;

/// A random point of a grid with `places` places in each direction.
fn place(random: &mut Rng, places: u64) -> DVec3 {
    let [x, y, z] = [(); 3].map(|()| random.u64(..places) as f64);
    dvec3(x, y, z)
}

/// Motions of all kinds: few poses in random order, still stretches, even walks, smooth motions and random ones.
fn motion(random: &mut Rng, kind: u64, frames: usize, joints: usize) -> Vec<DVec3> {
    let poses: Vec<Vec<DVec3>> = (0..3)
        .map(|_| (0..joints).map(|_| place(random, 3)).collect())
        .collect();
    let mut out = Vec::with_capacity(frames * joints);
    let mut still = 0;
    for frame in 0..frames {
        if frame > 0 && still > 0 {
            still -= 1;
            out.extend_from_within((frame - 1) * joints..);
            continue;
        }
        still = if random.u64(..8) == 0 {
            random.u64(..6)
        } else {
            0
        };
        match kind {
            0 => out.extend(&poses[random.u64(..3) as usize]),
            1 => out.extend((0..joints).map(|_| place(random, 3))),
            2 => out.extend((0..joints).map(|joint| DVec3::splat((frame + joint) as f64))),
            3 => {
                let time = frame as f64 * 0.3;
                let sway =
                    |joint: usize| dvec3((time + joint as f64).sin(), time.cos(), 0.1 * time);
                out.extend((0..joints).map(sway));
            }
            _ => out.extend((0..joints).map(|_| place(random, 1 << 30))),
        }
    }
    out
}

fn cut(poses: Poses<'_>, [omit, hold]: [usize; 2], kept: bool) -> Cut {
    let length = if kept {
        Length::Kept
    } else {
        Length::Shortened
    };
    limit(poses, &Options { omit, hold, length })
}

/// Compares frame by frame with the plain algorithm, and checks what the definition promises.
fn check(positions: &[DVec3], joints: usize, steps: [usize; 2], kept: bool) -> Cut {
    let repeats = repeats(positions, joints);
    let poses = Poses::new(positions, joints);
    let cut = check_repeating(positions, joints, &repeats, steps, kept);
    assert_eq!(
        cut,
        self::cut(poses, steps, kept),
        "equal positions are equal poses"
    );
    cut
}

/// The same for frames of which these equal the one before.
fn check_repeating(
    positions: &[DVec3],
    joints: usize,
    repeats: &[bool],
    steps: [usize; 2],
    kept: bool,
) -> Cut {
    let frames = positions.len() / joints.max(1);
    let poses = Poses::new(positions, joints).repeating(repeats);
    let cut = cut(poses, steps, kept);
    let held = cut.held.iter().map(|held| (held.covered, held.by));
    let fast = Plain {
        shown: cut.exposure.sources.to_vec(),
        omitted: cut.omitted.clone(),
        duplicated: cut.duplicated.clone(),
        held: held.collect(),
    };
    assert_eq!(
        fast,
        plain(positions, joints, repeats, steps, kept, None),
        "{positions:?} {steps:?} {kept}"
    );

    let whole = self::cut(poses, [0; 2], kept).exposure;
    let [omitted, held] = [cut.omitted.len(), cut.held.len()];
    let drawings: Vec<Drawing> = cut.exposure.drawings().collect();
    assert_eq!(
        drawings.len() + omitted + held,
        whole.drawings().count(),
        "each step saves a drawing"
    );
    assert_eq!(
        cut.exposure.len(),
        if kept { frames } else { frames - omitted }
    );
    assert_eq!(cut.duplicated.len(), if kept { omitted } else { 0 });
    assert_eq!([cut.omissions.done, cut.holds.done], [omitted, held]);
    assert_eq!(cut.omissions.shortfall() + omitted, steps[0]);
    assert_eq!(cut.holds.shortfall() + held, steps[1]);
    assert!(cut.exposure.sources.is_sorted());
    assert_eq!(cut.exposure.sources.first(), (frames > 0).then_some(&0));
    let stood = |source: u32| whole.drawings().find(|drawing| drawing.source == source);
    for drawing in &drawings {
        let before = stood(drawing.source).map_or(0, |drawing| drawing.length);
        assert!(
            drawing.length <= before.max(3),
            "{drawing:?} stands for too long"
        );
    }
    assert!(cut.omitted_run <= omitted);
    cut
}

#[test]
fn the_fast_code_does_what_the_plain_code_does() {
    let mut random = Rng::with_seed(1);
    for round in 0..4000 {
        let frames = match round % 4 {
            0 => random.u64(..5),
            1 => random.u64(..16),
            2 => random.u64(..40),
            _ => random.u64(..90),
        } as usize;
        let joints = 1 + random.u64(..3) as usize;
        let kind = random.u64(..5);
        let positions = motion(&mut random, kind, frames, joints);
        let mut steps = || match random.u64(..4) {
            0 => 0,
            1 => random.u64(..6) as usize,
            2 => random.u64(..1 + frames as u64) as usize,
            _ => usize::MAX,
        };
        let steps = [steps(), steps()];
        check(&positions, joints, steps, true);
        check(&positions, joints, steps, false);
        for kept in [true, false] {
            let key = random.u64(..1 + frames as u64) as usize;
            check_keeping(&positions, joints, key, steps, kept);
        }
    }
}

/// The same with a frame that must stay shown; a frame that does not exist changes nothing.
fn check_keeping(positions: &[DVec3], joints: usize, key: usize, steps: [usize; 2], length: bool) {
    let poses = Poses::new(positions, joints);
    let cut = cut(poses.keeping(Some(key)), steps, length);
    let repeats = repeats(positions, joints);
    let plain = plain(positions, joints, &repeats, steps, length, Some(key));
    let held = cut.held.iter().map(|held| (held.covered, held.by));
    let fast = Plain {
        shown: cut.exposure.sources.clone(),
        omitted: cut.omitted.clone(),
        duplicated: cut.duplicated.clone(),
        held: held.collect(),
    };
    assert_eq!(fast, plain, "{positions:?} {steps:?} {key}");
    let whole = self::cut(poses, [0; 2], length).exposure;
    if let Some(pose) = whole.sources.get(key) {
        assert!(cut.exposure.sources.contains(pose), "frame {key} stays");
        if length {
            assert_eq!(
                cut.exposure.sources[key], *pose,
                "frame {key} stays in place"
            );
        }
    }
}

#[test]
fn real_motions_are_cut_as_the_plain_code_does() {
    let files = [
        "examples/motion/boxing.bvh",
        "examples/motion/kick.bvh",
        "examples/motion/walk.bvh",
        "examples/motion/zombie-walk.bvh",
        "tests/motion/data/mixed_orders.bvh",
        "tests/motion/data/mocapbank.bvh",
        "tests/motion/data/rotation_first.bvh",
    ];
    for file in files {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
        let clip = bvh::read(File::open(path).expect("a file"))
            .expect("a motion")
            .clip;
        let positions = clip.positions();
        let anatomy = label_clip(&clip);
        let third = clip.frames / 3;
        for choice in [PointChoice::Seen, PointChoice::All] {
            let Measured {
                points,
                per_frame,
                repeats,
            } = Measured::of_clip(&clip, &positions, &anatomy, choice);
            for steps in [[4, third], [0, third], [12, 5], [6, usize::MAX]] {
                for kept in [true, false] {
                    let cut = check_repeating(&points, per_frame, &repeats, steps, kept);
                    assert!(cut.exposure.len() <= clip.frames, "{file}");
                }
            }
        }
    }
}

/// A body of which only the head turns, about the axis through its end.
fn nodding(end: Vec<DVec3>, axis: Axis) -> Clip {
    let joint = |name: &str, parent, offset, channels, ends| Joint {
        name: name.to_owned(),
        parent,
        offset,
        channels,
        ends,
    };
    let joints = ti_vec![
        joint("Hips", None, DVec3::ZERO, Vec::new(), Vec::new()),
        joint("Spine", Some(0.into()), DVec3::Y, Vec::new(), Vec::new()),
        joint(
            "Head",
            Some(1.into()),
            DVec3::Y,
            vec![Channel::Rotation(axis)],
            end,
        ),
    ];
    let turns = (0..24).map(|frame| 20.0 * (f64::from(frame) * 0.26).sin());
    Clip::new(Arc::new(Skeleton { joints }), 1.0 / 24.0, turns.collect())
}

#[test]
fn a_nod_keeps_its_drawings() {
    for (end, axis) in [
        (vec![DVec3::Y], Axis::X),
        (vec![DVec3::Y], Axis::Y),
        (Vec::new(), Axis::X),
    ] {
        let moves = !end.is_empty() && axis == Axis::X;
        let clip = nodding(end, axis);
        let measured = Measured::of_clip(
            &clip,
            &clip.positions(),
            &label_clip(&clip),
            PointChoice::Seen,
        );
        assert_eq!(
            measured.poses().speeds().iter().any(|speed| *speed > 0.0),
            moves
        );
        let whole = cut(measured.poses(), [0; 2], true);
        assert_eq!(whole.exposure.drawings().count(), 24);
        let held = cut(measured.poses(), [0, 8], true);
        assert_eq!((held.holds.done, held.exposure.drawings().count()), (8, 16));
    }
}

/// Fingers do not outweigh the body.
#[test]
fn speed_is_measured_where_it_is_seen() {
    let prepared = clip("tests/motion/data/mixed_orders.bvh");
    let joints = prepared.clip.skeleton.joints.len();
    let of = |choice| {
        Measured::of_clip(
            &prepared.clip,
            &prepared.positions,
            &prepared.anatomy,
            choice,
        )
    };
    let (seen, all) = (of(PointChoice::Seen), of(PointChoice::All));
    assert_eq!((all.per_frame, &all.points), (joints, &prepared.positions));
    assert!(seen.per_frame < joints, "{} of {joints}", seen.per_frame);
    let hands = prepared
        .anatomy
        .limbs
        .iter()
        .filter(|limb| limb.tip.is_some());
    assert_eq!(hands.count(), 4);
    assert_eq!(seen.repeats, all.repeats);
}

#[test]
fn frames_that_are_shown_keep_their_numbers() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/motion/zombie-walk.bvh");
    let clip = bvh::read(File::open(path).expect("a file"))
        .expect("a motion")
        .clip;
    let how = ExposureMethod::Limited {
        omit: Some(3),
        hold: Some(8),
        length: Length::Kept,
    };
    let prepared = prepare::prepare(clip.clone(), &prepare::Options::default()).expect("a rate");
    let edited = edit(
        prepared,
        &edit::Options {
            method: how,
            points: PointChoice::All,
            camera: None,
            key: None,
        },
    );
    let mut text = Vec::new();
    edited
        .write_bvh(&mut text)
        .expect("memory takes everything");
    let again = bvh::read_bytes(&text).expect("a motion").clip;
    let sheet = edited.exposure.expect("it was cut");
    assert_eq!(again.frames, clip.frames);
    for (frame, source) in sheet.sources.iter().enumerate() {
        assert_eq!(again.row(frame), clip.row(*source as usize), "{frame}");
    }
}

#[test]
fn the_shortest_motions_are_cut() {
    let at = |places: &[f64]| -> Vec<DVec3> { places.iter().map(|x| DVec3::X * *x).collect() };
    let most = [usize::MAX; 2];
    assert!(check(&[], 0, most, true).exposure.is_empty());
    assert!(check(&[], 1, most, true).exposure.is_empty());
    assert_eq!(check(&at(&[1.0]), 1, most, true).exposure.sources, [0]);
    // Nothing could be shown longer in place of the omitted pose.
    let two = check(&at(&[1.0, 2.0]), 1, [1, 0], true);
    assert_eq!(two.exposure.sources, [0, 1]);
    assert_eq!(two.omissions.shortfall(), 1);
    assert_eq!(
        check(&at(&[1.0, 2.0]), 1, [1, 0], false).exposure.sources,
        [0]
    );
    assert_eq!(
        check(&at(&[1.0, 2.0]), 1, [0, 1], true).exposure.sources,
        [0, 0]
    );
    let three = check(&at(&[0.0, 1.0, 5.0]), 1, [1, 0], true);
    assert_eq!(three.exposure.sources, [0, 0, 1]);
    assert_eq!([three.omitted, three.duplicated], [[2], [0]]);
}

#[test]
fn incomplete_frames_are_ignored() {
    let positions = [0.0, 1.0, 2.0, 3.0, 4.0].map(DVec3::splat);
    assert_eq!(
        cut(Poses::new(&positions, 2), [0; 2], true).exposure.len(),
        2
    );
    assert_eq!(Poses::new(&positions, 2).speeds(), [0.0, 24.0]);
}

#[test]
fn of_equally_fast_poses_the_first_is_taken() {
    let walk: Vec<DVec3> = (0..8).map(|frame| DVec3::X * frame as f64).collect();
    // Without the first step the second is the greatest, then the third.
    assert_eq!(check(&walk, 1, [3, 0], false).omitted, [1, 2, 3]);
    let held = check(&walk, 1, [0, 2], true).held;
    assert_eq!([held[0].covered, held[0].by], [1, 0]);
    assert_eq!([held[1].covered, held[1].by], [3, 2]);
}

#[test]
fn still_poses_may_be_shown_longer_than_copies() {
    let mut still = vec![DVec3::ZERO; 9];
    still.extend([1.0, 3.0, 6.0, 10.0].map(DVec3::splat));
    let cut = check(&still, 1, [0, usize::MAX], true);
    assert_eq!(
        cut.exposure.sources,
        [0, 0, 0, 0, 0, 0, 0, 0, 0, 9, 9, 11, 11]
    );
    assert_eq!(cut.exposure.keys().collect::<Vec<_>>(), [0, 9, 11]);
    // Equal poses that only become neighbours later are two.
    let back = [0.0, 9.0, 0.0, 1.0].map(DVec3::splat);
    let cut = check(&back, 1, [1, 0], true);
    assert_eq!(cut.exposure.sources, [0, 0, 2, 3]);
    assert_eq!(cut.exposure.drawings().count(), 3);
}

#[test]
fn omissions_concentrate_where_it_is_fast() {
    // Even steps, with a fast swing in the middle.
    let mut at = 0.0;
    let swing: Vec<DVec3> = (0..60)
        .map(|frame| {
            let step = if (24..40).contains(&frame) {
                4.0
            } else {
                0.1 + 0.001 * f64::from(frame)
            };
            at += step;
            DVec3::X * at
        })
        .collect();
    let usual = check(&swing, 1, [4, 0], true);
    assert_eq!(usual.omitted_run, 4);
    let torn = check(&swing, 1, [8, 0], true);
    assert_eq!(torn.omitted_run, 8);
    assert!(torn.omitted_run > MAX_OMITTED_RUN);
    // The omissions at the end have no pose after them.
    let end = [0.0, 1.0, 2.1, 3.3, 4.6, 20.0, 40.0, 60.0].map(DVec3::splat);
    assert_eq!(check(&end, 1, [3, 0], true).omitted_run, 3);
    // Two fast moments far from each other.
    let twice: Vec<DVec3> = (0..40)
        .map(|frame| DVec3::new(f64::from(frame) * 0.01, 0.0, 0.0))
        .enumerate()
        .map(|(frame, at)| match frame {
            10..20 => at + DVec3::Y * 10.0,
            20..30 => at,
            30.. => at + DVec3::Z * 9.0,
            _ => at,
        })
        .collect();
    assert!(check(&twice, 1, [3, 0], true).omitted_run < 4);
}

#[test]
fn recommended_options_are_those_of_the_thesis() {
    let options = Options::recommended(129);
    assert_eq!([options.omit, options.hold], [4, 43]);
    assert_eq!(options.length, Length::Kept);
}

#[test]
fn holds_end_near_half_of_the_frames() {
    let mut random = Rng::with_seed(9);
    let positions = motion(&mut random, 4, 3000, 2);
    let frames = cut(Poses::new(&positions, 2), [0; 2], true)
        .exposure
        .drawings()
        .count();
    let done = cut(Poses::new(&positions, 2), [0, usize::MAX], true)
        .holds
        .done;
    let share = done as f64 / frames as f64;
    assert!(
        (0.4..0.6).contains(&share),
        "{share} of the frames could be held"
    );
}

#[test]
fn positions_that_are_not_finite_are_limited_too() {
    let odd = [
        0.0,
        f64::NAN,
        1.0,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e200,
        -1e200,
        2.0,
        2.5,
    ];
    let odd = odd.map(DVec3::splat);
    for steps in [[0, 0], [1, 1], [4, 3], [usize::MAX; 2]] {
        check(&odd, 1, steps, true);
        check(&odd, 1, steps, false);
    }
    assert_eq!(ssd(&[DVec3::NAN], &[DVec3::ONE]), f64::INFINITY);
    assert_eq!(ssd(&[DVec3::INFINITY], &[DVec3::INFINITY]), f64::INFINITY);
}

#[test]
fn the_distance_of_two_poses_is_symmetric_and_bitwise_stable() {
    let mut random = Rng::with_seed(4);
    let mut pose = || -> Vec<DVec3> {
        let places = (0..30).map(|_| place(&mut random, 1 << 30) / 7.3);
        places.collect()
    };
    for _ in 0..100 {
        let [a, b] = [pose(), pose()];
        assert_eq!(ssd(&a, &b).to_bits(), ssd(&b, &a).to_bits());
        assert_eq!(ssd(&a, &a), 0.0);
        let both = [a.clone(), b.clone()].concat();
        assert_eq!(
            Poses::new(&both, 30).speeds()[1].to_bits(),
            ssd(&a, &b).to_bits()
        );
    }
    assert_eq!(
        ssd(
            &[DVec3::ZERO, DVec3::ONE],
            &[dvec3(1.0, 2.0, 2.0), DVec3::ZERO]
        ),
        12.0
    );
}

#[test]
fn errors_are_measured_against_the_source_at_the_same_time() {
    let walk: Vec<DVec3> = (0..6).map(|frame| DVec3::X * frame as f64).collect();
    let twos = error(Poses::new(&walk, 1), 10.0, &every(6, 2));
    assert_eq!(twos.drawings, 3);
    assert!((twos.rms - 0.5_f64.sqrt()).abs() < 1e-15);
    assert_eq!(twos.percent, Some(10.0 * twos.rms));
    assert_eq!(error(Poses::new(&walk, 1), 0.0, &every(6, 2)).percent, None);
    assert_eq!(error(Poses::new(&walk, 1), f64::NAN, &every(6, 1)).rms, 0.0);
    // Beyond the source there is nothing to compare with.
    assert_eq!(
        error(Poses::new(&walk, 1), 1.0, &Exposure::new(vec![0, 99])).rms,
        0.0
    );
    assert_eq!(
        error(Poses::new(&[], 0), 1.0, &Exposure::default()).rms,
        0.0
    );
    let all = compare(Poses::new(&walk, 1), 1.0, &every(6, 2));
    assert_eq!(
        all.map(|(method, _)| method),
        [Method::Asked, Method::Twos, Method::Threes, Method::Best]
    );
    assert_eq!(all[0].1, all[1].1);
    assert_eq!(all[3].1.drawings, 3);
}

#[test]
fn the_best_drawings_are_never_worse_than_others_of_the_same_number() {
    let mut random = Rng::with_seed(21);
    let mut compared = 0;
    for round in 0..60 {
        let frames = 20 + random.u64(..100) as usize;
        let positions = motion(&mut random, round % 5, frames, 2);
        let asked = check(&positions, 2, [3, frames / 3], true).exposure;
        for exposure in [asked, every(frames as u32, 2), every(frames as u32, 3)] {
            let [asked, .., best] =
                compare(Poses::new(&positions, 2), 1.0, &exposure).map(|(_, error)| error);
            // Other methods may draw equal neighbours twice, which the best drawings never do.
            if best.drawings == asked.drawings {
                compared += 1;
                assert!(best.rms <= asked.rms * (1.0 + 1e-9), "{best:?} {asked:?}");
            }
        }
    }
    assert!(
        compared >= 60,
        "only {compared} of 180 have the same number"
    );
}

#[test]
fn a_camera_sees_what_turns_towards_it() {
    let corners = [dvec3(-1.0, -2.0, -3.0), dvec3(1.0, 2.0, 3.0)];
    let close = |a: DVec3, b: DVec3| assert!(a.distance(b) < 1e-12, "{a} is not {b}");
    let see = |yaw: f64, pitch: f64, distance: Option<f64>| {
        Camera {
            yaw,
            pitch,
            distance,
        }
        .project(&corners)[1]
    };
    close(see(0.0, 0.0, None), dvec3(1.0, 2.0, 0.0));
    // From the side of +x, +z is on the left.
    close(see(90.0, 0.0, None), dvec3(-3.0, 2.0, 0.0));
    // From above, points nearer to the viewer are lower.
    close(see(0.0, 90.0, None), dvec3(1.0, -3.0, 0.0));
    close(see(360_000_090.0, 0.0, None), dvec3(-3.0, 2.0, 0.0));
    // Three units nearer than the centre, at a distance of twelve.
    close(see(0.0, 0.0, Some(12.0)), dvec3(1.0, 2.0, 0.0) * 12.0 / 9.0);
    // Behind the camera: as near as possible.
    close(see(0.0, 0.0, Some(1.0)), dvec3(1.0, 2.0, 0.0) * 100.0);
    close(
        see(f64::NAN, f64::INFINITY, Some(-1.0)),
        dvec3(1.0, 2.0, 0.0),
    );
    assert!(Camera::default().project(&[]).is_empty());
    assert_eq!(Camera::default().project(&[DVec3::NAN]).len(), 1);
}

#[test]
fn motion_along_the_view_is_no_motion_to_a_camera() {
    let far: Vec<DVec3> = (0..9).map(|frame| DVec3::Z * f64::from(frame)).collect();
    let seen = Camera::default().project(&far);
    assert_eq!(
        limit(Poses::new(&seen, 1), &Options::recommended(9))
            .exposure
            .drawings()
            .count(),
        1
    );
    assert!(
        limit(Poses::new(&far, 1), &Options::recommended(9))
            .exposure
            .drawings()
            .count()
            > 1
    );
}

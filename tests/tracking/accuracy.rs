//! How near tracks are to the truth.
//!
//! The rules and their numbers were fitted to the clips with the seeds [`FITTED`]. Each clip is also measured with other patches behind
//! the same marks and other noise, which nobody looked at ([`HELD_BACK`]). The same is required there, except where a
//! mark can be taken for a patch (`check_confusable`).

use std::sync::Arc;

use glam::DVec2;
use okoshi::internals::tracking::{Follower, Frame, Learner, Mark, Tracker};

use super::synthetic::{Disc, FITTED, Scene, ellipse};

const RED: (&str, [u8; 3]) = ("red", [205, 40, 45]);
const GREEN: (&str, [u8; 3]) = ("green", [40, 150, 60]);
const BLUE: (&str, [u8; 3]) = ("blue", [40, 70, 190]);
const YELLOW: (&str, [u8; 3]) = ("yellow", [225, 205, 40]);

/// The seeds of clips that were not looked at.
const HELD_BACK: [[u64; 2]; 3] = [[4_001, 100_000], [4_002, 200_000], [4_003, 300_000]];
/// Frames of each clip.
const FRAMES: usize = 160;
/// A mark is wrong if it is farther than this from the truth, pixels.
const WRONG: f64 = 10.0;
/// A mark of which less is seen may be lost.
const SEEN: f64 = 0.75;
/// A mark of which less is seen is gone.
const GONE: f64 = 0.1;

/// How well the marks of a clip were found.
#[derive(Debug)]
struct Accuracy {
    /// Errors of the frames that are not lost, pixels: the middle one, and the one that only 5 % exceed.
    median: f64,
    p95: f64,
    /// Marks that are seen well and said to be lost, of all that are seen well.
    lost: f64,
    /// Marks that are said to be where they are not, of all.
    silently_wrong: usize,
    /// Marks that are gone, and of these the ones that are said to be lost.
    gone: usize,
    gone_and_lost: usize,
}

/// Tracks a clip.
fn accuracy(name: &str, scene: &Scene) -> Accuracy {
    let background = scene.background();
    let frames: Vec<Vec<u8>> = (0..FRAMES)
        .map(|frame| scene.frame(&background, frame))
        .collect();
    let marks = scene.discs.iter().map(|disc| {
        // As it is named: the hue of a word.
        let named = [
            ("red", [255, 0, 0]),
            ("green", [0, 128, 0]),
            ("blue", [0, 0, 255]),
            ("yellow", [255, 255, 0]),
        ];
        let named = named
            .iter()
            .find(|(name, _)| *name == disc.mark.0)
            .expect("a colour for it");
        Mark::new(disc.mark.0, named.1).expect("it is coloured")
    });
    let mut learner = Learner::new(scene.size, marks.collect());
    for frame in &frames {
        learner.push(Frame::new(scene.size, frame).expect("it has pixels"));
    }
    let mut follower = Follower::new(learner.learned().expect("they are in the clip"));
    for frame in &frames {
        follower.push(Frame::new(scene.size, frame).expect("it has pixels"));
    }
    let times = (0..FRAMES).map(|frame| frame as f64 / 24.0).collect();
    let tracks = follower.tracks(times);
    let mut errors = Vec::new();
    let (mut seen, mut lost, mut silently_wrong, mut gone, mut gone_and_lost) = (0, 0, 0, 0, 0);
    for number in 0..FRAMES {
        for (truth, mark) in scene.truth(number).iter().zip(&tracks.marks) {
            seen += usize::from(truth.visible >= SEEN);
            gone += usize::from(truth.visible < GONE);
            if mark.is_lost[number] {
                lost += usize::from(truth.visible >= SEEN);
                gone_and_lost += usize::from(truth.visible < GONE);
            } else {
                let error = mark.points[number].distance(truth.at);
                errors.push(error);
                silently_wrong += usize::from(error > WRONG);
            }
        }
    }
    errors.sort_by(f64::total_cmp);
    let accuracy = Accuracy {
        median: errors[errors.len() / 2],
        p95: errors[errors.len() * 95 / 100],
        lost: lost as f64 / seen as f64,
        silently_wrong,
        gone,
        gone_and_lost,
    };
    eprintln!("{name}, seeds {:?}: {accuracy:?}", scene.seeds);
    accuracy
}

/// What must hold in every clip, with all seeds.
fn check(name: &str, scene: &Scene) -> Accuracy {
    let held_back = held_back(name, scene);
    let fitted = assert_accurate(accuracy(name, scene));
    for accuracy in held_back {
        assert_accurate(accuracy);
    }
    fitted
}

/// How well the clips are tracked that were held back.
fn held_back(name: &str, scene: &Scene) -> [Accuracy; 3] {
    HELD_BACK.map(|seeds| {
        let scene = Scene {
            seeds,
            ..scene.clone()
        };
        accuracy(name, &scene)
    })
}

/// What must hold in clips in which marks are taken for patches of their hue, without notice, if the patches are others than those that
/// the rules were fitted to: in at most so many of the 640 places of marks in each clip that was held back. The manual says so.
fn check_confusable(name: &str, scene: &Scene, most_wrong: usize) -> Accuracy {
    let held_back = held_back(name, scene);
    let fitted = assert_accurate(accuracy(name, scene));
    for accuracy in held_back {
        assert!(accuracy.median < 1.5, "{accuracy:?}");
        // One mark of four may be ambiguous for a part of the clip.
        assert!(accuracy.lost < 0.16, "{accuracy:?}");
        assert!(accuracy.silently_wrong <= most_wrong, "{accuracy:?}");
    }
    fitted
}

fn assert_accurate(accuracy: Accuracy) -> Accuracy {
    assert!(accuracy.median < 1.5, "{accuracy:?}");
    assert!(accuracy.p95 < 4.0, "{accuracy:?}");
    assert!(accuracy.lost < 0.05, "{accuracy:?}");
    assert_eq!(accuracy.silently_wrong, 0, "{accuracy:?}");
    assert_eq!(accuracy.gone_and_lost, accuracy.gone, "{accuracy:?}");
    accuracy
}

/// Four discs that cross each other's ways at up to 15 pixels a frame.
fn discs() -> Vec<Disc> {
    vec![
        Disc::new(RED, 8.0, |time| {
            ellipse(time, [160.0, 120.0], [110.0, 70.0], 15.0, 0.0)
        }),
        Disc::new(GREEN, 7.0, |time| {
            ellipse(time, [150.0, 110.0], [60.0, 90.0], 9.0, 0.3)
        }),
        Disc::new(BLUE, 9.0, |time| {
            ellipse(time, [170.0, 130.0], [120.0, 40.0], 11.0, 0.6)
        }),
        Disc::new(YELLOW, 6.0, |time| {
            ellipse(time, [140.0, 120.0], [40.0, 40.0], 4.0, 0.5)
        }),
    ]
}

fn scene(discs: Vec<Disc>) -> Scene {
    Scene {
        seeds: FITTED,
        size: [320, 240],
        discs,
        colorful: 14,
        patches: Vec::new(),
        noise: 6.0,
        shutter: 0.5,
        light: |_| 1.0,
    }
}

#[test]
fn crossing_marks_are_found_on_clutter() {
    check("crossing", &scene(discs()));
}

#[test]
fn noise_does_not_hide_marks() {
    check(
        "noise",
        &Scene {
            noise: 14.0,
            ..scene(discs())
        },
    );
}

#[test]
fn marks_that_blur_are_found_in_the_middle_of_their_way() {
    check(
        "blur",
        &Scene {
            shutter: 1.0,
            ..scene(discs())
        },
    );
}

#[test]
fn marks_that_leave_are_lost_until_they_return() {
    let mut discs = discs();
    discs[0].path = Arc::new(|time| ellipse(time, [160.0, 120.0], [230.0, 60.0], 12.0, 0.25));
    discs[1].path = Arc::new(|time| ellipse(time, [150.0, 120.0], [50.0, 190.0], 9.0, 0.0));
    let accuracy = check_confusable("leaving", &scene(discs), 24);
    assert!(accuracy.gone > FRAMES / 4, "{accuracy:?}");
}

#[test]
fn a_mark_that_is_gone_for_most_of_the_clip_is_found() {
    let mut discs = discs();
    discs.truncate(2);
    discs[0].path = Arc::new(|time| ellipse(time, [160.0, 120.0], [420.0, 40.0], 14.0, 0.25));
    let scene = Scene {
        noise: 10.0,
        // Still patches of its hue would be taken for it while it is gone.
        colorful: 0,
        ..scene(discs)
    };
    for seeds in [FITTED].into_iter().chain(HELD_BACK) {
        let scene = Scene {
            seeds,
            ..scene.clone()
        };
        let accuracy = accuracy("mostly gone", &scene);
        assert!(accuracy.gone > FRAMES / 2, "{accuracy:?}");
        assert!(accuracy.median < 1.5 && accuracy.p95 < 4.0, "{accuracy:?}");
        assert_eq!(accuracy.silently_wrong, 0, "{accuracy:?}");
    }
}

#[test]
fn marks_are_found_in_changing_light() {
    let light = |time: f64| 1.0 + 0.4 * (time / 11.0).sin();
    check_confusable(
        "light",
        &Scene {
            light,
            ..scene(discs())
        },
        1,
    );
}

#[test]
fn still_things_of_the_same_hue_are_no_marks() {
    let patches = vec![
        RED.1,
        GREEN.1,
        BLUE.1,
        YELLOW.1,
        [190, 60, 50],
        [60, 130, 80],
    ];
    check_confusable(
        "shared hue",
        &Scene {
            patches,
            ..scene(discs())
        },
        0,
    );
}

#[test]
fn a_mark_that_rests_for_most_of_the_clip_is_no_clutter() {
    let mut discs = discs();
    discs.truncate(1);
    discs[0].path = Arc::new(|time| match time {
        ..140.0 => DVec2::new(80.0, 60.0),
        _ => DVec2::new(80.0 + 8.0 * (time - 140.0), 60.0),
    });
    check("resting", &scene(discs));
}

#[test]
fn a_mark_that_moves_a_little_is_no_clutter() {
    let mut discs = discs();
    discs[1].path = Arc::new(|time| DVec2::new(80.0 + 2.0 * (time / 5.0).sin(), 60.0));
    let scene = Scene {
        colorful: 0,
        ..scene(discs)
    };
    check("moving a little", &scene);
}

#[test]
fn a_mark_that_never_moves_is_found() {
    let mut discs = discs();
    discs.truncate(1);
    discs[0].path = Arc::new(|_| DVec2::new(80.0, 60.0));
    check(
        "still",
        &Scene {
            colorful: 0,
            ..scene(discs)
        },
    );
}

#[test]
fn light_that_changes_over_things_of_the_same_hue_leaves_marks_alone() {
    let patches = vec![RED.1, GREEN.1, BLUE.1, YELLOW.1];
    let light = |time: f64| 1.0 + 0.4 * (time / 17.0).sin();
    check_confusable(
        "light, shared hue",
        &Scene {
            light,
            patches,
            ..scene(discs())
        },
        0,
    );
}

#[test]
fn a_hue_that_the_clip_has_not_is_refused_with_those_that_it_has() {
    let scene = Scene {
        colorful: 0,
        ..scene(discs())
    };
    let background = scene.background();
    let mut learner = Learner::new(
        scene.size,
        vec![Mark::new("left", [0, 200, 200]).expect("it is coloured")],
    );
    for frame in 0..10 {
        let frame = scene.frame(&background, frame);
        learner.push(Frame::new(scene.size, &frame).expect("it has pixels"));
    }
    let error = learner.learned().expect_err("it is not in the clip");
    assert_eq!(error.mark, 0);
    assert!(
        error.hues.contains(&"red") && error.hues.contains(&"blue"),
        "{error:?}"
    );
    assert!(!error.hues.contains(&"cyan"), "{error:?}");
}

#[test]
fn a_mark_that_is_picked_is_followed_from_there() {
    let scene = scene(discs());
    let background = scene.background();
    let frames: Vec<Vec<u8>> = (0..60)
        .map(|frame| scene.frame(&background, frame))
        .collect();
    let frame = |number: usize| Frame::new(scene.size, &frames[number]).expect("it has pixels");
    let at = scene.truth(0)[2].at + DVec2::new(2.0, -1.0);
    let mark = Mark::picked("hand", frame(0), at).expect("it is coloured");
    // A camera has no end: what the first frames show has to do.
    let mut learner = Learner::new(scene.size, vec![mark]);
    (0..20).for_each(|number| learner.push(frame(number)));
    let mut tracker = Tracker::new(learner.learned().expect("they are in the clip"));
    tracker.start(0, at);
    for number in 0..60 {
        let found = tracker.push(frame(number))[0].expect("it is seen");
        assert!(
            found.at.distance(scene.truth(number)[2].at) < 4.0,
            "{number}: {found:?}"
        );
    }
}

//! Laws of motions that play in turn, on random figures.

use glam::{DQuat, DVec3};
use proptest::prelude::*;
use proptest::test_runner::FileFailurePersistence;

use super::super::FigureClip;
use super::super::fixtures::{BIRD, CAR, DOG, FLOWER, PERSON, SLIME, drawing, playing};
use crate::compile::Compiled;
use crate::labels::FigurePartId;

/// Frames of a blend.
const BLEND: usize = 6;

fn only(compiled: &Compiled) -> &FigureClip {
    let [clip] = compiled.clips.as_slice() else {
        panic!("{} clips", compiled.clips.len());
    };
    clip
}

/// The first part that has a place of its own: the root, or one that moves with it.
fn root(clip: &FigureClip) -> FigurePartId {
    let is_root = |part: &(crate::bind::PartId, usize)| *part == (clip.root, 0);
    clip.order.position(is_root).expect("a root")
}

/// Where the root is, without height.
fn ground(clip: &FigureClip, frame: usize) -> DVec3 {
    let places = clip.retargeted.translations[root(clip)].as_ref();
    places.expect("a place")[frame].reject_from(DVec3::Y)
}

/// The largest step of the root over the ground.
fn largest_step(clip: &FigureClip) -> f64 {
    let steps = (1..clip.source_frames())
        .map(|frame| ground(clip, frame).distance(ground(clip, frame - 1)));
    steps.fold(0.0, f64::max)
}

/// The largest step of the middle of any part; no part of these figures has a parent, so each has a place of its own.
fn largest_step_of_parts(clip: &FigureClip) -> f64 {
    let paths = clip.retargeted.translations.iter().flatten();
    let steps = paths.flat_map(|path| path.windows(2).map(|pair| pair[0].distance(pair[1])));
    steps.fold(0.0, f64::max)
}

/// How far the middle of any part is from where it is in another pose, relative to the root.
fn places_apart(a: (&FigureClip, usize), b: (&FigureClip, usize)) -> f64 {
    let place = |(clip, frame): (&FigureClip, usize), part: FigurePartId| {
        let path = clip.retargeted.translations[part].as_ref();
        path.map(|path| path[frame] - ground(clip, frame))
    };
    let apart =
        a.0.order
            .keys()
            .filter_map(|part| Some(place(a, part)?.distance(place(b, part)?)));
    apart.fold(0.0, f64::max)
}

/// How different two poses are: the largest difference of a rotation, radians, or of a place relative to the root, drawing units.
fn apart(a: (&FigureClip, usize), b: (&FigureClip, usize)) -> f64 {
    let mut most = 0.0_f64;
    let still = DQuat::IDENTITY;
    for part in a.0.order.keys() {
        let turn = |(clip, frame): (&FigureClip, usize)| {
            let turns = clip.retargeted.rotations[part].as_ref();
            turns.map(|turns| turns[frame])
        };
        if let (Some(a), Some(b)) = (turn(a), turn(b)) {
            most = most.max((a.inverse() * b).angle_between(still));
        }
        let place = |(clip, frame): (&FigureClip, usize)| {
            let places = clip.retargeted.translations[part].as_ref();
            places.map(|places| places[frame] - ground(clip, frame))
        };
        if let (Some(a), Some(b)) = (place(a), place(b)) {
            most = most.max(a.distance(b));
        }
    }
    most
}

/// A list of clips, each with its seconds and its speed; each as it is written.
fn words() -> impl Strategy<Value = Vec<(&'static str, f64, f64)>> {
    let word = prop::sample::select(vec![
        "walk", "run", "sneak", "jump", "idle", "wave", "dance", "punch", "trot", "drive", "fly",
        "hop", "sway", "float", "swim",
    ]);
    let speed = prop::sample::select(vec![1.0, 1.0, 2.0, 0.5, 1.3]);
    prop::collection::vec((word, 0.2..4.0_f64, speed), 1..4)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 24,
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct("tests/regressions/turn.txt"))),
        ..ProptestConfig::default()
    })]

    #[test]
    fn motions_in_turn_are_those_of_single_clips(
        words in words(),
        figure in prop::sample::select(vec![PERSON, DOG, CAR, BIRD, FLOWER, SLIME]),
        is_loop: bool,
    ) {
        let written = words.iter().map(|(word, seconds, speed)| format!(" {word} {seconds:.3} speed {speed}"));
        let flag = if is_loop { " -l" } else { "" };
        let all = playing(figure, &format!("Motion{flag}{}", written.collect::<String>()));
        let all = only(&all);
        let singles: Vec<Compiled> = words
            .iter()
            .map(|(word, _, speed)| playing(figure, &format!("Motion {word} speed {speed}")))
            .collect();
        let normal: Vec<Compiled> = words
            .iter()
            .map(|(word, _, _)| playing(figure, &format!("Motion {word}")))
            .collect();
        let mut first = 0;
        let mut most = 0.0_f64;
        for (index, (word, seconds, speed)) in words.iter().enumerate() {
            let single = only(&singles[index]);
            let steps = single.source_frames() - 1;
            // It is as long as its speed says.
            let plain = (only(&normal[index]).source_frames() - 1) as f64;
            prop_assert_eq!(steps, (plain / speed).round() as usize);
            // It plays whole cycles, as many as come nearest to its seconds.
            let cycle = steps as f64 / 24.0;
            let cycles = ((format!("{seconds:.3}").parse::<f64>().unwrap() / cycle).round() as usize).max(1);
            let turn = &all.turns[index];
            prop_assert_eq!((turn.first, turn.steps, turn.cycles), (first, cycles * steps, cycles));
            // Behind the blend every frame is one of the clip.
            let blended = if index > 0 || is_loop && words.len() > 1 { BLEND } else { 0 };
            for step in blended..=cycles * steps {
                let own = if step == cycles * steps { steps } else { step % steps };
                let off = apart((all, first + step), (single, own));
                prop_assert!(off < 1e-6, "{word} {step}: {off}");
            }
            most = most.max(largest_step(single));
            first += cycles * steps;
        }
        prop_assert_eq!(all.source_frames(), first + 1);
        // The figure goes on from where it is.
        prop_assert!(largest_step(all) <= most + 1e-6, "{} > {most}", largest_step(all));
        if is_loop {
            let seam = apart((all, 0), (all, first));
            prop_assert!(seam < 1e-6, "{seam}");
        }
        // A step in a blend is at most that of one of its clips, and the fastest part of the way from one pose to the other, which may be
        // an arc of what moves on an arc itself: twice half a circle. Without a blend it would be the whole way.
        let fastest = singles.iter().map(|single| largest_step_of_parts(only(single)));
        let fastest = fastest.fold(0.0, f64::max);
        let differences = (1..words.len() + 1).flat_map(|next| {
            let [before, own] = [next - 1, next % words.len()].map(|index| only(&singles[index]));
            let frames = 0..=BLEND.min(own.source_frames() - 1);
            frames.map(move |frame| places_apart((before, before.source_frames() - 1), (own, frame)))
        });
        let difference = differences.fold(0.0, f64::max);
        let blended = 1.5 / BLEND as f64 * std::f64::consts::PI * difference;
        let seam = largest_step_of_parts(all);
        prop_assert!(seam <= 2.0 * fastest + blended, "{seam} > 2 × {fastest} + {blended}");
    }
}

#[test]
fn files_and_clips_that_come_along_mix() {
    let compiled = playing(
        PERSON,
        "Motion \"kick.bvh\" 1 walk 2 \"walk.bvh\" from .5 to 1 drive",
    );
    let clip = only(&compiled);
    assert_eq!(clip.name, "kick-walk-walk-drive");
    let lengths: Vec<usize> = clip.turns.iter().map(|turn| turn.steps).collect();
    assert_eq!(lengths[..3], [24, 48, 12]);
    // The file's poses are those of the file alone.
    let alone = playing(PERSON, "Motion \"kick.bvh\" to 1");
    for frame in 0..=24 {
        assert!(apart((clip, frame), (only(&alone), frame)) < 1e-6);
    }
    // It stays where it is when another motion begins: no step of any part is larger than those within the motions.
    let speeds = clip.speeds();
    let seams = [24, 72, 84].map(|frame| speeds[frame]);
    let most = speeds.iter().copied().fold(0.0, f64::max);
    assert!(seams.iter().all(|seam| *seam < most), "{seams:?} {most}");
}

#[test]
fn a_turned_figure_goes_on_where_it_is_heading() {
    // The kick ends with the body turned by some degrees.
    let compiled = playing(PERSON, "Motion \"kick.bvh\" walk 4");
    let clip = only(&compiled);
    let kick = clip.turns[0].steps;
    let way = ground(clip, kick + 48) - ground(clip, kick + 24);
    let body = clip.retargeted.rotations[root(clip)]
        .as_ref()
        .expect("turns");
    let front = |frame: usize| (body[frame] * body[0].inverse() * DVec3::Z).reject_from(DVec3::Y);
    let heading = front(kick + 24);
    let off = way.angle_between(heading).to_degrees();
    assert!(way.length() > 1.0 && off < 15.0, "{off} degrees");
    // A cycle of the walk changes nothing about that.
    let other = ground(clip, kick + 72) - ground(clip, kick + 48);
    assert!(way.angle_between(other).to_degrees() < 1.0);
}

#[test]
fn a_range_is_the_file_cut_there() {
    let slow = playing(PERSON, "Motion \"kick.bvh\" kick from 1.2 to 2.4 speed .5");
    let part = playing(PERSON, "Motion \"kick.bvh\" kick from 1.2 to 2.4");
    let (slow, part) = (only(&slow), only(&part));
    assert_eq!(part.source_frames(), 29);
    assert_eq!(slow.source_frames(), 57);
    for frame in 0..29 {
        let off = apart((slow, 2 * frame), (part, frame));
        assert!(off < 0.05, "frame {frame}: {off}");
    }
}

#[test]
fn performances_of_several_motions_are_reported() {
    let compiled = playing(PERSON, "Motion walk 2 wave 1 Perform \"kick.bvh\"");
    let found = compiled.diagnostics.iter().map(|one| one.code.id());
    let found: Vec<&str> = found.filter(|code| *code == "W328").collect();
    assert_eq!(found, ["W328"]);
}

#[test]
fn each_motion_that_does_not_fit_is_reported_at_its_word() {
    let text = drawing(CAR, "Motion drive 2 fly 1 walk 1");
    let compiled = playing(CAR, "Motion drive 2 fly 1 walk 1");
    let reported = compiled.diagnostics.iter().map(|one| {
        let written = &text[one.span.start..one.span.end];
        (one.code.id(), written.to_owned())
    });
    let reported = reported.filter(|(code, _)| *code == "W330");
    let reported: Vec<(&str, String)> = reported.collect();
    let expected = [("W330", "fly".to_owned()), ("W330", "walk".to_owned())];
    assert_eq!(reported, expected);
}

//! Laws of the clips that move the parts of a figure.

use glam::{DQuat, DVec3};

use super::super::FigureClip;
use super::super::fixtures::{ALL, BIRD, CAR, DOG, EEL, SLIME, SQUID, WEED, playing};
use crate::compile::Compiled;
use crate::labels::FigurePartId;

fn part(compiled: &Compiled, clip: &FigureClip, name: &str) -> FigurePartId {
    let is_called = |(part, bone): &(crate::bind::PartId, usize)| {
        *bone == 0 && compiled.bindings.parts[*part].name == name
    };
    clip.order.position(is_called).expect(name)
}

/// The angle of a rotation, radians, −π to π, about an axis.
fn angle(rotation: DQuat, axis: DVec3) -> f64 {
    let shorter = 1.0_f64.copysign(rotation.w);
    2.0 * f64::atan2(shorter * rotation.xyz().dot(axis), shorter * rotation.w)
}

#[test]
fn a_figure_plays_what_it_has() {
    for (figure, word) in ALL {
        let compiled = playing(figure, "Motion");
        let names: Vec<&str> = compiled.clips.iter().map(|clip| &*clip.name).collect();
        assert_eq!(names, [word], "{figure}");
    }
}

#[test]
fn every_clip_ends_as_it_begins() {
    for (figure, word) in ALL.into_iter().filter(|(_, word)| *word != "walk") {
        let compiled = playing(figure, "Motion");
        let clip = &compiled.clips[0].retargeted;
        let whole = clip.rotations.iter().flatten();
        for turns in whole {
            let seam = turns[0].angle_between(turns[turns.len() - 1]);
            // Of a wheel the whole turns are many.
            assert!(seam < 1e-6 || word == "drive", "{word}: {seam}");
        }
        let ways = clip.translations.iter().flatten();
        let ways: Vec<DVec3> = ways.map(|way| way[way.len() - 1] - way[0]).collect();
        for way in &ways {
            assert!(way.distance(ways[0]) < 1e-9 && way.y.abs() < 1e-9, "{word}");
        }
        let stays = playing(figure, "Motion -i");
        for way in stays.clips[0].retargeted.translations.iter().flatten() {
            assert!(
                way[way.len() - 1].distance(way[0]) < 1e-9,
                "{word} in place"
            );
        }
    }
}

#[test]
fn wheels_turn_by_distance_over_radius() {
    let compiled = playing(CAR, "Motion drive");
    let clip = &compiled.clips[0];
    let motion = &clip.retargeted;
    let body = part(&compiled, clip, "car body");
    let places = motion.translations[body].as_ref().expect("a root");
    for (name, radius) in [("rear wheel", 40.0), ("front wheel", 30.0)] {
        let wheel = part(&compiled, clip, name);
        let turns = motion.rotations[wheel].as_ref().expect(name);
        for frame in 1..places.len() {
            let step = places[frame] - places[frame - 1];
            let turn = turns[frame] * turns[frame - 1].inverse();
            // To the right a wheel turns clockwise; the body does not turn.
            let rolled = angle(turn, DVec3::NEG_Z) * radius;
            assert!(step.x > 1.0, "{name} {step}");
            assert!(
                (rolled - step.x).abs() < 0.01 * step.x,
                "{name} {rolled} {step}"
            );
        }
    }
    let heights = motion.translations[body].iter().flatten().map(|at| at.y);
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| {
        (low.min(y), high.max(y))
    });
    assert!(high > low && high - low < 2.0, "sprung by {}", high - low);
}

#[test]
fn wings_beat_together() {
    let compiled = playing(BIRD, "Motion fly");
    let clip = &compiled.clips[0];
    let motion = &clip.retargeted;
    let turns = |name: &str| {
        let wing = part(&compiled, clip, name);
        let turns = motion.rotations[wing].as_ref().expect(name);
        let turns = turns.iter().map(|turn| *turn * turns[0].inverse());
        turns
            .map(|turn| angle(turn, DVec3::Z))
            .collect::<Vec<f64>>()
    };
    // From where both are highest, the one on the drawing's right goes down clockwise, the other one its mirror image.
    let (left, right) = (turns("wing 2"), turns("wing 1"));
    for (left, right) in left.iter().zip(&right) {
        assert!(
            (left + right).abs() < 1e-6 && *left < 1e-9,
            "{left} {right}"
        );
    }
    let lowest = left.iter().copied().fold(0.0, f64::min);
    assert!((-1.4..-1.0).contains(&lowest), "{lowest}");
}

/// A part that bends moves as a wave: each bone later than the one before.
#[test]
fn waves_run_along_what_bends() {
    for (figure, motion, name) in [
        (EEL, "Motion swim", "tail"),
        (SQUID, "Motion float", "tentacle 1"),
        (WEED, "Motion sway Bend 4", "stem"),
    ] {
        let compiled = playing(figure, motion);
        let clip = &compiled.clips[0];
        let whole = clip.order[part(&compiled, clip, name)].0;
        let bones = clip.order.iter_enumerated();
        let bones = bones.filter(|(_, (part, bone))| *part == whole && *bone > 0);
        let turns = bones.map(|(bone, _)| {
            let turns = clip.retargeted.rotations[bone].as_ref();
            let turns = turns.unwrap_or_else(|| panic!("{motion}: a bone of {name} stays"));
            turns.as_slice()
        });
        let turns: Vec<&[DQuat]> = turns.collect();
        assert!(turns.len() >= 3, "{name} has {} bones", turns.len());
        let off = |turns: &[DQuat], frame: usize| turns[frame] * turns[0].inverse();
        let widest = (0..turns[0].len()).max_by(|a, b| {
            let [a, b] = [*a, *b].map(|frame| off(turns[0], frame).w.abs());
            b.total_cmp(&a)
        });
        let axis = off(turns[0], widest.expect("frames")).xyz().normalize();
        let phase = |turns: &[DQuat]| {
            let frames = turns.len() - 1;
            let angles = (0..frames).map(|frame| angle(off(turns, frame), axis));
            let angles: Vec<f64> = angles.collect();
            let [low, high] = angles.iter().fold([0.0_f64; 2], |[low, high], angle| {
                [low.min(*angle), high.max(*angle)]
            });
            assert!(
                high - low > 0.03,
                "{motion}: {name} turns by {}",
                high - low
            );
            let waves = angles.iter().enumerate().map(|(frame, angle)| {
                let time = std::f64::consts::TAU * frame as f64 / frames as f64;
                [angle * time.cos(), angle * time.sin()]
            });
            let [x, y] = waves.fold([0.0; 2], |[x, y], [a, b]| [x + a, y + b]);
            y.atan2(x) / std::f64::consts::TAU
        };
        let phases: Vec<f64> = turns.iter().map(|turns| phase(turns)).collect();
        for pair in phases.windows(2) {
            let late = (pair[1] - pair[0]).rem_euclid(1.0);
            assert!((0.02..0.25).contains(&late), "{motion}: {phases:?}");
        }
    }
}

#[test]
fn a_hop_stays_where_it_lands() {
    let compiled = playing(SLIME, "Motion hop");
    let clip = &compiled.clips[0];
    let root = clip
        .retargeted
        .translations
        .iter()
        .flatten()
        .next()
        .expect("a root");
    let grounded = clip.grounded();
    assert!(grounded[..6].iter().all(|grounded| *grounded) && !grounded[12]);
    let highest = root.iter().map(|at| at.y).fold(0.0_f64, f64::max);
    assert!(highest - root[0].y > 20.0);
}

#[test]
fn what_does_not_fit_names_what_does() {
    for (figure, motion, lacks, fits) in [
        (CAR, "Motion walk", "no legs", "`Motion drive`"),
        (SLIME, "Motion drive", "no wheels", "`Motion hop`"),
        (CAR, "Motion fly", "no wings", "`Motion drive`"),
        (BIRD, "Motion swim", "no fins", "`Motion fly`"),
        (DOG, "Motion float", "no tentacles", "`Motion walk`"),
    ] {
        let compiled = playing(figure, motion);
        let found = compiled
            .diagnostics
            .iter()
            .find(|found| found.message.contains(lacks));
        let found = found.unwrap_or_else(|| panic!("{motion}: {:?}", compiled.diagnostics));
        let help = found.help.as_deref().unwrap_or_default();
        assert!(help.contains(fits), "{motion}: {help}");
    }
}

#[test]
fn own_clips_take_a_name() {
    let compiled = playing(CAR, "Motion drive cruise Motion Limited 0 4");
    let names: Vec<&str> = compiled.clips.iter().map(|clip| &*clip.name).collect();
    assert_eq!(names, ["cruise", "drive"]);
    assert!(compiled.clips[1].drawings() < compiled.clips[1].frames());
}

//! `okoshi motion`, from the command line to what it writes.

use std::path::Path;

use gltf::animation::Interpolation;
use gltf::animation::util::ReadOutputs;
use okoshi::internals::limited::Measured;
use okoshi::internals::limited::{Cut, Options, limit};
use okoshi::internals::mocap::Clip;
use okoshi::internals::mocap::bvh::read_bytes;
use okoshi::internals::motion::PointChoice;

use crate::common::program::{Room, Run};
use crate::retarget::clips::clip;

/// A room with the kick in it: 169 frames at 60 a second, 68 at 24.
fn room() -> Room {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/motion/kick.bvh");
    Room::with("kick.bvh", std::fs::read(path).expect("the example"))
}

const FRAMES: usize = 68;

fn written(room: &Room, name: &str) -> Clip {
    let reading = read_bytes(&room.read(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert!(reading.notes.is_empty(), "{name}: {:?}", reading.notes);
    reading.clip
}

/// The number of rows of a clip that differ from the row before, including the first.
fn drawings(clip: &Clip) -> usize {
    1 + (1..clip.frames)
        .filter(|frame| clip.row(*frame) != clip.row(frame - 1))
        .count()
}

/// How the library limits the kick by default.
fn usual() -> (Clip, Cut) {
    let prepared = clip("examples/motion/kick.bvh");
    let measured = Measured::of_clip(
        &prepared.clip,
        &prepared.positions,
        &prepared.anatomy,
        PointChoice::Seen,
    );
    let usual = Options::recommended(prepared.clip.frames);
    let cut = limit(measured.poses(), &usual);
    (prepared.clip, cut)
}

#[test]
fn joints_are_listed() {
    let room = room();
    let run = room.run(&["motion", "kick.bvh"]);
    for line in [
        "Hips                    hips",
        "      LeftShoulder      left arm, collar",
        "            LeftHand    left arm, end",
    ] {
        assert!(run.out.contains(line), "{}", run.out);
    }
    assert_eq!(run.out.lines().count(), 21);
    run.ends(0, "Hips", "kick.bvh: 21 joints, 169 frames at 60 a second");
    room.run(&["motion", "-q", "kick.bvh"]).ends(0, "Hips", "");
    assert_eq!(room.files(), ["kick.bvh"]);
}

#[test]
fn a_limited_motion_is_what_the_library_makes() {
    let room = room();
    room.run(&["motion", "kick.bvh", "-o", "out.bvh"])
        .ends(0, "", "wrote out.bvh");
    let (full, cut) = usual();
    let out = written(&room, "out.bvh");
    assert_eq!(out.frames, FRAMES);
    assert!(
        (out.frame_time * 24.0 - 1.0).abs() < 1e-4,
        "{}",
        out.frame_time
    );
    assert_eq!(drawings(&out), cut.exposure.drawings().count());
    for (frame, source) in cut.exposure.sources.iter().enumerate() {
        for (is, due) in out.row(frame).iter().zip(full.row(*source as usize)) {
            assert!(
                (is - due).abs() <= 0.5e-6 + 1e-12,
                "frame {frame}: {is} {due}"
            );
        }
    }
}

#[test]
fn how_many_frames_and_drawings() {
    let room = room();
    for (arguments, frames, shown) in [
        (&["--full"] as &[&str], FRAMES, FRAMES),
        (&["--omit", "2", "--hold", "5"], FRAMES, FRAMES - 7),
        (
            &["--omit", "2", "--hold", "0", "--shorten"],
            FRAMES - 2,
            FRAMES - 2,
        ),
        (&["--every", "2"], FRAMES, 34),
        (&["--every", "3"], FRAMES, 23),
        (&["--drawings", "20"], FRAMES, 20),
        // Ranges count the frames of the file.
        (&["--range", "10:19", "--full", "--fps", "60"], 10, 10),
        (&["--range", "73:145", "--full"], 29, 29),
        (&["--from", "1.2", "--to", "2.4", "--full"], 29, 29),
        (&["--to", "1", "--full", "--speed", "2"], 13, 13),
        (&["--speed", ".5", "--full"], 135, 135),
        (&["--fps", "60", "--full"], 169, 169),
        (&["--fps", "12", "--full"], 34, 34),
        (&["--keep-rest", "--full"], FRAMES, FRAMES),
    ] {
        let all = [&["motion", "kick.bvh", "-q", "-o", "out.bvh"], arguments].concat();
        room.run(&all).ends(0, "", "");
        let out = written(&room, "out.bvh");
        assert_eq!(
            (out.frames, drawings(&out)),
            (frames, shown),
            "{arguments:?}"
        );
    }
}

#[test]
fn lead_ins_are_removed_by_default() {
    let room = room();
    let text = String::from_utf8(room.read("kick.bvh")).expect("text");
    let (head, rows) = text.split_once("Frame Time: 0.0166667").expect("frames");
    let width = written(&room, "kick.bvh").row(0).len();
    // A pose far away from all others.
    let rest = format!("0 300 900{}", " 0".repeat(width - 3));
    let head = head.replace("Frames: 169", "Frames: 170");
    room.write(
        "lead.bvh",
        format!("{head}Frame Time: 0.0166667\n{rest}{rows}"),
    );
    let run = room.run(&["motion", "lead.bvh", "--full", "-o", "out.bvh"]);
    run.ends(0, "", "frame 1 is a pose that the motion jumps out of");
    let without = written(&room, "out.bvh");
    room.run(&["motion", "kick.bvh", "-q", "--full", "-o", "plain.bvh"])
        .ends(0, "", "");
    assert_eq!(without, written(&room, "plain.bvh"));
    room.run(&[
        "motion",
        "lead.bvh",
        "-q",
        "--keep-rest",
        "--full",
        "-o",
        "kept.bvh",
    ])
    .ends(0, "", "");
    let kept = written(&room, "kept.bvh");
    assert_eq!(kept.row(0)[2], 900.0);
}

#[test]
fn a_model_has_a_key_for_each_drawing() {
    let room = room();
    room.run(&["motion", "kick.bvh", "-o", "out.glb"])
        .ends(0, "", "wrote out.glb");
    let (full, cut) = usual();
    let model = gltf::Gltf::from_slice(&room.read("out.glb")).expect("a model");
    let blob = model.blob.as_deref().expect("data");
    assert_eq!(
        model
            .nodes()
            .filter(|node| node.name() == Some("LeftHand"))
            .count(),
        1
    );
    let clips: Vec<_> = model.animations().collect();
    assert_eq!(clips.len(), 1);
    assert_eq!(clips[0].name(), Some("kick"));
    let starts = cut
        .exposure
        .drawings()
        .map(|drawing| (drawing.start as f64 * full.frame_time) as f32);
    let mut starts: Vec<f32> = starts.collect();
    assert!(starts.len() < FRAMES);
    // The closing key repeats the last drawing.
    starts.push((cut.exposure.len() as f64 * full.frame_time) as f32);
    let mut turning = 0;
    for channel in clips[0].channels() {
        assert_eq!(channel.sampler().interpolation(), Interpolation::Step);
        let reader = channel.reader(|_| Some(blob));
        let times: Vec<f32> = reader.read_inputs().expect("times").collect();
        assert_eq!(times, starts, "one key a drawing, none where it is held");
        let values = match reader.read_outputs().expect("values") {
            ReadOutputs::Rotations(turns) => {
                turning += 1;
                turns.into_f32().count()
            }
            ReadOutputs::Translations(places) => places.count(),
            _ => panic!("a channel of another kind"),
        };
        assert_eq!(values, starts.len());
    }
    assert_eq!(turning, full.skeleton.joints.len());

    room.run(&["motion", "kick.bvh", "-q", "--full", "-o", "full.glb"])
        .ends(0, "", "");
    let model = gltf::Gltf::from_slice(&room.read("full.glb")).expect("a model");
    let blob = model.blob.as_deref().expect("data");
    for channel in model.animations().next().expect("a clip").channels() {
        assert_eq!(channel.sampler().interpolation(), Interpolation::Linear);
        let times = channel.reader(|_| Some(blob)).read_inputs().expect("times");
        assert_eq!(times.count(), FRAMES);
    }
    room.run(&["motion", "kick.bvh", "-q", "-o", "out.gltf"])
        .ends(0, "", "");
    gltf::Gltf::from_slice(&room.read("out.gltf")).expect("a model in text");
}

#[test]
fn charts_are_drawn() {
    let room = room();
    room.run(&["motion", "kick.bvh", "-o", "chart.svg"])
        .ends(0, "", "wrote chart.svg");
    room.run(&[
        "motion", "kick.bvh", "-q", "--plot", "plot.svg", "-o", "out.bvh",
    ])
    .ends(0, "", "");
    room.run(&["motion", "kick.bvh", "--plot", "alone.svg"])
        .ends(0, "", "wrote alone.svg");
    let chart = String::from_utf8(room.read("chart.svg")).expect("text");
    for name in ["plot.svg", "alone.svg"] {
        assert_eq!(chart.as_bytes(), room.read(name), "{name}");
    }
    let tree = usvg::Tree::from_str(&chart, &usvg::Options::default()).expect("an SVG");
    assert!(tree.size().width() > 100.0);
    let document = roxmltree::Document::parse(&chart).expect("XML");
    let paths = document
        .descendants()
        .filter_map(|node| node.attribute("d").or(node.attribute("points")));
    let numbers = |path: &str| {
        path.split(|c: char| !(c.is_ascii_digit() || c == '.'))
            .filter(|n| !n.is_empty())
            .count()
    };
    let most = paths.map(numbers).max().expect("lines");
    assert!(most >= 2 * (FRAMES - 1), "a point for each step: {most}");
    assert!(chart.contains("kick"), "its title");
    assert_eq!(
        room.files(),
        ["alone.svg", "chart.svg", "kick.bvh", "out.bvh", "plot.svg"]
    );
}

#[test]
fn ways_to_cut_are_compared() {
    let room = room();
    let run = room.run(&["motion", "kick.bvh", "--compare", "-o", "out.bvh"]);
    for line in [
        "as asked:",
        "on twos:    34 drawings",
        "on threes:    23 drawings",
        "best drawings:",
    ] {
        assert!(run.err.contains(line), "{line}: {}", run.err);
    }
    run.ends(0, "", "% of the height (RMS)");
}

#[test]
fn a_camera_sees_another_motion() {
    let room = room();
    let shot = |name: &str, camera: &[&str]| {
        let arguments = [
            &["motion", "kick.bvh", "-q", "--omit", "4", "-o", name],
            camera,
        ]
        .concat();
        room.run(&arguments).ends(0, "", "");
        written(&room, name)
    };
    let [plain, front, side, near] = [
        shot("plain.bvh", &[]),
        shot("front.bvh", &["--camera", "0,0"]),
        shot("side.bvh", &["--camera", "-90,0"]),
        shot("near.bvh", &["--camera", "0,0,250"]),
    ];
    assert_ne!(front, side);
    assert_ne!(plain, front);
    assert_ne!(front, near);
}

#[test]
fn through_pipes() {
    let room = room();
    let kick = room.read("kick.bvh");
    let run = Run::of(room.pipe(&["motion", "-", "-o", "-", "--full"], &kick));
    assert_eq!(
        read_bytes(run.out.as_bytes()).expect("BVH").clip.frames,
        FRAMES
    );
    assert!(!run.err.contains("wrote"), "{}", run.err);
    run.ends(0, "HIERARCHY", "-: 21 joints");
    Run::of(room.pipe(&["motion", "-q", "-", "-o", "out.glb"], &kick)).ends(0, "", "");
    assert_eq!(room.files(), ["kick.bvh", "out.glb"]);
}

#[test]
fn wrong_usage_is_rejected() {
    let room = room();
    for (arguments, message) in [
        (&["-o", "out.png"] as &[&str], "must end in .bvh"),
        (&["-o", "out"], "must end in .bvh"),
        (&["-o", "kick.bvh"], "is the file that is read"),
        (&["-o", "./kick.bvh"], "is the file that is read"),
        (
            &["--range", "60:190"],
            "there is no frame 190: the clip has 169",
        ),
        (&["--range", "9:3"], "ends before it begins"),
        (&["--range", "0:3"], "frame 0"),
        (&["--range", "all"], "--range"),
        (&["--range", "1:9", "--to", "1"], "cannot be used with"),
        (&["--from", "3"], "the motion is 2.80 seconds long"),
        (&["--from", "2", "--to", "1"], "nothing is left"),
        (&["--from=-1"], "a number of seconds"),
        (&["--speed", "0"], "a number from 0.01 to 100"),
        (&["walk", "2"], "`walk` cannot follow a file"),
        (&["--fps", "0"], "0 is not a possible frame rate"),
        (&["--fps=-24"], "-24 is not a possible frame rate"),
        (&["--fps", "NaN"], "NaN is not a possible frame rate"),
        (&["--every", "0"], "0 is not in 1..=24"),
        (&["--every", "2", "--omit", "3"], "cannot be used with"),
        (&["--drawings", "9", "--every", "3"], "cannot be used with"),
        (&["--full", "--hold", "3"], "cannot be used with"),
        (&["--camera", "left"], "expected two numbers"),
        (&["--plot", "chart.png"], "must end in .svg"),
    ] {
        let run = room.run(&[&["motion", "kick.bvh"], arguments].concat());
        assert_eq!(run.status, 2, "{arguments:?}: {}", run.err);
        run.ends(2, "", message);
    }
    room.run(&["motion", "none.bvh"])
        .ends(2, "", "`none.bvh` is not there");
    assert_eq!(room.files(), ["kick.bvh"], "nothing is written");
}

#[test]
fn impossible_requests_are_reported() {
    let room = room();
    let run = room.run(&["motion", "kick.bvh", "--hold", "500", "-o", "out.bvh"]);
    run.ends(
        0,
        "",
        "warning: 500 holds were asked for: no pose may be held for more than 3 frames",
    );
    let run = room.run(&["motion", "kick.bvh", "--drawings", "2", "-o", "out.bvh"]);
    run.ends(
        0,
        "",
        "warning: 2 drawings were asked for: 9 to 68 are possible",
    );
}

#[test]
fn a_damaged_file() {
    let room = room();
    let text = String::from_utf8(room.read("kick.bvh")).expect("text");
    let mut lines: Vec<&str> = text.lines().collect();
    let first = lines
        .iter()
        .position(|line| line.starts_with("Frame Time"))
        .expect("frames")
        + 1;
    lines[first + 100] = "1 2 three";
    room.write("bad.bvh", lines.join("\n"));
    let place = format!(
        "bad.bvh: line {}, column 5: `three` is not a number",
        first + 101
    );
    let run = room.run(&[
        "motion", "bad.bvh", "--full", "--fps", "60", "-o", "out.bvh",
    ]);
    assert!(run.err.contains(&place), "{}", run.err);
    run.ends(
        2,
        "",
        "--keep-going continues with the 100 frames before it",
    );
    assert_eq!(room.files(), ["bad.bvh", "kick.bvh"]);

    let run = room.run(&[
        "motion",
        "bad.bvh",
        "--keep-going",
        "--full",
        "--fps",
        "60",
        "-o",
        "out.bvh",
    ]);
    assert!(run.err.contains(&place), "{}", run.err);
    run.ends(0, "", "continuing with the 100 frames before it");
    assert_eq!(written(&room, "out.bvh").frames, 100);

    room.write("empty.bvh", "");
    room.run(&["motion", "empty.bvh", "--keep-going"])
        .ends(2, "", "empty.bvh: line 1, column 1");
}

#[test]
fn clips_that_come_along_are_written() {
    for (legs, joints, frames) in [("2", 21, 25), ("4", 19, 25), ("6", 24, 17)] {
        let room = room();
        room.run(&["motion", "walk", "-o", "walk.bvh", "--legs", legs])
            .ends(0, "", "wrote walk.bvh");
        let clip = written(&room, "walk.bvh");
        assert_eq!((clip.skeleton.joints.len(), clip.frames), (joints, frames));
    }
    let room = room();
    room.run(&["motion", "walk", "--legs", "3"])
        .ends(2, "", "expected 2, 4 or 6");
    room.run(&["motion", "kick.bvh", "--up", "w"])
        .ends(2, "", "expected one of +x");
    room.run(&["motion", "wlak"]).ends(2, "", "wlak");
}

#[test]
fn a_loop_in_place_ends_where_it_begins() {
    let room = room();
    room.run(&["motion", "kick.bvh", "-o", "loop.bvh", "--full", "-il"])
        .ends(0, "", "a loop of the frames");
    let clip = written(&room, "loop.bvh");
    let (first, last) = (clip.pose(0), clip.pose(clip.frames - 1));
    for (first, last) in first.iter().zip(&last) {
        assert!(first.position.distance(last.position) < 0.01);
    }
}

#[test]
fn clips_that_come_along_play_in_turn() {
    let room = room();
    // Two walks of a second, a wave of two and a half, an idle of three.
    let words = [
        "motion", "-q", "walk", "2", "wave", "1", "idle", "1", "-o", "out.bvh",
    ];
    room.run(&words).ends(0, "", "");
    assert_eq!(written(&room, "out.bvh").frames, 24 * 2 + 60 + 72 + 1);
    let words = [
        "motion", "-q", "run", "wave", "-l", "--speed", "2", "-o", "out.bvh",
    ];
    room.run(&words).ends(0, "", "");
    let looped = written(&room, "out.bvh");
    let (start, end) = (looped.row(0), looped.row(looped.frames - 1));
    for channel in 3..start.len() {
        let turn = (start[channel] - end[channel]) / 360.0;
        assert!((turn - turn.round()).abs() < 1e-4, "{channel}");
    }
    for (words, message) in [
        (["walk", "2", "3"], "`3` is a second number of seconds"),
        (["walk", "0", "wave"], "`0` seconds are not possible"),
        (["walk", "2", "wav"], "did you mean `wave`?"),
        (["walk", "2", "drive"], "has no skeleton"),
        (["walk", "--to", "1"], "cut a file"),
    ] {
        let all = [&["motion"], &words[..], &["-o", "no.bvh"]].concat();
        room.run(&all).ends(2, "", message);
    }
}

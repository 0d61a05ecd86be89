//! `okoshi track`, from the command line to what it writes.

use std::fs::File;
use std::io::BufReader;
use std::process::Command;

use glam::DVec2;
use image::codecs::gif::{GifDecoder, GifEncoder};
use image::{AnimationDecoder as _, Delay, Frame, RgbImage};
use okoshi::internals::mark_tracks::MarkTracks;

use crate::common::program::{Room, Run};
use crate::synthetic::{Disc, FITTED, Scene, ellipse};

/// Frames of the clip.
const FRAMES: usize = 12;

/// A red disc that goes around a green one.
fn scene() -> Scene {
    Scene {
        seeds: FITTED,
        size: [121, 90],
        discs: vec![
            Disc::new(("green", [40, 150, 60]), 7.0, |time| {
                DVec2::new(60.0 + 0.5 * time, 45.0)
            }),
            Disc::new(("red", [205, 40, 45]), 7.0, |time| {
                ellipse(time, [60.0, 45.0], [40.0, 30.0], 8.0, 0.1)
            }),
        ],
        colorful: 0,
        patches: Vec::new(),
        noise: 2.0,
        shutter: 0.0,
        light: |_| 1.0,
    }
}

fn frames() -> Vec<RgbImage> {
    let scene = scene();
    let background = scene.background();
    let frame = |frame: usize| scene.frame(&background, frame);
    let image =
        |pixels| RgbImage::from_raw(scene.size[0], scene.size[1], pixels).expect("enough bytes");
    (0..FRAMES).map(|number| image(frame(number))).collect()
}

/// A room with the clip as `a.gif`, 10 frames a second.
fn room() -> Room {
    let mut gif = Vec::new();
    let mut encoder = GifEncoder::new(&mut gif);
    for frame in frames() {
        let delay = Delay::from_numer_denom_ms(100, 1);
        let frame = image::DynamicImage::from(frame).into_rgba8();
        encoder
            .encode_frame(Frame::from_parts(frame, 0, 0, delay))
            .expect("a GIF");
    }
    drop(encoder);
    Room::with("a.gif", gif)
}

fn track(room: &Room, arguments: &str) -> Run {
    let words: Vec<&str> = ["track"].into_iter().chain(arguments.split(' ')).collect();
    room.run(&words)
}

/// The track in a file, whose marks must be where they are.
fn checked(room: &Room, name: &str) -> MarkTracks {
    let tracks =
        MarkTracks::from_bytes(&room.read(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let scene = scene();
    assert_eq!(
        (tracks.size, tracks.times.len()),
        (scene.size, FRAMES),
        "{name}"
    );
    for mark in &tracks.marks {
        let disc = scene
            .discs
            .iter()
            .find(|disc| disc.mark.0 == mark.name)
            .expect("a disc");
        for (frame, point) in mark
            .points
            .iter()
            .enumerate()
            .filter(|(frame, _)| !mark.is_lost[*frame])
        {
            let apart = point.distance((disc.path)(frame as f64));
            assert!(
                apart < 1.5,
                "{name}: {} in frame {frame}: {apart}",
                mark.name
            );
        }
    }
    tracks
}

#[test]
fn tracks_of_an_animation_are_written_as_json_and_csv() {
    let room = room();
    let run = track(&room, "a.gif --mark red --mark green");
    assert_eq!((run.status, run.out.as_str()), (0, ""), "{}", run.err);
    for line in [
        "a.gif: 12 frames, 121 × 90 pixels, 1.1 s",
        "  red: seen in all frames",
        "wrote a.json",
    ] {
        assert!(run.err.contains(line), "{}", run.err);
    }
    let tracks = checked(&room, "a.json");
    assert_eq!(tracks.times[..3], [0.0, 0.1, 0.2]);
    assert!(
        tracks
            .marks
            .iter()
            .all(|mark| !mark.is_lost.contains(&true))
    );
    // Its own file may be replaced unasked.
    assert_eq!(track(&room, "a.gif --mark red --mark green").status, 0);
    assert_eq!(
        track(&room, "a.gif --mark red --mark green -o b.csv").status,
        0
    );
    assert_eq!(checked(&room, "b.csv"), tracks);
    let run = track(&room, "a.gif --mark red --mark green -q -o -");
    assert_eq!(run.err, "");
    assert_eq!(run.out.as_bytes(), room.read("a.json"));
}

#[test]
fn pictures_are_a_clip_in_the_order_of_their_numbers() {
    let room = Room::new();
    for (number, frame) in frames().into_iter().enumerate() {
        room.write(&format!("frames/f{}.png", number + 1), []);
        frame
            .save(room.path(&format!("frames/f{}.png", number + 1)))
            .expect("it is saved");
    }
    room.write("frames/notes.txt", "no picture");
    let run = track(&room, "frames --fps 12.5 --mark red -o a.json");
    assert_eq!(run.status, 0, "{}", run.err);
    assert_eq!(checked(&room, "a.json").times[1], 0.08);
    let files: Vec<String> = (1..=FRAMES)
        .rev()
        .map(|number| format!("frames/f{number}.png"))
        .collect();
    let run = track(&room, &format!("{} --mark red -o b.json", files.join(" ")));
    assert_eq!(run.status, 0, "{}", run.err);
    checked(&room, "b.json");
}

#[test]
fn the_annotated_clip_shows_where_marks_are() {
    let room = room();
    let run = track(&room, "a.gif --mark red -o a.json --annotated b.gif");
    assert_eq!(run.status, 0, "{}", run.err);
    assert!(run.err.contains("wrote b.gif"), "{}", run.err);
    let file = BufReader::new(File::open(room.path("b.gif")).expect("a file"));
    let frames = GifDecoder::new(file)
        .expect("a GIF")
        .into_frames()
        .collect_frames()
        .expect("frames");
    assert_eq!(frames.len(), FRAMES);
    let run = track(&room, "a.gif --mark red -o a.json --annotated c.png");
    assert!(
        run.err.contains("wrote c-01.png to c-12.png"),
        "{}",
        run.err
    );
    let [mark] = &checked(&room, "a.json").marks.raw[..] else {
        panic!("one mark")
    };
    for (frame, at) in mark.points.iter().enumerate() {
        let picture = image::open(room.path(&format!("c-{:02}.png", frame + 1)));
        let picture = picture.expect("a picture").into_rgb8();
        // The circle is brighter than anything in the clip.
        let top = DVec2::new(at.x, at.y - 4.0);
        let circle = picture
            .enumerate_pixels()
            .filter(|(_, _, pixel)| pixel.0[0] > 228);
        let nearest = circle.map(|(x, y, _)| DVec2::new(x.into(), y.into()).distance(top));
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        assert!(nearest < 2.0, "{nearest}");
    }
}

#[test]
fn videos_are_read_through_ffmpeg() {
    let room = room();
    let made = Command::new("ffmpeg")
        .args(["-loglevel", "error", "-i"])
        .arg(room.path("a.gif"))
        .args(["-vf", "scale=120:90", "-crf", "10", "-pix_fmt", "yuv420p"])
        .arg(room.path("a.mp4"))
        .status();
    if made.is_err() {
        eprintln!("skipped: ffmpeg is not installed");
    } else {
        let run = track(&room, "a.mp4 --mark red -o a.json --annotated b.mp4");
        assert_eq!(run.status, 0, "{}", run.err);
        let tracks = MarkTracks::from_bytes(&room.read("a.json")).expect("a track");
        assert_eq!((tracks.size, tracks.times.len()), ([120, 90], FRAMES));
        assert!((tracks.times[1] - 0.1).abs() < 1e-4, "{:?}", tracks.times);
        for (frame, point) in tracks.marks.raw[0].points.iter().enumerate() {
            let apart = point.distance((scene().discs[1].path)(frame as f64));
            assert!(apart < 3.0, "frame {frame}: {apart}");
        }
        assert!(room.files().contains(&"b.mp4".to_owned()));
        room.write("e.mp4", "no video");
        let run = track(&room, "e.mp4 --mark red");
        assert_eq!(run.status, 2);
        assert!(
            run.err.contains("`e.mp4` is no clip that ffmpeg can read"),
            "{}",
            run.err
        );
    }
    room.write("f.mp4", "a video");
    let mut command = room.command(&["track", "f.mp4", "--mark", "red"]);
    command.env("PATH", room.path(""));
    Run::of(command.output().expect("it starts")).ends(
        2,
        "",
        "need the program ffmpeg, which is not installed",
    );
}

#[test]
fn wrong_uses_are_refused_with_a_way_out() {
    let room = room();
    room.write("empty/a.txt", "no picture");
    room.write("b.gif", &room.read("a.gif")[..3000]);
    room.write("other/a.json", "{}");
    room.write("other/a.gif", room.read("a.gif"));
    for (arguments, message) in [
        ("a.gif", "--mark <[NAME=]COLOUR>"),
        ("a.gif --mark blu", "`blu` is no colour"),
        ("a.gif --mark grey", "has no hue"),
        ("a.gif --mark a,b=red", "the name of a mark has letters"),
        ("a.gif --mark red --mark red", "there are two marks `red`"),
        ("a.gif --mark blue", "what is coloured in it is red, green"),
        (
            "a.gif --mark red --fps 0",
            "expected a number from 0.1 to 1000",
        ),
        ("a.gif --mark red -o a.txt", "must end in .json or .csv"),
        (
            "a.gif --mark red --annotated a.avi",
            "must end in .gif, .apng, .mp4, .webm or .png",
        ),
        (
            "a.gif --mark red --annotated a.gif",
            "is the file that is read",
        ),
        (
            "a.gif --mark red -o a.json --annotated no/b.gif",
            "the folder `no` is not there",
        ),
        ("other/a.gif --mark red", "was not written by okoshi"),
        ("b.gif --mark red", "of `b.gif` cannot be read"),
        ("c.gif --mark red", "`c.gif` is not there"),
        ("empty --mark red", "has no pictures"),
    ] {
        track(&room, arguments).ends(2, "", message);
    }
    let before = room.read("a.gif");
    assert_eq!(before, room.read("other/a.gif"));
}

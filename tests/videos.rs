//! Videos of `okoshi render`: what ffmpeg encodes, and what happens without it.
#![cfg(feature = "cli")]
#![allow(
    clippy::print_stderr,
    reason = "what is skipped is said in the test's output"
)]
#![cfg(unix)]

mod common;

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::process::{Command, Stdio};

use common::patience::wait_until;
use common::program::{Room, Run};

const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">
  <rect x="10" y="10" width="80" height="80" fill="#cc2010" id="body"/>
</svg>
"##;

/// Whether ffmpeg is installed; says so if it is not.
fn has_ffmpeg() -> bool {
    let found = Command::new("ffmpeg").arg("-version").output().is_ok();
    if !found {
        eprintln!("skipped: ffmpeg is not installed");
    }
    found
}

/// The frames of a video, each with three bytes for a pixel.
fn frames(room: &Room, name: &str, [width, height]: [usize; 2]) -> Vec<Vec<u8>> {
    let output = Command::new("ffmpeg")
        .args(["-loglevel", "error", "-i"])
        .arg(room.path(name))
        .args(["-f", "rawvideo", "-pix_fmt", "rgb24", "-"])
        .stdin(Stdio::null())
        .output()
        .expect("ffmpeg");
    assert!(output.status.success(), "{output:?}");
    let frames = output.stdout.chunks(width * height * 3);
    frames.map(<[u8]>::to_vec).collect()
}

/// A room with a program in the place of ffmpeg.
fn room_with_ffmpeg(script: &str) -> Room {
    let room = Room::with("a.svg", DRAWING);
    room.write("bin/ffmpeg", format!("#!/bin/sh\n{script}\n"));
    let executable = fs::Permissions::from_mode(0o755);
    fs::set_permissions(room.path("bin/ffmpeg"), executable).expect("a script");
    room
}

/// Runs `render a.svg` with the program's own ffmpeg, if the room has one.
fn command(room: &Room, more: &str) -> Command {
    let arguments: Vec<&str> = ["render", "a.svg", "--size", "40x30"]
        .into_iter()
        .chain(more.split_whitespace())
        .collect();
    let mut command = room.command(&arguments);
    command.env("PATH", room.path("bin"));
    command
}

fn run(room: &Room, more: &str) -> Run {
    Run::of(command(room, more).output().expect("it starts"))
}

#[test]
fn videos_show_what_is_rendered() {
    if !has_ffmpeg() {
        return;
    }
    let room = Room::with("a.svg", DRAWING);
    let told = room.run(
        &"render a.svg -o t.png --size 64x48 --turntable 8 --background #ffffff"
            .split(' ')
            .collect::<Vec<_>>(),
    );
    assert_eq!(told.status, 0, "{}", told.err);
    for name in ["t.mp4", "t.webm"] {
        let arguments = format!("render a.svg -o {name} --size 63x47 --turntable 8");
        let run = room.run(&arguments.split(' ').collect::<Vec<_>>());
        assert_eq!(run.status, 0, "{}", run.err);
        // The sides are rounded up to even ones.
        let wrote = format!("wrote {name}: 8 frames, 64 × 48 pixels, 12 triangles each");
        assert!(run.err.contains(&wrote), "{}", run.err);
        let frames = frames(&room, name, [64, 48]);
        assert_eq!(frames.len(), 8, "{name}");
        for (index, frame) in frames.iter().enumerate() {
            let still = image::open(room.path(&format!("t-{}.png", index + 1)));
            let still = still.expect("a picture").into_rgb8();
            let bytes = frame.iter().zip(still.as_raw());
            let apart: u64 = bytes.map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
            let mean = apart as f64 / frame.len() as f64;
            // Compression, and colours of four pixels together; another matrix of colours would be 5 apart.
            assert!(mean < 3.0, "{name} {index}: {mean}");
            assert!(
                frame[..3].iter().all(|value| *value > 250),
                "{:?}",
                &frame[..3]
            );
        }
    }
    // What players need: the index before the frames.
    let file = room.read("t.mp4");
    let place = |name: &[u8]| file.windows(4).position(|four| four == name);
    assert!(place(b"moov") < place(b"mdat") && place(b"moov").is_some());
    let ending = room.files();
    assert!(
        !ending.iter().any(|name| name.contains("okoshi")),
        "{ending:?}"
    );
}

#[test]
fn without_ffmpeg_the_message_says_what_to_do() {
    let room = Room::with("a.svg", DRAWING);
    fs::create_dir(room.path("bin")).expect("a folder");
    room.write("t.mp4", "old");
    let run = run(&room, "-o t.mp4 --turntable 4");
    assert_eq!(run.status, 2);
    let told = "`t.mp4` cannot be written: videos need the program ffmpeg, which is not installed; install it (`apt install ffmpeg`";
    assert!(run.err.contains(told), "{}", run.err);
    assert!(
        run.err.contains("or write a .gif or .apng instead"),
        "{}",
        run.err
    );
    assert_eq!(room.read("t.mp4"), b"old");
    assert_eq!(room.files(), ["a.svg", "bin", "t.mp4"]);
}

#[test]
fn errors_of_ffmpeg_leave_the_old_file() {
    for script in [
        "echo \"[libx264 @ 0x5] there is no such thing\" >&2; echo second >&2; exit 3",
        "/bin/cat > /dev/null; echo \"[libx264 @ 0x5] there is no such thing\" >&2; echo second >&2; exit 3",
    ] {
        let room = room_with_ffmpeg(script);
        room.write("t.webm", "old");
        let run = run(&room, "-o t.webm --turntable 40");
        assert_eq!(run.status, 2);
        let told = "`t.webm` cannot be written: ffmpeg failed: there is no such thing; second";
        assert!(run.err.contains(told), "{}", run.err);
        assert_eq!(room.read("t.webm"), b"old");
        assert_eq!(room.files(), ["a.svg", "bin", "t.webm"]);
    }
}

#[test]
fn an_interrupted_video_leaves_nothing() {
    // Takes a while, and writes something first.
    let room = room_with_ffmpeg(
        "for out; do :; done; echo half > \"$out\"; echo > bin/started; /bin/cat > /dev/null; /bin/sleep 0.2; echo > bin/ended",
    );
    room.write("t.mp4", "old");
    let mut child = command(&room, "-o t.mp4 --turntable 1000")
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("it starts");
    let waits = |name: &str| wait_until(name, || room.path(name).exists());
    waits("bin/started");
    child.kill().expect("it runs");
    child.wait().expect("it ends");
    // Its input has ended, so ffmpeg ends too.
    waits("bin/ended");
    assert_eq!(room.read("t.mp4"), b"old");
    assert_eq!(room.files(), ["a.svg", "bin", "t.mp4"]);
}

#[test]
fn wrong_use_of_videos_is_explained() {
    let room = Room::with("a.svg", DRAWING);
    std::os::unix::fs::symlink("a.svg", room.path("b.mp4")).expect("a link");
    for (more, message) in [
        ("-o t.mp4", "would be an animation: choose what it shows"),
        (
            "-o t.mp4 --turntable 4 --background transparent",
            "videos have no transparency: choose another --background, or write .apng",
        ),
        (
            "-o b.mp4 --turntable 4",
            "`b.mp4` is the file that is read, which would be lost",
        ),
    ] {
        let run = run(&room, more);
        assert_eq!(run.status, 2, "{more}");
        assert!(run.err.contains(message), "{more}: {}", run.err);
    }
    assert_eq!(room.read("a.svg"), DRAWING.as_bytes());
}

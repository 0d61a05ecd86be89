use std::io::Read;
use std::path::Path;

use glam::DVec3;

use super::*;
use crate::mocap::{Axis, Channel, Clip};

/// The test files, with their joints, end sites, channels, frames, frame time, and the sum of all numbers, counted by other
/// means.
pub(super) const FILES: [(&str, [usize; 4], f64, f64); 5] = [
    (
        "examples/motion/boxing.bvh",
        [21, 5, 66, 300],
        0.01,
        -35501.535014,
    ),
    (
        "examples/motion/zombie-walk.bvh",
        [75, 16, 228, 31],
        0.041667,
        767.570822,
    ),
    (
        "tests/motion/data/mocapbank.bvh",
        [19, 5, 60, 455],
        0.033333,
        -28574.6041,
    ),
    (
        "tests/motion/data/mixed_orders.bvh",
        [60, 13, 183, 100],
        0.008333,
        -3767.1731,
    ),
    (
        "tests/motion/data/rotation_first.bvh",
        [4, 2, 15, 4],
        0.04,
        417.0,
    ),
];

pub(super) fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap()
}

/// Two joints, each with an end site; the second frame begins in line 21.
pub(super) const SMALL: &str = "HIERARCHY
ROOT Hips
{
  OFFSET 0 1 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Head
  {
    OFFSET 0 2.5 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 1 0
    }
  }
}
MOTION
Frames: 3
Frame Time: 0.041667

1 2 3 4 5 6 7 8 9
-1 -2.5 +3 .5 5. 6e1 7E-1 8e+0 9
0 0 0 0 0 0 0 0 0
";

pub(super) fn small() -> Clip {
    read_bytes(SMALL.as_bytes()).unwrap().clip
}

/// The result of reading the small file after a change.
pub(super) fn changed(from: &str, to: &str) -> Result<Reading, Error> {
    let text = SMALL.replacen(from, to, 1);
    assert_ne!(text, SMALL, "{from}");
    read_bytes(text.as_bytes())
}

pub(super) fn written(clip: &Clip, decimals: Decimals) -> Vec<u8> {
    let mut text = Vec::new();
    write(clip, decimals, &mut text).unwrap();
    text
}

#[test]
fn real_files_are_read_whole() {
    for (name, [joints, ends, width, frames], frame_time, sum) in FILES {
        let Reading { clip, notes } = read_bytes(&bytes(name)).unwrap();
        let skeleton = &clip.skeleton;
        assert_eq!(skeleton.joints.len(), joints, "{name}");
        assert_eq!(
            skeleton
                .joints
                .iter()
                .map(|joint| joint.ends.len())
                .sum::<usize>(),
            ends,
            "{name}"
        );
        assert_eq!(
            (skeleton.channel_count(), clip.frames),
            (width, frames),
            "{name}"
        );
        assert_eq!(clip.frame_time, frame_time, "{name}");
        let ours: f64 = clip.values().iter().sum();
        assert!(
            (ours - sum).abs() < 1e-6 * sum.abs().max(1.0),
            "{name}: {ours}"
        );
        assert_eq!(notes, [], "{name}");
        let text = written(&clip, Decimals::All);
        assert_eq!(
            read_bytes(&text).unwrap(),
            Reading { clip, notes },
            "{name}"
        );
    }
}

#[test]
fn a_small_file_is_read_exactly() {
    let clip = small();
    let joints = &clip.skeleton.joints.raw;
    assert_eq!(joints[0].channels[3], Channel::Rotation(Axis::Z));
    assert_eq!(joints[1].parent, Some(0.into()));
    assert_eq!(joints[1].offset, DVec3::new(0.0, 2.5, 0.0));
    assert_eq!(joints[1].ends, [DVec3::Y]);
    assert_eq!(
        clip.row(1),
        [-1.0, -2.5, 3.0, 0.5, 5.0, 60.0, 0.7, 8.0, 9.0]
    );
    assert_eq!(clip.frame_time, 0.041667);
}

#[test]
fn layout_and_letter_case_do_not_matter() {
    let clip = small();
    let same = |text: Vec<u8>, notes: usize| {
        let reading = read_bytes(&text).unwrap();
        assert_eq!(reading.clip, clip, "{}", String::from_utf8_lossy(&text));
        assert_eq!(reading.notes.len(), notes, "{:?}", reading.notes);
    };
    same(SMALL.replace('\n', "\r\n").into_bytes(), 0);
    same(SMALL.replace('\n', "\r").into_bytes(), 0);
    same(SMALL.replace('\n', "\n\n \t\n").into_bytes(), 0);
    same(SMALL.replace(' ', "\t ").into_bytes(), 0);
    same(format!("\u{FEFF}{SMALL}").into_bytes(), 0);
    same(SMALL.trim_end().as_bytes().to_vec(), 0);
    same(
        SMALL
            .replace("Hips\n{", "Hips {")
            .replace("Site\n    {", "Site{")
            .into_bytes(),
        0,
    );
    same(SMALL.replace("Hips\n{", "\n  Hips\n{").into_bytes(), 0);
    same(SMALL.replace("    }\n  }\n}", "}}}").into_bytes(), 0);
    for keyword in [
        "HIERARCHY",
        "ROOT",
        "JOINT",
        "OFFSET",
        "CHANNELS",
        "MOTION",
        "Frames",
        "Frame Time",
        "End Site",
    ] {
        same(
            SMALL.replace(keyword, &keyword.to_lowercase()).into_bytes(),
            0,
        );
        same(
            SMALL.replace(keyword, &keyword.to_uppercase()).into_bytes(),
            0,
        );
    }
    same(
        SMALL
            .replace("rotation", "ROTATION")
            .replace("Xposition", "xPosition")
            .into_bytes(),
        0,
    );
    same(
        SMALL
            .replace("Frames: 3", "Frames\t:3")
            .replace("Time: ", "Time  :")
            .into_bytes(),
        0,
    );
    same(
        SMALL
            .replace(
                "Frames: 3\nFrame Time: 0.041667",
                "Frame Time: 0.041667\nFrames: 3",
            )
            .into_bytes(),
        0,
    );
    same(
        SMALL
            .replace("MOTION\nFrames: 3\nFrame", "MOTION Frames: 3 Frame")
            .into_bytes(),
        0,
    );
    same(SMALL.replace("JOINT Head", "ROOT Head").into_bytes(), 1);
    same(SMALL.replace("ROOT Hips", "JOINT Hips").into_bytes(), 1);
    same(SMALL.replace("HIERARCHY\n", "").into_bytes(), 1);
    same(
        SMALL
            .replace(" 4 5 6 7 8 9", "\n4 5 6\n7 8 9")
            .replace(" .5 5. 6e1 ", "\n.5 5. 6e1\n")
            .replace("0 0 0 0 0 0 0 0 0", "0 0 0\n0 0 0\n\n0 0 0")
            .into_bytes(),
        0,
    );
    same(SMALL.replace("9\n-1", "9 -1").into_bytes(), 1);
    same(
        SMALL
            .replace("9\n-1", "9 -1")
            .replace("9\n0", "9 0")
            .into_bytes(),
        1,
    );
    same(format!("{SMALL}\nmade by hand\n1 2 3\n").into_bytes(), 1);
    same(format!("{SMALL}\u{1A}").into_bytes(), 1);
}

/// Returns a text in small portions, and is interrupted now and then.
struct Slow<'a>(&'a [u8], usize);

impl Read for Slow<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.1 += 1;
        if self.1.is_multiple_of(5) {
            return Err(std::io::ErrorKind::Interrupted.into());
        }
        let long = self.0.len().min(buffer.len()).min(self.1 % 7 + 1);
        let (now, later) = self.0.split_at(long);
        buffer[..long].copy_from_slice(now);
        self.0 = later;
        Ok(long)
    }
}

#[test]
fn input_may_come_in_any_portions_or_fail() {
    let text = SMALL.replace('\n', "\r\n");
    assert_eq!(read(Slow(text.as_bytes(), 0)).unwrap().clip, small());

    struct Broken;
    impl Read for Broken {
        fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
            Err(std::io::Error::other("no disk"))
        }
    }
    assert!(read(Broken).unwrap_err().message.contains("no disk"));
}

#[test]
fn blocks_of_a_large_file_meet() {
    // Lines of varying length, so that line endings fall anywhere around the ends of blocks; three kinds of line endings.
    for end in ["\n", "\r\n", "\r"] {
        let mut text = SMALL.split("\n1 2 3").next().unwrap().replace('\n', end);
        text = text.replace("Frames: 3", "Frames: 400000");
        let mut random = fastrand::Rng::with_seed(1);
        for frame in 0..400_000 {
            text.push_str(end);
            let number = f64::from(random.u32(..1 << 20)) / 1000.0;
            text.push_str(&format!("{frame} 0 0 {number} 1 2 3 4 5"));
        }
        assert!(text.len() > 9 << 20);
        let Reading { clip, notes } = read_bytes(text.as_bytes()).unwrap();
        assert_eq!(notes, []);
        assert_eq!(clip.frames, 400_000);
        for frame in 0..clip.frames {
            assert_eq!(clip.row(frame)[0], frame as f64);
        }
        // An error far behind the first blocks has the right line, and comes with the frames before it.
        let bad = text.replace(&format!("{end}250000 0 0 "), &format!("{end}250000 0 x "));
        let error = read_bytes(bad.as_bytes()).unwrap_err();
        assert_eq!((error.line, error.column), (250_020, 10), "{error}");
        assert_eq!(error.partial.unwrap().frames, 250_000);
    }
}

#[test]
fn names_are_read_unchanged() {
    let name = |text: &[u8]| {
        let whole = [
            b"HIERARCHY\nROOT",
            text,
            b"{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}\nMOTION\nFrames: 1\nFrame Time: .1\n1",
        ]
        .concat();
        let reading = read_bytes(&whole).unwrap();
        (
            reading.clip.skeleton.joints.raw[0].name.clone(),
            reading.notes.len(),
        )
    };
    assert_eq!(
        name(b" mixamorig:Left Arm \n"),
        ("mixamorig:Left Arm".to_owned(), 0)
    );
    assert_eq!(name("\t右腕\n".as_bytes()), ("右腕".to_owned(), 0));
    assert_eq!(name(b" H\xFCfte \r\n"), ("Hüfte".to_owned(), 1));
    assert_eq!(name(b" \n"), ("Joint1".to_owned(), 1));
    assert_eq!(name(b" JOINT"), ("JOINT".to_owned(), 0));
}

#[test]
fn mistakes_in_the_motion_header_are_corrected() {
    let third = 1.0 / 30.0;
    for (time, seconds) in [
        ("0", third),
        ("-0.04", third),
        ("nan", third),
        ("inf", third),
        ("", third),
        ("fast", third),
        ("1e-9", third),
        ("120", third),
        ("4.1667e-2", 0.041667),
    ] {
        let Reading { clip, notes } = changed("0.041667", time).unwrap();
        assert_eq!(clip.frame_time, seconds, "{time}");
        assert_eq!(notes.len(), usize::from(seconds == third), "{time}");
    }
    for (from, to, line) in [
        ("Frames: 3", "Frames: 4", 17),
        ("Frames: 3", "Frames: 2", 17),
        ("Frames: 3", "Frames: -3", 17),
        ("Frames: 3", "Frames:", 17),
        ("Frames: 3", "Frames: many", 17),
        ("Frames: 3", "Frames: 99999999999999999999999999", 17),
        ("Frames: 3\n", "", 19),
        ("Frame Time: 0.041667\n", "", 19),
        ("Frames: 3\n", "Frames: 3\nFrames: 7\n", 18),
        (
            "Frame Time: 0.041667\n",
            "Frame Time: 0.041667\nFrame Time: 1\n",
            19,
        ),
        ("MOTION\n", "MOTION\nMOTION\n", 17),
        ("  OFFSET 0 1 0\n", "  OFFSET 0 1 0\n  OFFSET 0 1 0\n", 5),
        ("    OFFSET 0 2.5 0\n", "", 7),
        ("      OFFSET 0 1 0\n", "", 11),
    ] {
        let Reading { clip, notes } = changed(from, to).unwrap();
        assert_eq!(clip.frames, 3, "{to}");
        assert_eq!(notes.len(), 1, "{notes:?}");
        assert_eq!(notes[0].line, line, "{notes:?}");
    }
    let none = SMALL
        .replace("Frames: 3", "Frames: 0")
        .split("\n1 2 3")
        .next()
        .unwrap()
        .to_owned();
    let Reading { clip, notes } = read_bytes(none.as_bytes()).unwrap();
    assert_eq!((clip.frames, notes.len()), (0, 1));
}

#[test]
fn several_roots_and_joints_without_channels_are_read() {
    let two = SMALL.replace("}\nMOTION", "}\nROOT Prop\n{\nOFFSET 1 2 3\nCHANNELS 0\nEnd Site\n{\nOFFSET 1 1 1\n}\nEnd Site\n{\nOFFSET 2 2 2\n}\n}\nMOTION");
    let Reading { clip, notes } = read_bytes(two.as_bytes()).unwrap();
    let prop = &clip.skeleton.joints.raw[2];
    assert_eq!((prop.parent, prop.ends.len(), notes.len()), (None, 2, 0));
    assert_eq!(clip.frames, 3);
    assert_eq!(
        read_bytes(&written(&clip, Decimals::All)).unwrap().clip,
        clip
    );
}

#[test]
fn deep_hierarchies_are_read_and_written() {
    let mut text = "HIERARCHY\n".to_owned();
    for _ in 0..MAX_JOINTS {
        text.push_str("JOINT a{OFFSET 0 1 0\nCHANNELS 0\n");
    }
    let ends = "}".repeat(MAX_JOINTS);
    let whole = format!("{text}{ends}\nMOTION\n");
    let Reading { clip, notes } = read_bytes(whole.as_bytes()).unwrap();
    assert_eq!(clip.skeleton.joints.len(), MAX_JOINTS);
    assert!(notes.len() < MAX_NOTES);
    let again = written(&clip, Decimals::All);
    assert!(again.len() < 1 << 24);
    assert_eq!(read_bytes(&again).unwrap().clip, clip);
    let error = read_bytes(format!("{text}JOINT b{{\n}}{ends}\nMOTION\n").as_bytes()).unwrap_err();
    assert!(error.message.contains("more than 65536 joints"), "{error}");
}

/// A file that was written without line breaks is the same file.
#[test]
fn a_file_on_one_line_is_read() {
    for name in [
        "tests/motion/data/mixed_orders.bvh",
        "examples/motion/walk.bvh",
    ] {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
        let text = std::fs::read_to_string(path).unwrap();
        let whole = read_bytes(text.as_bytes()).unwrap();
        let line = text.split_ascii_whitespace().collect::<Vec<_>>().join(" ");
        let read = read_bytes(line.as_bytes()).unwrap();
        assert_eq!(read.clip, whole.clip, "{name}");
        let notes: Vec<String> = read.notes.iter().map(ToString::to_string).collect();
        assert_eq!(
            notes,
            ["line 1: several frames on one line: read one after the other"]
        );
    }
}

/// An error in a line that also has the header points to the right place.
#[test]
fn errors_behind_the_header_have_their_column() {
    let text = "HIERARCHY ROOT A { OFFSET 0 0 0 CHANNELS 1 Xrotation End Site { OFFSET 0 1 0 } } MOTION Frames: 2 Frame Time: 0.1 1 x";
    let error = read_bytes(text.as_bytes()).unwrap_err();
    assert_eq!((error.line, error.column), (1, text.len()));
}

//! Malformed files: each is rejected with its line, or corrected with a note.

use super::tests::{SMALL, changed};
use super::*;

/// Expects an error at a line and a column, with these words, and with this many frames.
fn refused(
    reading: Result<Reading, Error>,
    line: usize,
    column: usize,
    words: &str,
    frames: usize,
) {
    let error = reading.expect_err(words);
    assert!(error.message.contains(words), "{error}, not {words}");
    assert_eq!((error.line, error.column), (line, column), "{error}");
    assert_eq!(
        error.partial.map_or(0, |clip| clip.frames),
        frames,
        "{words}"
    );
    assert!(!error.help.is_empty());
}

#[test]
fn errors_in_the_hierarchy_have_their_line() {
    for (from, to, line, column, words) in [
        (SMALL, "", 1, 1, "ends before MOTION"),
        (
            "HIERARCHY",
            "<svg>",
            1,
            1,
            "begins with HIERARCHY, not with `<svg>`",
        ),
        (
            "HIERARCHY\nROOT Hips\n",
            "",
            1,
            1,
            "begins with HIERARCHY, not with `{`",
        ),
        (
            "Hips\n{\n",
            "Hips\n",
            3,
            3,
            "`{` is missing after joint `Hips`, before `OFFSET`",
        ),
        (
            "Site\n    {\n",
            "Site\n",
            11,
            7,
            "`{` is missing after `End Site`",
        ),
        (
            "  }\n}\n",
            "}\n",
            15,
            1,
            "MOTION, but `Hips` of line 3 is still open",
        ),
        ("}\nMOTION", "}\n}\nMOTION", 16, 1, "`}` closes nothing"),
        ("OFFSET 0 1 0", "OFFSET 0 1", 4, 13, "OFFSET has 2 numbers"),
        (
            "OFFSET 0 1 0",
            "OFFSET 0 1 0 0",
            4,
            16,
            "`0` is not expected here",
        ),
        ("OFFSET 0 1 0", "OFFSET 0 y 0", 4, 12, "`y` is not a number"),
        (
            "OFFSET 0 2.5 0",
            "OFFSET 0 2,5 0",
            8,
            14,
            "`2,5` has a comma",
        ),
        (
            "OFFSET 0 1 0",
            "OFFSET 0 nan 0",
            4,
            12,
            "`nan` is not a finite number",
        ),
        (
            "OFFSET 0 1 0",
            "OFFSET 0 1e300 0",
            4,
            12,
            "`1e300` is too large: the limit is 1e12",
        ),
        (
            "OFFSET 0 1 0\n",
            "OFFSET 0 1 0\n  OFFSET 0 2 0\n",
            5,
            3,
            "a second OFFSET",
        ),
        (
            "CHANNELS 3",
            "CHANNELS 2",
            9,
            14,
            "CHANNELS says 2, but 3 follow",
        ),
        (
            "CHANNELS 3 Zrotation",
            "CHANNELS 3",
            9,
            14,
            "CHANNELS says 3, but 2 follow",
        ),
        ("CHANNELS 3", "CHANNELS", 9, 14, "CHANNELS has no count"),
        ("Zposition", "Zscale", 5, 34, "`Zscale` is not a channel"),
        (
            "    End Site\n",
            "    CHANNELS 1 Xrotation\n    End Site\n",
            10,
            5,
            "second CHANNELS",
        ),
        (
            "      OFFSET 0 1 0\n",
            "      OFFSET 0 1 0\n CHANNELS 1 Xrotation\n",
            13,
            2,
            "CHANNELS in an `End Site`",
        ),
        (
            "      OFFSET 0 1 0\n",
            "      OFFSET 0 1 0\n JOINT x\n{\n}\n",
            13,
            2,
            "a joint within an `End Site`",
        ),
        (
            "ROOT Hips",
            "End Site",
            2,
            1,
            "`End Site` is not within a joint",
        ),
        ("MOTION", "MOTIONS", 16, 1, "`MOTIONS` is not expected"),
        ("MOTION\n", "", 16, 1, "`Frames:` is not expected"),
        ("MOTION", "HIERARCHY", 16, 1, "`HIERARCHY` is not expected"),
        ("MOTION", "MOTION 1 2 3", 16, 8, "`1` is not expected"),
        ("0.041667", "0,041667", 18, 13, "`0,041667` has a comma"),
        ("0.041667", "0.04 0.04", 18, 18, "`0.04` is not expected"),
    ] {
        refused(changed(from, to), line, column, words, 0);
    }
    let joints = SMALL.find("ROOT").unwrap()..SMALL.find("MOTION").unwrap();
    let mut none = SMALL.to_owned();
    none.replace_range(joints, "");
    refused(read_bytes(none.as_bytes()), 2, 1, "there is no joint", 0);
    refused(read_bytes(b"\xFF\xFEH\0I\0E\0"), 1, 1, "UTF-16", 0);
    refused(read_bytes(b"\n\n  \n"), 1, 1, "ends before MOTION", 0);
    refused(
        changed("Hips", &"x".repeat(MAX_NAME_BYTES + 1)),
        2,
        6,
        "longer than 1024 bytes",
        0,
    );
}

#[test]
fn errors_in_frames_have_their_line() {
    for (from, to, line, column, words, frames) in [
        (
            "1 2 3 4",
            "1 2 3",
            20,
            16,
            "8 numbers, but a frame of this skeleton has 9",
            0,
        ),
        (
            "1 2 3 4",
            "1 2 3 3 4",
            20,
            19,
            "10 numbers, but a frame of this skeleton has 9",
            0,
        ),
        (
            "-1 -2.5 +3",
            "-1 -2.5",
            21,
            30,
            "8 numbers, but a frame of this skeleton has 9",
            1,
        ),
        (
            "-1 -2.5 +3",
            "-1 -2.5 +3 0",
            21,
            34,
            "10 numbers, but a frame of this skeleton has 9",
            1,
        ),
        (
            "0 0 0 0 0 0 0 0 0",
            "0 0 0 0",
            22,
            8,
            "4 numbers, but a frame of this skeleton has 9",
            2,
        ),
        (
            "-1 -2.5 +3",
            "-1 -2.5\n+3",
            21,
            8,
            "2 numbers, but a frame of this skeleton has 9",
            1,
        ),
        ("+3", "3,5", 21, 9, "`3,5` has a comma", 1),
        ("+3", "nan", 21, 9, "`nan` is not a finite number", 1),
        ("+3", "-INF", 21, 9, "`-INF` is not a finite number", 1),
        ("+3", "-1.#IND", 21, 9, "not a finite number", 1),
        ("+3", "1e13", 21, 9, "too large", 1),
        ("+3", "--3", 21, 9, "`--3` is not a number", 1),
        ("+3", "3.0.1", 21, 9, "`3.0.1` is not a number", 1),
        ("-1 -2.5", "x -2.5", 21, 1, "`x` is not a number", 1),
        (
            "0 0 0 0 0 0 0 0 0",
            "END",
            22,
            1,
            "`END` is not a number",
            2,
        ),
        (
            "0 0 0 0 0 0 0 0 0",
            "0 0 -",
            22,
            5,
            "`-` is not a number",
            2,
        ),
        (
            "1 2 3 4 5 6 7 8 9",
            "end",
            20,
            1,
            "`end` is not expected",
            0,
        ),
    ] {
        refused(changed(from, to), line, column, words, frames);
    }
    let cut = SMALL.split("1 2 3").next().unwrap();
    refused(
        read_bytes(cut.as_bytes()),
        18,
        21,
        "ends before the first of 3 frames",
        0,
    );
    let broken = SMALL.replace("3 4 5", "3\n4 5").replace("+3 .5", "+3 .5\n");
    refused(
        read_bytes(broken.as_bytes()),
        22,
        12,
        "4 numbers, but 3 are due in this line of a frame of 9",
        1,
    );
    let broken = SMALL
        .replace("3 4 5", "3\n4 5")
        .replace("+3 .5", "+3\n.5")
        .replace("0 0 0 0 0 0 0 0 0", "0 0 0");
    refused(
        read_bytes(broken.as_bytes()),
        24,
        6,
        "3 numbers, but a frame of this skeleton has 9",
        2,
    );
    let only = SMALL.split("-1 -2.5").next().unwrap().replace(" 8 9", "");
    refused(
        read_bytes(only.as_bytes()),
        20,
        14,
        "7 numbers, but a frame of this skeleton has 9",
        0,
    );
}

#[test]
fn columns_count_characters() {
    refused(
        changed("Hips\n{", "右腕 { x"),
        2,
        11,
        "`x` is not expected",
        0,
    );
    refused(changed("+3", "三"), 21, 9, "`三` is not a number", 1);
}

#[test]
fn exceeded_limits_are_reported() {
    let long = " ".repeat(MAX_LINE_BYTES + (8 << 20));
    refused(
        read_bytes(format!("HIERARCHY\n{long}").as_bytes()),
        2,
        1,
        "longer than 16 MiB",
        0,
    );
    let many = "Xrotation ".repeat(MAX_CHANNELS + 1);
    refused(
        changed(
            "CHANNELS 3 Zrotation Xrotation Yrotation",
            &format!("CHANNELS {} {many}", MAX_CHANNELS + 1),
        ),
        9,
        5,
        "more than 1048576 numbers in a frame",
        0,
    );
    // A wrong count does not allocate memory.
    assert_eq!(
        changed("Frames: 3", "Frames: 999999999999")
            .unwrap()
            .clip
            .frames,
        3
    );
    let mut nameless = "HIERARCHY\n".to_owned();
    for _ in 0..1000 {
        nameless.push_str("ROOT\n{\n}\n");
    }
    let notes = read_bytes(format!("{nameless}MOTION\n").as_bytes())
        .unwrap()
        .notes;
    assert_eq!(notes.len(), MAX_NOTES + 1);
    assert!(notes[MAX_NOTES].message.contains("more notes"));
}

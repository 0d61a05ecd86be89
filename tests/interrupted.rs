//! Outputs when the program is killed or the disk is full: the old file or the new one, whole, and nothing else.
//!
//! `OKOSHI_KILLS=400 cargo test --test interrupted -- --nocapture` kills more often, and prints what was found.
#![cfg(feature = "cli")]
#![allow(
    clippy::print_stdout,
    reason = "with --nocapture it says what kills left, and what is skipped"
)]
#![cfg(target_os = "linux")]

mod common;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

use common::program::{Room, Run, files};
use fastrand::Rng;

/// How often each command is killed, unless `OKOSHI_KILLS` says it.
const KILLS: usize = 12;

/// How much longer than an undisturbed run the longest life of a process is.
const LONGEST_LIFE: f64 = 1.2;

/// How long the output may stay open before a kill that aims at its writing, in microseconds.
const WRITING: u64 = 20_000;

/// A drawing whose outputs take a while to write; those of different versions differ.
fn drawing(version: usize) -> String {
    let mut text =
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"400\" height=\"400\">\n".to_owned();
    for index in 0..36 {
        let (x, y) = (20 + 40 * (index % 6), 20 + 40 * (index / 6));
        let radius = 9 + (index + version) % 7;
        let _ = writeln!(
            text,
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"#0000ff\"/>"
        );
    }
    text + "<text x=\"20\" y=\"20\">Body$Shape inflate</text></svg>\n"
}

/// A drawing with a mistake that `check --fix` mends, so long that writing it takes a while.
fn mistaken(version: usize) -> String {
    let text = drawing(version).replace("$Shape", "$Shpae");
    let comment = format!("<!-- {} -->\n", "padding ".repeat(500));
    text.replace("</svg>", &format!("{}</svg>", comment.repeat(400)))
}

/// A command, what it reads, and what it replaces.
struct Case {
    arguments: &'static [&'static str],
    input: &'static str,
    source: fn(usize) -> String,
    output: &'static str,
}

const CASES: [Case; 3] = [
    Case {
        arguments: &["build", "-q", "a.svg"],
        input: "a.svg",
        source: drawing,
        output: "a.glb",
    },
    Case {
        arguments: &["render", "-q", "a.svg", "--size=100x100", "-o", "a.png"],
        input: "a.svg",
        source: drawing,
        output: "a.png",
    },
    Case {
        arguments: &["check", "--fix", "a.svg"],
        input: "a.svg",
        source: mistaken,
        output: "a.svg",
    },
];

fn start(room: &Room, arguments: &[&str]) -> Child {
    room.command(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("it starts")
}

/// Whether a process has a file open that has no name, or the name of a temporary file.
fn is_writing(child: &Child) -> bool {
    let entries = fs::read_dir(format!("/proc/{}/fd", child.id()));
    entries.into_iter().flatten().flatten().any(|entry| {
        let target = fs::read_link(entry.path()).unwrap_or_default();
        let target = target.to_string_lossy();
        target.ends_with("(deleted)") || target.contains(".okoshi-")
    })
}

/// Waits for a random moment in the life of a process: any, or one while it writes.
fn wait_for_moment(child: &mut Child, usual: Duration, random: &mut Rng) {
    if random.bool() {
        std::thread::sleep(usual.mul_f64(LONGEST_LIFE * random.f64()));
        return;
    }
    while child.try_wait().expect("a process").is_none() {
        if is_writing(child) {
            std::thread::sleep(Duration::from_micros(random.u64(..WRITING)));
            return;
        }
    }
}

/// What a kill left.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord, Clone, Copy)]
enum Left {
    Old,
    New,
}

/// Kills a command again and again over the same output.
fn kill_often(case: &Case) {
    let kills = std::env::var("OKOSHI_KILLS")
        .ok()
        .and_then(|kills| kills.parse().ok())
        .unwrap_or(KILLS);
    let mut random = Rng::with_seed(71);
    let room = Room::new();
    // Complete outputs of two versions, each made in a folder of its own, and how long that takes.
    let began = Instant::now();
    let outputs = [0, 1].map(|version| {
        let room = Room::with(case.input, (case.source)(version));
        assert_eq!(room.run(case.arguments).status, 0);
        room.read(case.output)
    });
    let usual = began.elapsed() / 2;
    assert!(
        outputs[0] != outputs[1],
        "the versions have different outputs"
    );
    room.write(case.output, &outputs[1]);
    let mut found: BTreeMap<Left, usize> = BTreeMap::new();
    let mut leftovers = 0;
    for kill in 0..kills {
        let version = kill % 2;
        room.write(case.input, (case.source)(version));
        let old = room.read(case.output);
        let mut child = start(&room, case.arguments);
        wait_for_moment(&mut child, usual, &mut random);
        // It may have ended before.
        let _ = child.kill();
        child.wait().expect("it ends");
        let now = room.read(case.output);
        let left = if now == outputs[version] {
            Left::New
        } else {
            Left::Old
        };
        assert!(
            left == Left::New || now == old,
            "{:?} left a torn file",
            case.arguments
        );
        *found.entry(left).or_default() += 1;
        leftovers = temporary(&room).len();
    }
    println!(
        "{:?}: {kills} kills left {found:?}, {leftovers} temporary files",
        case.arguments
    );
    // A file has a temporary name for the moment between its first name and its last one.
    assert!(
        leftovers * 20 <= kills + 20,
        "{leftovers} temporary files after {kills} kills"
    );
    let old = SystemTime::now() - Duration::from_secs(120);
    for name in temporary(&room) {
        let file = File::options().write(true).open(room.path(&name));
        file.and_then(|file| file.set_modified(old))
            .expect("it is aged");
    }
    room.write(case.input, (case.source)(0));
    assert_eq!(room.run(case.arguments).status, 0);
    assert!(room.read(case.output) == outputs[0]);
    let mut expected = vec![case.input, case.output];
    expected.sort_unstable();
    expected.dedup();
    let expected: Vec<String> = expected.into_iter().map(str::to_owned).collect();
    assert_eq!(
        sorted(room.files()),
        sorted(expected),
        "the next output removes what is left"
    );
}

fn sorted(mut names: Vec<String>) -> Vec<String> {
    names.sort();
    names
}

fn temporary(room: &Room) -> Vec<String> {
    let mut names = room.files();
    names.retain(|name| name.starts_with(".okoshi-"));
    names
}

#[test]
fn a_killed_build_leaves_a_whole_model() {
    kill_often(&CASES[0]);
}

#[test]
fn a_killed_render_leaves_a_whole_picture() {
    kill_often(&CASES[1]);
}

#[test]
fn a_killed_fix_leaves_a_whole_drawing() {
    kill_often(&CASES[2]);
}

// ---- full disks

/// The commands that write files, with what they write.
const WRITERS: [(&[&str], &str); 12] = [
    (&["build", "../a.svg", "-o", "a.glb"], "a.glb"),
    (&["build", "../a.svg", "-o", "a.gltf"], "a.gltf"),
    (&["build", "../a.svg", "-o", "a.obj"], "a.obj"),
    (
        &["render", "../a.svg", "--size=100x100", "-o", "a.png"],
        "a.png",
    ),
    (
        &[
            "render",
            "../a.svg",
            "--size=100x100",
            "--turntable=4",
            "-o",
            "a.gif",
        ],
        "a.gif",
    ),
    (
        &[
            "render",
            "../a.svg",
            "--size=100x100",
            "--turntable=4",
            "-o",
            "a.apng",
        ],
        "a.apng",
    ),
    (&["motion", "../a.bvh", "-o", "b.bvh"], "b.bvh"),
    (&["motion", "../a.bvh", "--plot", "b.svg"], "b.svg"),
    (&["puppet", "../a.svg", "-o", "b.svg"], "b.svg"),
    (
        &[
            "track",
            "../a.webp",
            "--mark=red",
            "--mark=green",
            "--mark=blue",
            "--mark=magenta",
            "-o",
            "b.json",
        ],
        "b.json",
    ),
    (&["check", "--fix", "b.svg"], "b.svg"),
    (
        &[
            "edit",
            "b.svg",
            r#"--change={"change": "name", "part": "Body", "name": "Trunk"}"#,
        ],
        "b.svg",
    ),
];

/// What stands in the place of the output before: of okoshi, so that it may be replaced.
const OLD: &str = "<!-- Chart of a motion, written by okoshi 0.0.0 -->";

/// A room with the inputs, and an empty folder in it.
fn room() -> Room {
    let room = Room::with("a.svg", drawing(0));
    let motion = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/motion/walk.bvh");
    room.write("a.bvh", fs::read(motion).expect("an example"));
    let film = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/motion/hook-puppet.webp");
    room.write("a.webp", fs::read(film).expect("an example"));
    fs::create_dir(room.path("full")).expect("made");
    room
}

/// Runs every command with no space for its output: each says so, and the old file stays as it was.
fn check_full(room: &Room, run: impl Fn(&[&str]) -> Run) {
    let folder = room.path("full");
    for (arguments, output) in WRITERS {
        let edits = matches!(arguments[0], "check" | "edit");
        let old = if edits { mistaken(0) } else { OLD.to_owned() };
        fs::write(folder.join(output), &old).expect("there is space for the old file");
        let ran = run(arguments);
        let expected = format!("error: there is no space for `{output}` (");
        assert_eq!(ran.status, 2, "{arguments:?}: {}", ran.err);
        assert!(ran.err.contains(&expected), "{arguments:?}: {}", ran.err);
        assert!(
            ran.err.contains("free some, or write to another place"),
            "{}",
            ran.err
        );
        assert!(
            fs::read_to_string(folder.join(output)).expect("it is there") == old,
            "{arguments:?}"
        );
        assert_eq!(files(&folder), [output], "{arguments:?}");
        fs::remove_file(folder.join(output)).expect("removed");
    }
}

/// A file system that is unmounted when this is dropped.
struct Mounted<'a>(&'a Path);

impl Drop for Mounted<'_> {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0).status();
    }
}

#[test]
fn a_full_disk_leaves_the_old_file_and_nothing_else() {
    let room = room();
    let folder = room.path("full");
    let mount = Command::new("mount")
        .args(["-t", "tmpfs", "-o", "size=2m", "okoshi-test"])
        .arg(&folder)
        .output();
    if !mount.is_ok_and(|mount| mount.status.success()) {
        println!("skipped: only root may mount a small file system");
        return;
    }
    let _mounted = Mounted(&folder);
    // All but a page or two; the old file that is edited is written first.
    check_full(&room, |arguments| {
        let filler = folder.join("filler");
        fill(&filler);
        let ran = Run::of(
            room.command(arguments)
                .current_dir(&folder)
                .output()
                .expect("it starts"),
        );
        fs::remove_file(filler).expect("removed");
        ran
    });
}

/// Fills a file system up to the last byte.
fn fill(path: &Path) {
    use std::io::Write as _;
    let mut file = File::create(path).expect("created");
    // Twice, for a file system counts its pages a few at a time.
    for size in [1 << 16, 1 << 12, 1, 1 << 12, 1] {
        while file.write_all(&vec![0; size]).is_ok() {}
    }
}

#[test]
fn a_limit_on_file_sizes_leaves_the_old_file_and_nothing_else() {
    let room = room();
    check_full(&room, |arguments| {
        // The system would end the program, without a message, at the first byte too many.
        let mut command = Command::new("sh");
        command
            .args(["-c", "ulimit -f 4; exec \"$0\" \"$@\""])
            .arg(env!("CARGO_BIN_EXE_okoshi"))
            .args(arguments)
            .current_dir(room.path("full"));
        Run::of(command.output().expect("it starts"))
    });
}

#[test]
fn a_folder_without_permission_is_named() {
    use std::os::unix::fs::PermissionsExt as _;
    let room = room();
    let folder = room.path("full");
    fs::set_permissions(&folder, fs::Permissions::from_mode(0o555)).expect("permitted");
    if File::create(folder.join("probe")).is_ok() {
        println!("skipped: root may write anywhere");
        return;
    }
    for (arguments, _) in WRITERS
        .iter()
        .filter(|(arguments, _)| arguments[0] != "check")
    {
        let ran = Run::of(
            room.command(arguments)
                .current_dir(&folder)
                .output()
                .expect("it starts"),
        );
        assert_eq!(ran.status, 2, "{arguments:?}");
        assert!(
            ran.err
                .contains("error: no permission to write in the folder `.`"),
            "{}",
            ran.err
        );
        assert!(files(&folder).is_empty());
    }
    fs::set_permissions(&folder, fs::Permissions::from_mode(0o755)).expect("permitted");
}

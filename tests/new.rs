//! `okoshi new`: starter drawings.
#![cfg(feature = "cli")]

mod common;

use std::fs;
use std::process::Output;

use common::program::Room;

/// The templates, and how many nodes each makes at least: a landscape is one, below the root.
const TEMPLATES: [(&str, usize); 4] = [("human", 8), ("car", 8), ("island", 2), ("boy", 20)];

fn run(room: &Room, arguments: &[&str]) -> Output {
    room.command(arguments).output().expect("it starts")
}

/// Runs, and expects an exit status, nothing on stdout, and words on stderr.
#[track_caller]
fn ends(room: &Room, arguments: &[&str], status: i32, words: &[&str]) {
    let output = run(room, arguments);
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{told}");
    assert_eq!(String::from_utf8_lossy(&output.stdout), "");
    for word in words {
        assert!(told.contains(word), "stderr lacks {word:?}:\n{told}");
    }
}

#[test]
fn every_template_builds_without_diagnostics() {
    for (template, least) in TEMPLATES {
        let room = Room::new();
        ends(
            &room,
            &["new", "me", "--template", template],
            0,
            &[
                "wrote me.svg",
                "\n  okoshi build me.svg\n",
                "\n  okoshi inspect me.svg\n",
            ],
        );
        let checked = run(&room, &["check", "-v", "me.svg"]);
        assert_eq!(
            String::from_utf8_lossy(&checked.stdout),
            "me.svg: no findings\n",
            "{template}"
        );
        ends(&room, &["build", "-q", "me.svg"], 0, &[]);
        let nodes = common::nodes(&fs::read(room.path("me.glb")).expect("a model"));
        let nodes = nodes.expect("a valid model");
        assert!(nodes.len() >= least, "{template} has {} nodes", nodes.len());
        common::check_laws(&nodes).expect(template);
        assert_eq!(room.files(), ["me.glb", "me.svg"]);
    }
}

#[test]
fn help_lists_all_templates() {
    let output = run(&Room::new(), &["new", "--help"]);
    let help = String::from_utf8_lossy(&output.stdout).into_owned();
    for (template, _) in TEMPLATES {
        assert!(help.contains(template), "{help}");
    }
    ends(
        &Room::new(),
        &["new", "me", "--template", "boat"],
        2,
        &[
            "invalid value 'boat'",
            "[possible values: human, car, island, boy]",
        ],
    );
    ends(&Room::new(), &["new"], 2, &["<NAME>"]);
}

#[test]
fn existing_drawings_are_not_overwritten() {
    let room = Room::new();
    fs::write(room.path("my me.svg"), "hours of work").expect("written");
    for name in ["my me", "my me.svg"] {
        ends(
            &room,
            &["new", name],
            2,
            &[
                "error: `my me.svg` exists",
                "choose another name",
                "okoshi build 'my me.svg'",
            ],
        );
    }
    let kept = fs::read(room.path("my me.svg")).expect("kept");
    assert_eq!(kept, b"hours of work");
    fs::create_dir(room.path("folder.svg")).expect("made");
    ends(&room, &["new", "folder"], 2, &["`folder.svg` exists"]);
    assert_eq!(room.files(), ["folder.svg", "my me.svg"]);
}

#[test]
fn the_extension_is_added_once() {
    let room = Room::new();
    fs::create_dir(room.path("in")).expect("made");
    for name in ["a", "b.svg", "c.d", "in/e"] {
        ends(&room, &["new", "-q", name], 0, &[]);
    }
    assert_eq!(room.files(), ["a.svg", "b.svg", "c.d.svg", "in"]);
    assert_eq!(common::program::files(&room.path("in")), ["e.svg"]);
}

#[test]
fn names_that_are_no_path_are_refused() {
    let room = Room::new();
    ends(
        &room,
        &["new", "none/me"],
        2,
        &["error: the folder `none` is not there; create it"],
    );
    fs::write(room.path("file"), "").expect("written");
    ends(
        &room,
        &["new", "file/me"],
        2,
        &["error: the folder `file` is not there"],
    );
    for name in ["..", "folder/"] {
        ends(&room, &["new", name], 2, &["is not a file name"]);
    }
    ends(
        &room,
        &["new", ""],
        2,
        &["a value is required for '<NAME>'"],
    );
    ends(&room, &["new", "me.svgz"], 2, &["write `me.svg`"]);
    assert_eq!(room.files(), ["file"]);
}

#[cfg(unix)]
#[test]
fn read_only_folders_are_refused() {
    use std::os::unix::fs::PermissionsExt as _;

    let room = Room::new();
    let folder = room.path("locked");
    fs::create_dir(&folder).expect("made");
    fs::set_permissions(&folder, fs::Permissions::from_mode(0o555)).expect("locked");
    // Root can write everywhere; then this test checks nothing.
    if fs::write(folder.join("probe"), "").is_ok() {
        return;
    }
    ends(
        &room,
        &["new", "locked/me"],
        2,
        &["error: no permission to write in the folder `locked`; name a drawing in another"],
    );
    assert!(common::program::files(&folder).is_empty());
}

#[cfg(target_os = "linux")]
#[test]
fn errors_of_the_system_are_reported() {
    // Not even root can create files there.
    let name = "/proc/okoshi-me";
    ends(&Room::new(), &["new", name], 2, &["error: ", "/proc"]);
}

#[test]
fn a_template_on_stdout() {
    let room = Room::new();
    let output = run(&room, &["new", "-", "--template", "car"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(output.stderr, b"");
    ends(&room, &["new", "-q", "me", "--template", "car"], 0, &[]);
    let written = fs::read(room.path("me.svg")).expect("written");
    assert_eq!(output.stdout, written);
}

//! `okoshi new`: starter drawings.
#![cfg(feature = "cli")]

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::process::Output;

use common::program::Room;
use glam::Quat;
use gltf::animation::util::ReadOutputs;

/// A template, and what it must be.
struct Starter {
    name: &'static str,
    /// How many nodes it makes at least, with the root: a landscape is one, and so is a character that turns with its regions.
    nodes: usize,
    /// Its clips, each with nodes that must move far.
    clips: &'static [(&'static str, &'static [&'static str])],
}

const LIMBS: &[&str] = &["Rarm", "Larm", "Rleg", "Lleg.2", "Rshoe"];
const LEGS: &[&str] = &[
    "Near fore leg",
    "Near hind leg.2",
    "Far fore leg",
    "Far hind leg",
];

const STARTERS: [Starter; 9] = [
    Starter {
        name: "girl",
        nodes: 12,
        clips: &[("walk", LIMBS), ("walk", &["Lbraid.4", "Rbraid.4"])],
    },
    Starter {
        name: "boy",
        nodes: 11,
        clips: &[("walk", LIMBS), ("wave", &["Rarm", "Rarm.2"])],
    },
    Starter {
        name: "dog",
        nodes: 16,
        clips: &[("walk", LEGS)],
    },
    Starter {
        name: "dragon",
        nodes: 20,
        clips: &[("fly", &["Near wing", "Far wing"])],
    },
    Starter {
        name: "robot",
        nodes: 20,
        clips: &[
            ("walk", &["Right thigh", "Right shin", "Left upper arm"]),
            (
                "dance",
                &["Right upper arm", "Right forearm", "Left forearm"],
            ),
        ],
    },
    Starter {
        name: "racing-car",
        nodes: 7,
        clips: &[("drive", &["Front wheel", "Rear wheel"])],
    },
    Starter {
        name: "island",
        nodes: 2,
        clips: &[],
    },
    Starter {
        name: "turning",
        nodes: 30,
        clips: &[("Fox turns", &["Head", "Tail", "Left arm"])],
    },
    Starter {
        name: "empty",
        nodes: 1,
        clips: &[],
    },
];

/// How far something must move in a clip: turns in radians, weights of morph targets.
const FAR: f32 = 0.12;

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

/// The shapes of a drawing that are art: neither samples of legends nor lines from strings to what they mean.
fn shapes(drawing: &str) -> usize {
    let document = roxmltree::Document::parse(drawing).expect("XML");
    let is_art = |node: &roxmltree::Node<'_, '_>| {
        let id = node.attribute("id").unwrap_or_default();
        ["path", "rect", "circle", "ellipse"].contains(&node.tag_name().name())
            && !id.starts_with("leader")
            && !id.starts_with("sample")
    };
    document.descendants().filter(is_art).count()
}

/// The clips of a model: their names, and per node how far it moves from its first pose.
fn clips(glb: &[u8]) -> Vec<(String, BTreeMap<String, f32>)> {
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(glb).expect("a model");
    let blob = blob.unwrap_or_default();
    let clip = |clip: gltf::Animation<'_>| {
        let mut far = BTreeMap::new();
        for channel in clip.channels() {
            let reader = channel.reader(|_| Some(&*blob));
            let most = match reader.read_outputs().expect("keys") {
                ReadOutputs::Rotations(turns) => {
                    let turns: Vec<Quat> = turns.into_f32().map(Quat::from_array).collect();
                    let angles = turns.iter().map(|turn| turns[0].angle_between(*turn));
                    angles.fold(0.0, f32::max)
                }
                ReadOutputs::MorphTargetWeights(weights) => {
                    let weights: Vec<f32> = weights.into_f32().collect();
                    let (low, high) = (weights.iter(), weights.iter());
                    high.fold(0.0, |a: f32, b| a.max(*b)) - low.fold(1.0, |a: f32, b| a.min(*b))
                }
                _ => continue,
            };
            let node = channel.target().node().name().unwrap_or_default();
            far.insert(node.to_owned(), most);
        }
        (clip.name().unwrap_or_default().to_owned(), far)
    };
    document.animations().map(clip).collect()
}

/// Of all that okoshi can say of a drawing, a starter gets at most the hint that its shapes are inflated because no string
/// says `Shape`.
#[test]
fn every_template_builds_without_diagnostics_and_moves() {
    for starter in STARTERS {
        let name = starter.name;
        let room = Room::new();
        ends(
            &room,
            &["new", "me", "--template", name],
            0,
            &[
                "wrote me.svg",
                "\n  okoshi build me.svg\n",
                "\n  okoshi inspect me.svg\n",
            ],
        );
        let checked = run(&room, &["check", "-v", "me.svg"]);
        let report = String::from_utf8_lossy(&checked.stdout).into_owned();
        let said = report.lines().filter(|line| {
            ["error", "warning", "hint"]
                .iter()
                .any(|it| line.starts_with(it))
        });
        let said: Vec<&str> = said
            .filter(|line| !line.starts_with("hint[H417]"))
            .collect();
        assert!(said.is_empty(), "{name}: {said:#?}");
        ends(&room, &["build", "-q", "me.svg"], 0, &[]);
        let model = fs::read(room.path("me.glb")).expect("a model");
        let nodes = common::nodes(&model).expect("a valid model");
        assert!(
            nodes.len() >= starter.nodes,
            "{name} has {} nodes",
            nodes.len()
        );
        common::check_laws(&nodes).expect(name);
        let clips = clips(&model);
        assert_eq!(clips.is_empty(), starter.clips.is_empty(), "{name}");
        for (clip, movers) in starter.clips {
            let found = clips.iter().find(|(found, _)| found == clip);
            let Some((_, far)) = found else {
                panic!("{name} has no clip {clip}");
            };
            for mover in *movers {
                let moved = far.get(*mover).copied().unwrap_or_default();
                assert!(
                    moved >= FAR,
                    "{name}: in {clip}, {mover} moves by {moved} only: {far:#?}"
                );
            }
        }
        let drawing = fs::read_to_string(room.path("me.svg")).expect("text");
        let count = shapes(&drawing);
        assert!(
            (30..=60).contains(&count) || name == "empty" && count == 0,
            "{name} has {count} shapes"
        );
        assert_eq!(room.files(), ["me.glb", "me.svg"]);
    }
}

/// Without its `#`, what the empty page offers for copying is understood.
#[test]
fn what_the_empty_page_offers_are_strings() {
    let room = Room::new();
    ends(&room, &["new", "-q", "me", "-t", "empty"], 0, &[]);
    let drawing = fs::read_to_string(room.path("me.svg")).expect("text");
    let lines = drawing.split("<text").skip(1);
    let offers = lines.filter(|text| text.contains("id=\"string"));
    let offers: Vec<&str> = offers
        .filter_map(|text| Some(text.split_once(">#")?.1.split_once('<')?.0))
        .collect();
    assert!(offers.len() >= 10, "{offers:?}");
    for offer in offers {
        let taken = drawing.replace(&format!(">#{offer}<"), &format!(">{}<", offer.trim()));
        assert_ne!(taken, drawing);
        fs::write(room.path("me.svg"), taken).expect("written");
        let checked = run(&room, &["check", "-v", "me.svg"]);
        let report = String::from_utf8_lossy(&checked.stdout).into_owned();
        // There is no shape yet, so names are missing; but every word is one of the language.
        assert!(!report.contains("error[E1"), "{offer}: {report}");
    }
}

#[test]
fn the_list_says_what_there_is() {
    let room = Room::new();
    // A pipe gets no picture, whatever the terminal is.
    for terminal in ["dumb", "xterm-kitty"] {
        let mut command = room.command(&["new", "--list"]);
        let output = command.env("TERM", terminal).output().expect("it starts");
        assert_eq!(output.status.code(), Some(0));
        assert_eq!(output.stderr, b"");
        let list = String::from_utf8(output.stdout).expect("text");
        let names: Vec<&str> = list
            .lines()
            .filter_map(|line| line.split_whitespace().next())
            .collect();
        assert_eq!(names, STARTERS.map(|starter| starter.name));
        assert!(list.lines().all(|line| line.len() > 20), "{list}");
    }
    ends(&room, &["new", "--list", "me"], 2, &["cannot be used with"]);
    assert!(room.files().is_empty());
}

#[test]
fn names_choose_a_template() {
    let room = Room::new();
    for (former, now) in [("human", "girl"), ("car", "racing-car")] {
        let drawings = [former, now].map(|name| run(&room, &["new", "-", "-t", name]).stdout);
        assert!(!drawings[0].is_empty());
        assert_eq!(drawings[0], drawings[1], "{former}");
    }
    let written = |name: &str, more: &[&str]| {
        ends(&room, &[&["new", "-q", name], more].concat(), 0, &[]);
        let path = room.path(&format!("{name}.svg"));
        let drawing = fs::read(&path).expect("written");
        fs::remove_file(path).expect("removed");
        drawing
    };
    let girl = written("a", &["-t", "girl"]);
    assert_eq!(written("me", &[]), girl);
    assert_eq!(run(&room, &["new", "-"]).stdout, girl);
    // A drawing that is called like a template is that one, unless another is asked for.
    assert_eq!(written("robot", &[]), written("b", &["-t", "robot"]));
    assert_ne!(written("robot", &[]), girl);
    assert_eq!(written("robot", &["-t", "girl"]), girl);
}

#[test]
fn help_lists_all_templates() {
    let output = run(&Room::new(), &["new", "--help"]);
    let help = String::from_utf8_lossy(&output.stdout).into_owned();
    for word in STARTERS.map(|starter| starter.name) {
        assert!(help.contains(word), "{help}");
    }
    for former in ["also `human`", "also `car`"] {
        assert!(help.contains(former), "{help}");
    }
    ends(
        &Room::new(),
        &["new", "me", "--template", "boat"],
        2,
        &[
            "invalid value 'boat'",
            "[possible values: girl, boy, dog, dragon, robot, racing-car, island, turning, empty]",
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
        &["a value is required for '[NAME]'"],
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
    let output = run(&room, &["new", "-", "--template", "racing-car"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(output.stderr, b"");
    ends(
        &room,
        &["new", "-q", "me", "--template", "racing-car"],
        0,
        &[],
    );
    let written = fs::read(room.path("me.svg")).expect("written");
    assert_eq!(output.stdout, written);
}

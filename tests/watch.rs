//! `okoshi watch` with a real process and real files: saves of all kinds, and kills.
#![cfg(feature = "cli")]

mod common;

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::process::Command;
use std::thread::sleep;
use std::time::Duration;

use common::live::Live;

/// Before which moment of a build the program is killed, in microseconds after the save.
const LONGEST_BUILD: u64 = 60_000;

/// A drawing whose model depends on a number.
fn drawing(width: u32) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"400\" height=\"200\">\n\
         <rect x=\"20\" y=\"20\" width=\"{width}\" height=\"40\" fill=\"#cc0000\" id=\"body\"/>\n\
         <text x=\"50\" y=\"44\" font-size=\"5\">Body$Shape default -5 5</text>\n{}</svg>\n",
        format!("<!-- {} -->\n", "padding ".repeat(120)).repeat(10)
    )
}

/// A folder with a drawing that is watched.
fn watched(arguments: &[&str]) -> (tempfile::TempDir, Live) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a.svg"), drawing(50)).expect("written");
    let live = Live::start(folder.path(), &[&["watch"], arguments].concat());
    live.line("a.glb in");
    live.line("watching 1 drawing");
    (folder, live)
}

/// A folder with a drawing that is watched and another, whose builds tell that all earlier saves are done with.
fn watched_beside_another() -> (tempfile::TempDir, Live) {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["a.svg", "b.svg"] {
        fs::write(folder.path().join(name), drawing(50)).expect("written");
    }
    let live = Live::start(folder.path(), &["watch", "a.svg", "b.svg"]);
    live.lines(["a.glb in", "b.glb in", "watching 2 drawings"]);
    (folder, live)
}

/// What is said of the drawing until the other one is built after a save of it.
fn said_before_the_other(folder: &Path, live: &Live, save: u32) -> Vec<String> {
    fs::write(folder.join("b.svg"), drawing(save)).expect("written");
    let mut said = live.lines_to("b.glb in");
    said.retain(|line| line.contains("a.svg"));
    said
}

/// The width of the model, which is its largest extent, centimetres.
fn width(folder: &Path) -> u32 {
    let glb = fs::read(folder.join("a.glb")).expect("a model");
    let nodes = common::nodes(&glb).expect("a sound model");
    let body = nodes
        .iter()
        .find(|node| node.name == "Body")
        .expect("the part");
    let positions = || {
        body.primitives
            .iter()
            .flat_map(|primitive| &primitive.positions)
    };
    let extent = |axis: usize| {
        let along = || positions().map(|position| position[axis]);
        along().fold(f32::MIN, f32::max) - along().fold(f32::MAX, f32::min)
    };
    ((0..3).map(extent).fold(0.0, f32::max) * 100.0).round() as u32
}

/// Writes like Inkscape: truncates, then writes piece by piece, with a pause in which the file is incomplete.
fn in_pieces(path: &Path, text: &str) {
    let mut file = File::create(path).expect("created");
    for piece in text.as_bytes().chunks(4096) {
        file.write_all(piece).expect("written");
        sleep(Duration::from_millis(3));
    }
}

#[test]
fn every_save_is_built_once_however_it_is_made() {
    let (folder, live) = watched_beside_another();
    let path = folder.path().join("a.svg");
    let mut widths = vec![];
    for save in 0..40 {
        let now = 60 + save;
        match save % 4 {
            0 | 1 => in_pieces(&path, &drawing(now)),
            2 => {
                let text = fs::read_to_string(&path).expect("read");
                let before = format!("width=\"{}\" height=\"40\"", now - 1);
                let after = format!("width=\"{now}\" height=\"40\"");
                assert!(text.contains(&before));
                let status = Command::new("sed")
                    .args(["-i", &format!("s/{before}/{after}/")])
                    .arg(&path)
                    .status();
                assert!(status.expect("sed").success());
            }
            _ => {
                fs::remove_file(&path).expect("removed");
                fs::write(&path, drawing(now)).expect("written");
            }
        }
        live.line("a.glb in");
        widths.push(width(folder.path()));
    }
    assert_eq!(widths, (60..100).collect::<Vec<_>>());
    let more = said_before_the_other(folder.path(), &live, 51);
    assert_eq!(more, [""; 0]);
}

#[test]
fn a_save_that_changes_nothing_builds_nothing() {
    let (folder, live) = watched_beside_another();
    for save in 51..56 {
        in_pieces(&folder.path().join("a.svg"), &drawing(50));
        let said = said_before_the_other(folder.path(), &live, save);
        assert!(
            said.iter().all(|line| !line.contains("a.glb")),
            "it is built: {said:?}"
        );
    }
}

/// For how long it is no error, the tests in `src/watch` tell.
#[test]
fn a_cut_drawing_is_an_error_and_the_model_stays() {
    let (folder, live) = watched(&["a.svg"]);
    let path = folder.path().join("a.svg");
    let text = drawing(70);
    fs::write(&path, &text).expect("written");
    live.line("a.glb in");
    fs::write(&path, &text[..text.len() / 2]).expect("written");
    live.line("error[E001]");
    live.line("a.svg: 1 error, a.glb is unchanged");
    assert_eq!(width(folder.path()), 70);
    fs::remove_file(&path).expect("removed");
    live.line("a.svg: the file is gone; waiting for it");
    fs::write(&path, drawing(80)).expect("written");
    live.line("a.glb in");
    assert_eq!(width(folder.path()), 80);
}

/// Nor need their folders.
#[test]
fn linked_files_are_watched_before_they_exist() {
    let (folder, live) = watched(&["a.svg"]);
    for link in ["skin.png", "skins/red/skin.png"] {
        let linking = drawing(50).replace("-5 5<", &format!("-5 5 Texture \"{link}\"<"));
        fs::write(folder.path().join("a.svg"), linking).expect("written");
        live.line("error[E006]");
        live.line("a.glb is unchanged");
        let skin = folder.path().join(link);
        fs::create_dir_all(skin.parent().expect("a folder")).expect("a folder");
        let picture = |color: [u8; 3]| {
            let image = image::RgbImage::from_pixel(4, 4, image::Rgb(color));
            image.save(&skin).expect("a picture");
        };
        picture([255, 0, 0]);
        live.line("a.glb in");
        let red = fs::read(folder.path().join("a.glb")).expect("a model");
        picture([0, 255, 0]);
        live.line("a.glb in");
        assert_ne!(red, fs::read(folder.path().join("a.glb")).expect("a model"));
        fs::remove_file(&skin).expect("removed");
        live.line("error[E006]");
        live.line("a.glb is unchanged");
    }
}

/// A map of Tiled, its tile set and that one's picture.
#[test]
fn the_files_of_a_map_are_watched() {
    let (folder, live) = watched(&["a.svg"]);
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/terrain");
    let files = "harbour.tmx harbour.tsx harbour.png harbour-things.tsx harbour-things.png";
    for name in files.split(' ') {
        fs::copy(examples.join(name), folder.path().join(name)).expect("copied");
    }
    let linking = fs::read_to_string(examples.join("harbour.svg")).expect("a drawing");
    fs::write(folder.path().join("a.svg"), linking).expect("written");
    live.line("a.glb in");
    let model = || fs::read(folder.path().join("a.glb")).expect("a model");
    let mut before = model();
    for (name, old, new) in [
        ("harbour.tsx", "value=\"6\"", "value=\"7\""),
        ("harbour.tmx", "5,5,5,5,", "5,5,5,4,"),
        ("harbour.png", "", ""),
    ] {
        let path = folder.path().join(name);
        if old.is_empty() {
            let mut picture = image::open(&path).expect("a picture").into_rgba8();
            picture.pixels_mut().for_each(|pixel| pixel.0.swap(0, 2));
            picture.save(&path).expect("written");
        } else {
            let text = fs::read_to_string(&path).expect("a file");
            assert!(text.contains(old), "{name}");
            fs::write(&path, text.replacen(old, new, 1)).expect("written");
        }
        live.line("a.glb in");
        let after = model();
        assert_ne!(before, after, "{name}");
        before = after;
    }
}

#[test]
fn new_files_in_a_watched_folder_are_watched() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("in")).expect("a folder");
    let live = Live::start(folder.path(), &["watch", "in", "-o", "out"]);
    live.line("no drawings yet");
    fs::write(folder.path().join("in/one.svg"), drawing(50)).expect("written");
    live.line("one.glb in");
    fs::create_dir_all(folder.path().join("in/deep/er")).expect("a folder");
    fs::write(folder.path().join("in/deep/er/two.svg"), drawing(50)).expect("written");
    live.line("two.glb in");
    let built = folder.path().join("out");
    for glb in ["one.glb", "deep/er/two.glb"] {
        common::nodes(&fs::read(built.join(glb)).expect("there")).expect("a sound model");
    }
    assert!(!folder.path().join("in/one.glb").exists());
}

#[cfg(unix)]
#[test]
fn targets_of_links_are_watched() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("elsewhere")).expect("a folder");
    let target = folder.path().join("elsewhere/b.svg");
    fs::write(&target, drawing(50)).expect("written");
    std::os::unix::fs::symlink("elsewhere/b.svg", folder.path().join("a.svg")).expect("a link");
    let live = Live::start(folder.path(), &["watch", "a.svg"]);
    live.line("a.glb in");
    fs::write(&target, drawing(90)).expect("written");
    live.line("a.glb in");
    assert_eq!(width(folder.path()), 90);
}

#[test]
fn polling_notices_saves_too() {
    let (folder, live) = watched(&["a.svg", "--poll=30"]);
    for now in 60..65 {
        in_pieces(&folder.path().join("a.svg"), &drawing(now));
        live.line("a.glb in");
        assert_eq!(width(folder.path()), now);
    }
}

#[test]
fn paths_that_cannot_be_watched_are_errors_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let live = Live::start(folder.path(), &["watch", "nowhere.svg"]);
    live.line("error: `nowhere.svg` is not there; check the path");
}

#[test]
fn the_output_of_one_drawing_may_be_a_file_of_any_format() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a.svg"), drawing(50)).expect("written");
    for name in ["model.gltf", "model.obj", "model.GLB"] {
        let live = Live::start(folder.path(), &["watch", "a.svg", "-o", name]);
        live.line(&format!("{name} in"));
        let written = fs::read(folder.path().join(name)).expect("a file");
        match name {
            "model.gltf" => assert!(written.starts_with(b"{")),
            "model.obj" => assert!(written.starts_with(b"#")),
            _ => assert!(common::nodes(&written).is_ok()),
        }
    }
    assert!(!folder.path().join("a.glb").exists());
    fs::create_dir(folder.path().join("folder.glb")).expect("a folder");
    let live = Live::start(folder.path(), &["watch", "a.svg", "-o", "folder.glb"]);
    live.line("a.glb in");
    for (arguments, error) in [
        (
            &["watch", ".", "-o", "m.glb"][..],
            "error: `m.glb` is one file, and more than one drawing may be watched; name a folder",
        ),
        (
            &["watch", "a.svg", "a.svg", "-o", "m.glb"],
            "error: `m.glb` is one file",
        ),
        (
            &["watch", "a.svg", "-o", "b.svg"],
            "error: `b.svg` is a drawing, and okoshi never overwrites drawings",
        ),
        (
            &["watch", "a.svg", "-o", "-"],
            "error: a model that is written at every save needs a file or a folder",
        ),
    ] {
        Live::start(folder.path(), arguments).line(error);
    }
}

#[test]
fn a_kill_at_any_moment_leaves_a_sound_model() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.svg");
    let many = |shift: usize| {
        let circle = |index: usize| {
            format!(
                "<circle cx=\"{}\" cy=\"{}\" r=\"9\" fill=\"#00f\"/>\n",
                20 * (index % 20) + shift % 7,
                // Below the other shapes, so that each is a node of its own.
                400 + 20 * (index / 20)
            )
        };
        let circles: String = (0..200).map(circle).collect();
        drawing(50).replace("<text", &format!("{circles}<text"))
    };
    let mut random = fastrand::Rng::with_seed(12345);
    let (mut builds, mut saves) = (0, 0);
    for _ in 0..40 {
        let mut save = || {
            saves += 1;
            fs::write(&path, many(saves)).expect("written");
        };
        save();
        let live = Live::start(folder.path(), &["watch", "a.svg"]);
        for _ in 0..random.usize(1..=9) {
            live.line("a.glb in");
            builds += 1;
            save();
        }
        // Any moment of the next build.
        sleep(Duration::from_micros(random.u64(..LONGEST_BUILD)));
        live.kill();
        let glb = fs::read(folder.path().join("a.glb")).expect("a model");
        let nodes = common::nodes(&glb).expect("a sound model after a kill");
        assert_eq!(nodes.len(), 202);
    }
    assert!(builds >= 150, "only {builds} builds");
}

//! The program end to end: what it prints, writes and returns.
#![cfg(feature = "cli")]

mod common;

use std::fs;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};

use common::program::{BAD, Room, Run};
use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::Value;

const GOOD: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="200">
  <rect x="20" y="20" width="60" height="40" fill="#cc0000" id="body"/>
  <rect x="90" y="30" width="60" height="10" fill="#0000cc" id="arm"/>
  <text x="50" y="44" font-size="5">Body</text>
  <text x="120" y="39" font-size="5">Arm@Body$Shape roundv Bend 0</text>
</svg>
"##;

const HINT: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="200">
  <rect x="20" y="20" width="60" height="40" fill="#cc0000" id="body"/>
  <rect x="90" y="30" width="60" height="10" fill="#0000cc" id="arm"/>
  <text x="50" y="44" font-size="5">Body$Color red Color blue</text>
</svg>
"##;

fn names(glb: &[u8]) -> Vec<String> {
    let nodes = common::nodes(glb).expect("a model");
    nodes.into_iter().map(|node| node.name).collect()
}

#[test]
fn a_drawing_becomes_a_model_beside_it() {
    let room = Room::with("a.svg", GOOD);
    room.run(&["build", "a.svg"])
        .ends(0, "", "wrote a.glb: 2 parts, ");
    assert_eq!(room.files(), ["a.glb", "a.svg"]);
    assert_eq!(names(&room.read("a.glb")), ["Root", "Body", "Arm"]);
    assert_eq!(room.read("a.svg"), GOOD.as_bytes());
    let first = room.read("a.glb");
    room.run(&["build", "a.svg", "-o", "b.glb"])
        .ends(0, "", "wrote b.glb");
    assert_eq!(first, room.read("b.glb"), "the same bytes twice");
}

#[test]
fn a_gltf_holds_its_buffers() {
    let room = Room::with("a.svg", GOOD);
    room.run(&["build", "a.svg", "-o", "a.gltf"])
        .ends(0, "", "wrote a.gltf");
    let json: Value = serde_json::from_slice(&room.read("a.gltf")).expect("JSON");
    let buffers = json["buffers"].as_array().expect("buffers");
    assert_eq!(buffers.len(), 1);
    let uri = buffers[0]["uri"].as_str().expect("an address");
    assert!(
        uri.starts_with("data:application/octet-stream;base64,")
            || uri.starts_with("data:application/gltf-buffer;base64,"),
        "{}",
        &uri[..60]
    );
    gltf::Gltf::from_slice(&room.read("a.gltf")).expect("valid");
}

#[test]
fn a_skin_has_a_joint_per_part() {
    let room = Room::with("a.svg", GOOD);
    room.run(&["build", "a.svg", "--skin", "-q"])
        .ends(0, "", "");
    let model = gltf::Gltf::from_slice(&room.read("a.glb")).expect("a model");
    assert_eq!(model.meshes().count(), 1);
    let skin = model.skins().next().expect("a skin");
    let joints: Vec<&str> = skin.joints().filter_map(|joint| joint.name()).collect();
    assert_eq!(joints, ["Body", "Arm"]);
    let shown = model
        .nodes()
        .find(|node| node.skin().is_some())
        .expect("a node");
    assert_eq!(shown.name(), Some("Figure"));
}

#[test]
fn stdin_and_stdout() {
    let room = Room::with("a.svg", GOOD);
    room.run(&["build", "a.svg"]).ends(0, "", "wrote");
    let output = room.pipe(&["build", "-", "-o", "-"], GOOD.as_bytes());
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(
        output.stdout,
        room.read("a.glb"),
        "stdout carries the model and nothing else"
    );
    let run = Run::of(room.pipe(&["build", "-"], GOOD.as_bytes()));
    run.ends(
        2,
        "",
        "error: a drawing from stdin is in no folder: name the output with -o",
    );
    let run = Run::of(room.pipe(&["check", "-"], BAD.as_bytes()));
    run.ends(1, "<stdin>:3:42, at the top of the page: error[E101]: `Shap` is not a keyword; write `Shape`\n", "");
    let run = Run::of(room.pipe(&["inspect", "-"], GOOD.as_bytes()));
    let size = "\nmodel 0.4 m high, 1.3 m wide, 0.141 m deep\n";
    assert!(run.out.ends_with(size), "{}", run.out);
    run.ends(0, "└─ Body", "");
}

#[test]
fn nothing_is_written_on_errors() {
    let room = Room::with("bad.svg", BAD);
    room.run(&["build", "bad.svg"])
        .ends(1, "", "error[E101]: `Shap` is not a keyword");
    assert_eq!(room.files(), ["bad.svg"]);
    room.write("bad.glb", b"the last good one");
    let run = room.run(&["build", "bad.svg"]);
    run.ends(1, "", "nothing was written; `bad.glb` is unchanged\n");
    assert_eq!(room.read("bad.glb"), b"the last good one");
    assert_eq!(room.files(), ["bad.glb", "bad.svg"]);
    fs::remove_file(room.path("bad.glb")).expect("removed");
    room.run(&["build", "bad.svg", "--keep-going"]).ends(
        1,
        "",
        "wrote bad.glb: 1 part, 12 triangles, 0.4 m high, 0.6 m wide, 0.141 m deep\n",
    );
    assert_eq!(names(&room.read("bad.glb")), ["Root", "Body"]);
}

/// Files that are no drawings: name, bytes, exit status, and message.
const NO_DRAWINGS: &[(&str, &[u8], i32, &str)] = &[
    ("text.svg", b"hello", 1, "error[E001]: not well-formed XML"),
    (
        "cut.svg",
        b"<svg xmlns=\"http://www.w3.org/2000/svg\"><rect wid",
        1,
        "the file ends too early, as if it was cut off while it was saved: save it again",
    ),
    (
        "cut2.svg",
        b"<svg xmlns=\"http://www.w3.org/2000/svg\"><g>",
        1,
        "the file ends too early, as if it was cut off while it was saved: save it again",
    ),
    (
        "page.svg",
        b"<html/>",
        1,
        "error[E002]: the file is XML, but its root element is `html`, not `svg`",
    ),
    ("empty.svg", b"", 1, "error[E003]: the file is empty"),
    (
        "latin1.svg",
        b"<svg xmlns=\"http://www.w3.org/2000/svg\"><text>K\xf6rper$</text></svg>",
        1,
        "error[E004]",
    ),
    (
        "packed.svgz",
        b"\x1f\x8b\x08\x00broken",
        2,
        "`packed.svgz` is compressed, but damaged",
    ),
];

#[test]
fn files_that_are_no_drawings_are_refused() {
    for (name, bytes, status, message) in NO_DRAWINGS {
        let room = Room::with(name, bytes);
        room.run(&["build", name]).ends(*status, "", message);
        assert_eq!(room.files(), [*name], "nothing is written");
        let run = room.run(&["check", name]);
        assert_eq!(run.status, *status, "{name}");
        assert!(
            format!("{}{}", run.out, run.err).contains(message),
            "{name}: {}{}",
            run.out,
            run.err
        );
    }
}

#[test]
fn encodings() {
    let utf16 = |order: fn(u16) -> [u8; 2]| -> Vec<u8> {
        std::iter::once('\u{feff}')
            .chain(GOOD.chars())
            .flat_map(|c| order(c as u16))
            .collect()
    };
    for bytes in [utf16(u16::to_le_bytes), utf16(u16::to_be_bytes)] {
        let room = Room::with("a.svg", bytes);
        room.run(&["build", "a.svg"]).ends(1, "", "UTF-16");
        room.run(&["check", "a.svg"]).ends(1, "error[E004]", "");
        assert_eq!(room.files(), ["a.svg"]);
    }
    let room = Room::with("a.svg", format!("\u{feff}{GOOD}"));
    room.run(&["check", "a.svg"])
        .ends(0, "a.svg: no findings\n", "");
}

#[test]
fn files_of_other_kinds_in_place_of_drawings() {
    for (bytes, what, way) in [
        (
            &b"\x89PNG\r\n\x1A\n...."[..],
            "a PNG picture",
            "Path → Trace Bitmap",
        ),
        (
            b"\xFF\xD8\xFF\xE0....",
            "a JPEG picture",
            "Path → Trace Bitmap",
        ),
        (b"%PDF-1.7 ....", "a PDF", "open it in Inkscape"),
        (
            b"PK\x03\x04....",
            "a zip archive or an office document",
            "export it as SVG",
        ),
        (b"BLENDER-v300", "a Blender file", "Shape model"),
        (b"glTF\x02\0\0\0", "a glTF model", "Shape model"),
        (b"HIERARCHY\nROOT Hips", "a motion (BVH)", "%Motion"),
    ] {
        let room = Room::with("a.svg", bytes);
        for command in ["build", "check", "inspect"] {
            let expected = format!("error: `a.svg` is {what}, not a drawing: ");
            room.run(&[command, "a.svg"]).ends(2, "", &expected);
            room.run(&[command, "a.svg"]).ends(2, "", way);
        }
        assert_eq!(room.files(), ["a.svg"]);
    }
}

#[test]
fn a_drawing_in_the_place_of_a_command() {
    let room = Room::with("a b.svg", GOOD);
    room.run(&["a b.svg"])
        .ends(2, "", "did you mean `okoshi build \"a b.svg\"`?");
    room.run(&["gone.svg"])
        .ends(2, "", "did you mean `okoshi build gone.svg`?");
    fs::create_dir(room.path("drawings")).expect("made");
    room.run(&["drawings"])
        .ends(2, "", "did you mean `okoshi watch drawings`?");
    room.run(&["biuld"]).ends(2, "", "unrecognized subcommand");
}

#[test]
fn safe_fixes_are_applied() {
    let wrong = GOOD.replace("$Shape", "$Shpae").replace("<text", "<text  ");
    let room = Room::with("a.svg", wrong.replace('\n', "\r\n"));
    room.run(&["check", "--fix", "a.svg"])
        .ends(0, "a.svg: 1 finding fixed, nothing left\n", "");
    let right = wrong.replace("$Shpae", "$Shape").replace('\n', "\r\n");
    assert_eq!(room.read("a.svg"), right.as_bytes());
    // What is right is not written again.
    room.run(&["check", "--fix", "a.svg"])
        .ends(0, "a.svg: 0 findings fixed, nothing left\n", "");
    // Fixes that need a choice are left to people.
    let doubtful = GOOD.replace("@Body", "@Bdoy");
    room.write("b.svg", &doubtful);
    room.run(&["check", "--fix", "b.svg"])
        .ends(1, "b.svg: 0 findings fixed, 1 error", "");
    assert_eq!(room.read("b.svg"), doubtful.as_bytes());
    assert_eq!(room.files(), ["a.svg", "b.svg"]);
}

#[test]
fn packed_drawings() {
    let mut packed = GzEncoder::new(Vec::new(), Compression::default());
    packed.write_all(GOOD.as_bytes()).expect("packed");
    let room = Room::with("a.svgz", packed.finish().expect("packed"));
    room.run(&["build", "a.svgz"]).ends(0, "", "wrote a.glb");
    room.write("b.svg", GOOD);
    room.run(&["build", "b.svg"]).ends(0, "", "wrote b.glb");
    assert_eq!(room.read("a.glb"), room.read("b.glb"));
}

#[test]
fn files_that_cannot_be_read_or_written() {
    let room = Room::with("a.svg", GOOD);
    fs::create_dir(room.path("folder.svg")).expect("made");
    room.run(&["build", "gone.svg"])
        .ends(2, "", "error: `gone.svg` is not there; check the path");
    room.run(&["build", "folder.svg"]).ends(
        2,
        "",
        "error: `folder.svg` is a folder; name a drawing in it",
    );
    room.run(&["build", "b.svg"])
        .ends(2, "", "error: `b.svg` is not there; check the path");
    for near in ["A", "a", "a.SVG", "a.png"] {
        let expected = format!("error: `{near}` is not there; did you mean `a.svg`?");
        room.run(&["build", near]).ends(2, "", &expected);
    }
    room.run(&["build", "a.svg", "-o", "gone/a.glb"])
        .ends(2, "", "error: ");
    let formats = okoshi::export::extensions(|_| true);
    for output in ["a.doc", "out"] {
        room.run(&["build", "a.svg", "-o", output]).ends(
            2,
            "",
            &format!("error: the output `{output}` must end in {formats}"),
        );
    }
    room.run(&["build", "a.svg", "-o", "a.svg"])
        .ends(2, "", "okoshi never overwrites drawings");
    assert_eq!(room.read("a.svg"), GOOD.as_bytes());
    fs::create_dir(room.path("a.glb")).expect("made");
    room.run(&["build", "a.svg"]).ends(2, "", "error: ");
    assert_eq!(
        room.files(),
        ["a.glb", "a.svg", "folder.svg"],
        "no leavings"
    );
}

#[cfg(unix)]
#[test]
fn files_without_permission() {
    use std::os::unix::fs::PermissionsExt;
    let room = Room::with("a.svg", GOOD);
    room.write("shut/b.svg", GOOD);
    let mode = |name: &str, mode| {
        fs::set_permissions(room.path(name), fs::Permissions::from_mode(mode)).expect("permitted");
    };
    mode("a.svg", 0o000);
    mode("shut", 0o555);
    let denied = fs::read(room.path("a.svg")).is_err();
    if denied {
        room.run(&["build", "a.svg"]).ends(
            2,
            "",
            "error: `a.svg` cannot be read: permission denied; change its permissions",
        );
        room.run(&["build", "shut/b.svg"]).ends(2, "", "error: ");
        assert!(!room.path("shut/b.glb").exists());
    } else {
        // Root can read and write everything; then this test checks nothing.
        room.run(&["build", "a.svg"]).ends(0, "", "wrote");
    }
    mode("shut", 0o755);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_the_old_model() {
    let room = Room::with("a.svg", GOOD);
    let out = fs::OpenOptions::new()
        .write(true)
        .open("/dev/full")
        .expect("/dev/full");
    let run = room
        .command(&["build", "a.svg", "-o", "-"])
        .stdout(out)
        .output()
        .expect("it starts");
    assert_eq!(run.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&run.stderr).starts_with("error: "));
}

#[test]
fn several_drawings_at_once() {
    let room = Room::with("a.svg", GOOD);
    room.write("b.svg", GOOD.replace("Arm", "Bein"));
    room.write("c.svg", BAD);
    room.run(&["build", "a.svg", "b.svg", "-o", "x.glb"]).ends(
        2,
        "",
        "error: with several drawings, -o must name an existing folder",
    );
    fs::create_dir(room.path("out")).expect("made");
    let run = room.run(&["build", "a.svg", "c.svg", "b.svg", "-o", "out"]);
    let places: Vec<_> = ["wrote out/a.glb", "error[E101]", "wrote out/b.glb"]
        .map(|what| run.err.find(what))
        .into();
    assert!(
        places.iter().all(Option::is_some) && places.is_sorted(),
        "reported in the order given: {}",
        run.err
    );
    assert_eq!(run.status, 1);
    assert_eq!(names(&room.read("out/b.glb")), ["Root", "Body", "Bein"]);
    assert!(!room.path("out/c.glb").exists());
    room.run(&["check", "a.svg", "gone.svg"]).ends(
        2,
        "a.svg: no findings",
        "`gone.svg` is not there",
    );
    room.run(&["build", "a.svg", "b.svg", "--depfile", "d"])
        .ends(2, "", "--depfile goes with one drawing");
}

#[test]
fn two_drawings_never_write_one_file() {
    let room = Room::with("one/a.svg", GOOD);
    room.write("two/a.svg", GOOD.replace("Arm", "Bein"));
    fs::create_dir(room.path("out")).expect("made");
    let run = room.run(&["build", "one/a.svg", "two/a.svg", "-o", "out"]);
    run.ends(2, "", "error: ");
    assert!(!room.path("out/a.glb").exists());
}

#[test]
fn depfiles_are_escaped_for_make() {
    let picture =
        "<image x=\"10\" y=\"100\" width=\"50\" height=\"50\" href=\"my%20full.png\"/></svg>";
    let room = Room::with("my $drawing.svg", GOOD.replace("</svg>", picture));
    let png =
        fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/image-linked/full.png"));
    room.write("my full.png", png.expect("a picture"));
    room.run(&[
        "build",
        "my $drawing.svg",
        "-o",
        "the model.glb",
        "--depfile",
        "d.mk",
    ])
    .ends(0, "", "wrote the model.glb");
    let text = String::from_utf8(room.read("d.mk")).expect("text");
    assert_eq!(
        text,
        "the\\ model.glb: my\\ $$drawing.svg my\\ full.png\nmy\\ full.png:\n"
    );
}

#[test]
fn stats_report_what_was_built() {
    let room = Room::with("a.svg", GOOD);
    let run = room.run(&["build", "a.svg", "--stats"]);
    assert_eq!(run.out, "");
    for row in [
        "output  a.glb",
        "parts  2",
        "strings  2",
        "nodes  2",
        "meshes  2",
        "materials  2",
        "triangles  136",
    ] {
        assert!(run.err.contains(row), "{row} in\n{}", run.err);
    }
}

#[test]
fn quiet_and_verbose() {
    let room = Room::with("a.svg", HINT);
    room.run(&["build", "-q", "a.svg"]).ends(0, "", "");
    let usual = room.run(&["build", "a.svg"]);
    assert!(
        usual.err.contains("warning[W301]") && usual.err.contains("hint[H402]"),
        "{}",
        usual.err
    );
    room.write("bad.svg", BAD);
    let quiet = room.run(&["build", "-q", "bad.svg"]);
    assert!(
        quiet.err.contains("error[E101]") && !quiet.err.contains("nothing was written"),
        "{}",
        quiet.err
    );
    room.run(&["build", "-q", "-v", "a.svg"])
        .ends(2, "", "cannot be used with");
    // Many hints of a kind: the first has a line, and each its own lines of the drawing with `-v`.
    let many: String = (0..31)
        .map(|i| {
            let x = 40 * i;
            format!(
                "<rect x=\"{x}\" y=\"90\" width=\"9\" height=\"20\"/><text x=\"{x}\" y=\"105\" font-size=\"5\">P{i}＄</text>"
            )
        })
        .collect();
    room.write("many.svg", HINT.replace("</svg>", &format!("{many}</svg>")));
    let count = |run: Run, what: &str| run.err.matches(what).count();
    let usual = room.run(&["build", "many.svg"]);
    assert!(
        usual.err.contains(" hint[H405]: `＄` is read as `$`")
            && usual.err.contains(" (and 30 more in line 5)\n")
            && usual
                .err
                .contains("\n`okoshi check -v` shows all, each in its lines of the drawing\n"),
        "{}",
        usual.err
    );
    let lines = usual.err.lines().count();
    assert!(lines <= 22, "with what was written:\n{}", usual.err);
    assert_eq!(count(usual, "hint[H405]"), 1);
    let all = room.run(&["build", "-v", "many.svg"]);
    assert_eq!(count(all, "hint[H405]"), 31);
}

#[test]
fn colors() {
    let room = Room::with("bad.svg", BAD);
    let colored = |run: Run| format!("{}{}", run.out, run.err).contains('\x1b');
    assert!(
        !colored(room.run(&["check", "bad.svg"])),
        "no terminal, no colours"
    );
    assert!(colored(
        room.run(&["--color", "always", "check", "bad.svg"])
    ));
    assert!(colored(room.run(&["build", "--color=always", "bad.svg"])));
    assert!(!colored(
        room.run(&["--color", "never", "check", "bad.svg"])
    ));
    let output = room
        .command(&["check", "bad.svg", "--color", "always"])
        .env("NO_COLOR", "1")
        .output()
        .expect("it starts");
    assert!(
        colored(Run::of(output)),
        "what is said outright wins over NO_COLOR"
    );
    room.run(&["--color", "red", "check", "bad.svg"]).ends(
        2,
        "",
        "possible values: auto, always, never",
    );
}

#[test]
fn json_reports() {
    let room = Room::with("bad.svg", BAD);
    room.write("a.svg", HINT);
    let run = room.run(&["check", "--format", "json", "bad.svg", "a.svg"]);
    assert_eq!((run.status, run.err.as_str()), (1, ""));
    let json: Value = serde_json::from_str(&run.out).expect("JSON");
    let text = json.to_string();
    for code in ["E101", "W301", "H402"] {
        assert!(
            text.contains(&format!("\"{code}\"")),
            "{code} in {}",
            run.out
        );
    }
    let run = room.run(&["check", "--format", "sarif", "bad.svg", "a.svg"]);
    assert_eq!((run.status, run.err.as_str()), (1, ""));
    let sarif: Value = serde_json::from_str(&run.out).expect("SARIF");
    assert_eq!(sarif["version"], "2.1.0");
    let results = sarif["runs"][0]["results"].as_array().expect("results");
    let error = results
        .iter()
        .find(|result| result["ruleId"] == "E101")
        .expect("the error");
    assert_eq!(error["level"], "error");
    let place = &error["locations"][0]["physicalLocation"];
    assert_eq!(place["artifactLocation"]["uri"], "bad.svg");
    assert_eq!(place["region"]["startLine"], 3);
    assert_eq!(place["region"]["startColumn"], 42);
}

/// The JSON of `inspect`, name by name.
#[test]
fn inspect_as_json() {
    let legend = "<rect x=\"5\" y=\"180\" width=\"9\" height=\"9\" fill=\"#0000cc\" id=\"swatch\"/><text x=\"9\" y=\"186\" font-size=\"5\">$Metallic 1</text></svg>";
    let room = Room::with("a.svg", GOOD.replace("</svg>", legend));
    let run = room.run(&["inspect", "--json", "a.svg"]);
    assert_eq!(run.status, 0);
    let json: Value = serde_json::from_str(&run.out).expect("JSON");
    assert_eq!(json["drawing"], "a.svg");
    for list in ["terrain", "billboards", "clips"] {
        assert_eq!(json[list], serde_json::json!([]), "{list}");
    }
    let parts = json["parts"].as_array().expect("parts");
    let names: Vec<_> = parts
        .iter()
        .map(|part| part["name"].as_str().expect("a name"))
        .collect();
    assert_eq!(names, ["Body", "Arm", "swatch"]);
    assert_eq!(parts[0]["parent"], Value::Null);
    assert_eq!(parts[2]["kind"], "legend");
    let expected = serde_json::json!({
        "name": "Arm", "named_by": "string", "parent": "Body", "kind": "main", "element": "arm",
        "string": { "line": 5, "column": 38, "text": "Arm@Body$Shape roundv Bend 0", "bound_by": "nearest" },
        "center": [120.0, 35.0], "ends": [[150.0, 35.0], [90.0, 35.0]], "origin": [90.0, 35.0], "axis": [1.0, 0.0], "depth": 0.0,
        "attributes": {
            "Bend": { "value": "0", "from": "own" },
            "Color": { "value": "0 0 0.8", "from": "builtin" },
            "Metallic": { "value": "1", "from": "legend" },
            "Shape": { "value": "roundv", "from": "own" },
        },
        "joint": null, "joint_why": null,
    });
    assert_eq!(parts[1], expected);
    room.write("bad.svg", BAD);
    let run = room.run(&["inspect", "--json", "bad.svg"]);
    serde_json::from_str::<Value>(&run.out).expect("stdout carries JSON alone");
    assert_eq!(run.status, 1);
    assert!(run.err.contains("error[E101]"), "{}", run.err);
}

#[test]
fn the_manual() {
    let room = Room::new();
    room.run(&["explain"]).ends(0, "Shape", "");
    room.run(&["explain", "shape"]).ends(0, "Shape", "");
    room.run(&["explain", "roundv"]).ends(0, "a0 a1", "");
    room.run(&["explain", "e204"]).ends(0, "E204", "");
    room.run(&["explain", "Shap"]).ends(
        2,
        "",
        "there is no page on `Shap`: did you mean `Shape`? `okoshi explain` lists them all",
    );
    room.run(&["explain", "E999"])
        .ends(2, "", "there is no page on `E999`");
    // Codes of a report can be looked up.
    for code in okoshi::diagnostic::Code::ALL {
        room.run(&["explain", code.id()]).ends(0, code.title(), "");
    }
    for keyword in okoshi::internals::lang::keyword::Keyword::built() {
        room.run(&["explain", keyword.name()])
            .ends(0, keyword.name(), "");
    }
    // So can the words of people who do not know the keywords.
    room.run(&["explain", "elbow"])
        .ends(0, "# Joint\n\nA part turns where", "");
    room.run(&["explain", "Walk"]).ends(0, "%Motion walk", "");
}

#[test]
fn completions() {
    let room = Room::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let run = room.run(&["completions", shell]);
        assert_eq!((run.status, run.err.as_str()), (0, ""));
        for command in ["build", "check", "inspect", "explain", "keep-going"] {
            assert!(run.out.contains(command), "{shell}: {command}");
        }
    }
    let script = room.run(&["completions", "bash"]).out;
    room.write("okoshi.bash", script);
    let bash = Command::new("bash")
        .args(["-n", "okoshi.bash"])
        .current_dir(room.path(""))
        .output();
    if let Ok(bash) = bash {
        assert!(
            bash.status.success(),
            "bash reads it: {}",
            String::from_utf8_lossy(&bash.stderr)
        );
    }
    room.run(&["completions", "tcsh"])
        .ends(2, "", "possible values");
}

#[test]
fn help_describes_every_command() {
    let room = Room::new();
    for topic in [
        "okoshi build human.svg",
        "`Rarm@Ubody$Shape roundv`",
        "okoshi explain",
    ] {
        room.run(&["--help"]).ends(0, topic, "");
    }
    for command in [
        "new",
        "build",
        "check",
        "inspect",
        "explain",
        "man",
        "completions",
    ] {
        room.run(&["--help"]).ends(0, command, "");
        room.run(&[command, "--help"]).ends(0, "Usage: okoshi ", "");
    }
    room.run(&["--version"])
        .ends(0, env!("CARGO_PKG_VERSION"), "");
    room.run(&[]).ends(2, "", "Usage: okoshi");
    room.run(&["bild", "a.svg"]).ends(2, "", "build");
    room.run(&["build"]).ends(2, "", "<DRAWING>");
    room.run(&["build", "--tolerance", "2", "a.svg"]).ends(
        2,
        "",
        "expected a number from 0.000001 to 0.1",
    );
}

/// A reader that closes the pipe early, like `head -1`, is no failure.
#[test]
fn a_broken_pipe_does_not_panic() {
    let many: String = (0..3000)
        .map(|i| format!("<rect x=\"{i}\" y=\"90\" width=\"9\" height=\"9\"/>"))
        .collect();
    let room = Room::with("many.svg", HINT.replace("</svg>", &format!("{many}</svg>")));
    for (arguments, status) in [
        (&["inspect", "many.svg"][..], 0),
        (&["inspect", "--json", "many.svg"], 0),
        (&["check", "-v", "many.svg"], 0),
        // A truncated model is an error.
        (&["build", "many.svg", "-o", "-"], 2),
    ] {
        let mut child = room
            .command(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("it starts");
        let mut first = [0; 16];
        let mut out = child.stdout.take().expect("stdout");
        let mut err = child.stderr.take().expect("stderr");
        out.read_exact(&mut first).expect("it begins");
        drop(out);
        let mut told = String::new();
        err.read_to_string(&mut told).expect("text");
        let ended = child.wait().expect("it ends").code();
        assert_eq!(ended, Some(status), "{arguments:?}: {told}");
        assert!(!told.contains("panicked"), "{told}");
    }
}

#[test]
fn links_are_followed_in_the_folder_of_the_drawing() {
    let png =
        fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/image-linked/full.png"))
            .expect("a picture");
    let drawing = |link: &str| {
        GOOD.replace(
            "</svg>",
            &format!(
                "<image x=\"10\" y=\"100\" width=\"50\" height=\"50\" href=\"{link}\"/></svg>"
            ),
        )
    };
    let room = Room::with("in/a.svg", drawing("full.png"));
    room.write("in/full.png", &png);
    room.write("full.png", &png);
    room.run(&["build", "in/a.svg"])
        .ends(0, "", "wrote in/a.glb: 3 parts");
    room.write("in/b.svg", drawing("../full.png"));
    room.run(&["build", "in/b.svg"]).ends(
        1,
        "",
        "error[E007]: the link `../full.png` is outside the drawing's folder",
    );
    room.write("in/c.svg", drawing("full.png"));
    fs::remove_file(room.path("in/full.png")).expect("removed");
    room.run(&["build", "in/c.svg"])
        .ends(1, "", "error[E006]: the link `full.png` is not there");
    room.run(&["build", "in/c.svg", "--base", "."])
        .ends(0, "", "wrote in/c.glb");
    // `--root` allows more places, and links start where they did.
    room.run(&["build", "in/b.svg", "--root", "."])
        .ends(0, "", "wrote in/b.glb");
    room.run(&["build", "in/c.svg", "--root", "."]).ends(
        1,
        "",
        "error[E006]: the link `full.png` is not there",
    );
    room.write("in/full.png", &png);
    room.run(&["build", "in/c.svg", "--root", "."])
        .ends(0, "", "wrote in/c.glb");
    room.write("in/d.svg", drawing("../../full.png"));
    room.run(&["build", "in/d.svg", "--root", "."]).ends(
        1,
        "",
        "error[E007]: the link `../../full.png` is outside the drawing's folder",
    );
}

/// A motion of two joints, in two frames.
const MOTION: &str = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n\
    JOINT Spine\n{\nOFFSET 0 10 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 10 0\n}\n}\n}\n\
    MOTION\nFrames: 2\nFrame Time: 0.04\n0 0 0 0 0 0 0 0 0\n0 1 0 0 0 0 0 0 9\n";

#[test]
fn nothing_that_is_read_is_replaced() {
    let photo = GOOD.replace(
        "</svg>",
        "<image width=\"9\" height=\"9\" href=\"cat.png\"/></svg>",
    );
    let room = Room::with("cat.svg", &photo);
    let mut png = std::io::Cursor::new(Vec::new());
    let gradient =
        image::RgbImage::from_fn(4, 4, |x, y| image::Rgb([40 * x as u8, 40 * y as u8, 0]));
    gradient
        .write_to(&mut png, image::ImageFormat::Png)
        .expect("a picture");
    let png = png.into_inner();
    room.write("cat.png", &png);
    let lost = |run: Run, what: &str, other: &str| {
        run.ends(
            2,
            "",
            &format!("{what}, which would be lost; choose another name, `{other}` for example"),
        );
    };
    lost(
        room.run(&["render", "cat.svg", "--size", "8x8"]),
        "`cat.png` is linked by what is read",
        "cat-2.png",
    );
    lost(
        room.run(&["render", "cat.svg", "-o", "./cat.png"]),
        "`./cat.png` is linked by what is read",
        "./cat-2.png",
    );
    assert_eq!(room.read("cat.png"), png);

    // A model that the drawing takes in.
    room.write("part.svg", GOOD);
    room.run(&["build", "part.svg", "-o", "car.glb", "-q"])
        .ends(0, "", "");
    let model = room.read("car.glb");
    let car = GOOD.replace("Shape roundv", "Shape model \"car.glb\"");
    room.write("car.svg", &car);
    lost(
        room.run(&["build", "car.svg"]),
        "`car.glb` is linked by what is read",
        "car-2.glb",
    );
    assert_eq!(room.read("car.glb"), model);
    room.run(&["build", "car.svg", "-o", "car-2.glb"])
        .ends(0, "", "wrote car-2.glb");

    for (file, what) in [
        ("car.svg", "is the file that is read"),
        ("car.glb", "is linked by what is read"),
        ("out.glb", "is another output"),
    ] {
        let run = room.run(&["build", "car.svg", "-o", "out.glb", "--depfile", file]);
        run.ends(2, "", &format!("`{file}` {what}, which would be lost"));
    }
    assert_eq!(room.read("car.svg"), car.as_bytes());

    room.write("kick.bvh", MOTION);
    room.write("kick.svg", GOOD);
    lost(
        room.run(&["motion", "kick.bvh", "-o", "kick.svg"]),
        "`kick.svg` is a drawing",
        "kick-2.svg",
    );
    lost(
        room.run(&["motion", "kick.bvh", "-o", "kick.bvh"]),
        "`kick.bvh` is the file that is read",
        "kick-2.bvh",
    );
    assert_eq!(room.read("kick.svg"), GOOD.as_bytes());
    for _ in 0..2 {
        room.run(&["motion", "kick.bvh", "-o", "chart.svg"])
            .ends(0, "", "wrote chart.svg");
    }
    lost(
        room.run(&[
            "motion",
            "kick.bvh",
            "-o",
            "chart.svg",
            "--plot",
            "chart.svg",
        ]),
        "`chart.svg` is another output",
        "chart-2.svg",
    );
}

#[cfg(unix)]
#[test]
fn an_output_that_links_to_the_drawing_does_not_replace_it() {
    let room = Room::with("a.svg", GOOD);
    std::os::unix::fs::symlink("a.svg", room.path("soft.glb")).expect("linked");
    fs::hard_link(room.path("a.svg"), room.path("hard.glb")).expect("linked");
    for output in ["soft.glb", "hard.glb"] {
        let run = room.run(&["build", "a.svg", "-o", output]);
        run.ends(
            2,
            "",
            &format!("`{output}` is the file that is read, which would be lost"),
        );
    }
    assert_eq!(room.read("a.svg"), GOOD.as_bytes());
}

#[test]
fn files_of_other_programs_are_replaced_only_when_they_are_named() {
    let room = Room::with("a.svg", GOOD);
    room.write("a.glb", b"a model that took a week");
    room.write("a.png", b"a photo");
    for command in [
        &["build", "a.svg"][..],
        &["render", "a.svg", "--size", "8x8"],
    ] {
        let run = room.run(command);
        run.ends(
            2,
            "",
            "was not written by okoshi; rename it, or choose another name with -o, `a-2.",
        );
    }
    assert_eq!(room.read("a.glb"), b"a model that took a week");
    assert_eq!(room.read("a.png"), b"a photo");
    room.run(&["build", "a.svg", "-o", "a.glb", "-q"])
        .ends(0, "", "");
    room.run(&["render", "a.svg", "-o", "a.png", "--size", "8x8", "-q"])
        .ends(0, "", "");
    // What okoshi wrote may be replaced.
    room.run(&["build", "a.svg", "-q"]).ends(0, "", "");
    room.run(&["render", "a.svg", "--size", "8x8", "-q"])
        .ends(0, "", "");
}

#[test]
fn check_says_how_models_look() {
    let room = Room::with("a.svg", GOOD);
    let share = "a.svg: 100.0 % of the drawing's pixels show the right colour from the front\n";
    room.run(&["check", "--look", "a.svg"]).ends(0, share, "");
    let hidden = GOOD
        .replace("x=\"90\"", "x=\"20\"")
        .replace("Shape roundv", "Offset -90")
        .replace("x=\"120\" y=\"39\"", "x=\"40\" y=\"36\"");
    room.write("hidden.svg", hidden);
    room.run(&["check", "--look", "hidden.svg"]).ends(
        0,
        "hint[H411]: `Arm` shows 0 % of what is drawn of it: it is inside or behind `Body`, which is drawn before it",
        "",
    );
    let run = room.run(&["check", "--look", "--format", "json", "hidden.svg", "a.svg"]);
    let json: Value = serde_json::from_str(&run.out).expect("JSON");
    assert_eq!(json["drawings"][1]["look"]["right"], 1.0);
    let right = json["drawings"][0]["look"]["right"]
        .as_f64()
        .expect("a number");
    assert!((0.5..0.9).contains(&right), "{right}");
    room.write("bad.svg", BAD);
    room.run(&["check", "--look", "bad.svg"])
        .ends(1, "error[E101]", "");
    let run = room.run(&["check", "--look", "--format", "sarif", "hidden.svg"]);
    run.ends(0, "H411", "");
}

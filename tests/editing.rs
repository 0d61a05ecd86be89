//! Changes that a page makes of a drawing: what reaches the file, what is refused, and that nothing of others is lost.
#![cfg(feature = "cli")]

mod common;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::time::Duration;

use common::live::Live;
use common::pages::{Socket, asked, changed_meshes, got, heard, page, served};
use common::patience::wait_until;
use serde_json::{Value, json};

const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="200">
  <rect x="20" y="20" width="60" height="40" fill="#cc0000" id="body"/>
  <rect x="80" y="30" width="60" height="10" fill="#00aa00" id="arm"/>
  <text x="50" y="44" font-size="5">Body$Shape default -5 5</text>
  <text x="110" y="37" font-size="5">Arm@Body$Shape roundv</text>
</svg>
"##;

/// A drawing that a page shows, and may change.
struct Edited {
    folder: tempfile::TempDir,
    _live: Live,
    port: u16,
    page: Socket,
    key: String,
    revision: u64,
}

impl Edited {
    fn new(text: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("a.svg"), text).expect("written");
        Self::of(folder, "a.svg")
    }

    fn of(folder: tempfile::TempDir, target: &str) -> Self {
        let (live, port) = served(folder.path(), target);
        let mut page = page(port);
        let key = heard(&mut page, "editing")["key"]
            .as_str()
            .map(str::to_owned);
        let mut edited = Self {
            folder,
            _live: live,
            port,
            page,
            key: key.expect("a key"),
            revision: 0,
        };
        edited.build();
        edited
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("a.svg")
    }

    fn text(&self) -> String {
        fs::read_to_string(self.path()).expect("read")
    }

    /// The next build.
    fn build(&mut self) -> Value {
        let build = heard(&mut self.page, "build");
        self.revision = build["build"]["revision"].as_u64().expect("a revision");
        build
    }

    fn post(&self, path: &str, body: &Value) -> (u16, Value) {
        sent(self.port, path, &self.key, &body.to_string())
    }

    fn does(&self, what: &Value) -> (u16, Value) {
        let body = json!({"drawing": "a.svg", "revision": self.revision, "do": what});
        self.post("/changes", &body)
    }

    fn makes(&self, change: &Value) -> (u16, Value) {
        self.does(&json!({"make": change}))
    }
}

/// The answer to a request of the page.
fn sent(port: u16, path: &str, key: &str, body: &str) -> (u16, Value) {
    raw(
        port,
        path,
        &format!(
            "Origin: http://127.0.0.1:PORT\nContent-Type: application/json\nokoshi-key: {key}\n"
        ),
        body,
    )
}

fn raw(port: u16, path: &str, headers: &str, body: &str) -> (u16, Value) {
    let request = format!(
        "POST {path} HTTP/1.1\nHost: 127.0.0.1:PORT\nConnection: close\n{headers}Content-Length: {}\n\n{body}",
        body.len()
    );
    let (status, answer) = asked(port, &request);
    (
        status,
        serde_json::from_slice(&answer).unwrap_or(Value::Null),
    )
}

fn thickness(value: &str) -> Value {
    json!({"change": "set", "part": "Body", "attribute": "Shape", "value": value})
}

fn why(answer: &Value) -> &str {
    answer["why"].as_str().unwrap_or_default()
}

#[test]
fn a_change_reaches_the_file_and_is_undone() {
    let mut edited = Edited::new(DRAWING);
    assert_eq!(edited.makes(&thickness("default -9 9")).0, 200);
    let thick = DRAWING.replace("-5 5", "-9 9");
    assert_eq!(edited.text(), thick);
    let steps = heard(&mut edited.page, "steps");
    assert_eq!(steps["undo"], "Shape of Body");
    assert_eq!(steps["redo"], Value::Null);
    let build = edited.build();
    assert_eq!(build["build"]["findings"], json!([]));

    let renamed = json!({"change": "name", "part": "Body", "name": "Trunk"});
    assert_eq!(edited.makes(&renamed).0, 200);
    assert_eq!(edited.text(), thick.replace("Body", "Trunk"));
    for (what, text) in [
        ("undo", thick.as_str()),
        ("undo", DRAWING),
        ("redo", &thick),
        ("undo", DRAWING),
    ] {
        assert_eq!(edited.does(&json!(what)).0, 200, "{what}");
        assert_eq!(edited.text(), text, "{what}");
    }
    let (status, answer) = edited.does(&json!("undo"));
    assert_eq!((status, why(&answer)), (409, "there is nothing to undo"));
}

#[test]
fn a_refusal_says_why_and_what_else_could_be_done() {
    let edited = Edited::new(DRAWING);
    let (status, answer) = edited.makes(&json!({"change": "leave-out", "part": "Body"}));
    assert_eq!(status, 409);
    assert_eq!(
        why(&answer),
        "`Arm` hangs on `Body`: hang it elsewhere first"
    );
    let choice = &answer["choices"][0];
    assert_eq!(choice["title"], "Hang `Arm` on nothing");
    assert_eq!(edited.makes(&choice["change"]).0, 200);
    assert_eq!(edited.text(), DRAWING.replace("Arm@Body", "Arm@Root"));
    for (change, said) in [
        (thickness("defalt 3"), "defalt"),
        (thickness("default -9"), "too few"),
        (
            json!({"change": "name", "part": "Arm", "name": "Body"}),
            "Body",
        ),
        (
            json!({"change": "hang", "part": "Gone", "parent": null}),
            "Gone",
        ),
        (
            json!({"change": "hang", "part": "Arm", "parent": "Gone"}),
            "Gone",
        ),
        (
            json!({"change": "variable", "name": "w", "value": 3}),
            "`w`",
        ),
    ] {
        let before = edited.text();
        let (status, answer) = edited.makes(&change);
        assert_eq!(status, 409, "{change}");
        assert!(why(&answer).contains(said), "{change}: {answer}");
        assert_eq!(edited.text(), before, "{change}");
    }
}

#[test]
fn the_form_of_a_part_has_its_values_and_where_they_come_from() {
    let text = DRAWING.replace(
        "</svg>",
        "  <text x=\"5\" y=\"190\" font-size=\"5\">%Smooth 60</text>\n</svg>",
    );
    let edited = Edited::new(&text);
    let (status, form) = edited.post("/forms", &json!({"drawing": "a.svg", "part": "Arm"}));
    assert_eq!(status, 200, "{form}");
    assert_eq!(form["parent"], "Body");
    assert_eq!(form["parents"], json!(["Body"]));
    let field = |name: &str| {
        let fields = form["fields"].as_array().expect("fields");
        let found = fields.iter().find(|field| field["attribute"] == name);
        found.unwrap_or_else(|| panic!("no {name}")).clone()
    };
    let shape = field("Shape");
    assert_eq!(
        (&shape["value"], &shape["from"]),
        (&json!("roundv"), &json!("own"))
    );
    let chosen = &shape["variants"][shape["chosen"].as_u64().expect("one") as usize];
    assert_eq!(chosen["word"], "roundv");
    let angle = &chosen["arguments"][1]["takes"];
    assert_eq!(angle["type"], "number");
    assert_eq!(
        [&angle["low"], &angle["high"], &angle["start"]],
        [-90., 90., 90.].map(|n| json!(n)).each_ref()
    );
    assert_eq!(field("Smooth")["from"], "default");
    assert_eq!(
        field("Alpha")["variants"][0]["arguments"][0]["takes"]["start"],
        1.0
    );
    let (status, answer) = edited.post("/forms", &json!({"drawing": "a.svg", "part": "Leg"}));
    assert_eq!((status, why(&answer)), (409, "there is no part `Leg`"));
}

#[test]
fn requests_of_others_are_refused() {
    let edited = Edited::new(DRAWING);
    let body = json!({"drawing": "a.svg", "revision": edited.revision, "do": {"make": thickness("default -9 9")}});
    let body = body.to_string();
    let (port, key) = (edited.port, &edited.key);
    let own = "Origin: http://127.0.0.1:PORT\n";
    let kind = "Content-Type: application/json\n";
    let keyed = format!("okoshi-key: {key}\n");
    let status = |path: &str, headers: &str, body: &str| raw(port, path, headers, body).0;
    for path in ["/changes", "/tries", "/forms"] {
        assert_eq!(status(path, &format!("{own}{kind}"), &body), 403, "no key");
        for wrong in [
            "",
            "0",
            &key[1..],
            &format!("{key}0"),
            &"0".repeat(key.len()),
        ] {
            let headers = format!("{own}{kind}okoshi-key: {wrong}\n");
            assert_eq!(status(path, &headers, &body), 403, "{wrong}");
        }
        let twice = format!("{own}{kind}{keyed}{keyed}");
        assert_eq!(status(path, &twice, &body), 403, "two keys");
        assert_eq!(
            status(path, &format!("{kind}{keyed}"), &body),
            403,
            "no origin"
        );
        for origin in [
            "null",
            "http://evil.example",
            "http://127.0.0.1:1",
            "https://127.0.0.1:PORT",
        ] {
            let headers = format!("Origin: {origin}\n{kind}{keyed}");
            assert_eq!(status(path, &headers, &body), 403, "{origin}");
        }
        let cross = format!("{own}{kind}{keyed}Sec-Fetch-Site: cross-site\n");
        assert_eq!(status(path, &cross, &body), 403);
        for other in [
            "text/plain",
            "application/x-www-form-urlencoded",
            "multipart/form-data",
        ] {
            let headers = format!("{own}Content-Type: {other}\n{keyed}");
            assert_eq!(status(path, &headers, &body), 415, "{other}");
        }
        for wrong in [
            "",
            "{",
            "[]",
            "null",
            "\u{0}",
            &"[".repeat(60_000),
            r#"{"drawing":"a.svg"}"#,
        ] {
            assert_eq!(sent(port, path, key, wrong).0, 400, "{wrong:.20}");
        }
        let long = format!("{}{body}", " ".repeat(1 << 20));
        assert_eq!(sent(port, path, key, &long).0, 413);
        let announced = format!(
            "POST {path} HTTP/1.1\nHost: 127.0.0.1:PORT\n{own}{kind}{keyed}Content-Length: 99999999999\nConnection: close\n\n{{"
        );
        assert_eq!(asked(port, &announced).0, 413, "an announced length");
        let get =
            format!("GET {path} HTTP/1.1\nHost: 127.0.0.1:PORT\nConnection: close\n{keyed}\n");
        assert_eq!(asked(port, &get).0, 405);
    }
    for drawing in ["", "b.svg", "../a.svg", "/etc/passwd", "./a.svg", "A.svg"] {
        let body = body.replace("a.svg", drawing);
        let (status, answer) = sent(port, "/changes", key, &body);
        assert_eq!(status, 409, "{drawing}");
        assert!(why(&answer).contains("is not open here"), "{answer}");
    }
    for wrong in [
        json!({"change": "set", "part": "Body", "attribute": "Nonsense", "value": "1"}),
        json!({"change": "vanish", "part": "Body"}),
        json!({"change": "name", "part": "Body"}),
        json!({"change": "name", "part": "Body", "name": "X", "more": 1}),
    ] {
        assert_eq!(edited.makes(&wrong).0, 400, "{wrong}");
    }
    assert_eq!(edited.text(), DRAWING);
    // What is no mistake in the request may be one in the drawing.
    for wrong in [
        "default -9 9 $Color red",
        "default -9 9</text><script/>",
        "default\n-9 9",
        "\u{202e}",
        "",
    ] {
        assert_eq!(edited.makes(&thickness(wrong)).0, 409, "{wrong}");
    }
    assert_eq!(edited.text(), DRAWING);
}

#[test]
fn what_is_tried_is_seen_by_nobody_else() {
    let mut edited = Edited::new(DRAWING);
    let tries = |edited: &Edited, change: &Value| {
        let body = json!({
            "drawing": "a.svg", "revision": edited.revision, "change": change, "shows": "builds/1.glb",
        });
        let key = &edited.key;
        let headers = format!(
            "Host: 127.0.0.1:PORT\nOrigin: http://127.0.0.1:PORT\nContent-Type: application/json\nokoshi-key: {key}\nConnection: close"
        );
        let body = body.to_string();
        let length = body.len();
        let request =
            format!("POST /tries HTTP/1.1\n{headers}\nContent-Length: {length}\n\n{body}");
        asked(edited.port, &request)
    };
    let (status, thick) = tries(&edited, &thickness("default -9 9"));
    assert_eq!((status, changed_meshes(&thick)), (200, 1));
    assert_eq!(edited.text(), DRAWING);
    let served = |edited: &Edited| {
        let models = (1..30).map(|number| got(edited.port, &format!("/builds/{number}.glb")));
        let models: Vec<Vec<u8>> = models
            .filter(|(status, _)| *status == 200)
            .map(|(_, bytes)| bytes)
            .collect();
        models
    };
    let [real] = served(&edited)
        .try_into()
        .expect("only the drawing's own model is served");
    assert_eq!(got(edited.port, "/tries/2.glb").0, 404);

    // What would be refused shows nothing, and says nothing yet.
    let nothing = json!({"change": "hang", "part": "Body", "parent": "Arm"});
    assert_eq!(tries(&edited, &nothing), (204, vec![]));
    // There is nothing to undo, and no build: the next one is that of a save.
    assert_eq!(
        why(&edited.does(&json!("undo")).1),
        "there is nothing to undo"
    );
    let saved = DRAWING.replace("#cc0000", "#0000cc");
    fs::write(edited.path(), &saved).expect("written");
    let revision = edited.revision;
    edited.build();
    assert_eq!(edited.revision, revision + 1);
    // What is tried next is tried with what was saved, and the save stays.
    let (_, tried) = tries(&edited, &thickness("default -9 9"));
    assert_eq!(edited.text(), saved);
    assert!(tried != thick && served(&edited).iter().any(|model| *model != real));
    assert_eq!(edited.makes(&thickness("default -9 9")).0, 200);
    assert_eq!(edited.text(), saved.replace("-5 5", "-9 9"));
}

#[test]
fn read_only_takes_all_of_it_away() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a.svg"), DRAWING).expect("written");
    let live = Live::start(folder.path(), &["preview", "a.svg", "--read-only"]);
    let port = common::pages::port_of(&live);
    let mut shown = page(port);
    // The key would come before the list.
    let first = common::pages::next(&mut shown);
    assert_eq!(first["type"], "drawings");
    for path in ["/changes", "/tries", "/forms"] {
        let (status, answer) = sent(port, path, "", "{}");
        assert_eq!((status, why(&answer)), (405, "this page is read-only"));
    }
    let empty = tempfile::tempdir().expect("a folder");
    let live = Live::start(empty.path(), &["preview", ".", "--read-only"]);
    let mut shown = page(common::pages::port_of(&live));
    assert_eq!(common::pages::next(&mut shown)["type"], "drawings");
    fs::write(empty.path().join("a.svg"), DRAWING).expect("written");
    // Starters would have been offered before.
    assert_eq!(common::pages::next(&mut shown)["type"], "drawings");
}

#[test]
fn of_a_drawing_that_is_open_elsewhere_the_copy_is_changed() {
    let folder = tempfile::tempdir().expect("a folder");
    let elsewhere = tempfile::tempdir().expect("a folder");
    let copy = elsewhere.path().join("canvas.svg");
    let canvas = DRAWING.replace("-5 5", "-7 7");
    fs::write(folder.path().join("a.svg"), DRAWING).expect("written");
    fs::write(&copy, &canvas).expect("written");
    let copied = copy.to_str().expect("UTF-8");
    let live = Live::start(folder.path(), &["preview", "a.svg", "--unsaved", copied]);
    let port = common::pages::port_of(&live);
    let mut shown = page(port);
    let editing = heard(&mut shown, "editing");
    assert_eq!(editing["copy"], true);
    let key = editing["key"].as_str().expect("a key");
    let build = heard(&mut shown, "build");
    let does = |what: Value| {
        let revision = &build["build"]["revision"];
        let body = json!({"drawing": "a.svg", "revision": revision, "do": what});
        sent(port, "/changes", key, &body.to_string())
    };
    assert_eq!(does(json!({"make": thickness("default -9 9")})).0, 200);
    let text = |path: &Path| fs::read_to_string(path).expect("read");
    assert_eq!(text(&copy), canvas.replace("-7 7", "-9 9"));
    assert_eq!(does(json!("undo")).0, 200);
    assert_eq!(text(&copy), canvas);
    assert_eq!(text(&folder.path().join("a.svg")), DRAWING);

    let edited = Edited::new(DRAWING);
    let mut shown = page(edited.port);
    assert_eq!(heard(&mut shown, "editing")["copy"], false);
}

#[test]
fn a_folder_without_drawings_has_nothing_to_change() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_live, port) = served(folder.path(), ".");
    let mut shown = page(port);
    let key = heard(&mut shown, "editing")["key"]
        .as_str()
        .map(str::to_owned);
    let key = key.expect("a key");
    fs::write(folder.path().join("notes.txt"), "mine").expect("written");
    for drawing in ["", ".", "a.svg", "notes.txt"] {
        let body = json!({"drawing": drawing, "revision": 1, "do": "undo"});
        assert_eq!(sent(port, "/changes", &key, &body.to_string()).0, 409);
    }
}

#[test]
fn saves_from_elsewhere_are_kept() {
    let mut edited = Edited::new(DRAWING);
    // Another place was changed: both stay, although the page has not seen the save.
    let saved = DRAWING.replace("#00aa00", "#0000ff");
    let before = edited.revision;
    fs::write(edited.path(), &saved).expect("written");
    let body =
        json!({"drawing": "a.svg", "revision": before, "do": {"make": thickness("default -9 9")}});
    let (status, answer) = edited.post("/changes", &body);
    assert_eq!(status, 200, "{answer}");
    assert_eq!(edited.text(), saved.replace("-5 5", "-9 9"));

    // The same attribute was changed: nothing is lost without a word.
    let other = saved.replace("-5 5", "-20 20");
    fs::write(edited.path(), &other).expect("written");
    let (status, answer) = edited.post("/changes", &body);
    assert_eq!(status, 409);
    assert!(
        why(&answer).contains("`Shape` of `Body` is `default -20 20` now"),
        "{answer}"
    );
    assert_eq!(answer["choices"][0]["title"], "Change it all the same");
    assert_eq!(edited.text(), other);

    // Another shape has the name now.
    let swapped = DRAWING
        .replace("id=\"body\"", "id=\"x\"")
        .replace("id=\"arm\"", "id=\"body\"");
    fs::write(edited.path(), &swapped).expect("written");
    let (status, answer) = edited.post("/changes", &body);
    assert_eq!(status, 409);
    assert!(why(&answer).contains("another shape"), "{answer}");

    // The part is gone, and so is the file.
    fs::write(edited.path(), DRAWING.replace("Body", "Trunk")).expect("written");
    let (status, answer) = edited.post("/changes", &body);
    assert_eq!((status, why(&answer)), (409, "there is no part `Body`"));
    fs::remove_file(edited.path()).expect("removed");
    heard(&mut edited.page, "gone");
    assert_eq!(edited.post("/changes", &body).0, 409);
    assert!(!edited.path().exists());
}

#[test]
fn undo_keeps_what_came_from_elsewhere() {
    let mut edited = Edited::new(DRAWING);
    assert_eq!(edited.makes(&thickness("default -9 9")).0, 200);
    edited.build();
    let color = json!({"change": "set", "part": "Arm", "attribute": "Color", "value": "#123456"});
    assert_eq!(edited.makes(&color).0, 200);
    let both = edited.text();
    assert!(both.contains("Arm@Body$Shape roundv Color #123456"));
    // A save that keeps both, and adds a shape.
    let saved = both.replace(
        "</svg>",
        "  <circle cx=\"150\" cy=\"150\" r=\"9\" id=\"new\"/>\n</svg>",
    );
    fs::write(edited.path(), &saved).expect("written");
    assert_eq!(edited.does(&json!("undo")).0, 200);
    assert_eq!(edited.text(), saved.replace(" Color #123456", ""));
    // A save in which the other place is different: that step is given up, and the file stays.
    let other = edited.text().replace("-9 9", "-30 30");
    fs::write(edited.path(), &other).expect("written");
    let (status, answer) = edited.does(&json!("undo"));
    assert_eq!(status, 409);
    assert!(
        why(&answer).contains("Shape of Body stays as it is"),
        "{answer}"
    );
    assert_eq!(edited.text(), other);
    assert_eq!(
        why(&edited.does(&json!("undo")).1),
        "there is nothing to undo"
    );
}

#[test]
fn a_file_that_is_written_in_pieces_is_waited_for() {
    use std::io::Write as _;
    let edited = Edited::new(DRAWING);
    let saved = DRAWING
        .replace("#00aa00", "#0000ff")
        .replace("</svg>", &format!("<!-- {} --></svg>", "x".repeat(20_000)));
    let path = edited.path();
    let bytes = saved.clone().into_bytes();
    let (begun, begins) = std::sync::mpsc::channel();
    let writer = std::thread::spawn(move || {
        // As Inkscape does: in place, a piece at a time.
        let mut file = fs::File::create(path).expect("opened");
        for piece in bytes.chunks(4096) {
            file.write_all(piece).expect("written");
            let _ = begun.send(());
            std::thread::sleep(Duration::from_millis(60));
        }
    });
    begins.recv().expect("begun");
    // Once is enough, unless the machine stands still for longer than the program waits.
    wait_until("the change", || {
        let (status, answer) = edited.makes(&thickness("default -9 9"));
        assert!(
            status == 200 || why(&answer).contains("cannot be read as it is"),
            "{answer}"
        );
        status == 200
    });
    writer.join().expect("written");
    assert_eq!(edited.text(), saved.replace("-5 5", "-9 9"));

    // One that stays in pieces is not touched.
    fs::write(edited.path(), &saved[..9000]).expect("written");
    let (status, answer) = edited.makes(&thickness("default -7 7"));
    assert_eq!(status, 409);
    assert!(why(&answer).contains("cannot be read as it is"), "{answer}");
    assert_eq!(edited.text(), saved[..9000]);
}

#[test]
fn changes_and_saves_at_the_same_time_lose_nothing() {
    let mut edited = Edited::new(DRAWING);
    let path = edited.path();
    let stop = Arc::new(AtomicBool::new(false));
    let stopped = stop.clone();
    let saved = Arc::new(AtomicUsize::new(0));
    let counted = saved.clone();
    // Another program counts in comments, and saves by renaming; it reads the file before, as a careful one would.
    let writer = std::thread::spawn(move || {
        let mut saves = 0;
        while !stopped.load(Relaxed) {
            let mut text = String::new();
            // A change that came too late takes itself back: for a moment the file may be without the last save.
            wait_until(&format!("save {saves}"), || {
                text = fs::read_to_string(&path).expect("read");
                text.matches("<!--").count() == saves
            });
            let new = text.replace("</svg>", &format!("<!--{saves}--></svg>"));
            let copy = path.with_extension("tmp");
            fs::write(&copy, new).expect("written");
            fs::rename(&copy, &path).expect("renamed");
            saves += 1;
            counted.store(saves, Relaxed);
            // Longer each time: on a slow machine, each change would be late otherwise.
            std::thread::sleep(Duration::from_millis(100 + 10 * saves as u64));
        }
        saves
    });
    let (mut made, mut at) = (0, 0);
    wait_until("five changes and five saves", || {
        at += 1;
        let change =
            json!({"change": "set", "part": "Arm", "attribute": "Offset", "value": at.to_string()});
        made += usize::from(edited.makes(&change).0 == 200);
        // As a person would, who sees what has come of it; the other program saves, so there is a build.
        edited.build();
        made >= 5 && saved.load(Relaxed) >= 5
    });
    stop.store(true, Relaxed);
    let saves = writer.join().expect("no save is lost");
    assert_eq!(edited.text().matches("<!--").count(), saves);
}

#[cfg(unix)]
#[test]
fn modes_and_links_stay() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    let folder = tempfile::tempdir().expect("a folder");
    let real = folder.path().join("real");
    fs::create_dir(&real).expect("a folder");
    let real = real.join("drawing.svg");
    fs::write(&real, DRAWING).expect("written");
    fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).expect("set");
    symlink("real/drawing.svg", folder.path().join("a.svg")).expect("linked");
    let edited = Edited::of(folder, "a.svg");
    assert_eq!(edited.makes(&thickness("default -9 9")).0, 200);
    assert!(
        fs::symlink_metadata(edited.path())
            .expect("there")
            .is_symlink()
    );
    assert_eq!(
        fs::read_to_string(&real).expect("read"),
        DRAWING.replace("-5 5", "-9 9")
    );
    let mode = fs::metadata(&real).expect("there").permissions().mode();
    assert_eq!(mode & 0o7777, 0o640);
    let files = |folder: &Path| fs::read_dir(folder).expect("a folder").count();
    assert_eq!(files(real.parent().expect("a folder")), 1);

    fs::set_permissions(&real, fs::Permissions::from_mode(0o440)).expect("set");
    let (status, answer) = edited.makes(&thickness("default -8 8"));
    assert_eq!(status, 409);
    assert!(why(&answer).contains("write-protected"), "{answer}");
}

#[test]
fn packed_drawings_and_other_encodings_are_not_changed() {
    let packed = tempfile::tempdir().expect("a folder");
    let mut gzip = flate2::write::GzEncoder::new(vec![], flate2::Compression::default());
    std::io::Write::write_all(&mut gzip, DRAWING.as_bytes()).expect("packed");
    let bytes = gzip.finish().expect("packed");
    fs::write(packed.path().join("a.svg"), &bytes).expect("written");
    let edited = Edited::of(packed, "a.svg");
    let (status, answer) = edited.makes(&thickness("default -9 9"));
    assert_eq!(status, 409);
    assert!(why(&answer).contains("is packed"), "{answer}");
    assert_eq!(fs::read(edited.path()).expect("read"), bytes);

    // A byte order mark, and Windows' line ends, are kept.
    let marked = format!("\u{feff}{}", DRAWING.replace('\n', "\r\n"));
    let edited = Edited::new(&marked);
    assert_eq!(edited.makes(&thickness("default -9 9")).0, 200);
    assert_eq!(edited.text(), marked.replace("-5 5", "-9 9"));
}

#[test]
fn changes_need_not_wait_for_builds() {
    let edited = Edited::new(DRAWING);
    for at in 6..20 {
        let value = format!("default -{at} {at}");
        let (status, answer) = edited.makes(&thickness(&value));
        assert_eq!(status, 200, "{answer}");
        assert_eq!(
            edited.text(),
            DRAWING.replace("-5 5", &format!("-{at} {at}"))
        );
    }
    for at in (5..19).rev() {
        assert_eq!(edited.does(&json!("undo")).0, 200);
        assert_eq!(
            edited.text(),
            DRAWING.replace("-5 5", &format!("-{at} {at}"))
        );
    }
    assert_eq!(edited.makes(&thickness("round")).0, 200);
}

#[test]
fn a_build_follows_each_change() {
    let mut edited = Edited::new(DRAWING);
    for value in ["default -6 6", "default -7 7", "default -8 8"] {
        assert_eq!(edited.makes(&thickness(value)).0, 200);
        let build = edited.build();
        let parts = build["build"]["parts"].to_string();
        assert!(parts.contains(value), "{value}: {parts}");
    }
    wait_until("the last change", || edited.text().contains("-8 8"));
}

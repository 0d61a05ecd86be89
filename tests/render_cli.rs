//! `okoshi render` end to end: what it writes, and what it says of wrong use.

mod common;

use std::fs;

use common::program::{BAD, Room};
use image::{AnimationDecoder, ImageDecoder};
use okoshi::gltf::{Container, write};
use okoshi::scene::{Material, Mesh, Node, Piece, Primitive, Scene, Surface, ViewDependent};

const GOOD: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="200">
  <rect x="20" y="20" width="60" height="40" fill="#cc0000" id="body"/>
  <text x="50" y="44" font-size="5">Body</text>
</svg>
"##;

/// A folder with a good drawing and a bad one.
fn room() -> Room {
    let room = Room::with("a.svg", GOOD);
    room.write("bad.svg", BAD);
    room
}

/// Exit status, stdout, stderr.
fn run(room: &Room, arguments: &str) -> (i32, Vec<u8>, String) {
    let arguments: Vec<&str> = arguments.split_whitespace().collect();
    let output = room.command(&arguments).output().expect("it starts");
    let told = String::from_utf8(output.stderr).expect("text");
    assert!(!told.contains("panicked"), "{told}");
    let status = output.status.code().expect("it was not killed");
    (status, output.stdout, told)
}

#[track_caller]
fn ends(room: &Room, arguments: &str, status: i32, told: &str) {
    let (found, out, err) = run(room, arguments);
    assert_eq!(found, status, "{arguments}: {err}");
    assert!(err.contains(told), "{arguments}: {err:?} lacks {told:?}");
    assert!(out.is_empty(), "{arguments}");
}

/// The files beside the two drawings.
fn files(room: &Room) -> Vec<String> {
    let mut names = room.files();
    names.retain(|name| !name.ends_with(".svg"));
    names
}

fn picture(room: &Room, name: &str) -> image::RgbaImage {
    image::open(room.path(name)).expect("an image").into_rgba8()
}

#[test]
fn a_drawing_becomes_a_picture_beside_it() {
    let room = room();
    ends(
        &room,
        "render a.svg --size 80x60",
        0,
        "wrote a.png: 80 × 60 pixels, 12 triangles",
    );
    let image = picture(&room, "a.png");
    assert_eq!(image.dimensions(), (80, 60));
    let [r, g, b, alpha] = image.get_pixel(40, 30).0;
    assert!(
        r > 120 && g < 60 && b < 60 && alpha == 255,
        "{r} {g} {b} {alpha}"
    );
    assert_eq!(image.get_pixel(0, 0).0, [0; 4]);
    // A model gives the very same picture.
    ends(&room, "build a.svg", 0, "wrote");
    ends(
        &room,
        "render a.glb -o b.png --size 80x60",
        0,
        "wrote b.png",
    );
    assert_eq!(
        fs::read(room.path("a.png")).ok(),
        fs::read(room.path("b.png")).ok()
    );
    ends(&room, "build a.svg -o c.gltf", 0, "wrote");
    ends(&room, "-q render c.gltf --size 80x60", 0, "");
    assert_eq!(
        fs::read(room.path("a.png")).ok(),
        fs::read(room.path("c.png")).ok()
    );
    ends(
        &room,
        "render a.svg -o d.png --size 80x60 --background #00ff00",
        0,
        "wrote d.png",
    );
    assert_eq!(picture(&room, "d.png").get_pixel(0, 0).0, [0, 255, 0, 255]);
    let (status, out, _) = run(&room, "render a.svg -o - --size 80x60");
    assert_eq!((status, Some(out)), (0, fs::read(room.path("a.png")).ok()));
}

#[test]
fn options_change_the_picture() {
    let room = room();
    ends(&room, "render a.svg --size 60x60", 0, "wrote");
    let plain = picture(&room, "a.png");
    for more in ["--view=-40,30", "--projection orthographic", "--view 0,0"] {
        ends(
            &room,
            &format!("render a.svg -o other.png --size 60x60 {more}"),
            0,
            "wrote",
        );
        assert!(picture(&room, "other.png") != plain, "{more}");
    }
    ends(
        &room,
        "render a.svg -o other.png --size 60x60 --view 390,15 --shading smooth",
        0,
        "wrote",
    );
    assert!(picture(&room, "other.png") == plain);
}

#[test]
fn turntables() {
    let room = room();
    ends(
        &room,
        "render a.svg -o t.png --size 40x40 --turntable 10",
        0,
        "wrote t-01.png to t-10.png: 40 × 40",
    );
    let numbers: Vec<String> = (1..=10)
        .map(|number| format!("t-{number:02}.png"))
        .collect();
    assert_eq!(files(&room), numbers);
    ends(
        &room,
        "render a.svg -o t.gif --size 40x40 --turntable 10",
        0,
        "wrote t.gif: 10 frames",
    );
    let file = std::io::BufReader::new(fs::File::open(room.path("t.gif")).expect("a file"));
    let gif = image::codecs::gif::GifDecoder::new(file).expect("a GIF");
    assert_eq!(gif.dimensions(), (40, 40));
    let frames = gif.into_frames().collect_frames().expect("frames");
    assert_eq!(frames.len(), 10);
    assert_eq!(frames[3].delay().numer_denom_ms(), (400, 1));
    ends(
        &room,
        "render a.svg -o t.apng --size 40x40 --turntable 10",
        0,
        "wrote t.apng: 10 frames",
    );
    let file = std::io::BufReader::new(fs::File::open(room.path("t.apng")).expect("a file"));
    let apng = image::codecs::png::PngDecoder::new(file)
        .expect("a PNG")
        .apng()
        .expect("an animated one");
    let drawn = apng.into_frames().collect_frames().expect("frames");
    assert_eq!(drawn.len(), 10);
    for (index, frame) in drawn.iter().enumerate() {
        assert!(
            *frame.buffer() == picture(&room, &numbers[index]),
            "frame {index}"
        );
        // The GIF's colours are near, and what is clear in it is mostly clear here.
        let gif = frames[index].buffer();
        let far = gif.pixels().zip(frame.buffer().pixels()).filter(|(a, b)| {
            let apart = (0..3).any(|channel| a.0[channel].abs_diff(b.0[channel]) > 24);
            a.0[3] == 255 && b.0[3] == 255 && apart || a.0[3] == 0 && b.0[3] == 255
        });
        assert!(far.count() < 8, "frame {index}");
    }
    let (_, out, _) = run(&room, "render a.svg -o - --size 40x40 --turntable 10");
    assert_eq!(Some(out), fs::read(room.path("t.apng")).ok());
}

#[test]
fn wrong_use_is_told() {
    let room = room();
    let told = [
        (
            "render gone.svg",
            "error: `gone.svg` is not there; check the path",
        ),
        (
            "render gone.glb",
            "error: `gone.glb` is not there; check the path",
        ),
        (
            "render a.svg --size 800",
            "two whole numbers with an x between them are due",
        ),
        (
            "render a.svg --size 0x10",
            "each side may have 1 to 8192 pixels",
        ),
        (
            "render a.svg --size 9000x10",
            "each side may have 1 to 8192 pixels",
        ),
        (
            "render a.svg --view 30",
            "two numbers with a comma between them are due",
        ),
        (
            "render a.svg --view nan,3",
            "two numbers with a comma between them are due",
        ),
        (
            "render a.svg --view 0,91",
            "the camera is lifted by at most 90 degrees",
        ),
        (
            "render a.svg --background reddish",
            "a colour of six digits is due",
        ),
        (
            "render a.svg --turntable 1",
            "a whole number from 2 to 1000 is due",
        ),
        (
            "render a.svg --turntable 1001",
            "a whole number from 2 to 1000 is due",
        ),
        (
            "render a.svg -o a.gif",
            "would be a moving picture: say in how many frames",
        ),
        (
            "render a.svg -o a.jpg",
            "error: the output `a.jpg` must end in .png, .gif or .apng",
        ),
        (
            "render a.svg -o a.svg",
            "error: the output `a.svg` must end in .png, .gif or .apng",
        ),
        (
            "render a.svg -o none/a.png",
            "the folder `none` is not there; create it",
        ),
        ("render -", "a drawing from stdin has no place of its own"),
    ];
    for (arguments, message) in told {
        ends(&room, arguments, 2, message);
    }
    assert!(files(&room).is_empty(), "{:?}", files(&room));
    fs::write(room.path("no.glb"), "hello").expect("written");
    ends(
        &room,
        "render no.glb",
        2,
        "error: `no.glb` is no glTF that can be read",
    );
    let link = r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"../x.bin"}]}"#;
    fs::write(room.path("out.gltf"), link).expect("written");
    ends(
        &room,
        "render out.gltf",
        2,
        "links to `../x.bin`, which leads out of",
    );
    assert_eq!(files(&room), ["no.glb", "out.gltf"]);
}

#[test]
fn errors_in_the_drawing() {
    let room = room();
    ends(
        &room,
        "render bad.svg",
        1,
        "error[E101]: `Shap` is no keyword",
    );
    ends(&room, "render bad.svg", 1, "nothing was written");
    assert!(files(&room).is_empty());
    ends(
        &room,
        "render bad.svg --keep-going --size 40x40",
        1,
        "wrote bad.png",
    );
    assert_eq!(files(&room), ["bad.png"]);
    fs::remove_file(room.path("bad.png")).expect("removed");
    fs::write(
        room.path("none.svg"),
        r#"<svg xmlns="http://www.w3.org/2000/svg"/>"#,
    )
    .expect("written");
    ends(&room, "render none.svg", 1, "error");
    assert!(files(&room).is_empty());
}

/// A model of one upright square, one metre wide, that bends with the view.
fn bent() -> Vec<u8> {
    let square = Surface {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Surface::default()
    };
    let scene = Scene {
        nodes: vec![Node {
            name: "Island".to_owned(),
            mesh: Some(0),
            view_dependent: Some(ViewDependent::Bend),
            ..Node::default()
        }],
        roots: vec![0],
        meshes: vec![Mesh {
            primitives: vec![Primitive {
                pieces: vec![Piece::Surface(square)],
                material: 0,
            }],
        }],
        materials: vec![Material::default()],
        ..Scene::default()
    };
    let mut out = std::io::Cursor::new(Vec::new());
    write(&scene, Container::Glb, &mut out).expect("sound");
    out.into_inner()
}

#[test]
fn terrain_is_bent_with_the_view_unless_that_is_switched_off() {
    let room = room();
    room.write("bent.glb", bent());
    let ratio = |arguments: &str| {
        let arguments = format!("render bent.glb -o bent.png --size 200x200 {arguments}");
        ends(&room, &arguments, 0, "wrote bent.png");
        let image = picture(&room, "bent.png");
        let solid = image.enumerate_pixels().filter(|(_, _, p)| p.0[3] == 255);
        let [mut low, mut high] = [[u32::MAX; 2], [0; 2]];
        for (x, y, _) in solid {
            low = [low[0].min(x), low[1].min(y)];
            high = [high[0].max(x), high[1].max(y)];
        }
        f64::from(high[1] - low[1] + 1) / f64::from(high[0] - low[0] + 1)
    };
    let drawn = "--view 0,45 --projection orthographic";
    let flat = 0.5_f64.sqrt();
    for (arguments, wanted) in [
        (drawn.to_owned(), 1.0),
        (format!("{drawn} --bend on"), 1.0),
        (format!("{drawn} --bend off"), flat),
    ] {
        let found = ratio(&arguments);
        assert!((found - wanted).abs() < 0.02, "{arguments}: {found}");
    }
    ends(
        &room,
        "render bent.glb --bend sideways",
        2,
        "[possible values: on, off]",
    );
}

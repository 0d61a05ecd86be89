//! `okoshi render` end to end: its output, and its messages about wrong use.
#![cfg(feature = "cli")]

mod common;

use std::fs;
use std::sync::Arc;

use common::program::{BAD, Room};
use glam::{DQuat, DVec3};
use image::{AnimationDecoder, ImageDecoder};
use okoshi::export::{GLB, to_memory};
use okoshi::scene::{
    Animation, Camera, CameraProjection, Interpolation, Material, Mesh, NewNode, Node, Primitive,
    Scene, Surface, Timing, Track, Values, ViewDependent,
};

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
    // A model gives the same picture.
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
        // The GIF shows the same on white, in close colours.
        let gif = frames[index].buffer();
        for (found, wanted) in gif.pixels().zip(frame.buffer().pixels()) {
            let [r, g, b, alpha] = wanted.0;
            if alpha == 0 {
                assert_eq!(found.0, [255; 4], "frame {index}");
            }
            if alpha == 255 {
                let apart = (0..3).map(|channel| found.0[channel].abs_diff([r, g, b][channel]));
                assert!(
                    apart.max() < Some(24),
                    "frame {index}: {found:?} {wanted:?}"
                );
            }
        }
    }
    let (_, out, _) = run(&room, "render a.svg -o - --size 40x40 --turntable 10");
    assert_eq!(Some(out), fs::read(room.path("t.apng")).ok());
}

#[test]
fn wrong_use_is_explained() {
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
            "expected two whole numbers separated by an x",
        ),
        (
            "render a.svg --size 0x10",
            "each side must have 1 to 8192 pixels",
        ),
        (
            "render a.svg --size 9000x10",
            "each side must have 1 to 8192 pixels",
        ),
        (
            "render a.svg --view 30",
            "expected two numbers separated by a comma",
        ),
        (
            "render a.svg --view nan,3",
            "expected two numbers separated by a comma",
        ),
        (
            "render a.svg --view 0,91",
            "the camera can be at most 90 degrees",
        ),
        (
            "render a.svg --background reddish",
            "expected a colour of six digits, for example '#ffffff' for white, or transparent",
        ),
        (
            "render a.svg --turntable 1",
            "expected a whole number from 2 to 1000",
        ),
        (
            "render a.svg --turntable 1001",
            "expected a whole number from 2 to 1000",
        ),
        (
            "render a.svg -o a.gif",
            "would be an animation: choose what it shows",
        ),
        (
            "render a.svg -o a.jpg",
            "error: the output `a.jpg` must end in .png, .gif, .apng, .mp4 or .webm",
        ),
        (
            "render a.svg -o a.svg",
            "error: the output `a.svg` must end in .png, .gif, .apng, .mp4 or .webm",
        ),
        (
            "render a.svg -o none/a.png",
            "the folder `none` is not there; create it",
        ),
        ("render -", "a drawing from stdin is in no folder"),
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
        "error: `no.glb` is not a readable glTF file",
    );
    let link = r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"../x.bin"}]}"#;
    fs::write(room.path("out.gltf"), link).expect("written");
    ends(
        &room,
        "render out.gltf",
        2,
        "links to `../x.bin`, which is outside",
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
        "error[E101]: `Shap` is not a keyword",
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

/// A model of one upright square, one metre wide, in one node.
fn upright(node: Node, animations: Vec<Animation>) -> Vec<u8> {
    written(&upright_scene(node, animations))
}

fn written(scene: &Scene) -> Vec<u8> {
    to_memory(&GLB, scene, None).expect("sound").bytes
}

fn upright_scene(node: Node, animations: Vec<Animation>) -> Scene {
    let square = Surface {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Surface::default()
    };
    let mut scene = Scene {
        animations,
        ..Scene::default()
    };
    let material = scene.materials.push_and_get_key(Material {
        double_sided: true,
        ..Material::default()
    });
    scene.add(NewNode {
        node,
        mesh: Some(Mesh {
            primitives: vec![Primitive {
                patches: vec![square.into()],
                material,
            }],
        }),
        parent: None,
    });
    scene
}

/// A model that is bent with the view.
fn bent() -> Vec<u8> {
    let node = Node {
        name: "Island".to_owned(),
        view_dependent: Some(ViewDependent::Bend),
        ..Node::default()
    };
    upright(node, Vec::new())
}

/// A clip that turns the model about z a bit further at each key. The last key of held drawings repeats the one before.
fn turning(name: &str, times: &[f32], interpolation: Interpolation) -> Animation {
    let drawings = match interpolation {
        Interpolation::Step => times.len() - 1,
        _ => times.len(),
    };
    let turn = |key: usize| DQuat::from_rotation_z(key.min(drawings - 1) as f64 * 0.4);
    Animation {
        name: name.to_owned(),
        tracks: vec![Track {
            node: 0.into(),
            timing: Arc::new(Timing {
                times: times.to_vec(),
                interpolation,
            }),
            values: Values::Rotations(Arc::new((0..times.len()).map(turn).collect())),
        }],
    }
}

/// A folder with a model of two clips and one of a single clip of three held drawings.
fn moving_room() -> Room {
    let held = [0.0, 1.0 / 3.0, 5.0 / 6.0, 1.0];
    let held = turning("held", &held, Interpolation::Step);
    let smooth = turning("wave hand", &[0.0, 0.5], Interpolation::Linear);
    let room = room();
    let both = vec![smooth, held.clone()];
    room.write("two.glb", upright(Node::default(), both));
    room.write("one.glb", upright(Node::default(), vec![held]));
    room
}

fn gif(room: &Room, name: &str) -> Vec<image::Frame> {
    let file = std::io::BufReader::new(fs::File::open(room.path(name)).expect("a file"));
    let gif = image::codecs::gif::GifDecoder::new(file).expect("a GIF");
    gif.into_frames().collect_frames().expect("frames")
}

fn milliseconds(frames: &[image::Frame]) -> Vec<u32> {
    let delays = frames.iter().map(|frame| frame.delay().numer_denom_ms());
    delays.map(|(number, of)| number / of).collect()
}

#[test]
fn gif_delays_match_the_held_drawings_of_a_clip() {
    let room = moving_room();
    ends(
        &room,
        "render one.glb -o a.gif --size 40x40 --clip held",
        0,
        "wrote a.gif: 3 pictures in 1 seconds, 40 × 40 pixels, 2 triangles each",
    );
    let frames = gif(&room, "a.gif");
    assert_eq!(milliseconds(&frames), [330, 500, 170]);
    ends(
        &room,
        "render one.glb -o a.apng --size 40x40 --clip 1",
        0,
        "wrote a.apng: 3 pictures in 1 seconds",
    );
    let file = std::io::BufReader::new(fs::File::open(room.path("a.apng")).expect("a file"));
    let apng = image::codecs::png::PngDecoder::new(file).expect("a PNG");
    let apng = apng.apng().expect("an animated one");
    let drawn = apng.into_frames().collect_frames().expect("frames");
    assert_eq!(milliseconds(&drawn), [333, 500, 167]);
    ends(
        &room,
        "render one.glb -o a.png --size 40x40 --clip held",
        0,
        "wrote a-01.png to a-24.png: 40 × 40 pixels",
    );
    for frame in 0..24 {
        let shown = [8, 20, 24]
            .iter()
            .position(|end| frame < *end)
            .expect("one");
        let image = picture(&room, &format!("a-{:02}.png", frame + 1));
        assert!(image == *drawn[shown].buffer(), "{frame}");
    }
    // A constantly moving clip has all its frames, and their delays add up to its length.
    let smooth = "render two.glb -o b.gif --size 40x40 --clip wave_hand";
    let run_smooth = |more: &str| {
        let mut words: Vec<&str> = smooth.split(' ').collect();
        words.pop();
        words.push("wave hand");
        words.extend(more.split_whitespace());
        let output = room.command(&words).output().expect("it starts");
        assert!(output.status.success(), "{output:?}");
        milliseconds(&gif(&room, "b.gif"))
    };
    let delays = run_smooth("");
    assert_eq!((delays.len(), delays.iter().sum()), (12, 500));
    let delays = run_smooth("--fps 10 --from 0.25 --to 0.5");
    assert_eq!(delays, [100, 100, 50]);
    let (status, out, _) = run(&room, "render one.glb -o - --size 40x40 --clip held");
    assert_eq!((status, Some(out)), (0, fs::read(room.path("a.apng")).ok()));
}

/// A room with a model that runs ten metres to the right.
fn running_room() -> Room {
    let room = room();
    let run = Animation {
        name: "run".to_owned(),
        tracks: vec![Track {
            node: 0.into(),
            timing: Arc::new(Timing {
                times: vec![0.0, 1.0],
                interpolation: Interpolation::Linear,
            }),
            values: Values::Translations(vec![DVec3::ZERO, DVec3::X * 10.0]),
        }],
    };
    room.write("run.glb", upright(Node::default(), vec![run]));
    room
}

#[test]
fn a_camera_follows_what_moves() {
    let room = running_room();
    // The first and the last column of the model in the first and in the last frame.
    let extents = |more: &str| {
        let arguments = format!(
            "render run.glb -o run.gif --clip run --size 90x60 --view 0,10 --shading unlit --background #000000{more}"
        );
        ends(
            &room,
            &arguments,
            0,
            "wrote run.gif: 24 pictures in 1 seconds",
        );
        let frames = gif(&room, "run.gif");
        [0, 23].map(|index: usize| {
            let pixels = frames[index].buffer().enumerate_pixels();
            let model = pixels.filter(|(_, _, pixel)| pixel.0[0] > 200);
            let columns: Vec<u32> = model.map(|(x, _, _)| x).collect();
            let of = |column: Option<&u32>| column.copied().expect("the model");
            (of(columns.iter().min()), of(columns.iter().max()))
        })
    };
    let [(first, _), (_, last)] = extents("");
    assert!(first < 10 && last > 79, "{first} {last}");
    let [start, end] = extents(" --follow");
    assert_eq!(start, end);
    assert!(
        start.0 > 10 && start.1 < 79 && start.1 - start.0 > 30,
        "{start:?}"
    );
}

/// A room with a model of one square and two cameras in front of it: `Near`, and `Camera zoom`, which comes nearer in the second
/// of the clips.
fn filmed_room() -> Room {
    let room = room();
    let zoom = Animation {
        name: "zoom".to_owned(),
        tracks: vec![Track {
            node: 2.into(),
            timing: Arc::new(Timing {
                times: vec![0.0, 0.5, 1.0],
                interpolation: Interpolation::Step,
            }),
            values: Values::Translations([8.0, 4.0, 4.0].map(|z| DVec3::new(0.5, 0.5, z)).to_vec()),
        }],
    };
    let wave = turning("wave", &[0.0, 1.0], Interpolation::Linear);
    let mut scene = upright_scene(Node::default(), vec![wave, zoom]);
    for (index, (name, z)) in [("Near", 2.0), ("Camera zoom", 8.0)]
        .into_iter()
        .enumerate()
    {
        scene.add(NewNode {
            node: Node {
                name: name.to_owned(),
                translation: DVec3::new(0.5, 0.5, z),
                camera: Some(index.into()),
                ..Node::default()
            },
            mesh: None,
            parent: None,
        });
        scene.cameras.push(Camera {
            name: name.to_owned(),
            projection: CameraProjection::Perspective {
                vertical_field_of_view: 2.0 * 0.5_f64.atan(),
                near: 0.01,
                far: None,
            },
        });
    }
    room.write("filmed.glb", written(&scene));
    room
}

/// The width of what is visible in a picture.
fn visible_width(image: &image::RgbaImage) -> u32 {
    let seen = image.enumerate_pixels().filter(|(_, _, p)| p.0[3] > 128);
    let columns: std::collections::BTreeSet<u32> = seen.map(|(x, _, _)| x).collect();
    columns.len() as u32
}

#[test]
fn cameras_of_the_model_take_pictures() {
    let room = filmed_room();
    // The angle shows as many metres as the camera is away, in 64 pixels.
    let width = |more: &str, expected: u32| {
        let arguments = format!("render filmed.glb -o a.png --size 64x64 --shading unlit {more}");
        ends(&room, &arguments, 0, "wrote a.png");
        let width = visible_width(&picture(&room, "a.png"));
        assert!(width.abs_diff(expected) <= 1, "{more}: {width}");
    };
    width("--camera", 32);
    width("--camera Near", 32);
    width("--camera 2", 8);
    width("--camera=2", 8);
    // The camera of the clip, at a moment.
    width("--clip zoom --time 0.2 --camera", 8);
    width("--clip zoom --time 0.7 --camera", 16);
    width("--clip zoom --time 0.7 --camera 1", 32);
    // This clip moves no camera.
    width("--clip wave --time 0 --camera", 32);
    let film = "render filmed.glb -o a.gif --size 64x64 --clip zoom";
    let pictures = |more: &str| {
        ends(&room, &format!("{film}{more}"), 0, "wrote a.gif");
        gif(&room, "a.gif").len()
    };
    // Without the camera, nothing moves.
    assert_eq!(pictures(" --camera"), 2);
    assert_eq!(pictures(""), 1);
    ends(
        &room,
        "render filmed.glb -o strip.png --size 64x64 --shading unlit --clip zoom --strip 2 --camera",
        0,
        "wrote strip.png: 2 moments",
    );
    let strip = picture(&room, "strip.png");
    let cell = |index: u32| image::imageops::crop_imm(&strip, index * 64, 0, 64, 64).to_image();
    let widths = [0, 1].map(|index| visible_width(&cell(index)));
    assert!(widths[0].abs_diff(8) <= 1 && widths[1].abs_diff(16) <= 1);
}

#[test]
fn wrong_use_of_cameras_is_explained() {
    let room = filmed_room();
    for (arguments, told) in [
        (
            "filmed.glb --camera Far",
            "`filmed.glb` has no camera `Far`; there is 1 `Near`, 2 `Camera zoom`",
        ),
        ("filmed.glb --camera 3", "has no camera `3`; there is 1"),
        (
            "a.svg --camera",
            "`a.svg` has no camera: leave out --camera",
        ),
        (
            "filmed.glb --camera --view 0,0",
            "so --view has no meaning: leave out --view, or --camera",
        ),
        (
            "filmed.glb --camera --projection perspective",
            "leave out --projection, or --camera",
        ),
        (
            "filmed.glb --camera --turntable 4 -o a.gif",
            "leave out --turntable, or --camera",
        ),
        (
            "filmed.glb --camera --clip zoom --follow -o a.gif",
            "leave out --follow, or --camera",
        ),
        (
            "a.svg --camera --as-drawn",
            "leave out --as-drawn, or --camera",
        ),
    ] {
        ends(&room, &format!("render {arguments}"), 2, told);
    }
}

#[test]
fn gifs_have_a_background_unless_they_are_to_have_none() {
    let room = moving_room();
    let first = |more: &str| {
        let arguments = format!("render one.glb -o a.gif --size 40x40 --clip held{more}");
        ends(&room, &arguments, 0, "wrote a.gif");
        let frames = gif(&room, "a.gif");
        let pixels = frames.iter().flat_map(|frame| frame.buffer().pixels());
        let opaque = pixels.filter(|pixel| pixel.0[3] == 255).count();
        (frames[0].buffer().get_pixel(0, 0).0, opaque == 3 * 40 * 40)
    };
    assert_eq!(first(""), ([255; 4], true));
    assert_eq!(first(" --background #102030"), ([16, 32, 48, 255], true));
    let (corner, opaque) = first(" --background transparent");
    assert!(corner[3] == 0 && !opaque, "{corner:?} {opaque}");
}

#[test]
fn moments_and_strips_of_clips() {
    let room = moving_room();
    for (name, time) in [("early", "0.1"), ("same", "0.2"), ("late", "0.5")] {
        let arguments =
            format!("render one.glb -o {name}.png --size 40x40 --view 0,0 --time {time}");
        ends(&room, &arguments, 0, &format!("wrote {name}.png: 40 × 40"));
    }
    assert!(picture(&room, "early.png") == picture(&room, "same.png"));
    assert!(picture(&room, "early.png") != picture(&room, "late.png"));
    // A moment can be a turntable.
    ends(
        &room,
        "render one.glb -o t.gif --size 40x40 --clip held --time 0.5 --turntable 4",
        0,
        "wrote t.gif: 4 frames",
    );
    ends(
        &room,
        "render one.glb -o strip.png --size 40x30 --strip 5",
        0,
        "wrote strip.png: 5 moments, 40 × 30 pixels, 2 triangles each",
    );
    let strip = picture(&room, "strip.png");
    assert_eq!(strip.dimensions(), (200, 30));
    let cell = |index: u32| image::imageops::crop_imm(&strip, index * 40, 0, 40, 30).to_image();
    // At 0 and 0.25 the first drawing is shown, at 0.5 and 0.75 the second.
    assert!(cell(0) == cell(1) && cell(2) == cell(3));
    assert!(cell(1) != cell(2) && cell(3) != cell(4));
    ends(
        &room,
        "render one.glb -o part.png --size 40x30 --strip 2 --from 0.4 --to 0.8",
        0,
        "wrote part.png: 2 moments",
    );
    let part = picture(&room, "part.png");
    let cell = |index: u32| image::imageops::crop_imm(&part, index * 40, 0, 40, 30).to_image();
    assert!(cell(0) == cell(1));
}

#[test]
fn the_clip_of_a_character_turns_it() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/characters/boy.svg");
    let room = Room::with("boy.svg", fs::read_to_string(file).expect("the example"));
    let arguments = "render boy.svg -o strip.png --clip 1 --strip 5 --to 1 --size 60x80";
    ends(&room, arguments, 0, "wrote strip.png: 5 moments");
    let strip = picture(&room, "strip.png");
    let cell = |index: u32| image::imageops::crop_imm(&strip, index * 60, 0, 60, 80).to_image();
    for (first, second) in (0..5).flat_map(|first| (0..first).map(move |second| (first, second))) {
        let (first, second) = (cell(first), cell(second));
        let pixels = first.pixels().zip(second.pixels());
        let different = pixels.filter(|(a, b)| a != b).count();
        assert!(different > 100, "{different} pixels");
    }
}

#[test]
fn wrong_use_of_clips_is_explained() {
    let room = moving_room();
    let told = [
        (
            "two.glb -o a.gif --clip kick",
            "`two.glb` has no clip `kick`; there is 1 `wave hand` (0.5 s), 2 `held` (1 s)",
        ),
        ("two.glb -o a.gif --clip 3", "has no clip `3`; there is 1"),
        ("two.glb -o a.gif --clip 0", "has no clip `0`; there is 1"),
        (
            "two.glb --time 0",
            "has several clips: name one with --clip, 1 `wave hand` (0.5 s), 2",
        ),
        (
            "a.svg --time 0",
            "`a.svg` has no clips: nothing in it moves",
        ),
        (
            "one.glb --time 1.2",
            "has a clip of 1 seconds: --time 1.2 is after its end",
        ),
        ("one.glb -o a.gif --to 7", "--to 7 is after its end"),
        (
            "one.glb -o a.gif --from 0.5 --to 0.5",
            "cannot be shown from 0.5 to 0.5 seconds: --to must be after --from",
        ),
        ("one.glb --time=-1", "expected a number of seconds from 0"),
        ("one.glb --time 1 --fps 3", "cannot be used with"),
        ("one.glb --time 1 --follow", "cannot be used with"),
        ("one.glb --turntable 4 --follow", "cannot be used with"),
        (
            "two.glb --follow",
            "has several clips: name one with --clip",
        ),
        (
            "one.glb --strip 1",
            "expected a whole number from 2 to 1000",
        ),
        (
            "one.glb --strip 100 --size 4000x4000",
            "`one.glb` cannot be drawn as a strip of 400000 by 4000 pixels",
        ),
        (
            "one.glb -o a.gif --strip 3",
            "but --time and --strip make a still picture",
        ),
        (
            "one.glb -o a.gif --clip held --fps 60",
            "GIFs show at most 50 frames a second",
        ),
        (
            "one.glb -o a.gif --clip held --turntable 4",
            "--turntable shows one pose of a clip: choose it with --time",
        ),
    ];
    for (arguments, message) in told {
        ends(&room, &format!("render {arguments}"), 2, message);
    }
    assert_eq!(files(&room), ["one.glb", "two.glb"]);
}

#[test]
fn terrain_is_bent_with_the_view_by_default() {
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

#[test]
fn a_page_is_shown_as_drawn() {
    let room = room();
    ends(
        &room,
        "render a.svg --as-drawn",
        0,
        "wrote a.png: 200 × 200 pixels, 12 triangles",
    );
    let image = picture(&room, "a.png");
    for (x, y, pixel) in image.enumerate_pixels() {
        let is_body = (20..80).contains(&x) && (20..60).contains(&y);
        let wanted = if is_body { [0xcc, 0, 0, 255] } else { [0; 4] };
        assert_eq!(pixel.0, wanted, "{x}, {y}");
    }
    ends(
        &room,
        "render a.svg -o half.png --as-drawn --scale 0.5 --background #00ff00",
        0,
        "wrote half.png: 100 × 100 pixels",
    );
    assert_eq!(
        picture(&room, "half.png").get_pixel(9, 30).0,
        [0, 255, 0, 255]
    );
    assert_eq!(
        picture(&room, "half.png").get_pixel(10, 20).0,
        [0xcc, 0, 0, 255]
    );
    ends(&room, "build a.svg", 0, "wrote");
    let told = [
        (
            "a.glb --as-drawn",
            "`a.glb` is a model, which has no page: --as-drawn needs the drawing",
        ),
        (
            "a.svg --as-drawn --scale 41",
            "`a.svg` cannot be drawn 8200 by 8200 pixels: each side may have 1 to 8192; choose a smaller --scale",
        ),
        (
            "a.svg --as-drawn --scale 0",
            "expected a number of pixels above 0, up to 8192, for example 2",
        ),
        ("a.svg --scale 2", "--as-drawn"),
        (
            "a.svg --as-drawn --view 0,0",
            "'--as-drawn' cannot be used with '--view <YAW,PITCH>'",
        ),
        (
            "a.svg --as-drawn --clip 1",
            "'--as-drawn' cannot be used with '--clip <NAME>'",
        ),
        (
            "a.svg --as-drawn --turntable 4",
            "'--as-drawn' cannot be used with '--turntable <N>'",
        ),
        ("a.svg -o a.gif --as-drawn", "would be an animation"),
    ];
    for (arguments, message) in told {
        ends(&room, &format!("render {arguments}"), 2, message);
    }
}

#[test]
fn unlit_pictures_show_the_colors_of_materials() {
    let room = room();
    ends(
        &room,
        "render a.svg --size 60x60 --shading unlit",
        0,
        "wrote",
    );
    for pixel in picture(&room, "a.png").pixels() {
        let [r, g, b, alpha] = pixel.0;
        assert!(alpha == 0 || [r, g, b] == [0xcc, 0, 0], "{pixel:?}");
    }
}

//! `okoshi trace`: a photograph of a drawing becomes a figure that walks.
#![cfg(feature = "cli")]

mod common;

use common::program::Room;
use image::{ImageFormat, Rgb, RgbImage};

#[test]
fn a_photograph_becomes_a_figure_that_walks() {
    let photograph = std::fs::read("examples/photographs/boy.jpg").expect("the example");
    let room = Room::with("boy.jpg", photograph);
    let run = room.run(&["trace", "boy.jpg"]);
    run.ends(0, "", "from the sheet of paper in the picture");
    let run = room.run(&["annotate", "boy.svg"]);
    for name in [
        "Head@Body",
        "Hair@Head",
        "Larm@Body",
        "Rarm@Body",
        "Lfoot@Lleg",
        "Rfoot@Rleg",
    ] {
        assert!(run.out.contains(name), "{name} is not in {}", run.out);
    }
    let named = String::from_utf8(room.read("boy.svg")).expect("text");
    let walks = "<text x=\"9\" y=\"20\">%Motion walk</text></svg>";
    room.write("walks.svg", named.replace("</svg>", walks));
    let run = room.run(&["check", "walks.svg"]);
    assert_eq!(run.status, 0, "{}{}", run.out, run.err);
    let run = room.run(&["build", "walks.svg"]);
    run.ends(0, "", "1 clip");
}

#[test]
fn the_drawing_goes_where_it_is_asked_for_and_replaces_none() {
    let mut picture = RgbImage::from_pixel(64, 64, Rgb([255; 3]));
    for (x, y) in (16..48).flat_map(|x| (16..40).map(move |y| (x, y))) {
        picture.put_pixel(x, y, Rgb([200, 30, 30]));
    }
    let mut png = std::io::Cursor::new(Vec::new());
    picture
        .write_to(&mut png, ImageFormat::Png)
        .expect("the picture is encoded");
    let room = Room::with("box.png", png.into_inner());
    let drawing = room.run(&["trace", "box.png", "-o", "-"]);
    assert!(
        drawing.status == 0 && drawing.out.starts_with("<svg"),
        "{}",
        drawing.err
    );
    room.write("box.svg", "mine");
    room.run(&["trace", "box.png"])
        .ends(2, "", "never overwritten");
    assert_eq!(room.read("box.svg"), b"mine");
    let run = room.run(&["trace", "box.png", "-o", "other.svg", "-q"]);
    run.ends(0, "", "");
    assert_eq!(room.read("other.svg"), drawing.out.as_bytes());
    assert_eq!(room.files(), ["box.png", "box.svg", "other.svg"]);
}

#[test]
fn what_is_no_picture_of_a_drawing_is_refused() {
    let room = Room::with("text.jpg", "a text");
    room.run(&["trace", "text.jpg"])
        .ends(2, "", "`text.jpg` cannot be read");
    room.run(&["trace", "gone.png"]).ends(2, "", "gone.png");
    room.run(&["trace", "."])
        .ends(2, "", "name a picture in it");
    room.run(&["trace", "text.jpg", "-o", "a.glb"])
        .ends(2, "", "must end in .svg");
    assert_eq!(room.files(), ["text.jpg"]);
}

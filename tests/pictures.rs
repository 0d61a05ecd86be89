//! Every example looks the same as before: its picture is compared with the one in `tests/pictures/`.
//!
//! `OKOSHI_REWRITE=pictures cargo test --test pictures` updates those; look at them before you commit them.
#![cfg(feature = "cli")]

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use image::RgbaImage;
use okoshi::FolderResolver;
use okoshi::render::{Options, PosedModel, read, write_png};
use okoshi::resolver::MemoryResolver;

/// The side of the pictures, pixels.
const SIDE: u32 = 160;
/// The side of the blocks that are compared by their means, pixels: larger than an edge may move by rounding.
const BLOCK: u32 = 8;
/// The greatest mean difference of two pictures, of 255: in all, and in a block.
const MEAN: f64 = 0.6;
const WORST: f64 = 7.0;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn picture(glb: &[u8]) -> RgbaImage {
    let model = read(glb, &MemoryResolver::default()).expect("a model");
    let posed = PosedModel::new(&model, &model.rest()).expect("triangles");
    let options = Options::default()
        .with_size([SIDE, SIDE])
        .with_background([255, 255, 255]);
    posed.picture(&options).expect("a picture")
}

fn example(name: &str) -> Vec<u8> {
    let path = folder("examples").join(format!("{name}.svg"));
    let text = fs::read_to_string(&path).expect("an example");
    let beside = FolderResolver::new(path.parent().expect("a folder"));
    common::glb(&common::compiled(&text, &beside))
}

/// The mean difference of all values, and that of the block that differs most.
fn difference(one: &RgbaImage, other: &RgbaImage) -> (f64, f64) {
    if one.dimensions() != other.dimensions() {
        return (255.0, 255.0);
    }
    let blocks =
        (0..SIDE / BLOCK).flat_map(|y| (0..SIDE / BLOCK).map(move |x| (x * BLOCK, y * BLOCK)));
    let (mut sum, mut worst, mut count) = (0.0, 0.0_f64, 0.0);
    for (left, top) in blocks {
        // Signed, so that a slightly softer edge does not count.
        let mut far = [0.0_f64; 3];
        for y in top..top + BLOCK {
            for x in left..left + BLOCK {
                let (one, other) = (one.get_pixel(x, y).0, other.get_pixel(x, y).0);
                for channel in 0..3 {
                    far[channel] += f64::from(one[channel]) - f64::from(other[channel]);
                }
            }
        }
        let far = far.map(|far| far.abs() / f64::from(BLOCK * BLOCK));
        worst = far.into_iter().fold(worst, f64::max);
        sum += far.iter().sum::<f64>() / 3.0;
        count += 1.0;
    }
    (sum / count, worst)
}

fn save(image: &RgbaImage, path: &Path) {
    fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
    let mut file = fs::File::create(path).expect("a file");
    write_png(image, &mut file).expect("written");
}

#[test]
fn examples_look_the_same() {
    let rewrite = common::rewrite::rewrites("pictures");
    let mut wrong = Vec::new();
    for name in &common::examples() {
        let kept = folder("tests/pictures").join(format!("{name}.png"));
        let image = picture(&example(name));
        if rewrite {
            save(&image, &kept);
            continue;
        }
        let actual = folder("target/pictures").join(format!("{name}.png"));
        let Ok(bytes) = fs::read(&kept) else {
            save(&image, &actual);
            wrong.push(format!("{name} has no picture yet"));
            continue;
        };
        let reference = image::load_from_memory(&bytes).expect("a PNG").into_rgba8();
        let (mean, worst) = difference(&image, &reference);
        if mean > MEAN || worst > WORST {
            save(&image, &actual);
            wrong.push(format!(
                "{name} looks different: {mean:.2} all over, {worst:.1} in a block"
            ));
        }
    }
    assert!(
        wrong.is_empty(),
        "{}\nThe pictures as they are now lie in target/pictures. If they are right, run\n\
         `OKOSHI_REWRITE=pictures cargo test --test pictures`",
        wrong.join("\n")
    );
}

#[test]
fn a_moved_limb_is_noticed() {
    let whole = picture(&example("human"));
    assert_eq!(difference(&whole, &whole), (0.0, 0.0));
    let path = folder("examples/human.svg");
    let text = fs::read_to_string(&path).expect("an example");
    for (from, to) in [
        (
            "Rarm@Ubody$Shape roundv -90 90",
            "Rarm@Ubody$Shape roundv -90 90 Offset 12",
        ),
        ("$Color 0.85 0.3 0.25", "$Color 0.85 0.45 0.25"),
        ("Head@Ubody", "Head@Ubody$Shape default -40 40"),
    ] {
        assert!(text.contains(from), "the example has changed: {from}");
        let changed = text.replace(from, to);
        let compiled = common::compiled(&changed, &MemoryResolver::default());
        assert!(!compiled.has_errors(), "{to}");
        let (mean, worst) = difference(&picture(&common::glb(&compiled)), &whole);
        assert!(
            mean > MEAN || worst > WORST,
            "{to}: only {mean:.2}, {worst:.1}"
        );
    }
}

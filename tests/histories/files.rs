//! The files that the drawings of the histories link to, each in several versions.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::sync::{Arc, LazyLock};

use image::{ImageFormat, Rgba, RgbaImage};
use okoshi::compile::{Options, compile};
use okoshi::export::{GLB, to_memory};
use okoshi::resolver::{LinkError, MemoryResolver, Resolver};

/// The first two are files, and the third is that there is none.
pub(super) const VERSIONS: usize = 3;

/// The versions of a file, by their number.
type Contents = fn(usize) -> Vec<u8>;

/// The names of the files, and what makes a version.
pub(super) const LINKS: &[(&str, Contents)] = &[
    ("picture.png", |version| picture([0, 40][version])),
    ("front.png", |version| bird([20, 24][version])),
    ("side.png", |version| bird([28, 26][version])),
    ("model.glb", |version| model(4 + version)),
    ("other.glb", |version| model(7 + version)),
    ("motion.bvh", motion),
    ("marks.csv", marks),
];

static MADE: LazyLock<BTreeMap<&str, [Arc<[u8]>; 2]>> = LazyLock::new(|| {
    let made = LINKS
        .iter()
        .map(|(link, make)| (*link, [0, 1].map(|version| make(version).into())));
    made.collect()
});

/// The versions that there are now, the first ones at the beginning.
#[derive(Default)]
pub(super) struct Files(BTreeMap<&'static str, usize>);

impl Files {
    pub(super) fn set(&mut self, link: &'static str, version: usize) {
        self.0.insert(link, version);
    }
}

impl Resolver for Files {
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError> {
        let version = self.0.get(link).copied().unwrap_or(0);
        let found = MADE.get(link).and_then(|versions| versions.get(version));
        found.cloned().ok_or(LinkError::Missing)
    }
}

fn png(pixel: impl Fn(u32, u32) -> [u8; 4]) -> Vec<u8> {
    let picture = RgbaImage::from_fn(48, 48, |x, y| Rgba(pixel(x, y)));
    let mut file = Cursor::new(Vec::new());
    picture
        .write_to(&mut file, ImageFormat::Png)
        .expect("a picture that can be written");
    file.into_inner()
}

/// Two fields of colour.
fn picture(red: u8) -> Vec<u8> {
    png(|x, _| {
        if x < 24 {
            [red, 175, 80, 255]
        } else {
            [141, 110, 99, 255]
        }
    })
}

/// A round body with an eye at this place.
fn bird(eye: u32) -> Vec<u8> {
    png(|x, y| {
        let within =
            |cx: u32, cy: u32, r: u32| x.abs_diff(cx).pow(2) + y.abs_diff(cy).pow(2) < r * r;
        if within(eye, 18, 5) {
            [30, 40, 90, 255]
        } else if within(24, 24, 20) {
            [230, 180, 60, 255]
        } else {
            [0; 4]
        }
    })
}

fn model(width: usize) -> Vec<u8> {
    let drawing = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\"><rect width=\"{width}\" height=\"6\"/></svg>"
    );
    let compiled = compile(&drawing, &Options::default(), &MemoryResolver::default());
    let model = to_memory(&GLB, &compiled.scene, None);
    model.expect("a scene keeps its own rules").bytes
}

/// The first frames of the example of a walk.
fn motion(version: usize) -> Vec<u8> {
    let whole = include_str!("../../examples/motion/walk.bvh");
    let (skeleton, frames) = whole.split_once("Frames: 90").expect("90 frames");
    let mut lines = frames.lines().skip(1);
    let time = lines.next().expect("the frame time");
    let kept: Vec<&str> = lines.take(12 + 3 * version).collect();
    format!(
        "{skeleton}Frames: {}\n{time}\n{}\n",
        kept.len(),
        kept.join("\n")
    )
    .into_bytes()
}

/// The tracks of a hand that strikes and of one that hardly moves.
fn marks(version: usize) -> Vec<u8> {
    let mut table = "# 320x240\nframe,time,red_x,red_y,green_x,green_y\n".to_owned();
    for frame in 0..24 {
        let strike = (8 + version..12 + version).contains(&frame);
        let x = if strike {
            100 + 20 * (frame - 7 - version)
        } else {
            100
        };
        let time = frame as f64 / 24.0;
        table += &format!("{frame},{time},{x},120,{},120\n", 200 + frame / 12);
    }
    table.into_bytes()
}

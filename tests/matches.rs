//! The picture of a matching: what is the same in all views has one colour there, and what has no partner is grey.
#![cfg(feature = "cli")]

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use common::program::Room;
use glam::DVec2;
use image::RgbaImage;
use okoshi::FolderResolver;
use okoshi::compile::Compiled;
use okoshi::internals::billboard::{Character, RegionId, ViewId};
use okoshi::internals::geometry::{bounds, contains};
use okoshi::internals::report::picture_of_matches;
use okoshi::resolver::MemoryResolver;
use serde_json::Value;
use typed_index_collections::TiVec;

const EXAMPLES: [&str; 4] = ["bird", "boy", "cat", "robot"];
/// The layout of the picture, pixels: the height of a view, and the room around it and for its angles below.
const HEIGHT: f64 = 480.0;
const MARGIN: f64 = 20.0;
const CAPTION: f64 = 28.0;
/// The distance of the pixels that are looked at, wider than the border of a region is drawn: one counts if those around it show the
/// same region.
const STEP: f64 = 2.0;

fn example(name: &str) -> Compiled {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/characters");
    let text = fs::read_to_string(folder.join(format!("{name}.svg"))).expect("a drawing");
    common::compiled(&text, &FolderResolver::new(&folder))
}

/// The commonest colour of each region of a view in a picture whose cell begins at `left`, by region; regions of which nothing is
/// visible are missing. Also the width of the cell.
fn colors(
    character: &Character,
    view: ViewId,
    picture: &RgbaImage,
    left: u32,
) -> (BTreeMap<RegionId, [u8; 3]>, u32) {
    let shown = &character.views[view];
    let (low, high) = shown.bounds().expect("regions");
    let scale = HEIGHT / (high.y - low.y);
    let width = ((high.x - low.x) * scale + 2.0 * MARGIN).ceil();
    let slack = width - (high.x - low.x) * scale;
    let corner = DVec2::new(f64::from(left) + slack / 2.0, MARGIN);
    let boxes: TiVec<RegionId, _> = shown
        .regions
        .iter()
        .map(|region| bounds(&region.outline))
        .collect();
    let visible = |column: usize, row: usize| {
        let pixel = DVec2::new(f64::from(left), 0.0) + DVec2::new(column as f64, row as f64) * STEP;
        let at = (pixel + 0.5 - corner) / scale + low;
        let is_at = |index: &RegionId| {
            let is_near = boxes[*index]
                .is_some_and(|(low, high)| at.cmpge(low).all() && at.cmple(high).all());
            is_near && contains(&shown.regions[*index].outline, at)
        };
        boxes.keys().rev().find(is_at)
    };
    let [columns, rows] = [width, HEIGHT + 2.0 * MARGIN].map(|side| (side / STEP) as usize);
    let owners: Vec<Option<RegionId>> = (0..rows * columns)
        .map(|at| visible(at % columns, at / columns))
        .collect();
    let mut counts: BTreeMap<RegionId, BTreeMap<[u8; 3], usize>> = BTreeMap::new();
    for row in 1..rows - 1 {
        for column in 1..columns - 1 {
            let around =
                (row - 1..=row + 1).flat_map(|row| &owners[row * columns + column - 1..][..3]);
            let around: Vec<Option<RegionId>> = around.copied().collect();
            let Some(region) = around[0].filter(|_| around.iter().all(|own| *own == around[0]))
            else {
                continue;
            };
            let [x, y] = [column, row].map(|at| (at as f64 * STEP) as u32);
            let [r, g, b, _] = picture.get_pixel(left + x, y).0;
            *counts
                .entry(region)
                .or_default()
                .entry([r, g, b])
                .or_default() += 1;
        }
    }
    let commonest = counts.into_iter().map(|(region, counts)| {
        let most = counts.into_iter().max_by_key(|(_, count)| *count);
        (region, most.expect("a pixel").0)
    });
    (commonest.collect(), width as u32)
}

fn is_gray([r, g, b]: [u8; 3]) -> bool {
    r == g && g == b
}

/// Checks the picture of a single character; returns the numbers of pairs and of regions alone that could be seen.
fn check(compiled: &Compiled, what: &str) -> [usize; 2] {
    let [character] = &compiled.characters[..] else {
        panic!("{what} is one character");
    };
    let picture = picture_of_matches(&compiled.characters).expect("a picture");
    assert_eq!(f64::from(picture.height()), HEIGHT + 2.0 * MARGIN + CAPTION);
    let mut left = 0;
    let mut shown = Vec::new();
    for view in character.views.keys() {
        let (colors, width) = colors(character, view, &picture, left);
        shown.push(colors);
        left += width;
    }
    assert_eq!(picture.width(), left, "{what}");
    let mut seen = [0, 0];
    let mut taken: Vec<[u8; 3]> = Vec::new();
    for (region, track) in character.regions.iter().zip(&character.matching.tracks) {
        let own = track.regions.iter().zip(&shown);
        let own: Vec<[u8; 3]> = own
            .filter_map(|(region, colors)| colors.get(&(*region)?).copied())
            .collect();
        let name = &region.name;
        let is_alone = track.regions.iter().flatten().count() == 1;
        assert!(
            own.iter().all(|color| is_gray(*color) == is_alone),
            "{what} {name}: {own:?}"
        );
        if is_alone {
            seen[1] += own.len();
            continue;
        }
        assert!(
            own.windows(2).all(|pair| pair[0] == pair[1]),
            "{what} {name}: {own:?}"
        );
        if let [color, _, ..] = own[..] {
            assert!(
                !taken.contains(&color),
                "{what} {name}: {color:?} is that of another region"
            );
            taken.push(color);
            seen[0] += 1;
        }
    }
    seen
}

#[test]
fn pairs_have_one_color_in_all_views() {
    for name in EXAMPLES {
        let compiled = example(name);
        let pairs = compiled.characters[0].matching.tracks.iter();
        let pairs = pairs.filter(|track| track.regions.iter().flatten().count() > 1);
        let [seen, _] = check(&compiled, name);
        // Tiny regions are all border.
        assert!(seen + 4 >= pairs.count() && seen > 6, "{name}: {seen}");
    }
}

#[test]
fn regions_without_a_partner_are_gray() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/view-no-partner");
    let text = fs::read_to_string(folder.join("drawing.svg")).expect("a drawing");
    let compiled = common::compiled(&text, &MemoryResolver::default());
    assert_eq!(check(&compiled, "view-no-partner"), [1, 1]);
}

#[test]
fn characters_are_in_rows() {
    let mut both = example("boy").characters;
    let width = picture_of_matches(&both).expect("a picture").width();
    both.extend(example("cat").characters);
    let picture = picture_of_matches(&both).expect("a picture");
    assert_eq!(
        f64::from(picture.height()),
        2.0 * (HEIGHT + 2.0 * MARGIN + CAPTION)
    );
    assert!(picture.width() >= width);
    assert!(picture.pixels().all(|pixel| pixel.0[3] == 255));
    assert!(picture_of_matches(&[]).is_none());
}

fn boy() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/characters/boy.svg");
    fs::read_to_string(path).expect("a drawing")
}

#[test]
fn inspect_writes_the_picture_and_its_numbers() {
    let room = Room::with("boy.svg", boy());
    let done = room.run(&["inspect", "boy.svg", "--matches", "pairs.png"]);
    assert_eq!(done.status, 0, "{}", done.err);
    assert!(done.err.starts_with("wrote pairs.png: "), "{}", done.err);
    assert!(done.err.contains("0 without a partner"), "{}", done.err);
    assert!(done.out.contains(" 1 Left leg "), "{}", done.out);
    let plain = room.run(&["inspect", "boy.svg"]);
    assert!(!plain.out.contains(" 1 Left leg "), "{}", plain.out);
    let written = image::open(room.path("pairs.png"))
        .expect("a picture")
        .into_rgba8();
    let drawn = picture_of_matches(&example("boy").characters).expect("a picture");
    assert!(written == drawn);
    // Only the picture goes to stdout.
    let piped = room
        .command(&["inspect", "boy.svg", "--matches", "-"])
        .output()
        .expect("a run");
    assert_eq!(piped.stdout, room.read("pairs.png"));
}

#[test]
fn inspect_refuses_what_gives_no_picture() {
    let room = Room::with("boy.svg", boy());
    room.write("flat.svg", r##"<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><rect width="9" height="9"/></svg>"##);
    room.write("broken.svg", boy().replace("View 45 0", "View 45 0 Shap"));
    for (arguments, status, message) in [
        (
            &["inspect", "flat.svg", "--matches", "out.png"][..],
            2,
            "error: `flat.svg` has no character that is drawn from two sides",
        ),
        (
            &["inspect", "boy.svg", "--matches", "out.jpg"],
            2,
            "must end in .png",
        ),
        (
            &["inspect", "boy.svg", "--json", "--matches", "-"],
            2,
            "--json and --matches would both",
        ),
        (
            &["inspect", "broken.svg", "--matches", "out.png"],
            1,
            "`out.png` was not written",
        ),
    ] {
        let done = room.run(arguments);
        assert_eq!(done.status, status, "{arguments:?}: {}", done.err);
        assert!(done.err.contains(message), "{arguments:?}: {}", done.err);
    }
    assert_eq!(room.files(), ["boy.svg", "broken.svg", "flat.svg"]);
}

#[test]
fn inspect_never_replaces_an_input() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/characters");
    let room = Room::new();
    for name in ["bird.svg", "bird-front.png", "bird-side.png"] {
        room.write(name, fs::read(folder.join(name)).expect("a file"));
    }
    let before = room.read("bird-side.png");
    let done = room.run(&["inspect", "bird.svg", "--matches", "bird-side.png"]);
    assert_eq!(done.status, 2, "{}", done.err);
    assert!(
        done.err.contains("is linked by what is read"),
        "{}",
        done.err
    );
    assert_eq!(room.read("bird-side.png"), before);
}

#[test]
fn the_report_says_how_each_region_looks_in_each_view() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/view-no-partner");
    let text = fs::read_to_string(folder.join("drawing.svg")).expect("a drawing");
    let room = Room::with("a.svg", text);
    let done = room.run(&["inspect", "--json", "a.svg"]);
    let report: Value = serde_json::from_str(&done.out).expect("JSON");
    let regions = report["billboards"][0]["regions"]
        .as_array()
        .expect("regions");
    let found = regions.iter().map(|region| {
        let looks = region["looks"].as_array().expect("a list");
        let looks = looks.iter().map(|looks| {
            let at = looks["at"].as_array()?;
            let percent =
                |share: &Value| (share.as_f64().expect("a number") * 100.0).round() as i64;
            let at = at.iter().map(percent).collect::<Vec<_>>();
            Some((looks["color"].as_str().expect("a colour"), at))
        });
        looks.collect::<Vec<_>>()
    });
    assert_eq!(
        found.collect::<Vec<_>>(),
        [
            [
                Some(("#3366cc", vec![50, 50])),
                Some(("#3366cc", vec![50, 50]))
            ],
            [Some(("#ffcc00", vec![25, 40])), None],
        ]
    );
}

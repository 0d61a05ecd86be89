//! Which regions of two drawings show the same thing: how often the thesis' method and ours are right. The answers for pictures were
//! given by eye, those for other drawings by their ids.
//!
//! The drawings, the pictures and one half of the generated characters were looked at while the method was written. The other half
//! was held back: it alone tells how well the method does on what it has not seen.

use std::fmt::Write as _;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec2;
use typed_index_collections::TiVec;

use super::manual;
use crate::billboard::character::Character;
use crate::billboard::matching::by_similarity::compared::most_similar;
use crate::billboard::matching::{Track, match_regions};
use crate::billboard::place::frames;
use crate::billboard::region::{Direction, RegionId, View};
use crate::billboard::tests::generated::{FITTED, HELD_BACK, character, directions};
use crate::compile::{Compiled, Options, compile};
use crate::geometry::contains;
use crate::resolver::{LinkError, Resolver};
use crate::scene::ViewId;

/// The views of two pictures.
const BOTH: [ViewId; 2] = [ViewId::FIRST, ViewId::SECOND];

/// Points of two drawings that show the same thing.
type Answers = &'static [[[f64; 2]; 2]];

/// bird.svg, drawing units. The bird's right is on the left of the pictures.
const BIRD: Answers = &[
    // Body, head, belly, beak.
    [[50.0, 120.0], [249.0, 125.0]],
    [[100.0, 25.0], [297.5, 25.0]],
    [[100.0, 150.0], [280.0, 150.0]],
    [[100.0, 70.0], [274.0, 70.0]],
    // Feet.
    [[75.0, 175.0], [275.0, 175.0]],
    [[122.5, 175.0], [315.0, 175.0]],
    // Wings.
    [[71.0, 125.0], [264.0, 125.0]],
    [[129.0, 125.0], [314.0, 125.0]],
    // Eyes and pupils.
    [[77.5, 50.0], [270.0, 50.0]],
    [[121.0, 50.0], [298.5, 50.0]],
    [[85.5, 51.0], [264.5, 51.0]],
    [[114.5, 51.0], [289.5, 51.0]],
];

/// Two pictures of a character.
struct Pictures {
    name: &'static str,
    /// Files in `tests/characters`.
    files: [&'static str; 2],
    /// Their width and height, pixels.
    size: [u32; 2],
    /// How far the viewer of the second has walked to the character's left, degrees; by eye for the three-quarter views.
    theta: f64,
    /// Pixels.
    answers: Answers,
}

const PICTURES: [Pictures; 3] = [
    Pictures {
        name: "green alien (Kenney)",
        files: ["kenney-green-front.png", "kenney-green-threequarter.png"],
        size: [66, 92],
        theta: -30.0,
        answers: &[
            // Helmet, its glass, and the light on it.
            [[3.0, 33.0], [3.0, 33.0]],
            [[8.0, 28.0], [8.0, 28.0]],
            [[42.0, 20.0], [42.0, 20.0]],
            // Head, eyes, mouth.
            [[14.0, 45.0], [14.0, 45.0]],
            [[23.7, 41.0], [28.7, 41.0]],
            [[41.5, 41.0], [46.5, 41.0]],
            [[32.5, 52.7], [37.5, 52.7]],
            // Body with three spots.
            [[17.0, 72.0], [17.0, 72.0]],
            [[35.0, 75.0], [35.0, 75.0]],
            [[47.0, 67.5], [47.0, 67.5]],
            [[44.2, 74.0], [44.2, 74.0]],
        ],
    },
    Pictures {
        name: "pink alien (Kenney)",
        files: ["kenney-pink-front.png", "kenney-pink-threequarter.png"],
        size: [66, 92],
        theta: -30.0,
        answers: &[
            // Helmet, its glass, and the light on it beside and before the head.
            [[3.0, 33.0], [3.0, 33.0]],
            [[10.0, 22.0], [10.0, 22.0]],
            [[47.0, 16.5], [47.0, 16.5]],
            [[40.0, 26.0], [40.0, 26.0]],
            // Head, eye, pupil, mouth.
            [[14.0, 45.0], [14.0, 45.0]],
            [[26.4, 36.2], [31.4, 36.2]],
            [[33.0, 36.0], [38.0, 36.0]],
            [[32.8, 53.4], [37.8, 53.4]],
            // Body with three spots.
            [[17.0, 72.0], [17.0, 72.0]],
            [[40.2, 74.3], [40.2, 74.3]],
            [[26.4, 73.3], [26.4, 73.3]],
            [[32.0, 77.6], [32.0, 77.6]],
        ],
    },
    Pictures {
        name: "robot with outlines (model by Kenney)",
        files: ["robot-00.png", "robot-45.png"],
        size: [512, 512],
        theta: -45.0,
        answers: &[
            // Upper and lower half of the body, face.
            [[300.0, 218.0], [300.0, 218.0]],
            [[256.0, 380.0], [240.0, 380.0]],
            [[200.0, 340.0], [265.0, 340.0]],
            // Antenna.
            [[256.0, 150.0], [240.0, 150.0]],
            [[256.0, 195.0], [238.0, 195.0]],
            // Eyes and mouth.
            [[225.0, 283.0], [288.0, 285.0]],
            [[290.0, 285.0], [335.0, 285.0]],
            [[256.0, 320.0], [312.0, 321.0]],
            // Its right arm, which is in front of the body in the second picture, its muzzle, and the plate behind it.
            [[140.0, 320.0], [80.0, 300.0]],
            [[116.0, 298.0], [240.0, 298.0]],
            [[155.0, 245.0], [165.0, 250.0]],
            // Its left arm, and its muzzle.
            [[370.0, 320.0], [370.0, 310.0]],
            [[395.0, 298.0], [437.0, 298.0]],
        ],
    },
];

/// A row of the table.
struct Row {
    name: String,
    /// Pairs that there are, and of them those that each method finds.
    pairs: usize,
    thesis: usize,
    ours: usize,
}

impl Row {
    /// Compares both methods. `answers` gives the regions of two views that show the same thing.
    fn new(name: String, views: [&View; 2], answers: &[[RegionId; 2]]) -> Self {
        let mut views = TiVec::from(views.map(View::clone).to_vec());
        for region in views.iter_mut().flat_map(|view| &mut view.regions) {
            // Names and equal labels would decide.
            region.name = None;
        }
        let frames = frames(&views);
        let similar = most_similar(
            BOTH.map(|view| &views[view]),
            BOTH.map(|view| &frames[view]),
        );
        let tracks = match_regions(&views, &frames).tracks;
        let is_track = |pair: &&[RegionId; 2]| {
            let is_in = |track: &Track| BOTH.map(|view| track.regions[view]) == pair.map(Some);
            tracks.iter().any(is_in)
        };
        Self {
            name,
            pairs: answers.len(),
            thesis: answers
                .iter()
                .filter(|[a, b]| similar[*a] == Some(*b))
                .count(),
            ours: answers.iter().filter(is_track).count(),
        }
    }

    fn sum(name: &str, rows: &[Self]) -> Self {
        let sum = |of: fn(&Self) -> usize| rows.iter().map(of).sum();
        Self {
            name: name.to_owned(),
            pairs: sum(|row| row.pairs),
            thesis: sum(|row| row.thesis),
            ours: sum(|row| row.ours),
        }
    }

    fn share(&self) -> f64 {
        self.ours as f64 / self.pairs as f64
    }
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn compiled(text: &str, folder: &Path) -> Compiled {
    compile(text, &Options::default(), &Files(folder))
}

/// The files of a folder.
struct Files<'a>(&'a Path);

impl Resolver for Files<'_> {
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError> {
        let bytes = fs::read(self.0.join(link));
        bytes.map(Arc::from).map_err(|_| LinkError::Missing)
    }
}

/// The region in front at a point of a view, drawing units.
fn at(view: &View, point: [f64; 2]) -> RegionId {
    let is_there = view
        .regions
        .rposition(|region| contains(&region.outline, DVec2::from(point)));
    is_there.unwrap_or_else(|| panic!("nothing at {point:?}"))
}

/// The answers that points give: each region at most once.
fn by_points(views: [&View; 2], points: Answers) -> Vec<[RegionId; 2]> {
    let answers = points
        .iter()
        .map(|pair| [0, 1].map(|i| at(views[i], pair[i])));
    let answers: Vec<[RegionId; 2]> = answers.collect();
    for side in [0, 1] {
        let mut regions: Vec<RegionId> = answers.iter().map(|pair| pair[side]).collect();
        regions.sort_unstable();
        regions.dedup();
        assert_eq!(regions.len(), points.len(), "two points in one region");
    }
    answers
}

/// The answers that ids give: `lear-0` and `lear-1` are the same ear.
fn by_ids(compiled: &Compiled, character: &Character, views: [ViewId; 2]) -> Vec<[RegionId; 2]> {
    let ids = views.map(|view| {
        let tracks = character.matching.tracks.iter().zip(&character.regions);
        let ids = tracks.filter_map(|(track, model)| {
            let element = &compiled.drawing.shapes[model.shapes[view]?].element;
            let id = element.id.as_deref()?;
            let (own, _) = id.rsplit_once('-')?;
            Some((own.to_owned(), track.regions[view]?))
        });
        ids.collect::<Vec<_>>()
    });
    let pair = |(own, region): &(String, RegionId)| {
        let other = ids[1].iter().find(|(other, _)| other == own)?;
        Some([*region, other.1])
    };
    ids[0].iter().filter_map(pair).collect()
}

fn examples() -> Vec<Row> {
    let folder = folder("examples/characters");
    let mut rows = Vec::new();
    for name in ["bird", "boy", "cat", "robot"] {
        let path = folder.join(name).with_extension("svg");
        let compiled = compiled(&fs::read_to_string(path).expect("a drawing"), &folder);
        let [character] = &compiled.characters[..] else {
            panic!("{name} is one character");
        };
        for last in character.views.keys().skip(1) {
            let both = [ViewId::FIRST, last];
            let [a, b] = both.map(|view| &character.views[view]);
            let answers = match name {
                "bird" => by_points([a, b], BIRD),
                _ => by_ids(&compiled, character, both),
            };
            let theta = b.direction.theta;
            let from = if theta == 0.0 { ", from above" } else { "" };
            rows.push(Row::new(format!("`{name}.svg`{from}"), [a, b], &answers));
        }
    }
    rows
}

fn pictures() -> Vec<Row> {
    let row = |pictures: &Pictures| {
        let [width, height] = pictures.size;
        let view = |file: usize, theta: f64| {
            let href = pictures.files[file];
            format!(
                r#"<g inkscape:groupmode="layer"><image href="{href}" width="{width}" height="{height}"/><text y="9">Who$View {theta} 0</text></g>"#
            )
        };
        let text = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" width="{width}" height="{height}">{}{}</svg>"#,
            view(0, 0.0),
            view(1, pictures.theta)
        );
        let compiled = compiled(&text, &folder("tests/characters"));
        let [character] = &compiled.characters[..] else {
            panic!("{}: {:?}", pictures.name, compiled.diagnostics);
        };
        let views = BOTH.map(|view| &character.views[view]);
        let answers = by_points(views, pictures.answers);
        Row::new(pictures.name.to_owned(), views, &answers)
    };
    PICTURES.iter().map(row).collect()
}

/// Two directions far apart: the front, and 60° to 90° to either side.
fn from_the_side(seed: u64) -> [Direction; 2] {
    let theta = [60.0, -75.0, 90.0, -90.0][seed as usize % 4];
    [0.0, theta].map(|theta| Direction { theta, phi: 0.0 })
}

fn generated(seeds: Range<u64>, directions: fn(u64) -> [Direction; 2]) -> Vec<Row> {
    let row = |seed: u64| {
        let character = character(seed);
        let drawn = directions(seed).map(|direction| character.true_view(direction));
        let [first, second] = &drawn;
        let same = |(region, item): (RegionId, &usize)| {
            let other = second.items.position(|other| other == item)?;
            Some([region, other])
        };
        let answers: Vec<_> = first.items.iter_enumerated().filter_map(same).collect();
        let views = [&first.view, &second.view];
        Row::new(format!("seed {seed}"), views, &answers)
    };
    seeds.map(row).collect()
}

/// A number with commas.
fn grouped(number: usize) -> String {
    match number {
        0..1000 => number.to_string(),
        _ => format!("{},{:03}", grouped(number / 1000), number % 1000),
    }
}

/// The table in the manual.
fn table(rows: &[Row]) -> String {
    let mut table =
        String::from("| drawings | pairs | thesis' method | okoshi |\n|---|--:|--:|--:|\n");
    for row in rows {
        let percent = |right: usize| format!("{:.0} %", 100.0 * right as f64 / row.pairs as f64);
        writeln!(
            table,
            "| {} | {} | {} | {} |",
            row.name,
            grouped(row.pairs),
            percent(row.thesis),
            percent(row.ours)
        )
        .expect("text");
    }
    table
}

#[test]
fn the_manual_says_how_many_pairs_are_right() {
    let mut rows = examples();
    rows.extend(pictures());
    let halves = [FITTED, HELD_BACK].map(|seeds| generated(seeds, directions));
    for row in rows.iter().chain(halves.iter().flatten()) {
        assert!(
            row.ours >= row.thesis,
            "{}: {} of {}, by similarity {}",
            row.name,
            row.ours,
            row.pairs,
            row.thesis
        );
    }
    let own = Row::sum("drawings", &rows);
    assert!(own.share() >= 0.95, "{} of {}", own.ours, own.pairs);
    for (half, what) in halves.iter().zip(["looked at", "held back"]) {
        let name = format!("{} generated characters, {what}", half.len());
        let sum = Row::sum(&name, half);
        assert!(sum.share() >= 0.95, "{name}: {} of {}", sum.ours, sum.pairs);
        rows.push(sum);
    }
    for (seeds, what) in [(FITTED, "looked at"), (HELD_BACK, "held back")] {
        let sides = generated(seeds, from_the_side);
        let name = format!("{} of them from the side, {what}", sides.len());
        let sum = Row::sum(&name, &sides);
        assert!(sum.share() >= 0.91, "{name}: {} of {}", sum.ours, sum.pairs);
        rows.push(sum);
    }

    manual::keep("matched", &table(&rows));
}

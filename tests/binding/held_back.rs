//! Texts laid on drawings that no rule of binding was fitted to: the figures of `tests/motion/figures`.
//!
//! Where a text stands is drawn by lot, in the ways in which those of `texts.json` are laid, and what it means is known from that. Nobody
//! looked whether a person would lay it so: on these crowded figures, what stands above, below or beside a part often lies on another
//! one. The shares are therefore lower than those of texts that people place.

use std::path::{Path, PathBuf};
use std::{fs, iter};

use fastrand::Rng;
use glam::DVec2;
use okoshi::internals::geometry::contains;

use super::{Count, Laid, Text, compiled, count, report};

/// The cells along the larger side of the grid on which is looked up what is seen of a part.
const CELLS: usize = 160;
/// Parts of which fewer cells are seen get no text.
const LEAST_CELLS: usize = 12;
/// The sizes of the texts, of the larger side of the page.
const SIZES: [f64; 2] = [0.019, 0.037];
/// The share of the parts that get a text of either size: large ones have less room.
const NAMED: [f64; 2] = [0.8, 0.5];
/// The width of a letter, font sizes.
const LETTER: f64 = 0.55;
/// How texts are laid.
const KINDS: [&str; 9] = [
    "natural", "inside", "centred", "left", "right", "above", "below", "beside", "long",
];

/// What is seen of a drawing's parts.
struct Seen {
    /// The size of a cell, drawing units.
    cell: f64,
    corner: DVec2,
    columns: usize,
    /// Per cell, row by row, the ids of the shape that is seen there and of the groups around it.
    ids: Vec<Vec<String>>,
}

impl Seen {
    fn new(svg: &str) -> Self {
        let compiled = compiled(svg);
        let (corner, size) = compiled.drawing.page;
        let cell = size.max_element() / CELLS as f64;
        let [columns, rows] = (size / cell).to_array().map(|side| side.ceil() as usize);
        let parts = &compiled.bindings.parts;
        let ids = (0..columns * rows).map(|at| {
            let point = DVec2::new((at % columns) as f64, (at / columns) as f64) + 0.5;
            let point = corner + point * cell;
            let top = parts.iter().rfind(|part| contains(&part.outline, point));
            top.map_or_else(Vec::new, |part| super::ids(&compiled, part.shape))
        });
        Self {
            cell,
            corner,
            columns,
            ids: ids.collect(),
        }
    }

    /// The middles of the cells that show an element.
    fn of(&self, id: &str) -> Vec<DVec2> {
        let cells = self.ids.iter().enumerate();
        let shows = cells.filter(|(_, ids)| ids.iter().any(|own| own == id));
        let middle = |(at, _): (usize, &Vec<String>)| {
            let cell = DVec2::new((at % self.columns) as f64, (at / self.columns) as f64);
            self.corner + (cell + 0.5) * self.cell
        };
        shows.map(middle).collect()
    }

    /// How many cells of a box show something.
    fn covered(&self, low: DVec2, high: DVec2) -> usize {
        let cells = self.ids.iter().enumerate();
        let inside = cells.filter(|(at, ids)| {
            let cell = DVec2::new((at % self.columns) as f64, (at / self.columns) as f64);
            let middle = self.corner + (cell + 0.5) * self.cell;
            !ids.is_empty() && middle.cmpge(low).all() && middle.cmple(high).all()
        });
        inside.count()
    }
}

/// Which side of a part a text stands on.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Left,
    Right,
    Above,
    Below,
}

/// Where the middle of a text of a size stands beside one of the cells of a part.
fn beside(cells: &[DVec2], side: Side, size: DVec2, em: f64, random: &mut Rng) -> DVec2 {
    let is_level = matches!(side, Side::Left | Side::Right);
    let along = |cell: &DVec2| if is_level { cell.y } else { cell.x };
    let mut places: Vec<f64> = cells.iter().map(along).collect();
    places.sort_by(f64::total_cmp);
    // In the middle half of what is seen of it.
    let place = places[places.len() / 4 + random.usize(0..=places.len() / 2)];
    let in_line = cells.iter().filter(|cell| along(cell) == place);
    let gap = em * (0.3 + 0.5 * random.f64());
    let reach = |across: fn(&DVec2) -> f64, sign: f64| {
        let ends = in_line.clone().map(|cell| across(cell) * sign);
        sign * ends.fold(f64::NEG_INFINITY, f64::max)
    };
    match side {
        Side::Left => DVec2::new(reach(|cell| cell.x, -1.0) - gap - size.x / 2.0, place),
        Side::Right => DVec2::new(reach(|cell| cell.x, 1.0) + gap + size.x / 2.0, place),
        Side::Above => DVec2::new(place, reach(|cell| cell.y, -1.0) - gap - size.y / 2.0),
        Side::Below => DVec2::new(place, reach(|cell| cell.y, 1.0) + gap + size.y / 2.0),
    }
}

/// The cell that is farthest from all that is not of the part, and how far.
fn innermost(seen: &Seen, cells: &[DVec2]) -> (DVec2, f64) {
    let step = seen.cell;
    let is_own = |point: DVec2| {
        cells
            .iter()
            .any(|cell| cell.distance_squared(point) < 0.1 * step * step)
    };
    let ring = |middle: DVec2, reach: f64| {
        [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y]
            .iter()
            .all(|way| is_own(middle + *way * reach))
    };
    let depth = |cell: &DVec2| {
        let reaches = iter::successors(Some(step), |reach| Some(reach + step));
        reaches
            .take_while(|reach| ring(*cell, *reach))
            .last()
            .unwrap_or(0.0)
    };
    let depths = cells.iter().map(|cell| (*cell, depth(cell)));
    let deepest = depths.max_by(|one, other| one.1.total_cmp(&other.1));
    deepest.expect("a cell")
}

/// A text on a part of which these cells are seen.
fn text(
    seen: &Seen,
    id: &str,
    words: String,
    kind: &str,
    em: f64,
    random: &mut Rng,
) -> Option<Text> {
    let cells = seen.of(id);
    if cells.len() < LEAST_CELLS {
        return None;
    }
    let size = DVec2::new(words.len() as f64 * LETTER, 0.7) * em;
    let mut at = |side: Side| beside(&cells, side, size, em, random);
    let sides = [Side::Left, Side::Right, Side::Above, Side::Below];
    let freest = |places: &[DVec2]| {
        let covered = |place: &&DVec2| seen.covered(**place - size / 2.0, **place + size / 2.0);
        *places.iter().min_by_key(covered).expect("a side")
    };
    let middle = match kind {
        "left" => at(Side::Left),
        "right" => at(Side::Right),
        "above" => at(Side::Above),
        "below" => at(Side::Below),
        "beside" => freest(&[at(Side::Left), at(Side::Right)]),
        "centred" => innermost(seen, &cells).0,
        "natural" => match innermost(seen, &cells) {
            (middle, depth) if depth >= size.y => middle,
            _ => freest(&sides.map(at)),
        },
        // The text begins on the part.
        _ => cells[random.usize(..cells.len())] + DVec2::new(size.x / 2.0, 0.0),
    };
    Some(Text {
        x: middle.x - size.x / 2.0,
        y: middle.y + size.y / 2.0,
        size: em,
        text: words,
        means: vec![id.to_owned()],
    })
}

/// The texts of one kind and size on a figure.
fn laid(
    seen: &Seen,
    parts: &[(String, String)],
    kind: &str,
    size: usize,
    random: &mut Rng,
) -> Vec<Text> {
    let em = SIZES[size] * CELLS as f64 * seen.cell;
    let named: Vec<usize> = (0..parts.len())
        .filter(|_| random.f64() < NAMED[size])
        .collect();
    let mut texts = Vec::new();
    for part in &named {
        let (id, name) = &parts[*part];
        let mut words = name.clone();
        let other = &parts[named[random.usize(..named.len())]].1;
        if other != name && random.bool() {
            words = format!("{words}@{other}");
        }
        match kind {
            "long" => words.push_str("$Shape roundv -90 90"),
            _ if random.usize(..5) == 0 => words.push_str("$Shape inflate"),
            _ => {}
        }
        texts.extend(text(seen, id, words, kind, em, random));
    }
    texts
}

/// The figures: their drawings, and for each part that moves its id and a name.
fn figures() -> Vec<(String, Vec<(String, String)>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/motion/figures");
    let files = fs::read_dir(folder).expect("the figures");
    let mut paths: Vec<PathBuf> = files.map(|file| file.expect("a file").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "svg"));
    paths.sort();
    let read = |path: &Path| fs::read_to_string(path).expect("a text");
    let figure = |path: &PathBuf| {
        let list = read(&path.with_extension("txt"));
        let moving = list.lines().filter_map(|line| {
            let (id, choices) = line.split_once(": ")?;
            let choice = choices.split(" | ").next()?;
            (choice != "-").then(|| (id.to_owned(), choice.replace(' ', "")))
        });
        let mut parts: Vec<(String, String)> = Vec::new();
        for (id, name) in moving {
            let is_taken = parts.iter().any(|(_, other)| *other == name);
            let name = if is_taken {
                format!("{name}{id}")
            } else {
                name
            };
            parts.push((id, name));
        }
        (read(path), parts)
    };
    paths.iter().map(figure).collect()
}

#[test]
fn texts_name_what_is_meant_in_drawings_that_were_held_back() {
    let mut counts: Vec<(String, Count)> = Vec::new();
    for (seed, (svg, parts)) in figures().into_iter().enumerate() {
        let seen = Seen::new(&svg);
        let mut random = Rng::with_seed(seed as u64);
        for kind in KINDS {
            for size in 0..SIZES.len() {
                let laid = Laid {
                    art: String::new(),
                    kind: kind.to_owned(),
                    leaders: Vec::new(),
                    texts: laid(&seen, &parts, kind, size, &mut random),
                };
                let found = count(svg.clone(), &laid);
                counts.push((kind.to_owned(), found));
            }
        }
    }
    let (kinds, all, table) = report(counts.iter().map(|(kind, count)| (kind.as_str(), *count)));
    println!("{table}");
    assert!(all.all() > 1000, "{table}");
    assert!(all.share_right() >= 0.73, "{table}");
    for (kind, count) in &kinds {
        let least = match *kind {
            "natural" | "inside" | "centred" | "long" => 0.83,
            "beside" => 0.78,
            "right" => 0.7,
            "above" => 0.5,
            _ => 0.55,
        };
        assert!(count.share_right() >= least, "{kind}\n{table}");
    }
}

//! Pictures that were not drawn cleanly, beside the same that were: how many regions come out, and how many find their partners.

use std::fmt::Write as _;
use std::ops::Range;

use rayon::prelude::*;
use typed_index_collections::{TiSlice, TiVec};

use super::manual;
use super::painted::{Seen, Style};
use crate::billboard::matching::match_regions;
use crate::billboard::place::frames;
use crate::billboard::region::{Direction, View};
use crate::billboard::tests::generated::{Drawn, HELD_BACK, character};
use crate::scene::ViewId;

/// How many characters are painted.
const COUNT: u64 = 8;
/// The character's height, pixels.
const HEIGHT: f64 = 260.0;

const CLEAN: Style = Style {
    height: HEIGHT,
    is_outlined: true,
    is_white: false,
    gap: 0.0,
    shading: 0.0,
    noise: 0.0,
    jpeg: None,
};

/// A row of the table, with the least share of the clean picture's pairs that must remain, and of those that must be right near the front
/// and from the side.
struct Row {
    name: &'static str,
    style: Style,
    /// What its regions are compared with.
    clean: Style,
    kept: f64,
    least: [f64; 2],
}

fn rows() -> Vec<Row> {
    let row = |name, style, kept, least| Row {
        name,
        style,
        clean: Style {
            noise: 0.0,
            jpeg: None,
            ..style
        },
        kept,
        least,
    };
    let plain = Style {
        is_outlined: false,
        ..CLEAN
    };
    let noisy = |style: Style| Style {
        noise: 8.0,
        ..style
    };
    let jpeg = |style: Style| Style {
        jpeg: Some(30),
        ..style
    };
    vec![
        row("with outlines", CLEAN, 1.0, [0.95, 0.75]),
        row("with outlines, noise", noisy(CLEAN), 0.9, [0.8, 0.65]),
        row("with outlines, JPEG", jpeg(CLEAN), 0.8, [0.8, 0.65]),
        row("without", plain, 1.0, [0.8, 0.65]),
        row("without, noise", noisy(plain), 0.75, [0.8, 0.65]),
        row("without, JPEG", jpeg(plain), 0.55, [0.8, 0.65]),
    ]
}

/// What is measured of a way to paint.
#[derive(Debug, Default, Clone, Copy)]
struct Sums {
    /// Regions of all pictures.
    regions: usize,
    /// Pairs that there are near the front and from the side, and of them the right ones.
    pairs: [usize; 2],
    right: [usize; 2],
    /// What is drawn in both views, whether or not pictures show it as a region.
    drawn: [usize; 2],
}

impl Sums {
    fn and(self, other: Self) -> Self {
        let sum = |a: [usize; 2], b: [usize; 2]| [0, 1].map(|i| a[i] + b[i]);
        Self {
            regions: self.regions + other.regions,
            pairs: sum(self.pairs, other.pairs),
            right: sum(self.right, other.right),
            drawn: sum(self.drawn, other.drawn),
        }
    }

    fn share(self, side: usize) -> f64 {
        self.right[side] as f64 / self.pairs[side] as f64
    }
}

fn measured(seeds: Range<u64>, style: Style) -> Sums {
    let seeds = seeds.into_par_iter();
    let one = |seed: u64| {
        let who = character(seed);
        let mut sums = Sums::default();
        let near = [30.0, 45.0, 60.0, -45.0][seed as usize % 4];
        let side = [90.0, -90.0][seed as usize % 2];
        let seen = |theta: f64| {
            let direction = Direction { theta, phi: 0.0 };
            let drawn = who.true_view(direction);
            let picture = style.paint(&drawn, who.scale, seed);
            let seen = style.seen(&picture, &drawn, (who.scale, direction));
            (drawn, seen)
        };
        let front = seen(0.0);
        sums.regions = front.1.view.regions.len();
        for (side, theta) in [near, side].into_iter().enumerate() {
            let other = seen(theta);
            sums.regions += other.1.view.regions.len();
            (sums.pairs[side], sums.right[side]) = right([&front.1, &other.1]);
            sums.drawn[side] = in_both([&front.0, &other.0]);
        }
        sums
    };
    seeds.map(one).reduce(Sums::default, Sums::and)
}

fn in_both([a, b]: [&Drawn; 2]) -> usize {
    a.items.iter().filter(|item| b.items.contains(item)).count()
}

/// How many pairs of regions two pictures have, and how many of them are found.
fn right(seen: [&Seen; 2]) -> (usize, usize) {
    let views: TiVec<ViewId, View> = seen.map(|seen| seen.view.clone()).to_vec().into();
    let tracks = match_regions(&views, &frames(&views)).tracks;
    let [first, second] = seen.map(|seen| TiSlice::from_ref(&seen.items.raw[..]));
    let first: &TiSlice<crate::billboard::RegionId, _> = first;
    let mut counts = (0, 0);
    for (region, item) in first.iter_enumerated() {
        let item: Option<usize> = *item;
        let Some(item) = item else { continue };
        let Some(other) = second.position(|other| *other == Some(item)) else {
            continue;
        };
        counts.0 += 1;
        let is_track = |track: &crate::billboard::matching::Track| {
            track.regions[ViewId::FIRST] == Some(region)
                && track.regions[ViewId::SECOND] == Some(other)
        };
        counts.1 += usize::from(tracks.iter().any(is_track));
    }
    counts
}

#[test]
fn the_manual_says_how_pictures_that_are_not_clean_fare() {
    let seeds = HELD_BACK.start..HELD_BACK.start + COUNT;
    let mut table = String::from(
        "| pictures | regions, to those of clean ones | pairs that remain | right at 30° to 60° | at 90° |\n|---|--:|--:|--:|--:|\n",
    );
    let mut known: Vec<(Style, Sums)> = Vec::new();
    for row in rows() {
        let sums = measured(seeds.clone(), row.style);
        known.push((row.style, sums));
        // Clean pictures come first.
        let clean = known.iter().find(|(style, _)| *style == row.clean);
        let (_, clean) = *clean.expect("a clean one");
        let ratio = sums.regions as f64 / clean.regions as f64;
        let what = row.name;
        println!("{what}: {ratio:.2}, {sums:?}, clean {clean:?}");
        assert!(ratio <= 1.5, "{what}: {sums:?}");
        let seen = |side: usize| sums.pairs[side] as f64 / clean.pairs[side] as f64;
        for side in [0, 1] {
            assert!(seen(side) >= row.kept, "{what}: {sums:?}");
            assert!(sums.share(side) >= row.least[side], "{what}: {sums:?}");
        }
        writeln!(
            table,
            "| {what} | {ratio:.2} | {:.0} % | {:.0} % | {:.0} % |",
            100.0 * seen(0),
            100.0 * sums.share(0),
            100.0 * sums.share(1)
        )
        .expect("text");
    }
    manual::keep("painted", &table);
}

#[test]
fn gaps_in_outlines_are_closed() {
    let (mut whole, mut with_gaps) = (0, 0);
    for seed in 0..12 {
        let who = character(seed);
        let direction = Direction {
            theta: 0.0,
            phi: 0.0,
        };
        let drawn = who.true_view(direction);
        let style = Style {
            is_white: true,
            ..CLEAN
        };
        let count = |gap: f64| {
            let style = Style { gap, ..style };
            let picture = style.paint(&drawn, who.scale, seed);
            let seen = style.seen(&picture, &drawn, (who.scale, direction));
            seen.items.iter().flatten().count()
        };
        whole += count(0.0);
        with_gaps += count(0.028);
    }
    println!("{whole} regions, {with_gaps} of them with gaps");
    assert!(
        whole > 80 && with_gaps * 20 >= whole * 17,
        "{with_gaps} of {whole}"
    );
}

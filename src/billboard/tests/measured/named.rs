//! Names in pictures: what the matcher gets wrong, two texts make right.

use std::fmt::Write as _;
use std::io::Cursor;
use std::sync::Arc;

use glam::DVec2;
use image::ImageFormat;
use typed_index_collections::TiVec;

use super::painted::{Seen, Style};
use crate::billboard::region::{Direction, RegionId, View};
use crate::billboard::tests::generated::{Drawn, character};
use crate::compile::{Compiled, Options, compile};
use crate::resolver::{LinkError, Resolver};
use crate::scene::ViewId;

const BOTH: [ViewId; 2] = [ViewId::FIRST, ViewId::SECOND];
const STYLE: Style = Style {
    height: 240.0,
    is_outlined: true,
    is_white: false,
    gap: 0.0,
    shading: 0.0,
    noise: 0.0,
    jpeg: None,
};
/// How far apart the pictures are, pixels.
const GAP: f64 = 20.0;

/// Two pictures, `0` and `1`.
struct Pictures([Arc<[u8]>; 2]);

impl Pictures {
    /// Of two views of a character that is so large.
    fn of(drawn: &[Drawn; 2], scale: f64, seed: u64) -> Self {
        Self(drawn.each_ref().map(|drawn| {
            let mut file = Cursor::new(Vec::new());
            let picture = STYLE.paint(drawn, scale, seed);
            picture
                .write_to(&mut file, ImageFormat::Png)
                .expect("a file");
            file.into_inner().into()
        }))
    }
}

impl Resolver for Pictures {
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError> {
        match link {
            "0" => Ok(Arc::clone(&self.0[0])),
            "1" => Ok(Arc::clone(&self.0[1])),
            _ => Err(LinkError::Missing),
        }
    }
}

/// A drawing of two pictures, each with texts at places in it, pixels.
fn drawing(theta: f64, texts: [&[(DVec2, String)]; 2]) -> String {
    let [width, height] = STYLE.size();
    let step = f64::from(width) + GAP;
    let mut text = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="{}" height="{height}">"#,
        2.0 * step
    );
    for (view, theta) in [0.0, theta].into_iter().enumerate() {
        let left = view as f64 * step;
        let _ = write!(
            text,
            r#"<g id="view-{view}"><image href="{view}" x="{left}" width="{width}" height="{height}"/><text x="{left}" y="8" font-size="8">Who$View {theta} 0</text>"#
        );
        for (point, said) in texts[view] {
            let (x, y) = (left + point.x, point.y);
            // So small that it lies where it begins.
            let _ = write!(
                text,
                r#"<text x="{x}" y="{y}" font-size=".01" text-anchor="middle">{said}</text>"#
            );
        }
        text.push_str("</g>");
    }
    text.push_str("</svg>");
    text
}

fn compiled(theta: f64, texts: [&[(DVec2, String)]; 2], pictures: &Pictures) -> Compiled {
    let found = compile(&drawing(theta, texts), &Options::default(), pictures);
    assert_eq!(found.characters.len(), 1, "{:?}", found.diagnostics);
    assert!(!found.has_errors(), "{:?}", found.diagnostics);
    found
}

/// Whether two regions are one in a character.
fn is_pair(compiled: &Compiled, pair: [RegionId; 2]) -> bool {
    let mut tracks = compiled.characters[0].matching.tracks.iter();
    tracks.any(|track| BOTH.map(|view| track.regions[view]) == pair.map(Some))
}

#[test]
fn naming_a_wrong_pair_makes_it_right() {
    let (mut wrong, mut named) = (0, 0);
    for seed in 0..8 {
        let who = character(seed);
        let theta = [60.0, -75.0, 90.0, -90.0][seed as usize % 4];
        let directions = [0.0, theta].map(|theta| Direction { theta, phi: 0.0 });
        let drawn = directions.map(|direction| who.true_view(direction));
        let pictures = Pictures::of(&drawn, who.scale, seed);
        let plain = compiled(theta, [&[], &[]], &pictures);
        // The regions as they are on the page, moved into each picture.
        let seen: Vec<Seen> = (plain.characters[0].views.iter().zip(&drawn).enumerate())
            .map(|(index, (view, drawn))| {
                let left = index as f64 * (f64::from(STYLE.size()[0]) + GAP);
                STYLE.of_view(moved(view, -left), drawn, who.scale)
            })
            .collect();
        let pairs = seen[0].items.iter_enumerated().filter_map(|(first, item)| {
            let item = (*item)?;
            let second = seen[1].items.position(|other| *other == Some(item))?;
            Some((item, [first, second]))
        });
        for (item, pair) in pairs.filter(|(_, pair)| !is_pair(&plain, *pair)) {
            wrong += 1;
            let places = [0, 1].map(|view| seen[view].points[pair[view]]);
            let [Some(first), Some(second)] = places else {
                continue;
            };
            let texts = [first, second].map(|at| [(at, format!("N{item}"))]);
            let again = compiled(theta, [&texts[0], &texts[1]], &pictures);
            assert!(is_pair(&again, pair), "seed {seed}, item {item}");
            let model = again.characters[0].regions.iter();
            let mut model = model.filter(|model| model.name == format!("N{item}"));
            assert!(model.next().is_some() && model.next().is_none());
            named += 1;
        }
    }
    println!("{wrong} pairs are wrong, {named} of them were named");
    assert!(named >= 3, "{named} of {wrong}");
}

#[test]
fn what_a_picture_shows_can_be_hidden() {
    for seed in 0..2 {
        let who = character(seed);
        let directions = [0.0, 45.0].map(|theta| Direction { theta, phi: 0.0 });
        let drawn = directions.map(|direction| who.true_view(direction));
        let pictures = Pictures::of(&drawn, who.scale, seed);
        let plain = compiled(45.0, [&[], &[]], &pictures);
        let seen = STYLE.of_view(
            plain.characters[0].views[ViewId::FIRST].clone(),
            &drawn[0],
            who.scale,
        );
        let count = seen.view.regions.len();
        let named = seen.points.iter().flatten().take(4);
        let texts: Vec<(DVec2, String)> = named
            .enumerate()
            .map(|(index, at)| (*at, format!("N{index}$Hidden")))
            .collect();
        assert_eq!(texts.len(), 4);
        let hidden = compiled(45.0, [&texts, &[]], &pictures);
        let view = &hidden.characters[0].views[ViewId::FIRST];
        assert_eq!(view.regions.len(), count);
        for (id, region) in view.regions.iter_enumerated() {
            // Hidden ones come first, so that they lie on nothing that is seen.
            let is_hidden = region.name.is_some();
            assert_eq!(
                is_hidden,
                usize::from(id) < texts.len(),
                "{:?}",
                region.name
            );
            assert!(region.container.is_none_or(|outer| outer < id));
        }
        let outlines = |view: &View| {
            let mut all: Vec<String> = (view.regions.iter())
                .map(|region| format!("{:?}", region.outline))
                .collect();
            all.sort();
            all
        };
        assert_eq!(outlines(view), outlines(&seen.view));
        let flags = hidden.characters[0].regions.iter();
        assert_eq!(
            flags
                .filter(|region| region.is_hidden[ViewId::FIRST])
                .count(),
            4
        );
    }
}

/// A view whose regions are so much farther right.
fn moved(view: &View, by: f64) -> View {
    let mut view = view.clone();
    let regions: TiVec<RegionId, _> = std::mem::take(&mut view.regions);
    view.regions = regions
        .into_iter()
        .map(|mut region| {
            let outline = region.outline.map_rings(|ring| {
                ring.iter()
                    .map(|point| *point + DVec2::new(by, 0.0))
                    .collect()
            });
            region.outline = outline.into();
            region
        })
        .collect();
    view
}

//! From what is painted to the map: each cell gets the index of its look.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::looks::{Meaning, Paints, TileLook};
use super::raster::{Canvas, Code, NOTHING, paint_of};
use crate::svg::PaintKey;
use crate::terrain::Tile;

/// The most paints that each have a look of their own; in a layer with more, as painted by hand or photographed, each
/// kind has one, of their mean colour.
const MOST_PAINTS: usize = 200;
/// The most legends whose tiles have a look of their own where paints have none.
const MOST_LEGENDS: usize = 240;
/// The most unclear colours that are told apart in one stretch of a layer.
const MOST_UNCLEAR: usize = 4096;
/// Codes whose meaning is remembered in one stretch of a layer.
const MOST_KNOWN: usize = 1 << 16;
/// Cells that are remembered by place.
const PLACES: usize = 3;

/// In how many cells something is, and the first ones.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Tally {
    pub(super) count: usize,
    /// Indices of cells.
    pub(super) first: Vec<usize>,
}

impl Tally {
    fn add(&mut self, cell: usize) {
        self.count += 1;
        if self.first.len() < PLACES {
            self.first.push(cell);
        }
    }

    /// Takes in what was counted further down.
    fn append(&mut self, other: Self) {
        self.count += other.count;
        let room = PLACES.saturating_sub(self.first.len());
        self.first.extend(other.first.into_iter().take(room));
    }
}

/// What a layer shows.
pub(super) struct Survey {
    /// Per cell the index of its look.
    pub(super) cells: Vec<u8>,
    pub(super) looks: Vec<TileLook>,
    /// The unclear colours, the ones in most cells first.
    pub(super) unclear: Vec<(Code, Tally)>,
    /// Indices of the legends whose paint is in some cell, in order.
    pub(super) legends: Vec<usize>,
    /// Indices of the gradients and patterns, among the paints, that are in some cell with their mean colour, in order.
    pub(super) plain: Vec<usize>,
    /// Whether so many legends are used that some were not heeded.
    pub(super) too_many_legends: bool,
}

/// Looks at every cell.
pub(super) fn survey(canvas: &Canvas<'_>, paints: &Paints<'_>, cells: Vec<u8>) -> Survey {
    let mut cells = cells;
    match few(canvas, &mut cells) {
        Some(bands) => one_by_one(canvas, paints, cells, bands),
        None => by_kind(canvas, paints, cells),
    }
}

/// The codes in a band, in the order in which they come; a cell's byte is their place among them, 1 for the first.
type Found = Vec<(Code, Tally)>;

/// Looks which codes there are, band by band; `None` if they are many.
fn few(canvas: &Canvas<'_>, cells: &mut [u8]) -> Option<Vec<Found>> {
    let bands = canvas.bands(cells, |band, cells| {
        let mut found: Found = Vec::new();
        let mut known: FxHashMap<Code, u8> = FxHashMap::default();
        let mut last = (NOTHING, 0);
        band.draw(|place, cell, codes| {
            if known.len() > MOST_PAINTS {
                return;
            }
            for (offset, code) in codes.iter().enumerate() {
                if *code != last.0 {
                    let next = found.len();
                    let number = match *code {
                        NOTHING => 0,
                        code => *known.entry(code).or_insert_with(|| {
                            if next < MOST_PAINTS {
                                found.push((code, Tally::default()));
                            }
                            (next + 1).min(MOST_PAINTS + 1) as u8
                        }),
                    };
                    last = (*code, number);
                    if known.len() > MOST_PAINTS {
                        return;
                    }
                }
                if last.1 != 0 {
                    cells[place + offset] = last.1;
                    found[usize::from(last.1) - 1].1.add(cell + offset);
                }
            }
        });
        (known.len() <= MOST_PAINTS).then_some(found)
    });
    bands.into_iter().collect()
}

/// A look for each paint.
fn one_by_one(
    canvas: &Canvas<'_>,
    paints: &Paints<'_>,
    mut cells: Vec<u8>,
    bands: Vec<Found>,
) -> Survey {
    let mut all: BTreeMap<Code, Tally> = BTreeMap::new();
    for (code, tally) in bands.iter().flatten() {
        all.entry(*code).or_default().append(tally.clone());
    }
    if all.len() > MOST_PAINTS {
        cells.fill(0);
        return by_kind(canvas, paints, cells);
    }
    let mut survey = Survey::new();
    // By kind and paint, so that looks do not depend on what lies where.
    let mut drawn: BTreeMap<(Tile, PaintKey, u64), Vec<(Code, Meaning)>> = BTreeMap::new();
    for (code, tally) in all {
        let meaning = paints.meaning(code);
        survey.legends.extend(meaning.legend);
        let key = match paint_of(code) {
            Some(paint) => paints.list[paint].key.clone(),
            None => PaintKey::Solid(meaning.color),
        };
        match meaning.tile {
            None => survey.unclear.push((code, tally)),
            Some(Tile::None) => {}
            Some(tile) => {
                let same = drawn.entry((tile, key, meaning.opacity.to_bits()));
                same.or_default().push((code, meaning));
            }
        }
    }
    let mut look_of: FxHashMap<Code, u8> = FxHashMap::default();
    for ((tile, key, _), same) in drawn {
        // A pixel and a shape may show the same.
        let Some((code, meaning)) = same.first() else {
            continue;
        };
        let color = meaning.color.map(f64::from);
        let look = paints.look(tile, meaning.legend, color, meaning.opacity);
        let is_plain = look.texture.is_none() && !look.is_tinted;
        let is_server = matches!(key, PaintKey::Server(_));
        survey
            .plain
            .extend(paint_of(*code).filter(|_| is_plain && is_server));
        look_of.extend(
            same.iter()
                .map(|(code, _)| (*code, survey.looks.len() as u8)),
        );
        survey.looks.push(look);
    }
    let tables: Vec<Vec<u8>> = bands
        .iter()
        .map(|found| {
            let looks = found.iter().map(|(code, _)| look_of.get(code).copied());
            std::iter::once(0)
                .chain(looks.map(Option::unwrap_or_default))
                .collect()
        })
        .collect();
    canvas.remap(&mut cells, &tables);
    survey.finish(cells)
}

/// A look for each kind, and for each legend.
fn by_kind(canvas: &Canvas<'_>, paints: &Paints<'_>, mut cells: Vec<u8>) -> Survey {
    const KINDS: usize = Tile::DRAWN.len();
    let number = |meaning: Meaning| -> u8 {
        let Some(kind) = Tile::DRAWN
            .iter()
            .position(|tile| Some(*tile) == meaning.tile)
        else {
            return 0;
        };
        let legend = meaning.legend.filter(|legend| *legend < MOST_LEGENDS);
        legend.map_or(kind + 1, |legend| KINDS + 1 + legend) as u8
    };
    let bands = canvas.bands(&mut cells, |band, cells| {
        let mut known: FxHashMap<Code, (u8, Option<Tile>)> = FxHashMap::default();
        let mut sums = vec![Sum::default(); 256];
        let mut legends: BTreeMap<usize, ()> = BTreeMap::new();
        let mut unclear: FxHashMap<Code, Tally> = FxHashMap::default();
        band.draw(|place, cell, codes| {
            for (offset, code) in codes.iter().enumerate() {
                if *code == NOTHING {
                    continue;
                }
                if known.len() > MOST_KNOWN {
                    known.clear();
                }
                let (look, tile) = *known.entry(*code).or_insert_with(|| {
                    let meaning = paints.meaning(*code);
                    legends.extend(meaning.legend.map(|legend| (legend, ())));
                    (number(meaning), meaning.tile)
                });
                if tile.is_none() && (unclear.len() < MOST_UNCLEAR || unclear.contains_key(code)) {
                    unclear.entry(*code).or_default().add(cell + offset);
                }
                cells[place + offset] = look;
                sums[usize::from(look)].add(paints, *code);
            }
        });
        (sums, legends, unclear)
    });
    let mut survey = Survey::new();
    let mut sums = vec![Sum::default(); 256];
    let mut unclear: BTreeMap<Code, Tally> = BTreeMap::new();
    for (band_sums, legends, found) in bands {
        sums.iter_mut()
            .zip(band_sums)
            .for_each(|(sum, other)| sum.append(other));
        survey.legends.extend(legends.into_keys());
        let mut found: Vec<(Code, Tally)> = found.into_iter().collect();
        found.sort_by_key(|(code, _)| *code);
        for (code, tally) in found {
            unclear.entry(code).or_default().append(tally);
        }
    }
    survey.unclear = unclear.into_iter().collect();
    survey.too_many_legends = survey.legends.iter().any(|legend| *legend >= MOST_LEGENDS);
    let mut table = vec![0; 256];
    for (index, sum) in sums
        .iter()
        .enumerate()
        .skip(1)
        .filter(|(_, sum)| sum.count > 0)
    {
        let legend = index.checked_sub(KINDS + 1);
        let color = sum.color.map(|channel| channel as f64 / sum.count as f64);
        let tile = match legend {
            Some(_) => sum.tile,
            None => Tile::DRAWN[index - 1],
        };
        table[index] = survey.looks.len() as u8;
        let opacity = sum.opacity / sum.count as f64;
        survey.looks.push(paints.look(tile, legend, color, opacity));
    }
    for cell in &mut cells {
        *cell = table[usize::from(*cell)];
    }
    survey.finish(cells)
}

/// What cells of one look have in common.
#[derive(Clone, Default)]
struct Sum {
    color: [u64; 3],
    opacity: f64,
    count: u64,
    tile: Tile,
}

impl Sum {
    fn add(&mut self, paints: &Paints<'_>, code: Code) {
        let (color, opacity) = paints.appearance(code);
        (0..3).for_each(|channel| self.color[channel] += u64::from(color[channel]));
        self.opacity += opacity;
        if self.count == 0 {
            self.tile = paints.meaning(code).tile.unwrap_or_default();
        }
        self.count += 1;
    }

    fn append(&mut self, other: Self) {
        (0..3).for_each(|channel| self.color[channel] += other.color[channel]);
        self.opacity += other.opacity;
        if self.count == 0 {
            self.tile = other.tile;
        }
        self.count += other.count;
    }
}

impl Survey {
    fn new() -> Self {
        Self {
            cells: Vec::new(),
            looks: vec![TileLook::none()],
            unclear: Vec::new(),
            legends: Vec::new(),
            plain: Vec::new(),
            too_many_legends: false,
        }
    }

    fn finish(mut self, cells: Vec<u8>) -> Self {
        self.cells = cells;
        self.unclear
            .sort_by(|(one, a), (other, b)| b.count.cmp(&a.count).then(one.cmp(other)));
        for list in [&mut self.legends, &mut self.plain] {
            list.sort_unstable();
            list.dedup();
        }
        self
    }
}

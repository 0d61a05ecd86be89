//! Classifies the painted cells: each gets the index of its material.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::colors::Named;
use super::materials::{Meaning, Paints, TileMaterial};
use super::raster::{Canvas, Code, NOTHING, paint_of};
use crate::svg::PaintKey;
use crate::terrain::Tile;

/// The largest number of paints that each have their own material. In a layer with more, such as a photograph, each kind has
/// one material of the mean colour.
const MAX_PAINTS: usize = 200;
/// The largest number of legends that have their own material where paints have none.
const MAX_LEGENDS: usize = 240;
/// The largest number of unclear colours that are distinguished in a band.
const MAX_UNCLEAR: usize = 4096;
/// The largest number of codes whose meaning is cached in a band.
const MAX_CACHED: usize = 1 << 16;
/// The number of cells that are listed one by one.
const PLACES: usize = 3;

/// A number of cells, and the first ones.
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

    /// Adds the tally of a later band.
    fn append(&mut self, other: Self) {
        self.count += other.count;
        let room = PLACES.saturating_sub(self.first.len());
        self.first.extend(other.first.into_iter().take(room));
    }
}

/// The cells of a layer with their materials.
pub(super) struct Classification {
    /// Per cell the index of its material.
    pub(super) cells: Vec<u8>,
    pub(super) materials: Vec<TileMaterial>,
    /// The unclear colours, those in most cells first.
    pub(super) unclear: Vec<(Code, Tally)>,
    /// Indices of the legends whose paint is used, in order.
    pub(super) legends: Vec<usize>,
    /// Indices of the paints that are gradients or patterns and are used with their mean colour, in order.
    pub(super) plain: Vec<usize>,
    /// Whether so many legends are used that some were ignored.
    pub(super) too_many_legends: bool,
}

/// Classifies every cell.
pub(super) fn classify(canvas: &Canvas<'_>, paints: &Paints<'_>, cells: Vec<u8>) -> Classification {
    let mut cells = cells;
    match tally_codes(canvas, &mut cells) {
        Some(bands) => material_per_paint(canvas, paints, cells, bands),
        None => material_per_kind(canvas, paints, cells),
    }
}

/// The codes of a band in the order in which they occur. A cell's byte is the index of its code plus 1.
type CodeTallies = Vec<(Code, Tally)>;

/// Collects the codes of each band; `None` if a band has more than [`MAX_PAINTS`].
fn tally_codes(canvas: &Canvas<'_>, cells: &mut [u8]) -> Option<Vec<CodeTallies>> {
    let bands = canvas.bands(cells, |band, cells| {
        let mut found: CodeTallies = Vec::new();
        let mut known: FxHashMap<Code, u8> = FxHashMap::default();
        let mut last = (NOTHING, 0);
        band.draw(|place, cell, codes| {
            if known.len() > MAX_PAINTS {
                return;
            }
            for (offset, code) in codes.iter().enumerate() {
                if *code != last.0 {
                    let next = found.len();
                    let number = match *code {
                        NOTHING => 0,
                        code => *known.entry(code).or_insert_with(|| {
                            if next < MAX_PAINTS {
                                found.push((code, Tally::default()));
                            }
                            (next + 1).min(MAX_PAINTS + 1) as u8
                        }),
                    };
                    last = (*code, number);
                    if known.len() > MAX_PAINTS {
                        return;
                    }
                }
                if last.1 != 0 {
                    cells[place + offset] = last.1;
                    found[usize::from(last.1) - 1].1.add(cell + offset);
                }
            }
        });
        (known.len() <= MAX_PAINTS).then_some(found)
    });
    bands.into_iter().collect()
}

/// A material for each paint.
fn material_per_paint(
    canvas: &Canvas<'_>,
    paints: &Paints<'_>,
    mut cells: Vec<u8>,
    bands: Vec<CodeTallies>,
) -> Classification {
    let mut all: BTreeMap<Code, Tally> = BTreeMap::new();
    for (code, tally) in bands.iter().flatten() {
        all.entry(*code).or_default().append(tally.clone());
    }
    if all.len() > MAX_PAINTS {
        cells.fill(0);
        return material_per_kind(canvas, paints, cells);
    }
    let mut classification = Classification::new();
    // Sorted by kind and paint, so that the order of materials does not depend on the cells.
    let mut drawn: BTreeMap<(Named, PaintKey, u64), Vec<(Code, Meaning)>> = BTreeMap::new();
    for (code, tally) in all {
        let meaning = paints.meaning(code);
        classification.legends.extend(meaning.legend);
        let key = match paint_of(code) {
            Some(paint) => paints.list[paint].key.clone(),
            None => PaintKey::Solid(meaning.color),
        };
        match meaning.named {
            None => classification.unclear.push((code, tally)),
            Some(Named::Tile(Tile::None)) => {}
            Some(named) => {
                let same = drawn.entry((named, key, meaning.opacity.to_bits()));
                same.or_default().push((code, meaning));
            }
        }
    }
    let mut material_of: FxHashMap<Code, u8> = FxHashMap::default();
    for ((named, key, _), same) in drawn {
        // A pixel and a shape may have the same colour.
        let Some((code, meaning)) = same.first() else {
            continue;
        };
        let color = meaning.color.map(f64::from);
        let material = paints.material(named, meaning.legend, color, meaning.opacity);
        let is_plain = material.texture.is_none() && !material.is_tinted;
        let is_server = matches!(key, PaintKey::Server(_));
        classification
            .plain
            .extend(paint_of(*code).filter(|_| is_plain && is_server));
        material_of.extend(
            same.iter()
                .map(|(code, _)| (*code, classification.materials.len() as u8)),
        );
        classification.materials.push(material);
    }
    let tables: Vec<Vec<u8>> = bands
        .iter()
        .map(|found| {
            let materials = found.iter().map(|(code, _)| material_of.get(code).copied());
            std::iter::once(0)
                .chain(materials.map(Option::unwrap_or_default))
                .collect()
        })
        .collect();
    canvas.remap(&mut cells, &tables);
    classification.finish(cells)
}

/// A material for each kind, and for each legend.
fn material_per_kind(
    canvas: &Canvas<'_>,
    paints: &Paints<'_>,
    mut cells: Vec<u8>,
) -> Classification {
    const KINDS: usize = Named::ALL.len();
    let number = |meaning: Meaning| -> u8 {
        let Some(kind) = Named::ALL
            .iter()
            .position(|named| Some(*named) == meaning.named)
        else {
            return 0;
        };
        let legend = meaning.legend.filter(|legend| *legend < MAX_LEGENDS);
        legend.map_or(kind + 1, |legend| KINDS + 1 + legend) as u8
    };
    let bands = canvas.bands(&mut cells, |band, cells| {
        let mut known: FxHashMap<Code, (u8, bool)> = FxHashMap::default();
        let mut sums = vec![Sum::default(); 256];
        let mut legends: BTreeMap<usize, ()> = BTreeMap::new();
        let mut unclear: FxHashMap<Code, Tally> = FxHashMap::default();
        band.draw(|place, cell, codes| {
            for (offset, code) in codes.iter().enumerate() {
                if *code == NOTHING {
                    continue;
                }
                if known.len() > MAX_CACHED {
                    known.clear();
                }
                let (material, is_unclear) = *known.entry(*code).or_insert_with(|| {
                    let meaning = paints.meaning(*code);
                    legends.extend(meaning.legend.map(|legend| (legend, ())));
                    (number(meaning), meaning.named.is_none())
                });
                if is_unclear && (unclear.len() < MAX_UNCLEAR || unclear.contains_key(code)) {
                    unclear.entry(*code).or_default().add(cell + offset);
                }
                cells[place + offset] = material;
                sums[usize::from(material)].add(paints, *code);
            }
        });
        (sums, legends, unclear)
    });
    let mut classification = Classification::new();
    let mut sums = vec![Sum::default(); 256];
    let mut unclear: BTreeMap<Code, Tally> = BTreeMap::new();
    for (band_sums, legends, found) in bands {
        sums.iter_mut()
            .zip(band_sums)
            .for_each(|(sum, other)| sum.append(other));
        classification.legends.extend(legends.into_keys());
        let mut found: Vec<(Code, Tally)> = found.into_iter().collect();
        found.sort_by_key(|(code, _)| *code);
        for (code, tally) in found {
            unclear.entry(code).or_default().append(tally);
        }
    }
    classification.unclear = unclear.into_iter().collect();
    classification.too_many_legends = classification
        .legends
        .iter()
        .any(|legend| *legend >= MAX_LEGENDS);
    let mut table = vec![0; 256];
    for (index, sum) in sums
        .iter()
        .enumerate()
        .skip(1)
        .filter(|(_, sum)| sum.count > 0)
    {
        let legend = index.checked_sub(KINDS + 1);
        let color = sum.color.map(|channel| channel as f64 / sum.count as f64);
        let named = match legend {
            Some(_) => sum.named,
            None => Named::ALL[index - 1],
        };
        table[index] = classification.materials.len() as u8;
        let opacity = sum.opacity / sum.count as f64;
        classification
            .materials
            .push(paints.material(named, legend, color, opacity));
    }
    for cell in &mut cells {
        *cell = table[usize::from(*cell)];
    }
    classification.finish(cells)
}

/// The sum of the colours of the cells of one material.
#[derive(Clone, Default)]
struct Sum {
    color: [u64; 3],
    opacity: f64,
    count: u64,
    named: Named,
}

impl Sum {
    fn add(&mut self, paints: &Paints<'_>, code: Code) {
        let (color, opacity) = paints.appearance(code);
        (0..3).for_each(|channel| self.color[channel] += u64::from(color[channel]));
        self.opacity += opacity;
        if self.count == 0 {
            self.named = paints.meaning(code).named.unwrap_or_default();
        }
        self.count += 1;
    }

    fn append(&mut self, other: Self) {
        (0..3).for_each(|channel| self.color[channel] += other.color[channel]);
        self.opacity += other.opacity;
        if self.count == 0 {
            self.named = other.named;
        }
        self.count += other.count;
    }
}

impl Classification {
    fn new() -> Self {
        Self {
            cells: Vec::new(),
            materials: vec![TileMaterial::none()],
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

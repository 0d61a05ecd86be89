//! Legends: swatches whose attributes hold for all parts and tiles of a paint.

use rustc_hash::FxHashMap;
use typed_index_collections::TiSlice;

use super::PartAttributes;
use crate::bind::bindings::{DrawingString, PartKind, StringId};
use crate::bind::matching::{Matched, MatchedPart};
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::keyword::Keyword;
use crate::lang::value::Setting;
use crate::svg::{Drawing, PaintKey, ShapeId};

/// A legend: the attributes of all parts and tiles of a paint.
#[derive(Debug)]
pub struct Legend {
    /// The paint.
    pub paint: PaintKey,
    /// Its settings, each with its string.
    pub settings: Vec<(StringId, Setting)>,
    /// The shape beside which it stands.
    pub swatch: ShapeId,
    /// Its string, the first one if there are several.
    pub string: StringId,
    /// Whether a part or a drawn tile has the paint. Colours in pictures of tile layers do not count.
    pub is_used: bool,
}

/// Merges the legends by paint and gives them to the parts of that paint.
pub(super) fn merge(
    drawing: &Drawing,
    matched: &Matched,
    diagnostics: &mut Vec<Diagnostic>,
) -> PartAttributes {
    let Matched { strings, parts, .. } = matched;
    let mut legends: Vec<Legend> = Vec::new();
    let mut by_paint: FxHashMap<&PaintKey, usize> = FxHashMap::default();
    for (index, part) in parts.iter_enumerated() {
        let is_sample = matched.kinds[index] == PartKind::Legend && part.main == index;
        let Some(string) = part.string.filter(|_| is_sample) else {
            continue;
        };
        let paint = &part.paint(drawing).key;
        let settings = strings[string].settings.iter();
        let settings = settings.map(|setting| (string, setting.clone()));
        if let Some(legend) = by_paint.get(paint) {
            let legend = &mut legends[*legend];
            let message = "this legend's paint has a legend already; where both set an attribute, this one counts";
            let [place, other] = [string, legend.string].map(|string| strings[string].text.whole());
            diagnostics.push(
                Diagnostic::new(Code::TwoLegends, place, message)
                    .related(other, "the other legend")
                    .help("give the sample another colour, or combine both strings"),
            );
            for (string, setting) in settings {
                let settings = &mut legend.settings;
                settings.retain(|(_, old)| old.keyword != setting.keyword);
                settings.push((string, setting));
            }
            continue;
        }
        by_paint.insert(paint, legends.len());
        legends.push(Legend {
            paint: paint.clone(),
            settings: settings.collect(),
            swatch: part.shape,
            string,
            is_used: false,
        });
    }
    let legend_of = |(part, kind): (&MatchedPart, &PartKind)| {
        if !(kind.is_solid() || *kind == PartKind::Tile) {
            return None;
        }
        let legend = *by_paint.get(&part.paint(drawing).key)?;
        // Parts have no use for a legend about tiles.
        let has_use = *kind == PartKind::Tile || !legends[legend].is_for_tiles();
        legends[legend].is_used |= has_use;
        Some(legend)
    };
    PartAttributes {
        legend_of_part: parts.iter().zip(&matched.kinds).map(legend_of).collect(),
        legends,
    }
}

impl Legend {
    /// Whether it says what tiles of its paint are, or how high.
    fn is_for_tiles(&self) -> bool {
        let mut settings = self.settings.iter();
        settings.any(|(_, setting)| matches!(setting.keyword, Keyword::Tile | Keyword::Height))
    }

    /// Reports that nothing has the legend's paint.
    pub fn unused(
        &self,
        drawing: &Drawing,
        strings: &TiSlice<StringId, DrawingString>,
    ) -> Diagnostic {
        let swatch = &drawing.shapes[self.swatch].element;
        let what = if self.is_for_tiles() { "tile" } else { "part" };
        let swatch_name = drawing.describe(self.swatch);
        let message = format!("no {what} has the paint of this legend, {swatch_name}");
        let place = strings[self.string].text.whole();
        Diagnostic::new(Code::UnusedLegend, place, message)
        .related(swatch.span, "the legend")
        .help(if self.is_for_tiles() { "pick the sample's colour from the tiles with the colour picker, or delete the legend" } else { "pick the sample's colour from the parts with the colour picker; if the attributes are for the shape itself, write its name before `$`" })
    }
}

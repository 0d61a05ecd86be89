//! Legends: swatches whose attributes hold for all parts and tiles of a paint.

use rustc_hash::FxHashMap;

use super::bindings::{Bindings, Part, PartKind};
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::keyword::Keyword;
use crate::lang::value::Setting;
use crate::svg::{Drawing, PaintKey};

/// A legend: the attributes of all parts and tiles of a paint.
#[derive(Debug)]
pub struct Legend {
    /// The paint.
    pub paint: PaintKey,
    /// Its settings, each with the index of its string.
    pub settings: Vec<(usize, Setting)>,
    /// Index of the shape beside which it stands.
    pub swatch: usize,
    /// Index of its string, the first one if there are several.
    pub string: usize,
    /// Whether a part or a drawn tile has the paint. Colours in pictures of tile layers do not count.
    pub is_used: bool,
}

/// Merges the legends by paint and gives them to the parts of that paint.
pub(super) fn merge(drawing: &Drawing, bindings: &mut Bindings, diagnostics: &mut Vec<Diagnostic>) {
    let mut by_paint: FxHashMap<&PaintKey, usize> = FxHashMap::default();
    let is_sample = |part: &&Part| part.kind == PartKind::Legend && part.is_candidate();
    for part in bindings.parts.iter().filter(is_sample) {
        let Some(string) = part.string else { continue };
        let paint = &part.paint(drawing).key;
        let settings = bindings.strings[string].settings.iter();
        let settings = settings.map(|setting| (string, setting.clone()));
        if let Some(legend) = by_paint.get(paint) {
            let first = bindings.legends[*legend].string;
            let message = "this legend's paint has a legend already; where both set an attribute, this one counts";
            let [place, other] =
                [string, first].map(|string| bindings.strings[string].text.whole());
            diagnostics.push(
                Diagnostic::new(Code::TwoLegends, place, message)
                    .related(other, "the other legend")
                    .help("give the sample another colour, or combine both strings"),
            );
            let legend: &mut Legend = &mut bindings.legends[*legend];
            for (string, setting) in settings {
                let settings = &mut legend.settings;
                settings.retain(|(_, old)| old.keyword != setting.keyword);
                settings.push((string, setting));
            }
            continue;
        }
        by_paint.insert(paint, bindings.legends.len());
        bindings.legends.push(Legend {
            paint: paint.clone(),
            settings: settings.collect(),
            swatch: part.shape,
            string,
            is_used: false,
        });
    }
    for part in &mut bindings.parts {
        let is_tile = part.kind == PartKind::Tile;
        if (is_tile || matches!(part.kind, PartKind::Main | PartKind::Sub))
            && let Some(index) = by_paint.get(&part.paint(drawing).key)
        {
            part.legend = Some(*index);
            let legend = &mut bindings.legends[*index];
            // Parts have no use for a legend about tiles.
            legend.is_used |= is_tile || !legend.is_for_tiles();
        }
    }
    let shapes = 0..drawing.shapes.len();
    let mut pictures = shapes.filter(|shape| bindings.is_picture_of_layer(drawing, *shape));
    let has_maps = pictures.next().is_some();
    for legend in &bindings.legends {
        // The colours of pictures are known only when the tile layers are read.
        let may_be_used = has_maps && matches!(legend.paint, PaintKey::Solid(_));
        if !legend.is_used && !may_be_used {
            diagnostics.push(legend.unused(drawing, bindings));
        }
    }
}

impl Legend {
    /// Whether it says what tiles of its paint are.
    fn is_for_tiles(&self) -> bool {
        let mut settings = self.settings.iter();
        settings.any(|(_, setting)| setting.keyword == Keyword::Tile)
    }

    /// Reports that nothing has the legend's paint.
    pub fn unused(&self, drawing: &Drawing, bindings: &Bindings) -> Diagnostic {
        let swatch = &drawing.shapes[self.swatch].element;
        let what = match self.is_for_tiles() {
            true => "tile",
            false => "part",
        };
        let swatch_name = drawing.describe(self.swatch);
        let message = format!("no {what} has the paint of this legend, {swatch_name}");
        let place = bindings.strings[self.string].text.whole();
        Diagnostic::new(Code::UnusedLegend, place, message)
        .related(swatch.span, "the legend")
        .help(match self.is_for_tiles() {
            true => "pick the sample's colour from the tiles with the colour picker, or delete the legend",
            false => {
                "pick the sample's colour from the parts with the colour picker; if the attributes are for the shape itself, write its name before `$`"
            }
        })
    }
}

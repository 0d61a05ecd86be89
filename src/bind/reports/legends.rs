//! Legends whose paint nothing has.

use crate::bind::attributes::PartAttributes;
use crate::bind::matching::Matched;
use crate::diagnostic::Diagnostic;
use crate::svg::{Drawing, PaintKey};

/// Reports the legends that are not used.
pub(super) fn unused(
    drawing: &Drawing,
    matched: &Matched,
    attributes: &PartAttributes,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let mut shapes = drawing.shapes.keys();
    let has_maps = shapes.any(|shape| matched.layers.hold_picture(drawing, shape));
    for legend in &attributes.legends {
        // The colors of pictures are known only when the tile layers are read.
        let may_be_used = has_maps && matches!(legend.paint, PaintKey::Solid(_));
        if !legend.is_used && !may_be_used {
            diagnostics.push(legend.unused(drawing, &matched.strings));
        }
    }
}

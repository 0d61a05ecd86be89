//! Where on the page the texts and shapes are that diagnostics are about.

use std::collections::BTreeMap;

use crate::bind::describe::place;
use crate::diagnostic::Diagnostic;
use crate::geometry;
use crate::svg::{Drawing, Shape};

/// Says of each diagnostic about a text or a shape where on the page that is, unless its message says so.
pub(crate) fn locate(drawing: &Drawing, diagnostics: &mut [Diagnostic]) {
    if diagnostics.is_empty() {
        return;
    }
    let mut by_start: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (index, diagnostic) in diagnostics.iter().enumerate() {
        by_start
            .entry(diagnostic.span.start)
            .or_default()
            .push(index);
    }
    let mut set = |from: usize, to: usize, place: &dyn Fn() -> Option<&'static str>| {
        for index in by_start.range(from..=to).flat_map(|(_, indices)| indices) {
            let diagnostic = &mut diagnostics[*index];
            let place = place().map(str::trim_start);
            let is_said = |place: &str| {
                let short = place.strip_suffix(" of the page").unwrap_or(place);
                diagnostic.message.contains(short)
            };
            diagnostic.on_page = place.filter(|place| !is_said(place));
        }
    };
    for (label, _) in &drawing.labels {
        let whole = label.text.whole();
        let bounds = label.position.bounds;
        let place = || place(bounds, drawing.page);
        set(whole.start, whole.end, &place);
    }
    for shape in &drawing.shapes {
        let start = shape.element.span.start;
        let place = || place(bounds(shape)?, drawing.page);
        set(start, start, &place);
        if let Some(desc) = &shape.element.desc {
            let whole = desc.whole();
            set(whole.start, whole.end, &place);
        }
    }
}

fn bounds(shape: &Shape) -> Option<(glam::DVec2, glam::DVec2)> {
    geometry::bounds(&shape.outline).or_else(|| shape.stroke.as_ref()?.bounds())
}

//! The filled areas of parts.

use std::sync::Arc;

use super::node_groups::PartSource;
use crate::geometry::{Measure, Outline, measure};
use crate::memo::{Memo, Same};
use crate::svg::{Drawing, StrokeSource};

/// A part's outline and its measures.
#[derive(Debug, Clone)]
pub(super) struct Area {
    pub(super) outline: Arc<Outline>,
    pub(super) measure: Measure,
    /// Whether it is an island of a pair of limbs that is none of them: the name of its shape is not its own.
    pub(super) is_rest: bool,
}

/// What an area is made from: the fill or the stroke of a shape.
#[derive(Debug, PartialEq, Eq, Hash)]
enum AreaKey {
    Fill(Same<Outline>),
    Stroke(Same<StrokeSource>),
}

/// The areas of sources; `None` for those that cover nothing.
pub(super) fn areas(drawing: &Drawing, sources: &[PartSource], memo: &Memo) -> Vec<Option<Area>> {
    let key = |source: &PartSource| {
        let shape = &drawing.shapes[source.shape];
        match &shape.stroke {
            Some(stroke) if source.is_stroke => AreaKey::Stroke(Same(Arc::clone(stroke))),
            _ => AreaKey::Fill(Same(Arc::clone(&shape.outline))),
        }
    };
    memo.get_each(sources.iter().map(key).collect(), |key| {
        let outline = match key {
            AreaKey::Fill(outline) => Arc::clone(&outline.0),
            AreaKey::Stroke(stroke) => Arc::new(stroke.0.outline()),
        };
        let measure = measure(&outline)?;
        Some(Area {
            outline,
            measure,
            is_rest: false,
        })
    })
}

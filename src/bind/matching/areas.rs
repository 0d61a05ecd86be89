//! The filled areas of parts.

use std::sync::Arc;

use super::node_groups::PartSource;
use crate::geometry::{Measure, Outline, measure, union};
use crate::memo::{Long, Memo, Same};
use crate::svg::{Drawing, StrokeSource};

/// A part's outline and its measures.
#[derive(Debug, Clone)]
pub(super) struct Area {
    pub(super) outline: Arc<Outline>,
    pub(super) measure: Measure,
}

/// What an area is made from: the fill or the stroke of a shape.
#[derive(Debug, PartialEq, Eq, Hash)]
enum AreaKey {
    Fill(Same<Outline>),
    Stroke(Same<StrokeSource>),
}

/// Outlines that are made one.
#[derive(Debug, PartialEq, Eq, Hash)]
struct UnionKey(Long<Same<Outline>>);

/// The area that each list of outlines covers.
pub(in crate::bind) fn united(lists: Vec<Vec<Arc<Outline>>>, memo: &Memo) -> Vec<Arc<Outline>> {
    let key = |list: Vec<Arc<Outline>>| UnionKey(list.into_iter().map(Same).collect());
    memo.get_each(lists.into_iter().map(key).collect(), |UnionKey(list)| {
        let outlines: Vec<Outline> = list.0.iter().map(|outline| (*outline.0).clone()).collect();
        Arc::new(union(&outlines))
    })
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
        Some(Area { outline, measure })
    })
}

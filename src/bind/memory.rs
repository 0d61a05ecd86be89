//! Areas of parts, and those that are remembered.

use std::sync::Arc;

use super::bindings::Part;
use super::nearest::{Found, Question};
use super::units::Member;
use crate::geometry::{Measure, Outline, measure};
use crate::kept::Kept;
use crate::svg::{Drawing, StrokeSource};

/// What binding remembers for the next time: how the areas lie that a drawing has already had, and what is nearest.
#[derive(Debug, Default)]
pub struct Memory {
    /// Per shape its fill, and its stroke.
    areas: Vec<[Option<Area>; 2]>,
    /// For the strings in no container what they are bound to.
    pub(super) nearest: Nearest,
    /// What the parts without a string hang on.
    pub(super) hangers: Hangers,
}

/// See [`Question`].
pub(super) type Nearest = Kept<Question, Arc<[Found]>>;

/// Centres of parts that have names, with their indices, and of parts that have none; for these the nearest of those.
pub(super) type Hangers = Kept<(Vec<([f64; 2], usize)>, Vec<[f64; 2]>), Arc<[Option<usize>]>>;

/// An area and how it lies.
#[derive(Debug, Clone)]
pub(super) struct Area {
    /// What a stroke's area was made from.
    stroke: Option<Arc<StrokeSource>>,
    pub(super) outline: Arc<Outline>,
    pub(super) measure: Measure,
}

impl Memory {
    /// The area of a shape's fill or stroke, if it is what it was.
    pub(super) fn area(&self, drawing: &Drawing, member: &Member) -> Option<Area> {
        let shape = &drawing.shapes[member.shape];
        let known = self.areas.get(member.shape)?;
        let known = known[usize::from(member.is_stroke)].as_ref()?;
        let same = match (&known.stroke, &shape.stroke) {
            (Some(known), Some(stroke)) => Arc::ptr_eq(known, stroke),
            _ => Arc::ptr_eq(&known.outline, &shape.outline),
        };
        same.then(|| known.clone())
    }

    /// Remembers the areas of parts, and forgets all others.
    pub(super) fn keep(&mut self, drawing: &Drawing, parts: &[Part]) {
        self.areas.clear();
        self.areas.resize(drawing.shapes.len(), [None, None]);
        for part in parts {
            let stroke = drawing.shapes[part.shape].stroke.as_ref();
            self.areas[part.shape][usize::from(part.is_stroke)] = Some(Area {
                stroke: stroke.filter(|_| part.is_stroke).map(Arc::clone),
                outline: Arc::clone(&part.outline),
                measure: part.measure,
            });
        }
    }
}

impl Area {
    /// The area of a member, if it has one.
    pub(super) fn of(member: &Member, drawing: &Drawing) -> Option<Self> {
        let shape = &drawing.shapes[member.shape];
        let outline = match shape.stroke.as_deref() {
            Some(stroke) if member.is_stroke => Arc::new(stroke.outline()),
            _ => Arc::clone(&shape.outline),
        };
        let measure = measure(&outline)?;
        Some(Self {
            stroke: None,
            outline,
            measure,
        })
    }
}

//! Parts as they are drawn, with the strings that they are matched with.

use std::sync::Arc;

use super::areas::Area;
use super::held::Hold;
use super::layers::LayerId;
use super::node_groups::PartSource;
use crate::bind::bindings::{self, PartId, StringId};
use crate::geometry::{Measure, Outline};
use crate::svg::{Drawing, GroupId, Paint, ShapeId};

/// A part, before it has a name, attributes and a place in the hierarchy.
#[derive(Debug)]
pub(in crate::bind) struct MatchedPart {
    /// Its shape.
    pub(in crate::bind) shape: ShapeId,
    /// Whether its area is the shape's stroke rather than its fill.
    pub(in crate::bind) is_stroke: bool,
    /// For ink, a stroke that lies on another part, that part, which comes before it.
    pub(in crate::bind) host: Option<PartId>,
    /// For a line that begins on a shape, where it does.
    pub(in crate::bind) hold: Option<Hold>,
    /// Its area, drawing units.
    pub(in crate::bind) outline: Arc<Outline>,
    /// Its axis, center and ends, as they are drawn.
    pub(in crate::bind) measure: Measure,
    /// Whether it is an island of a pair of limbs that is none of them: the name of its shape is not its own.
    pub(in crate::bind) is_rest: bool,
    /// Whether it is inflated unless a string says otherwise: what is rounded in a drawing that never says `Shape`.
    pub(in crate::bind) is_balloon: bool,
    /// For a prop, and for a wheel in such a drawing, half its thickness if no string says its `Shape`, drawing units.
    pub(in crate::bind) plate: Option<f64>,
    /// For a prop, the layer that says that it stands.
    pub(in crate::bind) stands_in: Option<LayerId>,
    /// Its string.
    pub(in crate::bind) string: Option<StringId>,
    /// For an island, the description of its shape, which says attributes of all islands. What each is called and hangs on is found as
    /// without a string.
    pub(in crate::bind) described_by: Option<StringId>,
    /// The main part candidate of its node, which may be itself.
    pub(in crate::bind) main: PartId,
    /// The group whose content shares its node.
    pub(in crate::bind) node_group: Option<GroupId>,
    /// Index of its source.
    pub(super) source: usize,
}

impl MatchedPart {
    /// A part without a string, alone in its node.
    pub(super) fn new(
        index: PartId,
        source: &PartSource,
        Area {
            outline,
            measure,
            is_rest,
        }: Area,
    ) -> Self {
        Self {
            shape: source.shape,
            is_stroke: source.is_stroke,
            host: None,
            hold: source.hold,
            outline,
            measure,
            is_rest,
            is_balloon: false,
            plate: None,
            stands_in: None,
            string: None,
            described_by: None,
            main: index,
            node_group: None,
            source: source.index,
        }
    }

    /// The string that says its attributes.
    pub(in crate::bind) fn attributes_from(&self) -> Option<StringId> {
        self.string.or(self.described_by)
    }

    /// Its paint: that of the fill or of the stroke.
    pub(in crate::bind) fn paint<'a>(&self, drawing: &'a Drawing) -> &'a Paint {
        bindings::paint(drawing, self.shape, self.is_stroke)
    }
}

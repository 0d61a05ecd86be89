//! The bindings: strings, parts, and how they belong together.

use std::sync::Arc;

use typed_index_collections::{TiVec, ti_vec};

use crate::anatomy::{self, Garment, Role, Term};
use crate::geometry::{Measure, Outline};
use crate::index::index_type;
use crate::lang::Variables;
use crate::lang::ast::Annotation;
use crate::lang::value::Setting;
use crate::source::Text;
use crate::svg::{Drawing, Element, GroupId, Paint, ShapeId};

use super::attributes::Legend;
use super::matching::{DrawingSettings, LayerId, Layers, Leaders};
use super::poses::KeyPose;
use super::props::Prop;

index_type!(
    /// A string of a drawing.
    pub StringId
);

index_type!(
    /// A part of a drawing.
    pub PartId
);

/// The strings and parts of a drawing, and which belong together.
#[derive(Debug, Default)]
pub struct Bindings {
    /// Whether the drawing is annotated at all.
    pub annotated: bool,
    /// Whether no string says `Shape`, so that what no string says is found by rule.
    pub is_first_look: bool,
    /// The strings, in the order of the file.
    pub strings: TiVec<StringId, DrawingString>,
    /// The parts, back-most first; sub-parts, legends and unused parts included.
    pub parts: TiVec<PartId, Part>,
    /// The settings of all `%` strings, each with its string; for each keyword the last one.
    pub defaults: Vec<(StringId, Setting)>,
    /// The legends, merged by paint.
    pub legends: Vec<Legend>,
    /// The variables that the `%` strings define.
    pub variables: Variables,
    /// The settings of the whole drawing.
    pub settings: DrawingSettings,
    /// The layers, in the order of their strings.
    pub layers: Layers,
    /// The props, in paint order.
    pub(crate) props: Vec<Prop>,
    /// The key poses, in the order of their layers from bottom to top.
    pub(crate) poses: Vec<KeyPose>,
    /// Whether parts hang on those that they touch, because no string names a part but labels or ids do.
    pub hierarchy_by_contact: bool,
    /// Per layer the main part that is its parent; `None` for a child of the root.
    pub(super) parent_of_layer: TiVec<LayerId, Option<PartId>>,
    /// The lines that lead from strings to what they mean.
    pub(super) leaders: Leaders,
}

/// What holds a string.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StringHolder {
    /// A text: index into [`Drawing::labels`].
    Label(usize),
    /// The description of a shape.
    Shape(ShapeId),
    /// The description of a group.
    Group(GroupId),
}

/// The rule by which a string was bound to its part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoundBy {
    /// The string is the part's description.
    Desc,
    /// The string is in a group with the part.
    Group,
    /// A line leads from the string to the part.
    Leader,
    /// The part is the nearest.
    Nearest,
}

impl BoundBy {
    /// The word for `inspect`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Desc => "desc",
            Self::Group => "group",
            Self::Leader => "leader",
            Self::Nearest => "nearest",
        }
    }
}

/// Where the name of a part is from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NamedBy {
    /// A string.
    String,
    /// The label of its shape, or of a group that it is the main part of.
    Label {
        /// The group.
        group: Option<GroupId>,
    },
    /// The `id` of its shape, or of a group that it is the main part of.
    Id {
        /// The group.
        group: Option<GroupId>,
    },
    /// The program, in document order.
    Automatic,
}

impl NamedBy {
    /// The word for `inspect`.
    pub fn name(self) -> &'static str {
        match self {
            Self::String => "string",
            Self::Label { .. } => "label",
            Self::Id { .. } => "id",
            Self::Automatic => "automatic",
        }
    }
}

/// The part that a string is bound to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Binding {
    /// The part.
    pub part: PartId,
    /// The rule.
    pub by: BoundBy,
}

/// A string of the drawing.
#[derive(Debug)]
pub struct DrawingString {
    /// What holds it.
    pub holder: StringHolder,
    /// Its characters, shared with the drawing.
    pub text: Arc<Text>,
    /// The parsed string.
    pub annotation: Annotation,
    /// The values of its attributes.
    pub settings: Vec<Setting>,
    /// Whether it is about a region of a picture in a view, which is no part.
    pub is_of_picture: bool,
    /// The part that it is bound to.
    pub binding: Option<Binding>,
    /// Another part that is almost as near.
    pub runner_up: Option<PartId>,
    /// The container to whose children the string is restricted.
    pub(super) scope: Option<GroupId>,
}

/// The kind of a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PartKind {
    /// A node of the hierarchy.
    Main,
    /// A solid in its main part's node.
    Sub,
    /// The sample of a legend, whose attributes hold for its paint.
    Legend,
    /// Left out.
    Unused,
    /// Drawn in a tile layer: it has no name, no joint and no solid of its own.
    Tile,
    /// Drawn in a view of a character: one of its regions.
    Region,
    /// Stands by itself on the ground of a map, together with the rest of its group: it has no joint, and nothing hangs on it.
    Prop,
}

impl PartKind {
    /// Whether it is built as a solid: a part of a figure, or a prop.
    pub fn is_solid(self) -> bool {
        matches!(self, Self::Main | Self::Sub | Self::Prop)
    }

    /// The word for `inspect`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Main => "main",
            Self::Sub => "sub",
            Self::Legend => "legend",
            Self::Unused => "unused",
            Self::Tile => "tile",
            Self::Region => "region",
            Self::Prop => "prop",
        }
    }
}

/// A part: a filled area of the drawing.
#[derive(Debug)]
pub struct Part {
    /// Its name; empty for sub-parts, legends and unused parts without one.
    pub name: String,
    /// Where its name is from; for parts without a name, `String`.
    pub named_by: NamedBy,
    /// Its kind.
    pub kind: PartKind,
    /// Its shape.
    pub shape: ShapeId,
    /// Whether its area is the shape's stroke rather than its fill.
    pub is_stroke: bool,
    /// For ink, a stroke that lies on another part, that part, which comes before it.
    pub host: Option<PartId>,
    /// Its area, drawing units.
    pub outline: Arc<Outline>,
    /// Whether it is inflated unless a string says otherwise: what is rounded in a drawing that never says `Shape`.
    pub(super) is_balloon: bool,
    /// For a prop or a wheel that no string gives a `Shape`, half its thickness, drawing units.
    pub(super) plate: Option<f64>,
    /// For a prop, the layer that says that it stands.
    pub stands_in: Option<LayerId>,
    /// For cloth by its name, how far it reaches to either side of its plane at most if it is inflated without a `Shape` that says so,
    /// drawing units.
    pub(super) sheet: Option<f64>,
    /// Whether it has too many corners for its `Shape`, or is one of very many small shapes, and is a plate instead.
    pub is_too_fine: bool,
    /// The axis, centre and ends of its shape. `Axis` replaces the measured axis.
    pub measure: Measure,
    /// Those of all shapes of its node together, if its own are not the node's.
    pub of_group: Option<Box<Measure>>,
    /// Its string.
    pub string: Option<StringId>,
    /// Index of the legend of its paint.
    pub legend: Option<usize>,
    /// For a main part its parent; `None` for a child of the root.
    pub parent: Option<PartId>,
    /// The main part candidate of its node, which may be itself.
    pub main: PartId,
    /// The joint, drawing units.
    pub origin: glam::DVec2,
    pub(super) index: PartId,
}

impl Part {
    /// Whether it is the main part candidate of its node.
    pub fn is_candidate(&self) -> bool {
        self.main == self.index
    }

    /// For a prop or a wheel that no string gives a `Shape`, half its thickness, drawing units.
    pub(crate) fn plate(&self) -> Option<f64> {
        self.plate
    }

    /// The axis, centre and ends of its node.
    pub fn node_measure(&self) -> &Measure {
        self.of_group.as_deref().unwrap_or(&self.measure)
    }

    /// Whether it is cloth by its name, or belongs to cloth.
    pub fn is_sheet(&self) -> bool {
        self.sheet.is_some()
    }

    /// Whether it is a foot or a shoe by its name.
    pub fn is_foot(&self) -> bool {
        Role::of(&anatomy::terms(&self.name)) == Some(Role::Foot)
    }

    /// Whether it is an arm or a lower arm by its name, and no wing.
    pub fn is_arm(&self) -> bool {
        let terms = anatomy::terms(&self.name);
        let role = Role::of(&terms);
        matches!(role, Some(Role::UpperArm | Role::LowerArm)) && !terms.contains(&Term::Wing)
    }

    /// Whether it is a hand by its name.
    pub fn is_hand(&self) -> bool {
        Role::of(&anatomy::terms(&self.name)) == Some(Role::Hand)
    }

    /// Whether it is by its name in the plane in which a body is symmetric: trunk, neck, head or tail.
    pub fn is_in_the_middle(&self) -> bool {
        let terms = anatomy::terms(&self.name);
        Role::of(&terms).is_some_and(|role| {
            role.trunk().is_some() || matches!(role, Role::Neck | Role::Head | Role::Tail)
        })
    }

    /// Whether it is an arm or a leg by its name, or a piece of one.
    pub fn is_piece_of_limb(&self) -> bool {
        Role::of(&anatomy::terms(&self.name)).is_some_and(Role::is_piece_of_limb)
    }

    /// The garment that it is by its name.
    pub(crate) fn garment(&self) -> Option<Garment> {
        anatomy::garment(&self.name)
    }

    /// Whether it is a head or a face by its name.
    pub fn is_head(&self) -> bool {
        let terms = anatomy::terms(&self.name);
        Role::of(&terms) == Some(Role::Head) || terms.contains(&Term::Face)
    }

    /// Whether it is hair by its name.
    pub fn is_hair(&self) -> bool {
        anatomy::terms(&self.name).contains(&Term::Hair)
    }

    /// Whether the program chose its name.
    pub fn is_automatic(&self) -> bool {
        self.named_by == NamedBy::Automatic
    }

    /// Its paint: that of the fill or of the stroke.
    pub fn paint<'a>(&self, drawing: &'a Drawing) -> &'a Paint {
        paint(drawing, self.shape, self.is_stroke)
    }
}

/// From where a main part is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Seen {
    /// No name tells, or it is a limb of a figure in profile, or a face that shows both eyes.
    Anyhow,
    /// From the side: what is drawn on it is on its far side, too.
    InProfile,
    /// The same; it is part of a vehicle.
    VehicleInProfile,
    FromFront,
    FromBehind,
}

impl Seen {
    pub(crate) fn is_in_profile(self) -> bool {
        matches!(self, Self::InProfile | Self::VehicleInProfile)
    }
}

/// The paint of a shape's fill, or of its stroke.
pub(super) fn paint(drawing: &Drawing, shape: ShapeId, is_stroke: bool) -> &Paint {
    let shape = &drawing.shapes[shape];
    match &shape.stroke {
        Some(stroke) if is_stroke => &stroke.paint,
        _ => &shape.paint,
    }
}

impl Bindings {
    /// Per main part, and per prop's first part, the parts whose solids are in its node.
    pub fn parts_of_nodes(&self) -> TiVec<PartId, Vec<PartId>> {
        let mut parts_of_nodes = ti_vec![Vec::new(); self.parts.len()];
        for (index, part) in self.parts.iter_enumerated() {
            if part.kind.is_solid() {
                parts_of_nodes[part.main].push(index);
            }
        }
        parts_of_nodes
    }

    /// The islands of the path that a part fills, in their order: more than the part itself if the path consists of several pieces. What
    /// is a line has none but itself.
    pub(crate) fn islands(&self, part: PartId) -> impl Iterator<Item = PartId> {
        let is_fill = |one: &Part| !one.is_stroke && one.host.is_none();
        let own = &self.parts[part];
        let is_island = move |index: PartId, other: &Part| {
            index == part || (is_fill(own) && is_fill(other) && other.shape == own.shape)
        };
        let parts = self.parts.iter_enumerated();
        parts.filter_map(move |(index, other)| is_island(index, other).then_some(index))
    }

    /// The main part that is the parent of a layer; `None` for a child of the root.
    pub fn parent_of_layer(&self, layer: LayerId) -> Option<PartId> {
        self.parent_of_layer[layer]
    }

    /// The element that names a part, if no string does: its shape's, or its group's.
    pub fn naming_element<'a>(&self, drawing: &'a Drawing, part: PartId) -> Option<&'a Element> {
        let part = &self.parts[part];
        match part.named_by {
            NamedBy::String | NamedBy::Automatic => None,
            NamedBy::Label { group: Some(group) } | NamedBy::Id { group: Some(group) } => {
                Some(&drawing.groups[group].element)
            }
            NamedBy::Label { group: None } | NamedBy::Id { group: None } => {
                Some(&drawing.shapes[part.shape].element)
            }
        }
    }
}

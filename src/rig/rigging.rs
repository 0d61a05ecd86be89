//! Builds rigs from the figures of a drawing.

use crate::math;
use glam::{DQuat, DVec2, DVec3};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::Context;
use super::bones;
use super::builder::of_figure;
use super::figures::FigureGroup;
use super::surface;
use crate::bind::{self, Bindings, PartId};
use crate::geometry::{Frame, bounds_of, y_up};
use crate::labels::{Carry, Class, Detail, Facing, Figure, FigurePart, FigurePartId};
use crate::memo::exact;
use crate::mocap::Transform;
use crate::retarget::{Drive, Follow, Matching};
use crate::retarget::{Rig, RigPart, SharedTurn};
use crate::svg::Drawing;

/// A figure as it is drawn, its parts in the order of the group; drawing units, y up.
pub(super) fn drawn_figure(context: &Context<'_>, group: &FigureGroup) -> Figure {
    figure(
        context.drawing,
        context.bindings,
        context.parts_of_node,
        group,
        |part| bones::count(context.bends[part].as_deref()),
    )
}

/// A figure as it is drawn, given per main part the shapes of its node, and how many bones it has inside.
pub(super) fn figure(
    drawing: &Drawing,
    bindings: &Bindings,
    parts_of_node: &TiSlice<PartId, Vec<PartId>>,
    group: &FigureGroup,
    bends_of: impl Fn(PartId) -> usize,
) -> Figure {
    let middle = |part: PartId| y_up(bindings.parts[part].node_measure().center);
    let box_of = |part: PartId| {
        let (from, to) = bindings.parts[part].measure.bounds;
        let (a, b) = (y_up(from), y_up(to));
        [a.min(b), a.max(b)]
    };
    let pieces_of = |part: PartId| {
        let pieces = &bindings.parts[part].outline.polygons;
        if !(2..=MAX_PIECES).contains(&pieces.len()) {
            return Vec::new();
        }
        let borders = pieces.iter().filter_map(|piece| piece.rings.first());
        let boxes = borders.filter_map(|ring| bounds_of(ring.iter().map(|at| y_up(*at))));
        let mut boxes: Vec<[DVec2; 2]> = boxes.map(|(low, high)| [low, high]).collect();
        let extent = |[low, high]: &[DVec2; 2]| (*high - *low).max_element();
        let largest = boxes.iter().map(extent).fold(0.0, f64::max);
        boxes.retain(|piece| extent(piece) >= SLIVER * largest);
        if boxes.len() < 2 {
            boxes.clear();
        }
        boxes
    };
    let part = |(place, &index): (FigurePartId, &PartId)| {
        let part = &bindings.parts[index];
        let [one, other] = part.node_measure().ends.map(y_up);
        let nearer = |to: DVec2| {
            if one.distance_squared(to) <= other.distance_squared(to) {
                [one, other]
            } else {
                [other, one]
            }
        };
        let parent = group.parents[place];
        let [joint, tip] = match (part.parent, parent) {
            // It turns about its joint, even if that is between its ends.
            (Some(_), _) => [y_up(part.origin), nearer(y_up(part.origin))[1]],
            (None, Some(parent)) => nearer(middle(group.parts[parent])),
            // A trunk has its joint at its lower end.
            (None, None) => {
                if one.y <= other.y {
                    [one, other]
                } else {
                    [other, one]
                }
            }
        };
        let own = parts_of_node[index].iter().map(|member| box_of(*member));
        let bounds = own.fold(
            [joint.min(tip), joint.max(tip)],
            |[low, high], [from, to]| [low.min(from), high.max(to)],
        );
        let details = parts_of_node[index].iter().copied();
        let details = details.filter(|member| *member != index).take(MAX_DETAILS);
        let details = details.map(|member| {
            let shape = &bindings.parts[member];
            Detail {
                name: shape_name(drawing, shape),
                bounds: box_of(member),
                pieces: pieces_of(member),
                color: shape.paint(drawing).color,
            }
        });
        let bones = bindings.attributes(index).bones();
        let bones = bones.map_or(Vec::new(), |bones| bones.value.to_vec());
        FigurePart {
            name: part.name.clone(),
            is_automatic: part.is_automatic(),
            parent,
            joint,
            tip,
            near_end: Some(nearer(tip)[1]),
            width: 2.0 * part.node_measure().half_across,
            bounds,
            main_shape: box_of(index),
            pieces: pieces_of(index),
            details: details.collect(),
            drawing_order: part.shape.into(),
            bones,
            bends: bends_of(index),
            carry: bindings.attributes(index).carry().map(carry),
        }
    };
    Figure {
        parts: group.parts.iter_enumerated().map(part).collect(),
        facing: facing(bindings, group),
    }
}

/// The most details of a part that are looked at.
const MAX_DETAILS: usize = 256;
/// A shape in more pieces than this is a pattern: both eyes, all legs or all wheels have fewer.
const MAX_PIECES: usize = 16;
/// Where outlines touch themselves, pieces come off that are smaller than this share of the largest.
const SLIVER: f64 = 0.05;

/// The name of a shape: that of its string, its label, or its id.
fn shape_name(drawing: &Drawing, part: &bind::Part) -> String {
    let element = &drawing.shapes[part.shape].element;
    let own = Some(&part.name).filter(|name| !name.is_empty());
    let own = own.or(element.label.as_ref()).or(element.id.as_ref());
    own.cloned().unwrap_or_default()
}

/// What strings say with `Facing`: that of any part of the figure takes precedence over one for all figures.
fn facing(bindings: &Bindings, group: &FigureGroup) -> Option<Facing> {
    let word = of_figure(group, |part| bindings.facing_of_figure(part))?;
    Facing::from_word(word)
}

fn carry(carry: bind::Carry) -> Carry {
    match carry {
        bind::Carry::Direction => Carry::Direction,
        bind::Carry::Change => Carry::Change,
    }
}

/// The rig of a matched figure, its parts in the order of the group.
pub(super) fn rig(
    context: &Context<'_>,
    figure: &Figure,
    group: &FigureGroup,
    matching: &Matching,
    nodes: &RestNodes,
) -> Rig {
    let is_leg = |part: FigurePartId| {
        let matched = &matching.parts[part];
        let is_chain = matched
            .drive
            .is_some_and(|drive| drive.tip.is_some() || drive.follow == Follow::Sole);
        let class = matched.label.as_ref().map(|label| label.class);
        is_chain && class == Some(Class::Leg)
    };
    let class = |part: FigurePartId| matching.parts[part].label.as_ref().map(|label| label.class);
    let follow = |part: FigurePartId| matching.parts[part].drive.map(|drive| drive.follow);
    let is_trunk = |part: FigurePartId| matches!(class(part), Some(Class::Body | Class::Hips));
    // An arm that keeps its drawn pose, or whose string says that it points as the actor's, makes no room.
    let is_arm = |part: FigurePartId| {
        class(part) == Some(Class::Arm)
            && follow(part).is_none_or(|follow| follow == Follow::Direction)
            && figure.parts[part].carry.is_none()
    };
    let mut continues = ti_vec![false; group.parts.len()];
    for (index, part) in figure.parts.iter_enumerated() {
        if let Some(parent) = part.parent.filter(|_| is_leg(index)) {
            continues[parent] = true;
        }
    }
    // What has no drive moves with what it hangs on: a shoe is what its leg stands on.
    let mut carried = ti_vec![Vec::new(); group.parts.len()];
    for index in group.parts.keys() {
        let above = |part: &FigurePartId| figure.parts[*part].parent;
        let mut ways = std::iter::successors(Some(index), above).take(group.parts.len());
        if let Some(carrier) = ways.find(|part| matching.parts[*part].drive.is_some()) {
            carried[carrier].push(index);
        }
    }
    let surface_of = |index: FigurePartId| {
        let nodes = carried[index].iter().map(|part| {
            let part = group.parts[*part];
            (part, nodes.of(part).0.position.z)
        });
        surface::outermost(context, nodes)
    };
    let part = |(index, part): (FigurePartId, &FigurePart)| {
        let (node, is_rooted) = nodes.of(group.parts[index]);
        let depth = node.position.z;
        let stands = is_leg(index) && !continues[index];
        let joint = part.joint.extend(depth);
        let way = part.tip.extend(depth) - joint;
        // A joint beside the axis does not change where the part points.
        let axis = node.rotation * DVec3::Y;
        let way = if is_rooted {
            way
        } else {
            axis * way.dot(axis).abs()
        };
        RigPart {
            parent: part.parent,
            is_rooted,
            node,
            joint,
            tip: joint + way,
            surface: surface_of(index),
            outline: if is_arm(index) || is_trunk(index) {
                surface::outermost(context, std::iter::once((group.parts[index], depth)))
            } else {
                Vec::new()
            },
            is_arm: is_arm(index),
            stands,
            drive: matching.parts[index].drive,
            is_leg: is_leg(index),
            swing: context.bindings.attributes(group.parts[index]).swing(),
            inside: None,
            shared: None,
        }
    };
    let mut parts: TiVec<_, _> = figure.parts.iter_enumerated().map(part).collect();
    bones::add(context, figure, group, matching, &mut parts);
    Rig {
        parts,
        facing: matching.facing.facing,
    }
}

/// A node of the scene at rest, and the part that it shows.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RestNode {
    /// The part.
    pub part: PartId,
    /// Which node of the part it is: 0 is its own one, others bend it.
    pub bone: usize,
    /// Whether it is a child of the model's root.
    pub is_rooted: bool,
    /// Whether it is mirrored in the drawing plane.
    pub is_mirrored: bool,
    /// Its distance in front of the drawing plane, drawing units.
    pub depth: f64,
}

/// Per part its node at rest, in drawing units and the drawing's axes, and whether that is a child of the model's root; without
/// copies of parts.
pub(super) struct RestNodes(TiVec<PartId, Option<(Transform, bool)>>);

impl RestNodes {
    /// The nodes of a scene, given the rest frames of parts.
    pub(super) fn new(frames: &TiSlice<PartId, Frame>, nodes: &[RestNode]) -> Self {
        let mut rest = ti_vec![None; frames.len()];
        for node in nodes.iter().filter(|node| node.bone == 0) {
            let frame = &frames[node.part];
            // The original precedes its copies.
            rest[node.part].get_or_insert((
                Transform {
                    rotation: math::rotation_z(frame.angle),
                    position: frame.origin.extend(node.depth),
                },
                node.is_rooted,
            ));
        }
        Self(rest)
    }

    fn of(&self, part: PartId) -> (Transform, bool) {
        let origin = Transform {
            rotation: DQuat::IDENTITY,
            position: DVec3::ZERO,
        };
        // Every main part has a node, unless copies exceeded their limit.
        self.0[part].unwrap_or((origin, false))
    }
}

exact! {
    Rig { parts, facing }
    RigPart {
        parent, is_rooted, node, joint, tip, surface, outline, is_arm, stands, drive, is_leg, swing, inside, shared
    }
    SharedTurn { between, share }
    Transform { rotation, position }
}
exact!(Facing, Drive, FigurePartId);

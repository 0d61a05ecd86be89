//! Props: what stands by itself on the ground of a map, such as a tree, a fence, a sign.
//!
//! In a layer of props every group, clone and picture is one. So is every shape that is drawn without a group; one that stands on an
//! earlier shape belongs to that, as the crown of a tree does to its trunk.

use glam::DVec2;
use typed_index_collections::{TiSlice, TiVec};

use super::layers::{LayerKind, Layers};
use super::parts::MatchedPart;
use crate::bind::bindings::{PartId, PartKind};
use crate::geometry::{Outline, bounds_of, contains};
use crate::svg::{Drawing, GroupId, GroupKind, PaintKey};

/// How thick a prop is, as a share of its width.
const THICKNESS: f64 = 0.1;
/// The lowest share of an outline's height is what it stands on.
const SOLE: f64 = 0.02;
/// How many later shapes are compared with one: what stands on a shape is drawn soon after it.
const MOST_LATER: usize = 64;

/// The groups that are props, rather than layers of them: those whose own string says `Stand`, and that hold plain shapes alone.
pub(super) fn single(drawing: &Drawing, layers: &Layers) -> TiVec<GroupId, bool> {
    let of_kind = layers.iter();
    let of_kind = of_kind.filter(|layer| layer.kind == LayerKind::Stand);
    let mut single: TiVec<GroupId, bool> = vec![false; drawing.groups.len()].into();
    for layer in of_kind {
        single[layer.group] = drawing.groups[layer.group].kind == GroupKind::Group;
    }
    for shape in &drawing.shapes {
        let is_picture = matches!(shape.paint.key, PaintKey::Picture(_));
        single[shape.group] &= !is_picture && shape.element.tag != "use";
        let mut group = shape.group;
        // What is in a group of the layer is drawn in a group.
        while group != GroupId::ROOT {
            group = drawing.groups[group].parent;
            single[group] = false;
        }
    }
    single
}

/// Makes one prop of shapes without a group that stand on each other.
pub(super) fn join_loose(
    drawing: &Drawing,
    layers: &Layers,
    parts: &mut TiSlice<PartId, MatchedPart>,
) {
    let is_loose = |part: &MatchedPart| {
        let shape = &drawing.shapes[part.shape];
        let is_picture = matches!(shape.paint.key, PaintKey::Picture(_));
        part.node_group.is_none()
            && part.host.is_none()
            && !is_picture
            && shape.element.tag != "use"
            && layers.of_props(shape.group).is_some()
    };
    let loose = parts.iter_enumerated();
    let loose: Vec<PartId> = loose
        .filter(|(index, part)| part.main == *index && is_loose(part))
        .map(|(index, _)| index)
        .collect();
    for (place, index) in loose.iter().enumerate() {
        let part = &parts[*index];
        let Some(foot) = foot([&*part.outline]).filter(|_| part.attributes_from().is_none()) else {
            continue;
        };
        let group = drawing.shapes[part.shape].group;
        let earlier = loose[..place].iter().rev().take(MOST_LATER);
        let carrier = earlier.copied().find(|other| {
            let other = &parts[*other];
            let (low, high) = other.measure.bounds;
            let is_near = foot.cmpge(low).all() && foot.cmple(high).all();
            let is_same = drawing.shapes[other.shape].group == group;
            is_same && is_near && contains(&other.outline, foot)
        });
        if let Some(carrier) = carrier {
            parts[*index].main = parts[carrier].main;
        }
    }
    // Ink goes with its host.
    for index in parts.keys() {
        if let Some(host) = parts[index].host.filter(|_| {
            layers
                .of_props(drawing.shapes[parts[index].shape].group)
                .is_some()
        }) {
            parts[index].main = parts[host].main;
        }
    }
}

/// Gives props their layer and their thickness, which is that of a slab in the first look at a drawing, too.
pub(super) fn give_thickness(
    drawing: &Drawing,
    layers: &Layers,
    kinds: &TiSlice<PartId, PartKind>,
    parts: &mut TiSlice<PartId, MatchedPart>,
) {
    let mut widths: TiVec<PartId, [f64; 2]> =
        vec![[f64::INFINITY, f64::NEG_INFINITY]; parts.len()].into();
    let is_prop = |index: PartId| kinds[index] == PartKind::Prop;
    for (_, part) in parts.iter_enumerated().filter(|(index, _)| is_prop(*index)) {
        let (low, high) = part.measure.bounds;
        let ends = &mut widths[part.main];
        *ends = [ends[0].min(low.x), ends[1].max(high.x)];
    }
    for index in parts.keys().filter(|index| is_prop(*index)) {
        let [left, right] = widths[parts[index].main];
        let part = &mut parts[index];
        part.is_balloon = false;
        part.stands_in = layers.of_props(drawing.shapes[part.shape].group);
        part.plate = Some(THICKNESS / 2.0 * (right - left)).filter(|half| *half > 0.0);
    }
}

/// The point on which something with these outlines stands, drawing units: the middle of its lowest edge. `None` without any.
pub(in crate::bind) fn foot<'a>(
    outlines: impl IntoIterator<Item = &'a Outline> + Clone,
) -> Option<DVec2> {
    let points = || {
        let polygons = outlines
            .clone()
            .into_iter()
            .flat_map(|outline| &outline.polygons);
        polygons.flat_map(|polygon| polygon.rings.iter().flatten().copied())
    };
    let (low, high) = bounds_of(points())?;
    let sole = high.y - SOLE * (high.y - low.y);
    let edges = outlines
        .clone()
        .into_iter()
        .flat_map(|outline| &outline.polygons);
    let edges = edges.flat_map(|polygon| &polygon.rings).flat_map(|ring| {
        let next = ring.iter().cycle().skip(1);
        ring.iter().copied().zip(next.copied())
    });
    let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
    for (from, to) in edges {
        let (upper, lower) = if from.y < to.y {
            (from, to)
        } else {
            (to, from)
        };
        if lower.y < sole {
            continue;
        }
        let cut = if upper.y < sole {
            upper.lerp(lower, (sole - upper.y) / (lower.y - upper.y))
        } else {
            upper
        };
        for point in [cut, lower] {
            ends = [ends[0].min(point.x), ends[1].max(point.x)];
        }
    }
    Some(DVec2::new(ends[0].midpoint(ends[1]), high.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Polygon;

    fn outline(ring: &[[f64; 2]]) -> Outline {
        let ring = ring.iter().copied().map(DVec2::from_array).collect();
        Outline {
            polygons: vec![Polygon { rings: vec![ring] }],
        }
    }

    #[test]
    fn the_foot_is_the_middle_of_the_lowest_edge() {
        let crown = outline(&[[0., 0.], [40., 0.], [40., 60.], [0., 60.]]);
        let trunk = outline(&[[24., 60.], [30., 60.], [30., 100.], [24., 100.]]);
        assert_eq!(foot([&crown, &trunk]), Some(DVec2::new(27., 100.)));
        // A tip that is pointed: its lowest fiftieth.
        let drop = outline(&[[0., 0.], [100., 0.], [80., 100.]]);
        let at = foot([&drop]).unwrap();
        assert!((at - DVec2::new(79.4, 100.)).length() < 1e-9, "{at}");
        assert_eq!(foot([]), None);
    }
}

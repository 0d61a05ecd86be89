//! Pairs that are one shape: both arms, shoes or wheels in one path, as programs merge paths of one colour.
//!
//! Each of them moves on its own, so each island of such a shape is a part where no text names parts, and the description of the shape
//! does not say which part it is: one that says attributes alone is about all of its islands. What lies on several of them, such as both
//! cuffs, is split likewise. Legs that hang together, as in trousers, are cut apart.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec2;
use typed_index_collections::{TiSlice, TiVec};

use super::areas::Area;
use super::fork;
use super::node_groups::PartSource;
use crate::anatomy;
use crate::bind::names::of_element;
use crate::geometry::{
    Body, Outline, Polygon, area, bounds, connected, contains, measure, touching,
};
use crate::memo::{Memo, Same};
use crate::svg::{Drawing, Shape, ShapeId};

/// How far apart islands are at least, as a share of the larger extent of their shape.
const APART: f64 = 0.02;
/// The area of an island, as a share of that of the largest, from which on it is one of a pair, and no other thing of the
/// same colour.
const ALIKE: f64 = 0.3;
/// A shape with more is a pattern.
const MOST: usize = 12;
/// With more limbs, a drawing is a crowd, in which nothing is looked for.
const MOST_PIECES: usize = 64;
/// The most points of a border that are looked at.
const MOST_POINTS: usize = 16;

/// Splits the pairs of a drawing, and what lies on several of them, but for shapes whose description says which part they are. The
/// islands of a shape come one after the other.
pub(super) fn split(
    drawing: &Drawing,
    drawn: Vec<(PartSource, Area)>,
    is_described: &TiSlice<ShapeId, bool>,
    memo: &Memo,
) -> Vec<(PartSource, Area)> {
    let shapes = drawing.shapes.iter();
    let pairs: TiVec<ShapeId, Option<Pair>> = shapes.map(named_pair).collect();
    let is_pair = |source: &PartSource| pairs[source.shape].is_some();
    let can_split = |source: &PartSource| {
        !is_described[source.shape] && is_splittable(&drawing.shapes[source.shape])
    };
    let drawn = replaced(
        drawn,
        |source, _| pairs[source.shape].filter(|_| can_split(source)),
        |keys| memo.get_each(keys, |(outline, pair)| pieces(&outline.0, *pair)),
    );
    let pieces = drawn
        .iter()
        .filter(|(source, _)| !source.is_stroke && is_pair(source));
    let pieces: Vec<Arc<Outline>> = pieces.map(|(_, area)| Arc::clone(&area.outline)).collect();
    if pieces.len() < 2 || pieces.len() > MOST_PIECES {
        return drawn;
    }
    replaced(
        drawn,
        |source, area| {
            let is_several = area.outline.polygons.len() > 1;
            let may_lie_on_pairs = is_several && !is_pair(source) && can_split(source);
            may_lie_on_pairs.then(|| owners(&area.outline, &pieces))
        },
        |keys| memo.get_each(keys, |(outline, owners)| by_owner(&outline.0, owners)),
    )
}

/// The list with some areas replaced by their islands: those about which `asked` knows something.
fn replaced<K>(
    drawn: Vec<(PartSource, Area)>,
    asked: impl Fn(&PartSource, &Area) -> Option<K>,
    islands: impl FnOnce(Vec<(Same<Outline>, K)>) -> Vec<Vec<Area>>,
) -> Vec<(PartSource, Area)> {
    let mut keys = Vec::new();
    let mut is_asked = Vec::with_capacity(drawn.len());
    for (source, area) in &drawn {
        let key = if source.is_stroke {
            None
        } else {
            asked(source, area)
        };
        is_asked.push(key.is_some());
        keys.extend(key.map(|key| (Same(Arc::clone(&area.outline)), key)));
    }
    let mut islands = islands(keys).into_iter();
    let mut split = Vec::with_capacity(drawn.len());
    for ((source, area), is_asked) in drawn.into_iter().zip(is_asked) {
        let islands = if is_asked { islands.next() } else { None };
        match islands {
            Some(islands) if islands.len() > 1 => {
                split.extend(islands.into_iter().map(|island| (source, island)));
            }
            _ => split.push((source, area)),
        }
    }
    split
}

/// Whether the islands of a shape can be parts. Those of one with an outline would share that.
fn is_splittable(shape: &Shape) -> bool {
    shape.outline.polygons.len() <= MOST && shape.stroke.is_none()
}

/// What the label of a shape says that there are several of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Pair {
    /// Legs: `Legs`, `far legs`.
    Legs,
    /// Limbs, what is worn on them, or wheels.
    Others,
}

fn named_pair(shape: &Shape) -> Option<Pair> {
    let name = of_element(&shape.element, None)?.name;
    if !anatomy::comes_in_pairs(&name) {
        None
    } else if anatomy::are_legs(&name) {
        Some(Pair::Legs)
    } else {
        Some(Pair::Others)
    }
}

/// The limbs of an outline: its islands, or legs that hang together.
fn pieces(outline: &Outline, pair: Pair) -> Vec<Area> {
    let islands = islands(outline);
    if islands.len() > 1 || pair != Pair::Legs {
        return islands;
    }
    let legs = fork::legs(outline);
    legs.map_or(islands, |legs| measured(legs.into_iter()))
}

/// Per polygon of an outline the piece that it lies on, if it does.
fn owners(outline: &Outline, pieces: &[Arc<Outline>]) -> Vec<Option<usize>> {
    let owner = |polygon: &Polygon| {
        let border = &polygon.rings[0];
        let step = border.len().div_ceil(MOST_POINTS).max(1);
        let points: Vec<DVec2> = border.iter().copied().step_by(step).collect();
        let held = |piece: &Outline| {
            points
                .iter()
                .filter(|point| contains(piece, **point))
                .count()
        };
        let counts = pieces.iter().map(|piece| held(piece)).enumerate();
        let (piece, most) = counts.max_by_key(|(_, count)| *count)?;
        (4 * most >= points.len()).then_some(piece)
    };
    outline.polygons.iter().map(owner).collect()
}

/// The polygons of an outline by the pieces that they lie on.
fn by_owner(outline: &Outline, owners: &[Option<usize>]) -> Vec<Area> {
    let mut of_owner: BTreeMap<Option<usize>, Outline> = BTreeMap::new();
    for (polygon, owner) in outline.polygons.iter().zip(owners) {
        let outline = of_owner.entry(*owner).or_default();
        outline.polygons.push(polygon.clone());
    }
    if of_owner.keys().flatten().count() < 2 {
        return Vec::new();
    }
    measured(of_owner.into_values())
}

/// The outlines with their measures; none if one of them covers nothing.
fn measured(outlines: impl Iterator<Item = Outline>) -> Vec<Area> {
    let areas = outlines.map(|outline| {
        Some(Area {
            measure: measure(&outline)?,
            outline: Arc::new(outline),
            is_rest: false,
        })
    });
    areas.collect::<Option<Vec<Area>>>().unwrap_or_default()
}

/// The islands of an outline. Those that are much smaller than the largest are no limbs.
fn islands(outline: &Outline) -> Vec<Area> {
    let Some((low, high)) = bounds(outline) else {
        return Vec::new();
    };
    let polygons = outline.polygons.iter().map(|polygon| Outline {
        polygons: vec![polygon.clone()],
    });
    let polygons: Vec<Outline> = polygons.collect();
    let bodies = polygons.iter().map(|polygon| Body {
        outlines: vec![polygon],
        bounds: bounds(polygon).unwrap_or((low, high)),
        slack: APART * (high - low).max_element(),
    });
    let groups = connected(&touching(&bodies.collect::<Vec<_>>()));
    let joined = groups.into_iter().map(|members| Outline {
        polygons: members
            .into_iter()
            .flat_map(|member| polygons[member].polygons.clone())
            .collect(),
    });
    let joined: Vec<Outline> = joined.collect();
    let largest = joined.iter().map(area).fold(0.0, f64::max);
    let (islands, rest): (Vec<Outline>, Vec<Outline>) = joined
        .into_iter()
        .partition(|outline| area(outline) >= ALIKE * largest);
    let mut islands = measured(islands.into_iter());
    for island in measured(rest.into_iter()) {
        islands.push(Area {
            is_rest: true,
            ..island
        });
    }
    islands
}

//! The props of a drawing: which parts each has, what it is called, where it stands, and which are copies of one another.

use glam::DVec2;
use rustc_hash::{FxHashMap, FxHashSet};

use super::bindings::{Bindings, NamedBy, Part, PartId, PartKind};
use super::matching::{LayerId, foot};
use super::names::{Numbers, OwnName, of_element};
use crate::svg::{Drawing, GroupId, Paint, PaintKey};
use crate::texture::{PaintServer, Source};

/// How far corresponding points of two copies may be apart, as a share of the larger of size and distance from the page's origin: paths
/// are read in single precision.
const SAME: f64 = 1e-5;

/// Something that stands by itself on the ground of a map.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Prop {
    /// Its first part, which has its name and its string.
    pub main: PartId,
    /// Its parts, back-most first.
    pub parts: Vec<PartId>,
    /// Its layer.
    pub layer: LayerId,
    /// The point of the page on which it stands, drawing units: the middle of its lowest edge, or what `Stand` says.
    pub foot: DVec2,
    /// The first prop that looks the same: a clone, a copy, the same picture. Its own index if there is none before it.
    pub like: usize,
}

/// Finds the props, names them, and sets their joints, on which they stand. `group_of` is the group that makes a part a prop.
pub(super) fn find(
    drawing: &Drawing,
    bindings: &mut Bindings,
    group_of: impl Fn(PartId) -> Option<GroupId>,
) {
    let parts = bindings.parts.iter_enumerated();
    let mains = parts.filter(|(index, part)| part.kind == PartKind::Prop && part.main == *index);
    let mains: Vec<PartId> = mains.map(|(index, _)| index).collect();
    if mains.is_empty() {
        return;
    }
    let mut parts_of = bindings.parts_of_nodes();
    let mut props: Vec<Prop> = Vec::with_capacity(mains.len());
    for main in mains {
        let parts = std::mem::take(&mut parts_of[main]);
        let outlines = parts.iter().map(|part| &*bindings.parts[*part].outline);
        let said = bindings.attributes(main).stand().map(|point| point.value);
        let (Some(foot), Some(layer)) = (
            said.or_else(|| foot(outlines)),
            bindings.parts[main].stands_in,
        ) else {
            continue;
        };
        props.push(Prop {
            main,
            parts,
            layer,
            foot,
            like: props.len(),
        });
    }
    let mut first: FxHashMap<Vec<usize>, Vec<usize>> = FxHashMap::default();
    for index in 0..props.len() {
        let points = props[index].parts.iter();
        let points = points.map(|part| bindings.parts[*part].outline.point_count());
        let candidates = first.entry(points.collect()).or_default();
        let same = candidates.iter();
        let same = same
            .copied()
            .find(|other| are_alike(drawing, bindings, [&props[*other], &props[index]]));
        match same {
            Some(other) => props[index].like = other,
            None => candidates.push(index),
        }
    }
    name(drawing, bindings, &props, group_of);
    for prop in &props {
        for part in &prop.parts {
            bindings.parts[*part].origin = prop.foot;
        }
    }
    bindings.props = props;
}

/// Names props by their strings, by what a person called them, or else after their layer. A name that is taken gets a number.
fn name(
    drawing: &Drawing,
    bindings: &mut Bindings,
    props: &[Prop],
    group_of: impl Fn(PartId) -> Option<GroupId>,
) {
    let others = bindings
        .parts
        .iter()
        .filter(|part| part.kind != PartKind::Prop);
    let taken = others.map(|part| part.name.clone());
    let layers = bindings.layers.iter().map(|layer| layer.name.clone());
    let mut taken: FxHashSet<String> = taken.chain(layers).collect();
    let mut numbers = Numbers::default();
    for prop in props {
        let part = &bindings.parts[prop.main];
        let said = (!part.name.is_empty()).then(|| OwnName {
            name: part.name.clone(),
            by: part.named_by,
        });
        let group = group_of(prop.main);
        let of_group =
            group.and_then(|group| of_element(&drawing.groups[group].element, Some(group)));
        let own = said
            .or(of_group)
            .or_else(|| of_element(&drawing.shapes[part.shape].element, None));
        let (base, by) = match own {
            Some(own) => (own.name, own.by),
            None => (bindings.layers[prop.layer].name.clone(), NamedBy::Automatic),
        };
        let name = match by {
            NamedBy::Automatic => numbers.free(&base, 1, |name| !taken.contains(name)),
            _ if taken.contains(&base) => numbers.free(&base, 2, |name| !taken.contains(name)),
            _ => base,
        };
        taken.insert(name.clone());
        let part = &mut bindings.parts[prop.main];
        (part.name, part.named_by) = (name, by);
    }
}

/// Whether two props are one drawing at two places.
fn are_alike(drawing: &Drawing, bindings: &Bindings, props: [&Prop; 2]) -> bool {
    let [one, other] = props;
    let shift = other.foot - one.foot;
    let settings = |part: &Part| {
        let string = part.string.map(|string| &bindings.strings[string]);
        let settings = string.into_iter().flat_map(|string| &string.settings);
        let settings = settings.map(|setting| (setting.keyword, setting.text.clone()));
        settings.collect::<Vec<_>>()
    };
    one.layer == other.layer
        && one.parts.len() == other.parts.len()
        && one.parts.iter().zip(&other.parts).all(|(a, b)| {
            let [a, b] = [a, b].map(|part| &bindings.parts[*part]);
            let [of_a, of_b] = [a, b].map(|part| &drawing.shapes[part.shape]);
            let (low, high) = b.measure.bounds;
            let slack = SAME * low.abs().max(high.abs()).max(high - low).max_element();
            let is_near = |a: DVec2, b: DVec2| (a + shift - b).abs().max_element() <= slack;
            let [rings_a, rings_b] = [a, b].map(|part| part.outline.rings());
            let rings = rings_a.zip(rings_b);
            settings(a) == settings(b)
                && a.is_stroke == b.is_stroke
                && a.legend == b.legend
                && of_a.opacity == of_b.opacity
                && paints_alike(a.paint(drawing), b.paint(drawing), shift, slack)
                && a.outline.polygons.len() == b.outline.polygons.len()
                && rings.into_iter().all(|(a, b)| {
                    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| is_near(*a, *b))
                })
        })
}

/// Whether two paints are the same, moved by `shift`.
fn paints_alike(one: &Paint, other: &Paint, shift: DVec2, slack: f64) -> bool {
    let same_place = |a: &PaintServer, b: &PaintServer| {
        let [m, n] = [a, b].map(|server| server.place.matrix2);
        let moved = a.place.translation + shift - b.place.translation;
        let scale = n.x_axis.abs().max(n.y_axis.abs()).max_element();
        m.abs_diff_eq(n, SAME * scale) && moved.abs().max_element() <= slack
    };
    match (&one.server, &other.server) {
        (None, None) => one.key == other.key,
        (Some(a), Some(b)) if same_place(a, b) => match (&a.source, &b.source) {
            (Source::Picture(a, fa), Source::Picture(b, fb)) => a == b && fa == fb,
            _ => one.key == other.key && !matches!(one.key, PaintKey::Picture(_)),
        },
        _ => false,
    }
}

impl Bindings {
    /// The prop that a part belongs to.
    pub(crate) fn prop_of(&self, part: PartId) -> Option<usize> {
        let main = self.parts.get(part)?.main;
        let found = self.props.binary_search_by_key(&main, |prop| prop.main);
        found
            .ok()
            .filter(|_| self.parts[part].kind == PartKind::Prop)
    }
}

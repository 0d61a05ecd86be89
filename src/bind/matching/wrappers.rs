//! Groups that group nothing, and backgrounds, shadows on the ground among them.
//!
//! Drawing programs put everything into one group, frame or artboard, and a rectangle of the page's size behind it. Neither
//! says anything about the figure.

use glam::DVec2;
use rustc_hash::FxHashSet;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::ground_shadows;
use super::strings::ReadString;
use crate::anatomy::{self, Role};
use crate::bind::bindings::{StringHolder, StringId};
use crate::bind::names::{self, written_by_a_person};
use crate::geometry::{area, bounds};
use crate::svg::{Drawing, Element, GroupId, GroupKind, PaintKey, Shape, ShapeId};

/// The least share of the page that a frame or a background covers.
const PAGE: f64 = 0.9;
/// The least share of everything else that a background holds, by area of bounding boxes.
const HELD: f64 = 0.9;
/// The least share of its bounding box that a rectangle fills. Paper has corners: a sheet with rounded ones is a card, or the tile of an
/// icon.
const RECTANGULAR: f64 = 0.998;
/// Shapes this close to an edge of the page reach it, relative to its width or height.
const EDGE: f64 = 0.005;
/// The most backgrounds of a drawing.
const MAX_BACKGROUNDS: usize = 16;
/// First words of the ids and labels that programs give to artboards and layers.
const ARTBOARDS: &[&str] = &[
    "artboard",
    "frame",
    "page",
    "layer",
    "zeichenfläche",
    "ebene",
    "calque",
    "capa",
    "livello",
    "camada",
    "laag",
    "слой",
    "图层",
    "圖層",
    "레이어",
    "アートボード",
    "レイヤー",
];

/// What the programs that drew a drawing put around it and behind it.
#[derive(Debug)]
pub(super) struct Wrappers {
    /// Per group whether it groups nothing; always for the root and for layers that are not in a group.
    pub(super) groups_nothing: TiVec<GroupId, bool>,
    /// Per group whether it is a piece of a body with further pieces in it that are its children: an arm that holds the group of its
    /// hand.
    pub(super) carries: TiVec<GroupId, bool>,
    /// Per shape whether it is a background, unless a string names it.
    pub(super) backgrounds: TiVec<ShapeId, bool>,
    /// The backgrounds that are shadows on the ground.
    pub(super) shadows: Vec<ShapeId>,
}

/// Finds them. `counts` is the number of strings in each group that want a part, `in_map` whether a group is in a tile layer.
pub(super) fn find(
    drawing: &Drawing,
    strings: &TiSlice<StringId, ReadString>,
    counts: &TiSlice<GroupId, usize>,
    in_map: impl Fn(GroupId) -> bool,
) -> Wrappers {
    let (backgrounds, shadows) = backgrounds(drawing, strings, counts, in_map);
    let children = children(drawing, &backgrounds);
    let mut groups_nothing = TiVec::with_capacity(drawing.groups.len());
    for (index, group) in drawing.groups.iter_enumerated() {
        let inside = index != GroupId::ROOT && groups_nothing[group.parent];
        groups_nothing.push(match group.kind {
            GroupKind::Root => true,
            GroupKind::Layer => inside,
            GroupKind::Group => {
                // Several strings beside the only group of a page describe its content; a single one names the group.
                let lone = children[group.parent] == 1 && counts[group.parent] != 1;
                let frame = group.frame.is_some_and(|frame| covers_page(drawing, frame));
                inside && (lone || frame || is_artboard(&group.element))
            }
        });
    }
    let mut carries = ti_vec![false; drawing.groups.len()];
    if counts.iter().all(|count| *count == 0) {
        open_figures(drawing, &mut groups_nothing, &mut carries);
    }
    Wrappers {
        groups_nothing,
        carries,
        backgrounds,
        shadows,
    }
}

/// Opens the groups that are figures or limbs in pieces: two or more different parts of a body have names in them, such as arm and
/// head, or left and right arm. Eyes and hair stay with their head. A piece of a body with shapes of its own and further pieces in
/// named groups carries these.
fn open_figures(
    drawing: &Drawing,
    groups_nothing: &mut TiSlice<GroupId, bool>,
    carries: &mut TiSlice<GroupId, bool>,
) {
    let role = |element: &Element| {
        let terms = anatomy::terms(&names::of_element(element, None)?.name);
        let role = Role::of(&terms).filter(|role| *role != Role::OfHead)?;
        Some((role, anatomy::sides(&terms)))
    };
    let mut drawn: TiVec<GroupId, bool> = ti_vec![false; drawing.groups.len()];
    let mut pieces: TiVec<GroupId, FxHashSet<_>> =
        ti_vec![FxHashSet::default(); drawing.groups.len()];
    // Per group whether it holds a shape that no name makes a piece of its own, and whether it holds a group that one does.
    let mut has_own: TiVec<GroupId, bool> = ti_vec![false; drawing.groups.len()];
    let mut holds_piece: TiVec<GroupId, bool> = ti_vec![false; drawing.groups.len()];
    for shape in drawing.shapes.iter().filter(|shape| is_filled(shape)) {
        drawn[shape.group] = true;
        let own = role(&shape.element);
        has_own[shape.group] |= own.is_none();
        pieces[shape.group].extend(own);
    }
    // A group comes after the group that contains it.
    for (index, group) in drawing.groups.iter_enumerated().skip(1).rev() {
        if !drawn[index] {
            continue;
        }
        drawn[group.parent] = true;
        let own = role(&group.element);
        let is_group = group.kind == GroupKind::Group;
        carries[index] = is_group && own.is_some() && has_own[index] && holds_piece[index];
        let opens = is_group && !carries[index] && pieces[index].len() > 1;
        groups_nothing[index] |= opens;
        holds_piece[group.parent] |= own.is_some() || holds_piece[index];
        // What a program calls a group, or nobody calls anything, is drawn with what is around it.
        let is_unnamed = names::of_element(&group.element, None).is_none();
        has_own[group.parent] |= is_unnamed && has_own[index];
        let inner = std::mem::take(&mut pieces[index]);
        if opens || carries[index] {
            pieces[group.parent].extend(inner);
        }
        pieces[group.parent].extend(own);
    }
}

/// Per group, how many shapes and groups in it are filled or hold filled shapes, apart from backgrounds. In a drawing of lines
/// alone all shapes count.
fn children(drawing: &Drawing, backgrounds: &TiSlice<ShapeId, bool>) -> TiVec<GroupId, usize> {
    let counts = |all: bool| {
        let mut children: TiVec<GroupId, usize> = ti_vec![0; drawing.groups.len()];
        let mut drawn: TiVec<GroupId, bool> = ti_vec![false; drawing.groups.len()];
        for (shape, background) in drawing.shapes.iter().zip(backgrounds) {
            if *background || !all && !is_filled(shape) {
                continue;
            }
            children[shape.group] += 1;
            let mut group = shape.group;
            while group != GroupId::ROOT && !drawn[group] {
                drawn[group] = true;
                group = drawing.groups[group].parent;
                children[group] += 1;
            }
        }
        children
    };
    let filled = counts(false);
    match filled.first() {
        Some(0) => counts(true),
        _ => filled,
    }
}

pub(super) fn is_filled(shape: &Shape) -> bool {
    !shape.outline.polygons.is_empty()
}

fn covers_page(drawing: &Drawing, (low, high): (DVec2, DVec2)) -> bool {
    let (page, size) = drawing.page;
    let shared = (high.min(page + size) - low.max(page)).max(DVec2::ZERO);
    shared.element_product() >= PAGE * size.element_product()
}

/// Whether a program calls an element an artboard or a layer: `Frame 1`, `Layer_2`.
fn is_artboard(element: &Element) -> bool {
    let Some(name) = element.label.as_deref().or(element.id.as_deref()) else {
        return false;
    };
    let first = name.trim_start_matches('_').to_lowercase();
    written_by_a_person(name).is_none() && ARTBOARDS.iter().any(|word| first.starts_with(word))
}

fn backgrounds(
    drawing: &Drawing,
    strings: &TiSlice<StringId, ReadString>,
    counts: &TiSlice<GroupId, usize>,
    in_map: impl Fn(GroupId) -> bool,
) -> (TiVec<ShapeId, bool>, Vec<ShapeId>) {
    let mut found: TiVec<ShapeId, bool> = ti_vec![false; drawing.shapes.len()];
    let mut shadows = Vec::new();
    let shapes = drawing.shapes.keys();
    let filled: Vec<ShapeId> = shapes
        .filter(|shape| is_filled(&drawing.shapes[*shape]))
        .collect();
    for (place, shape) in filled.iter().copied().enumerate().take(MAX_BACKGROUNDS) {
        let rest = &filled[place + 1..];
        let described = strings
            .iter()
            .any(|string| string.holder == StringHolder::Shape(shape));
        if rest.is_empty()
            || in_map(drawing.shapes[shape].group)
            || described
            || has_string_beside(drawing, counts, &filled, shape)
        {
            break;
        }
        if ground_shadows::is_shadow(drawing, shape, rest) {
            shadows.push(shape);
        } else if !is_page(drawing, shape, rest) {
            break;
        }
        found[shape] = true;
    }
    (found, shadows)
}

/// Whether the first of the shapes, in paint order, is a rectangle of the page's size behind the others.
fn is_page(drawing: &Drawing, shape: ShapeId, rest: &[ShapeId]) -> bool {
    let own = bounds(&drawing.shapes[shape].outline).filter(|own| covers_page(drawing, *own));
    own.is_some_and(|own| {
        is_rectangle(&drawing.shapes[shape])
            && holds(drawing, own, rest)
            && !reaches_all_edges(drawing, rest)
    })
}

fn is_rectangle(shape: &Shape) -> bool {
    let [polygon] = shape.outline.polygons.as_slice() else {
        return false;
    };
    let Some((low, high)) = bounds(&shape.outline) else {
        return false;
    };
    let whole = (high - low).element_product();
    polygon.rings.len() == 1
        && !matches!(shape.paint.key, PaintKey::Picture(_))
        && area(&shape.outline) >= RECTANGULAR * whole
}

/// Whether shapes reach all four edges of the page: then what is drawn fills the page, as a flag does, and a rectangle behind it is a part
/// of it. Further rectangles that cover the page say nothing.
fn reaches_all_edges(drawing: &Drawing, shapes: &[ShapeId]) -> bool {
    let (page, size) = drawing.page;
    let near = EDGE * size;
    let mut reached = [false; 4];
    for shape in shapes {
        let shape = &drawing.shapes[*shape];
        let Some((low, high)) = bounds(&shape.outline) else {
            continue;
        };
        if covers_page(drawing, (low, high)) && is_rectangle(shape) {
            continue;
        }
        let [left, top]: [bool; 2] = low.cmple(page + near).into();
        let [right, bottom]: [bool; 2] = high.cmpge(page + size - near).into();
        for (reached, reaches) in reached.iter_mut().zip([left, top, right, bottom]) {
            *reached |= reaches;
        }
    }
    reached == [true; 4]
}

/// Whether a rectangle holds most of the other shapes.
fn holds(drawing: &Drawing, (low, high): (DVec2, DVec2), others: &[ShapeId]) -> bool {
    let (mut held, mut all) = (0.0, 0.0);
    for other in others {
        let Some((from, to)) = bounds(&drawing.shapes[*other].outline) else {
            continue;
        };
        let shared = (to.min(high) - from.max(low)).max(DVec2::ZERO);
        held += shared.element_product();
        all += (to - from).element_product();
    }
    held >= HELD * all
}

/// Whether a string is grouped with a shape, in a group that does not hold the whole drawing.
fn has_string_beside(
    drawing: &Drawing,
    counts: &TiSlice<GroupId, usize>,
    filled: &[ShapeId],
    shape: ShapeId,
) -> bool {
    let is_in = |shape: ShapeId, wanted: GroupId| {
        let mut group = drawing.shapes[shape].group;
        while group != wanted && group != GroupId::ROOT {
            group = drawing.groups[group].parent;
        }
        group == wanted
    };
    let mut group = drawing.shapes[shape].group;
    while group != GroupId::ROOT {
        let grouped = drawing.groups[group].kind == GroupKind::Group && counts[group] > 0;
        if grouped && !filled.iter().all(|other| is_in(*other, group)) {
            return true;
        }
        group = drawing.groups[group].parent;
    }
    false
}

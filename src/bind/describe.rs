//! Names shapes and groups in messages as a person sees them: by what they are called, else by what they look like.

use glam::DVec2;

use super::bindings::{Bindings, PartId};
use super::names::written_by_a_person;
use crate::geometry::{self, Measure, Outline, Ring, measure, remove_collinear};
use crate::math;
use crate::svg::{Drawing, Element, GroupId, GroupKind, PaintKey, Shape, ShapeId, oklab};

/// The words for colours, each with colours that people call so.
#[rustfmt::skip]
const WORDS: &[(&str, &[[u8; 3]])] = &[
    ("black", &[[0, 0, 0], [28, 28, 30]]),
    ("dark grey", &[[64, 64, 64], [80, 84, 90]]),
    ("grey", &[[112, 112, 112], [128, 128, 128], [150, 155, 165]]),
    ("light grey", &[[190, 190, 190], [215, 215, 215]]),
    ("white", &[[255, 255, 255], [246, 246, 244]]),
    ("red", &[[255, 0, 0], [200, 30, 40], [229, 57, 53], [150, 10, 20]]),
    ("orange", &[[255, 140, 0], [255, 165, 0], [240, 110, 30]]),
    ("yellow", &[[255, 255, 0], [255, 215, 0], [250, 225, 100]]),
    ("green", &[[0, 128, 0], [0, 200, 60], [76, 175, 80], [110, 140, 50]]),
    ("dark green", &[[0, 70, 20], [40, 70, 30]]),
    ("light green", &[[140, 230, 120], [190, 235, 180], [170, 220, 60]]),
    ("turquoise", &[[0, 150, 150], [64, 200, 190], [0, 230, 230]]),
    ("blue", &[[0, 0, 255], [40, 90, 220], [70, 130, 180], [66, 133, 244]]),
    ("dark blue", &[[0, 0, 110], [25, 40, 90]]),
    ("light blue", &[[135, 206, 235], [175, 205, 240], [90, 180, 245]]),
    ("purple", &[[128, 0, 128], [120, 60, 180], [160, 100, 200]]),
    ("pink", &[[255, 192, 203], [255, 105, 180], [240, 150, 180], [255, 0, 255]]),
    ("brown", &[[110, 60, 20], [139, 90, 43], [121, 85, 72], [80, 45, 25]]),
    ("beige", &[[245, 222, 179], [225, 190, 150], [255, 220, 195]]),
];

/// Points of an outline this far from an ellipse, as a share of its size, are not on it.
const OFF_ELLIPSE: f64 = 0.03;
/// An outline with fewer points is a polygon, whatever it comes near to.
const LEAST_OF_A_CURVE: usize = 12;
/// Lengths this close, relative to the larger, look the same.
const ALIKE: f64 = 0.02;
/// A corner this close to the line between its neighbours, as a share of the outline's size, is none.
const STRAIGHT: f64 = 1e-3;
/// Outlines with more points are not searched for corners.
const MANY: usize = 100;
/// How much farther from the middle the tips of a star are than the corners between them.
const TIPS: f64 = 1.2;

impl Bindings {
    /// A part for people: its name, or its shape.
    pub fn describe(&self, drawing: &Drawing, part: PartId) -> String {
        let part = &self.parts[part];
        describe(drawing, &part.name, part.shape)
    }

    /// A part for people who know the drawing only: an automatic name tells them nothing.
    pub fn describe_as_drawn(&self, drawing: &Drawing, part: PartId) -> String {
        if self.parts[part].is_automatic() {
            drawing.describe(self.parts[part].shape)
        } else {
            self.describe(drawing, part)
        }
    }
}

/// A part with this name and shape for people.
pub(super) fn describe(drawing: &Drawing, name: &str, shape: ShapeId) -> String {
    if name.is_empty() {
        drawing.describe(shape)
    } else {
        format!("`{name}`")
    }
}

impl Drawing {
    /// A shape for people: its label, or an id that a person wrote, or what it looks like and where it is.
    pub fn describe(&self, shape: ShapeId) -> String {
        self.shapes[shape].describe(self.page)
    }

    /// A group for people: its label, or an id that a person wrote, or what kind of group it is.
    pub fn describe_group(&self, group: GroupId) -> String {
        let group = &self.groups[group];
        match (group.element.given_name(), group.kind) {
            (Some(name), GroupKind::Layer) => format!("the layer {name}"),
            (Some(name), _) => format!("the group {name}"),
            (None, GroupKind::Root) => "the drawing".to_owned(),
            (None, GroupKind::Layer) => group.element.with_id("a layer".to_owned()),
            (None, GroupKind::Group) => group.element.with_id("a group".to_owned()),
        }
    }
}

impl Shape {
    /// The shape for people, on a page with this minimum corner and size.
    pub fn describe(&self, page: (DVec2, DVec2)) -> String {
        self.describe_as(&self.outline, page)
    }

    /// As [`describe`](Self::describe), for a shape whose own outline is empty.
    pub(crate) fn describe_as(&self, outline: &Outline, page: (DVec2, DVec2)) -> String {
        if let Some(name) = self.element.given_name() {
            return name;
        }
        let is_line = outline.polygons.is_empty() && self.stroke.is_some();
        let drawn = match &self.stroke {
            Some(stroke) if is_line => &stroke.outline(),
            _ => outline,
        };
        let what = match self.paint.key {
            PaintKey::Picture(_) => "picture".to_owned(),
            _ if is_line => format!("{} line", color_word(self.paint.color)),
            _ => {
                let form = form(drawn, self.element.tag);
                format!("{} {form}", color_word(self.paint.color))
            }
        };
        let place = geometry::bounds(drawn).and_then(|bounds| place(bounds, page));
        let place = place.unwrap_or_default();
        // Shorter, except in the middle, which could be that of anything.
        let short = place.strip_suffix(" of the page");
        let place = short.filter(|_| place.starts_with(" at")).unwrap_or(place);
        self.element.with_id(format!("the {what}{place}"))
    }
}

impl Element {
    /// The element for people who know its file: its label or id.
    pub fn describe(&self) -> String {
        match (&self.label, &self.id) {
            (Some(label), _) => format!("`{label}`"),
            (None, Some(id)) => format!("`#{id}`"),
            (None, None) => format!("a `<{}>`", self.tag),
        }
    }

    /// The name that the element gives to a part or layer that a description without a name describes: its label, else its id,
    /// whoever wrote them.
    pub fn own_name(&self) -> &str {
        self.label.as_deref().or(self.id.as_deref()).unwrap_or("")
    }

    /// The label or the id that a person gave to the element.
    fn given_name(&self) -> Option<String> {
        let label = self.label.as_deref().filter(|label| is_given(label));
        let id = self.id.as_deref().filter(|id| is_given(id));
        match (label, id) {
            (Some(label), _) => Some(format!("`{label}`")),
            (None, Some(id)) => Some(format!("`#{id}`")),
            (None, None) => None,
        }
    }

    /// A description, with the element's id behind it for those who look for it in the file.
    fn with_id(&self, description: String) -> String {
        match &self.id {
            Some(id) => format!("{description} (`#{id}`)"),
            None => description,
        }
    }
}

/// Whether a person rather than a program chose a label or an id. A single letter is too little for the name of a part, but it does
/// say which shape is meant.
fn is_given(name: &str) -> bool {
    let mut letters = name.trim().chars();
    let is_letter = letters.next().is_some_and(char::is_alphabetic) && letters.next().is_none();
    is_letter || written_by_a_person(name).is_some()
}

/// The plain word for an sRGB colour.
fn color_word(color: [u8; 3]) -> &'static str {
    let lab = oklab(color);
    let distance = |other: &[u8; 3]| {
        let other = oklab(*other);
        (0..3).map(|i| (lab[i] - other[i]).powi(2)).sum::<f64>()
    };
    let nearest = |samples: &[[u8; 3]]| samples.iter().map(distance).fold(f64::MAX, f64::min);
    let words = WORDS.iter();
    let nearest = words.min_by(|(_, a), (_, b)| nearest(a).total_cmp(&nearest(b)));
    nearest.map_or("grey", |(word, _)| word)
}

/// The word for the form of an outline.
fn form(outline: &Outline, tag: &str) -> &'static str {
    let [polygon] = outline.polygons.as_slice() else {
        return "shape";
    };
    let (Some(border), Some(measure)) = (polygon.rings.first(), measure(outline)) else {
        return "shape";
    };
    let (long, wide) = (measure.half_along, measure.half_across);
    let alike = (long - wide).abs() <= ALIKE * long.max(wide);
    let mut corners = border.clone();
    if corners.len() <= MANY {
        remove_collinear(&mut corners, STRAIGHT * long.max(wide));
    }
    match (corners.len(), polygon.rings.len()) {
        _ if tag == "rect" && alike => "square",
        _ if tag == "rect" => "rectangle",
        (count, rings) if count >= LEAST_OF_A_CURVE && is_ellipse(border, &measure) => {
            match (rings, alike) {
                (1, true) => "circle",
                (1, false) => "ellipse",
                _ => "ring",
            }
        }
        (3, 1) => "triangle",
        (4, 1) if is_rectangle(&corners) && alike => "square",
        (4, 1) if is_rectangle(&corners) => "rectangle",
        (_, 1) if is_star(&corners) => "star",
        _ => "shape",
    }
}

fn is_ellipse(border: &Ring, measure: &Measure) -> bool {
    border.iter().all(|point| {
        let from_center = *point - measure.center;
        let along = from_center.dot(measure.axis) / measure.half_along;
        let across = from_center.dot(measure.axis.perp()) / measure.half_across;
        (math::hypot(along, across) - 1.0).abs() <= OFF_ELLIPSE
    })
}

fn is_rectangle(corners: &Ring) -> bool {
    (0..4).all(|at| {
        let here = corners[at];
        let (before, after) = (corners[(at + 3) % 4] - here, corners[(at + 1) % 4] - here);
        before.dot(after).abs() <= ALIKE * before.length() * after.length()
    })
}

/// Whether corners far from the middle and near to it take turns.
fn is_star(corners: &Ring) -> bool {
    let middle = corners.iter().sum::<DVec2>() / corners.len() as f64;
    let farthest_and_nearest = |from: usize| {
        let distances = corners.iter().skip(from).step_by(2);
        let distances = distances.map(|corner| corner.distance(middle));
        distances.fold((0.0, f64::MAX), |(far, near): (f64, f64), distance| {
            (far.max(distance), near.min(distance))
        })
    };
    let [(far_a, near_a), (far_b, near_b)] = [0, 1].map(farthest_and_nearest);
    corners.len() >= 6
        && corners.len().is_multiple_of(2)
        && (near_a > TIPS * far_b || near_b > TIPS * far_a)
}

/// Where something is on the page, in thirds, with a space before it; `None` if the page has no size.
pub(super) fn place(
    (low, high): (DVec2, DVec2),
    (page_low, page_size): (DVec2, DVec2),
) -> Option<&'static str> {
    let middle = (low.midpoint(high) - page_low) / page_size;
    if !middle.is_finite() {
        return None;
    }
    let page_high = page_low + page_size;
    if high.cmplt(page_low).any() || low.cmpgt(page_high).any() {
        return Some(match (middle.x < 0.0, middle.x > 1.0, middle.y < 0.0) {
            (true, ..) => " to the left of the page",
            (_, true, _) => " to the right of the page",
            (.., true) => " above the page",
            _ => " below the page",
        });
    }
    let third = |share: f64| (share * 3.0).floor().clamp(0.0, 2.0) as usize;
    const PLACES: [[&str; 3]; 3] = [
        [
            " at the top left of the page",
            " at the top of the page",
            " at the top right of the page",
        ],
        [
            " at the left of the page",
            " in the middle of the page",
            " at the right of the page",
        ],
        [
            " at the bottom left of the page",
            " at the bottom of the page",
            " at the bottom right of the page",
        ],
    ];
    Some(PLACES[third(middle.y)][third(middle.x)])
}

//! What a face shows about where its figure looks: eyes, ears, nose, beak, horns, with or without a head of its own.

use glam::DVec2;

use super::{Bounds, For, Observed, middle, shared_width, side_of, weight, width};
use crate::anatomy::{self, Term};
use crate::labels::figure::is_trunk;
use crate::labels::vehicle::boxes;
use crate::labels::{Class, Detail, FigurePartId};

/// A nose leaves the head's outline by at least this share of the head's width, and that of a body by this share of the body's.
const BEYOND: f64 = 0.06;
const BEYOND_BODY: f64 = 0.02;
/// A nose within the outline shows a profile from this share of the head's width away from its middle.
const NOSE_OFF: f64 = 0.25;
/// An eye, a nose or a horn lies beside the middle of a body from this share of the body's width away from it.
const FACE_OFF: f64 = 0.2;
/// An eye that is this share of a head's width off its middle lies on the face's side, unless the head is this much wider than high:
/// behind a muzzle it may be anywhere.
const EYE_OFF: f64 = 0.08;
const MUZZLE: f64 = 1.2;
/// The least and the greatest width of an eye, as a share of the head's.
const EYE: [f64; 2] = [0.03, 0.4];
/// Two eyes lie around the head's middle if theirs is at most this share of the head's width away.
const AROUND: f64 = 0.12;
/// A shape with the name of an eye that is this much wider than high is two of them.
const BOTH_EYES: f64 = 2.2;
/// Two eyes have extents that differ by at most this share, and heights that differ by at most this share of the head's.
const ALIKE: f64 = 0.3;
const LEVEL: f64 = 0.12;
/// Two pieces with the name of eyes have extents that differ by at most this share.
const ALIKE_BY_NAME: f64 = 0.5;
/// The distance between the middles of two eyes, as a share of the head's width.
const EYES_APART: f64 = 0.15;
/// An eye in profile that no name tells is darker than this.
const DARK: f64 = 0.35;
/// The most details of a head that are compared.
const MAX_DETAILS: usize = 48;
/// What is at most this share of the head's width off its axis lies on it, and a mirror image is at most this far from where it
/// should be, along x and along y.
const ON_AXIS: f64 = 0.06;
const MIRRORED: f64 = 0.08;
/// Two ears may be this share of the head's width from mirroring each other.
const EARS_MIRRORED: f64 = 0.25;

/// A piece of a face.
#[derive(Debug, Clone, Copy)]
struct Piece {
    bounds: Bounds,
    /// Its colour, if it is known.
    color: Option<[u8; 3]>,
}

impl Observed<'_> {
    /// What carries the face: the head with its neck, or without a head the trunk.
    fn bearers(&self) -> impl Iterator<Item = FigurePartId> + '_ {
        let has_head = self.head.is_some();
        self.tree.order.iter().copied().filter(move |part| {
            let class = self.drafts[*part].class;
            if has_head {
                matches!(class, Some(Class::Head | Class::Neck))
            } else {
                is_trunk(class)
            }
        })
    }

    /// Parts and details of the head with a name that says this, each piece by its box.
    fn features(&self, term: Term) -> Vec<Bounds> {
        let parts = self.tree.parts.iter_enumerated();
        let parts = parts.filter(|(part, _)| self.drafts[*part].says(&[term]));
        let parts = parts.flat_map(|(index, part)| {
            let details = part.details.iter().flat_map(Detail::boxes);
            let own = boxes(self.tree, index).into_iter();
            apart(own.chain(details.copied()).take(MAX_DETAILS))
        });
        let details = self
            .bearers()
            .flat_map(|part| &self.tree.parts[part].details);
        let named = details.filter(|detail| anatomy::terms(&detail.name).contains(&term));
        let named = named.flat_map(|detail| detail.boxes().iter().copied());
        parts.chain(named).take(MAX_DETAILS).collect()
    }

    /// Whether names tell pieces of a face.
    pub(super) fn has_face(&self) -> bool {
        let terms = [Term::Eye, Term::Nose, Term::Horn, Term::Ear];
        terms.iter().any(|term| !self.features(*term).is_empty())
    }

    /// The middle of what names tell of a face.
    pub(super) fn middle_of_face(&self) -> Option<DVec2> {
        let terms = [Term::Eye, Term::Nose, Term::Horn];
        let all: Vec<Bounds> = terms.iter().flat_map(|term| self.features(*term)).collect();
        let sum: DVec2 = all.iter().map(|own| middle(*own)).sum();
        (!all.is_empty()).then(|| sum / all.len() as f64)
    }

    /// The main outline of the only head. Of a head in several shapes the others may be the nose itself.
    fn head_outline(&self) -> Option<Bounds> {
        let heads: Vec<FigurePartId> = self.of_class(Class::Head).take(2).collect();
        let [head] = heads[..] else {
            return None;
        };
        let head = &self.tree.parts[head];
        let is_known = width(head.main_shape) > 0.0;
        Some(if is_known {
            head.main_shape
        } else {
            head.bounds
        })
    }

    /// The side on which these leave an outline, if they do so on one side only.
    fn beyond(outline: Bounds, features: &[Bounds], least: f64) -> Option<f64> {
        let size = width(outline).max(f64::MIN_POSITIVE);
        let beyond = features
            .iter()
            .map(|own| [outline[0].x - own[0].x, own[1].x - outline[1].x].map(|way| way / size));
        let most = beyond.fold([f64::NEG_INFINITY; 2], |[a, b], [left, right]| {
            [a.max(left), b.max(right)]
        });
        match most.map(|way| way > least) {
            [true, false] => Some(-1.0),
            [false, true] => Some(1.0),
            _ => None,
        }
    }

    pub(super) fn nose(&self, vote: &mut impl FnMut(For, f64, String)) {
        let noses = self.features(Term::Nose);
        let (outline, least, what) = match (self.head, self.trunk) {
            (Some(_), _) => match self.head_outline() {
                Some(outline) => (outline, BEYOND, "head"),
                None => return,
            },
            (None, Some(trunk)) => (trunk, BEYOND_BODY, "body"),
            (None, None) => return,
        };
        if let Some(toward) = Self::beyond(outline, &noses, least) {
            let why = format!(
                "its nose leaves the {what}'s outline on the {}",
                side_of(toward)
            );
            vote(For::Side(toward), weight::NOSE, why);
        } else if self.head.is_some()
            && let [nose] = noses[..]
        {
            let off = middle(nose).x - middle(outline).x;
            if off.abs() > NOSE_OFF * width(outline) {
                let why = format!("its nose lies {} of the head's middle", side_of(off));
                vote(For::Side(off.signum()), weight::HORN, why);
            }
        }
    }

    pub(super) fn horns(&self, vote: &mut impl FnMut(For, f64, String)) {
        let horns = self.features(Term::Horn);
        let head = self.head_outline().map(|head| (head, BEYOND, "head"));
        let body = self.trunk.filter(|_| self.head.is_none());
        let outline = head.or(body.map(|body| (body, BEYOND_BODY, "body")));
        let Some((outline, least, what)) = outline else {
            return;
        };
        if let Some(toward) = Self::beyond(outline, &horns, least) {
            let why = format!(
                "its horn leaves the {what}'s outline on the {}",
                side_of(toward)
            );
            vote(For::Side(toward), weight::HORN, why);
        }
    }

    /// Two eyes beside each other, by name or by what is drawn on the head.
    pub(super) fn two_eyes(&self) -> Option<[Bounds; 2]> {
        let named = self.features(Term::Eye);
        if named.is_empty() {
            let head = self.head?;
            let pieces = self.drawn_on_head();
            let eyes = pieces.iter().filter(|piece| may_be_eye(piece.bounds, head));
            let eyes: Vec<&Piece> = eyes.collect();
            return pairs(&eyes).find_map(|(one, other)| {
                let is_pair =
                    one.color == other.color && are_two_eyes(one.bounds, other.bounds, head, ALIKE);
                is_pair.then_some([one.bounds, other.bounds])
            });
        }
        // Both may be drawn as one shape.
        let both = named.iter().find(|[low, high]| {
            let size = *high - *low;
            size.x > BOTH_EYES * size.y
        });
        let bearer = self.head.or(self.trunk)?;
        let two = pairs(&named).find(|(one, other)| are_eyes_by_name(**one, **other, bearer));
        let two = two.map(|(one, other)| [*one, *other]);
        two.or(both.map(|both| [*both; 2]))
    }

    /// What is drawn on the head, each piece of a shape for itself.
    fn drawn_on_head(&self) -> Vec<Piece> {
        let heads = self.of_class(Class::Head);
        let details = heads.flat_map(|head| &self.tree.parts[head].details);
        let pieces = details.flat_map(|detail| {
            let boxes = detail.boxes().iter();
            boxes.map(|bounds| Piece {
                bounds: *bounds,
                color: Some(detail.color),
            })
        });
        pieces.take(MAX_DETAILS).collect()
    }

    pub(super) fn eyes(&self, vote: &mut impl FnMut(For, f64, String)) {
        let two = "it shows two eyes beside each other".to_owned();
        if let Some(pair) = self.two_eyes() {
            let Some(head) = self.head else {
                vote(For::Front, weight::EYES_ON_BODY, two);
                return;
            };
            let [a, b] = pair.map(|eye| middle(eye).x);
            let off = a.midpoint(b) - middle(head).x;
            let is_around = off.abs() <= AROUND * width(head);
            let more = if is_around {
                weight::AROUND_MIDDLE
            } else {
                0.0
            };
            vote(For::Front, weight::TWO_EYES + more, two);
            return;
        }
        let Some(head) = self.head else {
            self.beside_body(vote);
            return;
        };
        let Some(eye) = self.one_eye(head) else {
            return;
        };
        vote(For::Profile, weight::ONE_EYE, "it shows one eye".to_owned());
        let size = head[1] - head[0];
        let off = (middle(eye).x - middle(head).x) / size.x.max(f64::MIN_POSITIVE);
        if off.abs() > EYE_OFF && size.x <= MUZZLE * size.y {
            let why = format!("the eye lies {} of the head's middle", side_of(off));
            vote(For::Side(off.signum()), weight::EYE, why);
        }
    }

    /// The only eye of a head: by its name, or the largest dark spot.
    fn one_eye(&self, head: Bounds) -> Option<Bounds> {
        if let Some(named) = self.features(Term::Eye).first() {
            return Some(*named);
        }
        let pieces = self.drawn_on_head().into_iter();
        let dark = pieces.filter(|piece| {
            let is_dark = piece.color.is_some_and(|color| luminance(color) < DARK);
            is_dark && may_be_eye(piece.bounds, head)
        });
        let inside = dark.filter(|piece| {
            let at = middle(piece.bounds);
            at.cmpgt(head[0]).all() && at.cmplt(head[1]).all()
        });
        let area = |piece: &Piece| (piece.bounds[1] - piece.bounds[0]).element_product();
        let largest = inside.max_by(|a, b| area(a).total_cmp(&area(b)));
        largest.map(|eye| eye.bounds)
    }

    /// An eye, a nose or a horn on a body without a head of its own, far from its middle.
    fn beside_body(&self, vote: &mut impl FnMut(For, f64, String)) {
        let (Some(trunk), Some(face)) = (self.trunk, self.middle_of_face()) else {
            return;
        };
        let off = face.x - middle(trunk).x;
        if off.abs() <= FACE_OFF * width(trunk) {
            return;
        }
        let features = [
            (Term::Eye, "eye"),
            (Term::Nose, "nose"),
            (Term::Horn, "horn"),
        ];
        let mut features = features.iter();
        let first = features.find(|(term, _)| !self.features(*term).is_empty());
        let what = first.map_or("face", |(_, what)| what);
        let why = format!("its {what} lies {} of the body's middle", side_of(off));
        vote(For::Side(off.signum()), weight::FACE, why);
    }

    /// A face whose pieces mirror each other, and ears on both sides of the head.
    pub(super) fn face(&self, vote: &mut impl FnMut(For, f64, String)) {
        let Some(head) = self.head_outline() else {
            return;
        };
        let axis = middle(head).x;
        let size = head[1] - head[0];
        let ears = self.features(Term::Ear);
        let is_pair = |one: Bounds, other: Bounds| {
            let [a, b] = [one, other].map(|ear| middle(ear).x - axis);
            let is_level = (middle(one).y - middle(other).y).abs() <= EARS_MIRRORED * size.y;
            a * b < 0.0 && (a + b).abs() <= EARS_MIRRORED * size.x && is_level
        };
        if pairs(&ears).any(|(one, other)| is_pair(*one, *other)) {
            let why = "its ears lie on both sides of the head".to_owned();
            vote(For::Front, weight::EARS, why);
        }
        if self.is_face_symmetric(head) {
            let why = "the left and the right half of its face mirror each other".to_owned();
            vote(For::Front, weight::SYMMETRIC_FACE, why);
        }
    }

    /// Whether at least one pair of what is drawn on a head mirrors each other, and most of the rest does, or lies on the axis.
    fn is_face_symmetric(&self, head: Bounds) -> bool {
        let axis = middle(head).x;
        let size = head[1] - head[0];
        let mut pieces = self.drawn_on_head();
        let heads = self.of_class(Class::Head);
        let on_head = heads.flat_map(|head| &self.tree.children[head]);
        let on_head = on_head.flat_map(|part| boxes(self.tree, *part));
        let on_head = on_head.map(|bounds| Piece {
            bounds,
            color: None,
        });
        pieces.extend(on_head.take(MAX_DETAILS));
        pieces.retain(|piece| {
            let at = middle(piece.bounds);
            at.cmpge(head[0]).all() && at.cmple(head[1]).all()
        });
        let off = |piece: &Piece| middle(piece.bounds).x - axis;
        let is_centred = |piece: &&Piece| off(piece).abs() <= ON_AXIS * size.x;
        let mirrors = |one: &Piece, other: &Piece| {
            let [a, b] = [one, other].map(|piece| piece.bounds[1] - piece.bounds[0]);
            let level = middle(one.bounds).y - middle(other.bounds).y;
            (off(one) + off(other)).abs() <= MIRRORED * size.x
                && level.abs() <= MIRRORED * size.y
                && one.color == other.color
                && are_alike(a, b, ALIKE)
        };
        let (centred, beside): (Vec<&Piece>, Vec<&Piece>) =
            pieces.iter().partition(|piece| is_centred(piece));
        let has_mirror = |one: &&&Piece| beside.iter().any(|other| mirrors(one, other));
        let mirrored = beside.iter().filter(has_mirror).count();
        let odd = beside.len() - mirrored;
        mirrored >= 2 && 3 * odd <= mirrored + centred.len()
    }
}

/// Boxes, those that overlap as one: a pupil is no other eye.
fn apart(boxes: impl Iterator<Item = Bounds>) -> Vec<Bounds> {
    let mut apart: Vec<Bounds> = Vec::new();
    for mut own in boxes {
        let touches = |other: &Bounds, own: &Bounds| {
            other[0].cmple(own[1]).all() && own[0].cmple(other[1]).all()
        };
        while let Some(place) = apart.iter().position(|other| touches(other, &own)) {
            let other = apart.swap_remove(place);
            own = [own[0].min(other[0]), own[1].max(other[1])];
        }
        apart.push(own);
    }
    apart
}

/// All pairs, without order.
fn pairs<T>(all: &[T]) -> impl Iterator<Item = (&T, &T)> {
    let each = all.iter().enumerate();
    each.flat_map(move |(place, one)| all[place + 1..].iter().map(move |other| (one, other)))
}

/// Whether two sizes differ by at most a share.
fn are_alike(a: DVec2, b: DVec2, share: f64) -> bool {
    (a - b).abs().cmple(share * a.max(b)).all()
}

fn may_be_eye([low, high]: Bounds, head: Bounds) -> bool {
    let own = high - low;
    let is_round = own.max_element() <= 2.5 * own.min_element();
    is_round && (EYE[0] * width(head)..=EYE[1] * width(head)).contains(&own.x)
}

/// Whether two spots on a head may be its eyes.
fn are_two_eyes(one: Bounds, other: Bounds, head: Bounds, alike: f64) -> bool {
    let size = head[1] - head[0];
    let [a, b] = [one, other].map(|eye| eye[1] - eye[0]);
    let way = middle(other) - middle(one);
    are_alike(a, b, alike)
        && way.y.abs() <= LEVEL * size.y
        && way.x.abs() >= EYES_APART * size.x
        && shared_width(one, other) <= 0.0
}

/// Whether two pieces with the name of eyes are two eyes, not one with its brow or its highlight.
fn are_eyes_by_name(one: Bounds, other: Bounds, bearer: Bounds) -> bool {
    let [a, b] = [one, other].map(|eye| eye[1] - eye[0]);
    let level = (middle(other).y - middle(one).y).abs();
    shared_width(one, other) <= 0.0
        && are_alike(a, b, ALIKE_BY_NAME)
        && level <= (2.0 * LEVEL * (bearer[1].y - bearer[0].y)).max(a.y.max(b.y))
}

/// How bright a colour is, 0 to 1.
fn luminance(color: [u8; 3]) -> f64 {
    let [r, g, b] = color.map(|channel| f64::from(channel) / 255.0);
    0.299 * r + 0.587 * g + 0.114 * b
}

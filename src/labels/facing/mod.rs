//! The direction that a figure faces: what it shows about it, and what that adds up to.
//!
//! Nothing that a figure shows is certain: a cat seen from the front has its tail at one side, and a dog in profile may show both
//! eyes. So everything votes. What votes for a side also votes for a profile; the figure is seen in profile if these votes weigh more
//! than those for the front, and it faces the side that has more of them.

mod above;
mod face;
mod vehicle;

use glam::DVec2;

use super::figure::{Drafts, is_trunk};
use super::part_tree::PartTree;
use super::segments::{self, Limb};
use super::vehicle as wheeled;
use super::{Class, Facing, FigurePartId, Side};
use crate::anatomy::{self, Term};

/// How much each observation weighs.
mod weight {
    /// Words that say far and near, fore and hind of legs, or left and right of limbs that lie beside each other.
    pub(super) const WORDS: f64 = 3.0;
    /// Most parts have a mirror image.
    pub(super) const SYMMETRY: f64 = 3.0;
    /// What is drawn on the face has mirror images: that weighs more than all that legs and arms may show together.
    pub(super) const SYMMETRIC_FACE: f64 = 5.0;
    /// Round wheels in a row.
    pub(super) const WHEELS: f64 = 3.0;
    /// The head, or the neck's root, beside the trunk's middle.
    pub(super) const HEAD: f64 = 2.0;
    /// A nose, beak or muzzle that leaves the head's outline.
    pub(super) const NOSE: f64 = 2.0;
    /// An eye, a nose or a horn beside the middle of a body without a head of its own.
    pub(super) const FACE: f64 = 2.0;
    /// A horn that leaves the head's outline, or a nose within it beside the head's middle.
    pub(super) const HORN: f64 = 1.0;
    /// Two ears on both sides of the head.
    pub(super) const EARS: f64 = 1.0;
    /// Legs that overlap, lie beside each other, or stand in a row.
    pub(super) const LEGS: f64 = 1.5;
    /// Feet that all point to one side.
    pub(super) const FEET: f64 = 1.5;
    /// Two arms that overlap, or lie on both sides of the trunk.
    pub(super) const ARMS: f64 = 1.0;
    /// One eye.
    pub(super) const ONE_EYE: f64 = 1.5;
    /// An eye beside the middle of a head without a muzzle.
    pub(super) const EYE: f64 = 0.5;
    /// Two eyes beside each other: many animals in profile show both.
    pub(super) const TWO_EYES: f64 = 1.0;
    /// Added to that if they lie on both sides of the head's middle.
    pub(super) const AROUND_MIDDLE: f64 = 1.0;
    /// Two eyes on a body without a head of its own.
    pub(super) const EYES_ON_BODY: f64 = 3.0;
    /// A tail at the other side.
    pub(super) const TAIL: f64 = 1.0;
    /// A near limb that is called left or right.
    pub(super) const NEAR: f64 = 1.0;
    /// A head above the trunk's middle.
    pub(super) const UPRIGHT: f64 = 0.5;
}

/// The neck's root, or the head, lies beside the trunk from this share of the trunk's width away from its middle.
const BESIDE: f64 = 0.35;
/// A head at most this share of the trunk's width beside its middle is above it.
const ABOVE: f64 = 0.15;
/// Two limbs overlap if they share this much of the narrower one's width, or if their joints are not farther apart than this share of
/// the trunk's width: the legs of a person who walks past are wide apart at their feet only.
const OVERLAP: f64 = 0.5;
const SAME_JOINT: f64 = 0.2;
/// Joints of limbs that lie beside each other are at least this share of the trunk's width apart.
const JOINTS_APART: f64 = 0.3;
/// A foot points to the side to which its middle is off its joint by this share of its width.
const POINTS: f64 = 0.07;
/// A trunk this much wider than high has one pair of legs in front and one behind, not left and right ones.
const LONG: f64 = 1.2;
/// Legs in a row reach over at least this share of the trunk's width.
const ROW: f64 = 0.3;
/// A shape with the head that is at least this share of the trunk's width wide has patches all over the trunk.
const PATCHES: f64 = 0.9;
/// Where only words say that a figure is seen from its side, its face tells which if it is at least this share of the trunk's width
/// off its middle.
const HINT: f64 = 0.02;

/// The direction that a figure faces, and why.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct FoundFacing {
    /// The direction.
    pub facing: Facing,
    /// Whether a string says so.
    pub by_string: bool,
    /// What speaks for it, for people to read.
    pub reasons: Vec<String>,
    /// What speaks against it.
    pub doubts: Vec<String>,
    /// Whether it is a vehicle that shows its wheels.
    pub is_vehicle: bool,
    /// Whether names tell pieces of a face: an eye, a nose, a horn.
    pub has_face: bool,
    /// Whether it shows two eyes, so that its far side has no face of its own.
    pub shows_two_eyes: bool,
}

/// What a vote is for.
#[derive(Debug, Clone, Copy, PartialEq)]
enum For {
    Front,
    /// A profile, to whichever side.
    Profile,
    /// −1 for the drawing's left, 1 for its right.
    Side(f64),
}

#[derive(Debug)]
struct Vote {
    says: For,
    weight: f64,
    why: String,
}

/// Counts the votes of a figure. What its string says needs no vote.
pub(super) fn find(tree: &PartTree<'_>, drafts: &Drafts) -> FoundFacing {
    let observed = Observed::new(tree, drafts);
    let seen = FoundFacing {
        is_vehicle: !observed.wheels.is_empty(),
        has_face: observed.has_face(),
        shows_two_eyes: observed.two_eyes().is_some(),
        ..FoundFacing::default()
    };
    if let Some(facing) = tree.facing {
        return FoundFacing {
            facing: if facing.is_from_above() {
                observed.up()
            } else {
                facing
            },
            by_string: true,
            reasons: vec![format!("its string says `Facing {}`", facing.word())],
            doubts: Vec::new(),
            ..seen
        };
    }
    let mut votes = observed.votes();
    votes.extend(observed.guess(&votes));
    let sum = |says: For| {
        let votes = votes.iter().filter(|vote| vote.says == says);
        votes.map(|vote| vote.weight).sum::<f64>()
    };
    let [left, right] = [-1.0, 1.0].map(|side| sum(For::Side(side)));
    let profile = sum(For::Profile) + (left - right).abs();
    let facing = match right - left {
        more if more == 0.0 || profile <= sum(For::Front) => Facing::Viewer,
        more if more < 0.0 => Facing::Left,
        _ => Facing::Right,
    };
    let from_above = observed.seen_from_above();
    if let Some((facing, why)) = from_above.filter(|_| facing == Facing::Viewer) {
        return FoundFacing {
            facing,
            reasons: vec![why],
            ..seen
        };
    }
    let agrees = |says: For| match facing {
        Facing::Viewer | Facing::Away | Facing::Up | Facing::UpHeadDown => says == For::Front,
        Facing::Left => matches!(says, For::Profile) || says == For::Side(-1.0),
        Facing::Right => matches!(says, For::Profile) || says == For::Side(1.0),
    };
    let (reasons, doubts): (Vec<Vote>, Vec<Vote>) =
        votes.into_iter().partition(|vote| agrees(vote.says));
    let texts = |votes: Vec<Vote>| votes.into_iter().map(|vote| vote.why).collect();
    let mut reasons: Vec<String> = texts(reasons);
    if reasons.is_empty() {
        reasons.push("nothing shows a profile".to_owned());
    }
    FoundFacing {
        facing,
        by_string: false,
        reasons,
        doubts: texts(doubts),
        ..seen
    }
}

/// The drawing's side of a direction along x.
fn side_of(toward: f64) -> &'static str {
    if toward < 0.0 { "left" } else { "right" }
}

type Bounds = [DVec2; 2];

fn middle([low, high]: Bounds) -> DVec2 {
    low.midpoint(high)
}

fn width([low, high]: Bounds) -> f64 {
    high.x - low.x
}

/// How much of the narrower box's width two boxes share; negative if they are apart.
fn shared_width(one: Bounds, other: Bounds) -> f64 {
    let shared = one[1].x.min(other[1].x) - one[0].x.max(other[0].x);
    let narrow = width(one).min(width(other));
    if narrow > 0.0 { shared / narrow } else { 0.0 }
}

/// What is known of a figure before it is asked where it looks.
struct Observed<'a> {
    tree: &'a PartTree<'a>,
    drafts: &'a Drafts,
    limbs: Vec<Limb>,
    trunk: Option<Bounds>,
    head: Option<Bounds>,
    /// The wheels in a row that show a vehicle from its side.
    wheels: Vec<Bounds>,
    /// Whether it is a vehicle, none of whose parts is a head or a limb.
    is_thing: bool,
}

impl<'a> Observed<'a> {
    fn new(tree: &'a PartTree<'a>, drafts: &'a Drafts) -> Self {
        let around = |wanted: &dyn Fn(Option<Class>) -> bool| {
            let parts = tree.order.iter().copied();
            let mut parts = parts.filter(|part| wanted(drafts[*part].class)).peekable();
            parts.peek().is_some().then(|| tree.around(parts))
        };
        let wheels = wheeled::wheels(tree);
        Self {
            tree,
            drafts,
            limbs: segments::limbs(tree, drafts),
            trunk: around(&is_trunk),
            head: around(&|class| class == Some(Class::Head)),
            is_thing: !wheels.is_empty() && wheeled::is_lifeless(drafts),
            wheels,
        }
    }

    fn votes(&self) -> Vec<Vote> {
        let mut votes = Vec::new();
        let mut vote = |says: For, weight: f64, why: String| votes.push(Vote { says, weight, why });
        self.wheels(&mut vote);
        if self.is_thing {
            return votes;
        }
        self.head(&mut vote);
        self.limbs(&mut vote);
        self.words(&mut vote);
        self.feet(&mut vote);
        self.tail(&mut vote);
        self.nose(&mut vote);
        self.horns(&mut vote);
        self.eyes(&mut vote);
        self.face(&mut vote);
        votes
    }

    /// The side of a figure of which words or wheels say that it is seen from its side, but nothing says which: that of its face,
    /// and a vehicle looks left, as most drawings do.
    fn guess(&self, votes: &[Vote]) -> Option<Vote> {
        let sum = |of: &dyn Fn(&Vote) -> f64| votes.iter().map(of).sum::<f64>();
        let toward = sum(&|vote| match vote.says {
            For::Side(toward) => toward * vote.weight,
            For::Front | For::Profile => 0.0,
        });
        let [profile, front] = [For::Profile, For::Front]
            .map(|says| sum(&|vote| if vote.says == says { vote.weight } else { 0.0 }));
        let is_said = profile >= weight::WORDS && profile > front && toward == 0.0;
        let trunk = self.trunk.filter(|_| is_said)?;
        let face = self.place_of_head().or(self.middle_of_face());
        let off = face.map_or(0.0, |face| face.x - middle(trunk).x);
        if off.abs() > HINT * width(trunk) {
            return Some(Vote {
                says: For::Side(off.signum()),
                weight: weight::EYE,
                why: format!("its face lies {} of the trunk's middle", side_of(off)),
            });
        }
        (!self.wheels.is_empty()).then(|| Vote {
            says: For::Side(-1.0),
            weight: weight::EYE,
            why: "nothing says where its front end is, and most drawings look left".to_owned(),
        })
    }

    fn of_class(&self, class: Class) -> impl Iterator<Item = FigurePartId> + '_ {
        let order = self.tree.order.iter().copied();
        order.filter(move |part| self.drafts[*part].class == Some(class))
    }

    /// The head's middle. Of a head that has patches of the trunk in the same shape, the face tells where it is.
    fn place_of_head(&self) -> Option<DVec2> {
        let head = self.head?;
        let is_patched = |trunk: Bounds| width(head) >= PATCHES * width(trunk);
        let face = self.middle_of_face();
        let face = face.filter(|_| self.trunk.is_some_and(is_patched));
        Some(face.unwrap_or(middle(head)))
    }

    fn head(&self, vote: &mut impl FnMut(For, f64, String)) {
        let (Some(trunk), Some(head)) = (self.trunk, self.place_of_head()) else {
            return;
        };
        let axis = middle(trunk).x;
        if self.tree.is_symmetric(axis) {
            vote(
                For::Front,
                weight::SYMMETRY,
                "its left and right halves mirror each other".to_owned(),
            );
        }
        // The top of a long neck may be anywhere: a flamingo's head hangs over its back.
        let on_trunk = |part: &FigurePartId| {
            let above = self.tree.parents[*part];
            above.is_none_or(|above| is_trunk(self.drafts[above].class))
        };
        let neck = self.of_class(Class::Neck).find(on_trunk);
        let (at, what) = match neck {
            Some(neck) => (self.tree.joint(neck).x, "neck begins"),
            None => (head.x, "head lies"),
        };
        let off = at - axis;
        let share = off.abs() / width(trunk);
        if share > BESIDE {
            let why = format!("its {what} {} of the trunk's middle", side_of(off));
            vote(For::Side(off.signum()), weight::HEAD, why);
        } else if share < ABOVE && neck.is_none() {
            let why = "its head lies above or below the trunk's middle".to_owned();
            vote(For::Front, weight::UPRIGHT, why);
        }
    }

    /// The boxes of all parts of the limbs of a class, each with where the limb's joint is along x.
    fn boxes(&self, class: Class) -> Vec<(Bounds, f64)> {
        let limbs = self.limbs.iter().filter(|limb| limb.class == class);
        let boxes = limbs.map(|limb| {
            let parts = limb.parts.iter().map(|(part, _)| *part);
            (self.tree.around(parts), self.tree.joint(limb.root()).x)
        });
        let mut boxes: Vec<(Bounds, f64)> = boxes.collect();
        boxes.sort_by(|a, b| middle(a.0).x.total_cmp(&middle(b.0).x));
        boxes
    }

    fn limbs(&self, vote: &mut impl FnMut(For, f64, String)) {
        let Some(trunk) = self.trunk else {
            return;
        };
        let size = trunk[1] - trunk[0];
        let is_long = size.x > LONG * size.y;
        let axis = middle(trunk).x;
        let across = |a: Bounds, b: Bounds| (middle(a).x - axis) * (middle(b).x - axis) < 0.0;
        for (class, weight) in [(Class::Leg, weight::LEGS), (Class::Arm, weight::ARMS)] {
            let name = class.name();
            match *self.boxes(class).as_slice() {
                [(a, from), (b, to)] => {
                    let joints = (to - from).abs() / size.x.max(f64::MIN_POSITIVE);
                    if shared_width(a, b) >= OVERLAP || joints <= SAME_JOINT {
                        vote(For::Profile, weight, format!("its {name}s overlap"));
                    } else if shared_width(a, b) <= 0.0
                        && joints >= JOINTS_APART
                        && across(a, b)
                        && !is_long
                    {
                        let why = format!("its {name}s lie beside each other");
                        vote(For::Front, weight, why);
                    }
                }
                [(a, _), (b, _), (c, _), (d, _)] if class == Class::Leg && is_long => {
                    let between = middle(c).x - middle(b).x;
                    let apart = |one: Bounds, other: Bounds| middle(other).x - middle(one).x;
                    if apart(a, b).max(apart(c, d)) < between && across(b, c) {
                        let why = "its legs stand in pairs, one behind the other".to_owned();
                        vote(For::Profile, weight, why);
                    }
                }
                [first, .., last] if class == Class::Leg && is_long => {
                    self.row_of_legs(&[first.0, last.0], size.x, vote);
                }
                [(_, _)] if class == Class::Leg && is_long => {
                    self.row_of_legs(&[], size.x, vote);
                }
                _ => {}
            }
        }
    }

    /// Legs in a row under a long trunk, each with its box or all in one shape.
    fn row_of_legs(&self, legs: &[Bounds], trunk: f64, vote: &mut impl FnMut(For, f64, String)) {
        let parts = self.of_class(Class::Leg);
        let pieces = parts.flat_map(|leg| self.tree.parts[leg].pieces.iter().copied());
        let all: Vec<Bounds> = legs.iter().copied().chain(pieces).collect();
        let ends = all.iter().copied().map(|leg| middle(leg).x);
        let [from, to] = ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[from, to], x| {
            [from.min(x), to.max(x)]
        });
        if all.len() > 1 && to - from >= ROW * trunk {
            let why = "its legs stand in a row under a long body".to_owned();
            vote(For::Profile, weight::LEGS, why);
        }
    }

    /// What names of limbs say: fore and hind, left and right.
    fn words(&self, vote: &mut impl FnMut(For, f64, String)) {
        let Some(trunk) = self.trunk else {
            return;
        };
        let says = |part: &FigurePartId| {
            let name = self.tree.name(*part);
            let has_more = !self.drafts[*part].terms.is_empty();
            has_more && anatomy::says_far_or_near(name)
        };
        if self.tree.order.iter().any(says) {
            let why = "names say what is on its far and on its near side".to_owned();
            vote(For::Profile, weight::WORDS, why);
        }
        let legs = self.limbs.iter().filter(|limb| limb.class == Class::Leg);
        let legs: Vec<&Limb> = legs.collect();
        let mean = |terms: &[Term]| {
            let said = legs.iter().filter(|leg| {
                let mut parts = leg.parts.iter();
                parts.any(|(part, _)| self.drafts[*part].says(terms))
            });
            let at: Vec<f64> = said.map(|leg| self.tree.joint(leg.root()).x).collect();
            (!at.is_empty()).then(|| at.iter().sum::<f64>() / at.len() as f64)
        };
        let fore = mean(&[Term::Fore]);
        // What is not called a fore leg is a hind one.
        let hind = mean(&[Term::Hind, Term::Back]);
        let far = BESIDE / 2.0 * width(trunk);
        if let (Some(fore), Some(hind)) = (fore, hind)
            && (fore - hind).abs() > far
        {
            let off = fore - hind;
            let why = format!("its front legs stand {} of the hind ones", side_of(off));
            vote(For::Side(off.signum()), weight::WORDS, why);
        }
        for (class, name) in [(Class::Leg, "leg"), (Class::Arm, "arm")] {
            let limbs = || self.limbs.iter().filter(|limb| limb.class == class);
            let called = |side: Side| {
                let mut limbs = limbs().filter(|limb| {
                    let mut parts = limb.parts.iter();
                    parts.any(|(part, _)| self.drafts[*part].side == Some(side))
                });
                limbs.next().filter(|_| limbs.next().is_none())
            };
            let [Some(left), Some(right)] = Side::BOTH.map(called) else {
                continue;
            };
            let [a, b] = [left, right]
                .map(|limb| self.tree.around(limb.parts.iter().map(|(part, _)| *part)));
            let order = |limb: &Limb| self.tree.parts[limb.root()].drawing_order;
            if shared_width(a, b) <= 0.0 {
                let why = format!("its left and right {name} lie beside each other");
                vote(For::Front, weight::WORDS, why);
            } else if shared_width(a, b) >= OVERLAP && order(left) != order(right) {
                // The left side is the near one of a figure that faces left.
                let (near, toward) = if order(left) > order(right) {
                    ("left", -1.0)
                } else {
                    ("right", 1.0)
                };
                let why = format!("its {near} {name} is the near one");
                vote(For::Side(toward), weight::NEAR, why);
            }
        }
    }

    fn feet(&self, vote: &mut impl FnMut(For, f64, String)) {
        let is_foot = |part: &FigurePartId| {
            let is_last = !self.tree.children[*part]
                .iter()
                .any(|child| self.drafts[*child].class == Some(Class::Leg));
            self.drafts[*part].says(&[Term::Foot]) && is_last
        };
        let feet: Vec<FigurePartId> = self.tree.order.iter().copied().filter(is_foot).collect();
        let off = |foot: &FigurePartId| {
            let own = self.tree.around(std::iter::once(*foot));
            // Of a foot by itself the middle of what it hangs on tells where the ankle is.
            let above = self.tree.parents[*foot];
            let leg = above.filter(|above| self.drafts[*above].class == Some(Class::Leg));
            let ankle = leg.map(|leg| {
                let [joint, tip] = [self.tree.joint(leg), self.tree.tip(leg)];
                let near = middle(own);
                if near.distance_squared(joint) < near.distance_squared(tip) {
                    joint.x
                } else {
                    tip.x
                }
            });
            let ankle = ankle.unwrap_or(self.tree.joint(*foot).x);
            (middle(own).x - ankle) / width(own).max(f64::MIN_POSITIVE)
        };
        let ways: Vec<f64> = feet.iter().map(off).collect();
        if ways.len() < 2 {
            return;
        }
        for toward in [-1.0, 1.0] {
            if ways.iter().all(|way| way * toward > POINTS) {
                let why = format!("its feet point {}", side_of(toward));
                vote(For::Side(toward), weight::FEET, why);
            }
        }
    }

    fn tail(&self, vote: &mut impl FnMut(For, f64, String)) {
        let (Some(trunk), Some(tail)) = (self.trunk, self.of_class(Class::Tail).next()) else {
            return;
        };
        let own = self.tree.around(std::iter::once(tail));
        let off = middle(own).x - middle(trunk).x;
        if off.abs() > BESIDE * width(trunk) {
            let why = format!("its tail lies {} of the trunk's middle", side_of(off));
            vote(For::Side(-off.signum()), weight::TAIL, why);
        }
    }
}

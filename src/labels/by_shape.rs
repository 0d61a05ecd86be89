//! Labels parts of a figure whose names say nothing: trunk, head, arms, legs and tail by their shape and place.

use glam::DVec2;
use typed_index_collections::TiSlice;

use super::figure::{Drafts, PartDraft, is_trunk};
use super::part_tree::PartTree;
use super::placement::Front;
use super::{Class, FigurePartId, beside, facing, held};
use crate::anatomy::Term;

/// An unnamed arm is at least this share of the figure's height long.
const ARM_LENGTH: f64 = 0.1;
/// It points outward by at least this share of the height.
const OUTWARD: f64 = 0.02;
/// What is at least this share of the trunk's width wide, with its middle within this share of its own width from that of the trunk, is at
/// both of its sides.
const WINGS: f64 = 0.6;
const CENTRED: f64 = 0.15;
/// Two parts whose mirrored centres are within this share of the height are a pair, so neither is the head.
const TWIN: f64 = 0.1;
/// A part whose joint is at most this share of its length from the middle of its axis has none of its own: it turns about its middle.
const MIDDLE: f64 = 0.1;
/// A leg that does not stand on the ground is at least and at most this much as long and as wide as the one that does.
const OTHER_LEG: std::ops::RangeInclusive<f64> = 0.6..=1.6;
/// How many candidates for a head are tried.
const MAX_HEADS: usize = 16;
/// A trunk at least this much wider than high is that of an animal in profile.
const LEVEL: f64 = 1.2;
/// By how much of the figure's height a head may lie lower than a tail if something is attached to it, such as ears.
const EARS: f64 = 0.25;
/// A part that is drawn after the trunk and of whose bounding box at least this share lies within the trunk's is on the trunk.
const OVER: f64 = 0.7;
/// A part of the trunk of which at least this share lies within another segment of it is on that segment.
const INSIDE: f64 = 0.9;
/// A part that carries a head and is narrower than this share of it is a neck.
const NECK: f64 = 0.6;
/// A part with this many chains longer than itself is the trunk of an insect or a spider.
const MANY_CHAINS: usize = 4;
/// With this many limbs without names, all of them are legs: no figure has so many arms.
const MANY_LIMBS: usize = 7;
/// With this many, they are if the trunk lies on the ground, as that of an insect seen from above.
const LIMBS_AROUND: usize = 5;
/// Such a trunk ends at most this share of the height above the ground.
const LOW: f64 = 0.25;

/// Finds the trunk: roots that have children. If no name tells a trunk, the root with the most descendants is one. So are
/// parts of it that carry a head, both arms or many limbs.
pub(super) fn trunk(tree: &PartTree<'_>, drafts: &mut Drafts) {
    let bare = |part: &FigurePartId| {
        let draft = &drafts[*part];
        tree.parents[*part].is_none() && draft.class.is_none() && !draft.detail
    };
    let roots: Vec<FigurePartId> = tree.order.iter().copied().filter(bare).collect();
    let known = drafts.iter().any(|draft| is_trunk(draft.class));
    let most = roots
        .iter()
        .copied()
        .reduce(|best, root| {
            if tree.descendants[root] > tree.descendants[best] {
                root
            } else {
                best
            }
        })
        .filter(|_| !known);
    for root in roots {
        if Some(root) == most || tree.descendants[root] > 0 {
            let why = format!("`{}` carries the others, so it is a body", tree.name(root));
            drafts[root].set(Class::Body, why);
        }
    }
    let reaches = tree.reaches();
    for part in tree.order.iter().copied() {
        let draft = &drafts[part];
        let on_trunk = tree.parents[part].is_some_and(|above| is_trunk(drafts[above].class));
        if draft.class.is_some() || draft.detail || !on_trunk {
            continue;
        }
        if let Some((class, carried)) = carrier(tree, drafts, &reaches, part) {
            let name = tree.name(part);
            let is = match class {
                Class::Neck => "the neck",
                _ => "a body",
            };
            drafts[part].set(class, format!("`{name}` carries {carried}, so it is {is}"));
        }
    }
}

/// What a part between the trunk and others is by what it carries.
fn carrier(
    tree: &PartTree<'_>,
    drafts: &Drafts,
    reaches: &TiSlice<FigurePartId, f64>,
    part: FigurePartId,
) -> Option<(Class, &'static str)> {
    let children = &tree.children[part];
    let of_class = |class: Class| {
        let children = children.iter().copied();
        children.filter(move |child| drafts[*child].class == Some(class))
    };
    let size = tree.size(part);
    if let Some(head) = of_class(Class::Head).next() {
        return Some(if size.x < NECK * tree.size(head).x {
            (Class::Neck, "the head")
        } else {
            (Class::Body, "the head")
        });
    }
    let sides: Vec<_> = of_class(Class::Arm)
        .filter_map(|arm| drafts[arm].side)
        .collect();
    if sides.iter().any(|side| *side != sides[0]) {
        return Some((Class::Body, "both arms"));
    }
    let long = children
        .iter()
        .filter(|child| reaches[**child] >= size.max_element() && !drafts[**child].detail);
    (long.count() >= MANY_CHAINS).then_some((Class::Body, "many limbs"))
}

/// Segments of the trunk that lie on another segment, such as the white belly of a penguin, go along with it.
pub(super) fn patches(tree: &PartTree<'_>, drafts: &mut Drafts) {
    for part in tree.order.iter().copied() {
        let Some(above) = tree.parents[part] else {
            continue;
        };
        let both = [part, above].map(|part| is_trunk(drafts[part].class));
        let is_on = tree.is_over(part, tree.around(std::iter::once(above)), INSIDE)
            && tree.parts[part].drawing_order > tree.parts[above].drawing_order;
        let carries = tree.children[part]
            .iter()
            .any(|child| drafts[*child].class.is_some());
        if both == [true; 2] && is_on && !carries {
            drafts[part].class = None;
            drafts[part].detail = true;
        }
    }
}

/// Whether a part's class may be told by its shape: it has none yet, and is attached to the trunk or is a root.
fn is_open(tree: &PartTree<'_>, drafts: &Drafts, part: FigurePartId) -> bool {
    let draft = &drafts[part];
    let above = tree.parents[part].map(|parent| drafts[parent].class);
    let on_trunk = above.is_none_or(|class| is_trunk(class) || class == Some(Class::Neck));
    draft.class.is_none() && !draft.detail && on_trunk
}

/// Takes the topmost part as the head if no name tells one. It sticks out of the trunk and is not one of a pair. If only
/// something that heads wear has a name, the head is below it, or it stands for the head.
pub(super) fn head(tree: &PartTree<'_>, drafts: &mut Drafts) {
    let is_head = |draft: &PartDraft| draft.class == Some(Class::Head);
    let worn = drafts.position(is_head);
    if worn.is_some_and(|part| !drafts[part].says(&[Term::HeadWear])) {
        return;
    }
    let trunk = tree.around(trunk_parts(tree, drafts));
    let axis = trunk[0].midpoint(trunk[1]);
    let mut heads: Vec<FigurePartId> = drafts
        .keys()
        .filter(|part| is_open(tree, drafts, *part) && !tree.stands(*part))
        .filter(|part| !drafts[*part].says(&[Term::Left, Term::Right]))
        .filter(|part| {
            let middle = tree.middle(*part);
            middle.cmplt(trunk[0]).any() || middle.cmpgt(trunk[1]).any()
        })
        .filter(|part| worn.is_none_or(|worn| tree.may_wear(*part, worn)))
        .collect();
    let size = trunk[1] - trunk[0];
    // Compares centres, because a raised hand may be higher than the top of a head.
    let rise = |part: FigurePartId| {
        let off = tree.middle(part) - axis;
        let ears = size.x > LEVEL * size.y && !tree.children[part].is_empty();
        off.y - off.x.abs() / 2.0 + if ears { EARS * tree.height } else { 0.0 }
    };
    heads.sort_by(|a, b| rise(*b).total_cmp(&rise(*a)).then(a.cmp(b)));
    let near = TWIN * tree.height;
    let twin = |part: FigurePartId| {
        let off = tree.middle(part) - axis;
        let mirrored = |other: &&FigurePartId| {
            let other = tree.middle(**other) - axis;
            (other.x + off.x).abs() <= near && (other.y - off.y).abs() <= near
        };
        off.x.abs() > near / 2.0
            && heads
                .iter()
                .filter(|other| **other != part)
                .any(|other| mirrored(&other))
    };
    let found = heads
        .iter()
        .copied()
        .take(MAX_HEADS)
        .find(|part| !twin(*part));
    let Some(mut head) = found else {
        return;
    };
    if let Some(worn) = worn {
        drafts[worn].class = None;
        drafts[worn].detail = true;
    }
    if let Some(larger) = larger_on_top(tree, drafts, head) {
        let why = format!("`{}` carries the head, so it is the neck", tree.name(head));
        drafts[head].set(Class::Neck, why);
        head = larger;
    }
    let why = format!(
        "`{}` is the topmost part, so it is the head",
        tree.name(head)
    );
    drafts[head].set(Class::Head, why);
}

/// The part on top of another one if it is larger, as a head on its neck.
fn larger_on_top(tree: &PartTree<'_>, drafts: &Drafts, part: FigurePartId) -> Option<FigurePartId> {
    let area = |part: FigurePartId| tree.size(part).element_product();
    let is_free = |child: &FigurePartId| drafts[*child].class.is_none() && !drafts[*child].detail;
    let above = tree.children[part].iter().copied().filter(is_free);
    above
        .filter(|child| tree.middle(*child).y > tree.middle(part).y && area(*child) > area(part))
        .max_by(|a, b| area(*a).total_cmp(&area(*b)).then(b.cmp(a)))
}

fn trunk_parts(tree: &PartTree<'_>, drafts: &Drafts) -> impl Iterator<Item = FigurePartId> {
    let order = tree.order.iter().copied();
    order.filter(|part| is_trunk(drafts[*part].class))
}

/// Labels what hangs on the trunk, and the next segments of limbs.
pub(super) fn limbs(tree: &PartTree<'_>, drafts: &mut Drafts) {
    let facing = Front::of(tree, drafts, facing::find(tree, drafts).facing);
    let with_hands = held::with_hands(tree, drafts);
    let trunk = tree.around(trunk_parts(tree, drafts));
    let reaches = tree.reaches();
    let mut has_tail = drafts.iter().any(|draft| draft.class == Some(Class::Tail));
    for part in tree.order.iter().copied() {
        let name = tree.name(part);
        if drafts[part].class.is_some() {
            continue;
        }
        if let Some(why) = held::by_arm(tree, drafts, &with_hands, part) {
            drafts[part].detail = true;
            drafts[part].held = Some(why);
        }
        if drafts[part].detail {
            continue;
        }
        let above = tree.parents[part];
        let class_above = above.and_then(|above| drafts[above].class);
        if let (Some(above), Some(class @ (Class::Arm | Class::Leg | Class::Tail))) =
            (above, class_above)
        {
            let above = tree.name(above);
            let why = format!(
                "`{name}` is attached to `{above}`, so it is the next piece of the same {}",
                class.name()
            );
            drafts[part].set(class, why);
        } else if !is_open(tree, drafts, part)
            || is_over_trunk(tree, drafts, trunk, part)
            || tree.is_below_all(part, trunk)
            || encloses(tree, trunk, part)
        {
            continue;
        } else if tree.stands(part) {
            let legs = tree.children[part].iter().filter(|child| {
                tree.stands(**child)
                    && matches!(drafts[**child].class, None | Some(Class::Leg))
                    && !drafts[**child].detail
            });
            if legs.count() > 1 {
                drafts[part].set(
                    Class::Hips,
                    format!("`{name}` carries legs, so it is the hips"),
                );
            } else {
                drafts[part].set(
                    Class::Leg,
                    format!("`{name}` stands on the ground, so it is a leg"),
                );
            }
        } else if is_other_leg(tree, drafts, &reaches, trunk, part) {
            let why = format!(
                "`{name}` is like the leg that stands on the ground, so it is the other one"
            );
            drafts[part].set(Class::Leg, why);
        } else if is_raised_leg(tree, trunk, part) {
            let why = format!("`{name}` points down below the trunk, so it is a leg");
            drafts[part].set(Class::Leg, why);
        } else if let Some(class) = outward(tree, &facing, drafts, trunk, part) {
            // A figure has one tail: what else is behind it is a bag, or a cloak.
            if class == Class::Tail && std::mem::replace(&mut has_tail, true) {
                continue;
            }
            let why = match class {
                Class::Tail => format!("`{name}` points away from the head, so it is a tail"),
                _ => format!("`{name}` points outward, so it is an arm"),
            };
            drafts[part].set(class, why);
        }
    }
    beside::arms(tree, drafts, trunk);
    many_legs(tree, drafts, trunk);
}

/// Whether a part is drawn on the trunk, like a button or a chest panel, or around it, like a belt.
fn is_over_trunk(
    tree: &PartTree<'_>,
    drafts: &Drafts,
    trunk: [DVec2; 2],
    part: FigurePartId,
) -> bool {
    let below = tree.parents[part].filter(|above| is_trunk(drafts[*above].class));
    let drawn = |part: FigurePartId| tree.parts[part].drawing_order;
    let is_later = below.is_some_and(|below| drawn(part) > drawn(below));
    is_later && (is_around(tree, trunk, part) || tree.is_over(part, trunk, OVER))
}

/// Whether the trunk lies within a part, as within its outline or its shadow.
fn encloses(tree: &PartTree<'_>, trunk: [DVec2; 2], part: FigurePartId) -> bool {
    let [low, high] = tree.around(std::iter::once(part));
    low.cmple(trunk[0]).all() && high.cmpge(trunk[1]).all()
}

/// Whether a part sticks out at both sides of the trunk.
fn is_around(tree: &PartTree<'_>, trunk: [DVec2; 2], part: FigurePartId) -> bool {
    let [low, high] = tree.around(std::iter::once(part));
    let beyond = OUTWARD * tree.height;
    low.x <= trunk[0].x - beyond && high.x >= trunk[1].x + beyond
}

/// Whether a part hangs from the lower half of the trunk to below it.
fn is_raised_leg(tree: &PartTree<'_>, [low, high]: [DVec2; 2], part: FigurePartId) -> bool {
    let (joint, tip) = (tree.joint(part), tree.tip(part));
    tree.parents[part].is_some()
        && joint.y < f64::midpoint(low.y, high.y)
        && tip.y < low.y - OUTWARD * tree.height
        && tip.y < joint.y - ARM_LENGTH * tree.height
}

/// Whether a part hangs on the lower half of an upright trunk and is as long and as wide as the only leg that stands on the ground.
fn is_other_leg(
    tree: &PartTree<'_>,
    drafts: &Drafts,
    reaches: &TiSlice<FigurePartId, f64>,
    trunk: [DVec2; 2],
    part: FigurePartId,
) -> bool {
    let Some(above) = tree.parents[part].filter(|_| is_upright(trunk)) else {
        return false;
    };
    let mut standing = tree.children[above].iter().copied().filter(|other| {
        tree.stands(*other)
            && !drafts[*other].detail
            && matches!(drafts[*other].class, None | Some(Class::Leg))
    });
    let (Some(leg), None) = (standing.next(), standing.next()) else {
        return false;
    };
    let alike = |own: f64, other: f64| OTHER_LEG.contains(&(own / other));
    axis(tree, trunk, part)[0].y < f64::midpoint(trunk[0].y, trunk[1].y)
        && alike(tree.parts[part].width, tree.parts[leg].width)
        && alike(reaches[part], reaches[leg])
}

/// Whether a trunk is higher than wide.
fn is_upright([low, high]: [DVec2; 2]) -> bool {
    let size = high - low;
    size.y > size.x
}

/// The ends of a part's axis, the nearer one to the middle of the trunk first if the part turns about its own middle, else its joint.
fn axis(tree: &PartTree<'_>, trunk: [DVec2; 2], part: FigurePartId) -> [DVec2; 2] {
    let [near, far] = tree.ends(part);
    let joint = tree.joint(part);
    if joint.distance(near.midpoint(far)) > MIDDLE * near.distance(far) {
        return [joint, tree.tip(part)];
    }
    let middle = trunk[0].midpoint(trunk[1]);
    if near.distance_squared(middle) <= far.distance_squared(middle) {
        [near, far]
    } else {
        [far, near]
    }
}

/// An arm points away from the middle of the trunk; in profile, what points away from the head is a tail, unless it hangs on the upper
/// half of an upright trunk.
fn outward(
    tree: &PartTree<'_>,
    facing: &Front,
    drafts: &Drafts,
    trunk: [DVec2; 2],
    part: FigurePartId,
) -> Option<Class> {
    let body = tree.parents[part].filter(|parent| is_trunk(drafts[*parent].class));
    let around = body.map_or(trunk, |body| tree.around(std::iter::once(body)));
    let middle = around[0].midpoint(around[1]);
    // An arm is at one side of the trunk. Wings in one shape behind it are at both.
    let width = tree.size(part).x;
    let is_wide = width >= WINGS * (around[1].x - around[0].x);
    let is_centred = (tree.middle(part).x - middle.x).abs() <= CENTRED * width;
    if is_around(tree, around, part) || is_wide && is_centred {
        return None;
    }
    let [joint, tip] = axis(tree, around, part);
    let reach = (tip.x - middle.x).abs();
    let points = reach > (joint.x - middle.x).abs() + OUTWARD * tree.height;
    let beside = !(around[0].x..=around[1].x).contains(&tree.middle(part).x);
    if joint.distance(tip) < ARM_LENGTH * tree.height || !points && !beside {
        return None;
    }
    match facing {
        Front::Beside { toward, .. }
            if (tree.middle(part).x - middle.x) * toward < 0.0
                && !(is_upright(around) && joint.y > middle.y) =>
        {
            Some(Class::Tail)
        }
        _ => Some(Class::Arm),
    }
}

/// Makes legs of all limbs without a name if there are too many for a figure with arms: insects and spiders are often drawn from
/// above, where some legs point up. A figure without legs also walks on arms and tentacles by name: an octopus.
fn many_legs(tree: &PartTree<'_>, drafts: &mut Drafts, trunk: [DVec2; 2]) {
    let is_limb = |part: FigurePartId| drafts[part].class.is_some_and(Class::is_limb);
    let is_root = |part: &FigurePartId| {
        let continues = tree.parents[*part].is_some_and(is_limb);
        is_limb(*part) && !continues
    };
    let count = |may_be_named: bool| {
        let roots = drafts.keys().filter(is_root);
        roots
            .filter(|part| may_be_named || !drafts[*part].named)
            .count()
    };
    let has_legs = drafts.iter().any(|draft| draft.class == Some(Class::Leg));
    let lies = trunk[0].y <= tree.above_ground(LOW);
    let walks_on_arms = !has_legs && count(true) >= MANY_LIMBS;
    let count = count(walks_on_arms);
    if count < MANY_LIMBS && (count < LIMBS_AROUND || !lies) {
        return;
    }
    for (part, draft) in drafts.iter_mut_enumerated() {
        if draft.class == Some(Class::Arm) && (walks_on_arms || !draft.named) {
            let why = format!(
                "`{}` belongs to one of {count} limbs, so it is a leg",
                tree.name(part)
            );
            draft.set(Class::Leg, why);
        }
    }
}

/// A segment of the trunk that carries legs but neither head nor arms is the hips. A skirt or trousers are only if they carry legs.
pub(super) fn hips(tree: &PartTree<'_>, drafts: &mut Drafts) {
    let carries = |drafts: &Drafts, part: FigurePartId, classes: &[Class]| {
        let mut carried = tree.children[part]
            .iter()
            .filter_map(|child| drafts[*child].class);
        carried.any(|class| classes.contains(&class))
    };
    let upper = [Class::Head, Class::Neck, Class::Arm];
    let has_upper = drafts
        .keys()
        .any(|part| drafts[part].class == Some(Class::Body) && carries(drafts, part, &upper));
    for part in drafts.keys() {
        let draft = &drafts[part];
        let unnamed = draft.class == Some(Class::Body) && !draft.named && has_upper;
        let carries_legs = carries(drafts, part, &[Class::Leg]);
        let is_skirt = draft.class == Some(Class::Hips) && draft.says(&[Term::HipWear]);
        if unnamed && carries_legs && !carries(drafts, part, &upper) {
            let why = format!("`{}` carries the legs, so it is the hips", tree.name(part));
            drafts[part].set(Class::Hips, why);
        } else if is_skirt && !carries_legs && tree.parents[part].is_some() {
            drafts[part].class = None;
            drafts[part].detail = true;
        }
    }
}

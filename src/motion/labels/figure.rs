//! The parts of a figure, labelled: by their names, and where those say nothing by their shape.

use glam::DVec2;

use super::place::{self, Front};
use super::shape::Shape;
use super::words::{self, Term};
use super::{Class, Facing, Label, Piece, Side, pieces};
use crate::motion::figure::Figure;

/// An arm without a name reaches at least this share of the figure's height.
const ARM_LENGTH: f64 = 0.1;
/// It points outward by at least this share.
const OUTWARD: f64 = 0.02;
/// Two parts this share of the height apart from each other's mirror image are a pair, and so no head.
const TWIN: f64 = 0.1;
/// Candidates for a head that are looked at.
const MAX_HEADS: usize = 16;

/// What is known of a part.
#[derive(Debug, Clone, Default)]
pub(super) struct Draft {
    pub(super) class: Option<Class>,
    pub(super) side: Option<Side>,
    /// What its name says.
    pub(super) terms: Vec<Term>,
    /// Whether its name tells its class.
    pub(super) named: bool,
    /// Worn, held or a feature of a face: follows what it hangs on.
    pub(super) detail: bool,
    pub(super) piece: Option<Piece>,
    pub(super) pair: usize,
    /// Why it has its class, and why its side.
    pub(super) why: [String; 2],
}

impl Draft {
    pub(super) fn says(&self, wanted: &[Term]) -> bool {
        self.terms.iter().any(|term| wanted.contains(term))
    }

    fn set(&mut self, class: Class, why: String) {
        self.class = Some(class);
        self.why[0] = why;
    }
}

/// Labels the parts of a figure; nothing for what follows the part that it hangs on.
///
/// Class by word, else: a child of a limb is its next piece, what stands on the ground is a leg, the topmost part the head, what
/// points outward an arm. Side by word, else by place: what is drawn left is Right, since the figure faces the viewer; if the
/// head lies more beside the body than above it, what was drawn later is on the near side.
pub fn label_figure(figure: &Figure) -> Vec<Option<Label>> {
    label_facing(figure).0
}

/// The labels of a figure's parts, and the way that it faces.
pub(crate) fn label_facing(figure: &Figure) -> (Vec<Option<Label>>, Facing) {
    let shape = Shape::new(figure);
    let mut drafts: Vec<Draft> = shape.parts.iter().map(|part| by_name(&part.name)).collect();
    trunk(&shape, &mut drafts);
    head(&shape, &mut drafts);
    by_shape(&shape, &mut drafts);
    hips(&shape, &mut drafts);
    let facing = Front::of(&shape, &drafts);
    let limbs = pieces::limbs(&shape, &drafts);
    place::sides(&shape, &facing, &limbs, &mut drafts);
    place::pairs(&shape, &facing, &limbs, &mut drafts);
    pieces::name(&shape, &limbs, &mut drafts);
    let label = |draft: Draft| {
        let class = draft.class?;
        let [class_why, side_why] = draft.why;
        Some(Label {
            class,
            side: draft.side.filter(|_| class.is_limb()),
            piece: draft.piece.unwrap_or(Piece::Whole),
            pair: draft.pair,
            why: class_why + &side_why,
        })
    };
    (drafts.into_iter().map(label).collect(), facing.facing())
}

fn by_name(name: &str) -> Draft {
    use Term as T;
    let terms = words::terms(name);
    let mut draft = Draft {
        terms,
        ..Draft::default()
    };
    draft.side = match (draft.says(&[T::Left]), draft.says(&[T::Right])) {
        (true, false) => Some(Side::Left),
        (false, true) => Some(Side::Right),
        _ => None,
    };
    draft.detail = draft.says(&[T::Detail, T::Helper]);
    if draft.detail {
        return draft;
    }
    let sided = draft.side.is_some();
    let class = if draft.says(&[T::Arm, T::UpperArm, T::LowerArm, T::Hand]) {
        Some(Class::Arm)
    } else if draft.says(&[T::Leg, T::Thigh, T::Shin, T::Foot]) {
        Some(Class::Leg)
    } else if sided && draft.says(&[T::Shoulder, T::Collar]) {
        Some(Class::Arm)
    } else if sided && draft.says(&[T::Hip, T::Toe]) {
        Some(Class::Leg)
    } else if draft.says(&[T::Head, T::Face]) {
        Some(Class::Head)
    } else if draft.says(&[T::Neck]) {
        Some(Class::Neck)
    } else if draft.says(&[T::Tail]) {
        Some(Class::Tail)
    } else if draft.says(&[T::Hips, T::Hip, T::Waist])
        || draft.says(&[T::Lower]) && draft.says(&[T::Body])
    {
        Some(Class::Hips)
    } else if draft.says(&[T::Body, T::Chest, T::Belly]) {
        Some(Class::Body)
    } else {
        None
    };
    if let Some(class) = class {
        draft.named = true;
        draft.set(class, format!("`{name}` is {} by its name", a(class)));
    }
    draft
}

/// What carries the rest: of the parts that hang on nothing, those that carry something; without a trunk by name, the one that
/// carries most.
fn trunk(shape: &Shape<'_>, drafts: &mut [Draft]) {
    let bare = |part: &usize| {
        let draft = &drafts[*part];
        shape.parents[*part].is_none() && draft.class.is_none() && !draft.detail
    };
    let roots: Vec<usize> = shape.order.iter().copied().filter(bare).collect();
    let known = drafts.iter().any(|draft| is_trunk(draft.class));
    let most = roots
        .iter()
        .copied()
        .reduce(|best, root| {
            if shape.carried[root] > shape.carried[best] {
                root
            } else {
                best
            }
        })
        .filter(|_| !known);
    for root in roots {
        if Some(root) == most || shape.carried[root] > 0 {
            let why = format!(
                "`{}` carries the others, so it is a body",
                shape.parts[root].name
            );
            drafts[root].set(Class::Body, why);
        }
    }
    for part in 0..drafts.len() {
        let on_head =
            shape.parents[part].is_some_and(|parent| drafts[parent].class == Some(Class::Head));
        // A face on a head is a part of it.
        if on_head && drafts[part].says(&[Term::Face]) {
            drafts[part].class = None;
            drafts[part].detail = true;
        }
    }
}

pub(super) fn is_trunk(class: Option<Class>) -> bool {
    matches!(class, Some(Class::Body | Class::Hips))
}

/// Whether a part's shape may tell its class: it has none, and hangs on the trunk or on nothing.
fn open(shape: &Shape<'_>, drafts: &[Draft], part: usize) -> bool {
    let draft = &drafts[part];
    let above = shape.parents[part].map(|parent| drafts[parent].class);
    let on_trunk = above.is_none_or(|class| is_trunk(class) || class == Some(Class::Neck));
    draft.class.is_none() && !draft.detail && on_trunk
}

/// The topmost part as the head, where no name tells one. It stands out of the trunk and is not one of a pair.
fn head(shape: &Shape<'_>, drafts: &mut [Draft]) {
    if drafts.iter().any(|draft| draft.class == Some(Class::Head)) {
        return;
    }
    let trunk = shape.around(
        shape
            .order
            .iter()
            .copied()
            .filter(|part| is_trunk(drafts[*part].class)),
    );
    let axis = trunk[0].midpoint(trunk[1]);
    let mut heads: Vec<usize> = (0..drafts.len())
        .filter(|part| open(shape, drafts, *part) && !shape.stands(*part))
        .filter(|part| !drafts[*part].says(&[Term::Skirt, Term::Left, Term::Right]))
        .filter(|part| {
            let middle = shape.middle(*part);
            middle.cmplt(trunk[0]).any() || middle.cmpgt(trunk[1]).any()
        })
        .collect();
    // The middle of a part: a raised hand may be higher than the top of a head.
    let rise = |part: usize| {
        let off = shape.middle(part) - axis;
        off.y - off.x.abs() / 2.0
    };
    heads.sort_by(|a, b| rise(*b).total_cmp(&rise(*a)).then(a.cmp(b)));
    let near = TWIN * shape.height;
    let twin = |part: usize| {
        let off = shape.middle(part) - axis;
        let mirrored = |other: &&usize| {
            let other = shape.middle(**other) - axis;
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
    if let Some(head) = found {
        let why = format!(
            "`{}` is the topmost part, so it is the head",
            shape.parts[head].name
        );
        drafts[head].set(Class::Head, why);
    }
}

fn by_shape(shape: &Shape<'_>, drafts: &mut [Draft]) {
    let facing = Front::of(shape, drafts);
    let trunk = shape
        .order
        .iter()
        .copied()
        .filter(|part| is_trunk(drafts[*part].class));
    let trunk = shape.around(trunk);
    for part in shape.order.iter().copied() {
        let name = &shape.parts[part].name;
        if drafts[part].class.is_some() || drafts[part].detail {
            continue;
        }
        let above = shape.parents[part];
        let class_above = above.and_then(|above| drafts[above].class);
        if let (Some(above), Some(class @ (Class::Arm | Class::Leg | Class::Tail))) =
            (above, class_above)
        {
            let above = &shape.parts[above].name;
            let why = format!(
                "`{name}` hangs on `{above}`, so it is the next piece of the same {}",
                class.name()
            );
            drafts[part].set(class, why);
        } else if !open(shape, drafts, part) || drafts[part].says(&[Term::Skirt]) {
            continue;
        } else if shape.stands(part) {
            let legs = shape.children[part].iter().filter(|child| {
                shape.stands(**child)
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
        } else if let Some(class) = outward(shape, &facing, drafts, trunk, part) {
            let why = match class {
                Class::Tail => format!("`{name}` points away from the head, so it is a tail"),
                _ => format!("`{name}` points outward, so it is an arm"),
            };
            drafts[part].set(class, why);
        }
    }
}

/// An arm points away from the middle of the trunk; in a figure seen from the side, what points away behind is a tail.
fn outward(
    shape: &Shape<'_>,
    facing: &Front,
    drafts: &[Draft],
    trunk: [DVec2; 2],
    part: usize,
) -> Option<Class> {
    let body = shape.parents[part].filter(|parent| is_trunk(drafts[*parent].class));
    let around = body.map_or(trunk, |body| shape.around(std::iter::once(body)));
    let axis = around[0].midpoint(around[1]).x;
    let (joint, tip) = (shape.joint(part), shape.tip(part));
    let reach = (tip.x - axis).abs();
    let points = reach > (joint.x - axis).abs() + OUTWARD * shape.height;
    let beside = !(around[0].x..=around[1].x).contains(&shape.middle(part).x);
    if joint.distance(tip) < ARM_LENGTH * shape.height || !points && !beside {
        return None;
    }
    match facing {
        Front::Beside { toward, .. } if (shape.middle(part).x - axis) * toward < 0.0 => {
            Some(Class::Tail)
        }
        _ => Some(Class::Arm),
    }
}

/// A trunk piece or a skirt that carries legs below a piece that carries head or arms is the hips.
fn hips(shape: &Shape<'_>, drafts: &mut [Draft]) {
    let carries = |drafts: &[Draft], part: usize, classes: &[Class]| {
        let mut carried = shape.children[part]
            .iter()
            .filter_map(|child| drafts[*child].class);
        carried.any(|class| classes.contains(&class))
    };
    let upper = [Class::Head, Class::Neck, Class::Arm];
    let has_upper = (0..drafts.len())
        .any(|part| drafts[part].class == Some(Class::Body) && carries(drafts, part, &upper));
    for part in 0..drafts.len() {
        let draft = &drafts[part];
        let skirt = draft.class.is_none() && draft.says(&[Term::Skirt]);
        let unnamed = draft.class == Some(Class::Body) && !draft.named && has_upper;
        if (skirt || unnamed)
            && carries(drafts, part, &[Class::Leg])
            && !carries(drafts, part, &upper)
        {
            let why = format!(
                "`{}` carries the legs, so it is the hips",
                shape.parts[part].name
            );
            drafts[part].set(Class::Hips, why);
        }
    }
}

/// A class with its article.
fn a(class: Class) -> String {
    match class {
        Class::Arm => "an arm".to_owned(),
        Class::Hips => "the hips".to_owned(),
        _ => format!("a {}", class.name()),
    }
}

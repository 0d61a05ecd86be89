//! Labels the parts of a figure: by name, and where names say nothing by shape.

use glam::DVec2;

use super::part_tree::PartTree;
use super::placement::{self, Front};
use super::{Class, Facing, Label, Piece, Side, pieces};
use crate::anatomy::{self, Term};
use crate::motion::figure::Figure;

/// An unnamed arm is at least this share of the figure's height long.
const ARM_LENGTH: f64 = 0.1;
/// It points outward by at least this share of the height.
const OUTWARD: f64 = 0.02;
/// Two parts whose mirrored centres are within this share of the height are a pair, so neither is the head.
const TWIN: f64 = 0.1;
/// How many candidates for a head are tried.
const MAX_HEADS: usize = 16;

/// What is known of a part so far.
#[derive(Debug, Clone, Default)]
pub(super) struct PartDraft {
    pub(super) class: Option<Class>,
    pub(super) side: Option<Side>,
    /// What its name says about it.
    pub(super) terms: Vec<Term>,
    /// Whether its name gives its class.
    pub(super) named: bool,
    /// Worn, held or part of a face: it follows its parent.
    pub(super) detail: bool,
    pub(super) piece: Option<Piece>,
    pub(super) pair: usize,
    /// The reasons for its class and for its side.
    pub(super) why: [String; 2],
}

impl PartDraft {
    pub(super) fn says(&self, wanted: &[Term]) -> bool {
        self.terms.iter().any(|term| wanted.contains(term))
    }

    fn set(&mut self, class: Class, why: String) {
        self.class = Some(class);
        self.why[0] = why;
    }
}

/// Labels the parts of a figure; `None` for a part that follows its parent.
///
/// Class by word. Otherwise a child of a limb is its next piece, what stands on the ground is a leg, the topmost part is the
/// head, and what points outward is an arm. Side by word. Otherwise by place: the drawn left is the figure's right, since it
/// faces the viewer. If the head lies more beside the body than above it, the figure is seen in profile, and limbs drawn later
/// are on its near side.
pub fn label_figure(figure: &Figure) -> Vec<Option<Label>> {
    label_facing(figure).0
}

/// The labels of a figure's parts, and the direction that the figure faces.
pub(crate) fn label_facing(figure: &Figure) -> (Vec<Option<Label>>, Facing) {
    let tree = PartTree::new(figure);
    let mut drafts: Vec<PartDraft> = tree.parts.iter().map(|part| by_name(&part.name)).collect();
    trunk(&tree, &mut drafts);
    head(&tree, &mut drafts);
    by_shape(&tree, &mut drafts);
    hips(&tree, &mut drafts);
    let facing = Front::of(&tree, &drafts);
    let limbs = pieces::limbs(&tree, &drafts);
    placement::sides(&tree, &facing, &limbs, &mut drafts);
    placement::pairs(&tree, &facing, &limbs, &mut drafts);
    pieces::name(&tree, &limbs, &mut drafts);
    let label = |draft: PartDraft| {
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

fn by_name(name: &str) -> PartDraft {
    use Term as T;
    let terms = anatomy::terms(name);
    let mut draft = PartDraft {
        terms,
        ..PartDraft::default()
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
        draft.set(
            class,
            format!("`{name}` is {} by its name", with_article(class)),
        );
    }
    draft
}

/// Finds the trunk: roots that have children. If no name tells a trunk, the root with the most descendants is one.
fn trunk(tree: &PartTree<'_>, drafts: &mut [PartDraft]) {
    let bare = |part: &usize| {
        let draft = &drafts[*part];
        tree.parents[*part].is_none() && draft.class.is_none() && !draft.detail
    };
    let roots: Vec<usize> = tree.order.iter().copied().filter(bare).collect();
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
            let why = format!(
                "`{}` carries the others, so it is a body",
                tree.parts[root].name
            );
            drafts[root].set(Class::Body, why);
        }
    }
    for part in 0..drafts.len() {
        let on_head =
            tree.parents[part].is_some_and(|parent| drafts[parent].class == Some(Class::Head));
        // A face on a head is a feature of it.
        if on_head && drafts[part].says(&[Term::Face]) {
            drafts[part].class = None;
            drafts[part].detail = true;
        }
    }
}

pub(super) fn is_trunk(class: Option<Class>) -> bool {
    matches!(class, Some(Class::Body | Class::Hips))
}

/// Whether a part's class may be told by its shape: it has none yet, and is attached to the trunk or is a root.
fn is_open(tree: &PartTree<'_>, drafts: &[PartDraft], part: usize) -> bool {
    let draft = &drafts[part];
    let above = tree.parents[part].map(|parent| drafts[parent].class);
    let on_trunk = above.is_none_or(|class| is_trunk(class) || class == Some(Class::Neck));
    draft.class.is_none() && !draft.detail && on_trunk
}

/// Takes the topmost part as the head if no name tells one. It sticks out of the trunk and is not one of a pair.
fn head(tree: &PartTree<'_>, drafts: &mut [PartDraft]) {
    if drafts.iter().any(|draft| draft.class == Some(Class::Head)) {
        return;
    }
    let trunk = tree.around(
        tree.order
            .iter()
            .copied()
            .filter(|part| is_trunk(drafts[*part].class)),
    );
    let axis = trunk[0].midpoint(trunk[1]);
    let mut heads: Vec<usize> = (0..drafts.len())
        .filter(|part| is_open(tree, drafts, *part) && !tree.stands(*part))
        .filter(|part| !drafts[*part].says(&[Term::Skirt, Term::Left, Term::Right]))
        .filter(|part| {
            let middle = tree.middle(*part);
            middle.cmplt(trunk[0]).any() || middle.cmpgt(trunk[1]).any()
        })
        .collect();
    // Compares centres, because a raised hand may be higher than the top of a head.
    let rise = |part: usize| {
        let off = tree.middle(part) - axis;
        off.y - off.x.abs() / 2.0
    };
    heads.sort_by(|a, b| rise(*b).total_cmp(&rise(*a)).then(a.cmp(b)));
    let near = TWIN * tree.height;
    let twin = |part: usize| {
        let off = tree.middle(part) - axis;
        let mirrored = |other: &&usize| {
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
    if let Some(head) = found {
        let why = format!(
            "`{}` is the topmost part, so it is the head",
            tree.parts[head].name
        );
        drafts[head].set(Class::Head, why);
    }
}

fn by_shape(tree: &PartTree<'_>, drafts: &mut [PartDraft]) {
    let facing = Front::of(tree, drafts);
    let trunk = tree
        .order
        .iter()
        .copied()
        .filter(|part| is_trunk(drafts[*part].class));
    let trunk = tree.around(trunk);
    for part in tree.order.iter().copied() {
        let name = &tree.parts[part].name;
        if drafts[part].class.is_some() || drafts[part].detail {
            continue;
        }
        let above = tree.parents[part];
        let class_above = above.and_then(|above| drafts[above].class);
        if let (Some(above), Some(class @ (Class::Arm | Class::Leg | Class::Tail))) =
            (above, class_above)
        {
            let above = &tree.parts[above].name;
            let why = format!(
                "`{name}` is attached to `{above}`, so it is the next piece of the same {}",
                class.name()
            );
            drafts[part].set(class, why);
        } else if !is_open(tree, drafts, part) || drafts[part].says(&[Term::Skirt]) {
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
        } else if let Some(class) = outward(tree, &facing, drafts, trunk, part) {
            let why = match class {
                Class::Tail => format!("`{name}` points away from the head, so it is a tail"),
                _ => format!("`{name}` points outward, so it is an arm"),
            };
            drafts[part].set(class, why);
        }
    }
}

/// An arm points away from the middle of the trunk; in profile, what points away from the head is a tail.
fn outward(
    tree: &PartTree<'_>,
    facing: &Front,
    drafts: &[PartDraft],
    trunk: [DVec2; 2],
    part: usize,
) -> Option<Class> {
    let body = tree.parents[part].filter(|parent| is_trunk(drafts[*parent].class));
    let around = body.map_or(trunk, |body| tree.around(std::iter::once(body)));
    let axis = around[0].midpoint(around[1]).x;
    let (joint, tip) = (tree.joint(part), tree.tip(part));
    let reach = (tip.x - axis).abs();
    let points = reach > (joint.x - axis).abs() + OUTWARD * tree.height;
    let beside = !(around[0].x..=around[1].x).contains(&tree.middle(part).x);
    if joint.distance(tip) < ARM_LENGTH * tree.height || !points && !beside {
        return None;
    }
    match facing {
        Front::Beside { toward, .. } if (tree.middle(part).x - axis) * toward < 0.0 => {
            Some(Class::Tail)
        }
        _ => Some(Class::Arm),
    }
}

/// A piece of the trunk, or a skirt, that carries legs but neither head nor arms is the hips.
fn hips(tree: &PartTree<'_>, drafts: &mut [PartDraft]) {
    let carries = |drafts: &[PartDraft], part: usize, classes: &[Class]| {
        let mut carried = tree.children[part]
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
                tree.parts[part].name
            );
            drafts[part].set(Class::Hips, why);
        }
    }
}

/// The name of a class with its article.
fn with_article(class: Class) -> String {
    match class {
        Class::Arm => "an arm".to_owned(),
        Class::Hips => "the hips".to_owned(),
        _ => format!("a {}", class.name()),
    }
}

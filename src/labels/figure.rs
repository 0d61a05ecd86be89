//! Labels the parts of a figure: by name, and where names say nothing by shape (`by_shape`).

use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::part_tree::PartTree;
use super::placement::{self, Front};
use super::{Class, FoundFacing, Label, LimbSegment, Side, by_shape, facing, segments, vehicle};
use crate::anatomy::{self, Term, name_words};
use crate::labels::{Figure, FigurePartId};

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
    /// Why it is held by an arm, if it is.
    pub(super) held: Option<String>,
    pub(super) segment: Option<LimbSegment>,
    pub(super) pair: usize,
    /// The reasons for its class and for its side.
    pub(super) why: [String; 2],
}

/// What is known of the parts of a figure so far.
pub(super) type Drafts = TiSlice<FigurePartId, PartDraft>;

impl PartDraft {
    pub(super) fn says(&self, wanted: &[Term]) -> bool {
        self.terms.iter().any(|term| wanted.contains(term))
    }

    pub(super) fn set(&mut self, class: Class, why: String) {
        self.class = Some(class);
        self.why[0] = why;
    }
}

/// Labels the parts of a figure; `None` for a part that follows its parent.
///
/// Class by word. Otherwise a child of a limb is its next segment, what stands on the ground is a leg, the topmost part is the
/// head, and what points outward is an arm. Side by word. Otherwise by place: the drawn left is the figure's right, if it
/// faces the viewer. Of a figure in profile, limbs drawn later are on its near side.
pub(crate) fn label_figure(figure: &Figure) -> TiVec<FigurePartId, Option<Label>> {
    label_drawn(figure).labels
}

/// A labelled figure.
#[derive(Debug)]
pub(crate) struct LabeledFigure {
    /// Per part its label; `None` for a part that follows its parent.
    pub(crate) labels: TiVec<FigurePartId, Option<Label>>,
    /// Per part whether it belongs to a limb that the figure spreads: a wing or a tentacle that does not hang down, a leg where
    /// there are three pairs or more, or a foot that is attached to the trunk.
    pub(crate) splayed: TiVec<FigurePartId, bool>,
    /// Per part the reason why an arm holds it, if one does.
    pub(crate) held: TiVec<FigurePartId, Option<String>>,
    /// Whether the name of one of its parts says what that is, as those of living things do.
    pub(crate) has_names: bool,
    /// The direction that the figure faces, and why.
    pub(crate) facing: FoundFacing,
}

/// Labels a figure's parts, and tells how it is drawn.
pub(crate) fn label_drawn(figure: &Figure) -> LabeledFigure {
    let tree = PartTree::new(figure);
    let mut drafts = by_names(figure);
    details(&tree, &mut drafts);
    by_shape::trunk(&tree, &mut drafts);
    by_shape::patches(&tree, &mut drafts);
    if !vehicle::is_alone(&tree, &drafts) {
        by_shape::head(&tree, &mut drafts);
        by_shape::limbs(&tree, &mut drafts);
        by_shape::hips(&tree, &mut drafts);
    }
    let found = facing::find(&tree, &drafts);
    let facing = Front::of(&tree, &drafts, found.facing);
    merged_limbs(&tree, &mut drafts);
    let limbs = segments::limbs(&tree, &drafts);
    placement::sides(&tree, &facing, &limbs, &mut drafts);
    placement::pairs(&tree, &facing, &limbs, &mut drafts);
    segments::name(&tree, &limbs, &mut drafts);
    let splayed = segments::splayed(&tree, &limbs, &drafts);
    let held = drafts.iter().map(|draft| draft.held.clone()).collect();
    let has_names = drafts.iter().any(|draft| draft.named);
    let label = |draft: PartDraft| {
        let class = draft.class?;
        let [class_why, side_why] = draft.why;
        Some(Label {
            class,
            side: draft.side.filter(|_| class.is_limb()),
            segment: draft.segment.unwrap_or(LimbSegment::Whole),
            pair: draft.pair,
            why: class_why + &side_why,
        })
    };
    LabeledFigure {
        labels: drafts.into_iter().map(label).collect(),
        splayed,
        held,
        has_names,
        facing: found,
    }
}

/// What the names say.
fn by_names(figure: &Figure) -> TiVec<FigurePartId, PartDraft> {
    let parts = &figure.parts;
    let mut drawn: Vec<FigurePartId> = parts.keys().collect();
    drawn.sort_by_key(|part| parts[*part].drawing_order);
    let names = drawn.iter().map(|part| anatomy::terms(&parts[*part].name));
    let mut names: Vec<Vec<Term>> = names.collect();
    let called = |part: &FigurePartId| parts[*part].name.as_str();
    elephants_trunk(&drawn.iter().map(called).collect::<Vec<_>>(), &mut names);
    anatomy::dress(&mut names);
    let mut drafts = ti_vec![PartDraft::default(); parts.len()];
    for (part, terms) in drawn.into_iter().zip(names) {
        drafts[part] = by_name(&parts[part].name, terms);
    }
    drafts
}

/// A trunk beside a body is an elephant's.
fn elephants_trunk(names: &[&str], terms: &mut [Vec<Term>]) {
    let is_trunk = |name: &str| name_words::has_word(name, "trunk");
    let mut named = names.iter().zip(&*terms);
    if !named.any(|(name, terms)| terms.contains(&Term::Body) && !is_trunk(name)) {
        return;
    }
    let trunks = names.iter().zip(terms).filter(|(name, _)| is_trunk(name));
    for (_, terms) in trunks {
        terms.retain(|term| *term != Term::Body);
        terms.extend([Term::Detail, Term::OfHead, Term::Nose]);
    }
}

fn by_name(name: &str, terms: Vec<Term>) -> PartDraft {
    use Term as T;
    let mut draft = PartDraft {
        terms,
        ..PartDraft::default()
    };
    draft.side = match (draft.says(&[T::Left]), draft.says(&[T::Right])) {
        (true, false) => Some(Side::Left),
        (false, true) => Some(Side::Right),
        _ => None,
    };
    let sided = draft.side.is_some();
    // A collar without a side is a dog's or a shirt's.
    draft.detail = draft.says(&[T::Detail]) || draft.says(&[T::Collar]) && !sided;
    if draft.detail {
        return draft;
    }
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

/// What is worn, or a feature of something else, follows it: a shoe on a foot, a face on a head.
fn details(tree: &PartTree<'_>, drafts: &mut Drafts) {
    for part in drafts.keys() {
        let Some(parent) = tree.parents[part] else {
            continue;
        };
        // Legends and the like are near a figure, but no parts of its body.
        drafts[part].detail |= tree.loose[part];
        let is_face = drafts[parent].class == Some(Class::Head) && drafts[part].says(&[Term::Face]);
        let is_worn =
            drafts[part].says(&[Term::Worn]) && drafts[parent].says(&[Term::Hand, Term::Foot]);
        // A wheel that stands on the ground is no leg.
        let is_wheel = drafts[part].class.is_none() && anatomy::is_disc(tree.name(part));
        if is_face || is_worn || is_wheel {
            drafts[part].class = None;
            drafts[part].detail = true;
        }
    }
}

/// What is the only one of its class and called `Legs` or `Arms` is all of them in one shape, which cannot move as one of them does.
fn merged_limbs(tree: &PartTree<'_>, drafts: &mut Drafts) {
    for class in [Class::Arm, Class::Leg] {
        let all = drafts.iter_enumerated();
        let mut members = all.filter(|(_, draft)| draft.class == Some(class));
        if let (Some((part, _)), None) = (members.next(), members.next())
            && anatomy::is_several_limbs(tree.name(part))
        {
            drafts[part].class = None;
            drafts[part].detail = true;
        }
    }
}

pub(super) fn is_trunk(class: Option<Class>) -> bool {
    matches!(class, Some(Class::Body | Class::Hips))
}

/// The name of a class with its article.
fn with_article(class: Class) -> String {
    match class {
        Class::Arm => "an arm".to_owned(),
        Class::Hips => "the hips".to_owned(),
        _ => format!("a {}", class.name()),
    }
}

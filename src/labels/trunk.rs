//! Finds hips, spine, neck and head of a skeleton whose limbs are known.

use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::Class;
use super::joint_names::JointName;
use super::joint_tree::JointTree;
use super::skeleton::{Anatomy, Limb};
use crate::mocap::JointId;

/// The most joints of an unnamed neck; longer chains are hair or a trunk.
const MAX_NECK: usize = 16;

/// Finds hips, spine, neck and head.
pub(super) fn fill(
    tree: &JointTree,
    named: &TiSlice<JointId, Option<JointName>>,
    anatomy: &mut Anatomy,
) {
    let hips = hips(tree, named, anatomy);
    anatomy.hips = Some(hips);
    let head_by_name = first(tree, named, JointName::Head);
    let chest = chest(tree, named, anatomy, head_by_name);
    if let Some(chest) = chest.filter(|chest| *chest != hips) {
        let top = tree.common([hips, chest]);
        anatomy.spine = tree
            .upward(chest)
            .take_while(|joint| Some(*joint) != top)
            .filter(|joint| *joint == chest || named[*joint] != Some(JointName::Helper))
            .collect();
        anatomy.spine.reverse();
        // In files that attach the hips to the chest, the chest is above the hips in the tree.
        if anatomy.spine.is_empty() {
            anatomy.spine.push(chest);
        }
    }
    match head_by_name {
        Some(head) => {
            let trunk = |joint: &JointId| *joint == hips || anatomy.spine.contains(joint);
            let below = tree.upward(head).skip(1).take_while(|joint| !trunk(joint));
            let mut neck: Vec<JointId> = below
                .filter(|joint| !matches!(named[*joint], Some(JointName::Helper | JointName::Head)))
                .take(MAX_NECK)
                .collect();
            neck.reverse();
            let on_trunk = tree.upward(head).any(|joint| trunk(&joint));
            neck.retain(|joint| on_trunk || named[*joint] == Some(JointName::Neck));
            anatomy.neck = neck;
            anatomy.head = Some(head);
        }
        None => by_shape(tree, named, anatomy, hips),
    }
}

/// The joint of a name that is nearest to the root.
fn first(
    tree: &JointTree,
    named: &TiSlice<JointId, Option<JointName>>,
    wanted: JointName,
) -> Option<JointId> {
    tree.joints()
        .filter(|joint| named[*joint] == Some(wanted))
        .min_by_key(|joint| (tree.depths[*joint], *joint))
}

fn roots<'a>(anatomy: &'a Anatomy, class: Class) -> impl Iterator<Item = JointId> + 'a {
    let root = |limb: &Limb| limb.collar.unwrap_or(limb.upper);
    let limbs = anatomy.limbs.iter().filter(move |limb| limb.class == class);
    limbs.map(root)
}

/// The joint that carries all limbs of a class.
fn carrier(tree: &JointTree, anatomy: &Anatomy, class: Class) -> Option<JointId> {
    tree.common(roots(anatomy, class).filter_map(|root| tree.parents[root]))
}

fn hips(
    tree: &JointTree,
    named: &TiSlice<JointId, Option<JointName>>,
    anatomy: &Anatomy,
) -> JointId {
    let carrier = carrier(tree, anatomy, Class::Leg);
    let above_legs = carrier.and_then(|carrier| {
        tree.upward(carrier)
            .find(|joint| named[*joint] == Some(JointName::Hips))
    });
    above_legs
        .or(carrier)
        .or_else(|| first(tree, named, JointName::Hips))
        .unwrap_or_default()
}

fn chest(
    tree: &JointTree,
    named: &TiSlice<JointId, Option<JointName>>,
    anatomy: &Anatomy,
    head: Option<JointId>,
) -> Option<JointId> {
    let last_spine = || {
        tree.joints()
            .filter(|joint| named[*joint] == Some(JointName::Spine))
            .max_by_key(|joint| (tree.depths[*joint], std::cmp::Reverse(*joint)))
    };
    let carrier = carrier(tree, anatomy, Class::Arm)
        .or_else(|| tree.parents[head?])
        .or_else(|| tree.parents[first(tree, named, JointName::Neck)?])
        .or_else(last_spine)?;
    // Some files attach the collar bones to the neck, or to helpers.
    tree.upward(carrier).find(|joint| {
        !matches!(
            named[*joint],
            Some(JointName::Neck | JointName::Head | JointName::Helper | JointName::Limb(..))
        )
    })
}

/// Finds neck and head if no name tells the head: the longest chain at the chest that is not a limb, up to where it branches or
/// ends.
fn by_shape(
    tree: &JointTree,
    named: &TiSlice<JointId, Option<JointName>>,
    anatomy: &mut Anatomy,
    hips: JointId,
) {
    let mut carries: TiVec<JointId, bool> = ti_vec![false; tree.len()];
    for limb in &anatomy.limbs {
        for joint in tree.upward(limb.upper) {
            carries[joint] = true;
        }
    }
    let neck_by_name = first(tree, named, JointName::Neck);
    let carrier = anatomy.spine.last().copied().unwrap_or(hips);
    let start = neck_by_name.or_else(|| {
        tree.children[carrier]
            .iter()
            .filter(|child| !carries[**child] && usable(named[**child]))
            .copied()
            .reduce(|best, child| {
                let whole = |child: JointId| tree.bones[child] + tree.reaches[child];
                if whole(child) > whole(best) {
                    child
                } else {
                    best
                }
            })
    });
    let Some(start) = start else {
        return;
    };
    let mut chain = vec![start];
    let mut last = start;
    while chain.len() < MAX_NECK {
        let mut next = tree.children[last]
            .iter()
            .filter(|child| usable(named[**child]) && !carries[**child]);
        let (Some(next), None) = (next.next(), next.next()) else {
            break;
        };
        // In files with end sites, a joint without one is itself the end of the head.
        let bare = tree.reaches[*next] <= 0.0 && tree.children[*next].is_empty();
        if bare && named[*next].is_none() && tree.has_ends() {
            break;
        }
        chain.push(*next);
        last = *next;
    }
    if named[last] != Some(JointName::Neck) {
        chain.pop();
        anatomy.head = Some(last);
    }
    if anatomy.spine.is_empty()
        && anatomy.limbs.iter().all(|limb| limb.class != Class::Arm)
        && neck_by_name.is_none()
    {
        // Without arms nothing tells where the trunk ends.
        anatomy.spine = chain;
    } else {
        anatomy.neck = chain;
    }
}

fn usable(named: Option<JointName>) -> bool {
    !matches!(
        named,
        Some(JointName::Helper | JointName::Limb(..) | JointName::Tail)
    )
}

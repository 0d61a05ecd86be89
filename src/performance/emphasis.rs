//! Emphasis: what does not matter moves less (Manya & Matsuda, section 3.3.2).

use typed_index_collections::{TiSlice, TiVec, ti_vec};

use crate::labels::Class;

/// The nodes of a figure or skeleton, and the limbs that they belong to. `Node` counts them: places of parts, or joints.
pub(crate) struct Limbs<'a, Node> {
    /// Per node its parent. In a cycle of parents, every node is visited at most once.
    pub parents: &'a TiSlice<Node, Option<Node>>,
    /// Per node what it is a part of; `None` for what has no class of its own, such as fingers.
    pub classes: &'a TiSlice<Node, Option<Class>>,
}

impl<Node> Limbs<'_, Node>
where
    Node: Copy + PartialEq + From<usize>,
    usize: From<Node>,
{
    /// A node and what it hangs on, up to the root.
    fn upwards(&self, node: Node) -> impl Iterator<Item = Node> {
        let parent = |node: &Node| self.parents[*node];
        std::iter::successors(Some(node), parent).take(self.parents.len())
    }

    /// The limb of a node, from its root to its tips: the connected nodes of its class, with what is between them and hangs on them
    /// and has no class.
    fn limb(&self, node: Node) -> TiVec<Node, bool> {
        let class = self.classes[node];
        let same = |node: &Node| self.classes[*node].is_none() || self.classes[*node] == class;
        let above: Vec<Node> = self.upwards(node).take_while(same).collect();
        let root = above
            .iter()
            .rev()
            .find(|node| self.classes[**node] == class);
        let root = *root.unwrap_or(&node);
        let belongs = |other: Node| {
            // All on the way up to the limb's root must belong to the limb.
            self.upwards(other)
                .take_while(|node| *node == root || same(node))
                .any(|node| node == root)
        };
        self.parents.keys().map(belongs).collect()
    }
}

/// Per node the ratio of its turns that is left; `None` for nodes that no mark performs, which stay as they are.
///
/// `channels` are the nodes of each characteristic joint, `followers` those that are edited along with them, and `largest` the largest
/// input of their marks. The nodes of the `emphasized` one stay, and so do their limbs and what they hang on. Of several ratios for
/// one node the largest counts.
pub(crate) fn ratios<Node>(
    limbs: &Limbs<'_, Node>,
    channels: &[Vec<Node>],
    followers: &[Vec<Node>],
    largest: &[f64],
    emphasized: usize,
) -> TiVec<Node, Option<f64>>
where
    Node: Copy + PartialEq + From<usize>,
    usize: From<Node>,
{
    let count = limbs.parents.len();
    let mut stays: TiVec<Node, bool> = ti_vec![false; count];
    for node in &channels[emphasized] {
        for above in limbs.upwards(*node) {
            stays[above] = true;
        }
        for (stays, is_limb) in stays.iter_mut().zip(limbs.limb(*node)) {
            *stays |= is_limb;
        }
    }
    let mut ratios: TiVec<Node, Option<f64>> = ti_vec![None; count];
    let most = largest[emphasized];
    for (channel, nodes) in channels.iter().enumerate() {
        if channel == emphasized || most <= 0.0 {
            continue;
        }
        let ratio = ratio(largest[channel], most);
        let limb = nodes.iter().map(|node| limbs.limb(*node));
        let none: TiVec<Node, bool> = ti_vec![false; count];
        let mut damped = limb.fold(none, |mut all, limb| {
            all.iter_mut().zip(limb).for_each(|(all, own)| *all |= own);
            all
        });
        for follower in followers.get(channel).into_iter().flatten() {
            damped[*follower] = true;
        }
        let nodes = damped.keys();
        for node in nodes.filter(|node| damped[*node] && !stays[*node]) {
            ratios[node] = Some(ratios[node].map_or(ratio, |other| ratio.max(other)));
        }
    }
    ratios
}

/// How much of its turns a channel keeps (equation 1): its largest input over that of the emphasised one, which is positive.
pub(super) fn ratio(largest: f64, emphasized: f64) -> f64 {
    (largest / emphasized).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A trunk, an arm of three with a finger, a second arm, a leg.
    const PARENTS: [Option<usize>; 8] = [
        None,
        Some(0),
        Some(1),
        Some(2),
        Some(3),
        Some(0),
        Some(0),
        Some(6),
    ];

    fn limbs(classes: &[Option<Class>]) -> Limbs<'_, usize> {
        Limbs {
            parents: TiSlice::from_ref(&PARENTS),
            classes: TiSlice::from_ref(classes),
        }
    }

    #[test]
    fn limbs_go_from_root_to_tip() {
        let (arm, leg) = (Some(Class::Arm), Some(Class::Leg));
        let classes = [Some(Class::Hips), arm, arm, arm, None, arm, leg, leg];
        let limbs = limbs(&classes);
        let of = |node| -> Vec<usize> {
            let limb = limbs.limb(node).into_iter_enumerated();
            limb.filter_map(|(node, is)| is.then_some(node)).collect()
        };
        assert_eq!(of(3), [1, 2, 3, 4]);
        assert_eq!(of(1), [1, 2, 3, 4]);
        assert_eq!(of(5), [5]);
        assert_eq!(of(7), [6, 7]);
        let found = ratios(
            &limbs,
            &[vec![3], vec![5], vec![7]],
            &[],
            &[1.0, 0.25, 0.5],
            0,
        );
        let expected = [
            None,
            None,
            None,
            None,
            None,
            Some(0.25),
            Some(0.5),
            Some(0.5),
        ];
        assert_eq!(found.raw, expected);
        let followers = [vec![], vec![1, 0, 6], vec![]];
        let found = ratios(
            &limbs,
            &[vec![3], vec![5], vec![7]],
            &followers,
            &[0.5, 0.25, 0.0],
            0,
        );
        let expected = [
            None,
            None,
            None,
            None,
            None,
            Some(0.5),
            Some(0.5),
            Some(0.0),
        ];
        assert_eq!(found.raw, expected);
    }

    #[test]
    fn cycles_end() {
        let limbs = Limbs {
            parents: TiSlice::from_ref(&[Some(1_usize), Some(0)]),
            classes: TiSlice::from_ref(&[Some(Class::Arm), Some(Class::Arm)]),
        };
        assert_eq!(limbs.limb(0).raw, [true, true]);
    }
}

//! Emphasis: what does not matter moves less (Manya & Matsuda, section 3.3.2).

use crate::labels::Class;

/// The nodes of a figure or skeleton, and the limbs that they belong to.
pub struct Limbs<'a> {
    /// Per node its parent. Chains that never end are climbed only once around.
    pub parents: &'a [Option<usize>],
    /// Per node what it is a part of; `None` for what has no class of its own, such as fingers.
    pub classes: &'a [Option<Class>],
}

impl Limbs<'_> {
    /// A node and what it hangs on, up to the root.
    fn upwards(&self, node: usize) -> impl Iterator<Item = usize> {
        let parent = |node: &usize| self.parents[*node];
        std::iter::successors(Some(node), parent).take(self.parents.len())
    }

    /// The limb of a node, from its root to its tips: the connected nodes of its class, with what is between them and hangs on them
    /// and has no class.
    fn limb(&self, node: usize) -> Vec<bool> {
        let class = self.classes[node];
        let same = |node: &usize| self.classes[*node].is_none() || self.classes[*node] == class;
        let above: Vec<usize> = self.upwards(node).take_while(same).collect();
        let root = above
            .iter()
            .rev()
            .find(|node| self.classes[**node] == class);
        let root = *root.unwrap_or(&node);
        let belongs = |other: usize| {
            // All on the way up to the limb's root must belong to the limb.
            self.upwards(other)
                .take_while(|node| *node == root || same(node))
                .any(|node| node == root)
        };
        (0..self.parents.len()).map(belongs).collect()
    }
}

/// Per node the ratio of its turns that is left; `None` for nodes that no mark performs, which stay as they are.
///
/// `channels` are the nodes of each characteristic joint, `followers` those that are edited along with them, and `largest` the largest
/// input of their marks. The nodes of the `emphasized` one stay, and so do their limbs and what they hang on. Of several ratios for
/// one node the largest counts.
pub fn ratios(
    limbs: &Limbs<'_>,
    channels: &[Vec<usize>],
    followers: &[Vec<usize>],
    largest: &[f64],
    emphasized: usize,
) -> Vec<Option<f64>> {
    let count = limbs.parents.len();
    let mut stays = vec![false; count];
    for node in &channels[emphasized] {
        for above in limbs.upwards(*node) {
            stays[above] = true;
        }
        for (stays, is_limb) in stays.iter_mut().zip(limbs.limb(*node)) {
            *stays |= is_limb;
        }
    }
    let mut ratios: Vec<Option<f64>> = vec![None; count];
    let most = largest[emphasized];
    for (channel, nodes) in channels.iter().enumerate() {
        if channel == emphasized || most <= 0.0 {
            continue;
        }
        let ratio = ratio(largest[channel], most);
        let limb = nodes.iter().map(|node| limbs.limb(*node));
        let mut damped = limb.fold(vec![false; count], |mut all, limb| {
            all.iter_mut().zip(limb).for_each(|(all, own)| *all |= own);
            all
        });
        for follower in followers.get(channel).into_iter().flatten() {
            damped[*follower] = true;
        }
        for node in (0..count).filter(|node| damped[*node] && !stays[*node]) {
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

    fn limbs(classes: &[Option<Class>]) -> Limbs<'_> {
        Limbs {
            parents: &PARENTS,
            classes,
        }
    }

    #[test]
    fn limbs_go_from_root_to_tip() {
        let (arm, leg) = (Some(Class::Arm), Some(Class::Leg));
        let classes = [Some(Class::Hips), arm, arm, arm, None, arm, leg, leg];
        let limbs = limbs(&classes);
        let of = |node| -> Vec<usize> {
            let limb = limbs.limb(node).into_iter().enumerate();
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
        assert_eq!(found, expected);
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
        assert_eq!(found, expected);
    }

    #[test]
    fn cycles_end() {
        let limbs = Limbs {
            parents: &[Some(1), Some(0)],
            classes: &[Some(Class::Arm), Some(Class::Arm)],
        };
        assert_eq!(limbs.limb(0), [true, true]);
    }
}

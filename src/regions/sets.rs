//! A union-find forest as a list of parents. The least index of a set is its root, so that the result does not depend on the order of
//! joins, and no parent comes after its child.

/// The root of an index's set, with path halving.
pub(crate) fn root(parents: &mut [u32], mut index: u32) -> u32 {
    while parents[index as usize] != index {
        let next = parents[parents[index as usize] as usize];
        parents[index as usize] = next;
        index = next;
    }
    index
}

/// Joins the sets of two indices.
pub(crate) fn join(parents: &mut [u32], one: u32, other: u32) {
    let (one, other) = (root(parents, one), root(parents, other));
    parents[one.max(other) as usize] = one.min(other);
}

/// Replaces each parent by the number of its set, from `first` on, in the order of the sets' least indices. Indices that are no members
/// get 0; a set has members only or none. The least indices, in order.
pub(super) fn number(
    parents: &mut [u32],
    first: u32,
    is_member: impl Fn(usize) -> bool,
) -> Vec<usize> {
    let mut firsts = Vec::new();
    for index in 0..parents.len() {
        let parent = parents[index] as usize;
        parents[index] = if !is_member(index) {
            0
        } else if parent == index {
            firsts.push(index);
            first + firsts.len() as u32 - 1
        } else {
            // Comes before, and has its number already.
            parents[parent]
        };
    }
    firsts
}

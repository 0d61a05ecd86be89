//! Lists of the pixels of groups, for a few marked pixels in a large picture.

/// Marked pixels that are connected, in the order of `starts`, the marked pixels that a group may begin with. `around` are the differences
/// of index from a pixel to its neighbors, which exist for every marked one. A group's pixels are in the order in which they are
/// reached.
pub(crate) fn groups(
    count: usize,
    starts: &[usize],
    around: &[isize],
    is_marked: impl Fn(usize) -> bool,
) -> Vec<Vec<usize>> {
    let mut is_taken = vec![false; count];
    let mut groups = Vec::new();
    for &start in starts {
        if std::mem::replace(&mut is_taken[start], true) {
            continue;
        }
        let mut group = vec![start];
        let mut next = 0;
        while let Some(&at) = group.get(next) {
            next += 1;
            for offset in around {
                let neighbor = at.wrapping_add_signed(*offset);
                if is_marked(neighbor) && !is_taken[neighbor] {
                    is_taken[neighbor] = true;
                    group.push(neighbor);
                }
            }
        }
        groups.push(group);
    }
    groups
}

//! Connected components of equal pixels.

/// A component: pixels of one class that are connected over their edges.
#[derive(Debug, Clone, Copy)]
pub(super) struct Component {
    pub(super) class: u16,
    /// Pixels.
    pub(super) area: usize,
    /// The side of the largest square of pixels inside.
    pub(super) square: u32,
}

/// The components of a picture of classes, in the order of their first pixels, and by pixel the index of its component.
pub(super) fn components(classes: &[u16], width: usize) -> (Vec<Component>, Vec<u32>) {
    let mut parents: Vec<u32> = Vec::new();
    let mut ids = vec![0_u32; classes.len()];
    for at in 0..classes.len() {
        let class = classes[at];
        let left = (at % width > 0 && classes[at - 1] == class).then(|| ids[at - 1]);
        let above = (at >= width && classes[at - width] == class).then(|| ids[at - width]);
        ids[at] = match (left, above) {
            (Some(left), Some(above)) if left != above => join(&mut parents, left, above),
            (Some(id), _) | (None, Some(id)) => id,
            (None, None) => {
                parents.push(parents.len() as u32);
                parents.len() as u32 - 1
            }
        };
    }
    measure(classes, width, &mut parents, ids)
}

fn measure(
    classes: &[u16],
    width: usize,
    parents: &mut [u32],
    mut ids: Vec<u32>,
) -> (Vec<Component>, Vec<u32>) {
    let mut found: Vec<Component> = Vec::new();
    let mut index = vec![u32::MAX; parents.len()];
    // The side of the largest square that ends at each pixel of the row above.
    let mut sides = vec![0_u32; width];
    for at in 0..ids.len() {
        let root = root(parents, ids[at]) as usize;
        if index[root] == u32::MAX {
            index[root] = found.len() as u32;
            found.push(Component {
                class: classes[at],
                area: 0,
                square: 0,
            });
        }
        ids[at] = index[root];
    }
    let mut corner = 0;
    for at in 0..ids.len() {
        let (x, id) = (at % width, ids[at]);
        let above = sides[x];
        let is_inner = x > 0
            && at >= width
            && ids[at - 1] == id
            && ids[at - width] == id
            && ids[at - width - 1] == id;
        let side = match is_inner {
            true => 1 + above.min(sides[x - 1]).min(corner),
            false => 1,
        };
        corner = above;
        sides[x] = side;
        let component = &mut found[id as usize];
        component.area += 1;
        component.square = component.square.max(side);
    }
    (found, ids)
}

fn root(parents: &mut [u32], mut id: u32) -> u32 {
    while parents[id as usize] != id {
        let next = parents[id as usize];
        parents[id as usize] = parents[next as usize];
        id = next;
    }
    id
}

fn join(parents: &mut [u32], a: u32, b: u32) -> u32 {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b) as usize] = a.min(b);
    a.min(b)
}

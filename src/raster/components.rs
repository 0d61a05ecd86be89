//! Connected components of equal pixels.

use crate::regions::{Labels, connected};

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
    let Labels { of: ids, firsts } = connected(
        classes.len(),
        width,
        0,
        |_| true,
        |at| classes[at - 1] == classes[at],
        |at| classes[at - width] == classes[at],
    );
    let component = |first: usize| Component {
        class: classes[first],
        area: 0,
        square: 0,
    };
    let mut found: Vec<Component> = firsts.into_iter().map(component).collect();
    // The side of the largest square that ends at each pixel of the row above.
    let mut sides = vec![0_u32; width];
    let mut corner = 0;
    for at in 0..ids.len() {
        let (x, id) = (at % width, ids[at]);
        let above = sides[x];
        let is_inner = x > 0
            && at >= width
            && ids[at - 1] == id
            && ids[at - width] == id
            && ids[at - width - 1] == id;
        let side = if is_inner {
            1 + above.min(sides[x - 1]).min(corner)
        } else {
            1
        };
        corner = above;
        sides[x] = side;
        let component = &mut found[id as usize];
        component.area += 1;
        component.square = component.square.max(side);
    }
    (found, ids)
}

//! The components that become regions.

use super::Seen;
use super::canvas::{Canvas, Color, mixture};
use super::components::Component;
use super::palette::{CLEAR, NONE};

/// At most so many regions are kept, the largest: matching takes time with the cube of their number.
pub(super) const MAX_REGIONS: usize = 400;
/// The least area of a region, pixels.
const MIN_AREA: f64 = 4.0;
/// The area that makes a region of a component without a square of 2 × 2 pixels.
const MIN_THIN_AREA: usize = 12;
/// A component without a square of so many pixels' side has an inscribed radius below 1.5 pixels.
pub(super) const FRINGE_SIDE: u32 = 3;
/// The largest distance of a fringe's colour from a mixture of its neighbours' colours: 0.05, here squared and in steps of 1/255.
pub(super) const FRINGE_DISTANCE: f32 = 163.0;
/// The share of a fringe's pixels that lie between the same two neighbours.
const FRINGE_PIXELS: f64 = 0.7;

/// What a component is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Background,
    Region,
    /// Too small, or a mixture of what it lies between: its pixels go to their neighbours.
    Rest,
}

/// The least area of a region in this picture, pixels.
pub(super) fn min_area(canvas: &Canvas) -> usize {
    (canvas.pixels.len() as f64 * canvas.least_share).max(MIN_AREA) as usize
}

/// Whether a component is large enough to be a region.
pub(super) fn is_large(component: &Component, min_area: usize) -> bool {
    component.area >= min_area && (component.square >= 2 || component.area >= MIN_THIN_AREA)
}

/// What each component of the palette's classes is.
pub(super) fn kinds(seen: &Seen<'_>) -> Vec<Kind> {
    let (canvas, components, ids) = (seen.canvas, seen.components, seen.ids);
    let min_area = min_area(canvas);
    // All of the padding is one component, that of the first pixel.
    let padding = ids.first().map_or(0, |id| *id as usize);
    let kind = |(index, component): (usize, &Component)| match component.class {
        _ if index == padding => Kind::Background,
        CLEAR if canvas.is_cut_out() && is_large(component, min_area) => Kind::Background,
        NONE | CLEAR => Kind::Rest,
        _ if is_large(component, min_area) => Kind::Region,
        _ => Kind::Rest,
    };
    let mut kinds: Vec<Kind> = components.iter().enumerate().map(kind).collect();
    drop_fringes(seen, &mut kinds);
    let mut regions: Vec<usize> = (0..kinds.len())
        .filter(|index| kinds[*index] == Kind::Region)
        .collect();
    regions.sort_by_key(|index| (usize::MAX - components[*index].area, *index));
    for index in regions.into_iter().skip(MAX_REGIONS) {
        kinds[index] = Kind::Rest;
    }
    kinds
}

/// Neighbours of a thin component, as pairs, with the number of its pixels between them.
type Pairs = Vec<([u32; 2], usize)>;

fn drop_fringes(seen: &Seen<'_>, kinds: &mut [Kind]) {
    let (canvas, palette) = (seen.canvas, seen.palette);
    let (components, ids) = (seen.components, seen.ids);
    let is_thin: Vec<bool> = components
        .iter()
        .zip(kinds.iter())
        .map(|(component, kind)| *kind == Kind::Region && component.square < FRINGE_SIDE)
        .collect();
    let mut pairs: Vec<Pairs> = vec![Vec::new(); components.len()];
    for at in canvas
        .rows()
        .flatten()
        .filter(|at| is_thin[ids[*at] as usize])
    {
        let mut near: Vec<u32> = Vec::new();
        for other in canvas.window(at).map(|other| ids[other]) {
            let is_new = other != ids[at] && !near.contains(&other);
            if is_new && kinds[other as usize] != Kind::Rest {
                near.push(other);
            }
        }
        near.sort_unstable();
        let pairs = &mut pairs[ids[at] as usize];
        for (index, &first) in near.iter().enumerate() {
            for &second in &near[index..] {
                match pairs.iter_mut().find(|(pair, _)| *pair == [first, second]) {
                    Some((_, count)) => *count += 1,
                    None => pairs.push(([first, second], 1)),
                }
            }
        }
    }
    let color = |id: u32| -> Color {
        let class = components[id as usize].class;
        palette.colors[usize::from(class)].map(f32::from)
    };
    let is_fringe = |(id, pairs): (usize, &Pairs)| {
        // Several neighbours may have one colour.
        let mut counts: Vec<([u16; 2], usize)> = Vec::new();
        for ([a, b], count) in pairs {
            let (_, distance) = mixture(color(id as u32), color(*a), color(*b));
            if distance > FRINGE_DISTANCE {
                continue;
            }
            let mut classes = [a, b].map(|id| components[*id as usize].class);
            classes.sort_unstable();
            match counts.iter_mut().find(|(known, _)| *known == classes) {
                Some((_, sum)) => *sum += count,
                None => counts.push((classes, *count)),
            }
        }
        let most = counts.into_iter().map(|(_, count)| count).max();
        most.is_some_and(|most| most as f64 >= FRINGE_PIXELS * components[id].area as f64)
    };
    let fringes: Vec<usize> = (0..components.len())
        .filter(|id| is_thin[*id] && is_fringe((*id, &pairs[*id])))
        .collect();
    for id in fringes {
        kinds[id] = Kind::Rest;
    }
}

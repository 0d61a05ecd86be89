//! Shapes of a drawing that nobody has named, as far as it matters for what they are.

use glam::DVec2;

use super::mask::{Box2, Island, Mask};
use crate::anatomy::Noun;

/// A piece of at least this share of the largest one is a piece of its own; smaller ones are specks.
const PIECE: f64 = 0.25;
/// Legs in one piece part at this share of their height from the top, or above.
const HIPS: f64 = 0.6;

/// What is asked about: a shape, or a group of shapes that belong together.
#[derive(Debug, Clone)]
pub(crate) struct Drawn {
    /// The name that it has; empty if it has none.
    pub(crate) name: String,
    /// What that name says it is.
    pub(crate) known: Option<Noun>,
    /// What it covers.
    pub(crate) mask: Mask,
    /// Its colour, or that of its largest shape.
    pub(crate) color: [u8; 3],
    /// The unit that it belongs to: a group of shapes that is one part, or itself.
    pub(crate) unit: usize,
}

impl Drawn {
    /// Whether it is in several pieces that are about as large.
    pub(crate) fn has_several_pieces(&self) -> bool {
        large(self.mask.islands()).len() > 1
    }
}

/// Pieces without specks.
fn large(mut islands: Vec<Island>) -> Vec<Island> {
    let largest = islands.first().map_or(0, |island| island.cells) as f64;
    islands.retain(|island| island.cells as f64 >= PIECE * largest);
    islands
}

/// A drawn shape with what was measured of it.
#[derive(Debug)]
pub(super) struct Shape {
    pub(super) name: String,
    pub(super) mask: Mask,
    pub(super) color: [f64; 3],
    pub(super) cells: f64,
    pub(super) bounds: Box2,
    /// Its pieces, the largest first, without specks.
    pub(super) islands: Vec<Island>,
    /// How many of its cells no later shape covers.
    pub(super) seen: f64,
}

/// All shapes, in the order in which they are drawn, and the box around them.
pub(super) struct Shapes {
    /// `None` for what covers no cell.
    all: Vec<Option<Shape>>,
    pub(super) bounds: Box2,
}

impl Shapes {
    /// `None` if nothing covers anything.
    pub(super) fn measure(drawn: &[Drawn]) -> Option<Self> {
        let mut later = Mask::empty();
        let mut all: Vec<Option<Shape>> = Vec::with_capacity(drawn.len());
        for one in drawn.iter().rev() {
            all.push(measure(one, &later));
            later.add(&one.mask);
        }
        all.reverse();
        let bounds = all.iter().flatten().map(|shape| shape.bounds);
        let bounds = bounds.reduce(Box2::around)?;
        Some(Self { all, bounds })
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (usize, &Shape)> {
        let all = self.all.iter().enumerate();
        all.filter_map(|(index, shape)| Some((index, shape.as_ref()?)))
    }

    pub(super) fn get(&self, index: usize) -> Option<&Shape> {
        self.all.get(index)?.as_ref()
    }

    pub(super) fn height(&self) -> f64 {
        self.bounds.size().y
    }

    /// The area of all shapes together, as if none covered another.
    pub(super) fn area(&self) -> f64 {
        self.bounds.size().element_product()
    }
}

impl Shape {
    pub(super) fn middle(&self) -> DVec2 {
        self.bounds.middle()
    }

    pub(super) fn size(&self) -> DVec2 {
        self.bounds.size()
    }

    /// The share of this shape that lies within the outline of another one.
    pub(super) fn on(&self, other: &Self) -> f64 {
        self.mask.shared(&other.mask) as f64 / self.cells
    }

    pub(super) fn distance_of_colors(&self, other: &Self) -> f64 {
        let squares = self.color.iter().zip(other.color);
        squares.map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
    }

    /// How bright it is, 0 to 1.
    pub(super) fn brightness(&self) -> f64 {
        let [red, green, blue] = self.color;
        (0.3 * red + 0.59 * green + 0.11 * blue) / 255.0
    }

    /// Its two pieces, the left one first, if it has two that are about as large.
    pub(super) fn twins(&self) -> Option<[Island; 2]> {
        twins(&self.islands)
    }

    /// Its two legs with a half of the hips each, the left one first, if it is in one piece that parts into two downwards.
    pub(super) fn legs(&self) -> Option<[Box2; 2]> {
        let [_] = self.islands.as_slice() else {
            return None;
        };
        let hips = self.bounds.low.y + HIPS * self.size().y;
        let legs = twins(&large(self.mask.below(hips as usize).islands()))?;
        Some(legs.map(|leg| Box2 {
            low: leg.bounds.low.with_y(self.bounds.low.y),
            high: leg.bounds.high,
        }))
    }

    /// Whether a piece of it is a disc, or a ring.
    pub(super) fn is_disc(&self, island: &Island) -> bool {
        let size = island.bounds.size();
        // A circle fills π/4 of its box.
        let fills = self.mask.fullness(island.bounds);
        let is_square = size.max_element() <= 1.2 * size.min_element();
        is_square && (0.68..=0.9).contains(&fills)
    }
}

/// Two pieces, the left one first, if there are two that are about as large.
fn twins(islands: &[Island]) -> Option<[Island; 2]> {
    let [one, other] = islands else {
        return None;
    };
    if (other.cells as f64) < 0.5 * one.cells as f64 {
        return None;
    }
    Some(if one.bounds.middle().x <= other.bounds.middle().x {
        [*one, *other]
    } else {
        [*other, *one]
    })
}

fn measure(drawn: &Drawn, later: &Mask) -> Option<Shape> {
    let bounds = drawn.mask.bounds()?;
    let islands = large(drawn.mask.islands());
    let mut seen = drawn.mask.clone();
    seen.remove(later);
    Some(Shape {
        name: drawn.name.clone(),
        cells: drawn.mask.count() as f64,
        mask: drawn.mask.clone(),
        color: drawn.color.map(f64::from),
        bounds,
        islands,
        seen: seen.count() as f64,
    })
}

//! Lays pieces out on pages: their places, and the largest scale at which they fit. Lengths are millimetres.

use glam::DVec2;
use rayon::prelude::*;

use super::marks::PieceMark;
use super::paper::{LEAST_MARGIN, Marked, Paper, Template, TurnedBox, cut_out, rough_box};
use super::pieces::PaperPiece;
use crate::geometry::Outline;

/// What a page leaves free at its edges: many printers cannot print there.
pub(super) const EDGE: f64 = 10.0;
/// The least distance between pieces.
pub(super) const GAP: f64 = 3.0;
/// The height of the line with a piece's name.
pub(super) const NAME_LINE: f64 = 5.0;
/// A puppet on one page that is smaller than this gets more pages.
const LEAST_HEIGHT: f64 = 200.0;
/// How often the range in which the largest scale lies is halved.
const STEPS: usize = 12;
/// How often the scale that was found is made smaller by this factor if the pieces do not fit, with all their bridges.
const TRIES: i32 = 12;
const SMALLER: f64 = 0.98;
/// The smallest scale that is tried, as a share of the one at which the drawing would be as large as the page.
const SMALLEST: f64 = 1e-3;

/// A piece on the sheet.
#[derive(Debug, Clone)]
pub(super) struct PlacedPiece {
    pub(super) paper: Paper,
    /// The page that it is on.
    pub(super) page: usize,
    /// From the turned piece to its place, from the top left corner of the page.
    pub(super) shift: DVec2,
}

/// Pieces on pages.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    /// Millimetres in a drawing unit.
    pub(super) scale: f64,
    pub(super) placed: Vec<PlacedPiece>,
    pub(super) pages: usize,
}

/// What is laid out.
pub(super) struct Task<'a> {
    pub(super) pieces: &'a [PaperPiece],
    /// Per piece what is drawn on it without holes, drawing units.
    pub(super) silhouettes: Vec<Outline>,
    /// Per piece the boxes around that, one for each way in which it may be turned.
    pub(super) boxes: Vec<Vec<TurnedBox>>,
    pub(super) marks: &'a [Option<PieceMark>],
    /// Per piece its holes: its own joint, then those of what it carries; drawing units.
    pub(super) holes: Vec<Vec<DVec2>>,
    /// Per piece the least width, for the name below it.
    pub(super) names: Vec<f64>,
    /// Width and height of a page.
    pub(super) page: DVec2,
    /// What the text takes of the first page.
    pub(super) text: f64,
    /// The larger side of the largest figure, drawing units.
    pub(super) extent: f64,
}

impl Task<'_> {
    /// The largest layout on one page, or on several where one would make the puppet too small. `None` if the pieces do not fit
    /// at any scale.
    pub(super) fn fit(&self) -> Option<Layout> {
        let whole = self.page.max_element() / self.extent;
        let tallest = LEAST_HEIGHT / self.extent;
        let on_one = self.largest_from(tallest, whole, 1);
        let tall = |layout: &Layout| layout.scale * self.extent >= LEAST_HEIGHT;
        on_one
            .filter(tall)
            .or_else(|| {
                self.may_fit(tallest, usize::MAX)
                    .then(|| self.at(tallest, usize::MAX))?
            })
            .or_else(|| self.largest(tallest, usize::MAX))
            .or_else(|| self.largest(whole, 1))
    }

    /// The layout with the largest scale on that many pages.
    pub(super) fn largest(&self, upper: f64, pages: usize) -> Option<Layout> {
        self.largest_from(0.0, upper, pages)
    }

    /// The same; `None` as soon as it is clear that it is smaller than `least`. To cut pieces out takes long: the scale is searched with
    /// boxes that are right but for where bridges go, and is made smaller if the pieces need it.
    fn largest_from(&self, least: f64, upper: f64, pages: usize) -> Option<Layout> {
        let (mut fits, mut too_large) = (upper * SMALLEST, upper * 4.0);
        for _ in 0..STEPS {
            // Halved as a ratio, since nothing is known about the size yet.
            let scale = (fits * too_large).sqrt();
            if self.may_fit(scale, pages) {
                fits = scale;
            } else {
                too_large = scale;
            }
            if too_large < least {
                return None;
            }
        }
        let scales = (0..TRIES).map(|tries| fits * SMALLER.powi(tries));
        scales.into_iter().find_map(|scale| self.at(scale, pages))
    }

    /// Whether boxes around the pieces fit at a scale on at most that many pages.
    fn may_fit(&self, scale: f64, pages: usize) -> bool {
        if !self.has_area(scale, pages) {
            return false;
        }
        let boxes = (0..self.pieces.len()).into_par_iter();
        let boxes = boxes.map(|index| rough_box(&self.template(index), scale, self.widest()));
        self.pack(&boxes.collect::<Vec<_>>(), pages).is_some()
    }

    /// The layout at a scale on at most that many pages.
    pub(super) fn at(&self, scale: f64, pages: usize) -> Option<Layout> {
        if !self.has_area(scale, pages) {
            return None;
        }
        let papers = (0..self.pieces.len()).into_par_iter();
        let papers = papers
            .map(|index| cut_out(&self.template(index), scale).upright_if_wider(self.widest()));
        let papers: Vec<Paper> = papers.collect();
        let boxes: Vec<(DVec2, DVec2)> = papers.iter().map(Paper::bounds).collect();
        let sizes: Vec<DVec2> = boxes.iter().map(|(low, high)| *high - *low).collect();
        let (places, pages) = self.pack(&sizes, pages)?;
        let placed = papers.into_iter().zip(places).enumerate();
        let placed = placed.map(|(index, (paper, (page, corner)))| {
            let slack = (self.names[index] - sizes[index].x).max(0.0) / 2.0;
            let inset = DVec2::new(EDGE + GAP / 2.0 + slack, EDGE + GAP / 2.0);
            PlacedPiece {
                shift: corner + inset - boxes[index].0,
                paper,
                page,
            }
        });
        Some(Layout {
            scale,
            placed: placed.collect(),
            pages,
        })
    }

    /// What a piece is cut out of.
    fn template(&self, index: usize) -> Template<'_> {
        Template {
            piece: &self.pieces[index],
            silhouette: &self.silhouettes[index],
            boxes: &self.boxes[index],
            holes: &self.holes[index],
            marked: match self.marks[index] {
                Some(_) => Marked::Yes,
                None => Marked::No,
            },
        }
    }

    /// Width and height of what can be printed of a page.
    fn room(&self) -> DVec2 {
        self.page - 2.0 * EDGE
    }

    /// The width of the widest piece that need not be turned upright.
    fn widest(&self) -> f64 {
        self.room().x - GAP
    }

    /// The page and the corner of each piece whose box has this size, and how many pages there are; `None` if they do not fit.
    fn pack(&self, sizes: &[DVec2], pages: usize) -> Option<(Vec<(usize, DVec2)>, usize)> {
        let mut packer = Packer {
            room: self.room(),
            text: self.text,
            most: pages,
            pages: Vec::new(),
        };
        let size = |index: usize| {
            let size = sizes[index];
            DVec2::new(size.x.max(self.names[index]), size.y + NAME_LINE) + GAP
        };
        let mut order: Vec<usize> = (0..sizes.len()).collect();
        order.sort_by(|a, b| size(*b).y.total_cmp(&size(*a).y).then(a.cmp(b)));
        let mut places = vec![(0, DVec2::ZERO); sizes.len()];
        for index in order {
            places[index] = packer.place(size(index))?;
        }
        Some((places, packer.pages.len()))
    }

    /// Whether so many pages have the area of the boxes around all pieces, however these are turned.
    fn has_area(&self, scale: f64, pages: usize) -> bool {
        let room = self.room();
        self.least_area(scale) <= pages as f64 * room.x * room.y - self.text * room.x
    }

    /// What the boxes of all pieces take at least, however they are turned.
    fn least_area(&self, scale: f64) -> f64 {
        let boxes = self.boxes.iter().map(|turned| {
            let areas = turned.iter().map(|turned| {
                let size = turned.size() * scale + GAP + 2.0 * LEAST_MARGIN;
                size.x * size.y
            });
            areas.fold(f64::INFINITY, f64::min)
        });
        boxes.sum()
    }
}

/// Packs rectangles onto pages, each as far up as it goes, then as far left (the skyline method).
struct Packer {
    /// Width and height of a page.
    room: DVec2,
    /// What is taken from the lower end of the first page.
    text: f64,
    /// The most pages.
    most: usize,
    /// Per page the lower border of what lies on it: steps from the left, each with its left end and its height.
    pages: Vec<Vec<DVec2>>,
}

impl Packer {
    /// The page of a rectangle, and its corner there; `None` if it fits on none.
    fn place(&mut self, size: DVec2) -> Option<(usize, DVec2)> {
        if size.cmpgt(self.room).any() {
            return None;
        }
        // An empty page has room for it, unless that is the first one with its text.
        (0..self.most).find_map(|page| {
            if page == self.pages.len() {
                self.pages.push(vec![DVec2::ZERO]);
            }
            Some((page, self.on_page(page, size)?))
        })
    }

    fn on_page(&mut self, page: usize, size: DVec2) -> Option<DVec2> {
        let skyline = &self.pages[page];
        let height = self.room.y - if page == 0 { self.text } else { 0.0 };
        let top = |left: f64| {
            let right = left + size.x;
            let ends = skyline.iter().skip(1).map(|step| step.x);
            let ends = ends.chain([self.room.x]);
            let under = skyline.iter().zip(ends);
            let under = under.filter(|(step, end)| step.x < right && *end > left);
            under.map(|(step, _)| step.y).fold(0.0, f64::max)
        };
        let corners = skyline.iter().map(|step| DVec2::new(step.x, top(step.x)));
        let fits = |corner: &DVec2| corner.x + size.x <= self.room.x && corner.y + size.y <= height;
        let corner = corners
            .filter(fits)
            .min_by(|a, b| a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x)))?;
        self.pages[page] = raised(skyline, corner, size);
        Some(corner)
    }
}

/// A skyline with a rectangle on it.
fn raised(skyline: &[DVec2], corner: DVec2, size: DVec2) -> Vec<DVec2> {
    let right = corner.x + size.x;
    let before = skyline.iter().copied().filter(|step| step.x < corner.x);
    let mut steps: Vec<DVec2> = before.collect();
    steps.push(DVec2::new(corner.x, corner.y + size.y));
    // What continues to the right of the rectangle begins at its right side.
    let behind = skyline.iter().rev().find(|step| step.x <= right);
    steps.extend(behind.map(|step| DVec2::new(right, step.y)));
    steps.extend(skyline.iter().copied().filter(|step| step.x > right));
    steps
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn packer(most: usize) -> Packer {
        Packer {
            room: DVec2::new(100.0, 150.0),
            text: 30.0,
            most,
            pages: Vec::new(),
        }
    }

    #[test]
    fn rectangles_go_to_the_next_page() {
        let mut packer = packer(2);
        let half = DVec2::new(100.0, 70.0);
        let placed: Vec<_> = (0..4).map(|_| packer.place(half)).collect();
        let top = DVec2::ZERO;
        let below = DVec2::new(0.0, 70.0);
        assert_eq!(
            placed,
            [Some((0, top)), Some((1, top)), Some((1, below)), None]
        );
    }

    proptest! {
        #[test]
        fn rectangles_do_not_overlap(sizes in prop::collection::vec((1.0..60.0, 1.0..80.0), 1..40)) {
            let mut packer = packer(usize::MAX);
            let mut placed: Vec<(usize, DVec2, DVec2)> = Vec::new();
            for (x, y) in sizes {
                let size = DVec2::new(x, y);
                let (page, low) = packer.place(size).unwrap();
                let high = low + size;
                let bottom = if page == 0 { 120.0 } else { 150.0 };
                prop_assert!(high.x <= 100.0 && high.y <= bottom);
                for (other, from, to) in &placed {
                    let apart = low.cmpge(*to - 1e-9).any() || high.cmple(*from + 1e-9).any();
                    prop_assert!(page != *other || apart);
                }
                placed.push((page, low, high));
            }
        }
    }
}

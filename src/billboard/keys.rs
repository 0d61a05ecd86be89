//! What takes long to compute of a character, with all that it is computed from as a key: a keystroke in a string must not match
//! and triangulate the regions again.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use glam::DVec2;

use super::features::OfRegion;
use super::matching::{Matching, match_regions};
use super::place::Frame;
use super::region::{Region, View};
use super::shape::{Morph, morph};
use crate::geometry::Outline;
use crate::memo::{Long, Memo};
use crate::svg::PictureSource;

/// All that a matching depends on: the numbers of the views, and the names of their regions.
#[derive(PartialEq, Eq, Hash)]
struct Matched {
    numbers: Long<u64>,
    names: Vec<Option<String>>,
}

/// All that the containers of a view's regions depend on.
#[derive(PartialEq, Eq, Hash)]
struct Contained(Long<u64>);

/// All that the mesh of a region depends on: the numbers of its outlines and feature points, and the names of these.
#[derive(PartialEq, Eq, Hash)]
struct Morphed {
    numbers: Long<u64>,
    names: Vec<Vec<String>>,
}

/// The file of a picture whose regions are found.
#[derive(PartialEq, Eq)]
struct PictureFile(Arc<Vec<u8>>);

impl Hash for PictureFile {
    // A drawing has few pictures, and comparing two takes less time than hashing.
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.len().hash(state);
    }
}

/// [`match_regions`]: `frames` follow from the views.
pub(super) fn matched(views: &[View], frames: &[Frame], memo: &Memo) -> Matching {
    let mut numbers = Vec::new();
    for view in views {
        numbers.extend([view.direction.theta, view.direction.phi].map(f64::to_bits));
        add_regions(&view.regions, &mut numbers);
    }
    let regions = views.iter().flat_map(|view| &view.regions);
    let key = Matched {
        numbers: Long(numbers),
        names: regions.map(|region| region.name.clone()).collect(),
    };
    let found = memo.get(key, |_| Arc::new(match_regions(views, frames)));
    Matching::clone(&found)
}

/// The container of each region, as `find` finds it.
pub(super) fn contained(
    regions: &[Region],
    memo: &Memo,
    find: impl FnOnce(&[Region]) -> Vec<Option<usize>>,
) -> Vec<Option<usize>> {
    let mut numbers = Vec::new();
    add_regions(regions, &mut numbers);
    memo.get(Contained(Long(numbers)), |_| find(regions))
}

/// [`morph`].
pub(super) fn morphed(outlines: &[Outline], features: &OfRegion, memo: &Memo) -> Morph {
    let mut numbers = Vec::new();
    for outline in outlines {
        add_outline(outline, &mut numbers);
    }
    let points = features.iter().flatten().map(|(_, point)| *point);
    numbers.extend(points.flat_map(|p| [p.x.to_bits(), p.y.to_bits()]));
    let names = |view: &Vec<(String, DVec2)>| view.iter().map(|(name, _)| name.clone()).collect();
    let key = Morphed {
        numbers: Long(numbers),
        names: features.iter().map(names).collect(),
    };
    let found = memo.get(key, |_| Arc::new(morph(outlines, features)));
    Morph::clone(&found)
}

/// What is found in a picture, as `find` finds it. That of an SVG picture is not kept.
pub(super) fn segmented<T: Send + Sync + 'static>(
    picture: &PictureSource,
    memo: &Memo,
    find: impl FnOnce(&PictureSource) -> T,
) -> Arc<T> {
    let find = || Arc::new(find(picture));
    match picture.bytes() {
        Some(bytes) => memo.get(PictureFile(Arc::clone(bytes)), |_| find()),
        None => find(),
    }
}

/// The numbers of regions; what lists are long is said before them, so that different regions never give the same numbers.
fn add_regions(regions: &[Region], numbers: &mut Vec<u64>) {
    numbers.push(regions.len() as u64);
    for region in regions {
        numbers.extend(region.color.map(f64::to_bits));
        // An index never reaches the number of `None`.
        numbers.push(region.container.map_or(u64::MAX, |outer| outer as u64));
        add_outline(&region.outline, numbers);
    }
}

fn add_outline(outline: &Outline, numbers: &mut Vec<u64>) {
    // The first number of a key is hashed, and should differ.
    let mut points = outline
        .polygons
        .iter()
        .flat_map(|p| p.rings.iter().flatten());
    numbers.push(points.next().map_or(0, |point| point.x.to_bits()));
    numbers.push(outline.polygons.len() as u64);
    for polygon in &outline.polygons {
        numbers.push(polygon.rings.len() as u64);
        for ring in &polygon.rings {
            numbers.push(ring.len() as u64);
            numbers.extend(ring.iter().flat_map(|p| [p.x.to_bits(), p.y.to_bits()]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::billboard::region::Direction;
    use crate::geometry::Polygon;

    fn square(at: f64) -> Region {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let ring = corners.map(|(x, y)| DVec2::new(x + at, y)).to_vec();
        Region {
            name: None,
            outline: Outline {
                polygons: vec![Polygon { rings: vec![ring] }],
            },
            color: [0.5, 0.5, 0.5, 1.0],
            container: None,
        }
    }

    fn view(theta: f64, regions: Vec<Region>) -> View {
        let direction = Direction { theta, phi: 0.0 };
        View { direction, regions }
    }

    #[test]
    fn only_what_changed_is_computed_again() {
        let mut memo = Memo::default();
        let mut views = [view(0.0, vec![square(0.0)]), view(45.0, vec![square(5.0)])];
        let mut misses = |views: &[View]| {
            let frames = crate::billboard::place::frames(views);
            let found = matched(views, &frames, &memo);
            assert_eq!(found, match_regions(views, &frames));
            let outlines: Vec<Outline> =
                views.iter().map(|v| v.regions[0].outline.clone()).collect();
            let features = vec![Vec::new(); views.len()];
            assert_eq!(
                morphed(&outlines, &features, &memo).points,
                morph(&outlines, &features).points
            );
            memo.next_generation();
            memo.last_misses()
        };
        assert_eq!(misses(&views), 2);
        assert_eq!(misses(&views), 0);
        // A name matters to the matching, and not to the shape.
        views[0].regions[0].name = Some("Nose".to_owned());
        assert_eq!(misses(&views), 1);
        views[1].regions[0] = square(6.0);
        assert_eq!(misses(&views), 2);
        views[1].direction.theta = 30.0;
        assert_eq!(misses(&views), 1);
    }
}

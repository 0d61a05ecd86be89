//! The slow steps of making a character, each with all its inputs as a key for the memo: a keystroke in a string must not match and
//! triangulate the regions again.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use typed_index_collections::{TiSlice, TiVec};

use super::drawn::{self, SVG_SIDE, Segmented};
use super::features::OfRegion;
use super::matching::{Matching, Method, match_by};
use super::place::frames;
use super::region::{Direction, Region, RegionId, View};
use super::shape::{Morph, morph};
use super::sides::{self, Symmetry};
use crate::geometry::{Outline, Polygon};
use crate::memo::{Exactly, Memo, exact};
use crate::scene::ViewId;
use crate::svg::{PictureSource, pixels_of};

exact!(RegionId);
exact! {
    View { direction, regions }
    Direction { theta, phi }
    Region { name, outline, color, container, is_line }
    Outline { polygons }
    Polygon { rings }
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

/// What the mesh of a region is made from.
type Shape = Exactly<(Vec<Arc<Outline>>, OfRegion)>;

/// [`match_by`].
pub(super) fn matched(views: &TiSlice<ViewId, View>, method: Method, memo: &Memo) -> Matching {
    let found = memo.get(
        (method, Exactly(views.raw.to_vec())),
        |(method, Exactly(views))| {
            let views = TiSlice::from_ref(&views[..]);
            Arc::new(match_by(*method, views, &frames(views)))
        },
    );
    Matching::clone(&found)
}

/// [`symmetry`].
pub(super) fn symmetry(view: &View, memo: &Memo) -> Arc<Symmetry> {
    memo.get(Exactly(view.clone()), |Exactly(view)| {
        Arc::new(sides::symmetry(view))
    })
}

/// The container of each region; see [`drawn::containers`]. A region's name and colour do not matter to it.
pub(super) fn contained(
    regions: &TiSlice<RegionId, Region>,
    memo: &Memo,
) -> TiVec<RegionId, Option<RegionId>> {
    let area = |region: &Region| (Arc::clone(&region.outline), region.container);
    let areas: TiVec<RegionId, _> = regions.iter().map(area).collect();
    memo.get(Exactly(areas), |Exactly(areas)| drawn::containers(areas))
}

/// [`morph`].
pub(super) fn morphed(outlines: Vec<Arc<Outline>>, features: &OfRegion, memo: &Memo) -> Morph {
    let shape: Shape = Exactly((outlines, features.clone()));
    let found = memo.get(shape, |Exactly((outlines, features))| {
        Arc::new(morph(outlines, &features.raw))
    });
    Morph::clone(&found)
}

/// The regions of a picture. Those of an SVG picture are not kept.
pub(super) fn segmented(picture: &PictureSource, memo: &Memo) -> Arc<Segmented> {
    match picture.bytes() {
        Some(file) => memo.get(PictureFile(Arc::clone(file)), |PictureFile(file)| {
            Arc::new(drawn::segmented(pixels_of(file)))
        }),
        None => Arc::new(drawn::segmented(picture.pixels(SVG_SIDE))),
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::super::matching::match_regions;
    use super::*;

    fn square(at: f64) -> Region {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let ring = corners.map(|(x, y)| DVec2::new(x + at, y)).to_vec();
        Region {
            name: None,
            outline: Arc::new(Outline {
                polygons: vec![Polygon { rings: vec![ring] }],
            }),
            color: [0.5, 0.5, 0.5, 1.0],
            container: None,
            is_line: false,
        }
    }

    fn view(theta: f64, regions: Vec<Region>) -> View {
        let direction = Direction { theta, phi: 0.0 };
        View {
            direction,
            regions: regions.into(),
        }
    }

    #[test]
    fn only_what_changed_is_computed_again() {
        let mut memo = Memo::default();
        let mut views = TiVec::from(vec![
            view(0.0, vec![square(0.0)]),
            view(45.0, vec![square(5.0)]),
        ]);
        let mut misses = |views: &TiSlice<ViewId, View>| {
            let found = matched(views, Method::Whole, &memo);
            assert_eq!(found, match_regions(views, &frames(views)));
            let outlines: Vec<_> = views
                .iter()
                .map(|v| v.regions[RegionId::FIRST].outline.clone())
                .collect();
            let features = TiVec::from(vec![Vec::new(); views.len()]);
            assert_eq!(
                morphed(outlines.clone(), &features, &memo).points,
                morph(&outlines, &features.raw).points
            );
            memo.next_generation();
            memo.last_misses
        };
        assert_eq!(misses(&views), 2);
        assert_eq!(misses(&views), 0);
        // A name matters to the matching, and not to the shape.
        views[ViewId::FIRST].regions[RegionId::FIRST].name = Some("Nose".to_owned());
        assert_eq!(misses(&views), 1);
        views[ViewId::SECOND].regions[RegionId::FIRST] = square(6.0);
        assert_eq!(misses(&views), 2);
        views[ViewId::SECOND].direction.theta = 30.0;
        assert_eq!(misses(&views), 1);
    }
}

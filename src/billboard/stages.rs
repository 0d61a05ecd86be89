//! The stages from two pictures to the shapes of a character, one by one: benchmarks measure them.

use image::RgbaImage;
use rayon::prelude::*;
use typed_index_collections::{TiSlice, TiVec};

use super::matching::{self, Matching};
use super::place::{self, Frame};
use super::region::{Direction, Region, RegionId, View};
use super::shape;
use crate::raster;
use crate::scene::ViewId;

/// The angle between the two pictures, degrees.
const TURN: f64 = 45.0;

/// Two pictures with their regions.
#[derive(Debug)]
pub struct Segmented {
    views: TiVec<ViewId, View>,
    frames: TiVec<ViewId, Frame>,
}

/// What belongs together in them.
#[derive(Debug)]
pub struct Matched(Matching);

/// Finds the regions of two pictures, of which the second is seen from 45 degrees.
pub fn segment(pictures: &[RgbaImage; 2]) -> Segmented {
    let found: Vec<_> = pictures.par_iter().map(raster::regions).collect();
    let views = found.into_iter().zip([0.0, TURN]).map(|(found, theta)| {
        let region = |region: raster::RasterRegion| Region {
            name: None,
            outline: region.outline.into(),
            color: region.color,
            container: region.container.map(RegionId::from),
            is_line: false,
        };
        View {
            direction: Direction { theta, phi: 0.0 },
            regions: found.regions.into_iter().map(region).collect(),
        }
    });
    let views: TiVec<ViewId, View> = views.collect();
    let frames = place::frames(&views);
    Segmented { views, frames }
}

/// Pairs their regions.
pub fn match_regions(found: &Segmented) -> Matched {
    Matched(matching::match_regions(&found.views, &found.frames))
}

/// Finds where in space each region is.
pub fn place(found: &Segmented, matched: &Matched) {
    let placed = place::place(
        &found.views,
        &found.frames,
        &matched.0.tracks,
        TiSlice::from_ref(&[]),
        TiSlice::from_ref(&[]),
    );
    assert_eq!(placed.len(), matched.0.tracks.len());
}

/// Gives the outlines of each region the same points in both pictures, and triangulates them.
pub fn shape(found: &Segmented, matched: &Matched) {
    let outlines = |track: &matching::Track| -> Vec<_> {
        let regions = track.regions.iter().zip(&found.views);
        let outline = |(region, view): (&Option<RegionId>, &View)| {
            region.map_or_else(Default::default, |region| {
                view.regions[region].outline.clone()
            })
        };
        regions.map(outline).collect()
    };
    let tracks = matched.0.tracks.raw.par_iter();
    let shapes = tracks.map(|track| shape::morph(&outlines(track), &[]));
    std::hint::black_box(shapes.collect::<Vec<_>>());
}

/// How many regions were found.
pub fn region_count(found: &Segmented) -> usize {
    found.views.iter().map(|view| view.regions.len()).sum()
}

/// How many things in space they are.
pub fn track_count(matched: &Matched) -> usize {
    matched.0.tracks.len()
}

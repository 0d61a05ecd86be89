//! The world's axes, origin and scale: `Axes`, `Ground` and `Scale`.

use glam::DVec2;
use rayon::prelude::*;
use typed_index_collections::TiSlice;

use crate::bind::{Bindings, Part, PartKind};
use crate::scene::WorldTransform;
use crate::terrain::{LandscapeId, Layer};
use crate::threads::GRAIN;

/// How a drawing with these tile layers lies in the world.
pub fn world_transform(
    bindings: &Bindings,
    layers: &TiSlice<LandscapeId, Layer>,
) -> WorldTransform {
    WorldTransform {
        origin: bindings
            .settings
            .ground
            .unwrap_or_else(|| middle_of_lower_edge(bindings, layers)),
        rotation: bindings.settings.axes,
        scale: bindings.settings.meters(),
    }
}

/// The middle of the lower edge of all that is built.
fn middle_of_lower_edge(bindings: &Bindings, layers: &TiSlice<LandscapeId, Layer>) -> DVec2 {
    let is_built = |part: &&Part| matches!(part.kind, PartKind::Main | PartKind::Sub);
    let parts = bindings.parts.raw.par_iter().with_min_len(GRAIN);
    let boxes = parts.filter(is_built).map(|part| part.measure.bounds);
    let both =
        |one: (DVec2, DVec2), other: (DVec2, DVec2)| (one.0.min(other.0), one.1.max(other.1));
    let landscapes = layers.iter().map(Layer::bounds);
    let landscapes = landscapes.map(|[low, high]| (low, high)).reduce(both);
    let all = boxes.reduce_with(both);
    let all = all.into_iter().chain(landscapes).reduce(both);
    all.map_or(DVec2::ZERO, |(low, high)| {
        DVec2::new((low.x + high.x) / 2.0, high.y)
    })
}

//! How many rays a picture takes.

use super::light::LAMPS;

/// The numbers of rays that pictures are made from.
#[derive(Debug)]
pub(super) struct Sampling {
    /// Rays of a pixel that contains an edge or a texture.
    pub(super) edge: usize,
    pub(super) refinement: Refinement,
    /// Rays of a pixel that shows nothing but the ground, or nothing at all, unless the ground ends in it.
    pub(super) empty: usize,
    /// Rays of a pixel of the model to each lamp, and to the sky.
    pub(super) model: LightRays,
    pub(super) ground: GroundSampling,
    /// The side of the tiles that are rendered in parallel, in pixels. What is around a tile is rendered with it.
    pub(super) tile: u32,
}

/// Which pixels contain an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Refinement {
    /// Those whose first few rays meet different surfaces.
    Pixel,
    /// Those whose single ray meets another surface than a neighbouring pixel's ray.
    Neighbors,
}

/// Rays from one point to the lights.
#[derive(Debug, Clone, Copy)]
pub(super) struct LightRays {
    pub(super) lamps: [usize; LAMPS],
    pub(super) sky: usize,
}

/// The lattice on which the light on the ground is computed. The pixels between interpolate: shadows on the ground are soft.
#[derive(Debug)]
pub(super) struct GroundSampling {
    /// Pixels from one point to the next.
    pub(super) spacing: u32,
    /// Rays of each point.
    pub(super) rays: LightRays,
}

/// A still picture: each pixel is as good as 16 rays to everything can make it.
pub(super) static STILL: Sampling = Sampling {
    edge: 16,
    refinement: Refinement::Pixel,
    empty: 4,
    model: LightRays {
        lamps: [2, 1, 1],
        sky: 4,
    },
    // Faint shadows show on white, and only the key lamp casts one.
    ground: GroundSampling {
        spacing: 2,
        rays: LightRays {
            lamps: [10, 0, 0],
            sky: 20,
        },
    },
    tile: 128,
};

/// A picture of a film, which is seen for a moment. The rays are the same in all pictures, so that nothing flickers.
pub(super) static FILM: Sampling = Sampling {
    edge: 8,
    refinement: Refinement::Neighbors,
    empty: 1,
    model: LightRays {
        lamps: [1, 1, 1],
        sky: 2,
    },
    ground: GroundSampling {
        spacing: 3,
        rays: LightRays {
            lamps: [4, 0, 0],
            sky: 8,
        },
    },
    // Several pictures are rendered at the same time.
    tile: 160,
};

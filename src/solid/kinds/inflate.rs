//! `inflate`: blown up like a balloon.

use glam::DVec2;

use super::{HeightField, Kind};
use crate::geometry::Outline;
use crate::scene::Surface;
use crate::solid::Options;
use crate::solid::inflate::{Balloon, Field, Mesh, Points, surface};
use crate::solid::layers::{DEFAULT_SEGMENTS, segments_within, steps_per_half_turn};

/// Layers per half turn of the smallest outlines: seen from near by they are still round.
const LEAST_SEGMENTS: u32 = 8;
/// In what steps there are more.
const STEP: f64 = 4.0;

/// A height field to both sides.
#[derive(Debug, Clone, PartialEq)]
pub struct Inflate(Balloon);

impl Inflate {
    /// The same, no higher than this where no height is given, drawing units.
    pub(super) fn at_most(&self, height: f64) -> Self {
        Self(Balloon {
            most: Some(self.0.most.map_or(height, |most| most.min(height))),
            ..self.0
        })
    }

    /// The same as a box with rounded edges that reaches as far at most where no height is given, drawing units.
    pub(super) fn boxed(&self, reach: f64) -> Self {
        Self(Balloon {
            most: Some(reach),
            is_box: true,
            ..self.0
        })
    }

    /// A tube along the stroke of a line of this width, drawing units.
    pub(super) fn cord(width: f64) -> Self {
        Self(Balloon {
            height: None,
            most: None,
            is_box: false,
            line: Some(width),
        })
    }

    /// The same for the stroke of a line of this width, drawing units.
    pub(super) fn of_line(&self, width: f64) -> Self {
        Self(Balloon {
            line: Some(width),
            ..self.0
        })
    }
}

impl Kind for Inflate {
    fn new(numbers: &[f64], _: f64) -> Option<Self> {
        let balloon = Balloon {
            height: numbers.first().copied(),
            line: None,
            most: None,
            is_box: false,
        };
        (numbers.len() <= 1).then_some(Self(balloon))
    }

    fn numbers(&self) -> Vec<f64> {
        let Balloon {
            height,
            most,
            is_box,
            line,
        } = self.0;
        // Hashes tell one from the other.
        [height, most, is_box.then_some(1.0), line]
            .map(|number| number.unwrap_or(f64::NAN))
            .to_vec()
    }

    fn surface(&self, outline: &Outline, half: DVec2, options: &Options) -> Surface {
        surface(&self.field(outline, half, options), options)
    }

    fn triangles(&self, outline: &Outline, _: DVec2, options: &Options) -> u64 {
        // Columns of half as many points stand on the border, about four for each layer.
        let layers = steps_per_half_turn(options) as usize;
        let points = self.0.border_points(outline);
        (points.max(4 * layers) * 2 * layers) as u64
    }

    fn height_field(&self) -> Option<&dyn HeightField> {
        Some(self)
    }

    fn depths(&self, half: DVec2, _: &Options) -> Option<[f64; 2]> {
        let height = self.0.most(half);
        Some([-height, height])
    }

    fn segments(&self, half: DVec2, crease: f64, invisible: f64) -> u32 {
        let widest = self.0.line.map_or(half.min_element(), |width| width / 2.0);
        let radius = self.0.most(half).max(widest);
        let enough = segments_within(invisible, radius);
        // In coarse steps: when the drawing grows, most solids stay as they are.
        let enough = (STEP * (enough / STEP).round()) as u32;
        // With more degrees between the layers than the crease has, their edges would show.
        let smooth = ((180.0 / crease) as u32).saturating_add(1);
        enough.max(smooth).clamp(LEAST_SEGMENTS, DEFAULT_SEGMENTS)
    }
}

impl HeightField for Inflate {
    fn points(&self, outline: &Outline, segments: u32, scale: f64) -> Points {
        self.0.points(outline, segments, scale)
    }

    fn field(&self, outline: &Outline, half: DVec2, options: &Options) -> Field {
        self.0.field(outline, half, options)
    }

    fn surface_of(&self, field: &Field, options: &Options) -> Surface {
        surface(field, options)
    }

    fn heights(&self, mesh: &Mesh, half: DVec2, options: &Options) -> Vec<f64> {
        self.0.heights(mesh, half, options.placement.scale)
    }
}

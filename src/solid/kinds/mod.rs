//! The kinds of solids. Each is a type that holds the kind's numbers, in a file of its own or that of its family, and a line in
//! the list below.

mod flat;
mod inflate;
mod lathe;
mod model;
mod round;
mod taper;

use std::ops::{Deref, DerefMut};

use glam::DVec2;

use super::Options;
use super::inflate::{Field, Mesh, Points};
use super::layers::{DEFAULT_SEGMENTS, Layer, with_thickness};
use super::stack;
use crate::geometry::Outline;
use crate::scene::Surface;

/// Lists the kinds: the name in a drawing, and the type.
macro_rules! kinds {
    ($($name:literal => $module:ident::$kind:ident,)*) => {
        /// How an outline gets its thickness: a kind with its numbers. Angles are in degrees, lengths in drawing units.
        #[derive(Debug, Clone, PartialEq)]
        pub enum Profile {
            $(
                #[doc = concat!("`", $name, "`")]
                $kind($module::$kind),
            )*
        }

        impl Profile {
            /// The kind of this name with its numbers in the order of its parameters; those at the end may be missing where
            /// the language has no number for them. `plate` is half the thickness of a plate without numbers.
            ///
            /// `None` for `none` and for names that are not in the list.
            pub fn new(name: &str, numbers: &[f64], plate: f64) -> Option<Self> {
                match name {
                    $($name => Some(Self::$kind($module::$kind::new(numbers, plate)?)),)*
                    _ => None,
                }
            }
        }

        impl Deref for Profile {
            type Target = dyn Kind;

            fn deref(&self) -> &Self::Target {
                match self {
                    $(Self::$kind(kind) => kind,)*
                }
            }
        }

        impl DerefMut for Profile {
            fn deref_mut(&mut self) -> &mut Self::Target {
                match self {
                    $(Self::$kind(kind) => kind,)*
                }
            }
        }
    };
}

kinds! {
    "default" => taper::Default,
    "roundv" => round::RoundV,
    "roundh" => round::RoundH,
    "round" => round::Round,
    "cone" => taper::Cone,
    "conev" => taper::ConeV,
    "coneh" => taper::ConeH,
    "inflate" => inflate::Inflate,
    "lathe" => lathe::Lathe,
    "flat" => flat::Flat,
    "model" => model::Model,
}

impl Profile {
    /// A plate that reaches as far to both sides, drawing units.
    pub fn plate(reach: f64) -> Self {
        Self::Default(taper::Default::plate(reach))
    }

    /// The same; what is inflated without a given height is no higher than this, drawing units.
    pub fn at_most(self, height: f64) -> Self {
        match self {
            Self::Inflate(inflate) => Self::Inflate(inflate.at_most(height)),
            other => other,
        }
    }

    /// The same as a box that reaches as far to both sides, drawing units, where no depth is given: a plate, or what is inflated as a
    /// box with rounded edges, thinner where it is narrower.
    pub fn boxed(self, reach: f64) -> Self {
        match self {
            Self::Inflate(inflate) => Self::Inflate(inflate.boxed(reach)),
            Self::Default(_) => Self::plate(reach),
            other => other,
        }
    }

    /// Whether a limb of this kind is expected to bend: slabs and soft shapes are, what is turned on a lathe or cut to a point is hard.
    pub fn is_flexible(&self) -> bool {
        matches!(self, Self::Default(_) | Self::Inflate(_))
    }

    /// A tube along the stroke of a line of this width, drawing units.
    pub fn cord(width: f64) -> Self {
        Self::Inflate(inflate::Inflate::cord(width))
    }

    /// The same for the stroke of a line of this width, drawing units: what is inflated becomes a tube.
    pub fn of_line(self, width: f64) -> Self {
        match self {
            Self::Inflate(inflate) => Self::Inflate(inflate.of_line(width)),
            other => other,
        }
    }
}

/// What a kind knows about its solids; a [`Profile`] dereferences to that of its kind. `half` are the half extents of the
/// outline across the axis and along it.
pub trait Kind {
    /// See [`Profile::new`].
    fn new(numbers: &[f64], plate: f64) -> Option<Self>
    where
        Self: Sized;

    /// All numbers of the kind, for hashes.
    fn numbers(&self) -> Vec<f64>;

    /// The scaled copies of the outline that the solid joins, in order of depth or the other way round. Only the first and
    /// the last may have a scale of 0. Empty for a kind that makes its surface in another way.
    fn layers(&self, _half: DVec2, _options: &Options) -> Vec<Layer> {
        Vec::new()
    }

    /// The surface of an outline.
    fn surface(&self, outline: &Outline, half: DVec2, options: &Options) -> Surface {
        let layers = with_thickness(self.layers(half, options), half);
        stack::surface(outline, &layers, options)
    }

    /// The kind as a height field, if it is one.
    fn height_field(&self) -> Option<&dyn HeightField> {
        None
    }

    /// How deep the solid reaches to the back and to the front, drawing units. A `lathe` is taken to reach as far as the
    /// outline does.
    fn depths(&self, half: DVec2, options: &Options) -> Option<[f64; 2]> {
        let layers = with_thickness(self.layers(half, options), half);
        Some([layers.first()?.z, layers.last()?.z])
    }

    /// How many layers per half turn of a rounding it has if nobody says how many. Edges with a smaller angle than `crease`,
    /// degrees, are smooth; a surface may be off by `invisible`, drawing units.
    fn segments(&self, _half: DVec2, _crease: f64, _invisible: f64) -> u32 {
        DEFAULT_SEGMENTS
    }

    /// About how many triangles the solid has over an outline, in drawing units.
    fn triangles(&self, outline: &Outline, half: DVec2, options: &Options) -> u64 {
        let bands = self.layers(half, options).len().saturating_sub(1);
        // Where it is scaled one way only, walls may be split in four.
        let each = if self.depends_on_axis() { 4 } else { 2 };
        (outline.point_count() * (each * bands + 2)) as u64
    }

    /// The solid's plane faces parallel to the drawing, if it has any.
    fn faces(&self) -> Option<Faces> {
        None
    }

    /// Moves the solid's back and its front face outwards by these distances. A solid without such faces is unchanged.
    fn raise(&mut self, _by: [f64; 2]) {}

    /// Whether it is a surface without thickness, visible from both sides.
    fn is_open(&self) -> bool {
        false
    }

    /// Whether it is rounded or pointed: its front is no plane parallel to the drawing.
    fn is_soft(&self) -> bool {
        true
    }

    /// Whether the solid, as seen from the front, covers more than its outline, whose points are relative to its centre.
    fn overflows(&self, _outline: &Outline) -> bool {
        false
    }

    /// Whether the solid depends on the direction of the outline's axis.
    fn depends_on_axis(&self) -> bool {
        false
    }
}

/// A kind whose front is a height field over the outline, 0 along its border, and whose back mirrors the front.
pub trait HeightField {
    /// The points of a mesh of the outline, about as dense as a rounding of so many layers per 180°; `scale` are units of the
    /// outline a drawing unit.
    fn points(&self, outline: &Outline, segments: u32, scale: f64) -> Points;

    /// The front over an outline. The depth of the plane and the crease angle do not matter.
    fn field(&self, outline: &Outline, half: DVec2, options: &Options) -> Field;

    /// The surface of a field.
    fn surface_of(&self, field: &Field, options: &Options) -> Surface;

    /// The heights over the points of any mesh of the outline at its final place, model units.
    fn heights(&self, mesh: &Mesh, half: DVec2, options: &Options) -> Vec<f64>;
}

/// The plane faces of a solid that are parallel to the drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Faces {
    /// The depths of the back and of the front face, if the solid has them.
    pub depths: [Option<f64>; 2],
    /// The solid's thickness; `None` for a flat surface.
    pub thickness: Option<f64>,
}

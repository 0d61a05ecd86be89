//! The description of a solid, from which its surface is made on demand.

use crate::math;
use std::any::Any;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use glam::{DAffine2, DVec2};
use rustc_hash::FxHasher;

use super::inflate::{Field, Mesh};
use super::{Options, Placement, Profile, build, half_extents};
use crate::geometry::Outline;
use crate::scene::{Surface, SurfaceSource};

/// Everything that a solid's surface depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Its outline as drawn, y down.
    pub outline: Arc<Outline>,
    /// From the drawing to the part's own frame, y up, its centre at the origin; without scaling.
    pub to_frame: DAffine2,
    /// How it gets its thickness.
    pub profile: Profile,
    /// Resolution, smoothing and position.
    pub options: Options,
    /// The sides of the drawing plane that it is on.
    pub sides: Sides,
    /// From the drawing to texture coordinates, if it is textured. The texture is projected through the whole solid
    /// along the viewer's direction, so that walls have the colours of the border.
    pub texture: Option<DAffine2>,
}

/// The sides of the drawing plane that a solid is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sides {
    /// As described.
    Front,
    /// Mirrored in the drawing plane.
    Back,
    /// Both (`-s`).
    Both,
}

impl Sides {
    /// The sides that the solid is on after it is mirrored in the drawing plane.
    pub(super) fn mirrored(self) -> Self {
        match self {
            Self::Front => Self::Back,
            Self::Back => Self::Front,
            Self::Both => Self::Both,
        }
    }
}

/// A surface on these sides of the drawing plane.
pub(super) fn on_sides(mut surface: Surface, sides: Sides) -> Surface {
    match sides {
        Sides::Front => surface,
        Sides::Back => surface.mirrored(),
        Sides::Both => {
            let back = surface.mirrored();
            surface.append(&back);
            surface
        }
    }
}

impl SurfaceSource for Solid {
    fn surface(&self) -> Surface {
        let mut surface = build(&self.in_frame(), &self.profile, &self.options);
        if let Some(texture) = self.texture {
            let map = texture * self.to_drawing();
            let uv = |[x, y, _]: &[f32; 3]| {
                let point = map.transform_point2(DVec2::new(f64::from(*x), f64::from(*y)));
                point.as_vec2().to_array()
            };
            surface.uvs = surface.positions.iter().map(uv).collect();
        }
        on_sides(surface, self.sides)
    }

    fn key(&self) -> u64 {
        let mut hasher = FxHasher::default();
        self.hash_into(&mut hasher);
        hasher.finish()
    }

    fn mirrored(&self) -> Arc<dyn SurfaceSource> {
        Arc::new(Self {
            sides: self.sides.mirrored(),
            ..self.clone()
        })
    }

    fn is_equal(&self, other: &dyn SurfaceSource) -> bool {
        (other as &dyn Any).downcast_ref::<Self>() == Some(self)
    }
}

impl Solid {
    /// A hash of everything that the surface is made from that tells surfaces apart by itself.
    pub(super) fn long_key(&self) -> u128 {
        long_hash(|hasher| self.hash_into(hasher))
    }

    fn hash_into(&self, hasher: &mut dyn Hasher) {
        let Self {
            outline,
            to_frame,
            profile,
            options,
            sides,
            texture,
        } = self;
        hasher.write_u8(*sides as u8);
        let mut hasher = hasher;
        std::mem::discriminant(profile).hash(&mut hasher);
        hasher.write_u8(texture.is_some().into());
        let mut number = |number: f64| hasher.write_u64(number.to_bits());
        for polygon in &outline.polygons {
            number(polygon.rings.len() as f64);
            for ring in &polygon.rings {
                number(ring.len() as f64);
                let coordinates = ring.iter().flat_map(DVec2::to_array);
                coordinates.for_each(&mut number);
            }
        }
        let Options {
            segments,
            crease,
            placement,
        } = *options;
        let Placement {
            rotation,
            translation,
            scale,
        } = placement;
        number(f64::from(segments));
        number(crease);
        number(rotation);
        let translation = translation.to_array().into_iter();
        translation.for_each(&mut number);
        number(scale);
        let transforms = [*to_frame].into_iter().chain(*texture);
        let transforms = transforms.flat_map(|transform| transform.to_cols_array());
        let numbers = transforms.chain(profile.numbers());
        numbers.for_each(&mut number);
    }

    /// The front, for height fields. The depth of the plane and the crease angle do not matter.
    pub(super) fn field(&self) -> Option<Field> {
        let kind = self.profile.height_field()?;
        let outline = self.in_frame();
        let half = half_extents(&outline)?;
        Some(kind.field(&outline, half, &self.options))
    }

    /// The surface in front of the drawing plane and behind it, made from its [`Solid::field`], without texture coordinates.
    pub(super) fn surface_of(&self, field: &Field) -> Option<Surface> {
        let kind = self.profile.height_field()?;
        Some(kind.surface_of(field, &self.options))
    }

    /// The heights over the points of a mesh of its outline, for height fields.
    pub(super) fn heights_over(&self, mesh: &Mesh) -> Option<Vec<f64>> {
        let field = self.profile.height_field()?;
        let half = half_extents(&self.in_frame())?;
        Some(field.heights(mesh, half, &self.options))
    }

    /// The outline in the part's own frame.
    fn in_frame(&self) -> Outline {
        let place = |point: &DVec2| self.to_frame.transform_point2(*point);
        let outline = &self.outline;
        outline.map_rings(|ring| ring.iter().map(place).collect())
    }

    /// From the solid's final positions, as seen from the front, to the drawing.
    fn to_drawing(&self) -> DAffine2 {
        self.to_final().inverse()
    }

    /// From the drawing to the solid's final positions as seen from the front.
    pub(super) fn to_final(&self) -> DAffine2 {
        let placement = &self.options.placement;
        let placed = DAffine2::from_scale(DVec2::splat(placement.scale))
            * DAffine2::from_translation(placement.translation.truncate())
            * DAffine2::from_mat2(math::rotation(placement.rotation));
        placed * self.to_frame
    }
}

/// A hash of 128 bits, the same in every run: what it is made from need not be compared.
pub(super) fn long_hash(content: impl Fn(&mut dyn Hasher)) -> u128 {
    let [high, low] = [0, 1].map(|salt| {
        let mut hasher = DefaultHasher::new();
        hasher.write_u8(salt);
        content(&mut hasher);
        u128::from(hasher.finish())
    });
    high << 64 | low
}

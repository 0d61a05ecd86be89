//! The model: nodes, meshes, materials, textures, clips, cameras. No drawing, no glTF.
//!
//! Conventions, stated once: right-handed axes, +Y up, metres, counter-clockwise front faces seen
//! from outside, quaternions `x y z w`, colours linear RGBA.
//!
//! Whatever a scene lists is referred to by an id of its own type: `scene.nodes[id]` takes a [`NodeId`] and nothing else. Ids
//! convert to and from `usize`, which counts from 0.

mod animation;
mod camera;
mod deferred;
mod size;
mod skin;
mod turn;
mod world;

use std::borrow::Cow;
use std::sync::Arc;

use glam::{DAffine2, DQuat, DVec3};

use crate::index::index_type;
use crate::math;

pub use animation::{Animation, Interpolation, Timing, Track, Values};
pub use camera::{Camera, CameraProjection};
pub use deferred::SurfaceSource;
pub use size::Size;
pub use skin::{Influence, MAX_JOINTS, RigidTransform, Skin, SkinnedPatch, TooManyJoints};
pub use turn::{Turn, ViewId, direction, view_axes};
#[doc(no_inline)]
pub use typed_index_collections::TiVec;
pub use world::WorldTransform;

index_type!(
    /// Refers to a node in [`Scene::nodes`], or of a glTF file.
    pub NodeId
);

index_type!(
    /// Refers to a mesh in [`Scene::meshes`], or of a glTF file.
    pub MeshId
);

index_type!(
    /// Refers to a material in [`Scene::materials`], or of a linked model.
    pub MaterialId
);

index_type!(
    /// Refers to a texture in [`Scene::textures`], or of a linked model.
    pub TextureId
);

index_type!(
    /// Refers to an image in [`Scene::images`], or of a linked model.
    pub ImageId
);

index_type!(
    /// Refers to a camera in [`Scene::cameras`].
    pub CameraId
);

/// A model.
///
/// Its lists are vectors that ids of their own index; `raw` is the plain vector.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Scene {
    /// All nodes; a child comes after its parent.
    pub nodes: TiVec<NodeId, Node>,
    /// The nodes without a parent.
    pub roots: Vec<NodeId>,
    /// The meshes that nodes refer to.
    pub meshes: TiVec<MeshId, Mesh>,
    /// The materials that primitives refer to.
    pub materials: TiVec<MaterialId, Material>,
    /// The textures that materials refer to.
    pub textures: TiVec<TextureId, Texture>,
    /// The images that textures refer to.
    pub images: TiVec<ImageId, Image>,
    /// The mesh that all nodes move together, if the nodes have no meshes of their own.
    pub skin: Option<Skin>,
    /// The clips, with distinct names.
    pub animations: Vec<Animation>,
    /// The cameras that nodes refer to.
    pub cameras: TiVec<CameraId, Camera>,
}

/// A node to be added to a scene, with its mesh.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NewNode {
    /// The node.
    pub node: Node,
    /// Its mesh.
    pub mesh: Option<Mesh>,
    /// Its parent in the scene; `None` makes it a root.
    pub parent: Option<NodeId>,
}

impl Scene {
    /// Adds a node with its mesh, and returns its id.
    pub fn add(&mut self, new: NewNode) -> NodeId {
        let mut node = new.node;
        node.mesh = new.mesh.map(|mesh| self.meshes.push_and_get_key(mesh));
        let id = self.nodes.push_and_get_key(node);
        match new.parent {
            Some(parent) => self.nodes[parent].children.push(id),
            None => self.roots.push(id),
        }
        id
    }
}

/// A node of the hierarchy: a joint, with or without a solid.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Node {
    /// The part's name.
    pub name: String,
    /// Its children.
    pub children: Vec<NodeId>,
    /// Its position in the parent's frame, metres.
    pub translation: DVec3,
    /// Its rotation in the parent's frame.
    pub rotation: DQuat,
    /// Its mesh.
    pub mesh: Option<MeshId>,
    /// The nodes that bend the mesh together with this one, all below it: what the mesh's [`Influence`]s count from 1. Empty if the
    /// node alone moves the mesh.
    pub bones: Vec<NodeId>,
    /// For one of such bones, how many nodes make the turn of its joint together, each an equal share: the node and those above it. 0
    /// for those above it themselves, and for nodes that are no bones.
    pub shares: usize,
    /// Its camera. Such a node is a root, without mesh and children: a camera is no part of the model.
    pub camera: Option<CameraId>,
    /// How its mesh depends on the viewer.
    pub view_dependent: Option<ViewDependent>,
    /// Its source in the drawing.
    pub provenance: Option<Provenance>,
}

/// How a node's mesh depends on the viewer; the extension `OKOSHI_view_dependent` in glTF.
///
/// A program that does not know the extension shows the undistorted 3D model.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ViewDependent {
    /// The node's mesh and all below it are scaled about the node's origin, in its frame (+Y up, ground level), so that
    /// from 45° above and with parallel projection both tops and fronts appear at full size, as in role-playing games.
    ///
    /// With d the unit vector towards the viewer, θ = asin(d.y) its elevation in degrees and h = (d.x, 0, d.z)
    /// normalised, the scale is along u = (+Y − h)/√2, for a viewer in front (0, 1, −1)/√2, by
    /// R = 1 + (√2 − 1)·(1 − ||θ| − 45| / 45): 1 at the ground and from above, √2 at 45°.
    ///
    /// Source: Kitamura, *Modeling and Animation of Pseudo-3D Objects*, 3.2.6, for viewers in front. Equation 3.2 there swaps
    /// its two ranges for negative θ, so that R would jump to 1.83 just below the ground; here it depends on |θ| alone.
    Bend,
    /// The node's content is a flat character that faces the viewer. Where its regions are, and how far their meshes are morphed,
    /// follows from where the viewer is among the views in which the character is drawn.
    Turn(Turn),
    /// The node is a region of such a character, a child of the node that turns. It is here in each of the views, in the
    /// character's space, metres.
    Region(TiVec<ViewId, DVec3>),
}

/// The source of a node in the drawing; `extras.okoshi` in glTF.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Provenance {
    /// The `id` of the source element, if it has one.
    pub element: Option<String>,
    /// The string that describes the part.
    pub string: Option<String>,
}

/// A mesh: one primitive a material.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Its primitives, never empty.
    pub primitives: Vec<Primitive>,
}

/// Triangles of one material.
#[derive(Debug, Clone, PartialEq)]
pub struct Primitive {
    /// The patches that they consist of.
    pub patches: Vec<SurfacePatch>,
    /// Their material.
    pub material: MaterialId,
}

/// A patch of a primitive.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum SurfacePatch {
    /// Triangles; boxed, because a large scene consists of deferred patches.
    Surface(Box<Surface>),
    /// A surface that is made when it is asked for.
    Deferred(Arc<dyn SurfaceSource>),
    /// Another patch, bound to a joint of a skin.
    Skinned(Box<SkinnedPatch>),
}

impl From<Surface> for SurfacePatch {
    fn from(surface: Surface) -> Self {
        Self::Surface(Box::new(surface))
    }
}

impl SurfacePatch {
    /// Its triangles.
    pub fn surface(&self) -> Cow<'_, Surface> {
        self.surface_by(&mut |source| Cow::Owned(source.surface()))
    }

    /// Its triangles, with deferred surfaces made by `make`.
    pub fn surface_by<'a>(
        &'a self,
        make: &mut dyn FnMut(&'a Arc<dyn SurfaceSource>) -> Cow<'a, Surface>,
    ) -> Cow<'a, Surface> {
        match self {
            Self::Surface(surface) => Cow::Borrowed(surface),
            Self::Deferred(source) => make(source),
            Self::Skinned(skinned) => Cow::Owned(skinned.surface()),
        }
    }

    /// The patch mirrored in the plane z = 0.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        match self {
            Self::Deferred(source) => Self::Deferred(source.mirrored()),
            _ => self.surface().mirrored().into(),
        }
    }
}

impl Primitive {
    /// The triangles of all its patches.
    pub fn surface(&self) -> Cow<'_, Surface> {
        self.surface_by(&mut |source| Cow::Owned(source.surface()))
    }

    /// The triangles of all its patches, with deferred surfaces made by `make`.
    pub fn surface_by<'a>(
        &'a self,
        make: &mut dyn FnMut(&'a Arc<dyn SurfaceSource>) -> Cow<'a, Surface>,
    ) -> Cow<'a, Surface> {
        match self.patches.as_slice() {
            [patch] => patch.surface_by(make),
            patches => Cow::Owned(patches.iter().fold(Surface::default(), |mut all, patch| {
                all.append(&patch.surface_by(make));
                all
            })),
        }
    }
}

/// An indexed triangle mesh. All lists of corners have the same length, except that `uvs` and `influences` may be empty.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Surface {
    /// Positions, in the node's frame, metres.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, origin at the image's top left.
    pub uvs: Vec<[f32; 2]>,
    /// The joints that move each corner, in a skin or in a node with bones.
    pub influences: Vec<Influence>,
    /// Morph targets: how far the corners of each are from `positions`, metres. The weights of the mesh say how much of it is
    /// added.
    pub targets: Vec<Vec<[f32; 3]>>,
    /// Three corners a triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// Appends another surface.
    pub fn append(&mut self, other: &Surface) {
        let base = self.positions.len() as u32;
        self.positions.extend_from_slice(&other.positions);
        self.normals.extend_from_slice(&other.normals);
        if self.uvs.is_empty() != other.uvs.is_empty() {
            // If only one of them has any, they are not used, but the lists must keep the same length.
            self.uvs.resize(base as usize, [0.0; 2]);
        }
        self.uvs.extend_from_slice(&other.uvs);
        if !self.uvs.is_empty() {
            self.uvs.resize(self.positions.len(), [0.0; 2]);
        }
        self.influences.extend_from_slice(&other.influences);
        let targets = self.targets.len().max(other.targets.len());
        self.targets.resize_with(targets, Vec::new);
        for (index, target) in self.targets.iter_mut().enumerate() {
            target.resize(base as usize, [0.0; 3]);
            target.extend(other.targets.get(index).into_iter().flatten());
            target.resize(self.positions.len(), [0.0; 3]);
        }
        self.triangles.extend(
            other
                .triangles
                .iter()
                .map(|t| t.map(|corner| corner + base)),
        );
    }

    /// The surface mirrored in the plane z = 0, its triangles still counter-clockwise.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let across = |list: &[[f32; 3]]| list.iter().map(|[x, y, z]| [*x, *y, -z]).collect();
        Self {
            positions: across(&self.positions),
            normals: across(&self.normals),
            uvs: self.uvs.clone(),
            influences: self.influences.clone(),
            targets: self.targets.iter().map(|target| across(target)).collect(),
            triangles: self
                .triangles
                .iter()
                .map(|[a, b, c]| [*a, *c, *b])
                .collect(),
        }
    }
}

/// The material of a part and, if it has a texture, the map from the drawing to texture coordinates; `None` for a part that has no
/// material of its own.
pub type PartMaterial = Option<(MaterialId, Option<DAffine2>)>;

/// A glTF metallic-roughness material. Factors are multiplied with their textures.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Its name.
    pub name: String,
    /// Base colour, linear RGB and alpha, each 0 to 1.
    pub base_color: [f32; 4],
    /// Base colour, sRGB and alpha.
    pub base_color_texture: Option<TextureUse>,
    /// 0 to 1.
    pub metallic: f32,
    /// 0 to 1.
    pub roughness: f32,
    /// Roughness in green, metalness in blue, both linear.
    pub metallic_roughness_texture: Option<TextureUse>,
    /// Tangent-space normals; the amount scales their x and y.
    pub normal_texture: Option<TextureUse>,
    /// Occlusion in red, linear; the amount is its strength.
    pub occlusion_texture: Option<TextureUse>,
    /// Linear RGB, each 0 to 1.
    pub emissive: [f32; 3],
    /// Emitted light, sRGB.
    pub emissive_texture: Option<TextureUse>,
    /// The meaning of alpha.
    pub alpha_mode: AlphaMode,
    /// Visible from both sides: surfaces without thickness.
    pub double_sided: bool,
    /// Shows its base colour whatever the light (`KHR_materials_unlit`).
    pub unlit: bool,
}

impl Default for Material {
    /// White and opaque, with the default roughness of parts.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [1.0; 4],
            base_color_texture: None,
            metallic: 0.0,
            roughness: 0.9,
            metallic_roughness_texture: None,
            normal_texture: None,
            occlusion_texture: None,
            emissive: [0.0; 3],
            emissive_texture: None,
            alpha_mode: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
        }
    }
}

impl Material {
    /// All textures that it uses.
    pub fn textures(&self) -> impl Iterator<Item = &TextureUse> {
        let all = [
            &self.base_color_texture,
            &self.metallic_roughness_texture,
            &self.normal_texture,
            &self.occlusion_texture,
            &self.emissive_texture,
        ];
        all.into_iter().flatten()
    }

    /// All textures that it uses, mutable.
    pub fn textures_mut(&mut self) -> impl Iterator<Item = &mut TextureUse> {
        let all = [
            &mut self.base_color_texture,
            &mut self.metallic_roughness_texture,
            &mut self.normal_texture,
            &mut self.occlusion_texture,
            &mut self.emissive_texture,
        ];
        all.into_iter().flatten()
    }
}

/// A channel of sRGB in linear light (IEC 61966-2-1).
pub fn linear(channel: f64) -> f32 {
    let channel = channel.clamp(0.0, 1.0);
    let linear = if channel <= 0.040_45 {
        channel / 12.92
    } else {
        math::powf((channel + 0.055) / 1.055, 2.4)
    };
    linear as f32
}

/// The meaning of a material's alpha.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// Fully transparent where alpha is below the cutoff, else opaque.
    Mask {
        /// 0 to 1.
        cutoff: f32,
    },
    /// Alpha is the opacity.
    Blend,
}

/// A material's use of a texture, with the surface's texture coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextureUse {
    /// The texture.
    pub texture: TextureId,
    /// The strength, from 0 to 1; for normals and occlusion only.
    pub amount: f32,
}

impl TextureUse {
    /// A texture at full strength.
    pub fn new(texture: TextureId) -> Self {
        Self {
            texture,
            amount: 1.0,
        }
    }
}

/// An image and how it is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Texture {
    /// The image.
    pub image: ImageId,
    /// How the image continues horizontally, and vertically.
    pub wrap: [Wrap; 2],
    /// The interpolation between its pixels.
    pub filter: Filter,
}

/// How a texture continues beyond its image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Wrap {
    /// The image repeats.
    #[default]
    Repeat,
    /// The image repeats, every other time mirrored.
    MirroredRepeat,
    /// The outermost pixels continue.
    ClampToEdge,
}

/// The interpolation between pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Filter {
    /// A weighted mean of the neighbouring pixels.
    #[default]
    Linear,
    /// The nearest pixel: sharp squares.
    Nearest,
}

/// An image file. Its first row is at the texture coordinate v = 0.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// Its name.
    pub name: String,
    /// The format of the bytes.
    pub media_type: MediaType,
    /// The content of the file.
    pub bytes: Arc<[u8]>,
}

/// The formats of image files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MediaType {
    /// `image/png`.
    Png,
    /// `image/jpeg`.
    Jpeg,
}

impl MediaType {
    /// Recognises a format by a file's first bytes.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        match bytes {
            [0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1A, b'\n', ..] => Some(Self::Png),
            [0xFF, 0xD8, 0xFF, ..] => Some(Self::Jpeg),
            _ => None,
        }
    }
}

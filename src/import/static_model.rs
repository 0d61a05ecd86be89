//! A finished model that a part is made of: its triangles at rest, its materials and their images.

use ::gltf::texture::{MagFilter, WrappingMode};
use ::gltf::{Document, image, material};
use glam::{DMat3, DVec3};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::{Buffers, ImportError, ParsedFile, TriangleSoup, decode, read};
use crate::resolver::Resolver;
use crate::scene::{
    AlphaMode, Filter, Image, ImageId, Material, MaterialId, MediaType, Surface, Texture,
    TextureId, TextureUse, Wrap,
};

/// A model at rest with its materials. Vertex colours are dropped.
#[derive(Debug)]
pub struct StaticModel {
    /// Its materials.
    pub materials: TiVec<MaterialId, Material>,
    /// The textures that the materials use.
    pub textures: TiVec<TextureId, Texture>,
    /// The images that the textures use.
    pub images: TiVec<ImageId, Image>,
    /// The lower and the upper corner of its bounding box, in the file's axes: +Y up, front towards +Z.
    pub bounds: [DVec3; 2],
    meshes: Vec<MaterialMesh>,
}

/// The triangles of one material.
#[derive(Debug)]
struct MaterialMesh {
    material: MaterialId,
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    uvs: Vec<[f32; 2]>,
    triangles: Vec<[u32; 3]>,
}

/// Reads a model in its rest pose; what it links to comes from `resolver`.
///
/// # Errors
/// A file that cannot be read, has no triangles or too many, or has images that are neither PNG nor JPEG or cannot be
/// decoded.
pub fn read_static_model(
    bytes: &[u8],
    resolver: &dyn Resolver,
) -> Result<StaticModel, ImportError> {
    let ParsedFile {
        document,
        buffers,
        geometry,
    } = read(bytes, resolver)?;
    let soup = geometry.triangles(&geometry.rest())?;
    let mut materials: TiVec<MaterialId, Material> =
        document.materials().map(|m| self::material(&m)).collect();
    // The default material of glTF.
    let default = materials.push_and_get_key(Material {
        name: "default".to_owned(),
        metallic: 1.0,
        roughness: 1.0,
        ..Material::default()
    });
    let meshes = meshes(&soup, &materials, default);
    let points = || meshes.iter().flat_map(|mesh| &mesh.positions).copied();
    let first = points().next().ok_or(ImportError::Empty)?;
    let bounds = points().fold([first; 2], |[low, high], p| [low.min(p), high.max(p)]);
    let mut asset = StaticModel {
        textures: textures(&document),
        images: images(&document, &buffers, resolver)?,
        materials,
        bounds,
        meshes,
    };
    asset.remove_unused();
    Ok(asset)
}

impl StaticModel {
    /// The number of triangles.
    pub fn triangles(&self) -> usize {
        self.meshes.iter().map(|mesh| mesh.triangles.len()).sum()
    }

    /// One surface for each material, with its material. Every point is moved to `turn · point + translation`;
    /// `turn` may contain a uniform scale.
    pub fn placed(
        &self,
        turn: DMat3,
        translation: DVec3,
    ) -> impl Iterator<Item = (MaterialId, Surface)> {
        self.meshes.iter().map(move |mesh| {
            let place = |point: &DVec3| (turn * *point + translation).as_vec3().to_array();
            let lean = |normal: &DVec3| (turn * *normal).normalize_or_zero().as_vec3().to_array();
            let surface = Surface {
                positions: mesh.positions.iter().map(place).collect(),
                normals: mesh.normals.iter().map(lean).collect(),
                uvs: mesh.uvs.clone(),
                triangles: mesh.triangles.clone(),
                ..Surface::default()
            };
            (mesh.material, surface)
        })
    }

    /// Removes unused materials, textures and images.
    fn remove_unused(&mut self) {
        let of_pieces = self.meshes.iter_mut().map(|mesh| &mut mesh.material);
        retain_used(&mut self.materials, of_pieces.collect());
        let of_materials = self.materials.iter_mut().flat_map(Material::textures_mut);
        retain_used(
            &mut self.textures,
            of_materials.map(|used| &mut used.texture).collect(),
        );
        let of_textures = self.textures.iter_mut().map(|texture| &mut texture.image);
        retain_used(&mut self.images, of_textures.collect());
    }
}

/// Removes the items that nothing refers to, and renumbers the references.
fn retain_used<Id, T>(list: &mut TiVec<Id, T>, references: Vec<&mut Id>)
where
    Id: Copy + From<usize>,
    usize: From<Id>,
{
    let mut is_used: TiVec<Id, bool> = ti_vec![false; list.len()];
    references.iter().for_each(|id| is_used[**id] = true);
    let mut kept = TiVec::with_capacity(list.len());
    let items = std::mem::take(list).into_iter_enumerated();
    let numbers: TiVec<Id, Option<Id>> = items
        .map(|(id, item)| is_used[id].then(|| kept.push_and_get_key(item)))
        .collect();
    *list = kept;
    for id in references {
        *id = numbers[*id].unwrap_or(*id);
    }
}

/// The triangles that have an area, grouped by material; those without one have the default.
fn meshes(
    soup: &TriangleSoup,
    materials: &TiSlice<MaterialId, Material>,
    default: MaterialId,
) -> Vec<MaterialMesh> {
    let mut meshes: Vec<MaterialMesh> = Vec::new();
    let mut piece_of: TiVec<MaterialId, Option<usize>> = ti_vec![None; materials.len()];
    // For each corner: the mesh that it was copied to, and its index there.
    let mut copies: Vec<Option<(usize, u32)>> = vec![None; soup.positions.len()];
    for (triangle, material) in soup.triangles.iter().zip(&soup.materials) {
        let corners = triangle.map(|corner| soup.positions[corner as usize]);
        let facet = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let sound = |p: &DVec3| p.is_finite() && p.abs().max_element() < 1e30;
        if !corners.iter().all(sound) || facet.try_normalize().is_none() {
            continue;
        }
        let material = material.map_or(default, |material| MaterialId::from(material as usize));
        let slot = *piece_of[material].get_or_insert_with(|| {
            meshes.push(MaterialMesh {
                material,
                positions: Vec::new(),
                normals: Vec::new(),
                uvs: Vec::new(),
                triangles: Vec::new(),
            });
            meshes.len() - 1
        });
        let textured = materials[material].textures().next().is_some();
        let mesh = &mut meshes[slot];
        let mut push = |corner: usize, normal: DVec3| {
            mesh.positions.push(soup.positions[corner]);
            mesh.normals.push(normal);
            if textured {
                let uv = soup.uvs[corner].to_array();
                mesh.uvs.push(if uv.iter().all(|n| n.is_finite()) {
                    uv
                } else {
                    [0.0; 2]
                });
            }
            mesh.positions.len() as u32 - 1
        };
        // Triangles without normals are shaded flat (glTF 2.0, 3.7.2.1), so they cannot share corners.
        let flat = triangle
            .iter()
            .any(|corner| soup.normals[*corner as usize].length_squared() < 0.5);
        let numbers = triangle.map(|corner| {
            let corner = corner as usize;
            if flat {
                return push(corner, facet.normalize());
            }
            match copies[corner] {
                Some((owner, number)) if owner == slot => number,
                _ => {
                    let number = push(corner, soup.normals[corner].as_dvec3());
                    copies[corner] = Some((slot, number));
                    number
                }
            }
        });
        mesh.triangles.push(numbers);
    }
    meshes
}

fn material(source: &::gltf::Material<'_>) -> Material {
    let base = source.pbr_metallic_roughness();
    let plain = |info: ::gltf::texture::Info<'_>| TextureUse::new(info.texture().index().into());
    let strength = source.emissive_strength().unwrap_or(1.0);
    Material {
        name: source.name().unwrap_or_default().to_owned(),
        base_color: base.base_color_factor(),
        base_color_texture: base.base_color_texture().map(plain),
        metallic: base.metallic_factor(),
        roughness: base.roughness_factor(),
        metallic_roughness_texture: base.metallic_roughness_texture().map(plain),
        normal_texture: source.normal_texture().map(|normal| TextureUse {
            amount: normal.scale(),
            ..TextureUse::new(normal.texture().index().into())
        }),
        occlusion_texture: source.occlusion_texture().map(|occlusion| TextureUse {
            amount: occlusion.strength(),
            ..TextureUse::new(occlusion.texture().index().into())
        }),
        emissive: source
            .emissive_factor()
            .map(|channel| (channel * strength).clamp(0.0, 1.0)),
        emissive_texture: source.emissive_texture().map(plain),
        alpha_mode: match source.alpha_mode() {
            material::AlphaMode::Opaque => AlphaMode::Opaque,
            material::AlphaMode::Mask => AlphaMode::Mask {
                cutoff: source.alpha_cutoff().unwrap_or(0.5),
            },
            material::AlphaMode::Blend => AlphaMode::Blend,
        },
        double_sided: source.double_sided(),
        unlit: source.unlit(),
    }
}

fn textures(document: &Document) -> TiVec<TextureId, Texture> {
    let wrap = |mode| match mode {
        WrappingMode::ClampToEdge => Wrap::ClampToEdge,
        WrappingMode::MirroredRepeat => Wrap::MirroredRepeat,
        WrappingMode::Repeat => Wrap::Repeat,
    };
    let texture = |texture: ::gltf::Texture<'_>| {
        let sampler = texture.sampler();
        Texture {
            image: texture.source().index().into(),
            wrap: [wrap(sampler.wrap_s()), wrap(sampler.wrap_t())],
            filter: match sampler.mag_filter() {
                Some(MagFilter::Nearest) => Filter::Nearest,
                _ => Filter::Linear,
            },
        }
    };
    document.textures().map(texture).collect()
}

fn images(
    document: &Document,
    buffers: &Buffers,
    resolver: &dyn Resolver,
) -> Result<TiVec<ImageId, Image>, ImportError> {
    let read = |image: image::Image<'_>| {
        let bytes = buffers.image(document, &image, resolver)?;
        let index = image.index();
        let media_type = MediaType::of(&bytes)
            .ok_or_else(|| ImportError::Image(format!("image {index} is neither PNG nor JPEG")))?;
        // They are written as they are, and others could not read a damaged one either.
        decode(&bytes)?;
        Ok(Image {
            name: image.name().unwrap_or_default().to_owned(),
            media_type,
            bytes,
        })
    };
    document.images().map(read).collect()
}

//! Meshes: triangles and their vertex attributes.

use crate::math;
use ::gltf::mesh::Mode;
use ::gltf::texture::TextureTransform;
use ::gltf::{Accessor, Document, Material, Primitive as Source, Semantic};
use glam::{DMat3, DVec3, Vec2, Vec4};

use super::buffers::{Buffers, F32, SCALAR, U8, U16, U32, VEC2, VEC3, VEC4};
use super::pose::Primitive;
use super::{ImportError, MAX_REPEATED, malformed};

/// Checks how much memory the vertices of a file need, before they are read.
///
/// # Errors
/// If that is more than its data and [`MAX_REPEATED`].
pub(super) fn check_size(document: &Document, buffers: &Buffers) -> Result<(), ImportError> {
    let mut needed = 0_usize;
    for primitive in document.meshes().flat_map(|mesh| mesh.primitives()) {
        let targets = primitive
            .morph_targets()
            .filter_map(|target| target.positions());
        let attributes = primitive.attributes().map(|(_, accessor)| accessor);
        let attributes = attributes.chain(targets).map(|accessor| {
            let length = accessor.count().saturating_mul(accessor.size());
            // One that is longer than its view is refused when it is read.
            let view = accessor.view();
            view.map_or(length, |view| length.min(view.length()))
        });
        // In a strip or fan every index makes a triangle.
        let of_index = match primitive.mode() {
            Mode::Triangles => size_of::<u32>(),
            _ => size_of::<[u32; 3]>(),
        };
        let indices = primitive
            .indices()
            .map(|indices| indices.count().saturating_mul(of_index));
        needed = attributes
            .chain(indices)
            .fold(needed, usize::saturating_add);
    }
    if needed <= buffers.length().saturating_add(MAX_REPEATED) {
        Ok(())
    } else {
        Err(ImportError::TooManyVertices(needed >> 20))
    }
}

/// The primitives of a mesh that consist of triangles.
pub(super) fn read(
    mesh: &::gltf::Mesh<'_>,
    buffers: &Buffers,
) -> Result<Vec<Primitive>, ImportError> {
    mesh.primitives()
        .filter_map(|source| primitive(&source, buffers).transpose())
        .collect()
}

fn primitive(source: &Source<'_>, buffers: &Buffers) -> Result<Option<Primitive>, ImportError> {
    let mode = source.mode();
    if !matches!(
        mode,
        Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
    ) {
        return Ok(None);
    }
    let Some(positions) = source.get(&Semantic::Positions) else {
        return Ok(None);
    };
    let positions: Vec<[f32; 3]> = buffers.list(&positions, &[(F32, VEC3)])?.collect();
    let count = positions.len();
    let same = |length: usize, what: &str| {
        if length == count {
            Ok(())
        } else {
            Err(malformed(format!(
                "a mesh has {count} corners but {length} {what}"
            )))
        }
    };
    let normals: Vec<[f32; 3]> = match source.get(&Semantic::Normals) {
        Some(accessor) => buffers.list(&accessor, &[(F32, VEC3)])?.collect(),
        None => Vec::new(),
    };
    if !normals.is_empty() {
        same(normals.len(), "normals")?;
    }
    let mut targets = Vec::new();
    for target in source.morph_targets() {
        let target: Vec<[f32; 3]> = match target.positions() {
            Some(accessor) => buffers.list(&accessor, &[(F32, VEC3)])?.collect(),
            None => vec![[0.0; 3]; count],
        };
        same(target.len(), "corners in a morph target")?;
        targets.push(target);
    }
    let reader = source.reader(|buffer| buffers.of(&buffer));
    let check = |accessor: Option<Accessor<'_>>, types: &[_]| {
        accessor.map(|a| buffers.check(&a, types)).transpose()
    };

    let material = source.material();
    let mut uvs = Vec::new();
    if let Some((set, transform)) = coordinates(&material) {
        let types = [(F32, VEC2), (U8, VEC2), (U16, VEC2)];
        if check(source.get(&Semantic::TexCoords(set)), &types)?.is_some() {
            let matrix =
                transform.map_or(DMat3::IDENTITY, |transform| transform_matrix(&transform));
            let apply = |[u, v]: [f32; 2]| {
                let moved = matrix * DVec3::new(f64::from(u), f64::from(v), 1.0);
                Vec2::new(moved.x as f32, moved.y as f32)
            };
            uvs = reader
                .read_tex_coords(set)
                .map_or_else(Vec::new, |list| list.into_f32().map(apply).collect());
            same(uvs.len(), "texture coordinates")?;
        }
    }
    let types = [
        (F32, VEC3),
        (U8, VEC3),
        (U16, VEC3),
        (F32, VEC4),
        (U8, VEC4),
        (U16, VEC4),
    ];
    let mut colors = Vec::new();
    if check(source.get(&Semantic::Colors(0)), &types)?.is_some() {
        let list = reader.read_colors(0);
        colors = list.map_or_else(Vec::new, |list| {
            list.into_rgba_f32().map(Vec4::from).collect()
        });
        same(colors.len(), "colours")?;
    }
    let mut influences = Vec::new();
    for set in 0.. {
        let joints = check(
            source.get(&Semantic::Joints(set)),
            &[(U8, VEC4), (U16, VEC4)],
        )?;
        let weights = check(
            source.get(&Semantic::Weights(set)),
            &[(F32, VEC4), (U8, VEC4), (U16, VEC4)],
        )?;
        if joints.is_none() || weights.is_none() {
            break;
        }
        let lists = reader.read_joints(set).zip(reader.read_weights(set));
        let pairs = lists.map_or_else(Vec::new, |(joints, weights)| {
            joints.into_u16().zip(weights.into_f32()).collect()
        });
        same(pairs.len(), "weights")?;
        influences.push(pairs);
    }
    let indices: Vec<u32> = match source.indices() {
        Some(accessor) => {
            buffers.check(&accessor, &[(U8, SCALAR), (U16, SCALAR), (U32, SCALAR)])?;
            reader
                .read_indices()
                .map_or_else(Vec::new, |list| list.into_u32().collect())
        }
        None => (0..count as u32).collect(),
    };
    if let Some(wrong) = indices.iter().find(|index| **index as usize >= count) {
        return Err(malformed(format!(
            "a mesh of {count} corners names corner {wrong}"
        )));
    }
    Ok(Some(Primitive {
        positions,
        targets,
        normals,
        uvs,
        colors,
        influences,
        triangles: triangles(mode, &indices),
        material: material.index(),
    }))
}

/// The set of texture coordinates of a material's first texture, the base colour's before others, and its texture
/// transform.
fn coordinates<'a>(material: &Material<'a>) -> Option<(u32, Option<TextureTransform<'a>>)> {
    let base = material.pbr_metallic_roughness();
    let info = base
        .base_color_texture()
        .or_else(|| base.metallic_roughness_texture())
        .or_else(|| material.emissive_texture());
    let Some(info) = info else {
        let normal = material.normal_texture().map(|normal| normal.tex_coord());
        let occlusion = || material.occlusion_texture().map(|map| map.tex_coord());
        return normal.or_else(occlusion).map(|set| (set, None));
    };
    let transform = info.texture_transform();
    let other = transform.as_ref().and_then(TextureTransform::tex_coord);
    Some((other.unwrap_or_else(|| info.tex_coord()), transform))
}

/// The corners of each triangle, in the order that glTF specifies for the mode.
fn triangles(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => {
            let turn = |(place, t): (usize, &[u32])| [t[0], t[1 + place % 2], t[2 - place % 2]];
            indices.windows(3).enumerate().map(turn).collect()
        }
        Mode::TriangleFan => {
            let (first, rest) = indices
                .split_first()
                .map_or((0, indices), |(first, rest)| (*first, rest));
            rest.windows(2)
                .map(|edge| [edge[0], edge[1], first])
                .collect()
        }
        _ => indices
            .chunks_exact(3)
            .map(|t| [t[0], t[1], t[2]])
            .collect(),
    }
}

/// The matrix of `KHR_texture_transform`: translation × rotation × scale.
fn transform_matrix(transform: &TextureTransform<'_>) -> DMat3 {
    let [x, y] = transform.offset().map(f64::from);
    let [width, height] = transform.scale().map(f64::from);
    let (sin, cos) = math::sin_cos(f64::from(transform.rotation()));
    DMat3::from_cols(
        DVec3::new(cos * width, -sin * width, 0.0),
        DVec3::new(sin * height, cos * height, 0.0),
        DVec3::new(x, y, 1.0),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_winding() {
        let indices = [0, 1, 2, 3, 4];
        assert_eq!(
            triangles(Mode::TriangleStrip, &indices),
            [[0, 1, 2], [1, 3, 2], [2, 3, 4]]
        );
        assert_eq!(
            triangles(Mode::TriangleFan, &indices),
            [[1, 2, 0], [2, 3, 0], [3, 4, 0]]
        );
        assert_eq!(triangles(Mode::Triangles, &indices), [[0, 1, 2]]);
        assert!(triangles(Mode::TriangleFan, &[]).is_empty());
    }
}

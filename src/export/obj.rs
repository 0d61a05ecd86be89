//! Wavefront OBJ, `.obj`: shapes for programs that read no glTF.
//!
//! Each node with a mesh is an object with its name, in its place in the world. Faces have normals and texture coordinates,
//! and name their materials. The format has no joints and no clips, and its colours and images would be in files of their
//! own, so all of these are left out.

use std::fmt::Write as _;
use std::io;

use glam::{Quat, Vec3};
use rayon::prelude::*;

use super::size::Extent;
use super::surfaces::with_surface;
use super::{Exporter, Output, SKINNED, Written, check, invalid};
use crate::memo::Memo;
use crate::scene::{MeshId, Primitive, RigidTransform, Scene, Surface};

/// Primitives that are in memory at a time.
const WINDOW: usize = 512;

/// Wavefront OBJ.
pub const OBJ: Obj = Obj;

/// Wavefront OBJ.
#[derive(Debug, Clone, Copy)]
pub struct Obj;

/// A primitive of a node.
struct Part<'a> {
    primitive: &'a Primitive,
    /// The name of the node, at its first primitive.
    object: Option<&'a str>,
    pose: RigidTransform,
}

impl Exporter for Obj {
    fn extension(&self) -> &'static str {
        "obj"
    }

    fn description(&self) -> &'static str {
        "Wavefront OBJ: shapes and names of materials, without colours, images and clips"
    }

    fn is_animated(&self) -> bool {
        false
    }

    fn write(&self, scene: &Scene, out: &mut dyn Output, memo: &Memo) -> io::Result<Written> {
        let mut written = Written::default();
        let mut extent = Extent::default();
        // The indices of the next vertex, texture coordinates and normal; they count from 1.
        let mut next = [1; 3];
        writeln!(out, "# okoshi {}", env!("CARGO_PKG_VERSION"))?;
        for window in parts(scene).chunks(WINDOW) {
            let surfaces: Vec<Surface> = window
                .par_iter()
                .map(|part| part.surface(scene, memo))
                .collect::<io::Result<_>>()?;
            let starts = surfaces.iter().map(|surface| {
                let start = next;
                next[0] += surface.positions.len();
                next[1] += surface.uvs.len();
                next[2] += surface.normals.len();
                start
            });
            let starts: Vec<[usize; 3]> = starts.collect();
            let texts: Vec<String> = (window, &surfaces, starts)
                .into_par_iter()
                .map(|(part, surface, start)| part.text(scene, surface, start))
                .collect();
            for (text, surface) in texts.iter().zip(&surfaces) {
                out.write_all(text.as_bytes())?;
                if let Some(bounds) = check::bounds(&surface.positions) {
                    extent.add(&surface.positions, bounds, &RigidTransform::IDENTITY);
                }
                written.vertices += surface.positions.len();
                written.triangles += surface.triangles.len();
                written.bytes += text.len() as u64;
            }
        }
        written.size = extent.size();
        Ok(written)
    }
}

/// The primitives of all nodes in the order of the nodes, and those of a skin.
fn parts(scene: &Scene) -> Vec<Part<'_>> {
    let mut parts = vec![];
    let mut push = |mesh: MeshId, name, pose| {
        let mut object = Some(name);
        parts.extend(scene.meshes[mesh].primitives.iter().map(|primitive| Part {
            primitive,
            object: object.take(),
            pose,
        }));
    };
    for (node, pose) in scene.nodes.iter().zip(scene.rest()) {
        if let Some(mesh) = node.mesh {
            push(mesh, node.name.as_str(), pose);
        }
    }
    if let Some(skin) = &scene.skin {
        push(skin.mesh, SKINNED, RigidTransform::IDENTITY);
    }
    parts
}

impl Part<'_> {
    /// The surface in the world.
    fn surface(&self, scene: &Scene, memo: &Memo) -> io::Result<Surface> {
        let mut surface = with_surface(self.primitive, memo, Surface::clone);
        if surface.triangles.is_empty() {
            return Ok(Surface::default());
        }
        check::surface(&surface, scene.nodes.len())?;
        if self.primitive.material >= scene.materials.next_key() {
            return Err(invalid("a primitive with a material out of range"));
        }
        for position in &mut surface.positions {
            let place = self.pose.place(Vec3::from(*position).as_dvec3());
            *position = place.as_vec3().to_array();
        }
        let rotation: Quat = self.pose.rotation.as_quat();
        for normal in &mut surface.normals {
            *normal = (rotation * Vec3::from(*normal)).to_array();
        }
        Ok(surface)
    }

    fn text(&self, scene: &Scene, surface: &Surface, start: [usize; 3]) -> String {
        let mut out = String::new();
        // Writing to a string does not fail.
        let _ = self.write(scene, surface, start, &mut out);
        out
    }

    fn write(
        &self,
        scene: &Scene,
        surface: &Surface,
        [vertex, uv, normal]: [usize; 3],
        out: &mut String,
    ) -> std::fmt::Result {
        if let Some(object) = self.object {
            writeln!(out, "o {}", word(object))?;
        }
        if surface.triangles.is_empty() {
            return Ok(());
        }
        for [x, y, z] in &surface.positions {
            writeln!(out, "v {x} {y} {z}")?;
        }
        // An image's first row is at v = 1 here.
        for [u, v] in &surface.uvs {
            writeln!(out, "vt {u} {}", 1.0 - v)?;
        }
        for [x, y, z] in &surface.normals {
            writeln!(out, "vn {x} {y} {z}")?;
        }
        let material = &scene.materials[self.primitive.material].name;
        writeln!(out, "usemtl {}", word(material))?;
        for triangle in &surface.triangles {
            out.push('f');
            for corner in triangle.map(|corner| corner as usize) {
                let [vertex, uv, normal] = [vertex, uv, normal].map(|first| first + corner);
                match (surface.uvs.is_empty(), surface.normals.is_empty()) {
                    (true, true) => write!(out, " {vertex}")?,
                    (true, false) => write!(out, " {vertex}//{normal}")?,
                    (false, true) => write!(out, " {vertex}/{uv}")?,
                    (false, false) => write!(out, " {vertex}/{uv}/{normal}")?,
                }
            }
            out.push('\n');
        }
        Ok(())
    }
}

/// A name as one word.
fn word(name: &str) -> String {
    let mut word = name.replace(|c: char| c.is_whitespace() || c.is_control(), "_");
    if word.is_empty() {
        word.push('_');
    }
    word
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::{GLB, by_extension, to_memory};
    use crate::scene::{Material, Mesh, Node, SurfacePatch};
    use glam::{DQuat, DVec3};
    use std::path::Path;
    use typed_index_collections::ti_vec;

    fn triangle(uvs: Vec<[f32; 2]>) -> Mesh {
        let surface = Surface {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.5, 0.0]],
            normals: vec![[0.0, 0.0, 1.0]; 3],
            uvs,
            influences: vec![],
            targets: Vec::new(),
            triangles: vec![[0, 1, 2]],
        };
        Mesh {
            primitives: vec![Primitive {
                patches: vec![SurfacePatch::Surface(Box::new(surface))],
                material: 0.into(),
            }],
        }
    }

    fn scene() -> Scene {
        let node = |name: &str, mesh: usize, children| Node {
            name: name.to_owned(),
            children,
            translation: DVec3::new(0.0, 2.0, 0.0),
            rotation: DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
            mesh: Some(mesh.into()),
            ..Node::default()
        };
        Scene {
            nodes: ti_vec![node("Upper arm", 0, vec![1.into()]), node("", 1, vec![])],
            roots: vec![0.into()],
            meshes: ti_vec![triangle(vec![]), triangle(vec![[0.25, 0.0]; 3])],
            materials: ti_vec![Material {
                name: "sky blue".to_owned(),
                ..Material::default()
            }],
            ..Scene::default()
        }
    }

    fn lines<'a>(text: &'a str, kind: &str) -> Vec<&'a str> {
        text.lines()
            .filter_map(|line| line.strip_prefix(kind)?.strip_prefix(' '))
            .collect()
    }

    /// The numbers of each line of a kind.
    fn numbers(text: &str, kind: &str) -> Vec<Vec<f32>> {
        let numbers = |line: &str| {
            line.split(' ')
                .map(|number| number.parse().unwrap())
                .collect()
        };
        lines(text, kind).into_iter().map(numbers).collect()
    }

    #[test]
    fn nodes_are_objects_in_the_world() {
        let exporter = by_extension(Path::new("a/model.OBJ")).unwrap();
        let model = to_memory(exporter, &scene(), None).unwrap();
        assert_eq!((model.written.vertices, model.written.triangles), (6, 2));
        let size = model.written.size.unwrap();
        assert_eq!([size.width, size.height, size.depth], [3.0, 1.5, 0.0]);
        assert_eq!(super::super::size(&scene()).unwrap(), Some(size));
        assert_eq!(
            to_memory(&GLB, &scene(), None).unwrap().written.size,
            Some(size)
        );
        let text = String::from_utf8(model.bytes).unwrap();
        assert_eq!(lines(&text, "o"), ["Upper_arm", "_"]);
        assert_eq!(lines(&text, "usemtl"), ["sky_blue"; 2]);
        assert_eq!(lines(&text, "f"), ["1//1 2//2 3//3", "4/1/4 5/2/5 6/3/6"]);
        assert_eq!(lines(&text, "vt"), ["0.25 1"; 3]);
        let expected = [
            [0.0, 2.0, 0.0],
            [0.0, 3.0, 0.0],
            [-0.5, 2.0, 0.0],
            [-2.0, 2.0, 0.0],
            [-3.0, 2.0, 0.0],
            [-2.0, 1.5, 0.0],
        ];
        for (kind, expected) in [("v", expected), ("vn", [[0.0, 0.0, 1.0]; 6])] {
            let rows = numbers(&text, kind);
            assert_eq!(rows.len(), expected.len());
            for (row, expected) in rows.iter().zip(expected) {
                let near = |(a, b): (&f32, f32)| (a - b).abs() < 1e-6;
                assert!(row.iter().zip(expected).all(near), "{kind} {row:?}");
            }
        }
    }

    #[test]
    fn a_skinned_model_is_the_same_shape() {
        let text = |scene: &Scene| {
            let model = to_memory(&OBJ, scene, None).unwrap();
            String::from_utf8(model.bytes).unwrap()
        };
        let skinned = text(&scene().skinned().unwrap());
        assert_eq!(lines(&skinned, "o"), [SKINNED]);
        let mut positions = [numbers(&text(&scene()), "v"), numbers(&skinned, "v")];
        let rounded = |number: &mut f32| *number = (*number * 1e4).round() + 0.0;
        for positions in &mut positions {
            positions.iter_mut().flatten().for_each(rounded);
        }
        assert_eq!(positions[0], positions[1]);
    }

    #[test]
    fn invalid_surfaces_are_refused() {
        let mut broken = scene();
        broken.meshes.raw[0].primitives[0].material = 1.into();
        let error = to_memory(&OBJ, &broken, None).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::InvalidInput);
    }
}

//! No two faces with the same normal overlap in one plane (z-fighting), or a warning says so: they would
//! flicker.
#![cfg(feature = "cli")]

mod common;

use std::any::Any;
use std::fs;
use std::path::{Path, PathBuf};

use glam::{DAffine3, DVec2, DVec3};
use okoshi::FolderResolver;
use okoshi::diagnostic::{Code, Diagnostic};
use okoshi::internals::geometry::{FillRule, area, intersect, resolve_overlaps};
use okoshi::internals::solid::{Sides, Solid};
use okoshi::scene::{NodeId, Scene, SurfacePatch, TiVec};

/// The distance below which planes coincide, as a share of the model's extent.
const NEAR: f64 = 1e-6;
/// The common area that is ignored, as a share of the smaller triangle.
const COMMON: f64 = 1e-3;
/// The most pairs that are compared in a drawing.
const PAIRS: usize = 400_000;

/// A triangle that faces along the viewer's axis.
struct Face {
    owner: usize,
    /// Whether it faces the viewer.
    front: bool,
    z: f64,
    corners: [DVec2; 3],
}

/// All triangles perpendicular to the viewer's axis, each with the number of its solid.
fn faces(scene: &Scene) -> Vec<Face> {
    let mut places: TiVec<NodeId, _> = vec![DAffine3::IDENTITY; scene.nodes.len()].into();
    let mut out = Vec::new();
    let mut owner = 0;
    for (id, node) in scene.nodes.iter_enumerated() {
        let own = DAffine3::from_rotation_translation(node.rotation, node.translation);
        places[id] *= own;
        for child in &node.children {
            places[*child] = places[id];
        }
        let primitives = node
            .mesh
            .iter()
            .flat_map(|mesh| &scene.meshes[*mesh].primitives);
        for patch in primitives.flat_map(|primitive| &primitive.patches) {
            owner += 1;
            // A solid and its copy count as two.
            let copies = match patch {
                SurfacePatch::Deferred(source) => (&**source as &dyn Any)
                    .downcast_ref::<Solid>()
                    .is_some_and(|solid| solid.sides == Sides::Both),
                _ => false,
            };
            let surface = patch.surface();
            let half = surface.triangles.len() / 2;
            for (number, triangle) in surface.triangles.iter().enumerate() {
                let corners = triangle.map(|i| {
                    let at = glam::Vec3::from(surface.positions[i as usize]).as_dvec3();
                    places[id].transform_point3(at)
                });
                let [a, b, c] = corners;
                let normal = (b - a).cross(c - a).normalize_or_zero();
                if normal.z.abs() < 1.0 - 1e-9 {
                    continue;
                }
                out.push(Face {
                    owner: 2 * owner + usize::from(copies && number >= half),
                    front: normal.z > 0.0,
                    z: (a.z + b.z + c.z) / 3.0,
                    corners: corners.map(DVec3::truncate),
                });
            }
        }
    }
    out
}

fn outline(face: &Face) -> okoshi::internals::geometry::Outline {
    resolve_overlaps(vec![face.corners.to_vec()], FillRule::NonZero)
}

/// Pairs of faces of different solids that would flicker.
fn flickering(scene: &Scene) -> usize {
    let mut faces = faces(scene);
    let all = || faces.iter().flat_map(|face| face.corners);
    let extent = all().fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
    faces.sort_by(|a, b| a.z.total_cmp(&b.z));
    let bounds = |face: &Face| {
        let [a, b, c] = face.corners;
        (a.min(b).min(c), a.max(b).max(c))
    };
    let (mut found, mut pairs) = (0, 0);
    for (index, one) in faces.iter().enumerate() {
        let (low, high) = bounds(one);
        for other in &faces[index + 1..] {
            if other.z - one.z > NEAR * extent {
                break;
            }
            let (other_low, other_high) = bounds(other);
            let apart = low.cmpgt(other_high).any() || other_low.cmpgt(high).any();
            if other.owner == one.owner || other.front != one.front || apart {
                continue;
            }
            pairs += 1;
            assert!(pairs <= PAIRS, "more pairs of faces than are looked at");
            let (one, other) = (outline(one), outline(other));
            let common = area(&intersect(&one, &other));
            if common > COMMON * area(&one).min(area(&other)) {
                found += 1;
            }
        }
    }
    found
}

fn drawings() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let inside = |folder: &str| fs::read_dir(root.join(folder)).expect("a folder");
    let examples = inside("examples").map(|entry| entry.expect("an entry").path());
    let cases =
        inside("tests/cases").map(|entry| entry.expect("an entry").path().join("drawing.svg"));
    let svg = |path: &PathBuf| path.extension().is_some_and(|end| end == "svg") && path.exists();
    let mut all: Vec<PathBuf> = examples.chain(cases).filter(svg).collect();
    all.sort();
    all
}

#[test]
fn no_faces_flicker() {
    let drawings = drawings();
    assert!(drawings.len() > 100);
    let mut bad = Vec::new();
    for path in drawings {
        let text = fs::read_to_string(&path).expect("text");
        let folder = path.parent().expect("a folder");
        let compiled = common::compiled(&text, &FolderResolver::new(folder));
        let found = flickering(&compiled.scene);
        let told = |diagnostic: &Diagnostic| diagnostic.code == Code::CopiesCoincide;
        if found > 0 && !compiled.diagnostics.iter().any(told) {
            bad.push(format!("{}: {found}", path.display()));
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

/// The measure finds faces that flicker.
#[test]
fn faces_in_one_plane_are_found() {
    let drawing = |second: &str| {
        let text = format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">
  <rect x="10" y="10" width="40" height="40" fill="red"/><text x="30" y="30">A$Shape -s default 5 9</text>
  <rect x="{second}" y="10" width="40" height="30" fill="blue"/><text x="{second}" y="30">B$Shape -s default 5 9 Offset 4</text>
</svg>"##
        );
        flickering(&common::compiled(&text, &okoshi::resolver::MemoryResolver::default()).scene)
    };
    // B reaches from 9 to 13: it stands on A, back to back.
    assert_eq!(drawing("30"), 0);
    let mut scene = common::compiled(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><rect x="10" y="10" width="40" height="40" fill="red"/></svg>"##,
        &okoshi::resolver::MemoryResolver::default(),
    )
    .scene;
    let again = scene.nodes.raw[0].clone();
    scene.nodes.push(again);
    scene.roots.push(1.into());
    assert!(flickering(&scene) >= 4);
}

//! Shared by the tests: models read back from GLB with the `gltf` crate.
#![allow(
    dead_code,
    reason = "each test file is a crate of its own and uses its share"
)]

#[cfg(feature = "disk")]
pub(crate) mod changed;
#[cfg(feature = "cli")]
pub(crate) mod editor;
pub(crate) mod law;
#[cfg(feature = "cli")]
pub(crate) mod live;
#[cfg(feature = "cli")]
pub(crate) mod pages;
pub(crate) mod patience;
#[cfg(feature = "cli")]
pub(crate) mod program;
pub(crate) mod rewrite;

use std::collections::{BTreeSet, HashMap, HashSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use gltf::animation::util::ReadOutputs;
use okoshi::compile::{Compiled, Options, compile};
use okoshi::export::{GLB, to_memory};
use okoshi::resolver::Resolver;

/// A primitive of the file: a solid, or several of one material.
pub(crate) struct Primitive {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) normals: Vec<[f32; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) material: String,
    pub(crate) double_sided: bool,
    pub(crate) is_translucent: bool,
}

/// A node of the file.
pub(crate) struct Node {
    pub(crate) name: String,
    pub(crate) parent: Option<String>,
    pub(crate) translation: [f32; 3],
    pub(crate) rotation: [f32; 4],
    pub(crate) primitives: Vec<Primitive>,
    /// Its camera in words.
    pub(crate) camera: Option<String>,
}

/// The drawings in a folder of the package and in those within it, in the order of their paths.
pub(crate) fn drawings_in(folder: &str) -> Vec<PathBuf> {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)];
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "svg") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// All examples, including subfolders: their paths in `examples` without extension.
pub(crate) fn examples() -> BTreeSet<String> {
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let name = |path: PathBuf| {
        let inside = path.strip_prefix(&top).expect("inside").with_extension("");
        let name = inside.to_str().expect("a plain name");
        name.replace('\\', "/")
    };
    let found: BTreeSet<String> = drawings_in("examples").into_iter().map(name).collect();
    assert!(found.len() > 10, "only {} examples were found", found.len());
    found
}

pub(crate) fn compiled(text: &str, resolver: &dyn Resolver) -> Compiled {
    compile(text, &Options::default(), resolver)
}

/// The GLB of a compiled drawing.
pub(crate) fn glb(compiled: &Compiled) -> Vec<u8> {
    let model = to_memory(&GLB, &compiled.scene, None);
    model.expect("a scene keeps its own rules").bytes
}

/// The nodes of a GLB, parents before children. Reading validates it.
pub(crate) fn nodes(glb: &[u8]) -> Result<Vec<Node>, String> {
    let gltf::Gltf { document, blob } =
        gltf::Gltf::from_slice(glb).map_err(|error| error.to_string())?;
    let blob = blob.unwrap_or_default();
    let mut out = Vec::new();
    let scene = document.default_scene().ok_or("no scene")?;
    let mut stack: Vec<(gltf::Node<'_>, Option<String>)> =
        scene.nodes().map(|node| (node, None)).collect();
    stack.reverse();
    while let Some((node, parent)) = stack.pop() {
        let name = node.name().unwrap_or_default().to_owned();
        let children: Vec<_> = node.children().collect();
        stack.extend(
            children
                .into_iter()
                .rev()
                .map(|child| (child, Some(name.clone()))),
        );
        let (translation, rotation, scale) = node.transform().decomposed();
        if scale != [1.0; 3] {
            return Err(format!("`{name}` is scaled by {scale:?}"));
        }
        let mut primitives = Vec::new();
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            primitives.push(read_primitive(&primitive, &blob)?);
        }
        out.push(Node {
            name,
            parent,
            translation,
            rotation,
            primitives,
            camera: node.camera().map(|camera| self::camera(&camera)),
        });
    }
    Ok(out)
}

fn camera(camera: &gltf::Camera<'_>) -> String {
    match camera.projection() {
        gltf::camera::Projection::Perspective(lens) => {
            let degrees = numbers(&[lens.yfov().to_degrees()]);
            format!("perspective camera, {degrees}° high")
        }
        gltf::camera::Projection::Orthographic(lens) => {
            let height = numbers(&[2.0 * lens.ymag()]);
            format!("orthographic camera, {height} m high")
        }
    }
}

fn read_primitive(primitive: &gltf::Primitive<'_>, blob: &[u8]) -> Result<Primitive, String> {
    let reader = primitive.reader(|buffer| (buffer.index() == 0).then_some(blob));
    let positions: Vec<[f32; 3]> = reader.read_positions().ok_or("no positions")?.collect();
    let normals: Vec<[f32; 3]> = reader.read_normals().ok_or("no normals")?.collect();
    let indices: Vec<u32> = reader
        .read_indices()
        .ok_or("no indices")?
        .into_u32()
        .collect();
    if normals.len() != positions.len() || !indices.len().is_multiple_of(3) {
        return Err("lists of different lengths".to_owned());
    }
    if let Some(index) = indices.iter().find(|i| **i as usize >= positions.len()) {
        return Err(format!("corner {index} does not exist"));
    }
    let finite = |list: &[[f32; 3]]| list.iter().flatten().all(|x| x.is_finite());
    if !finite(&positions) || !finite(&normals) {
        return Err("a corner is no number".to_owned());
    }
    let long = |n: &&[f32; 3]| (n.iter().map(|x| x * x).sum::<f32>() - 1.0).abs() > 1e-3;
    if let Some(normal) = normals.iter().find(long) {
        return Err(format!("the normal {normal:?} is not of length 1"));
    }
    let material = primitive.material();
    Ok(Primitive {
        positions,
        normals,
        triangles: indices.chunks(3).map(|t| [t[0], t[1], t[2]]).collect(),
        double_sided: material.double_sided(),
        is_translucent: material.alpha_mode() == gltf::material::AlphaMode::Blend,
        material: describe_material(&material),
    })
}

fn describe_material(material: &gltf::Material<'_>) -> String {
    let pbr = material.pbr_metallic_roughness();
    let mut out = material.name().unwrap_or_default().to_owned();
    let [_, _, _, alpha] = pbr.base_color_factor();
    for (name, value, usual) in [
        ("alpha", alpha, 1.0),
        ("metallic", pbr.metallic_factor(), 0.0),
        ("roughness", pbr.roughness_factor(), 0.9),
    ] {
        if (value - usual).abs() > 1e-6 {
            let _ = write!(out, " {name} {}", number(value));
        }
    }
    if material.emissive_factor() != [0.0; 3] {
        let _ = write!(out, " emissive {}", numbers(&material.emissive_factor()));
    }
    if material.double_sided() {
        out.push_str(" two-sided");
    }
    out
}

/// Whether the solids of a primitive are closed.
pub(crate) fn closed(primitive: &Primitive) -> Result<(), String> {
    closed_together(&[primitive])
}

/// Whether the solids of primitives are closed, all taken together: after vertices at one position are merged, every edge is
/// used as often in one direction as in the other. (Solids that touch may share an edge, so that may be more than once.)
fn closed_together(primitives: &[&Primitive]) -> Result<(), String> {
    let mut edges: HashMap<[[u32; 3]; 2], i64> = HashMap::new();
    let all = primitives.iter().flat_map(|primitive| {
        let triangles = primitive.triangles.iter();
        triangles.map(move |triangle| (primitive, triangle))
    });
    for (primitive, triangle) in all {
        let key = |index: u32| primitive.positions[index as usize].map(|x| (x + 0.0).to_bits());
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            let (from, to) = (key(triangle[from]), key(triangle[to]));
            *edges.entry([from, to]).or_default() += 1;
            *edges.entry([to, from]).or_default() -= 1;
        }
    }
    let open = edges.values().filter(|count| **count != 0).count();
    match open {
        0 => Ok(()),
        open => Err(format!("{} edges are open", open / 2)),
    }
}

/// The volume that a primitive encloses; positive where it is wound outward.
pub(crate) fn volume(primitive: &Primitive) -> f64 {
    let at = |index: u32| glam::Vec3::from(primitive.positions[index as usize]).as_dvec3();
    let sixth = |t: &[u32; 3]| at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0;
    primitive.triangles.iter().map(sixth).sum()
}

/// The larger of a primitive's extents and its distance from the joint.
fn extent(primitive: &Primitive) -> f64 {
    let all = primitive.positions.iter().flatten();
    all.fold(0.0, |most, x| f64::from(x.abs()).max(most))
}

/// The laws of every model.
pub(crate) fn check_laws(nodes: &[Node]) -> Result<(), String> {
    for node in nodes {
        let solid = |primitive: &&Primitive| !primitive.double_sided;
        let (closed, open): (Vec<&Primitive>, Vec<&Primitive>) = node
            .primitives
            .iter()
            .filter(solid)
            .partition(|primitive| closed(primitive).is_ok());
        // The primitives of a landscape's materials are closed together. Of shapes that are translucent together, what they hide of
        // each other is left out.
        let open: Vec<&Primitive> = match closed_together(&open) {
            Ok(()) => open,
            Err(_) => {
                let opaque = open.into_iter().filter(|one| !one.is_translucent);
                opaque.collect()
            }
        };
        closed_together(&open).map_err(|error| format!("`{}`: {error}", node.name))?;
        let volumes = closed.iter().map(|one| (volume(one), extent(one)));
        let together = open.iter().map(|one| volume(one)).sum();
        let largest = open.iter().map(|one| extent(one)).fold(0.0, f64::max);
        for (volume, extent) in volumes.chain([(together, largest)]) {
            // A tiny solid far from its joint may collapse in single precision.
            if volume < -1e-6 * extent.powi(3) {
                return Err(format!("`{}` has the volume {volume:e}", node.name));
            }
        }
    }
    Ok(())
}

/// A name that two nodes share, which is always an error in the drawing.
pub(crate) fn repeated_name(nodes: &[Node]) -> Option<&str> {
    let mut names = HashSet::new();
    let mut nodes = nodes.iter().map(|node| node.name.as_str());
    nodes.find(|name| !names.insert(*name))
}

/// The nodes as text: names, parents, transforms to four digits, cameras, primitives.
pub(crate) fn tree(nodes: &[Node]) -> String {
    let mut out = String::new();
    for node in nodes {
        let parent = node.parent.as_deref().unwrap_or("–");
        let _ = write!(out, "{} on {parent}", node.name);
        let (place, turn) = (numbers(&node.translation), numbers(&node.rotation));
        if place != "0 0 0" {
            let _ = write!(out, ", at {place}");
        }
        if turn != "0 0 0 1" {
            let _ = write!(out, ", turned {turn}");
        }
        out.push('\n');
        if let Some(camera) = &node.camera {
            let _ = writeln!(out, "  {camera}");
        }
        for primitive in &node.primitives {
            let mut low = [f32::INFINITY; 3];
            let mut high = [f32::NEG_INFINITY; 3];
            for position in &primitive.positions {
                for axis in 0..3 {
                    low[axis] = low[axis].min(position[axis]);
                    high[axis] = high[axis].max(position[axis]);
                }
            }
            let _ = writeln!(
                out,
                "  {} triangles, {}, from {} to {}",
                primitive.triangles.len(),
                primitive.material,
                numbers(&low),
                numbers(&high)
            );
        }
    }
    out
}

/// The clips of a GLB as text: channels with their number of keys, the first and the last key.
pub(crate) fn clips(glb: &[u8]) -> Result<String, String> {
    let gltf::Gltf { document, blob } =
        gltf::Gltf::from_slice(glb).map_err(|error| error.to_string())?;
    let blob = blob.unwrap_or_default();
    let mut out = String::new();
    for clip in document.animations() {
        let _ = writeln!(out, "{}", clip.name().unwrap_or_default());
        for channel in clip.channels() {
            let reader = channel.reader(|buffer| (buffer.index() == 0).then_some(&*blob));
            let times: Vec<f32> = reader.read_inputs().ok_or("no times")?.collect();
            let (what, values): (&str, Vec<Vec<f32>>) = match reader.read_outputs() {
                Some(ReadOutputs::Translations(places)) => {
                    ("moves", places.map(Vec::from).collect())
                }
                Some(ReadOutputs::Rotations(turns)) => {
                    ("turns", turns.into_f32().map(Vec::from).collect())
                }
                Some(ReadOutputs::MorphTargetWeights(weights)) => {
                    let weights: Vec<f32> = weights.into_f32().collect();
                    let each = (weights.len() / times.len().max(1)).max(1);
                    (
                        "morphs",
                        weights.chunks(each).map(<[f32]>::to_vec).collect(),
                    )
                }
                _ => return Err("a channel of another kind".to_owned()),
            };
            let (Some(first), Some(last)) = (values.first(), values.last()) else {
                return Err("a channel without keys".to_owned());
            };
            if times.len() != values.len() || !times.is_sorted_by(|a, b| a < b) {
                return Err("keys out of order".to_owned());
            }
            let _ = writeln!(
                out,
                "  {} {what}, {:?}, {} keys at {}: {} … {}",
                channel.target().node().name().unwrap_or_default(),
                channel.sampler().interpolation(),
                times.len(),
                numbers(&times[..times.len().min(4)]),
                numbers(first),
                numbers(last)
            );
        }
    }
    Ok(out)
}

fn numbers(list: &[f32]) -> String {
    let numbers: Vec<String> = list.iter().map(|x| number(*x)).collect();
    numbers.join(" ")
}

fn number(x: f32) -> String {
    let rounded = (f64::from(x) * 1e4).round() / 1e4 + 0.0;
    format!("{rounded}")
}

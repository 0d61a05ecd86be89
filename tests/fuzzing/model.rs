//! Every file in place of a model is read or refused, for pictures and as a part of a drawing; what was read can be posed,
//! rendered and written.

use okoshi::export::{EXPORTERS, GLTF, to_memory};
use okoshi::internals::import::read_static_model;
use okoshi::render::{self, Options, PosedModel, RenderError};
use okoshi::resolver::MemoryResolver;
use okoshi::scene::{Camera, CameraProjection, NewNode, Node};

use super::{drawing, files};

/// The most triangles of a model that is rendered: enough for every case, and fast.
const RENDERED: usize = 1 << 12;

/// The longest model that the search begins with, in bytes.
const LONGEST: usize = 24 << 10;

const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="90" height="90">
<rect x="5" y="5" width="40" height="60"/><text x="9" y="20">A$Shape model a.glb</text>
<rect x="50" y="5" width="20" height="30"/><text x="55" y="20">B@A$Shape -s model a.glb</text></svg>"##;

pub(super) fn check(bytes: &[u8]) -> bool {
    let nothing = MemoryResolver::default();
    let read = read_static_model(bytes, &nothing);
    let is_read = read.is_ok();
    if let Ok(model) = read {
        assert!(model.triangles() > 0);
        let finite = model.bounds.iter().all(|corner| corner.is_finite());
        assert!(finite, "{:?}", model.bounds);
        drawing::check_compiled(DRAWING, &nothing.with("a.glb", bytes));
    }
    if let Err(error @ RenderError::Crash(_)) = check_pictures(bytes) {
        panic!("{error}");
    }
    is_read
}

/// Renders a model at rest and at moments of its clips.
fn check_pictures(bytes: &[u8]) -> Result<(), RenderError> {
    let model = render::read(bytes, &MemoryResolver::default())?;
    let moments = model.clips().iter().take(3).flat_map(|clip| {
        assert!(clip.seconds.is_finite() && clip.seconds >= 0.0, "{clip:?}");
        let times = [0.0, clip.seconds / 3.0, clip.seconds, clip.seconds + 1.0];
        times.map(|time| model.pose_at(clip, time))
    });
    let options = Options::default().with_size([24, 16]);
    for pose in [model.rest()].into_iter().chain(moments) {
        let posed = PosedModel::new(&model, &pose)?;
        if posed.triangles <= RENDERED {
            let picture = posed.picture(&options)?;
            assert_eq!(picture.dimensions(), (24, 16));
            for camera in model.cameras().iter().take(2) {
                match posed.picture_by(&options, camera) {
                    Ok(picture) => assert_eq!(picture.dimensions(), (24, 16)),
                    Err(RenderError::CameraPose(_)) => (),
                    Err(error) => return Err(error),
                }
            }
        }
    }
    Ok(())
}

/// The models of the cases, in all formats, and the example that a part is made of.
pub(super) fn seeds() -> Vec<Vec<u8>> {
    let resolver = drawing::linked();
    let animated = ["limited", "motion", "skin", "terrain", "tile", "texture"];
    let folders = files::case_folders().into_iter();
    let named = |name: &str| animated.iter().any(|part| name.contains(part));
    let mut models: Vec<Vec<u8>> = folders
        .enumerate()
        .filter(|(index, path)| index % 8 == 0 || named(&path.to_string_lossy()))
        .filter_map(|(_, path)| std::fs::read_to_string(path.join("drawing.svg")).ok())
        .filter(|text| text.len() <= files::LONGEST)
        .flat_map(|text| {
            let compiled = okoshi::compile::compile(&text, &Default::default(), &resolver);
            let write = |exporter| to_memory(exporter, &compiled.scene, None).ok();
            let written = EXPORTERS.iter().copied().filter_map(write);
            written.map(|model| model.bytes).collect::<Vec<_>>()
        })
        .filter(|model| model.len() <= LONGEST)
        .collect();
    models.push(files::read("examples/shapes/biscuit.glb"));
    models.extend(filmed());
    models
}

/// A small model with a camera of each kind.
fn filmed() -> Option<Vec<u8>> {
    let compiled = okoshi::compile::compile(DRAWING, &Default::default(), &drawing::linked());
    let mut scene = compiled.scene;
    let projections = [
        CameraProjection::Perspective {
            vertical_field_of_view: 0.5,
            near: 0.01,
            far: Some(90.0),
        },
        CameraProjection::Orthographic {
            half_height: 1.0,
            near: 0.0,
            far: 90.0,
        },
    ];
    for (index, projection) in projections.into_iter().enumerate() {
        let name = format!("Camera {index}");
        let camera = scene.cameras.push_and_get_key(Camera { name, projection });
        scene.add(NewNode {
            node: Node {
                translation: glam::DVec3::Z * 3.0,
                camera: Some(camera),
                ..Node::default()
            },
            ..NewNode::default()
        });
    }
    Some(to_memory(&GLTF, &scene, None).ok()?.bytes)
}

//! The JSON of cameras.

use ::gltf::json::Camera as JsonCamera;
use ::gltf::json::camera::{Orthographic, Perspective, Type};
use ::gltf::json::validation::Checked::Valid;

use super::document::name;
use crate::scene::{Camera, CameraProjection};

/// A camera. It has no aspect ratio, so that viewers take that of their picture.
pub(super) fn camera(camera: &Camera) -> JsonCamera {
    let (type_, perspective, orthographic) = match camera.projection {
        CameraProjection::Perspective {
            vertical_field_of_view,
            near,
            far,
        } => {
            let perspective = Perspective {
                aspect_ratio: None,
                yfov: vertical_field_of_view as f32,
                zfar: far.map(|far| far as f32),
                znear: near as f32,
                extensions: None,
                extras: None,
            };
            (Type::Perspective, Some(perspective), None)
        }
        CameraProjection::Orthographic {
            half_height,
            near,
            far,
        } => {
            // Parallel projection has two magnifications instead of an aspect ratio; viewers fit them into their picture.
            let orthographic = Orthographic {
                xmag: half_height as f32,
                ymag: half_height as f32,
                zfar: far as f32,
                znear: near as f32,
                extensions: None,
                extras: None,
            };
            (Type::Orthographic, None, Some(orthographic))
        }
    };
    JsonCamera {
        name: name(&camera.name),
        orthographic,
        perspective,
        type_: Valid(type_),
        extensions: None,
        extras: None,
    }
}

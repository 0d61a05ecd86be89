//! Turns pictures into parts, except in tile layers, where their pixels are read one by one.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::image::{PictureSource, Traced};
use super::{Drawing, Paint, Shape};
use crate::diagnostic::{Code, Diagnostic};

/// Gives pictures their outlines and paints, except in groups that are marked in `left`. A picture that cannot be
/// read is reported and removed from the drawing.
pub(super) fn trace(drawing: &mut Drawing, left: &[bool], diagnostics: &mut Vec<Diagnostic>) {
    let page = drawing.page;
    let shapes = drawing.shapes.par_iter_mut();
    let traced: Vec<(bool, Option<Diagnostic>)> = shapes
        .map(|shape| match &shape.picture {
            Some(_) if left[shape.group] => (true, None),
            Some(picture) => one(&Arc::clone(picture), shape, page),
            None => (true, None),
        })
        .collect();
    let mut keep = traced.iter().map(|(keep, _)| *keep);
    drawing.shapes.retain(|_| keep.next().unwrap_or(true));
    diagnostics.extend(traced.into_iter().filter_map(|(_, finding)| finding));
}

/// Turns one picture into a part. Returns whether that is possible, and the diagnostic if there is one.
fn one(
    picture: &PictureSource,
    shape: &mut Shape,
    page: (DVec2, DVec2),
) -> (bool, Option<Diagnostic>) {
    let Traced {
        outline,
        color,
        server,
    } = match picture.trace() {
        Ok(traced) => traced,
        Err((code, message)) => {
            let finding = Diagnostic::new(code, shape.element.span, message);
            return (false, Some(finding.help(LARGE)));
        }
    };
    let finding = outline.polygons.is_empty().then(|| {
        let name = shape.describe(page);
        let message = format!("nothing opaque is left of {name}");
        Diagnostic::new(Code::Vanishes, shape.element.span, message)
            .help("delete it, or enlarge its clip")
    });
    shape.outline = Arc::new(outline);
    shape.paint = Paint {
        key: shape.paint.key.clone(),
        color,
        server: server.map(Arc::new),
    };
    shape.picture = None;
    (true, finding)
}

/// The help for a picture that cannot be read.
pub(crate) const LARGE: &str = "link a smaller picture, or save it again as PNG";

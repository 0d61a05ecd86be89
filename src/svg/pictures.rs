//! Turns pictures into parts, except in tile layers, where their pixels are read one by one.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use typed_index_collections::TiSlice;

use super::image::{PictureSource, Traced};
use super::{Drawing, GroupId, Paint, Shape};
use crate::diagnostic::{Code, Diagnostic};

/// Gives pictures their outlines and paints, except in groups that are marked in `left`. A picture that cannot be
/// read is reported and removed from the drawing.
pub(super) fn trace(
    drawing: &mut Drawing,
    left: &TiSlice<GroupId, bool>,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let page = drawing.page;
    let pictures = drawing.shapes.iter().map(|shape| {
        let picture = shape.picture.clone();
        picture.filter(|_| !left[shape.group])
    });
    let pictures: Vec<Option<Arc<PictureSource>>> = pictures.collect();
    let (files, file_of) = files(&pictures);
    let files: Vec<Result<Traced, (Code, String)>> =
        files.into_par_iter().map(PictureSource::trace).collect();
    let shapes = drawing
        .shapes
        .raw
        .par_iter_mut()
        .zip(&pictures)
        .zip(file_of);
    let traced: Vec<(bool, Option<Diagnostic>)> = shapes
        .map(|((shape, picture), file)| match picture {
            Some(picture) => one(picture, &files[file], shape, page),
            None => (true, None),
        })
        .collect();
    let mut keep = traced.iter().map(|(keep, _)| *keep);
    drawing.shapes.retain(|_| keep.next().unwrap_or(true));
    diagnostics.extend(traced.into_iter().filter_map(|(_, finding)| finding));
}

/// A picture of each file, and per picture the number of its file: one that is cloned is traced once.
fn files(pictures: &[Option<Arc<PictureSource>>]) -> (Vec<&PictureSource>, Vec<usize>) {
    let mut files = Vec::new();
    let mut known: FxHashMap<&[u8], usize> = FxHashMap::default();
    let mut file_of = vec![0; pictures.len()];
    for (index, picture) in pictures.iter().enumerate() {
        let Some(picture) = picture else { continue };
        let new = files.len();
        file_of[index] = match picture.bytes() {
            Some(bytes) => *known.entry(bytes.as_slice()).or_insert(new),
            None => new,
        };
        if file_of[index] == new {
            files.push(&**picture);
        }
    }
    (files, file_of)
}

/// Turns one picture into a part. Returns whether that is possible, and the diagnostic if there is one.
fn one(
    picture: &PictureSource,
    traced: &Result<Traced, (Code, String)>,
    shape: &mut Shape,
    page: (DVec2, DVec2),
) -> (bool, Option<Diagnostic>) {
    let traced = match traced {
        Ok(traced) => traced,
        Err((code, message)) => {
            let finding = Diagnostic::new(*code, shape.element.span, message.clone());
            return (false, Some(finding.help(LARGE)));
        }
    };
    let (outline, server) = picture.part(traced);
    let finding = outline.polygons.is_empty().then(|| {
        let name = shape.describe(page);
        let message = format!("nothing opaque is left of {name}");
        Diagnostic::new(Code::Vanishes, shape.element.span, message)
            .help("delete it, or enlarge its clip")
    });
    shape.outline = Arc::new(outline);
    shape.paint = Paint {
        key: shape.paint.key.clone(),
        color: traced.color,
        server: server.map(Arc::new),
    };
    shape.picture = None;
    (true, finding)
}

/// The help for a picture that cannot be read.
pub(crate) const LARGE: &str = "link a smaller picture, or save it again as PNG";

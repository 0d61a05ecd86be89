//! What a drawing looks like without okoshi: resvg's picture of the SVG itself, and how a model compares with it.
//!
//! Nothing here knows parts, strings or what the program made of the drawing. resvg has no fonts, so strings do not show.

use std::path::Path;

use okoshi::compile::Compiled;
use okoshi::internals::look::DrawnView;
use okoshi::render::{self, Options, PosedModel, Shading};
use okoshi::resolver::Resolver;
use resvg::tiny_skia::{Pixmap, Transform};

/// How far a channel may be off, of 255, over white.
const TOLERANCE: u8 = 24;
/// How far the channels of neighbouring pixels differ on a border, of 255.
const BORDER: u8 = 24;
/// Pixels at most this far from those beside a border are not counted.
const REACH: usize = 1;

/// How much of a model's picture shows what resvg draws.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Agreement {
    /// The number of pixels that are counted: where either picture shows something, away from the borders in resvg's.
    pub(crate) pixels: usize,
    /// How many of them have the right colour.
    pub(crate) right: usize,
}

impl Agreement {
    /// The share of right pixels, 0 to 1.
    pub(crate) fn share(self) -> f64 {
        match self.pixels {
            0 => 1.0,
            pixels => self.right as f64 / pixels as f64,
        }
    }
}

/// Compares the model of a drawing, seen from the front, with resvg's picture of `text` under a style sheet. The larger side of the
/// pictures has `side` pixels; resvg looks for linked files in `folder`.
pub(crate) fn agreement(
    compiled: &Compiled,
    text: &str,
    sheet: &str,
    folder: Option<&Path>,
    resolver: &dyn Resolver,
    side: u32,
) -> Result<Agreement, String> {
    let options = usvg::Options {
        resources_dir: folder.map(Path::to_owned),
        style_sheet: Some(sheet.to_owned()),
        ..usvg::Options::default()
    };
    let tree = usvg::Tree::from_str(text, &options).map_err(|error| error.to_string())?;
    let longest = tree.size().width().max(tree.size().height());
    let page = compiled.drawing.page.1.max_element();
    let view = DrawnView::new(compiled, compiled.scene.clone(), f64::from(side) / page)
        .map_err(|error| error.to_string())?;
    let [width, height] = view.size;
    let mut drawn = Pixmap::new(width, height).ok_or("it has no page")?;
    let scale = side as f32 / longest;
    resvg::render(
        &tree,
        Transform::from_scale(scale, scale),
        &mut drawn.as_mut(),
    );
    let drawn: Vec<[u8; 4]> = drawn
        .pixels()
        .iter()
        .map(|pixel| [pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()])
        .collect();
    let picture = picture(&view, resolver);
    let near = near_borders(&drawn, width as usize);
    let mut agreement = Agreement {
        pixels: 0,
        right: 0,
    };
    for ((drawn, shown), is_near) in drawn.iter().zip(picture.pixels()).zip(near) {
        let [r, g, b, alpha] = shown.0;
        let shown = [r, g, b].map(|value| {
            let alpha = f64::from(alpha) / 255.0;
            (f64::from(value) * alpha + 255.0 * (1.0 - alpha)).round() as u8
        });
        if is_near || (drawn[3] == 0 && alpha == 0) {
            continue;
        }
        let apart = |channel: usize| {
            let over_white = drawn[channel].saturating_add(255 - drawn[3]);
            over_white.abs_diff(shown[channel])
        };
        agreement.pixels += 1;
        agreement.right += usize::from((0..3).all(|channel| apart(channel) <= TOLERANCE));
    }
    Ok(agreement)
}

/// The picture of a model as it is drawn, without light; transparent where there is nothing.
pub(crate) fn picture(view: &DrawnView, resolver: &dyn Resolver) -> render::Image {
    if view.scene.meshes.is_empty() {
        return render::Image::new(view.size[0], view.size[1]);
    }
    let file = okoshi::export::to_memory(&okoshi::export::GLB, &view.scene, None);
    let bytes = file.expect("written").bytes;
    let model = render::read(&bytes, resolver).expect("a model");
    let posed = PosedModel::new(&model, &model.rest()).expect("triangles");
    let options = Options::default()
        .with_size(view.size)
        .with_shading(Shading::Unlit);
    posed.picture_of(&options, &view.sheet).expect("a picture")
}

/// Which pixels of a picture with rows of this width are near a place where the colour changes clearly.
fn near_borders(pixels: &[[u8; 4]], width: usize) -> Vec<bool> {
    let height = pixels.len() / width;
    let differ = |one: usize, other: usize| {
        (0..4).any(|channel| pixels[one][channel].abs_diff(pixels[other][channel]) > BORDER)
    };
    let mut near = vec![false; pixels.len()];
    let mut mark = |at: usize| {
        let (x, y) = (at % width, at / width);
        for row in y.saturating_sub(REACH)..=(y + REACH).min(height - 1) {
            let columns = x.saturating_sub(REACH)..=(x + REACH).min(width - 1);
            columns.for_each(|column| near[row * width + column] = true);
        }
    };
    for at in 0..pixels.len() {
        let right = (at % width + 1 < width).then_some(at + 1);
        let below = (at + width < pixels.len()).then_some(at + width);
        for other in [right, below].into_iter().flatten() {
            if differ(at, other) {
                mark(at);
                mark(other);
            }
        }
    }
    near
}

#[test]
fn two_pixels_on_each_side_of_a_border_are_not_counted() {
    let row = [0, 0, 0, 0, 90, 90, 90, 90].map(|value| [value; 4]);
    let near = near_borders(&[row, row].concat(), 8);
    let expected = [false, false, true, true, true, true, false, false];
    assert_eq!(near, [expected, expected].concat());
}

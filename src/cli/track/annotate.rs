//! The clip with what was found drawn on it.

use image::{DynamicImage, RgbImage};
use resvg::tiny_skia::{Color, Paint, PathBuilder, Pixmap, Stroke, StrokeDash, Transform};

use crate::mark_tracks::{MarkTrack, MarkTracks};
use crate::render::Image;

/// How long the trail behind a mark is, in seconds.
const TRAIL: f64 = 0.8;
/// The radius of a mark's circle, as a part of the picture's smaller side.
const RADIUS: f64 = 0.045;

/// A frame with each mark's circle and trail. A cross is where a lost mark may be; a circle of dashes is around the cross if something else
/// may be the mark.
pub(super) fn annotated(frame: RgbImage, tracks: &MarkTracks, number: usize) -> Image {
    let (width, height) = frame.dimensions();
    let image = DynamicImage::from(frame).into_rgba8();
    let Some(mut canvas) = Pixmap::new(width, height) else {
        return image;
    };
    // Opaque, so premultiplied colours are the colours.
    canvas.data_mut().copy_from_slice(image.as_raw());
    for mark in &tracks.marks {
        draw(&mut canvas, tracks, mark, number);
    }
    Image::from_raw(width, height, canvas.take()).unwrap_or(image)
}

fn draw(canvas: &mut Pixmap, tracks: &MarkTracks, mark: &MarkTrack, number: usize) {
    let radius = (RADIUS * f64::from(canvas.width().min(canvas.height()))).max(4.0) as f32;
    let width = (radius / 5.0).max(1.0);
    let place = |frame: usize| (mark.points[frame].x as f32, mark.points[frame].y as f32);
    // From where the mark was seen to where it was seen next.
    let mut trail = PathBuilder::new();
    let start = tracks.times[number] - TRAIL;
    for frame in (1..=number)
        .rev()
        .take_while(|frame| tracks.times[*frame] >= start)
    {
        if !mark.is_lost[frame] && !mark.is_lost[frame - 1] {
            let ((from_x, from_y), (x, y)) = (place(frame - 1), place(frame));
            trail.move_to(from_x, from_y);
            trail.line_to(x, y);
        }
    }
    let (x, y) = place(number);
    let (mut sign, mut dashes) = (PathBuilder::new(), PathBuilder::new());
    if mark.is_ambiguous[number] {
        dashes.push_circle(x, y, 1.6 * radius);
    }
    if mark.is_lost[number] {
        for side in [-1.0, 1.0] {
            sign.move_to(x - radius, y - side * radius);
            sign.line_to(x + radius, y + side * radius);
        }
    } else {
        sign.push_circle(x, y, radius);
    }
    let [r, g, b] = mark.color;
    let length = 0.4 * std::f32::consts::PI * radius;
    let dash = StrokeDash::new(vec![0.6 * length, 0.4 * length], 0.0);
    for (path, dash) in [(trail, None), (sign, None), (dashes, dash)] {
        let Some(path) = path.finish() else {
            continue;
        };
        // White around the mark's colour is seen on the mark, and on anything else.
        for (color, width) in [
            (Color::WHITE, 2.2 * width),
            (Color::from_rgba8(r, g, b, 255), width),
        ] {
            let mut paint = Paint::default();
            paint.set_color(color);
            let stroke = Stroke {
                width,
                dash: dash.clone(),
                ..Stroke::default()
            };
            canvas.stroke_path(&path, &paint, &stroke, Transform::identity(), None);
        }
    }
}

//! Numbers drawn with lines, since pictures must not depend on the fonts of a machine.

use resvg::tiny_skia::{Color, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Stroke, Transform};

/// A grid for digits: 4 columns and 6 rows.
const ROWS: f32 = 6.0;
/// From one digit to the next, columns of the grid.
const ADVANCE: f32 = 5.6;
/// The width of a digit itself, columns of the grid.
const WIDTH: f32 = 4.0;
/// The width of the lines, columns of the grid.
const LINE: f32 = 0.85;
/// How far the light border of digits reaches beyond them, columns of the grid.
const HALO: f32 = 0.7;

/// The lines of a character on the grid, y down.
fn lines(character: char) -> &'static [(f32, f32)] {
    match character {
        '0' => &[
            (1.0, 0.0),
            (3.0, 0.0),
            (4.0, 1.2),
            (4.0, 4.8),
            (3.0, 6.0),
            (1.0, 6.0),
            (0.0, 4.8),
            (0.0, 1.2),
            (1.0, 0.0),
        ],
        '1' => &[(0.8, 1.2), (2.2, 0.0), (2.2, 6.0)],
        '2' => &[
            (0.0, 1.2),
            (1.0, 0.0),
            (3.0, 0.0),
            (4.0, 1.2),
            (4.0, 2.2),
            (0.0, 6.0),
            (4.0, 6.0),
        ],
        '3' => &[
            (0.0, 0.0),
            (4.0, 0.0),
            (1.8, 2.4),
            (3.0, 2.4),
            (4.0, 3.5),
            (4.0, 4.8),
            (3.0, 6.0),
            (1.0, 6.0),
            (0.0, 5.0),
        ],
        '4' => &[(3.0, 6.0), (3.0, 0.0), (0.0, 4.2), (4.0, 4.2)],
        '5' => &[
            (4.0, 0.0),
            (0.5, 0.0),
            (0.2, 2.8),
            (1.2, 2.2),
            (3.0, 2.2),
            (4.0, 3.4),
            (4.0, 4.8),
            (3.0, 6.0),
            (1.0, 6.0),
            (0.0, 5.0),
        ],
        '6' => &[
            (3.4, 0.0),
            (1.6, 0.6),
            (0.0, 3.0),
            (0.0, 4.8),
            (1.0, 6.0),
            (3.0, 6.0),
            (4.0, 4.8),
            (4.0, 3.6),
            (3.0, 2.5),
            (1.0, 2.5),
            (0.0, 3.6),
        ],
        '7' => &[(0.0, 0.0), (4.0, 0.0), (1.4, 6.0)],
        '8' => &[
            (1.0, 2.8),
            (0.0, 1.9),
            (0.0, 1.0),
            (1.0, 0.0),
            (3.0, 0.0),
            (4.0, 1.0),
            (4.0, 1.9),
            (3.0, 2.8),
            (1.0, 2.8),
            (0.0, 3.9),
            (0.0, 5.0),
            (1.0, 6.0),
            (3.0, 6.0),
            (4.0, 5.0),
            (4.0, 3.9),
            (3.0, 2.8),
        ],
        '9' => &[
            (4.0, 2.4),
            (3.0, 3.5),
            (1.0, 3.5),
            (0.0, 2.4),
            (0.0, 1.2),
            (1.0, 0.0),
            (3.0, 0.0),
            (4.0, 1.2),
            (4.0, 3.0),
            (2.4, 5.4),
            (0.6, 6.0),
        ],
        '-' => &[(0.4, 3.2), (3.6, 3.2)],
        '.' => &[(1.6, 6.0), (2.2, 6.0)],
        '°' => &[
            (1.2, 0.0),
            (2.2, 0.0),
            (2.6, 0.8),
            (2.2, 1.6),
            (1.2, 1.6),
            (0.8, 0.8),
            (1.2, 0.0),
        ],
        _ => &[],
    }
}

/// The width of a text of digits, pixels, if they are `height` pixels high.
pub(super) fn width(text: &str, height: f32) -> f32 {
    let gaps = text.chars().count().saturating_sub(1) as f32;
    (gaps * ADVANCE + WIDTH) * height / ROWS
}

/// Writes digits, `-`, `.`, `°` and spaces around a point, `height` pixels high, with a light border.
pub(super) fn write(pixmap: &mut Pixmap, text: &str, [x, y]: [f32; 2], height: f32) {
    let mut path = PathBuilder::new();
    for (index, character) in text.chars().enumerate() {
        let left = index as f32 * ADVANCE;
        for (place, (x, y)) in lines(character).iter().enumerate() {
            match place {
                0 => path.move_to(left + x, *y),
                _ => path.line_to(left + x, *y),
            }
        }
    }
    let Some(path) = path.finish() else {
        return;
    };
    let unit = height / ROWS;
    let corner = [x - width(text, height) / 2.0, y - height / 2.0];
    let place = Transform::from_row(unit, 0.0, 0.0, unit, corner[0], corner[1]);
    let mut paint = Paint::default();
    let mut stroke = Stroke {
        line_cap: LineCap::Round,
        line_join: LineJoin::Round,
        ..Stroke::default()
    };
    for (color, line) in [
        (Color::from_rgba8(255, 255, 255, 140), LINE + 2.0 * HALO),
        (Color::from_rgba8(20, 20, 24, 255), LINE),
    ] {
        paint.set_color(color);
        stroke.width = line;
        pixmap.stroke_path(&path, &paint, &stroke, place, None);
    }
}

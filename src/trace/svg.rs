//! Regions as shapes of a drawing.

use std::fmt::Write as _;

use glam::DVec2;

use crate::geometry::Outline;
use crate::raster::RasterView;

/// The text of a drawing with the regions of a picture of this width and height in pixels, which are its units. Names that are added later become
/// labels of Inkscape, since its namespace is there.
pub(super) fn write(view: &RasterView, [width, height]: [u32; 2]) -> String {
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n"
    );
    let mut number = 0;
    let mut shape = |outline: &Outline, color: [f64; 4], line: &str| {
        number += 1;
        let (fill, opacity) = (hex(color), opacity("fill", color));
        let data = data(outline);
        let _ = writeln!(
            svg,
            "  <path id=\"shape{number}\" fill=\"{fill}\"{opacity} fill-rule=\"evenodd\"{line} d=\"{data}\"/>"
        );
    };
    for region in &view.regions {
        let line = region.line.map_or_else(String::new, |line| {
            format!(
                " stroke=\"{}\"{} stroke-width=\"{:.1}\" stroke-linejoin=\"round\"",
                hex(line.color),
                opacity("stroke", line.color),
                line.width
            )
        });
        shape(&region.outline, region.color, &line);
    }
    for line in &view.lines {
        shape(&line.outline, line.color, "");
    }
    svg.push_str("</svg>\n");
    svg
}

fn hex(color: [f64; 4]) -> String {
    let [r, g, b, _] = color.map(|channel| (channel * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn opacity(of: &str, [.., alpha]: [f64; 4]) -> String {
    if alpha > 0.995 {
        String::new()
    } else {
        format!(" {of}-opacity=\"{alpha:.2}\"")
    }
}

/// The outline as path data, to a tenth of a pixel.
fn data(outline: &Outline) -> String {
    let point = |point: &DVec2| {
        let [x, y] = [point.x, point.y].map(|at| (at * 10.0).round() / 10.0);
        format!("{x},{y}")
    };
    let ring = |ring: &Vec<DVec2>| {
        let points: Vec<String> = ring.iter().map(point).collect();
        format!("M {} Z", points.join(" "))
    };
    let rings: Vec<String> = outline.rings().map(ring).collect();
    rings.join(" ")
}

//! Outlines, strokes and solids.

use std::f64::consts::TAU;

use fastrand::Rng;

use super::kinds::{Kind, each, filled, grid, line, page, polygon, star, text};

pub(crate) const KINDS: &[Kind] = &[
    Kind {
        name: "dashes-fine",
        full: 10_000,
        small: 2,
        make: fine_dashes,
    },
    Kind {
        name: "dashes-of-one-line",
        full: 4_000_000,
        small: 50,
        make: dashes_of_one_line,
    },
    Kind {
        name: "dashes-of-many-strokes",
        full: 10_000,
        small: 1,
        make: dashes_of_many_strokes,
    },
    Kind {
        name: "circles-round-in-64-segments",
        full: 20_000,
        small: 20,
        make: |n| circles(n, "%Shape round Segments 64"),
    },
    Kind {
        name: "circles-round",
        full: 20_000,
        small: 20,
        make: |n| circles(n, "%Shape round"),
    },
    Kind {
        name: "circles-inflated",
        full: 20_000,
        small: 20,
        make: |n| circles(n, "%Shape inflate"),
    },
    Kind {
        name: "circles-overlapping-inflated",
        full: 2_500,
        small: 50,
        make: overlapping_circles,
    },
    Kind {
        name: "circles-of-one-path",
        full: 10_000,
        small: 100,
        make: circles_of_one_path,
    },
    Kind {
        name: "circles-of-one-path-overlapping",
        full: 10_000,
        small: 100,
        make: overlapping_circles_of_one_path,
    },
    Kind {
        name: "rings-nested-round",
        full: 4_000,
        small: 20,
        make: |n| nested_rings(n, "%Shape round"),
    },
    Kind {
        name: "rings-nested-inflated",
        full: 4_000,
        small: 20,
        make: |n| nested_rings(n, "%Shape inflate"),
    },
    Kind {
        name: "rings-nested-as-parts-round",
        full: 1_000,
        small: 20,
        make: |n| nested_parts(n, "%Shape round"),
    },
    Kind {
        name: "star-roundv",
        full: 20_000,
        small: 100,
        make: |n| one_star(n, "%Shape roundv"),
    },
    Kind {
        name: "star-roundh",
        full: 20_000,
        small: 100,
        make: |n| one_star(n, "%Shape roundh"),
    },
    Kind {
        name: "star-round",
        full: 20_000,
        small: 100,
        make: |n| one_star(n, "%Shape round"),
    },
    Kind {
        name: "star-lathe",
        full: 20_000,
        small: 100,
        make: |n| one_star(n, "%Shape lathe"),
    },
    Kind {
        name: "star-inflated",
        full: 20_000,
        small: 100,
        make: |n| one_star(n, "%Shape inflate"),
    },
    Kind {
        name: "star-conev",
        full: 20_000,
        small: 100,
        make: |n| one_star(n, "%Shape conev 0 20"),
    },
    Kind {
        name: "stars-roundv",
        full: 400,
        small: 5,
        make: |n| stars(n, "%Shape roundv"),
    },
    Kind {
        name: "stars-lathe",
        full: 400,
        small: 5,
        make: |n| stars(n, "%Shape lathe"),
    },
    Kind {
        name: "stars-inflated",
        full: 400,
        small: 5,
        make: |n| stars(n, "%Shape inflate"),
    },
    Kind {
        name: "stars-of-one-path-roundv",
        full: 400,
        small: 5,
        make: stars_of_one_path,
    },
    Kind {
        name: "scribble",
        full: 40_000,
        small: 500,
        make: |n| page(&filled(&scribble(n, 1))),
    },
    Kind {
        name: "scribble-of-a-line",
        full: 40_000,
        small: 500,
        make: scribbled_line,
    },
    Kind {
        name: "scribbles",
        full: 5_000,
        small: 100,
        make: scribbles,
    },
    Kind {
        name: "bars-crossed",
        full: 2_000,
        small: 50,
        make: crossed_bars,
    },
    Kind {
        name: "spiral",
        full: 40_000,
        small: 400,
        make: |n| spirals(n, 1, ""),
    },
    Kind {
        name: "spirals",
        full: 40_000,
        small: 400,
        make: |n| spirals(n, 8, ""),
    },
    Kind {
        name: "spiral-inflated",
        full: 40_000,
        small: 400,
        make: |n| spirals(n, 1, "%Shape inflate"),
    },
    Kind {
        name: "spiral-roundv",
        full: 40_000,
        small: 400,
        make: |n| spirals(n, 1, "%Shape roundv"),
    },
    Kind {
        name: "spiral-line",
        full: 40_000,
        small: 400,
        make: spiral_line,
    },
    Kind {
        name: "markers",
        full: 40_000,
        small: 100,
        make: markers,
    },
    Kind {
        name: "comb",
        full: 20_000,
        small: 100,
        make: |n| comb(n, ""),
    },
    Kind {
        name: "comb-inflated",
        full: 20_000,
        small: 50,
        make: |n| comb(n, "%Shape inflate"),
    },
    Kind {
        name: "comb-roundv",
        full: 20_000,
        small: 50,
        make: |n| comb(n, "%Shape roundv"),
    },
    Kind {
        name: "comb-roundh",
        full: 20_000,
        small: 50,
        make: |n| comb(n, "%Shape roundh"),
    },
    Kind {
        name: "holes-in-a-row",
        full: 20_000,
        small: 100,
        make: |n| holes_in_a_row(n, ""),
    },
    Kind {
        name: "holes-in-a-row-roundv",
        full: 20_000,
        small: 50,
        make: |n| holes_in_a_row(n, "%Shape roundv"),
    },
    Kind {
        name: "holes-in-a-grid",
        full: 20_000,
        small: 100,
        make: |n| holes_in_a_grid(n, ""),
    },
    Kind {
        name: "holes-in-a-grid-inflated",
        full: 20_000,
        small: 50,
        make: |n| holes_in_a_grid(n, "%Shape inflate"),
    },
    Kind {
        name: "curves",
        full: 20_000,
        small: 100,
        make: curves,
    },
    Kind {
        name: "layers-of-sheets",
        full: 20_000,
        small: 100,
        make: layers_of_sheets,
    },
    Kind {
        name: "clipped-by-a-scribble",
        full: 1_000,
        small: 20,
        make: clipped_by_a_scribble,
    },
];

/// Lines of 50 dashes finer than can be seen.
fn fine_dashes(n: usize) -> String {
    let data = each(n, |i| {
        let ([x, y], _) = grid(n, i);
        format!("M{x:.1} {y:.1}h5")
    });
    page(&format!(
        r#"<path stroke="red" fill="none" stroke-dasharray=".05" d="{data}"/>"#
    ))
}

/// One line with so many dashes.
fn dashes_of_one_line(n: usize) -> String {
    let dash = 500.0 / n as f64;
    page(&format!(
        r#"<path stroke="red" stroke-width="9" fill="none" stroke-dasharray="{dash}" d="M0 500C300 0 700 999 999 500"/>"#
    ))
}

/// So many strokes with a few hundred dashes each.
fn dashes_of_many_strokes(n: usize) -> String {
    let strokes = each(n, |i| format!(r#"<path d="M0 {}h999"/>"#, 999 * i / n));
    page(&format!(
        r#"<g stroke="red" stroke-dasharray="1 2">{strokes}</g>"#
    ))
}

fn circle(x: f64, y: f64, r: f64) -> String {
    format!(r#"<circle cx="{x:.1}" cy="{y:.1}" r="{r:.1}"/>"#)
}

/// Circles beside each other, each a part.
fn circles(n: usize, string: &str) -> String {
    let circles = each(n, |i| {
        let ([x, y], step) = grid(n, i);
        circle(x, y, 0.4 * step)
    });
    page(&(circles + &text(string)))
}

/// Circles that overlap many others, each a part.
fn overlapping_circles(n: usize) -> String {
    let mut random = Rng::with_seed(n as u64);
    let circles = each(n, |_| {
        let [x, y] = [(); 2].map(|()| random.f64() * 1000.0);
        circle(x, y, 60.0)
    });
    page(&(circles + &text("%Shape inflate")))
}

/// A circle as path data.
fn ring(x: f64, y: f64, r: f64) -> String {
    format!(
        "M{x:.2} {y:.2}a{r:.2} {r:.2} 0 0 0 0 {0:.2}a{r:.2} {r:.2} 0 0 0 0-{0:.2}",
        2.0 * r
    )
}

/// Circles beside each other in one path.
fn circles_of_one_path(n: usize) -> String {
    let data = each(n, |i| {
        let ([x, y], step) = grid(n, i);
        ring(x, y - 0.4 * step, 0.4 * step)
    });
    page(&filled(&data))
}

/// Circles in one path, each of which crosses many others.
fn overlapping_circles_of_one_path(n: usize) -> String {
    let mut random = Rng::with_seed(n as u64);
    let data = each(n, |_| {
        let [x, y] = [(); 2].map(|()| random.f64() * 900.0);
        ring(x, y, 50.0)
    });
    page(&filled(&data))
}

/// Rings around rings in one path.
fn nested_rings(n: usize, string: &str) -> String {
    let data = each(n, |i| {
        let r = 490.0 * (i + 1) as f64 / n as f64;
        ring(500.0, 500.0 - r, r)
    });
    page(&(filled(&data) + &text(string)))
}

/// Rings around rings, each a part.
fn nested_parts(n: usize, string: &str) -> String {
    let parts = each(n, |i| {
        let r = 490.0 * (n - i) as f64 / n as f64;
        let inner = r - 200.0 / n as f64;
        filled(&(ring(500.0, 500.0 - r, r) + &ring(500.0, 500.0 - inner, inner)))
    });
    page(&(parts + &text(string)))
}

/// One star with so many tips.
fn one_star(n: usize, string: &str) -> String {
    page(&(filled(&polygon(star(n, [500.0; 2], 480.0))) + &text(string)))
}

/// So many stars of 50 tips.
fn stars(n: usize, string: &str) -> String {
    let stars = each(n, |i| {
        let (middle, step) = grid(n, i);
        filled(&polygon(star(50, middle, 0.45 * step)))
    });
    page(&(stars + &text(string)))
}

/// So many stars of 50 tips that are one part.
fn stars_of_one_path(n: usize) -> String {
    let data = each(n, |i| {
        let (middle, step) = grid(n, i);
        polygon(star(50, middle, 0.45 * step))
    });
    page(&(filled(&data) + &text("%Shape roundv")))
}

/// A closed line to and fro over the whole page.
fn scribble(n: usize, seed: u64) -> String {
    let mut random = Rng::with_seed(seed);
    polygon((0..n).map(|_| [(); 2].map(|()| random.f64() * 1000.0)))
}

/// A stroke to and fro over the whole page.
fn scribbled_line(n: usize) -> String {
    let mut random = Rng::with_seed(1);
    let data = line((0..n).map(|_| [(); 2].map(|()| random.f64() * 1000.0)));
    page(&format!(r#"<path stroke="red" fill="none" d="{data}"/>"#))
}

/// Eight scribbles of so many points.
fn scribbles(n: usize) -> String {
    page(&each(8, |i| filled(&scribble(n, i as u64))))
}

/// So many upright bars, and as many level ones across all of them, in one path.
fn crossed_bars(n: usize) -> String {
    let step = 1000.0 / n as f64;
    let data = each(n, |i| {
        let (at, width) = (i as f64 * step, 0.5 * step);
        format!("M{at:.2} 0h{width:.2}v1000h-{width:.2}zM0 {at:.2}h1000v{width:.2}h-1000z")
    });
    page(&format!(r#"<path d="{data}"/>"#))
}

/// The middle line of a spiral within a circle, `part` of the way between its turns away from it.
fn spiral(n: usize, [x, y]: [f64; 2], radius: f64, part: f64) -> Vec<[f64; 2]> {
    let turns = (n as f64 / 40.0).max(1.0);
    let at = |i: usize| {
        let along = (i + 1) as f64 / n as f64;
        let angle = TAU * turns * along;
        let r = radius * (along + part / turns).max(0.0) / (1.0 + 1.0 / turns);
        [x + r * angle.cos(), y + r * angle.sin()]
    };
    (0..n).map(at).collect()
}

/// So many points in bands that are wound up.
fn spirals(n: usize, count: usize, string: &str) -> String {
    let bands = each(count, |i| {
        let (middle, step) = grid(count, i);
        let [outer, inner] = [0.3, 0.0].map(|part| spiral(n / count / 2, middle, 0.5 * step, part));
        let data = line(outer.into_iter().chain(inner.into_iter().rev()));
        filled(&(data + "Z"))
    });
    page(&(bands + &text(string)))
}

/// A stroke that is wound up.
fn spiral_line(n: usize) -> String {
    let data = line(spiral(n, [500.0; 2], 490.0, 0.0));
    page(&format!(r#"<path stroke="red" fill="none" d="{data}"/>"#))
}

/// A line with a marker at each of its points.
fn markers(n: usize) -> String {
    let marker =
        r#"<marker id="m" markerWidth="9" markerHeight="9"><circle cx="4" cy="4" r="4"/></marker>"#;
    let mut random = Rng::with_seed(1);
    let data = line((0..n).map(|_| [(); 2].map(|()| random.f64() * 1000.0)));
    page(&format!(
        r#"{marker}<path stroke="red" fill="none" marker-mid="url(#m)" d="{data}"/>"#
    ))
}

/// A comb with so many teeth.
fn comb(n: usize, string: &str) -> String {
    let step = 1000.0 / n as f64;
    let teeth = (0..n).flat_map(|i| {
        let x = i as f64 * step;
        [
            [x, 100.0],
            [x, 900.0],
            [x + 0.5 * step, 900.0],
            [x + 0.5 * step, 100.0],
        ]
    });
    let mut data = String::from("M");
    for (x, y) in teeth.map(|[x, y]| (x, y)) {
        data += &format!("{x:.3} {y:.0} ");
    }
    data += "1000 100 1000 0 0 0Z";
    page(&(filled(&data) + &text(string)))
}

/// A plate with so many holes beside each other.
fn holes_in_a_row(n: usize, string: &str) -> String {
    let step = 1000.0 / n as f64;
    let holes = each(n, |i| {
        let x = (i as f64 + 0.25) * step;
        format!("M{x:.3} 400v200h{:.3}v-200z", 0.5 * step)
    });
    page(&(filled(&format!("M0 0H1000V1000H0Z{holes}")) + &text(string)))
}

/// A plate with so many holes all over it.
fn holes_in_a_grid(n: usize, string: &str) -> String {
    let holes = each(n, |i| {
        let ([x, y], step) = grid(n, i);
        let (half, side) = (0.3 * step, 0.6 * step);
        format!(
            "M{:.2} {:.2}v{side:.2}h{side:.2}v-{side:.2}z",
            x - half,
            y - half
        )
    });
    page(&(filled(&format!("M0 0H1000V1000H0Z{holes}")) + &text(string)))
}

/// A path of so many curves, each with the most points that a curve can have.
fn curves(n: usize) -> String {
    let step = 1000.0 / n as f64;
    let data = each(n, |i| {
        let x = i as f64 * step;
        format!("C{x:.1} 0 {:.1} 1000 {:.1} 500", x + step, x + step)
    });
    page(&filled(&format!("M0 500{data}V1000H0Z")))
}

/// So many sheets on top of each other, each a part.
fn layers_of_sheets(n: usize) -> String {
    page(&each(n, |i| {
        format!(r#"<rect width="{}" height="900"/>"#, 500 + 400 * i / n)
    }))
}

/// So many circles that are clipped by a scribble of a thousand points.
fn clipped_by_a_scribble(n: usize) -> String {
    let clip = format!(
        r#"<clipPath id="c"><path d="{}"/></clipPath>"#,
        scribble(1000, 1)
    );
    let circles = each(n, |i| {
        let ([x, y], step) = grid(n, i);
        circle(x, y, 0.4 * step)
    });
    page(&format!(r#"{clip}<g clip-path="url(#c)">{circles}</g>"#))
}

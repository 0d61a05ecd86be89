//! What is written on a drawing and about it: names, legends, styles, masks and motion.

use super::kinds::{Kind, each, grid, page, text};

pub(crate) const KINDS: &[Kind] = &[
    Kind {
        name: "names-on-a-pile",
        full: 6000,
        small: 200,
        make: |count| {
            let one = |number| {
                format!(
                    r#"<circle cx="500" cy="500" r="400"/><text x="500" y="{}">n{number}</text>"#,
                    300 + number % 400
                )
            };
            page(&each(count, one))
        },
    },
    Kind {
        name: "names-at-random",
        full: 6000,
        small: 500,
        make: |count| {
            let mut random = fastrand::Rng::with_seed(1);
            let mut place = || random.u32(0..900);
            let one = |number| {
                let [x, y, a, b] = [place(), place(), place(), place()];
                format!(
                    r#"<rect x="{x}" y="{y}" width="99" height="99"/><text x="{a}" y="{b}">n{number}</text>"#
                )
            };
            page(&each(count, one))
        },
    },
    Kind {
        name: "names-in-a-grid",
        full: 6000,
        small: 500,
        make: |count| {
            let one = |number| {
                let ([x, y], step) = grid(count, number);
                let r = step * 0.4;
                format!(
                    r#"<circle cx="{x:.1}" cy="{y:.1}" r="{r:.1}"/><text x="{x:.1}" y="{y:.1}">n{number}@n{}</text>"#,
                    number / 2
                )
            };
            page(&each(count, one))
        },
    },
    Kind {
        name: "legends",
        full: 5000,
        small: 200,
        make: |count| {
            let one = |number| {
                let ([x, y], step) = grid(2 * count, 2 * number);
                let (side, color) = (step * 0.5, number * 0xffffff / count);
                format!(
                    r##"<rect x="{x:.1}" y="{y:.1}" width="{side:.1}" height="{side:.1}" fill="#{color:06x}"/><text x="{:.1}" y="{y:.1}">$Shape round</text>"##,
                    x + side
                )
            };
            page(&each(count, one))
        },
    },
    Kind {
        name: "classes",
        full: 8000,
        small: 500,
        make: |count| {
            let rules = each(count, |number| format!(".c{number}{{fill:red}}"));
            let shapes = each(count, |number| {
                format!(r#"<path class="c{number}" d="M0 {number}h9v.5z"/>"#)
            });
            page(&format!("<style>{rules}</style>{shapes}"))
        },
    },
    Kind {
        name: "selectors-of-descendants",
        full: 4000,
        small: 250,
        make: |count| {
            let rules = each(count, |number| format!("g g g .c{number}{{fill:red}}"));
            let shapes = each(count, |number| {
                format!(r#"<path class="c{number}" d="M0 {number}h9v.5z"/>"#)
            });
            page(&format!(
                "<style>{rules}</style><g><g><g>{shapes}</g></g></g>"
            ))
        },
    },
    Kind {
        name: "masks",
        full: 10_000,
        small: 500,
        make: |count| {
            let dots = each(count, |number| {
                let ([x, y], _) = grid(count, number);
                format!(r#"<circle cx="{x:.0}" cy="{y:.0}" r="3"/>"#)
            });
            let uses = each(count / 10, |number| {
                format!(r#"<path mask="url(#m)" d="M0 {number}h999v9z"/>"#)
            });
            page(&format!(r#"<mask id="m">{dots}</mask>{uses}"#))
        },
    },
    Kind {
        name: "swings",
        full: 4000,
        small: 250,
        make: |count| page(&(text("%Motion walk") + &chain(count, "$Swing 1"))),
    },
    Kind {
        name: "swings-for-minutes",
        full: 480,
        small: 5,
        make: |seconds| page(&(text(&format!("%Motion walk {seconds}")) + &chain(60, "$Swing 1"))),
    },
    Kind {
        name: "parts-that-follow-a-joint-for-minutes",
        full: 480,
        small: 5,
        make: |seconds| {
            page(&(text(&format!("%Motion walk {seconds}")) + &chain(500, "$Bone LeftUpLeg")))
        },
    },
];

/// Parts in a grid, each of which hangs on the one before, with the same attributes.
fn chain(count: usize, attributes: &str) -> String {
    each(count, |number| {
        let ([x, y], step) = grid(count, number);
        let parent = match number.checked_sub(1) {
            Some(before) => format!("@n{before}"),
            None => String::new(),
        };
        format!(
            r#"<rect x="{:.1}" y="{:.1}" width="{step:.1}" height="{step:.1}"/><text x="{x:.1}" y="{y:.1}">n{number}{parent}{attributes}</text>"#,
            x - step / 2.0,
            y - step / 2.0
        )
    })
}

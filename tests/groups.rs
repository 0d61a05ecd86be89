//! A limb that is drawn as a group of shapes turns about the place where it meets what it hangs on, in whatever order its shapes are drawn.

mod common;

use std::fmt::Write as _;

use common::law;
use glam::{DAffine2, DVec2};
use okoshi::compile::{Options, compile};
use okoshi::resolver::MemoryResolver;
use proptest::prelude::*;

/// A limb that points away from the middle of a round trunk.
#[derive(Debug, Clone)]
struct Limb {
    /// Its name with `@Body`.
    string: &'static str,
    /// Its direction, degrees.
    direction: f64,
    /// Its length and its width, as shares of the trunk's radius.
    size: [f64; 2],
    /// How far it reaches into the trunk, as a share of its length; negative for a gap.
    overlap: f64,
    /// Where along it each piece ends, as shares of its length.
    ends: Vec<f64>,
    /// The order in which its pieces are drawn.
    order: Vec<usize>,
    /// Whether it is drawn before the trunk.
    is_behind: bool,
}

fn limb() -> impl Strategy<Value = Limb> {
    let strings = prop::sample::select(vec![
        "Rarm@Body",
        "Lleg@Body",
        "Tail@Body",
        "Wing@Body",
        "腕@Body",
        "\"left arm\"@Body$Shape inflate",
    ]);
    let pieces = prop::collection::vec(0.2..1.0_f64, 2..5);
    let shape = (
        0.0..360.0_f64,
        1.0..3.0_f64,
        0.15..0.35_f64,
        -0.05..0.15_f64,
    );
    (strings, shape, pieces, any::<bool>()).prop_flat_map(|(string, shape, pieces, is_behind)| {
        let order = Just((0..pieces.len()).collect::<Vec<usize>>()).prop_shuffle();
        order.prop_map(move |order| {
            let (direction, length, width, overlap) = shape;
            let whole: f64 = pieces.iter().sum();
            let ends = pieces.iter().scan(0.0, |end, piece| {
                *end += piece / whole;
                Some(*end)
            });
            Limb {
                string,
                direction,
                size: [length, width],
                overlap,
                ends: ends.collect(),
                order,
                is_behind,
            }
        })
    })
}

/// The middle of the trunk, and its radius.
const TRUNK: (DVec2, f64) = (DVec2::new(200.0, 200.0), 50.0);

impl Limb {
    /// From the limb, along +x from 0, to the page.
    fn to_page(&self) -> DAffine2 {
        let (middle, radius) = TRUNK;
        let turn = DAffine2::from_angle(self.direction.to_radians());
        let start = radius - self.overlap * self.length();
        DAffine2::from_translation(middle) * turn * DAffine2::from_translation(DVec2::X * start)
    }

    fn length(&self) -> f64 {
        self.size[0] * TRUNK.1
    }

    /// Where its middle line crosses the border of the trunk.
    fn shoulder(&self) -> DVec2 {
        self.to_page()
            .transform_point2(DVec2::X * self.overlap * self.length())
    }

    fn drawing(&self) -> String {
        let [length, width] = self.size.map(|share| share * TRUNK.1);
        let mut pieces = String::new();
        for piece in &self.order {
            let from = if *piece == 0 {
                0.0
            } else {
                self.ends[piece - 1]
            };
            // Pieces overlap a little, as sleeves and hands do.
            let from = if *piece == 0 { from } else { from - 0.03 };
            let [x, to] = [from, self.ends[*piece]].map(|share| share * length);
            let _ = write!(
                pieces,
                "<rect x=\"{x}\" y=\"{}\" width=\"{}\" height=\"{width}\" fill=\"#{piece}84\"/>",
                -width / 2.0,
                to - x,
            );
        }
        let matrix = self.to_page().to_cols_array();
        let matrix = matrix.map(|number| number.to_string()).join(" ");
        let limb = format!(
            "<g transform=\"matrix({matrix})\">{pieces}<text font-size=\"5\" x=\"{length}\">{}</text></g>",
            self.string
        );
        let (middle, radius) = TRUNK;
        let trunk = format!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"{radius}\" fill=\"#468\"/><text font-size=\"5\" x=\"{}\" y=\"{}\">Body</text>",
            middle.x, middle.y, middle.x, middle.y
        );
        let both = if self.is_behind {
            limb + &trunk
        } else {
            trunk + &limb
        };
        format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 400 400\">{both}</svg>")
    }
}

#[test]
fn grouped_limbs_turn_where_they_meet_their_parent() {
    law::check(law::config(300), 100, limb(), |limb| {
        let drawing = limb.drawing();
        let compiled = compile(&drawing, &Options::default(), &MemoryResolver::default());
        let parts = compiled.bindings.parts.iter();
        let found: Vec<_> = parts.filter(|part| part.parent.is_some()).collect();
        prop_assert_eq!(found.len(), 1, "{}", drawing);
        let gap = found[0].origin.distance(limb.shoulder());
        prop_assert!(
            gap <= 0.1 * limb.length(),
            "{gap} of {}: {drawing}",
            limb.length()
        );
        Ok(true)
    });
}

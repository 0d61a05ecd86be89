//! The kinds of `Shape`.

use super::signature::{Bounds, Form, Parameter, Restriction, Takes, Usual, number, parameter};

/// What the table says about a kind of `Shape`.
#[derive(Debug)]
pub struct Kind {
    /// The word after `Shape`.
    pub name: &'static str,
    /// Its parameters.
    pub form: Form,
    /// The values of parameters that are not given.
    pub default: &'static str,
    /// The same as numbers, except for those that depend on the part.
    pub numbers: &'static [f64],
    /// What is checked besides the parameters' bounds.
    pub rules: &'static [Rule],
    /// One line.
    pub summary: &'static str,
    /// The manual, in Markdown.
    pub long: &'static str,
    /// A whole string that uses it.
    pub example: &'static str,
}

impl Kind {
    /// Whether its parameters are depths in the drawing, rather than a height, a radius or angles.
    pub fn takes_depths(&self) -> bool {
        let first = self.form.parameters.first();
        first.is_some_and(|parameter| matches!(parameter.name, "z" | "z0"))
    }
}

/// A rule about the numbers of a kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// The first number is less than the second: two angles.
    Ascending,
    /// The first number differs from the second, or the solid has no thickness: two depths.
    Distinct,
    /// The number at this index is not 0, or the solid has no thickness.
    NonZero(usize),
}

const A0: Parameter = number(
    "a0",
    Bounds::QUARTER,
    "where the rounding begins, in degrees: -90 is the back, 0 the drawing plane",
);
const A1: Parameter = number(
    "a1",
    Bounds::QUARTER,
    "where the rounding ends, in degrees: 0 is the drawing plane, 90 the front",
);
const R: Parameter = number(
    "r",
    Bounds::NOT_NEGATIVE,
    "how far it comes out of the drawing plane, in drawing units",
);
const Z0: Parameter = number(
    "z0",
    Bounds::ANY,
    "depth of one end, in drawing units towards the viewer",
);
const Z1: Parameter = number(
    "z1",
    Bounds::ANY,
    "depth of the other end, in drawing units towards the viewer",
);
const TOP: Parameter = number(
    "top",
    Bounds::NOT_NEGATIVE.usually(Usual::Between(0., 1.)),
    "size at `z1` divided by the size at `z0`",
);

static ANGLES: [Parameter; 2] = [A0, A1];
static ROUND: [Parameter; 3] = [A0, A1, R];
static DEPTHS: [Parameter; 2] = [Z0, Z1];
static CONE: [Parameter; 3] = [Z0, Z1, TOP];

/// All kinds, in the order of the reference.
pub static KINDS: [Kind; 12] = [
    Kind {
        name: "default",
        form: Form::new(&DEPTHS, &[0, 2]),
        default: "2.5 % of the page's diagonal to the front and to the back",
        numbers: &[],
        rules: &[Rule::Distinct],
        summary: "a plate: the outline from depth `z0` to depth `z1`",
        long: "The drawn outline becomes a plate with straight walls, like something sawn out of \
               wood. `z0` and `z1` say how far it extends to the back (negative) and to the front \
               (positive), in drawing units.",
        example: "Ubody$Shape default -10 10",
    },
    Kind {
        name: "roundv",
        form: Form::new(&ANGLES, &[0, 2]),
        default: "-90 90",
        numbers: &[-90., 90.],
        rules: &[Rule::Ascending],
        summary: "rounded about the part's axis: an arm, a leg, a trunk",
        long: "The part is rounded about its long axis, so that a drawn bar becomes a cylinder and \
               a drawn carrot becomes a carrot. The angles say how much of the rounding is kept: \
               `-90 90` is all of it, `0 90` the front half, `-90 0` the back half.",
        example: "Rarm@Ubody$Shape roundv -90 90",
    },
    Kind {
        name: "roundh",
        form: Form::new(&ANGLES, &[0, 2]),
        default: "-90 90",
        numbers: &[-90., 90.],
        rules: &[Rule::Ascending],
        summary: "rounded across the part's axis: a wheel seen from its edge, a drum on its side",
        long: "Like `roundv`, but rounded the other way: the cylinder lies across the part's long \
               axis. The angles say how much of the rounding is kept.",
        example: "Drum$Shape roundh",
    },
    Kind {
        name: "round",
        form: Form::new(&ROUND, &[0, 2, 3]),
        default: "-90 90, and as deep as the part's smaller half extent",
        numbers: &[-90., 90.],
        rules: &[Rule::Ascending, Rule::NonZero(2)],
        summary: "rounded on all sides: a ball, an egg, a head",
        long: "The part is rounded both ways: a circle becomes a ball, an ellipse an egg. The \
               angles say how much of the rounding is kept (`0 90` is a dome), `r` how far it comes \
               out of the drawing plane, in drawing units.",
        example: "Head@Ubody$Shape round -90 90 25",
    },
    Kind {
        name: "cone",
        form: Form::new(&CONE, &[0, 2, 3]),
        default: "0 20 0",
        numbers: &[0., 20., 0.],
        rules: &[Rule::Distinct],
        summary: "narrows from `z0` to `z1`: a cone, a pyramid, a nose",
        long: "The outline has its full size at depth `z0` and shrinks to `top` times that size at \
               depth `z1`. A `top` of 0 gives a point, 0.5 half the size, 1 a plate. A circle \
               becomes a cone, a square a pyramid.",
        example: "Nose@Head$Shape cone 0 12 0.2",
    },
    Kind {
        name: "conev",
        form: Form::new(&CONE, &[0, 2, 3]),
        default: "0 20 0",
        numbers: &[0., 20., 0.],
        rules: &[Rule::Distinct],
        summary: "narrows across the axis only: a roof along the axis, a wedge",
        long: "Like `cone`, but only the width across the part's axis shrinks. A bar becomes a roof \
               whose ridge runs along the bar.",
        example: "Roof$Shape conev 0 30",
    },
    Kind {
        name: "coneh",
        form: Form::new(&CONE, &[0, 2, 3]),
        default: "0 20 0",
        numbers: &[0., 20., 0.],
        rules: &[Rule::Distinct],
        summary: "narrows along the axis only: a roof across the axis, a wedge",
        long: "Like `cone`, but only the length along the part's axis shrinks. A bar becomes a roof \
               whose ridge runs across the bar.",
        example: "Roof$Shape coneh 0 30",
    },
    Kind {
        name: "inflate",
        form: Form::new(
            &[number(
                "h",
                Bounds::NOT_NEGATIVE,
                "height of the highest point, in drawing units",
            )],
            &[0, 1],
        ),
        default: "as high as it comes out round, at most half the part's smaller extent",
        numbers: &[],
        rules: &[Rule::NonZero(0)],
        summary: "blown up like a balloon: any outline, rounded inside",
        long: "The outline is blown up to both sides, as if two pieces of cloth were sewn together \
               along it and filled. `h` is the height of the highest point, in drawing units. The \
               rest scales with it: thin limbs come out thinner than the trunk, and the material \
               around a hole becomes a tube. A disc becomes a ball; a shape that is thin \
               everywhere, such as a ring or a letter, becomes about as thick as its stroke is \
               wide. Good for hands, leaves, clouds and animals: outlines for which the round \
               kinds are too regular.",
        example: "Cloud$Shape inflate 12",
    },
    Kind {
        name: "lathe",
        form: Form::new(
            &[number(
                "degrees",
                Bounds::new(0., 360., Restriction::MinExclusive),
                "how far it is turned about the axis",
            )],
            &[0, 1],
        ),
        default: "360",
        numbers: &[360.],
        rules: &[],
        summary: "turned like a vase: half the outline, turned about the part's axis",
        long: "Half the outline is turned about the part's axis, which runs through the part's middle, \
               as on a potter's wheel. Both halves count: a bulge on one side only goes all the way \
               round, so that the front looks like the drawing. A region that does not reach the \
               axis becomes a ring, and a hole in both halves becomes a hollow. `degrees` is how \
               far the outline is turned, half of it to each side of the viewer: 360 makes a \
               complete turn, 180 the front half, closed by a flat back.",
        example: "Vase$Shape lathe 360",
    },
    Kind {
        name: "model",
        form: Form::one(&parameter(
            "file.glb",
            Takes::File,
            "a model in the drawing's folder",
        )),
        default: "",
        numbers: &[],
        rules: &[],
        summary: "a ready-made model from a file, fitted to the part's bounding box",
        long: "A ready-made glTF model (`.glb` or `.gltf`) takes the place of the outline's solid, \
               with its own materials and textures. It is scaled to fit the part's bounding box. \
               Its up direction follows the part's axis (`Axis 90` keeps it upright), and its front \
               faces the viewer. The file must be in the drawing's folder or below it.",
        example: "Sword@Rarm$Shape model \"sword.glb\"",
    },
    Kind {
        name: "flat",
        form: Form::new(
            &[number(
                "z",
                Bounds::ANY,
                "depth towards the viewer, in drawing units",
            )],
            &[0, 1],
        ),
        default: "0",
        numbers: &[0.],
        rules: &[],
        summary: "the outline alone, like paper",
        long: "The part stays a thin sheet that is visible from both sides. `z` is its depth.",
        example: "Eye@Head$Shape flat 26",
    },
    Kind {
        name: "none",
        form: Form::new(&[], &[0]),
        default: "",
        numbers: &[],
        rules: &[],
        summary: "no solid: a joint only",
        long: "The part has no solid, but it is a joint that other parts can be attached to.",
        example: "Hips$Shape none",
    },
];

/// The kind that is written `name`, whatever its case.
pub(crate) fn from_name(name: &str) -> Option<&'static Kind> {
    KINDS.iter().find(|row| row.name.eq_ignore_ascii_case(name))
}

impl Kind {
    /// The printed form: `round [a0 a1 [r]]`.
    pub fn usage(&self) -> String {
        format!("{} {}", self.name, self.form.print())
            .trim_end()
            .to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usages_show_optional_parameters() {
        let usages: Vec<_> = KINDS.iter().map(Kind::usage).collect();
        assert_eq!(
            usages,
            [
                "default [z0 z1]",
                "roundv [a0 a1]",
                "roundh [a0 a1]",
                "round [a0 a1 [r]]",
                "cone [z0 z1 [top]]",
                "conev [z0 z1 [top]]",
                "coneh [z0 z1 [top]]",
                "inflate [h]",
                "lathe [degrees]",
                "model \"file.glb\"",
                "flat [z]",
                "none",
            ]
        );
        assert!(from_name("RoundV").is_some_and(|kind| kind.name == "roundv"));
    }

    #[test]
    fn default_numbers_agree_with_the_default_text() {
        for kind in &KINDS {
            let numbers: Vec<_> = kind.numbers.iter().map(f64::to_string).collect();
            let numbers = numbers.join(" ");
            assert!(kind.default.starts_with(&numbers), "{}", kind.name);
        }
    }
}

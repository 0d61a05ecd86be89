//! The words that are not keywords: arguments that are one of a few words, functions, kinds of string.

use super::{colors, kinds};
use crate::lang::ast::Function;

/// A word that an attribute takes as an argument.
#[derive(Debug)]
pub struct Word {
    /// The word.
    pub name: &'static str,
    /// One line.
    pub summary: &'static str,
}

const fn word(name: &'static str, summary: &'static str) -> Word {
    Word { name, summary }
}

/// The words of `Origin`.
pub(crate) static ORIGIN: [Word; 3] = [
    word("center", "the part's centre"),
    word("start", "the end point nearer to the parent's centre"),
    word("end", "the end point farther from the parent's centre"),
];

/// The words of `Ground`.
pub(crate) static GROUND: [Word; 2] = [
    word("bottom", "the middle of the figures' lower edge"),
    word("page", "the page's top left corner"),
];

/// The words of `Bind`.
pub(crate) static BIND: [Word; 3] = [
    word(
        "meant",
        "a string belongs to the part that it lies on, else to one near it",
    ),
    word(
        "center",
        "a string belongs to the part with the nearest centre",
    ),
    word(
        "outline",
        "a string belongs to the part with the nearest outline",
    ),
];

/// The words of `Strokes`.
pub(crate) static STROKES: [Word; 3] = [
    word("none", "strokes are guides, not parts"),
    word(
        "lines",
        "lines without a fill are ink on the parts that they lie on; beside all parts they are parts",
    ),
    word(
        "all",
        "the same, and the outlines of filled shapes are ink on them",
    ),
];

/// The words of `Tile`.
pub(crate) static TILE: [Word; 6] = [
    word("green", "top of the ground"),
    word("brown", "front of a cliff"),
    word("blue", "water"),
    word("red", "roof"),
    word("beige", "wall of a house"),
    word("none", "not a tile"),
];

/// The words of `Carry`.
pub(crate) static CARRY: [Word; 2] = [
    word("direction", "the limb points where the actor's does"),
    word(
        "change",
        "the limb turns by as much as the actor's does, from the pose in which it is drawn",
    ),
];

/// The words of `Side`.
pub(crate) static SIDE: [Word; 2] = [
    word("near", "where it is drawn alone"),
    word("both", "on the back as well, mirrored"),
];

/// The words of `Mirror`.
pub(crate) static MIRROR: [Word; 2] = [
    word("on", "the side that nobody drew is a mirror image"),
    word("off", "it stays as it is in the nearest view"),
];

/// The words of `Match`.
pub(crate) static MATCH: [Word; 2] = [
    word("whole", "all pairs together fit best, one to one"),
    word("thesis", "each region with the most similar one"),
];

/// The words of `Facing`.
pub(crate) static FACING: [Word; 5] = [
    word("left", "to the drawing's left"),
    word("right", "to the drawing's right"),
    word("front", "towards the viewer"),
    word("back", "away from the viewer, who sees its back"),
    word(
        "up",
        "up: it is seen from above, and lies on the ground when it moves",
    ),
];

/// The signed axes of `Axes`.
pub(crate) static AXES: [Word; 6] = [
    word("+x", "along the world's x"),
    word("-x", "against the world's x"),
    word("+y", "along the world's y"),
    word("-y", "against the world's y"),
    word("+z", "along the world's z"),
    word("-z", "against the world's z"),
];

/// The words of `Motion` that a number follows.
pub(crate) static FROM: [Word; 1] = [word("from", "where in the file it begins, in seconds")];
/// See [`FROM`].
pub(crate) static TO: [Word; 1] = [word("to", "where in the file it ends, in seconds")];
/// See [`FROM`].
pub(crate) static SPEED: [Word; 1] = [word("speed", "how fast it plays: 2 is twice as fast")];

/// The clips of `Motion` that come along.
pub(crate) static CLIPS: [Word; 15] = [
    word(
        "walk",
        "a walk; on four legs each hind foot is followed by the fore foot of its side",
    ),
    word("run", "a run; a gallop on four legs"),
    word("trot", "a trot of diagonal pairs; a jog on two legs"),
    word("sneak", "a slow walk on bent legs"),
    word("jump", "one jump on the spot"),
    word("idle", "standing and breathing"),
    word("wave", "a wave with the right hand, or with a fore leg"),
    word("dance", "a dance on the spot"),
    word(
        "punch",
        "a jab with the left hand and a punch with the right one",
    ),
    word("drive", "rolling on wheels"),
    word("fly", "flying with wings"),
    word("swim", "swimming with fins and a tail"),
    word("hop", "hops of one body"),
    word("float", "floating with tentacles"),
    word("sway", "swaying in the wind"),
];

/// A function of expressions, as the reference describes it.
#[derive(Debug)]
pub struct FunctionRow {
    /// The function.
    pub function: Function,
    /// The function's name.
    pub name: &'static str,
    /// The smallest and the largest number of arguments.
    pub arguments: (usize, usize),
    /// The printed form.
    pub usage: &'static str,
    /// One line.
    pub summary: &'static str,
    /// A whole string that uses it.
    pub example: &'static str,
}

/// The functions of expressions.
pub(crate) static FUNCTIONS: [FunctionRow; 6] = [
    FunctionRow {
        function: Function::Min,
        name: "min",
        arguments: (1, 64),
        usage: "min(a, b, …)",
        summary: "the smallest of the numbers",
        example: "Hat$Shape default 0 (min(4, 6))",
    },
    FunctionRow {
        function: Function::Max,
        name: "max",
        arguments: (1, 64),
        usage: "max(a, b, …)",
        summary: "the largest of the numbers",
        example: "Hat$Shape default 0 (max(4, 6))",
    },
    FunctionRow {
        function: Function::Abs,
        name: "abs",
        arguments: (1, 1),
        usage: "abs(a)",
        summary: "the number without its sign",
        example: "Hat$Offset (abs(-3))",
    },
    FunctionRow {
        function: Function::Sqrt,
        name: "sqrt",
        arguments: (1, 1),
        usage: "sqrt(a)",
        summary: "the square root; `a` must not be negative",
        example: "Hat$Offset (sqrt(2) * 10)",
    },
    FunctionRow {
        function: Function::Sin,
        name: "sin",
        arguments: (1, 1),
        usage: "sin(degrees)",
        summary: "the sine of an angle in degrees",
        example: "Hat$Offset (10 * sin(30))",
    },
    FunctionRow {
        function: Function::Cos,
        name: "cos",
        arguments: (1, 1),
        usage: "cos(degrees)",
        summary: "the cosine of an angle in degrees",
        example: "Hat$Offset (10 * cos(60))",
    },
];

impl Function {
    /// The function called `name`, ignoring case.
    pub fn from_name(name: &str) -> Option<Self> {
        FUNCTIONS
            .iter()
            .find(|row| row.name.eq_ignore_ascii_case(name))
            .map(|row| row.function)
    }

    /// The function's row of the table.
    pub fn row(self) -> &'static FunctionRow {
        &FUNCTIONS[self as usize]
    }
}

/// A kind of string, as the reference describes it.
#[derive(Debug)]
pub(crate) struct StringRow {
    /// The sign that it starts with; empty for part strings.
    pub sign: &'static str,
    /// The name of the kind.
    pub name: &'static str,
    /// What a string of this kind is bound to.
    pub bound: &'static str,
    /// One line.
    pub summary: &'static str,
    /// The manual, in Markdown.
    pub long: &'static str,
    /// A whole string.
    pub example: &'static str,
}

/// The kinds of string.
pub(crate) static STRINGS: [StringRow; 6] = [
    StringRow {
        sign: "#",
        name: "comment",
        bound: "nothing",
        summary: "a note for people",
        long: "Everything after `#` is ignored. Use it to leave notes in the drawing.",
        example: "# the left arm waves",
    },
    StringRow {
        sign: "%",
        name: "defaults",
        bound: "nothing",
        summary: "attributes for all parts, and settings of the whole drawing",
        long: "Attributes in a `%` string apply to every part that does not set them in its own \
               string or through a legend. Settings of the whole drawing (`Scale`, `Ground` and so \
               on) are allowed only here.\n\nA drawing can have several `%` strings, anywhere on \
               the page. They are combined from back to front; where two set the same thing, the \
               later one wins.",
        example: "%Scale 2 Shape roundv",
    },
    StringRow {
        sign: "*",
        name: "unused",
        bound: "a part",
        summary: "the part is left out",
        long: "The part that the string belongs to is left out of the model: a spare piece, a \
               sample, a scribble. The rest of the string is a comment.",
        example: "*Unuse",
    },
    StringRow {
        sign: "$",
        name: "legend",
        bound: "a part",
        summary: "a sample of paint that gives its attributes to all parts with that paint",
        long: "Draw a small shape with the same fill as your parts, and write the legend beside it. \
               The shape itself is left out of the model; every part with the same fill gets the \
               attributes.\n\nIn an object's description (`<desc>`), `$ …` sets the attributes of \
               that object itself.",
        example: "$Shape roundv Color #ffcc99",
    },
    StringRow {
        sign: "",
        name: "part",
        bound: "a part",
        summary: "names a part, attaches it to a parent, and sets its attributes",
        long: "`Name` alone names the part. `Name@Parent` attaches it to another part: it moves \
               along with its parent. Attributes come after `$`.\n\nA name that contains spaces or \
               one of `@ $ ( )` needs quotes: `\"Left arm\"@Body`.",
        example: "Rarm@Ubody$Shape roundv -90 90",
    },
    StringRow {
        sign: "^",
        name: "feature point",
        bound: "an outline",
        summary: "marks a point on the outline of a region of a character that turns",
        long: "The same name in two views marks the same point on a region's outline. The outlines \
               in between keep that point.",
        example: "^ nose",
    },
];

/// All words of the language that are not keywords: kinds, words of attributes, functions.
pub(crate) fn all() -> impl Iterator<Item = &'static str> {
    kinds::KINDS
        .iter()
        .map(|row| row.name)
        .chain(choices().map(|word| word.name))
        .chain(FUNCTIONS.iter().map(|row| row.name))
}

/// The words that attributes take.
fn choices() -> impl Iterator<Item = &'static Word> {
    ORIGIN
        .iter()
        .chain(&GROUND)
        .chain(&BIND)
        .chain(&STROKES)
        .chain(&TILE)
        .chain(&CARRY)
        .chain(&SIDE)
        .chain(&MIRROR)
        .chain(&MATCH)
        .chain(&FACING)
        .chain(&AXES)
        .chain(&CLIPS)
        .chain(FROM.iter().chain(&TO).chain(&SPEED))
}

/// Whether `word` has a meaning in any attribute, colour names included.
pub(crate) fn is_known(word: &str) -> bool {
    all().any(|known| known.eq_ignore_ascii_case(word)) || colors::is_color(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_are_in_the_order_of_the_enum() {
        for row in &FUNCTIONS {
            assert_eq!(row.function.row().name, row.name);
        }
    }
}

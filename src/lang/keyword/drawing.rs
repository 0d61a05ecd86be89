//! Rows of the table: settings of the whole drawing.

use super::signature::{Bounds, Form, POINT, Parameter, Takes, number};
use super::{Row, vocabulary};

static CENTIMETRES: [Parameter; 1] = [number(
    "s",
    Bounds::POSITIVE,
    "centimetres per drawing unit",
)];
static DIRECTIONS: [Parameter; 3] = [
    Parameter {
        name: "right",
        summary: "the world axis of the drawing's right",
        takes: Takes::SignedAxis,
    },
    Parameter {
        name: "up",
        summary: "the world axis of the drawing's up",
        takes: Takes::SignedAxis,
    },
    Parameter {
        name: "front",
        summary: "the world axis that points towards the viewer",
        takes: Takes::SignedAxis,
    },
];
static GROUND_WORD: [Parameter; 1] = [Parameter {
    name: "where",
    summary: "what lies at the world's origin",
    takes: Takes::Choice(&vocabulary::GROUND),
}];
static DEFINITION: [Parameter; 2] = [
    Parameter {
        name: "name",
        summary: "the new variable",
        takes: Takes::Variable,
    },
    number("value", Bounds::ANY, "its value"),
];
static BIND_WORD: [Parameter; 1] = [Parameter {
    name: "distance",
    summary: "what the distance is measured to",
    takes: Takes::Choice(&vocabulary::BIND),
}];
static STROKES_WORD: [Parameter; 1] = [Parameter {
    name: "which",
    summary: "what becomes a part",
    takes: Takes::Choice(&vocabulary::STROKES),
}];

pub(super) static SCALE: Row = Row {
    forms: &[Form::new(&CENTIMETRES, &[1])],
    default: "1",
    summary: "the size of the model: one drawing unit is `s` centimetres",
    long: "With `Scale 1`, a figure that is 170 units high in the drawing becomes 1.7 metres high. \
           Drawing units are what the drawing program shows at a document scale of 1.",
    example: "%Scale 2",
    ..Row::DRAWING
};

pub(super) static AXES: Row = Row {
    forms: &[Form::new(&DIRECTIONS, &[3])],
    default: "+x +y +z",
    summary: "which way the drawing faces in the model's world",
    long: "Three world axes: the ones that the drawing's right, its up, and the direction towards \
           the viewer become. `+x +y +z` is right for glTF; `+x +z -y` stands a drawing up in a \
           world where z is up.",
    example: "%Axes +x +z -y",
    ..Row::DRAWING
};

pub(super) static GROUND: Row = Row {
    forms: &[Form::new(&GROUND_WORD, &[1]), Form::new(&POINT, &[2])],
    default: "bottom",
    summary: "what lies at the world's origin",
    long: "`bottom` is the middle of the figures' lower edge, so that they stand on the ground. \
           `page` is the page's top left corner. Or give a point in drawing units.",
    example: "%Ground 120 300",
    ..Row::DRAWING
};

pub(super) static LET: Row = Row {
    forms: &[Form::new(&DEFINITION, &[2])],
    default: "",
    summary: "gives a number a name",
    long: "The name can then be used wherever a number can: alone (`Offset thick`) or in a \
           calculation (`Offset (thick / 2)`). A negative variable needs parentheses: `(-thick)`. \
           `Let` may come after the use, and may be in another `%` string. A variable cannot have \
           the name of a keyword.",
    example: "%Let thick 20 Let half (thick / 2)",
    ..Row::DRAWING
};

pub(super) static BIND: Row = Row {
    forms: &[Form::new(&BIND_WORD, &[1])],
    default: "center",
    summary: "how a string finds its part",
    long: "A string that is not grouped with its part belongs to the nearest part. `center` \
           measures the distance to the parts' centres, `outline` to their outlines, which is \
           better for parts that are long or lie inside each other.",
    example: "%Bind outline",
    ..Row::DRAWING
};

pub(super) static STROKES: Row = Row {
    forms: &[Form::new(&STROKES_WORD, &[1])],
    default: "none in annotated drawings, lines in others",
    summary: "which strokes become parts",
    long: "Normally lines are guides, and only filled shapes are parts. `lines` also makes parts \
           of lines without a fill, `all` of the borders of filled shapes as well.",
    example: "%Strokes lines",
    ..Row::DRAWING
};

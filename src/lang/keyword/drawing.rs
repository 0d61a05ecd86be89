//! Rows of the table: settings of the whole drawing.

use super::signature::{Bounds, Form, POINT, Parameter, Takes, choice, number, parameter};
use super::{Row, vocabulary};

static DIRECTIONS: [Parameter; 3] = [
    parameter(
        "right",
        Takes::SignedAxis,
        "the world axis of the drawing's right",
    ),
    parameter(
        "up",
        Takes::SignedAxis,
        "the world axis of the drawing's up",
    ),
    parameter(
        "front",
        Takes::SignedAxis,
        "the world axis that points towards the viewer",
    ),
];
static DEFINITION: [Parameter; 2] = [
    parameter("name", Takes::Variable, "the new variable"),
    number("value", Bounds::ANY, "its value"),
];

pub(super) static SCALE: Row = Row {
    forms: &[Form::one(&number(
        "s",
        Bounds::POSITIVE,
        "centimetres per drawing unit",
    ))],
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
    forms: &[
        Form::one(&choice(
            "where",
            &vocabulary::GROUND,
            "what lies at the world's origin",
        )),
        Form::new(&POINT, &[2]),
    ],
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
    forms: &[Form::one(&choice(
        "rule",
        &vocabulary::BIND,
        "how strings find their parts",
    ))],
    default: "meant",
    summary: "how a string finds its part",
    long: "`meant`: a string that is not grouped with its part belongs to the part that it lies on, \
           else to one near it, and all strings share out the parts so that together they are \
           nearest to them. `center` is the paper's rule: the nearest pairs of a string's top left \
           corner and a part's centre. `outline` measures the distance to outlines instead.",
    example: "%Bind center",
    ..Row::DRAWING
};

pub(super) static STROKES: Row = Row {
    forms: &[Form::one(&choice(
        "which",
        &vocabulary::STROKES,
        "what becomes a part",
    ))],
    default: "lines on parts",
    summary: "which strokes are built",
    long: "A line without a fill that is drawn on a part is ink: it lies on the part's surface and \
           moves with it, like a mouth on a face. So does a line that begins on a part and goes out \
           of it, as a part of its own, and a line with a label. Other lines beside all parts are guides; `lines` makes them \
           parts too. `all` does the same and adds the outlines of filled shapes, as ink on these; \
           a drawing that never says `Shape` gets `all` but for hairlines. `none` leaves all strokes \
           out. A line that is grouped with a string, or has one as its description, is a part in \
           any case, and a line that leads from a string to a part never is.",
    example: "%Strokes all",
    ..Row::DRAWING
};

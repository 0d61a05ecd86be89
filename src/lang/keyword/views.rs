//! Rows of the table: characters that are drawn from two sides (billboards).

use super::signature::{Bounds, DISTANCE, Form, Parameter, Restriction, choice, number};
use super::{Row, vocabulary};

static ANGLES: [Parameter; 2] = [
    number(
        "theta",
        Bounds::ANY,
        "how far the character is turned, in degrees",
    ),
    number(
        "phi",
        Bounds::new(-90., 90., Restriction::None),
        "how far the character is seen from above, in degrees",
    ),
];

pub(super) static DEPTH: Row = Row {
    forms: &[Form::new(&DISTANCE, &[1])],
    default: "estimated from the views",
    summary: "the depth of a character's region",
    long: "In a character that is drawn in two views, the depth of a region follows from how far \
           it moves between them. `Depth` sets it instead, in drawing units towards the viewer of \
           the front view.",
    example: "Nose$Depth 14",
    ..Row::ROW
};

pub(super) static VIEW: Row = Row {
    forms: &[Form::new(&ANGLES, &[2])],
    summary: "makes the string's group one view of a character",
    long: "Draw a character twice, in two layers and from two sides, and give both layers the same \
           name. `theta` is how far the viewer has walked around towards the character's left, \
           `phi` how far up, both in degrees. The front is `0 0`.",
    example: "Boy$View 45 0",
    ..Row::ROW
};

pub(super) static BACKING: Row = Row {
    default: "off",
    summary: "closes the gaps between a character's regions, and gives it a back",
    long: "Between two views, small gaps can open where a region slides away from its neighbour. \
           `Backing` lets each region go on a little under those in front of it, behind the whole \
           character, so that the gaps are filled with its colour. At the drawn views nothing of it \
           can be seen. It also gives the character a back: the silhouette of its front, with hair over \
           the face, and without eyes and mouth. One view's string is enough.",
    example: "Boy$View 0 0 Backing",
    ..Row::ROW
};

pub(super) static MIRROR: Row = Row {
    forms: &[Form::new(
        &[choice(
            "whether",
            &vocabulary::MIRROR,
            "whether the other side is made from the drawn one",
        )],
        &[0, 1],
    )],
    default: "found from the view from the front",
    summary: "whether a character's other side is the mirror image of the drawn one",
    long: "A character that looks symmetric from the front turns both ways from two drawings: `View 45 \
           0` serves the angle −45 as well, with left and right exchanged. `Mirror` does so for one \
           that okoshi does not find symmetric; what hangs beside it on one side only stays on that side. \
           `Mirror off` leaves the side that nobody drew as it is. One view's string is enough.",
    example: "Boy$View 45 0 Mirror off",
    ..Row::ROW
};

pub(super) static MATCH: Row = Row {
    forms: &[Form::one(&choice(
        "method",
        &vocabulary::MATCH,
        "how regions find their partners",
    ))],
    default: "whole",
    summary: "how the regions of a character's views find their partners",
    long: "`whole` pairs the regions of two views so that all pairs together fit best, each region with one. \
           `thesis` is the method of the thesis by which okoshi turns characters (section 4.2.3): each \
           region with the most similar one by equation 4.1, which the most similar one keeps if \
           several want it. Names decide with both. One view's string is enough.",
    example: "Boy$View 0 0 Match thesis",
    ..Row::ROW
};

pub(super) static HIDDEN: Row = Row {
    default: "off",
    summary: "a region that cannot be seen in this view",
    long: "Draw a region that cannot be seen in this view, and mark it with `Hidden`, to say what \
           shape it has while it is hidden.",
    example: "Ear$Hidden",
    ..Row::ROW
};

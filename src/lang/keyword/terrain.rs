//! Rows of the table: terrain.

use super::signature::{Bounds, Form, POINT, Restriction, Takes, choice, number, parameter};
use super::{Allowed, Row, vocabulary};

pub(super) static TILES: Row = Row {
    forms: &[
        Form::one(&number(
            "size",
            Bounds::POSITIVE,
            "side of a tile, in drawing units",
        )),
        Form::one(&parameter(
            "file",
            Takes::File,
            "a map of Tiled, `.tmx` or `.tmj`, in the drawing's folder",
        )),
    ],
    summary: "makes the string's group a map of tiles",
    long: "The group or layer that contains the string is read as a map, drawn as in role-playing \
           games, and becomes a landscape of blocks. `size` is the side of a tile in drawing units. \
           Or the map is a file of the editor Tiled, which is seen from straight above: a pixel of its tiles \
           is a drawing unit, and its top left corner is that of what is painted in the group, or of the page. \
           Its objects that show tiles stand on it.",
    example: "Island$Tiles 16",
    ..Row::ROW
};

pub(super) static TILE: Row = Row {
    forms: &[Form::one(&choice(
        "tile",
        &vocabulary::TILE,
        "what the tiles are",
    ))],
    allowed: Allowed::Legend,
    default: "chosen by the paint's colour",
    summary: "what tiles of this paint are",
    long: "Draw a small shape in the paint of your tiles and write beside it what they are: ground \
           (`green`), cliff (`brown`), water (`blue`), roof (`red`), wall (`beige`) or `none`.",
    example: "$Tile green Color #88bb44",
    ..Row::ROW
};

pub(super) static BEVEL: Row = Row {
    forms: &[Form::one(&number(
        "r",
        Bounds::new(0., 0.5, Restriction::None),
        "size of the bevel, in tiles",
    ))],
    default: "0",
    summary: "bevels the corners of the ground",
    long: "Cuts the corners of a landscape's ground by `r` tiles, so that it looks less like boxes. \
           Narrow faces keep at least their middle half.",
    example: "Island$Tiles 16 Bevel 0.2",
    ..Row::ROW
};

pub(super) static ROOF: Row = Row {
    forms: &[Form::one(&number(
        "factor",
        Bounds::NOT_NEGATIVE,
        "height of the ridge divided by depth of the roof",
    ))],
    default: "0.7071",
    summary: "how steep the roofs of a landscape are",
    long: "The height of the ridge divided by the depth of the roof. With 0.5 the model looks \
           exactly like the drawing when seen from 45° above.",
    example: "Village$Tiles 16 Roof 0.5",
    ..Row::ROW
};

pub(super) static HEIGHT: Row = Row {
    forms: &[Form::one(&number(
        "n",
        Bounds::new(-100., 100., Restriction::Integer),
        "height of the tops, in whole tiles",
    ))],
    default: "0; water lies one tile below its lowest bank",
    summary: "how high tiles are, in a map that is seen from straight above",
    long: "Makes a plain map of the tile layer: seen from straight above, without fronts. In a legend it \
           is the height of the tiles of that paint, in the string of a group inside the layer that of the \
           group's tiles, and in the layer's own string that of all others. Walls stand where heights \
           differ. Below 0 the ground is sunken.",
    example: "$Tile beige Height 3",
    ..Row::ROW
};

pub(super) static STAND: Row = Row {
    forms: &[Form::new(&[], &[0]), Form::new(&POINT, &[2])],
    default: "off; a prop stands on the middle of its lowest edge",
    summary: "makes what is in the string's group stand on the ground of a map",
    long: "Makes props of a layer: every group, clone and picture in it stands upright on the ground of a map, \
           where the middle of its lowest edge is drawn: trees, fences, signs, boats. Shapes without a group \
           stand by themselves, with those that are drawn on them. Copies share one mesh. A prop is a slab, a \
           tenth as thick as it is wide, unless a `Shape` in its own string, in that of the layer or in a `%` \
           string says otherwise. In the string of one prop, `x` and `y` are the point of the page on which \
           it stands.",
    example: "Trees$Stand",
    ..Row::ROW
};

//! The diagnostics of tile layers.

use glam::DVec2;

use super::Layer;
use super::classify::Tally;
use super::content::Content;
use super::edges::Stray;
use super::fit::{Borders, Fit};
use super::grid::{Grid, rectangle};
use super::materials::Paints;
use super::raster::Code as Painted;
use crate::bind::{Bindings, LayerId};
use crate::diagnostic::{Code, Diagnostic, Edit, Fix};
use crate::geometry::{contains, edges};
use crate::source::Span;
use crate::svg::{Drawing, GroupKind, PaintKey, ShapeId};
use crate::terrain::{AmbiguityKind, MAX_CELLS, Tile};

/// The largest distance of tiles' borders from the grid, cells.
const OFF: f64 = 0.1;
/// The largest number of unclear colours that are reported one by one.
const MAX_COLORS: usize = 5;
/// The largest number of ambiguities that are reported one by one.
const MAX_AMBIGUITIES: usize = 12;
/// The largest number of cells of a shape that are examined for whether it covers one of them.
const MAX_EXAMINED: f64 = 16.0;
/// The largest number of shapes that a diagnostic refers to.
const MAX_SHOWN: usize = 3;

/// Names the first cells for people, as in `column 3, row 1 and 4 more`. Columns and rows count from 1 at the top left.
pub(crate) fn cells_named(columns: usize, first: &[usize], count: usize) -> String {
    let cell = |cell: &usize| {
        let (column, row) = (cell % columns.max(1), cell / columns.max(1));
        format!("column {}, row {}", column + 1, row + 1)
    };
    let named: Vec<String> = first.iter().map(cell).collect();
    match (named.as_slice(), count.saturating_sub(first.len())) {
        ([all @ .., last], 0) if !all.is_empty() => format!("{} and {last}", all.join("; ")),
        (all, 0) => all.join("; "),
        (all, more) => format!("{} and {more} more", all.join("; ")),
    }
}

/// The span of the size of tiles in a layer's string.
pub(super) fn size_span(bindings: &Bindings, layer: LayerId) -> Span {
    let string = &bindings.strings[bindings.layers[layer].string];
    let size = bindings.layer_attributes(layer).tile_size();
    size.map_or(string.text.whole(), |size| bindings.span_of(&size.source))
}

/// A layer without tiles.
pub(super) fn empty(
    drawing: &Drawing,
    bindings: &Bindings,
    layer: LayerId,
    holds: bool,
) -> Diagnostic {
    let group = bindings.layers[layer].group;
    let element = &drawing.groups[group].element;
    let name = &bindings.layers[layer].name;
    let (message, help) = if holds {
        (
            format!(
                "the tile layer `{name}` has no tiles: no shape covers the centre of a cell, or legends set `none` for all that do"
            ),
            "write the size that the tiles are drawn with, so that each covers the centre of a cell",
        )
    } else {
        (
            format!(
                "the tile layer `{name}` has no tiles: nothing is painted in {}",
                drawing.describe_group(group)
            ),
            "put the string into the group or layer that contains the tiles",
        )
    };
    Diagnostic::new(Code::NoTiles, size_span(bindings, layer), message)
        .related(element.span, "the group")
        .help(help)
}

/// A grid over the limit.
pub(super) fn too_large(
    bindings: &Bindings,
    layer: LayerId,
    size: f64,
    [columns, rows]: [f64; 2],
) -> Diagnostic {
    let message = format!(
        "tiles of {size} make a grid of {columns:.0} × {rows:.0} = {:.0} cells, more than the limit of {MAX_CELLS}",
        columns * rows
    );
    Diagnostic::new(Code::LimitPassed, size_span(bindings, layer), message)
        .help("write the side of a tile in drawing units, and check that nothing is drawn far away")
}

/// Warns about the ambiguities of a map.
pub(super) fn open(drawing: &Drawing, layer: &Layer, diagnostics: &mut Vec<Diagnostic>) {
    let ambiguities = layer.landscape.ambiguities();
    for ambiguity in ambiguities.iter().take(MAX_AMBIGUITIES) {
        let [column, row] = ambiguity.cell;
        let shape = layer.source_at(column, row);
        let span = shape.map_or(Span::at(0), |shape| drawing.shapes[shape].element.span);
        let cell = layer.map.index(column, row);
        let cells = cells_named(layer.map.columns, &[cell], ambiguity.cells);
        let (message, help) = ambiguity.kind.message_and_help();
        let message = format!("`{}`: {message}: {cells}", layer.name);
        diagnostics.push(Diagnostic::new(Code::OpenTerrain, span, message).help(help));
    }
    if ambiguities.len() > MAX_AMBIGUITIES {
        let span = drawing.groups[layer.group].element.span;
        let more = ambiguities.len() - MAX_AMBIGUITIES;
        let message = format!(
            "`{}`: {more} more places can be read in more than one way",
            layer.name
        );
        let help = "fix the first ones: they often cause the others";
        diagnostics.push(Diagnostic::new(Code::OpenTerrain, span, message).help(help));
    }
}

impl AmbiguityKind {
    /// The message and the help of its warning.
    fn message_and_help(self) -> (String, String) {
        match self {
            Self::Unconstrained => (
                "nothing gives the height of this group, so its lowest part is on the ground".into(),
                "draw brown tiles below it, down to what it stands on".into(),
            ),
            Self::Hangs { drawn, needed } => (
                format!("this group hangs in the air: its height is {needed}, but {drawn} brown tiles are drawn below it"),
                "draw as many brown tiles as it is high, or draw an edge where another group begins".into(),
            ),
            Self::Uneven { most, taken: 0, columns } => (
                format!("a few of the {columns} columns of this group's lower border have up to {most} brown tiles, and the others none, so the group is as high as what is below it"),
                format!("draw no brown tiles there, or draw {most} in a quarter of the columns to lift the group"),
            ),
            Self::Uneven { most, taken, columns } => (
                format!("a few of the {columns} columns of this group's front have up to {most} brown tiles, so the group is only {taken} high, and there the front goes on below what it stands on"),
                format!("draw at most {taken} brown tiles everywhere, or draw {most} in a quarter of the columns to lift the group"),
            ),
            Self::Plain(Tile::Red) => (
                "a roof without a wall below it is read as ground of its colour".into(),
                "draw beige tiles below the roof, or say what the colour means: `$Tile green`".into(),
            ),
            Self::Plain(_) => (
                "a wall without a roof above it is read as ground of its colour".into(),
                "draw red tiles above the wall; for a path, write `$Tile green` beside a sample of its colour".into(),
            ),
            Self::House => (
                "this house hides other tiles, because its roof or its wall is not a rectangle".into(),
                "draw roof and wall as rectangles, or make what is in front of them high enough to hide the rest".into(),
            ),
            Self::Pits => (
                "brown tiles in the middle of green ones are pits".into(),
                "if a block on the ground was meant, draw edges around its top".into(),
            ),
        }
    }
}

/// Reports colours that are not clearly those of one kind.
pub(super) fn unclear(
    drawing: &Drawing,
    layer: &Layer,
    paints: &Paints<'_>,
    colors: &[(Painted, Tally)],
    diagnostics: &mut Vec<Diagnostic>,
) {
    for (code, tally) in colors.iter().take(MAX_COLORS) {
        let Some(shape) = shape_of(drawing, layer, paints, *code, tally) else {
            continue;
        };
        let ([r, g, b], _) = paints.appearance(*code);
        let hex = format!("#{r:02x}{g:02x}{b:02x}");
        let (what, swatch) = match &drawing.shapes[shape].paint.key {
            PaintKey::Server(id) => (
                format!("the gradient or pattern `#{id}`, whose mean is {hex},"),
                "with that fill".to_owned(),
            ),
            _ => (format!("the colour {hex}"), format!("of the colour {hex}")),
        };
        let cells = cells_named(layer.map.columns, &tally.first, tally.count);
        let message = format!("{what} is not a tile colour of `{}`: {cells}", layer.name);
        let help = format!(
            "say what it means: draw a square {swatch} in the same layer, and beside it write `$Tile green`, or brown, blue, red, beige, none"
        );
        let span = drawing.shapes[shape].element.span;
        diagnostics.push(Diagnostic::new(Code::UnclearTile, span, message).help(help));
    }
    let rest = colors.get(MAX_COLORS..).unwrap_or_default();
    if let [(code, first), ..] = rest
        && let Some(shape) = shape_of(drawing, layer, paints, *code, first)
    {
        let count: usize = rest.iter().map(|(_, tally)| tally.count).sum();
        let cells = cells_named(layer.map.columns, &first.first[..1], count);
        let message = format!(
            "{} more colours are not tile colours of `{}`: {cells}",
            rest.len(),
            layer.name
        );
        let help = "paint maps in a few plain colours, without anti-aliasing, and save them as PNG";
        let span = drawing.shapes[shape].element.span;
        diagnostics.push(Diagnostic::new(Code::UnclearTile, span, message).help(help));
    }
}

/// The shape that has a colour.
fn shape_of(
    drawing: &Drawing,
    layer: &Layer,
    paints: &Paints<'_>,
    code: Painted,
    tally: &Tally,
) -> Option<ShapeId> {
    if let Some(paint) = super::raster::paint_of(code) {
        return Some(paints.list[paint].shape);
    }
    let cell = tally.first.first().copied().unwrap_or(0);
    let columns = layer.map.columns.max(1);
    let (column, row) = (cell % columns, cell / columns);
    let pictures = layer.sources.iter().rev();
    let mut pictures = pictures.filter(|source| drawing.shapes[source.shape].picture.is_some());
    let here =
        pictures.find(|source| source.columns.contains(&column) && source.rows.contains(&row));
    here.or(layer.sources.first()).map(|source| source.shape)
}

/// Warns about gradients and patterns that are replaced by their mean colours.
pub(super) fn plain(drawing: &Drawing, paints: &Paints<'_>, list: &[usize]) -> Vec<Diagnostic> {
    let finding = |index: &usize| {
        let paint = &paints.list[*index];
        let PaintKey::Server(id) = paint.key else {
            return None;
        };
        let message =
            format!("the gradient or pattern `#{id}` appears on tiles as its mean colour");
        let span = drawing.shapes[paint.shape].element.span;
        Some(
            Diagnostic::new(Code::PlainPaint, span, message)
                .help("to give the tiles a picture, use a legend such as `$Tile green Texture \"grass.png\"`; or set a `Color`"),
        )
    };
    list.iter().filter_map(finding).collect()
}

/// Warns about tiles that are off the grid, with the grid that fits them if there is one.
pub(super) fn off_grid(
    drawing: &Drawing,
    bindings: &Bindings,
    layer: LayerId,
    grid: &Grid,
    content: &Content,
) -> Option<Diagnostic> {
    let off = |p: DVec2| {
        let cells = grid.cells(p);
        (cells - cells.round()).abs().max_element()
    };
    let (mut count, mut found) = (0, vec![]);
    for (shape, [low, high]) in &content.fills {
        if rectangle(&drawing.shapes[*shape].outline).is_some() {
            count += 1;
            found.extend((off(*low).max(off(*high)) > OFF).then_some(*shape));
        }
    }
    let mut borders = Borders::default();
    for (shape, _) in &content.fills {
        let edges = edges(&drawing.shapes[*shape].outline);
        edges.for_each(|[from, to]| borders.add(from, to));
    }
    for stroke in content.strokes(drawing) {
        stroke.middle_line(grid.size * OFF, |from, to| borders.add(from, to));
    }
    let name = &bindings.layers[layer].name;
    let message = match (found.len(), count) {
        // Of other shapes, most borders must be off.
        (0, _) if borders.agreement(grid)? > 0.0 => return None,
        (0, _) => format!("the shapes in `{name}` are off the grid"),
        (1, 1) => format!("the shape in `{name}` is off the grid"),
        (off, all) if off == all => format!("all {count} rectangles in `{name}` are off the grid"),
        (off, _) => format!("{off} of {count} rectangles in `{name}` are off the grid"),
    };
    let span = size_span(bindings, layer);
    let mut finding = Diagnostic::new(Code::OffGrid, span, message);
    finding = match borders.fit(grid) {
        None => finding.help(format!(
            "write the size that they are drawn with in place of {}, or move them onto the grid: a cell becomes whatever is drawn at its centre",
            grid.size
        )),
        Some(fit) => fitting(drawing, bindings, layer, grid.size, fit, finding),
    };
    for shape in found.iter().take(MAX_SHOWN) {
        let element = &drawing.shapes[*shape].element;
        finding = finding.related(
            element.span,
            "this one is off by more than a tenth of a tile",
        );
    }
    Some(finding)
}

/// Adds the help and the fix that make the grid fit.
fn fitting(
    drawing: &Drawing,
    bindings: &Bindings,
    layer: LayerId,
    written: f64,
    Fit { size, shift }: Fit,
    mut finding: Diagnostic,
) -> Diagnostic {
    let span = size_span(bindings, layer);
    let [x, y] = shift.to_array();
    let is_moved = shift.abs().max_element() > OFF * size.unwrap_or(written);
    let moving = format!("move the whole layer by {x} to the right and {y} down");
    let (help, title) = match (size, is_moved) {
        (Some(size), false) => (
            format!("write the size that fits its borders best, `Tiles {size}`"),
            format!("Write `Tiles {size}`"),
        ),
        (Some(size), true) => (
            format!(
                "write the size that fits its borders best, `Tiles {size}`, and {moving}; the grid begins at a multiple of the size"
            ),
            format!("Write `Tiles {size}` and move the layer onto the grid"),
        ),
        (None, _) => (
            format!("{moving}; the grid begins at a multiple of the size"),
            "Move the layer onto the grid".to_owned(),
        ),
    };
    let group = &drawing.groups[bindings.layers[layer].group];
    let mut edits: Vec<Edit> = size
        .map(|size| Edit {
            span,
            text: format!("Tiles {size}"),
        })
        .into_iter()
        .collect();
    let can_move = group.is_untransformed && group.kind != GroupKind::Root;
    if is_moved && can_move {
        edits.push(Edit {
            span: Span::at(group.element.span.end),
            text: format!(" transform=\"translate({x} {y})\""),
        });
    }
    if !is_moved || can_move {
        finding.fixes.push(Fix {
            title,
            edits,
            safe: false,
        });
    }
    finding.help(help)
}

/// Warns about strokes that are no edges.
pub(super) fn stray(
    drawing: &Drawing,
    layer: &Layer,
    content: &Content,
    strays: &[Stray],
) -> Option<Diagnostic> {
    let shape = |stray: &Stray| &drawing.shapes[content.strokes[stray.stroke]].element;
    let first = strays.first()?;
    let mut cells: Vec<usize> = strays.iter().map(|stray| stray.cell).collect();
    cells.truncate(MAX_SHOWN);
    let cells = cells_named(layer.map.columns, &cells, strays.len());
    let what = match strays.len() {
        1 => "a stroke is no edge: it runs".to_owned(),
        count => format!("{count} strokes are no edges: they run"),
    };
    let message = format!(
        "`{}`: {what} across tiles, more than a quarter of a tile from the lines between them: {cells}",
        layer.name
    );
    let finding = Diagnostic::new(Code::OffGrid, shape(first).span, message).help(
        "draw edges along the lines between tiles; for what is no edge, write the string `*` beside it",
    );
    Some(with_others(
        finding,
        strays.iter().map(|stray| shape(stray).span),
    ))
}

/// Warns about shapes that are too small or too thin for the map.
pub(super) fn idle(
    drawing: &Drawing,
    layer: &Layer,
    grid: &Grid,
    content: &Content,
) -> Option<Diagnostic> {
    let misses = |(index, [low, high]): &&(ShapeId, [DVec2; 2])| {
        let outline = &drawing.shapes[*index].outline;
        if drawing.shapes[*index].picture.is_some() || rectangle(outline).is_some() {
            return false;
        }
        // The cells whose middles are in its bounding box.
        let [first, past] = [*low, *high].map(|p| (grid.cells(p) - 0.5).ceil());
        let count = (past - first).max(DVec2::ZERO);
        count.x * count.y <= MAX_EXAMINED
            && (0..count.x as usize * count.y as usize).all(|at| {
                let (x, y) = (at % count.x as usize, at / count.x as usize);
                let middle = first + DVec2::new(x as f64, y as f64) + 0.5;
                !contains(outline, grid.origin + middle * grid.size)
            })
    };
    let idle: Vec<&(ShapeId, [DVec2; 2])> = content.fills.iter().filter(misses).collect();
    let element = |index: usize| &drawing.shapes[idle[index].0].element;
    let message = match idle.len() {
        0 => return None,
        1 => format!(
            "a shape in `{}` covers the centre of no tile, so it is not in the map",
            layer.name
        ),
        count => format!(
            "{count} shapes in `{}` cover the centre of no tile, so they are not in the map",
            layer.name
        ),
    };
    let finding = Diagnostic::new(Code::OffGrid, element(0).span, message)
        .help("draw what is a tile larger; for decoration, write the string `*` beside it");
    let spans = (0..idle.len()).map(|index| element(index).span);
    Some(with_others(finding, spans))
}

/// A finding with the first few of the other places that it is about; the first of these spans is its own.
fn with_others(finding: Diagnostic, spans: impl Iterator<Item = Span>) -> Diagnostic {
    let others = spans.take(MAX_SHOWN).skip(1);
    others.fold(finding, |finding, span| {
        finding.related(span, "and this one")
    })
}

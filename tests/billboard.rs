//! Characters that turn: at each drawn view the model is the drawing, seen on the page and by a viewer in that direction.
#![cfg(feature = "cli")]

mod common;

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use glam::DVec2;
use okoshi::FolderResolver;
use okoshi::compile::Compiled;
use okoshi::internals::look::DrawnView;
use okoshi::render::{self, Options, PosedModel, Shading, Sheet};
use okoshi::resolver::{MemoryResolver, Resolver as _};
use okoshi::scene::{ViewId, view_axes};
use resvg::tiny_skia::{Pixmap, Transform};

/// Pixels a drawing unit.
const SCALE: f64 = 3.0;
/// Colours that cover fewer pixels are not compared one by one.
const FEW: usize = 400;

/// Pixels between the places at which the colours across a line are looked at.
const STEP: f64 = 0.05;
/// A line's width is measured in at least so many places.
const FEWEST_PLACES: usize = 8;

const EXAMPLES: [&str; 4] = ["bird", "boy", "cat", "robot"];

struct Character {
    text: String,
    compiled: Compiled,
    folder: std::path::PathBuf,
}

fn character(name: &str) -> Character {
    edited(name, str::to_owned)
}

/// An example whose text was changed.
fn edited(name: &str, edit: impl Fn(&str) -> String) -> Character {
    let file = format!("examples/characters/{name}.svg");
    drawn(Path::new(&file), edit)
}

/// A drawing of the project whose text was changed.
fn drawn(file: &Path, edit: impl Fn(&str) -> String) -> Character {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let folder = file.parent().expect("a folder").to_owned();
    let text = edit(&fs::read_to_string(&file).expect("a drawing"));
    let compiled = common::compiled(&text, &FolderResolver::new(&folder));
    assert!(
        compiled.diagnostics.is_empty(),
        "{:?}",
        compiled.diagnostics
    );
    Character {
        text,
        compiled,
        folder,
    }
}

/// The pixels of a picture: red, green, blue and alpha, multiplied.
struct Picture {
    width: usize,
    pixels: Vec<[u8; 4]>,
}

impl Picture {
    /// The drawing, without its texts: there are no fonts.
    fn of_drawing(character: &Character) -> Self {
        let options = usvg::Options {
            resources_dir: Some(character.folder.clone()),
            ..usvg::Options::default()
        };
        let tree = usvg::Tree::from_str(&character.text, &options).expect("a drawing");
        let size = character.compiled.drawing.page.1 * SCALE;
        let [width, height] = size.to_array().map(|side| side.ceil() as u32);
        let mut pixmap = Pixmap::new(width, height).expect("a size");
        let scale = Transform::from_scale(SCALE as f32, SCALE as f32);
        resvg::render(&tree, scale, &mut pixmap.as_mut());
        let pixels = pixmap.pixels().iter();
        Self {
            width: width as usize,
            pixels: pixels
                .map(|p| [p.red(), p.green(), p.blue(), p.alpha()])
                .collect(),
        }
    }

    fn of_model(image: &render::Image) -> Self {
        let pixels = image.pixels().map(|pixel| {
            let [r, g, b, alpha] = pixel.0;
            let times = |channel| (u16::from(channel) * u16::from(alpha) / 255) as u8;
            [times(r), times(g), times(b), alpha]
        });
        Self {
            width: image.width() as usize,
            pixels: pixels.collect(),
        }
    }

    /// A rectangle of it.
    fn part(&self, [left, top]: [usize; 2], [width, height]: [usize; 2]) -> Self {
        let rows = (top..top + height).flat_map(|row| {
            let start = row * self.width + left;
            self.pixels[start..start + width].iter().copied()
        });
        Self {
            width,
            pixels: rows.collect(),
        }
    }

    /// Per pixel whether all around it, as far as `reach`, have its colour.
    fn is_even(&self, at: usize, reach: usize) -> bool {
        let (column, row) = (at % self.width, at / self.width);
        let height = self.pixels.len() / self.width;
        let inside =
            (reach..self.width - reach).contains(&column) && (reach..height - reach).contains(&row);
        inside
            && (row - reach..=row + reach).all(|row| {
                let line = &self.pixels[row * self.width + column - reach..][..2 * reach + 1];
                line.iter().all(|other| *other == self.pixels[at])
            })
    }
}

fn is_alike(a: [u8; 4], b: [u8; 4]) -> bool {
    (0..4).all(|channel| a[channel].abs_diff(b[channel]) <= 3)
}

/// Asserts that a picture of the model shows the drawing: the right colour in nearly all pixels that are two from a border, and for each
/// colour an intersection over union of at least 0.98. Returns how many colours were compared.
fn assert_same(drawn: &Picture, model: &Picture, what: &str) -> usize {
    assert_eq!(drawn.pixels.len(), model.pixels.len(), "{what}");
    let share = drawn.same(model, is_alike);
    assert!(share > 0.999, "{what}: {share}");

    // The colours that areas have, and of each the pixels that are nearer to it than to any other.
    let mut colors: Vec<([u8; 4], usize)> = Vec::new();
    for (at, own) in drawn.pixels.iter().enumerate() {
        if own[3] == 255 && drawn.is_even(at, 1) {
            match colors.iter_mut().find(|(color, _)| is_alike(*color, *own)) {
                Some((_, count)) => *count += 1,
                None => colors.push((*own, 1)),
            }
        }
    }
    colors.retain(|(_, count)| *count >= FEW);
    let nearest = |pixel: &[u8; 4]| {
        let apart = |color: &[u8; 4]| -> u32 {
            let channels = (0..4).map(|c| u32::from(color[c].abs_diff(pixel[c])));
            channels.map(|difference| difference * difference).sum()
        };
        let empty = apart(&[0; 4]);
        let best = (0..colors.len()).min_by_key(|index| apart(&colors[*index].0));
        best.filter(|index| apart(&colors[*index].0) < empty)
    };
    let mut counts = vec![[0_usize; 2]; colors.len()];
    for (at, (own, shown)) in drawn.pixels.iter().zip(&model.pixels).enumerate() {
        // Where both are mixtures, along a border, neither is of any colour.
        if !drawn.is_even(at, 1) && !model.is_even(at, 1) {
            continue;
        }
        match [nearest(own), nearest(shown)] {
            [Some(a), Some(b)] if a == b => counts[a] = counts[a].map(|count| count + 1),
            found => found
                .iter()
                .flatten()
                .for_each(|index| counts[*index][1] += 1),
        }
    }
    for ((color, _), [common, union]) in colors.iter().zip(&counts) {
        let iou = *common as f64 / *union as f64;
        assert!(
            iou > 0.98,
            "{what}: {color:?} has {common} of {union}, {iou:.4}"
        );
    }
    colors.len()
}

/// A picture of a model on a sheet, without light.
fn picture(scene: &okoshi::scene::Scene, sheet: &Sheet, size: [u32; 2]) -> Picture {
    let file = okoshi::export::to_memory(&okoshi::export::GLB, scene, None);
    let bytes = file.expect("written").bytes;
    let model = render::read(&bytes, &MemoryResolver::default()).expect("a model");
    let posed = PosedModel::new(&model, &model.rest()).expect("triangles");
    let options = Options::default()
        .with_size(size)
        .with_shading(Shading::Unlit);
    Picture::of_model(&posed.picture_of(&options, sheet).expect("a picture"))
}

#[test]
fn on_the_page_every_view_is_as_drawn() {
    let mut colors = 0;
    for name in EXAMPLES {
        let character = character(name);
        let scene = character.compiled.scene.clone();
        let view = DrawnView::new(&character.compiled, scene, SCALE).expect("a page");
        let model = picture(&view.scene, &view.sheet, view.size);
        colors += assert_same(&Picture::of_drawing(&character), &model, name);
    }
    assert!(colors > 20, "{colors}");
}

/// A drawn view, and what a viewer in its direction sees of the model.
struct Seen {
    drawn: Picture,
    model: Picture,
    /// The upper left corner of both, pixels from that of the page.
    corner: DVec2,
    direction: [f64; 2],
}

/// The examples with their views: pictures take long.
static SEEN: LazyLock<Vec<(&str, Character, Vec<Seen>)>> = LazyLock::new(|| {
    let example = |name: &'static str| {
        let character = character(name);
        let views = seen(&character);
        (name, character, views)
    };
    EXAMPLES.map(example).into()
});

/// All views of a character.
fn seen(character: &Character) -> Vec<Seen> {
    let compiled = &character.compiled;
    let drawing = Picture::of_drawing(character);
    let [shown] = &compiled.characters[..] else {
        panic!("one character");
    };
    let page = compiled.drawing.page.0;
    let root = &compiled.scene.nodes[compiled.scene.roots[0]];
    let meters =
        okoshi::internals::assemble::world_transform(&compiled.bindings, &compiled.layers).scale;
    let view = |(index, direction): (ViewId, &[f64; 2])| {
        let [right, up, _] = view_axes(*direction);
        let frame = &shown.frames[index];
        let boxes = shown.views[index].regions.iter();
        let boxes = boxes.filter_map(|region| okoshi::internals::geometry::bounds(&region.outline));
        let (low, high) = boxes
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
            .expect("regions");
        let corner = ((low - page) * SCALE - 6.0).floor().max(DVec2::ZERO);
        let end = ((high - page) * SCALE + 6.0).ceil();
        let size = (end - corner).to_array().map(|side| side as usize);
        let drawn = drawing.part(corner.to_array().map(|at| at as usize), size);
        // Views are as large as the first one.
        let unit = meters * shown.frames[ViewId::FIRST].height / frame.height;
        let offset = (page + corner / SCALE - frame.center) * unit;
        let sheet = Sheet {
            corner: root.translation + right * offset.x - up * offset.y,
            right,
            up,
            pixel: unit / SCALE,
        };
        let model = picture(&compiled.scene, &sheet, size.map(|side| side as u32));
        Seen {
            drawn,
            model,
            corner,
            direction: *direction,
        }
    };
    let views = shown.turn.views.iter_enumerated();
    views.take(shown.layers.len()).map(view).collect()
}

#[test]
fn a_viewer_in_the_direction_of_a_view_sees_it() {
    let mut views = 0;
    for (name, _, drawn_views) in SEEN.iter() {
        for seen in drawn_views {
            let what = format!("{name} from {:?}", seen.direction);
            let compared = assert_same(&seen.drawn, &seen.model, &what);
            assert!(compared > 2, "{what}: {compared} colours");
            views += 1;
        }
    }
    assert_eq!(views, 9);
}

/// Asserts that a picture of the model has the colours of the drawing, each channel within 0.02, wherever nothing begins or ends nearby.
fn assert_same_colors(drawn: &Picture, model: &Picture, what: &str) {
    let height = drawn.pixels.len() / drawn.width;
    let mut compared = 0;
    for row in 2..height - 2 {
        for column in 2..drawn.width - 2 {
            let own = drawn.pixels[row * drawn.width + column];
            let around = (row - 2..=row + 2).flat_map(|row| {
                drawn.pixels[row * drawn.width + column - 2..][..5]
                    .iter()
                    .copied()
            });
            let apart = |a: [u8; 4], b: [u8; 4]| {
                let channels = (0..4).map(|channel| a[channel].abs_diff(b[channel]));
                channels.max().unwrap_or_default()
            };
            // A gradient changes little by little.
            if own[3] == 0 || around.into_iter().any(|other| apart(own, other) > 8) {
                continue;
            }
            compared += 1;
            let shown = model.pixels[row * drawn.width + column];
            assert!(
                apart(own, shown) <= 5,
                "{what}: {shown:?} instead of {own:?} at {column}, {row}"
            );
        }
    }
    assert!(compared > 5000, "{what}: {compared} pixels");
}

#[test]
fn each_view_has_its_own_paints() {
    let character = drawn(
        Path::new("tests/cases/view-paints/drawing.svg"),
        str::to_owned,
    );
    let scene = character.compiled.scene.clone();
    let view = DrawnView::new(&character.compiled, scene, SCALE).expect("a page");
    let model = picture(&view.scene, &view.sheet, view.size);
    assert_same_colors(&Picture::of_drawing(&character), &model, "the page");
    for seen in seen(&character) {
        let what = format!("from {:?}", seen.direction);
        assert_same_colors(&seen.drawn, &seen.model, &what);
    }
}

/// A place on a border with a line.
struct Across {
    /// Pixels.
    at: DVec2,
    /// Across the border, of length 1.
    normal: DVec2,
    /// The line's width, pixels.
    width: f64,
    color: [u8; 4],
}

impl Across {
    /// How wide the line is in a picture there, pixels; `None` if it cannot be told from what is beside it.
    fn measured(&self, picture: &Picture) -> Option<f64> {
        let pixel = |along: f64| {
            let at = (self.at + self.normal * along).floor();
            let [column, row] = at.to_array().map(|at| at as usize);
            let is_inside = at.cmpge(DVec2::ZERO).all() && column < picture.width;
            let pixel = picture.pixels.get(row * picture.width + column);
            pixel.filter(|_| is_inside).copied()
        };
        let apart = |a: [u8; 4], b: [u8; 4]| -> u32 {
            let channels = (0..4).map(|c| u32::from(a[c].abs_diff(b[c])));
            channels.map(|difference| difference.pow(2)).sum()
        };
        let reach = self.width / 2.0 + 2.0;
        let beside = [pixel(-reach)?, pixel(reach)?];
        if beside
            .iter()
            .any(|side| apart(*side, self.color) < 60_u32.pow(2))
        {
            return None;
        }
        let steps = (2.0 * reach / STEP) as u32;
        let mut width = 0.0;
        for step in 0..steps {
            let own = pixel((f64::from(step) + 0.5) * STEP - reach)?;
            let other = beside.map(|side| apart(own, side));
            if apart(own, self.color) < other[0].min(other[1]) {
                width += STEP;
            }
        }
        Some(width)
    }
}

#[test]
fn lines_are_as_wide_as_drawn() {
    let mut lines = 0;
    for (name, character, drawn_views) in SEEN.iter() {
        let compiled = &character.compiled;
        let page = compiled.drawing.page.0;
        for (view, seen) in drawn_views.iter().enumerate() {
            let view = ViewId::from(view);
            for region in &compiled.characters[0].regions {
                let Some(shape) = region.shapes[view] else {
                    continue;
                };
                let shape = &compiled.drawing.shapes[shape];
                let Some(stroke) = &shape.stroke else {
                    continue;
                };
                let [r, g, b] = stroke.paint.color;
                let rings = shape.outline.polygons.iter().flat_map(|p| &p.rings);
                let edges = rings.flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
                let places = edges.filter_map(|(from, to)| {
                    let across = Across {
                        at: ((*from + *to) / 2.0 - page) * SCALE - seen.corner,
                        normal: (*to - *from).perp().try_normalize()?,
                        width: stroke.width() * SCALE,
                        color: [r, g, b, 255],
                    };
                    // Where nothing else hides the line or joins it.
                    let drawn = across.measured(&seen.drawn)?;
                    let is_clear = (drawn - across.width).abs() < 1.5;
                    is_clear.then(|| across.measured(&seen.model))?
                });
                let widths: Vec<f64> = places.collect();
                if widths.len() < FEWEST_PLACES {
                    continue;
                }
                let mean = widths.iter().sum::<f64>() / widths.len() as f64;
                let drawn = stroke.width() * SCALE;
                assert!(
                    (mean - drawn).abs() < 0.5,
                    "{name} from {:?}, {}: {mean:.2} instead of {drawn:.2} pixels",
                    seen.direction,
                    region.name
                );
                lines += 1;
            }
        }
    }
    assert!(lines > 80, "{lines}");
}

#[test]
fn the_clip_goes_to_the_last_drawn_view() {
    let character = character("boy");
    let file = okoshi::export::to_memory(&okoshi::export::GLB, &character.compiled.scene, None);
    let resolver = MemoryResolver::default();
    assert!(resolver.read("none").is_err());
    let model = render::read(&file.expect("written").bytes, &resolver).expect("a model");
    let [clip] = model.clips() else {
        panic!("one clip");
    };
    assert_eq!((clip.name.as_str(), clip.seconds), ("Boy turns", 3.0));
    let view = DrawnView::new(&character.compiled, character.compiled.scene.clone(), SCALE);
    let view = view.expect("a page");
    // The last view as the page shows it, and what the clip shows in the place of the first.
    let options = Options::default()
        .with_size(view.size)
        .with_shading(Shading::Unlit);
    // After the drawn views, it goes back and on to the side that nobody drew.
    let pose = model.pose_at(clip, 1.0);
    let posed = PosedModel::new(&model, &pose).expect("triangles");
    let picture = |options: &Options| {
        Picture::of_model(&posed.picture_of(options, &view.sheet).expect("a picture"))
    };
    let drawing = Picture::of_drawing(&character);
    let frames = &character.compiled.characters[0].frames;
    let moved = (frames.raw[1].center - frames.raw[0].center) * SCALE;
    assert!((moved.y).abs() < 1.0, "{moved}");
    let half = drawing.width / 2;
    let height = drawing.pixels.len() / drawing.width;
    let left = moved.x.round() as usize;
    let last = drawing.part([left, 0], [half, height]);
    // A viewer in front sees the clip, whether characters turn to the viewer or not.
    for options in [options, options.unbent()] {
        let shown = picture(&options).part([0, 0], [half, height]);
        assert_same(&last, &shown, "the clip");
    }
}

#[test]
fn backing_fills_gaps_and_changes_nothing_else() {
    let mut filled = 0;
    for name in EXAMPLES {
        let plain = character(name);
        let backed = edited(name, |text| {
            text.replace("$View 0 0<", "$View 0 0 Backing<")
        });
        let drawn = Picture::of_drawing(&plain);
        let scene = backed.compiled.scene.clone();
        let view = DrawnView::new(&backed.compiled, scene, SCALE).expect("a page");
        let model = picture(&view.scene, &view.sheet, view.size);
        assert_same(&drawn, &model, name);

        // Half way to the second view.
        let shown = &plain.compiled.characters[0];
        let [from, to] = [0, 1].map(|view| shown.turn.views.raw[view]);
        let [right, up, _] = view_axes([(from[0] + to[0]) / 2.0, (from[1] + to[1]) / 2.0]);
        let meters = okoshi::internals::assemble::world_transform(
            &plain.compiled.bindings,
            &plain.compiled.layers,
        )
        .scale;
        let size = (shown.frames[ViewId::FIRST].height * 1.5 * SCALE) as u32;
        let half = f64::from(size) / 2.0 * meters / SCALE;
        let halfway = |character: &Character| {
            let scene = &character.compiled.scene;
            let sheet = Sheet {
                corner: scene.nodes[scene.roots[0]].translation + (up - right) * half,
                right,
                up,
                pixel: meters / SCALE,
            };
            picture(scene, &sheet, [size; 2])
        };
        let [plain, backed] = [halfway(&plain), halfway(&backed)];
        let (mut covered, mut different) = (0, 0);
        for (at, (before, after)) in plain.pixels.iter().zip(&backed.pixels).enumerate() {
            // Along borders, more edges in a pixel mean more samples.
            if before[3] == 255 && plain.is_even(at, 1) {
                covered += 1;
                different += usize::from(!is_alike(*before, *after));
            }
            filled += usize::from(after[3] > before[3]);
        }
        assert!(covered > 5000, "{name}: {covered}");
        // With sides from behind there are more stops, between which places are rounded.
        assert!(
            different * 2000 <= covered,
            "{name}: {different} of {covered}"
        );
    }
    assert!(filled > 1000, "{filled} pixels");
}

/// What a viewer in a direction sees of a character, in a square around its middle.
fn seen_from(character: &Character, direction: [f64; 2]) -> Picture {
    let Compiled {
        scene,
        characters,
        bindings,
        layers,
        ..
    } = &character.compiled;
    let [right, up, _] = view_axes(direction);
    let meters = okoshi::internals::assemble::world_transform(bindings, layers).scale;
    let size = (characters[0].frames[ViewId::FIRST].height * 1.5 * SCALE) as u32;
    let half = f64::from(size) / 2.0 * meters / SCALE;
    let sheet = Sheet {
        corner: scene.nodes[scene.roots[0]].translation + (up - right) * half,
        right,
        up,
        pixel: meters / SCALE,
    };
    picture(scene, &sheet, [size; 2])
}

impl Picture {
    fn flipped(&self) -> Self {
        let rows = self.pixels.chunks(self.width);
        Self {
            width: self.width,
            pixels: rows.flat_map(|row| row.iter().rev().copied()).collect(),
        }
    }

    /// Of the pixels away from borders that one of two pictures shows, the share in which they are alike.
    fn same(&self, other: &Self, is_same: impl Fn([u8; 4], [u8; 4]) -> bool) -> f64 {
        let (mut all, mut same) = (0, 0);
        for (at, (own, shown)) in self.pixels.iter().zip(&other.pixels).enumerate() {
            if (own[3] > 0 || shown[3] > 0) && self.is_even(at, 2) {
                all += 1;
                same += usize::from(is_same(*own, *shown));
            }
        }
        assert!(all > 5000, "{all} pixels");
        same as f64 / all as f64
    }
}

#[test]
fn symmetric_characters_turn_both_ways_from_two_drawings() {
    for name in ["bird", "robot"] {
        let mirrored = character(name);
        let views = &mirrored.compiled.characters[0].turn.views;
        let [theta, phi] = views[ViewId::from(1)];
        assert!(views.contains(&[-theta, phi]), "{name}: {views:?}");
        for share in [0.5, 1.0, 2.0] {
            let [one, other] =
                [theta, -theta].map(|theta| seen_from(&mirrored, [share * theta, phi]));
            let same = one.same(&other.flipped(), is_alike);
            // The robot's buttons keep their colours.
            assert!(same > 0.985, "{name} from {share} of {theta}: {same}");
        }
        // Without, it stays as it is from the front.
        let off = edited(name, |text| {
            text.replace("$View 0 0<", "$View 0 0 Mirror off<")
        });
        let [front, side] = [0.0, -theta].map(|theta| seen_from(&off, [theta, phi]));
        assert!(front.same(&side, is_alike) > 0.999, "{name}");
    }
}

#[test]
fn a_badge_stays_on_its_side_in_mirrored_views() {
    let boy = character("boy");
    let region = |name: &str| {
        let mut regions = boy.compiled.characters[0].regions.iter();
        regions
            .find(|region| region.name == name)
            .expect("a region")
    };
    let mirrored = ViewId::from(2);
    let [right, _, _] = view_axes(boy.compiled.characters[0].turn.views[mirrored]);
    let x = |name: &str, view: ViewId, right: glam::DVec3| region(name).positions[view].dot(right);
    // From its right, the badge on its left chest is nearer to the far border of the shirt.
    let badge = x("Badge", mirrored, right);
    assert!(region("Badge").is_shown[mirrored]);
    assert!(badge > x("Shirt", mirrored, right), "{badge}");
    // What is seen of the left arm from the left is seen of the right one here.
    let [left, _, _] = view_axes(boy.compiled.characters[0].turn.views[ViewId::from(1)]);
    for [one, other] in [["Left arm", "Right arm"], ["Left eye", "Right eye"]] {
        let at = [x(one, ViewId::from(1), left), x(other, mirrored, right)];
        assert!((at[0] + at[1]).abs() < 1e-9, "{one}: {at:?}");
    }
}

#[test]
fn a_stick_in_one_hand_is_seen_from_both_sides_and_moves_nothing_else() {
    let stick = |[x, y]: [f64; 2]| {
        format!(
            r##"<path inkscape:label="Stick" fill="#3fae49" d="M 195,300 199,300 {x},{y} {},{y} Z"/><text"##,
            x - 4.0
        )
    };
    let with_stick = edited("boy", |text| {
        let views = text.split_inclusive("<text").collect::<Vec<_>>();
        let [front, side, third, rest] = views[..] else {
            panic!("{} pieces", views.len());
        };
        let side = side.replace(
            "<text",
            &stick([439.0, 140.0]).replace("195,300 199", "395,300 399"),
        );
        format!(
            "{}{side}{third}{rest}",
            front.replace("<text", &stick([254.0, 140.0]))
        )
    });
    let plain = character("boy");
    let [with_stick, plain] = [&with_stick, &plain].map(|who| &who.compiled.characters[0]);
    assert_eq!(with_stick.sides.len(), 1);
    let mirrored = ViewId::from(2);
    let region = |who: &okoshi::internals::billboard::Character, name: &str| {
        let mut regions = who.regions.iter();
        let region = regions.find(|region| region.name == name);
        region.expect("a region").positions.clone()
    };
    for name in ["Left arm", "Right arm", "Head", "Badge", "Right shoe"] {
        let [own, other] = [with_stick, plain].map(|who| region(who, name));
        for (own, other) in own.iter().zip(&other) {
            assert!(own.distance(*other) < 0.01, "{name}: {own} is not {other}");
        }
    }
    // In the left hand it is on the right of the picture, from the right, too.
    let [right, _, _] = view_axes(with_stick.turn.views[mirrored]);
    let stick = region(with_stick, "Stick")[mirrored].dot(right);
    let hand = region(with_stick, "Left hand")[mirrored].dot(right);
    assert!(stick > hand && hand > 0.0, "{stick}, {hand}");
    let mut regions = with_stick.regions.iter();
    let stick = regions.find(|region| region.name == "Stick");
    assert!(stick.is_some_and(|stick| stick.is_shown[mirrored]));
}

#[test]
fn from_behind_a_character_is_its_silhouette_without_a_face() {
    for name in ["bird", "boy", "robot"] {
        let backed = edited(name, |text| {
            text.replace("$View 0 0<", "$View 0 0 Backing<")
        });
        let [front, back] = [0.0, 180.0].map(|theta| seen_from(&backed, [theta, 0.0]));
        let seen = |a: [u8; 4], b: [u8; 4]| (a[3] == 255) == (b[3] == 255);
        let same = front.same(&back.flipped(), seen);
        assert!(same > 0.999, "{name}: {same}");
        // Eyes are nearly white, and nothing of the body is.
        let white = |picture: &Picture| {
            let pixels = picture.pixels.iter();
            pixels
                .filter(|pixel| pixel.iter().all(|channel| *channel > 230))
                .count()
        };
        assert!(white(&front) > 100 && white(&back) == 0, "{name}");
        // All around, there is no hole where a face was.
        for theta in (0..360).step_by(15) {
            let seen = seen_from(&backed, [f64::from(theta), 0.0]);
            let shown = seen.pixels.iter().filter(|pixel| pixel[3] == 255).count();
            let whole = front.pixels.iter().filter(|pixel| pixel[3] == 255).count();
            assert!(
                shown * 10 > whole * 6,
                "{name} from {theta}: {shown} of {whole}"
            );
        }
        let off = character(name);
        let views = &off.compiled.characters[0].turn.views;
        assert!(views.iter().all(|view| view[0].abs() < 90.0), "{views:?}");
    }
}

#[test]
fn a_face_under_hair_keeps_its_colour_until_the_hair_covers_it() {
    let boy = edited("boy", |text| {
        text.replace("$View 0 0<", "$View 0 0 Backing<")
    });
    let (skin, hair) = ([247.0, 201.0, 160.0], [122.0, 74.0, 33.0]);
    for theta in [-120.0, -90.0, -60.0, 60.0, 75.0, 90.0, 105.0, 120.0] {
        let seen = seen_from(&boy, [theta, 0.0]);
        let count = |mixed: f64| {
            let color: [f64; 3] = [0, 1, 2].map(|i| skin[i] + mixed * (hair[i] - skin[i]));
            let is_it =
                |pixel: &&[u8; 4]| (0..3).all(|i| (f64::from(pixel[i]) - color[i]).abs() < 3.0);
            seen.pixels.iter().filter(is_it).count()
        };
        let darker: usize = (1..20).map(|step| count(f64::from(step) / 20.0)).sum();
        assert!(
            count(0.0) > 100 && 5 * darker < count(0.0),
            "from {theta}: {darker} of {}",
            count(0.0)
        );
    }
}

#[test]
fn feature_points_tie_places_of_outlines_together() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/view-feature-points");
    let text = fs::read_to_string(folder.join("drawing.svg")).expect("a drawing");
    let goes_to = |text: &str, from: [f64; 2]| {
        let compiled = common::compiled(text, &MemoryResolver::default());
        let mut regions = compiled.characters[0].regions.iter();
        let region = regions.find(|region| region.name == "card");
        let region = region.expect("a region");
        let points = &region.meshes[0].morph.points.raw;
        let from = glam::DVec2::from(from);
        let mut corners = points[0].iter();
        let corner = corners.position(|point| point.distance(from) < 0.1);
        points[1][corner.expect("a corner")]
    };
    // The square turns by a quarter.
    for (from, to) in [([20.0, 20.0], [178.0, 20.0]), ([80.0, 20.0], [178.0, 80.0])] {
        let found = goes_to(&text, from);
        assert!(found.distance(glam::DVec2::from(to)) < 0.1, "{found}");
    }
    let without = text.replace("^a", "#a").replace("^b", "#b");
    let found = goes_to(&without, [20.0, 20.0]);
    assert!(
        found.distance(glam::DVec2::new(122.0, 20.0)) < 0.1,
        "{found}"
    );
}

#[test]
fn what_a_set_depth_hides_is_found() {
    let resolver = MemoryResolver::default();
    let look = |character: &Character| {
        okoshi::internals::look::compare(&character.compiled, &character.text, &resolver, 400)
            .expect("a look")
    };
    let boy = look(&character("boy"));
    assert!(boy.right > 0.998 && boy.parts.len() > 30, "{}", boy.right);
    let hidden = edited("boy", |text| {
        let nose = text.find("id=\"nose-0\"").expect("a nose");
        let end = nose + text[nose..].find("/>").expect("an end");
        let string = "><desc>Nose$Depth -300</desc></path>";
        format!("{}{string}{}", &text[..end], &text[end + 2..])
    });
    let found = okoshi::internals::look::hints(&hidden.compiled, &look(&hidden));
    let [hint] = &found[..] else {
        panic!("{found:?}");
    };
    assert!(
        hint.message.contains("`Head` is seen there"),
        "{}",
        hint.message
    );
}

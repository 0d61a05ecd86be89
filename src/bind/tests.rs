mod motions;

use super::matching::Strokes;
use super::*;
use crate::compile::{Compiled, Options, compile};
use crate::diagnostic::Code;
use crate::resolver::MemoryResolver;
use crate::svg::ShapeId;
use glam::{DQuat, DVec2, DVec3};

/// Compiles a page of 200 by 200 with these elements.
fn drawing(elements: &str) -> Compiled {
    let source = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="200">{elements}</svg>"#
    );
    compile(&source, &Options::default(), &MemoryResolver::default())
}

/// A square of 20 units with this centre and description.
fn square(x: i32, y: i32, desc: &str) -> String {
    filled(x, y, "#888888", desc)
}

fn filled(x: i32, y: i32, fill: &str, desc: &str) -> String {
    let desc = match desc {
        "" => String::new(),
        desc => format!("<desc>{desc}</desc>"),
    };
    let (x, y) = (x - 10, y - 10);
    format!(r#"<rect x="{x}" y="{y}" width="20" height="20" fill="{fill}">{desc}</rect>"#)
}

fn text(x: i32, y: i32, text: &str) -> String {
    format!(r#"<text x="{x}" y="{y}" font-size="4">{text}</text>"#)
}

fn part(compiled: &Compiled, name: &str) -> PartId {
    let parts = &compiled.bindings.parts;
    parts.position(|part| part.name == name).unwrap()
}

fn has(compiled: &Compiled, code: Code) -> bool {
    compiled
        .diagnostics
        .iter()
        .any(|diagnostic| diagnostic.code == code)
}

#[test]
fn each_rule_binds_what_the_rules_before_it_leave() {
    let group = format!("<g>{}{}</g>", square(60, 20, ""), text(150, 100, "Grouped"));
    let line = r##"<path d="M 34 152 L 155 155" fill="none" stroke="#000000"/>"##;
    let elements = [
        square(20, 20, "Described$"),
        group,
        square(155, 155, ""),
        text(25, 155, "Led"),
        line.to_owned(),
        square(20, 100, ""),
        text(60, 110, "Near"),
    ];
    let compiled = drawing(&elements.concat());
    for (name, by) in [
        ("Described", BoundBy::Desc),
        ("Grouped", BoundBy::Group),
        ("Led", BoundBy::Leader),
        ("Near", BoundBy::Nearest),
    ] {
        let part = &compiled.bindings.parts[part(&compiled, name)];
        let string = &compiled.bindings.strings[part.string.unwrap()];
        assert_eq!(string.binding.unwrap().by, by, "{name}");
    }
    let center = |name| {
        compiled.bindings.parts[part(&compiled, name)]
            .measure
            .center
    };
    assert_eq!(center("Led"), DVec2::new(155.0, 155.0));
    assert_eq!(center("Near"), DVec2::new(20.0, 100.0));
}

#[test]
fn the_closest_pair_is_bound_first() {
    // Both strings are nearest to the left square; the closer one gets it.
    let elements = [
        square(20, 50, ""),
        square(120, 50, ""),
        text(60, 50, "Second$"),
        text(22, 50, "First$"),
    ];
    let compiled = drawing(&elements.concat());
    let x = |name| {
        compiled.bindings.parts[part(&compiled, name)]
            .measure
            .center
            .x
    };
    assert_eq!([x("First"), x("Second")], [20.0, 120.0]);
}

#[test]
fn strings_in_a_group_of_several_stay_in_it() {
    // Without the container, the squares outside would be nearer.
    let group = [
        square(150, 150, ""),
        square(180, 150, ""),
        text(20, 22, "Inner$"),
        text(60, 22, "Other$"),
    ];
    let elements = [
        square(20, 20, ""),
        square(60, 20, ""),
        format!("<g>{}</g>", group.concat()),
    ];
    let compiled = drawing(&elements.concat());
    for name in ["Inner", "Other"] {
        let center = compiled.bindings.parts[part(&compiled, name)]
            .measure
            .center;
        assert_eq!(center.y, 150.0, "{name}");
    }
}

#[test]
fn texts_grouped_by_themselves_are_where_their_group_is() {
    let shapes = square(20, 20, "") + &square(60, 20, "");
    let outside = square(150, 150, "");
    for (left, right) in [("Left$", "Right$"), ("Left", "Right")] {
        let texts = text(20, 20, left) + &text(60, 20, right);
        let each = format!(
            "<g>{}</g><g>{}</g>",
            text(20, 20, left),
            text(60, 20, right)
        );
        for elements in [
            format!("{shapes}<g>{texts}</g>"),
            format!("{shapes}<g><g>{texts}</g></g>"),
            format!("<g>{shapes}</g><g>{texts}</g>"),
            format!("{outside}<g>{shapes}<g>{texts}</g></g>"),
            format!("{outside}<g>{shapes}{each}</g>"),
        ] {
            let compiled = drawing(&elements);
            assert!(!has(&compiled, Code::NoPartLeft), "{elements}");
            for (name, x) in [("Left", 20.0), ("Right", 60.0)] {
                let part = &compiled.bindings.parts[part(&compiled, name)];
                assert_eq!(part.measure.center.x, x, "{elements}");
            }
        }
    }
}

#[test]
fn a_string_too_many_has_no_part() {
    let one = drawing(&(square(20, 20, "") + &text(20, 20, "A$")));
    assert!(!has(&one, Code::NoPartLeft));
    let two = [square(20, 20, ""), text(20, 20, "A$"), text(50, 20, "B$")];
    assert!(has(&drawing(&two.concat()), Code::NoPartLeft));
}

#[test]
fn own_strings_win_over_legends_and_legends_over_defaults() {
    let elements = [
        filled(20, 20, "#ff0000", "Own$Smooth 40"),
        filled(60, 20, "#ff0000", "OfLegend$"),
        filled(100, 20, "#0000ff", "OfDefault$"),
        filled(180, 150, "#ff0000", ""),
        text(180, 150, "$Smooth 20 Offset 2"),
        text(10, 190, "%Smooth 10"),
        text(50, 190, "%Metallic 0.5"),
    ];
    let compiled = drawing(&elements.concat());
    let bindings = &compiled.bindings;
    let expected = [
        ("Own", 40.0, SetBy::Own, 2.0),
        ("OfLegend", 20.0, SetBy::Legend, 2.0),
        ("OfDefault", 10.0, SetBy::Default, 0.0),
    ];
    for (name, crease, from, offset) in expected {
        let part = part(&compiled, name);
        let attributes = bindings.attributes(part);
        assert_eq!(attributes.crease(), crease, "{name}");
        assert_eq!(
            attributes.offset().map_or(0.0, |offset| offset.value),
            offset
        );
        let resolved = bindings.resolved(&compiled.drawing, part);
        let smooth = resolved
            .iter()
            .find(|resolved| resolved.keyword.name() == "Smooth");
        assert_eq!(smooth.unwrap().from, from, "{name}");
        assert_eq!(attributes.segments(), None, "the program's default");
        let factors = bindings.material_factors(&compiled.drawing, part);
        assert_eq!([factors.metallic, factors.roughness], [0.5, 0.9]);
    }
    let span = bindings.span_of(
        &bindings
            .attributes(part(&compiled, "Own"))
            .offset()
            .unwrap()
            .source,
    );
    let legend = &bindings.strings[bindings.legends[0].string];
    assert!(span.start > legend.text.whole().start && span.end <= legend.text.whole().end);
}

#[test]
fn color_replaces_the_fill_and_alpha_its_opacity() {
    let elements = [
        filled(20, 20, "#ff0000", "Filled$"),
        filled(60, 20, "#ff0000", "Colored$Color 0 1 0 0.5"),
        filled(100, 20, "#ff0000", "Clear$Color 0 1 0 0.5 Alpha 0.25"),
    ];
    let compiled = drawing(&elements.concat());
    let color = |name| {
        let part = part(&compiled, name);
        compiled
            .bindings
            .material_factors(&compiled.drawing, part)
            .color
    };
    assert_eq!(color("Filled"), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(color("Colored"), [0.0, 1.0, 0.0, 0.5]);
    assert_eq!(color("Clear"), [0.0, 1.0, 0.0, 0.25]);
}

#[test]
fn settings_of_the_drawing_have_defaults() {
    let settings = |strings: &str| drawing(&(square(20, 20, "A$") + strings)).bindings.settings;
    let default = settings("");
    assert_eq!(default.scale, 1.0);
    assert_eq!(default.axes, DQuat::IDENTITY);
    assert_eq!(default.ground, None);
    assert_eq!(default.bind, BindRule::Meant);
    // A description tells nothing of other shapes; a text does.
    assert_eq!(default.strokes, Strokes::All);
    let named = settings(&text(20, 20, "B"));
    assert_eq!(named.strokes, Strokes::Visible);
    let said = settings(&text(100, 100, "%Shape round"));
    assert_eq!(said.strokes, Strokes::Ink);
    assert_eq!(
        drawing(&square(20, 20, "")).bindings.settings.strokes,
        Strokes::All
    );
    let strings = "%Scale 2 Axes +x -z +y Ground 30 40 Bind outline Strokes all";
    let set = settings(&text(100, 100, strings));
    assert_eq!(set.scale, 2.0);
    assert!((set.axes * DVec3::Y).distance(-DVec3::Z) < 1e-12);
    assert_eq!(set.ground, Some(DVec2::new(30.0, 40.0)));
    assert_eq!(set.bind, BindRule::Nearest(DistanceMode::Outline));
    assert_eq!(set.strokes, Strokes::All);
    let page = settings(&text(100, 100, "%Ground page Strokes lines"));
    assert_eq!(
        (page.ground, page.strokes),
        (Some(DVec2::ZERO), Strokes::Lines)
    );
}

#[test]
fn group_strings_make_layers_of_tiles_and_regions() {
    let group = |string: &str, x| format!("<g>{}{}</g>", square(x, 20, ""), text(x, 60, string));
    let elements = [
        group("Island$Tiles 20", 20),
        group("Boy$View 45 0", 60),
        group("Boy$Pose 1.5", 100),
        square(150, 150, "Rock$"),
    ];
    let compiled = drawing(&elements.concat());
    let bindings = &compiled.bindings;
    let layers = bindings.layers.iter();
    let layers: Vec<_> = layers
        .map(|layer| (layer.kind, layer.name.as_str()))
        .collect();
    let expected = [
        (LayerKind::Tiles, "Island"),
        (LayerKind::View, "Boy"),
        (LayerKind::Pose, "Boy"),
    ];
    assert_eq!(layers, expected);
    let tile_layers: Vec<LayerId> = bindings.tile_layers().map(|(index, _)| index).collect();
    assert_eq!(tile_layers, [LayerId::from(0)]);
    // Squares by number: that of the map is a tile, that of the view a region, that of the pose a copy, which is no shape of the
    // drawing, and no group string belongs to a part.
    let kinds: Vec<PartKind> = bindings.parts.iter().map(|part| part.kind).collect();
    let main = PartKind::Main;
    assert_eq!(kinds, [PartKind::Tile, PartKind::Region, main]);
    assert!(bindings.layers.iter().all(|layer| {
        let string = &bindings.strings[layer.string];
        string.binding.is_none() && !matching::wants_part(&string.annotation)
    }));
    let group_of = |shape: usize| compiled.drawing.shapes[ShapeId::from(shape)].group;
    let in_layers = in_layers_of_pixels(&compiled.drawing);
    assert!(in_layers[group_of(0)] && in_layers[group_of(1)] && !in_layers[group_of(2)]);
    assert_eq!(compiled.drawing.poses.copies.len(), 1);
    assert_eq!(bindings.tile_layer_of_group(group_of(0)), Some(0.into()));
    assert_eq!(bindings.tile_layer_of_group(group_of(1)), None);
    assert_eq!(bindings.view_of_group(group_of(1)), Some(1.into()));
    assert_eq!(bindings.layers.of_group(group_of(2)), None);
    assert_eq!(
        bindings
            .layer_attributes(0.into())
            .tile_size()
            .unwrap()
            .value,
        20.0
    );
}

#[test]
fn two_strings_cannot_make_layers_of_one_group() {
    let group = |second: &str| {
        let strings = text(20, 60, "Island$Tiles 20") + &text(20, 80, second);
        drawing(&format!("<g>{}{strings}</g>", square(20, 20, "")))
    };
    assert!(has(&group("Other$Tiles 10"), Code::TwoStrings));
    assert!(has(&group("Boy$View 0 0"), Code::TwoStrings));
    assert!(!has(&group("Boy$Pose 1"), Code::TwoStrings));
}

#[test]
fn joints_lie_at_the_end_near_the_parent() {
    let arm = |desc: &str| {
        let arm = format!(
            r##"<rect x="40" y="15" width="60" height="10" fill="#888888"><desc>{desc}</desc></rect>"##
        );
        let compiled = drawing(&(square(20, 20, "Body$") + &arm));
        compiled.bindings.parts[part(&compiled, "Arm")].origin
    };
    let near = DVec2::new(40.0, 20.0);
    let far = DVec2::new(100.0, 20.0);
    let middle = DVec2::new(70.0, 20.0);
    let expected = [
        ("Arm@Body", near),
        ("Arm@Body$Origin end", far),
        ("Arm@Body$Origin start", near),
        ("Arm@Body$Shape -c roundv", middle),
        ("Arm@Body$Shape -c roundv Origin end", far),
        ("Arm@Body$Origin 7 9", DVec2::new(7.0, 9.0)),
        ("Arm$", middle),
    ];
    for (desc, expected) in expected {
        let origin = arm(desc);
        assert!(origin.distance(expected) < 1e-6, "{desc}: {origin}");
    }
}

#[test]
fn parts_without_strings_are_named_and_hang_on_the_nearest_named_part() {
    let elements = [
        square(20, 20, "A$"),
        square(180, 20, "U-1$"),
        square(150, 20, ""),
        square(50, 20, ""),
    ];
    let compiled = drawing(&elements.concat());
    let bindings = &compiled.bindings;
    let found = bindings.parts.iter().map(|part| {
        let parent = part
            .parent
            .map(|parent| bindings.parts[parent].name.as_str());
        (part.name.as_str(), parent)
    });
    let found: Vec<_> = found.collect();
    let expected = [
        ("A", None),
        ("U-1", None),
        ("U-2", Some("U-1")),
        ("U-3", Some("A")),
    ];
    assert_eq!(found, expected);
}

#[test]
fn a_cycle_of_parents_is_broken_at_one_part() {
    let elements = [
        square(20, 20, "A@C"),
        square(60, 20, "B@A"),
        square(100, 20, "C@B"),
    ];
    let compiled = drawing(&elements.concat());
    assert!(has(&compiled, Code::ParentCycle));
    let parts = compiled.bindings.parts.iter();
    assert_eq!(parts.filter(|part| part.parent.is_none()).count(), 1);
}

/// A figure of rectangles with texts.
fn figure_of_rectangles(texts: &str) -> Compiled {
    let rectangle = |id: &str, [x, y, width, height]: [i32; 4]| {
        format!(r#"<rect id="{id}" x="{x}" y="{y}" width="{width}" height="{height}"/>"#)
    };
    let shapes = [
        rectangle("s1", [80, 60, 40, 60]),
        rectangle("s2", [84, 20, 32, 40]),
        rectangle("s3", [80, 120, 16, 60]),
        rectangle("s4", [104, 120, 16, 60]),
        rectangle("s5", [60, 62, 20, 10]),
        rectangle("s6", [120, 62, 20, 10]),
    ];
    drawing(&format!("{}{texts}", shapes.concat()))
}

/// The id of the shape that a name is bound to.
fn bound_shape(compiled: &Compiled, name: &str) -> String {
    let shape = compiled.bindings.parts[part(compiled, name)].shape;
    let id = &compiled.drawing.shapes[shape].element.id;
    id.clone().unwrap_or_default()
}

#[test]
fn words_decide_between_what_lies_about_equally_near() {
    // The same places, and other words.
    for (words, found) in [
        (["Head$", "Torso$"], ["s2", "s1"]),
        (["Torso$", "Head$"], ["s1", "s2"]),
        (["頭$", "胴$"], ["s2", "s1"]),
        (["胴$", "頭$"], ["s1", "s2"]),
        // Words that nobody knows are bound by place alone, whatever they are.
        (["Quux$", "Zork$"], ["s2", "s1"]),
        (["Zork$", "Quux$"], ["s2", "s1"]),
    ] {
        let texts = [text(86, 61, words[0]), text(104, 62, words[1])].concat();
        let compiled = figure_of_rectangles(&texts);
        let names = words.map(|word| word.trim_end_matches('$'));
        assert_eq!(names.map(|name| bound_shape(&compiled, name)), found);
    }
}

#[test]
fn words_never_outweigh_a_text_that_lies_well_on_something() {
    let texts = [text(88, 40, "Leg$"), text(82, 150, "Head$")].concat();
    let compiled = figure_of_rectangles(&texts);
    let found = ["Leg", "Head"].map(|name| bound_shape(&compiled, name));
    assert_eq!(found, ["s2", "s3"]);
}

#[test]
fn what_the_drawing_calls_so_is_meant() {
    let shapes = r#"<rect id="lamp" x="20" y="20" width="40" height="40"/>
        <rect id="blade" x="62" y="20" width="40" height="40"/>"#;
    for (name, found) in [("Lamp", "lamp"), ("Blade", "blade"), ("Quux", "blade")] {
        let text = text(57, 43, &format!("{name}$"));
        let compiled = drawing(&format!("{shapes}{text}"));
        assert_eq!(bound_shape(&compiled, name), found);
    }
}

#[test]
fn ground_takes_no_name_of_a_limb() {
    let sky = r#"<rect id="sky1" width="200" height="100"/><rect id="ground1" y="100" width="200" height="100"/>"#;
    let figure = r#"<circle id="s1" cx="100" cy="80" r="12"/><rect id="s2" x="90" y="92" width="20" height="60"/>"#;
    // Far from everything else.
    let texts = [
        text(8, 20, "Head$"),
        text(12, 180, "Leg$"),
        text(150, 20, "Sky$"),
    ]
    .concat();
    let compiled = drawing(&format!("{sky}{figure}{texts}"));
    let found = ["Head", "Leg", "Sky"].map(|name| bound_shape(&compiled, name));
    assert_eq!(found, ["s1", "s2", "sky1"]);
}

#[test]
fn wheels_are_discs_unless_a_string_says_shape() {
    use crate::solid::Profile;
    let circle = |x: i32, radius: i32, name: &str| {
        format!(
            r##"<circle cx="{x}" cy="100" r="{radius}" fill="#222222"><desc>{name}</desc></circle>"##
        )
    };
    let wheels = circle(50, 20, "Wheel$") + &circle(150, 10, "Ball$");
    let depths = |compiled: &Compiled, name: &str| {
        let part = part(compiled, name);
        let profile = compiled.bindings.profile(&compiled.drawing, part);
        let profile = profile.unwrap();
        let is_disc = matches!(profile, Profile::Default(_));
        (is_disc, profile.numbers())
    };
    let first_look = drawing(&wheels);
    let (is_disc, depth) = depths(&first_look, "Wheel");
    assert!(is_disc);
    // A circle is a polygon here, a little narrower than its diameter of 40.
    let is_half = |number: f64| (number.abs() - 7.0).abs() < 0.05;
    assert!(is_half(depth[0]) && is_half(depth[1]), "{depth:?}");
    assert!(!depths(&first_look, "Ball").0);
    let chosen = drawing(&(wheels + &text(100, 190, "%Shape inflate")));
    assert!(!depths(&chosen, "Wheel").0);
}

/// Of very many rounded shapes the smallest are plates: all that are inflated are larger.
#[test]
fn small_shapes_of_a_crowd_are_plates() {
    let circles = |count: usize| {
        let circle = |index: usize| {
            let (x, y) = (index % 100 * 2, index / 100 * 2);
            let radius = 0.2 + 0.001 * (index * 7919 % 500) as f64;
            format!(r##"<circle cx="{x}" cy="{y}" r="{radius}" fill="#888888"/>"##)
        };
        drawing(&(0..count).map(circle).collect::<String>())
    };
    let said = |compiled: &Compiled| {
        let found = compiled.diagnostics.iter();
        let mut found = found.filter(|found| found.code == Code::FirstLook);
        found.next().unwrap().message.clone()
    };
    assert!(said(&circles(500)).ends_with("500 rounded shapes are inflated"));
    let crowd = circles(3000);
    let (small, large): (Vec<&Part>, Vec<&Part>) = crowd
        .bindings
        .parts
        .iter()
        .partition(|part| part.is_too_fine);
    let width = |part: &&Part| part.measure.half_across;
    let largest = small.iter().map(width).fold(0.0, f64::max);
    let smallest = large.iter().map(width).fold(f64::INFINITY, f64::min);
    // Of 36 to 60 points each.
    assert!((500..2_500).contains(&large.len()), "{}", large.len());
    assert!(largest <= smallest, "{largest} {smallest}");
    let counts = [large.len(), small.len()];
    let message = format!(
        "{} rounded shapes are inflated, and {} small shapes are plates so that the model stays small",
        counts[0], counts[1]
    );
    assert!(said(&crowd).ends_with(&message), "{}", said(&crowd));
}

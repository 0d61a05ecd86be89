//! What `check --look` counts, and says.

use okoshi::compile::Compiled;
use okoshi::diagnostic::Code;
use okoshi::internals::look::{DrawnView, Instead, Look, compare, hints};
use okoshi::resolver::MemoryResolver;
use resvg::tiny_skia::{Pixmap, Transform};

use crate::common;
use crate::truth::picture;

/// A drawing on a page that does not begin at the origin.
fn page(body: &str) -> String {
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="300mm" viewBox="-20 10 100 80.5">{body}</svg>"#
    )
}

/// Compiles and compares a drawing without links.
fn looked_at(text: &str) -> (Compiled, Look) {
    let resolver = MemoryResolver::default();
    let compiled = common::compiled(text, &resolver);
    assert!(!compiled.has_errors(), "{:?}", compiled.diagnostics);
    let look = compare(&compiled, text, &resolver, 200).expect("a look");
    (compiled, look)
}

/// Asserts that the picture of a drawing's model is the picture of the drawing.
fn assert_same_picture(text: &str) {
    let compiled = common::compiled(text, &MemoryResolver::default());
    assert!(!compiled.has_errors(), "{:?}", compiled.diagnostics);
    let view = DrawnView::new(&compiled, compiled.scene.clone(), 2.0).expect("a page");
    assert_eq!(view.size, [200, 161]);
    let picture = picture(&view, &MemoryResolver::default());
    let plain = text.replace("width=\"300mm\"", "width=\"100\" height=\"80.5\"");
    let tree = usvg::Tree::from_str(&plain, &usvg::Options::default()).expect("a drawing");
    let mut drawn = Pixmap::new(200, 161).expect("a pixmap");
    let twice = Transform::from_scale(2.0, 2.0);
    resvg::render(&tree, twice, &mut drawn.as_mut());
    for (at, (pixel, drawn)) in picture.pixels().zip(drawn.pixels()).enumerate() {
        let drawn = drawn.demultiply();
        let drawn = [drawn.red(), drawn.green(), drawn.blue(), drawn.alpha()];
        let apart = (0..4).map(|channel| pixel.0[channel].abs_diff(drawn[channel]));
        assert!(
            apart.max() <= Some(2),
            "{text}: pixel {}, {}: {:?}, not {drawn:?}",
            at % 200,
            at / 200,
            pixel.0
        );
    }
}

#[test]
fn the_picture_lies_on_the_drawing() {
    let shapes = r##"<rect x="-10" y="20" width="60" height="40" fill="#3060c0"/>
        <rect x="10" y="30" width="60" height="40" fill="#f0d020" opacity="0.5"/>
        <rect x="40" y="15" width="20" height="30" fill="#000000" fill-opacity="0.25"/>"##;
    for strings in ["", "%Axes +x +z -y", "%Scale 7 Ground 3 4"] {
        assert_same_picture(&page(&format!(
            r#"{shapes}<text x="0" y="85" font-size="5">{strings}</text>"#
        )));
    }
}

#[test]
fn transparency_groups_are_translucent_as_a_whole() {
    let shapes = r##"<rect x="-10" y="20" width="60" height="40" fill="#3060c0"/>
        <rect x="0" y="30" width="20" height="20" fill="#ffffff"/>
        <rect x="5" y="35" width="5" height="5" fill="#000000"/>
        <rect x="30" y="50" width="30" height="20" fill="#f0d020" stroke="#804000" stroke-width="4"/>"##;
    let behind = r##"<rect x="-15" y="40" width="90" height="10" fill="#c04040"/>"##;
    for strings in ["", "%Shape default Strokes all", "%Shape round Strokes all"] {
        assert_same_picture(&page(&format!(
            r#"{behind}<g opacity="0.5">{shapes}</g><text x="0" y="89" font-size="5">{strings}</text>"#
        )));
    }
}

#[test]
fn what_is_not_meant_to_be_built_is_not_compared() {
    let (_, look) = looked_at(&page(
        r##"<rect x="0" y="20" width="40" height="40" fill="#3060c0"/>
        <text x="20" y="40" font-size="5">Body$Shape default</text>
        <rect x="50" y="20" width="20" height="20" fill="#000000" stroke="#ff0000" stroke-width="6"/>
        <text x="60" y="30" font-size="5">*</text>
        <path d="M 5 85 H 60" stroke="#00ff00" stroke-width="0.3" fill="none"/>"##,
    ));
    assert_eq!((look.right, look.right_without_lines), (1.0, 1.0));
    assert_eq!(look.lines, None);
    assert_eq!(look.parts.len(), 1);
    // What is near the border of the only part does not count.
    assert_eq!(look.pixels, 76 * 76);
}

#[test]
fn lines_that_are_not_built_are_missing() {
    let body = |strokes: &str| {
        page(&format!(
            r##"<rect x="0" y="20" width="40" height="40" fill="#3060c0" stroke="#ff0000" stroke-width="6"/>
            <text x="20" y="40" font-size="5">Body$Shape default</text>
            <path d="M 5 80 H 65" stroke="#00a000" stroke-width="8" fill="none"/>
            <text x="0" y="15" font-size="5">{strokes}</text>"##
        ))
    };
    // Of the outline 46 × 46 − 34 × 34 squares of two pixels, of the line 60 × 8.
    let (outline, line) = (4.0 * (46.0 * 46.0 - 34.0 * 34.0), 4.0 * 60.0 * 8.0);
    for (strokes, missing, built_by) in [
        ("", outline + line, Some("all")),
        ("%Strokes none", outline + line, Some("all")),
        ("%Strokes lines", outline, Some("all")),
        ("%Strokes all", 0.0, None),
    ] {
        let (_, look) = looked_at(&body(strokes));
        let lines = look.lines;
        assert_eq!(lines.map(|lines| lines.built_by), built_by, "{strokes}");
        let pixels = lines.map_or(0.0, |lines| lines.share * look.pixels as f64);
        assert!(
            (pixels - missing).abs() < 0.01 * missing + 1.0,
            "{strokes}: {pixels}"
        );
        assert_eq!(look.right_without_lines, 1.0, "{strokes}");
        let wrong = (1.0 - look.right) * look.pixels as f64;
        assert!((wrong - pixels).abs() < 1.0, "{strokes}: {wrong} {pixels}");
    }
    let (_, look) = looked_at(&body("").replace(" stroke=\"#ff0000\"", ""));
    let lines = look.lines.expect("a line is missing");
    assert_eq!(lines.built_by, "lines");
    assert!(
        (lines.share * look.pixels as f64 - line).abs() < 1.0,
        "{lines:?}"
    );
}

#[test]
fn colors_that_strings_give_are_right() {
    let (_, look) = looked_at(&page(
        r##"<rect x="0" y="20" width="40" height="40" fill="#3060c0"/>
        <text x="20" y="40" font-size="5">Body$Color 1 0 0</text>"##,
    ));
    assert_eq!(look.right, 1.0);
}

#[test]
fn a_part_behind_another_is_reported() {
    let body = |eye: &str| {
        page(&format!(
            r##"<rect x="0" y="20" width="40" height="40" fill="#3060c0"/>
            <text x="5" y="50" font-size="5">Head$Shape default -4 4</text>
            <ellipse cx="20" cy="35" rx="9" ry="6" fill="#ff0000"/>
            <text x="20" y="35" font-size="5">Eye@Head{eye}</text>"##
        ))
    };
    let (compiled, look) = looked_at(&body("$Offset 1"));
    assert_eq!(look.right, 1.0);
    assert_eq!(hints(&compiled, &look), []);
    let (compiled, look) = looked_at(&body("$Offset -30"));
    assert!((0.8..0.98).contains(&look.right), "{}", look.right);
    let eye = look.parts[1];
    assert_eq!(eye.right, 0);
    assert_eq!(eye.instead, Some((Instead::Part(0.into()), eye.pixels)));
    let found = hints(&compiled, &look);
    let [hint] = found.as_slice() else {
        panic!("{found:?}");
    };
    assert_eq!(hint.code, Code::LooksDifferent);
    assert_eq!(
        hint.message,
        "`Eye` shows 0 % of what is drawn of it: it is inside or behind `Head`, which is drawn before it"
    );
    let help = "take away or change the depth that is given for `Eye` and `Head`";
    assert_eq!(hint.help.as_deref(), Some(help));
}

#[test]
fn what_peeks_out_under_a_high_pile_is_not_in_front() {
    // Of 160 discs, all but the topmost show a narrow edge, as in a shaded cylinder. A bar is drawn over all of them.
    let disc = |i: u32| {
        let (y, red) = (300 - i, 0x20 + i);
        format!(r##"<ellipse cx="200" cy="{y}" rx="120" ry="60" fill="#{red:02x}4080"/>"##)
    };
    let discs: String = (0..160).map(disc).collect();
    let (compiled, look) = looked_at(&format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="400" height="400">{discs}
        <rect x="180" y="100" width="40" height="220" fill="#f0c000"/></svg>"##
    ));
    assert!(look.right > 0.98, "{}", look.right);
    let bar = look.parts.iter().max_by_key(|look| look.part);
    let bar = bar.expect("parts that are looked at");
    assert_eq!(compiled.bindings.parts.len(), 161);
    assert!(bar.share() > 0.95, "{}", bar.share());
}

#[test]
fn landscapes_look_as_drawn_at_their_places() {
    let (_, look) = looked_at(&page(
        r##"<g><text x="-20" y="5" font-size="5">Land$Tiles 10</text>
        <rect x="-20" y="20" width="60" height="20" fill="#4caf50"/>
        <rect x="-20" y="40" width="60" height="10" fill="#8d6e63"/></g>
        <g><text x="50" y="5" font-size="5">Isle$Tiles 5</text>
        <rect x="50" y="70" width="20" height="5" fill="#4caf50"/>
        <rect x="50" y="75" width="20" height="15" fill="#8d6e63"/></g>
        <rect x="0" y="25" width="10" height="20" fill="#ff0000"/>"##,
    ));
    assert!(look.right > 0.999, "{}", look.right);
    assert_eq!(look.parts.len(), 1);
    assert_eq!(look.parts[0].right, look.parts[0].pixels);
}

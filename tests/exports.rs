//! Drawings as Inkscape, Illustrator, Figma and Affinity export them, with names in the layers panel and no string: parts have those
//! names, and hang on what they touch.

mod common;

use okoshi::diagnostic::Code;
use okoshi::internals::bind::{PartId, PartKind};
use okoshi::resolver::MemoryResolver;

/// A shape: its colour, centre and radii, and the angle by which it is turned.
type Shape = (&'static str, [f64; 2], [f64; 2], f64);

/// Something that is drawn: its name, the name of what carries it, and its shapes. An empty name is none.
type FigurePart = (&'static str, &'static str, &'static [Shape]);

const SIZE: [f64; 2] = [200.0, 300.0];

const SKIN: &str = "#ffcc99";
const SHIRT: &str = "#3366cc";
const TROUSERS: &str = "#333366";

const PERSON: &[FigurePart] = &[
    (
        "Left arm",
        "Body",
        &[(SHIRT, [145.0, 120.0], [12.0, 45.0], -20.0)],
    ),
    (
        "Left hand",
        "Left arm",
        &[(SKIN, [162.0, 166.0], [11.0, 11.0], 0.0)],
    ),
    (
        "Left leg",
        "Hips",
        &[(TROUSERS, [118.0, 230.0], [13.0, 50.0], 0.0)],
    ),
    (
        "Left foot",
        "Left leg",
        &[("#222222", [123.0, 281.0], [20.0, 8.0], 0.0)],
    ),
    (
        "Right leg",
        "Hips",
        &[(TROUSERS, [82.0, 230.0], [13.0, 50.0], 0.0)],
    ),
    (
        "Right foot",
        "Right leg",
        &[("#222222", [77.0, 281.0], [20.0, 8.0], 0.0)],
    ),
    (
        "Hips",
        "Body",
        &[(TROUSERS, [100.0, 178.0], [32.0, 20.0], 0.0)],
    ),
    ("Body", "", &[(SHIRT, [100.0, 125.0], [36.0, 55.0], 0.0)]),
    ("Neck", "Body", &[(SKIN, [100.0, 72.0], [8.0, 14.0], 0.0)]),
    (
        "Head",
        "Neck",
        &[
            (SKIN, [100.0, 42.0], [24.0, 28.0], 0.0),
            ("#000000", [91.0, 38.0], [3.0, 4.0], 0.0),
            ("#000000", [109.0, 38.0], [3.0, 4.0], 0.0),
        ],
    ),
    (
        "Hat",
        "Head",
        &[("#884400", [100.0, 18.0], [30.0, 7.0], 0.0)],
    ),
    (
        "Right arm",
        "Body",
        &[(SHIRT, [55.0, 120.0], [12.0, 45.0], 20.0)],
    ),
    (
        "Right hand",
        "Right arm",
        &[(SKIN, [38.0, 166.0], [11.0, 11.0], 0.0)],
    ),
];

const DOG: &[FigurePart] = &[
    (
        "Tail",
        "Body",
        &[("#775533", [172.0, 120.0], [30.0, 6.0], -40.0)],
    ),
    (
        "Hind leg",
        "Body",
        &[("#775533", [145.0, 190.0], [11.0, 40.0], 0.0)],
    ),
    (
        "Hind paw",
        "Hind leg",
        &[("#ffffff", [140.0, 229.0], [15.0, 7.0], 0.0)],
    ),
    (
        "Front leg",
        "Body",
        &[("#775533", [65.0, 190.0], [11.0, 40.0], 0.0)],
    ),
    (
        "Front paw",
        "Front leg",
        &[("#ffffff", [60.0, 229.0], [15.0, 7.0], 0.0)],
    ),
    (
        "Body",
        "",
        &[("#886644", [105.0, 150.0], [60.0, 26.0], 0.0)],
    ),
    (
        "Head",
        "Body",
        &[("#886644", [45.0, 115.0], [25.0, 22.0], 0.0)],
    ),
    (
        "Ear",
        "Head",
        &[("#553311", [62.0, 104.0], [7.0, 18.0], 0.0)],
    ),
    (
        "Eye",
        "Head",
        &[("#000000", [38.0, 110.0], [3.0, 3.0], 0.0)],
    ),
    (
        "Nose",
        "Head",
        &[("#000000", [21.0, 118.0], [5.0, 4.0], 0.0)],
    ),
];

const BIRD: &[FigurePart] = &[
    (
        "Tail",
        "Body",
        &[("#2255aa", [168.0, 165.0], [34.0, 9.0], 15.0)],
    ),
    (
        "Leg_L",
        "Body",
        &[("#ddaa00", [92.0, 210.0], [4.0, 25.0], 0.0)],
    ),
    (
        "Leg_R",
        "Body",
        &[("#ddaa00", [112.0, 210.0], [4.0, 25.0], 0.0)],
    ),
    (
        "Foot_L",
        "Leg_L",
        &[("#ddaa00", [86.0, 236.0], [14.0, 4.0], 0.0)],
    ),
    (
        "Foot_R",
        "Leg_R",
        &[("#ddaa00", [118.0, 236.0], [14.0, 4.0], 0.0)],
    ),
    (
        "Body",
        "",
        &[("#3377dd", [100.0, 155.0], [45.0, 35.0], 0.0)],
    ),
    (
        "Head",
        "Body",
        &[("#3377dd", [60.0, 110.0], [22.0, 22.0], 0.0)],
    ),
    (
        "Beak",
        "Head",
        &[("#ff8800", [34.0, 112.0], [12.0, 5.0], 0.0)],
    ),
    (
        "Wing",
        "Body",
        &[("#2255aa", [112.0, 150.0], [32.0, 14.0], 20.0)],
    ),
];

const ROBOT_JA: &[FigurePart] = &[
    ("胴", "", &[("#888899", [100.0, 140.0], [40.0, 45.0], 0.0)]),
    ("頭", "胴", &[("#aaaabb", [100.0, 75.0], [26.0, 24.0], 0.0)]),
    ("目", "頭", &[("#000000", [100.0, 75.0], [15.0, 4.0], 0.0)]),
    (
        "右腕",
        "胴",
        &[("#888899", [52.0, 140.0], [10.0, 40.0], 10.0)],
    ),
    (
        "左腕",
        "胴",
        &[("#888899", [148.0, 140.0], [10.0, 40.0], -10.0)],
    ),
    (
        "右手",
        "右腕",
        &[("#666677", [45.0, 183.0], [11.0, 9.0], 0.0)],
    ),
    (
        "左手",
        "左腕",
        &[("#666677", [155.0, 183.0], [11.0, 9.0], 0.0)],
    ),
    (
        "右脚",
        "胴",
        &[("#888899", [80.0, 215.0], [12.0, 38.0], 0.0)],
    ),
    (
        "左脚",
        "胴",
        &[("#888899", [120.0, 215.0], [12.0, 38.0], 0.0)],
    ),
];

/// Nothing of it is in the vocabulary: the largest part is the root.
const LAMP: &[FigurePart] = &[
    (
        "stand",
        "cone",
        &[("#444444", [100.0, 190.0], [6.0, 80.0], 0.0)],
    ),
    (
        "plinth",
        "stand",
        &[("#222222", [100.0, 270.0], [45.0, 10.0], 0.0)],
    ),
    ("cone", "", &[("#ffdd66", [100.0, 90.0], [60.0, 45.0], 0.0)]),
    (
        "knob",
        "plinth",
        &[("#cc0000", [120.0, 262.0], [5.0, 5.0], 0.0)],
    ),
];

/// Two of its parts have one name, one has none.
const SNAKE: &[FigurePart] = &[
    (
        "segment",
        "",
        &[("#339933", [60.0, 150.0], [35.0, 18.0], 0.0)],
    ),
    (
        "segment-2",
        "segment",
        &[("#44aa44", [110.0, 150.0], [30.0, 15.0], 0.0)],
    ),
    (
        "tip",
        "segment-2",
        &[("#55bb55", [150.0, 150.0], [20.0, 8.0], 0.0)],
    ),
    (
        "U-1",
        "segment",
        &[("#ff0000", [20.0, 150.0], [12.0, 3.0], 0.0)],
    ),
];

/// What a program writes for a name: the attributes that begin an element.
type Attributes = fn(&str, &mut usize) -> String;

fn next(counter: &mut usize) -> usize {
    *counter += 1;
    *counter
}

/// The name as the person wrote it: programs write names that are taken a second time.
fn written(name: &str) -> &str {
    match name {
        "segment-2" => "segment",
        "U-1" => "",
        name => name,
    }
}

/// An id of a program, and a label of the person.
fn inkscape(name: &str, counter: &mut usize) -> String {
    let id = 1000 + 7 * next(counter);
    match written(name) {
        "" => format!("id=\"path{id}-3\""),
        name => format!("id=\"g{id}\" inkscape:label=\"{name}\""),
    }
}

/// Only an id, changed by the person in the object's properties.
fn inkscape_ids(name: &str, counter: &mut usize) -> String {
    let number = next(counter);
    match (name, written(name)) {
        (_, "") => format!("id=\"ellipse{number}\""),
        // Inkscape keeps ids unique itself.
        ("segment-2", _) => "id=\"segment-2\"".to_owned(),
        (_, name) => format!("id=\"{}\"", name.replace(' ', "_")),
    }
}

/// Illustrator up to 2015: signs are escaped, ids that are taken get a number.
fn illustrator(name: &str, counter: &mut usize) -> String {
    let number = next(counter);
    match written(name) {
        "" => format!("id=\"XMLID_{number}_\""),
        text => {
            let id = text.replace('_', "_x5F_").replace(' ', "_x20_");
            let copy = if text == name { "" } else { "_2_" };
            format!("id=\"{id}{copy}\"")
        }
    }
}

/// Illustrator today: the name beside an id made from it.
fn illustrator_cc(name: &str, counter: &mut usize) -> String {
    let number = next(counter);
    match written(name) {
        "" => format!("id=\"_Path_{number}\" data-name=\"&lt;Path&gt;\""),
        text => {
            let id = text.replace(' ', "_");
            let copy = if text == name {
                String::new()
            } else {
                format!("-{number}")
            };
            format!("id=\"{id}{copy}\" data-name=\"{text}\"")
        }
    }
}

/// Figma: names as they are; what is taken gets a number.
fn figma(name: &str, counter: &mut usize) -> String {
    let number = next(counter);
    match written(name) {
        "" => format!("id=\"Ellipse {number}\""),
        _ if name == "segment-2" => "id=\"segment-2\"".to_owned(),
        name => format!("id=\"{name}\""),
    }
}

/// Affinity: an id, and the name where it cannot be one.
fn affinity(name: &str, counter: &mut usize) -> String {
    let number = next(counter);
    match written(name) {
        "" => format!("id=\"Curve{number}\" serif:id=\"Curve {number}\""),
        text if text != name => format!("id=\"{text}{number}\" serif:id=\"{text}\""),
        text if text.contains(' ') => {
            format!("id=\"{}\" serif:id=\"{text}\"", text.replace(' ', "-"))
        }
        text => format!("id=\"{text}\""),
    }
}

/// How programs write a shape.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    /// An ellipse with a style, turned by a transform.
    Styled,
    /// A path with a class; the paints are the classes' numbers.
    Class,
    /// A path of curves with `fill`.
    Path,
    /// A path about the origin, moved by a matrix.
    Matrix,
}

fn shape(attributes: &str, (paint, [x, y], [rx, ry], degrees): Shape, form: Form) -> String {
    let class = CLASSES.iter().position(|known| *known == paint);
    // Four quarters of an ellipse, as programs write circles.
    let (sin, cos) = degrees.to_radians().sin_cos();
    let moved = form != Form::Matrix;
    let at = |u: f64, v: f64| {
        let (u, v) = (u * rx, v * ry);
        let turned = [u * cos - v * sin, u * sin + v * cos];
        let [left, top] = if moved { [x, y] } else { [0.0, 0.0] };
        format!("{:.3} {:.3}", turned[0] + left, turned[1] + top)
    };
    let k = 0.5523;
    let quarter = |[a, b]: [f64; 2], [c, d]: [f64; 2], [e, f]: [f64; 2]| {
        format!("C{} {} {}", at(a, b), at(c, d), at(e, f))
    };
    let path = [
        format!("M{}", at(1.0, 0.0)),
        quarter([1.0, k], [k, 1.0], [0.0, 1.0]),
        quarter([-k, 1.0], [-1.0, k], [-1.0, 0.0]),
        quarter([-1.0, -k], [-k, -1.0], [0.0, -1.0]),
        quarter([k, -1.0], [1.0, -k], [1.0, 0.0]),
        "Z".to_owned(),
    ]
    .concat();
    match form {
        Form::Styled => format!(
            "<ellipse {attributes} style=\"fill:{paint};fill-opacity:1;stroke:none\" cx=\"{x}\" cy=\"{y}\" rx=\"{rx}\" ry=\"{ry}\" \
             transform=\"rotate({degrees} {x} {y})\"/>\n"
        ),
        Form::Class => format!(
            "<path {attributes} class=\"st{}\" d=\"{path}\"/>\n",
            class.expect("a class")
        ),
        Form::Path => format!("<path {attributes} d=\"{path}\" fill=\"{paint}\"/>\n"),
        Form::Matrix => format!(
            "<g {attributes} transform=\"matrix(1,0,0,1,{x},{y})\"><path d=\"{path}\" style=\"fill:{paint};\"/></g>\n"
        ),
    }
}

/// The paints of all figures, which Illustrator writes as classes.
const CLASSES: &[&str] = &[
    SKIN, SHIRT, TROUSERS, "#222222", "#000000", "#884400", "#775533", "#ffffff", "#886644",
    "#553311", "#2255aa", "#ddaa00", "#3377dd", "#ff8800", "#888899", "#aaaabb", "#666677",
    "#444444", "#ffdd66", "#cc0000", "#339933", "#44aa44", "#55bb55", "#ff0000",
];

/// The pieces of a figure, those of several shapes as groups.
fn pieces(figure: &[FigurePart], attributes: Attributes, form: Form) -> String {
    let mut counter = 0;
    let mut out = String::new();
    for (name, _, shapes) in figure {
        let own = attributes(name, &mut counter);
        if let [only] = shapes {
            out += &shape(&own, *only, form);
        } else {
            let inner = shapes
                .iter()
                .map(|one| shape(&attributes("U-1", &mut counter), *one, form));
            out += &format!("<g {own}>\n{}</g>\n", inner.collect::<String>());
        }
    }
    out
}

fn inkscape_file(content: &str) -> String {
    let [width, height] = SIZE;
    format!(
        r##"<?xml version="1.0" encoding="UTF-8" standalone="no"?>
<!-- Created with Inkscape (http://www.inkscape.org/) -->
<svg width="{width}mm" height="{height}mm" viewBox="0 0 {width} {height}" version="1.1" id="svg5"
   xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd"
   xmlns="http://www.w3.org/2000/svg" xmlns:svg="http://www.w3.org/2000/svg">
  <sodipodi:namedview id="namedview7" pagecolor="#ffffff" inkscape:document-units="mm" inkscape:current-layer="layer1"/>
  <defs id="defs2"/>
  <g inkscape:label="Layer 1" inkscape:groupmode="layer" id="layer1" transform="translate(-3,4)">
{content}  </g>
</svg>
"##
    )
}

fn illustrator_file(content: &str) -> String {
    let [width, height] = SIZE;
    let classes = CLASSES.iter().enumerate();
    let classes: String = classes
        .map(|(number, paint)| format!("\t.st{number}{{fill:{};}}\n", paint.to_uppercase()))
        .collect();
    format!(
        r#"<?xml version="1.0" encoding="utf-8"?>
<!-- Generator: Adobe Illustrator 27.0.0, SVG Export Plug-In . SVG Version: 6.00 Build 0)  -->
<svg version="1.1" id="Layer_1" xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" x="0px" y="0px"
	 viewBox="0 0 {width} {height}" style="enable-background:new 0 0 {width} {height};" xml:space="preserve">
<style type="text/css">
{classes}</style>
{content}</svg>
"#
    )
}

fn figma_file(content: &str) -> String {
    let [width, height] = SIZE;
    format!(
        r##"<svg width="{width}" height="{height}" viewBox="0 0 {width} {height}" fill="none" xmlns="http://www.w3.org/2000/svg">
<g id="Frame 1" clip-path="url(#clip0_12_34)">
<rect width="{width}" height="{height}" fill="#D9D9D9"/>
<g id="Group 7">
{content}</g>
</g>
<defs>
<clipPath id="clip0_12_34">
<rect width="{width}" height="{height}" fill="white"/>
</clipPath>
</defs>
</svg>
"##
    )
}

fn affinity_file(content: &str) -> String {
    let [width, height] = SIZE;
    format!(
        r##"<?xml version="1.0" encoding="UTF-8" standalone="no"?>
<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">
<svg width="100%" height="100%" viewBox="0 0 {width} {height}" version="1.1" xmlns="http://www.w3.org/2000/svg"
  xmlns:xlink="http://www.w3.org/1999/xlink" xml:space="preserve" xmlns:serif="http://www.serif.com/"
  style="fill-rule:evenodd;clip-rule:evenodd;stroke-linejoin:round;stroke-miterlimit:2;">
    <g transform="matrix(1,0,0,1,-20,-30)">
        <g id="Artboard1" serif:id="Artboard 1" transform="matrix(1,0,0,1,20,30)">
            <rect x="0" y="0" width="{width}" height="{height}" style="fill:none;"/>
{content}        </g>
    </g>
</svg>
"##
    )
}

/// A way to write a figure.
struct Program {
    name: &'static str,
    attributes: Attributes,
    form: Form,
    file: fn(&str) -> String,
    /// Whether it writes underscores for spaces.
    underscores: bool,
    /// Whether the frame's background is left out.
    background: bool,
}

const PROGRAMS: [Program; 6] = [
    Program {
        name: "Inkscape, labels",
        attributes: inkscape,
        form: Form::Styled,
        file: inkscape_file,
        underscores: false,
        background: false,
    },
    Program {
        name: "Inkscape, ids",
        attributes: inkscape_ids,
        form: Form::Styled,
        file: inkscape_file,
        underscores: true,
        background: false,
    },
    Program {
        name: "Illustrator, escapes",
        attributes: illustrator,
        form: Form::Class,
        file: illustrator_file,
        underscores: false,
        background: false,
    },
    Program {
        name: "Illustrator, data-name",
        attributes: illustrator_cc,
        form: Form::Class,
        file: illustrator_file,
        underscores: false,
        background: false,
    },
    Program {
        name: "Figma",
        attributes: figma,
        form: Form::Path,
        file: figma_file,
        underscores: false,
        background: true,
    },
    Program {
        name: "Affinity",
        attributes: affinity,
        form: Form::Matrix,
        file: affinity_file,
        underscores: false,
        background: false,
    },
];

/// Names and parents of the parts of a drawing, sorted.
fn hierarchy(drawing: &str) -> Vec<(String, String)> {
    let compiled = common::compiled(drawing, &MemoryResolver::default());
    let bindings = &compiled.bindings;
    let mains = bindings
        .parts
        .iter()
        .filter(|part| part.kind == PartKind::Main);
    let name =
        |part: Option<PartId>| part.map_or(String::new(), |part| bindings.parts[part].name.clone());
    let mut found: Vec<(String, String)> = mains
        .map(|part| (part.name.clone(), name(part.parent)))
        .collect();
    found.sort();
    found
}

#[test]
fn exported_drawings_have_the_names_of_their_layers() {
    let figures: [(&str, &[FigurePart]); 6] = [
        ("person", PERSON),
        ("dog", DOG),
        ("bird", BIRD),
        ("robot", ROBOT_JA),
        ("lamp", LAMP),
        ("snake", SNAKE),
    ];
    let mut drawings = 0;
    for (what, figure) in figures {
        for program in &PROGRAMS {
            let drawing = (program.file)(&pieces(figure, program.attributes, program.form));
            let spell = |name: &str| {
                if program.underscores {
                    name.replace(' ', "_")
                } else {
                    name.to_owned()
                }
            };
            let expected = figure
                .iter()
                .map(|(name, parent, _)| (spell(name), spell(parent)));
            let mut expected: Vec<(String, String)> = expected.collect();
            expected.sort();
            let about = format!("{what}, {}:\n{drawing}", program.name);
            assert_eq!(hierarchy(&drawing), expected, "{about}");
            let compiled = common::compiled(&drawing, &MemoryResolver::default());
            let codes: Vec<Code> = compiled
                .diagnostics
                .iter()
                .map(|found| found.code)
                .filter(|code| *code != Code::FirstLook)
                .collect();
            let backgrounds = if program.background {
                vec![Code::Background]
            } else {
                vec![]
            };
            assert_eq!(codes, backgrounds, "{about}");
            drawings += 1;
        }
    }
    assert!(drawings >= 25, "{drawings}");
}

/// Strings may refer to what labels name.
#[test]
fn strings_attach_to_labels() {
    let figure = pieces(PERSON, inkscape, Form::Styled);
    let text = "<text x=\"95\" y=\"20\" font-size=\"6\">Bonnet@\"Left hand\"$Offset 3</text>\n";
    let found = hierarchy(&inkscape_file(&format!("{figure}{text}")));
    let parent = |name: &str| {
        let mut found = found.iter();
        found
            .find(|(own, _)| own == name)
            .map(|(_, parent)| parent.as_str())
    };
    assert_eq!(parent("Bonnet"), Some("Left hand"));
    assert_eq!(parent("Hat"), None);
}

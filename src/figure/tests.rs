use glam::DVec3;

use crate::compile::{Compiled, Options, compile};
use crate::diagnostic::Code;
use crate::resolver::MemoryResolver;
use crate::scene::{Node, Scene};

/// Compiles a page of 200 by 200 with these elements; a unit is a centimetre.
fn drawing(elements: &str) -> Compiled {
    let source = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="200">{elements}</svg>"#
    );
    compile(&source, &Options::default(), &MemoryResolver::default())
}

fn rect([x, y, width, height]: [i32; 4], desc: &str) -> String {
    format!(
        r##"<rect x="{x}" y="{y}" width="{width}" height="{height}" fill="#888888"><desc>{desc}</desc></rect>"##
    )
}

fn node<'a>(scene: &'a Scene, name: &str) -> &'a Node {
    let mut nodes = scene.nodes.iter();
    nodes.find(|node| node.name == name).unwrap()
}

/// The least and the greatest corner of a node's mesh, in centimetres.
fn bounds(scene: &Scene, name: &str) -> [DVec3; 2] {
    let mesh = &scene.meshes[node(scene, name).mesh.unwrap()];
    let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    for primitive in &mesh.primitives {
        for position in &primitive.surface().positions {
            let position = DVec3::from(position.map(f64::from)) * 100.0;
            bounds = [bounds[0].min(position), bounds[1].max(position)];
        }
    }
    bounds
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-4
}

#[test]
fn meshes_lie_along_y_away_from_the_joint() {
    let elements = [
        rect([40, 40, 20, 20], "Body$"),
        rect([60, 45, 60, 10], "Right@Body"),
        rect([45, 60, 10, 60], "Down@Body"),
    ];
    let scene = drawing(&elements.concat()).scene;
    for name in ["Right", "Down"] {
        let [low, high] = bounds(&scene, name);
        assert!(
            close(low.y, 0.0) && close(high.y, 60.0),
            "{name}: {low} {high}"
        );
        assert!(
            close(low.x, -5.0) && close(high.x, 5.0),
            "{name}: {low} {high}"
        );
        // Turned back, +Y points the way in which the part is drawn.
        let way = node(&scene, name).rotation * DVec3::Y;
        let expected = if name == "Right" { DVec3::X } else { -DVec3::Y };
        assert!(way.distance(expected) < 1e-9, "{name}: {way}");
    }
    let joint = node(&scene, "Right").translation * 100.0;
    assert!(joint.distance(DVec3::new(10.0, 0.0, 0.0)) < 1e-6, "{joint}");
}

#[test]
fn the_middle_of_the_lower_edge_is_the_origin() {
    let elements = rect([20, 30, 40, 50], "Body$");
    let body = |strings: &str| {
        let scene = drawing(&(elements.clone() + strings)).scene;
        node(&scene, "Body").translation * 100.0
    };
    assert!(body("").distance(DVec3::new(0.0, 25.0, 0.0)) < 1e-6);
    let page = body(r#"<text x="150" y="150">%Ground page Scale 2</text>"#);
    assert!(
        page.distance(DVec3::new(80.0, -110.0, 0.0)) < 1e-6,
        "{page}"
    );
}

#[test]
fn what_bends_is_a_chain_of_nodes_and_so_is_its_copy() {
    let elements = [
        rect([40, 40, 20, 20], "Body$"),
        rect([60, 45, 60, 10], "Arm@Body$Shape -d roundv Offset 9 Bend 1"),
        rect([118, 45, 12, 10], "Hand@Arm$"),
    ];
    let scene = drawing(&elements.concat()).scene;
    for back in ["", ".back"] {
        let chain = ["Arm", "Arm.2a", "Arm.2b", "Arm.2c", "Arm.2", "Hand"]
            .map(|name| format!("{name}{back}"));
        let ids = chain.map(|name| {
            let found = scene.nodes.iter_enumerated();
            let mut found = found.filter(|(_, node)| node.name == name);
            found.next().unwrap_or_else(|| panic!("{name}")).0
        });
        for pair in ids.windows(2) {
            assert_eq!(scene.nodes[pair[0]].children, [pair[1]]);
        }
        assert_eq!(scene.nodes[ids[0]].bones, ids[1..5]);
        assert_eq!(ids.map(|id| scene.nodes[id].shares), [0, 0, 0, 0, 4, 0]);
        // The hand is where it is drawn, and as deep as the arm.
        let rest = scene.rest();
        let [arm, hand] = [ids[0], ids[5]].map(|id| rest[id].translation * 100.0);
        assert!(hand.distance(arm + DVec3::X * 58.0) < 1e-6, "{arm} {hand}");
    }
}

#[test]
fn a_sleeve_follows_the_bones_of_its_arm() {
    let elements = [
        rect([40, 40, 20, 20], "Body$"),
        rect([60, 45, 60, 10], "Arm@Body$Shape -d roundv Offset 9 Bend 1"),
        rect([62, 44, 46, 12], "Sleeve@Arm$"),
        rect([101, 44, 8, 12], "Cuff@Sleeve$"),
        rect([112, 44, 6, 12], "Bracelet@Arm$"),
        rect([88, 48, 3, 3], "Button@Arm$"),
        // Only its end is on the arm.
        rect([86, 50, 12, 40], "Flag@Arm$"),
    ];
    let scene = drawing(&elements.concat()).scene;
    for back in ["", ".back"] {
        let find = |name: &str| {
            let mut found = scene.nodes.iter_enumerated();
            let name = format!("{name}{back}");
            found.find(|(_, node)| node.name == name).unwrap().0
        };
        let [arm, sleeve, last] = ["Arm", "Sleeve", "Arm.2"].map(find);
        let bones = &scene.nodes[arm].bones;
        assert_eq!((bones.len(), bones.last()), (4, Some(&last)));
        assert_eq!(&scene.nodes[sleeve].bones, bones);
        assert!(scene.nodes[arm].children.contains(&sleeve));
        // What is past the elbow turns with the forearm, on the sleeve as well.
        for name in ["Cuff", "Bracelet"] {
            assert!(scene.nodes[last].children.contains(&find(name)), "{name}");
        }
        for name in ["Cuff", "Bracelet", "Button", "Flag"] {
            assert!(scene.nodes[find(name)].bones.is_empty(), "{name}");
        }
    }
}

#[test]
fn copies_have_names_of_their_own_and_follow_their_originals() {
    let elements = [
        rect([40, 40, 20, 20], "Body$"),
        rect([60, 45, 60, 10], "Arm@Body$Shape -d roundv Offset 9 Bend 0"),
        rect([120, 45, 30, 10], "Hand@Arm$Shape -d roundv Offset 4"),
    ];
    let scene = drawing(&elements.concat()).scene;
    let names: Vec<&str> = scene.nodes.iter().map(|node| node.name.as_str()).collect();
    let expected = [
        "Body",
        "Arm",
        "Hand",
        "Hand.back",
        "Arm.back",
        "Hand.back-2",
        "Hand.back.back",
    ];
    assert_eq!(names, expected);
    let depth = |name| node(&scene, name).translation.z * 100.0;
    assert!(close(depth("Arm"), 9.0) && close(depth("Arm.back"), -9.0));
    // On a mirrored node the original is mirrored, and its copy is not.
    assert!(close(depth("Hand.back-2"), -4.0) && close(depth("Hand.back.back"), 4.0));
    let [arm, back] = ["Arm", "Arm.back"].map(|name| node(&scene, name).children.len());
    assert_eq!([arm, back], [2, 2]);
}

#[test]
fn parts_drawn_later_stand_out_where_faces_would_coincide() {
    let shape = "Shape default 0 10";
    let elements = [
        rect([10, 10, 50, 50], &format!("First${shape}")),
        rect([20, 20, 50, 50], &format!("Second${shape}")),
        rect([30, 30, 50, 50], &format!("Third${shape}")),
        rect([120, 120, 50, 50], &format!("Apart${shape}")),
        rect([40, 40, 50, 50], "Other$Shape default 0 20"),
    ];
    let scene = drawing(&elements.concat()).scene;
    // A step is a five-hundredth of the larger extent. From behind, what is drawn first hides the others.
    for (name, back, front) in [
        ("First", 0.0, 10.0),
        ("Second", 0.1, 10.1),
        ("Third", 0.2, 10.2),
        ("Apart", 0.0, 10.0),
        ("Other", 0.3, 20.0),
    ] {
        let [low, high] = bounds(&scene, name);
        assert!(
            close(low.z, back) && close(high.z, front),
            "{name}: {low} {high}"
        );
    }
}

#[test]
fn a_default_offset_moves_a_node_once_with_its_sub_parts() {
    let group = |own: &str| {
        let main = rect([20, 20, 50, 50], "Body$Shape default 0 10");
        let sub = rect([100, 20, 20, 20], &format!("Sub$Shape default 0 10 {own}"));
        // A group that is alone on its page would not count.
        let other = rect([150, 150, 20, 20], "Other$");
        let scene = drawing(&format!(
            r#"<g>{main}{sub}</g>{other}<text x="150" y="190">%Offset 5</text>"#
        ));
        let scene = scene.scene;
        (
            node(&scene, "Body").translation.z * 100.0,
            bounds(&scene, "Body")[1].z,
        )
    };
    let (node, front) = group("");
    assert!(close(node, 5.0) && close(front, 10.0), "{node} {front}");
    let (node, front) = group("Offset 7");
    assert!(close(node, 5.0) && close(front, 17.0), "{node} {front}");
}

#[test]
fn copies_that_coincide_are_reported() {
    let has = |desc: &str| {
        let compiled = drawing(&rect([20, 20, 50, 50], desc));
        let mut diagnostics = compiled.diagnostics.iter();
        diagnostics.any(|diagnostic| diagnostic.code == Code::CopiesCoincide)
    };
    assert!(has("Body$Shape -d default -5 5"));
    assert!(has("Body$Shape -s roundv"));
    assert!(!has("Body$Shape -d default -5 5 Offset 9"));
    assert!(!has("Body$Shape -s default 5 8"));
    assert!(!has("Body$Shape default -5 5"));
}

#[test]
fn mirrored_solids_share_a_node_and_mirrored_copies_do_not() {
    let part = |desc: &str| {
        let scene = drawing(&rect([20, 20, 50, 50], desc)).scene;
        let [low, high] = bounds(&scene, "Body");
        (scene.nodes.len(), low.z, high.z)
    };
    let (nodes, low, high) = part("Body$Shape -s default 5 8");
    assert!(
        nodes == 1 && close(low, -8.0) && close(high, 8.0),
        "{nodes} {low} {high}"
    );
    let (nodes, low, high) = part("Body$Shape -d default 5 8");
    assert!(
        nodes == 2 && close(low, 5.0) && close(high, 8.0),
        "{nodes} {low} {high}"
    );
}

#[test]
fn outlines_of_soft_volumes_are_cords_as_deep_as_they_are_wide() {
    let shapes = [
        r#"<ellipse cx="100" cy="100" rx="60" ry="40""#,
        r#"<circle cx="100" cy="100" r="30""#,
        // A bean, a drop, and a ring with a hole.
        r#"<path d="M60 100c0-60 80-60 80 0c0 30-20 40-30 20c-8-14-16-14-20 0c-10 20-30 10-30-20z""#,
        r#"<path d="M100 40c10 40 40 50 40 80a40 40 0 0 1-80 0c0-30 30-40 40-80z""#,
        r#"<path fill-rule="evenodd" d="M40 100a60 60 0 0 1 120 0a60 60 0 0 1-120 0zM75 100a25 25 0 0 0 50 0a25 25 0 0 0-50 0z""#,
    ];
    for shape in shapes {
        let sides = |stroke: &str| -> Vec<[DVec3; 2]> {
            let scene = drawing(&format!(r##"{shape} fill="#e84" {stroke}/>"##)).scene;
            let bounds = |primitive: &crate::scene::Primitive| {
                let surface = primitive.surface();
                let all = surface
                    .positions
                    .iter()
                    .map(|at| DVec3::from(at.map(f64::from)) * 100.0);
                all.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], at| {
                    [low.min(at), high.max(at)]
                })
            };
            scene.meshes.raw[0].primitives.iter().map(bounds).collect()
        };
        let [plain] = sides("")[..] else {
            panic!("{shape}")
        };
        // What is translucent as a whole is built like what is opaque.
        for (width, opacity) in [(3.0, "1"), (6.0, "1"), (10.0, "1"), (6.0, ".5")] {
            let stroke = format!(r##"opacity="{opacity}" stroke="#123" stroke-width="{width}""##);
            let [fill, cord] = sides(&stroke)[..] else {
                panic!("{shape}")
            };
            let half = width / 2.0;
            let thick = [cord[0].z, cord[1].z];
            assert!(
                thick.iter().all(|z| (z.abs() - half).abs() < 0.05 * half),
                "{shape}: {thick:?}"
            );
            for axis in 0..2 {
                // A miter reaches farther than half the width.
                assert!(cord[0][axis] < plain[0][axis] - 0.98 * half, "{shape}");
                assert!(fill[0][axis] > plain[0][axis] + 0.98 * half, "{shape}");
                assert!(fill[1][axis] < plain[1][axis] - 0.98 * half, "{shape}");
            }
        }
        // Where gaps or what lies below would show, the volume is whole.
        for stroke in [
            r##"stroke="#123" stroke-width="6" stroke-dasharray="4""##,
            r##"fill-opacity=".5" stroke="#123" stroke-width="6""##,
            r##"opacity=".5" stroke-opacity=".5" stroke="#123" stroke-width="6""##,
        ] {
            let [fill, ..] = sides(stroke)[..] else {
                panic!("{shape}")
            };
            let apart = (fill[0] - plain[0]).truncate().length();
            assert!(apart < 0.01, "{shape} {stroke}: {fill:?}");
        }
    }
}

#[test]
fn feet_that_are_drawn_from_the_front_point_forward() {
    let figure = |foot: &str, extra: &str| {
        let label = |name: &str| format!(r#"inkscape:label="{name}""#);
        let elements = [
            format!(
                r#"<ellipse {} cx="80" cy="140" rx="10" ry="30"/>"#,
                label("Left leg")
            ),
            format!(
                r#"<ellipse {} cx="120" cy="140" rx="10" ry="30"/>"#,
                label("Right leg")
            ),
            format!(
                r#"<ellipse {} cx="80" cy="172" rx="14" ry="9"/>"#,
                label(foot)
            ),
            format!(
                r#"<ellipse {} cx="100" cy="90" rx="30" ry="35"/>"#,
                label("Body")
            ),
            format!(r#"<circle {} cx="100" cy="35" r="22"/>"#, label("Head")),
            extra.to_owned(),
        ];
        let source = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" width="200" height="200">{}</svg>"#,
            elements.concat()
        );
        let scene = compile(&source, &Options::default(), &MemoryResolver::default()).scene;
        let [low, high] = bounds(&scene, foot);
        [low.z, high.z]
    };
    let [back, front] = figure("Left shoe", "");
    assert!(front > 0.8 * 18.0 && front > 1.5 * -back, "{back} {front}");
    let [back, front] = figure("Left ball", "");
    assert!((front + back).abs() < 0.1 * front, "{back} {front}");
    let text = |string: &str| format!(r#"<text x="150" y="190">{string}</text>"#);
    let [back, front] = figure("Left shoe", &text("%Shape inflate"));
    assert!((front + back).abs() < 0.1 * front, "{back} {front}");
}

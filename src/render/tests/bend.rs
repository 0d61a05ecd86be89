use super::*;

const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];

/// A unit cube at the origin that extends to the right, up and to the front, with a colour for each face: top red, front green,
/// right side blue.
fn cube() -> [Shape; 3] {
    let face = |corners: [[f32; 3]; 4], color: [u8; 4]| {
        let [r, g, b] = [0, 1, 2].map(|channel| f32::from(color[channel]) / 255.0);
        let mut shape = shape(
            corners.map(Vec3::from).to_vec(),
            vec![[0, 1, 2], [0, 2, 3]],
            unlit(r, g, b, 1.0),
        );
        shape.node = json!({ "extensions": { "OKOSHI_view_dependent": { "bend": {} } } });
        shape
    };
    [
        face(
            [[0., 1., 1.], [1., 1., 1.], [1., 1., 0.], [0., 1., 0.]],
            RED,
        ),
        face(
            [[0., 0., 1.], [1., 0., 1.], [1., 1., 1.], [0., 1., 1.]],
            GREEN,
        ),
        face(
            [[1., 0., 1.], [1., 0., 0.], [1., 1., 0.], [1., 1., 1.]],
            BLUE,
        ),
    ]
}

fn used() -> Value {
    json!({ "extensionsUsed": ["OKOSHI_view_dependent"] })
}

fn seen_from(yaw: f64, pitch: f64, bend: bool) -> Options {
    Options {
        view: View { yaw, pitch },
        bend,
        ..front(240)
    }
}

/// Width and height in pixels of the coloured area, which must fill its bounding box except for the corners.
#[track_caller]
fn sides(image: &Image, color: [u8; 4]) -> [u32; 2] {
    let alike = |pixel: &image::Rgba<u8>| {
        (0..4).all(|channel| pixel.0[channel].abs_diff(color[channel]) < 100)
    };
    let places: Vec<[u32; 2]> = image
        .enumerate_pixels()
        .filter(|(_, _, pixel)| alike(pixel))
        .map(|(x, y, _)| [x, y])
        .collect();
    let side = |axis: usize| {
        let along = || places.iter().map(|place| place[axis]);
        along().max().unwrap() - along().min().unwrap() + 1
    };
    let sides = [side(0), side(1)];
    assert!(places.len() as u32 + 4 >= sides[0] * sides[1]);
    sides
}

#[test]
fn tops_and_fronts_are_full_squares_from_45_degrees() {
    let file = file(&cube(), &used());
    // From the right the blue side is the front.
    for (yaw, front) in [(0.0, GREEN), (90.0, BLUE)] {
        let image = picture(&file, &seen_from(yaw, 45.0, true));
        let (top, front) = (sides(&image, RED), sides(&image, front));
        for [width, height] in [top, front] {
            assert!(
                width.abs_diff(height) <= 1,
                "{yaw}: {width} by {height} pixels"
            );
        }
        // The picture is as high as the margin allows: the bent shape was framed.
        let high = top[1] + front[1];
        assert!((205..=212).contains(&high), "{high} pixels");
    }
    let plain = picture(&file, &seen_from(0.0, 45.0, false));
    let [width, height] = sides(&plain, RED);
    let ratio = f64::from(height) / f64::from(width);
    assert!((ratio - 0.5_f64.sqrt()).abs() < 0.02, "{ratio}");
    let front = sides(&plain, GREEN);
    assert!(front[0].abs_diff(width) <= 1 && front[1].abs_diff(height) <= 1);
}

#[test]
fn nothing_is_bent_from_the_ground_from_above_or_by_unknown_extensions() {
    let bent = file(&cube(), &used());
    let mut shapes = cube();
    for shape in &mut shapes {
        shape.node = json!({});
    }
    let plain = file(&shapes, &json!({}));
    for (yaw, pitch) in [(0.0, 0.0), (30.0, 0.0), (0.0, 90.0), (70.0, -90.0)] {
        let of = |file, bend| picture(file, &seen_from(yaw, pitch, bend));
        assert_eq!(of(&bent, true), of(&plain, true), "{yaw} {pitch}");
    }
    let of = |file, bend| picture(file, &seen_from(30.0, 40.0, bend));
    assert_eq!(of(&bent, false), of(&plain, true));
    assert_ne!(of(&bent, true), of(&plain, true));
    // Unknown kinds of view dependence are ignored.
    shapes[0].node = json!({ "extensions": { "OKOSHI_view_dependent": { "spin": {} } } });
    assert_eq!(of(&file(&shapes, &used()), true), of(&plain, true));
}

#[test]
fn a_turn_is_framed_for_all_its_views_in_both_projections() {
    let file = file(&cube(), &used());
    let model = read(&file, &MemoryResolver::default()).unwrap();
    let posed = PosedModel::new(&model, &model.rest()).unwrap();
    for projection in [Projection::Perspective, Projection::Orthographic] {
        let options = Options {
            projection,
            ..seen_from(20.0, 45.0, true)
        };
        let mut reaches = [240, 240, 0, 0];
        let each = |image: Image| {
            let [left, top, right, bottom] = extent(&image);
            let before = reaches;
            reaches = [
                left.min(before[0]),
                top.min(before[1]),
                right.max(before[2]),
                bottom.max(before[3]),
            ];
            Ok::<_, RenderError>(())
        };
        posed.turntable(&options, 8, each).unwrap();
        let [left, top, right, bottom] = reaches;
        assert!(
            left >= 13 && top >= 13 && right <= 227 && bottom <= 227,
            "{reaches:?}"
        );
        assert!((right - left).max(bottom - top) > 200, "{reaches:?}");
    }
}

/// The material index of each pixel in a picture of `window`, in rows.
fn seen(
    file: &[u8],
    view: View,
    bend: bool,
    window: [f64; 4],
    size: [u32; 2],
) -> Vec<Vec<Option<usize>>> {
    let model = read(file, &MemoryResolver::default()).unwrap();
    let posed = PosedModel::new(&model, &model.rest()).unwrap();
    let [left, top, width, height] = window;
    let window = Window {
        left,
        top,
        width,
        height,
    };
    let seen = posed
        .visible_surfaces(
            &Options {
                view,
                bend,
                size,
                ..Options::default()
            },
            window,
        )
        .unwrap();
    let numbers: Vec<_> = seen
        .iter()
        .map(|seen| seen.and_then(|seen| seen.material))
        .collect();
    numbers
        .chunks(size[0] as usize)
        .map(<[_]>::to_vec)
        .collect()
}

const DRAWN: View = View {
    yaw: 0.0,
    pitch: 45.0,
};

#[test]
fn each_tile_of_the_drawn_look_is_on_its_own_pixel() {
    let file_of_cube = file(&cube(), &used());
    let (none, top, front) = (None, Some(0), Some(1));
    // A point at height y of the plane z appears at row z - y: the top fills row -1, the front row 0.
    let rows = seen(&file_of_cube, DRAWN, true, [-1.0, 2.0, 3.0, 4.0], [3, 4]);
    let tile = |what| vec![none, what, none];
    assert_eq!(rows, [tile(none), tile(top), tile(front), tile(none)]);
    // With more pixels per tile each has its share; and a window may be small and anywhere.
    let rows = seen(&file_of_cube, DRAWN, true, [0.0, 1.0, 1.0, 2.0], [50, 100]);
    let filled = |what| vec![vec![what; 50]; 50];
    assert_eq!(rows, [filled(top), filled(front)].concat());
    // Pixels need not be square.
    let rows = seen(&file_of_cube, DRAWN, true, [0.0, 1.0, 1.0, 2.0], [1, 6]);
    assert_eq!(rows.concat(), [top, top, top, front, front, front]);
    // In true 3D the cube is lower, whatever else is in the scene.
    let rows = seen(&file_of_cube, DRAWN, false, [0.0, 1.0, 1.0, 2.0], [1, 200]);
    let count = |what| rows.iter().filter(|row| row[0] == what).count();
    assert_eq!([count(top), count(front), count(none)], [71, 71, 58]);
}

#[test]
fn the_bend_keeps_the_nodes_origin_and_turns_with_its_frame() {
    let mut shapes = cube();
    for shape in &mut shapes {
        shape.node["translation"] = json!([10, 5, -7]);
    }
    // The origin appears at height (5 + 7)/√2, and the cube around it at full size.
    let up = 12.0 * 0.5_f64.sqrt();
    let moved = file(&shapes, &used());
    let (top, front) = (Some(0), Some(1));
    let rows = seen(&moved, DRAWN, true, [10.0, up + 1.0, 1.0, 2.0], [1, 20]);
    assert_eq!(rows.concat(), [[top; 10], [front; 10]].concat());
    // Its own up is the world's -Z: a viewer in front looks down on it, and nothing is bent.
    for shape in &mut shapes {
        shape.node["translation"] = json!([0, 0, 0]);
        let turn = -std::f64::consts::FRAC_PI_4;
        shape.node["rotation"] = json!([turn.sin(), 0, 0, turn.cos()]);
    }
    let lying = file(&shapes, &used());
    let of = |bend| picture(&lying, &seen_from(0.0, 0.0, bend));
    assert_eq!(of(true), of(false));
    let of = |bend| picture(&lying, &seen_from(0.0, 45.0, bend));
    assert_ne!(of(true), of(false));
}

#[test]
fn children_of_a_bent_node_bend_with_it_once() {
    let mut shapes = cube();
    shapes[0].node["children"] = json!([1, 2]);
    let tree = file(&shapes, &used());
    let mut json: Value = serde_json::from_slice(&tree).unwrap();
    json["scenes"][0]["nodes"] = json!([0]);
    let tree = serde_json::to_vec(&json).unwrap();
    let flat = file(&cube(), &used());
    let of = |file: &[u8]| picture(file, &seen_from(25.0, 35.0, true));
    assert_eq!(of(&tree), of(&flat));
    for index in [1, 2] {
        json["nodes"][index]
            .as_object_mut()
            .unwrap()
            .remove("extensions");
    }
    assert_eq!(of(&serde_json::to_vec(&json).unwrap()), of(&flat));
}

#[test]
fn visible_surfaces_have_their_base_color_without_light() {
    let mut shape = square(Vec3::ZERO, 1.0, plain(0.5, 0.25, 1.0, 1.0));
    shape.more.push((
        "COLOR_0",
        "VEC4",
        5126,
        bytes([0.5, 1.0, 1.0, 1.0].repeat(4)),
    ));
    let behind = square(Vec3::new(1.0, 0.0, -1.0), 1.0, plain(0.0, 1.0, 0.0, 1.0));
    let clear = square(Vec3::new(0.0, 0.0, 1.0), 1.0, plain(1.0, 1.0, 1.0, 0.0));
    let file = file(&[shape, behind, clear], &json!({}));
    let model = read(&file, &MemoryResolver::default()).unwrap();
    let posed = PosedModel::new(&model, &model.rest()).unwrap();
    let window = Window {
        left: -1.0,
        top: 1.0,
        width: 4.0,
        height: 2.0,
    };
    let sized = |size| Options {
        view: FRONT,
        size,
        ..Options::default()
    };
    let found = posed.visible_surfaces(&sized([4, 1]), window).unwrap();
    let srgb = |light: f32| 1.055 * light.powf(1.0 / 2.4) - 0.055;
    let near = Some(VisibleSurface {
        material: Some(0),
        base: [0.25, 0.25, 1.0, 1.0],
        blended: [srgb(0.25), srgb(0.25), srgb(1.0), 1.0],
    });
    let far = Some(VisibleSurface {
        material: Some(1),
        base: [0.0, 1.0, 0.0, 1.0],
        blended: [0.0, srgb(1.0), 0.0, 1.0],
    });
    assert_eq!(found, [near, near, far, None]);
    let sizes = [[0, 1], [1, MAX_SIDE + 1]];
    for size in sizes {
        let error = posed.visible_surfaces(&sized(size), window).unwrap_err();
        assert!(matches!(error, RenderError::Size(..)));
    }
}

#[test]
fn an_invalid_extension_is_malformed() {
    for extension in [json!([]), json!({ "bend": true }), json!("bend")] {
        let mut shapes = cube();
        shapes[1].node = json!({ "extensions": { "OKOSHI_view_dependent": extension } });
        let error = read(&file(&shapes, &used()), &MemoryResolver::default()).unwrap_err();
        let message = error.to_string();
        assert!(
            message.contains("OKOSHI_view_dependent of node 1"),
            "{message}"
        );
    }
}

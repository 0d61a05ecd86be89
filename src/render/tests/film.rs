use super::*;

/// A red square of half a metre that moves ten metres to the right in two seconds, and rests for another.
fn walker(interpolation: &str) -> Vec<u8> {
    let shape = square(Vec3::ZERO, 0.25, unlit(1.0, 0.0, 0.0, 1.0));
    let places = [Vec3::ZERO, Vec3::X * 5.0, Vec3::X * 10.0];
    moving(shape, "translation", places, interpolation)
}

/// A shape with three keys, a second apart, and a closing key that repeats the last a second later.
pub(super) fn moving(shape: Shape, path: &str, rows: [Vec3; 3], interpolation: &str) -> Vec<u8> {
    let rows = rows.iter().chain(&rows[2..]).flat_map(|row| row.to_array());
    let keys = bytes([0.0, 1.0, 2.0, 3.0].into_iter().chain(rows));
    let mut root: Value = serde_json::from_slice(&file(&[shape], &json!({}))).unwrap();
    let uri = base64::engine::general_purpose::STANDARD.encode(&keys);
    let of = |name: &str| root[name].as_array().unwrap().len();
    let (buffer, view, accessor) = (of("buffers"), of("bufferViews"), of("accessors"));
    let mut append = |name: &str, value: Value| {
        root[name].as_array_mut().unwrap().push(value);
    };
    let uri = format!("data:application/octet-stream;base64,{uri}");
    append("buffers", json!({ "byteLength": keys.len(), "uri": uri }));
    append(
        "bufferViews",
        json!({ "buffer": buffer, "byteOffset": 0, "byteLength": 16 }),
    );
    append(
        "bufferViews",
        json!({ "buffer": buffer, "byteOffset": 16, "byteLength": 48 }),
    );
    let times = json!({
        "bufferView": view, "componentType": 5126, "count": 4, "type": "SCALAR", "min": [0], "max": [3],
    });
    append("accessors", times);
    append(
        "accessors",
        json!({ "bufferView": view + 1, "componentType": 5126, "count": 4, "type": "VEC3" }),
    );
    root["animations"] = json!([{
        "name": "walk",
        "channels": [{ "sampler": 0, "target": { "node": 0, "path": path } }],
        "samplers": [{ "input": accessor, "output": accessor + 1, "interpolation": interpolation }],
    }]);
    serde_json::to_vec(&root).unwrap()
}

fn model(bytes: &[u8]) -> Model {
    read(bytes, &MemoryResolver::default()).unwrap()
}

/// The first and the last column that contain red.
pub(super) fn red(image: &Image) -> (u32, u32) {
    let columns = image
        .enumerate_pixels()
        .filter(|(_, _, pixel)| pixel.0 == [255, 0, 0, 255])
        .map(|(x, _, _)| x);
    let (mut low, mut high) = (u32::MAX, 0);
    for x in columns {
        (low, high) = (low.min(x), high.max(x));
    }
    (low, high)
}

fn wide(width: u32) -> Options {
    Options {
        size: [width, 40],
        ..front(width)
    }
}

fn drawn(film: &Film<'_>, options: &Options, times: &[f64]) -> Vec<Image> {
    let mut images = vec![];
    let shooting = film.shooting(options).unwrap();
    let drawn = shooting.draw(times.iter().copied(), |image| {
        images.push(image);
        Ok::<(), RenderError>(())
    });
    drawn.unwrap();
    images
}

#[test]
fn a_moving_model_stays_in_the_picture() {
    let model = model(&walker("LINEAR"));
    let [clip] = model.clips() else {
        panic!("one clip")
    };
    assert_eq!((clip.name.as_str(), clip.seconds), ("walk", 3.0));
    for projection in [Projection::Orthographic, Projection::Perspective] {
        let options = Options {
            projection,
            ..wide(400)
        };
        let film = Film::new(&model, clip, [0.0, 3.0]).unwrap();
        let images = drawn(&film, &options, &[0.0, 1.0, 2.0, 3.0]);
        let columns: Vec<(u32, u32)> = images.iter().map(red).collect();
        // From border to border, and always completely visible.
        assert!((1..=4).contains(&columns[0].0), "{columns:?}");
        assert!((395..=398).contains(&columns[2].1), "{columns:?}");
        let width = columns[0].1 - columns[0].0;
        assert!((17..=20).contains(&width), "{columns:?}");
        for (low, high) in &columns {
            assert!((high - low).abs_diff(width) <= 1, "{columns:?}");
        }
        let middle = columns[1].0 + columns[1].1;
        assert!(middle.abs_diff(399) <= 2, "{columns:?}");
        assert!(images[2] == images[3]);
        // A part of the clip has its own framing.
        let film = Film::new(&model, clip, [0.0, 1.0]).unwrap();
        let (low, high) = red(&drawn(&film, &options, &[0.0])[0]);
        assert!(high - low > 30, "{low} {high}");
    }
}

#[test]
fn consecutive_frames_with_equal_poses_are_one_picture() {
    let linear = model(&walker("LINEAR"));
    let film = Film::new(&linear, &linear.clips()[0], [0.0, 3.0]).unwrap();
    let held = film.held_frames(24).unwrap();
    assert_eq!(held.len(), 49);
    assert_eq!((held[48].frames, held[48].time), (24, 2.0));
    assert!((held[48].seconds - 1.0).abs() < 1e-9);
    let step = model(&walker("STEP"));
    let whole = |fps: u32, span: [f64; 2]| {
        let film = Film::new(&step, &step.clips()[0], span).unwrap();
        film.held_frames(fps).unwrap()
    };
    let frames: Vec<u32> = whole(24, [0.0, 3.0])
        .iter()
        .map(|frame| frame.frames)
        .collect();
    assert_eq!(frames, [24, 24, 24]);
    // Durations that are not a whole number of frames are kept.
    for (fps, span, frames) in [
        (24, [0.5, 2.51], 49),
        (7, [0.0, 3.0], 21),
        (10, [0.0, 0.0], 1),
    ] {
        let held = whole(fps, span);
        assert_eq!(held.iter().map(|frame| frame.frames).sum::<u32>(), frames);
        let seconds: f64 = held.iter().map(|frame| frame.seconds).sum();
        let wanted = if span[1] > span[0] {
            span[1] - span[0]
        } else {
            0.1
        };
        assert!((seconds - wanted).abs() < 1e-9, "{seconds}");
    }
    let held = whole(24, [0.0, 400.0]);
    assert!(held.iter().all(|frame| frame.seconds <= 60.0));
    assert_eq!(held.iter().map(|frame| frame.frames).sum::<u32>(), 9600);
    let film = Film::new(&step, &step.clips()[0], [0.0, 1e9]).unwrap();
    let error = film.held_frames(24).unwrap_err().to_string();
    assert!(
        error.contains("would be 24000000000 frames, more than the limit of 10000"),
        "{error}"
    );
}

#[test]
fn a_film_strip_shows_times_side_by_side() {
    let model = model(&walker("STEP"));
    let film = Film::new(&model, &model.clips()[0], [0.0, 3.0]).unwrap();
    let reported = std::cell::Cell::new(0);
    let strip = film
        .film_strip(&wide(100), 4, |done| reported.set(done))
        .unwrap();
    assert_eq!((strip.dimensions(), reported.get()), ((400, 40), 4));
    let cells = drawn(&film, &wide(100), &[0.0, 1.0, 2.0, 3.0]);
    for (index, cell) in cells.iter().enumerate() {
        // Edges are better in a still picture.
        let part = image::imageops::crop_imm(&strip, index as u32 * 100, 0, 100, 40);
        assert_eq!(red(&part.to_image()), red(cell), "{index}");
    }
    assert!(cells[0] != cells[1] && cells[1] != cells[2] && cells[2] == cells[3]);
    let large = Options {
        size: [8192, 8192],
        ..wide(1)
    };
    let error = film.film_strip(&large, 2, |_| ()).unwrap_err();
    assert!(matches!(error, RenderError::FilmStripTooLarge(16384, 8192)));
}

#[test]
fn a_jumping_model_leaves_the_ground_below() {
    let ball = sphere(plain(0.8, 0.8, 0.8, 1.0));
    let places = [Vec3::ZERO, Vec3::Y * 5.0, Vec3::Y * 10.0];
    let model = model(&moving(ball, "translation", places, "LINEAR"));
    let clip = &model.clips()[0];
    let film = Film::new(&model, clip, [0.0, 3.0]).unwrap();
    let options = Options {
        size: [100, 400],
        view: View {
            yaw: 0.0,
            pitch: 15.0,
        },
        ..Options::default()
    };
    // Just below the ball, from its lowest pixel on.
    let shadow = |image: &Image| {
        let [_, top, _, bottom] = extent(image);
        assert!(bottom - top < 80, "{top} {bottom}");
        (bottom + 2..bottom + 20).any(|y| image.get_pixel(50, y).0[3] > 0)
    };
    let images = drawn(&film, &options, &[0.0, 1.0]);
    assert!(shadow(&images[0]));
    assert!(!shadow(&images[1]));
}

#[test]
fn a_model_scaled_to_zero_is_invisible() {
    let shape = square(Vec3::ZERO, 0.25, unlit(1.0, 0.0, 0.0, 1.0));
    let scales = [Vec3::ZERO, Vec3::ONE, Vec3::ONE];
    let model = model(&moving(shape, "scale", scales, "STEP"));
    let film = Film::new(&model, &model.clips()[0], [0.0, 3.0]).unwrap();
    let options = Options {
        background: Some([9, 8, 7]),
        ..wide(50)
    };
    let images = drawn(&film, &options, &[0.0, 1.0]);
    assert!(images[0].pixels().all(|pixel| pixel.0 == [9, 8, 7, 255]));
    assert!(red(&images[1]).0 < 25);
}

/// The walker in front of a large square that stays.
fn walker_before_a_wall() -> Model {
    let wall = square(Vec3::new(5.0, -0.2, -1.0), 8.0, unlit(0.0, 0.0, 1.0, 1.0));
    let mut root: Value = serde_json::from_slice(&walker("LINEAR")).unwrap();
    let mut wall: Value = serde_json::from_slice(&file(&[wall], &json!({}))).unwrap();
    let offset = |list: &str| root[list].as_array().unwrap().len();
    let [accessors, views, buffers, materials] =
        ["accessors", "bufferViews", "buffers", "materials"].map(offset);
    for view in wall["bufferViews"].as_array_mut().unwrap() {
        view["buffer"] = buffers.into();
    }
    for accessor in wall["accessors"].as_array_mut().unwrap() {
        let view = accessor["bufferView"].as_u64().unwrap();
        accessor["bufferView"] = (view + views as u64).into();
    }
    let primitive = &mut wall["meshes"][0]["primitives"][0];
    primitive["material"] = materials.into();
    primitive["indices"] = (primitive["indices"].as_u64().unwrap() + accessors as u64).into();
    for accessor in primitive["attributes"]
        .as_object_mut()
        .unwrap()
        .values_mut()
    {
        *accessor = (accessor.as_u64().unwrap() + accessors as u64).into();
    }
    wall["nodes"][0]["mesh"] = 1.into();
    for list in [
        "accessors",
        "bufferViews",
        "buffers",
        "materials",
        "meshes",
        "nodes",
    ] {
        let more = wall[list].as_array().unwrap().clone();
        root[list].as_array_mut().unwrap().extend(more);
    }
    root["scenes"][0]["nodes"] = json!([0, 1]);
    model(&serde_json::to_vec(&root).unwrap())
}

fn followed(model: &Model) -> Film<'_> {
    let film = Film::new(model, &model.clips()[0], [0.0, 3.0]).unwrap();
    film.following().unwrap()
}

#[test]
fn a_following_camera_keeps_the_figure_large() {
    for model in [model(&walker("LINEAR")), walker_before_a_wall()] {
        let film = followed(&model);
        let options = Options {
            size: [200, 100],
            ..front(200)
        };
        let images = drawn(&film, &options, &[0.0, 0.5, 1.0, 1.5, 2.5, 3.0]);
        for image in &images {
            let (low, high) = red(image);
            assert!(low > 0 && high < 199, "{low} {high}");
            // Without following it is 9 pixels wide.
            assert!(high - low > 20, "{low} {high}");
        }
        // It runs at one speed at first, so the camera does too.
        assert_eq!(red(&images[0]), red(&images[1]));
        let still = Film::new(&model, &model.clips()[0], [0.0, 3.0]).unwrap();
        let (low, high) = red(&drawn(&still, &options, &[0.0])[0]);
        assert!(high - low < 20, "{low} {high}");
    }
}

#[test]
fn the_ground_stays_in_the_world_while_the_camera_moves() {
    let model = model(&walker("LINEAR"));
    let film = followed(&model);
    let options = Options {
        size: [160, 160],
        view: View::default(),
        background: Some([255; 3]),
        ..Options::default()
    };
    // Lines are 0.1 m apart, and the square goes 5 m in a second.
    let images = drawn(&film, &options, &[0.3, 0.31, 0.32, 0.34]);
    let differences = |one: usize, other: usize| {
        let bytes = images[one].as_raw().iter().zip(images[other].as_raw());
        bytes.filter(|(a, b)| a.abs_diff(**b) > 4).count()
    };
    assert!(differences(0, 2) < 60, "{}", differences(0, 2));
    assert!(differences(0, 3) < 60, "{}", differences(0, 3));
    assert!(differences(0, 1) > 600, "{}", differences(0, 1));
    // The lines fade out before the border.
    for image in &images {
        for (x, y, pixel) in image.enumerate_pixels() {
            let border = x == 0 || y == 0 || x == 159 || y == 159;
            assert!(!border || pixel.0.iter().all(|value| *value > 250));
        }
    }
    // Without light they are visible too, on any background.
    let unlit = Options {
        shading: Shading::Unlit,
        background: None,
        ..options
    };
    let image = &drawn(&film, &unlit, &[0.3])[0];
    let gray = |pixel: &&image::Rgba<u8>| {
        let [r, g, b, alpha] = pixel.0;
        r == g && g == b && (90..=150).contains(&r) && alpha > 20
    };
    assert!(image.pixels().filter(gray).count() > 200);
}

#[test]
fn a_camera_has_nothing_to_follow_where_nothing_travels() {
    let shape = || square(Vec3::ZERO, 0.25, unlit(1.0, 0.0, 0.0, 1.0));
    let sizes = [Vec3::ONE, Vec3::splat(2.0), Vec3::ONE];
    let model = model(&moving(shape(), "scale", sizes, "LINEAR"));
    let still = Film::new(&model, &model.clips()[0], [0.0, 3.0]).unwrap();
    let images = drawn(&still, &wide(100), &[0.0, 1.0]);
    assert!(images == drawn(&followed(&model), &wide(100), &[0.0, 1.0]));
}

#[test]
fn pictures_of_films_are_close_to_still_ones() {
    let ball = sphere(plain(0.8, 0.5, 0.3, 1.0));
    let places = [Vec3::ZERO, Vec3::Y * 0.5, Vec3::X];
    let model = model(&moving(ball, "translation", places, "LINEAR"));
    let film = Film::new(&model, &model.clips()[0], [0.0, 3.0]).unwrap();
    let options = Options {
        size: [150, 150],
        background: Some([255; 3]),
        ..Options::default()
    };
    let images = drawn(&film, &options, &[0.0, 1.5, 3.0]);
    let strip = film.film_strip(&options, 3, |_| ()).unwrap();
    for (index, image) in images.iter().enumerate() {
        let still = image::imageops::crop_imm(&strip, index as u32 * 150, 0, 150, 150).to_image();
        let bytes = image.as_raw().iter().zip(still.as_raw());
        let apart = bytes.map(|(a, b)| u64::from(a.abs_diff(*b)));
        let mean = apart.clone().sum::<u64>() as f64 / image.as_raw().len() as f64;
        assert!(mean < 0.5, "{index}: {mean}");
        // Edges have fewer steps; nothing is missing.
        let most = apart.max().unwrap();
        assert!(most < 60, "{index}: {most}");
    }
}

#[test]
fn an_error_ends_a_film() {
    let model = model(&walker("LINEAR"));
    let film = Film::new(&model, &model.clips()[0], [0.0, 3.0]).unwrap();
    let mut seen = 0;
    let times = (0..500).map(|index| f64::from(index) / 200.0);
    let shooting = film.shooting(&wide(20)).unwrap();
    let ended = shooting.draw(times, |_| {
        seen += 1;
        match seen {
            7 => Err(RenderError::Broken),
            _ => Ok(()),
        }
    });
    assert!(matches!(ended, Err(RenderError::Broken)));
    assert_eq!(seen, 7);
}

#[test]
fn a_film_is_the_same_without_other_threads() {
    let model = model(&walker("LINEAR"));
    let film = Film::new(&model, &model.clips()[0], [0.0, 3.0]).unwrap();
    let times = [0.0, 0.5, 1.0, 2.5];
    let images = drawn(&film, &wide(100), &times);
    let alone = crate::threads::without_others(|| drawn(&film, &wide(100), &times));
    assert!(images == alone);
}

use super::*;

/// A red square of half a metre that moves ten metres to the right in two seconds, and rests for another.
fn walker(interpolation: &str) -> Vec<u8> {
    let shape = square(Vec3::ZERO, 0.25, unlit(1.0, 0.0, 0.0, 1.0));
    let places = [Vec3::ZERO, Vec3::X * 5.0, Vec3::X * 10.0];
    moving(shape, "translation", places, interpolation)
}

/// A shape with three keys, a second apart, and a closing key that repeats the last a second later.
fn moving(shape: Shape, path: &str, rows: [Vec3; 3], interpolation: &str) -> Vec<u8> {
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
fn red(image: &Image) -> (u32, u32) {
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
    film.draw(options, times.iter().copied(), |image| {
        images.push(image);
        Ok::<(), RenderError>(())
    })
    .unwrap();
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
        let part = image::imageops::crop_imm(&strip, index as u32 * 100, 0, 100, 40);
        assert!(part.to_image() == *cell, "{index}");
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

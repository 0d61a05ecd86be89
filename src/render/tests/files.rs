use super::*;

/// Four texels: red, green above blue, white.
fn textured(mode: &str) -> Vec<u8> {
    let texels = [
        [255, 0, 0, 255],
        [0, 255, 0, 255],
        [0, 0, 255, 255],
        [255, 255, 255, 0],
    ];
    let image = RgbaImage::from_fn(2, 2, |x, y| image::Rgba(texels[(y * 2 + x) as usize]));
    let mut png = Cursor::new(vec![]);
    image.write_to(&mut png, ImageFormat::Png).unwrap();
    let uri = base64::engine::general_purpose::STANDARD.encode(png.into_inner());
    let mut material = unlit(1.0, 1.0, 1.0, 1.0);
    material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
    material["alphaMode"] = mode.into();
    let extra = json!({
        "images": [{ "uri": format!("data:image/png;base64,{uri}") }],
        "samplers": [{ "magFilter": 9728, "minFilter": 9728 }],
        "textures": [{ "source": 0, "sampler": 0 }],
    });
    file(&[square(Vec3::ZERO, 1.0, material)], &extra)
}

#[test]
fn texture_coordinates_are_applied() {
    let image = picture(&textured("MASK"), &front(100));
    near(image.get_pixel(30, 30), [255, 0, 0, 255]);
    near(image.get_pixel(70, 30), [0, 255, 0, 255]);
    near(image.get_pixel(30, 70), [0, 0, 255, 255]);
    // The picture is transparent where the texture is cut out.
    near(image.get_pixel(70, 70), [0; 4]);
    let image = picture(&textured("OPAQUE"), &front(100));
    near(image.get_pixel(70, 70), [255, 255, 255, 255]);
}

#[test]
fn corners_colors_and_sides() {
    let mut shape = square(Vec3::ZERO, 1.0, unlit(1.0, 1.0, 1.0, 1.0));
    shape.more.push((
        "COLOR_0",
        "VEC4",
        5126,
        bytes([0.0, 1.0, 0.0, 1.0].repeat(4)),
    ));
    near(of(&[shape], &front(50)).get_pixel(25, 25), [0, 255, 0, 255]);
    let back = Options {
        view: View {
            yaw: 180.0,
            pitch: 0.0,
        },
        ..front(50)
    };
    let image = of(&[square(Vec3::ZERO, 1.0, unlit(1.0, 1.0, 1.0, 1.0))], &back);
    assert_eq!(
        image.get_pixel(25, 25).0[3],
        0,
        "a single side is not seen from behind"
    );
    let mut material = unlit(1.0, 1.0, 1.0, 1.0);
    material["doubleSided"] = true.into();
    assert_eq!(
        of(&[square(Vec3::ZERO, 1.0, material)], &back)
            .get_pixel(25, 25)
            .0[3],
        255
    );
    // A mirrored node is not turned inside out.
    let mut mirrored = square(Vec3::ZERO, 1.0, unlit(1.0, 1.0, 1.0, 1.0));
    mirrored.node = json!({ "scale": [-1, 1, 1] });
    assert_eq!(of(&[mirrored], &front(50)).get_pixel(25, 25).0[3], 255);
}

#[test]
fn skins_follow_their_joints_and_not_their_node() {
    let fixed = square(Vec3::ZERO, 1.0, unlit(1.0, 0.0, 0.0, 1.0));
    let mut bound = square(Vec3::ZERO, 1.0, unlit(0.0, 0.0, 1.0, 1.0));
    bound.node = json!({ "skin": 0, "translation": [0, 50, 0] });
    bound
        .more
        .push(("JOINTS_0", "VEC4", 5121, [0, 1, 0, 0].repeat(4)));
    bound.more.push((
        "WEIGHTS_0",
        "VEC4",
        5126,
        bytes([0.5, 0.5, 0.0, 0.0].repeat(4)),
    ));
    // Two joints, offset by 6 to the right and by 2: with equal weights 4.
    let extra = json!({
        "nodes": [{ "translation": [6, 0, 0] }, { "translation": [2, 0, 0] }],
        "skins": [{ "joints": [2, 3] }],
    });
    let image = picture(&file(&[fixed, bound], &extra), &front(300));
    near(image.get_pixel(150 - 88, 150), [255, 0, 0, 255]);
    near(image.get_pixel(150, 150), [0; 4]);
    near(image.get_pixel(150 + 88, 150), [0, 0, 255, 255]);
}

#[track_caller]
fn refused(file: &[u8], message: &str) {
    let model = read(file, &MemoryResolver::default());
    let error = model
        .and_then(|model| PosedModel::new(&model, &model.rest()).map(|_| ()))
        .unwrap_err()
        .to_string();
    assert!(error.contains(message), "{error}");
}

#[test]
fn broken_files_are_refused() {
    refused(b"", "is not a readable glTF file");
    refused(
        b"glTF\x02\0\0\0\xff\xff\xff\xff",
        "is not a readable glTF file",
    );
    refused(
        b"glTF\x02\0\0\0\x0b\0\0\0\0\0\0\0JSON",
        "shorter than its header",
    );
    refused(&file(&[], &json!({})), "");
    let quad = || square(Vec3::ZERO, 1.0, unlit(1.0, 1.0, 1.0, 1.0));
    let with = |change: &dyn Fn(&mut Value)| {
        let mut root: Value = serde_json::from_slice(&file(&[quad()], &json!({}))).unwrap();
        change(&mut root);
        serde_json::to_vec(&root).unwrap()
    };
    refused(
        &with(&|root| root["extensionsRequired"] = json!(["KHR_draco_mesh_compression"])),
        "`KHR_draco_mesh_compression`",
    );
    refused(
        &with(&|root| root["buffers"][0]["uri"] = "gone.bin".into()),
        "links to `gone.bin`, which is not there",
    );
    refused(
        &with(&|root| root["buffers"][0]["uri"] = "data:;base64,AAAA".into()),
        "buffer view 0 is longer than its buffer",
    );
    refused(
        &with(&|root| root["accessors"][0]["count"] = 4_000_000_000_u64.into()),
        "longer than its buffer view",
    );
    refused(
        &with(&|root| root["accessors"][0]["type"] = "VEC2".into()),
        "accessor 0",
    );
    refused(
        &with(&|root| root["accessors"][2]["componentType"] = 5126.into()),
        "accessor 2",
    );
    refused(
        &with(&|root| root["accessors"] = json!([])),
        "a mesh uses accessor 0, which is not there",
    );
    refused(
        &with(&|root| root["nodes"][0]["children"] = json!([0])),
        "a node is its own ancestor",
    );
    refused(
        &with(&|root| root["meshes"][0]["primitives"][0]["mode"] = 1.into()),
        "has no triangles",
    );
    let mut wrong = quad();
    wrong.triangles[0][0] = 77;
    refused(&file(&[wrong], &json!({})), "names corner 77");
    let mut nowhere = quad();
    nowhere.positions.fill(Vec3::NAN);
    refused(&file(&[nowhere], &json!({})), "has no triangles");
    let size = |size| {
        let model = read(&file(&[quad()], &json!({})), &MemoryResolver::default()).unwrap();
        let posed = PosedModel::new(&model, &model.rest()).unwrap();
        posed
            .picture(&Options {
                size,
                ..Options::default()
            })
            .map(|_| ())
    };
    assert!(matches!(size([0, 5]), Err(RenderError::Size(0, 5))));
    assert!(matches!(size([5, 8193]), Err(RenderError::Size(5, 8193))));
}

#[test]
fn many_nodes_of_one_mesh_are_counted_before_they_are_made() {
    let mut ball = sphere(plain(1.0, 1.0, 1.0, 1.0));
    ball.node = json!({});
    let nodes: Vec<Value> = (0..9000).map(|_| json!({ "mesh": 0 })).collect();
    let all: Vec<usize> = (0..9001).collect();
    let mut root: Value =
        serde_json::from_slice(&file(&[ball], &json!({ "nodes": nodes }))).unwrap();
    root["scenes"][0]["nodes"] = json!(all);
    refused(
        &serde_json::to_vec(&root).unwrap(),
        "has 36868096 triangles, more than the limit of 33554432",
    );
}

/// A sparse accessor is all zeros but for what it lists, and primitives and nodes can share one: a small file can claim
/// any memory.
#[test]
fn vertices_without_data_are_counted_before_they_are_made() {
    let quad = || square(Vec3::ZERO, 1.0, unlit(1.0, 1.0, 1.0, 1.0));
    let with = |extra: Value, count: usize, uses: usize, more: Value| {
        let mut root: Value = serde_json::from_slice(&file(&[quad()], &extra)).unwrap();
        let accessors = root["accessors"].as_array_mut().unwrap();
        accessors.push(json!({
            "componentType": 5126, "count": count, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0],
            "sparse": {
                "count": 1,
                "indices": { "bufferView": 0, "componentType": 5121 },
                "values": { "bufferView": 0 },
            },
        }));
        let mut zeros = more;
        zeros["attributes"] = json!({ "POSITION": accessors.len() - 1 });
        let primitives = root["meshes"][0]["primitives"].as_array_mut().unwrap();
        primitives.extend(vec![zeros; uses]);
        root
    };
    let refused =
        |root: &Value, message: &str| refused(&serde_json::to_vec(root).unwrap(), message);
    refused(
        &with(json!({}), 30_000_000, 1, json!({})),
        "so often that they need 343 MiB, more than the limit of 256 MiB beyond its data",
    );
    refused(&with(json!({}), 3_000_000, 10, json!({})), "need 343 MiB");
    // Shared by many nodes; the triangles use hardly any of them.
    let nodes: Vec<Value> = (0..3000).map(|_| json!({ "mesh": 0 })).collect();
    let all: Vec<usize> = (0..3001).collect();
    let mut root = with(json!({ "nodes": nodes }), 8_000, 1, json!({ "indices": 2 }));
    root["scenes"][0]["nodes"] = json!(all);
    refused(&root, "need 274 MiB");
}

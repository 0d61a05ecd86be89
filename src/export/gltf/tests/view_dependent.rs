use super::*;

/// Three nodes in a row, of which the middle one is bent.
fn bent() -> Scene {
    let mut scene = single(strip(4));
    let node = scene.nodes.raw[0].clone();
    scene.nodes = ti_vec![node; 3];
    scene.nodes.raw[0].children = vec![1.into()];
    scene.nodes.raw[1].children = vec![2.into()];
    scene.nodes.raw[1].view_dependent = Some(ViewDependent::Bend);
    scene
}

#[test]
fn a_bent_node_says_so_and_no_reader_must_know_it() {
    for exporter in BOTH {
        let file = bytes(&bent(), exporter);
        let json = json(&file);
        assert_eq!(json["extensionsUsed"], json!([VIEW_DEPENDENT]));
        assert!(json.get("extensionsRequired").is_none());
        let of = |node: usize| &json["nodes"][node]["extensions"];
        assert_eq!(*of(1), json!({ "OKOSHI_view_dependent": { "bend": {} } }));
        assert!(of(0).is_null() && of(2).is_null());
        assert_round_trip(&bent(), exporter);
    }
    let plain = json(&bytes(&single(strip(4)), &GLB));
    assert!(plain.get("extensionsUsed").is_none());
}

#[test]
fn what_is_bent_is_left_out_of_a_skin() {
    let skinned = bent().skinned().unwrap();
    let meshes: Vec<_> = skinned.nodes.iter().map(|node| node.mesh).collect();
    assert_eq!(meshes, [None, Some(0.into()), Some(0.into())]);
    let skin = skinned.skin.as_ref().unwrap();
    assert_eq!((skin.mesh, skinned.meshes.len()), (1.into(), 2));
    let file = json(&bytes(&skinned, &GLB));
    assert_eq!(file["nodes"][1]["mesh"], 0);
    assert_eq!(file["nodes"][4]["mesh"], 1);
    let joints = |mesh: usize| &file["meshes"][mesh]["primitives"][0]["attributes"]["JOINTS_0"];
    assert!(joints(0).is_null() && joints(1).is_number());

    let mut all = bent();
    all.nodes.raw[0].view_dependent = Some(ViewDependent::Bend);
    let skinned = all.clone().skinned().unwrap();
    assert_eq!(skinned, all);

    // A skin that would show nothing is left out, although another mesh shows something.
    let mut hollow = bent();
    hollow.nodes.raw[0].mesh = Some(1.into());
    hollow.meshes.push(Mesh {
        primitives: vec![primitive(Surface::default(), 0)],
    });
    let file = json(&bytes(&hollow.skinned().unwrap(), &GLB));
    assert!(file.get("skins").is_none());
    assert_eq!(file["nodes"].as_array().unwrap().len(), 4);
}

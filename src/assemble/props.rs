//! Props on their landscapes: where each stands, and what is wrong with that.

use glam::{DQuat, DVec2};
use typed_index_collections::TiSlice;

use crate::bind::{Bindings, Prop};
use crate::diagnostic::{Code, Diagnostic, few_or_one, listed};
use crate::figure::FigureNodes;
use crate::scene::{Mesh, MeshId, NewNode, Node, NodeId, Provenance, Scene};
use crate::svg::Drawing;
use crate::terrain::{Footing, LandscapeId, Layer, Place};

/// By how much the front of a prop stands before the place of its foot, tiles, so that it does not lie in the face of a wall.
const BEFORE: f64 = 0.01;

/// A prop on its landscape.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StandingProp {
    /// Its landscape.
    pub landscape: LandscapeId,
    /// Where it stands there.
    pub place: Place,
    /// Its node, if it is built.
    pub node: Option<NodeId>,
}

/// Where each prop stands. If there is no landscape, none does.
pub(super) fn places(
    bindings: &Bindings,
    layers: &TiSlice<LandscapeId, Layer>,
) -> Vec<StandingProp> {
    let place = |prop: &Prop| {
        let landscape = landscape_under(layers, prop.foot)?;
        Some(StandingProp {
            landscape,
            place: layers[landscape].place(prop.foot),
            node: None,
        })
    };
    bindings.props.iter().filter_map(place).collect()
}

/// The landscape that a foot is drawn on: the one that is drawn last where something is drawn, else the nearest one.
fn landscape_under(layers: &TiSlice<LandscapeId, Layer>, foot: DVec2) -> Option<LandscapeId> {
    let mut on = layers.iter_enumerated().rev();
    let on = on.find(|(_, layer)| layer.cell_under(foot).is_some());
    let away = |layer: &Layer| {
        let [low, high] = layer.bounds();
        foot.distance_squared(foot.clamp(low, high))
    };
    let nearest = || {
        let layers = layers.iter_enumerated();
        layers.min_by(|(_, a), (_, b)| away(a).total_cmp(&away(b)))
    };
    on.or_else(nearest).map(|(index, _)| index)
}

/// Adds the nodes of props below those of their landscapes, `landscapes`. Props that look alike share a mesh, unless `apart`. `scale`
/// are metres in a drawing unit.
#[expect(
    clippy::too_many_arguments,
    reason = "it is called once, with all that is known"
)]
pub(super) fn add(
    drawing: &Drawing,
    bindings: &Bindings,
    layers: &TiSlice<LandscapeId, Layer>,
    landscapes: &TiSlice<LandscapeId, NodeId>,
    props: &mut [StandingProp],
    figures: &mut FigureNodes,
    scale: f64,
    apart: bool,
    scene: &mut Scene,
) {
    let mut meshes: Vec<Option<MeshId>> = vec![None; props.len()];
    for (index, (prop, standing)) in bindings.props.iter().zip(props).enumerate() {
        let own: Option<Mesh> = figures.props.get_mut(index).and_then(Option::take);
        let mesh = match meshes[prop.like].filter(|_| !apart) {
            Some(like) => Some(like),
            None => own.map(|mesh| scene.meshes.push_and_get_key(mesh)),
        };
        meshes[index] = mesh;
        let layer = &layers[standing.landscape];
        let part = &bindings.parts[prop.main];
        // The face of a slab is where it is drawn, and its thickness behind that.
        let attributes = bindings.attributes(prop.main);
        let is_slab = !bindings.is_shape_set(prop.main);
        let behind = part.plate().filter(|_| is_slab).unwrap_or(0.0);
        let forward = attributes.offset().map_or(0.0, |offset| offset.value);
        let mut point = standing.place.point * layer.size;
        point.z += BEFORE * layer.size - behind + forward;
        let string = part.string.map(|string| &bindings.strings[string].text);
        let id = scene.add(NewNode {
            node: Node {
                name: part.name.clone(),
                translation: point * scale,
                rotation: DQuat::IDENTITY,
                provenance: Some(Provenance {
                    element: drawing.shapes[part.shape].element.id.clone(),
                    string: string.map(|text| text.as_str().to_owned()),
                }),
                ..Node::default()
            },
            mesh: None,
            parent: Some(landscapes[standing.landscape]),
        });
        scene.nodes[id].mesh = mesh;
        standing.node = Some(id);
    }
}

/// Reports props whose feet are drawn where nothing can stand.
pub(super) fn report(
    drawing: &Drawing,
    bindings: &Bindings,
    layers: &TiSlice<LandscapeId, Layer>,
    props: &[StandingProp],
    diagnostics: &mut Vec<Diagnostic>,
) {
    let with = |footing: Footing| {
        let all = bindings.props.iter().zip(props);
        all.filter(move |(_, standing)| standing.place.footing == footing)
    };
    let name = |prop: &Prop| bindings.describe(drawing, prop.main);
    let span = |prop: &Prop| drawing.shapes[bindings.parts[prop.main].shape].element.span;
    let cell = |standing: &StandingProp| match standing.place.cell {
        Some([column, row]) => format!("column {}, row {}", column + 1, row + 1),
        None => "no cell".to_owned(),
    };
    let land = |standing: &StandingProp| format!("`{}`", layers[standing.landscape].name);
    let names = |footing| {
        let names: Vec<String> = with(footing).map(|(prop, _)| name(prop)).collect();
        listed(names.into_iter())
    };

    let outside = with(Footing::Outside).map(|(prop, standing)| {
        let DVec2 { x, y } = prop.foot;
        let message = format!(
            "the foot of {} is drawn beside {}, at {x:.1} {y:.1}: it stands at height 0",
            name(prop),
            land(standing)
        );
        Diagnostic::new(Code::NoFooting, span(prop), message).help(
            "move it so that its lowest edge is on the map, or write the point on which it stands: `Tree$Stand x y`",
        )
    });
    few_or_one(
        outside.collect(),
        |count| {
            format!(
                "the feet of {count} props are drawn beside the map, so they stand at height 0: {}",
                names(Footing::Outside)
            )
        },
        diagnostics,
    );
    let fronts = with(Footing::Front).map(|(prop, standing)| {
        let message = format!(
            "the foot of {} is drawn on the front of a wall of {} ({}): it stands on top of the wall",
            name(prop),
            land(standing),
            cell(standing)
        );
        Diagnostic::new(Code::NoFooting, span(prop), message).help(
            "move it so that its lowest edge is on a top, or write the point on which it stands: `Tree$Stand x y`",
        )
    });
    few_or_one(
        fronts.collect(),
        |count| {
            format!(
                "the feet of {count} props are drawn on the fronts of walls, so they stand on top of these: {}",
                names(Footing::Front)
            )
        },
        diagnostics,
    );
    // Where a string says the point, it is meant.
    let is_said = |prop: &Prop| bindings.attributes(prop.main).stand().is_some();
    let floating = || with(Footing::Water).filter(|(prop, _)| !is_said(prop));
    let float: Vec<String> = floating().map(|(prop, _)| name(prop)).collect();
    let floating = floating().map(|(prop, standing)| {
        let message = format!(
            "{} floats: its foot is drawn on water of {} ({})",
            name(prop),
            land(standing),
            cell(standing)
        );
        Diagnostic::new(Code::Floats, span(prop), message)
            .help("move its lowest edge onto ground if it should not")
    });
    few_or_one(
        floating.collect(),
        |count| {
            format!(
                "{count} props float: their feet are drawn on water: {}",
                listed(float.iter().cloned())
            )
        },
        diagnostics,
    );
}

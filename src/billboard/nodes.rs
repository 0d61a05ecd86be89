//! The nodes of characters that turn: one for each region.

use std::sync::Arc;

use glam::{DAffine2, DQuat, DVec2, DVec3, Vec3};
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec};

use super::character::{Character, RegionMesh, RegionModel};
use super::paints::Paint;
use super::pieces::{Coat, Cover, pieces};
use super::sides::Side;
use super::stops::Stops;
use crate::bind::{Bindings, PartId};
use crate::scene::{
    AlphaMode, Animation, Interpolation, Material, MaterialId, Mesh, NewNode, Node, NodeId,
    PartMaterial, Primitive, Provenance, Scene, Surface, Timing, Track, Values, ViewDependent,
    ViewId, WorldTransform, linear, view_axes,
};
use crate::svg::Drawing;

/// Seconds in which a clip turns a character by 45°.
const SECONDS: f64 = 1.0;
/// Keys of the clip for 45°, the first not counted.
const KEYS: f64 = 8.0;

/// Keys closer than this share of the way between two views are one.
const LEAST_STEP: f64 = 1e-6;

/// The materials of regions.
pub(crate) struct RegionMaterials<'a> {
    /// Per part the material with its texture, and the map from the drawing to texture coordinates, if it has one.
    pub textured: &'a TiSlice<PartId, PartMaterial>,
    /// The materials without a texture, by the part to which they belong and their colours.
    pub flat: FxHashMap<FlatMaterial, MaterialId>,
    /// Materials with a texture seen through, by the material without that and by the alpha that it is multiplied with as bits.
    pub veils: FxHashMap<(MaterialId, u64), MaterialId>,
    /// Whether no two parts have a material in common.
    pub are_apart: bool,
}

/// What tells materials without a texture apart: a part, if they are not shared, and sRGB with straight alpha as bits.
pub(crate) type FlatMaterial = (Option<PartId>, [u64; 4]);

impl<'a> RegionMaterials<'a> {
    /// No materials but those with textures.
    pub(crate) fn new(textured: &'a TiSlice<PartId, PartMaterial>, are_apart: bool) -> Self {
        Self {
            textured,
            flat: FxHashMap::default(),
            veils: FxHashMap::default(),
            are_apart,
        }
    }

    /// The material of a paint with a texture, and the map to its coordinates.
    fn textured(&self, paint: &Paint) -> Option<(MaterialId, DAffine2)> {
        let (material, map) = self.textured[paint.part?]?;
        Some((material, map?))
    }

    /// How a paint covers what is behind it.
    fn cover(&self, paint: &Paint, scene: &Scene) -> Cover {
        match self.textured(paint) {
            Some((material, _)) => match scene.materials[material].alpha_mode {
                AlphaMode::Opaque => Cover::Texture,
                _ => Cover::Transparent,
            },
            None if paint.color[3] < 1.0 => Cover::Transparent,
            None => Cover::Color,
        }
    }

    /// The material of a piece of a region, and the map to texture coordinates with the view in whose drawing it begins.
    fn of_piece(
        &mut self,
        region: &RegionModel,
        paints: &[Paint],
        coat: Coat,
        scene: &mut Scene,
    ) -> (MaterialId, Option<(DAffine2, ViewId)>) {
        let (paint, alpha) = match coat {
            Coat::Mixture(color) => return (self.material(region.part, color, scene), None),
            Coat::Paint(paint, alpha) => (&paints[paint], alpha),
        };
        match self.textured(paint) {
            Some((material, map)) => {
                let material = self.veil(material, alpha, scene);
                (material, Some((paint.in_view(map), paint.view)))
            }
            None => {
                let [r, g, b, own] = paint.color;
                let color = [r, g, b, own * alpha];
                (self.material(region.part, color, scene), None)
            }
        }
    }

    /// A material whose alpha is multiplied.
    fn veil(&mut self, material: MaterialId, alpha: f64, scene: &mut Scene) -> MaterialId {
        if alpha == 1.0 {
            return material;
        }
        let key = (material, alpha.to_bits());
        *self.veils.entry(key).or_insert_with(|| {
            let mut veil = scene.materials[material].clone();
            veil.base_color[3] *= alpha as f32;
            veil.alpha_mode = AlphaMode::Blend;
            scene.materials.push_and_get_key(veil)
        })
    }

    /// The material of a part in a colour, sRGB with straight alpha, each 0 to 1.
    fn material(&mut self, part: Option<PartId>, color: [f64; 4], scene: &mut Scene) -> MaterialId {
        let owner = part.filter(|_| self.are_apart);
        let key = (owner, color.map(f64::to_bits));
        *self.flat.entry(key).or_insert_with(|| {
            let [r, g, b, alpha] = color;
            scene.materials.push_and_get_key(Material {
                base_color: [linear(r), linear(g), linear(b), alpha as f32],
                alpha_mode: if alpha < 1.0 {
                    AlphaMode::Blend
                } else {
                    AlphaMode::Opaque
                },
                double_sided: true,
                unlit: true,
                ..Material::default()
            })
        })
    }
}

/// Adds the nodes of a character and of its regions to a scene, and the clip that turns it.
pub(crate) fn add(
    character: &Character,
    drawing: &Drawing,
    bindings: &Bindings,
    world: &WorldTransform,
    materials: &mut RegionMaterials<'_>,
    scene: &mut Scene,
) {
    let middle = character.frames[ViewId::FIRST].center;
    let layer = &bindings.layers[character.layers[ViewId::FIRST]];
    let string = bindings.strings[layer.string].text.as_str();
    let regions = character.regions.iter();
    let mut shown = regions.flat_map(|region| &region.is_shown);
    let added = character.turn.views.keys().skip(character.layers.len());
    let behind = added.zip(&character.sides);
    let behind = behind.filter(|(_, side)| matches!(side, Side::Behind(_)));
    let behind = behind.map(|(view, _)| view).collect();
    let stops = Stops::new(&character.turn, shown.all(|is_shown| *is_shown), behind);
    let root = scene.add(NewNode {
        node: Node {
            name: character.name.clone(),
            translation: world.point(DVec3::new(middle.x, -middle.y, 0.0)),
            rotation: world.rotation,
            view_dependent: Some(ViewDependent::Turn(stops.turn.clone())),
            provenance: Some(Provenance {
                element: drawing.groups[layer.group].element.id.clone(),
                string: Some(string.to_owned()),
            }),
            ..Node::default()
        },
        mesh: None,
        parent: None,
    });
    let scale = character.frames[ViewId::FIRST].height * world.scale;
    let at_first = stops.turn.weights(stops.turn.views[ViewId::FIRST]);
    let node_of = |region: &RegionModel| {
        let places = region.positions.iter().map(|place| *place * scale);
        let places = stops.places(&places.collect::<TiVec<ViewId, DVec3>>());
        let translation = stops.turn.position(&at_first, &places);
        let string = region
            .part
            .and_then(|part| bindings.parts[part].string)
            .map(|string| bindings.strings[string].text.as_str().to_owned());
        let mesh = mesh(character, &stops, region, scale, materials, scene);
        scene.add(NewNode {
            node: Node {
                name: region.name.clone(),
                translation,
                rotation: DQuat::IDENTITY,
                view_dependent: Some(ViewDependent::Region(places)),
                provenance: Some(Provenance {
                    element: (region.shape)
                        .and_then(|shape| drawing.shapes[shape].element.id.clone()),
                    string,
                }),
                ..Node::default()
            },
            mesh: Some(mesh),
            parent: Some(root),
        })
    };
    let nodes: Vec<NodeId> = character.regions.iter().map(node_of).collect();
    scene
        .animations
        .push(clip(character, &stops, &nodes, scale));
}

/// The mesh of a region, with a morph target for each view but the first, and for each stop.
fn mesh(
    character: &Character,
    stops: &Stops,
    region: &RegionModel,
    scale: f64,
    materials: &mut RegionMaterials<'_>,
    scene: &mut Scene,
) -> Mesh {
    let heights: TiVec<ViewId, f64> = character.frames.iter().map(|frame| frame.height).collect();
    let sizes = stops.sizes(|view| region.is_shown[view]);
    let mut primitives: Vec<Primitive> = Vec::new();
    for part in &region.meshes {
        let RegionMesh {
            morph,
            paints,
            lift,
        } = part;
        let covers = paints.list.iter();
        let covers: Vec<Cover> = covers.map(|paint| materials.cover(paint, scene)).collect();
        for piece in pieces(morph, paints, &covers, &character.turn.between, &heights) {
            let morph = &*piece.morph;
            let placed = |(view, points): (ViewId, &Vec<DVec2>)| -> Vec<DVec3> {
                let [right, up, _] = view_axes(character.turn.views[view]);
                let place = region.positions[view];
                let middle = DVec2::new(place.dot(right), place.dot(up));
                let frame = &character.frames[view];
                let height = (lift + piece.lifts[view]) * scale;
                let point = |point: &DVec2| {
                    let point = (frame.on_screen(*point) - middle) * scale;
                    point.extend(height)
                };
                points.iter().map(point).collect()
            };
            let in_views: TiVec<ViewId, Vec<DVec3>> =
                morph.points.iter_enumerated().map(placed).collect();
            let base = &in_views[ViewId::FIRST];
            let base: Vec<Vec3> = base.iter().map(|point| point.as_vec3()).collect();
            let target = |at: ViewId| {
                let size = sizes[at].extend(1.0);
                let points = base.iter().enumerate().map(|(index, base)| {
                    let point = stops.mixed(at, |view| in_views[view][index]) * size;
                    (point.as_vec3() - *base).to_array()
                });
                points.collect()
            };
            let mut surface = Surface {
                normals: vec![[0.0, 0.0, 1.0]; base.len()],
                targets: stops.turn.views.keys().skip(1).map(target).collect(),
                triangles: morph.triangles.clone(),
                positions: base.into_iter().map(|point| point.to_array()).collect(),
                ..Surface::default()
            };
            let (material, map) = materials.of_piece(region, &paints.list, piece.coat, scene);
            if let Some((map, view)) = map {
                let uv = |point: &DVec2| map.transform_point2(*point).as_vec2().to_array();
                surface.uvs = morph.points[view].iter().map(uv).collect();
            }
            primitives.push(Primitive {
                patches: vec![surface.into()],
                material,
            });
        }
    }
    Mesh { primitives }
}

/// The way of the clip that turns a character: through the drawn views in their order, and on to those that nobody drew. With each
/// view its direction, degrees; a way around goes on beyond 360.
fn path(character: &Character) -> Vec<(ViewId, DVec2)> {
    let views = &character.turn.views;
    let drawn = views.len() - character.sides.len();
    let at = |view: ViewId| (view, DVec2::from(views[view]));
    let mut path: Vec<(ViewId, DVec2)> = views.keys().take(drawn).map(at).collect();
    let back: Vec<_> = path.iter().rev().skip(1).copied().collect();
    if character.sides.is_empty() {
        return path;
    }
    let goes_around = (character.sides.iter()).any(|side| matches!(side, Side::Behind(_)));
    path.extend(back);
    let first = at(ViewId::FIRST).1;
    if !goes_around {
        path.extend(views.keys().skip(drawn).map(at));
        return path;
    }
    // All level with the first view, once around, and so that the drawn ones come first.
    let level = views
        .keys()
        .map(at)
        .filter(|(_, to)| (to.y - first.y).abs() < LEAST_STEP);
    let side = path
        .iter()
        .map(|(_, to)| to.x - first.x)
        .find(|way| *way != 0.0);
    let sign = side.unwrap_or(1.0).signum();
    let around = level.map(|(view, to)| {
        let way = (sign * (to.x - first.x)).rem_euclid(360.0);
        (view, way)
    });
    let mut around: Vec<(ViewId, f64)> = around.filter(|(_, way)| *way > 0.0).collect();
    around.sort_by(|a, b| a.1.total_cmp(&b.1));
    around.push((ViewId::FIRST, 360.0));
    let to = |(view, way): (ViewId, f64)| (view, DVec2::new(first.x + sign * way, first.y));
    path.extend(around.into_iter().map(to));
    path
}

/// The clip in which a character turns through its views, as a viewer in front of the first one sees it. `nodes` are those of its
/// regions.
fn clip(character: &Character, stops: &Stops, nodes: &[NodeId], scale: f64) -> Animation {
    let path = path(character);
    let mut directions = vec![path[0].1.to_array()];
    let mut times = vec![0.0];
    for ((first, from), (second, to)) in path.iter().zip(&path[1..]) {
        let degrees = (*to - *from).length();
        let keys = (degrees / 45.0 * KEYS).ceil().max(1.0);
        let start = times.last().copied().unwrap_or_default();
        let mut shares: Vec<f64> = (1..=keys as usize).map(|key| key as f64 / keys).collect();
        // Between keys everything is linear.
        shares.extend(stops.between(*first, *second));
        shares.sort_by(f64::total_cmp);
        shares.dedup_by(|next, last| *next - *last < LEAST_STEP);
        for share in shares {
            directions.push(from.lerp(*to, share).to_array());
            times.push(start + share * degrees / 45.0 * SECONDS);
        }
    }
    let timing = Arc::new(Timing {
        times: times.into_iter().map(|time| time as f32).collect(),
        interpolation: Interpolation::Linear,
    });
    let weights: Vec<TiVec<ViewId, f64>> =
        directions.iter().map(|d| stops.turn.weights(*d)).collect();
    let mut tracks = Vec::new();
    for (region, node) in character.regions.iter().zip(nodes) {
        let node = *node;
        let places = stops.places(&region.positions);
        let place = |weights: &TiVec<ViewId, f64>| stops.turn.position(weights, &places) * scale;
        tracks.push(Track {
            node,
            timing: Arc::clone(&timing),
            values: Values::Translations(weights.iter().map(place).collect()),
        });
        let targets =
            |weights: &TiVec<ViewId, f64>| weights.iter().skip(1).map(|w| *w as f32).collect();
        tracks.push(Track {
            node,
            timing: Arc::clone(&timing),
            values: Values::Weights(weights.iter().map(targets).collect()),
        });
    }
    Animation {
        name: format!("{} turns", character.name),
        tracks,
    }
}

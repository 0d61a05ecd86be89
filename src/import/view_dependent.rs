//! The extension `OKOSHI_view_dependent` (docs/view-dependent.md): how nodes follow the viewer.

use ::gltf::Node;
use glam::{DMat3, DMat4, DVec3};
use serde::Deserialize;

use super::{ImportError, malformed};
use crate::math;
use crate::scene::{Turn, ViewDependent, ViewId, direction, view_axes};

const EXTENSION: &str = "OKOSHI_view_dependent";
/// The elevation with the largest stretch, in degrees above the ground.
const STEEPEST: f64 = 45.0;

/// How a node follows the viewer. Ways that are not known are ignored.
///
/// # Errors
/// The extension, or what it says of a way that is known, has the wrong form.
pub(super) fn read(node: &Node<'_>) -> Result<Option<ViewDependent>, ImportError> {
    let Some(extension) = node.extension_value(EXTENSION) else {
        return Ok(None);
    };
    let index = node.index();
    let wrong = |form: &str| {
        malformed(format!(
            "the {EXTENSION} of node {index} should be like {form}"
        ))
    };
    let Some(ways) = extension.as_object() else {
        return Err(wrong(r#"{ "bend": {} }"#));
    };
    if let Some(bend) = ways.get("bend") {
        let known = bend.is_object().then_some(Some(ViewDependent::Bend));
        return known.ok_or_else(|| wrong(r#"{ "bend": {} }"#));
    }
    if let Some(turn) = ways.get("turn") {
        let form = r#"{ "turn": { "views": [[0, 0], [45, 0]], "between": [[0, 1]] } }"#;
        let turn = TurnJson::deserialize(turn).map_err(|_| wrong(form))?;
        let count = turn.views.len();
        let is_set =
            |set: &Vec<usize>| (1..=3).contains(&set.len()) && set.iter().all(|view| *view < count);
        let finite = turn
            .views
            .as_flattened()
            .iter()
            .all(|angle| angle.is_finite());
        if count == 0
            || count > Turn::MOST_VIEWS
            || turn.between.is_empty()
            || !finite
            || !turn.between.iter().all(is_set)
        {
            return Err(wrong(form));
        }
        return Ok(Some(ViewDependent::Turn(Turn {
            views: turn.views.into(),
            between: turn
                .between
                .into_iter()
                .map(|set| set.into_iter().map(ViewId::from).collect())
                .collect(),
        })));
    }
    if let Some(region) = ways.get("region") {
        let form = r#"{ "region": { "places": [[0, 0, 0], [1, 0, 0]] } }"#;
        let region = RegionJson::deserialize(region).map_err(|_| wrong(form))?;
        let places = region.places.into_iter().map(DVec3::from);
        return Ok(Some(ViewDependent::Region(places.collect())));
    }
    Ok(None)
}

#[derive(Deserialize)]
struct TurnJson {
    views: Vec<[f64; 2]>,
    between: Vec<Vec<usize>>,
}

#[derive(Deserialize)]
struct RegionJson {
    places: Vec<[f64; 3]>,
}

/// How a character is turned to its viewer.
pub(super) struct Facing {
    /// The viewer's direction, degrees, in the character's space.
    pub(super) direction: [f64; 2],
    /// From the frame of a screen that faces the viewer to the character's space.
    pub(super) rotation: DMat4,
}

/// Turns a character to the viewer. `global` takes its frame into the world, `towards` points to the viewer in the world.
pub(super) fn facing(global: DMat4, towards: DVec3) -> Facing {
    let into = DMat3::from_mat4(global).inverse();
    let towards = (into * towards).try_normalize().unwrap_or(DVec3::Z);
    let direction = direction(towards);
    let [right, up, towards] = view_axes(direction);
    Facing {
        direction,
        rotation: DMat4::from_mat3(DMat3::from_cols(right, up, towards)),
    }
}

/// The bend in a node's own frame. `global` takes that frame into the world, `towards` points to the viewer in the
/// world.
///
/// The identity if there is no bend, because the node is flat or the direction is zero.
pub(super) fn bend_matrix(global: DMat4, towards: DVec3) -> DMat4 {
    let into = DMat3::from_mat4(global).inverse();
    match (into * towards).try_normalize() {
        Some(towards) => DMat4::from_mat3(bend_for(towards)),
        None => DMat4::IDENTITY,
    }
}

/// The bend for the unit vector towards the viewer, with +Y up: a scale by R along u = (up − h)/√2, where h is the
/// viewer's horizontal direction (Kitamura, equation 3.2; the ranges for negative θ, swapped in print, are corrected).
fn bend_for(towards: DVec3) -> DMat3 {
    let Some(horizontal) = DVec3::new(towards.x, 0.0, towards.z).try_normalize() else {
        // From straight above R is 1.
        return DMat3::IDENTITY;
    };
    let elevation = math::asin(towards.y.clamp(-1.0, 1.0)).to_degrees().abs();
    let more = (std::f64::consts::SQRT_2 - 1.0) * (1.0 - (elevation - STEEPEST).abs() / STEEPEST);
    let along = (DVec3::Y - horizontal) * std::f64::consts::FRAC_1_SQRT_2;
    DMat3::IDENTITY
        + DMat3::from_cols(
            along * along.x * more,
            along * along.y * more,
            along * along.z * more,
        )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn towards(yaw: f64, pitch: f64) -> DVec3 {
        let ((yaw_sin, yaw_cos), (sin, cos)) =
            (yaw.to_radians().sin_cos(), pitch.to_radians().sin_cos());
        DVec3::new(cos * yaw_sin, sin, cos * yaw_cos)
    }

    /// The ratio R.
    fn ratio_of(yaw: f64, pitch: f64) -> f64 {
        bend_for(towards(yaw, pitch)).determinant()
    }

    #[test]
    fn the_ratio_is_that_of_the_thesis_for_the_absolute_elevation() {
        let most = std::f64::consts::SQRT_2;
        let near = |pitch: f64, ratio: f64| {
            let found = ratio_of(30.0, pitch);
            assert!((found - ratio).abs() < 1e-12, "{pitch}: {found}");
        };
        for sign in [1.0, -1.0] {
            near(sign * 45.0, most);
            near(sign * 22.5, (1.0 + most) / 2.0);
            near(sign * 67.5, (1.0 + most) / 2.0);
            near(sign * 0.0, 1.0);
            near(sign * 90.0, 1.0);
        }
    }

    #[test]
    fn the_bend_is_the_rotated_scale_of_the_thesis() {
        for pitch in [10.0, 45.0, 80.0] {
            let ratio = ratio_of(0.0, pitch);
            let turn = DMat3::from_rotation_x(std::f64::consts::FRAC_PI_4);
            let scale = DMat3::from_diagonal(DVec3::new(1.0, ratio, 1.0));
            let of_thesis = turn.transpose() * scale * turn;
            assert!(bend_for(towards(0.0, pitch)).abs_diff_eq(of_thesis, 1e-12));
            // From another side it is the same matrix, rotated with the viewer.
            let round = DMat3::from_rotation_y(2.0);
            let turned = bend_for(towards(2.0_f64.to_degrees(), pitch));
            assert!(turned.abs_diff_eq(round * of_thesis * round.transpose(), 1e-12));
        }
    }

    #[test]
    fn the_direction_is_taken_in_the_nodes_frame() {
        // The node's up is the world's -Z, so a viewer in front is straight above it.
        let lying = DMat4::from_rotation_x(-std::f64::consts::FRAC_PI_2);
        assert!(bend_matrix(lying, towards(0.0, 0.0)).abs_diff_eq(DMat4::IDENTITY, 1e-12));
        let bent = bend_matrix(lying, towards(0.0, 45.0));
        assert!((bent.determinant() - std::f64::consts::SQRT_2).abs() < 1e-12);
        let flat = DMat4::from_scale(DVec3::new(1.0, 0.0, 1.0));
        assert_eq!(bend_matrix(flat, DVec3::Z), DMat4::IDENTITY);
    }
}

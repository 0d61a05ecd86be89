//! Roofs: triangular prisms on the walls of houses (terrain.md, rule 8; equation 3.1).

use super::super::constraints::STRIPE;
use super::super::houses::House;
use super::corners::Corners;
use super::greedy::{Facing, Rect};
use super::mesh::Mesh;

/// The corners of a roof's eaves.
pub(super) fn eaves(house: &House) -> [[i32; 3]; 4] {
    let (y, x) = (house.eaves(), &house.roof);
    let [back, front] = [house.back(), house.front];
    [
        [x.start, y, front],
        [x.end, y, front],
        [x.end, y, back],
        [x.start, y, back],
    ]
}

/// The undersides of a roof where it extends beyond the walls.
pub(super) fn soffits(house: &House) -> Vec<Rect> {
    let (roof, walls) = (&house.roof, &house.walls);
    let sides = [
        [roof.start, roof.end.min(walls.start)],
        [roof.start.max(walls.end), roof.end],
    ];
    let mut rects = vec![];
    for [from, to] in sides {
        let mut x = from;
        while x < to {
            let end = ((x / STRIPE as i32 + 1) * STRIPE as i32).min(to);
            rects.push(Rect {
                facing: Facing::Down,
                material: house.materials[0],
                plane: house.eaves(),
                across: [x, end],
                along: [house.back(), house.front],
            });
            x = end;
        }
    }
    rects
}

/// Adds a roof: two slopes and two gables. `factor` is the ratio of the ridge's height to the depth.
pub(super) fn roof(mesh: &mut Mesh, corners: &Corners, house: &House, factor: f64) {
    let depth = f64::from(house.depth);
    let rise = factor * depth;
    let y = f64::from(house.eaves());
    let middle = f64::from(house.front) - depth / 2.0;
    let [near_left, near_right, far_right, far_left] = eaves(house);
    let ridge = |x: i32| [f64::from(x), y + rise, middle];
    let slope = (depth / 2.0).hypot(rise);
    let line = |from: [i32; 3], to: [i32; 3]| {
        let mut points = vec![from];
        corners.between(None, from, to, |point| points.push(point));
        points.push(to);
        points
    };
    let material = house.materials[0];
    let [up, out] = [(depth / 2.0 / slope) as f32, (rise / slope) as f32];
    for (eave, normal) in [
        (line(near_left, near_right), [0.0, up, out]),
        (line(far_right, far_left), [0.0, up, -out]),
    ] {
        let [first, last] = [eave[0], eave[eave.len() - 1]];
        let uv = |x: f64, v: f64| [if normal[2] < 0.0 { -x } else { x }, v];
        let top = |x: i32| (ridge(x), uv(f64::from(x), 0.0));
        let foot = |point: &[i32; 3]| {
            let place = point.map(f64::from);
            (place, uv(place[0], slope))
        };
        // A fan about the first end of the ridge covers the eave, and one more triangle the rest of the slope.
        let mut fan = vec![top(first[0])];
        fan.extend(eave.iter().map(foot));
        mesh.fan(material, normal, &fan);
        mesh.fan(
            material,
            normal,
            &[top(first[0]), foot(&last), top(last[0])],
        );
    }
    for (base, normal) in [
        (line(near_right, far_right), [1.0, 0.0, 0.0]),
        (line(far_left, near_left), [-1.0, 0.0, 0.0]),
    ] {
        let wall = house.materials[1];
        let place = |[x, y, z]: [f64; 3]| ([x, y, z], [z, -y]);
        let mut fan = vec![place(ridge(base[0][0]))];
        fan.extend(base.iter().map(|point| place(point.map(f64::from))));
        mesh.fan(wall, normal, &fan);
    }
}

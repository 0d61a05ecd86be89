//! Each rule of terrain with heights that were computed by hand, and the figures of the thesis.

use okoshi::internals::terrain::{AmbiguityKind, HouseInfo, Landscape, Map};

use crate::letters::{WATER, map};

/// Heights of the tops, a line a row; a dot where there is none.
fn tops(map: &Map) -> String {
    let land = Landscape::new(map);
    let mut lines = String::new();
    for row in 0..map.rows {
        let cells = (0..map.columns).map(|column| land.top(column, row));
        let words: Vec<String> = cells
            .map(|top| top.map_or(".".into(), |top| top.to_string()))
            .collect();
        lines += &(words.join(" ") + "\n");
    }
    lines
}

#[track_caller]
fn assert_tops(lines: &str, expected: &str) {
    let expected: String = expected
        .lines()
        .map(str::trim)
        .filter(|line| !line.is_empty())
        .map(|line| line.to_owned() + "\n")
        .collect();
    assert_eq!(tops(&map(lines)), expected);
}

/// The volume of the solid, and its bounds: x from the left, y from the ground, z from the map's first row.
fn measured(map: &Map) -> (f64, [[f64; 3]; 2]) {
    let middle = [map.columns as f64 / 2.0, 0.0, map.rows as f64 / 2.0];
    let mut volume = 0.0;
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for piece in Landscape::new(map)
        .surface(0.5, 0.0)
        .iter()
        .flat_map(|(_, pieces)| pieces)
    {
        let place = |corner: u32| {
            let place = piece.positions[corner as usize];
            [0, 1, 2].map(|axis| f64::from(place[axis]) + middle[axis])
        };
        for triangle in &piece.triangles {
            let [a, b, c] = triangle.map(place);
            volume += (a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]))
                / 6.0;
            for axis in 0..3 {
                for corner in [a, b, c] {
                    bounds[0][axis] = bounds[0][axis].min(corner[axis]);
                    bounds[1][axis] = bounds[1][axis].max(corner[axis]);
                }
            }
        }
    }
    (volume, bounds)
}

#[track_caller]
fn assert_volume(lines: &str, expected: f64) {
    let (volume, _) = measured(&map(lines));
    assert!(
        (volume - expected).abs() < 1e-3,
        "{volume} is not {expected}"
    );
}

fn notes(lines: &str) -> Vec<AmbiguityKind> {
    Landscape::new(&map(lines))
        .ambiguities()
        .iter()
        .map(|note| note.kind)
        .collect()
}

/// Rule 1, figure 3.4: width, height and depth are the tiles side by side, the browns and the greens.
#[test]
fn a_basic_solid_is_as_wide_high_and_deep_as_it_is_drawn() {
    let basic = map("
        g g g
        g g g
        b b b
        b b b
        b b b");
    let (volume, [low, high]) = measured(&basic);
    assert_eq!(volume.round(), 18.0);
    assert_eq!(
        [0, 1, 2].map(|axis| high[axis] - low[axis]),
        [3.0, 3.0, 2.0]
    );
    // Its foot is visible at row 5, and z = r + y.
    assert_eq!((low[1], high[2]), (0.0, 5.0));
}

/// Rule 2, figure 3.6 without edges: all tops are at one height, and columns with fewer browns hang.
#[test]
fn columns_with_fewer_browns_hang_below_the_common_top() {
    let stairs = "
        g g g
        b g g
        b b g
        b b b";
    assert_tops(
        stairs,
        "
        3 3 3
        . 3 3
        . . 3
        . . .",
    );
    // Depth times thickness: 1 × 3, 2 × 2, 3 × 1.
    assert_volume(stairs, 10.0);
    let (_, [low, _]) = measured(&map("
        . g g
        . b g
        . . b"));
    assert_eq!(low[1], 0.0);
    assert_eq!(notes(stairs), []);
}

/// Rule 4, figure 3.6 with edges: stairs, each step on the ground.
#[test]
fn edges_make_stairs() {
    let stairs = "
        g|g|g
        b g|g
        b b g
        b b b";
    assert_tops(
        stairs,
        "
        3 2 1
        . 2 1
        . . 1
        . . .",
    );
    assert_volume(stairs, 10.0);
}

/// Rule 3, figure 3.5: a box that is drawn on a plate stands on it; beside it the same box stands on the ground.
#[test]
fn a_thin_box_stands_on_a_plate() {
    assert_tops(
        "
        . . g . . . g
        g g b g g . b
        g g b g g . b
        g g g g g . .
        b b b b b . .",
        "
        . . 3 . . . 2
        1 1 . 1 1 . .
        1 1 . 1 1 . .
        1 1 1 1 1 . .
        . . . . . . .",
    );
}

/// Rule 7, figure 3.7 on the left: without edges there is a hole in the plate.
#[test]
fn without_edges_a_plate_has_a_hole() {
    let plate = "
        g g g g g
        g g g g g
        g g b g g
        g g g g g
        b b b b b";
    assert_tops(
        plate,
        "
        1 1 1 1 1
        1 1 1 1 1
        1 1 . 1 1
        1 1 1 1 1
        . . . . .",
    );
    // Its floor is a plate on the ground, and what stands there reaches as deep: 20 tiles of 1¼, less the pit.
    assert_volume(plate, 24.0);
    assert_eq!(notes(plate), [AmbiguityKind::Pits]);
}

/// Rules 4 and 5, figure 3.7 on the right: a ring of edges lifts a block onto the plate, which continues below and behind it.
#[test]
fn a_ring_of_edges_lifts_a_block_onto_the_plate() {
    let plate = "
        g g g g g
        :    -
        g g|g|g g
        g g b g g
        g g g g g
        b b b b b";
    assert_tops(
        plate,
        "
        1 1 1 1 1
        1 1 2 1 1
        1 1 . 1 1
        1 1 1 1 1
        . . . . .",
    );
    // The whole plate and one cube: hidden cells are filled.
    assert_volume(plate, 21.0);
    assert_eq!(notes(plate), []);
}

/// Rule 5: in front of a cliff whose foot a house hides, their common ground continues.
#[test]
fn the_ground_continues_behind_a_house_at_a_cliff() {
    let map = map("
        g g g g g
        g g g g g
        b b b b b
        b b b b b
        g R R R g
        g R R R g
        g B B B g
        g B B B g
        g g g g g
        b b b b b");
    // Ground of 7 rows, a cliff of two rows and two tiles, the house's block and roof.
    let (volume, _) = measured(&map);
    let expected = 5.0 * 7.0 + 5.0 * 4.0 + 3.0 * 4.0 + 3.0;
    assert!(
        (volume - expected).abs() < 1e-3,
        "{volume} is not {expected}"
    );
}

/// Rule 6, figure 3.8: without edges the tongue hangs, with edges it continues to the front behind it.
#[test]
fn fronts_with_edges_end_flush_with_what_is_behind() {
    let lines = |edge: &str| {
        format!(
            "
            g g g g g
            g g g g g
            b g g g b
            b g g g b
            b{edge}b b b{edge}b
            b{edge}b b b{edge}b"
        )
    };
    assert_volume(&lines(" "), 40.0);
    // In each of three columns 3 tiles at height 1 and 2 on the ground.
    assert_volume(&lines("|"), 55.0);
    for edge in [" ", "|"] {
        assert_eq!(Landscape::new(&map(&lines(edge))).top(2, 3), Some(4));
    }
}

/// Rule 7, figure 3.9: a pond is as deep as its far bank has browns.
#[test]
fn the_bed_of_a_pond_is_not_seen_from_behind() {
    let map = map("
        g g g g g
        g b b b g
        g w w w g
        g g g g g
        b b b b b");
    let surface = Landscape::new(&map).surface(0.5, 0.0);
    let (_, water) = (surface.iter())
        .find(|(material, _)| *material == WATER)
        .expect("water");
    let mut triangles = 0;
    for piece in water {
        for triangle in &piece.triangles {
            let [a, b, c] = triangle.map(|corner| piece.positions[corner as usize]);
            assert!(a[1] == b[1] && b[1] == c[1], "an upright face of water");
            triangles += 1;
        }
    }
    assert!(triangles > 0);
}

#[test]
fn ponds_are_as_deep_as_their_far_wall() {
    let pond = |browns: &str| {
        format!(
            "
        g g g g g
        {browns}
        g w w w g
        g w w w g
        g g g g g
        b b b b b
        b b b b b
        b b b b b"
        )
    };
    assert_tops(
        &pond("g b b b g"),
        "
        3 3 3 3 3
        3 . . . 3
        3 2 2 2 3
        3 2 2 2 3
        3 3 3 3 3
        . . . . .
        . . . . .
        . . . . .",
    );
    // 5 × 5 tiles of 3, less the pond: the drawn rows and a hidden one.
    assert_volume(&pond("g b b b g"), 75.0 - 9.0);
    assert_tops(
        &pond("g b b b g\n g b b b g"),
        "
        3 3 3 3 3
        3 . . . 3
        3 . . . 3
        3 1 1 1 3
        3 1 1 1 3
        3 3 3 3 3
        . . . . .
        . . . . .
        . . . . .",
    );
}

/// Rule 7: water that runs to the border lies at 0; a pond in ground at 0 lies below it.
#[test]
fn open_water_lies_at_the_ground() {
    assert_tops(
        "
        g g g
        b b b
        w w w",
        "
        1 1 1
        . . .
        0 0 0",
    );
    assert_tops(
        "
        g g g
        g b g
        g w g
        g g g",
        "
        0 0 0
        0 . 0
        0 -1 0
        0 0 0",
    );
}

/// Rule 7: also water that leaves the map at its side or at its top.
#[test]
fn water_at_any_border_is_open() {
    let side = "
        g g g
        w b b
        w w g
        g g g
        b b b";
    assert_eq!(Landscape::new(&map(side)).top(0, 1), Some(0));
    let lines = "
        w w w
        R R R
        B B B";
    assert_eq!(Landscape::new(&map(lines)).top(1, 0), Some(0));
    assert_eq!(notes(lines), []);
}

/// Rule 7: a dry pit has a floor below its near bank, as deep as its far wall has browns.
#[test]
fn pits_have_floors() {
    let pit = |browns: &str| {
        format!(
            "
        g g g g g
        {browns}
        g g g g g
        g g g g g
        b b b b b
        b b b b b
        b b b b b"
        )
    };
    // 5 × 4 or 5 × 5 tiles of 3, less the pit: it is as long as it is deep.
    let shallow = measured(&map(&pit("g b b b g"))).0;
    assert!(
        (shallow - (5.0 * 4.0 * 3.0 - 3.0)).abs() < 1e-3,
        "{shallow}"
    );
    let deep = measured(&map(&pit("g b b b g\n g b b b g"))).0;
    assert!(
        (deep - (5.0 * 5.0 * 3.0 - 3.0 * 4.0)).abs() < 1e-3,
        "{deep}"
    );
}

/// Rule 11: grass, a hill on it and the sea beside it are one solid, a quarter tile thick where nothing is drawn below.
#[test]
fn ground_and_sea_are_a_plate() {
    let lines = "
        g g g w
        :  -
        g|g|g w
        g b g w
        g g g w";
    let (volume, [low, high]) = measured(&map(lines));
    assert!((volume - (16.0 * 0.25 + 1.0)).abs() < 1e-3, "{volume}");
    assert_eq!([low[1], high[1]], [-0.25, 1.0]);
}

/// Rule 7: a sunken floor.
#[test]
fn a_green_floor_lies_below_its_wall() {
    assert_tops(
        "
        g g g g
        g b b g
        :  - -
        g|g g|g
        :  - -
        g g g g
        b b b b
        b b b b",
        "
        2 2 2 2
        2 . . 2
        2 1 1 2
        2 2 2 2
        . . . .
        . . . .",
    );
}

/// Rule 8, figures 3.10 to 3.13: sizes of houses, and equation 3.1.
#[test]
fn houses_are_as_large_as_they_are_drawn() {
    let house = map("
        R R R
        R R R
        B B B");
    let land = Landscape::new(&house);
    let built: Vec<HouseInfo> = land.houses().collect();
    assert_eq!(
        built,
        [HouseInfo {
            base: 0,
            width: 3,
            depth: 2,
            height: 1
        }]
    );
    let high = |roof: f64| {
        let surface = land.surface(roof, 0.0);
        let corners = surface
            .iter()
            .flat_map(|(_, pieces)| pieces)
            .flat_map(|piece| &piece.positions);
        corners.fold(0.0_f64, |high, place| high.max(place[1].into()))
    };
    assert!(
        (high(okoshi::internals::terrain::DEFAULT_ROOF) - (1.0 + 2.0 / 2.0_f64.sqrt())).abs()
            < 1e-6
    );
    assert_eq!(high(0.5), 2.0);
    // The block, and a prism of half its height at `Roof 0.5`.
    let (volume, _) = measured(&house);
    assert!((volume - (6.0 + 3.0)).abs() < 1e-6);
}

/// Rule 8, figure 3.10 on the right: a house on a hill stands as high as the hill.
#[test]
fn a_house_stands_on_its_hill() {
    let land = Landscape::new(&map("
        g g g g g
        g R R R g
        g R R R g
        g B B B g
        g B B B g
        g g g g g
        b b b b b
        b b b b b"));
    let built: Vec<HouseInfo> = land.houses().collect();
    assert_eq!(
        built,
        [HouseInfo {
            base: 2,
            width: 3,
            depth: 2,
            height: 2
        }]
    );
}

/// Rule 8: a roof in several colours has them where they are drawn, on both of its slopes.
#[test]
fn roofs_have_the_materials_of_their_tiles() {
    let mut house = map("
        R R R R
        R R R R
        R R R R
        B B B B");
    house.tiles.push(okoshi::internals::terrain::Tile::Red);
    let other = house.tiles.len() as u8 - 1;
    // The middle row, and the last tile of the eaves.
    house.cells[4..8].fill(other);
    house.cells[11] = other;
    let area = |roof: f64| {
        let mut areas = [0.0_f64; 8];
        for (material, pieces) in Landscape::new(&house).surface(roof, 0.0) {
            for piece in &pieces {
                for triangle in &piece.triangles {
                    let [a, b, c] = triangle.map(|corner| piece.positions[corner as usize]);
                    let [u, v] =
                        [b, c].map(|end| [0, 1, 2].map(|axis| f64::from(end[axis] - a[axis])));
                    let cross =
                        [1, 2, 0].map(|i: usize| u[i] * v[(i + 1) % 3] - u[(i + 1) % 3] * v[i]);
                    areas[usize::from(material)] +=
                        cross.iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0;
                }
            }
        }
        areas
    };
    // Each tile is a third of a slope, √2 × 3 / 2 long, one tile wide.
    let tile = 2.0_f64.sqrt() / 2.0;
    let areas = area(0.5);
    assert!(
        (areas[usize::from(other)] - 2.0 * 5.0 * tile).abs() < 1e-5,
        "{areas:?}"
    );
    assert!((areas[4] - 2.0 * 7.0 * tile).abs() < 1e-5, "{areas:?}");
}

/// Rule 8: edges separate adjacent houses.
#[test]
fn edges_separate_houses() {
    let pair = |edge: &str| {
        let land = Landscape::new(&map(&format!(
            "
            R R{edge}R R
            R R{edge}R R
            B B{edge}B B"
        )));
        land.houses().map(|house| house.width).collect::<Vec<_>>()
    };
    assert_eq!(pair(" "), [4]);
    assert_eq!(pair("|"), [2, 2]);
}

/// Rule 9: paths are tops, with a note; fronts without a top are one tile deep.
#[test]
fn remaining_tiles_are_built_too() {
    let path = "
        g g g
        g B g
        g B g
        b b b";
    assert_tops(
        path,
        "
        1 1 1
        1 1 1
        1 1 1
        . . .",
    );
    assert!(matches!(
        notes(path)[..],
        [AmbiguityKind::Plain(
            okoshi::internals::terrain::Tile::Beige
        )]
    ));
    let (volume, [low, high]) = measured(&map("
        b b
        b b
        b b"));
    assert_eq!(volume.round(), 6.0);
    assert_eq!(
        [0, 1, 2].map(|axis| high[axis] - low[axis]),
        [2.0, 3.0, 1.0]
    );
}

/// Rule 9: a roof behind a hill is that of a house whose wall the hill hides; on a plaza it is not.
#[test]
fn houses_may_stand_behind_hills() {
    let hill = "
        . R R . R R .
        g R R g R R g
        :-     -
        g g g g B B g
        g g g g|g g g
        b b b b g g g
        g g g g g g g";
    let land = Landscape::new(&map(hill));
    assert_eq!(notes(hill), []);
    let built: Vec<HouseInfo> = land.houses().collect();
    let house = HouseInfo {
        base: 0,
        width: 2,
        depth: 2,
        height: 1,
    };
    assert_eq!(built, [house; 2]);
    let plaza = "
        g g g g
        g R R g
        g g g g
        b b b b";
    assert!(matches!(notes(plaza)[..], [AmbiguityKind::Plain(_)]));
}

/// Rule 3: of the fronts between two surfaces, the longest that at least a quarter of the columns show.
#[test]
fn a_shore_that_is_thicker_in_one_column_does_not_lift_the_island() {
    let shore = "
        w w w w w w w w
        w g g g g g g w
        w g g g g g g w
        w b b b b b b w
        w w w b w w w w
        w w w w w w w w";
    let land = Landscape::new(&map(shore));
    assert_eq!(land.top(1, 1), Some(1));
    assert_eq!(
        notes(shore),
        [AmbiguityKind::Uneven {
            most: 2,
            taken: 1,
            columns: 6
        }]
    );
    // Two of six are more than a quarter: these are the posts of a bridge.
    let bridge = shore.replace("w w w b w w w w", "w b w b w w w w");
    assert_eq!(Landscape::new(&map(&bridge)).top(1, 1), Some(2));
    assert_eq!(notes(&bridge), []);
}

/// Rule 3: groups without a connection are put on the ground, with a note.
#[test]
fn loose_groups_are_reported() {
    let lines = "
        . w .
        R R R
        B B B";
    assert!(notes(lines).is_empty());
    let lines = "
        b b b
        b w b
        b g b
        b b b";
    assert_eq!(Landscape::new(&map(lines)).top(1, 2), Some(1));
    assert!(notes(lines).contains(&AmbiguityKind::Unconstrained));
}

/// An arch: the lintel hangs between its posts, and the ground behind is visible below it.
#[test]
fn arches_are_open() {
    let arch = "
        g g g g
        b b b b
        b g g b
        b g g b";
    let land = Landscape::new(&map(arch));
    assert_eq!(land.top(0, 0), Some(3));
    assert_eq!(land.top(1, 2), Some(0));
    // Two posts of 3, a lintel of 2, and plates of a quarter tile: grass, which the posts go down through.
    assert_volume(arch, 8.0 + 6.0 * 0.25);
}

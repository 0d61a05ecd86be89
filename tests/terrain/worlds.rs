//! Random landscapes with known heights, and their maps.

use okoshi::internals::terrain::{EDGE_BELOW, EDGE_RIGHT, Map};

use fastrand::Rng;

/// The top of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Top {
    Green,
    Blue,
    /// The eaves of the house with this number, over walls down to a height.
    Roof(usize, i32),
}

/// A landscape: the height and the top of each column; `None` where there is nothing.
#[derive(Debug, Clone)]
pub(crate) struct World {
    columns: i32,
    depth: i32,
    places: Vec<Option<(i32, Top)>>,
    houses: usize,
}

/// The visible face in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Sight {
    look: u8,
    /// Height at the cell's lower edge.
    height: i32,
    /// Distinguishes faces of one kind: height of tops, position of fronts, number of houses.
    face: (i32, usize),
}

/// A map, and the height of the visible face at the lower edge of each cell, row by row.
pub(crate) struct Drawn {
    pub(crate) map: Map,
    pub(crate) heights: Vec<Option<i32>>,
}

const GREEN: u8 = 1;
const BROWN: u8 = 2;
const BLUE: u8 = 3;
const RED: u8 = 4;
const BEIGE: u8 = 5;

impl World {
    /// A landscape of plateaus, blocks on them, stairs, ponds, pits and houses.
    pub(crate) fn random(seed: u64) -> Self {
        let mut random = Rng::with_seed(seed);
        let (columns, depth) = (random.i32(10..=26), random.i32(10..=24));
        let ground = (random.u8(..100) < 70).then_some((0, Top::Green));
        let mut world = Self {
            columns,
            depth,
            places: vec![ground; (columns * depth) as usize],
            houses: 0,
        };
        for _ in 0..random.i32(1..=4) {
            world.plateau(&mut random);
        }
        for _ in 0..random.i32(0..=2) {
            match random.i32(0..=5) {
                0 | 1 => world.block(&mut random),
                2 => world.stairs(&mut random),
                3 => world.hole(&mut random, Top::Blue),
                4 => world.hole(&mut random, Top::Green),
                _ => world.house(&mut random),
            }
        }
        world
    }

    fn index(&self, x: i32, z: i32) -> usize {
        (z * self.columns + x) as usize
    }

    fn at(&self, x: i32, z: i32) -> Option<(i32, Top)> {
        let inside = (0..self.columns).contains(&x) && (0..self.depth).contains(&z);
        inside.then(|| self.places[self.index(x, z)]).flatten()
    }

    /// A rectangle: left, right, back, front; right and front are exclusive.
    fn rectangle(&self, random: &mut Rng, width: [i32; 2], depth: [i32; 2]) -> [i32; 4] {
        let width = random.i32(width[0]..=width[1]).min(self.columns);
        let depth = random.i32(depth[0]..=depth[1]).min(self.depth);
        let x = random.i32(0..=self.columns - width);
        let z = random.i32(0..=self.depth - depth);
        [x, x + width, z, z + depth]
    }

    fn fill(&mut self, [left, right, back, front]: [i32; 4], height: i32, top: Top) {
        for z in back..front {
            for x in left..right {
                let index = self.index(x, z);
                self.places[index] = Some((height, top));
            }
        }
    }

    /// The height of a rectangle of grass with a margin around it, if it is flat.
    fn flat(&self, [left, right, back, front]: [i32; 4], margin: i32) -> Option<i32> {
        let first = self.at(left, back)?;
        let all = (back - margin..front + margin)
            .flat_map(|z| (left - margin..right + margin).map(move |x| (x, z)))
            .all(|(x, z)| self.at(x, z) == Some(first));
        (all && first.1 == Top::Green).then_some(first.0)
    }

    fn plateau(&mut self, random: &mut Rng) {
        let place = self.rectangle(random, [3, 12], [3, 10]);
        let height = random.i32(1..=4);
        self.fill(place, height, Top::Green);
    }

    fn block(&mut self, random: &mut Rng) {
        for _ in 0..20 {
            let place = self.rectangle(random, [1, 4], [1, 4]);
            if let Some(height) = self.flat(place, 0) {
                let height = height + random.i32(1..=3);
                return self.fill(place, height, Top::Green);
            }
        }
    }

    fn stairs(&mut self, random: &mut Rng) {
        let steps = random.i32(2..=4);
        let sideways = random.u8(..100) < 40;
        for _ in 0..20 {
            let size = [[steps, steps], [2, 4]];
            let [width, depth] = if sideways { size } else { [size[1], size[0]] };
            let place = self.rectangle(random, width, depth);
            let Some(height) = self.flat(place, 0) else {
                continue;
            };
            let [left, right, back, front] = place;
            for step in 0..steps {
                let strip = if sideways {
                    [left + step, left + step + 1, back, front]
                } else {
                    [left, right, front - step - 1, front - step]
                };
                self.fill(strip, height + step + 1, Top::Green);
            }
            return;
        }
    }

    /// A pond or a pit with banks on all sides.
    fn hole(&mut self, random: &mut Rng, top: Top) {
        for _ in 0..20 {
            let place = self.rectangle(random, [1, 5], [2, 5]);
            if let Some(height) = self.flat(place, 1) {
                let height = height - random.i32(1..=2);
                return self.fill(place, height, top);
            }
        }
    }

    fn house(&mut self, random: &mut Rng) {
        for _ in 0..20 {
            let place = self.rectangle(random, [2, 5], [2, 4]);
            if let Some(base) = self.flat(place, 0) {
                let height = base + random.i32(1..=3);
                self.houses += 1;
                return self.fill(place, height, Top::Roof(self.houses, base));
            }
        }
    }

    /// The visible face in a cell: the nearest on the line of sight z = row + y.
    fn sight(&self, x: i32, row: i32, [low, high]: [i32; 2]) -> Option<Sight> {
        (low..=high).rev().find_map(|y| {
            let z = row + y;
            let (height, top) = self.at(x, z)?;
            let face = match top {
                Top::Roof(house, _) => house,
                _ => 0,
            };
            if height == y {
                let look = match top {
                    Top::Green => GREEN,
                    Top::Blue => BLUE,
                    Top::Roof(..) => RED,
                };
                let face = (height, face);
                return Some(Sight { look, height, face });
            }
            let wall = matches!(top, Top::Roof(_, base) if y >= base);
            (height > y).then_some(Sight {
                look: if wall { BEIGE } else { BROWN },
                height: y,
                face: (z, if wall { face } else { 0 }),
            })
        })
    }

    /// The cells of the plan that the drawing does not show, although something is drawn where they would be seen: column, z
    /// from the drawing's first row, and the height of the ground or water there; `None` where there is nothing.
    pub(crate) fn hidden(&self) -> Vec<([i32; 2], Option<i32>)> {
        let [low, high] = self.bounds();
        let places = (0..self.depth).flat_map(|z| (0..self.columns).map(move |x| (x, z)));
        let hidden = places.filter_map(|(x, z)| {
            let height = match self.at(x, z) {
                Some((_, Top::Roof(..))) => return None,
                place => place.map(|(height, _)| height),
            };
            let sight = self.sight(x, z - height.unwrap_or(0), [low, high])?;
            let shows = sight.look == GREEN || sight.look == BLUE;
            let is_seen = shows && Some(sight.height) == height;
            (!is_seen).then_some(([x, z + high], height))
        });
        hidden.collect()
    }

    /// The lowest and the highest top, including the ground at 0.
    fn bounds(&self) -> [i32; 2] {
        let heights = self.places.iter().flatten().map(|(height, _)| *height);
        let high = heights.clone().max().unwrap_or(0);
        [heights.min().unwrap_or(0).min(0), high]
    }

    /// The map: with edges wherever heights or faces of neighbours differ.
    pub(crate) fn draw(&self) -> Drawn {
        let [low, high] = self.bounds();
        let rows = self.depth + high;
        let sights: Vec<Option<Sight>> = (-high..self.depth)
            .flat_map(|row| (0..self.columns).map(move |x| (x, row)))
            .map(|(x, row)| self.sight(x, row, [low, high]))
            .collect();
        let mut map = Map::empty(self.columns as usize, rows as usize);
        for (cell, sight) in sights.iter().enumerate() {
            let Some(sight) = sight else { continue };
            map.cells[cell] = sight.look;
            let differs = |other: usize| {
                let other = sights.get(other).copied().flatten();
                other.is_some_and(|other| other.look == sight.look && other.face != sight.face)
            };
            if (cell + 1) % map.columns != 0 && differs(cell + 1) {
                map.edges[cell] |= EDGE_RIGHT;
            }
            if differs(cell + map.columns) {
                map.edges[cell] |= EDGE_BELOW;
            }
        }
        Drawn {
            map,
            heights: sights
                .iter()
                .map(|sight| sight.map(|sight| sight.height))
                .collect(),
        }
    }
}

/// A meaningless map: overlapping rectangles of all kinds, and edges anywhere.
pub(crate) fn scribble(seed: u64) -> Map {
    let mut random = Rng::with_seed(seed ^ 0x5c21_bb1e);
    let (columns, rows) = (random.i32(1..=18), random.i32(1..=22));
    let mut map = Map::empty(columns as usize, rows as usize);
    for _ in 0..random.i32(1..=24) {
        let look = random.i32(0..=5) as u8;
        let (left, top) = (random.i32(0..=columns - 1), random.i32(0..=rows - 1));
        let (right, bottom) = (left + random.i32(1..=7), top + random.i32(1..=7));
        for row in top..bottom.min(rows) {
            for column in left..right.min(columns) {
                let cell = map.index(column as usize, row as usize);
                map.cells[cell] = look;
            }
        }
    }
    let percent = [0, 3, 20][random.i32(0..=2) as usize];
    for edges in &mut map.edges {
        if random.i32(..100) < percent {
            *edges = random.i32(1..=3) as u8;
        }
    }
    map
}

/// A map as text: a letter per cell.
pub(crate) fn picture(map: &Map) -> String {
    let letters = [' ', 'g', 'b', 'w', 'R', 'B', 'r'];
    let rows = map.cells.chunks(map.columns);
    let line =
        |row: &[u8]| -> String { row.iter().map(|look| letters[usize::from(*look)]).collect() };
    rows.map(|row| line(row) + "\n").collect()
}

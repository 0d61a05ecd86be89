//! Generated regions in two views.

use glam::{DAffine2, DMat2, DVec2};

use crate::geometry::{Outline, Polygon, Ring};

/// A region drawn twice.
pub(crate) struct Pair {
    pub(crate) name: &'static str,
    pub(crate) is_convex: bool,
    pub(crate) outlines: [Outline; 2],
    /// From the first view to the second.
    pub(crate) map: DAffine2,
}

/// Numbers that look random (SplitMix64).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn count(&mut self, low: usize, high: usize) -> usize {
        low + (self.next() % (high - low + 1) as u64) as usize
    }
}

/// A region of kind `index % 8`, turned by up to 20° and foreshortened to 60 % at the least, with other points in each view.
pub(crate) fn pair(index: u64) -> Pair {
    let mut random = Random(index * 7919 + 17);
    let draw = |random: &mut Random| -> (&'static str, [Ring; 2]) {
        let seed = random.next();
        let mut both = [0, 1].map(|_| {
            let points = random.count(24, 90);
            kind(index % 8, points, &mut Random(seed))
        });
        for (_, ring) in &mut both {
            let start = random.count(0, ring.len() - 1);
            ring.rotate_left(start);
        }
        let [(name, a), (_, b)] = both;
        (name, [a, b])
    };
    let (name, [a, b]) = draw(&mut random);
    let first = DAffine2::from_scale_angle_translation(
        DVec2::new(random.within(60.0, 160.0), random.within(60.0, 160.0)),
        random.within(-0.4, 0.4),
        DVec2::new(random.within(-500.0, 500.0), random.within(-500.0, 500.0)),
    );
    let mut view = DAffine2::from_angle(random.within(-20.0, 20.0).to_radians());
    let short = DVec2::new(random.within(0.6, 1.0), random.within(0.9, 1.1));
    view.matrix2 = DMat2::from_diagonal(short) * view.matrix2;
    view.translation = DVec2::new(random.within(-300.0, 300.0), random.within(-300.0, 300.0));
    let second = view * first;
    let place =
        |map: DAffine2, ring: &Ring| ring.iter().map(|p| map.transform_point2(*p)).collect();
    Pair {
        name,
        is_convex: index % 8 < 3,
        outlines: [
            outline(vec![place(first, &a)]),
            outline(vec![place(second, &b)]),
        ],
        map: view,
    }
}

/// One polygon.
pub(crate) fn outline(rings: Vec<Ring>) -> Outline {
    Outline {
        polygons: vec![Polygon { rings }],
    }
}

/// A closed curve by its angle, clockwise in a frame with y down.
pub(crate) fn curve(points: usize, radius: impl Fn(f64) -> DVec2) -> Ring {
    let each = (0..points).map(|i| -std::f64::consts::TAU * i as f64 / points as f64);
    each.map(radius).collect()
}

pub(crate) fn ellipse(points: usize, middle: DVec2, half: DVec2) -> Ring {
    curve(points, |angle| middle + DVec2::from_angle(angle) * half)
}

fn kind(kind: u64, points: usize, random: &mut Random) -> (&'static str, Ring) {
    match kind {
        0 => (
            "ellipse",
            ellipse(
                points,
                DVec2::ZERO,
                DVec2::new(1.0, random.within(0.4, 1.0)),
            ),
        ),
        1 => (
            "box",
            rounded(DVec2::new(1.0, random.within(0.3, 1.0)), 0.0, 1),
        ),
        2 => {
            let half = DVec2::new(1.0, random.within(0.3, 1.0));
            let radius = half.y * random.within(0.2, 0.9);
            ("rounded box", rounded(half, radius, points / 4))
        }
        3 => {
            let [rays, depth] = [random.within(4.0, 9.0).floor(), random.within(0.35, 0.7)];
            let ring = curve(2 * rays as usize, |angle| {
                let tip = (angle * rays / std::f64::consts::PI).round() as i64 % 2 == 0;
                DVec2::from_angle(angle) * if tip { 1.0 } else { depth }
            });
            ("star", ring)
        }
        4 => ("crescent", crescent(points, random.within(0.3, 0.75))),
        5 => ("hand", hand(points / 12 + 2, random)),
        6 => {
            let [neck, width] = [random.within(0.0, 0.5), random.within(0.15, 0.4)];
            let points = [
                (-1.0, -width),
                (-1.0, width),
                (neck, width),
                (neck, 0.8),
                (1.0, 0.0),
                (neck, -0.8),
                (neck, -width),
            ];
            ("arrow", points.map(DVec2::from).to_vec())
        }
        _ => {
            let waves: Vec<[f64; 2]> = (2..6)
                .map(|n| {
                    [
                        random.within(0.0, 0.5) / f64::from(n),
                        random.within(0.0, 6.3),
                    ]
                })
                .collect();
            let ring = curve(points, |angle| {
                let each = waves.iter().enumerate();
                let sum =
                    each.map(|(i, [size, phase])| size * ((i + 2) as f64 * angle + phase).sin());
                DVec2::from_angle(angle) * (1.0 + sum.sum::<f64>())
            });
            ("blob", ring)
        }
    }
}

fn rounded(half: DVec2, radius: f64, points: usize) -> Ring {
    let corners = [(1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(DVec2::from);
    let mut ring = Vec::new();
    for (number, corner) in corners.iter().enumerate() {
        let middle = *corner * (half - radius);
        if radius <= 0.0 {
            ring.push(middle);
            continue;
        }
        for i in 0..points {
            let angle = -(number as f64 + i as f64 / (points - 1).max(1) as f64)
                * std::f64::consts::FRAC_PI_2;
            ring.push(middle + DVec2::from_angle(angle) * radius);
        }
    }
    ring
}

fn crescent(points: usize, bite: f64) -> Ring {
    let half = points / 2;
    let arc = |depth: f64, i: usize| {
        let angle = std::f64::consts::PI * i as f64 / half as f64;
        DVec2::new(angle.cos(), -depth * angle.sin())
    };
    let outer = (0..half).map(|i| arc(1.0, i));
    let inner = (0..half).map(|i| arc(bite, half - i));
    outer.chain(inner).collect()
}

/// A palm with four fingers and a thumb.
fn hand(points: usize, random: &mut Random) -> Ring {
    let mut ring = vec![DVec2::new(0.5, 1.0)];
    for finger in 0..4 {
        let middle = 0.375 - 0.25 * f64::from(finger);
        let tip = -random.within(0.4, 0.8);
        ring.push(DVec2::new(middle + 0.11, 0.0));
        for i in 0..=points {
            let angle = -std::f64::consts::PI * i as f64 / points as f64;
            ring.push(DVec2::new(middle, tip) + DVec2::from_angle(angle) * 0.1);
        }
        ring.push(DVec2::new(middle - 0.11, 0.0));
    }
    for (x, y) in [
        (-0.5, 0.3),
        (-0.95, 0.1),
        (-1.0, 0.3),
        (-0.5, 0.7),
        (-0.45, 1.0),
    ] {
        ring.push(DVec2::new(x, y));
    }
    ring
}

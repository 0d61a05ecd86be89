use fastrand::Rng;
use glam::DVec3;

use super::poses::Poses;
use super::queue::{Queue, ascending, descending};
use super::segments::{Segments, drawing};
use super::{drawings, every, every_through, exact};

/// A motion of one joint, of `frames` frames; some stand still.
fn motion(random: &mut Rng, frames: usize, places: u64) -> Vec<DVec3> {
    let mut at = DVec3::ZERO;
    let mut motion = Vec::new();
    let mut still = 0;
    for _ in 0..frames {
        if still == 0 && random.u64(..6) == 0 {
            still = random.u64(..9);
        }
        if still > 0 {
            still -= 1;
        } else {
            at = DVec3::new(
                random.u64(..places) as f64,
                random.u64(..places) as f64,
                0.0,
            );
        }
        motion.push(at);
    }
    motion
}

#[test]
fn a_queue_gives_the_least_of_many_keys() {
    let mut random = Rng::with_seed(3);
    for count in [0, 1, 2, 3, 5, 8, 13, 64, 100] {
        let mut keys: Vec<u64> = (0..count).map(|_| random.u64(..9)).collect();
        let mut queue = Queue::new(keys.clone());
        for _ in 0..400 {
            let least = (0..keys.len()).filter(|entry| keys[*entry] != Queue::OUT);
            assert_eq!(
                queue.first(),
                least.min_by_key(|entry| (keys[*entry], *entry))
            );
            if count > 0 {
                let entry = random.u64(..count) as usize;
                keys[entry] = match random.u64(..4) {
                    0 => Queue::OUT,
                    _ => random.u64(..9),
                };
                queue.set(entry, keys[entry]);
            }
        }
    }
}

#[test]
fn keys_are_ordered_as_the_numbers_are() {
    let numbers = [
        0.0,
        f64::MIN_POSITIVE / 4.0,
        1e-300,
        1.0,
        1.5,
        1e300,
        f64::INFINITY,
    ];
    for pair in numbers.windows(2) {
        assert!(ascending(pair[0]) < ascending(pair[1]));
        assert!(descending(pair[0]) > descending(pair[1]));
    }
    let keys = numbers
        .iter()
        .flat_map(|number| [ascending(*number), descending(*number)]);
    assert!(keys.max() < Some(Queue::OUT));
}

/// The least cost of any choice of drawings, by their number: all segments, all drawings of each, no shortcut. The frame `key` is
/// the drawing of its segment.
fn least(motion: &[DVec3], max_hold: usize, key: Option<usize>) -> Vec<f64> {
    let cost = |start: usize, end: usize| {
        let all = start..end;
        let of = |drawing: usize| -> f64 {
            let apart = all
                .clone()
                .map(|frame| motion[frame].distance_squared(motion[drawing]));
            apart.sum()
        };
        let key = key.filter(|key| all.contains(key));
        let drawings = key.map_or(all.clone(), |key| key..key + 1);
        let least = drawings.map(of).fold(f64::INFINITY, f64::min);
        if end - start > max_hold && least > 0.0 {
            return f64::INFINITY;
        }
        least
    };
    let frames = motion.len();
    let mut table = vec![vec![f64::INFINITY; frames + 1]; frames + 1];
    table[0][0] = 0.0;
    for end in 1..=frames {
        for start in 0..end {
            let cost = cost(start, end);
            for count in 1..=end {
                table[end][count] = table[end][count].min(table[start][count - 1] + cost);
            }
        }
    }
    table.swap_remove(frames)
}

#[test]
fn the_best_drawings_are_optimal() {
    let mut random = Rng::with_seed(11);
    for round in 0..400 {
        let frames = 1 + random.u64(..30) as usize;
        let max_hold = 1 + random.u64(..9) as usize;
        let places = [2, 3, 10, 1_000_000][round % 4];
        let motion = self::motion(&mut random, frames, places);
        let key = match round % 3 {
            0 => None,
            _ => Some(random.usize(..frames)),
        };
        let least = least(&motion, max_hold, key);
        let fewest = least.iter().position(|cost| cost.is_finite()).unwrap_or(0);
        let poses = motion.chunk_by(|a, b| a == b).count();
        for asked in 0..frames + 3 {
            let drawn = drawings(Poses::new(&motion, 1).keeping(key), asked, max_hold);
            let count = asked.clamp(fewest, poses);
            assert_eq!([drawn.fewest, drawn.most], [fewest, poses]);
            assert_eq!([drawn.asked, drawn.drawings], [asked, count]);
            assert_eq!(drawn.exposure.drawings().count(), count);
            assert_eq!(drawn.exposure.len(), frames);
            if let Some(key) = key {
                let shown = drawn.exposure.sources[key] as usize;
                assert_eq!(motion[shown], motion[key], "the key pose is shown");
            }
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.max(1.0);
            assert!(
                near(drawn.cost, least[count]),
                "{drawn:?}, {}",
                least[count]
            );
            assert!(near(drawn.bound, drawn.cost));
            let mut shown = 0.0;
            for (frame, source) in drawn.exposure.sources.iter().enumerate() {
                shown += motion[frame].distance_squared(motion[*source as usize]);
            }
            assert!(near(shown, drawn.cost));
            for drawing in drawn.exposure.drawings() {
                let frames = drawing.start..drawing.start + drawing.length;
                assert!(frames.contains(&(drawing.source as usize)));
                let still = motion[frames].windows(2).all(|pair| pair[0] == pair[1]);
                assert!(drawing.length <= max_hold || still);
            }
        }
    }
}

#[test]
fn counts_that_no_penalty_yields_are_found() {
    // Two drawings are no better than one here, so no penalty yields two.
    let motion = [0.0, 1.0, 0.0].map(DVec3::splat);
    let costs = [1, 2, 3].map(|count| drawings(Poses::new(&motion, 1), count, 8).cost);
    assert_eq!(costs, [3.0, 3.0, 0.0]);
    // The table has to find what splitting alone does not.
    let mut random = Rng::with_seed(5);
    let mut tables = 0;
    for _ in 0..200 {
        let motion = self::motion(&mut random, 24, 1000);
        let frames = Poses::new(&motion, 1);
        let segments = Segments::new(frames, 5);
        let best: Vec<f64> = (5..20)
            .map(|count| exact::find(&segments, count).0.segmentation.cost)
            .collect();
        let convex = |costs: &[f64]| costs[0] + costs[2] >= 2.0 * costs[1] * (1.0 - 1e-12);
        tables += best.windows(3).filter(|costs| !convex(costs)).count();
    }
    assert!(tables > 20, "only {tables} numbers that no penalty gives");
}

#[test]
fn degenerate_motions_have_drawings() {
    assert!(drawings(Poses::new(&[], 0), 3, 8).exposure.is_empty());
    assert!(
        drawings(Poses::new(&[DVec3::ONE], 2), 3, 8)
            .exposure
            .is_empty()
    );
    let odd = [f64::NAN, f64::INFINITY, 1e300, -1e300, 0.0, f64::NAN, 2.0].map(DVec3::splat);
    for (count, max_hold) in [(0, 0), (1, 3), (4, 8), (usize::MAX, usize::MAX)] {
        let drawn = drawings(Poses::new(&odd, 1), count, max_hold);
        assert_eq!(drawn.exposure.len(), odd.len());
        assert!(drawn.cost.is_finite());
    }
    let still = vec![DVec3::ONE; 100];
    assert_eq!(
        drawings(Poses::new(&still, 1), 7, 8).exposure.sources,
        vec![0; 100]
    );
}

#[test]
fn of_equally_good_drawings_the_first_is_taken() {
    let motion = [0.0, 1.0].map(DVec3::splat);
    assert_eq!(drawing(Poses::new(&motion, 1), 0, 2, 8), 0);
}

#[test]
fn each_second_or_third_frame_is_a_drawing() {
    assert_eq!(every(5, 2).sources, [0, 0, 2, 2, 4]);
    assert_eq!(every(5, 3).sources, [0, 0, 0, 3, 3]);
    assert_eq!(every(2, 0).sources, [0, 1]);
    assert!(every(0, 3).is_empty());
    assert_eq!(every_through(6, 3, 4).sources, [0, 1, 1, 1, 4, 4]);
    assert_eq!(every_through(6, 3, 2).sources, [0, 0, 2, 2, 2, 5]);
}

#[test]
fn the_bound_holds_where_many_choices_are_equally_good() {
    // Penalties yield even numbers only, and the table between them would be too large.
    let motion: Vec<DVec3> = (0..100_000)
        .map(|frame| DVec3::X * f64::from(frame % 2))
        .collect();
    let drawn = drawings(Poses::new(&motion, 1), 50_001, 8);
    assert_eq!(drawn.exposure.drawings().count(), 50_001);
    assert_eq!([drawn.cost, drawn.bound], [25_000.0, 24_999.5]);
    // An even number is found by a penalty at once.
    let drawn = drawings(Poses::new(&motion, 1), 50_000, 8);
    assert_eq!([drawn.cost, drawn.bound], [25_000.0; 2]);
}

#[test]
fn segments_are_the_same_from_either_end() {
    let mut random = Rng::with_seed(8);
    for _ in 0..100 {
        let motion = self::motion(&mut random, 40, 9);
        let max_hold = 1 + random.u64(..5) as usize;
        let segments = Segments::new(Poses::new(&motion, 1), max_hold);
        let starting = (0..40).flat_map(|start| {
            let ends = segments.starting(start);
            ends.map(move |(end, cost)| (start, end, cost.to_bits()))
        });
        let ending = (1..=40).flat_map(|end| {
            let starts = segments.ending(end);
            starts.map(move |(start, cost)| (start, end, cost.to_bits()))
        });
        let [mut starting, mut ending] = [starting.collect::<Vec<_>>(), ending.collect()];
        starting.sort_unstable();
        ending.sort_unstable();
        assert_eq!(starting, ending);
    }
}

use glam::DVec2;
use typed_index_collections::TiVec;

use super::behind::{Back, Backs};
use super::symmetry::symmetry;
use super::*;
use crate::billboard::region::{Region, View};
use crate::billboard::tests::generated::random::Random;
use crate::billboard::tests::generated::{Character, Drawn, FITTED, HELD_BACK, character};
use crate::geometry::{FillRule, area, intersect, resolve_overlaps, subtract, union};

/// What decides whether a character is symmetric: it may hold a tool, or have its tail on one side.
const LIMBS: [&str; 7] = ["arm", "hand", "leg", "foot", "ear", "hair tail", "trunk"];

fn direction(theta: f64) -> Direction {
    Direction { theta, phi: 0.0 }
}

/// The area in which items of a kind are seen.
fn seen(drawn: &Drawn, kinds: &[&str], kind: &str, axis: Option<f64>) -> crate::geometry::Outline {
    let regions = drawn.view.regions.iter().zip(&drawn.items);
    let own = regions.filter(|(_, item)| kinds[**item] == kind);
    let own = own.map(|(region, _)| match axis {
        Some(axis) => mirror::outline(&region.outline, axis),
        None => (*region.outline).clone(),
    });
    union(&own.collect::<Vec<_>>())
}

/// How far an item is at most from the mirror image of the nearest one of its kind: in space, and as seen from the front. Heights.
fn apart(who: &Character, item: usize) -> [f64; 2] {
    let image = who.center(item) * glam::DVec3::new(-1.0, 1.0, 1.0);
    let of_kind = |other: &usize| who.items[*other].kind == who.items[item].kind;
    let ways = (0..who.items.len())
        .filter(of_kind)
        .map(|other| who.center(other) - image);
    let (in_space, in_front): (Vec<f64>, Vec<f64>) = ways
        .map(|way| (way.length(), way.truncate().length()))
        .unzip();
    [in_space, in_front].map(|all| all.into_iter().fold(f64::INFINITY, f64::min))
}

/// What came of generated characters.
#[derive(Debug, Default)]
struct Counts {
    /// Symmetric ones, and how many are found to be.
    symmetric: [usize; 2],
    /// Those with a limb elsewhere than the other one as seen from the front, and how many are taken for symmetric.
    lopsided: [usize; 2],
    /// Of symmetric ones that are found, how the mirror image of a view overlaps with what is truly seen, for each kind of thing.
    overlaps: Vec<f64>,
}

fn measured(seeds: impl Iterator<Item = u64>) -> Counts {
    let mut counts = Counts::default();
    for seed in seeds {
        let who = character(seed);
        let apart: Vec<[f64; 2]> = (0..who.items.len()).map(|item| apart(&who, item)).collect();
        let limbs = || (0..who.items.len()).filter(|item| LIMBS.contains(&who.items[*item].kind));
        let is_symmetric = limbs().all(|item| apart[item][0] < 0.01);
        let is_lopsided = limbs().any(|item| apart[item][1] > 0.1);
        let is_found = symmetry(&who.true_view(direction(0.0)).view).is_symmetric;
        for (counts, is_one) in [
            (&mut counts.symmetric, is_symmetric),
            (&mut counts.lopsided, is_lopsided),
        ] {
            counts[0] += usize::from(is_one);
            counts[1] += usize::from(is_one && is_found);
        }
        if !(is_symmetric && is_found) {
            continue;
        }
        let [left, right] = [45.0, -45.0].map(|theta| who.true_view(direction(theta)));
        let kinds: Vec<&str> = who.items.iter().map(|item| item.kind).collect();
        let mut of_kinds = kinds.clone();
        of_kinds.sort_unstable();
        of_kinds.dedup();
        // A badge is on one side only.
        let is_on_both =
            |kind: &&str| (0..kinds.len()).all(|i| kinds[i] != *kind || apart[i][0] < 0.01);
        for kind in of_kinds.into_iter().filter(is_on_both) {
            // The centre of the true characters is at their origin.
            let image = seen(&left, &kinds, kind, Some(0.0));
            let truth = seen(&right, &kinds, kind, None);
            let whole = area(&union(&[image.clone(), truth.clone()]));
            if whole > 0.0 {
                counts
                    .overlaps
                    .push(area(&intersect(&image, &truth)) / whole);
            }
        }
    }
    counts
}

#[test]
fn symmetric_characters_look_like_their_mirror_images_from_the_other_side() {
    for seeds in [FITTED, HELD_BACK] {
        let counts = measured(seeds);
        let overlap = counts.overlaps.iter().sum::<f64>() / counts.overlaps.len() as f64;
        let (symmetric, lopsided) = (counts.symmetric, counts.lopsided);
        let [all, found] = symmetric;
        assert!(all > 15 && found * 10 >= all * 9, "{found} of {all}");
        let [all, found] = lopsided;
        assert!(all > 15 && found * 20 <= all, "{found} of {all}");
        assert!(overlap > 0.95, "{overlap}");
    }
}

#[test]
fn what_has_a_large_part_on_one_side_only_is_not_symmetric() {
    let (mut symmetric, mut of) = (0, 0);
    for seed in HELD_BACK.take(60) {
        let mut view = character(seed).true_view(direction(0.0)).view;
        let found = symmetry(&view);
        let areas: TiVec<RegionId, f64> = view.regions.iter().map(|r| area(&r.outline)).collect();
        let largest = areas.iter().copied().fold(0.0, f64::max);
        let partners = found.partners.iter_enumerated();
        let mut pairs = partners.filter(|(id, partner)| {
            partner.is_some_and(|other| other != *id) && areas[*id] > 0.1 * largest
        });
        let Some((id, _)) = pairs.next().filter(|_| found.is_symmetric) else {
            continue;
        };
        of += 1;
        // Up by half of the height.
        let up = view
            .bounds()
            .map_or(0.0, |(low, high)| (high.y - low.y) / 2.0);
        let region = &mut view.regions[id];
        let moved =
            |ring: &Vec<glam::DVec2>| ring.iter().map(|p| *p - glam::DVec2::Y * up).collect();
        region.outline = std::sync::Arc::new(region.outline.map_rings(moved));
        symmetric += usize::from(symmetry(&view).is_symmetric);
    }
    assert!(of > 10 && symmetric == 0, "{symmetric} of {of}");
}

/// A rectangle.
fn rectangle([x, y, width, height]: [f64; 4], color: [f64; 3], container: Option<usize>) -> Region {
    let corners = [
        [x, y],
        [x, y + height],
        [x + width, y + height],
        [x + width, y],
    ];
    let [r, g, b] = color;
    Region {
        name: None,
        outline: std::sync::Arc::new(crate::geometry::resolve_overlaps(
            vec![corners.map(glam::DVec2::from).to_vec()],
            crate::geometry::FillRule::NonZero,
        )),
        color: [r, g, b, 1.0],
        container: container.map(RegionId::from),
        is_line: false,
    }
}

#[test]
fn hair_covers_a_face_and_a_shirt_does_not_cover_trousers() {
    let (hair, skin, red, blue, white) = (
        [0.3, 0.2, 0.1],
        [0.9, 0.8, 0.6],
        [0.8, 0.1, 0.1],
        [0.1, 0.1, 0.8],
        [1.0; 3],
    );
    let regions = vec![
        rectangle([20.0, 0.0, 40.0, 40.0], hair, None),
        rectangle([28.0, 12.0, 24.0, 32.0], skin, None),
        rectangle([32.0, 20.0, 5.0, 5.0], white, Some(1)),
        rectangle([43.0, 20.0, 5.0, 5.0], white, Some(1)),
        // A neck, a shirt with bare arms beside it, a logo on it, and trousers as wide as it.
        rectangle([35.0, 44.0, 10.0, 6.0], skin, None),
        rectangle([22.0, 50.0, 36.0, 40.0], red, None),
        rectangle([12.0, 52.0, 10.0, 36.0], skin, None),
        rectangle([58.0, 52.0, 10.0, 36.0], skin, None),
        rectangle([36.0, 60.0, 6.0, 6.0], white, Some(5)),
        rectangle([22.0, 90.0, 36.0, 12.0], blue, None),
        // A belly of another colour on something round.
        rectangle([80.0, 0.0, 60.0, 100.0], red, None),
        rectangle([90.0, 20.0, 40.0, 60.0], white, Some(10)),
    ];
    let view = View {
        direction: direction(0.0),
        regions: regions.into(),
    };
    let backs = Backs::of(&view);
    let under = |cover: usize| Back::Under(RegionId::from(cover));
    let (own, hidden) = (Back::Own, Back::Hidden);
    let expected = [
        own,
        under(0),
        hidden,
        hidden,
        own,
        own,
        own,
        own,
        hidden,
        own,
        own,
        under(10),
    ];
    assert_eq!(backs.0.raw, expected);
}

/// What is on one side only.
const ADDITIONS: [&str; 6] = ["stick", "bag", "fringe", "tail", "badge", "raised arm"];

/// A region around some corners, heights around a place.
fn polygon(
    at: DVec2,
    corners: impl Iterator<Item = DVec2>,
    color: [f64; 4],
    scale: f64,
    container: Option<RegionId>,
) -> Region {
    let ring = corners.map(|corner| at + corner * scale).collect();
    Region {
        name: None,
        outline: std::sync::Arc::new(resolve_overlaps(vec![ring], FillRule::NonZero)),
        color,
        container,
        is_line: false,
    }
}

fn ellipse(half: DVec2, turned: f64) -> impl Iterator<Item = DVec2> {
    let angle = |i| f64::from(i) / 24.0 * std::f64::consts::TAU;
    (0..24).map(move |i| DVec2::from_angle(turned).rotate(DVec2::from_angle(angle(i)) * half))
}

fn oblong(half: DVec2, turned: f64) -> impl Iterator<Item = DVec2> {
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
    let corner = move |(x, y)| DVec2::from_angle(turned).rotate(DVec2::new(x, y) * half);
    corners.into_iter().map(corner)
}

/// The front view of a character with something on one side only. `None` if it has no place for that.
fn with_addition(who: &Character, addition: &str, random: &mut Random) -> Option<View> {
    let Drawn {
        mut view, items, ..
    } = who.true_view(direction(0.0));
    let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
    let middle = who.center(items_of(who, "trunk")[0]).x * who.scale;
    // The outermost region of a kind on that side, and the box around it.
    let of_kind = |kind: &str| {
        let regions = items.iter_enumerated();
        let own = regions.filter(|(_, item)| who.items[**item].kind == kind);
        let boxes = own.filter_map(|(id, _)| {
            let (low, high) = bounds(&view.regions[id].outline)?;
            Some((id, (low + high) / 2.0, (high - low) / 2.0))
        });
        boxes.max_by(|a, b| (a.1.x * side).total_cmp(&(b.1.x * side)))
    };
    let color = random.color(0.0, 1.0);
    let (trunk, at_trunk, half_trunk) = of_kind("trunk")?;
    let aside = |at: DVec2, across: f64, up: f64| at + DVec2::new(side * across, -up);
    let scale = who.scale;
    let region = match addition {
        "stick" => {
            let (_, hand, _) = of_kind("hand")?;
            let half = DVec2::new(random.between(0.01, 0.025), random.between(0.2, 0.45));
            let at = aside(hand, 0.0, random.between(-0.1, 0.3) * scale);
            polygon(
                at,
                oblong(half, random.between(-0.3, 0.3)),
                color,
                scale,
                None,
            )
        }
        "bag" => {
            let at = aside(
                at_trunk,
                half_trunk.x * random.between(0.9, 1.2),
                -half_trunk.y * 0.8,
            );
            let half = DVec2::new(random.between(0.04, 0.09), random.between(0.05, 0.1));
            polygon(at, oblong(half, 0.0), color, scale, None)
        }
        "fringe" => {
            let (head, at, half) = of_kind("head")?;
            // From the parting over the brow to beside the head.
            let parting = random.between(-0.5, 0.5);
            let corners = [
                (parting, -1.0),
                (parting, -0.6),
                (1.1, -0.1),
                (1.1, -0.6),
                (0.7, -1.0),
            ];
            let corners = corners.map(|(x, y)| DVec2::new(x * side, y) * half / scale);
            polygon(at, corners.into_iter(), color, scale, Some(head))
        }
        "tail" => {
            let at = aside(
                at_trunk,
                half_trunk.x * 1.2,
                -half_trunk.y * random.between(0.3, 1.0),
            );
            let half = DVec2::new(random.between(0.08, 0.2), random.between(0.02, 0.05));
            polygon(
                at,
                ellipse(half, -side * random.between(0.0, 1.0)),
                color,
                scale,
                None,
            )
        }
        "badge" => {
            let at = aside(at_trunk, 0.5 * half_trunk.x, 0.4 * half_trunk.y);
            let half = DVec2::splat(random.between(0.015, 0.03));
            polygon(at, ellipse(half, 0.0), color, scale, Some(trunk))
        }
        _ => {
            let (arm, at, half) = of_kind("arm")?;
            let shoulder = at.y - 0.8 * half.y;
            let up = |ring: &Vec<DVec2>| {
                let image = |p: &DVec2| DVec2::new(p.x, 2.0 * shoulder - p.y);
                ring.iter().rev().map(image).collect()
            };
            let parts = [Some(arm), of_kind("hand").map(|(hand, ..)| hand)];
            let is_beside = |id: &RegionId| {
                let place = bounds(&view.regions[*id].outline);
                place.is_some_and(|(low, high)| ((low.x + high.x) / 2.0 - middle) * side > 0.0)
            };
            let parts: Vec<RegionId> = parts.into_iter().flatten().filter(is_beside).collect();
            for part in parts {
                let region = &mut view.regions[part];
                region.outline = std::sync::Arc::new(region.outline.map_rings(up));
            }
            return Some(view);
        }
    };
    // In pictures, what is seen in front cuts what is behind it.
    if addition != "tail" && random.below(2) == 0 {
        for behind in &mut view.regions {
            let rest = subtract(&behind.outline, &region.outline);
            if area(&rest) > 0.0 {
                behind.outline = std::sync::Arc::new(rest);
            }
        }
    }
    if addition == "tail" {
        // Behind all others.
        for region in &mut view.regions {
            region.container = region
                .container
                .map(|container| RegionId::from(usize::from(container) + 1));
        }
        view.regions.insert(RegionId::FIRST, region);
    } else {
        view.regions.push(region);
    }
    Some(view)
}

fn items_of(who: &Character, kind: &str) -> Vec<usize> {
    let items = 0..who.items.len();
    items.filter(|item| who.items[*item].kind == kind).collect()
}

/// What came of an addition: how many characters, how many of them whose axis is where it should be, how many are symmetric without it,
/// and how many of those with it.
#[derive(Debug, Default, Clone, Copy)]
struct WithAddition {
    all: usize,
    exact: usize,
    symmetric: usize,
    still_symmetric: usize,
}

fn additions(seeds: impl Iterator<Item = u64>) -> [WithAddition; ADDITIONS.len()] {
    let mut counts = [WithAddition::default(); ADDITIONS.len()];
    for seed in seeds {
        let who = character(seed);
        let truth = who.center(items_of(&who, "trunk")[0]).x * who.scale;
        let index = seed as usize % ADDITIONS.len();
        let mut random = Random::new(seed);
        let Some(view) = with_addition(&who, ADDITIONS[index], &mut random) else {
            continue;
        };
        let is_symmetric = symmetry(&who.true_view(direction(0.0)).view).is_symmetric;
        let (found, counts) = (symmetry(&view), &mut counts[index]);
        counts.all += 1;
        counts.exact += usize::from((found.axis - truth).abs() < 0.005 * who.scale);
        counts.symmetric += usize::from(is_symmetric);
        counts.still_symmetric += usize::from(is_symmetric && found.is_symmetric);
    }
    counts
}

#[test]
fn what_is_added_on_one_side_does_not_move_the_axis() {
    for seeds in [FITTED, HELD_BACK] {
        let counts = additions(seeds);
        let all: usize = counts.iter().map(|counts| counts.all).sum();
        let exact: usize = counts.iter().map(|counts| counts.exact).sum();
        assert!(all >= 190 && exact * 50 >= all * 49, "{exact} of {all}");
        for (addition, counts) in ADDITIONS.into_iter().zip(counts) {
            let WithAddition {
                symmetric,
                still_symmetric,
                ..
            } = counts;
            assert!(symmetric >= 10, "{addition}: {counts:?}");
            if addition == "raised arm" {
                assert!(still_symmetric * 10 <= symmetric, "{counts:?}");
            } else {
                assert!(
                    still_symmetric * 10 >= symmetric * 9,
                    "{addition}: {counts:?}"
                );
            }
        }
    }
}

#[test]
fn what_is_drawn_from_its_side_is_not_symmetric() {
    for seeds in [FITTED, HELD_BACK] {
        let from = |seed: &u64, theta: f64| {
            let view = character(*seed).true_view(direction(theta)).view;
            symmetry(&view).is_symmetric
        };
        let mut found = 0;
        for theta in [45.0, 90.0] {
            found += seeds.clone().filter(|seed| from(seed, theta)).count();
        }
        assert!(found <= 12, "{found} of 400");
    }
}

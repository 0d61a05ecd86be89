//! Clips in which a surface of the mark's hue passes, such as a shirt, behind the mark or before it.

use fastrand::Rng;
use glam::DVec2;
use okoshi::internals::tracking::{Follower, Frame, Learner, Mark};

use super::synthetic::{Disc, Scene, ellipse};

/// Frames of each clip.
const FRAMES: usize = 120;
/// A mark is wrong if it is farther than this from the truth, pixels.
const WRONG: f64 = 10.0;

/// A clip with one mark.
struct Passing {
    scene: Scene,
    frames: Vec<Vec<u8>>,
}

/// A rectangle that passes.
#[derive(Clone, Copy)]
struct Surface {
    color: [u8; 3],
    /// Half its width and height, pixels.
    half: DVec2,
    /// Where its middle is in a frame.
    path: fn(f64) -> DVec2,
    is_in_front: bool,
}

fn scene(color: [u8; 3], radius: f64, path: fn(f64) -> DVec2, seeds: [u64; 2]) -> Scene {
    Scene {
        seeds,
        size: [320, 240],
        discs: vec![Disc::new(("mark", color), radius, path)],
        colorful: 0,
        patches: Vec::new(),
        noise: 5.0,
        shutter: 0.4,
        light: |_| 1.0,
    }
}

/// A mark that goes around, and a surface of its hue that passes behind or before it, numbered from 0: the first three were looked at
/// while the rules were made, three more were not.
fn passing(number: usize) -> Passing {
    let path: fn(f64) -> DVec2 = match number % 3 {
        0 => |time| ellipse(time, [160.0, 120.0], [100.0, 70.0], 7.0, 0.1),
        1 => |time| ellipse(time, [150.0, 110.0], [60.0, 80.0], 5.0, 0.6),
        _ => |time| {
            DVec2::new(
                160.0 + 90.0 * (time / 14.0).sin(),
                70.0 + 20.0 * (time / 9.0).cos(),
            )
        },
    };
    let (color, surface) = match number {
        0 => (
            [205, 40, 45],
            Surface {
                color: [190, 35, 45],
                half: DVec2::new(35.0, 55.0),
                path: |time| DVec2::new(4.0 * time - 80.0, 150.0),
                is_in_front: false,
            },
        ),
        1 => (
            [40, 150, 60],
            Surface {
                color: [45, 140, 60],
                half: DVec2::new(45.0, 40.0),
                path: |time| DVec2::new(160.0 + 120.0 * (time / 25.0).cos(), 130.0),
                is_in_front: true,
            },
        ),
        2 => (
            [40, 70, 190],
            Surface {
                color: [35, 60, 180],
                half: DVec2::new(30.0, 80.0),
                path: |time| DVec2::new(370.0 - 3.2 * time, 170.0),
                is_in_front: false,
            },
        ),
        3 => (
            [225, 205, 40],
            Surface {
                color: [210, 190, 45],
                half: DVec2::new(40.0, 60.0),
                path: |time| DVec2::new(160.0 + 140.0 * (time / 30.0).sin(), 160.0),
                is_in_front: false,
            },
        ),
        4 => (
            [40, 70, 190],
            Surface {
                color: [45, 75, 175],
                half: DVec2::new(50.0, 45.0),
                path: |time| DVec2::new(3.0 * time - 60.0, 110.0),
                is_in_front: true,
            },
        ),
        _ => (
            [205, 40, 45],
            Surface {
                color: [180, 40, 50],
                half: DVec2::new(28.0, 70.0),
                path: |time| DVec2::new(250.0 - 2.0 * time, 150.0),
                is_in_front: false,
            },
        ),
    };
    let seeds = [[7, 1000], [4_001, 100_000]][number / 3];
    let scene = scene(color, 8.0 - (number % 2) as f64, path, seeds);
    let still = scene.background();
    let frame = |number: usize| {
        let at = (surface.path)(number as f64);
        if surface.is_in_front {
            let mut pixels = scene.frame(&still, number);
            let mut random = Rng::with_seed(number as u64);
            paint(scene.size, at, surface.half, |index| {
                for (channel, color) in surface.color.iter().enumerate() {
                    pixels[3 * index + channel] = (color - 4) + random.u8(..9);
                }
            });
            pixels
        } else {
            let mut background = still.clone();
            paint(scene.size, at, surface.half, |index| {
                background[index] = surface.color.map(f64::from);
            });
            scene.frame(&background, number)
        }
    };
    Passing {
        frames: (0..FRAMES).map(frame).collect(),
        scene,
    }
}

/// Calls a function for all pixels of a rectangle.
fn paint([width, height]: [u32; 2], at: DVec2, half: DVec2, mut pixel: impl FnMut(usize)) {
    for y in 0..height {
        for x in 0..width {
            let away = (DVec2::new(f64::from(x), f64::from(y)) - at).abs();
            if away.cmple(half).all() {
                pixel((y * width + x) as usize);
            }
        }
    }
}

#[test]
fn a_surface_of_the_marks_hue_is_not_taken_for_it() {
    for number in 0..6 {
        let Passing { scene, frames } = passing(number);
        let frame = |number: usize| Frame::new(scene.size, &frames[number]).expect("it has pixels");
        let mark = Mark::new("mark", scene.discs[0].mark.1).expect("it is coloured");
        let mut learner = Learner::new(scene.size, vec![mark]);
        (0..FRAMES).for_each(|number| learner.push(frame(number)));
        let mut follower = Follower::new(learner.learned().expect("it is in the clip"));
        (0..FRAMES).for_each(|number| follower.push(frame(number)));
        let tracks = follower.tracks((0..FRAMES).map(|frame| frame as f64 / 24.0).collect());
        let mark = &tracks.marks.raw[0];
        let (mut right, mut wrong) = (0, 0);
        for number in (0..FRAMES).filter(|number| !mark.is_lost[*number]) {
            let is_wrong = mark.points[number].distance(scene.truth(number)[0].at) > WRONG;
            *(if is_wrong { &mut wrong } else { &mut right }) += 1;
        }
        eprintln!("passing surface {number}: {right} right, {wrong} wrong of {FRAMES}");
        assert_eq!(wrong, 0, "surface {number}");
        // Before the surface and behind it the mark cannot be seen.
        assert!(right >= 72, "surface {number}: only {right} frames");
    }
}

//! Motions that play in turn, joined by blends: what is shown in each frame, and where the body goes meanwhile.
//!
//! Each motion keeps its length. In the first frames of one the motion before it goes on, from cycle to cycle if it is a loop and else
//! in its last pose, and fades into it; before and after such a blend every frame is one of a motion.

use glam::{DQuat, DVec3};

use crate::smoothing::ease;

/// How long a blend takes, seconds.
const BLEND: f64 = 0.25;

/// How many frames a blend takes, given the seconds from frame to frame.
pub(crate) fn blend_frames(frame_time: f64) -> usize {
    (BLEND / frame_time).round() as usize
}

/// How long a motion plays among others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Playing {
    /// The number of steps from its first frame to its last one.
    pub steps: usize,
    /// How often that is played; more than once for loops only.
    pub cycles: usize,
    /// Whether its last frame is its first one.
    pub is_loop: bool,
}

impl Playing {
    /// A motion of so many steps that plays for so many seconds, if that is said: a loop as many whole cycles as come nearest to it, and
    /// anything else once.
    pub(crate) fn lasting(
        steps: usize,
        is_loop: bool,
        seconds: Option<f64>,
        frame_time: f64,
    ) -> Self {
        let cycle = steps as f64 * frame_time;
        let cycles = match seconds {
            // A number that is too large becomes the largest one.
            Some(seconds) if is_loop && cycle > 0.0 => ((seconds / cycle).round() as usize).max(1),
            _ => 1,
        };
        Self {
            steps,
            cycles,
            is_loop,
        }
    }

    /// The number of steps of all cycles.
    pub(crate) fn length(&self) -> usize {
        self.steps.saturating_mul(self.cycles)
    }

    /// The cycle and the frame in it that are shown so many steps after the beginning. Beyond the end loops go on, and others stand
    /// still.
    fn at(&self, step: usize) -> Place {
        match (self.is_loop, step.checked_div(self.steps)) {
            (true, Some(cycle)) => Place {
                cycle,
                frame: step % self.steps,
            },
            _ => Place {
                cycle: 0,
                frame: step.min(self.steps),
            },
        }
    }
}

/// A frame of a motion, in one of its cycles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Place {
    /// The number of the cycle, from 0.
    pub cycle: usize,
    /// The frame in it.
    pub frame: usize,
}

/// What is shown in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Moment {
    /// The number of the motion.
    pub motion: usize,
    /// Its frame.
    pub place: Place,
    /// The motion that fades into it, if one does, and that one's frame.
    pub fading: Option<Fading>,
}

/// A motion that fades into the next one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fading {
    pub motion: usize,
    pub place: Place,
    /// How much of it is left: 1 at the beginning, and then less, down to 0 in the frame in which the blend has ended.
    pub share: f64,
}

/// What is shown frame by frame: as many frames as the motions have steps, and a last one. `blend` is the number of frames of a blend;
/// shorter motions are blended over their whole length. In a loop the last motion fades into the first.
pub(crate) fn moments(motions: &[Playing], blend: usize, is_loop: bool) -> Vec<Moment> {
    let mut moments = Vec::new();
    let mut before = if is_loop {
        motions.len().checked_sub(1)
    } else {
        None
    };
    let played = motions.iter().enumerate();
    for (index, motion) in played.filter(|(_, motion)| motion.length() > 0) {
        let blend = blend.clamp(1, motion.length());
        // A loop that plays alone goes on as it is.
        let fading = before.filter(|before| *before != index || !motion.is_loop);
        moments.extend((0..motion.length()).map(|step| Moment {
            motion: index,
            place: motion.at(step),
            fading: fading.filter(|_| step <= blend).map(|before| Fading {
                motion: before,
                place: motions[before].at(motions[before].length() + step),
                share: 1.0 - ease(step as f64 / blend as f64),
            }),
        }));
        before = Some(index);
    }
    let last = moments.last().map_or(0, |last: &Moment| last.motion);
    if let Some(motion) = motions.get(last) {
        let end = motion.length();
        moments.push(Moment {
            motion: last,
            // The end of a cycle, and not the beginning of the next one, which a player does not show.
            place: match motion.is_loop && end > 0 {
                true => Place {
                    cycle: motion.cycles - 1,
                    frame: motion.steps,
                },
                false => motion.at(end),
            },
            fading: None,
        });
    }
    moments
}

/// The path of a motion's body, and how it is turned.
pub(crate) struct Path<'a> {
    /// Frame by frame the position of its root.
    pub root: &'a [DVec3],
    /// By how much it is turned about the vertical at its end.
    pub turn: DQuat,
}

impl Path<'_> {
    /// From the root's first place to the one in a frame of some cycle, without height. `up` is a unit vector.
    fn way(&self, place: Place, up: DVec3) -> DVec3 {
        let (Some(first), Some(last)) = (self.root.first(), self.root.last()) else {
            return DVec3::ZERO;
        };
        let own = self.root[place.frame] - *first + (*last - *first) * place.cycle as f64;
        own.reject_from(up)
    }
}

/// Frame by frame where the body's root is on the ground, from its first place, and per motion how it is turned about the vertical.
///
/// The body goes on from where it is, into the direction in which it is heading. In a blend its velocity is the mean of those of both
/// motions. `up` is a unit vector.
pub(crate) fn travel(
    moments: &[Moment],
    paths: &[Path<'_>],
    up: DVec3,
) -> (Vec<DVec3>, Vec<DQuat>) {
    let mut turn = DQuat::IDENTITY;
    let mut turns = Vec::with_capacity(paths.len());
    for path in paths {
        turns.push(turn);
        turn = (path.turn * turn).normalize();
    }
    let mut place = DVec3::ZERO;
    let mut places = Vec::with_capacity(moments.len());
    for (frame, moment) in moments.iter().enumerate() {
        if frame > 0 {
            let before = moments[frame - 1];
            let next = |motion: usize, from: Place, to: Place| {
                turns[motion] * (paths[motion].way(to, up) - paths[motion].way(from, up))
            };
            // What leads to a frame is a step of the motions that were shown in the one before.
            let own = if before.motion == moment.motion {
                next(moment.motion, before.place, moment.place)
            } else {
                match moment.fading {
                    Some(fading) => next(before.motion, before.place, fading.place),
                    None => DVec3::ZERO,
                }
            };
            let step = match (before.fading, moment.fading) {
                (Some(from), Some(to)) if from.motion == to.motion => {
                    let share = (from.share + to.share) / 2.0;
                    next(from.motion, from.place, to.place) * share + own * (1.0 - share)
                }
                (Some(from), None) => own * (1.0 - from.share / 2.0),
                _ => own,
            };
            place += step;
        }
        places.push(place);
    }
    (places, turns)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A motion of so many steps that goes one ahead in each, along z.
    fn ahead(steps: usize) -> Vec<DVec3> {
        let place = |step: u32| DVec3::new(5.0, 1.0, f64::from(step));
        (0..=steps as u32).map(place).collect()
    }

    #[test]
    fn a_turned_body_goes_on_where_it_is_heading() {
        let motion = |steps, cycles, is_loop| Playing {
            steps,
            cycles,
            is_loop,
        };
        let playing = [motion(20, 1, false), motion(10, 2, true)];
        let moments = moments(&playing, 6, false);
        assert_eq!(moments.len(), 41);
        let quarter = DQuat::from_rotation_y(90_f64.to_radians());
        let roots = [ahead(20), ahead(10)];
        let paths = [0, 1].map(|index| Path {
            root: &roots[index],
            turn: [quarter, DQuat::IDENTITY][index],
        });
        let (places, turns) = travel(&moments, &paths, DVec3::Y);
        assert!(places[20].distance(DVec3::Z * 20.0) < 1e-9);
        // The first motion stands still at its end, so the body starts slowly, to its new front.
        assert!((turns[1] * DVec3::Z).distance(DVec3::X) < 1e-9);
        let steps: Vec<DVec3> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(
            steps[20].x < 0.2 && steps[20].z.abs() < 1e-9,
            "{}",
            steps[20]
        );
        for step in &steps[26..] {
            assert!(step.distance(DVec3::X) < 1e-9, "{step}");
        }
    }

    #[test]
    fn a_loop_fades_from_its_end_into_its_beginning() {
        let one = Playing {
            steps: 8,
            cycles: 1,
            is_loop: false,
        };
        let shown = moments(&[one, one], 4, true);
        let first = shown[0].fading.expect("a blend");
        assert_eq!((first.motion, first.place.frame, first.share), (1, 8, 1.0));
        let last = shown[16];
        assert_eq!((last.motion, last.place.frame, last.fading), (1, 8, None));
        // Nothing fades into the first motion otherwise.
        assert_eq!(moments(&[one, one], 4, false)[0].fading, None);
        assert!(moments(&[], 4, true).is_empty());
    }
}

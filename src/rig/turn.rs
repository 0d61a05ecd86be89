//! Motions that play in turn in one clip of a figure.

use std::sync::Arc;

use glam::DQuat;

use super::builder::MatchedFigure;
use super::figure_clip::FigureTurn;
use crate::bind::MotionTurn;
use crate::memo::{Exactly, Memo, Same};
use crate::mocap::in_turn::{Playing, blend_frames};
use crate::mocap::travel::Ending;
use crate::prepare::{self, PreparedClip};
use crate::retarget::{self, RetargetedClip, Rig};

/// One of the motions that play in turn, on a figure.
pub(super) struct PlayedTurn<'a> {
    /// The file or the word.
    pub(super) link: &'a str,
    pub(super) matched: MatchedFigure,
    pub(super) motion: Arc<PreparedClip>,
    pub(super) playing: Playing,
}

impl<'a> PlayedTurn<'a> {
    /// A motion on a figure, for as long as a string says.
    pub(super) fn new(
        link: &'a str,
        matched: MatchedFigure,
        motion: Arc<PreparedClip>,
        said: &MotionTurn,
    ) -> Self {
        let steps = match &matched.moves {
            Some(moves) => moves.frames() - 1,
            None => prepare::steps_at(&motion.clip, said.speed),
        };
        let is_loop = motion.ending == Ending::Loop;
        let playing = Playing::lasting(steps, is_loop, said.seconds, motion.clip.frame_time);
        Self {
            link,
            matched,
            motion,
            playing,
        }
    }

    /// How many steps from frame to frame it takes.
    pub(super) fn length(&self) -> usize {
        self.playing.length()
    }
}

/// The number of the motion that stands for all, with its root, its parts and its joints: the first one that has joints.
pub(super) fn main(turns: &[PlayedTurn<'_>]) -> usize {
    let main = turns.iter().position(|turn| turn.matched.moves.is_none());
    main.unwrap_or(0)
}

/// The motions as reports see them.
pub(super) fn played(turns: &[PlayedTurn<'_>]) -> Vec<FigureTurn> {
    let mut next = 0;
    let played = turns.iter().map(|turn| {
        let first = next;
        next += turn.length();
        FigureTurn {
            file: turn.link.to_owned(),
            first,
            steps: turn.length(),
            cycles: turn.playing.cycles,
        }
    });
    played.collect()
}

/// Motions of a figure, as the key of the cached clip in which they play in turn.
#[derive(PartialEq, Eq, Hash)]
struct JoinKey {
    rig: Exactly<Arc<Rig>>,
    turns: Vec<TurnKey>,
    is_loop: bool,
}

/// One of them.
#[derive(PartialEq, Eq, Hash)]
struct TurnKey {
    rig: Exactly<Arc<Rig>>,
    clip: Same<RetargetedClip>,
    motion: Same<PreparedClip>,
    playing: Playing,
}

/// Motions on a figure in turn, given the rig and the clip of each; and the rig of the one that stands for all, in which everything is
/// driven that any of them moves.
pub(super) fn joined(
    turns: &[PlayedTurn<'_>],
    rigs: &[Arc<Rig>],
    clips: &[Arc<RetargetedClip>],
    is_loop: bool,
    memo: &Memo,
) -> (Arc<Rig>, Arc<RetargetedClip>) {
    let mut rig = Rig::clone(&rigs[main(turns)]);
    for (index, part) in rig.parts.iter_mut_enumerated() {
        let mut drives = rigs.iter().filter_map(|rig| rig.parts[index].drive);
        part.drive = part.drive.or_else(|| drives.next());
    }
    let rig = Arc::new(rig);
    let played = turns.iter().zip(rigs.iter().zip(clips));
    let key = JoinKey {
        rig: Exactly(Arc::clone(&rig)),
        turns: played
            .map(|(turn, (rig, clip))| TurnKey {
                rig: Exactly(Arc::clone(rig)),
                clip: Same(Arc::clone(clip)),
                motion: Same(Arc::clone(&turn.motion)),
                playing: turn.playing,
            })
            .collect(),
        is_loop,
    };
    let clip = memo.get(key, |key| {
        let turns = key.turns.iter().map(|turn| {
            let motion = &turn.motion.0;
            retarget::Turn {
                rig: &turn.rig.0,
                clip: &turn.clip.0,
                playing: turn.playing,
                // A loop ends as it begins.
                turn: match motion.ending {
                    Ending::Loop => DQuat::IDENTITY,
                    Ending::Open => {
                        retarget::turn(&motion.clip, &motion.landmarks(), turn.rig.0.facing)
                    }
                },
            }
        });
        let turns: Vec<retarget::Turn<'_>> = turns.collect();
        let first = key.turns.first();
        let frame_time = first.map_or(1.0, |turn| turn.motion.0.clip.frame_time);
        let blend = blend_frames(frame_time);
        Arc::new(retarget::joined(&key.rig.0, &turns, blend, key.is_loop))
    });
    (rig, clip)
}

#[cfg(test)]
mod tests;

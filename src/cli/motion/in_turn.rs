//! Clips that come along in turn, and parts of files in seconds.

use std::path::Path;

use super::super::args::Motion;
use crate::clips::BuiltIn;
use crate::diagnostic::nearest_word;
use crate::mocap::Clip;
use crate::mocap::resample::{Error, Range};
use crate::prepare::{self, Options, PreparedClip, Turn};

/// The clips that come along, as the arguments name them, each with its seconds.
pub(super) fn turns(first: BuiltIn, arguments: &Motion) -> Result<(Turn, Vec<Turn>), String> {
    if arguments.from.is_some() || arguments.to.is_some() {
        return Err(
            "--from and --to cut a file: a clip that comes along plays for so many seconds, as in `okoshi motion walk 2`"
                .to_owned(),
        );
    }
    let turn = |which: BuiltIn| {
        if which.moves_parts() {
            return Err(super::needs_a_figure(which));
        }
        Ok(Turn {
            clip: prepare::built_in(which, arguments.legs),
            seconds: None,
        })
    };
    let mut first = turn(first)?;
    let mut others: Vec<Turn> = Vec::new();
    for text in &arguments.in_turn {
        if let Ok(seconds) = text.parse::<f64>() {
            if !seconds.is_finite() || seconds <= 0.0 {
                return Err(format!(
                    "`{text}` seconds are not possible: write a number above 0"
                ));
            }
            let own = others.last_mut().unwrap_or(&mut first);
            if let Some(first) = own.seconds.replace(seconds) {
                return Err(format!(
                    "`{text}` is a second number of seconds, behind {first}: name the clip that plays for so long"
                ));
            }
            continue;
        }
        match BuiltIn::from_name(text) {
            Some(which) => others.push(turn(which)?),
            None => {
                return Err(nearest_word(text, words()).map_or_else(
                    || {
                        let words = words().collect::<Vec<_>>().join(", ");
                        format!("`{text}` is no clip that comes along: write a number of seconds, or one of {words}")
                    },
                    |near| unknown(text, near),
                ));
            }
        }
    }
    Ok((first, others))
}

/// The words for the clips that come along and have a skeleton.
fn words() -> impl Iterator<Item = &'static str> {
    let own = BuiltIn::ALL.iter().filter(|clip| !clip.moves_parts());
    own.map(|clip| clip.name())
}

/// The word that is meant where a file is expected: one that is nearly it, if there is no such file.
pub(super) fn meant(file: &Path) -> Option<&'static str> {
    let text = file.to_str().filter(|_| !file.exists())?;
    nearest_word(text, words())
}

/// That a word is none, and which is `near` to it.
pub(super) fn unknown(text: &str, near: &str) -> String {
    format!("`{text}` is no clip that comes along: did you mean `{near}`?")
}

/// Why nothing can follow a file.
pub(super) fn not_in_turn(text: &str) -> String {
    format!(
        "`{text}` cannot follow a file: clips that come along play in turn here, and files with them in a drawing, as in `Motion \"kick.bvh\" walk 2`"
    )
}

/// The clips as one, changed as the options ask.
pub(super) fn joined(
    (first, others): (Turn, Vec<Turn>),
    options: &Options,
) -> Result<PreparedClip, Error> {
    let each = Options {
        range: None,
        is_loop: false,
        ..*options
    };
    let changed = |turn: Turn| {
        let seconds = turn.seconds;
        let clip = turn.clip.change(&each)?;
        Ok(Turn { clip, seconds })
    };
    let first = changed(first)?;
    let others = others.into_iter().map(changed);
    let others = others.collect::<Result<Vec<_>, Error>>()?;
    let last = Options {
        fps: options.fps,
        range: options.range,
        ..Options::default()
    };
    prepare::in_turn(first, others, options.is_loop)?.change(&last)
}

/// The options with the range of frames that the seconds mean.
pub(super) fn cut(clip: &Clip, arguments: &Motion, options: Options) -> Result<Options, String> {
    let [from, to] = [arguments.from, arguments.to];
    if from.is_none() && to.is_none() {
        return Ok(options);
    }
    if let (Some(from), Some(to)) = (from, to)
        && from >= to
    {
        return Err(format!(
            "nothing is left of a motion from {from} to {to} seconds: write the beginning before the end"
        ));
    }
    let (range, outside) = Range::of_seconds(clip, [from, to]);
    if let Some(outside) = outside {
        return Err(format!(
            "the motion is {:.2} seconds long: it has no second {}",
            outside.seconds, outside.asked
        ));
    }
    Ok(Options { range, ..options })
}

//! Every track is read, or refused with a help; one that was read is the same when it is written and read again.

use okoshi::internals::mark_tracks::{ErrorLocation, MarkTracks};

pub(super) fn check(bytes: &[u8]) -> bool {
    match MarkTracks::from_bytes(bytes) {
        Ok(tracks) => {
            check_tracks(&tracks);
            true
        }
        Err(error) => {
            assert!(!error.help.is_empty() && !error.message.is_empty());
            if let ErrorLocation::Position { line, column } = error.location {
                let lines = 1 + bytes.iter().filter(|byte| **byte == b'\n').count();
                assert!((1..=lines).contains(&line) && column > 0, "{error:?}");
            }
            false
        }
    }
}

fn check_tracks(tracks: &MarkTracks) {
    let frames = tracks.times.len();
    assert!(frames > 0 && tracks.times[0] == 0.0 && tracks.times.is_sorted());
    assert!(!tracks.marks.is_empty());
    for mark in &tracks.marks {
        assert_eq!((mark.points.len(), mark.is_lost.len()), (frames, frames));
        assert!(mark.points.iter().all(|point| point.is_finite()));
    }
    // Numbers are rounded where they are written, so only what was written once stays as it is.
    let json = tracks.to_json();
    let again = MarkTracks::from_bytes(json.as_bytes()).expect("what was written is a track");
    assert_eq!(again.to_json(), json);
    let table = again.to_csv();
    let table = MarkTracks::from_bytes(table.as_bytes()).expect("what was written is a track");
    assert_eq!(table, again);
}

/// A track in both formats, and a table as a person writes it.
pub(super) fn seeds() -> Vec<Vec<u8>> {
    let table = "# 320x240 by hand\nframe;time;red_x;red_y;left-hand_x;left-hand_y\n\
                 0;0;31,9;109,1;146,5;183\n1;0,1;;;146,1;183,1\n2;0,2;31,2;108;145;182,5\n";
    let tracks = MarkTracks::from_bytes(table.as_bytes()).expect("a track");
    let written = [table.to_owned(), tracks.to_csv(), tracks.to_json()];
    written.into_iter().map(String::into_bytes).collect()
}

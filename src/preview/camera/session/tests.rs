use super::*;
use crate::preview::camera::frame::Picture;

const SIZE: [u16; 2] = [160, 120];
const RED: [u8; 3] = [200, 40, 35];
const BLUE: [u8; 3] = [40, 70, 200];

/// The middles of the red and the blue disc at a time in milliseconds.
fn middles(time: f64) -> [DVec2; 2] {
    let turn = time / 1e3 * 2.0;
    [
        DVec2::new(55.0 + 25.0 * turn.cos(), 60.0 + 25.0 * turn.sin()),
        DVec2::new(115.0, 60.0 + 30.0 * (turn * 1.3).sin()),
    ]
}

/// A picture of both discs; `brown` patches of still clutter are red, too, but pale.
fn picture(sequence: u32, time: f64) -> Picture {
    let mut pixels = Vec::new();
    let discs = middles(time);
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            let at = DVec2::new(f64::from(x), f64::from(y));
            let is_in = |disc: usize| at.distance(discs[disc]) < 9.0;
            pixels.extend(match (is_in(0), is_in(1)) {
                (true, _) => RED,
                (_, true) => BLUE,
                _ if x < 20 && y < 30 => [150, 110, 95],
                _ => [150, 150, 145],
            });
        }
    }
    Picture::read(&Picture::message(sequence, SIZE, time, &pixels)).unwrap()
}

/// A session in which both discs were picked in the first frame.
fn picked() -> Session {
    let mut session = Session::default();
    session.frame(picture(1, 0.0)).unwrap();
    for at in middles(0.0) {
        let answers = session.handle(FromCamera::Pick { x: at.x, y: at.y });
        assert!(matches!(&answers.unwrap()[..], [ToCamera::Marks { .. }]));
    }
    session
}

/// Sends the frames of two seconds.
fn play(session: &mut Session, first: u32, start: f64) {
    for frame in 0..50 {
        let time = start + f64::from(frame) * 40.0;
        session.frame(picture(first + frame, time)).unwrap();
    }
}

fn record(session: &mut Session, first: u32, start: f64) -> MarkTracks {
    assert!(session.handle(FromCamera::Record {}).unwrap().is_empty());
    play(session, first, start);
    match &session.handle(FromCamera::Stop {}).unwrap()[..] {
        [ToCamera::Track { file }] => MarkTracks::from_bytes(file.as_bytes()).unwrap(),
        other => panic!("{other:?}"),
    }
}

fn refused(result: Result<Vec<ToCamera>, Refusal>) -> String {
    result.unwrap_err().to_string()
}

#[test]
fn a_recording_becomes_a_track() {
    let mut session = picked();
    play(&mut session, 2, 40.0);
    let track = record(&mut session, 60, 2040.0);
    let names: Vec<_> = track.marks.iter().map(|mark| mark.name.as_str()).collect();
    assert_eq!(names, ["red", "blue"]);
    assert_eq!((track.size, track.times.len()), ([160, 120], 50));
    assert_eq!((track.times[0], track.times[49]), (0.0, 1.96));
    for (mark, track) in track.marks.iter().enumerate() {
        for (frame, at) in track.points.iter().enumerate() {
            let truth = middles(2040.0 + frame as f64 * 40.0)[mark];
            let is_right = !track.is_lost[frame] && at.distance(truth) < 0.5;
            assert!(
                is_right,
                "frame {frame} of {}: {at}, not {truth}",
                track.name
            );
        }
    }
    // Once more, and with another name.
    let again = record(&mut session, 200, 4040.0);
    assert_eq!(again.times.len(), 50);
    let name = "left-hand".to_owned();
    let answers = session.handle(FromCamera::Name { mark: 0, name }).unwrap();
    let [ToCamera::Marks { marks }, ToCamera::Track { file }] = &answers[..] else {
        panic!("{answers:?}");
    };
    assert_eq!((&*marks[0].name, &*marks[1].name), ("left-hand", "blue"));
    assert!(file.contains("\"left-hand\""));
}

#[test]
fn marks_are_followed_while_frames_arrive() {
    let mut session = picked();
    for frame in 1..30 {
        let time = f64::from(frame) * 40.0;
        let answer = session.frame(picture(1 + frame, time)).unwrap();
        let ToCamera::Seen {
            sequence,
            marks,
            recorded,
        } = answer
        else {
            panic!("{answer:?}");
        };
        assert_eq!((sequence, recorded, marks.len()), (1 + frame, 0, 2));
        for (seen, truth) in marks.iter().zip(middles(time)) {
            let [x, y, radius] = seen.unwrap();
            let off = DVec2::new(x, y).distance(truth);
            assert!(off < 1.0, "frame {frame}: off by {off}, radius {radius}");
            assert!((radius - 9.0).abs() < 1.0, "{radius}");
        }
    }
}

#[test]
fn marks_are_chosen_once_and_have_names_of_their_own() {
    let mut session = Session::default();
    let pick =
        |session: &mut Session, at: DVec2| session.handle(FromCamera::Pick { x: at.x, y: at.y });
    assert!(refused(pick(&mut session, DVec2::ZERO)).contains("no picture"));
    session.frame(picture(1, 0.0)).unwrap();
    assert!(refused(pick(&mut session, DVec2::new(80.0, 5.0))).contains("grey"));
    let [red, blue] = middles(0.0);
    for at in [red, blue, red + 3.0] {
        pick(&mut session, at).unwrap();
    }
    assert_eq!(session.marks.len(), 2, "the red one is pointed at twice");
    let mut name = |mark, name: &str| {
        let name = name.to_owned();
        session.handle(FromCamera::Name { mark, name })
    };
    for (mark, wrong) in [(0, "blue"), (0, ""), (0, "two words"), (2, "other")] {
        assert!(name(mark, wrong).is_err(), "{mark} {wrong}");
    }
    name(0, "blau").unwrap();
    assert!(session.handle(FromCamera::Remove { mark: 2 }).is_err());
    session.handle(FromCamera::Remove { mark: 0 }).unwrap();
    assert_eq!(session.marks[0].name, "blue");
    session.handle(FromCamera::Record {}).unwrap();
    assert!(refused(pick(&mut session, red)).contains("before the recording"));
}

#[test]
fn frames_come_in_order_and_in_one_size() {
    let mut session = picked();
    for (sequence, time) in [(1, 80.0), (0, 80.0), (2, 0.0), (2, 0.5)] {
        let refused = session.frame(picture(sequence, time)).unwrap_err();
        assert!(matches!(refused, Refusal::Order(_)));
    }
    session.handle(FromCamera::Record {}).unwrap();
    session.frame(picture(2, 40.0)).unwrap();
    let small = |sequence, time| {
        let message = Picture::message(sequence, [32, 24], time, &[90; 3 * 32 * 24]);
        Picture::read(&message).unwrap()
    };
    let refused_size = session.frame(small(3, 80.0)).unwrap_err();
    assert!(matches!(refused_size, Refusal::Size));
    assert!(refused(session.handle(FromCamera::Stop {})).contains("nothing was recorded"));
    // Without a recording, another size is no mistake: the phone was turned.
    let answer = session.frame(small(4, 120.0)).unwrap();
    assert!(matches!(answer, ToCamera::Seen { marks, .. } if marks == [None, None]));
    session.frame(picture(5, 160.0)).unwrap();
}

#[test]
fn a_recording_has_a_limit_and_needs_marks() {
    let mut session = Session::default();
    assert!(refused(session.handle(FromCamera::Record {})).contains("no marks"));
    assert!(refused(session.handle(FromCamera::Stop {})).contains("nothing was recorded"));
    let tiny = |sequence: u32| {
        let mut pixels = [90; 3 * 16 * 16];
        for pixel in pixels.chunks_exact_mut(3).take(16 * 6) {
            pixel.copy_from_slice(&RED);
        }
        let message = Picture::message(sequence, [16, 16], f64::from(sequence), &pixels);
        Picture::read(&message).unwrap()
    };
    session.frame(tiny(1)).unwrap();
    session.handle(FromCamera::Pick { x: 8.0, y: 2.0 }).unwrap();
    session.handle(FromCamera::Record {}).unwrap();
    let last = MAX_FRAMES as u32 + 1;
    for sequence in 2..=last {
        session.frame(tiny(sequence)).unwrap();
    }
    let full = session.frame(tiny(last + 1)).unwrap_err();
    assert!(matches!(full, Refusal::Full));
    assert!(session.handle(FromCamera::Stop {}).is_ok());
}

#[test]
fn a_mark_that_is_gone_is_lost_in_the_track() {
    let mut session = picked();
    play(&mut session, 2, 40.0);
    session.handle(FromCamera::Record {}).unwrap();
    for frame in 0..10 {
        let message = Picture::message(
            100 + frame,
            SIZE,
            3000.0 + f64::from(frame),
            &vec![120; 3 * 160 * 120],
        );
        session.frame(Picture::read(&message).unwrap()).unwrap();
    }
    let answers = session.handle(FromCamera::Stop {}).unwrap();
    let [ToCamera::Track { file }] = &answers[..] else {
        panic!("{answers:?}");
    };
    let track = MarkTracks::from_bytes(file.as_bytes()).unwrap();
    assert!(track.marks.iter().all(|mark| mark.is_lost == [true; 10]));
}

use glam::DVec2;
use proptest::prelude::*;

use super::{Error, MarkTrack, MarkTracks, is_name};

/// A track of any marks, with numbers as they are written.
fn tracks() -> impl Strategy<Value = MarkTracks> {
    let names = prop::collection::hash_set("[a-zé_x-]{1,6}", 1..4);
    (names, 1..20_usize, 1..5000_u32, 1..5000_u32).prop_flat_map(|(names, frames, w, h)| {
        let steps = prop::collection::vec(1..9999_u32, frames - 1);
        let coordinate =
            || (-100_000..1_000_000_i32).prop_map(|hundredths| f64::from(hundredths) / 100.0);
        let point = (coordinate(), coordinate()).prop_map(|(x, y)| DVec2::new(x, y));
        let mark = (
            any::<[u8; 3]>(),
            prop::collection::vec(point, frames),
            // Whether it is lost, and ambiguous if it is.
            prop::collection::vec(any::<[bool; 2]>(), frames),
        );
        let marks = prop::collection::vec(mark, names.len());
        (steps, marks).prop_map(move |(steps, marks)| {
            let mut ticks = vec![0];
            for step in steps {
                ticks.push(ticks[ticks.len() - 1] + step);
            }
            let named = names.iter().zip(marks);
            MarkTracks {
                size: [w, h],
                times: ticks
                    .into_iter()
                    .map(|tick| f64::from(tick) / 1e4)
                    .collect(),
                marks: named
                    .map(|(name, (color, points, states))| MarkTrack {
                        name: name.clone(),
                        color,
                        points,
                        is_lost: states.iter().map(|[lost, _]| *lost).collect(),
                        is_ambiguous: states.iter().map(|state| *state == [true; 2]).collect(),
                    })
                    .collect(),
            }
        })
    })
}

proptest! {
    #[test]
    fn what_is_written_is_read(tracks in tracks()) {
        prop_assert_eq!(&MarkTracks::from_bytes(tracks.to_json().as_bytes()).unwrap(), &tracks);
        prop_assert_eq!(&MarkTracks::from_bytes(tracks.to_csv().as_bytes()).unwrap(), &tracks);
    }

    #[test]
    fn spreadsheets_of_other_countries_are_read(tracks in tracks()) {
        let text = tracks.to_csv().replace(',', ";").replace('.', ",").replace('\n', ";\r\n");
        prop_assert_eq!(&MarkTracks::from_bytes(text.as_bytes()).unwrap(), &tracks);
    }
}

fn read(text: &str) -> MarkTracks {
    MarkTracks::from_bytes(text.as_bytes()).unwrap()
}

fn error(text: &str) -> String {
    let Error { help, .. } = MarkTracks::from_bytes(text.as_bytes()).unwrap_err();
    assert!(!help.is_empty());
    MarkTracks::from_bytes(text.as_bytes())
        .unwrap_err()
        .to_string()
}

#[test]
fn the_formats_are_as_documented() {
    let tracks = MarkTracks {
        size: [320, 240],
        times: vec![0.0, 1.0 / 30.0, 0.1],
        marks: vec![MarkTrack {
            name: "red".into(),
            color: [0xd0, 0x30, 0x20],
            points: vec![
                DVec2::new(1.0, 2.5),
                DVec2::new(-0.001, 2.0 / 3.0),
                DVec2::new(9.0, 8.126),
            ],
            is_lost: vec![true, true, false],
            is_ambiguous: vec![true, false, false],
        }]
        .into(),
    };
    let json: serde_json::Value = serde_json::from_str(&tracks.to_json()).unwrap();
    let expected = serde_json::json!({
        "format": "okoshi track", "version": 1, "size": [320, 240], "times": [0, 0.0333, 0.1],
        "marks": [{"name": "red", "colour": "#d03020", "lost": [[0, 1]], "ambiguous": [[0, 0]], "points": [[1, 2.5], [0, 0.67], [9, 8.13]]}],
    });
    assert_eq!(json, expected);
    let expected = "# 320x240 red=#d03020\nframe,time,red_x,red_y,red_lost,red_ambiguous\n\
                    0,0,1,2.5,1,1\n1,0.0333,0,0.67,1,0\n2,0.1,9,8.13,0,0\n";
    assert_eq!(tracks.to_csv(), expected);
}

#[test]
fn a_table_by_hand_needs_only_size_times_and_places() {
    let tracks = read(
        "\u{feff}\"# 64×48 by me\",,\nTime,green_x,green_y,what\n10,1,2,\n11,,,x\n12,3,6,\n,,,\n",
    );
    assert_eq!(
        (tracks.size, &tracks.times[..]),
        ([64, 48], &[0.0, 1.0, 2.0][..])
    );
    let [mark] = &tracks.marks.raw[..] else {
        panic!()
    };
    assert_eq!((mark.name.as_str(), mark.color), ("green", [0, 128, 0]));
    assert_eq!(mark.is_lost, [false, true, false]);
    assert_eq!(mark.points[1], DVec2::new(2.0, 4.0));
}

#[test]
fn a_mark_is_where_it_was_seen_next_to_the_lost_frames() {
    let tracks = read("# 64x48\ntime,a_x,a_y,b_x,b_y\n0,,,,\n1,5,6,,\n2,,,,\n");
    assert_eq!(tracks.marks.raw[0].points, [DVec2::new(5.0, 6.0); 3]);
    assert_eq!(tracks.marks.raw[1].points, [DVec2::new(32.0, 24.0); 3]);
    assert_eq!(tracks.marks.raw[1].is_lost, [true; 3]);
}

#[test]
fn mistakes_in_tables_have_a_place() {
    let table = |rows: &str| error(&format!("# 64x48\ntime,red_x,red_y,red_lost\n{rows}"));
    assert!(table("").starts_with("line 2, column 1: the file has no frames"));
    assert!(table("0,1,two,0").starts_with("line 3, column 5: `two` is no number"));
    assert!(table("0,1,nan,0").contains("no number"));
    assert!(table("0,1,1e9,0").contains("no place"));
    assert!(table("0,1,,0").starts_with("line 3, column 5: one coordinate"));
    assert!(table("0,1,2").contains("3 cells for 4 columns"));
    assert!(table("0,1,2,maybe").starts_with("line 3, column 7: this is neither"));
    assert!(table("0,1,2,0\n0,1,2,0").starts_with("line 4, column 1: the frame at 0 s"));
    assert!(table(",1,2,0").contains("time of the frame is missing"));
    assert!(error("").contains("no frames"));
    assert!(error("time,red_x,red_y\n0,1,2").contains("size"));
    assert!(error("# 0x240\ntime,red_x,red_y\n0,1,2").contains("0 × 240"));
    assert!(error("# 64x48\nframe,red_x,red_y\n0,1,2").contains("`time`"));
    assert!(error("# 64x48\ntime,red_x\n0,1").contains("no `red_y`"));
    assert!(error("# 64x48\ntime,_x,_y\n0,1,2").contains("cannot be the name"));
    assert!(error("# 64x48\ntime,a_x,a_y,a_x\n0,1,2,3").starts_with("line 2, column 14: there is"));
}

#[test]
fn mistakes_in_json_have_a_place() {
    let good = serde_json::json!({
        "format": "okoshi track", "version": 1, "size": [64, 48], "times": [0, 1],
        "marks": [{"name": "red", "colour": "#f00", "points": [[1, 2], null], "lost": []}],
    });
    assert_eq!(read(&good.to_string()).marks.raw[0].is_lost, [false, true]);
    let wrong = |pointer: &str, value: serde_json::Value| {
        let mut file = good.clone();
        *file.pointer_mut(pointer).unwrap() = value;
        error(&file.to_string())
    };
    assert!(wrong("/format", "glTF".into()).starts_with("`format`: this JSON is no track"));
    assert!(wrong("/version", 2.into()).starts_with("`version`: only version 1"));
    assert!(wrong("/size", serde_json::json!([0, 9])).starts_with("`size`"));
    assert!(wrong("/times", serde_json::json!([])).starts_with("`times`: a track has"));
    assert!(wrong("/times/1", 0.into()).starts_with("`times[1]`: the frame at 0 s"));
    assert!(wrong("/marks", serde_json::json!([])).starts_with("`marks`: a track has"));
    assert!(wrong("/marks/0/name", "a b".into()).starts_with("`marks[0].name`: `a b` cannot"));
    assert!(wrong("/marks/0/colour", "red".into()).starts_with("`marks[0].colour`"));
    assert!(
        wrong("/marks/0/points", serde_json::json!([[1, 2]])).contains("1 points for 2 frames")
    );
    assert!(wrong("/marks/0/points/0/1", 1e9.into()).starts_with("`marks[0].points[0][1]`"));
    assert!(wrong("/marks/0/points/0/1", "1".into()).starts_with("line 1, column "));
    assert!(wrong("/marks/0/lost", serde_json::json!([[1, 2]])).starts_with("`marks[0].lost[0]`"));
    assert!(wrong("/marks/0/lost", serde_json::json!([[1, 0]])).contains("no frames 1 to 0"));
    let twice = serde_json::json!([good["marks"][0], good["marks"][0]]);
    assert!(wrong("/marks", twice).starts_with("`marks[1].name`: there is a mark `red` already"));
    assert!(error("{").starts_with("line 1, column 1: EOF"));
    let binary = MarkTracks::from_bytes(b"GIF89a\xff\xff").unwrap_err();
    assert!(binary.to_string().contains("UTF-8"));
}

#[test]
fn names_are_one_word() {
    assert!(is_name("red") && is_name("左手") && is_name("left-hand_2"));
    assert!(!is_name("") && !is_name("a b") && !is_name("a,b") && !is_name(&"a".repeat(65)));
}

//! `okoshi man`: a page for the program and each of its commands, which formatters read without a warning.
#![cfg(feature = "cli")]
#![allow(clippy::print_stdout, reason = "a test says what it skips")]

mod common;

use std::process::Command;

use common::program::Room;

/// The commands that the help lists.
fn commands(room: &Room) -> Vec<String> {
    let help = room.run(&["--help"]).out;
    let list = help.split("\nCommands:\n").nth(1).expect("a list");
    let list = list.lines().take_while(|line| !line.is_empty());
    // Summaries that are continued stand farther in.
    let names = list.filter(|line| !line.starts_with("   "));
    let names = names.filter_map(|line| line.split_whitespace().next());
    names
        .filter(|name| *name != "help")
        .map(str::to_owned)
        .collect()
}

#[test]
fn the_program_and_every_command_have_a_page() {
    let room = Room::new();
    let commands = commands(&room);
    assert!(commands.len() > 12, "{commands:?}");
    let program = room.run(&["man"]).out;
    assert!(program.starts_with(".TH OKOSHI 1 "), "{program}");
    for command in &commands {
        assert!(
            program.contains(&format!("okoshi\\-{command}(1)")),
            "{command}"
        );
    }
    let pages = commands
        .iter()
        .map(|command| (format!("okoshi-{command}"), vec!["man", command]));
    let pages = std::iter::once(("okoshi".to_owned(), vec!["man"])).chain(pages);
    let mut formatters = 0;
    for (name, arguments) in pages {
        let run = room.run(&arguments);
        assert_eq!((run.status, run.err.as_str()), (0, ""), "{name}");
        let page = run.out;
        assert!(page.is_ascii(), "{name}");
        let title = format!(".TH {} 1", name.to_uppercase());
        assert!(page.contains(&title), "{name} has no `{title}`:\n{page}");
        for section in ["NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS"] {
            assert!(
                page.contains(&format!(".SH {section}\n")),
                "{name}: {section}"
            );
        }
        assert!(!page.contains(".SH EXTRA"), "{name}");
        let file = format!("{name}.1");
        room.write(&file, &page);
        for (formatter, options) in [
            ("groff", &["-ww", "-man", "-Tutf8", "-z"][..]),
            ("mandoc", &["-Tlint", "-Werror"]),
        ] {
            let mut format = Command::new(formatter);
            format.args(options).arg(&file).current_dir(room.path(""));
            let Ok(done) = format.output() else { continue };
            formatters += 1;
            let said = [done.stdout, done.stderr].concat();
            let said = String::from_utf8_lossy(&said);
            assert!(
                done.status.success() && said.is_empty(),
                "{formatter} {file}: {said}"
            );
        }
    }
    if formatters == 0 {
        println!("skipped: neither groff nor mandoc, which read manual pages, is installed");
    }
}

#[test]
fn examples_stand_line_by_line() {
    let page = Room::new().run(&["man"]).out;
    let examples = page.split(".SH EXAMPLES\n.nf\n").nth(1).expect("examples");
    let examples = examples.split(".fi\n").next().expect("an end");
    let count = examples
        .lines()
        .filter(|line| line.starts_with("\\&  okoshi "))
        .count();
    assert!(count > 8, "{examples}");
    // Characters beyond ASCII are written by their numbers.
    let explain = Room::new().run(&["man", "explain"]).out;
    assert!(explain.contains("roundv \\[u2026]"), "{explain}");
}

#[test]
fn a_page_of_nothing_is_refused() {
    Room::new().run(&["man", "bild"]).ends(
        2,
        "",
        "there is no command `bild`; `okoshi --help` lists all commands",
    );
}

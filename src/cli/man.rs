//! `okoshi man`: the manual pages, made from the table of the command line.

use std::fmt::Write as _;
use std::io;

use clap::CommandFactory as _;
use clap_mangen::Man;

use super::args::Cli;
use super::{Failure, Outcome, print_out};

/// Prints the manual page of the program or of one of its commands, for `man`.
pub(super) fn run(name: Option<&str>) -> Result<Outcome, Failure> {
    let mut program = Cli::command().disable_help_subcommand(true);
    // Hands options that all commands have down to them.
    program.build();
    let command = match name {
        None => program,
        Some(name) => {
            let found = program.find_subcommand(name).cloned();
            found.ok_or_else(|| {
                format!("there is no command `{name}`; `okoshi --help` lists all commands")
            })?
        }
    };
    let page = page(command).map_err(|error| format!("the page cannot be made: {error}"))?;
    Ok(print_out(&page))
}

/// The page of a command in the language of troff, in ASCII.
fn page(mut command: clap::Command) -> io::Result<String> {
    // A page's own section instead of one that is called `EXTRA`.
    let closing = command.get_after_help().map(ToString::to_string);
    command = command.after_help(None);
    let has_commands = command.has_subcommands();
    // As pages of commands are called: `okoshi-build`.
    let title = command.get_display_name().unwrap_or(command.get_name());
    // Without a date, so that the same program gives the same page; the library would leave out its place, too.
    let title = format!(
        ".TH {} 1 \"\" \"okoshi {}\" \"User Commands\"\n",
        title.to_uppercase(),
        env!("CARGO_PKG_VERSION")
    );
    let man = Man::new(command);
    let mut page = title.into_bytes();
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    man.render_description_section(&mut page)?;
    man.render_options_section(&mut page)?;
    if has_commands {
        man.render_subcommands_section(&mut page)?;
    }
    let mut page = String::from_utf8_lossy(&page).into_owned();
    page.push_str(&closing.map_or_else(String::new, |closing| examples(&closing)));
    Ok(ascii(&page))
}

/// The text below a command's options: the first paragraph has examples, a line each, and the others are prose.
fn examples(text: &str) -> String {
    let mut section = String::from(".SH EXAMPLES\n");
    for paragraph in text.trim().split("\n\n") {
        let list = paragraph.strip_prefix("Examples:\n");
        section.push_str(if list.is_some() { ".nf\n" } else { ".PP\n" });
        for line in list.unwrap_or(paragraph).lines() {
            // What begins with a dot or an apostrophe would be a request.
            let line = line.replace('\\', "\\e").replace('-', "\\-");
            let _ = writeln!(section, "\\&{line}");
        }
        section.push_str(if list.is_some() { ".fi\n" } else { "" });
    }
    section
}

/// Characters beyond ASCII by their numbers, which all formatters understand without being told an encoding.
fn ascii(page: &str) -> String {
    let mut text = String::with_capacity(page.len());
    for c in page.chars() {
        if c.is_ascii() {
            text.push(c);
        } else {
            let _ = write!(text, "\\[u{:04X}]", u32::from(c));
        }
    }
    text
}

//! `okoshi app`

use std::path::Path;

use super::args::{App, Common};
use super::{Failure, Outcome, serving};
use crate::disk::{FolderResolver, ReadError, is_drawing, names_below};
use crate::preview::{APP_PORT, Files, PORT, lacking, serve_app};

/// How a folder is made.
const MADE_BY: &str = "in a clone of okoshi's repository, `bash editors/web/app.sh okoshi-app` makes such a folder, and `okoshi app okoshi-app` serves it";

/// Serves okoshi in the browser until it is interrupted.
pub(super) fn run(arguments: &App, common: Common) -> Result<Outcome, Failure> {
    let files = match &arguments.folder {
        Some(folder) => in_folder(folder)?,
        None => Files::embedded()
            .ok_or_else(|| format!("okoshi in the browser is not in this program: {MADE_BY}"))?,
    };
    if arguments.port == Some(PORT) {
        return Err(format!(
            "port {PORT} is that of `okoshi preview`: the browser would show this page in the place of previews from then on; choose another"
        )
        .into());
    }
    let bound = serving::bound(arguments.port, APP_PORT)?;
    let url = bound.url();
    let port = bound.port();
    let runtime = serving::runtime()?;
    println!("{url}");
    if arguments.port.is_none() && port != APP_PORT {
        eprintln!(
            "port {APP_PORT} is taken, maybe by another `okoshi app`; browsers keep drawings by the address, and those of that port are not shown here"
        );
    }
    if !common.quiet {
        eprintln!("press Ctrl-C to stop");
    }
    if arguments.open {
        serving::open(&url);
    }
    match runtime.block_on(serve_app(bound, files)) {
        Ok(never) => match never {},
        Err(error) => Err(format!("the page cannot be served: {error}").into()),
    }
}

/// The files of a folder that is okoshi in the browser.
fn in_folder(folder: &Path) -> Result<Files, Failure> {
    let shown = folder.display();
    if !folder.exists() {
        return Err(ReadError::missing(folder).into());
    }
    if folder.is_file() && is_drawing(folder) {
        return Err(format!(
            "`{shown}` is a drawing: open it on the page of `okoshi app`, or show it with `okoshi preview {shown} --open`"
        )
        .into());
    }
    if !folder.is_dir() {
        return Err(format!("`{shown}` is a file, not a folder: {MADE_BY}").into());
    }
    if let Some(lacks) = lacking(&names_below(folder)) {
        return Err(format!(
            "`{shown}` is not okoshi in the browser, it has no `{lacks}`: {MADE_BY}"
        )
        .into());
    }
    Ok(Files::Folder(Box::new(FolderResolver::new(folder))))
}

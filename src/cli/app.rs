//! `okoshi app`

use std::path::Path;

use super::args::{App, Common};
use super::{Failure, Outcome};
use crate::disk::{FolderResolver, ReadError, below, is_drawing};
use crate::preview::{APP_PORT, Files, PORT, bind, lacking, serve_app};

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
    let bound = bind(arguments.port, APP_PORT).map_err(|error| {
        let port = arguments.port.unwrap_or_default();
        format!("port {port} is not available ({error}); choose another with --port, or leave --port out")
    })?;
    let url = bound.url();
    let port = bound.port();
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()
        .map_err(|error| format!("the page cannot be served: {error}"))?;
    println!("{url}");
    if arguments.port.is_none() && port != APP_PORT {
        eprintln!(
            "port {APP_PORT} is taken, maybe by another `okoshi app`; browsers keep drawings by the address, and those of that port are not shown here"
        );
    }
    if !common.quiet {
        eprintln!("press Ctrl-C to stop");
    }
    if arguments.open
        && let Err(error) = open::that_detached(&url)
    {
        eprintln!("the browser cannot be opened ({error}); open {url} by hand");
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
    let names = below(folder).files;
    let names = names.iter().filter_map(|file| {
        let path = file.strip_prefix(folder).ok()?;
        let names: Option<Vec<&str>> = path.iter().map(|name| name.to_str()).collect();
        Some(names?.join("/"))
    });
    let names: Vec<String> = names.collect();
    if let Some(lacks) = lacking(&names) {
        return Err(format!(
            "`{shown}` is not okoshi in the browser, it has no `{lacks}`: {MADE_BY}"
        )
        .into());
    }
    Ok(Files::Folder(Box::new(FolderResolver::new(folder))))
}

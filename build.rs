//! Embeds the preview page in the program. A package has it ready-made in `editors/web/dist`; in a clone, npm builds it from
//! its lock file, in cargo's folder for such results. If npm is missing or fails, the program gets a plain page that says so.
//!
//! And embeds okoshi in the browser for `okoshi app`, if there is one: the folder that OKOSHI_APP names, or `editors/web/dist/app`.

#[path = "src/preview/complete.rs"]
mod complete;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;
use std::{env, fs, io};

use flate2::Compression;
use flate2::read::GzEncoder;

const FILES: [&str; 3] = ["page.html", "page.js", "page.css"];
/// What the page is built from.
const SOURCES: [&str; 4] = ["src", "scripts", "package.json", "package-lock.json"];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if env::var_os("CARGO_FEATURE_PREVIEW").is_none() {
        return;
    }
    println!("cargo::rerun-if-env-changed=OKOSHI_NO_PAGE");
    let folder = Path::new("editors/web");
    // What is not there is not named: cargo would run this every time.
    for watched in SOURCES.map(|name| folder.join(name)) {
        if watched.exists() {
            println!("cargo::rerun-if-changed={}", watched.display());
        }
    }
    let Some(out) = env::var_os("OUT_DIR").map(PathBuf::from) else {
        panic!("cargo tells where to build");
    };
    embed_app(folder, &out);
    match built(folder, &out.join("web")) {
        Ok(files) => {
            for (name, bytes) in FILES.iter().zip(files) {
                write(&out.join(name), &bytes);
            }
        }
        Err(why) => {
            println!("cargo::warning=the preview will have no page: {why}");
            write(&out.join("page.html"), plain(&why).as_bytes());
            write(&out.join("page.js"), b"");
            write(&out.join("page.css"), b"");
        }
    }
}

/// Puts the files of okoshi in the browser into the program, packed; or none.
fn embed_app(folder: &Path, out: &Path) {
    println!("cargo::rerun-if-env-changed=OKOSHI_APP");
    // One that is not there is not named either.
    let ready = Some(folder.join("dist/app")).filter(|ready| ready.exists());
    let named = env::var_os("OKOSHI_APP").filter(|named| !named.is_empty());
    let Some(app) = named.map(PathBuf::from).or(ready) else {
        return write(&out.join("app.rs"), b"&[]");
    };
    println!("cargo::rerun-if-changed={}", app.display());
    let mut files = Vec::new();
    if let Err(error) = list(&app, "", &mut files) {
        panic!("{}: {error}", app.display());
    }
    files.sort();
    // Nobody is to notice this after a release.
    if let Some(lacks) = complete::lacking(&files) {
        panic!(
            "{} has no {lacks}: name a folder that editors/web/app.sh made, as an absolute path",
            app.display()
        );
    }
    let packed = out.join("app");
    let _ = fs::remove_dir_all(&packed);
    let mut table = String::from("&[\n");
    for (number, name) in files.iter().enumerate() {
        let pack = || {
            fs::create_dir_all(&packed)?;
            let file = fs::File::open(app.join(name))?;
            let mut out = fs::File::create(packed.join(number.to_string()))?;
            io::copy(&mut GzEncoder::new(file, Compression::best()), &mut out)
        };
        if let Err(error) = pack() {
            panic!("{name}: {error}");
        }
        let _ = writeln!(
            table,
            "    ({name:?}, include_bytes!(concat!(env!(\"OUT_DIR\"), \"/app/{number}\"))),"
        );
    }
    table.push(']');
    write(&out.join("app.rs"), table.as_bytes());
}

/// The paths of the files below a folder, with `/` between names.
fn list(folder: &Path, above: &str, files: &mut Vec<String>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{above}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            list(&entry.path(), &format!("{name}/"), files)?;
        } else {
            files.push(name);
        }
    }
    Ok(())
}

/// The files of the page, ready-made or built in `room`, or why there are none.
fn built(folder: &Path, room: &Path) -> Result<Vec<Vec<u8>>, String> {
    if env::var_os("OKOSHI_NO_PAGE").is_some() {
        return Err("OKOSHI_NO_PAGE is set".to_owned());
    }
    let dist = if is_current(folder) {
        folder.join("dist")
    } else if folder.join("package.json").exists() {
        bundle(folder, room)?;
        room.join("dist")
    } else {
        // Nobody is to notice this after a release.
        panic!("the package has no page: run `npm run build` in editors/web before packaging");
    };
    let read = |name: &&str| {
        let path = dist.join(name);
        fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))
    };
    FILES.iter().map(read).collect()
}

/// Whether the page is there and no older than its sources.
fn is_current(folder: &Path) -> bool {
    let time = |path: PathBuf| fs::metadata(path).and_then(|found| found.modified()).ok();
    let dist = FILES
        .iter()
        .map(|name| time(folder.join("dist").join(name)));
    let Some(oldest) = dist.min().flatten() else {
        return false;
    };
    !SOURCES
        .iter()
        .any(|name| newest(&folder.join(name)) > Some(oldest))
}

/// The modification time of a file, or of the newest file in a folder.
fn newest(path: &Path) -> Option<SystemTime> {
    let metadata = fs::metadata(path).ok()?;
    if !metadata.is_dir() {
        return metadata.modified().ok();
    }
    let entries = fs::read_dir(path).ok()?.flatten();
    entries.filter_map(|entry| newest(&entry.path())).max()
}

/// Builds the page from a copy of its sources, as npm writes beside them.
fn bundle(folder: &Path, room: &Path) -> Result<(), String> {
    let lock = |folder: &Path| fs::read(folder.join("package-lock.json")).ok();
    let is_installed = room.join("node_modules/.package-lock.json").exists();
    let is_installed = is_installed && lock(room) == lock(folder);
    for name in SOURCES {
        let copy = room.join(name);
        let _ = fs::remove_dir_all(&copy);
        copied(&folder.join(name), &copy)
            .map_err(|error| format!("{}: {error}", copy.display()))?;
    }
    if !is_installed {
        npm(room, &["ci", "--omit=dev", "--no-audit", "--no-fund"])?;
    }
    npm(room, &["run", "build"])
}

/// Copies a file, or a folder with all that is in it.
fn copied(from: &Path, to: &Path) -> io::Result<()> {
    if !from.is_dir() {
        return fs::copy(from, to).map(drop);
    }
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        copied(&entry.path(), &to.join(entry.file_name()))?;
    }
    Ok(())
}

fn npm(folder: &Path, arguments: &[&str]) -> Result<(), String> {
    let program = if cfg!(windows) { "npm.cmd" } else { "npm" };
    let said = Command::new(program)
        .args(arguments)
        .current_dir(folder)
        .output();
    let said = said.map_err(|error| format!("npm cannot be run ({error}); install Node.js"))?;
    if said.status.success() {
        return Ok(());
    }
    let errors = String::from_utf8_lossy(&said.stderr);
    let last = errors.lines().rfind(|line| !line.trim().is_empty());
    let last = last.unwrap_or("it failed");
    Err(format!("npm {} failed: {last}", arguments.join(" ")))
}

fn plain(why: &str) -> String {
    let escaped = why.replace('&', "&amp;").replace('<', "&lt;");
    format!(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>okoshi</title>\n\
         <h1>The preview's page is not in this program</h1>\n\
         <p>When okoshi was built, the page could not be: {escaped}.</p>\n\
         <p>Install Node.js, build okoshi again, and the page will be here. \
         Until then <code>okoshi watch</code> builds models, and <code>okoshi render</code> draws pictures.</p>\n</html>\n"
    )
}

fn write(path: &Path, bytes: &[u8]) {
    if let Err(error) = fs::write(path, bytes) {
        panic!("{}: {error}", path.display());
    }
}

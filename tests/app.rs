//! `okoshi app` as a server: what it serves of a folder, what it refuses, and what it says without one.
#![cfg(feature = "cli")]

mod common;

use common::live::Live;
use common::pages::{answered, asked, got, port_of};
use common::program::Room;

const PAGE: &str = "<!doctype html><title>okoshi</title>";
const MODULE: &[u8] = b"\0asm\x01\0\0\0";
const WHOLE: [&str; 6] = [
    "service-worker.js",
    "v-0123456789ab/app.css",
    "v-0123456789ab/app.js",
    "v-0123456789ab/okoshi_web.js",
    "v-0123456789ab/worker.js",
    "LICENSE-MIT",
];

/// A folder `made` with the files that okoshi in the browser has at least, and a secret beside it.
fn room() -> Room {
    let room = Room::with("secret", "secret");
    room.write("made/index.html", PAGE);
    room.write("made/v-0123456789ab/okoshi_web_bg.wasm", MODULE);
    for name in WHOLE {
        room.write(&format!("made/{name}"), format!("// {name}"));
    }
    room
}

fn served(room: &Room) -> (Live, u16) {
    let live = Live::start(&room.path(""), &["app", "made", "--port", "0"]);
    let port = port_of(&live);
    (live, port)
}

/// What a browser sends.
fn request(path: &str) -> String {
    format!(
        "GET {path} HTTP/1.1\nHost: 127.0.0.1:PORT\nAccept-Encoding: gzip, br\nConnection: close\n\n"
    )
}

#[test]
fn a_folder_is_served_with_types_and_caching() {
    let room = room();
    let (_live, port) = served(&room);
    let kept = "cache-control: public, max-age=31536000, immutable";
    let asked_again = "cache-control: no-cache";
    for (path, kind, caching, body) in [
        (
            "/",
            "text/html; charset=utf-8",
            asked_again,
            PAGE.as_bytes(),
        ),
        (
            "/index.html",
            "text/html; charset=utf-8",
            asked_again,
            PAGE.as_bytes(),
        ),
        (
            "/service-worker.js?v=1",
            "text/javascript; charset=utf-8",
            asked_again,
            b"// service-worker.js",
        ),
        (
            "/v-0123456789ab/okoshi_web_bg.wasm",
            "application/wasm",
            kept,
            MODULE,
        ),
        (
            "/v-0123456789ab/app.css",
            "text/css; charset=utf-8",
            kept,
            b"// v-0123456789ab/app.css",
        ),
        (
            "/LICENSE-MIT",
            "text/plain; charset=utf-8",
            asked_again,
            b"// LICENSE-MIT",
        ),
    ] {
        let (status, head, found) = answered(port, &request(path));
        assert_eq!((status, found.as_slice()), (200, body), "{path}");
        for line in [
            &format!("content-type: {kind}"),
            caching,
            "x-content-type-options: nosniff",
            "x-frame-options: DENY",
        ] {
            assert!(
                head.lines().any(|own| own == line),
                "{path}: {line}:\n{head}"
            );
        }
        // The pages have policies of their own.
        assert!(!head.contains("content-security-policy"), "{path}:\n{head}");
    }
    let head = request("/").replace("GET", "HEAD");
    let (status, _, body) = answered(port, &head);
    assert_eq!((status, body.len()), (200, 0));
    // A newer version in the folder is served without another start.
    room.write("made/index.html", "newer");
    assert_eq!(got(port, "/"), (200, b"newer".to_vec()));
}

#[test]
fn nothing_else_is_served_and_nobody_else_is() {
    let room = room();
    #[cfg(unix)]
    {
        use std::os::unix::fs::symlink;
        symlink("../secret", room.path("made/file.js")).expect("a link");
        symlink("..", room.path("made/up")).expect("a link");
        symlink("index.html", room.path("made/alias.html")).expect("a link");
    }
    let (_live, port) = served(&room);
    for path in [
        "/none.html",
        "/v-0123456789ab",
        "/v-0123456789ab/",
        "/../secret",
        "/%2e%2e/secret",
        "/v-0123456789ab/..%2f..%2fsecret",
        "/v-0123456789ab/%2e%2e/%2e%2e/secret",
        "/..%5csecret",
        "/%252e%252e/secret",
        "//etc/passwd",
        "/%2fetc%2fpasswd",
        "/file.js",
        "/up/secret",
        "/%ff",
        "/index.html%00",
    ] {
        let (status, body) = asked(port, &request(path));
        assert!([400, 404].contains(&status), "{path}: {status}");
        let body = String::from_utf8_lossy(&body).into_owned();
        assert!(
            !body.contains("secret") && !body.contains("root:"),
            "{path}: {body}"
        );
    }
    #[cfg(unix)]
    assert_eq!(
        got(port, "/alias.html").0,
        200,
        "a link inside of the folder"
    );

    for headers in [
        "Host: evil.example",
        "Host: 127.0.0.1",
        "Host: 127.0.0.1:PORT\nOrigin: http://evil.example",
        "Host: 127.0.0.1:PORT\nSec-Fetch-Site: cross-site",
    ] {
        let request = format!("GET / HTTP/1.1\n{headers}\nConnection: close\n\n");
        let (status, body) = asked(port, &request);
        assert_eq!(status, 403, "{headers}");
        assert!(!String::from_utf8_lossy(&body).contains(PAGE), "{headers}");
    }
    for method in ["POST", "PUT", "DELETE", "OPTIONS"] {
        for path in ["/", "/changes", "/index.html"] {
            let request = format!(
                "{method} {path} HTTP/1.1\nHost: 127.0.0.1:PORT\nOrigin: http://127.0.0.1:PORT\nContent-Length: 0\nConnection: close\n\n"
            );
            assert_eq!(asked(port, &request).0, 405, "{method} {path}");
        }
    }
}

#[test]
fn a_folder_that_is_something_else_is_said_to_be() {
    let room = room();
    let refused = |arguments: &[&str]| {
        let run = room.run(arguments);
        assert_eq!((run.status, run.out.as_str()), (2, ""), "{arguments:?}");
        run.err
    };
    let way = "in a clone of okoshi's repository, `bash editors/web/app.sh okoshi-app` makes such a folder, and `okoshi app okoshi-app` serves it\n";
    assert_eq!(
        refused(&["app", "secret"]),
        format!("error: `secret` is a file, not a folder: {way}")
    );
    room.write("me.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"/>");
    assert_eq!(
        refused(&["app", "me.svg"]),
        "error: `me.svg` is a drawing: open it on the page of `okoshi app`, or show it with `okoshi preview me.svg --open`\n"
    );
    assert!(refused(&["app", "maed"]).starts_with("error: `maed` is not there"));
    for lacks in [
        "index.html",
        "service-worker.js",
        "v-0123456789ab/okoshi_web_bg.wasm",
    ] {
        let path = room.path(&format!("made/{lacks}"));
        let bytes = std::fs::read(&path).expect("read");
        std::fs::remove_file(&path).expect("removed");
        assert_eq!(
            refused(&["app", "made"]),
            format!("error: `made` is not okoshi in the browser, it has no `{lacks}`: {way}")
        );
        std::fs::write(path, bytes).expect("written");
    }
    std::fs::rename(room.path("made/v-0123456789ab"), room.path("made/other")).expect("renamed");
    assert_eq!(
        refused(&["app", "made"]),
        format!("error: `made` is not okoshi in the browser, it has no `v-…/app.css`: {way}")
    );
}

#[test]
fn ports_are_the_apps_own() {
    let room = room();
    let listener = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("its address");
    let taken = address.port().to_string();
    let live = Live::start(&room.path(""), &["app", "made", "--port", &taken]);
    live.line(&format!("error: port {taken} is not available"));
    // Whoever has it: the usual port is taken now.
    let _usual = std::net::TcpListener::bind("127.0.0.1:4174");
    let live = Live::start(&room.path(""), &["app", "made"]);
    let [address, _] = live.lines(["http://127.0.0.1:", "port 4174 is taken"]);
    assert!(!address.ends_with(":4174/"), "{address}");
    let run = room.run(&["app", "made", "--port", "4173"]);
    assert_eq!(run.status, 2);
    assert!(
        run.err
            .starts_with("error: port 4173 is that of `okoshi preview`"),
        "{}",
        run.err
    );
}

/// A program may be built with or without it.
#[test]
fn without_a_folder_the_one_in_the_program_is_served_or_the_way_to_one_is_said() {
    let room = Room::new();
    let live = Live::start(&room.path(""), &["app", "--port", "0"]);
    let line = live.line("");
    if line.starts_with("error: ") {
        assert!(
            line.starts_with("error: okoshi in the browser is not in this program: in a clone of okoshi's repository, `bash editors/web/app.sh okoshi-app` makes such a folder"),
            "{line}"
        );
        return;
    }
    // One stream may be heard before the other.
    let address = if line.starts_with("http") {
        line
    } else {
        live.line("http://")
    };
    let port = address.trim_end_matches('/').rsplit(':').next();
    let port = port.and_then(|port| port.parse().ok()).expect("a port");
    let (status, head, _) = answered(port, &request("/"));
    assert_eq!(status, 200);
    assert!(head.contains("content-encoding: gzip"), "{head}");
    let page = String::from_utf8(got(port, "/").1).expect("a page");
    let script = page
        .split("src=\"")
        .nth(1)
        .and_then(|rest| rest.split('"').next());
    let script = script.expect("a script");
    assert_eq!(got(port, &format!("/{script}")).0, 200, "{script}");
}

//! okoshi in the browser: the files of a folder that `editors/web/app.sh` made, from the program itself or from a disk.
//!
//! The pages bring their own content security policy, as they do on any other web server.

use std::convert::Infallible;
use std::io::{self, Read as _};
use std::sync::Arc;

use axum::Router;
use axum::body::Bytes;
use axum::extract::{Path, State};
use axum::http::header::{self, HeaderName};
use axum::http::{HeaderMap, StatusCode};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use flate2::read::GzDecoder;

use super::access::{Access, Hosts, control};
use super::complete::is_versioned;
use super::loopback::{self, Bound};
use crate::resolver::{Resolver, inside};

/// The port that is tried first: browsers keep drawings for an address, port included. It is not the live page's, because the service
/// worker would answer in the place of that page.
pub(crate) const PORT: u16 = 4174;

/// The files that were put into the program when it was built: their paths, and their bytes as gzip.
static EMBEDDED: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/app.rs"));

/// Media types by the endings of names; browsers compile modules while they arrive only if they have theirs.
const TYPES: [(&str, &str); 8] = [
    (".css", "text/css; charset=utf-8"),
    (".glb", "model/gltf-binary"),
    (".html", "text/html; charset=utf-8"),
    (".js", "text/javascript; charset=utf-8"),
    (".png", "image/png"),
    (".svg", "image/svg+xml"),
    (".txt", "text/plain; charset=utf-8"),
    (".wasm", "application/wasm"),
];

/// The rules of the pages: they send nothing, and each asks for a new version of itself.
const ACCESS: Access = Access {
    posted: &[],
    policy: None,
    caching: "no-cache",
};
/// How browsers keep files that never change.
const KEPT: &str = "public, max-age=31536000, immutable";

/// Where the files are.
pub(crate) enum Files {
    /// In the program: paths, and bytes as gzip.
    Packed(&'static [(&'static str, &'static [u8])]),
    /// In a folder, by links from there.
    Folder(Box<dyn Resolver + Send>),
}

impl Files {
    /// Those in the program; `None` if it was built without them.
    pub(crate) fn embedded() -> Option<Self> {
        (!EMBEDDED.is_empty()).then_some(Self::Packed(EMBEDDED))
    }

    /// The file at a path, and whether its bytes are gzip; `None` if there is none.
    fn file(&self, path: &str) -> Option<(Bytes, bool)> {
        match self {
            Self::Packed(files) => {
                let (_, bytes) = files.iter().find(|(own, _)| *own == path)?;
                Some((Bytes::from_static(bytes), true))
            }
            Self::Folder(folder) => {
                let bytes = folder.read(path).ok()?;
                Some((Bytes::from_owner(bytes), false))
            }
        }
    }
}

/// Serves okoshi in the browser until the program ends.
///
/// # Errors
/// If the system cannot listen.
pub(crate) async fn serve(bound: Bound, files: Files) -> io::Result<Infallible> {
    loopback::serve(bound, |hosts| router(files, hosts)).await
}

fn router(files: Files, hosts: Hosts) -> Router {
    let first = |State(files): State<Arc<Files>>, headers: HeaderMap| async move {
        answer(files, String::new(), headers).await
    };
    let any = |State(files): State<Arc<Files>>, Path(path): Path<String>, headers: HeaderMap| async move {
        answer(files, path, headers).await
    };
    Router::new()
        .route("/", get(first))
        .route("/{*path}", get(any))
        .with_state(Arc::new(files))
        .layer(from_fn_with_state((hosts, ACCESS), control))
}

async fn answer(files: Arc<Files>, path: String, headers: HeaderMap) -> Response {
    let takes_gzip = takes_gzip(&headers);
    // Large files are read and unpacked where nobody waits.
    let found = tokio::task::spawn_blocking(move || found(&files, &path, takes_gzip));
    found
        .await
        .unwrap_or(None)
        .unwrap_or_else(|| (StatusCode::NOT_FOUND, "not found\n").into_response())
}

/// The answer with the file at a path, percent-decoded; `None` if there is none in the folder.
fn found(files: &Files, path: &str, takes_gzip: bool) -> Option<Response> {
    let path = match path {
        "" => "index.html".to_owned(),
        folder if folder.ends_with('/') => format!("{folder}index.html"),
        file => file.to_owned(),
    };
    let path = inside(&path).ok()?;
    let (mut bytes, is_packed) = files.file(&path)?;
    if is_packed && !takes_gzip {
        let mut unpacked = Vec::new();
        GzDecoder::new(&*bytes).read_to_end(&mut unpacked).ok()?;
        bytes = unpacked.into();
    }
    let known = TYPES.iter().find(|(ending, _)| path.ends_with(ending));
    // Licences have no ending.
    let media_type = known.map_or("text/plain; charset=utf-8", |(_, media_type)| media_type);
    let mut headers: Vec<(HeaderName, &str)> = vec![(header::CONTENT_TYPE, media_type)];
    if is_packed {
        headers.push((header::VARY, "accept-encoding"));
    }
    if is_packed && takes_gzip {
        headers.push((header::CONTENT_ENCODING, "gzip"));
    }
    if is_versioned(&path) {
        headers.push((header::CACHE_CONTROL, KEPT));
    }
    let headers: HeaderMap = headers
        .into_iter()
        .filter_map(|(name, value)| Some((name, value.parse().ok()?)))
        .collect();
    Some((headers, bytes).into_response())
}

/// Whether whoever asks reads gzip.
fn takes_gzip(headers: &HeaderMap) -> bool {
    let all = headers.get_all(header::ACCEPT_ENCODING).into_iter();
    let all = all.filter_map(|value| value.to_str().ok());
    all.flat_map(|value| value.split(',')).any(|one| {
        let (name, weight) = one.split_once(';').unwrap_or((one, ""));
        let weight = weight.trim().strip_prefix("q=");
        let is_refused = weight.is_some_and(|weight| weight.trim().parse() == Ok(0.0));
        name.trim().eq_ignore_ascii_case("gzip") && !is_refused
    })
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use axum::body::to_bytes;
    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;

    const TEXT: &str = "<!doctype html><title>okoshi</title>";

    /// Files as `build.rs` makes them.
    fn packed() -> Files {
        let pack = |bytes: &[u8]| {
            let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
            encoder.write_all(bytes).unwrap();
            &*encoder.finish().unwrap().leak()
        };
        let files = vec![
            ("index.html", pack(TEXT.as_bytes())),
            ("v-1/okoshi_web_bg.wasm", pack(b"\0asm")),
        ];
        Files::Packed(files.leak())
    }

    async fn body(answer: Response) -> Vec<u8> {
        to_bytes(answer.into_body(), 1 << 20).await.unwrap().into()
    }

    #[tokio::test]
    async fn packed_files_are_unpacked_only_for_who_cannot() {
        let files = packed();
        let answer = found(&files, "", true).unwrap();
        assert_eq!(answer.headers()[header::CONTENT_ENCODING], "gzip");
        assert_eq!(answer.headers()[header::VARY], "accept-encoding");
        let packed = body(answer).await;
        let mut text = String::new();
        GzDecoder::new(&*packed).read_to_string(&mut text).unwrap();
        assert_eq!(text, TEXT);
        let answer = found(&files, "index.html", false).unwrap();
        assert!(!answer.headers().contains_key(header::CONTENT_ENCODING));
        assert_eq!(answer.headers()[header::VARY], "accept-encoding");
        assert_eq!(body(answer).await, TEXT.as_bytes());
    }

    #[tokio::test]
    async fn files_of_a_version_are_kept() {
        let files = packed();
        let module = found(&files, "v-1/okoshi_web_bg.wasm", true).unwrap();
        assert_eq!(module.headers()[header::CONTENT_TYPE], "application/wasm");
        assert_eq!(module.headers()[header::CACHE_CONTROL], KEPT);
        // By another way to it, too; but what only begins like a version does change.
        let again = found(&files, "v-1/../index.html", true).unwrap();
        assert!(!again.headers().contains_key(header::CACHE_CONTROL));
        for none in [
            "v-1",
            "v-1/",
            "v-2/okoshi_web_bg.wasm",
            "../index.html",
            "/index.html",
        ] {
            assert!(found(&files, none, true).is_none(), "{none}");
        }
    }

    #[test]
    fn encodings_are_read() {
        let takes = |value: &str| {
            let mut headers = HeaderMap::new();
            headers.insert(header::ACCEPT_ENCODING, value.parse().unwrap());
            takes_gzip(&headers)
        };
        for taken in ["gzip", "br, GZIP", "deflate,gzip;q=0.5", "gzip ; q=1.0"] {
            assert!(takes(taken), "{taken}");
        }
        for refused in ["", "br", "gzip;q=0", "gzip; q=0.000, br", "x-gzip2"] {
            assert!(!takes(refused), "{refused}");
        }
        assert!(!takes_gzip(&HeaderMap::new()));
    }
}

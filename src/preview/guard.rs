//! Who is let in: this machine's own page, and nobody else.
//!
//! Any page in the same browser can send requests to loopback, and a foreign name can be made to point there; the
//! `Host` that a request names, and the `Origin` that browsers put into it, tell them apart.

use std::net::SocketAddr;
use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::header::{self, HeaderName, HeaderValue};
use axum::http::{HeaderMap, Method, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

/// The names under which the page is served.
#[derive(Debug, Clone)]
pub(super) struct Names(Arc<[String]>);

impl Names {
    pub(super) fn of(address: SocketAddr) -> Self {
        let port = address.port();
        let names = ["127.0.0.1", "localhost", "[::1]"].map(|name| match port {
            // Browsers leave the usual port out.
            80 => name.to_owned(),
            port => format!("{name}:{port}"),
        });
        Self(names.into())
    }

    fn are(&self, name: &str) -> bool {
        self.0.iter().any(|own| own.eq_ignore_ascii_case(name))
    }
}

/// What every answer carries: no other page may hold it in a frame, take it for something else, or pass on where it
/// came from.
const HEADERS: [(HeaderName, &str); 6] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; \
         connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::X_FRAME_OPTIONS, "DENY"),
    (header::REFERRER_POLICY, "no-referrer"),
    (
        HeaderName::from_static("cross-origin-resource-policy"),
        "same-origin",
    ),
    (header::CACHE_CONTROL, "no-store"),
];

/// Refuses requests that are not the page's own.
pub(super) async fn guard(State(names): State<Names>, request: Request, next: Next) -> Response {
    let refusal = refusal(&names, request.method(), request.headers());
    let mut response = match refusal {
        Some(refusal) => refusal.into_response(),
        None => next.run(request).await,
    };
    for (name, value) in HEADERS {
        response
            .headers_mut()
            .insert(name, HeaderValue::from_static(value));
    }
    response
}

/// Why a request is refused.
fn refusal(
    names: &Names,
    method: &Method,
    headers: &HeaderMap,
) -> Option<(StatusCode, &'static str)> {
    let text = |name: HeaderName| {
        let mut all = headers.get_all(name).iter();
        match (all.next(), all.next()) {
            (None, _) => Ok(None),
            (Some(one), None) => one.to_str().map(Some).map_err(|_| ()),
            (Some(_), Some(_)) => Err(()),
        }
    };
    let own_host = matches!(text(header::HOST), Ok(Some(host)) if names.are(host));
    if !own_host {
        return Some((
            StatusCode::FORBIDDEN,
            "this page is served under its own address only\n",
        ));
    }
    let own_origin = match text(header::ORIGIN) {
        // Programs on this machine send none; browsers do wherever it matters.
        Ok(None) => true,
        Ok(Some(origin)) => origin
            .strip_prefix("http://")
            .is_some_and(|name| names.are(name)),
        Err(()) => false,
    };
    let site = text(HeaderName::from_static("sec-fetch-site"));
    let own_site = !matches!(site, Ok(Some("cross-site" | "same-site")) | Err(()));
    if !own_origin || !own_site {
        return Some((
            StatusCode::FORBIDDEN,
            "other pages may not look at this one\n",
        ));
    }
    if !matches!(*method, Method::GET | Method::HEAD) {
        return Some((StatusCode::METHOD_NOT_ALLOWED, "this page only shows\n"));
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(headers: &[(&'static str, &str)]) -> bool {
        let names = Names::of(([127, 0, 0, 1], 4173).into());
        let mut map = HeaderMap::new();
        for (name, value) in headers {
            map.append(*name, value.parse().unwrap());
        }
        refusal(&names, &Method::GET, &map).is_some()
    }

    #[test]
    fn only_the_own_page_is_let_in() {
        let host = ("host", "127.0.0.1:4173");
        for sound in [
            &[host][..],
            &[("host", "LocalHost:4173")],
            &[("host", "[::1]:4173")],
            &[host, ("origin", "http://127.0.0.1:4173")],
            &[host, ("sec-fetch-site", "same-origin")],
            &[host, ("sec-fetch-site", "none")],
        ] {
            assert!(!refused(sound), "{sound:?}");
        }
        for foreign in [
            &[][..],
            &[("host", "evil.example")],
            &[("host", "127.0.0.1")],
            &[("host", "127.0.0.1:80")],
            &[("host", "127.0.0.1:4173.evil.example")],
            &[host, ("host", "evil.example")],
            &[host, ("origin", "null")],
            &[host, ("origin", "http://evil.example")],
            &[host, ("origin", "https://127.0.0.1:4173")],
            &[host, ("origin", "http://127.0.0.1:4174")],
            &[host, ("sec-fetch-site", "cross-site")],
        ] {
            assert!(refused(foreign), "{foreign:?}");
        }
    }
}

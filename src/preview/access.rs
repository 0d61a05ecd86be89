//! Access control: only the page itself, on this machine, may send requests.
//!
//! Any page in the same browser can send requests to loopback, and a foreign name can resolve to it (DNS rebinding). The
//! `Host` and `Origin` headers of a request tell them apart.

use std::net::SocketAddr;
use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::header::{self, HeaderName, HeaderValue};
use axum::http::{HeaderMap, Method, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

/// The hosts under which the page is served.
#[derive(Debug, Clone)]
pub(super) struct Hosts(Arc<[String]>);

impl Hosts {
    pub(super) fn of(address: SocketAddr) -> Self {
        let port = address.port();
        let names = ["127.0.0.1", "localhost", "[::1]"].map(|name| match port {
            // Browsers omit the default port.
            80 => name.to_owned(),
            port => format!("{name}:{port}"),
        });
        Self(names.into())
    }

    fn contains(&self, name: &str) -> bool {
        self.0.iter().any(|own| own.eq_ignore_ascii_case(name))
    }
}

/// What a server's own page may do.
#[derive(Debug, Clone, Copy)]
pub(super) struct Access {
    /// The addresses to which the page may send something other than a question.
    pub(super) posted: &'static [&'static str],
    /// The content security policy of every response; without one, pages have their own.
    pub(super) policy: Option<&'static str>,
    /// How browsers may keep responses that do not say so themselves.
    pub(super) caching: &'static str,
}

/// The headers of every response: no other page may embed it, guess another content type, or send it as a referrer.
const HEADERS: [(HeaderName, &str); 4] = [
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::X_FRAME_OPTIONS, "DENY"),
    (header::REFERRER_POLICY, "no-referrer"),
    (
        HeaderName::from_static("cross-origin-resource-policy"),
        "same-origin",
    ),
];

/// Refuses requests that do not come from the page itself.
pub(super) async fn control(
    State((hosts, access)): State<(Hosts, Access)>,
    request: Request,
    next: Next,
) -> Response {
    let (method, path) = (request.method(), request.uri().path());
    let refusal = refusal(&hosts, access.posted, method, path, request.headers());
    let mut response = match refusal {
        Some(refusal) => refusal.into_response(),
        None => next.run(request).await,
    };
    let headers = response.headers_mut();
    for (name, value) in HEADERS {
        headers.insert(name, HeaderValue::from_static(value));
    }
    if let Some(policy) = access.policy {
        headers.insert(
            header::CONTENT_SECURITY_POLICY,
            HeaderValue::from_static(policy),
        );
    }
    headers
        .entry(header::CACHE_CONTROL)
        .or_insert(HeaderValue::from_static(access.caching));
    response
}

/// The response to a request that is refused.
fn refusal(
    hosts: &Hosts,
    posted: &[&str],
    method: &Method,
    path: &str,
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
    let own_host = matches!(text(header::HOST), Ok(Some(host)) if hosts.contains(host));
    if !own_host {
        return Some((
            StatusCode::FORBIDDEN,
            "this page is served under its own address only\n",
        ));
    }
    let own_origin = match text(header::ORIGIN) {
        // Only browsers send it.
        Ok(None) => true,
        Ok(Some(origin)) => origin
            .strip_prefix("http://")
            .is_some_and(|name| hosts.contains(name)),
        Err(()) => false,
    };
    let site = text(HeaderName::from_static("sec-fetch-site"));
    let own_site = !matches!(site, Ok(Some("cross-site" | "same-site")) | Err(()));
    if !own_origin || !own_site {
        return Some((StatusCode::FORBIDDEN, "other pages may not read this one\n"));
    }
    // Browsers name the origin of whatever is not only read.
    let is_posted = *method == Method::POST && posted.contains(&path);
    if is_posted && !headers.contains_key(header::ORIGIN) {
        return Some((
            StatusCode::FORBIDDEN,
            "only the page in a browser may change drawings\n",
        ));
    }
    if !is_posted && !matches!(*method, Method::GET | Method::HEAD) {
        return Some((StatusCode::METHOD_NOT_ALLOWED, "this page is read-only\n"));
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(headers: &[(&'static str, &str)]) -> bool {
        answer(&Method::GET, "/", headers).is_some()
    }

    fn answer(method: &Method, path: &str, headers: &[(&'static str, &str)]) -> Option<u16> {
        let hosts = Hosts::of(([127, 0, 0, 1], 4173).into());
        let mut map = HeaderMap::new();
        for (name, value) in headers {
            map.append(*name, value.parse().unwrap());
        }
        let refusal = refusal(&hosts, &["/changes", "/forms"], method, path, &map);
        refusal.map(|(status, _)| status.as_u16())
    }

    #[test]
    fn only_the_page_itself_sends_changes() {
        let host = ("host", "127.0.0.1:4173");
        let own = ("origin", "http://127.0.0.1:4173");
        let post = |path, headers: &[_]| answer(&Method::POST, path, headers);
        for path in ["/changes", "/forms"] {
            assert_eq!(post(path, &[host, own]), None);
            assert_eq!(post(path, &[host]), Some(403), "no origin");
            assert_eq!(post(path, &[host, ("origin", "null")]), Some(403));
            assert_eq!(
                post(path, &[host, ("origin", "http://evil.example")]),
                Some(403)
            );
            assert_eq!(
                post(path, &[host, own, ("sec-fetch-site", "cross-site")]),
                Some(403)
            );
            assert_eq!(post(path, &[("host", "evil.example"), own]), Some(403));
            assert_eq!(answer(&Method::PUT, path, &[host, own]), Some(405));
        }
        assert_eq!(post("/live", &[host, own]), Some(405));
        assert_eq!(post("/changes/", &[host, own]), Some(405));
    }

    #[test]
    fn only_the_page_itself_is_served() {
        let host = ("host", "127.0.0.1:4173");
        for own in [
            &[host][..],
            &[("host", "LocalHost:4173")],
            &[("host", "[::1]:4173")],
            &[host, ("origin", "http://127.0.0.1:4173")],
            &[host, ("sec-fetch-site", "same-origin")],
            &[host, ("sec-fetch-site", "none")],
        ] {
            assert!(!refused(own), "{own:?}");
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

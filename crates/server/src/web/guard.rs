//! Who may ask: checks that stand before every route.
//!
//! A page of another site can make a browser send requests to this machine, and a name of its own can be made to
//! point here (DNS rebinding). So the `Host` a request names and the `Origin` of the page that sends it must be this
//! server's own; beyond loopback a token is needed as well. Nothing is ever shared with other origins.

use std::collections::HashMap;
use std::error::Error;
use std::net::{IpAddr, SocketAddr};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use axum::body::{Body, HttpBody, to_bytes};
use axum::extract::{ConnectInfo, Request, State};
use axum::http::header::{AUTHORIZATION, CACHE_CONTROL, CONTENT_SECURITY_POLICY, COOKIE, HOST, LOCATION, ORIGIN};
use axum::http::header::{REFERRER_POLICY, SET_COOKIE, X_CONTENT_TYPE_OPTIONS, X_FRAME_OPTIONS};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, Uri};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use http_body_util::LengthLimitError;

use super::BODY;
use super::problem::Problem;

/// Name of the cookie that holds the token.
const COOKIE_NAME: &str = "rungs-token";

/// Requests of one address in [`WINDOW`]; a page needs a few dozen while somebody scrolls.
const REQUESTS: u32 = 2000;
const WINDOW: Duration = Duration::from_secs(10);

/// Addresses that are counted at once.
const ADDRESSES: usize = 10_000;

/// Everything a page of ours needs, and nothing from elsewhere.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; \
                      connect-src 'self'; font-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// What may ask, and how often.
#[derive(Debug)]
pub(super) struct Guard {
    /// `Host` values that mean this server.
    hosts: Vec<String>,
    token: Option<String>,
    /// How long a body may take.
    body: Duration,
    counts: Mutex<HashMap<IpAddr, (Instant, u32)>>,
}

impl Guard {
    /// Guards a server bound to an address; a token must be given by all who ask.
    pub(super) fn new(bound: SocketAddr, token: Option<String>, body: Duration) -> Guard {
        let port = bound.port();
        let mut hosts = Vec::new();
        if bound.ip().is_loopback() || bound.ip().is_unspecified() {
            hosts.extend([format!("localhost:{port}"), format!("127.0.0.1:{port}"), format!("[::1]:{port}")]);
        }
        hosts.push(bound.to_string());
        if port == 80 {
            // Browsers leave the usual port out.
            let short: Vec<String> = hosts.iter().filter_map(|it| Some(it.strip_suffix(":80")?.to_owned())).collect();
            hosts.extend(short);
        }
        Guard { hosts, token, body, counts: Mutex::default() }
    }

    /// A server on all addresses is asked for by names this program cannot know; the token is what counts then.
    fn any_host(&self) -> bool {
        self.token.is_some()
    }

    fn check(&self, request: &Request) -> Result<(), Problem> {
        let headers = request.headers();
        let host =
            single(headers, &HOST).ok_or_else(|| Problem::forbidden("expected one Host, found none or several"))?;
        if !self.any_host() && !self.hosts.iter().any(|own| own.eq_ignore_ascii_case(host)) {
            return Err(Problem::forbidden(format!("expected Host to be one of {}", self.hosts.join(", "))));
        }
        // Whoever names a server in the first line too must name the same one.
        if request.uri().authority().is_some_and(|named| !named.as_str().eq_ignore_ascii_case(host)) {
            return Err(Problem::forbidden("expected the address asked for to name the same server as Host"));
        }
        // Browsers say where a request comes from. Pages of others may link to this one and nothing else.
        let fetch = |name: &str| headers.get(name).map(|value| value.as_bytes());
        let linked = fetch("sec-fetch-mode") == Some(b"navigate") && fetch("sec-fetch-dest") == Some(b"document");
        if fetch("sec-fetch-site").is_some_and(|site| site != b"same-origin" && site != b"none") && !linked {
            return Err(Problem::forbidden("pages of other origins may not use this server"));
        }
        if headers.contains_key(ORIGIN) {
            let origin = single(headers, &ORIGIN).and_then(|origin| origin.strip_prefix("http://"));
            if origin.is_none_or(|origin| !origin.eq_ignore_ascii_case(host)) {
                return Err(Problem::forbidden("pages of other origins may not use this server"));
            }
        }
        if self.token.as_ref().is_some_and(|token| !given(headers, token)) {
            return Err(Problem::new(StatusCode::UNAUTHORIZED, "expected the token this server was started with"));
        }
        Ok(())
    }

    fn count(&self, from: IpAddr) -> Result<(), Problem> {
        let mut counts = self.counts.lock().unwrap_or_else(PoisonError::into_inner);
        if counts.len() >= ADDRESSES {
            counts.retain(|_, (since, _)| since.elapsed() < WINDOW);
        }
        if counts.len() >= ADDRESSES && !counts.contains_key(&from) {
            return Err(Problem::new(StatusCode::TOO_MANY_REQUESTS, "too many addresses ask at once"));
        }
        let (since, count) = counts.entry(from).or_insert_with(|| (Instant::now(), 0));
        if since.elapsed() >= WINDOW {
            (*since, *count) = (Instant::now(), 0);
        }
        *count += 1;
        match *count > REQUESTS {
            true => {
                Err(Problem::new(StatusCode::TOO_MANY_REQUESTS, format!("more than {REQUESTS} requests in {WINDOW:?}")))
            }
            false => Ok(()),
        }
    }

    /// A person opens the address that was printed, with the token in it: the browser keeps it as a cookie that
    /// scripts and other sites do not see, and the address bar loses it.
    fn signing_in(&self, uri: &Uri) -> Option<Response> {
        let token = self.token.as_ref()?;
        let query = uri.query()?;
        let given = query.split('&').find_map(|pair| pair.strip_prefix("token="))?;
        if !same(given, token) {
            return None;
        }
        let cookie = format!("{COOKIE_NAME}={token}; HttpOnly; SameSite=Strict; Path=/");
        let cookie = HeaderValue::from_str(&cookie).ok()?;
        Some((StatusCode::SEE_OTHER, [(LOCATION, HeaderValue::from_static("/")), (SET_COOKIE, cookie)]).into_response())
    }
}

/// The middleware.
pub(super) async fn guard(
    State(guard): State<Arc<Guard>>,
    ConnectInfo(from): ConnectInfo<SocketAddr>,
    request: Request,
    next: Next,
) -> Response {
    let mut response = match (guard.count(from.ip()), guard.signing_in(request.uri())) {
        (Err(problem), _) => problem.into_response(),
        (Ok(()), Some(response)) => response,
        (Ok(()), None) => match guard.check(&request) {
            Ok(()) => match arrived(request, guard.body).await {
                Ok(request) => next.run(request).await,
                Err(problem) => problem.into_response(),
            },
            Err(problem) => problem.into_response(),
        },
    };
    let headers = response.headers_mut();
    for (name, value) in [
        (CONTENT_SECURITY_POLICY, POLICY),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (X_FRAME_OPTIONS, "DENY"),
        (REFERRER_POLICY, "no-referrer"),
        (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
        (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
        (CACHE_CONTROL, "no-store"),
    ] {
        headers.entry(name).or_insert(HeaderValue::from_static(value));
    }
    response
}

/// A request with its whole body, which must arrive in time.
async fn arrived(request: Request, patience: Duration) -> Result<Request, Problem> {
    if request.body().is_end_stream() {
        return Ok(request);
    }
    let (head, body) = request.into_parts();
    let too_long = || Problem::new(StatusCode::PAYLOAD_TOO_LARGE, format!("expected a body of at most {BODY} bytes"));
    // What is announced as too long need not come.
    if body.size_hint().lower() > BODY as u64 {
        return Err(too_long());
    }
    let bytes = tokio::time::timeout(patience, to_bytes(body, BODY))
        .await
        .map_err(|_| Problem::new(StatusCode::REQUEST_TIMEOUT, format!("the body did not arrive in {patience:?}")))?;
    let bytes = bytes.map_err(|why| match why.source().is_some_and(|why| why.is::<LengthLimitError>()) {
        true => too_long(),
        false => Problem::new(StatusCode::BAD_REQUEST, "the body is malformed"),
    })?;
    Ok(Request::from_parts(head, Body::from(bytes)))
}

/// Stands before every route, behind the choice of the method: who may only look changes nothing.
pub(super) async fn only_look(request: Request, next: Next) -> Response {
    match *request.method() {
        Method::GET | Method::HEAD => next.run(request).await,
        _ => Problem::forbidden("this server was started read-only").into_response(),
    }
}

/// A header that stands once.
fn single<'h>(headers: &'h HeaderMap, name: &HeaderName) -> Option<&'h str> {
    let mut values = headers.get_all(name).iter();
    let value = values.next()?.to_str().ok()?;
    values.next().is_none().then_some(value)
}

fn given(headers: &HeaderMap, token: &str) -> bool {
    let bearer = single(headers, &AUTHORIZATION).and_then(|value| value.strip_prefix("Bearer "));
    let cookies = headers.get_all(COOKIE).iter().filter_map(|value| value.to_str().ok());
    let mut pairs = cookies.flat_map(|value| value.split(';')).filter_map(|pair| pair.trim().split_once('='));
    let cookie = pairs.find(|(name, _)| *name == COOKIE_NAME).map(|(_, value)| value);
    bearer.into_iter().chain(cookie).any(|found| same(found, token))
}

/// Takes the same time wherever two texts of one length differ.
fn same(a: &str, b: &str) -> bool {
    a.len() == b.len() && a.bytes().zip(b.bytes()).fold(0, |all, (a, b)| all | (a ^ b)) == 0
}

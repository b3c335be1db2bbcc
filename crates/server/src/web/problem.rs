//! What a request gets that cannot be answered.

use axum::Json;
use axum::extract::rejection::{JsonRejection, PathRejection, QueryRejection};
use axum::extract::ws::rejection::WebSocketUpgradeRejection;
use axum::http::header::{CONNECTION, RETRY_AFTER};
use axum::http::{HeaderValue, StatusCode};
use axum::response::{IntoResponse, Response};
use serde::Serialize;

use crate::engine::NotTaken;

/// A status and a sentence for a person, as `{"error": "..."}`.
#[derive(Debug)]
pub(super) struct Problem {
    status: StatusCode,
    why: String,
}

#[derive(Serialize)]
struct Body<'a> {
    error: &'a str,
}

impl Problem {
    pub(super) fn new(status: StatusCode, why: impl Into<String>) -> Problem {
        Problem { status, why: why.into() }
    }

    /// It may not be done at all.
    pub(super) fn forbidden(why: impl Into<String>) -> Problem {
        Problem::new(StatusCode::FORBIDDEN, why)
    }

    /// What it names is not there.
    pub(super) fn missing(why: impl Into<String>) -> Problem {
        Problem::new(StatusCode::NOT_FOUND, why)
    }

    /// It makes no sense, whatever program is served.
    pub(super) fn unfit(why: impl Into<String>) -> Problem {
        Problem::new(StatusCode::UNPROCESSABLE_ENTITY, why)
    }

    /// It makes sense, but not with this program or in this state.
    pub(super) fn refused(why: impl Into<String>) -> Problem {
        Problem::new(StatusCode::CONFLICT, why)
    }
}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let mut response = (self.status, Json(Body { error: &self.why })).into_response();
        let more = match self.status {
            StatusCode::TOO_MANY_REQUESTS => Some((RETRY_AFTER, "10")),
            // What is left of the request is not read.
            StatusCode::REQUEST_TIMEOUT | StatusCode::PAYLOAD_TOO_LARGE => Some((CONNECTION, "close")),
            _ => None,
        };
        if let Some((name, value)) = more {
            response.headers_mut().insert(name, HeaderValue::from_static(value));
        }
        response
    }
}

impl From<NotTaken> for Problem {
    fn from(why: NotTaken) -> Problem {
        Problem::new(StatusCode::SERVICE_UNAVAILABLE, why.to_string())
    }
}

impl From<JsonRejection> for Problem {
    fn from(why: JsonRejection) -> Problem {
        Problem::new(why.status(), why.body_text())
    }
}

impl From<QueryRejection> for Problem {
    fn from(why: QueryRejection) -> Problem {
        Problem::new(why.status(), why.body_text())
    }
}

impl From<PathRejection> for Problem {
    fn from(why: PathRejection) -> Problem {
        Problem::new(why.status(), why.body_text())
    }
}

impl From<WebSocketUpgradeRejection> for Problem {
    fn from(why: WebSocketUpgradeRejection) -> Problem {
        Problem::new(why.status(), why.body_text())
    }
}

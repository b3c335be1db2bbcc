//! The pages themselves: files that are part of the program.

use axum::Json;
use axum::extract::rejection::PathRejection;
use axum::extract::{Path, State};
use axum::http::header::CONTENT_TYPE;
use axum::http::{StatusCode, Uri};
use axum::response::{IntoResponse, Response};

use serde_json::Value;

use super::Served;
use super::describe::description;
use super::problem::Problem;

const HTML: &str = "text/html; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";

/// Name, type and content of everything a page loads.
const ASSETS: &[(&str, &str, &str)] = &[
    ("api.js", SCRIPT, include_str!("../../assets/api.js")),
    ("bits.js", SCRIPT, include_str!("../../assets/bits.js")),
    ("detail.js", SCRIPT, include_str!("../../assets/detail.js")),
    ("dom.js", SCRIPT, include_str!("../../assets/dom.js")),
    ("fault.js", SCRIPT, include_str!("../../assets/fault.js")),
    ("help.js", SCRIPT, include_str!("../../assets/help.js")),
    ("ladder.js", SCRIPT, include_str!("../../assets/ladder.js")),
    ("main.js", SCRIPT, include_str!("../../assets/main.js")),
    ("menu.js", SCRIPT, include_str!("../../assets/menu.js")),
    ("pair.js", SCRIPT, include_str!("../../assets/pair.js")),
    ("pane.js", SCRIPT, include_str!("../../assets/pane.js")),
    ("palette.js", SCRIPT, include_str!("../../assets/palette.js")),
    ("run.js", SCRIPT, include_str!("../../assets/run.js")),
    ("rung.js", SCRIPT, include_str!("../../assets/rung.js")),
    ("session.js", SCRIPT, include_str!("../../assets/session.js")),
    ("tables.js", SCRIPT, include_str!("../../assets/tables.js")),
    ("theme.js", SCRIPT, include_str!("../../assets/theme.js")),
    ("trend.js", SCRIPT, include_str!("../../assets/trend.js")),
    ("values.js", SCRIPT, include_str!("../../assets/values.js")),
    ("proof.js", SCRIPT, include_str!("../../assets/proof.js")),
    ("style.css", STYLE, include_str!("../../assets/style.css")),
    ("views.css", STYLE, include_str!("../../assets/views.css")),
    ("pair.css", STYLE, include_str!("../../assets/pair.css")),
    ("rungs.css", STYLE, render::svg::STYLE),
];

pub(super) async fn index() -> Response {
    ([(CONTENT_TYPE, HTML)], include_str!("../../assets/index.html")).into_response()
}

pub(super) async fn asset(name: Result<Path<String>, PathRejection>) -> Result<Response, Problem> {
    let Path(name) = name?;
    let found = ASSETS.iter().find(|asset| asset.0 == name);
    let (_, kind, content) = found.ok_or_else(|| Problem::missing("there is no such file"))?;
    Ok(([(CONTENT_TYPE, *kind)], *content).into_response())
}

/// What the API offers, in the form tools read.
pub(super) async fn openapi(State(served): State<Served>) -> Json<Value> {
    let other = served.pair.as_ref().map(|pair| pair.outline());
    Json(description(served.token, served.program.outline(), other))
}

pub(super) async fn missing(uri: Uri) -> Problem {
    Problem::missing(format!("there is nothing at {}", uri.path()))
}

pub(super) async fn wrong_method() -> Problem {
    Problem::new(StatusCode::METHOD_NOT_ALLOWED, "this address does not take that method")
}

//! A server without a network: requests in, answers out. For tests that make many requests of any kind.

use std::sync::Arc;

use axum::Router;
use axum::body::{Body, to_bytes};
use axum::http::Request;
use axum::http::header::CONTENT_TYPE;
use tower_service::Service;

use super::{Access, Served, live};
use crate::engine::{Handle, Pace};
use crate::view::Program;

/// Longest answer that is looked at, bytes.
const ANSWER: usize = 64 << 20;

/// The routes of a server, without the guard that stands before them: who may ask is not the question here.
pub struct Offline {
    routes: Router,
    served: Served,
    runtime: tokio::runtime::Runtime,
}

impl Offline {
    /// Answers requests about a program that this engine runs.
    ///
    /// # Errors
    /// The system gives no runtime.
    pub fn new(engine: Handle, program: Arc<dyn Program>) -> std::io::Result<Offline> {
        let served = Served::new(engine, (program, None), &Access::default());
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        Ok(Offline { routes: super::unguarded(false).with_state(served.clone()), served, runtime })
    }

    /// Status and body of the answer to a request; `None` where the first line is none that HTTP knows. What runs is
    /// paused then.
    pub fn ask(&self, method: &str, path: &str, body: &[u8]) -> Option<(u16, Vec<u8>)> {
        let request = Request::builder().method(method).uri(path).header(CONTENT_TYPE, "application/json");
        let request = request.body(Body::from(body.to_vec())).ok()?;
        self.runtime.block_on(async {
            let Ok(answer) = self.routes.clone().call(request).await;
            let (head, body) = answer.into_parts();
            let body = to_bytes(body, ANSWER).await.ok()?;
            self.served.engine.ask(|engine| engine.set_pace(Pace::Paused)).await.ok()?;
            Some((head.status.as_u16(), body.to_vec()))
        })
    }

    /// What a page is told first that says what it shows.
    ///
    /// # Errors
    /// The message makes no sense.
    pub fn see(&self, message: &str) -> Result<String, String> {
        live::told_first(message, &self.served)
    }
}

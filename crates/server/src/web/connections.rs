//! Connections: how many there may be, and how long one may take for what it has to do.
//!
//! A client that sends its head or its body slowly, or does not read what it is sent, keeps a connection and nothing
//! else; after the times of [`Limits`] not even that.

use std::collections::HashMap;
use std::io;
use std::net::{IpAddr, SocketAddr};
use std::pin::Pin;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll};
use std::time::Duration;

use axum::Router;
use axum::extract::ConnectInfo;
use hyper::Request;
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::watch;
use tokio::task::JoinSet;
use tokio::time::{Instant, Sleep, sleep, sleep_until, timeout};
use tower_service::Service;

/// Header lines of a request, and bytes of its head.
const HEADERS: usize = 64;
const HEAD: usize = 32 << 10;

/// How long requests in progress may take to end when the server does.
const FAREWELL: Duration = Duration::from_secs(2);

/// What one client may take of a server.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Connections at once, of all clients.
    pub connections: usize,
    /// Connections at once of one address.
    pub connections_of_one: usize,
    /// From the start of a request, or the end of the one before, to the end of its head.
    pub head: Duration,
    /// For a body.
    pub body: Duration,
    /// Without taking any byte of what it is sent.
    pub deaf: Duration,
    /// Without a word on a WebSocket; pages answer a ping that comes three times as often by themselves.
    pub silent: Duration,
    /// Messages on one WebSocket in ten seconds.
    pub messages: u32,
}

impl Default for Limits {
    fn default() -> Limits {
        Limits {
            // A process may have 1,024 files open on most systems.
            connections: 800,
            connections_of_one: 500,
            head: Duration::from_secs(15),
            body: Duration::from_secs(15),
            deaf: Duration::from_secs(30),
            silent: Duration::from_secs(60),
            // One for every picture of a page that is scrolled, and as many again.
            messages: 1200,
        }
    }
}

/// Answers connections until `ended` is done.
pub(super) async fn serve(listener: TcpListener, router: Router, limits: Limits, ended: impl Future<Output = ()>) {
    let open = Arc::new(Open { limits, counts: Mutex::default() });
    let (end, ending) = watch::channel(false);
    let mut connections = JoinSet::new();
    tokio::pin!(ended);
    loop {
        let accepted = tokio::select! {
            () = &mut ended => break,
            accepted = listener.accept() => accepted,
            Some(_) = connections.join_next() => continue,
        };
        match accepted {
            Ok((stream, from)) => {
                // One too many is closed at once: a page that was open comes back by itself.
                let Some(place) = open.place(from.ip()) else { continue };
                connections.spawn(answer(stream, from, router.clone(), limits, ending.clone(), place));
            }
            // Too many files are open in this process, or the client is gone again.
            Err(_) => sleep(Duration::from_millis(100)).await,
        }
    }
    let _ = end.send(true);
    let _ = timeout(FAREWELL, async { while connections.join_next().await.is_some() {} }).await;
}

async fn answer(
    stream: TcpStream,
    from: SocketAddr,
    router: Router,
    limits: Limits,
    mut ending: watch::Receiver<bool>,
    place: Place,
) {
    // What is told is told at once; without this it only comes late.
    let _ = stream.set_nodelay(true);
    let stream = Patient { stream, patience: limits.deaf, deadline: None, _place: place };
    let answer = service_fn(move |mut request: Request<Incoming>| {
        request.extensions_mut().insert(ConnectInfo(from));
        router.clone().call(request)
    });
    let mut http = http1::Builder::new();
    http.timer(TokioTimer::new()).header_read_timeout(limits.head).max_headers(HEADERS).max_buf_size(HEAD);
    let connection = http.serve_connection(TokioIo::new(stream), answer).with_upgrades();
    tokio::pin!(connection);
    let gone = tokio::select! {
        // A client that has gone, or that was too slow, is told nothing.
        _ = connection.as_mut() => true,
        _ = ending.changed() => false,
    };
    if !gone {
        connection.as_mut().graceful_shutdown();
        let _ = connection.as_mut().await;
    }
}

/// Connections that are open.
struct Open {
    limits: Limits,
    counts: Mutex<HashMap<IpAddr, usize>>,
}

impl Open {
    fn place(self: &Arc<Open>, of: IpAddr) -> Option<Place> {
        let mut counts = self.counts.lock().unwrap_or_else(PoisonError::into_inner);
        if counts.values().sum::<usize>() >= self.limits.connections {
            return None;
        }
        let count = counts.entry(of).or_default();
        if *count >= self.limits.connections_of_one {
            return None;
        }
        *count += 1;
        Some(Place { open: Arc::clone(self), of })
    }
}

/// The right to one connection. It goes with the stream, also into a WebSocket.
struct Place {
    open: Arc<Open>,
    of: IpAddr,
}

impl Drop for Place {
    fn drop(&mut self) {
        let mut counts = self.open.counts.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(count) = counts.get_mut(&self.of) {
            *count = count.saturating_sub(1);
        }
        counts.retain(|_, count| *count > 0);
    }
}

/// A stream that gives up on a client which takes nothing for too long.
struct Patient {
    stream: TcpStream,
    patience: Duration,
    /// Set while the client takes nothing.
    deadline: Option<Pin<Box<Sleep>>>,
    _place: Place,
}

impl Patient {
    /// Passes on what writing gave; while it gives nothing, time runs.
    fn watch<T>(&mut self, done: Poll<io::Result<T>>, context: &mut Context<'_>) -> Poll<io::Result<T>> {
        if done.is_ready() {
            self.deadline = None;
            return done;
        }
        let patience = self.patience;
        let deadline = self.deadline.get_or_insert_with(|| Box::pin(sleep_until(Instant::now() + patience)));
        match deadline.as_mut().poll(context) {
            Poll::Ready(()) => Poll::Ready(Err(io::ErrorKind::TimedOut.into())),
            Poll::Pending => Poll::Pending,
        }
    }
}

impl AsyncRead for Patient {
    fn poll_read(mut self: Pin<&mut Self>, context: &mut Context<'_>, into: &mut ReadBuf<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_read(context, into)
    }
}

impl AsyncWrite for Patient {
    fn poll_write(mut self: Pin<&mut Self>, context: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let done = Pin::new(&mut self.stream).poll_write(context, bytes);
        self.watch(done, context)
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        let done = Pin::new(&mut self.stream).poll_flush(context);
        self.watch(done, context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        parts: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        let done = Pin::new(&mut self.stream).poll_write_vectored(context, parts);
        self.watch(done, context)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }
}

//! A server for the pages of a test, on a thread of its own.

use std::net::SocketAddr;

use tokio::net::TcpListener;

/// Serves on a free port until the tests end; answers the address of the page.
///
/// # Panics
/// When there is no port or thread.
pub fn until_the_end<S, F, T>(serve: S) -> String
where
    S: FnOnce(TcpListener) -> F + Send + 'static,
    F: Future<Output = T>,
{
    let (told, address) = std::sync::mpsc::channel::<SocketAddr>();
    std::thread::spawn(move || {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
        runtime.block_on(async {
            let listener = TcpListener::bind("127.0.0.1:0").await.expect("a free port");
            told.send(listener.local_addr().expect("bound")).expect("the test waits");
            serve(listener).await;
        });
    });
    format!("http://{}/", address.recv().expect("the server starts"))
}

//! The HTTP server: loopback only, with limits on everything that a stranger could exhaust.

use crate::events::{Beats, Pulse};
use crate::routes;
use crate::session::Session;
use crate::view::ViewError;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tokio::time::{interval, sleep};

/// The most open connections. Further ones are closed at once.
const MOST_CONNECTIONS: usize = 64;
/// A request must arrive within this time.
const REQUEST_TIME: Duration = Duration::from_secs(5);
/// An answer must be taken within this time.
const ANSWER_TIME: Duration = Duration::from_secs(60);
/// Streams get a sign of life this often.
const BEAT: Duration = Duration::from_secs(5);
/// A stream that takes nothing for this long is closed.
const STALLED: Duration = Duration::from_secs(20);
/// The most requests that compute at a time.
const MOST_QUERIES: usize = 2;

/// The state that all connections share.
pub(crate) struct Server {
    pub(crate) session: Arc<Session>,
    /// The secret first part of every path.
    pub(crate) token: String,
    pub(crate) port: u16,
    pub(crate) beats: Arc<Beats>,
    /// Limits the requests that compute.
    pub(crate) queries: Arc<Semaphore>,
}

/// A secret that cannot be guessed: 128 random bits.
pub(crate) fn secret() -> Result<String, ViewError> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|e| ViewError::Server(std::io::Error::other(e.to_string())))?;
    Ok(bytes.iter().map(|b| format!("{b:02x}")).collect())
}

/// Serves the session until the program ends. `ready` gets the address.
pub(crate) fn serve(session: Arc<Session>, port: u16, ready: impl FnOnce(&str)) -> Result<(), ViewError> {
    /// As for the renderers' threads: kernels that are compiled without optimisation have large
    /// frames. Only the part that is used takes memory.
    const STACK: usize = 64 << 20;
    let token = secret()?;
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .max_blocking_threads(2 * MOST_QUERIES)
        .thread_stack_size(STACK)
        .build()
        .map_err(ViewError::Server)?;
    runtime.block_on(async {
        let listener = TcpListener::bind(SocketAddr::from((Ipv4Addr::LOCALHOST, port))).await;
        let listener = listener.map_err(ViewError::Server)?;
        let port = listener.local_addr().map_err(ViewError::Server)?.port();
        ready(&format!("http://127.0.0.1:{port}/{token}/"));
        let queries = Arc::new(Semaphore::new(MOST_QUERIES));
        let server = Arc::new(Server { session, token, port, beats: Arc::default(), queries });
        tokio::spawn(beat(Arc::clone(&server)));
        let places = Arc::new(Semaphore::new(MOST_CONNECTIONS));
        loop {
            let Ok((stream, _)) = listener.accept().await else {
                // Too many open files, for example: wait until some are closed.
                sleep(Duration::from_millis(50)).await;
                continue;
            };
            let Ok(place) = Arc::clone(&places).try_acquire_owned() else { continue };
            let server = Arc::clone(&server);
            tokio::spawn(async move {
                connection(&server, stream).await;
                drop(place);
            });
        }
    })
}

async fn beat(server: Arc<Server>) {
    let mut ticks = interval(BEAT);
    loop {
        ticks.tick().await;
        server.beats.0.fetch_add(1, Ordering::Relaxed);
        server.session.wake();
    }
}

/// Answers one request; errors concern only its sender.
async fn connection(server: &Arc<Server>, stream: TcpStream) {
    let _ = stream.set_nodelay(true);
    let pulse = Arc::new(Pulse::default());
    let service = service_fn(|request| {
        let (server, pulse) = (Arc::clone(server), Arc::clone(&pulse));
        async move { Ok::<_, std::convert::Infallible>(routes::answer(&server, &pulse, request).await) }
    });
    let conversation = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(REQUEST_TIME)
        .keep_alive(false)
        .max_buf_size(32 << 10)
        .serve_connection(TokioIo::new(stream), service);
    let watchdog = async {
        sleep(ANSWER_TIME).await;
        while pulse.age().is_some_and(|age| age < STALLED) {
            sleep(BEAT).await;
        }
    };
    tokio::select! {
        _ = conversation => {}
        () = watchdog => {}
    }
}

//! The answers to requests.

use crate::channel::Channel;
use crate::events::{Events, Pulse, so_far};
use crate::explain;
use crate::rig::Move;
use crate::server::Server;
use crate::session::Session;
use bytes::Bytes;
use durer_render::AntiAliasing;
use durer_render::film::Bits;
use http_body_util::combinators::BoxBody;
use http_body_util::{BodyExt, Full, Limited};
use hyper::body::Incoming;
use hyper::header::{self, HeaderValue};
use hyper::{Method, Request, Response, StatusCode};
use serde_json::{Value, json};
use std::convert::Infallible;
use std::sync::Arc;

type Answer = Response<BoxBody<Bytes, Infallible>>;

/// The largest body of a request.
const MOST_BYTES: usize = 4 << 10;

const PAGE: &str = include_str!("page/index.html");
const STYLE: &str = include_str!("page/style.css");
const SCRIPT: &str = include_str!("page/app.js");
const PANEL: &str = include_str!("page/panel.js");

/// The page loads nothing but the answers of this server, and no other page may show it in a frame.
const POLICY: &str =
    "default-src 'none'; connect-src 'self'; img-src data: blob:; frame-ancestors 'none'; base-uri 'none'";

/// The page with its style, its scripts and the picture so far in one answer, so that it is shown
/// sooner. The browser runs what bears the number that this answer alone has.
fn page(session: &Session) -> Answer {
    let Ok(nonce) = crate::server::secret() else {
        return plain(StatusCode::INTERNAL_SERVER_ERROR, "no random numbers are at hand");
    };
    let style = format!("<style nonce=\"{nonce}\">\n{STYLE}</style>");
    let script = |text: &str| format!("<script nonce=\"{nonce}\">\n{text}</script>");
    // As data, "<" must not end the element.
    let so_far = so_far(session).to_string().replace('<', "\\u003c");
    let page = PAGE
        .replace(
            "<script src=\"so_far.json\"></script>",
            &format!("<script id=\"so-far\" type=\"application/json\">{so_far}</script>"),
        )
        .replace("<link rel=\"stylesheet\" href=\"style.css\">", &style)
        .replace("<script src=\"panel.js\"></script>", &script(PANEL))
        .replace("<script src=\"app.js\"></script>", &script(SCRIPT));
    let mut answer = typed("text/html; charset=utf-8", Full::new(Bytes::from(page)).boxed());
    let policy = format!("{POLICY}; style-src 'nonce-{nonce}'; script-src 'nonce-{nonce}'");
    if let Ok(policy) = HeaderValue::from_str(&policy) {
        answer.headers_mut().insert(header::CONTENT_SECURITY_POLICY, policy);
    }
    answer
}

/// Answers a request.
pub(crate) async fn answer(server: &Arc<Server>, pulse: &Arc<Pulse>, request: Request<Incoming>) -> Answer {
    let mut answer = match check(server, &request) {
        Err(status) => plain(status, status.canonical_reason().unwrap_or_default()),
        Ok(path) => {
            let path = path.to_owned();
            route(server, pulse, &path, request).await
        }
    };
    let headers = answer.headers_mut();
    for (name, value) in [
        (header::CACHE_CONTROL, "no-store"),
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    ] {
        headers.entry(name).or_insert(HeaderValue::from_static(value));
    }
    answer
}

/// The path behind the token, if the request names this server and knows the token.
fn check<'r>(server: &Server, request: &'r Request<Incoming>) -> Result<&'r str, StatusCode> {
    // A page of another site could otherwise reach this server under a name of its own.
    let host = request.headers().get(header::HOST).and_then(|h| h.to_str().ok()).unwrap_or_default();
    let own = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{}", server.port));
    if !own.iter().any(|own| own.eq_ignore_ascii_case(host)) {
        return Err(StatusCode::FORBIDDEN);
    }
    if let Some(origin) = request.headers().get(header::ORIGIN) {
        let origin = origin.to_str().unwrap_or_default();
        if !own.iter().any(|own| origin.strip_prefix("http://") == Some(own)) {
            return Err(StatusCode::FORBIDDEN);
        }
    }
    let path = request.uri().path().strip_prefix('/').unwrap_or_default();
    let (token, rest) = path.split_once('/').unwrap_or((path, ""));
    // All bytes are compared, so that the time says nothing about the first wrong one.
    let differ = token.bytes().zip(server.token.bytes()).fold(0, |d, (a, b)| d | (a ^ b));
    if token.len() != server.token.len() || differ != 0 {
        return Err(StatusCode::NOT_FOUND);
    }
    Ok(rest)
}

async fn route(server: &Arc<Server>, pulse: &Arc<Pulse>, path: &str, request: Request<Incoming>) -> Answer {
    match (request.method(), path) {
        (&Method::GET, "") if !request.uri().path().ends_with('/') => {
            // The page's files are named from its folder.
            let mut answer = plain(StatusCode::PERMANENT_REDIRECT, "");
            if let Ok(folder) = HeaderValue::from_str(&format!("/{}/", server.token)) {
                answer.headers_mut().insert(header::LOCATION, folder);
            }
            answer
        }
        (&Method::GET, "") => page(&server.session),
        (&Method::GET, "events") => match Events::join(&server.session, pulse, &server.beats) {
            Some(events) => typed("text/event-stream", events.boxed()),
            None => plain(StatusCode::SERVICE_UNAVAILABLE, "the scene is shown in too many windows already"),
        },
        (&Method::GET, "pixel") => pixel(server, request.uri().query().unwrap_or_default()).await,
        (&Method::GET, "picture.png" | "picture.exr") => picture(server, path).await,
        (&Method::POST, "move" | "show" | "aa") => {
            let path = path.to_owned();
            let Ok(body) = Limited::new(request.into_body(), MOST_BYTES).collect().await else {
                return plain(StatusCode::PAYLOAD_TOO_LARGE, "the request is too long");
            };
            let value = serde_json::from_slice(&body.to_bytes()).unwrap_or(Value::Null);
            change(server, &path, value).await
        }
        (&Method::GET | &Method::POST, _) => plain(StatusCode::NOT_FOUND, "Not Found"),
        _ => plain(StatusCode::METHOD_NOT_ALLOWED, "Method Not Allowed"),
    }
}

/// Changes the painted picture, and answers with the number of the generation that shows the
/// change.
async fn change(server: &Arc<Server>, path: &str, value: Value) -> Answer {
    let name = value.get("name").and_then(Value::as_str).unwrap_or_default();
    let generation = match path {
        "move" => match Move::read(&value) {
            // This asks the scene, which may be busy.
            Some(how @ Move::LookAt(..)) => {
                match computed(server, move |server| server.session.move_camera(how)).await {
                    Ok(generation) => Some(generation),
                    Err(answer) => return answer,
                }
            }
            how => how.map(|how| server.session.move_camera(how)),
        },
        "show" => Channel::named(name).map(|channel| server.session.show(channel)),
        _ => anti_aliasing(name).map(|how| server.session.anti_alias(how)),
    };
    match generation {
        Some(generation) => data(&json!({ "generation": generation })),
        None => plain(StatusCode::BAD_REQUEST, "the request lacks a value, or a value is unknown"),
    }
}

fn anti_aliasing(name: &str) -> Option<AntiAliasing> {
    let (threshold, depth) = (AntiAliasing::THRESHOLD, AntiAliasing::DEPTH);
    Some(match name {
        "off" => AntiAliasing::Off,
        "method1" => AntiAliasing::Method1 { threshold, depth },
        "method2" => AntiAliasing::Method2 { threshold, depth },
        "3x3" => AntiAliasing::Grid(3),
        _ => return None,
    })
}

/// The ray of a pixel: `x=N&y=N`.
async fn pixel(server: &Arc<Server>, query: &str) -> Answer {
    let number = |name: &str| {
        let pairs = query.split('&').filter_map(|pair| pair.split_once('='));
        pairs.filter(|(key, _)| *key == name).find_map(|(_, value)| value.parse::<u32>().ok())
    };
    let (width, height) = server.session.file.size();
    let pixel = match (number("x"), number("y")) {
        (Some(x), Some(y)) if x < width && y < height => (x, y),
        _ => return plain(StatusCode::BAD_REQUEST, "there is no such pixel"),
    };
    match computed(server, move |server| explain::pixel(&server.session, pixel)).await {
        Ok(Ok(value)) => data(&value),
        Ok(Err(message)) => plain(StatusCode::CONFLICT, &message),
        Err(answer) => answer,
    }
}

/// The finished picture as a file.
async fn picture(server: &Arc<Server>, path: &str) -> Answer {
    let ending = path.rsplit('.').next().unwrap_or_default().to_owned();
    let kind = if ending == "png" { "image/png" } else { "image/x-exr" };
    let made = computed(server, move |server| {
        let shared = server.session.shared();
        let (generation, _, is_last) = shared.done;
        // As a PNG only the picture is written: a view is coloured by the page.
        let is_shown = ending == "exr" || shared.channel == Channel::Picture;
        if !is_last || generation != shared.generation || !is_shown {
            return None;
        }
        let film = shared.film.clone();
        drop(shared);
        let mut file = std::io::Cursor::new(Vec::new());
        let written = match ending.as_str() {
            "png" => film.write_png(&mut file, Bits::Eight),
            _ => film.write_exr(&mut file),
        };
        Some(written.map(|()| file.into_inner()).map_err(|e| e.to_string()))
    });
    let file = match made.await {
        Ok(Some(Ok(file))) => file,
        Ok(Some(Err(message))) => return plain(StatusCode::INTERNAL_SERVER_ERROR, &message),
        Ok(None) => return plain(StatusCode::CONFLICT, "the picture is not finished yet"),
        Err(answer) => return answer,
    };
    let mut answer = typed(kind, Full::new(Bytes::from(file)).boxed());
    // The page names the file.
    answer.headers_mut().insert(header::CONTENT_DISPOSITION, HeaderValue::from_static("attachment"));
    answer
}

/// Computes on a thread of its own; few at a time, so that renderers get their share.
async fn computed<R: Send + 'static>(
    server: &Arc<Server>,
    work: impl FnOnce(&Server) -> R + Send + 'static,
) -> Result<R, Answer> {
    let busy = || plain(StatusCode::SERVICE_UNAVAILABLE, "this could not be computed");
    let place = Arc::clone(&server.queries).acquire_owned().await.map_err(|_| busy())?;
    let server = Arc::clone(server);
    let work = move || {
        let result = work(&server);
        drop(place);
        result
    };
    tokio::task::spawn_blocking(work).await.map_err(|_| busy())
}

fn typed(kind: &'static str, body: BoxBody<Bytes, Infallible>) -> Answer {
    let mut answer = Response::new(body);
    answer.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(kind));
    answer
}

fn data(value: &Value) -> Answer {
    typed("application/json", Full::new(Bytes::from(value.to_string())).boxed())
}

fn plain(status: StatusCode, message: &str) -> Answer {
    let body = Full::new(Bytes::from(message.to_owned())).boxed();
    let mut answer = typed("text/plain; charset=utf-8", body);
    *answer.status_mut() = status;
    answer
}

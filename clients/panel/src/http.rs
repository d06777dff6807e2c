//! Requests to the server's own interface.

use leptos::prelude::window;
use pairing::wire::Refused;
use panel_logic::refusal_text;
use serde::Serialize;
use serde::de::DeserializeOwned;
use wasm_bindgen::{JsCast as _, JsValue};
use wasm_bindgen_futures::JsFuture;
use web_sys::{File, Headers, RequestInit, Response};

use crate::language::words;

/// Why there is no answer that can be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Failed {
    /// The robot does not know this device.
    NotPaired,
    /// The server says no.
    Refused(Refused),
    /// The server does not answer, or not in a known form.
    Unreachable,
}

impl Failed {
    /// For people.
    pub(crate) fn text(&self) -> String {
        match self {
            Self::NotPaired => words().access.not_paired.to_owned(),
            Self::Refused(refused) => refusal_text(words(), &refused.reason, &refused.text),
            Self::Unreachable => words().access.unreachable.to_owned(),
        }
    }
}

pub(crate) async fn get<T: DeserializeOwned>(path: &str) -> Result<T, Failed> {
    read(&text_of(path, &init("GET")).await?)
}

pub(crate) async fn post<T: DeserializeOwned>(path: &str, body: &impl Serialize) -> Result<T, Failed> {
    read(&send(path, body).await?)
}

/// For what has no answer but done.
pub(crate) async fn send(path: &str, body: &impl Serialize) -> Result<String, Failed> {
    let text = serde_json::to_string(body).map_err(|_| Failed::Unreachable)?;
    change(path, "application/json", &JsValue::from_str(&text)).await
}

/// A file, which the browser reads from its disk as it goes out.
pub(crate) async fn send_file(path: &str, file: &File) -> Result<String, Failed> {
    change(path, "application/octet-stream", file).await
}

async fn change(path: &str, kind: &str, body: &JsValue) -> Result<String, Failed> {
    let init = init("POST");
    let headers = Headers::new().map_err(unreachable)?;
    for (name, value) in [("content-type", kind), ("x-rvac", "1")] {
        headers.set(name, value).map_err(unreachable)?;
    }
    init.set_headers(&headers);
    init.set_body(body);
    text_of(path, &init).await
}

fn init(method: &str) -> RequestInit {
    let init = RequestInit::new();
    init.set_method(method);
    init
}

async fn text_of(path: &str, init: &RequestInit) -> Result<String, Failed> {
    let answer = JsFuture::from(window().fetch_with_str_and_init(path, init))
        .await
        .map_err(unreachable)?;
    let answer: Response = answer.dyn_into().map_err(unreachable)?;
    let text = JsFuture::from(answer.text().map_err(unreachable)?)
        .await
        .map_err(unreachable)?;
    let text = text.as_string().unwrap_or_default();
    match answer.status() {
        200..300 => Ok(text),
        401 => Err(Failed::NotPaired),
        _ => Err(serde_json::from_str(&text).map_or(Failed::Unreachable, Failed::Refused)),
    }
}

fn read<T: DeserializeOwned>(text: &str) -> Result<T, Failed> {
    serde_json::from_str(text).map_err(|_| Failed::Unreachable)
}

/// The browser's own words are for developers: they are in its console.
fn unreachable(_: JsValue) -> Failed {
    Failed::Unreachable
}

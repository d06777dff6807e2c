//! The WebSocket to the server, made again for ever.

use std::cell::RefCell;
use std::rc::Rc;
use std::time::Duration;

use leptos::prelude::*;
use pairing::wire::Greeting;
use panel_logic::{Backoff, PieceJoiner};
use rvac_api::{Request, RequestBody, Update};
use wasm_bindgen::JsCast;
use wasm_bindgen::closure::Closure;
use web_sys::{Event, MessageEvent, WebSocket};

use crate::access::Access;
use crate::store::Store;

/// Bytes that may wait in the browser. A drive request behind more than this would arrive late and still count as fresh.
const WAITING_MAX: u32 = 2048;

/// The connection or the wish for one.
#[derive(Clone, Default)]
pub(crate) struct Link {
    inner: Rc<RefCell<Inner>>,
}

#[derive(Default)]
struct Inner {
    socket: Option<WebSocket>,
    listeners: Option<Listeners>,
    backoff: Backoff,
    pieces: PieceJoiner,
}

/// Kept alive as long as the socket that calls them.
struct Listeners {
    _open: Closure<dyn FnMut(Event)>,
    _message: Closure<dyn FnMut(MessageEvent)>,
    _close: Closure<dyn FnMut(Event)>,
}

impl Link {
    /// Connects, if this device is paired; after a loss tries again with growing pauses.
    pub(crate) fn connect(&self, store: Store) {
        let link = self.clone();
        leptos::task::spawn_local(async move {
            match store.entrance.ask().await {
                Some(Access::Known(session)) => link.open(store, session.nonce),
                // Whoever pairs it connects then.
                Some(Access::Stranger) => {}
                Some(Access::Asked) | None => {
                    store.on_close();
                    link.retry(store);
                }
            }
        });
    }

    /// `nonce` is said first, where the server asks for it.
    fn open(&self, store: Store, nonce: Option<String>) {
        let Ok(socket) = WebSocket::new(&address()) else {
            self.retry(store);
            return;
        };
        let listeners = self.listen(&socket, store, nonce);
        let mut inner = self.inner.borrow_mut();
        inner.socket = Some(socket);
        inner.listeners = Some(listeners);
    }

    /// Sends a request if the connection is open. A drive request is dropped rather than sent late.
    pub(crate) fn send(&self, request: &Request) {
        let inner = self.inner.borrow();
        let Some(socket) = inner
            .socket
            .as_ref()
            .filter(|socket| socket.ready_state() == WebSocket::OPEN)
        else {
            return;
        };
        let drives = matches!(request.body, RequestBody::Drive { .. });
        if drives && socket.buffered_amount() > WAITING_MAX {
            return;
        }
        if let Ok(text) = serde_json::to_string(request) {
            socket.send_with_str(&text).ok(); // A closing socket reports that by its own event.
        }
    }

    fn listen(&self, socket: &WebSocket, store: Store, nonce: Option<String>) -> Listeners {
        let link = self.clone();
        let greeting = nonce.and_then(|nonce| serde_json::to_string(&Greeting { nonce }).ok());
        let open = Closure::<dyn FnMut(Event)>::new(move |_| {
            link.inner.borrow_mut().backoff.succeeded();
            link.inner.borrow_mut().pieces.clear();
            link.greet(greeting.as_deref());
            store.on_open();
        });
        let link = self.clone();
        let message = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
            store.on_heard();
            let text = event.data().as_string().unwrap_or_default();
            link.take(store, &text);
        });
        let link = self.clone();
        let close = Closure::<dyn FnMut(Event)>::new(move |_| {
            store.on_close();
            link.retry(store);
        });
        socket.set_onopen(Some(open.as_ref().unchecked_ref()));
        socket.set_onmessage(Some(message.as_ref().unchecked_ref()));
        socket.set_onclose(Some(close.as_ref().unchecked_ref()));
        Listeners {
            _open: open,
            _message: message,
            _close: close,
        }
    }

    /// Reads an update, or the next piece of one.
    fn take(&self, store: Store, text: &str) {
        match serde_json::from_str::<Update>(text) {
            Ok(Update::Piece { lane, last, text }) => {
                let whole = self.inner.borrow_mut().pieces.push(lane, &text, last);
                if let Some(whole) = whole {
                    self.take(store, &whole);
                }
            }
            Ok(update) => store.on_update(update),
            Err(error) => leptos::logging::warn!("a message could not be read: {error}"),
        }
    }

    /// Gives the connection up: its own close would come minutes later on a network that is gone.
    pub(crate) fn abandon(&self, store: Store) {
        let socket = self.inner.borrow_mut().socket.take();
        let Some(socket) = socket else { return };
        socket.set_onopen(None);
        socket.set_onmessage(None);
        socket.set_onclose(None);
        socket.close().ok(); // It may be closing already.
        store.on_close();
        self.retry(store);
    }

    fn greet(&self, greeting: Option<&str>) {
        let inner = self.inner.borrow();
        if let (Some(socket), Some(greeting)) = (&inner.socket, greeting) {
            socket.send_with_str(greeting).ok(); // A closing socket reports that by its own event.
        }
    }

    fn retry(&self, store: Store) {
        let pause = self.inner.borrow_mut().backoff.pause_ms();
        let link = self.clone();
        set_timeout(move || link.connect(store), Duration::from_millis(pause.into()));
    }
}

fn address() -> String {
    let host = window().location().host().unwrap_or_default();
    let scheme = if window()
        .location()
        .protocol()
        .is_ok_and(|protocol| protocol == "https:")
    {
        "wss"
    } else {
        "ws"
    };
    format!("{scheme}://{host}/api/ws?live")
}

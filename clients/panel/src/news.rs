//! How current the page is: looked at four times a second, and shown where it is not.

use std::time::Duration;

use leptos::prelude::*;
use panel_logic::{Currency, News};
use rvac_api::Status;

use crate::changes::set_if_changed;
use crate::language::words;
use crate::store::Store;

const LOOK_EVERY: Duration = Duration::from_millis(250);

/// Milliseconds of the browser's clock, which no change of the time of day touches.
pub(crate) fn now_ms() -> f64 {
    window().performance().map_or(0.0, |clock| clock.now())
}

impl Store {
    /// Looks whether the page is current, as long as it is open.
    pub(crate) fn watch_news(self) {
        let look = move || {
            let news = self.news.get_value();
            let currency = news.currency(now_ms());
            if currency != Currency::Current && self.currency.get_untracked() == Currency::Current {
                // What hands do now would arrive late.
                self.seat.lose();
            }
            set_if_changed(self.currency, currency);
            if currency == Currency::Away {
                self.show_away();
            }
            if news.gives_up(now_ms()) {
                self.reconnect();
            }
            self.give_up_presses();
        };
        set_interval(look, LOOK_EVERY);
    }

    /// Something came from the server.
    pub(crate) fn on_heard(self) {
        self.news.update_value(|news| news.on_heard(now_ms()));
    }

    /// The server says that it is there, and since when the daemon is silent.
    pub(crate) fn on_heartbeat(self, silent_ms: Option<u64>) {
        self.news
            .update_value(|news| news.on_heartbeat(now_ms(), silent_ms));
    }

    /// The server is not to be had: the state says so, once a glitch has become a loss.
    fn show_away(self) {
        let is_shown = self
            .status
            .with_untracked(|status| status.as_ref().is_some_and(|status| status.reason == "no-server"));
        if !is_shown {
            self.status.set(Some(Status {
                state: "disconnected".to_owned(),
                reason: "no-server".to_owned(),
                ..Status::default()
            }));
            self.device.set(None);
        }
    }
}

/// That what is seen is old, how old, and what to do.
#[component]
pub(crate) fn SilenceView(store: Store) -> impl IntoView {
    let silent_s = Memo::new(move |_| match store.currency.get() {
        Currency::Silent(seconds) => Some(seconds),
        Currency::Current | Currency::Away => None,
    });
    let is_silent = Memo::new(move |_| silent_s.get().is_some());
    view! {
        <Show when=move || is_silent.get()>
            <div class="silence" id="silence">
                <p><strong>{move || silent_s.get().map(|seconds| words().status.silent.fill([&seconds]))}</strong></p>
                <p role="alert">{words().status.silent_remedy}</p>
            </div>
        </Show>
    }
}

/// A page that has heard nothing yet.
pub(crate) fn no_news() -> StoredValue<News> {
    StoredValue::new(News::default())
}

//! Reads the inputs fifty times a second, and releases them when the page is no longer visible.

use std::time::Duration;

use leptos::ev;
use leptos::prelude::*;
use mixer::STEP_EVERY_US;

use super::gamepads;
use crate::store::Store;

/// Steps until the view is gone.
pub(super) fn watch(store: Store) {
    gamepads::watch(store.seat.plugged);
    let step = move || {
        if is_away() {
            store.let_go();
        } else if store.bench.is_open() {
            store.edit_step();
        } else if store.seat.is_lent.get_untracked() {
            store.lend_step();
        } else {
            store.drive();
        }
    };
    let steps = set_interval_with_handle(step, Duration::from_micros(STEP_EVERY_US));
    let hidden = window_event_listener(ev::visibilitychange, move |_| {
        if document().hidden() {
            store.let_go();
        }
    });
    let blurred = window_event_listener(ev::blur, move |_| store.let_go());
    let left = window_event_listener_untyped("pagehide", move |_| store.let_go());
    on_cleanup(move || {
        if let Ok(steps) = steps {
            steps.clear();
        }
        hidden.remove();
        blurred.remove();
        left.remove();
        store.let_go();
    });
}

/// The page is not visible, or another one has the focus.
fn is_away() -> bool {
    document().hidden() || !document().has_focus().unwrap_or(true)
}

//! On a phone all but the map is a sheet that lies over the lower part of the map. It is pulled up by scrolling the page; the handle
//! at its top does the same for a press.

use leptos::ev;
use leptos::html::Button;
use leptos::prelude::*;

use crate::icons::{Icon, icon};
use crate::language::words;

/// A sheet that is raised by more than this is pushed down by a press, CSS pixels.
const RAISED_PX: f64 = 40.0;
/// So much of the height of the page a press raises it.
const RAISE_SHARE: f64 = 0.5;

/// The bar at the top, under which the handle must not go, with a gap, CSS pixels.
const BAR_PX: f64 = 62.0;

/// Shows the map whole, for what is done on it.
pub(crate) fn lower() {
    scroll_to(0.0);
}

#[component]
pub(crate) fn SheetHandle() -> impl IntoView {
    let is_raised = RwSignal::new(false);
    let listener = window_event_listener(ev::scroll, move |_| {
        let raised = scrolled_px() > RAISED_PX;
        if raised != is_raised.get_untracked() {
            is_raised.set(raised);
        }
    });
    on_cleanup(move || listener.remove());
    let handle = NodeRef::<Button>::new();
    let press = move |_| {
        // Asked anew: the page tells of its scrolling only with its next picture.
        let scrolled_px = scrolled_px();
        if scrolled_px > RAISED_PX {
            lower();
            return;
        }
        let height_px = window().inner_height().ok().and_then(|height| height.as_f64());
        let above_px = handle.get_untracked().map_or(0.0, |handle| {
            handle.get_bounding_client_rect().top() + scrolled_px - BAR_PX
        });
        scroll_to((RAISE_SHARE * height_px.unwrap_or_default()).min(above_px));
    };
    let text = move || {
        let texts = &words().frame;
        if is_raised.get() {
            texts.lower_sheet
        } else {
            texts.raise_sheet
        }
    };
    view! {
        <button
            type="button"
            class="sheet-handle"
            id="sheet-handle"
            node_ref=handle
            aria-label=text
            data-raised=move || if is_raised.get() { "yes" } else { "no" }
            on:click=press
        >
            {icon(Icon::Up)}
        </button>
    }
}

/// How far the page is scrolled, CSS pixels.
fn scrolled_px() -> f64 {
    window().scroll_y().unwrap_or_default()
}

fn scroll_to(top_px: f64) {
    window().scroll_to_with_x_and_y(0.0, top_px);
}

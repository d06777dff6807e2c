//! The pad for finger or mouse, and keys while it has the focus.

use leptos::ev::{KeyboardEvent, PointerEvent};
use leptos::html;
use leptos::prelude::*;
use mixer::KeyCode;
use panel_logic::{Driver, knob_place};

use crate::drive::Seat;
use crate::language::words;

/// Share of the pad's half width that the knob can travel.
const TRAVEL: f64 = 0.63;

/// What hands and keys do to the pad.
#[derive(Clone, Copy)]
struct PadControl {
    seat: Seat,
    pad: NodeRef<html::Div>,
    ready: Signal<bool>,
}

impl PadControl {
    /// The pointer took hold of the pad.
    fn press(self, event: &PointerEvent) {
        if !self.ready.get_untracked() || event.button() != 0 {
            return;
        }
        if let Some(pad) = self.pad.get_untracked() {
            pad.set_pointer_capture(event.pointer_id()).ok(); // A pointer that is gone already ends the hold by itself.
        }
        self.place(event);
    }

    /// The pointer moved; it counts only while it holds the pad.
    fn drag(self, event: &PointerEvent) {
        if self
            .pad
            .get_untracked()
            .is_some_and(|pad| pad.has_pointer_capture(event.pointer_id()))
        {
            self.place(event);
        }
    }

    /// The pointer let go, or was taken away.
    fn free(self) {
        self.seat.put_knob([0.0, 0.0]);
    }

    /// A key went down or up; one that the mix does not know is left to the page.
    fn key(self, event: &KeyboardEvent, apply: fn(&mut Driver, KeyCode)) {
        let plain = !event.ctrl_key() && !event.alt_key() && !event.meta_key();
        let key = self.seat.driver.with_value(|driver| driver.key(&event.code()));
        let Some(key) = key.filter(|_| plain && self.ready.get_untracked()) else {
            return;
        };
        event.prevent_default();
        if !event.repeat() {
            self.seat.note_input(event.time_stamp());
            self.seat.driver.update_value(|driver| apply(driver, key));
        }
    }

    /// Puts the knob under the pointer, as far as it can travel.
    fn place(self, event: &PointerEvent) {
        let Some(pad) = self.pad.get_untracked() else {
            return;
        };
        let frame = pad.get_bounding_client_rect();
        let reach = frame.width() / 2.0 * TRAVEL;
        let right = (f64::from(event.client_x()) - frame.left() - frame.width() / 2.0) / reach;
        let down = (f64::from(event.client_y()) - frame.top() - frame.height() / 2.0) / reach;
        self.seat.note_input(event.time_stamp());
        self.seat.put_knob(knob_place(right, down));
    }
}

#[component]
pub(crate) fn Pad(seat: Seat, ready: Signal<bool>) -> impl IntoView {
    let pad = NodeRef::<html::Div>::new();
    let grip = PadControl { seat, pad, ready };
    let place_knob = move || {
        let [right, down] = seat.knob.get();
        format!("translate({}px, {}px)", right * 58.0, down * 58.0)
    };
    view! {
        <div
            class="pad"
            id="pad"
            node_ref=pad
            tabindex="0"
            role="application"
            aria-label=words().drive.pad
            aria-describedby="drive-hint"
            aria-disabled=move || if ready.get() { "false" } else { "true" }
            on:pointerdown=move |event| grip.press(&event)
            on:pointermove=move |event| grip.drag(&event)
            on:pointerup=move |_| grip.free()
            on:pointercancel=move |_| grip.free()
            on:lostpointercapture=move |_| grip.free()
            on:keydown=move |event| grip.key(&event, Driver::press)
            on:keyup=move |event| grip.key(&event, Driver::lift)
            on:blur=move |_| seat.hands_off()
        >
            <svg class="pad-arrows" viewBox="0 0 200 200" aria-hidden="true">
                <path d="M92 26l8-10 8 10M92 174l8 10 8-10M26 92l-10 8 10 8M174 92l10 8-10 8" />
            </svg>
            <div class="knob" style:transform=place_knob></div>
        </div>
    }
}

//! The pad for finger or mouse, and keys while it has the focus.

use leptos::ev::{self, Event, KeyboardEvent, PointerEvent};
use leptos::html;
use leptos::prelude::*;
use mixer::KeyCode;
use panel_logic::{Driver, PadEvent, Pointer, PointerKind, knob_place};
use wasm_bindgen::JsCast;
use web_sys::{MouseEvent, Node};

use crate::drive::Seat;
use crate::language::words;

/// Share of the pad's half width that the knob can travel.
const TRAVEL: f64 = 0.63;
/// What browsers call a finger.
const FINGER: &str = "touch";

/// What hands and keys do to the pad.
#[derive(Clone, Copy)]
struct PadControl {
    seat: Seat,
    pad: NodeRef<html::Div>,
    ready: Signal<bool>,
}

impl PadControl {
    /// A pointer goes down, on the pad or elsewhere. One that the browser does not capture for the pad would not tell its end.
    fn press(self, event: &PointerEvent) {
        let target = event.target().and_then(|target| target.dyn_into::<Node>().ok());
        let pad = self.pad.get_untracked();
        let Some(pad) = pad.filter(|pad| pad.contains(target.as_ref())) else {
            return self.end(event);
        };
        let counts = self.ready.get_untracked() && event.button() == 0;
        if counts && pad.set_pointer_capture(event.pointer_id()).is_ok() {
            self.hear(event, PadEvent::Pressed);
        }
    }

    /// A pointer moves, on the pad or elsewhere.
    fn follow(self, event: &PointerEvent) {
        if self.is_held() {
            self.hear(event, PadEvent::Moved);
        }
    }

    /// A pointer goes up, is taken away, or is captured no more.
    fn end(self, event: &PointerEvent) {
        self.seat.touch(PadEvent::Ended(event.pointer_id()));
    }

    /// The browser asks for a menu. It would take the pointer away, and a finger that is held still wants none.
    fn menu(self, event: &Event) {
        if self.is_held() {
            event.prevent_default();
        }
        self.seat.touch(PadEvent::Menu);
    }

    /// The browser begins to drag or to select something, and would take the pointer away for that.
    fn refuse(self, event: &Event) {
        if self.is_held() {
            event.prevent_default();
        }
        self.seat.touch(PadEvent::TakenAway);
    }

    /// A press begins neither a selection nor a drag. The keys need the focus that it would have brought.
    fn focus(self, event: &MouseEvent) {
        event.prevent_default();
        if let Some(pad) = self.pad.get_untracked() {
            pad.focus().ok(); // Without the focus only the keys do not drive.
        }
    }

    fn is_held(self) -> bool {
        self.seat.driver.with_value(Driver::is_touched)
    }

    fn hear(self, event: &PointerEvent, kind: fn(Pointer) -> PadEvent) {
        if let Some(pointer) = self.pointer(event) {
            self.seat.note_input(event.time_stamp());
            self.seat.touch(kind(pointer));
        }
    }

    /// A pointer, with the knob under it as far as it can travel.
    fn pointer(self, event: &PointerEvent) -> Option<Pointer> {
        let frame = self.pad.get_untracked()?.get_bounding_client_rect();
        let reach = frame.width() / 2.0 * TRAVEL;
        let right = (f64::from(event.client_x()) - frame.left() - frame.width() / 2.0) / reach;
        let down = (f64::from(event.client_y()) - frame.top() - frame.height() / 2.0) / reach;
        Some(Pointer {
            number: event.pointer_id(),
            kind: match event.pointer_type().as_str() {
                FINGER => PointerKind::Finger,
                _ => PointerKind::Other,
            },
            buttons: event.buttons(),
            place: knob_place(right, down),
        })
    }

    /// A key went down; one that the mix does not know is left to the page.
    fn key(self, event: &KeyboardEvent) {
        let plain = !event.ctrl_key() && !event.alt_key() && !event.meta_key();
        if !plain {
            // Systems keep keys that go up with these from the page.
            return self.seat.hands_off();
        }
        let key: Option<KeyCode> = self.seat.driver.with_value(|driver| driver.key(&event.code()));
        let Some(key) = key.filter(|_| self.ready.get_untracked()) else {
            return;
        };
        event.prevent_default();
        if !event.repeat() {
            self.seat.note_input(event.time_stamp());
            self.seat.driver.update_value(|driver| driver.press(key));
        }
    }

    /// A key went up, whatever it means now.
    fn lift(self, event: &KeyboardEvent) {
        self.seat.note_input(event.time_stamp());
        self.seat.driver.update_value(|driver| driver.lift(&event.code()));
    }

    /// Hears what happens to a pressed pointer anywhere on the page, until the view is gone.
    fn watch_page(self) {
        let listeners = [
            window_event_listener(ev::pointerdown, move |event| self.press(&event)),
            window_event_listener(ev::pointermove, move |event| self.follow(&event)),
            window_event_listener(ev::pointerup, move |event| self.end(&event)),
            window_event_listener(ev::pointercancel, move |event| self.end(&event)),
            window_event_listener(ev::contextmenu, move |event| self.menu(&event)),
            window_event_listener(ev::dragstart, move |event| self.refuse(&event)),
            window_event_listener_untyped("selectstart", move |event| self.refuse(&event)),
        ];
        on_cleanup(move || listeners.into_iter().for_each(WindowListenerHandle::remove));
    }
}

#[component]
pub(crate) fn Pad(seat: Seat, ready: Signal<bool>) -> impl IntoView {
    let pad = NodeRef::<html::Div>::new();
    let grip = PadControl { seat, pad, ready };
    grip.watch_page();
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
            on:lostpointercapture=move |event| grip.end(&event)
            on:mousedown=move |event| grip.focus(&event)
            on:keydown=move |event| grip.key(&event)
            on:keyup=move |event| grip.lift(&event)
            on:blur=move |_| seat.hands_off()
        >
            <svg class="pad-arrows" viewBox="0 0 200 200" aria-hidden="true">
                <path d="M92 26l8-10 8 10M92 174l8 10 8-10M26 92l-10 8 10 8M174 92l10 8-10 8" />
            </svg>
            <div class="knob" style:transform=place_knob></div>
        </div>
    }
}

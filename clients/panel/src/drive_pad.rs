//! Driving by hand: a pad for finger or mouse, and keys while the pad has the focus.

use std::time::Duration;

use leptos::ev::{self, KeyboardEvent, PointerEvent};
use leptos::html;
use leptos::prelude::*;
use panel_logic::{Driver, Intent, Key, Offer};

use crate::store::Store;

/// Share of the pad's half width that the knob can travel.
const TRAVEL: f64 = 0.63;

#[component]
pub(crate) fn DrivePad(store: Store) -> impl IntoView {
    let knob = RwSignal::new((0.0, 0.0));
    renew_and_guard(store, knob);
    let offer = Memo::new(move |_| store.offers().drive);
    let why = move || match offer.get() {
        Offer::NotNow(why) => why,
        Offer::Ready | Offer::Absent => {
            "Hold the knob, or focus the pad and hold W\u{a0}A\u{a0}S\u{a0}D or arrow keys. Letting go stops."
        }
    };
    let cleans = move || {
        store.robot.with(|robot| {
            robot.as_ref().is_some_and(|robot| {
                robot
                    .parts
                    .iter()
                    .any(|part| part == "brush-main" || part == "vacuum")
            })
        })
    };
    let choose_cleaners = move |event| {
        let set = if event_target_checked(&event) {
            Driver::clean_while_driving
        } else {
            Driver::drive_only
        };
        store.driver.update_value(set);
    };
    view! {
        <div class="drive">
            <Pad store knob ready=Signal::derive(move || offer.get() == Offer::Ready) />
            <p class="hint" id="drive-hint">{why}</p>
            <Show when=cleans>
                <label class="check">
                    <input type="checkbox" id="clean-while-driving" on:change=choose_cleaners />
                    "Clean while driving"
                </label>
            </Show>
        </div>
    }
}

/// What hands and keys do to the pad.
#[derive(Clone, Copy)]
struct Grip {
    store: Store,
    knob: RwSignal<(f64, f64)>,
    pad: NodeRef<html::Div>,
    ready: Signal<bool>,
}

impl Grip {
    /// The pointer took hold of the pad.
    fn press(self, event: &PointerEvent) {
        if !self.ready.get_untracked() || event.button() != 0 {
            return;
        }
        if let Some(pad) = self.pad.get_untracked() {
            pad.set_pointer_capture(event.pointer_id()).ok(); // A pointer that is gone already ends the hold by itself.
        }
        self.place(event);
        self.store.drive();
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
        self.knob.set((0.0, 0.0));
        self.store.driver.update_value(Driver::free_pad);
        self.store.drive();
    }

    /// A key went down or up; one that does not drive is left to the page.
    fn key(self, event: &KeyboardEvent, apply: fn(&mut Driver, Key)) {
        let plain = !event.ctrl_key() && !event.alt_key() && !event.meta_key();
        let free = plain && self.ready.get_untracked();
        let Some(key) = Key::from_code(&event.code()).filter(|_| free) else {
            return;
        };
        event.prevent_default();
        if !event.repeat() {
            self.store.driver.update_value(|driver| apply(driver, key));
            self.store.drive();
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
        let length = right.hypot(down).max(1.0);
        self.knob.set((right / length, down / length));
        self.store
            .driver
            .update_value(|driver| driver.hold_pad(Intent::of_pad(right, down)));
    }
}

#[component]
fn Pad(store: Store, knob: RwSignal<(f64, f64)>, ready: Signal<bool>) -> impl IntoView {
    let pad = NodeRef::<html::Div>::new();
    let grip = Grip {
        store,
        knob,
        pad,
        ready,
    };
    let place_knob = move || {
        let (right, down) = knob.get();
        format!("translate({}px, {}px)", right * 58.0, down * 58.0)
    };
    view! {
        <div
            class="pad"
            id="pad"
            node_ref=pad
            tabindex="0"
            role="application"
            aria-label="Drive pad"
            aria-describedby="drive-hint"
            aria-disabled=move || if ready.get() { "false" } else { "true" }
            on:pointerdown=move |event| grip.press(&event)
            on:pointermove=move |event| grip.drag(&event)
            on:pointerup=move |_| grip.free()
            on:pointercancel=move |_| grip.free()
            on:lostpointercapture=move |_| grip.free()
            on:keydown=move |event| grip.key(&event, Driver::press)
            on:keyup=move |event| grip.key(&event, Driver::lift)
            on:blur=move |_| store.let_go()
        >
            <svg class="pad-arrows" viewBox="0 0 200 200" aria-hidden="true">
                <path d="M92 26l8-10 8 10M92 174l8 10 8-10M26 92l-10 8 10 8M174 92l10 8-10 8" />
            </svg>
            <div class="knob" style:transform=place_knob></div>
        </div>
    }
}

/// Renews the lease ten times a second, and lets go when the page can no longer be looked at.
fn renew_and_guard(store: Store, knob: RwSignal<(f64, f64)>) {
    let renewal = set_interval_with_handle(move || store.drive(), Duration::from_millis(100));
    let let_go = move || {
        knob.set((0.0, 0.0));
        store.let_go();
    };
    let hidden = window_event_listener(ev::visibilitychange, move |_| {
        if document().hidden() {
            let_go();
        }
    });
    let blurred = window_event_listener(ev::blur, move |_| let_go());
    let left = window_event_listener_untyped("pagehide", move |_| let_go());
    on_cleanup(move || {
        if let Ok(renewal) = renewal {
            renewal.clear();
        }
        hidden.remove();
        blurred.remove();
        left.remove();
        store.let_go();
    });
}

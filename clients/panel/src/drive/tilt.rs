//! Driving by tilting the device in the hand, from a press of a button until the next.

use js_sys::{Function, Promise, Reflect};
use leptos::ev;
use leptos::prelude::*;
use panel_logic::{Driver, Tilt};
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_futures::JsFuture;
use web_sys::DeviceOrientationEvent;

use super::Seat;

use crate::language::words;

/// Browsers that do not ask give this answer when they do.
const GRANTED: &str = "granted";

/// Whether tilt is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Following {
    Off,
    On,
    /// The browser or the person does not allow it.
    Refused,
}

#[component]
pub(super) fn TiltButton(seat: Seat) -> impl IntoView {
    let following = RwSignal::new(Following::Off);
    let tilt = StoredValue::new(Tilt::default());
    let listener = window_event_listener(ev::deviceorientation, move |event| {
        if following.get_untracked() == Following::On {
            follow(seat, tilt, &event);
        }
    });
    on_cleanup(move || listener.remove());
    let press = move |_| {
        if following.get_untracked() == Following::On {
            following.set(Following::Off);
            seat.driver.update_value(Driver::forget_tilt);
            return;
        }
        tilt.set_value(Tilt::default());
        leptos::task::spawn_local(async move {
            following.set(if is_permitted().await {
                Following::On
            } else {
                Following::Refused
            });
        });
    };
    let label = move || match following.get() {
        Following::On => words().drive.tilt_stop,
        Following::Off | Following::Refused => words().drive.tilt,
    };
    view! {
        <Show when=has_tilt>
            <button
                type="button"
                class="small"
                id="tilt"
                aria-pressed=move || if following.get() == Following::On { "true" } else { "false" }
                on:click=press
            >
                {label}
            </button>
        </Show>
        <Show when=move || following.get() == Following::Refused>
            <p class="hint" role="status">
                {words().drive.tilt_refused}
            </p>
        </Show>
    }
}

fn follow(seat: Seat, tilt: StoredValue<Tilt>, event: &DeviceOrientationEvent) {
    let (Some(beta), Some(gamma)) = (event.beta(), event.gamma()) else {
        return; // A device without the sensor says nothing.
    };
    let reading = tilt.try_update_value(|tilt| tilt.reading([beta, gamma], screen_deg()));
    if let Some(reading) = reading.flatten() {
        seat.note_input(event.time_stamp());
        seat.tilt(reading);
    }
}

/// How far the picture is turned against the device.
fn screen_deg() -> f64 {
    let screen = window().screen().ok();
    screen
        .and_then(|screen| screen.orientation().angle().ok())
        .map_or(0.0, f64::from)
}

/// A hand-held device that can be asked.
fn has_tilt() -> bool {
    let touches = window()
        .match_media("(pointer: coarse)")
        .ok()
        .flatten()
        .is_some_and(|query| query.matches());
    touches && class().is_some()
}

fn class() -> Option<JsValue> {
    Reflect::get(&window(), &"DeviceOrientationEvent".into())
        .ok()
        .filter(JsValue::is_function)
}

/// Asks for permission where browsers require it; others permit it.
async fn is_permitted() -> bool {
    let Some(class) = class() else { return false };
    let ask = Reflect::get(&class, &"requestPermission".into()).unwrap_or(JsValue::UNDEFINED);
    let Ok(ask) = ask.dyn_into::<Function>() else {
        return true;
    };
    let Ok(promise) = ask.call0(&class).and_then(JsCast::dyn_into::<Promise>) else {
        return false;
    };
    let answer = JsFuture::from(promise).await;
    answer.is_ok_and(|answer| answer.as_string().as_deref() == Some(GRANTED))
}

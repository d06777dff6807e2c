//! Driving by hand: the pad, the keys, gamepads and tilt, by a control mix.

mod choice;
mod gamepads;
mod guard;
mod lend;
mod pad;
mod seat;
mod tilt;

use leptos::prelude::*;
use panel_logic::{Driver, Offer};

use crate::language::words;
use crate::mixes::ask_before_leaving;
use crate::store::Store;
use choice::MixChoice;
use lend::LentState;
use pad::Pad;
use tilt::TiltButton;

pub(crate) use lend::LendView;
pub(crate) use seat::Seat;

#[component]
pub(crate) fn DriveSheet(store: Store) -> impl IntoView {
    guard::watch(store);
    ask_before_leaving(store.bench);
    let seat = store.seat;
    let offer = Memo::new(move |_| store.offers().drive);
    let why = move || match offer.get() {
        _ if store.bench.is_open_now() => words().drive.while_edited,
        _ if seat.is_lent.get() => words().drive.while_lent,
        Offer::NotNow(why) => why.text(words()),
        Offer::Ready | Offer::Absent => words().drive.how,
    };
    view! {
        <div class="drive">
            <Pad seat ready=Signal::derive(move || seat.is_lent.get() || offer.get() == Offer::Ready) />
            <p class="hint" id="drive-hint">{why}</p>
            <LentState store />
            <Cleaners store />
            <MixChoice seat />
            <button
                type="button"
                class="small"
                id="edit-mixes"
                aria-expanded=move || if store.bench.is_open_now() { "true" } else { "false" }
                on:click=move |_| store.bench.toggle(seat)
            >
                {move || if store.bench.is_open_now() { words().drive.editor_close } else { words().drive.editor_open }}
            </button>
            <Hands seat />
            {store.late.when_there(move |views| (views.lend)(store))}
        </div>
        <Show when=move || store.bench.is_open_now()>{store.late.view(move |views| (views.mix_editor)(store))}</Show>
    }
}

/// Whether brushes and suction run, for a robot that has any.
#[component]
fn Cleaners(store: Store) -> impl IntoView {
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
    let choose = move |event| {
        let set = if event_target_checked(&event) {
            Driver::clean_while_driving
        } else {
            Driver::drive_only
        };
        store.seat.driver.update_value(set);
    };
    view! {
        <Show when=cleans>
            <label class="check">
                <input type="checkbox" id="clean-while-driving" on:change=choose />
                {words().drive.clean}
            </label>
        </Show>
    }
}

/// What is seen of gamepads, whether the inputs count, and how fast the robot follows.
#[component]
fn Hands(seat: Seat) -> impl IntoView {
    let pads = move || {
        let names = seat.pads.get();
        if names.is_empty() {
            words().drive.no_gamepad.to_owned()
        } else {
            names.join(", ")
        }
    };
    let state = move || match seat.why_not.get() {
        Some(why_not) => why_not,
        None if seat.is_live.get() => String::new(),
        None => words().drive.waits_for_rest.to_owned(),
    };
    view! {
        <div class="hands">
            <p class="hint" id="gamepads">{pads}</p>
            <p class="hint" id="drive-state" role="status">{state}</p>
            <p class="hint" id="flight" role="status">{move || seat.flight.get()}</p>
            <TiltButton seat />
            <Show when=move || seat.latency.get().is_some()>
                <p class="hint" id="latency" title=words().drive.latency_long>
                    {move || seat.latency.get()}
                    <span class="visually-hidden">{words().drive.latency_long}</span>
                </p>
            </Show>
        </div>
    }
}

//! Over the map: the chosen rooms, zones and spots with what cleaning them takes, and what to do next while something is drawn.

use leptos::prelude::*;
use panel_logic::{DrawnPart, Offer, PASSES_MAX, Tool};
use rvac_api::RequestBody;

use crate::icons::{Icon, icon};
use crate::job_settings_view::JobSettingsFields;
use crate::language::words;
use crate::store::Store;

#[component]
pub(crate) fn OrderBar(store: Store) -> impl IntoView {
    let orders = store.orders;
    let has_choice = Memo::new(move |_| orders.choice.with(|choice| !choice.is_empty()));
    let state = Memo::new(move |_| {
        store.status.with(|status| {
            status
                .as_ref()
                .map(|status| status.state.clone())
                .unwrap_or_default()
        })
    });
    // The choice has become a job.
    Effect::new(move |_| {
        if state.get() == "starting" {
            orders.choice.update(panel_logic::RoomChoice::clear);
        }
    });
    let chosen = Memo::new(move |_| orders.choice.get());
    Effect::new(move |_| {
        // Read, not only tracked: a memo that nobody reads is never made, and tells of nothing.
        chosen.with(|_| state.with(|_| store.ask_prospect()));
    });
    let hint = move || orders.sketch.with(|sketch| sketch.hint(words()));
    view! {
        <div class="order-place">
            <Show when=move || hint().is_some()>
                <div class="order-bar" id="sketch-bar" role="status">
                    <p>{hint}</p>
                    <button type="button" class="small" id="sketch-cancel" on:click=move |_| store.take_tool(Tool::Choose)>
                        {words().frame.cancel}
                    </button>
                </div>
            </Show>
            <Show when=move || has_choice.get()>
                <ChosenRooms store />
            </Show>
        </div>
    }
}

#[component]
fn ChosenRooms(store: Store) -> impl IntoView {
    let orders = store.orders;
    let names = move || {
        let rooms = store.rooms.get();
        orders.choice.with(|choice| choice.text(words(), &rooms))
    };
    let prospect = move || {
        orders
            .prospect
            .get()
            .unwrap_or_else(|| words().map.reckons.to_owned())
    };
    let offer = Memo::new(move |_| store.offers().start);
    let waits = move || match offer.get() {
        Offer::NotNow(why) => Some(why.text(words())),
        Offer::Ready | Offer::Absent => None,
    };
    let joinable = Memo::new(move |_| store.joinable_rooms());
    let clean = move |_| {
        let order = orders.choice.with_untracked(panel_logic::RoomChoice::order);
        if let (Some(order), Offer::Ready) = (order, offer.get_untracked()) {
            store.ask(RequestBody::Clean(order));
        }
    };
    view! {
        <div class="order-bar" id="order-bar" role="group" aria-label=words().map.chosen>
            <p><strong id="chosen-rooms">{names}</strong></p>
            <DrawnParts store />
            <p id="prospect" class="hint" aria-live="polite">{prospect}</p>
            <HowItIsCleaned store />
            <div class="order-tools">
                <button type="button" class="small" id="choose-none" on:click=move |_| orders.choice.update(panel_logic::RoomChoice::clear)>
                    {words().map.choose_none}
                </button>
                <Show when=move || joinable.get().is_some()>
                    <button type="button" class="small" id="join-chosen" on:click=move |_| store.join_chosen()>
                        {words().map.join_these}
                    </button>
                </Show>
                <button type="button" class="small" id="keep-out" on:click=move |_| store.take_tool(Tool::AvoidZone)>
                    {words().map.keep_out}
                </button>
                <button
                    type="button"
                    class="small strong"
                    id="clean-chosen"
                    aria-disabled=move || if waits().is_some() { "true" } else { "false" }
                    title=waits
                    on:click=clean
                >
                    {words().map.clean_these}
                    <span class="visually-hidden">{move || waits().map(|why| words().frame.not_now.fill([&why]))}</span>
                </button>
            </div>
        </div>
    }
}

/// How often and how the parts are cleaned: told in a line, and folded up, for it is seldom changed and the map is small on a phone.
#[component]
fn HowItIsCleaned(store: Store) -> impl IntoView {
    let choice = store.orders.choice;
    let told = move || choice.with(|choice| choice.manner_text(words()));
    view! {
        <details class="folded" id="manner">
            <summary>{told}</summary>
            <div class="order-tools">
                <Passes store />
                <JobSettingsFields
                    place="job"
                    settings=Signal::derive(move || choice.with(panel_logic::RoomChoice::settings))
                    change=Callback::new(move |settings| choice.update(|choice| choice.set_settings(settings)))
                />
            </div>
        </details>
    }
}

/// Zones and spots, each to be taken out. Rooms are taken out where they were chosen.
#[component]
fn DrawnParts(store: Store) -> impl IntoView {
    let choice = store.orders.choice;
    let parts = Memo::new(move |_| choice.with(|choice| choice.drawn(words())));
    let part = move |DrawnPart { place, name, .. }: DrawnPart| {
        let label = format!("{place}. {name}");
        let take_out = words().map.take_out.fill([&label]);
        view! {
            <button
                type="button"
                class="small part"
                id=format!("part-{place}")
                aria-label=take_out.clone()
                title=take_out
                on:click=move |_| choice.update(|choice| choice.take_out(place))
            >
                {label}
                {icon(Icon::Close)}
            </button>
        }
    };
    view! {
        <Show when=move || parts.with(|parts| !parts.is_empty())>
            <div class="order-tools" id="drawn-parts">
                {move || parts.get().into_iter().map(part).collect_view()}
            </div>
        </Show>
    }
}

#[component]
fn Passes(store: Store) -> impl IntoView {
    let choice = store.orders.choice;
    let button = move |passes: u8| {
        view! {
            <button
                type="button"
                id=format!("passes-{passes}")
                aria-pressed=move || if choice.with(|choice| choice.passes() == passes) { "true" } else { "false" }
                on:click=move |_| choice.update(|choice| choice.set_passes(passes))
            >
                {words().map.times.fill([&passes])}
            </button>
        }
    };
    view! {
        <div class="passes" role="group" aria-label=words().map.how_often>
            {(1..=PASSES_MAX).map(button).collect_view()}
        </div>
    }
}

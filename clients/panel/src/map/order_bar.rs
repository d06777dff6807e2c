//! Over the map: the chosen rooms, zones and spots with what cleaning them takes, and what to do next while something is drawn.

use leptos::prelude::*;
use panel_logic::{DrawnPart, PASSES_MAX, RoomChoice, Target, Tool};

use super::reshape_view::ReshapeBar;
use crate::access::{EDITS_HOME, Needs};
use crate::icons::{Icon, icon};
use crate::job_settings_view::JobSettingsFields;
use crate::language::words;
use crate::store::Store;

#[component]
pub(crate) fn OrderBar(store: Store) -> impl IntoView {
    let orders = store.orders;
    let has_choice = Memo::new(move |_| orders.choice.with(|choice| !choice.is_empty()));
    let is_reshaped = Memo::new(move |_| orders.reshape.with(Option::is_some));
    let state = Memo::new(move |_| {
        store.status.with(|status| {
            status
                .as_ref()
                .map(|status| status.state.clone())
                .unwrap_or_default()
        })
    });
    // A job begins, whoever asked for it.
    Effect::new(move |_| {
        if state.get() == "starting" {
            store.on_choice_sent();
        }
    });
    let chosen = Memo::new(move |_| orders.choice.get());
    Effect::new(move |_| {
        // Read, not only tracked: a memo without readers is never computed, and notifies nobody.
        chosen.with(|_| state.with(|_| store.ask_prospect()));
    });
    let hint = move || orders.sketch.with(|sketch| sketch.hint(words()));
    view! {
        <div class="order-place">
            <Show when=move || hint().is_some()>
                <div class="order-bar" id="sketch-bar" role="status">
                    <p class:wrong=move || orders.sketch.with(|sketch| sketch.is_too_small())>{hint}</p>
                    <button type="button" class="small" id="sketch-cancel" on:click=move |_| store.take_tool(Tool::Choose)>
                        {words().frame.cancel}
                    </button>
                </div>
            </Show>
            <Show when=move || is_reshaped.get()>
                <ReshapeBar store />
            </Show>
            // On a phone both would cover the whole map.
            <Show when=move || has_choice.get() && !is_reshaped.get()>
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
    let joinable = Memo::new(move |_| store.joinable_rooms());
    view! {
        <div class="order-bar" id="order-bar" role="group" aria-label=words().map.chosen>
            <p><strong id="chosen-rooms">{names}</strong></p>
            <DrawnParts store />
            <p id="prospect" class="hint" aria-live="polite">{prospect}</p>
            <HowItIsCleaned store />
            <div class="order-tools">
                <button type="button" class="small" id="choose-none" on:click=move |_| store.choose(RoomChoice::clear)>
                    {words().map.clear_choice}
                </button>
                <Show when=move || joinable.get().is_some()>
                    <Needs store verb=EDITS_HOME>
                        <button type="button" class="small" id="join-chosen" on:click=move |_| store.join_chosen()>
                            {words().map.join_these}
                        </button>
                    </Needs>
                </Show>
                <button type="button" class="small" id="keep-out" on:click=move |_| store.take_tool(Tool::AvoidZone)>
                    {words().map.keep_out}
                </button>
            </div>
        </div>
    }
}

/// How often and how the parts are cleaned: summarized in a line, and folded up, for it is seldom changed and the map is small on a phone.
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
                    settings=Signal::derive(move || choice.with(RoomChoice::settings))
                    change=Callback::new(move |settings| store.choose(|choice| choice.set_settings(settings)))
                />
            </div>
        </details>
    }
}

/// Zones and spots, and places that are kept out of, each to be reshaped and taken out. Rooms are taken out where they were chosen.
#[component]
fn DrawnParts(store: Store) -> impl IntoView {
    let choice = store.orders.choice;
    let parts = Memo::new(move |_| choice.with(|choice| choice.drawn(words())));
    let avoided = Memo::new(move |_| choice.with(|choice| choice.avoid().len()));
    let part = move |DrawnPart { place, name, .. }: DrawnPart| {
        let name = format!("{place}. {name}");
        let can_be_reshaped = choice.with_untracked(|choice| choice.part_outline(place).is_some());
        let label = words().map.reshape_named.fill([&name]);
        let reshape = can_be_reshaped.then(|| reshape_button(store, Target::Part(place), label));
        let take_out = move || store.choose(|choice| choice.take_out(place));
        view! { {take_out_button(format!("part-{place}"), name, take_out)} {reshape} }
    };
    let place = move |place: usize| {
        let name = words().map.avoided.fill([&place]);
        let label = words().map.reshape_named.fill([&name]);
        let reshape = reshape_button(store, Target::Avoided(place), label);
        let take_out = move || store.choose(|choice| choice.allow_again(place));
        view! { {take_out_button(format!("avoided-{place}"), name, take_out)} {reshape} }
    };
    view! {
        <Show when=move || parts.with(|parts| !parts.is_empty())>
            <div class="order-tools" id="drawn-parts">
                {move || parts.get().into_iter().map(part).collect_view()}
            </div>
        </Show>
        <Show when=move || avoided.get() != 0>
            <div class="order-tools" id="avoided-places">
                {move || (1..=avoided.get()).map(place).collect_view()}
            </div>
        </Show>
    }
}

fn take_out_button(id: String, name: String, take_out: impl Fn() + 'static) -> impl IntoView {
    let label = words().map.take_out.fill([&name]);
    view! {
        <button
            type="button"
            class="small part"
            id=id
            aria-label=label.clone()
            title=label
            on:click=move |_| take_out()
        >
            {name}
            {icon(Icon::Close)}
        </button>
    }
}

fn reshape_button(store: Store, target: Target, label: String) -> impl IntoView {
    view! {
        <button
            type="button"
            class="small"
            id=target.button_id()
            aria-label=label.clone()
            title=label
            on:click=move |_| store.begin_reshape(target)
        >
            {icon(Icon::Reshape)}
        </button>
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
                on:click=move |_| store.choose(|choice| choice.set_passes(passes))
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

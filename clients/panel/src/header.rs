//! The bar at the top: name of the robot, connection, charge, and the theme.

use leptos::prelude::*;
use panel_logic::{Currency, percent_text};

use crate::icons::{Icon, icon};
use crate::language::{LanguageChoice, words};
use crate::store::Store;
use crate::theme::Theme;

#[component]
pub(crate) fn Header(store: Store, theme: RwSignal<Theme>) -> impl IntoView {
    let robot = move || {
        store
            .robot
            .with(|robot| robot.as_ref().map(|robot| robot.device.to_uppercase()))
    };
    let home = move || store.home.get().map(|home| words().frame.simulated.fill([&home]));
    let toggle = move |_| {
        theme.update(|theme| *theme = theme.other());
        theme.get_untracked().choose();
        store.map.with_value(|map| map.set_theme(theme.get_untracked()));
    };
    view! {
        <header class="bar">
            <h1 class="brand">
                <svg class="mark" viewBox="0 0 32 32" width="28" height="28" aria-hidden="true">
                    <circle cx="16" cy="16" r="14" class="mark-body" />
                    <path d="M5.6 11.8a11.3 11.3 0 0 1 20.8 0" class="mark-bumper" />
                    <circle cx="16" cy="17.5" r="4.2" class="mark-eye" />
                </svg>
                "LibreRVAC"
            </h1>
            <Show when=move || robot().is_some()>
                <span class="chip" id="robot">{robot}</span>
            </Show>
            <Show when=move || home().is_some()>
                <span class="chip quiet wide-only">{home}</span>
            </Show>
            <span class="spring"></span>
            <Charge store />
            <Presence store />
            <LanguageChoice />
            <button
                type="button"
                class="round"
                id="theme"
                aria-label=move || if theme.get() == Theme::Dark { words().frame.use_light } else { words().frame.use_dark }
                on:click=toggle
            >
                {move || icon(if theme.get() == Theme::Dark { Icon::Sun } else { Icon::Moon })}
            </button>
        </header>
    }
}

#[component]
fn Charge(store: Store) -> impl IntoView {
    let charge = Memo::new(move |_| {
        store.device.with(|table| {
            table
                .as_ref()
                .and_then(|table| table.battery.as_ref().map(|battery| battery.charge))
        })
    });
    view! {
        <Show when=move || charge.get().is_some()>
            <span class="charge" class:low=move || charge.get().is_some_and(|charge| charge < 0.15)>
                <svg viewBox="0 0 26 14" width="26" height="14" aria-hidden="true">
                    <rect x="1" y="1" width="21" height="12" rx="3" class="cell" />
                    <rect x="23.5" y="4.5" width="2" height="5" rx="1" class="pole" />
                    <rect x="3" y="3" height="8" rx="1.5" class="fill" width=move || (charge.get().unwrap_or(0.0) * 17.0).max(1.0) />
                </svg>
                <span class="visually-hidden">{words().frame.battery} " "</span>
                {move || percent_text(words(), charge.get().unwrap_or(0.0))}
            </span>
        </Show>
    }
}

/// Whether the robot can be reached, beside a dot that does not rely on colour alone.
#[component]
fn Presence(store: Store) -> impl IntoView {
    let connected = Memo::new(move |_| {
        store.status.with(|status| {
            status
                .as_ref()
                .is_some_and(|status| status.state != "disconnected")
        })
    });
    let current = Memo::new(move |_| store.currency.get() == Currency::Current);
    let text = move || match (connected.get(), current.get()) {
        (true, true) => words().frame.connected,
        (true, false) => words().frame.not_current,
        (false, _) => words().frame.not_connected,
    };
    view! {
        <span class="presence" id="presence" class:up=move || connected.get() && current.get()>
            <span class="dot" aria-hidden="true"></span>
            {text}
        </span>
    }
}

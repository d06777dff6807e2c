//! What the robot decided lately, and why.

use leptos::prelude::*;
use panel_logic::clock_text;
use rvac_api::Decision;

use crate::store::Store;

#[component]
pub(crate) fn WhyView(store: Store) -> impl IntoView {
    let decisions = move || {
        store
            .decisions
            .with(|book| book.newest_first().cloned().collect::<Vec<_>>())
    };
    view! {
        <ol class="entries why" id="decisions" tabindex="0" aria-label="Decisions, newest first">
            <For each=decisions key=|entry| entry.number let:entry>
                {line(entry)}
            </For>
        </ol>
        <Show when=move || decisions().is_empty()>
            <p class="hint">"It has decided nothing yet."</p>
        </Show>
    }
}

fn line(entry: Decision) -> impl IntoView {
    view! {
        <li>
            <span class="when">{clock_text(entry.t)}</span>
            <span class="told">{entry.text}</span>
        </li>
    }
}

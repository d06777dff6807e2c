//! What the robot decided lately, and why.

use leptos::prelude::*;
use panel_logic::{clock_text, decision_text};
use rvac_api::Decision;

use crate::language::words;
use crate::store::Store;

#[component]
pub(crate) fn WhyView(store: Store) -> impl IntoView {
    let decisions = move || {
        store
            .decisions
            .with(|book| book.newest_first().cloned().collect::<Vec<_>>())
    };
    view! {
        <ol class="entries why" id="decisions" tabindex="0" aria-label=words().frame.decisions>
            <For each=decisions key=|entry| entry.number let:entry>
                {line(store, entry)}
            </For>
        </ol>
        <Show when=move || decisions().is_empty()>
            <p class="hint">{words().frame.no_decisions}</p>
        </Show>
    }
}

fn line(store: Store, entry: Decision) -> impl IntoView {
    view! {
        <li>
            <span class="when" title=words().log.since_start.fill([&clock_text(entry.t)])>{store.wall_text(entry.t)}</span>
            <span class="told">{decision_text(words(), &entry)}</span>
        </li>
    }
}

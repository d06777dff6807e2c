//! How worn or dirty the parts are that turn, and the word that one was cleaned.

use std::time::Duration;

use leptos::prelude::*;
use panel_logic::{PartRow, part_rows};
use rvac_api::RequestBody;

use crate::access::{Needs, OnlyLooks};
use crate::icons::{Icon, icon};
use crate::language::words;
use crate::store::Store;

/// Loads are measured by the minute.
const RENEW_EVERY: Duration = Duration::from_secs(30);

#[component]
pub(crate) fn PartsView(store: Store) -> impl IntoView {
    store.ask_quietly(RequestBody::Health);
    if let Ok(renewal) = set_interval_with_handle(move || store.ask_quietly(RequestBody::Health), RENEW_EVERY)
    {
        on_cleanup(move || renewal.clear());
    }
    let measures = Memo::new(move |_| {
        store.robot.with(|robot| {
            robot
                .as_ref()
                .is_some_and(|robot| robot.parts.iter().any(|part| part == "currents"))
        })
    });
    let rows = Memo::new(move |_| store.health.with(|parts| part_rows(words(), parts)));
    view! {
        <Show when=move || measures.get()>
            <section aria-labelledby="parts-title">
                <h3 id="parts-title">{words().health.title}</h3>
                <OnlyLooks store verb="reset-health" />
                <ul id="parts" class="rows parts">
                    {move || rows.get().into_iter().map(|part| row(store, part)).collect_view()}
                </ul>
                <p class="hint">{words().health.share_of}</p>
            </section>
        </Show>
    }
}

fn row(store: Store, part: PartRow) -> impl IntoView {
    let label = words().health.cleaned_named.fill([&part.name]);
    let (id, component) = (format!("cleaned-{}", part.component), part.component);
    let cleaned = move |_| store.reset_health(component.clone());
    let remedy = (!part.remedy.is_empty())
        .then(|| view! { <p class="remark">{icon(Icon::Warning)} {part.remedy}</p> });
    view! {
        <li>
            <span class="name">{part.name}</span>
            <span class="words">{part.state}</span>
            <Needs store verb="reset-health">
                <button type="button" class="small" id=id aria-label=label on:click=cleaned>
                    {words().health.cleaned}
                </button>
            </Needs>
            {remedy}
        </li>
    }
}
